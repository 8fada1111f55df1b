"""Cases as files, diagnoses in processes of their own, and a proof that goes on where it stopped."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml

from cosim.unit.errors import InputError
from evaluation.proof.answer import read_answer
from evaluation.proof.ground import Draw, make_cases, read_task
from evaluation.proof.isolated import diagnose_apart, files_of, write_files
from evaluation.proof.proof import Effort, Folder, prove
from evaluation.proof.workers import Given, Workers

DRAW = Draw(2, 3, ("leave_one_out",), ("bath",))


@pytest.fixture(scope="module")
def ground(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("ground")
    make_cases(folder, DRAW)
    return folder


def test_cases_are_made_once(ground: Path) -> None:
    before = {p: p.stat().st_mtime_ns for p in ground.rglob("*") if p.is_file()}
    assert make_cases(ground, DRAW) == ["case_0001", "case_0002"]
    assert {p: p.stat().st_mtime_ns for p in ground.rglob("*") if p.is_file()} == before


def test_a_folder_keeps_to_its_cases(ground: Path) -> None:
    with pytest.raises(InputError, match="other cases"):
        make_cases(ground, Draw(2, 4, ("leave_one_out",), ("bath",)))


@pytest.mark.parametrize(
    ("draw", "message"),
    [(Draw(1, 1, ("nulls",)), "no kind of case"), (Draw(1, 1, (), ("bridge",)), "no rig `bridge`")],
)
def test_a_draw_that_the_ground_cannot_make_is_refused_in_words(tmp_path: Path, draw: Draw, message: str) -> None:
    with pytest.raises(InputError, match=message):
        make_cases(tmp_path / "ground", draw)
    assert not (tmp_path / "ground" / "draw.yaml").exists()


def test_the_diagnosis_is_given_nothing_of_the_answer(ground: Path) -> None:
    answer = read_answer(ground / "answers" / "case_0001.json")
    (effect,) = answer.effects
    files = files_of(ground / "cases" / "case_0001")
    assert set(yaml.safe_load(files["task.yaml"])) == {"scenario", "training", "held_out", "hidden"}
    values = [f"{v:.4g}".encode() for v in effect.parameters.values()]
    assert not [n for n, content in files.items() if n.endswith(".yaml") and any(v in content for v in values)]
    assert read_task(ground / "cases" / "case_0001").hidden == (effect.effect,)


def test_files_travel_unchanged(ground: Path, tmp_path: Path) -> None:
    files = files_of(ground / "cases" / "case_0001")
    write_files(files, tmp_path / "there")
    assert files_of(tmp_path / "there") == files


def test_a_scenario_that_cannot_be_read_is_refused_by_the_process_in_words(ground: Path) -> None:
    files = {**files_of(ground / "cases" / "case_0001"), "scenario.yaml": b"components: 3\n"}
    attempt = diagnose_apart("case_0001", files, 60.0)
    assert attempt.outcome == "refused"
    assert attempt.message.startswith("error: scenario.yaml")
    assert attempt.diagnosis is None


def test_a_diagnosis_that_takes_too_long_is_ended(ground: Path) -> None:
    attempt = diagnose_apart("case_0001", files_of(ground / "cases" / "case_0001"), 0.2)
    assert (attempt.outcome, attempt.message) == ("timed out", "no answer within 0.2 s")


class _Interrupted(Workers):
    """One worker, and Ctrl-C after some cases."""

    def __init__(self, stop_after: int) -> None:
        super().__init__(None, 1)
        self.left = stop_after

    def results(self, work: Callable[..., Any], tasks: Mapping[str, Given]) -> Iterator[tuple[str, Any]]:
        for found in super().results(work, tasks):
            if not self.left:
                raise KeyboardInterrupt
            self.left -= 1
            yield found


#: Every diagnosis is ended before it can answer: these tests are about what happens then.
EFFORT = Effort(limit=0.05, has_baselines=False)


def _times(folder: Folder) -> dict[str, int]:
    files = [p for n in ("attempts", "references") for p in (folder.path / n).glob("*.json")]
    return {f"{p.parent.name}/{p.name}": p.stat().st_mtime_ns for p in files}


@pytest.mark.parametrize(
    ("stop_after", "kept"),
    [
        (1, ["attempts/case_0001.json"]),
        (3, ["attempts/case_0001.json", "attempts/case_0002.json", "references/case_0001.json"]),
    ],
)
def test_what_is_done_is_kept_and_not_done_again(
    ground: Path, tmp_path: Path, stop_after: int, kept: list[str]
) -> None:
    shutil.copytree(ground, tmp_path / "ground")
    folder = Folder(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        prove(folder, DRAW, _Interrupted(stop_after), EFFORT)
    before = _times(folder)
    assert sorted(before) == kept
    results = prove(folder, DRAW, Workers(None, 1), EFFORT)
    assert {name: time for name, time in _times(folder).items() if name in before} == before
    assert not list(tmp_path.rglob("*.part"))
    assert [(r.case, r.outcome) for r in results] == [("case_0001", "timed out"), ("case_0002", "timed out")]
    # Wrong, not forgotten: the truth could have been found, and there was something to gain.
    assert not any(r.score.is_verdict_right or r.score.effects[0].is_unit_right for r in results)
    assert all(r.reference.training_gain > 0.0 for r in results)
