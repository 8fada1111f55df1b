"""The truth: a fabric in Bullet, in steps of a quarter of a millisecond, with what the scenario leaves out."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from evaluation.proving.fabric.weave import Link, Measures, weave
from evaluation.proving.rig import GRAVITY, Array

#: Micro-step [s], iterations of the contact solver in it, and times in which contacts and stops correct errors [s].
STEP, ITERATIONS, CORRECTION, STOP_CORRECTION = 2.5e-4, 200, 2.5e-3, 25e-3
#: Mass of the lighter piece of a link [kg], by which a damped slide is stable, and a place where no marker is [m].
LIGHT, FARTHEST = 2e-3, 2.0
#: Length units of Bullet in a metre.
_CM = 100.0
#: Extent of the fabric of a draw.
ROWS, COLUMNS, HELD = 4, 2, 2


@dataclass(frozen=True)
class Specimen:
    """A fabric as it was really made.

    Args:
        measures: Of its links.
        mass: Of a link [kg].
        friction: Coefficient of two links in contact.
        steel: Spring constant of the compression springs [N/m].
        steel_rest: Their unloaded length [m].
        coil: Spring constant of the cold coils [N/m].
        heating: Times [s] and factors of the spring constant of the coils, straight between them; empty: 1.
        rows: Of the fabric.
        coil_rest: Their unloaded length [m].
        offset: Distance of the bars less the length of the springs [m].
        effects: What acts besides, by name, in SI.
        at_link: Number of the link that a local effect sits in.
        at_row: Number of the row that it sits in, where it is all links of a row.
    """

    measures: Measures = field(default_factory=Measures)
    mass: float = 7.3e-3
    friction: float = 0.5329
    steel: float = 150.0
    steel_rest: float = 58.5e-3
    coil: float = 157.1
    heating: tuple[tuple[float, float], ...] = ()
    rows: int = ROWS
    coil_rest: float = 9.4e-3
    offset: float = 0.85e-3
    effects: Mapping[str, float] = field(default_factory=dict)
    at_link: int = -1
    at_row: int = -1

    def of(self, name: str) -> float:
        """Strength of an effect; 0 where it does not act."""
        return self.effects.get(name, 0.0)

    def coil_at(self, time: float, is_local: bool) -> float:
        """Spring constant of a coil [N/m].

        Args:
            time: Since the start [s].
            is_local: Whether it sits in the link, or the row, of a local effect.
        """
        factor = 1.0
        if self.heating:
            times, factors = zip(*self.heating)
            factor = float(np.interp(time, times, factors))
        if is_local:
            factor = 1.0 + (1.0 - self.of("unheated_coil")) * (factor - 1.0)
            factor *= 1.0 - self.of("weak_coil")
        return self.coil * factor


def drape(specimen: Specimen, stop: float, interval: float, rng: np.random.Generator) -> Array:
    """Places of the markers while the fabric falls from flat.

    Args:
        specimen: The fabric.
        stop: Duration [s].
        interval: Between two pictures [s].
        rng: Of the start, whose links are never quite at rest.

    Returns:
        [m], shape (pictures, markers, 3): back and front bar of the last link of every row, at its outer side.
    """
    pybullet = _quiet_pybullet()
    client = pybullet.connect(pybullet.DIRECT)
    try:
        return _Bench(pybullet, client, specimen, rng).watched(stop, interval)
    finally:
        pybullet.disconnect(client)


class _Bench:
    """Links in a world."""

    def __init__(self, engine: Any, client: int, specimen: Specimen, rng: np.random.Generator) -> None:
        self._engine, self._client, self._specimen = engine, client, specimen
        self._time = 0.0
        # Bullet damps a slide by the speed at the begin of a step: beyond a mass per damping that runs away.
        self._step = STEP / max(1, math.ceil(specimen.of("viscous_damping") * STEP / LIGHT))
        self._links = weave(specimen.measures, specimen.rows, COLUMNS, HELD)
        engine.setPhysicsEngineParameter(
            fixedTimeStep=self._step,
            numSolverIterations=ITERATIONS,
            numSubSteps=0,
            useSplitImpulse=0,
            solverResidualThreshold=0,
            deterministicOverlappingPairs=1,
            enableConeFriction=1,
            erp=self._step / STOP_CORRECTION,
            contactERP=self._step / CORRECTION,
            frictionERP=self._step / CORRECTION,
            physicsClientId=client,
        )
        self._weight = _leaning(specimen.of("tilt"), specimen.of("roll"))
        engine.setGravity(*(_CM * g for g in self._weight), physicsClientId=client)
        self._part = _half(specimen)
        shapes = [self._shape(1.0), self._shape(-1.0)]
        self._bodies = [self._body(link, shapes) for link in self._links]
        self._free = [n for n, link in enumerate(self._links) if not link.is_held]
        #: Where the free links were woven, in Bullet's units: wires hold them there.
        self._woven = {n: engine.getBasePositionAndOrientation(self._bodies[n], client)[0] for n in self._free}
        for n in self._free:
            speed = 0.1 * rng.uniform(-1.0, 1.0, 3)
            engine.resetBaseVelocity(self._bodies[n], speed.tolist(), [0.0] * 3, physicsClientId=client)

    def _shape(self, side: float) -> int:
        """Bar and two arms of a half about its centre of mass."""
        m, (_, centre, _) = self._specimen.measures, self._part
        across = (m.width - m.bar) / 2.0
        arm = m.cold / 2.0
        engine = self._engine
        lie = engine.getQuaternionFromEuler((0.0, math.pi / 2.0, 0.0))
        box = [_CM * v / 2.0 for v in (m.bar, arm, m.bar)]
        ahead = _CM * side * (arm / 2.0 - centre)
        index = engine.createCollisionShapeArray(
            shapeTypes=[engine.GEOM_CYLINDER, engine.GEOM_BOX, engine.GEOM_BOX],
            radii=[_CM * m.bar / 2.0, 0.0, 0.0],
            lengths=[_CM * m.width, 0.0, 0.0],
            halfExtents=[[0.0] * 3, box, box],
            collisionFramePositions=[
                [0.0, -_CM * side * centre, 0.0],
                [-_CM * across, ahead, 0.0],
                [_CM * across, ahead, 0.0],
            ],
            collisionFrameOrientations=[lie, [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]],
            physicsClientId=self._client,
        )
        return int(index)

    def _body(self, link: Link, shapes: list[int]) -> int:
        engine, specimen = self._engine, self._specimen
        mass, centre, inertia = self._part
        along = np.array([0.0, math.cos(link.tilt), math.sin(link.tilt)])
        apart = (link.distance if link.is_held else specimen.measures.cold) - 2.0 * centre
        body = engine.createMultiBody(
            baseMass=0.0 if link.is_held else mass,
            baseCollisionShapeIndex=shapes[0],
            basePosition=(_CM * (np.array(link.back) + centre * along)).tolist(),
            baseOrientation=[math.sin(link.tilt / 2.0), 0.0, 0.0, math.cos(link.tilt / 2.0)],
            linkMasses=[0.0 if link.is_held else mass],
            linkCollisionShapeIndices=[shapes[1]],
            linkVisualShapeIndices=[-1],
            linkPositions=[[0.0, _CM * apart, 0.0]],
            linkOrientations=[[0.0, 0.0, 0.0, 1.0]],
            linkInertialFramePositions=[[0.0] * 3],
            linkInertialFrameOrientations=[[0.0, 0.0, 0.0, 1.0]],
            linkParentIndices=[0],
            linkJointTypes=[engine.JOINT_FIXED if link.is_held else engine.JOINT_PRISMATIC],
            linkJointAxis=[[0.0, 1.0, 0.0]],
            physicsClientId=self._client,
        )
        # Inertia, friction and damping in calls of their own: together Bullet gives them to the wrong piece.
        engine.changeDynamics(
            body,
            -1,
            linearDamping=0.0,
            angularDamping=0.0,
            maxJointVelocity=1e6,
            activationState=engine.ACTIVATION_STATE_DISABLE_SLEEPING,
            physicsClientId=self._client,
        )
        friction = specimen.friction + specimen.of("contact_friction")
        for piece in (-1, 0):
            weighed = {} if link.is_held else {"localInertiaDiagonal": [_CM**2 * i for i in inertia]}
            engine.changeDynamics(
                body,
                piece,
                lateralFriction=math.sqrt(friction),
                spinningFriction=0.0,
                rollingFriction=0.0,
                restitution=0.0,
                jointDamping=0.0,
                frictionAnchor=1,
                physicsClientId=self._client,
                **weighed,
            )
        if not link.is_held:
            self._slide(body)
        return int(body)

    def _slide(self, body: int) -> None:
        engine, stroke = self._engine, _CM * self._specimen.measures.stroke
        engine.changeDynamics(
            body, 0, jointLowerLimit=-stroke, jointUpperLimit=0.0, jointLimitForce=1e6, physicsClientId=self._client
        )
        engine.resetJointState(body, 0, 0.0, 0.0, physicsClientId=self._client)
        engine.changeDynamics(body, 0, jointDamping=self._specimen.of("viscous_damping"), physicsClientId=self._client)

    def watched(self, stop: float, interval: float) -> Array:
        """See `drape`."""
        between = round(interval / self._step)
        found = [self._markers()]
        for _ in range(round(stop / interval)):
            for _ in range(between):
                self._push()
                self._time += self._step
                self._engine.stepSimulation(self._client)
            found.append(self._markers())
            if not np.abs(found[-1]).max() < FARTHEST:  # not a number either
                acting = dict(self._specimen.effects)
                raise ValueError(f"a fabric with {acting} runs away at {self._time:.3f} s: that is no recording")
        return np.array(found)

    def _push(self) -> None:
        """Springs, dry friction of slides and a payload."""
        engine, specimen, client = self._engine, self._specimen, self._client
        last = [n for n in self._free if self._links[n].row == specimen.rows - 1]
        for n in self._free:
            body = self._bodies[n]
            length = specimen.measures.cold - specimen.offset + engine.getJointState(body, 0, client)[0] / _CM
            is_local = n == specimen.at_link or self._links[n].row == specimen.at_row
            steel = specimen.steel * (1.0 - specimen.of("weak_steel") * is_local)
            pull = specimen.coil_at(self._time, is_local) * max(length - specimen.coil_rest, 0.0)
            force = 2.0 * (steel * max(specimen.steel_rest - length, 0.0) - pull)
            engine.setJointMotorControl2(body, 0, engine.TORQUE_CONTROL, force=_CM * force, physicsClientId=client)
            dry = specimen.of("slide_friction") + specimen.of("jammed_link") * is_local
            engine.setJointMotorControl2(
                body, 0, engine.VELOCITY_CONTROL, targetVelocity=0.0, force=_CM * dry, physicsClientId=client
            )
            if self._links[n].place == 2 * COLUMNS - 2 and specimen.of("supply_wire_stiffness"):
                place, _ = engine.getBasePositionAndOrientation(body, client)
                wire = [specimen.of("supply_wire_stiffness") * (w - p) for w, p in zip(self._woven[n], place)]
                engine.applyExternalForce(body, -1, wire, place, engine.WORLD_FRAME, physicsClientId=client)
            if n in last and specimen.of("payload"):
                share = [_CM * specimen.of("payload") * g / len(last) for g in self._weight]
                place, _ = engine.getBasePositionAndOrientation(body, client)
                engine.applyExternalForce(body, -1, share, place, engine.WORLD_FRAME, physicsClientId=client)

    def _markers(self) -> Array:
        m, (_, centre, _) = self._specimen.measures, self._part
        found = []
        for n, link in enumerate(self._links):
            if link.place != 2 * COLUMNS - 2:
                continue
            place, turn = self._engine.getBasePositionAndOrientation(self._bodies[n], self._client)
            axes = np.array(self._engine.getMatrixFromQuaternion(turn)).reshape(3, 3)
            slide = 0.0 if link.is_held else self._engine.getJointState(self._bodies[n], 0, self._client)[0] / _CM
            distance = link.distance if link.is_held else m.cold + slide
            back = np.array(place) / _CM - centre * axes[:, 1] + m.width / 2.0 * axes[:, 0]
            found += [back, back + distance * axes[:, 1]]
        return np.array(found)


def _half(specimen: Specimen) -> tuple[float, float, tuple[float, float, float]]:
    """Mass [kg], distance of its centre from the bar [m] and principal moments [kg m^2] of half a link."""
    m = specimen.measures
    arm = m.cold / 2.0
    bar_volume, arm_volume = math.pi / 4.0 * m.bar**2 * m.width, m.bar**2 * arm
    density = specimen.mass / 2.0 / (bar_volume + 2.0 * arm_volume)
    bar, arms = density * bar_volume, 2.0 * density * arm_volume
    centre = arms * arm / 2.0 / (bar + arms)
    across = (m.width - m.bar) / 2.0
    shift = arms * (arm / 2.0 - centre) ** 2 + bar * centre**2
    around_x = bar * m.bar**2 / 8.0 + arms * (arm**2 + m.bar**2) / 12.0 + shift
    bar_across = bar * (m.bar**2 / 16.0 + m.width**2 / 12.0)
    around_y = bar_across + arms * (m.bar**2 / 6.0 + across**2)
    around_z = bar_across + arms * ((arm**2 + m.bar**2) / 12.0 + across**2) + shift
    return bar + arms, centre, (around_x, around_y, around_z)


def _leaning(tilt: float, roll: float) -> tuple[float, float, float]:
    """Gravity in the frame of a stand whose free end is raised by `tilt`, then turned about y by `roll` [rad]."""
    y, z = -GRAVITY * math.sin(tilt), -GRAVITY * math.cos(tilt)
    return -math.sin(roll) * z, y, math.cos(roll) * z


def _quiet_pybullet() -> Any:
    """Bullet prints when it is loaded."""
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        import pybullet
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)
    return pybullet
