"""A diagnosis whose time is limited answers with what it has found, and says that it stopped."""

from __future__ import annotations

import itertools
import os
import signal
from pathlib import Path

import pytest

from cosim.compute.steps import Steps, TimeIsOver, counted, may_be_left, was_left, watched, without_usual_time
from cosim.interrupt import first_interrupt
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.command import _is_stopped
from diagnosis.diagnose import _TIME_IS_OVER, Options, _refuse_what_does_not_serve, diagnose
from diagnosis.experiment.limits import parse_time
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from tests.diagnosis.test_pendulum_batch import made
from tests.systems.rigs import oscillator, oscillator_recordings

SETTINGS = Settings(nulls=1)


def test_only_what_may_be_left_is_left_once_the_time_is_over() -> None:
    now = itertools.count()
    done: list[int] = []
    with watched(Steps(lambda text: None, now=lambda: float(next(now)), most=0.0)) as steps:
        for n in counted([1, 2, 3], "needed"):
            done.append(n)
        steps("another stage")
        assert not was_left()
        with pytest.raises(TimeIsOver), may_be_left():
            done.extend(counted([4, 5, 6], "optional"))
        assert was_left()
        with may_be_left(False):
            steps("needed as well")
        for n in counted([7], "needed again"):
            done.append(n)
    assert done == [1, 2, 3, 4, 7]  # an item that is begun is done
    assert not was_left()  # nobody watches


def test_nothing_is_left_while_there_is_time() -> None:
    with watched(Steps(lambda text: None)), may_be_left():
        assert list(counted([1, 2], "items")) == [1, 2]
        assert not was_left()


def answer(folder: Path, most: float, stages: list[str]) -> Diagnosis:
    """Of an oscillator with a force that no law of the library has; its stages are told."""
    oscillator(folder)
    every = oscillator_recordings(folder, lambda x, v: -60.0 * x / (0.02 + abs(x)) ** 0.5, (0.4, 0.5, 0.45))
    read = [load_recording(r) for r in every]
    scenario = load_scenario(folder / "scenario.yaml")
    with watched(Steps(stages.append, most=most)) as steps:
        return diagnose(scenario, read[:2], read[2:], Settings(nulls=1), steps, Options(is_brief=True)).diagnosis


def test_a_diagnosis_without_any_time_answers_by_its_first_effect_and_says_that_it_stopped(tmp_path: Path) -> None:
    stages: list[str] = []
    found = answer(tmp_path, 0.0, stages)
    assert _TIME_IS_OVER in found.searched.untried
    assert found.notes[-1].startswith("Stopped by `--stop-after` (10 min where nothing is said), Ctrl-C or SIGTERM: ")
    assert found.verdict in (Verdict.CANNOT_TELL, Verdict.UNNAMED_PHYSICS, Verdict.MISSING_PHYSICS)
    assert found.adequacy is not None
    assert found.adequacy.chi_square["after"] <= found.adequacy.chi_square["recalibrated"]
    assert any(s.startswith("looking for a first effect") for s in stages)
    assert not any(s.startswith(("searching again", "looking for a third effect")) for s in stages), stages


def test_what_may_not_be_left_is_not_stopped() -> None:
    with watched(Steps(lambda text: None)) as steps:
        assert not steps.stop()
        assert list(counted([1, 2], "needed")) == [1, 2]
        with may_be_left():
            assert steps.stop()
        with pytest.raises(TimeIsOver), may_be_left():
            list(counted([3, 4], "optional"))
        assert was_left()


def test_an_interrupted_search_answers_with_what_it_has(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    oscillator(tmp_path)
    every = oscillator_recordings(tmp_path, lambda x, v: -60.0 * x / (0.02 + abs(x)) ** 0.5, (0.4, 0.5, 0.45))
    read = [load_recording(r) for r in every]
    told: list[str] = []

    def shown(text: str) -> None:
        if text.startswith("looking for a second effect: ") and not any("second effect: " in t for t in told):
            os.kill(os.getpid(), signal.SIGINT)
        told.append(text)

    with watched(Steps(shown)) as steps, first_interrupt(lambda: _is_stopped(steps)):
        options = Options(is_brief=True)
        found = diagnose(load_scenario(tmp_path / "scenario.yaml"), read[:2], read[2:], SETTINGS, steps, options)
    assert _TIME_IS_OVER in found.diagnosis.searched.untried
    assert found.diagnosis.adequacy is not None
    assert not any(t.startswith("looking for a third effect") for t in told)
    assert "Ctrl-C again gives it up" in capfd.readouterr().err


def test_a_usual_time_ends_what_may_be_left_and_not_what_goes_on_without_it() -> None:
    """Of fabrics and pendulums runs are kept: nobody asked for an end, and none is refused."""
    with watched(Steps(lambda text: None, most=0.0, is_usual=True)) as steps:
        assert not steps.has_end
        with pytest.raises(TimeIsOver), may_be_left():
            list(counted([1, 2], "optional"))
        without_usual_time()
        with may_be_left():
            assert list(counted([1, 2], "optional")) == [1, 2]
    with watched(Steps(lambda text: None, most=0.0)) as steps:
        assert steps.has_end
        without_usual_time()
        with pytest.raises(TimeIsOver), may_be_left():
            list(counted([1, 2], "asked for"))


def test_what_runs_in_batches_goes_on_beyond_the_usual_time() -> None:
    with watched(Steps(lambda text: None, most=0.0, is_usual=True)), may_be_left():
        _refuse_what_does_not_serve(True, Options())
        assert list(counted([1, 2], "optional")) == [1, 2]
    with watched(Steps(lambda text: None, most=0.0, is_usual=True)), may_be_left():
        _refuse_what_does_not_serve(False, Options())
        with pytest.raises(TimeIsOver):
            list(counted([1, 2], "optional"))


@pytest.mark.parametrize("text", ["0 s", "-1 min", "soon", "3 m", "10"])
def test_a_time_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="--stop-after"):
        parse_time(text)


def test_runs_of_the_co_simulation_are_resumed_and_not_cut_short(tmp_path: Path) -> None:
    swing = made(tmp_path / "swing", 1)
    with pytest.raises(InputError, match="--resume"), watched(Steps(lambda text: None, most=60.0)) as steps:
        diagnose(load_scenario("pendulum"), [swing], [], Settings(), steps)
