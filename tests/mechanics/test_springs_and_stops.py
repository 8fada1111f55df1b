"""Springs between their stops, at them and under load, against closed forms."""

import math

import numpy as np
import pytest

from mechanics.bullet import World, woven
from mechanics.fabric import layout
from mechanics.solver import SolverSettings

from .designs import HOT, REST, prototype

WEIGHTLESS = {"gravity": (0.0, 0.0, 0.0)}
#: Springs and stops between which 240 to 300 N/m find their balance.
BETWEEN = {"steel_stiffness": 400.0, "steel_rest_length": 0.046, "length_hot": 0.020}


def apart(design, length):
    """All links at rest, flat, at one length and too far from each other to touch."""
    motion = woven(design, layout(design))
    motion.position[:, 0] += 20.0 * np.arange(design.links)
    motion.orientation[:] = (0.0, 0.0, 0.0, 1.0)
    motion.slide[:] = 100 * (length - design.length_cold)
    return motion


def lengths(design, stiffness, start, steps, micro_step=5e-4, springs="motor"):
    """Lengths of all links [m] after every micro-step, shape (steps, link)."""
    world = World(design, layout(design), SolverSettings(micro_step, 50, 1e-3, springs), apart(design, start))
    k, r = np.full(2 * design.links, stiffness), np.full(2 * design.links, REST)
    found = []
    for _ in range(steps):
        world.advance(1, k, r)
        found.append(design.length_cold + world.motion().slide / 100)
    world.close()
    return np.array(found)


def balance(stiffness, load=0.0):
    """Length at which 2 k_s (b - l) + load = 2 k (l - r) [m], with the steel springs of `BETWEEN`."""
    return (stiffness * REST + 400.0 * 0.046 + load / 2) / (stiffness + 400.0)


@pytest.mark.parametrize("springs", ["force", "motor"])
@pytest.mark.parametrize("stiffness", [240.0, 270.0, 300.0])
def test_springs_hold_a_link_where_their_forces_balance(stiffness, springs):
    design = prototype(tether_rows=0, **BETWEEN, **WEIGHTLESS)
    expected = balance(stiffness)
    assert design.length_hot < expected < design.length_cold
    # Nothing moves it from there but the rounding of Bullet's own arithmetic.
    np.testing.assert_allclose(lengths(design, stiffness, expected, 400, springs=springs)[-1], expected, atol=1e-9)


@pytest.mark.parametrize("springs", ["force", "motor"])
def test_springs_carry_a_weight_where_their_forces_balance_it(springs):
    # A link held by its back half; 50 g's of gravity pull its front half (half the link's mass) with 1.8 N.
    design = prototype(tether_rows=1, tether_kind="hanging", gravity=(0.0, 490.0, 0.0), **BETWEEN)
    expected = balance(300.0, design.link_mass / 2 * 490.0)
    assert expected - balance(300.0) > 1e-3
    held = layout(design).is_fixed
    assert held.sum() == 2
    found = lengths(design, 300.0, expected, 400, springs=springs)[-1, held]
    np.testing.assert_allclose(found, expected, atol=1e-9)


@pytest.mark.parametrize("springs", ["force", "motor"])
def test_a_free_link_swings_at_the_frequency_of_its_springs_without_loss(springs):
    design = prototype(tether_rows=0, **BETWEEN, **WEIGHTLESS)
    middle, amplitude, step = balance(270.0), 1e-3, 1e-4
    swing = lengths(design, 270.0, middle + amplitude, 400, step, springs)[:, 0] - middle
    # Halves of mass m / 2 move against each other like m / 4, on 2 (k + k_s). The symplectic Euler method turns by
    # 2 asin(omega dt / 2) in each step and keeps the amplitude within omega dt / 2, here 4 %.
    omega = math.sqrt(2 * (270.0 + 400.0) / (design.link_mass / 4))
    turn = 2 * math.asin(omega * step / 2)
    np.testing.assert_allclose(swing, amplitude * np.cos(turn * np.arange(1, 401)), atol=0.05 * amplitude)
    assert swing[-80:].max() == pytest.approx(amplitude, rel=0.01)


@pytest.mark.parametrize("micro_step", [1e-3, 5e-4, 2.5e-4, 1.25e-4])
def test_a_link_heated_at_once_ends_at_its_stop_without_passing_it(micro_step):
    design = prototype(tether_rows=0, **WEIGHTLESS)
    found = lengths(design, HOT, design.length_cold, round(0.05 / micro_step), micro_step)
    # 6 N on a quarter of 7.3 g reach 4 m/s, more than a millimetre in a step. It must still land there.
    np.testing.assert_allclose(found[-1], design.length_hot, atol=1e-9)
    assert found.min() > design.length_hot - 1e-9


def test_springs_as_forces_pass_their_stop_by_a_step_and_return():
    design = prototype(tether_rows=0, **WEIGHTLESS)
    found = lengths(design, HOT, design.length_cold, 400, springs="force")
    # What Bullet's stop, active only once it is passed, lets through: speed times micro-step, less than 2 mm here.
    assert design.length_hot - 2e-3 < found.min() < design.length_hot - 1e-4
    np.testing.assert_allclose(found[-1], design.length_hot, atol=2e-4)


def test_a_stop_holds_what_a_load_adds_to_the_springs():
    # Cold springs and 1.8 N of weight both press a held link's slide on its outer stop.
    design = prototype(tether_rows=1, tether_kind="hanging", gravity=(0.0, 490.0, 0.0))
    found = lengths(design, 157.1, design.length_cold, 1000)[:, layout(design).is_fixed]
    # Bullet corrects a fiftieth of what has passed the stop in each step: what 500 m/s^2 pass in one step, no more.
    assert np.abs(found - design.length_cold).max() < 2.5e-4
    assert np.abs(found[-100:] - design.length_cold).max() < 2.5e-5


def test_a_load_pulls_a_link_off_the_inner_stop_only_when_it_is_stronger_than_the_springs():
    def held_length(acceleration):
        design = prototype(tether_rows=1, tether_kind="hanging", gravity=(0.0, acceleration, 0.0))
        return lengths(design, HOT, design.length_hot, 40)[-1, layout(design).is_fixed]

    design = prototype()
    # Springs press on the inner stop with 2 (k (l - r) - k_s (b - l)); the load is that of half a link.
    steel = design.steel_stiffness * (design.steel_rest_length - design.length_hot)
    limit = 2 * (HOT * (design.length_hot - REST) - steel) / (design.link_mass / 2)
    np.testing.assert_allclose(held_length(0.99 * limit), design.length_hot, atol=1e-9)
    assert (held_length(1.01 * limit) > design.length_hot + 1e-5).all()
