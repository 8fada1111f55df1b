"""Rendered videos with known truth, through `cosim track`, to a recording."""

import re

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from chainmail.camera.camera_file import CameraFile
from chainmail.camera.frames import Frames
from chainmail.camera.measure import measure
from chainmail.camera.opencv import opencv
from chainmail.camera.page import chosen_frames, write_page
from chainmail.camera.rendered import motion_of_table, write_video
from chainmail.camera.rig import load_rig
from chainmail.camera.tracks import GAP, PART, REBUILT, SEEN
from cosim.cli import app
from cosim.unit.errors import InputError
from diagnosis.recording.recording import load_recording
from tests.camera.fabrics import swaying
from tests.diagnosis.test_report import Page

SMALL = {
    "width": 480,
    "height": 360,
    "scale": "0.4 mm",
    "centre": ["65 mm", "-8 mm"],
    "rate": "24 Hz",
    "exposure": "8 ms",
    "diameter": "6 mm",
}
HARD = {
    "yaw": "10 deg",
    "pitch": "-5 deg",
    "distortion": [-0.25, 0.08, 0.001],
    "fiducials": True,
    "light": 0.65,
    "gradient": 0.4,
    "noise": 2.5,
    "jpeg": 60,
}
ROD = {
    "width": "6 mm",
    "start": ["-30 mm", "0 mm"],
    "stop": ["165 mm", "0 mm"],
    "direction": "80 deg",
    "begin": "0 s",
    "end": "1.5 s",
}


def rendered(folder, **keys):
    camera = folder / "camera.yaml"
    camera.write_text(yaml.safe_dump({**SMALL, **keys}))
    write_video(folder, CameraFile.model_validate({**SMALL, **keys}), camera, swaying(), 4, "a test")
    return folder


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    return rendered(tmp_path_factory.mktemp("plain"))


@pytest.fixture(scope="module")
def crossed(tmp_path_factory):
    return rendered(tmp_path_factory.mktemp("rod"), rods=[ROD])


def tracked(folder):
    return measure(folder / "frames", load_rig(folder / "rig.yaml"), folder / "rig.yaml")


def truth_of(folder):
    return motion_of_table(folder / "truth.csv"), np.genfromtxt(folder / "truth.csv", delimiter=",", skip_header=1)[
        :, -1
    ]


def test_places_and_curvature_of_a_plain_video(plain):
    found, (truth, bent) = tracked(plain), truth_of(plain)
    assert (found.tracks.state == SEEN).all()
    off = found.tracks.places - truth.places
    assert np.sqrt(np.mean(off**2)) < 0.05 * 0.4e-3  # a twentieth of a pixel
    assert 0.9 < np.mean(np.abs(off) < 1.96 * found.tracks.deviation) <= 1.0
    assert np.sqrt(np.mean((found.curvature.values - bent) ** 2)) < 0.10  # the aim for a picture without disturbance


def test_time_of_a_reading_is_the_middle_of_its_exposure(plain):
    """The shift in time that fits the tracks best is far below the 8 ms of the exposure."""
    found, (truth, _) = tracked(plain), truth_of(plain)
    assert found.tracks.times == pytest.approx(truth.times, abs=1e-9)
    speed = np.gradient(truth.places, truth.times, axis=0)
    shift = np.sum((found.tracks.places - truth.places) * speed) / np.sum(speed**2)
    assert abs(shift) < 0.5e-3


def test_lens_lean_light_and_compression(tmp_path):
    folder = rendered(tmp_path, end="0.6 s", **HARD)
    found, (truth, bent) = tracked(folder), truth_of(folder)
    off = found.tracks.places - truth.places
    assert np.sqrt(np.nanmean(off**2)) < 0.12e-3  # a quarter of a pixel
    # Errors of compression stay for many of these 18 frames: few of them are independent.
    assert np.mean(np.abs(off) < 1.96 * found.tracks.deviation) > 0.75
    known = np.isfinite(found.curvature.values)
    assert known.mean() > 0.95
    error = (found.curvature.values - bent)[known]
    assert np.mean(np.abs(error) < 1.96 * found.curvature.deviation[known]) > 0.7


def test_without_its_lens_the_same_video_is_wrong(tmp_path):
    """The test above can fail: what is not undone is seen."""
    folder = rendered(tmp_path, end="0.3 s", **{**HARD, "distortion": [-1.5]})
    rig = yaml.safe_load((folder / "rig.yaml").read_text())
    del rig["lens"]
    (folder / "rig.yaml").write_text(yaml.safe_dump(rig))
    found, (truth, _) = tracked(folder), truth_of(folder)
    assert np.sqrt(np.nanmean((found.tracks.places - truth.places) ** 2)) > 0.12e-3


