"""All types of FMI 2.0 and 3.0, arrays of several ranks, parameters and start values."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS, Causality, UnitError, VariableType
from cosim.unit.quantity import PhysicalValue, conversion

both_interfaces = pytest.mark.parametrize("interface", ["cs", "me"])
#: The extreme values of every type: a conversion through another type would lose them.
EXTREMES = {
    "float64": (-1.7976931348623157e308, 5e-324),
    "float32": (np.float32(3.4028235e38), np.float32(1e-45)),
    "int8": (-128, 127),
    "uint8": (0, 255),
    "int16": (-(2**15), 2**15 - 1),
    "uint16": (0, 2**16 - 1),
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "int64": (-(2**63), 2**63 - 1),
    "uint64": (0, 2**64 - 1),
    "boolean": (True, False),
    "enumeration": (7, 1),
    "string": ("", "Größe μ"),
    "binary": (b"", b"\x00\xff\x00"),
}
FMI2 = ("float64", "int32", "boolean", "enumeration", "string")


@both_interfaces
@pytest.mark.parametrize(("version", "name"), [(3, n) for n in EXTREMES] + [(2, n) for n in FMI2])
def test_extreme_values_of_every_type_come_back(started, version, interface, name):
    unit = started("echo", version, interface)
    vtype = unit.variables[f"{name}_out"].type
    for index, value in enumerate(EXTREMES[name]):
        unit.set(f"{name}_in", np.array(value, dtype=vtype.dtype))
        unit.refresh()
        assert unit.get(f"{name}_out")[()] == value
        unit.do_step(index * NANOSECONDS, NANOSECONDS)
        assert unit.get(f"{name}_out")[()] == value
        assert unit.get(f"{name}_out").dtype == vtype.dtype


@both_interfaces
def test_arrays_take_their_sizes_from_constants_and_structural_parameters(started, interface):
    unit = started("echo", 3, interface, structure={"rows": 3, "columns": 4})
    shapes = {"matrix": (3, 4), "cube": (3, 4, 2), "wholes": (3,), "texts": (3,)}
    assert {n: unit.variables[f"{n}_out"].shape for n in shapes} == shapes
    assert unit.variables["cube_in"].dims == ("row", "column", "cube_in_2")
    for name, shape in shapes.items():
        values = np.arange(np.prod(shape)).reshape(shape)
        given = values.astype(str).astype(object) if name == "texts" else values
        unit.set(f"{name}_in", given)
        unit.refresh()
        np.testing.assert_array_equal(unit.get(f"{name}_out"), given)


def test_a_structural_parameter_out_of_range_or_unknown_is_refused(load):
    with pytest.raises(InputError, match="rows = 4 is outside 0 to 3"):
        load("echo", 3, structure={"rows": 4})
    with pytest.raises(InputError, match=r"no structural parameter lines; there are: rows, columns"):
        load("echo", 3, structure={"lines": 1})
    with pytest.raises(InputError, match="it is the size of an array"):
        load("echo", 3, parameters={"rows": 2})


@both_interfaces
def test_fmi_2_scalars_are_gathered_to_arrays(started, interface):
    unit = started("echo", 2, interface)
    assert unit.variables["a"].shape == (2, 2)
    assert unit.variables["z"].first_index == 0
    assert unit.variables["a"].first_index == 1
    np.testing.assert_array_equal(unit.get("w"), [0.0, 1.0])  # their start values
    unit.set("a", np.array([[1.0, 2.0], [3.0, 4.0]]))
    unit.refresh()
    np.testing.assert_array_equal(unit.get("b"), [[1.0, 2.0], [3.0, 4.0]])


def test_scalars_with_a_gap_or_mixed_units_stay_scalars(load):
    variables = load("echo", 2).variables
    assert {n for n in variables if n.startswith(("gap", "mixed"))} == {"gap[1]", "gap[3]", "mixed[1]", "mixed[2]"}
    assert all(variables[n].shape == () for n in ("gap[1]", "mixed[2]"))


def test_declared_units_become_units_that_convert(load):
    variables = load("echo", 3, record=["half"]).variables
    assert conversion(variables["float64_in"].unit, "J") == (1.0, 0.0)  # N.m
    assert conversion(variables["half"].unit, "K") == (0.5, 100.0)  # bleem by its definition
    assert variables["float32_in"].unit == "opaque"
    with pytest.raises(ValueError, match="not a unit that is known"):
        conversion("opaque", "m")
    assert conversion("opaque", "opaque") == (1.0, 0.0)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (PhysicalValue.parse("300 K"), 400.0),  # (300 - 100) / 0.5
        ("30 hyperbleem", 280.0),  # (30 - 2) / 0.1
        ("30 bleem", 30.0),
        (30, 30.0),
        ([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]),
    ],
)
def test_a_start_value_of_a_local_variable_is_converted(started, given, expected):
    unit = started("echo", 3, start={"half": given}, record=["half"])
    assert unit.variables["half"].causality is Causality.LOCAL
    np.testing.assert_allclose(unit.get("half"), np.broadcast_to(expected, 3), rtol=1e-14)  # one rounding


def test_start_values_of_inputs_of_every_type(started):
    start = {
        "enumeration_in": "deep blue",
        "binary_in": "00ff",
        "string_in": PhysicalValue.parse("6 V"),
        "uint64_in": PhysicalValue.parse(str(2**64 - 1)),
        "boolean_in": True,
        "texts_in": ["x", "y"],
        "matrix_in": [[1, 2, 3], [4, 5, 6]],
    }
    unit = started("echo", 3, start=start)
    assert unit.get("enumeration_out") == 7
    assert unit.get("binary_out")[()] == b"\x00\xff"
    assert unit.get("string_out")[()] == "6 V"
    assert unit.get("uint64_out") == 2**64 - 1
    assert unit.get("boolean_out")
    assert unit.get("texts_out").tolist() == ["x", "y"]
    assert unit.get("matrix_out").tolist() == [[1, 2, 3], [4, 5, 6]]


def test_what_nobody_sets_keeps_the_start_value_of_the_fmu(started):
    unit = started("echo", 3)
    assert unit.variables["wholes_in"].start.tolist() == [1, 2, 3]
    assert unit.variables["texts_in"].start.tolist() == ["a", "b"]
    assert unit.get("string_out")[()] == "hello"


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"parameters": {"scael": 2.0}}, r"echo\.parameters\.scael.*no such parameter[\s\S]*did you mean scale\?"),
        ({"parameters": {"float64_in": 2.0}}, "this is no parameter that can be set here: its causality is input"),
        ({"start": {"float64_out": 2.0}}, "its initial calculated"),
        ({"start": {"int8_in": 128}}, "128 is outside -128 to 127"),
        ({"start": {"int8_in": 1.5}}, "1.5 is no whole number"),
        ({"start": {"boolean_in": 1}}, "1 is no Boolean"),
        ({"start": {"enumeration_in": "green"}}, r"`green` is no item; there are: red \(1\), deep blue \(7\)"),
        ({"start": {"enumeration_in": 2}}, "2 is no item"),
        ({"start": {"binary_in": "xyz"}}, "no binary data"),
        ({"start": {"string_in": PhysicalValue.parse(5)}}, "is no text; put it in quotes"),
        ({"start": {"float64_in": PhysicalValue.parse("1 m")}}, "no quantity in"),
        ({"start": {"matrix_in": [1.0, 2.0]}}, "2 values do not fit; it takes 2 x 3"),
        ({"start": {"matrix_in": [[1.0], [2.0, 3.0]]}}, "its rows have different lengths"),
        ({"record": ["hafl"]}, r"record\.hafl[\s\S]*did you mean half"),
    ],
)
def test_a_value_that_does_not_fit_is_an_error_with_its_key(load, settings, message):
    with pytest.raises(InputError, match=message):
        load("echo", 3, **settings)


def test_feedthrough_is_known_per_array(load):
    unit = load("echo", 3)
    assert unit.feedthrough["cube_out"] == {"cube_in"}
    assert unit.initial_feedthrough["string_out"] == {"string_in"}
    undeclared = load("echo", 2)  # no dependencies: every output depends on every input
    assert undeclared.feedthrough["b"] == {n for n, v in undeclared.variables.items() if v.causality is Causality.INPUT}
    trouble = load("trouble", 2)
    assert trouble.feedthrough == {"integral": frozenset(), "sum": {"u"}}


def test_start_values_are_exchanged_in_initialization_mode(load):
    unit = load("trouble", 3)
    unit.initialise(0)
    for value in (2.0, 3.0):
        unit.set("u", np.array(value))
        unit.refresh()
        assert unit.get("sum") == 10.0 * value
    unit.exit_initialisation()
    assert unit.get("sum") == 30.0


def test_a_number_that_is_not_finite_is_named(started):
    unit = started("echo", 3)
    with pytest.raises(UnitError, match=r"input cube_in\[2, 1, 2\] is not a finite number"):
        unit.set("cube_in", np.where(np.arange(12).reshape(2, 3, 2) == 7, np.nan, 0.0))
    broken = started("trouble", 2, "cs", parameters={"breaks": 1.0})
    with pytest.raises(UnitError, match="output integral is not a finite number"):
        broken.do_step(0, NANOSECONDS)


def test_each_access_says_what_it_does(load):
    unit = load("echo", 3)
    write = unit.writers["cube_in"]
    assert (write.function, list(write.references), write.is_direct) == ("fmi3SetFloat64", [44], True)
    assert write.buffer is unit.get("cube_in")
    read = next(r for r in unit.readers if r.variable.variable.name == "texts_out")
    assert (read.function, read.is_direct, read.variable.variable.type) == ("fmi3GetString", False, VariableType.STRING)


@pytest.mark.parametrize("version", [2, 3])
def test_an_fmu_whose_inputs_cannot_be_read_runs_from_its_declared_start_values(started, version):
    unit = started("trouble", version)
    with pytest.raises(UnitError, match="refuses this variable"):
        unit.buffers.input_readers["u"]()
    assert unit.get("u") == 1.0
    unit.do_step(0, NANOSECONDS)
    assert unit.get("integral") == 1.0
