"""One program at a time in a folder."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TextIO

from cosim.run_folder import missing, remove_empty, writing
from cosim.unit.errors import InputError

#: The file that is locked. It holds what is at work and the number of its process.
LOCK = ".at-work"


@contextmanager
def alone(folder: Path, what: str) -> Iterator[None]:
    """Keeps others out of a folder; what was made of its path goes again if nothing was written to it.

    The file `.at-work` is locked while this goes on, whatever is at work: a sweep must not write into a run. The system
    frees the lock when its process ends, however it ends: a file that a killed process left behind keeps nobody out.

    Args:
        folder: Made where it does not exist.
        what: What is at work: `run`, `diagnosis`.

    Raises:
        InputError: Another one is at work there, or the folder cannot be written or locked.
    """
    try:
        str(folder.absolute()).encode()
    except UnicodeEncodeError as error:  # NetCDF would find out when the run is over
        raise InputError(folder, "", "the name of this folder is no UTF-8", "give another with `--out`") from error
    file = folder / LOCK
    with writing(folder):
        made = missing(folder)
        folder.mkdir(parents=True, exist_ok=True)
        lock = file.open("a+", encoding="utf-8")
    with lock:
        if not _take(lock, folder):
            lock.seek(0)
            other, _, process = lock.read(100).partition(" ")
            who = f" (process {process})" if process.isdigit() else ""
            problem = f"another {other or what} is at work in this folder{who}"
            raise InputError(folder, "", problem, "wait for it, or give another folder with `--out`")
        try:
            with writing(folder):
                lock.truncate(0)
                lock.write(f"{what} {os.getpid()}")
                lock.flush()
            yield
        finally:
            with suppress(OSError):
                file.unlink()
            remove_empty(*made)


def _take(lock: TextIO, folder: Path) -> bool:
    """Whether the lock could be taken.

    Raises:
        InputError: The file system has no locks.
    """
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError as error:
        what = f"it cannot be locked, so that nothing keeps a second program out: {error.strerror}"
        raise InputError(folder, "", what, "give a folder on a local disk with `--out`") from error
    return os.fstat(lock.fileno()).st_nlink > 0  # removed by one that ended between the opening and the lock
