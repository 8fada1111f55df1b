"""Which tools are measured and where their interpreters are."""

from __future__ import annotations

import os
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Tool:
    """One entry of the tables.

    Args:
        name: As printed.
        module: File in `entries/`.
        python: Interpreter that has it; None: not installed.
        versions: FMI versions that it runs.
        has_csv: Whether it can record every step.
        is_peer: False for this project and for the floor.
        steps: Macro-steps of the chain: fewer where it is slow.
    """

    name: str
    module: str
    python: str | None
    versions: tuple[int, ...] = (2, 3)
    has_csv: bool = True
    is_peer: bool = True
    steps: int = 100_000


def _interpreter(variable: str) -> str | None:
    """Interpreter in the virtual environment that an environment variable names."""
    folder = os.environ.get(variable)
    python = Path(folder, "bin", "python") if folder else None
    return str(python) if python and python.exists() else None


def tools() -> list[Tool]:
    """All tools, installed or not. PEERS_VENV, COFMUPY_VENV, PYFMI_VENV: folders; MASTERSIM: a program."""
    peers, cofmupy, pyfmi = (_interpreter(v) for v in ("PEERS_VENV", "COFMUPY_VENV", "PYFMI_VENV"))
    mastersim = sys.executable if shutil.which(os.environ.get("MASTERSIM", "")) else None
    return [
        Tool("C floor", "c_floor", sys.executable, (2,), has_csv=False, is_peer=False),
        Tool("this project", "cosim", sys.executable, is_peer=False),
        Tool("FMPy, loop by hand", "fmpy_loop", sys.executable),
        Tool("FMPy container", "fmpy_container", peers, has_csv=False),
        Tool("fmucontainer", "fmu_container", peers, has_csv=False),
        Tool("libcosim (libcosimpy)", "libcosimpy", peers, (2,)),
        Tool("ecos (ecospy)", "ecospy", peers),
        Tool("MasterSim", "mastersim", mastersim, (2,)),
        Tool("PyFMI master", "pyfmi", pyfmi, (2,), steps=20_000),
        Tool("CoFmuPy", "cofmupy", cofmupy, steps=20_000),
    ]


def environment() -> dict[str, str]:
    """Environment of every tool's process: the repository on the path, single-threaded BLAS."""
    repository = Path(__file__).resolve().parent.parent.parent
    library = os.path.join(os.environ.get("PEERS_VENV", ""), "lib")  # ecos needs libtbb, which the package tbb brings
    return {**os.environ, "PYTHONPATH": str(repository), "OPENBLAS_NUM_THREADS": "1", "LD_LIBRARY_PATH": library}
