"""`cosim fmu build` and `cosim fmu export`."""

from __future__ import annotations

import os
import tempfile
import zipfile
from pathlib import Path

from cosim.fmu_build.at_first_use import file_name
from cosim.fmu_build.build_c import build_c, model_identifier
from cosim.fmu_tools.build_python import build_python, class_name
from cosim.fmu_tools.sources import Language, find_source, language_of
from cosim.shipped import fmu_folder, shipped_actuators
from cosim.unit.errors import InputError


def build(given: str, version: int, coils: int, out: Path | None) -> tuple[Path, list[str]]:
    """Build the FMU of a shipped actuator or of a folder.

    Args:
        given: Name of a shipped actuator, or a folder.
        version: FMI version, 2 or 3.
        coils: Number of coils.
        out: A folder, or a file that ends in .fmu; default: where scenarios find shipped actuators by name, or the
            folder itself.

    Returns:
        The file and the compiler's warnings.

    Raises:
        InputError: It cannot be built.
    """
    folder = find_source(given)
    language = language_of(folder)
    is_python = language is Language.PYTHON
    name = class_name(folder) if is_python else model_identifier(folder)
    target = _target(name, version, coils, out or (folder if is_python else _default_folder(folder)))
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        # A run may be reading the file, or another program building it: it is replaced as a whole.
        with tempfile.TemporaryDirectory(dir=target.parent, prefix=".building-") as scratch:
            made = Path(scratch) / target.name
            warnings = (build_python if is_python else build_c)(folder, version, coils, made)
            made.replace(target)
        return target, warnings
    except OSError as error:
        what = f"it cannot be written: {error.strerror or error}"
        raise InputError(target, "", what, "give a folder that can be written with `--out`") from error


def export(name: str, version: int, coils: int, out: Path) -> Path:
    """The FMU of a shipped actuator for other tools, with its sources and licence inside.

    Raises:
        InputError: There is no such actuator, or it cannot be built.
    """
    if name not in shipped_actuators():
        raise InputError(name, "", "there is no such actuator", f"one of: {', '.join(shipped_actuators())}")
    target, _ = build(name, version, coils, out)
    with zipfile.ZipFile(target) as archive:
        wanted = {"sources/model.c", "documentation/licenses/license.txt", "documentation/index.html"}
        missing = wanted - set(archive.namelist())
    if missing:
        raise InputError(target, "", f"it lacks {', '.join(sorted(missing))}", "repair the actuator's folder in fmus/")
    return target


def _default_folder(folder: Path) -> Path:
    return (
        fmu_folder()
        if os.path.realpath(folder) in {os.path.realpath(f) for f in shipped_actuators().values()}
        else folder
    )


def _target(name: str, version: int, coils: int, out: Path) -> Path:
    """As fmus/Makefile names them: an FMI 3.0 FMU takes any size, so the size is no part of its name by default."""
    if out.suffix == ".fmu":
        return out
    return out / file_name(name, version, coils)
