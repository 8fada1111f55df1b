"""Sixteenth set: a charging coil, a frame on a belt, an ink syringe, a sweat patch, a jacket, a floor, a fin, a motor.

Written without a look at the library of laws, its proof, its tests or its thresholds, and without a diagnosis of any of
its cases; of the earlier sets, the author had read the last two and the helpers that these take from the others.
Truths are integrated by scipy from equations that stand here. How large an effect is, and how far the numbers are off,
is drawn; the deviations of the numbers are those that a parameter set states. Recordings of a rig differ in length and
in logger; the one that is held out was partly made with a programme of another kind, within the range of the others.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.eighth_set import idle_column
from evaluation.strangers.eleventh_set import DEGREES, LEAKING, RPM, RUBBING, telegraph
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.tenth_set import stairs, swept
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth
from evaluation.strangers.twelfth_set import SQUARE

#: Heat of evaporation of water [J/kg].
VAPORISATION = 2.4e6
#: Laws that are true where a conductance depends on temperature.
WARMER = (
    "conductance_of_temperature",
    "temperature_dependent_conductance",
    "temperature_dependent_conductivity",
    "nonlinear_conductance",
)
#: Laws that are true where a motor's torque ripples with its angle.
COGGING = ("cogging_torque", "detent_torque", "reluctance_torque", "saliency", "nonlinear_spring")


def later(steps: Steps, by: float) -> Steps:
    """The same levels, each but the first `by` s later."""
    return Steps((0.0, *(t + by for t in steps.times[1:])), steps.levels)


# --- a knitted coil that is charged through a jacket (series-series, rectified), FMI 2 Model Exchange; V, A, uH, mS
COIL = OdeModel(
    "charging_coil",
    {
        "omega": (6.2832e5, "rad/s"),
        "R_1": (0.6, "ohm"),
        "R_2": (2.5, "ohm"),
        "U_d": (0.35, "V"),
        "C": (0.15, "F"),
        "C_coil": (4.5, "J/K"),
        "h": (0.07, "W/K"),
        "T_room": (296.15, "K"),
        "v_begin": (2.0, "V"),
    },
    {"u": "V", "M": "H", "load": "A/V"},
    {
        "v": (
            "V",
            "v_begin",
            "(0.63662*fmax((omega*M*u - R_1*1.27324*(v + 2.0*U_d))/(R_1*R_2 + omega*M*omega*M), 0.0) - load*v)/C",
        ),
        "T": (
            "K",
            "T_room",
            "(0.5*R_2*pow(fmax((omega*M*u - R_1*1.27324*(v + 2.0*U_d))/(R_1*R_2 + omega*M*omega*M), 0.0), 2.0)"
            " - h*(T - T_room))/C_coil",
        ),
    },
    {
        "charge": ("V", "v"),
        "coil": ("K", "T"),
        "primary": (
            "A",
            "(u - omega*M*fmax((omega*M*u - R_1*1.27324*(v + 2.0*U_d))/(R_1*R_2 + omega*M*omega*M), 0.0))/R_1",
        ),
    },
    0.02,
)
COIL_KNOWN = {"R_1": 0.04, "R_2": 0.05, "C": 0.06, "C_coil": 0.06, "h": 0.06}


def _kept(level: float, _: float) -> float:
    """A level in place of another."""
    return level


def _coil(
    folder: Path,
    rng: Rng,
    warmer: float = 0.0,
    still: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    quantum: float = 0.01,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The yarn's resistance may rise, R_2 (1 + warmer (T - T_room)).

    Still is begin and end [s] of a stretch of the second recording in which the stage does not move.
    """
    COIL.build(folder)
    names = (("inverter", "u", "V"), ("stage", "M", "uH"), ("sink", "load", "mS"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("jacket", "charging_coil")
    wires = "".join(f"  - {c}.{n} -> jacket.{n}\n" for c, n, _ in names)
    scenario(folder, "A charging coil", 320.0, 0.25, 0.5, parts, wires)
    data_sheet(folder, COIL, COIL_KNOWN)
    omega, r_1, r_2, diode, c, c_coil, h, room, begin = drawn(rng, COIL, COIL_KNOWN)

    def secondary(x: Array, u: Array) -> tuple[Array, Array]:
        """Amplitude of the current in the knitted coil [A] and its resistance [ohm]."""
        across, resistance = omega * 1e-6 * u[..., 1], r_2 * (1.0 + warmer * (x[..., 1] - room))
        driven = across * u[..., 0] - r_1 * 1.27324 * (x[..., 0] + 2.0 * diode)
        return np.maximum(driven / (r_1 * resistance + across**2), 0.0), np.asarray(resistance)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        amperes, resistance = (float(s) for s in secondary(x, u))
        return [
            (0.63662 * amperes - 1e-3 * float(u[2]) * float(x[0])) / c,
            (0.5 * resistance * amperes**2 - h * (float(x[1]) - room)) / c_coil,
        ]

    def primary(t: Array, x: Array, u: Array) -> Array:
        return np.asarray((u[:, 0] - omega * 1e-6 * u[:, 1] * secondary(x, u)[0]) / r_1)

    for number, (name, stop) in enumerate((("first", 320.0), ("second", 260.0), ("third", 290.0))):
        u = drawn_steps(rng, stop, 14.0, 3.0, 8.8, 0.5)
        if name == "third":
            u = stairs(rng, stop, 13.0, 3.3, 8.5, 5, 0.5)
        mutual = drawn_steps(rng, stop, 21.0, 2.0, 5.0, 0.5)
        load = drawn_steps(rng, stop, 27.0, 60.0, 240.0, 0.5)
        u, mutual, load = later(u, 0.25), later(mutual, 0.25), later(load, 0.25)
        moved = mutual
        if still is not None and name == "second":
            kept = float(mutual.at(np.asarray([still[0]]))[0])
            moved = between(mutual, still[0], still[1], partial(_kept, kept))
        t, x = integrated(rates, (begin, room), (u, moved, load), stop, 0.05)
        sensors = [
            Sensor("jacket.charge", "U_dc", "V", scaled(0, 1.0), 0.015, 0.5, noise_stated, quantum),
            Sensor("jacket.coil", "NTC Garn", "degC", celsius(1), 0.2, 0.5, noise_stated, 0.1),
            Sensor("jacket.primary", "I1 peak", "A", primary, 0.03, 0.5, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"inverter.u": (u, "V"), "stage.M": (moved, "uH"), "sink.load": (load, "mS")},
            loggers[number % len(loggers)],
            told={} if moved is mutual else {"stage.M": mutual},
        )
        write(folder / name, rng, made)


def coil_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=12.0, gap=(141.0, 163.0)), Logger("ms", zero=-4e3), Logger("min", zero=2.0, empty=0.02))
    _coil(folder, rng, quantum=0.05, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, a coarse reading of the voltage, a gap of 22 s, empty cells, three loggers of "
        "s, ms and min",
        FINE,
    )


