"""Starts that a recording says it does not know, by whatever name the rig's own FMU gives them."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from cosim.unit.quantity import PhysicalValue
from diagnosis.check.start import _stated


@pytest.mark.parametrize(
    ("channel", "unit", "uncertain", "deviation"),
    [
        ("oven.chamber", "K", {"oven.T_begin": PhysicalValue(12.0, "K")}, 12.0),
        ("oven.chamber", "K", {"oven.mass": PhysicalValue(2.0, "kg")}, 0.0),  # another quantity
        ("oven.chamber", "K", {"fan.T_begin": PhysicalValue(12.0, "K")}, 0.0),  # another component
        ("tank.level", "m", {"tank.h0": PhysicalValue(5.0, "mm")}, 0.005),
        ("coil[1,2].temperature", "K", {"coils.initial_temperature": PhysicalValue(3.0, "K")}, 3.0),
        ("tank.level", "m", {}, 0.0),
    ],
)
def test_a_start_counts_by_its_quantity_and_component(channel, unit, uncertain, deviation):
    compared = SimpleNamespace(recording=SimpleNamespace(uncertain=uncertain))
    beside = SimpleNamespace(channel=SimpleNamespace(name=channel, unit=unit))
    assert _stated(compared, beside) == pytest.approx(deviation)
