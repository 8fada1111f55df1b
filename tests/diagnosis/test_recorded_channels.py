"""Every documented channel of supply, strings and coils: results of a run and the network say the same of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.errors import InputError
from diagnosis.amend.free_run import read_run
from diagnosis.models.build import model_of
from diagnosis.models.coil_network.kernel.layout import QUANTITIES, CoilNetworkLayout
from diagnosis.models.coil_network.runs import network_quantity
from diagnosis.models.coil_network.translate import translate
from diagnosis.recording.fits import no_results
from diagnosis.recording.quantity import _KINDS, parse_quantity
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.series import recorded_series, series_of
from diagnosis.recording.write import Notes, write_recording
from diagnosis.search.problem import Point
from tests.diagnosis.test_recording import folder

TWO_STRINGS = """
title: two strings of three coils behind one supply with an inner resistance
time: {{stop: 12 s, macro_step: 10 ms, output_step: 50 ms, checkpoint_step: 6 s}}
algorithm: {{kind: gauss_seidel, order: [supply, room, circuit, actuator, load]}}
components:
  supply: {{kind: programme, outputs: {{voltage: {{unit: V, points: [[0 s, 0 V], [1 s, 6 V], [8 s, 2 V]]}}}}}}
  room: {{kind: programme, outputs: {{temperature: {{unit: K, constant: 22 degC}}}}}}
  circuit: {{kind: ngspice, strings: [3, 3], supply_resistance: 0.4 ohm, string_resistance: 0.2 ohm,
            start: {{resistance: 2.2 ohm}}{broken}}}
  actuator: {{kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, mechanical: load,
             parameters: {{resistance_temperature_coefficient: 0.002 1/K}}}}
  load: {{kind: hanging_mass, coils: 6, mass: 50 g}}
connections:
  - supply.voltage -> circuit.supply_voltage
