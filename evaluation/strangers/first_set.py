"""First set: rooms, cylinders, slides, circuits, reactors, exchangers, heaters, coils, a pendulum, motors."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, course, drawn_steps, write
from evaluation.strangers.truth import FINE, OPEN, PHYSICS, RECORDING, SENSOR, Truth

Rng = np.random.Generator
FOLDERS = ("first", "second", "third")
PLAIN, MINUTES, MILLISECONDS = Logger(), Logger("min"), Logger("ms")


def scenario(folder: Path, title: str, stop: float, macro: float, output: float, components: str, wires: str) -> None:
    """Write scenario.yaml."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scenario.yaml").write_text(
        f"title: {title}\ntime: {{stop: {stop:.10g} s, macro_step: {macro:.10g} s, output_step: {output:.10g} s}}\n"
        f"components:\n{components}connections:\n{wires}",
        encoding="utf-8",
    )


def programme(name: str, *outputs: tuple[str, str]) -> str:
    """A component that holds outputs at 0."""
    inner = "".join(
        f"      {n}: {{unit: {u or chr(34) + '1' + chr(34)}, constant: 0{' ' + u if u else ''}}}\n" for n, u in outputs
    )
    return f"  {name}:\n    kind: programme\n    outputs:\n{inner}"


def fmu(name: str, file: str, integrator: str = "cvode") -> str:
    """A component that is an FMU."""
    return f"  {name}: {{kind: fmu, fmu: {file}.fmu, integrator: {integrator}}}\n"


# --- a greenhouse: air and soil, FMI 2 Model Exchange, minutes, degC
GREENHOUSE = OdeModel(
    "greenhouse",
    {"C_air": (9e4, "J/K"), "C_soil": (1.5e6, "J/K"), "U_soil": (210.0, "W/K"), "U_glass": (95.0, "W/K")},
    {"heating": "W", "outdoor": "K"},
    {
        "T_air": ("K", "285.15", "(heating - U_soil*(T_air - T_soil) - U_glass*(T_air - outdoor))/C_air"),
        "T_soil": ("K", "284.15", "U_soil*(T_air - T_soil)/C_soil"),
    },
    {"air": ("K", "T_air"), "soil": ("K", "T_soil")},
)


def _greenhouse(
    folder: Path,
    rng: Rng,
    off: float,
    extra: Callable[[float, Array, Array], tuple[float, float]],
    logger: Logger = MINUTES,
    noise: float = 0.08,
    quantum: float = 0.1,
    stated: float | None = 1.0,
    spoil: Callable[[str, str, Array, Array], Array] | None = None,
    wild: float = 0.0,
) -> None:
    stop = 12 * 3600.0
    GREENHOUSE.build(folder)
    scenario(
        folder,
        "A greenhouse",
        stop,
        60,
        60,
        programme("weather", ("outdoor", "K")) + programme("stove", ("heating", "W")) + fmu("house", "greenhouse"),
        "  - weather.outdoor -> house.outdoor\n  - stove.heating -> house.heating\n",
    )
    ca, cs, us, ug = (v * np.exp(off * rng.standard_normal()) for v in (9e4, 1.5e6, 210.0, 95.0))
    for i, name in enumerate(FOLDERS):
        heat = drawn_steps(rng, stop, 5400, 0, 3500, 60)
        base = rng.uniform(270, 282)
        cold = Steps(*(tuple(v) for v in zip(*[(600.0 * k, round(base + 5 * np.sin(k / 9), 2)) for k in range(72)])))

        def rates(t: float, x: Array, u: Array, i: int = i) -> list[float]:
            a, s = extra(t + 1e6 * i, x, u)
            return [(u[1] - us * (x[0] - x[1]) - ug * (x[0] - u[0])) / ca + a, us * (x[0] - x[1]) / cs + s]

        t, x = course(rates, (285.15, 284.15), (cold, heat), stop, 30.0)
        sensors = [
            Sensor(
                "house.air",
                "air_degC",
                "degC",
                lambda t, x, u: x[:, 0] - CELSIUS,
                noise,
                120,
                stated,
                quantum,
                wild=wild,
            ),
            Sensor("house.soil", "soil_degC", "degC", lambda t, x, u: x[:, 1] - CELSIUS, noise, 120, stated, quantum),
        ]
        write(
            folder / name,
            rng,
            Written(
                t,
                x,
                sensors,
                {"weather.outdoor": (cold, "K"), "stove.heating": (heat, "W")},
                logger,
                recorded=["weather.outdoor", "stove.heating"],
                spoil=None if spoil is None else partial(spoil, name),
            ),
        )


