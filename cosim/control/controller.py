"""A controller as a unit: measured values in, what drives out."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cosim.control.laws import Law, Sample
from cosim.control.supervisor import Supervisor
from cosim.unit.protocol import (
    Array,
    ArrayStore,
    Causality,
    Coordinate,
    StepOutcome,
    StepStatus,
    Unit,
    UnitError,
    Variable,
    seconds,
)

#: How measured elements of a group become one value.
_COMBINE: Mapping[str, Callable[[Array], np.floating[npt.NBitBase]]] = {"mean": np.mean, "max": np.max, "min": np.min}


@dataclass(frozen=True)
class ControllerDesign:
    """A controller and its surroundings.

    Args:
        groups: Measured elements of every group, in order; each group has one command.
        measured_unit: Unit of measured values and setpoint.
        command_unit: Unit of the command.
        sample: Interval between samples [ns].
        low: Lowest command.
        high: Highest command.
        setpoint: Shape (groups,), where nothing is connected to that input.
        combine: `mean`, `max` or `min` of the elements of a group.
        is_squared: Whether the law's demand is the square of the command: heat goes with the square of a voltage.
        is_common: One command for all, a scalar; else one per group.
    """

    groups: Sequence[int]
    measured_unit: str
    command_unit: str
    sample: int
    low: float
    high: float
    setpoint: Array
    combine: str = "mean"
    is_squared: bool = False
    is_common: bool = False


def controller_variables(design: ControllerDesign) -> dict[str, Variable]:
    """Ports of a controller, by name."""
    count, elements = len(design.groups), sum(design.groups)
    shape, dims = ((), ()) if design.is_common else ((count,), ("string",))
    given, found = Causality.INPUT, Causality.OUTPUT
    demand_unit = f"({design.command_unit})^2" if design.is_squared else design.command_unit
    first = float(design.setpoint[0]) if design.is_common else design.setpoint
    listed = (
        Variable("measured", given, (elements,), design.measured_unit, ("coil",), "what the sensor reads"),
        Variable("setpoint", given, shape, design.measured_unit, dims, "what is asked for", start=first),
        Variable("command", found, shape, design.command_unit, dims, "what drives"),
        Variable("demand", found, shape, demand_unit, dims, "what the law asks for, before limits"),
        Variable("alarm", found, shape, "1", dims, "0 none, 1 limited, 2 out of range, 3 frozen, 4 no response"),
    )
    return {v.name: v for v in listed}


class ControllerUnit(Unit):
    """Samples its input `measured` and holds its output `command` until the next sample.

    In the order of the algorithm it comes after its sensor and before what it drives. `alarm` says per group what the
    supervisor does: 0 nothing, 1 it lowers the command, 2 to 4 a thermometer has failed and the group is off
    (`cosim.control.supervisor`). `demand` is what the law asked for, before limits and supervisor.

    Args:
        name: Name of the component.
        design: Groups, limits, times.
        law: From setpoint and measured value to the demand.
        supervisor: Over the law; None: none.
    """

    can_restore = True

    def __init__(self, name: str, design: ControllerDesign, law: Law, supervisor: Supervisor | None = None) -> None:
        self.name, self.design, self.law, self.supervisor = name, design, law, supervisor
        self.variables: Mapping[str, Variable] = controller_variables(design)
        self.coordinates: Mapping[str, Coordinate] = {}
        self._store = ArrayStore(name, self.variables)
        self._ends = np.cumsum([0, *design.groups])
        self._start = 0
        self._memory: dict[str, Array] = {}
        self._watch: dict[str, Array] = {}

    def set(self, name: str, value: Array) -> None:
        """Copy an input; raises UnitError if it is not finite."""
        self._store.set(name, value)

    def get(self, name: str) -> Array:
        """Current value of a variable."""
        return self._store.get(name)

    def initialise(self, time: int) -> None:
        """The lowest command, until the first sample."""
        self._start = time
        try:
            self._memory = self.law.begin(len(self.design.groups))
        except ValueError as error:  # of a user's own law
            raise UnitError(self.name, str(error), time, "correct the law's file") from error
        if self.supervisor is not None:
            self._watch = self.supervisor.begin(sum(self.design.groups), seconds(self.design.sample))
        self._store.arrays["command"][...] = self.design.low
        self._store.arrays["demand"][...] = 0.0
        self._store.arrays["alarm"][...] = 0.0

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Act where a sample is due at `time`; what it gives holds over the step.

        Raises:
            UnitError: The law gives a number that is not finite.
        """
        if (time - self._start) % self.design.sample == 0:
            self._act(time)
        return StepOutcome(StepStatus.OK, time + size)

    def _act(self, time: int) -> None:
        design, put = self.design, self._store.arrays
        count, step = len(design.groups), seconds(design.sample)
        measured = put["measured"]
        by_group = np.array(
            [_COMBINE[design.combine](measured[a:b]) for a, b in zip(self._ends[:-1], self._ends[1:])], dtype=np.float64
        )
        setpoint = np.broadcast_to(put["setpoint"], (count,)).astype(np.float64)
        power = 2.0 if design.is_squared else 1.0
        low, high = design.low**power, design.high**power
        try:
            demand = self.law.demand(Sample(seconds(time), step, setpoint, by_group), self._memory, low, high)
        except ValueError as error:  # of a user's own law
            raise UnitError(self.name, str(error), time, "correct the law's file") from error
        if demand.shape != (count,) or not np.isfinite(demand).all():
            raise UnitError(
                self.name,
                f"its law asks for {demand} in {count} groups",
                time,
                "a law gives one finite number per group",
            )
        given = np.clip(demand, low, high)
        alarm = np.zeros(count)
        if self.supervisor is not None:
            given, alarm = self._supervised(given, low, high, step)
        put["command"][...] = self._shaped(given ** (1.0 / power))
        put["demand"][...] = self._shaped(demand)
        put["alarm"][...] = self._shaped(alarm)

    def _supervised(self, given: Array, low: float, high: float, step: float) -> tuple[Array, Array]:
        """What is left of the law's command, and the alarm of every group."""
        assert self.supervisor is not None
        measured = self._store.arrays["measured"]
        failed = self.supervisor.check(measured, self._watch, step)
        allowed = self.supervisor.allowed(measured, self._watch, step)
        alarm = np.zeros(len(given))
        result = given.copy()
        for group, (a, b) in enumerate(zip(self._ends[:-1], self._ends[1:])):
            worst = float(failed[a:b].max())
            most = low if worst else max(low, float(allowed[a:b].min()) * high)
            alarm[group] = worst or float(given[group] > most)
            result[group] = min(given[group], most)
        # Heat goes with the demand: with the command, or with its square.
        share = np.repeat(result / high, self.design.groups)
        self.supervisor.heated(share, self._watch, step)
        return result, alarm

    def _shaped(self, values: Array) -> Array | float:
        return float(values[0]) if self.design.is_common else values

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """Memory of law and supervisor, and the values held."""
        state: dict[str, npt.NDArray[np.generic]] = {f"law.{n}": np.array(v) for n, v in self._memory.items()}
        state.update({f"watch.{n}": np.array(v) for n, v in self._watch.items()})
        state.update({f"value.{n}": a.copy() for n, a in self._store.arrays.items()})
        state["start"] = np.array(self._start)
        return state

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]], time: int) -> None:
        """Continue from `checkpoint`."""
        self._start = int(state["start"])
        for prefix, memory in (("law.", self._memory), ("watch.", self._watch)):
            memory.clear()
            memory.update(
                {
                    n.removeprefix(prefix): np.array(v, dtype=np.float64)
                    for n, v in state.items()
                    if n.startswith(prefix)
                }
            )
        for name, array in self._store.arrays.items():
            array[...] = state[f"value.{name}"]

    def terminate(self) -> None:
        """Nothing is held."""


def check_limits(low: float, high: float) -> None:
    """Raise ValueError unless two limits of a command make sense."""
    if not (math.isfinite(low) and math.isfinite(high) and 0.0 <= low < high):
        raise ValueError(f"the limits of the command are {low:g} and {high:g}; give 0 <= lowest < highest")
