"""Cameras that are bumped or held by hand, videos with more pictures than were filmed: undone, or said."""

import numpy as np
import pytest
import yaml
from scipy.interpolate import CubicSpline

from chainmail.camera.camera_file import CameraFile
from chainmail.camera.follow import stopped
from chainmail.camera.frames import Frames
from chainmail.camera.measure import measure
from chainmail.camera.opencv import opencv
from chainmail.camera.page import write_page
from chainmail.camera.rendered import motion_of_table, write_video
from chainmail.camera.rig import load_rig
from chainmail.camera.steady import motion_of, similarity
from chainmail.camera.summary import summary
from chainmail.camera.tracks import GAP, SEEN, Tracks
from cosim.unit.errors import InputError
from tests.camera.fabrics import pictures_of, saved, swaying
from tests.camera.test_track import SMALL

FRAMES = 36


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    folder = tmp_path_factory.mktemp("film")
    given = {**SMALL, "fiducials": True}
    write_video(folder, CameraFile.model_validate(given), folder / "camera.yaml", swaying(), 4, "a test")
    return folder


@pytest.fixture(scope="module")
def truth(film):
    return motion_of_table(film / "truth.csv")


@pytest.fixture(scope="module")
def pictures(film):
    return pictures_of(film / "frames")


def rig_of(film, tmp_path, change=lambda rig: None):
    rig = yaml.safe_load((film / "rig.yaml").read_text())
    change(rig)
    file = tmp_path / "rig.yaml"
    file.write_text(yaml.safe_dump(rig))
    return file


def moved(picture, shift, degrees=0.0, size=1.0):
    """As a camera sees it that is shifted by so many pixels, turned and nearer."""
    high, wide = picture.shape[:2]
    matrix = opencv().getRotationMatrix2D((wide / 2.0, high / 2.0), degrees, size)
    matrix[:, 2] += shift
    return opencv().warpAffine(
        picture, matrix, (wide, high), flags=opencv().INTER_CUBIC, borderMode=opencv().BORDER_REPLICATE
    )


def true_places(truth, times):
    """Places of the markers at these times, shape (times, markers, 2) [m]."""
    return CubicSpline(truth.times, truth.places, axis=0)(times)


def errors(measured, truth):
    return np.linalg.norm(measured.tracks.places - true_places(truth, measured.tracks.times), axis=2)


def test_a_bumped_tripod_is_undone_and_said(film, truth, pictures, tmp_path):
    bumped = [moved(p, (7.0, -4.0), 0.6) if n >= 15 else p for n, p in enumerate(pictures)]
    rig = rig_of(film, tmp_path)
    measured = measure(saved(tmp_path / "bumped", bumped), load_rig(rig), rig)
    assert np.nanmax(errors(measured, truth)) < 0.3e-3  # 8 px are 3.2 mm
    (said,) = (s for s in summary(measured) if s.startswith("camera: "))
    assert "it moves by up to" in said
    assert f"in {FRAMES} of {FRAMES} frames" in said
    write_page(tmp_path / "track.html", measured, load_rig(rig), Frames(tmp_path / "bumped"))  # overlays follow it
    assert "it moves by up to" in (tmp_path / "track.html").read_text()


def test_a_hand_that_holds_the_camera_is_undone(film, truth, pictures, tmp_path):
    held = [
        moved(p, (5.0 * np.sin(0.5 * n), 3.0 * np.cos(0.8 * n)), 0.4 * np.sin(0.3 * n), 1.0 + 0.004 * np.sin(0.2 * n))
        for n, p in enumerate(pictures)
    ]
    rig = rig_of(film, tmp_path)
    measured = measure(saved(tmp_path / "held", held), load_rig(rig), rig)
    off = measured.tracks.places - true_places(truth, measured.tracks.times)
    common = np.nanmedian(off, axis=(0, 1))  # of the picture that the others are brought to
    assert np.nanmax(np.abs(off - common)) < 0.3e-3
    inside = np.abs(off) < 1.96 * measured.tracks.deviation
    assert np.mean(inside[measured.tracks.state == SEEN]) > 0.85


