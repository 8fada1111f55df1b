"""An input that stood at a value that nobody stated: a valve that jams half open, a cooler that stops."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.diagnose import Options, diagnose
from diagnosis.faults.law import HELD, INPUT, LEVEL
from diagnosis.faults.programme import InputChange, input_change, level_inputs
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.models.build import model_of
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from tests.check.test_other_course import CHANNELS, COUNT, HOLD, SCENARIO, STACK, STEP, recorded, temperatures
from tests.systems.rigs import built

#: When the heater of the second run stands still [readings], and at which power [W].
SINCE, UNTIL, STOOD = 210, 395, 13.0


def told(folder: Path, acting: float | None) -> Diagnosis:
    """The answer to three runs; in the second the heater stands at a power for a while, as stated where None."""
    built(STACK, SCENARIO, folder)
    recordings = []
    for run in (1, 2, 3):
        rng = np.random.default_rng(300 + run)
        stated = np.repeat(rng.uniform(0.0, 40.0, COUNT // HOLD), HOLD)
        power = stated.copy()
        if run == 2 and acting is not None:
            power[SINCE:UNTIL] = acting
        path = recorded(folder / f"run_{run}", stated, temperatures(power), rng, tuple(CHANNELS))
        recordings.append(load_recording(path))
    scenario = load_scenario(folder / "scenario.yaml")
    return diagnose(scenario, recordings[:2], recordings[2:], Settings(), options=Options(is_brief=True)).diagnosis


def test_an_input_that_stood_elsewhere_is_named_with_its_value(tmp_path: Path) -> None:
    found = told(tmp_path, STOOD)
    assert found.verdict is Verdict.MEASUREMENT_FAULT, found.statement
    assert "input that stood at another value for a while, heater.power (run_2)" in found.statement
    (one,) = found.accepted
    assert one.effect == LEVEL.identifier
    _, begin, end, level = one.parameters
    assert level.value == pytest.approx(STOOD, abs=0.3)
    assert level.lower < STOOD < level.upper
    assert begin.value == pytest.approx(STEP * SINCE, abs=3.0 * STEP)
    assert end.value == pytest.approx(STEP * UNTIL, abs=3.0 * STEP)


def test_one_that_stayed_where_it_was_is_told_so(tmp_path: Path) -> None:
    """What is stated at the begin explains as much and has no value to choose: it is the simpler one."""
    rng = np.random.default_rng(302)
    stated = np.repeat(rng.uniform(0.0, 40.0, COUNT // HOLD), HOLD)
    found = told(tmp_path, float(stated[SINCE]))
    assert [f.effect for f in found.accepted] == [HELD.identifier], found.statement


def test_off_is_a_share_of_nothing(tmp_path: Path) -> None:
    found = told(tmp_path, 0.0)
    (one,) = found.accepted
    assert one.effect in (INPUT.identifier, LEVEL.identifier), found.statement
    assert one.parameters[0 if one.effect == INPUT.identifier else 3].value == pytest.approx(
        -1.0 if one.effect == INPUT.identifier else 0.0, abs=0.05
    )


def test_nothing_stood_where_nothing_did(tmp_path: Path) -> None:
    assert not told(tmp_path, None).findings


def test_a_value_acts_in_the_place_of_what_is_stated() -> None:
    change = InputChange(5.0, 1.0, 2.5, is_level=True)
    low = np.array([0.0, 1.0, 2.0, 3.0])
    stated = np.array([1.0, 2.0, 7.0, 4.0])
    shares = change.shares(low, 1.0)
    assert (stated + change.change(stated, shares)).tolist() == [1.0, 5.0, 6.0, 4.0]


def test_its_value_may_be_as_far_beyond_what_is_stated_as_that_is_wide(tmp_path: Path) -> None:
    told(tmp_path, None)
    scenario, first = load_scenario(tmp_path / "scenario.yaml"), load_recording(tmp_path / "run_1")
    (term,) = [t for t in model_of(scenario, [first], ()).input_terms() if t.identifier == LEVEL.identifier]
    *_, level = term.parameters
    (stated,) = first.inputs
    least, most = float(stated.values.min()), float(stated.values.max())
    assert (level.unit, level.is_reading) == ("W", True)
    assert (level.lower, level.upper) == (0.0, pytest.approx(2.0 * most - least))  # no power is below 0


def test_a_temperature_may_stand_too_and_a_constant_does_not(tmp_path: Path) -> None:
    """5.76 degC are 278.91 K of a shelf that is stated between -40 and 20 degC."""
    text = SCENARIO.replace(
        "constant: 10 W}}}", "constant: 10 W}, shelf: {unit: degC, points: [[0 s, -40 degC], [40 s, 20 degC]]}}}"
    )
    built(STACK, text, tmp_path)
    scenario = load_scenario(tmp_path / "scenario.yaml")
    power = np.full(COUNT, 10.0)
    path = recorded(tmp_path / "run_1", power, temperatures(power), np.random.default_rng(1), tuple(CHANNELS))
    found = level_inputs([scenario], [load_recording(path)])
    ((term, end),) = found.items()
    assert end == ("heater", "shelf")
    assert (term.parameters[-1].lower, term.parameters[-1].upper) == (pytest.approx(173.15), pytest.approx(353.15))
    given = scenario.components["heater"].outputs["shelf"]
    change = input_change(term, (1.0, 10.0, 20.0, 278.91), given)
    assert change.amount == pytest.approx(5.76)
