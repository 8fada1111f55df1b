"""Fifth set: four tanks, a harvester, a buoy, a pan, a classroom, a filter, a muscle, a solar loop, coils, a brake.

Written without a look at the library of laws, its proof, its tests or what the earlier sets had shown. Truths are
integrated by scipy from equations that stand here. How large an effect is, and how far the numbers are off, is drawn;
the deviations of the numbers are those that a parameter set states, or the 5 % of a rig that states none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.first_set import FOLDERS, MINUTES, PLAIN, Rng, fmu, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import COIL_C, COIL_G, COILS_PARAMETERS, between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.truth import FINE, OPEN, PHYSICS, RECORDING, SENSOR, Truth

Rates = Callable[[float, Array, Array], Sequence[float] | Array]
#: Recordings of a rig that was measured four times.
FOUR = (*FOLDERS, "fourth")
#: Heat of a kilogram of water [J/(kg*K)]; Stefan-Boltzmann constant [W/(m^2*K^4)]; gravity [m/s^2].
WATER, SIGMA, GRAVITY = 4186.0, 5.670374e-8, 9.81


def integrated(
    rates: Rates, start: Sequence[float], inputs: Sequence[Steps], stop: float, step: float
) -> tuple[Array, Array]:
    """Times [s] of shape (times,), states of shape (times, states): by LSODA from one change of an input to the next.

    Args:
        rates: Of the states, from time, states and inputs.
        start: States at 0.
        inputs: Held between their instants.
        stop: End [s].
        step: Between two times [s].
    """
    times: Array = step * np.arange(round(stop / step) + 1, dtype=np.float64)
    near = 1e-9 * stop
    found = sorted(t for s in inputs for t in s.times if near < t < stop - near)
    changes = [0.0, *(b for a, b in pairwise([0.0, *found]) if b - a > near), stop]
    x: Array = np.asarray(start, dtype=np.float64)
    states = np.empty((len(times), len(x)))
    states[0] = x
    for begin, end in pairwise(changes):
        u = np.asarray([float(s.at(np.asarray([begin]))[0]) for s in inputs])
        inside = (times > begin + near) & (times < end - near)

        def held(t: float, y: Array, u: Array = u) -> Array:
            return np.asarray(rates(t, y, u), dtype=np.float64)

        at = [*times[inside], end]
        solved = solve_ivp(held, (begin, end), x, method="LSODA", t_eval=at, rtol=1e-8, atol=1e-10)
        states[inside] = solved.y.T[:-1]
        x = solved.y[:, -1]
        states[np.abs(times - end) <= near] = x
    return times, states


def saturation_pressure(temperature: Array | float) -> Array:
    """Of water vapour [Pa], from a temperature [K]; Magnus' formula (Alduchov and Eskridge 1996)."""
    celsius_degrees = np.asarray(temperature) - CELSIUS
    return np.asarray(610.94 * np.exp(17.625 * celsius_degrees / (celsius_degrees + 243.04)))


# --- four tanks and two pumps (Johansson 2000), FMI 2 Model Exchange; V, cm
TANKS = OdeModel(
    "tanks",
    {
        "A1": (28e-4, "m^2"),
        "A2": (32e-4, "m^2"),
        "a1": (7.1e-6, "m^2"),
        "a2": (5.7e-6, "m^2"),
        "a3": (7.1e-6, "m^2"),
        "a4": (5.7e-6, "m^2"),
        "k1": (3.33e-6, "m^3/(s*V)"),
        "k2": (3.35e-6, "m^3/(s*V)"),
        "share1": (0.7, ""),
        "share2": (0.6, ""),
        "g2": (2 * GRAVITY, "m/s^2"),
        "lower": (0.12, "m"),
        "upper": (0.018, "m"),
    },
    {"u1": "V", "u2": "V"},
    {
        "h1": ("m", "lower", "(a3*sqrt(g2*fmax(h3, 0)) - a1*sqrt(g2*fmax(h1, 0)) + share1*k1*u1)/A1"),
        "h2": ("m", "lower", "(a4*sqrt(g2*fmax(h4, 0)) - a2*sqrt(g2*fmax(h2, 0)) + share2*k2*u2)/A2"),
        "h3": ("m", "upper", "((1 - share2)*k2*u2 - a3*sqrt(g2*fmax(h3, 0)))/A1"),
        "h4": ("m", "upper", "((1 - share1)*k1*u1 - a4*sqrt(g2*fmax(h4, 0)))/A2"),
    },
    {"level1": ("m", "h1"), "level2": ("m", "h2"), "level3": ("m", "h3"), "level4": ("m", "h4")},
    0.05,
)
TANKS_KNOWN = {"a1": 0.05, "a2": 0.05, "a3": 0.05, "a4": 0.05, "k1": 0.05, "k2": 0.05, "share1": 0.03, "share2": 0.03}


