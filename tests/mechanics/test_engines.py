"""One contract for the fabric in every engine, closed forms in MuJoCo, and what only one engine can do."""

from __future__ import annotations

import importlib
import math
from dataclasses import replace

import numpy as np
import pytest

from cosim.assemble import assemble
from cosim.cli import WRONG_INPUT, main
from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Unit, UnitError
from mechanics import mujoco_world
from mechanics.added import AddedEffects
from mechanics.bullet import World as BulletWorld
from mechanics.fabric import layout
from mechanics.motion import woven
from mechanics.mujoco_world import MujocoWorld
from mechanics.solver import SolverSettings
from tests.mechanics.designs import COLD, HOT, REST, STEP, advance, prototype, woven_unit
from tests.mechanics.test_springs_and_stops import BETWEEN, WEIGHTLESS, apart

ENGINES = ("bullet", "mujoco")
COARSE = {name: SolverSettings(5e-4, 50, 1e-3, engine=name) for name in ENGINES}
STIFFNESS, MICRO = 270.0, 2.5e-4


@pytest.fixture(params=ENGINES)
def engine(request):
    return request.param


def small(engine, **changes):
    """3 x 2 links, the first row held, in the engine."""
    settings = replace(COARSE[engine], **changes.pop("settings", {}))
    return woven_unit(prototype(rows=3, tether_rows=1, **changes), solver=settings)


def displaced(unit, by, what="position"):
    state = unit.checkpoint()
    state[f"motion.{what}"][-1] += np.array(by)
    unit.resume(state, 0)


def test_a_fabric_is_a_unit_with_the_same_variables_in_every_engine(engine):
    unit, other = small(engine), small("bullet")
    assert isinstance(unit, Unit)
    assert {n: (v.shape, v.unit, v.causality) for n, v in unit.variables.items()} == {
        n: (v.shape, v.unit, v.causality) for n, v in other.variables.items()
    }
    for name in unit.variables:
        assert np.isfinite(unit.get(name)).all(), name
    for name in ("position", "orientation", "link_length", "marker_position", "potential_energy"):
        np.testing.assert_allclose(unit.get(name), other.get(name), atol=1e-12)
    unit.terminate()
    unit.terminate()
    other.terminate()


def test_a_repeated_fabric_is_the_same_to_the_last_bit(engine):
    found = []
    for _ in range(2):
        unit = small(engine)
        advance(unit, 0.1)
        found.append(unit.get("position").copy())
        unit.terminate()
    assert np.array_equal(*found)


def test_a_resumed_fabric_goes_on_as_the_one_that_was_not_stopped(engine):
    unit, other = small(engine), small(engine)
    unit.set("stiffness", np.linspace(COLD, HOT, 18))
    advance(unit, 0.1)
    other.resume(unit.checkpoint(), 100_000_000)
    for one in (unit, other):
        advance(one, 0.1, 100_000_000)
    for name in unit.variables:
        assert np.array_equal(unit.get(name), other.get(name)), name
        assert name in ("stiffness", "rest_length") or np.isfinite(other.get(name)).all()
    unit.terminate()
    other.terminate()


def test_a_step_can_be_repeated_in_mujoco_and_bullet_says_that_it_cannot():
    unit = small("mujoco")
    assert unit.can_restore
    advance(unit, 0.05)
    saved, before = unit.save(), unit.get("position").copy()
    ends = []
    for _ in range(2):
        advance(unit, 0.05, 50_000_000)
        ends.append({n: unit.get(n).copy() for n in unit.variables})
        unit.restore(saved, 50_000_000)
        assert np.array_equal(unit.get("position"), before)
    for name in unit.variables:
        assert np.array_equal(ends[0][name], ends[1][name]), name
    unit.release(saved)
    unit.terminate()
    bullet = small("bullet")
    assert not bullet.can_restore
    with pytest.raises(UnitError, match="Bullet cannot return to a saved state"):
        bullet.save()
    bullet.terminate()


