"""A fabric's channels are asked what others are; contacts, which scatter from start to start, are no doubt."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from cosim.run import run
from cosim.scenario import load_scenario
from diagnosis.check.beside import STARTS, compare
from diagnosis.check.check import doubts_of
from diagnosis.check.starts import runs_from_starts
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording
from tests.fabric_diagnosis.fabrics import DRAPE, SENSORS, SMALL, with_fabric

pytest.importorskip("pybullet")
DRAPING = [f"marker[{i}].{axis}" for i in range(3, 9) for axis in "xyz"]
WARM = [
    *(f"marker[{i}].{axis}" for i in range(3, 11) for axis in "xyz"),
    *("link[15].length", "link[12].length", "fabric.max_curvature", "fabric.length"),
    *("supply.current", "coil[1,1].temperature"),
]
WITH_CURVATURE = SensorFile.model_validate(
    {
        **SENSORS.model_dump(),
        "channels": {**SENSORS.model_dump()["channels"], "fabric.max_curvature": {"rate": "20 Hz", "noise": "0.2 1/m"}},
    }
)
CASES = {"drape": (DRAPE, DRAPING), "warm": (SMALL, WARM)}


@cache
def simulated(case: str) -> list:
    """Results from the starts that a check takes, the same for all recordings of a case."""
    return runs_from_starts(load_scenario(CASES[case][0]), STARTS)[0]


def recorded(folder, case: str, seed: int) -> Recording:
    path, channels = CASES[case]
    start = {"start_speed": "1 mm/s", "start_number": str(2000 + seed)}
    results = run(with_fabric(load_scenario(path), **start))
    write_recording(folder, read_results(results, channels, WITH_CURVATURE, seed, folder), Notes("fabric"))
    return load_recording(folder)


def doubts(recording: Recording, case: str, monkeypatch):
    monkeypatch.setattr("diagnosis.check.beside.runs_from_starts", lambda scenario, starts: (simulated(case), ""))
    return doubts_of([compare(load_scenario(CASES[case][0]), recording)])


@pytest.fixture(scope="module", params=sorted(CASES))
def rig(request, tmp_path_factory):
    return request.param, recorded(tmp_path_factory.mktemp("rig") / "own", request.param, 1)


def changed(recording: Recording, change) -> Recording:
    """The recording with other values: `change` maps a channel's name and values to values."""
    channels = {n: replace(c, values=change(n, c.values)) for n, c in recording.channels.items()}
    return replace(recording, channels=channels)


@pytest.mark.parametrize("seed", range(2, 6))
@pytest.mark.parametrize("case", sorted(CASES))
def test_a_fabric_from_another_start_raises_no_doubt(case, seed, tmp_path, monkeypatch):
    found = doubts(recorded(tmp_path / "own", case, seed), case, monkeypatch)
    assert [str((d.kind, d.subject, d.statement)) for d in found if d.kind != "still"] == []


def test_pixels_for_metres_are_told(rig, monkeypatch):
    case, own = rig
    pixels = changed(own, lambda n, v: 3700.0 * v if n.startswith("marker") else v)
    found = [d for d in doubts(pixels, case, monkeypatch) if d.is_serious]
    assert {d.kind for d in found} == {"unit"}


def test_a_scale_that_is_too_large_is_told(rig, monkeypatch):
    case, own = rig
    scaled = changed(own, lambda n, v: 3.7 * v if n.startswith("marker") else v)
    found = [d for d in doubts(scaled, case, monkeypatch) if d.is_serious]
    assert [d.kind for d in found] == ["unit"]
    assert "pixels" in found[0].remedy
    assert any(f"{ratio} times" in found[0].statement for ratio in (3.69, 3.7, 3.71))  # noise and contacts: 0.3 %


def test_millimetres_for_metres_are_told(rig, monkeypatch):
    case, own = rig
    found = doubts(changed(own, lambda n, v: 1000.0 * v if n.startswith("marker") else v), case, monkeypatch)
    serious = [d for d in found if d.is_serious]
    assert {d.kind for d in serious} == {"unit"}


def test_two_exchanged_markers_are_told(rig, monkeypatch):
    case, own = rig
    first, second = "marker[3]", "marker[7]"
    names = {f"{a}.{x}": f"{b}.{x}" for a, b in ((first, second), (second, first)) for x in "xyz"}
    exchanged = replace(
        own,
        channels={n: replace(c, values=own.channels[names.get(n, n)].values) for n, c in own.channels.items()},
    )
    found = [d for d in doubts(exchanged, case, monkeypatch) if d.is_serious]
    assert {d.kind for d in found} == {"swapped"}
    assert all(first in d.subject and second in d.subject for d in found)


@pytest.mark.parametrize("axis", ["y"])
def test_an_axis_of_the_other_sign_is_told(rig, axis, monkeypatch):
    case, own = rig
    turned = changed(own, lambda n, v: -v if n.startswith("marker") and n.endswith(axis) else v)
    found = [d for d in doubts(turned, case, monkeypatch) if d.is_serious]
    assert [d.kind for d in found] == ["sign"]
    assert f"along {axis}" in found[0].subject


def test_heights_of_the_other_sign_are_told(rig, monkeypatch):
    case, own = rig
    turned = changed(own, lambda n, v: -v if n.startswith("marker") and n.endswith("z") else v)
    found = [d for d in doubts(turned, case, monkeypatch) if d.is_serious]
    assert {d.kind for d in found} == {"sign"}


def test_exchanged_axes_are_told(rig, monkeypatch):
    case, own = rig

    def of(name: str) -> str:
        stem, _, axis = name.rpartition(".")
        return f"{stem}.{ {'y': 'x', 'x': 'y'}.get(axis, axis) }" if name.startswith("marker") else name

    exchanged = replace(
        own, channels={n: replace(c, values=own.channels[of(n)].values) for n, c in own.channels.items()}
    )
    found = [d for d in doubts(exchanged, case, monkeypatch) if d.is_serious]
    assert found[0].kind == "swapped"
    assert "along x, y" in found[0].subject
