"""Where laws fit: asserted by what a person knows of each rig."""

from __future__ import annotations

from pathlib import Path

import pytest

from cosim.scenario import parse_scenario
from diagnosis.laws.document import lines
from diagnosis.laws.law import Role
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import Fit, fits, places_of
from evaluation.fmus.model import OdeModel
from evaluation.real.__main__ import main as real
from tests.systems.rigs import LUMP, OSCILLATOR, OSCILLATOR_SCENARIO, TANK

_TANK = """
title: A tank
time: {stop: 60 s, macro_step: 1 s, output_step: 1 s}
components:
  pump: {kind: programme, outputs: {flow: {unit: m^3/s, points: [[0 s, 0.01 m^3/s], [20 s, 0 m^3/s]]}}}
  tank: {kind: fmu, fmu: tank.fmu, integrator: cvode}
connections: [pump.flow -> tank.inflow]
"""
_LUMP = """
title: A lump
time: {stop: 600 s, macro_step: 2 s, output_step: 2 s}
components:
  drive: {kind: programme, outputs: {power: {unit: W, points: [[0 s, 20 W], [300 s, 0 W]]}}}
  room: {kind: programme, outputs: {temperature: {unit: degC, constant: 21 degC}}}
  lump: {kind: fmu, fmu: lump.fmu, integrator: cvode}
connections: [drive.power -> lump.power, room.temperature -> lump.room]
"""


def _fits(text: str, folder: Path) -> dict[tuple[str, str], Fit]:
    system = FastSystem(parse_scenario(text, folder / "scenario.yaml"))
    try:
        return {(f.term.identifier, f.placed.to): f for f in fits(places_of([system]), library(), 1.0)}
    finally:
        system.close()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """FMUs of the rigs."""
    found = tmp_path_factory.mktemp("rigs")
    for model in (OSCILLATOR, TANK, LUMP):
        model.build(found)
    return found


def test_a_position_takes_no_law_and_its_velocity_takes_those_of_motion(folder: Path) -> None:
    found = _fits(OSCILLATOR_SCENARIO.replace("INTEGRATOR", "cvode"), folder)
    assert {"dry_friction", "cubic_spring", "upper_stop"} <= {name for name, to in found if to == "der(v)"}
    assert not [name for name, to in found if to == "der(x)"]  # the derivative of a position is its velocity
    assert not {"radiation", "free_outflow", "leak"} & {name for name, _ in found}
    assert {"input_saturation", "input_dead_zone", "input_lag"} <= {name for name, to in found if to == "u"}


def test_the_units_of_strengths_are_those_that_a_person_writes(folder: Path) -> None:
    found = _fits(OSCILLATOR_SCENARIO.replace("INTEGRATOR", "cvode"), folder)
    assert found["cubic_spring", "der(v)"].term.parameters[0].unit == "1/m^2/s^2"
    assert found["viscous_damping", "der(v)"].term.parameters[0].unit == "1/s"
    assert found["dry_friction", "der(v)"].term.parameters[0].unit == "m/s^2"
    assert found["maxwell_element", "der(v)"].term.parameters[1].unit == "s"


def test_a_loss_takes_energy_and_a_spring_may_push_or_pull(folder: Path) -> None:
    found = _fits(OSCILLATOR_SCENARIO.replace("INTEGRATOR", "cvode"), folder)
    assert found["dry_friction", "der(v)"].term.parameters[0].lower == 0.0
    assert found["cubic_spring", "der(v)"].term.parameters[0].lower < 0.0
    assert found["cubic_spring", "der(v)"].term.unit == "mechanical"


def test_a_level_has_an_outflow_and_no_friction(folder: Path) -> None:
    found = _fits(_TANK, folder)
    assert ("free_outflow", "der(h)") in found
    assert found["free_outflow", "der(h)"].term.unit == "other"  # a level is a length, and no mechanism
    assert not {"dry_friction", "stiffness"} & {name for name, _ in found}


def test_a_temperature_radiates_against_the_room_in_kelvin(folder: Path) -> None:
    found = _fits(_LUMP, folder)
    law = found["radiation", "der(T)"]
    assert law.placed.formula == "-emission * (T ** 4 - room ** 4)"
    assert law.term.parameters[0].unit == "1/K^3/s"
    assert law.term.unit == "thermal"
    assert ("second_mass", "der(T)") in found


