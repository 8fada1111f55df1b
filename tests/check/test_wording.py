"""Lines that the check prints: what is named, in whose unit, and what a logged column is said to do."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from cosim.cli import app
from cosim.scenario import load_scenario
from diagnosis.check.beside import Beside, Course, compare
from diagnosis.check.input_doubts import how
from diagnosis.check.inputs import InputComparison
from diagnosis.check.tables import course_text, input_text, row
from diagnosis.recording.quantity import Target
from diagnosis.recording.recording import Channel, load_recording
from diagnosis.report.user_units import Units
from tests.check import rig

TIMES = np.arange(0.0, 600.0, 1.0)


def compared(kind: str, switches: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())) -> InputComparison:
    return InputComparison(
        "a", "drive.power", "W", kind, "recorded", True, ((10.0, 20.0),), 0.1, 2.0, 0.0, 0.0, switches
    )


def test_the_line_about_an_input_names_what_is_used() -> None:
    told = input_text(compared("scaled"))
    assert told == (
        "drive.power: the recorded input is 2 times as high; the simulation uses the recorded input, not the programme "
        "stated by the recording"
    )
    many = how(compared("part", (tuple(range(50)), (1.0,))))
    assert "the recorded course switches at least 50 times, the programme once" in many
    assert " it " not in many


def test_a_logged_temperature_has_no_switches() -> None:
    logged = 20.0 + 3.0 * np.sin(TIMES / 100.0)
    told = course_text(Course("room.temperature", "degC", TIMES, np.round(logged, 2), True))
    assert "switches" not in told
    assert "of its readings, by 0.0" in told
    assert told.endswith("K at a time")
    steps = Course("drive.power", "W", TIMES, 4.0 * ((TIMES // 50.0) % 2), True)
    assert course_text(steps).endswith("switches at 50, 100, 150, 200, 250, 300, ... (11 in all) s")
    assert course_text(steps, Units(("degC", "min"))).endswith("(11 in all) min")


@pytest.mark.parametrize(
    ("written", "unit", "shown"), [("bar", "Pa", "bar"), ("%", "1", "%"), ("mm", "m", "mm"), ("degC", "K", "°C")]
)
def test_the_table_is_in_the_unit_of_the_column(written: str, unit: str, shown: str) -> None:
    values = 300.0 + np.sin(TIMES)
    channel = Channel("rig.y", Target("rig", (), "y", unit), TIMES, values, 0.1, True)
    beside: Any = Beside(channel, None, np.arange(600), np.zeros(0), np.zeros((0, 0)))
    units = Units((written, "kPa", "m", "min"))
    found = row(beside, units, units.scale(599.0, "s"))
    assert found.ranges[0].endswith(f" {shown}")
    assert found.span == "0 to 9.983"


def test_channels_of_one_kind_are_shown_each_in_its_own_unit(tmp_path: Path) -> None:
    folder = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST))
    given = yaml.safe_load((folder / "recording.yaml").read_text())
    given["channels"]["coil[2].temperature"]["unit"] = "K"
    (folder / "recording.yaml").write_text(yaml.safe_dump(given, sort_keys=False))
    one = compare(load_scenario("tclab"), load_recording(folder))
    units = [
        row(b, one.units_of(b.channel.name), one.units.scale(600.0, "s")).ranges[0].split()[-1]
        for b in one.channels.values()
    ]
    assert units == ["°C", "K"]


def test_the_next_command_can_be_pasted(tmp_path: Path) -> None:
    table = tmp_path / "my data.csv"
    table.write_text("time_s,T1_degC\n" + "\n".join(f"{t},{20 + 0.1 * t}" for t in range(40)))
    out = tmp_path / "my rig"
    told = CliRunner().invoke(app, ["recording", "new", str(table), "--scenario", "tclab", "--out", str(out)]).output
    command = "".join(told.splitlines()).partition("then: ")[2]
    assert shlex.split(command) == ["cosim", "recording", "check", str(out), "--scenario", "tclab"]
