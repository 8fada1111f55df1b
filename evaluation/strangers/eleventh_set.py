"""Eleventh set: a jamming gripper, a heat pipe, a borehole, a lamp, a clutch, a laser, a fuel cell, a platform.

Written without a look at the library of laws, its proof, its tests or its thresholds, and without a diagnosis of any of
its cases; of what was reported on the earlier sets, the author had read nothing but the title of the last commits.
Truths are integrated by scipy from equations that stand here. How large an effect is, and how far the numbers are off,
is drawn; the deviations of the numbers are those that a parameter set states. Recordings of a rig differ in length and
in logger; the one that is held out was partly made with a programme of another kind.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.eighth_set import second_clock
from evaluation.strangers.fifth_set import FOUR, FOUR_SPLIT, integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, fahrenheit, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

Spoil = Callable[[str, Array, Array], Array]
#: Revolutions per minute in a radian per second; degrees in a radian.
RPM, DEGREES = 30.0 / np.pi, 180.0 / np.pi
#: Laws that are true where something rubs.
RUBBING = ("dry_friction", "coulomb_friction", "stribeck_friction")
#: Laws that are true where a flow is lost in proportion.
LEAKING = ("leak", "leakage", "linear_leak", "linear_loss", "heat_loss", "loss")


def telegraph(rng: Rng, stop: float, dwell: float, low: float, high: float, grid: float) -> Steps:
    """To and fro between two levels, each a little different every time, after random times."""
    times, t = [0.0], 0.0
    while (t := t + grid * max(1, round(rng.exponential(dwell) / grid + 0.3 * dwell / grid))) < stop - dwell / 4:
        times.append(t)
    ends = [(low, high)[i % 2] + 0.08 * (high - low) * (-1) ** i * rng.uniform(0.0, 1.0) for i in range(len(times))]
    return Steps(tuple(times), tuple(float(f"{v:.3g}") for v in ends))


def ramps(stop: float, low: float, high: float, period: float, hold: float) -> Steps:
    """A triangle from low to high and back, as a generator holds it for `hold` s each."""
    t = hold * np.arange(round(stop / hold))
    levels = low + (high - low) * (1.0 - np.abs(1.0 - 2.0 * ((t / period) % 1.0)))
    return Steps(tuple(float(v) for v in np.round(t, 9)), tuple(float(f"{v:.3g}") for v in levels))


# --- a gripper of grains in a membrane that is evacuated, pressed on by a ram, FMI 2 Model Exchange; kPa, mm, %
GRIPPER = OdeModel(
    "gripper",
    {
        "C_bag": (4e-9, "m^3/Pa"),
        "G_pump": (1.2e-8, "m^3/(s*Pa)"),
        "G_vent": (2.2e-8, "m^3/(s*Pa)"),
        "p_end": (8e4, "Pa"),
        "m": (0.4, "kg"),
        "d": (14.0, "N*s/m"),
        "k_soft": (420.0, "N/m"),
        "k_jam": (0.026, "N/(m*Pa)"),
    },
    {"duty": "", "vent": "", "force": "N"},
    {
        "p": ("Pa", "0.0", "(G_pump*duty*(p_end - p) - G_vent*vent*p)/C_bag"),
        "x": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(force - (k_soft + k_jam*p)*x - d*v)/m"),
    },
    {"vacuum": ("Pa", "p"), "dent": ("m", "x")},
    1e-3,
)
GRIPPER_KNOWN = {"C_bag": 0.05, "G_pump": 0.05, "G_vent": 0.06, "m": 0.03, "d": 0.08, "k_soft": 0.04, "k_jam": 0.05}


def _gripper(
    folder: Path,
    rng: Rng,
    leak: float = 0.0,
    rub: float = 0.0,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The membrane may leak, m^3/(s Pa) of vacuum; jammed grains may rub with `rub` [m^2] times the vacuum."""
    GRIPPER.build(folder)
    parts = programme("valves", ("duty", "'%'"), ("vent", "'%'")).replace("0 '%'", "0 %")
    parts += programme("ram", ("force", "N"))
    wires = "".join(f"  - {n} -> bag.{n.partition('.')[2]}\n" for n in ("valves.duty", "valves.vent", "ram.force"))
    scenario(folder, "A jamming gripper", 36.0, 0.02, 0.02, parts + with_numbers("bag", "gripper"), wires)
    data_sheet(folder, GRIPPER, GRIPPER_KNOWN)
    c_bag, g_pump, g_vent, p_end, m, d, k_soft, k_jam = drawn(rng, GRIPPER, GRIPPER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Vacuum is in kPa, the dent in mm, forces in mN."""
        p, s, v = (float(w) for w in x)
        flow = g_pump * 0.01 * float(u[0]) * (1e-3 * p_end - p) - (g_vent * 0.01 * float(u[1]) + leak) * p
        rubbing = 1e6 * rub * p * np.tanh(v / 3.0)
        return [flow / c_bag, v, (1e3 * float(u[2]) - (k_soft + 1e3 * k_jam * p) * s - d * v - rubbing) / m]

    for number, (name, stop) in enumerate((("first", 36.0), ("second", 28.0), ("third", 32.0))):
        duty = drawn_steps(rng, stop, 2.6, 0.0, 100.0, 0.02)
        for i in range(1, len(duty.levels), 3):
            duty = between(duty, duty.times[i], (*duty.times, stop)[i + 1], lambda v: 0.0)
        vent = bursts(rng, stop, 3.5, 0.8, 20.0, 100.0, 0.02)
        if name == "third":
            force = telegraph(rng, stop, 0.9, 3.0, 17.0, 0.02)
        else:
            force = drawn_steps(rng, stop, 1.1, 1.0, 20.0, 0.02)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (duty, vent, force), stop, 0.01)
        sensors = [
            Sensor("bag.vacuum", "p_vac (kPa)", "kPa", scaled(0, 1.0), 0.5, 0.04, noise_stated, 0.1, wild=wild),
            Sensor("bag.dent", "ram_pos", "mm", scaled(1, 1.0), 0.1, 0.02, noise_stated, 0.02, wild=wild),
        ]
        programmes = {"valves.duty": (duty, "%"), "valves.vent": (vent, "%"), "ram.force": (force, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def gripper_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=7320.0), Logger("s", zero=-1.5, jitter=0.3))
    _gripper(folder, rng, noise_stated=0.78, wild=0.01, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.28 times too small, wild readings, two rates, jitter, clocks "
        "from 7320 ms and -1.5 s",
        FINE,
    )


def gripper_leak(folder: Path, rng: Rng) -> Truth:
    leak = rng.uniform(3.5e-10, 6e-10)
    _gripper(folder, rng, leak=leak, loggers=(PLAIN, Logger("ms", zero=250.0)))
    return Truth(f"the membrane leaks {leak:.2e} m^3/(s Pa) of its vacuum", PHYSICS, LEAKING)


def gripper_two(folder: Path, rng: Rng) -> Truth:
    leak, rub = rng.uniform(3.5e-10, 6e-10), rng.uniform(1.2e-5, 2e-5)
    _gripper(folder, rng, leak=leak, rub=rub, loggers=(Logger("s", zero=66.0), PLAIN))
    return Truth(
        f"the membrane leaks {leak:.2e} m^3/(s Pa) of its vacuum, and grains rub with {rub:.2e} m^2 times the vacuum",
        PHYSICS,
        (*LEAKING, *RUBBING, "load_dependent_friction", "pressure_dependent_friction"),
    )


# --- a heat pipe between a heater and a water jacket, FMI 3, both interfaces; degC and degF, W, min; power is a column
PIPE = OdeModel(
    "pipe",
    {
        "C_e": (46.0, "J/K"),
        "C_c": (38.0, "J/K"),
        "G": (3.2, "W/K"),
        "U_water": (1.7, "W/K"),
        "U_room": (0.12, "W/K"),
        "T_room": (294.65, "K"),
        "T_begin": (294.65, "K"),
    },
    {"power": "W", "water": "K"},
    {
        "T_e": ("K", "T_begin", "(power - G*(T_e - T_c) - U_room*(T_e - T_room))/C_e"),
        "T_c": ("K", "T_begin", "(G*(T_e - T_c) - U_water*(T_c - water))/C_c"),
    },
    {"evaporator": ("K", "T_e"), "condenser": ("K", "T_c")},
    0.2,
)
PIPE_KNOWN = {"C_e": 0.05, "C_c": 0.05, "G": 0.06, "U_water": 0.05, "U_room": 0.15}


def _pipe(
    folder: Path,
    rng: Rng,
    dry: tuple[float, float] | None = None,
    is_wrong: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """The wick may dry out above a flow of heat [W], past which the pipe carries a share of G.

    The thermometer of the condenser shows degF; the sidecar of the first recording may say degC.
    """
    build3(PIPE, folder)
    parts = programme("bench", ("power", "W"), ("water", "degC")) + with_numbers("pipe", "pipe")
    wires = "  - bench.power -> pipe.power\n  - bench.water -> pipe.water\n"
    scenario(folder, "A heat pipe", 2400.0, 2, 4, parts, wires)
    data_sheet(folder, PIPE, PIPE_KNOWN)
    c_e, c_c, g, u_water, u_room, room, begin = drawn(rng, PIPE, PIPE_KNOWN)
    limit, left = dry or (np.inf, 1.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        warm, cool = (float(s) for s in x)
        carried = g * (warm - cool)
        carried = limit + left * (carried - limit) if carried > limit else carried
        return [
            (float(u[0]) - carried - u_room * (warm - room)) / c_e,
            (carried - u_water * (cool - float(u[1]) - CELSIUS)) / c_c,
        ]

    for number, (name, stop) in enumerate((("first", 2400.0), ("second", 3200.0), ("third", 2000.0))):
        power = drawn_steps(rng, stop, 130.0, 0.0, 62.0, 4.0)
        water = drawn_steps(rng, stop, 420.0, 12.0, 26.0, 4.0)
        if name == "third":
            power = ramps(stop, 4.0, 60.0, 500.0, 20.0)
        t, x = integrated(rates, (begin, begin), (power, water), stop, 1.0)
        said = "degC" if is_wrong and name == "first" else "degF"
        sensors = [
            Sensor("pipe.evaporator", "TC1", "degC", celsius(0), 0.25, 4.0, noise_stated, 0.1, colour),
            Sensor("pipe.condenser", "Fluke", said, fahrenheit(1), 0.4, 4.0, noise_stated, 0.1, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"bench.power": (power, "W"), "bench.water": (water, "degC")},
            loggers[number % len(loggers)],
            recorded=["bench.power"],
        )
        write(folder / name, rng, made)


def pipe_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=120.0, is_comma=True), Logger("min", is_comma=True, empty=0.015))
    _pipe(folder, rng, noise_stated=1.2, colour=0.75, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.75 and is stated 1.2 times too "
        "large, decimal commas, degF beside degC, empty cells",
        FINE,
    )


def pipe_dryout(folder: Path, rng: Rng) -> Truth:
    limit, left = rng.uniform(24.0, 31.0), rng.uniform(0.35, 0.5)
    _pipe(folder, rng, dry=(limit, left), loggers=(Logger("min", zero=3.0), Logger("s")))
    return Truth(
        f"the wick dries out above {limit:.2f} W, past which the pipe carries {left:.3f} times as much for a kelvin",
        PHYSICS,
        ("saturation", "saturating_flow", "saturating_gain", "dead_zone", "threshold", "dry_out", "michaelis_menten"),
    )


def pipe_fahrenheit(folder: Path, rng: Rng) -> Truth:
    _pipe(folder, rng, is_wrong=True, loggers=(Logger("min"), Logger("s", zero=15.0)))
    return Truth("the condenser is logged in degF and stated as degC, in the first recording", (*RECORDING, *SENSOR))


# --- a response test of a borehole with a buffer outdoors, FMI 3 Co-Simulation; degC, kW, L/min, h; a day at 2 min
BOREHOLE = OdeModel(
    "borehole",
    {
        "c": (4.17e6, "J/(m^3*K)"),
        "C_tank": (5e5, "J/K"),
        "C_loop": (9e5, "J/K"),
        "C_ground": (1.4e7, "J/K"),
        "U_tank": (5.0, "W/K"),
        "G_grout": (650.0, "W/K"),
        "G_far": (340.0, "W/K"),
        "T_far": (284.35, "K"),
        "T_begin": (286.15, "K"),
    },
    {"power": "W", "flow": "m^3/s", "outdoor": "K"},
    {
        "T_w": ("K", "T_begin", "(power - c*flow*(T_w - T_f) - U_tank*(T_w - outdoor))/C_tank"),
        "T_f": ("K", "T_begin", "(c*flow*(T_w - T_f) - G_grout*(T_f - T_g))/C_loop"),
        "T_g": ("K", "T_far", "(G_grout*(T_f - T_g) - G_far*(T_g - T_far))/C_ground"),
    },
    {"supply": ("K", "T_w"), "back": ("K", "T_f")},
    10.0,
)
BOREHOLE_KNOWN = {"C_tank": 0.03, "C_loop": 0.06, "C_ground": 0.1, "U_tank": 0.1, "G_grout": 0.06, "G_far": 0.08}


def _borehole(
    folder: Path,
    rng: Rng,
    pipes: float = 0.0,
    is_other: bool = False,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Pipes from tank to borehole may lose `pipes` W/K outdoors.

    `strayed` is by how much [K] the start of each recording is off (deviation), which is stated. The second recording
    may have the column of power of another run.
    """
    build3(BOREHOLE, folder, has_exchange=False)
    parts = (
        programme("heater", ("power", "kW"))
        + programme("pump", ("flow", "L/min"))
        + programme("weather", ("outdoor", "degC"))
        + with_numbers("hole", "borehole", "internal")
    )
    names = ("heater.power", "pump.flow", "weather.outdoor")
    wires = "".join(f"  - {n} -> hole.{n.partition('.')[2]}\n" for n in names)
    scenario(folder, "A thermal response test", 86400.0, 60, 120, parts, wires)
    data_sheet(folder, BOREHOLE, BOREHOLE_KNOWN)
    numbers = drawn(rng, BOREHOLE, BOREHOLE_KNOWN)
    c, c_tank, c_loop, c_ground, u_tank, g_grout, g_far, far, usual = numbers

    def rates(t: float, x: Array, u: Array) -> list[float]:
        tank, loop, ground = (float(s) for s in x)
        carried, outdoor = c * float(u[1]) / 6e4 * (tank - loop), float(u[2]) + CELSIUS
        inward = g_grout * (loop - ground)
        return [
            (1e3 * float(u[0]) - carried - u_tank * (tank - outdoor)) / c_tank,
            (carried - inward - pipes * (loop - outdoor)) / c_loop,
            (inward - g_far * (ground - far)) / c_ground,
        ]

    other = drawn_steps(rng, 72000.0, 7200.0, 0.0, 6.5, 120.0)
    for number, (name, stop) in enumerate((("first", 86400.0), ("second", 72000.0), ("third", 64800.0))):
        if name == "third":
            power = telegraph(rng, stop, 7200.0, 0.0, 6.0, 120.0)
        else:
            power = drawn_steps(rng, stop, 7200.0, 0.0, 6.5, 120.0)
        flow = drawn_steps(rng, stop, 14400.0, 9.0, 21.0, 120.0)
        outdoor = drawn_steps(rng, stop, 5400.0, -9.0, 9.0, 120.0)
        said = float(f"{rng.uniform(284.0, 291.0):.1f}") if strayed else usual
        begin = said + strayed * float(rng.normal())
        t, x = integrated(rates, (begin, begin, far), (power, flow, outdoor), stop, 60.0)
        sensors = [
            Sensor("hole.supply", "T_VL", "degC", celsius(0), 0.07, 120.0, noise_stated, 0.01),
            Sensor("hole.back", "T_RL", "degC", celsius(1), 0.06, 120.0, noise_stated, 0.01),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"hole": {"parameters": {"T_begin": f"{said:.1f} K"}}}
            sidecar["uncertain"] = {"hole.T_begin": f"{strayed:g} K"}
        made = Written(
            t,
            x,
            sensors,
            {"heater.power": (power, "kW"), "pump.flow": (flow, "L/min"), "weather.outdoor": (outdoor, "degC")},
            loggers[number % len(loggers)],
            recorded=["heater.power", "weather.outdoor"],
            sidecar=sidecar,
            told={"heater.power": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)


def borehole_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=13.5, empty=0.06), Logger("min", zero=-60.0))
    _borehole(folder, rng, strayed=1.2, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, a start of each recording is stated that is off by 1.2 K (deviation), which "
        "is stated too; empty cells, hours from 13.5, minutes from -60",
        FINE,
    )


