"""What a search found."""

from __future__ import annotations

from dataclasses import dataclass, field

from chainmail.design.candidate import Candidate
from chainmail.design.ledger import Entry
from chainmail.design.row_model import Chain
from chainmail.design.sequential import Verdict
from cosim.unit.quantity import PhysicalValue


@dataclass(frozen=True)
class Point:
    """One point of a front: what was found for one delay.

    Args:
        delay: From the first switch until the fabric is rigid.
        design: The design of least energy that fresh starts accepted, or else the one that was checked last; None:
            none met the request within the search.
        checks: Runs of it on fresh starts.
        verdict: Of the sequential test.
        counting: Numbers of the requirements that count for this delay.
        notes: What a reader must know of how it was found.
    """

    delay: PhysicalValue
    design: Candidate | None
    checks: tuple[Entry, ...]
    verdict: Verdict
    counting: tuple[int, ...]
    notes: tuple[str, ...] = ()


@dataclass
class Outcome:
    """What a search found.

    Args:
        winner: The design that the last check accepted; None: none was accepted.
        checked: The design that was checked last.
        checks: Full runs of it, on fresh starts.
        verdict: Of the sequential test.
        chain: The row model that screened.
        notes: What a reader must know of how the search ended.
        counting: Numbers of the requirements that count; None: all.
        points: Of a front; empty where none is asked for.
    """

    winner: Candidate | None = None
    checked: Candidate | None = None
    checks: list[Entry] = field(default_factory=list)
    verdict: Verdict = Verdict.OPEN
    chain: Chain | None = None
    notes: list[str] = field(default_factory=list)
    counting: tuple[int, ...] | None = None
    points: list[Point] = field(default_factory=list)
