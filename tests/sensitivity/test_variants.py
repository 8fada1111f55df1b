"""Trees in which one number of the diagnosis is another."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from evaluation.sensitivity.__main__ import _NOT_ENDED, changes, page
from evaluation.sensitivity.variant import ROOT, Constant, constants, write_variant


def constant(name: str, package: str = "judge") -> Constant:
    return next(c for c in constants(package) if c.key == name)


def imported(folder: Path, module: str, names: str) -> str:
    """What a process finds that takes its packages from a folder first."""
    own = {**os.environ, "PYTHONPATH": f"{folder}{os.pathsep}{ROOT}"}
    code = f"import {module} as m; print([getattr(m, n) for n in {names.split()!r}])"
    done = subprocess.run([sys.executable, "-P", "-c", code], env=own, capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_constants_are_those_of_the_source() -> None:
    found = {c.key: c.value for c in constants("judge")}
    assert found["judge.agreement.LEVEL"] == 0.001
    assert (found["judge.agreement.LAGS"], found["judge.agreement.FEWEST"]) == (20, 30)  # defined in one line
    assert "judge.verdict._UNCONFIRMED" not in found


@pytest.mark.parametrize(
    ("value", "half", "twice"),
    [(0.001, 0.0005, 0.002), (20, 10, 40), (1, None, 2), (0.0, None, None), (-4.0, -2.0, -8.0), (0.99, 0.98, 0.995)],
)
def test_halves_and_doubles(value: float, half: float | None, twice: float | None) -> None:
    one = Constant("diagnosis/judge/x.py", "X", value)
    for factor, expected in ((0.5, half), (2.0, twice)):
        now = one.at(factor)
        assert now is expected is None or (now == pytest.approx(expected) and type(now) is type(value))


def test_a_variant_differs_in_one_number(tmp_path: Path) -> None:
    write_variant(constant("judge.agreement.FOR_A_LAG"), 10, tmp_path)
    names = "LAGS FOR_A_LAG FEWEST LEVEL"
    assert imported(tmp_path, "diagnosis.judge.agreement", names) == "[20, 10, 30, 0.001]"
    changed = [
        p
        for p in (tmp_path / "diagnosis").rglob("*.py")
        if p.read_text() != (ROOT / p.relative_to(tmp_path)).read_text()
    ]
    assert [p.name for p in changed] == ["agreement.py"]


def test_what_changes_is_told_by_verdict_and_by_findings() -> None:
    before = {"a": {"verdict": "recalibrated", "accepted": []}, "b": {"verdict": "missing physics", "accepted": ["x"]}}
    assert changes(before, before) == "-"
    now = {"a": {"verdict": "cannot tell", "accepted": []}, "b": {"verdict": "missing physics", "accepted": []}}
    assert changes(before, now) == "a: recalibrated -> cannot tell; b: x -> nothing"
    assert changes(before, {**before, "b": _NOT_ENDED}) == "b: missing physics -> did not end"


def test_the_page_parts_numbers_that_change_something_from_others() -> None:
    one, other = Constant("diagnosis/judge/x.py", "X", 3), Constant("diagnosis/judge/y.py", "Y", 0.5)
    text = page("judge", ["a"], [(one, ["-", "a: p -> q"]), (other, ["as it is", "-"])])
    assert "| `judge.x.X` | 3 | - | a: p -> q |" in text
    assert "any of these answers: `judge.y.Y`." in text


@pytest.mark.parametrize("cases", [["nowhere"], ["."]])
def test_a_folder_that_is_no_case_is_refused(tmp_path: Path, cases: list[str]) -> None:
    command = [sys.executable, "-m", "evaluation.sensitivity", "--package", "judge", "--out", str(tmp_path / "out")]
    done = subprocess.run([*command, "--cases", *cases], capture_output=True, text=True, cwd=ROOT)
    assert done.returncode == 2
    assert "this is no case" in done.stderr
    assert not (tmp_path / "out").exists()


def test_a_case_is_answered_or_its_error_is(tmp_path: Path) -> None:
    (tmp_path / "case" / "task").mkdir(parents=True)
    (tmp_path / "case" / "answer.json").write_text(json.dumps({"training": ["one"], "held_out": ["two"]}))
    command = [sys.executable, "-m", "evaluation.sensitivity.answers", str(tmp_path / "case")]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
    found = json.loads(done.stdout)
    assert found["case"] == "case"
    assert found["verdict"].startswith("refused: ")
