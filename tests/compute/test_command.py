"""What a user sees of simulations that take long: lines of progress, and refusals that lose nothing."""

from __future__ import annotations

import numpy as np
import pytest
from rich.console import Console

from cosim.compute import display as shown
from cosim.compute.batch import Batches
from cosim.compute.cache import Cache
from cosim.compute.display import Display
from cosim.compute.result import Result, Task
from cosim.unit.errors import InputError
from diagnosis.command import diagnose
from tests.compute.work import square


def test_without_a_terminal_progress_is_a_line_now_and_then(monkeypatch, capsys):
    monkeypatch.setattr(shown, "INTERVAL", 0.0)
    display = Display(Console(stderr=True, force_terminal=False))
    with display.drawn():
        display.stage("recalibrating")
        display.progress.enter("contact scatter", expected=4)
        Batches(progress=display.progress).results(square, 1.0, [Task("a", 1.0), Task("b", 2.0)])
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "recalibrating"
    assert lines[-1] == "contact scatter: 2 of about 4 simulations, 2 s left"


def test_lines_do_not_come_faster_than_the_interval(capsys):
    display = Display(Console(stderr=True, force_terminal=False))
    for number in range(100):
        display.stage(f"stage {number}")
    assert capsys.readouterr().err == ""


def test_simulations_of_an_interrupted_diagnosis_are_not_overwritten_unasked(tmp_path):
    cache = Cache(tmp_path / "out" / "simulations")
    cache.put("ab", Result((np.ones(2),), "", 1.0))
    with pytest.raises(InputError, match="an interrupted diagnosis left its simulations here") as refusal:
        diagnose("pendulum", [tmp_path / "r"], out=tmp_path / "out", held_out=[tmp_path / "h"])
    assert "--resume" in refusal.value.remedy
    assert cache.count() == 1


def test_resuming_goes_past_that_refusal(tmp_path):
    Cache(tmp_path / "out" / "simulations").put("ab", Result((np.ones(2),), "", 1.0))
    with pytest.raises(InputError, match="there is no recording here"):
        diagnose("pendulum", [tmp_path / "r"], out=tmp_path / "out", held_out=[tmp_path / "h"], resume=True)
