"""The fabric as a unit: spring constants in, poses and measures out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

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
    seconds,
)
from mechanics.curvature import max_curvature
from mechanics.fabric import FabricDesign, layout
from mechanics.half import half
from mechanics.linking import is_hooked
from mechanics.motion import SCALE, Motion, rotation, woven
from mechanics.mujoco_world import MujocoWorld, check_design, load_mujoco
from mechanics.solver import SolverSettings
from mechanics.springs import SteelSpring, coil_tension, spring_energy
from mechanics.world import Divergence, World


def fabric_variables(design: FabricDesign) -> dict[str, Variable]:
    """Inputs and outputs of a fabric, by name; see docs/architecture.md for the numbering of coils and links."""
    links, rows = (design.links,), design.rows
    coils, coil, link = (2 * design.links,), ("coil",), ("link",)
    given, found = Causality.INPUT, Causality.OUTPUT
    listed = (
        Variable("stiffness", given, coils, "N/m", coil, "spring constant of every NiTi coil"),
        Variable("rest_length", given, coils, "m", coil, "unloaded length of every NiTi coil between its pins"),
        Variable("extension", found, coils, "m", coil, "length less rest length of every NiTi coil"),
        Variable("tension", found, coils, "N", coil, "pull of every NiTi coil"),
        Variable("link_length", found, links, "m", link, "link length l"),
        Variable("position", found, (*links, 3), "m", ("link", "axis"), "middle of every link"),
        Variable("orientation", found, (*links, 4), "1", ("link", "quaternion"), "orientation of every link"),
        Variable(
            "marker_position",
            found,
            (2 * rows, 3),
            "m",
            ("marker", "axis"),
            "back and front bar of the last link of every row, at its outer side (+x)",
        ),
        Variable("row_centre", found, (rows, 3), "m", ("row", "axis"), "middle of the two markers of every row"),
        Variable("max_curvature", found, (), "1/m", (), "equation (1) along the row centres"),
        Variable("fabric_length", found, (), "m", (), "between the back bars of the first and the last A links"),
        Variable("kinetic_energy", found, (), "J", (), "kinetic energy of all links"),
        Variable("potential_energy", found, (), "J", (), "energy of gravity and of all springs"),
        Variable("max_penetration", found, (), "m", (), "deepest overlap of two links at the end of the step"),
        Variable("contact_count", found, (), "1", (), "contact points between links"),
    )
    return {v.name: v for v in listed}


def fabric_coordinates(design: FabricDesign) -> dict[str, Coordinate]:
    """Row, place and orientation of links and coils; names of axes, quaternion parts and markers."""
    plan = layout(design)
    coil_link = np.repeat(np.arange(design.links), 2)
    return {
        "axis": Coordinate("axis", np.array(["x", "y", "z"]), "x across the fabric, y away from the tether, z up"),
        "quaternion": Coordinate("quaternion", np.array(["x", "y", "z", "w"]), "part of the quaternion"),
        "row": Coordinate("row", np.arange(1, design.rows + 1), "row, counted from the tether"),
        "link_row": Coordinate("link", plan.row + 1, "row of the link"),
        "link_place": Coordinate("link", plan.link_in_row + 1, "place of the link in its row, along x"),
        "link_kind": Coordinate("link", np.where(plan.is_b, "B", "A"), "orientation class of the link"),
        "coil_link": Coordinate("coil", coil_link + 1, "link that holds the coil"),
        "coil_arm": Coordinate("coil", np.arange(2 * design.links) % 2 + 1, "1: arm at -x, 2: arm at +x"),
        "marker_row": Coordinate("marker", np.repeat(np.arange(1, design.rows + 1), 2), "row of the marker"),
    }


def _engine(design: FabricDesign, solver: SolverSettings) -> Callable[..., World]:
    """What makes the worlds of a fabric; an engine that is not asked for need not be installed."""
    if solver.engine == "mujoco":
        check_design(design, solver)
        load_mujoco()
        return MujocoWorld
    from mechanics.bullet import World as BulletWorld  # late: it loads pybullet

    return BulletWorld


class FabricUnit(Unit):
    """A fabric of interlocked links, in the engine that the settings name.

    Args:
        name: Name of the unit.
        design: Fabric.
        solver: Numerical settings.

    Raises:
        ValueError: The micro-step is no whole number of nanoseconds, or the engine lacks what the design needs.
        MujocoMissing: The engine is MuJoCo, and its package is not installed.
    """

    def __init__(self, name: str, design: FabricDesign, solver: SolverSettings) -> None:
        self.name, self.design, self.solver = name, design, solver
        self._micro = round(solver.micro_step * NANOSECONDS)
        if self._micro < 1 or abs(self._micro / NANOSECONDS - solver.micro_step) > 1e-15:
            raise ValueError(f"micro_step is {solver.micro_step} s: give a whole number of nanoseconds")
        self.variables: Mapping[str, Variable] = fabric_variables(design)
        self.coordinates: Mapping[str, Coordinate] = fabric_coordinates(design)
        self._store = ArrayStore(name, self.variables)
        self._layout = layout(design)
        self._check_links()
        #: Share of their stiffness that the steel springs have, shape (coil,): 1 but for links with effects.
        self._steel_kept = np.repeat(design.added.steel_kept(design.links), 2)
        self._half = half(design)
        self._steel = SteelSpring(design.steel_stiffness, design.steel_rest_length)
        self._make_world = _engine(design, solver)
        self._world: World | None = None
        #: MuJoCo's states are exact; Bullet's are not (docs/decisions/0004-bullet-settings.md).
        self.can_restore = solver.engine == "mujoco"

    def set(self, name: str, value: Array) -> None:
        """Copy an input; raises UnitError if it is not finite."""
        self._store.set(name, value)

    def get(self, name: str) -> Array:
        """Current value of a variable."""
        return self._store.get(name)

    def initialise(self, time: int) -> None:
        """Weave the fabric flat, at rest.

        Raises:
            UnitError: An input makes no sense (a stiffness below zero).
        """
        self._check_inputs(time)
        self._seat(woven(self.design, self._layout))
        self._measure(time)

    def _seat(self, motion: Motion) -> None:
        self.terminate()
        self._world = self._make_world(self.design, self._layout, self.solver, motion)

    def _check_links(self) -> None:
        for link, _ in self.design.added.links:
            if not self._layout.is_locked[link]:
                continue
            first = int(np.flatnonzero(~self._layout.is_locked)[0])
            raise ValueError(
                f"link {link + 1} is held, and what is given of its slide does nothing: the first link that slides is "
                f"link {first + 1}"
            )

    def _check_inputs(self, time: int) -> None:
        for name in ("stiffness", "rest_length"):
            value = self._store.get(name)
            bad = np.flatnonzero(~(value >= 0))
            if bad.size:
                raise UnitError(
                    self.name,
                    f"{name} of coil {bad[0] + 1} is {value[bad[0]]} {self.variables[name].unit}",
                    time,
                    "it must be zero or positive; check the actuator connected to it",
                )

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Micro-steps with constant spring constants.

        Raises:
            UnitError: The engine diverged, a pose that is not finite, links overlap beyond the limit, a link torn free,
                or a macro-step that the micro-step does not divide.
        """
        assert self._world is not None, "initialise first"
        steps, rest = divmod(size, self._micro)
        if rest:
            raise UnitError(
                self.name,
                f"the macro-step {seconds(size)} s is no multiple of the micro-step {seconds(self._micro)} s",
                time,
                "change solver.micro_step or time.macro_step",
            )
        self._check_inputs(time)
        try:
            self._world.advance(steps, self._store.get("stiffness"), self._store.get("rest_length"))
        except Divergence as error:
            raise UnitError(self.name, str(error), time + size, "take a smaller solver.micro_step") from error
        self._measure(time + size)
        return StepOutcome(StepStatus.OK, time + size)

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """State of all links; the engine's world is rebuilt from it here, as `resume` will."""
        assert self._world is not None, "initialise first"
        motion = self._world.motion().copy()
        self._seat(motion)
        state: dict[str, npt.NDArray[np.generic]] = {f"motion.{n}": a for n, a in vars(motion).items()}
        state.update({f"value.{n}": self._store.get(n).copy() for n in self.variables})
        return state

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]], time: int) -> None:
        """Continue from `checkpoint`."""
        prefix = "motion."
        given = {n.removeprefix(prefix): a for n, a in state.items() if n.startswith(prefix)}
        self._seat(Motion(**{n: np.array(a, dtype=np.float64) for n, a in given.items()}))
        for name in self.variables:
            self._store.arrays[name][...] = state[f"value.{name}"]

    def save(self) -> Any:
        """State of MuJoCo's world and all values; Bullet cannot return to a state.

        Raises:
            UnitError: The engine is Bullet.
        """
        if not isinstance(self._world, MujocoWorld):
            raise UnitError(self.name, "Bullet cannot return to a saved state", None, "use `engine: mujoco`")
        return self._world.save(), {name: self._store.get(name).copy() for name in self.variables}

    def restore(self, saved: Any, time: int) -> None:
        """Return to what `save` gave."""
        assert isinstance(self._world, MujocoWorld), "nothing was saved"
        state, values = saved
        self._world.restore(state)
        for name in self.variables:
            self._store.arrays[name][...] = values[name]

    def terminate(self) -> None:
        """Free the engine's world."""
        if self._world is not None:
            self._world.close()
            self._world = None

    def _measure(self, time: int) -> None:
        """Fill the outputs and check them; docs/architecture.md says what each one is."""
        assert self._world is not None
        design, put = self.design, self._store.arrays
        motion = self._world.motion()
        self._check_finite(motion, time)
        axes = rotation(motion.orientation)
        bar_distance = design.bar_distance_cold + motion.slide / SCALE
        along = axes[:, :, 1]
        back = motion.position / SCALE - self._half.centre * along
        front = back + bar_distance[:, None] * along
        self._check_hooks(back, axes, bar_distance, time)
        self._check_contacts(time)
        put["link_length"][...] = bar_distance - design.length_offset
        length = np.repeat(put["link_length"], 2)
        put["extension"][...] = length - put["rest_length"]
        slack = length - self.design.added.rest_length(put["stiffness"], put["rest_length"])
        put["tension"][...] = coil_tension(self.design.added.coil_stiffness(put["stiffness"]), slack)
        put["position"][...] = (back + front) / 2
        put["orientation"][...] = motion.orientation
        self._measure_shape(back, front, axes)
        self._measure_energy(motion, axes, length, slack)

    def _measure_shape(self, back: Array, front: Array, axes: Array) -> None:
        put, per_row, rows = self._store.arrays, self.design.links_per_row, self.design.rows
        last = np.arange(rows) * per_row + per_row - 1
        side = self.design.outer_width / 2 * axes[last, :, 0]
        put["marker_position"][0::2] = back[last] + side
        put["marker_position"][1::2] = front[last] + side
        put["row_centre"][...] = (put["marker_position"][0::2] + put["marker_position"][1::2]) / 2
        put["max_curvature"][...] = max_curvature(put["row_centre"][:, 1:])
        a_links = back.reshape(rows, per_row, 3)[:, 0::2]
        put["fabric_length"][...] = np.linalg.norm(a_links[-1] - a_links[0], axis=1).mean()

    def _measure_energy(self, motion: Motion, axes: Array, length: Array, slack: Array) -> None:
        put, part = self._store.arrays, self._half
        along = axes[:, :, 1]
        velocity = motion.velocity / SCALE
        gap = self.design.bar_distance_cold + motion.slide / SCALE - 2 * part.centre
        moving = np.where(self._layout.is_fixed, 0.0, part.mass), np.where(self._layout.is_locked, 0.0, part.mass)
        front_velocity = (
            velocity
            + np.cross(motion.angular_velocity, gap[:, None] * along)
            + motion.slide_rate[:, None] / SCALE * along
        )
        spin = np.einsum("lij,li->lj", axes, motion.angular_velocity)
        rotational = 0.5 * (spin**2) @ np.array(part.inertia)
        put["kinetic_energy"][...] = (
            0.5 * moving[0] @ (velocity**2).sum(axis=1)
            + 0.5 * moving[1] @ (front_velocity**2).sum(axis=1)
            + rotational @ ((moving[0] > 0).astype(float) + (moving[1] > 0))
        )
        gravity = np.array(self.design.gravity)
        back_centre = motion.position / SCALE
        front_centre = back_centre + gap[:, None] * along
        put["potential_energy"][...] = (
            -moving[0] @ (back_centre @ gravity)
            - moving[1] @ (front_centre @ gravity)
            + spring_energy(
                self.design.added.coil_stiffness(put["stiffness"]), slack, length, self._steel, self._steel_kept
            )
        )

    def _check_finite(self, motion: Motion, time: int) -> None:
        for what, value in vars(motion).items():
            bad = np.flatnonzero(~np.isfinite(value.reshape(len(value), -1)).all(axis=1))
            if bad.size:
                raise UnitError(
                    self.name,
                    f"{what} of {self._describe(int(bad[0]))} is not finite",
                    time,
                    f"{'MuJoCo' if self.can_restore else 'Bullet'} diverged: take a smaller solver.micro_step",
                )

    def _check_hooks(self, back: Array, axes: Array, bar_distance: Array, time: int) -> None:
        pairs = self._layout.hooked
        torn = np.flatnonzero(~is_hooked(back, axes, bar_distance, self._half.arm_x, pairs))
        if torn.size:
            one, other = (self._describe(int(i)) for i in pairs[torn[0]])
            raise UnitError(
                self.name,
                f"{one} is torn free of {other} ({torn.size} of {len(pairs)} hooks open)",
                time,
                "take a smaller solver.micro_step or more solver.iterations",
            )

    def _check_contacts(self, time: int) -> None:
        assert self._world is not None
        contacts = self._world.contacts()
        self._store.arrays["contact_count"][...] = contacts.count
        self._store.arrays["max_penetration"][...] = contacts.penetration
        if contacts.penetration > self.solver.penetration_limit:
            one, other = map(self._describe, contacts.links)
            raise UnitError(
                self.name,
                f"{one} and {other} overlap by {1e3 * contacts.penetration:.3g} mm, more than the "
                f"{1e3 * self.solver.penetration_limit:.3g} mm of solver.penetration_limit",
                time,
                "take a smaller solver.micro_step or more solver.iterations",
            )

    def _describe(self, link: int) -> str:
        return f"link {link + 1} (row {self._layout.row[link] + 1}, place {self._layout.link_in_row[link] + 1})"
