"""An input that acted by another size than one recording states: a unit of its course, or a heater that is weaker."""

from __future__ import annotations

import re
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.run import RunStopped
from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from cosim.unit.quantity import conversion
from diagnosis.check import size_of_input as size_of_input_module
from diagnosis.check.beside import Compared, compare
from diagnosis.check.input_runs import InputRuns
from diagnosis.check.size_of_input import size_of_input
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from tests.check.test_other_course import HOLD, STEP, _doubts, _power, recordings_of, temperatures


def _recordings(folder: Path, factor: float, level: float = 1.0) -> list[Path]:
    """Three runs whose power is stated as a course under `overrides`, that of the second `factor` times as large."""

    def made(run: int) -> tuple[Array, Array]:
        return _power(run), temperatures((level if run == 2 else 1.0) * _power(run))

    found = recordings_of(folder, made)
    for run, path in enumerate(found, 1):
        about = yaml.safe_load((path / "recording.yaml").read_text(encoding="utf-8"))
        about.pop("inputs")
        held = (factor if run == 2 else 1.0) * _power(run)[::HOLD]
        points = [[f"{STEP * HOLD * n:g} s", f"{float(p)!r} W"] for n, p in enumerate(held)]
        about["overrides"] = {"components": {"heater": {"outputs": {"power": {"points": points}}}}}
        (path / "recording.yaml").write_text(yaml.safe_dump(about, sort_keys=False), encoding="utf-8")
    return found


def _told(folder: Path, recordings: list[Path]) -> list[Doubt]:
    return [d for d in _doubts(folder, recordings) if d.recording == "run_2" and d.subject == "heater.power"]


@pytest.mark.parametrize("written", ["Btu/h", "kcal/h"])
def test_a_course_that_is_stated_in_another_unit_is_told_with_the_unit(tmp_path: Path, written: str) -> None:
    factor = conversion("W", written)[0]
    (doubt,) = _told(tmp_path, _recordings(tmp_path, factor))
    assert (doubt.kind, doubt.is_serious) == ("unit", True)
    assert f"as if it were in {written} and not in W, at least" in doubt.statement
    assert float(re.findall(r"with ([\d.]+) times", doubt.statement)[0]) == pytest.approx(1.0 / factor, rel=0.02)
    assert "the course of heater.power under `overrides`" in doubt.remedy


@pytest.mark.parametrize("level", [0.6, 0.8])
def test_a_heater_that_is_weaker_in_one_recording_is_told_with_how_much(tmp_path: Path, level: float) -> None:
    (doubt,) = _told(tmp_path, _recordings(tmp_path, 1.0, level))
    assert doubt.kind == "number"
    assert "as if it were in" not in doubt.statement
    assert float(re.findall(r"with ([\d.]+) times", doubt.statement)[0]) == pytest.approx(level, rel=0.02)


def test_recordings_that_are_met_are_asked_nothing(tmp_path: Path) -> None:
    assert _told(tmp_path, _recordings(tmp_path, 1.0)) == []


def _compared(folder: Path, recordings: list[Path]) -> list[Compared]:
    scenario = load_scenario(str(folder / "scenario.yaml"))
    one, *others = (compare(scenario, load_recording(r)) for r in (recordings[1], recordings[0], recordings[2]))
    return [one, *others]


def test_runs_that_stop_explain_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    one, *others = _compared(tmp_path, _recordings(tmp_path, 3.4))
    assert size_of_input(one, others) is not None

    def stops(*_: object) -> None:
        raise RunStopped("it ran away", None, False)  # type: ignore[arg-type]

    monkeypatch.setattr(InputRuns, "readings", stops)
    assert size_of_input(one, others) is None


def test_an_input_that_stays_has_no_size_that_could_be_told(tmp_path: Path) -> None:
    one, *others = _compared(tmp_path, _recordings(tmp_path, 3.4))
    (course,) = one.courses
    still = replace(one, courses=(replace(course, values=np.full_like(course.values, 20.0)),))
    assert size_of_input(one, others) is not None
    assert size_of_input(still, others) is None


def test_an_input_of_one_sign_is_not_asked_for_the_other(tmp_path: Path) -> None:
    """A heater takes no power back: its unit gives the sign, and nothing is simulated."""
    recordings = _recordings(tmp_path, 1.0, 0.6)
    one = compare(load_scenario(str(tmp_path / "scenario.yaml")), load_recording(recordings[1]))
    (course,) = one.courses
    with closing(InputRuns(one)) as runs:
        assert size_of_input_module._turned(runs, one.channels, course).left == np.inf
        both = replace(course, values=course.values - 10.0)
        assert np.isfinite(size_of_input_module._turned(runs, one.channels, both).left)