def _tanks(
    folder: Path,
    rng: Rng,
    weir: float = 0.0,
    stuck: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
) -> None:
    """Two lower and two upper tanks; above 15 cm the first one may flow over a slot into the sewer."""
    TANKS.build(folder)
    stop = 1200.0
    parts = programme("amplifier", ("u1", "V"), ("u2", "V")) + with_numbers("rig", "tanks")
    wires = "  - amplifier.u1 -> rig.u1\n  - amplifier.u2 -> rig.u2\n"
    scenario(folder, "Four tanks", stop, 0.4, 2, parts, wires)
    data_sheet(folder, TANKS, TANKS_KNOWN)
    big, wide, a1, a2, a3, a4, k1, k2, s1, s2, g2, low, up = drawn(rng, TANKS, TANKS_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        out = np.sqrt(g2 * np.maximum(x, 0.0)) * np.asarray([a1, a2, a3, a4])
        over = weir * max(float(x[0]) - 0.15, 0.0) ** 1.5
        return [
            (out[2] - out[0] + s1 * k1 * u[0] - over) / big,
            (out[3] - out[1] + s2 * k2 * u[1]) / wide,
            ((1.0 - s2) * k2 * u[1] - out[2]) / big,
            ((1.0 - s1) * k1 * u[0] - out[3]) / wide,
        ]

    for name in FOLDERS:
        pumps = [drawn_steps(rng, stop, 70.0, 1.6, 4.3, 2.0) for _ in range(2)]
        t, x = integrated(rates, (low, low, up, up), pumps, stop, 0.4)
        sensors = [
            Sensor(
                f"rig.level{i + 1}",
                f"h{i + 1}_cm",
                "cm",
                scaled(i, 100.0),
                0.12 if i < 2 else 0.06,
                2.0 if i < 2 else 4.0,
                noise_stated,
                0.01,
            )
            for i in range(4)
        ]

        def spoil(column: str, t: Array, v: Array, name: str = name) -> Array:
            if stuck is None or name != "second" or column != "h2_cm":
                return v
            held = (t >= stuck[0]) & (t < stuck[1])
            return np.where(held, v[np.argmax(held)], v)

        programmes = {"amplifier.u1": (pumps[0], "V"), "amplifier.u2": (pumps[1], "V")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger, spoil=spoil))


def tanks_null(folder: Path, rng: Rng) -> Truth:
    _tanks(folder, rng, noise_stated=None, logger=Logger(gap=(480.0, 540.0), empty=0.02))
    return Truth("nothing; numbers off as stated, noise is not stated, a gap of 60 s", FINE)


def tanks_overflow(folder: Path, rng: Rng) -> Truth:
    weir = rng.uniform(1.0e-3, 1.8e-3)
    _tanks(folder, rng, weir=weir)
    return Truth(f"above 15 cm tank 1 flows over a slot: {weir:.2e} m^1.5/s times the power 1.5 of the excess", PHYSICS)


def tanks_stuck(folder: Path, rng: Rng) -> Truth:
    begin = 2.0 * round(rng.uniform(150.0, 300.0))
    _tanks(folder, rng, stuck=(begin, begin + 220.0))
    return Truth(f"the level of tank 2 is stuck for 220 s from {begin:.0f} s of the second recording", SENSOR)


# --- a piezoelectric harvester on a shaker, FMI 3 Model Exchange; V, mm, ms; the acceleration is a column of the log
HARVESTER = OdeModel(
    "harvester",
    {
        "m": (8e-3, "kg"),
        "k": (320.0, "N/m"),
        "c": (0.15, "N*s/m"),
        "theta": (1.4e-3, "N/V"),
        "C": (9e-8, "F"),
        "R": (1e5, "ohm"),
    },
    {"a": "m/s^2"},
    {
        "z": ("m", "0.0", "w"),
        "w": ("m/s", "0.0", "-(k*z + c*w + theta*v)/m - a"),
        "v": ("V", "0.0", "(theta*w - v/R)/C"),
    },
    {"voltage": ("V", "v"), "deflection": ("m", "z")},
    1e-4,
)


def _harvester(
    folder: Path,
    rng: Rng,
    hardening: float = 0.0,
    in_g: bool = False,
    noise_stated: float | None = 1.0,
) -> None:
    """A cantilever with a patch and a resistor; measured four times, two of them held out."""
    build3(HARVESTER, folder, has_co_simulation=False)
    stop = 3.0
    parts = programme("shaker", ("a", "m/s^2")) + fmu("beam", "harvester")
    scenario(folder, "A piezoelectric harvester", stop, 1e-3, 2e-3, parts, "  - shaker.a -> beam.a\n")
    m, k, c, theta, capacity, load = drawn(rng, HARVESTER)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        z, w, v = (float(s) for s in x)
        spring = k * z * (1.0 + hardening * z * z)
        return [w, -(spring + c * w + theta * v) / m - float(u[0]), (theta * w - v / load) / capacity]

    for name in FOUR:
        a = drawn_steps(rng, stop, 0.02, -12.0, 12.0, 2e-3)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (a,), stop, 2e-4)
        sensors = [
            Sensor("beam.voltage", "U_V", "V", scaled(2, 1.0), 0.15, 2e-3, noise_stated, 0.01),
            Sensor("beam.deflection", "laser_mm", "mm", scaled(0, 1e3), 0.012, 4e-3, noise_stated),
        ]
        told = {"shaker.a": Steps(a.times, tuple(round(v / 9.80665, 4) for v in a.levels))} if in_g else {}
        logger = Logger("ms", zero=1200.0, jitter=0.1)
        programmes = {"shaker.a": (a, "m/s^2")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger, recorded=["shaker.a"], told=told))


HARVESTER_SPLIT = {"training": ("first", "second"), "held_out": ("third", "fourth")}


def harvester_null(folder: Path, rng: Rng) -> Truth:
    _harvester(folder, rng, noise_stated=1.7)
    return Truth("nothing; numbers 5 % off, noise stated 1.7 times too large, jitter", FINE, **HARVESTER_SPLIT)


def harvester_hard(folder: Path, rng: Rng) -> Truth:
    size = rng.uniform(0.4, 0.7) / 1e-3**2
    _harvester(folder, rng, hardening=size)
    return Truth(
        f"the beam hardens with the cube of its deflection: {size:.3g} 1/m^2",
        PHYSICS,
        ("cubic_spring", "hardening_spring", "nonlinear_spring"),
        **HARVESTER_SPLIT,
    )


def harvester_g(folder: Path, rng: Rng) -> Truth:
    _harvester(folder, rng, in_g=True)
    return Truth(
        "the acceleration is logged in g and stated as m/s^2, in all recordings",
        (*RECORDING, *SENSOR),
        **HARVESTER_SPLIT,
    )


