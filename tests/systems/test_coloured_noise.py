"""Noise that is alike from one reading to the next, as behind a filter, is neither physics nor a fault of a sensor."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.judge.agreement import times_white
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.judge.headline import notes
from diagnosis.judge.verdict import evident
from diagnosis.recording.recording import load_recording
from tests.diagnosis.report_examples import ADEQUACY, CONTACT
from tests.systems.rigs import LUMP, LUMP_SCENARIO, LUMP_STEP, diagnosed, lump_course, write_recording

COUNT = 500
QUIET = replace(ADEQUACY, is_rejected=False, is_training_rejected=False, day=(), alike={"a": 0.8, "b": 0.6})
SUGGESTED = replace(CONTACT, is_accepted=False, gain=30.0, channels=("a", "b"))


def _noise(rng: np.random.Generator, correlation: float) -> Array:
    """Autoregressive noise of first order with deviation 1, shape (COUNT,)."""
    values = rng.standard_normal(COUNT)
    for i in range(1, COUNT):
        values[i] = correlation * values[i - 1] + math.sqrt(1.0 - correlation**2) * values[i]
    return values


def _diagnosed(folder: Path, seed: int, correlation: float, offset: float = 0.0) -> Diagnosis:
    """Three runs of a lump whose numbers are a few per cent off; in the second its thermometer may be off for 200 s."""
    LUMP.build(folder)
    (folder / "scenario.yaml").write_text(LUMP_SCENARIO, encoding="utf-8")
    every = []
    for number in range(3):
        rng = np.random.default_rng([seed, number])
        power = np.repeat(rng.uniform(0.0, 30.0, 25), 20)
        times, truth = LUMP_STEP * np.arange(COUNT), lump_course(power)
        if number == 1:
            truth = truth + offset * ((times > 300.0) & (times < 500.0))
        columns = {"t": times, "P": power, "T": truth + 0.1 * _noise(rng, correlation)}
        channels = {"lump.temperature": ("T", "K", "0.1 K")}
        path = write_recording(folder / f"run_{number + 1}", columns, {"drive.power": ("P", "W")}, channels)
        every.append(load_recording(path))
    return diagnosed(folder / "scenario.yaml", every)


@pytest.mark.parametrize(("correlation", "seed"), [(0.8, 1), (0.8, 2), (0.9, 1), (0.9, 2)])
def test_coloured_noise_accuses_nothing(tmp_path: Path, correlation: float, seed: int) -> None:
    """With noise taken for white one of these blamed a thermometer, and three could not be told."""
    found = _diagnosed(tmp_path, seed, correlation)
    assert found.verdict in (Verdict.CONSISTENT, Verdict.RECALIBRATED), found.statement
    assert not found.findings
    assert any("Noise behind a filter does so" in note for note in found.notes)


def test_a_thermometer_that_is_off_is_blamed_beside_such_noise_too(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, 2, 0.8, offset=0.8)
    assert found.verdict is Verdict.MEASUREMENT_FAULT
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert finding.recording == "run_2"


def test_a_mean_of_coloured_noise_scatters_as_bartlett_says() -> None:
    """The variance of the mean of 500 values is (1 + c)/(1 - c) times that of white noise, less an end effect."""
    rng = np.random.default_rng(5)
    means = [np.mean(_noise(rng, 0.8)) for _ in range(4000)]
    assert COUNT * np.var(means) == pytest.approx(times_white({"a": 0.8}, ["a"]), rel=0.08)
    assert times_white({"a": 0.8}, ["a", "white"]) == 1.0
    assert times_white({}, []) == 1.0


def test_suggestions_that_such_noise_gives_are_left_out_and_others_are_not() -> None:
    assert evident([SUGGESTED], QUIET, 20.0) == ()  # 30 < 20 (1 + 0.6)/(1 - 0.6)
    accepted, large = replace(SUGGESTED, is_accepted=True), replace(SUGGESTED, gain=81.0)
    white, rejected = replace(SUGGESTED, channels=("a", "c")), replace(QUIET, is_rejected=True)
    assert evident([accepted, large, white], QUIET, 20.0) == (accepted, large, white)
    assert evident([SUGGESTED], rejected, 20.0) == (SUGGESTED,)
    assert evident([SUGGESTED], replace(QUIET, is_training_rejected=True), 20.0) == (SUGGESTED,)


def test_what_such_noise_hides_is_said_where_the_model_agrees_and_only_there() -> None:
    (told,) = notes(Verdict.CONSISTENT, (), replace(QUIET, wild=0))
    assert told.startswith("Neighbouring readings of a, b differ by less")
    assert notes(Verdict.CONSISTENT, (), replace(QUIET, alike={}, wild=0)) == ()
    assert not any("filter" in n for n in notes(Verdict.MISSING_PHYSICS, (CONTACT,), QUIET))
