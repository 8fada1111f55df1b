"""Keys of a scenario as dotted paths: `supply.outputs.voltage.points[2][2]`, `fabric.parameters.friction`."""

from __future__ import annotations

import copy
import re
from collections.abc import Mapping
from typing import Any

from cosim.nearest import did_you_mean

_INDEX = re.compile(r"\[(\d+)\]")
#: Below these keys the rest of a path is one name: variables of FMUs have dots and brackets of their own.
_NAMES = ("parameters", "start", "structure")


def parts_of(key: str, data: Mapping[str, Any]) -> list[str | int]:
    """Parts of a path: names, and places in lists counted from 0.

    Args:
        key: As written; `components.` may be left out before the name of a component.
        data: Content of the scenario.

    Raises:
        ValueError: It is no path.
    """
    parts: list[str | int] = []
    pieces = key.split(".")
    components = data.get("components")
    known = components if isinstance(components, dict) else {}
    if pieces[0] in known and pieces[0] != "components":
        pieces.insert(0, "components")
    while pieces:
        piece = pieces.pop(0)
        name = _INDEX.sub("", piece)
        if not name or "[" in name or "]" in name or piece != name + "".join(f"[{i}]" for i in _INDEX.findall(piece)):
            raise ValueError(f"`{key}` is no path of keys; write for example `fabric.parameters.friction`")
        parts.append(name)
        for index in _INDEX.findall(piece):
            if int(index) < 1:
                raise ValueError(f"`{key}`: elements of a list are counted from 1")
            parts.append(int(index) - 1)
        if name in _NAMES and len(parts) == 3 and parts[0] == "components" and pieces:
            parts.append(".".join(pieces))
            break
    return parts


def changed(data: Any, assignments: Mapping[str, Any]) -> Any:
    """The scenario's content with other values; what was given stays as it was.

    Args:
        data: Content of the scenario.
        assignments: Path to value.

    Raises:
        ValueError: A path leads nowhere: there is no such component, no such place in a list, or a single value
            stands where the path goes on.
    """
    result = copy.deepcopy(data)
    for key, value in assignments.items():
        _assign(result, parts_of(key, result), copy.deepcopy(value), key)
    return result


def _assign(data: Any, parts: list[str | int], value: Any, key: str) -> None:
    place = data
    if parts[0] == "components" and len(parts) > 1 and parts[1] not in (data.get("components") or {}):
        there = ", ".join(data.get("components") or {}) or "none"
        raise ValueError(f"`{key}`: there is no component `{parts[1]}` (there: {there})")
    for number, part in enumerate(parts):
        is_last = number + 1 == len(parts)
        if isinstance(part, int):
            if not isinstance(place, list) or part >= len(place):
                size = (
                    f"it has {len(place)} elements" if isinstance(place, list) else f"`{parts[number - 1]}` is no list"
                )
                raise ValueError(f"`{key}`: there is no element {part + 1}: {size}")
        elif not isinstance(place, dict):
            raise ValueError(f"`{key}`: `{part}` cannot stand below a single value or a list")
        elif part not in place and not is_last and isinstance(parts[number + 1], int):
            top = parts[1] if parts[0] == "components" and len(parts) > 1 else parts[0]
            if number and top not in data and top not in (data.get("components") or {}):
                known = [*data, *(data.get("components") or {})]
                raise ValueError(f"`{key}`: there is no key or component `{top}`{did_you_mean(str(top), known)}")
            there = ", ".join(map(str, place)) or "nothing"
            raise ValueError(f"`{key}`: there is no list `{part}` (there: {there})")
        elif not is_last and part not in place:
            # A scenario may leave out `parameters`, `solver`, ...; what does not exist is refused when it is read.
            place[part] = {}
        if is_last:
            place[part] = value
        else:
            place = place[part]