def greenhouse_null(folder: Path, rng: Rng) -> Truth:
    _greenhouse(folder, rng, 0.08, lambda t, x, u: (0, 0), Logger("min", is_comma=True, empty=0.02))
    return Truth("nothing; parameters 8 % off", FINE)


def greenhouse_radiation(folder: Path, rng: Rng) -> Truth:
    _greenhouse(folder, rng, 0.03, lambda t, x, u: (-2.2e-11 * (x[0] ** 4 - u[0] ** 4), 0))
    return Truth("radiation of the air node to outdoors", PHYSICS, ("radiation",))


def greenhouse_window(folder: Path, rng: Rng) -> Truth:
    def extra(t: float, x: Array, u: Array) -> tuple[float, float]:
        return (-300.0 * (x[0] - u[0]) / 9e4 if 1e6 + 18000 < t < 1e6 + 21600 else 0.0), 0.0

    _greenhouse(folder, rng, 0.03, extra)
    return Truth(
        "a window open for an hour of the second recording",
        (*SENSOR, *PHYSICS),
        ("input_fault",),
    )


def greenhouse_stuck(folder: Path, rng: Rng) -> Truth:
    def spoil(name: str, column: str, t: Array, v: Array) -> Array:
        if name != "first" or column != "air_degC":
            return v
        held = (t > 20000) & (t < 25000)
        return np.where(held, v[np.argmax(held)], v)

    _greenhouse(folder, rng, 0.03, lambda t, x, u: (0, 0), spoil=spoil)
    return Truth("air sensor stuck for 83 min of the first recording", SENSOR, ())


# --- a hydraulic cylinder: pressure and piston, FMI 2, Co-Simulation; bar and mm
CYLINDER = OdeModel(
    "cylinder",
    {
        "A": (1.2e-3, "m^2"),
        "M": (35.0, "kg"),
        "d": (900.0, "N*s/m"),
        "k": (9000.0, "N/m"),
        "E": (4e11, "Pa/m^3"),
        "leak": (2.5e-12, "m^3/s/Pa"),
    },
    {"flow": "m^3/s"},
    {"p": ("Pa", "0.0", "E*(flow - A*v - leak*p)"), "s": ("m", "0.0", "v"), "v": ("m/s", "0.0", "(A*p - d*v - k*s)/M")},
    {"pressure": ("Pa", "p"), "stroke": ("m", "s")},
    1e-4,
)


def _cylinder(
    folder: Path,
    rng: Rng,
    off: float,
    force: Callable[[float], float],
    stated: float | None = 1.0,
    sizes: tuple[float, ...] = (1, 1, 1),
    read_p: float = 1.0,
    integrator: str = "internal",
    leak: Callable[[float], float] = lambda p: 0.0,
) -> None:
    CYLINDER.build(folder)
    stop = 6.0
    scenario(
        folder,
        "A cylinder with a return spring",
        stop,
        5e-3,
        5e-3,
        programme("pump", ("flow", "m^3/s")) + fmu("cylinder", "cylinder", integrator),
        "  - pump.flow -> cylinder.flow\n",
    )
    a, m, d, k, e, c = (v * np.exp(off * rng.standard_normal()) for v in (1.2e-3, 35.0, 900.0, 9000.0, 4e11, 2.5e-12))
    for name, size in zip(FOLDERS, sizes):
        flow = drawn_steps(rng, stop, 0.6, -3e-6 * size, 7e-6 * size, 5e-3)

        def rates(t: float, x: Array, u: Array) -> list[float]:
            return [
                e * (u[0] - a * x[2] - c * x[0] - leak(x[0])),
                x[2],
                (a * x[0] - d * x[2] - k * x[1] - force(x[2])) / m,
            ]

        t, x = course(rates, (0, 0, 0), (flow,), stop, 5e-4)
        sensors = [
            Sensor("cylinder.pressure", "p_bar", "bar", lambda t, x, u: read_p * x[:, 0] / 1e5, 0.02, 0.01, stated),
            Sensor("cylinder.stroke", "s_mm", "mm", lambda t, x, u: 1e3 * x[:, 1], 0.03, 0.01, stated, 0.01),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"pump.flow": (flow, "m^3/s")}))


def cylinder_null_noise_large(folder: Path, rng: Rng) -> Truth:
    _cylinder(folder, rng, 0.03, lambda v: 0.0, stated=3.0)
    return Truth("nothing; noise stated 3 times too large", FINE)


