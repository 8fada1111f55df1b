"""Seventh set: a propeller arm, a boost converter, a syringe, two rooms, a geared arm, a piezo stage, a vessel, a cell.

Written without a look at the library of laws, its proof, its tests or its thresholds; of what was reported on the
earlier sets, the author had seen the tables of verdicts. Truths are integrated by scipy from equations that stand here.
How large an effect is, and how far the numbers are off, is drawn; the deviations of the numbers are those that a
parameter set states.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.fifth_set import FOUR, FOUR_SPLIT, GRAVITY, WATER, integrated
from evaluation.strangers.first_set import FOLDERS, PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, data_sheet, fahrenheit, scaled
from evaluation.strangers.lab import Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.sixth_set import resting
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.truth import FINE, OPEN, PHYSICS, RECORDING, SENSOR, Truth

#: Degrees in a radian.
DEGREES = 180.0 / np.pi


def clocked(
    state: int, factor: float, times: Array, states: Array, fast: float
) -> Callable[[Array, Array, Array], Array]:
    """Reading of a state by a logger whose clock runs fast: what it calls t happened at (1 - fast) t."""
    return lambda t, x, u: np.asarray(factor * np.interp((1.0 - fast) * t, times, states[:, state]))


# --- an arm lifted by a propeller, FMI 3 Model Exchange; deg, deg/s; two tables
HELI = OdeModel(
    "heli",
    {
        "J": (0.012, "kg*m^2"),
        "m": (0.14, "kg"),
        "g": (GRAVITY, "m/s^2"),
        "r": (0.25, "m"),
        "b": (0.016, "N*m*s/rad"),
        "k": (0.12, "N/V"),
        "l": (0.25, "m"),
        "tau": (0.11, "s"),
    },
    {"voltage": "V"},
    {
        "phi": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "(l*F - m*g*r*sin(phi) - b*w)/J"),
        "F": ("N", "0.0", "(k*voltage - F)/tau"),
    },
    {"angle": ("rad", "phi"), "rate": ("rad/s", "w")},
    1e-3,
)
HELI_KNOWN = {"J": 0.04, "m": 0.02, "b": 0.08, "k": 0.05, "tau": 0.08}


def _heli(
    folder: Path,
    rng: Rng,
    friction: float = 0.0,
    fast: float = 0.0,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
) -> None:
    """The bearing may have a friction torque, `friction` N m, reached within 0.04 rad/s; one clock may run fast."""
    build3(HELI, folder, has_co_simulation=False)
    stop = 40.0
    parts = programme("driver", ("voltage", "V")) + with_numbers("arm", "heli")
    scenario(folder, "An arm with a propeller", stop, 0.02, 0.02, parts, "  - driver.voltage -> arm.voltage\n")
    data_sheet(folder, HELI, HELI_KNOWN)
    inertia, m, g, r, b, k, lever, tau = drawn(rng, HELI, HELI_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        phi, w, thrust = (float(s) for s in x)
        torque = lever * thrust - m * g * r * np.sin(phi) - b * w - friction * np.tanh(w / 0.04)
        return [w, torque / inertia, (k * float(u[0]) - thrust) / tau]

    for name in FOLDERS:
        voltage = drawn_steps(rng, stop, 1.4, 0.5, 8.0, 0.02)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (voltage,), stop, 0.01)
        angle = clocked(0, DEGREES, t, x, fast if name == "second" else 0.0)
        sensors = [
            Sensor("arm.angle", "encoder_deg", "deg", angle, 0.3, 0.04, noise_stated, 0.1),
            Sensor("arm.rate", "gyro_dps", "deg/s", scaled(1, DEGREES), 2.0, 0.02, noise_stated, 0.1),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"driver.voltage": (voltage, "V")}, logger))


def heli_null(folder: Path, rng: Rng) -> Truth:
    _heli(folder, rng, noise_stated=None, logger=Logger("ms", zero=86400.0, jitter=0.12))
    return Truth("nothing; numbers off as stated, noise is not stated, jitter, the clock begins at 86400 ms", FINE)


def heli_pivot(folder: Path, rng: Rng) -> Truth:
    friction = rng.uniform(5e-3, 9e-3)
    _heli(folder, rng, friction=friction)
    return Truth(
        f"dry friction of the pivot, {friction:.5f} N m, reached within 0.04 rad/s",
        PHYSICS,
        ("dry_friction", "coulomb_friction", "stribeck_friction"),
    )


def heli_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(0.004, 0.008)
    _heli(folder, rng, fast=fast)
    return Truth(
        f"the clock of the encoder's table runs {100 * fast:.2f} % fast in the second recording", (*RECORDING, *SENSOR)
    )


# --- a boost converter, averaged over a switching period, FMI 2 Model Exchange; V, A, ms
BOOST = OdeModel(
    "boost",
    {
        "L": (0.01, "H"),
        "R": (0.45, "ohm"),
        "C": (2.2e-4, "F"),
        "supply": (12.0, "V"),
        "load": (25.0, "ohm"),
    },
    {"duty": "", "drain": "A"},
    {
        "i": ("A", "0.8", "(supply - R*i - (1.0 - duty)*v)/L"),
        "v": ("V", "12.0", "((1.0 - duty)*i - v/load - drain)/C"),
    },
    {"current": ("A", "i"), "voltage": ("V", "v")},
    2e-5,
)
BOOST_KNOWN = {"L": 0.06, "R": 0.08, "C": 0.06, "load": 0.03}


def _boost(
    folder: Path,
    rng: Rng,
    drop: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    quantum: float = 0.01,
    logger: Logger | None = None,
) -> None:
    """Four runs; the diode may take a voltage, `drop` V, while it conducts; one run may state another one's duty."""
    BOOST.build(folder)
    stop = 0.8
    parts = programme("modulator", ("duty", "")) + programme("sink", ("drain", "A")) + with_numbers("rig", "boost")
    wires = "  - modulator.duty -> rig.duty\n  - sink.drain -> rig.drain\n"
    scenario(folder, "A boost converter", stop, 4e-4, 4e-4, parts, wires)
    data_sheet(folder, BOOST, BOOST_KNOWN)
    inductance, r, c, supply, load = drawn(rng, BOOST, BOOST_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        i, v, off = float(x[0]), float(x[1]), 1.0 - float(u[0])
        return [
            (supply - r * i - off * (v + drop * np.tanh(i / 0.05))) / inductance,
            (off * i - v / load - float(u[1])) / c,
        ]

    other = drawn_steps(rng, stop, 0.03, 0.25, 0.55, 4e-4)
    for name in FOUR:
        duty = drawn_steps(rng, stop, 0.03, 0.25, 0.55, 4e-4)
        drain = drawn_steps(rng, stop, 0.05, 0.0, 0.6, 4e-4)
        t, x = integrated(rates, (0.8, 12.0), (duty, drain), stop, 2e-4)
        sensors = [
            Sensor("rig.current", "I_L", "A", scaled(0, 1.0), 0.025, 4e-4, noise_stated, quantum / 2),
            Sensor("rig.voltage", "U_out", "V", scaled(1, 1.0), 0.1, 4e-4, noise_stated, quantum),
        ]
        told = {"modulator.duty": other} if is_other and name == "second" else {}
        programmes = {"modulator.duty": (duty, ""), "sink.drain": (drain, "A")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger or Logger("ms"), told=told))


