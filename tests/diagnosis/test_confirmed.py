"""Held-out recordings have the last word on findings."""

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge.confirmed import confirmed, held_out_chi_square
from diagnosis.judge.diagnosis import ChannelFit, Diagnosis, Verdict
from diagnosis.judge.own_numbers import foretold
from diagnosis.report.sentences import improvement
from diagnosis.search.posterior import cost
from diagnosis.search.problem import Point
from tests.diagnosis.report_examples import diagnosis as example
from tests.search.line_model import TIME, LineModel


def _with(recalibrated: float, after: float, samples: int = 400) -> Diagnosis:
    stages = {"before": 9.0, "recalibrated": recalibrated, "after": after}
    fit = ChannelFit("held out", True, "coil[1,1].temperature", "K", stages, stages, stages, samples)
    return replace(example(Verdict.MISSING_PHYSICS), fit=(fit,))


def test_findings_that_foretell_better_stand():
    assert confirmed(_with(2.0, 1.0)).verdict is Verdict.MISSING_PHYSICS


def test_findings_that_foretell_worse_are_refuted_and_stay_listed():
    found = confirmed(_with(1.0, 1.2))
    assert found.verdict is Verdict.CANNOT_TELL
    assert found.findings
    assert "480 against 400" in found.statement


@pytest.mark.parametrize(("after", "is_kept"), [(1.04, True), (1.06, False)])
def test_a_rise_within_chance_refutes_nothing(after, is_kept):
    # 400 samples: 0.04 is 16, below 20; 0.06 is 24, above it and above 2 % of 400
    assert (confirmed(_with(1.0, after)).verdict is Verdict.MISSING_PHYSICS) is is_kept


def test_training_recordings_refute_nothing():
    found = _with(1.0, 5.0)
    training = replace(found, fit=tuple(replace(f, is_held_out=False) for f in found.fit))
    assert confirmed(training).verdict is Verdict.MISSING_PHYSICS
    assert held_out_chi_square(training, "after") == 0.0


def test_a_room_that_nobody_measured_refutes_nothing():
    # The plain chi-square rises by a fifth; with the room of that day unknown it falls.
    found = confirmed(_with(1.0, 1.2), lambda: {"recalibrated": 390.0, "after": 350.0})
    assert found.verdict is Verdict.MISSING_PHYSICS
    assert found.foretold == {"recalibrated": 390.0, "after": 350.0}
    assert improvement(found).endswith("taken as unknown: 0.975 recalibrated only, 0.875 after")  # of 400 samples


def test_what_foretells_worse_with_the_room_unknown_too_is_refuted():
    found = confirmed(_with(1.0, 1.2), lambda: {"recalibrated": 350.0, "after": 390.0})
    assert found.verdict is Verdict.CANNOT_TELL
    assert "390 against 350" in found.statement


def test_the_room_is_asked_for_only_where_the_plain_chi_square_speaks_against():
    def asked():
        raise AssertionError("nothing speaks against")

    assert confirmed(_with(2.0, 1.0), asked).foretold == {}


def test_what_belongs_to_the_day_counts_by_its_prior_alone():
    """The least of |r + J z|^2 + z^2 over z is r' (1 + J J')^-1 r: the noise and the room together."""
    trained, judge = LineModel(0.3 + 0.5 * TIME), LineModel(0.7 + 0.5 * TIME, seed=1)
    judge.parameters[0] = replace(judge.parameters[0], name="offset of recording 1")
    point = Point(np.array([0.3, 0.5]))
    found = foretold(judge, trained, {"after": point})["after"]
    r, day = judge.residuals([point])[0], judge.base_jacobian(point)[:, 0]
    # at the offset 0 the prior has no pull: residuals there, and the prior's z from there
    r = r - day * point.base[0]
    assert found == pytest.approx(r @ r - (day @ r) ** 2 / (1.0 + day @ day), rel=1e-6)  # end of the iteration
    assert found < 0.1 * cost(judge.residuals([point])[0], np.zeros(0))
