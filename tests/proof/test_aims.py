"""Shares, aims and tables of a handful of scored cases."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import pytest

from cosim.unit.errors import InputError
from diagnosis.judge.diagnosis import Verdict
from evaluation.proof.aims import Aim, aims
from evaluation.proof.answer import Sabotage
from evaluation.proof.breakdown import (
    by_effect,
    by_kind,
    by_method,
    by_rig,
    by_sabotage,
    by_verdict,
    confusions,
    unit_matrix,
)
from evaluation.proof.command import write_all
from evaluation.proof.result import read_results, row
from evaluation.proof.tables import page_of, short
from evaluation.proof.wilson import Share
from tests.proof.examples import RADIATION, REFERENCE, SHORT, answer, diagnosis, finding, result

NULL = answer(kind="null", verdicts=("consistent", "recalibrated"))
RIGHT = result(diagnosis(finding()), answer(RADIATION))
MISSED = result(diagnosis(verdict=Verdict.CONSISTENT), answer(replace(RADIATION, strength="strong")))
SHORTED = result(diagnosis(finding("open_coil", "electrical", "coil[2,3]")), answer(SHORT))
QUIET = result(diagnosis(verdict=Verdict.RECALIBRATED), NULL)
ALARM = result(diagnosis(finding()), NULL)
SWAPPED = Sabotage("swapped_columns", ("r",), ("coil[1,1].temperature",), 0.0, 100.0)
SPOILED = answer(kind="sabotaged", verdicts=("recording fault", "cannot tell"), sabotage=SWAPPED)
FAILED = result(None, answer(RADIATION, SHORT, kind="two"), outcome="timed out")
REFUSED = result(None, answer(RADIATION), outcome="refused")
RESULTS = [RIGHT, MISSED, SHORTED, QUIET, ALARM, FAILED, REFUSED]


def _aim(name: str) -> Aim:
    return next(a for a in aims(RESULTS) if a.name == name)


def test_wilson_interval_is_the_published_one() -> None:
    # R. G. Newcombe, Statistics in Medicine 17 (1998) 857-872, table I: 81 of 263 and 0 of 20, method 3.
    assert Share(81, 263).interval == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert Share(0, 20).interval == pytest.approx((0.0, 0.1611), abs=5e-5)
    assert str(Share(0, 0)) == "no case"


def test_answers_that_are_none_are_not_counted() -> None:
    assert Share.of([True, None, False, None]) == Share(1, 2)


@pytest.mark.parametrize(
    ("name", "hits", "total"),
    [
        ("unit right", 2, 3),  # right, missed, shorted; the refused one is counted apart
        ("element right", 2, 3),
        ("time right", 0, 1),
        ("named first", 1, 3),
        ("false alarms", 1, 2),
        ("both of two effects", 0, 1),  # what timed out is wrong
        ("95 % intervals that hold the true parameter", 1, 1),
    ],
)
def test_aims_count_the_cases_that_they_are_about(name: str, hits: int, total: int) -> None:
    assert _aim(name).share == Share(hits, total)


def test_an_aim_is_reached_within_its_bounds_and_with_enough_cases() -> None:
    alarms = Aim("false alarms", 0.0, 0.05, Share(5, 100), fewest=100)
    assert alarms.is_reached
    assert not replace(alarms, share=Share(6, 100)).is_reached
    assert not replace(alarms, share=Share(0, 99)).is_reached
    assert not Aim("intervals", 0.9, 0.99, Share(100, 100)).is_reached
    assert not Aim("unit right", 0.95, 1.0, Share(0, 0)).is_reached


def test_visible_effects_are_counted_apart() -> None:
    hidden = replace(MISSED, reference=replace(REFERENCE, training_gain=19.0))
    (named,) = [a for a in aims([RIGHT, hidden]) if a.name == "named first"]
    assert named.share == Share(1, 2)
    assert named.visible == Share(1, 1)


def test_the_weakest_effects_come_first() -> None:
    rows = by_effect(RESULTS)
    assert [r[0] for r in rows] == ["shorted_coil", "radiation"]
    assert rows[0][2:8] == ("", "", "0 of 2", "1 of 2", "1 of 2", "0 of 2")
    assert rows[1][2:5] == ("1 of 2", "", "0 of 1")
    assert rows[1][-1] == "- (2)"


def test_confusions_tell_what_was_found_instead() -> None:
    assert confusions(RESULTS) == [("radiation", "-", 2), ("shorted_coil", "-", 1), ("shorted_coil", "open_coil", 1)]
    header, rows = unit_matrix(RESULTS)
    table = {r[0]: dict(zip(header[1:], r[1:])) for r in rows}
    assert table["thermal"]["thermal"] == 1
    assert table["thermal"]["nothing"] == 2
    assert table["electrical"]["electrical"] == 1


def test_kinds_rigs_and_methods_are_told_apart() -> None:
    kinds = {r[0]: r for r in by_kind(RESULTS)}
    assert kinds["single"][1] == 3
    assert kinds["null"][2] == Share(1, 2)
    assert kinds["null"][3] == Share(1, 2)
    assert kinds["null"][5] == 1
    (rig,) = by_rig(RESULTS)
    assert rig[2:5] == (6, Share(2, 6), Share(1, 2))
    methods = {r[0]: r for r in by_method(RESULTS)}
    # recalibrated, process, SINDy (ran away), diagnosis, knows, without the effect, noise; then runs away and terms
    assert methods["single"][2:] == (3.0, 2.0, float("inf"), 1.0, 1.0, None, 0.95, 3, 21.0)


def test_false_claims_are_of_sabotaged_cases_and_a_refusal_claims_nothing() -> None:
    named = result(diagnosis(finding()), SPOILED)
    careful = result(diagnosis(verdict=Verdict.CANNOT_TELL), SPOILED)
    refused = result(None, SPOILED, outcome="refused")
    late = result(None, SPOILED, outcome="timed out")
    by_name = {a.name: a for a in aims([named, careful, refused, late, *RESULTS])}
    assert by_name["false claims on sabotaged recordings"].share == Share(2, 4)
    assert by_name["false alarms"].share == Share(1, 2)  # of nulls alone
    # right, shorted (a false name), quiet, alarm, missed (which says that all is well), named and careful
    assert by_name["headline true, all kinds"].share == Share(3, 7)
    assert by_sabotage([named, careful, refused, *RESULTS]) == [
        ("swapped_columns", 3, 1, Share(1, 2), 1, "1 missing physics, 1 cannot tell, 1 refused")
    ]
    assert by_verdict([careful, QUIET, MISSED]) == [
        ("cannot tell", 1, Share(1, 1)),
        ("consistent", 1, Share(0, 1)),
        ("recalibrated", 1, Share(1, 1)),
    ]


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("false claims on sabotaged recordings", "at most 2 % of at least 60"),
        ("false alarms", "at most 5 % of at least 100"),
        ("headline true, all kinds", "95 %"),
        ("both of two effects", "70 %"),
        ("outside the catalogue: 80 % of the possible held-out gain", "80 %"),
        ("composed laws: 80 % of the possible held-out gain", "80 %"),
        ("left out of the catalogue: not misnamed", "90 %"),
    ],
)
def test_what_is_wanted(name: str, wanted: str) -> None:
    assert _aim(name).wanted == wanted


def test_the_page_tells_the_library_of_the_draw() -> None:
    about = {"cases": 7, "seed": 1, "library": "abc123", "library_now": "abc123"}
    assert "library frozen before the draw: abc123" in page_of([about], RESULTS)
    assert "another" not in page_of([about], RESULTS).split("## Aims")[0]
    assert "scored with another: def456" in page_of([about | {"library_now": "def456"}], RESULTS)


def test_a_twin_stands_beside_noise_alone(tmp_path: Path) -> None:
    case = replace(RIGHT, kind="outside", reference=replace(REFERENCE, oracle=None, twin=1.2))
    ((*_, knows, without, noise, _, _),) = by_method([case])
    assert (knows, without, noise) == (None, 1.2, 0.95)
    write_all([case, RIGHT], {"cases": 2, "seed": 1}, tmp_path)
    rows = list(csv.DictReader((tmp_path / "results.csv").read_text().splitlines()))
    assert [(r["twin"], r["floor"]) for r in rows] == [("1.2", "0.95"), ("", "0.95")]
    assert "| knows the effect | without the effect | noise alone |" in (tmp_path / "tables.md").read_text()


def test_results_of_a_proof_without_twins_can_be_read(tmp_path: Path) -> None:
    write_all([RIGHT], {"cases": 1, "seed": 1}, tmp_path)
    content = json.loads((tmp_path / "results.json").read_text())
    del content["cases"][0]["reference"]["twin"]
    (tmp_path / "results.json").write_text(json.dumps(content))
    assert read_results(tmp_path)[1] == [RIGHT]


def test_files_hold_every_case_and_can_be_read_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    about = {"cases": 7, "seed": 1, "kinds": "", "setups": "small"}
    write_all(RESULTS, about, tmp_path)
    assert "named first: 33 %" in capsys.readouterr().out
    again_about, again = read_results(tmp_path)
    assert (again_about, again) == (about, RESULTS)
    rows = list(csv.DictReader((tmp_path / "results.csv").read_text().splitlines()))
    assert [r["outcome"] for r in rows] == ["diagnosed"] * 5 + ["timed out", "refused"]
    assert rows[5]["effect"] == "radiation;shorted_coil"
    page = (tmp_path / "tables.md").read_text()
    assert "| named first | 85 % | 33 % (1 of 3; 6 to 79 %) |" in page
    assert "| case_0001 | two | small | timed out |  |" in page


def test_proofs_are_put_together() -> None:
    page = page_of([{"cases": 7, "seed": 1}, {"cases": 7, "seed": 2}], [*RESULTS, *RESULTS])
    assert "`cosim prove --cases 7 --seed 2`" in page
    assert "14 cases. 2 of them were refused" in page
    assert "| named first | 85 % | 33 % (2 of 6; 10 to 70 %) |" in page
    assert "both of two effects: 0 % (0 of 2" in short([*RESULTS, *RESULTS])


@pytest.mark.parametrize("text", ["", "[]", json.dumps({"about": {}, "cases": [{"case": 1}]})])
def test_a_folder_without_results_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "results.json").write_text(text)
    with pytest.raises(InputError, match="no result of this version"):
        read_results(tmp_path)


def test_a_row_has_single_values() -> None:
    assert all(isinstance(v, str | int | float | bool | None) for v in row(FAILED).values())