def cylinder_friction(folder: Path, rng: Rng) -> Truth:
    _cylinder(folder, rng, 0.03, lambda v: 60 * np.tanh(v / 1e-3))
    return Truth("dry friction of 60 N inside a Co-Simulation FMU", ("unnamed physics",), ())


def cylinder_psi(folder: Path, rng: Rng) -> Truth:
    _cylinder(folder, rng, 0.03, lambda v: 0.0, read_p=14.504)
    return Truth("pressures are in psi and stated as bar", RECORDING + SENSOR)


def cylinder_hard(folder: Path, rng: Rng) -> Truth:
    _cylinder(folder, rng, 0.02, lambda v: 0.0, sizes=(1, 1, 5), integrator="cvode", leak=lambda p: 4e-19 * p * abs(p))
    return Truth("a leak with the square of the pressure; held out is 5 times as hard", PHYSICS + FINE, ())


# --- a positioning slide, FMI 3 Model Exchange
STAGE = OdeModel(
    "stage",
    {"mass": (4.0, "kg"), "damping": (25.0, "N*s/m"), "spring": (220.0, "N/m"), "gain": (8.0, "N/V")},
    {"u": "V"},
    {"pos": ("m", "0.0", "vel"), "vel": ("m/s", "0.0", "(gain*u - damping*vel - spring*pos)/mass")},
    {"y": ("m", "pos")},
)


def _stage(
    folder: Path,
    rng: Rng,
    off: float,
    force: Callable[[Array], float],
    noise: float = 3e-5,
    stated: float | None = 1.0,
    more: dict[str, object] | None = None,
    limit: float | None = None,
    start: Callable[[int], tuple[float, float]] = lambda i: (0.0, 0.0),
    colour: float = 0.0,
    logger: Logger = PLAIN,
    gap_force: Callable[[Array], float] | None = None,
) -> None:
    build3(STAGE, folder, has_co_simulation=False)
    stop = 8.0
    scenario(
        folder,
        "A stage on leaf springs",
        stop,
        4e-3,
        4e-3,
        programme("amp", ("u", "V")) + fmu("stage", "stage"),
        "  - amp.u -> stage.u\n",
    )
    m, d, k, g = (v * np.exp(off * rng.standard_normal()) for v in (4.0, 25.0, 220.0, 8.0))
    for i, name in enumerate(FOLDERS):
        volt = drawn_steps(rng, stop, 0.7, -2, 2, 4e-3)
        t, x = course(
            lambda t, x, u: [x[1], (g * u[0] - d * x[1] - k * x[0] - force(x)) / m], start(i), (volt,), stop, 1e-3
        )

        def read(t: Array, x: Array, u: Array) -> Array:
            return 1e3 * (x[:, 0] if limit is None else np.clip(x[:, 0], -limit, limit))

        sensors = [Sensor("stage.y", "y_mm", "mm", read, 1e3 * noise, 0.01, stated, colour=colour, more=more or {})]
        write(folder / name, rng, Written(t, x, sensors, {"amp.u": (volt, "V")}, logger))


def stage_play(folder: Path, rng: Rng) -> Truth:
    def force(x: Array) -> float:  # a stop with clearance on one side and a hook on the other
        return float(900.0 * (max(x[0] - 0.02, 0.0) ** 1.5 / 0.02**0.5) + 300.0 * min(x[0] + 0.015, 0.0))

    _stage(folder, rng, 0.03, force)
    return Truth("two stops, one with the power 1.5", PHYSICS, ("upper_stop", "lower_stop"))


def stage_noise_small(folder: Path, rng: Rng) -> Truth:
    _stage(folder, rng, 0.03, lambda x: 0.0, stated=0.33)
    return Truth("nothing; noise stated 3 times too small", FINE)


def stage_saturated(folder: Path, rng: Rng) -> Truth:
    _stage(folder, rng, 0.03, lambda x: 0.0, limit=0.03)
    return Truth("the position sensor ends at 30 mm, not stated", SENSOR, ())


def stage_two(folder: Path, rng: Rng) -> Truth:
    _stage(folder, rng, 0.03, lambda x: 2.5 * np.tanh(x[1] / 1e-3) + 45.0 * x[1] * abs(x[1]))
    return Truth("dry friction of 2.5 N and drag", PHYSICS, ("dry_friction", "quadratic_drag", "stribeck_friction"))


