"""Algorithms that repeat steps: iterated, step doubling, events as communication points."""

import itertools
import math

import numpy as np
import pytest

from cosim.algorithms import gauss_seidel, jacobi
from cosim.algorithms.iterated import Iterated, groups
from cosim.algorithms.restoring import CannotRestore
from cosim.algorithms.step_doubling import ErrorControl, StepDoubling
from cosim.algorithms.synchronised import Synchronised
from cosim.connection import Connection
from cosim.system import System
from cosim.unit.protocol import StepOutcome, StepStatus, UnitError

from .scripted import Failing, Ramp, Relaxation
from .test_algorithms import two_tanks

SECOND = 1_000_000_000
EXACT = 0.4 + 0.6 * math.exp(-5.0)


def tank_error(algorithm, system, steps):
    size = SECOND // steps
    for index in range(steps):
        assert algorithm(system, index * size, size) == StepOutcome(StepStatus.OK, (index + 1) * size)
    return abs(float(system.value("x", "state")) - EXACT)


@pytest.mark.parametrize(("is_mean", "order"), [(True, 2.0), (False, 1.0)])
def test_order_of_convergence(is_mean, order):
    errors = []
    for steps in (25, 50, 100, 200):
        system = two_tanks()
        errors.append(tank_error(Iterated(system, 1e-12, 100, is_mean), system, steps))
    orders = [math.log2(a / b) for a, b in itertools.pairwise(errors)]
    # The asymptotic order; the next term of the error makes 5 % at 200 steps.
    assert orders[-1] == pytest.approx(order, abs=0.05)


def test_the_iteration_does_not_depend_on_the_order_of_units_once_it_has_converged():
    results = []
    for names in (("x", "y"), ("y", "x")):
        first = two_tanks()
        system = System({n: first.units[n] for n in names}, first.connections)
        system.exchange_all()
        results.append(tank_error(Iterated(system, 1e-13, 100, True), system, 10))
    assert results[0] == pytest.approx(results[1], abs=1e-11)  # a hundred times the tolerance of the iteration


def test_what_is_outside_the_loop_steps_once_and_need_not_restore():
    system = two_tanks()
    watcher = Relaxation("watcher", 1.0, 0.0, 0.0)
    watcher.can_restore = False
    whole = System(
        {"watcher": watcher, **system.units}, [*system.connections, Connection(("x", "state"), ("watcher", "input"))]
    )
    whole.initialise(0, {})
    assert [(g.names, g.is_loop) for g in groups(whole)] == [(("x", "y"), True), (("watcher",), False)]
    tank_error(Iterated(whole, 1e-12, 100, True), whole, 10)
    assert len(watcher.steps) == 10
    assert len(system.units["x"].steps) > 30


def test_a_unit_in_the_loop_that_cannot_restore_is_named():
    system = two_tanks()
    system.units["y"].can_restore = False
    with pytest.raises(CannotRestore, match=r"iterated .* y \(Relaxation\) cannot return"):
        Iterated(system, 1e-8, 10, True)
    with pytest.raises(CannotRestore, match=r"step_doubling .* y \(Relaxation\)"):
        StepDoubling(system, jacobi.step, ErrorControl(1e-4, 1e-6, 1000), SECOND)
    with pytest.raises(CannotRestore, match=r"synchronise .* y \(Relaxation\)"):
        Synchronised(system, jacobi.step)


def test_a_unit_of_one_step_size_is_refused_where_steps_are_divided():
    system = two_tanks()
    system.units["y"].can_vary_step = False
    with pytest.raises(CannotRestore, match="step_doubling divides macro-steps, but y takes steps of one size only"):
        StepDoubling(system, jacobi.step, ErrorControl(1e-4, 1e-6, 1000), SECOND)
    Iterated(system, 1e-8, 10, True)  # repeats whole steps only


def test_an_iteration_that_does_not_converge_says_which_input_still_changes():
    system = two_tanks()
    stiff = System(
        {"x": Relaxation("x", 1e3, 1.0, 0.0), "y": Relaxation("y", 1e3, 1.0)},
        [Connection(("x", "state"), ("y", "input"), -3.0), Connection(("y", "state"), ("x", "input"), 3.0)],
    )
    stiff.initialise(0, {})
    with pytest.raises(
        UnitError, match=r"the loop x, y does not converge in 20 .*still changes by .*smaller macro_step"
    ):
        Iterated(stiff, 1e-8, 20, False)(stiff, 0, SECOND)
    assert system is not stiff


