"""Where libngspice is: no Python package brings it, and every system calls its package differently."""

from __future__ import annotations

import contextlib
import ctypes
import ctypes.util
import os
import sys
from collections.abc import Iterator
from pathlib import Path

from cosim.unit.protocol import UnitError

VARIABLE = "NGSPICE_LIBRARY_PATH"

REMEDY = (
    "install it: Debian, Ubuntu: apt-get install libngspice0; Fedora: dnf install libngspice; conda-forge: "
    f"ngspice-lib; Homebrew: libngspice; or set {VARIABLE} to the library's file"
)

#: Patterns below `/`: Debian and Ubuntu, Fedora, a build of one's own, Homebrew on Linux, on Apple and on Intel Macs.
USUAL_PLACES = (
    "usr/lib/*-linux-gnu*/libngspice.so*",
    "usr/lib64/libngspice.so*",
    "usr/lib/libngspice.so*",
    "usr/local/lib/libngspice.so*",
    "home/linuxbrew/.linuxbrew/lib/libngspice.so*",
    "opt/homebrew/lib/libngspice*.dylib",
    "usr/local/lib/libngspice*.dylib",
)


class NgspiceMissingError(UnitError, ValueError):
    """libngspice is not there or does not load. A ValueError too: a circuit cannot be constructed without it."""

    def __init__(self, what: str) -> None:
        super().__init__("ngspice", what, remedy=REMEDY)


class PySpiceMissingError(UnitError, ValueError):
    """PySpice, or a package that it needs, is not installed; it loads libngspice for this program."""

    def __init__(self, package: str) -> None:
        needed = "PySpice" if package.startswith("PySpice") else f"{package}, which PySpice imports,"
        super().__init__(
            "ngspice",
            f"a circuit needs PySpice, and {needed} is not installed",
            remedy="install it, `pip install PySpice==1.5`",
        )


def find_ngspice() -> str:
    """File (or name known to the loader) of libngspice, loaded once to be sure.

    The first that loads of: the environment variable `NGSPICE_LIBRARY_PATH`; `lib/ngspice/` of the virtual
    environment, where tools/install_ngspice.sh unpacks it; the system's loader; a conda environment; usual places.

    Raises:
        NgspiceMissingError: None is there, none loads, or the variable names one that does not load.
    """
    given = os.environ.get(VARIABLE)
    if given:
        fault = _fault_of_loading(given)
        if fault:
            raise NgspiceMissingError(f"{VARIABLE} is {given}, which does not load: {fault}")
        return given
    faults = []
    for candidate in _candidates():
        fault = _fault_of_loading(candidate)
        if not fault:
            return candidate
        faults.append(fault)
    raise NgspiceMissingError("libngspice does not load: " + "; ".join(faults) if faults else "libngspice is not found")


def _candidates() -> Iterator[str]:
    prefix = Path(sys.prefix)
    yield from _files(prefix / "lib" / "ngspice", "libngspice.so*")
    known = ctypes.util.find_library("ngspice")
    if known:
        yield known
    for environment in {sys.prefix, os.environ.get("CONDA_PREFIX", sys.prefix)}:
        yield from _files(Path(environment) / "lib", "libngspice.so*")
        yield from _files(Path(environment) / "lib", "libngspice*.dylib")
    for pattern in USUAL_PLACES:
        yield from _files(Path("/"), pattern)


def _files(folder: Path, pattern: str) -> list[str]:
    """Files of a folder; none where it, or one on the way to it, may not be read."""
    try:
        return sorted(str(p) for p in folder.glob(pattern))
    except OSError:
        return []


def _fault_of_loading(library: str) -> str:
    """Why a library does not load, in one line; empty if it does."""
    try:
        ctypes.CDLL(library)
    except OSError:
        _load_neighbours(Path(library))
        try:
            ctypes.CDLL(library)
        except OSError as error:
            return str(error).splitlines()[0]
    return ""


def _load_neighbours(library: Path) -> None:
    """Load what lies beside it: an unpacked libngspice brings its own libfftw3 and libgomp, unknown to the loader."""
    if library.parent.name != "ngspice":
        return
    for neighbour in _files(library.parent, "*.so*"):
        if not Path(neighbour).name.startswith("libngspice"):
            with contextlib.suppress(OSError):
                ctypes.CDLL(neighbour, mode=ctypes.RTLD_GLOBAL)
