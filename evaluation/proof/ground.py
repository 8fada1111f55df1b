"""The cases of a proof: made by the proving ground in a process of its own, read as files."""

from __future__ import annotations

import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import yaml

from cosim.unit.errors import InputError

#: File that says which library there was when cases were drawn.
_LIBRARY = "library.txt"


@dataclass(frozen=True)
class Draw:
    """Which cases are wanted.

    Args:
        cases: How many.
        seed: Of all draws.
        kinds: Only these kinds; empty: all.
        setups: Only these rigs; empty: all.
    """

    cases: int
    seed: int
    kinds: tuple[str, ...] = ()
    setups: tuple[str, ...] = ()


@dataclass(frozen=True)
class Task:
    """What a diagnosis is asked.

    Args:
        training: Names of the recordings that are fitted.
        held_out: Names of those that judge.
        hidden: Identifiers that are taken out of the catalogue.
    """

    training: tuple[str, ...]
    held_out: tuple[str, ...]
    hidden: tuple[str, ...]


def make_cases(folder: Path, draw: Draw) -> list[str]:
    """Write cases and answers into `folder` unless they are there, and return the names of the cases.

    Args:
        folder: Gets `cases/` and `answers/`.
        draw: Which cases.

    Raises:
        InputError: The proving ground refuses what is wanted, or the folder holds the cases of another draw.
    """
    note = folder / "draw.yaml"
    wanted = {"cases": draw.cases, "seed": draw.seed, "kinds": list(draw.kinds), "setups": list(draw.setups)}
    if note.is_file():
        if yaml.safe_load(note.read_text()) != wanted:
            raise InputError(
                folder,
                "",
                "this folder holds a proof of other cases",
                "give another folder with `--out`, or ask for the same cases again",
            )
    else:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / _LIBRARY).write_text(library_commit() + "\n", encoding="utf-8")
        try:
            _prove(folder, draw)
        except InputError:  # nothing was drawn: nothing is left behind
            (folder / _LIBRARY).unlink()
            for empty in (folder, folder.parent):
                with suppress(OSError):
                    empty.rmdir()
            raise
        note.write_text(yaml.safe_dump(wanted, sort_keys=False))
    return sorted(p.name for p in (folder / "cases").iterdir())


def library_commit() -> str:
    """Commit of this program, with `and local changes` where its files differ from it; `unknown` outside a clone."""
    root = Path(__file__).resolve().parents[2]

    def told(*arguments: str) -> str | None:
        try:
            made = subprocess.run(["git", *arguments], cwd=root, capture_output=True, text=True, check=False)
        except OSError:
            return None
        return None if made.returncode else made.stdout.strip()

    commit = told("rev-parse", "HEAD") if (root / ".git").exists() else None
    if not commit:
        return "unknown"
    return f"{commit} and local changes" if told("status", "--porcelain", "-uno", "--", "diagnosis") else commit


def drawn_with(folder: Path) -> str:
    """Commit of the library when the cases in a folder were drawn; `unknown` where nobody wrote it down."""
    note = folder / _LIBRARY
    return note.read_text(encoding="utf-8").strip() if note.is_file() else "unknown"


def _prove(folder: Path, draw: Draw) -> None:
    command = [sys.executable, "-m", "evaluation.proving", str(folder)]
    command += ["--cases", str(draw.cases), "--seed", str(draw.seed)]
    command += ["--kinds", ",".join(draw.kinds), "--setups", ",".join(draw.setups)]
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    if made.returncode:
        last = (made.stderr.strip().splitlines() or ["no message"])[-1]
        raise InputError("cosim prove", "", f"the proving ground made no cases: {last}", "see docs/proving.md")


def read_task(case: Path) -> Task:
    """The task of a case."""
    given = yaml.safe_load((case / "task.yaml").read_text())
    return Task(tuple(given["training"]), tuple(given["held_out"]), tuple(given["hidden"]))
