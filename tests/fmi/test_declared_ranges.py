"""FMUs that say for which values they are made: `min` and `max` of variables and of their declared types."""

from __future__ import annotations

import json
import re
import zipfile
from collections.abc import Mapping
from pathlib import Path

import pytest
from typer.testing import CliRunner

from cosim.cli import app
from cosim.loading import load_scenario
from cosim.observers.ranges import outside_ranges
from cosim.run import record
from cosim.unit.protocol import Causality, Variable
from cosim.unit.ranges import beyond
from evaluation.fmus.model import OdeModel

TANK = OdeModel(
    "tank", {"A": (2.0, "m^2")}, {"inflow": "m^3/s"}, {"h": ("m", "0.5", "inflow/A")}, {"level": ("m", "h")}
)
SCENARIO = """
title: A tank that overflows
time: {stop: 10 s, macro_step: 100 ms, output_step: 100 ms}
components:
  pump: {kind: programme, outputs: {flow: {unit: L/s, points: [[0 s, 100 L/s], [4 s, 400 L/s], [8 s, -100 L/s]]}}}
  tank: {kind: fmu, fmu: tank.fmu, parameters: {A: 2 m^2}}
connections: [pump.flow -> tank.inflow]
"""


def declare(folder: Path, ranges: Mapping[str, str]) -> None:
    """Give variables of the built FMU further attributes."""
    TANK.build(folder)
    with zipfile.ZipFile(folder / "tank.fmu") as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    text = entries["modelDescription.xml"].decode()
    for name, attributes in ranges.items():
        text, count = re.subn(rf'(name="{name}"[^>]*>\s*<Real )', rf"\1{attributes} ", text)
        assert count == 1, name
    entries["modelDescription.xml"] = text.encode()
    with zipfile.ZipFile(folder / "tank.fmu", "w") as archive:
        for name, content in entries.items():
            archive.writestr(name, content)


def outside(folder: Path, ranges: Mapping[str, str], scenario: str = SCENARIO) -> list[str]:
    declare(folder, ranges)
    (folder / "scenario.yaml").write_text(scenario)
    return outside_ranges(record(load_scenario(folder / "scenario.yaml")).trace)


def test_nothing_is_said_where_no_range_is_declared_or_left(tmp_path: Path) -> None:
    """The level ends at 0.5 m + (0.4 + 1.6 - 0.2) m^3 / 2 m^2; it is highest, 1.5 m, at 8 s."""
    assert outside(tmp_path, {}) == []
    assert outside(tmp_path, {"level": 'min="0" max="1.500001"', "inflow": 'min="-0.1" max="0.4"'}) == []


def test_an_output_that_leaves_its_range_is_told_with_value_and_instants(tmp_path: Path) -> None:
    (told,) = outside(tmp_path, {"level": 'max="1"'})
    # 0.7 m at 4 s, then 0.2 m/s: 1 m is passed after 5.5 s
    assert told == (
        "tank.level was outside the range for which its unit is made (at most 1 m): 1.5 m at 8 s, outside from 5.6 s on"
    )


def test_an_input_is_compared_in_the_unit_of_the_fmu(tmp_path: Path) -> None:
    (told,) = outside(tmp_path, {"inflow": 'min="0" max="0.5"'})
    assert told == (
        "tank.inflow, given by pump.flow was outside the range for which its unit is made (0 to 0.5 m^3/s): "
        "-0.1 m^3/s at 8.1 s, outside from 8.1 s on"
    )


def test_parameters_are_told_by_validate_and_run(tmp_path: Path) -> None:
    declare(tmp_path, {"A": 'min="0.1" max="1.5"', "level": 'max="1"'})
    (tmp_path / "scenario.yaml").write_text(SCENARIO)
    told = "warning: tank.parameters.A = 2 m^2 is outside the range for which this FMU is made (0.1 to 1.5 m^2)"
    checked = CliRunner().invoke(app, ["validate", str(tmp_path / "scenario.yaml")])
    assert checked.exit_code == 0
    assert told in checked.stderr
    done = CliRunner().invoke(
        app, ["run", str(tmp_path / "scenario.yaml"), "--out", str(tmp_path / "run"), "--no-plots"]
    )
    assert done.exit_code == 0
    assert told in done.stderr
    assert "warning: tank.level was outside" in done.stderr
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert len(summary["outside_range"]) == 2


def test_a_run_that_stops_says_what_had_left_its_range(tmp_path: Path) -> None:
    declare(tmp_path, {"level": 'max="0.6"'})
    term = "{to: der(h), formula: 'k*h*h', parameters: {k: 1 1/(m*s)}}"
    stops = SCENARIO.replace("tank.fmu,", f"tank.fmu, integrator: cvode, added_terms: [{term}],")
    (tmp_path / "scenario.yaml").write_text(stops)
    done = CliRunner().invoke(
        app, ["run", str(tmp_path / "scenario.yaml"), "--out", str(tmp_path / "run"), "--no-plots"]
    )
    assert done.exit_code != 0, done.output
    assert "stopped:" in done.stderr
    assert "warning: tank.level was outside" in done.stderr


@pytest.mark.parametrize(
    ("values", "expected"), [([0.0, 1.0], [0.0, 0.0]), ([-1e-9, 1.0], [0.0, 0.0]), ([-0.5, 2.5], [0.5, 1.5])]
)
def test_rounding_is_no_departure(values: list[float], expected: list[float]) -> None:
    share = Variable("share", Causality.OUTPUT, (2,), "1", ("n",), least=0.0, most=1.0)
    assert beyond(share, values).tolist() == expected
