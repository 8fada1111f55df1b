"""Draws the figures of the actuators' pages from their FMUs: `python docs/actuators/figures.py [folder of FMUs]`."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.settings import FmuSettings
from cosim.unit.protocol import Array

ROOT = Path(__file__).resolve().parents[2]
IMAGES = ROOT / "docs" / "images"
STEP = 20_000_000
CELSIUS = 273.15
MODELS = ("thermal_stiffness", "instant_stiffness", "niti_kinetics", "tcp_muscle", "polypyrrole_film")
COLOURS = ("tab:blue", "tab:grey", "tab:red", "tab:green", "tab:purple")
#: Steel spring and stops of an arm, docs/mechanics.md.
STEEL_STIFFNESS, STEEL_LENGTH, STOPS = 150.0, 0.0585, (0.030, 0.033)


def load(folder: Path, model: str, parameters: Mapping[str, float] | None = None) -> CoSimulationUnit:
    """One element of a model."""
    settings = FmuSettings({"coils": 1}, parameters or {})
    return CoSimulationUnit(model, open_fmu(folder / f"{model}_fmi3.fmu"), settings)


def arm(folder: Path, model: str, seconds: float, off: float) -> dict[str, Array]:
    """One arm of a link without friction under 1 V until `off` [s]: length, force, power and the outputs over time."""
    unit, record, length = load(folder, model), [], STOPS[1]
    unit.initialise(0)
    drive = "voltage" if "voltage" in unit.variables else "power"
    names = ("temperature", "stiffness", "rest_length", "resistance", "stored_energy", "convected_energy")
    for index in range(int(seconds * 1e9) // STEP):
        k, rest = float(unit.get("stiffness")[0]), float(unit.get("rest_length")[0])
        length = float(np.clip((STEEL_STIFFNESS * STEEL_LENGTH + k * rest) / (STEEL_STIFFNESS + k), *STOPS))
        force, voltage = k * max(length - rest, 0.0), 1.0 if index * STEP < off * 1e9 else 0.0
        if "tension" in unit.variables:
            unit.set("tension", np.array([force]))
        power = voltage**2 / float(unit.get("resistance")[0])
        unit.set(drive, np.array([voltage if drive == "voltage" else power]))
        unit.do_step(index * STEP, STEP)
        record.append([(index + 1) * STEP / 1e9, length, force, power, *(float(unit.get(n)[0]) for n in names)])
    unit.terminate()
    return dict(zip(("time", "length", "force", "power", *names), np.array(record).T, strict=True))


def bath(folder: Path, model: str, temperatures: Array, tension: float = 0.0) -> Array:
    """Stiffness [N/m] of a coil that follows the temperature [K] of a stirred bath."""
    unit, record = load(folder, model, {"heat_transfer_coefficient": 9000.0}), []
    unit.set("ambient_temperature", np.array(temperatures[0]))
    if "tension" in unit.variables:
        unit.set("tension", np.array([tension]))
    unit.initialise(0)
    unit.set("power", np.array([1e-6]))  # counts as switched on, so that h A holds and no regressed rate
    for index, temperature in enumerate(temperatures):
        unit.set("ambient_temperature", np.array(temperature))
        unit.do_step(index * 5 * 10**9, 5 * 10**9)
        record.append(float(unit.get("stiffness")[0]))
    unit.terminate()
    return np.array(record)


def label(axes: Axes, x: str, y: str) -> None:
    """Axis labels and a light grid."""
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(alpha=0.3)


def draw_pulse(folder: Path, model: str) -> None:
    """Temperature, stiffness and rest length, and energy in one arm under a pulse of 1 V."""
    run = arm(folder, model, 60.0, 12.2)
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.4), layout="constrained")
    axes[0].plot(run["time"], run["temperature"] - CELSIUS, color="tab:red")
    label(axes[0], "time [s]", "temperature [°C]")
    axes[1].plot(run["time"], run["stiffness"], color="tab:blue")
    label(axes[1], "time [s]", "stiffness [N/m]")
    axes[1].yaxis.label.set_color("tab:blue")
    length = axes[1].twinx()
    length.plot(run["time"], 1e3 * run["rest_length"], color="tab:green")
    length.set_ylabel("rest length [mm]", color="tab:green")
    axes[2].plot(run["time"], np.cumsum(run["power"]) * STEP / 1e9, "k--", label="from the circuit")
    axes[2].plot(run["time"], run["stored_energy"], color="tab:orange", label="stored")
    axes[2].plot(run["time"], run["convected_energy"], color="tab:cyan", label="convected")
    label(axes[2], "time [s]", "energy [J]")
    axes[2].legend()
    for one in axes:
        one.axvspan(0.0, 12.2, color="k", alpha=0.06, lw=0)
    figure.suptitle(f"{model}: one arm of a link, 1 V for 12.2 s (grey)")
    figure.savefig(IMAGES / f"actuator_{model}.png", dpi=110)
    plt.close(figure)


def draw_loops(folder: Path) -> None:
    """Hysteresis of the two NiTi models: the paper's curve, minor loops, and the shift by stress."""
    figure, axes = plt.subplots(1, 2, figsize=(12, 4), layout="constrained", sharey=True)
    loop = np.concatenate([np.linspace(20, 75, 111), np.linspace(75, 20, 111)]) + CELSIUS
    turns = np.interp(np.arange(0, 7, 0.02), np.arange(8), np.array([20, 60, 42, 62, 48, 75, 45, 58])) + CELSIUS
    weight = 0.5 * 9.81
    for model, colour in (("thermal_stiffness", "tab:blue"), ("niti_kinetics", "tab:red")):
        axes[0].plot(loop - CELSIUS, bath(folder, model, loop, weight), color=colour, label=model)
        axes[0].plot(turns - CELSIUS, bath(folder, model, turns, weight), color=colour, lw=0.9, ls=":")
    axes[0].set_title("under 500 g; dotted: temperature turning inside the loop")
    for tension in (0.0, 2.0, 4.0, 6.0, 8.0):
        wide = np.concatenate([np.linspace(0, 95, 150), np.linspace(95, 0, 150)]) + CELSIUS
        shade = plt.get_cmap("plasma")(tension / 9.0)
        axes[1].plot(wide - CELSIUS, bath(folder, "niti_kinetics", wide, tension), color=shade, label=f"{tension:g} N")
    axes[1].set_title("niti_kinetics under other tensions")
    for one in axes:
        label(one, "temperature [°C]", "stiffness [N/m]")
        one.legend()
    figure.savefig(IMAGES / "actuator_hysteresis.png", dpi=110)
    plt.close(figure)


def draw_side_by_side(folder: Path) -> None:
    """Length and force of one arm with every model in turn."""
    figure, axes = plt.subplots(1, 2, figsize=(12, 4), layout="constrained")
    for model, colour in zip(MODELS, COLOURS, strict=True):
        run = arm(folder, model, 60.0, 20.0)
        axes[0].plot(run["time"], 1e3 * run["length"], color=colour, label=model)
        axes[1].plot(run["time"], run["force"], color=colour, label=model)
    label(axes[0], "time [s]", "length of the arm [mm]")
    label(axes[1], "time [s]", "tension of the actuator [N]")
    axes[1].legend()
    for one in axes:
        one.axvspan(0.0, 20.0, color="k", alpha=0.06, lw=0)
    figure.suptitle("One arm of a link (steel spring, stops at 30 and 33 mm, no friction), 1 V for 20 s (grey)")
    figure.savefig(IMAGES / "actuators_side_by_side.png", dpi=110)
    plt.close(figure)


def main(folder: Path) -> None:
    """Draw every figure."""
    for model in MODELS:
        draw_pulse(folder, model)
    draw_loops(folder)
    draw_side_by_side(folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build" / "fmus")
