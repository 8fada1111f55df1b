"""Another named law in the place of one of several that were found."""

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.search.exchange import in_their_places
from diagnosis.search.fit import fit
from diagnosis.search.search import Explanation, recalibrate, shrink
from tests.search.line_model import BEND, STEP, TIME, WAVE, LineModel

#: The same readings as a bend: nothing tells them apart.
BOW = replace(BEND, identifier="bow")
#: Readings of another form.
NOTCH = replace(BEND, identifier="notch")
#: As the bow, elsewhere, and in one recording alone.
FAR, OF_A_DAY = replace(BOW, place="elsewhere"), replace(BOW, recording=0)


class Twins(LineModel):
    """With laws that change the readings as others do."""

    def signal(self, point):
        found = super().signal(point)
        for term, values in point.terms.items():
            if term.identifier == "bow":
                found = found + values[0] * TIME**2
            elif term.identifier == "notch":
                found = found - values[0] * np.exp(-(((TIME - 0.5) / 0.1) ** 2))
        return found


@pytest.fixture(scope="module")
def model():
    return Twins(0.3 + 0.5 * TIME + 2.0 * TIME**2 + 0.5 * (TIME > 0.4), seed=5)


def of(model, *terms):
    """The fit with terms, and those without each."""
    point = recalibrate(model).point
    for term in terms:
        point = point.plus(term, (1.0, 0.4) if term == STEP else (1.0,))
    found = shrink(model, Explanation(fit(model, point)), 20.0)
    return found.fit, found.without


def test_twins_are_fitted_wherever_they_are_and_what_has_another_form_or_belongs_to_a_day_is_not(model):
    found, without = of(model, BEND, STEP)
    others = in_their_places(model, found, without, [BEND, BOW, NOTCH, FAR, OF_A_DAY, STEP, WAVE])
    assert list(others) == [BEND]
    assert {twin for twin, _ in others[BEND]} == {BOW, FAR}
    for twin, explanation in others[BEND]:
        assert set(explanation.terms) == {twin, STEP}
        assert explanation.fit.cost == pytest.approx(found.cost, abs=0.1)


def test_where_nothing_else_is_named_nothing_is_fitted(model):
    found, without = of(model, BEND, STEP)
    assert in_their_places(model, found, without, [BEND, OF_A_DAY, STEP, WAVE]) == {}
