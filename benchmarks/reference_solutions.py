"""Solutions of the Reference FMUs' equations, independent of the FMUs: closed forms, or SciPy at tight tolerance."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

Vector = np.ndarray[Any, np.dtype[np.float64]]
#: Times [s], shape (n,), to variable name to values, shape (n, ...).
Exact = Callable[[Vector], dict[str, Vector]]


def dahlquist(times: Vector) -> dict[str, Vector]:
    """dx/dt = -x, x(0) = 1."""
    return {"x": np.exp(-times)}


def van_der_pol(times: Vector) -> dict[str, Vector]:
    """x'' = (1 - x^2) x' - x from (2, 0), DOP853."""

    def rates(_time: float, x: Vector) -> list[float]:
        return [x[1], (1.0 - x[0] ** 2) * x[1] - x[0]]

    solution = solve_ivp(rates, (times[0], times[-1]), [2.0, 0.0], "DOP853", times, rtol=1e-12, atol=1e-13)
    return {"x0": solution.y[0], "x1": solution.y[1]}


def state_space(times: Vector) -> dict[str, Vector]:
    """dx/dt = x + u, y = x + u, x(0) = 0, u = (1, 2, 3): y = u exp(t)."""
    return {"y": np.exp(times)[:, None] * np.array([1.0, 2.0, 3.0])}


def bouncing_ball(times: Vector) -> dict[str, Vector]:
    """Free fall from 1 m, restitution 0.7; below 0.1 m/s the ball rests. At an impact the FMU's height is DBL_MIN."""
    gravity, restitution, slowest = 9.81, 0.7, 0.1
    begin, height, velocity = 0.0, 1.0, 0.0
    h, v = np.zeros_like(times), np.zeros_like(times)
    while True:
        impact = begin + (velocity + math.sqrt(velocity**2 + 2.0 * gravity * height)) / gravity
        flying = (times >= begin) & (times < impact)
        t = times[flying] - begin
        h[flying], v[flying] = height + velocity * t - 0.5 * gravity * t**2, velocity - gravity * t
        velocity = restitution * (gravity * (impact - begin) - velocity)
        begin, height = impact, sys.float_info.min
        if velocity < slowest:
            return {"h": h, "v": v}


def robertson(times: Vector) -> dict[str, Vector]:
    """Robertson's chemical kinetics from (1, 0) at the first time, Radau."""

    def rates(_time: float, y: Vector) -> list[float]:
        fast = 1e4 * y[1] * (1.0 - y[0] - y[1])
        return [-0.04 * y[0] + fast, 0.04 * y[0] - fast - 3e7 * y[1] ** 2]

    solution = solve_ivp(rates, (times[0], times[-1]), [1.0, 0.0], "Radau", times, rtol=1e-11, atol=1e-15)
    y1, y2 = solution.y
    return {"y1": y1, "y2": y2, "y3": 1.0 - y1 - y2}


EXACT: dict[str, Exact] = {
    "Dahlquist": dahlquist,
    "VanDerPol": van_der_pol,
    "StateSpace": state_space,
    "BouncingBall": bouncing_ball,
    "Roberts": robertson,
}
