"""Physics of niti_kinetics: phases, stress, latent heat, energy, loops. Coils in a bath follow its temperature."""

import numpy as np
import pytest
from fmu_runs import STEP, advance
from niti_twin import NITI
from scipy.optimize import curve_fit
from thermal_twin import CELSIUS, cooling, heating

from cosim.unit.protocol import UnitError, seconds

WEIGHT = 0.5 * 9.81  # the paper's 500 g [N]
LATENT, CAPACITY = NITI.mass * NITI.latent_heat, NITI.mass * NITI.specific_heat
#: 5 s in this bath are 110 time constants of a coil: it is as warm as the bath to the last digit.
STIRRED = {"heat_transfer_coefficient": 9000.0}
#: The step's error is 1e-12 J (3e-11 K); the austenite fraction changes by at most 0.07 per kelvin.
EXACT = 1e-9


class Bath:
    """Coils that take the temperature of their bath [K]."""

    def __init__(self, make_unit, tension=0.0, coils=1, **given):
        self.unit, self.time = make_unit("niti_kinetics", coils=coils, parameters=STIRRED, **given), 0
        self.unit.set("ambient_temperature", 270.0)
        self.unit.set("tension", np.broadcast_to(np.asarray(tension, float), coils))
        self.unit.initialise(0)

    def follow(self, temperatures, *names):
        """Outputs after each temperature, shape (temperatures, names, coils)."""
        record = []
        for temperature in temperatures:
            self.unit.set("ambient_temperature", temperature)
            self.unit.do_step(self.time, 5 * 10**9)
            self.time += 5 * 10**9
            record.append([self.unit.get(name).copy() for name in names])
        return np.array(record)


def austenite(bath, temperatures):
    return 1.0 - bath.follow(temperatures, "martensite_fraction")[:, 0]


