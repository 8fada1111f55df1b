"""Terms that the master adds to FMUs whose source it does not have, against closed forms and SciPy."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from cosim.formula import Formula, FormulaError
from cosim.run import run
from cosim.scenario import Scenario, parse_scenario
from cosim.unit.errors import InputError
from tests.fmi.fmi_models import build

#: CVODE at rtol 1e-8 with restarts at every macro-step, as tests/fmi/test_events.py.
INTEGRATED = 1e-6
DRAG, GRAVITY, BEFORE_IMPACT = 0.8, 9.81, 0.4


@pytest.fixture(scope="module")
def balls(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A bouncing ball in FMI 2.0 and 3.0: states height and velocity, input push, nothing known of its source."""
    folder = tmp_path_factory.mktemp("balls")
    for version in (2, 3):
        build("ball", version, folder)
    return folder


def _ball(folder: Path, version: int, terms: str, keys: str = "integrator: cvode") -> Scenario:
    text = f"""
title: A ball with more than its author gave it
time: {{stop: {BEFORE_IMPACT} s, macro_step: 10 ms, output_step: 10 ms, checkpoint_step: 100 ms}}
components:
  ball: {{kind: fmu, fmu: ball_fmi{version}.fmu, {keys}, added_terms: [{terms}]}}
"""
    return parse_scenario(text, folder / "scenario.yaml")


_ON_STATE = f"{{to: der(velocity), formula: -drag * velocity, parameters: {{drag: {DRAG} 1/s}}}}"
_ON_INPUT = f"{{to: push, formula: -drag * velocity, parameters: {{drag: {DRAG} 1/s}}}}"


def _falling(t: float) -> tuple[float, float]:
    """Height and velocity of a fall with linear drag."""
    speed = GRAVITY / DRAG * (1.0 - math.exp(-DRAG * t))
    return 1.0 - (GRAVITY * t - speed) / DRAG, -speed


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("term", [_ON_STATE, _ON_INPUT], ids=["derivative", "input"])
def test_drag_on_a_ball_of_somebody_else_is_integrated_with_it(balls: Path, version: int, term: str) -> None:
    result = run(_ball(balls, version, term))
    height, velocity = _falling(BEFORE_IMPACT)
    assert abs(float(result["ball.height"][-1]) - height) < INTEGRATED
    assert abs(float(result["ball.velocity"][-1]) - velocity) < 10 * INTEGRATED


def test_a_co_simulation_fmu_takes_a_term_at_its_input_once_a_step(balls: Path) -> None:
    result = run(_ball(balls, 3, _ON_INPUT, "integrator: internal"))
    velocity = 0.0
    for _ in range(40):  # the push of a step is that of its begin
        velocity += 0.01 * (-GRAVITY - DRAG * velocity)
    assert abs(float(result["ball.velocity"][-1]) - velocity) < 1e-12


@pytest.mark.parametrize("integrator", ["cvode", "internal"])
def test_a_term_at_an_output_is_what_others_see(balls: Path, integrator: str) -> None:
    term = "{to: height, formula: offset + 2 * height + rise * time, parameters: {offset: 5 mm, rise: 1 cm/s}}"
    plain = run(_ball(balls, 3, "", f"integrator: {integrator}"))["ball.height"].values
    seen = run(_ball(balls, 3, term, f"integrator: {integrator}"))["ball.height"]
    np.testing.assert_allclose(seen.values, 3.0 * plain + 0.005 + 0.01 * seen["time"].values, rtol=1e-12)


def test_a_run_with_terms_is_the_same_in_a_process_of_its_own_and_from_a_checkpoint(
    balls: Path, tmp_path: Path
) -> None:
    here = run(_ball(balls, 3, _ON_STATE))["ball.height"].values
    isolated = run(_ball(balls, 3, _ON_STATE, "integrator: cvode, isolation: process"))["ball.height"].values
    np.testing.assert_array_equal(here, isolated)
    run(_ball(balls, 3, _ON_STATE), tmp_path / "run")
    for file in sorted((tmp_path / "run" / "checkpoints").iterdir())[-1:]:
        file.unlink()
    for name in ("results.nc", "summary.json"):
        (tmp_path / "run" / name).unlink()
    resumed = run(_ball(balls, 3, _ON_STATE), tmp_path / "run", resume=True)["ball.height"].values
    np.testing.assert_array_equal(here, resumed)


