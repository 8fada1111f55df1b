"""Twenty-fifth set: an incubator, a flow battery, a wind turbine, a train's brake, a sauna, a showcase, salt, an arm.

Written by an author who had read neither the library of laws nor its proof nor its tests nor its thresholds, and who
had not run a diagnosis, of these cases or of any other; of the earlier sets, the author had read two and the helpers
that these take from the others. Truths are integrated from equations that stand here, by scipy or, of the arm and its
coil, by a scheme of their own. How large an effect is, and how far the numbers are off, is drawn; the deviations of the
numbers are those that a parameter set states. Recordings of a rig differ in length and in logger; the one that is held
out was partly made with a programme of another kind, within the range of the others.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.eighth_set import idle_column
from evaluation.strangers.eleventh_set import DEGREES, RPM, telegraph
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import GRAVITY, integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.sixteenth_set import later
from evaluation.strangers.tenth_set import stairs
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Charge of a mole [C/mol], gas constant [J/(mol*K)], heat of evaporation of water [J/kg], density of air [kg/m^3].
FARADAY, GAS, EVAPORATION, AIR = 96485.0, 8.314462618, 2.4e6, 1.2
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass", "hidden_storage")
#: Laws that are true where something wears with what went through it, or with time.
WORN = ("wear", "fouling", "clogging", "ageing", "aging", "degradation", "drift_of_parameter", "hidden_state")
#: Laws that are true where something begins at a value.
BEGINNING = ("threshold", "dead_zone", "dead_band", "onset")
#: Laws that are true where a number depends on a state.
RATED = ("nonlinear_rate", "rate_of_state", "state_dependent_rate", "parameter_of_state", "interaction")
#: Laws that are true where heat passes better with a difference of temperatures.
CONVECTING = (
    *RATED,
    "natural_convection",
    "convection",
    "nonlinear_conductance",
    "nonlinear_heat_loss",
    "state_dependent_conductance",
    "conductance_of_state",
    "heat_transfer_of_state",
)
#: Laws that are true where an input counts less with a state.
FADING = (*BEGINNING, *RATED, "saturation", "state_dependent_gain", "gain_of_state", "gain_of_input", "side_reaction")
#: Laws that are true where more leaks the larger a difference is.
DRAWING = (*RATED, "leakage", "leak", "nonlinear_leakage", "nonlinear_loss", "stack_effect", "natural_convection")
#: Laws that are true where something rubs.
RUBBING = ("dry_friction", "coulomb_friction", "stribeck_friction", "friction", "hysteresis", "backlash", "stiction")
#: Laws that are true where salt piles up before a membrane.
PILING = (*RATED, "concentration_polarisation", "concentration_polarization", "boundary_layer")
#: Laws that are true where what moves is cooled better.
FANNING = (*RATED, "forced_convection", "velocity_dependent_cooling", "conductance_of_state", "heat_transfer_of_state")


# --- an incubator with a phantom of an infant, FMI 2 Model Exchange; min, W, g/h, degC, g/m^3
INCUBATOR = OdeModel(
    "incubator",
    {
        "C_h": (150.0, "J/K"),
        "U_h": (4.0, "W/K"),
        "C_a": (900.0, "J/K"),
        "U_aw": (5.0, "W/K"),
        "C_w": (6000.0, "J/K"),
        "U_wr": (4.0, "W/K"),
        "C_s": (700.0, "J/K"),
        "U_as": (0.9, "W/K"),
        "C_c": (3200.0, "J/K"),
        "G": (1.6, "W/K"),
        "V": (0.12, "m^3"),
        "q": (8e-5, "m^3/s"),
        "k_e": (2e-5, "m^3/s"),
        "w_35": (0.0396, "kg/m^3"),
        "b": (0.053, "1/K"),
        "w_room": (0.008, "kg/m^3"),
        "T_air": (305.15, "K"),
        "T_skin": (307.15, "K"),
        "w_begin": (0.015, "kg/m^3"),
    },
    {"heat": "W", "mist": "kg/s", "pad": "W", "room": "K"},
    {
        "T_h": ("K", "T_air", "(heat - U_h*(T_h - T_a))/C_h"),
        "T_a": (
            "K",
            "T_air",
            "(U_h*(T_h - T_a) - U_aw*(T_a - T_w) - U_as*(T_a - T_s) - 1200.0*q*(T_a - room))/C_a",
        ),
        "T_w": ("K", "T_air", "(U_aw*(T_a - T_w) - U_wr*(T_w - room))/C_w"),
        "T_s": (
            "K",
            "T_skin",
            f"(U_as*(T_a - T_s) + G*(T_c - T_s) - {EVAPORATION}*k_e*(w_35*exp(b*(T_s - 308.15)) - w))/C_s",
        ),
        "T_c": ("K", "T_skin", "(pad - G*(T_c - T_s))/C_c"),
        "w": ("kg/m^3", "w_begin", "(mist + k_e*(w_35*exp(b*(T_s - 308.15)) - w) - q*(w - w_room))/V"),
    },
    {"air": ("K", "T_a"), "skin": ("K", "T_s"), "core": ("K", "T_c"), "vapour": ("kg/m^3", "w")},
    0.5,
)
INCUBATOR_KNOWN = {
    "C_h": 0.08,
    "U_h": 0.05,
    "C_a": 0.06,
    "U_aw": 0.05,
    "C_w": 0.05,
    "U_wr": 0.05,
    "C_s": 0.06,
    "U_as": 0.06,
    "C_c": 0.03,
    "G": 0.06,
    "V": 0.02,
    "q": 0.06,
    "k_e": 0.08,
}


def _incubator(
    folder: Path,
    rng: Rng,
    convects: float = np.inf,
    loose: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """The oil in the phantom may convect: G (1 + |T_c - T_s|/convects), convects in K.

    Loose are an instant of the second recording [s] from which on the probe on the skin shows in part the air, and what
    part of it.
    """
    INCUBATOR.build(folder)
    names = (("heater", "heat", "W"), ("mister", "mist", "g/h"), ("phantom", "pad", "W"), ("ward", "room", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("crib", "incubator")
    wires = "".join(f"  - {c}.{n} -> crib.{n}\n" for c, n, _ in names)
    scenario(folder, "An incubator with a phantom", 14400.0, 10, 20, parts, wires)
    data_sheet(folder, INCUBATOR, INCUBATOR_KNOWN)
    c_h, u_h, c_a, u_aw, c_w, u_wr, c_s, u_as, c_c, g, volume, q, k_e, *more = drawn(rng, INCUBATOR, INCUBATOR_KNOWN)
    w_35, b, w_room, air_0, skin_0, w_begin = more

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Vapour is in g/m^3."""
        heater, air, wall, skin, core, vapour = (float(s) for s in x)
        room = float(u[3]) + CELSIUS
        dried = k_e * (1e3 * w_35 * np.exp(b * (skin - 308.15)) - vapour)
        inner = g * (1.0 + abs(core - skin) / convects) * (core - skin)
        given, walled, touched = u_h * (heater - air), u_aw * (air - wall), u_as * (air - skin)
        return [
            (float(u[0]) - given) / c_h,
            (given - walled - touched - 1200.0 * q * (air - room)) / c_a,
            (walled - u_wr * (wall - room)) / c_w,
            (touched + inner - 1e-3 * EVAPORATION * dried) / c_s,
            (float(u[2]) - inner) / c_c,
            (float(u[1]) / 3600.0 + dried - q * (vapour - 1e3 * w_room)) / volume,
        ]

    for number, (name, stop) in enumerate((("first", 14400.0), ("second", 12600.0), ("third", 13200.0))):
        heat = drawn_steps(rng, stop, 900.0, 8.0, 48.0, 20.0)
        if name == "third":
            heat = wandering(rng, stop, 600.0, 9.0, 47.0, 20.0)
        mist = drawn_steps(rng, stop, 1300.0, 0.0, 4.5, 20.0)
        pad = drawn_steps(rng, stop, 1600.0, 0.0, 9.0, 20.0)
        heat, mist, pad = later(heat, 10.0), later(mist, 10.0), later(pad, 10.0)
        room = ramped(rng, stop, 1800.0, 20.0, 26.0, 60.0)
        start = (air_0, air_0, air_0, skin_0, skin_0, 1e3 * w_begin)
        t, x = integrated(rates, start, (heat, mist, pad, room), stop, 5.0)
        instant, part = loose if loose is not None and name == "second" else (np.inf, 0.0)

        def skin_shown(t: Array, x: Array, u: Array, instant: float = instant, part: float = part) -> Array:
            share = np.where(t >= instant, part, 0.0)
            return np.asarray((1.0 - share) * x[:, 3] + share * x[:, 1] - CELSIUS)

        sensors = [
            Sensor("crib.air", "T Luft", "degC", celsius(1), 0.08, 20.0, noise_stated, 0.02),
            Sensor("crib.skin", "T Haut", "degC", skin_shown, 0.05, 20.0, noise_stated, 0.01),
            Sensor("crib.core", "T Kern", "degC", celsius(4), 0.03, 20.0, noise_stated, 0.01),
            Sensor("crib.vapour", "Feuchte g/m3", "g/m^3", scaled(5, 1.0), 0.15, 40.0, noise_stated, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "heater.heat": (heat, "W"),
                "mister.mist": (mist, "g/h"),
                "phantom.pad": (pad, "W"),
                "ward.room": (room, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["ward.room"],
        )
        write(folder / name, rng, made)


def incubator_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=12.0), Logger("s", zero=-40.0, jitter=0.2), Logger("h", gap=(6000.0, 6480.0)))
    _incubator(folder, rng, noise_stated=1.1, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.1 times too large, two rates, a column of an input, jitter, a "
        "gap of 8 min, three loggers of min, s and h",
        FINE,
    )


