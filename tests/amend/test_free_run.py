"""A fitted point, written out and run by the co-simulation, against what the network predicts at the sensors."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from cosim.run import run
from cosim.scenario import load_scenario
from diagnosis.amend.amend import AmendedModel, amend, amend_like
from diagnosis.amend.changes import CannotAmend, changes_of
from diagnosis.amend.free_run import free_run, free_run_of
from diagnosis.candidates.registry import catalogue
from diagnosis.judge.held_out import TOLERANCE
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording
from diagnosis.search.problem import Point
from tests.amend import bench

#: On the end of a step of network and co-simulation: what comes within a step is spread over it, and the steps differ.
INSTANT = 4.0
RADIANT = ("radiation@all coils", "tilt@all coils")
_SENSORS = SensorFile.model_validate(
    {
        "default": {"rate": "7 Hz"},
        "channels": {
            "coil.temperature": {"unit": "K", "rate": "7 Hz", "noise": "0.2 K", "offset_bound": "0.2 s"},
            "coil.extension": {"rate": "5 Hz", "noise": "0.05 mm"},
            "string.current": {"rate": "9 Hz", "noise": "3 mA"},
            "supply.current": {"rate": "9 Hz", "noise": "5 mA"},
        },
    }
)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    """The scenario's own run, read with noise."""
    folder = tmp_path_factory.mktemp("recording") / "first"
    given = bench.scenario()
    wanted = ["coil[*].temperature", "coil[*].extension", "string[*].current", "supply.current"]
    read = read_results(run(given), wanted, _SENSORS, 1, Path("sensors.yaml"))
    write_recording(folder, read, Notes("first", "", {"time": {"stop": "15 s"}}))
    return load_recording(folder)


@pytest.fixture(scope="module")
def model(recording: Recording) -> CoilNetworkModel:
    return CoilNetworkModel(bench.scenario(), [recording], catalogue())


@pytest.fixture(scope="module")
def plain(model: CoilNetworkModel, tmp_path_factory: pytest.TempPathFactory) -> AmendedModel:
    """The recalibrated scenario; terms of sensors leave its FMUs as they are."""
    return amend(bench.scenario(), model, _point(model), tmp_path_factory.mktemp("plain"))


@pytest.fixture(scope="module")
def radiant(model: CoilNetworkModel, tmp_path_factory: pytest.TempPathFactory) -> AmendedModel:
    """A scenario with radiation and tilt."""
    return amend(bench.scenario(), model, _point(model, *RADIANT), tmp_path_factory.mktemp("radiant"))


def _point(model: CoilNetworkModel, *wanted: str) -> Point:
    """Every parameter off by half a deviation one way or the other, days left alone, and terms at typical strength."""
    z = [0.0 if " of recording " in p.name else 0.5 * (-1.0) ** i for i, p in enumerate(model.parameters)]
    point = Point(np.array(z))
    for name in wanted:
        identifier, _, place = name.partition("@")
        term = next(t for t in model.terms() if t.identifier == identifier and place in ("", t.place))
        values = [INSTANT if p.name == "instant" else p.starts[min(1, len(p.starts) - 1)] for p in term.parameters]
        point = point.plus(term, values)
    return point


def _largest(model: CoilNetworkModel, point: Point, free: dict[str, Any]) -> float:
    """Largest root mean square difference of a channel from the network's prediction, in deviations.

    Within a step of the network (at most 0.4 s) around the instant of a term a flow is the mean over that step, in the
    co-simulation over a shorter one: those samples are left out.
    """
    sizes = []
    has_instant = any(p.name == "instant" for t in point.terms for p in t.parameters)
    for series, predicted in zip(model.runs[0].series, model.predict(point, 0)):
        difference = free[series.quantity][series.samples, series.element] - predicted
        used = series.used & ~(has_instant & (np.abs(series.times - INSTANT) < 0.45))
        sizes.append(np.sqrt(np.mean(difference[used] ** 2)) / series.channel.deviation)
    return float(max(sizes))


@pytest.mark.parametrize(
    "wanted",
    [
        (),
        ("second_mass@all coils",),
        ("temperature_dependent_resistance@all coils", "supply_source_resistance"),
        ("open_coil@coil[1,2]",),
        ("slide_friction@all coils", "sensor_gain@coil[1,1].temperature", "sensor_lag@every extension"),
    ],
    ids=lambda w: ", ".join(w) or "recalibrated",
)
def test_a_free_run_gives_what_the_network_predicts(
    wanted: tuple[str, ...], model: CoilNetworkModel, recording: Recording, tmp_path: Path
) -> None:
    point = _point(model, *wanted)
    amended = amend(bench.scenario(), model, point, tmp_path)
    _gives_what_is_predicted(amended, point, model, recording)


@pytest.mark.parametrize("wanted", ["wrong_identity", "unnamed_value_linear_amperes@coil[2,1].temperature"])
def test_a_free_run_gives_what_the_network_predicts_of_a_sensor(
    wanted: str, model: CoilNetworkModel, plain: AmendedModel, recording: Recording, tmp_path: Path
) -> None:
    point = _point(model, wanted)
    amended = amend_like(plain, changes_of(bench.scenario(), model, point), tmp_path)
    _gives_what_is_predicted(amended, point, model, recording)


def _gives_what_is_predicted(
    amended: AmendedModel, point: Point, model: CoilNetworkModel, recording: Recording
) -> None:
    # Macro-steps of 50 ms against the network's second-order steps: the tolerance that the report states.
    assert _largest(model, point, free_run(amended, recording, model.runs[0].times)) < TOLERANCE
    before = free_run_of(bench.scenario(), recording, model.runs[0].times)
    assert _largest(model, point, before) > 10 * TOLERANCE


