"""What the first stretch of a held-out recording tells holds in the free run of the amended scenario too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.scenario import load_scenario
from diagnosis.amend.evaluate import evaluate_amended_model
from diagnosis.diagnose import Options, Result, diagnose
from diagnosis.judge.diagnosis import Diagnosis
from diagnosis.judge.held_out import TOLERANCE
from diagnosis.models.coil_network.translate import translate
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording
from diagnosis.search.cosim_model import BY_FREE_RUNS
from diagnosis.search.search import Settings
from tests.diagnosis.two_heaters import conditions, record, scenario

APART = ["55 degC", "48 degC"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("rig")


@pytest.fixture(scope="module")
def recordings(folder: Path) -> tuple[Recording, Recording]:
    """Both of a thermometer that reads 0.4 K too little; the second of coils whose start nobody wrote down."""
    base = scenario(folder)
    first = record(base, folder / "first", conditions("21.4 degC", "21.4 degC"), 1, conditions("21 degC", "21 degC"))
    second = record(
        base,
        folder / "second",
        conditions(APART, "22 degC"),
        2,
        conditions("45 degC", "21 degC"),
        beginning="3 s",
        uncertain={"heaters.initial_temperature": "5 K", "room.temperature": "1 K"},
    )
    return first, second


@pytest.fixture(scope="module")
def brief(folder: Path, recordings: tuple[Recording, Recording]) -> Result:
    """Without a search for laws: the model is recalibrated."""
    base = load_scenario(folder / "scenario.yaml")
    return diagnose(
        base, recordings[:1], recordings[1:], Settings(most_terms=0), options=Options(is_brief=True, threads=1)
    )


@pytest.fixture(scope="module")
def full(folder: Path, recordings: tuple[Recording, Recording], brief: Result) -> Diagnosis:
    """What a full report adds: the amended model, and held-out fits from free runs of it."""
    base, points = load_scenario(folder / "scenario.yaml"), (brief.points, brief.held_out_points)
    models = brief.training, brief.judge
    return evaluate_amended_model(brief.diagnosis, base, models, points, recordings[1:], folder / "out" / "amended")


def test_a_full_report_judges_as_a_brief_one(brief: Result, full: Diagnosis) -> None:
    assert full.held_out_by == BY_FREE_RUNS
    assert full.differences == ()
    for short, long in zip(brief.diagnosis.fit, full.fit, strict=True):
        assert (short.recording, short.channel) == (long.recording, long.channel)
        for stage in ("before", "recalibrated", "after"):
            # two predictions that differ by a tenth of the noise
            assert np.sqrt(long.chi_square[stage]) == pytest.approx(np.sqrt(short.chi_square[stage]), abs=TOLERANCE)


def test_the_first_stretch_is_what_makes_the_start_known(full: Diagnosis) -> None:
    after = [f.chi_square["after"] for f in full.fit if f.is_held_out]
    # of the day's room 3 s of cooling tell some tenths of a kelvin; 10 and 3 K of the start are 200 and 60 deviations
    assert max(after) < 5.0


def test_the_amended_scenario_has_the_room_that_every_day_has(
    folder: Path, recordings: tuple[Recording, Recording], full: Diagnosis
) -> None:
    """Of one day half is expected on another: 0.2 K of 0.4, in the room as in the start."""
    amended = load_scenario(folder / "out" / "amended" / "scenario.yaml")
    plain = translate(scenario_of(load_scenario(folder / "scenario.yaml"), recordings[0]))
    room = amended.components["room"].outputs["temperature"].constant  # type: ignore[union-attr]
    assert room.to("K") - 294.15 == pytest.approx(0.2, abs=0.03)
    written = yaml.safe_load((folder / "out" / "amended" / "scenario.yaml").read_text())
    start = written["components"]["heaters"]["parameters"]["initial_temperature"]
    assert float(start.split()[0]) - float(plain.parameters.base["initial_temperature"]) == pytest.approx(0.2, abs=0.05)
