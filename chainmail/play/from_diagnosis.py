"""Where the findings of a diagnosis sit on a fabric, from diagnosis.json."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from chainmail.play.film import Fabric, Finding
from cosim.unit.errors import InputError

#: Its file in the folder of a diagnosis.
FILE = "diagnosis.json"
_ELEMENT = re.compile(r"^(?P<kind>[A-Za-z]\w*)\[(?P<index>\d+(,\d+)?)\]")


def findings_of(folder: Path, fabric: Fabric) -> tuple[tuple[Finding, ...], tuple[str, ...]]:
    """Findings with the links and coils that they name, and notes on those that name none of this fabric.

    Args:
        folder: Of a diagnosis.
        fabric: On which they are shown.

    Raises:
        InputError: The file cannot be read, or is no diagnosis.
    """
    path = folder / FILE
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        findings = placed(content["findings"], fabric)
        verdict = str(content["verdict"])
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(
            path, "", f"it cannot be read as a diagnosis: {error}", "give the folder that `cosim diagnose --out` wrote"
        ) from error
    notes = [f"{folder.name}: verdict `{verdict}`, {len(findings)} findings"]
    notes += [
        f"{folder.name}: `{f.place}` is at no link of this fabric, so nothing is marked"
        for f in findings
        if not f.links
    ]
    return findings, tuple(notes)


def placed(entries: Iterable[Mapping[str, Any]], fabric: Fabric) -> tuple[Finding, ...]:
    """Findings as diagnosis.json has them, with the links and coils that they name.

    Raises:
        KeyError: One lacks a key.
    """
    return tuple(_finding(entry, fabric) for entry in entries)


def _finding(entry: Mapping[str, Any], fabric: Fabric) -> Finding:
    place = str(entry["place"])
    coils, links = _places([*place.split(" and ")], fabric)
    if not links:
        coils, links = _places(map(str, entry["elements"]), fabric)
    intervals = tuple(
        (float(begin), float(end)) for begin, end in entry["intervals"] if begin is not None and end is not None
    )
    return Finding(str(entry["statement"]), place, links, coils, intervals, bool(entry["is_accepted"]))


def _places(names: Iterable[str], fabric: Fabric) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Coils and links, from 0, that names of elements stand for; coils only where single coils are meant."""
    coils: set[int] = set()
    links: set[int] = set()
    for name in names:
        if name.startswith(("all coils", "all strings", "all links")) or name == fabric.name:
            links |= set(range(fabric.links))
            continue
        match = _ELEMENT.match(name.strip())
        if match is None:
            continue
        own, whole = _element(match["kind"], tuple(int(i) for i in match["index"].split(",")), fabric)
        coils |= own
        links |= whole | {coil // 2 for coil in own}
    return tuple(sorted(coils)), tuple(sorted(links))


def _element(kind: str, index: tuple[int, ...], fabric: Fabric) -> tuple[set[int], set[int]]:
    """Coils and links of one element; strings are the rows of a fabric (docs/recordings.md, Places)."""
    in_row = 2 * int(fabric.place.max())
    first, rest = index[0], index[1:]
    if kind == "coil":
        coil = (first - 1) * in_row + rest[0] - 1 if rest else first - 1
        is_there = 0 <= coil < 2 * fabric.links and (not rest or 1 <= rest[0] <= in_row) and first >= 1
        return ({coil} if is_there else set()), set()
    if kind in ("string", "row"):
        return set(), {int(i) for i in np.flatnonzero(fabric.row == first)}
    if kind == "link":
        return set(), {first - 1} if 1 <= first <= fabric.links else set()
    if kind == "marker":  # two on the last link of every row
        is_last = (fabric.row == (first + 1) // 2) & (fabric.place == fabric.place.max())
        return set(), {int(i) for i in np.flatnonzero(is_last)}
    return set(), set()
