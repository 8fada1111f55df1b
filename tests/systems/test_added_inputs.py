"""Quantities of other components in the formulas of added terms: closed forms, compiled code, refusals, SSP."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.settings import AddedTerm, FmuSettings
from cosim.fmu.unit import FmuUnit
from cosim.run import run
from cosim.scenario import Scenario, load_scenario, parse_scenario
from cosim.ssp.export import export_ssp
from cosim.ssp.importer import import_ssp
from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS
from cosim.unit.quantity import PhysicalValue
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.placed import PlacedInput, placed_of
from diagnosis.models.systems.places import Fit, fits, places_of
from evaluation.fmus.model import OdeModel

#: CVODE at rtol 1e-8 begins anew in each of 100 macro-steps.
INTEGRATED = 1e-6
TAU, SPEED, GAIN, STEP, STOP = 0.5, 2.0, 0.3, 0.02, 2.0
TANK = OdeModel(
    "tank",
    {"tau": (TAU, "s")},
    {"u": "V"},
    {"x": ("V", "0.0", "(u - x) / tau")},
    {"y": ("V", "x"), "through": ("V", "x + u")},
    1e-3,
)
CARRIAGE = OdeModel("carriage", {"v": (SPEED, "m/s")}, {"a": "m/s^2"}, {"s": ("m", "0.0", "v + 0*a")}, {}, 1e-3)
TEXT = f"""
title: A tank that a carriage passes
time: {{stop: {STOP} s, macro_step: {1e3 * STEP} ms, output_step: {1e3 * STEP} ms, checkpoint_step: 500 ms}}
algorithm: {{kind: KIND}}
components:
  drive: {{kind: programme, outputs: {{u: {{unit: V, constant: 1 V}}, a: {{unit: m/s^2, constant: 0 m/s^2}}}}}}
  carriage: {{kind: fmu, fmu: carriage.fmu, integrator: cvode}}
  rig:
    kind: fmu
    fmu: tank.fmu
    integrator: INTEGRATOR
    added_terms: [TERM]
connections:
  - drive.u -> rig.u
  - drive.a -> carriage.a
"""
INPUTS = "inputs: {place: {of: carriage.s, unit: cm}}"
#: The tank loses by how far the carriage has come, or its drive weakens.
RATE = f"{{to: der(x), formula: -g * place, parameters: {{g: {GAIN} V/s/m}}, {INPUTS}}}"
DRIVE = f"{{to: u, formula: -g * place * u, parameters: {{g: {GAIN} 1/m}}, {INPUTS}}}"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """FMUs of the tank and of the carriage."""
    found = tmp_path_factory.mktemp("tank")
    TANK.build(found)
    CARRIAGE.build(found)
    return found


def _scenario(folder: Path, term: str, integrator: str = "cvode", kind: str = "gauss_seidel") -> Scenario:
    text = TEXT.replace("TERM", term).replace("INTEGRATOR", integrator).replace("KIND", kind)
    return parse_scenario(text, folder / "scenario.yaml")


def _held(kind: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Place of the carriage that the rig has in each macro-step [m]: of its end where the carriage is stepped first."""
    return SPEED * STEP * (np.arange(round(STOP / STEP)) + (1.0 if kind == "gauss_seidel" else 0.0))


@pytest.mark.parametrize("kind", ["gauss_seidel", "jacobi"])
@pytest.mark.parametrize(("term", "integrator"), [(RATE, "cvode"), (DRIVE, "cvode"), (DRIVE, "internal")])
def test_a_term_sees_another_component_as_the_closed_form_says(
    folder: Path, term: str, integrator: str, kind: str
) -> None:
    scenario = _scenario(folder, term, integrator, kind)
    results = run(scenario)
    answered = [0.0]
    for place in _held(kind):
        goal = 1.0 - GAIN * place * (TAU if term == RATE else 1.0)
        answered.append(goal + (answered[-1] - goal) * np.exp(-STEP / TAU))
    np.testing.assert_allclose(results["rig.y"].values, answered, atol=INTEGRATED)
    system = FastSystem(scenario)
    system.set_substeps(2)
    rows = system.simulate()
    assert rows is not None
    for name in ("y", "through"):
        compiled = rows.values[:, system.recorded["rig", name]].ravel()
        np.testing.assert_allclose(compiled, results[f"rig.{name}"].values, atol=INTEGRATED)
    system.close()


def test_an_output_that_follows_the_input_at_once_follows_the_place_too(folder: Path) -> None:
    """through = x + u, with u weakened by where the carriage is at that instant."""
    results = run(_scenario(folder, DRIVE, "internal"))
    weakened = 1.0 - GAIN * SPEED * results["time"].values
    np.testing.assert_allclose(results["rig.through"].values - results["rig.y"].values, weakened, atol=INTEGRATED)


