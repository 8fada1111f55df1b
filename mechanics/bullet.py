"""The only place where Bullet is called: a world of links, driven by its springs.

Bullet works here in centimetres and kilograms, because its collision margin (0.001 length units) must be small against
a bar; everything that enters or leaves this module is SI. Traps that the settings avoid are listed in
docs/decisions/0004-bullet-settings.md.
"""

from __future__ import annotations

import math

import numpy as np

from cosim.unit.protocol import Array
from mechanics.bullet_added import AddedForces
from mechanics.engine import load
from mechanics.fabric import FabricDesign, Layout
from mechanics.half import Half, half
from mechanics.motion import SCALE, Motion, rotation, woven
from mechanics.solver import SolverSettings
from mechanics.world import Contacts

pybullet = load()

__all__ = ["SCALE", "Contacts", "Motion", "World", "rotation", "woven"]

#: Time in which an overlap of two links is pushed apart, and in which a slide returns to its stop [s]. Bullet wants
#: them as a share per step (ERP). Stops must be slow: a slide that is pushed off its stop is free there for a step, in
#: which a spring of some newtons throws it back by half a millimetre. docs/decisions/0004-bullet-settings.md.
CONTACT_CORRECTION_TIME = 2.5e-3
STOP_CORRECTION_TIME = 25e-3
#: Metres per length unit of Bullet.
_PER_UNIT = 1.0 / SCALE
_TORQUE, _MOTOR = pybullet.TORQUE_CONTROL, pybullet.VELOCITY_CONTROL
#: Bullet's limit of joint and body speed, set out of reach [cm/s, rad/s].
_NO_LIMIT = 1e6


def _share(steps: float) -> float:
    """Share of an error that is corrected in one step; at most half, beyond which corrections overshoot."""
    return min(0.5, steps)


