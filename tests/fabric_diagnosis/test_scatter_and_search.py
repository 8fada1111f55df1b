"""Contact scatter as uncertainty, and the search on what few simulations gave; truths are drawn, not simulated."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.models.fabric.mechanical import MechanicalModel
from diagnosis.models.fabric.scatter import FEWEST, Bins, Whitening, calibrated_scatter, scatter_covariance
from diagnosis.models.fabric.search import _Plan
from diagnosis.models.fabric.surface import Surface
from diagnosis.search.problem import Parameter, Point, Term, TermParameter
from diagnosis.search.search import Explanation, Settings, search

CHANNELS, TIMES = 10, 12
CHANNEL = np.tile(np.arange(CHANNELS), TIMES)
TIME = np.repeat(np.linspace(0.0, 1.0, TIMES), CHANNELS)
BINS = Bins(
    CHANNEL,
    TIME,
    np.zeros(len(TIME), dtype=int),
    np.zeros(len(TIME), dtype=int),
    np.full(len(TIME), 2e-5),
    np.full(len(TIME), 1e-2),
)
SCATTER = 3e-4  # m


def members(count: int, seed: int) -> np.ndarray:
    """Fabrics whose channels are off by amounts that stay for most of the run, as links that stick are."""
    random = np.random.default_rng(seed)
    stays = random.standard_normal((count, 1, CHANNELS)) * np.ones((1, TIMES, 1))
    moves = random.standard_normal((count, TIMES, CHANNELS))
    return 0.05 + SCATTER * (0.9 * stays + 0.4 * moves).reshape(count, -1)


def effect(kind: int, size: float) -> np.ndarray:
    """A pattern over channels that grows in time, of a size in metres."""
    pattern = np.random.default_rng(100 + kind).standard_normal(CHANNELS)
    return size * (TIME * pattern[CHANNEL])


def term(name: str) -> Term:
    return Term(name, "fabric", "mechanical", (TermParameter("size", "1", -10.0, 10.0, (1.0,)),))


TERMS = [term(name) for name in ("tilt", "payload", "wires", "friction")]


def model(measured: np.ndarray, ensemble: np.ndarray) -> MechanicalModel:
    surface = Surface(ensemble.mean(axis=0), np.zeros(1))
    surface.slopes[0] = effect(9, 1e-4)
    for kind, one in enumerate(TERMS):
        surface.add(one, 1.0, ensemble.mean(axis=0) + effect(kind, 1e-3), np.zeros(1))
    parameters = [Parameter("fabric.friction", "1", 0.5, 0.05)]
    return MechanicalModel(parameters, surface, measured, BINS, ensemble, [f"marker[{i}].z" for i in range(CHANNELS)])


def test_one_more_fabric_is_predicted_within_the_covariance_of_eight():
    squares = []
    for seed in range(20):
        drawn = members(9, seed)
        whiten = Whitening(calibrated_scatter(drawn[:8], BINS), BINS.noise)
        squares.append(np.mean(whiten(drawn[8] - drawn[:8].mean(axis=0)) ** 2))
    # a prediction from eight members is widened by (1 + 1/8) 7/5 = 1.6, so the mean lies below 1
    assert 0.5 < np.mean(squares) < 1.1


def test_scatter_that_stays_does_not_average_out_over_time():
    covariance = scatter_covariance(members(8, 1), BINS)
    first = CHANNEL == 0
    mean_variance = covariance[np.ix_(first, first)].mean()
    # true variance of a channel's mean over the run: (0.9^2 + 0.4^2 / 12) of SCATTER^2; white noise would give 1 / 12
    assert mean_variance > 0.4 * SCATTER**2


def test_members_farther_apart_than_the_covariance_says_widen_it():
    drawn = members(8, 2)
    drawn[3] += 20 * SCATTER * np.sin(40 * TIME)
    plain, wide = scatter_covariance(drawn, BINS), calibrated_scatter(drawn, BINS)
    assert np.trace(wide) > 1.5 * np.trace(plain)


def test_too_few_members_are_refused():
    with pytest.raises(ValueError, match="too few"):
        scatter_covariance(members(FEWEST - 1, 1), BINS)


def test_a_surface_is_exact_at_its_simulations_and_straight_between_them():
    surface = Surface(np.array([1.0, 2.0]), np.zeros(1))
    surface.slopes[0] = [0.5, 0.0]
    surface.add(TERMS[0], 1.0, np.array([1.2, 2.0]), np.zeros(1))
    surface.add(TERMS[0], 3.0, np.array([2.5, 2.0]), np.array([2.0]))  # 1.0 of it is the parameter's
    for strength, change in ((0.5, 0.1), (1.0, 0.2), (2.0, 0.35), (3.0, 0.5), (5.0, 0.8), (-1.0, -0.2)):
        assert surface.effect(TERMS[0], strength)[0] == pytest.approx(change)
    found = surface.bins([Point(np.zeros(1), {TERMS[0]: (2.0,)})], [np.array([1.0])])
    np.testing.assert_allclose(found, [[1.85, 2.0]])


def test_an_effect_beyond_the_scatter_is_named_with_its_size():
    drawn = members(9, 5)
    own = model(drawn[8] + effect(1, 3e-3), drawn[:8])
    outcome = search(own, TERMS, Settings())
    assert [t.identifier for t in outcome.best.terms] == ["payload"]
    strength = outcome.best.fit.point.terms[TERMS[1]][0]
    deviation = np.sqrt(outcome.best.fit.covariance[1, 1])
    assert strength == pytest.approx(3.0, abs=4 * deviation)
    assert deviation < 0.5


def test_scatter_alone_is_never_called_physics():
    found = 0
    for seed in range(20):
        drawn = members(9, 40 + seed)
        found += bool(search(model(drawn[8], drawn[:8]), TERMS, Settings()).best.terms)
    assert found == 0  # 5 % of 20 would be one; the widening makes it rarer


def test_without_the_covariance_scatter_would_be_called_physics():
    found = 0
    for seed in range(10):
        drawn = members(9, 40 + seed)
        own = model(drawn[8], drawn[:8])
        own._whiten = Whitening(1e-4 * own.scatter, replace(BINS, noise=BINS.noise).noise)
        found += bool(search(own, TERMS, Settings()).best.terms)
    assert found >= 5


def test_a_member_left_out_is_a_null():
    drawn = members(8, 7)
    null = model(drawn[0], drawn).without_member(3, seed=0)
    assert len(null.members) == 7
    np.testing.assert_allclose(null.measured, drawn[3], atol=6 * 2e-5)
    np.testing.assert_allclose(null.surface.mean, np.delete(drawn, 3, axis=0).mean(axis=0))
    assert not search(null, TERMS, Settings()).best.terms


def test_a_run_is_compared_with_parameters_moved_as_far_as_their_priors_allow():
    ensemble = members(8, 3)
    measured = ensemble.mean(axis=0) + effect(1, 1e-3)
    one, z = model(measured, ensemble), np.array([0.4])
    run = ensemble[0] + effect(9, 1e-4) * 0.4
    misfit = one.misfits(np.array([run, run + effect(9, 3e-4)]), Point(z))
    # By hand: the parameter anywhere, its prior of one deviation on top.
    values = np.linspace(-8.0, 8.0, 3201)
    whiten = Whitening(calibrated_scatter(ensemble, BINS), BINS.noise)
    for found, start in zip(misfit, (run, run + effect(9, 3e-4))):
        rows = start + np.outer(values - 0.4, effect(9, 1e-4))
        by_hand = np.sum(whiten(measured - rows) ** 2, axis=1) + values**2
        assert found == pytest.approx(float(by_hand.min()), rel=1e-4)
        assert found <= by_hand[int(np.argmin(np.abs(values - 0.4)))]


def test_channels_that_contacts_move_at_once_tell_less() -> None:
    """Markers of one link, and markers that scatter by themselves: shrinkage leaves half of what is alike."""
    alone = members(8, 21)
    one = 0.05 + (alone[:, CHANNEL == 0] - 0.05)[:, np.searchsorted(np.unique(TIME), TIME)]
    apart, alike = (model(m[0], m).scatters_together() for m in (alone, one))
    assert 1.0 <= apart < 2.0  # correlations of eight draws are no more than chance, and half of them is left
    assert alike > 2.0 * apart
    assert alike < CHANNELS


def test_how_a_rival_scatters_says_nothing_of_what_is_found() -> None:
    """A link that snaps with one law and not with another made both as uncertain as the one that snaps."""
    found, rival = (Explanation(SimpleNamespace(point=Point(np.zeros(1), {t: (1.0,)}))) for t in TERMS[:2])
    added: list[Term] = []
    counted: list[float] = []
    plan: Any = object.__new__(_Plan)
    plan.model = SimpleNamespace(laws=lambda: TERMS, own_point=lambda point: point)
    plan.surface = SimpleNamespace(add=lambda term, *rest: added.append(term), strengths=lambda term: [])
    plan.surface.has_near = lambda term, size, starts: False
    plan._sharpened = 2
    plan._network_point = Point(np.zeros(0))
    plan._enter = lambda stage, count: None
    plan._hopeful_of = lambda outcome: [found, rival]
    plan._runs = lambda points: [np.full((2, 3), next(iter(p.terms.values()))[0]) for p, _ in points]
    plan._scatter_of = lambda runs: counted.append(float(runs[0, 0]))
    assert plan.sharpen(SimpleNamespace(best=found), 4)
    assert added == [TERMS[0], TERMS[0], TERMS[1], TERMS[1]]  # as fitted, and at the largest
    assert len(counted) == 2


def test_strengths_by_which_runs_differ_are_those_of_a_straight_line() -> None:
    """Runs that differ by an effect alone differ by that strength from the mean of the others."""
    ensemble = members(8, 1)
    found = model(ensemble[0], ensemble)
    sizes = np.array([0.3, -0.1, 0.25, 0.05])
    runs = 0.05 + np.array([effect(0, 1e-3 * s) + 2.0 * effect(9, 1e-4) for s in sizes])
    shifts = found.shifts(runs, effect(0, 1e-3), Point(np.zeros(1)))
    others = np.array([np.delete(sizes, n).mean() for n in range(4)])
    np.testing.assert_allclose(shifts, sizes - others, atol=2e-3)


def test_fabrics_that_scatter_are_told_apart_by_no_less_than_that() -> None:
    """The scatter of strengths over runs is the one with which a recording tells them."""
    ensemble = members(8, 1)
    found = model(ensemble[0], ensemble)
    slope = effect(0, 1e-3)
    told = [np.std(found.shifts(members(6, 50 + n), slope, Point(np.zeros(1)))) for n in range(20)]
    alone = [found.shifts(members(2, 90 + n), slope, Point(np.zeros(1)))[0] for n in range(60)]
    assert np.mean(told) == pytest.approx(np.std(alone) / np.sqrt(2.0) * np.sqrt(6.0 / 5.0), rel=0.35)


def _at_other_strengths(terms: dict[Term, tuple[float, ...]], misfits: dict[float, list[float]]) -> tuple[Any, ...]:
    """What `at_other_strengths` gives of such an explanation, what was searched, and strengths that the surface got."""
    fitted = SimpleNamespace(best=SimpleNamespace(fit=SimpleNamespace(point=Point(np.zeros(1), terms))))
    added: list[float] = []
    plan: Any = object.__new__(_Plan)
    plan.model = SimpleNamespace(laws=lambda: TERMS, own_point=lambda point: point, network_point=lambda point: point)
    plan.surface = SimpleNamespace(add=lambda term, size, *rest: added.append(size))
    plan._network_point = Point(np.zeros(0))
    known = {size: np.array(values) for size, values in misfits.items()}
    runs = {(TERMS[0], size): np.full((6, 3), size) for size, v in known.items() if np.isfinite(v).all()}
    plan._at_other_strengths = lambda wanted, point: ({TERMS[0]: known}, runs)
    plan.search = lambda settings: "searched"
    plan.settled = lambda outcome, settings: f"{outcome} and settled"
    found = plan.at_other_strengths(fitted, Settings())
    return (found if found is not fitted else "as it was"), sorted(added)


def test_a_strength_that_meets_the_recordings_better_is_searched_with_before_a_second_effect() -> None:
    """A spring that is too weak to open its link: 0.25 shuts it in some runs, and 1.0 in all of them."""
    at = {0.0: [460.0, 470.0], 0.25: [187.0, 189.0, 190.0], 0.5: [186.0, 190.0, 180.0], 1.0: [152.0, 151.0, 155.0]}
    assert _at_other_strengths({TERMS[0]: (0.25,)}, at) == ("searched and settled", [0.25, 0.5, 1.0])


@pytest.mark.parametrize(
    ("terms", "at"),
    [
        ({TERMS[0]: (0.25,), TERMS[1]: (1.0,)}, {0.25: [187.0, 189.0], 1.0: [152.0, 151.0]}),
        ({TERMS[0]: (0.25,)}, {0.25: [187.0, 160.0, 190.0], 1.0: [152.0, 190.0, 175.0]}),
        ({TERMS[0]: (0.25,)}, {0.25: [np.inf], 1.0: [152.0, 151.0]}),
        ({TERMS[0]: (0.0,)}, {0.25: [187.0, 189.0], 1.0: [152.0, 151.0]}),
        ({term("camera"): (0.25,)}, {0.25: [187.0, 189.0], 1.0: [152.0, 151.0]}),
    ],
    ids=["two effects", "within scatter", "one that stops", "no strength", "of a camera"],
)
def test_no_other_strength_is_searched_with(terms: dict[Term, tuple[float, ...]], at: dict[float, list[float]]) -> None:
    assert _at_other_strengths(terms, at) == ("as it was", [])
