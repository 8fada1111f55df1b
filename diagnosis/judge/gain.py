"""What one model gains over another on readings that neither was fitted to, with the uncertainty of that gain.

Two questions, one of which must be answered by yes. Would the second model, if it were right but for errors that are
alike for a while, gain so much? That is asked of effects that act for a short time alone too. And is the gain larger
than its own scatter between stretches of time, whatever the models leave out?

Source of the second: F. X. Diebold and R. S. Mariano, Comparing predictive accuracy, J. Business and Economic
Statistics 13 (1995) 253-263.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.judge.unfitted import Predicted, Readings
from diagnosis.search.posterior import HUBER

#: -2 log likelihood that must be gained: odds of 20 to 1.
LEAST = 6.0
#: Standard errors that a gain, or a loss, must exceed.
ERRORS = 2.0
#: Stretches of time from which the scatter of a gain between them is known.
FEWEST = 8
#: Scatter by which a residual differs from both neighbours that stands out alone; noise does in one of 80,000.
ALONE = 5.0
#: Median size of the difference of two independent normal numbers.
MEDIAN = 0.954
#: Rise of a channel's root mean square from which it counts as worse: less is no matter for a user.
WORSE = 1.05


@dataclass(frozen=True)
class Gain:
    """Fall of -2 log likelihood (Huber's) from one model to another.

    Args:
        total: Over all readings, with what the day's own numbers cost.
        white: Its standard error if the errors of readings were independent.
        error: Its standard error by blocks, at least `white`: errors of a model are alike for a while.
        loss_error: The same if the first model is right.
        scatter: Its standard error from how the gain differs between stretches; infinite where they are too few.
        drawn: Its standard error where each model is a mean of runs of contacts that scatter, if both are equally
            right.
        shown: Root mean square by which the two predictions differ in the channel where they differ most, in deviations
            of the noise.
        worse: Channels (`channel of recording`) that are predicted significantly worse.
        rising: Channels of which more is left, by no more than chance.
    """

    total: float
    white: float
    error: float
    loss_error: float
    scatter: float
    drawn: float
    shown: float
    worse: tuple[str, ...]
    rising: tuple[str, ...] = ()

    @property
    def doubt(self) -> float:
        """How many times larger the standard error is than that of independent readings."""
        return self.error / self.white if self.white > 0.0 else 1.0

    @property
    def needed(self) -> float:
        """Gain from which it counts.

        Odds of 20 to 1 by as many readings as are independent of each other, or twice the scatter between stretches. Of
        contacts also twice what two predictions of one model gain over each other.
        """
        excess = float(np.sqrt(max(self.error**2 - self.white**2, 0.0)))
        least = min(max(LEAST * self.doubt**2, ERRORS * excess), max(LEAST, ERRORS * self.scatter))
        return max(least, ERRORS * self.drawn)

    @property
    def is_gain(self) -> bool:
        """Whether the second model predicts better."""
        return self.total > self.needed

    @property
    def is_loss(self) -> bool:
        """Whether it predicts worse."""
        return -self.total > max(LEAST, ERRORS * self.loss_error)


def loss(residuals: Array) -> Array:
    """Huber's function of residuals in deviations of the noise: squares, linear beyond `HUBER`."""
    size = np.abs(residuals)
    return np.asarray(np.where(size > HUBER, 2.0 * HUBER * size - HUBER**2, size**2))


def gain(without: Predicted, with_it: Predicted, readings: Readings) -> Gain:
    """Gain of one model over another.

    With residuals r0, r1 that differ by delta, the sum of loss(r0) - loss(r1) is about sum(delta^2) + 2 sum(delta r1).
    If the second model is right, the last sum has expectation 0, and its variance is taken from sums over blocks.
    A reading counts by its weight: of contacts that stay where they are, many readings tell what a few do.
    What the second model misses by single readings is evidence for neither: one that was taken while an input switched
    is missed by more or less according to the size of the switch, which any law of that input changes.

    Args:
        without: What the first leaves.
        with_it: What the second leaves.
        readings: What the residuals belong to.
    """
    kept = ~stands_alone(with_it.residuals, readings)
    first, second = np.where(kept, without.residuals, 0.0), np.where(kept, with_it.residuals, 0.0)
    found = _summed(first, second, readings.block, readings.weight)
    total = found[0] + without.prior - with_it.prior
    delta = (without.residuals - with_it.residuals) ** 2
    count = np.maximum(np.bincount(readings.channel, minlength=len(readings.channels)), 1)
    shown = float(np.sqrt(np.max(np.bincount(readings.channel, delta, len(readings.channels)) / count, initial=0.0)))
    reverse = _summed(second, first, readings.block, readings.weight)
    scatter = _scatter(readings.weight * (loss(first) - loss(second)), readings)
    worse, rising = worse_channels(without.residuals, with_it.residuals, readings)
    drawn = float(np.sqrt(np.sum(readings.weight * readings.drawn)))
    return Gain(total, found[1], found[2], reverse[2], scatter, drawn, shown, worse, rising)


def stands_alone(residuals: Array, readings: Readings) -> AnyArray:
    """Residuals that stand out from both neighbours of their channel to one side, shape (readings,).

    By `ALONE` of the scatter between neighbours, the median of which a few such readings do not move, or of the noise.
    """
    found = np.zeros(len(residuals), dtype=bool)
    for n in range(len(readings.channels)):
        places = np.flatnonzero(readings.channel == n)
        own = residuals[places]
        if len(own) < 3:
            continue
        steps = np.diff(own)
        scatter = max(1.0, float(np.median(np.abs(steps))) / MEDIAN)
        before, after = steps[:-1], -steps[1:]
        is_out = (np.minimum(np.abs(before), np.abs(after)) > ALONE * scatter) & (before * after > 0.0)
        found[places[1:-1]] = is_out
    return found


def is_better(first: Predicted, second: Predicted, readings: Readings) -> bool:
    """Whether one outcome of a search may take the place of another.

    It gains, no channel gets worse, and the squares of what is left fall too, the room and the start as written down:
    Huber's function counts single wild readings less, and so it would a stretch in which a model runs away.

    Args:
        first: What the first leaves.
        second: What the second leaves.
        readings: What the residuals belong to.
    """
    found = gain(first, second, readings)
    kept = ~readings.is_wild
    fell = float(np.sum(first.plain[kept] ** 2) - np.sum(second.plain[kept] ** 2))
    return found.is_gain and not found.worse and fell > 0.0


def _scatter(fell: Array, readings: Readings) -> float:
    """Standard error of a sum of losses from its scatter over stretches of time of each channel."""
    stretches = np.unique(np.stack([readings.channel, readings.block]), axis=1, return_inverse=True)[1]
    sums = np.bincount(stretches, fell)
    return float(np.sqrt(len(sums)) * np.std(sums, ddof=1)) if len(sums) >= FEWEST else float("inf")


def worse_channels(before: Array, after: Array, readings: Readings) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Channels whose prediction gets worse by more than a twentieth: by more than chance, and by no more than that.

    Args:
        before: Residuals of the first model, shape (readings,).
        after: Of the second, shape (readings,).
        readings: What they belong to.
    """
    count = len(readings.channels)
    found: tuple[list[str], list[str]] = [], []
    for number, channel in enumerate(readings.channels):
        own = readings.channel == number
        if not own.any():
            continue
        fell, white, error = _summed(after[own], before[own], readings.block[own], readings.weight[own])
        is_sure = fell > max(LEAST + 2.0 * np.log(count), ERRORS * max(white, error))
        if _size(after[own]) > WORSE * _size(before[own]):
            name = f"{channel.name} of {readings.titles[readings.of_channel[number]]}"
            found[0 if is_sure else 1].append(name)
    return tuple(found[0]), tuple(found[1])


def _size(residuals: Array) -> float:
    return float(np.sqrt(np.mean(loss(residuals))))


def _summed(first: Array, second: Array, block: Array, weight: Array) -> tuple[float, float, float]:
    """Fall of the loss from the first to the second, and its standard error: white, and by blocks."""
    delta = first - second
    cross = 2.0 * weight * delta * np.clip(second, -HUBER, HUBER)
    white = 2.0 * float(np.sqrt(np.sum(weight * np.clip(delta, -HUBER, HUBER) ** 2)))
    error = float(np.sqrt(np.sum(np.bincount(block, cross) ** 2))) if len(block) else 0.0
    return float(np.sum(weight * (loss(first) - loss(second)))), white, max(white, error)
