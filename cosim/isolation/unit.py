"""A unit in a process of its own, behind the protocol of any unit."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from cosim.fmu.archive import FmuArchive
from cosim.isolation.limits import Limits
from cosim.isolation.message import STATUSES, Frame, Kind
from cosim.isolation.process import IsolatedProcess
from cosim.isolation.shared import SharedArrays
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Coordinate, StepOutcome, Unit, UnitError, Variable, element_text

_LOG = logging.getLogger(__name__)


class IsolatedUnit(Unit):
    """A unit that another process builds and steps.

    Inputs that are set are handed over with the next request, so a value that the unit refuses is an error there.
    Outputs are copied after each step once they have been read for the first time.

    Several such units can step at the same time: `begin_step` on each, then `finish_step` on each.

    Args:
        name: Name of the component in the scenario.
        build: Makes the unit; called in the other process, so it must survive pickling
            (`functools.partial(CoSimulationUnit, name, archive, settings)`).
        limits: Wall time and memory that it may take.
        archive: The FMU's extracted files; removed at the end even if the process crashes.

    Raises:
        InputError: What the unit's own construction raises.
        UnitError: The same, or the process crashed or took too long.
    """

    def __init__(self, name: str, build: Callable[[], Unit], limits: Limits, archive: FmuArchive | None = None) -> None:
        self.name, self.archive = name, archive
        self._process = IsolatedProcess(name, build, limits, None if archive is None else archive.directory)
        self._time: int | None = None
        self._is_stepping = False
        try:
            request = Frame(Kind.CONSTRUCT, limits.memory_limit)
            facts = self._process.ask(request, "its construction", None).payload
        except BaseException:
            self._process.end()
            raise
        self.variables: Mapping[str, Variable] = facts["variables"]
        self.coordinates: Mapping[str, Coordinate] = facts["coordinates"]
        self.feedthrough: Mapping[str, frozenset[str]] = facts["feedthrough"]
        self.initial_feedthrough: Mapping[str, frozenset[str]] = facts["initial_feedthrough"]
        self.unrecorded: frozenset[str] = facts["unrecorded"]
        self.can_restore: bool = facts["can_restore"]
        self.can_checkpoint: bool = facts["can_checkpoint"]
        self._shared = SharedArrays(self._process.memory, self.variables, is_owner=False)
        self._arrays = self._shared.arrays
        self._indices = {n: i for i, n in enumerate(self._shared.inputs)}
        self._kept = {n for n in self._indices if n not in self._shared.texts}
        self._floats = {n for n in self._indices if self.variables[n].type.is_float}
        self._texts: dict[str, AnyArray] = {}

    def _send(self, kind: Kind, doing: str, first: int = 0, second: int = 0, rest: Any = None) -> None:
        if self._is_stepping:
            raise RuntimeError(f"{self.name}: finish_step comes before anything else")
        payload = (self._texts, rest) if self._texts or rest is not None else None
        self._process.send(Frame(kind, first, second, payload), doing, self._time)
        self._texts = {}

    def _receive(self, doing: str) -> tuple[Frame, Any]:
        reply = self._process.receive(doing, self._time)
        if reply.payload is None:
            return reply, None
        texts, rest = reply.payload
        for name, value in texts.items():
            self._arrays[name][...] = value
        return reply, rest

    def _ask(self, kind: Kind, doing: str, first: int = 0, second: int = 0, rest: Any = None) -> tuple[Frame, Any]:
        self._send(kind, doing, first, second, rest)
        return self._receive(doing)

    def set(self, name: str, value: AnyArray) -> None:
        """Copy a finite value to an input; the unit gets it with the next request."""
        array = self._arrays[name]
        array[...] = value
        if name in self._floats and not np.isfinite(array).all():
            raise UnitError(self.name, f"input {name}{element_text(array)} is not a finite number")
        if name in self._shared.texts:
            self._texts[name] = array.copy()
        self._shared.changed[self._indices[name]] = 1

    def get(self, name: str) -> AnyArray:
        """Live array of a variable."""
        if name not in self._kept:
            self._ask(Kind.FETCH, f"the reading of {name}", rest=name)
            self._kept.add(name)
        return self._arrays[name]

    def initialise(self, time: int) -> None:
        """Initialise at `time` [ns]."""
        self._time = time
        self._ask(Kind.INITIALISE, "its initialisation", time)

    def exit_initialisation(self) -> None:
        """All start values have been exchanged."""
        self._ask(Kind.EXIT_INITIALISATION, "the end of its initialisation")

    def refresh(self) -> None:
        """Outputs follow inputs; nothing is asked where no output depends directly on an input."""
        if self.feedthrough or self.initial_feedthrough:
            self._ask(Kind.REFRESH, "the update of its outputs")

    def begin_step(self, time: int, size: int) -> None:
        """Let it step, and do not wait: `finish_step` is the next call."""
        self._time = time
        self._send(Kind.DO_STEP, "its step", time, size)
        self._is_stepping = True

    def finish_step(self) -> StepOutcome:
        """Wait for the end of the step that `begin_step` began.

        Raises:
            UnitError: It cannot go on, crashed or did not return in time.
        """
        self._is_stepping = False
        reply, message = self._receive("its step")
        self._time = reply.second
        return StepOutcome(STATUSES[reply.first], reply.second, message or "")

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Step and wait."""
        self.begin_step(time, size)
        return self.finish_step()

    def save(self) -> int:
        """A number under which the other process keeps the state."""
        return self._ask(Kind.SAVE, "the saving of its state")[0].first

    def restore(self, saved: int, time: int) -> None:
        """Return to a saved state; the values last set are gone."""
        self._texts = {}
        self._time = time
        self._ask(Kind.RESTORE, "the return to a saved state", time, saved)

    def release(self, saved: int) -> None:
        """Let the other process free the state; nothing where that process has ended."""
        if not self._process.failure:
            self._ask(Kind.RELEASE, "the release of a saved state", 0, saved)

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """The unit's own checkpoint."""
        state: dict[str, npt.NDArray[np.generic]] = self._ask(Kind.CHECKPOINT, "its checkpoint")[1]
        return state

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]], time: int) -> None:
        """Continue from the unit's own checkpoint."""
        self._time = time
        self._ask(Kind.RESUME, "its resumption", time, rest=dict(state))

    def terminate(self) -> None:
        """End the process and remove the extracted files; safe to call twice.

        A crash here costs no results, so it is a warning and no error.
        """
        if not self._process.has_ended:
            try:
                if self._is_stepping:
                    self.finish_step()
                self._ask(Kind.TERMINATE, "its termination")
                self._process.finish()
            except (UnitError, InputError) as error:
                _LOG.warning("warning: %s; the results are not affected", error)
            finally:
                self._process.end()
        if self.archive is not None:
            self.archive.remove()
