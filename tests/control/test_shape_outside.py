"""A loop around a loop: a camera and a law of a user's own say which temperature the loop inside keeps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.run import run
from cosim.scenario import load_scenario, scenario_of_data

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "examples" / "control"


def _around_one_coil(wanted: float, stop: str) -> dict:
    """The shipped loop of one coil with PI inside; outside, the law of the example on the coil's stiffness.

    The law heats where what is measured is too large; stiffness is too small then, so both are given with a minus.
    """
    data = yaml.safe_load(load_scenario("closed_loop_coil").to_yaml())
    parts = data["components"]
    parts["controller"]["law"] = parts["controller"]["law"]["inner"]
    parts["camera"] = {"kind": "sensor", "unit": "N/m", "sample": "500 ms", "delay": "200 ms"}
    parts["camera"]["start"] = {"quantity": "157 N/m"}
    limits = {"rise": 0.02, "lowest": 295.15, "highest": 345.15}
    parts["shape"] = {
        "kind": "controller",
        "groups": [1],
        "supply": "common",
        "measured_unit": "N/m",
        "command_unit": "K",
        "sample": "500 ms",
        "lowest": "22 degC",
        "highest": "72 degC",
        "setpoint": f"{-wanted} N/m",
        "law": {"kind": "python", "file": str(EXAMPLES / "shape_law.py"), "parameters": limits},
    }
    data["algorithm"]["order"] = ["room", "camera", "shape", "thermometer", "controller", "circuit", "actuator"]
    data["connections"] += [
        "actuator.stiffness -> camera.quantity",
        {"connect": "camera.reading -> shape.measured", "factor": -1.0},
        "shape.command -> controller.setpoint",
    ]
    data["time"]["stop"] = stop
    return data


def test_the_outer_loop_finds_the_temperature_that_a_stiffness_takes():
    """On the heating branch of equation (2) 230 N/m take 57.7 degC; nothing in either loop says so."""
    data = _around_one_coil(230.0, "90 s")
    found = run(scenario_of_data(data, load_scenario("closed_loop_coil").path))
    late = found.sel(time=slice(60.0, None))
    # 0.1 K of noise of the thermometer inside is 1.4 N/m there.
    np.testing.assert_allclose(late["actuator.stiffness"], 230.0, atol=2.0)
    assert float(found["actuator.temperature"].max()) - 273.15 == pytest.approx(57.7, abs=0.5)


def test_in_the_example_the_camera_acts_first_and_five_times_less_often():
    """So the loop inside is never late, and the one outside is the slow one."""
    scenario = load_scenario(EXAMPLES / "shape_outside.yaml")
    order = scenario.algorithm.order
    assert order.index("camera") < order.index("shape") < order.index("controller") < order.index("circuit")
    assert scenario.components["shape"].sample.to("s") == 5 * scenario.components["controller"].sample.to("s")
