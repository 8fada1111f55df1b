"""Inputs that are late: compiled code and the co-simulation against closed forms."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import Scenario, parse_scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.placed import Placed, PlacedDelay, placed_of
from evaluation.fmus.model import OdeModel

#: CVODE at rtol 1e-8 begins anew in each of 100 macro-steps; Runge-Kutta of order 4 at a fortieth of the time constant.
INTEGRATED = 1e-6
TAU, STEP = 0.2, 0.02
#: Instants of the switch [s] and its values [V].
SWITCHED, VALUES = (0.0, 0.4, 1.0, 1.1), (0.3, 1.0, -0.5, 0.2)
LAG = OdeModel(
    "lag",
    {"tau": (TAU, "s")},
    {"u": "V"},
    {"x": ("V", "0.0", "(u - x) / tau")},
    {"y": ("V", "x"), "through": ("V", "x + u")},
    1e-3,
)
LATE = "{to: u, formula: late - u, parameters: {dead_time: DELAY s}, delays: {late: {of: u, by: dead_time}}}"
ALONE = f"""
title: A lag behind a switch
time: {{stop: 2 s, macro_step: {1e3 * STEP} ms, output_step: {1e3 * STEP} ms, checkpoint_step: 500 ms}}
algorithm: {{kind: KIND}}
components:
  switch: {{kind: programme, outputs: {{u: {{unit: V, points: POINTS}}}}}}
  rig: {{kind: fmu, fmu: lag.fmu, integrator: INTEGRATOR, added_terms: [TERM]}}
connections:
  - switch.u -> rig.u
""".replace("POINTS", str([[f"{t} s", f"{v} V"] for t, v in zip(SWITCHED, VALUES)]).replace("'", ""))
BEHIND = ALONE.replace(
    "connections:",
    "  valve: {kind: fmu, fmu: lag.fmu, integrator: INTEGRATOR}\nconnections:\n  - switch.u -> valve.u",
).replace("switch.u -> rig.u", "valve.through -> rig.u")
#: None, less than a step, a step, more than steps, a count of steps that is no exact number, longer than the run.
DELAYS = (0.0, 0.007, 0.02, 0.0531, 0.06, 0.14, 0.5, 3.0)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU of the lag."""
    found = tmp_path_factory.mktemp("lag")
    LAG.build(found)
    return found


def _scenario(
    folder: Path, delay: float | None, text: str = ALONE, integrator: str = "cvode", kind: str = "gauss_seidel"
) -> Scenario:
    term = "" if delay is None else LATE.replace("DELAY", repr(delay))
    text = text.replace("TERM", term).replace("INTEGRATOR", integrator).replace("KIND", kind)
    return parse_scenario(text, folder / "scenario.yaml")


def _simulated(scenario: Scenario, laws: tuple[Placed, ...] = (), **changes: Any) -> dict[str, Array]:
    system = FastSystem(scenario, laws)
    system.set_substeps(4)
    rows = system.simulate(**changes)
    assert rows is not None
    found = {n: rows.values[:, system.recorded["rig", n]].ravel().copy() for n in ("y", "through")}
    system.close()
    return found


def _lag(times: Array, delay: float) -> Array:
    """Response of the lag from rest to the switch, `delay` seconds late; before the start it had its first value."""
    since = np.maximum(times[:, None] - np.array([0.0, *(t + delay for t in SWITCHED[1:])]), 0.0)
    return np.asarray((1.0 - np.exp(-since / TAU)) @ np.diff([0.0, *VALUES]))


def _by_delay(times: Array, delay: float) -> Array:
    """Derivative of the same by the delay."""
    since = times[:, None] - np.array([t + delay for t in SWITCHED[1:]])
    return np.asarray(np.where(since > 0.0, -np.exp(-since / TAU) / TAU, 0.0) @ np.diff(VALUES))


@pytest.mark.parametrize("delay", DELAYS)
def test_a_lag_answers_a_late_switch_as_the_closed_form(folder: Path, delay: float) -> None:
    scenario = _scenario(folder, delay)
    results = run(scenario)
    expected = _lag(results["time"].values, delay)
    np.testing.assert_allclose(results["rig.y"].values, expected, atol=INTEGRATED)
    np.testing.assert_allclose(_simulated(scenario)["y"], expected, atol=INTEGRATED)


@pytest.mark.parametrize("delay", DELAYS)
def test_an_fmu_that_integrates_itself_gets_the_mean_of_each_step(folder: Path, delay: float) -> None:
    scenario = _scenario(folder, delay, integrator="internal")
    begins = STEP * np.arange(100)
    changes = np.array([-np.inf, *(t + delay for t in SWITCHED[1:])])
    shares = np.clip((begins[:, None] + STEP - changes) / STEP, 0.0, 1.0)
    answered = [0.0]
    for u in shares @ np.diff([0.0, *VALUES]):
        answered.append(u + (answered[-1] - u) * np.exp(-STEP / TAU))
    found = run(scenario)
    np.testing.assert_allclose(found["rig.y"].values, answered, atol=INTEGRATED)
    np.testing.assert_allclose(_simulated(scenario)["y"], answered, atol=INTEGRATED)
    # The mean instead of the edge: the largest step times (h / tau)^2 / 8.
    exact = _lag(found["time"].values, delay)
    np.testing.assert_allclose(found["rig.y"].values, exact, atol=1.5 * (STEP / TAU) ** 2 / 8.0)


