"""A scenario that goes out as SSP and comes back gives the same trace, to the last bit: no tolerance anywhere here."""

import zipfile

import pytest

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario, shipped_scenarios
from cosim.ssp.export import export_ssp
from cosim.ssp.importer import import_ssp
from cosim.unit.errors import InputError
from tests.cosim.short_runs import changed, drape, heating, prototype, shortened, without_fabric
from tests.ssp.runs import round_trip
from tests.systems.rigs import OSCILLATOR, TANK

#: Shipped scenarios with what happens in them; of the others the first four outputs are compared.
SHORT = {
    "passive_drape": drape,
    "prototype_cantilever": prototype,
    "prototype_cantilever_instant": lambda: without_fabric("prototype_cantilever_instant"),
    "single_coil_heating": heating,
    "water_bath": lambda: shortened("water_bath", "65 s"),
}
TRUCK = """
title: Quarter truck
time: {{stop: 50 ms, macro_step: 1 ms, output_step: 2 ms, checkpoint_step: 20 ms}}
algorithm: {algorithm}
components:
  chassis: {{kind: fmu, fmu: {chassis}, parameters: {{mass: 0.41 Mg}}, start: {{z_start: 0.3}}}}
  wheel: {{kind: fmu, fmu: {wheel}}}
  ground: {{kind: fmu, fmu: {ground}, parameters: {{step_time: 20 ms}}}}
connections:
  - chassis.force -> wheel.force_in
  - wheel.velocity -> chassis.velocity_in
  - {{connect: wheel.force -> ground.force_in, factor: 1.5, offset: -0.1}}
  - ground.velocity -> wheel.velocity_in
"""


def wired(scenario):
    """Connections, in any order."""
    return sorted(map(str, scenario.connections))


def first_outputs(name):
    """The first four output steps of a shipped scenario, with a checkpoint in the middle."""
    time = load_scenario(name).time
    output = time.output_step.to("s")
    stop = f"{time.start.to('s') + 4 * output:.9g} s"
    return shortened(name, stop, checkpoint_step=f"{2 * output:.9g} s")


@pytest.mark.parametrize("name", list(shipped_scenarios()))
def test_shipped_scenarios_return_from_ssp_2_with_the_same_trace(name, tmp_path):
    scenario = SHORT[name]() if name in SHORT else first_outputs(name)
    round_trip(scenario, tmp_path, "2.0")


@pytest.mark.parametrize("version", ["1.0", "2.0"])
def test_arrays_of_fmi_2_go_out_as_scalars_and_return_as_arrays(version, tmp_path):
    scenario = changed(heating(), "actuator", fmi=2)
    again = round_trip(scenario, tmp_path, version)
    assert wired(again) == [
        "actuator.resistance -> circuit.resistance",
        "circuit.power -> actuator.power",
        "room.temperature -> actuator.ambient_temperature",
        "supply.voltage -> circuit.supply_voltage",
    ]
    assert again.components["actuator"].structure == {"coils": 6}


@pytest.mark.parametrize("version", ["1.0", "2.0"])
@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("algorithm", ["{kind: jacobi}", "{kind: gauss_seidel, order: [ground, wheel, chassis]}"])
def test_systems_of_fmus_return_with_their_algorithm(models, version, fmi, algorithm, tmp_path):
    fmus = {name: models(name, fmi) for name in ("chassis", "wheel", "ground")}
    text = TRUCK.format(algorithm=algorithm, **fmus).replace("start: {z_start: 0.3}", "parameters: {mass: 400 kg}")
    text = text.replace("parameters: {mass: 0.41 Mg}, ", "")
    scenario = parse_scenario(text, tmp_path / "truck.yaml")
    again = round_trip(scenario, tmp_path, version)
    assert again.algorithm == scenario.algorithm
    assert wired(again) == wired(scenario)


