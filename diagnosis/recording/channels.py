"""Which quantities a run offers to be recorded."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import xarray as xr

from cosim.unit.errors import InputError
from diagnosis.recording.quantity import SI_UNITS, parse_quantity

#: Variable of the results to the channel that measures it: every coil, string, marker, or the whole.
_COIL = ("temperature", "extension", "stiffness")
_STRING = {"string_current": "current"}
_WHOLE = {"supply_current": "supply.current", "max_curvature": "fabric.max_curvature", "fabric_length": "fabric.length"}


def offered(results: xr.Dataset) -> list[str]:
    """Channels that a run offers without being asked: what such rigs measure.

    Those are the currents of supply and strings, temperature, extension and stiffness of the coils, markers, curvature
    and length of a fabric; of a run that has none of them, scalar outputs that such a name fits (`arm.angle`), or all.
    """
    found: list[str] = []
    for name in map(str, results):
        variable, dims = name.rpartition(".")[2], results[name].dims[1:]
        if variable in _WHOLE and not dims:
            found.append(_WHOLE[variable])
        elif variable in _STRING and dims == ("string",):
            found += [f"string[{i + 1}].current" for i in range(results.sizes["string"])]
        elif variable in _COIL and dims == ("coil",):
            found += [f"coil[{label}].{variable}" for label in _coil_labels(results)]
        elif variable == "marker_position":
            found += [f"marker[{i + 1}].{axis}" for i in range(results[name].shape[1]) for axis in "xyz"]
    scalars = [str(n) for n in results if results[n].ndim == 1]
    return found or [n for n in scalars if n.rpartition(".")[2] in SI_UNITS] or scalars


def _coil_labels(results: xr.Dataset) -> list[str]:
    if "string_of_coil" in results.coords and "position_in_string" in results.coords:
        places = zip(results["string_of_coil"].values, results["position_in_string"].values)
        return [f"{string},{place}" for string, place in places]
    return [str(i + 1) for i in range(results.sizes["coil"])]


def chosen(results: xr.Dataset, wanted: Sequence[str], source: Path) -> list[str]:
    """Channels that patterns name; `*` stands for any number or name, as in `coil[*].temperature`.

    Args:
        results: Of a run.
        wanted: Names or patterns; empty takes all that are offered.
        source: Scenario, for errors.

    Raises:
        InputError: A pattern fits nothing, or a name is none of a quantity.
    """
    available = offered(results)
    if not wanted:
        return available
    found: list[str] = []
    for pattern in wanted:
        if "*" not in pattern:
            try:
                parse_quantity(pattern)
            except ValueError as error:
                raise InputError(source, "--channels", str(error), "see docs/recordings.md") from error
            fitting = [pattern]
        else:
            expression = re.compile(re.escape(pattern).replace(r"\*", r"[\w,]*"))
            fitting = [name for name in available if expression.fullmatch(name)]
        if not fitting:
            raise InputError(
                source,
                "--channels",
                f"`{pattern}` fits nothing that this scenario offers",
                f"it offers: {', '.join(available)}",
            )
        found += [name for name in fitting if name not in found]
    return found
