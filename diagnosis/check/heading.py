"""Names of columns as people write them: a quantity, its number and its unit."""

from __future__ import annotations

import re
from dataclasses import dataclass

from cosim.unit.quantity import parse_unit
from diagnosis.recording.units import si_unit

#: How a unit may be spelled at the end of a column's name: spelling to unit and SI unit of its quantity.
SPELLINGS = {
    "degc": ("degC", "K"),
    "°c": ("degC", "K"),
    "celsius": ("degC", "K"),
    "c": ("degC", "K"),
    "degf": ("degF", "K"),
    "°f": ("degF", "K"),
    "kelvin": ("K", "K"),
    "k": ("K", "K"),
    "a": ("A", "A"),
    "ma": ("mA", "A"),
    "ua": ("uA", "A"),
    "v": ("V", "V"),
    "mv": ("mV", "V"),
    "w": ("W", "W"),
    "mw": ("mW", "W"),
    "kw": ("kW", "W"),
    "m": ("m", "m"),
    "cm": ("cm", "m"),
    "mm": ("mm", "m"),
    "um": ("um", "m"),
    "rad": ("rad", "rad"),
    "deg": ("deg", "rad"),
    "°": ("deg", "rad"),
    "rad/s": ("rad/s", "rad/s"),
    "deg/s": ("deg/s", "rad/s"),
    "n": ("N", "N"),
    "mn": ("mN", "N"),
    "n/m": ("N/m", "N/m"),
    "n/mm": ("N/mm", "N/m"),
    "ohm": ("ohm", "ohm"),
    "kohm": ("kohm", "ohm"),
    "s": ("s", "s"),
    "ms": ("ms", "s"),
    "us": ("us", "s"),
    "min": ("min", "s"),
    "h": ("h", "s"),
    "1/m": ("1/m", "1/m"),
    "pa": ("Pa", "Pa"),
    "hpa": ("hPa", "Pa"),
    "kpa": ("kPa", "Pa"),
    "mbar": ("mbar", "Pa"),
    "bar": ("bar", "Pa"),
    "rpm": ("rpm", "rad/s"),
    "u/min": ("rpm", "rad/s"),
    "kg": ("kg", "kg"),
    "l/min": ("L/min", "m^3/s"),
    "%": ("%", "1"),
    "percent": ("%", "1"),
}
_NAME = re.compile(r"^\s*(?P<body>.*?)\s*[\[(]\s*(?P<unit>[^\])]*)\s*[\])]\s*$")
#: A quantity over its unit (ISO 80000-1, 7.1.4: `p/kPa`, `n/(1/min)`), and a quantity in its unit: `p in kPa`.
_OVER = re.compile(r"^\s*(?P<body>[^/]+?)\s*(?:/\s*\(?|\s+in\s+)(?P<unit>[^()]+?)\)?\s*$")


@dataclass(frozen=True)
class Heading:
    """What the name of a column says.

    Args:
        name: As it stands.
        body: The same without its unit.
        word: Letters at its begin, small.
        numbers: Numbers in it.
        unit: As recording.yaml has it; None where the name has none.
        si_unit: SI unit of its quantity; None likewise.
    """

    name: str
    body: str
    word: str
    numbers: tuple[int, ...]
    unit: str | None
    si_unit: str | None


def heading(name: str) -> Heading:
    """Read the name of a column.

    >>> heading("T2_degC")
    Heading(name='T2_degC', body='T2', word='t', numbers=(2,), unit='degC', si_unit='K')
    >>> heading("Strom 1 [mA]").unit
    'mA'
    """
    body, tail = _divided(name)
    unit, si = known_unit(tail)
    numbers = tuple(int(n) for n in re.findall(r"\d+", body))
    word = re.sub(r"[\d\W_]+", "_", body).strip("_").lower()
    return Heading(name, body, word, numbers, unit, si)


def _divided(name: str) -> tuple[str, str]:
    """Name of a column without its unit, and the unit as it stands; empty where there is none.

    >>> _divided("p_bag/kPa"), _divided("n / (1/min)"), _divided("Druck in mbar"), _divided("x_mm"), _divided("U_1")
    (('p_bag', 'kPa'), ('n', '1/min'), ('Druck', 'mbar'), ('x', 'mm'), ('U_1', ''))
    """
    bracket = _NAME.match(name)
    if bracket and "/" not in bracket["body"]:
        return bracket["body"], bracket["unit"].strip()
    over = _OVER.match(name)
    if over and known_unit(over["unit"])[0] is not None:
        return over["body"], over["unit"]
    if bracket:
        return bracket["body"], bracket["unit"].strip()
    parts = re.split(r"[_\s]+", name.strip())
    if len(parts) > 1 and parts[-1].lower() in SPELLINGS:
        return "_".join(parts[:-1]), parts[-1]
    return name, ""


def known_unit(tail: str) -> tuple[str | None, str | None]:
    """A unit as recording.yaml has it and its SI unit; None where it is none that is known.

    >>> known_unit("mA"), known_unit("ml/min"), known_unit("M"), known_unit("left")
    (('mA', 'A'), ('ml/min', 'm^3/s'), (None, None), (None, None))
    """
    if tail == "M":  # minutes or metres, or a million
        return None, None
    if tail.lower() in SPELLINGS:
        return SPELLINGS[tail.lower()]
    if not re.fullmatch(r"[A-Za-zµ%°]+[²³]?(\^?\d)?([*/][A-Za-zµ%°]+[²³]?(\^?\d)?)*|1/[A-Za-z]+", tail):
        return None, None
    try:
        parse_unit(tail)
    except (ValueError, KeyError):
        return None, None
    return tail, si_unit(tail)
