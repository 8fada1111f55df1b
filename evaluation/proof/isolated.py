"""A case diagnosed in another process, which is given the files of that case and nothing else."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time as clock
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from evaluation.proof.ground import read_task

#: Files of a folder: path inside it to content.
Files = Mapping[str, bytes]
#: Exit code of `cosim diagnose` for a scenario or recording that it cannot work with.
REFUSED = 2
#: `cosim` in a process that hears Ctrl-C, though the worker that starts it is deaf to it.
_PROGRAM = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); from cosim.cli import main; main()"


@dataclass(frozen=True)
class Attempt:
    """What came of the diagnosis of a case.

    Args:
        case: Name of the case.
        outcome: `diagnosed`, `refused` (in words), `failed` or `timed out`.
        message: Why there is no diagnosis.
        seconds: Wall time of the process.
        diagnosis: Content of diagnosis.json, or None.
    """

    case: str
    outcome: str
    message: str
    seconds: float
    diagnosis: str | None = None

    def as_json(self) -> dict[str, Any]:
        """As plain values."""
        return asdict(self)


def files_of(folder: Path) -> Files:
    """All files below a folder."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def write_files(files: Files, folder: Path) -> None:
    """Write files as `files_of` read them."""
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def diagnose_apart(case: str, files: Files, limit: float) -> Attempt:
    """Diagnose a case in a process of its own, in a folder that holds nothing but the case.

    The answers lie elsewhere, and on a cluster not even on the same machine.

    Args:
        case: Name of the case.
        files: Its scenario, task and recordings.
        limit: Longest wall time [s].
    """
    with tempfile.TemporaryDirectory(prefix="cosim_prove_") as name:
        folder = Path(name) / case
        write_files(files, folder)
        out = Path(name) / "out"
        begin = clock.perf_counter()
        try:
            ended = subprocess.run(
                _command(folder, out),
                capture_output=True,
                text=True,
                check=False,
                timeout=limit,
                cwd=folder,
                env=_environment(),
            )
        except subprocess.TimeoutExpired:
            return Attempt(case, "timed out", f"no answer within {limit:g} s", clock.perf_counter() - begin)
        seconds = clock.perf_counter() - begin
        if ended.returncode:
            outcome = "refused" if ended.returncode == REFUSED else "failed"
            return Attempt(case, outcome, _last_words(ended.stderr, folder), seconds)
        return Attempt(case, "diagnosed", "", seconds, (out / "diagnosis.json").read_text(encoding="utf-8"))


def _command(folder: Path, out: Path) -> list[str]:
    task = read_task(folder)
    command = [sys.executable, "-c", _PROGRAM, "diagnose", "scenario.yaml", "--out", str(out), "--jobs", "1", "--brief"]
    for option, names in (("--recording", task.training), ("--held-out", task.held_out), ("--without", task.hidden)):
        for name in names:
            command += [option, name]
    return command


def _environment() -> dict[str, str]:
    """One thread each: as many cases run at once as there are processors."""
    package = str(Path(__file__).resolve().parents[2])
    path = os.pathsep.join([package, *filter(None, [os.environ.get("PYTHONPATH")])])
    return {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "PYTHONPATH": path}


def _last_words(text: str, folder: Path) -> str:
    """The message of an error without the temporary folder, or the end of a traceback."""
    lines = [line for line in text.strip().splitlines() if line.strip()] or ["no message"]
    begin = next((i for i, line in enumerate(lines) if line.startswith("error:")), len(lines) - 1)
    return " ".join(line.strip() for line in lines[begin:]).replace(str(folder), "").strip()