def test_a_fabric_without_tether_falls_like_a_stone(engine):
    unit = woven_unit(prototype(rows=3, tether_rows=0), solver=COARSE[engine])
    before = unit.get("position").mean(axis=0)
    advance(unit, 0.1)
    fallen = before - unit.get("position").mean(axis=0)
    unit.terminate()
    # 200 symplectic Euler steps of 0.5 ms fall g t (t + dt) / 2; the middle of a link is not its centre of mass where
    # its halves differ in speed: 0.03 mm
    assert fallen == pytest.approx([0, 0, 0.5 * 9.81 * 0.1 * 0.1005], abs=3e-5)


def test_energy_of_a_drape_does_not_grow(engine):
    unit = small(engine, settings={"iterations": 200})
    series = advance(unit, 0.3)
    unit.terminate()
    total = series["kinetic_energy"] + series["potential_energy"]
    # The start sets the outer stops under load, which stores 3 N over hundredths of a millimetre in each: 0.2 mJ.
    assert (total - np.minimum.accumulate(total)).max() < 3e-4
    assert total[0] - total[-1] > 1e-3


def test_both_engines_drape_alike():
    tips, fallen = {}, {}
    for name in ENGINES:
        unit = woven_unit(prototype(rows=4), solver=replace(COARSE[name], iterations=200))
        before = unit.get("row_centre")[-1, 2]
        advance(unit, 0.5)
        tips[name] = unit.get("row_centre")[-1].copy()
        fallen[name] = before - tips[name][2]
        unit.terminate()
    # It falls by some millimetres; starts that differ by 1 mm/s scatter by some tenths of one.
    assert fallen["mujoco"] > 5e-3
    np.testing.assert_allclose(tips["mujoco"], tips["bullet"], atol=1.5e-3)


def test_a_link_torn_free_stops_the_run_by_name(engine):
    unit = small(engine)
    displaced(unit, (0.0, 10.0, 0.0))
    with pytest.raises(UnitError, match=r"fabric at t = .*link 9 \(row 3, place 3\).*|is torn free of"):
        unit.do_step(0, STEP)
    unit.terminate()


def test_links_that_overlap_too_much_stop_the_run_by_name(engine):
    unit = small(engine, settings={"penetration_limit": 1e-7})
    place = r"link \d+ \(row \d, place \d\)"
    with pytest.raises(UnitError, match=rf"fabric at t = .* s: {place} and {place} overlap by"):
        advance(unit, 0.5)
    unit.terminate()


def test_a_pose_that_is_no_number_stops_the_run(engine):
    unit = small(engine)
    displaced(unit, (math.nan, 0.0, 0.0))
    with pytest.raises(UnitError, match=r"position of link 9 .* is not finite|MuJoCo warns of a position"):
        unit.do_step(0, STEP)
    unit.terminate()


def test_a_world_that_diverges_is_no_fabric_at_rest(engine, tmp_path, monkeypatch):
    """MuJoCo by itself would begin anew from the start and go on as if nothing had happened."""
    monkeypatch.chdir(tmp_path)
    unit = small(engine)
    displaced(unit, (0.0, 0.0, 1e14), "velocity")
    with pytest.raises(
        UnitError, match=r"MuJoCo warns of a velocity that is not finite or too large|torn|finite|overlap"
    ):
        unit.do_step(0, STEP)
    unit.terminate()
    assert not list(tmp_path.iterdir())  # no MUJOCO_LOG.TXT in the user's folder


def test_a_negative_stiffness_and_an_odd_macro_step_are_refused(engine):
    unit = small(engine)
    with pytest.raises(UnitError, match="no multiple of the micro-step"):
        unit.do_step(0, 700_000)
    unit.set("stiffness", np.where(np.arange(18) == 6, -1.0, COLD))
    with pytest.raises(UnitError, match="stiffness of coil 7 is -1"):
        unit.do_step(0, STEP)
    unit.terminate()


def world(engine, design, length, steps, **coils):
    """A world of links that touch nothing, and the length of the last link [m] after every micro-step."""
    kind = MujocoWorld if engine == "mujoco" else BulletWorld
    made = kind(design, layout(design), SolverSettings(MICRO, 50, 1e-3), apart(design, length))
    k = np.full(2 * design.links, coils.get("stiffness", STIFFNESS))
    r = np.full(2 * design.links, coils.get("rest_length", REST))
    found = []
    for _ in range(steps):
        made.advance(1, k, r)
        found.append(design.length_cold + made.motion().slide[-1] / 100)
    return made, np.array(found)


