"""Connections between variables, and carrying them out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import AnyArray, Unit, UnitError, Variable, VariableType

#: Zero-based index of one element of an array.
Element = tuple[int, ...]


class ConnectionFault(ValueError):
    """A connection or a component does not fit; the text names it and the remedy."""


@dataclass(frozen=True)
class Connection:
    """A directed connection `source_unit.source_variable -> target_unit.target_variable`, whole or of one element.

    Args:
        source: (unit, variable) of an output.
        target: (unit, variable) of an input.
        factor: Target value = factor * source value + offset (unit conversion and scaling).
        offset: See factor, in the unit of the target.
        source_element: The one element that is read; None reads the whole array.
        target_element: The one element that is written; None writes the whole array.
    """

    source: tuple[str, str]
    target: tuple[str, str]
    factor: float = 1.0
    offset: float = 0.0
    source_element: Element | None = None
    target_element: Element | None = None

    @property
    def is_scaled(self) -> bool:
        """Whether the value changes on the way."""
        return self.factor != 1.0 or self.offset != 0.0

    def __str__(self) -> str:
        return f"{_end(self.source, self.source_element)} -> {_end(self.target, self.target_element)}"


def _end(end: tuple[str, str], element: Element | None) -> str:
    return ".".join(end) + ("" if element is None else f"[{','.join(str(i + 1) for i in element)}]")


class Part:
    """One connection bound to its source and to the buffer of its target.

    Args:
        connection: What is connected.
        source: The unit that is read.
        buffer: Array of the target input that is written; shape of the target.
    """

    def __init__(self, connection: Connection, source: Unit, buffer: AnyArray) -> None:
        self.connection, self.source, self.buffer = connection, source, buffer
        self._name = connection.source[1]
        self._from = connection.source_element
        self._to: Element | tuple[()] = connection.target_element if connection.target_element is not None else ()

    def copy(self) -> None:
        """Copy the source's value into the buffer, scaled."""
        value = self.source.get(self._name)
        if self._from is not None:
            value = value[self._from]
        elif value.dtype == object and not value.shape:
            value = value.item()  # numpy would keep the array itself in an array of objects
        connection = self.connection
        if connection.is_scaled:
            value = connection.factor * value + connection.offset
        self.buffer[self._to] = value


class Transfer:
    """Everything that leads into one input, ready to be carried out.

    Args:
        target: The unit that is written.
        variable: Its input.
    """

    def __init__(self, target: Unit, variable: Variable) -> None:
        self.target, self.variable = target, variable
        self.parts: list[Part] = []
        self.buffer: AnyArray = np.empty(variable.shape, variable.type.dtype)
        if variable.start is not None:
            self.buffer[...] = variable.start

    @property
    def is_clock(self) -> bool:
        """Whether it hands over ticks: each time that it is carried out while its source ticks, the target ticks."""
        return self.variable.type is VariableType.CLOCK

    @property
    def end(self) -> tuple[str, str]:
        """(unit, input)."""
        return self.target.name, self.variable.name

    def add(self, connection: Connection, source: Unit) -> None:
        """Let one more connection lead into this input.

        Raises:
            ConnectionFault: Another one leads into the same element already.
        """
        for other in (p.connection for p in self.parts):
            if connection.target_element is None or other.target_element in (None, connection.target_element):
                raise ConnectionFault(
                    f"{connection}: another connection already leads into {'.'.join(self.end)}: {other}"
                )
        self.parts.append(Part(connection, source, self.buffer))

    @property
    def missing(self) -> Element | None:
        """First element that nothing leads into and that has no start value; None if there is none."""
        if self.variable.start is not None or any(p.connection.target_element is None for p in self.parts):
            return None
        reached = {p.connection.target_element for p in self.parts}
        return next((e for e in np.ndindex(self.variable.shape) if e not in reached), None)

    def carry_out(self) -> None:
        """Copy the outputs to the input; raises UnitError, naming the connection, if one is not finite."""
        for part in self.parts:
            part.copy()
        self.write()

    def write(self) -> None:
        """Hand the buffer to the unit."""
        try:
            self.target.set(self.variable.name, self.buffer)
        except UnitError as error:
            through = ", ".join(str(p.connection) for p in self.parts[:3]) + (" ..." if len(self.parts) > 3 else "")
            raise UnitError(error.unit, f"{error.what}, through {through}", error.time, error.remedy) from error
