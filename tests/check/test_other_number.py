"""One recording in which one number of the rig is another, beside what only looks like that."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check import other_number
from diagnosis.check.check import check_recordings
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Doubt, Verdict
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from tests.check.test_other_course import C_1, C_2, CHANNELS, COUNT, G_OUT, HOLD, SCENARIO, STACK, STEP, G, recorded
from tests.systems.rigs import built, held

#: Power that the runs may take [W]: from least to largest.
LEAST, MOST = 0.0, 40.0


def _recordings(
    folder: Path,
    loss: Callable[[int, Array], float],
    names: tuple[str, ...] = tuple(CHANNELS),
    largest: float = MOST,
    sensor: Callable[[Array], Array] = lambda values: values,
) -> list[Path]:
    """Three runs of a plate on a block; numbers of all are 2 % off.

    Args:
        folder: Where the files go.
        loss: Conductance from the block: number of the run, from 1, and temperatures to W/K.
        names: Channels that are recorded.
        largest: Power in the second run [W].
        sensor: What the second channel of the second run makes of the temperature.
    """
    STACK.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    found = []
    for run in (1, 2, 3):
        rng = np.random.default_rng(100 + run)
        power = np.repeat(rng.uniform(LEAST, largest if run == 2 else MOST, COUNT // HOLD), HOLD)
        course = _course(power, partial(loss, run))
        if run == 2:
            course[:, 1] = sensor(course[:, 1])
        found.append(recorded(folder / f"run_{run}", power, course, rng, names))
    return found


def _doubts(folder: Path, recordings: list[Path]) -> list[Doubt]:
    scenario = load_scenario(str(folder / "scenario.yaml"))
    return [d for d in check_recordings(scenario, [load_recording(r) for r in recordings]) if d.kind == "number"]


def _fanned(run: int, x: Array) -> float:
    """A fan blows at the block in the second run."""
    return 1.6 if run == 2 else 0.79


def _course(power: Array, loss: Callable[[Array], float]) -> Array:
    """Temperatures of plate and block [K], shape (steps, 2), by the classical Runge-Kutta method: 20 s of 300 s."""

    def rate(x: Array, u: float) -> Array:
        through = 0.98 * G * (x[0] - x[1])
        return np.array([(u - through) / 404.0, (through - loss(x) * (x[1] - 295.0)) / 918.0])

    states = [np.array([295.0, 295.0])]
    for u in power[:-1].tolist():
        x = states[-1]
        a = rate(x, u)
        b = rate(x + 0.5 * STEP * a, u)
        c = rate(x + 0.5 * STEP * b, u)
        states.append(x + STEP / 6.0 * (a + 2.0 * b + 2.0 * c + rate(x + STEP * c, u)))
    return np.array(states)


def test_a_number_that_is_another_in_one_recording_is_named_with_its_value(tmp_path: Path) -> None:
    (doubt,) = _doubts(tmp_path, _recordings(tmp_path, _fanned))
    assert (doubt.recording, doubt.subject, doubt.is_serious) == ("run_2", "stack.G_out", True)
    value = re.search(r"with stack.G_out = ([0-9.]+) W/K \(0.8 is stated\) in this recording alone", doubt.statement)
    assert value is not None
    assert float(value[1]) == pytest.approx(1.6, rel=0.05)  # other numbers are as stated, 2 % off


@pytest.mark.parametrize("of_air", [0.5, -0.3], ids=["loss", "gain"])
def test_a_number_that_is_stated_as_0_is_tried_on_either_side(of_air: float, tmp_path: Path) -> None:
    """The plate of the second run loses heat to the air, or gets some; the scenario says that no plate does."""
    rates = {
        "plate": ("K", "295", "(power - G*(plate - block) - G_air*(plate - 295))/C_1"),
        "block": STACK.states["block"],
    }
    model = replace(STACK, parameters=STACK.parameters | {"G_air": (0.0, "W/K")}, states=rates)

    def rate(x: Array, u: float, air: float) -> Array:
        through = G * (x[0] - x[1])
        return np.array([(u - through - air * (x[0] - 295.0)) / C_1, (through - G_OUT * (x[1] - 295.0)) / C_2])

    built(model, SCENARIO, tmp_path)
    recordings = []
    for run in (1, 2, 3):
        rng = np.random.default_rng(100 + run)
        power = np.repeat(rng.uniform(LEAST, MOST, COUNT // HOLD), HOLD)
        course = held(partial(rate, air=of_air if run == 2 else 0.0), np.array([295.0, 295.0]), power, STEP)
        recordings.append(recorded(tmp_path / f"run_{run}", power, course, rng, tuple(CHANNELS)))
    (doubt,) = _doubts(tmp_path, recordings)
    assert doubt.recording == "run_2"
    value = re.search(r"with stack.G_air = (-?[0-9.]+) W/K \(0 is stated\)", doubt.statement)
    assert value is not None, doubt.statement
    assert float(value[1]) == pytest.approx(of_air, rel=0.03)


def test_a_diagnosis_says_it_and_searches_nothing(tmp_path: Path) -> None:
    every = [load_recording(r) for r in _recordings(tmp_path, _fanned)]
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    found = diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis
    assert found.verdict is Verdict.RECORDING_FAULT
    assert not found.findings


def test_one_channel_proves_nothing(tmp_path: Path) -> None:
    assert not _doubts(tmp_path, _recordings(tmp_path, _fanned, ("stack.top",)))


def test_recordings_that_are_all_met_raise_no_doubt(tmp_path: Path) -> None:
    assert not _doubts(tmp_path, _recordings(tmp_path, lambda run, x: 0.79))


def test_a_sensor_that_is_another_is_no_number_of_the_rig(tmp_path: Path) -> None:
    def clipped(values: Array) -> Array:
        return np.minimum(values, float(np.quantile(values, 0.5)))

    assert not _doubts(tmp_path, _recordings(tmp_path, lambda run, x: 0.79, sensor=clipped))


def test_what_acts_at_temperatures_that_one_recording_alone_reaches_is_not_serious(tmp_path: Path) -> None:
    """A valve opens at 345 K: that recording alone is as warm, so a law of the rig may be what is missing."""
    found = _doubts(tmp_path, _recordings(tmp_path, lambda run, x: 1.6 if x[1] > 345.0 else 0.79, largest=120.0))
    assert not [d for d in found if d.is_serious]


def test_a_long_run_is_not_tried(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(other_number, "is_quick", lambda scenario: False)
    assert not _doubts(tmp_path, _recordings(tmp_path, _fanned))


def test_numbers_of_which_many_explain_it_say_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(other_number, "MOST", 0)
    assert not _doubts(tmp_path, _recordings(tmp_path, _fanned))
