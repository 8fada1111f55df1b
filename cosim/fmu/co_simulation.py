"""A Co-Simulation FMU: it brings its own solver."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from cosim.fmu.archive import FmuArchive
from cosim.fmu.clocks import Clocks
from cosim.fmu.unit import FmuSettings, FmuUnit, Mode, SavedState, is_worth_reporting
from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS, AnyArray, StepOutcome, StepStatus, UnitError, VariableType, seconds

#: What is practically the same instant [s]: a tenth of the resolution of simulated time.
INSTANT = 0.1 / NANOSECONDS
#: Early returns in a row without having moved before the FMU is given up.
MOST_RETURNS = 100


class CoSimulationUnit(FmuUnit):
    """An FMU that integrates itself (`integrator: internal`).

    Where it returns early, or in FMI 3.0 asks for Event Mode, the event is handled and the step goes on to its end,
    unless the settings ask for the event to be reported.

    Args:
        name: Name of the component in the scenario.
        archive: The opened FMU.
        settings: Structure, parameters and start values.

    Raises:
        InputError: The FMU has no Co-Simulation interface, or something in `settings` does not fit.
    """

    def __init__(self, name: str, archive: FmuArchive, settings: FmuSettings) -> None:
        super().__init__(name, archive, settings, "co_simulation")
        #: Whether steps may differ in size.
        self.can_vary_step = bool(self.binding.capabilities.canHandleVariableCommunicationStepSize)
        self._size: int | None = None
        self._now = math.nan
        self._saved = 0
        #: Time of the next time event that the FMU has announced [s].
        self.next_event: float | None = None
        #: Its clocks.
        self.clocks = Clocks(self.binding, self.table.exposed, self.buffers.values)
        if self.clocks.timed and not self.binding.uses_event_mode:
            self.binding.free()
            raise InputError(
                archive.path,
                name,
                "its clocks need Event Mode, which it does not have (hasEventMode)",
                "export it with Event Mode",
            )

    @property
    def is_plain(self) -> bool:
        """Whether a step is nothing but inputs, doStep and outputs: no Event Mode and no clocks."""
        return not self.binding.uses_event_mode and self.clocks.is_empty

    def check_step(self, size: int) -> None:
        """Raise InputError if the FMU cannot make steps of `size` [ns]."""
        internal = self.binding.capabilities.fixedInternalStepSize
        if self.can_vary_step or internal is None:
            return
        ratio = seconds(size) / float(internal)
        if abs(ratio - round(ratio)) > 1e-6 or round(ratio) < 1:
            raise InputError(
                self.archive.path,
                f"{self.name}.fixedInternalStepSize",
                f"it steps by {internal} s inside, and a macro-step of {seconds(size):g} s is no multiple of that",
                "choose a macro_step that is a multiple",
            )

    def _begin(self, time: int) -> None:
        self._now = seconds(time)
        if self.added.owners:
            self.buffers.read(time)  # some FMUs have their start values only from the end of Initialization Mode on
        self.added.start_own(self._now, None)
        self._mode = Mode.EVENT if self.binding.uses_event_mode else Mode.RUNNING
        if self._mode is Mode.EVENT:
            self._enter_step_mode = self.binding.checked("EnterStepMode")
            self.clocks.begin(self._now)
            self._leave_event_mode()

    def _leave_event_mode(self) -> None:
        """Tick what ticks now, iterate until the discrete states settle, go back to Step Mode."""
        if not self.clocks.is_empty:
            self.clocks.activate(self._now, INSTANT, self._write)
        self.next_event = self._settle().next_event
        self._enter_step_mode()
        self._mode = Mode.RUNNING

    def _before_update(self) -> None:
        if not self.clocks.is_empty:
            self.clocks.read()

    def _after_update(self) -> None:
        if not self.clocks.is_empty:
            self.clocks.ask_intervals(self._now)

    def set(self, name: str, value: AnyArray) -> None:
        """Copy a value to an input; a clock that is set true ticks at this instant."""
        if self.variables[name].type is not VariableType.CLOCK:
            super().set(name, value)
        elif np.any(value):
            self.buffers.values[name][...] = value
            if self._mode is Mode.RUNNING:
                self._enter_event_mode()
            self._is_stale = True

    def _write(self, name: str) -> None:
        self.writers[name]()

    def _pass_on(self, name: str) -> None:
        if name in self.clocks.clocked:
            return  # it is handed over when its clock ticks
        if self._mode is Mode.RUNNING and self.binding.uses_event_mode and self.table.exposed[name].is_discrete:
            self._enter_event_mode()
        super()._pass_on(name)

    def refresh(self) -> None:
        """Outputs, and what switches, follow the inputs that were set since."""
        if self._mode is Mode.EVENT:
            self._leave_event_mode()
        super().refresh()

    def do_step(self, time: int, size: int) -> StepOutcome:
        """One macro-step, through all events in it.

        Returns:
            OK at the end; EARLY_RETURN just after the first event where the settings ask for that; DISCARDED at the
            time that the FMU has reached where it refuses the step.

        Raises:
            UnitError: The FMU returned an error, asked to terminate, or an output is not finite.
        """
        self.exit_initialisation()
        if not self.can_vary_step and self._size not in (None, size):
            raise UnitError(
                self.name,
                "it cannot change its communication step size (canHandleVariableCommunicationStepSize is false)",
                time,
                "choose an algorithm with constant steps",
            )
        begin, end, length = seconds(time), seconds(time + size), seconds(size)
        if begin != self._now and abs(self._now - begin) * NANOSECONDS <= 1.0:
            begin, length = self._now, end - self._now
        try:
            self._now = begin
            self.clocks.silence()  # before the events at the begin: what ticks in them is a tick of this step
            if self._mode is Mode.EVENT:
                self._leave_event_mode()
            self.added.delayed.hold(begin)
            self.added.delayed.average(begin, end)
            self.added.write_inputs(begin)
            self.added.time = end
            status = self._advance(begin, end, length)
            self.added.step_own(begin, self._now - begin)
        except UnitError as error:
            raise UnitError(self.name, error.what, self._reached, error.remedy) from error
        if status is StepStatus.DISCARDED:
            return StepOutcome(status, self._reached, f"{self.name} refused the step (discard)")
        self._size = size
        self._is_stale = False
        if status is StepStatus.EARLY_RETURN and self._reached < time + size:
            self.buffers.read(self._reached)
            return StepOutcome(status, self._reached, f"{self.name} had an event")
        self.buffers.read(time + size)
        return StepOutcome(StepStatus.OK, time + size)

    @property
    def _reached(self) -> int:
        """The first nanosecond at or after the point where the FMU stands."""
        return math.ceil((self._now - INSTANT) * NANOSECONDS)

    def _due(self) -> float | None:
        """Time of the next time event or tick [s]."""
        tick = self.clocks.next_tick
        if self.next_event is None or tick is None:
            return self.next_event if tick is None else tick
        return min(self.next_event, tick)

    def _is_due(self) -> bool:
        due = self._due()
        return due is not None and due <= self._now + INSTANT

    def _advance(self, begin: float, end: float, length: float) -> StepStatus:
        """From begin to end; a whole step is passed with its own length, not with the rounding of end - begin."""
        self._now, stuck = begin, 0
        while self._now < end - INSTANT:
            if not self._is_due():
                due = self._due()
                stop = end if due is None else min(end, due)
                before = self._now
                is_whole = before == begin and stop == end
                result = self.binding.do_step(before, length if is_whole else stop - before, self._saved == 0)
                self._now = result.reached if result.early or result.discarded else stop
                if result.terminate:
                    raise self._terminated()
                if result.discarded:
                    return StepStatus.DISCARDED
                stuck = 0 if self._now > before + INSTANT else stuck + 1
                if stuck > MOST_RETURNS:
                    raise UnitError(self.name, f"it returned early {stuck} times without moving", self._reached)
                if not (result.event or result.early or self._is_due()):
                    continue
                has_event = result.event or self._is_due()
            else:
                has_event = True
            if has_event and self.binding.uses_event_mode:
                self._enter_event_mode()
                self._leave_event_mode()
            if self.settings.report_early_return and is_worth_reporting(self._now, begin, end):
                return StepStatus.EARLY_RETURN
        self._now = end
        return StepStatus.OK

    def moved_to(self, time: int, size: int) -> None:
        """Whoever made the FMU's steps in place of `do_step` says where it stands.

        Args:
            time: Time reached [ns].
            size: Size of the steps [ns].
        """
        self._now, self._size = seconds(time), size

    def save(self) -> SavedState:
        """As for every FMU; until it is released, the FMU is told that it may have to go back."""
        saved = super().save()
        self._saved += 1
        return saved

    def release(self, saved: SavedState) -> None:
        """Free a saved state."""
        super().release(saved)
        self._saved -= 1

    def checkpoint(self) -> dict[str, np.ndarray[Any, Any]]:
        """The FMU's serialised state in Step Mode, the inputs, and what is due next."""
        self.refresh()
        return super().checkpoint()

    def _extra(self) -> tuple[float, ...]:
        event = math.nan if self.next_event is None else self.next_event
        ticks = [x for clock in self.clocks.timed for x in clock.state()]
        own = self.added.own_values.tolist()
        return (self._now, event, math.nan if self._size is None else self._size, *own, *ticks)

    def _take_extra(self, extra: tuple[float, ...], time: int) -> None:
        self._now, event, size = extra[:3]
        self.next_event = None if math.isnan(event) else event
        self._size = None if math.isnan(size) else int(size)
        own = 3 + self.added.own_count
        self.added.take_own(np.array(extra[3:own]))
        for i, clock in enumerate(self.clocks.timed):
            clock.take(extra[own + 4 * i : own + 4 * (i + 1)])

    def _checkpoint_extra(self) -> dict[str, np.ndarray[Any, Any]]:
        return {"clockwork": np.array(self._extra())}

    def _resume_extra(self, extra: Mapping[str, np.ndarray[Any, Any]], time: int) -> None:
        self._take_extra(tuple(extra["clockwork"].tolist()), time)
