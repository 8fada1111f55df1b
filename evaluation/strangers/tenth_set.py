"""Tenth set: a shape-memory wire, a soft finger, an ionic strip, a cooled vest, a servo valve, wax, a knit, a web.

Written without a look at the library of laws, its proof, its tests or its thresholds, and without a diagnosis of any of
its cases; of what was reported on the earlier sets, the author had read how many cases of the ninth were decided, and
titles of commits since. Truths are integrated by scipy from equations that stand here.
How large an effect is, and how far the numbers are off, is drawn; the deviations of the numbers are those that a
parameter set states. Recordings of a rig differ in length, in logger and partly in rate; the one that is held out was
made with a programme of another kind than those that are fitted.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.eighth_set import second_clock
from evaluation.strangers.fifth_set import GRAVITY, WATER, integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

Read = Callable[[Array, Array, Array], Array]
#: Revolutions per minute in a radian per second; degrees in a radian; newtons in a pound of force.
RPM, DEGREES, POUND_FORCE = 30.0 / np.pi, 180.0 / np.pi, 4.448222
#: Laws that are true where still air carries more heat the warmer it is.
CONVECTION = ("natural_convection", "convection", "free_convection")
#: Laws that are true where a material creeps.
CREEP = (
    "relaxation",
    "creep",
    "viscoelastic",
    "viscoelasticity",
    "maxwell_element",
    "standard_linear_solid",
    "hidden_state",
)


def stairs(rng: Rng, stop: float, dwell: float, low: float, high: float, count: int, grid: float) -> Steps:
    """Up a stair of `count` levels and down again, until the end; how long a step is held varies little."""
    levels = np.linspace(low, high, count)
    course, t = [*levels, *levels[-2:0:-1]], 0.0
    times: list[float] = []
    shown: list[float] = []
    while t < stop - dwell / 2:
        times.append(t)
        shown.append(float(f"{course[len(shown) % len(course)] + 0.03 * (high - low) * rng.uniform(-1, 1):.3g}"))
        t += grid * round(rng.uniform(0.85, 1.15) * dwell / grid)
    return Steps(tuple(times), tuple(shown))


def swept(stop: float, low: float, high: float, slow: float, fast: float, hold: float) -> Steps:
    """A sine whose period falls from `slow` to `fast` s, as a generator holds it for `hold` s each."""
    t = hold * np.arange(round(stop / hold))
    rate = np.log(slow / fast) / stop
    turns = (np.exp(rate * t) - 1.0) / (slow * rate)
    levels = (low + high) / 2 - (high - low) / 2 * np.cos(2 * np.pi * turns)
    return Steps(tuple(float(v) for v in np.round(t, 9)), tuple(float(f"{v:.3g}") for v in levels))


def within(window: tuple[float, float], t: Array) -> Array:
    """Which instants are in it."""
    return np.asarray((t >= window[0]) & (t < window[1]))


# --- a wire of shape-memory alloy that pulls at a spring, heated by a current, FMI 2 Model Exchange; degC, mm, mA
WIRE = OdeModel(
    "wire",
    {
        "R": (3.2, "ohm"),
        "C": (0.11, "J/K"),
        "h": (0.0125, "W/K"),
        "T_room": (295.15, "K"),
        "T_begin": (295.15, "K"),
        "T_mid": (338.0, "K"),
        "T_wide": (4.5, "K"),
        "tau": (0.5, "s"),
        "reach": (6e-3, "m"),
        "k_spring": (300.0, "N/m"),
        "rise": (4.0, "K/N"),
    },
    {"current": "A"},
    {
        "T": ("K", "T_begin", "(R*current*current - h*(T - T_room))/C"),
        "share": (
            "",
            "0.0",
            "(1.0/(1.0 + exp(-(T - T_mid - rise*k_spring*reach*share)/T_wide)) - share)/tau",
        ),
    },
    {"temperature": ("K", "T"), "stroke": ("m", "reach*share")},
    0.02,
)
WIRE_KNOWN = {"R": 0.02, "C": 0.05, "h": 0.06, "T_mid": 0.008, "T_wide": 0.1, "tau": 0.1, "reach": 0.04, "rise": 0.08}


def _wire(
    folder: Path,
    rng: Rng,
    hysteresis: float = 0.0,
    exponent: float = 0.0,
    loose: tuple[float, float, float] | None = None,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """A wire that is heated may transform `hysteresis` K higher, one that cools as much lower than is stated.

    Still air may rise by itself, h (dT/40 K)^exponent. Loose is begin [s], end [s] and gain of the thermocouple over
    the room's temperature, in the second recording.
    """
    WIRE.build(folder)
    parts = programme("source", ("current", "mA")) + with_numbers("wire", "wire")
    scenario(folder, "A wire and a spring", 300.0, 0.2, 0.2, parts, "  - source.current -> wire.current\n")
    data_sheet(folder, WIRE, WIRE_KNOWN)
    r, c, h, room, begin, mid, wide, tau, reach, k_spring, rise = drawn(rng, WIRE, WIRE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Temperature is over that of the room; the last state is the branch, -1 to 1, turned within some 4 K."""
        warm, share, branch = (float(s) for s in x)
        loss = h * (max(abs(warm), 1e-9) / 40.0) ** exponent
        heating = (r * (1e-3 * float(u[0])) ** 2 - loss * warm) / c
        centre = mid - room + rise * k_spring * reach * share + hysteresis * branch
        aim = 1.0 / (1.0 + np.exp(-(warm - centre) / wide))
        return [heating, (aim - share) / tau, (heating - abs(heating) * branch) / 4.0 if hysteresis else 0.0]

    for number, (name, stop) in enumerate((("first", 300.0), ("second", 480.0), ("third", 200.0))):
        if name == "third":
            current = stairs(rng, stop, 8.0, 80.0, 590.0, 7, 0.2)
        else:
            current = drawn_steps(rng, stop, 9.0, 40.0, 600.0, 0.2)
        t, x = integrated(rates, (begin - room, 0.0, 0.0), (current,), stop, 0.1)

        def thermocouple(t: Array, x: Array, u: Array, name: str = name) -> Array:
            gain = np.ones(len(t))
            if loose is not None and name == "second":
                gain[within(loose[:2], t)] = loose[2]
            return np.asarray(gain * x[:, 0] + room - CELSIUS)

        every = 0.4 if name == "third" else 0.2
        sensors = [
            Sensor("wire.temperature", "TC-K/°C", "degC", thermocouple, 0.4, every, 1.0, 0.1),
            Sensor("wire.stroke", "hub_mm", "mm", scaled(1, 1e3 * reach), 0.04, every, 1.0, 0.01),
        ]
        made = Written(t, x, sensors, {"source.current": (current, "mA")}, loggers[number % len(loggers)])
        write(folder / name, rng, made)


