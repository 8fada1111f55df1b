"""YAML files that a user writes: read strictly, with every fault named by its key."""

from __future__ import annotations

import re
from collections.abc import Hashable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import pydantic
import yaml

from cosim.faults import is_weak, places_in_lists, shown, tags_of_members, words
from cosim.unit.errors import InputError

#: What pydantic puts into the place of a fault for a member of a union; it is no key of the file.
_MEMBER = re.compile(r"^(bool|constrained-str|function-plain\[.*|union\[.*|list\[.*|float|int|str|\[key\])$")

Model = TypeVar("Model", bound=pydantic.BaseModel)
#: Levels that a file may have; and marks of a level in the text up to which nothing can be nested too deeply.
DEEPEST, SAFE = 100, 2000
_NESTING = ("[", "{", "- ", "? ", ": ")


class _UniqueKeyLoader(yaml.CSafeLoader):
    """YAML keeps the last of two equal keys silently; here it is an error. In C: ten times as fast."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        seen: set[Any] = set()
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if not isinstance(key, Hashable):
                raise yaml.constructor.ConstructorError(None, None, "a list or mapping is no key", key_node.start_mark)
            if key in seen:
                raise yaml.constructor.ConstructorError(
                    None, None, f"the key `{key}` stands twice", key_node.start_mark
                )
            seen.add(key)
        return super().construct_mapping(node, deep)


def refuse_pipe(path: Path, remedy: str) -> None:
    """Refuse a named pipe or a device in the place of a file: one waits for a writer, the other may have no end.

    Raises:
        InputError: It is one.
    """
    if path.is_fifo():
        raise InputError(path, "", "it is a pipe and no file", remedy)
    if path.is_char_device() or path.is_block_device():
        raise InputError(path, "", "it is a device and no file", remedy)


def read_text(path: Path) -> str:
    """Text of a file.

    Raises:
        InputError: It cannot be read.
    """
    refuse_pipe(path, "give a YAML file")
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        what = f"its byte {error.start + 1} is no UTF-8"
        raise InputError(path, "", what, "give a YAML file, saved as UTF-8") from error
    except OSError as error:
        raise InputError(path, "", f"it cannot be read: {error.strerror}", "give a YAML file") from error


def parse_yaml(text: str, source: Path) -> Any:
    """Content of YAML text.

    Raises:
        InputError: It is no YAML, or a key stands twice; the text names line and column.
    """
    try:
        if sum(map(text.count, _NESTING)) > SAFE:
            _check_depth(text, source)
        return yaml.load(text, Loader=_UniqueKeyLoader)  # a SafeLoader
    except (yaml.YAMLError, ValueError) as error:  # ValueError: an impossible date, which YAML takes for a value
        mark = getattr(error, "problem_mark", None)
        where = f"line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        raise InputError(source, where, f"not valid YAML: {getattr(error, 'problem', error)}", "correct it") from error
    except RecursionError as error:
        raise InputError(source, "", "not valid YAML: nested too deeply", "correct it") from error


def read_model(path: Path, model: type[Model], what: str, remedy: str, without: str = "") -> Model:
    """A file of one kind, checked.

    Args:
        path: The file.
        model: What it is checked against.
        what: What the file is, in words: "a sweep is a mapping with the keys title, axes".
        remedy: What to do about a wrong key or value.
        without: What to do where the file holds no mapping; default: `remedy`.

    Raises:
        InputError: It cannot be read, or a key or value is wrong; all faults are listed, each with its key.
    """
    data = parse_yaml(read_text(path), path)
    if not isinstance(data, dict):
        raise InputError(path, "", what, without or remedy)
    try:
        return model.model_validate(data)
    except pydantic.ValidationError as error:
        raise input_error(path, error, remedy, model) from error


def _check_depth(text: str, source: Path) -> None:
    """Refuse what is nested so deeply that a parser in C, which calls itself for each level, would end the process."""
    depth = 0
    for event in yaml.parse(text, Loader=yaml.CSafeLoader):
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        if depth > DEEPEST:
            raise InputError(source, "", f"not valid YAML: nested more than {DEEPEST} deep", "correct it")


def input_error(
    source: Path, error: pydantic.ValidationError, remedy: str, model: type[pydantic.BaseModel] | None = None
) -> InputError:
    """All faults of a file, one per key.

    Args:
        source: The file.
        error: What pydantic found.
        remedy: What to do.
        model: What the file was checked against; with it a key that does not exist is compared with those that do.
    """
    faults: dict[str, str] = {}
    weak: set[str] = set()
    for fault in error.errors():
        key = _key(fault["loc"], model)
        # Of the members of a union the one that reads numbers says most; the others only say what they are not.
        is_other_member = fault["type"] in ("bool_type", "list_type", "model_type") and len(fault["loc"]) > 1
        if key not in faults or (key in weak and not is_other_member):
            faults[key] = _message(fault, model)
            (weak.add if is_weak(fault) else weak.discard)(key)
    # Where a mapping has a wrong key, that it is none of the other members of a union says nothing.
    weak = {k for k in weak if any(other.startswith((f"{k}.", f"{k}[")) for other in faults)}
    (key, message), *rest = ((k, text) for k, text in faults.items() if k not in weak)
    more = "".join(f"\n  also {other}: {text}" for other, text in rest)
    return InputError(source, key, message + more, remedy)


def _key(place: Sequence[int | str], model: type[pydantic.BaseModel] | None) -> str:
    """Keys of the file that lead to a fault, for example `components.fabric.rows`, `connections[2].factor`."""
    # pydantic inserts the kind of a component, an element, a law, an algorithm; no key of the file stands there.
    is_tag = tags_of_members(model, place) if model is not None else [False] * len(place)
    is_place = places_in_lists(model, place) if model is not None else [isinstance(p, int) for p in place]
    text = ""
    for i, part in enumerate(place):
        if is_tag[i] or (isinstance(part, str) and _MEMBER.match(part)):
            continue
        if isinstance(part, int) and is_place[i]:
            text += f"[{part + 1}]"  # what a user reads counts from 1
        else:
            text += f".{part}" if text else str(part)
    return text


def _message(fault: Any, model: type[pydantic.BaseModel] | None) -> str:
    if fault["type"] == "string_pattern_mismatch" and fault["loc"][0] == "connections":
        return f"{shown(fault['input'])} is no connection; write `component.output -> component.input`"
    return words(fault, model)
