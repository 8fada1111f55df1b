"""Twentieth set: a motor blind, a liquid lens, an extruder, algae, a hover pallet, an air pack, a vat, a sleeve.

Written without a look at the library of laws, its proof, its tests or its thresholds, and without a diagnosis of any of
its cases; of the earlier sets, the author had read the last two and the helpers that these take from the others.
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
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import GRAVITY, integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Written, celsius, drawn_steps, write
from evaluation.strangers.sixteenth_set import later
from evaluation.strangers.tenth_set import stairs, swept
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Milliradians in a degree.
MILLIRADIANS = 1e3 * np.pi / 180.0
#: Gas constant [J/kg/K] and heat capacity at constant volume [J/kg/K] of air.
AIR_CONSTANT, AIR_CAPACITY = 287.0, 718.0
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass")
#: Laws that are true where something takes up what the model keeps in the bath.
SORBING = ("sorption", "adsorption", "wall_adsorption", *STORED)
#: Laws that are true where a conductance depends on what is across it.
CONDUCTED = ("nonlinear_conductance", "conductance_of_state", "state_dependent_conductance")
#: Laws that are true where something grows or is made less than in proportion to what there is of it.
CROWDED = ("saturation", "saturating_gain", "reaction_order", "nonlinear_rate", "rate_of_state", "state_dependent_rate")


# --- a motor blind of cloth with a spring in its tube, FMI 2 Model Exchange; s, V, N, m, rpm, mA
BLIND = OdeModel(
    "roller_blind",
    {
        "J": (0.1, "kg*m^2"),
        "k": (3.0, "V*s/rad"),
        "R": (20.0, "ohm"),
        "d": (0.05, "N*m*s/rad"),
        "r": (0.022, "m"),
        "m": (1.2, "kg"),
        "mu": (0.4, "kg/m"),
        "M_s": (0.34, "N*m"),
        "k_s": (4e-3, "N*m/rad"),
        "x_begin": (1.0, "m"),
    },
    {"volts": "V", "pull": "N"},
    {
        "x": ("m", "x_begin", "r*w"),
        "turned": ("rad", "0.0", "w"),
        "w": (
            "rad/s",
            "0.0",
            f"(k*(volts - k*w)/R - d*w + r*({GRAVITY}*(m + mu*x) + pull) - M_s - k_s*turned)/J",
        ),
    },
    {"lowered": ("m", "x"), "tube": ("rad/s", "w"), "amperes": ("A", "(volts - k*w)/R")},
    2e-3,
)
BLIND_KNOWN = {"J": 0.06, "k": 0.02, "R": 0.05, "d": 0.1, "r": 0.02, "m": 0.02, "mu": 0.04, "M_s": 0.05, "k_s": 0.08}


def _blind(
    folder: Path,
    rng: Rng,
    thick: float = 0.0,
    sign: float = 1.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Cloth on the tube may be thick [mm]: its radius is sqrt(r^2 + thick (x_begin - x)/pi).

    `sign` is that of the current clamp in the second recording.
    """
    BLIND.build(folder)
    parts = programme("bridge", ("volts", "V")) + programme("hand", ("pull", "N"))
    parts += with_numbers("blind", "roller_blind")
    wires = "  - bridge.volts -> blind.volts\n  - hand.pull -> blind.pull\n"
    scenario(folder, "A motor blind", 56.0, 0.01, 0.02, parts, wires)
    data_sheet(folder, BLIND, BLIND_KNOWN)
    inertia, k, r, d, radius, m, mu, m_s, k_s, begin = drawn(rng, BLIND, BLIND_KNOWN)

    def wound(x: float) -> float:
        """Radius at which cloth leaves the tube [m]."""
        return float(np.sqrt(radius**2 + 1e-3 * thick * (begin - x) / np.pi))

    def amperes(x: Array, u: Array) -> Array:
        return np.asarray((u[..., 0] - k * x[..., 2]) / r)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        way, turned, w = (float(s) for s in x)
        arm = wound(way)
        pulled = arm * (GRAVITY * (m + mu * way) + float(u[1]))
        return [arm * w, w, (k * float(amperes(x, u)) - d * w + pulled - m_s - k_s * turned) / inertia]

    for number, (name, stop) in enumerate((("first", 56.0), ("second", 44.0), ("third", 50.0))):
        while True:
            volts = drawn_steps(rng, stop, 3.2, -12.0, 12.0, 0.02)
            if name == "third":
                volts = telegraph(rng, stop, 3.6, -9.0, 9.0, 0.02)
            pull = bursts(rng, stop, 4.0, 2.0, 2.0, 12.0, 0.02)
            volts, pull = later(volts, 0.01), later(pull, 0.01)
            t, x = integrated(rates, (begin, 0.0, 0.0), (volts, pull), stop, 5e-3)
            if x[:, 0].min() > 0.1 and x[:, 0].max() < 1.9 and np.ptp(x[:, 0]) > 0.7:
                break
        turns = 1e3 * (sign if name == "second" else 1.0)

        def clamp(t: Array, x: Array, u: Array, turns: float = turns) -> Array:
            return turns * amperes(x, u)

        sensors = [
            Sensor("blind.lowered", "Laser m", "m", scaled(0, 1.0), 2e-3, 0.02, noise_stated, 1e-3),
            Sensor("blind.tube", "n Rohr rpm", "rpm", scaled(2, RPM), 0.3, 0.02, noise_stated, 0.1),
            Sensor("blind.amperes", "Zange mA", "mA", clamp, 5.0, 0.02, noise_stated, 1.0),
        ]
        programmes = {"bridge.volts": (volts, "V"), "hand.pull": (pull, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def blind_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=4.4e4), Logger("s", zero=-8.0, gap=(20.0, 23.6)), Logger("ms", empty=0.02))
    _blind(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, a gap of 3.6 s, empty cells, three loggers of ms and s",
        FINE,
    )


def blind_radius(folder: Path, rng: Rng) -> Truth:
    thick = rng.uniform(0.3, 0.5)
    _blind(folder, rng, thick=thick, loggers=(PLAIN, Logger("ms", zero=-700.0)))
    return Truth(
        f"cloth on the tube is {thick:.3f} mm thick: the more is wound up, the larger is the radius at which it leaves,"
        f" sqrt(r^2 + {thick:.3f} mm (x_begin - x)/pi)",
        PHYSICS,
    )


def blind_sign(folder: Path, rng: Rng) -> Truth:
    _blind(folder, rng, sign=-1.0, loggers=(Logger("s", zero=12.0), Logger("ms")))
    return Truth(
        "the current clamp is put on the wrong way round in the second recording: its sign is reversed",
        (*RECORDING, *SENSOR),
    )


