"""Every kind of wrong value is refused in the project's words, and what was probably meant is named."""

import re
from pathlib import Path

import pytest
import yaml
from pydantic import BaseModel, ConfigDict, Field, StrictBool, StrictFloat, StrictInt, ValidationError

from cosim.assemble import assemble
from cosim.components import CircuitElement, Component, HoldLaw, OnOffLaw, PiLaw, PythonLaw
from cosim.faults import _WORDS, is_weak, known_keys, shown, tags_of_members, words
from cosim.nearest import did_you_mean, nearest
from cosim.scenario import Scenario, load_scenario, parse_scenario, shipped_scenarios
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue

#: How the library that checks types begins its own sentences.
FOREIGN = re.compile(
    r"Input should|Field required|Extra inputs|valid (string|integer|number|list|dict)|pydantic|Value error"
)
BASE = "hanging_coils"


def changed(path, value, base=BASE):
    data = yaml.safe_load(shipped_scenarios()[base].read_text())
    place = data
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return yaml.safe_dump(data)


WRONG = [
    (
        ("components", "supply", "outputs", "voltage", "points"),
        [["0 s", "0 V"], ["1.5 s", "4 V"], ["1.5 s", "0 V"]],
        "the times of `points` must rise, and 1.5 s comes after 1.5 s",
    ),
    (("title",), 5, "`5` is not text"),
    (("title",), None, "an empty value is not text"),
    (("title",), ["a"], "a list of 1 is not text"),
    (("time",), 5, "`5` is not a mapping of keys to values"),
    (("time",), [1], "a list of 1 is not a mapping"),
    (("time", "step"), "1 s", "there is no such key here; did you mean `stop`?"),
    (("time", "macrostep"), "1 s", "did you mean `macro_step`?"),
    (("tittle",), "x", "there is no such key here; did you mean `title`?"),
    (("algorithm",), {"kind": "gaus_seidel"}, "did you mean `gauss_seidel`?"),
    (("algorithm",), {"kind": "jacobi", "on_event": "stop"}, "it is one of: continue, synchronise"),
    (("algorithm",), {"kind": "jacobi", "on_event": "synchronize"}, "did you mean `synchronise`?"),
    (("algorithm",), {"kind": "iterated", "iterations": 2.5}, "`2.5` is not a whole number"),
    (("algorithm",), {"kind": "iterated", "iterations": "many"}, "`many` is not a whole number"),
    (("algorithm",), {"kind": "iterated", "iterations": True}, "`true` is not a whole number"),
    (("algorithm",), {"kind": "iterated", "iterations": 0}, "`0` must be at least 1"),
    (("algorithm",), {"kind": "iterated", "tolerance": 1}, "did you mean `relative_tolerance`?"),
    (("algorithm",), {"kind": "step_doubling", "absolute_tolerance": -1.0}, "`-1.0` must be greater than 0"),
    (("algorithm",), {"kind": "step_doubling", "absolute_tolerance": "small"}, "`small` is not a number"),
    (("algorithm",), "jacobi", "`jacobi` is not a mapping of keys to values"),
    (("algorithm",), {"order": []}, "the key `kind` is missing"),
    (("components",), {}, "it needs at least 1, and it has 0"),
    (("components",), [], "an empty list is not a mapping"),
    (("components", "1a"), {"kind": "programme", "outputs": {}}, "is not a name"),
    (("components", "circuit", "strings"), 5, "`5` is not a list"),
    (("components", "circuit", "strings"), [], "it needs at least 1, and it has 0"),
    (("components", "circuit", "string"), [6], "did you mean `strings`?"),
    (("components", "circuit", "kind"), "ngspise", "did you mean `ngspice`?"),
    (("components", "circuit", "supply"), "per_strings", "did you mean `per_string`?"),
    (("components", "circuit", "elements"), [{"kind": "contacts"}], "did you mean `contact`?"),
    (("components", "circuit", "elements"), [{"kind": "contact", "strin": 1}], "did you mean `string`?"),
    (("components", "actuator", "parameter"), {}, "did you mean `parameters`?"),
    (("components", "actuator", "record"), "x", "`x` is not a list"),
    (("components", "actuator", "isolation"), "proces", "did you mean `process`?"),
    (("connections",), "a.b -> c.d", "is not a list"),
    (("connections",), [5], "`5` is not text"),
    (
        ("connections",),
        [{"connect": "supply.voltage -> circuit.supply_voltage", "convert_units": "yes"}],
        "`yes` is not true or false",
    ),
]


