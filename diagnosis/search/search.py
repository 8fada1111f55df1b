"""The search: forwards with a beam, all refitted together, then backwards."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.compute.steps import TimeIsOver, counted, may_be_left
from cosim.unit.protocol import Array
from diagnosis.search.explanation import Explanation as Explanation
from diagnosis.search.explanation import Settings as Settings
from diagnosis.search.fit import Fit, fit
from diagnosis.search.grow import grow, pairs, polished
from diagnosis.search.nulls import calibrated
from diagnosis.search.posterior import costs_of_readings
from diagnosis.search.problem import Model, Parameter, Point, Term
from diagnosis.search.score import Score, Scoring
from diagnosis.search.structure import Structure, deviation_of, structure

#: Pairs of elements from which their scatter is estimated, and how many stated deviations it may grow to.
FEWEST, WIDEST = 6, 2.5
#: Stated deviations beyond which a clock or a lag may be a wrong minimum.
LATE = 1.5
#: Faults with begin and end that a model may have beside its laws.
MOST_FAULTS = 3
#: Share of what noise does not explain that the last effect took away at least, where faults of a day make room for
#: more. Where it took less it is not what is missing: many more would have to follow.
LEAST_SHARE = 0.1
#: Share of the best's gain from which the best of names alone is gone on from too.
NAMED = 0.8
#: Readings that do not count for a term: a wild one may have another beside it.
FEW = 2


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
        nulls: Recordings without any effect that the search was run on.
        first: What was found before the errors of the model were taken into account, where that is another outcome.
        few: One or two terms alone, where they were tried (`diagnosis.search.complete.by_few_terms`).
        one: The same of one term, where that was tried before.
    """

    base: Fit
    base_structure: Structure
    best: Explanation
    left: Structure
    rivals: tuple[Explanation, ...]
    margin: float
    false_alarm_rate: float
    tried: int
    nulls: int = 0
    first: Outcome | None = None
    few: Explanation | None = None
    one: Explanation | None = None


OnProgress = Callable[[str], None]
#: From the explanation before and those with one term more, best fit first, to those worth going on with.
Select = Callable[[Explanation, Sequence[Explanation]], Sequence[Explanation]]
#: From the recalibrated model and the margin to what takes the place of the terms that were found, if anything does.
Instead = Callable[[Fit, float], Explanation | None]


def best_fits(before: Explanation, grown: Sequence[Explanation]) -> Sequence[Explanation]:
    """All of them, best fit first: right where noise is all that a right model leaves."""
    return grown


def recalibrate(model: Model) -> Fit:
    """Fit what the model already has, within its priors, to the end: an unconverged base makes false gains."""
    found: Fit | None = None
    for _ in counted(("with stated widths", "with the widths that were found"), "rounds of the fit"):
        if found is None:
            found = with_clocks_set(model, fit(model, Point(np.zeros(len(model.parameters))), iterations=200))
        else:
            widths = spread(model.parameters, found.point.base)
            found = fit(model, found.point, iterations=200, widths=widths)
    assert found is not None
    return found


def with_clocks_set(model: Model, found: Fit) -> Fit:
    """The better of a fit and of one that begins again with clocks and lags as stated.

    A few readings near a switch can be explained twice: by a sensor that is slow, or by one that is early and slower
    still. While everything else is off the fit may run into the wrong one, and no step leads out of it.

    Args:
        model: Model and training recordings.
        found: Fit without terms.
    """
    clocks = np.array([p.is_clock for p in model.parameters], dtype=bool)
    if not np.any(np.abs(found.point.base[clocks]) > LATE):
        return found
    again = fit(model, Point(np.where(clocks, 0.0, found.point.base)), iterations=200)
    return min(found, again, key=lambda f: f.cost)


