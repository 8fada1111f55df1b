"""`python -m evaluation.sensitivity --package judge --cases DIR --out DIR`: halve and double every number.

Each constant of a package of the diagnosis is halved and doubled in a copy of its source, and the cases are diagnosed
again; the page says whose verdict or findings change. What is done in the folder is kept; the same command goes on.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from evaluation.sensitivity.variant import ROOT, Constant, constants, write_variant

FACTORS = (0.5, 2.0)
#: What a case is where its process did not end.
_NOT_ENDED = {"verdict": "did not end", "accepted": []}
_Answers = dict[str, Mapping[str, Any]]


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.sensitivity", description=__doc__)
    parser.add_argument("--package", required=True, help="folder in diagnosis/")
    parser.add_argument("--only", default="", help="constants whose name contains this, as `judge.agreement`")
    parser.add_argument("--cases", type=Path, nargs="+", required=True, help="folders with task/ and answer.json")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--limit", type=float, default=900.0, help="longest time for all cases [s]")
    given = parser.parse_args()
    missing = [f for f in given.cases if not (f / "answer.json").is_file()]
    if missing:
        print(f"{missing[0]}: this is no case: it has no answer.json", file=sys.stderr)
        return 2
    given.out.mkdir(parents=True, exist_ok=True)
    cases = [f.resolve() for f in given.cases]
    as_it_is = _kept(given.out / "as_it_is.json", lambda: answers(cases, [ROOT], given.limit))
    chosen = [c for c in constants(given.package) if given.only in c.key]
    found: list[tuple[Constant, list[str]]] = []
    for number, constant in enumerate(chosen):
        cells = []
        for factor in FACTORS:
            value = constant.at(factor)
            file = given.out / f"{constant.key}_{factor:g}.json"
            now = None if value is None else _kept(file, lambda c=constant, v=value: _of(c, v, cases, given.limit))
            cells.append("as it is" if now is None else changes(as_it_is, now))
        found.append((constant, cells))
        print(f"{number + 1} of {len(chosen)}: {constant.key}: {' | '.join(cells)}", flush=True)
    text = page(given.package, list(as_it_is), found)
    (given.out / "page.md").write_text(text, encoding="utf-8")
    return 0


def _kept(file: Path, make: Any) -> _Answers:
    """What a file holds, or what is made and written to it."""
    if not file.is_file():
        made = make()
        part = file.with_suffix(".part")
        part.write_text(json.dumps(made), encoding="utf-8")
        part.replace(file)
    return dict(json.loads(file.read_text(encoding="utf-8")))


def _of(constant: Constant, value: float | int, cases: Sequence[Path], limit: float) -> _Answers:
    with tempfile.TemporaryDirectory() as folder:
        write_variant(constant, value, Path(folder))
        return answers(cases, [Path(folder), ROOT], limit)


def answers(cases: Sequence[Path], path: Sequence[Path], limit: float) -> _Answers:
    """Case to what is found in it, by the packages of a path; those that did not end say so.

    Args:
        cases: Folders.
        path: Where packages are looked for, in this order.
        limit: Longest time for all [s].
    """
    command = [sys.executable, "-P", "-m", "evaluation.sensitivity.answers", *map(str, cases)]
    own = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, path))}
    with tempfile.TemporaryDirectory() as here:
        try:
            done = subprocess.run(
                command,
                cwd=here,
                env=own,
                timeout=limit,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                check=False,
            )
            text = done.stdout
        except subprocess.TimeoutExpired as stopped:
            text = stopped.stdout or b""
    found: _Answers = {case.name: _NOT_ENDED for case in cases}
    for line in text.decode("utf-8").splitlines():
        if line.startswith("{"):
            one = json.loads(line)
            found[one.pop("case")] = one
    return found


def changes(before: Mapping[str, Mapping[str, Any]], now: Mapping[str, Mapping[str, Any]]) -> str:
    """What is another answer, case by case; `-` where nothing is."""
    told = []
    for case, old in before.items():
        new = now[case]
        if new["verdict"] != old["verdict"]:
            told.append(f"{case}: {old['verdict']} -> {new['verdict']}")
        elif new["accepted"] != old["accepted"]:
            told.append(
                f"{case}: {', '.join(old['accepted']) or 'nothing'} -> {', '.join(new['accepted']) or 'nothing'}"
            )
    return "; ".join(told) or "-"


def page(package: str, cases: Sequence[str], found: Sequence[tuple[Constant, Sequence[str]]]) -> str:
    """The table as Markdown, what changes something first."""
    moved = [one for one in found if any(cell not in ("-", "as it is") for cell in one[1])]
    still = [one for one in found if one not in moved]
    rows = [f"| `{c.key}` | {c.value:g} | {half} | {twice} |" for c, (half, twice) in moved]
    names = ", ".join(f"`{c.key}`" for c, _ in still)
    return "\n".join(
        [
            f"### {package}",
            "",
            f"{len(found)} numbers, {len(cases)} cases ({', '.join(cases)}). {len(moved)} of them change an answer:",
            "",
            "| number | value | halved | doubled |",
            "|---|---|---|---|",
            *rows,
            "",
            f"Neither halved nor doubled do these change any of these answers: {names}.",
            "",
        ]
    )


if __name__ == "__main__":
    sys.exit(main())
