"""The command line of the product in a process of its own, as a user calls it; cases are diagnosed by it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

#: Exit code of a command that took longer than its limit.
TOO_LONG = -1


def run_cosim(
    arguments: Sequence[str], folder: Path, limit: float, **streams: Any
) -> subprocess.CompletedProcess[str] | None:
    """Run `cosim` with the packages of the working folder; None where it took too long.

    Args:
        arguments: After `cosim`.
        folder: Where it runs: it is given what is there.
        limit: Longest time [s].
        streams: Of `subprocess.run`: where its output goes.
    """
    command = [sys.executable, "-m", "cosim.cli", *arguments]
    own = {**os.environ, "PYTHONPATH": os.getcwd()}
    try:
        return subprocess.run(command, cwd=folder, env=own, timeout=limit, text=True, check=False, **streams)
    except subprocess.TimeoutExpired:
        return None


def run_logged(arguments: Sequence[str], folder: Path, limit: float, log: Path) -> int:
    """The same with all of its output in a file; returns the exit code, or `TOO_LONG`."""
    with log.open("w", encoding="utf-8") as file:
        done = run_cosim(arguments, folder, limit, stdout=file, stderr=subprocess.STDOUT)
    return TOO_LONG if done is None else done.returncode
