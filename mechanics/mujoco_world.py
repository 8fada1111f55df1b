"""The only place where MuJoCo is called: the same links as in `mechanics.bullet`, with springs as joint springs.

MuJoCo works in SI. Its contacts are soft and solved to convergence by Newton's method, where Bullet's are hard and
iterated; docs/decisions/0015-mujoco-and-speed-of-bullet.md says what is set and why.
"""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import numpy as np

from cosim.unit.protocol import Array
from mechanics.fabric import FabricDesign, Layout
from mechanics.half import Half, half
from mechanics.motion import SCALE, Motion, rotation, woven
from mechanics.solver import SolverSettings
from mechanics.world import Contacts, Divergence

#: Time constant of a contact and of a stop [s]; MuJoCo wants at least two micro-steps.
TIME_CONSTANT = 1e-3
#: Share of a constraint that contacts and stops hold: 1 would be rigid; at MuJoCo's own 0.9 hot stops give by 0.3 mm.
IMPEDANCE = 0.99
#: Ratio of frictional to normal impedance. Friction is regularised, and what is at rest creeps: the sag of a drape by
#: 1.6 % in 5 s at 10 (docs/engines.md).
FRICTION_RATIO = 1000.0
#: Of Newton's method, scaled as MuJoCo does. Each step starts from the forces of the one before: from converged forces
#: it takes 3 iterations, from those of MuJoCo's own 1e-8 it takes 20 (docs/engines.md).
TOLERANCE = 1e-15
#: Lengths by which a slide may pass its stops and still be where both its springs are linear [m].
_BEYOND = 1e-3


class MujocoMissing(ImportError):
    """The package `mujoco` is not installed."""


def load_mujoco() -> ModuleType:
    """The package `mujoco`; raises MujocoMissing where it is not installed."""
    try:
        engine = importlib.import_module("mujoco")
    except ImportError as error:
        raise MujocoMissing("the engine MuJoCo is not installed") from error
    # It prints a warning and writes MUJOCO_LOG.TXT into the working folder; here warnings are read and raised instead.
    engine.set_mju_user_warning(_ignore)
    return engine


def _ignore(text: str) -> None:
    del text


