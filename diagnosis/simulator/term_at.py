"""A candidate at a place as the search sees it: bounds and start values of its numbers, by what was recorded."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.bank.layout import BankLayout
from diagnosis.bank.places import SCALES, Place
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.search.problem import Term, TermParameter
from diagnosis.simulator.rig_scales import believed, rig_scales
from diagnosis.simulator.runs import LONGEST_LAG, Run, Series

#: Instants at which an effect that begins some time is tried first.
INSTANTS = 9
#: Where a limit may lie, as shares of the most that was read: of what is cut off nothing is seen above it.
CEILINGS = (0.99, 0.9, 0.75, 0.6, 0.45)
#: What a sensor may be off by, and where a recording states it.
STATED = {"sensor_clock_offset": "offset_bound", "sensor_lag": "lag_bound"}


def term_at(candidate: CandidateTerm, place: Place, layout: BankLayout, runs: Sequence[Run]) -> Term:
    """The term of a candidate at a place.

    Args:
        candidate: The effect.
        place: Where it acts.
        layout: Coils and strings.
        runs: The recordings.
    """
    own: list[Series] = []
    if candidate.axis == "channel":
        elements = set(np.flatnonzero(place.mask).tolist())
        own = [s for run in runs for s in run.series if layout.channel(s.quantity) + s.element in elements]
    scales = rig_scales(runs[0].translation.parameters.base)
    free = []
    for p in candidate.parameters:
        if p.is_fixed:
            continue
        lower, upper, starts = p.lower, p.upper, p.tried(scales) or p.starts
        if p.is_instant:
            lower = begin = min(run.translation.start for run in runs)
            upper = end = max(float(t[-1]) for run in runs for t in run.times.values())
            starts = tuple(float(v) for v in np.linspace(begin, end, INSTANTS + 2)[1:-1])
        elif p.name == "limit":
            starts = _limits([s for run in runs for s in run.series]) or starts
        elif p.name == "ceiling":
            starts = _ceilings(own) or starts
        negligible = max(p.negligible, _stated(candidate, own))
        plausible = believed(candidate, p, own, scales)
        free.append(
            TermParameter(p.name, p.unit, lower, upper, starts, p.is_switch, p.is_instant, negligible, *plausible)
        )
    return Term(candidate.identifier, place.label, candidate.unit, tuple(free), candidate.is_named, candidate.law)


def _stated(candidate: CandidateTerm, own: Sequence[Series]) -> float:
    """How far a sensor may be off by what the recordings state of it: that is no finding."""
    if candidate.identifier not in STATED:
        return 0.0
    stated = [float(getattr(s.channel, STATED[candidate.identifier])) for s in own]
    if candidate.identifier == "sensor_lag":  # beyond that the base has none; see `runs.clocks`
        stated = [s for s in stated if s <= LONGEST_LAG]
    return max(stated, default=0.0)


def _limits(every: Sequence[Series]) -> tuple[float, ...]:
    currents = [s for s in every if s.quantity in ("supply_current", "current")]
    most = max((float(np.quantile(s.measured, 0.999)) for s in currents), default=0.0)
    return tuple(most * share for share in CEILINGS) if most > 0.0 else ()


def _ceilings(own: Sequence[Series]) -> tuple[float, ...]:
    found = [
        (float(np.quantile(s.measured, 0.999)) - SCALES[s.quantity][1]) / SCALES[s.quantity][0]
        for s in own
        if s.measured.size
    ]
    most = max(found, default=0.0)
    return tuple(most * share for share in CEILINGS) if most > 0.0 else ()
