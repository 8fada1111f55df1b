"""Something of the rig that was another in one recording: found in the search, told as neither a sensor nor a law."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.formula import to_base
from cosim.run import run
from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.faults.law import PARAMETER, RATE
from diagnosis.faults.model import with_faults
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.judge.of_a_day import hidden_fault
from diagnosis.models.build import model_of, with_rig_faults
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.models.systems.changed_run import Changed
from diagnosis.recording.recording import load_recording
from diagnosis.search.problem import Point
from diagnosis.search.search import Settings
from tests.check.test_changed_rig import (
    FANNED,
    LAMP,
    SINCE,
    UNTIL,
    Rate,
    course_of,
    fan_from_then_on,
    lamp_for_a_while,
    three_runs,
)
from tests.check.test_other_course import C_1, C_2, CHANNELS, COUNT, G_OUT, HOLD, SCENARIO, STACK, G, recorded
from tests.systems.rigs import built


def _told(folder: Path, second: Rate) -> Diagnosis:
    first, other, third = map(load_recording, three_runs(folder, second))
    scenario = load_scenario(folder / "scenario.yaml")
    return diagnose(scenario, [first, other], [third], Settings(), options=Options(is_brief=True)).diagnosis


def _loses_more_when_hot(t: float, x: Array, u: float) -> Array:
    """A law of the rig, in every recording: nothing of one alone."""
    through = G * (x[0] - x[1])
    return np.array([(u - through) / C_1, (through - G_OUT * (x[1] - 295.0) - 0.02 * (x[1] - 295.0) ** 2) / C_2])


def test_a_parameter_that_changed_is_named_with_its_size_and_instant(tmp_path: Path) -> None:
    found = _told(tmp_path, fan_from_then_on)
    assert found.verdict is Verdict.MEASUREMENT_FAULT, found.statement
    assert found.statement.startswith(
        "In one recording the rig was another than in the others: parameter of the rig that was another for a while, "
        "stack.G_out (run_2)."
    )
    (one,) = found.accepted
    assert one.effect == PARAMETER.identifier
    share, begin, _ = one.parameters
    assert share.value == pytest.approx(FANNED / G_OUT - 1.0, rel=0.03)
    assert begin.value == pytest.approx(SINCE, abs=60.0)


def test_heat_from_elsewhere_is_something_that_acted_on_the_rig(tmp_path: Path) -> None:
    found = _told(tmp_path, lamp_for_a_while)
    assert found.verdict is Verdict.MEASUREMENT_FAULT, found.statement
    assert "something that acted on the rig for a while, derivative of stack.block (run_2)" in found.statement
    (one,) = found.accepted
    assert one.effect == RATE.identifier
    rate, begin, end = one.parameters
    assert (rate.unit, rate.value) == ("(K)/s", pytest.approx(LAMP / C_2, rel=0.03))
    assert (begin.value, end.value) == (pytest.approx(SINCE, abs=60.0), pytest.approx(UNTIL, abs=60.0))


def test_a_law_that_one_recording_alone_reaches_is_no_change_of_the_rig(tmp_path: Path) -> None:
    """A valve of the block that opens above 325 K: only the second run, of three times the power, comes there."""

    def opens(t: float, x: Array, u: float) -> Array:
        through = G * (x[0] - x[1])
        loss = G_OUT * (x[1] - 295.0) + 4.0 * max(x[1] - 325.0, 0.0)
        return np.array([(u - through) / C_1, (through - loss) / C_2])

    built(STACK, SCENARIO, tmp_path)
    recordings = []
    for number in (1, 2, 3):
        rng = np.random.default_rng(200 + number)
        power = np.repeat(rng.uniform(0.0, 110.0 if number == 2 else 28.0, COUNT // HOLD), HOLD)
        folder = recorded(tmp_path / f"run_{number}", power, course_of(opens, power), rng, tuple(CHANNELS))
        recordings.append(load_recording(folder))
    hottest = [float(r.channels["stack.bottom"].values.max()) for r in recordings]
    assert hottest[1] > 335.0 > 325.0 > max(hottest[0], hottest[2])
    scenario = load_scenario(tmp_path / "scenario.yaml")
    found = diagnose(scenario, recordings[:2], recordings[2:], Settings(), options=Options(is_brief=True)).diagnosis
    assert "the rig was another" not in found.statement, found.statement
    assert not [f for f in found.accepted if f.effect in (PARAMETER.identifier, RATE.identifier)]


def test_nothing_of_a_rig_is_tried_where_no_recording_stands_out(tmp_path: Path) -> None:
    recordings = [load_recording(r) for r in three_runs(tmp_path, _loses_more_when_hot)]
    model = model_of(load_scenario(tmp_path / "scenario.yaml"), recordings, ())
    assert with_rig_faults(model, recordings, ()) is model
    assert not any(t.identifier in (PARAMETER.identifier, RATE.identifier) for t in with_faults(model).faults())


def test_what_is_fitted_is_what_cosim_run_gives(tmp_path: Path) -> None:
    """The scenario of a recording holds the change as a term; its results are those of compiled code."""
    recordings = [load_recording(r) for r in three_runs(tmp_path, fan_from_then_on)]
    plain = model_of(load_scenario(tmp_path / "scenario.yaml"), recordings, ())
    model = with_rig_faults(plain, recordings, {"run_2"})
    assert isinstance(model, ClosedLoopModel)
    zero = np.zeros(len(model.parameters))
    for identifier, place, amount in (
        (PARAMETER.identifier, "stack.G_out (run_2)", 1.0),
        (RATE.identifier, "derivative of stack.block (run_2)", LAMP / C_2),
    ):
        (term,) = [t for t in model.input_terms() if (t.identifier, t.place) == (identifier, place)]
        point = Point(zero, {term: (amount, SINCE, UNTIL)})
        results = run(model.model.scenario_at(point, 1))
        there = np.interp(recordings[1].channels["stack.bottom"].times, results["time"], results["stack.bottom"])
        index = list(recordings[1].channels).index("stack.bottom")
        assert model.predict(point, 1)[index] == pytest.approx(there, abs=0.05)  # of steps that hold an edge
        before = model.predict(Point(zero), 1)[index]
        assert np.max(np.abs(model.predict(point, 1)[index] - before)) > 1.0
        assert model.predict(point, 0)[index] == pytest.approx(model.predict(Point(zero), 0)[index], abs=1e-9)


@pytest.mark.parametrize("unit", ["K", "degC", "rpm", "bar", "1", "", "kg/h", "1/h", "mol/L", "min", "uL/min", "kJ"])
def test_an_amount_is_in_units_that_are_not_converted_again(unit: str) -> None:
    """What is fitted, and what the check tells, is counted in SI: 3600 times less of a flow in kg/h would be told."""
    change = Changed("rig", "state", unit, None, 1.0)
    assert to_base(change.unit_of_amount) == (1.0, 0.0)


def test_a_change_over_the_whole_recording_is_not_one_of_a_while(tmp_path: Path) -> None:
    recordings = [load_recording(r) for r in three_runs(tmp_path, fan_from_then_on)]
    model = with_faults(
        with_rig_faults(model_of(load_scenario(tmp_path / "scenario.yaml"), recordings, ()), recordings, {"run_2"})
    )
    (term,) = [t for t in model.input_terms() if t.place == "stack.G_out (run_2)"]
    _, begin, end = term.parameters
    point = Point(np.zeros(len(model.parameters)), {term: (1.0, begin.lower, end.upper)})
    assert "give it under `overrides` there" in hidden_fault(model, point, term)
