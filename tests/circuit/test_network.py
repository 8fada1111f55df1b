"""The electrical unit against Ohm, Kirchhoff and a closed form."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from circuit.netlist import Network, render
from circuit.ngspice import ngspice
from circuit.unit import CircuitUnit
from cosim.unit.protocol import Unit, UnitError

from .closed_form import string_currents
from .solved_unit import solved


def test_prototype_draws_the_published_currents():
    unit = solved(Network((6,) * 6), 6.0, 2.2)
    # 6 V over six coils of 2.2 Ohm; 1e-12 is ngspice's rounding.
    np.testing.assert_allclose(unit.get("current"), 1 / 2.2, rtol=1e-12)
    np.testing.assert_allclose(unit.get("voltage"), 1.0, rtol=1e-12)
    assert unit.get("supply_current") == pytest.approx(6 / 2.2, rel=1e-12)
    assert unit.get("supply_power") == pytest.approx(36 / 2.2, rel=1e-12)
    assert isinstance(unit, Unit)


@st.composite
def networks(draw):
    strings = tuple(draw(st.lists(st.integers(1, 5), min_size=1, max_size=5)))
    coils = sum(strings)
    marked = draw(st.lists(st.integers(1, coils), max_size=3, unique=True))
    cut = draw(st.integers(0, len(marked)))
    network = Network(
        strings=strings,
        supply=draw(st.sampled_from(["common", "per_string"])),
        supply_resistance=draw(st.sampled_from([0.0, 0.05, 1.0])),
        string_resistance=draw(st.sampled_from([0.02, 0.5])),
        open_coils=tuple(marked[:cut]),
        shorted_coils=tuple(marked[cut:]),
    )
    voltage = draw(st.lists(st.floats(-12, 12), min_size=network.sources, max_size=network.sources))
    resistance = draw(st.lists(st.floats(0.1, 50), min_size=coils, max_size=coils))
    return network, np.array(voltage), np.array(resistance)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(networks())
def test_any_network_agrees_with_the_closed_form(case):
    network, voltage, resistance = case
    unit = solved(network, voltage if network.supply == "per_string" else voltage[0], resistance)
    # Rounding only: 13 digits of ngspice, and 1e-11 A where an open coil leaves picoamperes.
    expected = string_currents(network, voltage, resistance)
    np.testing.assert_allclose(unit.get("string_current"), expected, rtol=1e-10, atol=1e-11)
    losses = network.string_resistance * (unit.get("string_current") ** 2).sum()
    supply = unit.get("string_current") if network.supply == "per_string" else unit.get("supply_current")
    losses += network.supply_resistance * (supply**2).sum()
    assert unit.get("supply_power") == pytest.approx(unit.get("power").sum() + losses, rel=1e-9, abs=1e-9)
    unit.terminate()


def test_an_open_coil_stops_its_string_and_takes_its_whole_voltage():
    unit = solved(Network((3, 3), open_coils=(2,)), 6.0, 2.0)
    np.testing.assert_allclose(unit.get("string_current"), [0.0, 1.0], atol=1e-10)
    assert unit.get("voltage")[1] == pytest.approx(6.0, abs=1e-9)
    assert unit.get("power")[:3].max() < 1e-9


def test_two_open_coils_leave_no_undefined_node():
    unit = solved(Network((4,), open_coils=(2, 3)), 6.0, 2.0)
    assert np.isfinite(unit.get("voltage")).all()
    np.testing.assert_allclose(unit.get("voltage")[1:3], 3.0, rtol=1e-6)


def test_a_shorted_coil_drops_no_voltage_and_its_string_draws_more():
    unit = solved(Network((3, 3), shorted_coils=(5,)), 6.0, 2.0)
    np.testing.assert_allclose(unit.get("string_current"), [1.0, 1.5], rtol=1e-12)
    assert unit.get("voltage")[4] == 0.0
    assert unit.get("power")[4] == 0.0
    assert unit.get("current")[4] == pytest.approx(1.5, rel=1e-12)


def test_it_solves_again_only_when_an_input_has_changed():
    unit = solved(Network((2, 2)), 6.0, 2.2)
    for step in range(5):
        unit.set("resistance", np.full(4, 2.2))
        unit.do_step(step, 1)
    assert unit.solves == 1
    unit.set("resistance", np.array([2.2, 2.2, 2.2, 2.3]))
    unit.do_step(5, 1)
    unit.set("supply_voltage", np.array(3.0))
    unit.do_step(6, 1)
    assert unit.solves == 3
    np.testing.assert_allclose(unit.get("string_current"), [3 / 4.4, 3 / 4.5], rtol=1e-12)


def test_two_circuits_in_one_process_keep_apart():
    one, other = solved(Network((1,)), 1.0, 2.0), solved(Network((1, 1)), 1.0, 4.0)
    for factor in (1.0, 2.0, 3.0):
        one.set("supply_voltage", np.array(factor))
        other.set("supply_voltage", np.array(10 * factor))
        one.do_step(0, 1)
        other.do_step(0, 1)
        assert one.get("supply_current") == pytest.approx(factor / 2, rel=1e-12)
        assert other.get("supply_current") == pytest.approx(2 * 10 * factor / 4, rel=1e-12)


def test_thousands_of_solutions_leave_nothing_behind_in_ngspice():
    unit = solved(Network((2,)), 1.0, 1.0)
    for step in range(3000):
        unit.set("resistance", np.array([1.0, 1.0 + 1e-6 * step]))
        unit.do_step(step, 1)
    assert ngspice().plots() == ["const"]
    assert len(ngspice()._shared._stdout) < 10  # messages of the last command alone
    assert unit.get("supply_current") == pytest.approx(1 / (2 + 1e-6 * 2999), rel=1e-12)


def test_a_resumed_circuit_goes_on_like_the_other():
    first = solved(Network((3, 2), string_resistance=0.1), 6.0, 2.2)
    second = CircuitUnit("circuit", first.network)
    second.resume(first.checkpoint(), 0)
    for unit in (first, second):
        unit.set("resistance", np.linspace(2.0, 2.4, 5))
        unit.do_step(0, 1)
    for name in first.variables:
        assert np.array_equal(first.get(name), second.get(name)), name


def test_coils_are_labelled_by_string_and_place():
    unit = CircuitUnit("circuit", Network((2, 3)))
    assert unit.coordinates["string"].values.tolist() == [1, 2]
    assert unit.coordinates["string_of_coil"].values.tolist() == [1, 1, 2, 2, 2]
    assert unit.coordinates["position_in_string"].values.tolist() == [1, 2, 1, 2, 3]


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"strings": ()}, "without strings"),
        ({"strings": (2, 0)}, "string 2 has 0 coils"),
        ({"strings": (2, 1.5)}, "string 2 has 1.5 coils"),
        ({"supply_resistance": -1.0}, "supply_resistance"),
        ({"string_resistance": float("nan")}, "string_resistance"),
        ({"open_coils": (5,)}, "coil 5"),
        ({"shorted_coils": (0,)}, "coil 0"),
        ({"open_coils": (1,), "shorted_coils": (1,)}, "both"),
        ({"shorted_coils": (1, 2)}, "without a limit"),
        ({"supply": "each"}, "per_string"),
    ],
)
def test_a_network_that_makes_no_sense_is_refused(change, what):
    with pytest.raises(ValueError, match=what):
        Network(**{"strings": (2, 2), **change})


@pytest.mark.parametrize("value", [0.0, -2.2])
def test_a_resistance_that_is_not_positive_is_refused_by_name(value):
    unit = solved(Network((3,)), 6.0, 2.2)
    unit.set("resistance", np.array([2.2, value, 2.2]))
    with pytest.raises(UnitError, match=r"circuit at t = 2 s: resistance of coil 2 .*it must lie within"):
        unit.do_step(2_000_000_000, 1)


def test_an_input_that_is_no_number_is_refused():
    unit = CircuitUnit("circuit", Network((3,)))
    with pytest.raises(UnitError, match=r"resistance\[2\]"):
        unit.set("resistance", np.array([1.0, np.nan, 1.0]))


def test_the_netlist_holds_every_element_once():
    written = render(Network((2, 1), string_resistance=0.5, supply_resistance=0.1))
    names = [line.split()[0] for line in written.splitlines()[:-1]]
    assert sorted(names) == sorted(set(names))
    assert set(names) == {
        *("vsupply1", "rsupply1", "vstring1", "rstring1", "rcoil1", "rcoil2", "vstring2", "rstring2", "rcoil3")
    }