def balance(design, rest=REST):
    """Length at which coils and steel springs balance [m]."""
    return (STIFFNESS * rest + design.steel_stiffness * design.steel_rest_length) / (STIFFNESS + design.steel_stiffness)


def test_springs_hold_a_link_where_their_forces_balance(engine):
    design = prototype(tether_rows=0, **BETWEEN, **WEIGHTLESS)
    made, found = world(engine, design, balance(design), 400)
    made.close()
    np.testing.assert_allclose(found, balance(design), atol=1e-8)


def test_a_link_swings_at_the_frequency_of_its_springs(engine):
    design = prototype(tether_rows=0, **BETWEEN, **WEIGHTLESS)
    made, found = world(engine, design, balance(design) + 5e-4, 800)
    made.close()
    swing = found - balance(design)
    crossings = np.flatnonzero((swing[:-1] > 0) & (swing[1:] <= 0))
    # two halves of half the mass against each other: reduced mass m / 4
    rate = math.sqrt(2 * (STIFFNESS + design.steel_stiffness) / (design.link_mass / 4))
    period = MICRO * (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    assert period == pytest.approx(2 * math.pi / rate, rel=0.01)  # read to a micro-step of many periods


def test_a_coil_that_becomes_slack_between_the_stops_stops_pulling(engine):
    # It rests at 30 mm with the link at 28: it must not push. The steel springs alone accelerate the halves.
    design = prototype(tether_rows=0, **BETWEEN, **WEIGHTLESS)
    made, found = world(engine, design, 0.028, 4, rest_length=0.030)
    made.close()
    length, speed, expected = 0.028, 0.0, []
    for _ in range(4):  # symplectic Euler, as both engines step
        pull = STIFFNESS * max(length - 0.030, 0.0)
        force = 2 * (design.steel_stiffness * (design.steel_rest_length - length) - pull)
        speed += MICRO * force / (design.link_mass / 4)
        length += MICRO * speed
        expected.append(length)
    assert expected[1] < 0.030 < expected[3] < design.length_cold
    np.testing.assert_allclose(found, expected, atol=1e-8)


@pytest.mark.parametrize(("share", "moves"), [(0.8, False), (1.2, True)])
def test_friction_of_a_slide_in_mujoco_holds_what_it_can(share, moves):
    design = prototype(**WEIGHTLESS, **BETWEEN, added=AddedEffects(slide_friction=0.5))
    reach = 0.5 / (2 * (STIFFNESS + design.steel_stiffness))
    begin = balance(design) + share * reach
    made, found = world("mujoco", design, begin, 400)
    made.close()
    # Its friction is regularised: where it holds, it creeps by a micrometre in a tenth of a second.
    assert (abs(found[-1] - begin) > 0.1 * reach) == moves


def test_damping_payload_and_wires_in_mujoco_follow_their_laws():
    damped = prototype(**WEIGHTLESS, **BETWEEN, added=AddedEffects(slide_damping=0.05))
    made, found = world("mujoco", damped, balance(damped) + 5e-4, 1200)
    made.close()
    swing = found - balance(damped)
    peaks = [i for i in range(1, len(swing) - 1) if swing[i - 1] < swing[i] >= swing[i + 1]]
    rate = -np.polyfit(MICRO * np.array(peaks), np.log(swing[peaks]), 1)[0]
    assert rate == pytest.approx(0.05 / (2 * damped.link_mass / 4), rel=0.05)
    loaded = prototype(gravity=(0.0, -9.81, 0.0), added=AddedEffects(payload=6e-3))
    made, _ = world("mujoco", loaded, loaded.length_cold, 400, stiffness=COLD)
    speed = made.motion().velocity[:, 1] / 100 / 0.1
    made.close()
    # Three links share the payload; it pulls the back half, and the slide is at its stop, which gives a little.
    assert speed[-1] == pytest.approx(-9.81 * (1 + 2e-3 / loaded.link_mass), rel=2e-3)
    assert speed[-4] == pytest.approx(-9.81, rel=2e-3)
    wired = prototype(rows=3, gravity=(0.0, 9.81, 0.0), added=AddedEffects(wire_stiffness=40.0))
    seats = woven(wired, layout(wired)).position
    motion = apart(wired, wired.length_cold)
    motion.position[-1] = seats[-1]
    motion.position[:-1, 0] += 100.0
    made = MujocoWorld(wired, layout(wired), SolverSettings(MICRO, 50, 1e-3), motion)
    k, r = np.full(2 * wired.links, COLD), np.full(2 * wired.links, REST)
    frequency, times, falls = math.sqrt(40.0 / wired.link_mass), MICRO * np.arange(1, 401), []
    for _ in times:
        made.advance(1, k, r)
        falls.append((made.motion().position[-1, 1] - seats[-1, 1]) / 100)
    made.close()
    expected = 9.81 / frequency**2 * (1 - np.cos(frequency * times))
    np.testing.assert_allclose(falls, expected, atol=0.015 * np.max(expected))


def test_a_hot_stop_in_mujoco_gives_by_less_than_a_tenth_of_a_millimetre():
    design = prototype(tether_rows=0, **WEIGHTLESS)
    made, found = world("mujoco", design, design.length_hot, 400, stiffness=HOT)
    made.close()
    assert abs(found[-1] - design.length_hot) < 1e-4


@pytest.mark.parametrize(
    ("design", "settings", "words"),
    [
        ({"restitution": 0.5}, {}, "restitution"),
        ({}, {"springs": "motor"}, "motor"),
        ({}, {"friction_model": "pyramid"}, "pyramid"),
    ],
)
def test_what_mujoco_does_not_have_is_refused(design, settings, words):
    with pytest.raises(ValueError, match=words):
        woven_unit(prototype(rows=3, **design), solver=replace(COARSE["mujoco"], **settings))


@pytest.mark.parametrize(("key", "value"), [("engine", "jolt"), ("friction_model", "sphere")])
def test_settings_are_one_of_a_few(key, value):
    with pytest.raises(ValueError, match=key):
        SolverSettings(5e-4, 50, 1e-3, **{key: value})


def test_the_pyramid_of_friction_is_another_trajectory_of_the_same_drape():
    ends = {}
    for model in ("cone", "pyramid"):
        unit = small("bullet", settings={"friction_model": model})
        advance(unit, 0.3)
        ends[model] = unit.get("row_centre")[-1].copy()
        unit.terminate()
    difference = np.abs(ends["cone"] - ends["pyramid"]).max()
    assert 0.0 < difference < 2e-3


def drape_in(engine_line):
    source = load_scenario("passive_drape").path
    text = source.read_text().replace("kind: bullet_fabric", f"kind: bullet_fabric\n    {engine_line}")
    return parse_scenario(text, source)


def test_one_line_of_a_scenario_chooses_the_engine():
    assembly = assemble(drape_in("engine: mujoco"))
    unit = assembly.system.units["fabric"]
    assert (unit.solver.engine, unit.solver.micro_step) == ("mujoco", 2.5e-4)
    assembly.system.terminate()
    with pytest.raises(InputError, match="engine"):
        drape_in("engine: unreal")


def test_without_the_package_one_sentence_says_what_to_install(monkeypatch, tmp_path, capsys):
    def absent(name):
        if name == "mujoco":
            raise ModuleNotFoundError(f"No module named {name!r}")
        return importlib.import_module(name)

    monkeypatch.setattr(mujoco_world, "importlib", type("Importlib", (), {"import_module": staticmethod(absent)}))
    file = tmp_path / "mine.yaml"
    file.write_text(drape_in("engine: mujoco").to_yaml(True))
    monkeypatch.setattr("sys.argv", ["cosim", "validate", str(file)])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == WRONG_INPUT
    said = capsys.readouterr().err
    assert "components.fabric.engine: the package mujoco is not installed" in said
    assert 'pip install "active-chainmail[mujoco]"' in said
    assert "Traceback" not in said
