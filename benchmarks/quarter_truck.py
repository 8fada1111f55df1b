"""Quarter truck: the limit of the chassis height at 2 s, by step halving and by one monolithic solution."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.machine import heading, results_folder
from benchmarks.models import cosim_run, fmpy_loop
from benchmarks.models.build import build
from benchmarks.models.systems import QUARTER_TRUCK

#: Communication steps [s]; each divides 1 s, the time of the ground's step, into a whole number of steps.
STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4)
#: Parameters of the public case: kg, N/m, N s/m, m, 1/s.
CHASSIS = (400.0, 15e3, 1e3)
WHEEL = (40.0, 150e3, 0.0)
STEP_HEIGHT, BANDWIDTH = 0.1, 2 * math.pi * 10.0
Vector = np.ndarray[Any, np.dtype[np.float64]]
#: Height of the chassis at 2 s [m] with a step [s].
Simulate = Callable[[float], float]


def _fmpy(version: int, kind: str) -> Simulate:
    return lambda step: fmpy_loop.simulate(QUARTER_TRUCK, version, step, kind)[0]


def _cosim(method: cosim_run.Method) -> Simulate:
    return lambda step: cosim_run.simulate(QUARTER_TRUCK, 2, step, method)[0]


#: What is measured. All are of first order: the ground, which no loop contains, is held over each step.
METHODS: dict[str, Simulate] = {
    "FMPy loop, FMI 2.0, Jacobi": _fmpy(2, "jacobi"),
    "FMPy loop, FMI 2.0, Gauss-Seidel": _fmpy(2, "gauss_seidel"),
    "FMPy loop, FMI 3.0, Jacobi": _fmpy(3, "jacobi"),
    "cosim, jacobi": _cosim("jacobi"),
    "cosim, gauss_seidel": _cosim("gauss_seidel"),
    "cosim, iterated": _cosim("iterated"),
}


def _rates(time: float, x: Vector) -> Vector:
    """Rates of chassis height and velocity, wheel height and velocity, ground height; heights from equilibrium."""
    chassis, chassis_velocity, wheel, wheel_velocity, ground = x
    ground_velocity = STEP_HEIGHT * BANDWIDTH * math.exp(-BANDWIDTH * (time - 1.0))
    mass, stiffness, damping = CHASSIS
    suspension = stiffness * (wheel - chassis) + damping * (wheel_velocity - chassis_velocity)
    wheel_mass, tyre_stiffness, tyre_damping = WHEEL
    tyre = tyre_stiffness * (ground - wheel) + tyre_damping * (ground_velocity - wheel_velocity)
    return np.array(
        [chassis_velocity, suspension / mass, wheel_velocity, (tyre - suspension) / wheel_mass, ground_velocity]
    )


def monolithic(stop: float = QUARTER_TRUCK.stop) -> float:
    """Height of the chassis at `stop` [s] (after 1 s) in m, from all equations at once (DOP853, tolerance 1e-12).

    The system rests until the ground's step at 1 s, so the integration begins there. The tyre sees the integral of the
    filtered velocity, which is the step behind the filter.
    """
    solution = solve_ivp(_rates, (1.0, stop), np.zeros(5), method="DOP853", rtol=1e-12, atol=1e-14)
    return 1.0 + float(solution.y[0, -1])


def richardson(values: list[float]) -> float:
    """Limit of a first-order sequence whose step halves: orders 1 and 2 eliminated from its last three values."""
    first = [2 * fine - coarse for coarse, fine in itertools.pairwise(values)]
    return (4 * first[-1] - first[-2]) / 3


def table(simulate: Simulate) -> tuple[list[str], float]:
    """Rows of step, height, error and order; and the Richardson limit."""
    exact = monolithic()
    heights = [simulate(step) for step in STEPS]
    errors = [height - exact for height in heights]
    rows = []
    for i, step in enumerate(STEPS):
        found = f"{math.log2(abs(errors[i - 1] / errors[i])):.3f}" if i else ""
        rows.append(f"| {step:g} | {heights[i]:.9f} | {errors[i]:+.3e} | {found} |")
    return rows, richardson(heights)


def main(arguments: list[str] | None = None) -> None:
    """Print and write the tables."""
    del arguments
    build()
    lines = [
        heading("Quarter truck: height of the chassis at 2 s", "python -m benchmarks.quarter_truck"),
        "Chassis 400 kg on 15 kN/m and 1 kN s/m, wheel 40 kg on 150 kN/m without damping. The ground steps by",
        "0.1 m at 1 s, its derivative behind a 10 Hz filter. Start: chassis at 1 m, wheel at 0.5 m, at rest,",
        "springs compressed by the weights. One monolithic solution of all equations (SciPy DOP853): "
        f"{monolithic():.9f} m.",
    ]
    for name, simulate in METHODS.items():
        rows, limit = table(simulate)
        beside = limit - monolithic()
        lines += [
            "",
            f"## {name}\n",
            "| step [s] | height [m] | error [m] | order |",
            "|---|---|---|---|",
            *rows,
            "",
            f"Richardson limit {limit:.9f} m, {beside:+.1e} m from the monolithic solution.",
        ]
    text = "\n".join(lines) + "\n"
    (results_folder() / "quarter_truck.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