def boost_null(folder: Path, rng: Rng) -> Truth:
    _boost(folder, rng, noise_stated=1.7, quantum=0.1, logger=Logger("ms", zero=-20.0))
    return Truth(
        "nothing; numbers off as stated, noise stated 1.7 times too large, coarse converters, the clock begins at "
        "-20 ms",
        FINE,
        **FOUR_SPLIT,
    )


def boost_diode(folder: Path, rng: Rng) -> Truth:
    drop = rng.uniform(0.55, 0.9)
    _boost(folder, rng, drop=drop)
    return Truth(
        f"the diode takes {drop:.3f} V, reached within 0.05 A",
        PHYSICS,
        ("contact_drop", "diode_drop", "voltage_drop"),
        **FOUR_SPLIT,
    )


def boost_other_run(folder: Path, rng: Rng) -> Truth:
    _boost(folder, rng, is_other=True)
    return Truth("the second recording states the duty of another run", RECORDING, **FOUR_SPLIT)


# --- a syringe pump, a compliant tube and a needle, FMI 2 Co-Simulation or Model Exchange; mL/min, mbar
SYRINGE = OdeModel(
    "syringe",
    {
        "C1": (1.5e-11, "m^3/Pa"),
        "C2": (5e-11, "m^3/Pa"),
        "R1": (2.5e10, "Pa*s/m^3"),
        "R2": (6e10, "Pa*s/m^3"),
    },
    {"flow": "m^3/s"},
    {
        "p1": ("Pa", "0.0", "(flow - (p1 - p2)/R1)/C1"),
        "p2": ("Pa", "0.0", "((p1 - p2)/R1 - p2/R2)/C2"),
    },
    {"pressure": ("Pa", "p1"), "delivery": ("m^3/s", "p2/R2")},
    0.01,
)
SYRINGE_KNOWN = {"C1": 0.08, "C2": 0.06, "R1": 0.05, "R2": 0.03}
#: Millimetres of mercury in a millibar.
MERCURY = 0.750062


