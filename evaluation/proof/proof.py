"""The whole proof: cases, diagnoses, references, scores. Every finished case is on disk before the next begins."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

from diagnosis.report.json_file import read_json
from evaluation.proof.answer import read_answer
from evaluation.proof.ground import Draw, make_cases
from evaluation.proof.isolated import Attempt, Files, diagnose_apart, files_of
from evaluation.proof.place import read_duration, read_rig
from evaluation.proof.progress import Progress
from evaluation.proof.reference import Reference
from evaluation.proof.references import make_reference
from evaluation.proof.result import CaseResult
from evaluation.proof.scoring import score
from evaluation.proof.workers import Given, Lost, Workers


@dataclass(frozen=True)
class Folder:
    """Files of a proof.

    Args:
        path: `ground/` has cases and answers, `attempts/` and `diagnoses/` what was said, `references/` what the data
            allow.
    """

    path: Path

    def case(self, name: str) -> Path:
        """Folder of a case."""
        return self.path / "ground" / "cases" / name

    def answer(self, name: str, suffix: str = ".json") -> Path:
        """Answer of a case."""
        return self.path / "ground" / "answers" / f"{name}{suffix}"

    def attempt(self, name: str) -> Path:
        """What came of its diagnosis."""
        return self.path / "attempts" / f"{name}.json"

    def diagnosis(self, name: str) -> Path:
        """Its diagnosis.json, if one was made."""
        return self.path / "diagnoses" / f"{name}.json"

    def reference(self, name: str) -> Path:
        """What its data allow."""
        return self.path / "references" / f"{name}.json"


@dataclass(frozen=True)
class Effort:
    """What a proof may spend.

    Args:
        limit: Longest time of one diagnosis [s].
        has_baselines: Whether other methods are tried too.
        is_so_far: Make no new diagnoses, score those that are there.
    """

    limit: float = 1200.0
    has_baselines: bool = True
    is_so_far: bool = False


def prove(folder: Folder, draw: Draw, crew: Workers, effort: Effort) -> list[CaseResult]:
    """Make, diagnose and score cases; what an earlier call in the same folder finished is kept.

    Answers are read when all diagnoses are written, not before.

    Args:
        folder: Where everything is written.
        draw: Which cases.
        crew: Who works.
        effort: See there.

    Raises:
        InputError: The folder holds the proof of other cases.
    """
    cases = make_cases(folder.path / "ground", draw)
    if effort.is_so_far:  # cases are dealt in a drawn order: the first of them are a fair sample
        cases = [c for c in cases if folder.attempt(c).is_file()]
    else:
        _diagnose(folder, cases, crew, effort.limit)
    _refer(folder, cases, crew, effort.has_baselines)
    return [result(folder, case) for case in cases]


def _diagnose(folder: Folder, cases: Sequence[str], crew: Workers, limit: float) -> None:
    left = [c for c in cases if not folder.attempt(c).is_file()]
    progress = Progress("diagnosed", len(cases), len(cases) - len(left))

    def given(case: str) -> tuple[Any, ...]:
        return case, files_of(folder.case(case)), limit

    for case, attempt in crew.results(diagnose_apart, _later(left, given)):
        if isinstance(attempt, Lost):
            attempt = Attempt(case, "failed", attempt.message, 0.0)
        if attempt.diagnosis is not None:
            _write(folder.diagnosis(case), attempt.diagnosis)
        told = {k: v for k, v in attempt.as_json().items() if k != "diagnosis"}
        _write(folder.attempt(case), json.dumps(told, indent=1))
        progress.finished(case, "" if attempt.outcome == "diagnosed" else f"{attempt.outcome}: {attempt.message}")


def _refer(folder: Folder, cases: Sequence[str], crew: Workers, has_baselines: bool) -> None:
    left = [c for c in cases if not _has_reference(folder, c, has_baselines)]
    progress = Progress("compared", len(cases), len(cases) - len(left))

    def given(case: str) -> tuple[Any, ...]:
        return case, files_of(folder.case(case)), answer_files(folder, case), has_baselines

    for case, reference in crew.results(make_reference, _later(left, given)):
        if isinstance(reference, Lost):
            reference = Reference(case, failure=reference.message)
        _write(folder.reference(case), json.dumps(asdict(reference), indent=1))
        progress.finished(case, reference.failure)


def answer_files(folder: Folder, case: str) -> Files:
    """Everything that the proving ground says about a case: answer, clean readings, and recordings of a twin."""
    files = {p.name: p.read_bytes() for p in (folder.answer(case), folder.answer(case, ".npz"))}
    twin = folder.answer(case, "_twin")
    return files | {f"{twin.name}/{name}": content for name, content in files_of(twin).items()}


def _later(cases: Sequence[str], given: Callable[[str], tuple[Any, ...]]) -> dict[str, Given]:
    return {case: partial(given, case) for case in cases}


def _has_reference(folder: Folder, case: str, has_baselines: bool) -> bool:
    if not folder.reference(case).is_file():
        return False
    kept = read_reference(folder.reference(case))
    return bool(kept.baselines or kept.failure or not has_baselines)


def read_reference(path: Path) -> Reference:
    """Reference of a file."""
    return Reference(**json.loads(path.read_text()))


def result(folder: Folder, case: str) -> CaseResult:
    """Score of a case that was diagnosed and compared, from its files."""
    answer = read_answer(folder.answer(case))
    attempt = Attempt(**json.loads(folder.attempt(case).read_text()))
    reference = read_reference(folder.reference(case))
    diagnosis = read_json(folder.diagnosis(case)) if folder.diagnosis(case).is_file() else None
    scored = score(diagnosis, answer, read_rig(folder.case(case)), reference, read_duration(folder.case(case)))
    return CaseResult(
        case=case,
        kind=answer.kind,
        setup=answer.setup,
        engine=answer.engine,
        outcome=attempt.outcome,
        message=attempt.message,
        seconds=attempt.seconds,
        score=scored,
        reference=reference,
    )


def _write(path: Path, text: str) -> None:
    """Write a file whole or not at all: Ctrl-C may come at any time."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    part.write_text(text + "\n", encoding="utf-8")
    part.replace(path)
