"""Steps within bounds are minima within bounds."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from diagnosis.search.bounded import bounded_step


@pytest.mark.parametrize("seed", range(12))
def test_a_step_within_bounds_goes_downhill_as_far_as_any(seed):
    """Numbers that belong together (columns nearly alike), some of them at a bound; SciPy's solver is the reference."""
    rng = np.random.default_rng(seed)
    design = rng.standard_normal((40, 6))
    design[:, 1] = design[:, 0] + 0.05 * rng.standard_normal(40)
    right = design @ rng.standard_normal(6) * 3.0
    normal, slope = design.T @ design, -design.T @ right
    lower, upper = -rng.uniform(0.0, 1.0, 6), rng.uniform(0.0, 1.0, 6)
    step = bounded_step(normal, slope, lower, upper)
    best = lsq_linear(design, right, (lower, upper + 1e-12), tol=1e-12).x

    def gain(s: np.ndarray) -> float:
        return float(-2.0 * slope @ s - s @ normal @ s)

    assert np.all((step >= lower) & (step <= upper))
    assert gain(step) == pytest.approx(gain(best), rel=1e-6)  # SciPy stops at 1e-12


def test_without_bounds_it_is_newtons_step():
    normal = np.array([[4.0, 1.0], [1.0, 3.0]])
    slope = np.array([1.0, -2.0])
    step = bounded_step(normal, slope, np.full(2, -np.inf), np.full(2, np.inf))
    np.testing.assert_allclose(step, -np.linalg.solve(normal, slope), rtol=1e-12)


def test_what_stands_at_its_bound_and_wants_to_pass_stays():
    step = bounded_step(np.eye(2), np.array([1.0, 1.0]), np.array([0.0, -5.0]), np.array([1.0, 5.0]))
    np.testing.assert_allclose(step, [0.0, -1.0])


def test_a_model_without_anything_that_may_be_off_makes_an_empty_step():
    """As an amended scenario whose FMU states no uncertainty."""
    nothing = np.zeros(0)
    assert bounded_step(np.zeros((0, 0)), nothing, nothing, nothing).shape == (0,)