def test_elements_of_arrays_and_settings_of_ours_return(models, tmp_path):
    vector, scalar = models("vector_gain", 3), models("feedthrough", 3)
    text = f"""
title: Elements
time: {{stop: 10 ms, macro_step: 1 ms, output_step: 1 ms, checkpoint_step: 5 ms}}
components:
  source:
    kind: programme
    outputs:
      three: {{unit: "1", dim: axis, points: [[0 s, [1, 2, 3]], [5 ms, [4, 5, 6]]]}}
      one: {{unit: "1", constant: 0.1}}
  whole: {{kind: fmu, fmu: {vector}, structure: {{n: 3}}}}
  pieces: {{kind: fmu, fmu: {vector}, structure: {{n: 3}}, isolation: {{step_limit: 5 s}}}}
  filled: {{kind: fmu, fmu: {vector}, structure: {{n: 4}}}}
  single: {{kind: fmu, fmu: {scalar}, tolerance: 0.001}}
connections:
  - source.three -> whole.u
  - whole.y[3] -> pieces.u[1]
  - {{connect: "whole.y[1] -> pieces.u[2]", factor: 0.1, offset: 1.0}}
  - source.one -> pieces.u[3]
  - source.one -> filled.u
  - pieces.y[2] -> single.u
"""
    scenario = parse_scenario(text, tmp_path / "elements.yaml")
    again = round_trip(scenario, tmp_path, "2.0")
    for name in ("pieces", "single"):
        for key in ("isolation", "tolerance", "structure"):
            assert getattr(again.components[name], key) == getattr(scenario.components[name], key)
    assert wired(again) == wired(scenario)
    assert run(again)["single.y"].values[-1] == 0.1 * 4 + 1  # gain 1 in both FMUs


def test_equal_scenarios_give_equal_files(tmp_path):
    for name in ("a.ssp", "b.ssp"):
        export_ssp(heating(), tmp_path / name)
    assert (tmp_path / "a.ssp").read_bytes() == (tmp_path / "b.ssp").read_bytes()


def test_the_archive_is_as_the_standard_asks(tmp_path):
    export_ssp(heating(), tmp_path / "a.ssp")
    with zipfile.ZipFile(tmp_path / "a.ssp") as archive:
        entries = archive.infolist()
    assert entries[0].filename == "SystemStructure.ssd"
    assert all(e.filename.startswith("resources/") for e in entries[1:])
    assert {e.compress_type for e in entries} == {zipfile.ZIP_DEFLATED}
    assert max(e.extract_version for e in entries) <= 20
    assert all(e.flag_bits & ~0x800 == 0 for e in entries)


def test_parameters_keep_their_sources(tmp_path):
    export_ssp(heating(), tmp_path / "a.ssp")
    result = import_ssp(tmp_path / "a.ssp", tmp_path / "in")
    text = (tmp_path / "in" / "parameter_sets" / "actuator.yaml").read_text()
    assert "measured resistance of one coil" in text
    assert result.names == {}


def test_arrays_of_fmi_3_do_not_fit_into_ssp_1(tmp_path):
    with pytest.raises(InputError, match=r"SSP 1\.0.*`power` is an array of FMI 3\.0.*\n.*export as SSP 2\.0"):
        export_ssp(heating(), tmp_path / "a.ssp", "1.0")
    assert not (tmp_path / "a.ssp").exists()


AMENDED = """
title: A slide and a tank with terms
time: {stop: 200 ms, macro_step: 5 ms, output_step: 10 ms, checkpoint_step: 100 ms}
components:
  drive: {kind: programme, outputs: {u: {unit: V, constant: 1 V}, flow: {unit: m^3/s, constant: 0.01 m^3/s}}}
  slide:
    kind: fmu
    fmu: oscillator.fmu
    integrator: cvode
    added_terms:
      - to: der(v)
        formula: -branch * (x - slack) - limit * tanh(v / rounding)
        parameters: {branch: 150 1/s^2, time_constant: 50 ms, limit: 2 m/s^2, rounding: 1 cm/s}
        states: {slack: {rate: (x - slack) / time_constant, start: x, unit: m}}
  tank:
    kind: fmu
    fmu: tank.fmu
    added_terms:
      - {to: outflow, formula: -share * outflow, parameters: {share: 0.2}}
connections:
  - drive.u -> slide.u
  - drive.flow -> tank.inflow
"""


def test_terms_that_are_added_to_fmus_go_out_and_come_back(tmp_path):
    for model in (OSCILLATOR, TANK):
        model.build(tmp_path)
    scenario = parse_scenario(AMENDED, tmp_path / "scenario.yaml")
    again = round_trip(scenario, tmp_path, "2.0")
    assert again.components["slide"].added_terms == scenario.components["slide"].added_terms
    assert [t.to for t in again.components["tank"].added_terms] == ["outflow"]
    notes = export_ssp(scenario, tmp_path / "again.ssp")
    assert notes == tuple(
        f"other tools run `{name}` without the terms that are added to it" for name in ("slide", "tank")
    )
