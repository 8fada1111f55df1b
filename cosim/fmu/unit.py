"""An FMU as a unit: what Co-Simulation and Model Exchange have in common."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

import numpy as np

from cosim.fmu.access import Access
from cosim.fmu.added_terms import AddedTerms
from cosim.fmu.archive import FmuArchive
from cosim.fmu.binding import Binding, DiscreteStates, Interface
from cosim.fmu.buffers import Buffers, Saved
from cosim.fmu.delays import SavedDelay
from cosim.fmu.dependencies import dependencies
from cosim.fmu.plain import plain, unplain
from cosim.fmu.settings import FmuSettings, Table
from cosim.fmu.versions import bind
from cosim.unit.protocol import (
    NANOSECONDS,
    AnyArray,
    Causality,
    Coordinate,
    StepOutcome,
    Unit,
    UnitError,
    Variable,
    are_equal,
    element_text,
    is_finite,
    seconds,
)

__all__ = ["FmuSettings", "FmuUnit", "Mode", "SavedState"]

#: An FMU whose discrete states do not settle in so many iterations at one instant is given up.
MOST_ITERATIONS = 100


#: An event this close to the end of a step [s] (or a hundredth of the step) is not reported: the end is a communication
#: point anyway, and an integrator finds the event again at a time that differs by its tolerance.
REPORT_MARGIN = 2e-6


def is_worth_reporting(event: float, begin: float, end: float) -> bool:
    """Whether an event [s] lies inside a step, and not practically at its begin or end."""
    return begin + 1.0 / NANOSECONDS < event < end - min(REPORT_MARGIN, 0.01 * (end - begin))


class Mode(Enum):
    """Where an instance is in the state machine of FMI."""

    INSTANTIATED = "instantiated"
    INITIALISATION = "Initialization Mode"
    #: Step Mode (Co-Simulation) or Continuous-Time Mode (Model Exchange).
    RUNNING = "running"
    EVENT = "Event Mode"


@dataclass(frozen=True)
class SavedState:
    """What `FmuUnit.save` gives.

    Args:
        handle: The FMU's own state.
        values: Inputs and outputs.
        mode: Where the instance is.
        is_stale: Whether an input was set after the outputs were read.
        extra: What the interface keeps beside it.
        delayed: What delayed inputs of terms remember.
    """

    handle: Any
    values: Saved
    mode: Mode
    is_stale: bool
    extra: Any
    delayed: tuple[SavedDelay | None, ...] = ()


class FmuUnit(Unit):
    """Base of both interfaces.

    Args:
        name: Name of the component in the scenario.
        archive: The opened FMU; removed from disk by `terminate`.
        settings: Structure, parameters, start values.
        interface: Which of the FMU's interfaces is used.

    Raises:
        InputError: Something in `settings` does not exist or does not fit, or the FMU cannot be loaded.
    """

    def __init__(self, name: str, archive: FmuArchive, settings: FmuSettings, interface: Interface) -> None:
        self.name, self.archive, self.settings = name, archive, settings
        self.coordinates: Mapping[str, Coordinate] = {}
        self.table = Table(name, archive, settings)
        variables = {n: v.variable for n, v in self.table.exposed.items()}
        self.variables: Mapping[str, Variable] = variables
        #: Variables that `record` would make readable.
        self.unrecorded = frozenset(n for n, v in self.table.all.items() if v.variable.causality is Causality.LOCAL)
        self.unrecorded -= variables.keys()
        found = dependencies(archive.description, self.table.exposed)
        self.feedthrough, self.initial_feedthrough = found.feedthrough, found.initial
        self.binding: Binding = bind(archive, interface, name)
        try:
            self.can_restore = bool(self.binding.capabilities.canGetAndSetFMUstate)
            self.can_checkpoint = bool(self.binding.capabilities.canSerializeFMUstate)
            self.table.configure(self.binding)
            self.table.set_parameters(self.binding, settings.parameters)
            self.outside_range = self.table.outside_range()
            self.buffers = Buffers(self.binding, self.table.exposed)
            self.added = AddedTerms(name, self.table, interface == "model_exchange")
            if not self.added.is_empty:
                self._take_terms()
            #: Input to the call that sets it.
            self.writers: Mapping[str, Access] = self.buffers.writers
            #: Inputs but clocks, those that the FMU does not have last.
            self.inputs = (*self.writers, *(n for n, v in self.table.exposed.items() if v.is_added))
            #: One call for each variable that is read after a step.
            self.readers: list[Access] = self.buffers.readers
            self._mode = Mode.INSTANTIATED
            if self.binding.uses_event_mode:
                self._call_enter_event_mode = self.binding.checked("EnterEventMode")
            self._is_stale = False
            self._given: set[str] = set()
            for key, value in self.table.start_values(self.binding).items():
                self.buffers.values[key][...] = value
                self._given.add(key)
                variables[key] = replace(variables[key], start=value)  # what elements that nothing leads into keep
        except BaseException:
            self.binding.free()
            raise

    def _take_terms(self) -> None:
        """What the master adds acts from here on; outputs then depend on what their terms use."""
        self.added.bind(self.binding, self.buffers.values)
        self.buffers.added = self.added.add_outputs
        for name, inputs in self.added.feedthrough(self.feedthrough).items():
            self.feedthrough = {**self.feedthrough, name: self.feedthrough.get(name, frozenset()) | inputs}
            initial = self.initial_feedthrough.get(name, frozenset()) | inputs
            self.initial_feedthrough = {**self.initial_feedthrough, name: initial}

    def begin_again(self, parameters: Mapping[str, Any] | None = None) -> None:
        """Back to before the initialisation, with the parameters and start values that were given.

        Args:
            parameters: Those that have other values from now on, see `set_parameters`.

        Raises:
            UnitError: The FMU refuses to be reset.
            InputError: No such parameter, or a value that does not fit.
        """
        parameters = parameters or {}
        self.binding.call(self.binding.fmu.reset)
        self.binding.messages.clear()
        self._mode, self._is_stale = Mode.INSTANTIATED, False
        self.table.configure(self.binding)
        for name, access in self.binding.given.items():
            if name not in parameters:
                access()
        self.set_parameters(parameters)

    def set_parameters(self, parameters: Mapping[str, Any]) -> None:
        """Set parameters before initialisation; a scalar fills an array.

        Raises:
            InputError: No such parameter, or a value that does not fit.
        """
        self.table.set_parameters(self.binding, parameters)

    def set(self, name: str, value: AnyArray) -> None:
        """Copy a value to an input of the FMU; it reaches the FMU at once."""
        buffer = self.buffers.values[name]
        if self._mode is Mode.INSTANTIATED:
            self._given.add(name)
        elif buffer is not value and are_equal(buffer, value):
            return  # the FMU has it already
        buffer[...] = value
        if buffer.dtype.kind == "f" and not is_finite(buffer):
            raise UnitError(self.name, f"input {name}{element_text(buffer)} is not a finite number")
        self._pass_on(name)
        self._is_stale = True

    def _pass_on(self, name: str) -> None:
        """Hand an input to the FMU, with what is added to inputs."""
        if name in self.writers:
            self.writers[name]()
        if name in self.inputs and self._mode in (Mode.RUNNING, Mode.EVENT):
            self._add_to_inputs()

    def _add_to_inputs(self) -> None:
        """At a communication point: inputs get what is added to them."""
        self.added.write_inputs(self.added.time)

    def get(self, name: str) -> AnyArray:
        """Live buffer of an input, output or recorded variable."""
        return self.buffers.values[name]

    def initialise(self, time: int) -> None:
        """Enter Initialization Mode with the inputs set so far; what was not set keeps the FMU's own start value."""
        self.binding.enter_initialisation(seconds(time), self.settings.tolerance, self.settings.stop_time)
        self._mode = Mode.INITIALISATION
        self.table.check_accepted(self.binding)
        for name, write in self.writers.items():
            if name in self._given:
                write()
            elif self.variables[name].start is None:
                self.buffers.input_readers[name]()  # not every FMU lets its inputs be read, so only where it must be
        self.added.time = seconds(time)
        self.buffers.read(time)
        self._start_time = time

    def exit_initialisation(self) -> None:
        """Leave Initialization Mode; a second call does nothing."""
        if self._mode is Mode.INITIALISATION:
            self.binding.exit_initialisation()
            self._begin(self._start_time)
            self.buffers.read(self._start_time)
            self._is_stale = False

    def _enter_event_mode(self) -> None:
        if self._mode is not Mode.EVENT:
            self._call_enter_event_mode()
            self._mode = Mode.EVENT

    def _settle(self) -> DiscreteStates:
        """Iterate in Event Mode until the discrete states do not change any more.

        Raises:
            UnitError: They do not settle, or the FMU asks to terminate.
        """
        nominals = states = False
        for _ in range(MOST_ITERATIONS):
            self._before_update()
            found = self.binding.update_discrete_states()
            self._after_update()
            nominals, states = nominals or found.nominals_changed, states or found.states_changed
            if found.terminate:
                raise self._terminated()
            if not found.again:
                return DiscreteStates(False, False, nominals, states, found.next_event)
        raise UnitError(self.name, f"its discrete states do not settle in {MOST_ITERATIONS} iterations")

    def _terminated(self) -> UnitError:
        """The FMU asks to end the simulation: its outputs are valid, so they are read before that is said."""
        self.buffers.read()
        return UnitError(self.name, "the FMU asks to terminate the simulation")

    def _before_update(self) -> None:
        """What an interface reads in Event Mode before the discrete states are updated."""

    def _after_update(self) -> None:
        """What it reads afterwards."""

    def _begin(self, time: int) -> None:
        """From the end of Initialization Mode to the first step."""
        self._mode = Mode.RUNNING

    def refresh(self) -> None:
        """Read the outputs again if an input was set since."""
        if self._is_stale:
            self.buffers.read()
            self._is_stale = False

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Advance; the interface's own way."""
        raise NotImplementedError

    def _extra(self) -> Any:
        """What the interface keeps beside the FMU's own state."""
        return None

    def _take_extra(self, extra: Any, time: int) -> None:
        """Return to what `_extra` gave."""

    def save(self) -> SavedState:
        """The FMU's state, the values of inputs and outputs, and what the interface keeps."""
        if not self.can_restore:
            raise UnitError(
                self.name,
                "it cannot return to a saved state (canGetAndSetFMUstate is false)",
                remedy="choose an algorithm that repeats no step",
            )
        self.exit_initialisation()
        return SavedState(
            self.binding.save(),
            self.buffers.save(),
            self._mode,
            self._is_stale,
            self._extra(),
            self.added.delayed.save(),
        )

    def restore(self, saved: SavedState, time: int) -> None:
        """Return to a saved state, any number of times."""
        self.binding.restore(saved.handle)
        self.buffers.restore(saved.values)
        self._mode, self._is_stale = saved.mode, saved.is_stale
        self._take_extra(saved.extra, time)
        self.added.delayed.restore(saved.delayed)
        self.added.see_outputs()

    def release(self, saved: SavedState) -> None:
        """Free a saved state."""
        if self.binding.is_alive:
            self.binding.free_state(saved.handle)

    def checkpoint(self) -> dict[str, np.ndarray[Any, Any]]:
        """The FMU's serialised state, the inputs, and what the interface keeps."""
        if not self.binding.capabilities.canSerializeFMUstate:
            has = "can get and set its state but not serialise it" if self.can_restore else "cannot save its state"
            raise UnitError(
                self.name,
                f"the FMU {has}, so the run cannot be resumed from here",
                remedy="leave out checkpoints, or export the FMU with canSerializeFMUState",
            )
        self.exit_initialisation()
        inputs = {f"input.{n}": plain(self.buffers.values[n]) for n in self.inputs}
        extra = {f"extra.{k}": v for k, v in self._checkpoint_extra().items()}
        delayed = {f"delayed.{k}": v for k, v in self.added.delayed.arrays().items()}
        return {"state": self.binding.serialise(), **inputs, **extra, **delayed}

    def _checkpoint_extra(self) -> dict[str, np.ndarray[Any, Any]]:
        return {}

    def _resume_extra(self, extra: Mapping[str, np.ndarray[Any, Any]], time: int) -> None:
        """Return to what `_checkpoint_extra` gave."""

    def resume(self, state: Mapping[str, np.ndarray[Any, Any]], time: int) -> None:
        """Initialise, then restore the serialised state."""
        for name in self.inputs:
            self.buffers.values[name][...] = unplain(state[f"input.{name}"], self.variables[name].type)
            self._given.add(name)
        self.initialise(time)
        self.exit_initialisation()
        self.binding.deserialise(state["state"])
        extra = {k.removeprefix("extra."): v for k, v in state.items() if k.startswith("extra.")}
        self._resume_extra(extra, time)
        delayed = {k.removeprefix("delayed."): v for k, v in state.items() if k.startswith("delayed.")}
        self.added.delayed.resume(delayed)
        self.added.time = seconds(time)
        self.buffers.read(time)

    def terminate(self) -> None:
        """Free the instance and the extracted files; safe to call twice."""
        self.binding.free()
        self.archive.remove()