@pytest.mark.parametrize(("path", "value", "what"), WRONG, ids=[f"{'.'.join(p)}={v!r}"[:60] for p, v, _ in WRONG])
def test_a_wrong_value_is_refused_in_our_words(path, value, what):
    with pytest.raises(InputError) as caught:
        parse_scenario(changed(path, value), Path("mine.yaml"))
    assert what in str(caught.value)
    assert FOREIGN.search(str(caught.value)) is None, caught.value
    assert str(path[0]) in str(caught.value)


class _Everything(BaseModel):
    model_config = ConfigDict(extra="forbid")
    text: str = ""
    short: str = Field(default="abc", min_length=2, max_length=3)
    flag: StrictBool = True
    count: StrictInt = Field(default=1, lt=10, le=9, multiple_of=1)
    loose: int = 1
    number: StrictFloat = Field(default=1.0, allow_inf_nan=False)
    few: list[int] = Field(default=[], max_length=1)
    pair: tuple[int, int] = (1, 2)
    unique: set[int] = set()
    nothing: None = None
    path: Path = Path()


@pytest.mark.parametrize(
    "data",
    [
        {"text": 1},
        {"short": "a"},
        {"short": "abcd"},
        {"flag": 1},
        {"flag": "true"},
        {"count": 10},
        {"loose": "x"},
        {"loose": 1.5},
        {"loose": "9" * 5000},
        {"number": float("inf")},
        {"number": "x"},
        {"few": [1, 2]},
        {"few": {}},
        {"pair": [1]},
        {"pair": 1},
        {"unique": 1},
        {"nothing": 1},
        {"path": 1},
        {"unknown": 1},
        {1: 2},
        [],
        "x",
        None,
    ],
    ids=str,
)
def test_each_kind_of_fault_has_words_of_its_own(data):
    with pytest.raises(ValidationError) as caught:
        _Everything.model_validate(data)
    for fault in caught.value.errors():
        assert FOREIGN.search(words(fault)) is None
        assert fault["msg"] not in words(fault)
        assert len(words(fault)) < 200


def test_a_kind_that_nobody_foresaw_is_still_said_in_our_words():
    fault = {"type": "never_seen", "loc": ("a",), "msg": "Input should be seen", "input": 3}
    assert words(fault) == "`3` is not possible here"
    assert not is_weak(fault)
    assert is_weak({"type": "int_type"})
    assert set(_WORDS) >= {"missing", "extra_forbidden"}


def test_values_are_shown_short_and_as_the_file_has_them():
    assert shown("x" * 100) == f"`{'x' * 40}...`"
    assert shown({"a": 1, "b": 2, "c": 3, "d": 4}) == "a mapping with the keys `a`, `b`, `c`, ..."
    assert shown({}) == "an empty mapping"
    assert shown(False) == "`false`"


def test_keys_are_known_at_every_place():
    assert "macro_step" in known_keys(Scenario, ("time",))
    assert "path" not in known_keys(Scenario, ())
    assert "resistance" in known_keys(Scenario, ("components", "c", "ngspice", "elements", 0, "contact"))
    assert known_keys(Scenario, ("components", "c", "bullet_fabric", "tether")) == ["kind", "rows"]
    assert "factor" in known_keys(Scenario, ("connections", 0, "ScaledConnection"))


@pytest.mark.parametrize(
    ("given", "known", "meant"),
    [
        ("hangin_coils", ["hanging_coils", "water_bath"], "hanging_coils"),
        ("Rows", ["rows", "columns"], "rows"),
        ("zzz", ["rows", "columns"], None),
        ("", ["rows"], None),
    ],
)
def test_the_nearest_name(given, known, meant):
    assert nearest(given, known) == meant
    assert ("did you mean" in did_you_mean(given, known)) == (meant is not None)


