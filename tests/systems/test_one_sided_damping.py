"""A damper that is harder in one direction than it is said to be, in the other as it is: one law, and not two."""

from __future__ import annotations

from pathlib import Path

import pytest

from diagnosis.judge.diagnosis import Verdict
from diagnosis.recording.recording import load_recording
from tests.systems.rigs import diagnosed, oscillator, oscillator_recordings

#: Damping per mass beside the 4 1/s that are stated [1/s].
MORE = 6.0


@pytest.mark.parametrize("direction", ["forward", "backward"])
def test_it_is_named_with_its_direction_and_nothing_stands_beside_it(tmp_path: Path, direction: str) -> None:
    sign = 1.0 if direction == "forward" else -1.0
    scenario = oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: -MORE * v if sign * v > 0.0 else 0.0)
    found = diagnosed(scenario, [load_recording(r) for r in recordings])
    assert found.verdict is Verdict.MISSING_PHYSICS
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert finding.effect == f"one_sided_damping_of_{direction}_motion"
    assert finding.is_named
    (damping,) = finding.parameters
    assert damping.value == pytest.approx(MORE, rel=0.05)
    assert damping.lower < MORE < damping.upper
