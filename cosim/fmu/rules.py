"""Rules of FMI that a description must keep, because without them a value goes to the wrong variable or is lost.

Other tools run FMUs that break lesser rules, so those are only warned of (`cosim.fmu.archive`).
"""

from __future__ import annotations

import re
from pathlib import Path

from fmpy.model_description import ModelDescription, ModelVariable

from cosim.fmu.sizes import StructureFault, check_shape
from cosim.fmu.types import TYPES
from cosim.unit.errors import InputError
from cosim.unit.protocol import VariableType

_LARGEST_REFERENCE = 2**32 - 1
#: Lexical forms of XML Schema's types, which FMI uses.
_NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?|[-+]?INF|NaN", re.ASCII)
_WHOLE = re.compile(r"[-+]?\d{1,40}", re.ASCII)
_TRUTH = re.compile("true|false|1|0")
_HEXADECIMAL = re.compile("([0-9A-Fa-f]{2})*")
_AGAIN = "correct it in the tool that made the FMU, and export it again"


def check_rules(path: Path, description: ModelDescription) -> None:
    """Judge the variables of a description.

    Args:
        path: The .fmu file, for the error.
        description: What fmpy has read, checked or not.

    Raises:
        InputError: A name is there twice, a value reference is no unsigned 32-bit number, an array is too large, or a
            start value is none of its type; with name and line of the variable.
    """
    if description.fmiVersion.startswith("1"):  # refused as such where it would be loaded, whatever else it breaks
        return
    first: dict[str, ModelVariable] = {}
    for v in description.modelVariables:
        other = first.setdefault(v.name, v)
        if other is not v:
            raise _broken(path, v, f"another variable has this name (line {other.sourceline})")
        if not 0 <= v.valueReference <= _LARGEST_REFERENCE:
            raise _broken(path, v, f"its value reference {v.valueReference} is outside 0 to {_LARGEST_REFERENCE}")
        if v.type not in TYPES:
            raise _broken(path, v, f"its type {v.type} is none of FMI 2.0 or 3.0")
        _check_shape(path, v)
        wrong = _wrong_start(v)
        if wrong is not None:
            raise _broken(path, v, f"its start value `{wrong[:40]}` is no {v.type}")


def _broken(path: Path, v: ModelVariable, problem: str) -> InputError:
    return InputError(path, f"modelDescription.xml: variable {v.name}, line {v.sourceline}", problem, _AGAIN)


def _check_shape(path: Path, v: ModelVariable) -> None:
    """With the sizes that the FMU itself gives; those of a user are judged where they are given."""
    try:
        check_shape(v.name, getattr(v, "shape", ()) or ())
    except StructureFault as error:
        key = f"modelDescription.xml: variable {v.name}, line {v.sourceline}"
        raise InputError(path, key, str(error), error.remedy) from error


def _wrong_start(v: ModelVariable) -> str | None:
    """The first start value that is none of the variable's type."""
    vtype = TYPES[v.type]
    if v.start is None or vtype in (VariableType.STRING, VariableType.CLOCK):
        return None
    if vtype is VariableType.BINARY:
        given, form = ([v.start] if isinstance(v.start, str) else list(v.start)), _HEXADECIMAL
    else:
        given = v.start.split()
        form = _TRUTH if vtype is VariableType.BOOLEAN else _NUMBER if vtype.is_float else _WHOLE
    if not given and vtype is not VariableType.BINARY:
        return str(v.start)
    return next((text for text in given if not form.fullmatch(text)), None)
