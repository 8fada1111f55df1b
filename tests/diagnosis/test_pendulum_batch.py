"""Arms stepped in compiled code against the unit in Bullet, and the model that is made of them."""

from __future__ import annotations

import math
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from cosim.run import run
from cosim.scenario import load_scenario
from cosim.unit.quantity import PhysicalValue
from diagnosis.judge.estimates import estimates
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.models.pendulum.batch import arm, longest_step, swings
from diagnosis.models.pendulum.model import PendulumModel, without_scale
from diagnosis.models.sensor_chain import lagging
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording
from diagnosis.search.cosim_model import CosimModel, Free, free_parameters
from diagnosis.search.fit import fit
from diagnosis.search.pendulum_terms import pendulum_laws
from diagnosis.search.problem import Parameter, Point
from diagnosis.search.search import Settings, search
from mechanics.bullet_pendulum import PendulumWorld
from mechanics.pendulum import PendulumDesign

START = {"initial_angle": 1.285, "initial_angular_velocity": 0.85}
SMOOTH = {
    "viscous_damping": 1e-4,
    "quadratic_drag": 2e-5,
    "cubic_drag": 1e-6,
    "spring_stiffness": 3e-3,
    "spring_rest": 2.8,
    "band_damping": 6e-4,
    "band_width": 0.25,
    "periodic_torque": 8e-4,
    "periodic_rate": 9.0,
    "periodic_phase": 0.4,
    "constant_torque": 1e-3,
    "tilt": 0.02,
}
RESTS = {"coulomb_friction": 2e-2}  # sticks beside the vertical within a second
DRY = {"coulomb_friction": 3e-4, "stiction": 2.5e-3, "stribeck_speed": 0.4}


def design(**numbers: float) -> PendulumDesign:
    return PendulumDesign(0.1, 0.115, 4.408e-4, **START, **numbers)


def by_unit(given: PendulumDesign, micro: float, seconds: float) -> np.ndarray:
    """Angle and angular velocity every 10 ms, shape (samples, 2)."""
    world, rows = PendulumWorld(given, micro), []
    world.begin(given.initial_angle, given.initial_angular_velocity, 0.0)
    for _ in range(round(seconds / 0.01) + 1):
        rows.append((world.state()[0], world.angular_velocity()))
        world.advance(round(0.01 / micro), 0.0)
    world.close()
    return np.array(rows)


def together(designs: list[PendulumDesign], micro: float, seconds: float) -> np.ndarray:
    return swings([arm(asdict(d)) for d in designs], micro, 0.01, round(seconds / 0.01) + 1)


def test_every_smooth_torque_swings_as_the_equation_says():
    given, times = design(**SMOOTH), np.arange(0.0, 4.0, 0.01)

    def rate(time: float, y: np.ndarray) -> list[float]:
        weight = given.weight_moment * math.sin(y[0] - given.tilt)
        w = y[1]
        band = 6e-4 * math.exp(-(((y[0] - math.pi) / 0.25) ** 2))
        torque = 1e-3 + 8e-4 * math.sin(9.0 * time + 0.4) - 3e-3 * (y[0] - 2.8)
        return [w, (weight + torque - (1e-4 + 2e-5 * abs(w) + 1e-6 * w * w + band) * w) / given.inertia]

    exact = solve_ivp(rate, (0.0, 4.0), list(START.values()), "DOP853", times, rtol=1e-11, atol=1e-12).y[0]
    # Stoermer-Verlet: phase (w dt)^2 / 24 of 32 rad at 0.25 ms, 5e-6 rad, times an amplitude of 2
    assert np.abs(by_unit(given, 2.5e-4, 4.0)[:400, 0] - exact).max() < 3e-5


def test_dry_friction_is_second_order_where_the_arm_turns():
    given = design(**DRY)
    coarse, fine = by_unit(given, 5e-4, 12.0), by_unit(given, 6.25e-5, 12.0)
    # one motor over a whole step leaves 2.4e-3 rad
    assert np.abs(coarse - fine)[:, 0].max() < 1.5e-4


@pytest.mark.parametrize("numbers", [SMOOTH, DRY, RESTS], ids=["smooth", "dry", "rests"])
def test_arms_take_the_steps_of_the_unit_in_bullet(numbers):
    # No longer step than the unit's 5 ms fits: the batch takes the same steps, and rounding is left.
    assert longest_step(5e-3, 0.01, 8.0) == 5e-3
    designs = [design(**{name: value}) for name, value in numbers.items() if name not in ("band_width", "spring_rest")]
    designs = [d for d in designs if d != design()] + [design(**numbers)]
    given = [arm(asdict(d)) for d in designs]
    found = swings(given, 5e-3, 0.01, 201)
    for one, course in zip(designs, found):
        assert np.abs(course - by_unit(one, 5e-3, 2.0)).max() < 1e-9


