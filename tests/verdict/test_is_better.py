"""When another outcome of a search may take the place of the answer."""

from types import SimpleNamespace

import numpy as np

from diagnosis.judge.gain import is_better
from diagnosis.judge.unfitted import Predicted, Readings

COUNT = 400


def readings() -> Readings:
    zeros = np.zeros(COUNT, dtype=int)
    block = np.repeat(np.arange(10), COUNT // 10)
    channel = SimpleNamespace(name="coil[1].temperature", scatter=0.0, scatter_together=1.0, scatter_runs=1)
    return Readings(zeros, zeros, block, zeros.astype(bool), np.arange(COUNT), (channel,), (0,), ("held out",))


def test_one_that_leaves_noise_takes_the_place_of_one_that_leaves_three_times_as_much():
    noise = np.random.default_rng(1).standard_normal(COUNT)
    wrong = 3.0 * np.sign(np.sin(np.arange(COUNT))) + noise
    assert is_better(Predicted(wrong, wrong), Predicted(noise, noise), readings())
    assert not is_better(Predicted(noise, noise), Predicted(wrong, wrong), readings())


def test_one_that_runs_away_for_a_stretch_does_not():
    noise = np.random.default_rng(1).standard_normal(COUNT)
    wrong = 3.0 * np.sign(np.sin(np.arange(COUNT))) + noise
    away = noise.copy()
    away[:12] += 60.0  # squares of 43000 for 3600: Huber's function counts each of them as 464
    assert not is_better(Predicted(wrong, wrong), Predicted(away, away), readings())


def test_one_that_only_moves_the_room_does_not():
    """With the day's numbers estimated it leaves noise; as they are written down it leaves more than before."""
    noise = np.random.default_rng(1).standard_normal(COUNT)
    wrong = 3.0 * np.sign(np.sin(np.arange(COUNT))) + noise
    assert not is_better(Predicted(wrong, wrong), Predicted(noise, noise + 5.0), readings())
