"""`python -m evaluation.fabrics --cases N --seed S --out DIR`: draw small fabrics, diagnose each, score the answers.

Every case is diagnosed by `cosim diagnose --brief` in a process that is given its recordings alone. What is done in the
folder is kept; the same command goes on.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

from evaluation.command import run_logged
from evaluation.fabrics.score import page, score
from evaluation.proving.fabric.case import KINDS, RIGS, write_cases


def main(arguments: list[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.fabrics", description=__doc__)
    parser.add_argument("--cases", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", default="", choices=["", *KINDS], help="this kind alone")
    parser.add_argument("--rig", default="heated", choices=list(RIGS), help="which fabric (default: heated)")
    parser.add_argument("--visible", type=float, default=0.0, help="effects move the markers by at least this [mm]")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--limit", type=float, default=3600.0, help="longest time of one diagnosis [s]")
    parser.add_argument("--so-far", action="store_true", help="score what is done")
    given = parser.parse_args(arguments)
    names = [f"fabric_{n + 1:03d}" for n in range(given.cases)]
    if not given.so_far:
        write_cases(given.out, given.cases, given.seed, given.kind, given.rig, 1e-3 * given.visible)
        for number, name in enumerate(names):
            if not (given.out / "diagnoses" / name / "done.json").is_file():
                _diagnose(given.out / "cases" / name, given.out / "diagnoses" / name, given.limit)
                print(f"{number + 1} of {given.cases}", flush=True)
    scores = [score(given.out, n) for n in names if (given.out / "diagnoses" / n / "done.json").is_file()]
    text = page(scores, given.seed, given.cases)
    given.out.mkdir(parents=True, exist_ok=True)
    (given.out / "page.md").write_text(text, encoding="utf-8")
    print(text)
    return 0


def _diagnose(case: Path, out: Path, limit: float) -> None:
    out.mkdir(parents=True, exist_ok=True)
    answer = (out / "answer").resolve()
    command = ["diagnose", "scenario.yaml", "--brief", "--jobs", "1"]
    command += ["--recording", "training_1", "--held-out", "held_out_1", "--out", str(answer)]
    if (answer / "simulations").is_dir():
        command.append("--resume")
    begin = time.perf_counter()
    code = run_logged(command, case, limit, out / "log.txt")
    told = {"code": code, "seconds": time.perf_counter() - begin}
    (out / "done.json").write_text(json.dumps(told), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
