"""Finished simulations on disk, so that what was stopped goes on without making them again."""

from __future__ import annotations

import io
import json
import os
import zipfile
from contextlib import suppress
from pathlib import Path

import numpy as np

from cosim.compute.result import Result
from cosim.interrupt import deferred_interrupt
from cosim.unit.errors import InputError

#: First characters of a key name a folder: a folder of ten thousand files is slow on many file systems.
_PREFIX = 2


class Cache:
    """Results by key in a folder; a file is there whole or not at all.

    Args:
        folder: Made when the first result is kept.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def file(self, key: str) -> Path:
        """Where a result is kept."""
        return self.folder / key[:_PREFIX] / f"{key}.npz"

    def get(self, key: str) -> Result | None:
        """A result that was kept; None if there is none, or if its file is damaged (it is made again then)."""
        try:
            with np.load(io.BytesIO(self.file(key).read_bytes()), allow_pickle=False) as content:
                about = json.loads(str(content["about"]))
                arrays = tuple(np.asarray(content[f"a{i}"]) for i in range(int(about["arrays"])))
            return Result(arrays, str(about["failure"]), float(about["seconds"]), tuple(about.get("text", ())))
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
            return None

    def put(self, key: str, result: Result) -> None:
        """Keep a result; Ctrl-C while it is written stops the program when the result is kept.

        Raises:
            InputError: The folder cannot be written.
            KeyboardInterrupt: The user asked to stop in the meantime.
        """
        # KeyboardInterrupt inside an open archive would become the ValueError of a file that cannot be closed.
        with deferred_interrupt() as interrupt:
            self._write(key, result)
        interrupt.check()

    def _write(self, key: str, result: Result) -> None:
        about = {
            "arrays": len(result.arrays),
            "failure": result.failure,
            "seconds": result.seconds,
            "text": result.text,
        }
        buffer = io.BytesIO()
        named = {f"a{i}": array for i, array in enumerate(result.arrays)}
        np.savez_compressed(buffer, allow_pickle=False, about=np.array(json.dumps(about)), **named)
        file = self.file(key)
        # Two programs may write into one folder: each has a name of its own until the file is whole.
        partial = file.with_name(f"{file.name}.{os.getpid()}.part")
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            partial.write_bytes(buffer.getvalue())
            partial.replace(file)
        except OSError as error:
            with suppress(OSError):
                partial.unlink()
            raise InputError(
                self.folder,
                "",
                f"a simulation cannot be kept: {error.strerror or error}",
                "make room, or give another folder with `--out`",
            ) from error

    def count(self) -> int:
        """Number of results that are kept."""
        return sum(1 for _ in self.folder.glob("*/*.npz"))
