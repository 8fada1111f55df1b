"""A sum of generic terms for what neither laws with a name nor a few generic ones explain.

Where the best explanation leaves more than noise, the missing law has a shape that the library has not. One of a
systematic basis after the other (`diagnosis.candidates.unnamed_completing`, and the generic laws) is added where it
gains most with all others fitted again, and those that are not needed are taken away at the end: forwards and backwards
as in J. H. Friedman, Annals of Statistics 19 (1991) 1-67, with the running model in the place of a table of data.
Readings that it was not fitted to judge each of them (`diagnosis.judge.acceptance`), as they judge every other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from cosim.compute.steps import counted
from diagnosis.search.explanation import Explanation, Settings
from diagnosis.search.fit import Fit, fit
from diagnosis.search.focus import focus
from diagnosis.search.grow import HOPEFUL, PLACES, STEPS, fitted_with
from diagnosis.search.problem import Model, Term
from diagnosis.search.score import Projection, Score, score
from diagnosis.search.search import shrink

#: Terms that are added at most, where a simulation takes milliseconds and where it takes longer, and best-scored ones
#: that are fitted for each.
MOST, MOST_SLOW, TRIED = 8, 4, 3
#: Terms that stay in the queue, those that promised most before (J. H. Friedman, Fast MARS, Stanford University,
#: Department of Statistics, Technical Report 110, 1993, section 3).
QUEUED = 80
#: Terms in the place of all laws, as a shape that no law has rises and falls; best-scored ones that are begun for each,
#: what a straight line promises of knots far from where they belong says little; and how many of these are fitted to
#: the end: a knot begins far from its place, and arrives late.
FEW, FITTED, FINISHED = 2, 16, 8


@dataclass(frozen=True)
class Breadth:
    """How widely terms are looked for.

    Args:
        most: Terms that are added at most.
        tried: Best-scored ones that are begun for each.
        finished: How many of these are fitted to the end before one is taken; with several, each is begun from both of
            its best shapes.
    """

    most: int
    tried: int
    finished: int = 1


def by_few_terms(
    model: Model,
    base: Fit,
    terms: Sequence[Term],
    settings: Settings,
    margin: float,
    on_progress: Callable[[str], None] = lambda text: None,
    first: Explanation | None = None,
    most: int = FEW,
) -> Explanation:
    """One or two terms, generic ones among them, in the place of all laws that were found.

    Laws that bend towards a missing one hide it: what they leave has not its shape any more.

    Args:
        model: Model and training recordings.
        base: The recalibrated model.
        terms: Laws that hold in all recordings.
        settings: Of the search.
        margin: Gain that a term must exceed.
        on_progress: Told what is being done.
        first: What it goes on from, where one term was tried already.
        most: Terms at most.
    """
    pool = _at_places(model, base, terms, terms, settings)
    said = _told(on_progress, "trying one or two terms alone")
    begun = first or Explanation(base)
    breadth = Breadth(most - len(begun.terms), FITTED, FINISHED)
    return shrink(model, _with_more(model, begun, pool, settings, margin, said, breadth), margin)


def completed(
    model: Model,
    explanation: Explanation,
    terms: Sequence[Term],
    settings: Settings,
    margin: float,
    on_progress: Callable[[str], None] = lambda text: None,
    most: int = MOST,
) -> Explanation:
    """The explanation with generic terms beside it, as many as gain the margin each.

    Args:
        model: Model and training recordings.
        explanation: Best so far; it leaves more than noise.
        terms: Generic ones are added; the others single out places.
        settings: Of the search.
        margin: Gain that a term must exceed.
        on_progress: Told what is being done.
        most: Terms that are added at most.
    """
    generic = [t for t in terms if not t.is_named]
    pool = _at_places(model, explanation.fit, terms, generic, settings) if generic else []
    said = _told(on_progress, "describing what is left by generic terms")
    return _with_more(model, explanation, pool, settings, margin, said, Breadth(most, TRIED))


def _with_more(
    model: Model,
    explanation: Explanation,
    pool: Sequence[Term],
    settings: Settings,
    margin: float,
    on_progress: Callable[[int], None],
    breadth: Breadth,
) -> Explanation:
    """The explanation with terms of a pool, forwards."""
    current = explanation
    for number in range(breadth.most if pool else 0):
        on_progress(number)
        ranked = _scored(model, current.fit, pool, settings)
        pool = [s.term for s in ranked[:QUEUED]]
        hopeful = [s for s in ranked if s.gain > HOPEFUL * margin][: breadth.tried]
        trials = [_begun(model, current.fit, s, breadth) for s in counted(hopeful, "generic terms fitted")]
        if not trials:
            break
        best = sorted(trials, key=lambda f: f.cost)[: breadth.finished]
        grown = min((Explanation(fit(model, f.point, STEPS, f)) for f in best), key=lambda e: e.demerit)
        if current.cost - grown.cost <= margin or grown.is_negligible:
            break
        current = grown
    return Explanation(fit(model, current.fit.point, widths=explanation.fit.widths))


def _begun(model: Model, before: Fit, candidate: Score, breadth: Breadth) -> Fit:
    """Some steps of a fit with a term more, from the best of its shapes, and from the second best if it is asked."""
    first = fitted_with(model, before, candidate)
    if candidate.second is None or breadth.finished == 1:
        return first
    second = fitted_with(model, before, replace(candidate, values=candidate.second, second=None))
    return min(first, second, key=lambda f: f.cost)


def _told(on_progress: Callable[[str], None], what: str) -> Callable[[int], None]:
    """Tells the stage and which term it is at, counted from 1."""
    return lambda number: on_progress(f"{what}: {number + 1}")


def _scored(model: Model, base: Fit, terms: Sequence[Term], settings: Settings) -> list[Score]:
    """Scores, best first, without nulls: what chance gives is far below what is left."""
    projection = Projection(base)
    projection.noise(0, settings.seed)
    return score(model, base, terms, projection=projection).ranked


def _at_places(model: Model, base: Fit, terms: Sequence[Term], added: Sequence[Term], settings: Settings) -> list[Term]:
    """Terms that may be added at the places at which something scores best, and at those that hold all elements.

    A law that completes singles out a place too where its strength is its only number, which costs one simulation: what
    is missing may have no shape but its own, and laws of other shapes at its place score less than some elsewhere.
    """
    near = [t for t in focus(model, base.residuals, terms) if not t.is_completing or len(t.parameters) == 1]
    ranked = _scored(model, base, near, settings)
    places = list(dict.fromkeys(s.term.place for s in ranked[:40]))[:PLACES]
    places += [t.place for t in base.point.terms]
    return [t for t in added if t.place in places or t.place.startswith("all ")]