def stage_start(folder: Path, rng: Rng) -> Truth:
    _stage(folder, rng, 0.03, lambda x: 0.0, start=lambda i: (0.012 * (i - 1), 0.0))
    return Truth("nothing; two recordings begin away from rest, which is not said", FINE + RECORDING + SENSOR)


# --- an RC ladder, FMI 2 Model Exchange, ms and mV
LADDER = OdeModel(
    "ladder",
    {"R1": (1000.0, "ohm"), "R2": (2200.0, "ohm"), "C1": (1e-5, "F"), "C2": (4.7e-6, "F")},
    {"source": "V"},
    {"v1": ("V", "0.0", "((source - v1)/R1 - (v1 - v2)/R2)/C1"), "v2": ("V", "0.0", "(v1 - v2)/R2/C2")},
    {"node_1": ("V", "v1"), "node_2": ("V", "v2")},
)


def _ladder(
    folder: Path,
    rng: Rng,
    leak: Callable[[Array], float],
    inputs: Callable[[int], Steps],
    off: float = 0.05,
    stated: float | None = 1.0,
    logger: Logger = MILLISECONDS,
    at_rest: bool = False,
    gain: float = 1.0,
) -> None:
    LADDER.build(folder)
    stop = 0.4
    scenario(
        folder,
        "A ladder of two RC members",
        stop,
        5e-4,
        5e-4,
        programme("generator", ("source", "V")) + fmu("ladder", "ladder"),
        "  - generator.source -> ladder.source\n",
    )
    r1, r2, c1, c2 = (v * np.exp(off * rng.standard_normal()) for v in (1000.0, 2200.0, 1e-5, 4.7e-6))
    for i, name in enumerate(FOLDERS):
        source = inputs(i)
        t, x = course(
            lambda t, x, u: [((u[0] - x[0]) / r1 - (x[0] - x[1]) / r2) / c1, ((x[0] - x[1]) / r2 - leak(x)) / c2],
            (0, 0),
            (source,),
            stop,
            1e-4,
        )
        sensors = [
            Sensor("ladder.node_1", "ch1_mV", "mV", lambda t, x, u: 1e3 * x[:, 0], 4, 1e-3, stated, 2.44),
            Sensor("ladder.node_2", "ch2_mV", "mV", lambda t, x, u: gain * 1e3 * x[:, 1], 4, 1e-3, stated, 2.44),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"generator.source": (source, "V")}, logger))


def ladder_diode(folder: Path, rng: Rng) -> Truth:
    _ladder(
        folder,
        rng,
        lambda x: 1e-6 * (np.exp(min(x[1], 6.0) / 0.6) - 1.0),
        lambda i: drawn_steps(rng, 0.4, 0.05, -3, 3, 5e-4),
    )
    return Truth("a leaking diode at node 2", ("unnamed physics",), ())


def ladder_constant(folder: Path, rng: Rng) -> Truth:
    _ladder(folder, rng, lambda x: 0.0, lambda i: Steps((0.0,), (0.0,)))
    return Truth("nothing is driven: all readings are 0 but for noise", FINE)


def ladder_sign(folder: Path, rng: Rng) -> Truth:
    _ladder(folder, rng, lambda x: 0.0, lambda i: drawn_steps(rng, 0.4, 0.05, -3, 3, 5e-4), gain=-1.0)
    return Truth("channel 2 is connected the wrong way round", RECORDING + SENSOR)


# --- a stirred reactor without units, FMI 3 Model Exchange and Co-Simulation, time from 1000 min
REACTOR = OdeModel(
    "reactor",
    {"k": (0.002, ""), "dilution": (0.0015, ""), "yield_": (0.8, "")},
    {"feed": ""},
    {"a": ("", "0.4", "dilution*(feed - a) - k*a"), "b": ("", "0.1", "yield_*k*a - dilution*b")},
    {"A": ("", "a"), "B": ("", "b")},
    1.0,
)


def _reactor(
    folder: Path,
    rng: Rng,
    order: float,
    logger: Logger,
    off: float = 0.05,
    integrator: str = "cvode",
    colour: float = 0.0,
    stated: float | None = 1.0,
    every: float = 20.0,
    stop: float = 7200.0,
    noise: float = 0.004,
) -> None:
    build3(REACTOR, folder)
    scenario(
        folder,
        "A stirred reactor",
        7200.0,
        20,
        20,
        programme("dosing", ("feed", "")) + fmu("reactor", "reactor", integrator),
        "  - dosing.feed -> reactor.feed\n",
    )
    k, d, y = (v * np.exp(off * rng.standard_normal()) for v in (0.002, 0.0015, 0.8))
    for name in FOLDERS:
        feed = drawn_steps(rng, stop, 1500, 0.1, 2.0, 20)

        def rates(t: float, x: Array, u: Array) -> list[float]:
            r = k * x[0] ** order
            return [d * (u[0] - x[0]) - r, y * r - d * x[1]]

        t, x = course(rates, (0.4, 0.1), (feed,), stop, 10.0)
        sensors = [
            Sensor("reactor.A", "cA", "1", lambda t, x, u: x[:, 0], noise, every, stated, colour=colour),
            Sensor("reactor.B", "cB", "1", lambda t, x, u: x[:, 1], noise, every * 3, stated, colour=colour),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"dosing.feed": (feed, "")}, logger))


