"""Connections of elements, scaled and between types."""

import numpy as np
import pytest

from cosim.connection import Connection, ConnectionFault
from cosim.system import System
from cosim.unit.protocol import Causality, Variable, VariableType

from .scripted import Map, Relaxation


def fed(*connections, start=None, shape=(3,)):
    units = {
        "a": Map("a", lambda u: u + np.array([10.0, 20.0, 30.0]), shape=(3,)),
        "x": Relaxation("x", 1.0, 7.0, 0.0),
        "b": Relaxation("b", 1.0, 0.0, start, shape=shape),
    }
    system = System(units, list(connections))
    system.initialise(0, {})
    return units["b"].get("input")


def test_one_element_is_read_and_one_is_written():
    got = fed(
        Connection(("a", "output"), ("b", "input"), source_element=(2,), target_element=(0,)),
        Connection(("a", "output"), ("b", "input"), source_element=(0,), target_element=(2,)),
        Connection(("x", "state"), ("b", "input"), target_element=(1,)),
    )
    assert got.tolist() == [30.0, 7.0, 10.0]


def test_one_element_fills_a_whole_input():
    assert fed(Connection(("a", "output"), ("b", "input"), source_element=(1,))).tolist() == [20.0] * 3


def test_elements_that_nothing_leads_into_keep_their_start_value():
    got = fed(Connection(("x", "state"), ("b", "input"), 2.0, 1.0, target_element=(1,)), start=-1.0)
    assert got.tolist() == [-1.0, 15.0, -1.0]


@pytest.mark.parametrize(
    ("connections", "what"),
    [
        ([{"source_element": (3,)}], r"a\.output\[4\] -> b\.input: output has shape \(3,\); there is no such element"),
        ([{"target_element": (0, 0)}], r"b\.input\[1,1\]: input has shape \(3,\); there is no such element"),
        ([{"target_element": (0,)}], r"shape \(3,\) does not fit shape \(\)"),
        ([{"source_element": (0,), "target_element": (0,)}] * 2, r"already leads into b\.input"),
        ([{}, {"source_element": (0,), "target_element": (0,)}], r"already leads into b\.input"),
        ([{"source_element": (0,), "target_element": (1,)}], r"b\.input\[1\]: nothing is connected to this element"),
    ],
)
def test_an_element_that_does_not_fit_is_refused(connections, what):
    with pytest.raises(ConnectionFault, match=what):
        fed(*(Connection(("a", "output"), ("b", "input"), **c) for c in connections))


def typed(source, target, factor=1.0):
    units = {n: Map(n, lambda u: u) for n in "ab"}
    units["a"].variables["output"] = Variable("output", Causality.OUTPUT, (), "1", type=source)
    units["b"].variables["input"] = Variable("input", Causality.INPUT, (), "1", start=0, type=target)
    return System(units, [Connection(("a", "output"), ("b", "input"), factor)])


@pytest.mark.parametrize(
    ("source", "target"),
    [("Int32", "Float64"), ("UInt8", "Int16"), ("Float32", "Float64"), ("Boolean", "Boolean"), ("String", "String")],
)
def test_types_that_lose_nothing_connect(source, target):
    typed(VariableType(source), VariableType(target))


@pytest.mark.parametrize(
    ("source", "target"),
    [
        ("Float64", "Int32"),
        ("Int64", "Float32"),
        ("Float64", "Boolean"),
        ("Boolean", "String"),
        ("Enumeration", "Int64"),
        ("String", "Binary"),
    ],
)
def test_types_that_would_lose_something_are_refused(source, target):
    with pytest.raises(ConnectionFault, match=f"{source} does not fit {target} without loss"):
        typed(VariableType(source), VariableType(target))


def test_a_switch_cannot_be_scaled():
    with pytest.raises(ConnectionFault, match="a value of type Boolean cannot be scaled"):
        typed(VariableType.BOOLEAN, VariableType.BOOLEAN, 2.0)


def test_every_type_has_an_element_type_of_numpy():
    sizes = {t.value: t.dtype.itemsize for t in VariableType if t.dtype != np.dtype(object)}
    widths = {
        1: ("Int8", "UInt8", "Boolean", "Clock"),
        2: ("Int16", "UInt16"),
        4: ("Int32", "UInt32", "Float32"),
        8: ("Int64", "UInt64", "Float64", "Enumeration"),
    }
    assert sizes == {name: width for width, names in widths.items() for name in names}
