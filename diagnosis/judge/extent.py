"""Where and when an effect shows: elements, channels, recording and times."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.judge.unfitted import has_bins, raw_residuals
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Term

#: Share of its peak from which an effect counts as being there.
SHOWS = 0.1


def within_readings(
    intervals: Sequence[tuple[float, float]], times: Sequence[Array]
) -> tuple[tuple[float, float], ...]:
    """Intervals cut at the first and last reading: beyond these nobody looked."""
    if not any(len(t) for t in times):
        return tuple(intervals)
    first, last = (float(f(t[k] for t in times if len(t))) for f, k in ((min, 0), (max, -1)))
    return tuple((min(max(begin, first), last), max(min(end, last), first)) for begin, end in intervals)


def effect_of(model: DiagnosisModel, fit: Fit, term: Term) -> Array:
    """What a term changes in every reading, in deviations of the noise, shape (residuals,).

    Predictions are compared, not residuals: where the zero of a channel is taken away, a change spreads over all of it.
    """
    point = fit.point
    if has_bins(model):
        return np.asarray(model.residuals([point.without(term)])[0] - fit.residuals)  # bins of a fabric
    inner = model.plain
    used = np.concatenate([s.used for run in model.runs for s in run.series])
    return np.where(used, raw_residuals(inner, point.without(term)) - raw_residuals(inner, point), 0.0)


def elements_of(model: DiagnosisModel, term: Term) -> tuple[str, ...]:
    local = model.shows_in(term)
    if local is None:
        return (term.place,)
    return tuple(dict.fromkeys(model.layout.names[c].split(".")[0] for c in local[0])) or (term.place,)


def times_of(model: DiagnosisModel, effect: Array) -> tuple[int, tuple[tuple[float, float], ...]]:
    """Recording in which an effect shows most, and the times in which it is there, pieces with gaps of a tenth of it.

    It is there where it is a tenth of its peak or more.
    """
    layout, first = model.layout, 0
    owners = np.concatenate([np.full(len(run.series), n) for n, run in enumerate(model.runs)])
    if len(layout.names) == len(owners):
        recording = owners[np.asarray(layout.channel, dtype=int)]
        first = int(np.argmax(np.bincount(recording, effect**2)))
        chosen = recording == first
    else:
        chosen = np.ones(len(effect), dtype=bool)
    times, place = np.unique(layout.time[chosen], return_inverse=True)
    strength = np.sqrt(np.bincount(place, effect[chosen] ** 2, minlength=len(times)))
    if not strength.max() > 0.0:  # what changes no reading is in none
        return first, ()
    kept = times[strength >= SHOWS * float(strength.max())]
    gap = 0.1 * (times[-1] - times[0])
    cuts = np.flatnonzero(np.diff(kept) > gap)
    begins, ends = np.concatenate([[0], cuts + 1]), np.concatenate([cuts, [len(kept) - 1]])
    return first, tuple((float(kept[a]), float(kept[b])) for a, b in zip(begins, ends))


def channels_of(model: DiagnosisModel, effect: Array) -> tuple[str, ...]:
    """Channels in which the effect is largest, down to a tenth of the largest, at most twelve."""
    strength = np.bincount(np.asarray(model.layout.channel, dtype=int), effect**2, minlength=len(model.layout.names))
    order = np.argsort(-strength)
    return tuple(model.layout.names[i] for i in order[:12] if strength[i] > 0.1 * strength[order[0]])
