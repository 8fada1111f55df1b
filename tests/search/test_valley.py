"""A law whose numbers show as a product of powers: a fit goes down its bent ridge."""

import numpy as np
import pytest

from diagnosis.search.fit import fit
from diagnosis.search.problem import Layout, Parameter, Point, Term, TermParameter
from diagnosis.search.ridge import FACTORS, along, along_ridge

STICTION = Term(
    "stiction",
    "arm",
    "mechanical",
    (
        TermParameter("torque", "N*m", 0.0, 100.0, (1.0,)),
        TermParameter("speed", "rad/s", 1e-3, 100.0, (1.0,)),
    ),
)
TRUE = (6.0, 0.4)


class Loss:
    """Shows torque * speed^2 well and the speed hardly; the parameter of the model is beside the matter."""

    parameters = (Parameter("length", "m", 1.0, 0.1),)
    layout = Layout(np.zeros(3), np.arange(3.0), ("loss",), ("mechanical",))

    def residuals(self, points):
        found = []
        for point in points:
            torque, speed = point.terms.get(STICTION, (0.0, 1.0))
            product = torque * speed**2 / (TRUE[0] * TRUE[1] ** 2)
            found.append([300.0 * (product - 1.0), 4.0 * np.log(speed / TRUE[1]), point.base[0] - 0.5])
        return np.array(found)

    def base_jacobian(self, point):
        return np.array([[0.0], [0.0], [1.0]])


def stuck():
    """A fit that stopped after few steps, far along the ridge."""
    return fit(Loss(), Point(np.array([0.2]), {STICTION: (0.96, 1.0)}), iterations=1)


def test_a_fit_that_stopped_half_way_is_led_to_the_bottom():
    before = stuck()
    found = along_ridge(Loss(), before)
    assert before.cost > 5.0
    assert found.point.terms[STICTION] == pytest.approx(TRUE, rel=1e-3)


def test_the_points_keep_the_product_that_the_data_show():
    before = stuck()
    torque, speed = before.point.terms[STICTION]
    points = along(before)
    speeds = np.array([p.terms[STICTION][1] for p in points])
    np.testing.assert_allclose(speeds, speed * np.array(FACTORS))
    products = np.array([p.terms[STICTION][0] * p.terms[STICTION][1] ** 2 for p in points])
    np.testing.assert_allclose(products, torque * speed**2, rtol=0.05)  # a straight line would be 100 % off


def test_a_fit_at_the_bottom_stays_there():
    model = Loss()
    found = fit(model, Point(np.zeros(1), {STICTION: TRUE}))
    assert along_ridge(model, found).cost == pytest.approx(found.cost, abs=1e-9)
