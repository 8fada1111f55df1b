"""Whole diagnoses of the proving ground's network: a break in the third recording, a draught in the second, nothing."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.diagnose import Options, Result, diagnose
from diagnosis.judge.diagnosis import Verdict
from diagnosis.judge.events import event_of
from diagnosis.search.search import Settings
from evaluation.proving.effects.effect import Effect
from tests.events import network

pytestmark = pytest.mark.slow
SETUP = "small"


def diagnosed(folder: Path, effects: Sequence[Sequence[Effect]], seed: int = 5) -> Result:
    """Three recordings that are fitted and one held out."""
    recordings = network.recorded(folder, SETUP, effects, seed)
    scenario = load_scenario(network.SCENARIOS / f"{SETUP}.yaml")
    return diagnose(scenario, recordings[:3], recordings[3:], Settings(), options=Options(is_brief=True))


def held_out(found: Result) -> float:
    """Chi-square per held-out reading with what was found."""
    fits = [f for f in found.diagnosis.fit if f.is_held_out]
    return float(np.average([f.chi_square["after"] for f in fits], weights=[f.samples for f in fits]))


def test_a_coil_that_opens_in_the_third_recording_and_stays_open(tmp_path: Path) -> None:
    broken, before = network.open_coil(SETUP, 2, 1, 8.0), network.open_coil(SETUP, 2, 1, -1.0)
    found = diagnosed(tmp_path, [[], [], [broken], [before]])
    assert found.diagnosis.verdict is Verdict.MISSING_PHYSICS
    ((term, values),) = found.points["after"].terms.items()
    assert term.identifier == "open_coil"
    assert term.place == "coil[2,1]"
    event = event_of(term, values, found.training)
    assert event is not None
    assert event.recording == "day_3"
    assert event.seconds == pytest.approx(8.0, abs=0.5)
    assert held_out(found) < 1.5


def test_a_draught_of_the_second_recording_is_not_predicted_for_another_day(tmp_path: Path) -> None:
    found = diagnosed(tmp_path, [[], [network.draught(SETUP, 0.4, 30.0)], [], []])
    ((term, values),) = found.points["after"].terms.items()
    assert term.identifier == "draught"
    event = event_of(term, values, found.training)
    assert event is not None
    assert event.recording == "day_2"
    assert event.seconds == pytest.approx(30.0, abs=1.0)
    assert held_out(found) < 1.5


def test_three_programmes_without_an_event_have_none(tmp_path: Path) -> None:
    found = diagnosed(tmp_path, [[], [], [], []])
    assert not [t for t in found.points["after"].terms if any(p.is_instant for p in t.parameters)]
    assert held_out(found) < 1.5
