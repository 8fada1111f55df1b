"""SMA coils in a soft limb: two heating pulses each, one thermocouple per coil."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd  # type: ignore[import-untyped]

from cosim.unit.protocol import Array
from evaluation.real.folder import DataSet, Part
from evaluation.real.raw_files import SOURCES, raw_file

#: Coil to file, column of its duty, column of its thermocouple.
_COILS = {
    "c1": ("test_c1_only.csv", "pwm_duty_limb0_rev", "MCPtemp_0"),
    "c2": ("test_c2_only.csv", "pwm_duty_limb0_fwd", "MCPtemp_1"),
}
#: Instant between the two pulses [s], five seconds before the second begins.
BETWEEN = 185.0
_CLOCK = "Timestamp (millisec since midnight today)"
#: Step of the thermocouple's converter (MCP9600): 0.0625 K.
_QUANTUM = "0.0625 degC"


def sma_limb(folder: Path) -> DataSet:
    """The data set, read from its raw files.

    Both parts of a coil hold the whole file: the first is judged up to the second pulse, the second from there on.
    So the second pulse begins with what the first left behind, and no state has to be guessed.

    Raises:
        InputError: A file is missing.
    """
    parts: list[Part] = []
    for coil, (file, duty, temperature) in _COILS.items():
        table = pd.read_csv(raw_file(folder, "sma-limb", file), skiprows=2)
        time = table[_CLOCK].to_numpy(dtype=float)
        columns = {
            "time": time - time[0],
            "duty": table[duty].to_numpy(dtype=float),
            "temperature": table[temperature].to_numpy(dtype=float),
        }
        columns = _once(columns)
        parts += [
            _part(coil, "first", columns, {"end": f"{BETWEEN:g} s"}),
            _part(coil, "second", columns, {"begin": f"{BETWEEN:g} s"}),
        ]
    splits = {f"{c} second pulse": ((f"{c}_first",), (f"{c}_second",)) for c in _COILS}
    return DataSet("sma_limb", "sma_limb", SOURCES["sma-limb"], tuple(parts), splits)


def _once(columns: dict[str, Array]) -> dict[str, Array]:
    """Rows whose clock has moved on."""
    keep = np.concatenate([[True], np.diff(columns["time"]) > 0])
    return {name: values[keep] for name, values in columns.items()}


def _part(coil: str, pulse: str, columns: dict[str, Array], window: dict[str, str]) -> Part:
    begin = f"{np.mean(columns['temperature'][columns['duty'].cumsum() == 0]):.6g} degC"
    sidecar: dict[str, Any] = {
        "time": {"column": "time", "unit": "ms", "zero": 0.0},
        **window,
        "overrides": {
            "components": {
                "room": {"outputs": {"temperature": {"constant": begin}}},
                "wire": {"parameters": {"initial_temperature": begin}},
            }
        },
        "uncertain": {"room.temperature": "1 degC", "wire.initial_temperature": "0.2 degC"},
        # Supply voltage and current were not recorded: 10 W at full duty is a guess, absorbed by the heat capacity.
        "inputs": {"drive.power": {"column": "duty", "unit": "W", "factor": 10.0}},
        "channels": {
            "coil[1].temperature": {
                "column": "temperature",
                "unit": "degC",
                "quantum": _QUANTUM,
                "lag_bound": "30 s",
                "bias_bound": "1.5 degC",
            }  # MCP9600 with its thermocouple, data sheet
        },
    }
    title = f"SMA coil {coil} of a soft limb, {pulse} pulse"
    return Part(f"{coil}_{pulse}", title, columns, sidecar)
