"""A Model Exchange FMU integrated by CVODE, with state, time and step events."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from cosim.fmu.archive import FmuArchive
from cosim.fmu.continuous import ContinuousModel
from cosim.fmu.integrator import Integrator, load_cvode
from cosim.fmu.moved_parameter import MovedParameter, refuse_event
from cosim.fmu.unit import FmuSettings, FmuUnit, Mode, is_worth_reporting
from cosim.unit.protocol import (
    NANOSECONDS,
    AnyArray,
    Array,
    StepOutcome,
    StepStatus,
    UnitError,
    are_equal,
    seconds,
)

RELATIVE_TOLERANCE = 1e-8
#: Events in a row at practically the same instant before the FMU is given up: it chatters.
MOST_EVENTS = 100
#: What is practically the same instant [s]: a tenth of the resolution of simulated time.
INSTANT = 0.1 / NANOSECONDS


class ModelExchangeUnit(FmuUnit):
    """An FMU whose derivatives CVODE integrates (`integrator: cvode`).

    Inputs are constant over a macro-step and CVODE stops exactly at its end. It begins anew after a step whose begin
    changed an input, after an event, and after the state was saved or restored, so that a step that is repeated, or a
    run that is resumed, is the same to the last bit.

    Args:
        name: Name of the component in the scenario.
        archive: The opened FMU.
        settings: Structure, parameters and start values; `tolerance` is CVODE's rtol.

    Raises:
        InputError: The FMU has no Model Exchange interface, or something in `settings` does not fit.
    """

    def __init__(self, name: str, archive: FmuArchive, settings: FmuSettings) -> None:
        load_cvode(name)  # now: a run must not begin and then find that it is missing
        super().__init__(name, archive, settings, "model_exchange")
        self._next_event: float | None = None
        try:
            self.added.moved = {t.target: self.moved_parameter(t.target) for t in self.added.parameters}
            self.added.where = self._where
        except BaseException:
            self.binding.free()
            raise

    @property
    def next_event(self) -> float | None:
        """Time of the next time event [s]; None: there is none."""
        return self._next_event

    def continuous_states(self) -> Array:
        """Continuous states, shape (states,), a copy."""
        return self._model.get_states()[: self._model.states]

    def moved_parameter(self, name: str) -> MovedParameter:
        """Instances in which a parameter is smaller and larger, with nothing added."""
        settings = replace(self.settings, added_terms=())
        with contextlib.chdir(Path.cwd()):  # fmpy changes the working folder while it loads a library
            below = ModelExchangeUnit(self.name, self.archive, settings)
            try:
                found = MovedParameter(name, below, ModelExchangeUnit(self.name, self.archive, settings))
            except BaseException:
                below.binding.free()
                raise
        found.set_parameters(self, {})
        return found

    @property
    def _instances(self) -> list[ModelExchangeUnit]:
        return [i for moved in self.added.moved.values() for i in moved.instances]

    def begin_again(self, parameters: Mapping[str, Any] | None = None) -> None:
        """See `FmuUnit`."""
        for instance in self._instances:
            instance.begin_again()
        super().begin_again(parameters)

    def set_parameters(self, parameters: Mapping[str, Any]) -> None:
        """See `FmuUnit`."""
        super().set_parameters(parameters)
        for moved in self.added.moved.values():
            moved.set_parameters(self, parameters)

    def set(self, name: str, value: AnyArray) -> None:
        """See `FmuUnit`."""
        super().set(name, value)
        if self._mode is not Mode.INSTANTIATED and name in self.writers:
            for instance in self._instances:
                instance.set(name, value)

    def initialise(self, time: int) -> None:
        """See `FmuUnit`."""
        for instance in self._instances:
            for name in self._given & self.writers.keys():
                instance.set(name, self.buffers.values[name])
            instance.initialise(time)
        super().initialise(time)

    def exit_initialisation(self) -> None:
        """See `FmuUnit`."""
        for instance in self._instances:
            instance.exit_initialisation()
        super().exit_initialisation()

    def terminate(self) -> None:
        """See `FmuUnit`."""
        for moved in self.added.moved.values():
            moved.free()
        super().terminate()

    def rates_at(self, time: float, states: Array, inputs: Mapping[str, AnyArray]) -> Array:
        """Derivatives of the states at a point, shape (states,), with inputs as they are given."""
        self._hold(inputs)
        rates = np.zeros(self._model.states)
        self._model.derivatives(time, states, rates)
        return rates

    def outputs_at(self, time: float, states: Array, inputs: Mapping[str, AnyArray]) -> Mapping[str, AnyArray]:
        """Outputs at a point, with inputs as they are given."""
        self._hold(inputs)
        self._model.move_to(time, states)
        self.buffers.read()
        return self.buffers.values

    def complete_step(self, time: float, states: Array, inputs: Mapping[str, AnyArray]) -> None:
        """Tell the FMU that an integration has come to a point; another instance decides whether that is an event."""
        self._hold(inputs)
        self._model.move_to(time, states)
        self._model.completed_integrator_step()

    def _hold(self, inputs: Mapping[str, AnyArray]) -> None:
        if self._mode is Mode.EVENT:
            self._leave_event_mode()
        for name, value in inputs.items():
            if not are_equal(self.buffers.values[name], value):
                self.buffers.values[name][...] = value
                self.writers[name]()

    def _where(self) -> tuple[float, Array] | None:
        if self._mode is Mode.INITIALISATION:
            return None
        return self._now, self._integrator.states[: self._model.states]

    def _begin(self, time: int) -> None:
        """From Initialization Mode through Event Mode to Continuous-Time Mode."""
        binding = self.binding
        self._mode = Mode.EVENT
        self._model = ContinuousModel(binding, self.added)
        reports = bool(binding.capabilities.needsCompletedIntegratorStep)
        self._integrator = Integrator(self._model, self.settings.tolerance or RELATIVE_TOLERANCE, reports)
        self._enter_continuous = binding.checked("EnterContinuousTimeMode")
        self._now = seconds(time)
        self._is_own_started = False
        self._leave_event_mode()

    def _leave_event_mode(self) -> None:
        """Iterate the discrete states until they settle, then go on with the states that result."""
        settled = self._settle()
        self._next_event = settled.next_event
        if self.added.moved and self._next_event is not None:
            raise refuse_event(self.name, self._next_event)
        self._enter_continuous()
        self._mode = Mode.RUNNING
        if settled.nominals_changed:
            self._integrator.forget()
        if not self._is_own_started:
            self._is_own_started = True
            self.added.start_own(self._now, self._model.get_states()[: self._model.states])
        self._integrator.restart(self._model.get_states())

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Integrate over one macro-step, through all events in it.

        Returns:
            OK at the end, or EARLY_RETURN just after the first event where the settings ask for that.

        Raises:
            UnitError: CVODE gave up, events follow each other without end, the FMU returned an error or asked to
                terminate.
        """
        self.exit_initialisation()
        try:
            begin = self._instant(time)
            self.added.delayed.hold(begin)
            self._follow_delayed(begin)
            if self._mode is Mode.EVENT:
                self._leave_event_mode()
            reached = self._advance(begin, seconds(time + size))
        except UnitError as error:
            when = max(time, math.floor(self._now * NANOSECONDS))
            raise UnitError(self.name, error.what, when, error.remedy) from error
        self._is_stale = False
        rounded = math.ceil((reached - INSTANT) * NANOSECONDS)
        self.added.time = reached
        if rounded < time + size:
            self.buffers.read(rounded)
            return StepOutcome(StepStatus.EARLY_RETURN, rounded, f"{self.name} had an event")
        self.buffers.read(time + size)
        return StepOutcome(StepStatus.OK, time + size)

    def _instant(self, time: int) -> float:
        """Where the FMU stands [s]: after an early return that is within a nanosecond of `time`, not on it."""
        begin = seconds(time)
        return self._now if abs(self._now - begin) * NANOSECONDS <= 1.0 else begin

    def _advance(self, begin: float, end: float) -> float:
        """Integrate to `end` [s], or to the first event where the settings ask for that; returns the time reached."""
        now, last, repeated = begin, -math.inf, 0
        self._now = begin
        while now < end - INSTANT or self._is_due(now):
            stop = end if self._next_event is None else max(now, min(end, self._next_event))
            stop = min(stop, self.added.delayed.next_jump(now))
            reached = self._integrator.advance(now, stop) if stop > now else None
            self._now = now = stop if reached is None else reached.time
            if reached is not None and reached.terminates:
                raise self._terminated()
            if reached is not None and reached.is_step_event and self.added.moved:
                raise refuse_event(self.name, now)
            has_jumped = now < end - INSTANT and self._follow_delayed(now)
            if reached is not None and not (reached.is_root or reached.is_step_event) and not self._is_due(now):
                if has_jumped:
                    self._leave_event_mode()
                continue
            repeated = repeated + 1 if now - last <= INSTANT else 0
            last = now
            if repeated > MOST_EVENTS:
                raise UnitError(
                    self.name,
                    f"{repeated} events follow each other at {now:.9g} s: it chatters",
                    remedy="give its switching a hysteresis",
                )
            self._enter_event_mode()
            self._leave_event_mode()
            if self.settings.report_early_return and is_worth_reporting(now, begin, end):
                return now
        self._now = end
        return end

    def _follow_delayed(self, now: float) -> bool:
        """Delayed inputs get their values from now on; one that jumps is an event."""
        if not self.added.delayed.move_to(now):
            return False
        self._enter_event_mode()
        self.added.place(now, self._integrator.states)
        return True

    def _is_due(self, now: float) -> bool:
        return self._next_event is not None and self._next_event <= now + INSTANT

    def _pass_on(self, name: str) -> None:
        """An input that jumps is an event: it may switch something whose indicator jumps along with it."""
        if self._mode is Mode.RUNNING and name in self.inputs:
            self._enter_event_mode()
        super()._pass_on(name)

    def _add_to_inputs(self) -> None:
        self.added.place(self._now, self._integrator.states)

    def refresh(self) -> None:
        """Outputs, and what switches, follow the inputs that were set since."""
        if self._mode is Mode.EVENT:
            self._leave_event_mode()
        super().refresh()

    def _extra(self) -> tuple[float | None, float, Array]:
        self._integrator.forget()
        return self._next_event, self._now, self._integrator.states.copy()

    def _take_extra(self, extra: tuple[float | None, float, Array], time: int) -> None:
        self._next_event, self._now, states = extra
        self._integrator.forget()
        self.added.take_own(states[self._model.states : self._model.states + self._model.own])
        self._integrator.restart(states[: self._model.states + self._model.own])

    def checkpoint(self) -> dict[str, np.ndarray[Any, Any]]:
        """The FMU's serialised state in Continuous-Time Mode, the inputs and the next time event."""
        self.refresh()
        return super().checkpoint()

    def _checkpoint_extra(self) -> dict[str, np.ndarray[Any, Any]]:
        self._integrator.forget()
        own = {"added_states": self.added.own_values} if self._model.own else {}
        return {"next_event": np.array(math.inf if self._next_event is None else self._next_event), **own}

    def _resume_extra(self, extra: Mapping[str, np.ndarray[Any, Any]], time: int) -> None:
        event = float(extra["next_event"])
        self._next_event = event if math.isfinite(event) else None
        if self._model.own:
            self.added.take_own(extra["added_states"])
        self._integrator.restart(self._model.get_states())
