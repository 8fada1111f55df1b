"""`cosim prove` as a user meets it."""

from __future__ import annotations

from pathlib import Path

from typer.testing import CliRunner

from cosim.cli import app
from cosim.unit.errors import InputError
from diagnosis.judge.diagnosis import Verdict
from evaluation.proof.command import write_all
from tests.proof.examples import RADIATION, answer, diagnosis, finding, result

RUNNER = CliRunner()


def _refusal(*arguments: str) -> InputError:
    error = RUNNER.invoke(app, ["prove", *arguments]).exception
    assert isinstance(error, InputError)
    return error


def test_there_must_be_a_proof_to_go_on_with(tmp_path: Path) -> None:
    assert "no proof to go on with" in _refusal("--resume", "--out", str(tmp_path)).problem


def test_an_unknown_kind_is_refused_in_words(tmp_path: Path) -> None:
    error = _refusal("--kinds", "nulls", "--out", str(tmp_path), "--jobs", "1", "--no-baselines")
    assert "there is no kind of case `nulls`" in error.problem


def test_tables_need_results(tmp_path: Path) -> None:
    assert "cannot be read" in _refusal("--table", str(tmp_path)).problem


def test_several_proofs_become_one_page(tmp_path: Path) -> None:
    right = [result(diagnosis(finding()), answer(RADIATION))]
    wrong = [result(diagnosis(verdict=Verdict.CONSISTENT), answer(RADIATION))]
    for seed, results in ((1, right), (2, wrong)):
        (tmp_path / str(seed)).mkdir()
        write_all(results, {"cases": 1, "seed": seed, "kinds": "", "setups": ""}, tmp_path / str(seed))
    page = tmp_path / "page.md"
    tables = ["--table", str(tmp_path / "1"), "--table", str(tmp_path / "2")]
    assert RUNNER.invoke(app, ["prove", *tables, "--page", str(page)]).exit_code == 0
    assert "| named first | 85 % | 50 % (1 of 2; 9 to 91 %) |" in page.read_text()
