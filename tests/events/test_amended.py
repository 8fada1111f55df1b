"""The amended scenario is the rig after the last recording; each recording is run with what had set in by then."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from diagnosis.amend.amend import AmendedModel, amend
from diagnosis.amend.free_run import carried, free_run
from diagnosis.candidates.registry import catalogue
from diagnosis.judge.held_out import TOLERANCE
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.recording.recording import Recording
from diagnosis.search.problem import Point, Term
from tests.events import rig

#: Begin of the third recording on the joint axis, and 8 s of it: an end of steps of network and co-simulation [s].
THIRD, INSTANT = 110.0, 8.0


@functools.cache
def recordings() -> tuple[Recording, ...]:
    return tuple(rig.recorded(n) for n in range(3))


@functools.cache
def model() -> CoilNetworkModel:
    return CoilNetworkModel(rig.scenario(), recordings(), catalogue())


def point(*terms: tuple[str, str, tuple[float, ...]]) -> Point:
    known: dict[tuple[str, str], Term] = {(t.identifier, t.place): t for t in model().terms()}
    return Point(np.zeros(len(model().parameters)), {known[i, p]: v for i, p, v in terms})


def component(recording: Recording, amended: AmendedModel, name: str) -> dict[str, Any]:
    found = carried(recording, amended).overrides["components"].get(name, {})
    assert isinstance(found, dict)
    return found


def test_a_contact_that_came_loose_is_loose_in_the_scenario_and_from_its_instant_on_in_its_recording(
    tmp_path: Path,
) -> None:
    found = point(("loose_contact", "string[2]", (1.5, THIRD + INSTANT)))
    amended = amend(rig.scenario(), model(), found, tmp_path)
    loose = {"kind": "contact", "string": 2, "resistance": "1.5 ohm"}
    written = yaml.safe_load(amended.path.read_text())["components"]["circuit"]
    assert written["elements"] == [loose]
    own = [component(r, amended, "circuit").get("elements") for r in recordings()]
    assert own == [[], [], [{**loose, "instant": "8 s"}]]
    assert component(rig.recorded(3), amended, "circuit") == {}  # held out, later: as the scenario has it
    free = free_run(amended, recordings()[2], model().runs[2].times)
    for series, predicted in zip(model().runs[2].series, model().predict(found, 2)):
        difference = (free[series.quantity][series.samples, series.element] - predicted)[series.used]
        away = np.abs(series.times - INSTANT)[series.used] > 0.45  # steps of the network are up to 0.4 s
        assert np.sqrt(np.mean(difference[away] ** 2)) < TOLERANCE * series.channel.deviation, series.channel.name


def test_a_draught_of_one_day_has_the_strength_0_in_the_scenario_and_its_own_in_its_recording(tmp_path: Path) -> None:
    found = point(("draught", "all coils", (0.4, 60.0 + 20.0)), ("ambient_drift", "all coils in recording 3", (0.02,)))
    amended = amend(rig.scenario(), model(), found, tmp_path)
    text = amended.path.read_text()
    assert text.count("it belongs to one day alone: here its strength is 0") == 2
    parameters = yaml.safe_load(text)["components"]["actuator"]["parameters"]
    assert parameters["draught_amount"] == "0"
    assert parameters["ambient_drift_drift"] == "0 K/s"
    own = [component(r, amended, "actuator").get("parameters", {}) for r in (*recordings(), rig.recorded(3))]
    assert [o.get("draught_amount", "0") for o in own] == ["0", "0.4", "0", "0"]
    assert [o.get("ambient_drift_drift", "0 K/s") for o in own] == ["0 K/s", "0 K/s", "0.02 K/s", "0 K/s"]
    assert own[1]["draught_instant"] == "20 s"
    for number in (1, 2):
        free = free_run(amended, recordings()[number], {"temperature": np.array([19.0, 45.0])})["temperature"]
        network = model().network.simulate(
            model().network_parameters(found, number), model().runs[number].inputs, np.array([19.0, 45.0])
        )["temperature"]
        plain = model().network.simulate(
            model().network_parameters(point(), number), model().runs[number].inputs, np.array([19.0, 45.0])
        )["temperature"]
        assert np.abs(network - plain)[1].max() > 0.3
        assert free == pytest.approx(network, abs=0.1)  # macro-steps of 50 ms at up to 10 K/s


def test_cycles_made_before_a_recording_count_in_its_free_run(tmp_path: Path) -> None:
    worn = [rig.recorded(n, cycles_before=10.0 * n) for n in range(2)]
    own = CoilNetworkModel(rig.scenario(), worn, catalogue())
    fatigue = next(t for t in own.terms() if t.identifier == "fatigue" and t.place == "all coils")
    amended = amend(rig.scenario(), own, Point(np.zeros(len(own.parameters)), {fatigue: (0.02,)}), tmp_path)
    assert yaml.safe_load(amended.path.read_text())["components"]["actuator"]["parameters"]["cycles_before"] == "10"
    assert component(worn[0], amended, "actuator")["parameters"] == {"cycles_before": "0"}
    assert "actuator" not in carried(worn[1], amended).overrides["components"]
