"""A search that knows by how much even the best of its models is wrong."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial, reduce

import numpy as np

from cosim.compute.steps import TimeIsOver, counted, may_be_left
from cosim.unit.protocol import Array
from diagnosis.faults.given import GivenFaults, LawsOnly, faults_of, lasting_laws
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.wrappers.masked import MaskedModel
from diagnosis.models.wrappers.quasi_likelihood import BELIEVED, QuasiLikelihoodModel, inflation
from diagnosis.search.complete import FEW, by_few_terms
from diagnosis.search.fit import Fit, fit
from diagnosis.search.grow import grow, polished
from diagnosis.search.objective import bounded
from diagnosis.search.problem import Layout, Point, Term
from diagnosis.search.search import Explanation, Outcome, Settings, recalibrate, search, shrink
from diagnosis.search.structure import structure
from diagnosis.search.switches import costs_at
from diagnosis.search.validation import Validated, Validation, chosen

#: What was found is fitted again if it leaves errors whose variance is larger than was assumed by this factor.
FAR = 2.0
#: Models carried forward, best-scored terms refitted and terms at most: with few readings of their own, a wider search.
BEAM, REFITS, MOST_TERMS = 3, 8, 4
#: Derivatives of residuals by parameters from which it is not searched again: many channels tell more, and cost more.
MANY = 1_000_000
#: Rivals of what the first search found that are weighed then.
WEIGHED = 4
#: Rivals that are fitted again with larger errors: further ones neither win nor are as probable as these.
REFITTED = 5
#: Terms that are tried in the place of each term that was found, so that what may be exchanged is known.
EXCHANGED = 4


def search_with_model_error(
    model: DiagnosisModel, settings: Settings, on_progress: Callable[[str], None] = lambda text: None
) -> tuple[Outcome, DiagnosisModel]:
    """Search; where even the model that is found is wrong by more than noise, search again with larger errors.

    One or two generic terms in the place of all that was found may be what is missing (`by_few_terms`). Else the
    readings of a real rig are met far worse than their noise: the likelihood is tempered by what the most general model
    leaves, and terms are chosen by how well they predict stretches of the training that they were not fitted to. Where
    noise is all that is left, nothing of this happens.

    Args:
        model: Model and training recordings.
        settings: Of the search.
        on_progress: Told what is being done.

    Returns:
        The outcome, and the model that it belongs to.
    """
    ones: list[Explanation] = []

    def one_term(base: Fit, margin: float) -> Explanation | None:
        with suppress(TimeIsOver), may_be_left():
            ones.append(_few_terms(model, base, margin, settings, on_progress, most=1))
            return ones[0] if _is_met(model, ones[0]) else None
        return None

    outcome = search(model, model.terms(), settings, model.groups(), on_progress, instead=one_term)
    outcome = replace(outcome, one=ones[0]) if ones else outcome
    factor = pooled(inflation(outcome.best.fit.residuals, model.layout), model.layout)
    if factor.max() <= BELIEVED:
        return _with_fewer_terms(model, outcome, settings, on_progress), model
    try:
        with may_be_left():
            if model.can_be_searched_again:
                outcome = _with_few_terms(model, outcome, settings, on_progress)
                if outcome.best is outcome.few:
                    return outcome, model
            return _searched_again(model, outcome, factor, settings, on_progress)
    except TimeIsOver:  # what was found stands, with errors as large as it leaves
        found = QuasiLikelihoodModel(LawsOnly(model), factor)
        return replace(refitted(found, outcome), first=outcome), found


def _with_fewer_terms(
    model: DiagnosisModel, outcome: Outcome, settings: Settings, on_progress: Callable[[str], None]
) -> Outcome:
    """The outcome, or fewer terms in the place of several, a law without a name among them, where these are more
    probable.

    Each may bend towards a part of one law that the library has not, at other places than where it acts; and so may a
    fault beside a law.
    """
    terms = outcome.best.terms
    is_named = all(t.is_named for t in outcome.best.fit.point.lasting.terms)
    if len(terms) < 2 or is_named or not model.can_be_searched_again:
        return outcome
    with suppress(TimeIsOver), may_be_left():
        other = _with_few_terms(model, outcome, settings, on_progress)
        is_better = len(other.best.terms) < len(terms) and other.best.demerit < outcome.best.demerit
        return other if is_better else replace(outcome, few=other.few)
    return outcome


def _with_few_terms(
    model: DiagnosisModel, outcome: Outcome, settings: Settings, on_progress: Callable[[str], None]
) -> Outcome:
    """The outcome with one or two terms alone, as the best explanation where these leave noise."""
    few = outcome.few or _few_terms(model, outcome.base, outcome.margin, settings, on_progress, outcome.one)
    if not _is_met(model, few):
        return replace(outcome, few=few)
    left = structure(few.fit.residuals, model.layout, model.groups())
    return replace(outcome, best=few, left=left, rivals=tuple(_once((few, *outcome.rivals))), few=few)


def _few_terms(
    model: DiagnosisModel,
    base: Fit,
    margin: float,
    settings: Settings,
    on_progress: Callable[[str], None],
    first: Explanation | None = None,
    most: int = FEW,
) -> Explanation:
    """One or two terms alone that act in all recordings, see `by_few_terms`."""
    return by_few_terms(LawsOnly(model), base, lasting_laws(model), settings, margin, on_progress, first, most)


def _is_met(model: DiagnosisModel, explanation: Explanation) -> bool:
    """Whether an explanation leaves no more than what noise is believed to be."""
    return bool(pooled(inflation(explanation.fit.residuals, model.layout), model.layout).max() <= BELIEVED)


def _searched_again(
    model: DiagnosisModel,
    outcome: Outcome,
    factor: Array,
    settings: Settings,
    on_progress: Callable[[str], None],
) -> tuple[Outcome, DiagnosisModel]:
    """Search once more, by errors as large as a first outcome leaves."""
    on_progress("searching again: no model meets the readings within their noise")
    faults = _earned_faults(QuasiLikelihoodModel(LawsOnly(model), factor), outcome)
    if faults_of(outcome.best.fit.point) and not faults:  # they only bent a wrong model: then laws alone are looked for
        outcome = search(LawsOnly(model), model.terms(), settings, model.groups(), on_progress)
        factor = pooled(inflation(outcome.best.fit.residuals, model.layout), model.layout)
    first, given = outcome, GivenFaults(model, faults)
    outcome, found = laws_that_predict(given, _laws_alone(outcome), model.terms(), settings, on_progress)
    if faults:
        found = QuasiLikelihoodModel(LawsOnly(model), found.inflation)
        outcome = _with_faults(found, outcome, faults)
    return replace(outcome, first=first), found


def laws_that_predict(
    model: DiagnosisModel,
    outcome: Outcome,
    terms: Sequence[Term],
    settings: Settings,
    on_progress: Callable[[str], None] = lambda text: None,
) -> tuple[Outcome, QuasiLikelihoodModel]:
    """Laws by how well they predict stretches of the training, where the model errs by more than noise.

    Args:
        model: Model and training recordings, in which no fault is looked for.
        outcome: Of a search that took noise for all that is left: how large the errors are, and where to begin.
        terms: Laws that may be taken.
        settings: Of the search.
        on_progress: Told what is being done.

    Returns:
        The outcome, and the model with larger errors that it belongs to.
    """
    factor = pooled(inflation(outcome.best.fit.residuals, model.layout), model.layout)
    found = QuasiLikelihoodModel(model, factor)
    if len(model.layout.time) * len(model.parameters) < MANY:
        outcome = _validated(found, terms, settings, on_progress)
    else:
        outcome = _weighed(found, outcome, on_progress)
    raw = bounded(model.residuals([outcome.best.fit.point])[0])
    larger = pooled(inflation(raw, model.layout), model.layout)
    if np.any(larger >= FAR * factor):
        found = QuasiLikelihoodModel(model, np.maximum(factor, larger))
        outcome = refitted(found, outcome)
    return outcome, found


def _earned_faults(model: QuasiLikelihoodModel, outcome: Outcome) -> dict[Term, tuple[float, ...]]:
    """Faults of a first search that are worth their price even where the model errs as it does, with their values."""
    faults = faults_of(outcome.best.fit.point)
    if not faults:
        return {}
    alone = fit(model, Point(recalibrate(model).point.base, faults))
    return faults_of(shrink(model, Explanation(alone), outcome.margin).fit.point)


def _laws_alone(outcome: Outcome) -> Outcome:
    """The outcome with the laws of its explanations as the points that another search may begin at."""

    def laws(one: Explanation) -> Explanation:
        return Explanation(replace(one.fit, point=one.fit.point.lasting))

    return replace(outcome, best=laws(outcome.best), rivals=tuple(laws(e) for e in outcome.rivals))


def _with_faults(whole: QuasiLikelihoodModel, outcome: Outcome, faults: Mapping[Term, tuple[float, ...]]) -> Outcome:
    """Laws and faults fitted together, by a model that looks for neither."""

    def beside(one: Explanation) -> Explanation:
        point = one.fit.point
        return Explanation(fit(whole, Point(point.base, {**point.terms, **faults}), widths=one.fit.widths))

    best = shrink(whole, beside(outcome.best), outcome.margin)
    near = [beside(e) for e in outcome.rivals if len(e.terms) == len(outcome.best.terms)][:WEIGHED]
    return _settled(whole, outcome, recalibrate(whole), best, near)


def refitted(model: QuasiLikelihoodModel, outcome: Outcome) -> Outcome:
    """What was found with larger errors: intervals grow, and terms that are not earned any more go.

    It is not searched again: which laws predict does not hang on the size of the errors, and with larger ones the
    search would stop earlier, leave more, and so on. Of its rivals those are fitted again that come nearest as they
    are.
    """
    base = recalibrate(model)
    best = shrink(model, Explanation(fit(model, outcome.best.fit.point)), outcome.margin)
    rivals = [e for e in outcome.rivals if set(e.terms) != set(best.terms) and len(e.terms) == len(best.terms)]
    points = [e.fit.point for e in rivals]
    order = np.argsort(costs_at(model, base, points), kind="stable")
    near = [Explanation(fit(model, points[n])) for n in order[:REFITTED].tolist()]
    return _settled(model, outcome, base, best, near)


def _validated(
    model: QuasiLikelihoodModel, terms: Sequence[Term], settings: Settings, on_progress: Callable[[str], None]
) -> Outcome:
    """Search plain laws, and all where none of them predicts better; take what predicts best."""
    wide = replace(settings, beam=BEAM, refits=REFITS, most_terms=MOST_TERMS, stops_at_noise=False)
    known: list[Validated] = []
    outcomes = []
    every = distinct(model, [t for t in terms if not t.is_completing])
    plain = plain_terms(model, every)
    for some in (plain, every) if len(plain) < len(every) else (every,):
        validation = Validation(model, partial(MaskedModel, model), on_progress)
        outcomes.append(search(model, some, wide, model.groups(), on_progress, validation.select))
        known += validation.all
        if known and chosen(known, set(plain), outcomes[-1].margin).explanation.terms:
            break  # a law explains it; what else there is would only fill gaps
    outcome = outcomes[-1]
    if not known:
        return outcome
    best = chosen(known, set(plain), outcome.margin)
    explanation = shrink(model, best.explanation, outcome.margin)
    near = [f.explanation for f in known if len(f.explanation.terms) == len(explanation.terms)]
    on_progress("trying others in the place of what was found")
    near += _exchanged(model, explanation, plain, wide, outcome.margin)
    return _settled(model, outcome, outcome.base, explanation, near)


def _weighed(model: QuasiLikelihoodModel, first: Outcome, on_progress: Callable[[str], None]) -> Outcome:
    """Of what the first search found, the part that predicts: its terms and every choice of them, and its rivals."""
    margin = first.margin
    terms = first.best.terms
    points = [
        reduce(Point.without, [t for t in terms if t not in kept], first.best.fit.point)
        for count in range(1, len(terms) + 1)
        for kept in itertools.combinations(terms, count)
    ]
    points += [e.fit.point for e in first.rivals if set(e.terms) != set(terms)][:WEIGHED]
    base = recalibrate(model)
    again = counted(points, "explanations fitted again")
    fitted = [Explanation(base), *(Explanation(fit(model, p, widths=base.widths)) for p in again)]
    validation = Validation(model, partial(MaskedModel, model))
    known = []
    on_progress("validating explanations by stretches of time that they were not fitted to")
    for explanation in counted(fitted, "explanations validated"):
        known.append(validation.validated(explanation))
    plain = plain_terms(model, [t for e in fitted for t in e.terms])
    best = shrink(model, chosen(known, set(plain), margin).explanation, margin)
    return _settled(model, first, base, best, [e for e in fitted if len(e.terms) == len(best.terms)])


def _settled(
    model: QuasiLikelihoodModel, outcome: Outcome, base: Fit, best: Explanation, near: Sequence[Explanation]
) -> Outcome:
    """The outcome with another base, another best explanation, and its rivals, each once and best first."""
    return replace(
        outcome,
        base=base,
        base_structure=structure(base.residuals, model.layout, model.groups()),
        best=best,
        left=structure(best.fit.residuals, model.layout, model.groups()),
        rivals=tuple(_once(sorted([best, *near], key=lambda e: e.fit.cost))),
    )


def _exchanged(
    model: QuasiLikelihoodModel, found: Explanation, terms: Sequence[Term], settings: Settings, margin: float
) -> list[Explanation]:
    """Explanations with another term in the place of one of several; the search did not meet them all on its way."""
    others: list[Explanation] = []
    for term in counted(found.terms if len(found.terms) > 1 else (), "effects exchanged"):
        without = Explanation(fit(model, found.fit.point.without(term), near=found.fit))
        grown, _ = grow(model, [t for t in terms if t != term], [without], settings, margin)
        others += polished(model, grown, without.demerit, margin)[:EXCHANGED]
    return others


def distinct(model: DiagnosisModel, terms: Sequence[Term]) -> list[Term]:
    """Terms without those that are others by another name: of one coil alone, `all coils` is `coil[1]`."""
    found: dict[tuple[object, ...], Term] = {}
    for term in terms:
        spot = model.where(term)[1]
        key = (term.identifier, spot.label if spot.mask is None else np.asarray(spot.mask).tobytes(), spot.day)
        found.setdefault(key, term)
    return list(found.values())


def plain_terms(model: DiagnosisModel, terms: Sequence[Term]) -> list[Term]:
    """Laws with a name that hold at any time, and faults of sensors that a recording itself says may be there.

    Where much is left unexplained, an event at some instant, what belongs to one day (a drift), a term without a name
    or a sensor under suspicion without a reason fills any gap; none of them says anything about another recording.
    """
    channels = [s.channel for run in model.runs for s in run.series]
    stated = {
        "sensor_lag": any(c.lag_bound > 0 for c in channels),
        "sensor_clock_offset": any(c.offset_bound > 0 for c in channels),
        "sensor_bias": any(c.bias_bound > 0 for c in channels),
    }
    return [
        t
        for t in terms
        if t.is_named
        and not any(p.is_instant for p in t.parameters)
        and not model.where(t)[0].is_of_a_day
        and (t.unit != "measurement" or stated.get(t.identifier, False))
    ]


def _once(explanations: Sequence[Explanation]) -> list[Explanation]:
    """Explanations with different terms, the first of each."""
    found: dict[frozenset[Term], Explanation] = {}
    for explanation in explanations:
        found.setdefault(frozenset(explanation.terms), explanation)
    return list(found.values())


def pooled(found: Array, layout: Layout) -> Array:
    """One inflation for all channels of a quantity (geometric mean): a model errs in all of them alike."""
    kinds = [name.split(" (")[0].rsplit(".", 1)[-1] for name in layout.names]
    means = {k: np.exp(np.mean([np.log(v) for v, other in zip(found, kinds) if other == k])) for k in kinds}
    return np.array([means[k] for k in kinds])
