"""One diagnosis at a time in a folder."""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cosim.errors import InputError
from cosim.run_folder import writing

#: File whose lock says that a diagnosis is at work; the system frees the lock when its process ends, however it ends.
NAME = ".diagnosis-at-work"


@contextmanager
def alone(folder: Path) -> Iterator[None]:
    """Keeps other diagnoses out of a folder; one that was made here goes again if nothing was written to it.

    Args:
        folder: Made where it does not exist.

    Raises:
        InputError: Another diagnosis is at work there, or the folder cannot be written.
    """
    file, is_new = folder / NAME, not folder.exists()
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
        lock = file.open("a")
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise InputError(folder, "", "another diagnosis is at work in this folder",
                             "wait for it, or give another folder with `--out`") from error  # fmt: skip
        try:
            yield
        finally:
            with suppress(OSError):
                file.unlink()
            if is_new:
                with suppress(OSError):  # of what is not empty the system refuses it
                    folder.rmdir()
