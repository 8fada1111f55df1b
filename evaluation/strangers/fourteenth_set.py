"""Fourteenth set: a twisted string, a transformer, a test lung, a laminate, a boat, a compressor, a patch, a cryostat.

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
from evaluation.strangers.eleventh_set import DEGREES, LEAKING, RPM, telegraph
from evaluation.strangers.fifth_set import FOUR, FOUR_SPLIT, integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.tenth_set import stairs, swept, within
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth
from evaluation.strangers.twelfth_set import SQUARE

#: Metres per second in a knot; gas constant [J/(mol*K)].
KNOT, GAS = 1852.0 / 3600.0, 8.314462
#: Laws that are true where a heat capacity depends on temperature.
CAPACITY = ("heat_capacity_of_temperature", "temperature_dependent_capacity")


# --- two strings that a motor twists lift a spring's end, FMI 2 Model Exchange; turns, mm, mA; two rates
TWISTED = OdeModel(
    "twisted",
    {
        "J": (2e-5, "kg*m^2"),
        "k_m": (0.02, "N*m/A"),
        "R": (2.0, "ohm"),
        "d": (2.5e-5, "N*m*s/rad"),
        "L": (0.3, "m"),
        "r": (8e-4, "m"),
        "F_0": (9.0, "N"),
        "k_spring": (400.0, "N/m"),
        "twist_begin": (40.0, "rad"),
    },
    {"u": "V", "pull": "N"},
    {
        "twist": ("rad", "twist_begin", "w"),
        "w": (
            "rad/s",
            "0.0",
            "(k_m*(u - k_m*w)/R - d*w - (F_0 + pull + k_spring*(L - sqrt(L*L - r*r*twist*twist)))"
            "*r*r*twist/sqrt(L*L - r*r*twist*twist))/J",
        ),
    },
    {
        "turned": ("rad", "twist"),
        "lift": ("m", "L - sqrt(L*L - r*r*twist*twist)"),
        "current": ("A", "(u - k_m*w)/R"),
    },
    1e-3,
)
TWISTED_KNOWN = {"J": 0.06, "k_m": 0.03, "R": 0.04, "d": 0.1, "r": 0.02, "F_0": 0.06, "k_spring": 0.04}


def _twisted(
    folder: Path,
    rng: Rng,
    softness: float = 0.0,
    ahead: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The strings may stretch, `softness` m/N; the laser's clock may be ahead [s] in the second recording."""
    TWISTED.build(folder)
    parts = programme("amplifier", ("u", "V")) + programme("winch", ("pull", "N")) + with_numbers("string", "twisted")
    wires = "  - amplifier.u -> string.u\n  - winch.pull -> string.pull\n"
    scenario(folder, "A twisted string", 60.0, 0.05, 0.05, parts, wires)
    data_sheet(folder, TWISTED, TWISTED_KNOWN)
    inertia, k_m, r_motor, d, length, r, f_0, k_spring, begin = drawn(rng, TWISTED, TWISTED_KNOWN)

    def lifted(twist: Array | float, pull: Array | float) -> tuple[Array, Array]:
        """Way of the spring's end [m] and force of the strings [N]."""
        drawn_in = length - np.sqrt(length**2 - (r * np.asarray(twist)) ** 2)
        force = (f_0 + np.asarray(pull) + k_spring * drawn_in) / (1.0 + k_spring * softness)
        return np.asarray(drawn_in - softness * force), np.asarray(force)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        twist, w = (float(s) for s in x)
        force = float(lifted(twist, float(u[1]))[1])
        lever = r * r * twist / np.sqrt(length**2 - (r * twist) ** 2)
        return [w, (k_m * (float(u[0]) - k_m * w) / r_motor - d * w - force * lever) / inertia]

    for number, (name, stop) in enumerate((("first", 60.0), ("second", 45.0), ("third", 50.0))):
        u = drawn_steps(rng, stop, 2.2, 0.4, 4.4, 0.1)
        if name == "third":
            u = swept(stop, 0.6, 4.2, 12.0, 4.0, 0.2)
            u = Steps((0.0, *(t + 0.05 for t in u.times[1:])), u.levels)
        pull = drawn_steps(rng, stop, 3.4, 0.0, 12.0, 0.1)
        t, x = integrated(rates, (begin, 0.0), (u, pull), stop, 0.01)
        way = lifted(x[:, 0], pull.at(t))[0]
        late = ahead if name == "second" else 0.0

        def laser(now: Array, x: Array, u: Array, t: Array = t, way: Array = way, late: float = late) -> Array:
            return np.asarray(1e3 * np.interp(now - late, t, way))

        sensors = [
            Sensor("string.lift", "laser s [mm]", "mm", laser, 0.25, 0.05, noise_stated, 0.05),
            Sensor("string.turned", "Umdrehungen", "turn", scaled(0, 0.5 / np.pi), 0.06, 0.1, noise_stated, 0.02),
            Sensor(
                "string.current",
                "I_mot",
                "mA",
                lambda t, x, u: 1e3 * (u[:, 0] - k_m * x[:, 1]) / r_motor,
                15.0,
                0.1,
                noise_stated,
                5.0,
            ),
        ]
        programmes = {"amplifier.u": (u, "V"), "winch.pull": (pull, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def twisted_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=-1.2, jitter=0.25), Logger("ms", zero=2.0e4, gap=(18.0, 23.0)), Logger("s", empty=0.03))
    _twisted(folder, rng, noise_stated=0.82, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.22 times too small, two rates, jitter, a gap of 5 s, empty "
        "cells, three loggers",
        FINE,
    )


