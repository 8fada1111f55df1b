"""Loads below the coils in MuJoCo: masses that swing on springs, with friction, damping and wires of its own solver."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from evaluation.proving.effects.effect import Effect
from evaluation.proving.effects.electrical import REFERENCE
from evaluation.proving.effects.mechanical import (
    SlideFriction,
    SupplyWireStiffness,
    ThermalContraction,
    Tilt,
    ViscousDamping,
)
from evaluation.proving.rig import GRAVITY, Array, Rig
from evaluation.proving.truth import Trace

#: Effects that MuJoCo can make.
SUPPORTED: tuple[type[Effect], ...] = (SlideFriction, SupplyWireStiffness, ThermalContraction, Tilt, ViscousDamping)
_STEP = 0.002  # [s]; the masses swing at 6 to 10 Hz
_BLOCK = 10  # steps with one stiffness
#: Share of critical damping that every spring has, inner friction of the wire.
_DAMPING_RATIO = 0.05


def hang(trace: Trace, rig: Rig, effects: Sequence[Effect]) -> Array:
    """Extension of every coil under its swinging load.

    Args:
        trace: Stiffness and temperature over time.
        rig: Weights.
        effects: Mechanical ones, all of them in `SUPPORTED`.

    Returns:
        [m], shape (steps + 1, coils), at the times of the trace.
    """
    coils = rig.weight.size
    friction, damping, wire, reach, lost = (np.zeros(coils) for _ in range(5))
    contraction = np.zeros(coils)
    for effect in effects:
        amount = effect.place.amount
        if isinstance(effect, SlideFriction):
            friction += effect.parameters["friction"] * amount
        elif isinstance(effect, ViscousDamping):
            damping += effect.parameters["damping"] * amount
        elif isinstance(effect, SupplyWireStiffness):
            wire += effect.parameters["wire"] * amount
            reach += effect.parameters["reach"] * amount
        elif isinstance(effect, Tilt):
            lost += effect.parameters["loss"] * amount
        elif isinstance(effect, ThermalContraction):
            contraction += effect.parameters["contraction"] * amount
        else:
            raise ValueError(f"MuJoCo's loads know no {effect.identifier}")
    model = _model(rig.weight, friction)
    moments, course = _swing(model, trace, rig.weight * (1.0 - lost), (damping, wire, reach))
    extension = np.stack([np.interp(trace.time, moments, c) for c in course.T], axis=1)
    return np.asarray(extension - contraction * (trace.states["mean_temperature"] - REFERENCE))


def _model(weight: Array, friction: Array) -> mujoco.MjModel:
    """Masses on slides; the springs are set while it runs."""
    bodies = "".join(
        f'<body pos="{0.1 * n} 0 0"><joint type="slide" axis="0 0 -1" damping="1" stiffness="1" frictionloss="{f:.9g}" '
        f'solreffriction="0.004 1" solimpfriction="0.99 0.9999 0.0001"/><geom type="sphere" size="0.01" '
        f'mass="{w / GRAVITY:.9g}" contype="0" conaffinity="0"/></body>'
        for n, (w, f) in enumerate(zip(weight, friction))
    )
    text = (
        f'<mujoco><option timestep="{_STEP}" integrator="implicitfast" gravity="0 0 -{GRAVITY}" iterations="50" '
        f'tolerance="1e-12"/><worldbody>{bodies}</worldbody></mujoco>'
    )
    return mujoco.MjModel.from_xml_string(text)


def _swing(model: mujoco.MjModel, trace: Trace, load: Array, laws: tuple[Array, Array, Array]) -> tuple[Array, Array]:
    damping, wire, reach = laws
    data = mujoco.MjData(model)
    weight = model.body_mass[1:] * GRAVITY
    moments = np.arange(0.0, trace.time[-1] + _STEP * _BLOCK, _STEP * _BLOCK)
    middles = moments + 0.5 * _STEP * _BLOCK
    stiffness = np.stack([np.interp(middles, trace.time, k) for k in trace.states["stiffness"].T], axis=1)
    whole = stiffness + wire
    own = 2.0 * _DAMPING_RATIO * np.sqrt(whole[0] * model.body_mass[1:])
    model.dof_damping[:] = damping + own
    data.qpos[:] = (load + wire * reach) / whole[0]
    data.qfrc_applied[:] = load - weight  # what a tilt takes from the weight along the coil
    course = np.empty((moments.size, load.size))
    for n in range(moments.size):
        course[n] = data.qpos
        model.jnt_stiffness[:] = whole[n]
        model.qpos_spring[:] = wire * reach / whole[n]
        mujoco.mj_step(model, data, _BLOCK)
    return moments, course
