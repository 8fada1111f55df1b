"""Eighteenth set: a hoist, a suction cup, a cabinet, a wearer, a seam sealer, a squid, a blanket, an ozone cabinet.

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
from evaluation.strangers.eleventh_set import LEAKING, RPM, RUBBING, telegraph
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import GRAVITY, integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Written, celsius, drawn_steps, write
from evaluation.strangers.sixteenth_set import WARMER, later
from evaluation.strangers.tenth_set import stairs, swept
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Heat of evaporation of water [J/kg]; heat capacity [J/kg/K] and density [kg/m^3] of air.
EVAPORATION, AIR, DENSITY = 2.45e6, 1006.0, 1.15
#: Laws that are true where something takes up what the model keeps in the air.
SORBING = ("sorption", "adsorption", "wall_adsorption", "hidden_state", "hidden_mass", "hidden_capacity", "second_mass")
#: Laws that are true where a body radiates.
RADIATING = ("radiation", "thermal_radiation", *WARMER)


# --- a hoist that lifts warp beams, its drum and its speed drive, FMI 2 Model Exchange; ms, m/s, mm, N, rpm
HOIST = OdeModel(
    "hoist",
    {
        "J": (0.02, "kg*m^2"),
        "r": (0.06, "m"),
        "k": (6e4, "N/m"),
        "c": (80.0, "N*s/m"),
        "m": (25.0, "kg"),
        "d": (30.0, "N*s/m"),
        "k_p": (1.0, "N*m*s/rad"),
        "M_hold": (14.715, "N*m"),
    },
    {"aim": "m/s", "hand": "N"},
    {
        "w": ("rad/s", "0.0", "(k_p*(aim/r - w) + M_hold - r*(k*s + c*(r*w - v)))/J"),
        "s": ("m", f"m*{GRAVITY}/k", "r*w - v"),
        "v": ("m/s", "0.0", f"(k*s + c*(r*w - v) - d*v + hand)/m - {GRAVITY}"),
        "x": ("m", "0.0", "v"),
    },
    {"drum": ("rad/s", "w"), "beam": ("m", "x"), "rope": ("N", "k*s + c*(r*w - v)")},
    5e-4,
)
HOIST_KNOWN = {"J": 0.05, "k": 0.06, "c": 0.15, "m": 0.02, "d": 0.12, "k_p": 0.04}


def _hoist(
    folder: Path,
    rng: Rng,
    dry: float = 0.0,
    is_reversed: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The rails may rub with `dry` N; the tacho may be the other way round in the second recording."""
    HOIST.build(folder)
    parts = programme("lever", ("aim", "m/s")) + programme("worker", ("hand", "N")) + with_numbers("lift", "hoist")
    wires = "  - lever.aim -> lift.aim\n  - worker.hand -> lift.hand\n"
    scenario(folder, "A hoist for warp beams", 8.0, 2e-3, 4e-3, parts, wires)
    data_sheet(folder, HOIST, HOIST_KNOWN)
    inertia, r, k, c, m, d, k_p, held = drawn(rng, HOIST, HOIST_KNOWN)

    def rope(x: Array) -> Array:
        """Force in the rope [N]."""
        return np.asarray(k * x[..., 1] + c * (r * x[..., 0] - x[..., 2]))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        w, _, v, _ = (float(s) for s in x)
        force = float(rope(x))
        return [
            (k_p * (float(u[0]) / r - w) + held - r * force) / inertia,
            r * w - v,
            (force - d * v - dry * np.tanh(v / 2e-3) + float(u[1])) / m - GRAVITY,
            v,
        ]

    for number, (name, stop) in enumerate((("first", 8.0), ("second", 6.6), ("third", 7.4))):
        aim = drawn_steps(rng, stop, 0.45, -0.24, 0.24, 4e-3)
        if name == "third":
            aim = swept(stop, -0.21, 0.21, 2.4, 0.8, 8e-3)
        hand = bursts(rng, stop, 0.5, 0.4, -40.0, 40.0, 4e-3)
        aim, hand = later(aim, 2e-3), later(hand, 2e-3)
        t, x = integrated(rates, (0.0, m * GRAVITY / k, 0.0, 0.0), (aim, hand), stop, 1e-3)
        sign = -1.0 if is_reversed and name == "second" else 1.0
        sensors = [
            Sensor("lift.drum", "n Trommel", "rpm", scaled(0, sign * RPM), 0.4, 4e-3, noise_stated, 0.1),
            Sensor("lift.beam", "Seilzug mm", "mm", scaled(3, 1e3), 0.5, 4e-3, noise_stated, 0.2),
            Sensor("lift.rope", "load cell", "N", lambda t, x, u: rope(x), 2.0, 4e-3, noise_stated, 0.5),
        ]
        programmes = {"lever.aim": (aim, "m/s"), "worker.hand": (hand, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def hoist_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=-12.0, empty=0.02), Logger("ms", zero=4200.0, jitter=0.2), Logger("s", gap=(3.1, 3.8)))
    _hoist(folder, rng, noise_stated=0.87, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.15 times too small, empty cells, jitter, a gap of 0.7 s, three "
        "loggers of s and ms",
        FINE,
    )


def hoist_rails(folder: Path, rng: Rng) -> Truth:
    dry = rng.uniform(9.0, 16.0)
    _hoist(folder, rng, dry=dry, loggers=(Logger("ms", zero=70.0), Logger("s")))
    return Truth(f"the rails rub with {dry:.2f} N, against the motion of the beam", PHYSICS, RUBBING)


def hoist_reversed(folder: Path, rng: Rng) -> Truth:
    _hoist(folder, rng, is_reversed=True, loggers=(Logger("s", zero=5.0), Logger("ms")))
    return Truth(
        "the tacho is the other way round in the second recording: the speed of the drum has the other sign",
        (*RECORDING, *SENSOR),
    )