def reactor_second_order(folder: Path, rng: Rng) -> Truth:
    _reactor(folder, rng, 2.0, Logger("min", zero=1000.0))
    return Truth("the reaction is of second order", ("unnamed physics",), ())


def reactor_null(folder: Path, rng: Rng) -> Truth:
    _reactor(folder, rng, 1.0, Logger("min", zero=1000.0, jitter=0.3), integrator="internal")
    return Truth("nothing; jitter of the clock", FINE)


def reactor_short(folder: Path, rng: Rng) -> Truth:
    _reactor(folder, rng, 1.0, Logger("min"), every=120.0, stop=1160.0)
    return Truth("nothing; ten and four readings of a recording", FINE)


def reactor_coloured(folder: Path, rng: Rng) -> Truth:
    _reactor(folder, rng, 1.0, Logger("s"), colour=0.9, stated=None)
    return Truth("nothing; the noise is coloured and not stated", FINE)


# --- a heat exchanger of two FMUs: one Model Exchange (FMI 3), one Co-Simulation (FMI 2)
HOT = OdeModel(
    "hot_side",
    {"C": (4200.0, "J/K"), "flow": (60.0, "W/K"), "UA": (90.0, "W/K")},
    {"inlet": "K", "wall": "K"},
    {"T": ("K", "320.0", "(flow*(inlet - T) - UA*(T - wall))/C")},
    {"outlet": ("K", "T"), "heat": ("W", "UA*(T - wall)")},
)
WALL = OdeModel(
    "cold_side",
    {"C": (2500.0, "J/K"), "UB": (70.0, "W/K")},
    {"heat": "W", "coolant": "K"},
    {"T": ("K", "300.0", "(heat - UB*(T - coolant))/C")},
    {"wall": ("K", "T")},
    0.05,
)


def _exchanger(
    folder: Path,
    rng: Rng,
    extra: Callable[[Array, Array], tuple[float, float]],
    logger: Logger = PLAIN,
    off: float = 0.03,
    noise: float = 0.05,
) -> None:
    build3(HOT, folder, has_co_simulation=False)
    WALL.build(folder)
    stop = 1800.0
    scenario(
        folder,
        "A heat exchanger",
        stop,
        0.5,
        5,
        programme("bath", ("inlet", "K"), ("coolant", "K"))
        + fmu("hot", "hot_side")
        + fmu("cold", "cold_side", "internal"),
        "  - bath.inlet -> hot.inlet\n  - bath.coolant -> cold.coolant\n"
        "  - hot.heat -> cold.heat\n  - cold.wall -> hot.wall\n",
    )
    c1, f, ua, c2, ub = (v * np.exp(off * rng.standard_normal()) for v in (4200.0, 60.0, 90.0, 2500.0, 70.0))
    for name in FOLDERS:
        inlet, cool = drawn_steps(rng, stop, 250, 310, 360, 5), drawn_steps(rng, stop, 400, 283, 300, 5)

        def rates(t: float, x: Array, u: Array) -> list[float]:
            a, b = extra(x, u)
            return [
                (f * (u[0] - x[0]) - ua * (x[0] - x[1]) + a) / c1,
                (ua * (x[0] - x[1]) - ub * (x[1] - u[1]) + b) / c2,
            ]

        t, x = course(rates, (320, 300), (inlet, cool), stop, 1.0)
        sensors = [
            Sensor("hot.outlet", "T_out", "degC", lambda t, x, u: x[:, 0] - CELSIUS, noise, 5, 1.0, 0.01),
            Sensor("cold.wall", "T_wall", "K", lambda t, x, u: x[:, 1], noise, 10, 1.0, 0.01),
        ]
        write(
            folder / name,
            rng,
            Written(t, x, sensors, {"bath.inlet": (inlet, "K"), "bath.coolant": (cool, "K")}, logger),
        )


