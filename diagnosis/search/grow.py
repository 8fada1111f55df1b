"""Explanations with one term more, or with two at once."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from cosim.compute.steps import counted
from cosim.unit.protocol import Array
from diagnosis.search.explanation import Explanation, Settings
from diagnosis.search.fit import Fit, fit, fit_best
from diagnosis.search.focus import focus, unnamed_at
from diagnosis.search.problem import Model, Point, Term, TermParameter, has_ridges, strength_slopes
from diagnosis.search.ridge import along_ridge
from diagnosis.search.score import SHARE, Projection, Score, Scoring, score
from diagnosis.search.structure import structure
from diagnosis.search.switches import costs_at, costs_of, is_strained, nominal_of, switch_scores

#: A term is refitted if the straight line promises this share of the margin (some strengths are far from straight).
HOPEFUL = 0.4
#: Explanations within this of the best are fitted to the end, and at most so many.
CLOSE, MOST_POLISHED = 12.0, 5
#: ... or within this share of what was gained, for the first fits are rough.
ROUGH = 0.03
#: A term is not refitted any more once another gained so many times what its straight line promises (straight lines
#: promise too little where residuals are large and count linearly: by as much as they did before).
OUTDONE = 1.6
#: Equations of which a generic law is fitted all the same where what is best leaves structure.
EQUATIONS = 3
#: Combinations of the first values of a law that is tried whatever the straight line says of it.
STARTS, TRIED_STARTS = 96, 2
#: Share of the sum of squares of all residuals by which a law changes them that does something.
FELT = 0.01
#: Instants from which a fit may begin where the model does not say which.
INSTANTS = 40
#: How far from where a fit ended its instants are tried [s].
LATE = (-3.0, -2.0, -1.4, -1.0, -0.7, -0.5, -0.3, -0.2, -0.1, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0)
#: Faults with begin and end that are fitted beside the laws, the best scores first, and how often an interval moves.
FAULTS, MOVED_INTERVALS = 3, 4
#: Fall of -2 log posterior for which an interval is moved: less than that no reading shows.
WORTH = 1.0
#: Nulls that say what chance gives to the best of all terms.
DRAWS = 96
#: Most steps of a trial, whose derivatives by the model's own parameters are those at hand, and of what goes on.
TRIAL, STEPS = 8, 15
#: Trials that fall short of the best by less than this share of its gain go on (of 150, one in twenty gained more than
#: 6 % by that), and more so laws of the catalogue at the place of the best score (radiation gained 41 % once).
FAR, FARTHEST = 0.12, 0.4
#: Places at which unnamed terms are tried too.
PLACES = 4
#: Best-scored terms of which pairs are looked at, pairs that are fitted, and cosine beyond which two are one.
PAIRED, PAIRS, ALIKE = 40, 4, 0.995


def grow(
    model: Model, terms: Sequence[Term], current: Sequence[Explanation], settings: Settings, margin: float
) -> tuple[list[Explanation], Scoring]:
    """Explanations with one term more, and the scoring of the first model."""
    grown: dict[frozenset[Term], Explanation] = {}
    scorings = []
    for explanation in current:
        projection = Projection(explanation.fit)
        projection.noise(DRAWS if not explanation.terms else 0, settings.seed)
        scoring = _scored(model, explanation.fit, terms, projection)
        faults = interval_scores(model, explanation.fit, projection)
        scorings.append(scoring.joined(faults))
        hopeful = [s for s in scoring.ranked if s.gain > HOPEFUL * margin]
        tried: dict[frozenset[Term], Fit] = {}
        laws, most, kept = set[frozenset[Term]](), 0.0, 1.0
        left_out: list[Score] = []
        for candidate in counted(_choice(hopeful, settings.refits), "laws fitted"):
            key = frozenset((*explanation.terms, candidate.term))
            is_law = _is_law_at(candidate, hopeful[0])
            if key not in grown and (is_law or candidate.gain * kept * OUTDONE > most):
                tried[key] = fitted_with(model, explanation.fit, candidate)
                laws |= {key} if is_law else set()
                gained = explanation.fit.cost - tried[key].cost
                most, kept = max(most, gained), max(kept, gained / candidate.gain)
            elif key not in grown:
                left_out.append(candidate)
        if settings.stops_at_noise and tried:
            best = min(tried.values(), key=lambda f: f.cost)
            for candidate in _unnamed_equations(left_out, best, model):
                tried[frozenset((*explanation.terms, candidate.term))] = fitted_with(model, explanation.fit, candidate)
        faulty = _with_faults(model, explanation, faults.ranked, margin)
        is_met = any(structure(e.fit.residuals, model.layout).is_noise for e in faulty.values())
        if not explanation.terms and tried and settings.trials and not is_met:
            others = _tried_all_the_same(model, explanation.fit, hopeful, tried, settings.trials)
            tried |= others
            laws |= set(others)
        if tried:  # straight lines may have pointed elsewhere than where the best was found
            (there,) = min(tried, key=lambda k: tried[k].cost) - set(explanation.terms)
            laws |= {k for k in tried for t in k - set(explanation.terms) if t.is_named and t.place == there.place}
        grown |= _continued(model, explanation.fit.cost, tried, laws)
        grown |= faulty
    return list(grown.values()), scorings[0]


def _tried_all_the_same(
    model: Model, before: Fit, ranked: Sequence[Score], tried: Mapping[frozenset[Term], Fit], most: int
) -> dict[frozenset[Term], Fit]:
    """Other laws with a name, each from the best of all its starts; none where a law that was tried leaves noise."""
    best = min(tried.values(), key=lambda f: f.cost)
    if structure(best.residuals, model.layout).is_noise:
        return {}
    known = {t for key in tried for t in key}
    left = [s.term for s in ranked if s.term.is_named and s.term not in known][:most]
    return {
        frozenset({term}): fit_best(model, _best_starts(model, before, term), TRIAL, before)
        for term in counted(left, "other laws with a name fitted")
    }


def _best_starts(model: Model, before: Fit, term: Term) -> list[Point]:
    """The best of every combination of a law's first values, from where the base is and from where it is believed.

    A law that does nothing at its first values has no slope there: such points are left out while there are others.
    """
    every = itertools.islice(itertools.product(*(p.starts for p in term.parameters)), STARTS)
    bases = [before.point, nominal_of(before)] if is_strained(before) else [before.point]
    points = [base.plus(term, values) for values in every for base in bases]
    found = model.residuals([*bases, *points])
    plain, with_it = found[: len(bases)], found[len(bases) :]
    moved = [float(np.sum((r - plain[n % len(bases)]) ** 2)) for n, r in enumerate(with_it)]
    least = FELT * float(before.residuals @ before.residuals)
    cost = costs_of(with_it, before, points)
    order = sorted(range(len(points)), key=lambda n: (not moved[n] > least, cost[n]))
    return [points[n] for n in order[:TRIED_STARTS] if np.isfinite(cost[n])] or [points[0]]


def interval_scores(model: Model, base: Fit, projection: Projection) -> Scoring:
    """Scores of faults with begin and end, where the model knows any; see `diagnosis.faults`."""
    own = getattr(model, "interval_scores", None)
    found = own(base, projection) if own is not None else None
    return found or Scoring([], 0, np.zeros(projection.draws), (None,) * projection.draws)


def _with_faults(
    model: Model, explanation: Explanation, ranked: Sequence[Score], margin: float
) -> dict[frozenset[Term], Explanation]:
    """Explanations with a fault more: they are fitted beside the laws, so that none of those is crowded out."""
    grown = {}
    for candidate in ranked[:FAULTS]:
        if candidate.gain > HOPEFUL * margin:
            start = explanation.fit.point.plus(candidate.term, candidate.values)
            trial = fit(model, start, TRIAL, explanation.fit, refreshes=0)
            found = Explanation(_with_intervals_set(model, fit(model, trial.point, STEPS, trial)))
            if not found.is_negligible:  # smaller than what one reading scatters by
                grown[frozenset(found.terms)] = found
    return grown


def _unnamed_equations(left_out: Sequence[Score], best: Fit, model: Model) -> list[Score]:
    """Of generic laws whose straight line promises less, one of every equation, where the best leaves structure.

    The straight line of a law that bends the response says little: a loop that shifts with the rate promised 240
    where a clock offset gained 569, and gained 1185. Before a name is taken that does not explain all, they are fitted.
    """
    if structure(best.residuals, model.layout).is_noise:
        return []
    found: dict[str, Score] = {}
    for candidate in left_out:
        if not candidate.term.is_named:
            found.setdefault("_".join(candidate.term.identifier.split("_")[:2]), candidate)
    return list(found.values())[:EQUATIONS]


def _continued(
    model: Model, before: float, tried: Mapping[frozenset[Term], Fit], laws: Collection[frozenset[Term]]
) -> dict[frozenset[Term], Explanation]:
    """Trials with the derivatives taken anew where they may still become the best, and the others as they are."""
    grown, best = {}, min((f.cost for f in tried.values()), default=before)
    for key, trial in counted(sorted(tried.items(), key=lambda t: t[1].cost), "fits gone on with"):
        share = FARTHEST if key in laws else FAR
        may_win = before - trial.cost + CLOSE > (1.0 - share) * (before - best)
        grown[key] = Explanation(_settled(model, fit(model, trial.point, STEPS, trial)) if may_win else trial)
        best = min(best, grown[key].fit.cost)
    return grown


def _settled(model: Model, found: Fit) -> Fit:
    """A fit that has gone down the ridges of its laws, where these have any, or tried instants near its own."""
    return along_ridge(model, found) if has_ridges(model) else _with_instants_set(model, found)


def _with_intervals_set(model: Model, found: Fit) -> Fit:
    """The fit, or a better one with the begin or end of a fault some samples elsewhere.

    What else is fitted may have held them: between two samples they have no slope that would move them.
    """
    near = getattr(model, "near_intervals", None)
    for _ in range(MOVED_INTERVALS):
        points = [] if near is None else list(near(found.point))
        costs = costs_at(model, found, points) if points else []
        if not costs or min(costs) >= found.cost - WORTH:
            break
        found = min(found, fit(model, points[int(np.argmin(costs))], STEPS, found), key=lambda f: f.cost)
    return found


def _with_instants_set(model: Model, found: Fit) -> Fit:
    """The fit, or a better one with an instant nearby.

    Readings that a step leaves on its wrong side pull at it with a force that does not grow with their distance
    (Huber), so that others may hold it: a break at 42.0 s was fitted at 42.7 s, where another law passed for it.
    """
    points = list(_other_instants(found.point, _instants_near))
    if not points:
        return found
    costs = costs_at(model, found, points)
    best = int(np.argmin(costs))
    if costs[best] >= found.cost:
        return found
    return min(found, fit(model, points[best], STEPS, found), key=lambda f: f.cost)


def polished(model: Model, grown: Sequence[Explanation], before: float, margin: float) -> list[Explanation]:
    """Best first, and fitted to the end those that may be the best: refits of many rest on derivatives made nearby.

    Where even the best is not earned, the order of the others matters to nobody.
    """
    ranked = sorted(grown, key=lambda e: e.demerit)
    gained = before - ranked[0].demerit if ranked else 0.0
    most = MOST_POLISHED if gained > margin else 1
    near = [e for e in ranked if e.demerit < ranked[0].demerit + max(CLOSE, ROUGH * gained)][:most]
    whole = [_settled(model, fit(model, e.fit.point, widths=e.fit.widths)) for e in counted(near, "best fits finished")]
    done = [Explanation(_with_intervals_set(model, f)) for f in whole]
    return sorted([*done, *ranked[len(near) :]], key=lambda e: e.demerit)


def _scored(model: Model, base: Fit, terms: Sequence[Term], projection: Projection) -> Scoring:
    """Scores of all terms worth trying: unnamed ones at single elements where a named one scores well."""
    near = focus(model, base.residuals, terms)
    first = score(model, base, near, projection=projection)
    places = list(dict.fromkeys(s.term.place for s in first.ranked[:40]))[:PLACES]
    more = unnamed_at(terms, places, near)
    whole = first.joined(score(model, base, more, projection=projection)) if more else first
    switched = switch_scores(model, base, [t for t in terms if t.is_named])
    known = {s.term for s in switched}
    ranked = sorted((*switched, *(s for s in whole.ranked if s.term not in known)), key=lambda s: -s.gain)
    return replace(whole, ranked=ranked)


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
        # A law far from straight promises little; one of the catalogue, at the very place, is tried all the same.
        is_near = candidate.gain > (0.05 if _is_law_at(candidate, ranked[0]) else 0.3) * ranked[0].gain
        if is_near and is_new and others[candidate.term.is_named] < count:
            others[candidate.term.is_named] += 1
            chosen.append(candidate)
    return chosen


def _is_law_at(candidate: Score, best: Score) -> bool:
    """Whether it is a law of the catalogue at the place of the best score."""
    return candidate.term.is_named and candidate.term.place == best.term.place


def fitted_with(model: Model, before: Fit, candidate: Score) -> Fit:
    """Fit all again with a term more, from what the straight line says and from the best of other starts."""
    here = before.point.plus(candidate.term, candidate.values)
    points, starts = list(_starts(before, candidate)), [here]
    if points:
        costs = costs_at(model, before, [here, *points])
        other = int(np.argmin(costs[1:]))
        if costs[1 + other] <= costs[0] or candidate.term.parameters[0].is_switch:
            starts.append(points[other])
    if candidate.second is not None and has_ridges(model):
        starts.append(before.point.plus(candidate.term, candidate.second))
    return fit_best(model, starts, TRIAL, before, refreshes=0)


def _starts(before: Fit, candidate: Score) -> Iterator[Point]:
    """Where else a fit may begin: other instants and switches, and the nominal point where the base is strained."""
    term, (strength, *shape) = candidate.term, candidate.values
    first = term.parameters[0]
    sizes = (first.upper,) if first.is_switch else (strength, *first.starts[:3])
    yield from _other_shapes(before, candidate, sizes)
    if len(first.starts) > 1:  # far from a straight line another size may be the better start
        yield from (before.point.plus(term, (size, *shape)) for size in first.starts)
    for moved in _other_instants(before.point, _instants):  # what came first may have come at a wrong instant
        yield from (moved.plus(term, (size, *shape)) for size in sizes)
    if is_strained(before):
        for size in sizes:
            yield nominal_of(before).plus(term, (size, *shape))


def _instants(parameter: TermParameter, _: float = 0.0) -> list[float]:
    """Instants to try for one [s], wherever it is: those that the model gives, else evenly spread within its bounds."""
    if parameter.scan:
        return list(parameter.scan)
    return [float(v) for v in np.linspace(parameter.lower, parameter.upper, INSTANTS + 2)[1:-1]]


def _instants_near(parameter: TermParameter, now: float) -> list[float]:
    """Instants around one [s], within its bounds."""
    return [now + late for late in LATE if parameter.lower < now + late < parameter.upper]


def _other_instants(point: Point, instants: Callable[[TermParameter, float], Sequence[float]]) -> Iterator[Point]:
    """The same with one of its instants elsewhere: where, a function of it and its value says."""
    for term, values in point.terms.items():
        for i, parameter in enumerate(term.parameters):
            if parameter.is_instant and term.recording is None:  # intervals of faults: `_with_intervals_set`
                for value in instants(parameter, values[i]):
                    yield point.plus(term, (*values[:i], value, *values[i + 1 :]))


def _best_instants(model: Model, base: Fit, point: Point) -> Point:
    """The point, or the best of those with one of its instants elsewhere, one instant after the other."""
    points = [point, *_other_instants(point, _instants)]
    if len(points) == 1:
        return point
    return points[int(np.argmin(costs_at(model, base, points)))]


def _other_shapes(before: Fit, candidate: Score, sizes: Sequence[float]) -> Iterator[Point]:
    term, (_, *shape) = candidate.term, candidate.values
    first, *others = term.parameters
    if not first.is_switch and not any(p.is_instant for p in others):
        return
    for i, parameter in enumerate(others):
        for value in (*parameter.starts, *(_instants(parameter) if parameter.is_instant else ())):
            for size in sizes:
                yield before.point.plus(term, (size, *shape[:i], value, *shape[i + 1 :]))
    if not others:
        yield before.point.plus(term, (sizes[0],))


def pairs(model: Model, base: Fit, ranked: Sequence[Score], settings: Settings, margin: float) -> list[Explanation]:
    """Explanations with two terms that gain together what neither does alone.

    Each of two effects may be hidden behind the other, so that the best single term is neither. The straight lines of
    the best-scored terms and the angles between them tell which pairs are worth a fit.

    Args:
        model: Model and training recordings.
        base: Recalibrated, without terms.
        ranked: Scores without terms.
        settings: Of the search.
        margin: Gain by which two must exceed the best of one.
    """
    lasting = [s for s in ranked if s.term.recording is None]
    chosen: dict[frozenset[Term], Point] = {}
    # Two laws that hold in all recordings are asked for beside faults of single ones, which take up a bit of anything.
    for some in (lasting, ranked):
        chosen |= _pairs_among(model, base, list(some[:PAIRED]), margin)
    return [
        Explanation(fit(model, _best_instants(model, base, point), STEPS, base))
        for point in counted(list(chosen.values()), "pairs of laws fitted")
    ]


def _pairs_among(model: Model, base: Fit, top: Sequence[Score], margin: float) -> dict[frozenset[Term], Point]:
    """Pairs that promise more than the best of these alone, with the points from which to fit them."""
    if len(top) < 2:
        return {}
    tasks = [(s.term, (SHARE * max(abs(v) for v in s.term.parameters[0].starts), *s.values[1:])) for s in top]
    slopes = strength_slopes(model, base.point, base.residuals, tasks)
    gram, along = Projection(base).gram(np.where(np.isfinite(slopes), slopes, 0.0))
    found: list[tuple[float, int, int, Array]] = []
    for i, j in itertools.combinations(range(len(top)), 2):
        own = gram[np.ix_((i, j), (i, j))]
        if np.linalg.det(own) <= (1.0 - ALIKE**2) * own[0, 0] * own[1, 1]:
            continue  # one does what the other does
        amounts = -np.linalg.solve(own, along[[i, j]])
        limits = [top[n].term.parameters[0] for n in (i, j)]
        if all(p.lower <= a <= p.upper for p, a in zip(limits, amounts)):
            found.append((float(amounts @ own @ amounts), i, j, np.asarray(amounts, dtype=np.float64)))
    found.sort(key=lambda pair: -pair[0])
    chosen = {}
    for gain, i, j, amounts in found[:PAIRS]:
        if gain < top[0].gain + HOPEFUL * margin:
            break
        point = base.point
        for n, amount in zip((i, j), amounts):
            point = point.plus(top[n].term, (float(amount), *top[n].values[1:]))
        chosen[frozenset((top[i].term, top[j].term))] = point
    return chosen
