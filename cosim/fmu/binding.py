"""Calls into a loaded FMU, with one interface for FMI 2.0 and 3.0 and every status checked.

Values pass through preallocated buffers and the functions of the shared library itself, because fmpy's list calls
cost several times as much (see docs/decisions/0006-fmu-calls.md); loading and rare calls go through fmpy.
"""

from __future__ import annotations

import ctypes
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from fmpy.fmi1 import FMICallException

from cosim.fmu.access import (
    Access,
    BinaryReader,
    BinaryWriter,
    ConvertingReader,
    ConvertingWriter,
    TextReader,
    TextWriter,
)
from cosim.fmu.archive import FmuArchive
from cosim.fmu.shared_library import fault_of_library
from cosim.fmu.sizes import MOST_BYTES
from cosim.fmu.types import CType
from cosim.fmu.variables import FmuVariable
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, UnitError, VariableType

Interface = Literal["co_simulation", "model_exchange"]

_STATUS = {1: "warning", 2: "discard", 3: "error", 4: "fatal", 5: "pending"}
WARNING, DISCARD, FATAL = 1, 2, 4
#: File of an FMU that may be instantiated once per process, to the name of the unit that uses it.
_ONLY_ONCE: dict[Path, str] = {}


class StepResult(NamedTuple):
    """What a Co-Simulation step ended with (a named tuple: made at every step, it costs half of a frozen dataclass).

    Args:
        reached: Time reached [s].
        event: Whether the FMU asks for Event Mode.
        early: Whether it returned before the end of the step.
        discarded: Whether it refused the step (fmi2Discard, fmi3Discard).
        terminate: Whether it asks to end the simulation.
    """

    reached: float
    event: bool = False
    early: bool = False
    discarded: bool = False
    terminate: bool = False


_SPOKEN: dict[Interface, str] = {"co_simulation": "Co-Simulation", "model_exchange": "Model Exchange"}


def other_interface(archive: FmuArchive) -> str:
    """What to do where an FMU lacks the interface that was asked for."""
    description = archive.description
    if description.coSimulation is not None:
        return "it has Co-Simulation: write `integrator: internal`"
    if description.modelExchange is not None:
        return "it has Model Exchange: write `integrator: cvode`"
    only = (
        "it has Scheduled Execution alone, which is not supported; "
        if description.scheduledExecution is not None
        else ""
    )
    return f"{only}export it for Co-Simulation or Model Exchange"


@dataclass(frozen=True)
class DiscreteStates:
    """Result of fmi3UpdateDiscreteStates or fmi2NewDiscreteStates.

    Args:
        again: Whether the FMU wants another iteration.
        terminate: Whether it asks to end the simulation.
        nominals_changed: Whether nominal values of the continuous states are new.
        states_changed: Whether values of the continuous states are new.
        next_event: Time of the next time event [s]; None: there is none.
    """

    again: bool
    terminate: bool
    nominals_changed: bool
    states_changed: bool
    next_event: float | None


