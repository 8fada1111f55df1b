"""The loop of the proving ground: the paper's branches outside, a history of its own inside."""

from dataclasses import replace

import numpy as np
import pytest

from evaluation.proving.hysteresis import CELSIUS, Loop, lower, upper
from evaluation.proving.rig import DataSheet, ideal_rig

RIG = ideal_rig(DataSheet(strings=(1,)))


def along(loop, temperatures):
    return np.array([loop.accept(np.full((1, 1), t))[0, 0] for t in temperatures])


def loop_of(rig, **others):
    return Loop(rig, 1, np.full(1, 20.0 + CELSIUS), **others)


@pytest.mark.parametrize("duhem", [0.0, 0.5, 1.0])
def test_full_loop_is_the_papers(duhem):
    loop = loop_of(RIG, duhem=np.full(1, duhem))
    up, down = np.linspace(20.0, 110.0, 200), np.linspace(110.0, -20.0, 200)
    assert along(loop, up) == pytest.approx(lower(up), abs=1e-6)
    # Duhem's form starts the way down from where heating ended, 1e-4 N/m below full austenite.
    assert along(loop, down) == pytest.approx(upper(down), abs=0.02)


def test_scatter_within_the_wire_changes_the_full_loop_by_little():
    rig = replace(RIG, spread=0.6)
    up, down = np.linspace(20.0, 110.0, 200), np.linspace(110.0, 0.0, 200)
    loop = loop_of(rig)
    # Curvature of the branch (at most 1.7 N/m/K^2) times half the variance, 0.18 K^2. Where the loop is narrower than
    # the scatter, near its hot end, the narrow plays close early: 1 % of the rise.
    assert np.abs(along(loop, up) - lower(up)).max() < 0.5
    assert np.abs(along(loop, down) - upper(down)).max() < 2.5


def test_without_duhem_a_turn_inside_the_loop_holds_the_stiffness():
    loop = loop_of(RIG)
    top = along(loop, [60.0])[0]
    held = along(loop, np.linspace(60.0, 50.0, 11))
    assert upper(np.array(50.0)) > top  # still inside the loop
    assert held == pytest.approx(np.full(11, top), rel=1e-12)


def test_with_duhem_a_turn_moves_the_stiffness_at_once_and_by_the_same_in_any_steps():
    turned = []
    for steps in (2, 50):
        loop = loop_of(RIG, duhem=np.ones(1))
        along(loop, [60.0])
        turned.append(along(loop, np.linspace(60.0, 45.0, steps))[-1])
    top = lower(np.array(60.0))
    assert turned[0] == pytest.approx(turned[1], rel=1e-12)  # closed form
    assert turned[0] < top - 10.0
    assert turned[0] > lower(np.array(45.0))


def test_looking_ahead_leaves_no_mark():
    loop = loop_of(replace(RIG, spread=0.5, duhem=0.3))
    along(loop, [55.0])
    ahead = loop.stiffness(np.full((1, 1), 65.0))
    loop.stiffness(np.full((1, 1), 20.0))
    assert loop.accept(np.full((1, 1), 65.0)) == pytest.approx(ahead, rel=1e-14)
