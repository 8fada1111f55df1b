"""One program at a time in a folder."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cosim.run_folder import writing
from cosim.unit.errors import InputError


@contextmanager
def alone(folder: Path, what: str) -> Iterator[None]:
    """Keeps others out of a folder; one that was made here goes again if nothing was written to it.

    The file `.<what>-at-work` is locked while this goes on; the system frees the lock when its process ends, however
    it ends.

    Args:
        folder: Made where it does not exist.
        what: What is at work: `run`, `diagnosis`.

    Raises:
        InputError: Another one is at work there, or the folder cannot be written.
    """
    file, is_new = folder / f".{what}-at-work", not folder.exists()
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
        lock = file.open("a")
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if not os.fstat(lock.fileno()).st_nlink:  # removed by one that ended between the opening and the lock
                raise BlockingIOError
        except BlockingIOError as error:
            raise InputError(
                folder,
                "",
                f"another {what} is at work in this folder",
                "wait for it, or give another folder with `--out`",
            ) from error
        try:
            yield
        finally:
            with suppress(OSError):
                file.unlink()
            if is_new:
                with suppress(OSError):  # of what is not empty the system refuses it
                    folder.rmdir()