class World:
    """A Bullet world with one multibody per link: back half as base, front half on a slide.

    Springs act in one of two ways (`SolverSettings.springs`). "force": as a joint force, set anew in every micro-step.
    Bullet's stop acts only where the slide has already passed it, so preloaded slides rattle by some tenths of a
    millimetre, which shakes friction loose. "motor": each spring pair is a joint motor that seeks the stop towards
    which it acts, with no more than the springs' force. Between the stops the motor is at its bound, that is the force;
    at a stop it gives what keeps the slide there, and a slide that would pass the stop at its present speed is
    caught by the impulse that its mass needs. Nothing rattles, and friction holds what it can hold.

    Args:
        design: Fabric.
        layout: Which links are held.
        solver: Numerical settings.
        motion: Where the links start.
    """

    engine = "Bullet"

    def __init__(self, design: FabricDesign, layout: Layout, solver: SolverSettings, motion: Motion) -> None:
        self.design, self.layout, self.solver = design, layout, solver
        self._motion = motion.copy()
        self._client = pybullet.connect(pybullet.DIRECT)
        if self._client < 0:
            raise RuntimeError("Bullet has no free client")
        self._configure()
        self._half = half(design)
        shapes = self._shapes(self._half)
        self._bodies = [self._link(i, shapes, self._half) for i in range(design.links)]
        self._link_of = {body: link for link, body in enumerate(self._bodies)}
        sliding = np.flatnonzero(~layout.is_locked)
        #: (body, stiffness of both its steel springs [N/m], its two coils) of every link whose slide is free.
        steel = 2 * design.steel_stiffness * design.added.steel_kept(design.links)
        self._sliding = [(self._bodies[i], float(steel[i]), 2 * int(i), 2 * int(i) + 1) for i in sliding]
        self._slides = sliding
        self._free = np.flatnonzero(~layout.is_fixed)
        self._added = AddedForces(design, layout, self._client, self._bodies, sliding.tolist())

    def close(self) -> None:
        """Free Bullet's world; safe to call twice."""
        if self._client >= 0:
            pybullet.disconnect(physicsClientId=self._client)
            self._client = -1

    def _configure(self) -> None:
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=self.solver.micro_step,
            numSolverIterations=self.solver.iterations,
            numSubSteps=0,
            useSplitImpulse=0,
            solverResidualThreshold=0,
            deterministicOverlappingPairs=1,
            enableConeFriction=int(self.solver.friction_model == "cone"),
            erp=_share(self.solver.micro_step / STOP_CORRECTION_TIME),
            contactERP=_share(self.solver.micro_step / CONTACT_CORRECTION_TIME),
            frictionERP=_share(self.solver.micro_step / CONTACT_CORRECTION_TIME),
            physicsClientId=self._client,
        )
        pybullet.setGravity(*(SCALE * g for g in self.design.gravity), physicsClientId=self._client)

    def _shapes(self, part: Half) -> tuple[int, int]:
        """Collision shapes of the back and of the front half, about their centres of mass."""
        return self._shape(part, 1.0), self._shape(part, -1.0)

    def _shape(self, part: Half, sign: float) -> int:
        along_x = pybullet.getQuaternionFromEuler((0.0, math.pi / 2, 0.0))
        box = [SCALE * size / 2 for size in part.arm_size]
        arm_y = SCALE * sign * (part.arm_size[1] / 2 - part.centre)
        centres = [
            [0.0, -SCALE * sign * part.centre, 0.0],
            [-SCALE * part.arm_x, arm_y, 0.0],
            [SCALE * part.arm_x, arm_y, 0.0],
        ]
        index = pybullet.createCollisionShapeArray(
            shapeTypes=[pybullet.GEOM_CYLINDER, pybullet.GEOM_BOX, pybullet.GEOM_BOX],
            radii=[SCALE * part.bar_radius, 0.0, 0.0],
            lengths=[SCALE * part.bar_length, 0.0, 0.0],
            halfExtents=[[0.0, 0.0, 0.0], box, box],
            collisionFramePositions=centres,
            collisionFrameOrientations=[along_x, [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]],
            physicsClientId=self._client,
        )
        return int(index)

    def _link(self, link: int, shapes: tuple[int, int], part: Half) -> int:
        is_fixed, is_locked = bool(self.layout.is_fixed[link]), bool(self.layout.is_locked[link])
        # The front half sits where the slide puts it at full length; a locked one is welded where it is held.
        apart = SCALE * (self.design.bar_distance_cold - 2 * part.centre)
        if is_locked:
            apart += float(self._motion.slide[link])
        body = pybullet.createMultiBody(
            baseMass=0.0 if is_fixed else part.mass,
            baseCollisionShapeIndex=shapes[0],
            basePosition=self._motion.position[link].tolist(),
            baseOrientation=self._motion.orientation[link].tolist(),
            linkMasses=[0.0 if is_locked else part.mass],
            linkCollisionShapeIndices=[shapes[1]],
            linkVisualShapeIndices=[-1],
            linkPositions=[[0.0, apart, 0.0]],
            linkOrientations=[[0.0, 0.0, 0.0, 1.0]],
            linkInertialFramePositions=[[0.0, 0.0, 0.0]],
            linkInertialFrameOrientations=[[0.0, 0.0, 0.0, 1.0]],
            linkParentIndices=[0],
            linkJointTypes=[pybullet.JOINT_FIXED if is_locked else pybullet.JOINT_PRISMATIC],
            linkJointAxis=[[0.0, 1.0, 0.0]],
            physicsClientId=self._client,
        )
        self._material(body, part, is_fixed, is_locked)
        if not is_locked:
            self._slide(body, link)
        if not is_fixed:
            pybullet.resetBaseVelocity(
                body,
                self._motion.velocity[link].tolist(),
                self._motion.angular_velocity[link].tolist(),
                physicsClientId=self._client,
            )
        return int(body)

    def _material(self, body: int, part: Half, is_fixed: bool, is_locked: bool) -> None:
        """Friction, inertia and damping.

        What concerns the whole multibody must not stand in one call with what concerns a piece: Bullet then gives the
        base what was meant for the piece, without a word.
        """
        pybullet.changeDynamics(
            body,
            -1,
            linearDamping=0.0,
            angularDamping=0.0,
            maxJointVelocity=_NO_LIMIT,
            activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
            physicsClientId=self._client,
        )
        inertia = [SCALE**2 * moment for moment in part.inertia]
        for piece, is_massless in ((-1, is_fixed), (0, is_locked)):
            settings = {} if is_massless else {"localInertiaDiagonal": inertia}
            pybullet.changeDynamics(
                body,
                piece,
                # Bullet multiplies the coefficients of the two bodies in contact.
                lateralFriction=math.sqrt(self.design.pair_friction),
                spinningFriction=0.0,
                rollingFriction=0.0,
                restitution=math.sqrt(self.design.restitution),
                jointDamping=0.0,
                frictionAnchor=int(self.solver.friction_anchors),
                physicsClientId=self._client,
                **settings,
            )

    def _slide(self, body: int, link: int) -> None:
        shortest = SCALE * (self.design.bar_distance_hot - self.design.bar_distance_cold)
        pybullet.changeDynamics(
            body,
            0,
            jointLowerLimit=shortest,
            jointUpperLimit=0.0,
            jointLimitForce=_NO_LIMIT,
            physicsClientId=self._client,
        )
        pybullet.resetJointState(
            body, 0, float(self._motion.slide[link]), float(self._motion.slide_rate[link]), physicsClientId=self._client
        )
        pybullet.setJointMotorControl2(body, 0, pybullet.VELOCITY_CONTROL, force=0.0, physicsClientId=self._client)

    def advance(self, steps: int, stiffness: Array, rest_length: Array) -> None:
        """Take micro-steps with the spring forces of this instant.

        Args:
            steps: Number of micro-steps.
            stiffness: Shape (coil,) [N/m].
            rest_length: Shape (coil,) [m].
        """
        act = self._push if self.solver.springs == "force" else self._drive
        added = self.design.added
        k, r = added.coil_stiffness(stiffness).tolist(), added.rest_length(stiffness, rest_length).tolist()
        links = [(body, steel, k[i], r[i], k[j], r[j]) for body, steel, i, j in self._sliding]
        step, client = pybullet.stepSimulation, self._client
        for _ in range(steps):
            act(links)
            if self._added.is_active:
                self._added.push()
            step(client)

    def _opening_force(self, slide: float, steel: float, k0: float, r0: float, k1: float, r1: float) -> float:
        """Force of both arms' springs that lengthens a link [N]: two steel coils push, NiTi coils 0 and 1 pull."""
        length, rest = self.design.length_cold + slide * _PER_UNIT, self.design.steel_rest_length
        force = steel * (rest - length) if length < rest else 0.0
        if length > r0:
            force -= k0 * (length - r0)
        if length > r1:
            force -= k1 * (length - r1)
        return force

    def _push(self, links: list[tuple[int, float, float, float, float, float]]) -> None:
        """Springs as joint forces."""
        client, get, put, torque = self._client, pybullet.getJointState, pybullet.setJointMotorControl2, _TORQUE
        for body, steel, k0, r0, k1, r1 in links:
            force = self._opening_force(get(body, 0, client)[0], steel, k0, r0, k1, r1)
            put(body, 0, torque, force=SCALE * force, physicsClientId=client)

    def _drive(self, links: list[tuple[int, float, float, float, float, float]]) -> None:
        """Springs as bounded joint motors; see the class."""
        client, get, put, motor = self._client, pybullet.getJointState, pybullet.setJointMotorControl2, _MOTOR
        shortest = SCALE * (self.design.bar_distance_hot - self.design.bar_distance_cold)
        per_step, slowly = 1.0 / self.solver.micro_step, 1.0 / STOP_CORRECTION_TIME
        impact = self._half.mass / 2 * per_step  # two halves of mass m move against each other like m / 2
        for body, steel, k0, r0, k1, r1 in links:
            slide, rate = get(body, 0, client)[:2]
            force = self._opening_force(slide, steel, k0, r0, k1, r1)
            if force > 0:
                gap, bound = -slide, SCALE * force
                is_inside, speed = gap > 0, rate
            else:
                gap, bound = shortest - slide, -SCALE * force
                is_inside, speed = gap < 0, -rate
            if speed > abs(gap) * per_step:
                bound += impact * speed
            put(
                body,
                0,
                motor,
                targetVelocity=gap * (per_step if is_inside else slowly),
                force=bound,
                physicsClientId=client,
            )

    def motion(self) -> Motion:
        """Current state; the arrays are overwritten by the next call."""
        client, m = self._client, self._motion
        for i in self._free:
            body = self._bodies[i]
            m.position[i], m.orientation[i] = pybullet.getBasePositionAndOrientation(body, client)
            m.velocity[i], m.angular_velocity[i] = pybullet.getBaseVelocity(body, client)
        for i in self._slides:
            m.slide[i], m.slide_rate[i] = pybullet.getJointState(self._bodies[i], 0, client)[:2]
        return m

    def contacts(self) -> Contacts:
        """Contact points between links, as Bullet found them in its last step."""
        points = pybullet.getContactPoints(physicsClientId=self._client) or ()
        if not points:
            return Contacts(0, 0.0, (0, 0))
        deepest = min(points, key=lambda point: point[8])
        links = self._link_of[deepest[1]], self._link_of[deepest[2]]
        return Contacts(len(points), max(0.0, -deepest[8] / SCALE), links)
