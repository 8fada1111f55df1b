"""Laws that are quicker than anything in the model without them: as many steps of the integration as they need."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Verdict
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.models.systems.model import SAME, SystemModel
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point, Term
from diagnosis.search.search import Settings
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import write_recording

#: A carriage that a drive pushes against a cord: its own time constant is 60 ms, three macro-steps.
MASS, DAMPING, CORD = 0.6, 10.0, 9.0
#: Dry friction that the model does not have [N], and the speed within which it sets in [m/s]: at rest its time
#: constant is 1 ms.
FRICTION, ROUNDING = 1.2, 2e-3
STEP, COUNT, NOISE = 0.02, 900, 1e-3
CARRIAGE = OdeModel(
    "carriage",
    {"m": (MASS, "kg"), "d": (DAMPING, "N*s/m"), "k": (CORD, "N/m")},
    {"push": "N"},
    {"x": ("m", "0", "v"), "v": ("m/s", "0", "(push - k*x - d*v)/m")},
    {"place": ("m", "x")},
)
SCENARIO = f"""\
title: A carriage against a cord
time: {{stop: {STEP * COUNT:g} s, macro_step: 20 ms, output_step: 20 ms}}
components:
  drive: {{kind: programme, outputs: {{push: {{unit: N, constant: 0 N}}}}}}
  carriage: {{kind: fmu, fmu: carriage.fmu, integrator: cvode}}
connections: [drive.push -> carriage.push]
"""


def course(push: Array, friction: float) -> Array:
    """Places at the begin of every step, by an implicit method with tight tolerances, shape (steps,) [m]."""
    found, state = np.empty(len(push)), np.zeros(2)
    for k, force in enumerate(push):
        found[k] = state[0]

        def rate(t: float, y: Array, force: float = force) -> list[float]:
            rubs = friction * np.tanh(y[1] / ROUNDING)
            return [y[1], (force - CORD * y[0] - DAMPING * y[1] - rubs) / MASS]

        state = solve_ivp(rate, (0.0, STEP), state, method="Radau", rtol=1e-7, atol=1e-9).y[:, -1]
    return found


def recorded(folder: Path, friction: float) -> list[Recording]:
    CARRIAGE.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    found = []
    for number in range(3):
        rng = np.random.default_rng([7, number])
        push = np.repeat(rng.uniform(-6.0, 6.0, COUNT // 45), 45)
        places = course(push, friction) + NOISE * rng.standard_normal(COUNT)
        columns = {"t": STEP * np.arange(COUNT), "F": push, "x": places}
        path = write_recording(
            folder / f"run_{number + 1}",
            columns,
            {"drive.push": ("F", "N")},
            {"carriage.place": ("x", "m", f"{1e3 * NOISE:g} mm")},
        )
        found.append(load_recording(path))
    return found


@pytest.fixture(scope="module")
def rubbing(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Recording]]:
    folder = tmp_path_factory.mktemp("carriage")
    return folder, recorded(folder, FRICTION)


def models(folder: Path, recordings: list[Recording]) -> tuple[ClosedLoopModel, ClosedLoopModel, Term]:
    scenario = load_scenario(folder / "scenario.yaml")
    model = ClosedLoopModel(scenario, recordings[:2])
    (law,) = [t for t in model.terms() if t.identifier == "dry_friction"]
    return model, ClosedLoopModel(scenario, recordings[2:], like=model), law


def chi_square(model: ClosedLoopModel, point: Point) -> float:
    return float(np.mean(model.residuals([point])[0] ** 2))


def test_steps_of_the_model_alone_are_too_long_for_friction_that_sets_in_at_once(rubbing) -> None:
    model, judge, law = models(*rubbing)
    true = Point(np.zeros(len(model.parameters)), {law: (FRICTION / MASS, ROUNDING)})
    assert chi_square(model, true) > 1.4
    assert model.refine(true)
    assert chi_square(model, true) == pytest.approx(1.0, abs=0.1)
    assert chi_square(judge, true) == pytest.approx(1.0, abs=0.1)  # what judges has the same steps
    assert not model.refine(true)


def test_without_laws_nothing_is_made_finer_and_a_law_that_is_slow_needs_no_more(rubbing) -> None:
    model, _, law = models(*rubbing)
    plain = Point(np.zeros(len(model.parameters)))
    assert not model.refine(plain)
    slow = Point(plain.base, {law: (0.01, 0.5)})
    assert not model.refine(slow)
    assert isinstance(model.model, SystemModel)
    fine = model.model
    apart = fine._residuals_by(slow, fine._steps_of(slow)) - fine._residuals_by(slow, 8 * fine._steps_of(slow))
    assert float(np.sum(apart**2)) < 2 * SAME


def test_a_fit_ends_where_more_steps_change_nothing(rubbing) -> None:
    model, _, law = models(*rubbing)
    found = fit(model, Point(np.zeros(len(model.parameters)), {law: (*law.parameters[0].starts[:1], ROUNDING)}))
    friction, rounding = found.point.terms[law]
    assert friction == pytest.approx(FRICTION / MASS, rel=0.03)
    assert rounding == pytest.approx(ROUNDING, rel=0.3)
    assert found.cost / len(found.residuals) == pytest.approx(1.0, abs=0.1)
    assert not model.refine(found.point)


def test_friction_is_named_with_its_size(rubbing) -> None:
    folder, recordings = rubbing
    answer = diagnose(
        load_scenario(folder / "scenario.yaml"),
        recordings[:2],
        recordings[2:],
        Settings(),
        options=Options(is_brief=True),
    ).diagnosis
    assert answer.verdict is Verdict.MISSING_PHYSICS
    (found,) = answer.accepted
    assert found.effect == "dry_friction"
    strength = found.parameters[0]
    assert strength.lower < FRICTION / MASS < strength.upper
