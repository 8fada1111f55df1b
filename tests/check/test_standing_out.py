"""One recording that stands out only once numbers that are off are fitted to the others."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis import standing_out
from diagnosis.candidates.registry import catalogue
from diagnosis.check import check
from diagnosis.check.beside import compare
from diagnosis.check.check import doubts_of
from diagnosis.check.odd_one_out import ALL_CHANNELS
from diagnosis.judge.diagnosis import Doubt, Verdict
from diagnosis.models.build import models_of
from diagnosis.recording.recording import load_recording
from diagnosis.refitted import Refitted
from diagnosis.standing_out import apart_once_refitted
from tests.systems.rigs import COUNT, STEP, diagnosed, drive, held, oscillator, oscillator_recordings

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


def _stuck(x: Array) -> Array:
    is_in = (TIMES > 1.2) & (TIMES < 1.6)
    return np.where(is_in, x[np.argmax(is_in)], x)


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


def _driven(
    folder: Path, number: int, other: Callable[[Array], Array], law: Callable[[float, float], float] = _stiffer
) -> list[Path]:
    """Recordings of the stiffer rig with its speed; one has another law, and states another course of its drive."""
    oscillator(folder)
    recordings = oscillator_recordings(folder, _stiffer, SIZES)
    own = oscillator_recordings(folder / "own", law, SIZES)[number]
    (recordings[number] / "data.csv").write_text((own / "data.csv").read_text())
    for n, recording in enumerate(recordings):
        table = pd.read_csv(recording / "data.csv")
        table["v"] = np.gradient(table["x"].to_numpy(), STEP)
        table["u"] = other(table["u"].to_numpy()) if n == number else table["u"]
        table.to_csv(recording / "data.csv", index=False)
        about = yaml.safe_load((recording / "recording.yaml").read_text(encoding="utf-8"))
        about["channels"]["rig.speed"] = {"column": "v", "unit": "m/s", "noise": "0.15 m/s"}
        (recording / "recording.yaml").write_text(yaml.safe_dump(about, sort_keys=False), encoding="utf-8")
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
        (_drifting, r"as if this sensor drifted in proportion to time, by 0\.0[45]\d+ m \([\d.]+ to [\d.]+\)"),
        (_off, r"as if this sensor was off by 0\.0[45]\d+ m \([\d.]+ to [\d.]+\) from about 1\.2"),
        (_stuck, r"as if this sensor stood still from 1\.2\d* to 1\.[56]\d* s, it is"),
        (_other_range, r"as if this sensor read 1\.2 times as much"),
    ],
    ids=["drift", "offset", "stuck", "range"],
)
def test_the_recording_and_what_its_sensor_would_have_done(
    sensor: Callable[[Array], Array], words: str, number: int, tmp_path: Path
) -> None:
    recordings = _spoiled(tmp_path, number, sensor)
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    before = doubts_of([compare(scenario, load_recording(r)) for r in recordings])
    # the spring that is off hides what it is
    assert not [d for d in before if d.kind == "odd one out" and d.subject != ALL_CHANNELS]
    (told,) = _told(tmp_path, recordings)
    assert (told.recording, told.subject) == (f"run_{number + 1}", "rig.position")
    assert re.search(words, told.statement), told.statement
    assert "look at this sensor" in told.remedy
    assert not told.is_serious


def test_what_no_sensor_explains_is_said_of_the_recording_alone(tmp_path: Path) -> None:
    (told,) = _told(tmp_path, _spoiled(tmp_path, 2, _bent))
    assert told.recording == "run_3"
    assert "as if this sensor" not in told.statement
    assert "input, start and day" in told.remedy


@pytest.mark.parametrize("number", [1, 2], ids=["fitted", "held out"])
def test_an_input_that_acted_by_another_size_is_told(number: int, tmp_path: Path) -> None:
    (told,) = _told(tmp_path, _driven(tmp_path, number, lambda u: u / 0.6))
    assert (told.recording, told.subject) == (f"run_{number + 1}", "drive.u")
    assert told.statement.startswith("with numbers fitted to the others, ")
    factor = re.search(r"with ([\d.]+) times what is stated of drive.u", told.statement)
    assert factor is not None
    assert float(factor[1]) == pytest.approx(0.6, rel=0.01)


def test_a_short_while_in_which_nothing_acted_is_told_of_the_input(tmp_path: Path) -> None:
    """The amplifier of the drive was off from 1.3 to 1.45 s of 4 s."""
    recordings = _driven(tmp_path, 1, lambda u: u)
    u = drive(1, SIZES[1])
    given = np.where((TIMES >= 1.3) & (TIMES < 1.45), 0.0, u)

    def rate(x: Array, volt: float) -> Array:
        return np.array([x[1], 101.0 * volt - 420.0 * x[0] - 4.05 * x[1]])

    states = held(rate, np.zeros(2), given, STEP)
    table = pd.read_csv(recordings[1] / "data.csv")
    table["x"] = states[:, 0] + 1e-3 * np.random.default_rng(7).standard_normal(COUNT)
    table["v"] = states[:, 1] + 0.15 * np.random.default_rng(8).standard_normal(COUNT)
    table.to_csv(recordings[1] / "data.csv", index=False)
    (told,) = _told(tmp_path, recordings)
    assert (told.recording, told.subject) == ("run_2", "drive.u")
    assert told.statement.startswith(
        "with numbers fitted to the others, with the recorded course of drive.u the scenario"
    )
    assert " as it is " not in told.statement
    assert (told.begin, told.end) == (pytest.approx(1.3, abs=0.02), pytest.approx(1.45, abs=0.02))


def test_a_number_that_is_another_in_one_recording_is_told_and_the_search_goes_on(tmp_path: Path) -> None:
    """A spring that was changed for one run: it may be a law that this run alone reaches."""
    (told,) = _told(tmp_path, _driven(tmp_path, 1, lambda u: u, lambda x, v: -124.0 * x))
    assert (told.recording, told.subject, told.kind) == ("run_2", "rig.k", "number")
    assert not told.is_serious
    stiffness = re.search(r"rig.k = ([\d.]+)", told.statement)
    assert stiffness is not None
    assert float(stiffness[1]) == pytest.approx(520.0, rel=0.02)


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
    monkeypatch.setattr(type(refitted._model), "can_be_refitted", property(lambda self: False))
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


def test_what_the_check_leaves_open_is_asked_again_beside_fitted_numbers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One doubt about the recording stays, with what is off."""
    monkeypatch.setattr(check, "sensor_of_one", lambda one, others: None)
    paths = _spoiled(tmp_path, 1, lambda x: x + 0.6 * TIMES / END)
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    (before,) = [d for d in doubts_of([compare(scenario, load_recording(r)) for r in paths]) if d.kind == "odd one out"]
    assert before.subject == ALL_CHANNELS
    found = diagnosed(tmp_path / "scenario.yaml", [load_recording(r) for r in paths])
    (doubt,) = [d for d in found.doubts if d.kind == "odd one out"]
    assert doubt.subject == "rig.position"
    assert "as if this sensor drifted" in doubt.statement


