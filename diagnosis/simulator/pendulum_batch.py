"""Many independent arms on hinges in one world of Bullet, in one pass of compiled code.

Bullet moves the arms, as in the unit (mechanics/bullet_pendulum.py); what is saved is a world per run, Python at every
micro-step, and the co-simulation around a single unit. A correction of fourth order lets the step be longer than the
unit's: angles differ from those of the unit by about 1e-6 rad after 12 s (1e-4 rad with dry friction; tests).
"""

from __future__ import annotations

import ctypes
import functools
import importlib.util
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from cosim.unit import Array
from diagnosis.bank.compiler import CompilerError, load

#: Order of the numbers of an arm in pendulums.c; the first five are made from others.
LAWS = (
    "viscous_damping", "quadratic_drag", "cubic_drag", "coulomb_friction", "stiction", "stribeck_speed",
    "spring_stiffness", "spring_rest", "band_damping", "band_width", "periodic_torque", "periodic_rate",
    "periodic_phase", "constant_torque",
)  # fmt: skip
#: Longest step where the unit's is shorter, in radians of a small swing: errors of 5e-6 rad after 15 swings; half of it
#: with dry friction (1e-4 rad). Stiction acts near standstill alone, which a longer step leaps over (1e-2 rad): the
#: unit's own.
PHASE, DRY_PHASE, STUCK_PHASE = 0.042, 0.021, 0.0
_DRY, _STICKS = (5 + LAWS.index(name) for name in ("coulomb_friction", "stiction"))
#: Arms that are simulated together: one star of pendulums.c.
TOGETHER = 4


class NoBatch(Exception):
    """Bullet's C interface is not to be had here: why."""


@functools.cache
def _library() -> ctypes.CDLL:
    """The compiled code, connected to Bullet.

    Raises:
        NoBatch: There is no compiler, or pybullet's library does not export Bullet's C interface.
    """
    spec = importlib.util.find_spec("pybullet")
    if spec is None or spec.origin is None:
        raise NoBatch("pybullet is not installed")
    try:
        library = load(Path(__file__).with_name("pendulums.c").read_text(encoding="utf-8"))
    except CompilerError as error:
        raise NoBatch(str(error)) from error
    library.pendulums_run.argtypes = [
        ctypes.c_void_p, ctypes.c_int, ctypes.c_double, ctypes.c_double, ctypes.c_int, ctypes.c_int, ctypes.c_void_p,
    ]  # fmt: skip
    if library.pendulums_open(spec.origin.encode()):
        raise NoBatch(f"{spec.origin} does not export Bullet's C interface")
    return library


def is_available() -> bool:
    """Whether arms can be simulated together here."""
    try:
        _library()
    except NoBatch:
        return False
    return True


def arm(values: Mapping[str, float]) -> list[float]:
    """Numbers of an arm for pendulums.c.

    Args:
        values: All numbers of a `mechanics.pendulum_design.PendulumDesign`, SI.
    """
    inertia = values["central_inertia"] + values["mass"] * values["centre_distance"] ** 2
    moment = values["mass"] * values["gravity"] * values["centre_distance"]
    first = [inertia, moment, values["initial_angle"], values["initial_angular_velocity"], values["tilt"]]
    return first + [values[name] for name in LAWS]


def longest_step(unit_step: float, spacing: float, frequency: float, phase: float = PHASE) -> float:
    """Step [s] that divides the spacing of samples, no shorter than the unit's.

    Args:
        unit_step: Micro-step of the unit [s].
        spacing: Of samples [s], a whole number of micro-steps.
        frequency: Of small swings [rad/s].
        phase: Longest step in radians of a small swing.
    """
    micro = round(spacing / unit_step)
    fitting = [k for k in range(1, micro + 1) if micro % k == 0 and (k == 1 or k * unit_step * frequency <= phase)]
    return unit_step * max(fitting)


def swings(arms: Sequence[Sequence[float]], unit_step: float, spacing: float, samples: int) -> Array:
    """Angle [rad] and angular velocity [rad/s] at even times from 0, shape (arms, samples, 2).

    Args:
        arms: As `arm` gives them.
        unit_step: Micro-step of the unit whose runs are meant [s].
        spacing: Of samples [s].
        samples: How many.

    Returns:
        Infinite for an arm that Bullet lost.

    Raises:
        NoBatch: Bullet cannot be called, or would not build the arms.
    """
    library = _library()
    given = np.ascontiguousarray(arms, dtype=np.float64)
    found = np.zeros((len(given), samples, 2))
    longest = np.where(given[:, _STICKS] > 0.0, STUCK_PHASE, np.where(given[:, _DRY] > 0.0, DRY_PHASE, PHASE))
    for phase in (STUCK_PHASE, DRY_PHASE, PHASE):
        members = np.flatnonzero(longest == phase)
        for begin in range(0, len(members), TOGETHER):
            chosen = members[begin : begin + TOGETHER]
            own, out = np.ascontiguousarray(given[chosen]), np.zeros((len(chosen), samples, 2))
            step = longest_step(unit_step, spacing, float(np.sqrt(np.max(own[:, 1] / own[:, 0]))), phase)
            if library.pendulums_run(
                own.ctypes.data, len(own), step, unit_step, round(spacing / step), samples, out.ctypes.data
            ):  # fmt: skip
                raise NoBatch("Bullet did not build the arms")
            found[chosen] = out
    return np.where(np.isfinite(found), found, np.inf)
