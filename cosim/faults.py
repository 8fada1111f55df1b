"""What is wrong with a value of a file, in words: the library that checks types reports kinds, this says them."""

from __future__ import annotations

import types
import typing
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel

from cosim.nearest import did_you_mean

Fault = Mapping[str, Any]

#: Characters of a wrong value that are shown.
_LONGEST = 60
_TEXT_AS_IS = 40


def shown(value: object) -> str:
    """A value as a message shows it: short, and as the file has it."""
    if value is None:
        return "an empty value"
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, Mapping):
        return f"a mapping with {_keys(value)}" if value else "an empty mapping"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}" if value else "an empty list"
    text = str(value) if len(str(value)) <= _LONGEST else f"{str(value)[:_TEXT_AS_IS]}..."
    return f"`{text}`"


def _keys(value: Mapping[Any, Any]) -> str:
    first = ", ".join(f"`{str(key)[:_TEXT_AS_IS]}`" for key in list(value)[:3])
    return f"the key{'s' if len(value) > 1 else ''} {first}{', ...' if len(value) > 3 else ''}"


def _is_not(what: str) -> Callable[[Fault], str]:
    return lambda fault: f"{shown(fault['input'])} is not {what}"


def _bound(words: str, key: str) -> Callable[[Fault], str]:
    return lambda fault: f"{shown(fault['input'])} must be {words} {fault['ctx'][key]:g}"


def _own_words(fault: Fault) -> str:
    return str(fault["ctx"]["error"]) if "error" in fault.get("ctx", {}) else str(fault["msg"]).partition(", ")[2]


def _choice(fault: Fault) -> str:
    options = [part.strip("'\" ") for part in str(fault["ctx"]["expected"]).replace(" or ", ", ").split(", ")]
    given = shown(fault["input"])
    return f"{given} is not possible here; it is one of: {', '.join(options)}{_hint(fault['input'], options)}"


def _tag(fault: Fault) -> str:
    tags = [tag.strip("' ") for tag in str(fault["ctx"]["expected_tags"]).split(",")]
    return (
        f"`kind` must be one of: {', '.join(tags)}, not {shown(fault['ctx']['tag'])}{_hint(fault['ctx']['tag'], tags)}"
    )


def _hint(given: object, known: Iterable[str]) -> str:
    return did_you_mean(given, known) if isinstance(given, str) else ""


def _count(words: str, key: str) -> Callable[[Fault], str]:
    return lambda fault: f"it needs at {words} {fault['ctx'][key]}, and it has {len(fault['input'])}"


#: Kind of a fault to its words. What the project's own checks raise is said as they say it.
_WORDS: dict[str, Callable[[Fault], str]] = {
    "missing": lambda fault: "this key is missing",
    "extra_forbidden": lambda fault: "there is no such key here",
    "invalid_key": lambda fault: f"{shown(fault['input'])} is no key; keys are text",
    "value_error": _own_words,
    "assertion_error": _own_words,
    "literal_error": _choice,
    "enum": _choice,
    "union_tag_invalid": _tag,
    "union_tag_not_found": lambda fault: (
        "the key `kind` is missing"
        if isinstance(fault["input"], Mapping)
        else f"{shown(fault['input'])} is not a mapping with the key `kind`"
    ),
    "string_type": _is_not("text; put it in quotes if it is meant as text"),
    "string_unicode": _is_not("text that can be read"),
    "string_too_short": _count("least", "min_length"),
    "string_too_long": _count("most", "max_length"),
    "string_pattern_mismatch": _is_not("a name; a name begins with a letter and has letters, digits and underscores"),
    "int_type": _is_not("a whole number"),
    "int_from_float": _is_not("a whole number"),
    "int_parsing": _is_not("a whole number"),
    "int_parsing_size": lambda fault: "this number is too large",
    "float_type": _is_not("a number"),
    "float_parsing": _is_not("a number"),
    "finite_number": _is_not("a finite number"),
    "bool_type": _is_not("true or false"),
    "bool_parsing": _is_not("true or false"),
    "list_type": _is_not("a list"),
    "tuple_type": _is_not("a list"),
    "set_type": _is_not("a list"),
    "iterable_type": _is_not("a list"),
    "dict_type": _is_not("a mapping of keys to values"),
    "mapping_type": _is_not("a mapping of keys to values"),
    "model_type": _is_not("a mapping of keys to values"),
    "model_attributes_type": _is_not("a mapping of keys to values"),
    "dataclass_type": _is_not("a mapping of keys to values"),
    "none_required": _is_not("empty"),
    "path_type": _is_not("a path"),
    "too_short": _count("least", "min_length"),
    "too_long": _count("most", "max_length"),
    "greater_than": _bound("greater than", "gt"),
    "greater_than_equal": _bound("at least", "ge"),
    "less_than": _bound("less than", "lt"),
    "less_than_equal": _bound("at most", "le"),
    "multiple_of": _bound("a multiple of", "multiple_of"),
    "recursion_loop": lambda fault: "it contains itself",
}
#: Kinds that only say what a value is not. Of the members of a union another one says more.
_WEAK = frozenset(kind for kind in _WORDS if kind.endswith(("_type", "_from_float")))


