"""Two-mass oscillator: order of convergence against its closed form, and the energy that the coupling makes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from benchmarks.machine import heading, results_folder
from benchmarks.models import cosim_run, fmpy_loop
from benchmarks.models.build import build
from benchmarks.models.systems import TWO_MASS
from cosim.run import RunStopped

#: Communication steps [s]; each divides every stop time below.
STEPS = (4e-3, 2e-3, 1e-3, 5e-4)
#: Times at which the energy is looked at [s].
TIMES = (0.4, 0.8, 1.6, 3.2)
WALL, COUPLING = 4 * math.pi**2, 16 * math.pi**2
State = tuple[float, ...]
Simulate = Callable[[float, float], State]


def _cosim(method: cosim_run.Method) -> Simulate:
    return lambda step, stop: cosim_run.simulate(replace(TWO_MASS, stop=stop), 2, step, method)


def _fmpy(kind: str) -> Simulate:
    return lambda step, stop: fmpy_loop.simulate(replace(TWO_MASS, stop=stop), 2, step, kind)


#: What is measured: state at a stop time [s] with a step [s].
METHODS: dict[str, Simulate] = {
    "FMPy loop, Jacobi": _fmpy("jacobi"),
    "FMPy loop, Gauss-Seidel": _fmpy("gauss_seidel"),
    "cosim, jacobi": _cosim("jacobi"),
    "cosim, gauss_seidel": _cosim("gauss_seidel"),
    "cosim, iterated (inputs: end)": _cosim({"kind": "iterated", "inputs": "end"}),
    "cosim, iterated (inputs: mean)": _cosim({"kind": "iterated", "inputs": "mean"}),
}
#: Relative tolerances of step doubling; its steps within the macro-step follow from them.
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6)


def closed_form(time: float) -> State:
    """Displacement [m] and velocity [m/s] of the left mass, then of the right one.

    Unit masses, walls 4 pi^2 N/m, coupling 16 pi^2 N/m: the masses swing in phase with 2 pi and against each other with
    6 pi; from (1 m, 0) at rest both modes have the amplitude 1/2. Source: oscillator_left/model.c.
    """
    slow, fast = 2 * math.pi, 6 * math.pi
    in_phase, against = 0.5 * math.cos(slow * time), 0.5 * math.cos(fast * time)
    in_phase_rate, against_rate = -0.5 * slow * math.sin(slow * time), -0.5 * fast * math.sin(fast * time)
    return (in_phase + against, in_phase_rate + against_rate, in_phase - against, in_phase_rate - against_rate)


def energy(state: State) -> float:
    """Kinetic energy and that of the three springs [J]; 10 pi^2 in the closed form."""
    left, left_velocity, right, right_velocity = state
    kinetic = 0.5 * (left_velocity**2 + right_velocity**2)
    return kinetic + 0.5 * WALL * (left**2 + right**2) + 0.5 * COUPLING * (left - right) ** 2


def displacement_error(state: State, time: float) -> float:
    """Larger error of the two displacements [m]."""
    exact = closed_form(time)
    return max(abs(state[0] - exact[0]), abs(state[2] - exact[2]))


def convergence(simulate: Simulate) -> list[str]:
    """Rows of step, error of displacement and order."""
    rows, before = [], math.nan
    for step in STEPS:
        error = displacement_error(simulate(step, TWO_MASS.stop), TWO_MASS.stop)
        order = "" if math.isnan(before) else f"{math.log2(before / error):.2f}"
        rows.append(f"| {step * 1e3:g} | {error:.3e} | {order} |")
        before = error
    return rows


def error_control(tolerance: float) -> str:
    """Row of tolerance and error of displacement of step doubling, macro-step 10 ms."""
    method = {"kind": "step_doubling", "relative_tolerance": tolerance, "absolute_tolerance": tolerance}
    try:
        found = f"{displacement_error(_cosim(method)(1e-2, TWO_MASS.stop), TWO_MASS.stop):.3e}"
    except RunStopped as stopped:
        found = f"stops: {stopped.reason}"
    return f"| {tolerance:g} | {found} |"


def energy_row(name: str) -> str:
    """Relative error of the energy at the times, step 1 ms."""
    exact = energy(closed_form(0.0))
    found = [energy(METHODS[name](1e-3, time)) / exact - 1 for time in TIMES]
    return f"| {name} | " + " | ".join(f"{value:+.2e}" for value in found) + " |"


def main(arguments: list[str] | None = None) -> None:
    """Print and write the tables."""
    del arguments
    build()
    lines = [
        heading("Two-mass oscillator", "python -m benchmarks.two_mass"),
        "Force and displacement coupling, both halves exact between communication points. Error of the",
        f"displacements at {TWO_MASS.stop} s against the closed form; start (1 m, 0) at rest.",
    ]
    for name, simulate in METHODS.items():
        lines += ["", f"## {name}\n", "| step [ms] | error [m] | order |", "|---|---|---|", *convergence(simulate)]
    lines += [
        "",
        "## cosim, step_doubling, macro-step 10 ms\n",
        "| tolerance | error [m] |",
        "|---|---|",
        *(error_control(tolerance) for tolerance in TOLERANCES),
    ]
    lines += [
        "",
        "## Relative error of the energy, step 1 ms\n",
        "| | " + " | ".join(f"{t:g} s" for t in TIMES) + " |",
        "|---" * (1 + len(TIMES)) + "|",
        *(energy_row(name) for name in METHODS),
    ]
    text = "\n".join(lines) + "\n"
    (results_folder() / "two_mass.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