class MujocoWorld:
    """See `mechanics.world.World`.

    A link is a body on a free joint (its back half) with a child on a slide (its front half). Bars are capsules whose
    round ends lie inside the arms, so that a neighbour touches what it would touch of Bullet's cylinders; arms are
    boxes. Where both coils and the steel springs of a link act all the way between its stops, they are one linear
    spring of the joint, and micro-steps run without Python; other links get their force anew in every micro-step.

    Args:
        design: Fabric.
        layout: Which links are held.
        solver: Numerical settings.
        motion: Where the links start.

    Raises:
        MujocoMissing: The package is not installed.
        ValueError: The design needs what this engine does not have.
    """

    engine = "MuJoCo"

    def __init__(self, design: FabricDesign, layout: Layout, solver: SolverSettings, motion: Motion) -> None:
        check_design(design, solver)
        self._mujoco = load_mujoco()
        self.design, self.layout, self.solver = design, layout, solver
        self._half = half(design)
        self._motion = motion.copy()
        self._steel = design.steel_stiffness * design.added.steel_kept(design.links)
        self._friction = design.added.slide_frictions(design.links)
        self._free, self._slides = np.flatnonzero(~layout.is_fixed), np.flatnonzero(~layout.is_locked)
        self._model = self._mujoco.MjModel.from_xml_string(self._description())
        self._data = self._mujoco.MjData(self._model)
        self._find()
        self._place()

    def close(self) -> None:
        """Free the world; safe to call twice."""
        self._data = self._model = None

    def advance(self, steps: int, stiffness: Array, rest_length: Array) -> None:
        """See `mechanics.world.World`."""
        pulls_from = self.design.added.rest_length(stiffness, rest_length)
        stiffness = self.design.added.coil_stiffness(stiffness)
        nonlinear = self._set_springs(stiffness, pulls_from)
        if nonlinear.any() or self._ends.size:
            for _ in range(steps):
                self._push(nonlinear, stiffness, pulls_from)
                self._pull_wires()
                self._mujoco.mj_step(self._model, self._data)
        else:
            self._mujoco.mj_step(self._model, self._data, steps)
        self._check()

    def motion(self) -> Motion:
        """See `mechanics.world.World`."""
        m, free = self._motion, self._free
        position, velocity = self._data.qpos, self._data.qvel
        m.position[free] = SCALE * position[self._free_position[:, :3]]
        m.orientation[free] = position[self._free_position[:, [4, 5, 6, 3]]]
        m.velocity[free] = SCALE * velocity[self._free_velocity[:, :3]]
        # Angular velocity of a free joint is in the frame of its body.
        own = velocity[self._free_velocity[:, 3:]]
        m.angular_velocity[free] = np.einsum("lij,lj->li", rotation(m.orientation[free]), own)
        m.slide[self._slides] = SCALE * position[self._slide_position]
        m.slide_rate[self._slides] = SCALE * velocity[self._slide_velocity]
        return m

    def contacts(self) -> Contacts:
        """See `mechanics.world.World`."""
        count = int(self._data.ncon)
        if not count:
            return Contacts(0, 0.0, (0, 0))
        found = self._data.contact
        deepest = int(np.argmin(found.dist))
        one, other = self._link_of_geom[found.geom[deepest]]
        return Contacts(count, max(0.0, -float(found.dist[deepest])), (int(one), int(other)))

    def save(self) -> Array:
        """All that decides how the world goes on, in MuJoCo's order."""
        kind = self._mujoco.mjtState.mjSTATE_INTEGRATION
        state = np.empty(self._mujoco.mj_stateSize(self._model, kind))
        self._mujoco.mj_getState(self._model, self._data, state, kind)
        return state

    def restore(self, state: Array) -> None:
        """Back to what `save` gave."""
        self._mujoco.mj_setState(self._model, self._data, state, self._mujoco.mjtState.mjSTATE_INTEGRATION)

    def _set_springs(self, stiffness: Array, pulls_from: Array) -> Array:
        """Springs that are linear between the stops as springs of their joints; which slides have others."""
        design, links = self.design, self._slides
        shortest, longest = design.length_hot - _BEYOND, design.length_cold + _BEYOND
        coils, rest = stiffness.reshape(-1, 2)[links], pulls_from.reshape(-1, 2)[links]
        is_slack = (rest >= longest) | (coils == 0.0)
        is_linear = (is_slack | (rest <= shortest)).all(axis=1)
        steel_rest = design.steel_rest_length
        is_linear &= steel_rest >= longest or steel_rest <= shortest
        pushing = 2 * self._steel[links] * (steel_rest >= longest)
        acting = np.where(is_slack, 0.0, coils)
        total = acting.sum(axis=1) + pushing
        # Where the forces of all springs balance, as a displacement of the slide.
        moment = (acting * rest).sum(axis=1) + pushing * steel_rest
        balance = np.divide(moment, total, out=np.zeros_like(total), where=total > 0.0) - design.length_cold
        self._model.jnt_stiffness[self._slide_joint] = np.where(is_linear, total, 0.0)
        self._model.qpos_spring[self._slide_position] = balance
        self._data.qfrc_applied[self._slide_velocity] = 0.0
        return np.asarray(~is_linear)

    def _push(self, chosen: Array, stiffness: Array, pulls_from: Array) -> None:
        """Springs of the chosen slides as forces: two steel coils push, two NiTi coils pull."""
        links = self._slides[chosen]
        length = self.design.length_cold + self._data.qpos[self._slide_position[chosen]]
        pull = stiffness.reshape(-1, 2)[links] * np.maximum(length[:, None] - pulls_from.reshape(-1, 2)[links], 0.0)
        push = 2 * self._steel[links] * np.maximum(self.design.steel_rest_length - length, 0.0)
        self._data.qfrc_applied[self._slide_velocity[chosen]] = push - pull.sum(axis=1)

    def _check(self) -> None:
        """Raise what MuJoCo only counts: it would set a world that diverged back to its start without a word."""
        # All at once: this is asked after every macro-step.
        for kind in np.flatnonzero(self._data.warning.number):
            name = self._mujoco.mjtWarning(int(kind)).name.removeprefix("mjWARN_")
            raise Divergence(f"MuJoCo warns of {_MEANING.get(name, name)}")

    def _find(self) -> None:
        """Addresses of joints and bodies."""
        model = self._model
        joint = {model.joint(i).name: i for i in range(model.njnt)}
        free = np.array([joint[f"free{i}"] for i in self._free], dtype=np.int64)
        self._slide_joint = np.array([joint[f"slide{i}"] for i in self._slides], dtype=np.int64)
        self._free_position = model.jnt_qposadr[free][:, None] + np.arange(7)
        self._free_velocity = model.jnt_dofadr[free][:, None] + np.arange(6)
        self._slide_position = model.jnt_qposadr[self._slide_joint]
        self._slide_velocity = model.jnt_dofadr[self._slide_joint]
        names = [model.body(b).name for b in model.geom_bodyid]
        link_of = {f"{part}{i}": i for i in range(self.design.links) for part in ("back", "front")}
        self._link_of_geom = np.array([link_of[name] for name in names])

    def _place(self) -> None:
        """The state of the links, and what acts on them all the time."""
        m, free, data = self._motion, self._free, self._data
        data.qpos[self._free_position[:, :3]] = m.position[free] / SCALE
        data.qpos[self._free_position[:, [4, 5, 6, 3]]] = m.orientation[free]
        data.qvel[self._free_velocity[:, :3]] = m.velocity[free] / SCALE
        axes = rotation(m.orientation[free])
        data.qvel[self._free_velocity[:, 3:]] = np.einsum("lji,lj->li", axes, m.angular_velocity[free])
        data.qpos[self._slide_position] = m.slide[self._slides] / SCALE
        data.qvel[self._slide_velocity] = m.slide_rate[self._slides] / SCALE
        self._load()

    def _load(self) -> None:
        """The weight of a payload, shared by the free links of the last row, and what wires are made of."""
        design, added = self.design, self.design.added
        last = [int(i) for i in self._free if self.layout.row[i] == design.rows - 1]
        for link in last if added.payload else ():
            self._data.xfrc_applied[self._body(link), :3] = added.payload * np.array(design.gravity) / len(last)
        place = self.layout.link_in_row
        ends = [int(i) for i in self._free if place[i] == design.links_per_row - 1] if added.wire_stiffness else []
        #: Links that hang on wires: their bodies, where these were woven, and what acts on them besides.
        self._ends = np.array([self._body(i) for i in ends], dtype=np.int64)
        self._seats = woven(design, self.layout).position[ends] / SCALE
        self._end_position = self._free_position[np.isin(self._free, ends), :3]
        self._besides = self._data.xfrc_applied[self._ends, :3].copy()

    def _body(self, link: int) -> int:
        return int(self._model.body(f"back{link}").id)

    def _pull_wires(self) -> None:
        """Springs from the last link of every row to where it was woven."""
        if self._ends.size:
            # Not xpos: after a step that is still the place before it.
            pull = self.design.added.wire_stiffness * (self._seats - self._data.qpos[self._end_position])
            self._data.xfrc_applied[self._ends, :3] = self._besides + pull

    def _description(self) -> str:
        """The model as MJCF."""
        design, solver = self.design, self.solver
        time_constant = max(TIME_CONSTANT, 2 * solver.micro_step)
        solref, solimp = f"{time_constant!r} 1", f"{IMPEDANCE} {IMPEDANCE} 0.001"
        added = design.added
        root = ElementTree.Element("mujoco")
        # Sizes of arrays are taken from the arena, which holds contacts of any number that fits into it.
        ElementTree.SubElement(root, "size", memory="1G" if design.links > 200 else "200M")
        ElementTree.SubElement(root, "compiler", angle="radian", autolimits="true", balanceinertia="false")
        option = ElementTree.SubElement(
            root,
            "option",
            timestep=repr(solver.micro_step),
            gravity=_text(design.gravity),
            cone="elliptic",
            impratio=repr(FRICTION_RATIO),
            integrator="implicitfast",
            solver="Newton",
            iterations=str(solver.iterations),
            tolerance=repr(TOLERANCE),
        )
        # Without the first a world that diverged begins anew at its start, as if nothing had happened. All links of a
        # fabric touch: looking for islands among them finds one, and costs a third of the time.
        ElementTree.SubElement(option, "flag", autoreset="disable", island="disable")
        default = ElementTree.SubElement(root, "default")
        ElementTree.SubElement(
            default,
            "geom",
            friction=f"{design.pair_friction!r} 0 {added.hinge_friction!r}",
            solref=solref,
            solimp=solimp,
            condim="6" if added.hinge_friction else "3",
        )
        # Dry friction of a slide is to hold it, not to let it creep: as rigid as MuJoCo takes it.
        ElementTree.SubElement(
            default,
            "joint",
            solreflimit=solref,
            solimplimit=solimp,
            solreffriction=solref,
            solimpfriction="0.9999 0.9999 0.001",
            damping="0",
        )
        world = ElementTree.SubElement(root, "worldbody")
        exclusions = ElementTree.SubElement(root, "contact")
        for link in range(design.links):
            self._link(world, link, self._half)
            ElementTree.SubElement(exclusions, "exclude", body1=f"back{link}", body2=f"front{link}")
        return ElementTree.tostring(root, encoding="unicode")

    def _link(self, world: ElementTree.Element, link: int, part: Half) -> None:
        is_fixed, is_locked = bool(self.layout.is_fixed[link]), bool(self.layout.is_locked[link])
        m, design = self._motion, self.design
        x, y, z, w = m.orientation[link]
        back = ElementTree.SubElement(
            world, "body", name=f"back{link}", pos=_text(m.position[link] / SCALE), quat=_text((w, x, y, z))
        )
        if not is_fixed:
            ElementTree.SubElement(back, "freejoint", name=f"free{link}")
        self._solid(back, part, 1.0)
        # The front half sits where the slide puts it at full length; a locked one is welded where it is held.
        apart = design.bar_distance_cold - 2 * part.centre + (m.slide[link] / SCALE if is_locked else 0.0)
        front = ElementTree.SubElement(back, "body", name=f"front{link}", pos=_text((0.0, apart, 0.0)))
        if not is_locked:
            shortest = design.bar_distance_hot - design.bar_distance_cold
            ElementTree.SubElement(
                front,
                "joint",
                name=f"slide{link}",
                type="slide",
                axis="0 1 0",
                range=_text((shortest, 0.0)),
                damping=repr(design.added.slide_damping),
                frictionloss=repr(float(self._friction[link])),
            )
        self._solid(front, part, -1.0)

    def _solid(self, body: ElementTree.Element, part: Half, sign: float) -> None:
        """Mass and shape of a half about its centre of mass."""
        ElementTree.SubElement(body, "inertial", pos="0 0 0", mass=repr(part.mass), diaginertia=_text(part.inertia))
        bar_y, arm_y = -sign * part.centre, sign * (part.arm_size[1] / 2 - part.centre)
        ElementTree.SubElement(
            body,
            "geom",
            type="capsule",
            size=repr(part.bar_radius),
            fromto=_text((-part.arm_x, bar_y, 0.0, part.arm_x, bar_y, 0.0)),
        )
        for side in (-part.arm_x, part.arm_x):
            ElementTree.SubElement(
                body, "geom", type="box", size=_text([s / 2 for s in part.arm_size]), pos=_text((side, arm_y, 0.0))
            )


def check_design(design: FabricDesign, solver: SolverSettings) -> None:
    """Raise ValueError where a fabric needs what MuJoCo does not have."""
    if design.restitution:
        raise ValueError(
            f"restitution is {design.restitution}: contacts of the engine mujoco have none; set it to 0 or use "
            "`engine: bullet`"
        )
    if solver.springs != "force":
        raise ValueError(
            "solver.springs is `motor`: with the engine mujoco springs are springs of their joints; leave the key out"
        )
    if solver.friction_model != "cone":
        raise ValueError("solver.friction_model is `pyramid`: the engine mujoco has the cone alone; leave the key out")


#: What each warning of MuJoCo means.
_MEANING = {
    "INERTIA": "a mass matrix that cannot be inverted",
    "CONTACTFULL": "more contacts than fit into its memory",
    "CNSTRFULL": "more constraints than fit into its memory",
    "BADQPOS": "a position that is not finite or too large",
    "BADQVEL": "a velocity that is not finite or too large",
    "BADQACC": "an acceleration that is not finite or too large",
}


def _text(values: Any) -> str:
    return " ".join(repr(float(v)) for v in values)


__all__ = ["MujocoMissing", "MujocoWorld", "check_design", "load_mujoco"]
