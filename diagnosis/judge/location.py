"""Where and when a recalibrated model departs from the recordings, and the input that is missing there."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Dependence:
    """What a residual goes with.

    Args:
        variable: For example `temperature above the surroundings`, `current`, `time`.
        correlation: Of the residual with it, from -1 to 1.
    """

    variable: str
    correlation: float


#: Equation of a residual where no unit could be driven alone.
WHOLE = "all its equations; not driven alone: the whole simulation runs by itself"


@dataclass(frozen=True)
class Location:
    """One line of the table of places: a residual of a unit that was driven alone with recorded inputs.

    Args:
        unit: electrical, thermal, stiffness, mechanical, measurement or other.
        equation: The balance or law that the residual is one of: `heat balance`, `Ohm's law of a string`.
        element: `coil[2,5]`, `string[3]`, `all coils`.
        channel: Channel or group of channels in which it shows most.
        begin: Begin of the window [s].
        end: End of the window [s].
        z: Largest standardised sum of residuals there, with the noise of the inputs carried along.
        limit: Size of z that noise alone passes in one of a hundred recordings.
        recording: Title of its recording.
        depends_on: What it goes with, the closest first.
    """

    unit: str
    equation: str
    element: str
    channel: str
    begin: float
    end: float
    z: float
    limit: float
    recording: str = ""
    depends_on: tuple[Dependence, ...] = ()

    @property
    def is_whole(self) -> bool:
        """Whether no unit could be driven alone, so that it is a residual of the whole simulation."""
        return self.equation == WHOLE

    @property
    def is_noise(self) -> bool:
        """Whether noise alone explains it."""
        return abs(self.z) <= self.limit


@dataclass(frozen=True)
class Waveform:
    """The unknown input at a located equation.

    Args:
        unit: Of the input: W, V, N, N/m, ohm, K or m.
        equation: Where it acts.
        element: Element on which it acts.
        times: Instants [s], rising.
        values: Estimate at these instants.
        lower: Lower ends of its 95 % intervals.
        upper: Upper ends.
        recording: Title of the recording that it was estimated from.
        finding: Number of the finding that it belongs to, from 1; 0 if to none.
        predicted: What the law of that finding gives at these instants; empty where there is none.
    """

    unit: str
    equation: str
    element: str
    times: tuple[float, ...]
    values: tuple[float, ...]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    recording: str = ""
    finding: int = 0
    predicted: tuple[float, ...] = ()


@dataclass(frozen=True)
class Proposal:
    """A law without a name for an unknown input, by sparse regression.

    Args:
        formula: The law with its numbers; `delay(x, tau)` is x through a first-order delay of tau seconds.
        unit: Of the amplitudes.
        equation_unit: electrical, thermal, stiffness or mechanical.
        place: Where it acts.
        terms: Identifiers of the unnamed terms that it is made of; empty where there is none in the catalogue.
        amplitudes: Factor of each term.
        depends_on: What each term depends on, in words.
        gain: Fall of -2 log posterior by it, linearised.
        share: Of what the unknown input explains, from 0 to 1.
    """

    formula: str
    unit: str
    equation_unit: str
    place: str
    terms: tuple[str, ...]
    amplitudes: tuple[float, ...]
    depends_on: tuple[str, ...]
    gain: float
    share: float


@dataclass(frozen=True)
class Remainder:
    """What is left in one channel or group of channels at the end.

    Args:
        channel: Its name, or that of the group.
        begin: Begin of the window [s].
        end: End of the window [s].
        z: Standardised sum of the residuals in it.
        limit: Size of z that noise alone passes in one of a hundred recordings.
        unit: SI unit of the channel; empty of a group whose channels have several.
        mean: Mean of measured minus simulated in the window [unit]; NaN where it is not known.
        noise: Where the noise of the channels comes from: `stated`, `estimated` from neighbouring readings, or `both`;
            empty where it is not known.
    """

    channel: str
    begin: float
    end: float
    z: float
    limit: float
    unit: str = ""
    mean: float = math.nan
    noise: str = ""
