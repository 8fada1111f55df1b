"""The public quarter-truck case: the limit of the chassis height at 2 s, known from one monolithic solution."""

import math

import pytest

from benchmarks import quarter_truck
from benchmarks.models import cosim_run, fmpy_loop
from benchmarks.models.build import build
from benchmarks.models.systems import QUARTER_TRUCK

#: Communication steps [s]; their errors are of first order, so three of them give the limit to about 1e-7 m.
STEPS = (1e-3, 5e-4, 2.5e-4)


@pytest.fixture(scope="module", autouse=True)
def _built():
    build()


def test_the_monolithic_solution_is_the_published_height():
    # The case's page gives "about 1.0661": four decimals.
    assert quarter_truck.monolithic() == pytest.approx(1.0661, abs=5e-5)


@pytest.mark.parametrize("method", ["jacobi", "gauss_seidel", "iterated"])
def test_the_chassis_height_tends_to_the_monolithic_solution(method):
    exact = quarter_truck.monolithic()
    heights = [cosim_run.simulate(QUARTER_TRUCK, 2, step, method)[0] for step in STEPS]
    errors = [height - exact for height in heights]
    # The terms left out by two eliminations are of third order: 2e-3 m (step / 10 ms)^2 at most, below 1e-6 m.
    assert quarter_truck.richardson(heights) == pytest.approx(exact, abs=1e-6)
    # First order: the second-order term is 1.6 % of the error at 1 ms and halves with the step.
    assert math.log2(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.03)
    assert math.log2(errors[1] / errors[2]) == pytest.approx(1.0, abs=0.02)


def test_gauss_seidel_gives_the_numbers_of_a_loop_written_by_hand_on_fmpy():
    # Same calls in the same order: only the rounding of time may differ.
    by_hand = fmpy_loop.simulate(QUARTER_TRUCK, 2, 1e-3, "gauss_seidel")
    assert cosim_run.simulate(QUARTER_TRUCK, 2, 1e-3, "gauss_seidel") == pytest.approx(by_hand, abs=1e-12)


def test_fmi_2_and_fmi_3_give_the_same_heights():
    # The same C code behind both interfaces. The FMI 3.0 ground has an event, at a communication point.
    second = cosim_run.simulate(QUARTER_TRUCK, 2, 1e-3)
    assert cosim_run.simulate(QUARTER_TRUCK, 3, 1e-3) == pytest.approx(second, abs=1e-12)
