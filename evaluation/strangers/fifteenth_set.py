"""Fifteenth set: a magnetic flap, a spin dryer, a generator, a model car, a nose, a gel, an electrolyser, a wet cloth.

Written without a look at the library of laws, its proof, its tests or its thresholds, and without a diagnosis of any of
its cases; of what was reported on the earlier sets, the author had read nothing but the titles of the last commits.
Truths are integrated by scipy from equations that stand here. How large an effect is, and how far the numbers are off,
is drawn; the deviations of the numbers are those that a parameter set states. Recordings of a rig differ in length and
in logger; the one that is held out was partly made with a programme of another kind, within the range of the others.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.eighth_set import idle_column
from evaluation.strangers.eleventh_set import DEGREES, LEAKING, RPM, RUBBING, telegraph
from evaluation.strangers.fifth_set import FOUR, FOUR_SPLIT, GRAVITY, integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourteenth_set import GAS
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.tenth_set import stairs, swept, within
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Faraday's constant [C/mol]; heat of evaporation of water [J/kg]; pascals in a psi.
FARADAY, VAPORISATION, PSI = 96485.0, 2.43e6, 6894.757


def ramped(rng: Rng, stop: float, knot: float, low: float, high: float, hold: float) -> Steps:
    """Straight lines between random levels every `knot` s, as a logger holds them for `hold` s each."""
    t = hold * np.arange(round(stop / hold))
    knots = np.arange(0.0, stop + 2.0 * knot, knot)
    levels = np.interp(t, knots, rng.uniform(low, high, len(knots)))
    return Steps(tuple(float(v) for v in np.round(t, 9)), tuple(float(f"{v:.4g}") for v in levels))


# --- a flap of magnetised silicone between two coils, a magnet on a slide, FMI 2 Model Exchange; ms, deg, mA, mT
FLAP = OdeModel(
    "flap",
    {
        "R": (5.0, "ohm"),
        "L": (0.02, "H"),
        "b": (0.01, "T/A"),
        "M": (0.05, "A*m^2"),
        "J": (2.5e-7, "kg*m^2"),
        "d": (4.5e-6, "N*m*s/rad"),
        "k": (6e-4, "N*m/rad"),
    },
    {"u": "V", "magnet": "T"},
    {
        "i": ("A", "0.0", "(u - R*i)/L"),
        "angle": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "(M*(b*i + magnet)*cos(angle) - k*angle - d*w)/J"),
    },
    {"bend": ("rad", "angle"), "current": ("A", "i")},
    2e-4,
)
FLAP_KNOWN = {"R": 0.03, "L": 0.06, "b": 0.03, "M": 0.05, "J": 0.06, "d": 0.1, "k": 0.06}


def _flap(
    folder: Path,
    rng: Rng,
    stiffening: float = 0.0,
    lost: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The silicone may stiffen, k angle (1 + stiffening angle^2); the laser may lose the flap in the first recording.

    Lost is begin and end of that [s]: it shows 0.
    """
    FLAP.build(folder)
    parts = programme("amplifier", ("u", "V")) + programme("slide", ("magnet", "mT"))
    parts += with_numbers("silicone", "flap")
    wires = "  - amplifier.u -> silicone.u\n  - slide.magnet -> silicone.magnet\n"
    scenario(folder, "A magnetic flap", 4.8, 2e-3, 2e-3, parts, wires)
    data_sheet(folder, FLAP, FLAP_KNOWN)
    r, inductance, b, moment, inertia, d, k = drawn(rng, FLAP, FLAP_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        i, angle, w = (float(s) for s in x)
        turning = moment * (b * i + 1e-3 * float(u[1])) * np.cos(angle)
        held = k * angle * (1.0 + stiffening * angle**2)
        return [(float(u[0]) - r * i) / inductance, w, (turning - held - d * w) / inertia]

    for number, (name, stop) in enumerate((("first", 4.8), ("second", 4.0), ("third", 4.4))):
        u = drawn_steps(rng, stop, 0.12, -4.2, 4.2, 2e-3)
        if name == "third":
            u = telegraph(rng, stop, 0.09, -3.4, 3.4, 2e-3)
        magnet = drawn_steps(rng, stop, 0.6, -3.0, 3.0, 2e-3)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (u, magnet), stop, 1e-3)
        blind = lost if lost is not None and name == "first" else (-1.0, -1.0)

        def spoil(column: str, t: Array, v: Array, blind: tuple[float, float] = blind) -> Array:
            return np.where(within(blind, t), 0.0, v) if column == "LK-G tip" else v

        sensors = [
            Sensor("silicone.bend", "LK-G tip", "deg", scaled(1, DEGREES), 0.35, 2e-3, noise_stated, 0.05),
            Sensor("silicone.current", "shunt/mA", "mA", scaled(0, 1e3), 8.0, 2e-3, noise_stated, 2.0),
        ]
        programmes = {"amplifier.u": (u, "V"), "slide.magnet": (magnet, "mT")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)], spoil=spoil))


def flap_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=-200.0, gap=(1.7, 2.15)), Logger("s", zero=86.4), Logger("ms", zero=5e3, empty=0.015))
    _flap(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, a gap of 0.45 s, empty cells, three loggers of ms and s",
        FINE,
    )


def flap_stiffening(folder: Path, rng: Rng) -> Truth:
    stiffening = rng.uniform(0.5, 0.9)
    _flap(folder, rng, stiffening=stiffening, loggers=(Logger("s", zero=1.0), Logger("ms")))
    return Truth(
        f"the silicone stiffens as it is bent: k angle (1 + {stiffening:.3f} angle^2)",
        PHYSICS,
        ("cubic_spring", "cubic_stiffness", "hardening", "hardening_spring", "nonlinear_spring", "stiffening"),
    )