def test_a_free_run_tells_a_sensor_the_current_of_its_coil_though_no_current_is_recorded(
    model: CoilNetworkModel, plain: AmendedModel, recording: Recording, tmp_path: Path
) -> None:
    """With and without the term the run is the same: what the sensor adds is the run's own current, by its law."""
    term = "unnamed_value_linear_amperes@coil[2,1].temperature"
    amended = amend_like(plain, changes_of(bench.scenario(), model, _point(model, term)), tmp_path / "on")
    times = model.runs[0].times["temperature"]
    found = free_run(amended, recording, {"temperature": times})["temperature"]
    # clocks of quantities are late each in its own way: here the currents are read by that of the temperatures
    without = free_run(plain, recording, {"temperature": times})["temperature"]
    change = found - without
    assert not change[:, [0, 1, 3]].any()
    sensors = yaml.safe_load((tmp_path / "on" / "sensors.yaml").read_text())["sensors"]
    own = next(s for s in sensors if "channel" in s)
    assert own == {
        "channel": "coil[2,1].temperature",
        "effect": "unnamed_value_linear_amperes",
        "law": "value = truth + a * scale * (I / 0.4)",
        "parameters": {"a": "-0.0316", "scale": "10"},
    }
    late = next((s["parameters"]["clock_offset"] for s in sensors if s.get("quantity") == "temperature"), "0 s")
    moments = times - float(late.split()[0])
    current = free_run(plain, recording, {"current": moments.clip(0.0)})["current"][:, 1]
    own_clock = next((s for s in sensors if s.get("quantity") == "current"), None)
    assert own_clock is None  # so that the currents above are those at the moments asked for
    assert np.abs(change[:, 2]).max() > 0.05
    assert change[:, 2] == pytest.approx(-0.0316 * 10.0 * current / 0.4, abs=1e-12)  # rounding of 300 K


def _under(recording: Recording, components: dict[str, Any]) -> Recording:
    return replace(recording, overrides={**recording.overrides, "components": components})


@pytest.mark.parametrize(
    "components",
    [
        {"supply": {"outputs": {"voltage": {"points": [["0 s", "0 V"], ["2 s", "1.8 V"]]}}}},
        {
            "room": {"outputs": {"temperature": {"constant": "30 degC"}}},
            "actuator": {"parameters": {"initial_temperature": "30 degC"}},
        },
        {"load": {"mass": "150 g"}, "actuator": {"parameters": {"heat_transfer_coefficient": "120 W/(m^2*K)"}}},
    ],
    ids=["programme", "ambient", "what was recalibrated"],
)
def test_the_conditions_of_another_recording_hold_in_the_amended_scenario(
    components: dict[str, Any], model: CoilNetworkModel, radiant: AmendedModel, recording: Recording
) -> None:
    other = _under(recording, components)
    there = CoilNetworkModel(bench.scenario(), [other], catalogue())
    same = {str(t): v for t, v in _point(model, *RADIANT).terms.items()}
    point = _point(there, *RADIANT)  # another rig has other values to start from
    point = Point(point.base, {t: same[str(t)] for t in point.terms})
    free = free_run(radiant, other, there.runs[0].times)
    assert _largest(there, point, free) < TOLERANCE
    assert _largest(model, _point(model, *RADIANT), free) > 10 * TOLERANCE


def test_terms_stand_in_the_scenario_with_units_and_beside_it_for_sensors(
    model: CoilNetworkModel, tmp_path: Path
) -> None:
    point = _point(model, "radiation@coil[2,1]", "sensor_bias@coil[1,1].temperature", "loose_contact@string[2]")
    amend(bench.scenario(), model, point, tmp_path)
    written = yaml.safe_load((tmp_path / "scenario.yaml").read_text())["components"]
    assert written["actuator"]["parameters"]["radiation_emissivity_area"] == ["0 m^2", "0 m^2", "0.00044 m^2", "0 m^2"]
    assert written["circuit"]["elements"] == [
        {"kind": "contact", "string": 2, "resistance": "0.66 ohm"}  # the rig as it is now: it came loose and stays so
    ]
    sensors = yaml.safe_load((tmp_path / "sensors.yaml").read_text())["sensors"]
    assert [(s["channel"], s["effect"]) for s in sensors if "channel" in s] == [
        ("coil[1,1].temperature", "sensor_bias")
    ]
    assert len(written["actuator"]["parameters"]["reference_resistance"]) == 4
    assert load_scenario(tmp_path / "scenario.yaml").title.endswith("(amended)")


def _written(model: CoilNetworkModel, point: Point, folder: Path) -> AmendedModel:
    return amend(bench.scenario(), model, point, folder)


def test_fmus_are_taken_for_the_stage_without_terms(model: CoilNetworkModel, tmp_path: Path) -> None:
    after = _written(model, _point(model, "second_mass@all coils"), tmp_path / "after")
    changes = changes_of(bench.scenario(), model, _point(model))
    without = amend_like(after, changes, tmp_path / "without")
    assert not list((tmp_path / "without").glob("*.fmu"))
    assert without.scenario.components["actuator"].fmu == "../after/amended_actuator_fmi3.fmu"  # type: ignore[union-attr]
    with pytest.raises(CannotAmend, match="radiation is not in the FMUs"):
        amend_like(after, changes_of(bench.scenario(), model, _point(model, "radiation@all coils")), tmp_path / "x")
