"""Direct feedthrough: outputs follow in order, and algebraic loops are found before the run and solved."""

import itertools
import math

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cosim.algorithms import gauss_seidel, jacobi
from cosim.connection import Connection
from cosim.ordering import in_order
from cosim.system import System
from cosim.unit.protocol import Causality, UnitError, Variable, VariableType

from .scripted import Map, Relaxation


def chained(*functions, start=0.0, closed=False):
    """Maps in a row, each fed by the one before; listed backwards, so that the order must be found."""
    names = [f"m{i}" for i in range(len(functions))]
    units = {n: Map(n, f, start) for n, f in reversed(list(zip(names, functions)))}
    ends = list(itertools.pairwise(names)) + ([(names[-1], names[0])] if closed else [])
    return System(units, [Connection((a, "output"), (b, "input")) for a, b in ends])


def outputs(system):
    return {n: float(u.get("output")) for n, u in system.units.items()}


def test_a_chain_of_feedthrough_is_followed_in_its_order_whatever_the_order_of_units():
    system = chained(lambda u: u + 1, lambda u: 2 * u, lambda u: u**2, start=3.0)
    system.initialise(0, {})
    assert outputs(system) == {"m0": 4.0, "m1": 8.0, "m2": 64.0}
    assert not system.loops
    system.units["m0"].set("input", np.array(0.0))
    system.units["m0"].refresh()
    before = [u.refreshed for u in system.units.values()]
    system.propagate()
    assert outputs(system) == {"m0": 1.0, "m1": 2.0, "m2": 4.0}
    # Each of the two units that are fed is asked once, none twice.
    assert sum(u.refreshed for u in system.units.values()) - sum(before) == 2


@pytest.mark.parametrize("algorithm", [jacobi.step, gauss_seidel.step])
def test_a_state_seen_through_a_chain_of_maps_arrives_without_delay(algorithm):
    """x' = -x through two gains of 0.5 and -4 (u = -2 x, x' = u - x = -3 x); Jacobi alone delays each gain a step."""
    units = {"b": Map("b", lambda u: -4 * u), "a": Map("a", lambda u: 0.5 * u), "x": Relaxation("x", 1.0, 1.0, 0.0)}
    links = [(("x", "state"), ("a", "input")), (("a", "output"), ("b", "input")), (("b", "output"), ("x", "input"))]
    system = System(units, [Connection(*link) for link in links])
    system.initialise(0, {})
    size = 1_000_000
    for index in range(1000):
        algorithm(system, index * size, size)
    system.propagate()
    # First order with the constant of one held input: |error| < 3 h; two more steps of delay would triple it.
    assert float(units["x"].get("state")) == pytest.approx(math.exp(-3.0), abs=0.5e-3)
    assert outputs_of(units) == pytest.approx(-2 * float(units["x"].get("state")), abs=1e-15)


def outputs_of(units):
    return float(units["b"].get("output"))


def test_a_linear_loop_is_found_before_the_run_and_solved():
    system = chained(lambda u: 3 - 2 * u, lambda u: 4 * u + 1, closed=True)  # y = 3 - 2 (4 y + 1): y = 1/9
    assert [loop.size for loop in system.loops] == [2]
    assert "m0.output -> m1.input" in str(system.loops[0])
    system.initialise(0, {})
    assert outputs(system) == pytest.approx({"m0": 1 / 9, "m1": 4 / 9 + 1}, abs=1e-9)


def test_a_loop_that_expands_under_repetition_is_solved_all_the_same():
    system = chained(lambda u: np.exp(-u), lambda u: 5 * u, closed=True)  # y = exp(-5 y), slope -5 y = -1.3 at the root
    system.initialise(0, {})
    y = outputs(system)["m0"]
    assert y == pytest.approx(math.exp(-5 * y), abs=1e-10)
    assert y == pytest.approx(0.2653448, abs=1e-6)  # W(5) / 5


def test_a_loop_of_many_unknowns_is_solved_without_a_jacobian():
    count = 200
    weights = np.linspace(-3.0, -0.5, count)
    units = {
        "a": Map("a", lambda u: weights * u + 1.0, shape=(count,)),
        "b": Map("b", lambda u: 1.5 * u, shape=(count,)),
    }
    system = System(units, [Connection(("a", "output"), ("b", "input")), Connection(("b", "output"), ("a", "input"))])
    system.initialise(0, {})
    assert units["a"].get("output") == pytest.approx(1.0 / (1.0 - 1.5 * weights), abs=1e-8)


def test_a_ring_of_arrays_that_is_none_element_by_element_needs_no_solver():
    """Each element depends on its left neighbour only: repetition settles it."""
    shift = np.array([[0.0, 0.0], [1.0, 0.0]])
    first = np.array([1.0, 0.0])
    units = {"a": Map("a", lambda u: shift @ u + first, shape=(2,)), "b": Map("b", lambda u: u, shape=(2,))}
    system = System(units, [Connection(("a", "output"), ("b", "input")), Connection(("b", "output"), ("a", "input"))])
    system.initialise(0, {})
    assert units["a"].get("output").tolist() == [1.0, 1.0]
    assert units["a"].refreshed < 8


def test_a_loop_without_a_solution_is_reported_with_its_connections():
    system = chained(lambda u: u + 1.0, lambda u: u, closed=True)
    with pytest.raises(UnitError, match=r"algebraic loop .*m1\.output -> m0\.input.*no solution was found"):
        system.initialise(0, {})


