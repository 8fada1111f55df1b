"""Residuals do not depend on the process that simulates."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from cosim.compute import replicas
from cosim.compute.batch import Batches
from cosim.compute.cluster import choose_place
from cosim.scenario import load_scenario
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.models.systems.model import SystemModel
from diagnosis.recording.recording import load_recording
from diagnosis.search.problem import Point
from tests.systems.rigs import oscillator, oscillator_recordings


def test_two_processes_say_what_one_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(replicas, "WORTH", 0.0)
    scenario = load_scenario(str(oscillator(tmp_path)))
    recordings = [load_recording(r) for r in oscillator_recordings(tmp_path, lambda x, v: 0.0)]
    alone = ClosedLoopModel(scenario, recordings)
    both = ClosedLoopModel(scenario, recordings, batches=Batches(choose_place(2, None)))
    assert isinstance(both.model, SystemModel)
    assert isinstance(alone.model, SystemModel)
    zero = np.zeros(len(both.parameters))
    terms = both.model.terms()[:12]
    points = [Point(zero), *(Point(zero, {t: tuple(p.starts[0] for p in t.parameters)}) for t in terms)]
    both.residuals(points[:1])
    assert not alone.model._replicas._left
    (other,) = both.model._replicas._replicas
    end = time.monotonic() + 120.0
    while not other.look():
        assert other.process.poll() is None
        assert time.monotonic() < end, "the process does not answer"
        time.sleep(0.05)
    np.testing.assert_array_equal(both.residuals(points), alone.residuals(points))
    assert len(other.asked) == 0
    assert both.model._replicas._answered < 3 * len(points)  # the other process gave some
    assert both.simulations == alone.simulations
