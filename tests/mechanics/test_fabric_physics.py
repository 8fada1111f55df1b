"""Bullet against closed forms, conservation laws and the limits that stop a run."""

import math

import numpy as np
import pybullet
import pytest

from cosim.unit import Unit, UnitError
from mechanics.bullet import SolverSettings, World, woven
from mechanics.fabric import layout
from mechanics.hanging_mass import HangingMassUnit

from .designs import COLD, HOT, REST, SOLVER, STEP, advance, prototype, woven_unit

WEIGHTLESS = {"gravity": (0.0, 0.0, 0.0)}


@pytest.mark.parametrize("stiffness", [220.0, 260.0, 300.0])
def test_springs_hold_a_link_where_their_forces_balance(stiffness):
    # Long thin links without gravity touch nothing on their way; the balance lies between the stops:
    # k (l - r) = k_s (b - l).  A slide has no friction, so the mean over its swing is the balance.
    design = prototype(bar_diameter=5e-3, length_offset=0.0, steel_stiffness=150.0, steel_rest_length=0.07,
                       length_cold=0.040, length_hot=0.015, tether_rows=0, **WEIGHTLESS)  # fmt: skip
    balance = (stiffness * REST + 150.0 * 0.07) / (stiffness + 150.0)
    world = World(design, layout(design), SolverSettings(5e-4, 50, 1e-3), woven(design, layout(design)))
    start = world.motion().copy()
    start.slide[:] = 100 * (balance - design.length_cold)
    world.close()
    world = World(design, layout(design), SolverSettings(5e-4, 50, 1e-3), start)
    k, r = np.full(2 * design.links, stiffness), np.full(2 * design.links, REST)
    world.advance(200, k, r)
    length = design.length_cold + world.motion().slide / 100
    world.close()
    # Left at the balance it stays there: 1e-6 m is the rounding of Bullet's contact margin.
    np.testing.assert_allclose(length, balance, atol=1e-6)


def test_a_stop_takes_the_whole_spring_force():
    design = prototype(tether_rows=0, **WEIGHTLESS)
    unit = woven_unit(design)
    series = advance(unit, 0.5)
    unit.terminate()
    # Cold springs push every free link against its outer stop; it may give by less than 0.02 mm.
    np.testing.assert_allclose(series["link_length"][-10:], design.length_cold, atol=2e-5)


def test_the_tension_reported_is_that_of_hookes_law():
    unit = woven_unit(prototype(), stiffness=200.0)
    advance(unit, 0.1)
    extension = np.repeat(unit.get("link_length"), 2) - REST
    np.testing.assert_allclose(unit.get("extension"), extension, rtol=1e-12)
    np.testing.assert_allclose(unit.get("tension"), 200.0 * extension, rtol=1e-12)
    unit.terminate()


def test_a_fabric_without_tether_falls_like_a_stone():
    design = prototype(tether_rows=0)
    unit = woven_unit(design)
    mass = design.link_mass * design.links
    before = unit.get("position").mean(axis=0)
    advance(unit, 0.2)
    fallen = before - unit.get("position").mean(axis=0)
    unit.terminate()
    # 400 symplectic Euler steps of 0.5 ms fall g t (t + dt) / 2; internal forces cannot move the centre of mass.
    # The middle of a link is not its centre of mass where halves differ in speed: 0.02 mm.
    assert fallen == pytest.approx([0, 0, 0.5 * 9.81 * 0.2 * 0.2005], abs=2e-5)
    assert mass == pytest.approx(0.1314)


def test_energy_never_grows_without_supply():
    unit = woven_unit(prototype())
    series = advance(unit, 3.0)
    unit.terminate()
    total = series["kinetic_energy"] + series["potential_energy"]
    # The springs hold 2 J; a stop that gives by 0.02 mm under 3.8 N moves 0.1 mJ in and out of them.
    rise = np.maximum.accumulate(total[::-1])[::-1][:-1] - total[:-1]
    assert rise.max() < 2e-4 * abs(total).max()
    assert total[-1] < total[0] - 5e-3  # the drape lost height and gave its energy to friction


def test_the_cold_drape_comes_to_rest_without_overlaps():
    unit = woven_unit(prototype())
    series = advance(unit, 3.0)
    unit.terminate()
    assert series["max_penetration"].max() < 2e-4  # a fiftieth of a bar
    assert series["kinetic_energy"][-50:].max() < 1e-4
    assert 8.0 < series["max_curvature"][-1] < 20.0
    assert series["contact_count"][-1] > 50


def test_heating_straightens_the_fabric():
    unit = woven_unit(prototype())
    cold = advance(unit, 2.0)["max_curvature"][-50:].mean()
    unit.set("stiffness", np.full(36, HOT))
    hot = advance(unit, 2.5, 2_000_000_000)["max_curvature"][-50:].mean()
    unit.terminate()
    assert hot < cold / 3


def test_the_direction_of_gravity_decides_where_the_fabric_goes():
    tips = {}
    for name, gravity in (("down", (0.0, 0.0, -9.81)), ("up", (0.0, 0.0, 9.81)), ("none", (0.0, 0.0, 0.0))):
        unit = woven_unit(prototype(gravity=gravity))
        advance(unit, 0.6)
        tips[name] = unit.get("row_centre")[-1, 2]
        unit.terminate()
    assert tips["down"] < tips["none"] - 0.01 < tips["none"] + 0.01 < tips["up"]


