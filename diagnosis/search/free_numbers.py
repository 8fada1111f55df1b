"""Numbers of a scenario that may be off: which, by how much, and what a point makes of them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np

from cosim.assemble import assemble
from cosim.components import FmuComponent, ProgrammeComponent
from cosim.fmu.archive import open_fmu
from cosim.fmu.settings import FmuSettings, Table
from cosim.fmu.values import array_of
from cosim.fmu.variables import start_value
from cosim.fmu_assembly import find_fmu
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Causality
from cosim.unit.quantity import PhysicalValue, conversion
from diagnosis.faults.programme import InputChange
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording
from diagnosis.recording.units import si_unit
from diagnosis.search.problem import Own, Parameter
from diagnosis.search.shares import RIG_START, own_deviation, own_label, shared_deviation

#: Kind of component to what its numbers may be off by where neither its scenario nor its parameter set says so
#: (deviation of ln(value)): a few per cent, as of a careful rig. Masses are weighed; where a centre lies is worked out.
USUAL: Mapping[str, Mapping[str, float]] = {"bullet_pendulum": {"mass": 0.015, "centre_distance": 0.05}}
_ELEMENT = re.compile(r"^(?P<name>.*?)\[(?P<element>\d+)\]$")


class Movable(Protocol):
    """A change of an input that may have come earlier or later."""

    def moved(self, earlier: float) -> InputChange:
        """What acts beside the recorded course where the change came earlier by a time [s]."""
        ...


@dataclass(frozen=True)
class Free:
    """A number of the scenario that may be off.

    Args:
        parameter: Name, unit, nominal value and prior; where several make up one number, nominal is 0 and the value an
            offset.
        component: Component that has it.
        name: Its parameter, or an output of a programme, which is moved as a whole.
        recordings: Numbers of the recordings that it belongs to alone (an initial state, a day's room), or None: all.
        element: Of a parameter that is a list, from 0; None: every element.
        is_list: Whether the parameter is a list.
        switch: Change of a recorded input whose instant it moves; None: it is a number.
    """

    parameter: Parameter
    component: str
    name: str
    recordings: frozenset[int] | None = None
    element: int | None = None
    is_list: bool = False
    switch: Movable | None = None

    def belongs_to(self, recording: int) -> bool:
        """Whether it acts in a recording."""
        return self.recordings is None or recording in self.recordings

    @property
    def is_own(self) -> bool:
        """Whether it belongs to some recordings alone."""
        return self.recordings is not None


@dataclass(frozen=True)
class Number:
    """A number of a scenario, or a list of them.

    Args:
        values: In `unit`; one where it is no list.
        unit: SI unit of its dimension.
        is_list: Whether it has elements.
    """

    values: tuple[float, ...]
    unit: str
    is_list: bool = False


class Numbers:
    """Numbers of one scenario, each looked up once.

    Args:
        scenario: The scenario, under the conditions of a recording where it is one.
    """

    def __init__(self, scenario: Scenario) -> None:
        self.scenario = scenario
        self._known: dict[tuple[str, str], Number | None] = {}

    def of(self, component: str, name: str) -> Number | None:
        """Values that the scenario, its parameter set or else the FMU itself gives; None where there are none."""
        key = component, name
        if key not in self._known:
            self._known[key] = _number(self.scenario, component, name)
        return self._known[key]

    def is_given(self, component: str, name: str) -> bool:
        """Whether the scenario itself gives it."""
        return name in getattr(self.scenario.components[component], "parameters", {})


def free_parameters(scenario: Scenario, recordings: Sequence[Recording]) -> list[Free]:
    """Numbers that may be off: those whose parameter set states an uncertainty, and what a recording says itself.

    Of a component whose parameters state none, those of `USUAL` may be off. What a recording doubts of a programme, or
    of a temperature, is divided into what the rig shares and what each recording or day has (module `shares`).
    Any other initial state is set by hand each time, and belongs to its recording alone.

    Raises:
        InputError: A recording names something that the scenario does not have.
    """
    return [*_relative(scenario_of(scenario, recordings[0])), *_stated(scenario, recordings)]


def _relative(scenario: Scenario) -> Iterator[Free]:
    assembly = assemble(scenario)
    try:
        for component, resolved in assembly.parameters.items():
            usual = USUAL.get(scenario.components[component].kind, {})
            for name, deviation in (resolved.uncertainty or usual).items():
                value = resolved.values[name]
                if deviation and isinstance(value, PhysicalValue):
                    unit = si_unit(value.unit)
                    parameter = Parameter(f"{component}.{name}", unit, value.to(unit), deviation)
                    yield Free(parameter, component, name)
    finally:
        assembly.system.terminate()


@dataclass(frozen=True)
class _Doubt:
    """What one recording states of one number, or of one element of it."""

    name: str
    element: int | None
    deviation: float
    number: Number
    recording: int
    day: str


def _stated(scenario: Scenario, recordings: Sequence[Recording]) -> list[Free]:
    doubts: dict[str, list[_Doubt]] = {}
    for number, recording in enumerate(recordings):
        numbers = Numbers(scenario_of(scenario, recording))
        # those of single elements last: they count more than one for all
        for key, given in sorted(recording.uncertain.items(), key=lambda item: item[0].endswith("]")):
            doubt = _doubt(numbers, recording, number, key, given)
            own = doubts.setdefault(doubt.name, [])
            own[:] = [d for d in own if (d.recording, d.element) != (number, doubt.element)]
            own.append(doubt)
    found: list[Free] = []
    for name, own in doubts.items():
        is_room = isinstance(scenario.components[name.partition(".")[0]], ProgrammeComponent)
        found += _divided(name, own, is_room) if is_room or own[0].number.unit == "K" else map(_alone, own)
    if not any(f.recordings is None for f in found):
        return sorted(found, key=lambda f: min(f.recordings or (0,)))  # by recording, as they state them
    return found


def check_stated(scenario: Scenario, recording: Recording) -> None:
    """Hold the names, elements and units under `uncertain` against a scenario.

    Raises:
        InputError: One is not there, or its deviation does not fit it.
    """
    numbers = Numbers(scenario)
    for key, given in recording.uncertain.items():
        _doubt(numbers, recording, 0, key, given)


def _doubt(numbers: Numbers, recording: Recording, index: int, key: str, given: PhysicalValue) -> _Doubt:
    """One entry of `uncertain`.

    Raises:
        InputError: There is no such number, or the deviation does not fit it.
    """
    file, where = recording.path / "recording.yaml", f"uncertain.{key}"
    component, _, name = key.partition(".")
    own = numbers.of(component, name) if component in numbers.scenario.components else None
    element, match = None, _ELEMENT.match(name)
    if own is None and match is not None and component in numbers.scenario.components:
        name, element = match["name"], int(match["element"]) - 1
        own = numbers.of(component, name)
        if own is not None and not (own.is_list and 0 <= element < len(own.values)):
            there = f"{len(own.values)} elements" if own.is_list else "no elements"
            raise InputError(file, where, f"{component}.{name} has {there}", "name one that it has, from 1")
    if own is None:
        raise InputError(
            file, where, "the scenario has no such number", "name `component.parameter`, or an output of a programme"
        )
    try:
        factor = conversion(given.unit or own.unit, own.unit)[0]
    except ValueError as error:
        raise InputError(file, where, str(error), f"give a positive difference in {own.unit}") from error
    if not given.number > 0:
        raise InputError(file, where, f"{given} is not positive", f"give a positive difference in {own.unit}")
    return _Doubt(f"{component}.{name}", element, factor * given.number, own, index, recording.day)


def _alone(doubt: _Doubt) -> Free:
    """A number that belongs to its recording wholly."""
    label = doubt.name if doubt.element is None else f"{doubt.name}[{doubt.element + 1}]"
    component, _, name = doubt.name.partition(".")
    value = doubt.number.values[doubt.element or 0]
    own = Own(label, doubt.recording)
    parameter = Parameter(own_label(own), doubt.number.unit, value, doubt.deviation, False, own=own)
    return Free(parameter, component, name, frozenset((doubt.recording,)), doubt.element, doubt.number.is_list)


def _divided(name: str, doubts: Sequence[_Doubt], is_room: bool) -> Iterator[Free]:
    """What the rig shares of a number, and what each recording has of it: the room one for a day, starts one for each.

    A list has one number for each element and recording beside what all share.
    """
    whole = [d for d in doubts if d.element is None]
    shared = shared_deviation([d.deviation for d in doubts], math.inf if is_room else RIG_START) if whole else 0.0
    if whole:
        yield _offset(name, whole[0], f"offset of {name}", shared)
    members: dict[str, list[_Doubt]] = {}
    owners: dict[str, Own] = {}
    for d in doubts:
        elements: Iterable[int | None] = (d.element,)
        if d.element is None and d.number.is_list:
            others = {o.element for o in doubts if o.recording == d.recording}
            elements = [i for i in range(len(d.number.values)) if i not in others]
        for element in elements:
            label = f"offset of {name}" + ("" if element is None else f"[{element + 1}]")
            own = Own(label, d.recording, d.day if is_room else "")
            owners.setdefault(own_label(own), own)
            members.setdefault(own_label(own), []).append(replace(d, element=element))
    for label, own_doubts in members.items():
        left = own_deviation(min(d.deviation for d in own_doubts), shared)
        yield _offset(name, own_doubts[0], label, left, frozenset(d.recording for d in own_doubts), owners[label])


def _offset(
    name: str,
    doubt: _Doubt,
    label: str,
    deviation: float,
    recordings: frozenset[int] | None = None,
    own: Own | None = None,
) -> Free:
    component, _, field = name.partition(".")
    parameter = Parameter(label, doubt.number.unit, 0.0, deviation, False, own=own)
    return Free(parameter, component, field, recordings, doubt.element, doubt.number.is_list)


def moved(numbers: Numbers, free: Iterable[tuple[Free, float]]) -> dict[tuple[str, str], Number]:
    """Values at a point: (component, name) to its number; of a programme the amount by which it is moved.

    Args:
        numbers: Of the scenario that is changed; what it gives itself is what is moved, else the nominal value.
        free: What may be off, with its z.
    """
    groups: dict[tuple[str, str], list[tuple[Free, float]]] = {}
    for one, z in free:
        groups.setdefault((one.component, one.name), []).append((one, z))
    found = {}
    for (component, name), members in groups.items():
        first = members[0][0]
        is_programme = isinstance(numbers.scenario.components[component], ProgrammeComponent)
        is_known = first.is_own or first.parameter.nominal == 0.0 or numbers.is_given(component, name)
        known = numbers.of(component, name) if is_known else None
        if is_programme or known is None or known.unit != first.parameter.unit:
            known = Number((0.0 if is_programme else first.parameter.nominal,), first.parameter.unit)
        values = np.array(known.values)
        for one, z in members:
            p, at = one.parameter, slice(None) if one.element is None else slice(one.element, one.element + 1)
            if p.is_relative:
                values[at] = values[at] * math.exp(p.deviation * z)
            else:
                values[at] = values[at] + p.deviation * z
        found[component, name] = Number(tuple(values.tolist()), known.unit, known.is_list)
    return found


def _number(scenario: Scenario, component: str, name: str) -> Number | None:
    given = scenario.components[component]
    if isinstance(given, ProgrammeComponent):
        output = given.outputs.get(name)
        return None if output is None else Number((0.0,), si_unit(output.unit))
    assembly = assemble(scenario)
    try:
        given = assembly.scenario.components[component]  # an actuator with its size
        resolved = assembly.parameters.get(component)
        value = None if resolved is None else resolved.values.get(name)
    finally:
        assembly.system.terminate()
    if isinstance(given, FmuComponent):
        return _of_fmu(given, component, name, value, scenario.path or Path())
    if not isinstance(value, PhysicalValue):
        return None
    unit = si_unit(value.unit)
    return Number((value.to(unit),), unit)


def _of_fmu(given: FmuComponent, component: str, name: str, value: object, source: Path) -> Number | None:
    """A parameter of an FMU: what the scenario or its set gives, else the FMU's own start value."""
    archive = open_fmu(find_fmu(given, source))
    try:
        table = Table(component, archive, FmuSettings(given.structure))
        variable = table.all.get(name)
        if variable is None or variable.variable.causality is not Causality.PARAMETER or variable.is_structural:
            return None
        v = variable.variable
        if not v.type.is_float or len(v.shape) > 1:
            return None
        array = start_value(variable.declared, v.type, v.shape) if value is None else None
        if value is not None:
            array = array_of(variable, value, table.units)
        if array is None:
            return None
    finally:
        archive.remove()
    unit = si_unit(v.unit)
    factor, offset = conversion(v.unit, unit)
    # in FMI 3.0 one start value may stand for all elements
    values = factor * np.broadcast_to(np.asarray(array, dtype=np.float64), v.shape).reshape(-1) + offset
    return Number(tuple(values.tolist()), unit, bool(v.shape))
