"""Two-mass oscillator: order of convergence against its closed form, and the energy that the coupling makes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from benchmarks.machine import heading, results_folder
from benchmarks.models import cosim_run, fmpy_loop
from benchmarks.models.build import build
from benchmarks.models.systems import TWO_MASS, System

#: Communication steps [s]; each divides every stop time below.
STEPS = (4e-3, 2e-3, 1e-3, 5e-4)
#: Times at which the energy is looked at [s].
TIMES = (0.4, 0.8, 1.6, 3.2)
WALL, COUPLING = 4 * math.pi**2, 16 * math.pi**2
State = tuple[float, ...]
Simulate = Callable[[System, int, float, str], State]
#: Name of the tool to how it runs, with the algorithms that it has.
TOOLS: dict[str, tuple[Simulate, tuple[str, ...]]] = {
    "FMPy loop": (fmpy_loop.simulate, ("jacobi", "gauss_seidel")),
    "cosim": (cosim_run.simulate, ("jacobi", "gauss_seidel")),
}


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


def convergence(simulate: Simulate, kind: str) -> list[str]:
    """Rows of step, error of displacement and order."""
    rows, before = [], math.nan
    for step in STEPS:
        error = displacement_error(simulate(TWO_MASS, 2, step, kind), TWO_MASS.stop)
        order = "" if math.isnan(before) else f"{math.log2(before / error):.2f}"
        rows.append(f"| {step * 1e3:g} | {error:.3e} | {order} |")
        before = error
    return rows


def energy_row(name: str, simulate: Simulate, kind: str) -> str:
    """Relative error of the energy at the times, step 1 ms."""
    exact = energy(closed_form(0.0))
    found = [energy(simulate(replace(TWO_MASS, stop=time), 2, 1e-3, kind)) / exact - 1 for time in TIMES]
    return f"| {name}, {kind} | " + " | ".join(f"{value:+.2e}" for value in found) + " |"


def main(arguments: list[str] | None = None) -> None:
    """Print and write the tables."""
    del arguments
    build()
    lines = [heading("Two-mass oscillator", "python -m benchmarks.two_mass"),
             "Force and displacement coupling, both halves exact between communication points. Error of the",
             f"displacements at {TWO_MASS.stop} s against the closed form; start (1 m, 0) at rest."]  # fmt: skip
    for name, (simulate, kinds) in TOOLS.items():
        for kind in kinds:
            lines += ["", f"## {name}, {kind}\n", "| step [ms] | error [m] | order |", "|---|---|---|",
                      *convergence(simulate, kind)]  # fmt: skip
    lines += ["", "## Relative error of the energy, step 1 ms\n", "| | " + " | ".join(f"{t:g} s" for t in TIMES) + " |",
              "|---" * (1 + len(TIMES)) + "|"]  # fmt: skip
    lines += [energy_row(name, simulate, kind) for name, (simulate, kinds) in TOOLS.items() for kind in kinds]
    text = "\n".join(lines) + "\n"
    (results_folder() / "two_mass.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