def borehole_pipes(folder: Path, rng: Rng) -> Truth:
    pipes = rng.uniform(28.0, 45.0)
    _borehole(folder, rng, pipes=pipes, loggers=(Logger("h", zero=6.0), Logger("h")))
    return Truth(
        f"pipes between tank and borehole lose {pipes:.1f} W/K to the air outdoors",
        PHYSICS,
        (*LEAKING, "loss_to_ambient", "heat_exchange", "plate_loss"),
    )


def borehole_other_run(folder: Path, rng: Rng) -> Truth:
    _borehole(folder, rng, is_other=True, loggers=(Logger("min"), Logger("h", zero=0.5)))
    return Truth("the second recording has the heater's power of another run", (*RECORDING, *SENSOR))


# --- a quartz lamp in a housing (FMI 2, Model Exchange) over carbon cloth (FMI 3, Co-Simulation); degC, W; two clocks
LAMP = OdeModel(
    "lamp",
    {
        "C_wire": (1.0, "J/K"),
        "a": (9.4e-12, "W/K^4"),
        "stray": (0.15, ""),
        "view": (0.45, ""),
        "C_case": (110.0, "J/K"),
        "U_case": (1.0, "W/K"),
        "T_begin": (295.15, "K"),
    },
    {"power": "W", "gain": "W", "air": "K"},
    {
        "T_l": ("K", "T_begin", "(power - a*(pow(T_l, 4) - pow(T_h, 4)))/C_wire"),
        "T_h": ("K", "T_begin", "(stray*a*(pow(T_l, 4) - pow(T_h, 4)) - U_case*(T_h - air) + gain)/C_case"),
    },
    {"radiant": ("W", "view*a*(pow(T_l, 4) - pow(T_h, 4))"), "housing": ("K", "T_h")},
    0.02,
)
SWATCH = OdeModel(
    "swatch",
    {"C_cloth": (20.0, "J/K"), "h": (0.1, "W/K"), "U_gap": (0.12, "W/K"), "T_begin": (295.15, "K")},
    {"radiant": "W", "housing": "K", "air": "K"},
    {"T_s": ("K", "T_begin", "(radiant + U_gap*(housing - T_s) - h*(T_s - air))/C_cloth")},
    {"temperature": ("K", "T_s"), "back": ("W", "U_gap*(T_s - housing)")},
    0.02,
)
LAMP_KNOWN = {"C_wire": 0.06, "stray": 0.05, "view": 0.03, "C_case": 0.04, "U_case": 0.06}
SWATCH_KNOWN = {"C_cloth": 0.04, "h": 0.06, "U_gap": 0.06}


