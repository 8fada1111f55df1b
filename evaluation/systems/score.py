"""Answers beside the truth."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from datetime import date
from pathlib import Path
from typing import Any

from evaluation.systems.rigs import RIGS

#: Kinds of cases whose law the library does not have where it acts.
OUTSIDE = ("hidden", "memory", "composed")
#: Rigs with FMUs that hide their states.
HIDING = frozenset(rig.name for rig in RIGS if rig.hidden)
#: Verdicts that say that a recording is wrong and not the model.
FAULTY = ("measurement fault", "recording fault")
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
        "fault": truth.get("fault", ""),
        "found": [f"{f['effect']} at {f['place']} ({f['standing']})" for f in accepted],
        "named": [f"{f['effect']} at {f['place']}" for f in named],
        "gain": _gain(chi),
        "truth": list(zip(truth["places"], truth["answers"])),
    }
    hits = [_hit(place, names, accepted) for place, names in zip(truth["places"], truth["answers"])]
    found |= {"element": [h[0] for h in hits], "name": [h[1] for h in hits], "class": [h[2] for h in hits]}
    own = {name for names in truth["answers"] for name in names}
    is_outside = truth["kind"] in OUTSIDE
    found["misnamed"] = bool(named) if is_outside else any(_base(f["effect"]) not in own for f in named)
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


def _rows(scores: Sequence[Mapping[str, Any]]) -> list[tuple[str, str, list[bool]]]:
    """Measure, aim, and whether each case that it is about meets it."""
    done = [s for s in scores if not s["failed"]]
    visible = [s for s in done if s["kind"] == "single" and s["gain"] is not None]
    both = [s for s in done if s["kind"] == "two"]
    faulty = [s for s in done if s["kind"] == "fault"]
    outside = [s for s in done if s["kind"] in OUTSIDE]
    return [
        ("diagnoses that ended", "all", [not s["failed"] for s in scores]),
        ("element right", "90 %", [s["element"][0] for s in visible]),
        ("named first", "85 %", [s["name"][0] for s in visible]),
        ("within the class", "95 %", [s["class"][0] for s in visible]),
        ("both of two within their classes", "70 %", [all(s["class"]) for s in both]),
        ("false alarms on nulls", "at most 5 %", [s["physics"] for s in done if s["kind"] == "null"]),
        (
            "nulls that are recognised",
            "no aim",
            [s["verdict"] in ("recalibrated", "consistent") for s in done if s["kind"] == "null"],
        ),
        (
            "a fault where there is none",
            "at most 2 %",
            [s["verdict"] in FAULTY for s in done if s["kind"] != "fault"],
        ),
        ("a fault of a sensor or an input is identified", "no aim", [_is_identified(s) for s in faulty]),
        ("physics named where there was a fault alone", "at most 2 %", [bool(s["named"]) for s in faulty]),
        ("wrong name on laws outside the library", "at most 5 %", [s["misnamed"] for s in outside]),
        (
            "laws outside the library: 80 % of the possible gain",
            "80 %",
            [s["gain"] >= 0.8 for s in outside if s["gain"] is not None],
        ),
        (
            "a wrong name, any kind",
            "at most 5 %",
            [s["misnamed"] or (s["kind"] == "null" and s["physics"]) for s in done],
        ),
    ]


def _is_identified(s: Mapping[str, Any]) -> bool:
    """Whether a fault is found; of single wild readings nothing has to be said."""
    if s["fault"] == "wild readings":
        return not s["physics"]
    return s["verdict"] in FAULTY or any("in_interval" in f for f in s["found"])


def _share(hits: Sequence[bool]) -> str:
    return f"{100 * sum(hits) / len(hits):.0f} % ({sum(hits)} of {len(hits)})" if hits else "no case"


def _short(s: Mapping[str, Any]) -> str:
    """What is wrong of an answer; empty: nothing."""
    if s["failed"]:
        return "it did not end"
    kind, visible = s["kind"], s["gain"] is not None
    wrong = []
    if kind == "null" and s["physics"]:
        wrong.append("false alarm")
    if s["misnamed"]:
        wrong.append("wrong name")
    if kind != "fault" and s["verdict"] in FAULTY:
        wrong.append("a fault where there is none")
    if kind == "single" and visible and not s["name"][0]:
        wrong.append("within the class" if s["class"][0] else "not within the class")
    if kind == "two" and not all(s["class"]):
        wrong.append("not both within their classes")
    if kind == "fault" and not _is_identified(s):
        wrong.append("fault not told")
    if kind in OUTSIDE and visible and s["gain"] < 0.8:
        wrong.append("less than 80 % of the possible gain")
    return ", ".join(wrong)


def _truth(s: Mapping[str, Any]) -> str:
    if s["fault"]:
        return str(s["fault"])
    return "; ".join(f"{names[0] if names else s['kind']} at {place}" for place, names in s["truth"])


def page(folders: Sequence[Path], seed: int, cases: int, commit: str) -> str:
    """The tables."""
    scores = [score(f) for f in folders]
    lines = [
        "# What the diagnosis reaches on systems of FMUs",
        "",
        f"`python -m evaluation.systems --cases {cases} --seed {seed}`, {date.today()}, library frozen at {commit}.",
        f"{len(scores)} cases are scored.",
        "Rigs, truths, scoring: [laws.md](laws.md#proof). Single effects count where recalibration alone leaves",
        "chi-square per held-out reading above 1.3: what lies below is taken up by the numbers of the model.",
        "",
        "| measure | aim | all | Model Exchange alone | with Co-Simulation |",
        "|---|---|---|---|---|",
    ]
    open_ones = [s for s in scores if s["rig"] not in HIDING]
    closed = [s for s in scores if s["rig"] in HIDING]
    for one, two, three in zip(_rows(scores), _rows(open_ones), _rows(closed)):
        lines.append(f"| {one[0]} | {one[1]} | {_share(one[2])} | {_share(two[2])} | {_share(three[2])} |")
    lines += ["", "Answers that fall short:", "", "| case | rig | truth | verdict | accepted | gain | |"]
    lines += ["|---|---|---|---|---|---|---|"]
    for s in scores:
        if what := _short(s):
            if s["failed"]:
                lines.append(f"| {s['case']} | {s['rig']} | {s['kind']} | | | | {what} |")
                continue
            accepted = "; ".join(s["found"]) or "nothing"
            gain = _percent(s["gain"])
            truth = _truth(s) or "nothing"
            lines.append(f"| {s['case']} | {s['rig']} | {truth} | {s['verdict']} | {accepted} | {gain} | {what} |")
    lines += ["", "All:", "", "| case | rig | kind | truth | verdict | named | gain |", "|---|---|---|---|---|---|---|"]
    for s in scores:
        if s["failed"]:
            lines.append(f"| {s['case']} | {s['rig']} | {s['kind']} | | did not end | | |")
            continue
        named, gain = "; ".join(s["named"]), _percent(s["gain"])
        lines.append(f"| {s['case']} | {s['rig']} | {s['kind']} | {_truth(s)} | {s['verdict']} | {named} | {gain} |")
    return "\n".join(lines) + "\n"


def _percent(gain: float | None) -> str:
    return "" if gain is None else f"{100 * gain:.0f} %"