def test_an_arm_that_friction_holds_stands_still_where_it_does_in_bullet():
    given = design(**RESTS)
    found, unit = together([given], 5e-3, 2.0)[0], by_unit(given, 5e-3, 2.0)
    assert np.abs(unit[-1, 1]) < 1e-9 < np.abs(unit[-1, 0] - math.pi)
    assert np.abs(found[-1] - unit[-1]).max() < 1e-9


# Ten steps of the unit in one, five with dry friction. The correction makes up for the error of weight and damping,
# which leaves 5e-6 rad; not for that of a spring and of a shaking table (1e-4 rad), nor of stiction (3e-4 rad).
LOSSES = {"viscous_damping": 1e-4, "quadratic_drag": 2e-5, "tilt": 0.02}


@pytest.mark.parametrize(
    ("numbers", "largest"), [(LOSSES, 1e-5), (SMOOTH, 2e-4), (DRY, 5e-4)], ids=["losses", "smooth", "dry"]
)
def test_a_longer_step_gives_the_angles_of_the_units_own(numbers, largest):
    given = design(**numbers)
    found, unit = together([design(), given], 5e-4, 12.0)[1], by_unit(given, 5e-4, 12.0)
    assert np.abs(found - unit)[:, 0].max() < largest
    assert longest_step(5e-4, 0.01, 8.0) == pytest.approx(5e-3)


def made(folder: Path, seed: int, **truth: str) -> Recording:
    """A recording of the shipped pendulum for 6 s with other parameters than the scenario says, noise 1 mrad."""
    base = load_scenario("pendulum")
    own = base.components["arm"]
    parameters = {**own.parameters, **{k: PhysicalValue.parse(v) for k, v in truth.items()}}
    time = base.time.model_copy(update={"stop": PhysicalValue(6.0, "s"), "checkpoint_step": PhysicalValue(1.0, "s")})
    scenario = base.model_copy(
        update={"components": {"arm": own.model_copy(update={"parameters": parameters})}, "time": time}
    )
    sensors = SensorFile.model_validate({"default": {"rate": "50 Hz", "noise": "1 mrad", "unit": "rad"}})
    write_recording(folder, read_results(run(scenario), ["arm.angle"], sensors, seed, folder), Notes("swing"))
    return load_recording(folder)


@pytest.fixture(scope="module")
def longer(tmp_path_factory) -> Recording:
    return made(tmp_path_factory.mktemp("r") / "r", 1, centre_distance="121 mm")


@pytest.fixture(scope="module")
def braked(tmp_path_factory) -> Recording:
    return made(
        tmp_path_factory.mktemp("r") / "r",
        2,
        band_damping="6e-4 N*m*s",
        band_width="0.25 rad",
        centre_distance="114 mm",
    )


def test_residuals_are_those_of_the_co_simulation(longer):
    base = load_scenario("pendulum")
    laws = [law.place for law in pendulum_laws("arm")]
    free = free_parameters(base, [longer])
    fast, slow = (kind(base, [longer], free, laws) for kind in (PendulumModel, CosimModel))
    damping, play = (next(t for t in fast.terms() if t.identifier == i) for i in ("viscous_damping", "backlash"))
    point = Point(np.array([0.7]), {damping: (1e-4,), play: (0.01,)})
    # 1e-5 rad against a noise of 1e-3 rad
    assert np.abs(fast.residuals([point]) - slow.residuals([point])).max() < 0.02
    assert (
        np.abs(fast.base_jacobian(point) - slow.base_jacobian(point)).max()
        < 2e-2 * np.abs(slow.base_jacobian(point)).max()
    )  # forward against central differences
    np.testing.assert_array_equal(fast.predict(point, 0), slow.predict(point, 0))


def test_wrong_parameters_alone_are_recalibrated_and_nothing_else(longer):
    model = ClosedLoopModel(load_scenario("pendulum"), [longer])
    found = search(model, model.terms(), Settings())
    assert found.best.terms == ()
    distance = model.parameters[0]
    assert distance.value(found.base.point.base[0]) == pytest.approx(0.121, rel=2e-4)


