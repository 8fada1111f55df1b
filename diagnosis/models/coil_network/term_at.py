"""A candidate at a place as the search sees it: bounds and start values of its numbers, by what was recorded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diagnosis.candidates.candidate import CandidateTerm, Parameter, Scope
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.places import SCALES, Place
from diagnosis.models.coil_network.rig_scales import believed
from diagnosis.models.coil_network.runs import LONGEST_LAG, Run, Series
from diagnosis.models.timeline import Timeline
from diagnosis.search.problem import Term, TermParameter

#: Instants of each recording at which an effect that begins some time is tried first, and those from which a fit may
#: begin once it is worth one.
INSTANTS, SCANNED = 9, 40
#: Where a limit may lie, as shares of the most that was read: of what is cut off nothing is seen above it.
CEILINGS = (0.99, 0.9, 0.75, 0.6, 0.45)
#: What a sensor may be off by, and where a recording states it.
STATED = {"sensor_clock_offset": "offset_bound", "sensor_lag": "lag_bound"}


def term_at(
    candidate: CandidateTerm,
    place: Place,
    layout: CoilNetworkLayout,
    runs: Sequence[Run],
    timeline: Timeline,
    scales: Mapping[str, float],
) -> Term:
    """The term of a candidate at a place; its instants are those of the joint axis of the recordings.

    Args:
        candidate: The effect.
        place: Where it acts.
        layout: Coils and strings.
        runs: The recordings.
        timeline: The recordings that are fitted, laid end to end.
        scales: Of the rig (`rig_scales`): the same for all of a model's terms.
    """
    own: list[Series] = []
    if candidate.axis == "channel":
        elements = set(np.flatnonzero(place.mask).tolist())
        own = [s for run in runs for s in run.series if layout.channel(s.quantity) + s.element in elements]
    free = []
    scan: tuple[float, ...]
    for p in candidate.parameters:
        if p.is_fixed:
            continue
        lower, upper, starts, scan = p.lower, p.upper, p.tried(scales) or p.starts, ()
        if p.is_instant:
            lower, upper = timeline.begin, timeline.end
            starts, scan = (_instants(timeline, count, candidate.scope) for count in (INSTANTS, SCANNED))
        elif p.name == "limit":
            starts = _limits([s for run in runs for s in run.series]) or starts
        elif p.name == "ceiling":
            starts = _ceilings(own) or starts
        negligible = max(p.negligible, _stated(candidate, own))
        believable = believed(candidate, p, own, scales)
        free.append(
            TermParameter(
                p.name,
                p.unit,
                lower,
                upper,
                starts,
                p.is_switch,
                p.is_instant,
                negligible,
                *believable,
                scan,
                p.meaning,
                physical(p, own),
                p.physical == "reading" or (p.unit == "K" and p.is_position),
            )
        )
    return Term(
        candidate.identifier,
        place.label,
        candidate.unit,
        tuple(free),
        candidate.is_named,
        candidate.law,
        is_completing=candidate.is_completing,
    )


def physical(parameter: Parameter, own: Sequence[Series]) -> tuple[float, float, str] | None:
    """Factor, offset and SI unit of the quantity that a number counted in typical readings stands for.

    Args:
        parameter: Of an effect on channels.
        own: Series of these channels, all of one quantity; there may be none.

    Returns:
        None where the number is a quantity itself, or no such channel was recorded.
    """
    if not (parameter.physical and own) or own[0].quantity not in SCALES:
        return None
    (scale, pivot), unit = SCALES[own[0].quantity], own[0].channel.unit
    if parameter.physical == "rate":
        return scale / 60.0, 0.0, f"{unit}/s"
    return scale, pivot if parameter.physical == "reading" else 0.0, unit


def _instants(timeline: Timeline, count: int, scope: Scope) -> tuple[float, ...]:
    """So many instants within each recording, evenly spread, and the begin of each that says something of its own.

    What is there from the begin of the first recording on and lasts is no event. On one day of several it is one.
    """
    found: list[float] = []
    for number in timeline.order:
        seat = timeline.seats[number]
        inside = np.linspace(seat.position, seat.position + seat.end - seat.begin, count + 2)[1:-1]
        is_event = seat.position > timeline.begin or (scope == "day" and len(timeline.days) > 1)
        found += [*([seat.position] if is_event else []), *inside.tolist()]
    return tuple(found)


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