def incubator_convects(folder: Path, rng: Rng) -> Truth:
    convects = rng.uniform(2.0, 3.0)
    _incubator(folder, rng, convects=convects, loggers=(Logger("s"), Logger("min", zero=-3.0)))
    return Truth(
        "oil in the phantom convects between core and skin: G (1 + |T_c - T_s|/" + f"{convects:.3f} K)",
        PHYSICS,
        CONVECTING,
    )


def incubator_loose(folder: Path, rng: Rng) -> Truth:
    instant, part = 20.0 * round(rng.uniform(3600.0, 6000.0) / 20.0) - 10.0, rng.uniform(0.2, 0.32)
    _incubator(folder, rng, loose=(instant, part), loggers=(Logger("min"), PLAIN))
    return Truth(
        f"from {instant:g} s of the second recording on, the probe on the skin has come loose: it shows {part:.3f} of "
        f"the air's temperature and {1.0 - part:.3f} of the skin's",
        (*RECORDING, *SENSOR),
    )


# --- a cell of a vanadium flow battery and its tanks, FMI 2 Model Exchange; s, A, L/min, degC, V, %
FLOW_BATTERY = OdeModel(
    "flow_battery",
    {
        "V_c": (4e-5, "m^3"),
        "V_t": (4e-4, "m^3"),
        "conc": (1600.0, "mol/m^3"),
        "E_0": (1.38, "V"),
        "R_0": (8e-3, "ohm"),
        "b": (0.012, "1/K"),
        "R_1": (5e-3, "ohm"),
        "tau": (50.0, "s"),
        "C": (2200.0, "J/K"),
        "h": (0.35, "W/K"),
        "k_x": (2e-6, "1/s"),
        "s_begin": (0.5, ""),
        "T_begin": (298.15, "K"),
    },
    {"current": "A", "flow": "m^3/s", "room": "K"},
    {
        "s_c": ("", "s_begin", f"(flow*(s_t - s_c) + current/({FARADAY}*conc))/V_c"),
        "s_t": ("", "s_begin", "flow*(s_c - s_t)/V_t - k_x*s_t"),
        "v": ("V", "0.0", "(R_1*current - v)/tau"),
        "T": ("K", "T_begin", "(R_0*exp(-b*(T - 298.15))*current*current + v*current - h*(T - room))/C"),
    },
    {
        "voltage": (
            "V",
            f"E_0 + 2.0*{GAS}*T/{FARADAY}*log(fmax(s_c, 1e-6)/fmax(1.0 - s_c, 1e-6))"
            " + R_0*exp(-b*(T - 298.15))*current + v",
        ),
        "charge": ("", "s_t"),
        "warmth": ("K", "T"),
    },
    1.0,
)
FLOW_BATTERY_KNOWN = {
    "V_c": 0.06,
    "V_t": 0.02,
    "conc": 0.015,
    "E_0": 2e-3,
    "R_0": 0.05,
    "b": 0.1,
    "R_1": 0.08,
    "tau": 0.08,
    "C": 0.05,
    "h": 0.08,
    "k_x": 0.2,
}


def cycled(rng: Rng, stop: float, dwell: float, largest: float, grid: float, is_telegraph: bool) -> Steps:
    """Currents [A] that charge and discharge a cell of 67.9 kC between 0.42 and 0.82 of its charge, from 0.5 on."""
    times, levels, t, charge = [0.0], [0.0], 0.0, 0.5
    t += grid * round(0.3 * dwell / grid)
    while t < stop - dwell / 4:
        span = grid * max(1, round(rng.uniform(0.5, 1.5) * dwell / grid))
        level = float(f"{rng.uniform(0.75 if is_telegraph else 0.2, 1.0) * largest:.3g}")
        turns = rng.random() < (0.8 if is_telegraph else 0.35)
        sign = float(np.sign(levels[-1]) or 1.0) * (-1.0 if turns else 1.0)
        if not 0.42 < charge + sign * level * span / 67.9e3 < 0.82:
            sign = -sign
        times.append(t)
        levels.append(sign * level)
        charge += sign * level * span / 67.9e3
        t += span
    return Steps(tuple(times), tuple(levels))


def _vanadium(
    folder: Path,
    rng: Rng,
    gas: tuple[float, float] = (0.0, 1.0),
    corner: tuple[float, float] | None = None,
    begins: float = 0.0,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Hydrogen may take a part of the charging current, gas[0] (s_c - gas[1]) of it, above a state of charge gas[1].

    A corner of the tank may be stirred badly: its volume and what it exchanges with the rest, in m^3 and m^3/s. The
    second recording may begin with another state of charge than is said, by `begins`.
    """
    FLOW_BATTERY.build(folder)
    names = (("cycler", "current", "A"), ("pump", "flow", "L/min"), ("lab", "room", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("cell", "flow_battery")
    wires = "".join(f"  - {c}.{n} -> cell.{n}\n" for c, n, _ in names)
    scenario(folder, "A vanadium flow battery", 10800.0, 5, 10, parts, wires)
    data_sheet(folder, FLOW_BATTERY, FLOW_BATTERY_KNOWN)
    v_c, v_t, conc, e_0, r_0, b, r_1, tau, capacity, h, k_x, s_begin, warm_0 = drawn(
        rng, FLOW_BATTERY, FLOW_BATTERY_KNOWN
    )
    share, onset = gas
    v_d, passes = corner if corner is not None else (1.0, 0.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The last is the state of charge in the corner."""
        cell, tank, v, warm, held = (float(s) for s in x)
        amps, flow = float(u[0]), float(u[1]) / 6e4
        stored = amps * (1.0 - share * max(cell - onset, 0.0)) if amps > 0.0 else amps
        heat = r_0 * np.exp(-b * (warm - 298.15)) * amps**2 + v * amps
        return [
            (flow * (tank - cell) + stored / (FARADAY * conc)) / v_c,
            (flow * (cell - tank) - passes * (tank - held)) / v_t - k_x * tank,
            (r_1 * amps - v) / tau,
            (heat - h * (warm - float(u[2]) - CELSIUS)) / capacity,
            passes * (tank - held) / v_d,
        ]

    def volts(t: Array, x: Array, u: Array) -> Array:
        warm = x[:, 3]
        ohmic = r_0 * np.exp(-b * (warm - 298.15)) * u[:, 0]
        return np.asarray(e_0 + 2.0 * GAS * warm / FARADAY * np.log(x[:, 0] / (1.0 - x[:, 0])) + ohmic + x[:, 2])

    for number, (name, stop) in enumerate((("first", 10800.0), ("second", 9000.0), ("third", 9600.0))):
        amps = later(cycled(rng, stop, 420.0, 16.0, 10.0, name == "third"), 5.0)
        flow = later(drawn_steps(rng, stop, 700.0, 0.1, 0.4, 10.0), 5.0)
        room = ramped(rng, stop, 2400.0, 19.0, 27.0, 100.0)
        first = s_begin + (begins if name == "second" else 0.0)
        t, x = integrated(rates, (first, first, 0.0, warm_0, first), (amps, flow, room), stop, 5.0)
        sensors = [
            Sensor("cell.voltage", "U Zelle", "V", volts, 1.5e-3, 10.0, noise_stated, 5e-4, wild=wild),
            Sensor("cell.charge", "SOC Photometer", "%", scaled(1, 100.0), 0.3, 20.0, noise_stated, 0.1, wild=wild),
            Sensor("cell.warmth", "T Tank", "degC", celsius(3), 0.05, 10.0, noise_stated, 0.02, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"cycler.current": (amps, "A"), "pump.flow": (flow, "L/min"), "lab.room": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["lab.room"],
        )
        write(folder / name, rng, made)


def vanadium_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=900.0, empty=0.02), Logger("h", zero=8.5), Logger("min", gap=(4000.0, 4300.0)))
    _vanadium(folder, rng, noise_stated=None, wild=0.004, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, wild readings, two rates, a column of an input, empty "
        "cells, a gap of 5 min, three loggers of s, h and min",
        FINE,
    )