@pytest.mark.parametrize(
    ("path", "value", "what"),
    [
        (("connections", 0), "suply.voltage -> circuit.supply_voltage", "did you mean `supply`?"),
        (("connections", 0), "supply.voltag -> circuit.supply_voltage", "did you mean `voltage`?"),
        (("components", "actuator", "fmu"), "thermal_stifness", "did you mean `thermal_stiffness`?"),
        (("components", "actuator", "parameter_set"), "niti_papers", "did you mean `niti_paper`?"),
        (("components", "circuit", "start"), {"resistanc": "1 ohm"}, "did you mean `resistance`?"),
    ],
)
def test_names_of_components_variables_and_files_are_guessed(path, value, what):
    with pytest.raises(InputError) as caught:
        assemble(parse_scenario(changed(path, value), Path("mine.yaml")))
    assert what in str(caught.value)


def test_the_name_of_a_scenario_is_guessed():
    with pytest.raises(InputError, match="did you mean `hanging_coils`"):
        load_scenario("hangin_coils")


@pytest.mark.parametrize(
    ("text", "unit", "words"),
    [
        ("23 C", "K", "`23 C` is no quantity in K; write `23 degC`"),
        ("70 F", "K", "`70 F` is no quantity in K; write `70 degF`"),
        ("2 C", "s", "`2 C` is no quantity in s"),
        ("6 Volt", "V", "`Volt` is not a unit that is known here; did you mean `volt`?"),
        ("6 Frobs", "V", "`Frobs` is not a unit that is known here"),
    ],
)
def test_a_slip_in_a_unit_is_told_with_what_to_write(text, unit, words):
    with pytest.raises(ValueError, match=r"^" + re.escape(words) + "$"):
        PhysicalValue.parse(text).to(unit)


def _tagged(annotation):
    """Every member of a union that `kind` tells apart, below an annotation, with the keys that lead to it."""
    for member in getattr(annotation, "__args__", (annotation,)):
        if isinstance(member, type) and issubclass(member, BaseModel):
            yield member


COMPONENTS = list(_tagged(Component.__origin__))
ELEMENTS = list(_tagged(CircuitElement.__origin__))
LAWS = [OnOffLaw, PiLaw, HoldLaw, PythonLaw]


def _kind(model):
    return model.model_fields["kind"].annotation.__args__[0]


@pytest.mark.parametrize("model", COMPONENTS, ids=_kind)
def test_a_wrong_key_of_every_component_is_named_as_the_file_has_it(model):
    given = {"kind": _kind(model), "colour": "red"}
    with pytest.raises(InputError) as error:
        parse_scenario(changed(("components", "own"), given), Path("scenario.yaml"))
    assert "components.own.colour" in str(error.value)
    assert f"own.{_kind(model)}." not in str(error.value)


@pytest.mark.parametrize("model", ELEMENTS, ids=_kind)
def test_a_wrong_key_of_every_element_is_named_as_the_file_has_it(model):
    given = [{"kind": _kind(model), "colour": "red"}]
    with pytest.raises(InputError) as error:
        parse_scenario(changed(("components", "circuit", "elements"), given), Path("scenario.yaml"))
    assert "components.circuit.elements[1].colour" in str(error.value)


@pytest.mark.parametrize("model", LAWS, ids=_kind)
def test_a_wrong_key_of_every_law_is_named_as_the_file_has_it(model):
    given = {"kind": "controller", "law": {"kind": _kind(model), "colour": "red"}}
    with pytest.raises(InputError) as error:
        parse_scenario(changed(("components", "own"), given), Path("scenario.yaml"))
    assert "components.own.law.colour" in str(error.value)


def test_a_key_or_a_component_that_is_called_like_a_kind_stays_in_its_place():
    assert tags_of_members(Scenario, ("components", "fmu", "fmu", "fmu")) == [False, False, True, False]
    place = ("components", "programme", "programme", "outputs")
    assert tags_of_members(Scenario, place) == [False, False, True, False]
    with pytest.raises(InputError) as error:
        parse_scenario(changed(("components", "lead"), {"kind": "fmu", "fmu": 5}), Path("scenario.yaml"))
    assert error.value.key == "components.lead.fmu"


def test_what_was_meant_is_said_of_a_kind_that_has_a_key_of_its_name():
    with pytest.raises(InputError) as error:
        parse_scenario(
            changed(("components", "own"), {"kind": "fmu", "fmu": "a.fmu", "integratr": "cvode"}), Path("s.yaml")
        )
    assert "did you mean `integrator`?" in str(error.value)
