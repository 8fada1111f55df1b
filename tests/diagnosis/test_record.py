"""`cosim record`: what sensors read of a run comes back from the folder as it was."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml
from typer.testing import CliRunner

from cosim.cli import app
from cosim.run import run
from cosim.scenario import Scenario, parse_scenario
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue
from diagnosis.recording.channels import chosen, offered
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.quantity import Target, parse_quantity
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import load_recording
from diagnosis.recording.sensor import Sensor, SensorFile, lag, load_sensors, read_with
from diagnosis.recording.series import Series, sample, series_of
from diagnosis.recording.write import Notes, write_recording

PENDULUM = """
title: a short swing
time: {stop: 2 s, macro_step: 5 ms, output_step: 5 ms, checkpoint_step: 1 s}
components:
  arm: {kind: bullet_pendulum, parameter_set: pendulum_arm, parameters: {initial_angle: 2 rad}}
"""
RAMP = Series(np.arange(0.0, 100.5, 0.5), np.arange(0.0, 100.5, 0.5) + 290.0, False, "K")


def pendulum() -> Scenario:
    return parse_scenario(PENDULUM, Path("short.yaml"))


def read(sensor: Sensor, series: Series = RAMP, seed: int = 0):
    return read_with(sensor, series, np.random.default_rng(seed))


def test_the_end_of_a_step_is_told_from_means_and_a_jump_stays_one():
    """An exponential after a switch, by exact means over steps of 0.1 s; outputs at each step, or each second one."""
    tau, step = 0.8, 0.1

    def made(every: int) -> tuple[xr.Dataset, np.ndarray]:
        ends = step * np.arange(81)
        decay = np.where(ends > 4.0, np.exp(-np.maximum(ends - 4.0, 0.0) / tau), 1.0)
        area = np.minimum(ends, 4.0) + tau * (1.0 - np.exp(-np.maximum(ends - 4.0, 0.0) / tau))
        means = np.concatenate([[1.0], np.diff(area) / step])[::every]
        about = {"units": "A", "cell_methods": "time: mean"}
        data = {"circuit.supply_current": ("time", means, about)}
        results = xr.Dataset(data, {"time": ("time", ends[::every])}, {"macro_step_s": step})
        return results, decay[::every]

    for every in (1, 2):
        results, exact = made(every)
        found = series_of(results, parse_quantity("supply.current"), Path("x")).values
        means = results["circuit.supply_current"].values
        away = slice(40 // every + 2, -1)
        off, before = np.abs(found - exact)[away], np.abs(means - exact)[away]
        assert off.max() < 0.1 * before.max()
        np.testing.assert_allclose(found[: 40 // every + 1], 1.0, atol=1e-12)
        assert "cell_methods" not in results["time"].attrs
    results.attrs.pop("macro_step_s")
    plain = series_of(results, parse_quantity("supply.current"), Path("x")).values
    np.testing.assert_array_equal(plain, results["circuit.supply_current"].values)


def test_a_perfect_recording_is_the_run_itself(tmp_path):
    results = run(pendulum())
    sensors = SensorFile.model_validate({"default": {"rate": "200 Hz"}})
    write_recording(tmp_path / "r", read_results(results, [], sensors, 0, tmp_path), Notes("swing"))
    recording = load_recording(tmp_path / "r")
    assert set(recording.channels) == {"arm.angle", "arm.angular_velocity"}
    for name, found in recording.channels.items():
        np.testing.assert_allclose(found.times, results["time"].values, atol=1e-12)
        np.testing.assert_allclose(found.values, results[name].values, rtol=1e-12)


HEATER = """
title: one heater
time: {start: 2 s, stop: 12 s, macro_step: 100 ms, output_step: 500 ms, checkpoint_step: 10 s}
components:
  drive: {kind: programme, outputs: {power: {unit: W, points: [[2 s, 0 W], [4 s, 1 W], [9 s, 0.2 W]]}}}
  room: {kind: programme, outputs: {temperature: {unit: K, constant: 19.5 degC}}}
  heater: {kind: fmu, fmu: thermal_stiffness, structure: {coils: 1}, parameter_set: tclab_heater,
           parameters: {initial_temperature: 31 degC}}
connections:
  - drive.power -> heater.power[1]
  - room.temperature -> heater.ambient_temperature
