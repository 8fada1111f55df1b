"""An actuator that stays where it is for a while, though its command goes on."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.diagnose import Options, diagnose
from diagnosis.faults.model import with_faults
from diagnosis.faults.programme import InputChange
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.models.build import models_of
from diagnosis.recording.recording import load_recording
from diagnosis.search.score import Projection
from diagnosis.search.search import Settings, recalibrate
from tests.systems.rigs import held, tank, write_recording

STEP, COUNT = 0.5, 400
#: Samples between which the valve of the second recording stays.
STAYS = (160, 244)


def test_it_stays_at_what_is_stated_where_it_begins() -> None:
    stated = np.array([1.0, 2.0, 4.0, 8.0, 16.0])
    fault = InputChange(1.0, 1.0, 3.5, is_held=True)
    shares = fault.shares(np.arange(5.0), 1.0)
    np.testing.assert_allclose(stated + fault.change(stated, shares), [1.0, 2.0, 2.0, 5.0, 16.0])


def test_a_list_stays_element_by_element() -> None:
    stated = np.array([[1.0, 5.0], [2.0, 6.0], [4.0, 8.0]])
    fault = InputChange(1.0, 1.0, 9.0, is_held=True)
    moved = stated + fault.change(stated, fault.shares(np.arange(3.0), 1.0))
    np.testing.assert_allclose(moved, [[1.0, 5.0], [2.0, 6.0], [2.0, 6.0]])


def _diagnosed(folder: Path, stays: tuple[int, int] | None) -> Diagnosis:
    """Three runs of a tank whose valve goes to another place every 8 s; its numbers are 2 % off, noise 1 mm."""
    tank(folder, "200 s", "500 ms")
    every = []
    for number in range(3):
        rng = np.random.default_rng(30 + number)
        stated = np.repeat(rng.uniform(0.005, 0.03, COUNT // 16), 16)
        given = stated.copy()
        if stays is not None and number == 1:
            given[slice(*stays)] = stated[stays[0]]
        level = held(lambda h, q: (q - 0.0203 * h) / 0.495, np.array([0.4]), given, STEP)[:, 0]
        columns = {"t": STEP * np.arange(COUNT), "q": stated, "h": level + 1e-3 * rng.standard_normal(COUNT)}
        inputs, channels = {"pump.inflow": ("q", "m^3/s")}, {"tank.level": ("h", "m", "1 mm")}
        every.append(load_recording(write_recording(folder / f"run_{number}", columns, inputs, channels)))
    scenario = load_scenario(str(folder / "scenario.yaml"))
    return diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis


def test_an_input_that_stays_is_found_with_its_interval(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, STAYS)
    assert found.verdict is Verdict.MEASUREMENT_FAULT
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.place) == ("input_held_in_interval", "pump.inflow (run_1)")
    _, begin, end = finding.parameters
    assert end.value == pytest.approx(STEP * STAYS[1], abs=0.5)
    # Until the next command at 88 s it does not matter when it began to stay.
    assert begin.lower == pytest.approx(80.0, abs=0.6)
    assert begin.upper == pytest.approx(88.0, abs=0.6)


def test_a_valve_that_follows_its_command_has_no_fault(tmp_path: Path) -> None:
    assert not [f for f in _diagnosed(tmp_path, None).findings if f.is_accepted]


def test_what_an_input_that_stays_does_is_simulated_at_every_interval_once(tmp_path: Path) -> None:
    scenario = load_scenario(str(tank(tmp_path, "200 s", "500 ms")))
    rng = np.random.default_rng(31)
    stated = np.repeat(rng.uniform(0.005, 0.03, COUNT // 16), 16)
    given = stated.copy()
    given[slice(*STAYS)] = stated[STAYS[0]]
    level = held(lambda h, q: (q - 0.0203 * h) / 0.495, np.array([0.4]), given, STEP)[:, 0]
    columns = {"t": STEP * np.arange(COUNT), "q": stated, "h": level + 1e-3 * rng.standard_normal(COUNT)}
    inputs, channels = {"pump.inflow": ("q", "m^3/s")}, {"tank.level": ("h", "m", "1 mm")}
    recording = load_recording(write_recording(tmp_path / "run", columns, inputs, channels))
    model, _ = models_of(scenario, [recording], [], ())
    faulty = with_faults(model)
    base = recalibrate(faulty)
    projection = Projection(base)
    projection.noise(4, 0)
    found, made = [], []
    for _ in range(2):
        before = faulty.simulations
        scoring = faulty.interval_scores(base, projection)
        made.append(faulty.simulations - before)
        found.append(next(s for s in scoring.ranked if s.term.identifier == "input_held_in_interval"))
    assert found[0].values == found[1].values
    assert found[0].gain == pytest.approx(found[1].gain, rel=1e-6)
    assert made[1] < made[0] - 100
