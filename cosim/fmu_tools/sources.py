"""Where the sources of actuators are, and which folders can be built."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path

from cosim.nearest import did_you_mean
from cosim.shipped import shipped_actuators
from cosim.unit.errors import InputError


class Language(StrEnum):
    """Language of an actuator's source."""

    C = "c"
    PYTHON = "python"


def find_source(given: str) -> Path:
    """Folder of a shipped actuator by name, or the folder given.

    Raises:
        InputError: It is neither.
    """
    folder, shipped = Path(given), shipped_actuators()
    if folder.is_dir():
        return folder
    if given in shipped:
        return shipped[given]
    raise InputError(
        given,
        "",
        f"there is no such folder and no such actuator{did_you_mean(given, shipped)}",
        f"give a folder, or one of: {', '.join(shipped)}",
    )


def language_of(folder: Path) -> Language:
    """Language of the sources in a folder.

    Raises:
        InputError: It holds neither model.c and config.h nor actuator.py.
    """
    if (folder / "model.c").is_file() and (folder / "config.h").is_file():
        return Language.C
    if (folder / "actuator.py").is_file():
        return Language.PYTHON
    raise InputError(
        folder,
        "",
        "it holds no actuator: neither model.c with config.h nor actuator.py",
        "begin one with `cosim fmu new NAME`",
    )
