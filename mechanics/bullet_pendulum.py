"""A rigid arm on a hinge in Bullet: the second of the two files that call it."""

from __future__ import annotations

import math

from mechanics.engine import load
from mechanics.pendulum_design import PendulumDesign

pybullet = load()

#: Bullet's limit of joint speed, set out of reach [rad/s].
_NO_LIMIT = 1e6
#: One hinge, one motor row: the solver is exact after the first iteration.
_ITERATIONS = 10


class PendulumWorld:
    """One multibody: a fixed base and the arm on a revolute joint about y; angle 0 points up, pi hangs down.

    Bullet adds the whole change of speed of a step before it moves the arm (symplectic Euler). Its speed is therefore
    held here as that of the middle of a step (Stoermer-Verlet, the same arithmetic), which makes angle and speed
    second order in the micro-step instead of first: docs/mechanics.md. Dry friction is Bullet's own joint motor, which
    seeks speed 0 with no more than the friction's torque and so holds the arm where it sticks.

    Args:
        design: Arm and hinge.
        micro_step: Time step [s].
    """

    def __init__(self, design: PendulumDesign, micro_step: float) -> None:
        self.design, self.micro_step = design, micro_step
        self.acceleration = 0.0
        self._speed = self._angle = self._time = 0.0
        self._held = -1.0
        self._client = pybullet.connect(pybullet.DIRECT)
        if self._client < 0:
            raise RuntimeError("Bullet has no free client")
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=micro_step,
            numSubSteps=0,
            numSolverIterations=_ITERATIONS,
            solverResidualThreshold=0,
            physicsClientId=self._client,
        )
        sine, cosine = math.sin(design.tilt), math.cos(design.tilt)
        pybullet.setGravity(-design.gravity * sine, 0.0, -design.gravity * cosine, physicsClientId=self._client)
        self._body = self._arm()

    def _arm(self) -> int:
        design, client = self.design, self._client
        body = pybullet.createMultiBody(
            baseMass=0.0,
            linkMasses=[design.mass],
            linkCollisionShapeIndices=[-1],
            linkVisualShapeIndices=[-1],
            linkPositions=[[0.0, 0.0, 0.0]],
            linkOrientations=[[0.0, 0.0, 0.0, 1.0]],
            linkInertialFramePositions=[[0.0, 0.0, design.centre_distance]],
            linkInertialFrameOrientations=[[0.0, 0.0, 0.0, 1.0]],
            linkParentIndices=[0],
            linkJointTypes=[pybullet.JOINT_REVOLUTE],
            linkJointAxis=[[0.0, 1.0, 0.0]],
            physicsClientId=client,
        )
        pybullet.changeDynamics(
            body,
            -1,
            linearDamping=0.0,
            angularDamping=0.0,
            maxJointVelocity=_NO_LIMIT,
            activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
            physicsClientId=client,
        )
        # All friction is ours; the moment about the hinge is what matters, so the other two are set alike.
        pybullet.changeDynamics(
            body,
            0,
            localInertiaDiagonal=[design.central_inertia] * 3,
            jointDamping=0.0,
            linearDamping=0.0,
            angularDamping=0.0,
            physicsClientId=client,
        )
        self._hold(int(body), 0.0)
        return int(body)

    def _hold(self, body: int, torque: float) -> None:
        """Dry friction of the next steps [N m]."""
        if torque == self._held:
            return
        self._held = torque
        pybullet.setJointMotorControl2(
            body, 0, pybullet.VELOCITY_CONTROL, targetVelocity=0.0, force=torque, physicsClientId=self._client
        )

    def close(self) -> None:
        """Free Bullet's world; safe to call twice."""
        if self._client >= 0:
            pybullet.disconnect(physicsClientId=self._client)
            self._client = -1

    def begin(self, angle: float, angular_velocity: float, torque: float) -> None:
        """Start from angle [rad] and angular velocity [rad/s] at one instant, with an outer torque [N m].

        A trial step gives the acceleration, with which the speed goes back by half a step.
        """
        self.put(angle, angular_velocity, 0.0, 0.0)
        self.advance(1, torque)
        acceleration = self.acceleration
        self.put(angle, angular_velocity - 0.5 * self.micro_step * acceleration, acceleration, 0.0)

    def put(self, angle: float, half_speed: float, acceleration: float, time: float) -> None:
        """Set the state as `state` gives it."""
        pybullet.resetJointState(self._body, 0, angle, half_speed, physicsClientId=self._client)
        self._angle, self._speed, self.acceleration, self._time = angle, half_speed, acceleration, time

    def state(self) -> tuple[float, float, float, float]:
        """Angle [rad], speed half a step before [rad/s], acceleration of the last step [rad/s^2], time [s]."""
        angle, speed = pybullet.getJointState(self._body, 0, self._client)[:2]
        return float(angle), float(speed), self.acceleration, self._time

    def angular_velocity(self) -> float:
        """Now [rad/s]: that of half a step before, carried on with the acceleration of the last step."""
        return self._speed + 0.5 * self.micro_step * self.acceleration

    def advance(self, steps: int, torque: float) -> None:
        """Take micro-steps under an outer torque [N m].

        Args:
            steps: Number of micro-steps.
            torque: About the hinge, held constant.
        """
        design, client, body, dt = self.design, self._client, self._body, self.micro_step
        is_driven = bool(torque) or design.has_smooth_law
        is_dry = design.coulomb_friction > 0 or design.stiction > 0
        for _ in range(steps):
            middle = self._speed + 0.5 * dt * self.acceleration
            given = torque + design.smooth_torque(self._time, self._angle, middle) if is_driven else 0.0
            if is_dry:
                given += self._dry_friction(middle, given)
            if given:
                pybullet.setJointMotorControl2(body, 0, pybullet.TORQUE_CONTROL, force=given, physicsClientId=client)
            pybullet.stepSimulation(client)
            self._angle, speed = pybullet.getJointState(body, 0, client)[:2]
            self.acceleration, self._speed = (speed - self._speed) / dt, speed
            self._time += dt

    def _dry_friction(self, middle: float, given: float) -> float:
        """Set the motor that is dry friction; the torque that stands for it in a step in which the arm turns [N m]."""
        design = self.design
        friction = design.dry_friction(middle)
        free = given + design.weight_moment * math.sin(self._angle - design.tilt)
        turning = design.turning(friction, self._speed, free, self.micro_step)
        self._hold(self._body, friction if turning is None else 0.0)
        return turning or 0.0
