"""The fit finds what a closed form gives, keeps bounds, and shrugs off wild readings."""

import numpy as np
import pytest

from diagnosis.search.fit import fit
from diagnosis.search.problem import Point
from tests.search.line_model import BEND, LID, STEP, TIME, LineModel


def test_a_linear_fit_is_the_posterior_of_a_gaussian():
    model = LineModel(0.3 + 0.5 * TIME)
    found = fit(model, Point(np.zeros(2)))
    design = np.stack([np.ones_like(TIME), TIME], axis=1) / 0.1
    normal = design.T @ design + np.eye(2)
    expected = np.linalg.solve(normal, design.T @ (model.measured / 0.1))
    assert found.is_converged
    # Huber's weights leave a few readings beyond four deviations aside: none here
    np.testing.assert_allclose(found.point.base, expected, atol=1e-6)
    np.testing.assert_allclose(found.covariance, np.linalg.inv(normal), rtol=1e-6)


def test_a_fit_near_another_takes_no_derivatives_of_its_own():
    model = LineModel(0.3 + 0.5 * TIME + 0.4 * TIME**2)
    base = fit(model, Point(np.zeros(2)))
    before = model.jacobians
    found = fit(model, base.point.plus(BEND, (0.1,)), near=base)
    assert model.jacobians == before
    assert found.point.terms[BEND][0] == pytest.approx(0.4, abs=0.15)  # two deviations
    fresh = fit(model, base.point.plus(BEND, (0.1,)))
    assert found.cost == pytest.approx(fresh.cost, abs=1e-3)


def test_wild_readings_move_an_estimate_little():
    clean = fit(LineModel(0.3 + 0.5 * TIME), Point(np.zeros(2)))
    wild = fit(LineModel(0.3 + 0.5 * TIME, wild=0.02), Point(np.zeros(2)))
    # 2 % of readings 5 off would move a mean by 0.1; bounded influence allows 0.02 * 4 * 0.1
    assert abs(wild.point.base[0] - clean.point.base[0]) < 0.03


def test_a_switch_is_there_wholly_or_not_at_all():
    model = LineModel(np.minimum(0.2 + TIME, 0.8))
    base = fit(model, Point(np.zeros(2)))
    found = fit(model, base.point.plus(LID, (0.02, 0.9)))
    assert found.point.terms[LID][0] == pytest.approx(1.0, abs=1e-6)
    assert found.point.terms[LID][1] == pytest.approx(0.8, abs=0.03)


def test_an_instant_is_found_from_a_start_nearby():
    model = LineModel(0.2 + 0.5 * (TIME > 0.53))
    base = fit(model, Point(np.zeros(2)))
    found = fit(model, base.point.plus(STEP, (0.3, 0.5)))
    assert found.point.terms[STEP][1] == pytest.approx(0.53, abs=0.01)


def test_wider_priors_let_parameters_go_farther():
    model = LineModel(5.0 + 0.0 * TIME)
    near = fit(model, Point(np.zeros(2)))
    wide = fit(model, Point(np.zeros(2)), widths=np.array([4.0, 1.0]))
    assert wide.point.base[0] > near.point.base[0]
    assert wide.cost < near.cost - 20.0  # (5 / 1)^2 against (5 / 4)^2