@pytest.mark.parametrize(
    ("inputs", "where", "problem"),
    [
        ("{place: {of: cariage.s, unit: m}}", "place.of", "no component cariage; did you mean `carriage`"),
        ("{place: {of: carriage.t, unit: m}}", "place.of", "carriage has no output t"),
        ("{place: {of: carriage.s, unit: kg}}", "place.unit", "kg"),
        ("{place: {of: carriage.s, unit: furlongs_}}", "place", "not a unit that is known"),
        ("{tau: {of: carriage.s, unit: m}}", "tau", "a variable of the FMU has this name"),
        ("{if: {of: carriage.s, unit: m}}", "if", "no formula can use this name"),
        ("{place: {of: carriage, unit: m}}", "place.of", "`carriage` names no variable"),
    ],
)
def test_what_leads_nowhere_is_refused_by_its_key(folder: Path, inputs: str, where: str, problem: str) -> None:
    unit = "kg" if "kg" in inputs else "m"
    with pytest.raises(InputError, match=rf"added_terms\[0\].inputs\.{where}") as found:
        run(_scenario(folder, DRIVE.replace(INPUTS, f"inputs: {inputs}").replace("1/m", f"1/{unit}")))
    assert problem in str(found.value)


def test_two_terms_use_one_quantity_by_one_name(folder: Path) -> None:
    other = DRIVE.replace("carriage.s", "drive.u").replace("unit: cm", "unit: V").replace("1/m", "1/V")
    with pytest.raises(InputError, match=r": components.rig.added_terms\[1\].inputs.place: another term has this name"):
        run(_scenario(folder, f"{RATE}, {other}"))
    twice = run(_scenario(folder, f"{RATE}, {RATE}"))
    once = run(_scenario(folder, RATE.replace(f"{GAIN} V", f"{2.0 * GAIN} V")))
    np.testing.assert_allclose(twice["rig.y"], once["rig.y"], atol=INTEGRATED)


def test_nothing_can_be_added_to_an_input_that_the_fmu_does_not_have(folder: Path) -> None:
    with pytest.raises(InputError, match=r"no floating-point input or output `place`.*it has: x, u, y, through|place"):
        run(_scenario(folder, f"{{to: place, formula: place, {INPUTS}}}"))


@pytest.mark.parametrize("kind", [ModelExchangeUnit, CoSimulationUnit])
def test_a_unit_goes_back_and_on_with_the_input_that_it_had(folder: Path, kind: type[FmuUnit]) -> None:
    """Nothing sets the place again after the state is saved."""
    term = AddedTerm("u", "-g * place * u", {"g": PhysicalValue(GAIN, "1/m")}, inputs={"place": "m"})
    settings = FmuSettings(added_terms=(term,))
    units = [kind("rig", open_fmu(folder / "tank.fmu"), settings) for _ in range(2)]  # type: ignore[call-arg]
    try:
        first, fresh = units
        first.set("u", np.array(1.0))
        first.initialise(0)
        first.exit_initialisation()
        first.set("place", np.array(2.0))
        first.do_step(0, NANOSECONDS)
        saved, checkpoint = first.save(), first.checkpoint()
        first.do_step(NANOSECONDS, NANOSECONDS)
        after = float(first.get("y"))
        weakened = (1.0 - GAIN * 2.0) * (1.0 - np.exp(-2.0 / TAU))
        assert after == pytest.approx(weakened, abs=INTEGRATED)
        first.set("place", np.array(0.0))
        first.restore(saved, NANOSECONDS)
        first.do_step(NANOSECONDS, NANOSECONDS)
        assert float(first.get("y")) == pytest.approx(after, abs=1e-12)
        first.release(saved)
        fresh.resume(checkpoint, NANOSECONDS)
        fresh.do_step(NANOSECONDS, NANOSECONDS)
        assert float(fresh.get("y")) == pytest.approx(after, abs=INTEGRATED)
    finally:
        for unit in units:
            unit.terminate()


def test_the_input_goes_out_with_an_ssp_and_comes_back(folder: Path, tmp_path: Path) -> None:
    scenario = _scenario(folder, DRIVE, "internal")
    export_ssp(scenario, tmp_path / "rig.ssp")
    import_ssp(tmp_path / "rig.ssp", tmp_path / "again")
    again = load_scenario(str(tmp_path / "again/scenario.yaml"))
    assert again.components["rig"].added_terms == scenario.components["rig"].added_terms  # type: ignore[union-attr]
    np.testing.assert_allclose(run(again)["rig.y"], run(scenario)["rig.y"], rtol=0.0, atol=1e-12)