def test_a_crossing_rod_gives_gaps_and_no_wrong_marker(crossed):
    found, (truth, _) = tracked(crossed), truth_of(crossed)
    state = found.tracks.state
    assert (state == PART).any()
    assert (state == REBUILT).any()
    off = np.linalg.norm(found.tracks.places - truth.places, axis=2)
    read = state != GAP
    assert off[read].max() < 3e-3  # the nearest other marker is 20 mm away
    assert 1.0 - read.mean() < 0.05
    # What is hidden is known less well, and the readings say so.
    whole = np.median(found.tracks.deviation[state == SEEN])
    assert np.median(found.tracks.deviation[state == REBUILT]) > 2.0 * whole
    inside = np.abs(found.tracks.places - truth.places) < 3.0 * found.tracks.deviation
    assert inside[read].mean() > 0.9


def test_command_writes_a_recording_that_is_read(crossed, tmp_path):
    out = tmp_path / "recording"
    given = ["track", str(crossed / "frames"), "--rig", str(crossed / "rig.yaml"), "--out", str(out)]
    result = CliRunner().invoke(app, given)
    assert result.exit_code == 0, result.output
    recording = load_recording(out)
    assert set(recording.channels) == {f"marker[{k + 1}].{a}" for k in range(12) for a in "yz"} | {
        "fabric.max_curvature"
    }
    truth, bent = truth_of(crossed)
    channel = recording.channels["marker[12].z"]
    assert channel.is_deviation_given
    expected = np.interp(channel.times, truth.times, truth.places[:, 11, 1])
    assert np.abs(channel.values - expected).max() < 6.0 * channel.deviation
    curvature = recording.channels["fabric.max_curvature"]
    scatter = np.std(curvature.values - np.interp(curvature.times, truth.times, bent))
    assert scatter < 3.0 * curvature.deviation
    page = (out / "track.html").read_text()
    assert page.count("<img") >= 3
    assert not re.search(r'(src|href)="https?:', page)  # offline
    again = CliRunner().invoke(app, given)
    assert isinstance(again.exception, InputError)
    assert "exists already" in str(again.exception)


def test_a_title_is_escaped_once_on_the_page(crossed, tmp_path):
    title = "<script>&\"' of Monday"
    rig = yaml.safe_load((crossed / "rig.yaml").read_text())
    odd = crossed / "odd.yaml"
    odd.write_text(yaml.safe_dump({**rig, "title": title}))
    found = measure(crossed / "frames", load_rig(odd), odd)
    write_page(tmp_path / "track.html", found, load_rig(odd), Frames(crossed / "frames"))
    page = Page((tmp_path / "track.html").read_text())
    assert not page.open
    assert "script" not in page.names
    assert page.text.count(title) == 2  # of the window and above the page
    assert page.names.count("figure") == len(chosen_frames(found))
    assert page.names.count("svg") == len(chosen_frames(found)) + 4


def test_rendering_depends_on_the_seed_alone(tmp_path):
    cv2, pictures = opencv(), []
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        folder = tmp_path / name
        folder.mkdir()
        camera = CameraFile.model_validate({**SMALL, "end": "0.05 s"})
        assert write_video(folder, camera, folder / "camera.yaml", swaying(), seed, "a test") == 2
        pictures.append(cv2.imread(str(folder / "frames" / "000002.jpg")))
    assert (pictures[0] == pictures[1]).all()
    assert (pictures[0] != pictures[2]).any()


def test_a_video_file_gives_what_its_frames_give(plain, tmp_path):
    cv2 = opencv()
    files = sorted((plain / "frames").iterdir())[:20]
    writer = cv2.VideoWriter(str(tmp_path / "video.avi"), cv2.VideoWriter_fourcc(*"MJPG"), 24.0, (480, 360))
    writer.set(cv2.VIDEOWRITER_PROP_QUALITY, 98)
    for file in files:
        writer.write(cv2.imread(str(file)))
    writer.release()
    rig = yaml.safe_load((plain / "rig.yaml").read_text())
    del rig["clock"]["rate"]  # the file's own time stamps
    (tmp_path / "rig.yaml").write_text(yaml.safe_dump(rig))
    found = measure(tmp_path / "video.avi", load_rig(tmp_path / "rig.yaml"), tmp_path / "rig.yaml")
    truth, _ = truth_of(plain)
    assert found.tracks.times == pytest.approx(truth.times[:20], abs=1e-6)
    assert np.abs(found.tracks.places - truth.places[:20]).max() < 0.25e-3
