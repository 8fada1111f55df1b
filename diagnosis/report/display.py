"""Numbers and foreign text as people read them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit import Array

#: SI unit to factor and unit for differences (RMSE, residuals): the same for all channels, so that rows compare.
_DIFFERENCES = {"A": (1e3, "mA"), "V": (1e3, "mV"), "W": (1e3, "mW"), "m": (1e3, "mm")}
#: SI unit to factor and unit for values below 1.
_SMALL = {"A": (1e3, "mA"), "W": (1e3, "mW"), "m": (1e3, "mm")}
_KELVIN = 273.15
UNKNOWN = "\N{EN DASH}"


def difference(unit: str) -> tuple[float, str]:
    """Factor from SI and unit in which differences are shown: differences of degC are K."""
    return _DIFFERENCES.get(unit, (1.0, symbol(unit)))


@dataclass(frozen=True)
class Axis:
    """How values of one figure are shown: `factor * value + offset` in `unit`."""

    factor: float
    offset: float
    unit: str

    def __call__(self, values: Array) -> Array:
        """Values from SI."""
        return values * self.factor + self.offset


def axis(measured: Array, unit: str) -> Axis:
    """Temperatures in degC, small currents, powers and lengths in mA, mW and mm, all else in SI."""
    if unit == "K":
        return Axis(1.0, -_KELVIN, "°C")
    largest = float(np.nanmax(np.abs(measured), initial=0.0))
    factor, name = _SMALL.get(unit, (1.0, symbol(unit))) if largest < 1.0 else (1.0, symbol(unit))
    return Axis(factor, 0.0, name)


def symbol(unit: str) -> str:
    """Unit as printed; nothing for a pure number."""
    return "" if unit == "1" else unit


def number(value: float, digits: int = 3) -> str:
    """A number with so many significant digits; a dash where it is not known.

    >>> number(0.012345), number(123456.0), number(2e-7)
    ('0.0123', '123000', '2.00e-07')
    """
    if not math.isfinite(value):
        return UNKNOWN if math.isnan(value) else ("-" if value < 0 else "") + "∞"
    if value == 0.0:
        return "0"
    size = math.floor(math.log10(abs(float(f"{value:.{digits - 1}e}"))))
    if not -4 <= size < 6:
        return f"{value:.{digits - 1}e}"
    return f"{round(value, digits - 1 - size):.{max(digits - 1 - size, 0)}f}"


def interval(value: float, lower: float, upper: float, unit: str) -> str:
    """An estimate with its interval, as many digits as the interval deserves.

    >>> interval(0.31234, 0.28111, 0.34999, "ohm")
    '0.312 ohm (0.281 to 0.350)'
    """
    width = upper - lower
    if not (math.isfinite(width) and width > 0.0 and math.isfinite(value)):
        texts = [number(v, 4) for v in (value, lower, upper)]
    else:
        biggest = max(abs(v) for v in (value, lower, upper))
        digits = min(max(2 + math.floor(math.log10(biggest)) - math.floor(math.log10(width)), 3), 9)
        decimals = digits - 1 - math.floor(math.log10(biggest))
        is_plain = 1e-4 <= biggest < 1e6
        texts = [f"{v:.{max(decimals, 0)}f}" if is_plain else f"{v:.{digits - 1}e}" for v in (value, lower, upper)]
    return f"{texts[0]} {symbol(unit)}".strip() + f" ({texts[1]} to {texts[2]})"


def percent(probability: float) -> str:
    """A probability; the ends are not rounded to certainty.

    >>> percent(0.9999), percent(0.0), percent(0.123)
    ('> 99.9 %', '< 0.1 %', '12 %')
    """
    if not math.isfinite(probability):
        return UNKNOWN
    share = 100.0 * probability
    if share > 99.9:
        return "> 99.9 %"
    if share < 0.1:
        return "< 0.1 %"
    return f"{share:.0f} %" if 1.0 <= share <= 99.0 else f"{share:.1f} %"


def span(begin: float, end: float) -> str:
    """An interval of time, or an instant."""
    if begin == end:
        return f"at {number(begin)} s"
    return f"{number(begin)} to {number(end)} s"


def duration(seconds: float) -> str:
    """Wall time."""
    return f"{seconds:.1f} s" if seconds < 120.0 else f"{seconds / 60.0:.1f} min"


def words(effect: str) -> str:
    """An identifier in words; a parameter that the model has already is called so.

    >>> words("base:reference_resistance"), words("second_mass")
    ("the model's own reference resistance", 'second mass')
    """
    text = clean(effect).replace("_", " ")
    return f"the model's own {text.removeprefix('base:')}" if text.startswith("base:") else text


def clean(text: str) -> str:
    """Foreign text without control characters: a title must neither steer a terminal nor break a page."""
    return "".join(c if c.isprintable() else " " for c in text).strip()


def listed(names: Sequence[str], most: int) -> str:
    """Names joined, the last ones counted only."""
    kept = ", ".join(clean(n) for n in names[:most])
    return kept if len(names) <= most else f"{kept} and {len(names) - most} more"
