"""Another named law in the place of one of several that were found."""

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.search.exchange import in_its_place
from diagnosis.search.fit import fit
from diagnosis.search.search import Explanation, Settings, recalibrate, search, shrink
from tests.search.line_model import BEND, STEP, TIME, WAVE, LineModel

#: The same readings as a bend: nothing tells them apart.
BOW = replace(BEND, identifier="bow")
#: At the place of the bend, with readings of another form.
NOTCH = replace(BEND, identifier="notch")
#: As the bow, elsewhere; and in one recording alone.
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
    point = recalibrate(model).point
    for term in terms:
        point = point.plus(term, (1.0, 0.4) if term == STEP else (1.0,))
    return shrink(model, Explanation(fit(model, point)), 20.0)


def test_the_twin_is_fitted_and_what_has_another_form_is_not(model):
    found = of(model, BEND, STEP)
    (other,) = in_its_place(model, found, [BEND, BOW, NOTCH, FAR, OF_A_DAY, STEP, WAVE])
    assert set(other.terms) == {BOW, STEP}
    assert other.fit.cost == pytest.approx(found.fit.cost, abs=0.1)


def test_one_law_alone_was_compared_with_all_when_it_was_found(model):
    assert in_its_place(model, of(Twins(0.3 + 2.0 * TIME**2), BEND), [BEND, BOW]) == []


def test_a_search_knows_the_twin_of_what_it_found_first(model):
    outcome = search(model, [BEND, STEP, BOW, NOTCH], Settings())
    rivals = [set(e.terms) for e in outcome.rivals if abs(e.fit.cost - outcome.best.fit.cost) < 1.0]
    assert {BEND, STEP} in rivals
    assert {BOW, STEP} in rivals
