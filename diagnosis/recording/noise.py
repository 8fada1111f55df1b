"""The noise of a sensor, from its own readings."""

from __future__ import annotations

import numpy as np

from cosim.unit.protocol import AnyArray, Array

#: Quantiles 0.25 and 0.5 of |x| of a normal distribution with deviation 1.
_QUARTER, _MEDIAN = 0.318639363964375, 0.674489750196082
#: No reading is trusted beyond this share of its range: a simulation that agrees so well is right.
LEAST = 1e-6
#: Bends beyond this many deviations belong to switches.
_SWITCH = 4.0
#: Share by which an estimate with cubics must be lower, to say that the signal itself bends.
_CURVED = 0.1
#: A sensor rounds where at least this share of neighbouring readings are equal.
_TIES = 0.05
#: So many equal readings in a row, at the end of the range, are a sensor that clips (or a supply that is off).
_STUCK = 4
#: Share of equal neighbours among the other readings beyond which a sensor rounds by more than its noise.
_TWINS = 0.2
#: Readings from which cubics are compared with lines.
_ENOUGH = 16
#: Windows that must remain beside readings at the end of the range, for an estimate without those.
_FEW = 6
#: Times that dither is drawn, to average its own scatter out.
_DRAWS = 8


def estimate_noise(times: Array, values: Array, quantum: float = 0.0, is_free: AnyArray | None = None) -> float:
    """Standard deviation of the white noise on a smooth signal.

    Each reading is compared with the line through its two neighbours (with unequal spacing too), which removes value
    and slope; where the cubic through four neighbours leaves less, the signal is curved and that one counts. Readings
    around switches, where the signal itself bends, are recognised by their size and left out: differences alone would
    count them as noise. Readings that stand still at the end of the range have no noise and are left out too: a clipped
    channel would be trusted far too much. Rounded readings are dithered with one step of uniform noise, whose variance
    is taken off again: the distances of rounded readings take few values, and their median would jump between them.

    Args:
        times: Shape (samples,) [s], rising.
        values: Shape (samples,).
        quantum: Step of a quantised reading; 0 finds it.
        is_free: Whether each reading is one within the sensor's range, shape (samples,); None asks the values. Where a
            course was taken off the readings, the values do not tell any more.

    Returns:
        The deviation, rounding included, at least that of rounding to the quantum, quantum / sqrt(12), and never 0.

    Source: Gasser, Sroka, Jennen-Steinmetz, Biometrika 73 (1986) 625-633 (pseudo-residuals); dither: Lipshitz,
    Wannamaker, Vanderkooy, J. Audio Eng. Soc. 40 (1992) 355-375.
    """
    spread = float(np.ptp(values)) if len(values) else 0.0
    size = float(np.max(np.abs(values), initial=0.0))
    step = quantum or find_quantum(values)
    floor = max(step / np.sqrt(12.0), LEAST * spread, 1e-9 * size, float(np.finfo(float).tiny))
    if len(values) < 3:
        return float(floor)
    free = ~repeats_end(values) if is_free is None else is_free
    found = _deviation(times, values, step, 1, free)
    if int(free.sum()) >= _ENOUGH:
        finer = _deviation(times, values, step, 2, free)
        found = finer if finer < (1.0 - _CURVED) * found else found
    return float(max(found, floor))


def is_unresolved(times: Array, values: Array, quantum: float = 0.0) -> bool:
    """Whether a signal bends so much between readings that its scatter is no noise but the signal.

    White noise leaves as much of polynomials of every order; where one through six neighbours leaves less than the
    cubic through four, and that less than the line, the noise lies below what any of them says.

    Args:
        times: Shape (samples,) [s], rising.
        values: Shape (samples,).
        quantum: Step of a quantised reading; 0 finds it.
    """
    if len(values) < _ENOUGH:
        return False
    step, is_free = quantum or find_quantum(values), ~repeats_end(values)
    line, cubic, quintic = (_deviation(times, values, step, reach, is_free) for reach in (1, 2, 3))
    return bool(cubic < (1.0 - _CURVED) * line and quintic < (1.0 - _CURVED) * cubic)


