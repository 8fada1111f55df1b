"""One line of the scorecard."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class Row:
    """A published value beside ours.

    Args:
        section: Group in the table.
        quantity: What is compared.
        published: The paper's value as it prints it, or what it states in words.
        ours: Our value in `unit`; a number.
        unit: Unit of `ours`.
        target: Number that `ours` is compared with; None where the paper states only a relation.
        tolerance: Largest accepted |ours - target|, or None where `is_met` was decided by the relation.
        reason: Why this tolerance.
        is_met: Whether it passes.
        explanation: Why the two differ, where they do.
        band: 5 and 95 % over the starts; None for a single run.
        starts: How many starts there are.
        median: Their median where the starts are other runs than ours; None where `ours` is their median.
    """

    section: str
    quantity: str
    published: str
    ours: float
    unit: str
    target: float | None
    tolerance: float | None
    reason: str
    is_met: bool
    explanation: str = ""
    band: tuple[float, float] | None = None
    starts: int = 1
    median: float | None = None

    def as_dict(self) -> dict[str, Any]:
        """For JSON; a value that is not finite becomes null."""
        found = {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in asdict(self).items()}
        if self.band is not None:
            found["band"] = [v if math.isfinite(v) else None for v in self.band]
        return found


def compare(
    section: str,
    quantity: str,
    published: str,
    ours: float,
    target: float,
    unit: str,
    tolerance: float,
    reason: str,
    explanation: str = "",
) -> Row:
    """A row that passes if |ours - target| <= tolerance (never with NaN)."""
    is_met = abs(ours - target) <= tolerance
    return Row(section, quantity, published, ours, unit, target, tolerance, reason, is_met, explanation)


def relation(
    section: str,
    quantity: str,
    published: str,
    ours: float,
    unit: str,
    is_met: bool,
    reason: str,
    explanation: str = "",
) -> Row:
    """A row for a statement in words."""
    return Row(section, quantity, published, ours, unit, None, None, reason, bool(is_met), explanation)
