"""`python -m evaluation.systems.others --out DIR`: what a user would pick instead, on the recordings of a draw.

Every method is given what `cosim diagnose` was given: the equations of the FMU (here as NumPy code, which agrees with
the FMU to 1e-5), inputs and readings of the two recordings that are fitted. What they learn runs freely, with the
equations, over the recording that was held out. Readings are smoothed by each of two kernels; the better is taken by
the free run of the second recording.

- `sparse`: sequentially thresholded least squares of pysindy over polynomials of degree 3, signs and signed squares of
  states and inputs; its threshold is the one with the best free run of the second recording.
- `Gaussian process`: scikit-learn, squared exponential with a length for each variable, and white noise.
- `network`: two layers of 16, tanh, fitted by L-BFGS to the derivatives (scikit-learn).
- `network in the loop`: a layer of 16, tanh, fitted by Adam to the readings through the simulation (jax, where it is
  installed).
- `symbolic`: genetic programming (gplearn, where installed).
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import sys
import time as clock
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.systems.case import RECORDINGS
from evaluation.systems.others.data import WINDOWS, Data, Learnt, free_run, read
from evaluation.systems.others.methods import gaussian_process, neural, sparse, symbolic
from evaluation.systems.others.neural_ode import neural_ode
from evaluation.systems.rigs import RIGS, Rig

#: Name to method and the package that it needs.
METHODS: Mapping[str, tuple[Callable[[Rig, Sequence[Data]], tuple[Learnt, int]], str]] = {
    "sparse": (sparse, "pysindy"),
    "Gaussian process": (gaussian_process, "sklearn"),
    "network": (neural, "sklearn"),
    "network in the loop": (neural_ode, "jax"),
    "symbolic": (symbolic, "gplearn"),
}
#: Rigs of which the equations are no text that jax can trace.
NO_TEXT = ("a pendulum that a slide balances upside down",)


def case(folder: Path) -> dict[str, Any] | None:
    """Every method on one case; None where the FMU hides its states, which none of them can do without."""
    answer = json.loads((folder / "answer.json").read_text(encoding="utf-8"))
    rig = next(r for r in RIGS if r.name == answer["rig"])
    if rig.hidden:
        return None
    read_by = [[read(rig, folder / "task" / name, window) for name in RECORDINGS] for window in WINDOWS]
    held_out = read_by[0][-1]
    found: dict[str, Any] = {"case": folder.name, "kind": answer["kind"], "rig": rig.name}
    found["as it is"] = {"chi": free_run(rig, None, held_out), "terms": 0, "seconds": 0.0}
    ours = json.loads((folder / "diagnosis" / "diagnosis.json").read_text(encoding="utf-8"))
    chi = (ours["adequacy"] or {}).get("chi_square", {})
    accepted = sum(f["is_accepted"] for f in ours["findings"])
    found["cosim diagnose"] = {"chi": chi.get("after"), "terms": accepted, "seconds": ours["seconds"]}
    for name, (method, package) in METHODS.items():
        if importlib.util.find_spec(package) is None or (package == "jax" and rig.name in NO_TEXT):
            continue
        begin = clock.process_time()
        tried = [method(rig, one[:-1]) for one in (read_by[:1] if package == "jax" else read_by)]
        errors = [free_run(rig, learnt, read_by[0][-2]) for learnt, _ in tried]
        learnt, terms = tried[int(np.argmin(errors))]
        seconds = clock.process_time() - begin
        found[name] = {"chi": free_run(rig, learnt, held_out), "terms": terms, "seconds": seconds}
    return found


def page(found: Sequence[Mapping[str, Any]]) -> str:
    """The table."""
    names = ["as it is", "cosim diagnose", *METHODS]
    lines = ["| case | rig | kind | " + " | ".join(names) + " |", "|" + "---|" * (len(names) + 3)]
    for one in found:
        cells = [_cell(one.get(name)) for name in names]
        lines.append(f"| {one['case']} | {one['rig']} | {one['kind']} | {' | '.join(cells)} |")
    nulls = [one for one in found if one["kind"] == "null"]
    for title, rows in (("median of nulls", nulls), ("median of others", [o for o in found if o not in nulls])):
        cells = []
        for name in names:
            own = [r[name] for r in rows if r.get(name) and r[name]["chi"] is not None]
            medians = (
                {key: float(np.median([o[key] for o in own])) for key in ("chi", "terms", "seconds")} if own else None
            )
            cells.append(_cell(medians))
        lines.append(f"| {title} | | | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _cell(one: Mapping[str, Any] | None) -> str:
    if not one or one["chi"] is None:
        return ""
    chi = "ran away" if not np.isfinite(one["chi"]) else f"{one['chi']:.3g}"
    return f"{chi}; {one['terms']:.0f}; {one['seconds']:.0f} s"


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.systems.others", description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of a draw")
    given = parser.parse_args()
    found = []
    for folder in sorted(given.out.glob("case_*"), key=lambda f: int(f.name.rpartition("_")[2])):
        kept = folder / "others.json"
        if not kept.is_file() and (folder / "done").is_file() and (folder / "done").read_text() == "0":
            one = case(folder)
            kept.write_text(json.dumps(one), encoding="utf-8")
            print(folder.name, flush=True)
        if kept.is_file() and (one := json.loads(kept.read_text(encoding="utf-8"))) is not None:
            found.append(one)
    text = page(found)
    (given.out / "others.md").write_text(text, encoding="utf-8")
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