def test_a_loop_of_switches_settles():
    units = {n: Map(n, lambda u: u) for n in "ab"}
    for unit in units.values():
        unit.variables = {
            n: Variable(n, v.causality, (), "1", start=v.start, type=VariableType.BOOLEAN)
            for n, v in unit.variables.items()
        }
    links = [Connection((a, "output"), (b, "input")) for a, b in (("a", "b"), ("b", "a"))]
    system = System(units, links)
    assert str(system.loops[0]).startswith("ring of discrete values ")
    system.initialise(0, {})
    assert units["a"].get("output") == units["b"].get("output")


def test_the_loop_follows_its_drive_during_the_run():
    """y = 1 - 3 y + x, with x' = -x: y = (1 + x) / 4 at every communication point."""

    class Sum(Map):
        def __init__(self) -> None:
            super().__init__("s", lambda u: u)
            self.variables["drive"] = Variable("drive", Causality.INPUT, (), "1", start=0.0)
            self._store.arrays["drive"] = np.array(0.0)
            self.feedthrough = self.initial_feedthrough = {"output": frozenset({"input", "drive"})}

        def refresh(self) -> None:
            self._store.arrays["output"][...] = 1 - 3 * self.get("input") + self.get("drive")

    units = {"s": Sum(), "same": Map("same", lambda u: u), "x": Relaxation("x", 1.0, 1.0, 0.0)}
    links = [
        (("s", "output"), ("same", "input")),
        (("same", "output"), ("s", "input")),
        (("x", "state"), ("s", "drive")),
    ]
    system = System(units, [Connection(*link) for link in links])
    system.initialise(0, {})
    for index in range(10):
        jacobi.step(system, index * 100_000_000, 100_000_000)
        system.propagate()
        expected = (1 + math.exp(-0.1 * (index + 1))) / 4
        assert float(units["s"].get("output")) == pytest.approx(expected, abs=1e-9)


class Late(Map):
    """A second output changes when the input has been set, though it is not declared to: an event."""

    def __init__(self, name) -> None:
        super().__init__(name, lambda u: 2 * u)
        self.variables["event"] = Variable("event", Causality.OUTPUT, (), "1")
        self._store.arrays["event"] = np.array(0.0)

    def refresh(self) -> None:
        super().refresh()
        self._store.arrays["event"][...] = self.get("input") < 0.75


class Counting(Map):
    """Shows its input at once, and adds it up over the steps."""

    def __init__(self, name) -> None:
        super().__init__(name, lambda u: u)
        self.variables["sum"] = Variable("sum", Causality.OUTPUT, (), "1")
        self._store.arrays["sum"] = np.array(0.0)

    def do_step(self, time, size):
        self._store.arrays["sum"] += self.get("input")
        return super().do_step(time, size)


def with_event():
    """x' = u - x, u = event of a unit that sees x; whoever reads the event first reads it too early."""
    units = {"early": Counting("early"), "late": Late("late"), "x": Relaxation("x", 1.0, 1.0, 0.0)}
    links = [("late", "event", "early"), ("x", "state", "late"), ("early", "output", "x")]
    return System(units, [Connection((a, b), (c, "input")) for a, b, c in links])


def everything_exchanged(system, time, size):
    """Jacobi without a shortcut."""
    system.sample_sources(time, size)
    system.propagate()
    for name in system.movers:
        system.exchange(name)
    return system.step_together(system.movers, time, size)


@pytest.mark.parametrize(
    "make", [lambda: chained(np.cos, np.sin, start=3.0), lambda: chained(np.cos, np.cos, closed=True), with_event]
)
def test_jacobi_leaves_out_only_transfers_that_change_nothing(make):
    one, other = make(), make()
    one.initialise(0, {})
    other.initialise(0, {})
    for index in range(30):
        jacobi.step(one, index * 100_000_000, 100_000_000)
        everything_exchanged(other, index * 100_000_000, 100_000_000)
        for name, unit in one.units.items():
            for variable in unit.variables:
                assert unit.get(variable).tobytes() == other.units[name].get(variable).tobytes(), (name, variable)


def test_in_a_chain_every_input_is_set_once_per_step_and_in_a_loop_again_after_its_solution():
    assert chained(np.cos, np.sin, np.cos).unsettled == []
    assert len(chained(np.cos, np.cos, closed=True).unsettled) == 2
    # What reads the event is carried out before the unit that has it follows its input.
    assert [t.end for t in with_event().unsettled] == [("early", "input"), ("x", "input")]


def test_order_of_rings_and_chains():
    assert in_order(0, []) == []
    assert in_order(3, [(2, 1), (1, 0)]) == [[2], [1], [0]]
    assert sorted(map(sorted, in_order(5, [(0, 1), (1, 0), (1, 2), (3, 4), (4, 3), (4, 0)]))) == [[0, 1], [2], [3, 4]]
    order = in_order(5, [(0, 1), (1, 0), (1, 2), (3, 4), (4, 3), (4, 0)])
    assert [sorted(group) for group in order] == [[3, 4], [0, 1], [2]]


def test_rings_of_any_graph_are_those_that_scipy_finds():
    random = np.random.default_rng(4)
    for _ in range(300):
        count = int(random.integers(1, 12))
        edges = random.integers(0, count, (int(random.integers(0, 2 * count)), 2)).tolist()
        graph = coo_array((np.ones(len(edges)), np.reshape(edges, (-1, 2)).T), shape=(count, count))
        labels = connected_components(graph, directed=True, connection="strong")[1]
        order = in_order(count, [(a, b) for a, b in edges])
        assert {frozenset(g) for g in order} == {frozenset(np.flatnonzero(labels == n).tolist()) for n in set(labels)}
        place = {node: n for n, group in enumerate(order) for node in group}
        assert all(place[a] <= place[b] for a, b in edges)


def test_a_chain_of_thousands_needs_no_deep_recursion():
    assert in_order(5000, [(i, i + 1) for i in range(4999)]) == [[i] for i in range(5000)]