def test_a_camera_that_stands_still_is_left_alone(film, truth, tmp_path):
    rig = rig_of(film, tmp_path)
    measured = measure(film / "frames", load_rig(rig), rig)
    assert measured.motion is not None
    assert not measured.motion.is_moving
    assert any(s.startswith("camera: it stands still within 0.") for s in summary(measured))


def test_pictures_without_fiducials_of_a_moving_camera_are_gaps(film, pictures, tmp_path):
    bumped = [moved(p, (7.0, -4.0)) if n >= 15 else p for n, p in enumerate(pictures)]
    for n in (20, 21):  # somebody stands before all that is blue
        blue = bumped[n][..., 0].astype(int) - bumped[n][..., 2] > 40
        bumped[n] = np.where(blue[..., None], 90, bumped[n]).astype(np.uint8)
    rig = rig_of(film, tmp_path)
    measured = measure(saved(tmp_path / "lost", bumped), load_rig(rig), rig)
    assert (measured.tracks.state[20:22] == GAP).all()
    assert (measured.tracks.state[[10, 30]] == SEEN).all()
    said = " ".join(summary(measured))
    assert "the other 2 are gaps" in said
    assert "frames without any marker: 2" in said


def test_without_coloured_fiducials_nothing_is_claimed(film, tmp_path):
    rig = rig_of(film, tmp_path, lambda r: [r["plane"].pop(k) for k in ("colour", "diameter")])
    said = summary(measure(film / "frames", load_rig(rig), rig))
    assert any(s.startswith("camera: taken to stand still, nothing in the rig shows whether it does") for s in said)


def test_pictures_that_were_doubled_and_compressed_anew_are_gaps(film, truth, pictures, tmp_path):
    rng = np.random.default_rng(3)
    doubled = []
    for picture in pictures:
        again = np.clip(picture.astype(int) + rng.integers(-1, 2, picture.shape), 0, 255).astype(np.uint8)
        doubled += [picture, again]  # no copy bit for bit
    rig = rig_of(film, tmp_path, lambda r: r["clock"].update(rate="48 Hz"))
    measured = measure(saved(tmp_path / "doubled", doubled), load_rig(rig), rig)
    assert any("repeat the one before them while the markers move" in s for s in summary(measured))
    known = np.isfinite(measured.tracks.places).all(axis=(1, 2))
    assert known[::2].mean() > 0.9
    assert known[1::2].mean() < 0.4
    assert np.nanmax(errors(measured, truth)[known]) < 1.5e-3


def course(places):
    count = len(places)
    covariance = np.broadcast_to(1e-9 * np.eye(2), (count, 3, 2, 2))
    spread = np.array([[0.0, 0.0], [0.03, 0.01], [0.06, 0.0]])
    values = np.stack([places, 0.5 * places], axis=1)[:, None] + spread
    return Tracks(
        np.arange(count) / 30.0, values, covariance, np.ones((count, 3)), np.full((count, 3), SEEN), np.ones(count)
    )


def test_what_turns_round_has_not_stopped():
    rng = np.random.default_rng(1)
    turning = 0.01 * np.abs(np.arange(-10, 11)) + 1e-6 * rng.standard_normal(21)
    turning[11:] -= 0.01  # it stays at its turning point for one picture
    assert not stopped(course(turning)).any()
    going = 0.01 * np.floor(np.arange(20) / 2.0) + 1e-6 * rng.standard_normal(20)
    assert stopped(course(going))[3:-2:2].all()
    assert not stopped(course(1e-5 * rng.standard_normal(20))).any()  # at rest


