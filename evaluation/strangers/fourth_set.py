"""Fourth set: a conveyor, a boiler, a shaft, a vessel, a wall of two FMUs, a vehicle, a fan, an absorber, coils.

Written without a look at the library of laws, its proof or its tests, on the library as it was frozen before;
committed before the first draw. How large an effect is, and how far the numbers are off, is drawn; the deviations of
the numbers are those that a parameter set states, or the 5 % of a rig that states none.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.first_set import FOLDERS, MINUTES, Rng, fmu, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, course, drawn_steps, write
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.truth import FINE, OPEN, PHYSICS, RECORDING, SENSOR, Truth

Spoil = Callable[[str, str, Array, Array], Array]
Rates = Callable[[float, Array, Array], Sequence[float]]


def data_sheet(folder: Path, model: OdeModel, uncertainty: Mapping[str, float]) -> None:
    """A parameter set `numbers.yaml`; numbers that are not in `uncertainty` are held."""
    lines = ["title: From the data sheet"]
    lines.append("parameters:")
    for name, (value, unit) in model.parameters.items():
        text = unit or '"1"'
        known = f"uncertainty: {uncertainty.get(name, 0.0):g}"
        lines.append(f'  {name}: {{value: {value!r}, unit: {text}, source: "data sheet", {known}}}')
    (folder / "numbers.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def scaled(state: int, factor: float) -> Callable[[Array, Array, Array], Array]:
    """Reading of a state in another unit."""
    return lambda t, x, u: np.asarray(factor * x[:, state])


def fahrenheit(state: int) -> Callable[[Array, Array, Array], Array]:
    """Reading of a temperature that is a state [degF]."""
    return lambda t, x, u: np.asarray((x[:, state] - CELSIUS) * 1.8 + 32.0)


def bursts(rng: Rng, stop: float, pause: float, length: float, low: float, high: float, grid: float) -> Steps:
    """Random levels for a while, 0 in between, on a grid of instants [s]."""
    times, levels, t = [0.0], [0.0], 0.0
    while True:
        t += grid * max(1, round(rng.uniform(0.4, 1.6) * pause / grid))
        end = t + grid * max(1, round(rng.uniform(0.5, 1.5) * length / grid))
        if end >= stop:
            return Steps(tuple(times), tuple(levels))
        times += [t, end]
        levels += [float(f"{rng.uniform(low, high):.3g}"), 0.0]
        t = end


def between(steps: Steps, begin: float, end: float, change: Callable[[float], float]) -> Steps:
    """A course that is another between two instants."""
    times = sorted({*steps.times, begin, end})
    levels = [float(v) for v in steps.at(np.asarray(times))]
    return Steps(tuple(times), tuple(change(v) if begin <= t < end else v for t, v in zip(times, levels)))


def chosen(
    rates: Rates,
    start: Sequence[float],
    others: Sequence[Steps],
    stop: float,
    step: float,
    looks: Sequence[float],
    choose: Callable[[float, Array, float], float],
) -> Steps:
    """An input that somebody chooses at instants from what he sees; it is the first of the inputs (Euler's method)."""
    x, times, levels, due = np.asarray(start, dtype=float), [0.0], [choose(0.0, np.asarray(start), 0.0)], list(looks)
    for t in np.arange(0.0, stop, step):
        if due and t >= due[0] - 1e-9:
            due.pop(0)
            level = choose(float(t), x, levels[-1])
            if level != levels[-1] and t > 0:
                times.append(float(t))
                levels.append(level)
        u = np.asarray([levels[-1], *(float(s.at(np.asarray([t]))[0]) for s in others)])
        x = x + step * np.asarray(rates(float(t), x, u))
    return Steps(tuple(times), tuple(levels))


# --- a belt conveyor, FMI 2 Model Exchange; m/min; drive and load are columns of the log
CONVEYOR = OdeModel(
    "conveyor",
    {"M": (180.0, "kg"), "c": (120.0, "N*s/m"), "f": (0.25, "m/s^2")},
    {"drive": "N", "load": "kg"},
    {"v": ("m/s", "0.0", "(drive - c*v - f*load*tanh(v/0.02))/(M + load)")},
    {"speed": ("m/s", "v")},
    1e-3,
)


def _conveyor(
    folder: Path, rng: Rng, bearings: float = 0.0, splice: float = 0.0, noise_stated: float | None = 1.0
) -> None:
    CONVEYOR.build(folder)
    stop = 120.0
    parts = programme("panel", ("drive", "N")) + programme("hopper", ("load", "kg")) + fmu("belt", "conveyor")
    wires = "  - panel.drive -> belt.drive\n  - hopper.load -> belt.load\n"
    scenario(folder, "A belt conveyor", stop, 0.1, 0.2, parts, wires)
    m, c, f = drawn(rng, CONVEYOR)
    turn = 11.4

    def rates(t: float, x: Array, u: Array) -> tuple[float, float]:
        v, s = float(x[0]), float(x[1])
        drag = c * v + (f * float(u[1]) + bearings) * np.tanh(v / 0.02)
        if s % turn < 0.7:
            drag += splice * np.tanh(v / 0.02)
        return (float(u[0]) - drag) / (m + float(u[1])), v

    for name in FOLDERS:
        drive = drawn_steps(rng, stop, 6.0, 20.0, 420.0, 0.2)
        for i in range(2, len(drive.levels), 4):
            drive = between(drive, drive.times[i], (*drive.times, stop)[i + 1], lambda v: 0.0)
        load = drawn_steps(rng, stop, 15.0, 0.0, 120.0, 0.2)
        t, x = course(rates, (0.0, rng.uniform(0.0, turn)), (drive, load), stop, 0.01)
        sensors = [Sensor("belt.speed", "belt_m_min", "m/min", scaled(0, 60.0), 0.6, 0.2, noise_stated, 0.1)]
        programmes = {"panel.drive": (drive, "N"), "hopper.load": (load, "kg")}
        write(
            folder / name,
            rng,
            Written(t, x, sensors, programmes, Logger("s", empty=0.01), recorded=["panel.drive", "hopper.load"]),
        )


def conveyor_null(folder: Path, rng: Rng) -> Truth:
    _conveyor(folder, rng, noise_stated=None)
    return Truth("nothing; numbers 5 % off, noise is not stated", FINE)


def conveyor_friction(folder: Path, rng: Rng) -> Truth:
    force = rng.uniform(35.0, 60.0)
    _conveyor(folder, rng, bearings=force)
    return Truth(f"dry friction of the bearings of {force:.1f} N", PHYSICS, ("dry_friction", "stribeck_friction"))


def conveyor_splice(folder: Path, rng: Rng) -> Truth:
    force = rng.uniform(180.0, 260.0)
    _conveyor(folder, rng, splice=force)
    return Truth(
        f"the belt's splice rubs: {force:.0f} N more for 0.7 m of each 11.4 m of belt, from an unknown place on",
        PHYSICS,
    )


# --- a boiler of two layers, FMI 3, both interfaces; a thermostat switches 2 kW; degC, min, decimal commas
BOILER = OdeModel(
    "boiler",
    {
        "C": (1.67e5, "J/K"),
        "cp": (4186.0, "J/(kg*K)"),
        "mix": (150.0, "W/K"),
        "ua": (1.4, "W/K"),
        "T_begin": (318.15, "K"),
    },
    {"power": "W", "draw": "kg/s", "cold": "K", "room": "K"},
    {
        "T_low": ("K", "T_begin", "(power + draw*cp*(cold - T_low) + mix*(T_up - T_low) - ua*(T_low - room))/C"),
        "T_up": ("K", "T_begin", "(draw*cp*(T_low - T_up) - mix*(T_up - T_low) - ua*(T_up - room))/C"),
    },
    {"lower": ("K", "T_low"), "upper": ("K", "T_up")},
    5.0,
)
BOILER_KNOWN = {"C": 0.04, "mix": 0.15, "ua": 0.25}


def _boiler(
    folder: Path,
    rng: Rng,
    loop: float = 0.0,
    clamp: float = 0.0,
    jet: float = 0.0,
    gallons: bool = False,
    look: float = 30.0,
    logger: Logger = MINUTES,
    integrator: str = "cvode",
    noise_stated: float | None = 1.0,
) -> None:
    build3(BOILER, folder)
    stop = 6 * 3600.0
    parts = (
        programme("relay", ("power", "W"))
        + programme("tap", ("draw", "kg/min"))
        + programme("cellar", ("cold", "K"), ("room", "K"))
        + with_numbers("tank", "boiler", integrator)
    )
    wires = (
        "  - relay.power -> tank.power\n  - tap.draw -> tank.draw\n"
        "  - cellar.cold -> tank.cold\n  - cellar.room -> tank.room\n"
    )
    scenario(folder, "A boiler with a thermostat", stop, 10, 30, parts, wires)
    data_sheet(folder, BOILER, BOILER_KNOWN)
    c, cp, mix, ua, begin = drawn(rng, BOILER, BOILER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        low, up, pipe = (float(v) for v in x)
        power, draw, cold, room = (float(v) for v in u)
        draw /= 60.0
        between_layers = (mix + jet * (draw / 0.1) ** 2) * (up - low)
        lost = loop * max(up - room, 0.0) ** 1.5
        return [
            (power + draw * cp * (cold - low) + between_layers - ua * (low - room)) / c,
            (draw * cp * (low - up) - between_layers - ua * (up - room) - lost) / c,
            (up - pipe) / clamp if clamp else 0.0,
        ]

    for name in FOLDERS:
        draw = bursts(rng, stop, 1500.0, 300.0, 1.5, 7.0, look)
        cold = Steps((0.0,), (round(rng.uniform(281.0, 286.0), 1),))
        room = Steps((0.0,), (round(rng.uniform(288.0, 294.0), 1),))
        wanted = drawn_steps(rng, stop, 5400.0, 320.0, 340.0, 10.0)

        def thermostat(t: float, x: Array, now: float, wanted: Steps = wanted) -> float:
            goal = float(wanted.at(np.asarray([t]))[0])
            return 2000.0 if x[0] < goal - 1.5 or (now > 0 and x[0] < goal + 1.5) else 0.0

        start, looks = [begin] * 3, np.arange(0.0, stop, look)
        power = chosen(rates, start, (draw, cold, room), stop, 10.0, list(looks), thermostat)
        t, x = course(rates, start, (power, draw, cold, room), stop, 5.0)
        sensors = [
            Sensor("tank.lower", "T_unten", "degC", celsius(0), 0.15, 30.0, noise_stated, 0.1),
            Sensor("tank.upper", "T_oben", "degC", celsius(2 if clamp else 1), 0.15, 30.0, noise_stated, 0.1),
        ]
        told = {"tap.draw": Steps(draw.times, tuple(round(v / 3.785, 3) for v in draw.levels))} if gallons else {}
        write(
            folder / name,
            rng,
            Written(
                t,
                x,
                sensors,
                {
                    "relay.power": (power, "W"),
                    "tap.draw": (draw, "kg/min"),
                    "cellar.cold": (cold, "K"),
                    "cellar.room": (room, "K"),
                },
                logger,
                recorded=["relay.power", "tap.draw"],
                told=told,
            ),
        )


def boiler_null(folder: Path, rng: Rng) -> Truth:
    _boiler(folder, rng, logger=Logger("min", is_comma=True, empty=0.02), integrator="internal", look=10.0)
    return Truth(
        "nothing; numbers off as stated, decimal commas, Co-Simulation; inputs change each 10 s, logged each 30 s",
        FINE,
    )


def boiler_two(folder: Path, rng: Rng) -> Truth:
    loop, clamp = rng.uniform(0.6, 1.0), rng.uniform(150.0, 260.0)
    _boiler(folder, rng, loop=loop, clamp=clamp)
    return Truth(
        f"a loop through an open check valve cools the upper layer by {loop:.2f} W/K^1.5 times the power 1.5 of the "
        f"difference to the room; the upper thermometer is clamped on and lags by {clamp:.0f} s",
        (*PHYSICS, *SENSOR),
        ("sensor_lag", "natural_convection", "convection_rise", "heat_loss", "radiation"),
    )


def boiler_jet(folder: Path, rng: Rng) -> Truth:
    jet = rng.uniform(500.0, 900.0)
    _boiler(folder, rng, jet=jet, look=10.0)
    return Truth(
        f"the inlet's jet mixes the layers: {jet:.0f} W/K times (draw over 6 kg/min) squared; inputs as in the null",
        PHYSICS,
    )


def boiler_gallons(folder: Path, rng: Rng) -> Truth:
    _boiler(folder, rng, gallons=True)
    return Truth("the draw is logged in US gallons and stated as kg: 3.785 too little", (*RECORDING, *SENSOR))


# --- two inertias and a flexible shaft, FMI 3 Model Exchange, without units
SHAFT = OdeModel(
    "shaft",
    {"J1": (0.02, ""), "J2": (0.05, ""), "k": (60.0, ""), "d": (0.05, ""), "b1": (0.02, ""), "b2": (0.05, "")},
    {"torque": ""},
    {
        "w1": ("", "0.0", "(torque - k*phi - d*(w1 - w2) - b1*w1)/J1"),
        "w2": ("", "0.0", "(k*phi + d*(w1 - w2) - b2*w2)/J2"),
        "phi": ("", "0.0", "w1 - w2"),
    },
    {"motor": ("", "w1"), "driven": ("", "w2")},
    5e-4,
)


def _shaft(
    folder: Path,
    rng: Rng,
    play: float = 0.0,
    dry: float = 0.0,
    air: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
) -> None:
    build3(SHAFT, folder, has_co_simulation=False)
    stop = 6.0
    parts = programme("servo", ("torque", "")) + fmu("train", "shaft")
    scenario(folder, "Two inertias and a shaft", stop, 2e-3, 4e-3, parts, "  - servo.torque -> train.torque\n")
    j1, j2, k, d, b1, b2 = drawn(rng, SHAFT)

    def rates(t: float, x: Array, u: Array) -> tuple[float, float, float]:
        w1, w2, phi = (float(v) for v in x)
        twist = phi - min(max(phi, -play), play)
        through = k * twist + (d * (w1 - w2) if twist or not play else 0.0)
        load = b2 * w2 + dry * np.tanh(w2 / 0.05) + air * w2 * abs(w2)
        return (float(u[0]) - through - b1 * w1) / j1, (through - load) / j2, w1 - w2

    other = drawn_steps(rng, stop, 0.3, -3.0, 3.0, 2e-3)
    for name in FOLDERS:
        torque = drawn_steps(rng, stop, 0.3, -3.0, 3.0, 2e-3)
        t, x = course(rates, (0.0, 0.0, 0.0), (torque,), stop, 2.5e-4)
        sensors = [
            Sensor("train.motor", "n1", "1", scaled(0, 1.0), 0.15, 4e-3, noise_stated, 0.05),
            Sensor("train.driven", "n2", "1", scaled(1, 1.0), 0.15, 8e-3, noise_stated),
        ]
        told = {"servo.torque": other} if is_other and name == "second" else {}
        made = Written(t, x, sensors, {"servo.torque": (torque, "")}, Logger("ms", zero=730.0, jitter=0.1), told=told)
        write(folder / name, rng, made)


def shaft_null(folder: Path, rng: Rng) -> Truth:
    _shaft(folder, rng, noise_stated=1.4)
    return Truth("nothing; numbers 5 % off, noise stated 1.4 times too large, no units", FINE)


def shaft_backlash(folder: Path, rng: Rng) -> Truth:
    play = rng.uniform(0.012, 0.02)
    _shaft(folder, rng, play=play)
    return Truth(f"backlash of {play:.4f} rad to either side in the coupling", PHYSICS, ("backlash", "dead_zone"))


def shaft_two(folder: Path, rng: Rng) -> Truth:
    dry, air = rng.uniform(0.35, 0.6), rng.uniform(1.5e-3, 2.5e-3)
    _shaft(folder, rng, dry=dry, air=air)
    return Truth(
        f"at the driven inertia dry friction of {dry:.3f} N m and drag of {air:.5f} N m s^2",
        PHYSICS,
        ("dry_friction", "stribeck_friction", "quadratic_drag"),
    )


def shaft_other_run(folder: Path, rng: Rng) -> Truth:
    _shaft(folder, rng, is_other=True)
    return Truth("the second recording states the torque of another run", RECORDING)


# --- a pressure vessel between two proportional valves, FMI 2 Co-Simulation; bar, %, l/min
VESSEL = OdeModel(
    "vessel",
    {"V": (0.012, "m^3"), "g_in": (1.1e-3, "m^3/s"), "g_out": (0.9e-3, "m^3/s")},
    {"supply": "Pa", "valve": "1", "vent": "1"},
    {"p": ("Pa", "0.0", "(g_in*valve*(supply - p) - g_out*vent*p)/V")},
    {"pressure": ("Pa", "p"), "inflow": ("m^3/s", "g_in*valve*(supply - p)/101325.0")},
    2e-3,
)
VESSEL_KNOWN = {"V": 0.03, "g_in": 0.08, "g_out": 0.08}


def _vessel(
    folder: Path,
    rng: Rng,
    leak: float = 0.0,
    raised: tuple[float, float, float] | None = None,
    integrator: str = "internal",
) -> None:
    VESSEL.build(folder)
    stop = 240.0
    parts = (
        programme("compressor", ("supply", "bar"))
        + programme("plc", ("valve", "'%'"), ("vent", "'%'")).replace("0 '%'", "0 %")
        + with_numbers("vessel", "vessel", integrator)
    )
    wires = "  - compressor.supply -> vessel.supply\n  - plc.valve -> vessel.valve\n  - plc.vent -> vessel.vent\n"
    scenario(folder, "A vessel between two valves", stop, 0.1, 0.2, parts, wires)
    data_sheet(folder, VESSEL, VESSEL_KNOWN)
    volume, g_in, g_out = drawn(rng, VESSEL, VESSEL_KNOWN)

    def flow(p: Array | float, u: Array) -> Array:
        return np.asarray(g_in * 0.01 * u[..., 1] * (1e5 * u[..., 0] - p))

    def rates(t: float, x: Array, u: Array) -> tuple[float]:
        p = float(x[0])
        return ((float(flow(p, u)) - g_out * 0.01 * float(u[2]) * p - leak * p) / volume,)

    for name in FOLDERS:
        supply = Steps((0.0,), (6.0,))
        valve = bursts(rng, stop, 8.0, 8.0, 15.0, 90.0, 0.2)
        vent = bursts(rng, stop, 16.0, 5.0, 10.0, 80.0, 0.2)
        real = supply
        if raised is not None and name == "second":
            real = between(supply, raised[0], raised[1], lambda v: v + raised[2])
        t, x = course(rates, (0.0,), (real, valve, vent), stop, 0.02)
        sensors = [
            Sensor("vessel.pressure", "p_bar", "bar", scaled(0, 1e-5), 0.02, 0.2, 1.0, 0.01),
            Sensor(
                "vessel.inflow",
                "Q_l_min",
                "l/min",
                lambda t, x, u: 6e4 * flow(x[:, 0], u) / 101325.0,
                2.0,
                0.4,
                1.0,
                0.5,
            ),
        ]
        programmes = {"compressor.supply": (real, "bar"), "plc.valve": (valve, "%"), "plc.vent": (vent, "%")}
        told = {"compressor.supply": supply} if real is not supply else {}
        write(folder / name, rng, Written(t, x, sensors, programmes, told=told, recorded=["plc.valve", "plc.vent"]))


def vessel_leak(folder: Path, rng: Rng) -> Truth:
    leak = rng.uniform(4e-5, 7e-5)
    _vessel(folder, rng, leak=leak, integrator="cvode")
    return Truth(f"a leak of {leak:.3g} m^3/s times the pressure", PHYSICS, ("leakage",))


def vessel_supply(folder: Path, rng: Rng) -> Truth:
    begin, more = float(round(rng.uniform(70, 110))), round(rng.uniform(1.2, 2.0), 1)
    _vessel(folder, rng, raised=(begin, begin + 60.0, more))
    return Truth(
        f"the supply was {more} bar higher than stated, {begin:.0f} s to {begin + 60:.0f} s of the second recording",
        SENSOR,
        ("input_fault",),
    )


# --- a wall: bricks (FMI 2, Model Exchange) and a panel of insulation (FMI 3, Co-Simulation); hours
BRICKS = OdeModel(
    "bricks",
    {
        "C_b": (1.3e5, "J/(m^2*K)"),
        "U_out": (16.0, "W/(m^2*K)"),
        "U_b": (6.5, "W/(m^2*K)"),
        "U_joint": (1.1, "W/(m^2*K)"),
        "T_begin": (281.15, "K"),
    },
    {"outdoor": "K", "panel": "K"},
    {
        "T1": ("K", "T_begin", "(U_out*(outdoor - T1) - U_b*(T1 - T2))/C_b"),
        "T2": ("K", "T_begin", "(U_b*(T1 - T2) - U_joint*(T2 - panel))/C_b"),
    },
    {"outer": ("K", "T1"), "joint": ("K", "T2"), "heat": ("W/m^2", "U_joint*(T2 - panel)")},
)
PANEL = OdeModel(
    "panel",
    {
        "C_p": (1.4e4, "J/(m^2*K)"),
        "C_i": (1.8e4, "J/(m^2*K)"),
        "U_p": (1.6, "W/(m^2*K)"),
        "U_in": (7.7, "W/(m^2*K)"),
        "T_begin": (288.15, "K"),
    },
    {"heat": "W/m^2", "indoor": "K"},
    {
        "T3": ("K", "T_begin", "(heat - U_p*(T3 - T4))/C_p"),
        "T4": ("K", "T_begin", "(U_p*(T3 - T4) + U_in*(indoor - T4))/C_i"),
    },
    {"back": ("K", "T3"), "inner": ("K", "T4")},
    60.0,
)


def _wall(
    folder: Path,
    rng: Rng,
    sun: float = 0.0,
    off: float = 0.0,
    noise_stated: float | None = 1.0,
    rate: float = 1.0,
) -> None:
    BRICKS.build(folder)
    build3(PANEL, folder)
    stop = 60 * 3600.0
    parts = (
        programme("weather", ("outdoor", "K"))
        + programme("heating", ("indoor", "K"))
        + fmu("bricks", "bricks")
        + fmu("panel", "panel", "internal")
    )
    wires = (
        "  - weather.outdoor -> bricks.outdoor\n  - panel.back -> bricks.panel\n"
        "  - bricks.heat -> panel.heat\n  - heating.indoor -> panel.indoor\n"
    )
    scenario(folder, "A wall of two layers", stop, 120, 600, parts, wires)
    c_b, u_out, u_b, u_joint, _ = drawn(rng, BRICKS)
    c_p, c_i, u_p, u_in, _ = drawn(rng, PANEL)

    for name in FOLDERS:
        cloud = rng.uniform(0.6, 1.0)

        def rates(t: float, x: Array, u: Array, cloud: float = cloud) -> list[float]:
            a, b, c, d = (float(v) for v in x)
            hour = (t / 3600.0) % 24.0
            shine = sun * cloud * max(np.sin(np.pi * (hour - 8.0) / 10.0), 0.0) if 8.0 < hour < 18.0 else 0.0
            return [
                (u_out * (u[0] - a) - u_b * (a - b) + shine) / c_b,
                (u_b * (a - b) - u_joint * (b - c)) / c_b,
                (u_joint * (b - c) - u_p * (c - d)) / c_p,
                (u_p * (c - d) + u_in * (u[1] - d)) / c_i,
            ]

        quarter = 900.0 * np.arange(round(stop / 900.0))
        slow = np.cumsum(rng.normal(size=len(quarter))) * 0.15
        air = 279.0 + rng.uniform(-3, 3) + 4.5 * np.sin(2 * np.pi * (quarter / 3600.0 - 9.0) / 24.0) + slow
        outdoor = Steps(tuple(quarter.tolist()), tuple(float(round(v, 1)) for v in air))
        indoor = drawn_steps(rng, stop, 8 * 3600.0, 289.0, 296.0, 600.0)
        t, x = course(rates, (281.15, 281.15, 288.15, 288.15), (outdoor, indoor), stop, 60.0)
        sensors = [
            Sensor("bricks.outer", "aussen", "degC", celsius(0), 0.08, 600.0, noise_stated, 0.0625),
            Sensor("bricks.joint", "fuge", "degC", celsius(1), 0.08, 600.0, noise_stated, 0.0625),
            Sensor("panel.inner", "innen", "degC", celsius(3), 0.08, 600.0, noise_stated, 0.0625),
        ]

        def spoil(column: str, t: Array, v: Array) -> Array:
            return v + off if column == "innen" else v

        programmes = {"weather.outdoor": (outdoor, "K"), "heating.indoor": (indoor, "K")}
        made = Written(
            t,
            x,
            sensors,
            programmes,
            Logger("h", rate=rate),
            recorded=["weather.outdoor", "heating.indoor"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def wall_null(folder: Path, rng: Rng) -> Truth:
    _wall(folder, rng, noise_stated=0.4, rate=1.0005)
    return Truth("nothing; numbers 5 % off, noise stated 2.5 times too small, clock 0.05 % fast", (*FINE, *OPEN))


def wall_sun(folder: Path, rng: Rng) -> Truth:
    sun = rng.uniform(120.0, 200.0)
    _wall(folder, rng, sun=sun)
    return Truth(f"the sun on the bricks from hour 8 to 18 of each day, {sun:.0f} W/m^2 times 0.6 to 1 by day", PHYSICS)


def wall_offset(folder: Path, rng: Rng) -> Truth:
    off = rng.uniform(1.4, 2.2)
    _wall(folder, rng, off=off)
    return Truth(f"the inner thermometer reads {off:.2f} K too much in all recordings", (*SENSOR, *RECORDING))


# --- a vehicle along a road, FMI 2 Model Exchange; km/h, force and grade at 5 Hz, distance at 1 Hz
VEHICLE = OdeModel(
    "vehicle",
    {"m": (1450.0, "kg"), "c": (22.0, "N*s/m"), "g": (9.81, "m/s^2")},
    {"force": "N", "grade": "1"},
    {"v": ("m/s", "0.0", "(force - c*v)/m - g*grade"), "s": ("m", "0.0", "v")},
    {"speed": ("m/s", "v"), "distance": ("m", "s")},
    1e-2,
)
VEHICLE_KNOWN = {"m": 0.06, "c": 0.3}


def _vehicle(folder: Path, rng: Rng, air: float = 0.0, rolling: float = 0.0, in_miles: bool = False) -> None:
    VEHICLE.build(folder)
    stop = 300.0
    parts = (
        programme("can", ("force", "kN"))
        + programme("map", ("grade", "'%'")).replace("0 '%'", "0 %")
        + with_numbers("car", "vehicle")
    )
    scenario(folder, "A vehicle", stop, 0.1, 0.5, parts, "  - can.force -> car.force\n  - map.grade -> car.grade\n")
    data_sheet(folder, VEHICLE, VEHICLE_KNOWN)
    m, c, g = drawn(rng, VEHICLE, VEHICLE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> tuple[float, float]:
        v = float(x[0])
        resistance = c * v + air * v * abs(v) + rolling * np.tanh(v / 0.1)
        return (1e3 * float(u[0]) - resistance) / m - g * 0.01 * float(u[1]), v

    for name in FOLDERS:
        grade = drawn_steps(rng, stop, 40.0, -2.0, 3.0, 1.0)
        wanted = drawn_steps(rng, stop, 35.0, 6.0, 34.0, 1.0)
        looks = 0.2 * np.round(np.cumsum(rng.uniform(2.0, 6.0, 120)) / 0.2)

        def driver(t: float, x: Array, now: float, wanted: Steps = wanted) -> float:
            pull = 0.9 * (float(wanted.at(np.asarray([t]))[0]) - float(x[0]))
            return round(min(max(pull, -3.5 if x[0] > 3.0 else 0.0), 3.0), 2)

        force = chosen(rates, (0.0, 0.0), (grade,), stop, 0.1, [0.0, *looks], driver)
        t, x = course(rates, (0.0, 0.0), (force, grade), stop, 0.05)
        speed = 3.6 / 1.609344 if in_miles and name == "second" else 3.6
        sensors = [
            Sensor("car.speed", "v_kmh", "km/h", scaled(0, speed), 0.25, 0.2, 1.0, 0.1),
            Sensor("car.distance", "s_m", "m", scaled(1, 1.0), 3.0, 1.0, 1.0, 1.0),
        ]
        programmes = {"can.force": (force, "kN"), "map.grade": (grade, "%")}
        write(folder / name, rng, Written(t, x, sensors, programmes, recorded=["can.force", "map.grade"]))


def vehicle_two(folder: Path, rng: Rng) -> Truth:
    air, rolling = rng.uniform(0.35, 0.55), rng.uniform(150.0, 220.0)
    _vehicle(folder, rng, air=air, rolling=rolling)
    return Truth(
        f"drag of the air of {air:.3f} N s^2/m^2 and rolling resistance of {rolling:.0f} N",
        PHYSICS,
        ("quadratic_drag", "dry_friction", "stribeck_friction"),
    )


def vehicle_miles(folder: Path, rng: Rng) -> Truth:
    _vehicle(folder, rng, in_miles=True)
    return Truth("the speed of the second recording is in mph and stated as km/h", (*RECORDING, *SENSOR))


# --- a fan and its duct, FMI 3 Model Exchange; rpm, A, Pa
FAN = OdeModel(
    "fan",
    {
        "R": (1.1, "ohm"),
        "L": (3e-3, "H"),
        "K": (0.06, "V*s/rad"),
        "J": (4e-4, "kg*m^2"),
        "b": (1e-4, "N*m*s/rad"),
        "tau": (9.3e-3, "Pa*s^2/rad^2"),
        "r": (2000.0, "Pa*s/m^3"),
        "z": (2.5e4, "Pa*s^2/m^6"),
        "I": (360.0, "Pa*s^2/m^3"),
    },
    {"u": "V", "damper": "1"},
    {
        "i": ("A", "0.0", "(u - R*i - K*w)/L"),
        "w": ("rad/s", "0.0", "(K*i - b*w - tau*w*q)/J"),
        "q": ("m^3/s", "0.0", "(tau*w*w - r*q - z*damper*q*fabs(q))/I"),
    },
    {"current": ("A", "i"), "speed": ("rad/s", "w"), "pressure": ("Pa", "tau*w*w - r*q")},
    5e-4,
)
FAN_KNOWN = {"R": 0.03, "K": 0.02, "J": 0.06, "b": 0.3, "tau": 0.05, "r": 0.08, "z": 0.08, "I": 0.1}


def _fan(folder: Path, rng: Rng, copper: float = 0.0, stall: float = 0.0) -> None:
    build3(FAN, folder, has_co_simulation=False)
    stop = 90.0
    parts = programme("source", ("u", "V")) + programme("flap", ("damper", "")) + with_numbers("fan", "fan")
    scenario(
        folder, "A fan and its duct", stop, 0.01, 0.05, parts, "  - source.u -> fan.u\n  - flap.damper -> fan.damper\n"
    )
    data_sheet(folder, FAN, FAN_KNOWN)
    r, inductance, k, j, b, tau, duct, z, inertia = drawn(rng, FAN, FAN_KNOWN)

    def rise(w: Array, q: Array) -> Array:
        near = np.exp(-(((q / np.maximum(w, 1.0) - 2.3e-4) / 0.35e-4) ** 2))
        return np.asarray(tau * w * w * (1.0 - stall * near))

    def rates(t: float, x: Array, u: Array) -> tuple[float, float, float, float]:
        i, w, q, warm = (float(v) for v in x)
        now = r * (1.0 + copper * warm)
        lift = float(rise(np.asarray(w), np.asarray(q)))
        return (
            (float(u[0]) - now * i - k * w) / inductance,
            (k * i - b * w - tau * w * q) / j,
            (lift - duct * q - z * float(u[1]) * q * abs(q)) / inertia,
            (now * i * i - warm / 35.0) / 0.6,
        )

    for name in FOLDERS:
        volt, damper = drawn_steps(rng, stop, 4.0, 4.0, 14.0, 0.05), drawn_steps(rng, stop, 7.0, 0.8, 8.0, 0.05)
        t, x = course(rates, (0.0, 0.0, 0.0, 0.0), (volt, damper), stop, 1e-3)
        sensors = [
            Sensor("fan.current", "I_A", "A", scaled(0, 1.0), 0.01, 0.05, 1.0, 0.01),
            Sensor("fan.speed", "n_rpm", "rpm", scaled(1, 30.0 / np.pi), 3.0, 0.05, 1.0, 1.0),
            Sensor(
                "fan.pressure", "dp_Pa", "Pa", lambda t, x, u: rise(x[:, 1], x[:, 2]) - duct * x[:, 2], 3.0, 0.1, 1.0
            ),
        ]
        programmes = {"source.u": (volt, "V"), "flap.damper": (damper, "")}
        write(folder / name, rng, Written(t, x, sensors, programmes, Logger("s", zero=-3.0)))


def fan_warm(folder: Path, rng: Rng) -> Truth:
    _fan(folder, rng, copper=0.0039)
    return Truth(
        "the winding heats itself: 0.0039 1/K, 35 K/W, 21 s",
        PHYSICS,
        ("self_heating_resistance", "temperature_dependent_resistance", "resistance_of_temperature"),
    )


def fan_stall(folder: Path, rng: Rng) -> Truth:
    depth = rng.uniform(0.3, 0.4)
    _fan(folder, rng, stall=depth)
    return Truth(f"the fan stalls: its pressure falls by {100 * depth:.0f} % near one ratio of flow to speed", PHYSICS)


# --- a structure with an absorber, FMI 2, both interfaces; mm
ABSORBER = OdeModel(
    "absorber",
    {
        "m1": (40.0, "kg"),
        "k1": (9000.0, "N/m"),
        "c1": (25.0, "N*s/m"),
        "m2": (3.0, "kg"),
        "k2": (600.0, "N/m"),
        "c2": (9.0, "N*s/m"),
    },
    {"force": "N"},
    {
        "x1": ("m", "0.0", "v1"),
        "v1": ("m/s", "0.0", "(force - k1*x1 - c1*v1 + k2*(x2 - x1) + c2*(v2 - v1))/m1"),
        "x2": ("m", "0.0", "v2"),
        "v2": ("m/s", "0.0", "(-k2*(x2 - x1) - c2*(v2 - v1))/m2"),
    },
    {"floor": ("m", "x1"), "mass": ("m", "x2")},
    1e-3,
)
STRUCTURE = OdeModel(
    "structure",
    {"m1": (40.0, "kg"), "k1": (9000.0, "N/m"), "c1": (25.0, "N*s/m")},
    {"force": "N"},
    {"x1": ("m", "0.0", "v1"), "v1": ("m/s", "0.0", "(force - k1*x1 - c1*v1)/m1")},
    {"floor": ("m", "x1")},
    1e-3,
)


def _absorber(
    folder: Path,
    rng: Rng,
    hardening: float = 0.0,
    stuck: tuple[float, float] | None = None,
    is_told: bool = True,
    noise_stated: float | None = 1.0,
    integrator: str = "cvode",
) -> None:
    model = ABSORBER if is_told else STRUCTURE
    model.build(folder)
    stop = 30.0
    parts = programme("shaker", ("force", "N")) + fmu("plant", model.name, integrator)
    scenario(folder, "A floor on a shaker", stop, 5e-3, 0.02, parts, "  - shaker.force -> plant.force\n")
    m1, k1, c1, m2, k2, c2 = drawn(rng, ABSORBER)

    def rates(t: float, x: Array, u: Array) -> tuple[float, float, float, float]:
        a, va, b, vb = (float(v) for v in x)
        z = b - a
        spring = k2 * z * (1.0 + hardening * z * z) + c2 * (vb - va)
        return va, (float(u[0]) - k1 * a - c1 * va + spring) / m1, vb, -spring / m2

    for name in FOLDERS:
        force = drawn_steps(rng, stop, 0.3, -70.0, 70.0, 5e-3)
        t, x = course(rates, (0.0, 0.0, 0.0, 0.0), (force,), stop, 2.5e-3)
        sensors = [Sensor("plant.floor", "floor_mm", "mm", scaled(0, 1e3), 0.08, 0.02, noise_stated, 0.02)]
        if is_told:
            sensors.append(Sensor("plant.mass", "mass_mm", "mm", scaled(2, 1e3), 0.2, 0.04, noise_stated, 0.05))

        def spoil(column: str, t: Array, v: Array, name: str = name) -> Array:
            if stuck is None or name != "second" or column != "mass_mm":
                return v
            held = (t > stuck[0]) & (t < stuck[1])
            return np.where(held, v[np.argmax(held)], v)

        write(
            folder / name,
            rng,
            Written(
                t, x, sensors, {"shaker.force": (force, "N")}, Logger("s", zero=100.0, gap=(17.0, 17.6)), spoil=spoil
            ),
        )


def absorber_null(folder: Path, rng: Rng) -> Truth:
    _absorber(folder, rng, noise_stated=None, integrator="internal")
    return Truth("nothing; numbers 5 % off, noise is not stated, a gap, Co-Simulation", FINE)


def absorber_hard(folder: Path, rng: Rng) -> Truth:
    size = rng.uniform(0.12, 0.25) / 0.03**2
    _absorber(folder, rng, hardening=size)
    return Truth(
        f"the absorber's spring hardens with the cube of its stretch: {size:.0f} 1/m^2",
        PHYSICS,
        ("cubic_spring", "hardening_spring", "nonlinear_spring"),
    )


def absorber_untold(folder: Path, rng: Rng) -> Truth:
    _absorber(folder, rng, is_told=False)
    return Truth(
        "a second mass on a spring, 3 kg at 2.2 Hz, which the model does not have", PHYSICS, ("second_mass", "absorber")
    )


def absorber_stuck(folder: Path, rng: Rng) -> Truth:
    begin = rng.uniform(7.0, 12.0)
    _absorber(folder, rng, stuck=(begin, begin + 3.5))
    return Truth(f"the laser of the mass is stuck for 3.5 s from {begin:.2f} s of the second recording", SENSOR)


# --- coils of the tool's own kind: a board of two strings in a room of its own; one coil with a weight
COIL_C, COIL_G = 7.328e-9 * 6450 * 837, 90 * 97.85e-6
COILS_PARAMETERS = "parameters: {use_regressed_cooling_rate: false}"


def _board(folder: Path, rng: Rng) -> None:
    """Two coils in series beside one of its own; thermometers in degF, a clamp in A."""
    stop = 120.0
    scenario(
        folder,
        "A board of three coils",
        stop,
        0.05,
        0.1,
        "  supply:\n    kind: programme\n    outputs:\n      voltage: {unit: V, constant: 0 V}\n"
        "  room:\n    kind: programme\n    outputs:\n      temperature: {unit: K, constant: 22 degC}\n"
        "  circuit: {kind: ngspice, strings: [2, 1], supply: common, start: {resistance: 2.2 ohm}}\n"
        "  actuator: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room,\n"
        f"    {COILS_PARAMETERS}}}\n",
        "  - supply.voltage -> circuit.supply_voltage\n",
    )
    own = np.exp(0.035 * rng.standard_normal((3, 3)))
    r = 2.2 * np.exp(0.03 * rng.normal()) * own[0]
    c, h = COIL_C * np.exp(0.05 * rng.normal()) * own[1], COIL_G * np.exp(0.05 * rng.normal()) * own[2]

    def currents(v: Array) -> Array:
        pair = v / (r[0] + r[1])
        return np.stack([pair, pair, v / r[2]], axis=-1)

    for name in FOLDERS:
        volt = drawn_steps(rng, stop, 15.0, 0.0, 1.0, 0.1)
        room = float(f"{rng.uniform(18, 25):.1f}")
        real = room + CELSIUS + 0.4 * rng.normal()

        def rates(t: float, x: Array, u: Array, real: float = real) -> Array:
            return np.asarray((currents(np.asarray(u[0])) ** 2 * r - h * (x - real)) / c)

        t, x = course(rates, [real] * 3, (volt,), stop, 0.02)
        sensors = [
            Sensor(
                f"coil[{place}].temperature",
                f"TC{i + 1}_F",
                "degF",
                fahrenheit(i),
                0.4,
                0.5,
                1.0,
                0.1,
            )
            for i, place in enumerate(("1,1", "1,2", "2,1"))
        ]
        sensors.append(
            Sensor(
                "supply.current",
                "clamp",
                "A",
                lambda t, x, u: np.asarray(u[:, 0] / (r[0] + r[1]) + u[:, 0] / r[2]),
                0.004,
                0.5,
                1.0,
                0.001,
            )
        )
        conditions = {
            "room": {"outputs": {"temperature": {"constant": f"{room} degC"}}},
            "actuator": {"parameters": {"initial_temperature": f"{room} degC"}},
        }
        made = Written(
            t,
            x,
            sensors,
            {"supply.voltage": (volt, "V")},
            Logger("s", zero=12.0),
            sidecar={"components": conditions, "uncertain": {"room.temperature": "0.5 K"}},
        )
        write(folder / name, rng, made)


def board_null(folder: Path, rng: Rng) -> Truth:
    _board(folder, rng)
    return Truth("nothing; numbers and rooms off by what is usual, degF", FINE)


def _branches(temperature: float) -> tuple[float, float]:
    """Stiffness on the heating and on the cooling branch [N/m], equation (2) of the paper."""
    t = temperature - CELSIUS
    heating = 230.5 * np.exp(-17443 * np.exp(-0.1669 * t)) + 157.1
    cooling = 199.6 * np.exp(-696.0 * np.exp(-0.1549 * t)) + 157.9
    return float(heating), float(cooling)


def _hanging_course(
    volt: Steps, begin: float, room: float, r: float, c: float, h: float, latent: float, stop: float
) -> tuple[Array, Array]:
    """Temperature and stiffness of one coil; transformation takes up `latent` [J] between its two stiffnesses."""
    step = 0.01
    times: Array = step * np.arange(round(stop / step) + 1, dtype=np.float64)
    u = volt.at(times)
    warm, k = begin, _branches(begin)[0]
    states = np.empty((len(times), 2))
    states[0] = warm, k
    for n in range(len(times) - 1):
        power = u[n] ** 2 / r - h * (warm - room)
        heating, cooling = _branches(warm)
        up, down = _branches(warm + 0.05)
        capacity = c
        if power > 0 and k <= heating + 1e-6:
            capacity += latent * (up - heating) / 0.05 / 230.0
        if power < 0 and k >= cooling - 1e-6:
            capacity += latent * (down - cooling) / 0.05 / 230.0
        warm += step * power / capacity
        heating, cooling = _branches(warm)
        k = min(max(k, heating), max(cooling, heating))
        states[n + 1] = warm, k
    return times, states


def _hanging(folder: Path, rng: Rng, latent: float = 0.0, hot: float = 0.0) -> None:
    """One coil under 120 g: thermocouple, ruler, clamp."""
    stop = 150.0
    scenario(
        folder,
        "One coil lifts a weight",
        stop,
        0.05,
        0.1,
        "  supply:\n    kind: programme\n    outputs:\n      voltage: {unit: V, constant: 0 V}\n"
        "  room:\n    kind: programme\n    outputs:\n      temperature: {unit: K, constant: 22 degC}\n"
        "  circuit: {kind: ngspice, strings: [1], start: {resistance: 2.2 ohm}}\n"
        "  actuator: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, mechanical: load,\n"
        f"    {COILS_PARAMETERS}}}\n"
        "  load: {kind: hanging_mass, coils: 1, mass: 120 g}\n",
        "  - supply.voltage -> circuit.supply_voltage\n",
    )
    r, c, h = (v * np.exp(0.05 * rng.normal()) for v in (2.2, COIL_C, COIL_G))
    for name in FOLDERS:
        volt = drawn_steps(rng, stop, 14.0, 0.0, 1.15, 0.1)
        room = 21.5
        begin = room + CELSIUS + (hot if name == "second" else 0.0)
        t, x = _hanging_course(volt, begin, room + CELSIUS, r, c, h, latent, stop)
        sensors = [
            Sensor("coil[1].temperature", "T_wire", "degC", celsius(0), 0.3, 0.5, 1.0, 0.1),
            Sensor(
                "coil[1].extension", "ruler_mm", "mm", lambda t, x, u: 1e3 * 0.12 * 9.80665 / x[:, 1], 0.05, 0.5, 1.0
            ),
            Sensor("supply.current", "I_mA", "mA", lambda t, x, u: 1e3 * u[:, 0] / r, 2.0, 0.5, 1.0, 1.0),
        ]
        conditions = {
            "room": {"outputs": {"temperature": {"constant": f"{room} degC"}}},
            "actuator": {"parameters": {"initial_temperature": f"{room} degC"}},
        }
        made = Written(t, x, sensors, {"supply.voltage": (volt, "V")}, sidecar={"components": conditions})
        write(folder / name, rng, made)


def hanging_latent(folder: Path, rng: Rng) -> Truth:
    latent = rng.uniform(0.3, 0.6)
    _hanging(folder, rng, latent=latent)
    return Truth(f"latent heat of the transformation, {latent:.2f} J in all", PHYSICS, ("latent_heat",))


def hanging_hot(folder: Path, rng: Rng) -> Truth:
    hot = rng.uniform(9.0, 14.0)
    _hanging(folder, rng, hot=hot)
    return Truth(f"the second recording begins {hot:.1f} K warmer than stated", (*RECORDING, *SENSOR))


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    conveyor_null,
    shaft_backlash,
    boiler_two,
    absorber_stuck,
    vehicle_two,
    wall_offset,
    fan_warm,
    hanging_hot,
    vessel_supply,
    conveyor_splice,
    boiler_null,
    absorber_untold,
    vehicle_miles,
    shaft_two,
    hanging_latent,
    wall_sun,
    vessel_leak,
    board_null,
    boiler_jet,
    shaft_other_run,
    absorber_hard,
    conveyor_friction,
    wall_null,
    fan_stall,
    boiler_gallons,
    absorber_null,
    shaft_null,
)
