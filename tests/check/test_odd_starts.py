"""A start of one recording that is not as stated, beside what only looks like one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.check import check_recordings
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Doubt, Verdict
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import held, tank, write_recording

STEP, COUNT = 2.0, 400


def _recordings(folder: Path, starts: Sequence[float], leak: float = 0.02) -> list[Path]:
    tank(folder, "800 s", "2 s")
    found = []
    for number, start in enumerate(starts):
        rng = np.random.default_rng(number)
        inflow = np.repeat(rng.uniform(0.004, 0.016, COUNT // 20), 20)

        def rate(x: Array, flow: float) -> Array:
            return np.array([(flow - leak * x[0]) / 0.5])

        level = held(rate, np.array([start]), inflow, STEP)[:, 0] + 2e-3 * rng.standard_normal(COUNT)
        columns = {"t": STEP * np.arange(COUNT), "u": inflow, "h": level}
        found.append(
            write_recording(
                folder / f"run_{number + 1}",
                columns,
                {"pump.inflow": ("u", "m^3/s")},
                {"tank.level": ("h", "m", "2 mm")},
            )
        )
    return found


def _starts(folder: Path, recordings: Sequence[Path]) -> list[Doubt]:
    scenario = load_scenario(str(folder / "scenario.yaml"))
    return [d for d in check_recordings(scenario, [load_recording(r) for r in recordings]) if d.kind == "start"]


def test_one_recording_that_begins_elsewhere_is_told(tmp_path: Path) -> None:
    recordings = _recordings(tmp_path, (0.4, 0.7, 0.4))
    (told,) = _starts(tmp_path, recordings)
    assert told.is_serious
    assert told.recording == "run_2"
    assert told.subject == "tank.level"


def _slow(folder: Path, starts: Sequence[float]) -> list[Path]:
    """A tank that leaks so little that it has not forgotten its start when a recording ends."""
    found = _recordings(folder, starts, leak=5e-4)
    scenario = folder / "scenario.yaml"
    text = scenario.read_text(encoding="utf-8")
    assert text.count("integrator: cvode") == 1
    slow = text.replace("integrator: cvode", "integrator: cvode, parameters: {leak: 5e-4 m^2/s}")
    scenario.write_text(slow, encoding="utf-8")
    return found


def test_a_slow_rig_that_begins_elsewhere_is_told_though_it_never_forgets_that(tmp_path: Path) -> None:
    (told,) = _starts(tmp_path, _slow(tmp_path, (0.4, 2.4, 0.4)))
    assert told.is_serious
    assert (told.recording, told.subject) == ("run_2", "tank.level")
    assert "later ones are nearer to the simulation" in told.statement


def test_an_offset_of_a_slow_rigs_sensor_is_no_start(tmp_path: Path) -> None:
    """It is as large at the end as at the begin; the same of a rig that begins elsewhere in all recordings."""
    recordings = _slow(tmp_path, (0.4, 0.4, 0.4))
    table = pd.read_csv(recordings[1] / "data.csv")
    table.assign(h=table["h"] + 2.0).to_csv(recordings[1] / "data.csv", index=False)
    assert not _starts(tmp_path, recordings)
    assert not any(d.is_serious for d in _starts(tmp_path, _slow(tmp_path, (2.4, 2.4, 2.4))))


def test_its_diagnosis_says_so_and_searches_nothing(tmp_path: Path) -> None:
    every = [load_recording(r) for r in _recordings(tmp_path, (0.4, 0.7, 0.4))]
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    found = diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis
    assert found.verdict is Verdict.RECORDING_FAULT
    assert found.statement.startswith(
        "The first readings of a recording are not where it is said to begin: in run_2, tank.level:"
    )
    assert not found.findings


@pytest.mark.parametrize(
    ("starts", "change"),
    [
        ((0.7, 0.7, 0.7), None),  # all of them: a number of the scenario
        ((0.4, 0.405, 0.4), None),  # two and a half deviations of the noise
        ((0.4, 0.4, 0.4), lambda table: table.assign(h=table["h"] + 0.3)),  # an offset of its sensor, from begin to end
        ((0.4, 0.7, 0.4), "uncertain"),  # the recording says that it does not know
    ],
)
def test_what_is_no_other_start_of_one_recording_is_not(
    starts: Sequence[float], change: Callable[[pd.DataFrame], pd.DataFrame] | str | None, tmp_path: Path
) -> None:
    recordings = _recordings(tmp_path, starts)
    if change == "uncertain":
        sidecar = recordings[1] / "recording.yaml"
        keys = yaml.safe_load(sidecar.read_text(encoding="utf-8"))
        sidecar.write_text(yaml.safe_dump(keys | {"uncertain": {"tank.h_0": "300 mm"}}), encoding="utf-8")
    elif callable(change):
        change(pd.read_csv(recordings[1] / "data.csv")).to_csv(recordings[1] / "data.csv", index=False)
    assert not any(d.is_serious for d in _starts(tmp_path, recordings))


def test_a_number_that_is_off_moves_no_start(tmp_path: Path) -> None:
    assert not any(d.is_serious for d in _starts(tmp_path, _recordings(tmp_path, (0.4, 0.4, 0.4), leak=0.03)))


def test_one_recording_alone_is_no_odd_one(tmp_path: Path) -> None:
    (told,) = _starts(tmp_path, _recordings(tmp_path, (0.7,)))
    assert not told.is_serious


@pytest.mark.parametrize(("uncertain", "count"), [("", 1), ("uncertain: {tank.depth: 3 cm}\n", 0)])
def test_a_pressure_begins_elsewhere_where_a_depth_is_said_to_be_unknown(
    tmp_path: Path, uncertain: str, count: int
) -> None:
    """The unknown start is of another quantity than the channel: 3 cm of water are 290 Pa."""
    OdeModel(
        "tank",
        {"depth": (0.4, "m"), "area": (0.5, "m^2"), "leak": (0.02, "m^2/s")},
        {"inflow": "m^3/s"},
        {"h": ("m", "depth", "(inflow - leak*h)/area")},
        {"pressure": ("Pa", "9810.0*h")},
    ).build(tmp_path)
    text = (
        "title: A tank\ntime: {stop: 800 s, macro_step: 2 s, output_step: 2 s}\ncomponents:\n"
        "  pump: {kind: programme, outputs: {inflow: {unit: m^3/s, constant: 0.01 m^3/s}}}\n"
        "  tank: {kind: fmu, fmu: tank.fmu, integrator: cvode}\nconnections: [pump.inflow -> tank.inflow]\n"
    )
    (tmp_path / "scenario.yaml").write_text(text, encoding="utf-8")
    recordings = []
    for number, start in enumerate((0.4, 0.46, 0.4)):
        rng = np.random.default_rng(number)
        inflow = np.repeat(rng.uniform(0.004, 0.016, COUNT // 20), 20)
        level = held(lambda x, flow: np.array([(flow - 0.02 * x[0]) / 0.5]), np.array([start]), inflow, STEP)[:, 0]
        columns = {"t": STEP * np.arange(COUNT), "u": inflow, "p": 9810.0 * level + 10.0 * rng.standard_normal(COUNT)}
        inputs, channels = {"pump.inflow": ("u", "m^3/s")}, {"tank.pressure": ("p", "Pa", "10 Pa")}
        recordings.append(write_recording(tmp_path / f"run_{number + 1}", columns, inputs, channels, uncertain))
    told = _starts(tmp_path, recordings)
    assert [d.recording for d in told if d.is_serious] == ["run_2"] * count
