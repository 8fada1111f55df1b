"""A sensor that was off for a while in training, and a model that is right: the fault is told, and the model kept."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from cosim.cli import app
from cosim.loading import load_scenario
from diagnosis.check.check import check_recordings
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel

ROOM = OdeModel(
    "room",
    {"Ca": (4e5, "J/K"), "Cw": (6e6, "J/K"), "Gaw": (150.0, "W/K"), "Gwo": (60.0, "W/K"), "Gao": (40.0, "W/K")},
    {"power": "W", "outside": "K"},
    {
        "Ta": ("K", "293.15", "(power - Gaw*(Ta - Tw) - Gao*(Ta - outside))/Ca"),
        "Tw": ("K", "293.15", "(Gaw*(Ta - Tw) - Gwo*(Tw - outside))/Cw"),
    },
    {"air": ("K", "Ta"), "wall": ("K", "Tw")},
)
STEP, COUNT = 120.0, 720
SCENARIO = """
title: A room
time: {stop: 86400 s, macro_step: 60 s, output_step: 120 s}
components:
  weather: {kind: programme, outputs: {outside: {unit: K, constant: 278.15 K}}}
  radiator: {kind: programme, outputs: {heating: {unit: W, constant: 800 W}}}
  room: {kind: fmu, fmu: room.fmu, integrator: cvode}
connections: [weather.outside -> room.outside, radiator.heating -> room.power]
"""


def week(seed: int, fault: slice, size: float, folder: Path, heating: np.ndarray | None = None) -> np.ndarray:
    """Write a recording whose wall sensor reads too much for a while; the heating that was applied, as held values."""
    rng = np.random.default_rng(seed)
    own = np.repeat(rng.uniform(0.0, 2500.0, 18), COUNT // 18).round()
    outside = 278.0 + 4.0 * np.sin(np.arange(COUNT) / COUNT * 6.28 + rng.uniform(0.0, 6.28))
    states, x = [], np.array([293.15, 293.15])
    for power, cold in zip(own, outside):
        states.append(x)
        for _ in range(12):  # Heun's steps of 10 s: the air's time constant is 35 min

            def rate(y: np.ndarray, power: float = float(power), cold: float = float(cold)) -> np.ndarray:
                between = 150.0 * (y[0] - y[1])
                return np.array(
                    [(power - between - 40.0 * (y[0] - cold)) / 4e5, (between - 60.0 * (y[1] - cold)) / 6e6]
                )

            guess = x + 10.0 * rate(x)
            x = x + 5.0 * (rate(x) + rate(guess))
    values = np.array(states) + 0.06 * rng.standard_normal((COUNT, 2))
    values[fault, 1] += size
    folder.mkdir()
    table = np.column_stack([STEP * np.arange(COUNT), own if heating is None else heating, outside, values])
    np.savetxt(folder / "data.csv", table, delimiter=",", header="t,P,To,Ta,Tw", comments="", fmt="%.7g")
    about = {
        "title": folder.name,
        "source": "computed",
        "table": "data.csv",
        "time": {"column": "t", "unit": "s"},
        "inputs": {"radiator.heating": {"column": "P", "unit": "W"}, "weather.outside": {"column": "To", "unit": "K"}},
        "channels": {
            "room.air": {"column": "Ta", "unit": "K", "noise": "0.06 K"},
            "room.wall": {"column": "Tw", "unit": "K", "noise": "0.06 K"},
        },
    }
    (folder / "recording.yaml").write_text(yaml.safe_dump(about))
    return own


@pytest.fixture
def room(tmp_path: Path) -> Path:
    """Scenario and FMU."""
    ROOM.build(tmp_path)
    (tmp_path / "scenario.yaml").write_text(SCENARIO)
    return tmp_path


def test_a_fault_that_alone_bends_the_recalibration_is_told_and_the_model_is_kept(room: Path) -> None:
    """Without the fault the recalibration is worse than the scenario; with it, it is as good."""
    week(1, slice(250, 375), 1.6, room / "first")
    week(2, slice(0, 0), 0.0, room / "second")
    asked = ["diagnose", str(room / "scenario.yaml"), "--recording", str(room / "first")]
    asked += ["--held-out", str(room / "second"), "--brief", "--out", str(room / "answer")]
    done = CliRunner().invoke(app, asked)
    assert done.exit_code == 0, done.output
    answer = json.loads((room / "answer" / "diagnosis.json").read_text())
    assert answer["verdict"] == "measurement fault"
    accepted = [f for f in answer["findings"] if f["is_accepted"]]
    assert [f["effect"] for f in accepted] == ["sensor_offset_in_interval"]
    offset = accepted[0]["parameters"][0]
    assert offset["value"] == pytest.approx(1.6, abs=0.05)
    assert "in report.html" not in done.output  # `--brief` writes none


def test_readings_that_leave_the_simulation_at_once_do_not_begin_elsewhere(room: Path) -> None:
    """The column of another run's heating: the slope is another, the start is the same."""
    other = week(1, slice(0, 0), 0.0, room / "first")
    week(3, slice(0, 0), 0.0, room / "second", other)
    asked = ["recording", "check", str(room / "first"), str(room / "second")]
    done = CliRunner().invoke(app, [*asked, "--scenario", str(room / "scenario.yaml")])
    assert "begins at" not in done.output
    assert "input agrees" not in done.output


