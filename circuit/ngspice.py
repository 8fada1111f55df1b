"""ngspice in this process, through PySpice: the only module that imports it.

PySpice 1.5 loads libngspice and receives its messages. Commands go straight to the library that PySpice has loaded,
because `exec_command` raises on every line on stderr that is no warning (`Note:`, gmin stepping, `Using SPARSE`)
although the solution is there. Reasons and measurements: docs/decisions/0005-ngspice-calls.md.
"""

from __future__ import annotations

import contextlib
import functools
import itertools
import logging
import os
import re
import sys
import tempfile
import threading
import warnings
from collections.abc import Iterator, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from circuit.installation import NgspiceMissingError, PySpiceMissingError, find_ngspice
from cosim.unit.protocol import Array

#: Commands after which ngspice's command history is freed; PySpice's own number.
COMMANDS_TO_RELEASE = 10_000

#: Beginnings of harmless lines that may speak of failures (`Note: ... gmin stepping failed`).
_NOTE = re.compile(r"\s*(note|warning|using|trying|doing)\b|.*\b(gmin|source) stepping\b", re.IGNORECASE)

#: Words of genuine errors of libngspice 39. A line with neither is a note; what it might hide is caught by the check of
#: the vectors (`Circuit.solve`) and by Kirchhoff's laws (`circuit.unit`).
_ERROR = re.compile(
    r"\b(error|fatal|no such|not found|unknown|can't|cannot|aren't any|failed|aborted|out of memory)\b", re.IGNORECASE
)

_titles = itertools.count(1)


class NgspiceError(Exception):
    """ngspice refused a command or has no solution; the text quotes it."""


def is_error(line: str) -> bool:
    """Whether a line that ngspice prints tells of an error rather than of its progress."""
    return _NOTE.match(line) is None and _ERROR.search(line) is not None


@contextlib.contextmanager
def _init_file() -> Iterator[None]:
    """Let libngspice begin where the user has no entry in the password database, as in a container run with `--user`.

    libngspice (39 at least) looks there for the home folder that may hold `.spiceinit`, and crashes if there is no
    entry. It does not look where the working folder has such a file, so for this moment it gets an empty one.
    """
    if sys.platform == "win32" or _has_entry():
        yield
        return
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, ".spiceinit").write_text("* nothing\n")
        with contextlib.chdir(folder):
            yield


def _has_entry() -> bool:
    import pwd  # Unix alone has it

    try:
        pwd.getpwuid(os.getuid())
    except KeyError:
        return False
    return True


class Ngspice:
    """The one libngspice of this process; circuits take turns in it, one thread at a time (it is not thread-safe)."""

    def __init__(self) -> None:
        path = find_ngspice()
        # PySpice logs `can't find init file` as an error; where the program configures no logging it stays quiet.
        logging.getLogger("PySpice").addHandler(logging.NullHandler())
        try:
            with warnings.catch_warnings():
                warnings.simplefilter(
                    "ignore", SyntaxWarning
                )  # of its docstrings, when Python 3.12 or newer compiles it
                from PySpice.Spice.NgSpice.Shared import NgSpiceShared, ffi
        except ModuleNotFoundError as error:
            raise PySpiceMissingError(error.name or "PySpice") from error

        NgSpiceShared.LIBRARY_PATH = path
        try:
            with _init_file():
                self._shared: Any = NgSpiceShared.new_instance()
        except OSError as error:
            raise NgspiceMissingError(f"libngspice at {path} does not load: {error}") from error
        self._library: Any = self._shared._ngspice_shared
        self._null = ffi.NULL
        self._commands = 0
        self._current = ""
        self.lock = threading.RLock()

    @property
    def version(self) -> int:
        """Major version of libngspice."""
        return int(self._shared.ngspice_version)

    def command(self, text: str) -> list[str]:
        """Carry out one command and return the lines that it printed.

        Raises:
            NgspiceError: ngspice printed an error.
        """
        shared = self._shared
        shared.clear_output()
        self._commands += 1
        if self._commands >= COMMANDS_TO_RELEASE:
            self._library.ngSpice_Command(self._null)
            self._commands = 0
        code = self._library.ngSpice_Command(text.encode("ascii"))
        if code or shared._error_in_stderr or shared._error_in_stdout:
            self._raise_errors(text, code)
        lines: list[str] = shared._stdout
        return lines

    def _raise_errors(self, text: str, code: int) -> None:
        errors = [str(line).strip() for line in (*self._shared._stderr, *self._shared._stdout) if is_error(str(line))]
        if errors or code:
            raise NgspiceError(f"ngspice refused `{text}`: {'; '.join(errors) or f'code {code}'}")

    def load(self, netlist: str) -> None:
        """Load a circuit; its title line must be new.

        Raises:
            NgspiceError: ngspice cannot read the netlist.
        """
        self._current = ""
        try:
            self._shared.load_circuit(netlist)
        except NameError as error:  # PySpice's errors derive from it
            raise NgspiceError(f"ngspice cannot read the netlist: {self._shared.stdout or error}") from error
        self._raise_errors("load circuit", 0)

    def circuits(self) -> dict[str, int]:
        """Title line to the number by which `setcirc` knows a circuit; numbers move when circuits come and go."""
        try:
            lines = self.command("setcirc")
        except NgspiceError:  # how ngspice says that there is none
            return {}
        columns = [line.split("\t") for line in lines]
        return {c[-1].strip(): int(c[-2]) for c in columns if len(c) >= 2 and c[-2].strip().isdigit()}

    def select(self, title: str) -> None:
        """Make a circuit the current one.

        Raises:
            NgspiceError: It is not loaded.
        """
        if self._current == title:
            return
        number = self.circuits().get(title)
        if number is None:
            raise NgspiceError(f"ngspice holds no circuit `{title}`; it was removed")
        self.command(f"setcirc {number}")
        self._current = title

    def remove(self, title: str) -> None:
        """Free a circuit; nothing happens if it is not loaded."""
        if title in self.circuits():
            self.select(title)
            self.command("remcirc")
        self._current = ""

    def plots(self) -> list[str]:
        """Names of the results that ngspice holds; `const` is always there."""
        return [str(name) for name in self._shared.plot_names]

    def read(self, vectors: Sequence[bytes]) -> Array:
        """First value of each vector of the current plot; NaN where there is none."""
        get, null = self._library.ngGet_Vec_Info, self._null
        values = np.full(len(vectors), np.nan)
        for i, name in enumerate(vectors):
            info = get(name)
            if info != null and info.v_realdata != null:
                values[i] = info.v_realdata[0]
        return values