def exchanger_two(folder: Path, rng: Rng) -> Truth:
    _exchanger(folder, rng, lambda x, u: (-1.2e-7 * (x[0] ** 4 - 290.0**4) * 0.9 - 2.0 * (x[0] - 295.0), 0.0))
    return Truth(
        "radiation and loss of the hot side to a room that the model does not have", PHYSICS, ("radiation", "heat_loss")
    )


def exchanger_drift(folder: Path, rng: Rng) -> Truth:
    _exchanger(folder, rng, lambda x, u: (0.0, 0.0), Logger("s", rate=1.02))
    return Truth("the logger's clock runs 2 % fast", RECORDING + SENSOR)


# --- three heaters of the tool's own kind, and coils
def _heaters(folder: Path, rng: Rng, off: float, neighbours: float, told: bool = True, square: float = 0.0) -> None:
    stop = 900.0
    wires = (
        "".join(f"  - drive.power_{i} -> heaters.power[{i}]\n" for i in (1, 2, 3))
        + "  - room.temperature -> heaters.ambient_temperature\n"
    )
    scenario(
        folder,
        "Three heaters",
        stop,
        0.5,
        1,
        programme("drive", *((f"power_{i}", "W") for i in (1, 2, 3)))
        + "  room:\n    kind: programme\n    outputs:\n      temperature: {unit: K, constant: 23 degC}\n"
        + "  heaters:\n    kind: fmu\n    fmu: thermal_stiffness\n    structure: {coils: 3}\n"
        + "    parameter_set: tclab_heater\n"
        + "    parameters: {initial_temperature: 23 degC}\n",
        wires,
    )
    c = 2.0 * np.exp(off * rng.standard_normal(3))
    h = 0.012 * np.exp(off * rng.standard_normal(3))
    for name in FOLDERS:
        powers = [drawn_steps(rng, stop, 150, 0, 1.0, 1) for _ in range(3)]
        room = float(f"{rng.uniform(19, 26):.1f}")

        def rates(t: float, x: Array, u: Array, room: float = room) -> Array:
            swap = neighbours * np.array([x[1] - x[0], x[0] + x[2] - 2 * x[1], x[1] - x[2]])
            return (u - h * (x - room - CELSIUS) - square * (x - room - CELSIUS) ** 2 + swap) / c

        t, x = course(rates, [room + CELSIUS] * 3, powers, stop, 0.5)
        sensors = [
            Sensor(
                f"coil[{i + 1}].temperature",
                f"T{i + 1}",
                "degC",
                celsius(i),
                0.1,
                (1.0, 2.0, 5.0)[i],
                1.0,
                0.0625,
            )
            for i in range(3)
        ]
        write(
            folder / name,
            rng,
            Written(
                t,
                x,
                sensors,
                {f"drive.power_{i + 1}": (p, "W") for i, p in enumerate(powers)},
                Logger("s", empty=0.03),
                sidecar={
                    "components": {
                        "room": {"outputs": {"temperature": {"constant": f"{room} degC"}}},
                        "heaters": {"parameters": {"initial_temperature": f"{room} degC"}},
                    }
                },
            ),
        )


def heaters_null(folder: Path, rng: Rng) -> Truth:
    _heaters(folder, rng, 0.15, 0.0)
    return Truth("nothing; parameters 15 % off, three rates of sampling", FINE)


def heaters_neighbours(folder: Path, rng: Rng) -> Truth:
    _heaters(folder, rng, 0.1, 0.004)
    return Truth("heat between neighbours", PHYSICS, ("neighbour_heat", "neighbours", "heat_exchange"))