def twisted_stretch(folder: Path, rng: Rng) -> Truth:
    softness = rng.uniform(1.6e-4, 2.6e-4)
    _twisted(folder, rng, softness=softness, loggers=(PLAIN, Logger("ms", zero=-350.0)))
    return Truth(
        f"the strings stretch, {1e3 * softness:.3f} mm/N",
        PHYSICS,
        (
            "series_elasticity",
            "series_compliance",
            "compliance",
            "elastic_transmission",
            "cable_stretch",
            "stretch",
        ),
    )


def twisted_clock(folder: Path, rng: Rng) -> Truth:
    ahead = round(rng.uniform(0.18, 0.32), 2)
    _twisted(folder, rng, ahead=ahead, loggers=(Logger("ms"), PLAIN))
    return Truth(
        f"the clock of the laser's table is {1e3 * ahead:.0f} ms ahead in the second recording", (*RECORDING, *SENSOR)
    )


# --- a transformer with a switched load behind an inverter, FMI 3 Model Exchange; A, ms; four runs; voltage is a column
TRANSFORMER = OdeModel(
    "transformer",
    {
        "R_1": (0.9, "ohm"),
        "L_m": (0.022, "H"),
        "L_s": (8e-4, "H"),
        "R_2": (0.03, "ohm"),
        "n": (5.0, ""),
    },
    {"u": "V", "load": "ohm"},
    {
        "psi": ("V*s", "0.0", "u - R_1*(psi/L_m + i_2)"),
        "i_2": ("A", "0.0", "(u - R_1*(psi/L_m + i_2) - n*n*(R_2 + load)*i_2)/L_s"),
    },
    {"primary": ("A", "psi/L_m + i_2"), "secondary": ("A", "n*i_2")},
    5e-5,
)
TRANSFORMER_KNOWN = {"R_1": 0.04, "L_m": 0.06, "L_s": 0.08, "R_2": 0.1}


