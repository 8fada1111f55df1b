"""`python -m evaluation.strangers --set first --seed S --out DIR`: recordings of foreign rigs, diagnosed and scored.

Every case is diagnosed by `cosim diagnose --brief` in a process that is given its recordings alone. What is done in the
folder is kept; the same command goes on. Scored is what a table can hold: the verdict, and whether a law has a name
that is not the truth's. Sentences are for a person to read; `log.txt` has them.
"""

from __future__ import annotations

import argparse
import json
import sys
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.command import run_cosim
from evaluation.strangers import (
    eighteenth_set,
    eighth_set,
    eleventh_set,
    fifteenth_set,
    fifth_set,
    first_set,
    fourteenth_set,
    fourth_set,
    nineteenth_set,
    ninth_set,
    second_set,
    seventeenth_set,
    seventh_set,
    sixteenth_set,
    sixth_set,
    tenth_set,
    third_set,
    thirteenth_set,
    thirtieth_set,
    thirty_first_set,
    twelfth_set,
    twentieth_set,
    twenty_eighth_set,
    twenty_fifth_set,
    twenty_first_set,
    twenty_fourth_set,
    twenty_ninth_set,
    twenty_second_set,
    twenty_seventh_set,
    twenty_sixth_set,
    twenty_third_set,
)
from evaluation.strangers.first_set import Rng
from evaluation.strangers.truth import OPEN, Truth

SETS = {
    "first": first_set.CASES,
    "second": second_set.CASES,
    "third": third_set.CASES,
    "fourth": fourth_set.CASES,
    "fifth": fifth_set.CASES,
    "sixth": sixth_set.CASES,
    "seventh": seventh_set.CASES,
    "eighth": eighth_set.CASES,
    "ninth": ninth_set.CASES,
    "tenth": tenth_set.CASES,
    "eleventh": eleventh_set.CASES,
    "twelfth": twelfth_set.CASES,
    "thirteenth": thirteenth_set.CASES,
    "fourteenth": fourteenth_set.CASES,
    "fifteenth": fifteenth_set.CASES,
    "sixteenth": sixteenth_set.CASES,
    "seventeenth": seventeenth_set.CASES,
    "eighteenth": eighteenth_set.CASES,
    "nineteenth": nineteenth_set.CASES,
    "twentieth": twentieth_set.CASES,
    "twenty_first": twenty_first_set.CASES,
    "twenty_second": twenty_second_set.CASES,
    "twenty_third": twenty_third_set.CASES,
    "twenty_fourth": twenty_fourth_set.CASES,
    "twenty_fifth": twenty_fifth_set.CASES,
    "twenty_sixth": twenty_sixth_set.CASES,
    "twenty_seventh": twenty_seventh_set.CASES,
    "twenty_eighth": twenty_eighth_set.CASES,
    "twenty_ninth": twenty_ninth_set.CASES,
    "thirtieth": thirtieth_set.CASES,
    "thirty_first": thirty_first_set.CASES,
}
#: Units of findings that are no physics.
MEASURED = ("measurement", "input")


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.strangers", description=__doc__)
    parser.add_argument("--set", choices=sorted(SETS), default="first")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--only", nargs="*", default=[], help="names of cases")
    parser.add_argument("--limit", type=float, default=1200.0, help="longest time of one diagnosis [s]")
    given = parser.parse_args()
    rows = []
    for case in SETS[given.set]:
        name = case.__name__
        if given.only and name not in given.only:
            continue
        folder = (given.out / name).resolve()
        if not (folder / "answer.json").is_file():
            make(case, folder, given.seed)
        if not (folder / "log.txt").is_file():
            diagnose(folder, given.limit)
        rows.append(score(folder))
        print(" | ".join(rows[-1]), flush=True)
    return 0


def make(case: Callable[[Path, Rng], Truth], folder: Path, seed: int) -> None:
    """Write a case into `task`, its truth into `answer.json`; cases are drawn independently of each other."""
    truth = case(folder / "task", np.random.default_rng([seed, zlib.crc32(case.__name__.encode())]))
    (folder / "answer.json").write_text(json.dumps(truth.__dict__, indent=1), encoding="utf-8")


def convert(folder: Path, limit: float) -> None:
    """Write tables with decimal commas anew with points, as a user would."""
    truth, task = json.loads((folder / "answer.json").read_text(encoding="utf-8")), folder / "task"
    for name in (*truth["training"], *truth["held_out"]):
        table = task / name / "data.csv"
        if ";" in table.read_text(encoding="utf-8")[:200]:
            new = task / f"new_{name}"
            _cosim(
                task, ["recording", "new", f"{name}/data.csv", "--scenario", "scenario.yaml", "--out", str(new)], limit
            )
            table.write_text((new / "data.csv").read_text(encoding="utf-8"), encoding="utf-8")


def diagnose(folder: Path, limit: float) -> None:
    """Ask for a diagnosis."""
    convert(folder, limit)
    truth, task = json.loads((folder / "answer.json").read_text(encoding="utf-8")), folder / "task"
    asked = ["diagnose", "scenario.yaml", "--brief", "--out", "../diagnosis"]
    for key, names in (("--recording", truth["training"]), ("--held-out", truth["held_out"])):
        for name in names:
            asked += [key, name]
    (folder / "log.txt").write_text(_cosim(task, asked, limit), encoding="utf-8")


def _cosim(folder: Path, command: list[str], limit: float) -> str:
    done = run_cosim(command, folder, limit, capture_output=True)
    if done is None:
        return f"no answer within {limit:g} s\n"
    return done.stdout + done.stderr


def score(folder: Path) -> tuple[str, ...]:
    """Case, what is concealed, verdict, named physics, whether both are true."""
    truth = json.loads((folder / "answer.json").read_text(encoding="utf-8"))
    file = folder / "diagnosis" / "diagnosis.json"
    if not file.is_file():
        first = (folder / "log.txt").read_text(encoding="utf-8").strip().split("\n")[0]
        return folder.name, truth["concealed"], first, "", "refused"
    answer = json.loads(file.read_text(encoding="utf-8"))
    named = [f["effect"] for f in answer["findings"] if _is_named(f)]
    is_true = answer["verdict"] in (*truth["right"], *OPEN) and set(named) <= set(truth["names"])
    return folder.name, truth["concealed"], answer["verdict"], ", ".join(named), "true" if is_true else "false"


def _is_named(finding: Mapping[str, Any]) -> bool:
    return bool(finding["is_accepted"] and finding["standing"] == "named" and finding["unit"] not in MEASURED)


if __name__ == "__main__":
    sys.exit(main())
