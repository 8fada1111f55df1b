"""Clocks and lags have more than one minimum; recalibration takes the lower one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.search.fit import fit
from diagnosis.search.problem import Layout, Parameter, Point
from diagnosis.search.search import with_clocks_set

TIME = np.linspace(0.0, 1.0, 200)
#: A wave of 0.2 s: being late by a whole period explains it as well as being on time.
PERIOD = 0.2


class WaveModel:
    """measured = sin(2 pi (t - delay) / PERIOD) + noise; the prior of the delay has a deviation of 0.1 s."""

    def __init__(self, is_clock: bool) -> None:
        self.parameters = [Parameter("delay", "s", 0.0, 0.1, False, is_clock=is_clock)]
        self.layout = Layout(np.zeros(len(TIME)), TIME, ("wave",), ("measurement",))
        self.measured = np.sin(2.0 * np.pi * TIME / PERIOD) + 0.05 * np.random.default_rng(0).standard_normal(len(TIME))

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return np.array(
            [(self.measured - np.sin(2.0 * np.pi * (TIME - 0.1 * p.base[0]) / PERIOD)) / 0.05 for p in points]
        )

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        angle = 2.0 * np.pi * (TIME - 0.1 * point.base[0]) / PERIOD
        return np.asarray(np.cos(angle) * 0.2 * np.pi / PERIOD / 0.05)[:, None]


@pytest.mark.parametrize(("is_clock", "delay"), [(True, 0.0), (False, PERIOD)])
def test_a_clock_that_is_off_by_a_period_is_set_right_and_what_is_no_clock_stays(is_clock: bool, delay: float) -> None:
    model = WaveModel(is_clock)
    wrong = fit(model, Point(np.array([2.1])), iterations=50)
    assert 0.1 * wrong.point.base[0] == pytest.approx(PERIOD, abs=2e-3)  # no step leads out of this minimum
    found = with_clocks_set(model, wrong)
    # The delay is known to 0.05 PERIOD / (2 pi sqrt(100)) = 0.16 ms.
    assert 0.1 * found.point.base[0] == pytest.approx(delay, abs=1e-3)
    assert found.cost <= wrong.cost


def test_a_clock_that_is_nearly_right_is_not_fitted_again() -> None:
    model = WaveModel(True)
    near = fit(model, Point(np.array([0.1])), iterations=50)
    assert with_clocks_set(model, near) is near
