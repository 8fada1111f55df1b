"""Calls into a loaded FMU, with one interface for FMI 2.0 and 3.0 and every status checked.

Arrays pass through preallocated buffers and the functions of the shared library itself, because fmpy's list calls
cost several times as much (see docs/decisions/0006-fmu-calls.md); loading and rare calls go through fmpy.
"""

from __future__ import annotations

import ctypes
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Literal

import numpy as np
from fmpy import fmi2, fmi3
from fmpy.fmi1 import FMICallException

from cosim.errors import InputError
from cosim.fmu.archive import FmuArchive
from cosim.fmu.variables import FmuVariable
from cosim.unit import Array, UnitError

Interface = Literal["co_simulation", "model_exchange"]

_STATUS = {1: "warning", 2: "discard", 3: "error", 4: "fatal", 5: "pending"}
_OK, _WARNING, _DISCARD = 0, 1, 2


class DoStepDiscarded(Exception):
    """The FMU discarded the step (fmi2Discard, fmi3Discard)."""


class Binding(ABC):
    """One instance of an FMU.

    Args:
        archive: The opened FMU.
        interface: Co-Simulation or Model Exchange.
        name: Instance name, used in messages.
    """

    #: Functions of the shared library that set and get doubles.
    setter: str
    getter: str

    def __init__(self, archive: FmuArchive, interface: Interface, name: str) -> None:
        self.archive, self.interface, self.name = archive, interface, name
        self.messages: list[str] = []
        description = archive.description
        kind = description.coSimulation if interface == "co_simulation" else description.modelExchange
        if kind is None:
            other = "model_exchange" if interface == "co_simulation" else "co_simulation"
            raise InputError(
                archive.path, "modelDescription.xml", f"it has no {interface} interface", f"it offers {other}: use that"
            )
        self.capabilities = kind
        try:
            self.fmu = self._load(kind.modelIdentifier)
        except InputError:
            raise
        except Exception as error:  # fmpy raises bare Exception
            raise InputError(
                archive.path,
                f"binaries/.../{kind.modelIdentifier}",
                f"its binary cannot be loaded: {error}",
                "the binary may need libraries that are not installed here (see `ldd`)",
            ) from error
        self.is_alive = True

    @abstractmethod
    def _load(self, identifier: str) -> Any: ...

    def check(self, function: str, status: int) -> None:
        """Raise UnitError with the FMU's own message if a status is not OK or Warning."""
        if status in (_OK, _WARNING):
            return
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

    def _log(self, message: bytes | None) -> None:
        if message:
            self.messages.append(message.decode("utf-8", "replace").strip())
            del self.messages[:-20]

    @abstractmethod
    def configure(self, variable: FmuVariable, value: int) -> None:
        """Set a structural parameter before initialisation."""

    def set_parameter(self, variable: FmuVariable, value: Any) -> None:
        """Set a parameter of any FMI type; arrays as numpy arrays."""
        setter = getattr(self.fmu, f"set{variable.kind}")
        values = [value] if variable.kind == "String" else np.ravel(value).tolist()
        self.call(setter, list(variable.value_references), values)

    @abstractmethod
    def _arguments(self, variable: FmuVariable, buffer: Array) -> tuple[Any, ...]:
        """Arguments after the component of the functions that set and get doubles."""

    def _access(self, function: str, variable: FmuVariable, buffer: Array) -> Callable[[], None]:
        call, component = getattr(self.fmu.dll, function), self.fmu.component
        arguments = self._arguments(variable, buffer)

        def access() -> None:
            status = call(component, *arguments)
            if status > _WARNING:
                self.check(f"{function}({variable.variable.name})", status)

        return access

    def writer(self, variable: FmuVariable, buffer: Array) -> Callable[[], None]:
        """A function that copies `buffer` (its address is kept) to the FMU."""
        return self._access(self.setter, variable, buffer)

    def reader(self, variable: FmuVariable, buffer: Array) -> Callable[[], None]:
        """A function that fills `buffer` (its address is kept) from the FMU."""
        return self._access(self.getter, variable, buffer)

    @abstractmethod
    def enter_initialisation(self, time: float) -> None:
        """Enter Initialization Mode at `time` [s]."""

    @abstractmethod
    def exit_initialisation(self) -> None:
        """Leave Initialization Mode."""

    @abstractmethod
    def do_step(self, time: float, size: float) -> float:
        """Advance from `time` by `size` [s]; returns the time reached."""

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
        """State as bytes, shape (size,)."""
        state = self.save()
        data = self.call(self.fmu.serializeFMUState, state)
        self.free_state(state)
        return np.frombuffer(data, dtype=np.uint8).copy()

    def deserialise(self, data: np.ndarray[Any, Any]) -> None:
        """Restore a serialised state."""
        state = self.call(self.fmu.deserializeFMUState, data.astype(np.uint8).tobytes())
        self.restore(state)
        self.free_state(state)

    def free(self) -> None:
        """Terminate and unload; safe to call twice, and after an error."""
        if not self.is_alive:
            return
        self.is_alive = False
        try:
            self.fmu.terminate()
        except Exception:  # after an error the FMU may refuse to terminate; it is freed all the same
            self.messages.clear()
        self.fmu.freeInstance()


