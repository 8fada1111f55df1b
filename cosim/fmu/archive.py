"""Open an FMU file: check it, read its description, extract it."""

from __future__ import annotations

import shutil
import stat
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import fmpy
from fmpy.model_description import ModelDescription, read_model_description

from cosim.errors import InputError

#: An FMU that unpacks to more than this is refused [byte].
MAXIMUM_UNPACKED_SIZE = 1 << 30


@dataclass
class FmuArchive:
    """An FMU extracted to a temporary folder.

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
        shutil.rmtree(self.directory, ignore_errors=True)


def open_fmu(path: Path) -> FmuArchive:
    """Extract an FMU and read its description.

    Raises:
        InputError: No such file, no zip, no valid modelDescription.xml, no binary for this platform, or an entry
            that would leave the folder, is a symbolic link or unpacks beyond `MAXIMUM_UNPACKED_SIZE`.
    """
    if not path.is_file():
        raise InputError(path, "", "there is no such FMU", "build the FMUs with `make fmus`, or correct the path")
    try:
        with zipfile.ZipFile(path) as archive:
            _check_entries(path, archive)
    except zipfile.BadZipFile as error:
        raise InputError(path, "", f"this is not an FMU: {error}",
                         "an FMU is a zip archive; export it again") from error  # fmt: skip
    try:
        description = read_model_description(str(path), validate=True)
    except Exception as error:  # fmpy raises bare Exception for most defects
        raise InputError(
            path, "modelDescription.xml", f"it cannot be read: {_first_line(error)}", "check it with `fmpy validate`"
        ) from error
    _check_platform(path, description)
    directory = Path(tempfile.mkdtemp(prefix="cosim-fmu-"))
    fmpy.extract(str(path), unzipdir=str(directory))
    return FmuArchive(path, directory, description)


def _first_line(error: Exception) -> str:
    return str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__


def _check_entries(path: Path, archive: zipfile.ZipFile) -> None:
    total = 0
    for entry in archive.infolist():
        name = PurePosixPath(entry.filename.replace("\\", "/"))
        if name.is_absolute() or ".." in name.parts or ":" in name.parts[0:1]:
            raise InputError(path, entry.filename, "this entry would be written outside the FMU's folder", "refused")
        if stat.S_ISLNK(entry.external_attr >> 16):
            raise InputError(path, entry.filename, "this entry is a symbolic link", "refused; export the FMU again")
        total += entry.file_size
    if total > MAXIMUM_UNPACKED_SIZE:
        raise InputError(path, "", f"it unpacks to {total / 1e9:.1f} GB", "refused: more than 1 GiB")
    if "modelDescription.xml" not in archive.namelist():
        raise InputError(path, "", "there is no modelDescription.xml in it", "an FMU holds one at its top level")


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