def wire_hysteresis(folder: Path, rng: Rng) -> Truth:
    hysteresis = rng.uniform(5.0, 8.0)
    loggers = (Logger("s", zero=20.0), Logger("min"), Logger("ms", zero=650.0))
    _wire(folder, rng, hysteresis=hysteresis, loggers=loggers)
    return Truth(
        f"the wire transforms {hysteresis:.2f} K higher when it is heated, and as much lower when it cools, than is "
        "stated",
        PHYSICS,
        ("hysteresis", "bouc_wen"),
    )


def wire_two(folder: Path, rng: Rng) -> Truth:
    hysteresis, exponent = rng.uniform(5.0, 8.0), rng.uniform(0.25, 0.38)
    _wire(folder, rng, hysteresis=hysteresis, exponent=exponent, loggers=(PLAIN, Logger("s", zero=-35.0)))
    return Truth(
        f"the wire transforms {hysteresis:.2f} K higher when it is heated, and as much lower when it cools, than "
        f"stated, and still air rises by itself, h (dT/40 K)^{exponent:.3f}",
        PHYSICS,
        ("hysteresis", "bouc_wen", *CONVECTION),
    )


def wire_loose(folder: Path, rng: Rng) -> Truth:
    begin, gain = 10.0 * round(rng.uniform(6.0, 25.0)), rng.uniform(0.78, 0.87)
    loose = (begin, begin + 150.0, gain)
    _wire(folder, rng, loose=loose, loggers=(Logger("min", zero=4.0), PLAIN))
    return Truth(
        f"the thermocouple comes loose and shows {gain:.3f} times the wire's rise over the room, {begin:g} s to "
        f"{begin + 150.0:g} s of the second recording",
        SENSOR,
    )


# --- a soft finger of silicone behind a tube and a vent, FMI 3 Model Exchange; kPa, deg; two rates
FINGER = OdeModel(
    "finger",
    {
        "C_air": (3.3e-10, "m^3/Pa"),
        "R_tube": (1.2e9, "Pa*s/m^3"),
        "G_vent": (8e-10, "m^3/(s*Pa)"),
        "beta": (6e-6, "m^3/rad"),
        "J": (8e-4, "kg*m^2"),
        "k": (0.25, "N*m/rad"),
        "d": (0.012, "N*m*s/rad"),
    },
    {"supply": "Pa", "vent": ""},
    {
        "p": ("Pa", "0.0", "((supply - p)/R_tube - G_vent*vent*p - beta*w)/C_air"),
        "bend": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "(beta*p - k*bend - d*w)/J"),
    },
    {"pressure": ("Pa", "p"), "angle": ("rad", "bend")},
    1e-3,
)
FINGER_KNOWN = {"C_air": 0.06, "R_tube": 0.06, "G_vent": 0.08, "beta": 0.04, "J": 0.05, "k": 0.05, "d": 0.1}


def _finger(
    folder: Path,
    rng: Rng,
    creep: tuple[float, float] | None = None,
    weight: float = 0.0,
    stronger: tuple[float, float, float] | None = None,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Silicone may creep: a spring [N m/rad] behind a dashpot with a time [s]; a finger that hangs has its weight.

    Stronger is begin [s], end [s] and factor of the supply's pressure in the first recording.
    """
    build3(FINGER, folder, has_co_simulation=False)
    parts = programme("valves", ("supply", "kPa"), ("vent", "")) + with_numbers("finger", "finger")
    wires = "  - valves.supply -> finger.supply\n  - valves.vent -> finger.vent\n"
    scenario(folder, "A soft finger", 40.0, 0.02, 0.02, parts, wires)
    data_sheet(folder, FINGER, FINGER_KNOWN)
    c_air, r_tube, g_vent, beta, inertia, k, d = drawn(rng, FINGER, FINGER_KNOWN)
    k_creep, tau_creep = creep or (0.0, 1.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in kPa."""
        p, bend, w, crept = (float(s) for s in x)
        flow = 1e3 * ((float(u[0]) - p) / r_tube - g_vent * float(u[1]) * p) - beta * w
        torque = 1e3 * beta * p - k * bend - k_creep * (bend - crept) - weight * np.sin(bend) - d * w
        return [1e-3 * flow / c_air, w, torque / inertia, (bend - crept) / tau_creep]

    for number, (name, stop) in enumerate((("first", 40.0), ("second", 64.0), ("third", 30.0))):
        if name == "third":
            stated = swept(stop, 8.0, 88.0, 9.0, 1.6, 0.2)
            vent = bursts(rng, stop, 4.0, 1.5, 0.3, 0.9, 0.02)
        else:
            stated = drawn_steps(rng, stop, 2.2, 5.0, 90.0, 0.02)
            vent = drawn_steps(rng, stop, 3.1, 0.0, 1.0, 0.02)
        supply = stated
        if stronger is not None and name == "first":
            supply = between(stated, stronger[0], stronger[1], lambda v: stronger[2] * v)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (supply, vent), stop, 0.01)
        sensors = [
            Sensor("finger.pressure", "MPX kPa", "kPa", scaled(0, 1.0), 0.35, 0.02, noise_stated, 0.1, colour),
            Sensor("finger.angle", "cam_deg", "deg", scaled(1, DEGREES), 0.5, 0.04, noise_stated, 0.1, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"valves.supply": (supply, "kPa"), "valves.vent": (vent, "")},
            loggers[number % len(loggers)],
            told={} if supply is stated else {"valves.supply": stated},
        )
        write(folder / name, rng, made)


