"""How far a strength may be from the fitted one, by simulations at others."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.candidates.registry import catalogue
from diagnosis.judge.estimates import estimated, estimates
from diagnosis.models.build import model_of
from diagnosis.models.fabric.model import FabricModel
from diagnosis.models.fabric.strengths import (
    best_size,
    better_size,
    fitted_sizes,
    interval_of,
    is_better,
    next_sizes,
    widened,
)
from diagnosis.recording.recording import load_recording
from diagnosis.search.problem import TermParameter
from diagnosis.search.search import Settings
from tests.fabric_diagnosis.fabrics import laws_but
from tests.fabric_diagnosis.test_refuted_finding import recorded, tiny

ROLL = TermParameter("roll", "rad", -0.5, 0.5, (0.25,))
SHARE = TermParameter("steel_loss", "1", 0.0, 0.9, (0.4,))


def runs(level: float, scatter: float = 0.0, count: int = 6) -> Array:
    """Misfits of so many runs about a level."""
    return np.asarray(level + scatter * np.resize([-1.0, 1.0], count))


@pytest.mark.parametrize(
    ("strength", "known", "parameter", "sizes"),
    [
        (0.7, [0.4], SHARE, [0.7, 0.9]),  # springs weaker than any that were simulated: left out, too
        (0.3, [0.4], SHARE, [0.3]),  # between simulations a straight line is known at both ends
        (0.85, [0.4], SHARE, [0.85]),  # hardly below the largest, which would say nothing else
        (-0.1, [0.075, -0.075], ROLL, [-0.1, -0.3]),  # of the same sign, no farther than is believed
        (0.45, [0.075], ROLL, [0.45]),  # beyond belief already
        (0.0, [0.075], ROLL, []),
    ],
)
def test_beyond_what_was_simulated_the_largest_is_simulated_too(strength, known, parameter, sizes) -> None:
    assert fitted_sizes(strength, known, replace(parameter, plausible=0.3 if parameter is ROLL else 1.0)) == sizes


def test_exact_parabola_gives_what_curvature_gives() -> None:
    # -2 log likelihood ((s - 0.2) / 0.02)^2 has the 95 % interval 0.2 +- 1.96 * 0.02.
    misfits = {s: runs(((s - 0.2) / 0.02) ** 2) for s in (0.0, 0.05, 0.1, 0.2, 0.4, 0.5)}
    lower, upper = interval_of(0.2, misfits, ROLL)
    assert lower == pytest.approx(0.2 - 1.96 * 0.02, abs=1e-5)
    assert upper == pytest.approx(0.2 + 1.96 * 0.02, abs=1e-5)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_response_that_saturates_leaves_the_strength_open_upwards(sign: float) -> None:
    # From 0.1 on nothing more moves: 0.113 is met as well as 0.226 and 0.45, and 0.028 is not.
    misfits = {
        sign * s: runs(100.0 + 900.0 * max(0.0, 0.1 - s) / 0.1, 1.0) for s in (0.0, 0.028, 0.057, 0.113, 0.226, 0.452)
    }
    ends = interval_of(sign * 0.113, misfits, ROLL)
    near, far = sorted(ends, key=abs)
    assert far == pytest.approx(sign * 0.5)
    assert 0.057 < abs(near) < 0.113


def test_what_runs_scatter_by_is_no_reason_to_exclude_a_strength() -> None:
    level = {0.1: 300.0, 0.2: 300.0, 0.05: 340.0, 0.025: 400.0, 0.0: 500.0, 0.4: 340.0}
    sharp = interval_of(0.1, {s: runs(v, 1.0) for s, v in level.items()}, ROLL)
    blunt = interval_of(0.1, {s: runs(v, 60.0) for s, v in level.items()}, ROLL)
    assert blunt[0] < 0.05 < sharp[0]
    assert sharp[1] < 0.4 < blunt[1]


def test_one_run_excludes_nothing() -> None:
    misfits = {s: runs(300.0 + 1e4 * abs(s - 0.1), count=1) for s in (0.0, 0.025, 0.05, 0.1, 0.2, 0.4)}
    assert interval_of(0.1, misfits, ROLL) == (0.0, 0.5)


def test_strength_of_one_run_does_not_say_where_between_it_and_the_next_the_end_is() -> None:
    misfits = {0.1: runs(300.0, 1.0), 0.2: runs(300.0, count=1), 0.4: runs(900.0, 1.0), 0.0: runs(900.0, 1.0)}
    lower, upper = interval_of(0.1, misfits, ROLL)
    assert 0.0 < lower < 0.1
    assert upper == 0.4


def test_strength_that_is_not_told_from_nothing_reaches_nothing_and_stops_there() -> None:
    misfits = {-s: runs(300.0, 5.0) for s in (0.0, 0.025, 0.05, 0.1, 0.2)} | {-0.4: runs(900.0, 5.0)}
    lower, upper = interval_of(-0.1, misfits, ROLL)
    assert upper == 0.0
    assert -0.4 < lower < -0.2


def test_only_strengths_that_may_still_be_within_are_simulated() -> None:
    known: dict[float, Array] = {}
    assert next_sizes(0.2, known, ROLL) == [0.2, 0.1, 0.4]
    known |= {0.2: runs(300.0, 1.0), 0.1: runs(900.0, 1.0), 0.4: runs(300.5, 1.0)}
    assert next_sizes(0.2, known, ROLL) == [0.5]  # four times as much is beyond the bound
    known |= {0.5: runs(301.0, 1.0)}
    assert next_sizes(0.2, known, ROLL) == []
    assert interval_of(0.2, known, ROLL)[1] == 0.5


def test_strength_at_its_bound_is_simulated_downwards_alone() -> None:
    assert next_sizes(0.9, {}, SHARE) == [0.9, 0.45]


def test_strength_that_cannot_be_simulated_ends_the_interval() -> None:
    known = {0.2: runs(300.0, 1.0), 0.1: runs(300.0, 1.0), 0.05: runs(np.inf, count=1), 0.4: runs(np.inf, count=1)}
    assert next_sizes(0.2, known, ROLL) == []
    assert interval_of(0.2, known, ROLL) == (0.1, 0.2)


@pytest.mark.parametrize("best", [0.2, 0.14, -0.2])
def test_where_the_fitted_strength_is_not_the_best_that_is_simulated_too(best: float) -> None:
    """The stand leaned by 0.2 rad: straight lines between knots gave 0.175 rad (0.158 to 0.186)."""
    fitted = float(np.copysign(0.175, best))
    known = {s: runs(300.0 + ((s - best) / 0.006) ** 2, 1.0) for s in (0.5 * fitted, fitted, 2.0 * fitted)}
    assert better_size(fitted, known) == pytest.approx(best)
    assert not interval_of(fitted, known, ROLL)[0] <= best <= interval_of(fitted, known, ROLL)[1]
    known[best] = runs(300.0, 1.0)
    assert better_size(fitted, known) is None
    assert is_better(best, fitted, known)
    low, high = interval_of(best, known, ROLL)
    assert low < best < high


def test_a_fitted_strength_that_is_nearly_the_best_stays() -> None:
    known = {s: runs(300.0 + ((s - 0.178) / 0.006) ** 2, 1.0) for s in (0.0875, 0.175, 0.35)}
    assert better_size(0.175, known) is None
    level = {s: runs(300.0 + ((s - 0.2) / 0.02) ** 2, 20.0) for s in (0.0875, 0.175, 0.2, 0.35)}
    assert not is_better(0.2, 0.175, level)  # by less than both means scatter


def test_no_effect_at_all_is_no_better_strength() -> None:
    """A row of springs as good without any loss: a surface has no knot there."""
    known = {s: runs(300.0 + 1e4 * s, 1.0) for s in (0.0, 0.1, 0.2, 0.4)}
    assert best_size({s: float(np.mean(v)) for s, v in known.items()}) == 0.1
    assert better_size(0.2, known) is None
    turned = {s: runs(300.0 + 1e4 * (s + 0.05) ** 2, 1.0) for s in (0.0, 0.1, 0.2)}
    assert better_size(0.1, turned) is None  # the other way is another effect


def test_an_interval_holds_what_one_more_run_would_be_fitted_by() -> None:
    """Of 2000 fabrics with five runs each: 95 % of the recordings are told within it, however sharp a fit is."""
    rng = np.random.default_rng(9)
    inside = 0
    for _ in range(2000):
        told = 0.02 * rng.standard_normal(6)
        runs, recording = 0.2 + told[:5], 0.2 + told[5]
        shifts = np.array([r - np.delete(runs, n).mean() for n, r in enumerate(runs)])
        low, high = widened((0.199, 0.201), float(runs.mean()), shifts, ROLL)
        inside += low <= recording <= high
    assert 0.93 < inside / 2000 < 0.97
    assert widened((0.19, 0.21), 0.2, np.array([]), ROLL) == (0.19, 0.21)
    assert widened((0.01, 0.03), 0.02, np.full(5, 1.0), ROLL) == (0.0, 0.5)


def test_of_runs_that_stop_or_rise_to_one_side_no_better_strength_is_known() -> None:
    assert better_size(0.2, {0.1: runs(np.inf), 0.2: runs(300.0), 0.4: runs(np.inf)}) is None
    assert better_size(0.2, {0.1: runs(200.0), 0.2: runs(300.0), 0.4: runs(400.0)}) is None
    assert better_size(0.2, {0.2: runs(np.inf)}) is None


def test_search_bounds_the_strength_that_it_finds(tmp_path: Path) -> None:
    recording = load_recording(recorded(tmp_path / "leans", 1, tilt="0.3 rad"))
    model = model_of(tiny(), [recording], catalogue(), without=laws_but("tilt"))
    assert isinstance(model, FabricModel)
    (tilt,) = model.laws()[:1]
    assert model.simulated_interval(tilt) is None
    outcome = model.own_search(Settings(), lambda text: None)
    assert set(outcome.best.terms) == {tilt}
    lower, upper = model.simulated_interval(tilt) or (0.0, 0.0)
    value = outcome.best.fit.point.terms[tilt][0]
    assert 0.2 < lower < value < upper < 0.4
    # What is printed holds both intervals.
    (by_curvature,) = estimates(outcome.best.fit, tilt)
    model.take_interval(tilt, (0.1, 0.32))
    (told,) = estimated(model, outcome.best.fit, tilt, 1.0)
    assert told.lower == 0.1
    assert told.upper == by_curvature.upper > 0.32
    assert told.value == by_curvature.value
