"""Rigs for the tests of systems of FMUs: linear models as FMUs, and truths that SciPy integrates."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import yaml
from scipy.integrate import solve_ivp

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Diagnosis
from diagnosis.recording.recording import Recording
from diagnosis.search.search import Settings
from evaluation.fmus.model import OdeModel

OSCILLATOR = OdeModel(
    "oscillator",
    {"k": (400.0, "1/s^2"), "c": (4.0, "1/s"), "b": (100.0, "m/s^2/V"), "x_0": (0.0, "m"), "v_0": (0.0, "m/s")},
    {"u": "V"},
    {"x": ("m", "x_0", "v"), "v": ("m/s", "v_0", "b*u - k*x - c*v")},
    {"position": ("m", "x"), "speed": ("m/s", "v")},
)
TANK = OdeModel(
    "tank",
    {"area": (0.5, "m^2"), "leak": (0.02, "m^2/s"), "h_0": (0.4, "m")},
    {"inflow": "m^3/s"},
    {"h": ("m", "h_0", "(inflow - leak * h) / area")},
    {"level": ("m", "h"), "outflow": ("m^3/s", "leak * h")},
)
LUMP = OdeModel(
    "lump",
    {"capacity": (50.0, "J/K"), "loss": (0.4, "W/K"), "T_0": (300.0, "K")},
    {"power": "W", "room": "K"},
    {"T": ("K", "T_0", "(power - loss * (T - room)) / capacity")},
    {"temperature": ("K", "T")},
)
#: Seconds between two readings of the lump, and the temperature of its room [K].
LUMP_STEP, ROOM = 2.0, 294.15
LUMP_SCENARIO = """
title: A lump
time: {stop: 1000 s, macro_step: 2 s, output_step: 2 s}
components:
  drive: {kind: programme, outputs: {power: {unit: W, constant: 0 W}}}
  room: {kind: programme, outputs: {temperature: {unit: degC, constant: 21 degC}}}
  lump: {kind: fmu, fmu: lump.fmu, integrator: cvode}
connections: [drive.power -> lump.power, room.temperature -> lump.room]
"""
#: Seconds between two readings of the oscillator, and readings of a recording.
STEP, COUNT = 0.005, 800
OSCILLATOR_SCENARIO = """\
title: An oscillator of one mass
time: {stop: 4 s, macro_step: 5 ms, output_step: 5 ms}
components:
  drive: {kind: programme, outputs: {u: {unit: V, constant: 0 V}}}
  rig: {kind: fmu, fmu: oscillator.fmu, integrator: INTEGRATOR}
connections:
  - drive.u -> rig.u
"""


TANK_SCENARIO = """\
title: A tank
time: {stop: STOP, macro_step: STEP, output_step: STEP}
components:
  pump: {kind: programme, outputs: {inflow: {unit: m^3/s, constant: 0.01 m^3/s}}}
  tank: {kind: fmu, fmu: tank.fmu, integrator: cvode}
connections:
  - pump.inflow -> tank.inflow
"""


def drive(seed: int, size: float) -> Array:
    """Six sines below and above the resonance [V], shape (COUNT,)."""
    rng = np.random.default_rng(seed)
    times = STEP * np.arange(COUNT)
    rates, phases = rng.uniform(0.5, 5.0, 6), rng.uniform(0.0, 6.28, 6)
    return np.asarray(size * sum(np.sin(2.0 * np.pi * f * times + p) for f, p in zip(rates, phases)))


def held(rate: Callable[[Array, float], Array], start: Array, inputs: Array, step: float) -> Array:
    """Integrate with inputs that are held over each step, shape (steps, states)."""
    states = [start]
    for u in inputs[:-1]:
        end = solve_ivp(lambda _, x, u=u: rate(x, float(u)), (0.0, step), states[-1], rtol=1e-9, atol=1e-11)
        states.append(end.y[:, -1])
    return np.array(states)


def lump_course(power: Array) -> Array:
    """Temperature [K] of a lump whose loss and capacity are a few per cent from the model's, shape (steps,)."""

    def rate(x: Array, watt: float) -> Array:
        return np.array([(watt - 0.41 * (x[0] - ROOM)) / 49.0])

    return held(rate, np.array([300.0]), power, LUMP_STEP)[:, 0]


def write_recording(
    folder: Path,
    columns: dict[str, Array],
    inputs: dict[str, tuple[str, str]],
    channels: dict[str, tuple[str, str, str]],
    extra: str = "",
) -> Path:
    """A recording folder; inputs and channels are column and unit, channels with their noise too, empty if not stated.

    Column `t` is the time [s].
    """
    folder.mkdir(parents=True, exist_ok=True)
    names = list(columns)
    table = np.column_stack([columns[n] for n in names])
    np.savetxt(folder / "data.csv", table, delimiter=",", header=",".join(names), comments="", fmt="%.12g")
    about = {
        "title": folder.name,
        "source": "a test",
        "table": "data.csv",
        "time": {"column": "t", "unit": "s"},
        "inputs": {k: {"column": c, "unit": u} for k, (c, u) in inputs.items()},
        "channels": {
            k: {"column": c, "unit": u} | ({"noise": noise} if noise else {}) for k, (c, u, noise) in channels.items()
        },
    }
    text = yaml.safe_dump({k: v for k, v in about.items() if v}, sort_keys=False, allow_unicode=True)
    (folder / "recording.yaml").write_text(text + extra, encoding="utf-8")
    return folder


def built(model: OdeModel, scenario: str, folder: Path) -> Path:
    """The FMU with a scenario of it; returns the file of the scenario."""
    model.build(folder)
    path = folder / "scenario.yaml"
    path.write_text(scenario, encoding="utf-8")
    return path


def diagnosed(scenario: Path, every: Sequence[Recording]) -> Diagnosis:
    """What is said of three recordings, of which the last one judges."""
    options = Options(is_brief=True)
    return diagnose(load_scenario(str(scenario)), every[:2], every[2:], Settings(), options=options).diagnosis


def oscillator(folder: Path, integrator: str = "cvode") -> Path:
    """The FMU with its scenario; returns the scenario."""
    return built(OSCILLATOR, OSCILLATOR_SCENARIO.replace("INTEGRATOR", integrator), folder)


def tank(folder: Path, stop: str, step: str) -> Path:
    """The FMU of a tank with its scenario, whose end and steps are given; returns the scenario."""
    return built(TANK, TANK_SCENARIO.replace("STOP", stop).replace("STEP", step), folder)


def oscillator_recordings(
    folder: Path, law: Callable[[float, float], float], sizes: tuple[float, ...] = (0.3, 0.4, 0.5)
) -> list[Path]:
    """Recordings of an oscillator that has a law more, all numbers 1 to 2 % off, noise 1 mm.

    Args:
        folder: Where they go.
        law: Acceleration over position [m] and velocity [m/s].
        sizes: Of the drives [V].
    """
    found = []
    for number, size in enumerate(sizes):
        u = drive(number, size)

        def rate(x: Array, volt: float) -> Array:
            return np.array([x[1], 101.0 * volt - 396.0 * x[0] - 4.05 * x[1] + law(float(x[0]), float(x[1]))])

        states = held(rate, np.zeros(2), u, STEP)
        noise = 1e-3 * np.random.default_rng(100 + number).standard_normal(COUNT)
        columns = {"t": STEP * np.arange(COUNT), "u": u, "x": states[:, 0] + noise}
        found.append(
            write_recording(
                folder / f"run_{number + 1}", columns, {"drive.u": ("u", "V")}, {"rig.position": ("x", "m", "1 mm")}
            )
        )
    return found