def finger_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=3.4), Logger("ms", jitter=0.25))
    _finger(folder, rng, colour=0.8, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.8, jitter, two loggers and two "
        "rates",
        FINE,
    )


def finger_creep(folder: Path, rng: Rng) -> Truth:
    k_creep, tau = rng.uniform(0.06, 0.09), rng.uniform(4.0, 8.0)
    _finger(folder, rng, creep=(k_creep, tau), loggers=(PLAIN, Logger("s", zero=118.0)))
    return Truth(f"silicone creeps: a spring of {k_creep:.3f} N m/rad behind a dashpot, {tau:.2f} s", PHYSICS, CREEP)


def finger_two(folder: Path, rng: Rng) -> Truth:
    k_creep, tau = rng.uniform(0.06, 0.09), rng.uniform(4.0, 8.0)
    weight = rng.uniform(0.045, 0.06) * 0.12 * GRAVITY
    _finger(folder, rng, creep=(k_creep, tau), weight=weight, loggers=(Logger("ms", zero=200.0),))
    return Truth(
        f"silicone creeps: a spring of {k_creep:.3f} N m/rad behind a dashpot, {tau:.2f} s, and the finger hangs: "
        f"gravity turns it back with {weight:.4f} N m sin(bend)",
        PHYSICS,
        (*CREEP, "gravity", "weight", "gravity_torque", "pendulum"),
    )


def finger_supply(folder: Path, rng: Rng) -> Truth:
    begin, factor = float(round(rng.uniform(8.0, 20.0))), rng.uniform(1.12, 1.2)
    _finger(folder, rng, stronger=(begin, begin + 13.0, factor), loggers=(Logger("s", zero=50.0), PLAIN))
    return Truth(
        f"the supply gave {factor:.3f} times the pressure that is stated, {begin:g} s to {begin + 13.0:g} s of the "
        "first recording",
        SENSOR,
        ("input_fault",),
    )


# --- a strip of an ionic polymer in water that bends with its charge, FMI 3 Co-Simulation, without units; V, A, mm
STRIP = OdeModel(
    "strip",
    {"R": (12.0, ""), "C": (0.06, ""), "kappa": (45.0, ""), "tau_b": (0.35, "")},
    {"u": ""},
    {"q": ("", "0.0", "(u - q/C)/R"), "b": ("", "0.0", "(kappa*q - b)/tau_b")},
    {"i": ("", "(u - q/C)/R"), "tip": ("", "b")},
    2e-3,
)
STRIP_KNOWN = {"R": 0.04, "C": 0.06, "kappa": 0.05, "tau_b": 0.08}


def _strip(
    folder: Path,
    rng: Rng,
    leak: tuple[float, float] | None = None,
    is_reversed: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Water may be split above a voltage [V] of the double layer, and leak [S] times the excess past it."""
    build3(STRIP, folder, has_exchange=False)
    parts = programme("potentiostat", ("u", "")) + with_numbers("strip", "strip", "internal")
    scenario(folder, "An ionic strip", 60.0, 0.02, 0.02, parts, "  - potentiostat.u -> strip.u\n")
    data_sheet(folder, STRIP, STRIP_KNOWN)
    r, c, kappa, tau = drawn(rng, STRIP, STRIP_KNOWN)
    onset, conductance = leak or (np.inf, 0.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Charge is in mC."""
        q, b = (float(s) for s in x)
        v = 1e-3 * q / c
        split = conductance * np.sign(v) * max(0.0, abs(v) - onset) if conductance else 0.0
        return [1e3 * ((float(u[0]) - v) / r - split), (1e-3 * kappa * q - b) / tau]

    def current(t: Array, x: Array, u: Array) -> Array:
        return np.asarray((u[:, 0] - 1e-3 * x[:, 0] / c) / r)

    for number, (name, stop) in enumerate((("first", 60.0), ("second", 36.0), ("third", 48.0))):
        u = swept(stop, -2.0, 2.0, 12.0, 2.4, 0.2) if name == "third" else drawn_steps(rng, stop, 1.8, -2.1, 2.1, 0.02)
        t, x = integrated(rates, (0.0, 0.0), (u,), stop, 0.01)
        sign = -1.0 if is_reversed and name == "second" else 1.0
        sensors = [
            Sensor("strip.i", "WE(1).Current", "1", current, 1.2e-3, 0.02, noise_stated, 1e-4, wild=wild),
            Sensor("strip.tip", "Keyence", "1", scaled(1, sign), 0.03, 0.02, noise_stated, 0.01, wild=wild),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"potentiostat.u": (u, "")}, loggers[number % len(loggers)]))


