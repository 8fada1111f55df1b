"""The search for what a fabric lacks, with few simulations of Bullet."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.models.fabric.mechanical import MechanicalModel
from diagnosis.models.fabric.scatter import FEWEST, Whitening, calibrated_scatter
from diagnosis.models.fabric.strengths import (
    REFINED,
    best_size,
    better_size,
    fitted_sizes,
    interval_of,
    is_better,
    largest_believed,
    next_sizes,
    widened,
)
from diagnosis.models.fabric.surface import Surface
from diagnosis.search.problem import Point, Term
from diagnosis.search.search import Explanation, Outcome, Settings, recalibrate, search

if TYPE_CHECKING:
    from diagnosis.models.fabric.model import FabricModel

#: Effects that are simulated again, and how far their -2 log posterior may lie behind the best.
HOPEFUL, BEHIND = 4, 40.0
#: Share of the largest gain by which another effect may gain less.
LEAST = 0.5
#: Rows whose links are simulated one by one.
ROWS = 2


@dataclass(frozen=True)
class Effort:
    """How many simulations a search makes for each recording.

    Args:
        ensemble: Random starts at the nominal point, from which scatter is known.
        repeats: Starts of every effect.
        confirmed: Starts at the point found.
        hopeful: Effects that are simulated again where they were fitted.
        others: Starts of the nominal point in the other engine.
        has_links: Whether effects of single links are simulated at once; else those of the links of a row whose own
            effect is hopeful.
    """

    ensemble: int
    repeats: int
    confirmed: int
    hopeful: int = HOPEFUL
    others: int = 4
    has_links: bool = False


#: Greatest effort of a simulation of all recordings (`FabricModel.effort`), with what such a fabric is worth. An effort
#: of 10,000 takes about a second of one core. It stands for the time, so that a result does not depend on the machine.
EFFORTS = (
    (45e3, Effort(8, 3, 6, has_links=True)),
    (110e3, Effort(6, 2, 5, others=3)),
    (float("inf"), Effort(6, 1, 4, others=2)),
)
#: Prior deviations over which the answer to a parameter is simulated. One deviation moves places less than contacts
#: scatter: slopes were scatter then, and a fit could follow them. The answer is straight enough over a few per cent.
STEP = 4.0
#: How much farther from nothing an effect has to be than any member of the ensemble, in mean squares. Of ten effects
#: that do nothing one is farther than all of eight members.
SHOWS = 1.5
#: Bins of two runs that are one run [m and 1/m].
SAME = 1e-12
#: How often hopeful effects are simulated where they were fitted: a spring that is a little too weak does nothing, and
#: straight lines do not know that.
ROUNDS = 3
#: Of these, how many in a second and third round.
AGAIN = 2

OnProgress = Callable[[str], None]


def search_fabric(
    model: FabricModel,
    settings: Settings,
    on_progress: OnProgress = lambda text: None,
    effort: Effort | None = None,
) -> Outcome:
    """Find what a model of a fabric lacks.

    1. Circuit and coils are recalibrated by the coil network. 2. Random starts tell the contacts' scatter.
    3. Every mechanical parameter and effect is simulated once or twice. 4. The whole search runs on every member of
    the ensemble as a null: its largest gain is the least that counts. 5. The search itself, on what was simulated: for
    one effect first, then for more beside it, since contacts of a fabric with an effect scatter by another amount than
    those of one without. Hopeful effects are simulated where they were fitted, and the best explanation from several
    starts. 6. What was found is simulated at other strengths: between which it meets the recordings as well.

    Args:
        model: Model and training recordings; its mechanical part is made here.
        settings: Of the search.
        on_progress: Told what is being done.
        effort: How many simulations are made; default: by `EFFORTS`.

    Raises:
        InputError: Bullet cannot simulate the scenario.
    """
    effort = effort or next(own for most, own in EFFORTS if model.effort <= most)
    plan = _Plan(model, settings, effort, on_progress)
    plan.anchor()
    plan.answers()
    margin = plan.margin()
    own = replace(settings, floor=max(settings.floor, margin))
    one = replace(own, most_terms=min(own.most_terms, 1))
    outcome = plan.search(one)
    if plan.narrow(outcome):
        outcome = plan.search(one)
    outcome = plan.settled(outcome, one)
    if outcome.best.terms:
        outcome = plan.at_other_strengths(outcome, one)
    if outcome.best.terms:
        more = replace(own, floor=max(own.floor, plan.margin_beside()))
        outcome = plan.settled(plan.search(more), more)
        plan.bound_strengths(outcome)
    model.take_scatter(model.scatter())
    return outcome


class _Plan:
    """Steps of a search, in order."""

    def __init__(self, model: FabricModel, settings: Settings, effort: Effort, on_progress: OnProgress) -> None:
        self.model, self.settings, self._tell = model, settings, on_progress
        self._count = len(model.mechanical_recordings)
        self._network_point = Point(np.zeros(model.first_own))
        self._size, self._repeats, self._confirmed = effort.ensemble, effort.repeats, effort.confirmed
        self._hopeful, self._asked_elsewhere = effort.hopeful, effort.others
        self._has_links = effort.has_links
        self._first = [t for t in model.laws() if effort.has_links or self._is_wide(t)]
        self._sharpened = self._confirmed if self._repeats > 1 else 1
        effects = self._repeats * len(model.free) + sum(
            self._starts(t) * len(t.parameters[0].starts) for t in self._first
        )
        self._left = self._count * (
            self._size + effort.others + effects + self._hopeful * self._sharpened + self._confirmed
        )

    def _starts(self, term: Term) -> int:
        """From how many starts an effect is simulated at first; there are many of single links and rows."""
        return 1 if term in self.model.link_places else self._repeats

    def _is_wide(self, term: Term) -> bool:
        """Whether an effect acts in more than one link."""
        place = self.model.link_places.get(term)
        return place is None or place.is_row

    def _enter(self, stage: str, simulations: int) -> None:
        """A stage that makes so many simulations for each recording."""
        self._tell(stage)
        self.model.batches.progress.enter(stage, self._left)
        self._left = max(self._left - self._count * simulations, 0)

    def _enter_more(self, stage: str, simulations: int) -> None:
        """The same of simulations that were not counted before."""
        self._left += self._count * simulations
        self._enter(stage, simulations)

    def _point(self, z: Array, terms: dict[Term, tuple[float, ...]] | None = None) -> Point:
        return Point(np.concatenate([self._network_point.base, z]), {**self._network_point.terms, **(terms or {})})

    def anchor(self) -> None:
        """Recalibrated coils, and an ensemble of random starts there."""
        model = self.model
        if model.network is not None:
            self._tell("recalibrating circuit and coils")
            self._network_point = recalibrate(model.network).point
        self._enter("contact scatter", self._size)
        here = self._point(np.zeros(len(model.free)))
        runs = model.simulated([(here, s + 1) for s in range(self._size)])
        members = [m for m in runs if m is not None]
        if len(members) < FEWEST:
            reason = (model.fabric_runs.reasons or ["it stops"])[0]
            raise InputError(
                model.mechanical_recordings[0].path,
                "",
                f"Bullet cannot simulate this fabric: {reason}",
                "run the scenario with `cosim run`; most often solver.micro_step is too long",
            )
        self._members = np.array(members)
        #: Number of the start of the first member, and effects that were asked whether they do anything.
        self._plain_start = next(s + 1 for s, m in enumerate(runs) if m is not None)
        self._asked: set[Term] = set()
        self._scatter = calibrated_scatter(self._members, model.binning.bins)
        self._farthest = self._farthest_member()
        #: Runs of the explanation that was confirmed last, shape (starts, bins).
        self._runs_found = self._members
        #: Runs about the means of their points.
        self._apart = self._members - self._members.mean(axis=0)
        self.surface = Surface(self._members.mean(axis=0), np.zeros(len(model.free)))
        self._ask_elsewhere(here)

    def _ask_elsewhere(self, here: Point) -> None:
        """The same fabric in the other engine: what the two differ by is an error of solving, and no physics."""
        self._enter("the same fabric in another engine", self._asked_elsewhere)
        runs = self.model.simulated_elsewhere([(here, s + 1) for s in range(self._asked_elsewhere)])
        found = [m for m in runs if m is not None]
        #: Runs of the other engine, and what their mean differs by; None where there are none.
        self._elsewhere: list[Array] = found
        self._difference = np.mean(found, axis=0) - self._members.mean(axis=0) if found else None

    def _farthest_member(self) -> float:
        """Mean square of the member that is farthest from the mean of the others, whitened by the scatter of both."""
        count = len(self._members)
        whiten = Whitening(self._scatter * (1.0 + 1.0 / (count - 1.0)), self.model.binning.bins.noise / 10.0)
        others = (self._members.sum(axis=0) - self._members) / (count - 1.0)
        return float(np.max(np.mean(whiten(self._members - others) ** 2, axis=1)))

    def answers(self) -> None:
        """One simulation of every parameter and of every start value of every effect."""
        count = len(self.model.free)
        tasks = [(t, s) for t in self._first for s in t.parameters[0].starts]
        self._enter("mechanical effects", self._repeats * count + sum(self._starts(t) for t, _ in tasks))
        points = [(self._point(STEP * np.eye(count)[i]), self._repeats) for i in range(count)]
        points += [(self._point(np.zeros(count), {t: (s,)}), self._starts(t)) for t, s in tasks]
        found = self._means(points)
        for i, bins in enumerate(found[:count]):
            if bins is not None:
                self.surface.slopes[i] = (bins - self.surface.mean) / STEP
        for (term, strength), bins in zip(tasks, found[count:]):
            self._take(term, strength, bins)
        wide = [(t, s) for t, s in tasks if t not in self.model.link_places]
        if not self._has_links:  # a run takes long
            wide = [(t, s) for t, s in wide if not self.surface.knows(t)]
        larger = [(t, largest_believed(t.parameters[0], s)) for t, s in wide]
        self._enter_more("effects of all links, at their largest", self._repeats * len(larger))
        for (term, strength), bins in zip(
            larger, self._means([(self._point(np.zeros(count), {t: (s,)}), self._repeats) for t, s in larger])
        ):
            self._take(term, strength, bins)
        self._without_plain()
        self._prepare(self._members)

    def _take(self, term: Term, strength: float, bins: Array | None) -> None:
        """Take what an effect does where that is more than the scatter of the contacts.

        An effect that does nothing (coils without heat in a cold fabric) is the scatter of its runs, which a fit would
        follow.
        """
        starts = self._starts(term)
        if bins is not None and self._shows(bins - self.surface.mean, starts):
            self.surface.add(term, strength, bins, np.zeros(len(self.model.free)), starts)

    def _without_plain(self) -> None:
        """Forget effects that do nothing at all: from the first start they run as the plain fabric does.

        Of effects that do nothing one in ten shows, by the scatter of its runs.
        """
        count = len(self.model.free)
        known = [t for t in self.model.laws() if self.surface.knows(t) and t not in self._asked]
        self._asked |= set(known)
        if not known:
            return
        starts = {t: next(iter(self.surface.strengths(t))) for t in known}
        here = np.zeros(count)
        self._enter_more("whether they do anything at all", len(starts) + 1)
        # Most of them show at once: the rest, which may act later, is simulated to the end.
        first = [self._point(here, {t: (s,)}) for t, s in starts.items()]
        is_same = self.model.begins_as_plain(first, self._point(here), self._plain_start)
        late = {t: p for (t, p), same in zip(zip(starts, first), is_same) if same}
        if not late:
            return
        self._enter_more("whether the others do anything later", len(late))
        for term, bins in zip(late, self.model.simulated([(p, self._plain_start) for p in late.values()])):
            if bins is not None and np.allclose(bins, self._members[0], rtol=0.0, atol=SAME):
                self.surface.forget(term)

    def _shows(self, change: Array, starts: int) -> bool:
        """Whether a change of the mean over so many starts is farther from nothing than any member of the ensemble is.

        By `SHOWS` times, in mean squares whitened by the scatter of either, with a tenth of the sensors' noise.
        """
        count, noise = len(self._members), self.model.binning.bins.noise
        own = Whitening(self._scatter * (1.0 / starts + 1.0 / count), noise / 10.0)(change)
        return bool(np.mean(own**2) > SHOWS * self._farthest)

    def _means(self, points: Sequence[tuple[Point, int]]) -> list[Array | None]:
        """Means over so many starts, each of its own for every point; None where every run stopped."""
        return [None if runs is None else runs.mean(axis=0) for runs in self._runs(points)]

    def _runs(self, points: Sequence[tuple[Point, int]]) -> list[Array | None]:
        """The same before the mean is taken, shape (starts, bins) each."""
        starts = iter(range(self._size + 1, self._size + 1 + sum(count for _, count in points)))
        found = iter(self.model.simulated([(p, next(starts)) for p, count in points for _ in range(count)]))
        runs: list[Array | None] = []
        for _, count in points:
            rows = [r for r in (next(found) for _ in range(count)) if r is not None]
            runs.append(np.array(rows) if rows else None)
        return runs

    def _scatter_of(self, runs: Array) -> None:
        """Count how runs of one point differ as scatter: a fabric with an effect may scatter more than one without."""
        if len(runs) > 1:
            apart = (runs - runs.mean(axis=0)) * np.sqrt(len(runs) / (len(runs) - 1.0))
            self._apart = np.concatenate([self._apart, apart])
            self._prepare(self.surface.mean + self._apart)

    def _prepare(self, members: Array) -> None:
        model = self.model
        binning, parameters = model.binning, [f.parameter for f in model.free]
        model.prepare(
            MechanicalModel(
                parameters,
                self.surface,
                binning.measured(),
                binning.bins,
                members,
                binning.names,
                model.camera,
                self._difference,
            )
        )

    def margin(self) -> float:
        """Largest gain that the search finds in any fabric that lacks nothing: a member of the ensemble, a run of the
        other engine."""
        self._tell("the same search on nulls")
        count, seed, whole = (
            len(self._members) if len(self._members) > FEWEST else 0,
            self.settings.seed,
            self.model.prepared,
        )
        nulls = [whole.without_member(n, seed) for n in range(count)]
        nulls += [whole.of_other_engine(run, n, seed) for n, run in enumerate(self._elsewhere)]
        return self._margin_of(nulls)

    def margin_beside(self) -> float:
        """The same of fabrics that lack what was found and nothing else: the runs from which it was confirmed."""
        self._tell("the same search on nulls that have what was found")
        runs, whole = self._runs_found, self.model.prepared
        return self._margin_of([whole.of_run(runs, n, self.settings.seed) for n in range(len(runs)) if len(runs) > 1])

    def _margin_of(self, nulls: Sequence[MechanicalModel]) -> float:
        """Largest gain that the search finds in any of several nulls."""
        once = replace(self.settings, floor=0.0, level=0.5, most_terms=1)
        return max((_largest_gain(search(null, self._known(), once)) for null in nulls), default=0.0)

    def _known(self) -> list[Term]:
        return [t for t in self.model.laws() if self.surface.knows(t)] + self.model.camera_terms()

    def search(self, settings: Settings) -> Outcome:
        """The search on what is known so far."""
        model = self.model
        unknown = {t for t in model.laws() if not self.surface.knows(t)}
        terms = [t for t in model.terms() if t not in unknown]
        return search(model, terms, settings, model.groups(), self._tell)

    def narrow(self, outcome: Outcome) -> bool:
        """Simulate an effect in every link of the row in which it is hopeful; whether any was."""
        places = self.model.link_places
        rows = [t for e in self._hopeful_of(outcome) for t in e.terms if t in places and places[t].is_row]
        chosen = list(dict.fromkeys(rows))[:ROWS]
        tasks = [
            t
            for t in self.model.laws()
            if not self.surface.knows(t)
            and any(t.identifier == r.identifier and places[t].row == places[r].row for r in chosen)
        ]
        if not tasks:
            return False
        self._enter_more("the same in single links", len(tasks))
        here = np.zeros(len(self.model.free))
        found = self._means([(self._point(here, {t: t.parameters[0].starts[:1]}), 1) for t in tasks])
        for term, bins in zip(tasks, found):
            self._take(term, term.parameters[0].starts[0], bins)
        self._without_plain()
        return True

    def settled(self, outcome: Outcome, settings: Settings) -> Outcome:
        """The outcome with hopeful effects simulated where they were fitted, and the best from several starts."""
        for number in range(ROUNDS):
            if not self.sharpen(outcome, self._hopeful if number == 0 else min(self._hopeful, AGAIN)):
                break
            outcome = self.search(settings)
        self.confirm(outcome)
        return self.search(settings)

    def _hopeful_of(self, outcome: Outcome) -> list[Explanation]:
        """The best, and rivals that are nearly as good or gain half as much: what was simulated once is uncertain."""
        best = outcome.rivals[0].fit.cost if outcome.rivals else outcome.best.fit.cost
        most = max(best + BEHIND, best + LEAST * (outcome.base.cost - best))
        near = [e for e in outcome.rivals if e.terms and e.fit.cost < most]
        return [outcome.best, *sorted(near, key=lambda e: e.fit.cost)]

    def sharpen(self, outcome: Outcome, most: int) -> bool:
        """Simulate at most so many hopeful effects where they were fitted; whether any was."""
        laws = set(self.model.laws())
        wanted: dict[Term, tuple[Point, list[float]]] = {}
        for explanation in self._hopeful_of(outcome):
            for term in explanation.terms:
                if term in laws and term not in wanted and len(wanted) < most:
                    sizes = self._sizes(term, explanation.fit.point.terms[term][0])
                    if sizes:
                        wanted[term] = explanation.fit.point, sizes
        if not wanted:
            return False
        tasks = [(term, point, size) for term, (point, sizes) in wanted.items() for size in sizes]
        self._enter("hopeful effects where they were fitted", len(tasks) * self._sharpened)
        points = [self._point(self.model.own_point(p).base, {t: (s,)}) for t, p, s in tasks]
        found = self._runs([(p, self._sharpened) for p in points])
        for runs, (term, point, size) in zip(found, tasks):
            if runs is not None:
                self.surface.add(term, size, runs.mean(axis=0), self.model.own_point(point).base, self._sharpened)
                if term in outcome.best.terms:  # how a rival scatters says nothing of what is found
                    self._scatter_of(runs)
        return True

    def _sizes(self, term: Term, strength: float) -> list[float]:
        """Where a hopeful effect is to be simulated that was not yet, from so many starts."""
        wanted = fitted_sizes(strength, self.surface.strengths(term), term.parameters[0])
        return [s for s in wanted if not self.surface.has_near(term, s, self._sharpened)]

    def confirm(self, outcome: Outcome) -> None:
        """Several starts at the best explanation: what it really gives, and its scatter."""
        model = self.model
        point = model.own_point(outcome.best.fit.point)
        self._network_point = model.network_point(outcome.best.fit.point)
        self._enter("the explanation found, from several starts", self._confirmed)
        whole = self._point(point.base, dict(point.terms))
        starts = [(whole, self._size + 1 + s) for s in range(self._confirmed)]
        found = [m for m in model.simulated(starts) if m is not None]
        if not found:
            return
        members = self._runs_found = np.array(found)
        mean = members.mean(axis=0)
        predicted = self.surface.bins([point], [point.base])[0]
        simulated = [t for t in point.terms if self.surface.knows(t)]
        strongest = max(simulated, key=lambda t: outcome.best.gains.get(t, 0.0), default=None)
        if strongest is None:
            self.surface = self.surface.with_mean(mean, point.base)
        elif abs(point.terms[strongest][0]) > 0:
            rest = predicted - self.surface.effect(strongest, point.terms[strongest][0])
            corrected = self.surface.mean + (point.base - self.surface.anchor) @ self.surface.slopes + mean - rest
            self.surface.add(strongest, point.terms[strongest][0], corrected, point.base, len(found))
        self._scatter_of(members)

    def at_other_strengths(self, outcome: Outcome, settings: Settings) -> Outcome:
        """The outcome, or that of a search that knows the one effect at strengths which meet the recordings better.

        Lines between few strengths have their least at a knot: springs that are so weak that their link stays shut were
        fitted by as much as just shuts it, and another effect beside them filled what was left.
        """
        model, laws = self.model, set(self.model.laws())
        fitted = outcome.best.fit.point
        point = model.own_point(fitted)
        if len(point.terms) != 1:
            return outcome
        ((term, (strength, *_)),) = point.terms.items()
        if term not in laws or strength == 0.0:
            return outcome
        self._network_point = model.network_point(fitted)
        known, runs = self._at_other_strengths([term], point)
        if _best_known(strength, known[term]) == strength:
            return outcome
        for (_, size), found in runs.items():
            if size:
                self.surface.add(term, size, found.mean(axis=0), point.base, len(found))
        return self.settled(self.search(settings), settings)

    def bound_strengths(self, outcome: Outcome) -> None:
        """Simulate every effect that was found at other strengths: between which it meets the recordings as well."""
        model, laws = self.model, set(self.model.laws())
        fitted = outcome.best.fit.point
        point = model.own_point(fitted)
        terms = [t for t in point.terms if t in laws and point.terms[t][0] != 0.0]
        if not terms:
            return
        self._network_point = model.network_point(fitted)
        known, runs = self._at_other_strengths(terms, point)
        for term in terms:
            self._bound(term, point, known[term], runs)

    def _at_other_strengths(
        self, terms: Sequence[Term], point: Point
    ) -> tuple[dict[Term, dict[float, Array]], dict[tuple[Term, float], Array]]:
        """-2 log posterior of runs at strengths about the fitted ones, and about better ones; and these runs."""
        known: dict[Term, dict[float, Array]] = {t: {} for t in terms}
        made: dict[tuple[Term, float], Array] = {}
        refined = 0
        while True:
            wanted = [(t, s) for t in terms for s in next_sizes(point.terms[t][0], known[t], t.parameters[0])]
            if not wanted and refined < REFINED:
                refined += 1
                wanted = [(t, s) for t in terms if (s := better_size(point.terms[t][0], known[t])) is not None]
            if not wanted:
                return known, made
            points = [point.plus(t, (s, *point.terms[t][1:])) for t, s in wanted]
            self._enter_more("the effects found, at other strengths", len(points) * self._confirmed)
            found = self._runs([(self._point(p.base, dict(p.terms)), self._confirmed) for p in points])
            for (term, size), runs in zip(wanted, found):
                known[term][size] = np.array([np.inf])
                if runs is not None:
                    known[term][size], made[term, size] = self.model.prepared.misfits(runs, point), runs

    def _bound(
        self, term: Term, point: Point, misfits: Mapping[float, Array], runs: Mapping[tuple[Term, float], Array]
    ) -> None:
        """Tell the model the interval of a strength: about the best one, and with the fitted one."""
        strength = point.terms[term][0]
        if not np.isfinite(misfits[strength]).all():
            return
        best = _best_known(strength, misfits)
        shifts = self.model.prepared.shifts(runs[term, best], self.surface.slope(term, best), point)
        low, high = widened(interval_of(best, misfits, term.parameters[0]), best, shifts, term.parameters[0])
        self.model.take_interval(term, (min(low, strength), max(high, strength)))


def _best_known(strength: float, misfits: Mapping[float, Array]) -> float:
    """The strength that meets the recordings best by more than errors of means; the fitted one where none does."""
    if not np.isfinite(misfits[strength]).all():
        return strength
    best = best_size({s: float(np.mean(v)) for s, v in misfits.items()})
    return best if best != strength and is_better(best, strength, misfits) else strength


def _largest_gain(outcome: Outcome) -> float:
    """What the best of all explanations gains over the recalibrated model [-2 log posterior]."""
    return outcome.base.cost - min([outcome.base.cost, *(e.fit.cost for e in outcome.rivals)])
