"""`python -m evaluation.sensitivity.answers CASE [CASE ...]`: one line of JSON for each case, what was found in it.

A case is a folder with `task/` (scenario and recordings) and `answer.json` (which recordings are held out), as
`evaluation.strangers` writes it. It is diagnosed by whatever package `diagnosis` stands first in the path.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.diagnose import Options, diagnose
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings


def answer(folder: Path) -> dict[str, Any]:
    """What the diagnosis says of a case: verdict and accepted findings with their standing, or its error."""
    asked = json.loads((folder / "answer.json").read_text(encoding="utf-8"))
    task = folder / "task"
    try:
        scenario = load_scenario(task / "scenario.yaml")
        training, held_out = ([load_recording(task / n) for n in asked[k]] for k in ("training", "held_out"))
        found = diagnose(scenario, training, held_out, Settings(), options=Options(is_brief=True)).diagnosis
    except InputError as error:
        return {"verdict": f"refused: {error}", "accepted": []}
    except Exception as error:  # a changed number may break anything, and that is an answer too
        return {"verdict": f"error: {type(error).__name__}: {error}", "accepted": []}
    accepted = sorted(f"{f.effect} at {f.place} ({f.standing.value})" for f in found.accepted)
    return {"verdict": found.verdict.value, "accepted": accepted}


if __name__ == "__main__":
    for case in sys.argv[1:]:
        print(json.dumps({"case": Path(case).name, **answer(Path(case))}), flush=True)
