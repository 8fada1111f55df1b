"""What doubts about recordings mean for a diagnosis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from diagnosis.judge.diagnosis import Doubt, Finding

#: Kinds of doubts that are about a stretch of one sensor or input and not about the whole recording.
OF_A_STRETCH = ("sensor", "input")


def is_of_another_experiment(doubt: Doubt) -> bool:
    """Whether a doubt says that recording and scenario are not of the same experiment: nothing is searched then."""
    return doubt.is_serious and doubt.kind not in OF_A_STRETCH


def faults(doubts: Sequence[Doubt]) -> list[Doubt]:
    """Serious doubts about a stretch of a sensor or of an input."""
    return [d for d in doubts if d.is_serious and d.kind in OF_A_STRETCH]


def doubted(findings: Sequence[Finding], doubts: Sequence[Doubt]) -> tuple[Finding, ...]:
    """Findings, those of physics as suggestions where a sensor or an input was at fault: the fault may have made them.

    Args:
        findings: Of a search.
        doubts: About its recordings.
    """
    found = faults(doubts)
    if not found:
        return tuple(findings)
    why = f"first the fault has to be cleared: {found[0].statement.rstrip('.')}"
    return tuple(
        replace(f, is_accepted=False, doubts=(why, *f.doubts))
        if f.is_accepted and f.unit not in ("measurement", "input")
        else f
        for f in findings
    )
