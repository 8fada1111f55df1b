"""Other ways to describe the training, where readings of another recording reject the answer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.model_error import search_with_model_error
from diagnosis.models.protocol import ModelBase
from diagnosis.models.wrappers.quasi_likelihood import QuasiLikelihoodModel
from diagnosis.search.fit import fit
from diagnosis.search.search import Explanation, Outcome, Settings
from diagnosis.ways import other_ways
from tests.diagnosis.test_model_error import Rig
from tests.search.line_model import BEND, LID, STEP, TIME, WAVE


class Whole(Rig, ModelBase):
    """With what other ways ask of a model."""


def with_fault(model: Rig, outcome: Outcome) -> Outcome:
    """The outcome as it is where an event of one recording is among what was found."""
    point = outcome.best.fit.point.plus(STEP, (0.5, 0.4))
    best = Explanation(fit(model, point))
    return replace(outcome, best=best, rivals=(best,))


@pytest.mark.parametrize("errs", [True, False])
def test_where_a_fault_was_found_and_the_model_errs_laws_alone_are_validated_too(errs: bool) -> None:
    """Readings with a saw that no law has: a step of one recording fills a gap of it, and predicts nothing."""
    model = Whole(0.3 + 0.5 * TIME + 3.0 * TIME**2 + 0.6 * (TIME * 4.5 % 1.0), seed=1)
    outcome, found = search_with_model_error(model, Settings())
    assert isinstance(found, QuasiLikelihoodModel)
    assert outcome.first is not None
    given = with_fault(model, outcome if errs else replace(outcome, first=None))
    said: list[str] = []
    ways = list(other_ways(model, given, Settings(), said.append))
    assert said[0] == "searching laws that hold in all recordings alone"
    assert all(STEP not in way.best.terms for way, _ in ways)
    validated = [way for way, _ in ways if way.first is not None]
    assert len(validated) == (1 if errs else 0)
    if errs:
        assert set(validated[0].best.terms) <= {BEND, WAVE, LID}
        assert BEND in validated[0].best.terms


def test_where_laws_meet_the_training_one_generic_term_alone_is_asked_for_too() -> None:
    """A wave that the search took for a bend and a lid: what meets readings in training may be refuted by others."""
    model = Whole(0.3 + 0.5 * TIME + 0.6 * np.sin(25.0 * TIME), seed=2)
    outcome, _ = search_with_model_error(model, Settings())
    assert set(outcome.best.terms) == {WAVE}
    assert outcome.left.is_noise
    bent = Explanation(fit(model, outcome.base.point.plus(BEND, (0.5,))))
    given = replace(outcome, best=bent, rivals=(bent,))
    assert [set(way.best.terms) for way, _ in other_ways(model, given, Settings())] == [{WAVE}]


def test_where_nothing_was_found_and_noise_is_left_there_is_no_other_way() -> None:
    model = Whole(0.3 + 0.5 * TIME, seed=3)
    outcome, _ = search_with_model_error(model, Settings())
    assert not outcome.best.terms
    assert not list(other_ways(model, outcome, Settings()))