def test_an_fmu_that_hides_its_states_has_laws_at_its_inputs_and_outputs_alone(folder: Path) -> None:
    text = OSCILLATOR_SCENARIO.replace("INTEGRATOR", "internal")
    found = _fits(text, folder)
    assert {to for _, to in found} == {"u", "position", "speed"}
    at_input = {name for name, to in found if to == "u"}
    assert {"input_saturation", "input_dead_time", "input_rate_limit", "input_play"} <= at_input
    assert {"port_linear_of_speed", "port_of_sign_of_speed", "port_of_sign_of_rate_of_position"} <= at_input
    assert "port_hidden_state_of_speed" in at_input
    at_output = {name for name, to in found if to == "position"}
    assert {"output_offset", "correction_state_linear_of_u", "correction_state_squared_of_position"} <= at_output
    assert {"response_linear_of_u", "response_linear_of_speed", "response_squared_of_speed"} <= at_output
    assert not {n for n in at_output if n.startswith("response_") and n.endswith("_of_position")}  # a gain is its own
    system = FastSystem(parse_scenario(text, folder / "scenario.yaml"))
    (said,) = places_of([system])[0].untried
    assert "hides its states: laws were tried at its input `u` and at its outputs `position`, `speed` alone" in said
    assert "with `integrator: cvode` they are tried at its states too" in said  # the FMU has both interfaces
    system.close()


def test_laws_of_the_same_form_are_one(folder: Path) -> None:
    """A law without a name is not tried where one with a name says the same."""
    found = _fits(OSCILLATOR_SCENARIO.replace("INTEGRATOR", "cvode"), folder)
    assert ("stiffness", "der(v)") in found
    assert ("coupling_linear_of_x", "der(v)") not in found


def test_every_law_of_the_library_states_a_source_and_can_vanish() -> None:
    assert len({law.identifier for law in library()}) == len(library())
    for law in library():
        first = law.numbers[0]
        assert law.source
        lowest = -first.most if first.least is None else first.least
        assert lowest <= 0.0 < first.most, law.identifier  # 0 is within the bounds
    assert {law.role for law in library()} == set(Role)


def test_a_lag_of_a_macro_step_is_an_error_of_the_coupling_and_no_finding(folder: Path) -> None:
    """Gauss-Seidel hands on values that are half a macro-step early: a lag of that size compensates that."""
    system = FastSystem(parse_scenario(_TANK, folder / "scenario.yaml"))
    found = {f.term.identifier: f for f in fits(places_of([system]), library(), 1.0, 0.5)}
    system.close()
    assert found["input_lag"].term.parameters[0].negligible == 0.5
    limit = found["input_rate_limit"].term.parameters[0]  # seconds for each unit: late by as much at the input's size
    assert limit.negligible == pytest.approx(0.5 * limit.starts[0] / 3.0, rel=1e-9)
    assert found["free_outflow"].term.parameters[0].negligible == 0.0


def test_the_page_of_the_library_is_that_of_the_files() -> None:
    page = Path(__file__).parents[2] / "docs" / "law-library.md"
    assert page.read_text(encoding="utf-8").rstrip() == "\n".join(lines()).rstrip()
    assert "`-stiffness_3 * x ** 3`" in page.read_text(encoding="utf-8")


