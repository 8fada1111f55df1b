"""An actuator connects itself: which connections are made, where size and parameters come from."""

import numpy as np
import pytest

from cosim.actuator.resolve import PARAMETER_SETS
from cosim.assemble import assemble
from cosim.run import run
from cosim.run_folder import RunFolder
from cosim.scenario import load_scenario, parse_scenario, scenario_folder
from cosim.shipped import shipped_actuators
from cosim.unit.errors import InputError

from .scenarios import changed, quantity, short

ALWAYS = {
    "supply.voltage -> circuit.supply_voltage",
    "room.temperature -> actuator.ambient_temperature",
    "actuator.resistance -> circuit.resistance",
    "actuator.stiffness -> load.stiffness",
    "actuator.rest_length -> load.rest_length",
}
OWN = {
    "thermal_stiffness": {"circuit.power -> actuator.power"},
    "instant_stiffness": {"circuit.power -> actuator.power"},
    "niti_kinetics": {"circuit.power -> actuator.power", "load.tension -> actuator.tension"},
    "tcp_muscle": {"circuit.power -> actuator.power"},
    "polypyrrole_film": {"circuit.voltage -> actuator.voltage"},
}


def resolved(scenario):
    assembly = assemble(scenario)
    assembly.system.terminate()
    return assembly.scenario


@pytest.mark.parametrize("name", sorted(OWN))
def test_each_actuator_gets_the_connections_that_it_has_variables_for(name):
    found = resolved(short(fmu=name))
    assert set(found.connections) == ALWAYS | OWN[name]
    assert len(found.connections) == len(set(found.connections))


def test_every_shipped_actuator_has_a_parameter_set_with_its_own_start_values():
    for name in shipped_actuators():
        chosen = resolved(short(fmu=name)).components["actuator"].parameter_set
        assert chosen == PARAMETER_SETS.get(name, name)
        assert (scenario_folder() / "parameter_sets" / f"{chosen}.yaml").is_file()
    assert resolved(short(fmu="tcp_muscle", parameter_set=None)).components["actuator"].parameter_set == "tcp_muscle"


def test_the_result_is_that_of_the_connections_written_out():
    text = short().to_yaml()
    plain = resolved(short())
    written = parse_scenario(plain.to_yaml(), load_scenario("hanging_coils").path)
    assert written.components["actuator"].kind == "fmu"
    assert "kind: actuator" in text
    one, other = run(short()), run(written)
    for name in one.data_vars:
        assert np.array_equal(one[name], other[name]), name


def test_the_run_folder_records_the_resolved_connections_and_can_be_resumed_from(tmp_path):
    run(short(), tmp_path / "run")
    record = load_scenario(RunFolder(tmp_path / "run").scenario)
    assert set(record.connections) == ALWAYS | OWN["thermal_stiffness"]
    assert record.components["actuator"].structure == {"coils": 6}
    assert record.components["actuator"].parameters["volume"] == quantity("7.328 mm^3")
    again = run(record)
    assert np.array_equal(again["actuator.stiffness"], run(short())["actuator.stiffness"])


def test_a_connection_that_is_written_takes_the_place_of_the_one_made():
    heater = load_scenario("water_bath").components["current_off"]
    scenario = short()
    components = {"heater": heater, **scenario.components}
    algorithm = scenario.algorithm.model_copy(update={"order": list(components)})
    connections = [*scenario.connections, "heater.power -> actuator.power"]
    changes = {"components": components, "algorithm": algorithm, "connections": connections}
    found = resolved(scenario.model_copy(update=changes))
    assert "heater.power -> actuator.power" in found.connections
    assert "circuit.power -> actuator.power" not in found.connections


def test_the_size_comes_from_the_neighbours_and_an_fmu_of_fmi_2_is_found_by_it():
    for fmi in (2, 3):
        assembly = assemble(short(fmi=fmi))
        assembly.system.terminate()
        assert assembly.system.units["actuator"].variables["stiffness"].shape == (6,)
        assert assembly.scenario.components["actuator"].structure == {"coils": 6}
    assert "thermal_stiffness_fmi2_n6.fmu" in assemble_version(short(fmi=2))


def assemble_version(scenario):
    assembly = assemble(scenario)
    assembly.system.terminate()
    return assembly.versions["FMU of actuator"]


WRONG = [
    (lambda: short(electrical="battery"), "components.actuator.electrical", "there is no component `battery`"),
    (lambda: short(mechanical="actuator"), "components.actuator.mechanical", "there is no component `actuator`"),
    (lambda: short(electrical="room"), "components.actuator.electrical", "`room` gives no `power` to this actuator"),
    (lambda: short(fmu="polypyrrole_film", electrical="room"), "components.actuator.electrical", "no `voltage`"),
    (lambda: short(ambient="supply"), "components.actuator.ambient", "`supply` gives no `ambient_temperature`"),
    (lambda: short(mechanical="circuit"), "components.actuator.mechanical", "`circuit` takes no stiffness"),
    (
        lambda: changed(short(), "load", coils=5),
        "components.actuator",
        r"electrical (circuit): 6, mechanical (load): 5",
    ),
    (lambda: short(structure={"coils": 7}), "components.actuator", "structure: 7"),
    (lambda: short(parameter_set="prototype_links"), "parameters", "no such parameter"),
]


@pytest.mark.parametrize(("make", "key", "what"), WRONG)
def test_a_neighbour_that_does_not_fit_is_named_with_its_key(make, key, what):
    with pytest.raises(InputError) as caught:
        assemble(make())
    assert key in caught.value.key
    assert what in caught.value.problem
    assert caught.value.remedy


def test_an_fmu_of_fmi_2_of_another_size_is_refused_with_both_sizes(fmus):
    with pytest.raises(InputError, match="is built for 36 coils, its neighbours have 6"):
        assemble(short(fmu=str(fmus / "thermal_stiffness_fmi2.fmu")))