"""
#: Each measures something else; the other names of the same quantities are compared with these.
CHANNELS = [
    "supply.current",
    "supply.voltage",
    "supply.power",
    "string[1].current",
    "string[2].voltage",
    "coil[1,2].voltage",
    "coil[2,1].power",
    "coil[2,3].temperature",
    "coil[4].resistance",
    "coil[1,1].stiffness",
    "coil[6].extension",
    "coil[5].length",
    "coil[1].tension",
    "coil[2,2].current",
]


def recorded(tmp_path: Path, broken: str = ""):
    """Scenario, results and recording of every channel, by perfect sensors."""
    file = tmp_path / "two_strings.yaml"
    file.write_text(TWO_STRINGS.format(broken=broken))
    scenario = parse_scenario(file.read_text(), file)
    results = run(scenario)
    sensors = SensorFile.model_validate({"default": {"rate": "5 Hz"}})
    read = read_results(results, CHANNELS, sensors, 0, file)
    write_recording(tmp_path / "r", read, Notes("two strings", overrides={"time": {"stop": "12 s"}}))
    return scenario, results, load_recording(tmp_path / "r")


@pytest.mark.parametrize("broken", ["", ", open_coils: [2]", ", shorted_coils: [5]"])
def test_network_and_results_of_a_run_agree_on_every_channel(tmp_path, broken):
    scenario, results, recording = recorded(tmp_path, broken)
    model = model_of(scenario, [recording], [])
    assert type(model).__name__ == "CoilNetworkModel"
    predicted = model.predict(Point(np.zeros(len(model.parameters))), 0)
    for series, values in zip(model.runs[0].series, predicted):
        measured = series.measured[series.used]
        # The co-simulation holds resistances over a macro-step of 10 ms, the network takes them at its middle.
        scale = max(np.abs(measured).max(), 1e-3)
        np.testing.assert_allclose(values[series.used], measured, atol=2e-3 * scale, err_msg=series.channel.name)
    if broken.startswith(", open"):
        by_name = dict(zip((s.channel.name for s in model.runs[0].series), predicted))
        assert np.abs(by_name["string[1].current"]).max() < 1e-9
        assert by_name["coil[1,2].voltage"].max() == pytest.approx(
            results["circuit.terminal_voltage"].values.max(), rel=1e-3
        )


def test_the_names_of_one_quantity_say_the_same(tmp_path):
    _, results, _ = recorded(tmp_path)

    def values(name):  # means over steps, as the co-simulation gives them: a product of two at the ends is another
        return recorded_series(results, parse_quantity(name), tmp_path).values

    np.testing.assert_array_equal(values("coil[2,1].current"), values("string[2].current"))
    np.testing.assert_allclose(values("string[1].voltage"), sum(values(f"coil[1,{n}].voltage") for n in (1, 2, 3)))
    np.testing.assert_allclose(values("supply.power"), values("supply.voltage") * values("supply.current"))
    late = results["time"].values > 1.1
    lost = values("supply.voltage") - values("string[1].voltage")  # in the string's wires
    np.testing.assert_allclose(lost[late], 0.2 * values("string[1].current")[late], rtol=1e-9)
    layout = CoilNetworkLayout(6, (3, 3))
    recording = load_recording(folder(tmp_path))
    assert network_quantity(parse_quantity("coil[5].current"), layout, recording) == ("current", 1)
    assert network_quantity(parse_quantity("coil[2,2].voltage"), layout, recording) == ("voltage", 4)


def test_every_documented_quantity_of_supply_strings_and_coils_is_offered_by_the_network(tmp_path):
    recording, layout = load_recording(folder(tmp_path)), CoilNetworkLayout(6, (3, 3))
    for kind, element in (("supply", ""), ("string", "[1]"), ("coil", "[1,2]")):
        for quantity in _KINDS[kind][0]:
            network_quantity(parse_quantity(f"{kind}{element}.{quantity}"), layout, recording)


@pytest.mark.parametrize(
    ("name", "layout", "text"),
    [
        ("supply.voltage", CoilNetworkLayout(6, (3, 3), "per_string"), "every string has a supply of its own"),
        ("supply.voltage", CoilNetworkLayout(2), "gives the power of its heaters"),
        ("coil[1].current", CoilNetworkLayout(2), "gives the power of its heaters"),
        ("coil[1,3].temperature", CoilNetworkLayout(2), "no such quantity"),
        ("coil[2,1].temperature", CoilNetworkLayout(2), "no such quantity"),
        ("string[3].voltage", CoilNetworkLayout(6, (3, 3)), "6 coils in 2 strings"),
        ("heaters.temperature[1]", CoilNetworkLayout(2), "names of its supply, strings and coils"),
    ],
)
def test_what_a_network_cannot_offer_is_said(tmp_path, name, layout, text):
    with pytest.raises(InputError) as caught:
        network_quantity(parse_quantity(name), layout, load_recording(folder(tmp_path)))
    assert text in str(caught.value)
    assert caught.value.key == f"channels.{name}"


def test_without_a_circuit_all_coils_are_one_string(tmp_path):
    channels = {f"coil[1,{n}].temperature": {"column": "T", "unit": "degC"} for n in (1, 2)}
    model = model_of(load_scenario("tclab"), [load_recording(folder(tmp_path, channels=channels))], [])
    assert [(s.quantity, s.element) for s in model.runs[0].series] == [("temperature", 0), ("temperature", 1)]


def test_two_channels_of_one_quantity_are_refused(tmp_path):
    channels = {n: {"column": "T", "unit": "degC"} for n in ("coil[1,1].temperature", "coil[1].temperature")}
    with pytest.raises(InputError, match=r"measures the same as coil\[1,1\]\.temperature") as caught:
        model_of(load_scenario("tclab"), [load_recording(folder(tmp_path, channels=channels))], [])
    assert caught.value.key == "channels.coil[1].temperature"


def test_a_coil_may_be_open_in_one_recording_alone(tmp_path):
    scenario, _, whole = recorded(tmp_path)
    content = (tmp_path / "r" / "recording.yaml").read_text()
    (tmp_path / "r" / "recording.yaml").write_text(
        content.replace("overrides:\n", "overrides:\n  components: {circuit: {open_coils: [1]}}\n")
    )
    broken = load_recording(tmp_path / "r")
    model = model_of(scenario, [whole, broken], [])
    start = Point(np.zeros(len(model.parameters)))
    number = CHANNELS.index("string[1].current")
    first, second = (model.predict(start, n)[number].max() for n in (0, 1))
    assert first > 0.5
    assert second < 1e-9
    resistances = [p for p in model.parameters if p.name == "reference_resistance"]
    assert resistances[0].nominal == pytest.approx(2.2)  # of the coils that are whole


def test_places_of_a_fabric_are_as_documented():
    """String s is row s from the tether; along it two coils to a link, the arm at -x first, from the supply on."""
    there = no_results(load_scenario("spatial_control"))
    link = there["coil_link"].values - 1
    np.testing.assert_array_equal(there["string_of_coil"], there["link_row"].values[link])
    expected = 2 * (there["link_place"].values[link] - 1) + there["coil_arm"].values
    np.testing.assert_array_equal(there["position_in_string"], expected)
    assert "at the supply" in there["position_in_string"].attrs["long_name"]
    assert "counted from the tether" in there["row"].attrs["long_name"]
    assert there["coil_arm"].attrs["long_name"].startswith("1: arm at -x")


def test_a_free_run_is_read_on_every_derived_quantity(tmp_path):
    scenario, results, recording = recorded(tmp_path)
    derived = [n for n, q in QUANTITIES.items() if q.is_derived]
    times = dict.fromkeys(derived, np.arange(0.5, 11.9, 0.5))
    found = read_run(results, translate(scenario), times)
    for name in ("supply.power", "supply.voltage", "string[2].voltage", "coil[1,2].voltage", "coil[1].tension"):
        quantity, element = network_quantity(parse_quantity(name), translate(scenario).layout, recording)
        own = series_of(results, parse_quantity(name), tmp_path)
        steps = np.searchsorted(own.times, times[quantity] - 1e-9)  # a flow stands at the end of its step
        np.testing.assert_allclose(found[quantity][:, element], own.values[steps], rtol=2e-3, err_msg=name)