def spread(parameters: Sequence[Parameter], base: Array) -> Array:
    """Widths of the priors: those of many elements of a kind grow where most of them lie farther than was stated.

    The median of the differences between elements of one string tells, so that neither one faulty element does nor a
    whole string (empirical Bayes; Efron, Large-Scale Inference, Cambridge 2010, chapter 1).
    """
    widths = np.ones(len(base))
    kinds: dict[str, dict[str, list[int]]] = {}
    for i, parameter in enumerate(parameters):
        if parameter.alike is not None:
            kinds.setdefault(parameter.alike.kind, {}).setdefault(parameter.alike.group, []).append(i)
    for strings in kinds.values():
        members = [i for string in strings.values() for i in string]
        apart = [base[a] - base[b] for string in strings.values() for a, b in itertools.combinations(string, 2)]
        if len(apart) >= FEWEST:
            widths[members] = float(np.clip(deviation_of(np.array(apart)), 1.0, WIDEST))
    return widths


def search(
    model: Model,
    terms: Sequence[Term],
    settings: Settings,
    groups: Mapping[str, Array] | None = None,
    on_progress: OnProgress = lambda text: None,
    select: Select = best_fits,
    instead: Instead | None = None,
) -> Outcome:
    """Find the terms that a model lacks.

    Args:
        model: Model and training recordings.
        terms: Catalogue and unnamed terms at all their places; those that complete are left to `complete`.
        settings: See there.
        groups: Groups of channels for the search for structure.
        on_progress: Told what is being done.
        select: Chooses what goes on.
        instead: Asked once where two terms leave structure: whether one alone explains it.
    """
    laws = [t for t in terms if not t.is_completing]
    on_progress("recalibrating")
    base = recalibrate(model)
    left = structure(base.residuals, model.layout, groups)
    current = [Explanation(base)]
    best = current[0]
    rivals: tuple[Explanation, ...] = (best,)
    named: Explanation | None = None
    margin, rate, tried, nulls = settings.floor, 1.0, 0, 0
    first = Scoring([], 0, np.zeros(0))
    for level in range(settings.most_terms + MOST_FAULTS):
        on_progress(f"looking for {_nth(level)} effect")
        is_done = settings.stops_at_noise and structure(best.fit.residuals, model.layout, groups).is_noise
        ahead = [e for e in current if not is_done or e is best or e is named]
        paired = (base, first.ranked) if level == 1 and not is_done else None
        step = _grown(model, laws, ahead, settings, margin, level, paired)
        if step is None:
            break
        grown, scoring = step
        grown = polished(model, grown, current[0].demerit, margin)
        first = scoring if level == 0 else first
        tried += scoring.tried
        if level == 0 and grown and current[0].cost - grown[0].cost > margin:
            on_progress("searching recordings without effects, for what chance alone gives")
            scoring, nulls = calibrated(model, base, scoring, settings)
        if level == 0:
            margin = max(settings.floor, scoring.margin(settings.level))
        if not grown or current[0].cost - grown[0].cost <= margin or grown[0].is_negligible:
            if level == 0:  # not earned, but an experiment may decide about them
                rivals = (best, *grown)
            break
        if level == 0:
            rate = scoring.false_alarm_rate(base.cost - grown[0].fit.cost - grown[0].price)
        grown = list(select(current[0], grown))
        if not grown:
            break
        share = (current[0].cost - grown[0].cost) / max(current[0].cost - len(model.layout.time), 1.0)
        current, named = _gone_on_from(grown, settings.beam, best.cost)
        best, rivals = current[0], tuple(grown)
        is_left = not structure(best.fit.residuals, model.layout, groups).is_noise
        is_enough = _is_enough(best, level + 1, is_left, share, settings)
        is_asked = level == 1 and is_left and not is_enough
        other = instead(base, margin) if instead and is_asked else None
        best, rivals = (best, rivals) if other is None else (other, (other, *rivals))
        if is_enough or other is not None:
            break
    on_progress("removing what is not needed")
    best = shrink(model, best, margin)
    after = structure(best.fit.residuals, model.layout, groups)
    return Outcome(base, left, best, after, rivals, margin, rate, tried, nulls)


