"""Gains on unfitted readings and agreement with the noise, against closed forms and drawn noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import chdtr

from cosim.unit.protocol import Array
from diagnosis.judge.agreement import LEVEL, agreement
from diagnosis.judge.gain import ERRORS, LEAST, gain, loss, stands_alone
from diagnosis.judge.unfitted import Predicted, Readings, readings_of, set_aside, wild_readings
from diagnosis.recording.quantity import Target
from diagnosis.recording.recording import Channel
from tests.verdict.lines import Lines, Run, Series

COUNT = 400


def channel(number: int, times: Array, is_given: bool) -> Channel:
    target = Target("coil", (number + 1,), "temperature", "K")
    return Channel(f"coil[{number + 1}].temperature", target, times, np.zeros(len(times)), 1.0, is_given)


def readings(channels: int = 1, is_given: bool = True, count: int = COUNT) -> Readings:
    times = np.linspace(0.0, 100.0, count)
    used = np.ones(count, dtype=bool)
    made = [
        Series(
            Channel(
                f"coil[{n + 1}].temperature",
                Target("coil", (n + 1,), "temperature", "K"),
                times,
                np.zeros(count),
                1.0,
                is_given,
            ),
            np.arange(count),
            used,
        )
        for n in range(channels)
    ]
    return readings_of([Run(tuple(made))], ["steps"])


def test_the_gain_of_the_right_model_is_the_square_of_what_it_adds():
    """sum(r0^2) - sum(r1^2) with r0 = delta + noise: expectation sum(delta^2), standard error 2 sqrt(sum(delta^2))."""
    delta = 0.2 * np.sin(np.linspace(0.0, 20.0, COUNT))
    found = []
    for seed in range(200):
        noise = np.random.default_rng(seed).standard_normal(COUNT)
        found.append(gain(Predicted(noise + delta, noise + delta), Predicted(noise, noise), readings()))
    square = float(delta @ delta)
    assert np.mean([g.total for g in found]) == pytest.approx(square, abs=4.0 * 2.0 * np.sqrt(square / 200))
    assert np.std([g.total for g in found]) == pytest.approx(2.0 * np.sqrt(square), rel=0.2)
    assert found[0].white == pytest.approx(2.0 * np.sqrt(square), rel=1e-12)


def test_a_spurious_law_hardly_ever_gains():
    """What is not there is a loss of delta^2 on average: 20 to 1 is passed in less than one of twenty draws."""
    delta = 0.3 * np.sin(np.linspace(0.0, 20.0, COUNT))
    passed = 0
    for seed in range(300):
        noise = np.random.default_rng(seed).standard_normal(COUNT)
        passed += gain(Predicted(noise, noise), Predicted(noise + delta, noise + delta), readings()).is_gain
    assert passed <= 3  # expectation -delta^2 = -18, standard error 8.5: 6 lies 2.8 errors above


def test_errors_that_are_alike_for_a_while_ask_for_more():
    """The same fall of the sum of squares counts where residuals are noise, and not where a slow error remains."""
    delta = 0.2 * np.ones(COUNT)
    noise = np.random.default_rng(3).standard_normal(COUNT)
    clean = gain(Predicted(noise + delta, noise), Predicted(noise, noise), readings())
    slow = noise + 3.0 * np.sin(np.linspace(0.0, 12.0, COUNT))
    rough = gain(Predicted(slow + delta, slow), Predicted(slow, slow), readings())
    assert LEAST <= clean.needed < 2.0 * LEAST
    assert rough.doubt > 3.0
    assert rough.needed > 5.0 * clean.needed
    assert rough.needed >= ERRORS * np.sqrt(rough.error**2 - rough.white**2)


def test_a_channel_that_another_one_pays_for_is_told():
    """2.1 instead of 1.3 deviations in one channel, while the sum over both falls."""
    noise = np.random.default_rng(0).standard_normal((2, COUNT))
    wave = np.sin(np.linspace(0.0, 30.0, COUNT))
    before = np.concatenate([noise[0] + 4.0 * wave, noise[1] + 1.2 * wave])
    after = np.concatenate([noise[0], noise[1] + 2.6 * wave])
    found = gain(Predicted(before, before), Predicted(after, after), readings(2))
    assert found.total > found.needed
    assert found.worse == ("coil[2].temperature of steps",)


def test_a_channel_that_rises_by_no_more_than_chance_is_told_too():
    """The same sum falls; of the second channel 1.1 times as much is left, by an error that lasts for long."""
    noise = np.random.default_rng(0).standard_normal((2, COUNT))
    wave, slow = np.sin(np.linspace(0.0, 30.0, COUNT)), np.sin(np.linspace(0.0, 3.0, COUNT)) ** 8
    before = np.concatenate([noise[0] + 4.0 * wave, 0.3 * noise[1] + 3.0 * slow])
    after = np.concatenate([noise[0], 0.3 * noise[1] + 3.3 * slow])
    found = gain(Predicted(before, before), Predicted(after, after), readings(2))
    assert found.total > found.needed
    assert found.worse == ()
    assert found.rising == ("coil[2].temperature of steps",)
    assert gain(Predicted(after, after), Predicted(before, before), readings(2)).rising == ()


def test_noise_is_rejected_in_one_of_a_thousand_and_the_limit_is_that_of_chi_square():
    limit = agreement(np.random.default_rng(0).standard_normal(COUNT), readings()).limit
    assert 1.0 - chdtr(COUNT, COUNT * limit) == pytest.approx(LEVEL, rel=1e-6)
    rejected = sum(
        agreement(np.random.default_rng(seed).standard_normal(3 * COUNT), readings(3)).is_rejected
        for seed in range(400)
    )
    assert rejected <= 3  # two tests at 0.001 each: 0.8 expected


def test_a_model_that_is_wrong_by_half_the_noise_is_rejected():
    noise = np.random.default_rng(1).standard_normal(COUNT)
    told = agreement(noise + np.sin(np.linspace(0.0, 9.0, COUNT)), readings())
    assert told.is_rejected
    assert told.worst is not None
    assert told.worst.multiple == pytest.approx(np.sqrt(1.5), rel=0.1)


def test_a_noise_that_was_estimated_has_an_error_of_its_own():
    white = np.random.default_rng(0).standard_normal(COUNT)
    given, estimated = (agreement(white, readings(1, g)).limit for g in (True, False))
    assert estimated > given + 0.3  # 2 * 3.09 * 1.2 / sqrt(400)


def test_two_wild_readings_in_a_row_and_one_at_a_switch_do_not_count_either():
    """14 deviations each in a noise of one; five in a row, or many of them, are no wild readings."""
    run = readings()
    noise = np.random.default_rng(4).standard_normal(COUNT)
    wild = noise.copy()
    wild[[50, 51, 200]] += (14.0, 13.0, -11.0)
    assert np.flatnonzero(set_aside(run, wild)).tolist() == [50, 51, 200]
    assert agreement(wild, run).wild == 3
    assert not agreement(wild, run).is_rejected
    stretch = noise.copy()
    stretch[100:105] += 14.0
    assert not set_aside(run, stretch).any()
    assert agreement(stretch, run).is_rejected
    many = noise.copy()
    many[10:-10:15] += 14.0  # 26 of 400
    assert not set_aside(run, many).any()
    assert agreement(many, run).is_rejected
    beside = noise.copy()
    beside[100:110] += 14.0 * np.exp(-np.arange(10.0) / 3.0)  # a response that fades is none
    assert not set_aside(run, beside).any()


def test_the_first_and_the_last_reading_may_be_wild_where_the_one_neighbour_is_met():
    run, noise = readings(), np.random.default_rng(5).standard_normal(COUNT)
    ends = noise.copy()
    ends[[0, -1]] = 15.0, -15.0
    ends[[1, -2]] = 0.3, -0.5
    assert np.flatnonzero(set_aside(run, ends)).tolist() == [0, COUNT - 1]
    settling = ends.copy()  # a start that the model does not have lasts for several readings
    settling[:4] = 15.0, 12.0, 9.5, 7.0
    assert np.flatnonzero(set_aside(run, settling)).tolist() == [COUNT - 1]


def test_single_wild_readings_are_known_by_their_neighbours_and_do_not_count():
    values = np.random.default_rng(2).standard_normal(COUNT)
    values[[50, 200]] += (30.0, -25.0)
    values[300:] += 40.0  # a step is none
    assert np.flatnonzero(wild_readings(values, 1.0)).tolist() == [50, 200]
    run = readings()
    residuals = np.random.default_rng(4).standard_normal(COUNT)
    residuals[[50, 200]] = 30.0
    with_wild = replace(run, is_wild=np.isin(np.arange(COUNT), [50, 200]))
    for one in (run, with_wild):  # by what the model leaves, and by the readings alone
        assert not agreement(residuals, one).is_rejected
        assert agreement(residuals, one).wild == 2


def test_readings_are_those_that_a_model_uses():
    made = readings_of(Lines(np.zeros(400)).runs, ["line"])
    assert len(made) == 400
    assert len(set(made.block.tolist())) == 10


def predicted(residuals: Array) -> Predicted:
    return Predicted(residuals, residuals)


def test_readings_that_were_taken_while_an_input_switched_are_evidence_for_no_law():
    """Ten single readings missed by 40 deviations, by a tenth less with the law: nothing is gained by it."""
    own, noise, jumps = readings(), np.random.default_rng(5).standard_normal(COUNT), np.zeros(COUNT)
    jumps[20::40] = 40.0
    without, with_it = (predicted(noise + f * jumps) for f in (1.0, 0.9))
    assert np.array_equal(np.flatnonzero(stands_alone(with_it.residuals, own)), np.arange(20, 400, 40))
    found = gain(without, with_it, own)
    assert found.total == pytest.approx(0.0, abs=1e-9)
    assert not found.is_gain
    lasting = predicted(
        noise + 2.0 * np.sin(np.linspace(0.0, 25.0, COUNT))
    )  # what lasts for several readings counts whole
    assert gain(lasting, predicted(noise), own).total == pytest.approx(
        float(np.sum(loss(lasting.residuals) - loss(noise)))
    )
