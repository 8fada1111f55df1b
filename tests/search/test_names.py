"""When an effect may be called by its name, and which laws without one are tried before."""

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge.diagnosis import Estimate
from diagnosis.judge.standing import unidentified
from diagnosis.search.fit import fit
from diagnosis.search.grow import EQUATIONS, _unnamed_equations
from diagnosis.search.problem import Point, Term, TermParameter
from diagnosis.search.score import Score
from diagnosis.search.search import recalibrate
from tests.search.line_model import LID, STEP, TIME, LineModel

LINE = 0.3 + 0.5 * TIME
REACH = TermParameter("reach", "m", 0.0, 0.05, (0.003,))
WIRE = Term("wire", "all", "mechanical", (TermParameter("a", "N/m", 0.0, 10.0, (1.0,)), REACH))


BREAK = replace(STEP, parameters=(replace(STEP.parameters[0], upper=1.0, plausible=1.0), STEP.parameters[1]))


GAIN = Term("gain", "all", "measurement", (TermParameter("gain", "1", -1.0, 1.0, (0.02,)),))


@pytest.mark.parametrize(
    ("term", "values", "is_doubtful"),
    [
        (LID, (1.0, 0.7), False),
        (LID, (1.0, 50.0), True),
        (LID, (1.0, -50.0), True),
        (STEP, (0.4, 1.0), False),  # an instant may lie anywhere
        (STEP, (10.0, 0.5), True),  # a strength at its bound is not identified
        (BREAK, (1.0, 0.5), False),  # a clean break is all there is
        (GAIN, (-1.0,), False),  # nothing is left
        (GAIN, (1.0,), True),  # more than twice as much may be
        (STEP, (0.0, 0.5), True),  # there it vanishes
        (WIRE, (1.0, 0.0), False),  # nothing of a part of the law
        (WIRE, (1.0, 0.05), True),
    ],
)
def test_a_law_at_a_bound_is_not_identified_unless_a_rig_can_have_that(term, values, is_doubtful):
    base = recalibrate(LineModel(LINE))
    found = replace(base, point=base.point.plus(term, values))
    estimates = [Estimate(p.name, p.unit, v, v - 1e-3, v + 1e-3) for p, v in zip(term.parameters, values)]
    assert bool(unidentified(term, found, estimates)) is is_doubtful


def test_an_interval_that_holds_zero_or_all_that_the_bounds_allow_identifies_nothing():
    base = recalibrate(LineModel(LINE))
    found = replace(base, point=base.point.plus(WIRE, (1.0, 0.01)))
    reach = Estimate("reach", "m", 0.01, 0.008, 0.012)
    (told,) = unidentified(WIRE, found, (Estimate("a", "N/m", 1.0, -0.5, 2.5), reach))
    assert told.startswith("a = 1.00 N/m (-0.50 to 2.50): the interval holds 0")
    (told,) = unidentified(WIRE, found, (Estimate("a", "N/m", 5.0, 0.5, 9.9), reach))
    assert told.endswith("the interval is as wide as the bounds")
    assert unidentified(WIRE, found, (Estimate("a", "N/m", 1.0, 0.8, 1.2), reach)) == ()


def _generic(name: str, gain: float) -> Score:
    term = Term(f"unnamed_{name}", "coil[1,1]", "thermal", WIRE.parameters, is_named=False)
    return Score(term, (0.1, 0.01), gain, 1.0)


LEFT_OUT = [_generic("heat_square_time", 50.0), _generic("heat_linear_time", 40.0), _generic("shift_linear_rate", 30.0)]


def test_where_structure_is_left_one_generic_law_of_every_equation_is_tried():
    model = LineModel(LINE + 0.5 * np.sin(25 * TIME))
    found = _unnamed_equations([Score(LID, (1.0, 0.7), 60.0, 1.0), *LEFT_OUT], recalibrate(model), model)
    assert [s.term.identifier for s in found] == ["unnamed_heat_square_time", "unnamed_shift_linear_rate"]
    many = [_generic(f"equation{n}_linear_time", 9.0 - n) for n in range(2 * EQUATIONS)]
    assert len(_unnamed_equations(many, recalibrate(model), model)) == EQUATIONS


def test_where_noise_is_left_none_is_tried():
    model = LineModel(LINE)
    assert _unnamed_equations(LEFT_OUT, fit(model, Point(np.zeros(2))), model) == []
