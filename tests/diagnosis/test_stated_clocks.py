"""Recalibration keeps clocks and lags within what a recording states of them."""

from __future__ import annotations

import numpy as np
import pytest

from diagnosis.models.coil_network.free import Clocks, free_parameters
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.priors import DailyPriors
from diagnosis.search.problem import Parameter


def _parameters(clocks: Clocks) -> dict[str, Parameter]:
    found = free_parameters(CoilNetworkLayout(2, (2,)), {}, {"temperature"}, clocks, {}, DailyPriors())
    return {f.parameter.name: f.parameter for f in found}


def test_a_clock_and_a_lag_end_at_their_stated_bounds() -> None:
    found = _parameters(Clocks({"temperature": 0.2}, {"temperature": 0.5}))
    clock, lag = found["delay of every temperature"], found["lag of every temperature"]
    assert [clock.value(s * clock.bounds) for s in (-1.0, 1.0)] == pytest.approx([-0.2, 0.2], rel=1e-12)
    assert lag.value(lag.bounds) == pytest.approx(0.5, rel=1e-12)
    assert lag.value(0.0) == pytest.approx(0.1, rel=1e-12)  # a fifth of the bound is typical
    assert 0.0 < lag.value(-lag.bounds) < 0.05
    assert np.isclose(clock.deviation, 0.1)


def test_what_is_not_stated_is_no_parameter() -> None:
    assert _parameters(Clocks({}, {})) == {}