def flap_lost(folder: Path, rng: Rng) -> Truth:
    begin = round(rng.uniform(0.8, 2.8), 1)
    _flap(folder, rng, lost=(begin, begin + 1.1), loggers=(Logger("ms", zero=40.0), Logger("ms")))
    return Truth(
        f"the laser loses the flap and shows 0, {begin:g} s to {begin + 1.1:g} s of the first recording", SENSOR
    )


# --- tub and drum of a spin dryer with laundry on one side, FMI 3 Model Exchange; rpm, mm, N; ballast is a column
TUB = OdeModel(
    "spin_dryer",
    {
        "m": (24.0, "kg"),
        "unbalance": (0.08, "kg*m"),
        "r": (0.2, "m"),
        "k": (1.5e4, "N/m"),
        "d": (150.0, "N*s/m"),
        "T": (0.3, "s"),
    },
    {"command": "rad/s", "ballast": "kg"},
    {
        "phi": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "(command - w)/T"),
        "y": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "((unbalance - r*ballast)*w*w*cos(phi) - k*y - d*v)/m"),
    },
    {"speed": ("rad/s", "w"), "way": ("m", "y"), "foot": ("N", "k*y + d*v")},
    1e-3,
)
TUB_KNOWN = {"m": 0.04, "unbalance": 0.06, "k": 0.05, "d": 0.1, "T": 0.03}


