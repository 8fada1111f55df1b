"""Where the sources of actuators are, and which folders can be built."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path

from cosim.errors import InputError

ROOT = Path(__file__).resolve().parents[2]
FMUS, TEMPLATES = ROOT / "fmus", ROOT / "templates"


class Language(StrEnum):
    """Language of an actuator's source."""

    C = "c"
    PYTHON = "python"


def shipped_actuators() -> dict[str, Path]:
    """Name to source folder of every shipped actuator."""
    return {file.parent.name: file.parent for file in sorted(FMUS.glob("*/model.c"))}


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
    raise InputError(given, "", "there is no such folder and no such actuator",
                     f"give a folder, or one of: {', '.join(shipped)}")  # fmt: skip


def language_of(folder: Path) -> Language:
    """Language of the sources in a folder.

    Raises:
        InputError: It holds neither model.c and config.h nor actuator.py.
    """
    if (folder / "model.c").is_file() and (folder / "config.h").is_file():
        return Language.C
    if (folder / "actuator.py").is_file():
        return Language.PYTHON
    raise InputError(folder, "", "it holds no actuator: neither model.c with config.h nor actuator.py",
                     "begin one with `cosim fmu new NAME`")  # fmt: skip