def vanadium_full(folder: Path, rng: Rng) -> Truth:
    share, onset = rng.uniform(1.2, 1.8), rng.uniform(0.55, 0.6)
    _vanadium(folder, rng, gas=(share, onset), loggers=(Logger("min", zero=4.0), PLAIN))
    return Truth(
        f"hydrogen takes a part of the charging current once the cell is fuller than {onset:.3f}: {share:.3f} (s_c - "
        f"{onset:.3f}) of it do not charge",
        PHYSICS,
        FADING,
    )


def vanadium_two(folder: Path, rng: Rng) -> Truth:
    share, onset = rng.uniform(1.2, 1.8), rng.uniform(0.55, 0.6)
    volume, lag = rng.uniform(1e-4, 1.6e-4), rng.uniform(900.0, 1500.0)
    _vanadium(folder, rng, gas=(share, onset), corner=(volume, volume / lag), loggers=(PLAIN, Logger("h", zero=1.0)))
    return Truth(
        f"hydrogen takes a part of the charging current once the cell is fuller than {onset:.3f}: {share:.3f} (s_c - "
        f"{onset:.3f}) of it do not charge; and a further {1e3 * volume:.4f} L in a corner of the tank mix with the "
        f"rest with a time constant of {lag:.0f} s",
        PHYSICS,
        (*FADING, *STORED),
    )


def vanadium_start(folder: Path, rng: Rng) -> Truth:
    begins = float(rng.choice([-1.0, 1.0])) * rng.uniform(0.05, 0.08)
    _vanadium(folder, rng, begins=begins, loggers=(PLAIN, Logger("min", zero=-20.0)))
    return Truth(
        f"the battery was used before the second recording: it begins at a state of charge of {0.5 + begins:.4f}, and "
        "is said to begin at 0.5",
        (*RECORDING, *SENSOR),
    )


# --- a small wind turbine on a soft tower, FMI 2 Model Exchange; s, ms, m/s, N m, deg, rpm, mm
TURBINE = OdeModel(
    "turbine",
    {
        "J": (60.0, "kg*m^2"),
        "c_1": (7.4, "N*s^2/m"),
        "c_2": (2.0, "N*s^2/rad"),
        "k_b": (1.2, "1/rad"),
        "c_t": (12.0, "N*s^2/m^2"),
        "k_t": (1.5, "1/rad"),
        "m": (350.0, "kg"),
        "d": (72.0, "N*s/m"),
        "k": (1.66e4, "N/m"),
        "tau": (0.4, "s"),
        "w_begin": (18.0, "rad/s"),
        "x_begin": (0.05, "m"),
    },
    {"wind": "m/s", "torque": "N*m", "pitch": "rad"},
    {
        "w": ("rad/s", "w_begin", "(c_1*(wind - v)*(wind - v)*(1.0 - k_b*a) - c_2*(wind - v)*w - torque)/J"),
        "x": ("m", "x_begin", "v"),
        "v": ("m/s", "0.0", "(c_t*(wind - v)*(wind - v)*(1.0 - k_t*a) - d*v - k*x)/m"),
        "a": ("rad", "0.0", "(pitch - a)/tau"),
    },
    {"speed": ("rad/s", "w"), "sway": ("m", "x"), "blade": ("rad", "a")},
    0.01,
)
TURBINE_KNOWN = {"J": 0.04, "c_1": 0.03, "c_2": 0.05, "k_b": 0.06, "c_t": 0.04, "k_t": 0.06}
TURBINE_KNOWN |= {"m": 0.04, "d": 0.15, "k": 0.03, "tau": 0.08}


