"""Terms that change a parameter of an FMU while it runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.fmu.moved_parameter import change
from cosim.run import RunStopped, run
from cosim.scenario import load_scenario
from cosim.ssp.command import scenario_of
from cosim.ssp.export import export_ssp
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.placed import Placed
from diagnosis.models.systems.places import fits, places_of
from diagnosis.models.systems.quantities import Places
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.fmi.fmi_models import build
from tests.systems.rigs import diagnosed, held, write_recording

#: A winding that warms itself; with `k` its resistance grows with the temperature.
NUMBERS = {
    "L": (2.0, "H"),
    "R": (1.5, "ohm"),
    "C": (40.0, "J/K"),
    "h": (0.3, "W/K"),
    "T_0": (293.15, "K"),
}
STATES = {
    "i": ("A", "0", "(u - RES*i)/L"),
    "T": ("K", "T_0", "(RES*i*i - h*(T - T_0))/C"),
}


def _winding(name: str, resistance: str, **more: tuple[float, str]) -> OdeModel:
    states = {n: (unit, start, rate.replace("RES", resistance)) for n, (unit, start, rate) in STATES.items()}
    outputs = {"current": ("A", "i"), "temperature": ("K", "T"), "heat": ("W", f"{resistance}*i*i")}
    return OdeModel(name, {**NUMBERS, **more}, {"u": "V"}, states, outputs)


PLAIN = _winding("winding", "R")
TRUTH = _winding("truth", "R*(1.0 + k*(T - T_0))", k=(0.004, "1/K"))
CONDUCTIVE = _winding("conductive", "1.0/G", G=(1.0 / 1.5, "S"))
TERM = "{to: parameter(R), is_share: true, formula: k * (T - T_b), parameters: {k: 0.004 1/K, T_b: 293.15 K}}"
SCENARIO = """
title: A winding
time: {stop: 400 s, macro_step: 0.5 s, output_step: 0.5 s}
components:
  drive: {kind: programme, outputs: {u: {unit: V, points: [[0 s, 6 V], [150 s, 9 V], [260 s, 3 V]]}}}
  winding:
    kind: fmu
    fmu: NAME.fmu
    integrator: cvode
    MORE
