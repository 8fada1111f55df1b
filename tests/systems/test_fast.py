"""Systems of FMUs in compiled code against the co-simulation, closed forms and SciPy."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import Scenario, parse_scenario
from cosim.unit.quantity import PhysicalValue
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.placed import Placed, PlacedState
from diagnosis.search.cosim_run import Changes
from tests.fmi.fmi_models import build
from tests.systems.rigs import LUMP, OSCILLATOR, TANK

#: CVODE at rtol 1e-8 begins anew in each of 200 macro-steps.
INTEGRATED = 1e-6
_OSCILLATOR = """
title: An oscillator
time: {stop: 1 s, macro_step: 5 ms, output_step: 10 ms}
algorithm: {kind: KIND}
components:
  drive: {kind: programme, outputs: {u: {unit: V, points: [[0 s, 1 V], [0.5 s, -0.5 V]]}}}
  rig: {kind: fmu, fmu: oscillator.fmu, integrator: INTEGRATOR, TERMS}
connections:
  - drive.u -> rig.u
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """FMUs of the rigs."""
    found = tmp_path_factory.mktemp("rigs")
    for model in (OSCILLATOR, TANK, LUMP):
        model.build(found)
    for version in (2, 3):
        build("ball", version, found)
    return found


def _scenario(
    folder: Path, integrator: str = "cvode", kind: str = "gauss_seidel", terms: str = "start: {}"
) -> Scenario:
    text = _OSCILLATOR.replace("INTEGRATOR", integrator).replace("KIND", kind).replace("TERMS", terms)
    return parse_scenario(text, folder / "scenario.yaml")


