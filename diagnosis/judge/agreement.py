"""Whether readings reject a model, by the noise of their sensors and the error of what was fitted.

Source: chi-square test of goodness of fit with known variances; several channels by Bonferroni's inequality.
Scatter from successive differences: J. von Neumann, Ann. Math. Statist. 12 (1941) 367-395.
Noise that is alike from reading to reading: M. S. Bartlett, J. Royal Statistical Society 98 (1935) 536-543.
Whiteness at several lags: G. M. Ljung and G. E. P. Box, Biometrika 65 (1978) 297-303.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtr, chdtri

from cosim.unit.protocol import Array
from diagnosis.judge.independent import independent
from diagnosis.judge.parameter_error import Tested
from diagnosis.judge.unfitted import NOISE_ERROR, Readings, set_aside
from diagnosis.models.coil_network.runs import ZERO, deviation
from diagnosis.recording.noise import estimate_noise

#: Probability that noise alone is taken for a departure of the model.
LEVEL = 0.001
#: Standard normal quantile of that level, for the error of an estimated noise.
QUANTILE = 3.09
#: Standard normal quantile of 99 %, by which von Neumann's ratio of white residuals may be below 1.
WHITE = 2.33
#: Deviations by which a residual differs from both neighbours that stands out alone; noise does in one of 80,000.
ALONE = 5.0
#: Largest correlation of the noise of neighbouring readings: what lasts for more than some ten of them is no noise.
MOST_ALIKE = 0.9
#: Share of differences between neighbouring residuals that may be jumps and do not count as scatter.
JUMPS = 0.05
#: Lags at which white residuals are asked to be white, at most; one for so many readings, and readings that are needed.
LAGS, FOR_A_LAG, FEWEST = 20, 5, 30
#: Deviations by which one residual counts at most in that question.
CLIPPED = 3.0


@dataclass(frozen=True)
class ChannelAgreement:
    """One channel of one recording.

    Args:
        channel: Name.
        recording: Title.
        unit: SI unit.
        rmse: Root mean square of measured minus predicted, single wild readings left out [unit].
        noise: Standard deviation of the noise, with rounding [unit].
        chi_square: Per reading.
        limit: Of that: noise alone exceeds it in one of a thousand diagnoses.
        samples: Readings that count.
        scatter: Root mean square of what is left as far as it changes from one reading to the next, as white noise does
            [unit]; `rmse` where there is a single reading.
        lasting: Root mean square of what is left without readings that stand out alone [unit]; `rmse` if none does.
        tested: Chi-square per reading that is compared with the limit, where that is another: with what the error of
            fitted numbers explains, and its price, see `diagnosis.judge.parameter_error`.
        is_noise_stated: Whether the recording states the noise; else it was estimated from neighbouring readings.
        correlation: Of the noise of neighbouring readings, where these differ by less than is stated; else 0.
        own_scatter: Of neighbouring readings themselves, whatever is simulated, where what is left is white at all of
            several lags and there is more than the stated noise [unit]; else 0: it is not asked for.
    """

    channel: str
    recording: str
    unit: str
    rmse: float
    noise: float
    chi_square: float
    limit: float
    samples: int
    scatter: float = 0.0
    lasting: float | None = None
    tested: float | None = None
    is_noise_stated: bool = True
    correlation: float = 0.0
    own_scatter: float = 0.0

    @property
    def statistic(self) -> float:
        """Chi-square per reading that is compared with the limit."""
        return self.chi_square if self.tested is None else self.tested

    @property
    def is_rejected(self) -> bool:
        """Whether noise, and the error of fitted numbers where that was asked, do not explain what is left."""
        return self.statistic > self.limit

    @property
    def is_irregular(self) -> bool:
        """Whether what is left is as white as noise: neighbouring residuals differ by as much as any two of them.

        Von Neumann's ratio of n white residuals scatters by 1 / sqrt(n) about 1. An error of the model that lasts for
        several readings lowers it: successive differences leave it out. Readings that stand out alone, too few or too
        near to be set aside as wild, are no such error.
        """
        lasting = self.rmse if self.lasting is None else self.lasting
        return self.scatter**2 >= (1.0 - WHITE / math.sqrt(max(self.samples, 1))) * lasting**2

    @property
    def louder(self) -> float:
        """Noise that the readings show by themselves in multiples of the stated one, at least 1.

        The smaller of two: what readings and what residuals scatter by from one to the next. 1 where these are no
        measure of the noise: what is left is not white, or no noise was stated.
        """
        return max(min(self.scatter, self.own_scatter) / self.noise, 1.0) if self.own_scatter else 1.0

    @property
    def is_beyond_scatter(self) -> bool:
        """Whether what is left is more than noise of that scatter explains, readings that stand out alone counted.

        The ratio of the mean square of n white residuals to that of their differences scatters by 1 / sqrt(n).
        """
        times = 1.0 if self.louder == 1.0 else 1.0 + QUANTILE / math.sqrt(self.samples)
        return self.statistic / self.louder**2 > self.limit * times

    @property
    def multiple(self) -> float:
        """What is left in multiples of the noise."""
        return self.rmse / self.noise if self.noise > 0.0 else float("inf")


@dataclass(frozen=True)
class Agreement:
    """All channels.

    Args:
        chi_square: Per reading, over all.
        limit: Of that.
        samples: Readings that count.
        wild: Single wild readings that do not count.
        channels: Each one.
        tested: See `ChannelAgreement`.
    """

    chi_square: float
    limit: float
    samples: int
    wild: int
    channels: tuple[ChannelAgreement, ...]
    tested: float | None = None

    @property
    def is_irregular(self) -> bool:
        """Whether all channels that reject the model do so by what changes from one reading to the next alone.

        Where none does so alone and all of them do together: those that leave more than their noise.
        """
        rejected = [c for c in self.channels if c.is_rejected]
        if not rejected and self.is_rejected:
            rejected = [c for c in self.channels if c.statistic > 1.0]
        return bool(rejected) and all(c.is_irregular for c in rejected)

    @property
    def is_rejected(self) -> bool:
        """Whether the readings reject the model."""
        return self.statistic > self.limit or any(c.is_rejected for c in self.channels)

    @property
    def statistic(self) -> float:
        """Chi-square per reading that is compared with the limit."""
        return self.chi_square if self.tested is None else self.tested

    @property
    def is_met_by_scatter(self) -> bool:
        """Whether the stated noise alone rejects the model: noise as large as what is left scatters does not.

        That is how a recording is judged that states no noise. What is left has to be white in each channel that is
        judged by its scatter, and no more than its readings scatter by themselves (`ChannelAgreement.louder`).
        """
        if not self.is_rejected or any(c.is_beyond_scatter for c in self.channels):
            return False
        less = sum(c.samples * c.statistic * (1.0 - 1.0 / c.louder**2) for c in self.channels)
        error = math.sqrt(sum(c.samples for c in self.channels if c.louder > 1.0))
        return self.statistic - less / self.samples <= self.limit + QUANTILE * error / self.samples

    @property
    def louder(self) -> dict[str, float]:
        """Channel to how many times its stated noise it scatters, where readings do not reject the model by that."""
        if not self.is_met_by_scatter:
            return {}
        found: dict[str, float] = {}
        for c in sorted(self.channels, key=lambda c: -c.louder):
            if c.louder > 1.0:
                found.setdefault(c.channel, c.louder)
        return found

    @property
    def needs_parameter_error(self) -> bool:
        """Whether noise alone does not explain what is left, but noise and the error of fitted numbers do."""
        by_noise = self.chi_square > self.limit or any(c.chi_square > c.limit for c in self.channels)
        return by_noise and not self.is_rejected

    @property
    def worst(self) -> ChannelAgreement | None:
        """The channel that is met worst, by what the test compares."""
        return max(self.channels, key=lambda c: c.statistic / c.limit, default=None)

    @property
    def alike(self) -> dict[str, float]:
        """Correlation of the stated noise of neighbouring readings by channel, called as in the layout of a search."""
        is_one = len({c.recording for c in self.channels}) == 1
        named = {c.channel if is_one else f"{c.channel} ({c.recording})": c.correlation for c in self.channels}
        return {name: correlation for name, correlation in named.items() if correlation > 0.0}

    @property
    def excess(self) -> float:
        """Sum of squares beyond what noise gives, at least 0.

        Of what is printed as root mean square: a zero that is off counts, so that shares agree with the rows of fits.
        """
        return max(sum(c.samples * (c.multiple**2 - 1.0) for c in self.channels), 0.0)


def times_white(alike: Mapping[str, float], channels: Sequence[str]) -> float:
    """By how much the variance of a mean of many readings is larger than if their noise were white, at least.

    Of an autoregressive noise of first order with a correlation c it is (1 + c)/(1 - c) (Bartlett 1935), and by so much
    a search that counts every reading as one of its own overrates a gain.

    Args:
        alike: Channel to the correlation of neighbouring readings, see `Agreement.alike`.
        channels: The least correlated of these counts.

    >>> times_white({"a": 0.5, "b": 0.8}, ["a", "b"]), times_white({"a": 0.5}, ["a", "b"])
    (3.0, 1.0)
    """
    least = min((alike.get(name, 0.0) for name in channels), default=0.0)
    return (1.0 + least) / (1.0 - least)


def times_louder(louder: Mapping[str, float], names: Sequence[str]) -> float:
    """How many times their stated noise channels scatter, the loudest of them.

    Args:
        louder: By channel, see `Agreement.louder`.
        names: Channels, called as in the layout of a search: of several recordings each with the title of its own.

    >>> times_louder({"a": 1.5}, ["a (monday)", "b"]), times_louder({"a": 1.5}, ["b"])
    (1.5, 1.0)
    """
    own = [n for channel, n in louder.items() if any(f"{name} (".startswith(f"{channel} (") for name in names)]
    return max(own, default=1.0)


def _scatter(own: Array) -> float:
    """Deviation of what changes from one reading to the next, without the largest of the differences.

    A model that is late at a switch, and a gap between readings, make a few differences as large as its error.
    """
    if len(own) < 2:
        return float(np.sqrt(np.mean(own**2)))
    squares = np.sort(np.diff(own) ** 2)
    kept = squares[: max(len(squares) - int(np.ceil(JUMPS * len(squares))), 1)]
    share = len(kept) / len(squares)
    # of a normal distribution without its tails this part of the variance stays
    part = float(chdtr(3.0, float(chdtri(1.0, 1.0 - share)))) / share if share < 1.0 else 1.0
    return float(np.sqrt(0.5 * np.mean(kept) / part))


def _lasting(own: Array, scatter: float) -> float:
    """Root mean square without residuals that stand out from both neighbours to one side, by `ALONE` of the scatter."""
    if len(own) < 3:
        return float(np.sqrt(np.mean(own**2)))
    before, after = own[1:-1] - own[:-2], own[1:-1] - own[2:]
    is_alone = np.zeros(len(own), dtype=bool)
    is_alone[1:-1] = (np.minimum(np.abs(before), np.abs(after)) > ALONE * scatter) & (before * after > 0.0)
    return float(np.sqrt(np.mean(own[~is_alone] ** 2)))


def _is_white(own: Array, scatter: float) -> bool:
    """Whether residuals are alike at no lag up to `LAGS`, by the test of Ljung and Box; False of too few of them.

    Their mean is not taken away: an offset is alike in all.
    """
    count = len(own)
    if count < FEWEST or scatter <= 0.0:
        return False
    size = np.clip(own / scatter, -CLIPPED, CLIPPED)
    lags = np.arange(1, min(LAGS, count // FOR_A_LAG) + 1)
    alike = np.array([size[k:] @ size[:-k] for k in lags]) / float(size @ size)
    statistic = count * (count + 2.0) * float(np.sum(alike**2 / (count - lags)))
    return statistic <= float(chdtri(float(len(lags)), LEVEL))


def _correlation(scatter: float, count: int, share: float) -> float:
    """Correlation of the noise of neighbouring readings, 0 to 1, where they differ by less than the stated noise says.

    A filter in a sensor does that. Of an autoregressive noise of first order neighbours differ by 2 (1 - correlation)
    of its variance. By chance white noise does so too: half of the mean square of n differences scatters by sqrt(3/n).

    Args:
        scatter: Of neighbouring residuals, in deviations of the noise.
        count: Residuals.
        share: Share of the variance of the noise that is remembered for long, as contacts are.
    """
    ratio = scatter**2 / max(1.0 - share, 1e-9)
    return 0.0 if ratio >= 1.0 - WHITE * math.sqrt(3.0 / max(count, 1)) else min(1.0 - ratio, MOST_ALIKE)


def agreement(residuals: Array, readings: Readings, tested: Tested | None = None) -> Agreement:
    """Compare residuals with the noise.

    The zero of a channel is known to `ZERO` of its noise; a noise that was estimated has an error of its own.

    Args:
        residuals: In deviations of the noise, shape (readings,).
        readings: What they belong to.
        tested: What is left where fitted numbers may move within their own error; it is compared with the limits, and
            everything else is of the residuals.
    """
    wild = set_aside(readings, residuals)
    counted = ~wild
    numbers = [n for n in range(len(readings.channels)) if np.any(counted & (readings.channel == n))]
    found, squares, error = [], 0.0, 0.0
    shares: dict[int, tuple[float, float]] = {}
    for n in numbers:
        channel, own = readings.channels[n], residuals[counted & (readings.channel == n)]
        count = len(own)
        unknown = ZERO**2 if channel.bias_bound == 0.0 else 0.0
        total = float(own @ own - unknown / (1.0 + count * unknown) * own.sum() ** 2)
        own_error = 0.0 if channel.is_deviation_given else NOISE_ERROR / np.sqrt(count)
        noise, scatter = deviation(channel), _scatter(own)
        share = (channel.scatter / noise) ** 2 if noise > 0.0 else 0.0
        shares[n] = share, _correlation(scatter, count, share) if channel.is_deviation_given else 0.0
        free = independent([[(count, *shares[n])]])
        statistic = (total if tested is None else float(tested.channels[n])) / count
        is_asked = channel.is_deviation_given and noise > 0.0 and statistic > 1.0
        limit = float(chdtri(free, LEVEL / len(numbers))) / free * (1.0 + 2.0 * QUANTILE * own_error)
        found.append(
            ChannelAgreement(
                channel.name,
                readings.titles[readings.of_channel[n]],
                channel.unit,
                noise * float(np.sqrt(np.mean(own**2))),
                noise,
                total / count,
                limit,
                count,
                noise * scatter,
                noise * _lasting(own, scatter),
                None if tested is None else statistic,
                channel.is_deviation_given,
                shares[n][1],
                estimate_noise(channel.times, channel.values, channel.quantum)
                if is_asked and _is_white(own, scatter)
                else 0.0,
            )
        )
        squares += total
        error += (count * own_error) ** 2
    samples = sum(c.samples for c in found)
    if not samples:
        return Agreement(0.0, 1.0, 0, int(wild.sum()), ())
    own_shares = [(readings.of_channel[n], (c.samples, *shares[n])) for n, c in zip(numbers, found)]
    recordings = [[own for of, own in own_shares if of == r] for r in dict.fromkeys(of for of, _ in own_shares)]
    free = independent(recordings)
    limit = float(chdtri(free, LEVEL)) / free + 2.0 * QUANTILE * float(np.sqrt(error)) / samples
    return Agreement(
        squares / samples,
        limit,
        samples,
        int(wild.sum()),
        tuple(found),
        None if tested is None else tested.total / samples,
    )