# --- a suction cup that picks plies of cloth, ejector and hose, FMI 3 Co-Simulation; ms, %, kPa, N, L/min
CUP = OdeModel(
    "suction_cup",
    {
        "Q": (4e-4, "m^3/s"),
        "p_max": (7e4, "Pa"),
        "c_v": (6e-9, "m^3/s/Pa"),
        "G_h": (2e-8, "m^3/s/Pa"),
        "G_c": (6e-9, "m^3/s/Pa"),
        "V_l": (6e-5, "m^3"),
        "V_c": (1.5e-4, "m^3"),
        "S": (2.8e-3, "m^2"),
        "p_room": (1.01e5, "Pa"),
    },
    {"drive": "", "vent": ""},
    {
        "p_l": ("Pa", "0.0", "p_room*(Q*drive*(1.0 - p_l/p_max) - c_v*vent*p_l - G_h*(p_l - p_c))/V_l"),
        "p_c": ("Pa", "0.0", "p_room*(G_h*(p_l - p_c) - G_c*p_c)/V_c"),
    },
    {"line": ("Pa", "p_l"), "hold": ("N", "S*p_c"), "exhaust": ("m^3/s", "Q*drive*(1.0 - p_l/p_max)")},
    5e-4,
)
CUP_KNOWN = {"Q": 0.04, "p_max": 0.04, "c_v": 0.06, "G_h": 0.06, "G_c": 0.08, "V_l": 0.06, "V_c": 0.06, "S": 0.02}


