"""The start of a recording: each coil's own, known or not; the room that a rig shares and the one that a day has."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue
from diagnosis.judge.held_out import carried_over, channel_fits
from diagnosis.judge.initial_state import begun
from diagnosis.judge.recording_parameters import recording_parameters
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.coil_network.translate import translate
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.search.cosim_model import CosimModel, free_parameters
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point
from tests.diagnosis.two_heaters import conditions, record, scenario

CELSIUS = 273.15
APART = ["55 degC", "48 degC"]


def network(base, *recordings):
    return CoilNetworkModel(base, recordings, ())


def fitted(model):
    """The model's point after a fit of its parameters."""
    return fit(model, Point(np.zeros(len(model.parameters))), iterations=30).point


def total(model, point, number, field):
    """A field of the network for one recording."""
    return np.broadcast_to(model.network_parameters(point, number).base[field], (2,))


def chi_square(model, point, recordings):
    fits = channel_fits(model, recordings, {"after": point}, is_held_out=True)
    return float(np.mean([f.chi_square["after"] for f in fits]))


@pytest.mark.parametrize("parameters", ["initial_temperature: 21 degC", ""])
def test_two_coils_that_a_recording_starts_apart_cool_apart(tmp_path, parameters):
    base = scenario(tmp_path, parameters=parameters)
    recording = record(base, tmp_path / "one", conditions(APART), 1, conditions(APART))
    model = network(base, recording)
    at = Point(np.zeros(len(model.parameters)))
    np.testing.assert_allclose(total(model, at, 0, "initial_temperature"), np.array([55.0, 48.0]) + CELSIUS)
    first, second = (values[0] for values in model.predict(at, 0))
    assert (first, second) == (pytest.approx(55.0 + CELSIUS), pytest.approx(48.0 + CELSIUS))
    assert chi_square(model, at, [recording]) == pytest.approx(1.0, abs=0.25)


def test_a_start_that_is_unknown_is_found_coil_by_coil(tmp_path):
    base = scenario(tmp_path)
    recording = record(
        base,
        tmp_path / "one",
        conditions(APART),
        1,
        conditions("50 degC"),
        uncertain={"heaters.initial_temperature": "5 K"},
    )
    model = network(base, recording)
    names = [p.name for p in model.parameters if "initial_temperature" in p.name]
    assert names == [
        "initial_temperature",
        "coil[1].initial_temperature of recording 1",
        "coil[2].initial_temperature of recording 1",
    ]
    found = total(model, fitted(model), 0, "initial_temperature") - CELSIUS
    np.testing.assert_allclose(found, [55.0, 48.0], atol=0.2)


def test_one_coil_whose_start_is_unknown_leaves_the_other(tmp_path):
    base = scenario(tmp_path)
    recording = record(
        base,
        tmp_path / "one",
        conditions(["50 degC", "42 degC"]),
        1,
        conditions("50 degC"),
        uncertain={"heaters.initial_temperature[2]": "10 degC"},
    )
    model = network(base, recording)
    own = {p.name: p.deviation for p in model.parameters if "coil" in p.name and "initial" in p.name}
    assert set(own) == {"coil[2].initial_temperature of recording 1"}
    assert own["coil[2].initial_temperature of recording 1"] == pytest.approx(10.0, rel=1e-3)
    number = [p.name for p in model.parameters].index("initial_temperature of recording 1")
    moved = Point(np.eye(len(model.parameters))[number])
    np.testing.assert_array_equal(total(model, moved, 0, "initial_temperature")[1], 50.0 + CELSIUS)
    found = total(model, fitted(model), 0, "initial_temperature") - CELSIUS
    np.testing.assert_allclose(found, [50.0, 42.0], atol=0.2)


def test_a_coil_that_came_from_above_is_found_on_its_cooling_branch(tmp_path):
    base = scenario(tmp_path)
    warm = conditions("50 degC", "45 degC", initial_loop_position=[1.0, 0.0])
    recording = record(
        base,
        tmp_path / "one",
        warm,
        1,
        conditions("50 degC", "45 degC"),
        channels="coil[*].temperature coil[*].stiffness",
        uncertain={"heaters.initial_loop_position": "0.5"},
    )
    model = network(base, recording)
    at = Point(np.zeros(len(model.parameters)))
    assert chi_square(model, at, [recording]) > 1000.0
    point = fitted(model)
    np.testing.assert_allclose(total(model, point, 0, "initial_loop_position"), [1.0, 0.0], atol=0.03)
    assert chi_square(model, point, [recording]) < 1.5


