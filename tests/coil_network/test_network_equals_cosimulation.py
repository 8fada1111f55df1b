"""The network against the co-simulation of the shipped units, at the same step."""

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.errors import InputError
from diagnosis.models.coil_network.kernel.inputs import Drive, Programme, grid
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.series import recorded_series

#: Both make the same exact steps; the network's exp is right to 1e-15 and rounding adds up over some thousand steps.
TOLERANCE = 1e-9

NAMES = {
    "temperature": "actuator.temperature",
    "stiffness": "actuator.stiffness",
    "resistance": "actuator.resistance",
    "power": "circuit.power",
    "current": "circuit.string_current",
    "supply_current": "circuit.supply_current",
}
#: Derived quantities of the network to their variables, or to the channels that are made of several.
DERIVED = {"voltage": "circuit.voltage", "tension": "load.tension"}
MADE = {"string_voltage": [f"string[{n}].voltage" for n in range(1, 7)], "supply_power": ["supply.power"]}

NETWORK = """
title: network under load
time: {{stop: 40 s, macro_step: 20 ms, output_step: 100 ms, checkpoint_step: 20 s}}
algorithm: {{kind: gauss_seidel, order: [supply, room, circuit, actuator, load]}}
components:
  supply: {{kind: programme, outputs: {{voltage: {voltage}}}}}
  room:
    kind: programme
    outputs: {{temperature: {{unit: K, points: [[0 s, 295 K], [40 s, 299 K]], interpolation: linear}}}}
  circuit:
    kind: ngspice
    strings: [6, 6, 6, 6, 6, 6]
    supply: {supply}
    supply_resistance: 0.4 ohm
    string_resistance: 0.2 ohm
    start: {{resistance: 2.2 ohm}}
  actuator:
    kind: actuator
    fmu: thermal_stiffness
    electrical: circuit
    ambient: room
    mechanical: load
    parameters: {{resistance_temperature_coefficient: 0.002 1/K, use_regressed_cooling_rate: {regressed}}}
  load: {{kind: hanging_mass, coils: 36, mass: 100 g}}
connections:
  - supply.voltage -> circuit.supply_voltage
"""
COMMON = "{unit: V, points: [[0 s, 0 V], [1 s, 9 V], [15 s, 0 V], [17 s, 5 V], [24 s, 2 V]]}"
PER_STRING = (
    "{unit: V, dim: string, points: [[0 s, [0 V, 0 V, 0 V, 0 V, 0 V, 0 V]], [1 s, [3 V, 4 V, 5 V, 6 V, 7 V, 8 V]], "
    "[15 s, [1 V, 0 V, 1 V, 0 V, 1 V, 0 V]]]}"
)


@pytest.fixture(scope="module", autouse=True)
def _fmus(shipped_fmus):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COSIM_FMU_PATH", str(shipped_fmus))
        yield


def assert_equal(result, dataset, names):
    for quantity, variable in names.items():
        wanted = dataset[variable].values.reshape(len(dataset.time), -1)
        scale = np.abs(wanted).max()
        np.testing.assert_allclose(result[quantity], wanted, rtol=TOLERANCE, atol=TOLERANCE * scale, err_msg=quantity)


def simulate(layout, drive, step, stop, times, parameters):
    inputs = drive.on_grid(grid(0.0, stop, step))
    return CoilNetwork(layout, is_midpoint=False).simulate(CoilNetworkParameters(parameters), inputs, times)


def test_single_coils_follow_the_shipped_scenario():
    dataset = run(load_scenario("single_coil_heating"))
    voltage = Programme(np.array([0.0, 40.0]), np.array([[0.5, 0.7, 0.8, 0.9, 1.0, 1.2], [0.0] * 6]))
    result = simulate(
        CoilNetworkLayout(6, (1,) * 6, "per_string"),
        Drive(Programme.constant(295.15), voltage),
        0.1,
        80.0,
        dataset.time.values,
        {},
    )
    assert dataset["actuator.temperature"].values.max() > 350.0
    assert_equal(result, dataset, NAMES)


@pytest.mark.parametrize("supply", ["common", "per_string"])
@pytest.mark.parametrize("regressed", ["true", "false"])
def test_loaded_networks_follow_the_co_simulation(tmp_path, supply, regressed):
    text = NETWORK.format(voltage=COMMON if supply == "common" else PER_STRING, supply=supply, regressed=regressed)
    dataset = run(parse_scenario(text, tmp_path / "network.yaml"))
    if supply == "common":
        voltage = Programme(np.array([0.0, 1.0, 15.0, 17.0, 24.0]), np.array([0.0, 9.0, 0.0, 5.0, 2.0]))
    else:
        voltage = Programme(
            np.array([0.0, 1.0, 15.0]),
            np.array([[0.0] * 6, [3.0, 4.0, 5.0, 6.0, 7.0, 8.0], [1.0, 0.0, 1.0, 0.0, 1.0, 0.0]]),
        )
    room = Programme(np.array([0.0, 40.0]), np.array([295.0, 299.0]), is_linear=True)
    wanted = dict.fromkeys((*NAMES, "extension", "length", *DERIVED, *MADE, "terminal_voltage"), dataset.time.values)
    result = simulate(
        CoilNetworkLayout(36, (6,) * 6, supply),
        Drive(room, voltage),
        0.02,
        40.0,
        wanted,
        {
            "supply_resistance": 0.4,
            "string_resistance": 0.2,
            "resistance_temperature_coefficient": 0.002,
            "use_regressed_cooling_rate": float(regressed == "true"),
            "load": 0.1 * 9.81,
        },
    )
    assert np.ptp(dataset["actuator.stiffness"].values) > 100.0
    assert_equal(result, dataset, {**NAMES, **DERIVED, "extension": "load.extension", "length": "load.length"})
    for quantity, channels in MADE.items():
        wanted = np.stack([recorded_series(dataset, parse_quantity(c), tmp_path).values for c in channels], axis=1)
        np.testing.assert_allclose(result[quantity], wanted, rtol=TOLERANCE, atol=TOLERANCE * wanted.max())
    terminal = dataset["circuit.terminal_voltage"].values.reshape(len(dataset.time), -1)
    np.testing.assert_allclose(
        result["terminal_voltage"], np.broadcast_to(terminal, (len(terminal), 6)), rtol=TOLERANCE
    )
    if supply == "common":
        assert terminal[20, 0] == pytest.approx(9.0 - 0.4 * dataset["circuit.supply_current"].values[20], rel=1e-9)
        np.testing.assert_array_equal(
            recorded_series(dataset, parse_quantity("supply.voltage"), tmp_path).values, terminal[:, 0]
        )
    else:
        with pytest.raises(InputError, match="a supply of its own"):
            recorded_series(dataset, parse_quantity("supply.voltage"), tmp_path)
