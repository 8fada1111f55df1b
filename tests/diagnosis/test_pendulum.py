"""A pendulum in Bullet against closed forms and SciPy: energy, period, each friction, play, tilt."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS, UnitError
from mechanics.pendulum import PendulumDesign, PendulumUnit

MASS, DISTANCE, INERTIA, GRAVITY = 0.1, 0.115, 4.408e-4, 9.80665
J = INERTIA + MASS * DISTANCE**2
MOMENT = MASS * GRAVITY * DISTANCE


def design(**numbers: float) -> PendulumDesign:
    return PendulumDesign(MASS, DISTANCE, INERTIA, GRAVITY, **numbers)


def swing(given: PendulumDesign, seconds: float, micro: float = 1e-3, output: float = 5e-3, torque: float = 0.0):
    """Times, angle read, angular velocity, angle of the arm, each (outputs,)."""
    unit = PendulumUnit("arm", given, micro)
    unit.set("torque", np.array(torque))
    unit.initialise(0)
    unit.exit_initialisation()
    size, rows = round(output * NANOSECONDS), []
    names = ("angle", "angular_velocity", "arm_angle")
    rows.append([float(unit.get(n)) for n in names])
    for i in range(round(seconds / output)):
        unit.do_step(i * size, size)
        rows.append([float(unit.get(n)) for n in names])
    unit.terminate()
    return np.arange(len(rows)) * output, *np.array(rows).T


def reference(given: PendulumDesign, times: np.ndarray, torque: float = 0.0) -> np.ndarray:
    """Smooth laws by SciPy's DOP853: angle and angular velocity, (2, outputs)."""

    def rate(_: float, y: np.ndarray) -> list[float]:
        resist = (given.viscous_damping + given.quadratic_drag * abs(y[1])) * y[1]
        return [y[1], (MOMENT * math.sin(y[0] - given.tilt) - resist + torque) / J]

    start = [given.initial_angle, given.initial_angular_velocity]
    return solve_ivp(rate, (0.0, times[-1]), start, "DOP853", times, rtol=1e-11, atol=1e-12).y


def test_a_large_swing_has_the_period_of_the_elliptic_integral():
    amplitude = 1.6
    times, _, speed, _ = swing(design(initial_angle=math.pi - amplitude), 10.0)
    turns = np.flatnonzero((speed[:-1] > 0) & (speed[1:] <= 0))
    moments = times[turns] + 5e-3 * speed[turns] / (speed[turns] - speed[turns + 1])
    period = np.mean(np.diff(moments))
    expected = 4.0 * ellipk(math.sin(amplitude / 2) ** 2) * math.sqrt(J / MOMENT)
    assert period == pytest.approx(expected, rel=1e-5)  # leapfrog: (w dt)^2 / 24 = 2.7e-6


def test_angle_and_speed_are_second_order_in_the_micro_step():
    given = design(initial_angle=1.5, initial_angular_velocity=2.0, viscous_damping=1e-4, quadratic_drag=1e-5)
    errors = []
    for micro in (5e-3, 2.5e-3, 1.25e-3):
        times, _, speed, angle = swing(given, 5.0, micro)
        exact = reference(given, times)
        errors.append([np.sqrt(np.mean((angle - exact[0]) ** 2)), np.sqrt(np.mean((speed - exact[1]) ** 2))])
    orders = np.log2(np.array(errors)[:-1] / np.array(errors)[1:])
    assert np.all(np.abs(orders - 2.0) < 0.1)
    assert errors[-1][0] < 4e-4  # rad, after 6.4 swings of 1.6 rad


def test_without_friction_no_energy_is_lost():
    times, _, speed, angle = swing(design(initial_angle=1.5), 60.0)
    energy = 0.5 * J * speed**2 + MOMENT * (1.0 + np.cos(angle))
    early, late = energy[times < 6.0].mean(), energy[times > 54.0].mean()
    # The drift that a friction of 1e-8 N m s would cause in this minute is 3e-4 of the energy.
    assert abs(late / early - 1.0) < 1e-6
    assert np.ptp(energy) / early < 2e-4  # it sways within a swing, as leapfrog does


