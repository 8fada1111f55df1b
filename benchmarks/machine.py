"""Where and when a table was measured."""

from __future__ import annotations

import datetime
import os
import platform
import subprocess
from pathlib import Path


def heading(title: str, command: str) -> str:
    """Markdown heading with date, commit and machine."""
    try:
        commit = subprocess.run(
            ["git", "rev-parse", "--short", "HEAD"],
            capture_output=True,
            text=True,
            check=True,
            cwd=Path(__file__).parent,
        ).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        commit = "unknown"
    today = datetime.datetime.now(tz=datetime.UTC).date()
    machine = f"{os.cpu_count()} cores, {platform.machine()}, {platform.system()}, Python {platform.python_version()}"
    return f"# {title}\n\n{today}, commit {commit}, {machine}. Command: `{command}`\n"


def results_folder() -> Path:
    """Folder of the dated tables."""
    folder = Path(__file__).parent / "results"
    folder.mkdir(exist_ok=True)
    return folder


def resident_memory() -> float:
    """Resident memory of this process [MiB] (Linux)."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20
