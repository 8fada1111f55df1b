"""`mechanical` is said of mechanisms alone: the level of a tank is a length too."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.locate.locate import closed
from diagnosis.recording.quantity import Target
from diagnosis.search.problem import Layout


@pytest.mark.parametrize(
    ("target", "unit"),
    [
        (Target("tank", (), "level", "m"), "other"),
        (Target("tank", (), "h", "m"), "other"),
        (Target("reactor", (), "concentration", "1"), "other"),
        (Target("cart", (), "position", "m"), "mechanical"),
        (Target("arm", (), "angle", "rad"), "mechanical"),
        (Target("marker", (3,), "z"), "mechanical"),
        (Target("coil", (1,), "temperature"), "thermal"),
    ],
)
def test_a_part_is_called_mechanical_where_it_is_known_to_be(target: Target, unit: str) -> None:
    times = np.linspace(0.0, 1.0, 50)
    series = SimpleNamespace(channel=SimpleNamespace(target=target))
    layout = Layout(np.zeros(50), times, (str(target),), (target.domain,))
    model: Any = SimpleNamespace(layout=layout, runs=(SimpleNamespace(series=(series,)),))
    fit: Any = SimpleNamespace(residuals=np.sin(9.0 * times))
    (found,) = closed(model, fit)
    assert found.unit == unit