def _course(
    system: FastSystem, name: tuple[str, str], **changes: object
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    rows = system.simulate(**changes)  # type: ignore[arg-type]
    assert rows is not None
    return rows.values[:, system.recorded[name]].ravel().copy()


@pytest.mark.parametrize("integrator", ["cvode", "internal"])
@pytest.mark.parametrize("kind", ["gauss_seidel", "jacobi"])
def test_one_fmu_is_simulated_as_the_co_simulation_does(folder: Path, integrator: str, kind: str) -> None:
    scenario = _scenario(folder, integrator, kind)
    system = FastSystem(scenario)
    system.set_substeps(2)
    there = run(scenario)["rig.position"].values
    for _ in range(2):  # a reset FMU is as a fresh one
        np.testing.assert_allclose(_course(system, ("rig", "position")), there, atol=INTEGRATED)
    system.close()


def test_it_agrees_with_the_closed_form_of_a_damped_oscillator(folder: Path) -> None:
    text = (
        _OSCILLATOR.replace("INTEGRATOR", "cvode").replace("KIND", "jacobi").replace("TERMS", "parameters: {x_0: 1 m}")
    )
    text = text.replace("[0 s, 1 V], [0.5 s, -0.5 V]", "[0 s, 0 V]")
    system = FastSystem(parse_scenario(text, folder / "scenario.yaml"))
    system.set_substeps(4)
    found, t = _course(system, ("rig", "position")), system.times
    rate = math.sqrt(400.0 - 4.0)
    expected = np.exp(-2.0 * t) * (np.cos(rate * t) + 2.0 / rate * np.sin(rate * t))
    np.testing.assert_allclose(found, expected, atol=1e-6)  # Runge-Kutta of order 4 at 1.25 ms: 20 * h is 0.025
    system.close()


def test_a_parameter_that_is_moved_and_moved_back_leaves_no_trace(folder: Path) -> None:
    system = FastSystem(_scenario(folder))
    first = _course(system, ("rig", "position"))
    moved = _course(system, ("rig", "position"), changes=Changes({"rig": {"k": PhysicalValue(500.0, "1/s^2")}}))
    assert np.max(np.abs(moved - first)) > 0.01
    np.testing.assert_array_equal(_course(system, ("rig", "position")), first)
    system.close()


@pytest.mark.parametrize("integrator", ["cvode", "internal"])
def test_a_law_with_a_memory_is_what_the_scenario_with_it_runs(folder: Path, integrator: str) -> None:
    """A Maxwell element at the velocity, or at the input of an FMU that hides its states."""
    is_open = integrator == "cvode"
    place, unit, length = ("der(v)", "1/s^2", "x") if is_open else ("u", "V/m", "position")
    law = Placed(
        "rig",
        place,
        f"-branch * ({length} - slack)",
        (("branch", unit), ("time_constant", "ms")),
        {},
        (PlacedState("slack", f"({length} - slack) / time_constant", length, "m"),),
    )
    values = (150.0 if is_open else 1.5, 50.0)
    system = FastSystem(_scenario(folder, integrator), [law])
    system.set_substeps(2)
    found = _course(system, ("rig", "position"), laws={0: values})
    assert np.max(np.abs(found - _course(system, ("rig", "position")))) > 0.01
    entry = law.entry(values).model_dump(mode="json")
    with_it = _scenario(folder, integrator).model_copy(deep=True)
    rig = with_it.components["rig"].model_copy(update={"added_terms": [law.entry(values)]})
    with_it = with_it.model_copy(update={"components": {**with_it.components, "rig": rig}})
    np.testing.assert_allclose(found, run(with_it)["rig.position"].values, atol=INTEGRATED)
    assert entry["states"]["slack"]["start"] == length
    again = FastSystem(with_it)  # an amended scenario is simulated with what it has
    again.set_substeps(2)
    np.testing.assert_allclose(_course(again, ("rig", "position")), found, atol=1e-12)
    system.close()
    again.close()


def test_two_coupled_fmus_with_units_that_differ(folder: Path) -> None:
    text = """
title: Two tanks
time: {stop: 60 s, macro_step: 500 ms, output_step: 1 s}
components:
  pump: {kind: programme, outputs: {flow: {unit: l/s, points: [[0 s, 8 l/s], [20 s, 2 l/s]]}}}
  upper: {kind: fmu, fmu: tank.fmu, integrator: cvode}
  lower: {kind: fmu, fmu: tank.fmu, integrator: internal, parameters: {h_0: 20 cm}}
connections:
  - pump.flow -> upper.inflow
  - upper.outflow -> lower.inflow
"""
    scenario = parse_scenario(text, folder / "scenario.yaml")
    system, results = FastSystem(scenario), run(scenario)
    system.set_substeps(2)
    for name in ("upper", "lower"):
        np.testing.assert_allclose(_course(system, (name, "level")), results[f"{name}.level"].values, atol=INTEGRATED)
    assert abs(float(results["lower.level"][0]) - 0.2) < 1e-12
    system.close()


@pytest.mark.parametrize("kind", ["gauss_seidel", "jacobi"])
def test_a_correction_state_at_an_output_reaches_the_fmu_behind_it_as_in_the_co_simulation(
    folder: Path, kind: str
) -> None:
    """Terms at outputs see what the FMU itself gives, not what other terms add to it."""
    text = f"""
title: Two tanks
time: {{stop: 60 s, macro_step: 500 ms, output_step: 1 s}}
algorithm: {{kind: {kind}}}
components:
  pump: {{kind: programme, outputs: {{flow: {{unit: l/s, points: [[0 s, 8 l/s], [20 s, 2 l/s]]}}}}}}
  upper: {{kind: fmu, fmu: tank.fmu, integrator: internal}}
  lower: {{kind: fmu, fmu: tank.fmu, integrator: cvode, parameters: {{h_0: 20 cm}}}}
connections:
  - pump.flow -> upper.inflow
  - upper.outflow -> lower.inflow
"""
    scenario = parse_scenario(text, folder / "scenario.yaml")
    laws = [
        Placed(
            "upper",
            "outflow",
            "-extra",
            (("gain", "m^2/s"), ("settling", "s")),
            {},
            (PlacedState("extra", "(gain * level - extra) / settling", "gain * level", "m^3/s"),),
        ),
        Placed("upper", "level", "bend * level * level", (("bend", "1/m"),)),
        Placed("upper", "level", "share * outflow", (("share", "s/m^2"),)),
    ]
    values = [(0.004, 8.0), (0.1,), (0.5,)]
    system = FastSystem(scenario, laws)
    system.set_substeps(2)
    before = _course(system, ("lower", "level"))
    found = {n: _course(system, (n, "level"), laws=dict(enumerate(values))) for n in ("upper", "lower")}
    assert np.max(np.abs(found["lower"] - before)) > 1e-3
    upper = scenario.components["upper"].model_copy(
        update={"added_terms": [law.entry(v) for law, v in zip(laws, values)]}
    )
    amended = scenario.model_copy(update={"components": {**scenario.components, "upper": upper}})
    results = run(amended)
    again = FastSystem(amended)
    again.set_substeps(2)
    for name, course in found.items():
        np.testing.assert_allclose(course, results[f"{name}.level"].values, atol=INTEGRATED)
        np.testing.assert_allclose(_course(again, (name, "level")), course, atol=1e-12)
    system.close()
    again.close()


@pytest.mark.parametrize("version", [2, 3])
def test_a_ball_bounces_at_the_same_instants(folder: Path, version: int) -> None:
    """State events: the first impact of a fall from 1 m is at sqrt(2 h / g)."""
    text = f"""
title: A ball
time: {{stop: 1 s, macro_step: 10 ms, output_step: 10 ms}}
components:
  ball: {{kind: fmu, fmu: ball_fmi{version}.fmu, integrator: cvode}}
"""
    scenario = parse_scenario(text, folder / "scenario.yaml")
    system = FastSystem(scenario)
    np.testing.assert_allclose(_course(system, ("ball", "height")), run(scenario)["ball.height"].values, atol=2e-5)
    system.close()


def test_what_it_cannot_simulate_is_said(folder: Path) -> None:
    steps = "algorithm: {kind: iterated}\ncomponents"
    scenario = parse_scenario(
        _OSCILLATOR.replace("INTEGRATOR", "internal")
        .replace("algorithm: {kind: KIND}\ncomponents", steps)
        .replace("TERMS", "start: {}"),
        folder / "scenario.yaml",
    )
    with pytest.raises(NotFast, match="repeats steps"):
        FastSystem(scenario)


def test_a_simulation_that_runs_away_is_no_result(folder: Path) -> None:
    law = Placed("rig", "der(v)", "a * x**3", (("a", "1/m^2/s^2"),))
    system = FastSystem(_scenario(folder), [law])
    assert system.simulate(laws={0: (1e9,)}) is None
    assert system.simulate() is not None
    system.close()
