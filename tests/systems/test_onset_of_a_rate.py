"""A fan that sets in where the plate is warm enough: one law of the plate's own temperature, and nothing beside it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Verdict
from diagnosis.recording.recording import load_recording
from tests.check.test_other_course import C_1, C_2, G_OUT, STEP, G, _power, recordings_of
from tests.systems.rigs import diagnosed, held

#: Temperature from which it blows [K], and what it takes off [W/K].
WARM, FAN = 318.0, 1.2


def _rate(x: Array, u: float) -> Array:
    through = 0.99 * G * (x[0] - x[1])
    fan = FAN * max(float(x[0]) - WARM, 0.0)
    return np.array([(u - through - fan) / (1.01 * C_1), (through - 0.98 * G_OUT * (x[1] - 295.0)) / C_2])


def test_it_is_described_at_its_place_with_its_onset_and_stands_alone(tmp_path: Path) -> None:
    def made(run: int) -> tuple[Array, Array]:
        warm = held(_rate, np.array([295.0, 295.0]), _power(run), STEP)
        assert (warm[:, 0] > WARM).mean() > 0.1
        return _power(run), warm

    recordings = recordings_of(tmp_path, made)
    found = diagnosed(tmp_path / "scenario.yaml", [load_recording(r) for r in recordings])
    assert found.verdict is Verdict.UNNAMED_PHYSICS
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.place) == ("rate_spline", "stack.plate")
    onset = next(p for p in finding.parameters if p.name == "onset")
    assert onset.value == pytest.approx(WARM, abs=0.5)
