"""CVODE of SUNDIALS (scikit-sundae) over the equations of a Model Exchange FMU."""

from __future__ import annotations

import contextlib
import io
import os
from dataclasses import dataclass
from typing import Any

import numpy as np

from cosim.fmu.continuous import ContinuousModel
from cosim.unit.protocol import Array, UnitError

#: Internal steps of CVODE in one macro-step before it is given up.
MOST_STEPS = 50_000
#: Absolute tolerance of a state over relative tolerance times nominal value.
ABSOLUTE_SHARE = 0.01
_INSTALL = "install it, `pip install scikit-sundae`"
_OTHERWISE = "or take `integrator: internal` if the FMU has a Co-Simulation interface"
_LOOSEN = "loosen its tolerance, or give a smaller macro_step"


def load_cvode(name: str) -> Any:
    """The class CVODE of scikit-sundae.

    Args:
        name: Component that needs it.

    Raises:
        UnitError: It is not installed or does not load.
    """
    os.environ.setdefault("SUNLOGGER_WARNING_FILENAME", os.devnull)  # SUNDIALS writes its warnings to standard output
    try:
        from sksundae.cvode import CVODE
    except ModuleNotFoundError as error:
        raise UnitError(
            name, "`integrator: cvode` needs scikit-sundae, and it is not installed", remedy=f"{_INSTALL}, {_OTHERWISE}"
        ) from error
    except ImportError as error:
        raise UnitError(
            name,
            f"`integrator: cvode` needs scikit-sundae, and it does not load: {error}",
            remedy=f"install it again, {_OTHERWISE}",
        ) from error
    return CVODE


class _Nowhere(io.TextIOBase):
    """A stream that keeps nothing."""

    def write(self, text: str, /) -> int:
        """Forget it."""
        return len(text)


_NOWHERE = _Nowhere()


@dataclass(frozen=True)
class Reached:
    """Where an integration stopped.

    Args:
        time: Time [s].
        is_root: Whether an event indicator changed its sign there.
        is_step_event: Whether the FMU asked for Event Mode after a completed step.
        terminates: Whether it asked for the end of the simulation.
    """

    time: float
    is_root: bool = False
    is_step_event: bool = False
    terminates: bool = False


class Integrator:
    """Integrates between events.

    GMRES needs no Jacobian, so nothing is assumed of how the states of an FMU depend on each other; where it fails, a
    dense Jacobian from differences takes over for good. (A band of width zero perturbs all states at once: a state
    that depends on another one gets a wrong diagonal.)

    Args:
        model: The FMU's equations.
        relative_tolerance: CVODE's rtol; its atol is `ABSOLUTE_SHARE` of it times each state's nominal value.
        reports_steps: Whether the FMU wants to know of every completed step.
    """

    def __init__(self, model: ContinuousModel, relative_tolerance: float, reports_steps: bool) -> None:
        self._cvode = load_cvode(model.name)
        self._model, self._rtol, self._reports_steps = model, relative_tolerance, reports_steps
        #: A model with event indicators but no states gets one that stays zero: CVODE finds roots of ODEs only.
        self._count = max(model.states + model.own, 1)
        self._is_needed = model.states + model.own > 0 or model.indicators > 0
        self._linear_solver = "gmres"
        self._solver: Any = None
        self._size = 0.0
        self.states = np.zeros(self._count)
        self.restart()

    def restart(self, states: Array | None = None) -> None:
        """The next step begins anew, from `states` where they are given: an input, a state or a parameter jumped."""
        self._is_fresh = True
        if states is not None:
            self.states[: len(states)] = states

    def forget(self) -> None:
        """The next step begins with a new solver: nominal values have changed, or it must be the same when repeated.

        A solver that is only initialised again keeps traces of its past: its next step differs in the last digits.
        """
        self._solver = None
        self.restart()

    def _build(self, size: float) -> None:
        model = self._model
        nominals = np.ones(self._count)
        nominals[: model.states + model.own] = model.nominals()
        options: dict[str, Any] = {
            "rtol": self._rtol,
            "atol": ABSOLUTE_SHARE * self._rtol * nominals,
            "linsolver": self._linear_solver,
            # CVODE's own guess costs evaluations at every restart; a step that is too long is cut by its error test.
            "first_step": 0.1 * size,
            "max_num_steps": MOST_STEPS,
        }
        self._events: Any = None
        if model.indicators:

            def events(time: float, states: Array, result: Array) -> None:
                model.event_indicators(time, states, result)

            self._events = events
            options.update(eventsfn=events, num_events=model.indicators)
        self._solver, self._size = self._cvode(model.derivatives, **options), size
        self._is_fresh = True

    def advance(self, begin: float, end: float) -> Reached:
        """Integrate from `begin` towards `end` [s], never past it; the FMU stands at the point reached.

        Raises:
            UnitError: CVODE gave up, or the FMU refused a call.
        """
        model = self._model
        if not self._is_needed:
            model.move_to(end, self.states)
            return Reached(end, False, *self._report())
        size = end - begin
        if self._solver is None or not 0.1 * self._size <= size <= 10.0 * self._size:
            self._build(size)
        time = begin
        model.forgive()
        for _ in range(MOST_STEPS):
            solution = self._step(time, end)
            time, is_root = float(solution.t), solution.status == 2
            self.states[:] = solution.y
            model.move_to(time, self.states)
            is_step_event, terminates = self._report()
            if is_root or is_step_event or terminates or time >= end:
                return Reached(time, is_root, is_step_event, terminates)
        raise UnitError(model.name, f"CVODE took {MOST_STEPS} steps without reaching {end:.9g} s", remedy=_LOOSEN)

    def _report(self) -> tuple[bool, bool]:
        return self._model.completed_integrator_step() if self._reports_steps else (False, False)

    def _step(self, begin: float, end: float) -> Any:
        """One call of CVODE; it stops exactly at `end`: past it, it would interpolate across the jump of the inputs."""
        method = "onestep" if self._reports_steps else "normal"
        for solver in (self._linear_solver, "dense"):
            if solver != self._linear_solver:
                self._linear_solver = solver
                self._build(end - begin)
            if self._is_fresh:
                self._solver.init_step(begin, self.states)
                self._is_fresh = False
            with contextlib.redirect_stdout(_NOWHERE):  # scikit-sundae prints a failure, which `message` has too
                solution = self._solver.step(end, method, end)
            self._drop_record()
            if solution.success and np.isfinite(solution.y).all():
                return solution
            self._is_fresh = True
        raise UnitError(self._model.name, f"CVODE failed: {solution.message}", remedy=_LOOSEN)

    def _drop_record(self) -> None:
        """scikit-sundae 1.2 keeps every event of a run in lists on the function; nothing here reads them."""
        if self._events is not None:
            for name in ("_i", "_t", "_y"):
                getattr(self._events, name).clear()
