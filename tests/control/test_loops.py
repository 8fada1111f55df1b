"""Closed loops: closed form, overshoot, hold on the cooling branch, a law of a user's own, resumption."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from cosim.control.controller import ControllerDesign, ControllerUnit
from cosim.control.laws import Pi
from cosim.run import RunStopped, run
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue
from tests.control.closed_form import largest_error
from tests.control.files import CAPACITY, CONDUCTANCE, loop

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "examples" / "control"
OFFSET = 273.15


def test_the_sampled_loop_is_its_closed_form():
    assert largest_error() < 1e-9


@pytest.mark.parametrize("share", [0.7, 1.0, 1.3])
def test_overshoot_stays_below_three_kelvin_where_convection_is_off_by_a_third(share):
    """The loop of the shipped scenario, at its own settings, as a plain PI at 62 degC."""
    scenario = load_scenario("closed_loop_coil")
    controller, actuator = scenario.components["controller"], scenario.components["actuator"]
    plain = controller.model_copy(update={"law": controller.law.inner, "setpoint": PhysicalValue(62.0, "degC")})
    other = actuator.model_copy(
        update={"parameters": {"heat_transfer_coefficient": PhysicalValue(90 * share, "W/m^2/K")}}
    )
    found = run(
        scenario.model_copy(update={"components": {**scenario.components, "controller": plain, "actuator": other}})
    )
    temperature = found["actuator.temperature"].values[:, 0] - OFFSET
    assert temperature.max() < 65.0
    assert abs(temperature[-50:].mean() - 62.0) < 0.2


def test_holding_on_the_cooling_branch_costs_two_fifths_less_and_stays_stiff():
    scenario = load_scenario("closed_loop_coil")
    found = run(scenario)
    controller = scenario.components["controller"]
    plain = controller.model_copy(update={"law": controller.law.inner, "setpoint": PhysicalValue(62.0, "degC")})
    flat = run(scenario.model_copy(update={"components": {**scenario.components, "controller": plain}}))

    def holding(run_):  # mean power over the last 20 s
        return float(run_["circuit.power"].sel(time=slice(10.0, None)).mean())

    assert holding(found) < 0.65 * holding(flat)
    stiffness = found["actuator.stiffness"].values[:, 0]
    reached = stiffness[found["time"].values <= 3.0].max()
    assert stiffness[found["time"].values > 5.0].min() > 0.95 * reached


def test_a_law_of_ones_own_gives_the_same_bits_as_the_built_in_one(tmp_path):
    shutil.copy(EXAMPLES / "my_law.py", tmp_path / "my_law.py")
    numbers = {"gain": "0.004 W/K", "integral_time": "4 s"}
    own = {"kind": "python", "file": "my_law.py", "parameters": numbers}
    built_in = run(loop({"controller.law": {"kind": "pi", **numbers}}, 5.0))
    users = run(loop({"controller.law": own}, 5.0, tmp_path))
    np.testing.assert_array_equal(users["controller.command"].values, built_in["controller.command"].values)
    np.testing.assert_array_equal(users["actuator.temperature"].values, built_in["actuator.temperature"].values)


def test_an_interrupted_run_goes_on_to_the_same_bits(tmp_path):
    changes = {
        "sensor.noise": "0.3 K",
        "sensor.delay": "250 ms",
        "sensor.lag": "0.2 s",
        "sensor.exposure": "50 ms",
        "controller.law": {
            "kind": "hold",
            "hold_at": "46 degC",
            "reheat_below": "42 degC",
            "inner": {"kind": "pi", "gain": "0.05 W/K", "integral_time": "4 s"},
        },
        "controller.supervisor": {
            "limit": "70 degC",
            "margin": "1 K",
            "fastest_rise": "60 K/s",
            "delay": "300 ms",
            "lag": "0.2 s",
            "slowest_rise": "30 K/s",
            "cooling_time": "3 s",
            "ambient": "20 degC",
            "tolerance": "10 K",
        },
    }
    whole = run(loop(changes, 8.0))
    steps = []

    def stop(progress):
        steps.append(progress.done)
        if progress.time >= 3.0:
            raise KeyboardInterrupt

    with pytest.raises(RunStopped):
        run(loop(changes, 8.0), tmp_path / "out", on_progress=stop)
    resumed = run(loop(changes, 8.0), tmp_path / "out", resume=True)
    for name in whole.data_vars:
        np.testing.assert_array_equal(resumed[name].values, whole[name].values, err_msg=str(name))


def test_on_off_stays_within_its_band_and_one_sample():
    """Beyond the band by no more than a sample of heating or cooling: 2 W and (band top - room)."""
    found = run(loop({"controller.law": {"kind": "on_off", "band": "2 K"}, "controller.highest": "0.6 W"}, 30.0))
    late = found["actuator.temperature"].values[150:, 0] - OFFSET
    rise = 0.1 * 0.6 / CAPACITY
    fall = 0.1 * CONDUCTANCE * (61.0 - 22.0) / CAPACITY
    assert 59.0 - fall < late.min()
    assert late.max() < 61.0 + rise
    assert {0.0, 0.6} == set(found["controller.command"].values[:, 0])


def test_the_integral_does_not_wind_up():
    """A setpoint out of reach for 20 s, then one within reach.

    Without anti-windup the integral would be 0.05 W/K * 100 K * 20 s / 4 s = 25 W by then, and the drive at its limit.
    """
    steps = {
        "kind": "programme",
        "outputs": {
            "setpoint": {"unit": "K", "dim": "string", "points": [["0 s", ["200 degC"]], ["20 s", ["40 degC"]]]}
        },
    }
    scenario = loop({"controller.highest": "0.4 W"}, 30.0)
    data = scenario.model_dump(mode="json", exclude_none=True)
    data["components"]["plan"] = steps
    data["algorithm"]["order"] = ["plan", *data["algorithm"]["order"]]
    data["connections"].append("plan.setpoint -> controller.setpoint")
    from cosim.scenario import scenario_of_data

    found = run(scenario_of_data(data, Path("loop.yaml")))
    assert found["controller.command"].sel(time=20.2).item() == 0.0
    late = found["actuator.temperature"].sel(time=slice(28.0, None)).values - OFFSET
    np.testing.assert_allclose(late, 40.0, atol=2.0)  # the slow pole has 5 s


@pytest.mark.parametrize(("combine", "wanted"), [("mean", 40.0), ("max", 50.0), ("min", 30.0)])
def test_a_group_is_controlled_by_what_its_elements_are_combined_to(combine, wanted):
    design = ControllerDesign((2, 1), "K", "V", 10, 0.0, 100.0, np.zeros(2), combine)
    unit = ControllerUnit("controller", design, Pi(-1.0, 1e9))
    unit.set("measured", np.array([30.0, 50.0, 7.0]))
    unit.set("setpoint", np.zeros(2))
    unit.initialise(0)
    unit.do_step(0, 10)
    np.testing.assert_allclose(unit.get("command"), [wanted, 7.0])


WRONG = {
    "unknown law": ({"controller.law": {"kind": "pid"}}, "must be one of"),
    "negative gain unit": ({"controller.law.gain": "0.05 K/W"}, "no quantity in"),
    "limits": ({"controller.lowest": "3 W"}, "lowest < highest"),
    "sample off the grid": ({"controller.sample": "150 ms"}, "multiple of time.macro_step"),
    "sensor off the grid": ({"sensor.sample": "150 ms"}, "multiple of time.macro_step"),
    "group sizes": ({"controller.groups": [2]}, "shape"),
    "setpoints": ({"controller.setpoint": ["60 degC", "50 degC"]}, "setpoint has 2 values"),
    "reheat above hold": (
        {
            "controller.law": {
                "kind": "hold",
                "hold_at": "46 degC",
                "reheat_below": "50 degC",
                "inner": {"kind": "on_off", "band": "1 K"},
            }
        },
        "is not below hold_at",
    ),
    "no file": ({"controller.law": {"kind": "python", "file": "none.py"}}, "there is no file"),
    "half a supervisor": (
        {
            "controller.supervisor": {
                "limit": "80 degC",
                "margin": "1 K",
                "fastest_rise": "9 K/s",
                "slowest_rise": "1 K/s",
            }
        },
        "belong together",
    ),
    "exposure too long": ({"sensor.exposure": "200 ms"}, "longer than sample"),
    "a fault of no element": ({"sensor.faults": [{"element": 2, "instant": "1 s"}]}, "there is no element 2"),
    "unit without zero": ({"sensor.unit": "degC"}, "take K"),
    "feedforward alone": ({"controller.law.feedforward": "0.01 W/K"}, "belong together"),
}


@pytest.mark.parametrize(("changes", "what"), WRONG.values(), ids=WRONG)
def test_a_wrong_component_gets_one_clear_error(changes, what):
    with pytest.raises(InputError, match=what) as refused:
        run(loop(changes, 1.0))
    assert refused.value.remedy


def test_an_error_in_a_users_law_stops_the_run_by_name(tmp_path):
    (tmp_path / "bad.py").write_text("def command(sample, memory):\n    return undefined\n")
    with pytest.raises(RunStopped, match=r"controller at t = 0 s: bad\.py: NameError"):
        run(loop({"controller.law": {"kind": "python", "file": "bad.py"}}, 1.0, tmp_path))
    (tmp_path / "nan.py").write_text("def command(sample, memory):\n    return float('nan')\n")
    with pytest.raises(RunStopped, match="one finite number per group"):
        run(loop({"controller.law": {"kind": "python", "file": "nan.py"}}, 1.0, tmp_path))
    (tmp_path / "none.py").write_text("x = 1\n")
    with pytest.raises(InputError, match="has no function `command"):
        run(loop({"controller.law": {"kind": "python", "file": "none.py"}}, 1.0, tmp_path))
