"""Controllers of strings, each a unit of its own (an FMU), behind the ports of one controller."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from cosim.control.controller import ControllerDesign, controller_variables
from cosim.unit.protocol import AnyArray, Coordinate, StepOutcome, StepStatus, Unit, Variable

#: Ports with one value per string.
_PER_STRING = ("setpoint", "command", "demand", "alarm")


class StringControllers(Unit):
    """What `ControllerUnit` does, by one unit per string with the ports measured, setpoint, command, demand, alarm.

    Args:
        name: Name of the component.
        design: Groups, limits, times.
        strings: One unit per group, in order; its `measured` has as many elements as the group.
    """

    def __init__(self, name: str, design: ControllerDesign, strings: Sequence[Unit]) -> None:
        self.name, self.strings = name, tuple(strings)
        self.variables: Mapping[str, Variable] = controller_variables(design)
        self.coordinates: Mapping[str, Coordinate] = {}
        self.can_restore = all(s.can_restore for s in self.strings)
        self.can_checkpoint = all(s.can_checkpoint for s in self.strings)
        self._parts = np.cumsum(design.groups)[:-1]
        self._is_common = design.is_common
        self.set("setpoint", np.asarray(self.variables["setpoint"].start))

    def set(self, name: str, value: AnyArray) -> None:
        """Copy an input; raises UnitError if it is not finite."""
        if name == "measured":
            parts: Sequence[AnyArray] = np.split(np.asarray(value), self._parts)
        else:
            parts = list(np.broadcast_to(np.asarray(value), (len(self.strings),)))
        for string, part in zip(self.strings, parts):
            string.set(name, part)

    def get(self, name: str) -> AnyArray:
        """Current value of a variable."""
        values = [np.asarray(s.get(name), dtype=np.float64).reshape(-1) for s in self.strings]
        joined = np.concatenate(values)
        return joined.reshape(()) if self._is_common and name in _PER_STRING else joined

    def initialise(self, time: int) -> None:
        """The lowest command, until the first sample."""
        for string in self.strings:
            string.initialise(time)

    def exit_initialisation(self) -> None:
        """See `Unit`."""
        for string in self.strings:
            string.exit_initialisation()

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Every string acts where its sample is due; raises UnitError where one of them cannot go on."""
        for string in self.strings:
            string.do_step(time, size)
        return StepOutcome(StepStatus.OK, time + size)

    def save(self) -> Any:
        """State of every string; raises UnitError where one cannot restore."""
        return [s.save() for s in self.strings]

    def restore(self, saved: Any, time: int) -> None:
        """Return to `save`."""
        for string, state in zip(self.strings, saved):
            string.restore(state, time)

    def release(self, saved: Any) -> None:
        """Free what `save` gave."""
        for string, state in zip(self.strings, saved):
            string.release(state)

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """State of every string."""
        return {f"{i}.{n}": a for i, s in enumerate(self.strings, start=1) for n, a in s.checkpoint().items()}

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]], time: int) -> None:
        """Continue from `checkpoint`."""
        for i, string in enumerate(self.strings, start=1):
            prefix = f"{i}."
            string.resume({n.removeprefix(prefix): a for n, a in state.items() if n.startswith(prefix)}, time)

    def terminate(self) -> None:
        """Free every string."""
        for string in self.strings:
            string.terminate()
