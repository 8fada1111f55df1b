"""A Model Exchange FMU integrated by CVODE of SUNDIALS (scikit-sundae)."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from typing import Any

import numpy as np
from sksundae.cvode import CVODE

from cosim.errors import InputError
from cosim.fmu.archive import FmuArchive
from cosim.fmu.unit import FmuSettings, FmuUnit
from cosim.unit import Array, StepOutcome, StepStatus, UnitError, seconds


class ModelExchangeUnit(FmuUnit):
    """An FMU whose derivatives CVODE integrates (`integrator: cvode`).

    Inputs are constant over a macro-step, so CVODE is started afresh at each step and told to stop exactly at its end:
    an integrator that steps past the end would interpolate across the jump of the inputs.

    Args:
        name: Name of the component in the scenario.
        archive: The opened FMU; it must have no event indicators.
        settings: Structure and parameters.
        relative_tolerance: CVODE's rtol.
        absolute_tolerance: CVODE's atol, times the nominal value of each state.

    Raises:
        InputError: The FMU has no Model Exchange interface, or has events.
    """

    def __init__(
        self, name: str, archive: FmuArchive, settings: FmuSettings,
        relative_tolerance: float = 1e-8, absolute_tolerance: float = 1e-10,
    ) -> None:  # fmt: skip
        super().__init__(name, archive, settings, "model_exchange")
        relative_tolerance = settings.tolerance or relative_tolerance
        self._is_fmi3 = archive.description.fmiVersion.startswith("3")
        self._tolerances = relative_tolerance, absolute_tolerance
        self._count = 0
        self._solver: Any = None

    def initialise(self, time: int) -> None:
        """Initialise."""
        super().initialise(time)

    def _begin(self, time: int) -> None:
        fmu, call = self.binding.fmu, self.binding.call
        if self._is_fmi3:
            self._count = int(call(fmu.getNumberOfContinuousStates))
            indicators = int(call(fmu.getNumberOfEventIndicators))
        else:
            self._count = int(self.archive.description.numberOfContinuousStates)
            indicators = int(self.archive.description.numberOfEventIndicators)
        if indicators:
            raise InputError(self.archive.path, self.name, f"it has {indicators} event indicators",
                             "use `integrator: internal` for this FMU")  # fmt: skip
        self._update_discrete_states()
        call(fmu.enterContinuousTimeMode)
        self._states = np.zeros(self._count)
        self._scratch = np.zeros(self._count)
        self._rates = np.zeros(self._count)
        nominals = np.ones(self._count)
        call(fmu.getNominalsOfContinuousStates, _pointer(nominals), self._count)
        call(fmu.getContinuousStates, _pointer(self._states), self._count)
        rtol, atol = self._tolerances
        # GMRES needs no Jacobian, so nothing is assumed of how the states of an FMU depend on each other. (A band of
        # width zero perturbs all states at once: a state that depends on another one gets a wrong diagonal.)
        self._options = {"rtol": rtol, "atol": atol * np.abs(nominals), "linsolver": "gmres"}
        super()._begin(time)

    def _update_discrete_states(self) -> None:
        for _ in range(100):
            if not self.binding.update_discrete_states().again:
                return
        raise UnitError(self.name, "its discrete states do not settle in 100 iterations")

    def _derivatives(self, time: float, states: Array, rates: Array) -> None:
        fmu, call = self.binding.fmu, self.binding.call
        self._scratch[:] = states
        call(fmu.setTime, time)
        call(fmu.setContinuousStates, _pointer(self._scratch), self._count)
        get = fmu.getContinuousStateDerivatives if self._is_fmi3 else fmu.getDerivatives
        call(get, _pointer(self._rates), self._count)
        rates[:] = self._rates

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Integrate over one macro-step.

        Raises:
            UnitError: CVODE gave up, or the FMU returned an error.
        """
        self.exit_initialisation()
        begin, end = seconds(time), seconds(time + size)
        fmu, call = self.binding.fmu, self.binding.call
        if self._count:
            solver = CVODE(self._derivatives, first_step=0.1 * (end - begin), **self._options)
            solver.init_step(begin, self._states)
            solution = solver.step(end, tstop=end)
            if not solution.success or not np.isfinite(solution.y).all():
                raise UnitError(self.name, f"CVODE failed: {solution.message}", time, "loosen its tolerances")
            self._states[:] = solution.y
        call(fmu.setTime, end)
        call(fmu.setContinuousStates, _pointer(self._states), self._count)
        enter_event_mode, terminate = call(fmu.completedIntegratorStep)
        if terminate:
            raise UnitError(self.name, "the FMU asks to terminate the simulation", time)
        if enter_event_mode:
            call(fmu.enterEventMode)
            self._update_discrete_states()
            call(fmu.enterContinuousTimeMode)
            call(fmu.getContinuousStates, _pointer(self._states), self._count)
        self.buffers.read(time + size)
        return StepOutcome(StepStatus.OK, time + size)

    def resume(self, state: Mapping[str, np.ndarray[Any, Any]], time: int) -> None:
        """Restore the serialised state; CVODE starts afresh at every step and keeps none."""
        super().resume(state, time)
        self.binding.call(self.binding.fmu.getContinuousStates, _pointer(self._states), self._count)


def _pointer(array: Array) -> Any:
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
