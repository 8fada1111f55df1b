"""What the two diagnoses of each case have in common."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.camera.case import SOURCES


@dataclass(frozen=True)
class Answer:
    """A diagnosis, as far as it counts here.

    Args:
        verdict: What it says of the model.
        effects: Accepted effects, each with its class, the most probable first.
        values: Their strengths with 95 % intervals.
    """

    verdict: str
    effects: tuple[tuple[str, ...], ...]
    values: tuple[tuple[float, float, float], ...]

    def names(self, effect: str) -> bool:
        """Whether an effect is among its findings, or in the class of one."""
        return any(effect in members for members in self.effects)


def answer_of(file: Path) -> Answer:
    """Read a diagnosis.json."""
    told: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    accepted = [f for f in told["findings"] if f["is_accepted"]]
    return Answer(
        told["verdict"],
        tuple((f["effect"], *f["ambiguous_with"]) for f in accepted),
        tuple((p["value"], p["lower"], p["upper"]) for f in accepted for p in f["parameters"][:1]),
    )


def is_same(one: Answer, other: Answer) -> bool:
    """Whether both say the same of the model, and each finding of one is, or is of the class of, one of the other."""
    if one.verdict != other.verdict or len(one.effects) != len(other.effects):
        return False
    first = {members[0] for members in one.effects}
    second = {members[0] for members in other.effects}
    return first == second or (all(map(other.names, first)) and all(map(one.names, second)))


@dataclass(frozen=True)
class Line:
    """One case.

    Args:
        truth: See `evaluation.camera.case.Truth`.
        video: Answer from the video.
        markers: Answer from the true markers.
    """

    truth: dict[str, Any]
    video: Answer
    markers: Answer

    @property
    def is_same(self) -> bool:
        """See `is_same`."""
        return is_same(self.video, self.markers)

    def is_found(self, answer: Answer) -> bool:
        """Whether an answer has the concealed effect, first or in the class; of nothing, no effect."""
        kind = self.truth["kind"]
        return not answer.effects if kind == "nothing" else answer.names(kind)


def lines_of(folders: Sequence[Path]) -> list[Line]:
    """Cases that are done."""
    return [
        Line(
            json.loads((f / "truth.json").read_text(encoding="utf-8")),
            *(answer_of(f / s / "diagnosis.json") for s in SOURCES),
        )
        for f in folders
        if all((f / s / "diagnosis.json").is_file() for s in SOURCES)
    ]


def page(lines: Sequence[Line]) -> str:
    """A table of the cases, and what they have in common."""
    count = len(lines)
    same = sum(line.is_same for line in lines)
    strict = sum(
        _firsts(line.video) == _firsts(line.markers) and line.video.verdict == line.markers.verdict for line in lines
    )
    found = [sum(line.is_found(a) for line, a in ((n, getattr(n, s)) for n in lines)) for s in SOURCES]
    text = [
        f"{count} cases. Same verdict and findings from video as from true markers: {_share(same, count)} "
        f"(the most probable effects equal: {_share(strict, count)}).",
        f"The concealed effect, or none where there is none: {_share(found[0], count)} from video, "
        f"{_share(found[1], count)} from true markers.",
        f"Places of the video: {np.median([n.truth['place_error'] for n in lines]):.4f} mm rms in the median case, "
        f"{max(n.truth['place_error'] for n in lines):.4f} mm in the worst; gaps: at most "
        f"{100 * max(n.truth['gaps'] for n in lines):.1f} %.",
        "",
        "| concealed | strength | from video | from true markers | same |",
        "|---|---|---|---|---|",
    ]
    for n in lines:
        size = f"{n.truth['strength']:.3g} {n.truth['unit']}" if n.truth["kind"] != "nothing" else "-"
        text.append(
            f"| {n.truth['kind']} | {size} | {_said(n.video)} | {_said(n.markers)} | {'yes' if n.is_same else 'no'} |"
        )
    return "\n".join(text) + "\n"


def _firsts(answer: Answer) -> list[str]:
    return sorted(members[0] for members in answer.effects)


def _said(answer: Answer) -> str:
    said = [
        f"{members[0]} {value:.3g} ({low:.3g} to {high:.3g})" + (f" or {', '.join(members[1:])}" if members[1:] else "")
        for members, (value, low, high) in zip(answer.effects, answer.values)
    ]
    return f"{answer.verdict}: {'; '.join(said)}" if said else answer.verdict


def _share(part: int, whole: int) -> str:
    return f"{part} of {whole} ({100.0 * part / max(whole, 1):.0f} %)"
