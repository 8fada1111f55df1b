"""Two masses, cut into a half that gives a force and one that gives a displacement; both halves step exactly."""

import math
from dataclasses import replace

import pytest

from benchmarks import two_mass
from benchmarks.models import cosim_run
from benchmarks.models.build import build
from benchmarks.models.systems import TWO_MASS

#: Communication step [s] of the coarser of two runs.
STEP = 1e-3


@pytest.fixture(scope="module", autouse=True)
def _built():
    build()


def error(method, step):
    """Larger error of the two displacements at 0.8 s [m]."""
    return two_mass.displacement_error(cosim_run.simulate(TWO_MASS, 2, step, method), TWO_MASS.stop)


def energy_error(method, step, stop):
    """Relative error of the energy after `stop` seconds."""
    state = cosim_run.simulate(replace(TWO_MASS, stop=stop), 2, step, method)
    return two_mass.energy(state) / two_mass.energy(two_mass.closed_form(0.0)) - 1


def test_the_closed_form_solves_the_equations_of_motion():
    # Central differences of width 1e-4 s: the third derivative, at most (6 pi)^4 / 2 = 6e4 m/s^4, times 1e-8 s^2 / 12.
    width = 1e-4
    before, now, after = (two_mass.closed_form(0.37 + k * width) for k in (-1, 0, 1))
    for mass, other in ((0, 2), (2, 0)):
        acceleration = (after[mass] - 2 * now[mass] + before[mass]) / width**2
        force = -two_mass.WALL * now[mass] - two_mass.COUPLING * (now[mass] - now[other])
        assert acceleration == pytest.approx(force, abs=1e-4)


@pytest.mark.parametrize(
    ("method", "order"),
    [
        ("jacobi", 1),
        ("gauss_seidel", 1),
        ({"kind": "iterated", "inputs": "end"}, 1),
        ({"kind": "iterated", "inputs": "mean"}, 2),
    ],
)
def test_each_algorithm_converges_to_the_closed_form_with_its_order(method, order):
    # The next term of the error is some per cent of the first at 1 ms.
    assert math.log2(error(method, STEP) / error(method, STEP / 2)) == pytest.approx(order, abs=0.05)


def test_a_held_coupling_feeds_energy_in_and_the_mean_of_both_ends_does_not():
    # Jacobi's and Gauss-Seidel's late forces do work on the masses: the energy rises, half as fast at half the step.
    for method in ("jacobi", "gauss_seidel"):
        coarse, fine = (energy_error(method, step, 0.8) for step in (STEP, STEP / 2))
        assert coarse > 0.01
        assert coarse / fine == pytest.approx(2.0, abs=0.1)
    # With both inputs at the mean of the step's ends the work of the coupling spring cancels; what is left, 6e-14 when
    # this was written, is rounding over 3200 steps and the tolerance of the iteration.
    assert energy_error("iterated", STEP, 3.2) == pytest.approx(0.0, abs=1e-11)
