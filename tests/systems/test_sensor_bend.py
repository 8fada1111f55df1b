"""A sensor whose characteristic is bent: named, with the reading at which it is right."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Verdict
from diagnosis.models.sensor_chain import read
from diagnosis.models.systems.sensors import Reach, sensor_laws_of
from diagnosis.recording.recording import load_recording
from diagnosis.recording.series import Series
from diagnosis.search.problem import Term
from diagnosis.search.search import Settings
from tests.systems.rigs import oscillator, oscillator_recordings

BEND, CENTRE = 1.5, -0.05


def _term(unit: str) -> Term:
    reach = Reach(unit, 2.0, -4.0, 6.0, 0.01, 10.0)
    every = sensor_laws_of({"rig.position": reach}, 0.1, 0.1)
    return next(law.place.term for law in every if law.place.term.identifier == "sensor_bend")


def test_a_sensor_that_is_not_linear_is_named(tmp_path: Path) -> None:
    scenario = load_scenario(str(oscillator(tmp_path)))
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0)
    for folder in recordings:
        table = pd.read_csv(folder / "data.csv")
        table["x"] += BEND * (table["x"] - CENTRE) ** 2
        table.to_csv(folder / "data.csv", index=False)
    every = [load_recording(r) for r in recordings]
    found = diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis
    assert found.verdict is Verdict.MEASUREMENT_FAULT
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.place) == ("sensor_bend", "rig.position")
    bend, centre = finding.parameters
    assert bend.value == pytest.approx(BEND, rel=0.1)
    assert bend.lower < BEND < bend.upper
    assert centre.value == pytest.approx(CENTRE, abs=0.02)


def test_it_reads_right_at_its_centre_and_more_to_both_sides(tmp_path: Path) -> None:
    oscillator(tmp_path)
    channel = load_recording(oscillator_recordings(tmp_path, lambda x, v: 0.0)[0]).channels["rig.position"]
    times = np.array([float(channel.times[0]), float(channel.times[-1])])
    course = Series(times, np.array([0.0, 2.0]), False, "m")
    plain = read(channel, {}, course, float(times[1] - times[0]))
    bent = read(channel, {_term("m"): (0.25, 1.0)}, course, float(times[1] - times[0]))
    np.testing.assert_allclose(bent - plain, 0.25 * (plain - 1.0) ** 2, atol=1e-12)
    assert (bent - plain)[0] == pytest.approx(0.25)


@pytest.mark.parametrize(("unit", "expected"), [("m", "1/(m)"), ("1", "1"), ("", "1")])
def test_its_unit_is_one_over_that_of_the_reading(unit: str, expected: str) -> None:
    bend, centre = _term(unit).parameters
    assert (bend.unit, centre.unit) == (expected, unit)
    assert bend.lower == -bend.upper
    assert centre.lower < -4.0
    assert centre.upper > 6.0


@pytest.mark.filterwarnings("error")
def test_a_course_that_runs_away_is_read_without_a_warning(tmp_path: Path) -> None:
    oscillator(tmp_path)
    channel = load_recording(oscillator_recordings(tmp_path, lambda x, v: 0.0)[0]).channels["rig.position"]
    times = np.linspace(float(channel.times[0]), float(channel.times[-1]), 5)
    course = Series(times, np.array([0.0, 1e200, np.inf, -np.inf, np.nan]), False, "m")
    every = sensor_laws_of({"rig.position": Reach("m", 2.0, -4.0, 6.0, 0.01, 10.0)}, 0.1, 0.1)
    laws = {t: tuple(p.starts[0] for p in t.parameters) for t in (law.place.term for law in every)}
    assert {"sensor_bend", "sensor_clipping", "sensor_hysteresis"} <= {t.identifier for t in laws}
    assert not np.isfinite(read(channel, laws, course, float(times[1] - times[0]))).all()
