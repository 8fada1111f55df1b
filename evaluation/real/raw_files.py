"""Where the raw files of the public data sets lie, and errors for those that do not."""

from __future__ import annotations

import os
from pathlib import Path

from cosim.unit.errors import InputError

#: Environment variable that names the folder of the raw files.
VARIABLE = "COSIM_RECORDINGS"
#: Data set to where it is published.
SOURCES = {
    "tclab": "github.com/APMonitor/arduino, commit f36e65a (Apache-2.0)",
    "sma-limb": "github.com/softroboticscontrollab/pose-estimation, commit 0f727c8 (no licence stated)",
    "cart-pendulum": "github.com/dynamicslab/MultiArm-Pendulum, commit e99a7e1 (MIT)",
    "emps": "EMPS, nonlinearbenchmark.org (Janot, Gautier, Brunot 2019)",
    "silverbox": "Silverbox, nonlinearbenchmark.org (Wigren, Schoukens 2013)",
}


def recordings_folder(given: Path | None = None) -> Path | None:
    """The folder given, or that of the environment variable, or None."""
    if given is not None:
        return given
    named = os.environ.get(VARIABLE)
    return Path(named) if named else None


def raw_file(folder: Path, data_set: str, name: str) -> Path:
    """A raw file.

    Args:
        folder: Of all data sets.
        data_set: Folder of the set.
        name: Of the file.

    Raises:
        InputError: It is not there; the error names its public source.
    """
    file = folder / data_set / name
    if not file.is_file():
        raise InputError(
            file, "", "there is no such file", f"fetch it from {SOURCES[data_set]} and put it into {folder / data_set}"
        )
    return file
