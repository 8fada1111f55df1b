"""A small proof, whole: cases are made, diagnosed in processes of their own, and scored. It must go well."""

from __future__ import annotations

import pytest

from evaluation.proof.ground import Draw
from evaluation.proof.proof import Effort, Folder, prove
from evaluation.proof.result import CaseResult
from evaluation.proof.workers import workers

#: On the two quick rigs: one null, a fault of a sensor, and effects in the heat and in the length.
DRAW = Draw(5, 27, ("null", "single", "sensor"), ("bath", "heaters"))


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> dict[str, CaseResult]:
    with workers(1) as alone:
        found = prove(Folder(tmp_path_factory.mktemp("proof")), DRAW, alone, Effort(limit=1200.0, has_baselines=False))
    names = [r.score.effects[0].effect if r.score.effects else "null" for r in found]
    return dict(zip(names, found))


def test_the_cases_are_those_of_the_draw(results: dict[str, CaseResult]) -> None:
    assert set(results) == {"draught", "null", "creep", "insulation_when_off", "sensor_clock_offset"}
    assert {r.outcome for r in results.values()} == {"diagnosed"}


def test_nothing_is_found_where_nothing_is(results: dict[str, CaseResult]) -> None:
    assert results["null"].score.is_false_alarm is False
    assert results["null"].score.is_verdict_right


@pytest.mark.parametrize(
    ("effect", "verdict"),
    [
        ("draught", "missing physics"),
        ("creep", "missing physics"),
        ("insulation_when_off", "missing physics"),
        ("sensor_clock_offset", "measurement fault"),
    ],
)
def test_concealed_effects_are_located_and_named(results: dict[str, CaseResult], effect: str, verdict: str) -> None:
    scored = results[effect].score
    (found,) = scored.effects
    assert scored.verdict == verdict
    assert (found.found, found.is_unit_right, found.is_place_right) == (effect, True, True)
    assert found.is_in_class
    assert scored.held_out.is_as_good


def test_the_instant_of_a_draught_is_found(results: dict[str, CaseResult]) -> None:
    assert results["draught"].score.effects[0].is_time_right


def test_the_true_terms_explain_what_is_left_in_held_out_recordings(results: dict[str, CaseResult]) -> None:
    reference = results["insulation_when_off"].reference
    assert reference.training_gain is not None
    assert reference.training_gain > 1000.0
    # Noise alone is 1 by definition; its estimate from a few thousand samples, rounding included, is within 15 %.
    assert reference.floor == pytest.approx(1.0, abs=0.15)
    assert reference.recalibrated is not None
    assert reference.oracle is not None
    assert reference.recalibrated > 10.0 * reference.oracle
