"""Scenario files under generated changes, and what the JSON Schema accepts."""

import copy

import jsonschema
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cosim.scenario import Scenario, json_schema, parse_scenario, scenario_folder, shipped_scenarios
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue, conversion

DATA = {name: yaml.safe_load(path.read_text()) for name, path in shipped_scenarios().items()}
SOURCE = scenario_folder() / "mine.yaml"
UNITS = ("s", "ms", "V", "mV", "K", "degC", "m", "mm", "N/m", "N/mm", "kg", "g", "W/(m^2*K)", "ohm", "1/K", "%")


def places(node, here=()):
    """Every place inside a mapping or list."""
    if isinstance(node, dict):
        for key, value in node.items():
            yield (*here, key)
            yield from places(value, (*here, key))
    elif isinstance(node, list):
        for index, value in enumerate(node):
            yield (*here, index)
            yield from places(value, (*here, index))


def replaced(data, place, value):
    data = copy.deepcopy(data)
    node = data
    for key in place[:-1]:
        node = node[key]
    node[place[-1]] = value
    return data


FEW = ("single_coil_heating", "passive_drape", "prototype_cantilever")
PLACES = [(name, place) for name, data in DATA.items() if name in FEW for place in places(data)]
scalars = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=12),
    st.builds("{} {}".format, st.floats(allow_nan=False, allow_infinity=False), st.sampled_from(UNITS)),
)
junk = st.recursive(scalars, lambda x: st.lists(x, max_size=3) | st.dictionaries(st.text(max_size=5), x, max_size=3))


def read(text):
    """The scenario, or the error that names what is wrong."""
    try:
        return parse_scenario(text, SOURCE)
    except InputError as error:
        return error


# Derandomised: the same examples every time.
@settings(max_examples=100, derandomize=True, deadline=None, suppress_health_check=list(HealthCheck))
@given(place=st.sampled_from(PLACES), value=junk)
def test_whatever_stands_in_a_scenario_it_is_read_or_refused_in_words(place, value):
    name, where = place
    text = yaml.safe_dump(replaced(DATA[name], where, value))
    answer = read(text)
    if isinstance(answer, InputError):
        assert (answer.source, bool(answer.problem), bool(answer.remedy)) == (str(SOURCE), True, True)
    else:
        assert read(answer.to_yaml()) == answer
        assert read(answer.to_yaml(is_complete=True)) == answer


@settings(max_examples=200, derandomize=True, deadline=None)
@given(text=st.text(max_size=200))
def test_text_that_is_anything_is_refused_in_words(text):
    with pytest.raises(InputError) as caught:
        parse_scenario(text, SOURCE)
    assert caught.value.remedy


@settings(max_examples=200, derandomize=True, deadline=None)
@given(number=st.floats(-1e12, 1e12, allow_nan=False).map(lambda x: float(f"{x:.12g}")), unit=st.sampled_from(UNITS))
def test_a_quantity_survives_being_written_and_read(number, unit):
    value = PhysicalValue(number, unit)
    assert PhysicalValue.parse(str(value)) == value


@settings(max_examples=200, derandomize=True, deadline=None)
@given(number=st.floats(allow_nan=False, allow_infinity=False), unit=st.sampled_from(UNITS))
def test_a_number_in_its_own_unit_keeps_its_last_bit(number, unit):
    assert PhysicalValue(number, unit).to(unit) == number
    assert PhysicalValue(0.1 + 0.2, "meter").to("m") == 0.1 + 0.2  # 0.30000000000000004, another spelling


@settings(max_examples=200, derandomize=True, deadline=None)
@given(
    number=st.floats(-1e6, 1e6).map(lambda x: float(f"{x:.6g}")),
    pair=st.sampled_from([("mm", "m"), ("degC", "K"), ("N/mm", "N/m"), ("ms", "s"), ("degF", "K"), ("g", "kg")]),
)
def test_a_connection_converts_as_a_quantity_does(number, pair):
    factor, offset = conversion(*pair)
    # Both round to 15 digits of a value up to 1e6 units; the offset of degF carries the digits of 255.37 K.
    assert factor * number + offset == pytest.approx(PhysicalValue(number, pair[0]).to(pair[1]), rel=1e-12, abs=1e-11)


VALIDATOR = jsonschema.Draft202012Validator(json_schema())
BROKEN = [
    ((), "colour", "blue"),
    (("time",), "stop", None),
    (("time",), "stop", 5),
    (("time",), "stop", "five seconds"),
    (("time",), "steps", "1 s"),
    (("components", "fabric"), "kind", "cloth"),
    (("components", "fabric"), "rows", 1),
    (("components", "fabric"), "rows", "8"),
    (("components", "fabric"), "colour", "blue"),
    (("components", "fabric", "tether"), "kind", "nailed"),
    ((), "connections", ["coil.stiffness = fabric.stiffness"]),
    ((), "connections", "coil.stiffness -> fabric.stiffness"),
    ((), "components", {"2fabric": DATA["passive_drape"]["components"]["fabric"]}),
    ((), "title", None),
    ((), "path", "elsewhere.yaml"),
]


def test_the_schema_is_itself_valid():
    jsonschema.Draft202012Validator.check_schema(json_schema())


@pytest.mark.parametrize(("place", "key", "value"), BROKEN)
def test_what_an_editor_underlines_the_program_refuses_too(place, key, value):
    data = copy.deepcopy(DATA["passive_drape"])
    assert VALIDATOR.is_valid(data)
    node = data
    for part in place:
        node = node[part]
    if value is None:
        node.pop(key)
    else:
        node[key] = value
    assert not VALIDATOR.is_valid(data)
    with pytest.raises(InputError):
        parse_scenario(yaml.safe_dump(data), SOURCE)


def test_the_schema_describes_every_key_of_every_kind_of_component():
    text = str(json_schema())
    for component in Scenario.model_fields["components"].annotation.__args__[1].__args__[0].__args__:
        for key in component.model_fields:
            assert f"'{key}'" in text, key
