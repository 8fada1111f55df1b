"""One recording in which something of the rig was another for a while, beside what only looks like that."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check import changed_rig
from diagnosis.check.beside import Compared, compare
from diagnosis.check.changed_rig import changed_rig as asked
from diagnosis.check.check import check_recordings
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from tests.check.test_other_course import C_1, C_2, CHANNELS, COUNT, G_OUT, HOLD, SCENARIO, STACK, STEP, G, recorded
from tests.systems.rigs import built, held

END = STEP * (COUNT - 1)
#: When the rig of the second run is another [s].
SINCE, UNTIL = 4000.0, 8600.0
#: Heat that something else gives to the block then [W], and its loss while a fan blows [W/K].
LAMP, FANNED = 12.0, 1.6
Rate = Callable[[float, Array, float], Array]


def _rate(t: float, x: Array, u: float, loss: float = G_OUT, lamp: float = 0.0) -> Array:
    through = G * (x[0] - x[1])
    return np.array([(u - through) / C_1, (through + lamp - loss * (x[1] - 295.0)) / C_2])


def fan_from_then_on(t: float, x: Array, u: float) -> Array:
    return _rate(t, x, u, loss=FANNED if t >= SINCE else G_OUT)


def _fan_for_a_while(t: float, x: Array, u: float) -> Array:
    return _rate(t, x, u, loss=FANNED if SINCE <= t < UNTIL else G_OUT)


def lamp_for_a_while(t: float, x: Array, u: float) -> Array:
    return _rate(t, x, u, lamp=LAMP if SINCE <= t < UNTIL else 0.0)


def _swings(t: float, x: Array, u: float) -> Array:
    """Heat that comes and goes many times: no one interval explains it."""
    return _rate(t, x, u, lamp=15.0 * float(np.sin(t / 400.0)))


def three_runs(folder: Path, second: Rate, names: tuple[str, ...] = tuple(CHANNELS)) -> list[Path]:
    """Three runs of a plate on a block, of which the second has another rig."""
    built(STACK, SCENARIO, folder)
    found = []
    for run in (1, 2, 3):
        rng = np.random.default_rng(100 + run)
        power = np.repeat(rng.uniform(0.0, 40.0, COUNT // HOLD), HOLD)
        course = course_of(second if run == 2 else _rate, power)
        found.append(recorded(folder / f"run_{run}", power, course, rng, names))
    return found


def course_of(law: Rate, power: Array) -> Array:
    """Temperatures of plate and block [K], shape (COUNT, 2): time is a third state of the equations."""

    def rate(x: Array, u: float) -> Array:
        return np.append(law(float(x[2]), x, u), 1.0)

    return held(rate, np.array([295.0, 295.0, 0.0]), power, STEP)[:, :2]


def _compared(folder: Path, recordings: list[Path]) -> tuple[Compared, list[Compared]]:
    first, second, third = (compare(load_scenario(folder / "scenario.yaml"), load_recording(r)) for r in recordings)
    return second, [first, third]


def _told(folder: Path, second: Rate) -> Doubt | None:
    return asked(*_compared(folder, three_runs(folder, second)))


@pytest.mark.parametrize(
    ("second", "words", "expected"),
    [
        (
            fan_from_then_on,
            r"stack\.G_out = ([\d.]+) W/K \(0\.8 is stated\) from about ([\d.]+) s on",
            (FANNED, SINCE),
        ),
        (
            _fan_for_a_while,
            r"stack\.G_out = ([\d.]+) W/K \(0\.8 is stated\) from about ([\d.]+) to ([\d.]+) s",
            (FANNED, SINCE, UNTIL),
        ),
        (
            lamp_for_a_while,
            r"der\(stack\.block\) larger by ([\d.]+) K/s from about ([\d.]+) to ([\d.]+) s",
            (LAMP / C_2, SINCE, UNTIL),
        ),
    ],
    ids=["from an instant on", "for a while", "heat from elsewhere"],
)
def test_what_was_another_is_told_with_its_size_and_when(
    second: Rate, words: str, expected: tuple[float, ...], tmp_path: Path
) -> None:
    told = _told(tmp_path, second)
    assert told is not None
    assert (told.recording, told.is_serious) == ("run_2", False)
    found = re.search(words, told.statement)
    assert found is not None, told.statement
    size, *instants = (float(n) for n in found.groups())
    assert size == pytest.approx(expected[0], rel=0.05)
    assert instants == pytest.approx(expected[1:], abs=0.02 * END)
    assert told.begin == pytest.approx(SINCE, abs=0.02 * END)


def test_stated_under_overrides_it_is_no_more_told(tmp_path: Path) -> None:
    """What the remedy says: the recording is met once the term stands there."""
    recordings = three_runs(tmp_path, fan_from_then_on)
    told = asked(*_compared(tmp_path, recordings))
    assert told is not None
    assert "a term that is added to `parameter(G_out)` of `stack`" in told.remedy
    path = recordings[1] / "recording.yaml"
    about = yaml.safe_load(path.read_text(encoding="utf-8"))
    term = {
        "to": "parameter(G_out)",
        "formula": "amount*step(time - begin)",
        "is_share": True,
        "parameters": {"amount": FANNED / G_OUT - 1.0, "begin": f"{SINCE} s"},
    }
    about.setdefault("overrides", {})["components"] = {"stack": {"added_terms": [term]}}
    path.write_text(yaml.safe_dump(about, sort_keys=False), encoding="utf-8")
    assert asked(*_compared(tmp_path, recordings)) is None


def test_the_check_tells_it_of_a_recording_that_stands_out(tmp_path: Path) -> None:
    recordings = three_runs(tmp_path, _fan_for_a_while)
    every = check_recordings(load_scenario(tmp_path / "scenario.yaml"), [load_recording(r) for r in recordings])
    (told,) = [d for d in every if d.recording == "run_2" and d.kind == "odd one out"]
    assert "as if something of the rig was another, with" in told.statement
    assert not told.is_serious


def test_what_no_interval_explains_is_not_told(tmp_path: Path) -> None:
    assert _told(tmp_path, _swings) is None


def test_a_recording_that_is_met_is_not_asked_about(tmp_path: Path) -> None:
    assert _told(tmp_path, _rate) is None


def test_one_channel_proves_nothing(tmp_path: Path) -> None:
    assert asked(*_compared(tmp_path, three_runs(tmp_path, fan_from_then_on, ("stack.top",)))) is None


def test_a_long_run_is_not_tried(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(changed_rig, "MOST_STEPS", COUNT // 2)
    assert _told(tmp_path, fan_from_then_on) is None


def test_an_fmu_that_integrates_itself_takes_no_other_parameter(tmp_path: Path) -> None:
    recordings = three_runs(tmp_path, fan_from_then_on)
    path = tmp_path / "scenario.yaml"
    path.write_text(path.read_text(encoding="utf-8").replace(", integrator: cvode", ""), encoding="utf-8")
    assert asked(*_compared(tmp_path, recordings)) is None


def test_of_many_changes_that_explain_it_the_first_are_told_and_the_others_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(changed_rig, "as_explained", lambda theirs: 0.37)
    told = _told(tmp_path, fan_from_then_on)
    assert told is not None
    assert told.statement.count(" or ") == changed_rig.MOST - 1
    assert re.search(r"\(\d more of its numbers and derivatives do, too\)", told.statement)
