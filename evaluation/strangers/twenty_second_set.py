"""Twenty-second set: a lift, vapour, a roaster, a wind tunnel, an ice tank, a rider, powder, a bank of coils.

Written by an author who had read neither the library of laws nor its proof nor its tests nor its thresholds, and who
had not run a diagnosis, of these cases or of any other; of the earlier sets, the author had read two and the helpers
that these take from the others. Truths are integrated by scipy from equations that stand here. How large an effect is,
and how far the numbers are off, is drawn; the deviations of the numbers are those that a parameter set states.
Recordings of a rig differ in length and in logger; the one that is held out was partly made with a programme of another
kind, within the range of the others.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.eighth_set import idle_column
from evaluation.strangers.eleventh_set import RPM, RUBBING, telegraph
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import GRAVITY, integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.sixteenth_set import later
from evaluation.strangers.tenth_set import stairs, swept
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Heat of evaporation of the water in a bean [J/kg].
EVAPORATION = 2.3e6
#: A ton of 2000 pounds [t].
SHORT_TON = 0.90718474
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass")
#: Laws that are true where something takes up what the model keeps elsewhere.
SORBING = ("sorption", "adsorption", "wall_adsorption", *STORED)
#: Laws that are true where a drag depends on the place.
PLACED = ("state_dependent_damping", "damping_of_state", "position_dependent_friction", "position_dependent_damping")
#: Laws that are true where a rate depends on what there is of something.
RATED = ("reaction_order", "nonlinear_rate", "rate_of_state", "state_dependent_rate")
#: Laws that are true where something begins at a value.
BEGINNING = ("threshold", "dead_zone", "dead_band", "onset")
#: Laws that are true where a gain of an input falls with the input.
SATED = ("saturation", "saturating_gain", "input_saturation", "nonlinear_input", "gain_of_input")
#: Laws that are true where melting takes up heat.
MELTING = ("latent_heat", "phase_change", "melting", "apparent_heat_capacity")
#: Laws that are true where coils warm each other.
NEIGHBOURS = (
    "neighbour_conduction",
    "neighbour_heat",
    "coil_coupling",
    "thermal_coupling",
    "mutual_heating",
    "coupling",
)


# --- a small lift with counterweight and balance chain, FMI 2 Model Exchange; ms, A, kg, rpm, mm, N
LIFT = OdeModel(
    "lift",
    {
        "J": (0.8, "kg*m^2"),
        "k_t": (7.0, "N*m/A"),
        "d": (6.0, "N*m*s/rad"),
        "r": (0.1, "m"),
        "k": (9000.0, "N/m"),
        "c": (150.0, "N*s/m"),
        "m_c": (60.0, "kg"),
        "m_w": (68.0, "kg"),
        "d_g": (25.0, "N*s/m"),
        "K": (80.0, "N/m"),
    },
    {"amps": "A", "payload": "kg"},
    {
        "q": ("rad", "0.0", "w"),
        "w": (
            "rad/s",
            "0.0",
            f"(k_t*amps - d*w - r*(k*(r*q - x) + c*(r*w - v)) + r*{GRAVITY}*(m_w - m_c) - r*K*x)/(J + m_w*r*r)",
        ),
        "x": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", f"(k*(r*q - x) + c*(r*w - v) - payload*{GRAVITY} - d_g*v)/(m_c + payload)"),
    },
    {"sheave": ("rad/s", "w"), "cabin": ("m", "x"), "rope": ("N", "k*(r*q - x) + c*(r*w - v)")},
    1e-3,
)
LIFT_KNOWN = {"J": 0.06, "k_t": 0.03, "d": 0.08, "k": 0.06, "c": 0.1, "m_c": 0.01, "m_w": 0.01, "d_g": 0.15, "K": 0.03}


def _lift(
    folder: Path,
    rng: Rng,
    bent: tuple[float, float, float] | None = None,
    away: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """A rail may be bent: drag [N s/m] about a place [m], over a width [m].

    Away is begin and end [s] of a stretch of the first recording in which no weights are in the cabin, against what is
    said.
    """
    LIFT.build(folder)
    parts = programme("inverter", ("amps", "A")) + programme("weights", ("payload", "kg"))
    parts += with_numbers("lift", "lift")
    wires = "  - inverter.amps -> lift.amps\n  - weights.payload -> lift.payload\n"
    scenario(folder, "A small lift with a balance chain", 32.0, 0.01, 0.02, parts, wires)
    data_sheet(folder, LIFT, LIFT_KNOWN)
    inertia, k_t, d, r, k, c, m_c, m_w, d_g, chain = drawn(rng, LIFT, LIFT_KNOWN)
    more, place, width = bent if bent is not None else (0.0, 0.0, 1.0)

    def rope(x: Array) -> Array:
        """Pull above that of the empty cabin [N]."""
        return np.asarray(k * (r * x[..., 0] - x[..., 2]) + c * (r * x[..., 1] - x[..., 3]))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        _, w, place_now, v = (float(s) for s in x)
        pull = float(rope(x))
        drag = d_g + more * np.exp(-(((place_now - place) / width) ** 2))
        uneven = r * GRAVITY * (m_w - m_c) - r * chain * place_now
        return [
            w,
            (k_t * float(u[0]) - d * w - r * pull + uneven) / (inertia + m_w * r * r),
            v,
            (pull - float(u[1]) * GRAVITY - drag * v) / (m_c + float(u[1])),
        ]

    for number, (name, stop) in enumerate((("first", 32.0), ("second", 25.0), ("third", 28.0))):
        amps = drawn_steps(rng, stop, 1.4, -2.6, 4.6, 0.02)
        if name == "third":
            amps = stairs(rng, stop, 1.2, -2.4, 4.4, 5, 0.02)
        payload = bursts(rng, stop, 2.2, 3.6, 8.0, 30.0, 0.02)
        amps, payload = later(amps, 0.01), later(payload, 0.01)
        run = payload
        if away is not None and name == "first":
            run = between(payload, away[0], away[1], lambda v: 0.0)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (amps, run), stop, 5e-3)
        sensors = [
            Sensor("lift.sheave", "Treibscheibe rpm", "rpm", scaled(1, RPM), 0.4, 0.02, noise_stated, 0.1),
            Sensor("lift.cabin", "laser mm", "mm", scaled(2, 1e3), 4.0, 0.02, noise_stated, 1.0),
            Sensor("lift.rope", "load cell (tared) N", "N", lambda t, x, u: rope(x), 6.0, 0.02, noise_stated, 1.0),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"inverter.amps": (amps, "A"), "weights.payload": (run, "kg")},
            loggers[number % len(loggers)],
            told={} if run is payload else {"weights.payload": payload},
        )
        write(folder / name, rng, made)


def lift_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=1.2e5, jitter=0.15), Logger("s", zero=-4.0, gap=(11.0, 12.6)), Logger("min"))
    _lift(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, jitter, a gap of 1.6 s, three loggers of ms, s and min",
        FINE,
    )


def lift_bent(folder: Path, rng: Rng) -> Truth:
    more, place, width = rng.uniform(200.0, 300.0), rng.uniform(0.1, 0.9), rng.uniform(0.3, 0.45)
    _lift(folder, rng, bent=(more, place, width), loggers=(Logger("ms", zero=40.0), Logger("s")))
    return Truth(
        f"a guide rail is bent about {place:.3f} m: the cabin's drag rises there by {more:.1f} N s/m "
        f"exp(-((x - {place:.3f} m)/{width:.3f} m)^2)",
        PHYSICS,
        PLACED,
    )


def lift_away(folder: Path, rng: Rng) -> Truth:
    begin = 0.02 * round(rng.uniform(6.0, 14.0) / 0.02) + 0.01
    _lift(folder, rng, away=(begin, begin + 9.0), loggers=(Logger("s", zero=2.0), Logger("ms", zero=-700.0)))
    return Truth(
        f"for 9 s from {begin:.2f} s of the first recording on, no weights are in the cabin, and they are said to be",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- anaesthetic vapour in a circle and a patient (a simulator's), FMI 2 Co-Simulation; min, L/min, %
VAPOUR = OdeModel(
    "vapour",
    {
        "V_c": (6e-3, "m^3"),
        "V_a": (2.6e-3, "m^3"),
        "lam": (0.65, ""),
        "s": (0.75, ""),
        "V_v": (9e-3, "m^3"),
        "V_m": (0.06, "m^3"),
    },
    {"fresh": "m^3/s", "dial": "", "vent": "m^3/s", "heart": "m^3/s"},
    {
        "F_c": ("", "0.0", "(fresh*(dial - F_c) + vent*(F_a - F_c))/V_c"),
        "F_a": ("", "0.0", "(vent*(F_c - F_a) - lam*heart*(F_a - s*F_v - (1.0 - s)*F_m))/V_a"),
        "F_v": ("", "0.0", "lam*s*heart*(F_a - F_v)/V_v"),
        "F_m": ("", "0.0", "lam*(1.0 - s)*heart*(F_a - F_m)/V_m"),
    },
    {"inspired": ("", "F_c"), "expired": ("", "F_a")},
    0.5,
)
VAPOUR_KNOWN = {"V_c": 0.03, "V_a": 0.06, "lam": 0.04, "s": 0.03, "V_v": 0.06, "V_m": 0.08}


def _vapour(
    folder: Path,
    rng: Rng,
    hoses: float = 0.0,
    sorbed: float = 0.0,
    cools: float = np.inf,
    is_swapped: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """Hoses may take up vapour, as much as `hoses` L of gas would, at `sorbed` L/min.

    The vaporiser may cool where much gas flows, so that it gives dial/(1 + (fresh/cools)^2), cools in L/min. Both
    columns may be swapped in the second recording.
    """
    VAPOUR.build(folder)
    parts = (
        programme("machine", ("fresh", "L/min"), ("dial", "'%'"), ("vent", "L/min")).replace("0 '%'", "0 %")
        + programme("pump", ("heart", "L/min"))
        + with_numbers("patient", "vapour", "internal")
    )
    wires = "".join(f"  - machine.{n} -> patient.{n}\n" for n in ("fresh", "dial", "vent"))
    wires += "  - pump.heart -> patient.heart\n"
    scenario(folder, "Vapour in a circle and a patient", 2700.0, 1, 2, parts, wires)
    data_sheet(folder, VAPOUR, VAPOUR_KNOWN)
    v_c, v_a, lam, s, v_v, v_m = drawn(rng, VAPOUR, VAPOUR_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Shares are in %, flows in L/s; the last is what is in the hoses."""
        circle, lung, vessels, muscle, held = (float(v) for v in x)
        fresh, vent, heart = float(u[0]) / 60.0, float(u[2]) / 60.0, lam * float(u[3]) / 60.0
        given = float(u[1]) / (1.0 + (float(u[0]) / cools) ** 2)
        taken = sorbed / 60.0 * (circle - held)
        return [
            (fresh * (given - circle) + vent * (lung - circle) - taken) / (1e3 * v_c),
            (vent * (circle - lung) - heart * (lung - s * vessels - (1.0 - s) * muscle)) / (1e3 * v_a),
            heart * s * (lung - vessels) / (1e3 * v_v),
            heart * (1.0 - s) * (lung - muscle) / (1e3 * v_m),
            taken / hoses if hoses else 0.0,
        ]

    for number, (name, stop) in enumerate((("first", 2700.0), ("second", 2100.0), ("third", 2400.0))):
        dial = drawn_steps(rng, stop, 180.0, 0.0, 5.0, 2.0)
        if name == "third":
            dial = telegraph(rng, stop, 160.0, 0.3, 4.7, 2.0)
        fresh = drawn_steps(rng, stop, 240.0, 0.8, 7.0, 2.0)
        vent = drawn_steps(rng, stop, 320.0, 3.0, 8.0, 2.0)
        dial, fresh, vent = later(dial, 1.0), later(fresh, 1.0), later(vent, 1.0)
        heart = ramped(rng, stop, 300.0, 3.5, 7.0, 10.0)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0, 0.0), (fresh, dial, vent, heart), stop, 1.0)
        is_crossed = is_swapped and name == "second"
        first, second = (1, 0) if is_crossed else (0, 1)
        sensors = [
            Sensor("patient.inspired", "FiSev", "%", scaled(first, 1.0), 0.03, 2.0, noise_stated, 0.01, colour),
            Sensor("patient.expired", "etSev", "%", scaled(second, 1.0), 0.03, 2.0, noise_stated, 0.01, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "machine.fresh": (fresh, "L/min"),
                "machine.dial": (dial, "%"),
                "machine.vent": (vent, "L/min"),
                "pump.heart": (heart, "L/min"),
            },
            loggers[number % len(loggers)],
            recorded=["pump.heart"],
        )
        write(folder / name, rng, made)


