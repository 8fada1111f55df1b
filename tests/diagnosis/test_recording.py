"""Recordings are read, checked, converted and aligned; noise is estimated where it is not given."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.errors import InputError
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.noise import estimate_noise, find_quantum
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import load_recording

TIMES = np.arange(0.0, 20.0, 0.5)


def folder(path: Path, table: dict[str, Any] | None = None, **sidecar: Any) -> Path:
    """A recording of one heater with the keys given."""
    columns = {"time": TIMES, "T": 20.0 + TIMES} if table is None else table
    pd.DataFrame(columns).to_csv(path / "data.csv", index=False)
    content = {
        "title": "a heater",
        "table": "data.csv",
        "channels": {"coil[1].temperature": {"column": "T", "unit": "degC"}},
    }
    (path / "recording.yaml").write_text(yaml.safe_dump({**content, **sidecar}))
    return path


def channel(**keys: Any) -> dict[str, Any]:
    return {"coil[1].temperature": {"column": "T", "unit": "degC", **keys}}


def test_units_become_si_and_differences_stay_differences(tmp_path):
    recording = load_recording(
        folder(tmp_path, channels=channel(noise="0.3 degC", quantum="0.1 degC", maximum="35 degC", bias_bound="1 degC"))
    )
    found = recording.channels["coil[1].temperature"]
    assert found.values[0] == pytest.approx(293.15, abs=1e-9)  # 20 degC
    assert (found.deviation, found.quantum, found.bias_bound) == pytest.approx((0.3, 0.1, 1.0), rel=1e-12)
    assert found.limits == (-math.inf, pytest.approx(308.15, abs=1e-9))
    assert found.is_deviation_given
    assert found.is_clipped.sum() == np.sum(TIMES >= 15.0)


def test_a_rounding_step_is_found_beside_a_stated_noise(tmp_path):
    """Readings in steps of 0.5 K, a thermometer said to be good to 0.1 K: their errors are 0.5 / sqrt(12) at least."""
    random = np.random.default_rng(3)
    times = np.arange(0.0, 100.0, 0.5)
    smooth = 20.0 + 0.1 * times + 0.1 * random.standard_normal(len(times))
    for values, step in ((np.round(smooth / 0.5) * 0.5, 0.5), (smooth, 0.0)):
        table = {"time": times, "T": values}
        found = load_recording(folder(tmp_path, table, channels=channel(noise="0.1 degC")))
        assert found.channels["coil[1].temperature"].quantum == pytest.approx(step, abs=1e-9)
        assert found.channels["coil[1].temperature"].deviation == pytest.approx(0.1, rel=1e-12)


def test_channels_at_other_rates_and_clocks_come_onto_the_clock_of_the_scenario(tmp_path):
    ticks = np.arange(0.0, 20000.0, 137.0)
    pd.DataFrame({"ms": 5000.0 + ticks, "mA": np.sin(ticks)}).to_csv(tmp_path / "fast.csv", index=False)
    channels = channel() | {
        "supply.current": {
            "column": "mA",
            "unit": "mA",
            "table": "fast.csv",
            "time": {"column": "ms", "unit": "ms", "zero": 5000.0, "offset_bound": "40 ms"},
        }
    }
    recording = load_recording(folder(tmp_path, channels=channels))
    current = recording.channels["supply.current"]
    np.testing.assert_allclose(current.times, ticks / 1000.0, atol=1e-12)
    np.testing.assert_allclose(current.values, np.sin(ticks) / 1000.0, rtol=1e-12)
    assert current.offset_bound == pytest.approx(0.04, rel=1e-12)
    assert len(recording.channels["coil[1].temperature"].times) == len(TIMES)
    assert recording.end == pytest.approx(ticks[-1] / 1000.0, abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(lost=st.lists(st.booleans(), min_size=40, max_size=40), seed=st.integers(0, 10**6))
def test_gaps_and_irregular_times_keep_exactly_the_readings_that_are_there(tmp_path_factory, lost, seed):
    path = tmp_path_factory.mktemp("gappy")
    random = np.random.default_rng(seed)
    times = np.cumsum(random.uniform(0.01, 1.0, 40))
    values = random.normal(20.0, 1.0, 40)
    gone = np.array(lost)
    table = {"time": times, "T": np.where(gone, np.nan, values)}
    sidecar = {"time": {"zero": 0.0}, "channels": channel(invalid=[-999.0])}
    if (~gone).sum() < 8:
        with pytest.raises(InputError, match="fewer than 8"):
            load_recording(folder(path, table, **sidecar))
        return
    found = load_recording(folder(path, table, **sidecar)).channels["coil[1].temperature"]
    np.testing.assert_allclose(found.times, times[~gone], rtol=1e-12)
    np.testing.assert_allclose(found.values, values[~gone] + 273.15, rtol=1e-12)
    assert 0.0 < found.deviation < np.inf


def test_parquet_is_read_as_csv_is(tmp_path):
    pytest.importorskip("pyarrow", reason="reading Parquet needs pyarrow, which is not installed")
    as_csv = load_recording(folder(tmp_path)).channels["coil[1].temperature"].values
    pd.DataFrame({"time": TIMES, "T": 20.0 + TIMES}).to_parquet(tmp_path / "data.parquet")
    content = yaml.safe_load((tmp_path / "recording.yaml").read_text()) | {"table": "data.parquet"}
    (tmp_path / "recording.yaml").write_text(yaml.safe_dump(content))
    as_parquet = load_recording(tmp_path)
    np.testing.assert_array_equal(as_parquet.channels["coil[1].temperature"].values, as_csv)


def test_only_what_lies_between_begin_and_end_and_is_valid_counts(tmp_path):
    values = np.where(TIMES == 6.0, 0.0, 20.0 + TIMES)
    recording = load_recording(
        folder(tmp_path, {"time": TIMES, "T": values}, begin="5 s", end="15 s", channels=channel(invalid=[0.0]))
    )
    times = recording.channels["coil[1].temperature"].times
    assert (times[0], times[-1], len(times)) == (5.0, 15.0, 20)
    assert 6.0 not in times


WRONG = [
    ({"channels": channel(column="U")}, "channels.coil[1].temperature.column", "there is no column `U`"),
    ({"channels": channel(unit="V")}, "channels.coil[1].temperature.unit", "V cannot be converted to K"),
    ({"channels": channel(noise="3 mA")}, "channels.coil[1].temperature.noise.unit", "mA cannot be converted to K"),
    ({"channels": channel(noise="-1 K")}, "channels.coil[1].temperature.noise", "is not positive"),
    ({"channels": channel(maximum="3 V")}, "channels.coil[1].temperature.maximum", "3 V"),
    ({"channels": {"coil[0].temperature": {"column": "T", "unit": "degC"}}}, "channels.coil[0].temperature", "from 1"),
    ({"channels": {"coil[1,2,3].temperature": {"column": "T", "unit": "K"}}}, "channels.coil[1,2,3]", "write `coil"),
    ({"channels": {"coil[1].colour": {"column": "T", "unit": "degC"}}}, "channels.coil[1].colour", "no colour"),
    ({"time": {"unit": "V"}}, "time.unit", "V cannot be converted to s"),
    ({"time": {"column": "clock"}}, "time.column", "there is no column `clock`"),
    ({"table": "other.csv"}, "", "there is no such table"),
    ({"chanels": {}}, "chanels", "there is no such key"),
    ({"begin": "5 s", "end": "4 s"}, "", "must come after begin"),
    ({"end": "2 s"}, "channels.coil[1].temperature", "it has 5 values, fewer than 8"),
    ({"inputs": {"drive": {"column": "T", "unit": "W"}}}, "inputs.drive", "no output of a programme"),
]


@pytest.mark.parametrize(("sidecar", "key", "text"), WRONG, ids=[text for _, _, text in WRONG])
def test_a_wrong_recording_is_one_error_that_names_the_key(tmp_path, sidecar, key, text):
    path = folder(tmp_path)
    content = yaml.safe_load((path / "recording.yaml").read_text()) | sidecar
    (path / "recording.yaml").write_text(yaml.safe_dump(content))
    with pytest.raises(InputError) as caught:
        load_recording(path)
    assert text in str(caught.value)
    assert key in caught.value.key or caught.value.key == key


@pytest.mark.parametrize(
    ("table", "text"),
    [
        ({"time": TIMES[::-1], "T": TIMES}, "its times do not rise"),
        ({"time": np.repeat(TIMES[::2], 2), "T": TIMES}, "its times do not rise"),
        ({"time": TIMES, "T": ["warm", *TIMES[1:]]}, "`warm` in row 1"),
        ({"time": [math.nan] * len(TIMES), "T": TIMES}, "the clock has no values"),
        ({"time": TIMES, "T": [math.nan] * len(TIMES)}, "0 values"),
    ],
)
def test_a_wrong_table_is_one_error(tmp_path, table, text):
    with pytest.raises(InputError) as caught:
        load_recording(folder(tmp_path, table))
    assert text in str(caught.value)


def test_a_folder_without_a_recording_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"no recording\.yaml"):
        load_recording(tmp_path)


def test_overrides_and_recorded_inputs_make_the_scenario_of_the_recording(tmp_path):
    power = np.repeat([0.0, 50.0, 100.0, 0.0], 10)
    path = folder(
        tmp_path,
        {"time": TIMES, "T": 20.0 + TIMES, "percent": power},
        overrides={"components": {"room": {"outputs": {"temperature": {"constant": "19 degC"}}}}},
        inputs={"drive.power_1": {"column": "percent", "unit": "W", "factor": 0.01}},
    )
    scenario = scenario_of(load_scenario("tclab"), load_recording(path))
    assert scenario.components["room"].outputs["temperature"].constant.to("K") == pytest.approx(292.15)
    points = scenario.components["drive"].outputs["power_1"].points
    assert [(t.to("s"), v.to("W")) for t, v in points] == [(0.0, 0.0), (5.0, 0.5), (10.0, 1.0), (15.0, 0.0)]
    assert scenario.time.stop.to("s") == pytest.approx(19.5)


def test_a_constant_may_stand_in_place_of_points_and_the_other_way_round(tmp_path):
    drive = {"power_1": {"constant": "0.3 W"}}
    room = {"temperature": {"points": [["0 s", "20 degC"], ["10 s", "21 degC"]]}}
    path = folder(tmp_path, overrides={"components": {"drive": {"outputs": drive}, "room": {"outputs": room}}})
    components = scenario_of(load_scenario("tclab"), load_recording(path)).components
    assert components["drive"].outputs["power_1"].points is None
    assert components["drive"].outputs["power_1"].constant.to("W") == pytest.approx(0.3)
    assert components["room"].outputs["temperature"].constant is None
    assert len(components["drive"].outputs["power_2"].points) == 4


def test_another_kind_of_component_replaces_the_whole_of_it(tmp_path):
    load = {"kind": "bullet_pendulum", "parameter_set": "pendulum_arm"}
    base = parse_scenario(
        "title: t\ntime: {stop: 1 s, macro_step: 5 ms, output_step: 5 ms, checkpoint_step: 1 s}\n"
        "components:\n  load: {kind: hanging_mass, coils: 1, mass: 5 g}\n",
        tmp_path / "own.yaml",
    )
    (tmp_path / "own.yaml").write_text(base.to_yaml())
    path = folder(tmp_path, overrides={"components": {"load": load}})
    assert scenario_of(base, load_recording(path)).components["load"].kind == "bullet_pendulum"


def test_tables_that_share_a_clock_share_its_zero(tmp_path):
    pd.DataFrame({"time": 103.0 + TIMES, "mA": TIMES}).to_csv(tmp_path / "late.csv", index=False)
    channels = channel() | {"supply.current": {"column": "mA", "unit": "mA", "table": "late.csv"}}
    table = {"time": 100.0 + TIMES, "T": 20.0 + TIMES}
    recording = load_recording(folder(tmp_path, table, channels=channels))
    assert recording.channels["coil[1].temperature"].times[0] == 0.0
    assert recording.channels["supply.current"].times[0] == pytest.approx(3.0, abs=1e-9)


def test_an_input_that_the_scenario_does_not_have_is_named(tmp_path):
    path = folder(tmp_path, inputs={"drive.torque": {"column": "T", "unit": "W"}})
    with pytest.raises(InputError) as caught:
        scenario_of(load_scenario("tclab"), load_recording(path))
    assert caught.value.key == "inputs.drive.torque"
    assert "power_1" in caught.value.remedy


NAMES = [
    "supply.current",
    "string[3].current",
    "coil[2,5].temperature",
    "coil[7].extension",
    "marker[4].z",
    "fabric.max_curvature",
    "arm.angle",
    "heater.temperature[2]",
]


@pytest.mark.parametrize("name", NAMES)
def test_names_of_quantities_survive_being_read(name):
    assert str(parse_quantity(name)) == name


def heating(noise: float, quantum: float, seed: int, switches: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A coil that heats for 100 s at 2 Hz, with jumps if wanted."""
    random = np.random.default_rng(seed)
    times = np.arange(0.0, 100.0, 0.5)
    values = 22.0 + 40.0 * (1.0 - np.exp(-times / 10.0))
    if switches:
        values = values + np.repeat(random.uniform(0.0, 20.0, switches), len(times) // switches)
    values += noise * random.standard_normal(len(times))
    return times, quantum * np.round(values / quantum) if quantum else values


# 200 readings tell a deviation to 10 % (median); the mean of 20 such to 2.5 %. Rounding to steps of three deviations
# is no longer white: 12 % are left. With a switch at every fifth reading small jumps pass for noise: a fifth.
@pytest.mark.parametrize(
    ("noise", "quantum", "switches", "tolerance"),
    [
        (0.3, 0.0, 0, 0.06),
        (0.003, 0.0, 0, 0.06),
        (0.3, 0.0625, 0, 0.06),
        (0.3, 0.25, 0, 0.06),
        (0.3, 0.5, 0, 0.08),
        (0.1, 0.25, 0, 0.08),
        (0.05, 0.25, 0, 0.15),
        (0.01, 0.25, 0, 0.05),
        (0.3, 0.0, 10, 0.08),
        (0.3, 0.0, 40, 0.25),
        (0.3, 0.25, 10, 0.08),
    ],
)
@pytest.mark.parametrize("is_quantum_known", [True, False])
def test_noise_is_estimated_under_rounding_and_around_switches(noise, quantum, switches, tolerance, is_quantum_known):
    expected = math.hypot(noise, quantum / math.sqrt(12.0))
    found = [estimate_noise(*heating(noise, quantum, s, switches), quantum * is_quantum_known) for s in range(20)]
    assert np.mean(found) == pytest.approx(expected, rel=tolerance)


def test_noise_is_never_below_rounding_and_never_zero():
    times = np.arange(0.0, 10.0, 0.1)
    assert estimate_noise(times, np.zeros(100)) > 0.0
    assert estimate_noise(times, 5.0 + times, 0.2) == pytest.approx(0.2 / math.sqrt(12.0), rel=1e-9)
    assert estimate_noise(times[:2], np.array([1.0, 2.0])) > 0.0


@pytest.mark.parametrize("quantum", [0.0, 0.05])
def test_readings_that_stand_still_at_the_end_of_the_range_do_not_lower_the_estimate(quantum):
    times, values = heating(0.3, quantum, 1)
    free = estimate_noise(times, values, quantum)
    clipped = np.minimum(values, np.quantile(values, 0.5))
    assert np.mean(clipped == clipped.max()) > 0.45
    # Half of 200 readings are left, and those next to the ceiling have lost a part of their noise; with the readings
    # at the ceiling it would be a third.
    assert estimate_noise(times, clipped, quantum) == pytest.approx(free, rel=0.25)


def test_wild_readings_do_not_raise_the_estimate():
    times, values = heating(0.3, 0.0, 1)
    calm = estimate_noise(times, values)
    values[::50] += 5.0
    assert estimate_noise(times, values) == pytest.approx(calm, rel=0.1)  # 4 of 200 readings


@settings(max_examples=50, deadline=None)
@given(scale=st.floats(1e-6, 1e6), slope=st.floats(-10.0, 10.0), seed=st.integers(0, 1000))
def test_noise_scales_with_the_unit_and_ignores_value_and_slope(scale, slope, seed):
    random = np.random.default_rng(seed)
    times = np.sort(random.uniform(0.0, 100.0, 300))
    noise = random.standard_normal(300)
    alone = estimate_noise(times, noise)
    assert estimate_noise(times, scale * (noise + slope * times)) == pytest.approx(
        scale * alone, rel=1e-3, abs=1e-3 * scale
    )


def test_a_reading_that_stands_still_but_for_its_last_digits_has_no_step():
    values = 0.4905 + 1e-13 * np.repeat([0.0, 1.0, 2.0, 1.0, 3.0], 8)
    assert find_quantum(values) == 0.0
    assert 0.0 < estimate_noise(np.arange(40.0), values) < 1e-9


def test_the_step_of_a_rounded_reading_is_found_and_a_smooth_one_has_none():
    times, values = heating(0.05, 0.0625, 3)
    assert find_quantum(values) == pytest.approx(0.0625, rel=1e-9)
    assert find_quantum(np.round(values, 2)) == pytest.approx(0.0625, rel=0.05)  # published with two decimals
    assert find_quantum(heating(0.05, 0.0, 3)[1]) == 0.0
    assert find_quantum(np.where(times < 50.0, 0.0, values)) != 0.0
    assert find_quantum(np.where(times < 50.0, 0.0, heating(0.05, 0.0, 3)[1])) == 0.0  # a current that is off
