"""A law at a place of one FMU, in the names of its variables: what a scenario says under `added_terms`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from cosim.components import AddedDelayEntry, AddedInputEntry, AddedStateEntry, AddedTermEntry
from cosim.unit.quantity import PhysicalValue


@dataclass(frozen=True)
class PlacedState:
    """A state of its own.

    Args:
        name: Symbol in the formulas.
        rate: Formula of its derivative.
        start: Formula of its value at the start.
        unit: Its unit.
    """

    name: str
    rate: str
    start: str
    unit: str


@dataclass(frozen=True)
class PlacedDelay:
    """An input as it was some time ago.

    Args:
        name: Symbol in the formulas.
        of: The input.
        by: Number that is the time.
    """

    name: str
    of: str
    by: str


@dataclass(frozen=True)
class PlacedInput:
    """A quantity of another component.

    Args:
        name: Symbol in the formulas.
        of: `component.variable`.
        unit: Its unit in the formulas.
    """

    name: str
    of: str
    unit: str


@dataclass(frozen=True)
class Placed:
    """What is added to one derivative, input or output.

    Args:
        component: Name of the FMU in the scenario.
        to: `der(state)`, or an input or output.
        formula: In the FMU's variables, `time`, numbers, constants and own states.
        numbers: Names of the free numbers with their units.
        constants: Names to values with units of what is not fitted.
        states: Its own states.
        delays: Delayed inputs.
        is_share: Whether the formula is a share of the derivative as the FMU has it.
        inputs: Quantities of other components.
    """

    component: str
    to: str
    formula: str
    numbers: tuple[tuple[str, str], ...]
    constants: Mapping[str, PhysicalValue] = field(default_factory=dict)
    states: tuple[PlacedState, ...] = ()
    delays: tuple[PlacedDelay, ...] = ()
    is_share: bool = False
    inputs: tuple[PlacedInput, ...] = ()

    @property
    def parameter(self) -> str:
        """Parameter of which it is a share; empty where it is added to something else."""
        begin = "parameter("
        return self.to[len(begin) : -1] if self.to.startswith(begin) else ""

    def entry(self, values: tuple[float, ...]) -> AddedTermEntry:
        """The same in a scenario, with values of its numbers."""
        numbers = {name: PhysicalValue(v, unit) for (name, unit), v in zip(self.numbers, values)}
        states = {s.name: AddedStateEntry(rate=s.rate, start=s.start, unit=s.unit) for s in self.states}
        delays = {d.name: AddedDelayEntry(of=d.of, by=d.by) for d in self.delays}
        parameters = {**numbers, **self.constants}
        return AddedTermEntry(
            to=self.to,
            formula=self.formula,
            is_share=self.is_share,
            parameters=parameters,
            states=states,
            delays=delays,
            inputs={i.name: AddedInputEntry(of=i.of, unit=i.unit) for i in self.inputs},
        )


def placed_of(component: str, entry: AddedTermEntry) -> tuple[Placed, tuple[float, ...]]:
    """What a scenario adds already, with its values."""
    numbers = {name: PhysicalValue.parse(v) for name, v in entry.parameters.items()}
    states = tuple(PlacedState(name, s.rate, s.start, s.unit) for name, s in entry.states.items())
    delays = tuple(PlacedDelay(name, d.of, d.by) for name, d in entry.delays.items())
    units = tuple((n, v.unit) for n, v in numbers.items())
    inputs = tuple(PlacedInput(name, i.of, i.unit) for name, i in entry.inputs.items())
    placed = Placed(component, entry.to, entry.formula, units, {}, states, delays, entry.is_share, inputs)
    return placed, tuple(v.number for v in numbers.values())
