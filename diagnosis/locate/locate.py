"""Every unit driven alone and tested: the table of the location."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.judge.location import WHOLE, Location, Proposal, Waveform
from diagnosis.locate.course import Course, course
from diagnosis.locate.fitted import Fitted, fitted
from diagnosis.locate.investigate import investigate
from diagnosis.locate.panel import Panel, panels
from diagnosis.locate.replay import ELECTRICAL, THERMAL, Replay, electrical, field_of, mechanical, thermal
from diagnosis.locate.statistic import Tested, refitted, tested
from diagnosis.models.coil_network.kernel.places import coil_label
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Model
from diagnosis.search.structure import structure

Unit = Callable[[Fitted, Sequence[Course], Sequence[Panel]], list[Replay]]
#: Times that a unit is linearised, at most, and how far its parameters must have moved for it [prior deviations].
LINEARISED, FAR = 3, 1.5


@dataclass(frozen=True)
class Located:
    """Where a recalibrated model departs from the recordings.

    Args:
        locations: One line for each unit, the strongest departure first.
        waveforms: Unknown input at the equations of units that depart by more than noise.
        proposals: Laws for these inputs, the best first.
    """

    locations: tuple[Location, ...]
    waveforms: tuple[Waveform, ...] = ()
    proposals: tuple[Proposal, ...] = ()


@dataclass(frozen=True)
class UnitTest:
    """A unit driven alone, with its test.

    Args:
        replay: The unit.
        tested: What was found.
        location: The line of the table.
        courses: Of every recording, at the point where it was tested.
    """

    replay: Replay
    tested: Tested
    location: Location
    courses: Sequence[Course]


def locate(model: DiagnosisModel, fit: Fit, titles: Sequence[str], seed: int = 0) -> Located:
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
    tests = unit_tests(own, titles, seed)
    lines: list[Location] = []
    waveforms: list[Waveform] = []
    proposals: list[Proposal] = []
    for unit in sorted(tests, key=lambda t: -abs(t.location.z) / t.location.limit):
        if unit.location.is_noise:
            lines.append(unit.location)
            continue
        found = investigate(unit.replay, unit.tested, unit.location, unit.courses, titles)
        lines.append(found.location)
        waveforms += found.waveforms
        proposals += found.proposals
    return Located(tuple(lines), tuple(waveforms), tuple(sorted(proposals, key=lambda p: -p.gain)))


def closed(model: Model, fit: Fit) -> tuple[Location, ...]:
    """Units by the residuals of the closed simulation, where no unit can be driven alone (a fabric, another FMU)."""
    found = []
    for unit in dict.fromkeys(model.layout.units):
        chosen = np.array([model.layout.units[int(c)] == unit for c in model.layout.channel])
        left = structure(np.where(chosen, fit.residuals, 0.0), model.layout)
        equation = WHOLE
        found.append(
            Location(
                _called(unit, model), equation, left.channels, left.channels, left.begin, left.end, left.z, left.limit
            )
        )
    return tuple(sorted(found, key=lambda location: -abs(location.z) / location.limit))


def _called(unit: str, model: Model) -> str:
    """The part of a model in words: what is in no other part is mechanical only where its channels are."""
    targets = [s.channel.target for run in getattr(model, "runs", ()) for s in run.series]
    if unit != "mechanical" or len(targets) != len(model.layout.units):
        return unit
    own = [t for t, u in zip(targets, model.layout.units) if u == unit]
    return unit if all(t.is_mechanical for t in own) else "other"


def unit_tests(model: Fitted, titles: Sequence[str], seed: int = 0) -> list[UnitTest]:
    """Drive every unit alone with the recorded inputs and test what is left.

    Args:
        model: Recalibrated.
        titles: Of the recordings.
        seed: Of the simulated noise.
    """
    tests = _unit_test(model, electrical, titles, seed)
    is_electrical = any(not t.location.is_noise for t in tests)
    heated = _unit_test(model, thermal, titles, seed)
    if is_electrical and heated and not heated[0].location.is_noise:
        # Power that a string takes beyond I^2 R may heat its coils, all of them or one.
        for shares in _shares(model, heated[0]):
            other = _unit_test(model, partial(thermal, shares=shares), titles, seed)
            heated = min(heated, other, key=lambda t: abs(t[0].location.z))
    return [*tests, *heated, *_unit_test(model, mechanical, titles, seed)]


def _shares(model: Fitted, heated: UnitTest) -> list[Array]:
    """All coils of each string alike, or all of it in the coil that departs most of each string."""
    strings = model.coils.string_of_coil
    even = 1.0 / np.bincount(strings)[strings]
    single = even.copy()
    worst = np.zeros(model.coils.coils)
    for (number, k), z in heated.tested.by_element.items():
        coil = int(heated.tested.panels[number].elements[k])
        worst[coil] = max(worst[coil], abs(z))
    for string in np.unique(strings):
        members = np.flatnonzero(strings == string)
        first = members[np.argmax(worst[members])]
        if worst[first] > heated.location.limit:
            single[members] = 0.0
            single[first] = 1.0
    return [even, single]


def _unit_test(model: Fitted, unit: Unit, titles: Sequence[str], seed: int) -> list[UnitTest]:
    """A unit's tests, at the point that its own channels want: linearised again while its parameters move far."""
    for attempt in range(LINEARISED):
        courses = [course(model, n) for n in range(len(model.network.runs))]
        found = [p for q in model.network.measured for p in panels(model, q)]
        replays = unit(model, courses, found)
        refits = [refitted(replay.panels, _prior(model, replay)) for replay in replays]
        change = np.zeros(len(model.parameters))
        for replay, refit in zip(replays, refits):
            own = refit.change[: len(change)] * is_own(model, replay)
            change = np.where(np.abs(own) > np.abs(change), own, change)
        is_near = attempt + 1 == LINEARISED or np.abs(change).max(initial=0.0) < FAR
        other = None if is_near else model.moved(change)
        if other is None:
            break
        model = other
    tests = []
    for replay, refit in zip(replays, refits):
        outcome = tested(refit, [summed(model, p) for p in replay.panels], seed)
        tests.append(UnitTest(replay, outcome, _location(model, replay, outcome, titles), courses))
    return tests