def test_shift_turn_and_size_are_those_that_a_person_gives():
    points = np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]])
    goals = 2.0 * points @ np.array([[0.0, 1.0], [-1.0, 0.0]]) + np.array([3.0, -1.0])  # a quarter turn
    matrix = similarity(points, goals)
    assert np.allclose(matrix, [[0.0, -2.0, 3.0], [2.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
    still = motion_of(np.tile(points * 30.0, (12, 1, 1)), points * 30.0, None)
    assert not still.is_moving
    assert still.left == pytest.approx(0.0, abs=1e-9)


def test_fiducials_that_hardly_any_picture_shows_tell_nothing(film, pictures, tmp_path):
    hidden = list(pictures)
    for n in range(3, FRAMES):
        blue, green, _ = np.moveaxis(hidden[n].astype(int), 2, 0)
        hidden[n] = np.where((blue > green + 3)[..., None], 90, hidden[n]).astype(np.uint8)
    rig = rig_of(film, tmp_path)
    measured = measure(saved(tmp_path / "hidden", hidden), load_rig(rig), rig)
    assert measured.motion is None
    assert any(s.startswith("camera: taken to stand still") for s in summary(measured))
    assert (measured.tracks.state == SEEN).mean() > 0.9


def test_a_rate_beside_that_of_the_file_is_said(film, pictures, tmp_path):
    file = tmp_path / "film.avi"
    writer = opencv().VideoWriter(str(file), opencv().VideoWriter_fourcc(*"MJPG"), 24.0, (480, 360))
    for picture in pictures:
        writer.write(picture)
    writer.release()
    rig = rig_of(film, tmp_path, lambda r: r["clock"].update(rate="60 Hz"))
    said = " ".join(summary(measure(file, load_rig(rig), rig)))
    assert "60 Hz of the rig file, though the video says 24 frames per second" in said
    rig = rig_of(film, tmp_path)
    assert "though the video says" not in " ".join(summary(measure(file, load_rig(rig), rig)))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda r: r["markers"]["layout"].update(rows=5), "it has 6 rows"),
        (
            lambda r: [f.update(at=[f["at"][0], _other(f["at"][1])]) for f in r["plane"]["fiducials"]],
            "z points the other",
        ),
    ],
    ids=["rows", "z"],
)
def test_a_usual_mistake_is_named(film, tmp_path, change, said):
    rig = rig_of(film, tmp_path, change)
    with pytest.raises(InputError) as error:
        measure(film / "frames", load_rig(rig), rig)
    assert said in str(error.value)


def _other(length):
    return length[1:] if length.startswith("-") else f"-{length}"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda r: r["markers"].update(diameter="20 px"), "is a number of pixels"),
        (lambda r: r["markers"].update(diameter=6), "write for example `6 mm`"),
        (lambda r: r["markers"]["layout"].update(along=-90), "write for example `-90 deg`"),
        (lambda r: r["clock"].update(exposure=8), "write for example `8 ms`"),
        (lambda r: r.update(lens={"focal": ["4.2 mm", "4.2 mm"], "centre": [240, 180]}), "it counts in pixels"),
    ],
    ids=["screen", "length", "angle", "time", "focal"],
)
def test_units_that_were_left_out_or_are_none(film, tmp_path, change, said):
    with pytest.raises(InputError) as error:
        load_rig(rig_of(film, tmp_path, change))
    assert said in str(error.value)


def test_a_fiducial_that_is_not_found_is_counted_from_one(film, tmp_path):
    rig = rig_of(film, tmp_path, lambda r: r["plane"]["fiducials"][1].update(pixel=[240, 180]))
    with pytest.raises(InputError) as error:
        measure(film / "frames", load_rig(rig), rig)
    assert "plane.fiducials[2]" in str(error.value)
    assert "whole" in str(error.value)


def of_points(film, truth, tmp_path, at, reach):
    points = [[f"{1e3 * y:.3f} mm", f"{1e3 * z:.3f} mm"] for y, z in true_places(truth, at)]
    layout = {"kind": "points", "points": points, "reach": reach}
    rig = rig_of(film, tmp_path, lambda r: r["markers"].update(layout=layout))
    return measure(film / "frames", load_rig(rig), rig)


def test_points_whose_reaches_overlap_are_told_where_none_goes_farther(film, truth, tmp_path):
    """Neighbours are 20 to 30 mm away."""
    measured = of_points(film, truth, tmp_path, 0.35, "60 mm")
    assert np.mean(measured.tracks.state != GAP) > 0.6
    assert np.nanmax(errors(measured, truth)) < 0.5e-3


def test_points_that_leave_their_reach_are_no_others_and_it_is_said(film, truth, tmp_path):
    with pytest.raises(InputError) as error:
        of_points(film, truth, tmp_path, 0.7, "30 mm")
    assert "and may go farther; since reaches overlap" in str(error.value)
