"""The equations of a Model Exchange FMU as functions on numpy arrays."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable

import numpy as np

from cosim.fmu.added_terms import AddedTerms
from cosim.fmu.binding import DISCARD, WARNING, Binding
from cosim.fmu.sizes import MOST_STATES
from cosim.unit.protocol import Array, UnitError

#: Evaluations without a finite value between two events before the FMU is given up; CVODE's step is tiny by then.
MOST_FAULTS = 100


class ContinuousModel:
    """Continuous states, derivatives and event indicators of one instance.

    Args:
        binding: An initialised FMU.
        added: What the master adds to it, or None.
    """

    def __init__(self, binding: Binding, added: AddedTerms | None = None) -> None:
        self._added = None if added is None or added.is_empty else added
        description = binding.archive.description
        is_fmi3 = binding.prefix == "fmi3"
        self._binding = binding
        self.name = binding.name
        #: Number of continuous states and of event indicators; structural parameters can change both in FMI 3.0.
        self.states, self.indicators = description.numberOfContinuousStates, description.numberOfEventIndicators
        if is_fmi3:
            self.states = int(binding.call(binding.fmu.getNumberOfContinuousStates))
            self.indicators = int(binding.call(binding.fmu.getNumberOfEventIndicators))
        if max(self.states, self.indicators) > MOST_STATES:
            raise UnitError(
                self.name,
                f"the FMU says that it has {self.states} continuous states and {self.indicators} event "
                f"indicators; more than {MOST_STATES} are not integrated",
                remedy="use its Co-Simulation interface, if it has one",
            )
        #: States that terms of the master add; they come last.
        self.own = 0 if self._added is None else self._added.own_count
        array = ctypes.c_void_p, ctypes.c_size_t
        self._set_time = binding.checked("SetTime", ctypes.c_double)
        self._set_states = binding.function("SetContinuousStates", *array)
        derivatives = "GetContinuousStateDerivatives" if is_fmi3 else "GetDerivatives"
        self._get_derivatives = binding.function(derivatives, *array)
        self._get_indicators = binding.function("GetEventIndicators", *array)
        self._get_states = binding.checked("GetContinuousStates", *array)
        self._get_nominals = binding.checked("GetNominalsOfContinuousStates", *array)
        boolean = ctypes.c_bool if is_fmi3 else ctypes.c_int
        self._completed = binding.checked("CompletedIntegratorStep", boolean, ctypes.c_void_p, ctypes.c_void_p)
        self._wants_event, self._terminate = boolean(), boolean()
        self._scratch = [np.zeros(self.states), np.zeros(self.states), np.zeros(self.indicators)]
        self._zeros = [np.zeros_like(a) for a in self._scratch]
        self._faults, self._finite = 0, math.nan
        self._addresses = [a.ctypes.data for a in self._scratch]

    def get_states(self) -> Array:
        """Continuous states, then those of terms, shape (states + own,), a copy."""
        result = np.zeros(self.states + self.own)
        if self.states:
            self._get_states(result.ctypes.data, self.states)
        if self._added is not None and self.own:
            result[self.states :] = self._added.own_values
        return result

    def nominals(self) -> Array:
        """Nominal values of the states, shape (states + own,); where the FMU gives zero or nonsense, one."""
        result = np.ones(self.states + self.own)
        if self.states:
            self._get_nominals(result.ctypes.data, self.states)
        result = np.abs(result)
        return np.where(np.isfinite(result) & (result > 0.0), result, 1.0)

    def forgive(self) -> None:
        """A new integration begins: count anew what is not finite."""
        self._faults = 0

    def move_to(self, time: float, states: Array) -> None:
        """Set time [s] and states, shape (states,), for good; the FMU may refuse (UnitError)."""
        self._set_time(time)
        if self.states:
            self._scratch[0][:] = states[: self.states]
            status = self._set_states(self._binding.fmu.component, self._addresses[0], self.states)
            if status > WARNING:
                self._binding.check(f"{self._binding.prefix}SetContinuousStates", status)
        if self._added is not None:
            self._added.place(time, states[: self.states + self.own])

    def derivatives(self, time: float, states: Array, rates: Array) -> None:
        """Fill `rates`; with NaN where the FMU discards the point, so that the integrator takes a smaller step."""
        rates[self.states :] = 0.0
        if self.states:
            rates[: self.states] = self._evaluate(self._get_derivatives, 1, "Derivatives", time, states)
        if self._added is not None:
            self._added.add_rates(time, states[: self.states + self.own], rates[: self.states + self.own])

    def event_indicators(self, time: float, states: Array, result: Array) -> None:
        """Fill `result`, shape (indicators,)."""
        result[:] = self._evaluate(self._get_indicators, 2, "GetEventIndicators", time, states)

    def _evaluate(self, function: Callable[..., int], slot: int, label: str, time: float, states: Array) -> Array:
        self._set_time(time)
        component, result = self._binding.fmu.component, self._scratch[slot]
        status = 0
        if self.states:
            self._scratch[0][:] = states[: self.states]
            status = self._set_states(component, self._addresses[0], self.states)
        if status <= WARNING and self._added is not None:
            self._added.place(time, states[: self.states + self.own])
        if status <= WARNING:
            status = function(component, self._addresses[slot], result.size)
        if status > WARNING:
            if status != DISCARD:
                self._binding.check(label, status)
            result.fill(np.nan)
        if result.dot(self._zeros[slot]) != 0.0:  # NaN or infinity: CVODE takes a smaller step
            self._faults += 1
            if self._faults > MOST_FAULTS:
                raise UnitError(self.name, f"{label}: a value is not finite just after {self._finite:.9g} s")
        else:
            self._finite = time
        return result

    def completed_integrator_step(self) -> tuple[bool, bool]:
        """Tell the FMU that the step is accepted; whether it wants Event Mode, and whether it terminates."""
        self._completed(True, ctypes.addressof(self._wants_event), ctypes.addressof(self._terminate))
        if self._added is not None:
            self._added.complete_step()
        return bool(self._wants_event.value), bool(self._terminate.value)