def vapour_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("min", zero=7.0, is_comma=True, empty=0.03),
        Logger("s", is_comma=True, gap=(900.0, 1020.0)),
        Logger("h", zero=8.25, is_comma=True),
    )
    _vapour(folder, rng, noise_stated=1.1, colour=0.3, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.3 and is stated 1.1 times too "
        "large, decimal commas, a column of an input, empty cells, a gap of 2 min, three loggers of min, s and h, "
        "Co-Simulation",
        FINE,
    )


def vapour_hoses(folder: Path, rng: Rng) -> Truth:
    hoses, sorbed = rng.uniform(7.0, 12.0), rng.uniform(0.8, 1.4)
    _vapour(folder, rng, hoses=hoses, sorbed=sorbed, loggers=(Logger("s", zero=12.0), Logger("min")))
    return Truth(
        f"rubber hoses take up vapour of the circle, at {sorbed:.3f} L/min, as much as {hoses:.2f} L of gas would",
        PHYSICS,
        SORBING,
    )


def vapour_two(folder: Path, rng: Rng) -> Truth:
    hoses, sorbed, cools = rng.uniform(7.0, 12.0), rng.uniform(0.8, 1.4), rng.uniform(10.0, 14.0)
    _vapour(folder, rng, hoses=hoses, sorbed=sorbed, cools=cools, loggers=(Logger("min", zero=-3.0), PLAIN))
    return Truth(
        f"rubber hoses take up vapour of the circle, at {sorbed:.3f} L/min, as much as {hoses:.2f} L of gas would; and "
        f"the vaporiser cools where much gas flows: it gives dial/(1 + (fresh/{cools:.2f} L/min)^2)",
        PHYSICS,
        (*SORBING, *SATED),
    )