# --- a buoy in a tank, moved by a winch, FMI 2 Model Exchange; mm, m/s^2
BUOY = OdeModel(
    "buoy",
    {
        "m": (45.0, "kg"),
        "added": (20.0, "kg"),
        "area": (0.12, "m^2"),
        "weight": (9810.0, "N/m^3"),
        "b": (30.0, "N*s/m"),
    },
    {"force": "N"},
    {"z": ("m", "0.0", "v"), "v": ("m/s", "0.0", "(force - b*v - weight*area*z)/(m + added)")},
    {"heave": ("m", "z"), "acceleration": ("m/s^2", "(force - b*v - weight*area*z)/(m + added)")},
    5e-3,
)
BUOY_KNOWN = {"added": 0.08, "area": 0.03, "b": 0.08}


def _buoy(
    folder: Path,
    rng: Rng,
    drag: float = 0.0,
    wave: float = 0.0,
    drift: float = 0.0,
) -> None:
    """Heave alone; the tank may have a standing wave of 2.9 rad/s that the buoy raises and that lifts it."""
    BUOY.build(folder)
    stop = 120.0
    parts = programme("winch", ("force", "N")) + with_numbers("buoy", "buoy")
    scenario(folder, "A heaving buoy", stop, 0.03, 0.06, parts, "  - winch.force -> buoy.force\n")
    data_sheet(folder, BUOY, BUOY_KNOWN)
    m, added, area, weight, b = drawn(rng, BUOY, BUOY_KNOWN)

    def acceleration(x: Array, u: Array) -> Array:
        z, v, eta = x[..., 0], x[..., 1], x[..., 2]
        force = u[..., 0] - b * v - drag * v * np.abs(v) - weight * area * (z - eta)
        return np.asarray(force / (m + added))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        change = float(acceleration(x, u))
        return [x[1], change, x[3], -(2.9**2) * x[2] - 2 * 0.03 * 2.9 * x[3] - wave * change]

    for name in FOLDERS:
        force = drawn_steps(rng, stop, 1.5, -90.0, 90.0, 0.06)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (force,), stop, 0.03)
        rate = drift if name == "second" else 0.0

        def laser(t: Array, x: Array, u: Array, times: Array = t, z: Array = x[:, 0], rate: float = rate) -> Array:
            return np.asarray(1e3 * np.interp((1.0 - rate) * t, times, z))

        sensors = [
            Sensor("buoy.acceleration", "imu", "m/s^2", lambda t, x, u: acceleration(x, u), 0.03, 0.06, 1.0, 1e-3),
            Sensor("buoy.heave", "laser_mm", "mm", laser, 2.0, 0.24, 1.0, 0.1),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"winch.force": (force, "N")}, Logger(zero=-10.0)))


def buoy_drag(folder: Path, rng: Rng) -> Truth:
    drag = rng.uniform(140.0, 220.0)
    _buoy(folder, rng, drag=drag)
    return Truth(f"drag of the water with the square of the speed, {drag:.1f} N s^2/m^2", PHYSICS, ("quadratic_drag",))


def buoy_wave(folder: Path, rng: Rng) -> Truth:
    wave = rng.uniform(0.04, 0.08)
    _buoy(folder, rng, wave=wave)
    return Truth(
        f"a standing wave of the tank at 2.9 rad/s, raised by {wave:.3f} of the buoy's acceleration and lifting it",
        PHYSICS,
        ("second_mass", "absorber"),
    )


def buoy_clock(folder: Path, rng: Rng) -> Truth:
    drift = rng.uniform(0.003, 0.006)
    _buoy(folder, rng, drift=drift)
    return Truth(
        f"the clock of the laser's table runs {100 * drift:.2f} % fast in the second recording", (*RECORDING, *SENSOR)
    )


# --- a pan with water on a hot plate, FMI 2 Co-Simulation; degC and degF; power is a column of the log
PAN = OdeModel(
    "pan",
    {
        "C_plate": (850.0, "J/K"),
        "C_water": (4200.0, "J/K"),
        "contact": (28.0, "W/K"),
        "plate_loss": (1.6, "W/K"),
        "water_loss": (3.6, "W/K"),
        "T_begin": (295.15, "K"),
    },
    {"power": "W", "room": "K"},
    {
        "T_p": ("K", "T_begin", "(power - contact*(T_p - T_w) - plate_loss*(T_p - room))/C_plate"),
        "T_w": ("K", "T_begin", "(contact*(T_p - T_w) - water_loss*(T_w - room))/C_water"),
    },
    {"plate": ("K", "T_p"), "water": ("K", "T_w")},
    0.5,
)
PAN_KNOWN = {"C_plate": 0.08, "C_water": 0.04, "contact": 0.08, "plate_loss": 0.08, "water_loss": 0.08}


