"""The values of an FMU's inputs and outputs as numpy arrays that the FMU reads and writes in place."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from cosim.fmu.access import Access
from cosim.fmu.binding import Binding
from cosim.fmu.variables import FmuVariable
from cosim.unit.protocol import AnyArray, Causality, UnitError, VariableType, element_text

Saved = list[AnyArray]


class Buffers:
    """Arrays of inputs, and of everything that is read after a step.

    All that is read and has one type lies in one block, so that one call reads it; each variable is a view into it.

    Args:
        binding: The FMU.
        variables: Its inputs, its outputs and the recorded local variables.
    """

    def __init__(self, binding: Binding, variables: Mapping[str, FmuVariable]) -> None:
        self._name = binding.name
        self.values: dict[str, AnyArray] = {}
        self.writers: dict[str, Access] = {}
        self.readers: list[Access] = []
        #: The calls that `read` makes, one for each type.
        self.group_readers: list[Access] = []
        self._blocks: list[AnyArray] = []
        self._scalars: list[AnyArray] = []
        self._checked: list[tuple[AnyArray, AnyArray]] = []
        #: What is done to outputs that were read, before anybody sees them.
        self.added: Callable[[], None] | None = None
        read: dict[VariableType, dict[str, FmuVariable]] = {}
        for name, v in variables.items():
            if v.variable.type is VariableType.CLOCK:  # in Event Mode alone: cosim.fmu.clocks
                self.values[name] = np.zeros(v.variable.shape, dtype=np.bool_)
            elif v.is_added:  # no call sets it
                self.values[name] = _filled(v)
            elif v.variable.causality is Causality.INPUT:
                self.values[name] = _filled(v)
                self.writers[name] = binding.writer(v, self.values[name])
            else:
                read.setdefault(v.variable.type, {})[name] = v
        for vtype, members in read.items():
            self._add_block(binding, vtype, members)
        #: Arrays that no other is a view into: inputs, blocks, clocks.
        self._all = [*(v for v in self.values.values() if v.base is None), *self._blocks]
        self.input_readers = {n: binding.reader(variables[n], self.values[n]) for n in self.writers}

    def _add_block(self, binding: Binding, vtype: VariableType, members: Mapping[str, FmuVariable]) -> None:
        block: AnyArray = np.zeros(sum(v.variable.size for v in members.values()), dtype=vtype.dtype)
        if vtype is VariableType.STRING:
            block.fill("")
        elif vtype is VariableType.BINARY:
            block.fill(b"")
        begin = 0
        for name, v in members.items():
            view = block[begin : begin + v.variable.size].reshape(v.variable.shape)
            self.values[name] = view
            self.readers.append(binding.reader(v, view))
            begin += v.variable.size
        self._blocks.append(block)
        if block.size:
            self.group_readers.append(binding.group_reader(list(members.values()), block))
        if vtype.is_float and block.size == 1:
            self._scalars.append(block)
        elif vtype.is_float:
            self._checked.append((block, np.zeros_like(block)))

    def read(self, time: int | None = None) -> None:
        """Get all outputs.

        Raises:
            UnitError: The FMU refuses, or a number is not finite.
        """
        for get in self.group_readers:
            get()
        for block in self._scalars:
            if not math.isfinite(block.item()):
                raise self._not_finite(time)
        for block, zeros in self._checked:
            # Infinity and NaN times zero are NaN: one product finds them all, four times as fast as isfinite().all().
            if zeros.dot(block) != 0.0:
                raise self._not_finite(time)
        if self.added is not None:
            self.added()

    def _not_finite(self, time: int | None) -> UnitError:
        names = (n for n, v in self.values.items() if n not in self.writers and v.dtype.kind == "f")
        found = next(n for n in names if not np.isfinite(self.values[n]).all())
        what = f"output {found}{element_text(self.values[found])} is not a finite number"
        return UnitError(self._name, what, time)

    def save(self) -> Saved:
        """Copies of all values."""
        return [a.copy() for a in self._all]

    def restore(self, saved: Saved) -> None:
        """Return to saved values."""
        for array, copy in zip(self._all, saved, strict=True):
            array[...] = copy


def _filled(v: FmuVariable) -> AnyArray:
    """The declared start value where there is one."""
    empty: Any = {VariableType.STRING: "", VariableType.BINARY: b""}.get(v.variable.type, 0)
    values: AnyArray = np.empty(v.variable.shape, dtype=v.variable.type.dtype)
    if v.variable.start is None or values.dtype == object:
        values.fill(empty)
    if v.variable.start is not None:
        values[...] = v.variable.start
    return values
