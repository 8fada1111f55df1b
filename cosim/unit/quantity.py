"""Physical values as a person writes them (`6 V`, `22 degC`) and as the code needs them (SI floats)."""

from __future__ import annotations

import contextlib
import functools
import math
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import platformdirs
from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticSerializationUnexpectedValue, core_schema


@contextlib.contextmanager
def _hidden(*packages: str) -> Iterator[None]:
    """Let an import believe that these packages are not installed, where nobody has imported them yet."""
    names = [name for name in packages if name not in sys.modules]
    sys.modules.update(dict.fromkeys(names))  # type: ignore[arg-type]  # None: how Python marks what is not to be found
    try:
        yield
    finally:
        for name in names:
            del sys.modules[name]


# pint imports them, to handle arrays that nothing here has: a fifth of the time of `cosim validate`.
with _hidden("dask", "scipy"):
    import pint
    from pint.util import string_preprocessor

#: Longest text of a unit, and what none contains: a number to some power, or one of many digits. pint would compute it;
#: `9**9**9**9` ends with the memory of the machine.
_LONGEST_UNIT = 1000
_COSTLY = re.compile(r"(?<![\w.])[\d.]+[\s)]*\*\*|(?<![\w.])\d{7}")
#: Coulomb and farad where a temperature is asked for, and what is meant.
_TEMPERATURES = {"C": "degC", "F": "degF"}
_TEXT = re.compile(r"^\s*(?P<number>[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?)\s*(?P<unit>.*?)\s*$")
_PATTERN = r"^\s*[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?\s*.*$"


@functools.cache
def registry() -> pint.UnitRegistry[Any]:
    """The unit registry, made once; its definitions, once parsed, are kept in the user's cache."""
    folder = platformdirs.user_cache_path("active-chainmail", appauthor=False) / "units"
    try:
        return pint.UnitRegistry(autoconvert_offset_to_baseunit=True, cache_folder=folder)
    except Exception:  # no room, no permission, a damaged file: pickle and pint raise many unrelated kinds
        return pint.UnitRegistry(autoconvert_offset_to_baseunit=True)


@functools.cache
def parse_unit(text: str) -> pint.Unit:
    """A unit; `1` and an empty text are dimensionless.

    Raises:
        ValueError: pint does not know it.
    """
    if len(text) > _LONGEST_UNIT:
        raise ValueError(f"`{text[:20]} ...` is not a unit: it has {len(text)} letters")
    if _COSTLY.search(string_preprocessor(text)):
        raise ValueError(f"`{text}` is not a unit: powers are of units, and small")
    try:
        return registry().Unit("" if text.strip() in ("", "1") else text)
    except Exception as error:  # pint raises several unrelated kinds, also for malformed text
        raise ValueError(f"`{text}` is not a unit that is known here{_in_small_letters(text)}") from error


def _in_small_letters(text: str) -> str:
    """`Volt` is a slip for `volt`; empty where small letters are no unit either."""
    try:
        registry().Unit(text.lower())
    except Exception:  # as above
        return ""
    return f"; did you mean `{text.lower()}`?"


@functools.cache
def turns(source: str, target: str) -> float:
    """What pint leaves out between cycles and angles: 2 pi from Hz to rad/s, its inverse back, else 1.

    Hz counts cycles, and a cycle is a turn of 2 pi rad; to pint hertz and rad/s are both 1/s. Only where exactly one
    of two units is written with hertz and the other with an angle in its place is the factor certain; 1/s stays 1/s.
    Decision record 0016.

    >>> turns("Hz", "rad/s"), turns("rpm", "Hz"), turns("1/s", "Hz"), turns("N*m", "N*m/rad")
    (6.283185307179586, 0.15915494309189535, 1.0, 1.0)
    """
    first, second = (cycles_and_angles(text) for text in (source, target))
    cycles, angles = first[0] - second[0], second[1] - first[1]
    return float((2.0 * math.pi) ** cycles) if cycles and cycles == angles else 1.0


@functools.cache
def cycles_and_angles(text: str) -> tuple[float, float]:
    """Powers of hertz as written, and of radian in base units; raises ValueError for an unknown unit."""
    unit = parse_unit(text)
    written: dict[str, Any] = dict(unit._units)
    cycles = sum(float(power) for name, power in written.items() if name.endswith("hertz"))
    base: dict[str, Any] = dict(registry().get_root_units(unit)[1]._units)
    return cycles, float(base.get("radian", 0.0))


@functools.cache
def conversion(source: str, target: str) -> tuple[float, float]:
    """(factor, offset) with target value = factor * source value + offset.

    Raises:
        ValueError: The units measure different things.

    >>> conversion("mm", "m"), conversion("Hz", "rad/s")
    ((0.001, 0.0), (6.28318530717959, 0.0))
    """
    if source == target:
        return 1.0, 0.0
    first, second = parse_unit(source), parse_unit(target)
    if first.dimensionality != second.dimensionality:
        raise ValueError(f"{source} cannot be converted to {target}")
    offset = float(registry().Quantity(0.0, first).to(second).magnitude)
    factor = float(registry().Quantity(1.0, first).to(second).magnitude) - offset
    return float(f"{factor * turns(source, target):.15g}"), float(f"{offset:.15g}")


