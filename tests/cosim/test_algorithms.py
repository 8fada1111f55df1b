"""Systems and algorithms on scripted units with exact solutions."""

import itertools
import math

import numpy as np
import pytest

from cosim.algorithms import gauss_seidel, jacobi
from cosim.system import Connection, ConnectionFault, System
from cosim.unit.protocol import Causality, StepOutcome, StepStatus, Unit, UnitError, Variable

from .scripted import Failing, Relaxation, fail

ALGORITHMS = {"jacobi": jacobi.step, "gauss_seidel": gauss_seidel.step}
RATES = (3.0, 2.0)


def two_tanks():
    """x' = 3 (y - x), y' = 2 (x - y); x(0) = 1, y(0) = 0: x = 0.4 + 0.6 exp(-5 t)."""
    units = {"x": Relaxation("x", RATES[0], 1.0, 0.0), "y": Relaxation("y", RATES[1], 0.0)}
    links = [Connection(("x", "state"), ("y", "input")), Connection(("y", "state"), ("x", "input"))]
    system = System(units, links)
    system.initialise(0, {})
    return system


def error_after_one_second(algorithm, steps):
    system, size = two_tanks(), 1_000_000_000 // steps
    for index in range(steps):
        ALGORITHMS[algorithm](system, index * size, size)
    return abs(float(system.value("x", "state")) - (0.4 + 0.6 * math.exp(-5.0)))


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_a_coupled_system_converges_with_first_order(algorithm):
    errors = [error_after_one_second(algorithm, n) for n in (100, 200, 400, 800)]
    orders = [math.log2(a / b) for a, b in itertools.pairwise(errors)]
    # Inputs held over a step are a first-order approximation; the order nears 1 from either side.
    assert orders[-1] == pytest.approx(1.0, abs=0.05)
    assert errors[-1] < 1e-3


def test_gauss_seidel_hands_on_new_outputs_and_jacobi_old_ones():
    after = {}
    for name, step in ALGORITHMS.items():
        system = two_tanks()
        step(system, 0, 100_000_000)
        after[name] = system.units["y"].steps[0][2]
    assert after["jacobi"] == 1.0
    assert after["gauss_seidel"] == pytest.approx(math.exp(-0.3), rel=1e-15)


def test_jacobi_does_not_depend_on_the_order_of_units():
    results = []
    for names in (("x", "y"), ("y", "x")):
        system = two_tanks()
        turned = System({n: system.units[n] for n in names}, system.connections)
        turned.exchange_all()
        for index in range(50):
            jacobi.step(turned, index * 10_000_000, 10_000_000)
        results.append((float(turned.value("x", "state")), float(turned.value("y", "state"))))
    assert results[0] == results[1]


@pytest.mark.parametrize("size", [100_000_000, 333_333_333, 7])
def test_a_hundred_thousand_steps_end_exactly_on_time(size):
    unit = Relaxation("x", 1.0, 1.0, 0.0)
    system = System({"x": unit}, [])
    system.initialise(0, {})
    outcome = None
    for index in range(100_000):
        outcome = gauss_seidel.step(system, index * size, size)
    assert outcome.time == 100_000 * size
    assert unit.steps[-1][0] == 99_999 * size


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("status", [StepStatus.EARLY_RETURN, StepStatus.DISCARDED])
def test_a_step_that_was_not_finished_is_reported(algorithm, status):
    unit = Failing("x", 20, lambda time, size: StepOutcome(status, time + 3, "stopped short"))
    system = System({"x": unit}, [])
    system.initialise(0, {})
    assert ALGORITHMS[algorithm](system, 0, 10).status is StepStatus.OK
    outcome = ALGORITHMS[algorithm](system, 20, 10)
    assert (outcome.status, outcome.time, outcome.message) == (status, 23, "stopped short")


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_a_unit_that_fails_is_not_silenced(algorithm):
    system = System({"x": Failing("x", 0, fail)}, [])
    system.initialise(0, {})
    with pytest.raises(UnitError, match=r"scripted at t = 0 s: it cannot go on \(script it otherwise\)"):
        ALGORITHMS[algorithm](system, 0, 10)


def test_wall_time_of_every_unit_is_measured():
    system = two_tanks()
    for index in range(10):
        gauss_seidel.step(system, index * 10, 10)
    assert set(system.wall_time) == {"x", "y"}
    assert all(value > 0 for value in system.wall_time.values())


def test_units_are_converted_on_the_way():
    units = {"x": Relaxation("x", 1.0, 20.0, 0.0), "y": Relaxation("y", 1.0, 0.0)}
    system = System(units, [Connection(("x", "state"), ("y", "input"), 1.0, 273.15)])
    system.initialise(0, {})
    assert float(units["y"].get("input")) == pytest.approx(293.15, abs=1e-12)


