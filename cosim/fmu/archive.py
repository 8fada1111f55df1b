"""Open an FMU file: check it, read its description, extract it; once for all instances of this process."""

from __future__ import annotations

import copy
import os
import weakref
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import fmpy
from fmpy.model_description import ModelDescription

from cosim.fmu.description import read_description
from cosim.fmu.extraction import unpack
from cosim.fmu.temporary import make_folder, remove_folder, remove_with
from cosim.unit.errors import InputError


@dataclass(eq=False)
class _Extracted:
    """An extracted FMU, its description and its loaded libraries, for all instances that use them.

    FMI lets one library have several instances (canBeInstantiatedOnlyOncePerProcess says where it may not), and an
    instance only reads its resources.
    """

    directory: Path
    description: ModelDescription
    users: int = 0
    libraries: dict[tuple[Any, str], Any] = field(default_factory=dict)

    def leave(self) -> None:
        """One user less; with the last one libraries are closed and files deleted."""
        self.users -= 1
        if self.users > 0:
            return
        for library in self.libraries.values():
            library.freeLibrary()
        self.libraries.clear()
        remove_folder(self.directory)


#: What is extracted at present, by file and the state in which it was read.
_OPEN: weakref.WeakValueDictionary[tuple[str, int, int, int], _Extracted] = weakref.WeakValueDictionary()


@dataclass
class FmuArchive:
    """An FMU extracted to a temporary folder, which is removed at the latest when this process ends.

    Args:
        path: The .fmu file.
        directory: Where it is extracted.
        description: The parsed modelDescription.xml; instances share it, so nobody changes it.
    """

    path: Path
    directory: Path
    description: ModelDescription
    _shared: _Extracted | None = field(default=None, repr=False, compare=False)

    def remove(self) -> None:
        """Give up the extracted files, which are deleted with their last user; safe to call twice."""
        if self._shared is None:
            remove_folder(self.directory)
            return
        shared, self._shared = self._shared, None
        self.directory = Path(os.devnull, "removed")
        shared.leave()

    def load(self, kind: Callable[..., Any], identifier: str, **settings: Any) -> Any:
        """An object of fmpy for one instance; the library and its functions are looked up once per archive.

        Args:
            kind: Class of fmpy.
            identifier: Model identifier.
            settings: What the class takes besides: guid, instanceName.
        """
        given = {"modelIdentifier": identifier, "unzipDirectory": str(self.directory), **settings}
        if self._shared is None:
            return kind(**given)
        libraries = self._shared.libraries
        if (kind, identifier) not in libraries:
            libraries[kind, identifier] = kind(**given)
        instance = copy.copy(libraries[kind, identifier])
        instance.instanceName = settings["instanceName"]
        instance.freeLibrary = _nothing  # `_Extracted.leave` closes it
        return instance

    def __getstate__(self) -> dict[str, Any]:
        """For a process of its own, which loads the library itself and leaves the files to this one."""
        return {**self.__dict__, "_shared": None}


def _nothing() -> None:
    return


def open_fmu(path: Path, is_shared: bool = True) -> FmuArchive:
    """Extract an FMU and read its description.

    Args:
        path: The .fmu file.
        is_shared: Whether files and library may be those of other instances; False: they are its own.

    Raises:
        InputError: No such file, no zip, no valid modelDescription.xml, no binary for this platform, or an archive
            that `cosim.fmu.extraction` refuses.
    """
    if not os.path.isfile(path):  # also of a name too long, where `Path` raises
        if os.path.isdir(path):
            raise InputError(path, "", "there is no such FMU: this is a folder", "give the .fmu file")
        raise InputError(path, "", "there is no such FMU", "build the FMUs with `make fmus`, or correct the path")
    state = os.stat(path)
    key = os.path.realpath(path), state.st_ino, state.st_mtime_ns, state.st_size
    shared = _OPEN.get(key) if is_shared else None
    if shared is not None and shared.users > 0:
        shared.users += 1
        return FmuArchive(path, shared.directory, shared.description, shared)
    directory = make_folder()
    try:
        unpack(path, directory)
        description = read_description(path, directory)
        _check_platform(path, description)
    except BaseException:
        remove_folder(directory)
        raise
    if not is_shared:
        archive = FmuArchive(path, directory, description)
        remove_with(archive, directory)
        return archive
    shared = _OPEN[key] = _Extracted(directory, description, 1)
    remove_with(shared, directory)
    return FmuArchive(path, directory, description, shared)


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