def _transformer(
    folder: Path,
    rng: Rng,
    knee: float = np.inf,
    share: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The core may saturate, i_m = psi/L_m (1 + (psi/knee)^2), `knee` in V s.

    The clamp of the primary may end, in the second recording, at what is exceeded for a `share` of the time.
    """
    build3(TRANSFORMER, folder, has_co_simulation=False)
    parts = programme("inverter", ("u", "V")) + programme("bank", ("load", "ohm"))
    parts += with_numbers("core", "transformer")
    wires = "  - inverter.u -> core.u\n  - bank.load -> core.load\n"
    scenario(folder, "A transformer", 0.36, 5e-4, 5e-4, parts, wires)
    data_sheet(folder, TRANSFORMER, TRANSFORMER_KNOWN)
    r_1, l_m, l_s, r_2, n = drawn(rng, TRANSFORMER, TRANSFORMER_KNOWN)

    def magnetising(psi: Array | float) -> Array:
        return np.asarray(np.asarray(psi) / l_m * (1.0 + (np.asarray(psi) / knee) ** 2))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        psi, i_2 = (float(s) for s in x)
        across = float(u[0]) - r_1 * (float(magnetising(psi)) + i_2)
        return [across, (across - n * n * (r_2 + float(u[1])) * i_2) / l_s]

    for number, (name, stop) in enumerate(zip(FOUR, (0.36, 0.3, 0.33, 0.3))):
        u = drawn_steps(rng, stop, 6e-3, -12.0, 12.0, 5e-4)
        if name == "fourth":
            u = telegraph(rng, stop, 5e-3, -9.0, 9.0, 5e-4)
        load = drawn_steps(rng, stop, 0.022, 0.15, 0.8, 5e-4)
        t, x = integrated(rates, (0.0, 0.0), (u, load), stop, 1e-4)
        first = magnetising(x[:, 0]) + x[:, 1]
        end = float(f"{np.quantile(np.abs(first), 1.0 - share):.1f}") if share and name == "second" else np.inf

        def spoil(column: str, t: Array, v: Array, end: float = end) -> Array:
            return np.clip(v, -end, end) if column == "clamp A" else v

        sensors = [
            Sensor(
                "core.primary",
                "clamp A",
                "A",
                lambda t, x, u: magnetising(x[:, 0]) + x[:, 1],
                0.08,
                5e-4,
                noise_stated,
                0.02,
                colour,
            ),
            Sensor("core.secondary", "clamp B", "A", scaled(1, n), 0.1, 5e-4, noise_stated, 0.05, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"inverter.u": (u, "V"), "bank.load": (load, "ohm")},
            loggers[number % len(loggers)],
            recorded=["inverter.u"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def transformer_null(folder: Path, rng: Rng) -> Truth:
    _transformer(folder, rng, noise_stated=1.2, colour=0.6, loggers=(Logger("s", zero=0.25, empty=0.02), Logger("ms")))
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.6 and is stated 1.2 times too "
        "large, empty cells, s from 0.25",
        FINE,
        **FOUR_SPLIT,
    )


def transformer_core(folder: Path, rng: Rng) -> Truth:
    knee = rng.uniform(0.12, 0.17)
    _transformer(folder, rng, knee=knee, loggers=(Logger("ms"), Logger("ms", zero=1000.0)))
    return Truth(
        f"the core saturates: i_m = psi/L_m (1 + (psi/{knee:.4f} V s)^2)",
        PHYSICS,
        ("saturation", "magnetic_saturation", "saturable_inductance", "inductance_of_current"),
        **FOUR_SPLIT,
    )


def transformer_clamp(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.14, 0.24)
    _transformer(folder, rng, share=share, loggers=(Logger("ms", zero=-5.0), Logger("s")))
    return Truth(
        f"the clamp of the primary ends at what {100 * share:.0f} % of the second recording exceed, either way, which "
        "is not stated",
        SENSOR,
        **FOUR_SPLIT,
    )


# --- a breathing test lung on a ventilator, FMI 3 Co-Simulation; hPa, L/min, mL; two rates
LUNG = OdeModel(
    "lung",
    {
        "R_hose": (2.5e5, "Pa*s/m^3"),
        "C_hose": (1e-7, "m^3/Pa"),
        "R_airway": (5e5, "Pa*s/m^3"),
        "C_lung": (5e-7, "m^3/Pa"),
    },
    {"blower": "Pa", "effort": "Pa"},
    {
        "p": ("Pa", "0.0", "((blower - p)/R_hose - (p + effort - V/C_lung)/R_airway)/C_hose"),
        "V": ("m^3", "0.0", "(p + effort - V/C_lung)/R_airway"),
    },
    {"mask": ("Pa", "p"), "flow": ("m^3/s", "(p + effort - V/C_lung)/R_airway"), "volume": ("m^3", "V")},
    1e-3,
)
LUNG_KNOWN = {"R_hose": 0.06, "C_hose": 0.1, "R_airway": 0.06, "C_lung": 0.05}


def _lung(
    folder: Path,
    rng: Rng,
    turbulent: float = 0.0,
    leak: float = 0.0,
    gain: tuple[float, float, float] | None = None,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The airway may lose turbulent q^2 besides [Pa s^2/m^6]; the mask may leak, leak p [m^3/(s Pa)].

    Gain is begin [s], end [s] and factor of the flow that is shown in the second recording.
    """
    build3(LUNG, folder, has_exchange=False)
    parts = programme("ventilator", ("blower", "hPa")) + programme("piston", ("effort", "hPa"))
    parts += with_numbers("patient", "lung", "internal")
    wires = "  - ventilator.blower -> patient.blower\n  - piston.effort -> patient.effort\n"
    scenario(folder, "A test lung", 60.0, 0.01, 0.02, parts, wires)
    data_sheet(folder, LUNG, LUNG_KNOWN)
    r_hose, c_hose, r_airway, c_lung = drawn(rng, LUNG, LUNG_KNOWN)

    def through(across: Array) -> Array:
        """Flow [mL/s] of a difference of pressure [hPa]."""
        linear, square = 1e-8 * r_airway, 1e-14 * turbulent
        if not square:
            return np.asarray(across / linear)
        root = np.sqrt(linear**2 + 4.0 * square * np.abs(across))
        return np.asarray(np.sign(across) * (root - linear) / (2.0 * square))

    def flow(x: Array, effort: Array) -> Array:
        return through(x[..., 0] + effort - x[..., 1] / (1e8 * c_lung))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in hPa, volume in mL."""
        p, q = float(x[0]), float(flow(x, np.asarray(u[1])))
        return [((float(u[0]) - p) / (1e-8 * r_hose) - q - 1e8 * leak * p) / (1e8 * c_hose), q]

    for number, (name, stop) in enumerate((("first", 60.0), ("second", 48.0), ("third", 54.0))):
        blower = drawn_steps(rng, stop, 1.1, 3.0, 24.0, 0.02)
        if name == "third":
            blower = telegraph(rng, stop, 0.9, 5.0, 21.0, 0.02)
        effort = bursts(rng, stop, 1.9, 0.7, 2.0, 8.0, 0.02)
        effort = Steps((0.0, *(t + 0.01 for t in effort.times[1:])), effort.levels)
        t, x = integrated(rates, (0.0, 0.0), (blower, effort), stop, 5e-3)
        begin, end, factor = gain if gain is not None and name == "second" else (0.0, 0.0, 1.0)

        def spoil(
            column: str, t: Array, v: Array, begin: float = begin, end: float = end, factor: float = factor
        ) -> Array:
            return np.where(within((begin, end), t), np.round(factor * v, 1), v) if column == "Q_pat" else v

        sensors = [
            Sensor("patient.mask", "Paw", "hPa", scaled(0, 1.0), 0.15, 0.02, 1.0, 0.1),
            Sensor("patient.flow", "Q_pat", "L/min", lambda t, x, u: 0.06 * flow(x, u[:, 1]), 0.8, 0.02, 1.0, 0.1),
            Sensor("patient.volume", "bellows (ml)", "mL", scaled(1, 1.0), 6.0, 0.1, 1.0, 2.0),
        ]
        programmes = {"ventilator.blower": (blower, "hPa"), "piston.effort": (effort, "hPa")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)], spoil=spoil))


def lung_turbulent(folder: Path, rng: Rng) -> Truth:
    turbulent = rng.uniform(2e8, 3.4e8)
    _lung(folder, rng, turbulent=turbulent, loggers=(Logger("s", zero=8.0), Logger("ms")))
    return Truth(f"the airway loses {turbulent:.2e} Pa s^2/m^6 q^2 besides (Rohrer)", PHYSICS, SQUARE)


def lung_two(folder: Path, rng: Rng) -> Truth:
    turbulent, leak = rng.uniform(2e8, 3.4e8), rng.uniform(1.8e-7, 2.8e-7)
    _lung(folder, rng, turbulent=turbulent, leak=leak, loggers=(PLAIN, Logger("min", zero=3.0)))
    return Truth(
        f"the airway loses {turbulent:.2e} Pa s^2/m^6 q^2 besides (Rohrer), and the mask leaks {leak:.2e} m^3/(s Pa)",
        PHYSICS,
        (*SQUARE, *LEAKING),
    )


def lung_gain(folder: Path, rng: Rng) -> Truth:
    begin, factor = float(round(rng.uniform(8.0, 24.0))), rng.uniform(1.18, 1.32)
    _lung(folder, rng, gain=(begin, begin + 16.0, factor), loggers=(Logger("ms", zero=120.0), PLAIN))
    return Truth(
        f"the flow is shown {factor:.3f} times as large, {begin:g} s to {begin + 16.0:g} s of the second recording",
        SENSOR,
    )


# --- a laminate in a heated mould, FMI 2 Co-Simulation; degC, W, h; six hours, each minute; the room is a column
LAMINATE = OdeModel(
    "laminate",
    {
        "C_mould": (4200.0, "J/K"),
        "C_part": (1000.0, "J/K"),
        "G": (9.0, "W/K"),
        "U_mould": (2.6, "W/K"),
        "U_part": (0.9, "W/K"),
        "T_begin": (295.15, "K"),
    },
    {"heat": "W", "room": "K"},
    {
        "T_m": ("K", "T_begin", "(heat - G*(T_m - T_p) - U_mould*(T_m - room))/C_mould"),
        "T_p": ("K", "T_begin", "(G*(T_m - T_p) - U_part*(T_p - room))/C_part"),
    },
    {"mould": ("K", "T_m"), "part": ("K", "T_p")},
    5.0,
)
LAMINATE_KNOWN = {"C_mould": 0.04, "C_part": 0.06, "G": 0.08, "U_mould": 0.05, "U_part": 0.08}


def _laminate(
    folder: Path,
    rng: Rng,
    cured: float = 0.0,
    is_exchanged: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """The resin may give `cured` J while it cures, in each recording anew (first order, 60 kJ/mol, 25 min at 100 degC).

    The two thermocouples may be exchanged in the second recording.
    """
    LAMINATE.build(folder)
    parts = programme("foil", ("heat", "W")) + programme("hall", ("room", "degC"))
    parts += with_numbers("tool", "laminate", "internal")
    scenario(
        folder,
        "A laminate in a heated mould",
        21600.0,
        30,
        60,
        parts,
        "  - foil.heat -> tool.heat\n  - hall.room -> tool.room\n",
    )
    data_sheet(folder, LAMINATE, LAMINATE_KNOWN)
    c_mould, c_part, g, u_mould, u_part, begin = drawn(rng, LAMINATE, LAMINATE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        mould, part, raw = (float(s) for s in x)
        room = float(u[1]) + CELSIUS
        curing = raw / 1500.0 * np.exp(6e4 / GAS * (1.0 / 373.15 - 1.0 / part))
        return [
            (float(u[0]) - g * (mould - part) - u_mould * (mould - room)) / c_mould,
            (g * (mould - part) - u_part * (part - room) + cured * curing) / c_part,
            -curing,
        ]

    for number, (name, stop) in enumerate((("first", 21600.0), ("second", 18000.0), ("third", 19800.0))):
        heat = drawn_steps(rng, stop, 1500.0, 0.0, 480.0, 60.0)
        if name == "third":
            heat = stairs(rng, stop, 1200.0, 10.0, 450.0, 5, 60.0)
        quarters = 900.0 * np.arange(round(stop / 900.0))
        airing = 21.0 + np.cumsum(0.35 * rng.standard_normal(len(quarters)))
        room = Steps(tuple(float(v) for v in quarters), tuple(float(v) for v in np.round(airing, 1)))
        t, x = integrated(rates, (begin, begin, 1.0), (heat, room), stop, 15.0)
        one, two = (1, 0) if is_exchanged and name == "second" else (0, 1)
        sensors = [
            Sensor("tool.mould", "TC1", "degC", celsius(one), 0.2, 60.0, noise_stated, 0.1, wild=wild),
            Sensor("tool.part", "TC2", "degC", celsius(two), 0.2, 60.0, noise_stated, 0.1, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"foil.heat": (heat, "W"), "hall.room": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["hall.room"],
        )
        write(folder / name, rng, made)


def laminate_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=13.5), Logger("min", zero=5.0, gap=(7200.0, 9600.0)))
    _laminate(folder, rng, noise_stated=None, wild=0.012, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, wild readings, a gap of 40 min, h from 13.5, minutes "
        "from 5, Co-Simulation",
        FINE,
    )


def laminate_curing(folder: Path, rng: Rng) -> Truth:
    cured = rng.uniform(1.1e5, 1.8e5)
    _laminate(folder, rng, cured=cured, loggers=(Logger("min"), Logger("h", zero=-0.25)))
    return Truth(
        f"the resin gives {1e-3 * cured:.1f} kJ while it cures, in each recording anew",
        PHYSICS,
        (
            "exotherm",
            "reaction_heat",
            "heat_of_reaction",
            "exothermic_reaction",
            "self_heating",
            "hidden_state",
            "hidden_source",
        ),
    )


def laminate_exchanged(folder: Path, rng: Rng) -> Truth:
    _laminate(folder, rng, is_exchanged=True, loggers=(Logger("h"), Logger("min", zero=60.0)))
    return Truth("the two thermocouples are exchanged in the second recording", (*RECORDING, *SENSOR))


# --- a model boat in a basin, surge and yaw (Nomoto 1957), FMI 2 Model Exchange; m/s, deg/s; the rudder is a column
BOAT = OdeModel(
    "boat",
    {
        "m": (14.0, "kg"),
        "d": (9.0, "N*s/m"),
        "J": (1.6, "kg*m^2"),
        "d_yaw": (2.2, "N*m*s/rad"),
        "c_rudder": (2.0, "N*s^2/m"),
        "v_begin": (0.0, "m/s"),
    },
    {"thrust": "N", "rudder": "rad"},
    {
        "v": ("m/s", "v_begin", "(thrust - d*v)/m"),
        "r": ("rad/s", "0.0", "(c_rudder*v*v*rudder - d_yaw*r)/J"),
    },
    {"speed": ("m/s", "v"), "yaw": ("rad/s", "r")},
    0.01,
)
BOAT_KNOWN = {"m": 0.05, "d": 0.06, "J": 0.08, "d_yaw": 0.08, "c_rudder": 0.06}


def _boat(
    folder: Path,
    rng: Rng,
    drag: float = 0.0,
    is_knots: bool = False,
    noise_stated: float | None = 1.0,
    quantum: float = 0.01,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Water may drag besides, drag v^2 [N s^2/m^2]; the log may show knots in the first recording."""
    BOAT.build(folder)
    parts = (
        programme("propeller", ("thrust", "N")) + programme("servo", ("rudder", "deg")) + with_numbers("hull", "boat")
    )
    wires = "  - propeller.thrust -> hull.thrust\n  - servo.rudder -> hull.rudder\n"
    scenario(folder, "A model boat", 260.0, 0.1, 0.5, parts, wires)
    data_sheet(folder, BOAT, BOAT_KNOWN)
    m, d, inertia, d_yaw, c_rudder, begin = drawn(rng, BOAT, BOAT_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        v, r = (float(s) for s in x)
        return [
            (float(u[0]) - d * v - drag * v * abs(v)) / m,
            (c_rudder * v * v * float(u[1]) / DEGREES - d_yaw * r) / inertia,
        ]

    for number, (name, stop) in enumerate((("first", 260.0), ("second", 210.0), ("third", 230.0))):
        thrust = drawn_steps(rng, stop, 6.0, 0.5, 13.0, 0.5)
        if name == "third":
            thrust = wandering(rng, stop, 5.0, 0.5, 13.0, 0.5)
        rudder = drawn_steps(rng, stop, 4.5, -30.0, 30.0, 0.5)
        if name == "third":
            rudder = telegraph(rng, stop, 3.0, -24.0, 24.0, 0.5)
        t, x = integrated(rates, (begin, 0.0), (thrust, rudder), stop, 0.05)
        shown = 1.0 / KNOT if is_knots and name == "first" else 1.0
        sensors = [
            Sensor("hull.speed", "Log", "m/s", scaled(0, shown), 0.012, 0.5, noise_stated, quantum),
            Sensor("hull.yaw", "IMU.gz", "deg/s", scaled(1, DEGREES), 0.5, 0.5, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"propeller.thrust": (thrust, "N"), "servo.rudder": (rudder, "deg")},
            loggers[number % len(loggers)],
            recorded=["servo.rudder"],
        )
        write(folder / name, rng, made)


def boat_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("s", zero=36000.0, is_comma=True, gap=(120.0, 138.0)),
        Logger("s", zero=-5.0, is_comma=True, empty=0.02),
        Logger("ms", zero=777.0, is_comma=True),
    )
    _boat(folder, rng, quantum=0.05, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, a coarse log of the speed, decimal commas, a gap of 18 s, empty cells, s from "
        "36000, three loggers",
        FINE,
    )


def boat_drag(folder: Path, rng: Rng) -> Truth:
    drag = rng.uniform(3.5, 6.0)
    _boat(folder, rng, drag=drag, loggers=(Logger("min"), Logger("s", zero=12.5)))
    return Truth(f"water drags besides, {drag:.3f} N s^2/m^2 v^2", PHYSICS, SQUARE)


def boat_knots(folder: Path, rng: Rng) -> Truth:
    _boat(folder, rng, is_knots=True, loggers=(PLAIN, Logger("min", zero=-2.0)))
    return Truth("the speed is logged in knots and stated as m/s, in the first recording", (*RECORDING, *SENSOR))


# --- a compressor (FMI 2, Model Exchange) and its receiver (FMI 3, Co-Simulation); rpm, bar, %; two rates
COMPRESSOR = OdeModel(
    "compressor",
    {
        "J": (2.5e-3, "kg*m^2"),
        "k_m": (0.05, "V*s/rad"),
        "R": (0.5, "ohm"),
        "d": (1.2e-4, "N*m*s/rad"),
        "swept": (1.27e-6, "m^3/rad"),
        "eta": (0.88, ""),
        "p_room": (1.013e5, "Pa"),
    },
    {"u": "V", "back": "Pa"},
    {"w": ("rad/s", "0.0", "(k_m*(u - k_m*w)/R - d*w - swept*(back - p_room))/J")},
    {"speed": ("rad/s", "w"), "drawn": ("m^3/s", "eta*swept*w")},
    2e-3,
)
RECEIVER = OdeModel(
    "receiver",
    {
        "V": (5e-3, "m^3"),
        "c": (4.4e-4, "m^3/s"),
        "p_room": (1.013e5, "Pa"),
        "p_begin": (1.013e5, "Pa"),
    },
    {"inflow": "m^3/s", "valve": ""},
    {"p": ("Pa", "p_begin", "(p_room*inflow - c*valve*(p - p_room))/V")},
    {"pressure": ("Pa", "p")},
    0.01,
)
COMPRESSOR_KNOWN = {"J": 0.08, "k_m": 0.02, "R": 0.05, "d": 0.1, "swept": 0.03, "eta": 0.03}
RECEIVER_KNOWN = {"V": 0.03, "c": 0.02}


def _compressor(
    folder: Path,
    rng: Rng,
    clearance: float = 0.0,
    left: float = 0.0,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; air in the clearance may expand, eta (1 - clearance ((p/p_room)^(1/1.3) - 1)).

    The second recording may begin with `left` Pa in the receiver. `strayed` is by how much [Pa] the start of each
    recording is off (deviation), which is stated.
    """
    COMPRESSOR.build(folder)
    build3(RECEIVER, folder, has_exchange=False)
    data_sheet(folder, RECEIVER, RECEIVER_KNOWN)
    (folder / "numbers.yaml").rename(folder / "vessel.yaml")
    data_sheet(folder, COMPRESSOR, COMPRESSOR_KNOWN)
    parts = (
        programme("drive", ("u", "V"))
        + programme("nozzle", ("valve", "'%'")).replace("0 '%'", "0 %")
        + with_numbers("pump", "compressor")
        + with_numbers("tank", "receiver", "internal").replace("numbers.yaml", "vessel.yaml")
    )
    wires = (
        "  - drive.u -> pump.u\n  - nozzle.valve -> tank.valve\n  - pump.drawn -> tank.inflow\n"
        "  - tank.pressure -> pump.back\n"
    )
    scenario(folder, "A compressor and its receiver", 160.0, 0.1, 0.2, parts, wires)
    inertia, k_m, r, d, swept_volume, eta, p_room = drawn(rng, COMPRESSOR, COMPRESSOR_KNOWN)
    volume, c, _, usual = drawn(rng, RECEIVER, RECEIVER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in kPa."""
        w, p = (float(s) for s in x)
        room = 1e-3 * p_room
        filling = eta * (1.0 - clearance * ((p / room) ** (1.0 / 1.3) - 1.0))
        out = c * 0.01 * float(u[1]) * (p - room)
        return [
            (k_m * (float(u[0]) - k_m * w) / r - d * w - 1e3 * swept_volume * (p - room)) / inertia,
            (room * filling * swept_volume * w - out) / volume,
        ]

    for number, (name, stop) in enumerate((("first", 160.0), ("second", 125.0), ("third", 140.0))):
        u = drawn_steps(rng, stop, 8.0, 6.0, 12.0, 0.2)
        if name == "third":
            u = stairs(rng, stop, 8.0, 6.0, 12.0, 4, 0.2)
        valve = bursts(rng, stop, 22.0, 12.0, 50.0, 100.0, 0.2)
        said = float(f"{usual + rng.uniform(0.0, 4e4):.4g}") if strayed else usual
        begin = said + strayed * float(rng.normal()) + (left if name == "second" else 0.0)
        t, x = integrated(rates, (0.0, 1e-3 * begin), (u, valve), stop, 0.02)
        sensors = [
            Sensor("pump.speed", "Drehzahl", "rpm", scaled(0, RPM), 9.0, 0.2, noise_stated, 2.0),
            Sensor("tank.pressure", "p_abs/bar", "bar", scaled(1, 0.01), 0.008, 0.4, noise_stated, 2e-3),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"tank": {"parameters": {"p_begin": f"{1e-5 * said:.6g} bar"}}}
            sidecar["uncertain"] = {"tank.p_begin": f"{1e-5 * strayed:g} bar"}
        made = Written(
            t,
            x,
            sensors,
            {"drive.u": (u, "V"), "nozzle.valve": (valve, "%")},
            loggers[number % len(loggers)],
            sidecar=sidecar,
        )
        write(folder / name, rng, made)


def compressor_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=61.0, empty=0.01), Logger("min", zero=0.4), Logger("ms", jitter=0.2))
    _compressor(folder, rng, strayed=8e3, noise_stated=0.9, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, a start of the receiver is stated that is off by 0.08 bar "
        "(deviation), which is stated too; noise stated 1.11 times too small, two rates, jitter, empty cells",
        FINE,
    )


