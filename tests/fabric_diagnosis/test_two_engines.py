"""What two engines differ by for one fabric is an error of solving its equations, and counts as uncertainty."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cosim.components import FabricComponent
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.candidates.registry import catalogue
from diagnosis.models.build import model_of
from diagnosis.models.fabric.mechanical import MechanicalModel
from diagnosis.models.fabric.model import FabricModel
from diagnosis.models.fabric.runs import in_other_engine
from diagnosis.models.fabric.scatter import SHOWN, engine_covariance
from diagnosis.models.fabric.search import Effort, _Plan
from diagnosis.search.problem import Point
from diagnosis.search.search import Settings, search
from mechanics import unit
from mechanics.mujoco_world import MujocoMissing
from tests.fabric_diagnosis.fabrics import DRAPE, made, with_fabric
from tests.fabric_diagnosis.test_scatter_and_search import BINS, CHANNEL, SCATTER, TERMS, effect, members, model

#: A pattern over channels that grows, which no effect makes: by it the mean of the other engine differs [m].
DIFFERENCE = effect(50, 8.0 * SCATTER)


def with_difference(measured: np.ndarray, ensemble: np.ndarray) -> MechanicalModel:
    plain = model(measured, ensemble)
    return MechanicalModel(
        plain.parameters, plain.surface, measured, BINS, ensemble, plain.layout.names, difference=DIFFERENCE
    )


def test_half_of_the_covariance_lies_along_the_difference_and_its_size_is_kept():
    covariance = engine_covariance(DIFFERENCE, BINS)
    direction = DIFFERENCE / np.linalg.norm(DIFFERENCE)
    along = float(direction @ covariance @ direction)
    assert SHOWN * np.sum(DIFFERENCE**2) < along <= np.sum(DIFFERENCE**2)
    assert np.trace(covariance) == pytest.approx(np.sum(DIFFERENCE**2), rel=0.05)  # averaged over neighbouring times
    assert np.all(np.linalg.eigvalsh(covariance) > -1e-12)
    apart = covariance[np.ix_(CHANNEL == 0, CHANNEL == 1)]
    assert np.allclose(apart, SHOWN * np.outer(DIFFERENCE[CHANNEL == 0], DIFFERENCE[CHANNEL == 1]))


def test_a_fabric_of_the_other_engine_is_rejected_without_the_difference_and_not_with_it():
    drawn = members(9, 5)
    measured = drawn[8] + DIFFERENCE
    nothing = [Point(np.zeros(1))]
    assert np.mean(model(measured, drawn[:8]).residuals(nothing)[0] ** 2) > 3.0
    whole = with_difference(measured, drawn[:8])
    assert np.mean(whole.residuals(nothing)[0] ** 2) < 1.3
    assert not search(whole, TERMS, Settings()).best.terms


def test_an_effect_is_found_beside_the_difference_with_its_size():
    drawn = members(9, 5)
    own = with_difference(drawn[8] + DIFFERENCE + effect(1, 4e-3), drawn[:8])
    outcome = search(own, TERMS, Settings())
    assert [t.identifier for t in outcome.best.terms] == ["payload"]
    strength = outcome.best.fit.point.terms[TERMS[1]][0]
    assert strength == pytest.approx(4.0, abs=4.0 * np.sqrt(outcome.best.fit.covariance[1, 1]))


def test_a_run_of_the_other_engine_is_a_null_with_noise_of_its_own():
    drawn = members(8, 7)
    whole = with_difference(drawn[0], drawn)
    first, second = (whole.of_other_engine(drawn[3] + DIFFERENCE, n, seed=0) for n in range(2))
    np.testing.assert_allclose(first.measured, drawn[3] + DIFFERENCE, atol=6 * 2e-5)
    assert np.any(first.measured != second.measured)
    assert np.all(first.surface.mean == whole.surface.mean)
    assert not search(first, TERMS, Settings()).best.terms


def test_the_other_engine_has_its_own_settings_and_what_both_know():
    drape = load_scenario(DRAPE)
    plain = drape.components["fabric"]
    assert isinstance(plain, FabricComponent)
    assert plain.engine == "bullet"
    other = in_other_engine(drape, "fabric")
    fabric = other.components["fabric"]
    assert isinstance(fabric, FabricComponent)
    assert (fabric.engine, fabric.solver.micro_step.to("ms")) == ("mujoco", 0.25)
    assert fabric.solver.iterations == plain.solver.iterations
    assert fabric.parameters == plain.parameters
    back = in_other_engine(other, "fabric").components["fabric"]
    assert isinstance(back, FabricComponent)
    assert (back.engine, back.solver.friction_anchors) == ("bullet", True)


def test_without_another_engine_the_search_goes_on_and_says_what_is_not_counted(tmp_path, monkeypatch):
    def missing() -> None:
        raise MujocoMissing("the package mujoco is not installed")

    monkeypatch.setattr(unit, "load_mujoco", missing)
    drape = load_scenario(DRAPE)
    with pytest.raises(InputError):
        in_other_engine(drape, "fabric")
    recording = made(tmp_path / "r", 1, [f"marker[{i}].z" for i in (6, 7, 8)], drape)
    fabric = model_of(drape, [recording], catalogue())
    assert isinstance(fabric, FabricModel)
    assert fabric.untried == ()
    plan = _Plan(fabric, Settings(), Effort(4, 1, 1, 1), lambda text: None)
    plan.anchor()
    assert plan._difference is None
    (told,) = fabric.untried
    assert told.startswith("what two engines differ by is not known and not counted as uncertainty: ")


def test_a_fabric_that_the_other_engine_refuses_is_refused_with_its_reason():
    bouncing = with_fabric(load_scenario(DRAPE), restitution="0.2")
    with pytest.raises(InputError, match="restitution"):
        in_other_engine(bouncing, "fabric")


def test_two_engines_that_differ_are_asked_once_and_counted(tmp_path):
    """A drape in Bullet and in MuJoCo: they part by tenths of a millimetre, and so much is in the deviation."""
    drape = load_scenario(DRAPE)
    recording = made(tmp_path / "r", 1, [f"marker[{i}].z" for i in (6, 7, 8)], drape)
    fabric = model_of(drape, [recording], catalogue())
    assert isinstance(fabric, FabricModel)
    plan = _Plan(fabric, Settings(), replace(Effort(4, 1, 1, 1), others=2), lambda text: None)
    plan.anchor()
    assert fabric.untried == ()
    assert len(plan._elsewhere) == 2
    assert plan._difference is not None
    assert 1e-6 < np.sqrt(np.mean(plan._difference**2)) < 5e-3
    plan._prepare(plan._members)
    deviation = fabric.prepared.scatter_deviation()
    plan._difference = None
    plan._prepare(plan._members)
    alone = fabric.prepared.scatter_deviation()
    assert np.all(deviation >= alone)
    assert np.any(deviation > 1.05 * alone)
