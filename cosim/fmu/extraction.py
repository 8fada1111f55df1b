"""Unpack an FMU's zip archive, refusing what a hostile or damaged one can do."""

from __future__ import annotations

import shutil
import stat
import zipfile
from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from cosim.unit.errors import InputError

#: An FMU that unpacks to more than this is refused [byte].
MAXIMUM_UNPACKED_SIZE = 1 << 30
#: So many entries are refused: they could fill a file system's table without filling the disk.
MAXIMUM_ENTRIES = 100_000
#: Unpacked over packed size of the whole archive from which it is refused; binaries, text and tables stay below 50.
MAXIMUM_RATIO = 200.0
#: Archives that unpack to less than this may have any ratio [byte].
HARMLESS_SIZE = 64 << 20
#: Why a second entry of one name is refused. One with the same bytes does no harm: some tools pack a folder twice.
TWICE = "this entry is there twice, with different contents"
_CHUNK = 1 << 20
_ENCRYPTED = 0x1


def check_entries(path: Path, entries: Sequence[zipfile.ZipInfo]) -> None:
    """Judge an archive by its table of contents.

    Raises:
        InputError: An entry would leave the folder, is a link, a device, encrypted, there twice with different
            contents or both file and folder, or the whole is too many or too large.
    """
    if len(entries) > MAXIMUM_ENTRIES:
        raise _refused(path, "", f"it has {len(entries)} entries, more than {MAXIMUM_ENTRIES}")
    files: dict[PurePosixPath, tuple[int, int]] = {}
    folders: set[PurePosixPath] = set()
    for entry in entries:
        name = _checked_name(path, entry)
        if entry.is_dir():
            folders.add(name)
            continue
        content = entry.file_size, entry.CRC
        if files.setdefault(name, content) != content:
            raise _refused(path, entry.filename, TWICE)
        folders.update(name.parents)
    both = files.keys() & folders
    if both:
        raise _refused(path, str(min(both)), "this entry is both a file and a folder")
    unpacked = sum(entry.file_size for entry in entries)
    packed = max(sum(entry.compress_size for entry in entries), 1)
    if unpacked > MAXIMUM_UNPACKED_SIZE:
        raise _refused(path, "", f"it unpacks to {unpacked / 1e9:.1f} GB, more than 1 GiB")
    if unpacked > HARMLESS_SIZE and unpacked > MAXIMUM_RATIO * packed:
        raise _refused(path, "", f"it unpacks to {unpacked / packed:.0f} times its size: a zip bomb")


def _refused(path: Path, entry: str, problem: str) -> InputError:
    return InputError(path, entry, problem, "refused; export the FMU again")


def _checked_name(path: Path, entry: zipfile.ZipInfo) -> PurePosixPath:
    name = PurePosixPath(entry.filename.replace("\\", "/"))
    if name.is_absolute() or ".." in name.parts or ":" in "".join(name.parts[:1]):
        raise _refused(path, entry.filename, "this entry would be written outside the FMU's folder")
    mode = entry.external_attr >> 16
    if stat.S_ISLNK(mode):
        raise _refused(path, entry.filename, "this entry is a symbolic link")
    if stat.S_IFMT(mode) not in (0, stat.S_IFREG, stat.S_IFDIR):
        raise _refused(path, entry.filename, "this entry is neither a file nor a folder")
    if entry.flag_bits & _ENCRYPTED:
        raise _refused(path, entry.filename, "this entry is encrypted")
    return name


def unpack(path: Path, folder: Path) -> None:
    """Write all entries below `folder`, counting what is really written.

    Raises:
        InputError: As `check_entries`, or an entry is damaged, larger than declared, or cannot be written.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            entries = archive.infolist()
            check_entries(path, entries)
            for entry in entries:
                _unpack_entry(path, archive, entry, folder)
    except zipfile.BadZipFile as error:
        raise InputError(
            path, "", f"this is not an FMU: {error}", "an FMU is a zip archive; export it again"
        ) from error
    except (OSError, RuntimeError, NotImplementedError, ValueError, EOFError) as error:
        raise InputError(
            path,
            "",
            f"it cannot be unpacked: {error}",
            "export it again, or make room in the folder of temporary files",
        ) from error


def _unpack_entry(path: Path, archive: zipfile.ZipFile, entry: zipfile.ZipInfo, folder: Path) -> None:
    target = folder / _checked_name(path, entry)
    if entry.is_dir():
        target.mkdir(parents=True, exist_ok=True)
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    if target.is_file():
        _compare_entry(path, archive, entry, target)
        return
    written = 0
    with archive.open(entry) as source, target.open("xb") as sink:
        while chunk := source.read(_CHUNK):
            written += len(chunk)
            if written > entry.file_size:
                raise _refused(path, entry.filename, f"it is larger than the {entry.file_size} bytes that it declares")
            sink.write(chunk)
    if (entry.external_attr >> 16) & stat.S_IXUSR:  # FMUs that wrap a tool start programs of their resources
        target.chmod(0o700)


def _compare_entry(path: Path, archive: zipfile.ZipFile, entry: zipfile.ZipInfo, target: Path) -> None:
    """Refuse a second entry of one name unless it holds the bytes of the first; a checksum can be forged."""
    with archive.open(entry) as source, target.open("rb") as first:
        while True:
            chunk = source.read(_CHUNK)
            if chunk != first.read(len(chunk) or 1):
                raise _refused(path, entry.filename, TWICE)
            if not chunk:
                return


def remove(folder: Path) -> None:
    """Delete an unpacked FMU; what cannot be deleted is left."""
    shutil.rmtree(folder, ignore_errors=True)