def random_run(unit, seed=3, steps=150):
    chance = np.random.default_rng(seed)
    powers = chance.uniform(0.0, 1.0, (steps, 36)) * (chance.random((steps, 36)) < 0.7)
    tensions = np.repeat(chance.uniform(0.0, 8.0, (steps // 5, 36)), 5, axis=0)
    names = ("stored_energy", "convected_energy", "latent_energy", "temperature", "martensite_fraction")
    return powers, advance(unit, powers, names, size=20 * STEP, tensions=tensions)


@pytest.mark.parametrize("version", [3, 2])
@pytest.mark.parametrize("interface", ["co_simulation", "model_exchange"])
def test_energy_supplied_is_stored_as_heat_and_transformation_or_convected(make_unit, version, interface):
    unit = make_unit("niti_kinetics", version, interface)
    unit.initialise(0)
    powers, run = random_run(unit)
    stored, convected, latent, temperature, martensite = run.swapaxes(0, 1)
    supplied = np.cumsum(powers, axis=0) * seconds(20 * STEP)
    # The sum of the two states is linear in them, which CVODE keeps to rounding of its own error weights.
    tolerance = 1e-10 if interface == "co_simulation" else 1e-8
    np.testing.assert_allclose(stored + convected, supplied, rtol=0.0, atol=tolerance)
    # The inner iteration: sensible and latent heat make up the state exactly, and the latent heat is that of the phase.
    np.testing.assert_allclose(CAPACITY * (temperature - 295.15) + latent, stored, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(latent, LATENT * (1.0 - martensite), rtol=0.0, atol=1e-10)
    assert np.ptp(martensite) == 1.0  # the run passes through the whole transformation


@pytest.mark.parametrize("tension", [0.0, 3.0, 6.0])
def test_the_outermost_loop_is_the_cosine_law_of_liang_and_rogers(make_unit, tension):
    bath = Bath(make_unit, tension)
    path = np.linspace(270.0, 370.0, 201)
    reduced = path - NITI.shift(tension)
    up, down = austenite(bath, path)[:, 0], austenite(bath, path[::-1])[::-1, 0]
    np.testing.assert_allclose(up, NITI.heating(reduced), rtol=0.0, atol=EXACT)
    np.testing.assert_allclose(down, NITI.cooling(reduced), rtol=0.0, atol=EXACT)


def test_transformation_temperatures_rise_with_stress_by_the_slope(make_unit):
    tensions = np.array([0.0, 1.0, 2.0, 4.0, 8.0])
    bath = Bath(make_unit, tensions, coils=5)
    path = np.linspace(270.0, 380.0, 441)
    surface = 8.0 * tensions * 1.0676e-3 / (np.pi * 0.29956e-3**3)  # Wahl
    expected = 2.0 / 3.0 * surface / 13.8e6
    assert expected[-1] == pytest.approx(39.09, abs=0.01)
    for way in (path, path[::-1]):
        run = austenite(bath, way)
        half = np.array([np.interp(0.5, *sorted_by(run[:, k], way)) for k in range(5)])
        # The half-way point, interpolated between temperatures 0.25 K apart.
        np.testing.assert_allclose(half - half[0], expected, rtol=0.0, atol=1e-3)


def sorted_by(keys, values):
    order = np.argsort(keys, kind="stable")
    return keys[order], values[order]


def test_the_loop_closes_and_repeats(make_unit):
    bath = Bath(make_unit, 3.0)
    circle = np.concatenate([np.linspace(275.0, 360.0, 60), np.linspace(360.0, 275.0, 60)])
    names = ("martensite_fraction", "stiffness", "rest_length", "resistance", "stored_energy")
    first, second = bath.follow(circle, *names), bath.follow(circle, *names)
    np.testing.assert_allclose(second[-1], first[-1], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(second, first, rtol=0.0, atol=1e-6)  # stiffness: 200 N/m per unit of fraction
    assert np.ptp(first[:, 0]) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("seed", range(8))
def test_minor_loops_stay_inside_the_major_loop_and_never_jump(make_unit, seed):
    bath, chance = Bath(make_unit), np.random.default_rng(seed)
    path = np.repeat(chance.uniform(275.0, 325.0, 40), 1)
    path = np.interp(np.arange(0, 39, 0.2), np.arange(40), path)
    run = austenite(bath, path)[:, 0]
    assert (run >= NITI.heating(path) - EXACT).all()
    assert (run <= NITI.cooling(path) + EXACT).all()
    steepest = 0.5 * np.pi / (NITI.austenite_finish - NITI.austenite_start)  # of either branch
    # A scaled branch is never steeper than the steepest branch is, relative to what is left: at most 1.5 times here.
    assert (np.abs(np.diff(run)) <= 1.5 * steepest * np.abs(np.diff(path)) + EXACT).all()
    moved = np.diff(run) * np.sign(np.diff(path))
    assert moved.min() >= -EXACT  # austenite grows on the way up, shrinks on the way down
    assert np.ptp(run) > 0.5


def test_repeated_minor_loops_settle(make_unit):
    """The restarted law has no return-point memory: a minor loop drifts, by less each time (README)."""
    bath = Bath(make_unit)
    bath.follow([309.0], "temperature")
    ends = np.array([austenite(bath, [302.0, 309.0])[-1, 0] for _ in range(60)])
    drift = np.abs(np.diff(ends))
    assert (drift[1:] <= drift[:-1] + EXACT).all()
    assert drift[0] > 1e-3
    assert drift[-1] < 1e-3 * drift[0]


def test_heating_takes_up_the_latent_heat(make_unit):
    """Without losses, dT/dt = P / (C + m L dz/dT), and above the transformation all of m L has been taken up."""
    power, given = 0.2, {"heat_transfer_coefficient": 0.0}
    unit = make_unit("niti_kinetics", coils=1, parameters=given)
    unit.initialise(0)
    names = ("temperature", "martensite_fraction", "stored_energy")
    temperature, martensite, stored = advance(unit, np.full((1200, 1), power), names)[:, :, 0].T
    assert martensite[-1] == 0.0
    assert stored[-1] - CAPACITY * (temperature[-1] - 295.15) == pytest.approx(LATENT, abs=1e-10)
    rate = np.gradient(temperature, seconds(STEP))
    middle = int(np.argmin(np.abs(martensite - 0.5)))
    steepest = 0.5 * np.pi / (NITI.austenite_finish - NITI.austenite_start)
    # Central differences over 0.02 s, where the slope of the cosine is stationary.
    assert rate[middle] == pytest.approx(power / (CAPACITY + LATENT * steepest), rel=1e-4)
    assert rate[5] == pytest.approx(power / CAPACITY, rel=1e-6)


def test_a_sudden_pull_on_austenite_warms_it_by_the_heat_of_transformation(make_unit):
    bath = Bath(make_unit)
    bath.follow([330.0, 311.0], "temperature")
    before = {name: bath.unit.get(name).copy() for name in ("temperature", "martensite_fraction", "stored_energy")}
    assert before["martensite_fraction"][0] == 0.0
    bath.unit.set("tension", np.array([6.0]))
    bath.unit.buffers.read(bath.time)
    temperature, martensite = bath.unit.get("temperature")[0], bath.unit.get("martensite_fraction")[0]
    assert martensite > 0.1
    assert bath.unit.get("stored_energy") == before["stored_energy"]
    warmed = CAPACITY * (temperature - before["temperature"][0])
    assert warmed == pytest.approx(LATENT * martensite, abs=1e-10)


def test_resistance_falls_and_the_coil_contracts_and_stiffens_with_austenite(make_unit):
    bath = Bath(make_unit, WEIGHT)
    path = np.linspace(300.0, 350.0, 101)
    fraction, resistance, length, stiffness = bath.follow(
        path, "martensite_fraction", "resistance", "rest_length", "stiffness"
    )[:, :, 0].T
    np.testing.assert_allclose(resistance, 2.2 * (1.0 - (1.0 - 0.89 / 1.02) * (1.0 - fraction)), rtol=1e-14)
    unwound = np.pi * 1.0676e-3**2 * 31 * 0.002 / 0.29956e-3  # Wahl: deflection of a shear strain at the surface
    np.testing.assert_allclose(length, 0.0094 + unwound * fraction, rtol=1e-14)
    assert (np.diff(resistance) <= 0.0).all()
    assert (resistance[0], resistance[-1]) == (2.2, pytest.approx(1.9196, abs=1e-4))
    # The shear moduli are given to five digits.
    assert stiffness[0] == pytest.approx(157.1, rel=2e-5)
    assert stiffness[-1] == pytest.approx(float(heating(70.0)), rel=2e-5)


def test_turns_that_touch_limit_the_contraction(make_unit):
    unit = make_unit("niti_kinetics", coils=1, parameters={"coil_rest_length": 0.005})
    unit.initialise(0)
    assert unit.get("rest_length")[0] == pytest.approx(31 * 0.29956e-3, rel=1e-14)


def test_under_the_papers_weight_the_stiffness_is_close_to_equation_2(make_unit):
    bath = Bath(make_unit, WEIGHT)
    celsius = np.linspace(30.0, 70.0, 81)
    up = bath.follow(celsius + CELSIUS, "stiffness")[:, 0, 0]
    bath.follow([400.0], "stiffness")
    down = bath.follow(celsius[::-1] + CELSIUS, "stiffness")[::-1, 0, 0]
    # A cosine is no Gompertz curve: 2.3 and 10.7 N/m are the largest residuals of the fits (README).
    assert np.abs(up - heating(celsius)).max() < 2.4
    assert np.abs(down - cooling(celsius)).max() < 10.8


def test_latent_heat_slows_the_cooling_to_the_papers_rate(make_unit):
    """Equation (5) has a regressed alpha of 0.14 1/s where h A / C is 0.22 1/s: under load, latent heat explains it."""
    unit = make_unit("niti_kinetics", coils=2)
    unit.set("tension", np.array([3.5, WEIGHT]))
    unit.initialise(0)
    advance(unit, np.full((1, 2), 1.0 / 2.2), (), size=200 * 10**9)
    rise = advance(unit, np.zeros((300, 2)), ("temperature",), size=10**8, begin=200 * 10**9)[:, 0] - 295.15
    time = 0.1 * np.arange(1, 301)
    start = 1.0 / 2.2 / NITI.conductance
    for k in range(2):
        (alpha,), _ = curve_fit(lambda t, a: start * np.exp(-a * t), time, rise[:, k], p0=0.2)
        assert alpha == pytest.approx(0.14, abs=0.005)
    assert NITI.conductance / CAPACITY == pytest.approx(0.2226, abs=1e-4)


def test_a_slack_coil_is_an_unloaded_one(make_unit):
    slack, unloaded = Bath(make_unit, -5.0), Bath(make_unit, 0.0)
    path = np.linspace(290.0, 320.0, 20)
    np.testing.assert_array_equal(austenite(slack, path), austenite(unloaded, path))


def test_one_long_step_equals_many_short_ones(make_unit):
    names, runs = ("temperature", "martensite_fraction", "stored_energy", "convected_energy"), []
    power = np.linspace(0.1, 0.8, 36)
    for steps in (1, 1000):
        unit = make_unit("niti_kinetics")
        unit.set("tension", np.full(36, 4.0))
        unit.initialise(0)
        runs.append(advance(unit, np.tile(power, (steps, 1)), names, size=20 * 10**9 // steps)[-1])
    # A thousand steps of 1e-12 J each at most: 1e-9 J, or 3e-8 K.
    np.testing.assert_allclose(runs[0], runs[1], rtol=0.0, atol=3e-8)


@pytest.mark.parametrize("version", [3, 2])
@pytest.mark.parametrize(
    "given", [{"martensite_finish": 320.0}, {"austenite_finish": 300.0}, {"austenite_start": 270.0}]
)
def test_transformation_temperatures_in_the_wrong_order_are_refused(make_unit, version, given):
    unit = make_unit("niti_kinetics", version, parameters=given)
    with pytest.raises(UnitError, match="the cooling branch must lie below the heating branch"):
        unit.initialise(0)
