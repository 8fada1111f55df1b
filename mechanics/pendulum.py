"""A pendulum as a unit: a rigid arm on a hinge in Bullet, with an encoder."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from cosim.unit.protocol import (
    NANOSECONDS,
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
from mechanics.pendulum_design import PendulumDesign, behind_play

if TYPE_CHECKING:
    from mechanics.bullet_pendulum import PendulumWorld

__all__ = ["PendulumDesign", "PendulumUnit"]

#: A step in which damping takes more than this share of the speed is no longer accurate.
_LARGEST_DAMPING = 0.5


class PendulumUnit(Unit):
    """A single arm that swings about a fixed hinge.

    Args:
        name: Name of the unit.
        design: Arm, hinge, encoder and where it starts.
        micro_step: Bullet's time step [s].

    Raises:
        ValueError: The micro-step is no whole number of nanoseconds, or too long for the damping.
    """

    can_restore = True

    def __init__(self, name: str, design: PendulumDesign, micro_step: float) -> None:
        self.name, self.design = name, design
        self._micro = round(micro_step * NANOSECONDS)
        if self._micro < 1 or abs(self._micro / NANOSECONDS - micro_step) > 1e-15:
            raise ValueError(f"micro_step is {micro_step} s: give a whole number of nanoseconds")
        if design.viscous_damping * micro_step > _LARGEST_DAMPING * design.inertia:
            raise ValueError(
                f"viscous_damping of {design.viscous_damping:g} N m s/rad stops the arm within a micro-step of "
                f"{micro_step:g} s: take a shorter one"
            )
        self.coordinates: Mapping[str, Coordinate] = {}
        given, found = Causality.INPUT, Causality.OUTPUT
        listed = (
            Variable("torque", given, (), "N*m", (), "outer torque about the hinge", 0.0),
            Variable("angle", found, (), "rad", (), "angle that the encoder reads; pi hangs down"),
            Variable("angular_velocity", found, (), "rad/s", (), "angular velocity of the arm"),
            Variable("arm_angle", found, (), "rad", (), "angle of the arm itself"),
            Variable("kinetic_energy", found, (), "J", (), "kinetic energy"),
            Variable("potential_energy", found, (), "J", (), "energy of gravity, 0 where it hangs"),
        )
        self.variables: Mapping[str, Variable] = {v.name: v for v in listed}
        self._store = ArrayStore(name, self.variables)
        from mechanics.bullet_pendulum import PendulumWorld  # late: where pybullet is missing, everything else works

        self._make_world = PendulumWorld
        self._world: PendulumWorld | None = None

    def set(self, name: str, value: Array) -> None:
        """Copy an input; raises UnitError if it is not finite."""
        self._store.set(name, value)

    def get(self, name: str) -> Array:
        """Current value of a variable."""
        return self._store.get(name)

    def initialise(self, time: int) -> None:
        """Hold the arm at its initial angle and speed; the encoder stands in the middle of its play."""
        self._open()
        design = self.design
        self._store.get("angle")[...] = self._store.get("arm_angle")[...] = design.initial_angle
        self._store.get("angular_velocity")[...] = design.initial_angular_velocity
        self._energies()

    def exit_initialisation(self) -> None:
        """Let go, under the torque that has been set."""
        self._live().begin(
            self.design.initial_angle, self.design.initial_angular_velocity, float(self._store.get("torque"))
        )

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Swing on.

        Raises:
            UnitError: The step is no whole number of micro-steps, or Bullet lost the arm.
        """
        steps, rest = divmod(size, self._micro)
        if rest:
            raise UnitError(
                self.name, f"a step of {size} ns is no whole number of micro-steps of {self._micro} ns", time
            )
        world = self._live()
        world.advance(steps, float(self._store.get("torque")))
        angle = world.state()[0]
        if not (math.isfinite(angle) and math.isfinite(world.angular_velocity())):
            raise UnitError(
                self.name, "the arm is lost: its angle is no finite number", time + size, "take a shorter micro_step"
            )
        self._store.get("arm_angle")[...] = angle
        self._store.get("angular_velocity")[...] = world.angular_velocity()
        self._read()
        self._energies()
        return StepOutcome(StepStatus.OK, time + size)

    def _read(self) -> None:
        encoder = self._store.get("angle")
        encoder[...] = behind_play(float(encoder), float(self._store.get("arm_angle")), self.design.backlash)

    def _energies(self) -> None:
        speed, angle = float(self._store.get("angular_velocity")), float(self._store.get("arm_angle"))
        self._store.get("kinetic_energy")[...] = self.design.kinetic_energy(speed)
        self._store.get("potential_energy")[...] = self.design.potential_energy(angle)

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """State of the arm, inputs and outputs; Bullet keeps nothing else of a single hinge."""
        content: dict[str, npt.NDArray[np.generic]] = {n: self._store.get(n).copy() for n in self.variables}
        content["state"] = np.array(self._live().state())
        return content

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]], time: int) -> None:
        """Continue from `checkpoint`."""
        if self._world is None:
            self._open()
        for name in self.variables:
            self._store.arrays[name][...] = state[name]
        angle, speed, acceleration, since = (float(v) for v in state["state"])
        self._live().put(angle, speed, acceleration, since)

    def terminate(self) -> None:
        """Free Bullet's world; safe to call twice."""
        if self._world is not None:
            self._world.close()
            self._world = None

    def _open(self) -> None:
        self.terminate()
        self._world = self._make_world(self.design, self._micro / NANOSECONDS)

    def _live(self) -> PendulumWorld:
        assert self._world is not None, "initialise comes first"
        return self._world
