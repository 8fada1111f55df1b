"""Swapping the actuator is one line: for every ordered pair the run is that of a scenario written for the other."""

import itertools

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import parse_scenario
from cosim.shipped import shipped_actuators

from .scenarios import short

ACTUATORS = sorted(shipped_actuators())
#: Written by hand for each actuator: every connection, its size and its parameter set.
CONNECTIONS = {
    "thermal_stiffness": ("niti_paper", ["circuit.power -> actuator.power"]),
    "instant_stiffness": ("niti_instant", ["circuit.power -> actuator.power"]),
    "niti_kinetics": ("niti_kinetics", ["circuit.power -> actuator.power", "load.tension -> actuator.tension"]),
    "tcp_muscle": ("tcp_muscle", ["circuit.power -> actuator.power"]),
    "polypyrrole_film": ("polypyrrole_film", ["circuit.voltage -> actuator.voltage"]),
}
TEXT = """
title: written for {name}
time: {{start: 0 s, stop: 4 s, macro_step: 10 ms, output_step: 50 ms, checkpoint_step: 1 s}}
algorithm: {{kind: gauss_seidel, order: [supply, room, circuit, actuator, load]}}
components:
  supply: {{kind: programme, outputs: {{voltage: {{unit: V, points: [[0 s, 0 V], [1 s, 6 V], [3 s, 0 V]]}}}}}}
  room: {{kind: programme, outputs: {{temperature: {{unit: K, constant: 22 degC}}}}}}
  circuit: {{kind: ngspice, strings: [6], start: {{resistance: 2.2 ohm}}}}
  actuator: {{kind: fmu, fmu: {name}, fmi: {fmi}, structure: {{coils: 6}}, parameter_set: {parameters}}}
  load: {{kind: hanging_mass, coils: 6, mass: 100 g}}
connections:
  - supply.voltage -> circuit.supply_voltage
  - room.temperature -> actuator.ambient_temperature
  - actuator.resistance -> circuit.resistance
  - actuator.stiffness -> load.stiffness
  - actuator.rest_length -> load.rest_length
"""


@pytest.fixture(scope="module")
def written():
    """`written(name, fmi)`: run of the scenario written for an actuator, made once."""
    done = {}

    def get(name, fmi):
        if (name, fmi) not in done:
            parameters, own = CONNECTIONS[name]
            text = TEXT.format(name=name, fmi=fmi, parameters=parameters) + "".join(f"  - {c}\n" for c in own)
            done[name, fmi] = run(parse_scenario(text, short().path))
        return done[name, fmi]

    return get


@pytest.fixture(scope="module")
def swapped():
    """`swapped(a, b, fmi)`: run of the scenario text for `a` in which the one line `fmu: a` becomes `fmu: b`."""
    done = {}

    def get(first, second, fmi):
        text = short(fmu=first, fmi=fmi).to_yaml()
        line = f"    fmu: {first}\n"
        assert text.count(line) == 1
        changed = text.replace(line, f"    fmu: {second}\n")
        if changed not in done:  # the same text, from whichever scenario it came
            done[changed] = run(parse_scenario(changed, short().path))
        return done[changed]

    return get


def test_every_shipped_actuator_takes_part():
    assert set(ACTUATORS) == set(CONNECTIONS)


@pytest.mark.parametrize("fmi", [3, 2])
@pytest.mark.parametrize(("first", "second"), list(itertools.permutations(ACTUATORS, 2)))
def test_changing_one_line_gives_the_run_written_for_the_other(written, swapped, first, second, fmi):
    one, other = swapped(first, second, fmi), written(second, fmi)
    assert set(one.data_vars) == set(other.data_vars)
    for name in other.data_vars:
        assert np.array_equal(one[name], other[name]), name


@pytest.mark.parametrize("fmi", [3, 2])
@pytest.mark.parametrize(("first", "second"), list(itertools.combinations(ACTUATORS, 2)))
def test_two_actuators_do_not_give_the_same_run(written, first, second, fmi):
    one, other = written(first, fmi)["load.length"], written(second, fmi)["load.length"]
    assert float(np.abs(one - other).max()) > 1e-5  # 10 um: otherwise the test above would tell nothing


@pytest.mark.parametrize("name", ACTUATORS)
def test_both_versions_of_fmi_give_the_same_run(written, name):
    for variable, values in written(name, 3).data_vars.items():
        assert np.array_equal(values, written(name, 2)[variable]), variable