def _pan(
    folder: Path,
    rng: Rng,
    steam: float = 0.0,
    boost: tuple[float, float, float] | None = None,
    logger: Logger = MINUTES,
    integrator: str = "cvode",
) -> None:
    """A litre of water; it may evaporate into a room of 40 % relative humidity, `steam` in W/Pa."""
    PAN.build(folder)
    stop = 5400.0
    parts = (
        programme("relay", ("power", "W"))
        + programme("kitchen", ("room", "K"))
        + with_numbers("pan", "pan", integrator)
    )
    wires = "  - relay.power -> pan.power\n  - kitchen.room -> pan.room\n"
    scenario(folder, "Water on a hot plate", stop, 2, 10, parts, wires)
    data_sheet(folder, PAN, PAN_KNOWN)
    c_plate, c_water, contact, plate_loss, water_loss, begin = drawn(rng, PAN, PAN_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        plate, water = float(x[0]), float(x[1])
        power, room = float(u[0]), float(u[1])
        over = contact * (plate - water)
        vapour = steam * float(saturation_pressure(water) - 0.4 * saturation_pressure(room))
        return [
            (power - over - plate_loss * (plate - room)) / c_plate,
            (over - water_loss * (water - room) - vapour) / c_water,
        ]

    for name in FOLDERS:
        stated = bursts(rng, stop, 500.0, 300.0, 200.0, 700.0, 10.0)
        power = stated
        if boost is not None and name == "second":
            power = between(stated, boost[0], boost[1], lambda v: boost[2] * v)
        room = Steps((0.0,), (round(rng.uniform(291.0, 297.0), 1),))
        t, x = integrated(rates, (begin, begin), (power, room), stop, 2.0)
        sensors = [
            Sensor("pan.plate", "plate_F", "degF", lambda t, x, u: (x[:, 0] - CELSIUS) * 1.8 + 32, 1.5, 10.0, 1.0, 0.5),
            Sensor("pan.water", "water_C", "degC", celsius(1), 0.12, 10.0, 1.0, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"relay.power": (power, "W"), "kitchen.room": (room, "K")},
            logger,
            recorded=["relay.power"],
            told={} if power is stated else {"relay.power": stated},
        )
        write(folder / name, rng, made)


def pan_null(folder: Path, rng: Rng) -> Truth:
    _pan(folder, rng, logger=Logger("min", zero=30.0, is_comma=True, empty=0.02), integrator="internal")
    return Truth("nothing; numbers off as stated, decimal commas, degF beside degC, Co-Simulation", FINE)


def pan_steam(folder: Path, rng: Rng) -> Truth:
    steam = rng.uniform(2.0e-3, 3.0e-3)
    _pan(folder, rng, steam=steam)
    return Truth(
        f"the water evaporates: {steam:.2e} W/Pa times its vapour pressure above that of the room",
        PHYSICS,
        ("evaporation",),
    )


def pan_boost(folder: Path, rng: Rng) -> Truth:
    begin, factor = 10.0 * round(rng.uniform(130.0, 240.0)), rng.uniform(1.2, 1.35)
    _pan(folder, rng, boost=(begin, begin + 1200.0, factor))
    return Truth(
        f"the power was {factor:.2f} times what is logged, {begin:.0f} s to {begin + 1200:.0f} s of the "
        "second recording",
        SENSOR,
        ("input_fault",),
    )


# --- carbon dioxide in a classroom and its corridor, FMI 3, both interfaces, without units; min
CLASSROOM = OdeModel(
    "classroom",
    {
        "V_room": (180.0, ""),
        "V_hall": (90.0, ""),
        "breath": (5.2, ""),
        "door": (0.06, ""),
        "hall_air": (0.08, ""),
        "outdoor": (420.0, ""),
        "room_begin": (450.0, ""),
        "hall_begin": (430.0, ""),
    },
    {"people": "", "fan": ""},
    {
        "room": ("", "room_begin", "(breath*people - fan*(room - outdoor) - door*(room - hall))/V_room"),
        "hall": ("", "hall_begin", "(door*(room - hall) - hall_air*(hall - outdoor))/V_hall"),
    },
    {"desk": ("", "room"), "corridor": ("", "hall")},
    1.0,
)
CLASSROOM_KNOWN = {"V_room": 0.03, "V_hall": 0.05, "breath": 0.08, "door": 0.08, "hall_air": 0.08}
FOUR_SPLIT = {"training": ("first", "second", "third"), "held_out": ("fourth",)}


def _classroom(
    folder: Path,
    rng: Rng,
    tube: float = 0.0,
    left: float = 0.0,
    grid: float = 60.0,
    noise_stated: float | None = 1.0,
    integrator: str = "cvode",
) -> None:
    """Ppm by volume; four mornings, one held out; the room's air may reach its sensor through a tube, `tube` s late."""
    build3(CLASSROOM, folder)
    stop = 4.5 * 3600.0
    parts = programme("school", ("people", ""), ("fan", "")) + with_numbers("air", "classroom", integrator)
    scenario(
        folder,
        "Air of a classroom",
        stop,
        5,
        60,
        parts,
        "  - school.people -> air.people\n  - school.fan -> air.fan\n",
    )
    data_sheet(folder, CLASSROOM, CLASSROOM_KNOWN)
    room, hall, breath, door, hall_air, outdoor, _, hall_begin = drawn(rng, CLASSROOM, CLASSROOM_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        through = door * (x[0] - x[1])
        return [
            (breath * u[0] - u[1] * (x[0] - outdoor) - through) / room,
            (through - hall_air * (x[1] - outdoor)) / hall,
        ]

    for name in FOUR:
        count = drawn_steps(rng, stop, 1500.0, 0.0, 31.0, grid)
        people = Steps(count.times, tuple(float(round(v)) for v in count.levels))
        fan = drawn_steps(rng, stop, 1100.0, 0.05, 0.4, grid)
        stated = float(round(rng.uniform(430.0, 520.0)))
        begin = stated + (left if name == "second" else 0.0)
        t, x = integrated(rates, (begin, hall_begin), (people, fan), stop, 5.0)

        def desk(t: Array, x: Array, u: Array, times: Array = t, course: Array = x[:, 0]) -> Array:
            return np.asarray(np.interp(t - tube, times, course))

        sensors = [
            Sensor("air.desk", "co2_desk", "1", desk, 8.0, 60.0, noise_stated, 1.0),
            Sensor("air.corridor", "co2_hall", "1", scaled(1, 1.0), 6.0, 60.0, noise_stated, 1.0),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"school.people": (people, ""), "school.fan": (fan, "")},
            Logger("min", zero=480.0),
            recorded=["school.people", "school.fan"],
            sidecar={"components": {"air": {"parameters": {"room_begin": stated}}}},
        )
        write(folder / name, rng, made)


def classroom_null(folder: Path, rng: Rng) -> Truth:
    _classroom(folder, rng, grid=15.0, noise_stated=None, integrator="internal")
    return Truth(
        "nothing; numbers off as stated, no units, noise is not stated, Co-Simulation; inputs change on a grid of 15 s "
        "and are logged each 60 s",
        FINE,
        **FOUR_SPLIT,
    )


def classroom_tube(folder: Path, rng: Rng) -> Truth:
    tube = rng.uniform(140.0, 230.0)
    _classroom(folder, rng, tube=tube)
    return Truth(
        f"the air of the desk reaches its sensor through a tube: a dead time of {tube:.0f} s",
        (*PHYSICS, *SENSOR),
        ("dead_time", "transport_delay", "sensor_delay", "sensor_lag"),
        **FOUR_SPLIT,
    )


def classroom_start(folder: Path, rng: Rng) -> Truth:
    left = float(round(rng.uniform(150.0, 300.0)))
    _classroom(folder, rng, left=left)
    return Truth(
        f"the second recording begins {left:.0f} ppm above what is stated", (*RECORDING, *SENSOR), **FOUR_SPLIT
    )


# --- an active filter of two integrators (Tow and Thomas), FMI 3 Model Exchange; V, mV, ms
FILTER = OdeModel(
    "biquad",
    {
        "R": (1e4, "ohm"),
        "Rq": (1.6e4, "ohm"),
        "Rg": (1e4, "ohm"),
        "C1": (1e-7, "F"),
        "C2": (1e-7, "F"),
        "band_begin": (0.0, "V"),
        "low_begin": (0.0, "V"),
    },
    {"u": "V"},
    {
        "v1": ("V", "band_begin", "-(v1/Rq + v2/R + u/Rg)/C1"),
        "v2": ("V", "low_begin", "v1/(R*C2)"),
    },
    {"band": ("V", "v1"), "low": ("V", "v2")},
    1e-5,
)
FILTER_KNOWN = {"Rq": 0.03, "Rg": 0.03, "C1": 0.07, "C2": 0.07}


def _filter(folder: Path, rng: Rng, rail: float = 0.0, is_other: bool = False) -> None:
    """Charged capacitors are stated; the second integrator may end at a rail; the programme may be the scenario's."""
    build3(FILTER, folder, has_co_simulation=False)
    stop = 0.3
    parts = programme("generator", ("u", "V"))
    written = drawn_steps(rng, stop, 4e-3, -3.0, 3.0, 1e-4)
    real = drawn_steps(rng, stop, 4e-3, -3.0, 3.0, 1e-4)
    if is_other:
        points = ", ".join(f"[{t:.10g} s, {v:.10g} V]" for t, v in zip(written.times, written.levels))
        parts = f"  generator:\n    kind: programme\n    outputs:\n      u: {{unit: V, points: [{points}]}}\n"
    parts += with_numbers("board", "biquad")
    scenario(folder, "An active filter", stop, 1e-4, 2e-4, parts, "  - generator.u -> board.u\n")
    data_sheet(folder, FILTER, FILTER_KNOWN)
    r, rq, rg, c1, c2, _, _ = drawn(rng, FILTER, FILTER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        v1, v2 = float(x[0]), float(x[1])
        clamp = (v2 - min(max(v2, -rail), rail)) / 100.0 if rail else 0.0
        return [-(v1 / rq + v2 / r + float(u[0]) / rg) / c1, (v1 / r - clamp) / c2]

    for name in FOLDERS:
        u = real if is_other else drawn_steps(rng, stop, 4e-3, -3.0, 3.0, 1e-4)
        start = [float(round(v, 2)) for v in rng.uniform(-1.5, 1.5, 2)]
        t, x = integrated(rates, start, (u,), stop, 5e-5)
        sensors = [
            Sensor("board.band", "band_mV", "mV", scaled(0, 1e3), 30.0, 2e-4, 1.0, 5.0),
            Sensor("board.low", "low_V", "V", scaled(1, 1.0), 0.03, 4e-4, 1.0),
        ]
        begin = {"band_begin": f"{start[0]} V", "low_begin": f"{start[1]} V"}
        made = Written(
            t,
            x,
            sensors,
            {} if is_other else {"generator.u": (u, "V")},
            Logger("ms", zero=20.0),
            sidecar={"components": {"board": {"parameters": begin}}},
        )
        write(folder / name, rng, made)


def filter_rail(folder: Path, rng: Rng) -> Truth:
    rail = rng.uniform(2.1, 2.5)
    _filter(folder, rng, rail=rail)
    return Truth(
        f"the amplifier of the second integrator ends at {rail:.2f} V to either side",
        PHYSICS,
        ("saturation", "upper_stop", "lower_stop", "state_limit"),
    )


def filter_programme(folder: Path, rng: Rng) -> Truth:
    _filter(folder, rng, is_other=True)
    return Truth("the scenario states a programme that was played in none of the recordings", (*RECORDING, *SENSOR))


# --- a pneumatic muscle that lifts a weight (Chou and Hannaford 1996), FMI 2, both interfaces; bar, mm
MUSCLE = OdeModel(
    "muscle",
    {
        "S": (3.14e-4, "m^2"),
        "braid": (13.8, ""),
        "loss": (5.6, ""),
        "L": (0.25, "m"),
        "M": (20.0, "kg"),
        "k": (2500.0, "N/m"),
        "c": (160.0, "N*s/m"),
        "tau": (0.12, "s"),
        "g": (GRAVITY, "m/s^2"),
        "p_begin": (1e5, "Pa"),
        "x_begin": (0.010, "m"),
    },
    {"regulator": "Pa"},
    {
        "p": ("Pa", "p_begin", "(regulator - p)/tau"),
        "x": ("m", "x_begin", "v"),
        "v": ("m/s", "0.0", "(S*p*(braid*(1 - x/L)*(1 - x/L) - loss) - k*x - c*v)/M - g"),
    },
    {"pressure": ("Pa", "p"), "lift": ("m", "x")},
    1e-3,
)
MUSCLE_KNOWN = {"S": 0.03, "braid": 0.04, "k": 0.08, "c": 0.08, "tau": 0.06}


def _muscle(
    folder: Path, rng: Rng, fibres: float = 0.0, noise_stated: float | None = 1.0, integrator: str = "cvode"
) -> None:
    """The fibres of the braid may rub on each other: Dahl's model, full after about 1.5 mm."""
    MUSCLE.build(folder)
    stop = 40.0
    parts = programme("valve", ("regulator", "bar")) + with_numbers("arm", "muscle", integrator)
    scenario(folder, "A pneumatic muscle", stop, 0.01, 0.02, parts, "  - valve.regulator -> arm.regulator\n")
    data_sheet(folder, MUSCLE, MUSCLE_KNOWN)
    area, braid, loss, length, mass, k, c, tau, g, p_begin, x_begin = drawn(rng, MUSCLE, MUSCLE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        p, lift, v, rub = (float(s) for s in x)
        pull = area * p * (braid * (1.0 - lift / length) ** 2 - loss)
        force = pull - k * lift - c * v - fibres * rub
        return [(1e5 * float(u[0]) - p) / tau, v, force / mass - g, (v - abs(v) * rub) / 5e-4]

    for name in FOUR:
        valve = drawn_steps(rng, stop, 1.2, 1.0, 4.0, 0.02)
        t, x = integrated(rates, (p_begin, x_begin, 0.0, 0.0), (valve,), stop, 0.01)
        sensors = [
            Sensor("arm.pressure", "p_bar", "bar", scaled(0, 1e-5), 0.02, 0.04, noise_stated, 0.01),
            Sensor("arm.lift", "draw_wire_mm", "mm", scaled(1, 1e3), 0.25, 0.02, noise_stated, 0.1),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"valve.regulator": (valve, "bar")}, Logger(empty=0.03)))


def muscle_null(folder: Path, rng: Rng) -> Truth:
    _muscle(folder, rng, noise_stated=0.7, integrator="internal")
    return Truth(
        "nothing; numbers off as stated, noise stated 1.4 times too small, empty cells, Co-Simulation",
        (*FINE, *OPEN),
        **FOUR_SPLIT,
    )


def muscle_fibres(folder: Path, rng: Rng) -> Truth:
    force = rng.uniform(14.0, 24.0)
    _muscle(folder, rng, fibres=force)
    return Truth(
        f"the fibres of the braid rub: hysteresis of {force:.1f} N (Dahl), full after 1.5 mm",
        PHYSICS,
        ("dry_friction", "stribeck_friction", "hysteresis", "bouc_wen"),
        **FOUR_SPLIT,
    )


# --- a solar collector (FMI 2, Model Exchange) and its store (FMI 3, Co-Simulation); hours
COLLECTOR = OdeModel(
    "collector",
    {
        "C_c": (11000.0, "J/K"),
        "gain": (1.5, "m^2"),
        "U": (7.0, "W/K"),
        "cp": (WATER, "J/(kg*K)"),
        "T_begin": (291.15, "K"),
    },
    {"sun": "W/m^2", "ambient": "K", "flow": "kg/s", "inlet": "K"},
    {"T_c": ("K", "T_begin", "(gain*sun - U*(T_c - ambient) - flow*cp*(T_c - inlet))/C_c")},
    {"outlet": ("K", "T_c")},
)
STORE = OdeModel(
    "store",
    {
        "m": (25.0, "kg"),
        "cp": (WATER, "J/(kg*K)"),
        "mix": (6.0, "W/K"),
        "ua": (1.5, "W/K"),
        "T_begin": (291.15, "K"),
    },
    {"inlet": "K", "flow": "kg/s", "room": "K"},
    {
        "T_t": ("K", "T_begin", "(flow*cp*(inlet - T_t) - mix*(T_t - T_b) - ua*(T_t - room))/(m*cp)"),
        "T_b": ("K", "T_begin", "(flow*cp*(T_t - T_b) + mix*(T_t - T_b) - ua*(T_b - room))/(m*cp)"),
    },
    {"top": ("K", "T_t"), "bottom": ("K", "T_b")},
    5.0,
)
#: Mixed cells that a pipe consists of.
CELLS = 10


def _solar(folder: Path, rng: Rng, sky: float = 0.0, pipe: float = 0.0, noise_stated: float | None = 1.0) -> None:
    """Two FMUs; the collector may radiate to the sky, `sky` m^2, and the pipe to the store may hold `pipe` kg."""
    COLLECTOR.build(folder)
    build3(STORE, folder)
    stop = 6 * 3600.0
    parts = (
        programme("weather", ("sun", "W/m^2"), ("ambient", "K"))
        + programme("pump", ("flow", "kg/s"))
        + programme("cellar", ("room", "K"))
        + fmu("collector", "collector")
        + fmu("store", "store", "internal")
    )
    wires = (
        "  - weather.sun -> collector.sun\n  - weather.ambient -> collector.ambient\n"
        "  - pump.flow -> collector.flow\n  - store.bottom -> collector.inlet\n"
        "  - collector.outlet -> store.inlet\n  - pump.flow -> store.flow\n  - cellar.room -> store.room\n"
    )
    scenario(folder, "A solar collector and its store", stop, 6, 60, parts, wires)
    known = {"C_c": 0.05, "gain": 0.05, "U": 0.05}
    c_c, gain, loss, cp, begin = drawn(rng, COLLECTOR, known)
    m, _, mix, ua, _ = drawn(rng, STORE, {"m": 0.03, "mix": 0.05, "ua": 0.05})

    def rates(t: float, x: Array, u: Array) -> list[float]:
        hot, top, bottom = float(x[0]), float(x[1]), float(x[2])
        sun, ambient, flow, room = (float(v) for v in u)
        radiated = sky * SIGMA * (hot**4 - (0.0552 * ambient**1.5) ** 4)
        behind = [*x[3:], hot] if pipe else [hot]
        return [
            (gain * sun - loss * (hot - ambient) - radiated - flow * cp * (hot - bottom)) / c_c,
            (flow * cp * (behind[0] - top) - mix * (top - bottom) - ua * (top - room)) / (m * cp),
            (flow * cp * (top - bottom) + mix * (top - bottom) - ua * (bottom - room)) / (m * cp),
            *(flow * CELLS / pipe * (before - here) for here, before in pairwise(behind)),
        ]

    for name in FOLDERS:
        clouds = np.clip(np.cumsum(0.25 * rng.normal(size=round(stop / 300.0))) * 0.5 + 0.7, 0.15, 1.0)
        minutes = 300.0 * np.arange(round(stop / 300.0))
        clear = 850.0 * np.sin(np.pi * (minutes / 3600.0 + 2.0) / 12.0)
        sun = Steps(tuple(minutes.tolist()), tuple(float(round(v)) for v in clear * clouds))
        air = 286.0 + rng.uniform(-3.0, 5.0) + 5.0 * np.sin(np.pi * (minutes / 3600.0 - 1.0) / 12.0)
        ambient = Steps(tuple(minutes.tolist()), tuple(float(round(v, 1)) for v in air))
        flow = drawn_steps(rng, stop, 1500.0, 0.006, 0.04, 60.0)
        room = Steps((0.0,), (round(rng.uniform(287.0, 292.0), 1),))
        count = 3 + (CELLS if pipe else 0)
        t, x = integrated(rates, [begin] * count, (sun, ambient, flow, room), stop, 10.0)
        sensors = [
            Sensor("collector.outlet", "T_collector", "degC", celsius(0), 0.25, 60.0, noise_stated, 0.1),
            Sensor("store.top", "T_top", "degC", celsius(1), 0.12, 60.0, noise_stated, 0.0625),
            Sensor("store.bottom", "T_bottom", "degC", celsius(2), 0.12, 120.0, noise_stated, 0.0625),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "weather.sun": (sun, "W/m^2"),
                "weather.ambient": (ambient, "K"),
                "pump.flow": (flow, "kg/s"),
                "cellar.room": (room, "K"),
            },
            Logger("h", zero=8.25),
            recorded=["weather.sun", "weather.ambient", "pump.flow"],
        )
        write(folder / name, rng, made)


