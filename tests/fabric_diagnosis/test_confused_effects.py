"""An effect of a fabric bears no name alone while one that data often cannot tell from it does as well."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.judge.acceptance import STRENGTHS, _confused, _scattered
from diagnosis.judge.rivals import INTERPOLATED, alternatives_to, open_rivals
from diagnosis.judge.unfitted import Predicted
from diagnosis.models.fabric import search as fabric_search
from diagnosis.models.fabric.mechanical import MechanicalModel
from diagnosis.search.problem import Point
from diagnosis.search.search import Explanation, Settings, search
from tests.fabric_diagnosis.test_scatter_and_search import TERMS, effect, members, model
from tests.verdict.test_gain_and_agreement import COUNT, readings

TILT, PAYLOAD, WIRES, FRICTION = TERMS


class Known:
    """A mechanical model with the laws of its terms: a tilt is often confused with a payload and with friction."""

    def __init__(self, inner: MechanicalModel) -> None:
        self.inner = inner

    def __getattr__(self, name: str) -> Any:
        return getattr(self.inner, name)

    def terms(self) -> list[Any]:
        return TERMS

    def where(self, term: Any) -> tuple[Any, Any]:
        names = {"payload": "lengths decide", "friction": "speed decides", "base:link_mass": "a weight decides"}
        return SimpleNamespace(confused_with=names if term == TILT else {}), None


def found(likeness: float) -> tuple[Known, Explanation]:
    """A fabric that leans, where a payload moves markers by the same pattern and by one of its own."""
    drawn = members(9, 5)
    own = model(drawn[8] + effect(0, 4e-3), drawn[:8])
    alike = likeness * effect(0, 1e-3) + np.sqrt(1.0 - likeness**2) * effect(1, 1e-3)
    own.surface.forget(PAYLOAD)
    own.surface.add(PAYLOAD, 1.0, own.surface.mean + alike, np.zeros(1))
    known = Known(own)
    return known, search(known, TERMS, Settings()).best  # type: ignore[arg-type]


class Judge:
    """Readings that judge: noise is left by the model with a tilt, and ten times as much by the laws that miss them.

    Args:
        as_good: Effects that predict them as well, at the second of the strengths that are asked.
    """

    def __init__(self, *as_good: str) -> None:
        self.unfitted = SimpleNamespace(readings=readings())
        self.asked: list[Point] = []
        self._as_good, self._noise = as_good, np.random.default_rng(2).standard_normal(COUNT)

    def predict(self, point: Point) -> Predicted:
        others = [t.identifier for t in point.terms if t != TILT]
        if not others:
            return Predicted(self._noise, self._noise)
        self.asked.append(point)
        is_second = sum(set(others) == {t.identifier for t in p.terms if t != TILT} for p in self.asked) == 2
        left = self._noise * (1.0 if is_second and set(others) <= set(self._as_good) else 10.0)
        return Predicted(left, left)


def confused(known: Known, best: Explanation, term: Any, *as_good: str) -> tuple[tuple[Any, float], ...]:
    return _confused(known, Judge(*as_good), best, term)  # type: ignore[arg-type]


@pytest.mark.parametrize(("likeness", "is_open"), [(0.999, True), (0.3, False)])
def test_what_does_as_well_is_a_rival_and_what_does_not_is_none(likeness: float, is_open: bool) -> None:
    known, best = found(likeness)
    largest = max(best.terms, key=lambda t: best.gains[t])
    assert largest in (TILT, PAYLOAD)
    if largest == PAYLOAD:  # as alike as that, either may come first
        pytest.fail("the effect itself is found here")
    rivals = dict(confused(known, best, TILT))
    assert set(rivals) == {PAYLOAD, FRICTION}
    assert (rivals[PAYLOAD] < INTERPOLATED) is is_open
    assert rivals[FRICTION] > INTERPOLATED
    accepted: Any = SimpleNamespace(headline=best, rivals=(), confused={TILT: tuple(rivals.items())})
    assert open_rivals([], TILT, accepted) == (("payload",) if is_open else ())
    alternatives, probability = alternatives_to(None, accepted, TILT)  # type: ignore[arg-type]
    assert probability == (0.5 if is_open else 1.0)
    assert [a.effect for a in alternatives] == (["payload"] if is_open else [])


def test_an_effect_that_names_no_other_and_that_none_names_has_no_such_rival() -> None:
    known, best = found(0.3)
    assert confused(known, Explanation(best.fit), WIRES) == ()


def test_of_two_laws_one_has_to_name_the_other() -> None:
    known, best = found(0.3)
    asked = replace(best.fit, point=Point(best.fit.point.base, {FRICTION: (1.0,)}))
    assert [other for other, _ in confused(known, Explanation(asked), FRICTION)] == [TILT]


def test_what_predicts_the_readings_that_judge_as_well_is_a_rival_whatever_few_simulations_say_of_it() -> None:
    known, best = found(0.3)
    rivals = dict(confused(known, best, TILT, "friction"))
    assert rivals[FRICTION] == 0.0
    assert rivals[PAYLOAD] > INTERPOLATED


def test_rivals_are_asked_at_their_fitted_strength_and_at_others() -> None:
    known, best = found(0.3)
    judge = Judge()
    _confused(known, judge, best, TILT)  # type: ignore[arg-type]
    sizes = [p.terms[PAYLOAD][0] for p in judge.asked if PAYLOAD in p.terms]
    # The bound itself is asked: coils that stay cold are the end of coils that are heated less.
    within = [share * sizes[1] for share in STRENGTHS if share * sizes[1] < PAYLOAD.parameters[0].upper]
    assert sizes == pytest.approx([*within, PAYLOAD.parameters[0].upper])
    assert len(within) >= 3
    assert not any(TILT in p.terms for p in judge.asked)


def test_names_are_as_open_as_the_search_goes_on() -> None:
    assert INTERPOLATED == fabric_search.BEHIND


class Rejecting(Judge):
    """A judge whose readings, of training or held out, do or do not reject a model without an effect."""

    def __init__(self, does_reject: bool) -> None:
        super().__init__()
        self.model, self._does_reject = SimpleNamespace(has_scatter=True), does_reject

    def rejects(self, point: Point) -> bool:
        return self._does_reject


@pytest.mark.parametrize(
    ("does_reject", "unit", "count"), [(False, "mechanical", 1), (True, "mechanical", 0), (False, "thermal", 0)]
)
def test_an_effect_that_no_readings_ask_for_is_not_accepted_of_what_scatters(
    does_reject: bool, unit: str, count: int
) -> None:
    """Two equal fabrics part in a direction, and a weak law of the fabric may follow it, held out too."""
    without = SimpleNamespace(point=Point(np.zeros(1)))
    told = _scattered(Rejecting(does_reject), replace(TILT, unit=unit), without)  # type: ignore[arg-type]
    assert len(told) == count
    assert not told or "reject the model without it" in told[0]


def test_of_a_model_that_does_not_scatter_no_readings_have_to_reject_it() -> None:
    judge = Rejecting(False)
    judge.model = SimpleNamespace(has_scatter=False)
    assert _scattered(judge, TILT, SimpleNamespace(point=Point(np.zeros(1)))) == []  # type: ignore[arg-type]