connections: [drive.u -> winding.u]
"""


def _scenario(folder: Path, model: OdeModel, more: str = "") -> Path:
    model.build(folder)
    path = folder / f"{model.name}.yaml"
    path.write_text(SCENARIO.replace("NAME", model.name).replace("MORE", more), encoding="utf-8")
    return path


@pytest.mark.parametrize("power", [1.0, -1.0])
def test_what_a_parameter_does_is_exact_in_proportion_and_in_its_reciprocal(power: float) -> None:
    three = [np.array([3.0 + 2.0 * (1.0 + s) ** power]) for s in (-0.25, 0.0, 0.25)]
    for share in (-0.6, -0.1, 0.0, 0.2, 1.5):
        assert change(share, *three)[0] == pytest.approx(2.0 * (1.0 + share) ** power - 2.0, abs=1e-12)


@pytest.mark.parametrize(("power", "most"), [(2.0, 0.02), (0.5, 0.02), (-2.0, 0.02), (3.0, 0.04)])
def test_other_powers_are_met_to_a_few_per_cent_within_a_third(power: float, most: float) -> None:
    three = [np.array([(1.0 + s) ** power]) for s in (-0.25, 0.0, 0.25)]
    for share in np.linspace(-0.3, 0.3, 13):
        true = (1.0 + share) ** power
        assert 1.0 + change(float(share), *three)[0] == pytest.approx(true, rel=most)


def test_what_does_not_move_with_a_parameter_stays_and_what_turns_is_a_parabola() -> None:
    here = np.array([1.0, 0.0])
    found = change(0.5, np.array([1.0, 0.0625]), here, np.array([1.0, 0.0625]))
    np.testing.assert_allclose(found, [0.0, 0.25])


def test_a_parameter_that_would_change_its_sign_is_no_number() -> None:
    assert np.isnan(change(-1.0, np.array([0.75]), np.array([1.0]), np.array([1.25]))[0])


def test_a_resistance_that_grows_with_the_temperature_is_that_of_equations_that_have_it(tmp_path: Path) -> None:
    """States and an output that holds the parameter; by the co-simulation and by compiled code."""
    expected = run(load_scenario(str(_scenario(tmp_path, TRUTH))))
    path = _scenario(tmp_path, PLAIN, f"added_terms: [{TERM}]")
    found = run(load_scenario(str(path)))
    system = FastSystem(load_scenario(str(path)))
    system.set_substeps(2)
    rows = system.simulate()
    assert rows is not None
    plain = run(load_scenario(str(_scenario(tmp_path, PLAIN))))
    for name in ("current", "temperature", "heat"):
        true = expected[f"winding.{name}"].to_numpy()
        size = float(np.std(true))
        assert float(np.max(np.abs(plain[f"winding.{name}"].to_numpy() - true))) > 0.1 * size
        np.testing.assert_allclose(found[f"winding.{name}"].to_numpy(), true, atol=1e-5 * size)
        np.testing.assert_allclose(rows.values[:, system.recorded["winding", name]].ravel(), true, atol=1e-4 * size)
    system.close()


def test_a_conductance_that_falls_by_its_reciprocal_is_the_same(tmp_path: Path) -> None:
    term = TERM.replace("parameter(R)", "parameter(G)").replace("k * (T - T_b)", "1/(1 + k*(T - T_b)) - 1")
    expected = run(load_scenario(str(_scenario(tmp_path, TRUTH))))
    found = run(load_scenario(str(_scenario(tmp_path, CONDUCTIVE, f"added_terms: [{term}]"))))
    true = expected["winding.heat"].to_numpy()
    np.testing.assert_allclose(found["winding.heat"].to_numpy(), true, atol=1e-5 * float(np.std(true)))


BESIDE = "{to: u, formula: -0.5 * u}, {to: der(T), formula: q, parameters: {q: 0.02 K/s}}"


def test_beside_terms_at_an_input_and_a_derivative_both_simulators_agree(tmp_path: Path) -> None:
    path = _scenario(tmp_path, PLAIN, f"added_terms: [{BESIDE}, {TERM}]")
    found = run(load_scenario(str(path)))
    system = FastSystem(load_scenario(str(path)))
    system.set_substeps(2)
    rows = system.simulate()
    assert rows is not None
    equations = {n: (u, s, r.replace("(u -", "(0.5*u -")) for n, (u, s, r) in TRUTH.states.items()}
    unit, start, rate = equations["T"]
    equations["T"] = unit, start, f"{rate} + 0.02"
    both = OdeModel("both", TRUTH.parameters, TRUTH.inputs, equations, TRUTH.outputs)
    expected = run(load_scenario(str(_scenario(tmp_path, both))))
    for name in ("current", "temperature", "heat"):
        true = expected[f"winding.{name}"].to_numpy()
        size = float(np.std(true))
        np.testing.assert_allclose(found[f"winding.{name}"].to_numpy(), true, atol=1e-5 * size)
        np.testing.assert_allclose(rows.values[:, system.recorded["winding", name]].ravel(), true, atol=1e-4 * size)
    system.close()


@pytest.mark.parametrize(
    ("term", "where", "what"),
    [
        (TERM.replace("(R)", "(Q)"), "to", "no floating-point parameter `Q`.*"),
        (TERM.replace(" is_share: true,", ""), "is_share", "a share of its value"),
        (TERM.replace("k * (T - T_b)", "k * T * R"), "formula", "R"),
        (TERM.replace("k * (T - T_b)", "T - T_b"), "formula", ""),
        (f"{TERM}, {TERM}", "to", "two terms change `R`"),
    ],
)
def test_a_change_that_cannot_be_is_refused(tmp_path: Path, term: str, where: str, what: str) -> None:
    path = _scenario(tmp_path, PLAIN, f"added_terms: [{term}]")
    with pytest.raises(InputError, match=rf"added_terms\[\d\].{where}.*{what}"):
        run(load_scenario(str(path)))


def test_a_parameter_of_zero_is_refused(tmp_path: Path) -> None:
    path = _scenario(tmp_path, PLAIN, f"parameters: {{R: 0 ohm}}\n    added_terms: [{TERM}]")
    with pytest.raises(InputError, match="`R` is 0"):
        run(load_scenario(str(path)))


def test_an_fmu_that_solves_itself_is_refused(tmp_path: Path) -> None:
    path = _scenario(tmp_path, PLAIN, f"added_terms: [{TERM}]")
    path.write_text(path.read_text(encoding="utf-8").replace("cvode", "internal"), encoding="utf-8")
    with pytest.raises(InputError, match="use `integrator: cvode`"):
        run(load_scenario(str(path)))


def test_a_run_stops_where_the_parameter_would_change_its_sign(tmp_path: Path) -> None:
    term = "{to: parameter(R), is_share: true, formula: w * time, parameters: {w: -0.01 1/s}}"
    path = _scenario(tmp_path, PLAIN, f"added_terms: [{term}]")
    with pytest.raises(RunStopped, match="parameter R changes it by"):
        run(load_scenario(str(path)))


def _diagnosed(folder: Path, k: float) -> Diagnosis:
    """Three runs of a winding whose numbers are 3 % off; noise of 10 mA and 0.2 K."""
    path = _scenario(folder, PLAIN)
    every = []
    for number in range(3):
        rng = np.random.default_rng(20 + number)
        volts = np.repeat(rng.uniform(0.0, 9.0, 20), 40)

        def rate(x: Array, u: float) -> Array:
            resistance = 1.47 * (1.0 + k * (x[1] - 293.15))
            return np.array([(u - resistance * x[0]) / 2.0, (resistance * x[0] ** 2 - 0.309 * (x[1] - 293.15)) / 39.0])

        states = held(rate, np.array([0.0, 293.15]), volts, 0.5)
        columns = {
            "t": 0.5 * np.arange(len(states)),
            "U": volts,
            "I": states[:, 0] + 0.01 * rng.standard_normal(len(states)),
            "T": states[:, 1] + 0.2 * rng.standard_normal(len(states)),
        }
        channels = {"winding.current": ("I", "A", "0.01 A"), "winding.temperature": ("T", "K", "0.2 K")}
        every.append(
            load_recording(write_recording(folder / f"run_{number}", columns, {"drive.u": ("U", "V")}, channels))
        )
    return diagnosed(path, every)


def test_a_resistance_that_grows_with_the_temperature_is_found_with_its_coefficient(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, 0.004)
    assert found.verdict is Verdict.UNNAMED_PHYSICS
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.place) == ("parameter_change_of_T", "winding.R")
    assert "parameter that changes with a quantity (T)), winding.R" in finding.statement
    assert finding.law == "parameter(R) *= 1 + a * (T - o_0), o_0 = 293.1 K"
    assert finding.parameters[0].value == pytest.approx(0.004, rel=0.01)
    assert finding.parameters[0].unit == "1/K"


def test_a_winding_whose_resistance_stays_has_no_such_law(tmp_path: Path) -> None:
    assert not [f for f in _diagnosed(tmp_path, 0.0).findings if f.is_accepted]


def _places(folder: Path, model: OdeModel) -> Places:
    system = FastSystem(load_scenario(str(_scenario(folder, model))))
    try:
        return places_of([system])[0]
    finally:
        system.close()


def test_parameters_of_the_derivatives_may_change_and_a_start_temperature_may_not(tmp_path: Path) -> None:
    found = _places(tmp_path, PLAIN).parameters
    assert {n: c.moves for n, c in found.items()} == {"R": ("i", "T"), "L": ("i",), "C": ("T",), "h": ("T",)}


def test_parameters_that_act_as_a_product_are_one_place_that_names_both(tmp_path: Path) -> None:
    states = {n: (unit, start, rate.replace("h*", "u_wall*area*")) for n, (unit, start, rate) in PLAIN.states.items()}
    numbers = {**NUMBERS, "u_wall": (30.0, "W/m^2/K"), "area": (0.01, "m^2")}
    model = OdeModel("wall", numbers, PLAIN.inputs, states, PLAIN.outputs)
    own = _places(tmp_path, model)
    assert "h" not in own.parameters
    assert own.parameters["u_wall"].alike == ("area",)
    (law,) = [f for f in fits([own], library(), 1.0) if f.placed.to == "parameter(u_wall)"][:1]
    assert law.term.law.endswith("or parameter(area) alike")


def _many() -> OdeModel:
    """Ten losses of a lump, of which each is a parameter."""
    numbers = {f"loss_{n}": (0.01 * (n + 1), "W/K") for n in range(10)}
    sum_of = " + ".join(numbers)
    rate = {"T": ("K", "300", f"(power - ({sum_of})*(T - 293.15))/50.0")}
    return OdeModel("many", numbers, {"power": "W"}, rate, {"temperature": ("K", "T")})


def test_instances_of_parameters_that_were_asked_for_long_ago_are_made_again(tmp_path: Path) -> None:
    """A lump of ten losses, one of which grows by a third: the same before and after all others were asked."""
    _many().build(tmp_path)
    text = SCENARIO.replace("NAME", "many").replace("MORE", "").replace("V", "W").replace("winding.u", "winding.power")
    path = tmp_path / "many.yaml"
    path.write_text(text, encoding="utf-8")
    strength = (("a", "1"),)
    laws = [Placed("winding", f"parameter(loss_{n})", "a", strength, is_share=True) for n in range(10)]
    system = FastSystem(load_scenario(str(path)), laws)
    column = system.recorded["winding", "temperature"]

    def course(*numbers: int) -> Array | None:
        rows = system.simulate(laws=dict.fromkeys(numbers, (1.0 / 3.0,)))
        return None if rows is None else rows.values[:, column].ravel().copy()

    first, plain = course(9), course()
    assert first is not None
    assert plain is not None
    assert all(course(n) is not None for n in range(9))
    again = course(9)
    assert again is not None
    np.testing.assert_array_equal(again, first)
    assert float(np.max(np.abs(first - plain))) > 0.1
    assert course(*range(8)) is not None
    assert course(*range(9)) is None
    system.close()


def test_a_parameter_beside_whose_value_the_equations_have_none_is_no_place(tmp_path: Path) -> None:
    states = {**PLAIN.states, "i": ("A", "0", "(u - R*i)/L*sqrt(0.5 - edge)")}
    model = OdeModel("edge", {**NUMBERS, "edge": (0.45, "1")}, PLAIN.inputs, states, PLAIN.outputs)
    assert set(_places(tmp_path, model).parameters) == {"R", "L", "C", "h"}


def test_an_fmu_with_events_says_that_its_parameters_were_not_tried(tmp_path: Path) -> None:
    """It climbs a stair every 0.3 s."""
    path = tmp_path / "stair.yaml"
    stair = build("stair", 2, tmp_path)
    text = "{title: A stair, time: {stop: 2 s, macro_step: 0.1 s, output_step: 0.1 s}, components: {stair: FMU}}"
    fmu = f"{{kind: fmu, fmu: '{stair}', integrator: cvode}}"
    path.write_text(text.replace("FMU", fmu), encoding="utf-8")
    system = FastSystem(load_scenario(str(path)))
    (own,) = places_of([system])
    assert own.parameters == {}
    (said,) = [t for t in own.untried if "parameter" in t]
    assert said.startswith("no parameter of `stair` was tried as one that changes: it has time events")
    system.close()


class _Limited(OdeModel):
    """An FMU that keeps its heat capacity at 40 J/K at most."""

    def source(self, guid: str) -> str:
        kept = "m->p[k] = k == 2 && v[i] > 40.0 ? 40.0 : v[i]; continue;"
        found = super().source(guid).replace("m->p[k] = v[i]; continue;", kept)
        assert kept in found
        return found


def test_a_parameter_that_the_fmu_limits_is_no_place(tmp_path: Path) -> None:
    limited = _Limited("limited", NUMBERS, PLAIN.inputs, PLAIN.states, PLAIN.outputs)
    assert set(_places(tmp_path, limited).parameters) == {"R", "L", "h"}


def test_a_term_at_such_a_parameter_is_refused(tmp_path: Path) -> None:
    limited = _Limited("limited", NUMBERS, PLAIN.inputs, PLAIN.states, PLAIN.outputs)
    path = _scenario(tmp_path, limited, f"added_terms: [{TERM.replace('(R)', '(C)')}]")
    with pytest.raises(InputError, match="the FMU does not take 50: it keeps 40"):
        run(load_scenario(str(path)))


def test_a_scenario_with_such_a_term_returns_from_ssp(tmp_path: Path) -> None:
    scenario = load_scenario(str(_scenario(tmp_path, PLAIN, f"added_terms: [{TERM}]")))
    export_ssp(scenario, tmp_path / "winding.ssp")
    again = scenario_of(tmp_path / "winding.ssp", tmp_path / "again")
    expected, found = (run(s)["winding.heat"].to_numpy() for s in (scenario, again))
    np.testing.assert_array_equal(found, expected)
