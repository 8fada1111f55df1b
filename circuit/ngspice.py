"""The only place where ngspice is called, through PySpice.

ngspice keeps one set of circuits per process, so there is one simulator object, with one circuit in it: whichever
circuit is solved next takes its place. Not for use from several threads.
"""

from __future__ import annotations

import ctypes.util
import logging
import math
import os
import re
import sys
from collections.abc import Iterable, Sequence
from functools import lru_cache
from glob import glob
from pathlib import Path
from typing import Any

import numpy as np

from cosim.unit import Array, UnitError

_VARIABLE = "NGSPICE_LIBRARY_PATH"
_PLACES = ("/usr/lib/*-linux-gnu", "/usr/lib64", "/usr/lib", "/usr/local/lib", "/opt/homebrew/lib", "/opt/local/lib")
_MISSING = (
    "install it (Debian, Ubuntu: libngspice0; Fedora: libngspice; conda-forge: ngspice-lib; Homebrew: libngspice), or set "
    f"{_VARIABLE} to the library's file"
)
#: What ngspice says when something has failed; notes, warnings and progress match nothing here.
_ERROR = re.compile(r"error|fatal|abort|no such|not found|unknown|can't|cannot|failed|not enough", re.IGNORECASE)
_HARMLESS = re.compile(r"^\s*(note|warning)\b|init file|initialization file", re.IGNORECASE)
#: Longest command that PySpice passes on.
_COMMAND_LENGTH = 1000


def find_library() -> str:
    """File or loader name of libngspice.

    Looked for in `NGSPICE_LIBRARY_PATH`, in the virtual environment (lib/ngspice), by the loader, then in the places
    where packages put it.

    Raises:
        UnitError: It is nowhere; the text names the packages.
    """
    given = os.environ.get(_VARIABLE)
    if given:
        if Path(given).is_file():
            return given
        raise UnitError("ngspice", f"{_VARIABLE} is {given}, but there is no such file", remedy=_MISSING)
    candidates = sorted(glob(f"{sys.prefix}/lib/ngspice/libngspice.so*")) + sorted(glob(f"{sys.prefix}/lib/libngspice*"))
    by_loader = ctypes.util.find_library("ngspice")
    if by_loader:
        candidates.append(by_loader)
    for place in _PLACES:
        candidates += sorted(glob(f"{place}/libngspice.so*")) + sorted(glob(f"{place}/libngspice*.dylib"))
    if not candidates:
        raise UnitError("ngspice", "libngspice is not installed", remedy=_MISSING)
    return candidates[0]


def is_error(line: str) -> bool:
    """Whether a line that ngspice prints reports a failure, not a note on how it solved."""
    return not _HARMLESS.search(line) and bool(_ERROR.search(line))


@lru_cache(maxsize=1)
def simulator() -> Simulator:
    """The simulator of this process, started at the first call."""
    return Simulator()


class Simulator:
    """libngspice through PySpice.

    Raises:
        UnitError: The library is missing or cannot be loaded.
    """

    def __init__(self) -> None:
        library = find_library()
        os.environ[_VARIABLE] = library  # PySpice reads it when it is imported
        logging.getLogger("PySpice").setLevel(logging.ERROR)  # it warns of every ngspice newer than itself
        try:
            from PySpice.Spice.NgSpice import Shared
        except ImportError as error:
            raise UnitError("ngspice", f"PySpice cannot be imported: {error}", remedy="run `make setup`") from error

        class Listening(Shared.NgSpiceShared):  # type: ignore[misc]
            """PySpice takes every line on stderr for a failure; here `is_error` decides."""

            @staticmethod
            def _send_char(message: Any, _number: int, user_data: Any) -> int:
                this = Shared.ffi.from_handle(user_data)
                stream, _, content = Shared.ffi_string_utf8(message).partition(" ")
                (this._stderr if stream == "stderr" else this._stdout).append(content)
                if is_error(content):
                    this._error_in_stderr = True
                return 0

        Shared.NgSpiceShared.LIBRARY_PATH = library
        try:
            self._shared = Listening.new_instance()
        except (OSError, NameError, Shared.NgSpiceCommandError) as error:
            raise UnitError("ngspice", f"{library} cannot be loaded: {error}", remedy=_MISSING) from error
        self._failures = (Shared.NgSpiceCommandError, Shared.NgSpiceCircuitError, NameError)
        self._null = Shared.ffi.NULL
        self._loaded: object | None = None

    @property
    def version(self) -> str:
        """Version of ngspice."""
        return str(self._shared.ngspice_version)

    def command(self, text: str) -> str:
        """Run one ngspice command.

        Raises:
            UnitError: ngspice reports a failure; the text holds its own words.
        """
        try:
            return str(self._shared.exec_command(text))
        except self._failures as error:
            said = "; ".join(line.strip() for line in (*self._shared._stderr, *self._shared._stdout) if line.strip())
            raise UnitError("ngspice", f"`{text[:60]}` failed: {said or error}") from error

    def load(self, owner: object, text: str) -> bool:
        """Make sure that the circuit in ngspice is that of `owner`.

        Returns:
            Whether it was loaded just now, so that all its values must be set.

        Raises:
            UnitError: ngspice refuses the netlist.
        """
        if self._loaded is owner:
            return False
        self.unload(self._loaded)
        try:
            self._shared.load_circuit(text)
        except self._failures as error:
            raise UnitError("ngspice", f"the netlist was refused: {self._shared.stdout or error}") from error
        self._loaded = owner
        return True

    def unload(self, owner: object) -> None:
        """Remove the circuit of `owner` if it is the one in ngspice."""
        if owner is not None and self._loaded is owner:
            self._loaded = None
            self.command("remcirc")

    def alter(self, changes: Iterable[tuple[str, float]]) -> None:
        """Set element values: resistances [Ohm] and source voltages [V].

        ngspice keeps the old value where it cannot read the new one, so only finite numbers pass.

        Raises:
            UnitError: A value is not finite.
        """
        waiting: list[str] = []
        length = 0
        for element, value in changes:
            if not math.isfinite(value):
                raise UnitError("ngspice", f"the value of {element} is {value}")
            text = f"alter {element} = {value!r}"
            if length + len(text) > _COMMAND_LENGTH:
                self.command(";".join(waiting))
                waiting, length = [], 0
            waiting.append(text)
            length += len(text) + 1
        if waiting:
            self.command(";".join(waiting))

    def operating_point(self, vectors: Sequence[bytes]) -> Array:
        """Solve the circuit and read vectors.

        Args:
            vectors: Names of nodes, and of sources with `#branch`.

        Returns:
            Shape (vector,) [V] or [A].

        Raises:
            UnitError: No solution, or a vector that does not exist.
        """
        self.command("op")
        values = np.empty(len(vectors))
        read = self._shared._ngspice_shared.ngGet_Vec_Info
        for i, name in enumerate(vectors):
            info = read(name)
            if info == self._null or info.v_length < 1:
                raise UnitError("ngspice", f"the operating point holds no {name.decode()}: it was not solved")
            values[i] = info.v_realdata[0]
        # Results pile up otherwise, and every later step gets slower.
        self.command("destroy all")
        self._shared.clear_output()
        return values