def _tub(
    folder: Path,
    rng: Rng,
    dry: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The struts may rub with `dry` N; water in the counterweight balances a part of the laundry."""
    build3(TUB, folder, has_co_simulation=False)
    parts = programme("servo", ("command", "rpm")) + programme("pump", ("ballast", "g"))
    parts += with_numbers("dryer", "spin_dryer")
    wires = "  - servo.command -> dryer.command\n  - pump.ballast -> dryer.ballast\n"
    scenario(folder, "A spin dryer", 24.0, 0.01, 0.01, parts, wires)
    data_sheet(folder, TUB, TUB_KNOWN)
    m, unbalance, r, k, d, lag = drawn(rng, TUB, TUB_KNOWN)

    def feet(x: Array) -> Array:
        return np.asarray(k * x[..., 2] + d * x[..., 3] + dry * np.tanh(x[..., 3] / 4e-3))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        phi, w, _, v = (float(s) for s in x)
        thrown = (unbalance - r * 1e-3 * float(u[1])) * w * w * np.cos(phi)
        return [w, (float(u[0]) / RPM - w) / lag, v, (thrown - float(feet(x))) / m]

    for number, (name, stop) in enumerate((("first", 24.0), ("second", 20.0), ("third", 22.0))):
        command = drawn_steps(rng, stop, 1.9, 110.0, 470.0, 0.05)
        if name == "third":
            command = stairs(rng, stop, 1.8, 120.0, 450.0, 5, 0.05)
        ballast = drawn_steps(rng, stop, 5.0, 0.0, 240.0, 0.05)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (command, ballast), stop, 1e-3)
        sensors = [
            Sensor("dryer.way", "inductive_3", "mm", scaled(2, 1e3), 0.12, 0.01, noise_stated, 0.02, colour),
            Sensor("dryer.foot", "Kraft F1+F2", "N", lambda t, x, u: feet(x), 2.0, 0.01, noise_stated, 0.5, colour),
            Sensor("dryer.speed", "n_Trommel", "rpm", scaled(1, RPM), 2.5, 0.05, noise_stated, 1.0, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"servo.command": (command, "rpm"), "pump.ballast": (ballast, "g")},
            loggers[number % len(loggers)],
            recorded=["pump.ballast"],
        )
        write(folder / name, rng, made)


def tub_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=431.0), Logger("ms", zero=-60.0), Logger("min", zero=1.5))
    _tub(folder, rng, noise_stated=0.9, colour=0.5, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.5 and is stated 1.11 times too "
        "small, two rates, three loggers of s, ms and min",
        FINE,
    )


def tub_dry(folder: Path, rng: Rng) -> Truth:
    dry = rng.uniform(7.0, 12.0)
    _tub(folder, rng, dry=dry, loggers=(Logger("ms"), Logger("s", zero=15.0)))
    return Truth(f"the struts rub with {dry:.2f} N", PHYSICS, (*RUBBING, "hysteresis", "bouc_wen"))


def tub_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(2.5e-3, 5e-3)
    _tub(folder, rng, loggers=(PLAIN, Logger("s", zero=3.0, rate=1.0 + fast), Logger("ms")))
    return Truth(
        f"the clock of the second recording is {100 * fast:.2f} % fast, which is not stated", (*RECORDING, *SENSOR)
    )


# --- a small synchronous generator on a stiff grid: rotor angle and field, FMI 3 Model Exchange; four runs; deg, W, A
GENERATOR = OdeModel(
    "generator",
    {
        "M": (12.5, "W*s^2/rad"),
        "D": (30.0, "W*s/rad"),
        "U": (230.0, "V"),
        "X": (30.0, "ohm"),
        "k_f": (150.0, "V/A"),
        "R_f": (20.0, "ohm"),
        "L_f": (11.0, "H"),
        "i_begin": (1.6, "A"),
    },
    {"shaft": "W", "u_f": "V"},
    {
        "delta": ("rad", "0.0", "slip"),
        "slip": ("rad/s", "0.0", "(shaft - k_f*i_f*U/X*sin(delta) - D*slip)/M"),
        "i_f": ("A", "i_begin", "(u_f - R_f*i_f)/L_f"),
    },
    {"angle": ("rad", "delta"), "power": ("W", "k_f*i_f*U/X*sin(delta)"), "field": ("A", "i_f")},
    2e-3,
)
GENERATOR_KNOWN = {"M": 0.05, "D": 0.1, "X": 0.05, "k_f": 0.04, "R_f": 0.04, "L_f": 0.08}


def _generator(
    folder: Path,
    rng: Rng,
    salient: float = 0.0,
    knee: float = np.inf,
    is_reversed: bool = False,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Poles may be salient, salient sin(2 delta) [W], and iron saturated, k_f i_f/sqrt(1 + (i_f/knee)^2).

    The current clamp of the power meter may be the other way round in the third recording.
    """
    build3(GENERATOR, folder, has_co_simulation=False)
    parts = programme("engine", ("shaft", "W")) + programme("exciter", ("u_f", "V"))
    parts += with_numbers("machine", "generator")
    wires = "  - engine.shaft -> machine.shaft\n  - exciter.u_f -> machine.u_f\n"
    scenario(folder, "A generator on a stiff grid", 60.0, 0.02, 0.02, parts, wires)
    data_sheet(folder, GENERATOR, GENERATOR_KNOWN)
    m, d, volts, reactance, k_f, r_f, l_f, begin = drawn(rng, GENERATOR, GENERATOR_KNOWN)

    def given(x: Array) -> Array:
        """Power into the grid [W]."""
        delta, field = x[..., 0], x[..., 2]
        inner = k_f * field / np.sqrt(1.0 + (field / knee) ** 2)
        return np.asarray(inner * volts / reactance * np.sin(delta) + salient * np.sin(2.0 * delta))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        slip, field = float(x[1]), float(x[2])
        return [slip, (float(u[0]) - float(given(x)) - d * slip) / m, (float(u[1]) - r_f * field) / l_f]

    for number, (name, stop) in enumerate(zip(FOUR, (60.0, 50.0, 56.0, 54.0))):
        shaft = drawn_steps(rng, stop, 2.6, 80.0, 740.0, 0.1)
        if name == "fourth":
            shaft = swept(stop, 120.0, 700.0, 9.0, 2.5, 0.1)
        exciter = drawn_steps(rng, stop, 4.0, 20.0, 44.0, 0.1)
        t, x = integrated(rates, (0.0, 0.0, begin), (shaft, exciter), stop, 5e-3)
        sign = -1.0 if is_reversed and name == "third" else 1.0

        def meter(t: Array, x: Array, u: Array, sign: float = sign) -> Array:
            return sign * given(x)

        sensors = [
            Sensor("machine.angle", "Polrad", "deg", scaled(0, DEGREES), 0.25, 0.02, 1.0, 0.1),
            Sensor("machine.power", "P3ph", "W", meter, 4.5, 0.02, 1.0, 1.0),
            Sensor("machine.field", "I_err", "A", scaled(2, 1.0), 0.012, 0.02, 1.0, 2e-3),
        ]
        programmes = {"engine.shaft": (shaft, "W"), "exciter.u_f": (exciter, "V")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def generator_salient(folder: Path, rng: Rng) -> Truth:
    salient = rng.uniform(380.0, 600.0)
    _generator(folder, rng, salient=salient, loggers=(Logger("s", zero=-2.0), PLAIN, Logger("ms")))
    return Truth(
        f"poles are salient: {salient:.1f} W sin(2 delta) besides",
        PHYSICS,
        ("cogging_torque", "detent_torque", "reluctance_torque", "saliency", "nonlinear_spring"),
        **FOUR_SPLIT,
    )


def generator_two(folder: Path, rng: Rng) -> Truth:
    salient, knee = rng.uniform(380.0, 600.0), rng.uniform(2.2, 3.0)
    _generator(folder, rng, salient=salient, knee=knee, loggers=(Logger("ms", zero=900.0), Logger("s", zero=7.5)))
    return Truth(
        f"poles are salient, {salient:.1f} W sin(2 delta) besides, and iron saturates: "
        f"k_f i_f/sqrt(1 + (i_f/{knee:.3f} A)^2)",
        PHYSICS,
        (
            "cogging_torque",
            "detent_torque",
            "reluctance_torque",
            "saliency",
            "nonlinear_spring",
            "saturation",
            "magnetic_saturation",
            "saturating_gain",
        ),
        **FOUR_SPLIT,
    )


def generator_reversed(folder: Path, rng: Rng) -> Truth:
    _generator(folder, rng, is_reversed=True, loggers=(PLAIN, Logger("min", zero=20.0)))
    return Truth(
        "the clamp of the power meter is the other way round in the third recording: power has the other sign",
        (*RECORDING, *SENSOR),
        **FOUR_SPLIT,
    )


# --- a model car that turns (single track) with its steering servo, FMI 2 Co-Simulation; km/h, deg; speed is a column
CAR = OdeModel(
    "single_track",
    {
        "m": (12.0, "kg"),
        "J": (0.6, "kg*m^2"),
        "a": (0.22, "m"),
        "b": (0.25, "m"),
        "C_f": (180.0, "N/rad"),
        "C_r": (220.0, "N/rad"),
        "T_servo": (0.07, "s"),
    },
    {"steer": "rad", "speed": "m/s"},
    {
        "wheel": ("rad", "0.0", "(steer - wheel)/T_servo"),
        "side": (
            "m/s",
            "0.0",
            "(C_f*(wheel - (side + a*turn)/fmax(speed, 0.5)) - C_r*(side - b*turn)/fmax(speed, 0.5))/m"
            " - fmax(speed, 0.5)*turn",
        ),
        "turn": (
            "rad/s",
            "0.0",
            "(a*C_f*(wheel - (side + a*turn)/fmax(speed, 0.5)) + b*C_r*(side - b*turn)/fmax(speed, 0.5))/J",
        ),
    },
    {
        "yaw": ("rad/s", "turn"),
        "lateral": (
            "m/s^2",
            "(C_f*(wheel - (side + a*turn)/fmax(speed, 0.5)) - C_r*(side - b*turn)/fmax(speed, 0.5))/m",
        ),
    },
    1e-3,
)
CAR_KNOWN = {"m": 0.03, "J": 0.08, "C_f": 0.06, "C_r": 0.06, "T_servo": 0.06}


def _car(
    folder: Path,
    rng: Rng,
    grip: float = np.inf,
    share: float = 0.0,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Tyres may hold no more than `grip` times their load, F tanh(C slip/F).

    The gyroscope may end, in the first recording, at what is exceeded for a `share` of the time.
    """
    CAR.build(folder)
    parts = programme("radio", ("steer", "deg")) + programme("hall", ("speed", "km/h"))
    parts += with_numbers("car", "single_track", "internal")
    wires = "  - radio.steer -> car.steer\n  - hall.speed -> car.speed\n"
    scenario(folder, "A model car that turns", 50.0, 0.02, 0.02, parts, wires)
    data_sheet(folder, CAR, CAR_KNOWN)
    m, inertia, a, b, c_f, c_r, lag = drawn(rng, CAR, CAR_KNOWN)
    load = m * GRAVITY / (a + b)

    def held(linear: Array, most: float) -> Array:
        return np.asarray(most * np.tanh(linear / most)) if np.isfinite(most) else linear

    def sides(x: Array, speed: Array) -> tuple[Array, Array]:
        """Forces of the front and of the rear tyres [N]."""
        wheel, side, turn = x[..., 0], x[..., 1], x[..., 2]
        front = c_f * (wheel - (side + a * turn) / speed)
        return held(front, grip * load * b), held(-c_r * (side - b * turn) / speed, grip * load * a)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        speed = float(u[1]) / 3.6
        front, rear = (float(f) for f in sides(x, np.asarray(speed)))
        lateral, turning = (front + rear) / m, (a * front - b * rear) / inertia
        return [(float(u[0]) / DEGREES - float(x[0])) / lag, lateral - speed * float(x[2]), turning]

    for number, (name, stop) in enumerate((("first", 50.0), ("second", 42.0), ("third", 46.0))):
        steer = drawn_steps(rng, stop, 0.7, -12.0, 12.0, 0.02)
        if name == "third":
            steer = swept(stop, -10.0, 10.0, 5.0, 1.2, 0.04)
        speed = ramped(rng, stop, 5.0, 11.0, 23.0, 0.1)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (steer, speed), stop, 0.01)
        yaw = np.abs(DEGREES * x[:, 2])
        end = float(f"{np.quantile(yaw, 1.0 - share):.0f}") if share and name == "first" else np.inf

        def spoil(column: str, t: Array, v: Array, end: float = end) -> Array:
            return np.clip(v, -end, end) if column == "gyroZ" else v

        def lateral(t: Array, x: Array, u: Array) -> Array:
            front, rear = sides(x, u[:, 1] / 3.6)
            return np.asarray((front + rear) / m)

        sensors = [
            Sensor("car.yaw", "gyroZ", "deg/s", scaled(2, DEGREES), 0.8, 0.02, noise_stated, 0.1, wild=wild),
            Sensor("car.lateral", "accY", "m/s^2", lateral, 0.12, 0.02, noise_stated, 0.01, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"radio.steer": (steer, "deg"), "hall.speed": (speed, "km/h")},
            loggers[number % len(loggers)],
            recorded=["hall.speed"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def car_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=123456.0, empty=0.01), Logger("ms", zero=31.0), Logger("s", zero=-0.5))
    _car(folder, rng, noise_stated=1.15, wild=0.01, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, wild readings, noise stated 1.15 times too large, empty cells, ms from "
        "123456, Co-Simulation",
        FINE,
    )


def car_grip(folder: Path, rng: Rng) -> Truth:
    grip = rng.uniform(0.5, 0.65)
    _car(folder, rng, grip=grip, loggers=(Logger("s", zero=60.0), Logger("ms")))
    return Truth(
        f"tyres hold no more than {grip:.3f} times their load: F tanh(C slip/F)",
        PHYSICS,
        ("saturation", "saturating_gain", "tyre_saturation", "nonlinear_damping", "state_limit"),
    )


def car_gyroscope(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.12, 0.2)
    _car(folder, rng, share=share, loggers=(PLAIN, Logger("min", zero=0.2)))
    return Truth(
        f"the gyroscope ends at what {100 * share:.0f} % of the first recording exceed, either way, which is not "
        "stated",
        SENSOR,
    )


# --- two gas sensors and a lamp detector in a test chamber, FMI 3, both interfaces, without units; ppm, L/min
NOSE = OdeModel(
    "nose",
    {
        "V": (2.0, ""),
        "a_1": (4e-4, ""),
        "d_1": (0.02, ""),
        "a_2": (7e-5, ""),
        "d_2": (0.005, ""),
        "g_1": (8.0, ""),
        "s_1": (6.0, ""),
        "g_2": (3.0, ""),
        "s_2": (9.0, ""),
    },
    {"inlet": "", "flow": ""},
    {
        "c": ("", "0.0", "flow/60.0*(inlet - c)/V"),
        "x_1": ("", "0.0", "a_1*c*(1.0 - x_1) - d_1*x_1"),
        "x_2": ("", "0.0", "a_2*c*(1.0 - x_2) - d_2*x_2"),
    },
    {"pid": ("", "c"), "fast": ("", "g_1*(1.0 + s_1*x_1)"), "slow": ("", "g_2*(1.0 + s_2*x_2)")},
    0.5,
)
NOSE_KNOWN = {"V": 0.04, "a_1": 0.06, "d_1": 0.06, "a_2": 0.06, "d_2": 0.06, "s_1": 0.05, "s_2": 0.05}


def _nose(
    folder: Path,
    rng: Rng,
    sorbed: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Walls may take up gas, sorbed c [L/s], and give it back in 500 s.

    The first recording may have the column of the inlet of another run.
    """
    build3(NOSE, folder)
    parts = programme("mixer", ("inlet", "")) + programme("valve", ("flow", "")) + with_numbers("nose", "nose")
    wires = "  - mixer.inlet -> nose.inlet\n  - valve.flow -> nose.flow\n"
    scenario(folder, "Gas sensors in a chamber", 5400.0, 5, 5, parts, wires)
    data_sheet(folder, NOSE, NOSE_KNOWN)
    volume, a_1, d_1, a_2, d_2, g_1, s_1, g_2, s_2 = drawn(rng, NOSE, NOSE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        c, x_1, x_2, walls = (float(s) for s in x)
        taken = sorbed * c - walls / 500.0
        return [
            (float(u[1]) / 60.0 * (float(u[0]) - c) - taken) / volume,
            a_1 * c * (1.0 - x_1) - d_1 * x_1,
            a_2 * c * (1.0 - x_2) - d_2 * x_2,
            taken,
        ]

    other = bursts(rng, 5400.0, 260.0, 330.0, 15.0, 150.0, 5.0)
    for number, (name, stop) in enumerate((("first", 5400.0), ("second", 4500.0), ("third", 4800.0))):
        inlet = bursts(rng, stop, 260.0, 330.0, 15.0, 150.0, 5.0)
        if name == "third":
            inlet = stairs(rng, stop, 280.0, 0.0, 140.0, 5, 5.0)
        flow = drawn_steps(rng, stop, 500.0, 0.6, 2.0, 5.0)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (inlet, flow), stop, 1.0)
        sensors = [
            Sensor("nose.pid", "PID-AH2", "1", scaled(0, 1.0), 0.9, 5.0, noise_stated, 0.1, colour),
            Sensor(
                "nose.fast", "MOX 1 uS", "1", lambda t, x, u: g_1 * (1.0 + s_1 * x[:, 1]), 0.3, 5.0, noise_stated, 0.05
            ),
            Sensor(
                "nose.slow", "MOX 2 uS", "1", lambda t, x, u: g_2 * (1.0 + s_2 * x[:, 2]), 0.15, 5.0, noise_stated, 0.05
            ),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"mixer.inlet": (inlet, ""), "valve.flow": (flow, "")},
            loggers[number % len(loggers)],
            recorded=["mixer.inlet"],
            told={"mixer.inlet": other} if is_other and name == "first" else {},
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "heater V", lambda n: np.asarray(5.0 + 0.01 * rng.standard_normal(n)))


def nose_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=1.7e3, empty=0.03), Logger("min", zero=-4.0), Logger("h", zero=10.0))
    _nose(folder, rng, noise_stated=0.88, colour=0.6, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, no units, noise of the detector's neighbouring readings correlates by 0.6, "
        "noise stated 1.14 times too small, a column that nothing names, empty cells, three loggers of s, min and h",
        FINE,
    )


