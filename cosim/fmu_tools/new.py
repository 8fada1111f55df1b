"""`cosim fmu new`: a folder of one's own from the template."""

from __future__ import annotations

import keyword
import re
import shutil
from pathlib import Path

from cosim.fmu_tools.sources import Language
from cosim.shipped import TEMPLATES, shipped_actuators
from cosim.unit.errors import InputError

_PLACEHOLDER = "my_actuator"


def begin(given: str, language: Language) -> Path:
    """Copy the template of a language to a new folder and name the actuator after it.

    Args:
        given: Folder to make; its last part names the actuator.
        language: C or Python.

    Raises:
        InputError: The name cannot be an identifier in C and Python, or the folder exists.
    """
    target = Path(given)
    name = target.name
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name) or keyword.iskeyword(name):
        remedy = "use small letters, digits and underscores, a letter first, for example latex_coil"
        raise InputError(given or "NAME", "", f"`{name}` cannot name an actuator", remedy)
    if name in shipped_actuators():
        raise InputError(given, "", f"`{name}` is the name of a shipped actuator", "choose another name")
    source = TEMPLATES / language.value
    try:
        target.mkdir(parents=True)  # by one program alone: of two at once the second is refused
    except FileExistsError:
        raise InputError(given, "", "this folder exists already", "give another name, or remove it") from None
    except OSError as error:
        raise _cannot_be_written(given, error) from error
    try:
        for file in sorted(p for p in source.iterdir() if p.is_file()):
            text = file.read_text(encoding="utf-8").replace(_PLACEHOLDER, name)
            (target / file.name).write_text(text, encoding="utf-8")
    except OSError as error:
        shutil.rmtree(target, ignore_errors=True)
        raise _cannot_be_written(given, error) from error
    return target


def _cannot_be_written(given: str, error: OSError) -> InputError:
    what = f"it cannot be written: {error.strerror or error}"
    return InputError(given, "", what, "give a folder that can be written and has room")
