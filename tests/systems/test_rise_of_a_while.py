"""A thermometer that came loose for a while shows part of the rise over where it began; a unit of one recording."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario
from diagnosis.faults.model import with_faults
from diagnosis.judge.diagnosis import Estimate, Verdict
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.recording.recording import load_recording
from diagnosis.report.unit_factor import unit_factor
from diagnosis.search import grow
from diagnosis.search.problem import Point
from tests.diagnosis.report_examples import CONTACT
from tests.systems.rigs import LUMP, LUMP_SCENARIO, LUMP_STEP, diagnosed, lump_course, write_recording

COUNT = 500
SHARE, BEGIN, END = 0.8, 300.0, 600.0


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Path]]:
    """Three runs with steps of power of 30 s to 60 s; the sensor of the second comes loose."""
    folder = tmp_path_factory.mktemp("rig")
    LUMP.build(folder)
    (folder / "scenario.yaml").write_text(LUMP_SCENARIO, encoding="utf-8")
    recordings = []
    for number in range(3):
        rng = np.random.default_rng(number)
        power = np.repeat(rng.uniform(0.0, 30.0, 25), 20)
        times, values = LUMP_STEP * np.arange(COUNT), lump_course(power)
        if number == 1:
            inside = (times > BEGIN) & (times < END)
            values = np.where(inside, 300.0 + SHARE * (values - 300.0), values)
        columns = {"t": times, "P": power, "T": values + 0.1 * rng.standard_normal(COUNT)}
        inputs, channels = {"drive.power": ("P", "W")}, {"lump.temperature": ("T", "K", "0.1 K")}
        recordings.append(write_recording(folder / f"run_{number + 1}", columns, inputs, channels))
    return folder, recordings


def test_a_thermometer_that_came_loose_is_told_by_its_share_of_the_rise(
    rig: tuple[Path, list[Path]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def tried(*_: object) -> None:
        raise AssertionError("a fault of a while leaves noise here: no law is tried whatever its straight line says")

    monkeypatch.setattr(grow, "_tried_all_the_same", tried)
    every = [load_recording(r) for r in rig[1]]
    found = diagnosed(rig[0] / "scenario.yaml", every)
    assert found.verdict is Verdict.MEASUREMENT_FAULT
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.recording) == ("sensor_rise_in_interval", "run_2")
    gain = finding.parameters[0]
    assert gain.value == pytest.approx(SHARE - 1.0, abs=0.005)  # the first reading has a noise of its own
    ((begin, end),) = finding.intervals
    assert (begin, end) == pytest.approx((BEGIN, END), abs=8.0)


def test_it_changes_the_rise_and_not_the_start(rig: tuple[Path, list[Path]]) -> None:
    scenario = load_scenario(str(rig[0] / "scenario.yaml"))
    model = with_faults(ClosedLoopModel(scenario, [load_recording(r) for r in rig[1]]))
    term = next(t for t in model.sensor_terms if t.identifier == "sensor_rise_in_interval" and t.recording == 0)
    zero = Point(np.zeros(len(model.parameters)))
    plain, loose = model.predict(zero, 0)[0], model.predict(zero.plus(term, (-0.5, -10.0, 2000.0)), 0)[0]
    origin = model.sensor_terms[term].origin
    assert origin == pytest.approx(300.0, abs=0.3)
    np.testing.assert_allclose(loose - origin, 0.5 * (plain - origin), atol=1e-9)


def test_a_sensor_that_shows_one_value_has_no_share_of_a_rise(rig: tuple[Path, list[Path]], tmp_path: Path) -> None:
    table = pd.read_csv(rig[1][0] / "data.csv")
    columns = {"t": table["t"].to_numpy(), "P": table["P"].to_numpy(), "T": np.full(COUNT, 300.0)}
    inputs, channels = {"drive.power": ("P", "W")}, {"lump.temperature": ("T", "K", "0.1 K")}
    still = load_recording(write_recording(tmp_path / "still", columns, inputs, channels))
    model = with_faults(ClosedLoopModel(load_scenario(str(rig[0] / "scenario.yaml")), [still]))
    kinds = {"sensor_offset_in_interval", "sensor_drift_in_interval", "sensor_stuck_in_interval"}
    assert {t.identifier for t in model.sensor_terms} == kinds


def test_a_gain_of_one_recording_that_is_a_factor_between_units_asks_for_the_unit() -> None:
    """A pound-force is 4.448 N: what is logged in pounds and stated as newtons reads 0.2248 of the truth."""
    parameters = (Estimate("gain", "1", -0.7752, -0.7756, -0.7748), Estimate("begin", "s", 0.0, 0.0, 0.0))
    question = unit_factor(replace(CONTACT, effect="sensor_gain_in_interval", parameters=parameters))
    assert "1 pound-force is 4.448 N" in question
    assert question.endswith("?")