def strip_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=2.0), Logger("s", zero=-5.0, gap=(20.0, 23.0)))
    _strip(folder, rng, noise_stated=None, wild=0.008, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, no units, noise is not stated, wild readings, a gap of 3 s in the second "
        "recording",
        FINE,
    )


def strip_electrolysis(folder: Path, rng: Rng) -> Truth:
    onset, conductance = rng.uniform(0.95, 1.15), rng.uniform(0.04, 0.07)
    _strip(folder, rng, leak=(onset, conductance), loggers=(PLAIN, Logger("ms", zero=10.0)))
    return Truth(
        f"water is split above {onset:.3f} V of the double layer, {conductance:.4f} S times the excess leaks past it",
        PHYSICS,
        ("threshold", "threshold_leak", "dead_zone", "overflow", "one_sided_outflow", "diode"),
    )


def strip_sign(folder: Path, rng: Rng) -> Truth:
    _strip(folder, rng, is_reversed=True, loggers=(Logger("s", zero=8.0),))
    return Truth("the laser counts the other way in the second recording", (*RECORDING, *SENSOR))


# --- a vest with water in its tubes (FMI 2, Model Exchange) and a chiller (FMI 3, Co-Simulation); degC, kg/min; min
VEST = OdeModel(
    "vest",
    {
        "c": (WATER, "J/(kg*K)"),
        "C_tubes": (2200.0, "J/K"),
        "C_skin": (9000.0, "J/K"),
        "UA": (25.0, "W/K"),
        "U_air": (3.0, "W/K"),
        "blood": (15.0, "W/K"),
        "T_core": (310.15, "K"),
        "T_tubes_begin": (298.15, "K"),
        "T_skin_begin": (306.15, "K"),
    },
    {"flow": "kg/s", "supply": "K", "heat": "W", "ambient": "K"},
    {
        "T_v": (
            "K",
            "T_tubes_begin",
            "(flow*c*(supply - T_v) + UA*(T_s - T_v) + U_air*(ambient - T_v))/C_tubes",
        ),
        "T_s": ("K", "T_skin_begin", "(heat - UA*(T_s - T_v) + blood*(T_core - T_s))/C_skin"),
    },
    {"back": ("K", "T_v"), "skin": ("K", "T_s")},
    1.0,
)
CHILLER = OdeModel(
    "chiller",
    {
        "c": (WATER, "J/(kg*K)"),
        "C_tank": (13000.0, "J/K"),
        "U_tank": (1.5, "W/K"),
        "T_tank_begin": (295.15, "K"),
    },
    {"flow": "kg/s", "back": "K", "cooling": "W", "ambient": "K"},
    {
        "T_w": (
            "K",
            "T_tank_begin",
            "(flow*c*(back - T_w) - cooling + U_tank*(ambient - T_w))/C_tank",
        )
    },
    {"tank": ("K", "T_w")},
    0.5,
)
VEST_KNOWN = {"C_tubes": 0.06, "C_skin": 0.05, "UA": 0.06, "U_air": 0.1, "blood": 0.05}
CHILLER_KNOWN = {"C_tank": 0.04, "U_tank": 0.1}