def coil_warm(folder: Path, rng: Rng) -> Truth:
    warmer = rng.uniform(3.5e-3, 4.6e-3)
    _coil(folder, rng, warmer=warmer, loggers=(Logger("s", zero=-3.0), Logger("min")))
    return Truth(
        f"the yarn's resistance rises with temperature: R_2 (1 + {warmer:.5f}/K (T - T_room))", PHYSICS, WARMER
    )


def coil_still(folder: Path, rng: Rng) -> Truth:
    begin = 10.0 * round(rng.uniform(5.0, 15.0)) + 0.5
    _coil(folder, rng, still=(begin, begin + 80.0), loggers=(Logger("ms"), Logger("s", zero=40.0)))
    return Truth(
        f"the stage does not move, {begin:g} s to {begin + 80.0:g} s of the second recording, as it is said to",
        SENSOR,
        ("input_fault",),
    )


# --- the frame of an embroidery machine on a belt, with its servo, FMI 3 Model Exchange; ms, mm, A, N, deg
FRAME = OdeModel(
    "frame",
    {
        "J": (3e-4, "kg*m^2"),
        "k_t": (0.25, "N*m/A"),
        "r": (0.015, "m"),
        "k": (2e4, "N/m"),
        "c": (20.0, "N*s/m"),
        "m": (4.0, "kg"),
        "d": (12.0, "N*s/m"),
        "k_p": (0.43, "N*m/rad"),
        "k_d": (0.0228, "N*m*s/rad"),
    },
    {"aim": "m", "pull": "N"},
    {
        "theta": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "(k_p*(aim/r - theta) - k_d*w - r*(k*(r*theta - y) + c*(r*w - v)))/J"),
        "y": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(k*(r*theta - y) + c*(r*w - v) + pull - d*v)/m"),
    },
    {"way": ("m", "y"), "angle": ("rad", "theta"), "current": ("A", "(k_p*(aim/r - theta) - k_d*w)/k_t")},
    2e-4,
)
FRAME_KNOWN = {"J": 0.05, "k_t": 0.03, "k": 0.06, "c": 0.15, "m": 0.03, "d": 0.1}


