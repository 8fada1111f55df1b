"""Cycles: for each delay the design of least energy, by an epsilon-constraint on the delay.

Energy and delay are two aims. One of them is bounded (the delay, at each value that the task lists) and the other is
made least; the points together are the front (Haimes, Lasdon and Wismer, IEEE Trans. SMC 1 (1971) 296-297).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from chainmail.design.cycle import check_cooling, counting, delays
from chainmail.design.impossible import Impossible
from chainmail.design.keys import corners, value_of, weave_of
from chainmail.design.ledger import BudgetSpent
from chainmail.design.outcome import Outcome, Point
from chainmail.design.sequential import Verdict
from chainmail.design.task import Cycle
from chainmail.design.weave_model import jam_distance, slack_curvature, thickest_bar
from cosim.unit.quantity import PhysicalValue

if TYPE_CHECKING:
    from chainmail.design.candidate import Candidate
    from chainmail.design.search import Search

Keys = tuple[tuple[str, str], ...]
#: Heated rows, number of the level of their temperature, geometry.
Place = tuple[tuple[int, ...], int, Keys]
#: Geometries are screened with this share of the closed form's curvature, as rows are with that of the row model.
SURE = 0.8
#: Geometries that closed forms may propose for one programme.
PROPOSALS = 5
#: Geometries count as the same where no number differs by more than this share of its range.
NEAR = 0.05
#: The bar is chosen so thick that cold links bend by this much more than is wanted, by the closed form.
ROOM = 1.1


@dataclass
class Front:
    """Finds the designs of a front.

    Args:
        search: Makes programmes and judges them.
        cycle: What is wanted.
        outcome: What is found is written here.
    """

    search: Search
    cycle: Cycle
    outcome: Outcome
    _found: list[Place] = field(default_factory=list)

    def run(self) -> Outcome:
        """One point per delay, each checked on fresh starts.

        The longest delay comes first, since it allows most; where a delay is too short for anything, the optimiser may
        spend what is left.

        Raises:
            Impossible: No delay can be met.
        """
        search, cycle, hold = self.search, self.cycle, self.search.hold
        check_cooling(cycle, search.ledger.rig, hold)
        reasons: list[Impossible] = []
        for delay in reversed(delays(cycle)):
            search.at_delay(delay, counting(search.ledger.task.wanted, cycle, delay))
            notes: list[str] = []
            try:
                notes += self._least()
                self._complete()
            except BudgetSpent as spent:
                notes.append(f"the search ended early: {spent}")
            part = Outcome()
            found = search.accepted()
            if found:
                search.last_check(found, part)
            elif search.ledger.entries:
                reasons.append(search.unmet())
                notes.append(str(reasons[-1]))
            self.outcome.points.insert(0, self._point(delay, part, notes))
        if not any(p.design for p in self.outcome.points):
            raise reasons[0]
        self._share()
        return self._best()

    def _share(self) -> None:
        """Check designs that a shorter delay accepted for longer ones that have none: they are rigid in time for these.

        The search of a longer delay comes first and knows nothing of them. Fresh starts are run once for all delays.
        """
        points = self.outcome.points
        for number, point in enumerate(points):
            shorter = [p.design for p in points[:number] if p.verdict is Verdict.ACCEPTED and p.design is not None]
            if point.verdict is Verdict.ACCEPTED or not shorter:
                continue
            self.search.at_delay(point.delay, point.counting)
            part = Outcome()
            self.search.last_check(sorted(set(shorter), key=lambda c: c.energy(self.search.ledger.rig)), part)
            if part.winner is not None:
                part.notes.append(f"the design is that of a shorter delay: {part.winner.text()}")
                points[number] = self._point(point.delay, part, point.notes)

    def _point(self, delay: PhysicalValue, part: Outcome, notes: Iterable[str]) -> Point:
        """What was found for the delay that the search looks at."""
        return Point(
            delay,
            part.winner or part.checked,
            tuple(part.checks),
            part.verdict,
            self.search.counting or (),
            (*notes, *part.notes),
        )

    def _best(self) -> Outcome:
        """The accepted point of least energy; of equal ones that of the shortest delay."""
        checked = [p for p in self.outcome.points if p.design is not None]
        good = [p for p in checked if p.verdict is Verdict.ACCEPTED]
        rig = self.search.ledger.rig
        best = min(
            good or checked[-1:],
            key=lambda p: (p.design.energy(rig) if p.design is not None else 0.0, p.delay.to("s")),
        )
        self.outcome.winner = best.design if good else None
        self.outcome.checked, self.outcome.checks = best.design, list(best.checks)
        self.outcome.verdict, self.outcome.counting = best.verdict, best.counting
        return self.outcome

    def _least(self) -> list[str]:
        """Fewest rows first, hottest first; then cooler, with other geometries where the own one does not do."""
        search = self.search
        notes: list[str] = []
        begin = next((b for b in self._found if self._is_short(b)), None) or self._hottest(notes)
        if begin is None:
            if search.ledger.task.vary.keys:
                notes.append(search.optimise(self._is_hopeless))
            return notes
        ladder = [begin]
        while ladder[-1][1] > 0 and (cooler := self._first(begin[0], ladder[-1][1] - 1, ladder[-1][2])):
            ladder.append(cooler)
        for place in self._coolest_first(ladder):
            if self._is_short(place) and search.meets(self._candidate(place)):
                self._found.insert(0, place)
                break
        return notes

    def _complete(self) -> None:
        """Run to its end what met the request of this delay in a short run that was made for another one.

        Such a programme is heated longer than the closed forms allow this delay, and its links closed before its end.
        """
        search = self.search
        if search.accepted():
            return
        short = [c for c, e in search.ledger.decided().items() if e.fidelity == "short" and e.meets(search.counting)]
        for candidate in sorted(short, key=lambda c: c.energy(search.ledger.rig)):
            search.tell(candidate.text())
            if search.meets(candidate):
                return

    def _coolest_first(self, ladder: list[Place]) -> list[Place]:
        """Levels of a ladder from the coolest up, each with the geometries of its own and of cooler levels.

        What does at a cooler level from one start has more room at a hotter one.
        """
        found = []
        for rows, level, _ in reversed(ladder):
            cooler = dict.fromkeys(keys for _, other, keys in reversed(ladder) if other <= level)
            found += [(rows, level, keys) for keys in cooler]
        return found

    def _hottest(self, notes: list[str]) -> Place | None:
        """The fewest rows that do, as hot as the delay allows; with the scenario's own geometry if it does."""
        search = self.search
        tried = []
        for rows in search.patterns()[::-1]:
            levels = [n for n in range(len(search.levels)) if search.candidate(rows, search.levels[n]) is not None]
            if not levels:
                notes.append(f"rows {', '.join(map(str, rows))}: no level can be reached within this delay")
                continue
            place = (rows, levels[-1], self._own())
            if self._is_short(place):
                return place
            tried.append((search.ledger.shortly(self._candidate(place)).worst(search.counting), place))
        if not tried:
            return None
        # Other geometries are tried with the rows that came nearest.
        rows, level, _ = max(tried, key=lambda t: t[0])[1]
        return self._first(rows, level)

    def _candidate(self, place: Place) -> Candidate:
        rows, level, keys = place
        made = self.search.candidate(rows, self.search.levels[level], keys=keys)
        assert made is not None
        return made

    def _is_short(self, place: Place) -> bool:
        """Whether a design meets the request as far as a short run shows."""
        rows, level, keys = place
        made = self.search.candidate(rows, self.search.levels[level], keys=keys)
        if made is None:
            return False
        self.search.tell(made.text())
        return self.search.has_room(self.search.ledger.shortly(made))

    def _first(self, rows: tuple[int, ...], level: int, keys: Keys | None = None) -> Place | None:
        """The first geometry with which rows at a level meet the request in a short run."""
        own = self._own() if keys is None else keys
        if self._is_short((rows, level, own)):
            return rows, level, own
        tried = [own]
        # Every run says more about the closed form, so what it proposes is asked for anew.
        while len(tried) <= PROPOSALS:
            other = next((g for g in self._geometries() if not any(self._are_near(g, t) for t in tried)), None)
            if other is None:
                break
            if self._is_short((rows, level, other)):
                return rows, level, other
            tried.append(other)
        return None

    def _own(self) -> Keys:
        """The scenario's own numbers, within their ranges."""
        spans, rig = self.search.ledger.task.vary.keys, self.search.ledger.rig
        return tuple((key, span.at(span.share(value_of(rig, key)))) for key, span in spans.items())

    def _geometries(self) -> list[Keys]:
        """Few that closed forms propose: hot links stop at the jam; the thickest bar that still lets cold links bend.

        The nearer cold links are to the jam, the less they need to contract; the thickest bar brings them nearest.

        Raises:
            Impossible: By the closed form no geometry of the ranges bends enough when it is cold.
        """
        spans = self.search.ledger.task.vary.keys
        if not spans:
            return []
        scale, least = self._fitted(), self._fitted(min)
        if scale is None or least is None:
            return []
        self._check_reach(scale)
        own = dict(self._own())
        proposals = [self._at_jam(own), self._at_jam(self._with_thickest(own, least))]
        proposals.append(self._with_end(proposals[-1], "tolerance", 0.0))
        proposals.append(self._with_end(proposals[1], "tolerance", 1.0))
        found = [self._own()]
        for proposal in proposals:
            made = tuple((key, proposal[key]) for key in spans)
            if not self._is_hopeless(made) and not any(self._are_near(made, other) for other in found):
                found.append(made)
        return found[1:]

    def _are_near(self, first: Keys, second: Keys) -> bool:
        """Whether two geometries differ by so little that a second run would say nothing new."""
        spans = self.search.ledger.task.vary.keys
        places = [
            [span.share(PhysicalValue.parse(dict(keys)[key])) for key, span in spans.items()]
            for keys in (first, second)
        ]
        return all(abs(a - b) < NEAR for a, b in zip(*places))

    def _fitted(self, find: Callable[[Iterable[float]], float] = max) -> float | None:
        """Scale of the closed form, from the cold curvatures of all runs: the largest, or another of them."""
        ledger = self.search.ledger
        cold = next(n for n, w in enumerate(ledger.task.wanted) if w.quantity.endswith("max_curvature"))
        scales = []
        for entry in ledger.entries:
            weave = weave_of(entry.candidate.keys, ledger.rig) if not entry.failure else None
            form = slack_curvature(weave.bar_distance_cold, weave.bar_diameter) if weave is not None else 0.0
            scales += [entry.values[cold] / form] if form > 0.0 else []
        return find(scales) if scales else None

    def _check_reach(self, scale: float) -> None:
        curved = [self._cold(corner, scale) for corner in corners(self.search.ledger.task.vary.keys)]
        if max(curved) < SURE * self.cycle.cold.to("1/m"):
            raise Impossible(
                f"the weave: cold links have too little slack for {self.cycle.cold} in all of the ranges",
                f"about {max(curved):.3g} 1/m, by the closed form of the slack; thinner bars or longer cold links bend "
                "more",
            )

    def _cold(self, keys: Keys, scale: float) -> float:
        weave = weave_of(keys, self.search.ledger.rig)
        return 0.0 if weave is None else scale * slack_curvature(weave.bar_distance_cold, weave.bar_diameter)

    def _is_hopeless(self, keys: Keys) -> bool:
        """Whether a geometry cannot be woven, or bends too little when cold, by a margin for the closed form."""
        scale = self._fitted()
        if weave_of(keys, self.search.ledger.rig) is None:
            return True
        return scale is not None and self._cold(keys, scale) < SURE * self.cycle.cold.to("1/m")

    def _with_thickest(self, keys: dict[str, str], scale: float) -> dict[str, str]:
        key = self._key("bar_diameter")
        weave = weave_of(tuple(keys.items()), self.search.ledger.rig)
        if key is None or weave is None:
            return keys
        span = self.search.ledger.task.vary.keys[key]
        ends = span.low.to("m"), span.high.to("m")
        bar = thickest_bar(weave.bar_distance_cold, ROOM * self.cycle.cold.to("1/m"), scale, *ends)
        return {**keys, key: span.at((bar - ends[0]) / (ends[1] - ends[0]))}

    def _at_jam(self, keys: dict[str, str]) -> dict[str, str]:
        key = self._key("length_hot")
        weave = weave_of(tuple(keys.items()), self.search.ledger.rig)
        if key is None or weave is None:
            return keys
        span = self.search.ledger.task.vary.keys[key]
        ends = span.low.to("m"), span.high.to("m")
        length = jam_distance(weave.bar_diameter) - weave.length_offset
        return {**keys, key: span.at((length - ends[0]) / (ends[1] - ends[0]))}

    def _with_end(self, keys: dict[str, str], name: str, end: float) -> dict[str, str]:
        key = self._key(name)
        return keys if key is None else {**keys, key: self.search.ledger.task.vary.keys[key].at(end)}

    def _key(self, name: str) -> str | None:
        return next((k for k in self.search.ledger.task.vary.keys if k.rpartition(".")[2] == name), None)
