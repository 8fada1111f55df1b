"""Momentum, friction and energy of links in contact."""

import math

import numpy as np
import pytest

from mechanics.bullet import SCALE, World, rotation, woven
from mechanics.fabric import layout
from mechanics.half import half
from mechanics.solver import SolverSettings

from .designs import COLD, HOT, REST, SOLVER, prototype


def momenta(world, design):
    """Linear [kg m/s] and angular momentum about the origin [kg m^2/s] of all links, shape (3,) each."""
    m, part = world.motion(), half(design)
    axes = rotation(m.orientation)
    along = axes[:, :, 1]
    gap = design.bar_distance_cold + m.slide / SCALE - 2 * part.centre
    back, arm = m.position / SCALE, gap[:, None] * along
    speed = m.velocity / SCALE
    front_speed = speed + np.cross(m.angular_velocity, arm) + (m.slide_rate / SCALE)[:, None] * along
    spin = np.einsum("lij,j,lkj,lk->li", axes, np.array(part.inertia), axes, m.angular_velocity)
    linear = part.mass * (speed + front_speed).sum(axis=0)
    angular = part.mass * (np.cross(back, speed) + np.cross(back + arm, front_speed)).sum(axis=0) + 2 * spin.sum(axis=0)
    return linear, angular


def lost_momenta(stiffness, micro_step):
    """Momenta that a free fabric loses in 0.1 s, as shares of what all links moving alike would have."""
    design = prototype(tether_rows=0, gravity=(0.0, 0.0, 0.0))
    start = woven(design, layout(design))
    start.velocity += np.random.default_rng(7).uniform(-20.0, 20.0, start.velocity.shape)  # cm/s
    world = World(design, layout(design), SolverSettings(micro_step, 200, 1e-3, "motor"), start)
    before, turning = momenta(world, design)
    for k in (COLD, stiffness):
        world.advance(round(0.05 / micro_step), np.full(2 * design.links, k), np.full(2 * design.links, REST))
    assert world.contacts().count > 50
    after, turned = momenta(world, design)
    world.close()
    most = design.links * design.link_mass * 0.2  # all links at the fastest start
    return np.abs(after - before).max() / most, np.abs(turned - turning).max() / (most * 0.05)


def test_contacts_springs_and_stops_keep_the_momenta_of_a_free_fabric():
    linear, angular = lost_momenta(COLD, 5e-4)
    # Impulses come in pairs, but Bullet moves links by Euler steps: 0.011 % and 0.005 % were measured.
    assert linear < 3e-4
    assert angular < 3e-4


def test_the_momentum_lost_by_contracting_links_is_of_first_order_in_the_micro_step():
    # Speeds reach 4 m/s when all springs are heated at once; 0.59 % and 0.28 % were measured.
    coarse, fine = (lost_momenta(HOT, step)[0] for step in (5e-4, 2.5e-4))
    assert coarse < 0.01
    assert math.log2(coarse / fine) == pytest.approx(1.0, abs=0.3)


@pytest.mark.parametrize(("slope", "slides"), [(0.70, False), (0.80, True)])
def test_a_link_slides_on_another_beyond_the_slope_of_its_friction(slope, slides):
    angle, g = math.atan(slope), 9.81
    design = prototype(friction=0.73, gravity=(0.0, g * math.sin(angle), -g * math.cos(angle)))
    start = woven(design, layout(design))
    # Link 17 lies flat on the held link 1, arm on arm; everything else is far away.
    start.position[:, 0] = 100.0 * np.arange(1, design.links + 1)
    start.orientation[:] = (0.0, 0.0, 0.0, 1.0)
    start.position[1] = (0.0, 0.0, 0.0)
    shorter = SCALE * (layout(design).bar_distance[1] - design.bar_distance_cold)
    start.position[17] = (0.0, shorter / 2, SCALE * design.bar_diameter)
    world = World(design, layout(design), SOLVER, start)
    stiffness, rest = np.full(2 * design.links, COLD), np.full(2 * design.links, REST)
    world.advance(100, stiffness, rest)
    settled = world.motion().velocity[17, 1] / SCALE
    world.advance(100, stiffness, rest)
    gained = world.motion().velocity[17, 1] / SCALE - settled
    world.close()
    # Coulomb: g (sin - 0.73 cos) where it slides, 0 where it does not; the solver's rest is 2 % of g over 50 ms.
    expected = 0.05 * g * (math.sin(angle) - 0.73 * math.cos(angle)) if slides else 0.0
    assert gained == pytest.approx(expected, abs=0.02 * 0.05 * g)