@pytest.mark.parametrize(
    ("name", "given", "problem"),
    [
        ("heaters.initial_temperature[3]", "1 K", "there are 2 coils"),
        ("heaters.initial_temperature", "0 K", "not positive"),
        ("heaters.initial_temperature", "1 W", "W"),
        ("heaters.density", "1 kg/m^3", "cannot be estimated"),
    ],
)
def test_a_doubt_that_cannot_be_is_one_error(tmp_path, name, given, problem):
    base = scenario(tmp_path)
    recording = record(base, tmp_path / "one", {}, 1, uncertain={name: given})
    with pytest.raises(InputError, match=problem):
        network(base, recording)


def test_milli_kelvin_are_no_kelvin(tmp_path):
    base = scenario(tmp_path)
    recording = record(base, tmp_path / "one", {}, 1, uncertain={"room.temperature": "500 mK"})
    stated = [p.deviation for p in network(base, recording).parameters if "ambient" in p.name]
    assert np.hypot(*stated) == pytest.approx(0.5)


def rooms(tmp_path, *truth, said="21 degC", starts="21 degC", **keys):
    """Recordings of rooms that all say the same."""
    base = scenario(tmp_path)
    return base, [
        record(base, tmp_path / f"day_{n}", conditions(starts, room), n, conditions("21 degC", said), **keys)
        for n, room in enumerate(truth)
    ]


def test_a_thermometer_that_is_off_every_day_is_known_on_the_next(tmp_path):
    """Room and start 0.4 K above what is read, three days: two are fitted, the third is predicted."""
    base, days = rooms(tmp_path, *["21.4 degC"] * 3, starts="21.4 degC")
    training, judge = network(base, *days[:2]), network(base, days[2])
    point = fitted(training)
    carried = carried_over(point, training, judge)
    forgotten = Point(np.zeros(len(judge.parameters)))
    before, after = (chi_square(judge, p, days[2:]) for p in (forgotten, carried))
    assert before > 10.0
    # two days put 2/3 of what both have into what is shared: (1 - 2/3)^2 of the misfit stays
    assert after - 1.0 == pytest.approx((before - 1.0) / 9.0, rel=0.35)
    assert [judge.parameters[i].name for i in recording_parameters(judge, training)] == [
        "ambient_offset of recording 1",
        "initial_temperature of recording 1",
    ]


def test_the_shares_of_rig_and_day_add_to_what_is_stated(tmp_path):
    base, days = rooms(tmp_path, "21 degC", uncertain={"room.temperature": "1 K"})
    room = {p.name: p.deviation for p in network(base, *days).parameters if "ambient" in p.name}
    assert room == {
        "ambient_offset": pytest.approx(1.0 / np.sqrt(2.0)),
        "ambient_offset of recording 1": pytest.approx(1.0 / np.sqrt(2.0)),
    }


def test_a_room_that_is_another_each_day_is_no_property_of_the_rig(tmp_path):
    base, days = rooms(tmp_path, "21.6 degC", "20.4 degC")
    model = network(base, *days)
    point = fitted(model)
    by_name = {p.name: p.deviation * z for p, z in zip(model.parameters, point.base)}
    assert abs(by_name["ambient_offset"]) < 0.05
    assert by_name["ambient_offset of recording 1"] == pytest.approx(0.6, abs=0.06)
    assert by_name["ambient_offset of recording 2"] == pytest.approx(-0.6, abs=0.06)


def test_two_halves_of_a_day_have_one_room_and_two_starts(tmp_path):
    base, days = rooms(tmp_path, "21.4 degC", "21.4 degC", day="monday")
    names = [p.name for p in network(base, *days).parameters if " of recording " in p.name]
    assert names == [
        "ambient_offset of recording day monday",
        "initial_temperature of recording 1",
        "initial_temperature of recording 2",
    ]


