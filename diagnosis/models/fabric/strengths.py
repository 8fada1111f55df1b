"""How far a strength may be from the fitted one, by simulations at others.

Between few simulations a surface is made of straight lines, and each knot is a mean of runs that scatter. Where a
fabric hardly answers to more of an effect (it lies on its stops), the lines are steeper than the fabric is, and the
curvature of the fit tells the strength more sharply than the recordings do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from scipy.stats import chi2, t

from cosim.unit.protocol import Array
from diagnosis.models.fabric.surface import is_near
from diagnosis.search.problem import TermParameter

#: Shares of the fitted strength at which an effect is simulated too, downwards and upwards from it.
LESS, MORE = (0.5, 0.25, 0.0), (2.0, 4.0)
#: Rise of -2 log likelihood at the ends of a 95 % interval of one number.
RISE = float(chi2.ppf(0.95, 1))
#: Strength that is none.
LEAST = 1e-9
#: Standard errors of a mean over starts by which it may lie too high.
ERRORS = 2.0
#: Share of the fitted strength by which one has to be apart from all that were simulated, to be simulated too.
APART = 0.05
#: How often a better strength is looked for.
REFINED = 3


def largest_believed(parameter: TermParameter, sign: float) -> float:
    """Strength of an effect of a sign beyond which it is not believed, or not searched."""
    bound = parameter.upper if sign > 0.0 else parameter.lower
    return float(np.copysign(min(parameter.plausible, abs(bound)), sign))


def fitted_sizes(strength: float, known: Sequence[float], parameter: TermParameter) -> list[float]:
    """Strengths at which an effect that was fitted is simulated: as fitted, and at its largest if that is beyond all.

    A straight line through smaller strengths does not know what lies beyond them: a coil that stays cold may let its
    link stop elsewhere than one that is heated by a third.

    Args:
        strength: The fitted one.
        known: At which it was simulated.
        parameter: Of the effect, for its bounds and the largest size that is believed.

    >>> from diagnosis.search.problem import TermParameter
    >>> share = TermParameter("heat_loss", "1", 0.0, 1.0, (0.6,), plausible=1.0)
    >>> fitted_sizes(0.7, [0.6], share), fitted_sizes(0.5, [0.6], share), fitted_sizes(0.9, [0.6], share)
    ([0.7, 1.0], [0.5], [0.9])
    """
    if abs(strength) <= LEAST:
        return []
    largest = largest_believed(parameter, strength)
    is_beyond = all(abs(strength) > abs(k) for k in known if k * strength > 0.0)
    is_larger = abs(largest) > abs(strength) and not is_near(strength, largest)
    return [strength, largest] if is_beyond and is_larger else [strength]


def next_sizes(strength: float, misfits: Mapping[float, Array], parameter: TermParameter) -> list[float]:
    """Strengths to simulate next: on either side the first that is not known, where none before it is excluded.

    Args:
        strength: The fitted one.
        misfits: What is known, as in `interval_of`; empty at first.
        parameter: Of the effect, for its bounds.

    >>> from diagnosis.search.problem import TermParameter
    >>> next_sizes(0.2, {}, TermParameter("roll", "rad", -0.5, 0.5, (0.25,)))
    [0.2, 0.1, 0.4]
    """
    wanted = [] if strength in misfits else [strength]
    excess = _excess(strength, misfits) if strength in misfits else {}
    for shares in (LESS, MORE):
        sizes = [float(np.clip(share * strength, parameter.lower, parameter.upper)) for share in shares]
        for size in dict.fromkeys(s for s in sizes if s != strength):
            if size not in misfits:
                wanted.append(size)
                break
            if excess[size] > 0.0:
                break
    return wanted


def better_size(strength: float, misfits: Mapping[float, Array]) -> float | None:
    """Where a parabola through the simulations about the best one has its least; None where that is known.

    The fitted strength lies between knots of straight lines: it need not be the one that meets the recordings best, and
    an interval about another one does not hold it.

    Args:
        strength: The fitted one.
        misfits: As in `interval_of`.

    >>> import numpy as np
    >>> better_size(0.175, {s: np.array([1e4 * (s - 0.2) ** 2] * 2) for s in (0.0875, 0.175, 0.35)})
    0.2
    """
    means = {s: _mean(v)[0] for s, v in misfits.items() if np.isfinite(v).all()}
    places = sorted(means)
    at = places.index(best_size(means)) if any(means) else 0
    if not 0 < at < len(places) - 1:
        return None
    (a, b, c), (f, g, h) = places[at - 1 : at + 2], [means[p] for p in places[at - 1 : at + 2]]
    left, right = (g - f) / (b - a), (h - g) / (c - b)
    if not right > left:
        return None
    # slopes at the middles of both pieces of a parabola; between them it turns
    least = round(0.5 * (a + b) - left * 0.5 * (c - a) / (right - left), 12)
    is_known = any(abs(least - p) <= APART * abs(strength) for p in places)
    return None if is_known or least * strength <= 0.0 else least


def best_size(means: Mapping[float, float]) -> float:
    """The strength that meets the recordings best, but for none: whether there is any effect the search has judged."""
    return min((s for s in means if s), key=lambda s: means[s])


def is_better(size: float, strength: float, misfits: Mapping[float, Array]) -> bool:
    """Whether a strength meets the recordings better than the fitted one, by more than the errors of both means."""
    (level, error), (mean, own) = _mean(misfits[strength]), _mean(misfits[size])
    return bool(mean + ERRORS * float(np.hypot(error, own)) < level)


def interval_of(strength: float, misfits: Mapping[float, Array], parameter: TermParameter) -> tuple[float, float]:
    """Strengths between which simulations meet the recordings as well as at the fitted one.

    From the fitted strength outwards, to where -2 log likelihood has risen by more than `RISE` and the errors of both
    means; between two simulations by a parabola whose vertex is the inner one. Where it never does to the bound, or
    to 0.

    Args:
        strength: The fitted one.
        misfits: Strength to -2 log likelihood of each of its runs, the fitted one among them; infinite where it
            cannot be simulated.
        parameter: Of the effect, for its bounds.
    """
    excess = _excess(strength, misfits)
    places = sorted(excess)
    below, above = [p for p in reversed(places) if p <= strength], [p for p in places if p >= strength]
    least, most = (parameter.lower, 0.0) if strength < 0.0 else (0.0, parameter.upper)
    return _end(below, excess, least), _end(above, excess, most)


def widened(
    interval: tuple[float, float], strength: float, shifts: Array, parameter: TermParameter
) -> tuple[float, float]:
    """An interval that holds what one more run of the same fabric would be fitted by, with a probability of 95 %.

    Source: Student's t prediction from k draws, Gelman et al., Bayesian Data Analysis, 3rd ed., section 3.2.

    Args:
        interval: From simulations at other strengths.
        strength: That meets the recordings best.
        shifts: Strengths by which each of k runs there differs from the mean of the others.
        parameter: Of the effect, for its bounds.
    """
    count = len(shifts)
    if count < 2:
        return interval
    # a run less the mean of k - 1 others scatters by 1 + 1/(k - 1), a recording less that of k by 1 + 1/k
    of_one = float(np.mean(shifts**2)) * (count - 1) / count
    width = float(t.ppf(0.975, count - 1) * np.sqrt(of_one * (1.0 + 1.0 / count)))
    least, most = (parameter.lower, 0.0) if strength < 0.0 else (0.0, parameter.upper)
    return min(interval[0], max(strength - width, least)), max(interval[1], min(strength + width, most))


def _excess(strength: float, misfits: Mapping[float, Array]) -> dict[float, float]:
    """By how much each strength is too far; negative where it meets the recordings as well."""
    level, error = _mean(misfits[strength])
    found = {}
    for size, values in misfits.items():
        mean, own = _mean(values)
        found[size] = mean - level - RISE - ERRORS * float(np.hypot(error, own)) if np.isfinite(mean) else float("inf")
    found[strength] = -RISE
    return found


def _mean(values: Array) -> tuple[float, float]:
    """Mean of runs and its standard error; infinite from one run."""
    count = len(values)
    return float(np.mean(values)), float(np.std(values, ddof=1) / np.sqrt(count)) if count > 1 else float("inf")


def _end(outwards: list[float], excess: Mapping[float, float], bound: float) -> float:
    """Where it rises too far, going outwards; `bound` where it does not."""
    for last, place in pairwise(outwards):
        if excess[place] > 0.0:
            if not np.isfinite(excess[last]):  # known from one run
                return place
            share = float(np.sqrt(-excess[last] / (excess[place] - excess[last])))
            return last + share * (place - last)
    return bound
