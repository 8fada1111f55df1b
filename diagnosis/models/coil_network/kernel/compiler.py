"""Compiles the network's source once and keeps the library in the user's cache."""

from __future__ import annotations

import ctypes
import hashlib
import os
import platform
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

#: No -ffast-math: it would let sums be reordered and NaN go unnoticed. Traps and errno of the maths library are never
#: read, and without these two flags gcc does not turn comparisons and square roots into vector code.
FLAGS = ("-std=gnu11", "-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math", "-fPIC", "-shared")
_INSTALL = "install gcc (Debian, Ubuntu: `apt install build-essential`; Fedora: `dnf install gcc`; macOS: Xcode tools)"


class CompilerError(Exception):
    """The network cannot be compiled: why, and what to do."""


def cache_folder() -> Path:
    """Where compiled networks are kept: `COSIM_CACHE`, else the user's cache folder (XDG base directories)."""
    own = os.environ.get("COSIM_CACHE")
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(own) if own else Path(base) / "cosim" / "network"


def compiler() -> str:
    """Path of the C compiler: `CC` if it is set, else gcc or cc.

    Raises:
        CompilerError: There is none.
    """
    named = os.environ.get("CC")
    found = shutil.which(named) if named else shutil.which("gcc") or shutil.which("cc")
    if found is None:
        raise CompilerError(f"the coil network needs a C compiler, and {named or 'gcc'} was not found: {_INSTALL}")
    return found


def _processor() -> str:
    """What -march=native depends on: a cache folder may be shared between machines."""
    information = Path("/proc/cpuinfo")
    lines = information.read_text().splitlines() if information.is_file() else []
    chosen = [line for line in lines if line.startswith(("flags", "Features", "model name"))][:2]
    return "\n".join([platform.machine(), platform.processor(), *chosen])


def library_path(source: str) -> Path:
    """Compiled library of a source; compiles it if the cache does not hold it.

    Raises:
        CompilerError: There is no compiler, it refuses the source, or the cache folder cannot be written.
    """
    tool = compiler()
    version = subprocess.run([tool, "--version"], capture_output=True, text=True, check=False).stdout
    identity = "\n".join([source, " ".join(FLAGS), tool, version, _processor()])
    name = hashlib.sha256(identity.encode()).hexdigest()[:32]
    folder = cache_folder()
    path = folder / f"{name}.so"
    if path.is_file():
        return path
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder) as work:
            _compile(tool, source, Path(work))
            (Path(work) / "network.so").replace(path)  # in one move: another process may be doing the same
    except OSError as error:
        raise CompilerError(
            f"the folder for compiled networks cannot be used ({error}): "
            "set COSIM_CACHE to a folder that can be written"
        ) from error
    return path


def _compile(tool: str, source: str, folder: Path) -> None:
    (folder / "network.c").write_text(source)
    command = [tool, *FLAGS, "-o", str(folder / "network.so"), str(folder / "network.c"), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise CompilerError(f"{tool} refused the network's source:\n{done.stderr[:4000]}")


@cache
def load(source: str) -> ctypes.CDLL:
    """The loaded library of a source.

    Raises:
        CompilerError: See `library_path`.
    """
    path = library_path(source)
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        raise CompilerError(f"the compiled network {path} does not load ({error}): delete it and try again") from error
