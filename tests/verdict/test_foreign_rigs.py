"""Sentences that were false on rigs that the authors of the library did not make (docs/strangers.md, fourth set)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge.agreement import agreement
from diagnosis.judge.diagnosis import Doubt, Moved, Used, Verdict
from diagnosis.judge.doubts import doubted, without_explained_starts
from diagnosis.judge.headline import how_right
from diagnosis.judge.location import Remainder
from diagnosis.judge.unfitted import readings_of
from diagnosis.judge.verdict import _open_ones
from diagnosis.recording.quantity import Target
from diagnosis.recording.recording import Channel
from diagnosis.report.sentences import clocks, improvement
from diagnosis.report.undecided import what_decides
from tests.diagnosis.report_examples import CONTACT, LAG
from tests.verdict.lines import Run, Series
from tests.verdict.test_honest_statements import ADEQUACY, diagnosis

START = Doubt(
    "second", "coil[1].temperature", "start", "begins at 31 degC", "state it", False, 0.0, 1.0, 16.0, is_far=True
)
OFF_AT_FIRST = replace(
    LAG,
    effect="sensor_offset_in_interval",
    place="coil[1].temperature (second)",
    recording="second",
    channels=("coil[1].temperature (second)",),
    intervals=((-0.25, 2.9),),
)


def test_readings_of_a_swing_that_the_model_meets_are_not_wild() -> None:
    """Four readings in a period: its crests stand out from both neighbours by 40 deviations of the noise."""
    times = np.arange(400.0)
    swing = 40.0 * np.cos(0.5 * np.pi * times)
    noise = np.random.default_rng(8).standard_normal(400)
    channel = Channel(
        "mass.position", Target("mass", (1,), "position", "m"), times, swing + noise, 1.0, is_deviation_given=True
    )
    run = readings_of([Run((Series(channel, np.arange(400), np.ones(400, dtype=bool)),))], ["first"])
    assert np.count_nonzero(run.is_wild) > 50  # by its neighbours alone
    found = agreement(noise, run)
    assert found.wild == 0
    assert found.samples == 400
    single = noise.copy()
    single[200] += 20.0  # a crest that is wild all the same
    assert agreement(single, run).wild == 1


def test_a_sensor_that_is_off_at_first_does_not_explain_a_start_that_is_stated_wrongly() -> None:
    fault, physics = doubted([OFF_AT_FIRST, CONTACT], [START])
    assert not fault.is_accepted
    assert not physics.is_accepted
    assert fault.doubts[0].startswith("first the start has to be stated: second, coil[1].temperature")
    later = replace(OFF_AT_FIRST, intervals=((40.0, 50.0),))
    fault, physics = doubted([later, CONTACT], [START])
    assert fault.is_accepted  # it has nothing to do with the start
    assert not physics.is_accepted


def test_a_bias_that_was_found_leaves_no_start_to_state() -> None:
    bias = replace(LAG, effect="sensor_bias", channels=("coil[1].temperature",), recording="second")
    programme = replace(START, kind="programme")
    assert without_explained_starts([START, programme], [bias]) == (programme,)
    assert without_explained_starts([START], [replace(bias, is_accepted=False)]) == (START,)


def test_a_law_beside_one_of_a_sensor_is_not_called_one_of_a_sensor() -> None:
    nameless = replace(LAG, standing=type(LAG.standing).UNNAMED)
    (alone,) = _open_ones([nameless])
    assert alone.startswith("what improves the prediction is described by a law of a sensor or an input")
    (beside,) = _open_ones([nameless, CONTACT])
    assert beside.startswith("part of what improves the prediction is described")


def test_per_cent_that_tell_no_difference_stand_with_chi_square() -> None:
    chi = {"before": 40000.0, "recalibrated": 111.0, "after": 1.13}
    close = replace(ADEQUACY, explained=0.99999, by_recalibration=0.997, chi_square=chi)
    assert "recalibration alone more than 99 %; chi-square per reading 111 by it, 1.13 now" in how_right(close, True)
    assert "chi-square" not in how_right(replace(close, by_recalibration=0.5), True)


def test_what_is_left_in_several_recordings_has_come_back_already() -> None:
    told = replace(
        diagnosis(Verdict.CANNOT_TELL),
        findings=(),
        next_experiment=None,
        adequacy=replace(ADEQUACY, is_irregular=False),
        left=(Remainder("belt.speed (first)", 0.6, 2.8, 40.0, 4.0),),
    )
    fits = [
        replace(told.fit[0], recording=name, is_held_out=False, whiteness={"after": z})
        for name, z in (("first", 40.0), ("second", -35.0), ("third", 1.0))
    ]
    assert what_decides(replace(told, fit=tuple(fits))).startswith("What is left is in 2 of 3 training recordings")
    assert what_decides(replace(told, fit=tuple(fits[::2]))).startswith("Repeat the recording in which most is left")
    # Of noise that lasts for several readings neither is true: it is in all recordings, and of no rig.
    assert ADEQUACY.worst is not None
    lasting = replace(ADEQUACY, is_irregular=False, worst=replace(ADEQUACY.worst, correlation=0.5))
    for chosen in (fits, fits[::2]):
        text = what_decides(replace(told, fit=tuple(chosen), adequacy=lasting))
        assert text.startswith("What is left may be noise that lasts for several readings")


def test_rows_without_the_numbers_of_the_day_stand_beside_what_judged() -> None:
    """ "Agrees" stood above a chi-square of 9.98 that was not the one that had judged."""
    told = diagnosis(Verdict.RECALIBRATED)
    day = (Moved("room of third", "K", 0.6, False, 2.0),)
    chi = {"before": 25.0, "recalibrated": 1.03, "after": 1.03}
    with_day = improvement(replace(told, adequacy=replace(ADEQUACY, day=day, chi_square=chi)))
    assert "(held out, numbers of the day as written down)" in with_day
    assert "with those numbers estimated, as judged: 25.0 before, 1.03 recalibrated only, 1.03 after" in with_day
    assert "as judged" not in improvement(replace(told, adequacy=replace(ADEQUACY, day=(), chi_square=chi)))


@pytest.mark.parametrize(
    ("zero", "text"),
    [(100.0, "Times are counted from the scenario's zero; in the clock of its table that is 100 s"), (0.0, "")],
)
def test_times_are_said_to_be_counted_from_another_zero_than_the_table_s(zero: float, text: str) -> None:
    told = replace(
        diagnosis(Verdict.CANNOT_TELL), recordings=(Used("second", "second", False, 0.0, 20.0, ("a",), zero=zero),)
    )
    assert clocks(told).startswith(text)
    assert bool(clocks(told)) == bool(text)
    epoch = replace(told, recordings=(replace(told.recordings[0], zero=1.7e9),))
    assert clocks(epoch) == ""  # a date
