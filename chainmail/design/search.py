"""The structured search: from few hot rows at the root to more and cooler ones, each step judged by runs."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtri

from chainmail.design.candidate import LEAD, Candidate, Pulse, Rig, on_grid
from chainmail.design.closed_form import heated_together, nearest_power
from chainmail.design.cycle import cycled, delays
from chainmail.design.front import Front
from chainmail.design.impossible import Impossible
from chainmail.design.keys import value_of
from chainmail.design.ledger import BudgetSpent, Entry, Ledger
from chainmail.design.optimiser import minimised
from chainmail.design.outcome import Outcome
from chainmail.design.row_model import Chain, fitted
from chainmail.design.sequential import SequentialTest, Verdict
from chainmail.design.shape import COLD_BEND, HOT_BEND, fewest_rows, scheduled
from chainmail.design.shortfall import shortfall
from chainmail.design.task import Schedule, Shape, Span, Wanted
from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue

#: Temperature of the hold on the cooling branch [K].
HOLD = 319.15
#: Levels of the temperature at the end of heating, between the ends that the task gives.
LEVELS = 4
#: A pattern is not run where this share of the row model's sag is too much already.
SURE = 0.8
#: Share that a sequential test tells from the wanted one: 0.3 below it, as far as ten runs can tell.
APART, ERROR = 0.3, 0.1
#: Share by which programmes stay below a limit of power: ngspice solves currents to 1e-3 of their value.
BELOW = 1e-3
#: Starts of the first design that meets the request, from which it is known how much each requirement scatters.
STARTS = (1, 2, 3)
#: Fresh starts are numbered from here; the search itself uses lower ones.
FRESH = 1001
#: Fresh starts that a sequential test takes where all of them meet the request.
CHECKS = 6
#: What the optimiser sees of a design that was not run, or not to its end: worse than any bound that is missed.
UNMADE = 10.0


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
        #: Delay that is looked at, and the requirements that count for it; None: all.
        self.delay: PhysicalValue | None = None
        self.counting: tuple[int, ...] | None = None
        if task.cycle is not None:
            self.delay = delays(task.cycle)[-1]
            self.deadline = self.delay.to("s")
        limits = [w.below.to("W") for w in task.wanted if w.quantity == f"{self._rig.circuit}.supply_power" and w.below]
        self.power = min(limits, default=math.inf)
        self.lowest, self.voltage = task.vary.voltage.low.to("V"), task.vary.voltage.high.to("V")
        low, high = task.vary.temperature.low.to("K"), task.vary.temperature.high.to("K")
        #: How far a run must be from each bound, so that the wanted share of starts is on its right side.
        self._room: tuple[float, ...] = ()
        self._fresh: dict[Candidate, list[Entry]] = {}
        self.levels = tuple(float(t) for t in np.linspace(low, high, LEVELS))

    @property
    def room(self) -> tuple[float, ...]:
        """How far a run must be from each bound; empty where no design met the request."""
        return self._room

    @property
    def hold(self) -> float:
        """Temperature of the hold [K]."""
        return HOLD

    def at_delay(self, delay: PhysicalValue, counting: tuple[int, ...]) -> None:
        """Look at one delay of a front, by the requirements that count for it."""
        self.delay, self.deadline, self.counting = delay, delay.to("s"), counting

    @property
    def coolest(self) -> float:
        """Lowest temperature at the end of heating [K]."""
        return self.levels[0]

    def candidate(
        self,
        rows: tuple[int, ...],
        hot: float | Sequence[float] | None = None,
        *,
        voltage: float | None = None,
        power: float | None = None,
        keys: tuple[tuple[str, str], ...] = (),
    ) -> Candidate | None:
        """The cheapest programme of a pattern by the closed forms; None where voltage, power or time forbid it.

        All rows are heated in one time, the shortest that the limits allow, each to its own temperature.

        Args:
            rows: Heated rows.
            hot: Temperature at the end of heating, one for all or one per row [K]; None: the lowest.
            voltage: Another limit than the task's [V].
            power: The same [W].
            keys: Numbers of the scenario that are changed.
        """
        if self.ledger.task.cycle is not None:
            return self._cycled(rows, hot, voltage, power, keys)
        end = on_grid(self.deadline - LEAD, self._rig, up=False)
        if not rows:
            return Candidate((), HOLD, end, self.deadline, keys)
        hots = list(hot) if isinstance(hot, Sequence) else [self.coolest if hot is None else hot] * len(rows)
        own = [self._rig.rows[r - 1] for r in rows]
        # At the limit, rounding would decide whether it is kept.
        most = self.voltage if voltage is None else voltage, self.power if power is None else power
        exact = heated_together(own, hots, most[0] * (1 - 1e-9), most[1] * (1 - BELOW), end)
        if exact is None:
            return None
        volts = [math.floor(1e4 * v) / 1e4 for v in exact]
        if min(volts) < self.lowest:
            return None
        begin = on_grid(end - max(r.heating_time(v, t) for r, v, t in zip(own, volts, hots)), self._rig, up=False)
        if begin < 0.0:
            return None
        helds = [on_grid(end + r.coasting_time(t, HOLD), self._rig, up=False) for r, t in zip(own, hots)]
        pulses = tuple(Pulse(n, v, t, begin, end, h) for n, v, t, h in zip(rows, volts, hots, helds))
        return Candidate(pulses, HOLD, begin, self.deadline, keys)

    def _cycled(
        self,
        rows: tuple[int, ...],
        hot: float | Sequence[float] | None,
        voltage: float | None,
        power: float | None,
        keys: tuple[tuple[str, str], ...],
    ) -> Candidate | None:
        cycle = self.ledger.task.cycle
        assert cycle is not None
        assert self.delay is not None
        hots = list(hot) if isinstance(hot, Sequence) else [self.coolest if hot is None else hot] * len(rows)
        limits = (
            self.lowest,
            self.voltage if voltage is None else voltage,
            (self.power if power is None else power) * (1 - BELOW),
        )
        return cycled(cycle, self.delay, self._rig, rows, hots, limits, HOLD, keys)

    def meets(self, candidate: Candidate) -> bool:
        """Whether a design meets the request, with room for how it scatters between starts.

        A design that barely meets it from one start misses it from half of the others, and a search for the least
        energy ends with such a one.
        """
        entry = self.ledger.judged(candidate, counting=self.counting)
        if entry.meets(self.counting) and not self._room:
            # Of one fidelity: a coarse run differs from fine ones by more than starts do.
            starts = STARTS if entry.fidelity == "coarse" else STARTS[1:]
            own = [] if entry.fidelity == "coarse" else [entry]
            runs = [*own, *self.ledger.fine_batch(candidate, starts)]
            complete = np.array([e.distances for e in runs if not e.failure])
            scatter = np.std(complete, axis=0, ddof=1) if len(complete) > 1 else np.zeros(len(entry.distances))
            shares = [w.share for w in self.ledger.task.wanted]
            self._room = tuple(float(max(ndtri(p), 0.0) * s) for p, s in zip(shares, scatter))
        return self.has_room(entry)

    def has_room(self, entry: Entry) -> bool:
        if not entry.meets(self.counting):
            return False
        # Where several starts of a design are known, the first one may be the luckiest.
        known = self.ledger.mean_distances(entry)
        where = range(len(known)) if self.counting is None else self.counting
        return not self._room or all(math.isnan(known[n]) or known[n] >= self._room[n] for n in where)

    def run(self) -> Outcome:
        """Search, then check on fresh starts.

        Raises:
            Impossible: No design can meet the request.
        """
        outcome = Outcome()
        self._check_heat()
        task = self.ledger.task
        if task.cycle is not None:
            return Front(self, task.cycle, outcome).run()
        try:
            if task.schedule is not None:
                self._on_schedule(task.schedule)
            elif task.shape is not None:
                self._in_shape(task.shape, outcome)
            else:
                self._feasible(outcome)
        except BudgetSpent as spent:
            outcome.notes.append(f"the search ended early: {spent}")
        found = self.accepted()
        if not found and task.vary.keys:
            outcome.notes.append(self.optimise())
            found = self.accepted()
        if not found:
            self._run_nearest()
            raise self.unmet()
        self.last_check(found, outcome)
        return outcome

    def optimise(self, is_hopeless: Callable[[tuple[tuple[str, str], ...]], bool] = lambda keys: False) -> str:
        """Vary the numbers of the fabric around the design that came nearest, by CMA-ES, until one meets the request.

        Args:
            is_hopeless: Whether closed forms exclude some numbers, which are then not run.

        Returns:
            What was done, for the report.
        """
        decided = [(e.worst(self.counting), c) for c, e in self.ledger.decided().items() if not e.failure and c.rows]
        if not decided:
            return "numbers of the fabric were not varied: no design was run to its end"
        nearest, spans = max(decided, key=lambda d: d[0])[1], self.ledger.task.vary.keys
        runs = 0

        def distance(shares: Array) -> float:
            nonlocal runs
            keys = tuple((key, span.at(float(x))) for (key, span), x in zip(spans.items(), shares))
            if is_hopeless(keys):
                return UNMADE
            made = replace(nearest, keys=keys)
            self.tell(f"optimiser: {made.text()}")
            runs += 1
            entry = self.ledger.judged(made, counting=self.counting)
            return -min(self.ledger.scaled(entry, self.counting)) if not entry.failure else UNMADE

        begin = [self.share_of(key, span, nearest) for key, span in spans.items()]
        try:
            found = minimised(distance, begin, self.ledger.left() - CHECKS, self.ledger.task.seed)
            ended = "it met the request" if found <= 0.0 else "none met the request"
        except BudgetSpent as spent:
            ended = str(spent)
        return f"CMA-ES over {', '.join(spans)}: {runs} designs; {ended}"

    def share_of(self, key: str, span: Span, candidate: Candidate) -> float:
        """Where a design, or else the scenario, lies in the range of a key."""
        own = dict(candidate.keys).get(key)
        return span.share(PhysicalValue.parse(own) if own is not None else value_of(self._rig, key))

    def _check_heat(self) -> None:
        """Raise Impossible where not even one row can be heated in time."""
        if any(self.candidate((r,)) is not None for r in self._rig.free):
            return
        row, time = self._rig.rows[self._rig.held], self.deadline - LEAD
        hot = f"{self.coolest - 273.15:.3g} degC"
        if time <= 0.0:
            raise Impossible(
                f"the time: a row must be hot {LEAD:g} s before {self.deadline:g} s, heated from 0 s on",
                f"a deadline after {LEAD:g} s",
            )
        needed = row.voltage_for(self.coolest, time)
        power = nearest_power(row, self.coolest, time)
        if needed > self.voltage:
            limit = row.limit(self.voltage)
            soonest = row.heating_time(self.voltage, self.coolest)
            nearest = f"a row reaches it by then from {_upwards(needed)} V on"
            if math.isfinite(soonest):
                raise Impossible(
                    f"voltage and time: at {self.voltage:.4g} V a row needs {_upwards(soonest)} s to {hot} and has "
                    f"{time:.4g} s",
                    f"{nearest}, or at {self.voltage:.4g} V by a deadline of {_upwards(soonest + LEAD)} s",
                )
            raise Impossible(
                f"the voltage: at {self.voltage:.4g} V a row settles at {limit - 273.15:.3g} degC and does not reach "
                f"{hot} by {time:.4g} s",
                nearest,
            )
        if power <= self.power:
            most, least = row.voltage_of(self.power * (1 - BELOW)), row.power(self.lowest) / (1 - BELOW)
            raise Impossible(
                f"the lowest voltage: {self.power:.3g} W allow a row {_downwards(most)} V, and `voltage` begins at "
                f"{self.lowest:.4g} V",
                f"a range that begins at {_downwards(most)} V or below, or {_upwards(least)} W",
            )
        raise Impossible(
            f"the power: a row needs {_upwards(power)} W to reach {hot} by {time:.4g} s, more than {self.power:.3g} W",
            f"from {_upwards(power)} W on one row can be heated in time",
        )

    def _feasible(self, outcome: Outcome) -> None:
        """From the root outward: the fewest rows that can do, hottest first, then cooler while the request is met."""
        self.tell("all rows cold")
        cold = self.ledger.judged(self._need(()))
        if cold.is_met:
            return
        patterns = self.patterns()
        tried = (self.candidate(p) for p in patterns)
        first = next((c for c in tried if c is not None), None)
        if first is None:
            raise Impossible(
                "voltage, power and time together: no pattern of `rows_heated` can be heated, all its rows at once, by "
                f"{self.deadline - LEAD:g} s",
                "give patterns with fewer rows; one row alone can be heated in time",
            )
        patterns = [p for p in patterns if len(p) <= len(first.rows)]
        self._screen(cold, outcome)
        best: Candidate | None = None
        for pattern in reversed(patterns):
            if outcome.chain is not None and self._is_hopeless(pattern, outcome.chain):
                outcome.notes.append(
                    f"not run: heated rows {', '.join(map(str, pattern))}; with these rows straight "
                    "the cold ones alone sag too much, by the row model"
                )
                continue
            best = self._coolest(pattern, best)
        if best is not None:
            self._cooler_rows(best)

    def _coolest(self, pattern: tuple[int, ...], best: Candidate | None) -> Candidate | None:
        """The coolest level at which a pattern meets the request, from the hottest that costs less than the best."""
        for hot in reversed(self.levels):
            made = self.candidate(pattern, hot)
            if made is None or (best is not None and made.energy(self._rig) >= best.energy(self._rig)):
                continue
            self.tell(made.text())
            if not self.meets(made):
                break  # cooler sags more
            best = made
        return best

    def _on_schedule(self, schedule: Schedule) -> None:
        """Rows one after another, hotter where what is wanted is not met."""
        for hot in self.levels:
            try:
                made = self._scheduled(schedule, hot, self.voltage, self.power)
            except Impossible:
                if hot == self.coolest:
                    raise
                return  # hotter needs more
            self.tell(made.text())
            if self.meets(made):
                return

    def _scheduled(self, schedule: Schedule, hot: float, voltage: float, power: float) -> Candidate:
        return scheduled(schedule, self._rig, hot, HOLD, (self.lowest, voltage), power * (1 - BELOW))

    def wider(
        self, candidate: Candidate, *, voltage: float | None = None, power: float | None = None
    ) -> Candidate | None:
        """The programme of the same rows and temperatures under another limit of voltage or power."""
        schedule = self.ledger.task.schedule
        if schedule is None:
            hots = [p.hot for p in candidate.pulses]
            return self.candidate(candidate.rows, hots, voltage=voltage, power=power, keys=candidate.keys)
        most = self.voltage if voltage is None else voltage, self.power if power is None else power
        try:
            return self._scheduled(schedule, candidate.hottest, *most)
        except Impossible:
            return None

    def _in_shape(self, shape: Shape, outcome: Outcome) -> None:
        """Patterns that have the shape by the row model, fewest rows first; hotter rows only where they bend too much.

        Hotter rows on both sides also straighten a flexible one between them, so no row is hotter than it must be.
        """
        rig = self._rig
        patterns, total = fewest_rows(shape, rig), 2 ** len(rig.free)
        if not patterns:
            raise Impossible(
                f"the shape: by the row model none of {total} patterns of heated rows has it",
                f"by that model a cold row bends by {math.degrees(COLD_BEND):.3g} and a hot one by "
                f"{math.degrees(HOT_BEND):.2g} degrees: `straight` above the one, `bent` below the other",
            )
        if all(self.candidate(p) is None for p in patterns):
            raise self._not_at_once(patterns[0])
        rows = ", ".join(map(str, patterns[0])) or "none"
        outcome.notes.append(
            f"row model: {len(patterns)} of {total} patterns {'has' if len(patterns) == 1 else 'have'} the shape, the "
            f"fewest heated rows are {rows}"
        )
        for pattern in patterns:
            heights = dict.fromkeys(pattern, 0)
            while (candidate := self.candidate(pattern, [self.levels[n] for n in heights.values()])) is not None:
                self.tell(candidate.text())
                if self.meets(candidate):
                    return
                bent = self._bent(self.ledger.judged(candidate))
                raised = [r for r in heights if r in bent and heights[r] + 1 < len(self.levels)]
                if not raised:
                    break
                heights |= {r: heights[r] + 1 for r in raised}

    def _not_at_once(self, rows: tuple[int, ...]) -> Impossible:
        """Why a pattern cannot be heated all at once by the closed forms."""
        own, time = [self._rig.rows[r - 1] for r in rows], self.deadline - LEAD
        power = sum(nearest_power(r, self.coolest, time) for r in own) / (1 - BELOW)
        volts = max(r.voltage_for(self.coolest, time) for r in own)
        return Impossible(
            f"voltage, power and time together: rows {', '.join(map(str, rows))} cannot be heated to "
            f"{self.coolest - 273.15:.3g} degC at once by {time:g} s",
            f"by then it takes {_upwards(volts)} V and {_upwards(power)} W; allowed are {self.voltage:.4g} V and "
            f"{self.power:.4g} W",
        )

    def _bent(self, entry: Entry) -> set[int]:
        """Rows that are to be straight and bend too much, or so much that other starts may.

        On the mean over the starts that are known: the first one may have the straightest rows of all.
        """
        if entry.failure:
            return set()
        room = self._room or (0.0,) * len(entry.distances)
        return {
            w.of
            for w, distance, least in zip(self.ledger.task.wanted, self.ledger.mean_distances(entry), room)
            if w.quantity == f"{self._rig.fabric}.row_bend"
            and isinstance(w.of, int)
            and w.below is not None
            and distance < least
        }

    def _cooler_rows(self, best: Candidate) -> None:
        """Each row as cool as it may be, from the tip to the root: the load falls towards the tip."""
        for place in reversed(range(len(best.pulses))):
            hots = [p.hot for p in best.pulses]
            if hots[place] <= self.coolest:
                continue
            hots[place] = self.coolest
            made = self.candidate(best.rows, hots)
            if made is None:
                continue
            self.tell(made.text())
            if not self.meets(made):
                return
            best = made

    def _screen(self, cold: Entry, outcome: Outcome) -> None:
        """Fit the row model to the cold run: rows that are hot at best straight."""
        sag = self._sag(cold)
        if sag is not None and sag > 0.0:
            outcome.chain = fitted(len(self._rig.rows), self._rig.held, taut_pitch(self._rig), sag, 0.0)

    def _is_hopeless(self, rows: tuple[int, ...], chain: Chain) -> bool:
        """Whether the cold rows alone sag more than is wanted, by a margin for the model."""
        most = [
            w.below.to("m") for w in self.ledger.task.wanted if w.quantity == f"{self._rig.fabric}.tip_sag" and w.below
        ]
        return bool(most) and SURE * chain.sag(rows) > min(most)

    def patterns(self) -> list[tuple[int, ...]]:
        """Patterns with most rows first; those at the root before others."""
        given = self.ledger.task.vary.rows_heated
        if given != "any":
            return sorted({tuple(sorted(set(p))) for p in given}, key=lambda p: (-len(p), p))
        free = self._rig.free
        return [free[:count] for count in range(len(free), 0, -1)]

    def accepted(self) -> list[Candidate]:
        """Designs that met the request, by the run that decided; those with room first, the cheapest of them first.

        Of those without it the one that has most of it comes first: fresh starts are least likely to reject it.
        """
        good = [c for c, e in self.ledger.decided().items() if e.fidelity != "short" and e.meets(self.counting)]
        roomy = [c for c, e in self.ledger.decided().items() if c in good and self.has_room(e)]
        others = self._cheapest([c for c in good if c not in roomy])
        return [*self._cheapest(roomy), *sorted(others, key=lambda c: -self._share_of_room(self.ledger.decided()[c]))]

    def _share_of_room(self, entry: Entry) -> float:
        """How much of the room a design has, where it has least of it."""
        known = self.ledger.mean_distances(entry)
        where = range(len(known)) if self.counting is None else self.counting
        return min(
            (
                known[n] / self._room[n]
                for n in where
                if self._room and self._room[n] > 0.0 and not math.isnan(known[n])
            ),
            default=math.inf,
        )

    def _cheapest(self, good: list[Candidate]) -> list[Candidate]:
        if self.ledger.task.least == "rows_heated":
            return sorted(good, key=lambda c: (len(c.rows), c.energy(self._rig)))
        return sorted(good, key=lambda c: c.energy(self._rig))

    def last_check(self, found: list[Candidate], outcome: Outcome) -> None:
        every = self.ledger.task.wanted
        wanted = every if self.counting is None else [every[n] for n in self.counting]
        outcome.counting = self.counting
        test = check_of(wanted)
        for candidate in found:
            # Of one programme for several delays, fresh starts are run once and say something about each.
            known = self._fresh.setdefault(candidate, [])
            checks: list[Entry] = []
            verdict = Verdict.OPEN
            self.tell(f"fresh starts of {candidate.text()}")
            try:
                while verdict is Verdict.OPEN:
                    number = max(1, min(self.ledger.batches.place.parallel, test.fewest - len(checks)))
                    if len(known) < len(checks) + number:
                        start = FRESH + self.ledger.count("full")
                        known += self.ledger.full_batch(candidate, range(start, start + number))
                    checks = known[: len(checks) + number]
                    met = sum(e.meets(self.counting) for e in checks)
                    verdict = test.verdict(met, len(checks) - met)
            except BudgetSpent as spent:
                outcome.notes.append(f"the last check ended early: {spent}")
            outcome.checked, outcome.checks, outcome.verdict = candidate, checks, verdict
            if verdict is Verdict.ACCEPTED:
                outcome.winner = candidate
                return
            if verdict is Verdict.OPEN:
                return
            outcome.notes.append(f"fresh starts rejected {candidate.text()}")

    def _run_nearest(self) -> None:
        """Run the design that came nearest with the scenario's own settings: a coarse run's number is off."""
        decided = [(e.worst(self.counting), c) for c, e in self.ledger.decided().items() if not e.failure]
        if not decided:
            return
        nearest = max(decided, key=lambda d: d[0])[1]
        if self.ledger.decided()[nearest].fidelity == "coarse":
            with contextlib.suppress(BudgetSpent):
                self.ledger.fine_batch(nearest, STARTS[:1])

    def unmet(self) -> Impossible:
        """What of the request no run met, and how near one came."""
        return shortfall(self.ledger, self.counting)

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


def check_of(wanted: Sequence[Wanted]) -> SequentialTest:
    """The sequential test of the last check: of the greatest share, with the stated error or a smaller one."""
    share = max(w.share for w in wanted)
    return SequentialTest(share, share - APART, min(ERROR, 1.0 - max(w.confidence for w in wanted) + 1e-12))


def taut_pitch(rig: Rig) -> float:
    """Pitch of the taut, cold weave of a fabric [m]."""
    return rig.weave.cold_weave.pitch


def _downwards(value: float) -> str:
    """Three digits, rounded downwards: a value that is said to be allowed must be so.

    >>> _downwards(16.248), _downwards(2.2)
    ('16.2', '2.2')
    """
    grain = 10.0 ** (math.floor(math.log10(value)) - 2)
    return f"{grain * math.floor(value / grain + 1e-9):.3g}"


def _upwards(value: float) -> str:
    """Three digits, rounded upwards: a value that is said to suffice must suffice.

    >>> _upwards(5.391), _upwards(2.2)
    ('5.4', '2.2')
    """
    grain = 10.0 ** (math.floor(math.log10(value)) - 2)
    return f"{grain * math.ceil(value / grain - 1e-9):.3g}"
