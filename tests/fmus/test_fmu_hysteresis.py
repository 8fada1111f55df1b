"""The play operator between the two branches of equation (2), driven through arbitrary temperature histories."""

import numpy as np
import pytest
from fmu_runs import advance
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from thermal_twin import CELSIUS, CROSSING, STEEPEST, bounds, cooling, follow, heating

#: In so long a step [ns] a coil without power takes the temperature of its bath to the last digit: exp(-140) is left.
SOAK = 1000 * 10**9
#: Rounding of a temperature of 300 K, 6e-14, times the steepest slope, and of k itself.
ROUNDING = 1e-11  # [N/m]

celsius = st.floats(-20.0, 120.0)
below_crossing = st.floats(-20.0, 69.0)
histories = st.lists(celsius, min_size=2, max_size=15)
#: The FMU is rewound to its start before every example.
replayed = settings(deadline=None, max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])


class Bath:
    """A coil in a bath: sets its temperature [degC], answers its stiffness [N/m]."""

    def __init__(self, unit):
        self.unit, self.time = unit, 0
        unit.initialise(0)
        unit.exit_initialisation()
        self.start = unit.save()

    def rewind(self):
        self.time = 0
        self.unit.restore(self.start, 0)
        return self

    def to(self, temperature):
        self.unit.set("ambient_temperature", temperature + CELSIUS)
        self.unit.do_step(self.time, SOAK)
        self.time += SOAK
        assert abs(self.unit.get("temperature")[0] - CELSIUS - temperature) < 1e-12
        return float(self.unit.get("stiffness")[0])


@pytest.fixture(scope="module")
def bath(make_unit):
    bath = Bath(make_unit(coils=1))
    yield bath
    bath.unit.release(bath.start)


def test_the_branches_cross_once_and_the_heating_branch_lies_lower_before():
    grid = np.linspace(-CELSIUS, 300.0, 200_001)
    gap = cooling(grid) - heating(grid)
    assert (gap[grid < CROSSING] > 0.0).all()
    assert (gap[grid > CROSSING + 1e-9] < 0.0).all()
    assert round(CROSSING, 4) == 69.7246


@replayed
@given(histories)
def test_stiffness_never_jumps(bath, history):
    bath.rewind()
    temperatures = [22.0, *history]
    stiffness = [bath.to(t) for t in temperatures]
    change, distance = np.abs(np.diff(stiffness)), np.abs(np.diff(temperatures))
    assert (change <= STEEPEST * distance + ROUNDING).all()


@replayed
@given(histories)
def test_stiffness_never_leaves_the_branches(bath, history):
    bath.rewind()
    for temperature in history:
        low, high = bounds(temperature)
        assert low - ROUNDING <= bath.to(temperature) <= high + ROUNDING


@replayed
@given(histories)
def test_stiffness_equals_that_of_a_twin_that_takes_small_steps(bath, history):
    bath.rewind()
    before, memory = 22.0, heating(22.0)
    for temperature in history:
        memory = follow(np.linspace(before, temperature, 200), memory)
        assert bath.to(temperature) == pytest.approx(float(memory), abs=ROUNDING)
        before = temperature


@replayed
@given(below_crossing, below_crossing, below_crossing, st.integers(2, 5))
def test_minor_loops_close(bath, begin, first, second, cycles):
    bath.rewind().to(begin)
    bath.to(first)
    loops = [(bath.to(second), bath.to(first)) for _ in range(cycles)]
    assert all(loop == pytest.approx(loops[0], abs=ROUNDING) for loop in loops)


@replayed
@given(celsius, celsius, st.floats(0.0, 1.0))
def test_an_excursion_within_the_last_stroke_leaves_no_mark(bath, begin, turn, share):
    """Return-point memory: back at the turning point, the stiffness is what it was there."""
    bath.rewind().to(begin)
    at_turn = bath.to(turn)
    bath.to(turn + share * (begin - turn))
    assert bath.to(turn) == pytest.approx(at_turn, abs=ROUNDING)


def test_a_full_cycle_runs_along_the_published_branches(bath):
    bath.rewind()
    rising, falling = np.arange(22.0, 101.0, 2.0), np.arange(100.0, 21.0, -2.0)
    np.testing.assert_allclose([bath.to(t) for t in rising], heating(rising), atol=ROUNDING)
    above = falling >= CROSSING
    expected = np.where(above, heating(falling), cooling(falling))
    np.testing.assert_allclose([bath.to(t) for t in falling], expected, atol=ROUNDING)


def test_the_loop_is_wide_in_the_middle(bath):
    bath.rewind()
    up, hot, down = bath.to(50.0), bath.to(90.0), bath.to(50.0)
    assert (round(up, 1), round(down, 1)) == (160.8, 305.6)
    assert hot == pytest.approx(float(heating(90.0)), abs=ROUNDING)


def test_stiffness_stays_while_the_temperature_turns_between_the_branches(bath):
    bath.rewind().to(60.0)
    assert bath.to(58.0) == pytest.approx(float(heating(60.0)), abs=ROUNDING)
    assert bath.to(59.9) == pytest.approx(float(heating(60.0)), abs=ROUNDING)
    assert bath.to(45.0) == pytest.approx(float(cooling(45.0)), abs=ROUNDING)


@pytest.mark.parametrize("distance", [1e-3, 1e-6, 1e-9])
def test_stiffness_is_continuous_across_the_crossing(bath, distance):
    bath.rewind()
    below, above = bath.to(CROSSING - distance), bath.to(CROSSING + distance)
    again = bath.to(CROSSING - distance)
    assert abs(above - below) <= 2.0 * STEEPEST * distance + ROUNDING
    assert abs(again - above) <= 2.0 * STEEPEST * distance + ROUNDING
    bath.to(90.0)
    assert bath.to(CROSSING + distance) == pytest.approx(float(heating(CROSSING + distance)), abs=ROUNDING)
    assert bath.to(CROSSING - distance) == pytest.approx(float(cooling(CROSSING - distance)), abs=ROUNDING)
    assert bath.to(CROSSING + distance) == pytest.approx(float(heating(CROSSING + distance)), abs=ROUNDING)


def test_other_branches_that_never_cross_keep_their_loop_open(make_unit):
    """With a cooling branch above the heating branch everywhere there is no temperature that closes the loop."""
    unit = make_unit(coils=1, parameters={"cooling_a": 240.0})
    bath = Bath(unit)
    assert bath.to(90.0) == pytest.approx(float(heating(90.0)), abs=ROUNDING)
    assert bath.to(75.0) == pytest.approx(float(heating(90.0)), abs=ROUNDING)
    assert bath.to(50.0) == pytest.approx(240.0 / 199.6 * (float(cooling(50.0)) - 157.9) + 157.9, abs=ROUNDING)
    bath.unit.release(bath.start)


def test_each_coil_remembers_its_own_past(make_unit):
    unit = make_unit()
    unit.initialise(0)
    unit.exit_initialisation()
    power = np.where(np.arange(36) % 2 == 0, 0.5, 0.3)[None]
    advance(unit, power, (), size=SOAK)
    warm = unit.get("temperature").copy() - CELSIUS
    np.testing.assert_allclose(unit.get("stiffness"), heating(warm), rtol=1e-12)
    advance(unit, np.zeros((1, 36)), (), size=5 * 10**9, begin=SOAK)
    cool = unit.get("temperature") - CELSIUS
    expected = np.clip(heating(warm), heating(cool), bounds(cool)[1])
    np.testing.assert_allclose(unit.get("stiffness"), expected, rtol=1e-12)
    assert np.ptp(unit.get("stiffness")) > 10.0