def solar_null(folder: Path, rng: Rng) -> Truth:
    _solar(folder, rng, noise_stated=0.6)
    return Truth(
        "nothing; numbers 5 % off, noise stated 1.7 times too small, the clock begins at 8.25 h", (*FINE, *OPEN)
    )


def solar_two(folder: Path, rng: Rng) -> Truth:
    sky, pipe = rng.uniform(0.3, 0.45), rng.uniform(3.0, 5.0)
    _solar(folder, rng, sky=sky, pipe=pipe)
    return Truth(
        f"the collector radiates to the sky with {sky:.3f} m^2 and the pipe to the store holds {pipe:.1f} kg of water: "
        "a dead time that falls with the flow",
        PHYSICS,
        ("radiation", "heat_loss", "natural_convection", "dead_time", "transport_delay"),
    )


# --- six coils of the tool's own kind, strings of three, two and one beside each other on a board; degC, mA
STRINGS = (3, 2, 1)


def _bank(folder: Path, rng: Rng, alpha: float = 0.0, across: float = 0.0, is_exchanged: bool = False) -> None:
    """Currents by string and temperatures by coil; neighbours on the board may exchange heat, `across` W/K."""
    stop = 150.0
    scenario(
        folder,
        "A bank of six coils",
        stop,
        0.05,
        0.1,
        "  supply:\n    kind: programme\n    outputs:\n      voltage: {unit: V, constant: 0 V}\n"
        "  room:\n    kind: programme\n    outputs:\n      temperature: {unit: K, constant: 22 degC}\n"
        f"  circuit: {{kind: ngspice, strings: {list(STRINGS)}, supply: common, start: {{resistance: 2.2 ohm}}}}\n"
        "  actuator: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room,\n"
        f"    {COILS_PARAMETERS}}}\n",
        "  - supply.voltage -> circuit.supply_voltage\n",
    )
    string = np.repeat(np.arange(3), STRINGS)
    own = np.exp(0.03 * rng.standard_normal((3, 6)))
    r, c, h = 2.2 * own[0], COIL_C * own[1], COIL_G * own[2]

    def currents(x: Array, volt: Array) -> Array:
        warm = r * (1.0 + alpha * (x - 295.15))
        return np.stack([volt / warm[..., string == i].sum(axis=-1) for i in range(3)], axis=-1)

    def warming(x: Array, volt: Array, room: float) -> Array:
        power = currents(x, volt)[string] ** 2 * r * (1.0 + alpha * (x - 295.15))
        flux = across * np.diff(x)
        swap = np.concatenate([flux, [0.0]]) - np.concatenate([[0.0], flux])
        return np.asarray((power - h * (x - room) + swap) / c)

    def ammeter(number: int) -> Callable[[Array, Array, Array], Array]:
        return lambda t, x, u: 1e3 * currents(x, u[:, 0])[:, number]

    for name in FOLDERS:
        volt = drawn_steps(rng, stop, 16.0, 0.0, 1.0, 0.1)
        room = float(f"{rng.uniform(19, 25):.1f}")

        def rates(t: float, x: Array, u: Array, room: float = room) -> Array:
            return warming(x, u[0], room + CELSIUS)

        t, x = integrated(rates, [room + CELSIUS] * 6, (volt,), stop, 0.05)
        places = [f"{s + 1},{i + 1}" for s, count in enumerate(STRINGS) for i in range(count)]
        is_swapped = is_exchanged and name == "second"
        read = [*range(2), 3, 2, *range(4, 6)] if is_swapped else list(range(6))
        sensors = [
            Sensor(f"coil[{place}].temperature", f"TC{i + 1}", "degC", celsius(read[i]), 0.25, 0.5, 1.0, 0.1)
            for i, place in enumerate(places)
        ]
        sensors += [
            Sensor(f"string[{i + 1}].current", f"I{i + 1}_mA", "mA", ammeter(i), 1.5, 0.25, 1.0, 0.5) for i in range(3)
        ]
        conditions = {
            "room": {"outputs": {"temperature": {"constant": f"{room} degC"}}},
            "actuator": {"parameters": {"initial_temperature": f"{room} degC"}},
        }
        made = Written(
            t, x, sensors, {"supply.voltage": (volt, "V")}, Logger("s", zero=5.0), sidecar={"components": conditions}
        )
        write(folder / name, rng, made)