def _suit(
    folder: Path,
    rng: Rng,
    exponent: float = 0.0,
    fast: float = 0.0,
    noise_stated: float | None = 1.0,
    clock: tuple[str, float] | None = None,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; the tubes may carry heat by their flow, UA (flow / 0.8 kg/min)^exponent.

    The clock of the chiller's logger may run `fast` (share) in the second recording.
    """
    VEST.build(folder)
    build3(CHILLER, folder, has_exchange=False)
    data_sheet(folder, CHILLER, CHILLER_KNOWN)
    (folder / "numbers.yaml").rename(folder / "chiller.yaml")
    data_sheet(folder, VEST, VEST_KNOWN)
    parts = (
        programme("pump", ("flow", "kg/min"))
        + programme("control", ("cooling", "W"))
        + programme("subject", ("heat", "W"))
        + programme("room", ("ambient", "degC"))
        + with_numbers("chiller", "chiller", "internal").replace("numbers.yaml", "chiller.yaml")
        + with_numbers("vest", "vest")
    )
    wires = (
        "  - pump.flow -> chiller.flow\n  - pump.flow -> vest.flow\n  - control.cooling -> chiller.cooling\n"
        "  - room.ambient -> chiller.ambient\n  - room.ambient -> vest.ambient\n  - subject.heat -> vest.heat\n"
        "  - chiller.tank -> vest.supply\n  - vest.back -> chiller.back\n"
    )
    scenario(folder, "A water-cooled vest", 3600.0, 2, 2, parts, wires)
    c, c_tubes, c_skin, ua, u_air, blood, core, tubes_begin, skin_begin = drawn(rng, VEST, VEST_KNOWN)
    _, c_tank, u_tank, tank_begin = drawn(rng, CHILLER, CHILLER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        tank, tubes, skin = (float(s) for s in x)
        carried, ambient = float(u[0]) / 60.0 * c, float(u[3]) + CELSIUS
        taken = ua * (float(u[0]) / 0.8) ** exponent * (skin - tubes)
        return [
            (carried * (tubes - tank) - float(u[1]) + u_tank * (ambient - tank)) / c_tank,
            (carried * (tank - tubes) + taken + u_air * (ambient - tubes)) / c_tubes,
            (float(u[2]) - taken + blood * (core - skin)) / c_skin,
        ]

    for number, (name, stop) in enumerate((("first", 3600.0), ("second", 5400.0), ("third", 3000.0))):
        if name == "third":
            flow = stairs(rng, stop, 240.0, 0.35, 1.6, 5, 2.0)
            cooling = bursts(rng, stop, 260.0, 360.0, 200.0, 420.0, 2.0)
        else:
            flow = drawn_steps(rng, stop, 300.0, 0.3, 1.7, 2.0)
            cooling = drawn_steps(rng, stop, 420.0, 20.0, 380.0, 2.0)
        heat = drawn_steps(rng, stop, 600.0, 30.0, 190.0, 2.0)
        ambient = Steps((0.0,), (float(f"{rng.uniform(27.0, 36.0):.1f}"),))
        t, x = integrated(rates, (tank_begin, tubes_begin, skin_begin), (flow, cooling, heat, ambient), stop, 1.0)
        drift = fast if name == "second" else 0.0

        def tank(_: Array, t: Array = t, x: Array = x, drift: float = drift) -> Array:
            return np.asarray(np.interp((1.0 - drift) * _, t, x[:, 0]) - CELSIUS)

        sensors = [
            Sensor("vest.back", "T_return", "degC", celsius(1), 0.08, 4.0, noise_stated, 0.01),
            Sensor("vest.skin", "iButton_chest", "degC", celsius(2), 0.07, 4.0, noise_stated, 0.0625),
            Sensor("chiller.tank", "PT100 Tank", "degC", lambda t, x, u: tank(t), 0.05, 6.0, noise_stated, 0.01),
        ]
        programmes = {
            "pump.flow": (flow, "kg/min"),
            "control.cooling": (cooling, "W"),
            "subject.heat": (heat, "W"),
            "room.ambient": (ambient, "degC"),
        }
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))
        if clock is not None:
            second_clock(folder / name, clock[0], clock[1] + 37.0 * number)


def suit_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", gap=(1500.0, 1770.0)), Logger("min", zero=9.0, empty=0.03), Logger("s", zero=60.0))
    _suit(folder, rng, noise_stated=1.4, clock=("min", 500.0), loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, noise stated 1.4 times too large, a gap of 270 s, empty cells, the "
        "chiller's table is of a logger with another rate and a clock of its own, in minutes from 500",
        FINE,
    )


def suit_transfer(folder: Path, rng: Rng) -> Truth:
    exponent = rng.uniform(0.5, 0.75)
    _suit(folder, rng, exponent=exponent, loggers=(Logger("min"), PLAIN))
    return Truth(
        f"the tubes carry heat by their flow: UA (flow / 0.8 kg/min)^{exponent:.3f}",
        PHYSICS,
        ("forced_convection", "flow_dependent_transfer", "transfer_of_flow", "heat_exchange", "gain_of_input"),
    )


def suit_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(0.02, 0.035)
    _suit(folder, rng, fast=fast, loggers=(PLAIN, Logger("s", zero=1200.0)))
    return Truth(
        f"the clock of the chiller's table runs {100 * fast:.2f} % fast in the second recording", (*RECORDING, *SENSOR)
    )


# --- the pilot stage and spool of a servo valve with a feedback wire, FMI 2 Model Exchange; mA, um, ms
VALVE = OdeModel(
    "valve",
    {
        "L": (0.24, "H"),
        "R": (80.0, "ohm"),
        "J": (8e-7, "kg*m^2"),
        "d": (1.4e-3, "N*m*s/rad"),
        "k": (4.0, "N*m/rad"),
        "k_t": (0.4, "N*m/A"),
        "k_wire": (80.0, "N"),
        "g": (15.0, "m/(s*rad)"),
    },
    {"u": "V"},
    {
        "i": ("A", "0.0", "(u - R*i)/L"),
        "flap": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "(k_t*i - k*flap - d*w - k_wire*s)/J"),
        "s": ("m", "0.0", "g*flap"),
    },
    {"current": ("A", "i"), "spool": ("m", "s")},
    5e-5,
)
VALVE_KNOWN = {"L": 0.05, "R": 0.02, "J": 0.05, "d": 0.1, "k": 0.04, "k_t": 0.05, "k_wire": 0.04, "g": 0.06}


def _valve(
    folder: Path,
    rng: Rng,
    saturation: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """Iron of the torque motor may saturate, torque k_t i_s tanh(i/i_s), i_s in mA.

    The first recording may state the voltage of another run.
    """
    VALVE.build(folder)
    parts = programme("card", ("u", "V")) + with_numbers("valve", "valve")
    scenario(folder, "A servo valve", 0.4, 2e-4, 2e-4, parts, "  - card.u -> valve.u\n")
    data_sheet(folder, VALVE, VALVE_KNOWN)
    inductance, r, inertia, d, k, k_t, k_wire, g = drawn(rng, VALVE, VALVE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Current is in mA, angle in mrad, the spool in um."""
        i, flap, w, s = (float(v) for v in x)
        drive = saturation * np.tanh(i / saturation) if saturation else i
        return [
            (1e3 * float(u[0]) - r * i) / inductance,
            w,
            (k_t * drive - k * flap - d * w - 1e-3 * k_wire * s) / inertia,
            1e3 * g * flap,
        ]

    other = drawn_steps(rng, 0.4, 0.014, -8.0, 8.0, 2e-4)
    for number, (name, stop) in enumerate((("first", 0.4), ("second", 0.9), ("third", 0.3))):
        if name == "third":
            u = swept(stop, -7.8, 7.8, 0.09, 0.016, 1e-3)
        else:
            u = drawn_steps(rng, stop, 0.014, -8.0, 8.0, 2e-4)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (u,), stop, 5e-5)
        sensors = [
            Sensor("valve.current", "CH1 shunt", "mA", scaled(0, 1.0), 0.5, 2e-4, noise_stated, 0.1),
            Sensor("valve.spool", "CH2 LVDT µm", "um", scaled(3, 1.0), 3.5, 2e-4, noise_stated, 1.0),
        ]
        told = {"card.u": other} if is_other and name == "first" else {}
        made = Written(t, x, sensors, {"card.u": (u, "V")}, loggers[number % len(loggers)], told=told)
        write(folder / name, rng, made)


