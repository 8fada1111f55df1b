"""Findings with a size that no real rig has, and laws that the channels cannot tell: of every kind of model."""

from dataclasses import replace

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.candidates.registry import candidate
from diagnosis.judge.plausibility import implausible, unidentified
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.fabric.laws import fabric_laws
from diagnosis.search.pendulum_terms import Arm, arm_of, pendulum_laws, sensor_laws
from diagnosis.search.problem import Term, TermParameter
from tests.locate import rig

ELECTRICAL = "no electrical channel was recorded, so an electrical law cannot be told from heat"


@pytest.fixture(scope="module")
def network_terms():
    wanted = ("ambient_step", "insulation_when_off", "sensor_lag", "backlash", "temperature_dependent_convection")
    model = CoilNetworkModel(load_scenario(rig.SCENARIO), [rig.blank(0)], [candidate(name) for name in wanted])
    return {term.identifier: term for term in reversed(model.terms())}


def test_a_room_does_not_jump_by_26_kelvin(network_terms):
    found = implausible(network_terms["ambient_step"], (26.0, 3.0))
    assert len(found) == 1
    assert found[0].startswith("step_size would have to be 26 K; 5 K is the most that is believed (a window")
    assert implausible(network_terms["ambient_step"], (-26.0, 3.0)) != []
    assert implausible(network_terms["ambient_step"], (-4.9, 3.0)) == []


@pytest.mark.parametrize(
    ("name", "at_bound", "believed"),
    [("insulation_when_off", 0.95, 0.37), ("temperature_dependent_convection", 0.05, 0.012), ("backlash", 5e-3, 1e-3)],
)
def test_a_strength_at_its_bound_is_not_believed(network_terms, name, at_bound, believed):
    assert len(implausible(network_terms[name], (at_bound,))) == 1
    assert implausible(network_terms[name], (believed,)) == []


def test_a_lag_beyond_what_sensors_have_is_not_believed(network_terms):
    (sentence,) = implausible(network_terms["sensor_lag"], (970.0,))
    assert sentence.startswith("lag_time would have to be 970 s; 30 s is the most that is believed (a sheathed")


def test_what_the_recording_states_of_a_lag_stands_above_what_is_believed_of_sensors():
    recording = rig.blank(0)
    slow = {name: replace(channel, lag_bound=60.0) for name, channel in recording.channels.items()}
    model = CoilNetworkModel(
        load_scenario(rig.SCENARIO), [replace(recording, channels=slow)], [candidate("sensor_lag")]
    )
    for term in model.terms():
        assert implausible(term, (59.0,)) == []
        (sentence,) = implausible(term, (970.0,))
        assert sentence.startswith("lag_time would have to be 970 s; 60 s is the most that is believed (the recording")


def test_limits_of_a_network_are_those_of_its_own_coils():
    model = CoilNetworkModel(load_scenario(rig.SCENARIO), [rig.blank(0)], [candidate("slide_friction")])
    term = next(t for t in model.terms() if t.place == "all coils")
    load = float(np.median(model.runs[0].translation.parameters.base["load"]))
    assert term.parameters[0].plausible == pytest.approx(0.5 * load)
    assert term.parameters[0].starts[-1] < 0.5 * load


def test_a_value_just_beyond_its_limit_is_told_with_the_digits_that_show_it():
    parameter = TermParameter("a", "1", 0.0, 1.0, (0.1,), plausible=0.5, plausible_reason="half")
    term = Term("x", "all", "thermal", (parameter,))
    assert implausible(term, (0.50001,)) == ["a would have to be 0.50001; 0.5 is the most that is believed (half)"]
    assert implausible(term, (0.4999,)) == []
    assert implausible(term, (float("nan"),)) != []  # what is not known to be small is not believed
    with pytest.raises(ValueError):
        implausible(term, (0.1, 0.2))


def test_an_arm_of_a_pendulum_has_limits_of_its_own_weight():
    scenario = load_scenario("pendulum")
    arm = arm_of(scenario, "arm")
    assert arm.moment == pytest.approx(0.1 * 9.80665 * 0.115)
    laws = {law.place.term.identifier: law.place.term for law in pendulum_laws("arm", arm=arm)}
    assert implausible(laws["coulomb_friction"], (0.09 * arm.moment,)) == []
    assert len(implausible(laws["coulomb_friction"], (0.5,))) == 1
    assert "0.2 rad; 0.1 rad is the most" in implausible(laws["tilt"], (-0.2,))[0].replace("-", "")
    lag = next(law.place.term for law in sensor_laws("arm", ["angle"]) if law.place.term.identifier == "sensor_lag")
    assert len(implausible(lag, (1.0,))) == 1


