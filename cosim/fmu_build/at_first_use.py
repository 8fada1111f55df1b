"""FMUs of the shipped actuators and controllers: built where they are asked for and not there yet."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

from cosim.fmu_build.build_c import build_c
from cosim.shipped import fmu_folder, given_fmu_folder, shipped_fmus
from cosim.unit.errors import InputError

#: The size for which `make fmus` builds, and which file names leave out.
DEFAULT_COILS = 36


def file_name(name: str, version: int, coils: int) -> str:
    """As fmus/Makefile names them."""
    return f"{name}_fmi{version}{'' if coils == DEFAULT_COILS else f'_n{coils}'}.fmu"


def shipped_fmu(name: str, version: int, coils: int) -> Path | None:
    """A shipped FMU's file, built now where it was not; None: there is no such FMU, or no such file
    in the folder that `COSIM_FMU_PATH` names, in which nothing is built.

    Args:
        name: Of the actuator or controller.
        version: FMI version, 2 or 3.
        coils: Number of coils; an FMI 3.0 FMU takes any, so it is not in the name of its file.

    Raises:
        InputError: It cannot be built: no compiler, or a folder that cannot be written.
    """
    size = coils if version == 2 else DEFAULT_COILS
    path = fmu_folder() / file_name(name, version, size)
    if os.path.isfile(path):  # of a name too long it is False
        return path
    source = shipped_fmus().get(name)
    if source is None or given_fmu_folder() is not None:
        return None
    print(f"building {path.name} (once; it is kept in {path.parent})", file=sys.stderr, flush=True)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        # Two runs may build the same file: each writes its own, and the last one to finish replaces an equal one.
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=".building-") as scratch:
            made = Path(scratch) / path.name
            build_c(source, version, size, made)
            made.replace(path)
    except OSError as error:
        problem = f"{path.name} cannot be built here: {error.strerror or error}"
        remedy = "make this folder writable, or name a folder with built FMUs: COSIM_FMU_PATH"
        raise InputError(path.parent, "", problem, remedy) from error
    return path
