"""FMI 3.0 binding."""

from __future__ import annotations

import ctypes
import logging
from collections.abc import Callable, Sequence
from typing import Any

from fmpy import fmi3

from cosim.fmu.binding import DISCARD, Binding, DiscreteStates, StepResult
from cosim.fmu.types import FMI3
from cosim.fmu.variables import FmuVariable
from cosim.unit.protocol import AnyArray

_LOG = logging.getLogger(__name__)


class _Discrete(ctypes.Structure):
    _fields_ = [
        ("again", ctypes.c_bool),
        ("terminate", ctypes.c_bool),
        ("nominals", ctypes.c_bool),
        ("states", ctypes.c_bool),
        ("defined", ctypes.c_bool),
        ("next_event", ctypes.c_double),
    ]


class Fmi3Binding(Binding):
    """FMI 3.0."""

    prefix = "fmi3"
    _state_names = "SerializedFMUStateSize", "SerializeFMUState"
    c_types = FMI3
    _update: Callable[..., None] | None = None

    def _load(self, identifier: str) -> Any:
        token = self.archive.description.instantiationToken
        is_model = self.interface == "model_exchange"
        kind = fmi3.FMU3Model if is_model else fmi3.FMU3Slave
        loaded = self.archive.load(kind, identifier, guid=token, instanceName=self.name)

        def log(_environment: Any, _status: int, _category: bytes, message: bytes) -> None:
            self._log(message)

        if is_model:
            model = loaded
            model.instantiate(loggingOn=True, logMessage=log)
            return model
        slave = loaded
        self._instantiate(slave, log)
        self._event, self._terminate, self._early = (ctypes.c_bool() for _ in range(3))
        self._reached = ctypes.c_double()
        self.step_results = self._event, self._terminate, self._early, self._reached
        self._addresses = tuple(ctypes.addressof(r) for r in self.step_results)
        types = [ctypes.c_double, ctypes.c_double, ctypes.c_bool, *[ctypes.c_void_p] * 4]
        step = slave.dll["fmi3DoStep"]
        step.argtypes, step.restype = [ctypes.c_void_p, *types], ctypes.c_int
        self.step_function = step
        return slave

    def _instantiate(self, slave: Any, log: Callable[..., None]) -> None:
        """With Event Mode where the FMU has it; without where it refuses what it declares."""
        capabilities = self.capabilities
        for with_events in (True, False) if capabilities.hasEventMode else (False,):
            try:
                slave.instantiate(
                    loggingOn=True,
                    logMessage=log,
                    eventModeUsed=with_events,
                    earlyReturnAllowed=with_events or capabilities.mightReturnEarlyFromDoStep,
                )
            except Exception:  # fmpy raises bare Exception
                if not with_events:
                    raise
                _LOG.warning("%s: it declares Event Mode but refuses it: it runs without", self.name)
            else:
                self.uses_event_mode = with_events
                return

    def configure(self, values: Sequence[tuple[FmuVariable, AnyArray]]) -> None:
        """Set all of them in one visit to Configuration Mode."""
        if not values:
            return
        self.call(self.fmu.enterConfigurationMode)
        for variable, value in values:
            self.writer(variable, value)()
        self.call(self.fmu.exitConfigurationMode)

    def enter_initialisation(self, time: float, tolerance: float | None, stop: float | None) -> None:
        """Enter Initialization Mode."""
        self.call(lambda: self.fmu.enterInitializationMode(tolerance, time, stop))

    def do_step(self, time: float, size: float, is_final: bool = True) -> StepResult:
        """One fmi3DoStep."""
        self._reached.value = time
        status = self.step_function(self.fmu.component, time, size, is_final, *self._addresses)
        if status == DISCARD:
            return StepResult(min(max(self._reached.value, time), time + size), discarded=True)
        self.check("fmi3DoStep", status)
        reached = self._reached.value if self._early.value else time + size
        return StepResult(reached, self._event.value, self._early.value, False, self._terminate.value)

    def update_discrete_states(self) -> DiscreteStates:
        """One fmi3UpdateDiscreteStates."""
        if self._update is None:
            self._discrete = _Discrete()
            fields = ("again", "terminate", "nominals", "states", "defined", "next_event")
            base = ctypes.addressof(self._discrete)
            self._update_arguments = [base + getattr(_Discrete, f).offset for f in fields]
            self._update = self.checked("UpdateDiscreteStates", *[ctypes.c_void_p] * 6)
        self._update(*self._update_arguments)
        found = self._discrete
        next_event = found.next_event if found.defined else None
        return DiscreteStates(found.again, found.terminate, found.nominals, found.states, next_event)
