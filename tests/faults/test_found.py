"""Faults of a day are found where they are, beside laws, and never in recordings that have none."""

import numpy as np
import pytest

from diagnosis.judge.acceptance import accept
from diagnosis.judge.adequacy import adequacy
from diagnosis.judge.diagnosis import Searched, Verdict
from diagnosis.judge.findings import findings
from diagnosis.judge.of_a_day import is_shown_there_alone
from diagnosis.judge.unfitted import left_out_readings, left_out_stretches
from diagnosis.judge.verdict import verdict
from tests.faults.rig import NAMES, STOP, Wrong, faulty, found, interval, recorded, scenario

#: Begin and end are found within this share of the recording.
CLOSE = 0.05 * STOP


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return scenario(tmp_path_factory.mktemp("rig"))


def named(outcome):
    return {str(t): t for t in outcome.best.terms}


@pytest.mark.parametrize(
    ("amount", "kind", "strength"), [(1.5, "sensor_offset_in_interval", 1.5), (None, "sensor_stuck_in_interval", 1.0)]
)
def test_a_thermometer_that_is_wrong_for_a_while_is_a_fault_of_that_sensor_then_and_no_physics(
    made, amount, kind, strength
):
    recordings = recorded(made, 1, wrong=[Wrong(NAMES[1], 0.4, 0.6, amount, recording=1)])
    model, outcome = faulty(made, recordings), found(made, recordings)
    (term,) = outcome.best.terms
    assert str(term) == f"{kind} at {NAMES[1]} (second)"
    assert term.recording == 1
    assert interval(outcome, term) == pytest.approx((0.4 * STOP, 0.6 * STOP), abs=CLOSE)
    assert outcome.best.fit.point.terms[term][0] == pytest.approx(strength, abs=0.15)
    titles = [r.title for r in recordings]
    accepted = accept(
        model,
        outcome,
        left_out_stretches(model, titles),
        left_out_stretches(model, titles),
        lambda t: is_shown_there_alone(t, outcome.best.fit.point.terms[t], model, None),
        lambda: left_out_readings(model, titles),
    )
    (finding,) = findings(model, outcome, accepted, titles)
    assert finding.is_accepted
    assert finding.recording == "second"
    right = adequacy(accepted, left_out_stretches(model, titles).readings, ())
    word = verdict(outcome, [finding], right, Searched())
    assert word is Verdict.MEASUREMENT_FAULT
    assert finding.channels == (f"{NAMES[1]} (second)",)
    assert finding.is_named
    ((begin, end),) = finding.intervals
    assert 0.38 * STOP < begin < end < 0.62 * STOP


def test_a_heater_that_gave_more_for_a_while_is_a_fault_of_its_input(made):
    fault = ("input_gain_in_interval at power of coil[1] (first)", (0.1, 200.0, 330.0))
    outcome = found(made, recorded(made, 2, [fault]))
    (term,) = outcome.best.terms
    assert str(term) == fault[0]
    gain, begin, end = outcome.best.fit.point.terms[term]
    assert gain == pytest.approx(0.1, abs=0.02)
    assert (begin, end) == pytest.approx((200.0, 330.0), abs=CLOSE)


def test_a_heater_that_was_on_before_the_first_command_is_told(made):
    fault = ("unstated_input_in_interval at power of coil[2] (second)", (0.2, 40.0, 100.0))
    outcome = found(made, recorded(made, 2, [fault]))
    (term,) = outcome.best.terms
    assert str(term) == fault[0]
    power, begin, end = outcome.best.fit.point.terms[term]
    assert power == pytest.approx(0.2, rel=0.15)
    assert (begin, end) == pytest.approx((40.0, 100.0), abs=CLOSE)


@pytest.mark.slow
def test_two_sensors_at_fault_are_found_beside_a_law(made):
    law = ("neighbour_heat at all coils", (0.03,))
    wrong = [Wrong(NAMES[0], 0.3, 0.5, 2.0), Wrong(NAMES[1], 0.6, 0.8, -2.0, recording=1)]
    outcome = found(made, recorded(made, 3, [law], wrong))
    assert set(named(outcome)) == {
        law[0],
        f"sensor_offset_in_interval at {NAMES[0]} (first)",
        f"sensor_offset_in_interval at {NAMES[1]} (second)",
    }
    values = outcome.best.fit.point.terms
    assert values[named(outcome)[law[0]]][0] == pytest.approx(0.03, abs=0.006)


@pytest.mark.slow
def test_a_sensor_and_an_input_at_fault_are_both_found(made):
    fault = ("input_gain_in_interval at power of coil[1] (second)", (0.15, 150.0, 300.0))
    outcome = found(made, recorded(made, 3, [fault], [Wrong(NAMES[1], 0.3, 0.5, 2.0)]))
    assert set(named(outcome)) == {fault[0], f"sensor_offset_in_interval at {NAMES[1]} (first)"}


@pytest.mark.slow
def test_one_sensor_that_is_wrong_twice_is_two_faults(made):
    wrong = [Wrong(NAMES[0], 0.2, 0.35, 2.0), Wrong(NAMES[0], 0.6, 0.8, -1.5)]
    outcome = found(made, recorded(made, 4, wrong=wrong))
    spans = sorted(interval(outcome, t) for t in outcome.best.terms)
    assert {t.identifier for t in outcome.best.terms} == {"sensor_offset_in_interval"}
    assert np.array(spans) == pytest.approx(np.array([[0.2, 0.35], [0.6, 0.8]]) * STOP, abs=CLOSE)


@pytest.mark.parametrize(
    "law", [("radiation at all coils", (3e-4,)), ("sensor_bias at coil[1].temperature", (0.2,)), None]
)
def test_what_holds_on_every_day_or_not_at_all_is_no_fault_of_one(made, law):
    outcome = found(made, recorded(made, 5, [law] if law else []))
    assert not [t for t in outcome.best.terms if t.recording is not None]
