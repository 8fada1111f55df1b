"""Order of magnitude, unit, sign: are the readings of the size that the scenario says?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from cosim.unit.quantity import conversion
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.explain import LEVEL, Basis, Fit, basis, explains, gain
from diagnosis.check.quantiles import chi_square_beyond
from diagnosis.check.timing import percent
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.sidecar import load_sidecar

#: Deviation of ln(measured range / simulated range) before anything is known: parameters of a class-room rig are off
#: by a
#: factor of 1.6 (docs/real-recordings.md), and missing physics takes as much; a factor of 2 is one deviation.
SPREAD = float(np.log(2.0))
#: Deviation of a rig's temperature before it is heated from what the scenario says [K]: what a laboratory's varies
#: over a year.
ROOM = 5.0
#: Units in which a table may be written, by the SI unit of its quantity.
UNITS = {
    "K": ("K", "degC", "degF"),
    "A": ("A", "mA", "uA"),
    "V": ("V", "mV"),
    "W": ("W", "mW", "kW"),
    "m": ("m", "cm", "mm", "um"),
    "rad": ("rad", "deg"),
    "rad/s": ("rad/s", "deg/s", "rpm"),
    "N": ("N", "mN", "kN"),
    "N/m": ("N/m", "N/mm"),
    "ohm": ("ohm", "mohm", "kohm"),
    "1/m": ("1/m", "1/cm", "1/mm"),
    "Pa": ("Pa", "mbar", "kPa", "psi", "bar", "MPa"),
    "m/s": ("m/s", "mm/s", "km/h"),
    "m^3/s": ("m^3/s", "l/s", "l/min", "m^3/h"),
    "N*m": ("N*m", "N*mm"),
}
#: Factors on the time of a swing that has no input: its frequency is a parameter.
PACES = np.geomspace(0.5, 2.0, 57)


@dataclass(frozen=True)
class _Size:
    """What tells the size of a channel.

    Args:
        ranges: Measured over simulated range.
        levels: First readings, measured and simulated.
    """

    ranges: float
    levels: tuple[float, float]


def unit_doubts(compared: Compared) -> list[Doubt]:
    """Doubts about the unit of every channel."""
    units = units_stated(compared)
    return [
        d for b in _simulated(compared) for d in _unit_doubts(compared, b, units.get(b.channel.name, b.channel.unit))
    ]


def sign_doubts(compared: Compared) -> list[Doubt]:
    """Doubts about the sign of every channel; to be asked where the response follows the programme."""
    return [d for b in _simulated(compared) if b.moves for d in _sign_doubts(compared, b)]


def _simulated(compared: Compared) -> list[Beside]:
    """Channels whose simulation changes."""
    every = [b for b in compared.channels.values() if b.is_comparable]
    # what a fabric does within the scatter of its contacts says nothing of a size
    return [b for b in every if _range(b.simulated_there) > 0.0 and (b.moves or not b.scatter)]


def _range(values: Array) -> float:
    """Between the percentiles 1 and 99: what moves for a moment alone has none."""
    low, high = np.quantile(values, (0.01, 0.99))
    return float(high - low)


def units_stated(compared: Compared) -> dict[str, str]:
    """Unit of every channel's column, as recording.yaml states it."""
    try:
        sidecar = load_sidecar(compared.recording.path / "recording.yaml")
    except InputError:  # the recording is not from a file
        return {}
    return {name: entry.unit for name, entry in sidecar.channels.items()}


def first(beside: Beside) -> tuple[Array, float]:
    """The readings before anything changes (at least three), and their time [s]."""
    assert beside.simulated is not None
    times, values = beside.channel.times, beside.channel.values
    course = beside.at(times)
    moved = np.flatnonzero(np.abs(course - course[0]) > beside.floor)
    count = int(np.clip(moved[0] if moved.size else len(times), 3, 20))
    return values[:count], float(times[0])


def _size(beside: Beside, factor: float = 1.0, offset: float = 0.0) -> _Size:
    """Range and first level of the readings after a conversion."""
    simulated = beside.simulated_there
    measured = factor * beside.measured + offset
    values, _ = first(beside)
    levels = factor * float(np.median(values)) + offset, float(simulated[0])
    return _Size(_range(measured) / _range(simulated), levels)


def _apart(beside: Beside, factor: float = 1.0, offset: float = 0.0) -> float:
    """Root mean square distance of the readings from the simulation after a conversion."""
    return float(np.sqrt(np.mean((factor * beside.measured + offset - beside.simulated_there) ** 2)))