def _cup(
    folder: Path,
    rng: Rng,
    pressed: float = np.inf,
    share: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """Vacuum may press the pores of the cloth together, it lets through G_c/(1 + p/pressed), pressed in kPa.

    The vacuum sensor may end, in the second recording, at what is exceeded for a `share` of the time.
    """
    build3(CUP, folder, has_exchange=False)
    names = (("valve_1", "drive"), ("valve_2", "vent"))
    parts = "".join(programme(c, (n, "'%'")).replace("0 '%'", "0 %") for c, n in names)
    parts += with_numbers("gripper", "suction_cup", "internal")
    wires = "".join(f"  - {c}.{n} -> gripper.{n}\n" for c, n in names)
    scenario(folder, "A suction cup on cloth", 8.0, 2.5e-3, 5e-3, parts, wires)
    data_sheet(folder, CUP, CUP_KNOWN)
    q, p_max, c_v, g_h, g_c, v_l, v_c, area, p_room = drawn(rng, CUP, CUP_KNOWN)

    def drawn_off(p: Array, drive: Array) -> Array:
        """What the ejector draws [mL/s], of a vacuum [kPa] and a drive [%]."""
        return np.asarray(1e6 * q * 0.01 * drive * (1.0 - 1e3 * p / p_max))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Both vacua are in kPa, flows in mL/s."""
        line, cup = (float(s) for s in x)
        hose = 1e9 * g_h * (line - cup)
        through = 1e9 * g_c * cup / (1.0 + max(cup, 0.0) / pressed)
        out = float(drawn_off(x[0], u[0])) - 1e9 * c_v * 0.01 * float(u[1]) * line
        return [1e-9 * p_room * (out - hose) / v_l, 1e-9 * p_room * (hose - through) / v_c]

    for number, (name, stop) in enumerate((("first", 8.0), ("second", 6.5), ("third", 7.2))):
        drive = drawn_steps(rng, stop, 0.32, 6.0, 100.0, 5e-3)
        if name == "third":
            drive = stairs(rng, stop, 0.28, 10.0, 95.0, 5, 5e-3)
        vent = bursts(rng, stop, 0.7, 0.35, 20.0, 100.0, 5e-3)
        drive, vent = later(drive, 2.5e-3), later(vent, 2.5e-3)
        t, x = integrated(rates, (0.0, 0.0), (drive, vent), stop, 1.25e-3)
        end = float(f"{np.quantile(x[:, 0], 1.0 - share):.1f}") if share and name == "second" else np.inf

        def spoil(column: str, t: Array, v: Array, end: float = end) -> Array:
            return np.minimum(v, end) if column == "VAC kPa" else v

        sensors = [
            Sensor("gripper.line", "VAC kPa", "kPa", scaled(0, 1.0), 0.15, 5e-3, noise_stated, 0.05, colour),
            Sensor("gripper.hold", "F Sauger", "N", scaled(1, 1e3 * area), 0.5, 5e-3, noise_stated, 0.1, colour),
            Sensor(
                "gripper.exhaust",
                "flow (L/min)",
                "L/min",
                lambda t, x, u: 0.06 * drawn_off(x[:, 0], u[:, 0]),
                0.2,
                5e-3,
                noise_stated,
                0.05,
                colour,
            ),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"valve_1.drive": (drive, "%"), "valve_2.vent": (vent, "%")},
            loggers[number % len(loggers)],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def cup_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=-640.0), Logger("s", zero=18.0, empty=0.03), Logger("min", zero=0.5))
    _cup(folder, rng, noise_stated=1.15, colour=0.4, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.4 and is stated 1.15 times too "
        "large, empty cells, three loggers of ms, s and min, Co-Simulation",
        FINE,
    )


def cup_porous(folder: Path, rng: Rng) -> Truth:
    pressed = rng.uniform(28.0, 50.0)
    _cup(folder, rng, pressed=pressed, loggers=(Logger("ms"), Logger("s", zero=-2.0)))
    return Truth(
        f"vacuum presses the pores of the cloth together: it lets through G_c/(1 + p/{pressed:.2f} kPa)",
        PHYSICS,
        (
            "nonlinear_conductance",
            "conductance_of_state",
            "state_dependent_conductance",
            "saturation",
            "saturating_gain",
        ),
    )


def cup_clipped(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.12, 0.2)
    _cup(folder, rng, share=share, loggers=(Logger("s", zero=1.0), Logger("ms"), Logger("s")))
    return Truth(
        f"the vacuum sensor ends at what {100 * share:.0f} % of the second recording exceed, which is not stated",
        SENSOR,
    )


# --- a conditioning cabinet for samples of cloth, FMI 2 Co-Simulation; min, W, g/min, L/min, degC; room is a column
CABINET = OdeModel(
    "cabinet",
    {
        "C_air": (2500.0, "J/K"),
        "C_wall": (12000.0, "J/K"),
        "h": (18.0, "W/K"),
        "U": (9.0, "W/K"),
        "m_air": (0.6, "kg"),
        "w_room": (0.008, "kg/kg"),
        "T_begin": (295.15, "K"),
        "w_begin": (0.008, "kg/kg"),
    },
    {"heater": "W", "mist": "kg/s", "purge": "m^3/s", "room": "K"},
    {
        "T": (
            "K",
            "T_begin",
            f"(heater - h*(T - T_w) - {DENSITY}*{AIR}*purge*(T - room) - {EVAPORATION}*mist)/C_air",
        ),
        "T_w": ("K", "T_begin", "(h*(T - T_w) - U*(T_w - room))/C_wall"),
        "w": ("kg/kg", "w_begin", f"(mist + {DENSITY}*purge*(w_room - w))/m_air"),
    },
    {"air": ("K", "T"), "wall": ("K", "T_w"), "moisture": ("kg/kg", "w")},
    1.0,
)
CABINET_KNOWN = {"C_air": 0.06, "C_wall": 0.05, "h": 0.06, "U": 0.06, "m_air": 0.05, "w_room": 0.03}


def _humidity(kelvin: float, moisture: float) -> float:
    """Relative humidity of air of a temperature [K] with a moisture [g/kg]."""
    warm = kelvin - CELSIUS
    saturated = 610.94 * np.exp(17.625 * warm / (warm + 243.04))
    return float(1.013e5 * moisture / (622.0 + moisture) / saturated)


def _cabinet(
    folder: Path,
    rng: Rng,
    samples: float = 0.0,
    gap: float = 0.0,
    dry: tuple[float, float] | None = None,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """Samples of `samples` g take up moisture, their regain is 0.16 of the humidity at last (700 s), with its heat.

    Through a gap in the door, `gap` g/s of air may come and go. Dry is begin and end [s] of a stretch of the second
    recording in which no mist comes.
    """
    CABINET.build(folder)
    names = (("rod", "heater", "W"), ("nozzle", "mist", "g/min"), ("blower", "purge", "L/min"), ("lab", "room", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("chamber", "cabinet", "internal")
    wires = "".join(f"  - {c}.{n} -> chamber.{n}\n" for c, n, _ in names)
    scenario(folder, "A conditioning cabinet", 14400.0, 5, 10, parts, wires)
    data_sheet(folder, CABINET, CABINET_KNOWN)
    c_air, c_wall, h, loss, m_air, w_room, t_begin, w_begin = drawn(rng, CABINET, CABINET_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Moisture is in g/kg, the samples' water in g."""
        air, wall, moisture, held = (float(s) for s in x)
        room = float(u[3]) + CELSIUS
        mist, through = float(u[1]) / 60.0, DENSITY * float(u[2]) / 60.0 + gap
        taken = (samples * 0.16 * _humidity(air, moisture) - held) / 700.0 if samples else 0.0
        heat = float(u[0]) - 1e-3 * AIR * through * (air - room) + 1e-3 * EVAPORATION * (taken - mist)
        return [
            (heat - h * (air - wall)) / c_air,
            (h * (air - wall) - loss * (wall - room)) / c_wall,
            (mist + 1e-3 * through * (1e3 * w_room - moisture) - taken) / m_air,
            taken,
        ]

    for number, (name, stop) in enumerate((("first", 14400.0), ("second", 12000.0), ("third", 13200.0))):
        heater = drawn_steps(rng, stop, 800.0, 150.0, 420.0, 10.0)
        if name == "third":
            heater = telegraph(rng, stop, 700.0, 170.0, 400.0, 10.0)
        mist = drawn_steps(rng, stop, 550.0, 0.1, 1.5, 10.0)
        purge = drawn_steps(rng, stop, 1300.0, 60.0, 180.0, 10.0)
        room = ramped(rng, stop, 2400.0, 20.0, 25.0, 60.0)
        blown = mist
        if dry is not None and name == "second":
            blown = between(mist, dry[0], dry[1], lambda v: 0.0 * v)
        wet = samples * 0.16 * _humidity(t_begin, 1e3 * w_begin)
        start = (t_begin, t_begin, 1e3 * w_begin, wet)
        t, x = integrated(rates, start, (heater, blown, purge, room), stop, 5.0)
        sensors = [
            Sensor("chamber.air", "Pt100 Luft", "degC", celsius(0), 0.12, 10.0, 1.0, 0.05),
            Sensor("chamber.wall", "Pt100 Wand", "degC", celsius(1), 0.12, 10.0, 1.0, 0.05),
            Sensor("chamber.moisture", "x g/kg", "g/kg", scaled(2, 1.0), 0.15, 10.0, 1.0, 0.02),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "rod.heater": (heater, "W"),
                "nozzle.mist": (blown, "g/min"),
                "blower.purge": (purge, "L/min"),
                "lab.room": (room, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["lab.room"],
            told={} if blown is mist else {"nozzle.mist": mist},
        )
        write(folder / name, rng, made)


def cabinet_samples(folder: Path, rng: Rng) -> Truth:
    samples = rng.uniform(90.0, 180.0)
    _cabinet(folder, rng, samples=samples, loggers=(Logger("min", zero=9.0), Logger("h")))
    return Truth(
        f"samples of {samples:.0f} g hang in the cabinet, which take up and give off moisture with its heat",
        PHYSICS,
        SORBING,
    )


def cabinet_two(folder: Path, rng: Rng) -> Truth:
    samples, gap = rng.uniform(90.0, 180.0), rng.uniform(0.35, 0.6)
    _cabinet(folder, rng, samples=samples, gap=gap, loggers=(Logger("h", zero=8.0), PLAIN))
    return Truth(
        f"samples of {samples:.0f} g hang in the cabinet, which take up and give off moisture with its heat, and "
        f"{gap:.3f} g/s of air come and go through a gap in the door",
        PHYSICS,
        (*SORBING, *LEAKING, "heat_exchange"),
    )


def cabinet_dry(folder: Path, rng: Rng) -> Truth:
    begin = 60.0 * round(rng.uniform(40.0, 140.0))
    _cabinet(folder, rng, dry=(begin, begin + 1800.0), loggers=(PLAIN, Logger("min", zero=-45.0), Logger("h")))
    return Truth(
        f"the nozzle's tank is empty, {begin:g} s to {begin + 1800.0:g} s of the second recording, and mist is said to "
        "come",
        SENSOR,
        ("input_fault",),
    )


# --- the wearer of a smart shirt on an ergometer, FMI 3, both interfaces, without units; W, L/min, 1/min, degC
WEARER = OdeModel(
    "wearer",
    {
        "o_rest": (0.3, ""),
        "k_o": (0.0115, ""),
        "tau_o": (35.0, ""),
        "h_rest": (68.0, ""),
        "k_h": (38.0, ""),
        "tau_h": (22.0, ""),
        "a": (270.0, ""),
        "g": (24.0, ""),
        "C": (2.4e5, ""),
        "T_begin": (36.8, ""),
    },
    {"power": "", "room": ""},
    {
        "o": ("", "o_rest", "(o_rest + k_o*power - o)/tau_o"),
        "h": ("", "h_rest", "(h_rest + k_h*(o - o_rest) - h)/tau_h"),
        "T": ("", "T_begin", "(a*o - g*(T - room))/C"),
    },
    {"uptake": ("", "o"), "heart": ("", "h"), "core": ("", "T")},
    1.0,
)
WEARER_KNOWN = {
    "o_rest": 0.05,
    "k_o": 0.04,
    "tau_o": 0.08,
    "h_rest": 0.03,
    "k_h": 0.06,
    "tau_h": 0.1,
    "a": 0.05,
    "g": 0.06,
    "C": 0.05,
}


def _wearer(
    folder: Path,
    rng: Rng,
    warm: float = 0.0,
    late: float = 0.0,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The heart may beat faster in a warm body, by `warm` (T - T_begin) 1/min.

    The clock of the chest strap may be late [s] in the second recording.
    """
    build3(WEARER, folder)
    parts = programme("ergometer", ("power", "")) + programme("lab", ("room", "")) + with_numbers("person", "wearer")
    wires = "  - ergometer.power -> person.power\n  - lab.room -> person.room\n"
    scenario(folder, "A wearer on an ergometer", 4500.0, 5, 5, parts, wires)
    data_sheet(folder, WEARER, WEARER_KNOWN)
    o_rest, k_o, tau_o, h_rest, k_h, tau_h, a, g, c, begin = drawn(rng, WEARER, WEARER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        uptake, heart, core = (float(s) for s in x)
        wanted = h_rest + k_h * (uptake - o_rest) + warm * (core - begin)
        return [
            (o_rest + k_o * float(u[0]) - uptake) / tau_o,
            (wanted - heart) / tau_h,
            (a * uptake - g * (core - float(u[1]))) / c,
        ]

    for number, (name, stop) in enumerate((("first", 4500.0), ("second", 3600.0), ("third", 4000.0))):
        power = drawn_steps(rng, stop, 170.0, 20.0, 190.0, 5.0)
        if name == "third":
            power = wandering(rng, stop, 130.0, 30.0, 180.0, 5.0)
        room = ramped(rng, stop, 900.0, 19.0, 25.0, 60.0)
        t, x = integrated(rates, (o_rest, h_rest, begin), (power, room), stop, 1.0)
        behind, beats = late if name == "second" else 0.0, x[:, 1]

        def strap(now: Array, x: Array, u: Array, t: Array = t, h: Array = beats, behind: float = behind) -> Array:
            return np.asarray(np.interp(now - behind, t, h))

        sensors = [
            Sensor("person.uptake", "VO2", "1", scaled(0, 1.0), 0.05, 5.0, noise_stated, 0.01, wild=wild),
            Sensor("person.heart", "HF Brustgurt", "1", strap, 1.8, 5.0, noise_stated, 1.0, wild=wild),
            Sensor("person.core", "pill degC", "1", scaled(2, 1.0), 0.03, 20.0, noise_stated, 0.01, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"ergometer.power": (power, ""), "lab.room": (room, "")},
            loggers[number % len(loggers)],
            recorded=["lab.room"],
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "battery V", lambda n: np.asarray(3.9 + 0.01 * rng.standard_normal(n)))


def wearer_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=15.0), Logger("s", zero=-120.0, gap=(1500.0, 1710.0)), Logger("h", zero=10.25))
    _wearer(folder, rng, noise_stated=1.2, wild=0.008, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, no units, wild readings, noise stated 1.2 times too large, two rates, a "
        "column that nothing names, a gap of 3.5 min, three loggers of min, s and h",
        FINE,
    )


def wearer_warm(folder: Path, rng: Rng) -> Truth:
    warm = rng.uniform(11.0, 18.0)
    _wearer(folder, rng, warm=warm, loggers=(Logger("s", zero=30.0), Logger("min")))
    return Truth(f"the heart beats faster in a warm body, by {warm:.2f} (T - T_begin) 1/min", PHYSICS)


def wearer_clock(folder: Path, rng: Rng) -> Truth:
    late = 5.0 * round(rng.uniform(6.0, 10.0))
    _wearer(folder, rng, late=late, loggers=(Logger("min"), PLAIN, Logger("min", zero=2.0)))
    return Truth(f"the clock of the chest strap is {late:g} s late in the second recording", (*RECORDING, *SENSOR))


# --- blower (FMI 2, Model Exchange) and heater (FMI 3, Co-Simulation) of a hot-air seam sealer; V, A, W, rpm, degC
BLOWER = OdeModel(
    "blower",
    {
        "k": (0.02, "V*s/rad"),
        "R": (1.0, "ohm"),
        "J": (2e-4, "kg*m^2"),
        "c_f": (1e-6, "kg/rad"),
        "k_q": (0.06, "N*m*s^2/kg/rad"),
    },
    {"volts": "V", "warm": "K"},
    {"w": ("rad/s", "0.0", "(k*(volts - k*w)/R - k_q*c_f*w*w*sqrt(296.15/fmax(warm, 250.0)))/J")},
    {
        "speed": ("rad/s", "w"),
        "amperes": ("A", "(volts - k*w)/R"),
        "flow": ("kg/s", "c_f*w*sqrt(296.15/fmax(warm, 250.0))"),
    },
    0.01,
)
HEATER = OdeModel(
    "air_heater",
    {
        "C_e": (60.0, "J/K"),
        "C_n": (45.0, "J/K"),
        "g": (2.2, "W/K"),
        "U": (0.3, "W/K"),
        "T_begin": (296.15, "K"),
    },
    {"power": "W", "flow": "kg/s", "room": "K"},
    {
        "T_e": ("K", "T_begin", "(power - g*sqrt(fmax(flow, 1e-5)/1e-3)*(T_e - T_n))/C_e"),
        "T_n": (
            "K",
            "T_begin",
            f"(g*sqrt(fmax(flow, 1e-5)/1e-3)*(T_e - T_n) - ({AIR}*flow + U)*(T_n - room))/C_n",
        ),
    },
    {"element": ("K", "T_e"), "nozzle": ("K", "T_n")},
    0.05,
)
BLOWER_KNOWN = {"k": 0.02, "R": 0.05, "J": 0.06, "c_f": 0.03, "k_q": 0.06}
HEATER_KNOWN = {"C_e": 0.06, "C_n": 0.06, "g": 0.06, "U": 0.08}


def _sealer(
    folder: Path,
    rng: Rng,
    emitted: float = 0.0,
    dry: float = 0.0,
    is_exchanged: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; the element may radiate, emitted (T_e^4 - room^4) [W/K^4]; bearings may rub with `dry` N m.

    The thermocouples of element and nozzle may be exchanged in the second recording.
    """
    BLOWER.build(folder)
    build3(HEATER, folder, has_exchange=False)
    data_sheet(folder, HEATER, HEATER_KNOWN)
    (folder / "numbers.yaml").rename(folder / "heater.yaml")
    data_sheet(folder, BLOWER, BLOWER_KNOWN)
    parts = (
        programme("speed_dial", ("volts", "V"))
        + programme("heat_dial", ("power", "W"))
        + programme("shop", ("room", "degC"))
        + with_numbers("fan", "blower")
        + with_numbers("coil", "air_heater", "internal").replace("numbers.yaml", "heater.yaml")
    )
    wires = (
        "  - speed_dial.volts -> fan.volts\n  - heat_dial.power -> coil.power\n  - shop.room -> coil.room\n"
        "  - fan.flow -> coil.flow\n  - coil.nozzle -> fan.warm\n"
    )
    scenario(folder, "A hot-air seam sealer", 240.0, 0.1, 0.2, parts, wires)
    k, r, inertia, c_f, k_q = drawn(rng, BLOWER, BLOWER_KNOWN)
    c_e, c_n, g, loss, begin = drawn(rng, HEATER, HEATER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        w, element, nozzle = (float(s) for s in x)
        room = float(u[2]) + CELSIUS
        flow = c_f * w * np.sqrt(296.15 / nozzle)
        passed = g * np.sqrt(max(flow, 1e-5) / 1e-3) * (element - nozzle)
        shone = emitted * (element**4 - room**4)
        return [
            (k * (float(u[0]) - k * w) / r - k_q * w * flow - dry * np.tanh(w / 5.0)) / inertia,
            (float(u[1]) - passed - shone) / c_e,
            (passed - (AIR * flow + loss) * (nozzle - room)) / c_n,
        ]

    for number, (name, stop) in enumerate((("first", 240.0), ("second", 200.0), ("third", 220.0))):
        volts = drawn_steps(rng, stop, 14.0, 9.0, 24.0, 0.2)
        if name == "third":
            volts = stairs(rng, stop, 12.0, 9.5, 23.5, 4, 0.2)
        power = drawn_steps(rng, stop, 30.0, 60.0, 560.0, 0.2)
        volts, power = later(volts, 0.1), later(power, 0.1)
        room = ramped(rng, stop, 60.0, 21.0, 25.0, 2.0)
        t, x = integrated(rates, (0.0, begin, begin), (volts, power, room), stop, 0.05)
        one, two = (2, 1) if is_exchanged and name == "second" else (1, 2)
        sensors = [
            Sensor("fan.speed", "n rpm", "rpm", scaled(0, RPM), 25.0, 0.2, noise_stated, 10.0),
            Sensor(
                "fan.amperes",
                "shunt A",
                "A",
                lambda t, x, u: (u[:, 0] - k * x[:, 0]) / r,
                0.03,
                0.2,
                noise_stated,
                0.01,
            ),
            Sensor("coil.element", "TC 1 (Wendel)", "degC", celsius(one), 1.2, 0.4, noise_stated, 0.5),
            Sensor("coil.nozzle", "TC 2 (Duese)", "degC", celsius(two), 0.8, 0.4, noise_stated, 0.5),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"speed_dial.volts": (volts, "V"), "heat_dial.power": (power, "W"), "shop.room": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["shop.room"],
        )
        write(folder / name, rng, made)


def sealer_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("s", zero=300.0, is_comma=True),
        Logger("ms", zero=-1500.0, is_comma=True, gap=(81.0, 95.0)),
        Logger("min", is_comma=True, empty=0.02),
    )
    _sealer(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, noise is not stated, two rates, decimal commas, a gap of 14 s, "
        "empty cells, three loggers of s, ms and min",
        FINE,
    )


def sealer_radiation(folder: Path, rng: Rng) -> Truth:
    emitted = rng.uniform(2.4e-10, 3.6e-10)
    _sealer(folder, rng, emitted=emitted, loggers=(PLAIN, Logger("min", zero=1.0)))
    return Truth(f"the element radiates {emitted:.3e} W/K^4 (T_e^4 - room^4)", PHYSICS, RADIATING)


def sealer_two(folder: Path, rng: Rng) -> Truth:
    emitted, dry = rng.uniform(2.4e-10, 3.6e-10), rng.uniform(5e-3, 9e-3)
    _sealer(folder, rng, emitted=emitted, dry=dry, loggers=(Logger("ms"), Logger("s", zero=-6.0)))
    return Truth(
        f"the element radiates {emitted:.3e} W/K^4 (T_e^4 - room^4), and the blower's bearings rub with "
        f"{1e3 * dry:.2f} mN m",
        PHYSICS,
        (*RADIATING, *RUBBING),
    )


def sealer_exchanged(folder: Path, rng: Rng) -> Truth:
    _sealer(folder, rng, is_exchanged=True, loggers=(Logger("min", zero=7.0), PLAIN))
    return Truth("the thermocouples of element and nozzle are exchanged in the second recording", (*RECORDING, *SENSOR))


# --- a soft squid that jets, on a spring in a flume, FMI 3 Model Exchange; ms, kPa, mL, mm, m/s; the flume is a column
SQUID = OdeModel(
    "squid",
    {
        "E": (3e7, "Pa/m^3"),
        "I": (3e5, "Pa*s^2/m^3"),
        "b": (5e10, "Pa*s^2/m^6"),
        "A": (1e-4, "m^2"),
        "rho": (998.0, "kg/m^3"),
        "V_rest": (2.4e-4, "m^3"),
        "m": (0.9, "kg"),
        "c": (6.0, "N*s^2/m^2"),
        "d": (0.5, "N*s/m"),
        "k": (5.0, "N/m"),
    },
    {"squeeze": "Pa", "flow": "m/s"},
    {
        "V": ("m^3", "V_rest", "-Q"),
        "Q": ("m^3/s", "0.0", "(E*(V - V_rest) + squeeze - b*Q*fabs(Q))/I"),
        "x": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(rho*fmax(Q, 0.0)*fmax(Q, 0.0)/A - c*(v + flow)*fabs(v + flow) - d*v - k*x)/m"),
    },
    {"pressure": ("Pa", "E*(V - V_rest) + squeeze"), "mantle": ("m^3", "V"), "way": ("m", "x")},
    1e-3,
)
SQUID_KNOWN = {"E": 0.05, "I": 0.06, "b": 0.08, "A": 0.03, "V_rest": 0.01, "m": 0.04, "c": 0.08, "d": 0.1, "k": 0.03}


def _squid(
    folder: Path,
    rng: Rng,
    inward: float = 1.0,
    stuck: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """Water may come in more easily than it goes out, through flaps besides the siphon, inward b Q^2.

    Stuck is begin and end [s] of a stretch of the first recording in which the pressure's reading does not change.
    """
    build3(SQUID, folder, has_co_simulation=False)
    parts = programme("tendon", ("squeeze", "kPa")) + programme("flume", ("flow", "m/s"))
    parts += with_numbers("robot", "squid")
    wires = "  - tendon.squeeze -> robot.squeeze\n  - flume.flow -> robot.flow\n"
    scenario(folder, "A soft squid in a flume", 36.0, 0.01, 0.02, parts, wires)
    data_sheet(folder, SQUID, SQUID_KNOWN)
    e, inertance, b, area, rho, rest, m, c, d, k = drawn(rng, SQUID, SQUID_KNOWN)

    def pressure(x: Array, squeeze: Array) -> Array:
        """In the mantle [kPa]."""
        return np.asarray(1e-9 * e * (x[..., 0] - 1e6 * rest) + squeeze)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Volume is in mL, flow in mL/s, way in m."""
        _, out, way, v = (float(s) for s in x)
        lost = 1e-15 * b * out * abs(out) * (inward if out < 0.0 else 1.0)
        past = v + float(u[1])
        thrust = 1e-12 * rho * max(out, 0.0) ** 2 / area
        return [
            -out,
            1e9 * (float(pressure(x, u[0])) - lost) / inertance,
            v,
            (thrust - c * past * abs(past) - d * v - k * way) / m,
        ]

    for number, (name, stop) in enumerate((("first", 36.0), ("second", 30.0), ("third", 33.0))):
        squeeze = bursts(rng, stop, 0.9, 0.8, 0.8, 3.6, 0.02)
        if name == "third":
            squeeze = swept(stop, 0.0, 3.4, 4.5, 1.4, 0.04)
        squeeze = later(squeeze, 0.01)
        flow = ramped(rng, stop, 6.0, 0.0, 0.25, 0.1)
        t, x = integrated(rates, (1e6 * rest, 0.0, 0.0, 0.0), (squeeze, flow), stop, 5e-3)
        held = stuck if stuck is not None and name == "first" else (np.inf, np.inf)

        def spoil(column: str, t: Array, v: Array, held: tuple[float, float] = held) -> Array:
            if column != "p Mantel" or held[0] == np.inf:
                return v
            kept = v[np.searchsorted(t, held[0])]
            return np.where((t >= held[0]) & (t < held[1]), kept, v)

        sensors = [
            Sensor(
                "robot.pressure",
                "p Mantel",
                "kPa",
                lambda t, x, u: pressure(x, u[:, 0]),
                0.03,
                0.02,
                noise_stated,
                0.01,
            ),
            Sensor("robot.mantle", "cam mL", "mL", scaled(0, 1.0), 1.2, 0.02, noise_stated, 0.5),
            Sensor("robot.way", "laser mm", "mm", scaled(2, 1e3), 0.5, 0.02, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"tendon.squeeze": (squeeze, "kPa"), "flume.flow": (flow, "m/s")},
            loggers[number % len(loggers)],
            recorded=["flume.flow"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def squid_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("ms", zero=2.2e5, gap=(14.0, 16.4)),
        Logger("min", zero=-1.0),
        Logger("s", zero=0.25, jitter=0.15),
    )
    _squid(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, a gap of 2.4 s, jitter, three loggers of ms, min and s",
        FINE,
    )


def squid_flaps(folder: Path, rng: Rng) -> Truth:
    inward = rng.uniform(0.25, 0.45)
    _squid(folder, rng, inward=inward, loggers=(Logger("s", zero=3.0), Logger("ms")))
    return Truth(
        f"water comes in more easily than it goes out, through flaps besides the siphon: {inward:.3f} b Q^2 inwards",
        PHYSICS,
    )


def squid_stuck(folder: Path, rng: Rng) -> Truth:
    begin = float(round(rng.uniform(6.0, 20.0)))
    _squid(folder, rng, stuck=(begin, begin + 9.0), loggers=(Logger("ms", zero=-40.0), Logger("s")))
    return Truth(
        f"the reading of the mantle's pressure is stuck, {begin:g} s to {begin + 9.0:g} s of the first recording",
        SENSOR,
    )


# --- a blanket of light-guiding fibres and its LEDs, FMI 2 Model Exchange; mA, V, W/m^2, degC; room is a column
BLANKET = OdeModel(
    "light_blanket",
    {
        "E": (17.0, "V"),
        "R": (2.5, "ohm"),
        "k_v": (0.012, "V/K"),
        "eta": (6.0, "W/A"),
        "S": (0.06, "m^2"),
        "G": (1.2, "W/K"),
        "C_j": (6.0, "J/K"),
        "h": (0.35, "W/K"),
        "C_h": (90.0, "J/K"),
        "a": (0.5, ""),
        "h_c": (0.4, "W/K"),
        "C_c": (60.0, "J/K"),
        "T_begin": (297.15, "K"),
    },
    {"current": "A", "room": "K"},
    {
        "T_j": (
            "K",
            "T_begin",
            "((E + R*current - k_v*(T_j - 298.15) - eta)*current - G*(T_j - T_h))/C_j",
        ),
        "T_h": ("K", "T_begin", "(G*(T_j - T_h) - h*(T_h - room))/C_h"),
        "T_c": ("K", "T_begin", "(a*eta*current - h_c*(T_c - room))/C_c"),
    },
    {
        "volts": ("V", "E + R*current - k_v*(T_j - 298.15)"),
        "light": ("W/m^2", "eta*current/S"),
        "sink": ("K", "T_h"),
        "cloth": ("K", "T_c"),
    },
    0.1,
)
BLANKET_KNOWN = {
    "E": 0.01,
    "R": 0.05,
    "k_v": 0.08,
    "eta": 0.04,
    "G": 0.06,
    "C_j": 0.08,
    "h": 0.06,
    "C_h": 0.05,
    "a": 0.05,
    "h_c": 0.06,
    "C_c": 0.06,
}


def _blanket(
    folder: Path,
    rng: Rng,
    droop: float = np.inf,
    is_other: bool = False,
    quantum: float = 0.02,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The larger the current, the less light it may make, eta/(1 + current/droop), droop in A.

    For the second recording, the current of another run may be told.
    """
    BLANKET.build(folder)
    parts = programme("supply", ("current", "mA")) + programme("ward", ("room", "degC"))
    parts += with_numbers("blanket", "light_blanket")
    wires = "  - supply.current -> blanket.current\n  - ward.room -> blanket.room\n"
    scenario(folder, "A light blanket", 3600.0, 1.5, 3, parts, wires)
    data_sheet(folder, BLANKET, BLANKET_KNOWN)
    e, r, k_v, eta, area, g, c_j, h, c_h, a, h_c, c_c, begin = drawn(rng, BLANKET, BLANKET_KNOWN)

    def volts(x: Array, u: Array) -> Array:
        return np.asarray(e + 1e-3 * r * u[..., 0] - k_v * (x[..., 0] - 298.15))

    def light(u: Array) -> Array:
        """Of the LEDs [W]."""
        return np.asarray(1e-3 * eta * u[..., 0] / (1.0 + 1e-3 * u[..., 0] / droop))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        chip, sink, cloth = (float(s) for s in x)
        room, shone = float(u[1]) + CELSIUS, float(light(u))
        return [
            (1e-3 * float(volts(x, u)) * float(u[0]) - shone - g * (chip - sink)) / c_j,
            (g * (chip - sink) - h * (sink - room)) / c_h,
            (a * shone - h_c * (cloth - room)) / c_c,
        ]

    other = later(drawn_steps(rng, 3000.0, 100.0, 80.0, 1000.0, 3.0), 1.5)
    for number, (name, stop) in enumerate((("first", 3600.0), ("second", 3000.0), ("third", 3300.0))):
        current = drawn_steps(rng, stop, 100.0, 80.0, 1000.0, 3.0)
        if name == "third":
            current = telegraph(rng, stop, 90.0, 120.0, 960.0, 3.0)
        current = later(current, 1.5)
        room = ramped(rng, stop, 600.0, 22.0, 27.0, 15.0)
        t, x = integrated(rates, (begin, begin, begin), (current, room), stop, 0.75)
        sensors = [
            Sensor("blanket.volts", "U LED", "V", lambda t, x, u: volts(x, u), 0.02, 3.0, 1.0, quantum),
            Sensor("blanket.light", "radiometer", "W/m^2", lambda t, x, u: light(u) / area, 0.8, 3.0, 1.0, 0.5),
            Sensor("blanket.sink", "NTC Kuehler", "degC", celsius(1), 0.15, 3.0, 1.0, 0.1),
            Sensor("blanket.cloth", "IR cloth", "degC", celsius(2), 0.15, 3.0, 1.0, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"supply.current": (current, "mA"), "ward.room": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["ward.room"],
            told={"supply.current": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)


def blanket_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=60.0, jitter=0.1), Logger("s", zero=3e4, empty=0.03), Logger("h", zero=-0.5))
    _blanket(folder, rng, quantum=0.1, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, a coarse reading of the voltage, jitter, empty cells, "
        "three loggers of min, s and h",
        FINE,
    )


def blanket_droop(folder: Path, rng: Rng) -> Truth:
    droop = rng.uniform(2.2, 3.6)
    _blanket(folder, rng, droop=droop, loggers=(Logger("s", zero=-20.0), Logger("min")))
    return Truth(
        f"the larger the current, the less light it makes: eta/(1 + current/{droop:.3f} A)",
        PHYSICS,
        ("saturation", "saturating_gain", "nonlinear_rate"),
    )


def blanket_other_run(folder: Path, rng: Rng) -> Truth:
    _blanket(folder, rng, is_other=True, loggers=(Logger("min"), Logger("s", zero=11.0)))
    return Truth("the second recording is said to have had the current of another run", (*RECORDING, *SENSOR))


# --- a cabinet in which ozone fades denim, FMI 2 Co-Simulation; min, g/h, L/min, g/m^3, %, degC a column; two rates
OZONE = OdeModel(
    "ozone_cabinet",
    {
        "V": (0.8, "m^3"),
        "k_d": (1.5e-3, "1/s"),
        "b": (0.05, "1/K"),
        "k_c": (2e-3, "1/s"),
        "k_z": (0.12, "m^3/kg/s"),
        "z_begin": (0.95, ""),
    },
    {"made": "kg/s", "purge": "m^3/s", "warmth": "K"},
    {
        "c": ("kg/m^3", "0.0", "(made - purge*c)/V - k_d*exp(b*(warmth - 298.15))*c - k_c*z*c"),
        "z": ("", "z_begin", "-k_z*c*z"),
    },
    {"ozone": ("kg/m^3", "c"), "indigo": ("", "z")},
    2.0,
)
OZONE_KNOWN = {"V": 0.03, "k_d": 0.08, "b": 0.1, "k_c": 0.08, "k_z": 0.06}


def _ozone(
    folder: Path,
    rng: Rng,
    second: float = 0.0,
    unit: float = 1.0,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """Ozone may decay with its square besides, second c^2 [m^3/kg/s].

    What the analyser of the second recording shows may be in another `unit` [its reading for 1 g/m^3]. `strayed` is by
    how much the indigo at each begin is off (deviation), which is stated.
    """
    OZONE.build(folder)
    names = (("generator", "made", "g/h"), ("blower", "purge", "L/min"), ("shop", "warmth", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("drum", "ozone_cabinet", "internal")
    wires = "".join(f"  - {c}.{n} -> drum.{n}\n" for c, n, _ in names)
    scenario(folder, "An ozone cabinet for denim", 10800.0, 5, 10, parts, wires)
    data_sheet(folder, OZONE, OZONE_KNOWN)
    volume, k_d, b, k_c, k_z, usual = drawn(rng, OZONE, OZONE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Ozone is in g/m^3."""
        c, z = (float(s) for s in x)
        gone = k_d * np.exp(b * (float(u[2]) + CELSIUS - 298.15)) + k_c * z + 1e-3 * second * c
        return [(float(u[0]) / 3600.0 - float(u[1]) / 6e4 * c) / volume - gone * c, -1e-3 * k_z * c * z]

    for number, (name, stop) in enumerate((("first", 10800.0), ("second", 9000.0), ("third", 9900.0))):
        made_up = drawn_steps(rng, stop, 500.0, 1.0, 40.0, 10.0)
        if name == "third":
            made_up = stairs(rng, stop, 450.0, 3.0, 38.0, 4, 10.0)
        purge = drawn_steps(rng, stop, 900.0, 30.0, 180.0, 10.0)
        warmth = ramped(rng, stop, 1800.0, 20.0, 34.0, 30.0)
        said = float(f"{usual + rng.uniform(-0.1, 0.03):.3g}") if strayed else usual
        t, x = integrated(rates, (0.0, said + strayed * float(rng.normal())), (made_up, purge, warmth), stop, 5.0)
        factor = unit if name == "second" else 1.0
        sensors = [
            Sensor("drum.ozone", "O3 analyser", "g/m^3", scaled(0, factor), 0.025, 10.0, noise_stated, 0.01),
            Sensor("drum.indigo", "K/S %", "%", scaled(1, 100.0), 0.5, 60.0, noise_stated, 0.1),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"drum": {"parameters": {"z_begin": f"{said:.6g}"}}}
            sidecar["uncertain"] = {"drum.z_begin": f"{strayed:g}"}
        made = Written(
            t,
            x,
            sensors,
            {
                "generator.made": (made_up, "g/h"),
                "blower.purge": (purge, "L/min"),
                "shop.warmth": (warmth, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["shop.warmth"],
            sidecar=sidecar,
        )
        write(folder / name, rng, made)


def ozone_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=400.0), Logger("h", zero=-0.1, gap=(3600.0, 4500.0)), Logger("s", zero=7200.0))
    _ozone(folder, rng, strayed=0.02, noise_stated=0.88, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, the indigo at the begin is stated and off by 0.02 (deviation), which is "
        "stated too, noise stated 1.14 times too small, two rates, a gap of 15 min, three loggers of min, h and s, "
        "Co-Simulation",
        FINE,
    )


def ozone_square(folder: Path, rng: Rng) -> Truth:
    second = rng.uniform(0.8, 1.4)
    _ozone(folder, rng, second=second, loggers=(Logger("h", zero=2.0), Logger("min")))
    return Truth(
        f"ozone decays with its square besides, {second:.3f} m^3/kg/s c^2",
        PHYSICS,
        ("reaction_order", "nonlinear_rate", "rate_of_state", "state_dependent_rate"),
    )


def ozone_unit(folder: Path, rng: Rng) -> Truth:
    _ozone(folder, rng, unit=0.51, loggers=(PLAIN, Logger("min", zero=-8.0)))
    return Truth(
        "the ozone of the second recording is in per mille of the volume, said to be in g/m^3", (*RECORDING, *SENSOR)
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    hoist_rails,
    cup_null,
    cabinet_dry,
    wearer_warm,
    sealer_null,
    squid_stuck,
    blanket_droop,
    ozone_null,
    hoist_null,
    cup_clipped,
    cabinet_samples,
    wearer_null,
    sealer_exchanged,
    squid_flaps,
    blanket_null,
    ozone_unit,
    hoist_reversed,
    cup_porous,
    cabinet_two,
    wearer_clock,
    sealer_radiation,
    squid_null,
    blanket_other_run,
    ozone_square,
    sealer_two,
)
