"""What a pendulum may lack, as laws that its unit can switch on."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

from diagnosis.search.cosim_model import ComponentTerm
from diagnosis.search.problem import Term, TermParameter
from diagnosis.search.unit_law import UnitLaw


@dataclass(frozen=True)
class _Law:
    """One effect; the first parameter is its strength. The source stands in mechanics/pendulum_design.py."""

    identifier: str
    name: str
    law: str
    parameters: tuple[TermParameter, ...]
    confused_with: Mapping[str, str] = field(default_factory=dict)


_TORQUE, _DAMPING, _DRAG = "N*m", "N*m*s", "N*m*s^2"
_AMPLITUDES = "swings of different sizes decide: how the loss per swing falls with the amplitude"
#: Friction and drag take energy, so they are bounded below by 0: a fit that is not bounded finds the wrong sign.
_LAWS = (
    _Law("viscous_damping", "viscous damping of the hinge", "torque = -viscous_damping * w", (
        TermParameter("viscous_damping", _DAMPING, 0.0, 0.05, (1e-5, 1e-4, 1e-3)),),
        {"quadratic_drag": _AMPLITUDES, "coulomb_friction": _AMPLITUDES}),
    _Law("coulomb_friction", "dry friction of the hinge", "torque = -coulomb_friction * sign(w)", (
        TermParameter("coulomb_friction", _TORQUE, 0.0, 0.5, (1e-5, 1e-4, 1e-3)),),
        {"viscous_damping": _AMPLITUDES, "stiction": "slow swings decide: stiction lets go above its Stribeck speed"}),
    _Law("stiction", "stiction of the hinge", "torque = -stiction * exp(-(w / stribeck_speed)**2) * sign(w)", (
        TermParameter("stiction", _TORQUE, 0.0, 0.5, (5e-3, 1e-3, 2e-4)),
        TermParameter("stribeck_speed", "rad/s", 1e-3, 10.0, (0.05, 0.15, 0.4, 1.2))),
        {"coulomb_friction": "fast swings decide: there stiction does nothing"}),
    _Law("quadratic_drag", "drag of the air, with the square of the speed", "torque = -quadratic_drag * abs(w) * w", (
        TermParameter("quadratic_drag", _DRAG, 0.0, 0.05, (1e-6, 1e-5, 1e-4)),),
        {"viscous_damping": _AMPLITUDES}),
    _Law("backlash", "backlash between arm and encoder", "abs(arm - encoder) <= backlash / 2", (
        TermParameter("backlash", "rad", 0.0, 0.5, (1e-3, 1e-2)),),
        {"tilt": "slow turns decide: play stands still at each of them",
         "sensor_lag": "swings of different sizes decide"}),
    _Law("tilt", "tilt of the stand against gravity", "torque = weight_moment * sin(angle - tilt)", (
        TermParameter("tilt", "rad", -0.2, 0.2, (1e-3, -1e-3, 1e-2, -1e-2)),)),
)  # fmt: skip

_HANGING = math.pi
#: Rates at which a periodic torque is looked for [rad/s]: closer than what 12 s can tell apart.
_RATES = tuple(0.5 * n for n in range(2, 41))
#: Torques without a name, over the arm's own variables; each is a number of the unit. A spring stores energy, so its
#: stiffness is not negative: where it may be, a fit went astray and two other terms were found in its place.
_UNNAMED = (
    _Law("torque_of_rate_cubed", "torque with the cube of the rate", "torque = -cubic_drag * w**3", (
        TermParameter("cubic_drag", "N*m*s^3", 0.0, 0.01, (1e-7, 1e-6, 1e-5)),)),
    _Law("torque_of_position", "torque with the position",
         "torque = -spring_stiffness * (angle - spring_rest)", (
        TermParameter("spring_stiffness", "N*m", 0.0, 0.05, (1e-3, 5e-3)),
        TermParameter("spring_rest", "rad", _HANGING - 2.0, _HANGING + 2.0,
                      (_HANGING, _HANGING - 0.3, _HANGING + 0.3)))),
    _Law("torque_of_rate_in_a_band", "torque with the rate near the lowest position",
         "torque = -band_damping * exp(-((angle - pi) / band_width)**2) * w", (
        TermParameter("band_damping", "N*m*s", 0.0, 0.05, (1e-4, 1e-3)),
        TermParameter("band_width", "rad", 0.05, 1.5, (0.15, 0.3, 0.7)))),
    _Law("periodic_torque", "torque that comes and goes",
         "torque = periodic_torque * sin(periodic_rate * t + periodic_phase)", (
        TermParameter("periodic_torque", "N*m", -0.02, 0.02, (5e-4, -5e-4)),
        TermParameter("periodic_rate", "rad/s", 0.3, 30.0, _RATES),
        TermParameter("periodic_phase", "rad", -7.0, 7.0, (0.0, 0.5 * math.pi)))),
    _Law("constant_torque", "steady torque", "torque = constant_torque", (
        TermParameter("constant_torque", "N*m", -0.02, 0.02, (1e-4, -1e-4, 1e-3, -1e-3)),)),
)  # fmt: skip
#: Law of the catalogue to the name of the same term in a library of torques over rate, position and history. It is
#: tried only where the catalogue is without the law: else the name tells more.
_TWINS = {
    "viscous_damping": "torque_of_rate", "coulomb_friction": "torque_of_the_sign_of_rate",
    "stiction": "torque_of_slow_rate", "quadratic_drag": "torque_of_rate_squared",
    "backlash": "memory_of_direction", "tilt": "torque_of_the_cosine_of_position",
}  # fmt: skip
#: Faults of the encoder's chain. A bias is not among them: in free swings it is what a tilt is (state `bias_bound`).
SENSOR_TERMS: Mapping[str, tuple[str, str, TermParameter]] = {
    "sensor_gain": ("gain of a sensor", "value = pi + (1 + gain) * (truth - pi)",
                    TermParameter("gain", "1", -0.3, 0.3, (0.02, -0.02), negligible=0.002)),
    "sensor_lag": ("lag of a sensor", "lag_time * d(value) = truth - value",
                   TermParameter("lag_time", "s", 0.0, 1.0, (0.005, 0.03), negligible=0.001)),
    "sensor_clock_offset": ("clock of a sensor", "value(t) = truth(t - offset)",
                            TermParameter("offset", "s", -1.0, 1.0, (0.01, -0.01), negligible=0.001)),
}  # fmt: skip


def pendulum_laws(component: str, without: Collection[str] = ()) -> list[UnitLaw]:
    """Laws of a component of kind `bullet_pendulum`, those without a name last.

    Args:
        component: Its name in the scenario.
        without: Laws that are hidden: the same torques are among those without a name.
    """
    named = [_unit_law(component, law) for law in _LAWS if law.identifier not in without]
    twins = [replace(law, identifier=_TWINS[law.identifier], name=f"law {_TWINS[law.identifier]}", confused_with={})
             for law in _LAWS if law.identifier in without]  # fmt: skip
    return named + [_unit_law(component, law, is_named=False) for law in (*_UNNAMED, *twins)]


def _unit_law(component: str, law: _Law, is_named: bool = True) -> UnitLaw:
    term = Term(law.identifier, component, "mechanical", law.parameters, is_named, law.law)
    place = ComponentTerm(term, component, tuple(p.name for p in law.parameters))
    return UnitLaw(place, law.name, "mechanics/pendulum_design.py", law.confused_with)


def sensor_laws(component: str, channels: Collection[str]) -> list[UnitLaw]:
    """Faults of the sensors of a pendulum.

    Args:
        component: Its name in the scenario.
        channels: Names of the channels.
    """
    return [
        UnitLaw(ComponentTerm(Term(identifier, channel, "measurement", (number,), law=law), component, ()), name)
        for channel in channels
        for identifier, (name, law, number) in SENSOR_TERMS.items()
    ]


def pendulum_terms(component: str) -> list[ComponentTerm]:
    """The laws of the catalogue as terms alone."""
    return [law.place for law in pendulum_laws(component) if law.place.term.is_named]
