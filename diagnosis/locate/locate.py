"""Every unit driven alone and tested: the table of the location."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit import Array
from diagnosis.bank.places import coil_label
from diagnosis.judge.location import Location, Waveform
from diagnosis.locate.course import Course, course
from diagnosis.locate.fitted import Fitted, fitted
from diagnosis.locate.panel import Panel, panels
from diagnosis.locate.replay import ELECTRICAL, THERMAL, Replay, electrical, field_of, mechanical, thermal
from diagnosis.locate.statistic import Tested, tested
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Model
from diagnosis.search.structure import structure


@dataclass(frozen=True)
class Located:
    """Where a recalibrated model departs from the recordings.

    Args:
        locations: One line for each unit, the strongest departure first.
        waveforms: Unknown input at the equations of units that depart by more than noise.
    """

    locations: tuple[Location, ...]
    waveforms: tuple[Waveform, ...] = ()


@dataclass(frozen=True)
class UnitTest:
    """A unit driven alone, with its test.

    Args:
        replay: The unit.
        tested: What was found.
        location: The line of the table.
    """

    replay: Replay
    tested: Tested
    location: Location


def locate(model: Model, fit: Fit, titles: Sequence[str], seed: int = 0) -> Located:
    """Where and when each unit, driven alone with the recorded inputs, departs from the recordings.

    Args:
        model: The model with its recordings.
        fit: Recalibrated, without terms.
        titles: Of the recordings.
        seed: Of the simulated noise.
    """
    own = fitted(model, fit)
    if own is None:
        return Located(closed(model, fit))
    tests, _ = unit_tests(own, titles, seed)
    lines = sorted((t.location for t in tests), key=lambda found: -abs(found.z) / found.limit)
    return Located(tuple(lines))


def closed(model: Model, fit: Fit) -> tuple[Location, ...]:
    """Units by the residuals of the closed simulation, where no unit can be driven alone (a fabric, another FMU)."""
    found = []
    for unit in dict.fromkeys(model.layout.units):
        chosen = np.array([model.layout.units[int(c)] == unit for c in model.layout.channel])
        left = structure(np.where(chosen, fit.residuals, 0.0), model.layout)
        equation = "all its equations; not driven alone: the whole simulation runs by itself"
        found.append(Location(unit, equation, left.channels, left.channels, left.begin, left.end, left.z, left.limit))
    return tuple(sorted(found, key=lambda location: -abs(location.z) / location.limit))


def unit_tests(model: Fitted, titles: Sequence[str], seed: int = 0) -> tuple[list[UnitTest], list[Course]]:
    """Drive every unit alone with the recorded inputs and test what is left.

    Args:
        model: Recalibrated.
        titles: Of the recordings.
        seed: Of the simulated noise.
    """
    courses = [course(model, n) for n in range(len(model.bank.runs))]
    found = [p for q in model.bank.measured for p in panels(model, q)]
    replays = [electrical(model, courses, found), thermal(model, courses, found)]
    replays += mechanical(model, courses, found)
    tests = []
    for replay in replays:
        if replay is not None:
            groups = [summed(model, p) for p in replay.panels]
            outcome = tested(replay.panels, groups, _prior(model, replay), seed)
            tests.append(UnitTest(replay, outcome, _location(model, replay, outcome, titles)))
    return tests, courses


def summed(model: Fitted, panel: Panel) -> list[Array]:
    """Channels that are summed: each alone, those of each string, all."""
    count = len(panel.elements)
    groups = [np.array([n]) for n in range(count)]
    if panel.quantity not in ("current", "supply_current") and model.coils.strings:
        strings = model.coils.string_of_coil[panel.elements]
        groups += [np.flatnonzero(strings == s) for s in np.unique(strings) if 1 < np.sum(strings == s) < count]
    return groups + ([np.arange(count)] if count > 1 else [])


def _prior(model: Fitted, replay: Replay) -> Array:
    """What brings the unit's own parameters back to their nominal values; others are taken as they were found."""
    is_mechanical = replay.unit not in ("electrical", "thermal")
    size = replay.panels[0].columns.shape[2]
    prior = np.zeros(size)
    for n, (parameter, z) in enumerate(zip(model.parameters, model.fit.point.base)):
        if not (is_mechanical and field_of(parameter) in THERMAL | ELECTRICAL):
            prior[n] = -z
    return prior


def _location(model: Fitted, replay: Replay, tested: Tested, titles: Sequence[str]) -> Location:
    peak = tested.peak
    panel = tested.panels[peak.panel]
    names = [model.bank.layout.names[panel.channels[k]] for k in peak.members]
    return Location(
        unit=replay.unit,
        equation=f"{replay.equation}; driven by {replay.driven_by}",
        element=element_of(model, panel, peak.members),
        channel=names[0] if len(names) == 1 else f"{len(names)} channels of {panel.quantity}",
        begin=float(panel.times[peak.begin]),
        end=float(panel.times[min(peak.end, len(panel.times) - 1)]),
        z=peak.z,
        limit=tested.limit,
        recording=titles[panel.recording],
    )


def element_of(model: Fitted, panel: Panel, members: Array) -> str:
    """`coil[2,5]`, `string[3]`, `all coils`, `all strings` or `supply`."""
    elements = panel.elements[members]
    if panel.quantity == "supply_current":
        return "supply"
    if panel.quantity == "current":
        return f"string[{elements[0] + 1}]" if len(elements) == 1 else "all strings"
    if len(elements) == 1:
        return coil_label(model.coils, int(elements[0]))
    strings = set(model.coils.string_of_coil[elements].tolist())
    return f"string[{strings.pop() + 1}]" if len(strings) == 1 and len(model.coils.strings) > 1 else "all coils"