def nose_walls(folder: Path, rng: Rng) -> Truth:
    sorbed = rng.uniform(3e-3, 5e-3)
    _nose(folder, rng, sorbed=sorbed, loggers=(Logger("min"), Logger("s", zero=600.0)))
    return Truth(
        f"walls take up gas, {sorbed:.2e} L/s c, and give it back in 500 s",
        PHYSICS,
        (
            "sorption",
            "adsorption",
            "wall_adsorption",
            "hidden_state",
            "hidden_mass",
            "second_mass",
            "hidden_capacity",
            "memory",
            "dielectric_absorption",
        ),
    )


def nose_other_run(folder: Path, rng: Rng) -> Truth:
    _nose(folder, rng, is_other=True, loggers=(PLAIN, Logger("min", zero=75.0)))
    return Truth("the first recording has the inlet of another run", (*RECORDING, *SENSOR))


# --- a strip of hydrogel in a salt bath, FMI 3 Co-Simulation; mol/m^3, mm, mL/min, h; ten hours, each minute
GEL = OdeModel(
    "hydrogel",
    {
        "V": (1.2e-3, "m^3"),
        "c_brine": (600.0, "mol/m^3"),
        "w_dry": (2.0, ""),
        "w_more": (12.0, ""),
        "c_half": (120.0, "mol/m^3"),
        "tau": (1700.0, "s"),
        "l_dry": (0.03, "m"),
        "c_begin": (60.0, "mol/m^3"),
        "w_begin": (10.0, ""),
    },
    {"brine": "m^3/s", "fresh": "m^3/s"},
    {
        "c": ("mol/m^3", "c_begin", "(brine*(c_brine - c) - fresh*c)/V"),
        "w": ("", "w_begin", "(w_dry + w_more/(1.0 + c/c_half) - w)/tau"),
    },
    {"salt": ("mol/m^3", "c"), "length": ("m", "l_dry*cbrt(1.0 + w)")},
    5.0,
)
GEL_KNOWN = {"V": 0.03, "c_brine": 0.02, "w_more": 0.05, "c_half": 0.06, "tau": 0.08, "l_dry": 0.015}


