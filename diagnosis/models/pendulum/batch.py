"""Many independent arms on hinges, stepped in compiled code as Bullet steps them.

Bullet moves the arm of the unit (mechanics/bullet_pendulum.py) and of every run that judges. For one link on a hinge of
a fixed base its arithmetic is a few lines (pendulums.c), which give the angles of the unit to rounding where both take
the same steps. A correction of fourth order lets the step be longer than the unit's: angles differ from those of the
unit by about 1e-6 rad after 12 s (1e-4 rad with dry friction; tests).
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.models.coil_network.kernel.compiler import CompilerError, load

#: Order of the numbers of an arm in pendulums.c; the first five are made from others.
LAWS = (
    "viscous_damping",
    "quadratic_drag",
    "cubic_drag",
    "coulomb_friction",
    "stiction",
    "stribeck_speed",
    "spring_stiffness",
    "spring_rest",
    "band_damping",
    "band_width",
    "periodic_torque",
    "periodic_rate",
    "periodic_phase",
    "constant_torque",
)
#: Longest step where the unit's is shorter, in radians of a small swing: errors of 5e-6 rad after 15 swings; half of it
#: with dry friction (1e-4 rad). Stiction acts near standstill alone, which a longer step leaps over (1e-2 rad): the
#: unit's own.
PHASE, DRY_PHASE, STUCK_PHASE = 0.042, 0.021, 0.0
_DRY, _STICKS = (5 + LAWS.index(name) for name in ("coulomb_friction", "stiction"))


@functools.cache
def _library() -> ctypes.CDLL:
    """The compiled code.

    Raises:
        CompilerError: There is no compiler.
    """
    library = load(Path(__file__).with_name("pendulums.c").read_text(encoding="utf-8"))
    library.pendulums_run.argtypes = [
        ctypes.c_void_p,
        ctypes.c_double,
        ctypes.c_double,
        ctypes.c_int,
        ctypes.c_int,
        ctypes.c_void_p,
    ]
    library.pendulums_run.restype = None
    return library


def is_available() -> bool:
    """Whether there is a compiler here for them."""
    try:
        _library()
    except CompilerError:
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
        Infinite for an arm that ran away.

    Raises:
        CompilerError: There is no compiler.
    """
    run = _library().pendulums_run
    given = np.ascontiguousarray(arms, dtype=np.float64)
    found = np.zeros((len(given), samples, 2))
    phases = np.where(given[:, _STICKS] > 0.0, STUCK_PHASE, np.where(given[:, _DRY] > 0.0, DRY_PHASE, PHASE))
    for own, out, phase in zip(given, found, phases.tolist()):
        step = longest_step(unit_step, spacing, float(np.sqrt(own[1] / own[0])), phase)
        run(own.ctypes.data, step, unit_step, round(spacing / step), samples, out.ctypes.data)
    return np.where(np.isfinite(found), found, np.inf)
