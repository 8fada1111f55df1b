"""`python -m evaluation.systems --cases N --seed S --out DIR`: draw cases, diagnose each, open the answers, score.

Every case is diagnosed by `cosim diagnose --brief` in a process that is given its recordings alone. What is done in the
folder is kept; the same command goes on.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

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

    if not given.so_far:
        with ThreadPoolExecutor(given.jobs) as pool:
            list(pool.map(one, range(given.cases)))
    text = page([f for f in folders if (f / "done").is_file()], given.seed, given.cases)
    (given.page or given.out / "page.md").write_text(text, encoding="utf-8")
    print(text)
    return 0


def _diagnose(folder: Path, limit: float) -> None:
    task = folder / "task"
    without = json.loads((folder / "answer.json").read_text(encoding="utf-8"))["without"]
    command = [sys.executable, "-m", "cosim.cli", "diagnose", "scenario.yaml", "--brief", "--out", "../diagnosis"]
    for name in RECORDINGS[:-1]:
        command += ["--recording", name]
    command += ["--held-out", RECORDINGS[-1]]
    for name in without:
        command += ["--without", name]
    with (folder / "log.txt").open("w", encoding="utf-8") as log:
        try:
            code = subprocess.run(
                command,
                cwd=task,
                stdout=log,
                stderr=subprocess.STDOUT,
                timeout=limit,
                env={**os.environ, "PYTHONPATH": os.getcwd()},
                check=False,
            ).returncode
        except subprocess.TimeoutExpired:
            code = -1
    (folder / "done").write_text(str(code), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
