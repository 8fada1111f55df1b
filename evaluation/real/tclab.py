"""Two heaters on one board (APMonitor's Temperature Control Lab), two programmes of ten minutes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd  # type: ignore[import-untyped]

from evaluation.real.folder import DataSet, Part
from evaluation.real.raw_files import SOURCES, raw_file

_FILES = {
    "energy_balance": ("Energy_balance_MIMO_data.txt", "Two heaters, steps of both every 100 s"),
    "second_order": ("2nd_order_MIMO_data.txt", "Two heaters, steps of both every 60 s"),
}


def tclab(folder: Path) -> DataSet:
    """The data set, read from its raw files.

    Each file is trained on once and tested on once. Surroundings and heaters begin at the mean of the first readings;
    the two sensors differ there by 0.9 and 1.4 K, which their data sheet allows (TMP36: 2 K), hence the bound.

    Raises:
        InputError: A file is missing.
    """
    names = list(_FILES)
    splits = {
        f"{trained} to {tested}": ((trained,), (tested,))
        for trained, tested in ((names[0], names[1]), (names[1], names[0]))
    }
    parts = tuple(_part(name, raw_file(folder, "tclab", file), title) for name, (file, title) in _FILES.items())
    return DataSet("tclab", "tclab", SOURCES["tclab"], parts, splits)


def _part(name: str, file: Path, title: str) -> Part:
    table = pd.read_csv(file, skipinitialspace=True)
    values = table.iloc[:, :5].to_numpy(dtype=float).T
    columns = dict(zip(("time", "heater_1", "heater_2", "temperature_1", "temperature_2"), values))
    begin = f"{columns['temperature_1'][0] / 2 + columns['temperature_2'][0] / 2:.6g} degC"
    sidecar: dict[str, Any] = {
        "time": {"column": "time", "unit": "s", "zero": 0.0},
        "overrides": {
            "components": {
                "room": {"outputs": {"temperature": {"constant": begin}}},
                "heaters": {"parameters": {"initial_temperature": begin}},
            }
        },
        # Nothing moves before the heaters go on: board and room are at one temperature, and where that lies is for the
        # biases of the sensors to tell. What is left is the scatter of a reading.
        "uncertain": {"room.temperature": "0.05 degC", "heaters.initial_temperature": "0.05 degC"},
        # 1 W at 100 %, as the makers state for heater 1; heater 2 is said to be weaker.
        "inputs": {f"drive.power_{i}": {"column": f"heater_{i}", "unit": "W", "factor": 0.01} for i in (1, 2)},
        "channels": {
            f"coil[{i}].temperature": {
                "column": f"temperature_{i}",
                "unit": "degC",
                "lag_bound": "60 s",
                "bias_bound": "2 degC",
            }
            for i in (1, 2)
        },
    }
    return Part(name, title, columns, sidecar)