class Binding(ABC):
    """One instance of an FMU.

    Args:
        archive: The opened FMU.
        interface: Co-Simulation or Model Exchange.
        name: Instance name, used in messages.

    Raises:
        InputError: The FMU does not offer the interface, or its binary cannot be loaded.
    """

    #: Begin of the names of all functions, `fmi2` or `fmi3`.
    prefix: str
    #: Rest of the names of the functions that give the size of a serialised state, and the state.
    _state_names: tuple[str, str]
    c_types: dict[VariableType, CType]
    #: fmi2DoStep or fmi3DoStep, with the argument types of C; of Co-Simulation alone.
    step_function: Callable[..., int]
    #: What fmi3DoStep fills: eventHandlingNeeded, terminateSimulation, earlyReturn, lastSuccessfulTime; ctypes objects.
    step_results: Sequence[Any] = ()

    def __init__(self, archive: FmuArchive, interface: Interface, name: str) -> None:
        self.archive, self.interface, self.name = archive, interface, name
        self.messages: list[str] = []
        #: Parameters and start values that were given, by name of the variable.
        self.given: dict[str, Access] = {}
        self._functions: dict[tuple[Any, ...], Callable[..., int]] = {}
        description = archive.description
        kind = description.coSimulation if interface == "co_simulation" else description.modelExchange
        if kind is None:
            raise InputError(
                archive.path,
                "modelDescription.xml",
                f"it has no {_SPOKEN[interface]} interface",
                other_interface(archive),
            )
        self.capabilities = kind
        #: Whether Event Mode is used; Co-Simulation in FMI 3.0 may have it.
        self.uses_event_mode = interface == "model_exchange"
        fault = fault_of_library(archive, kind.modelIdentifier)
        if fault:
            raise InputError(archive.path, "binaries", *fault)
        self._claim()
        try:
            self.fmu = self._load(kind.modelIdentifier)
        except InputError:
            raise
        except Exception as error:  # fmpy raises bare Exception
            if self._claimed is not None:
                del _ONLY_ONCE[self._claimed]
            said = "".join(f"; it says: {m}" for m in self.messages[-3:])
            if "nstantiate" in str(error):  # fmpy's own words where the FMU gives no instance
                raise InputError(
                    archive.path,
                    f"binaries/.../{kind.modelIdentifier}",
                    f"its binary is loaded, but gives no instance{said}",
                    "it may need a licence, resources or a program that is not here: ask whoever exported it",
                ) from error
            raise InputError(
                archive.path,
                f"binaries/.../{kind.modelIdentifier}",
                f"its binary cannot be loaded: {error}{said}",
                "it needs the tool that exported it (needsExecutionTool): install that"
                if kind.needsExecutionTool
                else "the binary may need libraries that are not installed here (see `ldd`)",
            ) from error
        self.is_alive = True
        self.is_fatal = False

    def _claim(self) -> None:
        """Refuse a second instance of an FMU that allows one per process."""
        self._claimed: Path | None = None
        if not self.capabilities.canBeInstantiatedOnlyOncePerProcess:
            return
        path = self.archive.path.resolve()
        if path in _ONLY_ONCE:
            raise InputError(
                path,
                "canBeInstantiatedOnlyOncePerProcess",
                f"{_ONLY_ONCE[path]} uses it already",
                f"give {self.name} `isolation: process`",
            )
        self._claimed = path
        _ONLY_ONCE[path] = self.name

    @abstractmethod
    def _load(self, identifier: str) -> Any: ...

    def check(self, function: str, status: int) -> None:
        """Raise UnitError with the FMU's own message if a status is not OK or Warning."""
        if status <= WARNING:
            return
        self.is_fatal = self.is_fatal or status == FATAL
        said = "; ".join(self.messages[-3:])
        self.messages.clear()
        raise UnitError(self.name, f"{function} returned {_STATUS.get(status, status)}" + (f": {said}" if said else ""))

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a checked fmpy method; its exception becomes a UnitError with the FMU's message."""
        try:
            return function(*arguments)
        except FMICallException as error:
            self.check(error.function, int(error.status))
            raise UnitError(self.name, str(error)) from error

    def function(self, name: str, *argtypes: Any) -> Callable[..., int]:
        """The library's function `fmi2<name>` or `fmi3<name>`, unchecked; addresses are passed as integers."""
        key = name, *argtypes
        if key not in self._functions:  # a search asks for them before each of its simulations
            found = self.fmu.dll[self.prefix + name]  # an object of its own: fmpy's argument types stay as they are
            found.argtypes, found.restype = [ctypes.c_void_p, *argtypes], ctypes.c_int
            self._functions[key] = found
        return self._functions[key]

    def checked(self, name: str, *argtypes: Any) -> Callable[..., None]:
        """The library's function with the component bound and its status checked."""
        call, component, label = self.function(name, *argtypes), self.fmu.component, self.prefix + name

        def checked_call(*arguments: Any) -> None:
            status = call(component, *arguments)
            if status > WARNING:
                self.check(label, status)

        return checked_call

    def _log(self, message: bytes | None) -> None:
        if message:
            self.messages.append(message.decode("utf-8", "replace").strip())
            del self.messages[:-20]

    @abstractmethod
    def configure(self, values: Sequence[tuple[FmuVariable, AnyArray]]) -> None:
        """Set structural parameters before initialisation."""

    def _access(
        self, verb: str, kinds: tuple[type[Access], ...], variables: Sequence[FmuVariable], values: AnyArray
    ) -> Access:
        plain, converting, text, binary = kinds
        vtype = variables[0].variable.type
        c_type = self.c_types[vtype]
        name = f"{verb}{c_type.suffix}"
        argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p]
        if vtype is VariableType.BINARY:
            argtypes.append(ctypes.c_void_p)
        if self.prefix == "fmi3" and vtype is not VariableType.CLOCK:
            argtypes.append(ctypes.c_size_t)
        kind = plain if c_type.dtype == values.dtype else converting
        kind = {VariableType.STRING: text, VariableType.BINARY: binary}.get(vtype, kind)
        numbers = [r for v in variables for r in v.value_references]
        references = (ctypes.c_uint32 * len(numbers))(*numbers)
        buffer = values if kind is plain else np.zeros(values.shape, dtype=c_type.dtype)
        call = self.function(name, *argtypes)
        return kind(
            self.prefix + name,
            self.fmu.component,
            call,
            variables[0],
            references,
            values,
            buffer,
            self.check,
            self.name,
        )

    def writer(self, variable: FmuVariable, values: AnyArray) -> Access:
        """A call that copies `values` (its address is kept) to the FMU."""
        return self._access("Set", (Access, ConvertingWriter, TextWriter, BinaryWriter), (variable,), values)

    def give(self, variable: FmuVariable, values: AnyArray) -> None:
        """Set a parameter or a start value before initialisation.

        An FMU that initialises itself when the experiment is set up forgets it, so it is set there once more.
        """
        name = variable.variable.name
        access = self.given.get(name)
        if access is None or access.values.shape != values.shape or access.values.dtype != values.dtype:
            access = self.given[name] = self.writer(variable, values.copy())
        access.values[...] = values
        access()

    def reader(self, variable: FmuVariable, values: AnyArray) -> Access:
        """A call that fills `values` (its address is kept) from the FMU."""
        return self.group_reader((variable,), values)

    def group_reader(self, variables: Sequence[FmuVariable], values: AnyArray) -> Access:
        """One call that reads several variables of one type, one after the other, into `values`."""
        return self._access("Get", (Access, ConvertingReader, TextReader, BinaryReader), variables, values)

    @abstractmethod
    def enter_initialisation(self, time: float, tolerance: float | None, stop: float | None) -> None:
        """Enter Initialization Mode at `time` [s]."""

    def exit_initialisation(self) -> None:
        """Leave Initialization Mode."""
        self.call(self.fmu.exitInitializationMode)

    @abstractmethod
    def do_step(self, time: float, size: float, is_final: bool = True) -> StepResult:
        """Advance from `time` by `size` [s].

        Args:
            time: Current communication point [s].
            size: Communication step size [s].
            is_final: Whether no earlier state will be restored (noSetFMUStatePriorToCurrentPoint).
        """

    @abstractmethod
    def update_discrete_states(self) -> DiscreteStates:
        """One iteration in Event Mode."""

    def save(self) -> Any:
        """Handle of the FMU's state; free it with `free_state`."""
        return self.call(self.fmu.getFMUState)

    def restore(self, state: Any) -> None:
        """Return to a saved state."""
        self.call(self.fmu.setFMUState, state)

    def free_state(self, state: Any) -> None:
        """Free a saved state."""
        self.call(self.fmu.freeFMUState, state)

    def serialise(self) -> np.ndarray[Any, np.dtype[np.uint8]]:
        """State as bytes, shape (size,).

        Raises:
            UnitError: The FMU refuses, or its state is too large to be kept.
        """
        state = self.save()
        try:
            size = ctypes.c_size_t()
            self.checked(self._state_names[0], ctypes.c_void_p, ctypes.c_void_p)(state, ctypes.addressof(size))
            if size.value > MOST_BYTES:
                raise UnitError(
                    self.name,
                    f"{self.prefix}{self._state_names[0]} says that its state has {size.value} bytes, more than "
                    f"{MOST_BYTES}, so it is not saved",
                    remedy="give a `checkpoint_step` as long as the run, which then cannot be resumed",
                )
            data = np.zeros(size.value, dtype=np.uint8)
            write = self.checked(self._state_names[1], ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t)
            write(state, data.ctypes.data, data.size)
        finally:
            self.free_state(state)
        return data

    def deserialise(self, data: np.ndarray[Any, Any]) -> None:
        """Restore a serialised state."""
        state = self.call(self.fmu.deserializeFMUState, data.astype(np.uint8).tobytes())
        try:
            self.restore(state)
        finally:
            self.free_state(state)

    def free(self) -> None:
        """Terminate and unload; safe to call twice, and after an error (after fatal nothing may be called)."""
        if not self.is_alive:
            return
        self.is_alive = False
        if self._claimed is not None:
            _ONLY_ONCE.pop(self._claimed, None)
        if self.is_fatal:
            return
        try:
            self.fmu.terminate()
        except Exception:  # after an error the FMU may refuse to terminate; it is freed all the same
            self.messages.clear()
        self.fmu.freeInstance()
