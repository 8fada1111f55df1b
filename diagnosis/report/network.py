"""The network of coils, as far as a report draws it, and which of its elements a finding concerns."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from diagnosis.judge.diagnosis import Diagnosis, Finding

_ELEMENT = re.compile(r"^(?P<kind>supply|string|coil)(\[(?P<index>\d+(,\d+)*)\])?")


@dataclass(frozen=True)
class Network:
    """Strings in parallel across the supply.

    Args:
        strings: Coils of every string; empty where there is no network.
    """

    strings: tuple[int, ...] = ()


@dataclass(frozen=True)
class Concerned:
    """What to mark.

    Args:
        coils: (string, place in it), from 1.
        strings: Numbers, from 1.
        supply: Whether the supply is concerned.
    """

    coils: frozenset[tuple[int, int]] = frozenset()
    strings: frozenset[int] = frozenset()
    supply: bool = False

    def __bool__(self) -> bool:
        return bool(self.coils or self.strings or self.supply)


def inferred(diagnosis: Diagnosis) -> Network:
    """The smallest network that holds all elements that a diagnosis names; none if it names no coil of a string."""
    names = [f.channel for f in diagnosis.fit]
    names += [n for finding in diagnosis.findings for n in (*finding.elements, *finding.channels)]
    found = [_parsed(n) for n in names]
    coils = [index for kind, index in found if kind == "coil" and len(index) == 2]
    if not coils:
        return Network()
    strings = max([s for s, _ in coils] + [index[0] for kind, index in found if kind == "string" and index])
    return Network((max(place for _, place in coils),) * strings)


def concerned(finding: Finding, network: Network) -> Concerned:
    """Elements of the network that a finding is about: its place where that names one, else its elements."""
    if finding.place.startswith("all coils"):  # also on one day alone
        every = ((s, c) for s, count in enumerate(network.strings, 1) for c in range(1, count + 1))
        return Concerned(frozenset(every))
    place = _marked([finding.place], network)
    return place or _marked(finding.elements, network)


def _marked(names: Iterable[str], network: Network) -> Concerned:
    coils, strings, supply = set(), set(), False
    for kind, index in (_parsed(part) for name in names for part in name.split(" and ")):
        if kind == "supply":
            supply = True
        elif kind == "string" and index and index[0] <= len(network.strings):
            strings.add(index[0])
        elif kind == "coil" and len(index) == 2 and _exists(index, network):
            coils.add((index[0], index[1]))
    return Concerned(frozenset(coils), frozenset(strings), supply)


def _exists(index: tuple[int, ...], network: Network) -> bool:
    return 1 <= index[0] <= len(network.strings) and 1 <= index[1] <= network.strings[index[0] - 1]


def _parsed(name: str) -> tuple[str, tuple[int, ...]]:
    match = _ELEMENT.match(name)
    if match is None:
        return "", ()
    return match["kind"], tuple(int(i) for i in (match["index"] or "").split(",") if i)