# --- a liquid lens with two electrodes, focus and tilt, FMI 3 Model Exchange; ms, V, 1/m, deg, uA
LENS = OdeModel(
    "liquid_lens",
    {
        "R": (3e6, "ohm"),
        "C": (4e-9, "F"),
        "G": (2e-9, "S"),
        "P_0": (-10.0, "1/m"),
        "s": (6e-3, "1/m/V^2"),
        "w_1": (90.0, "1/s"),
        "z_1": (0.35, ""),
        "g": (3.3e-5, "1/V^2"),
        "w_2": (120.0, "1/s"),
        "z_2": (0.3, ""),
    },
    {"left": "V", "right": "V"},
    {
        "v_l": ("V", "0.0", "((left - v_l)/R - G*v_l)/C"),
        "v_r": ("V", "0.0", "((right - v_r)/R - G*v_r)/C"),
        "P": ("1/m", "P_0", "Q"),
        "Q": ("1/m/s", "0.0", "w_1*w_1*(P_0 + 0.5*s*(v_l*v_l + v_r*v_r) - P) - 2.0*z_1*w_1*Q"),
        "n": ("rad", "0.0", "o"),
        "o": ("rad/s", "0.0", "w_2*w_2*(g*(v_r*v_r - v_l*v_l) - n) - 2.0*z_2*w_2*o"),
    },
    {"power": ("1/m", "P"), "tilt": ("rad", "n"), "drawn": ("A", "(left - v_l + right - v_r)/R")},
    5e-4,
)
LENS_KNOWN = {
    "R": 0.05,
    "C": 0.06,
    "G": 0.1,
    "P_0": 0.02,
    "s": 0.05,
    "w_1": 0.04,
    "z_1": 0.1,
    "g": 0.05,
    "w_2": 0.04,
    "z_2": 0.1,
}


