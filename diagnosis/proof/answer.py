"""What was concealed in a case: the proving ground's answer, read for scoring alone."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Concealed:
    """An effect that a case hides.

    Args:
        effect: Identifier.
        unit: Unit that it belongs to.
        is_in_catalogue: Whether the catalogue has an entry for it.
        is_hidden: Whether that entry was taken away from the diagnosis.
        strength: `weak`, `medium` or `strong`.
        place: Kind of place.
        elements: Coils or strings, counted from 1; empty: all.
        channels: Of a fault of sensors.
        parameters: True values, SI.
        comparable: Names of those that the catalogue's entry has too.
        instant: When it sets in [s], or None.
    """

    effect: str
    unit: str
    is_in_catalogue: bool
    is_hidden: bool
    strength: str
    place: str
    elements: tuple[str, ...]
    channels: tuple[str, ...]
    parameters: Mapping[str, float]
    comparable: tuple[str, ...]
    instant: float | None

    @property
    def is_known(self) -> bool:
        """Whether the diagnosis could have named it."""
        return self.is_in_catalogue and not self.is_hidden


@dataclass(frozen=True)
class Answer:
    """The truth about a case.

    Args:
        case: Its name.
        kind: Kind of case.
        setup: Rig.
        engine: What moved the loads or the arm.
        verdicts: Verdicts that are right.
        effects: What is concealed.
    """

    case: str
    kind: str
    setup: str
    engine: str
    verdicts: tuple[str, ...]
    effects: tuple[Concealed, ...]


def read_answer(path: Path) -> Answer:
    """Read `answers/<case>.json`."""
    given = json.loads(path.read_text())
    effects = tuple(
        Concealed(
            f["effect"], f["unit"], f["is_in_catalogue"], f["is_hidden"], f["strength"], f["place"],
            tuple(f["elements"]), tuple(f["channels"]), f["parameters"], tuple(f["comparable_parameters"]),
            f["intervals"][0][0] if f["intervals"] else None,
        )
        for f in given["findings"]
    )  # fmt: skip
    return Answer(given["case"], given["kind"], given["setup"], given["engine"], tuple(given["verdicts"]), effects)