"""
#: What somebody may change in the scenario after the recording was made.
LATER = [
    ("points: [[2 s, 0 W], [4 s, 1 W], [9 s, 0.2 W]]", "interpolation: linear, points: [[0 s, 3 W], [100 s, 5 W]]"),
    ("constant: 19.5 degC", "points: [[0 s, 25 degC], [9 s, 40 degC]]"),
    ("initial_temperature: 31 degC", "initial_temperature: 50 degC"),
    ("start: 2 s, stop: 12 s", "start: 0 s, stop: 700 s"),
]


@pytest.mark.parametrize("is_run_folder", [False, True])
def test_a_recording_holds_its_conditions_whatever_the_scenario_says_later(tmp_path, is_run_folder):
    file, out = tmp_path / "heater.yaml", tmp_path / "r"
    file.write_text(HEATER)
    original = parse_scenario(HEATER, file)
    if is_run_folder:
        run(original, tmp_path / "done")
    done = CliRunner().invoke(app, ["record", str(tmp_path / "done" if is_run_folder else file), "--out", str(out)])
    assert done.exit_code == 0, done.output
    text = HEATER
    for before, after in LATER:
        assert before in text
        text = text.replace(before, after)
    file.write_text(text)
    again = scenario_of(parse_scenario(text, file), load_recording(out))
    assert again.components["drive"] == original.components["drive"]
    assert again.components["room"] == original.components["room"]
    assert again.components["heater"].parameters["initial_temperature"].to("degC") == 31.0
    assert (again.time.start.to("s"), again.time.stop.to("s")) == (2.0, 12.0)
    first = run(original)["heater.temperature"]
    # outputs are recorded as often as channels were read: the shared ones are the same
    np.testing.assert_array_equal(run(again)["heater.temperature"].sel(time=first.time).values, first.values)


@pytest.mark.parametrize(
    "text",
    [HEATER.replace(",\n           parameters: {initial_temperature: 31 degC}", ""), PENDULUM],
    ids=["FMU", "pendulum"],
)
def test_a_start_that_the_scenario_does_not_state_is_recorded_too(tmp_path, text):
    """It is that of the FMU's own description, or of the pendulum's design."""
    file, out = tmp_path / "own.yaml", tmp_path / "r"
    file.write_text(text)
    assert CliRunner().invoke(app, ["record", str(file), "--out", str(out)]).exit_code == 0
    recording = load_recording(out)
    (parameters,) = (c["parameters"] for c in recording.overrides["components"].values() if "parameters" in c)
    if "arm" in text:
        assert parameters == {"initial_angle": "2 rad", "initial_angular_velocity": "0.0 rad/s"}
    else:
        first = recording.channels["coil[1].temperature"].values[0]
        assert PhysicalValue.parse(parameters["initial_temperature"]).to("K") == pytest.approx(first, abs=1e-9)
    given = next(iter(run(parse_scenario(text, file)).values()))
    np.testing.assert_array_equal(
        next(iter(run(scenario_of(parse_scenario(text, file), recording)).values())).sel(time=given.time).values,
        given.values,
    )


def test_recorded_conditions_are_not_changed_by_reading_them(tmp_path):
    path, drive = tmp_path / "r", {"unit": "W", "points": [["0 s", "0 W"]]}
    (tmp_path / "heater.yaml").write_text(HEATER)
    write_recording(
        path,
        {
            "coil[1].temperature": read_results(
                run(parse_scenario(HEATER, tmp_path / "heater.yaml")), [], SensorFile(), 0, tmp_path
            )["coil[1].temperature"]
        },
        Notes("h", overrides={"components": {"drive": {"outputs": {"power": drive}}}}),
    )
    content = yaml.safe_load((path / "recording.yaml").read_text())
    content["inputs"] = {"drive.power": {"column": "coil[1].temperature", "unit": "W"}}
    (path / "recording.yaml").write_text(yaml.safe_dump(content))
    recording = load_recording(path)
    scenario_of(parse_scenario(HEATER, tmp_path / "heater.yaml"), recording)
    assert recording.overrides["components"]["drive"]["outputs"]["power"] == drive


def test_every_sensor_fault_leaves_its_own_mark(tmp_path):
    results = run(pendulum())
    sensors = SensorFile.model_validate(
        {
            "channels": {
                "arm.angle": {
                    "rate": "50 Hz",
                    "noise": "0.5 deg",
                    "quantum": "0.1 deg",
                    "maximum": "3.5 rad",
                    "unit": "deg",
                    "gaps": [["0.5 s", "0.7 s"]],
                    "drop_outs": 0.1,
                    "lag_bound": "20 ms",
                },
                "arm.angular_velocity": {"rate": "20 Hz", "clock_offset": "30 ms", "offset_bound": "50 ms"},
            }
        }
    )
    write_recording(tmp_path / "r", read_results(results, [], sensors, 5, tmp_path), Notes("swing"))
    recording = load_recording(tmp_path / "r")
    angle, speed = recording.channels["arm.angle"], recording.channels["arm.angular_velocity"]
    degree = math.pi / 180.0
    assert angle.deviation == pytest.approx(0.5 * degree, rel=1e-9)
    assert angle.quantum == pytest.approx(0.1 * degree, rel=1e-9)
    np.testing.assert_allclose(np.round(angle.values / degree / 0.1) * 0.1, angle.values / degree, atol=1e-9)
    assert not np.any((angle.times > 0.5) & (angle.times < 0.7))
    assert 0.8 < len(angle.times) / (101 - 11) < 0.97
    assert angle.is_clipped.sum() > 5
    assert angle.values.max() <= 3.5 + 1e-9
    truth = np.interp(angle.times, results["time"], results["arm.angle"])
    free = ~angle.is_clipped & (truth < 3.45)
    assert np.std((angle.values - truth)[free]) == pytest.approx(0.5 * degree, rel=0.25)  # some 60 readings
    assert speed.times[0] == pytest.approx(0.03, abs=1e-12)
    assert speed.offset_bound == 0.05
    true = np.interp(speed.times - 0.03, results["time"], results["arm.angular_velocity"])
    np.testing.assert_allclose(speed.values, true, atol=1e-6)


def test_the_folder_does_not_tell_what_a_laboratory_would_not_know(tmp_path):
    concealed = {"lag": "0.2 s", "gain": 1.05, "bias": "2 deg", "drift": "1 deg/s", "clock_offset": "10 ms"}
    sensors = SensorFile.model_validate({"channels": {"arm.angle": concealed}})
    write_recording(tmp_path / "r", read_results(run(pendulum()), [], sensors, 0, tmp_path), Notes("swing"))
    content = yaml.safe_load((tmp_path / "r" / "recording.yaml").read_text())
    assert content["channels"]["arm.angle"] == {"column": "arm.angle", "unit": "rad"}


def test_gain_bias_and_drift_act_in_the_unit_of_the_reading():
    found = read(Sensor.model_validate({"rate": "1 Hz", "gain": 1.02, "bias": "0.5 K", "drift": "0.01 K/s"}))
    true = np.arange(0.0, 101.0) + 290.0 - 273.15
    assert found.unit == "degC"
    np.testing.assert_allclose(found.values, 1.02 * true + 0.5 + 0.01 * np.arange(0.0, 101.0), atol=1e-9)


def test_a_lag_follows_a_ramp_at_the_distance_of_its_time_constant():
    found = lag(RAMP.times, RAMP.values, 4.0)
    expected = RAMP.values - 4.0 * (1.0 - np.exp(-RAMP.times / 4.0))  # slope 1 K/s, settled at the start
    np.testing.assert_allclose(found, expected, atol=1e-10)
    np.testing.assert_array_equal(lag(RAMP.times, RAMP.values, 0.0), RAMP.values)


def test_readings_that_scatter_in_time_are_true_at_their_recorded_times():
    found = read(Sensor.model_validate({"rate": "2 Hz", "jitter": "50 ms", "unit": "K"}))
    assert np.std(np.diff(found.times)) == pytest.approx(0.05 * math.sqrt(2.0), rel=0.15)  # 200 intervals
    np.testing.assert_allclose(found.values, 290.0 + found.times, atol=1e-9)


def test_the_same_seed_reads_the_same_and_another_channel_changes_nothing(tmp_path):
    results = run(pendulum())
    sensors = SensorFile.model_validate({"default": {"noise": "0.01", "drop_outs": 0.2, "jitter": "1 ms"}})
    alone = read_results(results, ["arm.angle"], sensors, 7, tmp_path)["arm.angle"].reading
    both = read_results(results, ["arm.angular_velocity", "arm.angle"], sensors, 7, tmp_path)["arm.angle"].reading
    other = read_results(results, ["arm.angle"], sensors, 8, tmp_path)["arm.angle"].reading
    np.testing.assert_array_equal(alone.values, both.values)
    assert not np.array_equal(alone.values, other.values, equal_nan=True)


def test_samples_between_outputs_are_right_to_fourth_order():
    errors = []
    for step in (0.1, 0.05):
        times = np.arange(0.0, 2.0 + step / 2, step)
        series = Series(times, np.sin(3.0 * times), False, "1")
        at = np.linspace(0.0, 2.0, 997)
        errors.append(np.max(np.abs(sample(series, at) - np.sin(3.0 * at))))
    assert 3.5 < math.log2(errors[0] / errors[1]) < 4.3


@pytest.mark.parametrize("is_flow", [False, True])
def test_a_run_that_loses_its_way_is_infinitely_wrong_without_a_warning(is_flow):
    """Warnings are errors here: neither overflow nor `invalid value` may come up."""
    times = np.arange(0.0, 10.0)
    values = np.array([1.0, 2.0, 3.0, 4.0, 1e308, -1e308, math.inf, math.nan, 5.0, 6.0])
    dataset = xr.Dataset({"a.b": ("time", values, {"units": "km"})}, {"time": times})
    series = series_of(dataset, Target("a", (), "b", "mm"), Path("r"))
    found = sample(Series(series.times, series.values, is_flow, "mm"), np.array([0.0, 0.5, 2.5, 4.0, 5.5, 7.0, 9.0]))
    np.testing.assert_allclose(found[:2], [1e6, 1.5e6])
    assert np.isposinf(found[3:6]).all()
    assert not np.isnan(found).any()
    assert found[6] == (6e6 if is_flow else math.inf)  # the cubic of the last samples is drawn with a lost one


def test_most_exact_sensor_entry_holds():
    sensors = SensorFile.model_validate(
        {
            "default": {"rate": "1 Hz"},
            "channels": {"coil.temperature": {"rate": "2 Hz"}, "coil[2,5].temperature": {"rate": "3 Hz"}},
        }
    )
    rates = [
        sensors.of(parse_quantity(n)).rate.number
        for n in ("supply.current", "coil[1,5].temperature", "coil[2,5].temperature")
    ]
    assert rates == [1.0, 2.0, 3.0]


@pytest.fixture(scope="module")
def coils():
    """Results of six strings of one coil."""
    from cosim.scenario import load_scenario

    loaded = load_scenario("single_coil_heating")
    short = parse_scenario(loaded.to_yaml().replace("stop: 80 s", "stop: 20 s"), loaded.path)
    return run(short)


def test_every_string_and_coil_can_be_recorded_by_its_place(coils, tmp_path):
    names = offered(coils)
    assert "supply.current" in names
    assert [n for n in names if n.startswith("string")] == [f"string[{i}].current" for i in range(1, 7)]
    assert [n for n in names if n.endswith(".temperature")] == [f"coil[{i},1].temperature" for i in range(1, 7)]
    assert chosen(coils, ["coil[*].temperature", "coil[2,1].temperature"], tmp_path) == names_of_temperature(names)
    by_place = series_of(coils, parse_quantity("coil[4,1].temperature"), tmp_path)
    by_number = series_of(coils, parse_quantity("coil[4].temperature"), tmp_path)
    np.testing.assert_array_equal(by_place.values, coils["actuator.temperature"].values[:, 3])
    np.testing.assert_array_equal(by_place.values, by_number.values)
    current = series_of(coils, parse_quantity("supply.current"), tmp_path)
    assert current.is_flow
    np.testing.assert_array_equal(current.values, coils["circuit.supply_current"].values)


def names_of_temperature(names: list[str]) -> list[str]:
    return [n for n in names if n.endswith(".temperature")]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("coil[9,1].temperature", "no coil 1 in string 9"),
        ("coil[1,2].temperature", "no coil 2 in string 1"),
        ("coil[7].temperature", "6 elements"),
        ("string[7].current", "6 elements"),
        ("fabric.max_curvature", "no such quantity"),
        ("marker[*].z", "fits nothing"),
        ("colour", "is no name of a quantity"),
    ],
)
def test_a_channel_that_is_not_there_is_one_error(coils, tmp_path, name, text):
    with pytest.raises(InputError, match=text):
        read_results(coils, [name], SensorFile(), 0, tmp_path)


@pytest.mark.parametrize(
    ("content", "text"),
    [
        ("default: {rate: 0 Hz}", "greater than 0"),
        ("default: {rat: 2 Hz}", "no such key"),
        ("default: {drop_outs: 1.5}", "less than 1"),
        ("default: {gaps: [[3 s, 2 s]]}", "does not come after"),
        ("[1, 2]", "a mapping"),
        ("default: {rate: [", "not valid YAML"),
    ],
)
def test_a_wrong_sensor_file_is_one_error(tmp_path, content, text):
    file = tmp_path / "sensors.yaml"
    file.write_text(content)
    with pytest.raises(InputError, match=text):
        load_sensors(file)


def test_a_sensor_in_the_wrong_unit_names_the_channel(coils, tmp_path):
    sensors = SensorFile.model_validate({"channels": {"supply.current": {"noise": "3 K"}}})
    with pytest.raises(InputError) as caught:
        read_results(coils, ["supply.current"], sensors, 0, tmp_path)
    assert caught.value.key == "channels.supply.current"


def test_a_folder_with_a_recording_is_never_overwritten(tmp_path):
    (tmp_path / "short.yaml").write_text(PENDULUM)
    (tmp_path / "r").mkdir()
    (tmp_path / "r" / "recording.yaml").write_text("mine")
    with pytest.raises(InputError, match="already holds a recording"):
        CliRunner().invoke(
            app, ["record", str(tmp_path / "short.yaml"), "--out", str(tmp_path / "r")], catch_exceptions=False
        )
    assert (tmp_path / "r" / "recording.yaml").read_text() == "mine"
