"""What sensors read of a run."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from cosim.unit.errors import InputError
from diagnosis.recording.channels import chosen
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.sensor import SensorFile, read_with
from diagnosis.recording.series import place_of, series_of
from diagnosis.recording.write import Recorded

#: Most readings of a channel: a hundred million take 0.8 GB before they are written as text.
MOST_READINGS = 100_000_000


def check_channels(
    there: xr.Dataset, wanted: Sequence[str], sensors: SensorFile, span: float, source: Path, given: Path
) -> None:
    """Refuse channels that a run does not offer, or sensors that read too often, before it is made.

    Args:
        there: Variables that the run will record, without values (`diagnosis.recording.fits.no_results`).
        wanted: See `read_results`.
        sensors: See `read_results`.
        span: Length of the run [s].
        source: Scenario, for errors.
        given: File of the sensors, for errors.

    Raises:
        InputError: There is no such channel, or a sensor would give more than `MOST_READINGS` readings.
    """
    for name in chosen(there, wanted, source):
        target = parse_quantity(name)
        place_of(there, target, source)
        rate = sensors.of(target).rate
        if span * rate.to("Hz") > MOST_READINGS:
            what = f"{rate} over {span:.6g} s are {span * rate.to('Hz'):.3g} readings of {name}"
            raise InputError(given, "rate", what, f"give a rate below {MOST_READINGS / span:.3g} Hz")


def read_results(
    results: xr.Dataset, wanted: Sequence[str], sensors: SensorFile, seed: int, source: Path
) -> dict[str, Recorded]:
    """Read channels of a run with their sensors.

    Args:
        results: Of `cosim.run`.
        wanted: Names or patterns of channels; empty takes all that are offered.
        sensors: Which sensor reads which channel.
        seed: Of noise, jitter and losses; each channel has a stream of its own, so that one more changes no other.
        source: File named in errors.

    Raises:
        InputError: There is no such channel, or a sensor does not fit it.
    """
    found = {}
    for name in chosen(results, wanted, source):
        target = parse_quantity(name)
        series = series_of(results, target, source)
        own = sensors.of(target)
        random = np.random.default_rng([seed, zlib.crc32(name.encode())])
        try:
            found[name] = Recorded(read_with(own, series, random), own)
        except ValueError as error:
            raise InputError(source, f"channels.{name}", str(error), "give the sensor in the channel's unit") from error
    return found