def valve_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=-20.0, jitter=0.3), Logger("s", empty=0.03), Logger("ms"))
    _valve(folder, rng, noise_stated=0.7, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.43 times too small, jitter, empty cells, two loggers", FINE
    )


def valve_saturation(folder: Path, rng: Rng) -> Truth:
    saturation = rng.uniform(75.0, 105.0)
    _valve(folder, rng, saturation=saturation, loggers=(Logger("ms"), Logger("s", zero=0.05)))
    return Truth(
        f"iron of the torque motor saturates: torque k_t i_s tanh(i/i_s), i_s = {saturation:.1f} mA",
        PHYSICS,
        ("saturation", "magnetic_saturation", "input_saturation", "saturating_gain"),
    )


def valve_other_run(folder: Path, rng: Rng) -> Truth:
    _valve(folder, rng, is_other=True, loggers=(Logger("ms", zero=4.0),))
    return Truth("the first recording states the voltage of another run", RECORDING)


# --- paraffin in a heated case, FMI 3, both interfaces; degC, W, h; a reading each minute; power and room are columns
WAX = OdeModel(
    "wax",
    {
        "C_case": (420.0, "J/K"),
        "C_wax": (1300.0, "J/K"),
        "U_in": (2.6, "W/K"),
        "U_out": (0.85, "W/K"),
        "T_begin": (294.15, "K"),
    },
    {"power": "W", "room": "K"},
    {
        "T_c": ("K", "T_begin", "(power - U_in*(T_c - T_w) - U_out*(T_c - room))/C_case"),
        "T_w": ("K", "T_begin", "U_in*(T_c - T_w)/C_wax"),
    },
    {"case": ("K", "T_c"), "core": ("K", "T_w")},
    10.0,
)
WAX_KNOWN = {"C_case": 0.05, "C_wax": 0.05, "U_in": 0.06, "U_out": 0.05}


