"""Numbers and foreign text as people read them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from cosim.unit.quantity import conversion, parse_unit

#: SI unit to factor and unit for differences (RMSE, residuals): the same for all channels, so that rows compare.
_DIFFERENCES = {"A": (1e3, "mA"), "V": (1e3, "mV"), "W": (1e3, "mW"), "m": (1e3, "mm")}
#: SI unit to factor and unit for values below 1.
_SMALL = {"A": (1e3, "mA"), "W": (1e3, "mW"), "m": (1e3, "mm")}
#: 0 degC [K].
_KELVIN = 273.15
#: Share of the end of an interval below which its begin is 0: a clock that is a hair off is no begin.
NOTHING = 1e-4
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


def likelihood(value: float) -> str:
    """A difference of log likelihoods: at most 1 decimal and 4 significant digits.

    >>> likelihood(5.678), likelihood(987.65), likelihood(123456.7), likelihood(1234567.8)
    ('5.7', '987.6', '123500', '1.235e+06')
    """
    return f"{value:.1f}" if abs(value) < 999.95 else number(value, 4)


def instant(value: float, digits: int = 4) -> str:
    """A time without needless zeros, and without an exponent where people write none.

    >>> instant(6.0), instant(43200.0), instant(0.3125)
    ('6', '43200', '0.3125')
    """
    text = f"{value:.{digits}g}"
    return number(value, digits) if "e" in text else text


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


#: Scales of temperature and the unit in which differences on them are shown.
_TEMPERATURES = {"K": "K", "degC": "K", "celsius": "K", "degree_Celsius": "K", "degF": "°F", "fahrenheit": "°F"}
_BASE_UNIT = re.compile(r"[^\W\d_]+")


def user_unit(unit: str, written: Iterable[str]) -> str:
    """Unit for a quantity by what the user wrote elsewhere; the SI unit where nothing that was written fits.

    A unit of the same kind is taken as it is, the first one that was written; else the units that a compound consists
    of are replaced one by one. A temperature within a compound is a difference, so it stays in K.

    Args:
        unit: SI unit of the quantity.
        written: Units of channels and of parameters of the scenario, as written.

    >>> user_unit("m", ["degC", "mm"]), user_unit("m/N", ["mm"]), user_unit("W/K", ["mA"])
    ('mm', 'mm/N', 'W/K')
    """
    known: dict[str, str] = {}
    for text in written:
        kind = _kind(text)
        if kind:
            known.setdefault(kind, text)
    if _kind(unit) in known:
        return known[_kind(unit)]
    parts = {"m", "s", "A", "V", "W", "N", "kg", "J", "ohm", "rad"}
    return _BASE_UNIT.sub(lambda m: known.get(_kind(m[0]), m[0]) if m[0] in parts else m[0], unit)


def _kind(unit: str) -> str:
    """Dimension of a unit; empty for pure numbers and for what is no unit."""
    try:
        found = parse_unit(unit)
    except ValueError:
        return ""
    # An angle has no dimension, but it is no pure number either.
    return "angle" if str(found) in ("radian", "degree") else "" if found.dimensionless else str(found.dimensionality)


def user_scale(unit: str, preferred: str, is_difference: bool = False) -> tuple[float, float, str]:
    """Factor and offset from SI, and the unit as printed; SI where the preferred unit does not fit.

    Args:
        unit: SI unit.
        preferred: Unit as the user wrote it; may be empty.
        is_difference: Whether values are differences (a bias, a step): differences of degC are K.
    """
    if not preferred or preferred == unit:
        return 1.0, 0.0, symbol(unit)
    try:
        factor, offset = conversion(unit, preferred)
    except ValueError:
        return 1.0, 0.0, symbol(unit)
    if preferred not in _TEMPERATURES:
        return factor, offset, symbol(preferred)
    printed = (
        _TEMPERATURES[preferred] if is_difference else {"degF": "°F", "fahrenheit": "°F", "K": "K"}.get(preferred, "°C")
    )
    return factor, 0.0 if is_difference else offset, printed


def user_value(value: float, unit: str, preferred: str, is_difference: bool = False) -> str:
    """A quantity in the unit that the user wrote.

    >>> user_value(0.0015, "m", "mm"), user_value(295.15, "K", "degC"), user_value(1.6, "K", "degC", True)
    ('1.50 mm', '22.0 °C', '1.60 K')
    """
    factor, offset, printed = user_scale(unit, preferred, is_difference)
    return f"{number(factor * value + offset)} {printed}".strip()


def user_interval(
    value: float, lower: float, upper: float, unit: str, preferred: str, is_difference: bool = False
) -> str:
    """An estimate with its interval in the unit that the user wrote; see `interval`.

    >>> user_interval(3.1e-4, 2.8e-4, 3.4e-4, "m", "mm")
    '0.310 mm (0.280 to 0.340)'
    """
    factor, offset, printed = user_scale(unit, preferred, is_difference)
    return interval(factor * value + offset, factor * lower + offset, factor * upper + offset, printed)


#: Parameters of a model in words.
_PARAMETERS: Mapping[str, str] = {
    "capacity": "heat capacity",
    "specific_heat": "specific heat",
    "conductance": "heat transfer (h A)",
    "cooling_rate": "cooling rate while the power is off",
    "reference_resistance": "resistance at the reference temperature",
    "heating_a": "rise of the stiffness on the heating branch",
    "heating_d": "stiffness when cold",
    "cooling_a": "rise of the stiffness on the cooling branch",
    "heating_shift": "temperature of the heating branch",
    "cooling_shift": "temperature of the cooling branch",
    "transformation_shift": "transformation temperature",
    "load": "load",
    "power_gain": "heating power",
    "ambient_offset": "room temperature",
    "initial_temperature": "initial temperature",
}


def moved(name: str, value: float, is_relative: bool, unit: str, preferred: str = "") -> str:
    """By how much a parameter of the model was moved by its recalibration.

    Args:
        name: Of the parameter: `capacity`, `coil[2,1].load`, `ambient_offset of recording 2`.
        value: Factor where it is relative, else the change, SI.
        is_relative: See there.
        unit: SI unit of the parameter.
        preferred: Unit as the user wrote it.

    >>> moved("capacity", 3.82, True, "J/K"), moved("coil[2,1].transformation_shift", 1.6, False, "K")
    ("heat capacity: 3.82 times the scenario's value", 'transformation temperature of coil[2,1]: +1.60 K')
    """
    told = parameter_words(name)
    if is_relative:
        # No scenario states the lag of a sensor: the factor counts from the typical lag below the stated bound.
        base = "what was assumed" if name.startswith("lag of ") else "the scenario's value"
        return f"{told}: {number(value)} times {base}"
    sign = "+" if value > 0 else ""
    return f"{told}: {sign}{user_value(value, unit, preferred, is_difference=True)}"


def parameter_words(name: str) -> str:
    """A parameter of the model in words, with the place at its end.

    >>> parameter_words("coil[2,1].capacity"), parameter_words("ambient_offset of recording 2")
    ('heat capacity of coil[2,1]', 'room temperature of recording 2')
    >>> parameter_words("room.c_air")
    'room.c_air'
    """
    text = clean(name)
    place, _, field = text.rpartition(".") if re.fullmatch(r"[^\s.]+\.\w+", text) else ("", "", text)
    if place and field not in _PARAMETERS:  # of an FMU: as its scenario and its documents call it
        return text
    own, of, rest = field.partition(" of ")
    told = _PARAMETERS.get(own, own.replace("_", " "))
    return f"{told} of {place}" if place else f"{told}{of}{rest}"


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
    """An interval of time, or an instant.

    >>> span(2.4e-4, 198000.0), span(39999.8, 40000.0), span(0.5, 2.0)
    ('0 to 198000 s', 'at 40000 s', '0.500 to 2.00 s')
    """
    first, last = ends(begin, end)
    return f"{first} to {last} s" if first != last else f"at {last} s"


def ends(begin: float, end: float) -> tuple[str, str]:
    """Both ends of an interval as numbers; a begin that is next to nothing of the end is 0."""
    return number(begin if abs(begin) >= NOTHING * abs(end) else 0.0), number(end)


def duration(seconds: float) -> str:
    """Wall time."""
    return f"{seconds:.1f} s" if seconds < 120.0 else f"{seconds / 60.0:.1f} min"


def words(effect: str) -> str:
    """An identifier in words; a parameter that the model has already is called so, and a law without a name too.

    >>> words("base:reference_resistance"), words("second_mass"), words("unnamed_value_square")
    ("the model's own reference resistance", 'second mass', 'a law without a name (value square)')
    """
    text = clean(effect).replace("_", " ")
    if text.startswith("unnamed "):
        return f"a law without a name ({text.removeprefix('unnamed ')})"
    return f"the model's own {text.removeprefix('base:')}" if text.startswith("base:") else text


def clean(text: str) -> str:
    """Foreign text without control characters: a title must neither steer a terminal nor break a page."""
    return "".join(c if c.isprintable() else " " for c in text).strip()


def listed(names: Sequence[str], most: int) -> str:
    """Names joined, the last ones counted only."""
    kept = ", ".join(clean(n) for n in names[:most])
    return kept if len(names) <= most else f"{kept} and {len(names) - most} more"
