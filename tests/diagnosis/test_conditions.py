"""The scenario of a recording is the one given, also where a program changed it since it was read."""

from __future__ import annotations

from cosim.unit.quantity import PhysicalValue
from diagnosis.recording.conditions import scenario_of
from tests.fabric_diagnosis.fabrics import small, still


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
