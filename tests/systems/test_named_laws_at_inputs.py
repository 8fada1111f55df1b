"""Laws with a name at the inputs of FMUs that hide their states: radiation, drag, dry friction, with size and place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.laws.law import Role
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import Fit, fits, places_of
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.search.search import Settings
from diagnosis.write_outputs import write_outputs
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import held, write_recording

#: Heat capacity [J/K], loss [W/K], room [K], and what it radiates, which the model does not have [W/K^4].
C, K, ROOM, EMISSION = 0.5, 0.3, 293.0, 1.2e-9
#: Mass [kg], damping [N s/m], spring [N/m] of a carriage, and its drag [N s^2/m^2] and friction [N], which the model
#: does not have.
M, D, S, DRAG, FRICTION = 2.0, 1.5, 8.0, 1.1, 0.6
LUMP = """\
title: A lump in a room
time: {stop: 12500 ms, macro_step: 25 ms, output_step: 50 ms}
components:
  drive: {kind: programme, outputs: {power: {unit: W, constant: 0 W}}}
  lump: {kind: fmu, fmu: lump.fmu, integrator: internal}
connections: [drive.power -> lump.power]
"""
CARRIAGE = """\
title: A carriage
time: {stop: 40 s, macro_step: 20 ms, output_step: 40 ms}
components:
  drive: {kind: programme, outputs: {force: {unit: N, constant: 0 N}}}
  carriage: {kind: fmu, fmu: carriage.fmu, integrator: internal}
