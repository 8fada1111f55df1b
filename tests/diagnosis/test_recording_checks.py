"""Hostile values, long tables, and what is said before anything is simulated: channels, units, times, order."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.models.build import model_of
from diagnosis.recording import recording as module
from diagnosis.recording.fits import fitting
from diagnosis.recording.labels import distinct, labels
from diagnosis.recording.recording import load_recording
from diagnosis.recording.together import check_order, prepared
from diagnosis.recording.usage import near_switch, usage
from tests.diagnosis.test_recording import TIMES, channel, folder

WARM = 20.0 + TIMES


def changed(values: np.ndarray, row: int, value: float) -> np.ndarray:
    found = values.copy()
    found[row] = value
    return found


@pytest.mark.parametrize(
    ("table", "text"),
    [
        ({"time": TIMES, "T": changed(WARM, 3, math.inf)}, "the value in row 4 of its column, inf, no sensor reads"),
        ({"time": TIMES, "T": changed(WARM, 3, -1e300)}, "the value in row 4 of its column, -1e+300, no sensor reads"),
        ({"time": changed(TIMES, 5, math.nan), "T": WARM}, "the value in row 6 of its column, 22.5, has no time"),
        ({"time": changed(TIMES, -1, math.inf), "T": WARM}, "the value in row 40 of its column, 39.5, has no time"),
    ],
)
def test_values_that_are_not_finite_are_one_error_each(tmp_path, table, text):
    for keys in ({}, {"inputs": {"drive.power_1": {"column": "T", "unit": "W"}}}):
        with pytest.raises(InputError) as caught:
            load_recording(folder(tmp_path, table, **keys))
        assert text in str(caught.value)


def test_an_infinite_value_may_be_listed_as_invalid_and_a_row_may_be_empty(tmp_path):
    table = {"time": changed(TIMES, 5, math.nan), "T": changed(changed(WARM, 3, math.inf), 5, math.nan)}
    found = load_recording(folder(tmp_path, table, channels=channel(invalid=[math.inf]))).channels[
        "coil[1].temperature"
    ]
    assert found.dropped == {"empty": 1, "invalid": 1}
    np.testing.assert_array_equal(found.times, np.delete(TIMES, [3, 5]))


def test_a_long_table_is_thinned_to_readings_as_they_are(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "MOST_VALUES", 100)
    random = np.random.default_rng(3)
    times = np.arange(0.0, 100.0, 0.1)
    values = np.round(20.0 + 0.3 * random.standard_normal(1000), 2)
    other = np.where(random.random(1000) < 0.2, math.nan, values)
    rare = np.where(np.arange(1000) % 10 == 7, values, math.nan)
    table = {"time": times, "T": values, "gappy": other, "rare": rare}
    channels = channel() | {
        f"coil[{n}].temperature": {"column": c, "unit": "degC"} for n, c in ((2, "gappy"), (3, "rare"))
    }
    found = list(load_recording(folder(tmp_path, table, channels=channels)).channels.values())
    whole, gappy, sparse = found
    np.testing.assert_allclose(whole.times, times[::10], atol=1e-12)
    np.testing.assert_allclose(whole.values, values[::10] + 273.15, rtol=1e-12)  # picked, not averaged
    assert whole.dropped == {"thinned": 900}
    assert whole.deviation == pytest.approx(
        0.3, rel=0.25
    )  # of one reading, as a white noise's mean of ten would not be
    assert len(gappy.times) <= 100
    assert np.mean(np.isin(gappy.times, whole.times)) > 0.7  # the same rows where they can be
    assert len(sparse.times) == 100
    assert "thinned" not in sparse.dropped


@pytest.mark.parametrize(
    ("row", "is_read"), [("3,0,21,5", False), ('3,"21"', True), ("3,21,", True), ("3,21, ,", True), ("3,21,,x", False)]
)
def test_a_row_with_more_values_than_columns_is_refused(tmp_path, row, is_read):
    """With decimal commas `0,5,21,3` under `time,T` was read as 0 s and 5 degC."""
    path = folder(tmp_path, {"time": np.arange(40.0), "T": np.arange(40.0)})
    table = path / "data.csv"
    lines = table.read_text().splitlines()
    table.write_text("\n".join([*lines[:4], row, *lines[5:]]) + "\n")
    if is_read:
        assert len(load_recording(path).channels["coil[1].temperature"].times) == 40
    else:
        with pytest.raises(InputError, match=r"line 5: it has 4 values under 2 column names\n.*with decimal commas"):
            load_recording(path)


def test_channels_of_a_recording_share_the_readings_that_are_compared(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "MOST_READINGS", 250)
    monkeypatch.setattr(module, "LEAST_KEPT", 10)
    times = np.arange(0.0, 100.0, 0.1)
    rare = np.where(np.arange(1000) % 20 == 7, times, math.nan)
    channels = channel() | {f"coil[{n}].temperature": {"column": "T", "unit": "degC"} for n in (2, 3)}
    channels |= {"coil[4].temperature": {"column": "rare", "unit": "degC"}}
    found = load_recording(folder(tmp_path, {"time": times, "T": times, "rare": rare}, channels=channels)).channels
    assert [len(c.times) for c in found.values()] == [63, 63, 63, 50]  # every 16th row; the last has no more
    assert [c.dropped.get("thinned", 0) for c in found.values()] == [937, 937, 937, 0]


def test_an_input_that_changes_in_every_row_is_refused_and_one_that_stays_is_not(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "MOST_CHANGES", 20)
    entry = {"inputs": {"drive.power_1": {"column": "P", "unit": "W"}}}
    path = folder(tmp_path, {"time": TIMES, "T": WARM, "P": 0.01 * TIMES}, **entry)
    with pytest.raises(InputError, match="changes 40 times") as caught:
        load_recording(path)
    assert caught.value.key == "inputs.drive.power_1"
    path = folder(tmp_path, {"time": TIMES, "T": WARM, "P": np.repeat([0.0, 1.0], 20)}, **entry)
    points = scenario_of_points(path)
    assert [(t.to("s"), v.to("W")) for t, v in points] == [(0.0, 0.0), (10.0, 1.0)]


def scenario_of_points(path):
    from diagnosis.recording.conditions import scenario_of

    return scenario_of(load_scenario("tclab"), load_recording(path)).components["drive"].outputs["power_1"].points


def test_a_beginning_must_leave_something_that_judges(tmp_path):
    with pytest.raises(InputError, match="nothing of it is left that judges") as caught:
        load_recording(folder(tmp_path, beginning="30 s"))
    assert caught.value.key == "beginning"
    with pytest.raises(InputError, match="more than 0 s"):
        load_recording(folder(tmp_path, beginning="-1 s"))


# --- held against the scenario

FITS = {
    "tclab": "coil[1].temperature",
    "pendulum": "arm.angle",
    "hanging_coils": "supply.current",
    "spatial_control": "fabric.max_curvature",
}
UNITS = {"temperature": "degC", "angle": "deg", "current": "mA", "max_curvature": "1/m"}


@pytest.mark.parametrize("name", FITS)
@pytest.mark.parametrize(
    ("wrong", "unit", "text"),
    [
        ("coil[700].temperature", "degC", ""),
        ("string[9].current", "A", ""),
        ("nothing.at_all", "A", "no such quantity"),
        ("marker[99].z", "mm", ""),
    ],
)
def test_a_wrong_channel_is_said_before_anything_is_simulated(tmp_path, monkeypatch, name, wrong, unit, text):
    """For every kind of model: heaters and coils (network), pendulum (closed loop), fabric."""
    for there in (
        "cosim.run.run",
        "diagnosis.search.cosim_run.run",
        "diagnosis.models.coil_network.kernel.network.CoilNetwork.run",
        "diagnosis.models.coil_network.kernel.network.load",
    ):
        monkeypatch.setattr(there, lambda *a, **k: pytest.fail("it was simulated or compiled"))
    quantity = FITS[name].rpartition(".")[2]
    channels = {FITS[name]: {"column": "T", "unit": UNITS[quantity]}, wrong: {"column": "T", "unit": unit}}
    recording = load_recording(folder(tmp_path, channels=channels))
    with pytest.raises(InputError) as caught:
        model_of(load_scenario(name), [recording], [])
    assert caught.value.key == f"channels.{wrong}"
    assert text in str(caught.value)


@pytest.mark.parametrize(
    ("name", "unit", "text"),
    [
        ("arm.angular_velocity", "1", None),
        ("arm.kinetic_energy", "W", "is in J: W cannot be converted to J"),
        ("arm.kinetic_energy", "1", "is in J"),
        ("arm.kinetic_energy", "mJ", None),
    ],
)
def test_the_unit_of_any_variable_of_the_scenario_is_checked(tmp_path, name, unit, text):
    if name == "arm.angular_velocity":
        unit = "deg/s"
    recording = load_recording(folder(tmp_path, channels={name: {"column": "T", "unit": unit}}))
    if text is None:
        assert list(fitting(load_scenario("pendulum"), [recording])[0].channels) == [name]
        return
    with pytest.raises(InputError) as caught:
        fitting(load_scenario("pendulum"), [recording])
    assert caught.value.key == f"channels.{name}.unit"
    assert text in str(caught.value)


def test_a_recording_outside_the_simulated_time_is_one_error(tmp_path):
    scenario = load_scenario("tclab")
    late = folder(tmp_path, time={"zero": -700.0}, overrides={"time": {"stop": "600 s"}})
    with pytest.raises(InputError, match=r"from 700 s to 719\.5 s, and 0 s to 600 s is simulated") as caught:
        fitting(scenario, [load_recording(late)])
    assert caught.value.key == "channels.coil[1].temperature"
    early = folder(tmp_path, time={"zero": 100.0})
    with pytest.raises(InputError, match="0 values within the simulated time"):
        fitting(scenario, [load_recording(early)])


def test_readings_outside_the_simulated_time_are_left_out_and_counted(tmp_path):
    path = folder(tmp_path, time={"zero": 3.0}, overrides={"time": {"stop": "10 s"}})
    (found,) = fitting(load_scenario("tclab"), [load_recording(path)])
    own = found.channels["coil[1].temperature"]
    assert (own.times[0], own.times[-1]) == (0.0, 10.0)
    assert own.dropped == {"before start": 6, "after stop": 13}
    assert str(usage(found)[0]) == (
        "coil[1].temperature: 19 of 40 readings are not used: 6 before the simulated time, 13 after the simulated time"
    )
    near = folder(tmp_path, time={"zero": 0.5, "offset_bound": "0.6 s"})  # within what its clock may be off
    assert fitting(load_scenario("tclab"), [load_recording(near)])[0].channels["coil[1].temperature"].dropped == {}


@pytest.mark.parametrize("within", [0, 1])
def test_readings_that_only_a_late_clock_brings_into_the_simulated_time_are_not_enough(tmp_path, within):
    """The other channel is read throughout; of this one the simulation has values for one reading at most."""
    first = TIMES[10] - 0.5 * (TIMES[10] - TIMES[9]) if within == 0 else TIMES[9]
    table = {"time": TIMES, "T": np.where(np.arange(len(TIMES)) < 10, WARM, math.nan), "other": WARM}
    own = {"column": "time", "unit": "s", "zero": float(first), "offset_bound": "1 min"}
    channels = channel(time=own) | {"coil[2].temperature": {"column": "other", "unit": "degC"}}
    recording = load_recording(folder(tmp_path, table, channels=channels))
    with pytest.raises(InputError, match=f"it has {within} values within the simulated time, fewer than 8"):
        fitting(load_scenario("tclab"), [recording])


# --- which readings count


def test_every_reading_that_is_not_used_is_counted_once_with_its_reason(tmp_path):
    values = changed(changed(np.minimum(WARM, 35.0), 2, math.nan), 4, -99.0)
    path = folder(
        tmp_path,
        {"time": TIMES, "T": values},
        begin="1 s",
        end="18 s",
        switch_margin="0.6 s",
        channels=channel(invalid=[-99.0], maximum="35 degC"),
    )
    (found,) = usage(load_recording(path), [10.0, 16.0])
    assert found.unused == {
        "empty": 1,
        "listed as invalid": 1,
        "before `begin`": 2,
        "after `end`": 3,
        "clipped": 7,
        "within 0.6 s of a switch": 3,
    }
    assert found.rows == 40
    assert found.used == 40 - sum(found.unused.values())
    assert str(found).startswith(
        "coil[1].temperature: 17 of 40 readings are not used: 1 empty, 1 listed as invalid, 2 be"
    )
    assert str(usage(load_recording(folder(tmp_path)))[0]) == "coil[1].temperature: all 40 readings are used"


def test_samples_near_a_switch_are_those_of_a_table_of_all_distances():
    random = np.random.default_rng(1)
    times, switches = np.sort(random.uniform(0.0, 100.0, 500)), random.uniform(-5.0, 105.0, 30)
    expected = np.min(np.abs(times[:, None] - switches[None, :]), axis=1) <= 0.4
    np.testing.assert_array_equal(near_switch(times, switches, 0.4), expected)
    assert not near_switch(times, random.uniform(0.0, 100.0, 100), 0.4).any()  # a recorded course jumps all the time
    assert not near_switch(times, [], 0.4).any()


# --- several recordings


def recordings(tmp_path, **keys):
    found = []
    for place in ("a/first", "a/second", "b/first"):
        (tmp_path / place).mkdir(parents=True)
        found.append(load_recording(folder(tmp_path / place, **keys)))
    return found


def test_labels_are_titles_unless_they_are_shared(tmp_path):
    first, second, third = recordings(tmp_path)
    assert labels([first]) == ("a heater",)
    assert labels([first, replace(second, title="other")]) == ("a heater", "other")
    assert labels([first, second]) == ("a heater (first)", "a heater (second)")
    assert labels([first, second, third]) == ("a heater (a/first)", "a heater (second)", "a heater (b/first)")
    assert labels([first, first]) == tuple(
        f"a heater ({'/'.join(first.path.resolve().parts)[1:]}) no. {n}" for n in (1, 2)
    )
    assert [r.title for r in distinct(distinct([first, second]))] == ["a heater (first)", "a heater (second)"]


def test_channels_of_recordings_with_one_title_have_names_of_their_own(tmp_path):
    """In the layouts of network and closed loop, which every table of a diagnosis takes its names from."""
    heaters = recordings(tmp_path)[:2]
    names = model_of(load_scenario("tclab"), heaters, []).layout.names
    assert names == ("coil[1].temperature (a heater (first))", "coil[1].temperature (a heater (second))")
    arms = [load_recording(folder(r.path, channels={"arm.angle": {"column": "T", "unit": "deg"}})) for r in heaters]
    names = model_of(load_scenario("pendulum"), arms, []).layout.names
    assert names == ("arm.angle (a heater (first))", "arm.angle (a heater (second))")


def test_the_order_of_recordings_must_be_possible(tmp_path):
    one, two, three = recordings(tmp_path)
    check_order([one, two, three])
    good = [
        replace(one, order=2, day="A", cycles_before=5.0),
        replace(two, order=1),
        replace(three, order=9, day="B", cycles_before=5.0),
    ]
    check_order(good)
    for wrong, key, text in (
        ([replace(one, order=1), two], "order", "does not state its place"),
        ([replace(one, order=1), replace(two, order=1)], "order", "has the order 1 too"),
        ([replace(one, order=1, cycles_before=7.0), replace(two, order=2)], "cycles_before", "states 0"),
        (
            [replace(one, order=1, day="A"), replace(two, order=2, day="B"), replace(three, order=3, day="A")],
            "day",
            "the day `A` goes on after",
        ),
        (
            [replace(one, order=1, day="A"), replace(two, order=2), replace(three, order=3, day="A")],
            "day",
            "the day `A` goes on after",
        ),
    ):
        with pytest.raises(InputError, match=text) as caught:
            check_order(wrong)
        assert caught.value.key == key


@pytest.mark.parametrize(
    ("keys", "text"),
    [
        ({"order": 0}, "must be at least 1"),
        ({"cycles_before": -1}, "must be at least 0"),
        ({"cycles_before": math.inf}, "finite"),
    ],
)
def test_order_and_cycles_are_checked_as_they_are_read(tmp_path, keys, text):
    with pytest.raises(InputError) as caught:
        load_recording(folder(tmp_path, **keys))
    assert text in str(caught.value)
    assert next(iter(keys)) in caught.value.key


def test_recordings_are_prepared_together(tmp_path):
    one, two, three = recordings(tmp_path)
    training, held_out = prepared(load_scenario("tclab"), [one, two], [three])
    assert [r.title for r in training] == ["a heater (a/first)", "a heater (second)"]
    assert [r.title for r in held_out] == ["a heater (b/first)"]