def compressor_clearance(folder: Path, rng: Rng) -> Truth:
    clearance = rng.uniform(0.24, 0.32)
    _compressor(folder, rng, clearance=clearance, loggers=(PLAIN, Logger("ms", zero=3000.0)))
    return Truth(
        f"air in the clearance expands: eta (1 - {clearance:.4f} ((p/p_room)^(1/1.3) - 1))",
        PHYSICS,
        ("clearance", "clearance_volume", "volumetric_efficiency", "pressure_dependent_efficiency"),
    )


def compressor_start(folder: Path, rng: Rng) -> Truth:
    left = rng.uniform(5e4, 1e5)
    _compressor(folder, rng, left=left, loggers=(Logger("min"), Logger("s", zero=-7.5)))
    return Truth(
        f"the receiver holds {1e-5 * left:.3f} bar over the room's at the begin of the second recording and is said "
        "to be empty",
        (*RECORDING, *SENSOR),
    )


# --- a solar patch that charges a capacitor, FMI 3, both interfaces, without units; mV, mA, K; light is a column
PATCH = OdeModel(
    "solar_patch",
    {
        "k_light": (0.12, ""),
        "i_0": (1.3e-7, ""),
        "v_n": (0.437, ""),
        "rise": (0.07, ""),
        "C": (4.0, ""),
        "C_cloth": (60.0, ""),
        "absorbed": (5.0, ""),
        "h": (0.16, ""),
        "T_room": (297.0, ""),
        "v_begin": (1.0, ""),
    },
    {"light": "", "load": ""},
    {
        "v": ("", "v_begin", "(k_light*light - i_0*exp(rise*(T - T_room))*(exp(v/v_n) - 1.0) - load*v)/C"),
        "T": ("", "T_room", "(absorbed*light - h*(T - T_room))/C_cloth"),
    },
    {
        "voltage": ("", "1000.0*v"),
        "current": ("", "1000.0*(k_light*light - i_0*exp(rise*(T - T_room))*(exp(v/v_n) - 1.0))"),
        "cloth": ("", "T"),
    },
    0.5,
)
PATCH_KNOWN = {"k_light": 0.03, "i_0": 0.15, "v_n": 0.02, "C": 0.05, "C_cloth": 0.06, "absorbed": 0.04, "h": 0.06}


