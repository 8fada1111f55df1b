"""Whether "the model agrees" is true: by how far the model is from the truth, not by what its readings contain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge.diagnosis import ChannelFit, Diagnosis, Met, Moved, Used, Verdict
from evaluation.proof.answer import Answer
from evaluation.proof.departure import departures, is_within_noise, noise_limit
from evaluation.proof.headline import is_headline_true
from evaluation.proof.reference import Reference
from tests.diagnosis.report_examples import ADEQUACY
from tests.proof.examples import RADIATION, REFERENCE, SMALL, answer, diagnosis

#: Readings of each of four thermometers, and their noise [K].
COUNT, CHANNELS, NOISE = 400, 4, 0.3
TIME = np.linspace(0.0, 1.0, COUNT)
NULL = answer(kind="null", verdicts=("consistent", "recalibrated"))


def _told(
    error: float, wild: int = 0, room: float = 0.0, stated: float | None = None, channels: int = CHANNELS
) -> tuple[Diagnosis, Answer, Reference]:
    """A diagnosis that says "agrees", of a model that is off, with what the scorer knows.

    Args:
        error: Of the model [deviations], slow, in the first `channels` channels.
        wild: Wild readings of each channel, 15 deviations off and more.
        room: How much warmer than written the room of the held-out day is [K].
        stated: What the diagnosis takes the room for [K]; None: it does not ask.
        channels: That the model errs in.
    """
    rng = np.random.default_rng(7)
    met, fits, noises = [], [], {}
    for n in range(CHANNELS):
        name = f"coil[1,{n + 1}].temperature"
        noise = NOISE * rng.standard_normal(COUNT)
        noise[rng.permutation(COUNT)[:wild]] += 15.0 * NOISE * rng.choice([-1.0, 1.0], wild)
        departure = NOISE * error * np.sqrt(2.0) * np.sin(4.0 * np.pi * TIME) * (n < channels)
        plain = noise - departure + room
        with_day = plain - (stated or 0.0)
        sizes = [float(np.sqrt(np.mean(v**2))) for v in (plain, with_day, noise)]
        rmse = dict.fromkeys(("before", "recalibrated", "after"), sizes[0])
        square = {k: (v / NOISE) ** 2 for k, v in rmse.items()}
        fits.append(ChannelFit("tuesday", True, name, "K", rmse, square, square, COUNT))
        met.append(Met("tuesday", name, "K", sizes[1], COUNT))
        noises[name] = (sizes[2], NOISE)
    day = (Moved("ambient_offset of recording tuesday", "K", stated, False, stated / 0.5),) if stated else ()
    told = replace(
        diagnosis(verdict=Verdict.RECALIBRATED),
        fit=tuple(fits),
        adequacy=replace(ADEQUACY, day=day, met=tuple(met)),
        recordings=(Used("tuesday", "", True, 0.0, 1.0, tuple(noises)),),
    )
    floor = float(np.mean([(n / NOISE) ** 2 for n, _ in noises.values()]))
    samples = dict.fromkeys(noises, COUNT)
    return told, replace(NULL, room=room), replace(REFERENCE, samples=samples, noises=noises, floor=floor)


@pytest.mark.parametrize("wild", [0, 6])
@pytest.mark.parametrize(("room", "stated"), [(0.0, None), (0.6, 0.6), (0.6, 0.55)])
@pytest.mark.parametrize(("error", "is_true"), [(0.0, True), (0.2, True), (0.5, False), (1.0, False), (3.0, False)])
def test_a_model_agrees_as_far_as_it_is_near_the_truth(
    wild: int, room: float, stated: float | None, error: float, is_true: bool
) -> None:
    told, truth, reference = _told(error, wild, room, stated)
    assert is_headline_true(told, truth, SMALL, reference) is is_true
    # ... which the plain chi-square of readings with wild ones, or of another room, does not tell.
    if error == 0.0 and (wild or room):
        assert np.mean([f.chi_square["after"] for f in told.fit]) > noise_limit(COUNT * CHANNELS)


def test_the_room_has_to_be_the_true_one() -> None:
    assert is_within_noise(*_told(0.0, room=0.6, stated=0.6))
    told, truth, reference = _told(0.0, room=0.6, stated=0.6)
    # a room that makes up for something else: the readings are met, and the sentence about the room is false
    assert not is_within_noise(told, replace(truth, room=0.0), reference)
    assert not is_within_noise(told, replace(truth, room=-0.6), reference)
    assert is_within_noise(told, replace(truth, room=0.4), reference)  # by less than half of its doubt
    assert not is_within_noise(*_told(0.0, room=0.6))  # a diagnosis that takes nothing for granted


def test_one_channel_that_is_off_counts() -> None:
    assert not is_within_noise(*_told(1.0, channels=1))
    assert not is_within_noise(*_told(1.0, wild=6, channels=1))
    assert is_within_noise(*_told(0.3, channels=1))


def test_the_departure_is_that_of_the_model_whatever_the_readings_contain() -> None:
    for wild in (0, 6):
        told, _, reference = _told(1.0, wild)
        assert [square for _, square in departures(told, reference)] == pytest.approx([1.0] * CHANNELS, abs=0.35)


def test_what_is_concealed_and_shows_is_false_however_near_the_model_is() -> None:
    told, _, reference = _told(0.0)
    assert not is_headline_true(told, answer(RADIATION), SMALL, reference)
    assert is_headline_true(told, answer(RADIATION), SMALL, replace(reference, training_gain=19.0))


def test_a_reference_of_before_has_the_floor_of_all_readings() -> None:
    for error, is_true in ((0.0, True), (0.2, True), (0.5, False)):
        told, truth, reference = _told(error, wild=6)
        before = replace(reference, noises={})
        assert is_within_noise(told, truth, before) is is_true