@pytest.mark.parametrize(
    "numbers",
    [{"viscous_damping": 1e-4}, {"quadratic_drag": 2e-5}, {"tilt": 0.05}, {"tilt": -0.05, "viscous_damping": 3e-5}],
)
def test_smooth_laws_agree_with_scipy(numbers):
    given = design(initial_angle=1.5, initial_angular_velocity=1.0, **numbers)
    times, _, speed, angle = swing(given, 9.0)
    exact = reference(given, times)
    assert np.max(np.abs(angle - exact[0])) < 2e-3  # phase 2.7e-6 of 72 rad times the speed of 12 rad/s over 8 1/s
    assert np.max(np.abs(speed - exact[1])) < 2e-2


def test_small_swings_decay_with_the_viscous_rate():
    damping = 5e-4
    times, angle, _, _ = swing(design(initial_angle=math.pi - 0.01, viscous_damping=damping), 10.0)
    omega = math.sqrt(MOMENT / J - (damping / J / 2) ** 2)
    decay = np.exp(-damping * times / (2 * J))
    expected = -0.01 * decay * (np.cos(omega * times) + damping / (2 * J * omega) * np.sin(omega * times))
    assert np.max(np.abs(angle - math.pi - expected)) < 5e-6  # leapfrog: phase off by 2.7e-6 of 80 rad


def test_dry_friction_takes_the_same_from_every_half_swing_and_then_holds():
    friction = 2e-3
    times, angle, speed, _ = swing(design(initial_angle=math.pi - 0.2, coulomb_friction=friction), 6.0)
    turns = np.abs(angle[1:-1] - math.pi)[(speed[:-2] * speed[2:] <= 0) & (np.abs(speed[1:-1]) < 0.05)]
    peaks = turns[turns > 0.03]
    loss = 2 * friction / MOMENT  # linear pendulum: 2 tau / (m g l) from every half swing
    assert peaks[0] == pytest.approx(0.2 - loss, rel=0.01)  # sin(x) < x: 0.7 % at 0.2 rad
    assert np.all(angle[times > 5.0] == angle[-1])  # it holds, to the last bit
    assert abs(angle[-1] - math.pi) <= friction / MOMENT


def test_an_arm_at_rest_breaks_loose_only_beyond_its_stiction():
    given = design(coulomb_friction=1e-3, stiction=2e-3)
    held = swing(given, 0.5, torque=2.9e-3)
    loose = swing(given, 0.5, torque=3.1e-3)
    assert np.all(held[1] == math.pi)
    assert loose[1][-1] - math.pi > 1e-3


def test_stiction_falls_off_with_the_stribeck_speed():
    given = design(coulomb_friction=1e-3, stiction=2e-3, stribeck_speed=0.5)
    assert given.dry_friction(0.0) == pytest.approx(3e-3)
    assert given.dry_friction(0.5) == pytest.approx(1e-3 + 2e-3 / math.e)
    assert given.dry_friction(-5.0) == pytest.approx(1e-3)


def test_tilt_moves_where_the_arm_hangs():
    _, angle, _, _ = swing(design(initial_angle=math.pi, tilt=0.1, viscous_damping=5e-3), 6.0)
    assert angle[-1] == pytest.approx(math.pi + 0.1, abs=1e-4)  # exp(-1.4 * 6) of 0.1 is left


def test_the_encoder_stands_still_in_its_play_and_then_follows_at_half_of_it():
    play = 0.04
    _, read, speed, arm = swing(design(initial_angle=math.pi - 0.5, backlash=play), 4.0)
    assert np.max(np.abs(read - arm)) == pytest.approx(play / 2, rel=1e-9)
    moving = np.abs(read - arm) > play / 2 * (1 - 1e-9)
    assert np.all(np.sign(arm - read)[moving & (np.abs(speed) > 0.5)] == np.sign(speed)[moving & (np.abs(speed) > 0.5)])
    lost = np.ptp(arm[200:]) - np.ptp(read[200:])  # it began in the middle of its play
    assert lost == pytest.approx(play, rel=0.02)  # outputs every 5 ms miss the turning points by up to 1e-4


