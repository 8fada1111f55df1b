"""Rolling shutters: readings at the time of their picture, what is said where none is stated; and other zooms."""

import numpy as np
import pytest
import yaml

from chainmail.camera.camera_file import CameraFile
from chainmail.camera.measure import measure
from chainmail.camera.opencv import opencv
from chainmail.camera.render import Motion
from chainmail.camera.rendered import write_video
from chainmail.camera.rig import load_rig
from chainmail.camera.shutter import at_one_time, largest_shift, line_delays
from chainmail.camera.tracks import GAP, SEEN, Tracks
from cosim.unit.errors import InputError
from tests.camera.fabrics import swaying
from tests.camera.test_track import SMALL

READOUT = 0.03


def course(times, phase=0.0):
    """Two coordinates that swing with 3 Hz by 5 mm, at 0.1 m/s at most, shape (..., 2) [m]."""
    return 5e-3 * np.stack([np.sin(6 * np.pi * times + phase), np.cos(6 * np.pi * times)], axis=-1)


def tracks_of(places, times, noise=1e-5):
    shape = places.shape[:2]
    covariance = np.broadcast_to(noise**2 * np.eye(2), (*shape, 2, 2)).copy()
    return Tracks(times, places, covariance, np.ones(shape), np.full(shape, SEEN), np.zeros(len(times)))


def test_lines_are_late_below_the_middle_and_early_above():
    delays = line_delays(np.array([0.0, 49.5, 99.0]), 100, 0.02)
    assert delays == pytest.approx([-0.0099, 0.0, 0.0099])
    assert line_delays(np.array([0.0]), 100, -0.02)[0] == pytest.approx(0.0099)


def test_places_are_those_at_the_time_of_the_picture():
    times, late = np.arange(40) / 30.0, np.array([-0.012, 0.0, 0.015])
    read = np.stack([course(times + d) for d in late], axis=1)
    found = at_one_time(tracks_of(read, times), np.tile(late, (40, 1)))
    off = np.abs(found.places - course(times)[:, None])
    before = np.abs(read - course(times)[:, None])
    assert before[:, 2].max() > 1.2e-3
    assert off[2:-2].max() < 0.1e-3
    # What the cubic leaves is covered by what it differs by from the parabola.
    assert np.mean(off[:, ::2] < 1.96 * found.deviation[:, ::2]) >= 0.95
    assert np.array_equal(found.places[:, 1], read[:, 1])  # the middle of the picture stays as it was read


def test_a_reading_without_others_nearby_is_a_gap():
    times = np.arange(30) / 30.0
    tracks = tracks_of(course(times)[:, None], times)
    is_gap = np.ones((30, 1), dtype=bool)
    is_gap[[3, 15, 16, 17], 0] = False
    found = at_one_time(tracks.without(is_gap), np.full((30, 1), 0.01))
    assert np.flatnonzero(found.state[:, 0] != GAP).tolist() == [15, 16, 17]
    assert np.isnan(found.places[3, 0]).all()


@pytest.mark.parametrize("rate", [24.0, 60.0, 240.0])
def test_a_shift_is_that_of_a_motion_and_not_of_noise(rate):
    times = np.arange(round(2 * rate)) / rate
    noise = 1e-5 * np.random.default_rng(0).standard_normal((len(times), 6, 2))
    assert largest_shift(tracks_of(noise, times), 0.02) < 0.7e-5
    drift = noise + np.array([0.1, 0.0]) * times[:, None, None]
    assert largest_shift(tracks_of(drift, times), 0.02) == pytest.approx(1e-3, rel=0.02)
    assert largest_shift(tracks_of(noise[:1], times[:1]), 0.02) == 0.0


def rolled(motion, height, scale, centre):
    """The motion that a shutter at once would see as one that rolls sees the given one."""
    grid = np.linspace(motion.times[0], motion.times[-1], 721)
    places = np.stack([np.interp(grid, motion.times, c) for c in motion.places.reshape(len(motion.times), -1).T])
    places = places.T.reshape(len(grid), *motion.places.shape[1:])
    seen = places.copy()
    for _ in range(5):  # the line depends on the place, and the place on the time of the line
        lines = (height - 1) / 2.0 - (seen[..., 1] - centre) / scale
        delays = READOUT * ((lines + 0.5) / height - 0.5)
        for marker in range(seen.shape[1]):
            for axis in range(2):
                seen[:, marker, axis] = np.interp(grid + delays[:, marker], grid, places[:, marker, axis])
    return Motion(grid, seen)