def _turbine(
    folder: Path,
    rng: Rng,
    ice: tuple[float, float] = (0.0, 1.0),
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Ice may grow on the blades in the second recording: c_1 (1 - ice[0] (1 - exp(-t/ice[1]))), ice[1] in s."""
    TURBINE.build(folder)
    names = (("mast", "wind", "m/s"), ("inverter", "torque", "N*m"), ("hub", "pitch", "deg"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("rotor", "turbine")
    wires = "".join(f"  - {c}.{n} -> rotor.{n}\n" for c, n, _ in names)
    scenario(folder, "A small wind turbine", 60.0, 0.025, 0.05, parts, wires)
    data_sheet(folder, TURBINE, TURBINE_KNOWN)
    inertia, c_1, c_2, k_b, c_t, k_t, mass, d, k, tau, w_begin, x_begin = drawn(rng, TURBINE, TURBINE_KNOWN)

    for number, (name, stop) in enumerate((("first", 60.0), ("second", 48.0), ("third", 54.0))):
        loses = ice[0] if name == "second" else 0.0

        def rates(t: float, x: Array, u: Array, loses: float = loses) -> list[float]:
            w, bent, v, a = (float(s) for s in x)
            met = float(u[0]) - v
            lift = c_1 * (1.0 - loses * (1.0 - np.exp(-t / ice[1])))
            return [
                (lift * met**2 * (1.0 - k_b * a) - c_2 * met * w - float(u[1])) / inertia,
                v,
                (c_t * met**2 * (1.0 - k_t * a) - d * v - k * bent) / mass,
                (float(u[2]) / DEGREES - a) / tau,
            ]

        wind = ramped(rng, stop, 3.0, 7.5, 11.0, 0.25)
        torque = drawn_steps(rng, stop, 4.0, 120.0, 260.0, 0.05)
        pitch = drawn_steps(rng, stop, 3.0, 0.0, 8.0, 0.05)
        if name == "third":
            torque = stairs(rng, stop, 2.5, 125.0, 255.0, 5, 0.05)
        torque, pitch = later(torque, 0.025), later(pitch, 0.025)
        t, x = integrated(rates, (w_begin, x_begin, 0.0, 0.0), (wind, torque, pitch), stop, 0.0125)
        sensors = [
            Sensor("rotor.speed", "Rotor rpm", "rpm", scaled(0, RPM), 0.5, 0.05, noise_stated, 0.1, colour),
            Sensor("rotor.sway", "Turm mm", "mm", scaled(1, 1e3), 0.4, 0.05, noise_stated, 0.1, colour),
            Sensor("rotor.blade", "Blatt deg", "deg", scaled(3, DEGREES), 0.05, 0.1, noise_stated, 0.01, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"mast.wind": (wind, "m/s"), "inverter.torque": (torque, "N*m"), "hub.pitch": (pitch, "deg")},
            loggers[number % len(loggers)],
            recorded=["mast.wind"],
        )
        write(folder / name, rng, made)


def turbine_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=20.0), Logger("ms", zero=-500.0, gap=(20.0, 22.0)), Logger("s", jitter=0.15))
    _turbine(folder, rng, colour=0.2, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.2 and is stated rightly, two "
        "rates, a column of an input, jitter, a gap of 2 s, loggers of s and ms",
        FINE,
    )


def turbine_iced(folder: Path, rng: Rng) -> Truth:
    loses, grows = rng.uniform(0.05, 0.08), rng.uniform(9.0, 15.0)
    _turbine(folder, rng, ice=(loses, grows), loggers=(PLAIN, Logger("ms", zero=1500.0)))
    return Truth(
        f"in the second recording alone, ice grows on the blades: c_1 (1 - {loses:.4f} (1 - exp(-t/{grows:.2f} s)))",
        (*PHYSICS, *RECORDING),
        (*WORN, *RATED, "gain_of_input", "icing"),
    )


def turbine_clock(folder: Path, rng: Rng) -> Truth:
    rate = 1.0 + float(rng.choice([-1.0, 1.0])) * rng.uniform(0.01, 0.016)
    _turbine(folder, rng, loggers=(Logger("ms"), Logger("s", zero=5.0, rate=rate), PLAIN))
    return Truth(
        f"the clock of the second recording runs {rate:.5f} times as fast as it is said to",
        (*RECORDING, *SENSOR),
    )


# --- air brake of a train: pipe, auxiliary reservoir, cylinder; FMI 2 Co-Simulation that hides its states; s, kPa, L/s
TRAIN_BRAKE = OdeModel(
    "train_brake",
    {
        "V_1": (0.012, "m^3"),
        "V_2": (0.012, "m^3"),
        "V_a": (0.05, "m^3"),
        "V_c": (0.018, "m^3"),
        "g_v": (0.02, "m^3/s"),
        "g_p": (8e-3, "m^3/s"),
        "g_f": (6e-3, "m^3/s"),
        "g_a": (0.02, "m^3/s"),
        "g_r": (6e-3, "m^3/s"),
        "A": (0.09, "m^2"),
        "p_s": (2.5e4, "Pa"),
        "p_begin": (5e5, "Pa"),
    },
    {"handle": "Pa", "cock": "m^3/s"},
    {
        "p_1": ("Pa", "p_begin", "(g_v*(handle - p_1) - g_p*(p_1 - p_2))/V_1"),
        "p_2": (
            "Pa",
            "p_begin",
            "(g_p*(p_1 - p_2) - g_f*0.5*(p_2 - p_a + sqrt((p_2 - p_a)*(p_2 - p_a) + 4e6)) - cock*p_2)/V_2",
        ),
        "p_a": (
            "Pa",
            "p_begin",
            "(g_f*0.5*(p_2 - p_a + sqrt((p_2 - p_a)*(p_2 - p_a) + 4e6))"
            " - g_a*0.5e-5*(p_a - p_2 + sqrt((p_a - p_2)*(p_a - p_2) + 4e6))*(p_a - p_c))/V_a",
        ),
        "p_c": (
            "Pa",
            "0.0",
            "(g_a*0.5e-5*(p_a - p_2 + sqrt((p_a - p_2)*(p_a - p_2) + 4e6))*(p_a - p_c)"
            " - g_r*p_c/(1.0 + exp(-(p_2 - p_a - 8e3)/1.5e3)))/V_c",
        ),
    },
    {
        "pipe": ("Pa", "p_2"),
        "cylinder": ("Pa", "p_c"),
        "shoe": ("N", "A*0.5*(p_c - p_s + sqrt((p_c - p_s)*(p_c - p_s) + 1.6e7))"),
    },
    0.02,
)
TRAIN_BRAKE_KNOWN = {"V_1": 0.03, "V_2": 0.03, "V_a": 0.02, "V_c": 0.04, "g_v": 0.06, "g_p": 0.06, "g_f": 0.06}
TRAIN_BRAKE_KNOWN |= {"g_a": 0.08, "g_r": 0.06, "A": 0.02, "p_s": 0.06}


def played(values: Array, width: float) -> Array:
    """What follows values, but never nearer than by half a width once it has turned."""
    found, at = np.empty(len(values)), float(values[0])
    for i, v in enumerate(values):
        at = min(max(at, float(v) - width), float(v) + width)
        found[i] = at
    return found


def _rail(
    folder: Path,
    rng: Rng,
    rubs: float = 0.0,
    is_held: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> tuple[float, float]:
    """The rigging may rub, with a force `rubs` [kN] at the shoe.

    The driver's handle may stay where it was over a stretch of the first recording, against what is said; begin and end
    [s] of it come back.
    """
    TRAIN_BRAKE.build(folder)
    parts = programme("driver", ("handle", "kPa")) + programme("rear", ("cock", "L/s"))
    parts += with_numbers("wagon", "train_brake", "internal")
    wires = "  - driver.handle -> wagon.handle\n  - rear.cock -> wagon.cock\n"
    scenario(folder, "Air brake of a train", 240.0, 0.1, 0.2, parts, wires)
    data_sheet(folder, TRAIN_BRAKE, TRAIN_BRAKE_KNOWN)
    v_1, v_2, v_a, v_c, g_v, g_p, g_f, g_a, g_r, area, spring, begin = drawn(rng, TRAIN_BRAKE, TRAIN_BRAKE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """In kPa."""
        front, back, stored, braking = (float(s) for s in x)
        passed = g_p * (front - back)
        root = np.sqrt((back - stored) ** 2 + 4.0)
        fed = g_f * 0.5 * (back - stored + root)
        applied = g_a * 5e-3 * (stored - back + root) * (stored - braking)
        let = g_r * braking / (1.0 + np.exp(-(back - stored - 8.0) / 1.5))
        return [
            (g_v * (float(u[0]) - front) - passed) / v_1,
            (passed - fed - 1e-3 * float(u[1]) * back) / v_2,
            (fed - applied) / v_a,
            (applied - let) / v_c,
        ]

    stretch = (0.0, 0.0)
    for number, (name, stop) in enumerate((("first", 240.0), ("second", 200.0), ("third", 220.0))):
        handle = drawn_steps(rng, stop, 11.0, 350.0, 500.0, 0.2)
        if name == "third":
            handle = telegraph(rng, stop, 11.0, 370.0, 500.0, 0.2)
        cock = bursts(rng, stop, 22.0, 7.0, 0.15, 0.5, 0.2)
        handle, cock = later(handle, 0.1), later(cock, 0.1)
        run = handle
        if is_held and name == "first":
            moves = [
                (abs(now - before), t, before)
                for t, before, now in zip(handle.times[1:], handle.levels, handle.levels[1:])
                if 0.25 * stop < t < 0.65 * stop
            ]
            _, since, before = max(moves)
            stretch = (since, round(since + 20.1, 6))
            run = between(handle, *stretch, lambda v, before=before: before)  # type: ignore[misc]
        first = 1e-3 * begin
        t, x = integrated(rates, (first, first, first, 0.0), (run, cock), stop, 0.05)
        over = x[:, 3] - 1e-3 * spring
        shoe = area * 0.5 * (over + np.sqrt(over**2 + 16.0))
        x = np.column_stack([x, played(shoe, rubs)])
        sensors = [
            Sensor("wagon.pipe", "HL hinten kPa", "kPa", scaled(1, 1.0), 1.0, 0.2, noise_stated, 0.5),
            Sensor("wagon.cylinder", "C kPa", "kPa", scaled(3, 1.0), 1.0, 0.2, noise_stated, 0.5),
            Sensor("wagon.shoe", "Klotz kN", "kN", scaled(4, 1.0), 0.08, 0.2, noise_stated, 0.02),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"driver.handle": (run, "kPa"), "rear.cock": (cock, "L/s")},
            loggers[number % len(loggers)],
            told={} if run is handle else {"driver.handle": handle},
        )
        write(folder / name, rng, made)
    return stretch


def rail_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=15.0, gap=(100.0, 106.0)), Logger("min", empty=0.02), Logger("ms", zero=300.0))
    _rail(folder, rng, noise_stated=0.95, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too small, empty cells, a gap of 6 s, three loggers "
        "of s, min and ms, Co-Simulation",
        FINE,
    )


def rail_rubs(folder: Path, rng: Rng) -> Truth:
    rubs = rng.uniform(0.7, 1.1)
    _rail(folder, rng, rubs=rubs, loggers=(Logger("ms"), Logger("s", zero=-2.0)))
    return Truth(
        f"the rigging rubs with {rubs:.3f} kN at the shoe: the shoe's force follows that of the cylinder only by so "
        "much, either way",
        PHYSICS,
        RUBBING,
    )


def rail_held(folder: Path, rng: Rng) -> Truth:
    begin, end = _rail(folder, rng, is_held=True, loggers=(PLAIN, Logger("min", zero=1.0)))
    return Truth(
        f"from {begin:.10g} s to {end:.10g} s of the first recording the driver's handle stays where it was, and is "
        "said to have moved",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a sauna, FMI 2 Co-Simulation that hides its states, without units and with its owner's names; two rates
SAUNA = OdeModel(
    "sauna_mokki",
    {
        "C_kivi": (45000.0, ""),
        "U_kivi": (14.0, ""),
        "C_ilma": (25000.0, ""),
        "U_seina": (90.0, ""),
        "C_seina": (150000.0, ""),
        "U_ulos": (90.0, ""),
        "tau_h": (30.0, ""),
        "Til": (16.0, ""),
        "Vuoto": (0.006, ""),
        "K_ulko": (7.0, ""),
        "Kivi_0": (250.0, ""),
        "Ilma_0": (65.0, ""),
        "Seina_0": (45.0, ""),
        "K_0": (15.0, ""),
    },
    {"Teho": "", "Loyly": "", "Tuuletus": "", "Eteinen": ""},
    {
        "Kivi": ("", "Kivi_0", "(1000.0*Teho - U_kivi*(Kivi - Ilma) - 2260.0*Vesi/tau_h)/C_kivi"),
        "Ilma": (
            "",
            "Ilma_0",
            "(U_kivi*(Kivi - Ilma) - U_seina*(Ilma - Seina)"
            " - 1100.0*(Tuuletus/3600.0 + Vuoto)*(Ilma - Eteinen))/C_ilma",
        ),
        "Seina": ("", "Seina_0", "(U_seina*(Ilma - Seina) - U_ulos*(Seina - Eteinen))/C_seina"),
        "Vesi": ("", "0.0", "Loyly - Vesi/tau_h"),
        "K": ("", "K_0", "(Vesi/tau_h - (Tuuletus/3600.0 + Vuoto)*(K - K_ulko))/Til"),
    },
    {"Kiuas": ("", "Kivi"), "Lauteet": ("", "Ilma"), "Hoyry": ("", "K")},
    1.0,
)
SAUNA_KNOWN = {
    "C_kivi": 0.05,
    "U_kivi": 0.05,
    "C_ilma": 0.06,
    "U_seina": 0.05,
    "C_seina": 0.05,
    "U_ulos": 0.05,
    "tau_h": 0.08,
    "Til": 0.02,
    "Vuoto": 0.08,
}


def _sauna(
    folder: Path,
    rng: Rng,
    benches: tuple[float, float] | None = None,
    is_clipped: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> float:
    """Benches may soak up vapour, as much as so many m^3 of air hold, with a time constant [s].

    The hygrometer of the second recording may reach no further than to four fifths of the readings that there would
    be; that value [g/m^3] comes back.
    """
    SAUNA.build(folder)
    names = (("Vastus", "Teho"), ("Kauha", "Loyly"), ("Luukku", "Tuuletus"), ("Anturi", "Eteinen"))
    parts = "".join(programme(c, (n, "")) for c, n in names) + with_numbers("Sauna", "sauna_mokki", "internal")
    wires = "".join(f"  - {c}.{n} -> Sauna.{n}\n" for c, n in names)
    scenario(folder, "Mökin sauna", 7200.0, 5, 10, parts, wires)
    data_sheet(folder, SAUNA, SAUNA_KNOWN)
    c_k, u_k, c_i, u_s, c_s, u_o, tau, space, leak, outside, stone_0, air_0, wall_0, damp_0 = drawn(
        rng, SAUNA, SAUNA_KNOWN
    )
    soaks, lag = benches if benches is not None else (0.0, 600.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The last is the vapour that the benches hold, as that of air with which they are at rest."""
        stone, air, wall, water, damp, held = (float(s) for s in x)
        vent, boiled = float(u[2]) / 3600.0 + leak, water / tau
        given, walled, soaked = u_k * (stone - air), u_s * (air - wall), soaks * (damp - held) / lag
        return [
            (1e3 * float(u[0]) - given - 2260.0 * boiled) / c_k,
            (given - walled - 1100.0 * vent * (air - float(u[3]))) / c_i,
            (walled - u_o * (wall - float(u[3]))) / c_s,
            float(u[1]) - boiled,
            (boiled - vent * (damp - outside) - soaked) / space,
            (damp - held) / lag,
        ]

    most = np.inf
    for number, (name, stop) in enumerate((("first", 7200.0), ("second", 6300.0), ("third", 6600.0))):
        power = drawn_steps(rng, stop, 700.0, 1.0, 6.0, 10.0)
        if name == "third":
            power = telegraph(rng, stop, 500.0, 1.2, 5.8, 10.0)
        poured = bursts(rng, stop, 420.0, 20.0, 5.0, 15.0, 10.0)
        vent = drawn_steps(rng, stop, 900.0, 5.0, 70.0, 10.0)
        power, poured, vent = later(power, 5.0), later(poured, 5.0), later(vent, 5.0)
        hall = ramped(rng, stop, 1800.0, 16.0, 24.0, 60.0)
        start = (stone_0, air_0, wall_0, 0.0, damp_0, damp_0)
        t, x = integrated(rates, start, (power, poured, vent, hall), stop, 5.0)
        top = np.inf
        if is_clipped and name == "second":
            top = most = float(f"{np.quantile(x[:, 4], 0.8):.3g}")

        def spoil(column: str, t: Array, v: Array, top: float = top) -> Array:
            return np.minimum(v, top) if column == "Kosteus g/m3" else v

        sensors = [
            Sensor("Sauna.Kiuas", "Kivet C", "1", scaled(0, 1.0), 1.2, 20.0, noise_stated, 0.5),
            Sensor("Sauna.Lauteet", "Lauteet C", "1", scaled(1, 1.0), 0.25, 10.0, noise_stated, 0.1),
            Sensor("Sauna.Hoyry", "Kosteus g/m3", "1", scaled(4, 1.0), 0.5, 10.0, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "Vastus.Teho": (power, ""),
                "Kauha.Loyly": (poured, ""),
                "Luukku.Tuuletus": (vent, ""),
                "Anturi.Eteinen": (hall, ""),
            },
            loggers[number % len(loggers)],
            recorded=["Anturi.Eteinen"],
            spoil=spoil,
        )
        write(folder / name, rng, made)
    return most


def sauna_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("min", zero=30.0, is_comma=True),
        Logger("h", zero=18.0, is_comma=True, empty=0.02),
        Logger("s", is_comma=True, gap=(2500.0, 2740.0)),
    )
    _sauna(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, no units, two rates, a column of an input, decimal "
        "commas, empty cells, a gap of 4 min, three loggers of min, h and s, Co-Simulation",
        FINE,
    )