def vapour_swapped(folder: Path, rng: Rng) -> Truth:
    _vapour(folder, rng, is_swapped=True, loggers=(PLAIN, Logger("min", zero=1.0)))
    return Truth("both columns are swapped in the second recording", (*RECORDING, *SENSOR))


# --- a sample roaster of coffee, FMI 2 Model Exchange; min, kW, %, degC, g/kg; two rates; the hall is a column
ROASTER = OdeModel(
    "roaster",
    {
        "C_d": (4500.0, "J/K"),
        "C_b": (1900.0, "J/K"),
        "U": (13.0, "W/K"),
        "eta": (0.62, ""),
        "h_f": (9.0, "W/K"),
        "k": (6e-4, "1/s"),
        "b": (0.03, "1/K"),
        "m": (1.0, "kg"),
        "T_d_begin": (453.15, "K"),
        "T_b_begin": (298.15, "K"),
        "W_begin": (0.11, "kg/kg"),
    },
    {"gas": "W", "fan": "", "hall": "K"},
    {
        "T_d": ("K", "T_d_begin", "(eta*gas - h_f*fan*(T_d - hall) - U*(T_d - T_b))/C_d"),
        "T_b": ("K", "T_b_begin", f"(U*(T_d - T_b) - {EVAPORATION}*m*k*W*exp(b*(T_b - 423.15)))/C_b"),
        "W": ("kg/kg", "W_begin", "-k*W*exp(b*(T_b - 423.15))"),
    },
    {"drum": ("K", "T_d"), "bean": ("K", "T_b"), "damp": ("kg/kg", "W")},
    0.25,
)
ROASTER_KNOWN = {"C_d": 0.05, "C_b": 0.04, "U": 0.06, "eta": 0.05, "h_f": 0.08, "k": 0.08, "b": 0.05}


