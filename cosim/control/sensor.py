"""A sensor as a unit: thermometers and cameras between a quantity and a controller.

The laws are those of `cosim record` (`diagnosis.recording.sensor`), under the same names and in the same order: lag,
gain, bias and drift, noise, clipping, rounding. A test compares the two.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from cosim.unit.protocol import (
    Array,
    ArrayStore,
    Causality,
    Coordinate,
    StepOutcome,
    StepStatus,
    Unit,
    Variable,
    seconds,
)

#: What a sensor remembers.
State = dict[str, npt.NDArray[Any]]


@dataclass(frozen=True)
class Fault:
    """A sensor that fails.

    Args:
        element: Which, counted from 0.
        instant: When [ns].
        reads: What it measures from then on, in the sensor's unit; None: its reading stays what it was.
    """

    element: int
    instant: int
    reads: float | None


@dataclass(frozen=True)
class SensorDesign:
    """What a sensor does with its quantity; numbers in the sensor's unit.

    Args:
        size: Elements; each is read by a sensor of its own.
        unit: Unit of quantity and reading.
        sample: Interval between readings [ns].
        lag: Time constant with which it follows [s].
        exposure: Time over which a reading is averaged, up to its instant [ns].
        delay: Time from the instant of a reading until it is given out [ns].
        gain: Shape (size,).
        bias: Shape (size,).
        drift: Added per second.
        noise: Standard deviation.
        minimum: Smallest reading.
        maximum: Largest reading.
        quantum: Step of the reading; 0: none.
        seed: Of the noise.
        faults: Failures.
        dim: Name of the dimension of the elements.
    """

    size: int
    unit: str
    sample: int
    lag: float = 0.0
    exposure: int = 0
    delay: int = 0
    gain: Array = field(default_factory=lambda: np.ones(1))
    bias: Array = field(default_factory=lambda: np.zeros(1))
    drift: float = 0.0
    noise: float = 0.0
    minimum: float = -math.inf
    maximum: float = math.inf
    quantum: float = 0.0
    seed: int = 0
    faults: Sequence[Fault] = ()
    dim: str = "coil"


class SensorUnit(Unit):
    """Reads its input `quantity` at regular instants; its output `reading` holds from one reading to the next.

    Its input over a step is the quantity at the begin of that step, so the sensor comes before what it watches in the
    order of the algorithm; between two steps the quantity is a straight line.

    Args:
        name: Name of the component.
        design: What it does.
    """

    can_restore = True
    initial_feedthrough = {"reading": frozenset({"quantity"})}

    def __init__(self, name: str, design: SensorDesign) -> None:
        self.name, self.design = name, design
        shape, dims = (design.size,), (design.dim,)
        listed = (
            Variable("quantity", Causality.INPUT, shape, design.unit, dims, "what is measured"),
            Variable("reading", Causality.OUTPUT, shape, design.unit, dims, "what the sensor gives out"),
        )
        self.variables: Mapping[str, Variable] = {v.name: v for v in listed}
        self.coordinates: Mapping[str, Coordinate] = {}
        self._store = ArrayStore(name, self.variables)
        # Readings that are made but not given out yet, newest last.
        self._depth = -(-design.delay // design.sample) + 1
        self._state: State = {}
        self._start = 0

    def set(self, name: str, value: Array) -> None:
        """Copy the quantity; raises UnitError if it is not finite."""
        self._store.set(name, value)

    def get(self, name: str) -> Array:
        """Current value of a variable."""
        return self._store.get(name)

    def initialise(self, time: int) -> None:
        """The first reading is that of the start, settled."""
        self._start, self._state = time, {}
        self.refresh()

    def refresh(self) -> None:
        """Until the first step, the reading follows the quantity."""
        if not self._state:
            self._store.arrays["reading"][...] = self._read(self._store.arrays["quantity"], 0)

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Take the reading that is due at `time`, then give out what has come through the delay."""
        state = self._state or self._begin(time)
        quantity = self._store.arrays["quantity"]
        self._follow(state, quantity, time)
        since, rest = divmod(time - self._start, self.design.sample)
        if rest == 0:
            taken = self._exposed(state)
            state["pending"][:-1] = state["pending"][1:]
            state["pending"][-1] = self._read(taken, since, state, time)
        # The newest reading that is old enough; before the first one has come through, the first one holds.
        behind = max(-(-(self.design.delay - rest) // self.design.sample), 0)
        self._store.arrays["reading"][...] = state["pending"][-1 - min(behind, self._depth - 1)]
        return StepOutcome(StepStatus.OK, time + size)

    def _begin(self, time: int) -> State:
        quantity = self._store.arrays["quantity"]
        first = self._read(quantity, 0)
        self._state = {
            "settled": quantity.copy(),
            "before": quantity.copy(),
            "time": np.array(time),
            "exposed": np.zeros_like(quantity),
            "exposure": np.array(0),
            "pending": np.tile(first, (self._depth, 1)),
            "frozen": np.full(self.design.size, np.nan),
        }
        return self._state

    def _follow(self, state: State, quantity: Array, time: int) -> None:
        """Lag and exposure from the last communication point to this one, exact for a straight line between them."""
        before, begin = np.asarray(state["before"], dtype=np.float64), int(state["time"])
        settled = np.asarray(state["settled"], dtype=np.float64)
        if time > begin:
            step, tau = seconds(time - begin), self.design.lag
            if tau > 0.0:
                # y' = (x - y) / tau with x a straight line: y follows at a distance of slope * tau.
                slope = (quantity - before) / step
                behind = settled - (before - slope * tau)
                now = quantity - slope * tau + behind * math.exp(-step / tau)
            else:
                now = quantity.copy()
            self._expose(state, settled, now, begin, time)
            state["settled"] = now
        state["before"], state["time"] = quantity.copy(), np.array(time)

    def _expose(self, state: State, first: Array, last: Array, begin: int, end: int) -> None:
        """Add what falls into the exposure of the next reading."""
        if not self.design.exposure:
            return
        due = self._start + -(-(end - self._start) // self.design.sample) * self.design.sample
        opened = max(begin, due - self.design.exposure)
        if end > opened:
            middle = (0.5 * (opened + end) - begin) / (end - begin)
            state["exposed"] = state["exposed"] + (end - opened) * (first + middle * (last - first))
            state["exposure"] = state["exposure"] + (end - opened)

    def _exposed(self, state: State) -> Array:
        total = int(state["exposure"])
        if not total:
            return np.asarray(state["settled"], dtype=np.float64)
        mean = np.asarray(state["exposed"], dtype=np.float64) / total
        state["exposed"], state["exposure"] = np.zeros_like(mean), np.array(0)
        return mean

    def _read(
        self,
        values: Array,
        index: int,
        state: State | None = None,
        time: int | None = None,
    ) -> Array:
        """Reading number `index` of what is there; with faults where their state is given."""
        design = self.design
        values = values.copy()
        active = [f for f in design.faults if time is not None and time >= f.instant]
        for fault in active:
            if fault.reads is not None:
                values[fault.element] = fault.reads
        found = design.gain * values + design.bias + design.drift * seconds(index * design.sample)
        if design.noise:
            # A stream of its own for every reading: a run that goes on from a checkpoint draws the same numbers.
            random = np.random.Generator(np.random.Philox(key=design.seed, counter=[0, 0, 0, index]))
            found = found + design.noise * random.standard_normal(design.size)
        found = np.clip(found, design.minimum, design.maximum)
        if design.quantum:
            found = design.quantum * np.round(found / design.quantum)
        for fault in active:
            if fault.reads is None and state is not None:
                frozen = np.asarray(state["frozen"], dtype=np.float64)
                if np.isnan(frozen[fault.element]):
                    frozen[fault.element] = np.asarray(state["pending"][-2 if self._depth > 1 else -1])[fault.element]
                    state["frozen"] = frozen
                found[fault.element] = frozen[fault.element]
        return found

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """Everything that the next readings depend on."""
        state: dict[str, npt.NDArray[np.generic]] = {f"state.{n}": np.array(v) for n, v in self._state.items()}
        state.update({f"value.{n}": a.copy() for n, a in self._store.arrays.items()})
        state["start"] = np.array(self._start)
        return state

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]], time: int) -> None:
        """Continue from `checkpoint`."""
        self._start = int(state["start"])
        self._state = {n.removeprefix("state."): np.array(v) for n, v in state.items() if n.startswith("state.")}
        for name, array in self._store.arrays.items():
            array[...] = state[f"value.{name}"]

    def terminate(self) -> None:
        """Nothing is held."""