def sauna_benches(folder: Path, rng: Rng) -> Truth:
    soaks, lag = rng.uniform(6.0, 10.0), rng.uniform(400.0, 700.0)
    _sauna(folder, rng, benches=(soaks, lag), loggers=(PLAIN, Logger("min", zero=-10.0)))
    return Truth(
        f"the benches soak up vapour and give it back: as much as {soaks:.2f} m^3 of air hold, with a time constant of "
        f"{lag:.0f} s",
        PHYSICS,
        (*STORED, "sorption", "adsorption", "absorption"),
    )


def sauna_clipped(folder: Path, rng: Rng) -> Truth:
    most = _sauna(folder, rng, is_clipped=True, loggers=(Logger("min"), Logger("h", zero=2.0)))
    return Truth(
        f"the hygrometer of the second recording shows no more than {most:g} g/m^3, which nobody says",
        (*RECORDING, *SENSOR),
    )


# --- a showcase of a museum with silica gel, FMI 3 Model Exchange; h, W, L/min, degC, g/m^3, g
SHOWCASE = OdeModel(
    "showcase",
    {
        "V": (0.6, "m^3"),
        "leak": (5e-6, "m^3/s"),
        "k_g": (3e-5, "m^3/s"),
        "m_g": (0.12, "kg"),
        "X_m": (0.4, ""),
        "c_20": (0.0173, "kg/m^3"),
        "b": (0.06, "1/K"),
        "C_i": (9000.0, "J/K"),
        "U_i": (2.5, "W/K"),
        "C_g": (3e4, "J/K"),
        "U_g": (0.8, "W/K"),
        "eta": (0.7, ""),
        "T_begin": (294.15, "K"),
        "c_begin": (9e-3, "kg/m^3"),
        "X_begin": (0.2, ""),
    },
    {"lamp": "W", "pump": "m^3/s", "room": "K", "damp": "kg/m^3"},
    {
        "T_i": ("K", "T_begin", "(eta*lamp - U_i*(T_i - room) - U_g*(T_i - T_g))/C_i"),
        "T_g": ("K", "T_begin", "U_g*(T_i - T_g)/C_g"),
        "c": ("kg/m^3", "c_begin", "((leak + pump)*(damp - c) - k_g*(c - c_20*exp(b*(T_g - 293.15))*X/X_m))/V"),
        "X": ("", "X_begin", "k_g*(c - c_20*exp(b*(T_g - 293.15))*X/X_m)/m_g"),
    },
    {"air": ("K", "T_i"), "vapour": ("kg/m^3", "c"), "gel": ("kg", "m_g*X")},
    60.0,
)
SHOWCASE_KNOWN = {
    "V": 0.02,
    "leak": 0.1,
    "k_g": 0.08,
    "m_g": 0.01,
    "X_m": 0.04,
    "c_20": 5e-3,
    "b": 0.02,
    "C_i": 0.06,
    "U_i": 0.05,
    "C_g": 0.06,
    "U_g": 0.08,
    "eta": 0.04,
}


