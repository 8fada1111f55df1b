"""What a search does where no model meets the readings within their noise, and what the first stretch is for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from cosim.compute.steps import TimeIsOver
from diagnosis import model_error
from diagnosis.model_error import REFITTED, refitted, search_with_model_error
from diagnosis.models.protocol import Labelled
from diagnosis.models.wrappers.quasi_likelihood import QuasiLikelihoodModel, correlation_time, inflation
from diagnosis.search.complete import by_few_terms
from diagnosis.search.fit import Fit, fit
from diagnosis.search.problem import Layout, Parameter, Point, Term, TermParameter
from diagnosis.search.search import Explanation, Outcome, Settings, recalibrate, search
from diagnosis.search.structure import structure
from diagnosis.search.validation import BLOCKS, Validated, Validation, blocks, chosen
from tests.search.line_model import BEND, LID, STEP, TERMS, TIME, WAVE, LineModel
from tests.verdict.lines import Law

TIMES = np.linspace(0.0, 10.0, 200)
LAYOUT = Layout(np.zeros(200, dtype=int), TIMES, ("bath.temperature",), ("thermal",))


def term(name: str) -> Term:
    return Term(name, "bath", "thermal", (TermParameter("a", "1", -10.0, 10.0, (0.1,)),))


class Curves:
    """A straight line, with terms that add a curve each; readings are given."""

    parameters = (Parameter("level", "1", 0.0, 10.0, False), Parameter("slope", "1", 0.0, 10.0, False))
    layout = LAYOUT
    curves = {"bend": np.sin(TIMES), "gap": np.where(TIMES > 8.0, TIMES - 8.0, 0.0)}

    def __init__(self, readings: np.ndarray, seen: np.ndarray | None = None) -> None:
        self.readings = readings
        self.seen = np.ones(200, dtype=bool) if seen is None else seen

    def residuals(self, points: Sequence[Point]) -> np.ndarray:
        found = []
        for p in points:
            curve = 10.0 * p.base[0] + p.base[1] * TIMES
            for t, values in p.terms.items():
                curve = curve + values[0] * self.curves[t.identifier]
            found.append(np.where(self.seen, self.readings - curve, 0.0))
        return np.array(found)

    def base_jacobian(self, point: Point) -> np.ndarray:
        return -np.stack([np.full(200, 10.0), TIMES], axis=1) * self.seen[:, None]


@pytest.mark.parametrize("share", [0.0, 0.5, 0.9])
def test_the_correlation_time_is_that_of_an_autoregressive_process(share):
    rng, values = np.random.default_rng(3), np.zeros(4000)
    noise = rng.standard_normal(4000)
    for i in range(1, 4000):
        values[i] = share * values[i - 1] + noise[i]
    expected = (1 + share) / (1 - share)
    assert correlation_time(values) == pytest.approx(expected, rel=0.35)  # 210 independent samples: up to 30 %


def test_noise_that_is_as_stated_is_not_inflated_and_twice_as_much_fourfold():
    noise = np.random.default_rng(1).standard_normal(200)
    assert inflation(noise, LAYOUT)[0] < 2.0
    assert inflation(2.0 * noise, LAYOUT)[0] / inflation(noise, LAYOUT)[0] == pytest.approx(4.0, rel=0.3)


def test_a_slow_error_of_one_deviation_counts_as_few_samples():
    assert inflation(np.sqrt(2.0) * np.sin(2 * np.pi * TIMES / 10.0), LAYOUT)[0] > 20.0


def test_stretches_are_equal_shares_of_time_and_hold_every_sample_once():
    found = blocks(LAYOUT)
    assert [int(b.sum()) for b in found] == [200 // BLOCKS] * BLOCKS
    assert np.array_equal(sum(b.astype(int) for b in found), np.ones(200))


def test_a_law_that_holds_predicts_and_a_gap_filler_does_not():
    """A sine of three periods is predicted from the rest; a bend at the end alone helps nowhere else."""
    readings = 4.0 * np.sin(TIMES) + np.random.default_rng(2).standard_normal(200)
    model = Curves(readings)
    validation = Validation(model, lambda seen: Curves(readings, seen))
    start = fit(model, Point(np.zeros(2)))
    grown = [Explanation(fit(model, start.point.plus(term(n), (0.1,)))) for n in ("bend", "gap")]
    selected = validation.select(Explanation(start), grown)
    assert [t.identifier for t in selected[0].terms] == ["bend"]
    losses = {tuple(t.identifier for t in f.explanation.terms): f.loss for f in validation.all}
    assert losses[("bend",)] == pytest.approx(1.0, abs=0.35)  # noise of 1; 200 samples: 0.1, and the fit's own errors
    assert losses[()] > 5.0


def test_of_two_that_predict_alike_the_plain_one_is_taken():
    readings = np.random.default_rng(2).standard_normal(200)
    start = Explanation(fit(Curves(readings), Point(np.zeros(2))))
    other = Explanation(fit(Curves(readings), start.fit.point.plus(term("bend"), (0.1,))))
    losses = np.array([1.0, 1.2, 0.9, 1.1, 1.0])
    far = Validated(start, readings, losses + 1.0)
    plain, special = Validated(other, readings, losses + 0.01), Validated(start, readings, losses * 0.98)
    assert chosen([far, plain, special], set(other.terms), 20.0) is special  # fewer terms, and it predicts better
    assert chosen([far, plain], set(other.terms), 20.0) is plain


def test_one_stretch_that_asks_for_what_it_alone_holds_does_not_outvote_the_others():
    readings = np.random.default_rng(2).standard_normal(200)
    start = Explanation(fit(Curves(readings), Point(np.zeros(2))))
    better = Validated(start, readings, np.array([1.0, 1.0, 1.0, 1.0, 30.0]))
    worse = Validated(start, readings, np.array([4.0, 4.0, 4.0, 4.0, 4.0]))
    assert np.mean(better.losses) > np.mean(worse.losses)
    assert better.loss == pytest.approx(30.0**0.2, rel=1e-4)  # fifth root of the product
    assert better.loss < worse.loss


def test_among_those_that_predict_alike_the_readings_decide_and_each_term_pays_the_margin():
    readings = 4.0 * np.sin(TIMES) + np.random.default_rng(2).standard_normal(200)
    start = Explanation(fit(Curves(readings), Point(np.zeros(2))))
    bend = Explanation(fit(Curves(readings), start.fit.point.plus(term("bend"), (0.1,))))
    gain = start.cost - bend.cost
    assert gain > 100.0  # 200 readings, errors of 4 / sqrt(2) against noise of 1, bounded
    losses = np.array([1.0, 1.2, 0.9, 1.1, 1.0])
    both = [Validated(start, readings, losses), Validated(bend, readings, losses * [1.02, 0.98, 1.03, 0.99, 1.0])]
    plain = set(bend.terms)
    assert chosen(both, plain, 0.9 * gain).explanation is bend
    assert chosen(both, plain, 1.1 * gain).explanation is start
    rejected = Validated(bend, readings, losses * 3.0)
    assert chosen([both[0], rejected], plain, 20.0).explanation is start


class Rig(LineModel):
    """A line model with all that a diagnosis asks of one."""

    runs = (SimpleNamespace(series=()),)
    simulations = 0
    can_be_searched_again = True

    def terms(self) -> list[Term]:
        return list(TERMS)

    def groups(self) -> dict[str, np.ndarray]:
        return {}

    def where(self, found: Term) -> tuple[Law, Labelled]:
        return Law(found.identifier, found.law, {}), Labelled(found.place)

    def shows_in(self, term: Term) -> None:
        """In every channel."""


def test_of_many_channels_what_the_search_found_is_weighed_and_not_searched_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # A slow error that no law has: the search fills its gaps until it may have no more terms.
    rig = Rig(0.3 + 0.5 * TIME + 3.0 * TIME**2 + 0.6 * np.sin(9.0 * TIME), seed=1)
    first = search(rig, TERMS, Settings(), rig.groups())
    assert {BEND, WAVE} < set(first.best.terms)
    monkeypatch.setattr(model_error, "MANY", 1)
    said: list[str] = []
    outcome, model = search_with_model_error(rig, Settings(), said.append)
    assert isinstance(model, QuasiLikelihoodModel)
    assert BEND in outcome.best.terms
    assert WAVE not in outcome.best.terms
    # The same term against errors as large as they are: worth a tenth of what noise alone would make of it.
    assert outcome.margin < outcome.best.gains[BEND] < 0.1 * first.best.gains[BEND]
    assert sum(text.startswith("looking for a first effect") for text in said) == 1


RIPPLE = replace(WAVE, identifier="ripple", is_completing=True)


class Rippled(Rig):
    """A wave is one of the terms that complete, which no search of laws tries."""

    def terms(self) -> list[Term]:
        return [BEND, STEP, LID, RIPPLE]

    def signal(self, point: Point) -> np.ndarray:
        return super().signal(Point(point.base, {WAVE if t == RIPPLE else t: v for t, v in point.terms.items()}))


def test_one_generic_term_that_leaves_noise_stands_in_the_place_of_all_laws_that_do_not() -> None:
    rig = Rippled(0.3 + 0.5 * TIME + 0.6 * np.sin(25.0 * TIME), seed=1)
    said: list[str] = []
    outcome, model = search_with_model_error(rig, Settings(), said.append)
    assert model is rig
    assert list(outcome.best.terms) == [RIPPLE]
    assert outcome.best.fit.point.terms[RIPPLE][0] == pytest.approx(0.6, abs=0.03)
    assert outcome.left.is_noise
    assert sum(text.startswith("looking for a first effect") for text in said) == 1


def test_where_one_or_two_terms_leave_more_than_noise_they_are_not_taken() -> None:
    rig = Rippled(0.3 + 0.5 * TIME + 0.6 * np.sin(25.0 * TIME) + 0.6 * (TIME * 4.5 % 1.0), seed=1)
    outcome, model = search_with_model_error(rig, Settings())
    assert isinstance(model, QuasiLikelihoodModel)
    assert RIPPLE not in outcome.best.terms


BENT = replace(BEND, identifier="bent", is_named=False)
WHOLE = replace(WAVE, identifier="whole", is_completing=True)


class Halves(Rig):
    """One law that completes is a bend and a wave at once; either has a law, with a name or without."""

    laws: tuple[Term, ...] = (BENT, WAVE, WHOLE)

    def terms(self) -> list[Term]:
        return list(self.laws)

    def signal(self, point: Point) -> np.ndarray:
        terms: dict[Term, tuple[float, ...]] = {}
        for term, values in point.terms.items():
            for part in {"bent": (BEND,), "wave": (WAVE,), "whole": (BEND, WAVE)}.get(term.identifier, (term,)):
                terms[part] = (terms.get(part, (0.0,))[0] + values[0],)
        return super().signal(Point(point.base, terms))


def halves(wave: float, laws: tuple[Term, ...] = Halves.laws) -> Halves:
    found = Halves(0.3 + 0.5 * TIME + 3.0 * TIME**2 + wave * np.sin(25.0 * TIME), seed=1)
    found.laws = laws
    return found


def test_one_term_that_explains_what_two_laws_without_a_name_do_stands_in_their_place() -> None:
    assert len(search(halves(3.0), [BENT, WAVE], Settings()).best.terms) == 2
    outcome, model = search_with_model_error(halves(3.0), Settings())
    assert isinstance(model, Halves)
    assert list(outcome.best.terms) == [WHOLE]
    assert outcome.best.fit.point.terms[WHOLE][0] == pytest.approx(3.0, abs=0.1)
    assert outcome.left.is_noise


@pytest.mark.parametrize(
    ("wave", "laws"), [(2.0, (BENT, WAVE, WHOLE)), (3.0, (BEND, replace(WAVE, is_named=True), WHOLE))]
)
def test_laws_stand_that_one_term_does_not_explain_and_those_with_names(wave: float, laws: tuple[Term, ...]) -> None:
    outcome, _ = search_with_model_error(halves(wave, laws), Settings())
    assert set(outcome.best.terms) == set(laws[:2])


def test_where_time_is_over_before_one_term_was_tried_laws_stand(monkeypatch: pytest.MonkeyPatch) -> None:
    def over(*_: object) -> None:
        raise TimeIsOver

    monkeypatch.setattr(model_error, "by_few_terms", over)
    outcome, model = search_with_model_error(halves(3.0), Settings())
    assert isinstance(model, Halves)
    assert set(outcome.best.terms) == {BENT, WAVE}
    assert outcome.few is None


def rough() -> Halves:
    """Neither both laws nor the one that completes explain the teeth."""
    return Halves(0.3 + 0.5 * TIME + 3.0 * TIME**2 + 3.0 * np.sin(25.0 * TIME) + 0.8 * (TIME * 4.5 % 1.0), seed=1)


def test_where_two_terms_leave_structure_one_alone_is_asked_for_once_before_a_third() -> None:
    rig, asked = rough(), list[tuple[int, float]]()

    def none(base: Fit, margin: float) -> None:
        asked.append((len(base.point.terms), margin))

    search(rig, [BENT, WAVE], Settings(), instead=none)
    assert [terms for terms, _ in asked] == [0]
    assert asked[0][1] >= 20.0
    asked.clear()
    search(halves(3.0), [BENT, WAVE], Settings(), instead=none)
    assert asked == []  # noise is left


def test_one_term_that_explains_what_two_do_not_ends_the_search() -> None:
    rig = rough()
    other = Explanation(fit(rig, Point(np.zeros(len(rig.parameters)), {WHOLE: (3.0,)})))
    found = search(rig, [BENT, WAVE], Settings(), instead=lambda base, margin: other)
    assert found.best.terms == (WHOLE,)
    assert found.rivals[0] is other


@pytest.mark.parametrize("can_be_searched_again", [True, False])
def test_one_term_alone_is_asked_for_however_long_the_recordings_are(
    can_be_searched_again: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It costs a part of the search that it may end; other searches are as long as that itself."""
    monkeypatch.setattr(model_error, "BELIEVED", 1e9)  # what comes after the search is not asked here
    rig = rough()
    rig.can_be_searched_again = can_be_searched_again
    said: list[str] = []
    outcome, _ = search_with_model_error(rig, Settings(), said.append)
    assert outcome.one is not None
    assert any("one or two terms alone" in text for text in said)


