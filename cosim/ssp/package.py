"""The .ssp archive: taken apart safely, put together reproducibly."""

from __future__ import annotations

import shutil
import tempfile
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import unquote, urlsplit

from cosim.fmu.extraction import unpack
from cosim.run_folder import replacing
from cosim.ssp.namespaces import DEFAULT_SSD
from cosim.unit.errors import InputError

#: The earliest time that a zip entry can carry; equal contents then give equal files.
_EPOCH = (1980, 1, 1, 0, 0, 0)


def extract(path: Path, into: Path) -> None:
    """Unpack a package, by the rules for FMUs (`cosim.fmu.extraction`).

    Raises:
        InputError: There is no such file, it is no zip archive, holds no SystemStructure.ssd, or is an archive that
            would write elsewhere, holds links, is encrypted, damaged or too large.
    """
    if not path.is_file():
        what = "this is a folder" if path.is_dir() else "there is no such file"
        raise InputError(path, "", what, "give the path of an .ssp file")
    if not zipfile.is_zipfile(path):
        raise InputError(path, "", "this is not an SSP", "an SSP is a zip archive; export it again")
    try:
        unpack(path, into)
    except InputError as error:
        problem, remedy = (text.replace("FMU", "SSP") for text in (error.problem, error.remedy))
        raise InputError(path, error.key, problem, remedy) from error
    if not (into / DEFAULT_SSD).is_file():
        raise InputError(path, "", f"there is no {DEFAULT_SSD} in it", "an SSP holds one at its top level")


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
        with replacing(path, is_shared=True) as partial, zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED) as archive:
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