def _showcase(
    folder: Path,
    rng: Rng,
    draws: float = 0.0,
    is_ratio: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Warm air may draw air in at the joints: leak + draws sqrt(|T_i - T_room|), draws in 1e-6 m^3/s/K^0.5.

    The vapour of the room of the second recording may be in g of a kg of air.
    """
    build3(SHOWCASE, folder, has_co_simulation=False)
    names = (("track", "lamp", "W"), ("doser", "pump", "L/min"), ("hall", "room", "degC"), ("hygro", "damp", "g/m^3"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("case", "showcase")
    wires = "".join(f"  - {c}.{n} -> case.{n}\n" for c, n, _ in names)
    scenario(folder, "A showcase with silica gel", 691200.0, 450, 900, parts, wires)
    data_sheet(folder, SHOWCASE, SHOWCASE_KNOWN)
    volume, leak, k_g, m_g, x_m, c_20, b, c_i, u_i, c_g, u_g, eta, *begins = drawn(rng, SHOWCASE, SHOWCASE_KNOWN)
    warm_0, damp_0, gel_0 = begins

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Vapour is in g/m^3."""
        air, gel, vapour, held = (float(s) for s in x)
        room = float(u[2]) + CELSIUS
        moved = leak + float(u[1]) / 6e4 + 1e-6 * draws * np.sqrt(abs(air - room))
        sorbed = k_g * (vapour - 1e3 * c_20 * np.exp(b * (gel - 293.15)) * held / x_m)
        return [
            (eta * float(u[0]) - u_i * (air - room) - u_g * (air - gel)) / c_i,
            u_g * (air - gel) / c_g,
            (moved * (float(u[3]) - vapour) - sorbed) / volume,
            1e-3 * sorbed / m_g,
        ]

    for number, (name, stop) in enumerate((("first", 691200.0), ("second", 576000.0), ("third", 604800.0))):
        lamp = drawn_steps(rng, stop, 21600.0, 0.0, 16.0, 900.0)
        if name == "third":
            lamp = telegraph(rng, stop, 25200.0, 0.5, 15.0, 900.0)
        pump = bursts(rng, stop, 36000.0, 18000.0, 0.2, 0.9, 900.0)
        lamp, pump = later(lamp, 450.0), later(pump, 450.0)
        room = ramped(rng, stop, 28800.0, 18.0, 25.0, 1800.0)
        damp = ramped(rng, stop, 64800.0, 5.0, 14.0, 1800.0)
        t, x = integrated(rates, (warm_0, warm_0, 1e3 * damp_0, gel_0), (lamp, pump, room, damp), stop, 225.0)
        told = {}
        if is_ratio and name == "second":
            told = {"hygro.damp": Steps(damp.times, tuple(float(f"{v / AIR:.4g}") for v in damp.levels))}
        sensors = [
            Sensor("case.air", "T Vitrine", "degC", celsius(0), 0.06, 900.0, noise_stated, 0.01),
            Sensor("case.vapour", "aF Vitrine", "g/m^3", scaled(2, 1.0), 0.05, 900.0, noise_stated, 0.01),
            Sensor("case.gel", "Waage Gel g", "g", scaled(3, 1e3 * m_g), 0.05, 1800.0, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "track.lamp": (lamp, "W"),
                "doser.pump": (pump, "L/min"),
                "hall.room": (room, "degC"),
                "hygro.damp": (damp, "g/m^3"),
            },
            loggers[number % len(loggers)],
            recorded=["hall.room", "hygro.damp"],
            told=told,
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "lux", lambda n: np.full(n, 50.0))


def showcase_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=100.0, empty=0.03), Logger("min", zero=-60.0), Logger("s", gap=(260000.0, 275000.0)))
    _showcase(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, two rates, columns of two inputs, a column that nobody "
        "uses, empty cells, a gap of 4.2 h, three loggers of h, min and s",
        FINE,
    )


def showcase_draws(folder: Path, rng: Rng) -> Truth:
    draws = rng.uniform(4.0, 7.0)
    _showcase(folder, rng, draws=draws, loggers=(Logger("min"), Logger("h", zero=24.0)))
    return Truth(
        f"a case that is warmer or colder than the room draws air in at its joints: leak + {draws:.3f}e-6 m^3/s "
        "sqrt(|T_i - T_room|/K)",
        PHYSICS,
        DRAWING,
    )


def showcase_ratio(folder: Path, rng: Rng) -> Truth:
    _showcase(folder, rng, is_ratio=True, loggers=(Logger("h"), Logger("min", zero=10.0)))
    return Truth(
        f"the vapour of the room of the second recording is in g per kg of air, {AIR:g} times less, and is said to be "
        "in g/m^3",
        (*RECORDING, *SENSOR),
    )


# --- reverse osmosis: pump (FMI 2, Co-Simulation) and vessel (FMI 2, Model Exchange); s, rpm, g/L, bar, L/h, mg/L
SKID = OdeModel(
    "skid",
    {
        "D": (5e-7, "m^3/rad"),
        "slip": (2e-8, "1/Pa"),
        "C_h": (1e-10, "m^3/Pa"),
        "tau": (2.0, "s"),
        "w_begin": (140.0, "rad/s"),
        "p_begin": (2.8e6, "Pa"),
    },
    {"drive": "rad/s", "taken": "m^3/s"},
    {
        "w": ("rad/s", "w_begin", "(drive - w)/tau"),
        "p": ("Pa", "p_begin", "(D*w*(1.0 - slip*p) - taken)/C_h"),
    },
    {"pressure": ("Pa", "p"), "speed": ("rad/s", "w")},
    0.05,
)
VESSEL = OdeModel(
    "vessel",
    {
        "A": (1.5e-11, "m^3/(Pa*s)"),
        "k_pi": (7.8e4, "Pa*m^3/kg"),
        "B": (4e-7, "m^3/s"),
        "k_v": (2.5e-8, "m^3/(s*Pa^0.5)"),
        "V_m": (3e-3, "m^3"),
        "V_p": (4e-4, "m^3"),
        "c_begin": (8.0, "kg/m^3"),
        "q_begin": (0.12, "kg/m^3"),
    },
    {"feed": "Pa", "valve": "", "salt": "kg/m^3"},
    {
        "c": (
            "kg/m^3",
            "c_begin",
            "((A*(feed - k_pi*c) + k_v*valve*sqrt(feed))*salt - k_v*valve*sqrt(feed)*c - B*c)/V_m",
        ),
        "q": ("kg/m^3", "q_begin", "(B*c - A*(feed - k_pi*c)*q)/V_p"),
    },
    {
        "taken": ("m^3/s", "A*(feed - k_pi*c) + k_v*valve*sqrt(feed)"),
        "permeate": ("m^3/s", "A*(feed - k_pi*c)"),
        "brine": ("kg/m^3", "c"),
        "product": ("kg/m^3", "q"),
    },
    0.05,
)
SKID_KNOWN = {"D": 0.02, "slip": 0.1, "C_h": 0.06, "tau": 0.06}
VESSEL_KNOWN = {"A": 0.05, "k_pi": 0.02, "B": 0.08, "k_v": 0.04, "V_m": 0.03, "V_p": 0.06}