def _grown(
    model: Model,
    laws: Sequence[Term],
    ahead: Sequence[Explanation],
    settings: Settings,
    margin: float,
    level: int,
    paired: tuple[Fit, Sequence[Score]] | None,
) -> tuple[list[Explanation], Scoring] | None:
    """Explanations with one term more, and the scoring; None if the time is over and something was found before.

    Args:
        model: Model and training recordings.
        laws: Terms that may be taken.
        ahead: Explanations that grow.
        settings: Of the search.
        margin: Gain that a term has to exceed.
        level: How many terms they have.
        paired: The recalibrated model and the scores of its terms, of which pairs are looked at too; None: none are.
    """
    try:
        with may_be_left(level > 0):
            grown, scoring = grow(model, laws, ahead, settings, margin)
            return [*grown, *(pairs(model, paired[0], paired[1], settings, margin) if paired else [])], scoring
    except TimeIsOver:
        return None


def _nth(level: int) -> str:
    """An effect by its number, from 0, in words."""
    words = ("a first", "a second", "a third", "a fourth", "a fifth", "a sixth")
    return words[level] if level < len(words) else f"effect {level + 1}, one more"


def _is_enough(best: Explanation, terms: int, is_left: bool, share: float, settings: Settings) -> bool:
    """Whether no further term is looked for: faults of a day leave as much room for laws as there was without them.

    Args:
        best: The best explanation.
        terms: How many terms it has.
        is_left: Whether it leaves structure.
        share: Of what noise did not explain, what the last term took away.
        settings: Of the search.
    """
    faults = sum(t.recording is not None for t in best.terms) if share >= LEAST_SHARE else 0
    is_done = settings.stops_at_noise and not is_left and terms >= settings.most_terms - 1
    return is_done or terms >= settings.most_terms + faults


def _gone_on_from(
    grown: Sequence[Explanation], beam: int, before: float
) -> tuple[list[Explanation], Explanation | None]:
    """The best few, and the best of names alone where it comes near: two named laws may be what one bends into.

    Args:
        grown: Explanations, best first.
        beam: How many.
        before: -2 log posterior before they grew.

    Returns:
        Both together, and the named one if the best is not named and it comes near.
    """
    kept = list(grown[:beam])
    if all(t.is_named for t in kept[0].terms):
        return kept, None
    named = next((e for e in grown if all(t.is_named for t in e.terms)), None)
    if named is None or before - named.cost < NAMED * (before - kept[0].cost):
        return kept, None
    return [*kept, *([named] if all(e is not named for e in kept) else [])], named


def _of_few(model: Model, without: Fit, fit: Fit) -> float:
    """What the few readings gain that gain most by a term, means of many aside."""
    gains = costs_of_readings(without.residuals) - costs_of_readings(fit.residuals)
    if model.layout.of_many is not None:
        gains = gains[~model.layout.of_many]
    return float(np.sum(np.maximum(np.sort(gains)[-FEW:], 0.0)))


def shrink(model: Model, explanation: Explanation, margin: float) -> Explanation:
    """Take away terms whose absence costs less than the margin, the least needed first.

    The `FEW` readings that a term explains best do not count, means of many aside: what acts on no more of them follows
    wild readings, which Huber's function makes small and not nothing.
    """
    while True:
        without = {
            t: fit(model, explanation.fit.point.without(t), near=explanation.fit)
            for t in counted(explanation.terms, "effects left out in turn")
        }
        gains = {t: f.cost - explanation.fit.cost for t, f in without.items()}
        worth = {t: gain - t.price - _of_few(model, without[t], explanation.fit) for t, gain in gains.items()}
        if not worth or min(worth.values()) > margin:
            return replace(explanation, gains=gains, without=without)
        point = without[min(worth, key=lambda t: worth[t])].point
        explanation = Explanation(fit(model, point, widths=explanation.fit.widths))
