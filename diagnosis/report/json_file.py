"""diagnosis.json: a diagnosis key by key, and back."""

from __future__ import annotations

import json
import math
import types
from collections.abc import Mapping
from dataclasses import asdict, is_dataclass
from enum import Enum
from pathlib import Path
from typing import Any, Union, get_args, get_origin, get_type_hints

import numpy as np
from pydantic import TypeAdapter, ValidationError

from cosim.faults import words
from cosim.run_folder import write_atomically
from cosim.unit.errors import InputError
from diagnosis.judge.diagnosis import Diagnosis

_REMEDY = "give the diagnosis.json of this version's `cosim diagnose`; docs/diagnosis.schema.json tells its keys"


def write_json(diagnosis: Diagnosis, path: Path) -> None:
    """Write diagnosis.json as docs/diagnosis.schema.json has it; a number that is not finite becomes null."""
    text = json.dumps(as_json(diagnosis), indent=2, ensure_ascii=False, allow_nan=False)
    write_atomically(path, (text + "\n").encode())


def as_json(diagnosis: Diagnosis) -> dict[str, Any]:
    """The same as plain dictionaries, lists, strings, numbers and None."""
    plain: dict[str, Any] = _plain(asdict(diagnosis))
    return plain


def read_json(path: Path) -> Diagnosis:
    """Diagnosis of a file written by `write_json`; null becomes NaN where a number is expected.

    Raises:
        InputError: The file is none, or has other keys or types.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(path, "", f"cannot be read: {error.strerror}", _REMEDY) from error
    except ValueError as error:
        raise InputError(path, "", f"is no JSON: {error}", _REMEDY) from error
    prepared = _prepared(Diagnosis, content, "", path)
    try:
        return TypeAdapter(Diagnosis).validate_python(prepared)
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(str(part) for part in first["loc"])
        raise InputError(path, key, words(first), _REMEDY) from error


def _plain(value: Any) -> Any:
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _prepared(expected: Any, value: Any, key: str, path: Path) -> Any:
    """`value` with NaN for each null where `expected` is a float; keys that a dataclass does not have are refused."""
    if expected is float and value is None:
        return math.nan
    if is_dataclass(expected) and isinstance(value, dict):
        hints = get_type_hints(expected)
        unknown = sorted(set(value) - set(hints))
        if unknown:
            raise InputError(path, _within(key, unknown[0]), "is no key of a diagnosis", _REMEDY)
        return {k: _prepared(hints[k], v, _within(key, k), path) for k, v in value.items()}
    inner = get_args(expected)
    if get_origin(expected) is tuple and isinstance(value, list):
        types_of = [inner[0]] * len(value) if inner[-1] is Ellipsis else list(inner) + [Any] * len(value)
        return tuple(_prepared(t, v, _within(key, i), path) for i, (t, v) in enumerate(zip(types_of, value)))
    if get_origin(expected) is dict and isinstance(value, dict):
        return {k: _prepared(inner[1], v, _within(key, k), path) for k, v in value.items()}
    if get_origin(expected) in (Union, types.UnionType) and value is not None:
        named = [t for t in inner if t is not type(None)]
        return _prepared(named[0], value, key, path) if len(named) == 1 else value
    return value


def _within(key: str, name: object) -> str:
    return f"{key}.{name}" if key else str(name)
