"""Units of recorded columns: what a person means by `C` or `px` is not always what the unit registry reads."""

from __future__ import annotations

import re

from cosim.unit.quantity import PhysicalValue, conversion, cycles_and_angles, parse_unit, registry

#: SI units by which a unit of the same dimension is replaced.
_SI = (
    "rad",
    "rad/s",
    "K",
    "m",
    "kg",
    "kg*m^2",
    "m^2",
    "m^3",
    "W/(m^2*K)",
    "J/(kg*K)",
    "kg/m^3",
    "1",
    "ohm",
    "V",
    "W",
    "N/m",
    "N*m",
    "N*m*s",
    "1/K",
    "m/s^2",
    "A",
    "Pa",
    "N",
    "m/s",
    "m^3/s",
)
#: Ends of the names of units that belong to screens and print; as lengths they are those of a printed page.
_SCREEN = ("pixel", "pixels", "point", "pica", "didot", "cicero")
#: Words that a unit of an angle, or of its rate, is made of. Other numbers without dimension count something else.
_ANGLE = re.compile(r"radian|degree|turn|revolution|arcminute|arcsecond|grade|gon|cycle|circle|dimensionless")
_NUMBER = re.compile(r"percent|ppm|count|bit|steradian|hertz|becquerel|neper|decibel")
#: (SI unit, unit as written) to what is meant.
_MEANT = {
    ("K", "C"): "degC",
    ("K", "c"): "degC",
    ("K", "oC"): "degC",
    ("K", "ºC"): "degC",
    ("K", "deg C"): "degC",
    ("K", "deg"): "degC",
    ("K", "°"): "degC",
    ("K", "F"): "degF",
    ("K", "deg F"): "degF",
    ("K", "k"): "K",
    ("s", "m"): "min",
    ("s", "M"): "min",
    ("s", "H"): "h",
    ("s", "S"): "s",
    ("s", "mS"): "ms",
    ("s", "D"): "d",
    ("N", "g"): "gf",
    ("N", "gram"): "gf",
    ("N", "kg"): "kgf",
    ("N", "lb"): "lbf",
    ("ohm", "O"): "ohm",
    ("ohm", "R"): "ohm",
    ("m", "MM"): "mm",
    ("m", "CM"): "cm",
}
#: Unit of a pure number.
PURE = "1"
#: Readings of which only the maker of a converter or a controller knows what they stand for.
_RAW = ("", "1", "%", "percent", "count", "counts", "bit", "bits", "steps", "ticks", "dB")
#: A prefix of 1e6 or more before these is a slip of the shift key: no rig has readings of megametres or megaseconds.
#: Cavities and smelters have megavolts and megaamperes; where they are a slip, the size of the readings shows it.
_NEVER_MEGA = {"m": "mm", "s": "ms"}


def si_unit(unit: str) -> str:
    """SI unit of the same dimension; the unit itself where none is known.

    >>> si_unit("mbar"), si_unit("degC"), si_unit("mol/m^3")
    ('Pa', 'K', 'mol/m^3')
    >>> si_unit("rpm"), si_unit("%")
    ('rad/s', '1')
    """
    try:
        base = PhysicalValue(1.0, unit)
        is_angle = any(cycles_and_angles(unit or "1"))
        for candidate in _SI[0 if is_angle else 2 :]:  # per cent is no angle
            try:
                base.to(candidate)
            except ValueError:
                continue
            # 1/s is no rad/s, though they are of one size
            return unit if unit and conversion(unit, candidate) == (1.0, 0.0) else candidate
    except ValueError:  # an FMU's own way to write it
        return unit
    return unit


def unit_of_component(unit: str, usual: str) -> str:
    """SI unit of a variable of a component: by its name where the unit fits that, else by its unit.

    An FMU may call a pressure `current`, but `C` at a `temperature` is a slip and no coulomb. A pure number stays
    one, for an FMU that states no unit; `diagnosis.recording.series.place_of` refuses it where the FMU states one.

    Args:
        unit: As written for its column.
        usual: SI unit that the variable's name says; empty where it says none.
    """
    if unit.strip() == PURE:
        return PURE
    is_slip = (usual, unit.strip()) in _MEANT or unit.strip() in _RAW
    try:
        conversion(unit, usual or unit)
    except ValueError:
        return usual if is_slip else si_unit(unit)
    return usual or si_unit(unit)


