"""Where the model errs by more than noise, no fit takes a size that no rig has; else the readings decide."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge.plausibility import implausible
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point, limits_of
from tests.search.line_model import BEND, TIME, LineModel

#: The bend of the line, believed up to half a unit.
SMALL = replace(BEND, parameters=(replace(BEND.parameters[0], plausible=0.5),))


class BelievedLine(LineModel):
    """A line that is known to err by more than noise."""

    sizes_are_believed = True

    def signal(self, point: Point) -> np.ndarray:
        """With the small bend for the one that the line knows."""
        values = tuple(point.terms.values())
        return super().signal(Point(point.base, {BEND: values[0]} if values else {}))


class FreeLine(BelievedLine):
    """The same, met within its noise."""

    sizes_are_believed = False


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_fit_ends_at_the_largest_believed_size_and_the_verdict_knows(sign: float) -> None:
    truth = sign * 2.0 * TIME**2
    start = Point(np.zeros(2)).plus(SMALL, (0.1 * sign,))
    held = fit(BelievedLine(truth), start).point.terms[SMALL]
    assert held == pytest.approx((0.5 * sign,), rel=1e-6)
    (sentence,) = implausible(SMALL, held)
    assert sentence == "a lies at 0.5, the most that is believed"
    free = fit(FreeLine(truth), start).point.terms[SMALL]
    assert free == pytest.approx((2.0 * sign,), abs=0.3)
    assert "would have to be" in implausible(SMALL, free)[0]


def test_a_size_within_belief_is_fitted_alike_by_both() -> None:
    start = Point(np.zeros(2)).plus(SMALL, (0.1,))
    truth = 0.3 * TIME**2
    found = [fit(model(truth), start).point.terms[SMALL][0] for model in (BelievedLine, FreeLine)]
    assert found[0] == pytest.approx(found[1])
    assert implausible(SMALL, (found[0],)) == []


def test_all_of_a_share_is_no_size_that_a_fit_was_held_at() -> None:
    share = replace(BEND, parameters=(replace(BEND.parameters[0], lower=0.0, upper=1.0, plausible=1.0),))
    assert implausible(share, (1.0,)) == []


def test_a_belief_below_the_smallest_size_leaves_the_bounds_as_they_are() -> None:
    odd = replace(BEND.parameters[0], lower=1.0, upper=2.0, plausible=0.5)
    assert limits_of(BelievedLine(0.0 * TIME), odd) == (1.0, 2.0)
