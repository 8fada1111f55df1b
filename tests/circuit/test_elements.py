"""Elements in series with strings and sources, against closed forms of Ohm's and Kirchhoff's laws."""

from __future__ import annotations

import math

import numpy as np
import pytest

from circuit.elements import FADING, Contact, CurrentLimit, Drop, Lead, SlowSource, SourceResistance
from circuit.netlist import Network
from circuit.unit import CircuitUnit
from cosim.unit.protocol import Array

MS = 1_000_000
#: ngspice solves linear networks to the last digits; four orders above rounding.
SOLVED = 1e-12


def _current(network: Network, voltage: float, begin: int = 0, size: int = 10 * MS) -> Array:
    unit = CircuitUnit("circuit", network)
    unit.set("supply_voltage", np.full(unit.variables["supply_voltage"].shape, voltage))
    unit.set("resistance", np.full(network.coils, 2.0))
    unit.initialise(0)
    unit.do_step(begin, size)
    found = unit.get("string_current").copy()
    unit.terminate()
    return found


def test_a_contact_lies_in_series_with_its_string_alone() -> None:
    network = Network((2, 2), elements=(Contact(2, 1.5), Contact(2, 0.5)))
    np.testing.assert_allclose(_current(network, 6.0), [1.5, 1.0], rtol=SOLVED)


@pytest.mark.parametrize(("begin", "ohm"), [(0, 0.0), (90, 0.0), (95, 0.5), (100, 1.0)])
def test_a_contact_comes_at_its_instant_with_the_share_of_the_step_after_it(begin: int, ohm: float) -> None:
    network = Network((2,), elements=(Contact(1, 1.0, instant=0.1),))
    np.testing.assert_allclose(_current(network, 6.0, begin * MS), [6.0 / (4.0 + ohm)], rtol=SOLVED)


@pytest.mark.parametrize("rise", [0.5, 50.0])
def test_a_lead_agrees_with_its_current(rise: float) -> None:
    current = float(_current(Network((2,), elements=(Lead(1, rise),)), 6.0)[0])
    # Settled to 1e-13 of the resistance; the residual of V = I (4 + rise I^2) follows it.
    assert current * (4.0 + rise * current**2) == pytest.approx(6.0, rel=1e-12)


@pytest.mark.parametrize(("drop", "voltage"), [(0.2, 6.0), (3.0, 6.0), (0.2, 0.1), (0.2, -6.0)])
def test_a_drop_takes_its_voltage_whatever_the_current_and_fades_below_its_threshold(
    drop: float, voltage: float
) -> None:
    current = float(_current(Network((2,), elements=(Drop(1, drop),)), voltage)[0])
    # Settled to 1e-13 of the resistance, which one step of a drop larger than its voltage carries on some tenfold.
    assert current * (4.0 + drop / (abs(current) + FADING)) == pytest.approx(voltage, rel=1e-11)


def test_an_inner_resistance_of_the_supply_couples_the_strings() -> None:
    network = Network((2, 2), supply_resistance=0.5, elements=(SourceResistance(1, 0.5),))
    np.testing.assert_allclose(_current(network, 6.0), [1.0, 1.0], rtol=SOLVED)  # 6 V over 1 ohm + 4 ohm / 2


@pytest.mark.parametrize(
    ("limit", "share", "total"), [(2.0, 1.0, 2.0), (2.0, 0.5, 2.5), (5.0, 1.0, 3.0), (2.0, 0.0, 3.0)]
)
def test_a_source_keeps_its_limit(limit: float, share: float, total: float) -> None:
    network = Network((2, 2), elements=(CurrentLimit(1, limit, share),))
    assert _current(network, 6.0).sum() == pytest.approx(total, rel=SOLVED)
    assert _current(network, -6.0).sum() == pytest.approx(-total, rel=SOLVED)


def test_a_limited_source_warms_its_leads_with_the_limited_current() -> None:
    network = Network((2,), elements=(CurrentLimit(1, 1.0), Lead(1, 0.5)))
    unit = CircuitUnit("circuit", network)
    unit.set("supply_voltage", np.array(6.0))
    unit.set("resistance", np.full(2, 2.0))
    unit.initialise(0)
    assert float(unit.get("supply_current")) == pytest.approx(1.0, rel=SOLVED)
    assert float(unit.get("supply_power")) == pytest.approx(4.0 + 0.5, rel=1e-12)  # coils and lead at 1 A
    unit.terminate()


def test_supplies_of_their_own_have_elements_of_their_own() -> None:
    network = Network((2, 2), supply="per_string", elements=(SourceResistance(2, 2.0), CurrentLimit(1, 0.75)))
    np.testing.assert_allclose(_current(network, 6.0), [0.75, 1.0], rtol=SOLVED)


@pytest.mark.parametrize(
    ("element", "said"),
    [
        (Contact(3, 1.0), "no string 3"),
        (Lead(1, -1.0), "0 or positive"),
        (Drop(3, 1.0), "no string 3"),
        (SourceResistance(2, 1.0), "no supply 2"),
        (CurrentLimit(1, 0.0), "above 0 A"),
        (Contact(1, math.nan), "0 or positive"),
    ],
)
def test_an_element_without_place_or_sense_is_refused(
    element: Contact | Lead | Drop | SourceResistance | CurrentLimit, said: str
) -> None:
    with pytest.raises(ValueError, match=said):
        Network((2, 2), elements=(element,))


def test_a_slow_source_comes_up_and_dies_away_with_its_exponential_and_goes_on_from_a_checkpoint() -> None:
    network = Network((2,), elements=(SlowSource(1, 0.5),))
    unit = CircuitUnit("circuit", network)
    unit.set("supply_voltage", np.array(6.0))
    unit.set("resistance", np.full(2, 2.0))
    unit.initialise(0)
    assert float(unit.get("string_current")[0]) == 0.0  # 0 V at the start
    state = {}
    for n in range(40):
        unit.do_step(50 * n * MS, 50 * MS)
        begin, end = 0.05 * n, 0.05 * (n + 1)
        mean = 6.0 - 6.0 * 0.5 * (math.exp(-begin / 0.5) - math.exp(-end / 0.5)) / 0.05
        # The mean of the exponential, as a sum over steps: rounding of 40 of them.
        assert float(unit.get("string_current")[0]) == pytest.approx(mean / 4.0, rel=1e-11)
        state = state or ({k: v.copy() for k, v in unit.checkpoint().items()} if n == 9 else {})
    other = CircuitUnit("other", network)
    other.resume(state, 500 * MS)
    other.do_step(500 * MS, 50 * MS)
    mean = 6.0 - 6.0 * 0.5 * (math.exp(-1.0) - math.exp(-1.1)) / 0.05
    assert float(other.get("string_current")[0]) == pytest.approx(mean / 4.0, rel=1e-11)
    unit.terminate()
    other.terminate()


def test_a_supply_with_two_delays_is_refused() -> None:
    with pytest.raises(ValueError, match="more than one slow_source"):
        Network((2,), elements=(SlowSource(1, 0.5), SlowSource(1, 0.1)))
