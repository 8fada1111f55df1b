"""Scenario files: what is read, what is refused, and with which words."""

import json
from pathlib import Path

import jsonschema
import pytest
import yaml

from cosim.assemble import assemble
from cosim.scenario import json_schema, load_scenario, parse_scenario, scenario_folder, shipped_scenarios
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue, conversion

SHIPPED = sorted(shipped_scenarios())
BASE = load_scenario("passive_drape")


def changed(path, value, base="passive_drape"):
    """Text of a shipped scenario with the key at `path` replaced; None deletes it."""
    data = yaml.safe_load(shipped_scenarios()[base].read_text())
    node = data
    for key in path[:-1]:
        node = node[key]
    if value is None:
        del node[path[-1]]
    else:
        node[path[-1]] = value
    return yaml.safe_dump(data)


@pytest.mark.parametrize("name", SHIPPED)
def test_every_shipped_scenario_survives_a_round_trip(name):
    scenario = load_scenario(name)
    again = parse_scenario(scenario.to_yaml(), scenario.path)
    assert again == scenario


@pytest.mark.parametrize("name", SHIPPED)
def test_every_shipped_scenario_satisfies_the_schema(name):
    data = yaml.safe_load(shipped_scenarios()[name].read_text())
    jsonschema.Draft202012Validator(json_schema()).validate(data)


def test_the_schema_file_for_editors_is_up_to_date():
    stored = json.loads((scenario_folder() / "scenario.schema.json").read_text())
    assert stored == json_schema(), "run `cosim schema > scenarios/scenario.schema.json`"


@pytest.mark.parametrize("name", SHIPPED)
def test_every_shipped_scenario_points_editors_to_the_schema(name):
    first = shipped_scenarios()[name].read_text().splitlines()[0]
    assert first == "# yaml-language-server: $schema=scenario.schema.json"


FABRIC = ("components", "fabric")
STIFFNESS = ("components", "coil", "outputs", "stiffness")
WRONG = [
    (("colour",), "blue", "colour", "there is no such key"),
    (("path",), "elsewhere.yaml", "path", "there is no such key"),
    (("time", "stop"), "1e999 s", "time.stop", "`1e999 s` is not a finite number"),
    (("time", "stop"), "1e308 year", "time.stop", "is too large"),
    (("time", "stop"), "5 V", "time.stop", "is no quantity in s"),
    (("time", "stop"), 5, "time.stop", "has no unit; write for example `5 s`"),
    (("time", "stop"), "-1 s", "time", "must come after start"),
    (("time", "output_step"), "15 ms", "time", "must be a multiple of macro_step"),
    (("time", "macro_step"), "0 s", "time.macro_step", "must be greater than 0 s"),
    (("time", "macro_step"), "0.3 ns", "time", "whole number of nanoseconds"),
    (("time", "stop"), ".nan s", "time.stop", "not a number with a unit"),
    (("time", "stop"), None, "time.stop", "this key is missing"),
    ((*FABRIC, "rows"), 1, "components.fabric", "`1` must be at least 3"),
    ((*FABRIC, "tether", "kind"), "nailed", "components.fabric", "it is one of: cantilever, hanging"),
    (
        (*FABRIC, "kind"),
        "cloth",
        "components.fabric",
        "`kind` must be one of: programme, ngspice, fmu, actuator, bullet_fabric",
    ),
    ((*FABRIC, "solver"), {"micro_step": "0.3 ms"}, "components.fabric.solver.micro_step", "whole number of steps"),
    ((*FABRIC, "solver"), {"iterations": 0}, "iterations", "`0` must be at least 1"),
    (
        ("connections",),
        ["coil.stiffness = fabric.stiffness"],
        "connections[1]",
        "write `component.output -> component.in",
    ),
    (("algorithm",), {"kind": "jacobi", "order": ["coil"]}, "algorithm.order", "every component once"),
    (STIFFNESS, {"unit": "N/m"}, "components.coil", "either `constant` or `points`"),
    (
        STIFFNESS,
        {"unit": "N/m", "points": [["0 s", "1 N/m"], ["5 ms", "2 N/m"]]},
        "components.coil.outputs.stiffness",
        "not a whole number of macro-steps",
    ),
    (STIFFNESS, {"unit": "N/m", "constant": "3 K"}, "components.coil", "no quantity"),
]


@pytest.mark.parametrize(("path", "value", "key", "what"), WRONG)
def test_a_wrong_scenario_names_file_key_and_fault(path, value, key, what):
    with pytest.raises(InputError) as caught:
        parse_scenario(changed(path, value), Path("mine.yaml"))
    assert caught.value.source == "mine.yaml"
    assert key in f"{caught.value.key}: {caught.value.problem}"
    assert what in caught.value.problem
    assert caught.value.remedy