def words(fault: Fault, model: type[BaseModel] | None = None) -> str:
    """What is wrong, in a sentence without its key.

    Args:
        fault: One entry of `pydantic.ValidationError.errors()`.
        model: What the file was checked against; a key that does not exist is compared with those that do.
    """
    text = _WORDS.get(str(fault["type"]), _is_not("possible here"))(fault)
    if fault["type"] == "extra_forbidden" and model is not None and fault["loc"]:
        text += did_you_mean(str(fault["loc"][-1]), known_keys(model, fault["loc"][:-1]))
    return text


def is_weak(fault: Fault) -> bool:
    """Whether the fault only says what the value is not."""
    return str(fault["type"]) in _WEAK


def known_keys(model: type[BaseModel], place: Sequence[int | str]) -> list[str]:
    """Keys that a mapping of a file may have.

    Args:
        model: What the whole file is checked against.
        place: Keys that lead to the mapping; of a union the tag of its member too, as pydantic reports it.
    """
    return [key for annotation in _levels(model, place)[-1] for key in _fields(annotation)]


def places_in_lists(model: type[BaseModel], place: Sequence[int | str]) -> list[bool]:
    """Which of the steps that lead to a fault are places in a list: a whole number may also be a key of a mapping."""
    return [
        isinstance(step, int)
        and any(get_origin(m) in (list, tuple) for annotation in found for m in _members(annotation))
        for step, found in zip(place, _levels(model, place))
    ]


def tags_of_members(model: type[BaseModel], place: Sequence[int | str]) -> list[bool]:
    """Which of the steps that lead to a fault are the tag of a member of a union, which is no key of the file."""
    told = []
    for step, found in zip(place, _levels(model, place)):
        models = [m for annotation in found for m in _members(annotation) if _is_model(m)]
        is_key = len(models) == 1 and step in models[0].model_fields  # of a tag one member is left, and keys follow
        told.append(not is_key and any(_has_tag(m, step) for m in models))
    return told


def _levels(model: type[BaseModel], place: Sequence[int | str]) -> list[list[Any]]:
    """Annotations of what stands before each step, and after the last one."""
    found: list[list[Any]] = [[model]]
    for step in place:
        found.append([inner for annotation in found[-1] for inner in _inside(annotation, step)])
    return found


def _members(annotation: Any) -> list[Any]:
    """The annotation without `Annotated`; of a union every member."""
    if get_origin(annotation) is typing.Annotated:
        return _members(get_args(annotation)[0])
    if get_origin(annotation) in (typing.Union, types.UnionType):
        return [m for a in get_args(annotation) for m in _members(a)]
    return [annotation]


def _fields(annotation: Any) -> list[str]:
    return [k for m in _members(annotation) if _is_model(m) for k, f in m.model_fields.items() if not f.exclude]


def _is_model(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def _inside(annotation: Any, step: int | str) -> list[Any]:
    """What stands under a key, or at a place of a list; a step that is the tag of a union leads to that member."""
    members = _members(annotation)
    models = [m for m in members if _is_model(m)]
    if len(models) > 1 and (tagged := [m for m in models if _has_tag(m, step)]):
        return tagged  # also where a member has a key of that name: `fmu` is a kind and a key of it
    found: list[Any] = []
    for member in members:
        if _is_model(member):
            if step in member.model_fields:
                found.append(member.model_fields[str(step)].annotation)
            elif _has_tag(member, step):
                found.append(member)
        elif get_origin(member) is dict:
            found.append(get_args(member)[1])
        elif get_origin(member) in (list, tuple) and isinstance(step, int):
            found += get_args(member)
    return found or members


def _has_tag(member: type[BaseModel], step: int | str) -> bool:
    kind = member.model_fields.get("kind")
    return member.__name__ == step or (
        kind is not None and get_origin(kind.annotation) is Literal and step in get_args(kind.annotation)
    )
