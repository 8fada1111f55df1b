"""`python -m evaluation.camera --cases N --seed S --out DIR`: film, track, diagnose, compare.

Each case is a small fabric with one concealed effect or none, recorded from two starts: one is fitted, the other
judges. It is diagnosed from its video and from the true places of its markers. Simulations are kept and shared by all
cases; what is done in the folder is kept, and the same command goes on.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from cosim.compute.batch import Batches
from cosim.compute.cache import Cache
from cosim.scenario import load_scenario
from diagnosis.diagnose import Means, diagnose
from diagnosis.recording.recording import load_recording
from diagnosis.recording.together import prepared
from diagnosis.report.json_file import write_json
from diagnosis.search.search import Settings
from evaluation.camera.case import RECORDINGS, SCENARIO, SOURCES, kinds_of, make
from evaluation.camera.score import lines_of, page


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.camera", description=__doc__)
    parser.add_argument("--cases", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--so-far", action="store_true", help="tables of what is done")
    given = parser.parse_args()
    folders = [given.out / f"case_{n + 1}" for n in range(given.cases)]
    for number, (folder, kind) in enumerate(zip(folders, kinds_of(given.cases))):
        if given.so_far:
            break
        if not (folder / "truth.json").is_file():
            make(folder, given.seed, number)
        for source in SOURCES:
            if not (folder / source / "diagnosis.json").is_file():
                _diagnose(folder / source, given.out / "simulations")
        print(f"{number + 1} of {given.cases}: {kind}", flush=True)
    text = page(lines_of(folders))
    (given.out / "page.md").write_text(text, encoding="utf-8")
    print(text)
    return 0


def _diagnose(folder: Path, kept: Path) -> None:
    with Batches(cache=Cache(kept)) as batches:
        base = load_scenario(SCENARIO)
        first, second = (load_recording(folder / name) for name in RECORDINGS)
        training, judges = prepared(base, [first], [second])
        found = diagnose(base, training, judges, Settings(), means=Means(threads=1, batches=batches, is_brief=True))
    write_json(found.diagnosis, folder / "diagnosis.json")
    print(
        f"{folder}: {found.diagnosis.verdict.value}, {batches.made} simulations, {found.diagnosis.seconds:.0f} s",
        flush=True,
    )


if __name__ == "__main__":
    sys.exit(main())