def test_where_nothing_is_known_beside_fitted_numbers_either_it_is_said_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for ask in ("sensor_of_one", "unit_of_input", "size_of_input", "other_course", "other_number", "changed_rig"):
        monkeypatch.setattr(check, ask, lambda one, others: None)
    monkeypatch.setattr(standing_out, "_of_rig", lambda refitted, number: None)
    paths = _driven(tmp_path, 1, lambda u: u, lambda x, v: -24.0 * x - 8.0 * v)
    found = diagnosed(tmp_path / "scenario.yaml", [load_recording(r) for r in paths])
    (doubt,) = [d for d in found.doubts if d.kind == "odd one out"]
    assert (doubt.recording, doubt.subject) == ("run_2", ALL_CHANNELS)
    assert doubt.statement.startswith("the scenario as it is")


@pytest.mark.parametrize("number", [1, 2], ids=["fitted", "held out"])
def test_an_input_of_the_opposite_sign_is_told(number: int, tmp_path: Path) -> None:
    (told,) = _told(tmp_path, _driven(tmp_path, number, lambda u: -u))
    assert (told.recording, told.subject, told.kind) == (f"run_{number + 1}", "drive.u", "sign")
    assert "with the opposite sign of what is stated of drive.u" in told.statement
    assert told.is_serious


def test_where_hardly_anything_is_explained_a_law_may_be_what_the_others_took_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A spring that hardens is taken for a stiffer one where numbers are fitted, and explains nothing elsewhere."""
    monkeypatch.setattr(standing_out, "_of_rig", lambda refitted, number: None)
    (told,) = _told(tmp_path, _driven(tmp_path, 1, lambda u: u[::-1].copy()))
    assert (told.recording, told.subject, told.is_serious) == ("run_2", ALL_CHANNELS, False)
    assert "and a law where the numbers of the others took it up" in told.remedy


def test_twins_of_one_title_are_not_left_out_of_the_fit(tmp_path: Path) -> None:
    refitted = _refitted(tmp_path, _spoiled(tmp_path, 1, _drifting))
    twins = [replace(one, recording=replace(one.recording, title="run")) for one in refitted._compared]
    assert Refitted(refitted._model, refitted._judge, twins).by_others("run") == []