def _lens(
    folder: Path,
    rng: Rng,
    most: float = np.inf,
    is_misread: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The angle of contact may saturate: v^2 counts as most^2 tanh(v^2/most^2), most in V.

    The tilt of the first recording may be written in mrad.
    """
    build3(LENS, folder, has_co_simulation=False)
    parts = programme("amplifier", ("left", "V"), ("right", "V")) + with_numbers("lens", "liquid_lens")
    wires = "  - amplifier.left -> lens.left\n  - amplifier.right -> lens.right\n"
    scenario(folder, "A liquid lens", 4.8, 1e-3, 2e-3, parts, wires)
    data_sheet(folder, LENS, LENS_KNOWN)
    r, c, leaking, p_0, s, w_1, z_1, g, w_2, z_2 = drawn(rng, LENS, LENS_KNOWN)

    def counted(v: float) -> float:
        """What counts of the square of a voltage [V^2]."""
        return v * v if most == np.inf else most**2 * float(np.tanh((v / most) ** 2))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        v_l, v_r, power, swelling, tilt, tilting = (float(v) for v in x)
        left, right = counted(v_l), counted(v_r)
        return [
            ((float(u[0]) - v_l) / r - leaking * v_l) / c,
            ((float(u[1]) - v_r) / r - leaking * v_r) / c,
            swelling,
            w_1 * w_1 * (p_0 + 0.5 * s * (left + right) - power) - 2.0 * z_1 * w_1 * swelling,
            tilting,
            w_2 * w_2 * (g * (right - left) - tilt) - 2.0 * z_2 * w_2 * tilting,
        ]

    for number, (name, stop) in enumerate((("first", 4.8), ("second", 4.0), ("third", 4.4))):
        left = drawn_steps(rng, stop, 0.11, 4.0, 60.0, 2e-3)
        right = drawn_steps(rng, stop, 0.13, 4.0, 60.0, 2e-3)
        if name == "third":
            left = swept(stop, 6.0, 58.0, 0.8, 0.12, 4e-3)
        left, right = later(left, 1e-3), later(right, 1e-3)
        t, x = integrated(rates, (0.0, 0.0, p_0, 0.0, 0.0, 0.0), (left, right), stop, 5e-4)
        angle = 1e3 if is_misread and name == "first" else DEGREES

        def current(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(1e6 * (u[:, 0] - x[:, 0] + u[:, 1] - x[:, 1]) / r)

        sensors = [
            Sensor("lens.power", "Shack-Hartmann dpt", "1/m", scaled(2, 1.0), 0.1, 2e-3, noise_stated, 0.02, colour),
            Sensor(
                "lens.tilt",
                "PSD",
                "deg",
                scaled(4, angle),
                0.04 * (MILLIRADIANS if angle == 1e3 else 1.0),
                2e-3,
                noise_stated if angle != 1e3 or noise_stated is None else noise_stated / MILLIRADIANS,
                0.01,
                colour,
            ),
            Sensor("lens.drawn", "I uA", "uA", current, 0.2, 2e-3, noise_stated, 0.05, colour),
        ]
        programmes = {"amplifier.left": (left, "V"), "amplifier.right": (right, "V")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def lens_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=-250.0, gap=(1.9, 2.3)), Logger("s", zero=0.8, jitter=0.15), Logger("ms", empty=0.03))
    _lens(folder, rng, noise_stated=1.2, colour=0.3, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.3 and is stated 1.2 times too "
        "large, a gap of 0.4 s, jitter, empty cells, three loggers of ms and s",
        FINE,
    )


def lens_saturated(folder: Path, rng: Rng) -> Truth:
    most = rng.uniform(62.0, 80.0)
    _lens(folder, rng, most=most, loggers=(Logger("s", zero=3.0), Logger("ms")))
    return Truth(
        f"the angle of contact saturates: v^2 counts as {most:.2f}^2 tanh(v^2/{most:.2f}^2), v in V",
        PHYSICS,
        ("saturation", "saturating_gain"),
    )


def lens_misread(folder: Path, rng: Rng) -> Truth:
    _lens(folder, rng, is_misread=True, loggers=(Logger("ms"), Logger("s", zero=-1.0)))
    return Truth("the tilt of the first recording is in mrad, said to be in deg", (*RECORDING, *SENSOR))


# --- a small extruder for filament, two zones, FMI 2 Model Exchange; s, W, rpm, degC, MPa; room is a column
EXTRUDER = OdeModel(
    "extruder",
    {
        "C_1": (900.0, "J/K"),
        "C_2": (700.0, "J/K"),
        "C_m": (70.0, "J/K"),
        "g_12": (1.5, "W/K"),
        "g_1": (6.0, "W/K"),
        "g_2": (5.0, "W/K"),
        "h_1": (0.6, "W/K"),
        "h_2": (0.5, "W/K"),
        "k_s": (1e-4, "kg/rad"),
        "c_p": (2200.0, "J/kg/K"),
        "z": (2.5e6, "Pa*s/rad"),
        "b": (0.02, "1/K"),
        "T_begin": (463.15, "K"),
    },
    {"heat_1": "W", "heat_2": "W", "screw": "rad/s", "room": "K"},
    {
        "T_1": ("K", "T_begin", "(heat_1 - g_12*(T_1 - T_2) - g_1*(T_1 - M_1) - h_1*(T_1 - room))/C_1"),
        "T_2": ("K", "T_begin", "(heat_2 + g_12*(T_1 - T_2) - g_2*(T_2 - M_2) - h_2*(T_2 - room))/C_2"),
        "M_1": ("K", "T_begin", "(k_s*c_p*screw*(room - M_1) + g_1*(T_1 - M_1))/C_m"),
        "M_2": ("K", "T_begin", "(k_s*c_p*screw*(M_1 - M_2) + g_2*(T_2 - M_2))/C_m"),
    },
    {
        "feeding": ("K", "T_1"),
        "metering": ("K", "T_2"),
        "melt": ("K", "M_2"),
        "pressure": ("Pa", "z*screw*exp(-b*(M_2 - 463.15))"),
    },
    0.2,
)
EXTRUDER_KNOWN = {
    "C_1": 0.05,
    "C_2": 0.05,
    "C_m": 0.08,
    "g_12": 0.1,
    "g_1": 0.07,
    "g_2": 0.07,
    "h_1": 0.08,
    "h_2": 0.08,
    "k_s": 0.03,
    "z": 0.05,
    "b": 0.04,
}


def _extruder(
    folder: Path,
    rng: Rng,
    sheared: float = 0.0,
    is_swapped: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The melt may be heated as it is sheared, sheared screw^2 [W s^2/rad^2] at 190 degC, half of it in each zone.

    The cables of the two heaters may be exchanged in the second recording.
    """
    EXTRUDER.build(folder)
    parts = programme("cabinet", ("heat_1", "W"), ("heat_2", "W")) + programme("gear", ("screw", "rpm"))
    parts += programme("hall", ("room", "degC")) + with_numbers("barrel", "extruder")
    wires = (
        "  - cabinet.heat_1 -> barrel.heat_1\n  - cabinet.heat_2 -> barrel.heat_2\n  - gear.screw -> barrel.screw\n"
        "  - hall.room -> barrel.room\n"
    )
    scenario(folder, "A small extruder", 2400.0, 0.5, 1, parts, wires)
    data_sheet(folder, EXTRUDER, EXTRUDER_KNOWN)
    c_1, c_2, c_m, g_12, g_1, g_2, h_1, h_2, k_s, c_p, z, b, begin = drawn(rng, EXTRUDER, EXTRUDER_KNOWN)

    def thinned(x: Array) -> Array:
        """Viscosity of the melt in the second zone, as a multiple of that at 190 degC."""
        return np.asarray(np.exp(-b * (x[..., 3] - 463.15)))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        one, two, first, last = (float(s) for s in x)
        screw, room = float(u[2]) / RPM, float(u[3]) + CELSIUS
        carried = k_s * c_p * screw
        made = 0.5 * sheared * screw**2 * float(thinned(x))
        return [
            (float(u[0]) - g_12 * (one - two) - g_1 * (one - first) - h_1 * (one - room)) / c_1,
            (float(u[1]) + g_12 * (one - two) - g_2 * (two - last) - h_2 * (two - room)) / c_2,
            (carried * (room - first) + g_1 * (one - first) + made) / c_m,
            (carried * (first - last) + g_2 * (two - last) + made) / c_m,
        ]

    def pressure(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(1e-6 * z * u[:, 2] / RPM * thinned(x))

    for number, (name, stop) in enumerate((("first", 2400.0), ("second", 1900.0), ("third", 2100.0))):
        heat_1 = drawn_steps(rng, stop, 90.0, 80.0, 420.0, 1.0)
        heat_2 = drawn_steps(rng, stop, 110.0, 20.0, 250.0, 1.0)
        screw = drawn_steps(rng, stop, 60.0, 10.0, 75.0, 1.0)
        if name == "third":
            screw = stairs(rng, stop, 70.0, 12.0, 73.0, 5, 1.0)
        heat_1, heat_2, screw = later(heat_1, 0.5), later(heat_2, 0.5), later(screw, 0.5)
        room = ramped(rng, stop, 500.0, 21.0, 27.0, 10.0)
        is_crossed = is_swapped and name == "second"
        run = (heat_2, heat_1) if is_crossed else (heat_1, heat_2)
        t, x = integrated(rates, (begin,) * 4, (*run, screw, room), stop, 0.5)
        sensors = [
            Sensor("barrel.feeding", "TC Zone 1", "degC", celsius(0), 0.3, 1.0, noise_stated, 0.1),
            Sensor("barrel.metering", "TC Zone 2", "degC", celsius(1), 0.3, 1.0, noise_stated, 0.1),
            Sensor("barrel.melt", "TC Schmelze", "degC", celsius(3), 0.4, 1.0, noise_stated, 0.1),
            Sensor("barrel.pressure", "Dynisco MPa", "MPa", pressure, 0.08, 1.0, noise_stated, 0.02),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "cabinet.heat_1": (run[0], "W"),
                "cabinet.heat_2": (run[1], "W"),
                "gear.screw": (screw, "rpm"),
                "hall.room": (room, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["hall.room"],
            told={"cabinet.heat_1": heat_1, "cabinet.heat_2": heat_2} if is_crossed else {},
        )
        write(folder / name, rng, made)


def extruder_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("min", zero=5.0, is_comma=True),
        Logger("s", zero=-100.0, is_comma=True, gap=(800.0, 905.0)),
        Logger("h", is_comma=True, empty=0.02),
    )
    _extruder(folder, rng, noise_stated=0.86, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.16 times too small, decimal commas, a gap of 105 s, empty "
        "cells, three loggers of min, s and h",
        FINE,
    )


def extruder_sheared(folder: Path, rng: Rng) -> Truth:
    sheared = rng.uniform(1.0, 1.8)
    _extruder(folder, rng, sheared=sheared, loggers=(Logger("s", zero=40.0), Logger("min")))
    return Truth(
        f"the melt is heated as it is sheared, {sheared:.3f} W s^2/rad^2 screw^2 exp(-b (T - 190 degC)), half of it in "
        "each zone",
        PHYSICS,
        ("hidden_source",),
    )


def extruder_swapped(folder: Path, rng: Rng) -> Truth:
    _extruder(folder, rng, is_swapped=True, loggers=(PLAIN, Logger("min", zero=-2.0)))
    return Truth(
        "the cables of the two heaters are exchanged in the second recording: each had the power that is said of the "
        "other",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- algae in a lit tank, FMI 2 Co-Simulation; h, W/m^2, mL/min, L/min, g/L, mg/L; degC is a column; two rates
ALGAE = OdeModel(
    "algae",
    {
        "V": (0.01, "m^3"),
        "mu": (3e-5, "1/s"),
        "K_i": (60.0, "W/m^2"),
        "K_n": (0.02, "kg/m^3"),
        "b": (0.03, "1/K"),
        "q": (1.5e-6, "1/s"),
        "y_o": (1.4, ""),
        "y_n": (0.35, ""),
        "k_a": (170.0, "1/m^3"),
        "O_air": (8.2e-3, "kg/m^3"),
        "N_feed": (0.4, "kg/m^3"),
        "X_begin": (0.5, "kg/m^3"),
        "N_begin": (0.2, "kg/m^3"),
    },
    {"light": "W/m^2", "feed": "m^3/s", "air": "m^3/s", "warmth": "K"},
    {
        "X": (
            "kg/m^3",
            "X_begin",
            "(mu*light/(light + K_i)*N/(N + K_n)*exp(b*(warmth - 298.15)) - q - feed/V)*X",
        ),
        "O": (
            "kg/m^3",
            "O_air",
            "y_o*(mu*light/(light + K_i)*N/(N + K_n)*exp(b*(warmth - 298.15)) - q)*X + (k_a*air + feed/V)*(O_air - O)",
        ),
        "N": (
            "kg/m^3",
            "N_begin",
            "feed*(N_feed - N)/V - y_n*mu*light/(light + K_i)*N/(N + K_n)*exp(b*(warmth - 298.15))*X",
        ),
    },
    {"cells": ("kg/m^3", "X"), "oxygen": ("kg/m^3", "O"), "nitrate": ("kg/m^3", "N")},
    10.0,
)
ALGAE_KNOWN = {
    "V": 0.02,
    "mu": 0.07,
    "K_i": 0.08,
    "K_n": 0.1,
    "b": 0.1,
    "q": 0.1,
    "y_o": 0.05,
    "y_n": 0.05,
    "k_a": 0.06,
    "O_air": 0.01,
    "N_feed": 0.02,
}


def _algae(
    folder: Path,
    rng: Rng,
    shade: float = 0.0,
    dark: tuple[float, float] | None = None,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Cells may shade each other: light counts as light (1 - exp(-shade X))/(shade X), shade in L/g.

    Dark is begin and end [s] of a stretch of the first recording in which the lamp has no power. `strayed` is by how
    much [g/L] the cells at each begin are off (deviation), which is stated.
    """
    ALGAE.build(folder)
    pumps = (("doser", "feed", "mL/min"), ("sparger", "air", "L/min"))
    names = (("leds", "light", "W/m^2"), *pumps, ("bath", "warmth", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("tank", "algae", "internal")
    wires = "".join(f"  - {c}.{n} -> tank.{n}\n" for c, n, _ in names)
    scenario(folder, "Algae in a lit tank", 259200.0, 120, 240, parts, wires)
    data_sheet(folder, ALGAE, ALGAE_KNOWN)
    volume, mu, k_i, k_n, b, q, y_o, y_n, k_a, o_air, n_feed, usual, n_begin = drawn(rng, ALGAE, ALGAE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Oxygen is in mg/L, the others in g/L."""
        cells, oxygen, nitrate = (float(s) for s in x)
        light = float(u[0])
        if shade:
            light *= -float(np.expm1(-shade * cells)) / (shade * cells)
        grown = mu * light / (light + k_i) * nitrate / (nitrate + k_n) * np.exp(b * (float(u[3]) + CELSIUS - 298.15))
        renewed = float(u[1]) / 6e7 / volume
        aired = k_a * float(u[2]) / 6e4 + renewed
        return [
            (grown - q - renewed) * cells,
            1e3 * y_o * (grown - q) * cells + aired * (1e3 * o_air - oxygen),
            renewed * (n_feed - nitrate) - y_n * grown * cells,
        ]

    for number, (name, stop) in enumerate((("first", 259200.0), ("second", 216000.0), ("third", 240000.0))):
        light = drawn_steps(rng, stop, 11000.0, 10.0, 220.0, 240.0)
        if name == "third":
            light = wandering(rng, stop, 10000.0, 15.0, 215.0, 240.0)
        feed = drawn_steps(rng, stop, 19000.0, 0.5, 9.0, 240.0)
        air = drawn_steps(rng, stop, 15000.0, 0.8, 3.5, 240.0)
        light, feed, air = later(light, 120.0), later(feed, 120.0), later(air, 120.0)
        warmth = ramped(rng, stop, 43200.0, 22.0, 30.0, 960.0)
        run = light
        if dark is not None and name == "first":
            run = between(light, dark[0], dark[1], lambda v: 0.0)
        said = float(f"{usual + rng.uniform(-0.15, 0.25):.3g}") if strayed else usual
        start = (said + strayed * float(rng.normal()), 1e3 * o_air, n_begin)
        t, x = integrated(rates, start, (run, feed, air, warmth), stop, 120.0)
        sensors = [
            Sensor("tank.cells", "OD g/L", "g/L", scaled(0, 1.0), 8e-3, 240.0, noise_stated, 2e-3),
            Sensor("tank.oxygen", "Optode mg/L", "mg/L", scaled(1, 1.0), 0.05, 240.0, noise_stated, 0.01),
            Sensor("tank.nitrate", "ISE mg/L", "mg/L", scaled(2, 1e3), 2.0, 480.0, noise_stated, 0.5),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"tank": {"parameters": {"X_begin": f"{said:.6g} g/L"}}}
            sidecar["uncertain"] = {"tank.X_begin": f"{strayed:g} g/L"}
        made = Written(
            t,
            x,
            sensors,
            {
                "leds.light": (run, "W/m^2"),
                "doser.feed": (feed, "mL/min"),
                "sparger.air": (air, "L/min"),
                "bath.warmth": (warmth, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["bath.warmth"],
            sidecar=sidecar,
            told={} if run is light else {"leds.light": light},
        )
        write(folder / name, rng, made)


def algae_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=100.0, gap=(90000.0, 104000.0)), Logger("min", zero=-60.0), Logger("s", empty=0.02))
    _algae(folder, rng, strayed=0.03, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, cells at the begin are stated and off by 0.03 g/L (deviation), which is "
        "stated too, noise is not stated, two rates, a gap of 3.9 h, empty cells, three loggers of h, min and s, "
        "Co-Simulation",
        FINE,
    )


def algae_shade(folder: Path, rng: Rng) -> Truth:
    shade = rng.uniform(1.6, 2.6)
    _algae(folder, rng, shade=shade, loggers=(Logger("h", zero=2.0), Logger("min")))
    return Truth(
        f"cells X shade each other: light counts as light (1 - exp(-{shade:.3f} L/g X))/({shade:.3f} L/g X)",
        PHYSICS,
        CROWDED,
    )


def algae_dark(folder: Path, rng: Rng) -> Truth:
    begin = 240.0 * round(rng.uniform(250.0, 700.0)) + 120.0
    _algae(folder, rng, dark=(begin, begin + 36000.0), loggers=(Logger("min", zero=9.0), Logger("h")))
    return Truth(
        f"the lamp has no power for 10 h from {begin / 3600.0:.2f} h of the first recording on, and is said to be lit",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- fan (FMI 2, Model Exchange) and skirt (FMI 3, Co-Simulation) of a hover pallet; V, N, rpm, A, L/s, Pa, mm
FAN = OdeModel(
    "pallet_fan",
    {
        "k": (0.12, "V*s/rad"),
        "R": (0.8, "ohm"),
        "J": (4e-3, "kg*m^2"),
        "k_q": (5e-7, "N*m*s^2/rad^2"),
        "D": (1.2e-4, "m^3/rad"),
        "s": (1.5e-5, "m^3/s/Pa"),
        "w_begin": (300.0, "rad/s"),
    },
    {"volts": "V", "back": "Pa"},
    {"w": ("rad/s", "w_begin", "(k*(volts - k*w)/R - k_q*w*w - D*back)/J")},
    {"speed": ("rad/s", "w"), "amperes": ("A", "(volts - k*w)/R"), "flow": ("m^3/s", "D*w - s*back")},
    1e-3,
)
SKIRT = OdeModel(
    "skirt",
    {
        "A": (0.25, "m^2"),
        "C_a": (8e-7, "m^3/Pa"),
        "L": (0.35, "m"),
        "rho": (1.19, "kg/m^3"),
        "m": (10.0, "kg"),
        "d": (300.0, "N*s/m"),
        "p_begin": (480.0, "Pa"),
        "h_begin": (3e-3, "m"),
    },
    {"flow": "m^3/s", "load": "N"},
    {
        "p": ("Pa", "p_begin", "(flow - L*fmax(h, 0.0)*sqrt(2.0*fmax(p, 0.0)/rho) - A*v)/C_a"),
        "h": ("m", "h_begin", "v"),
        "v": ("m/s", "0.0", f"(A*p - d*v - load)/m - {GRAVITY}"),
    },
    {"pressure": ("Pa", "p"), "height": ("m", "h")},
    5e-4,
)
FAN_KNOWN = {"k": 0.02, "R": 0.05, "J": 0.06, "k_q": 0.08, "D": 0.03, "s": 0.08}
SKIRT_KNOWN = {"A": 0.02, "C_a": 0.1, "L": 0.06, "m": 0.02, "d": 0.1}


def _hover(
    folder: Path,
    rng: Rng,
    porous: float = 0.0,
    dry: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; the cloth of the skirt may let through porous p [L/s/Pa]; the fan's bearings may rub with `dry` N m."""
    FAN.build(folder)
    build3(SKIRT, folder, has_exchange=False)
    data_sheet(folder, SKIRT, SKIRT_KNOWN)
    (folder / "numbers.yaml").rename(folder / "skirt.yaml")
    data_sheet(folder, FAN, FAN_KNOWN)
    parts = (
        programme("lever", ("volts", "V"))
        + programme("hand", ("load", "N"))
        + with_numbers("fan", "pallet_fan")
        + with_numbers("skirt", "skirt", "internal").replace("numbers.yaml", "skirt.yaml")
    )
    wires = (
        "  - lever.volts -> fan.volts\n  - hand.load -> skirt.load\n  - fan.flow -> skirt.flow\n"
        "  - skirt.pressure -> fan.back\n"
    )
    scenario(folder, "A hover pallet", 28.0, 0.01, 0.02, parts, wires)
    k, r, inertia, k_q, delivered, slip, w_begin = drawn(rng, FAN, FAN_KNOWN)
    area, c_a, rim, rho, m, d, p_begin, h_begin = drawn(rng, SKIRT, SKIRT_KNOWN)

    def blown(x: Array) -> Array:
        """Of the fan [L/s], of its speed and the pressure [Pa]."""
        return np.asarray(1e3 * (delivered * x[..., 0] - slip * x[..., 1]))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Height is in mm."""
        w, p, height, v = (float(s) for s in x)
        rim_lost = rim * max(height, 0.0) * np.sqrt(2.0 * max(p, 0.0) / rho)
        return [
            (k * (float(u[0]) - k * w) / r - k_q * w * w - delivered * p - dry * np.tanh(w / 2.0)) / inertia,
            1e-3 * (float(blown(x)) - rim_lost - porous * p - area * v) / c_a,
            v,
            1e3 * ((area * p - 1e-3 * d * v - float(u[1])) / m - GRAVITY),
        ]

    for number, (name, stop) in enumerate((("first", 28.0), ("second", 22.0), ("third", 25.0))):
        volts = drawn_steps(rng, stop, 1.6, 34.0, 52.0, 0.02)
        if name == "third":
            volts = telegraph(rng, stop, 1.4, 35.0, 51.0, 0.02)
        load = ramped(rng, stop, 2.0, 0.0, 80.0, 0.1)
        volts, load = later(volts, 0.01), later(load, 0.01)
        t, x = integrated(rates, (w_begin, p_begin, 1e3 * h_begin, 0.0), (volts, load), stop, 5e-3)

        def amperes(t: Array, x: Array, u: Array) -> Array:
            return np.asarray((u[:, 0] - k * x[:, 0]) / r)

        sensors = [
            Sensor("fan.speed", "Hall rpm", "rpm", scaled(0, RPM), 8.0, 0.02, noise_stated, 2.0),
            Sensor("fan.amperes", "I_fan/A", "A", amperes, 0.03, 0.02, noise_stated, 0.01),
            Sensor("fan.flow", "vane L/s", "L/s", lambda t, x, u: blown(x), 0.3, 0.04, noise_stated, 0.1),
            Sensor("skirt.pressure", "dp Pa", "Pa", scaled(1, 1.0), 5.0, 0.02, noise_stated, 1.0),
            Sensor("skirt.height", "Laser mm", "mm", scaled(2, 1.0), 0.04, 0.02, noise_stated, 0.01),
        ]
        programmes = {"lever.volts": (volts, "V"), "hand.load": (load, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def hover_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=17.0), Logger("ms", zero=-3e3, gap=(9.0, 11.5)), Logger("min", empty=0.02))
    _hover(folder, rng, noise_stated=1.15, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, noise stated 1.15 times too large, two rates, a gap of 2.5 s, empty "
        "cells, three loggers of s, ms and min",
        FINE,
    )


def hover_porous(folder: Path, rng: Rng) -> Truth:
    porous = rng.uniform(9e-3, 1.5e-2)
    _hover(folder, rng, porous=porous, loggers=(Logger("ms"), Logger("s", zero=-4.0)))
    return Truth(f"the cloth of the skirt lets air through, {porous:.4f} L/s/Pa p", PHYSICS, LEAKING)


def hover_two(folder: Path, rng: Rng) -> Truth:
    porous, dry = rng.uniform(9e-3, 1.5e-2), rng.uniform(0.03, 0.05)
    _hover(folder, rng, porous=porous, dry=dry, loggers=(PLAIN, Logger("min", zero=2.0)))
    return Truth(
        f"the cloth of the skirt lets air through, {porous:.4f} L/s/Pa p, and the bearings of the fan rub with "
        f"{1e3 * dry:.1f} mN m",
        PHYSICS,
        (*LEAKING, *RUBBING),
    )


def hover_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(8e-3, 1.4e-2) * rng.choice([-1.0, 1.0])
    _hover(folder, rng, loggers=(Logger("s", rate=1.0 + fast), Logger("ms"), Logger("s", zero=60.0)))
    return Truth(
        f"the clock of the first recording is off by {100 * fast:+.2f} % (fast is +), which is not stated",
        (*RECORDING, *SENSOR),
    )


# --- a bottle of air that a soft robot carries, and its limb, FMI 3 Co-Simulation; s, %, bar, kPa, g/min
AIRPACK = OdeModel(
    "air_pack",
    {
        "V_b": (3.5e-4, "m^3"),
        "c_v": (2.5e-11, "kg/s/Pa"),
        "c_o": (7.5e-10, "kg/s/Pa"),
        "V_l": (1.2e-4, "m^3"),
        "c_l": (2e-9, "m^3/Pa"),
        "T": (296.15, "K"),
        "p_room": (1.01e5, "Pa"),
        "p_begin": (2e6, "Pa"),
    },
    {"fill": "", "vent": ""},
    {
        "p_b": ("Pa", "p_begin", f"-{AIR_CONSTANT}*T*c_v*fill*p_b/V_b"),
        "p_l": (
            "Pa",
            "0.0",
            f"{AIR_CONSTANT}*T*(c_v*fill*p_b - c_o*vent*p_l)/(V_l + c_l*(2.0*p_l + p_room))",
        ),
    },
    {"bottle": ("Pa", "p_b"), "limb": ("Pa", "p_l"), "supplied": ("kg/s", "c_v*fill*p_b")},
    0.02,
)
AIRPACK_KNOWN = {"V_b": 0.03, "c_v": 0.05, "c_o": 0.06, "V_l": 0.06, "c_l": 0.06}


def _airpack(
    folder: Path,
    rng: Rng,
    wall: float = np.inf,
    missing: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The air in the bottle may cool as it expands, the wall warms it with `wall` W/K.

    In the second recording, the bottle may be less full at the begin than is said, by a share that is missing.
    """
    build3(AIRPACK, folder, has_exchange=False)
    names = (("valve_1", "fill"), ("valve_2", "vent"))
    parts = "".join(programme(c, (n, "'%'")).replace("0 '%'", "0 %") for c, n in names)
    parts += with_numbers("pack", "air_pack", "internal")
    wires = "".join(f"  - {c}.{n} -> pack.{n}\n" for c, n in names)
    scenario(folder, "A bottle of air for a soft robot", 300.0, 0.1, 0.2, parts, wires)
    data_sheet(folder, AIRPACK, AIRPACK_KNOWN)
    v_b, c_v, c_o, v_l, c_l, warm, p_room, p_begin = drawn(rng, AIRPACK, AIRPACK_KNOWN)

    def bottle(x: Array) -> Array:
        """Pressure in the bottle [bar], of the air in it [g] and its temperature [K]."""
        return np.asarray(1e-8 * x[..., 0] * AIR_CONSTANT * x[..., 1] / v_b)

    def supplied(x: Array, fill: Array) -> Array:
        """To the limb [g/s]."""
        return np.asarray(1e6 * c_v * fill * bottle(x) * np.sqrt(warm / x[..., 1]))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The limb's pressure is in kPa."""
        left, air, p = (float(s) for s in x)
        gone = float(supplied(x, u[0]))
        vented = 1e4 * c_o * float(u[1]) * p
        cooled = 0.0
        if wall < np.inf:
            cooled = (wall * (warm - air) - 1e-3 * gone * AIR_CONSTANT * air) / (1e-3 * left * AIR_CAPACITY)
        grows = v_l + 1e3 * c_l * (2.0 * p + 1e-3 * p_room)
        return [-gone, cooled, 1e-6 * AIR_CONSTANT * warm * (gone - vented) / grows]

    for number, (name, stop) in enumerate((("first", 300.0), ("second", 240.0), ("third", 270.0))):
        fill = drawn_steps(rng, stop, 9.0, 0.0, 75.0, 0.2)
        if name == "third":
            fill = bursts(rng, stop, 6.0, 8.0, 20.0, 75.0, 0.2)
        vent = drawn_steps(rng, stop, 13.0, 15.0, 100.0, 0.2)
        fill, vent = later(fill, 0.1), later(vent, 0.1)
        full = 1e3 * p_begin * v_b / (AIR_CONSTANT * warm) * (1.0 - (missing if name == "second" else 0.0))
        t, x = integrated(rates, (full, warm, 0.0), (fill, vent), stop, 0.05)
        sensors = [
            Sensor("pack.bottle", "p_1 bar", "bar", lambda t, x, u: bottle(x), 0.03, 0.2, noise_stated, 0.01),
            Sensor("pack.limb", "p_2 kPa", "kPa", scaled(2, 1.0), 0.3, 0.2, noise_stated, 0.1),
            Sensor(
                "pack.supplied",
                "MFM g/min",
                "g/min",
                lambda t, x, u: 60.0 * supplied(x, u[:, 0]),
                0.02,
                0.2,
                noise_stated,
                5e-3,
            ),
        ]
        programmes = {"valve_1.fill": (fill, "%"), "valve_2.vent": (vent, "%")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def airpack_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", jitter=0.2), Logger("s", zero=444.0, empty=0.03), Logger("ms", gap=(100.0, 114.0)))
    _airpack(folder, rng, noise_stated=0.87, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.15 times too small, jitter, empty cells, a gap of 14 s, three "
        "loggers of min, s and ms, Co-Simulation",
        FINE,
    )


def airpack_cold(folder: Path, rng: Rng) -> Truth:
    wall = rng.uniform(0.08, 0.15)
    _airpack(folder, rng, wall=wall, loggers=(PLAIN, Logger("min", zero=-1.5)))
    return Truth(
        f"the air in the bottle cools as it expands; the wall, which stays warm, heats it with {wall:.4f} W/K",
        PHYSICS,
        STORED,
    )


def airpack_start(folder: Path, rng: Rng) -> Truth:
    missing = rng.uniform(0.06, 0.11)
    _airpack(folder, rng, missing=missing, loggers=(Logger("s", zero=5.0), Logger("min")))
    return Truth(
        f"the bottle has {100 * missing:.1f} % less air at the begin of the second recording than is said",
        (*RECORDING, *SENSOR),
    )


# --- a wool dyer's vat, which acid and lye hold at its pH, FMI 3, both interfaces, without units; warm is a column
VAT = OdeModel(
    "vat",
    {
        "V": (40.0, ""),
        "c_acid": (2.0, ""),
        "c_lye": (1.0, ""),
        "pK": (4.76, ""),
        "k_0": (0.3, ""),
        "k_n": (0.075, ""),
        "b": (0.02, ""),
        "A_begin": (30.0, ""),
        "N_begin": (14.0, ""),
    },
    {"acid": "", "lye": "", "fresh": "", "warm": ""},
    {
        "A": ("", "A_begin", "(acid*c_acid - (fresh + 0.001*(acid + lye))*A)/(60.0*V)"),
        "N": ("", "N_begin", "(lye*c_lye - (fresh + 0.001*(acid + lye))*N)/(60.0*V)"),
    },
    {
        "ph": ("", "pK + log10(fmax(N, 0.001)/fmax(A - N, 0.001))"),
        "conducts": ("", "(k_0 + k_n*N)*(1.0 + b*(warm - 50.0))"),
    },
    2.5,
)
VAT_KNOWN = {"V": 0.03, "c_acid": 0.04, "c_lye": 0.03, "pK": 0.004, "k_0": 0.06, "k_n": 0.04, "b": 0.05}


def _vat(
    folder: Path,
    rng: Rng,
    bound: float = 0.0,
    slow: float = 1.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Wool in the vat may bind acid, `bound` (A - N) of the bath at last, with a time constant `slow` [s].

    The second recording may be said to have had the lye of another run.
    """
    build3(VAT, folder)
    names = (("pump_1", "acid"), ("pump_2", "lye"), ("tap", "fresh"), ("steam", "warm"))
    parts = "".join(programme(c, (n, "")) for c, n in names) + with_numbers("bath", "vat")
    wires = "".join(f"  - {c}.{n} -> bath.{n}\n" for c, n in names)
    scenario(folder, "A vat of a wool dyer", 7200.0, 2.5, 5, parts, wires)
    data_sheet(folder, VAT, VAT_KNOWN)
    volume, c_acid, c_lye, pk, k_0, k_n, b, a_begin, n_begin = drawn(rng, VAT, VAT_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        acetate, sodium, held = (float(s) for s in x)
        out = float(u[2]) + 1e-3 * (float(u[0]) + float(u[1]))
        taken = (bound * (acetate - sodium) - held) / slow
        return [
            (float(u[0]) * c_acid - out * acetate) / (60.0 * volume) - taken,
            (float(u[1]) * c_lye - out * sodium) / (60.0 * volume),
            taken,
        ]

    def conducts(t: Array, x: Array, u: Array) -> Array:
        return np.asarray((k_0 + k_n * x[:, 1]) * (1.0 + b * (u[:, 3] - 50.0)))

    other = later(drawn_steps(rng, 6000.0, 330.0, 14.0, 40.0, 5.0), 2.5)
    for number, (name, stop) in enumerate((("first", 7200.0), ("second", 6000.0), ("third", 6600.0))):
        acid = drawn_steps(rng, stop, 280.0, 14.0, 46.0, 5.0)
        if name == "third":
            acid = telegraph(rng, stop, 260.0, 17.0, 43.0, 5.0)
        lye = drawn_steps(rng, stop, 330.0, 14.0, 40.0, 5.0)
        fresh = drawn_steps(rng, stop, 500.0, 0.8, 3.2, 5.0)
        acid, lye, fresh = later(acid, 2.5), later(lye, 2.5), later(fresh, 2.5)
        warm = ramped(rng, stop, 1200.0, 42.0, 58.0, 50.0)
        start = (a_begin, n_begin, bound * (a_begin - n_begin))
        t, x = integrated(rates, start, (acid, lye, fresh, warm), stop, 1.25)
        sensors = [
            Sensor(
                "bath.ph",
                "pH",
                "1",
                lambda t, x, u: pk + np.log10(x[:, 1] / (x[:, 0] - x[:, 1])),
                8e-3,
                5.0,
                noise_stated,
                2e-3,
                wild=wild,
            ),
            Sensor("bath.conducts", "LF mS/cm", "1", conducts, 0.012, 10.0, noise_stated, 5e-3, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "pump_1.acid": (acid, ""),
                "pump_2.lye": (lye, ""),
                "tap.fresh": (fresh, ""),
                "steam.warm": (warm, ""),
            },
            loggers[number % len(loggers)],
            recorded=["steam.warm"],
            told={"pump_2.lye": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "level cm", lambda n: np.asarray(61.5 + 0.2 * rng.standard_normal(n)))


def vat_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=30.0), Logger("h", zero=-1.0, jitter=0.1), Logger("s", gap=(2500.0, 2900.0)))
    _vat(folder, rng, wild=0.006, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, no units, wild readings, noise stated rightly, two rates, a column that "
        "nothing names, jitter, a gap of 400 s, three loggers of min, h and s",
        FINE,
    )


def vat_wool(folder: Path, rng: Rng) -> Truth:
    bound, slow = rng.uniform(0.4, 0.65), rng.uniform(250.0, 450.0)
    _vat(folder, rng, bound=bound, slow=slow, loggers=(Logger("s", zero=1e4), Logger("min")))
    return Truth(
        f"wool in the vat binds acid, {bound:.3f} (A - N) at last, with a time constant of {slow:.0f} s",
        PHYSICS,
        SORBING,
    )


def vat_other_run(folder: Path, rng: Rng) -> Truth:
    _vat(folder, rng, is_other=True, loggers=(PLAIN, Logger("min", zero=-5.0), Logger("h")))
    return Truth("the second recording is said to have had the lye of another run", (*RECORDING, *SENSOR))


# --- a sleeve with cloth electrodes that makes a muscle lift the forearm, FMI 2 Co-Simulation; ms, V, N, deg, rad/s, mA
SLEEVE = OdeModel(
    "pulse_sleeve",
    {
        "R_s": (900.0, "ohm"),
        "R_p": (2500.0, "ohm"),
        "C_p": (4e-4, "F"),
        "i_h": (3.5e-4, "A"),
        "i_s": (1.6e-4, "A"),
        "tau": (0.12, "s"),
        "M": (12.0, "N*m"),
        "I": (0.12, "kg*m^2"),
        "k": (5.0, "N*m/rad"),
        "c": (0.7, "N*m*s/rad"),
        "G": (4.0, "N*m"),
        "r": (0.04, "m"),
    },
    {"pulses": "V", "weight": "N"},
    {
        "v": ("V", "0.0", "((pulses - v)/R_s - v/R_p)/C_p"),
        "a": ("", "0.0", "(0.5 + 0.5*tanh(((pulses - v)/R_s - i_h)/i_s) - a)/tau"),
        "bend": ("rad", "0.0", "turn"),
        "turn": ("rad/s", "0.0", "(M*a - k*bend - c*turn - G*sin(bend) - r*weight)/I"),
    },
    {"elbow": ("rad", "bend"), "gyro": ("rad/s", "turn"), "drawn": ("A", "(pulses - v)/R_s")},
    1e-3,
)
SLEEVE_KNOWN = {
    "R_s": 0.05,
    "R_p": 0.07,
    "C_p": 0.08,
    "i_h": 0.05,
    "i_s": 0.07,
    "tau": 0.08,
    "M": 0.06,
    "I": 0.05,
    "k": 0.06,
    "c": 0.1,
    "G": 0.04,
    "r": 0.01,
}


def _sleeve(
    folder: Path,
    rng: Rng,
    tired: float = 0.0,
    slow: float = 1.0,
    eased: float = np.inf,
    share: float = 0.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The muscle may tire, `tired` of its torque at last where it is fully active, with a time constant `slow` [s].

    Skin may conduct the better, the more voltage it has, v (1 + (v/eased)^2)/R_p, eased in V. The goniometer may end,
    in the second recording, at what is exceeded for a `share` of the time.
    """
    SLEEVE.build(folder)
    parts = programme("stimulator", ("pulses", "V")) + programme("cable", ("weight", "N"))
    parts += with_numbers("arm", "pulse_sleeve", "internal")
    wires = "  - stimulator.pulses -> arm.pulses\n  - cable.weight -> arm.weight\n"
    scenario(folder, "A sleeve that makes a muscle lift", 48.0, 0.01, 0.02, parts, wires)
    data_sheet(folder, SLEEVE, SLEEVE_KNOWN)
    r_s, r_p, c_p, i_h, i_s, tau, most, inertia, k, c, hanging, r = drawn(rng, SLEEVE, SLEEVE_KNOWN)

    def current(x: Array, pulses: Array) -> Array:
        """Mean of the pulses [A]."""
        return np.asarray((pulses - x[..., 0]) / r_s)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        v, active, bend, turn, spent = (float(s) for s in x)
        i = float(current(x, u[0]))
        torque = most * (1.0 - spent) * active
        return [
            (i - v * (1.0 + (v / eased) ** 2) / r_p) / c_p,
            (0.5 + 0.5 * np.tanh((i - i_h) / i_s) - active) / tau,
            turn,
            (torque - k * bend - c * turn - hanging * np.sin(bend) - r * float(u[1])) / inertia,
            (tired * active - spent) / slow,
        ]

    for number, (name, stop) in enumerate((("first", 48.0), ("second", 40.0), ("third", 44.0))):
        pulses = drawn_steps(rng, stop, 1.3, 0.2, 2.1, 0.02)
        if name == "third":
            pulses = telegraph(rng, stop, 1.2, 0.4, 1.9, 0.02)
        weight = drawn_steps(rng, stop, 3.5, 2.0, 28.0, 0.02)
        pulses, weight = later(pulses, 0.01), later(weight, 0.01)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0, 0.0), (pulses, weight), stop, 5e-3)
        end = np.inf
        if share and name == "second":
            end = float(f"{DEGREES * np.quantile(x[:, 2], 1.0 - share):.0f}")

        def spoil(column: str, t: Array, v: Array, end: float = end) -> Array:
            return np.minimum(v, end) if column == "Gonio deg" else v

        sensors = [
            Sensor("arm.elbow", "Gonio deg", "deg", scaled(2, DEGREES), 0.3, 0.02, 1.0, 0.1),
            Sensor("arm.gyro", "IMU wz", "rad/s", scaled(3, 1.0), 0.03, 0.02, 1.0, 5e-3),
            Sensor("arm.drawn", "I mean mA", "mA", lambda t, x, u: 1e3 * current(x, u[:, 0]), 6e-3, 0.02, 1.0, 2e-3),
        ]
        programmes = {"stimulator.pulses": (pulses, "V"), "cable.weight": (weight, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)], spoil=spoil))


def sleeve_tired(folder: Path, rng: Rng) -> Truth:
    tired, slow = rng.uniform(0.2, 0.35), rng.uniform(10.0, 18.0)
    _sleeve(folder, rng, tired=tired, slow=slow, loggers=(Logger("ms", zero=90.0), PLAIN))
    return Truth(
        f"the muscle tires, {tired:.3f} of its torque at last where it is fully active, with a time constant of "
        f"{slow:.2f} s, and recovers likewise",
        PHYSICS,
        ("hidden_state",),
    )


def sleeve_two(folder: Path, rng: Rng) -> Truth:
    tired, slow, eased = rng.uniform(0.2, 0.35), rng.uniform(10.0, 18.0), rng.uniform(0.9, 1.3)
    _sleeve(folder, rng, tired=tired, slow=slow, eased=eased, loggers=(PLAIN, Logger("ms", zero=-60.0)))
    return Truth(
        f"the muscle tires, {tired:.3f} of its torque at last where it is fully active, with a time constant of "
        f"{slow:.2f} s, and skin conducts the better, the more voltage v it has: v (1 + (v/{eased:.3f} V)^2)/R_p",
        PHYSICS,
        ("hidden_state", *CONDUCTED),
    )


def sleeve_clipped(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.07, 0.11)
    _sleeve(folder, rng, share=share, loggers=(Logger("s", zero=0.5), Logger("ms")))
    return Truth(
        f"the goniometer ends at what {100 * share:.0f} % of the second recording exceed, which is not stated",
        SENSOR,
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    blind_radius,
    lens_null,
    extruder_swapped,
    algae_shade,
    hover_null,
    airpack_start,
    vat_null,
    sleeve_tired,
    blind_null,
    lens_misread,
    extruder_sheared,
    algae_dark,
    hover_porous,
    airpack_null,
    vat_other_run,
    sleeve_two,
    blind_sign,
    lens_saturated,
    extruder_null,
    algae_null,
    hover_clock,
    airpack_cold,
    vat_wool,
    sleeve_clipped,
    hover_two,
)