def _osmosis(
    folder: Path,
    rng: Rng,
    piles: float = np.inf,
    scale: tuple[float, float] = (0.0, np.inf),
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; salt may pile up before the membrane, c exp(J/piles), piles in L/h.

    Scale may grow on it: A/(1 + S), dS/dt = scale[0] (c - scale[1]) above scale[1], in L/g/s and g/L. The second
    recording may be said to have had the valve of another run.
    """
    SKID.build(folder)
    VESSEL.build(folder)
    data_sheet(folder, SKID, SKID_KNOWN)
    (folder / "numbers.yaml").rename(folder / "skid.yaml")
    data_sheet(folder, VESSEL, VESSEL_KNOWN)
    parts = (
        programme("inverter", ("drive", "rpm"))
        + programme("needle", ("valve", ""))
        + programme("mixer", ("salt", "g/L"))
        + with_numbers("skid", "skid", "internal").replace("numbers.yaml", "skid.yaml")
        + with_numbers("vessel", "vessel")
    )
    wires = (
        "  - inverter.drive -> skid.drive\n  - needle.valve -> vessel.valve\n  - mixer.salt -> vessel.salt\n"
        "  - skid.pressure -> vessel.feed\n  - vessel.taken -> skid.taken\n"
    )
    scenario(folder, "Reverse osmosis", 720.0, 0.05, 1, parts, wires)
    stroke, slip, soft, tau, w_begin, p_begin = drawn(rng, SKID, SKID_KNOWN)
    a, k_pi, b, k_v, v_m, v_p, c_begin, q_begin = drawn(rng, VESSEL, VESSEL_KNOWN)
    # Pressures are in bar, flows in L/s.
    a, k_pi, soft, slip = 1e8 * a, 1e-5 * k_pi, 1e8 * soft, 1e5 * slip
    stroke, b, k_v, v_m, v_p = 1e3 * stroke, 1e3 * b, 1e3 * np.sqrt(1e5) * k_v, 1e3 * v_m, 1e3 * v_p
    piled, (grows, dissolved) = piles / 3600.0, scale

    def through(p: Any, c: Any, scaled_by: Any) -> Any:
        """Permeate [L/s], and the salt before the membrane [g/L]."""
        open_to, wall = a / (1.0 + scaled_by), c
        for _ in range(25):
            wall = c * np.exp(open_to * (p - k_pi * wall) / piled)
        return open_to * (p - k_pi * wall), wall

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The last is the scale."""
        w, p, c, q, grown = (float(s) for s in x)
        made, wall = through(p, c, grown)
        out = k_v * float(u[1]) * np.sqrt(p)
        passed = b * wall
        return [
            (float(u[0]) / RPM - w) / tau,
            (stroke * w * (1.0 - slip * p) - made - out) / soft,
            ((made + out) * float(u[2]) - out * c - passed) / v_m,
            (passed - made * q) / v_p,
            grows * max(c - dissolved, 0.0),
        ]

    other = later(drawn_steps(rng, 610.0, 40.0, 0.5, 1.0, 1.0), 0.5)
    for number, (name, stop) in enumerate((("first", 720.0), ("second", 610.0), ("third", 660.0))):
        drive = drawn_steps(rng, stop, 28.0, 1000.0, 1700.0, 1.0)
        if name == "third":
            drive = wandering(rng, stop, 18.0, 1020.0, 1680.0, 1.0)
        valve = drawn_steps(rng, stop, 40.0, 0.5, 1.0, 1.0)
        salt = drawn_steps(rng, stop, 90.0, 3.0, 7.0, 1.0)
        drive, valve, salt = later(drive, 0.5), later(valve, 0.5), later(salt, 0.5)
        start = (w_begin, 1e-5 * p_begin, c_begin, q_begin, 0.0)
        t, x = integrated(rates, start, (drive, valve, salt), stop, 0.25)

        def permeate(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(3600.0 * through(x[:, 1], x[:, 2], x[:, 4])[0])

        sensors = [
            Sensor("skid.pressure", "P Feed bar", "bar", scaled(1, 1.0), 0.08, 1.0, noise_stated, 0.02),
            Sensor("vessel.permeate", "Permeat L/h", "L/h", permeate, 0.8, 1.0, noise_stated, 0.2),
            Sensor("vessel.brine", "Konzentrat g/L", "g/L", scaled(2, 1.0), 0.05, 1.0, noise_stated, 0.01),
            Sensor("vessel.product", "Permeat mg/L", "mg/L", scaled(3, 1e3), 1.5, 2.0, noise_stated, 0.5),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"inverter.drive": (drive, "rpm"), "needle.valve": (valve, ""), "mixer.salt": (salt, "g/L")},
            loggers[number % len(loggers)],
            told={"needle.valve": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)


def osmosis_piles(folder: Path, rng: Rng) -> Truth:
    piles = rng.uniform(330.0, 470.0)
    _osmosis(folder, rng, piles=piles, loggers=(Logger("min", zero=2.0), PLAIN))
    return Truth(
        "salt piles up before the membrane: osmotic pressure and passage of salt are those of "
        f"c exp(J/{piles:.1f} L/h)",
        PHYSICS,
        PILING,
    )


def osmosis_two(folder: Path, rng: Rng) -> Truth:
    piles, grows, dissolved = rng.uniform(330.0, 470.0), rng.uniform(8e-5, 1.3e-4), rng.uniform(8.0, 9.0)
    _osmosis(folder, rng, piles=piles, scale=(grows, dissolved), loggers=(PLAIN, Logger("s", zero=50.0)))
    return Truth(
        "salt piles up before the membrane: osmotic pressure and passage of salt are those of "
        f"c exp(J/{piles:.1f} L/h); and scale grows on it while the brine holds more than {dissolved:.3f} g/L: "
        f"A/(1 + S), dS/dt = {1e3 * grows:.4f}e-3 L/g/s (c - {dissolved:.3f} g/L)",
        PHYSICS,
        (*PILING, *WORN, *BEGINNING),
    )


def osmosis_other_run(folder: Path, rng: Rng) -> Truth:
    _osmosis(folder, rng, is_other=True, loggers=(Logger("s", zero=-6.0), Logger("min")))
    return Truth("the second recording is said to have had the valve of another run", (*RECORDING, *SENSOR))


# --- an arm that one coil in a stream of air pulls up, from a source with inner resistance; the tool's own units
COIL = {
    "reference_resistance": (2.6, "ohm", 0.02),
    "heat_transfer_coefficient": (220.0, "W/(m^2*K)", 0.05),
    "area": (100.0, "mm^2", 0.0),
    "volume": (7.5, "mm^3", 0.0),
    "density": (6450.0, "kg/m^3", 0.0),
    "specific_heat": (830.0, "J/(kg*K)", 0.05),
    "heating_a": (0.22, "N/mm", 0.02),
    "heating_b": (17443.0, '"1"', None),
    "heating_c": (0.1669, "1/K", None),
    "heating_d": (0.155, "N/mm", 0.01),
    "cooling_a": (0.192, "N/mm", 0.02),
    "cooling_b": (696.0, '"1"', None),
    "cooling_c": (0.1549, "1/K", None),
    "cooling_d": (0.156, "N/mm", None),
}
ARM = {
    "mass": (120.0, "g", 0.01),
    "centre_distance": (105.0, "mm", 0.02),
    "central_inertia": (4.6, "kg*cm^2", 0.0),
    "viscous_damping": (9e-4, "N*m*s/rad", 0.15),
}
#: Resistances of the wires and of the source [ohm], rise of the coil's resistance [1/K], lever times stretch [m^2].
COIL_WIRES, COIL_INNER, COIL_RISE, COIL_LEVER = 0.1, 0.4, 6e-4, 2e-4


def _lever_files(folder: Path) -> None:
    """Scenario and parameter sets of the arm and its coil."""
    folder.mkdir(parents=True, exist_ok=True)

    def entries(numbers: Mapping[str, tuple[float, str, float | None]]) -> list[str]:
        found = []
        for name, (value, unit, uncertainty) in numbers.items():
            known = "" if uncertainty is None else f", uncertainty: {uncertainty:g}"
            found.append(f'  {name}: {{value: {value:g}, unit: {unit}, source: "own measurement"{known}}}')
        return found

    lines = ["title: A thin coil in a stream of air", "parameters:", *entries(COIL)]
    lines += [
        '  use_regressed_cooling_rate: {value: false, source: "cools as it heats"}',
        '  initial_temperature: {value: 22, unit: degC, source: "room"}',
        '  reference_temperature: {value: 22, unit: degC, source: "room"}',
        f'  resistance_temperature_coefficient: {{value: {COIL_RISE:g}, unit: 1/K, source: "own measurement"}}',
        '  coil_rest_length: {value: 10, unit: mm, source: "calliper"}',
    ]
    (folder / "coil.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    lines = ["title: An arm of aluminium", "parameters:", *entries(ARM)]
    lines += [f'  gravity: {{value: {GRAVITY:g}, unit: m/s^2, source: "standard"}}']
    (folder / "arm.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    parts = (
        "  source:\n    kind: programme\n    outputs:\n      voltage: {unit: V, points: [[0 s, 0 V]]}\n"
        + programme("room", ("temperature", "degC")).replace("constant: 0 degC", "constant: 22 degC")
        + f"  circuit: {{kind: ngspice, strings: [1], supply: common, supply_resistance: {COIL_INNER} ohm, "
        f"string_resistance: {COIL_WIRES} ohm, start: {{resistance: 2.6 ohm}}}}\n"
        "  coil: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, "
        "parameter_set: coil.yaml}\n"
        "  arm: {kind: bullet_pendulum, micro_step: 0.5 ms, parameter_set: arm.yaml, "
        "parameters: {initial_angle: 195 deg, initial_angular_velocity: 0 rad/s}}\n"
    )
    wires = (
        "  - source.voltage -> circuit.supply_voltage\n"
        f'  - {{connect: "coil.stiffness[1] -> arm.torque", factor: {COIL_LEVER:g}, convert_units: false}}\n'
    )
    scenario(folder, "An arm that one coil pulls up", 16.0, 0.0025, 0.02, parts, wires)


def _branch(numbers: Sequence[float], warm: float | Array) -> Array:
    """Equation (2) of the paper [N/mm], of temperatures [degC]."""
    a, b, c, d = numbers
    return np.asarray(a * np.exp(-b * np.exp(-c * np.asarray(warm))) + d)


def _lever_course(
    numbers: Mapping[str, Any], volts: Steps, room: float, stop: float, step: float, fans: float
) -> tuple[Array, Array]:
    """Times [s], and temperature [degC], current [A], voltage at the terminals [V], angle [rad], its rate [rad/s].

    The coil: heat by the exponential of equation (3) over a step, with power and loss of its middle, and a stiffness
    that moves only as far as both branches demand. The arm: classical Runge-Kutta, with the mean torque of a step.

    Args:
        numbers: Resistance, conductance [W/K], capacity [J/K], branches; m g l [N m], inertia and damping of the arm.
        volts: Of the source.
        room: [degC].
        stop: End [s].
        step: Of time [s].
        fans: By what part more heat the coil loses for each rad/s of the arm.
    """
    times: Array = step * np.arange(round(stop / step) + 1, dtype=np.float64)
    emf = volts.at(times)
    heating, cooling = numbers["heating"], numbers["cooling"]
    scan = np.arange(200.0, 0.0, -0.01)
    is_above = _branch(cooling, scan) >= _branch(heating, scan)
    crossing = float(scan[np.argmax(is_above)]) if is_above.any() else -np.inf

    def resistance(warm: float) -> float:
        return float(numbers["resistance"] * (1.0 + COIL_RISE * (warm - 22.0)))

    def current(warm: float, v: float) -> float:
        return v / (COIL_INNER + COIL_WIRES + resistance(warm))

    def relaxed(warm: float, at: float, v: float, span: float, rate: float) -> float:
        loss = numbers["conductance"] * (1.0 + fans * abs(rate))
        end = room + current(at, v) ** 2 * resistance(at) / loss
        return float(end + (warm - end) * np.exp(-loss * span / numbers["capacity"]))

    def turned(y: Array, torque: float) -> Array:
        return np.asarray(
            [y[1], (numbers["weight"] * np.sin(y[0]) - numbers["damping"] * y[1] + torque) / numbers["inertia"]]
        )

    warm = room
    stiff = float(_branch(heating, warm))
    arm = np.asarray([numbers["angle"], 0.0])
    found = np.empty((len(times), 5))
    for i, v in enumerate(emf):
        amps = current(warm, float(v))
        found[i] = (warm, amps, float(v) - COIL_INNER * amps, arm[0], arm[1])
        middle = relaxed(warm, warm, float(v), step / 2, arm[1])
        warm, before = relaxed(warm, middle, float(v), step, arm[1]), stiff
        up, down = float(_branch(heating, warm)), float(_branch(cooling, warm))
        stiff = up if warm >= crossing else min(max(stiff, min(up, down)), max(up, down))
        torque = 1e3 * COIL_LEVER * (before + stiff) / 2
        a = turned(arm, torque)
        b = turned(arm + step / 2 * a, torque)
        c = turned(arm + step / 2 * b, torque)
        d = turned(arm + step * c, torque)
        arm = arm + step / 6 * (a + 2 * b + 2 * c + d)
    return times, found


def _lever(
    folder: Path,
    rng: Rng,
    fans: float = 0.0,
    slip: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The arm may fan the coil: it loses 1 + fans |rate| times as much heat, fans in s/rad.

    Slip are an instant of the second recording [s] at which the encoder slips on its shaft, and by how much [deg].
    """
    _lever_files(folder)

    def off(numbers: Mapping[str, tuple[float, str, float | None]], name: str) -> float:
        """A number as it is."""
        value, _, uncertainty = numbers[name]
        return float(value * np.exp((uncertainty or 0.0) * rng.normal()))

    mass, distance = 1e-3 * off(ARM, "mass"), 1e-3 * off(ARM, "centre_distance")
    numbers: dict[str, Any] = {
        "resistance": off(COIL, "reference_resistance"),
        "conductance": 1e-6 * off(COIL, "area") * off(COIL, "heat_transfer_coefficient"),
        "capacity": 1e-9 * off(COIL, "density") * off(COIL, "volume") * off(COIL, "specific_heat"),
        "heating": [off(COIL, f"heating_{n}") for n in "abcd"],
        "cooling": [off(COIL, f"cooling_{n}") for n in "abcd"],
        "weight": mass * GRAVITY * distance,
        "inertia": mass * distance**2 + 1e-4 * off(ARM, "central_inertia"),
        "damping": off(ARM, "viscous_damping"),
    }

    for number, (name, stop) in enumerate((("first", 16.0), ("second", 12.4), ("third", 14.0))):
        volts = drawn_steps(rng, stop, 1.6, 0.0, 2.8, 0.02)
        if name == "third":
            volts = stairs(rng, stop, 0.9, 0.1, 2.7, 5, 0.02)
        volts = later(volts, 0.01)
        said = float(f"{rng.uniform(20.5, 24.0):.3g}")
        room = said + 0.2 * float(rng.normal())
        pulled = 1e3 * COIL_LEVER * float(_branch(numbers["heating"], room))
        numbers["angle"] = np.pi + np.arcsin(pulled / numbers["weight"])
        begins = round(DEGREES * numbers["angle"] + 0.15 * float(rng.normal()), 1)
        t, x = _lever_course(numbers, volts, room, stop, 2.5e-3, fans)
        instant, by = slip if slip is not None and name == "second" else (np.inf, 0.0)

        def angle(t: Array, x: Array, u: Array, instant: float = instant, by: float = by) -> Array:
            return np.asarray(DEGREES * x[:, 3] + np.where(t >= instant, by, 0.0))

        sensors = [
            Sensor("supply.current", "I mA", "mA", scaled(1, 1e3), 1.5, 0.02, noise_stated, 0.5),
            Sensor("supply.voltage", "U V", "V", scaled(2, 1.0), 4e-3, 0.02, noise_stated, 1e-3),
            Sensor("coil[1].temperature", "Pyrometer", "degC", scaled(0, 1.0), 0.3, 0.04, noise_stated, 0.1),
            Sensor("arm.angle", "Drehgeber deg", "deg", angle, 0.15, 0.02, noise_stated, 0.05),
        ]
        points = [[f"{s:.10g} s", f"{v:.10g} V"] for s, v in zip(volts.times, volts.levels)]
        sidecar: dict[str, Any] = {
            "components": {
                "source": {"outputs": {"voltage": {"points": points}}},
                "coil": {"parameters": {"initial_temperature": f"{said:g} degC"}},
                "arm": {"parameters": {"initial_angle": f"{begins:g} deg"}},
            },
            "uncertain": {"room.temperature": "0.3 degC", "arm.initial_angle": "0.2 deg"},
        }
        made = Written(
            t,
            x,
            sensors,
            {"room.temperature": (Steps((0.0,), (said,)), "degC")},
            loggers[number % len(loggers)],
            sidecar=sidecar,
        )
        write(folder / name, rng, made)


def lever_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=3.0, empty=0.02), Logger("ms", zero=-200.0), Logger("s", gap=(7.0, 7.6)))
    _lever(folder, rng, noise_stated=1.05, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, room and start off by 0.2 K (deviation), angle at the start by 0.15 degrees, "
        "noise stated 1.05 times too large, two rates, empty cells, a gap of 0.6 s, loggers of s and ms",
        FINE,
    )


def lever_fans(folder: Path, rng: Rng) -> Truth:
    fans = rng.uniform(0.22, 0.34)
    _lever(folder, rng, fans=fans, loggers=(PLAIN, Logger("ms", zero=40.0)))
    return Truth(
        f"the arm fans the coil: the coil loses 1 + {fans:.4f} s/rad |angular velocity| times as much heat",
        PHYSICS,
        FANNING,
    )


def lever_slips(folder: Path, rng: Rng) -> Truth:
    instant = 0.02 * round(rng.uniform(4.0, 7.5) / 0.02) - 0.01
    by = float(rng.choice([-1.0, 1.0])) * rng.uniform(1.6, 2.6)
    _lever(folder, rng, slip=(instant, by), loggers=(Logger("ms"), Logger("s", zero=1.0), PLAIN))
    return Truth(
        f"at {instant:.2f} s of the second recording the encoder slips on its shaft: from there on it shows "
        f"{by:+.3f} degrees more",
        (*RECORDING, *SENSOR),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    vanadium_full,
    rail_null,
    lever_slips,
    showcase_draws,
    incubator_null,
    turbine_clock,
    osmosis_two,
    sauna_clipped,
    lever_null,
    incubator_convects,
    turbine_iced,
    vanadium_start,
    showcase_null,
    rail_rubs,
    osmosis_other_run,
    sauna_null,
    incubator_loose,
    vanadium_two,
    turbine_null,
    showcase_ratio,
    lever_fans,
    sauna_benches,
    rail_held,
    osmosis_piles,
    vanadium_null,
)