def test_a_missing_recording_is_named_with_its_source(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert real(["--recordings", str(tmp_path), "--out", str(tmp_path / "out"), "--only", "emps"]) == 2
    said = capsys.readouterr().err
    assert "slide.csv: there is no such file" in said
    assert "nonlinearbenchmark.org" in said


def test_a_state_without_a_unit_is_no_level_and_no_angle(tmp_path: Path) -> None:
    """A pure number and a radian have one dimension: a concentration has no opening to flow out of."""
    OdeModel("reactor", {"k": (0.1, "")}, {"feed": ""}, {"a": ("", "0.5", "feed - k*a")}, {"A": ("", "a")}).build(
        tmp_path
    )
    text = """
title: A reactor
time: {stop: 60 s, macro_step: 1 s, output_step: 1 s}
components:
  pump: {kind: programme, outputs: {feed: {unit: "1", points: [[0 s, 0.1], [20 s, 0]]}}}
  reactor: {kind: fmu, fmu: reactor.fmu, integrator: cvode}
connections: [pump.feed -> reactor.feed]
"""
    found = {name for name, to in _fits(text, tmp_path) if to == "der(a)"}
    assert "constant" in found
    assert "rate_linear" in found
    assert not found & {"steady_inflow", "free_outflow", "leak", "viscous_damping", "dry_friction"}


def test_a_twist_whose_derivative_is_a_difference_couples_both_parts_without_units(tmp_path: Path) -> None:
    model = OdeModel(
        "train",
        {"J": (0.02, ""), "K": (8.0, "")},
        {"torque": ""},
        {
            "w_a": ("", "0", "(torque - K*phi) / J"),
            "phi": ("", "0", "w_a - w_b"),
            "w_b": ("", "0", "K*phi / (2.0*J)"),
        },
        {"motor": ("", "w_a")},
    )
    model.build(tmp_path)
    text = """
title: A drive train
time: {stop: 2 s, macro_step: 10 ms, output_step: 10 ms}
components:
  drive: {kind: programme, outputs: {torque: {unit: "1", points: [[0 s, 1], [1 s, -1]]}}}
  train: {kind: fmu, fmu: train.fmu, integrator: cvode}
connections: [drive.torque -> train.torque]
"""
    found = _fits(text, tmp_path)
    play = found["coupling_play_of_w_b", "der(w_a)"]
    assert play.placed.formula == "stiffness * min(max(phi, -play), play)"
    assert play.reaction is not None
    assert play.reaction.to == "der(w_b)"
    assert found["coupling_damping_of_w_b", "der(w_a)"].placed.formula == "-damping * (w_a - w_b)"


def test_each_temperature_at_an_inlet_may_be_that_of_the_surroundings(tmp_path: Path) -> None:
    model = OdeModel(
        "boiler",
        {"c": (0.01, "1/s")},
        {"power": "K/s", "cold": "K", "room": "K"},
        {"T": ("K", "300", "power - c * (T - cold)")},
        {"temperature": ("K", "T")},
    )
    model.build(tmp_path)
    text = """
title: A boiler
time: {stop: 600 s, macro_step: 2 s, output_step: 2 s}
components:
  drive: {kind: programme, outputs: {power: {unit: K/s, points: [[0 s, 0.1 K/s], [300 s, 0 K/s]]}}}
  water: {kind: programme, outputs: {temperature: {unit: degC, constant: 12 degC}}}
  air: {kind: programme, outputs: {temperature: {unit: degC, constant: 21 degC}}}
  boiler: {kind: fmu, fmu: boiler.fmu, integrator: cvode}
connections: [drive.power -> boiler.power, water.temperature -> boiler.cold, air.temperature -> boiler.room]
"""
    found = _fits(text, tmp_path)
    losses = {name: fit.placed.formula for (name, _), fit in found.items() if name.startswith("heat_loss")}
    assert losses == {"heat_loss_of_cold": "-loss * (T - cold)", "heat_loss_of_room": "-loss * (T - room)"}


def _lump_in(folder: Path, parameters: dict[str, tuple[float, str]], rate: str) -> dict[str, Fit]:
    """Laws with a name at a lump whose room is no input."""
    numbers = {"C": (50.0, "J/K"), "K": (0.4, "W/K"), **parameters}
    OdeModel("lump", numbers, {"power": "W"}, {"T": ("K", "300", rate)}, {"temperature": ("K", "T")}).build(folder)
    text = _LUMP.replace("  room: {kind: programme, outputs: {temperature: {unit: degC, constant: 21 degC}}}\n", "")
    found = _fits(text.replace(", room.temperature -> lump.room", ""), folder)
    return {name: fit for (name, to), fit in found.items() if to == "der(T)" and fit.term.is_named}


def test_a_room_that_is_a_parameter_is_found_by_what_flows_by_the_difference_to_it(tmp_path: Path) -> None:
    parameters = {"T_room": (294.0, "K"), "T_switch": (330.0, "K")}
    rate = "(power*(T > T_switch ? 0.5 : 1.0) - K*(T - T_room))/C"
    found = _lump_in(tmp_path, parameters, rate)
    assert {"radiation", "heat_loss", "natural_convection", "second_mass", "latent_heat"} <= set(found)
    placed = found["radiation"].placed
    assert placed.formula == "-emission * (T ** 4 - surroundings ** 4)"
    assert placed.constants["surroundings"].to("K") == 294.0
    assert "surroundings = 294 K" in found["radiation"].term.law


def test_a_room_at_the_zero_of_its_unit_is_one(tmp_path: Path) -> None:
    found = _lump_in(tmp_path, {"T_room": (0.0, "degC")}, "(power - K*(T - T_room - 273.15))/C")
    assert found["radiation"].placed.constants["surroundings"].to("K") == pytest.approx(273.15)


def test_where_nothing_says_what_the_surroundings_are_only_laws_that_need_them_are_left_out(tmp_path: Path) -> None:
    found = _lump_in(tmp_path, {}, "(power - K*(T - 294.0))/C")
    assert {"second_mass", "latent_heat", "evaporation"} <= set(found)
    assert not {"radiation", "heat_loss", "natural_convection"} & set(found)


def test_two_parameters_that_may_be_the_room_are_none(tmp_path: Path) -> None:
    parameters = {"T_wall": (294.0, "K"), "T_air": (296.0, "K")}
    found = _lump_in(tmp_path, parameters, "(power - K*(T - T_wall) - 0.1*(T - T_air))/C")
    assert not {"radiation", "heat_loss", "natural_convection"} & set(found)


def test_any_state_may_have_a_hidden_one_beside_it_and_a_temperature_has_it_by_name(folder: Path) -> None:
    tank = _fits(_TANK, folder)["rate_hidden_state", "der(h)"]
    assert tank.placed.formula == "a * (h - inside)"
    assert [(s.rate, s.start) for s in tank.placed.states] == [("(h - inside) / settling_time", "h")]
    assert [p.unit for p in tank.term.parameters] == ["1/s", "s"]
    lump = _fits(_LUMP, folder)
    assert ("second_mass", "der(T)") in lump
    assert ("rate_hidden_state", "der(T)") not in lump


def test_a_speed_without_an_angle_has_no_law_whose_size_is_a_way(tmp_path: Path) -> None:
    """A flywheel states how fast it turns and not how far: friction that gives way over an angle has no size there."""
    model = OdeModel("flywheel", {"J": (0.1, "kg*m^2")}, {"torque": "N*m"}, {"w": ("rad/s", "0", "torque/J")}, {})
    model.build(tmp_path)
    text = """
title: A flywheel
time: {stop: 2 s, macro_step: 10 ms, output_step: 10 ms}
components:
  drive: {kind: programme, outputs: {torque: {unit: N*m, points: [[0 s, 1 N*m], [1 s, -1 N*m]]}}}
  flywheel: {kind: fmu, fmu: flywheel.fmu, integrator: cvode}
connections: [drive.torque -> flywheel.torque]
"""
    found = {name for name, to in _fits(text, tmp_path) if to == "der(w)"}
    assert {"dry_friction", "viscous_damping", "rate_hysteresis"} <= found
    assert not {"presliding_friction", "maxwell_element", "stiffness"} & found


_WARM = """
title: A warm lump
time: {stop: 600 s, macro_step: 2 s, output_step: 2 s}
components:
  drive: {kind: programme, outputs: {power: {unit: W, points: [[0 s, 20 W], [300 s, 0 W]]}}}
  room: {kind: programme, outputs: {temperature: {unit: degC, constant: 21 degC}}}
  warm: {kind: fmu, fmu: warm.fmu, integrator: cvode}
connections: [drive.power -> warm.power, room.temperature -> warm.room]
"""


@pytest.mark.parametrize(("unit", "start"), [("K", 300.0), ("degC", 26.85), ("degF", 80.33)])
def test_powers_of_an_absolute_temperature_are_about_where_it_is(tmp_path: Path, unit: str, start: float) -> None:
    """The square of 300 K that move by 10 K is a constant and a slope: it is counted from 300 K, in any unit."""
    model = OdeModel(
        "warm",
        {"C": (50.0, "J/K"), "loss": (0.4, "W/K"), "T_0": (start, unit)},
        {"power": "W", "room": unit},
        {"T": (unit, "T_0", "(power - loss * (T - room)) / C")},
        {"temperature": (unit, "T")},
    )
    model.build(tmp_path)
    found = _fits(_WARM, tmp_path)
    square = found["rate_squared", "der(T)"].placed
    assert square.formula == "a * (T - s_0) ** 2"
    assert square.constants["s_0"].number == pytest.approx(300.0, abs=0.05)
    assert square.constants["s_0"].unit == "K"
    assert found["rate_squared", "der(T)"].term.law == "der(T) += a * (T - s_0) ** 2, s_0 = 300 K"
    assert found["rate_squared", "der(T)"].term.parameters[0].unit == "1/K/s"
    onset = found["rate_spline", "der(T)"].term.parameters[1]
    # 20 W warm it from 26.85 degC towards 71 degC, the room is at 21 degC: no start where it never is.
    assert 294.0 < onset.starts[0] < 305.0 < onset.starts[-1] < 344.0


def test_powers_of_what_moves_about_zero_are_about_zero(folder: Path) -> None:
    found = _fits(OSCILLATOR_SCENARIO.replace("INTEGRATOR", "cvode"), folder)
    assert found["quadratic_drag", "der(v)"].placed.formula == "-drag * abs(v) * v"
    assert found["rate_squared", "der(v)"].placed.formula == "a * v ** 2"
    assert not found["rate_squared", "der(v)"].placed.constants


def test_an_exchange_may_be_driven_by_a_third_quantity_where_there_is_one(tmp_path: Path) -> None:
    """Water in a hose warms a wall: heat goes with the flow. Two walls that do not touch exchange nothing."""
    model = OdeModel(
        "hose",
        {"UA": (0.2, "1/s")},
        {"flow": "kg/s", "inlet": "K"},
        {
            "T_water": ("K", "300", "flow*(inlet - T_water)/(1.0) - UA*(T_water - T_wall)"),
            "T_wall": ("K", "300", "UA*(T_water - T_wall)"),
            "T_far": ("K", "300", "0.01*(300.0 - T_far)"),
            "film": ("kg", "0.02", "-1e-3*film"),
            "frost": ("kg", "0", "1e-5"),
        },
        {"temperature": ("K", "T_wall")},
    )
    model.build(tmp_path)
    text = """
title: A hose
time: {stop: 600 s, macro_step: 1 s, output_step: 1 s}
components:
  pump: {kind: programme, outputs: {flow: {unit: kg/s, points: [[0 s, 0.1 kg/s], [300 s, 0.3 kg/s]]}}}
  tap: {kind: programme, outputs: {temperature: {unit: K, points: [[0 s, 320 K], [200 s, 305 K]]}}}
  hose: {kind: fmu, fmu: hose.fmu, integrator: cvode}
connections: [pump.flow -> hose.flow, tap.temperature -> hose.inlet]
"""
    found = _fits(text, tmp_path)
    law = found["modulated_exchange_of_T_wall_of_flow", "der(T_water)"]
    assert law.placed.formula == "-a * (T_water - T_wall) * flow"
    assert law.reaction is not None
    assert (law.reaction.to, law.reaction.formula) == ("der(T_wall)", "ratio * a * (T_water - T_wall) * flow")
    assert law.term.parameters[0].unit in ("1/kg", "1.0/kg")
    assert found["modulated_loss_of_inlet_of_flow", "der(T_wall)"].placed.formula == "-a * (T_wall - inlet) * flow"
    # The exchange of the model is that of the film at the begin; of frost there is none yet.
    wet = found["modulated_exchange_of_T_wall_of_film", "der(T_water)"].placed
    assert wet.formula == "-a * (T_water - T_wall) * (film - o_0)"
    assert wet.constants["o_0"].to("kg") == pytest.approx(0.02)
    frosted = found["modulated_exchange_of_T_wall_of_frost", "der(T_water)"].placed
    assert frosted.formula == "-a * (T_water - T_wall) * frost"
    assert not [n for n, _ in found if n.startswith("modulated_exchange") and "T_far" in n.split("_of_")[1]]