def test_held_links_stay_where_they_are():
    unit = woven_unit(prototype())
    before = unit.get("position").copy()
    advance(unit, 0.5)
    np.testing.assert_array_equal(unit.get("position")[:6], before[:6])
    assert np.abs(unit.get("position")[6:] - before[6:]).max() > 1e-3
    unit.terminate()


def test_friction_between_two_bodies_is_the_coefficient_of_the_design():
    world = World(prototype(), layout(prototype()), SOLVER, woven(prototype(), layout(prototype())))
    one, other = (pybullet.getDynamicsInfo(world._bodies[i], 0, world._client)[1] for i in (3, 8))
    damping = pybullet.getDynamicsInfo(world._bodies[8], 0, world._client)
    world.close()
    assert one * other == pytest.approx(0.73, rel=1e-12)
    assert damping[5] == 0.0  # restitution


def test_ten_thousand_iterations_are_possible():
    unit = woven_unit(prototype(), solver=SolverSettings(5e-4, 10_000, 1e-3))
    unit.do_step(0, 1_000_000)
    assert unit.get("max_penetration") < 1e-4
    unit.terminate()


@pytest.mark.parametrize("name", ["iterations", "micro_step", "penetration_limit"])
def test_solver_settings_must_be_positive(name):
    with pytest.raises(ValueError, match=name):
        SolverSettings(**{"iterations": 50, "micro_step": 5e-4, "penetration_limit": 1e-3, name: 0})


def test_a_repeated_fabric_moves_the_same_to_the_last_bit():
    positions = []
    for _ in range(2):
        unit = woven_unit(prototype())
        advance(unit, 0.5)
        positions.append(unit.get("position").copy())
        unit.terminate()
    assert np.array_equal(*positions)


def test_a_resumed_fabric_goes_on_like_the_one_that_was_not_stopped():
    unit = woven_unit(prototype())
    advance(unit, 0.3)
    state = unit.checkpoint()
    other = woven_unit(prototype())
    other.resume(state, 300_000_000)
    for one in (unit, other):
        advance(one, 0.3, 300_000_000)
    for name in unit.variables:
        assert np.array_equal(unit.get(name), other.get(name)), name
    unit.terminate()
    other.terminate()


def test_links_that_overlap_too_much_stop_the_run_by_name():
    unit = woven_unit(prototype(), solver=SolverSettings(5e-4, 50, 1e-7))
    with pytest.raises(UnitError, match=r"fabric at t = .* s: link \d+ \(row \d, place \d\) and link \d+ .* overlap by"):
        advance(unit, 1.0)
    unit.terminate()


def displaced(unit, link, by):
    state = unit.checkpoint()
    state["motion.position"][link] += 100 * np.array(by)
    unit.resume(state, 0)


def test_a_link_torn_free_stops_the_run_by_name():
    unit = woven_unit(prototype())
    displaced(unit, 17, (0.0, 0.1, 0.0))
    with pytest.raises(UnitError, match=r"is torn free of .*hooks open"):
        unit.do_step(0, STEP)
    unit.terminate()


def test_a_pose_that_is_no_number_stops_the_run():
    unit = woven_unit(prototype())
    displaced(unit, 17, (math.nan, 0.0, 0.0))
    with pytest.raises(UnitError, match=r"position of link 18 .* is not finite"):
        unit.do_step(0, STEP)
    unit.terminate()


def test_a_negative_stiffness_is_refused_by_coil():
    unit = woven_unit(prototype())
    unit.set("stiffness", np.where(np.arange(36) == 6, -1.0, COLD))
    with pytest.raises(UnitError, match="stiffness of coil 7 is -1"):
        unit.do_step(0, STEP)
    unit.terminate()


def test_a_macro_step_that_the_micro_step_does_not_divide_is_refused():
    unit = woven_unit(prototype())
    with pytest.raises(UnitError, match="no multiple of the micro-step"):
        unit.do_step(0, 700_000)
    unit.terminate()


def test_markers_and_coordinates_describe_the_last_links_of_the_rows():
    unit = woven_unit(prototype())
    assert isinstance(unit, Unit)
    kinds = unit.coordinates["link_kind"].values
    assert "".join(kinds[:3]) == "ABA"
    markers = unit.get("marker_position").reshape(6, 2, 3)
    np.testing.assert_allclose(markers.mean(axis=1), unit.get("row_centre"), rtol=1e-12)
    assert (np.linalg.norm(markers[:, 1] - markers[:, 0], axis=1) > 0.03).all()
    unit.terminate()


def test_a_hanging_mass_stretches_its_coil_by_its_weight():
    unit = HangingMassUnit("load", 2, 0.5)
    unit.set("stiffness", np.array([157.1, 356.0]))
    unit.set("rest_length", np.full(2, REST))
    unit.initialise(0)
    np.testing.assert_allclose(unit.get("extension"), 0.5 * 9.81 / np.array([157.1, 356.0]), rtol=1e-14)
    np.testing.assert_allclose(unit.get("length"), REST + unit.get("extension"), rtol=1e-14)
    unit.set("stiffness", np.array([157.1, 0.0]))
    with pytest.raises(UnitError, match="coil 1 is 0"):
        unit.do_step(0, 1)