def bank_null(folder: Path, rng: Rng) -> Truth:
    _bank(folder, rng)
    return Truth("nothing; numbers of the coils off by 3 %", FINE)


def bank_two(folder: Path, rng: Rng) -> Truth:
    alpha, across = rng.uniform(0.8e-3, 1.4e-3), rng.uniform(1.2e-3, 2.0e-3)
    _bank(folder, rng, alpha=alpha, across=across)
    return Truth(
        f"resistance rises with temperature, {alpha:.2e} 1/K, and neighbours on the board exchange {across:.2e} W/K",
        PHYSICS,
        (
            "temperature_dependent_resistance",
            "resistance_of_temperature",
            "neighbour_heat",
            "neighbours",
            "heat_exchange",
        ),
    )


def bank_exchanged(folder: Path, rng: Rng) -> Truth:
    _bank(folder, rng, is_exchanged=True)
    return Truth(
        "the thermocouples of the last coil of string 1 and the first of string 2 are exchanged, in the second "
        "recording",
        RECORDING,
    )


# --- an eddy-current brake on a test bench, FMI 2 Model Exchange; rpm, A
BRAKE = OdeModel(
    "brake",
    {
        "J": (0.03, "kg*m^2"),
        "b": (4e-3, "N*m*s/rad"),
        "kb": (1.2e-2, "N*m*s/(rad*A^2)"),
        "R": (12.0, "ohm"),
        "L": (0.8, "H"),
    },
    {"torque": "N*m", "u": "V"},
    {
        "w": ("rad/s", "0.0", "(torque - b*w - kb*i*i*w)/J"),
        "i": ("A", "0.0", "(u - R*i)/L"),
    },
    {"speed": ("rad/s", "w"), "current": ("A", "i")},
    2e-3,
)
BRAKE_KNOWN = {"J": 0.05, "b": 0.08, "kb": 0.06, "R": 0.03, "L": 0.08}