def test_a_heavier_arm_may_have_more_friction():
    light, heavy = (
        {law.place.term.identifier: law.place.term.parameters[0] for law in pendulum_laws("arm", arm=arm)}
        for arm in (Arm(0.1, 8.0), Arm(0.4, 8.0))
    )
    assert heavy["coulomb_friction"].plausible == pytest.approx(4.0 * light["coulomb_friction"].plausible)
    assert heavy["coulomb_friction"].starts == pytest.approx(
        [4.0 * v for v in light["coulomb_friction"].starts], rel=0.01
    )
    assert heavy["tilt"] == light["tilt"]


def test_every_law_of_pendulum_and_fabric_has_a_limit_for_its_strength_and_starts_within():
    for law in (*pendulum_laws("arm"), *fabric_laws("fabric")):
        strength = law.place.term.parameters[0]
        assert 0.0 < strength.plausible <= strength.upper, law.name
        assert strength.plausible_reason
        for parameter in law.place.term.parameters:
            assert all(parameter.lower <= v <= parameter.upper for v in parameter.starts), parameter.name
            assert all(abs(v) < parameter.plausible for v in parameter.starts), parameter.name


def test_a_play_as_long_as_a_coil_of_the_fabric_is_not_believed():
    laws = {law.place.term.identifier: law.place.term for law in fabric_laws("fabric")}
    (sentence,) = implausible(laws["backlash"], (5e-3,))
    assert sentence.startswith("coil_play would have to be 0.005 m; 0.003 m is the most that is believed")


def test_no_start_of_the_pendulum_is_a_number_of_the_proving_ground():
    """Spring at rest at 2.8 rad, torque at 9 rad/s, brake 0.25 rad wide, stiction that fades at 0.4 rad/s."""
    laws = {law.place.term.identifier: law.place.term.parameters for law in pendulum_laws("arm")}
    for law, number, value in (
        ("torque_of_position", 1, 2.8),
        ("periodic_torque", 1, 9.0),
        ("torque_of_rate_in_a_band", 1, 0.25),
        ("stiction", 1, 0.4),
    ):
        assert min(abs(s / value - 1.0) for s in laws[law][number].starts) > 0.01, law


def test_a_thermometer_drifts_as_its_connector_warms_and_no_faster():
    """A connector of 10 g is warmed by 1 W at 10 K in a minute; typical readings of a thermometer are 10 K."""
    model = CoilNetworkModel(load_scenario(rig.SCENARIO), [rig.blank(0)], [candidate("sensor_drift")])
    drift = next(t for t in model.terms() if t.place.endswith("temperature"))
    assert implausible(drift, (0.5,)) == []
    assert implausible(drift, (-0.9,)) == []
    (told,) = implausible(drift, (1.5,))
    assert told.startswith("drift would have to be 0.25 K/s; 0.167 K/s is the most that is believed (10 K in a minute")


def test_an_electrical_law_needs_an_electrical_channel():
    droop = candidate("shared_supply_droop")
    assert unidentified(droop, ["temperature"]) == ELECTRICAL
    assert unidentified(droop, ["temperature", "supply_current"]) == ""
    assert unidentified(droop, ["temperature", "power"]) == ""
    assert unidentified(candidate("loose_contact"), ["temperature", "extension"]) == ELECTRICAL


def test_thermal_stiffness_and_mechanical_laws_need_theirs_and_sensors_none():
    assert unidentified(candidate("second_mass"), ["current"]).startswith("no temperature was recorded")
    assert unidentified(candidate("second_mass"), ["temperature"]) == ""
    assert unidentified(candidate("fatigue"), ["temperature"]).startswith(
        "neither stiffness nor extension was recorded"
    )
    assert unidentified(candidate("backlash"), ["stiffness"]).startswith("no extension or length was recorded")
    assert unidentified(candidate("backlash"), ["length"]) == ""
    assert unidentified(candidate("sensor_gain"), ["temperature"]) == ""
    assert unidentified(candidate("unnamed_heat_linear_time"), ["extension"]) != ""
