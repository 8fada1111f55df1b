"""Results of a proof as tables in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from diagnosis.proof.aims import aims
from diagnosis.proof.result import CaseResult


def short(results: Sequence[CaseResult]) -> str:
    """A line for each aim."""
    return "\n".join(f"{'reached' if a.is_reached else 'missed '}  {a.name}: {a.share}, wanted {a.wanted}"
                     for a in aims(results))  # fmt: skip


def page_of(about: Sequence[dict[str, Any]], results: Sequence[CaseResult]) -> str:
    """The whole page."""
    return short(results)
