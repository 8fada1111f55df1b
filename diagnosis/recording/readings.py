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
from diagnosis.recording.series import series_of
from diagnosis.recording.write import Recorded


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