def _syringe(
    folder: Path,
    rng: Rng,
    stiffening: float = 0.0,
    in_mercury: bool = False,
    grid: float = 0.05,
    is_recorded: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
    integrator: str = "cvode",
) -> None:
    """The tube may become stiffer with its pressure: C2/(1 + stiffening p2), `stiffening` in 1/Pa."""
    SYRINGE.build(folder)
    stop = 120.0
    parts = programme("pump", ("flow", "mL/min")) + with_numbers("line", "syringe", integrator)
    scenario(folder, "A syringe pump and its line", stop, 0.05, 0.1, parts, "  - pump.flow -> line.flow\n")
    data_sheet(folder, SYRINGE, SYRINGE_KNOWN)
    c1, c2, r1, r2 = drawn(rng, SYRINGE, SYRINGE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        p1, p2 = float(x[0]), float(x[1])
        through = (p1 - p2) / r1
        return [
            (float(u[0]) / 6e7 - through) / c1,
            (through - p2 / r2) / c2 * (1.0 + stiffening * p2),
        ]

    factor = 0.01 * (MERCURY if in_mercury else 1.0)
    for name in FOLDERS:
        flow = drawn_steps(rng, stop, 5.0, 0.0, 24.0, grid)
        t, x = integrated(rates, (0.0, 0.0), (flow,), stop, 0.05)
        sensors = [
            Sensor("line.pressure", "p_mbar", "mbar", scaled(0, factor), 1.0, 0.2, noise_stated, 0.1),
            Sensor("line.delivery", "q_mL_min", "mL/min", scaled(1, 6e7 / r2), 0.1, 0.2, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"pump.flow": (flow, "mL/min")},
            logger,
            recorded=["pump.flow"] if is_recorded else [],
        )
        write(folder / name, rng, made)


def syringe_null(folder: Path, rng: Rng) -> Truth:
    logger = Logger("min", zero=3.5, is_comma=True)
    _syringe(folder, rng, is_recorded=True, noise_stated=None, logger=logger, integrator="internal")
    return Truth(
        "nothing; numbers off as stated, noise is not stated, decimal commas, minutes from 3.5 min, Co-Simulation; the "
        "flow changes on a grid of 0.05 s and is logged each 0.2 s",
        FINE,
    )


def syringe_tubing(folder: Path, rng: Rng) -> Truth:
    stiffening = rng.uniform(6e-5, 1e-4)
    _syringe(folder, rng, stiffening=stiffening)
    return Truth(f"the tube becomes stiffer with its pressure: C2/(1 + {stiffening:.3e} 1/Pa p2)", PHYSICS)


def syringe_mercury(folder: Path, rng: Rng) -> Truth:
    _syringe(folder, rng, in_mercury=True)
    return Truth("the pressure is logged in mmHg and stated as mbar, in all recordings", (*RECORDING, *SENSOR))


# --- two rooms, one with a radiator, FMI 3 Model Exchange; degC, min; power and outdoors are columns
ROOMS = OdeModel(
    "rooms",
    {
        "C_rad": (3e4, "J/K"),
        "C_a": (6e5, "J/K"),
        "C_b": (5e5, "J/K"),
        "U_rad": (30.0, "W/K"),
        "U_ab": (25.0, "W/K"),
        "U_ao": (22.0, "W/K"),
        "U_bo": (18.0, "W/K"),
        "T_begin": (291.15, "K"),
    },
    {"power": "W", "outdoors": "K"},
    {
        "T_rad": ("K", "T_begin", "(power - U_rad*(T_rad - T_a))/C_rad"),
        "T_a": ("K", "T_begin", "(U_rad*(T_rad - T_a) - U_ab*(T_a - T_b) - U_ao*(T_a - outdoors))/C_a"),
        "T_b": ("K", "T_begin", "(U_ab*(T_a - T_b) - U_bo*(T_b - outdoors))/C_b"),
    },
    {"radiator": ("K", "T_rad"), "living": ("K", "T_a"), "bed": ("K", "T_b")},
    2.0,
)
ROOMS_KNOWN = {"C_rad": 0.06, "C_a": 0.06, "C_b": 0.06, "U_rad": 0.05, "U_ab": 0.08, "U_ao": 0.05, "U_bo": 0.05}


def _rooms(
    folder: Path,
    rng: Rng,
    exponent: float = 1.0,
    door: float = 0.0,
    furniture: float = 0.0,
    is_exchanged: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger | None = None,
) -> None:
    """Emission may grow with a power of the excess, being U_rad times it at 25 K; `door` is in W/K^1.5.

    Furniture of the heated room, `furniture` J/K, takes 20 W/K from its air.
    """
    build3(ROOMS, folder, has_co_simulation=False)
    stop = 86400.0
    parts = (
        programme("boiler", ("power", "W"))
        + resting(programme("weather", ("outdoors", "K")), "278.15 K")
        + with_numbers("house", "rooms")
    )
    wires = "  - boiler.power -> house.power\n  - weather.outdoors -> house.outdoors\n"
    scenario(folder, "Two rooms and a radiator", stop, 30, 60, parts, wires)
    data_sheet(folder, ROOMS, ROOMS_KNOWN)
    c_rad, c_a, c_b, u_rad, u_ab, u_ao, u_bo, begin = drawn(rng, ROOMS, ROOMS_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        radiator, living, bed, solid = (float(s) for s in x)
        power, outdoors = float(u[0]), float(u[1])
        over, across = radiator - living, living - bed
        emitted = u_rad * over * (abs(over) / 25.0 + 1e-9) ** (exponent - 1.0)
        through = u_ab * across + door * across * np.sqrt(abs(across))
        stored = 20.0 * (living - solid) if furniture else 0.0
        return [
            (power - emitted) / c_rad,
            (emitted - through - u_ao * (living - outdoors) - stored) / c_a,
            (through - u_bo * (bed - outdoors)) / c_b,
            stored / furniture if furniture else 0.0,
        ]

    for name in FOLDERS:
        power = drawn_steps(rng, stop, 5400.0, 0.0, 1200.0, 60.0)
        outdoors = drawn_steps(rng, stop, 9000.0, 271.0, 285.0, 60.0)
        t, x = integrated(rates, [begin] * 4, (power, outdoors), stop, 30.0)
        one, two = (2, 1) if is_exchanged and name == "second" else (1, 2)
        sensors = [
            Sensor("house.radiator", "T_radiator", "degC", celsius(0), 0.3, 60.0, noise_stated, 0.1),
            Sensor("house.living", "T_living", "degC", celsius(one), 0.15, 60.0, noise_stated, 0.1),
            Sensor("house.bed", "T_bed", "degC", celsius(two), 0.15, 60.0, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"boiler.power": (power, "W"), "weather.outdoors": (outdoors, "K")},
            logger or Logger("min"),
            recorded=["boiler.power", "weather.outdoors"],
        )
        write(folder / name, rng, made)


def rooms_null(folder: Path, rng: Rng) -> Truth:
    _rooms(folder, rng, noise_stated=0.6, logger=Logger("h", gap=(30000.0, 35000.0)))
    return Truth(
        "nothing; numbers off as stated, noise stated 1.7 times too small, a gap of 83 min, hours", (*FINE, *OPEN)
    )


def rooms_emission(folder: Path, rng: Rng) -> Truth:
    exponent = rng.uniform(1.25, 1.35)
    _rooms(folder, rng, exponent=exponent)
    return Truth(
        f"the radiator emits with the power {exponent:.3f} of its excess over the room",
        PHYSICS,
        ("natural_convection", "convection", "radiation"),
    )


def rooms_two(folder: Path, rng: Rng) -> Truth:
    door, furniture = rng.uniform(5.0, 9.0), rng.uniform(3e5, 5e5)
    _rooms(folder, rng, door=door, furniture=furniture)
    return Truth(
        f"air through the open door carries {door:.2f} W/K^1.5 times the power 1.5 of the difference between the "
        f"rooms, and furniture of {furniture:.3g} J/K takes 20 W/K from the air of the heated one",
        PHYSICS,
        ("natural_convection", "convection", "second_mass", "thermal_mass", "hidden_mass"),
    )


def rooms_exchanged(folder: Path, rng: Rng) -> Truth:
    _rooms(folder, rng, is_exchanged=True)
    return Truth("the thermometers of the two rooms are exchanged, in the second recording", RECORDING)


# --- a motor with brushes, a gearbox and a flexible arm, FMI 2 Model Exchange; rpm, deg/s, A
ARM = OdeModel(
    "geared",
    {
        "L": (0.015, "H"),
        "R": (1.8, "ohm"),
        "ke": (0.045, "V*s/rad"),
        "J1": (2e-5, "kg*m^2"),
        "b1": (1e-5, "N*m*s/rad"),
        "n": (20.0, ""),
        "k": (6.0, "N*m/rad"),
        "d": (0.03, "N*m*s/rad"),
        "J2": (0.02, "kg*m^2"),
        "b2": (0.02, "N*m*s/rad"),
    },
    {"voltage": "V"},
    {
        "i": ("A", "0.0", "(voltage - R*i - ke*w1)/L"),
        "w1": ("rad/s", "0.0", "(ke*i - b1*w1 - (k*twist + d*(w1/n - w2))/n)/J1"),
        "twist": ("rad", "0.0", "w1/n - w2"),
        "w2": ("rad/s", "0.0", "(k*twist + d*(w1/n - w2) - b2*w2)/J2"),
    },
    {"current": ("A", "i"), "motor": ("rad/s", "w1"), "arm": ("rad/s", "w2")},
    5e-4,
)
ARM_KNOWN = {"L": 0.08, "R": 0.05, "ke": 0.03, "J1": 0.06, "k": 0.06, "d": 0.08, "J2": 0.04, "b2": 0.08}


def _arm(
    folder: Path,
    rng: Rng,
    drop: float = 0.0,
    friction: float = 0.0,
    hardening: float = 0.0,
    stronger: tuple[float, float, float] | None = None,
    every: Sequence[float] = (8e-3, 8e-3, 8e-3),
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
) -> None:
    """Brushes may take `drop` V, the motor's bearings `friction` N m; torque of the arm k (twist + hardening twist^3).

    `stronger` is begin [s], end [s] and factor of the voltage in the second recording.
    """
    ARM.build(folder)
    stop = 12.0
    parts = programme("amplifier", ("voltage", "V")) + with_numbers("joint", "geared")
    scenario(folder, "A flexible arm on a gearbox", stop, 4e-3, 4e-3, parts, "  - amplifier.voltage -> joint.voltage\n")
    data_sheet(folder, ARM, ARM_KNOWN)
    inductance, r, ke, j1, b1, n, k, d, j2, b2 = drawn(rng, ARM, ARM_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        i, w1, twist, w2 = (float(s) for s in x)
        slip = w1 / n - w2
        torque = k * (twist + hardening * twist**3) + d * slip
        return [
            (float(u[0]) - r * i - drop * np.tanh(i / 0.1) - ke * w1) / inductance,
            (ke * i - b1 * w1 - friction * np.tanh(w1 / 1.5) - torque / n) / j1,
            slip,
            (torque - b2 * w2) / j2,
        ]

    for name, interval in zip(FOLDERS, every, strict=True):
        stated = drawn_steps(rng, stop, 0.6, -12.0, 12.0, 4e-3)
        voltage = stated
        if stronger is not None and name == "second":
            voltage = between(stated, stronger[0], stronger[1], lambda v: stronger[2] * v)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (voltage,), stop, 2e-3)
        sensors = [
            Sensor("joint.current", "I_A", "A", scaled(0, 1.0), 0.04, interval, noise_stated, 0.01),
            Sensor("joint.motor", "n_rpm", "rpm", scaled(1, 30.0 / np.pi), 15.0, interval, noise_stated, 1.0),
            Sensor("joint.arm", "gyro_dps", "deg/s", scaled(3, DEGREES), 4.0, interval, noise_stated, 0.5),
        ]
        told = {} if voltage is stated else {"amplifier.voltage": stated}
        write(folder / name, rng, Written(t, x, sensors, {"amplifier.voltage": (voltage, "V")}, logger, told=told))


def arm_null(folder: Path, rng: Rng) -> Truth:
    _arm(folder, rng, every=(4e-3, 8e-3, 12e-3), noise_stated=None, logger=Logger("ms", empty=0.02))
    return Truth(
        "nothing; numbers off as stated, noise is not stated, read each 4, 8 and 12 ms in the three recordings, empty "
        "cells, rpm",
        FINE,
    )


def arm_brushes(folder: Path, rng: Rng) -> Truth:
    drop = rng.uniform(0.5, 0.9)
    _arm(folder, rng, drop=drop)
    return Truth(
        f"the brushes take {drop:.3f} V, reached within 0.1 A",
        PHYSICS,
        ("contact_drop", "brush_drop", "voltage_drop"),
    )


def arm_two(folder: Path, rng: Rng) -> Truth:
    friction, hardening = rng.uniform(5e-3, 9e-3), rng.uniform(3.0, 6.0)
    _arm(folder, rng, friction=friction, hardening=hardening)
    return Truth(
        f"dry friction at the motor, {friction:.5f} N m, reached within 1.5 rad/s, and an arm that hardens: "
        f"k (twist + {hardening:.2f} twist^3)",
        PHYSICS,
        ("dry_friction", "coulomb_friction", "stribeck_friction", "cubic_spring", "cubic_stiffness", "hardening"),
    )


def arm_stronger(folder: Path, rng: Rng) -> Truth:
    begin, factor = 0.2 * round(rng.uniform(15.0, 35.0)), rng.uniform(1.08, 1.15)
    _arm(folder, rng, stronger=(begin, begin + 3.0, factor))
    return Truth(
        f"the voltage was {factor:.3f} times what is stated, {begin:g} s to {begin + 3.0:g} s of the second recording",
        SENSOR,
        ("input_fault",),
    )


# --- a piezo stage on flexures, FMI 3, both interfaces; um, V, ms
PIEZO = OdeModel(
    "piezo",
    {
        "w0": (750.0, "rad/s"),
        "zeta": (0.06, ""),
        "gain": (1.8e-6, "m/V"),
        "tau": (2e-3, "s"),
    },
    {"command": "V"},
    {
        "y": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "w0*w0*(gain*a - y) - 2.0*zeta*w0*v"),
        "a": ("V", "0.0", "(command - a)/tau"),
    },
    {"position": ("m", "y"), "monitor": ("V", "a")},
    1e-4,
)
PIEZO_KNOWN = {"w0": 0.03, "zeta": 0.08, "gain": 0.04, "tau": 0.06}


def _piezo(
    folder: Path,
    rng: Rng,
    hysteresis: float = 0.0,
    stuck: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    logger: Logger | None = None,
) -> None:
    """The charge may lag behind the voltage by up to `hysteresis` V (Bouc-Wen); `stuck` is begin and end [s]."""
    build3(PIEZO, folder)
    stop = 1.0
    parts = programme("controller", ("command", "V")) + with_numbers("stage", "piezo")
    scenario(folder, "A piezo stage", stop, 5e-4, 5e-4, parts, "  - controller.command -> stage.command\n")
    data_sheet(folder, PIEZO, PIEZO_KNOWN)
    w0, zeta, gain, tau = drawn(rng, PIEZO, PIEZO_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Position is in um."""
        y, v, a, h = (float(s) for s in x)
        rise = (float(u[0]) - a) / tau
        lag = 0.6 * (hysteresis * rise - 0.6 * abs(rise) * h - 0.4 * rise * abs(h)) if hysteresis else 0.0
        return [v, w0**2 * (1e6 * gain * (a - h) - y) - 2.0 * zeta * w0 * v, rise, lag]

    for name in FOLDERS:
        command = drawn_steps(rng, stop, 0.025, 0.0, 10.0, 5e-4)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (command,), stop, 2.5e-4)
        sensors = [
            Sensor("stage.position", "probe_um", "um", scaled(0, 1.0), 0.05, 5e-4, noise_stated, 0.01),
            Sensor("stage.monitor", "monitor_V", "V", scaled(2, 1.0), 0.02, 5e-4, noise_stated, 0.005),
        ]

        def spoil(column: str, t: Array, v: Array, name: str = name) -> Array:
            if stuck is None or name != "second" or column != "probe_um":
                return v
            inside = (t >= stuck[0]) & (t < stuck[1])
            return np.where(inside, v[int(np.argmax(inside))], v)

        programmes = {"controller.command": (command, "V")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger or Logger("ms"), spoil=spoil))


def piezo_null(folder: Path, rng: Rng) -> Truth:
    _piezo(folder, rng, noise_stated=1.4, logger=Logger("s", zero=2.0, empty=0.04))
    return Truth(
        "nothing; numbers off as stated, noise stated 1.4 times too large, empty cells, the clock begins at 2 s", FINE
    )


def piezo_hysteresis(folder: Path, rng: Rng) -> Truth:
    hysteresis = rng.uniform(0.25, 0.45)
    _piezo(folder, rng, hysteresis=hysteresis)
    return Truth(
        f"hysteresis of the ceramic (Bouc-Wen), at most {hysteresis:.3f} V of the command",
        PHYSICS,
        ("hysteresis", "bouc_wen"),
    )


def piezo_stuck(folder: Path, rng: Rng) -> Truth:
    begin = 0.01 * round(rng.uniform(25.0, 60.0))
    _piezo(folder, rng, stuck=(begin, begin + 0.15))
    return Truth(
        f"the position sensor repeats one reading from {begin:.2f} s to {begin + 0.15:.2f} s of the second recording",
        SENSOR,
    )


# --- a stirred vessel in a heated and cooled jacket, FMI 2 Model Exchange; degC, degF, kg/min
JACKET = OdeModel(
    "jacket",
    {
        "C_j": (1.2e4, "J/K"),
        "C": (2.5e4, "J/K"),
        "UA": (45.0, "W/K"),
        "U_j": (7.0, "W/K"),
        "U": (2.5, "W/K"),
        "cp": (WATER, "J/(kg*K)"),
        "T_in": (285.15, "K"),
        "T_room": (294.15, "K"),
        "T_begin": (294.15, "K"),
    },
    {"power": "W", "coolant": "kg/s"},
    {
        "T_j": (
            "K",
            "T_begin",
            "(power - UA*(T_j - T_v) - coolant*cp*(T_j - T_in) - U_j*(T_j - T_room))/C_j",
        ),
        "T_v": ("K", "T_begin", "(UA*(T_j - T_v) - U*(T_v - T_room))/C"),
    },
    {"jacket": ("K", "T_j"), "vessel": ("K", "T_v")},
    0.5,
)
JACKET_KNOWN = {"C_j": 0.06, "C": 0.04, "UA": 0.06, "U_j": 0.08, "U": 0.08}


def _jacket(
    folder: Path,
    rng: Rng,
    viscous: float = 0.0,
    is_misread: bool = False,
    in_fahrenheit: bool = False,
    is_recorded: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
) -> None:
    """Four runs; heat transfer may improve as the content thins: UA (1 + viscous (T - 294.15 K)), in 1/K.

    The jacket's thermometer may be in degF, and stated so, or in one recording in degF and stated as degC.
    """
    JACKET.build(folder)
    stop = 9000.0
    parts = (
        programme("heater", ("power", "W"))
        + programme("valve", ("coolant", "kg/min"))
        + with_numbers("vessel", "jacket")
    )
    wires = "  - heater.power -> vessel.power\n  - valve.coolant -> vessel.coolant\n"
    scenario(folder, "A vessel in a jacket", stop, 4, 12, parts, wires)
    data_sheet(folder, JACKET, JACKET_KNOWN)
    c_j, c, ua, u_j, u_v, cp, inlet, room, begin = drawn(rng, JACKET, JACKET_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        jacket, vessel = float(x[0]), float(x[1])
        power, coolant = float(u[0]), float(u[1]) / 60.0
        through = ua * (1.0 + viscous * (vessel - 294.15)) * (jacket - vessel)
        return [
            (power - through - coolant * cp * (jacket - inlet) - u_j * (jacket - room)) / c_j,
            (through - u_v * (vessel - room)) / c,
        ]

    for name in FOUR:
        power = drawn_steps(rng, stop, 900.0, 0.0, 3000.0, 4.0)
        coolant = drawn_steps(rng, stop, 900.0, 0.15, 0.9, 4.0)
        t, x = integrated(rates, (begin, begin), (power, coolant), stop, 4.0)
        is_other = in_fahrenheit or (is_misread and name == "second")
        reading, unit, factor = fahrenheit(0) if is_other else celsius(0), "degC", 1.0
        if in_fahrenheit:
            unit, factor = "degF", 1.8
        sensors = [
            Sensor("vessel.jacket", "T_jacket", unit, reading, 0.15 * factor, 12.0, noise_stated, 0.1),
            Sensor("vessel.vessel", "T_content", "degC", celsius(1), 0.1, 12.0, noise_stated, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"heater.power": (power, "W"), "valve.coolant": (coolant, "kg/min")},
            logger,
            recorded=["heater.power", "valve.coolant"] if is_recorded else [],
        )
        write(folder / name, rng, made)


def jacket_null(folder: Path, rng: Rng) -> Truth:
    _jacket(folder, rng, in_fahrenheit=True, is_recorded=True, logger=Logger("min", zero=615.0))
    return Truth(
        "nothing; numbers off as stated, degF beside degC, the clock begins at 615 min; inputs change on a grid of 4 s "
        "and are logged each 12 s",
        FINE,
        **FOUR_SPLIT,
    )


def jacket_viscous(folder: Path, rng: Rng) -> Truth:
    viscous = rng.uniform(0.018, 0.028)
    _jacket(folder, rng, viscous=viscous)
    return Truth(
        f"heat transfer improves as the content thins: UA (1 + {viscous:.5f} 1/K (T - 294.15 K))", PHYSICS, **FOUR_SPLIT
    )


def jacket_misread(folder: Path, rng: Rng) -> Truth:
    _jacket(folder, rng, is_misread=True)
    return Truth(
        "the jacket's thermometer is logged in degF and stated as degC, in the second recording",
        (*RECORDING, *SENSOR),
        **FOUR_SPLIT,
    )


# --- a supercapacitor of two branches and its case (Zubieta and Bonert 2000), FMI 3 Co-Simulation, without units; V, K
SUPERCAP = OdeModel(
    "supercap",
    {
        "C1": (60.0, ""),
        "C2": (12.0, ""),
        "R1": (0.03, ""),
        "R2": (4.0, ""),
        "C_case": (25.0, ""),
        "U_case": (0.09, ""),
        "v_begin": (1.3, ""),
    },
    {"current": ""},
    {
        "v1": ("", "v_begin", "(current - (v1 - v2)/R2)/C1"),
        "v2": ("", "v_begin", "(v1 - v2)/(R2*C2)"),
        "warm": ("", "0.0", "(R1*current*current - U_case*warm)/C_case"),
    },
    {"terminals": ("", "v1 + R1*current"), "case": ("", "warm")},
    0.1,
)
SUPERCAP_KNOWN = {"C1": 0.04, "C2": 0.08, "R1": 0.05, "R2": 0.08, "C_case": 0.06, "U_case": 0.06}


def cycling(rng: Rng, stop: float, dwell: float, low: float, high: float, room: float, grid: float) -> Steps:
    """Currents of random sizes for random times on a grid [s], with such signs that the charge stays within `room` [C].

    A current that would lead further than that from the begin goes the other way, and is smaller if need be.
    """
    times, levels, t, charge = [0.0], [0.0], grid * round(dwell / grid), 0.0
    while t < stop - dwell / 4:
        length = grid * round(rng.uniform(0.5, 1.5) * dwell / grid)
        level = float(rng.uniform(low, high) * rng.choice([-1.0, 1.0]))
        if abs(charge + level * length) > room:
            away = 1.0 if charge >= 0.0 else -1.0
            level = -away * min(abs(level), (room + abs(charge)) / length)
        times.append(t)
        levels.append(float(f"{level:.3g}"))
        charge += levels[-1] * length
        t += length
    return Steps(tuple(times), tuple(levels))


def _supercap(
    folder: Path,
    rng: Rng,
    rise: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
) -> None:
    """The first capacity may rise with its voltage, `rise` per volt from 1.3 V; the programme may be the scenario's."""
    build3(SUPERCAP, folder, has_exchange=False)
    stop = 1500.0

    def played() -> Steps:
        return cycling(rng, stop, 12.0, 1.5, 8.0, 60.0, 0.5)

    written, real = played(), played()
    parts = programme("cycler", ("current", ""))
    if is_other:
        points = ", ".join(f"[{t:.10g} s, {v:.10g}]" for t, v in zip(written.times, written.levels))
        parts = f'  cycler:\n    kind: programme\n    outputs:\n      current: {{unit: "1", points: [{points}]}}\n'
    parts += with_numbers("cap", "supercap", "internal")
    scenario(folder, "A supercapacitor", stop, 0.5, 0.5, parts, "  - cycler.current -> cap.current\n")
    data_sheet(folder, SUPERCAP, SUPERCAP_KNOWN)
    c1, c2, r1, r2, c_case, u_case, begin = drawn(rng, SUPERCAP, SUPERCAP_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        v1, v2, warm = (float(s) for s in x)
        i, across = float(u[0]), (v1 - v2) / r2
        return [
            (i - across) / (c1 * (1.0 + rise * (v1 - 1.3))),
            across / c2,
            (r1 * i * i - u_case * warm) / c_case,
        ]

    for name in FOLDERS:
        current = real if is_other else played()
        t, x = integrated(rates, (begin, begin, 0.0), (current,), stop, 0.5)

        def terminals(t: Array, x: Array, u: Array, current: Steps = current) -> Array:
            return np.asarray(x[:, 0] + r1 * current.at(t))

        sensors = [
            Sensor("cap.terminals", "U_V", "1", terminals, 6e-3, 1.0, noise_stated, 1e-3),
            Sensor("cap.case", "dT_K", "1", scaled(2, 1.0), 0.1, 5.0, noise_stated, 0.05),
        ]
        programmes = {} if is_other else {"cycler.current": (current, "")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger))


def supercap_null(folder: Path, rng: Rng) -> Truth:
    _supercap(folder, rng, noise_stated=2.0, logger=Logger("min", zero=30.0, gap=(600.0, 660.0)))
    return Truth(
        "nothing; numbers off as stated, no units, noise stated 2 times too large, a gap of 1 min, the clock begins at "
        "30 min",
        FINE,
    )


def supercap_capacity(folder: Path, rng: Rng) -> Truth:
    rise = rng.uniform(0.15, 0.3)
    _supercap(folder, rng, rise=rise)
    return Truth(f"the first capacity rises with its voltage: C1 (1 + {rise:.3f}/V (v1 - 1.3 V))", PHYSICS)


def supercap_programme(folder: Path, rng: Rng) -> Truth:
    _supercap(folder, rng, is_other=True)
    return Truth(
        "the scenario states a programme that was played in none of the recordings; all have one other",
        (*RECORDING, *SENSOR),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    heli_null,
    boost_diode,
    syringe_mercury,
    rooms_two,
    arm_null,
    piezo_hysteresis,
    jacket_misread,
    supercap_null,
    heli_pivot,
    boost_other_run,
    syringe_null,
    rooms_emission,
    arm_stronger,
    piezo_null,
    jacket_viscous,
    supercap_programme,
    heli_clock,
    boost_null,
    syringe_tubing,
    rooms_exchanged,
    arm_brushes,
    piezo_stuck,
    jacket_null,
    supercap_capacity,
    rooms_null,
    arm_two,
)
