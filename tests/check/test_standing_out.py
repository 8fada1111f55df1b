"""One recording that stands out only once numbers that are off are fitted to the others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.candidates.registry import catalogue
from diagnosis.check.beside import compare
from diagnosis.check.check import doubts_of
from diagnosis.judge.diagnosis import Doubt, Verdict
from diagnosis.models.build import models_of
from diagnosis.recording.recording import load_recording
from diagnosis.refitted import Refitted
from diagnosis.standing_out import apart_once_refitted
from tests.systems.rigs import COUNT, STEP, diagnosed, oscillator, oscillator_recordings

SIZES = (0.4, 0.5, 0.45)
TIMES: Array = STEP * np.arange(COUNT, dtype=np.float64)
END = float(TIMES[-1])


def _stiffer(x: float, v: float) -> float:
    """A spring 6 % stiffer than stated: it is recalibrated, and until then every recording is missed."""
    return -24.0 * x


def _drifting(x: Array) -> Array:
    return x + 0.05 * TIMES / END


def _off(x: Array) -> Array:
    return x + 0.05 * ((TIMES > 1.2) & (TIMES < 2.8))


def _other_range(x: Array) -> Array:
    return 1.2 * x


def _bent(x: Array) -> Array:
    """What no fault that is known of a sensor explains."""
    return x + 0.04 * np.sin(3.0 * TIMES)


def _spoiled(folder: Path, number: int, sensor: Callable[[Array], Array]) -> list[Path]:
    """Recordings of the stiffer rig, one of which was read by another sensor."""
    oscillator(folder)
    recordings = oscillator_recordings(folder, _stiffer, SIZES)
    table = pd.read_csv(recordings[number] / "data.csv")
    table["x"] = sensor(table["x"].to_numpy())
    table.to_csv(recordings[number] / "data.csv", index=False)
    return recordings


def _refitted(folder: Path, recordings: list[Path], held_out: int = 1) -> Refitted:
    scenario = load_scenario(str(folder / "scenario.yaml"))
    every = [compare(scenario, load_recording(r)) for r in recordings]
    read = [one.recording for one in every]
    fitted, judging = read[: len(read) - held_out], read[len(read) - held_out :]
    return Refitted(*models_of(scenario, fitted, judging, catalogue()), every)


def _told(folder: Path, recordings: list[Path]) -> list[Doubt]:
    return apart_once_refitted(_refitted(folder, recordings))


@pytest.mark.parametrize("number", [1, 2], ids=["fitted", "held out"])
@pytest.mark.parametrize(
    ("sensor", "words"),
    [
        (_drifting, "as if this sensor drifted in proportion to time"),
        (_off, "as if this sensor was off by as much from about 1.2"),
        (_other_range, "as if this sensor read 1.2 times as much"),
    ],
    ids=["drift", "offset", "range"],
)
def test_the_recording_and_what_its_sensor_would_have_done(
    sensor: Callable[[Array], Array], words: str, number: int, tmp_path: Path
) -> None:
    recordings = _spoiled(tmp_path, number, sensor)
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    before = doubts_of([compare(scenario, load_recording(r)) for r in recordings])
    assert not [d for d in before if d.kind == "odd one out"]  # the spring that is off hides it
    (told,) = _told(tmp_path, recordings)
    assert (told.recording, told.subject) == (f"run_{number + 1}", "rig.position")
    assert words in told.statement
    assert "look at this sensor" in told.remedy
    assert not told.is_serious


def test_what_no_sensor_explains_is_said_of_the_recording_alone(tmp_path: Path) -> None:
    (told,) = _told(tmp_path, _spoiled(tmp_path, 2, _bent))
    assert told.recording == "run_3"
    assert "as if this sensor" not in told.statement
    assert "input, start and day" in told.remedy


def test_nothing_stands_out_of_good_recordings_nor_by_a_law_that_all_of_them_reach(tmp_path: Path) -> None:
    oscillator(tmp_path)
    assert _told(tmp_path, oscillator_recordings(tmp_path, _stiffer, SIZES)) == []
    assert _told(tmp_path, oscillator_recordings(tmp_path, lambda x, v: -1e3 * x**3 - 24.0 * x, SIZES)) == []


def test_a_law_that_one_recording_alone_reaches_is_left_open(tmp_path: Path) -> None:
    """An end stop at 0.35 m: the second recording alone goes there, and nothing is said against its sensor."""
    oscillator(tmp_path)
    stop = lambda x, v: -24.0 * x - 4e3 * max(abs(x) - 0.35, 0.0) * np.sign(x)  # noqa: E731
    recordings = oscillator_recordings(tmp_path, stop, (0.1, 0.5, 0.12))
    (told,) = _told(tmp_path, recordings)
    assert told.recording == "run_2"
    assert "as if this sensor" not in told.statement
    assert "where it alone reaches that" in told.remedy


def test_it_is_not_asked_of_two_recordings_without_judges_or_of_what_is_known(tmp_path: Path) -> None:
    recordings = _spoiled(tmp_path, 2, _drifting)
    assert _told(tmp_path, recordings[1:]) == []
    assert apart_once_refitted(_refitted(tmp_path, recordings, held_out=0)) == []
    assert apart_once_refitted(_refitted(tmp_path, recordings, held_out=2)) == []  # one fit, nothing that foresees it
    assert apart_once_refitted(_refitted(tmp_path, recordings), {"run_3"}) == []


def test_a_fit_that_takes_minutes_is_not_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    refitted = _refitted(tmp_path, _spoiled(tmp_path, 2, _drifting))
    monkeypatch.setattr(type(refitted._model), "can_be_searched_again", property(lambda self: False))
    assert apart_once_refitted(refitted) == []


def test_a_diagnosis_says_which_recording_and_which_sensor_to_look_at(tmp_path: Path) -> None:
    """The held-out sensor drifts: no law is fitted to its readings, and none is said to fail to explain them."""
    recordings = [load_recording(r) for r in _spoiled(tmp_path, 2, _drifting)]
    found = diagnosed(tmp_path / "scenario.yaml", recordings)
    assert found.verdict is Verdict.CANNOT_TELL
    assert found.findings == ()
    assert "run_3 stands out: with numbers fitted to the others" in found.statement
    assert "as if this sensor drifted in proportion to time" in found.statement
    reasons = " ".join((found.statement, *found.notes))
    assert "no law that was tried explains" not in reasons
    assert "to which laws are fitted, no more is left than noise explains" in reasons


def test_twins_of_one_title_are_not_left_out_of_the_fit(tmp_path: Path) -> None:
    refitted = _refitted(tmp_path, _spoiled(tmp_path, 1, _drifting))
    twins = [replace(one, recording=replace(one.recording, title="run")) for one in refitted._compared]
    assert Refitted(refitted._model, refitted._judge, twins).by_others("run") == []