def test_the_room_of_a_day_that_was_fitted_is_known_of_its_other_half(tmp_path):
    base, days = rooms(tmp_path, "22 degC", "22 degC", day="monday")
    _, others = rooms(tmp_path / "other", "22 degC") if (tmp_path / "other").mkdir() is None else (None, [])
    training, judge, stranger = network(base, days[0]), network(base, days[1]), network(base, others[0])
    point = fitted(training)
    whole, half = (float(total(m, carried_over(point, training, m), 0, "ambient_offset")[0]) for m in (judge, stranger))
    assert whole == pytest.approx(1.0, abs=0.1)
    assert half == pytest.approx(0.5, abs=0.1)  # of one day half is expected on another
    assert [judge.parameters[i].name for i in recording_parameters(judge, training)] == [
        "initial_temperature of recording 1"
    ]
    assert len(recording_parameters(stranger, training)) == 2


def test_a_first_stretch_tells_the_start_of_each_coil(tmp_path):
    base = scenario(tmp_path)
    first = record(base, tmp_path / "first", {}, 1)
    second = record(
        base,
        tmp_path / "second",
        conditions(APART),
        2,
        conditions("50 degC"),
        beginning="2 s",
        uncertain={"heaters.initial_temperature": "5 K"},
    )
    training, judge = network(base, first), network(base, second)
    carried = carried_over(fitted(training), training, judge)
    begins, points = begun(judge, training, {"after": carried}, [second])
    found = total(judge, points["after"], 0, "initial_temperature") - CELSIUS
    np.testing.assert_allclose(found, [55.0, 48.0], atol=0.3)
    assert chi_square(begins, points["after"], [second]) < 2.0 < chi_square(judge, carried, [second])


# The same for a model that the co-simulation itself simulates.


def closed(base, *recordings):
    return CosimModel(base, recordings, free_parameters(base, recordings))


@pytest.mark.parametrize("parameters", ["initial_temperature: 22 degC", ""])
def test_starts_that_any_fmu_has_are_unknown_element_by_element(tmp_path, parameters):
    """Where the scenario gives none, the FMU's own start value is the nominal one: 295.15 K."""
    base = scenario(tmp_path, "tcp_muscle", parameters)
    recording = record(
        base,
        tmp_path / "one",
        conditions(["25 degC", "20 degC"]),
        1,
        conditions(room="22 degC"),
        uncertain={"heaters.initial_temperature": "3 K"},
    )
    model = closed(base, recording)
    assert [p.name for p in model.parameters] == [
        "offset of heaters.initial_temperature",
        "offset of heaters.initial_temperature[1] of recording 1",
        "offset of heaters.initial_temperature[2] of recording 1",
    ]
    assert np.hypot(*[p.deviation for p in model.parameters[:2]]) == pytest.approx(3.0)
    point = Point(np.array([1.0, 0.5, -0.25]))
    changed = model.scenario_at(point, 0).components["heaters"].parameters["initial_temperature"]
    moves = np.array([p.deviation * z for p, z in zip(model.parameters, point.base)])
    np.testing.assert_allclose([v.to("K") for v in changed], 295.15 + moves[0] + moves[1:], rtol=1e-12)


def test_what_recordings_share_needs_no_runs_of_its_own(tmp_path):
    base = scenario(tmp_path, "tcp_muscle")
    given = {"room.temperature": "1 K", "heaters.initial_temperature": "2 K"}
    days = [record(base, tmp_path / f"day_{n}", {}, n, uncertain=given) for n in range(2)]
    model = closed(base, *days)
    point = Point(np.linspace(-0.5, 0.5, len(model.parameters)))
    jacobian = model.base_jacobian(point)
    assert model.runs == 2 * (1 + 3)  # of each recording: at the point, with another room, with two other starts
    for column in (0, [p.name for p in model.parameters].index("offset of heaters.initial_temperature")):
        step = 0.01 * (np.arange(len(model.parameters)) == column)
        high, low = model.residuals([Point(point.base + step), Point(point.base - step)])
        np.testing.assert_allclose(jacobian[:, column], (high - low) / 0.02, atol=1e-5)