@dataclass(frozen=True)
class PhysicalValue:
    """A number with its unit, as written.

    Args:
        number: The number.
        unit: The unit as written; empty for a pure number.
        text: The whole text as written, where it was text.
    """

    number: float
    unit: str
    text: str = field(default="", compare=False)

    @classmethod
    def parse(cls, value: object) -> PhysicalValue:
        """From `6 V` or a bare number.

        Raises:
            ValueError: It is neither, or is not finite.
        """
        if isinstance(value, PhysicalValue):
            return value
        if isinstance(value, int | float) and not isinstance(value, bool):
            try:
                number = float(value)
            except OverflowError:
                raise ValueError(f"a whole number of {len(str(value))} digits is too large") from None
            if not math.isfinite(number):
                raise ValueError(f"{value} is not a finite number")
            return cls(number, "")
        match = _TEXT.match(value) if isinstance(value, str) else None
        if match is None:
            raise ValueError(f"{value!r} is not a number with a unit, such as `1.5 mm`")
        parse_unit(match["unit"])
        if not math.isfinite(float(match["number"])):
            raise ValueError(f"`{value}` is not a finite number")
        return cls(float(match["number"]), match["unit"], str(value))

    def to(self, unit: str) -> float:
        """The number in another unit; in its own unit it is the number as written, to the last bit.

        Raises:
            ValueError: The units measure different things, or a dimensional value was written without a unit.
        """
        if self.unit and self.unit == unit:
            return self.number
        if not self.unit and parse_unit(unit).dimensionality != parse_unit("1").dimensionality:
            raise _without_unit(self.number, unit)
        given, asked = parse_unit(self.unit), parse_unit(unit)
        if given == asked:
            return self.number
        try:
            wanted = registry().Quantity(self.number, given).to(asked)
        except (pint.PintError, ArithmeticError) as error:
            meant = _TEMPERATURES.get(self.unit, "") if asked.dimensionality == parse_unit("K").dimensionality else ""
            hint = f"; write `{self.number:g} {meant}`" if meant else ""
            raise ValueError(f"`{self}` is no quantity in {unit}{hint}") from error
        number = float(wanted.magnitude) * turns(self.unit, unit)
        if not math.isfinite(number):
            raise ValueError(f"`{self}` is too large for a number in {unit}")
        # Through a decimal of 15 digits, so that 22 degC is 295.15 K and 0.1 ms is 1e-4 s, without binary debris.
        return float(f"{number:.15g}")

    def __str__(self) -> str:
        short = f"{self.number:.15g}"
        return f"{short if float(short) == self.number else repr(self.number)} {self.unit}".strip()


def _serialise(value: object) -> str:
    if not isinstance(value, PhysicalValue):  # lets pydantic try the next member of a union
        raise PydanticSerializationUnexpectedValue(f"{value!r} is no PhysicalValue")
    return str(value)


def _without_unit(number: float, unit: str) -> ValueError:
    return ValueError(f"{number:g} has no unit; write for example `{number:g} {unit}`")


@dataclass(frozen=True)
class In:
    """Pydantic annotation: a `PhysicalValue` that converts to `unit`, within bounds.

    Args:
        unit: SI unit that it must convert to; None accepts any unit.
        minimum: Smallest value in `unit`.
        is_exclusive: Whether the minimum itself is refused.
        usual: Unit in which a number without one was probably meant, for the error; default: `unit`.
    """

    unit: str | None = None
    minimum: float | None = None
    is_exclusive: bool = False
    usual: str = ""

    def _validate(self, value: object) -> PhysicalValue:
        parsed = PhysicalValue.parse(value)
        if self.usual and parsed.unit in ("", "1"):
            raise _without_unit(parsed.number, self.usual)
        if self.unit is not None:
            number = parsed.to(self.unit)
            if self.minimum is not None and (number < self.minimum or (self.is_exclusive and number == self.minimum)):
                relation = "greater than" if self.is_exclusive else "at least"
                raise ValueError(f"`{parsed}` must be {relation} {self.minimum:g} {self.unit}")
        return parsed

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(
            self._validate, serialization=core_schema.plain_serializer_function_ser_schema(_serialise)
        )

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        about = f"A number with a unit that converts to {self.unit}." if self.unit else "A number with its unit."
        text: JsonSchemaValue = {"type": "string", "pattern": _PATTERN}
        if self.unit in ("1", None):
            return {"anyOf": [{"type": "number"}, text], "description": about}
        return {**text, "description": about}
