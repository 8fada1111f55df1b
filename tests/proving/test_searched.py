"""Which spoiled recordings are put to the search, and how its answers count."""

import json
from pathlib import Path

import pytest

from diagnosis.judge.diagnosis import Verdict
from evaluation.strangers.searched import ANSWERS, answer_of, drawn, kind_of, left_to_search, summary


def spoiled(draw: Path, name: str, answer: object) -> None:
    (draw / name).mkdir(parents=True)
    (draw / name / "spoiled.json").write_text(json.dumps(answer), encoding="utf-8")


def test_what_the_check_left_of_the_spoiled_ones_is_searched(tmp_path: Path) -> None:
    spoiled(tmp_path, "quiet", {"answer": "silent", "fault": "clock", "told": "first: 2 s late"})
    spoiled(tmp_path, "said", {"answer": "named", "fault": "unit", "told": "first: in degF"})
    spoiled(tmp_path, "as_it_is", {"answer": "silent", "fault": "nothing", "told": ""})
    spoiled(tmp_path, "conceals_something", None)
    assert left_to_search(tmp_path) == ["quiet"]


def test_a_part_is_drawn_by_a_seed() -> None:
    names = [f"case {n}" for n in range(40)]
    assert sorted(drawn(names, 3, 100)) == sorted(names)
    assert drawn(names, 3, 10) == drawn(names, 3, 40)[:10]
    assert drawn(names, 3, 10) != drawn(names, 4, 10)


ANSWER_BY_VERDICT = {
    "missing physics": "physics",
    "unnamed physics": "physics",
    "measurement fault": "fault",
    "recording fault": "fault",
    "consistent": "agrees",
    "recalibrated": "agrees",
    "cannot tell": "cannot tell",
}


@pytest.mark.parametrize("verdict", Verdict)
def test_every_verdict_has_its_answer(verdict: Verdict) -> None:
    assert kind_of(verdict.value) == ANSWER_BY_VERDICT[verdict.value]


def test_an_answer_stands_beside_what_was_done(tmp_path: Path) -> None:
    spoiled(tmp_path, "quiet", {"answer": "silent", "fault": "clock", "told": "first: 2 s late"})
    folder = tmp_path / "quiet"
    (folder / "log.txt").write_text("reading\nno answer within 300 s\n", encoding="utf-8")
    none = {"case": "quiet", "told": "first: 2 s late", "answer": "none", "says": "no answer within 300 s"}
    assert answer_of(folder) == none
    (folder / "diagnosis").mkdir()
    found = {"verdict": "missing physics", "statement": "The model leaves out: drag"}
    (folder / "diagnosis" / "diagnosis.json").write_text(json.dumps(found), encoding="utf-8")
    assert answer_of(folder) == {**none, "answer": "physics", "says": "The model leaves out: drag"}
    assert summary([answer_of(folder)]) == "1 cases: physics 1, fault 0, agrees 0, cannot tell 0, none 0"
    assert len(ANSWERS) == 5
