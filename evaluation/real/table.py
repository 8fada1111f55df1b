"""`python -m evaluation.real.table`: every public data set through `cosim diagnose`, and the table of the results."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import yaml

#: Data set and split to what hand-made models reached elsewhere on the same split: simple, extended.
ELSEWHERE: Mapping[tuple[str, str], tuple[float, float]] = {
    ("tclab", "energy_balance to second_order"): (1.79, 0.79),
    ("tclab", "second_order to energy_balance"): (2.46, 0.51),
    ("sma_limb", "c1 second pulse"): (7.3, 1.6),
    ("sma_limb", "c2 second pulse"): (8.9, 1.5),
    ("pendulum", "authors' split"): (0.206, 0.014),
    ("pendulum", "widest and smallest"): (0.206, 0.014),
}
#: Channels whose errors are put together: temperatures and angles.
_COUNTED = (".temperature", ".angle")
_STAGES = ("before", "recalibrated", "after")


def held_out_rmse(content: Mapping[str, Any], stage: str) -> float:
    """Root mean square error over all samples of held-out temperatures or angles together.

    Args:
        content: Of diagnosis.json.
        stage: `before`, `recalibrated` or `after`.
    """
    fits = [f for f in content["fit"] if f["is_held_out"] and f["channel"].endswith(_COUNTED)]
    samples = np.array([f["samples"] for f in fits], dtype=float)
    squares = np.array([f["rmse"][stage] ** 2 for f in fits])
    return float(np.sqrt(np.sum(samples * squares) / np.sum(samples)))


def tasks(recordings: Path) -> Iterator[tuple[str, str, list[str]]]:
    """Data set, split and the arguments of `cosim diagnose`, without `--out`."""
    for file in sorted(recordings.glob("*/splits.yaml")):
        content = yaml.safe_load(file.read_text(encoding="utf-8"))
        for split, parts in content["splits"].items():
            own = file.parent / content["scenario"]
            given = [str(own) if own.is_file() else content["scenario"]]
            for option, key in (("--recording", "training"), ("--held-out", "held_out")):
                for name in parts[key]:
                    given += [option, str(file.parent / name)]
            yield file.parent.name, split, given


def row(data_set: str, split: str, content: Mapping[str, Any]) -> str:
    """A line of the table."""
    unit = "rad" if data_set == "pendulum" else "K"
    figures = [f"{held_out_rmse(content, stage):.3g}" for stage in _STAGES]
    elsewhere = ELSEWHERE.get((data_set, split))
    told = f"{elsewhere[0]:g} -> {elsewhere[1]:g}" if elsewhere else "none"
    found = _listed(f for f in content["findings"] if f["is_accepted"])
    suggested = _listed(f for f in content["findings"] if not f["is_accepted"])
    cells = [
        f"{data_set}, {split}",
        *figures,
        told,
        unit,
        content["verdict"],
        found,
        suggested,
        f"{content['seconds']:.0f} s",
    ]
    return "| " + " | ".join(cells) + " |"


def _listed(findings: Iterable[Mapping[str, Any]]) -> str:
    """Effects with what they may be instead, and places; in quotation marks where only the description has a name."""
    told = []
    for one in findings:
        effect = " or ".join((one["effect"], *one["ambiguous_with"]))
        told.append(
            f"{effect} at {one['place']}"
            if one["is_named"] or one["standing"] == "class"
            else f'"{effect}" at {one["place"]}'
        )
    return "; ".join(told) or "nothing"


def main(arguments: list[str] | None = None) -> int:
    """Diagnose what has no diagnosis yet, print the table; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.real.table", description=__doc__)
    parser.add_argument("--recordings", type=Path, required=True, help="folder that `python -m evaluation.real` wrote")
    parser.add_argument("--out", type=Path, required=True, help="folder for the diagnoses")
    parser.add_argument("--only", default="", help="only data sets and splits whose name contains this")
    given = parser.parse_args(arguments)
    lines = [
        "| recording | before | recalibrated | amended | elsewhere | unit | verdict | found | suggested alone | time |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for data_set, split, call in tasks(given.recordings):
        if given.only not in f"{data_set}, {split}":
            continue
        out = given.out / f"{data_set} {split}".replace(" ", "_").replace("'", "")
        if not (out / "diagnosis.json").is_file():
            command = [sys.executable, "-m", "cosim.cli", "diagnose", *call, "--out", str(out)]
            print("cosim", " ".join(command[3:]), file=sys.stderr)
            done = subprocess.run(command, check=False)
            if done.returncode:
                return done.returncode
        lines.append(row(data_set, split, json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))))
    print("\n".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
