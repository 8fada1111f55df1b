"""What a pendulum may lack, as laws that its unit can switch on."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from cosim.components import PendulumComponent
from cosim.parameters import resolve
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue
from diagnosis.candidates.sizes import EITHER_SIGN, ONE_SIGN, SMALLEST, places, signed_sizes, sizes
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
_HANGING = math.pi
#: Rates at which a periodic torque is looked for [rad/s]: the middles between the rates that go into 12 s a whole
#: number of times, up to 19 rad/s; what lies closer together 12 s cannot tell apart.
_RATES = tuple(round((n + 0.5) * 2.0 * math.pi / 12.0, 3) for n in range(2, 36))


@dataclass(frozen=True)
class Arm:
    """What the torques on an arm are compared with.

    Args:
        moment: Largest moment of its weight about the hinge [N m].
        rate: Rate of small swings [rad/s], which is also the speed of a swing of 1 rad.
    """

    moment: float
    rate: float


def arm_of(scenario: Scenario, component: str) -> Arm:
    """The arm of a scenario; one of 0.1 kg at 0.1 m where its numbers are not known (whoever assembles it says why)."""
    found, (mass, distance) = scenario.components.get(component), BENCH
    if isinstance(found, PendulumComponent):
        try:
            given = resolve(found.parameter_set, found.parameters, scenario.path or Path("scenario")).values
            quantities = [given[name] for name in ("mass", "centre_distance")]
            own = [q.to(unit) for q, unit in zip(quantities, ("kg", "m")) if isinstance(q, PhysicalValue)]
        except (InputError, KeyError, ValueError):
            own = []
        if len(own) == 2 and min(own) > 0.0:
            mass, distance = own
    return Arm(mass * _GRAVITY * distance, math.sqrt(_GRAVITY / distance))


#: Standard gravity [m/s^2].
_GRAVITY = 9.80665
#: Mass [kg] and distance of its centre from the hinge [m] of an arm for the bench.
BENCH = (0.1, 0.1)
_BENCH_ARM = Arm(BENCH[0] * _GRAVITY * BENCH[1], math.sqrt(_GRAVITY / BENCH[1]))
_DRIES_UP = "a tenth of the weight's moment lets the arm rest 6 degrees off: that is seen before a run"


#: What each number is, by its name.
_MEANINGS = {
    "coulomb_friction": "torque of dry friction",
    "viscous_damping": "torque per rate",
    "stiction": "torque of stiction at rest, beyond the dry friction",
    "stribeck_speed": "rate at which stiction has fallen to 37 %",
    "quadratic_drag": "torque per square of the rate",
    "backlash": "play from end to end",
    "tilt": "angle of the stand",
    "cubic_drag": "torque per cube of the rate",
    "spring_stiffness": "torque per angle",
    "spring_rest": "angle without torque",
    "band_damping": "torque per rate in the middle of the band",
    "band_width": "half width of the band",
    "periodic_torque": "largest torque",
    "periodic_rate": "rate of the phase",
    "periodic_phase": "phase at time 0",
    "constant_torque": "torque",
}


def _size(
    name: str, unit: str, upper: float, most: float, why: str, count: int = ONE_SIGN, lower: float = 0.0
) -> TermParameter:
    """A number that takes sizes of one sign, tried by the rule of `diagnosis.candidates.sizes`."""
    most = min(most, upper)
    return TermParameter(
        name,
        unit,
        lower,
        upper,
        _starts(most, lower, count),
        plausible=most,
        plausible_reason=why,
        meaning=_MEANINGS[name],
    )


def _starts(most: float, lower: float, count: int) -> tuple[float, ...]:
    return sizes(most, max(SMALLEST * most, lower), count)


def _signed(name: str, unit: str, upper: float, most: float, why: str, count: int = EITHER_SIGN) -> TermParameter:
    """A number of either sign."""
    most = min(most, upper)
    starts = signed_sizes(most, count=count)
    return TermParameter(
        name, unit, -upper, upper, starts, plausible=most, plausible_reason=why, meaning=_MEANINGS[name]
    )


def _laws(arm: Arm) -> tuple[_Law, ...]:
    """Laws with a name. Friction and drag take energy, so they are bounded below by 0.

    A fit that is not bounded finds the wrong sign.
    """
    moment, rate = arm.moment, arm.rate
    leans = "a stand that leans by 6 degrees is seen"
    swings = "a damping ratio of 0.15: the arm rests after two swings"
    drag = "a tenth of the weight's moment at the speed of a swing of 1 rad: a sail, no arm"
    return (
        _Law(
            "viscous_damping",
            "viscous damping of the hinge",
            "torque = -viscous_damping * w",
            (_size("viscous_damping", _DAMPING, 0.05, 0.3 * moment / rate, swings),),
            {"quadratic_drag": _AMPLITUDES, "coulomb_friction": _AMPLITUDES},
        ),
        _Law(
            "coulomb_friction",
            "dry friction of the hinge",
            "torque = -coulomb_friction * sign(w)",
            (_size("coulomb_friction", _TORQUE, 0.5, 0.1 * moment, _DRIES_UP),),
            {
                "viscous_damping": _AMPLITUDES,
                "stiction": "slow swings decide: stiction lets go above its Stribeck speed",
            },
        ),
        _Law(
            "stiction",
            "stiction of the hinge",
            "torque = -stiction * exp(-(w / stribeck_speed)**2) * sign(w)",
            (
                _size("stiction", _TORQUE, 0.5, 0.2 * moment, "at rest it is at most about twice the dry friction"),
                _size(
                    "stribeck_speed",
                    "rad/s",
                    10.0,
                    0.3 * rate,
                    "the fall with speed is over at a third of the speed of a swing; if not, it is another law",
                    4,
                    1e-3,
                ),
            ),
            {"coulomb_friction": "fast swings decide: there stiction does nothing"},
        ),
        _Law(
            "quadratic_drag",
            "drag of the air, with the square of the speed",
            "torque = -quadratic_drag * abs(w) * w",
            (_size("quadratic_drag", _DRAG, 0.05, 0.1 * moment / rate**2, drag),),
            {"viscous_damping": _AMPLITUDES},
        ),
        _Law(
            "backlash",
            "backlash between arm and encoder",
            "abs(arm - encoder) <= backlash / 2",
            (_size("backlash", "rad", 0.5, 0.1, "a play of 6 degrees is felt by hand", 2),),
            {
                "tilt": "slow turns decide: play stands still at each of them",
                "sensor_lag": "swings of different sizes decide",
            },
        ),
        _Law(
            "tilt",
            "tilt of the stand against gravity",
            "torque = weight_moment * sin(angle - tilt)",
            (_signed("tilt", "rad", 0.2, 0.1, leans),),
        ),
    )


def _unnamed(arm: Arm) -> tuple[_Law, ...]:
    """Torques without a name, over the arm's own variables; each is a number of the unit.

    A spring stores energy, so its stiffness is not negative: where it may be, a fit went astray and two other terms
    were found in its place.
    """
    moment, rate = arm.moment, arm.rate
    tenth = "a tenth of the weight's moment: no small torque"
    return (
        _Law(
            "torque_of_rate_cubed",
            "torque with the cube of the rate",
            "torque = -cubic_drag * w**3",
            (_size("cubic_drag", "N*m*s^3", 0.01, 0.1 * moment / rate**3, tenth),),
        ),
        _Law(
            "torque_of_position",
            "torque with the position",
            "torque = -spring_stiffness * (angle - spring_rest)",
            (
                _size("spring_stiffness", "N*m", 0.05, 0.3 * moment, "a third of the weight's own stiffness", 2),
                TermParameter(
                    "spring_rest",
                    "rad",
                    _HANGING - 2.0,
                    _HANGING + 2.0,
                    places(1.0, origin=_HANGING, is_signed=True),
                    meaning=_MEANINGS["spring_rest"],
                ),
            ),
        ),
        _Law(
            "torque_of_rate_in_a_band",
            "torque with the rate near the lowest position",
            "torque = -band_damping * exp(-((angle - pi) / band_width)**2) * w",
            (
                _size("band_damping", _DAMPING, 0.05, moment / rate, "it stops the arm where it hangs", 2),
                _size("band_width", "rad", 1.5, 1.0, "a wider band is the whole swing", lower=0.05),
            ),
        ),
        _Law(
            "periodic_torque",
            "torque that comes and goes",
            "torque = periodic_torque * sin(periodic_rate * t + periodic_phase)",
            (
                _signed("periodic_torque", "N*m", 0.02, 0.1 * moment, tenth, 1),
                TermParameter("periodic_rate", "rad/s", 0.3, 30.0, _RATES, meaning=_MEANINGS["periodic_rate"]),
                # A sine and a cosine together are every phase.
                TermParameter(
                    "periodic_phase", "rad", -7.0, 7.0, (0.0, 0.5 * math.pi), meaning=_MEANINGS["periodic_phase"]
                ),
            ),
        ),
        _Law(
            "constant_torque",
            "steady torque",
            "torque = constant_torque",
            (_signed("constant_torque", "N*m", 0.02, 0.1 * moment, tenth),),
        ),
    )


#: Law of the catalogue to the name of the same term in a library of torques over rate, position and history. It is
#: tried only where the catalogue is without the law: else the name tells more.
_TWINS = {
    "viscous_damping": "torque_of_rate",
    "coulomb_friction": "torque_of_the_sign_of_rate",
    "stiction": "torque_of_slow_rate",
    "quadratic_drag": "torque_of_rate_squared",
    "backlash": "memory_of_direction",
    "tilt": "torque_of_the_cosine_of_position",
}
#: Faults of the encoder's chain. A bias is not among them: in free swings it is what a tilt is (state `bias_bound`).
SENSOR_TERMS: Mapping[str, tuple[str, str, TermParameter]] = {
    "sensor_gain": (
        "gain of a sensor",
        "value = pi + (1 + gain) * (truth - pi)",
        TermParameter(
            "gain",
            "1",
            -0.3,
            0.3,
            signed_sizes(0.1, 0.002, 1),
            negligible=0.002,
            plausible=0.1,
            plausible_reason="an encoder read with another count is off by far more",
            meaning="change of the sensor's factor: 0.01 reads 1 % too much",
        ),
    ),
    "sensor_lag": (
        "lag of a sensor",
        "lag_time * d(value) = truth - value",
        TermParameter(
            "lag_time",
            "s",
            0.0,
            1.0,
            sizes(0.1, 0.001, 2),
            negligible=0.001,
            plausible=0.1,
            plausible_reason="an encoder with a filter of 0.1 s no longer follows a swing",
            meaning="time constant of the sensor",
        ),
    ),
    "sensor_clock_offset": (
        "clock of a sensor",
        "value(t) = truth(t - offset)",
        TermParameter(
            "offset",
            "s",
            -1.0,
            1.0,
            signed_sizes(0.5, 0.001, 1),
            negligible=0.001,
            plausible=0.5,
            plausible_reason="a hand starts two clocks within 0.5 s",
            meaning="time by which the clock is late",
        ),
    ),
}


def pendulum_laws(component: str, without: Collection[str] = (), arm: Arm = _BENCH_ARM) -> list[UnitLaw]:
    """Laws of a component of kind `bullet_pendulum`, those without a name last.

    Args:
        component: Its name in the scenario.
        without: Laws that are hidden: the same torques are among those without a name.
        arm: What torques are compared with.
    """
    laws = _laws(arm)
    named = [_unit_law(component, law) for law in laws if law.identifier not in without]
    twins = [
        replace(law, identifier=_TWINS[law.identifier], name=f"law {_TWINS[law.identifier]}", confused_with={})
        for law in laws
        if law.identifier in without
    ]
    return named + [_unit_law(component, law, is_named=False) for law in (*_unnamed(arm), *twins)]


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
