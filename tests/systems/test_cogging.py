"""A force that repeats along the way is named with its period, and a spring that bends is none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.laws.motion.cogging import LAW
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from tests.systems.rigs import oscillator, oscillator_recordings

#: Largest acceleration [m/s^2], radians per metre and phase.
AMPLITUDE, WAVE, PHASE = 4.0, 60.0, 0.8


def _asked(folder: Path, law: object) -> Diagnosis:
    scenario = load_scenario(str(oscillator(folder)))
    every = [load_recording(r) for r in oscillator_recordings(folder, law)]  # type: ignore[arg-type]
    return diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis


def test_cogging_is_named_with_its_period(tmp_path: Path) -> None:
    found = _asked(tmp_path, lambda x, v: AMPLITUDE * np.sin(WAVE * x + PHASE))
    assert found.verdict is Verdict.MISSING_PHYSICS
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert finding.effect == "cogging"
    amplitude, wave, phase = finding.parameters
    assert abs(amplitude.value) == pytest.approx(AMPLITUDE, rel=0.05)
    assert wave.value == pytest.approx(WAVE, rel=0.01)
    assert wave.lower < WAVE < wave.upper
    own = np.sin(phase.value) if amplitude.value > 0.0 else -np.sin(phase.value)
    assert own == pytest.approx(np.sin(PHASE), abs=0.1)


def test_a_spring_that_hardens_is_no_cogging(tmp_path: Path) -> None:
    found = _asked(tmp_path, lambda x, v: -3e4 * x**3)
    assert [f.effect for f in found.findings if f.is_accepted] == ["cubic_spring"]


def test_waves_are_so_close_that_one_of_them_is_always_in_phase_with_what_lies_between() -> None:
    """Half a step of waves, over a way of four sizes, is less than half a period."""
    _, wave, _ = LAW.numbers
    assert np.max(np.diff(wave.starts)) / 2.0 * 4.0 < np.pi
    assert wave.least is not None
    assert 4.0 * wave.starts[0] > 1.9 * 2.0 * np.pi * 0.99  # two periods, or nearly
