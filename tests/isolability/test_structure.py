"""What channels tell apart by the structure of the equations: the findings of the field notes."""

import os
import subprocess
import sys

import pytest

from diagnosis.isolability.isolability import extra_channels
from diagnosis.isolability.structure import Rig, analyse

STRINGS = {"string[1]": ["coil[1,1]", "coil[1,2]"], "string[2]": ["coil[2,1]", "coil[2,2]"]}
COILS = [c for coils in STRINGS.values() for c in coils]


def rig(*quantities):
    channels = set()
    for quantity in quantities:
        elements = ["supply"] if quantity == "supply_current" else STRINGS if quantity == "current" else COILS
        channels |= {(quantity, e) for e in elements}
    return Rig(STRINGS, True, True, frozenset(channels))


def apart(analysis, one, other):
    a, b = analysis.faults.index(one), analysis.faults.index(other)
    return bool(analysis.is_isolable[a, b] and analysis.is_isolable[b, a])


HEAT, PHASE = "heat balance of coil[1,1]", "stiffness of coil[1,1]"
STRING, LENGTH = "resistance in series with string[1]", "force or extension of coil[1,1]"


def test_current_temperature_and_position_tell_the_units_apart():
    found = analyse(rig("current", "temperature", "extension"))
    assert found.is_detectable.all()
    assert apart(found, HEAT, PHASE)
    assert apart(found, HEAT, STRING)
    assert apart(found, PHASE, STRING)
    assert not apart(found, PHASE, LENGTH)  # the extension shows both in one equation


def test_without_temperature_heat_and_phase_cannot_be_told_apart():
    found = analyse(rig("current", "extension"))
    assert not apart(found, HEAT, PHASE)
    assert apart(found, HEAT, STRING)


def test_without_position_no_channel_shows_the_phase():
    found = analyse(rig("current", "temperature"))
    assert PHASE in found.undetectable()
    assert LENGTH in found.undetectable()
    assert not apart(found, HEAT, "sensor of coil[1,1].temperature")


def test_one_coil_without_current_cannot_tell_electrical_from_thermal():
    one = Rig({"string[1]": ["coil[1,1]"]}, True, True, frozenset({("temperature", "coil[1,1]")}))
    found = analyse(one)
    assert not apart(found, HEAT, STRING)
    with_current = analyse(Rig(one.strings, True, True, one.channels | {("current", "string[1]")}))
    assert apart(with_current, HEAT, STRING)


@pytest.mark.parametrize(
    ("quantities", "best"),
    [
        (("current", "extension"), "temperature of every coil"),
        (("current", "temperature", "extension"), "stiffness of every coil"),
    ],
)
def test_the_channel_that_would_help_most(quantities, best):
    own = rig(*quantities)
    found = extra_channels(own, analyse(own))
    assert best in [f.channel for f in found[:2]]
    assert found[0].classes >= found[-1].classes > 0


def test_classes_have_the_same_order_in_every_process():
    code = (
        "from tests.isolability.test_structure import analyse, rig; "
        "print(analyse(rig('supply_current', 'current', 'temperature', 'extension')).classes())"
    )
    told = {
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("1", "2", "3")
    }
    assert len(told) == 1
    assert "sensor of supply.current" in told.pop()


def with_channels(own, quantity, elements):
    return Rig(own.strings, True, True, own.channels | {(quantity, e) for e in elements}, own.feels_heat, own.has_load)


def test_a_voltage_of_every_coil_tells_a_coil_from_its_string_and_from_its_neighbour():
    """By Ohm's law of each coil; the current alone knows the sum of what lies in the string."""
    own = rig("current")
    one, other = "resistance of coil[1,1]", "resistance of coil[1,2]"
    found = analyse(own)
    assert not apart(found, one, other)
    assert not apart(found, one, STRING)
    found = analyse(with_channels(own, "voltage", COILS))
    assert apart(found, one, other)
    assert apart(found, one, STRING)


def test_a_voltage_across_the_coils_of_a_string_tells_them_from_their_wires():
    own = rig("current")
    found = analyse(with_channels(own, "string_voltage", STRINGS))
    assert apart(found, "resistance of coil[1,1]", STRING)
    assert not apart(found, "resistance of coil[1,1]", "resistance of coil[1,2]")


def test_the_power_of_a_supply_tells_its_voltage_from_the_sensor_of_its_current():
    """Power over current is the voltage."""
    own = rig("supply_current")
    supply, sensor = "voltage of the supply", "sensor of supply.current"
    assert not apart(analyse(own), supply, sensor)
    found = analyse(with_channels(own, "supply_power", ["supply"]))
    assert "sensor of supply.power" in found.faults
    assert apart(found, STRING, sensor)


def test_voltages_are_among_the_channels_that_may_be_recorded_in_addition():
    own = rig("current")
    offered = {c.channel for c in extra_channels(own, analyse(own))}
    assert {"voltage of every coil", "voltage of every string"} <= offered