def _frame(
    folder: Path,
    rng: Rng,
    cogging: float = 0.0,
    dry: float = 0.0,
    lag: float = 0.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The motor may cog, cogging sin(12 theta) [N m], and the rails may rub with `dry` N.

    The scale of the second recording may follow with a lag [s].
    """
    build3(FRAME, folder, has_co_simulation=False)
    parts = programme("pattern", ("aim", "mm")) + programme("spring", ("pull", "N")) + with_numbers("axis", "frame")
    wires = "  - pattern.aim -> axis.aim\n  - spring.pull -> axis.pull\n"
    scenario(folder, "A frame of an embroidery machine", 7.2, 2e-3, 4e-3, parts, wires)
    data_sheet(folder, FRAME, FRAME_KNOWN)
    inertia, k_t, r, k, c, m, d, k_p, k_d = drawn(rng, FRAME, FRAME_KNOWN)

    def asked(x: Array, aim: Array) -> Array:
        """Torque of the servo [N m]."""
        return np.asarray(k_p * (1e-3 * aim / r - x[..., 0]) - k_d * x[..., 1])

    for number, (name, stop) in enumerate((("first", 7.2), ("second", 6.0), ("third", 6.6))):
        aim = drawn_steps(rng, stop, 0.3, -30.0, 30.0, 4e-3)
        if name == "third":
            aim = swept(stop, -20.0, 20.0, 1.2, 0.35, 8e-3)
        pull = drawn_steps(rng, stop, 0.7, -15.0, 15.0, 4e-3)
        aim, pull = later(aim, 2e-3), later(pull, 2e-3)
        late = lag if name == "second" else 0.0

        def rates(t: float, x: Array, u: Array, late: float = late) -> list[float]:
            theta, w, y, v, shown = (float(s) for s in x)
            belt = k * (r * theta - y) + c * (r * w - v)
            turning = float(asked(x, np.asarray(u[0]))) - cogging * np.sin(12.0 * theta)
            return [
                w,
                (turning - r * belt) / inertia,
                v,
                (belt + float(u[1]) - d * v - dry * np.tanh(v / 2e-3)) / m,
                (y - shown) / late if late else v,
            ]

        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0, 0.0), (aim, pull), stop, 1e-3)
        sensors = [
            Sensor("axis.way", "Glasmassstab Y", "mm", scaled(4, 1e3), 0.04, 4e-3, 1.0, 5e-3),
            Sensor("axis.angle", "resolver", "deg", scaled(0, DEGREES), 0.25, 4e-3, 1.0, 0.1),
            Sensor("axis.current", "Iq", "A", lambda t, x, u: asked(x, u[:, 0]) / k_t, 0.03, 4e-3, 1.0, 0.01),
        ]
        programmes = {"pattern.aim": (aim, "mm"), "spring.pull": (pull, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def frame_cogging(folder: Path, rng: Rng) -> Truth:
    cogging = rng.uniform(0.012, 0.02)
    _frame(folder, rng, cogging=cogging, loggers=(Logger("ms", zero=500.0), Logger("s")))
    return Truth(f"the motor cogs: {1e3 * cogging:.2f} mN m sin(12 theta)", PHYSICS, COGGING)


def frame_two(folder: Path, rng: Rng) -> Truth:
    cogging, dry = rng.uniform(0.012, 0.02), rng.uniform(3.0, 5.0)
    _frame(folder, rng, cogging=cogging, dry=dry, loggers=(Logger("s", zero=9.0), Logger("ms")))
    return Truth(
        f"the motor cogs, {1e3 * cogging:.2f} mN m sin(12 theta), and the rails rub with {dry:.2f} N",
        PHYSICS,
        (*COGGING, *RUBBING, "hysteresis", "bouc_wen"),
    )


def frame_lag(folder: Path, rng: Rng) -> Truth:
    lag = rng.uniform(0.025, 0.05)
    _frame(folder, rng, lag=lag, loggers=(Logger("ms"), Logger("ms", zero=-250.0)))
    return Truth(
        f"the scale follows with a lag of {1e3 * lag:.1f} ms in the second recording (a filter that was left on)",
        SENSOR,
    )


# --- a syringe that lays conductive ink on cloth, FMI 2 Co-Simulation; kPa, g; the nozzle's temperature is a column
INK = OdeModel(
    "dispenser",
    {
        "G": (5e-11, "m^3/s/Pa"),
        "R": (2e13, "Pa*s/m^3"),
        "b": (0.03, "1/K"),
        "rho": (1400.0, "kg/m^3"),
        "p_room": (1.01e5, "Pa"),
        "T_ref": (298.15, "K"),
        "V_begin": (8e-6, "m^3"),
    },
    {"regulator": "Pa", "nozzle": "K"},
    {
        "p": ("Pa", "0.0", "(p_room + p)/V*(G*(regulator - p) - p/R*exp(b*(nozzle - T_ref)))"),
        "V": ("m^3", "V_begin", "p/R*exp(b*(nozzle - T_ref))"),
    },
    {"barrel": ("Pa", "p"), "laid": ("kg", "rho*(V - V_begin)")},
    0.05,
)
INK_KNOWN = {"G": 0.06, "R": 0.08, "b": 0.05, "rho": 0.01, "V_begin": 0.03}


def _ink(
    folder: Path,
    rng: Rng,
    thinning: float = 0.0,
    emptied: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Ink may thin where it is sheared, p/R (p/150 kPa)^thinning.

    The second recording may begin with less ink in the barrel, by `emptied` mL.
    """
    INK.build(folder)
    parts = programme("valve", ("regulator", "kPa")) + programme("heater", ("nozzle", "degC"))
    parts += with_numbers("syringe", "dispenser", "internal")
    wires = "  - valve.regulator -> syringe.regulator\n  - heater.nozzle -> syringe.nozzle\n"
    scenario(folder, "An ink dispenser", 420.0, 0.25, 0.5, parts, wires)
    data_sheet(folder, INK, INK_KNOWN)
    g, resistance, b, rho, p_room, reference, begin = drawn(rng, INK, INK_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in kPa, the volume of the air in mL."""
        p, volume = (float(s) for s in x)
        thinner = float(np.exp(b * (float(u[1]) + CELSIUS - reference)))
        if thinning:
            thinner *= float((max(p, 0.0) / 150.0) ** thinning)
        out = 1e9 * p / resistance * thinner
        return [(1e-3 * p_room + p) / volume * (1e9 * g * (float(u[0]) - p) - out), out]

    for number, (name, stop) in enumerate((("first", 420.0), ("second", 340.0), ("third", 380.0))):
        regulator = drawn_steps(rng, stop, 7.0, 30.0, 320.0, 0.5)
        if name == "third":
            regulator = telegraph(rng, stop, 6.0, 50.0, 300.0, 0.5)
        nozzle = ramped(rng, stop, 60.0, 22.0, 44.0, 2.0)
        full = 1e6 * begin + (emptied if name == "second" else 0.0)
        t, x = integrated(rates, (0.0, full), (regulator, nozzle), stop, 0.1)

        def laid(t: Array, x: Array, u: Array, full: float = full) -> Array:
            return np.asarray(1e-3 * rho * (x[:, 1] - full))

        sensors = [
            Sensor("syringe.barrel", "p Kartusche", "kPa", scaled(0, 1.0), 0.8, 0.5, noise_stated, 0.5),
            Sensor(
                "syringe.laid",
                "Waage (g)",
                "g",
                laid,
                0.01,
                0.5,
                noise_stated,
                5e-3,
            ),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"valve.regulator": (regulator, "kPa"), "heater.nozzle": (nozzle, "degC")},
            loggers[number % len(loggers)],
            recorded=["heater.nozzle"],
        )
        write(folder / name, rng, made)


def ink_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("s", zero=52000.0, is_comma=True, empty=0.02),
        Logger("min", zero=-0.5, is_comma=True, gap=(150.0, 185.0)),
        Logger("ms", is_comma=True, jitter=0.2),
    )
    _ink(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, decimal commas, empty cells, a gap of 35 s, jitter, s "
        "from 52000, Co-Simulation",
        FINE,
    )


def ink_thinning(folder: Path, rng: Rng) -> Truth:
    thinning = rng.uniform(0.16, 0.32)
    _ink(folder, rng, thinning=thinning, loggers=(Logger("min"), Logger("s", zero=5.0)))
    return Truth(
        f"ink thins where it is sheared: p/R (p/150 kPa)^{thinning:.3f}",
        PHYSICS,
        ("nonlinear_conductance", "conductance_of_state", "state_dependent_conductance", "nonlinear_rate"),
    )


def ink_start(folder: Path, rng: Rng) -> Truth:
    emptied = rng.uniform(5.0, 8.0)
    _ink(folder, rng, emptied=emptied, loggers=(PLAIN, Logger("s", zero=-10.0)))
    return Truth(
        f"the barrel of the second recording holds {emptied:.2f} mL less ink at its begin than is stated",
        (*RECORDING, *SENSOR),
    )


# --- an enzyme electrode for lactate in a sweat patch, FMI 3, both interfaces, without units; mmol/L, uL/min, uA
SWEAT = OdeModel(
    "sweat_patch",
    {
        "V": (50.0, ""),
        "k_e": (0.004, ""),
        "k_el": (0.01, ""),
        "s_el": (0.5, ""),
        "c_begin": (5.0, ""),
    },
    {"inlet": "", "flow": ""},
    {
        "c": ("", "c_begin", "flow/60.0/V*(inlet - c) - k_e*c"),
        "h": ("", "0.0", "k_e*c - (k_el + flow/60.0/V)*h"),
    },
    {"lactate": ("", "c"), "current": ("", "s_el*h")},
    0.5,
)
SWEAT_KNOWN = {"V": 0.04, "k_e": 0.06, "k_el": 0.06, "s_el": 0.05}


def _sweat(
    folder: Path,
    rng: Rng,
    half: float = np.inf,
    drift: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The enzyme may saturate, k_e c/(1 + c/half); the zero of the first recording's current may drift [uA]."""
    build3(SWEAT, folder)
    parts = programme("mixer", ("inlet", "")) + programme("pump", ("flow", "")) + with_numbers("patch", "sweat_patch")
    wires = "  - mixer.inlet -> patch.inlet\n  - pump.flow -> patch.flow\n"
    scenario(folder, "A sweat patch", 7200.0, 5, 10, parts, wires)
    data_sheet(folder, SWEAT, SWEAT_KNOWN)
    volume, k_e, k_el, s_el, begin = drawn(rng, SWEAT, SWEAT_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        c, peroxide = (float(s) for s in x)
        through = float(u[1]) / 60.0 / volume
        eaten = k_e * c / (1.0 + c / half)
        return [through * (float(u[0]) - c) - eaten, eaten - (k_el + through) * peroxide]

    for number, (name, stop) in enumerate((("first", 7200.0), ("second", 6000.0), ("third", 6600.0))):
        inlet = drawn_steps(rng, stop, 420.0, 1.0, 26.0, 10.0)
        if name == "third":
            inlet = wandering(rng, stop, 330.0, 2.0, 25.0, 10.0)
        flow = drawn_steps(rng, stop, 700.0, 6.0, 34.0, 10.0)
        t, x = integrated(rates, (begin, 0.0), (inlet, flow), stop, 2.0)
        strayed = drift if name == "first" else 0.0

        def spoil(column: str, t: Array, v: Array, strayed: float = strayed, stop: float = stop) -> Array:
            return v + strayed * t / stop if column == "CH2 [uA]" else v

        sensors = [
            Sensor("patch.lactate", "photometer", "1", scaled(0, 1.0), 0.12, 10.0, noise_stated, 0.05, colour),
            Sensor("patch.current", "CH2 [uA]", "1", scaled(1, s_el), 0.012, 10.0, noise_stated, 2e-3, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"mixer.inlet": (inlet, ""), "pump.flow": (flow, "")},
            loggers[number % len(loggers)],
            spoil=spoil,
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "skin degC", lambda n: np.asarray(33.0 + 0.1 * rng.standard_normal(n)))


def sweat_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=18.0), Logger("h", zero=-0.2, empty=0.03), Logger("s", zero=3600.0))
    _sweat(folder, rng, noise_stated=0.85, colour=0.5, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, no units, noise of neighbouring readings correlates by 0.5 and is stated 1.18 "
        "times too small, a column that nothing names, empty cells, three loggers of min, h and s",
        FINE,
    )


def sweat_enzyme(folder: Path, rng: Rng) -> Truth:
    half = rng.uniform(12.0, 22.0)
    _sweat(folder, rng, half=half, loggers=(Logger("s", zero=30.0), Logger("min")))
    return Truth(
        f"the enzyme saturates: k_e c/(1 + c/{half:.2f})",
        PHYSICS,
        (
            "saturation",
            "saturating_gain",
            "rate_of_state",
            "state_dependent_rate",
            "nonlinear_rate",
            "reaction_order",
        ),
    )


def sweat_drift(folder: Path, rng: Rng) -> Truth:
    drift = rng.uniform(0.2, 0.36) * rng.choice([-1.0, 1.0])
    _sweat(folder, rng, drift=drift, loggers=(Logger("min", zero=1.0), Logger("s")))
    return Truth(f"the zero of the current drifts by {drift:.3f} uA in the course of the first recording", SENSOR)


# --- three layers of a firefighter's jacket under a radiant panel, FMI 3 Co-Simulation; kW/m^2, degC; room is a column
JACKET = OdeModel(
    "jacket",
    {
        "C_shell": (500.0, "J/K/m^2"),
        "C_barrier": (450.0, "J/K/m^2"),
        "C_liner": (800.0, "J/K/m^2"),
        "absorbed": (0.85, ""),
        "h": (24.0, "W/K/m^2"),
        "G_1": (20.0, "W/K/m^2"),
        "G_2": (26.0, "W/K/m^2"),
        "U": (22.0, "W/K/m^2"),
        "T_plate": (305.15, "K"),
        "T_begin": (300.15, "K"),
    },
    {"flux": "W/m^2", "room": "K"},
    {
        "T_o": ("K", "T_begin", "(absorbed*flux - h*(T_o - room) - G_1*(T_o - T_b))/C_shell"),
        "T_b": ("K", "T_begin", "(G_1*(T_o - T_b) - G_2*(T_b - T_l))/C_barrier"),
        "T_l": ("K", "T_begin", "(G_2*(T_b - T_l) - U*(T_l - T_plate))/C_liner"),
    },
    {"shell": ("K", "T_o"), "barrier": ("K", "T_b"), "liner": ("K", "T_l")},
    0.5,
)
JACKET_KNOWN = {
    "C_shell": 0.05,
    "C_barrier": 0.06,
    "C_liner": 0.05,
    "absorbed": 0.03,
    "h": 0.05,
    "G_1": 0.06,
    "G_2": 0.06,
    "U": 0.05,
}


def _jacket(
    folder: Path,
    rng: Rng,
    warmer: float = 0.0,
    water: float = 0.0,
    is_exchanged: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The gap behind the shell may conduct better when it is hot, G_1 (1 + warmer (T_mean - 300 K)/100 K).

    The barrier may hold `water` kg/m^2, in each recording anew, that dries (240 s at 330 K, twice as fast with each
    10.4 K). The thermocouples of barrier and liner may be exchanged in the first recording.
    """
    build3(JACKET, folder, has_exchange=False)
    parts = programme("panel", ("flux", "kW/m^2")) + programme("hall", ("room", "degC"))
    parts += with_numbers("sample", "jacket", "internal")
    wires = "  - panel.flux -> sample.flux\n  - hall.room -> sample.room\n"
    scenario(folder, "A jacket under a radiant panel", 1800.0, 1, 2, parts, wires)
    data_sheet(folder, JACKET, JACKET_KNOWN)
    c_shell, c_barrier, c_liner, absorbed, h, g_1, g_2, u_plate, plate, begin = drawn(rng, JACKET, JACKET_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        shell, barrier, liner, wet = (float(s) for s in x)
        room = float(u[1]) + CELSIUS
        gap = g_1 * (1.0 + warmer * (0.5 * (shell + barrier) - 300.0) / 100.0) * (shell - barrier)
        inner = g_2 * (barrier - liner)
        drying = wet / 240.0 * np.exp((barrier - 330.0) / 15.0) if water else 0.0
        return [
            (1e3 * absorbed * float(u[0]) - h * (shell - room) - gap) / c_shell,
            (gap - inner - VAPORISATION * water * drying) / c_barrier,
            (inner - u_plate * (liner - plate)) / c_liner,
            -drying,
        ]

    for number, (name, stop) in enumerate((("first", 1800.0), ("second", 1500.0), ("third", 1640.0))):
        flux = bursts(rng, stop, 45.0, 60.0, 1.5, 9.0, 2.0)
        if name == "third":
            flux = stairs(rng, stop, 55.0, 0.5, 7.0, 5, 2.0)
        room = ramped(rng, stop, 240.0, 20.0, 27.0, 10.0)
        t, x = integrated(rates, (begin, begin, begin, 1.0), (flux, room), stop, 0.5)
        one, two = (2, 1) if is_exchanged and name == "first" else (1, 2)
        sensors = [
            Sensor("sample.shell", "TE1 aussen", "degC", celsius(0), 0.5, 2.0, noise_stated, 0.1, wild=wild),
            Sensor("sample.barrier", "TE2", "degC", celsius(one), 0.3, 2.0, noise_stated, 0.1, wild=wild),
            Sensor("sample.liner", "TE3", "degC", celsius(two), 0.2, 2.0, noise_stated, 0.1, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"panel.flux": (flux, "kW/m^2"), "hall.room": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["hall.room"],
        )
        write(folder / name, rng, made)


def jacket_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("min", zero=77.0, jitter=0.2),
        Logger("s", zero=-15.0, gap=(600.0, 690.0)),
        Logger("h", zero=14.5),
    )
    _jacket(folder, rng, wild=0.01, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, wild readings, jitter, a gap of 90 s, three loggers of min, s and h, "
        "Co-Simulation",
        FINE,
    )


def jacket_gap(folder: Path, rng: Rng) -> Truth:
    warmer = rng.uniform(0.4, 0.65)
    _jacket(folder, rng, warmer=warmer, loggers=(Logger("s", zero=100.0), Logger("min")))
    return Truth(
        f"the gap behind the shell conducts better when it is hot: G_1 (1 + {warmer:.3f} (T_mean - 300 K)/100 K)",
        PHYSICS,
        WARMER,
    )


def jacket_two(folder: Path, rng: Rng) -> Truth:
    warmer, water = rng.uniform(0.4, 0.65), rng.uniform(0.02, 0.04)
    _jacket(folder, rng, warmer=warmer, water=water, loggers=(PLAIN, Logger("min", zero=8.0)))
    return Truth(
        f"the gap behind the shell conducts better when it is hot, G_1 (1 + {warmer:.3f} (T_mean - 300 K)/100 K), and "
        f"the barrier holds {1e3 * water:.1f} g/m^2 of water that dries, in each recording anew",
        PHYSICS,
        (*WARMER, "hidden_state", "hidden_source"),
    )


def jacket_exchanged(folder: Path, rng: Rng) -> Truth:
    _jacket(folder, rng, is_exchanged=True, loggers=(Logger("min", zero=-3.0), PLAIN))
    return Truth("the thermocouples of barrier and liner are exchanged in the first recording", (*RECORDING, *SENSOR))


# --- a heat pump (FMI 2, Model Exchange) and a heated floor (FMI 3, Co-Simulation); two days; degC, kW, %; two rates
HEAT_PUMP = OdeModel(
    "heat_pump",
    {
        "P_max": (2500.0, "W"),
        "eta": (0.45, ""),
        "pinch": (8.0, "K"),
        "C_water": (3e5, "J/K"),
        "G": (1200.0, "W/K"),
        "T_begin": (300.15, "K"),
    },
    {"speed": "", "outside": "K", "back": "K"},
    {"T_w": ("K", "T_begin", "(speed*P_max*eta*T_w/fmax(T_w - outside + pinch, 5.0) - G*(T_w - back))/C_water")},
    {"supply": ("K", "T_w"), "heat": ("W", "G*(T_w - back)")},
    10.0,
)
FLOOR = OdeModel(
    "floor",
    {
        "C_slab": (1.2e7, "J/K"),
        "C_room": (4e6, "J/K"),
        "H": (540.0, "W/K"),
        "U": (150.0, "W/K"),
        "T_slab": (297.15, "K"),
        "T_room": (293.15, "K"),
    },
    {"heat": "W", "outside": "K"},
    {
        "T_s": ("K", "T_slab", "(heat - H*(T_s - T_r))/C_slab"),
        "T_r": ("K", "T_room", "(H*(T_s - T_r) - U*(T_r - outside))/C_room"),
    },
    {"slab": ("K", "T_s"), "air": ("K", "T_r")},
    10.0,
)
HEAT_PUMP_KNOWN = {"P_max": 0.02, "eta": 0.04, "C_water": 0.08, "G": 0.05}
FLOOR_KNOWN = {"C_slab": 0.05, "C_room": 0.08, "H": 0.06, "U": 0.05}


def _floor(
    folder: Path,
    rng: Rng,
    ground: float = 0.0,
    ahead: float = 0.0,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """Two FMUs; the slab may lose ground (T - 283 K) W to the soil.

    The heat meter's clock may be ahead [s] in the second recording. `strayed` is by how much [K] the slab's temperature
    at each begin is off (deviation), which is stated.
    """
    HEAT_PUMP.build(folder)
    build3(FLOOR, folder, has_exchange=False)
    data_sheet(folder, FLOOR, FLOOR_KNOWN)
    (folder / "numbers.yaml").rename(folder / "house.yaml")
    data_sheet(folder, HEAT_PUMP, HEAT_PUMP_KNOWN)
    parts = (
        programme("controller", ("speed", "'%'")).replace("0 '%'", "0 %")
        + programme("weather", ("outside", "degC"))
        + with_numbers("pump", "heat_pump")
        + with_numbers("house", "floor", "internal").replace("numbers.yaml", "house.yaml")
    )
    wires = (
        "  - controller.speed -> pump.speed\n  - weather.outside -> pump.outside\n"
        "  - weather.outside -> house.outside\n  - pump.heat -> house.heat\n  - house.slab -> pump.back\n"
    )
    scenario(folder, "A heat pump and a heated floor", 172800.0, 40, 120, parts, wires)
    p_max, eta, pinch, c_water, g, t_begin = drawn(rng, HEAT_PUMP, HEAT_PUMP_KNOWN)
    c_slab, c_room, h, loss, usual, t_room = drawn(rng, FLOOR, FLOOR_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        water, slab, room = (float(s) for s in x)
        outside = float(u[1]) + CELSIUS
        pumped = 0.01 * float(u[0]) * p_max * eta * water / max(water - outside + pinch, 5.0)
        heat, up = g * (water - slab), h * (slab - room)
        return [
            (pumped - heat) / c_water,
            (heat - up - ground * (slab - 283.0)) / c_slab,
            (up - loss * (room - outside)) / c_room,
        ]

    for number, (name, stop) in enumerate((("first", 172800.0), ("second", 144000.0), ("third", 158400.0))):
        speed = drawn_steps(rng, stop, 9000.0, 8.0, 90.0, 120.0)
        if name == "third":
            speed = telegraph(rng, stop, 6000.0, 15.0, 80.0, 120.0)
        outside = ramped(rng, stop, 14400.0, -9.0, 14.0, 600.0)
        said = float(f"{usual + rng.uniform(-1.5, 1.5):.5g}") if strayed else usual
        start = (t_begin, said + strayed * float(rng.normal()), t_room)
        t, x = integrated(rates, start, (speed, outside), stop, 30.0)
        metered = 1e-3 * g * (x[:, 0] - x[:, 1])
        late = ahead if name == "second" else 0.0

        def meter(now: Array, x: Array, u: Array, t: Array = t, kw: Array = metered, late: float = late) -> Array:
            return np.asarray(np.interp(now - late, t, kw))

        sensors = [
            Sensor("pump.supply", "Vorlauf", "degC", celsius(0), 0.15, 120.0, noise_stated, 0.1),
            Sensor("house.slab", "Estrich", "degC", celsius(1), 0.05, 120.0, noise_stated, 0.02),
            Sensor("house.air", "Raum EG", "degC", celsius(2), 0.08, 120.0, noise_stated, 0.05),
            Sensor("pump.heat", "WMZ kW", "kW", meter, 0.12, 360.0, noise_stated, 0.01),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"house": {"parameters": {"T_slab": f"{said:.6g} K"}}}
            sidecar["uncertain"] = {"house.T_slab": f"{strayed:g} K"}
        made = Written(
            t,
            x,
            sensors,
            {"controller.speed": (speed, "%"), "weather.outside": (outside, "degC")},
            loggers[number % len(loggers)],
            recorded=["weather.outside"],
            sidecar=sidecar,
        )
        write(folder / name, rng, made)


def floor_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=6.0), Logger("min", zero=1440.0, gap=(61200.0, 72000.0)), Logger("s", empty=0.02))
    _floor(folder, rng, strayed=0.8, noise_stated=1.25, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, the slab's begin is stated and off by 0.8 K (deviation), which is "
        "stated too, noise stated 1.25 times too large, two rates, a gap of 3 h, empty cells, three loggers",
        FINE,
    )


def floor_ground(folder: Path, rng: Rng) -> Truth:
    ground = rng.uniform(55.0, 80.0)
    _floor(folder, rng, ground=ground, loggers=(Logger("min", zero=30.0), Logger("h")))
    return Truth(f"the slab loses {ground:.1f} W/K (T - 283 K) to the soil", PHYSICS, (*LEAKING, "heat_exchange"))


def floor_clock(folder: Path, rng: Rng) -> Truth:
    ahead = 60.0 * round(rng.uniform(12.0, 20.0))
    _floor(folder, rng, ahead=ahead, loggers=(Logger("h"), Logger("min", zero=-90.0)))
    return Truth(
        f"the clock of the heat meter's table is {ahead / 60.0:g} min ahead in the second recording",
        (*RECORDING, *SENSOR),
    )


# --- the soft tail fin of a swimming robot in a flume, FMI 2 Model Exchange; ms, deg, mN m, m/s; the flume is a column
FIN = OdeModel(
    "fin",
    {
        "T_servo": (0.05, "s"),
        "J": (4e-4, "kg*m^2"),
        "k": (0.06, "N*m/rad"),
        "d": (1.6e-3, "N*m*s/rad"),
        "c": (0.06, "N*s^2/m/rad"),
    },
    {"command": "rad", "flow": "m/s"},
    {
        "root": ("rad", "0.0", "(command - root)/T_servo"),
        "bend": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "(k*(root - bend) - d*w - c*flow*flow*bend)/J"),
    },
    {"angle": ("rad", "bend"), "torque": ("N*m", "k*(root - bend)")},
    1e-3,
)
FIN_KNOWN = {"T_servo": 0.06, "J": 0.06, "k": 0.05, "d": 0.1, "c": 0.08}


def _fin(
    folder: Path,
    rng: Rng,
    drag: float = 0.0,
    share: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """Water may drag besides, drag w^2 [N m s^2].

    The torque cell may end, in the second recording, at what is exceeded for a `share` of the time.
    """
    FIN.build(folder)
    parts = programme("servo", ("command", "deg")) + programme("flume", ("flow", "m/s")) + with_numbers("tail", "fin")
    wires = "  - servo.command -> tail.command\n  - flume.flow -> tail.flow\n"
    scenario(folder, "A soft tail fin", 36.0, 0.02, 0.02, parts, wires)
    data_sheet(folder, FIN, FIN_KNOWN)
    lag, inertia, k, d, c = drawn(rng, FIN, FIN_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        root, bend, w = (float(s) for s in x)
        turned = k * (root - bend) - d * w - drag * w * abs(w) - c * float(u[1]) ** 2 * bend
        return [(float(u[0]) / DEGREES - root) / lag, w, turned / inertia]

    for number, (name, stop) in enumerate((("first", 36.0), ("second", 30.0), ("third", 33.0))):
        command = drawn_steps(rng, stop, 0.55, -35.0, 35.0, 0.02)
        if name == "third":
            command = swept(stop, -24.0, 24.0, 3.0, 0.6, 0.04)
        flow = ramped(rng, stop, 6.0, 0.0, 0.9, 0.1)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (command, flow), stop, 5e-3)
        torque = np.abs(1e3 * k * (x[:, 0] - x[:, 1]))
        end = float(f"{np.quantile(torque, 1.0 - share):.1f}") if share and name == "second" else np.inf

        def spoil(column: str, t: Array, v: Array, end: float = end) -> Array:
            return np.clip(v, -end, end) if column == "Mz (mNm)" else v

        sensors = [
            Sensor("tail.angle", "cam tip deg", "deg", scaled(1, DEGREES), 0.5, 0.02, noise_stated, 0.1, colour),
            Sensor(
                "tail.torque",
                "Mz (mNm)",
                "mN*m",
                lambda t, x, u: 1e3 * k * (x[:, 0] - x[:, 1]),
                0.5,
                0.02,
                noise_stated,
                0.1,
                colour,
            ),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"servo.command": (command, "deg"), "flume.flow": (flow, "m/s")},
            loggers[number % len(loggers)],
            recorded=["flume.flow"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def fin_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=8.1e4, empty=0.015), Logger("s", zero=-2.5), Logger("min", zero=0.75))
    _fin(folder, rng, noise_stated=1.2, colour=0.4, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.4 and is stated 1.2 times too "
        "large, empty cells, three loggers of ms, s and min",
        FINE,
    )


def fin_drag(folder: Path, rng: Rng) -> Truth:
    drag = rng.uniform(2.2e-4, 4e-4)
    _fin(folder, rng, drag=drag, loggers=(Logger("s", zero=4.0), Logger("ms")))
    return Truth(f"water drags besides, {drag:.2e} N m s^2 w^2", PHYSICS, SQUARE)


def fin_cell(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.13, 0.22)
    _fin(folder, rng, share=share, loggers=(Logger("ms", zero=-700.0), Logger("s")))
    return Truth(
        f"the torque cell ends at what {100 * share:.0f} % of the second recording exceed, either way, which is not "
        "stated",
        SENSOR,
    )


# --- an induction motor (gamma model, turning with the voltage) and a brake, FMI 3 Model Exchange; V, A, rpm, N m
MOTOR = OdeModel(
    "induction_motor",
    {
        "R_s": (5.0, "ohm"),
        "R_r": (4.0, "ohm"),
        "L_m": (0.4, "H"),
        "L_l": (0.05, "H"),
        "J": (3e-3, "kg*m^2"),
        "d": (1e-3, "N*m*s/rad"),
        "p": (2.0, ""),
    },
    {"u": "V", "turning": "rad/s", "load": "N*m"},
    {
        "sd": ("V*s", "0.0", "u - R_s*(sd/L_m - (rd - sd)/L_l) + turning*sq"),
        "sq": ("V*s", "0.0", "-R_s*(sq/L_m - (rq - sq)/L_l) - turning*sd"),
        "rd": ("V*s", "0.0", "-R_r*(rd - sd)/L_l + (turning - p*w)*rq"),
        "rq": ("V*s", "0.0", "-R_r*(rq - sq)/L_l - (turning - p*w)*rd"),
        "w": ("rad/s", "0.0", "(1.5*p*(sq*rd - sd*rq)/L_l - d*w - load)/J"),
    },
    {
        "speed": ("rad/s", "w"),
        "amperes": (
            "A",
            "sqrt((sd/L_m - (rd - sd)/L_l)*(sd/L_m - (rd - sd)/L_l)"
            " + (sq/L_m - (rq - sq)/L_l)*(sq/L_m - (rq - sq)/L_l))",
        ),
        "torque": ("N*m", "1.5*p*(sq*rd - sd*rq)/L_l"),
    },
    1e-4,
)
MOTOR_KNOWN = {"R_s": 0.04, "R_r": 0.06, "L_m": 0.06, "L_l": 0.06, "J": 0.05, "d": 0.1}


def _motor(
    folder: Path,
    rng: Rng,
    knee: float = np.inf,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """Iron may saturate, i_m = psi/L_m (1 + (psi/knee)^2), `knee` in V s.

    The second recording may have the column of the load of another run.
    """
    build3(MOTOR, folder, has_co_simulation=False)
    names = (("inverter", "u", "V"), ("clock", "turning", "rad/s"), ("brake", "load", "N*m"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("motor", "induction_motor")
    wires = "".join(f"  - {c}.{n} -> motor.{n}\n" for c, n, _ in names)
    scenario(folder, "An induction motor", 4.0, 2e-3, 2e-3, parts, wires)
    data_sheet(folder, MOTOR, MOTOR_KNOWN)
    r_s, r_r, l_m, l_l, inertia, d, pairs = drawn(rng, MOTOR, MOTOR_KNOWN)

    def stator(x: Array) -> tuple[Array, Array]:
        """Currents of the stator along and across [A]."""
        main = (1.0 + (x[..., 0] ** 2 + x[..., 1] ** 2) / knee**2) / l_m
        return (
            np.asarray(x[..., 0] * main - (x[..., 2] - x[..., 0]) / l_l),
            np.asarray(x[..., 1] * main - (x[..., 3] - x[..., 1]) / l_l),
        )

    def torque(x: Array) -> Array:
        return np.asarray(1.5 * pairs * (x[..., 1] * x[..., 2] - x[..., 0] * x[..., 3]) / l_l)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        sd, sq, rd, rq, w = (float(s) for s in x)
        along, across = (float(i) for i in stator(x))
        volts, turning, load = (float(s) for s in u)
        slip = turning - pairs * w
        return [
            volts - r_s * along + turning * sq,
            -r_s * across - turning * sd,
            -r_r * (rd - sd) / l_l + slip * rq,
            -r_r * (rq - sq) / l_l - slip * rd,
            (float(torque(x)) - d * w - load) / inertia,
        ]

    other = drawn_steps(rng, 3.4, 0.25, 0.0, 1.6, 2e-3)
    for number, (name, stop) in enumerate((("first", 4.0), ("second", 3.4), ("third", 3.8))):
        u = drawn_steps(rng, stop, 0.35, 110.0, 190.0, 2e-3)
        if name == "third":
            u = stairs(rng, stop, 0.3, 112.0, 186.0, 4, 2e-3)
        turning = drawn_steps(rng, stop, 0.5, 235.0, 314.0, 2e-3)
        load = drawn_steps(rng, stop, 0.25, 0.0, 1.6, 2e-3)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0, 0.0), (u, turning, load), stop, 5e-4)
        sensors = [
            Sensor("motor.speed", "n_Welle", "rpm", scaled(4, RPM), 4.0, 2e-3, noise_stated, 1.0),
            Sensor("motor.amperes", "|I| A", "A", lambda t, x, u: np.hypot(*stator(x)), 0.04, 2e-3, noise_stated, 0.01),
            Sensor("motor.torque", "M_airgap", "N*m", lambda t, x, u: torque(x), 0.06, 2e-3, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"inverter.u": (u, "V"), "clock.turning": (turning, "rad/s"), "brake.load": (load, "N*m")},
            loggers[number % len(loggers)],
            recorded=["brake.load"],
            told={"brake.load": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)


def motor_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=-100.0, gap=(1800.0e-3, 2060.0e-3)), Logger("s", zero=7.0), Logger("ms", empty=0.02))
    _motor(folder, rng, noise_stated=0.88, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.14 times too small, a gap of 0.26 s, empty cells, three "
        "loggers of ms and s",
        FINE,
    )


def motor_iron(folder: Path, rng: Rng) -> Truth:
    knee = rng.uniform(0.7, 0.95)
    _motor(folder, rng, knee=knee, loggers=(Logger("ms"), Logger("s", zero=0.5)))
    return Truth(
        f"iron saturates: i_m = psi/L_m (1 + (psi/{knee:.4f} V s)^2)",
        PHYSICS,
        ("saturation", "magnetic_saturation", "saturable_inductance", "inductance_of_current"),
    )


def motor_other_run(folder: Path, rng: Rng) -> Truth:
    _motor(folder, rng, is_other=True, loggers=(Logger("s"), Logger("ms", zero=60.0)))
    return Truth("the second recording has the load of another run", (*RECORDING, *SENSOR))


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    coil_warm,
    frame_lag,
    ink_null,
    sweat_enzyme,
    jacket_exchanged,
    floor_null,
    fin_drag,
    motor_other_run,
    coil_null,
    frame_cogging,
    ink_start,
    sweat_null,
    jacket_gap,
    floor_clock,
    fin_null,
    motor_iron,
    coil_still,
    frame_two,
    ink_thinning,
    sweat_drift,
    jacket_null,
    floor_ground,
    fin_cell,
    motor_null,
    jacket_two,
)
