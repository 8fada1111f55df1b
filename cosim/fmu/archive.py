"""Open an FMU file: check it, read its description, extract it."""

from __future__ import annotations

import logging
import os
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import fmpy
from fmpy.model_description import ModelDescription, ValidationError, read_model_description

from cosim.errors import InputError
from cosim.fmu.extraction import unpack
from cosim.fmu.temporary import make_folder, remove_folder, remove_with

_LOG = logging.getLogger(__name__)


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
        description = _read(path, directory)
        _check_platform(path, description)
    except BaseException:
        remove_folder(directory)
        raise
    archive = FmuArchive(path, directory, description)
    remove_with(archive, directory)
    return archive


def _read(path: Path, directory: Path) -> ModelDescription:
    if not (directory / "modelDescription.xml").is_file():
        raise InputError(path, "", "there is no modelDescription.xml in it", "an FMU holds one at its top level")
    try:
        description = _parse(path, directory)
        _complete(description, directory)
    except Exception as error:  # fmpy raises bare Exception for most defects
        raise InputError(
            path, "modelDescription.xml", f"it cannot be read: {_first_line(error)}", "check it with `fmpy validate`"
        ) from error
    return description


def _parse(path: Path, directory: Path) -> ModelDescription:
    """A description that breaks a rule but can be read is used, with a warning: other tools run such FMUs."""
    try:
        return read_model_description(directory, validate=True)
    except ValidationError as error:
        description = read_model_description(directory, validate=False)
        more = f" (and {len(error.problems) - 1} more)" if len(error.problems) > 1 else ""
        _LOG.warning("%s: modelDescription.xml is not valid: %s%s", path.name, error.problems[0], more)
        return description


def _complete(description: ModelDescription, directory: Path) -> None:
    """What fmpy 0.3 leaves out: all start values of String and Binary arrays (a tuple), bounds of unsigned integers."""
    variables = {v.name: v for v in description.modelVariables}
    root = ElementTree.parse(directory / "modelDescription.xml").getroot()
    for element in root.iterfind("ModelVariables/*"):
        if element.tag.startswith("UInt"):
            variable = variables[element.attrib["name"]]
            variable.min, variable.max = element.get("min"), element.get("max")
        starts = element.findall("Start")
        if len(starts) > 1:
            variables[element.attrib["name"]].start = tuple(start.attrib.get("value", "") for start in starts)


def _first_line(error: Exception) -> str:
    return str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__


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