def _gel(
    folder: Path,
    rng: Rng,
    power: float = 0.0,
    dried: float = 0.0,
    noise_stated: float | None = 1.0,
    quantum: float = 0.05,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """Water may pass a swollen gel faster, its rate times (w/8)^power.

    The second recording may begin with a gel that holds less water by `dried`, as a multiple of its dry mass.
    """
    build3(GEL, folder, has_exchange=False)
    parts = programme("pump_1", ("brine", "mL/min")) + programme("pump_2", ("fresh", "mL/min"))
    parts += with_numbers("strip", "hydrogel", "internal")
    wires = "  - pump_1.brine -> strip.brine\n  - pump_2.fresh -> strip.fresh\n"
    scenario(folder, "A strip of hydrogel", 36000.0, 60, 60, parts, wires)
    data_sheet(folder, GEL, GEL_KNOWN)
    volume, c_brine, w_dry, w_more, c_half, tau, l_dry, c_begin, w_begin = drawn(rng, GEL, GEL_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Flows are in mL/min."""
        c, w = (float(s) for s in x)
        brine, fresh = float(u[0]) / 6e7, float(u[1]) / 6e7
        aim = w_dry + w_more / (1.0 + c / c_half)
        return [(brine * (c_brine - c) - fresh * c) / volume, (aim - w) / tau * (w / 8.0) ** power]

    for number, (name, stop) in enumerate((("first", 36000.0), ("second", 30000.0), ("third", 32400.0))):
        brine = bursts(rng, stop, 2700.0, 2400.0, 12.0, 48.0, 60.0)
        fresh = drawn_steps(rng, stop, 3300.0, 8.0, 48.0, 60.0)
        if name == "third":
            fresh = wandering(rng, stop, 2400.0, 8.0, 48.0, 60.0)
        begin = w_begin - (dried if name == "second" else 0.0)
        t, x = integrated(rates, (c_begin, begin), (brine, fresh), stop, 20.0)
        sensors = [
            Sensor("strip.salt", "LF 2 (mol/m3)", "mol/m^3", scaled(0, 1.0), 3.0, 60.0, noise_stated, 1.0),
            Sensor(
                "strip.length",
                "Kamera L",
                "mm",
                lambda t, x, u: 1e3 * l_dry * np.cbrt(1.0 + x[:, 1]),
                0.12,
                60.0,
                noise_stated,
                quantum,
            ),
        ]
        programmes = {"pump_1.brine": (brine, "mL/min"), "pump_2.fresh": (fresh, "mL/min")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def gel_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("h", zero=8.25, is_comma=True, gap=(14400.0, 17400.0)),
        Logger("min", zero=1440.0, is_comma=True),
        Logger("h", zero=-0.1, is_comma=True, empty=0.03),
    )
    _gel(folder, rng, noise_stated=0.85, quantum=0.25, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.18 times too small, a coarse camera, decimal commas, a gap of "
        "50 min, empty cells, h from 8.25, min from 1440",
        FINE,
    )


def gel_skin(folder: Path, rng: Rng) -> Truth:
    power = rng.uniform(1.7, 2.5)
    _gel(folder, rng, power=power, loggers=(Logger("min", zero=3.0), Logger("h")))
    return Truth(
        f"water passes a swollen gel faster: its rate times (w/8)^{power:.3f}",
        PHYSICS,
        (
            "rate_of_state",
            "state_dependent_rate",
            "nonlinear_rate",
            "nonlinear_diffusion",
            "concentration_dependent_diffusivity",
            "reaction_order",
        ),
    )


def gel_start(folder: Path, rng: Rng) -> Truth:
    dried = rng.uniform(3.0, 4.5)
    _gel(folder, rng, dried=dried, loggers=(Logger("h", zero=1.0), Logger("min")))
    return Truth(
        f"the gel of the second recording has dried, w begins {dried:.2f} lower, and is said to begin as the others",
        (*RECORDING, *SENSOR),
    )


# --- an electrolyser (FMI 2, Model Exchange) and its hydrogen tank (FMI 3, Co-Simulation); A, V, degC, psi; two rates
ELECTROLYSER = OdeModel(
    "electrolyser",
    {
        "n": (6.0, ""),
        "R": (0.012, "ohm"),
        "A": (0.06, "V"),
        "i_0": (0.02, "A"),
        "C": (900.0, "J/K"),
        "h": (1.2, "W/K"),
        "eta": (0.95, ""),
        "T_room": (295.15, "K"),
    },
    {"amperes": "A", "back": "Pa"},
    {
        "T": (
            "K",
            "T_room",
            "(amperes*n*(1.23 - 8.5e-4*(T - 298.15) + 4.308e-5*T*log(fmax(back, 5e4)/101325.0)"
            " + R*(1.0 - 0.006*(T - 298.15))*amperes + A*asinh(amperes/(2.0*i_0)) - 1.48) - h*(T - T_room))/C",
        ),
    },
    {
        "volts": (
            "V",
            "n*(1.23 - 8.5e-4*(T - 298.15) + 4.308e-5*T*log(fmax(back, 5e4)/101325.0)"
            " + R*(1.0 - 0.006*(T - 298.15))*amperes + A*asinh(amperes/(2.0*i_0)))",
        ),
        "stack": ("K", "T"),
        "gas": ("mol/s", f"n*eta*amperes/(2.0*{FARADAY})"),
    },
    1.0,
)
GAS_TANK = OdeModel(
    "gas_tank",
    {
        "V": (2e-3, "m^3"),
        "c": (1e-9, "mol/s/Pa"),
        "T_gas": (295.15, "K"),
        "p_room": (1.013e5, "Pa"),
        "p_begin": (3e5, "Pa"),
    },
    {"gas": "mol/s", "valve": ""},
    {"p": ("Pa", "p_begin", f"{GAS}*T_gas/V*(gas - c*valve*(p - p_room))")},
    {"pressure": ("Pa", "p")},
    1.0,
)
ELECTROLYSER_KNOWN = {"R": 0.06, "A": 0.03, "C": 0.06, "h": 0.06, "eta": 0.02}
GAS_TANK_KNOWN = {"V": 0.03, "c": 0.05}


def _electrolyser(
    folder: Path,
    rng: Rng,
    crossing: float = 0.0,
    stuck: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; hydrogen may go back through the membrane, crossing p [mol/(s Pa)].

    Stuck is begin and end [s] of a pressure that stands still in the second recording.
    """
    ELECTROLYSER.build(folder)
    build3(GAS_TANK, folder, has_exchange=False)
    data_sheet(folder, GAS_TANK, GAS_TANK_KNOWN)
    (folder / "numbers.yaml").rename(folder / "tank.yaml")
    data_sheet(folder, ELECTROLYSER, ELECTROLYSER_KNOWN)
    parts = (
        programme("source", ("amperes", "A"))
        + programme("needle", ("valve", "'%'")).replace("0 '%'", "0 %")
        + with_numbers("stack", "electrolyser")
        + with_numbers("bottle", "gas_tank", "internal").replace("numbers.yaml", "tank.yaml")
    )
    wires = (
        "  - source.amperes -> stack.amperes\n  - needle.valve -> bottle.valve\n  - stack.gas -> bottle.gas\n"
        "  - bottle.pressure -> stack.back\n"
    )
    scenario(folder, "An electrolyser and its tank", 7200.0, 2.5, 5, parts, wires)
    n, r, a, i_0, c_heat, h, eta, t_room = drawn(rng, ELECTROLYSER, ELECTROLYSER_KNOWN)
    volume, c, t_gas, p_room, p_begin = drawn(rng, GAS_TANK, GAS_TANK_KNOWN)

    def across(x: Array, amperes: Array) -> Array:
        """Voltage of one cell."""
        stack, p = x[..., 0], 1e5 * x[..., 1]
        open_circuit = 1.23 - 8.5e-4 * (stack - 298.15) + 4.308e-5 * stack * np.log(p / 101325.0)
        resistance = r * (1.0 - 0.006 * (stack - 298.15))
        return np.asarray(open_circuit + resistance * amperes + a * np.arcsinh(amperes / (2.0 * i_0)))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in bar."""
        amperes, valve = float(u[0]), 0.01 * float(u[1])
        stack, p = float(x[0]), 1e5 * float(x[1])
        made = n * eta * amperes / (2.0 * FARADAY) - crossing * p
        heat = amperes * n * (float(across(x, np.asarray(amperes))) - 1.48)
        return [(heat - h * (stack - t_room)) / c_heat, 1e-5 * GAS * t_gas / volume * (made - c * valve * (p - p_room))]

    for number, (name, stop) in enumerate((("first", 7200.0), ("second", 6000.0), ("third", 6600.0))):
        amperes = drawn_steps(rng, stop, 420.0, 3.0, 19.0, 5.0)
        if name == "third":
            amperes = stairs(rng, stop, 380.0, 4.0, 18.0, 5, 5.0)
        amperes = Steps((0.0, *(t + 2.5 for t in amperes.times[1:])), amperes.levels)
        valve = drawn_steps(rng, stop, 700.0, 30.0, 100.0, 5.0)
        t, x = integrated(rates, (t_room, 1e-5 * p_begin), (amperes, valve), stop, 1.0)
        still = stuck if stuck is not None and name == "second" else (-1.0, -1.0)

        def spoil(column: str, t: Array, v: Array, still: tuple[float, float] = still) -> Array:
            if column != "H2 out" or still[0] < 0.0:
                return v
            return np.where(within(still, t), v[np.searchsorted(t, still[0]) - 1], v)

        def volts(t: Array, x: Array, u: Array) -> Array:
            return n * across(x, u[:, 0])

        sensors = [
            Sensor("stack.volts", "U_Stack", "V", volts, 0.015, 5.0, noise_stated, 5e-3),
            Sensor("stack.stack", "NTC 4", "degC", celsius(0), 0.25, 5.0, noise_stated, 0.1),
            Sensor("bottle.pressure", "H2 out", "psi", scaled(1, 1e5 / PSI), 0.25, 15.0, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"source.amperes": (amperes, "A"), "needle.valve": (valve, "%")},
            loggers[number % len(loggers)],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def electrolyser_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=615.0), Logger("s", zero=-30.0, gap=(3300.0, 3720.0)), Logger("h", zero=0.5))
    _electrolyser(folder, rng, noise_stated=1.25, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, noise stated 1.25 times too large, two rates, a gap of 7 min, three "
        "loggers of min, s and h",
        FINE,
    )


def electrolyser_crossing(folder: Path, rng: Rng) -> Truth:
    crossing = rng.uniform(1.2e-10, 2.2e-10)
    _electrolyser(folder, rng, crossing=crossing, loggers=(PLAIN, Logger("min", zero=90.0)))
    return Truth(
        f"hydrogen goes back through the membrane, {crossing:.2e} mol/(s Pa) p",
        PHYSICS,
        (*LEAKING, "crossover", "back_diffusion", "self_discharge", "decay"),
    )


def electrolyser_stuck(folder: Path, rng: Rng) -> Truth:
    begin = 60.0 * round(rng.uniform(20.0, 55.0))
    _electrolyser(folder, rng, stuck=(begin, begin + 1500.0), loggers=(Logger("s", zero=2.0), Logger("min")))
    return Truth(
        f"the pressure stands still, {begin / 60.0:g} min to {begin / 60.0 + 25.0:g} min of the second recording",
        SENSOR,
    )


# --- a wet cloth on a sweating hot plate and a balance, FMI 2 Model Exchange; degC, g, g/min, W; the room is a column
CLOTH = OdeModel(
    "wet_cloth",
    {
        "C_plate": (900.0, "J/K"),
        "C_cloth": (180.0, "J/K"),
        "G": (3.0, "W/K"),
        "h": (0.6, "W/K"),
        "beta": (2.5e-9, "kg/s/Pa"),
        "p_v": (1400.0, "Pa"),
        "m_0": (4e-3, "kg"),
        "T_begin": (298.15, "K"),
        "m_begin": (0.025, "kg"),
    },
    {"heat": "W", "drip": "kg/s", "room": "K"},
    {
        "T_p": ("K", "T_begin", "(heat - G*(T_p - T_c))/C_plate"),
        "T_c": (
            "K",
            "T_begin",
            "(G*(T_p - T_c) - h*(T_c - room)"
            f" - {VAPORISATION}*beta*(610.94*exp(17.625*(T_c - 273.15)/(T_c - 30.11)) - p_v)*water/(water + m_0))"
            "/C_cloth",
        ),
        "water": (
            "kg",
            "m_begin",
            "drip - beta*(610.94*exp(17.625*(T_c - 273.15)/(T_c - 30.11)) - p_v)*water/(water + m_0)",
        ),
    },
    {"plate": ("K", "T_p"), "cloth": ("K", "T_c"), "balance": ("kg", "water")},
    1.0,
)
CLOTH_KNOWN = {"C_plate": 0.04, "C_cloth": 0.08, "G": 0.06, "h": 0.06, "beta": 0.05}


def _cloth(
    folder: Path,
    rng: Rng,
    wetter: float = 0.0,
    guard: float = 0.0,
    stronger: tuple[float, float, float] | None = None,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Wet cloth may conduct better, G (1 + wetter (water/20 g - 1)); the plate may lose guard (T - room) W besides.

    Stronger is begin [s], end [s] and factor of the heater in the second recording; `strayed` is by how much [g] the
    water of each begin is off (deviation), which is stated.
    """
    CLOTH.build(folder)
    names = (("foil", "heat", "W"), ("nozzle", "drip", "g/min"), ("climate", "room", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("bench", "wet_cloth")
    wires = "".join(f"  - {c}.{n} -> bench.{n}\n" for c, n, _ in names)
    scenario(folder, "A wet cloth on a hot plate", 10800.0, 5, 15, parts, wires)
    data_sheet(folder, CLOTH, CLOTH_KNOWN)
    c_plate, c_cloth, g, h, beta, p_v, m_0, begin, usual = drawn(rng, CLOTH, CLOTH_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Water is in g."""
        plate, cloth, water = (float(s) for s in x)
        room = float(u[2]) + CELSIUS
        saturated = 610.94 * np.exp(17.625 * (cloth - CELSIUS) / (cloth - 30.11))
        drying = 1e3 * beta * (saturated - p_v) * water / (water + 1e3 * m_0)
        through = g * (1.0 + wetter * (water / 20.0 - 1.0)) * (plate - cloth)
        return [
            (float(u[0]) - through - guard * (plate - room)) / c_plate,
            (through - h * (cloth - room) - 1e-3 * VAPORISATION * drying) / c_cloth,
            float(u[1]) / 60.0 - drying,
        ]

    for number, (name, stop) in enumerate((("first", 10800.0), ("second", 9000.0), ("third", 9900.0))):
        stated = drawn_steps(rng, stop, 750.0, 5.0, 40.0, 15.0)
        if name == "third":
            stated = wandering(rng, stop, 600.0, 5.0, 40.0, 15.0)
        heat = stated
        if stronger is not None and name == "second":
            heat = between(stated, stronger[0], stronger[1], lambda v: stronger[2] * v)
        drip = bursts(rng, stop, 900.0, 900.0, 0.5, 1.8, 15.0)
        room = ramped(rng, stop, 1800.0, 21.0, 25.0, 60.0)
        said = float(f"{1e3 * usual + rng.uniform(-5.0, 10.0):.3g}") if strayed else 1e3 * usual
        t, x = integrated(rates, (begin, begin, said + strayed * float(rng.normal())), (heat, drip, room), stop, 5.0)
        sensors = [
            Sensor("bench.plate", "T Platte", "degC", celsius(0), 0.12, 15.0, noise_stated, 0.05, wild=wild),
            Sensor("bench.cloth", "IR-Kopf", "degC", celsius(1), 0.25, 15.0, noise_stated, 0.1, wild=wild),
            Sensor("bench.balance", "Waage netto", "g", scaled(2, 1.0), 0.2, 15.0, noise_stated, 0.1, wild=wild),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"bench": {"parameters": {"m_begin": f"{said:.6g} g"}}}
            sidecar["uncertain"] = {"bench.m_begin": f"{strayed:g} g"}
        made = Written(
            t,
            x,
            sensors,
            {"foil.heat": (heat, "W"), "nozzle.drip": (drip, "g/min"), "climate.room": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["climate.room"],
            sidecar=sidecar,
            told={} if heat is stated else {"foil.heat": stated},
        )
        write(folder / name, rng, made)


def cloth_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=33.0), Logger("s", zero=250.0, jitter=0.3), Logger("min", zero=-1.0, empty=0.02))
    _cloth(folder, rng, strayed=2.5, wild=0.006, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, water at the begin is stated and off by 2.5 g (deviation), which is stated "
        "too, wild readings, jitter, empty cells",
        FINE,
    )


def cloth_wetter(folder: Path, rng: Rng) -> Truth:
    wetter = rng.uniform(0.3, 0.45)
    _cloth(folder, rng, wetter=wetter, loggers=(PLAIN, Logger("min", zero=4.0)))
    return Truth(
        f"wet cloth conducts better: G (1 + {wetter:.3f} (water/20 g - 1))",
        PHYSICS,
        ("conductance_of_state", "state_dependent_conductance", "conductance_of_moisture", "wet_conduction"),
    )


def cloth_two(folder: Path, rng: Rng) -> Truth:
    wetter, guard = rng.uniform(0.3, 0.45), rng.uniform(0.35, 0.6)
    _cloth(folder, rng, wetter=wetter, guard=guard, loggers=(Logger("min"), Logger("h", zero=2.0)))
    return Truth(
        f"wet cloth conducts better, G (1 + {wetter:.3f} (water/20 g - 1)), and the plate loses {guard:.3f} W/K to the "
        "room besides",
        PHYSICS,
        (
            *LEAKING,
            "heat_exchange",
            "conductance_of_state",
            "state_dependent_conductance",
            "conductance_of_moisture",
            "wet_conduction",
        ),
    )


def cloth_heater(folder: Path, rng: Rng) -> Truth:
    begin, factor = 300.0 * round(rng.uniform(4.0, 16.0)), rng.uniform(1.22, 1.4)
    _cloth(folder, rng, stronger=(begin, begin + 3000.0, factor), loggers=(Logger("s", zero=1800.0), Logger("min")))
    return Truth(
        f"the heater gave {factor:.3f} times the power that is stated, {begin / 60.0:g} min to "
        f"{begin / 60.0 + 50.0:g} min of the second recording",
        SENSOR,
        ("input_fault",),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    flap_stiffening,
    tub_null,
    generator_reversed,
    car_grip,
    nose_null,
    gel_start,
    electrolyser_crossing,
    cloth_heater,
    flap_null,
    tub_clock,
    generator_salient,
    car_gyroscope,
    nose_walls,
    gel_null,
    electrolyser_stuck,
    cloth_wetter,
    flap_lost,
    tub_dry,
    generator_two,
    car_null,
    nose_other_run,
    gel_skin,
    electrolyser_null,
    cloth_null,
    cloth_two,
)
