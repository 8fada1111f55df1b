"""`python -m evaluation.camera --cases N --whole M --seed S --out DIR`: film, track, diagnose, compare.

Each case is a small fabric with one concealed effect or none, filmed, and recorded from the video and from the true
places of its markers. The search runs on both recordings, on simulations that all cases share: an ensemble of starts,
and every effect at its start values from several of them. The first M cases go through the whole of
`cosim diagnose --brief` besides, with simulations where effects were fitted and a second recording that judges. What is
done in the folder is kept, and the same command goes on.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from cosim.compute.batch import Batches
from cosim.compute.cache import Cache
from cosim.scenario import load_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.diagnose import Options, diagnose
from diagnosis.models.fabric.model import FabricModel
from diagnosis.models.fabric.search import Effort, search_fabric
from diagnosis.recording.recording import load_recording
from diagnosis.recording.together import prepared
from diagnosis.report.json_file import write_json
from diagnosis.search.search import Settings
from evaluation.camera.case import RECORDINGS, SCENARIO, SOURCES, kinds_of, make
from evaluation.camera.score import DIAGNOSIS, SEARCH, page

#: A search on shared simulations, without any where effects were fitted. They are made once for all cases, so that
#: several starts of every effect cost little; from one start each, the starts' scatter would choose among effects.
SHARED = Effort(12, 4, 4, hopeful=0)


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.camera", description=__doc__)
    parser.add_argument("--cases", type=int, default=33)
    parser.add_argument("--whole", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--so-far", action="store_true", help="tables of what is done")
    given = parser.parse_args()
    folders = [given.out / f"case_{n + 1}" for n in range(max(given.cases, given.whole))]
    kept = Cache(given.out / "simulations")
    if not given.so_far:
        _all(folders, given.seed, given.cases, given.whole, kept)
    text = "\n".join(page(folders, file) for file in (SEARCH, DIAGNOSIS))
    (given.out / "page.md").write_text(text, encoding="utf-8")
    print(text)
    return 0


def _all(folders: list[Path], seed: int, searched: int, whole: int, kept: Cache) -> None:
    for is_whole, count in ((False, searched), (True, whole)):
        for number, (folder, kind) in enumerate(zip(folders[:count], kinds_of(count))):
            make(folder, seed, number, RECORDINGS if is_whole else RECORDINGS[:1])
            for source in SOURCES:
                if not (folder / source / (DIAGNOSIS if is_whole else SEARCH)).is_file():
                    (_diagnose if is_whole else _search)(folder / source, kept)
            print(f"{number + 1} of {count}: {kind}", flush=True)


def _search(folder: Path, kept: Cache) -> None:
    with Batches(cache=kept) as batches:
        model = FabricModel(load_scenario(SCENARIO), [load_recording(folder / RECORDINGS[0])], catalogue(), batches)
        best = search_fabric(model, Settings(), effort=SHARED).best
    terms = sorted(best.terms, key=lambda t: -best.gains.get(t, 0.0))
    found = [
        {
            "effect": t.identifier,
            "value": best.fit.point.terms[t][0],
            "gain": best.gains.get(t, 0.0),
        }
        for t in terms
    ]
    (folder / SEARCH).write_text(json.dumps(found, indent=1), encoding="utf-8")


def _diagnose(folder: Path, kept: Cache) -> None:
    with Batches(cache=kept) as batches:
        base = load_scenario(SCENARIO)
        first, second = (load_recording(folder / name) for name in RECORDINGS)
        training, judges = prepared(base, [first], [second])
        options = Options(threads=1, batches=batches, is_brief=True)
        found = diagnose(base, training, judges, Settings(), options=options)
    write_json(found.diagnosis, folder / DIAGNOSIS)


if __name__ == "__main__":
    sys.exit(main())
