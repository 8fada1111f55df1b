"""Open an FMU file: check it, read its description, extract it."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import fmpy
from fmpy.model_description import ModelDescription

from cosim.errors import InputError
from cosim.fmu.description import read_description
from cosim.fmu.extraction import unpack
from cosim.fmu.temporary import make_folder, remove_folder, remove_with


@dataclass
class FmuArchive:
    """An FMU extracted to a temporary folder, which is removed at the latest when this process ends.

    Args:
        path: The .fmu file.
        directory: Where it is extracted.
        description: The parsed modelDescription.xml.
    """

    path: Path
    directory: Path
    description: ModelDescription

    def remove(self) -> None:
        """Delete the extracted files; safe to call twice."""
        remove_folder(self.directory)


def open_fmu(path: Path) -> FmuArchive:
    """Extract an FMU and read its description.

    Raises:
        InputError: No such file, no zip, no valid modelDescription.xml, no binary for this platform, or an archive
            that `cosim.fmu.extraction` refuses.
    """
    if not os.path.isfile(path):  # also of a name too long, where `Path` raises
        raise InputError(path, "", "there is no such FMU", "build the FMUs with `make fmus`, or correct the path")
    directory = make_folder()
    try:
        unpack(path, directory)
        description = read_description(path, directory)
        _check_platform(path, description)
    except BaseException:
        remove_folder(directory)
        raise
    archive = FmuArchive(path, directory, description)
    remove_with(archive, directory)
    return archive


def _check_platform(path: Path, description: ModelDescription) -> None:
    supported = fmpy.supported_platforms(str(path))
    wanted = fmpy.platform if description.fmiVersion.startswith("2") else fmpy.platform_tuple
    if wanted not in supported and fmpy.platform not in supported:
        there = ", ".join(supported) or "none"
        raise InputError(
            path,
            f"binaries/{wanted}",
            f"there is no binary for this platform (it holds: {there})",
            "export or build the FMU for this platform",
        )