class WrongUnit(ValueError):
    """A unit that does not fit what is measured.

    Args:
        problem: What is wrong.
        remedy: What to write instead.
    """

    def __init__(self, problem: str, remedy: str) -> None:
        super().__init__(problem)
        self.remedy = remedy


def conversion_of_reading(unit: str, target: str) -> tuple[float, float]:
    """(factor, offset) with SI value = factor * reading + offset.

    Args:
        unit: As written for a column.
        target: SI unit of what it measures.

    Raises:
        WrongUnit: It is unknown, measures something else, or is read as something that nobody means here: a pixel, a
            difference of temperatures, a logarithm, a pure number for an angle, a megametre.
    """
    name = _check(unit, target)
    if name.startswith("delta_"):
        plain = unit.replace("delta_", "", 1)
        raise WrongUnit(f"`{unit}` is a difference of temperatures, not a temperature", f"write `{plain}`")
    return conversion(unit, target)


def conversion_of_difference(unit: str, target: str) -> float:
    """SI value of a difference of one unit: 0.3 degC of noise are 0.3 K.

    Raises:
        WrongUnit: As for `conversion_of_reading`; a difference of temperatures is one here.
    """
    _check(unit, target)
    return conversion(unit, target)[0]


def _check(unit: str, target: str) -> str:
    """Name of the unit in the registry."""
    try:
        name = str(parse_unit(unit))
    except ValueError as error:
        if unit == target:  # an FMU's own way to write it: there is nothing to convert
            return unit
        raise WrongUnit(str(error), instead(unit, target)) from error
    if any(part.endswith(_SCREEN) for part in re.split(r"[^A-Za-z_]+", name)):
        raise WrongUnit(
            f"`{unit}` is a unit of screens and print; how long it is on the rig only the scale of the picture says",
            "give the scale: `unit: mm` with `factor`, the millimetres to one pixel",
        )
    try:
        conversion(unit, target)
    except ValueError as error:
        read_as = f" (`{unit}` is read as {name.replace('_', ' ')})" if name not in (unit, "dimensionless") else ""
        raise WrongUnit(f"{error}{read_as}", instead(unit, target)) from error
    if not _is_linear(unit, target):
        raise WrongUnit(f"`{unit}` is a logarithmic unit", f"convert the column to {target} first")
    if target in ("rad", "rad/s") and _NUMBER.search(name) and not _ANGLE.search(name.replace("steradian", "")):
        per, whole, rate = ("", "turn", "") if target == "rad" else ("/s", "rpm", " per time")
        raise WrongUnit(
            f"`{unit}` is read as {name.replace('_', ' ')}, which is no unit of an angle{rate}",
            f"write rad{per}, deg{per} or {whole}, with `factor` where a reading is none of them",
        )
    if target in _NEVER_MEGA and conversion(unit, target)[0] >= 1e6 and unit.startswith("M"):
        raise WrongUnit(f"`{unit}` is read as {name}, a million {target}", f"write `{_NEVER_MEGA[target]}`")
    return name


def _is_linear(unit: str, target: str) -> bool:
    own, asked = parse_unit(unit), parse_unit(target)
    zero, one, two = (float(registry().Quantity(x, own).to(asked).magnitude) for x in (0.0, 1.0, 2.0))
    return abs((two - one) - (one - zero)) <= 1e-9 * max(abs(zero), abs(one), abs(two))


def instead(unit: str, target: str) -> str:
    """Remedy: what was meant, as far as that can be told."""
    plain = unit.strip()
    if plain in _RAW:
        return f"give the unit that the readings stand for ({target}), with `factor`, its amount to one of them"
    candidates = [_MEANT.get((target, plain)), plain.lower(), plain.lower().rstrip("s")]
    for meant in candidates:
        if meant is None or meant == unit:
            continue
        try:
            conversion(meant, target)
        except ValueError:
            continue
        return f"write `{meant}`"
    return f"give a unit that converts to {target}"
