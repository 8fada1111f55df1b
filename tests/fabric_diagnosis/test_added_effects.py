"""Added mechanical effects in Bullet against closed forms, on links that touch nothing."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from cosim.assemble import assemble
from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.errors import InputError
from mechanics.added import AddedEffects, tilted
from mechanics.bullet import World, woven
from mechanics.fabric import layout
from mechanics.half import half
from mechanics.solver import SolverSettings
from tests.mechanics.designs import REST, prototype, woven_unit
from tests.mechanics.test_springs_and_stops import BETWEEN, WEIGHTLESS, apart

STIFFNESS = 270.0
STEP = 2.5e-4


def world(design, length, springs="force"):
    return World(design, layout(design), SolverSettings(STEP, 50, 1e-3, springs), apart(design, length))


def slides(design, length, steps, stiffness=STIFFNESS):
    """Length of the first free link [m] after every micro-step."""
    made = world(design, length)
    k, r = np.full(2 * design.links, stiffness), np.full(2 * design.links, REST)
    found = []
    for _ in range(steps):
        made.advance(1, k, r)
        found.append(design.length_cold + made.motion().slide[-1] / 100)
    made.close()
    return np.array(found)


def balance(design, rest=REST, stiffness=STIFFNESS):
    """Length at which coils and steel springs balance [m]."""
    k, s = stiffness, design.steel_stiffness
    return (k * rest + s * design.steel_rest_length) / (k + s)


@pytest.mark.parametrize(("share", "moves"), [(0.8, False), (1.2, True)])
def test_a_slide_stands_until_its_springs_overcome_its_friction(share, moves):
    design = prototype(**WEIGHTLESS, **BETWEEN, added=AddedEffects(slide_friction=0.5))
    reach = 0.5 / (2 * (STIFFNESS + design.steel_stiffness))  # friction over the constant of all four springs
    begin = balance(design) + share * reach
    end = slides(design, begin, 400)[-1]
    # single precision of Bullet's positions: micrometres
    assert (abs(end - begin) > 0.1 * reach) == moves
    assert abs(end - balance(design)) < 1.01 * max(share, 1.0) * reach


def test_a_damped_slide_loses_its_swing_at_the_rate_of_its_damping():
    damping = 0.05
    design = prototype(**WEIGHTLESS, **BETWEEN, added=AddedEffects(slide_damping=damping))
    swing = slides(design, balance(design) + 5e-4, 1200) - balance(design)
    reduced = half(design).mass / 2  # two halves against each other
    rate = damping / (2 * reduced)
    peaks = [i for i in range(1, len(swing) - 1) if swing[i - 1] < swing[i] >= swing[i + 1]]
    times, sizes = STEP * np.array(peaks), swing[peaks]
    found = -np.polyfit(times, np.log(sizes), 1)[0]
    # peaks are read at micro-steps, which cuts up to 1 % off each
    assert found == pytest.approx(rate, rel=0.05)


@pytest.mark.parametrize(
    ("added", "rest"),
    [
        (AddedEffects(coil_play=1e-3), REST + 1e-3),
        (AddedEffects(coil_contraction=1e-5), REST - 1e-5 * (STIFFNESS - 157.1)),
    ],
)
def test_play_and_contraction_move_the_balance_of_the_springs(added, rest):
    damped = AddedEffects(**{**vars(added), "slide_damping": 1.0})
    design = prototype(**WEIGHTLESS, **BETWEEN, added=damped)
    assert slides(design, balance(design), 800)[-1] == pytest.approx(balance(design, rest), abs=2e-6)


def test_a_wire_carries_the_end_of_its_row_like_a_spring():
    stiffness = 40.0
    # pulled along its slide, with the far half below: it hangs, and does not turn
    design = prototype(gravity=(0.0, 9.81, 0.0), added=AddedEffects(wire_stiffness=stiffness))
    seats = woven(design, layout(design)).position
    motion = apart(design, design.length_cold)
    motion.position[-1] = seats[-1]
    motion.position[:-1, 0] += 100.0
    made = World(design, layout(design), SolverSettings(STEP, 50, 1e-3, "motor"), motion)
    k, r = np.full(2 * design.links, 157.1), np.full(2 * design.links, REST)
    falls, frequency = [], math.sqrt(stiffness / design.link_mass)
    times = STEP * np.arange(1, 401)
    for _ in times:
        made.advance(1, k, r)
        falls.append((made.motion().position[-1, 1] - seats[-1, 1]) / 100)
    made.close()
    expected = 9.81 / frequency**2 * (1 - np.cos(frequency * times))
    # the symplectic step is half a step early: omega h / 2 = 1 % of the amplitude
    np.testing.assert_allclose(falls, expected, atol=0.015 * np.max(expected))


def test_a_payload_pulls_the_last_row_with_its_weight():
    design = prototype(gravity=(0.0, -9.81, 0.0), added=AddedEffects(payload=6e-3))
    made = world(design, design.length_cold, "motor")
    k, r = np.full(2 * design.links, 157.1), np.full(2 * design.links, REST)
    made.advance(400, k, r)
    speed = made.motion().velocity[:, 1] / 100 / 0.1
    made.close()
    assert speed[-1] == pytest.approx(-9.81 * (1 + 2e-3 / design.link_mass), rel=1e-4)
    assert speed[-4] == pytest.approx(-9.81, rel=1e-4)


def test_friction_in_hinges_holds_a_fabric_up():
    def fall(**added):
        unit = woven_unit(prototype(rows=4, added=AddedEffects(**added)))
        for index in range(15):
            unit.do_step(index * 10_000_000, 10_000_000)
        end = unit.get("row_centre")[-1, 2]
        unit.terminate()
        return end

    # it drapes by millimetres; starts that differ by 1 mm/s scatter by 0.1 mm, a lever of 5 mm lifts it by 0.5 mm
    assert fall(hinge_friction=5e-3) - fall() > 3e-4


def test_a_tilted_stand_turns_gravity():
    assert tilted((0.0, 0.0, -9.81), 0.0, 0.0) == (0.0, 0.0, -9.81)
    x, y, z = tilted((0.0, 0.0, -9.81), math.radians(30), 0.0)
    assert (x, y, z) == pytest.approx((0.0, -9.81 / 2, -9.81 * math.sqrt(0.75)))
    leaning = tilted((0.0, 0.0, -9.81), 0.2, -0.3)
    assert np.linalg.norm(leaning) == pytest.approx(9.81)
    assert leaning[0] < 0


def test_random_starts_repeat_and_differ():
    def drop(**changes):
        unit = woven_unit(prototype(rows=3, **changes))
        for index in range(3):
            unit.do_step(index * 10_000_000, 10_000_000)
        found = unit.get("position").copy()
        unit.terminate()
        return found

    first, again, other = (drop(start_speed=1e-3, start_number=n) for n in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    # 1 mm/s over 30 ms: up to 30 micrometres, the smaller the more contacts stop it
    assert 1e-7 < np.abs(first - other).max() < 1e-3
    np.testing.assert_array_equal(drop(), drop(start_number=5))


@pytest.mark.parametrize("change", [{"slide_friction": -0.1}, {"payload": math.nan}, {"coil_play": -1e-3}])
def test_effects_that_would_give_energy_are_refused(change):
    with pytest.raises(ValueError, match=next(iter(change))):
        AddedEffects(**change)


def test_a_scenario_sets_them_and_is_told_what_does_not_go():
    source = Path(load_scenario("passive_drape").path or "")

    def built(given: str):
        named = "parameter_set: prototype_links"
        text = source.read_text().replace("    solver: {friction_anchors: true}\n", "")
        assembly = assemble(parse_scenario(text.replace(named, f"{named}\n    {given}"), source))
        assembly.system.terminate()
        return assembly.system.units["fabric"].design  # type: ignore[attr-defined]

    given = "parameters: {slide_friction: 0.1 N, tilt: 3 deg, start_speed: 1 mm/s, start_number: 2}"
    design = built(given)
    assert design.added == AddedEffects(slide_friction=0.1)
    assert design.gravity[1] == pytest.approx(-9.81 * math.sin(math.radians(3)))
    assert (design.start_speed, design.start_number) == (1e-3, 2)
    with pytest.raises(InputError, match="springs as motors"):
        built(given + "\n    solver: {springs: motor}")
