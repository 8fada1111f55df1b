"""Second set: a battery, a fermenter, a trolley, a reservoir, a radiator, coils in series, a pump with its pipe."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.first_set import FOLDERS, Rng, fmu, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, course, drawn_steps, write
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

# --- a battery cell: charge and one overvoltage, FMI 3 Co-Simulation, an output called `y`, hours
CELL = OdeModel(
    "cell",
    {"Q": (9000.0, "C"), "R0": (0.03, "ohm"), "R1": (0.02, "ohm"), "tau": (300.0, "s"), "slope": (0.7, "V")},
    {"load": "A"},
    {"s": ("", "0.9", "-load/Q"), "v": ("V", "0.0", "(R1*load - v)/tau")},
    {"y": ("V", "3.4 + slope*s - v - R0*load")},
    2.0,
)


def _cell(folder: Path, rng: Rng, slow: float, stated: float | None, integrator: str = "internal") -> None:
    build3(CELL, folder)
    stop = 4 * 3600.0
    parts = programme("bench", ("load", "A")) + fmu("cell", "cell", integrator)
    scenario(folder, "A battery cell", stop, 10, 10, parts, "  - bench.load -> cell.load\n")
    q, r0, r1, tau = (v * np.exp(0.03 * rng.standard_normal()) for v in (9000.0, 0.03, 0.02, 300.0))
    for name in FOLDERS:
        load = drawn_steps(rng, stop, 1500, -0.8, 1.6, 10)

        def rates(t: float, x: Array, u: Array) -> list[float]:
            return [-u[0] / q, (r1 * u[0] - x[1]) / tau, (slow * u[0] - x[2]) / 2500.0]

        t, x = course(rates, (0.9, 0.0, 0.0), (load,), stop, 10.0)
        sensors = [
            Sensor(
                "cell.y",
                "U_mV",
                "mV",
                lambda t, x, u: 1e3 * (3.4 + 0.7 * x[:, 0] - x[:, 1] - x[:, 2] - r0 * u[:, 0]),
                1.0,
                20.0,
                stated,
                0.5,
            )
        ]
        write(folder / name, rng, Written(t, x, sensors, {"bench.load": (load, "A")}, Logger("h", zero=12.0)))


def cell_null(folder: Path, rng: Rng) -> Truth:
    _cell(folder, rng, 0.0, None)
    return Truth("nothing; noise is not stated, the clock begins at 12 h", FINE)


def cell_diffusion(folder: Path, rng: Rng) -> Truth:
    _cell(folder, rng, 0.015, 1.0, "cvode")
    return Truth("a second, slow overvoltage", ("unnamed physics",), ())


# --- a fermenter without units, FMI 2 Model Exchange
FERMENTER = OdeModel(
    "fermenter",
    {"mu": (2.0e-4, ""), "gain": (0.5, "")},
    {"feed": ""},
    {"X": ("", "0.2", "mu*S*X"), "S": ("", "1.0", "feed - mu*S*X/gain")},
    {"biomass": ("", "X"), "substrate": ("", "S")},
)


def _fermenter(folder: Path, rng: Rng, half: float) -> None:
    FERMENTER.build(folder)
    stop = 18000.0
    parts = programme("pump", ("feed", "")) + fmu("tank", "fermenter")
    scenario(folder, "A fermenter", stop, 60, 60, parts, "  - pump.feed -> tank.feed\n")
    mu, gain = 2.0e-4 * np.exp(0.03 * rng.standard_normal()), 0.5 * np.exp(0.03 * rng.standard_normal())
    for name in FOLDERS:
        feed = drawn_steps(rng, stop, 4000, 0.0, 4e-4, 60)

        def rates(t: float, x: Array, u: Array) -> list[float]:
            growth = mu * x[1] * x[0] / (1.0 + half * x[1])
            return [growth, u[0] - growth / gain]

        t, x = course(rates, (0.2, 1.0), (feed,), stop, 30.0)
        sensors = [
            Sensor("tank.biomass", "OD", "1", lambda t, x, u: x[:, 0], 0.005, 120.0),
            Sensor("tank.substrate", "glc", "1", lambda t, x, u: x[:, 1], 0.01, 600.0),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"pump.feed": (feed, "")}, Logger("min", jitter=0.2)))


def fermenter_null(folder: Path, rng: Rng) -> Truth:
    _fermenter(folder, rng, 0.0)
    return Truth("nothing", FINE)


def fermenter_saturation(folder: Path, rng: Rng) -> Truth:
    _fermenter(folder, rng, 0.8)
    return Truth("growth saturates (Monod)", ("unnamed physics",), ())


# --- a trolley with a load on a rope, FMI 3 Model Exchange
TROLLEY = OdeModel(
    "trolley",
    {"M": (6.0, "kg"), "b": (9.0, "N*s/m"), "w2": (9.0, "1/s^2"), "c": (0.25, "1/s")},
    {"force": "N"},
    {
        "x": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(force - b*v)/M"),
        "phi": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "-w2*phi - c*w - (force - b*v)/M"),
    },
    {"x_cart": ("m", "x"), "angle": ("rad", "phi")},
)


def _trolley(folder: Path, rng: Rng, dry: float, late: float = 0.0) -> None:
    build3(TROLLEY, folder, has_co_simulation=False)
    stop = 16.0
    parts = programme("drive", ("force", "N")) + fmu("crane", "trolley")
    scenario(folder, "A trolley with a load", stop, 0.01, 0.02, parts, "  - drive.force -> crane.force\n")
    m, b, w2, c = (v * np.exp(0.02 * rng.standard_normal()) for v in (6.0, 9.0, 9.0, 0.25))
    for name in FOLDERS:
        force = drawn_steps(rng, stop, 1.2, -12, 12, 0.02)

        def rates(t: float, x: Array, u: Array) -> list[float]:
            a = (u[0] - b * x[1] - dry * np.tanh(x[1] / 2e-3)) / m
            return [x[1], a, x[3], -w2 * x[2] - c * x[3] - a]

        t, x = course(rates, (0, 0, 0, 0), (force,), stop, 4e-3)
        sensors = [
            Sensor("crane.x_cart", "x_cm", "cm", lambda t, x, u: 100 * x[:, 0], 0.05, 0.04),
            Sensor("crane.angle", "phi_deg", "deg", lambda t, x, u: np.degrees(x[:, 2]), 0.1, 0.02, 1.0, 0.05),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"drive.force": (force, "N")}, Logger("s", zero=-late)))
        if late:  # the sidecar does not know of it
            file = folder / name / "recording.yaml"
            file.write_text(file.read_text().replace(f"zero: {-late}", "zero: 0.0"))


def trolley_friction(folder: Path, rng: Rng) -> Truth:
    _trolley(folder, rng, 2.5)
    return Truth("dry friction of the trolley", PHYSICS, ("dry_friction", "stribeck_friction"))


def trolley_early(folder: Path, rng: Rng) -> Truth:
    _trolley(folder, rng, 0.0, late=0.4)
    return Truth("the logger's clock is 0.4 s ahead", RECORDING)


def trolley_alone(folder: Path, rng: Rng) -> Truth:
    _trolley(folder, rng, 0.0)
    return Truth("nothing; no recording is held out", FINE, held_out=())


# --- a reservoir, FMI 2 Model Exchange, levels in cm
RESERVOIR = OdeModel(
    "reservoir",
    {"area": (0.8, "m^2"), "k": (2e-3, "m^2/s")},
    {"inflow": "m^3/s"},
    {"h": ("m", "0.5", "(inflow - k*h)/area")},
    {"level": ("m", "h")},
)


def _reservoir(folder: Path, rng: Rng, leak: float, spoil: Callable[[str, Array, Array], Array] | None = None) -> None:
    RESERVOIR.build(folder)
    stop = 5400.0
    parts = programme("valve", ("inflow", "m^3/s")) + fmu("basin", "reservoir")
    scenario(folder, "A reservoir", stop, 5, 15, parts, "  - valve.inflow -> basin.inflow\n")
    area, k = 0.8 * np.exp(0.03 * rng.standard_normal()), 2e-3 * np.exp(0.03 * rng.standard_normal())
    for name in FOLDERS:
        flow = drawn_steps(rng, stop, 800, 2e-4, 2.2e-3, 15)
        t, x = course(lambda t, x, u: [(u[0] - k * x[0] - leak) / area], (0.5,), (flow,), stop, 5.0)
        sensors = [Sensor("basin.level", "h_cm", "cm", lambda t, x, u: 100 * x[:, 0], 0.2, 15.0, 1.0, 0.1)]
        write(
            folder / name,
            rng,
            Written(
                t,
                x,
                sensors,
                {"valve.inflow": (flow, "m^3/s")},
                spoil=spoil,
            ),
        )


def reservoir_leak(folder: Path, rng: Rng) -> Truth:
    _reservoir(folder, rng, 2.5e-4)
    return Truth("a steady outflow", PHYSICS, ("steady_inflow",))


def reservoir_unit(folder: Path, rng: Rng) -> Truth:
    _reservoir(folder, rng, 0.0, lambda column, t, v: v * 10.0)
    return Truth("the column is in mm and stated as cm", RECORDING)


def reservoir_saturated(folder: Path, rng: Rng) -> Truth:
    _reservoir(folder, rng, 0.0, lambda column, t, v: np.minimum(v, 62.0))
    return Truth("the level sensor ends at 62 cm, which is not stated", SENSOR)


# --- a radiator in a room, FMI 2 Co-Simulation; both temperatures
RADIATOR = OdeModel(
    "radiator",
    {"C_r": (9e3, "J/K"), "C_z": (6e4, "J/K"), "U": (28.0, "W/K"), "V": (15.0, "W/K")},
    {"power": "W"},
    {
        "T_r": ("K", "291.15", "(power - U*(T_r - T_z))/C_r"),
        "T_z": ("K", "291.15", "(U*(T_r - T_z) - V*(T_z - 278.15))/C_z"),
    },
    {"surface": ("K", "T_r"), "room": ("K", "T_z")},
    5.0,
)


def _radiator(folder: Path, rng: Rng, swap: bool = False, other: bool = False) -> None:
    RADIATOR.build(folder)
    stop = 21600.0
    parts = programme("boiler", ("power", "W")) + fmu("home", "radiator", "internal")
    scenario(folder, "A radiator", stop, 30, 30, parts, "  - boiler.power -> home.power\n")
    cr, cz, u1, v1 = (v * np.exp(0.05 * rng.standard_normal()) for v in (9e3, 6e4, 28.0, 15.0))
    for name in FOLDERS:
        power = drawn_steps(rng, stop, 3000, 0, 900, 30)
        wrong = drawn_steps(rng, stop, 3000, 0, 900, 30)

        def rates(t: float, x: Array, u: Array) -> list[float]:
            return [
                (u[0] - u1 * (x[0] - x[1])) / cr,
                (u1 * (x[0] - x[1]) - v1 * (x[1] - 278.15)) / cz,
            ]

        t, x = course(rates, (291.15, 291.15), (power,), stop, 15.0)
        first, second = (1, 0) if swap else (0, 1)
        sensors = [
            Sensor("home.surface", "T_surface_degF", "degF", _fahrenheit(first), 0.2, 60.0, 1.0, 0.1),
            Sensor("home.room", "T_room_degC", "degC", celsius(second), 0.1, 60.0, 1.0, 0.1),
        ]
        told: dict[str, Steps] = {"boiler.power": wrong} if other and name == "first" else {}
        write(
            folder / name,
            rng,
            Written(
                t,
                x,
                sensors,
                {"boiler.power": (power, "W")},
                Logger("min", gap=(9000.0, 9900.0)),
                recorded=["boiler.power"],
                told=told,
            ),
        )


def _fahrenheit(state: int) -> Callable[[Array, Array, Array], Array]:
    return lambda t, x, u: np.asarray((x[:, state] - CELSIUS) * 1.8 + 32.0)


def radiator_swapped(folder: Path, rng: Rng) -> Truth:
    _radiator(folder, rng, swap=True)
    return Truth("both thermometers are exchanged, one of them in degF", RECORDING)


def radiator_other_input(folder: Path, rng: Rng) -> Truth:
    _radiator(folder, rng, other=True)
    return Truth("the recorded power of the first recording is of another day", RECORDING + SENSOR)


def radiator_null(folder: Path, rng: Rng) -> Truth:
    _radiator(folder, rng)
    return Truth("nothing; a gap, degF beside degC", FINE)


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    cell_null,
    cell_diffusion,
    fermenter_null,
    fermenter_saturation,
    trolley_friction,
    trolley_early,
    trolley_alone,
    reservoir_leak,
    reservoir_unit,
    reservoir_saturated,
    radiator_swapped,
    radiator_other_input,
    radiator_null,
)
