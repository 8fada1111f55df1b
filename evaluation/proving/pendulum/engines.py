"""The arm's swing by three engines; each returns the angle at even times."""

from __future__ import annotations

import ctypes
import math
import os
from collections.abc import Callable
from typing import Any

import numpy as np

from evaluation.proving.pendulum.arm import GRAVITY, Arm
from evaluation.proving.rig import Array

#: (arm, angle [rad], angular velocity [rad/s], stop [s], interval [s]) to angles [rad], shape (samples,).
Engine = Callable[[Arm, float, float, float, float], Array]


def own(arm: Arm, angle: float, speed: float, stop: float, interval: float) -> Array:
    """Stoermer and Verlet with Moreau's impulses for dry friction, in steps of 0.25 ms.

    Source: J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, CISM 302 (1988).
    """
    steps = round(interval / 2.5e-4)
    dt = interval / steps
    viscous = arm.of("viscous_damping")
    found = [angle]
    time, speed = 0.0, _kicked(arm, 0.0, angle, speed, 0.5 * dt, viscous)
    for _ in range(round(stop / interval)):
        for _ in range(steps):
            angle += dt * speed
            time += dt
            speed = _kicked(arm, time, angle, speed, dt, viscous)
        found.append(angle)
    return np.array(found)


def _kicked(arm: Arm, time: float, angle: float, speed: float, dt: float, viscous: float) -> float:
    torque = arm.weight(angle) + arm.given(time, angle, speed)
    share = dt / arm.inertia
    free = (speed + share * torque) / (1.0 + share * viscous)
    return math.copysign(max(abs(free) - share * arm.dry(free), 0.0), free)


def bullet(arm: Arm, angle: float, speed: float, stop: float, interval: float) -> Array:
    """Bullet, a chain of one link in steps of 1/8 ms; dry friction is an outer torque that never turns the speed."""
    pybullet = _quiet_pybullet()
    steps = round(interval / 1.25e-4)
    dt = interval / steps
    client = pybullet.connect(pybullet.DIRECT)
    try:
        pybullet.setPhysicsEngineParameter(fixedTimeStep=dt, numSubSteps=0, physicsClientId=client)
        tilt = arm.of("tilt")
        pybullet.setGravity(-GRAVITY * math.sin(tilt), 0.0, -GRAVITY * math.cos(tilt), physicsClientId=client)
        body = _bullet_arm(pybullet, arm, client)
        found, time = [angle], 0.0
        torque = arm.weight(angle) + arm.given(0.0, angle, speed) - arm.of("viscous_damping") * speed
        # Bullet moves with the speed after the kick: start half a step early.
        pybullet.resetJointState(body, 0, angle, speed - 0.5 * dt * torque / arm.inertia, physicsClientId=client)
        for _ in range(round(stop / interval)):
            for _ in range(steps):
                here, now = pybullet.getJointState(body, 0, physicsClientId=client)[:2]
                push = arm.given(time, here, now) - arm.of("viscous_damping") * now
                free = now + dt / arm.inertia * (push + arm.weight(here))
                limit = arm.inertia / dt * abs(free)
                push -= math.copysign(min(arm.dry(free), limit), free)
                pybullet.setJointMotorControl2(body, 0, pybullet.TORQUE_CONTROL, force=push, physicsClientId=client)
                pybullet.stepSimulation(physicsClientId=client)
                time += dt
            found.append(pybullet.getJointState(body, 0, physicsClientId=client)[0])
        return np.array(found)
    finally:
        pybullet.disconnect(client)


def _bullet_arm(bullet_api: Any, arm: Arm, client: int) -> int:
    body = bullet_api.createMultiBody(
        baseMass=0.0,
        linkMasses=[arm.mass],
        linkCollisionShapeIndices=[-1],
        linkVisualShapeIndices=[-1],
        linkPositions=[[0.0, 0.0, 0.0]],
        linkOrientations=[[0.0, 0.0, 0.0, 1.0]],
        linkInertialFramePositions=[[0.0, 0.0, arm.distance]],
        linkInertialFrameOrientations=[[0.0, 0.0, 0.0, 1.0]],
        linkParentIndices=[0],
        linkJointTypes=[bullet_api.JOINT_REVOLUTE],
        linkJointAxis=[[0.0, 1.0, 0.0]],
        physicsClientId=client,
    )
    central = arm.inertia - arm.mass * arm.distance**2
    for link in (-1, 0):
        bullet_api.changeDynamics(
            body,
            link,
            linearDamping=0.0,
            angularDamping=0.0,
            jointDamping=0.0,
            maxJointVelocity=1e6,
            activationState=bullet_api.ACTIVATION_STATE_DISABLE_SLEEPING,
            physicsClientId=client,
        )
    bullet_api.changeDynamics(body, 0, localInertiaDiagonal=[central] * 3, physicsClientId=client)
    bullet_api.setJointMotorControl2(body, 0, bullet_api.VELOCITY_CONTROL, force=0.0, physicsClientId=client)
    return int(body)


def _quiet_pybullet() -> Any:
    """pybullet, which prints its build time when it is first loaded."""
    kept, nothing = [os.dup(1), os.dup(2)], os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nothing, 1)
        os.dup2(nothing, 2)
        import pybullet

        ctypes.CDLL(None).fflush(None)  # what C still holds must not come out later
    finally:
        for number, copy in zip((1, 2), kept):
            os.dup2(copy, number)
            os.close(copy)
        os.close(nothing)
    return pybullet


def mujoco(arm: Arm, angle: float, speed: float, stop: float, interval: float) -> Array:
    """MuJoCo with its own joint damping and frictionloss, in steps of 0.25 ms."""
    import mujoco as engine

    steps = round(interval / 2.5e-4)
    dt = interval / steps
    central = arm.inertia - arm.mass * arm.distance**2
    tilt = arm.of("tilt")
    model = engine.MjModel.from_xml_string(
        f'<mujoco><option timestep="{dt!r}" integrator="implicitfast" gravity="{-GRAVITY * math.sin(tilt)!r} 0 '
        f'{-GRAVITY * math.cos(tilt)!r}" tolerance="1e-14"/><worldbody><body>'
        f'<joint type="hinge" axis="0 1 0" damping="{arm.of("viscous_damping")!r}" frictionloss="{arm.dry(0.0)!r}" '
        f'solreffriction="0.001 1" solimpfriction="0.99 0.9999 0.001"/>'
        f'<inertial pos="0 0 {arm.distance!r}" mass="{arm.mass!r}" diaginertia="{central!r} {central!r} {central!r}"/>'
        "</body></worldbody></mujoco>"
    )
    data = engine.MjData(model)
    torque = arm.weight(angle) + arm.given(0.0, angle, speed)
    data.qpos[0], data.qvel[0] = (
        angle,
        speed - 0.5 * dt * torque / arm.inertia,
    )  # it moves with the speed after the kick
    has_given = bool(set(arm.effects) & {"quadratic_drag", "cable", "brake", "shake"}) or arm.extra is not None
    found = [angle]
    for _ in range(round(stop / interval)):
        if has_given or "stiction" in arm.effects:
            for _ in range(steps):
                here, now = float(data.qpos[0]), float(data.qvel[0])
                data.qfrc_applied[0] = arm.given(float(data.time), here, now)
                model.dof_frictionloss[0] = arm.dry(now)
                engine.mj_step(model, data)
        else:
            engine.mj_step(model, data, steps)
        found.append(float(data.qpos[0]))
    return np.array(found)


ENGINES: dict[str, Engine] = {"own": own, "bullet": bullet, "mujoco": mujoco}
