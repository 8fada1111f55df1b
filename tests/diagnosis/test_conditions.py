"""The scenario of a recording is the one given, also where a program changed it since it was read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.components import nanoseconds
from cosim.scenario import TimeSettings
from cosim.unit.quantity import PhysicalValue
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording, load_recording
from tests.fabric_diagnosis.fabrics import small, still
from tests.systems.rigs import write_recording


def test_what_a_program_changed_stays_changed(tmp_path):
    read = small()
    fabric = read.components["fabric"].model_copy(update={"engine": "mujoco", "rows": 6})
    step = read.time.model_copy(update={"macro_step": PhysicalValue(20.0, "ms")})
    changed = read.model_copy(update={"components": {**read.components, "fabric": fabric}, "time": step})
    recording = still(tmp_path / "r", overrides={"components": {"fabric": {"columns": 3}}})
    found = scenario_of(changed, recording)
    own = found.components["fabric"]
    assert (own.engine, own.rows, own.columns) == ("mujoco", 6, 3)
    assert found.time.macro_step.to("ms") == 20.0
    assert found.path == read.path


def test_what_the_file_has_is_taken_where_nothing_was_changed(tmp_path):
    found = scenario_of(small(), still(tmp_path / "r"))
    assert found.components == small().components
    assert found.time.stop.to("s") == 0.98


def slowly(folder: Path, interval: float) -> Recording:
    """A recording of a marker that is read at an interval [s]."""
    times = np.arange(0.0, 0.97, interval)
    columns = {"t": times, "x": 0.1 + 0.001 * np.sin(times)}
    return load_recording(write_recording(folder, columns, {}, {"marker[5].x": ("x", "m", "0.2 mm")}))


@pytest.mark.parametrize(
    ("interval", "expected"),
    [(0.02, 20.0), (0.0199, 20.0), (0.05, 40.0), (0.06, 60.0), (0.12, 120.0), (0.13, 120.0), (0.005, 10.0)],
)
def test_outputs_are_recorded_as_often_as_the_channels_are_read(tmp_path, interval, expected):
    read = small()
    wanted = {
        "macro_step": PhysicalValue(10.0, "ms"),
        "output_step": PhysicalValue(120.0, "ms"),
        "checkpoint_step": PhysicalValue(1.2, "s"),
    }
    changed = read.model_copy(update={"time": read.time.model_copy(update=wanted)})
    found = scenario_of(changed, slowly(tmp_path / "r", interval)).time
    assert found.output_step.to("ms") == pytest.approx(expected)
    assert found.macro_step.to("ms") == 10.0
    assert nanoseconds(found.stop) % nanoseconds(wanted["output_step"]) == 0  # as the scenario itself has it
    TimeSettings.model_validate(found.model_dump())
