"""A channel that one recording states in another unit than it was written in, seen beside the other recordings.

What the scenario misses of a size it misses in all recordings about alike. Where one recording reads so many times what
the others read, beside the simulation, and that is the factor to another unit of the quantity, it is asked
whether its unit is right.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from cosim.unit.quantity import PhysicalValue, conversion, parse_unit
from diagnosis.check import scale
from diagnosis.check.beside import Beside, Compared
from diagnosis.judge.diagnosis import Doubt

#: Quantities by SI unit that are asked, with units of laboratories beside those of `diagnosis.check.scale`.
_MORE: dict[str, tuple[str, ...]] = {
    "K": (),
    "A": (),
    "V": (),
    "W": ("hp", "Btu/h"),
    "J": ("J", "kJ", "cal", "Btu", "W*h"),
    "kg": ("kg", "g", "lb"),
    "kg/s": ("kg/s", "kg/min", "kg/h", "lb/min"),
    "m": ("inch", "ft"),
    "m/s": ("mph", "ft/s", "knot"),
    "m^3/s": ("gallon/min",),
    "m^3": ("m^3", "l", "ml", "gallon"),
    "rad": ("turn",),
    "rad/s": (),
    "N": ("lbf", "kgf"),
    "N*m": ("lbf*ft", "lbf*inch"),
    "Pa": ("mmHg", "inHg", "atm"),
}
#: Units in which a table may be written, by the SI unit of its quantity.
UNITS = {base: (*scale.UNITS.get(base, ()), *more) for base, more in _MORE.items()}
#: Units that are asked beside these of one recording among others, whose factor stands out by itself: of all recordings
#: together a factor is a number of the rig as well, and more units would be met by chance.
OF_ONE: dict[str, tuple[str, ...]] = {
    "A": ("kA", "nA"),
    "V": ("kV", "uV"),
    "W": ("MW", "uW", "kcal/h"),
    "J": ("mJ", "kcal"),
    "kg": ("mg", "oz"),
    "kg/s": ("g/s", "g/min", "mg/s", "mg/min"),
    "m": ("nm", "km", "yard"),
    "m/s": ("cm/s", "um/s", "m/min", "mm/min"),
    "m/s^2": ("m/s^2", "mm/s^2", "g_0"),
    "m^2": ("m^2", "cm^2", "mm^2"),
    "m^3": ("cm^3", "mm^3", "ul"),
    "m^3/s": ("ml/s", "ml/min", "ul/min", "ul/s", "l/h", "m^3/min", "ft^3/min"),
    "rad": ("mrad", "arcmin"),
    "rad/s": ("mrad/s", "turn/s", "deg/min"),
    "N": ("uN", "gf"),
    "N*m": ("mN*m", "uN*m"),
    "Pa": ("hPa", "mPa", "cmH2O"),
    "ohm": ("Mohm",),
    "1/m": ("1/inch",),
    "s": ("s", "ms", "us", "min", "h"),
    "1/s": ("1/s", "1/min", "1/h"),
    "Hz": ("Hz", "kHz", "1/min"),
    "F": ("F", "mF", "uF", "nF", "pF"),
    "H": ("H", "mH", "uH"),
    "C": ("C", "mC", "uC", "nC"),
    "T": ("T", "mT"),
    "mol/m^3": ("mol/m^3", "mol/l", "umol/l"),
    "kg/m^3": ("kg/m^3", "g/cm^3", "mg/l"),
    "W/m^2": ("W/m^2", "kW/m^2", "mW/cm^2"),
    "1": ("1", "percent", "ppm"),
}
#: Scales of temperature in which numbers without a unit may be: that of the others, of this one, its slope and
#: its zero.
SCALES = (
    ("degC", "degF", 1.8, 32.0),
    ("degF", "degC", 1.0 / 1.8, -32.0 / 1.8),
    ("degC", "K", 1.0, 273.15),
    ("K", "degC", 1.0, -273.15),
    ("degF", "K", 1.0 / 1.8, 459.67 / 1.8),
    ("K", "degF", 1.8, -459.67),
)
#: How far the mean may be from what a scale gives, as a share of the standard deviation and of the mean.
ABOUT, ABOUT_MEAN = 0.25, 0.02
#: Share of a channel's variance that a straight line in its simulation explains, in every recording that is compared.
FOLLOWED = 0.95
#: How far apart the others may be, relative to their median, and how far a factor may be from one of units: where a
#: number of the scenario is off, recordings of other inputs differ by a few hundredths.
ALIKE, NEAR = 0.05, 0.08
#: Least departure from 1 of a factor that is one, and other recordings that agree: of two, either may be the wrong one.
LEAST, OTHERS = 0.25, 2


def units_of_one(every: Sequence[Compared]) -> list[Doubt]:
    """Doubts about the unit of a channel in one recording alone; all are serious."""
    return [d for name in dict.fromkeys(n for one in every for n in one.channels) for d in _of_channel(every, name)]


def _of_channel(every: Sequence[Compared], name: str) -> Iterator[Doubt]:
    slopes = [(one, slope(one.channels[name])) for one in every if name in one.channels]
    for one, own in slopes:
        ratio = ratio_to(own, [s for other, s in slopes if other is not one])
        if ratio is None:
            continue
        stated = stated_unit(one, name)
        base = one.channels[name].channel.unit
        others = [(o.channels[name], s) for o, s in slopes if o is not one and s is not None]
        scales = _scale_of_one(one.channels[name], others, ratio) if base == "1" else None
        if scales is not None:
            yield _of_scale(one, name, *scales)
            continue
        near = units_near(ratio, stated, base, more=OF_ONE.get(base, ()))
        near = [unit for unit in near if _is_level_nearer(one.channels[name], stated, unit)]
        if not near:
            continue
        text = (
            f"beside the simulation its readings are {ratio:.3g} times those of the other recordings, as if they were "
            f"in {' or '.join(near)} and not in {stated}"
        )
        remedy = f"is `channels.{name}.unit` of this recording right?"
        z = abs(float(np.log(ratio))) / NEAR
        yield Doubt(one.recording.title, name, "unit", text, remedy, True, one.begin, one.end, z)


def _is_level_nearer(beside: Beside, stated: str, unit: str) -> bool:
    """Whether readings in a unit with another zero lie nearer to the simulation than in the stated one.

    A rig that is warmed 1.8 times as much reads no degF: its zero is where it was. Units of one zero tell nothing more.
    """
    if conversion(unit, stated)[1] == 0.0:
        return True
    base, level = beside.channel.unit, float(np.mean(beside.simulated_there))
    mean = float(np.mean(beside.measured))
    number = PhysicalValue(mean, base).to(stated)
    return abs(PhysicalValue(number, unit).to(base) - level) < abs(mean - level)


def _scale_of_one(beside: Beside, others: Sequence[tuple[Beside, float]], ratio: float) -> tuple[str, str] | None:
    """Scales of temperature in which numbers of the others and of one recording seem to be; None where they are alike.

    A pure number has no zero that is known: a scale tells itself by its slope and its zero together.

    Args:
        beside: The channel of the recording.
        others: The channel of each of the others, with the slope of its readings in the simulation.
        ratio: How many times theirs its own slope is.
    """
    where = float(np.mean(beside.simulated_there))
    there = float(np.median([np.mean(o.measured) + s * (where - np.mean(o.simulated_there)) for o, s in others]))
    mean, width = float(np.mean(beside.measured)), float(np.std(beside.measured))
    about = ABOUT * width + ABOUT_MEAN * abs(mean)
    if abs(mean - there) < about:
        return None  # of what is this large, no zero of a scale is seen
    for theirs, mine, factor, shift in SCALES:
        if abs(mean - factor * there - shift) < about and abs(np.log(ratio / factor)) < NEAR:
            return theirs, mine
    return None


def _of_scale(one: Compared, name: str, theirs: str, mine: str) -> Doubt:
    text = (
        f"beside the simulation its readings are as if in {mine}, and those of the other recordings as if in {theirs}"
    )
    remedy = f"in what did this sensor read? Convert the column of `channels.{name}` of this recording"
    return Doubt(one.recording.title, name, "unit", text, remedy, True, one.begin, one.end, np.log(1.8) / NEAR)


def ratio_to(own: float | None, others: Sequence[float | None]) -> float | None:
    """How many times the slope of the others one is; None where one is not known, or the others are not alike."""
    known = [s for s in others if s is not None]
    if own is None or len(known) < OTHERS or len(known) < len(others):
        return None
    usual = float(np.median(known))
    if usual <= 0.0 or own <= 0.0 or max(abs(s / usual - 1.0) for s in known) > ALIKE:
        return None
    return own / usual


def stated_unit(one: Compared, name: str) -> str:
    """Unit of a channel's column; its SI unit where the recording is not from a file."""
    return scale.units_stated(one).get(name, one.channels[name].channel.unit)