def test_all_faults_are_listed_at_once():
    text = changed(("time", "stop"), "5 V").replace("title:", "headline:")
    with pytest.raises(InputError) as caught:
        parse_scenario(text, Path("mine.yaml"))
    assert all(word in str(caught.value) for word in ("time.stop", "headline", "title"))


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("title: [", "not valid YAML"),
        ("- a\n- b\n", "a scenario is a mapping"),
        ("title: a\ntitle: b\n", "the key `title` stands twice"),
        ("", "a scenario is a mapping"),
        ("? [a, b]\n: c\n", "line 1, column 3: not valid YAML: a list or mapping is no key"),
        ("title: 2026-02-31\n", "not valid YAML"),
        ("[" * 5000, "not valid YAML"),
        ("title: !!python/object/apply:os.getcwd []\n", "could not determine a constructor"),
    ],
)
def test_text_that_is_no_scenario_is_refused(text, what):
    with pytest.raises(InputError, match=what):
        parse_scenario(text, Path("mine.yaml"))


def test_an_unknown_name_lists_the_shipped_scenarios():
    with pytest.raises(InputError, match="passive_drape"):
        load_scenario("nothing_like_it")


ASSEMBLED = [
    ((*FABRIC, "parameters"), {"link_mass": "-7 g"}, "parameters.link_mass: it is -0.007 kg"),
    ((*FABRIC, "parameters"), {"width": "30 mm"}, "cannot be woven"),
    ((*FABRIC, "parameters"), {"bar_diameter": "12 mm"}, "cannot be woven"),
    ((*FABRIC, "parameters"), {"colour": 1}, "a fabric has no parameter `colour`"),
    ((*FABRIC, "parameters"), {"link_mass": "7 V"}, "is no quantity in kg"),
    ((*FABRIC, "parameters"), {"gravity": "9.81 m/s^2"}, "three accelerations"),
    ((*FABRIC, "parameter_set"), "no_such_links", "there is no parameter set `no_such_links`"),
    ((*FABRIC, "tether", "rows"), 8, "leave at least one of the 8 rows free"),
    (("connections", 0), "coil.stiffness -> cloth.stiffness", "there is no component cloth"),
    (("connections", 0), "coil.colour -> fabric.stiffness", "coil has no output colour"),
    (("connections", 0), "coil.rest_length -> fabric.stiffness", "m cannot be converted to N/m"),
    (("connections", 0), "coil.rest_length -> fabric.rest_length", "fabric.rest_length"),
]


@pytest.mark.parametrize(("path", "value", "what"), ASSEMBLED)
def test_what_only_the_units_can_tell_is_refused_before_the_run(path, value, what):
    scenario = parse_scenario(changed(path, value), Path("mine.yaml"))
    with pytest.raises(InputError) as caught:
        assemble(scenario)
    assert what in str(caught.value)
    assert "mine.yaml" in str(caught.value)


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"value": 1.0, "unit": "mm"}, "source"),
        ({"value": 1.0, "unit": "blobs", "source": "a guess"}, "blobs"),
        ({"value": 1.0, "unit": "mm", "source": "a guess", "colour": 1}, "colour"),
        ({"value": ".inf", "unit": "mm", "source": "a guess"}, "not a number with a unit"),
        ({"value": "1 cm", "unit": "mm", "source": "a guess"}, "give the unit of `1 cm` under `unit`"),
    ],
)
def test_a_parameter_needs_value_unit_and_source(tmp_path, change, what):
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump({"title": "mine", "parameters": {"tolerance": change}}))
    text = changed((*FABRIC, "parameter_set"), "mine.yaml")
    with pytest.raises(InputError, match=what):
        assemble(parse_scenario(text, tmp_path / "scenario.yaml"))


def test_a_parameter_that_stands_twice_is_refused(tmp_path):
    one = "  tolerance: {value: 1, unit: mm, source: a guess}\n"
    (tmp_path / "mine.yaml").write_text(f"title: mine\nparameters:\n{one}{one}")
    with pytest.raises(InputError, match="line 4, column 3: not valid YAML: the key `tolerance` stands twice"):
        assemble(parse_scenario(changed((*FABRIC, "parameter_set"), "mine.yaml"), tmp_path / "scenario.yaml"))


def test_a_fault_in_a_component_is_named_by_the_keys_of_the_file():
    wrong = [
        ((*FABRIC, "parameters"), {"link_mass": "seven"}, "components.fabric.parameters.link_mass"),
        ((*FABRIC, "solver"), {"micro_step": "1 mm"}, "components.fabric.solver.micro_step"),
        (("components", "coil", "outputs", "stiffness", "constant"), "x", "components.coil.outputs.stiffness.constant"),
    ]
    for path, value, key in wrong:
        with pytest.raises(InputError) as caught:
            parse_scenario(changed(path, value), Path("mine.yaml"))
        assert caught.value.key == key


@pytest.mark.parametrize(
    ("text", "unit", "number"),
    [
        ("22 degC", "K", 295.15),
        ("0.1571 N/mm", "N/m", 157.1),
        ("0.5 ms", "s", 5e-4),
        ("7.328 mm^3", "m^3", 7.328e-9),
        ("12 delta_degC/s", "K/s", 12.0),
        ("1e-3 1/K", "1/K", 1e-3),
        (" 6V ", "V", 6.0),
    ],
)
def test_quantities_convert_without_binary_debris(text, unit, number):
    assert PhysicalValue.parse(text).to(unit) == number


def test_connections_convert_offsets_too():
    assert conversion("degC", "K") == (1.0, 273.15)
    assert conversion("mm", "m") == (0.001, 0.0)
    with pytest.raises(ValueError, match="cannot be converted"):
        conversion("V", "A")
