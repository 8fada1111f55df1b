"""Clocks of a Co-Simulation FMU with Event Mode."""

from __future__ import annotations

import numpy as np

from cosim.unit.protocol import NANOSECONDS

STEP = NANOSECONDS // 10


def test_a_periodic_clock_ticks_at_multiples_of_its_interval(started):
    unit = started("clocks", 3)
    seen = []
    for index in range(14):
        unit.do_step(index * STEP, STEP)
        seen.append(int(unit.get("periodic_ticks")))
    # It ticks at 0.1, 0.4, 0.7, 1.0, 1.3 s, which are ends of steps: what ticks there is seen there.
    assert seen == [1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5]
    assert unit.get("when") == 0.1 + 4 * 0.3


def test_a_countdown_clock_ticks_once_after_its_interval(started):
    unit = started("clocks", 3)
    for index in range(14):
        unit.do_step(index * STEP, STEP)
    assert unit.get("countdown_ticks") == 1
    assert abs(unit.get("when_countdown") - 0.65) < 1e-12  # wound up at 0.4 s by 0.25 s


def test_an_output_clock_is_true_in_the_step_in_which_it_ticks(started):
    unit = started("clocks", 3)
    ticks = []
    for index in range(14):
        unit.do_step(index * STEP, STEP)
        ticks.append(bool(unit.get("every_second")))
    assert [i for i, tick in enumerate(ticks) if tick] == [3, 9]


def test_a_triggered_clock_samples_its_input(started):
    unit = started("clocks", 3)
    for index in range(6):
        unit.set("sample", np.array(float(index)))
        unit.set("triggered", np.array(index in (2, 5)))
        unit.do_step(index * STEP, STEP)
    assert unit.get("triggered_ticks") == 2
    assert unit.get("sampled") == 5.0
