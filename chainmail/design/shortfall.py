"""Why no design was found: the limit that fewest designs reached, and what came nearest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from chainmail.design.candidate import Candidate
from chainmail.design.impossible import Impossible
from chainmail.design.ledger import Entry, Ledger
from cosim.unit.quantity import PhysicalValue


def shortfall(ledger: Ledger, counting: Sequence[int] | None) -> Impossible:
    """The limit that fewest designs reached, told with the design that came nearest.

    Distances to bounds are compared as shares of the bounds, since their units differ. Coarse runs count only where no
    other run reached its end, or for a design by what decided about it.

    Args:
        ledger: Every run of the search; none of its designs was accepted.
        counting: Numbers of the requirements that count; None: all.
    """
    entries = [e for e in ledger.entries if not e.failure]
    complete = [e for e in entries if e.fidelity != "coarse"] or entries
    if not complete:
        reasons = "; ".join(dict.fromkeys(" ".join(e.failure.split()) for e in ledger.entries))
        return Impossible(f"no run reached its end: {reasons}", "correct the scenario")
    runs = _runs(ledger, entries)
    numbers = range(len(ledger.task.wanted)) if counting is None else counting
    known = [n for n in numbers if not all(np.isnan(e.distances[n]) for e in complete)]
    reached = {n: sum(any(e.distances[n] >= 0.0 for e in own) for own in runs.values()) for n in known}
    nearest = _nearest(ledger, complete, known)
    rarest = min(known, key=lambda n: (reached[n], ledger.scaled(nearest, [n]) or [np.inf]))
    limit, tried = ledger.task.wanted[rarest].text(), len({e.candidate for e in ledger.entries})
    if not reached[rarest]:
        most = max(runs, key=lambda c: len(c.rows)).rows
        widest = f", of which one heats rows {', '.join(map(str, most))}" if most else ""
        return Impossible(
            f"{limit}: no run of {tried} designs reached it{widest}",
            f"the nearest was {_value(ledger, nearest, rarest)} with {nearest.candidate.text()}",
        )
    limit = f"{limit}: {reached[rarest]} of {tried} designs reached it"
    whole = {c: sum(e.meets(known) for e in own) for c, own in runs.items()}
    if any(whole.values()):
        best = max(whole, key=lambda c: whole[c] / len(runs[c]))
        return Impossible(
            f"{limit}, and none was accepted",
            f"{whole[best]} of {len(runs[best])} runs of this design met all that they tell of: {best.text()}",
        )
    closest = _nearest(ledger, [e for own in runs.values() for e in own if e.distances[rarest] >= 0.0], known)
    missed = min(known, key=lambda n: ledger.scaled(closest, [n]) or [np.inf])
    return Impossible(
        f"{limit}, none of them in a run that met all else",
        f"of these the nearest missed {ledger.task.wanted[missed].text()} with {_value(ledger, closest, missed)}: "
        f"{closest.candidate.text()}",
    )


def _runs(ledger: Ledger, entries: Sequence[Entry]) -> dict[Candidate, list[Entry]]:
    """Complete runs of every design; of one that has coarse ones alone what decided about it."""
    found: dict[Candidate, list[Entry]] = {}
    for entry in entries:
        if entry.fidelity != "coarse":
            found.setdefault(entry.candidate, []).append(entry)
    decided = ledger.decided()
    for entry in entries:
        found.setdefault(entry.candidate, [decided.get(entry.candidate, entry)])
    return found


def _nearest(ledger: Ledger, entries: Sequence[Entry], numbers: Sequence[int]) -> Entry:
    """The run whose worst distance, as a share of the bound, is best."""
    return max(entries, key=lambda e: min(ledger.scaled(e, numbers), default=-np.inf))


def _value(ledger: Ledger, entry: Entry, number: int) -> PhysicalValue:
    """What a run had, corrected as its distance is; with as many digits as tell it from the bound."""
    wanted, unit = ledger.task.wanted[number], ledger.units[number]
    bound = wanted.below or wanted.above
    assert bound is not None
    limit, distance = bound.to(unit), entry.distances[number]
    value = limit - distance if wanted.below is not None else limit + distance
    rounded = (float(f"{value:.{digits}g}") for digits in (4, 7))
    return PhysicalValue(next((v for v in rounded if v != limit), value), unit)
