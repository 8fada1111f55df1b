"""When an effect may be called by its name, and which laws without one are tried before."""

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge.judge import is_limiting_case
from diagnosis.search.fit import fit
from diagnosis.search.grow import EQUATIONS, _unnamed_equations
from diagnosis.search.problem import Point, Term, TermParameter
from diagnosis.search.score import Score
from diagnosis.search.search import recalibrate
from tests.search.line_model import LID, STEP, TIME, LineModel

LINE = 0.3 + 0.5 * TIME
REACH = TermParameter("reach", "m", 0.0, 0.05, (0.003,))
WIRE = Term("wire", "all", "mechanical", (TermParameter("a", "N/m", 0.0, 10.0, (1.0,)), REACH))


@pytest.mark.parametrize(
    ("term", "values", "is_limiting"),
    [
        (LID, (1.0, 0.7), False), (LID, (1.0, 50.0), True), (LID, (1.0, -50.0), True),
        (STEP, (0.4, 1.0), False),  # an instant may lie anywhere
        (STEP, (10.0, 0.5), False),  # a strength at its bound is only strong
        (WIRE, (1.0, 0.0), False),  # nothing of a part of the law
        (WIRE, (1.0, 0.05), True),
    ],
)  # fmt: skip
def test_a_law_at_a_bound_of_its_shape_is_another_law(term, values, is_limiting):
    base = recalibrate(LineModel(LINE))
    assert is_limiting_case(replace(base, point=base.point.plus(term, values)), term) is is_limiting


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
