"""`python -m evaluation.strangers.spoiled --seed S --out DIR`: rigs of all sets on which nothing is wrong, spoiled.

Of each case that conceals nothing, one recording is spoiled by a fault that is drawn, and put to the check that stands
before every diagnosis. Scored are its serious doubts: right are those of the spoiled recording that name the kind of
fault and what it is of, or say that it stands out; every other one is false. One case of eight stays as it is. What is
done in the folder is kept; the same command goes on.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
import zlib
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.strangers.__main__ import SETS, convert, make
from evaluation.strangers.spoil import FAULTS, Fault, read, written
from evaluation.strangers.truth import FINE

#: Kinds of doubts that say what was done, by kind of fault. A gain is a scale, whatever its unit.
RIGHT = {
    "unit": ("unit", "scale"),
    "gain": ("unit", "scale"),
    "sign": ("sign", "turned", "unit", "scale"),
    "swapped": ("swapped",),
    "clock": ("clock", "dead time"),
    "sensor": ("sensor", "range", "noise"),
    "input": ("input", "programme", "other run", "number"),
}
#: What says no more than that a recording is not like the others, or that its readings do not follow.
OPEN = ("odd one out", "no answer")
#: Recordings that are refused in words, as too few readings are.
REFUSED = "refused"


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.strangers.spoiled", description=__doc__)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--sets", nargs="*", default=sorted(SETS), help="names of sets")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    given = parser.parse_args()
    named = {c.__name__: (name, n) for name in reversed(given.sets) for n, c in enumerate(SETS[name])}
    cases = sorted(named.values())  # a name that two sets have is drawn once
    given.out.mkdir(parents=True, exist_ok=True)
    tasks = [(given.out.resolve(), name, n, given.seed) for name, n in cases]
    with ProcessPoolExecutor(given.jobs, get_context("spawn"), max_tasks_per_child=1) as pool:
        answers = []
        for answer in pool.map(_asked, tasks):
            if answer is not None:
                answers.append(answer)
                print(" | ".join(str(answer[k]) for k in ("case", "fault", "told", "answer", "says")), flush=True)
    print(summary(answers))
    return 0


def summary(answers: Sequence[dict[str, Any]]) -> str:
    """Counts of answers by kind of fault, as a table."""
    lines = ["| fault | cases | named | stands out | silent | false | refused |", "|---|---|---|---|---|---|---|"]
    for kind in (*RIGHT, "nothing"):
        found = Counter(a["answer"] for a in answers if a["fault"] == kind)
        counts = " | ".join(str(found[k]) for k in ("named", "stands out", "silent", "false", REFUSED))
        lines.append(f"| {kind} | {sum(found.values())} | {counts} |")
    return "\n".join(lines)


def _asked(task: tuple[Path, str, int, int]) -> dict[str, Any] | None:
    """The answer to one case, kept in its folder; None where it conceals something, or cannot be spoiled so."""
    out, name, number, seed = task
    case = SETS[name][number]
    folder = out / case.__name__
    kept = folder / "spoiled.json"
    if not kept.is_file():
        if not (folder / "answer.json").is_file():
            make(case, folder, seed)
        found: dict[str, Any] | None = None
        if tuple(json.loads((folder / "answer.json").read_text(encoding="utf-8"))["right"]) == FINE:
            found = _spoiled(folder, np.random.default_rng([seed, zlib.crc32(case.__name__.encode()), 1]))
        else:
            shutil.rmtree(folder / "task")
        kept.write_text(json.dumps(found, indent=1), encoding="utf-8")
    answer: dict[str, Any] | None = json.loads(kept.read_text(encoding="utf-8"))
    return answer


def _spoiled(folder: Path, rng: np.random.Generator) -> dict[str, Any]:
    """The answer to a case that conceals nothing: with a fault, or in one of eight as it is."""
    convert(folder, 120.0)
    truth = json.loads((folder / "answer.json").read_text(encoding="utf-8"))
    names = [*truth["training"], *truth["held_out"]]
    fault = None
    if rng.random() > 1.0 / 8.0:
        for place in rng.permutation(len(FAULTS)):
            files = read(folder / "task" / str(rng.choice(names)))
            fault = FAULTS[int(place)](files, rng)
            if fault is not None:
                written(files)
                break
    doubts = _checked(folder / "task", names)
    return {"case": folder.name, **_scored(fault, doubts), "doubts": doubts}


def _checked(task: Path, names: Sequence[str]) -> list[dict[str, Any]]:
    """Serious doubts, or the error in the place of them."""
    from cosim.scenario import load_scenario
    from cosim.unit.errors import InputError
    from diagnosis.check.check import check_recordings
    from diagnosis.recording.recording import load_recording

    try:
        found = check_recordings(load_scenario(task / "scenario.yaml"), [load_recording(task / n) for n in names])
    except InputError as error:
        return [{"recording": "", "subject": "", "kind": REFUSED, "statement": str(error), "is_serious": True}]
    keys = ("recording", "subject", "kind", "statement", "is_serious")
    return [{k: getattr(d, k) for k in keys} for d in found]


def _scored(fault: Fault | None, doubts: Sequence[dict[str, Any]]) -> dict[str, str]:
    """What was done, and whether the serious doubts say so."""
    serious = [d for d in doubts if d["is_serious"]]
    if any(d["kind"] == REFUSED for d in serious):
        return {"fault": fault.kind if fault else "nothing", "told": "", "answer": REFUSED, "says": ""}
    says = "; ".join(f"{d['recording']}, {d['subject']}: {d['kind']}" for d in serious)
    if fault is None:
        return {"fault": "nothing", "told": "", "answer": "false" if serious else "silent", "says": says}
    title = fault.recording.replace("_", " ")

    def is_right(doubt: dict[str, Any]) -> bool:
        is_there = not fault.subjects or any(s in doubt["subject"] for s in fault.subjects)
        return doubt["kind"] in RIGHT[fault.kind] and is_there

    if any(d["recording"] != title or not (is_right(d) or d["kind"] in OPEN) for d in serious):
        answer = "false"
    elif any(is_right(d) for d in serious):
        answer = "named"
    else:
        answer = "stands out" if serious else "silent"
    return {"fault": fault.kind, "told": f"{fault.recording}: {fault.told}", "answer": answer, "says": says}


if __name__ == "__main__":
    sys.exit(main())