def test_an_ssp_of_fmus_alone_needs_the_source_to_be_one(folder: Path, tmp_path: Path) -> None:
    term = "{to: u, formula: -g * a * u, parameters: {g: 0.1 s^2/m}, inputs: {a: {of: drive.a, unit: m/s^2}}}"
    with pytest.raises(InputError, match=r"added_terms\[0\].inputs.a: drive is no FMU and is left out"):
        export_ssp(_scenario(folder, term, "internal"), tmp_path / "rig.ssp", only_fmus=True)


@pytest.mark.parametrize("kind", ["gauss_seidel", "jacobi"])
@pytest.mark.parametrize(("term", "integrator"), [(RATE, "cvode"), (DRIVE, "cvode"), (DRIVE, "internal")])
def test_a_law_that_is_tried_is_the_term_that_a_scenario_has(
    folder: Path, term: str, integrator: str, kind: str
) -> None:
    """The carriage shows its place nowhere: the law takes it from its state."""
    with_it, without = _scenario(folder, term, integrator, kind), _scenario(folder, "", integrator, kind)
    law, values = placed_of("rig", with_it.components["rig"].added_terms[0])  # type: ignore[union-attr]
    given, tried = FastSystem(with_it), FastSystem(without, [law])
    courses = []
    for system, laws in ((given, {}), (tried, {0: values}), (tried, {}), (FastSystem(without), {})):
        system.set_substeps(2)
        rows = system.simulate(laws=laws)
        assert rows is not None
        courses.append([rows.values[:, system.recorded["rig", name]].ravel().copy() for name in ("y", "through")])
    np.testing.assert_allclose(courses[0], courses[1], rtol=0.0, atol=1e-12)
    np.testing.assert_array_equal(courses[2], courses[3])
    assert law.entry(values).inputs == with_it.components["rig"].added_terms[0].inputs  # type: ignore[union-attr]


def _fits(folder: Path, text: str) -> dict[tuple[str, str], Fit]:
    system = FastSystem(parse_scenario(text, folder / "scenario.yaml"))
    try:
        found = fits(places_of([system]), library(), 1.0)
        return {(f.term.identifier, f.term.place): f for f in found if f.placed.inputs}
    finally:
        system.close()


@pytest.mark.parametrize("integrator", ["cvode", "internal"])
def test_a_law_may_use_what_another_component_is_like_and_nothing_connects(folder: Path, integrator: str) -> None:
    """The drive is connected to the tank, the carriage is not pushed: its place is all that is left for the tank."""
    text = TEXT.replace("TERM", "").replace("INTEGRATOR", integrator).replace("KIND", "jacobi")
    found = _fits(folder, text.replace("constant: 1 V", "points: [[0 s, 0 V], [1 s, 1 V]]"))
    rig = {name: fit for (name, place), fit in found.items() if place.startswith("rig.")}
    assert {i.of for fit in rig.values() for i in fit.placed.inputs} == {"carriage.s"}
    at_states = {"far_linear_of_carriage_s", "far_product_of_carriage_s", "far_parameter_change_of_carriage_s"}
    assert at_states <= set(rig) if integrator == "cvode" else not at_states & set(rig)
    assert {"far_input_of_carriage_s", "far_gain_of_carriage_s"} <= set(rig)
    assert ("far_output_product_of_y_of_carriage_s" in rig) is (integrator == "internal")
    assert all(fit.term.is_completing and not fit.term.is_named for fit in found.values())
    assert rig["far_gain_of_carriage_s"].beside == "carriage.s"
    assert integrator == "cvode" or rig["far_output_product_of_y_of_carriage_s"].beside == "y, carriage.s"
    assert rig["far_gain_of_carriage_s"].placed.inputs == (PlacedInput("carriage_s", "carriage.s", "m"),)
    # What the tank gives is nothing that the carriage could not have from it; its own place is no other's.
    carriage = {i.of for (_, place), f in found.items() if place.startswith("carriage.") for i in f.placed.inputs}
    assert carriage == ({"drive.u", "rig.y", "rig.through"})


def test_one_quantity_in_two_units_is_tried_once(folder: Path) -> None:
    text = TEXT.replace("TERM", "").replace("INTEGRATOR", "cvode").replace("KIND", "jacobi")
    other = "  display: {kind: programme, outputs: {shown: {unit: cm, points: [[0 s, 0 cm], [2 s, 400 cm]], "
    other += "interpolation: linear}, seen: {unit: m, points: [[0 s, 0 m], [2 s, 4 m]], interpolation: linear}}}\n"
    found = _fits(folder, text.replace("components:\n", f"components:\n{other}"))
    seen = {i.of for (_, place), f in found.items() if place.startswith("rig.") for i in f.placed.inputs}
    assert len(seen & {"display.shown", "display.seen"}) == 1