def summed(model: Fitted, panel: Panel) -> list[Array]:
    """Channels that are summed: each alone, those of each string, all."""
    count = len(panel.elements)
    groups = [np.array([n]) for n in range(count)]
    if panel.quantity not in ("current", "supply_current") and model.coils.strings:
        strings = model.coils.string_of_coil[panel.elements]
        groups += [np.flatnonzero(strings == s) for s in np.unique(strings) if 1 < np.sum(strings == s) < count]
    return groups + ([np.arange(count)] if count > 1 else [])


def is_own(model: Fitted, replay: Replay) -> Array:
    """1 for each parameter that is one of the unit's own, else 0, shape (parameters,)."""
    touched = np.any([np.any(p.columns, axis=(0, 1))[: len(model.parameters)] for p in replay.panels], axis=0)
    if replay.unit in ("electrical", "thermal"):
        return np.asarray(touched, dtype=np.float64)
    return np.array([float(t and field_of(p) not in THERMAL | ELECTRICAL) for t, p in zip(touched, model.parameters)])


def _prior(model: Fitted, replay: Replay) -> Array:
    """What brings the unit's own parameters back to their nominal values; others are taken as they were found."""
    prior = np.zeros(replay.panels[0].columns.shape[2])
    prior[: len(model.parameters)] = -model.fit.point.base / model.fit.widths * is_own(model, replay)
    return prior


def _location(model: Fitted, replay: Replay, tested: Tested, titles: Sequence[str]) -> Location:
    peak = tested.peak
    panel = tested.panels[peak.panel]
    names = [model.network.layout.names[panel.channels[k]] for k in peak.members]
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