def test_work_of_an_outer_torque_becomes_energy():
    _, angle, speed, _ = swing(design(), 1.0, torque=0.02)
    energy = 0.5 * J * speed**2 + MOMENT * (1.0 + np.cos(angle))
    np.testing.assert_allclose(energy, 0.02 * (angle - math.pi), atol=3e-7)  # leapfrog sways by 1e-4 of 2 mJ


def test_a_restored_arm_swings_on_to_the_last_bit():
    given = design(initial_angle=1.0, viscous_damping=1e-4, coulomb_friction=1e-4, stiction=1e-4, backlash=0.01)
    unit = PendulumUnit("arm", given, 1e-3)
    unit.initialise(0)
    unit.exit_initialisation()
    unit.do_step(0, 200_000_000)
    saved = unit.save()
    unit.do_step(200_000_000, 300_000_000)
    once = [float(unit.get(n)) for n in unit.variables]
    unit.restore(saved, 200_000_000)
    unit.do_step(200_000_000, 300_000_000)
    assert [float(unit.get(n)) for n in unit.variables] == once
    fresh = PendulumUnit("arm", given, 1e-3)
    fresh.resume(saved, 200_000_000)
    fresh.do_step(200_000_000, 300_000_000)
    assert [float(fresh.get(n)) for n in fresh.variables] == once
    unit.terminate()
    fresh.terminate()


@pytest.mark.parametrize("name", ["viscous_damping", "coulomb_friction", "stiction", "quadratic_drag", "backlash"])
def test_friction_of_the_wrong_sign_is_refused(name):
    with pytest.raises(ValueError, match=f"{name} is -1e-05"):
        design(**{name: -1e-5})


def test_a_damping_that_stops_the_arm_within_a_step_is_refused():
    with pytest.raises(ValueError, match="take a shorter one"):
        PendulumUnit("arm", design(viscous_damping=2.0), 1e-3)


def test_a_step_between_micro_steps_is_refused():
    unit = PendulumUnit("arm", design(), 1e-3)
    unit.initialise(0)
    unit.exit_initialisation()
    with pytest.raises(UnitError, match="no whole number of micro-steps"):
        unit.do_step(0, 1_500_000)
    unit.terminate()


def test_the_shipped_scenario_swings_between_the_horizontals():
    angle = run(load_scenario("pendulum"))["arm.angle"].values
    assert (angle.min(), angle.max()) == (
        pytest.approx(math.pi / 2, abs=1e-4),
        pytest.approx(3 * math.pi / 2, abs=1e-4),
    )


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ("{colour: 1}", "a pendulum has no parameter `colour`"),
        ("{mass: 3 s}", "3 s"),
        ("{viscous_damping: -1e-4 N*m*s/rad}", "it takes energy"),
    ],
)
def test_a_wrong_parameter_is_one_error_that_names_the_component(change, text):
    data = (
        "title: t\ntime: {stop: 1 s, macro_step: 5 ms, output_step: 5 ms, checkpoint_step: 1 s}\n"
        f"components:\n  arm: {{kind: bullet_pendulum, parameter_set: pendulum_arm, parameters: {change}}}\n"
    )
    with pytest.raises(InputError) as caught:
        run(parse_scenario(data, Path("own.yaml")))
    assert caught.value.key.startswith("components.arm")
    assert text in str(caught.value)


def test_a_micro_step_that_does_not_divide_the_macro_step_is_refused():
    data = (
        "title: t\ntime: {stop: 1 s, macro_step: 5 ms, output_step: 5 ms, checkpoint_step: 1 s}\n"
        "components:\n  arm: {kind: bullet_pendulum, parameter_set: pendulum_arm, micro_step: 2 ms}\n"
    )
    with pytest.raises(InputError, match="must divide"):
        parse_scenario(data, Path("own.yaml"))
