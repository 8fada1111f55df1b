"""Answers beside the truth."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from datetime import date
from pathlib import Path
from subprocess import run
from typing import Any

#: Units of findings that are no physics.
MEASURED = ("measurement", "input")


def score(folder: Path) -> dict[str, Any]:
    """One case: what is right of its answer."""
    truth = json.loads((folder / "answer.json").read_text(encoding="utf-8"))
    found: dict[str, Any] = {"case": folder.name, "kind": truth["kind"], "rig": truth["rig"], "failed": True}
    file = folder / "diagnosis" / "diagnosis.json"
    if (folder / "done").read_text(encoding="utf-8") != "0" or not file.is_file():
        return found
    answer = json.loads(file.read_text(encoding="utf-8"))
    accepted = [f for f in answer["findings"] if f["is_accepted"]]
    physics = [f for f in accepted if f["unit"] not in MEASURED]
    named = [f for f in physics if f["standing"] == "named"]
    chi = (answer["adequacy"] or {}).get("chi_square", {})
    found |= {
        "failed": False,
        "verdict": answer["verdict"],
        "statement": answer["statement"],
        "seconds": answer["seconds"],
        "physics": bool(physics),
        "named": [f"{f['effect']} at {f['place']}" for f in named],
        "gain": _gain(chi),
        "truth": list(zip(truth["places"], truth["answers"])),
    }
    hits = [_hit(place, names, accepted) for place, names in zip(truth["places"], truth["answers"])]
    found |= {"element": [h[0] for h in hits], "name": [h[1] for h in hits], "class": [h[2] for h in hits]}
    own = {name for names in truth["answers"] for name in names}
    found["misnamed"] = any(_base(f["effect"]) not in own for f in named) if truth["kind"] != "hidden" else bool(named)
    return found


def _base(effect: str) -> str:
    return str(effect).split("_of_")[0]


def _gain(chi: Mapping[str, float]) -> float | None:
    """Share of the mismatch that can be explained and is, on held-out readings."""
    if not chi or chi["recalibrated"] <= 1.3:
        return None
    return 1.0 - max(chi["after"] - 1.0, 0.0) / (chi["recalibrated"] - 1.0)


def _hit(place: str, names: Sequence[str], accepted: Sequence[Mapping[str, Any]]) -> tuple[bool, bool, bool]:
    """Whether the place is right, the name first, the name within the class."""
    component = place.partition(".")[0]
    element = name = within = False
    for one in accepted:
        is_there = one["place"] == place or (one["place"].startswith(f"{component}.") and "input_offset" in names)
        element = element or is_there
        if is_there:
            name = name or (one["standing"] == "named" and _base(one["effect"]) in names)
            members = {_base(e) for e in (one["effect"], *one["ambiguous_with"])}
            within = within or bool(members & set(names))
    return element, name, within


def page(folders: Sequence[Path], seed: int, cases: int) -> str:
    """The tables."""
    scores = [score(f) for f in folders]
    commit = run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False).stdout.strip()
    done = [s for s in scores if not s["failed"]]
    one = [s for s in done if s["kind"] == "single"]
    visible = [s for s in one if s["gain"] is not None]
    both = [s for s in done if s["kind"] == "two"]
    faulty = [s for s in done if s["kind"] == "fault"]
    outside = [s for s in done if s["kind"] in ("hidden", "composed")]
    gains = [s["gain"] >= 0.8 for s in outside if s["gain"] is not None]
    rows = [
        ("diagnoses that ended", "all", [not s["failed"] for s in scores]),
        ("element right", "90 %", [s["element"][0] for s in visible]),
        ("named first", "85 %", [s["name"][0] for s in visible]),
        ("within the class", "95 %", [s["class"][0] for s in visible]),
        ("both of two within their classes", "70 %", [all(s["class"]) for s in both]),
        ("false alarms on nulls", "at most 5 %", [s["physics"] for s in done if s["kind"] == "null"]),
        (
            "physics named where a sensor was at fault",
            "at most 2 %",
            [bool(s["named"]) for s in faulty],
        ),
        ("wrong name on hidden and composed laws", "at most 10 %", [s["misnamed"] for s in outside]),
        ("hidden and composed: 80 % of the possible gain", "80 %", gains),
        (
            "a wrong name, any kind",
            "at most 5 %",
            [s["misnamed"] or (s["kind"] == "null" and s["physics"]) for s in done],
        ),
    ]
    lines = [
        "# What the diagnosis reaches on systems of FMUs",
        "",
        f"`python -m evaluation.systems --cases {cases} --seed {seed}`, {date.today()}, at {commit}.",
        f"{len(scores)} cases are scored.",
        "Rigs, truths, scoring: [laws.md](laws.md#proof). Single effects count where recalibration alone leaves",
        "chi-square per held-out reading above 1.3: what lies below is taken up by the numbers of the model.",
        "",
        "| measure | aim | reached |",
        "|---|---|---|",
    ]
    for name, aim, hits in rows:
        share = f"{100 * sum(hits) / len(hits):.0f} % ({sum(hits)} of {len(hits)})" if hits else "no case"
        lines.append(f"| {name} | {aim} | {share} |")
    lines += ["", "| case | rig | kind | truth | verdict | named | gain |", "|---|---|---|---|---|---|---|"]
    for s in scores:
        if s["failed"]:
            lines.append(f"| {s['case']} | {s['rig']} | {s['kind']} | | failed | | |")
            continue
        truth = "; ".join(f"{names[0] if names else 'composed'} at {place}" for place, names in s["truth"])
        gain = "" if s["gain"] is None else f"{100 * s['gain']:.0f} %"
        lines.append(
            f"| {s['case']} | {s['rig']} | {s['kind']} | {truth} | {s['verdict']} | {'; '.join(s['named'])} | {gain} |"
        )
    return "\n".join(lines) + "\n"