def test_a_brake_that_the_catalogue_has_not_is_found_without_a_name(braked):
    model = ClosedLoopModel(load_scenario("pendulum"), [braked])
    found = search(model, model.terms(), Settings(most_terms=1))
    (term,) = found.best.terms
    assert not term.is_named
    assert term.identifier == "torque_of_rate_in_a_band"
    damping, width = found.best.fit.point.terms[term]
    # of a brake that is passed at speed its product with the width shows, and hardly more
    assert damping * width == pytest.approx(6e-4 * 0.25, rel=0.05)


def test_a_law_that_is_hidden_is_among_those_without_a_name(longer):
    base = load_scenario("pendulum")
    whole, without = (ClosedLoopModel(base, [longer], hidden).terms() for hidden in ((), ("backlash",)))
    assert "memory_of_direction" not in {t.identifier for t in whole}
    assert [t.is_named for t in without if t.identifier == "memory_of_direction"] == [False]
    assert "backlash" not in {t.identifier for t in without}


def test_a_heavier_arm_swings_alike_without_friction_and_less_damped_with_it(longer):
    base = load_scenario("pendulum")
    free = free_parameters(base, [longer])
    heavy = type(free[0])(type(free[0].parameter)("arm.mass", "kg", 0.1, 0.1), "arm", "mass")
    model = PendulumModel(base, [longer], [heavy], [law.place for law in pendulum_laws("arm")])
    damping = next(t for t in model.terms() if t.identifier == "viscous_damping")
    assert np.abs(model.base_jacobian(Point(np.zeros(1)))).max() < 1e-4
    light, much = Point(np.zeros(1), {damping: (1e-4,)}), Point(np.log(1.5) * np.full(1, 10.0), {damping: (1.5e-4,)})
    assert np.abs(model.residuals([light]) - model.residuals([much])).max() < 1e-4


def test_what_no_swing_shows_is_not_fitted_but_counts_in_the_interval(longer):
    base = load_scenario("pendulum")
    recordings = [longer]
    free = free_parameters(base, recordings)
    mass = Free(Parameter("arm.mass", "kg", 0.1, 0.02), "arm", "mass")
    kept, scale = without_scale(base, [mass, *free])
    assert (kept, scale) == (free, 0.02)
    own = base.components["arm"]
    driven = own.model_copy(update={"parameters": {**own.parameters, "viscous_damping": PhysicalValue(1e-4, "N*m*s")}})
    damped = base.model_copy(update={"components": {"arm": driven}})
    assert without_scale(damped, [mass, *free]) == ([mass, *free], 0.0)  # a known torque sets the scale


def test_intervals_of_torques_hold_the_doubt_about_the_mass(longer):
    model = ClosedLoopModel(load_scenario("pendulum"), [longer])
    damping, tilt = (next(t for t in model.terms() if t.identifier == i) for i in ("viscous_damping", "tilt"))
    found = fit(model, Point(np.zeros(len(model.parameters)), {damping: (1e-4,), tilt: (0.01,)}))
    (seen,), (whole,) = estimates(found, damping), estimates(found, damping, scale_uncertainty=(0.015,))
    half = np.hypot(seen.upper - seen.value, 1.96 * 0.015 * seen.value)
    assert whole.upper - whole.value == pytest.approx(half, rel=1e-3)
    assert model.scale_uncertainty(tilt) == (0.0,)


def test_stiction_is_simulated_in_the_steps_of_the_unit():
    given = design(stiction=6e-3, stribeck_speed=0.36)
    found, unit = together([given], 5e-4, 6.0)[0], by_unit(given, 5e-4, 6.0)
    assert np.abs(found - unit)[:, 0].max() < 1e-4


def test_a_sensor_of_first_order_answers_a_ramp_exactly():
    times = 0.01 * np.arange(200)
    # response of lag * y' + y = t, at rest before
    np.testing.assert_allclose(lagging(times, 0.05, 0.01), times - 0.05 * (1.0 - np.exp(-times / 0.05)), atol=1e-12)


@pytest.mark.parametrize(("fault", "amount"), [("sensor_gain", 0.02), ("sensor_clock_offset", 0.02)])
def test_faults_of_the_encoder_change_what_it_reads(longer, fault, amount):
    model = ClosedLoopModel(load_scenario("pendulum"), [longer])
    term = next(t for t in model.terms() if t.identifier == fault)
    zero = Point(np.zeros(len(model.parameters)))
    plain, faulty = (model.predict(p, 0)[0] for p in (zero, zero.plus(term, (amount,))))
    if fault == "sensor_gain":
        np.testing.assert_allclose(faulty, math.pi + 1.02 * (plain - math.pi), atol=1e-9)
    else:
        np.testing.assert_allclose(faulty[1:], plain[:-1], atol=1e-5)  # 50 Hz: one sample late; splines differ
