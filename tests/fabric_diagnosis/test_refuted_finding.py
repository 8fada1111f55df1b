"""A finding of a fabric that other readings reject ends in an answer, also when it is resumed."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from cosim.compute.cache import Cache
from cosim.run import run
from cosim.scenario import Scenario, load_scenario, scenario_folder
from cosim.unit.quantity import PhysicalValue
from diagnosis.candidates.registry import catalogue
from diagnosis.command import diagnose
from diagnosis.models.build import model_of
from diagnosis.models.fabric.model import FabricModel
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording
from tests.fabric_diagnosis.fabrics import DRAPE, laws_but, shortened, with_fabric

#: More samples than a channel has bins, so that neither can be taken for the other.
SENSORS = SensorFile.model_validate({"default": {"rate": "200 Hz", "noise": "0.1 mm", "unit": "m"}})
CHANNELS = [f"marker[{i}].{axis}" for i in (5, 6) for axis in "yz"]
#: All but a lean of the stand: few simulations do.
WITHOUT = laws_but("tilt")


def tiny() -> Scenario:
    """3 x 2 links that drape from one held row for 0.3 s."""
    whole = shortened(load_scenario(DRAPE), 0.3)
    fabric = whole.components["fabric"]
    coarse = fabric.solver.model_copy(update={"iterations": 10})
    one = fabric.tether.model_copy(update={"rows": 1})
    fabric = fabric.model_copy(update={"rows": 3, "tether": one, "solver": coarse})
    time = whole.time.model_copy(update={"output_step": PhysicalValue(10.0, "ms")})
    return whole.model_copy(update={"components": {**whole.components, "fabric": fabric}, "time": time})


def recorded(folder: Path, seed: int, **truth: str) -> Path:
    """A recording of it, from a start of its own, with other numbers than the scenario's."""
    start = {"start_speed": "1 mm/s", "start_number": str(1000 + seed)}
    results = run(with_fabric(tiny(), **start, **truth))
    write_recording(folder, read_results(results, CHANNELS, SENSORS, seed, folder), Notes(folder.name))
    return folder


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A scenario, a recording of a stand that leans, and one of a stand that leans the other way."""
    folder = tmp_path_factory.mktemp("fabric")
    scenario = folder / "tiny.yaml"
    scenario.write_text(tiny().to_yaml(True), encoding="utf-8")
    shutil.copytree(scenario_folder() / "parameter_sets", folder / "parameter_sets")
    return (scenario, recorded(folder / "monday", 1, tilt="0.3 rad"), recorded(folder / "tuesday", 2, tilt="-0.3 rad"))


def answer(out: Path) -> dict:
    return json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))


def test_what_held_out_readings_reject_is_suggested_and_not_accepted_and_so_when_resumed(files, tmp_path):
    scenario, monday, tuesday = files
    out = tmp_path / "answer"
    given = {
        "level": 0.05,
        "seed": 1,
        "jobs": 1,
        "cluster": None,
        "without": WITHOUT,
        "limit": None,
        "brief": False,
        "despite_doubts": True,
    }
    diagnose(str(scenario), [monday], out=out, held_out=[tuesday], resume=False, **given)
    found = answer(out)
    assert [f["effect"] for f in found["findings"]] == ["tilt"]
    assert not found["findings"][0]["is_accepted"]
    # Contacts differ between processors: by itself, or with what was fitted beside it, the law predicts worse.
    why = " ".join(found["findings"][0]["doubts"])
    assert "-2 log likelihood rises" in why or "are predicted worse than by the scenario as it is" in why
    made = Cache(out / "simulations").count()
    assert made > 10
    again = tmp_path / "again"
    shutil.copytree(out / "simulations", again / "simulations")
    diagnose(str(scenario), [monday], out=again, held_out=[tuesday], resume=True, **given)
    assert Cache(again / "simulations").count() == made  # every simulation was read
    for key in ("verdict", "statement", "findings", "fit"):
        assert answer(again)[key] == found[key], key


def test_without_held_out_recordings_stretches_of_the_training_judge_a_fabric(files, tmp_path):
    scenario, monday, _ = files
    out = tmp_path / "answer"
    diagnose(
        str(scenario),
        [monday],
        out=out,
        held_out=[],
        level=0.05,
        seed=1,
        jobs=1,
        cluster=None,
        resume=False,
        without=WITHOUT,
        limit=None,
        brief=True,
        despite_doubts=True,
    )
    (found,) = answer(out)["findings"]
    assert found["effect"] == "tilt"
    assert found["parameters"][0]["value"] == pytest.approx(0.3, abs=0.1)


def test_left_out_readings_of_a_fabric_are_those_whose_bins_are_left_out(files):
    scenario, monday, _ = files
    model = model_of(load_scenario(scenario), [load_recording(monday)], catalogue())
    assert isinstance(model, FabricModel)
    bins, readings = len(model.binning.measured()), sum(len(s.samples) for s in model.runs[0].series)
    assert bins < readings
    place = model.residual_of_reading
    assert place.shape == (readings,)
    # The mean of the readings of a bin is what the bin holds.
    values = np.concatenate([s.channel.values for s in model.runs[0].series])
    means = np.bincount(place, values, minlength=bins) / np.bincount(place, minlength=bins)
    np.testing.assert_allclose(means, model.binning.measured(), rtol=1e-12, atol=1e-15)