def _coils(folder: Path, rng: Rng, alpha: float, wrong: bool = False, off: float = 0.03) -> None:
    stop = 100.0
    points = "{unit: V, constant: 0 V}"
    scenario(
        folder,
        "Three strings of one coil",
        stop,
        0.05,
        0.1,
        f"  supply:\n    kind: programme\n    outputs:\n      voltage: {points}\n"
        "  room:\n    kind: programme\n    outputs:\n      temperature: {unit: K, constant: 22 degC}\n"
        "  circuit: {kind: ngspice, strings: [1, 1, 1], supply: common, start: {resistance: 2.2 ohm}}\n"
        "  actuator: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room,\n"
        "    parameters: {use_regressed_cooling_rate: false}}\n",
        "  - supply.voltage -> circuit.supply_voltage\n",
    )
    r, c, h = (v * np.exp(off * rng.standard_normal(3)) for v in (2.2, 7.328e-9 * 6450 * 837, 90 * 97.85e-6))
    for name in FOLDERS:
        volt = drawn_steps(rng, stop, 18, 0.0, 0.85, 0.1)
        other = drawn_steps(rng, stop, 18, 0.0, 0.85, 0.1)

        def rates(t: float, x: Array, u: Array) -> Array:
            return np.asarray((u[0] ** 2 / (r * (1 + alpha * (x - 295.15))) - h * (x - 294.65)) / c)

        t, x = course(rates, [294.65] * 3, (volt,), stop, 0.02)
        sensors = [
            *(
                Sensor(
                    f"coil[{i + 1},1].temperature",
                    f"T{i + 1}",
                    "degC",
                    celsius(i),
                    0.2,
                    0.5,
                    1.0,
                    0.1,
                )
                for i in range(3)
            ),
            Sensor(
                "supply.current",
                "I",
                "mA",
                lambda t, x, u: 1e3 * (u[:, :1] / (r * (1 + alpha * (x - 295.15)))).sum(axis=1),
                3.0,
                0.25,
                1.0,
                1.0,
            ),
        ]
        write(
            folder / name,
            rng,
            Written(
                t,
                x,
                sensors,
                {"supply.voltage": (volt, "V")},
                Logger("ms", zero=50000.0),
                told={"supply.voltage": other} if wrong and name == "second" else {},
                sidecar={
                    "components": {
                        "room": {"outputs": {"temperature": {"constant": "21.5 degC"}}},
                        "actuator": {"parameters": {"initial_temperature": "21.5 degC"}},
                    }
                },
            ),
        )


def coils_resistance(folder: Path, rng: Rng) -> Truth:
    _coils(folder, rng, 0.0012)
    return Truth(
        "resistance rises with temperature", PHYSICS, ("temperature_dependent_resistance", "resistance_of_temperature")
    )


def coils_wrong_programme(folder: Path, rng: Rng) -> Truth:
    _coils(folder, rng, 0.0, wrong=True)
    return Truth("the second recording states another programme", RECORDING)


# --- a pendulum of the tool's own kind
def _pendulum(folder: Path, rng: Rng, drag: float, sign: float = 1.0, off: float = 0.02) -> None:
    scenario(
        folder,
        "A pendulum",
        10.0,
        5e-3,
        5e-3,
        "  arm:\n    kind: bullet_pendulum\n    micro_step: 1 ms\n    parameter_set: pendulum_arm\n"
        "    parameters: {initial_angle: 90 deg, initial_angular_velocity: 0 rad/s}\n",
        "  []\n",
    )
    text = (folder / "scenario.yaml").read_text().replace("connections:\n  []\n", "")
    (folder / "scenario.yaml").write_text(text)
    inertia = 4408e-7 + 0.1 * 0.115**2
    rate = 0.1 * 9.80665 * 0.115 / inertia * np.exp(off * rng.standard_normal())
    for name in FOLDERS:
        first = float(f"{rng.uniform(70, 150):.1f}")
        t, x = course(
            lambda t, x, u: [x[1], rate * np.sin(x[0]) - drag * x[1] * abs(x[1])],
            (np.radians(first), 0),
            (),
            10.0,
            1e-3,
        )
        sensors = [
            Sensor("arm.angle", "phi_deg", "deg", lambda t, x, u: sign * np.degrees(x[:, 0]), 0.15, 0.02, 1.0, 0.088)
        ]
        write(
            folder / name,
            rng,
            Written(
                t,
                x,
                sensors,
                {},
                Logger("s", zero=17.25),
                sidecar={
                    "components": {"arm": {"parameters": {"initial_angle": f"{first} deg"}}},
                    "uncertain": {"arm.initial_angle": "0.5 deg"},
                },
            ),
        )


def pendulum_drag(folder: Path, rng: Rng) -> Truth:
    _pendulum(folder, rng, 0.03)
    return Truth(
        "drag with the square of the rate", PHYSICS, ("quadratic_drag", "quadratic_damping", "air_drag", "drag")
    )


def pendulum_sign(folder: Path, rng: Rng) -> Truth:
    _pendulum(folder, rng, 0.0, sign=-1.0)
    return Truth("the encoder counts the other way", RECORDING + SENSOR)