def _brake(
    folder: Path,
    rng: Rng,
    critical: float = 0.0,
    dry: float = 0.0,
    copper: float = 0.0,
    is_other: bool = False,
) -> None:
    """Four runs, one held out; the disc's own field may weaken that of the coil above a critical speed [rad/s]."""
    BRAKE.build(folder)
    stop = 80.0
    parts = programme("drive", ("torque", "N*m")) + programme("source", ("u", "V")) + with_numbers("bench", "brake")
    wires = "  - drive.torque -> bench.torque\n  - source.u -> bench.u\n"
    scenario(folder, "An eddy-current brake", stop, 0.02, 0.04, parts, wires)
    data_sheet(folder, BRAKE, BRAKE_KNOWN)
    inertia, b, kb, r, inductance = drawn(rng, BRAKE, BRAKE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        w, i, warm = (float(v) for v in x)
        weaker = 1.0 + (w / critical) ** 2 if critical else 1.0
        drag = b * w + kb * i * i * w / weaker + dry * np.tanh(w / 0.5)
        now = r * (1.0 + copper * warm)
        return [(float(u[0]) - drag) / inertia, (float(u[1]) - now * i) / inductance, (now * i * i - warm / 1.6) / 14.0]

    other = drawn_steps(rng, stop, 3.0, 0.3, 3.0, 0.04)
    for name in FOUR:
        torque = drawn_steps(rng, stop, 3.0, 0.3, 3.0, 0.04)
        volt = drawn_steps(rng, stop, 4.0, 8.0, 24.0, 0.04)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (torque, volt), stop, 0.02)
        sensors = [
            Sensor("bench.speed", "n_rpm", "rpm", scaled(0, 30.0 / np.pi), 8.0, 0.04, 1.0, 1.0),
            Sensor("bench.current", "I_A", "A", scaled(1, 1.0), 0.015, 0.08, 1.0, 0.01),
        ]
        programmes = {"drive.torque": (torque, "N*m"), "source.u": (volt, "V")}
        told = {"drive.torque": other} if is_other and name == "first" else {}
        write(folder / name, rng, Written(t, x, sensors, programmes, Logger("s", zero=60.0), told=told))


