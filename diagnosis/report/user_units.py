"""Quantities in the units in which the user wrote recordings: what a report shows, while diagnosis.json stays in SI."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Diagnosis, Estimate
from diagnosis.recording.recording import Recording
from diagnosis.report import display
from diagnosis.report.display import ends, interval, number, user_scale, user_unit
from diagnosis.report.fits import plain_channel

#: Sizes of a number that are read without an exponent. What falls outside in the user's unit and not in SI stays in SI:
#: 5 ohm/A^2 are 0.000005 ohm/mA^2.
_READABLE = (1e-3, 1e5)


@dataclass(frozen=True)
class Scale:
    """How one quantity is shown: `factor * value + offset` in `unit`.

    Args:
        factor: From SI.
        offset: From SI; 0 of a difference.
        unit: As printed; empty for a pure number.
    """

    factor: float
    offset: float
    unit: str

    def __call__(self, value: float) -> float:
        """A value from SI."""
        return self.factor * value + self.offset

    def text(self, value: float, digits: int = 3) -> str:
        """A value with its unit."""
        return f"{number(self(value), digits)} {self.unit}".strip()

    def interval(self, value: float, lower: float, upper: float) -> str:
        """An estimate with its interval."""
        return interval(self(value), self(lower), self(upper), self.unit)


@dataclass(frozen=True)
class Units:
    """Units that the user wrote; where none of them fits a quantity it is shown in SI.

    Args:
        written: Of channels and clocks, as written; of several of one kind the first counts.
        channels: Names of channels and the unit of each, as written.
    """

    written: tuple[str, ...] = ()
    channels: tuple[tuple[str, str], ...] = ()

    def of(self, channel: str) -> Units:
        """The same with the unit of a channel first: two speeds may be written in rpm and in deg/s.

        Args:
            channel: Its name, with or without what a title of a recording or an occasion adds.

        >>> Units(("rpm", "deg/s"), (("motor", "rpm"), ("arm", "deg/s"))).of("arm (second)").text(1.0, "rad/s")
        '57.3 deg/s'
        """
        own = dict(self.channels).get(plain_channel(channel))
        return self if own is None else Units((own, *self.written), self.channels)

    def scale(self, value: float, unit: str, is_difference: bool = True) -> Scale:
        """How a quantity of such a size is shown.

        Args:
            value: In SI; one that would need an exponent in the user's unit is shown in SI.
            unit: SI unit.
            is_difference: Whether it is a change and no reading of a thermometer: a change of 2 degC is 2 K.

        >>> Units(("degC", "mm")).scale(0.0003, "m").text(0.0003)
        '0.300 mm'
        """
        found = Scale(*user_scale(unit, user_unit(unit, self.written), is_difference))
        if _is_readable(value) and not _is_readable(found(value)):
            return Scale(1.0, 0.0, display.symbol(unit))
        return found

    def text(self, value: float, unit: str, is_difference: bool = True) -> str:
        """A quantity with its unit."""
        return self.scale(value, unit, is_difference).text(value)

    def estimate(self, estimate: Estimate) -> str:
        """An estimate with its interval, as the physical quantity that it stands for.

        >>> Units(("mm",)).estimate(Estimate("gap", "m", 3.1e-4, 2.8e-4, 3.4e-4))
        '0.310 mm (0.280 to 0.340)'
        """
        told = estimate.physical or estimate
        found = self.scale(told.value, told.unit, not estimate.is_reading)
        return found.interval(told.value, told.lower, told.upper)

    def like(self, estimate: Estimate, value: float) -> str:
        """Another value of the same parameter (a bound), in the unit in which the estimate is shown."""
        told, shift = estimate.physical or estimate, 0.0
        factor = 1.0
        if estimate.physical is not None and estimate.upper > estimate.lower:
            factor = (told.upper - told.lower) / (estimate.upper - estimate.lower)
            shift = told.lower - factor * estimate.lower
        return self.scale(told.value, told.unit, not estimate.is_reading).text(factor * value + shift)

    def difference(self, unit: str) -> tuple[float, str]:
        """Factor from SI and unit in which a column of differences (RMSE, residuals) is shown."""
        preferred = user_unit(unit, self.written)
        if preferred == unit and unit not in self.written:
            return display.difference(unit)
        factor, _, printed = user_scale(unit, preferred, is_difference=True)
        return factor, printed

    def axis(self, measured: Array, unit: str) -> display.Axis:
        """How readings of one figure are shown.

        Args:
            measured: Readings, SI, any shape.
            unit: SI unit.
        """
        preferred = user_unit(unit, self.written)
        if preferred == unit and unit not in self.written:
            return display.axis(measured, unit)
        return display.Axis(*user_scale(unit, preferred))

    def span(self, begin: float, end: float) -> str:
        """An interval of time or an instant, on the clock of a recording."""
        return self.spans([(begin, end)])[0]

    def spans(self, intervals: Sequence[tuple[float, float]]) -> list[str]:
        """Several of them, in the unit of the last one.

        >>> Units(("ms", "s")).spans([(1.84, 76.7), (97.0, 120.0)])
        ['1.84 to 76.7 s', '97.0 to 120 s']
        """
        if not intervals:
            return []
        scale = self.scale(max(end for _, end in intervals), "s")
        found = []
        for begin, end in intervals:
            first, last = ends(scale(begin), scale(end))
            found.append(f"{first} to {scale.text(end)}" if first != last else f"at {scale.text(end)}")
        return found


#: Where nothing is known of what the user wrote.
IN_SI = Units()


def written_units(recordings: Sequence[Recording]) -> Units:
    """Units of several recordings, each once, in their order; of a channel that of the first recording that has it."""
    channels: dict[str, str] = {}
    for recording in recordings:  # the units of its channels come first, in their order
        channels = {**dict(zip(recording.channels, recording.units)), **channels}
    return Units(tuple(dict.fromkeys(u for r in recordings for u in r.units)), tuple(channels.items()))


def units_of(diagnosis: Diagnosis) -> Units:
    """Units in which a diagnosis is shown."""
    return Units(diagnosis.units, tuple(diagnosis.channel_units.items()))


def _is_readable(value: float) -> bool:
    return value == 0.0 or not math.isfinite(value) or _READABLE[0] <= abs(value) < _READABLE[1]
