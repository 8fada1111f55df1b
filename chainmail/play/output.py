"""Writing a page or a film as a whole or not at all."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cosim.run_folder import replacing
from cosim.unit.errors import InputError


@contextmanager
def output(path: Path) -> Iterator[Path]:
    """A file to write, which becomes `path` once it is whole; its folder is made.

    Raises:
        InputError: It cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path, is_shared=True) as partial:
            yield partial
    except OSError as error:
        raise InputError(
            path, "", f"it cannot be written: {error.strerror or error}", "give another path, or make room"
        ) from error
