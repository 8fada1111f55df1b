"""A scenario with all files that it needs, to be run in another process or on another machine.

Parameter sets are written out; FMUs and controllers of a user's own travel as bytes. Shipped FMUs are those of the
machine that runs it, which must have the same program.
"""

from __future__ import annotations

import functools
import hashlib
import io
import tempfile
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Files:
    """Files that travel.

    Args:
        content: Name in the folder where they are unpacked, to content; an unpacked FMU is a zip of itself.
        program: Hash of the program that sends them.
    """

    content: Mapping[str, bytes]
    program: str

    @property
    def digest(self) -> str:
        """Hash of all of them."""
        found = hashlib.sha256(self.program.encode())
        for name in sorted(self.content):
            found.update(name.encode() + b"\0" + self.content[name])
        return found.hexdigest()


class Packer:
    """Collects the files of scenarios and gives each its name on the way."""

    def __init__(self) -> None:
        self._content: dict[str, bytes] = {}
        self._known: dict[Path, str] = {}

    def packed(self, data: dict[str, Any], folder: Path) -> dict[str, Any]:
        """Content of a scenario with the names that its files have where they are unpacked.

        Args:
            data: Content of a scenario with parameter sets written out.
            folder: Where relative paths start from.
        """
        components = {}
        for name, given in data["components"].items():
            component = dict(given)
            law = component.get("law")
            # An actuator or system names its FMU; a controller of a user's own, the file of its law.
            for holder, key in ((component, "fmu"), (dict(law) if isinstance(law, dict) else {}, "file")):
                found = _file(holder.get(key), folder)
                if found is not None:
                    holder[key] = self._named(found)
                if key == "file" and holder:
                    component["law"] = holder
            components[name] = component
        return {**data, "components": components}

    def files(self) -> Files:
        """What was collected."""
        return Files(dict(self._content), program_hash())

    def _named(self, path: Path) -> str:
        if path not in self._known:
            content = path.read_bytes() if path.is_file() else _zipped(path)
            # The digest keeps apart files of one name; the name keeps its ending, by which files are told.
            name = f"{hashlib.sha256(content).hexdigest()[:16]}-{path.name}"
            self._known[path] = name
            self._content[name] = content
        return self._known[path]


def _file(value: object, folder: Path) -> Path | None:
    """The file that a key names; None for a shipped name."""
    if not isinstance(value, str) or not value.endswith((".fmu", ".py")):
        return None
    beside = folder / value
    path = (beside if beside.exists() else Path(value)).resolve()
    return path if path.exists() else None


def _zipped(folder: Path) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for file in sorted(p for p in folder.rglob("*") if p.is_file()):
            # A fixed date: equal content must give equal bytes.
            archive.writestr(zipfile.ZipInfo(str(file.relative_to(folder))), file.read_bytes())
    return buffer.getvalue()


_UNPACKED: dict[str, tempfile.TemporaryDirectory[str]] = {}


def unpacked(files: Files) -> Path:
    """Folder of the files on this machine; unpacked once per process, and removed at its end.

    Raises:
        RuntimeError: The program here is another than the one that sent them.
    """
    if files.program != program_hash():
        raise RuntimeError("this worker runs another version of the program; install the same one on all machines")
    digest = files.digest
    if digest not in _UNPACKED:
        folder = tempfile.TemporaryDirectory(prefix="cosim-")
        for name, content in files.content.items():
            (Path(folder.name) / name).write_bytes(content)
        _UNPACKED[digest] = folder
    return Path(_UNPACKED[digest].name)


@functools.cache
def program_hash() -> str:
    """Hash of every file that a simulation runs through."""
    digest = hashlib.sha256(np.__version__.encode())
    for package in ("circuit", "cosim", "mechanics"):
        spec = find_spec(package)
        assert spec is not None
        assert spec.origin is not None
        root = Path(spec.origin).parent
        for file in sorted(p for p in root.rglob("*") if p.suffix in (".py", ".c", ".h")):
            digest.update(str(file.relative_to(root)).encode() + file.read_bytes())
    return digest.hexdigest()