def require_ngspice() -> None:
    """Look for libngspice and PySpice without loading PySpice, which takes as long as all other checks of a file.

    Raises:
        NgspiceMissingError: libngspice is not there or does not load.
        PySpiceMissingError: PySpice, or a package that it needs, is not installed.
    """
    find_ngspice()
    for package in ("PySpice", "cffi"):
        try:
            is_there = find_spec(package) is not None
        except ModuleNotFoundError:  # how an importer of somebody else says it
            is_there = False
        if not is_there:
            raise PySpiceMissingError(package)


@functools.cache
def ngspice() -> Ngspice:
    """The ngspice of this process, loaded at the first call.

    Raises:
        NgspiceMissingError: libngspice is not there or does not load.
    """
    return Ngspice()


class Circuit:
    """One netlist in ngspice, whose elements are altered and whose operating point is solved.

    Args:
        netlist: Text of the netlist without its title line.
        vectors: Node voltages (`n1`) and branch currents (`v1#branch`) to read.

    Raises:
        NgspiceMissingError: libngspice is not there.
        NgspiceError: ngspice cannot read the netlist.
    """

    def __init__(self, netlist: str, vectors: Sequence[str]) -> None:
        self._engine = ngspice()
        self._title = f"* circuit {next(_titles)}"
        self._vectors = [v.encode("ascii") for v in vectors]
        self._names = tuple(vectors)
        with self._engine.lock:
            self._engine.load(f"{self._title}\n{netlist}")

    def solve(self, changes: Mapping[str, float]) -> Array:
        """Alter elements and solve the operating point.

        Args:
            changes: Element to its new value [V, ohm]. Finite, and resistances positive: ngspice keeps the old value
                where it cannot read the new one, and takes negative ones as they are.

        Returns:
            Value of each vector [V, A], shape (vectors,).

        Raises:
            NgspiceError: A change is not finite, or ngspice has no finite solution.
        """
        for element, value in changes.items():
            if not np.isfinite(value):
                raise NgspiceError(f"{element} = {value} is not a finite number")
        engine = self._engine
        with engine.lock:
            engine.select(self._title)
            try:
                for element, value in changes.items():
                    engine.command(f"alter {element} = {value!r}")
                engine.command("op")
                values = engine.read(self._vectors)
            finally:
                engine.command("destroy all")  # without it every further solution is slower: 64 ms after 1500
        missing = np.flatnonzero(~np.isfinite(values))
        if missing.size:
            raise NgspiceError(f"ngspice has no finite value of {self._names[int(missing[0])]}")
        return values

    def remove(self) -> None:
        """Free it in ngspice; safe to call twice."""
        with self._engine.lock:
            self._engine.remove(self._title)
