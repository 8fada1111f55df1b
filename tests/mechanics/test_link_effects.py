"""Effects of one link, in Bullet and in MuJoCo, against closed forms, on links that touch nothing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.assemble import assemble
from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.errors import InputError
from mechanics.added import AddedEffects, LinkEffects
from mechanics.bullet import World
from mechanics.fabric import layout
from mechanics.mujoco_world import MujocoWorld
from mechanics.solver import SolverSettings
from tests.mechanics.designs import COLD, REST, prototype, woven_unit
from tests.mechanics.test_springs_and_stops import BETWEEN, WEIGHTLESS, apart

WORLDS = {"bullet": World, "mujoco": MujocoWorld}
STIFFNESS, MICRO = 270.0, 2.5e-4
#: The last link of the prototype, and the one beside it.
LINK, OTHER = 17, 16


def length_of(engine, link, stiffness=STIFFNESS, start=None, **effects):
    """Where a link comes to rest [m], with effects in the last one."""
    added = AddedEffects(slide_damping=1.0, links=((LINK, LinkEffects(**effects)),))
    design = prototype(**WEIGHTLESS, **BETWEEN, added=added)
    begin = balance(stiffness) if start is None else start
    made = WORLDS[engine](design, layout(design), SolverSettings(MICRO, 50, 1e-3, "force"), apart(design, begin))
    made.advance(800, np.full(2 * design.links, stiffness), np.full(2 * design.links, REST))
    found = design.length_cold + made.motion().slide[link] / 100
    made.close()
    return found


def balance(coil, steel=BETWEEN["steel_stiffness"]):
    """Length at which coils and steel springs balance [m]."""
    return (coil * REST + steel * BETWEEN["steel_rest_length"]) / (coil + steel)


@pytest.mark.parametrize("engine", WORLDS)
@pytest.mark.parametrize(
    ("effects", "expected"),
    [
        ({}, balance(270.0)),
        ({"steel_loss": 0.2}, balance(270.0, 320.0)),
        ({"coil_loss": 0.1}, balance(243.0)),
        # of 270 - 157.1 N/m, by which the coil is stiffer than cold, a third is missing
        ({"heat_loss": 1 / 3}, balance(157.1 + 2 / 3 * 112.9)),
        ({"heat_loss": 0.3, "coil_loss": 0.05}, balance(0.95 * (157.1 + 0.7 * 112.9))),
    ],
)
def test_the_springs_of_one_link_balance_where_what_is_left_of_them_balances(engine, effects, expected):
    design = prototype(**BETWEEN)
    assert design.length_hot < expected < design.length_cold
    assert length_of(engine, LINK, **effects) == pytest.approx(expected, abs=5e-6)
    assert length_of(engine, OTHER, **effects) == pytest.approx(balance(270.0), abs=5e-6)


@pytest.mark.parametrize("engine", WORLDS)
def test_a_jammed_link_stays_where_it_is_and_others_do_not(engine):
    begin = balance(STIFFNESS) + 1e-3
    assert length_of(engine, LINK, start=begin, slide_friction=20.0) == pytest.approx(begin, abs=1e-5)
    assert length_of(engine, OTHER, start=begin, slide_friction=20.0) == pytest.approx(balance(STIFFNESS), abs=5e-6)


def test_a_coil_that_is_not_heated_is_as_stiff_as_a_cold_one():
    unheated = AddedEffects(links=((1, LinkEffects(heat_loss=1.0)),))
    given = np.array([390.0, 390.0, 390.0, 100.0])
    assert unheated.coil_stiffness(given).tolist() == [390.0, 390.0, 157.1, 100.0]
    plain = AddedEffects()
    assert plain.coil_stiffness(given) is given


def test_tension_and_energy_are_of_the_springs_that_are_there():
    effects = ((LINK, LinkEffects(steel_loss=1.0, coil_loss=0.25)),)
    units = [woven_unit(prototype(added=AddedEffects(links=links))) for links in ((), effects)]
    whole, less = units
    tension = [u.get("tension")[[2 * OTHER, 2 * LINK]] for u in units]
    assert tension[1] == pytest.approx(tension[0] * [1.0, 0.75])
    length = whole.get("link_length")[LINK]
    design = whole.design
    steel = 2 * 0.5 * design.steel_stiffness * (design.steel_rest_length - length) ** 2
    coils = 2 * 0.25 * 0.5 * COLD * (length - REST) ** 2
    missing = float(whole.get("potential_energy") - less.get("potential_energy"))
    assert missing == pytest.approx(steel + coils, rel=1e-6)
    for unit in units:
        unit.terminate()


@pytest.mark.parametrize(
    ("effects", "problem"),
    [
        ({"steel_loss": 1.1}, "steel_loss is 1.1: give a share from 0 to 1"),
        ({"coil_loss": -0.1}, "coil_loss is -0.1"),
        ({"heat_loss": float("nan")}, "heat_loss is nan"),
        ({"slide_friction": -1.0}, "slide_friction is -1.0: give zero or a positive number"),
    ],
)
def test_shares_beyond_all_and_friction_that_drives_are_refused(effects, problem):
    with pytest.raises(ValueError, match=problem):
        LinkEffects(**effects)


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        ("'steel_loss[25]': 0.5", r"steel_loss\[25\]: the fabric has links 1 to 24"),
        ("'steel_loss[0]': 0.5", r"steel_loss\[0\]: the fabric has links 1 to 24"),
        ("'steel_loss[2]': 0.5", "link 2 is held, and what is given of its slide does nothing.*is link 7"),
        ("'stel_loss[8]': 0.5", "a link has no parameter `stel_loss`; did you mean `steel_loss`?"),
        ("'steel_loss[8]': 2", r"steel_loss\[8\]: it is 2\n"),
        ("'slide_friction[8]': 3 m", r"slide_friction\[8\]: `3 m` is no quantity in N"),
        ("slide_friction: 3 m", "slide_friction: `3 m` is no quantity in N"),
    ],
)
def test_a_scenario_is_told_what_does_not_go(given, problem):
    with pytest.raises(InputError, match=problem.replace("?", r"\?")):
        _built(f"parameters: {{{given}}}")


def _built(given):
    source = Path(load_scenario("passive_drape").path or "")
    named = "parameter_set: prototype_links"
    text = source.read_text().replace("    solver: {friction_anchors: true}\n", "")
    assembly = assemble(parse_scenario(text.replace(named, f"{named}\n    {given}"), source))
    assembly.system.terminate()
    return assembly.system.units["fabric"].design


def test_a_scenario_gives_links_their_effects_by_number():
    design = _built("parameters: {'steel_loss[8]': 50 %, 'slide_friction[8]': 2 N, 'heat_loss[10]': 1}")
    assert design.added.links == ((7, LinkEffects(steel_loss=0.5, slide_friction=2.0)), (9, LinkEffects(heat_loss=1.0)))
    with pytest.raises(InputError, match="springs as motors"):
        _built("parameters: {'slide_friction[8]': 2 N}\n    solver: {springs: motor}")