# --- a motor of two channels, FMI 2 Co-Simulation, rpm and mA
DRIVE = OdeModel(
    "gearmotor",
    {"L": (2e-3, "H"), "R": (2.0, "ohm"), "K": (0.05, "V*s/rad"), "J": (2e-4, "kg*m^2"), "b": (1e-4, "N*m*s/rad")},
    {"voltage": "V"},
    {"i": ("A", "0.0", "(voltage - R*i - K*w)/L"), "w": ("rad/s", "0.0", "(K*i - b*w)/J")},
    {"current": ("A", "i"), "speed": ("rad/s", "w")},
    1e-4,
)


def _motor(
    folder: Path,
    rng: Rng,
    friction: float,
    integrator: str,
    limit: float = 1e9,
    sizes: tuple[float, ...] = (1, 1, 1),
    sign: float = 1.0,
    fade: float = 0.0,
) -> None:
    DRIVE.build(folder)
    stop = 5.0
    scenario(
        folder,
        "A motor with a disk",
        stop,
        2e-3,
        2e-3,
        programme("driver", ("voltage", "V")) + fmu("motor", "gearmotor", integrator),
        "  - driver.voltage -> motor.voltage\n",
    )
    inductance, r, k, j, b = (v * np.exp(0.03 * rng.standard_normal()) for v in (2e-3, 2.0, 0.05, 2e-4, 1e-4))
    for name, size in zip(FOLDERS, sizes):
        volt = drawn_steps(rng, stop, 0.5, -6 * size, 6 * size, 2e-3)

        def rates(t: float, x: Array, u: Array) -> list[float]:
            e = np.clip(u[0], -limit, limit)
            return [
                (e - r * x[0] - k * (1 - fade * abs(x[0])) * x[1]) / inductance,
                (k * (1 - fade * abs(x[0])) * x[0] - b * x[1] - friction * np.tanh(x[1] / 0.5)) / j,
            ]

        t, x = course(rates, (0, 0), (volt,), stop, 2e-4)
        sensors = [
            Sensor("motor.current", "I_mA", "mA", lambda t, x, u: sign * 1e3 * x[:, 0], 15, 5e-3, 1.0, 5),
            Sensor("motor.speed", "n_rpm", "rpm", lambda t, x, u: 30 / np.pi * x[:, 1], 3, 1e-2, 1.0),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"driver.voltage": (volt, "V")}, Logger("s", gap=(2.0, 2.6))))


def motor_sign(folder: Path, rng: Rng) -> Truth:
    _motor(folder, rng, 0.0, "internal", sign=-1.0)
    return Truth("the shunt is connected the wrong way round", RECORDING + SENSOR)


def motor_saturation(folder: Path, rng: Rng) -> Truth:
    _motor(folder, rng, 0.0, "cvode", limit=8.0, sizes=(1, 1, 2))
    return Truth("the driver ends at 8 V, which only the held-out recording reaches", OPEN + SENSOR)


def motor_friction(folder: Path, rng: Rng) -> Truth:
    _motor(folder, rng, 0.012, "cvode")
    return Truth("dry friction", PHYSICS, ("dry_friction",))


def greenhouse_outliers(folder: Path, rng: Rng) -> Truth:
    _greenhouse(folder, rng, 0.05, lambda t, x, u: (0, 0), Logger("h"), wild=0.02)
    return Truth("nothing; 2 % wild readings", FINE)


def ladder_steady(folder: Path, rng: Rng) -> Truth:
    _ladder(folder, rng, lambda x: x[1] / 3e4, lambda i: Steps((0.0,), (2.0,)))
    return Truth("a leak of 30 kohm; one and the same step in all recordings", PHYSICS + FINE, ("leakage",))


def stage_coloured(folder: Path, rng: Rng) -> Truth:
    _stage(folder, rng, 0.03, lambda x: 0.0, colour=0.8, noise=6e-5)
    return Truth("nothing; coloured noise of the stated size", FINE)


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    greenhouse_null,
    greenhouse_radiation,
    greenhouse_window,
    greenhouse_stuck,
    greenhouse_outliers,
    cylinder_null_noise_large,
    cylinder_friction,
    cylinder_psi,
    cylinder_hard,
    stage_play,
    stage_noise_small,
    stage_saturated,
    stage_two,
    stage_start,
    stage_coloured,
    ladder_diode,
    ladder_constant,
    ladder_sign,
    ladder_steady,
    reactor_second_order,
    reactor_null,
    reactor_short,
    reactor_coloured,
    exchanger_two,
    exchanger_drift,
    heaters_null,
    heaters_neighbours,
    coils_resistance,
    coils_wrong_programme,
    pendulum_drag,
    pendulum_sign,
    motor_sign,
    motor_saturation,
    motor_friction,
)
