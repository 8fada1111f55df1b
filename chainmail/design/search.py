"""The structured search: from all rows hot to fewer, later and cooler, each step judged by runs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import combinations

from chainmail.design.candidate import Candidate, on_grid
from chainmail.design.closed_form import greatest_voltage, nearest_power
from chainmail.design.ledger import BudgetSpent, Entry, Ledger
from chainmail.design.row_model import Chain, fitted
from chainmail.design.sequential import SequentialTest, Verdict
from cosim.unit.quantity import PhysicalValue

#: Temperatures at the end of heating [K], and of the hold on the cooling branch [K].
HOT, COOLER, HOLD = 335.15, (331.15,), 319.15
#: Times between the end of heating and the deadline [s]: links need seconds to close against friction.
LEADS = (4.0, 2.0, 1.0)
#: Patterns of one size that the row model may send to Bullet beside the rows at the root.
SCREENED = 1
#: Share that a sequential test tells from the wanted one: 0.3 below it, as far as ten runs can tell.
APART, ERROR = 0.3, 0.1
#: Fresh starts are numbered from here; the search itself uses lower ones.
FRESH = 1001


class Impossible(Exception):
    """No design meets the request.

    Args:
        limit: The limit that forbids it.
        nearest: The nearest that is possible.
    """

    def __init__(self, limit: str, nearest: str) -> None:
        super().__init__(f"{limit}; {nearest}")
        self.limit, self.nearest = limit, nearest


@dataclass
class Outcome:
    """What a search found.

    Args:
        winner: The design that the last check accepted; None: none was accepted.
        checks: Full runs of it, on fresh starts.
        verdict: Of the sequential test.
        reference: All free rows hot, with the same kind of programme.
        chain: The row model that screened.
        notes: What a reader must know of how the search ended.
    """

    winner: Candidate | None = None
    checks: list[Entry] = field(default_factory=list)
    verdict: Verdict = Verdict.OPEN
    reference: Candidate | None = None
    chain: Chain | None = None
    notes: list[str] = field(default_factory=list)


@dataclass
class Search:
    """Finds the design of least energy.

    Args:
        ledger: Makes the runs.
        tell: Told what is done.
    """

    ledger: Ledger
    tell: Callable[[str], None] = lambda text: None

    def __post_init__(self) -> None:
        task, self._rig = self.ledger.task, self.ledger.rig
        moments = [w.at.to("s") for w in task.wanted if w.at is not None]
        self.deadline = max(moments) if moments else self._rig.scenario.time.stop.to("s")
        limits = [w.below.to("W") for w in task.wanted if w.quantity == f"{self._rig.circuit}.supply_power" and w.below]
        self.power = min(limits, default=math.inf)
        self.voltage = task.vary.voltage.high.to("V")

    def candidate(self, rows: tuple[int, ...], hot: float = HOT, lead: float = LEADS[0]) -> Candidate | None:
        """The cheapest programme of a pattern by the closed forms; None where voltage, power or time forbid it.

        Energy to reach a temperature falls with the voltage, so it is the greatest that is allowed.
        """
        end = on_grid(self.deadline - lead, self._rig, up=False)
        if not rows:
            return Candidate((), 0.0, hot, HOLD, end, end, self.deadline + 1.0, self.deadline)
        row = self._rig.rows[rows[0] - 1]
        # Rounded downwards: at the limit itself, rounding would decide whether it is kept.
        voltage = math.floor(1e4 * greatest_voltage(row, len(rows), self.voltage, self.power) * (1.0 - 1e-9)) / 1e4
        heating = row.heating_time(voltage, hot)
        if not math.isfinite(heating):
            return None
        begin = on_grid(end - heating, self._rig, up=False)
        held = on_grid(end + row.coasting_time(hot, HOLD), self._rig, up=False)
        return Candidate(rows, voltage, hot, HOLD, begin, end, held, self.deadline) if begin >= 0.0 else None

    def run(self) -> Outcome:
        """Search, then check on fresh starts.

        Raises:
            Impossible: No design can meet the request.
        """
        outcome = Outcome()
        self._check_heat()
        found: list[Candidate] = []
        try:
            found = list(self._feasible(outcome))
        except BudgetSpent as spent:
            outcome.notes.append(f"the search ended early: {spent}")
        found = sorted(self._accepted(), key=lambda c: c.energy(self._rig))
        if not found and not any(e.is_met for e in self.ledger.entries):
            raise self._unmet()
        self._last_check(found, outcome)
        return outcome

    def _check_heat(self) -> None:
        """Raise Impossible where not even one row can be heated in time."""
        if any(self.candidate((r,), lead=min(LEADS)) is not None for r in self._rig.free):
            return
        row, time = self._rig.rows[self._rig.held], self.deadline - min(LEADS)
        needed = row.voltage_for(HOT, time)
        power = nearest_power(row, HOT, time)
        hot = f"{HOT - 273.15:.3g} degC"
        if needed > self.voltage:
            raise Impossible(
                f"the voltage: at {self.voltage:.4g} V a row settles at {row.limit(self.voltage) - 273.15:.3g} degC "
                f"and does not reach {hot} by {time:g} s",
                f"a row reaches it by then from {_upwards(needed)} V on",
            )
        raise Impossible(
            f"the power: one row needs {_upwards(power)} W to reach {hot} by {time:g} s, more than {self.power:.3g} W",
            f"from {_upwards(power)} W on one row can be heated in time",
        )

    def _feasible(self, outcome: Outcome) -> Iterator[Candidate]:
        rig, free = self._rig, self._rig.free
        self.tell("all rows cold")
        (cold,) = self.ledger.coarse(self._need(()), (1,))
        if cold.is_met and self.ledger.coarse(cold.candidate, (2,))[0].is_met:
            yield cold.candidate
            return
        patterns = self._patterns()
        tried = (self.candidate(p, lead=lead) for lead in LEADS for p in patterns)
        first = next((c for c in tried if c is not None), None)
        if first is None:
            raise Impossible(
                "voltage, power and time together: no pattern of `rows_heated` can be heated, all its rows at once, by "
                f"{self.deadline - min(LEADS):g} s",
                "give patterns with fewer rows; one row alone can be heated in time",
            )
        outcome.reference = first
        self.tell(f"{len(first.rows)} rows hot")
        (hot,) = self.ledger.coarse(first, (1,))
        if not hot.is_met:
            (hot,) = self.ledger.coarse(first, (2,))
        if not hot.is_met:
            return
        yield first
        best = first
        sags = [self._sag(e) for e in (cold, hot)]
        if self.ledger.task.vary.rows_heated == "any" and None not in sags and len(first.rows) == len(free):
            outcome.chain = fitted(len(rig.rows), rig.held, self._pitch(), float(sags[0] or 0), float(sags[1] or 0))
        for pattern in self._fewer(patterns, first, outcome.chain):
            made = self.candidate(pattern)
            if made is None or made.energy(rig) >= best.energy(rig):
                continue
            self.tell(f"rows {', '.join(map(str, pattern))} hot")
            if self._holds(made):
                best = made
                yield made
        yield from self._later_and_cooler(best)

    def _later_and_cooler(self, best: Candidate) -> Iterator[Candidate]:
        lead = LEADS[0]
        for shorter in LEADS[1:]:
            made = self.candidate(best.rows, HOT, shorter)
            if made is None or made.energy(self._rig) >= best.energy(self._rig):
                continue
            self.tell(f"{shorter:g} s between heating and deadline")
            if not self._holds(made):
                break
            lead, best = shorter, made
            yield made
        for cooler in COOLER:
            made = self.candidate(best.rows, cooler, lead)
            if made is not None:
                self.tell(f"heated to {cooler - 273.15:.3g} degC")
                if not self._holds(made):
                    break
                yield made

    def _holds(self, candidate: Candidate) -> bool:
        """On two starts."""
        return all(e.is_met for e in self.ledger.coarse(candidate, (1, 2)))

    def _patterns(self) -> list[tuple[int, ...]]:
        """Patterns with most rows first; those at the root before others."""
        given = self.ledger.task.vary.rows_heated
        if given != "any":
            return sorted((tuple(sorted(set(p))) for p in given), key=lambda p: (-len(p), p))
        free = self._rig.free
        return [free[:count] for count in range(len(free), 0, -1)]

    def _fewer(
        self, patterns: list[tuple[int, ...]], first: Candidate, chain: Chain | None
    ) -> Iterator[tuple[int, ...]]:
        """Patterns with fewer rows: those at the root, and where the row model expects less sag, that pattern too."""
        for pattern in patterns:
            if len(pattern) >= len(first.rows):
                continue
            yield pattern
            if chain is not None and self.ledger.task.vary.rows_heated == "any":
                ranked = sorted(combinations(self._rig.free, len(pattern)), key=chain.sag)
                yield from (p for p in ranked[:SCREENED] if p != pattern and chain.sag(p) < 0.9 * chain.sag(pattern))

    def _accepted(self) -> list[Candidate]:
        """Candidates all of whose runs met the request; a coarse run that was made again does not count."""
        runs: dict[Candidate, list[Entry]] = {}
        for entry in self.ledger.entries:
            runs.setdefault(entry.candidate, []).append(entry)
        good = []
        for candidate, own in runs.items():
            judged = [e for e in own if not (e.fidelity == "coarse" and self._was_repeated(e, own))]
            if judged and all(e.is_met for e in judged):
                good.append(candidate)
        return good

    @staticmethod
    def _was_repeated(entry: Entry, others: list[Entry]) -> bool:
        return any(o.fidelity == "fine" and o.start == entry.start for o in others)

    def _last_check(self, found: list[Candidate], outcome: Outcome) -> None:
        wanted = self.ledger.task.wanted
        share = max(w.share for w in wanted)
        test = SequentialTest(share, share - APART, min(ERROR, 1.0 - max(w.confidence for w in wanted) + 1e-12))
        start = FRESH
        for candidate in found:
            checks: list[Entry] = []
            verdict = Verdict.OPEN
            self.tell(f"fresh starts of {candidate.text()}")
            try:
                while verdict is Verdict.OPEN:
                    number = max(1, min(self.ledger.batches.place.parallel, 6 - len(checks)))
                    checks += self.ledger.full_batch(candidate, range(start, start + number))
                    start += number
                    met = sum(e.is_met for e in checks)
                    verdict = test.verdict(met, len(checks) - met)
            except BudgetSpent as spent:
                outcome.notes.append(f"the last check ended early: {spent}")
            outcome.checks, outcome.verdict = checks, verdict
            if verdict is Verdict.ACCEPTED:
                outcome.winner = candidate
                return
            if verdict is Verdict.OPEN:
                return
            outcome.notes.append(f"fresh starts rejected {candidate.text()}")

    def _unmet(self) -> Impossible:
        """What of the request no run met, and how near one came."""
        complete = [e for e in self.ledger.entries if not e.failure]
        if not complete:
            reasons = "; ".join(dict.fromkeys(" ".join(e.failure.split()) for e in self.ledger.entries))
            return Impossible(f"no run reached its end: {reasons}", "correct the scenario")
        best = max(complete, key=lambda e: min(e.distances))
        worst = min(range(len(best.distances)), key=lambda i: best.distances[i])
        unit = self.ledger.units[worst]
        wanted = self.ledger.task.wanted[worst]
        tried = len({e.candidate for e in self.ledger.entries})
        most = max((e.candidate for e in complete), key=lambda c: len(c.rows))
        hottest = f", of which one heats rows {', '.join(map(str, most.rows))}" if most.rows else ""
        return Impossible(
            f"{wanted.text()}: no run of {tried} designs reached it{hottest}",
            f"the nearest was {PhysicalValue(float(f'{best.values[worst]:.4g}'), unit)} with {best.candidate.text()}",
        )

    def _need(self, rows: tuple[int, ...]) -> Candidate:
        made = self.candidate(rows)
        assert made is not None
        return made

    def _sag(self, entry: Entry) -> float | None:
        """Tip sag of a run, where it is wanted [m]."""
        for wanted, value in zip(self.ledger.task.wanted, entry.values):
            if wanted.quantity == f"{self._rig.fabric}.tip_sag":
                return value
        return None

    def _pitch(self) -> float:
        """Pitch of two rows, from the bar diameter: 2.49 d in the jam (docs/mechanics.md) [m]."""
        from pathlib import Path

        from cosim.components import FabricComponent
        from cosim.parameters import resolve

        fabric = self._rig.scenario.components[self._rig.fabric]
        assert isinstance(fabric, FabricComponent)
        values = resolve(fabric.parameter_set, fabric.parameters, self._rig.scenario.path or Path("scenario")).values
        bar = values.get("bar_diameter")
        return 2.49 * (bar.to("m") if isinstance(bar, PhysicalValue) else 8.35e-3)


def _upwards(value: float) -> str:
    """Three digits, rounded upwards: what is told to suffice must suffice.

    >>> _upwards(5.391), _upwards(2.2)
    ('5.4', '2.2')
    """
    grain = 10.0 ** (math.floor(math.log10(value)) - 2)
    return f"{grain * math.ceil(value / grain - 1e-9):.3g}"