def test_a_scalar_feeds_every_element_of_an_array():
    units = {"x": Relaxation("x", 1.0, 5.0, 0.0), "y": Relaxation("y", 1.0, 0.0, shape=(3,))}
    system = System(units, [Connection(("x", "state"), ("y", "input"))])
    system.initialise(0, {})
    assert units["y"].get("input").tolist() == [5.0, 5.0, 5.0]


@pytest.mark.parametrize(
    ("connections", "what"),
    [
        ([(("x", "state"), ("z", "input"))], "there is no component z; there are: x, y"),
        ([(("x", "level"), ("y", "input"))], "x has no output level; it has: state"),
        ([(("x", "input"), ("y", "input"))], "x has no output input"),
        ([(("x", "state"), ("y", "state"))], "y has no input state"),
        ([(("x", "state"), ("y", "input")), (("y", "state"), ("y", "input"))], "already leads into y.input"),
        ([], "y.input: nothing is connected"),
    ],
)
def test_a_connection_that_does_not_fit_is_refused(connections, what):
    units = {"x": Relaxation("x", 1.0, 1.0, 0.0), "y": Relaxation("y", 1.0, 0.0)}
    with pytest.raises(ConnectionFault, match=what):
        System(units, [Connection(a, b) for a, b in connections])


def test_shapes_must_agree():
    units = {"x": Relaxation("x", 1.0, 1.0, 0.0, shape=(2,)), "y": Relaxation("y", 1.0, 0.0, shape=(3,))}
    with pytest.raises(ConnectionFault, match=r"shape \(2,\) does not fit shape \(3,\)"):
        System(units, [Connection(("x", "state"), ("y", "input"))])


def test_a_loop_without_a_first_value_is_refused_with_the_key_to_give():
    units = {"x": Relaxation("x", 1.0, 1.0), "y": Relaxation("y", 1.0, 0.0)}
    links = [Connection(("x", "state"), ("y", "input")), Connection(("y", "state"), ("x", "input"))]
    system = System(units, links)
    with pytest.raises(ConnectionFault, match=r"components\.x\.start\.input"):
        system.initialise(0, {})
    system.initialise(0, {"x": {"input": 0.25}})
    assert float(units["y"].get("input")) == 1.0


def test_a_variable_needs_one_name_per_dimension():
    with pytest.raises(ValueError, match="dimension names"):
        Variable("power", Causality.INPUT, (3,), "W")


def test_an_input_that_is_not_finite_is_refused_where_it_arrives():
    unit = Relaxation("x", 1.0, 1.0, 0.0, shape=(3,))
    with pytest.raises(UnitError, match=r"x: input input\[3\] is not a finite number"):
        unit.set("input", np.array([0.0, 1.0, np.inf]))
    assert isinstance(unit, Unit)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_a_value_that_is_not_finite_is_caught_on_its_way_and_the_connection_named(algorithm):
    system = two_tanks()
    system.units["x"].get("state")[...] = math.nan
    with pytest.raises(UnitError, match=r"input input.* is not a finite number, through x\.state -> y\.input"):
        ALGORITHMS[algorithm](system, 0, 10)


class Remote(Relaxation):
    """Its step has a begin and an end, and a log tells in which order they came."""

    def __init__(self, name, log, fails=False):
        super().__init__(name, 1.0, 1.0, 0.0)
        self.log, self.fails = log, fails

    def begin_step(self, time, size):
        self.log.append(f"{self.name} begins")
        self._asked = time, size

    def finish_step(self):
        self.log.append(f"{self.name} ends")
        if self.fails:
            raise UnitError(self.name, "it crashed", self._asked[0])
        return super().do_step(*self._asked)


def test_jacobi_lets_units_in_other_processes_step_at_the_same_time():
    log = []
    units = {"a": Remote("a", log), "b": Remote("b", log), "c": Relaxation("c", 1.0, 1.0, 0.0)}
    system = System(units, [])
    system.initialise(0, {})
    assert jacobi.step(system, 0, 1_000_000_000) == StepOutcome(StepStatus.OK, 1_000_000_000)
    assert log == ["a begins", "b begins", "a ends", "b ends"]
    assert {n: float(u.get("state")) for n, u in units.items()} == dict.fromkeys("abc", math.exp(-1.0))


def test_a_step_that_has_begun_is_ended_when_another_unit_fails():
    log = []
    system = System({"a": Remote("a", log, fails=True), "b": Remote("b", log)}, [])
    system.initialise(0, {})
    with pytest.raises(UnitError, match="a at t = 0 s: it crashed"):
        jacobi.step(system, 0, 10)
    assert log == ["a begins", "b begins", "a ends", "b ends"]