def _swatch(
    folder: Path,
    rng: Rng,
    radiation: float = 0.0,
    stronger: tuple[float, float, float] | None = None,
    noise_stated: float | None = 1.0,
    clock: tuple[str, float] | None = None,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; the cloth may radiate itself, `radiation` [W/K^4] (T^4 - T_air^4).

    Stronger is begin [s], end [s] and factor of the lamp's power in the first recording.
    """
    LAMP.build(folder)
    build3(SWATCH, folder, has_exchange=False)
    data_sheet(folder, SWATCH, SWATCH_KNOWN)
    (folder / "numbers.yaml").rename(folder / "cloth.yaml")
    data_sheet(folder, LAMP, LAMP_KNOWN)
    parts = (
        programme("dimmer", ("power", "W"))
        + programme("hood", ("air", "degC"))
        + with_numbers("lamp", "lamp")
        + with_numbers("swatch", "swatch", "internal").replace("numbers.yaml", "cloth.yaml")
    )
    wires = (
        "  - dimmer.power -> lamp.power\n  - hood.air -> lamp.air\n  - hood.air -> swatch.air\n"
        "  - lamp.radiant -> swatch.radiant\n  - lamp.housing -> swatch.housing\n  - swatch.back -> lamp.gain\n"
    )
    scenario(folder, "A lamp over carbon cloth", 420.0, 0.1, 0.5, parts, wires)
    c_wire, a, stray, view, c_case, u_case, begin = drawn(rng, LAMP, LAMP_KNOWN)
    c_cloth, h, u_gap, _ = drawn(rng, SWATCH, SWATCH_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        wire, case, cloth = (float(s) for s in x)
        air = float(u[1]) + CELSIUS
        light, across = a * (wire**4 - case**4), u_gap * (case - cloth)
        return [
            (float(u[0]) - light) / c_wire,
            (stray * light - u_case * (case - air) - across) / c_case,
            (view * light + across - h * (cloth - air) - radiation * (cloth**4 - air**4)) / c_cloth,
        ]

    for number, (name, stop) in enumerate((("first", 420.0), ("second", 540.0), ("third", 360.0))):
        if name == "third":
            stated = ramps(stop, 10.0, 150.0, 120.0, 5.0)
        else:
            stated = drawn_steps(rng, stop, 35.0, 0.0, 160.0, 0.5)
        power = stated
        if stronger is not None and name == "first":
            power = between(stated, stronger[0], stronger[1], lambda v: stronger[2] * v)
        air = Steps((0.0,), (float(f"{rng.uniform(20.5, 24.0):.1f}"),))
        t, x = integrated(rates, (begin, begin, begin), (power, air), stop, 0.25)
        sensors = [
            Sensor("swatch.temperature", "IR-Kamera ROI1", "degC", celsius(2), 0.4, 0.5, noise_stated, 0.1),
            Sensor("lamp.housing", "Pt1000", "degC", celsius(1), 0.15, 2.0, noise_stated, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"dimmer.power": (power, "W"), "hood.air": (air, "degC")},
            loggers[number % len(loggers)],
            told={} if power is stated else {"dimmer.power": stated},
        )
        write(folder / name, rng, made)
        if clock is not None:
            second_clock(folder / name, clock[0], clock[1] + 90.0 * number)


def swatch_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=8.0, empty=0.02), Logger("ms", zero=-300.0), Logger("s"))
    _swatch(folder, rng, noise_stated=1.3, clock=("min", 720.0), loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, noise stated 1.3 times too large, empty cells, the housing's table "
        "is of a logger with another rate and a clock of its own, in minutes from 720",
        FINE,
    )


def swatch_radiation(folder: Path, rng: Rng) -> Truth:
    radiation = rng.uniform(3e-10, 4.5e-10)
    _swatch(folder, rng, radiation=radiation, loggers=(PLAIN, Logger("min", zero=1.0)))
    return Truth(f"the cloth radiates {radiation:.3e} W/K^4 (T^4 - T_air^4)", PHYSICS, ("radiation",))


def swatch_lamp(folder: Path, rng: Rng) -> Truth:
    begin, factor = 10.0 * round(rng.uniform(8.0, 20.0)), rng.uniform(1.13, 1.22)
    _swatch(folder, rng, stronger=(begin, begin + 120.0, factor), loggers=(Logger("s", zero=33.0), PLAIN))
    return Truth(
        f"the lamp was given {factor:.3f} times the power that is stated, {begin:g} s to {begin + 120.0:g} s of the "
        "first recording",
        SENSOR,
        ("input_fault",),
    )


# --- an electroadhesive clutch between two sheets that a spring holds, FMI 2 Model Exchange; V, mm, ms
CLUTCH = OdeModel(
    "clutch",
    {
        "R": (1e6, "ohm"),
        "C": (8e-9, "F"),
        "m": (0.15, "kg"),
        "d": (2.5, "N*s/m"),
        "k": (900.0, "N/m"),
        "grip": (8e-5, "N/V^2"),
        "v_slip": (0.03, "m/s"),
    },
    {"u": "V", "pull": "N"},
    {
        "V": ("V", "0.0", "(u - V)/(R*C)"),
        "x": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(pull - k*x - d*v - grip*V*V*tanh(v/v_slip))/m"),
    },
    {"voltage": ("V", "V"), "slide": ("m", "x")},
    1e-4,
)
CLUTCH_KNOWN = {"R": 0.02, "C": 0.06, "m": 0.02, "d": 0.1, "k": 0.03, "grip": 0.06, "v_slip": 0.05}


def _clutch(
    folder: Path,
    rng: Rng,
    held: tuple[float, float] | None = None,
    share: float = 0.0,
    noise_stated: float | None = 1.0,
    quantum: float = 0.01,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The dielectric may hold charge: it lags the voltage with a time [s], and a share of it counts as voltage.

    The laser may have a smaller range in the second recording: it ends at what is exceeded for a `share` of the time.
    """
    CLUTCH.build(folder)
    parts = programme("amplifier", ("u", "V")) + programme("shaker", ("pull", "N")) + with_numbers("clutch", "clutch")
    wires = "  - amplifier.u -> clutch.u\n  - shaker.pull -> clutch.pull\n"
    scenario(folder, "An electroadhesive clutch", 1.2, 1e-3, 1e-3, parts, wires)
    data_sheet(folder, CLUTCH, CLUTCH_KNOWN)
    r, c, m, d, k, grip, v_slip = drawn(rng, CLUTCH, CLUTCH_KNOWN)
    tau, left = held or (1.0, 0.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Slide is in mm, forces in mN; the last state is the voltage that the dielectric holds."""
        volts, s, v, kept = (float(w) for w in x)
        gripping = 1e3 * grip * (volts + left * kept) ** 2 * np.tanh(1e-3 * v / v_slip)
        return [
            (float(u[0]) - volts) / (r * c),
            v,
            (1e3 * float(u[1]) - k * s - d * v - gripping) / m,
            (volts - kept) / tau,
        ]

    for number, (name, stop) in enumerate((("first", 1.2), ("second", 1.6), ("third", 1.0))):
        if name == "third":
            u = telegraph(rng, stop, 0.07, -260.0, 260.0, 1e-3)
        else:
            u = drawn_steps(rng, stop, 0.11, -300.0, 300.0, 1e-3)
        pull = drawn_steps(rng, stop, 0.06, 0.0, 12.0, 1e-3)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (u, pull), stop, 5e-4)
        limit = float(f"{np.quantile(x[:, 1], 1.0 - share):.1f}") if share and name == "second" else np.inf

        def spoil(column: str, t: Array, v: Array, limit: float = limit) -> Array:
            return np.minimum(v, limit) if column == "opto_mm" else v

        sensors = [
            Sensor("clutch.voltage", "HV mon", "V", scaled(0, 1.0), 2.0, 1e-3, noise_stated, 0.5),
            Sensor("clutch.slide", "opto_mm", "mm", scaled(1, 1.0), 0.06, 1e-3, noise_stated, quantum),
        ]
        programmes = {"amplifier.u": (u, "V"), "shaker.pull": (pull, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)], spoil=spoil))


def clutch_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=100.0, jitter=0.2), Logger("s", zero=0.25), Logger("ms"))
    _clutch(folder, rng, noise_stated=None, quantum=0.2, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, a coarse converter of the laser, jitter, two units of "
        "time",
        FINE,
    )


def clutch_charge(folder: Path, rng: Rng) -> Truth:
    tau, left = rng.uniform(0.12, 0.25), rng.uniform(0.16, 0.26)
    _clutch(folder, rng, held=(tau, left), loggers=(Logger("ms"), Logger("ms", zero=40.0)))
    return Truth(
        f"the dielectric holds charge: {left:.3f} times what lags the voltage by {1e3 * tau:.0f} ms grips with it",
        PHYSICS,
        ("hidden_state", "dielectric_absorption", "polarisation", "residual_charge", "relaxation"),
    )


def clutch_saturated(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.12, 0.22)
    _clutch(folder, rng, share=share, loggers=(Logger("s"), Logger("ms")))
    return Truth(
        f"the laser of the second recording ends at what {100 * share:.0f} % of its course exceed, which is not stated",
        SENSOR,
    )


# --- inversion and light of a pumped laser of class B, FMI 3 Model Exchange, without units; ms; four runs
LASER = OdeModel(
    "laser",
    {
        "tau_f": (4e-3, ""),
        "tau_c": (2e-5, ""),
        "slope": (1.2, ""),
        "beta": (5e-4, ""),
        "eta": (2.0, ""),
        "side": (1.5, ""),
    },
    {"current": ""},
    {
        "n": ("", "1.0", "(slope*current - n*(1.0 + s))/tau_f"),
        "s": ("", "0.8", "((n - 1.0)*s + beta*n)/tau_c"),
    },
    {"light": ("", "eta*s"), "glow": ("", "side*n")},
    2e-6,
)
LASER_KNOWN = {"tau_f": 0.04, "tau_c": 0.05, "slope": 0.03, "eta": 0.04, "side": 0.03}


def _laser(
    folder: Path,
    rng: Rng,
    absorber: tuple[float, float] | None = None,
    dimmed: tuple[float, float, float] | None = None,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The cavity may absorb more where there is little light, q/(1 + s/s_a).

    Dimmed is begin [s], end [s] and gain of the photodiode in the second recording.
    """
    build3(LASER, folder, has_co_simulation=False)
    parts = programme("driver", ("current", "")) + with_numbers("laser", "laser")
    scenario(folder, "A pumped laser", 0.12, 1e-4, 1e-4, parts, "  - driver.current -> laser.current\n")
    data_sheet(folder, LASER, LASER_KNOWN)
    tau_f, tau_c, slope, beta, eta, side = drawn(rng, LASER, LASER_KNOWN)
    q, knee = absorber or (0.0, 1.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        n, s = (float(w) for w in x)
        gain = n - 1.0 - q / (1.0 + s / knee)
        return [(slope * float(u[0]) - n * (1.0 + s)) / tau_f, (gain * s + beta * n) / tau_c]

    for number, (name, stop) in enumerate(zip(FOUR, (0.12, 0.15, 0.1, 0.12))):
        if name == "fourth":
            current = telegraph(rng, stop, 5e-3, 1.5, 2.3, 1e-4)
        else:
            current = drawn_steps(rng, stop, 6e-3, 1.3, 2.5, 1e-4)
        t, x = integrated(rates, (1.0, 0.8), (current,), stop, 2e-5)

        def photodiode(t: Array, x: Array, u: Array, name: str = name) -> Array:
            gain = np.full(len(t), eta)
            if dimmed is not None and name == "second":
                gain[(t >= dimmed[0]) & (t < dimmed[1])] *= dimmed[2]
            return np.asarray(gain * x[:, 1])

        sensors = [
            Sensor("laser.light", "PD1", "1", photodiode, 0.04, 1e-4, noise_stated, 0.005, colour),
            Sensor("laser.glow", "PD2 side", "1", scaled(0, side), 0.004, 1e-4, noise_stated, 1e-3, colour),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"driver.current": (current, "")}, loggers[number % 2]))


def laser_null(folder: Path, rng: Rng) -> Truth:
    _laser(folder, rng, noise_stated=None, colour=0.5, loggers=(Logger("ms", zero=20.0, empty=0.01), Logger("ms")))
    return Truth(
        "nothing; numbers off as stated, no units, noise is not stated and that of neighbouring readings correlates by "
        "0.5, empty cells",
        FINE,
        **FOUR_SPLIT,
    )


def laser_absorber(folder: Path, rng: Rng) -> Truth:
    q, knee = rng.uniform(0.016, 0.022), rng.uniform(0.7, 1.2)
    _laser(folder, rng, absorber=(q, knee), loggers=(Logger("ms"), Logger("s", zero=1.0)))
    return Truth(
        f"something in the cavity absorbs and bleaches: a loss of {q:.4f}/(1 + s/{knee:.3f})",
        PHYSICS,
        ("saturable_absorber", "saturable_absorption", "saturating_loss", "saturation", "michaelis_menten"),
        **FOUR_SPLIT,
    )


def laser_filter(folder: Path, rng: Rng) -> Truth:
    begin, gain = 1e-3 * round(rng.uniform(25.0, 75.0)), rng.uniform(0.76, 0.86)
    _laser(folder, rng, dimmed=(begin, begin + 0.05, gain), loggers=(Logger("ms"), Logger("ms", zero=-5.0)))
    return Truth(
        f"the photodiode shows {gain:.3f} times the light, {1e3 * begin:g} ms to {1e3 * begin + 50.0:g} ms of the "
        "second recording",
        SENSOR,
        **FOUR_SPLIT,
    )


# --- a stack of ten fuel cells with its fan, FMI 2 Co-Simulation; V, A, degC, %
STACK = OdeModel(
    "stack",
    {
        "E_0": (9.4, "V"),
        "R_m": (0.11, "ohm"),
        "R_a": (0.12, "ohm"),
        "tau_a": (4.0, "s"),
        "R_h": (0.05, "ohm"),
        "tau_h": (35.0, "s"),
        "E_heat": (14.8, "V"),
        "C_heat": (850.0, "J/K"),
        "h_still": (0.9, "W/K"),
        "h_fan": (3.0, "W/K"),
        "T_air": (296.15, "K"),
        "T_begin": (301.15, "K"),
    },
    {"current": "A", "fan": ""},
    {
        "v_a": ("V", "0.0", "(R_a*current - v_a)/tau_a"),
        "v_h": ("V", "0.0", "(R_h*current - v_h)/tau_h"),
        "T": (
            "K",
            "T_begin",
            "(current*(E_heat - E_0 + v_a + v_h + R_m*current) - (h_still + h_fan*fan)*(T - T_air))/C_heat",
        ),
    },
    {"voltage": ("V", "E_0 - v_a - v_h - R_m*current"), "temperature": ("K", "T")},
    0.1,
)
STACK_KNOWN = {
    "E_0": 0.01,
    "R_m": 0.05,
    "R_a": 0.06,
    "tau_a": 0.08,
    "R_h": 0.08,
    "tau_h": 0.1,
    "C_heat": 0.05,
    "h_still": 0.08,
    "h_fan": 0.06,
}


def _stack(
    folder: Path,
    rng: Rng,
    starving: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Gas may run short at the electrodes: a loss of -B ln(1 - i/i_limit), B [V] and limit [A].

    The load switches between two readings.
    """
    STACK.build(folder)
    parts = programme("load", ("current", "A")) + programme("blower", ("fan", "'%'")).replace("0 '%'", "0 %")
    wires = "  - load.current -> stack.current\n  - blower.fan -> stack.fan\n"
    scenario(folder, "A fuel cell", 900.0, 0.5, 1, parts + with_numbers("stack", "stack", "internal"), wires)
    data_sheet(folder, STACK, STACK_KNOWN)
    numbers = drawn(rng, STACK, STACK_KNOWN)
    e_0, r_m, r_a, tau_a, r_h, tau_h, e_heat, c_heat, still, blown, air, begin = numbers
    b, limit = starving or (0.0, 100.0)

    def volts(x: Array, current: Array) -> Array:
        return np.asarray(e_0 - x[..., 0] - x[..., 1] - r_m * current + b * np.log1p(-current / limit))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        current, cooling = float(u[0]), still + blown * 0.01 * float(u[1])
        heating = current * (e_heat - float(volts(x, u[0])))
        return [
            (r_a * current - x[0]) / tau_a,
            (r_h * current - x[1]) / tau_h,
            (heating - cooling * (x[2] - air)) / c_heat,
        ]

    for number, (name, stop) in enumerate((("first", 900.0), ("second", 1100.0), ("third", 800.0))):
        if name == "third":
            current = ramps(stop, 0.5, 13.5, 160.0, 8.0)
        else:
            current = drawn_steps(rng, stop, 24.0, 0.0, 14.0, 1.0)
        current = Steps((0.0, *(t + 0.5 for t in current.times[1:])), current.levels)
        fan = drawn_steps(rng, stop, 150.0, 0.0, 100.0, 1.0)
        t, x = integrated(rates, (0.0, 0.0, begin), (current, fan), stop, 0.5)
        sensors = [
            Sensor("stack.voltage", "U_stack", "V", lambda t, x, u: volts(x, u[:, 0]), 0.02, 1.0, noise_stated, 0.005),
            Sensor("stack.temperature", "T_plate", "degC", celsius(2), 0.15, 1.0, noise_stated, 0.0625),
        ]
        programmes = {"load.current": (current, "A"), "blower.fan": (fan, "%")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def stack_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=15.0), Logger("s", gap=(410.0, 520.0)), Logger("s", zero=-12.0, empty=0.02))
    _stack(folder, rng, noise_stated=1.5, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.5 times too large, a gap of 110 s, empty cells, three loggers, "
        "Co-Simulation",
        FINE,
    )


def stack_starving(folder: Path, rng: Rng) -> Truth:
    b, limit = rng.uniform(0.2, 0.32), rng.uniform(14.6, 15.6)
    _stack(folder, rng, starving=(b, limit), loggers=(PLAIN, Logger("s", zero=240.0)))
    return Truth(
        f"gas runs short at the electrodes: the stack loses -{b:.3f} V ln(1 - i/{limit:.2f} A) more",
        PHYSICS,
        ("concentration_loss", "concentration_overvoltage", "limiting_current", "mass_transport_loss"),
    )


def stack_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(0.018, 0.032)
    _stack(folder, rng, loggers=(PLAIN, Logger("s", rate=1.0 + fast), Logger("min")))
    return Truth(f"the logger's clock runs {100 * fast:.2f} % fast in the second recording", RECORDING)


# --- a platform on an air bearing, turned by a reaction wheel, FMI 2 Model Exchange; rpm, deg/s, deg, V; two rates
PLATFORM = OdeModel(
    "platform",
    {
        "J_p": (0.9, "kg*m^2"),
        "J_w": (8e-4, "kg*m^2"),
        "R": (2.4, "ohm"),
        "k_t": (0.03, "N*m/A"),
        "b": (1.5e-5, "N*m*s/rad"),
        "c": (0.02, "N*m*s/rad"),
        "rate_begin": (0.0, "rad/s"),
    },
    {"u": "V"},
    {
        "w": ("rad/s", "0.0", "(k_t*(u - k_t*w)/R - b*w)/J_w + (k_t*(u - k_t*w)/R - b*w + c*rate)/J_p"),
        "rate": ("rad/s", "rate_begin", "-(k_t*(u - k_t*w)/R - b*w + c*rate)/J_p"),
        "phi": ("rad", "0.0", "rate"),
    },
    {"wheel": ("rad/s", "w"), "gyro": ("rad/s", "rate"), "heading": ("rad", "phi")},
    2e-3,
)
PLATFORM_KNOWN = {"J_p": 0.04, "J_w": 0.04, "R": 0.03, "k_t": 0.03, "b": 0.15, "c": 0.1}


def _platform(
    folder: Path,
    rng: Rng,
    dry: float = 0.0,
    swirl: float = 0.0,
    turning: float = 0.0,
    is_reversed: bool = False,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The wheel may rub with `dry` N m; air that leaves the bearing may turn the platform with `swirl` N m.

    The platform may turn already at the begin of the second recording [deg/s]. The gyroscope may be upside down in the
    first.
    """
    PLATFORM.build(folder)
    parts = programme("bus", ("u", "V")) + with_numbers("platform", "platform")
    scenario(folder, "A platform with a reaction wheel", 50.0, 0.05, 0.05, parts, "  - bus.u -> platform.u\n")
    data_sheet(folder, PLATFORM, PLATFORM_KNOWN)
    j_p, j_w, r, k_t, b, c, _ = drawn(rng, PLATFORM, PLATFORM_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Speed of the wheel is relative to the platform."""
        w, rate = float(x[0]), float(x[1])
        torque = k_t * (float(u[0]) - k_t * w) / r - b * w - dry * np.tanh(w / 1.5)
        turn = (swirl - torque - c * rate) / j_p
        return [torque / j_w - turn, turn, rate]

    for number, (name, stop) in enumerate((("first", 50.0), ("second", 70.0), ("third", 45.0))):
        u = drawn_steps(rng, stop, 2.4, -12.0, 12.0, 0.05)
        if name == "third":
            u = ramps(stop, -10.0, 10.0, 11.0, 0.25)
        begin = turning / DEGREES if name == "second" else 0.0
        t, x = integrated(rates, (0.0, begin, 0.0), (u,), stop, 0.025)
        sign = -1.0 if is_reversed and name == "first" else 1.0
        sensors = [
            Sensor("platform.wheel", "RW speed [rpm]", "rpm", scaled(0, RPM), 10.0, 0.05, 1.0, 1.0),
            Sensor("platform.gyro", "gyro_z", "deg/s", scaled(1, sign * DEGREES), 0.25, 0.05, 1.0, 0.02),
            Sensor("platform.heading", "yaw_mocap", "deg", scaled(2, DEGREES), 0.5, 0.25, 1.0, 0.01),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"bus.u": (u, "V")}, loggers[number % len(loggers)]))


def platform_friction(folder: Path, rng: Rng) -> Truth:
    dry = rng.uniform(4e-3, 7e-3)
    _platform(folder, rng, dry=dry, loggers=(Logger("s", zero=900.0), Logger("ms")))
    return Truth(f"the bearings of the wheel rub with {1e3 * dry:.2f} mN m", PHYSICS, RUBBING)


def platform_two(folder: Path, rng: Rng) -> Truth:
    dry, swirl = rng.uniform(4e-3, 7e-3), float(rng.choice([-1.0, 1.0])) * rng.uniform(5e-4, 9e-4)
    _platform(folder, rng, dry=dry, swirl=swirl, loggers=(PLAIN, Logger("s", zero=-3.0)))
    return Truth(
        f"the bearings of the wheel rub with {1e3 * dry:.2f} mN m, and air that leaves the bearing of the platform "
        f"turns it with {1e3 * swirl:.2f} mN m",
        PHYSICS,
        (*RUBBING, "steady_inflow", "steady_torque", "constant_torque", "steady_force", "constant_force"),
    )


def platform_start(folder: Path, rng: Rng) -> Truth:
    turning = float(rng.choice([-1.0, 1.0])) * rng.uniform(4.0, 8.0)
    _platform(folder, rng, turning=turning, loggers=(Logger("ms", zero=60.0), PLAIN))
    return Truth(
        f"the platform turns with {turning:.2f} deg/s at the begin of the second recording and is said to rest",
        (*RECORDING, *SENSOR),
    )


def platform_sign(folder: Path, rng: Rng) -> Truth:
    _platform(folder, rng, is_reversed=True, loggers=(PLAIN, Logger("min")))
    return Truth("the gyroscope is mounted upside down in the first recording", (*RECORDING, *SENSOR))


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    gripper_leak,
    pipe_null,
    borehole_other_run,
    swatch_radiation,
    clutch_saturated,
    laser_null,
    stack_starving,
    platform_sign,
    gripper_null,
    pipe_dryout,
    borehole_null,
    swatch_lamp,
    clutch_charge,
    laser_filter,
    stack_null,
    platform_friction,
    gripper_two,
    pipe_fahrenheit,
    borehole_pipes,
    swatch_null,
    clutch_null,
    laser_absorber,
    stack_clock,
    platform_two,
    platform_start,
)