#: Laws that complete, at a place where no other law acts: a strength alone, and one with a shape.
THERE = replace(WAVE, identifier="there", place="elsewhere", is_completing=True)
SHAPED = replace(
    THERE, identifier="shaped", parameters=(*WAVE.parameters, TermParameter("knot", "s", 0.0, 1.0, (0.5,)))
)


class Elsewhere(Rig):
    """What is missing acts where no law of the search does."""

    def terms(self) -> list[Term]:
        return [BEND, STEP, LID, THERE, SHAPED]

    def signal(self, point: Point) -> np.ndarray:
        terms = {WAVE if t in (THERE, SHAPED) else t: v for t, v in point.terms.items()}
        return super().signal(Point(point.base, terms))


def test_a_strength_that_completes_singles_out_its_place() -> None:
    """Laws elsewhere score something, and none does there."""
    rig = Elsewhere(0.3 + 0.5 * TIME + 0.6 * np.sin(25.0 * TIME), seed=1)
    base = recalibrate(rig)
    found = by_few_terms(rig, base, rig.terms(), Settings(), 20.0, most=1)
    assert found.terms == (THERE,)
    assert found.fit.point.terms[THERE][0] == pytest.approx(0.6, abs=0.03)
    assert by_few_terms(rig, base, [BEND, STEP, LID, SHAPED], Settings(), 20.0, most=1).terms != (SHAPED,)


