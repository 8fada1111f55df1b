"""Answers about small fabrics beside the truth: false claims first."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from datetime import date
from pathlib import Path
from typing import Any

#: Units of findings that are no physics.
MEASURED = ("measurement", "input")
#: Verdicts by which nothing is missing.
AGREES = ("consistent", "recalibrated")
#: Effects of single links and rows, whose place counts.
LOCAL = frozenset({"weak_steel", "weak_coil", "unheated_coil", "jammed_link"})


def score(folder: Path, name: str) -> dict[str, Any]:
    """One case: what was said, and what of it is false.

    A claim is an accepted finding of physics with a name. It is false where nothing of that name acts, unless it says
    itself that it cannot tell its effect from the true one. Of nothing, any accepted finding is false.

    Args:
        folder: Of the draw.
        name: Of the case.
    """
    truth = json.loads((folder / "answers" / f"{name}.json").read_text(encoding="utf-8"))
    out = folder / "diagnoses" / name
    done = json.loads((out / "done.json").read_text(encoding="utf-8"))
    found = {**truth, "seconds": done["seconds"], "failed": True}
    file = out / "answer" / "diagnosis.json"
    if done["code"] or not file.is_file():
        return found
    answer = json.loads(file.read_text(encoding="utf-8"))
    said = [f for f in answer["findings"] if f["is_accepted"]]
    physics = [f for f in said if f["unit"] not in MEASURED]
    named = [f for f in said if f["standing"] == "named"]
    if truth["kind"] == "null":
        false = said
    else:
        false = [f for f in named if truth["effect"] not in _meant(f) or not _is_there(f, truth)]
        if truth["kind"] == "camera":  # a camera moves nothing
            false += [f for f in physics if f not in false]
    chi = (answer["adequacy"] or {}).get("chi_square", {})
    return found | {
        "failed": False,
        "verdict": answer["verdict"],
        "said": [_said(f) for f in said],
        "false": [f["effect"] for f in false],
        "is_named": any(f["effect"] == truth["effect"] and _is_there(f, truth) for f in named),
        "is_in_class": any(truth["effect"] in _meant(f) for f in said),
        "is_told": answer["verdict"] == "recording fault" and truth["kind"] == "camera",
        "chi": [chi.get(k) for k in ("before", "recalibrated", "after")],
    }


def _is_there(finding: Mapping[str, Any], truth: Mapping[str, Any]) -> bool:
    """Whether a finding of one link or one row is where the effect acts; of any other, True."""
    if truth["kind"] != "local" or finding["effect"] not in LOCAL:
        return True
    if truth.get("row"):
        return f"row {truth['row']}" in finding["place"]
    return f"link {truth['link']} " in f"{finding['place']} "


def _meant(finding: Mapping[str, Any]) -> set[str]:
    return {finding["effect"], *finding["ambiguous_with"]}


def _said(finding: Mapping[str, Any]) -> str:
    strength = ", ".join(f"{p['value']:.3g} {p['unit']}" for p in finding["parameters"])
    others = f", or {', '.join(finding['ambiguous_with'])}" if finding["ambiguous_with"] else ""
    return f"{finding['effect']} at {finding['place']} {strength} ({finding['standing']}{others})"


def page(scores: Sequence[Mapping[str, Any]], seed: int, cases: int) -> str:
    """Markdown: false claims, then every case."""
    whole = [s for s in scores if not s["failed"]]
    nulls = [s for s in whole if s["kind"] == "null"]
    known, local, camera = ([s for s in whole if s["kind"] == kind] for kind in ("global", "local", "camera"))
    lines = [
        f"{date.today().isoformat()}, seed {seed}: {len(scores)} of {cases} cases, {len(scores) - len(whole)} of them "
        "without an answer.",
        "",
        "| | |",
        "|---|---|",
        f"| false claims | {sum(bool(s['false']) for s in whole)} of {len(whole)} |",
        f"| of them where nothing acts | {sum(bool(s['false']) for s in nulls)} of {len(nulls)} |",
        f"| effects of all links named | {sum(s['is_named'] for s in known)} of {len(known)} |",
        f"| the same, within the class named | {sum(s['is_in_class'] for s in known)} of {len(known)} |",
        f"| effects of one link or row named at their place | {sum(s['is_named'] for s in local)} of {len(local)} |",
        f"| cameras and markers named, or told as a fault | {sum(s['is_named'] or s['is_told'] for s in camera)} of "
        f"{len(camera)} |",
        f"| nothing acts and nothing is missing by the answer | {sum(s['verdict'] in AGREES for s in nulls)} of "
        f"{len(nulls)} |",
        "",
        "| case | truth | verdict | said | false | moves markers by [mm] "
        "| held-out chi-square: before, recalibrated, after | wall time [s] |",
        "|---" * 8 + "|",
    ]
    for s in scores:
        where = f", link {s['link']}" if s.get("link") else f", row {s['row']}" if s.get("row") else ""
        truth = f"{s['effect']} {s['strength']:.3g}{where}" if s["effect"] else "nothing"
        moves = "-" if s.get("moves_mm") is None else f"{s['moves_mm']:.2f}"
        if s["failed"]:
            lines.append(f"| {s['case']} | {truth} | no answer | | | {moves} | | {s['seconds']:.0f} |")
            continue
        chi = ", ".join("-" if c is None else f"{c:.2f}" for c in s["chi"])
        said, false = "; ".join(s["said"]) or "-", ", ".join(s["false"]) or "-"
        lines.append(
            f"| {s['case']} | {truth} | {s['verdict']} | {said} | {false} | {moves} | {chi} | {s['seconds']:.0f} |"
        )
    return "\n".join(lines) + "\n"