def test_heating_that_was_logged_as_zero_and_acted_is_told_with_its_size(room: Path) -> None:
    """A share of nothing is nothing: such a stretch was called physics, or not found."""
    own = week(1, slice(0, 0), 0.0, room / "as_it_was")
    assert own[280] == 1023.0
    assert len(set(own[280:320])) == 1
    logged = own.copy()
    logged[280:320] = 0.0
    week(1, slice(0, 0), 0.0, room / "first", logged)
    week(2, slice(0, 0), 0.0, room / "second")
    asked = ["diagnose", str(room / "scenario.yaml"), "--recording", str(room / "first")]
    asked += ["--held-out", str(room / "second"), "--brief", "--out", str(room / "answer")]
    done = CliRunner().invoke(app, asked)
    assert done.exit_code == 0, done.output
    answer = json.loads((room / "answer" / "diagnosis.json").read_text())
    assert answer["verdict"] == "measurement fault", done.output
    (fault,) = [f for f in answer["findings"] if f["is_accepted"]]
    assert fault["effect"] == "unstated_input_in_interval"
    size, begin, end = (p["value"] for p in fault["parameters"])
    assert size == pytest.approx(1023.0, rel=0.03)
    assert (begin, end) == pytest.approx((280 * STEP, 320 * STEP), abs=2.0 * STEP)


def test_the_columns_of_two_outputs_in_one_unit_are_seen_to_be_exchanged(room: Path) -> None:
    """By a lag the air explains the wall, so that only one of them gains; and outputs of one FMU were not compared."""
    week(1, slice(0, 0), 0.0, room / "right")
    week(1, slice(0, 0), 0.0, room / "wrong")
    text = (room / "wrong" / "recording.yaml").read_text()
    swapped = (
        text.replace("column: Ta", "column: X").replace("column: Tw", "column: Ta").replace("column: X", "column: Tw")
    )
    assert swapped != text
    (room / "wrong" / "recording.yaml").write_text(swapped)
    scenario = load_scenario(room / "scenario.yaml")
    wrong, right = (check_recordings(scenario, [load_recording(room / n)]) for n in ("wrong", "right"))
    assert [d.kind for d in wrong if d.is_serious] == ["swapped"]
    assert right == ()


def test_an_input_column_that_was_copied_from_another_recording_is_told(room: Path) -> None:
    """Neither another run's programme nor a shift explains the readings then: the right column is nowhere."""
    other = week(1, slice(0, 0), 0.0, room / "first")
    week(3, slice(0, 0), 0.0, room / "second", other)
    scenario = load_scenario(room / "scenario.yaml")
    found = check_recordings(scenario, [load_recording(room / n) for n in ("first", "second")])
    serious = [d for d in found if d.is_serious]
    assert [(d.recording, d.subject) for d in serious] == [("second", "radiator.heating")]
    assert "to the last digit" in serious[0].statement


def test_a_programme_that_was_run_twice_is_no_copy(room: Path) -> None:
    """The same heating on another day, with other weather."""
    own = week(1, slice(0, 0), 0.0, room / "first")
    week(1, slice(0, 0), 0.0, room / "again", own)
    scenario = load_scenario(room / "scenario.yaml")
    assert check_recordings(scenario, [load_recording(room / n) for n in ("first", "again")]) == ()


def test_a_sensor_that_stands_still_half_of_the_time_has_the_noise_that_is_stated(room: Path) -> None:
    """The median of neighbouring differences is 0 then: "scatter by 5.58e-08, 5740 times less" was the doubt."""
    week(1, slice(0, 0), 0.0, room / "first")
    table = np.loadtxt(room / "first" / "data.csv", delimiter=",", skiprows=1)
    table[200:620, 4] = table[200, 4]
    np.savetxt(room / "first" / "data.csv", table, delimiter=",", header="t,P,To,Ta,Tw", comments="", fmt="%.7g")
    found = check_recordings(load_scenario(room / "scenario.yaml"), [load_recording(room / "first")])
    assert any("stood still" in d.statement for d in found)
    assert not any(d.kind == "noise" for d in found)


def test_readings_that_repeat_the_largest_value_where_the_model_goes_on_are_an_end_of_the_range(room: Path) -> None:
    """A sensor that ends at 21 degC, which nobody stated: that, and not a noise that is stated too large."""
    week(1, slice(0, 0), 0.0, room / "first")
    scenario = load_scenario(room / "scenario.yaml")
    assert check_recordings(scenario, [load_recording(room / "first")]) == ()
    table = np.loadtxt(room / "first" / "data.csv", delimiter=",", skiprows=1)
    end = float(np.quantile(table[:, 3], 0.6))
    table[:, 3] = np.minimum(table[:, 3], end)
    np.savetxt(room / "first" / "data.csv", table, delimiter=",", header="t,P,To,Ta,Tw", comments="", fmt="%.7g")
    found = check_recordings(scenario, [load_recording(room / "first")])
    (doubt,) = [d for d in found if d.kind == "range"]
    assert doubt.is_serious
    assert "repeat its largest value" in doubt.statement
    assert "`maximum`" in doubt.remedy
    assert not any(d.kind == "noise" for d in found)