def _wax(
    folder: Path,
    rng: Rng,
    melting: tuple[float, float, float] | None = None,
    strayed: float = 0.0,
    warmer: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Wax may melt: heat [J], temperature [K] and width [K]. The second recording may begin `warmer` K.

    `strayed` is by how much [K] the start of each recording is off (deviation), which is stated.
    """
    build3(WAX, folder)
    parts = programme("heater", ("power", "W"), ("room", "degC")) + with_numbers("pack", "wax")
    wires = "  - heater.power -> pack.power\n  - heater.room -> pack.room\n"
    scenario(folder, "A pack of wax", 28800.0, 30, 60, parts, wires)
    data_sheet(folder, WAX, WAX_KNOWN)
    c_case, c_wax, u_in, u_out, usual = drawn(rng, WAX, WAX_KNOWN)
    heat, point, wide = melting or (0.0, 325.0, 1.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        case, core = (float(s) for s in x)
        inward = u_in * (case - core)
        capacity = c_wax + heat * np.exp(-(((core - point) / wide) ** 2)) / (wide * np.sqrt(np.pi))
        return [(float(u[0]) - inward - u_out * (case - float(u[1]) - CELSIUS)) / c_case, inward / capacity]

    for number, (name, stop) in enumerate((("first", 28800.0), ("second", 43200.0), ("third", 21600.0))):
        if name == "third":
            power = stairs(rng, stop, 1500.0, 4.0, 46.0, 5, 60.0)
        else:
            power = drawn_steps(rng, stop, 2400.0, 0.0, 50.0, 60.0)
        room = drawn_steps(rng, stop, 7200.0, 19.0, 25.0, 60.0)
        said = float(f"{rng.uniform(292.0, 306.0):.1f}") if strayed else usual
        begin = said + strayed * float(rng.normal()) + (warmer if name == "second" else 0.0)
        t, x = integrated(rates, (begin, begin), (power, room), stop, 30.0)
        sensors = [
            Sensor("pack.case", "Gehäuse", "degC", celsius(0), 0.15, 60.0, noise_stated, 0.1),
            Sensor("pack.core", "Kern", "degC", celsius(1), 0.12, 60.0, noise_stated, 0.1),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"pack": {"parameters": {"T_begin": f"{said:.1f} K"}}}
            sidecar["uncertain"] = {"pack.T_begin": f"{strayed:g} K"}
        made = Written(
            t,
            x,
            sensors,
            {"heater.power": (power, "W"), "heater.room": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["heater.power", "heater.room"],
            sidecar=sidecar,
        )
        write(folder / name, rng, made)


def wax_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=510.0, is_comma=True), Logger("min", is_comma=True, empty=0.02))
    _wax(folder, rng, strayed=2.0, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, a start of each recording is stated that is off by 2 K (deviation), which is "
        "stated too; decimal commas, empty cells, minutes from 510",
        FINE,
    )


def wax_melting(folder: Path, rng: Rng) -> Truth:
    heat, point, wide = rng.uniform(2e4, 3.5e4), rng.uniform(318.0, 323.0), rng.uniform(2.0, 3.5)
    _wax(folder, rng, melting=(heat, point, wide), loggers=(Logger("h", zero=8.25), Logger("min")))
    return Truth(
        f"the wax takes up {heat / 1e3:.1f} kJ as it melts, around {point - CELSIUS:.2f} degC within {wide:.2f} K",
        PHYSICS,
        ("latent_heat", "phase_change", "melting"),
    )


def wax_start(folder: Path, rng: Rng) -> Truth:
    warmer = rng.uniform(7.0, 12.0)
    _wax(folder, rng, warmer=warmer, loggers=(Logger("min", zero=30.0),))
    return Truth(
        f"case and wax are {warmer:.2f} K warmer than stated at the begin of the second recording",
        (*RECORDING, *SENSOR),
    )


# --- a knitted strip stretched by a linear motor, with its resistance, FMI 2 Co-Simulation; mm, kohm; force is a column
KNIT = OdeModel(
    "knit",
    {
        "m": (0.25, "kg"),
        "d": (3.5, "N*s/m"),
        "k": (180.0, "N/m"),
        "k_slow": (60.0, "N/m"),
        "tau_slow": (3.0, "s"),
        "length": (0.1, "m"),
        "R_rest": (12000.0, "ohm"),
        "gauge": (1.4, ""),
    },
    {"force": "N"},
    {
        "x": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(force - k*x - k_slow*(x - y) - d*v)/m"),
        "y": ("m", "0.0", "(x - y)/tau_slow"),
    },
    {"stretch": ("m", "x"), "resistance": ("ohm", "R_rest*(1.0 + gauge*x/length)")},
    1e-3,
)
KNIT_KNOWN = {"m": 0.03, "d": 0.1, "k": 0.05, "k_slow": 0.1, "tau_slow": 0.1, "R_rest": 0.02, "gauge": 0.06}


def _knit(
    folder: Path,
    rng: Rng,
    locking: float = 0.0,
    frozen: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    quantum: float = 0.02,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Loops may lock as they are stretched, k locking (exp(x/locking) - 1), `locking` in mm.

    The laser may repeat one reading, begin and end [s], in the second recording.
    """
    KNIT.build(folder)
    parts = programme("motor", ("force", "N")) + with_numbers("knit", "knit", "internal")
    scenario(folder, "A knitted strip", 36.0, 0.02, 0.02, parts, "  - motor.force -> knit.force\n")
    data_sheet(folder, KNIT, KNIT_KNOWN)
    m, d, k, k_slow, tau_slow, length, r_rest, gauge = drawn(rng, KNIT, KNIT_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Courses are in mm, forces in mN."""
        s, v, y = (float(w) for w in x)
        held = k * locking * np.expm1(s / locking) if locking else k * s
        return [v, (1e3 * float(u[0]) - held - k_slow * (s - y) - d * v) / m, (s - y) / tau_slow]

    def resistance(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(1e-3 * r_rest * (1.0 + gauge * 1e-3 * x[:, 0] / length))

    for number, (name, stop) in enumerate((("first", 36.0), ("second", 52.0), ("third", 24.0))):
        if name == "third":
            force = bursts(rng, stop, 1.2, 1.6, 2.0, 8.0, 0.02)
        else:
            force = drawn_steps(rng, stop, 1.5, 0.3, 8.0, 0.02)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (force,), stop, 0.01)

        def spoil(column: str, t: Array, v: Array, name: str = name) -> Array:
            if frozen is None or name != "second" or column != "x/mm":
                return v
            return np.where(within(frozen, t), v[np.searchsorted(t, frozen[0])], v)

        sensors = [
            Sensor("knit.stretch", "x/mm", "mm", scaled(0, 1.0), 0.15, 0.02, noise_stated, quantum, colour),
            Sensor("knit.resistance", "R_knit", "kohm", resistance, 0.06, 0.02, noise_stated, 0.01, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"motor.force": (force, "N")},
            loggers[number % len(loggers)],
            recorded=["motor.force"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def knit_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=1500.0), Logger("s", empty=0.03))
    _knit(folder, rng, noise_stated=None, quantum=0.5, colour=0.4, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated and that of neighbouring readings correlates by 0.4, a "
        "coarse converter of the laser, empty cells, Co-Simulation",
        FINE,
    )


def knit_locking(folder: Path, rng: Rng) -> Truth:
    locking = rng.uniform(45.0, 75.0)
    _knit(folder, rng, locking=locking, loggers=(PLAIN, Logger("s", zero=7.0)))
    return Truth(
        f"loops lock as they are stretched: k {locking:.1f} mm (exp(x/{locking:.1f} mm) - 1)",
        PHYSICS,
        ("cubic_spring", "cubic_stiffness", "quadratic_spring", "hardening", "hardening_spring", "nonlinear_spring"),
    )


def knit_frozen(folder: Path, rng: Rng) -> Truth:
    begin = float(round(rng.uniform(12.0, 32.0)))
    _knit(folder, rng, frozen=(begin, begin + 7.0), loggers=(Logger("min"),))
    return Truth(f"the laser repeats one reading from {begin:g} s to {begin + 7.0:g} s of the second recording", SENSOR)


# --- a web between two rolls that wind it either way, FMI 2 Model Exchange; rpm, N; two rates
WEB = OdeModel(
    "web",
    {
        "J_1": (0.05, "kg*m^2"),
        "J_2": (0.03, "kg*m^2"),
        "r_1": (0.12, "m"),
        "r_2": (0.08, "m"),
        "b_1": (0.04, "N*m*s/rad"),
        "b_2": (0.03, "N*m*s/rad"),
        "EA": (2000.0, "N"),
        "span": (1.5, "m"),
        "visc": (25.0, "N*s/m"),
    },
    {"hold": "N*m", "pull": "N*m"},
    {
        "w_1": ("rad/s", "0.0", "(r_1*(EA*ext/span + visc*(r_2*w_2 - r_1*w_1)) - hold - b_1*w_1)/J_1"),
        "w_2": ("rad/s", "0.0", "(pull - r_2*(EA*ext/span + visc*(r_2*w_2 - r_1*w_1)) - b_2*w_2)/J_2"),
        "ext": ("m", "0.0", "r_2*w_2 - r_1*w_1 - fabs(r_2*w_2)*ext/span"),
    },
    {
        "speed_1": ("rad/s", "w_1"),
        "speed_2": ("rad/s", "w_2"),
        "tension": ("N", "EA*ext/span + visc*(r_2*w_2 - r_1*w_1)"),
    },
    1e-3,
)
WEB_KNOWN = {"J_1": 0.04, "J_2": 0.04, "b_1": 0.08, "b_2": 0.08, "EA": 0.05, "visc": 0.1}


def _web(
    folder: Path,
    rng: Rng,
    dry: float = 0.0,
    is_pounds: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    clock: tuple[str, float] | None = None,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The first roll may rub with `dry` N m.

    Tension may be logged in pounds and stated as N, in the second recording.
    """
    WEB.build(folder)
    parts = programme("drives", ("hold", "N*m"), ("pull", "N*m")) + with_numbers("web", "web")
    wires = "  - drives.hold -> web.hold\n  - drives.pull -> web.pull\n"
    scenario(folder, "A web between two rolls", 40.0, 0.02, 0.02, parts, wires)
    data_sheet(folder, WEB, WEB_KNOWN)
    j_1, j_2, r_1, r_2, b_1, b_2, stiff, span, visc = drawn(rng, WEB, WEB_KNOWN)

    def pulled(x: Array) -> Array:
        """Tension [N]; the extension is in mm."""
        return np.asarray(1e-3 * stiff * x[..., 2] / span + visc * (r_2 * x[..., 1] - r_1 * x[..., 0]))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        w_1, w_2, ext = (float(s) for s in x)
        tension = float(pulled(x))
        return [
            (r_1 * tension - float(u[0]) - b_1 * w_1 - dry * np.tanh(w_1 / 0.4)) / j_1,
            (float(u[1]) - r_2 * tension - b_2 * w_2) / j_2,
            1e3 * (r_2 * w_2 - r_1 * w_1) - abs(r_2 * w_2) * ext / span,
        ]

    for number, (name, stop) in enumerate((("first", 40.0), ("second", 90.0), ("third", 32.0))):
        hold = drawn_steps(rng, stop, 3.0, 1.0, 2.6, 0.02)
        if name == "third":
            pull = stairs(rng, stop, 1.6, 0.3, 2.1, 6, 0.02)
        else:
            pull = drawn_steps(rng, stop, 2.4, 0.3, 2.2, 0.02)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (hold, pull), stop, 0.01)
        unit = POUND_FORCE if is_pounds and name == "second" else 1.0

        def load_cell(t: Array, x: Array, u: Array, unit: float = unit) -> Array:
            return np.asarray(pulled(x) / unit)

        sensors = [
            Sensor("web.tension", "LC1_N", "N", load_cell, 0.2, 0.02, noise_stated, 0.05, wild=wild),
            Sensor("web.speed_1", "n Abwickler", "rpm", scaled(0, RPM), 1.2, 0.1, noise_stated, 0.5, wild=wild),
            Sensor("web.speed_2", "n Aufwickler", "rpm", scaled(1, RPM), 1.5, 0.1, noise_stated, 0.5, wild=wild),
        ]
        programmes: Mapping[str, tuple[Steps, str]] = {"drives.hold": (hold, "N*m"), "drives.pull": (pull, "N*m")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))
        if clock is not None:
            second_clock(folder / name, clock[0], clock[1] - 4.0 * number)


