"""The figure of a closed loop: setpoint, reading and hold beside the temperature of the coil."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
import yaml

from chainmail.figures import closed_loop
from chainmail.figures.draw import draw_run
from chainmail.figures.setpoints import loop_of
from cosim import figure_style as style
from cosim.run import run
from cosim.run_folder import RunFolder
from cosim.scenario import load_scenario, scenario_of_data

ZERO = 273.15


@pytest.fixture
def lines(monkeypatch):
    """Label of every line of the first axes to its values, and the label of that axis, as the figure is saved."""
    found: dict[str, np.ndarray | str] = {}
    save = style.Figure.savefig

    def saved(self, path, **options):
        if path.stem.startswith("closed_loop"):
            found.update({str(line.get_label()): np.asarray(line.get_ydata()) for line in self.axes[0].lines})
            found["axis"] = self.axes[0].get_ylabel()
        save(self, path, **options)

    monkeypatch.setattr(style.Figure, "savefig", saved)
    return found


def test_the_setpoint_stands_beside_what_was_measured(tmp_path, lines):
    folder = RunFolder(tmp_path / "run")
    scenario = load_scenario("closed_loop_coil", ["time.stop=3 s", "time.checkpoint_step=1 s"])
    made = run(scenario, folder.path)
    draw_run(folder.path)
    assert lines["axis"] == "temperature [°C]"
    np.testing.assert_allclose(lines["setpoint"], 60.5, atol=1e-9)
    np.testing.assert_allclose(lines["hold"], 46.0, atol=1e-9)
    np.testing.assert_allclose(lines["measured"], made["thermometer.reading"].values.ravel() - ZERO, atol=1e-9)
    np.testing.assert_allclose(lines["coil"], made["actuator.temperature"].values.ravel() - ZERO, atol=1e-9)


def _two_strings() -> dict:
    """The loop of one coil with two strings, each with a setpoint of its own over time, asked for in degC."""
    data = yaml.safe_load(load_scenario("closed_loop_coil").to_yaml())
    data["components"]["controller"] |= {"groups": [1, 1], "supply": "per_string"}
    points = [["0 s", ["30 degC", "40 degC"]], ["1 s", ["50 degC", "60 degC"]]]
    asked = {"unit": "degC", "dim": "string", "points": points}
    data["algorithm"]["order"].append("request")
    data["components"]["request"] = {"kind": "programme", "outputs": {"temperature": asked}}
    return data


@pytest.mark.parametrize(
    ("connection", "expected"),
    [
        ("request.temperature -> controller.setpoint", [[30.0, 40.0], [50.0, 60.0]]),
        ({"connect": "request.temperature -> controller.setpoint", "offset": 2.0}, [[32.0, 42.0], [52.0, 62.0]]),
        ("request.temperature[1] -> controller.setpoint[2]", None),
        (None, [[60.5], [60.5]]),
    ],
)
def test_a_setpoint_comes_from_what_feeds_it(connection, expected):
    data = _two_strings()
    data["connections"] = [] if connection is None else [connection]
    recorded = xr.Dataset(
        {"request.temperature": (("time", "string"), [[30.0, 40.0], [50.0, 60.0]], {"units": "degC"})},
        {"time": [0.0, 1.0]},
    )
    loop = loop_of(scenario_of_data(data, load_scenario("closed_loop_coil").path), recorded, "controller")
    assert loop is not None
    assert loop.measured is None
    if expected is None:  # fed in parts: nothing is drawn rather than a wrong line
        assert loop.setpoint is None
    else:
        np.testing.assert_allclose(loop.setpoint - ZERO, expected, atol=1e-9)
    assert loop_of(load_scenario("closed_loop_coil"), recorded, "room") is None


def test_setpoints_that_differ_are_a_line_each_and_what_is_no_temperature_keeps_its_unit(tmp_path, lines):
    time = np.arange(3.0)
    recorded = xr.Dataset(
        {"c.command": (("time", "string"), np.ones((3, 2)), {"units": "V"}), "c.alarm": (("time",), np.zeros(3))},
        {"time": time},
    )
    loop = closed_loop.Loop("m", np.array([[0.1, 0.2]] * 3), np.array([[0.1, 0.3]] * 3), None)
    closed_loop.draw(tmp_path / "closed_loop_c.png", recorded, "c", loop)
    assert lines["axis"] == "measured [m]"
    assert lines["setpoints of 2 strings"] == pytest.approx(0.1)
    assert lines["measured"] == pytest.approx(0.2)
    assert "hold" not in lines