@pytest.fixture(scope="module")
def rolling(tmp_path_factory):
    folder = tmp_path_factory.mktemp("rolling")
    spec = {**SMALL, "begin": "30 ms", "end": "1.45 s"}
    camera = folder / "camera.yaml"
    camera.write_text(yaml.safe_dump(spec))
    file = CameraFile.model_validate(spec)
    motion = swaying(low=-4.0, high=9.0)
    seen = rolled(motion, file.height, file.scale.to("m"), file.centre[1].to("m"))
    write_video(folder, file, camera, seen, 5, "a phone")
    return folder, motion


def tracked(folder, **clock):
    rig = yaml.safe_load((folder / "rig.yaml").read_text())
    rig["clock"].update(clock)
    file = folder / f"rig_{len(clock)}.yaml"
    file.write_text(yaml.safe_dump(rig))
    return measure(folder / "frames", load_rig(file), file)


def errors(found, motion):
    true = np.stack(
        [np.interp(found.tracks.times, motion.times, c) for c in motion.places.reshape(len(motion.times), -1).T], axis=1
    ).reshape(found.tracks.places.shape)
    read = found.tracks.state != GAP
    off = (found.tracks.places - true)[read]
    return np.sqrt(np.mean(off**2)), np.mean(np.abs(off) < 1.96 * found.tracks.deviation[read])


def test_a_stated_readout_is_undone(rolling):
    folder, motion = rolling
    plain, told = tracked(folder), tracked(folder, readout=f"{READOUT} s")
    before, after = errors(plain, motion), errors(told, motion)
    assert before[0] > 4 * after[0]
    assert after[0] < 0.06e-3
    assert after[1] > 0.9


def test_what_a_rolling_shutter_would_shift_is_said_where_none_is_stated(rolling):
    folder, _ = rolling
    said = [n for n in tracked(folder).notes if n.startswith("shutter: ")]
    assert len(said) == 1
    assert "clock.readout" in said[0]
    assert not [n for n in tracked(folder, readout="30 ms").notes if n.startswith("shutter: ")]


def test_nothing_is_said_of_shutters_where_nothing_moves(tmp_path):
    motion = swaying()
    still = Motion(motion.times, np.repeat(motion.places[:1], len(motion.times), axis=0))
    camera = tmp_path / "camera.yaml"
    camera.write_text(yaml.safe_dump(SMALL))
    write_video(tmp_path, CameraFile.model_validate(SMALL), camera, still, 5, "at rest")
    assert not [n for n in tracked(tmp_path).notes if n.startswith("shutter: ")]


def test_a_readout_longer_than_a_frame_is_refused(rolling):
    with pytest.raises(InputError, match="readout"):
        tracked(rolling[0], readout="1 s")


@pytest.mark.parametrize("zoom", [0.85, 1.15])
def test_another_zoom_is_set_beside_the_rig(rolling, tmp_path, zoom):
    cv2, folder = opencv(), rolling[0]
    (tmp_path / "frames").mkdir()
    for file in sorted((folder / "frames").iterdir()):
        picture = cv2.imread(str(file))
        height, width = picture.shape[:2]
        turn = np.array([[zoom, 0.0, (1 - zoom) * width / 2], [0.0, zoom, (1 - zoom) * height / 2]])
        large = cv2.warpAffine(picture, turn, (width, height), flags=cv2.INTER_AREA, borderMode=cv2.BORDER_REPLICATE)
        cv2.imwrite(str(tmp_path / "frames" / file.name), large)
    rig = yaml.safe_load((folder / "rig.yaml").read_text())
    # Of links whose lengths are not known better than by a quarter, so that it is not refused by them.
    rig["markers"]["layout"].update(
        link_length={"least": "24 mm", "most": "42 mm"}, row_pitch={"least": "15 mm", "most": "36 mm"}
    )
    (tmp_path / "rig.yaml").write_text(yaml.safe_dump(rig))
    found = measure(tmp_path / "frames", load_rig(tmp_path / "rig.yaml"), tmp_path / "rig.yaml")
    (said,) = [n for n in found.notes if n.startswith("markers: ")]
    percent = round(100 * abs(zoom - 1))
    assert f"too {'large' if zoom > 1 else 'small'} by " in said
    assert abs(int(said.split(" by ")[1].split(" %")[0]) - percent) <= 3


def test_a_size_as_stated_says_nothing_of_zoom(rolling):
    (said,) = [n for n in tracked(rolling[0]).notes if n.startswith("markers: ")]
    assert "zoom" not in said
