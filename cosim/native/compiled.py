"""Finds and loads the compiled library; says why where there is none."""

from __future__ import annotations

import ctypes
import sys
from functools import cache
from pathlib import Path

from cosim.native.layout import LAYOUT_VERSION, Cursor, PlanLayout

_FOLDER = Path(__file__).resolve().parent
_BUILD = "build it with `pip install -e .` (needs gcc)"


class LibraryAbsent(Exception):
    """There is no usable library; the text says why and what to do."""


def library_path() -> Path:
    """Where setuptools puts the library, in a source tree and in an installation; setup.py names it."""
    return _FOLDER / f"_stepper{'.dll' if sys.platform == 'win32' else '.so'}"


@cache
def _load(path: Path) -> ctypes.CDLL | str:
    if not path.is_file():
        return f"{path.name} is not built; {_BUILD}"
    try:
        library = ctypes.CDLL(str(path))
        if library.cosim_layout_version() != LAYOUT_VERSION:
            return f"{path.name} is older than its Python side; {_BUILD}"
        library.cosim_advance.argtypes = (
            ctypes.POINTER(PlanLayout),
            ctypes.POINTER(Cursor),
            ctypes.c_int64,
            ctypes.c_double,
        )
        library.cosim_advance.restype = ctypes.c_int32
        library.cosim_format_rows.restype = ctypes.c_size_t
    except (OSError, AttributeError) as error:
        return f"{path.name} cannot be loaded ({error}); {_BUILD}"
    return library


def library() -> ctypes.CDLL:
    """The loaded library.

    Raises:
        LibraryAbsent: It is not built, does not load or does not fit these sources.
    """
    loaded = _load(library_path())
    if isinstance(loaded, str):
        raise LibraryAbsent(loaded)
    return loaded


_told: set[str] = set()


def tell_once(reason: str) -> None:
    """Say on standard error, once per process, why the loop in Python runs although the library could have run it."""
    if reason not in _told:
        _told.add(reason)
        print(f"cosim: the loop runs in Python: {reason}", file=sys.stderr)
