"""What the two answers of each case have in common."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.camera.case import RECORDINGS, SOURCES, errors

#: Files of an answer: of the search alone, and of a whole diagnosis.
SEARCH, DIAGNOSIS = "search.json", "diagnosis.json"


@dataclass(frozen=True)
class Answer:
    """What was found, as far as it counts here.

    Args:
        verdict: What a diagnosis says of the model; of a search nothing.
        effects: Effects that were found (of a diagnosis: accepted), each with its class, the most probable first.
        values: Their strengths.
        suggested: Effects that a diagnosis suggests and does not accept.
    """

    verdict: str
    effects: tuple[tuple[str, ...], ...]
    values: tuple[float, ...]
    suggested: tuple[str, ...] = ()

    def names(self, effect: str) -> bool:
        """Whether an effect is among its findings, or in the class of one."""
        return any(effect in members for members in self.effects)

    def text(self) -> str:
        """For a table."""
        said = [
            f"{members[0]} {value:.3g}" + (f" or {', '.join(members[1:])}" if members[1:] else "")
            for members, value in zip(self.effects, self.values)
        ]
        maybe = [f"({', '.join(self.suggested)})"] if self.suggested else []
        return "; ".join(([self.verdict] if self.verdict else []) + said + maybe) or "none"


def answer_of(file: Path) -> Answer:
    """Read an answer."""
    told: Any = json.loads(file.read_text(encoding="utf-8"))
    if isinstance(told, list):
        return Answer("", tuple((f["effect"],) for f in told), tuple(f["value"] for f in told))
    accepted = [f for f in told["findings"] if f["is_accepted"]]
    return Answer(
        told["verdict"],
        tuple((f["effect"], *f["ambiguous_with"]) for f in accepted),
        tuple(f["parameters"][0]["value"] for f in accepted),
        tuple(f["effect"] for f in told["findings"] if not f["is_accepted"]),
    )


def is_same(one: Answer, other: Answer) -> bool:
    """Whether both say the same of the model, and each finding of one is, or is of the class of, one of the other."""
    if one.verdict != other.verdict or len(one.effects) != len(other.effects):
        return False
    first = {members[0] for members in one.effects}
    second = {members[0] for members in other.effects}
    return first == second or (all(map(other.names, first)) and all(map(one.names, second)))


def is_right(answer: Answer, kind: str) -> bool:
    """Whether an answer has the concealed effect, first or in the class; of nothing, no effect."""
    return not answer.effects if kind == "nothing" else answer.names(kind)


def is_first(answer: Answer, kind: str) -> bool:
    """Whether the strongest effect is the concealed one; of nothing, none."""
    return not answer.effects if kind == "nothing" else bool(answer.effects) and kind in answer.effects[0]


@dataclass(frozen=True)
class Line:
    """One case.

    Args:
        truth: See `evaluation.camera.case.Truth`.
        video: Answer from the video.
        markers: Answer from the true markers.
        error: Root mean square error of the places of the video [mm].
        gaps: Share of gaps in it.
    """

    truth: dict[str, Any]
    video: Answer
    markers: Answer
    error: float
    gaps: float


def lines_of(folders: Sequence[Path], file: str) -> list[Line]:
    """Cases that are done."""
    found = []
    for folder in folders:
        if all((folder / source / file).is_file() for source in SOURCES):
            truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
            video, markers = (answer_of(folder / source / file) for source in SOURCES)
            found.append(Line(truth, video, markers, *errors(folder, RECORDINGS[0])))
    return found


def page(folders: Sequence[Path], file: str) -> str:
    """A table of the cases, and what they have in common."""
    lines = lines_of(folders, file)
    if not lines:
        return f"{file}: no case\n"
    both = [(line.video, line.markers, line.truth["kind"]) for line in lines]
    rows = {
        "the same from video as from true markers": [is_same(v, m) for v, m, _ in both],
        "the same strongest effect, or none in both": [_first(v) == _first(m) for v, m, _ in both],
        "the concealed effect among those found, from video": [is_right(v, k) for v, _, k in both],
        "the same from true markers": [is_right(m, k) for _, m, k in both],
        "the concealed effect first, from video": [is_first(v, k) for v, _, k in both],
        "the same first, from true markers": [is_first(m, k) for _, m, k in both],
    }
    text = [f"{file}: {len(lines)} cases", "", "| | share |", "|---|---|"]
    text += [f"| {name} | {sum(hits)} of {len(hits)} ({100 * np.mean(hits):.0f} %) |" for name, hits in rows.items()]
    off, gaps = [line.error for line in lines], [line.gaps for line in lines]
    text += [
        f"| places of the video, rms | {np.median(off):.3f} mm (median), {max(off):.3f} mm (most) |",
        f"| gaps | {100 * np.mean(gaps):.2f} % |",
        "",
        "| concealed | strength | from video | from true markers | same |",
        "|---|---|---|---|---|",
    ]
    for line in lines:
        kind, same = line.truth["kind"], "yes" if is_same(line.video, line.markers) else "no"
        size = "-" if kind == "nothing" else f"{line.truth['strength']:.3g} {line.truth['unit']}"
        text.append(f"| {kind} | {size} | {line.video.text()} | {line.markers.text()} | {same} |")
    return "\n".join(text) + "\n"


def _first(answer: Answer) -> str:
    return answer.effects[0][0] if answer.effects else ""