def _roaster(
    folder: Path,
    rng: Rng,
    burns: float = 0.0,
    begins: float = 180.0,
    lag: float = 0.0,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Beans may give heat from a temperature on: burns (T - begins), burns in W/K, begins in degC.

    The probe among the beans may lag in the second recording, with a time constant `lag` [s].
    """
    ROASTER.build(folder)
    parts = (
        programme("burner", ("gas", "kW"))
        + programme("blower", ("fan", "'%'")).replace("0 '%'", "0 %")
        + programme("air", ("hall", "degC"))
        + with_numbers("roaster", "roaster")
    )
    wires = "  - burner.gas -> roaster.gas\n  - blower.fan -> roaster.fan\n  - air.hall -> roaster.hall\n"
    scenario(folder, "A sample roaster", 960.0, 0.5, 1, parts, wires)
    data_sheet(folder, ROASTER, ROASTER_KNOWN)
    c_d, c_b, across, eta, h_f, k, b, mass, drum_begin, bean_begin, w_begin = drawn(rng, ROASTER, ROASTER_KNOWN)

    for number, (name, stop) in enumerate((("first", 960.0), ("second", 840.0), ("third", 900.0))):
        slow = lag if name == "second" else 0.0

        def rates(t: float, x: Array, u: Array, slow: float = slow) -> list[float]:
            """Moisture is in g/kg; the last is what a slow probe shows."""
            drum, bean, damp, shown = (float(s) for s in x)
            passed = across * (drum - bean)
            dried = k * damp * np.exp(b * (bean - 423.15))
            own = burns * max(bean - CELSIUS - begins, 0.0)
            lost = h_f * 0.01 * float(u[1]) * (drum - CELSIUS - float(u[2]))
            return [
                (1e3 * eta * float(u[0]) - lost - passed) / c_d,
                (passed - 1e-3 * EVAPORATION * mass * dried + own) / c_b,
                -dried,
                (bean - shown) / slow if slow else 0.0,
            ]

        gas = drawn_steps(rng, stop, 50.0, 0.8, 4.4, 1.0)
        if name == "third":
            gas = wandering(rng, stop, 40.0, 0.9, 4.3, 1.0)
        fan = drawn_steps(rng, stop, 80.0, 25.0, 100.0, 1.0)
        gas, fan = later(gas, 0.5), later(fan, 0.5)
        hall = ramped(rng, stop, 200.0, 19.0, 24.0, 10.0)
        start = (drum_begin, bean_begin, 1e3 * w_begin, bean_begin)
        t, x = integrated(rates, start, (gas, fan, hall), stop, 0.5)
        sensors = [
            Sensor("roaster.drum", "TC Trommel", "degC", celsius(0), 0.6, 1.0, noise_stated, 0.25, wild=wild),
            Sensor(
                "roaster.bean", "TC Bohne", "degC", celsius(3 if slow else 1), 0.4, 1.0, noise_stated, 0.25, wild=wild
            ),
            Sensor("roaster.damp", "NIR g/kg", "g/kg", scaled(2, 1.0), 1.0, 2.0, noise_stated, 0.1, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"burner.gas": (gas, "kW"), "blower.fan": (fan, "%"), "air.hall": (hall, "degC")},
            loggers[number % len(loggers)],
            recorded=["air.hall"],
        )
        write(folder / name, rng, made)


def roaster_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=86.0), Logger("min", zero=-1.0, jitter=0.2), Logger("s", gap=(400.0, 440.0)))
    _roaster(folder, rng, wild=0.006, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, wild readings, noise stated rightly, two rates, a column of an input, jitter, "
        "a gap of 40 s, loggers of s and min",
        FINE,
    )


def roaster_cracks(folder: Path, rng: Rng) -> Truth:
    burns, begins = rng.uniform(4.5, 6.5), rng.uniform(158.0, 168.0)
    _roaster(folder, rng, burns=burns, begins=begins, loggers=(Logger("min", zero=3.0), PLAIN))
    return Truth(
        f"beans give heat of their own above {begins:.1f} degC: {burns:.2f} W/K (T - {begins:.1f} degC)",
        PHYSICS,
        (*BEGINNING, "self_heating", "exotherm", "reaction_heat", "nonlinear_heat"),
    )


def roaster_lag(folder: Path, rng: Rng) -> Truth:
    lag = rng.uniform(14.0, 22.0)
    _roaster(folder, rng, lag=lag, loggers=(PLAIN, Logger("min")))
    return Truth(
        f"the probe among the beans is a thick one in the second recording: it lags, time constant {lag:.1f} s",
        (*RECORDING, *SENSOR),
    )


# --- wind tunnel (FMI 3, Co-Simulation) and a turbine in it (FMI 2, Model Exchange); s, rpm, m/s, ohm, A, degC
TUNNEL = OdeModel(
    "tunnel",
    {
        "tau": (1.2, "s"),
        "p_f": (1.5e-3, "N*s^2/rad^2"),
        "z": (0.15, "N*s^2/m^2"),
        "m": (4.8, "kg"),
        "n_begin": (80.0, "rad/s"),
        "v_begin": (7.0, "m/s"),
    },
    {"drive": "rad/s", "thrust": "N"},
    {
        "n": ("rad/s", "n_begin", "(drive - n)/tau"),
        "v": ("m/s", "v_begin", "(p_f*n*fabs(n) - z*v*fabs(v) - thrust)/m"),
    },
    {"wind": ("m/s", "v"), "fan": ("rad/s", "n")},
    0.01,
)
TURBINE = OdeModel(
    "turbine",
    {
        "m_q": (3e-3, "kg"),
        "e": (0.042, "m/rad"),
        "t_0": (0.02, "N*s^2/m^2"),
        "t_w": (2.6e-3, "N*s^2/m/rad"),
        "J": (1.5e-3, "kg*m^2"),
        "d": (1.5e-4, "N*m*s/rad"),
        "k": (0.05, "V*s/rad"),
        "R": (1.1, "ohm"),
        "a_R": (3.9e-3, "1/K"),
        "C": (6.5, "J/K"),
        "U": (0.06, "W/K"),
        "T_room": (295.15, "K"),
        "w_begin": (80.0, "rad/s"),
    },
    {"wind": "m/s", "load": "ohm"},
    {
        "w": ("rad/s", "w_begin", "(m_q*wind*(wind - e*w) - d*w - k*k*w/(R*(1.0 + a_R*(T - T_room)) + load))/J"),
        "T": (
            "K",
            "T_room",
            "(R*(1.0 + a_R*(T - T_room))*pow(k*w/(R*(1.0 + a_R*(T - T_room)) + load), 2) - U*(T - T_room))/C",
        ),
    },
    {
        "speed": ("rad/s", "w"),
        "amps": ("A", "k*w/(R*(1.0 + a_R*(T - T_room)) + load)"),
        "winding": ("K", "T"),
        "thrust": ("N", "t_0*wind*fabs(wind) + t_w*w*wind"),
    },
    0.01,
)
TUNNEL_KNOWN = {"tau": 0.08, "p_f": 0.03, "z": 0.05, "m": 0.05}
TURBINE_KNOWN = {
    "m_q": 0.05,
    "e": 0.03,
    "t_0": 0.08,
    "t_w": 0.08,
    "J": 0.05,
    "d": 0.1,
    "k": 0.015,
    "R": 0.02,
    "C": 0.06,
    "U": 0.08,
}


def _tunnel(
    folder: Path,
    rng: Rng,
    weakens: float = 0.0,
    rubs: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; magnets may weaken as the winding warms, k (1 - weakens (T - T_room)), weakens in 1/K.

    Bearings may rub with a constant torque [N m]. The second recording may be said to have had the load of another run.
    """
    build3(TUNNEL, folder, has_exchange=False)
    TURBINE.build(folder)
    data_sheet(folder, TUNNEL, TUNNEL_KNOWN)
    (folder / "numbers.yaml").rename(folder / "tunnel.yaml")
    data_sheet(folder, TURBINE, TURBINE_KNOWN)
    parts = (
        programme("inverter", ("drive", "rpm"))
        + programme("rheostat", ("load", "ohm"))
        + with_numbers("tunnel", "tunnel", "internal").replace("numbers.yaml", "tunnel.yaml")
        + with_numbers("turbine", "turbine")
    )
    wires = (
        "  - inverter.drive -> tunnel.drive\n  - rheostat.load -> turbine.load\n"
        "  - tunnel.wind -> turbine.wind\n  - turbine.thrust -> tunnel.thrust\n"
    )
    scenario(folder, "A turbine in a wind tunnel", 150.0, 0.025, 0.1, parts, wires)
    tau, p_f, z, mass, n_begin, v_begin = drawn(rng, TUNNEL, TUNNEL_KNOWN)
    m_q, e, t_0, t_w, inertia, d, k, r, a_r, c, loss, room, w_begin = drawn(rng, TURBINE, TURBINE_KNOWN)

    def linked(x: Array) -> Array:
        """Of the generator [V s/rad]."""
        return np.asarray(k * (1.0 - weakens * (x[..., 3] - room)))

    def current(x: Array, load: Array) -> Array:
        """Of the generator [A]."""
        return np.asarray(linked(x) * x[..., 2] / (r * (1.0 + a_r * (x[..., 3] - room)) + load))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        n, v, w, warm = (float(s) for s in x)
        amps = float(current(x, u[1]))
        thrust = t_0 * v * abs(v) + t_w * w * v
        braked = d * w + float(linked(x)) * amps + rubs * np.tanh(w / 0.5)
        return [
            (float(u[0]) / RPM - n) / tau,
            (p_f * n * abs(n) - z * v * abs(v) - thrust) / mass,
            (m_q * v * (v - e * w) - braked) / inertia,
            (r * (1.0 + a_r * (warm - room)) * amps**2 - loss * (warm - room)) / c,
        ]

    other = later(drawn_steps(rng, 120.0, 7.0, 0.4, 9.0, 0.1), 0.05)
    for number, (name, stop) in enumerate((("first", 150.0), ("second", 120.0), ("third", 135.0))):
        drive = drawn_steps(rng, stop, 6.0, 520.0, 1250.0, 0.1)
        if name == "third":
            drive = swept(stop, 560.0, 1220.0, 24.0, 5.0, 0.3)
        load = drawn_steps(rng, stop, 7.0, 0.4, 9.0, 0.1)
        drive, load = later(drive, 0.05), later(load, 0.05)
        t, x = integrated(rates, (n_begin, v_begin, w_begin, room), (drive, load), stop, 0.025)
        sensors = [
            Sensor("tunnel.wind", "Prandtl m/s", "m/s", scaled(1, 1.0), 0.06, 0.1, noise_stated, 0.01),
            Sensor("turbine.speed", "n Turbine", "rpm", scaled(2, RPM), 6.0, 0.1, noise_stated, 1.0),
            Sensor("turbine.amps", "I Last A", "A", lambda t, x, u: current(x, u[:, 1]), 0.02, 0.1, noise_stated, 5e-3),
            Sensor("turbine.winding", "Pt1000 Wicklung", "degC", celsius(3), 0.2, 0.2, noise_stated, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"inverter.drive": (drive, "rpm"), "rheostat.load": (load, "ohm")},
            loggers[number % len(loggers)],
            told={"rheostat.load": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)


def tunnel_magnets(folder: Path, rng: Rng) -> Truth:
    weakens = rng.uniform(5e-3, 7e-3)
    _tunnel(folder, rng, weakens=weakens, loggers=(Logger("s", zero=5.0), Logger("ms")))
    return Truth(
        f"magnets weaken as the winding warms: k (1 - {1e3 * weakens:.3f}e-3/K (T - T_room)), in torque and voltage",
        PHYSICS,
    )


def tunnel_two(folder: Path, rng: Rng) -> Truth:
    weakens, rubs = rng.uniform(5e-3, 7e-3), rng.uniform(0.01, 0.016)
    _tunnel(folder, rng, weakens=weakens, rubs=rubs, loggers=(Logger("min"), Logger("s", zero=-20.0)))
    return Truth(
        f"magnets weaken as the winding warms: k (1 - {1e3 * weakens:.3f}e-3/K (T - T_room)), in torque and voltage; "
        f"and bearings rub with {1e3 * rubs:.2f} mN m at any speed",
        PHYSICS,
        RUBBING,
    )


def tunnel_other_run(folder: Path, rng: Rng) -> Truth:
    _tunnel(folder, rng, is_other=True, loggers=(PLAIN, Logger("ms", zero=1e4)))
    return Truth("the second recording is said to have had the load of another run", (*RECORDING, *SENSOR))


# --- a tank of model ice on a chilled floor, FMI 3 Model Exchange; h, W, L/min, degC; the hall is a column
ICE = OdeModel(
    "ice_tank",
    {
        "C_b": (8e4, "J/K"),
        "C_s": (3e5, "J/K"),
        "C_i": (9e4, "J/K"),
        "g_p": (2e6, "W*s/m^3/K"),
        "G_i": (150.0, "W/K"),
        "h": (16.0, "W/K"),
        "eps": (0.7, ""),
        "T_b_begin": (263.15, "K"),
        "T_s_begin": (265.15, "K"),
        "T_i_begin": (266.35, "K"),
    },
    {"chiller": "W", "pump": "m^3/s", "lamps": "W", "hall": "K"},
    {
        "T_b": ("K", "T_b_begin", "(g_p*pump*(T_s - T_b) - chiller)/C_b"),
        "T_s": ("K", "T_s_begin", "(g_p*pump*(T_b - T_s) + G_i*(T_i - T_s))/C_s"),
        "T_i": ("K", "T_i_begin", "(G_i*(T_s - T_i) + h*(hall - T_i) + eps*lamps)/C_i"),
    },
    {"brine": ("K", "T_b"), "slab": ("K", "T_s"), "ice": ("K", "T_i")},
    5.0,
)
ICE_KNOWN = {"C_b": 0.04, "C_s": 0.05, "C_i": 0.05, "g_p": 0.06, "G_i": 0.06, "h": 0.08, "eps": 0.05}


def _ice(
    folder: Path,
    rng: Rng,
    melts: float = 0.0,
    about: float = -5.5,
    width: float = 1.0,
    drift: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Brine in the ice may melt about a temperature: C_i (1 + melts exp(-((T - about)/width)^2)), in degC and K.

    The thermometer of the slab may drift, K/h, in the second recording.
    """
    build3(ICE, folder, has_co_simulation=False)
    names = (("plant", "chiller", "W"), ("plant", "pump", "L/min"), ("sun", "lamps", "W"), ("hall", "hall", "degC"))
    parts = programme("plant", ("chiller", "W"), ("pump", "L/min")) + programme("sun", ("lamps", "W"))
    parts += programme("hall", ("hall", "degC")) + with_numbers("tank", "ice_tank")
    wires = "".join(f"  - {c}.{n} -> tank.{n}\n" for c, n, _ in names)
    scenario(folder, "A tank of model ice", 21600.0, 10, 20, parts, wires)
    data_sheet(folder, ICE, ICE_KNOWN)
    c_b, c_s, c_i, g_p, g_i, h, eps, *begin = drawn(rng, ICE, ICE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        brine, slab, ice = (float(s) for s in x)
        pumped, up = g_p * float(u[1]) / 6e4 * (slab - brine), g_i * (slab - ice)
        wide = c_i * (1.0 + melts * np.exp(-(((ice - CELSIUS - about) / width) ** 2)))
        return [
            (pumped - float(u[0])) / c_b,
            (-pumped - up) / c_s,
            (up + h * (float(u[3]) + CELSIUS - ice) + eps * float(u[2])) / wide,
        ]

    for number, (name, stop) in enumerate((("first", 21600.0), ("second", 17280.0), ("third", 19440.0))):
        chiller = telegraph(rng, stop, 1500.0, 40.0, 660.0, 20.0)
        if name == "third":
            chiller = stairs(rng, stop, 480.0, 50.0, 650.0, 6, 20.0)
        pump = drawn_steps(rng, stop, 1500.0, 4.0, 14.0, 20.0)
        lamps = bursts(rng, stop, 1500.0, 1200.0, 120.0, 500.0, 20.0)
        chiller, pump, lamps = later(chiller, 10.0), later(pump, 10.0), later(lamps, 10.0)
        hall = ramped(rng, stop, 3600.0, 6.0, 15.0, 60.0)
        t, x = integrated(rates, begin, (chiller, pump, lamps, hall), stop, 10.0)
        strays = drift if name == "second" else 0.0

        def spoil(column: str, t: Array, v: Array, strays: float = strays) -> Array:
            return v + strays * t / 3600.0 if column == "Pt100 Platte" else v

        sensors = [
            Sensor("tank.brine", "Pt100 Sole", "degC", celsius(0), 0.06, 20.0, noise_stated, 0.01),
            Sensor("tank.slab", "Pt100 Platte", "degC", celsius(1), 0.06, 20.0, noise_stated, 0.01),
            Sensor("tank.ice", "IR Eis", "degC", celsius(2), 0.1, 20.0, noise_stated, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "plant.chiller": (chiller, "W"),
                "plant.pump": (pump, "L/min"),
                "sun.lamps": (lamps, "W"),
                "hall.hall": (hall, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["hall.hall"],
            spoil=spoil if strays else None,
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "door", lambda n: np.zeros(n))


def ice_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=9.5), Logger("min", zero=540.0, empty=0.02), Logger("s", gap=(8000.0, 9200.0)))
    _ice(folder, rng, noise_stated=0.9, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.1 times too small, a column of an input, a column that nobody "
        "uses, empty cells, a gap of 20 min, three loggers of h, min and s",
        FINE,
    )


def ice_melts(folder: Path, rng: Rng) -> Truth:
    melts, about, width = rng.uniform(3.0, 5.0), rng.uniform(-6.0, -5.2), rng.uniform(1.1, 1.6)
    _ice(folder, rng, melts=melts, about=about, width=width, loggers=(Logger("min"), Logger("h", zero=-1.0)))
    return Truth(
        f"brine in the ice melts about {about:.2f} degC: its heat capacity is 1 + {melts:.2f} "
        f"exp(-((T - {about:.2f} degC)/{width:.2f} K)^2) times as large",
        PHYSICS,
        MELTING,
    )


def ice_drift(folder: Path, rng: Rng) -> Truth:
    drift = float(rng.choice([-1.0, 1.0])) * rng.uniform(0.14, 0.22)
    _ice(folder, rng, drift=drift, loggers=(Logger("h"), Logger("min", zero=15.0)))
    return Truth(
        f"the thermometer of the slab drifts by {drift:.3f} K/h in the second recording",
        (*RECORDING, *SENSOR),
    )


# --- a rider on an ergometer, FMI 2 Model Exchange, without units and with names as a clinic has them; two rates
RIDER = OdeModel(
    "Proband_07",
    {
        "v_Ruhe": (0.35, ""),
        "g_Watt": (0.0108, ""),
        "n_opt": (80.0, ""),
        "c_Kad": (1.6e-4, ""),
        "Tau1": (35.0, ""),
        "HF_0": (62.0, ""),
        "HF_1": (28.0, ""),
        "Dq": (0.012, ""),
        "Tau2": (600.0, ""),
        "La_k": (8e-3, ""),
        "La_s": (1.6, ""),
        "La_e": (1.7e-3, ""),
        "La_A": (1.2, ""),
        "D_A": (0.0, ""),
        "V_A": (0.4, ""),
    },
    {"P_soll": "", "Kad": ""},
    {
        "VO2": ("", "V_A", "(v_Ruhe + g_Watt*P_soll*(1.0 + c_Kad*(Kad - n_opt)*(Kad - n_opt)) - VO2)/Tau1"),
        "Drf": ("", "D_A", "Dq*(VO2 - v_Ruhe) - Drf/Tau2"),
        "Lak": ("", "La_A", "La_k*exp(La_s*(VO2 - 3.0)) - La_e*(Lak - 1.0)"),
    },
    {"HF_ist": ("", "HF_0 + HF_1*VO2 + Drf"), "VO2_ist": ("", "VO2"), "La_ist": ("", "Lak")},
    0.5,
)
RIDER_KNOWN = {
    "v_Ruhe": 0.04,
    "g_Watt": 0.03,
    "n_opt": 0.03,
    "c_Kad": 0.1,
    "Tau1": 0.06,
    "HF_0": 0.02,
    "HF_1": 0.03,
    "Dq": 0.08,
    "Tau2": 0.08,
    "La_k": 0.08,
    "La_s": 0.05,
    "La_e": 0.08,
}


def _rider(
    folder: Path,
    rng: Rng,
    tires: float = 0.0,
    over: float = 210.0,
    warmed: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Work above a power `over` [W] may tire: a watt needs 1 + tires E of its oxygen, E in 10 kJ; E is lost in 500 s.

    Warmed are lactate and drift at the begin of the second recording, of a warm-up that is not mentioned.
    """
    RIDER.build(folder)
    parts = programme("Rad_1", ("P_soll", ""), ("Kad", "")) + with_numbers("Proband", "Proband_07")
    wires = "  - Rad_1.P_soll -> Proband.P_soll\n  - Rad_1.Kad -> Proband.Kad\n"
    scenario(folder, "Ergometer, Proband 07", 1800.0, 1, 2, parts, wires)
    data_sheet(folder, RIDER, RIDER_KNOWN)
    rest, watt, best, lean, tau_1, hf_0, hf_1, d_q, tau_2, l_k, l_s, l_e, l_a, d_a, v_a = drawn(rng, RIDER, RIDER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The last is work above `over` [10 kJ]."""
        oxygen, drift, lactate, tired = (float(s) for s in x)
        power, cadence = float(u[0]), float(u[1])
        needed = watt * power * (1.0 + lean * (cadence - best) ** 2) * (1.0 + tires * tired)
        return [
            (rest + needed - oxygen) / tau_1,
            d_q * (oxygen - rest) - drift / tau_2,
            l_k * np.exp(l_s * (oxygen - 3.0)) - l_e * (lactate - 1.0),
            1e-4 * max(power - over, 0.0) - tired / 500.0,
        ]

    for number, (name, stop) in enumerate((("first", 1800.0), ("second", 1500.0), ("third", 1680.0))):
        power = drawn_steps(rng, stop, 70.0, 70.0, 310.0, 2.0)
        if name == "third":
            power = stairs(rng, stop, 60.0, 80.0, 300.0, 5, 2.0)
        power = later(power, 1.0)
        cadence = ramped(rng, stop, 120.0, 55.0, 105.0, 4.0)
        start = (v_a, d_a, l_a, 0.0)
        if warmed is not None and name == "second":
            start = (v_a, warmed[1], warmed[0], 0.0)
        t, x = integrated(rates, start, (power, cadence), stop, 1.0)
        sensors = [
            Sensor(
                "Proband.HF_ist",
                "HF [1/min]",
                "1",
                lambda t, x, u: np.asarray(hf_0 + hf_1 * x[:, 0] + x[:, 1]),
                1.2,
                2.0,
                noise_stated,
                1.0,
            ),
            Sensor("Proband.VO2_ist", "VO2 [L/min]", "1", scaled(0, 1.0), 0.06, 2.0, noise_stated, 0.01),
            Sensor("Proband.La_ist", "La Patch [mM]", "1", scaled(2, 1.0), 0.12, 4.0, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"Rad_1.P_soll": (power, ""), "Rad_1.Kad": (cadence, "")},
            loggers[number % len(loggers)],
            recorded=["Rad_1.Kad"],
        )
        write(folder / name, rng, made)


def rider_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", empty=0.03), Logger("min", zero=2.0), Logger("s", zero=-60.0, gap=(700.0, 790.0)))
    _rider(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, no units, two rates, a column of an input, empty cells, "
        "a gap of 90 s, loggers of s and min",
        FINE,
    )


def rider_tired(folder: Path, rng: Rng) -> Truth:
    tires, over = rng.uniform(0.055, 0.08), rng.uniform(195.0, 215.0)
    _rider(folder, rng, tires=tires, over=over, loggers=(Logger("s", zero=30.0), Logger("min")))
    return Truth(
        f"work above {over:.0f} W tires: a watt needs 1 + {tires:.3f} E of its oxygen, E the work above it [10 kJ], "
        "which is lost with a time constant of 500 s",
        PHYSICS,
        (*STORED, *BEGINNING, "fatigue", "wear"),
    )


def rider_warmed(folder: Path, rng: Rng) -> Truth:
    lactate, drift = rng.uniform(4.5, 6.5), rng.uniform(8.0, 12.0)
    _rider(folder, rng, warmed=(lactate, drift), loggers=(PLAIN, Logger("min", zero=-1.0)))
    return Truth(
        f"before the second recording there was a warm-up that is not mentioned: lactate begins at {lactate:.2f} mM "
        f"instead of 1.2 mM, the drift of the pulse at {drift:.1f}/min instead of 0",
        (*RECORDING, *SENSOR),
    )


# --- a hopper with a vibrating tray and a belt scale, FMI 2 Co-Simulation; kg/min, mm, m/s, kg, t/h
POWDER = OdeModel(
    "powder",
    {
        "k_g": (0.25, "1/s"),
        "m_full": (7.0, "kg"),
        "M_h": (40.0, "kg"),
        "c_2": (110.0, "1/m/s"),
        "L": (1.3, "m"),
        "M_begin": (130.0, "kg"),
        "m_begin": (5.0, "kg"),
    },
    {"refill": "kg/s", "shake": "m", "belt": "m/s"},
    {
        "M": ("kg", "M_begin", "refill - k_g*(m_full*M/(M + M_h) - m)"),
        "m": ("kg", "m_begin", "k_g*(m_full*M/(M + M_h) - m) - c_2*shake*m"),
        "b_1": ("kg", "0.0", "c_2*shake*m - belt*b_1/L"),
        "b_2": ("kg", "0.0", "belt*(b_1 - b_2)/L"),
    },
    {"hopper": ("kg", "M"), "laden": ("kg", "b_1 + b_2"), "flow": ("kg/s", "belt*b_2/L")},
    0.1,
)
POWDER_KNOWN = {"k_g": 0.08, "m_full": 0.04, "M_h": 0.08, "c_2": 0.05, "L": 0.02}


def caking(shake: Steps, low: float, high: float, share: float) -> Steps:
    """What counts of a shaking [mm]: below `low` powder sets, and a share counts no more until `high` is passed."""
    is_set, levels = False, []
    for level in shake.levels:
        is_set = level < low or (is_set and level < high)
        levels.append(level * (1.0 - share) if is_set else level)
    return Steps(shake.times, tuple(levels))


def _powder(
    folder: Path,
    rng: Rng,
    cakes: tuple[float, float, float] | None = None,
    is_short: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Powder may set: low and high shaking [mm] between which it stays as it is, and the share that counts no more.

    The flow of the second recording may be in short tons an hour.
    """
    POWDER.build(folder)
    names = (("elevator", "refill", "kg/min"), ("magnet", "shake", "mm"), ("drive", "belt", "m/s"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("feeder", "powder", "internal")
    wires = "".join(f"  - {c}.{n} -> feeder.{n}\n" for c, n, _ in names)
    scenario(folder, "A hopper, a tray and a belt scale", 900.0, 0.5, 1, parts, wires)
    data_sheet(folder, POWDER, POWDER_KNOWN)
    k_g, m_full, m_h, c_2, length, hopper_begin, tray_begin = drawn(rng, POWDER, POWDER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        hopper, tray, first, second = (float(s) for s in x)
        falls = k_g * (m_full * hopper / (hopper + m_h) - tray)
        thrown, carried = 1e-3 * c_2 * float(u[1]) * tray, float(u[2]) / length
        return [
            float(u[0]) / 60.0 - falls,
            falls - thrown,
            thrown - carried * first,
            carried * (first - second),
        ]

    for number, (name, stop) in enumerate((("first", 900.0), ("second", 720.0), ("third", 810.0))):
        shake = drawn_steps(rng, stop, 22.0, 0.25, 1.9, 1.0)
        if name == "third":
            shake = wandering(rng, stop, 18.0, 0.3, 1.85, 1.0)
        refill = bursts(rng, stop, 50.0, 45.0, 30.0, 80.0, 1.0)
        belt = drawn_steps(rng, stop, 35.0, 0.1, 0.45, 1.0)
        shake, refill, belt = later(shake, 0.5), later(refill, 0.5), later(belt, 0.5)
        counts = shake if cakes is None else caking(shake, *cakes)
        t, x = integrated(rates, (hopper_begin, tray_begin, 0.0, 0.0), (refill, counts, belt), stop, 0.5)
        hourly = 3.6 / (SHORT_TON if is_short and name == "second" else 1.0)

        def flow(t: Array, x: Array, u: Array, hourly: float = hourly) -> Array:
            """Over the end of the belt [t/h]."""
            return np.asarray(hourly * u[:, 2] / length * x[:, 3])

        sensors = [
            Sensor("feeder.hopper", "load cells kg", "kg", scaled(0, 1.0), 0.4, 1.0, noise_stated, 0.1),
            Sensor(
                "feeder.laden", "belt kg", "kg", lambda t, x, u: np.asarray(x[:, 2] + x[:, 3]), 0.06, 1.0, noise_stated
            ),
            Sensor("feeder.flow", "belt scale t/h", "t/h", flow, 0.03, 1.0, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"elevator.refill": (refill, "kg/min"), "magnet.shake": (shake, "mm"), "drive.belt": (belt, "m/s")},
            loggers[number % len(loggers)],
        )
        write(folder / name, rng, made)


def powder_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=30.0), Logger("s", zero=4.0, jitter=0.2, empty=0.02), Logger("h"))
    _powder(folder, rng, noise_stated=1.15, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.15 times too large, jitter, empty cells, three loggers of min, "
        "s and h, Co-Simulation",
        FINE,
    )


def powder_caked(folder: Path, rng: Rng) -> Truth:
    low, high, share = rng.uniform(0.5, 0.65), rng.uniform(1.2, 1.4), rng.uniform(0.16, 0.24)
    _powder(folder, rng, cakes=(low, high, share), loggers=(Logger("s", zero=-9.0), Logger("min")))
    return Truth(
        f"shaken by less than {low:.3f} mm, powder sets, and shaking moves {100 * share:.0f} % less of it, until it is "
        f"shaken by {high:.3f} mm or more",
        PHYSICS,
        ("hysteresis", "relay_hysteresis", "backlash", "gain_of_input", "nonlinear_input", "hidden_state", *BEGINNING),
    )


def powder_tons(folder: Path, rng: Rng) -> Truth:
    _powder(folder, rng, is_short=True, loggers=(PLAIN, Logger("min", zero=12.0)))
    return Truth(
        "the flow of the second recording is in short tons an hour (of 0.907 t), said to be in t/h",
        (*RECORDING, *SENSOR),
    )


# --- two strings of three coils side by side, each from its own supply, with weights; the tool's own units
BANK = {
    "reference_resistance": (3.1, "ohm", 0.02, 0.03),
    "heat_transfer_coefficient": (75.0, "W/(m^2*K)", 0.05, 0.03),
    "area": (110.0, "mm^2", 0.0, 0.0),
    "volume": (9.0, "mm^3", 0.0, 0.0),
    "density": (6450.0, "kg/m^3", 0.0, 0.0),
    "specific_heat": (850.0, "J/(kg*K)", 0.04, 0.03),
    "heating_a": (0.205, "N/mm", 0.02, 0.0),
    "heating_b": (17443.0, '"1"', None, None),
    "heating_c": (0.1669, "1/K", None, None),
    "heating_d": (0.148, "N/mm", 0.01, 0.0),
    "cooling_a": (0.178, "N/mm", 0.02, 0.0),
    "cooling_b": (696.0, '"1"', None, None),
    "cooling_c": (0.1549, "1/K", None, None),
    "cooling_d": (0.149, "N/mm", None, None),
}
BANK_COILS, BANK_WIRES, BANK_MASS = 6, 0.3, 0.2


def _bank_files(folder: Path) -> None:
    """Scenario and parameter set of the bank."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["title: Coils of our own winding", "parameters:"]
    for name, (value, unit, uncertainty, scatter) in BANK.items():
        known = "" if uncertainty is None else f", uncertainty: {uncertainty:g}, scatter: {scatter:g}"
        lines.append(f'  {name}: {{value: {value:g}, unit: {unit}, source: "own winding"{known}}}')
    lines += [
        '  use_regressed_cooling_rate: {value: false, source: "cools as it heats"}',
        '  initial_temperature: {value: 23, unit: degC, source: "room"}',
        '  reference_temperature: {value: 23, unit: degC, source: "room"}',
        '  resistance_temperature_coefficient: {value: 0, unit: 1/K, source: "neglected"}',
        '  coil_rest_length: {value: 11, unit: mm, source: "calliper"}',
    ]
    (folder / "numbers.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    parts = (
        "  supply:\n    kind: programme\n    outputs:\n"
        "      voltage: {unit: V, dim: string, points: [[0 s, [0 V, 0 V]]]}\n"
        + programme("room", ("temperature", "degC")).replace("constant: 0 degC", "constant: 23 degC")
        + f"  circuit: {{kind: ngspice, strings: [3, 3], supply: per_string, string_resistance: {BANK_WIRES} ohm, "
        "start: {resistance: 3.1 ohm}}\n"
        "  bank: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, mechanical: weights, "
        "parameter_set: numbers.yaml}\n"
        f"  weights: {{kind: hanging_mass, coils: {BANK_COILS}, mass: {1e3 * BANK_MASS:g} g}}\n"
    )
    wires = "  - supply.voltage -> circuit.supply_voltage\n"
    scenario(folder, "Two strings of three coils side by side", 90.0, 0.05, 0.1, parts, wires)


def _branch(numbers: Sequence[float], warm: Array) -> Array:
    """Equation (2) of the paper [N/mm], of a temperature [degC]."""
    a, b, c, d = numbers
    return np.asarray(a * np.exp(-b * np.exp(-c * warm)) + d)


def _stiffness(heating: Sequence[float], cooling: Sequence[float], warm: Array) -> Array:
    """Stiffness of a coil that was never heated before, which moves only as far as the branches demand [N/mm].

    Args:
        heating: a, b, c and d of the branch of rising temperature.
        cooling: Of falling temperature.
        warm: Its temperatures [degC].
    """
    up, down = _branch(heating, warm), _branch(cooling, warm)
    scan = np.arange(200.0, 0.0, -0.01)
    is_above = _branch(cooling, scan) >= _branch(heating, scan)
    crossing = float(scan[np.argmax(is_above)]) if is_above.any() else -np.inf
    found = np.empty(len(warm))
    now = up[0]
    for i, (a, b) in enumerate(zip(up, down)):
        now = a if warm[i] >= crossing else min(max(now, min(a, b)), max(a, b))
        found[i] = now
    return found


def _bank(
    folder: Path,
    rng: Rng,
    passes: float = 0.0,
    slips: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Heat may pass between coils that lie side by side, as a share of what each loses to the room per kelvin.

    Slips are an instant [s] of the first recording, from which on the thermocouple of coil 2 shows a share of how much
    warmer than the room it is, and that share.
    """
    _bank_files(folder)

    def off(name: str) -> Array:
        """Factors of a number, one for each coil."""
        _, _, uncertainty, scatter = BANK[name]
        return np.exp((uncertainty or 0.0) * rng.normal() + (scatter or 0.0) * rng.standard_normal(BANK_COILS))

    resistance = BANK["reference_resistance"][0] * off("reference_resistance")
    conductance = BANK["heat_transfer_coefficient"][0] * 1e-6 * BANK["area"][0] * off("heat_transfer_coefficient")
    capacity = BANK["density"][0] * 1e-9 * BANK["volume"][0] * BANK["specific_heat"][0] * off("specific_heat")
    heating = [BANK[f"heating_{n}"][0] for n in "abcd"]
    cooling = [BANK[f"cooling_{n}"][0] for n in "abcd"]
    heating[0] *= float(off("heating_a")[0])
    heating[3] *= float(off("heating_d")[0])
    cooling[0] *= float(off("cooling_a")[0])
    between_pairs = passes * BANK["heat_transfer_coefficient"][0] * 1e-6 * BANK["area"][0]
    wired = np.asarray([resistance[:3].sum() + BANK_WIRES, resistance[3:].sum() + BANK_WIRES])

    for number, (name, stop) in enumerate((("first", 90.0), ("second", 72.0), ("third", 80.0))):
        volts = [drawn_steps(rng, stop, 7.0, 0.0, 4.4, 0.1) for _ in range(2)]
        if name == "third":
            volts[0] = telegraph(rng, stop, 6.0, 0.4, 4.0, 0.1)
        volts = [later(v, 0.05) for v in volts]
        said = float(f"{rng.uniform(21.0, 25.0):.3g}")
        room = said + 0.2 * float(rng.normal())

        def rates(t: float, x: Array, u: Array, room: float = room) -> Array:
            """Temperatures of the coils [degC]."""
            amps = np.repeat(u / wired, 3)
            passed = between_pairs * (np.roll(x, 3) - x)
            return np.asarray((amps**2 * resistance - conductance * (x - room) + passed) / capacity)

        t, x = integrated(rates, [room] * BANK_COILS, volts, stop, 0.025)
        stiff = [_stiffness(heating, cooling, x[:, i]) for i in (1, 4)]
        stretched = np.stack([BANK_MASS * GRAVITY / k for k in stiff], axis=1)
        states = np.concatenate([x, stretched], axis=1)
        slip = slips if slips is not None and name == "first" else (np.inf, 1.0)

        def spoil(column: str, t: Array, v: Array, slip: tuple[float, float] = slip, room: float = room) -> Array:
            return np.where(t >= slip[0], room + slip[1] * (v - room), v) if column == "TC 2" else v

        sensors = [
            Sensor(
                f"string[{i + 1}].current",
                f"I{i + 1} mA",
                "mA",
                lambda t, x, u, v=volts[i], i=i: 1e3 * v.at(t) / wired[i],  # type: ignore[misc]
                2.0,
                0.1,
                noise_stated,
                0.5,
            )
            for i in range(2)
        ]
        sensors += [
            Sensor(f"coil[{i + 1}].temperature", f"TC {i + 1}", "degC", scaled(i, 1.0), 0.25, 0.2, noise_stated, 0.1)
            for i in range(BANK_COILS)
        ]
        sensors += [
            Sensor(f"coil[{i}].extension", f"laser {i} mm", "mm", scaled(s, 1.0), 0.05, 0.1, noise_stated, 0.01)
            for i, s in ((2, 6), (5, 7))
        ]
        # Both strings may switch at one instant, which is the same but for rounding.
        times = sorted({round(s, 9) for v in volts for s in v.times})
        points = [[f"{s:.10g} s", [f"{float(v.at(np.asarray([s]))[0]):.10g} V" for v in volts]] for s in times]
        sidecar: dict[str, Any] = {
            "components": {
                "supply": {"outputs": {"voltage": {"points": points}}},
                "bank": {"parameters": {"initial_temperature": f"{said:g} degC"}},
            },
            "uncertain": {"room.temperature": "0.3 degC"},
        }
        made = Written(
            t,
            states,
            sensors,
            {"room.temperature": (Steps((0.0,), (said,)), "degC")},
            loggers[number % len(loggers)],
            sidecar=sidecar,
            spoil=spoil,
        )
        write(folder / name, rng, made)


def bank_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=15.0), Logger("ms", zero=-2e3, empty=0.02), Logger("s", gap=(30.0, 34.0)))
    _bank(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, from coil to coil too, room and start off by 0.2 K (deviation), noise stated "
        "rightly, two rates, empty cells, a gap of 4 s, loggers of s and ms",
        FINE,
    )


def bank_neighbours(folder: Path, rng: Rng) -> Truth:
    passes = rng.uniform(0.14, 0.24)
    _bank(folder, rng, passes=passes, loggers=(PLAIN, Logger("ms", zero=500.0)))
    return Truth(
        f"coils that lie side by side in the two strings warm each other: per kelvin {passes:.3f} of what the model "
        "says a coil loses to the room",
        PHYSICS,
        NEIGHBOURS,
    )


def bank_slipped(folder: Path, rng: Rng) -> Truth:
    instant, share = float(f"{rng.uniform(25.0, 50.0):.3g}"), rng.uniform(0.74, 0.84)
    _bank(folder, rng, slips=(instant, share), loggers=(Logger("s", zero=-1.5), PLAIN))
    return Truth(
        f"the thermocouple of coil 2 slips at {instant:g} s of the first recording: from then on it shows {share:.3f} "
        "of how much warmer than the room the coil is",
        (*RECORDING, *SENSOR),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    vapour_hoses,
    lift_null,
    tunnel_magnets,
    bank_slipped,
    ice_null,
    rider_warmed,
    powder_caked,
    roaster_null,
    lift_away,
    vapour_null,
    ice_melts,
    tunnel_other_run,
    bank_null,
    roaster_cracks,
    powder_tons,
    rider_null,
    lift_bent,
    vapour_two,
    ice_drift,
    powder_null,
    bank_neighbours,
    roaster_lag,
    rider_tired,
    vapour_swapped,
    tunnel_two,
)
