"""`python -m evaluation.strangers.searched --draw DIR --seed S --cases N --out DIR2`: the search, put to spoiled ones.

Of the recordings that `evaluation.strangers.spoiled` has spoiled, the check leaves some to the search. A drawn part of
them is diagnosed. The rigs lack nothing, so physics is a false claim; which fault is said is for a person to read: the
headline stands beside what was done. What is done in the folder is kept; the same command goes on.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.strangers.__main__ import diagnose
from evaluation.strangers.truth import FINE, OPEN, PHYSICS

#: Answers to a spoiled recording whose rig lacks nothing.
ANSWERS = ("physics", "fault", "agrees", "cannot tell", "none")


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.strangers.searched", description=__doc__)
    parser.add_argument("--draw", type=Path, required=True, help="folder of evaluation.strangers.spoiled")
    parser.add_argument("--seed", type=int, default=1, help="of the part that is drawn")
    parser.add_argument("--cases", type=int, default=20)
    parser.add_argument("--limit", type=float, default=300.0, help="longest time of one diagnosis [s]")
    parser.add_argument("--out", type=Path, required=True)
    given = parser.parse_args()
    answers = []
    for name in drawn(left_to_search(given.draw), given.seed, given.cases):
        folder = (given.out / name).resolve()
        if not (folder / "task").is_dir():
            shutil.copytree(given.draw / name, folder)
        if not (folder / "log.txt").is_file():
            diagnose(folder, given.limit)
        answers.append(answer_of(folder))
        print(" | ".join(str(answers[-1][k]) for k in ("case", "told", "answer", "says")), flush=True)
    print(summary(answers))
    return 0


def left_to_search(draw: Path) -> list[str]:
    """Names of the cases that were spoiled and of which the check has no serious doubt, in order."""
    found = []
    for file in sorted(draw.glob("*/spoiled.json")):
        answer = json.loads(file.read_text(encoding="utf-8"))
        if answer is not None and answer["answer"] == "silent" and answer["fault"] != "nothing":
            found.append(file.parent.name)
    return found


def drawn(names: Sequence[str], seed: int, count: int) -> list[str]:
    """So many of the names by a seed, at most all of them."""
    order = np.random.default_rng(seed).permutation(len(names))
    return [names[int(n)] for n in order[:count]]


def answer_of(folder: Path) -> dict[str, Any]:
    """What was done to a case, and what the search says."""
    spoiled = json.loads((folder / "spoiled.json").read_text(encoding="utf-8"))
    file = folder / "diagnosis" / "diagnosis.json"
    if not file.is_file():
        says = (folder / "log.txt").read_text(encoding="utf-8").strip().split("\n")[-1]
        return {"case": folder.name, "told": spoiled["told"], "answer": "none", "says": says}
    found = json.loads(file.read_text(encoding="utf-8"))
    return {
        "case": folder.name,
        "told": spoiled["told"],
        "answer": kind_of(found["verdict"]),
        "says": found["statement"],
    }


def kind_of(verdict: str) -> str:
    """Of an answer, one of `ANSWERS`, by its verdict."""
    if verdict in PHYSICS:
        return "physics"
    if verdict in FINE:
        return "agrees"
    return "cannot tell" if verdict in OPEN else "fault"


def summary(answers: Sequence[dict[str, Any]]) -> str:
    """Counts of answers in words."""
    found = Counter(a["answer"] for a in answers)
    return f"{len(answers)} cases: " + ", ".join(f"{kind} {found[kind]}" for kind in ANSWERS)


if __name__ == "__main__":
    sys.exit(main())
