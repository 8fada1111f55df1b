"""An input that was not applied for a while, or did not move: no other course, and the search finds begin and end."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.beside import Course
from diagnosis.check.check import check_recordings
from diagnosis.check.pause import NOTHING, STAYED, paused
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Verdict
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from tests.check.test_other_course import CHANNELS, SCENARIO, STACK, STEP, _power, recorded, temperatures

#: When the heater was off [s], soon after its power changed: 44 % of the recording.
BEGIN, END = 3640.0, 8900.0
#: When it changes next.
LEVEL = 4800.0


def acted(kind: str, power: Array) -> Array:
    times = STEP * np.arange(len(power))
    inside = (times >= BEGIN) & (times < END)
    return np.where(inside, 0.0 if kind == NOTHING else power[times < BEGIN][-1], power)


def _recordings(folder: Path, kind: str) -> list[Path]:
    """Three runs; in the second one power is not what its column says for a while."""
    STACK.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    found = []
    for run in (1, 2, 3):
        rng, stated = np.random.default_rng(100 + run), _power(run)
        power = acted(kind, stated) if run == 2 else stated
        found.append(recorded(folder / f"run_{run}", stated, temperatures(power), rng, tuple(CHANNELS)))
    return found


@pytest.mark.parametrize("kind", [NOTHING, STAYED])
def test_it_is_said_of_the_input_and_found_with_begin_and_end(tmp_path: Path, kind: str) -> None:
    every = [load_recording(r) for r in _recordings(tmp_path, kind)]
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    (doubt,) = [d for d in check_recordings(scenario, every) if d.kind in ("odd one out", "programme")]
    assert (doubt.recording, doubt.subject, doubt.is_serious) == ("run_2", "heater.power", False)
    assert kind in doubt.statement
    # what does not move may have stopped at any instant from which its level is held
    latest = BEGIN if kind == NOTHING else LEVEL
    assert BEGIN - 3 * STEP < doubt.begin < latest + 3 * STEP
    assert doubt.end == pytest.approx(END, abs=3 * STEP)
    found = diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis
    assert found.verdict is Verdict.MEASUREMENT_FAULT
    (one,) = [f for f in found.findings if f.is_accepted]
    assert one.place == "heater.power (run_2)"
    begin, end = (next(p for p in one.parameters if p.name == name) for name in ("begin", "end"))
    assert begin.lower - STEP <= BEGIN <= begin.upper + STEP
    assert end.value == pytest.approx(END, abs=STEP)


@pytest.mark.parametrize("is_linear", [False, True])
@pytest.mark.parametrize("kind", [NOTHING, STAYED])
def test_the_interval_is_found_between_the_ends_of_pieces(kind: str, is_linear: bool) -> None:
    """Against the course itself: what is missed is the area between both."""
    times = np.arange(0.0, 100.0, 1.0)
    course = Course("pump.flow", "L/min", times, 2.0 + np.sin(times / 9.0), False, is_linear)
    fine = np.arange(0.0, 100.0, 0.05)

    def at(own_times: Array, values: Array) -> Array:
        if is_linear:
            return np.interp(fine, own_times, values)
        return values[np.maximum(np.searchsorted(own_times, fine, side="right") - 1, 0)]

    goal = at(times, course.values)
    first = goal[fine <= 23.0][-1]
    goal = np.where((fine >= 23.0) & (fine < 61.5), 0.0 if kind == NOTHING else first, goal)
    found = paused(course, kind, (0.0, 100.0), 0.1, lambda t, v: float(np.mean((at(t, v) - goal) ** 2)))
    assert (found.begin, found.end) == (pytest.approx(23.0, abs=1.0), pytest.approx(61.5, abs=1.0))
    assert found.left < 0.03
    assert (found.kind, found.course) == (kind, course)


def test_a_short_interval_is_sought_from_where_readings_depart() -> None:
    """What is missed is the same wherever nothing acts but near the right interval, as of a response that collapses."""
    times = np.arange(0.0, 100.0, 1.0)
    course = Course("pump.flow", "L/min", times, np.full(100, 2.0), False, False)
    begin, end = 23.0, 25.0

    def missed(own_times: Array, values: Array) -> float:
        off = own_times[values == 0.0]
        on = own_times[(own_times > off[0]) & (values > 0.0)][0]
        return min(abs(float(off[0]) - begin) + abs(float(on) - end), 4.0)

    assert paused(course, NOTHING, (0.0, 100.0), 0.1, missed).left > 3.0
    found = paused(course, NOTHING, (0.0, 100.0), 0.1, missed, 23.3)
    assert (found.begin, found.end) == (pytest.approx(begin, abs=0.2), pytest.approx(end, abs=0.2))
