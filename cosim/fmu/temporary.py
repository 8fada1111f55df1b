"""Temporary folders that do not outlive their processes.

A process that ends, even through an exception, removes its folders itself. One that is killed or crashes cannot: its
folders are removed by the next process that opens an FMU. Each folder holds a file on which its process keeps a lock
(flock); the kernel drops the lock with the last process that holds it, forked ones included, so a lock that can be
taken says that nobody needs the folder any more.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import tempfile
import weakref
from pathlib import Path

from cosim.fmu.extraction import remove

PREFIX = "cosim-fmu-"
LOCK = ".in-use"

_swept: set[str] = set()
_locks: dict[Path, int] = {}


def make_folder() -> Path:
    """A new locked folder; the first call of a process removes what killed processes left."""
    parent = tempfile.gettempdir()
    if parent not in _swept:
        _swept.add(parent)
        sweep(Path(parent))
    folder = Path(tempfile.mkdtemp(prefix=PREFIX))
    handle = os.open(folder / LOCK, os.O_CREAT | os.O_RDWR, 0o600)
    fcntl.flock(handle, fcntl.LOCK_EX)
    _locks[folder] = handle
    return folder


def remove_folder(folder: Path) -> None:
    """Remove a folder of `make_folder`; safe to call twice."""
    remove(folder)
    handle = _locks.pop(folder, None)
    if handle is not None:
        os.close(handle)


def remove_with(owner: object, folder: Path) -> None:
    """Remove a folder when its owner is collected or this process ends; a forked process leaves it alone."""
    weakref.finalize(owner, _remove_if_ours, folder, os.getpid())


def _remove_if_ours(folder: Path, process: int) -> None:
    if os.getpid() == process:
        remove_folder(folder)


def sweep(parent: Path) -> None:
    """Remove the folders of processes that are gone."""
    for folder in parent.glob(PREFIX + "*"):
        with contextlib.suppress(OSError):  # no lock file, another user's, in use, or removed meanwhile
            handle = os.open(folder / LOCK, os.O_RDWR)
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                remove(folder)
            finally:
                os.close(handle)
