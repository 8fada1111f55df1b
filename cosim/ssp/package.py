"""The .ssp archive: taken apart safely, put together reproducibly."""

from __future__ import annotations

import shutil
import stat
import tempfile
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urlsplit

from cosim.errors import InputError
from cosim.ssp.namespaces import DEFAULT_SSD

#: A package that unpacks to more than this is refused [byte].
MAXIMUM_UNPACKED_SIZE = 4 << 30
#: The earliest time that a zip entry can carry; equal contents then give equal files.
_EPOCH = (1980, 1, 1, 0, 0, 0)
_REFUSED = "refused; export the package again"


def extract(path: Path, into: Path) -> None:
    """Unpack a package.

    Raises:
        InputError: There is no such file, it is no zip archive, holds no SystemStructure.ssd, or an entry would leave
            the folder, is a symbolic link, is encrypted, or unpacks beyond `MAXIMUM_UNPACKED_SIZE`.
    """
    if not path.is_file():
        raise InputError(path, "", "there is no such file", "give the path of an .ssp file")
    try:
        with zipfile.ZipFile(path) as archive:
            for entry in archive.infolist():
                _check_entry(path, entry)
            if DEFAULT_SSD not in archive.namelist():
                raise InputError(path, "", f"there is no {DEFAULT_SSD} in it", "an SSP holds one at its top level")
            _unpack(path, archive, into)
    except (zipfile.BadZipFile, NotImplementedError, EOFError) as error:
        raise InputError(
            path, "", f"this is not an SSP: {error}", "an SSP is a zip archive; export it again"
        ) from error


def _check_entry(path: Path, entry: zipfile.ZipInfo) -> None:
    name = PurePosixPath(entry.filename.replace("\\", "/"))
    if name.is_absolute() or ".." in name.parts or ":" in "".join(name.parts[:1]):
        raise InputError(path, entry.filename, "this entry would be written outside the package's folder", _REFUSED)
    if stat.S_ISLNK(entry.external_attr >> 16):
        raise InputError(path, entry.filename, "this entry is a symbolic link", _REFUSED)
    if entry.flag_bits & 1:
        raise InputError(path, entry.filename, "this entry is encrypted, which SSP forbids", _REFUSED)


def _unpack(path: Path, archive: zipfile.ZipFile, into: Path) -> None:
    """Write the entries, counting what really comes out: the sizes that an archive declares may be false."""
    left = MAXIMUM_UNPACKED_SIZE
    for entry in archive.infolist():
        target = into.joinpath(*PurePosixPath(entry.filename.replace("\\", "/")).parts)
        if entry.is_dir():
            target.mkdir(parents=True, exist_ok=True)
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        with archive.open(entry) as source, target.open("wb") as file:
            while block := source.read(1 << 20):
                left -= len(block)
                if left < 0:
                    raise InputError(path, entry.filename, "the package unpacks to more than 4 GiB", _REFUSED)
                file.write(block)


@contextmanager
def opened(path: Path) -> Iterator[Path]:
    """Folder of a package's files while the context lasts; that of an .ssd file itself."""
    if path.suffix.lower() == ".ssd":
        if not path.is_file():
            raise InputError(path, "", "there is no such file", "give the path of an .ssp or .ssd file")
        yield path.parent
        return
    folder = Path(tempfile.mkdtemp(prefix="cosim-ssp-"))
    try:
        extract(path, folder)
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def write(path: Path, entries: Mapping[str, bytes]) -> None:
    """Write a package: entries in order, deflated, without times, so that equal contents give equal files.

    Raises:
        InputError: It cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in entries.items():
                entry = zipfile.ZipInfo(name, _EPOCH)
                entry.compress_type = zipfile.ZIP_DEFLATED
                entry.external_attr = 0o100644 << 16
                archive.writestr(entry, content)
    except OSError as error:
        raise InputError(
            path, "", f"it cannot be written: {error.strerror}", "give another file with `--out`"
        ) from error


def resolve(uri: str, folder: Path, root: Path) -> Path:
    """File that a relative URI names.

    Args:
        uri: As written; a fragment is not looked at.
        folder: Folder that it starts from.
        root: Folder that it must not leave.

    Raises:
        ValueError: It is absolute, leaves the package, or there is no such file.
    """
    parts = urlsplit(uri)
    if parts.scheme or parts.netloc or parts.path.startswith("/"):
        raise ValueError(f"`{uri}` is no relative reference; only files of the package are read")
    path = (folder / unquote(parts.path)).resolve()
    if not path.is_relative_to(root.resolve()):
        raise ValueError(f"`{uri}` leaves the package")
    if not path.is_file():
        raise ValueError(f"there is no file `{uri}` in the package")
    return path
