"""Recordings without noise, as `cosim record` makes them where no sensors are stated: they raise no doubt."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from cosim.cli import app

NETWORK = """
title: Nine coils in three strings, one open and one shorted
time: {stop: 2 s, macro_step: 10 ms, output_step: 20 ms}
components:
  supply:
    kind: programme
    outputs: {voltage: {unit: mV, interpolation: linear, points: [[0 s, 0 V], [1 s, 5000 mV], [2 s, 5 V]]}}
  room: {kind: programme, outputs: {temperature: {unit: degF, constant: 77 degF}}}
  circuit:
    kind: ngspice
    strings: [4, 2, 3]
    supply: common
    supply_resistance: 0.5 ohm
    open_coils: [6]
    shorted_coils: [2]
    start: {resistance: 2.2 ohm}
  actuator: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, mechanical: load}
  load: {kind: hanging_mass, coils: 9, mass: 50 g}
connections: [supply.voltage -> circuit.supply_voltage]
"""


def _checked(folder: Path, scenario: str, *more: str) -> str:
    runner = CliRunner()
    recorded = runner.invoke(app, ["record", scenario, "--out", str(folder / "r"), *more])
    assert recorded.exit_code == 0, recorded.output
    checked = runner.invoke(app, ["recording", "check", str(folder / "r"), "--scenario", scenario])
    assert checked.exit_code == 0, checked.output
    return " ".join(checked.output.split())


def _network(folder: Path) -> str:
    path = folder / "network.yaml"
    path.write_text(NETWORK, encoding="utf-8")
    return str(path)


@pytest.mark.parametrize(
    ("scenario", "stop"), [("tclab", "20 s"), ("single_coil_heating", "10 s"), ("single_coil_heating", "60 s")]
)
def test_a_recording_of_a_shipped_scenario_raises_no_serious_doubt(tmp_path: Path, scenario: str, stop: str) -> None:
    assert "No serious doubt" in _checked(tmp_path, scenario, "--set", f"time.stop={stop}")


@pytest.mark.parametrize(
    "channels", ["*", "supply.current", "coil[1,3].temperature", "coil[9].extension", "string[2].voltage"]
)
def test_rounding_is_neither_a_sign_nor_a_wild_reading(tmp_path: Path, channels: str) -> None:
    """Extensions of coils that stay cold differ in their last digits, and an open string carries 4 pA."""
    more = [] if channels == "*" else ["--channels", channels]
    told = _checked(tmp_path, _network(tmp_path), *more)
    assert "(sign)" not in told
    assert "far from both neighbours" not in told
