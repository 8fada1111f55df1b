"""Pictures without a browser: bodies against closed forms, films as files."""

import importlib.util
import math
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from chainmail.play.camera import VIEWS, Camera, camera, reach_of
from chainmail.play.film import Film, Marks, Point, Track
from chainmail.play.links import bodies, markers, pose_at
from chainmail.play.movie import MovieStyle, moments, write_gif, write_mp4
from chainmail.play.page import ranges_of
from chainmail.play.picture import Painter, Style, pairs
from chainmail.play.raster import Body, draw, empty
from cosim.unit.errors import InputError

from .films import fabric

_WHITE = np.ones(3)


def far_camera(distance=4.0, size=(400, 400)):
    """Looks along -x from afar, y to the right and z up."""
    axes = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    return Camera(np.array([distance, 0.0, 0.0]), axes, size)


def turn(angle):
    """About x."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


@pytest.mark.parametrize("angle", [0.0, 0.4, math.pi / 4])
def test_a_box_covers_the_pixels_of_its_front(angle):
    seen, half = far_camera(), np.array([0.1, 0.5, 0.3])
    layer = empty(seen.size, _WHITE)
    draw(layer, seen, Body(half, False, np.zeros(3), turn(angle), np.array([1.0, 0.0, 0.0])))
    hit = np.isfinite(layer.depth)
    # the front face stands 3.9 m away; the pixels on its edges are the error
    edge = seen.focal / 3.9
    assert np.count_nonzero(hit) == pytest.approx(4 * half[1] * half[2] * edge**2, abs=4 * (half[1] + half[2]) * edge)
    np.testing.assert_allclose(layer.depth[hit], 3.9, atol=1e-12)


def test_a_cylinder_is_seen_as_a_disc_from_its_end_and_as_a_strip_from_its_side():
    seen = far_camera()
    half = np.array([0.2, 0.5, 0.5])
    end = empty(seen.size, _WHITE)
    draw(end, seen, Body(half, True, np.zeros(3), np.eye(3), np.zeros(3)))
    hit = np.isfinite(end.depth)
    edge = seen.focal / 3.8
    assert np.count_nonzero(hit) == pytest.approx(math.pi * 0.25 * edge**2, abs=math.pi * edge)
    np.testing.assert_allclose(end.depth[hit], 3.8, atol=1e-12)

    across = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # its axis along y of the world
    side = empty(seen.size, _WHITE)
    draw(side, seen, Body(half, True, np.zeros(3), across, np.zeros(3)))
    assert side.depth.min() == pytest.approx(3.5, abs=1e-4)  # its nearest line
    rows = np.flatnonzero(np.isfinite(side.depth[:, 200]))
    # rays that touch a circle of radius r at distance D pass at the tangent r / sqrt(D^2 - r^2)
    assert len(rows) == pytest.approx(2 * seen.focal * 0.5 / math.sqrt(16 - 0.25), abs=2)


def test_the_nearer_body_is_seen():
    seen = far_camera()
    layer = empty(seen.size, _WHITE)
    red, blue = np.array([1.0, 0, 0]), np.array([0, 0, 1.0])
    for where, colour in ((0.5, red), (-0.5, blue)):
        draw(layer, seen, Body(np.full(3, 0.2), False, np.array([where, 0.0, 0.0]), np.eye(3), colour))
    assert layer.colour[200, 200, 0] > 0.5
    assert layer.colour[200, 200, 2] == 0


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("size", [(400, 300), (200, 500)])
def test_every_view_holds_every_link_of_every_frame(view, size):
    film = Film((fabric(frames=20),))
    seen = camera(view, reach_of(film), size)
    for time in (0.0, 2.5, 5.0):
        pose = pose_at(film.fabric, time)
        for body in bodies(film.fabric, pose, film.fabric.fields[0], (20, 70)):
            column, row, depth = seen.project(body.middle)
            assert 0 < column < size[0]
            assert 0 < row < size[1]
            assert depth > 0


def test_poses_between_frames_lie_between_them():
    given = fabric(frames=11)
    middle = pose_at(given, 0.25)
    np.testing.assert_allclose(middle.position, (given.position[0] + given.position[1]) / 2, atol=1e-12)
    assert pose_at(given, -0.1) is None
    assert pose_at(given, 5.1) is None


def test_recorded_markers_lie_where_they_were_recorded():
    given = fabric(frames=11)
    simulated = markers(given, pose_at(given, 1.0))
    times = np.linspace(0, 5, 51)
    track = Track(times, np.full(51, simulated[4, 2] + 0.002))
    marks = Marks("camera", (Point("marker", 5, (None, None, track)),))
    ((here, there),) = pairs(given, marks, 1.0)
    np.testing.assert_allclose(here, simulated[4])
    np.testing.assert_allclose(there - here, [0, 0, 0.002], atol=1e-12)


def test_a_gap_of_a_recording_shows_nothing():
    times = np.concatenate([np.arange(0, 1, 0.1), np.arange(2, 3, 0.1)])
    track = Track(times, times)
    assert track.at(1.5) is None
    assert track.at(-0.1) is None
    assert track.at(3.5) is None
    assert track.at(0.45) == pytest.approx(0.45)
    assert track.at(2.0) == pytest.approx(2.0)


def test_a_ghost_is_seen_where_it_is_apart_and_not_where_it_coincides():
    given = replace(fabric(frames=2), is_held=np.zeros(18, dtype=bool))
    style = Style((200, 160), "side", "temperature", ())
    film = Film((given,))
    alone = np.asarray(Painter(film, reach_of(film), ranges_of(film.fabrics), style).at(0.0)).astype(int)
    for shift, least, most in ((0.0, 0, 0), (0.03, 0.02, 1)):
        moved = replace(given, position=given.position - [0.0, 0.0, shift])
        both = Film((given, moved))
        drawn = np.asarray(Painter(both, reach_of(film), ranges_of(film.fabrics), style).at(0.0)).astype(int)
        assert least <= (np.abs(drawn - alone).max(axis=2) > 20).mean() <= most


def test_a_gif_has_a_picture_for_every_moment(tmp_path):
    film = Film((fabric(frames=20), replace(fabric(frames=20, seed=5), title="other")))
    path = tmp_path / "film.gif"
    assert write_gif(film, path, MovieStyle(speed=5.0, width=240, quantity="stiffness")) == 14
    with Image.open(path) as picture:
        assert picture.n_frames == 14  # 5 s at 5 s/s and 12.5 pictures a second, and the last moment
        assert picture.size == (240, 148)
        assert picture.info["duration"] == 80
        first = np.asarray(picture.convert("RGB")).astype(int)
        picture.seek(13)
        last = np.asarray(picture.convert("RGB")).astype(int)
    assert (np.abs(first - last).max(axis=2) > 30).mean() > 0.02  # the fabric has moved
    assert path.stat().st_size < 300_000


def test_without_a_speed_a_film_lasts_12_seconds_at_most():
    given = fabric(frames=20, duration=100.0)
    times = moments(Film((given,)), None, 12.5)
    assert times[-1] == 100.0
    assert len(times) / 12.5 <= 12.1
    np.testing.assert_allclose(np.diff(times)[:-1], 10 / 12.5)


@pytest.mark.parametrize(
    ("style", "told"),
    [
        (MovieStyle(quantity="colour"), "no `colour` of its coils(.|\n)*give one of: temperature, stiffness"),
        (MovieStyle(view="below"), "no view `below`(.|\n)*oblique, side, top, front"),
        (MovieStyle(speed=1e-4), "makes 625000 pictures, more than 5000(.|\n)*larger speed"),
    ],
)
def test_a_choice_that_does_not_exist_is_refused(style, told, tmp_path):
    with pytest.raises(InputError, match=told):
        write_gif(Film((fabric(frames=5),)), tmp_path / "film.gif", style)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(importlib.util.find_spec("imageio_ffmpeg") is None, reason="imageio-ffmpeg is not installed")
def test_an_mp4_can_be_read_back(tmp_path):
    import imageio_ffmpeg

    path = tmp_path / "film.mp4"
    film = Film((fabric(frames=20),))
    count = write_mp4(film, path, MovieStyle(speed=10.0, width=240))
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    read = subprocess.run(command, capture_output=True, check=True)
    assert b"Video: h264" in read.stderr
    assert count == 14
    frames = np.frombuffer(read.stdout, dtype=np.uint8).reshape(count, 148, 240, 3).astype(int)
    style = Style((240, 148), "oblique", "temperature", ("Supply voltage", "Maximum curvature"))
    drawn = np.asarray(Painter(film, reach_of(film), ranges_of(film.fabrics), style).at(5.0)).astype(int)
    assert np.abs(frames[-1] - drawn).mean() < 4  # what H.264 loses, of 255


def test_without_the_package_mp4_names_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "imageio_ffmpeg", None)
    with pytest.raises(InputError, match=r"imageio-ffmpeg, which is not installed(.|\n)*active-chainmail\[video\]"):
        write_mp4(Film((fabric(frames=5),)), tmp_path / "film.mp4", MovieStyle())