def units_near(ratio: float, stated: str, base: str, near: float = NEAR, more: Sequence[str] = ()) -> list[str]:
    """Units of a quantity in which numbers are about so many times those in the stated one.

    Args:
        ratio: Of numbers, that in the unit that is looked for to that in the stated one.
        stated: Unit that a recording states.
        base: SI unit of the quantity.
        near: How far the logarithms may be apart.
        more: Units beside those of `UNITS`.
    """
    own = conversion(stated, base)[0]
    factors = {u: own / conversion(u, base)[0] for u in (*UNITS.get(base, ()), *more) if u != stated}
    return [u for u, f in factors.items() if abs(np.log(f)) > LEAST and abs(np.log(ratio / f)) < near]


def other_units(stated: str) -> list[str]:
    """Units of the quantity of a unit that are others than it; none of a unit of no known quantity.

    >>> other_units("km/h")[:3]
    ['m/s', 'mm/s', 'mph']
    """
    quantity = parse_unit(stated).dimensionality
    bases = [base for base in OF_ONE | UNITS if parse_unit(base).dimensionality == quantity]
    alike = [(*UNITS.get(base, ()), *OF_ONE.get(base, ()), base) for base in bases]
    own = [units for units in alike if stated in units] or alike  # a torque and a work have one dimension
    every = dict.fromkeys(unit for units in own for unit in units)
    return [unit for unit in every if not np.allclose(conversion(unit, stated), (1.0, 0.0), rtol=1e-9, atol=1e-12)]


def slope(beside: Beside) -> float | None:
    """Slope of the readings in the simulation, where a straight line explains them."""
    if not beside.is_comparable:
        return None
    simulated = beside.simulated_there - np.mean(beside.simulated_there)
    measured = beside.measured - np.mean(beside.measured)
    size, total = float(simulated @ simulated), float(measured @ measured)
    if not size > 0.0 or not total > 0.0:
        return None
    slope = float(simulated @ measured) / size
    left = measured - slope * simulated
    return slope if float(left @ left) <= (1.0 - FOLLOWED) * total else None