class Waves(Curves):
    """A straight line, with terms that add a wave each."""

    curves = {f"wave_{n}": np.sin(0.7 * n * TIMES) for n in range(1, 10)}

    def groups(self) -> dict[str, np.ndarray]:
        return {}


def test_with_larger_errors_the_nearest_rivals_are_fitted_again_and_the_others_left_out():
    rng = np.random.default_rng(2)
    sizes = {"wave_3": 3.0} | {f"wave_{n}": 0.1 * n for n in (1, 2, 4, 5, 6, 7, 8, 9)}
    truth = sum(size * Waves.curves[name] for name, size in sizes.items())
    model = Waves(1.0 + 0.2 * TIMES + truth + rng.standard_normal(200))
    every = [Explanation(fit(model, Point(np.zeros(2), {term(name): (0.1,)}))) for name in Waves.curves]
    best = min(every, key=lambda e: e.fit.cost)
    assert [t.identifier for t in best.terms] == ["wave_3"]
    quiet = structure(best.fit.residuals, model.layout)
    outcome = Outcome(every[0].fit, quiet, best, quiet, tuple(every), 1.0, 0.01, 9)
    found = refitted(model, outcome)
    near = sorted((e for e in every if e is not best), key=lambda e: e.fit.cost)[:REFITTED]
    assert [e.terms for e in found.rivals] == [best.terms, *(e.terms for e in near)]
    assert len(every) > 1 + REFITTED