@pytest.mark.parametrize("integrator", ["cvode", "internal"])
def test_an_input_that_is_late_by_nothing_is_the_input(folder: Path, integrator: str) -> None:
    plain, late = (run(_scenario(folder, d, BEHIND, integrator)) for d in (None, 0.0))
    np.testing.assert_allclose(late["rig.y"], plain["rig.y"], rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(late["rig.through"], plain["rig.through"], rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("kind", ["gauss_seidel", "jacobi"])
@pytest.mark.parametrize("integrator", ["cvode", "internal"])
@pytest.mark.parametrize("text", [ALONE, BEHIND], ids=["programme", "unit"])
@pytest.mark.parametrize("delay", [0.0, 0.007, 0.06, 0.1234])
def test_compiled_code_is_the_co_simulation(folder: Path, kind: str, integrator: str, text: str, delay: float) -> None:
    """Also where an output follows its input at once, and where another FMU sets the input."""
    scenario = _scenario(folder, delay, text, integrator, kind)
    results, found = run(scenario), _simulated(scenario)
    np.testing.assert_allclose(found["y"], results["rig.y"], atol=INTEGRATED)
    np.testing.assert_allclose(found["through"], results["rig.through"], atol=INTEGRATED)


@pytest.mark.parametrize("delay", [0.007, 0.0531, 0.14])
def test_the_derivative_by_the_delay_is_that_of_the_closed_form(folder: Path, delay: float) -> None:
    law = placed_of("rig", _scenario(folder, delay).components["rig"].added_terms[0])[0]  # type: ignore[union-attr]
    system = FastSystem(_scenario(folder, None), [law])
    system.set_substeps(4)
    small, courses = 1e-5, []
    for value in (delay, delay + small):
        rows = system.simulate(laws={0: (value,)})
        assert rows is not None
        courses.append(rows.values[:, system.recorded["rig", "y"]].ravel().copy())
    slopes, expected = np.diff(courses, axis=0)[0] / small, _by_delay(system.times, delay)
    system.close()
    # At a reading that the switch passes there is none; else half the second derivative times the difference.
    inside = np.all(np.abs(system.times[:, None] - delay - np.array(SWITCHED[1:])) > 2.0 * small, axis=1)
    np.testing.assert_allclose(slopes[inside], expected[inside], atol=small * 1.5 / TAU**2 + 10.0 * 1e-9 / small)


def test_the_response_is_continuous_in_the_delay(folder: Path) -> None:
    """Across whole numbers of steps too, by Model Exchange and by Co-Simulation."""
    for integrator in ("cvode", "internal"):
        law = placed_of("rig", _scenario(folder, 0.1).components["rig"].added_terms[0])[0]  # type: ignore[union-attr]
        system = FastSystem(_scenario(folder, None, integrator=integrator), [law])
        before = None
        for delay in np.linspace(0.0, 0.05, 101):
            rows = system.simulate(laws={0: (float(delay),)})
            assert rows is not None
            now = rows.values[:, system.recorded["rig", "y"]].copy()
            if before is not None:
                assert np.max(np.abs(now - before)) < 1.01 * 1.5 * 5e-4 / TAU
            before = now
        system.close()


@pytest.mark.parametrize("integrator", ["cvode", "internal"])
def test_a_run_goes_on_from_a_checkpoint_within_the_delay(folder: Path, integrator: str, tmp_path: Path) -> None:
    scenario, out = _scenario(folder, 0.2531, BEHIND, integrator), tmp_path / "run"
    whole = run(scenario, out)["rig.y"].values.copy()
    for file in sorted((out / "checkpoints").iterdir())[-1:]:
        file.unlink()
    for name in ("results.nc", "summary.json"):
        (out / name).unlink()
    np.testing.assert_array_equal(run(scenario, out, resume=True)["rig.y"].values, whole)


def test_steps_that_are_repeated_see_the_same_past(folder: Path) -> None:
    scenario = _scenario(folder, 0.1234, ALONE, "cvode", "iterated")
    results = run(scenario)
    np.testing.assert_allclose(results["rig.y"].values, _lag(results["time"].values, 0.1234), atol=INTEGRATED)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("of: u", "of: y"), "no floating-point input `y`"),
        (("by: dead_time", "by: late_time"), "no parameter `late_time`"),
        (("1 s}", "-1 s}"), "it is no delay"),
        (("1 s}", "1 V}"), "it is no delay"),
        (("{late:", "{x:"), "has this name"),
    ],
)
def test_a_delay_that_makes_no_sense_is_refused_in_words(folder: Path, change: tuple[str, str], said: str) -> None:
    term = LATE.replace("DELAY", "1").replace(*change)
    text = ALONE.replace("TERM", term).replace("INTEGRATOR", "cvode").replace("KIND", "jacobi")
    with pytest.raises(InputError, match=said):
        run(parse_scenario(text, folder / "scenario.yaml"))


def test_delays_of_the_library_are_numbers_of_their_laws() -> None:
    delayed = [law for law in library() if law.delays]
    assert "input_dead_time" in {law.identifier for law in delayed}
    for law in delayed:
        assert {d.by for d in law.delays} <= {n.name for n in law.numbers if n.least is not None and n.least >= 0.0}


def test_a_law_with_a_delay_goes_into_a_scenario_and_back() -> None:
    law = Placed("rig", "u", "late - u", (("dead_time", "s"),), delays=(PlacedDelay("late", "u", "dead_time"),))
    assert placed_of("rig", law.entry((0.25,))) == (law, (0.25,))
