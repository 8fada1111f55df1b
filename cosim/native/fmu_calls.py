"""Calls of a Co-Simulation FMU as operations."""

from __future__ import annotations

import ctypes
import math

from cosim.fmu.access import Access, address_of
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.native.action import Call
from cosim.native.layout import ELEMENT_TYPES, Code, Operation
from cosim.unit.protocol import AnyArray, Array


def write_call(access: Access, given: AnyArray, unit: int) -> Call | None:
    """Set one input to the values in `given`; None where Python has to translate them (text, binary data)."""
    if not _is_carried(access) or given.dtype != access.values.dtype:
        return None
    call = _access_call(access, Code.WRITE_FMI3 if _is_fmi3(access) else Code.WRITE_FMI2, unit)
    operation = call.operation
    operation.source_type = ELEMENT_TYPES[given.dtype.name]
    operation.source = given.ctypes.data
    operation.held = access.values.ctypes.data
    operation.held_bytes = given.nbytes
    operation.source_step = 1
    operation.factor = 1.0
    if access.is_direct:
        operation.target = given.ctypes.data
    return call


def read_calls(access: Access, unit: int) -> list[Call] | None:
    """Get one or more outputs; None where Python has to translate their values."""
    if not _is_carried(access):
        return None
    call = _access_call(access, Code.READ_FMI3 if _is_fmi3(access) else Code.READ_FMI2, unit)
    return [call] if access.is_direct else [call, _conversion(access.buffer, access.values, unit)]


def is_plain(unit: CoSimulationUnit, connected: set[str]) -> bool:
    """Whether a step is nothing but inputs, doStep and outputs while no event comes up.

    Args:
        unit: The FMU.
        connected: Its inputs that something is connected to.
    """
    if not unit.clocks.is_empty:
        return False
    # A discrete input that is set takes an FMU with Event Mode there.
    return not (unit.binding.uses_event_mode and any(unit.table.exposed[name].is_discrete for name in connected))


def next_event(unit: CoSimulationUnit) -> float:
    """Time of the next time event [s]; infinity if there is none."""
    return math.inf if unit.next_event is None else unit.next_event


def step_call(unit: CoSimulationUnit, index: int, due: Array) -> Call:
    """fmi2DoStep or fmi3DoStep.

    Args:
        unit: The FMU.
        index: Number of its wall time.
        due: Time of its next time event [s], shape (1,); kept up to date by the caller.
    """
    binding = unit.binding
    is_fmi3 = binding.prefix == "fmi3"
    operation = Operation(
        code=Code.STEP_FMI3 if is_fmi3 else Code.STEP_FMI2,
        unit=index,
        function=address_of(binding.step_function),
        component=binding.fmu.component,
        due=due.ctypes.data,
    )
    if is_fmi3:
        *flags, operation.reached = map(ctypes.addressof, binding.step_results)
        operation.flags[:] = flags
    return Call(operation, binding, "step_function", binding.step_results)


def is_carried(array: AnyArray) -> bool:
    """Whether the library can read and write an array by its address."""
    return array.dtype.name in ELEMENT_TYPES and bool(array.flags["C_CONTIGUOUS"])


def _is_carried(access: Access) -> bool:
    return is_carried(access.values) and is_carried(access.buffer)


def _is_fmi3(access: Access) -> bool:
    return access.function.startswith("fmi3")


def _access_call(access: Access, code: Code, unit: int) -> Call:
    operation = Operation(
        code=code,
        unit=unit,
        target_type=ELEMENT_TYPES[access.buffer.dtype.name],
        function=address_of(access.call),
        component=access.arguments[0],
        references=ctypes.addressof(access.references),
        reference_count=len(access.references),
        target=access.buffer.ctypes.data,
        count=access.buffer.size,
    )
    return Call(operation, access, "call")


def _conversion(source: AnyArray, target: AnyArray, unit: int) -> Call:
    """FMI 2.0's Booleans and enumerations are C integers."""
    operation = Operation(
        code=Code.CONVERT,
        unit=unit,
        source_type=ELEMENT_TYPES[source.dtype.name],
        target_type=ELEMENT_TYPES[target.dtype.name],
        source=source.ctypes.data,
        target=target.ctypes.data,
        count=target.size,
        source_step=1,
        factor=1.0,
    )
    return Call(operation)