def test_the_room_that_a_rig_shares_is_carried_by_any_model(tmp_path):
    base = scenario(tmp_path, "tcp_muscle")
    truth, said = conditions("21 degC", "21.4 degC"), conditions("21 degC", "21 degC")
    days = [
        record(base, tmp_path / f"day_{n}", truth, n, said, uncertain={"room.temperature": "1 K"}) for n in range(3)
    ]
    training, judge = closed(base, *days[:2]), closed(base, days[2])
    carried = carried_over(fitted(training), training, judge)
    shift = judge.changes_at(carried, 0).shifts["room"]["temperature"]
    assert shift == pytest.approx(0.4 * 2 / 3, abs=0.03)


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("heaters.initial_temperature[3]", "has 2 elements"),
        ("heaters.muscles[1]", "has no elements"),
        ("heaters.nothing", "no such number"),
        ("oven.initial_temperature", "no such number"),
    ],
)
def test_a_doubt_about_nothing_is_one_error(tmp_path, name, problem):
    base = scenario(tmp_path, "tcp_muscle")
    recording = record(base, tmp_path / "one", {}, 1, uncertain={name: "1 K"})
    with pytest.raises(InputError, match=problem):
        closed(base, recording)


def test_an_actuator_that_takes_its_size_from_its_neighbours_has_its_starts_too(tmp_path):
    text = """
title: Three muscles in a string
time: {stop: 2 s, macro_step: 100 ms, output_step: 200 ms, checkpoint_step: 1 s}
components:
  supply: {kind: programme, outputs: {voltage: {unit: V, constant: 1 V}}}
  circuit: {kind: ngspice, strings: [3], start: {resistance: 1.15 ohm}}
  room: {kind: programme, outputs: {temperature: {unit: K, points: [[0 s, 21 degC], [1 s, 22 degC]]}}}
  muscles: {kind: actuator, fmu: tcp_muscle, electrical: circuit, ambient: room}
connections: [supply.voltage -> circuit.supply_voltage]
"""
    (tmp_path / "scenario.yaml").write_text(text)
    base = load_scenario(tmp_path / "scenario.yaml")
    recording = record(
        base,
        tmp_path / "one",
        {},
        1,
        channels="coil[*].temperature",
        uncertain={"muscles.initial_temperature[3]": "2 K", "room.temperature": "0.5 degC"},
    )
    model = closed(base, recording)
    point = Point(np.array([1.0 if "[3]" in p.name else 0.0 for p in model.parameters]))
    changed = model.scenario_at(Point(point.base + 0.5), 0).components
    starts = [v.to("degC") for v in changed["muscles"].parameters["initial_temperature"]]
    np.testing.assert_allclose(starts, [22.0, 22.0, 25.0])
    rooms = [v.to("degC") for _, v in changed["room"].outputs["temperature"].points]
    np.testing.assert_allclose(rooms, np.array([21.0, 22.0]) + np.sqrt(0.5) * 0.5, rtol=1e-12)  # two halves of variance


def test_an_amended_scenario_has_what_every_day_has_and_no_day_of_its_own(tmp_path):
    base = scenario(tmp_path, "tcp_muscle")
    given = {"room.temperature": "1 K", "heaters.initial_temperature": "2 K"}
    days = [
        record(base, tmp_path / f"day_{n}", {}, n, conditions("30 degC", "25 degC"), uncertain=given) for n in range(2)
    ]
    model = ClosedLoopModel(base, days)
    z = [1.0 if " of recording " not in p.name else 5.0 for p in model.parameters]
    path = model.amend(base, Point(np.array(z)), tmp_path / "amended")
    written = load_scenario(path).components
    room = written["room"].outputs["temperature"].constant.to("degC")
    assert room == pytest.approx(21.0 + 1.0 / np.sqrt(2.0))
    start = written["heaters"].parameters["initial_temperature"].to("degC")
    assert start == pytest.approx(21.0 + 0.3 / np.sqrt(2.0))


def test_a_network_hears_a_single_coil_by_its_name_in_fmi_2():
    base = load_scenario("hanging_contraction")
    coils = base.components["actuator"]
    own = {**coils.parameters, "initial_temperature[2]": PhysicalValue(48.0, "degC")}
    second = coils.model_copy(update={"fmi": 2, "parameters": own})
    found = translate(base.model_copy(update={"components": {**base.components, "actuator": second}}))
    starts = np.asarray(found.parameters.base["initial_temperature"]) - CELSIUS
    np.testing.assert_allclose(starts, np.where(np.arange(36) == 1, 48.0, 22.0))
