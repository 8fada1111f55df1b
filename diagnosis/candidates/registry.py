"""Every candidate of this folder: a file that defines `CANDIDATE` or `CANDIDATES` is part of the catalogue."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache
from pathlib import Path

from diagnosis.candidates.candidate import CandidateTerm

_UNITS = ("electrical", "thermal", "stiffness", "mechanical", "measurement")


@cache
def catalogue() -> tuple[CandidateTerm, ...]:
    """All candidates, named ones first, then by rank, unit and identifier.

    Raises:
        ValueError: Two candidates have one identifier.
    """
    found: list[CandidateTerm] = []
    for module in pkgutil.iter_modules([str(Path(__file__).resolve().parent)]):
        loaded = importlib.import_module(f"diagnosis.candidates.{module.name}")
        own = getattr(loaded, "CANDIDATE", None)
        found += [own] if own is not None else getattr(loaded, "CANDIDATES", ())
    identifiers = [term.identifier for term in found]
    twice = sorted({i for i in identifiers if identifiers.count(i) > 1})
    if twice:
        raise ValueError(f"the candidate {twice[0]} is defined twice")
    return tuple(sorted(found, key=lambda t: (not t.is_named, t.rank, _UNITS.index(t.unit), t.identifier)))


def candidate(identifier: str) -> CandidateTerm:
    """One candidate.

    Raises:
        KeyError: There is none of that name.
    """
    for term in catalogue():
        if term.identifier == identifier:
            return term
    raise KeyError(f"there is no candidate {identifier}")