def _score(size: _Size, unit: str, is_place: bool = False) -> float:
    """-2 log of how probable a size is, up to a constant: chi-square with two degrees of freedom.

    A coordinate has no level of its own: its origin is anywhere.
    """
    found = (np.log(max(size.ranges, 1e-12)) / SPREAD) ** 2
    measured, simulated = size.levels
    if unit == "K":
        return float(found + ((measured - simulated) / ROOM) ** 2)
    if unit in ("m", "N/m", "ohm") and not is_place and measured > 0.0 and simulated > 0.0:
        # what hangs loaded from the start has a level too: a threshold that is missed changes the range alone
        found += (np.log(measured / simulated) / SPREAD) ** 2
    return float(found)


def _unit_doubts(compared: Compared, beside: Beside, stated: str) -> list[Doubt]:
    """A size that no rig like this has, where another unit gives one that it has."""
    channel = beside.channel
    as_is = _size(beside)
    worst = _score(as_is, channel.unit, beside.is_place)
    limit = chi_square_beyond(LEVEL / max(len(compared.channels), 1), 2)
    # a channel that does not move is no question of its unit: a wire may have come off
    if worst <= limit or np.std(beside.measured) <= 3.0 * channel.deviation:
        return []
    best: tuple[float, str] | None = None
    for unit in UNITS.get(channel.unit, ()):
        if unit == stated:
            continue
        own, other = conversion(stated, channel.unit), conversion(unit, channel.unit)
        factor = other[0] / own[0]
        offset = other[1] - factor * own[1]
        if np.std(beside.simulated_there) <= 3.0 * factor * channel.deviation:
            continue  # in that unit the noise would hide all that is simulated
        if channel.unit == "K" and _apart(beside, factor, offset) >= _apart(beside):
            continue  # another start is forgotten on the way, another unit is not
        score = _score(_size(beside, factor, offset), channel.unit, beside.is_place)
        if best is None or score < best[0]:
            best = score, unit
    if best is None or best[0] > chi_square_beyond(0.05, 2) or worst - best[0] <= limit:
        return []
    measured, simulated = as_is.levels
    text = f"as `unit: {stated}` the readings span {as_is.ranges:.3g} times what is simulated"
    if channel.unit == "K":
        text += f" and begin at {measured - 273.15:.4g} degC, where {simulated - 273.15:.4g} degC is simulated"
    text += f"; as `unit: {best[1]}` they are of its size"
    return [
        Doubt(
            compared.recording.title,
            channel.name,
            "unit",
            text,
            f"correct `channels.{channel.name}.unit`",
            True,
            compared.begin,
            compared.end,
            float(np.sqrt(worst - best[0])),
        )
    ]


def _sign_doubts(compared: Compared, beside: Beside) -> list[Doubt]:
    """A response that goes the other way than the simulated one."""
    if len(beside.pick) < 24:
        return []
    same, other = _signed(compared, beside)
    limit = chi_square_beyond(LEVEL / max(len(compared.channels), 1), 1) + (
        0.0 if len(compared.switches()) else 2.0 * np.log(len(PACES))
    )
    found = gain(same, other)
    if found <= limit or not explains(same.share, other.share):
        return []
    text = (
        f"the readings fall where the simulation rises: turned over it explains {percent(other.share)} of their "
        f"variance, as it is {percent(same.share)}"
    )
    remedy = "is the sensor or the column of opposite sign? Correct the table, or the scenario's direction"
    kind = "sign"
    if not len(compared.switches()):
        kind = "turned"
        text += "; nothing drives it: a start on the other side does that too, or a clock that is off by half a swing"
        remedy = "is the sensor or the column of opposite sign, does it begin on the other side, or is its clock off?"
    return [
        Doubt(
            compared.recording.title,
            beside.channel.name,
            kind,
            text,
            remedy,
            True,
            compared.begin,
            compared.end,
            float(np.sqrt(found)),
        )
    ]


def _signed(compared: Compared, beside: Beside) -> tuple[Fit, Fit]:
    """Best fits with weights of the right and of the wrong sign."""
    assert beside.simulated is not None
    times, measured = beside.times, beside.measured
    groups = [basis(beside)]
    if not len(compared.switches()):  # a swing without an input: its frequency is a parameter
        groups += [Basis(beside.at(pace * times)[:, None]) for pace in PACES]
    # of readings that are turned over the squares are those of columns that are
    fits = [[one.fit(sign * measured, beside.tolerance) for one in groups] for sign in (1.0, -1.0)]
    same, other = (min(found, key=lambda f: f.squares) for found in fits)
    return same, other
