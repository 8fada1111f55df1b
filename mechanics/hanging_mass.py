"""A mass hanging from each coil, always in equilibrium (the paper's water bath, section 2.3)."""

from __future__ import annotations

from collections.abc import Mapping

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
    UnitError,
    Variable,
)


class HangingMassUnit(Unit):
    """Quasi-static load: extension = m g / k, length = rest length + extension, tension = m g.

    Inertia is left out: the bath changes over minutes, the 500 g swing at about 3 Hz.

    Args:
        name: Name of the unit.
        coils: Number of coils, each with its own mass.
        mass: Mass below each coil [kg].
        gravity: Magnitude of gravity [m/s^2].

    Raises:
        ValueError: No coils, or a mass or gravity that is not positive and finite.

    Source: paper, section 2.3.
    """

    can_restore = True

    def __init__(self, name: str, coils: int, mass: float, gravity: float = 9.81) -> None:
        if coils < 1:
            raise ValueError(f"coils is {coils}: at least one coil must carry the mass")
        for what, value, unit in (("mass", mass, "kg"), ("gravity", gravity, "m/s^2")):
            if not (np.isfinite(value) and value > 0):
                raise ValueError(f"{what} is {value} {unit}: give a positive number")
        self.name = name
        self._weight = mass * gravity
        self.coordinates: Mapping[str, Coordinate] = {}
        shape, dims = (coils,), ("coil",)
        self.variables: Mapping[str, Variable] = {
            v.name: v
            for v in (
                Variable("stiffness", Causality.INPUT, shape, "N/m", dims, "spring constant of every coil"),
                Variable("rest_length", Causality.INPUT, shape, "m", dims, "unloaded length of every coil", 0.0),
                Variable("extension", Causality.OUTPUT, shape, "m", dims, "elongation under the mass"),
                Variable("length", Causality.OUTPUT, shape, "m", dims, "length under the mass"),
                Variable("tension", Causality.OUTPUT, shape, "N", dims, "weight carried by every coil"),
            )
        }
        # While it steps it is sampled: its outputs change in `do_step` alone.
        self.initial_feedthrough = {
            "extension": frozenset({"stiffness"}),
            "length": frozenset({"stiffness", "rest_length"}),
            "tension": frozenset(),
        }
        self._start = 0
        self._store = ArrayStore(name, self.variables)

    def set(self, name: str, value: Array) -> None:
        """Copy an input; raises UnitError if it is not finite."""
        self._store.set(name, value)

    def get(self, name: str) -> Array:
        """Current value of a variable."""
        return self._store.get(name)

    def initialise(self, time: int) -> None:
        """Equilibrium at the start."""
        self._start = time
        self._solve(time)

    def refresh(self) -> None:
        """Equilibrium with the inputs set since."""
        self._solve(self._start)

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Equilibrium at the end of the step; raises UnitError where a stiffness is not positive."""
        self._solve(time + size)
        return StepOutcome(StepStatus.OK, time + size)

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """Inputs and outputs; there is no other state."""
        return {name: self._store.get(name).copy() for name in self.variables}

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]], time: int) -> None:
        """Continue from `checkpoint`."""
        for name in self.variables:
            self._store.arrays[name][...] = state[name]

    def terminate(self) -> None:
        """Nothing is held."""

    def _solve(self, time: int) -> None:
        stiffness = self._store.get("stiffness")
        bad = np.flatnonzero(~(stiffness > 0))
        if bad.size:
            raise UnitError(
                self.name,
                f"stiffness of coil {bad[0] + 1} is {stiffness[bad[0]]} N/m, so its mass has no equilibrium",
                time,
                "the stiffness must be positive; check the actuator connected to it",
            )
        extension = self._store.get("extension")
        extension[...] = self._weight / stiffness
        self._store.get("length")[...] = self._store.get("rest_length") + extension
        self._store.get("tension")[...] = self._weight
