"""The search: forwards with a beam, all refitted together, then backwards."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from cosim.unit import Array
from diagnosis.search.fit import Fit, cost, fit, fit_best
from diagnosis.search.focus import focus, unnamed_at
from diagnosis.search.problem import Model, Parameter, Point, Term
from diagnosis.search.score import Score, Scoring, score
from diagnosis.search.structure import Structure, structure

#: A term is refitted if the straight line promises this share of the margin (some strengths are far from straight).
HOPEFUL = 0.4
#: Prior deviations beyond which a recalibration has been pulled away by what is missing, and fits start afresh too.
STRAINED = 4.0
#: -2 log of the prior odds of a generic law against one of the catalogue: they are many, and any of them may bend well.
UNNAMED = 6.0
#: Explanations within this of the best are fitted to the end, and at most so many.
CLOSE, MOST_POLISHED = 12.0, 5
#: ... or within this share of what was gained, for the first fits are rough.
ROUGH = 0.03
#: Pairs of elements from which their scatter is told, and how many stated deviations it may grow to.
FEWEST, WIDEST = 6, 2.5
#: A term is not refitted any more once another gained so many times what its straight line promises (straight lines
#: promise too little where residuals are large and count linearly: by as much as they did before).
OUTDONE = 1.6
#: Instants from which a fit may begin.
INSTANTS = 40
#: Nulls that say what chance gives to the best of all terms.
DRAWS = 96
#: Most steps of a fit in the competition.
TRIAL = 15
#: Places at which unnamed terms are tried too.
PLACES = 4


@dataclass(frozen=True)
class Settings:
    """What the search may spend and what it must be shown.

    Args:
        level: Rate of false alarms that is allowed.
        floor: Least gain, whatever chance would give: every real rig has many tiny effects.
        beam: Models that are carried forward.
        refits: Best-scored terms that are refitted per model.
        most_terms: Terms that a model may have.
        seed: Of all random numbers.
    """

    level: float = 0.05
    floor: float = 20.0
    beam: int = 2
    refits: int = 6
    most_terms: int = 3
    seed: int = 0


@dataclass(frozen=True)
class Explanation:
    """A model with terms that were fitted.

    Args:
        fit: Converged fit of everything together.
        gains: Fall of -2 log posterior by each term, all others kept.
    """

    fit: Fit
    gains: Mapping[Term, float] = field(default_factory=dict)

    @property
    def terms(self) -> tuple[Term, ...]:
        """Its terms."""
        return tuple(self.fit.point.terms)

    @property
    def cost(self) -> float:
        """-2 log posterior of the fit, and what the odds are against laws without a name before any data."""
        return self.fit.cost + UNNAMED * sum(not t.is_named for t in self.terms)

    @property
    def demerit(self) -> float:
        """What explanations are compared by: a free shape must pay for itself too (Laplace's approximation)."""
        extra = sum(len(t.parameters) - 1 for t in self.terms)
        return self.cost + extra * float(np.log(max(len(self.fit.residuals), 2)))


@dataclass(frozen=True)
class Outcome:
    """What a search found.

    Args:
        base: Recalibrated model without terms.
        base_structure: What is left without terms.
        best: The accepted explanation; without terms where none was earned.
        left: What is left with it.
        rivals: Other explanations with as many terms, best first (the accepted one is among them); where none was
            earned, the model without terms and those that came nearest.
        margin: Gain that a term had to exceed.
        false_alarm_rate: Probability that chance alone gives the first accepted term its gain; 1 without one.
        tried: Choices of terms and shapes that were simulated.
    """

    base: Fit
    base_structure: Structure
    best: Explanation
    left: Structure
    rivals: tuple[Explanation, ...]
    margin: float
    false_alarm_rate: float
    tried: int


OnProgress = Callable[[str], None]
#: From the explanation before and those with one term more, best fit first, to those worth going on with.
Select = Callable[[Explanation, Sequence[Explanation]], Sequence[Explanation]]


def best_fits(before: Explanation, grown: Sequence[Explanation]) -> Sequence[Explanation]:
    """All of them, best fit first: right where noise is all that a right model leaves."""
    return grown


def recalibrate(model: Model) -> Fit:
    """Fit what the model already has, within its priors, to the end: an unconverged base makes false gains."""
    found = fit(model, Point(np.zeros(len(model.parameters))), iterations=200)
    widths = spread(model.parameters, found.point.base)
    return fit(model, found.point, iterations=200, widths=widths)


def spread(parameters: Sequence[Parameter], base: Array) -> Array:
    """Widths of the priors: those of many elements of a kind grow where most of them lie farther than was stated.

    The median of the differences between elements of one string tells, so that neither one faulty element does nor a
    whole string (empirical Bayes; Efron, Large-Scale Inference, Cambridge 2010, chapter 1).
    """
    widths = np.ones(len(base))
    kinds: dict[str, dict[str, list[int]]] = {}
    for i, parameter in enumerate(parameters):
        if "]." in parameter.name:
            element, kind = parameter.name.split("].", 1)
            kinds.setdefault(kind, {}).setdefault(element.split(",")[0], []).append(i)
    for strings in kinds.values():
        members = [i for string in strings.values() for i in string]
        apart = [base[a] - base[b] for string in strings.values() for a, b in itertools.combinations(string, 2)]
        if len(apart) >= FEWEST:
            typical = float(np.median(np.abs(apart))) / (0.6745 * np.sqrt(2.0))  # the median of |z| is 0.6745
            widths[members] = float(np.clip(typical, 1.0, WIDEST))
    return widths


def search(
    model: Model, terms: Sequence[Term], settings: Settings, groups: Mapping[str, Array] | None = None,
    on_progress: OnProgress = lambda text: None, select: Select = best_fits,
) -> Outcome:  # fmt: skip
    """Find the terms that a model lacks.

    Args:
        model: Model and training recordings.
        terms: Catalogue and unnamed terms at all their places.
        settings: See there.
        groups: Groups of channels for the search for structure.
        on_progress: Told what is being done.
        select: Chooses what goes on.
    """
    on_progress("recalibrating")
    base = recalibrate(model)
    left = structure(base.residuals, model.layout, groups)
    current = [Explanation(base)]
    best = current[0]
    rivals: tuple[Explanation, ...] = (best,)
    margin, rate, tried = settings.floor, 1.0, 0
    for level in range(settings.most_terms):
        on_progress(f"looking for effect {level + 1}")
        is_done = structure(current[0].fit.residuals, model.layout, groups).is_noise
        grown, scoring = _grow(model, terms, current[:1] if is_done else current, settings, margin)
        tried += scoring.tried
        if level == 0:
            margin = max(settings.floor, scoring.margin(settings.level))
        if not grown or current[0].cost - grown[0].cost <= margin:
            if level == 0:  # not earned, but an experiment may decide about them
                rivals = (best, *grown)
            break
        if level == 0:
            rate = scoring.false_alarm_rate(base.cost - grown[0].fit.cost)
        grown = list(select(current[0], grown))
        if not grown:
            break
        current = grown[: settings.beam]
        best, rivals = current[0], tuple(grown)
        if structure(best.fit.residuals, model.layout, groups).is_noise and level + 1 >= settings.most_terms - 1:
            break
    on_progress("removing what is not needed")
    best = shrink(model, best, margin)
    after = structure(best.fit.residuals, model.layout, groups)
    return Outcome(base, left, best, after, rivals, margin, rate, tried)


def _grow(
    model: Model, terms: Sequence[Term], current: Sequence[Explanation], settings: Settings, margin: float
) -> tuple[list[Explanation], Scoring]:
    """Explanations with one term more, best first, and the scoring of the first model."""
    grown: dict[frozenset[Term], Explanation] = {}
    scorings = []
    for explanation in current:
        scoring = _scored(model, explanation.fit, terms, settings, DRAWS if not explanation.terms else 0)
        scorings.append(scoring)
        hopeful = [s for s in scoring.ranked if s.gain > HOPEFUL * margin]
        most, kept = 0.0, 1.0
        for candidate in _choice(hopeful, settings.refits):
            key = frozenset((*explanation.terms, candidate.term))
            if key not in grown and candidate.gain * kept * OUTDONE > most:
                grown[key] = Explanation(_refit(model, explanation.fit, candidate))
                gained = explanation.fit.cost - grown[key].fit.cost
                most, kept = max(most, gained), max(kept, gained / candidate.gain)
    return _polished(model, sorted(grown.values(), key=lambda e: e.demerit), current[0].demerit), scorings[0]


def _polished(model: Model, grown: list[Explanation], before: float) -> list[Explanation]:
    """The same with those fitted to the end that may be the best: refits of many rest on derivatives made nearby."""
    gained = before - grown[0].demerit if grown else 0.0
    near = [e for e in grown if e.demerit < grown[0].demerit + max(CLOSE, ROUGH * gained)][:MOST_POLISHED]
    done = [Explanation(fit(model, e.fit.point, widths=e.fit.widths)) for e in near]
    return sorted([*done, *grown[len(near) :]], key=lambda e: e.demerit)


def _scored(model: Model, base: Fit, terms: Sequence[Term], settings: Settings, draws: int) -> Scoring:
    """Scores of all terms worth trying: unnamed ones at single elements where a named one scores well."""
    near = focus(model, base.residuals, terms)
    first = score(model, base, near, draws, settings.seed)
    places = list(dict.fromkeys(s.term.place for s in first.ranked[:40]))[:PLACES]
    more = unnamed_at(terms, places, near)
    return first.joined(score(model, base, more, draws, settings.seed)) if more else first


def _choice(ranked: Sequence[Score], count: int) -> list[Score]:
    """The best scores, and the best of other effects that come near them: places compete, and so do effects.

    Of the many generic laws only the best few of each unit are among the others.
    """
    chosen: list[Score] = []
    generic = count if ranked and not ranked[0].term.is_named else count // 2
    for candidate in ranked[:count]:
        generic -= not candidate.term.is_named
        chosen += [candidate] if candidate.term.is_named or generic >= 0 else []
    others = {True: 0, False: 0}
    for candidate in ranked[count : 12 * count]:
        is_new = all(c.term.identifier != candidate.term.identifier for c in chosen)
        if candidate.gain > 0.3 * ranked[0].gain and is_new and others[candidate.term.is_named] < count:
            others[candidate.term.is_named] += 1
            chosen.append(candidate)
    return chosen


def _refit(model: Model, before: Fit, candidate: Score) -> Fit:
    """Fit all again with a term more, from what the straight line says and from the best of other starts."""
    here = before.point.plus(candidate.term, candidate.values)
    points = list(_starts(before, candidate))
    if not points:
        return fit(model, here, TRIAL, before)
    values = model.residuals([here, *points])
    costs = [
        cost(v, p.base, before.widths) if np.isfinite(v).all() else np.inf for v, p in zip(values, [here, *points])
    ]
    other = int(np.argmin(costs[1:]))
    if costs[1 + other] > costs[0] and not candidate.term.parameters[0].is_switch:
        return fit(model, here, TRIAL, before)
    return fit_best(model, [here, points[other]], TRIAL, before)


def _starts(before: Fit, candidate: Score) -> Iterator[Point]:
    """Where else a fit may begin: other instants and switches, and the nominal point where the base is strained."""
    term, (strength, *shape) = candidate.term, candidate.values
    first, *others = term.parameters
    sizes = (first.upper,) if first.is_switch else (strength, *first.starts[:3])
    if first.is_switch or any(p.is_instant for p in others):
        for i, parameter in enumerate(others):
            span = np.linspace(parameter.lower, parameter.upper, INSTANTS + 2)[1:-1] if parameter.is_instant else ()
            for value in (*parameter.starts, *(float(v) for v in span)):
                for size in sizes:
                    yield before.point.plus(term, (size, *shape[:i], value, *shape[i + 1 :]))
        if not others:
            yield before.point.plus(term, (sizes[0],))
    if np.max(np.abs(before.point.base / before.widths), initial=0.0) > STRAINED:
        nominal = Point(np.zeros_like(before.point.base), before.point.terms)
        for size in sizes:
            yield nominal.plus(term, (size, *shape))


def shrink(model: Model, explanation: Explanation, margin: float) -> Explanation:
    """Take away terms whose absence costs less than the margin, the least needed first."""
    while True:
        without = {t: fit(model, explanation.fit.point.without(t), near=explanation.fit) for t in explanation.terms}
        gains = {t: f.cost - explanation.fit.cost for t, f in without.items()}
        if not gains or min(gains.values()) > margin:
            return replace(explanation, gains=gains)
        point = without[min(gains, key=lambda t: gains[t])].point
        explanation = Explanation(fit(model, point, widths=explanation.fit.widths))