def find_quantum(values: Array) -> float:
    """Step to which readings are rounded; 0 where neighbouring readings are hardly ever equal.

    Readings that stand still at one value (a current that is off) do not count: they must be equal at several values.
    """
    if len(values) < 8:
        return 0.0
    equal = np.diff(values) == 0.0
    levels = np.unique(values[1:][equal])
    if np.mean(equal) < _TIES or len(levels) < 3:
        return 0.0
    gaps = np.diff(np.unique(values))
    # Rounding of decimals may split a step (0.06 and 0.07 for 0.0625): the mean of the smallest ones.
    gaps = gaps[gaps > 1e-9 * np.max(np.abs(values))]
    if not gaps.size:  # all the same but for rounding in the last digits
        return 0.0
    smallest = float(gaps.min())
    return float(np.mean(gaps[(gaps >= smallest) & (gaps < 1.5 * smallest)]))


def repeated(values: Array) -> AnyArray:
    """Whether each reading is one of `_STUCK` equal ones in a row or more, shape (samples,)."""
    edges = np.concatenate([[0], np.flatnonzero(np.diff(values) != 0.0) + 1, [len(values)]])
    length = np.diff(edges)
    return np.asarray(np.repeat(length >= _STUCK, length))


def repeats_end(values: Array) -> AnyArray:
    """Whether each reading is one of a row of equal ones at the end of the range, shape (samples,).

    Where other neighbours are equal too, the sensor rounds by more than its noise: then a row tells nothing.
    """
    found = repeated(values) & ((values == np.max(values)) | (values == np.min(values)))
    others = np.diff(values)[~(found[1:] | found[:-1])]
    return found if others.size and np.mean(others == 0.0) < _TWINS else np.zeros_like(found)


def _deviation(times: Array, values: Array, quantum: float, reach: int, is_free: AnyArray) -> float:
    """Deviation from the bends, with `reach` neighbours on each side; of windows that are free, if there are enough."""
    count = len(values) - 2 * reach
    chosen = np.all([is_free[k : k + count] for k in range(2 * reach + 1)], axis=0)
    chosen = chosen if chosen.sum() >= _FEW else np.ones(count, dtype=bool)
    line = _Line(times, reach)
    if not quantum:
        return _scale(line.bends(values)[chosen])
    random = np.random.default_rng(0)
    variances = []
    for _ in range(_DRAWS):
        dithered = values + quantum * (random.random(len(values)) - 0.5)
        variances.append(_scale(line.bends(dithered)[chosen]) ** 2)
    return float(np.sqrt(max(float(np.mean(variances)) - quantum**2 / 12.0, 0.0)))


class _Line:
    """The polynomial through the neighbours of each reading; its weights depend on the times alone.

    Args:
        times: Shape (samples,) [s].
        reach: Neighbours on each side.
    """

    def __init__(self, times: Array, reach: int) -> None:
        self._index = np.arange(reach, len(times) - reach)
        self._offsets = [k for k in range(-reach, reach + 1) if k]
        nodes = np.stack([times[self._index + k] - times[self._index] for k in self._offsets], axis=1)
        weights = np.ones_like(nodes)
        for i in range(len(self._offsets)):
            for j in range(len(self._offsets)):
                if i != j:
                    weights[:, i] *= -nodes[:, j] / (nodes[:, i] - nodes[:, j])
        self._weights = weights
        self._size = np.sqrt(1.0 + np.sum(weights**2, axis=1))

    def bends(self, values: Array) -> Array:
        """Distance of each reading from its polynomial, in deviations of white noise."""
        neighbours = np.stack([values[self._index + k] for k in self._offsets], axis=1)
        bend = values[self._index] - np.einsum("ij,ij->i", self._weights, neighbours)
        return np.asarray(bend / self._size)


def _scale(bends: Array) -> float:
    """Deviation of bends; the largest ones are left out, once the smaller ones have told what is large."""
    size: AnyArray = np.abs(bends)
    scale = float(np.quantile(size, 0.25)) / _QUARTER
    for _ in range(5):
        kept = size[size <= _SWITCH * scale]
        if not kept.size:
            break
        scale = float(np.median(kept)) / _MEDIAN
    return scale
