"""FMI 2.0 binding."""

from __future__ import annotations

import ctypes
import itertools
import weakref
from collections.abc import Callable, Sequence
from typing import Any

from fmpy import fmi2
from fmpy.fmi1 import FMICallException
from fmpy.logging import addLoggerProxy

from cosim.fmu.binding import DISCARD, Binding, DiscreteStates, StepResult
from cosim.fmu.types import FMI2
from cosim.fmu.variables import FmuVariable
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, UnitError

_PENDING = 5
_LAST_SUCCESSFUL_TIME, _TERMINATED = 2, 3

#: Instances by the number that they pass as their environment: fmpy's proxy, which formats the messages' arguments
#: in C, knows one logger for the whole process.
_INSTANCES: weakref.WeakValueDictionary[int, Fmi2Binding] = weakref.WeakValueDictionary()
_NUMBERS = itertools.count(1)


def _log(environment: int | None, _name: bytes, _status: int, _category: bytes, message: bytes) -> None:
    instance = _INSTANCES.get(environment or 0)
    if instance is not None:
        instance._log(message)


_LOGGER = fmi2.fmi2CallbackLoggerTYPE(_log)


class Fmi2Binding(Binding):
    """FMI 2.0."""

    prefix = "fmi2"
    _state_names = "SerializedFMUstateSize", "SerializeFMUstate"
    c_types = FMI2
    _update: Callable[..., None] | None = None

    def _load(self, identifier: str) -> Any:
        kind = fmi2.FMU2Slave if self.interface == "co_simulation" else fmi2.FMU2Model
        fmu = self.archive.load(kind, identifier, guid=self.archive.description.guid, instanceName=self.name)
        number = next(_NUMBERS)
        _INSTANCES[number] = self
        callbacks = fmi2.fmi2CallbackFunctions()
        callbacks.logger = _LOGGER
        callbacks.allocateMemory = fmi2.defaultCallbacks.allocateMemory
        callbacks.freeMemory = fmi2.defaultCallbacks.freeMemory
        callbacks.componentEnvironment = number
        addLoggerProxy(ctypes.byref(callbacks))
        self._callbacks = callbacks  # kept: the FMU holds its address
        fmu.instantiate(callbacks=callbacks, loggingOn=True)
        if self.interface == "co_simulation":
            step = fmu.dll["fmi2DoStep"]
            step.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_int]
            step.restype = ctypes.c_int
            self.step_function = step
        return fmu

    def configure(self, values: Sequence[tuple[FmuVariable, AnyArray]]) -> None:
        """Refuse: FMI 2.0 has no structural parameters."""
        for variable, _ in values:
            raise InputError(
                self.archive.path,
                variable.variable.name,
                "FMI 2.0 has no structural parameters",
                "build the FMU for this size, or use FMI 3.0",
            )

    def enter_initialisation(self, time: float, tolerance: float | None, stop: float | None) -> None:
        """Set up the experiment, give parameters and start values once more, enter Initialization Mode."""
        self.call(lambda: self.fmu.setupExperiment(tolerance, time, stop))
        for access in self.given.values():
            access()
        self.call(self.fmu.enterInitializationMode)

    def do_step(self, time: float, size: float, is_final: bool = True) -> StepResult:
        """One fmi2DoStep; after fmi2Discard the FMU is asked how far it came and whether it has terminated."""
        status = self.step_function(self.fmu.component, time, size, is_final)
        if status == DISCARD:
            return self._discarded(time)
        if status == _PENDING:
            raise UnitError(
                self.name,
                "its step runs on asynchronously (fmi2DoStep returned fmi2Pending), which is not supported",
                remedy="export it without canRunAsynchronuously",
            )
        self.check("fmi2DoStep", status)
        return StepResult(time + size)

    def _discarded(self, time: float) -> StepResult:
        try:
            terminate = self.fmu.getBooleanStatus(_TERMINATED)
        except FMICallException:  # it does not say
            terminate = False
        try:
            reached = self.fmu.getRealStatus(_LAST_SUCCESSFUL_TIME)
        except FMICallException:
            reached = time
        return StepResult(reached, discarded=True, terminate=terminate)

    def update_discrete_states(self) -> DiscreteStates:
        """One fmi2NewDiscreteStates."""
        if self._update is None:
            self._info = fmi2.fmi2EventInfo()
            self._update = self.checked("NewDiscreteStates", ctypes.c_void_p)
        self._update(ctypes.addressof(self._info))
        info = self._info
        return DiscreteStates(
            bool(info.newDiscreteStatesNeeded),
            bool(info.terminateSimulation),
            bool(info.nominalsOfContinuousStatesChanged),
            bool(info.valuesOfContinuousStatesChanged),
            info.nextEventTime if info.nextEventTimeDefined else None,
        )
