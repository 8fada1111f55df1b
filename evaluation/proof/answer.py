"""What was concealed in a case: the proving ground's answer, read for scoring alone."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any


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
        instant: When it sets in [s], on the clock of its recording, or None.
        recording: Title of the recording in which it sets in; empty: of all of them, or not told.
        order: Place of that recording in time, from 1; 0: not told.
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
    recording: str = ""
    order: int = 0

    @property
    def is_known(self) -> bool:
        """Whether the diagnosis could have named it."""
        return self.is_in_catalogue and not self.is_hidden


@dataclass(frozen=True)
class Sabotage:
    """How recordings and scenario of a case are not of one experiment.

    Args:
        kind: Its name.
        titles: Of the recordings that are concerned.
        channels: That are concerned.
        begin: Begin of the stretch [s].
        end: End of the stretch [s].
        same_as: Effects of the catalogue that say the same in other words.
        units: Units to which something without a name may be put down; of models that are structurally wrong.
    """

    kind: str
    titles: tuple[str, ...]
    channels: tuple[str, ...]
    begin: float
    end: float
    same_as: tuple[str, ...] = ()
    units: tuple[str, ...] = ()


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
        sabotage: What is wrong with recordings or scenario, or None.
        room: How far the surroundings of all recordings are off what is written down [K]; None where it is not told.
    """

    case: str
    kind: str
    setup: str
    engine: str
    verdicts: tuple[str, ...]
    effects: tuple[Concealed, ...]
    sabotage: Sabotage | None = None
    room: float | None = None


def read_answer(path: Path) -> Answer:
    """Read `answers/<case>.json`."""
    given = json.loads(path.read_text())
    effects = tuple(
        Concealed(
            f["effect"],
            f["unit"],
            f["is_in_catalogue"],
            f["is_hidden"],
            f["strength"],
            f["place"],
            tuple(f["elements"]),
            tuple(f["channels"]),
            f["parameters"],
            tuple(f["comparable_parameters"]),
            *_begin(f["intervals"]),
        )
        for f in given["findings"]
    )
    return Answer(
        given["case"],
        given["kind"],
        given["setup"],
        given["engine"],
        tuple(given["verdicts"]),
        effects,
        _sabotage(given.get("sabotage")),
        given.get("rig", {}).get("room"),
    )


def _begin(intervals: Sequence[Any] | None) -> tuple[float | None, str, int]:
    """When and in which recording something sets in; proofs of before had one instant for all recordings."""
    if not intervals:
        return None, "", 0
    first = intervals[0]
    if isinstance(first, Mapping):
        return first["begin"], first["title"], first["order"]
    return first[0], "", 0


def _sabotage(given: Mapping[str, Any] | None) -> Sabotage | None:
    if given is None:
        return None
    lists = {n: tuple(given[n]) for n in ("titles", "channels", "same_as", "units")}
    return Sabotage(kind=given["kind"], begin=given["begin"], end=given["end"], **lists)
