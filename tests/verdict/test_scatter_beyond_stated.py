"""Readings that scatter by more than they state, and a model that leaves no more than that."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cosim.unit.protocol import Array
from diagnosis.judge.agreement import Agreement, agreement, times_louder
from diagnosis.judge.diagnosis import Verdict
from diagnosis.judge.headline import headline, noise_of, notes
from diagnosis.recording.noise import estimate_noise
from tests.diagnosis.report_examples import ADEQUACY
from tests.search.line_model import TIME
from tests.verdict.lines import NOISE, Lines
from tests.verdict.test_gain_and_agreement import COUNT, readings
from tests.verdict.test_invariants import LIKE, answer, truths

LINE = 0.3 + 0.5 * TIME
DRAWN = np.random.default_rng(4).standard_normal(COUNT)
EVERY = np.arange(COUNT)


def judged(residuals: Array, measured: Array | None = None, is_given: bool = True) -> Agreement:
    """Agreement of one channel whose noise is stated as 1 and that measured the residuals, or something else."""
    whole = readings(is_given=is_given)
    values = residuals if measured is None else measured
    return agreement(residuals, replace(whole, channels=(replace(whole.channels[0], values=values),)))


def test_white_readings_of_more_than_the_stated_noise_do_not_reject_by_their_scatter() -> None:
    found = judged(1.5 * DRAWN)
    assert found.is_rejected
    assert found.is_met_by_scatter
    assert found.louder["coil[1].temperature"] == pytest.approx(1.5, rel=0.1)


@pytest.mark.parametrize(
    ("name", "residuals"),
    [
        ("a wave", 1.5 * DRAWN + np.sin(EVERY / 15.0)),
        ("an offset", 1.5 * DRAWN + 0.5),
        ("a wave of four readings: neighbours differ as if it were white", 1.5 * DRAWN + np.cos(np.pi * EVERY / 2.0)),
        ("every second reading", 1.5 * DRAWN + np.cos(np.pi * EVERY)),
        ("a jump for a while", 1.5 * DRAWN + 2.0 * ((EVERY > 100) & (EVERY < 140))),
        ("what comes back after eight readings", 1.5 * DRAWN + 3.0 * (EVERY % 8 == 0)),
        ("wild readings", DRAWN + 8.0 * (EVERY % 25 == 5)),
    ],
)
def test_what_is_alike_at_any_interval_or_stands_out_is_no_scatter(name: str, residuals: Array) -> None:
    found = judged(residuals)
    assert found.is_rejected, name
    assert not found.is_met_by_scatter, name
    assert found.louder == {}


def test_scatter_of_the_simulation_is_none_of_the_readings() -> None:
    """The readings themselves scatter by the stated noise; what the model adds from one to the next is its error."""
    found = judged(1.5 * DRAWN, np.random.default_rng(8).standard_normal(COUNT))
    assert found.is_irregular
    assert not found.is_met_by_scatter


def test_noise_that_nobody_stated_is_not_taken_to_be_larger() -> None:
    assert not judged(2.0 * DRAWN, is_given=False).is_met_by_scatter


def test_a_few_readings_do_not_tell() -> None:
    whole = readings(count=25)
    few = 2.0 * DRAWN[:25]
    found = agreement(few, replace(whole, channels=(replace(whole.channels[0], values=few),)))
    assert found.is_rejected
    assert not found.is_met_by_scatter


def test_every_channel_that_rejects_has_to_scatter() -> None:
    whole = readings(2)
    other = DRAWN[::-1] + np.sin(EVERY / 15.0)
    rows = np.concatenate([1.5 * DRAWN, other])
    channels = tuple(replace(c, values=v) for c, v in zip(whole.channels, (1.5 * DRAWN, other)))
    found = agreement(rows, replace(whole, channels=channels))
    assert [c.is_rejected for c in found.channels] == [True, True]
    assert [c.is_beyond_scatter for c in found.channels] == [False, True]
    assert not found.is_met_by_scatter


def test_white_noise_of_any_size_passes_in_nearly_every_draw_and_a_small_wave_in_few() -> None:
    """A wave of 0.6 of the noise, of 40 readings; 200 draws each."""
    passed = {False: 0, True: 0}
    for seed in range(200):
        drawn = 1.5 * np.random.default_rng(seed).standard_normal(COUNT)
        for has_wave in passed:
            found = judged(drawn + (0.9 * np.sin(EVERY * 2.0 * np.pi / 40.0) if has_wave else 0.0))
            assert found.is_rejected
            passed[has_wave] += found.is_met_by_scatter
    assert passed[False] >= 190
    assert passed[True] <= 10


def test_the_answer_agrees_by_the_scatter_and_says_that_the_stated_noise_would_reject() -> None:
    told = answer(Lines(LINE, 1, noise=0.5 * NOISE), Lines(LINE, 2, noise=0.5 * NOISE))
    assert told.word is Verdict.RECALIBRATED
    assert "scatter of neighbouring readings, which is more than the noise that is stated," in told.statement
    (note,) = [n for n in told.below if "Correct `noise`" in n]
    assert "By the noise that is stated the readings would reject the model" in note
    times = re.search(r"by ([\d.]+) times \(signal\)", note)
    assert times is not None
    assert float(times[1]) == pytest.approx(2.0, abs=0.1)


def test_a_model_that_is_right_as_it_is_stays_consistent() -> None:
    told = answer(Lines(0.0 * TIME, 1, noise=0.6 * NOISE), Lines(0.0 * TIME, 2, noise=0.6 * NOISE))
    assert told.word is Verdict.CONSISTENT


@LIKE
@given(truths(), st.integers(0, 999), st.sampled_from((0.4, 0.7)))
def test_it_never_agrees_beyond_what_the_readings_scatter_by_themselves(
    signals: tuple[Array, Array], seed: int, share: float
) -> None:
    training, judge = (Lines(s, seed + 1000 * n, noise=share * NOISE) for n, s in enumerate(signals))
    told = answer(training, judge)
    if told.word in (Verdict.CONSISTENT, Verdict.RECALIBRATED):
        left = NOISE * share * told.accepted.after.residuals
        own = estimate_noise(TIME, judge.measured)
        assert np.sqrt(np.mean(left**2)) < 1.2 * max(own, share * NOISE)


def test_training_readings_alone_are_named() -> None:
    """The held-out ones are met within the stated noise: nothing else is said of them."""
    only = replace(ADEQUACY, is_rejected=False, is_training_rejected=True, louder={"a.b": 1.31}, day=())
    assert not only.is_open
    assert noise_of(only) == "the stated noise of the sensors"
    assert headline(Verdict.RECALIBRATED, [], only).endswith(
        "within the stated noise of the sensors once its own parameters are recalibrated."
    )
    (note,) = notes(Verdict.RECALIBRATED, [], only)[:1]
    assert note.startswith("By the noise that is stated the training readings would reject the model")
    assert "1.31 times (a.b)" in note


def test_channels_of_several_recordings_carry_their_title_in_a_search() -> None:
    assert times_louder({"a": 2.0}, ["a (monday)"]) == 2.0
    assert times_louder({"a": 2.0}, ["ab (monday)", "b"]) == 1.0
    assert times_louder({}, ["a"]) == 1.0
