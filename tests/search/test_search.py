"""What the search accepts, rejects and says by how much; on a model in closed form."""

from dataclasses import replace

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.search.fit import fit
from diagnosis.search.problem import Alike, Layout, Parameter, Point, Term
from diagnosis.search.score import Projection, score
from diagnosis.search.search import Explanation, Settings, recalibrate, search, shrink, spread
from diagnosis.search.structure import structure
from diagnosis.search.switches import is_strained, switch_scores
from tests.search.line_model import BEND, LID, STEP, TERMS, TIME, WAVE, LineModel

LINE = 0.3 + 0.5 * TIME


def test_the_promised_gain_is_what_a_refit_gains():
    model = LineModel(LINE + 0.5 * TIME**2)
    base = recalibrate(model)
    best = score(model, base, [BEND]).ranked[0]
    refit = fit(model, base.point.plus(BEND, best.values))
    assert best.gain == pytest.approx(base.cost - refit.cost, rel=1e-3)
    assert best.values[0] == pytest.approx(refit.point.terms[BEND][0], rel=1e-3)


def test_what_a_recalibration_does_as_well_cannot_be_seen():
    model = LineModel(LINE)
    base = recalibrate(model)
    seen = score(model, base, [BEND, WAVE]).ranked
    visibility = {s.term: s.visibility for s in seen}
    # t^2 less its best line has the length 1 / sqrt(180) of 1 / sqrt(5)
    if BEND in visibility:
        assert visibility[BEND] == pytest.approx(np.sqrt(5.0 / 180.0), rel=0.05)
    assert visibility.get(WAVE, 1.0) > 0.5


@pytest.mark.parametrize(
    ("truth", "term"),
    [
        (LINE + 2.0 * TIME**2, BEND),
        (LINE + 0.2 * np.sin(25 * TIME), WAVE),
        (LINE + 0.4 * (TIME > 0.63), STEP),
        (np.minimum(0.3 + TIME, 0.8), LID),
    ],
    ids=["bend", "wave", "jump", "lid"],
)
def test_the_term_that_is_missing_is_found_alone(truth, term):
    outcome = search(LineModel(truth, seed=3), TERMS, Settings())
    assert outcome.best.terms == (term,)
    assert outcome.left.is_noise
    assert not outcome.base_structure.is_noise
    assert outcome.false_alarm_rate < 1e-3


def test_two_terms_are_found_together():
    outcome = search(LineModel(LINE + 0.25 * np.sin(25 * TIME) + 0.5 * (TIME > 0.4), seed=5), TERMS, Settings())
    assert set(outcome.best.terms) == {WAVE, STEP}
    assert all(gain > outcome.margin for gain in outcome.best.gains.values())


def test_nulls_are_not_taken_for_physics():
    """With a floor of 0 the margin alone is at work: it allows 5 %; 40 nulls pass it at most 6 times (98 % sure)."""
    alarms = sum(bool(search(LineModel(LINE, seed=s), TERMS, Settings(floor=0.0)).best.terms) for s in range(40))
    assert alarms <= 6
    assert not any(search(LineModel(LINE, seed=s), TERMS, Settings()).best.terms for s in range(20))


def test_wild_readings_are_no_structure():
    model = LineModel(LINE, seed=2, wild=0.01)
    outcome = search(model, TERMS, Settings())
    assert not outcome.best.terms
    assert outcome.base_structure.is_noise


def test_structure_is_told_with_its_window():
    values = np.random.default_rng(0).standard_normal(300)
    values[100:112] += 3.0
    layout = Layout(np.zeros(300), np.arange(300.0), ("x",), ("thermal",))
    found = structure(values, layout)
    assert not found.is_noise
    assert 95.0 <= found.begin <= 105.0
    assert found.end - found.begin == 11.0


def test_priors_grow_where_coils_scatter_more_than_was_stated_and_not_by_one_string():
    parameters = [
        Parameter(f"coil[{s},{c}].conductance", "1", 1.0, 0.03, alike=Alike("conductance", f"string {s}"))
        for s in range(1, 7)
        for c in range(1, 7)
    ]
    rng = np.random.default_rng(1)
    assert np.all(spread(parameters, rng.standard_normal(36)) < 1.4)
    # the median of 90 differences, which are not independent, is good to about 15 %
    np.testing.assert_allclose(spread(parameters, 2.0 * rng.standard_normal(36)), 2.0, rtol=0.35)
    string = rng.standard_normal(36)
    string[:6] += 8.0
    assert np.all(spread(parameters, string) < 1.4)
    one = rng.standard_normal(36)
    one[7] = 20.0
    assert np.all(spread(parameters, one) < 1.4)


def test_a_strength_against_its_sign_gains_nothing():
    model = LineModel(LINE + 1.0 * (TIME > 0.5))
    base = fit(model, Point(np.zeros(2)))
    ranked = score(model, base, [LID]).ranked
    assert all(0.0 <= s.values[0] <= 1.0 for s in ranked)


def test_what_a_parameter_at_its_bound_would_do_is_seen():
    """An offset that may move by 6 deviations and would need 7 stays at its bound: more is no recalibration."""
    free, held = (recalibrate(LineModel(offset + 0.5 * TIME)) for offset in (3.0, 7.0))
    assert held.point.base[0] == pytest.approx(6.0, rel=1e-3)
    column = held.columns.values[:, :1].T
    for base, least, most in ((free, 0.0, 1e-3), (held, 0.15, 0.3)):
        projection = Projection(base)
        projection.noise(2, 0)
        seen = projection.look(np.asarray(column))
        # of a constant a line through the origin leaves a quarter, 1 - (1/2)^2 / (1/3); large residuals weigh less
        assert least <= seen.left[0] / seen.whole[0] <= most


def test_a_switch_is_found_from_the_nominal_point_where_the_base_was_pulled_away():
    """Readings cut off at 0.9 of a line that rises to 5.3: recalibrated, the line itself stays near the ceiling."""
    model = LineModel(np.minimum(0.3 + 5.0 * TIME, 0.9))
    model.parameters = [replace(p, nominal=n) for p, n in zip(model.parameters, (0.3, 5.0))]
    model.signal = lambda point: LineModel.signal(model, Point(point.base + np.array([0.3, 5.0]), point.terms))
    base = recalibrate(model)
    assert is_strained(base)
    found = switch_scores(model, base, TERMS)
    assert [s.term for s in found] == [LID]
    assert found[0].values[1] == 0.9
    assert search(model, TERMS, Settings()).best.terms == (LID,)


def test_switches_are_left_to_straight_lines_where_the_base_holds():
    model = LineModel(LINE)
    assert switch_scores(model, recalibrate(model), TERMS) == []


class Spiked(LineModel):
    """With a term that moves three readings in the middle, or fewer."""

    def __init__(self, off: int) -> None:
        super().__init__(LINE)
        self.measured[200 : 200 + off] += 3.0

    def signal(self, point: Point) -> Array:
        found = super().signal(point)
        found[200:203] += point.terms.get(BLOCK, (0.0,))[0]
        return found


BLOCK = replace(BEND, identifier="block")


@pytest.mark.parametrize(("off", "kept"), [(2, ()), (3, (BLOCK,))])
def test_what_explains_two_readings_is_no_law(off: int, kept: tuple[Term, ...]) -> None:
    model = Spiked(off)
    with_it = fit(model, recalibrate(model).point.plus(BLOCK, (2.0,)))
    assert recalibrate(model).cost - with_it.cost > 20.0  # Huber's function leaves that much of two wild readings
    assert shrink(model, Explanation(with_it), 20.0).terms == kept
