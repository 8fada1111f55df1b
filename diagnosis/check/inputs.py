"""Recorded inputs beside programmes."""

from __future__ import annotations

from diagnosis.check.beside import Compared
from diagnosis.judge.diagnosis import Doubt


def input_doubts(compared: Compared) -> list[Doubt]:
    """TODO."""
    return []
