"""The laws and the supervisor as a C FMU: the same as in Python, in loops and on drawn readings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.components import ControllerComponent
from cosim.control.controller import ControllerUnit
from cosim.control.string_controllers import StringControllers
from cosim.control_assembly import build_controller
from cosim.run import RunStopped, run
from cosim.scenario import Scenario, load_scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import UnitError

HERE = Path("scenario.yaml")
PI = {"kind": "pi", "gain": "9 V^2/K", "integral_time": "4.5 s", "feedforward": "0.7 V^2/K", "ambient": "22 degC"}
LAWS = {
    "on-off": ({"kind": "on_off", "band": "4 K"}, "linear"),
    "pi": ({**PI, "gain": "0.4 V/K", "feedforward": "0.1 V/K"}, "linear"),
    "hold by pi": ({"kind": "hold", "hold_at": "46 degC", "reheat_below": "42 degC", "inner": PI}, "squared"),
    "hold by on-off": (
        {"kind": "hold", "hold_at": "46 degC", "reheat_below": "42 degC", "inner": {"kind": "on_off", "band": "2 K"}},
        "squared",
    ),
}
SUPERVISOR = {
    "limit": "80 degC",
    "margin": "0.5 K",
    "fastest_rise": "50 K/s",
    "slowest_rise": "3 K/s",
    "cooling_time": "5 s",
    "ambient": "20 degC",
    "tolerance": "25 K",
    "delay": "250 ms",
    "lag": "300 ms",
    "lowest": "0 degC",
    "highest": "90 degC",
    "frozen_after": "500 ms",
}


def component(name: str, **changes: object) -> ControllerComponent:
    law, drive = LAWS[name]
    return ControllerComponent.model_validate(
        {
            "kind": "controller",
            "groups": [3, 1, 2],
            "sample": "100 ms",
            "lowest": "0.5 V",
            "highest": "10.8 V",
            "drive": drive,
            "setpoint": "60.5 degC",
            "law": law,
            **changes,
        }
    )


def both(given: ControllerComponent) -> tuple[ControllerUnit, StringControllers]:
    python = build_controller("controller", given, HERE)
    c = build_controller("controller", given.model_copy(update={"fmu": "string_controller"}), HERE)
    assert isinstance(python, ControllerUnit)
    assert isinstance(c, StringControllers)
    return python, c


def readings(seed: int, steps: int) -> np.ndarray:
    """Six temperatures [K] that wander from 20 to 95 degC; one stands still for a while, one ends out of range."""
    random = np.random.default_rng(seed)
    level = 293.15 + 45.0 * np.arange(steps)[:, None] / steps + random.normal(0.0, 8.0, (steps, 6))
    level[steps // 3 : steps // 3 + 16, 1] = level[steps // 3, 1]
    level[-10:, 4] = 365.15
    return level


@pytest.mark.parametrize("supervisor", [None, SUPERVISOR], ids=["free", "supervised"])
@pytest.mark.parametrize(("combine", "supply"), [("mean", "per_string"), ("max", "per_string"), ("min", "common")])
@pytest.mark.parametrize("law", LAWS)
def test_the_fmu_does_what_the_laws_in_python_do(law, combine, supply, supervisor):
    """Two macro-steps a sample, from a start before 0; setpoints are switched off for a third of the time."""
    units = both(component(law, combine=combine, supply=supply, supervisor=supervisor))
    asked, alarms, size = [], set(), 50_000_000
    for unit in units:
        unit.set("measured", np.full(6, 295.15))
        unit.initialise(-200_000_000)
        unit.exit_initialisation()
    for step, measured in enumerate(readings(7, 120)):
        for unit in units:
            unit.set("measured", measured)
            if step % 40 == 0:
                shape = unit.variables["setpoint"].shape
                unit.set("setpoint", np.full(shape, 295.15 if step == 40 else 333.65))
            unit.do_step(-200_000_000 + step * size, size)
        for name in ("command", "demand", "alarm"):
            np.testing.assert_allclose(units[1].get(name), units[0].get(name), rtol=1e-12, atol=1e-12, err_msg=name)
        asked.append(np.array(units[0].get("command")).ravel())
        alarms |= set(np.array(units[0].get("alarm")).ravel())
    units[1].terminate()
    assert np.ptp(asked) > 5.0  # it drove, and stopped driving
    assert alarms >= ({0.0} if supervisor is None else {0.0, 3.0})


def swapped(scenario: Scenario) -> Scenario:
    """One more line in the scenario."""
    other = scenario.components["controller"].model_copy(update={"fmu": "string_controller"})
    return scenario.model_copy(update={"components": {**scenario.components, "controller": other}})


def test_the_shipped_loop_runs_the_same_with_the_fmu_and_goes_on_after_an_interruption(tmp_path):
    scenario = load_scenario("closed_loop_coil")
    expected, found = run(scenario), run(swapped(scenario))
    for name in ("controller.command", "controller.alarm", "actuator.temperature"):
        np.testing.assert_allclose(found[name].values, expected[name].values, rtol=0.0, atol=1e-9, err_msg=name)

    def stop(progress):
        if progress.time >= 15.0:
            raise KeyboardInterrupt

    with pytest.raises(RunStopped):
        run(swapped(scenario), tmp_path / "out", on_progress=stop)
    assert "string_controller" in (tmp_path / "out" / "versions.json").read_text()  # the FMU is on the record
    resumed = run(swapped(scenario), tmp_path / "out", resume=True)
    for name in found.data_vars:
        np.testing.assert_array_equal(resumed[name].values, found[name].values, err_msg=str(name))


WRONG = {
    "a law in Python": ({"law": {"kind": "python", "file": "my_law.py"}}, "python"),
    "another command": (
        {
            "command_unit": "W",
            "lowest": "0 W",
            "highest": "1 W",
            "drive": "linear",
            "law": {**PI, "gain": "1 W/K", "feedforward": "0.1 W/K"},
        },
        "measures K and commands V",
    ),
    "a delay too long": ({"supervisor": {**SUPERVISOR, "delay": "7 s"}}, "lasts more than 64 samples"),
}


@pytest.mark.parametrize(("change", "what"), WRONG.values(), ids=WRONG)
def test_what_the_fmu_cannot_do_is_refused(tmp_path, change, what):
    (tmp_path / "my_law.py").write_text("def command(sample, memory):\n    return 0.0\n")
    given = component("pi", **change).model_copy(update={"fmu": "string_controller"})

    def begin() -> None:
        build_controller("controller", given, tmp_path / "scenario.yaml").initialise(0)

    with pytest.raises((ValueError, InputError, UnitError), match=what):
        begin()