def _patch(
    folder: Path,
    rng: Rng,
    leak: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The capacitor may leak, leak v [A/V]; the second recording may have the column of the light of another run."""
    build3(PATCH, folder)
    parts = programme("lamp", ("light", "")) + programme("sink", ("load", "")) + with_numbers("patch", "solar_patch")
    wires = "  - lamp.light -> patch.light\n  - sink.load -> patch.load\n"
    scenario(folder, "A solar patch", 2700.0, 1, 5, parts, wires)
    data_sheet(folder, PATCH, PATCH_KNOWN)
    k_light, i_0, v_n, rise, c, c_cloth, absorbed, h, room, begin = drawn(rng, PATCH, PATCH_KNOWN)

    def current(x: Array, light: Array) -> Array:
        dark = i_0 * np.exp(rise * (x[..., 1] - room)) * (np.exp(x[..., 0] / v_n) - 1.0)
        return np.asarray(k_light * light - dark)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        light, load = (float(s) for s in u)
        charging = float(current(x, np.asarray(light))) - (load + leak) * float(x[0])
        return [charging / c, (absorbed * light - h * (float(x[1]) - room)) / c_cloth]

    other = drawn_steps(rng, 2300.0, 70.0, 0.0, 1.1, 5.0)
    for number, (name, stop) in enumerate((("first", 2700.0), ("second", 2300.0), ("third", 2500.0))):
        light = drawn_steps(rng, stop, 70.0, 0.0, 1.1, 5.0)
        if name == "third":
            light = wandering(rng, stop, 55.0, 0.0, 1.1, 5.0)
        load = drawn_steps(rng, stop, 110.0, 5e-3, 0.045, 5.0)
        t, x = integrated(rates, (begin, room), (light, load), stop, 1.0)
        sensors = [
            Sensor("patch.voltage", "U2_mV", "1", scaled(0, 1e3), 15.0, 5.0, noise_stated, 5.0),
            Sensor(
                "patch.current",
                "I1_mA",
                "1",
                lambda t, x, u: 1e3 * current(x, u[:, 0]),
                0.8,
                5.0,
                noise_stated,
                0.2,
            ),
            Sensor("patch.cloth", "Pt1000 (K)", "1", scaled(1, 1.0), 0.25, 5.0, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"lamp.light": (light, ""), "sink.load": (load, "")},
            loggers[number % len(loggers)],
            recorded=["lamp.light"],
            told={"lamp.light": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "rH", lambda n: np.asarray(44.0 + 0.4 * rng.standard_normal(n)))


def patch_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=512.0, empty=0.02), Logger("s", zero=90.0, gap=(1300.0, 1500.0)))
    _patch(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, no units, noise is not stated, a column that nothing names, minutes from 512, "
        "a gap of 200 s, empty cells",
        FINE,
    )


def patch_leak(folder: Path, rng: Rng) -> Truth:
    leak = rng.uniform(9e-4, 1.5e-3)
    _patch(folder, rng, leak=leak, loggers=(PLAIN, Logger("min", zero=10.0)))
    return Truth(f"the capacitor leaks, {leak:.2e} A/V", PHYSICS, (*LEAKING, "self_discharge", "decay"))


def patch_other_run(folder: Path, rng: Rng) -> Truth:
    _patch(folder, rng, is_other=True, loggers=(Logger("min"), Logger("s", zero=33.0)))
    return Truth("the second recording has the light of another run", (*RECORDING, *SENSOR))


# --- a cold stage with a sample on a cryocooler, FMI 2 Model Exchange; K, mW, min and h; the cold head is a column
CRYOSTAT = OdeModel(
    "cryostat",
    {
        "C_stage": (60.0, "J/K"),
        "C_sample": (14.0, "J/K"),
        "G_link": (0.05, "W/K"),
        "G_sample": (0.025, "W/K"),
        "T_begin": (76.0, "K"),
    },
    {"heater": "W", "head": "K"},
    {
        "T_s": ("K", "T_begin", "(heater - G_link*(T_s - head) - G_sample*(T_s - T_x))/C_stage"),
        "T_x": ("K", "T_begin", "G_sample*(T_s - T_x)/C_sample"),
    },
    {"stage": ("K", "T_s"), "sample": ("K", "T_x")},
    5.0,
)
CRYOSTAT_KNOWN = {"C_stage": 0.05, "C_sample": 0.06, "G_link": 0.04, "G_sample": 0.06}


def _cryostat(
    folder: Path,
    rng: Rng,
    stored: float = 0.0,
    led: float = 0.0,
    stronger: tuple[float, float, float] | None = None,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """The stage's capacity may rise, C (1 + stored (T/100 K - 1)), and its link's conductance at its mean temperature.

    That is G (1 + led (T/90 K - 1)). Stronger is begin [s], end [s] and factor of the heater in the second recording.
    """
    CRYOSTAT.build(folder)
    parts = programme("source", ("heater", "mW")) + programme("cooler", ("head", "K"))
    parts += with_numbers("cold", "cryostat")
    wires = "  - source.heater -> cold.heater\n  - cooler.head -> cold.head\n"
    scenario(folder, "A cold stage", 16200.0, 10, 30, parts, wires)
    data_sheet(folder, CRYOSTAT, CRYOSTAT_KNOWN)
    c_stage, c_sample, g_link, g_sample, begin = drawn(rng, CRYOSTAT, CRYOSTAT_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        stage, sample = (float(s) for s in x)
        head = float(u[1])
        link = g_link * (1.0 + led * ((stage + head) / 180.0 - 1.0))
        across = g_sample * (stage - sample)
        capacity = c_stage * (1.0 + stored * (stage / 100.0 - 1.0))
        return [(1e-3 * float(u[0]) - link * (stage - head) - across) / capacity, across / c_sample]

    for number, (name, stop) in enumerate((("first", 16200.0), ("second", 13500.0), ("third", 14400.0))):
        stated = drawn_steps(rng, stop, 800.0, 0.0, 3300.0, 30.0)
        if name == "third":
            stated = wandering(rng, stop, 700.0, 50.0, 3250.0, 30.0)
        heater = stated
        if stronger is not None and name == "second":
            heater = between(stated, stronger[0], stronger[1], lambda v: stronger[2] * v)
        head = drawn_steps(rng, stop, 1100.0, 70.0, 76.0, 30.0)
        t, x = integrated(rates, (begin, begin), (heater, head), stop, 10.0)
        sensors = [
            Sensor("cold.stage", "Si-Diode A", "K", scaled(0, 1.0), 0.1, 30.0, noise_stated, 0.02, colour, wild),
            Sensor("cold.sample", "Si-Diode B", "K", scaled(1, 1.0), 0.1, 30.0, noise_stated, 0.02, colour, wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"source.heater": (heater, "mW"), "cooler.head": (head, "K")},
            loggers[number % len(loggers)],
            recorded=["cooler.head"],
            told={} if heater is stated else {"source.heater": stated},
        )
        write(folder / name, rng, made)


def cryostat_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=-12.0, jitter=0.15), Logger("h", zero=22.75))
    _cryostat(folder, rng, noise_stated=0.85, colour=0.5, wild=0.008, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.5 and is stated 1.18 times too "
        "small, wild readings, jitter, h from 22.75",
        FINE,
    )


def cryostat_capacity(folder: Path, rng: Rng) -> Truth:
    stored = rng.uniform(0.65, 1.0)
    _cryostat(folder, rng, stored=stored, loggers=(Logger("min"), Logger("s", zero=600.0)))
    return Truth(
        f"the stage's heat capacity rises with temperature: C (1 + {stored:.3f} (T/100 K - 1))", PHYSICS, CAPACITY
    )


def cryostat_two(folder: Path, rng: Rng) -> Truth:
    stored, led = rng.uniform(0.65, 1.0), rng.uniform(0.35, 0.55)
    _cryostat(folder, rng, stored=stored, led=led, loggers=(Logger("h", zero=4.0), Logger("min")))
    return Truth(
        f"the stage's heat capacity rises with temperature, C (1 + {stored:.3f} (T/100 K - 1)), and so does its "
        f"link's conductance, G (1 + {led:.3f} (T_mean/90 K - 1))",
        PHYSICS,
        (
            *CAPACITY,
            "conductance_of_temperature",
            "temperature_dependent_conductance",
            "temperature_dependent_conductivity",
            "nonlinear_conductance",
        ),
    )


def cryostat_heater(folder: Path, rng: Rng) -> Truth:
    begin, factor = 300.0 * round(rng.uniform(8.0, 26.0)), rng.uniform(1.22, 1.4)
    _cryostat(folder, rng, stronger=(begin, begin + 4500.0, factor), loggers=(Logger("min", zero=7.0), Logger("h")))
    return Truth(
        f"the heater gave {factor:.3f} times the power that is stated, {begin / 60.0:g} min to "
        f"{begin / 60.0 + 75.0:g} min of the second recording",
        SENSOR,
        ("input_fault",),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    twisted_stretch,
    transformer_null,
    lung_gain,
    laminate_curing,
    boat_null,
    compressor_start,
    patch_leak,
    cryostat_heater,
    twisted_null,
    transformer_clamp,
    lung_two,
    laminate_exchanged,
    boat_drag,
    compressor_null,
    patch_other_run,
    cryostat_capacity,
    twisted_clock,
    transformer_core,
    lung_turbulent,
    laminate_null,
    boat_knots,
    compressor_clearance,
    patch_null,
    cryostat_null,
    cryostat_two,
)
