"""How far simulations of equal fabrics differ, as a covariance: from starts a hair apart, and by two engines.

Neither is ever physics. Contacts scatter; and two engines that solve the same equations in other ways (hard contacts,
soft ones) part by more than that, which is the error of solving them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky, solve_triangular

from cosim.unit.protocol import AnyArray, Array

#: Weight of what the ensemble shows between channels; the rest is a smooth model, which few members cannot upset.
SHOWN = 0.5
#: Time over which scatter is remembered, as a share of the recording: links that stick stay where they are.
MEMORY = 0.5
#: Bins of time over which variances are averaged.
SMOOTH = 5
#: Fewest members: with n of them, the squared distance of one more is inflated by (n - 1) / (n - 3).
FEWEST = 4


@dataclass(frozen=True)
class Bins:
    """Samples of all mechanical channels, averaged over pieces of time; sorted by time.

    Args:
        channel: Number of the channel of each bin, shape (bins,).
        time: Mean time of its samples [s], shape (bins,).
        recording: Number of the recording, shape (bins,).
        group: Number of the kind of quantity (the height of a marker), which share a variance, shape (bins,).
        noise: Standard deviation of the sensor's noise in each bin's mean, shape (bins,).
        scale: Size of the quantity's changes, for a floor of the variance, shape (bins,).
    """

    channel: AnyArray
    time: Array
    recording: AnyArray
    group: AnyArray
    noise: Array
    scale: Array

    def only(self, chosen: AnyArray) -> Bins:
        """Some of them, by a mask of shape (bins,)."""
        every = (self.channel, self.time, self.recording, self.group, self.noise, self.scale)
        return Bins(*(v[chosen] for v in every))


def scatter_covariance(members: Array, bins: Bins) -> Array:
    """Covariance of one more fabric of the same kind about the mean of an ensemble, without sensors' noise.

    Half of it is what the ensemble shows, half a model of scatter that is remembered for a while within a channel,
    with variances averaged over channels of one kind and over time. The factor (1 + 1/n) (n - 1) / (n - 3) is the
    variance of Student's t prediction from n members.

    Args:
        members: Shape (members, bins).
        bins: What each bin is.

    Returns:
        Shape (bins, bins).

    Raises:
        ValueError: There are fewer than `FEWEST` members.

    Source: shrinkage: O. Ledoit, M. Wolf, J. Multivariate Analysis 88 (2004) 365-411; prediction: A. Gelman et al.,
    Bayesian Data Analysis, 3rd ed., CRC 2013, section 3.2.
    """
    count = len(members)
    if count < FEWEST:
        raise ValueError(f"{count} members are too few to tell scatter; make at least {FEWEST}")
    apart = members - members.mean(axis=0)
    inflation = (1.0 + 1.0 / count) * (count - 1) / (count - 3)
    return inflation * _shrunk(apart.T @ apart / (count - 1), bins)


def engine_covariance(difference: Array, bins: Bins) -> Array:
    """Covariance of what a solution of the equations is off by, from what two engines differ by.

    One difference tells a size and a direction, and no more: half of the covariance is along it, half remembers as much
    for a while within a channel.

    Args:
        difference: Mean of the one less mean of the other, shape (bins,).
        bins: What each bin is.

    Returns:
        Shape (bins, bins).
    """
    return _shrunk(np.outer(difference, difference), bins)


def _shrunk(shown: Array, bins: Bins) -> Array:
    """Half of what is shown, and half of a model that remembers the same variances for a while within a channel."""
    deviation = np.sqrt(_pooled(np.diag(shown), bins) + (1e-4 * bins.scale) ** 2)
    memory = MEMORY * max(float(np.ptp(bins.time)), 1e-9)
    lag = np.abs(bins.time[:, None] - bins.time[None, :]) / memory
    is_same = (bins.channel[:, None] == bins.channel[None, :]) & (bins.recording[:, None] == bins.recording[None, :])
    model = np.where(is_same, np.outer(deviation, deviation) * np.exp(-lag), 0.0)
    return np.asarray(SHOWN * shown + (1.0 - SHOWN) * model)


def _pooled(variance: Array, bins: Bins) -> Array:
    """Variances averaged over channels of one kind at equal places in time, then over neighbouring times."""
    found = np.zeros_like(variance)
    for recording in np.unique(bins.recording):
        for group in np.unique(bins.group):
            chosen = np.flatnonzero((bins.group == group) & (bins.recording == recording))
            if not chosen.size:
                continue
            times, place = np.unique(np.round(bins.time[chosen], 6), return_inverse=True)
            mean = np.bincount(place, variance[chosen]) / np.bincount(place)
            width = min(SMOOTH, len(times))
            kernel = np.ones(width)
            smooth = np.convolve(mean, kernel, mode="same") / np.convolve(np.ones(len(times)), kernel, mode="same")
            found[chosen] = smooth[place]
    return found


def calibrated_scatter(members: Array, bins: Bins, seed: int = 0) -> Array:
    """Covariance as in `scatter_covariance`, widened where the members themselves are farther apart than it says.

    Every member is predicted from the others; what its mean squared residual exceeds 1 by is made good.

    Args:
        members: Shape (members, bins); with no more than `FEWEST` of them nothing can be left out.
        bins: What each bin is.
        seed: Of the sensors' noise that is added to the member that is left out.

    Returns:
        Shape (bins, bins).
    """
    whole = scatter_covariance(members, bins)
    if len(members) <= FEWEST:
        return whole
    squares = []
    for number, member in enumerate(members):
        others = np.delete(members, number, axis=0)
        noise = bins.noise * np.random.default_rng([seed, number]).standard_normal(len(member))
        whiten = Whitening(scatter_covariance(others, bins), bins.noise)
        squares.append(float(np.mean(whiten(member + noise - others.mean(axis=0)) ** 2)))
    return whole * max(1.0, float(np.mean(squares)))


class Whitening:
    """Turns differences between measurement and model into independent residuals of deviation 1.

    Args:
        scatter: Covariance of contact scatter, shape (bins, bins).
        noise: Standard deviation of the sensors' noise, shape (bins,).
    """

    def __init__(self, scatter: Array, noise: Array) -> None:
        self._factor = cholesky(scatter + np.diag(noise**2), lower=True)

    def __call__(self, differences: Array) -> Array:
        """Residuals of differences, shape (rows, bins) or (bins,); bin by bin, what earlier bins did not predict."""
        return np.asarray(solve_triangular(self._factor, differences.T, lower=True).T)
