"""Values as a scenario gives them to arrays of an FMU's type, shape and unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from cosim.fmu.units import UnitNames, is_known
from cosim.fmu.variables import FmuVariable
from cosim.unit.protocol import AnyArray, VariableType
from cosim.unit.quantity import PhysicalValue

_DISPLAY = re.compile(r"^\s*(?P<number>[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?)\s*(?P<unit>\S.*?)\s*$")
#: Whole numbers up to this are exact as floating-point numbers.
_EXACT = 2**53


def array_of(variable: FmuVariable, value: Any, units: UnitNames) -> AnyArray:
    """A value or nested lists of values as an array of the variable's shape; one value fills it.

    Args:
        variable: What it is for.
        value: Bare numbers are in the FMU's own unit; `PhysicalValue` is converted; text is for String, for Binary
            (hexadecimal), for Enumeration (name of an item), or a number with one of the FMU's display units.
        units: Units that the FMU declares.

    Raises:
        ValueError: It does not fit type, unit, range or shape; the text says how.
    """
    v = variable.variable
    if not v.shape and v.type.is_float and isinstance(value, PhysicalValue | float):  # most parameters of most FMUs
        return np.array(_number(variable, value, units), dtype=v.type.dtype)
    given = value.tolist() if isinstance(value, np.ndarray) else value
    flat, shape = _flatten(given)
    if shape not in ((), (1,), v.shape):
        wanted = " x ".join(map(str, v.shape)) or "one value"
        raise ValueError(f"{' x '.join(map(str, shape))} values do not fit; it takes {wanted}")
    elements = [_element(variable, e, units) for e in flat]
    result: AnyArray = np.empty(v.shape, dtype=v.type.dtype)
    if len(elements) == 1:
        result.fill(elements[0])
    else:
        result.flat[:] = elements
    return result


def _flatten(value: Any) -> tuple[list[Any], tuple[int, ...]]:
    if not isinstance(value, Sequence) or isinstance(value, str | bytes):
        return [value], ()
    parts = [_flatten(element) for element in value]
    shapes = {shape for _, shape in parts}
    if len(shapes) > 1:
        raise ValueError("its rows have different lengths")
    inner = shapes.pop() if shapes else ()
    return [e for elements, _ in parts for e in elements], (len(parts), *inner)


def _element(variable: FmuVariable, value: Any, units: UnitNames) -> Any:
    vtype = variable.variable.type
    if vtype.is_float:
        return _number(variable, value, units)
    if vtype is VariableType.STRING:
        return _text(value)
    if vtype is VariableType.BINARY:
        return _binary(value)
    if vtype is VariableType.BOOLEAN:
        if not isinstance(value, bool | np.bool_):
            raise ValueError(f"{value} is no Boolean; write true or false")
        return bool(value)
    if vtype is VariableType.ENUMERATION:
        return _item(variable, value)
    if vtype is VariableType.CLOCK:
        raise ValueError("a clock takes no value; connect it")
    return _whole(value, np.iinfo(vtype.dtype))


def _number(variable: FmuVariable, value: Any, units: UnitNames) -> float:
    unit = variable.variable.unit
    if isinstance(value, PhysicalValue):
        if is_known(unit):
            return value.to(unit)
        if value.unit:
            raise ValueError(f"`{value}`: the FMU's unit `{unit}` is not known here, so only a bare number fits")
        return value.number
    if isinstance(value, str):
        match = _DISPLAY.match(value)
        if match and match["unit"] == units.declared(variable.declared[0]):
            return float(match["number"])
        found = units.from_display(variable.declared[0], float(match["number"]), match["unit"]) if match else None
        if found is None:
            raise ValueError(f"`{value}` is no number with a unit that converts to {unit}")
        return found
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | float | np.number):
        raise ValueError(f"{value} is no number")
    return float(value)


def _whole(value: Any, limits: Any) -> int:
    if isinstance(value, PhysicalValue):
        if value.unit:
            raise ValueError(f"`{value}`: a whole number takes no unit")
        if value.text.strip().lstrip("+-").isdigit():
            number = int(value.text)
        elif abs(value.number) > _EXACT or value.number != round(value.number):
            raise ValueError(f"`{value}` is no whole number, or too large to be exact: put it in quotes")
        else:
            number = round(value.number)
    elif isinstance(value, int | np.integer) and not isinstance(value, bool):
        number = int(value)
    elif isinstance(value, float) and value == round(value):
        number = round(value)
    else:
        raise ValueError(f"{value} is no whole number")
    if not limits.min <= number <= limits.max:
        raise ValueError(f"{number} is outside {limits.min} to {limits.max}")
    return number


def _text(value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, PhysicalValue) and value.text:
        return value.text
    raise ValueError(f"{value} is no text; put it in quotes")


def _binary(value: Any) -> bytes:
    if isinstance(value, bytes):
        return value
    try:
        return bytes.fromhex(_text(value))
    except ValueError as error:
        raise ValueError(f"`{value}` is no binary data; write its bytes in hexadecimal, in quotes") from error


def _item(variable: FmuVariable, value: Any) -> int:
    items = variable.items
    text = value.text if isinstance(value, PhysicalValue) else value
    if isinstance(text, str) and text in items:
        return items[text]
    known = ", ".join(f"{name} ({number})" for name, number in items.items())
    try:
        number = _whole(value, np.iinfo(np.int64))
    except ValueError as error:
        raise ValueError(f"`{value}` is no item; there are: {known}") from error
    if items and number not in items.values():
        raise ValueError(f"{number} is no item; there are: {known}")
    return number