def brake_critical(folder: Path, rng: Rng) -> Truth:
    critical = rng.uniform(260.0, 330.0)
    _brake(folder, rng, critical=critical)
    return Truth(
        f"above a critical speed of {critical:.0f} rad/s the disc's own field weakens the brake", PHYSICS, **FOUR_SPLIT
    )


def brake_two(folder: Path, rng: Rng) -> Truth:
    dry, copper = rng.uniform(0.12, 0.2), 0.0039
    _brake(folder, rng, dry=dry, copper=copper)
    return Truth(
        f"dry friction of the bearings of {dry:.3f} N m, and the coil of the brake heats itself: "
        "0.0039 1/K, 1.6 K/W, 22 s",
        PHYSICS,
        (
            "dry_friction",
            "stribeck_friction",
            "self_heating_resistance",
            "temperature_dependent_resistance",
            "resistance_of_temperature",
        ),
        **FOUR_SPLIT,
    )


def brake_other_run(folder: Path, rng: Rng) -> Truth:
    _brake(folder, rng, is_other=True)
    return Truth("the first recording states the torque of another run", RECORDING, **FOUR_SPLIT)


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    tanks_null,
    buoy_drag,
    pan_boost,
    bank_two,
    classroom_tube,
    harvester_g,
    muscle_null,
    brake_critical,
    filter_programme,
    solar_two,
    pan_null,
    tanks_overflow,
    buoy_clock,
    harvester_hard,
    classroom_start,
    bank_null,
    muscle_fibres,
    brake_other_run,
    solar_null,
    pan_steam,
    tanks_stuck,
    brake_two,
    classroom_null,
    buoy_wave,
    bank_exchanged,
    filter_rail,
    harvester_null,
)