def web_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=31.0, jitter=0.2), Logger("s"))
    _web(folder, rng, noise_stated=1.25, wild=0.012, clock=("ms", 8400.0), loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.25 times too large, wild readings, jitter, speeds are of a "
        "logger with another rate and a clock of its own, in ms",
        FINE,
    )


def web_friction(folder: Path, rng: Rng) -> Truth:
    dry = rng.uniform(0.16, 0.26)
    _web(folder, rng, dry=dry, loggers=(PLAIN, Logger("min", zero=2.0)))
    return Truth(
        f"the first roll rubs with {dry:.3f} N m",
        PHYSICS,
        ("dry_friction", "coulomb_friction", "stribeck_friction"),
    )


def web_pounds(folder: Path, rng: Rng) -> Truth:
    _web(folder, rng, is_pounds=True, loggers=(Logger("ms"), PLAIN))
    return Truth("tension is logged in pounds and stated as N, in the second recording", (*RECORDING, *SENSOR))


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    wire_hysteresis,
    finger_null,
    strip_sign,
    suit_transfer,
    valve_null,
    wax_start,
    knit_locking,
    web_pounds,
    finger_creep,
    strip_null,
    suit_clock,
    valve_saturation,
    wax_null,
    knit_frozen,
    web_friction,
    wire_loose,
    finger_two,
    strip_electrolysis,
    suit_null,
    valve_other_run,
    wax_melting,
    knit_null,
    wire_two,
    web_null,
    finger_supply,
)
