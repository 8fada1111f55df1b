"""Quantities given over time."""

import numpy as np
import pytest

from cosim.assemble import assemble
from cosim.programme import Course, ProgrammeUnit
from cosim.scenario import load_scenario, parse_scenario

from .short_runs import shortened

SECOND = 1_000_000_000
TEXT = """
title: A ramp and steps
time: {start: -1 s, stop: 4 s, macro_step: 500 ms, output_step: 500 ms, checkpoint_step: 1 s}
components:
  given:
    kind: programme
    outputs:
      ramp: {unit: V, interpolation: linear, points: [[0 s, 0 V], [1 s, 2 V], [3 s, 1000 mV]]}
      steps: {unit: K, points: [[0 s, 20 degC], [1.5 s, 30 degC]]}
      pair: {unit: V, dim: string, interpolation: linear, points: [[0 s, [0 V, 4 V]], [2 s, [2 V, 0 V]]]}
      fixed: {unit: mm, constant: 1 cm}
connections: []
"""


@pytest.fixture
def given(tmp_path):
    assembly = assemble(parse_scenario(TEXT, tmp_path / "ramp.yaml"))
    unit = assembly.system.units["given"]
    unit.initialise(-SECOND)
    return unit


def over(unit, name, begin, end, size):
    """Value of every step of `size` from `begin` to `end` [ns]."""
    values = []
    for time in range(begin, end, size):
        outcome = unit.do_step(time, size)
        assert outcome.time == time + size
        values.append(np.array(unit.get(name)).tolist())
    return values


def test_before_the_first_point_its_value_holds_and_after_the_last_one_too(given):
    assert float(given.get("ramp")) == 0.0
    assert float(given.get("steps")) == 293.15
    assert over(given, "ramp", -SECOND, 0, SECOND // 2) == [0.0, 0.0]
    assert over(given, "ramp", 3 * SECOND, 5 * SECOND, SECOND) == [1.0, 1.0]
    assert over(given, "steps", 3 * SECOND, 5 * SECOND, SECOND) == [303.15, 303.15]


def test_a_step_takes_effect_in_the_macro_step_that_begins_with_it(given):
    assert over(given, "steps", SECOND, 2 * SECOND, SECOND // 2) == [293.15, 303.15]
    assert over(given, "steps", SECOND, 2 * SECOND, SECOND // 4) == [293.15, 293.15, 303.15, 303.15]


@pytest.mark.parametrize("size", [SECOND // 2, SECOND // 4, SECOND // 10])
def test_the_integral_of_a_ramp_is_exact_for_every_step_size(given, size):
    total = sum(over(given, "ramp", 0, 3 * SECOND, size)) * size / SECOND
    # 1 V s up to 2 V, then 3 V s down to 1 V; only rounding remains.
    assert total == pytest.approx(1.0 + 3.0, abs=1e-12)


def test_every_element_of_a_list_has_its_own_course(given):
    assert over(given, "pair", 0, 2 * SECOND, SECOND) == [[0.5, 3.0], [1.5, 1.0]]
    assert given.variables["pair"].dims == ("string",)


def test_the_value_is_in_the_unit_of_the_output(given):
    assert float(given.get("fixed")) == 10.0
    assert given.variables["fixed"].unit == "mm"


def test_a_single_point_is_a_constant():
    course = Course((0,), np.array([3.0]), "V", None, True)
    unit = ProgrammeUnit("given", {"voltage": course})
    unit.initialise(-5)
    assert [float(unit.get("voltage")), *over(unit, "voltage", 0, 40, 10)] == [3.0] * 5


def test_a_ramp_is_that_of_numpy_to_the_last_bit():
    """The loop in C has the same formula: both loops must agree in every bit."""
    random = np.random.default_rng(3)
    times = np.cumsum(random.integers(1, 10**10, 40)) - 10**11
    values = random.normal(size=(40, 3)) * 10.0 ** random.integers(-9, 9, (40, 3))
    wide = Course(tuple(times.tolist()), values, "V", "string", True)
    narrow = Course(wide.times, values[:, 0].copy(), "V", None, True)
    moments = [*random.uniform(times[0] - 1e9, times[-1] + 1e9, 200), *times.astype(float)]
    for moment in moments:
        expected = [np.interp(moment, times.astype(float), column) for column in values.T]
        assert np.asarray(wide.at(moment)).tolist() == expected
        assert narrow.at(moment) == expected[0]


def test_a_resumed_programme_holds_what_it_held(given):
    over(given, "ramp", 0, SECOND // 2, SECOND // 2)
    fresh = ProgrammeUnit("given", given.courses)
    fresh.resume(given.checkpoint(), SECOND // 2)
    for name in given.variables:
        assert np.array_equal(fresh.get(name), given.get(name))


def test_the_power_of_the_prototype_goes_on_and_off_when_the_paper_says():
    scenario = load_scenario("prototype_cantilever")
    course = scenario.components["supply"].outputs["voltage"]
    assert [(str(t), str(v)) for t, v in course.points] == [("-4 s", "0 V"), ("0.37 s", "6 V"), ("12.6 s", "0 V")]


def test_the_bath_climbs_to_70_degrees_and_back_in_steps_of_two():
    points = load_scenario("water_bath").components["bath"].outputs["temperature"].points
    held = [v.to("degC") for (t, v), (_, before) in zip(points[1:], points, strict=False) if v == before]
    assert held == [*range(30, 71, 2), *range(68, 29, -2)]


def test_shortening_keeps_the_points_before_the_end():
    scenario = shortened("water_bath", "300 s", checkpoint_step="100 s")
    assert scenario.components["bath"].outputs["temperature"].points[-1][0].to("s") == 300.0
