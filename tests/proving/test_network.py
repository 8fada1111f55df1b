"""The proving ground's network against closed forms."""

import numpy as np
import pytest

from evaluation.proving.network import OPEN, Branches, solve


def network(coil, strings, **others):
    first = np.concatenate([[0], np.cumsum(strings)[:-1]])
    zero = np.zeros(len(strings))
    given = {"lead": zero.copy(), "drop": zero.copy(), "leak": zero.copy()} | others
    return Branches(np.array(coil, dtype=float), first, **given)


def test_strings_in_parallel_carry_what_series_resistance_lets_through():
    coil, into = solve(network([1.0, 2.0, 3.0, 5.0, 5.0], [3, 2], lead=np.array([0.0, 2.0])), 6.0)
    # By hand: 6 V / 6 ohm and 6 V / 12 ohm; exact but for rounding.
    assert into == pytest.approx([1.0, 0.5], rel=1e-14)
    assert coil == pytest.approx([1.0, 1.0, 1.0, 0.5, 0.5], rel=1e-14)


def test_source_resistance_divides_the_voltage():
    _, into = solve(network([6.0, 3.0], [1, 1], source=2.0), 8.0)
    # 6 || 3 = 2 ohm behind 2 ohm: half of the 8 V is left.
    assert into == pytest.approx([4.0 / 6.0, 4.0 / 3.0], rel=1e-14)


def test_current_limit_holds_the_total_and_keeps_the_shares():
    _, into = solve(network([6.0, 3.0], [1, 1], limit=0.9), 8.0)
    assert into == pytest.approx([0.3, 0.6], rel=1e-14)


def test_constant_drop_is_a_counter_voltage_and_blocks_below_it():
    drop = np.array([0.7, 0.0])
    assert solve(network([2.0, 2.0], [1, 1], drop=drop), 3.7)[1] == pytest.approx([1.5, 1.85], rel=1e-14)
    assert solve(network([2.0, 2.0], [1, 1], drop=drop), 0.5)[1] == pytest.approx([0.0, 0.25], abs=1e-15)


def test_a_drop_that_source_resistance_brings_below_the_threshold_blocks():
    # The open string lowers the bus to 1 V * 1/(1 + 9) = 0.1 V, below the 0.5 V that the other needs.
    _, into = solve(network([1.0, 1.0], [1, 1], drop=np.array([0.5, 0.0]), source=9.0), 1.0)
    assert into == pytest.approx([0.0, 0.1], rel=1e-14)


def test_open_coil_stops_its_string_alone():
    _, into = solve(network([OPEN, 2.0, 2.0, 2.0], [2, 2]), 4.0)
    assert into[0] < 1e-11
    assert into[1] == pytest.approx(1.0, rel=1e-14)


def test_leak_agrees_with_a_nodal_solution():
    rng = np.random.default_rng(4)
    coil, leak, source = rng.uniform(1.0, 3.0, 8), np.array([0.05, 0.0]), 0.4
    current, _ = solve(network(coil, [4, 4], leak=leak, source=source, lead=np.array([0.2, 0.1])), 5.0)
    # Nodes: bus, then after lead and after each coil but the last of both strings; conductances by hand.
    size = 1 + 2 * 4
    matrix, right = np.zeros((size, size)), np.zeros(size)
    matrix[0, 0], right[0] = 1.0 / source, 5.0 / source

    def connect(a, b, resistance):
        matrix[a, a] += 1.0 / resistance
        if b is not None:
            matrix[b, b] += 1.0 / resistance
            matrix[a, b] -= 1.0 / resistance
            matrix[b, a] -= 1.0 / resistance

    for string, lead in enumerate((0.2, 0.1)):
        nodes = [1 + 4 * string + n for n in range(4)]
        connect(0, nodes[0], lead)
        for n in range(4):
            connect(nodes[n], nodes[n + 1] if n < 3 else None, coil[4 * string + n])
        matrix[nodes[2], nodes[2]] += leak[string]  # two coils above, two below
    voltage = np.linalg.solve(matrix, right)
    ends = np.concatenate([np.append(voltage[1 + 4 * s : 5 + 4 * s], 0.0) for s in range(2)]).reshape(2, 5)
    assert current == pytest.approx((-np.diff(ends, axis=1)).ravel() / coil, rel=1e-12)
