"""`python -m evaluation.systems --cases N --seed S --out DIR`: draw cases, diagnose each, open the answers, score.

Every case is diagnosed by `cosim diagnose --brief` in a process that is given its recordings alone. What is done in the
folder is kept; the same command goes on. The library is frozen before the draw: the commit is written down, a work tree
with changes is refused, and so is going on with another commit.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from evaluation.command import run_logged
from evaluation.systems.case import KINDS, RECORDINGS, make
from evaluation.systems.score import page


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.systems", description=__doc__)
    parser.add_argument("--cases", type=int, default=120)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=float, default=1200.0, help="longest time of one diagnosis [s]")
    parser.add_argument("--page", type=Path, help="where the tables go")
    parser.add_argument("--so-far", action="store_true", help="score what is done")
    given = parser.parse_args()
    kinds = list(KINDS)
    rng = np.random.default_rng(given.seed)
    drawn = rng.choice(kinds, given.cases, p=list(KINDS.values())).tolist()
    folders = [given.out / f"case_{n + 1}" for n in range(given.cases)]

    def one(number: int) -> None:
        folder = folders[number]
        if not (folder / "answer.json").is_file():
            make(folder, drawn[number], given.seed, number)
        if not (folder / "done").is_file():
            _diagnose(folder, given.limit)
            print(f"{number + 1} of {given.cases}: {drawn[number]}", flush=True)

    given.out.mkdir(parents=True, exist_ok=True)
    try:
        commit = frozen(given.out, given.seed, given.cases, only_read=given.so_far)
    except NotFrozen as reason:
        print(f"{given.out}: {reason}", file=sys.stderr)
        return 2
    print(f"library frozen at {commit}", flush=True)
    if not given.so_far:
        with ThreadPoolExecutor(given.jobs) as pool:
            list(pool.map(one, range(given.cases)))
    text = page([f for f in folders if (f / "done").is_file()], given.seed, given.cases, commit)
    (given.page or given.out / "page.md").write_text(text, encoding="utf-8")
    print(text)
    return 0


class NotFrozen(Exception):
    """The library may have changed since the draw; the text says why."""


def frozen(out: Path, seed: int, cases: int, only_read: bool = False) -> str:
    """Commit of the library with which a folder's cases are diagnosed; the first call writes it down.

    Raises:
        NotFrozen: The folder is of another draw or another commit, or the work tree has changes.
    """
    file = out / "frozen.json"
    if only_read and file.is_file():
        return str(json.loads(file.read_text(encoding="utf-8"))["commit"])
    commit = _git("rev-parse", "--short", "HEAD")
    changes = _git("status", "--porcelain", "--untracked-files=no")
    if changes:
        raise NotFrozen("the work tree has changes that no commit names; commit them, then draw")
    now = {"commit": commit, "seed": seed, "cases": cases}
    if not file.is_file():
        file.write_text(json.dumps(now), encoding="utf-8")
    then = json.loads(file.read_text(encoding="utf-8"))
    if then != now:
        raise NotFrozen(f"it was drawn as {then}, not as {now}; take another folder")
    return commit


def _git(*arguments: str) -> str:
    done = subprocess.run(["git", *arguments], capture_output=True, text=True, check=False)
    return done.stdout.strip()


def _diagnose(folder: Path, limit: float) -> None:
    task = folder / "task"
    without = json.loads((folder / "answer.json").read_text(encoding="utf-8"))["without"]
    command = ["diagnose", "scenario.yaml", "--brief", "--out", "../diagnosis"]
    for name in RECORDINGS[:-1]:
        command += ["--recording", name]
    command += ["--held-out", RECORDINGS[-1]]
    for name in without:
        command += ["--without", name]
    code = run_logged(command, task, limit, folder / "log.txt")
    (folder / "done").write_text(str(code), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