def _pointer(buffer: Array) -> Any:
    if buffer.dtype != np.float64 or not buffer.flags["C_CONTIGUOUS"]:
        raise ValueError("a buffer must be contiguous float64: its address is kept")
    return buffer.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


class Fmi3Binding(Binding):
    """FMI 3.0."""

    setter, getter = "fmi3SetFloat64", "fmi3GetFloat64"

    def _load(self, identifier: str) -> Any:
        kind = fmi3.FMU3Slave if self.interface == "co_simulation" else fmi3.FMU3Model
        fmu = kind(
            guid=self.archive.description.instantiationToken, modelIdentifier=identifier,
            unzipDirectory=str(self.archive.directory), instanceName=self.name,
        )  # fmt: skip
        self._event, self._terminate, self._early = (ctypes.c_bool() for _ in range(3))
        self._reached = ctypes.c_double()
        self._results = tuple(ctypes.byref(x) for x in (self._event, self._terminate, self._early, self._reached))
        fmu.instantiate(loggingOn=True, logMessage=lambda _env, _status, _category, message: self._log(message))
        return fmu

    def configure(self, variable: FmuVariable, value: int) -> None:
        self.call(self.fmu.enterConfigurationMode)
        self.set_parameter(variable, value)
        self.call(self.fmu.exitConfigurationMode)

    def _arguments(self, variable: FmuVariable, buffer: Array) -> tuple[Any, ...]:
        references = (ctypes.c_uint32 * 1)(*variable.value_references)
        return references, 1, _pointer(buffer), buffer.size

    def enter_initialisation(self, time: float) -> None:
        self.call(lambda: self.fmu.enterInitializationMode(startTime=time))

    def exit_initialisation(self) -> None:
        self.call(self.fmu.exitInitializationMode)

    def do_step(self, time: float, size: float) -> float:
        status = self.fmu.dll.fmi3DoStep(self.fmu.component, time, size, True, *self._results)
        if status == _DISCARD:
            raise DoStepDiscarded
        if status > _WARNING:
            self.check("fmi3DoStep", status)
        if self._terminate.value:
            raise UnitError(self.name, "the FMU asks to terminate the simulation")
        return self._reached.value if self._early.value else time + size


class Fmi2Binding(Binding):
    """FMI 2.0."""

    setter, getter = "fmi2SetReal", "fmi2GetReal"

    def _load(self, identifier: str) -> Any:
        kind = fmi2.FMU2Slave if self.interface == "co_simulation" else fmi2.FMU2Model
        fmu = kind(
            guid=self.archive.description.guid, modelIdentifier=identifier,
            unzipDirectory=str(self.archive.directory), instanceName=self.name,
        )  # fmt: skip
        callbacks = fmi2.fmi2CallbackFunctions()
        callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(lambda _env, _name, _status, _cat, message: self._log(message))
        callbacks.allocateMemory = fmi2.defaultCallbacks.allocateMemory
        callbacks.freeMemory = fmi2.defaultCallbacks.freeMemory
        self._callbacks = callbacks  # kept: the FMU holds its address
        fmu.instantiate(callbacks=callbacks, loggingOn=True)
        return fmu

    def configure(self, variable: FmuVariable, value: int) -> None:
        raise InputError(self.archive.path, variable.variable.name, "FMI 2.0 has no structural parameters",
                         "build the FMU for this size, or use FMI 3.0")  # fmt: skip

    def _arguments(self, variable: FmuVariable, buffer: Array) -> tuple[Any, ...]:
        count = len(variable.value_references)
        references = (ctypes.c_uint * count)(*variable.value_references)
        return references, count, _pointer(buffer)

    def enter_initialisation(self, time: float) -> None:
        self.call(lambda: self.fmu.setupExperiment(startTime=time))
        self.call(self.fmu.enterInitializationMode)

    def exit_initialisation(self) -> None:
        self.call(self.fmu.exitInitializationMode)

    def do_step(self, time: float, size: float) -> float:
        status = self.fmu.dll.fmi2DoStep(self.fmu.component, time, size, 1)
        if status == _DISCARD:
            raise DoStepDiscarded
        if status > _WARNING:
            self.check("fmi2DoStep", status)
        return time + size


def bind(archive: FmuArchive, interface: Interface, name: str) -> Binding:
    """Load an FMU with the binding of its FMI version.

    Raises:
        InputError: FMI 1.0, or the interface is not offered, or the binary cannot be loaded.
    """
    version = archive.description.fmiVersion
    if version.startswith("3"):
        return Fmi3Binding(archive, interface, name)
    if version.startswith("2"):
        return Fmi2Binding(archive, interface, name)
    raise InputError(archive.path, "modelDescription.xml", f"FMI {version} is not supported", "export it as FMI 2 or 3")
