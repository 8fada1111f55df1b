"""The shared library of an FMU: where it is, and what would end the process that loads it."""

from __future__ import annotations

import re
import struct
from pathlib import Path

import fmpy

from cosim.fmu.archive import FmuArchive

_IDENTIFIER = re.compile(r"[A-Za-z_]\w*", re.ASCII)
#: Of an ELF file of 64 bits, little-endian: begin of its magic number, size of its header, and where that has the place
#: of the table of segments, the size of an entry and their number (System V gABI, figures 4-3 and 5-1).
_MAGIC, _HEADER, _PLACE, _ENTRIES = b"\x7fELF\x02\x01", 64, 32, 54
_LOADED = 1  # PT_LOAD


def library(archive: FmuArchive, identifier: str) -> Path | None:
    """File of the shared library for this platform; None: there is none."""
    return next((file for file in _candidates(archive, identifier) if file.is_file()), None)


def _candidates(archive: FmuArchive, identifier: str) -> list[Path]:
    """Where FMI 3 and FMI 2 have the library for this platform."""
    name = f"{identifier}{fmpy.sharedLibraryExtension}"
    return [archive.directory / "binaries" / platform / name for platform in (fmpy.platform_tuple, fmpy.platform)]


def fault_of_name(archive: FmuArchive, identifier: str) -> str:
    """What is wrong with the name of the shared library; empty where there is one for this platform."""
    if not _IDENTIFIER.fullmatch(identifier):
        return f"the modelIdentifier `{identifier}` is no name of a file: letters, digits and underscores"
    if library(archive, identifier) is not None:
        return ""
    candidates = _candidates(archive, identifier)
    there = sorted(p.name for file in candidates if file.parent.is_dir() for p in file.parent.iterdir())
    held = f", where it holds {', '.join(there)}" if there else ""
    return f"no {candidates[0].name} for {fmpy.platform_tuple}{held}"


def fault_of_library(archive: FmuArchive, identifier: str) -> tuple[str, str] | None:
    """What is wrong with the shared library, and the remedy, before it is loaded; None: nothing that is seen."""
    fault = fault_of_name(archive, identifier)
    if fault:
        return fault, "FMI names the library after the modelIdentifier; export the FMU again, or rename it"
    path = library(archive, identifier)
    if path is not None and is_cut_off(path):
        return f"{path.name} is cut off: it ends before its last segment", "export or copy the FMU again"
    return None


def is_cut_off(path: Path) -> bool:
    """Whether a library ends before its segments do: the loader maps what is not there, and the process ends by SIGBUS.

    Of anything but an ELF file of 64 bits the answer is False; the loader refuses what it does not know.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        header = file.read(_HEADER)
        if len(header) < _HEADER or not header.startswith(_MAGIC):
            return False
        (place,) = struct.unpack_from("<Q", header, _PLACE)
        length, count = struct.unpack_from("<HH", header, _ENTRIES)
        if place + length * count > size:
            return True
        file.seek(place)
        table = file.read(length * count)
    if length < 40:  # an entry has at least what is read of it here
        return False
    entries = (struct.unpack_from("<IIQQQQ", table, k * length) for k in range(count))
    return any(kind == _LOADED and begin + held > size for kind, _, begin, _, _, held in entries)
