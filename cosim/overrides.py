"""`--set key=value`: one key of a scenario replaced on the command line, checked like the file itself."""

from __future__ import annotations

import copy
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cosim.nearest import did_you_mean
from cosim.unit.errors import InputError
from cosim.yaml_file import parse_yaml

_EXAMPLE = 'write it like `--set time.stop="5 s"`, or with the name of a component: `--set fabric.rows=8`'
#: A key, a name in double quotes that may hold dots, or a place in a list.
_PART = re.compile(r'"(?P<quoted>[^"]+)"|(?P<key>[^.\[\]"]+)|\[(?P<place>\d+)\]')
#: A key to the one that it stands in place of: a programme's output has either.
_INSTEAD = {"constant": "points", "points": "constant"}


def with_changes(data: object, changes: Sequence[str], keys: Sequence[str]) -> Any:
    """The content of a scenario with keys replaced or added.

    Args:
        data: Content of the scenario file.
        changes: `key=value`; keys are separated by dots, `[2]` is the second entry of a list, a name with dots stands
            in double quotes, and a key that begins with the name of a component means `components.NAME`. The value is
            YAML, as in the file.
        keys: First keys that a scenario may have.

    Raises:
        InputError: A change has no key or no value, its key leads nowhere, or its value is no YAML.
    """
    changed = copy.deepcopy(data)
    for change in changes:
        key, equals, text = change.partition("=")
        if not equals or not key.strip():
            raise InputError(f"--set {change}", "", "a key, an equals sign and a value are needed", _EXAMPLE)
        value = parse_yaml(text, Path(f"--set {change}"))
        if value is None:
            raise InputError(f"--set {change}", "", "there is no value behind the equals sign", _EXAMPLE)
        _put(changed, _with_places_of_names(_path(change, key.strip(), changed, keys), changed), value, change)
    return changed


def _path(change: str, key: str, data: Any, keys: Sequence[str]) -> list[str | int]:
    parts: list[str | int] = []
    at = 0
    while at < len(key):
        match = _PART.match(key, at)
        if match is None:
            raise InputError(
                f"--set {change}", "", f"`{key}` is no key: what follows `{key[:at]}` cannot be read", _EXAMPLE
            )
        parts.append(int(match["place"]) if match["place"] else match["quoted"] or match["key"].strip())
        at = match.end()
        if key[at : at + 1] == "." and at + 1 < len(key):
            at += 1
    components = data.get("components") if isinstance(data, dict) else None
    names = list(components) if isinstance(components, dict) else []
    if parts[0] in names and parts[0] not in keys:
        return ["components", *parts]
    if parts[0] not in keys:
        raise InputError(
            f"--set {change}",
            "",
            f"a scenario has no key `{parts[0]}` and this one no such component"
            f"{did_you_mean(str(parts[0]), [*keys, *names])}",
            f"begin with one of: {', '.join([*keys, *map(str, names)])}",
        )
    return parts


def _with_places_of_names(path: list[str | int], data: Any) -> list[str | int]:
    """The path with `heat_loss`, `[10]` as the one name `heat_loss[10]` where a parameter of a component is meant.

    Parameters of single links, and elements of arrays of FMUs, have such names; a list of values keeps its places.
    """
    if len(path) < 3 or path[-3] != "parameters" or not isinstance(path[-1], int):
        return path
    place = data
    for part in path[:-1]:
        place = place.get(part) if isinstance(place, dict) else None
    return path if isinstance(place, list) else [*path[:-2], f"{path[-2]}[{path[-1]}]"]


def _put(data: Any, path: Sequence[str | int], value: object, change: str) -> None:
    place = data
    for i, part in enumerate(path[:-1]):
        place = _step(place, part, path[:i], change)
    last = path[-1]
    if isinstance(last, int) or not isinstance(place, dict):
        _step(place, last, path[:-1], change)  # refuses what is not there
        place[int(last) - 1] = value
        return
    if last in _INSTEAD and _INSTEAD[last] in place:
        del place[_INSTEAD[last]]
    place[last] = value


def _step(place: Any, part: str | int, before: Sequence[str | int], change: str) -> Any:
    """What stands under a key; a mapping that is not there yet is made."""
    where = ".".join(map(str, before)) or "the scenario"
    if isinstance(part, int):
        if not isinstance(place, list) or not 1 <= part <= len(place):
            there = f"has {len(place)} entries" if isinstance(place, list) else "is no list"
            raise InputError(f"--set {change}", "", f"{where} {there}, so there is no [{part}]", "entries count from 1")
        return place[part - 1]
    if not isinstance(place, dict):
        raise InputError(f"--set {change}", "", f"{where} holds no keys, so there is no `{part}` in it", _EXAMPLE)
    if before == ["components"] and part not in place:
        raise InputError(
            f"--set {change}",
            "",
            f"there is no component `{part}`{did_you_mean(str(part), place)}",
            f"there are: {', '.join(map(str, place))}",
        )
    return place.setdefault(part, {})
