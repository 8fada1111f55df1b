"""Whether an effect does anything: most show at the begin, one of hot coils where they are heated, some never."""

from __future__ import annotations

import numpy as np
import pytest
import yaml

from cosim.scenario import load_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.models.build import model_of
from diagnosis.models.fabric.model import FabricModel
from diagnosis.models.fabric.runs import beginning
from diagnosis.models.fabric.search import SAME
from diagnosis.search.problem import Point
from tests.fabric_diagnosis.fabrics import DRAPE, laws_but, made, shortened

#: When the coils become as stiff as hot ones, half-way through the recording.
HEATED = 0.2
START = 1


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    folder = tmp_path_factory.mktemp("late")
    given = yaml.safe_load(DRAPE.read_text())
    given["components"]["coil"]["outputs"]["stiffness"] = {
        "unit": "N/m",
        "points": [[f"{t} s", f"{k} N/m"] for t, k in ((0.0, 157.1), (HEATED, 157.1), (HEATED + 0.02, 387.0))],
        "interpolation": "linear",
    }
    path = folder / "scenario.yaml"
    path.write_text(yaml.safe_dump(given))
    scenario = shortened(load_scenario(path), 0.4)
    recording = made(folder / "r", 1, [f"marker[{i}].z" for i in (6, 7, 8)], scenario)
    found = model_of(scenario, [recording], catalogue(), without=laws_but("payload", "thermal_contraction", "tilt"))
    assert isinstance(found, FabricModel)
    return found


@pytest.fixture(scope="module")
def points(model):
    laws = {t.identifier: t for t in model.laws()}
    plain = Point(np.zeros(len(model.parameters)))
    return plain, {name: Point(plain.base, {t: t.parameters[0].starts[:1]}) for name, t in laws.items()}


def test_what_shows_at_once_needs_no_whole_run(model, points):
    plain, effects = points
    wanted = ["payload", "tilt", "thermal_contraction"]
    assert model.begins_as_plain([effects[n] for n in wanted], plain, START) == [False, False, True]


def test_what_acts_later_shows_in_a_whole_run(model, points):
    plain, effects = points
    own, late = model.simulated([(plain, START), (effects["thermal_contraction"], START)])
    assert np.abs(own - late).max() > 1e-5


def test_coils_that_stay_cold_contract_never(model, points, tmp_path):
    scenario = shortened(load_scenario(DRAPE), 0.4)
    recording = made(tmp_path / "r", 1, ["marker[8].z"], scenario)
    cold = model_of(scenario, [recording], catalogue(), without=laws_but("thermal_contraction"))
    assert isinstance(cold, FabricModel)
    (law,) = [t for t in cold.laws() if t.identifier == "thermal_contraction"]
    plain = Point(np.zeros(len(cold.parameters)))
    effect = Point(plain.base, {law: law.parameters[0].starts[:1]})
    assert cold.begins_as_plain([effect], plain, START) == [True]
    own, other = cold.simulated([(plain, START), (effect, START)])
    assert np.abs(own - other).max() <= SAME


def test_beginning_is_what_was_read_until_then(model):
    (recording,) = model.mechanical_recordings
    short = beginning(recording, 0.5)
    assert short is not None
    assert short.end == pytest.approx(0.5 * recording.end, abs=0.05)
    for name, channel in short.channels.items():
        whole = recording.channels[name]
        assert np.array_equal(channel.values, whole.values[: len(channel.values)])
        assert len(channel.times) == len(channel.values) == np.sum(whole.times <= short.end)