@pytest.mark.parametrize("inner", [jacobi.step, gauss_seidel.step])
def test_step_doubling_meets_its_tolerance_with_fewer_steps_where_little_happens(inner):
    errors, counts = [], []
    for tolerance in (1e-3, 1e-4, 1e-5):
        system = two_tanks()
        algorithm = StepDoubling(system, inner, ErrorControl(0.0, tolerance, 1000), SECOND)
        for index in range(4):
            algorithm(system, index * SECOND, SECOND)
        exact = 0.4 + 0.6 * math.exp(-20.0)
        errors.append(abs(float(system.value("x", "state")) - exact))
        counts.append(algorithm.accepted)
    # The local error goes with the square of the step, the global one, which nothing damps here, with the step: a
    # tolerance of a tenth costs sqrt(10) times the steps and leaves 1 / sqrt(10) of the error.
    assert counts[2] / counts[1] == pytest.approx(math.sqrt(10), rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(math.sqrt(10), rel=0.15)
    assert errors[2] < 2e-3


def test_steps_grow_when_the_transient_is_over():
    system = two_tanks()
    algorithm = StepDoubling(system, gauss_seidel.step, ErrorControl(0.0, 1e-6, 1000), SECOND)
    counts = []
    for index in range(8):
        before = algorithm.accepted
        algorithm(system, index * SECOND, SECOND)
        counts.append(algorithm.accepted - before)
    assert counts[0] > 100
    assert counts[-1] <= 2


def test_a_step_that_a_unit_discards_is_tried_shorter():
    def refuse_long(time, size):
        if size > 10_000_000:
            return StepOutcome(StepStatus.DISCARDED, time, "too long")
        return Relaxation.do_step(unit, time, size)

    unit = Failing("x", 0, refuse_long)
    system = System({"x": unit}, [])
    system.initialise(0, {})
    algorithm = StepDoubling(system, gauss_seidel.step, ErrorControl(1e-3, 1e-3, 1000), SECOND)
    assert algorithm(system, 0, SECOND).time == SECOND
    assert algorithm.rejected >= 1
    assert float(unit.get("state")) == pytest.approx(math.exp(-1.0), rel=1e-12)  # exact for a constant input


def test_a_tolerance_that_no_step_meets_is_reported():
    system = two_tanks()
    algorithm = StepDoubling(system, gauss_seidel.step, ErrorControl(0.0, 1e-12, 10_000_000), SECOND)
    with pytest.raises(UnitError, match=r"error of a step of .* times the tolerance, and minimum_step allows none"):
        algorithm(system, 0, SECOND)


@pytest.mark.parametrize("inner", [jacobi.step, gauss_seidel.step])
def test_an_event_becomes_a_communication_point_of_all_units(inner):
    event = 333_333_333
    units = {"ramp": Ramp("ramp", 1.0, -1.0, event), "x": Relaxation("x", 1.0, 0.0, 0.0)}
    system = System(units, [Connection(("ramp", "state"), ("x", "input"))])
    system.initialise(0, {})
    outcome = Synchronised(system, inner)(system, 0, SECOND)
    assert outcome == StepOutcome(StepStatus.OK, SECOND)
    assert float(units["ramp"].get("state")) == pytest.approx(event * 1e-9 - (SECOND - event) * 1e-9, abs=1e-15)
    assert [(t, s) for t, s, _ in units["x"].steps][-2:] == [(0, event), (event, SECOND - event)]


def test_an_event_that_stands_still_is_no_endless_loop():
    stuck = Failing("stuck", 0, lambda time, size: StepOutcome(StepStatus.EARLY_RETURN, time, "stuck returned early"))
    system = System({"stuck": stuck}, [])
    system.initialise(0, {})
    with pytest.raises(UnitError, match="stuck returned early without having moved"):
        Synchronised(system, jacobi.step)(system, 0, 10)


def test_a_repeated_step_leaves_no_trace_in_what_follows():
    """A refused step and its repetition give the same bits as the step made at once."""
    system = two_tanks()
    saved = system.save()
    jacobi.step(system, 0, SECOND)
    once = {n: system.value(n, "state") for n in "xy"}
    for _ in range(3):
        system.restore(saved, 0)
        jacobi.step(system, 0, SECOND)
        assert all(np.array_equal(system.value(n, "state"), once[n]) for n in "xy")
    system.release(saved)
