"""Looks for the amplitude at which a composed law leaves what is wanted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evaluation.proving.composed.strength import AIM, LEAST_IN_TRAINING, LEFT, Left
from evaluation.proving.effects.effect import STRENGTHS, Strength


class NoLaw(Exception):
    """None of many compositions can be made strong enough on a rig."""


@dataclass(frozen=True)
class Wanted:
    """Chi-square per sample that a recalibration is to leave held out."""

    held_out: float

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Wanted:
        """Log-uniform."""
        return cls(float(AIM[0] * (AIM[1] / AIM[0]) ** rng.random()))

    def corrected(self, amount: float, left: Left) -> float | None:
        """The amount with which it should come out, the rest taken as proportional; None: training shows too little."""
        if not np.isfinite(left.held_out) or left.held_out <= 1.01 or left.training < LEAST_IN_TRAINING:
            return None
        return amount * float(np.sqrt((self.held_out - 1.0) / (left.held_out - 1.0)))


def amount_of(amounts: Sequence[float], left: Sequence[Left], wanted: Wanted) -> float | None:
    """The least amount at which the wanted chi-square is left; None where no amount does it, or training shows nothing.

    Args:
        amounts: Rising.
        left: With each of them.
        wanted: See there.
    """
    rests = np.array([max(one.held_out - 1.0, 1e-12) for one in left])
    goal = wanted.held_out - 1.0
    above = np.flatnonzero(rests >= goal)
    if not above.size or above[0] == 0:
        return None
    high = int(above[0])
    low = high - 1
    if not np.isfinite(rests[high]):
        return None
    share = np.log(goal / rests[low]) / np.log(rests[high] / rests[low])
    training = [max(one.training - 1.0, 1e-12) for one in (left[low], left[high])]
    if np.exp((1.0 - share) * np.log(training[0]) + share * np.log(training[1])) < LEAST_IN_TRAINING - 1.0:
        return None
    return float(amounts[low] * (amounts[high] / amounts[low]) ** share)


def strength_of(left: Left) -> Strength:
    """Third of the range of what may be left, on a logarithmic scale."""
    share = np.log(left.held_out / LEFT[0]) / np.log(LEFT[1] / LEFT[0])
    return STRENGTHS[int(np.clip(share * len(STRENGTHS), 0, len(STRENGTHS) - 1))]