connections: [drive.force -> carriage.force]
"""


def lump(folder: Path) -> Path:
    numbers = {"C": (C, "J/K"), "K": (K, "W/K"), "T_room": (ROOM, "K")}
    rate = "(power - K*(T - T_room))/C"
    model = OdeModel(
        "lump", numbers, {"power": "W"}, {"T": ("K", "T_room", rate)}, {"temperature": ("degC", "T - 273.15")}
    )
    model.build(folder)
    (folder / "scenario.yaml").write_text(LUMP, encoding="utf-8")
    return folder / "scenario.yaml"


def carriage(folder: Path, shown: str) -> Path:
    numbers = {"m": (M, "kg"), "d": (D, "N*s/m"), "s": (S, "N/m")}
    states = {"x": ("m", "0.0", "v"), "v": ("m/s", "0.0", "(force - d*v - s*x)/m")}
    outputs = {"speed": {"speed": ("m/s", "v")}, "position": {"position": ("mm", "1000*x")}}[shown]
    OdeModel("carriage", numbers, {"force": "N"}, states, outputs).build(folder)
    (folder / "scenario.yaml").write_text(CARRIAGE, encoding="utf-8")
    return folder / "scenario.yaml"


def placed(scenario: Path) -> list[Fit]:
    system = FastSystem(load_scenario(scenario))
    try:
        return list(fits(places_of([system]), library(), 1.0))
    finally:
        system.close()


def test_the_library_has_them_from_one_file_each() -> None:
    found = {law.identifier: law for law in library() if law.role is Role.HEAT_OVER_TEMPERATURE}
    assert found["radiation_at_port"].formula == "-emission * (T ** 4 - T_a ** 4)"
    assert found["radiation_at_port"].numbers[0].of == "u / T / T_abs ** 3"  # W/K^4 of a heat flow [W]
    assert "second_mass_at_port" not in found  # its time would be that of a capacity that the FMU hides
    assert not [law for law in library() if law.identifier == "constant_force_at_port"]  # an offset of the input


def test_places_are_those_that_a_person_would_choose(tmp_path: Path) -> None:
    warm = {f.term.identifier for f in placed(lump(tmp_path))}
    assert {"radiation_at_port_of_temperature", "natural_convection_at_port_of_temperature"} <= warm
    assert not {n for n in warm if "drag" in n or "leak" in n}
    moving = {f.term.identifier: f for f in placed(carriage(tmp_path, "speed"))}
    assert {"quadratic_drag_at_port_of_speed", "dry_friction_at_port_of_speed"} <= set(moving)
    assert "cubic_spring_at_port_of_speed" not in moving  # nothing shows the position
    drag, other = (
        moving[n].term.parameters[0] for n in ("quadratic_drag_at_port_of_speed", "port_signed_square_of_speed")
    )
    assert drag.lower == 0.0 < drag.upper  # it takes energy
    assert other.lower == 0.0 < min(other.starts)  # a law without a name: `+ a * ...`, what the named one cannot be
    shown = {f.term.identifier: f for f in placed(carriage(tmp_path, "position"))}
    assert {"quadratic_drag_at_port_of_rate_of_position", "cubic_spring_at_port_of_position"} <= set(shown)
    (name, unit) = shown["quadratic_drag_at_port_of_rate_of_position"].placed.numbers[0]
    assert (name, unit) == ("drag", "N*s^2/mm^2")


def test_a_room_that_an_fmu_hides_is_found_by_its_outputs(tmp_path: Path) -> None:
    system = FastSystem(load_scenario(lump(tmp_path)))
    (own,) = places_of([system])
    system.close()
    assert own.room == pytest.approx(ROOM, abs=1e-6)


def recorded(folder: Path, number: int, columns: dict[str, Array], given: str, read: tuple[str, str, str]) -> Recording:
    """Column `u` is the input, `y` the reading; `given` has its name and unit."""
    quantity, unit = given.split()
    channel, own, noise = read
    path = write_recording(folder / f"run_{number}", columns, {quantity: ("u", unit)}, {channel: ("y", own, noise)})
    return load_recording(path)


def answered(scenario: Path, recordings: list[Recording]) -> Diagnosis:
    loaded = load_scenario(scenario)
    made = diagnose(loaded, recordings[:2], recordings[2:], Settings(), options=Options(is_brief=True))
    written = write_outputs(made, loaded, recordings[:2], recordings[2:], scenario.parent / "answer")
    if made.diagnosis.accepted:
        assert written.amended_model is not None
        results = run(load_scenario(scenario.parent / "answer" / "amended" / "scenario.yaml"))
        assert all(np.isfinite(v.values).all() for v in results.data_vars.values())
    return made.diagnosis


def test_radiation_of_a_hidden_lump_is_named(tmp_path: Path) -> None:
    scenario, recordings = lump(tmp_path), []
    for number in range(3):
        rng = np.random.default_rng([11, number])
        power = np.repeat(rng.choice([0.0, 20.0, 35.0, 50.0], 5), 50)

        def course(x: Array, watt: float) -> Array:
            return np.asarray((watt - K * (x - ROOM) - EMISSION * (x**4 - ROOM**4)) / C)

        values = held(course, np.array([ROOM]), power, 0.05)[:, 0] - 273.15 + 0.2 * rng.standard_normal(250)
        columns = {"t": 0.05 * np.arange(250), "u": power, "y": values}
        recordings.append(recorded(tmp_path, number, columns, "drive.power W", ("lump.temperature", "degC", "0.2 K")))
    answer = answered(scenario, recordings)
    assert answer.verdict is Verdict.MISSING_PHYSICS
    (found,) = answer.accepted
    assert found.effect == "radiation_at_port_of_temperature"
    assert found.statement.startswith("radiation, lump.power")
    assert found.parameters[0].value == pytest.approx(EMISSION, rel=0.05)
    assert "surroundings = 293 K" in found.law


@pytest.mark.parametrize(
    ("shown", "unit", "noise", "effect"),
    [
        ("speed", "m/s", 0.002, "dry_friction"),
        ("position", "mm", 0.5, "quadratic_drag"),
    ],
    ids=["friction", "drag"],
)
def test_drag_and_friction_of_a_hidden_carriage_are_named(
    tmp_path: Path, shown: str, unit: str, noise: float, effect: str
) -> None:
    scenario, recordings = carriage(tmp_path, shown), []
    drag, friction = (DRAG, 0.0) if effect == "quadratic_drag" else (0.0, FRICTION)
    for number in range(3):
        rng = np.random.default_rng([12, number])
        force = np.repeat(rng.uniform(-6.0, 6.0, 25), 40)

        def course(x: Array, push: float) -> Array:
            v = x[1]
            extra = drag * abs(v) * v + friction * np.tanh(v / 0.005)
            return np.array([v, (push - 1.02 * D * v - 0.98 * S * x[0] - extra) / M])

        states = held(course, np.zeros(2), force, 0.04)
        values = (1000.0 * states[:, 0] if shown == "position" else states[:, 1]) + noise * rng.standard_normal(1000)
        columns = {"t": 0.04 * np.arange(1000), "u": force, "y": values}
        channel = (f"carriage.{shown}", unit, f"{noise} {unit}")
        recordings.append(recorded(tmp_path, number, columns, "drive.force N", channel))
    answer = answered(scenario, recordings)
    assert answer.verdict is Verdict.MISSING_PHYSICS, [f.statement for f in answer.findings]
    effects = {f.effect for f in answer.accepted}
    where = {"speed": "of_speed", "position": "of_rate_of_position"}[shown]
    assert f"{effect}_at_port_{where}" in effects, [(f.statement, f.doubts) for f in answer.accepted]
    (found,) = (f for f in answer.accepted if f.effect.startswith(effect))
    assert found.is_named
    if effect == "dry_friction":
        assert found.parameters[0].value == pytest.approx(FRICTION, rel=0.1)