_HEATER = """
title: Two lumps in a room, with radiation that their model leaves out
time: {stop: 40 s, macro_step: 100 ms, output_step: 1 s}
components:
  drive: {kind: programme, outputs: {power: {unit: W, dim: coil, points: [[0 s, [3 W, 1 W]], [20 s, [0 W, 0 W]]]}}}
  room: {kind: programme, outputs: {temperature: {unit: K, constant: 21 degC}}}
  lump:
    kind: fmu
    fmu: thermal_stiffness
    fmi: %d
    integrator: cvode
    structure: {coils: 2}
    parameter_set: sma_limb_coil
    parameters: {initial_temperature: 21 degC, use_regressed_cooling_rate: false}
    added_terms:
      - to: der(temperature)
        formula: -(area * sigma / capacity) * (temperature**4 - ambient_temperature**4)
        parameters: {area: 111 mm^2, sigma: 5.670374419e-8 W/m^2/K^4, capacity: 0.18895275 kJ/K}
connections:
  - drive.power -> lump.power
  - room.temperature -> lump.ambient_temperature
"""


def test_radiation_on_a_lumped_heater_agrees_with_scipy() -> None:
    text = (_HEATER % 3).replace("0.18895275 kJ/K", "188.95275 J/K")
    result = run(parse_scenario(text, Path("heater.yaml")))
    capacity, loss = 6450.0 * 35e-9 * 837.0, 90.0 * 111e-6
    added = 111e-6 * 5.670374419e-8 / 188.95275

    def rate(t: float, kelvin: Any, power: Any) -> Any:
        del t
        return (power - loss * (kelvin - 294.15)) / capacity - added * (kelvin**4 - 294.15**4)

    state = np.full(2, 294.15)
    for power in (np.array([3.0, 1.0]), np.zeros(2)):
        state = solve_ivp(rate, (0.0, 20.0), state, args=(power,), rtol=1e-10, atol=1e-10).y[:, -1]
    # CVODE at rtol 1e-8 of 300 K over 400 macro-steps.
    np.testing.assert_allclose(result["lump.temperature"].values[-1], state, atol=1e-3)


@pytest.mark.parametrize(
    ("term", "keys", "said"),
    [
        ("{to: der(velocity), formula: velocity}", "integrator: cvode", "not in"),
        ("{to: der(height), formula: velocity + push}", "integrator: cvode", "puts together"),
        ("{to: der(spin), formula: '1'}", "integrator: cvode", "no continuous state `spin`"),
        (_ON_STATE, "integrator: internal", "its own solver integrates"),
        ("{to: weight, formula: '1'}", "integrator: cvode", "no floating-point input or output"),
        ("{to: height, formula: spin}", "integrator: cvode", "there is no `spin`"),
        ("{to: height, formula: height * ratio, parameters: {height: 1 m}}", "integrator: cvode", "has this name"),
    ],
)
def test_a_term_that_makes_no_sense_is_refused_in_words(balls: Path, term: str, keys: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        run(_ball(balls, 3, term, keys))


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os').system('true')",
        "x.__class__",
        "(lambda: 1)()",
        "[x for x in (1,)]",
        "x if x else x",
        "'x'",
        "x and x",
        "x := 1",
        "open('f')",
        "x[0]",
        "9**9**9**9**x",
        "(" * 300 + "x" + ")" * 300 + "+",
        "1e999 * x",
        "x.real",
    ],
)
def test_nothing_but_arithmetic_is_read_from_a_formula(text: str) -> None:
    with pytest.raises(FormulaError):
        Formula(text, {"x": "m"}, "m")


def test_a_formula_is_evaluated_in_si_whatever_the_units_of_its_quantities() -> None:
    formula = Formula(
        "k * max(x, y) * exp(-x / y) * step(x - y) + abs(-y) * sqrt(k*k)", {"x": "mm", "y": "m", "k": "1"}, "km"
    )
    assert formula.names == {"x", "y", "k"}
    x, y, k = np.array([3.0, 1.0]), np.array(2.0), np.array(0.5)
    expected = k * np.maximum(x, y) * np.exp(-x / y) * (x >= y) + y * k
    np.testing.assert_allclose(formula.value({"x": x, "y": y, "k": k}), expected, rtol=1e-15)
