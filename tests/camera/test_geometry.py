"""Lens, plane, circle and curvature against what is known exactly, or against an independent way."""

import numpy as np
import pytest

from chainmail.camera.camera_file import CameraFile
from chainmail.camera.circle import fit_circle
from chainmail.camera.curvature import curvature_deviation, curvatures, largest_curvature
from chainmail.camera.lens import Lens
from chainmail.camera.pinhole import Pinhole
from chainmail.camera.plane import plane_of_points, plane_of_scale
from chainmail.camera.sight import Sight
from tests.camera.fabrics import markers

LENS = Lens((1200.0, 1190.0), (318.0, 243.0), (-0.28, 0.09, 0.001, -0.0012, 0.004))


def test_undistort_undoes_distort():
    grid = np.stack(np.meshgrid(np.linspace(0, 640, 9), np.linspace(0, 480, 7)), axis=-1).reshape(-1, 2)
    assert LENS.undistort(LENS.distort(grid)) == pytest.approx(grid, abs=1e-4)
    assert np.abs(LENS.distort(grid) - grid).max() > 5.0  # there was something to undo


def test_a_point_beyond_the_lens_is_no_number():
    strong = Lens((100.0, 100.0), (0.0, 0.0), (-0.4, 0.0, 0.0, 0.0, 0.0))
    assert np.isnan(strong.undistort(np.array([[200.0, 0.0]]))).all()


def test_plane_through_points_sees_what_the_camera_projects():
    """`lens` and `plane` undo `pinhole`, which shares no code with them."""
    file = CameraFile.model_validate({"yaw": "15 deg", "pitch": "-8 deg", "distortion": [-0.25, 0.08, 0.001, -0.0008]})
    camera = Pinhole(file)
    lens = Lens((camera.focal, camera.focal), camera.middle, (-0.25, 0.08, 0.001, -0.0008, 0.0))
    fiducials = np.array([[-0.03, 0.06], [0.17, 0.06], [-0.03, -0.08], [0.17, -0.08], [0.07, 0.0]])
    sight = Sight(lens, plane_of_points(lens.undistort(camera.project(fiducials)), fiducials))
    places = markers(6.0)
    assert sight.places(camera.project(places)) == pytest.approx(places, abs=1e-9)
    assert sight.pixels(places) == pytest.approx(camera.project(places), abs=1e-5)
    pixel = sight.pixel_length(camera.project(places))
    assert pixel == pytest.approx(np.full(12, 0.25e-3), rel=0.08)


def test_plane_of_scale_has_its_axes():
    plane = plane_of_scale(0.5e-3, (100.0, 50.0), "left", "up")
    assert plane.places(np.array([[98.0, 46.0]])) == pytest.approx(np.array([[1e-3, 2e-3]]))


@pytest.mark.parametrize("bad", [[[0, 0], [1, 1], [2, 2], [3, 3]], [[0, 0], [1, 0], [2, 0], [0, 1]]])
def test_points_on_one_line_are_refused(bad):
    good = np.array([[0.0, 0.0], [1.0, 0.1], [1.1, 1.0], [0.0, 0.9]])
    with pytest.raises(ValueError, match="one line"):
        plane_of_points(np.array(bad, dtype=float), good)


@pytest.mark.parametrize("hidden", [0.3, 0.5, 0.7])
def test_circle_of_a_marker_that_a_rod_hides_in_part(hidden):
    """The outline of a disc that is cut by a straight edge; the centroid of what is left is far off."""
    radius, centre, random = 3e-3, np.array([0.02, -0.01]), np.random.default_rng(1)
    angle = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    rim = centre + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    edge = centre[0] + radius * (1.0 - 2.0 * hidden)
    seen = rim[rim[:, 0] < edge]
    high = np.sqrt(radius**2 - (edge - centre[0]) ** 2)
    cut = np.stack([np.full(20, edge), np.linspace(-high, high, 20) + centre[1]], axis=1)
    points = np.concatenate([seen, cut]) + 2e-5 * random.standard_normal((len(seen) + 20, 2))
    found = fit_circle(points, radius, 2.5e-4)
    assert found is not None
    assert np.linalg.norm(found.centre - centre) < 4e-5
    assert np.linalg.norm(found.centre - centre) < 4.0 * np.sqrt(np.trace(found.covariance))


def test_no_circle_through_a_sliver():
    angle = np.linspace(-0.3, 0.3, 12)
    assert fit_circle(3e-3 * np.stack([np.cos(angle), np.sin(angle)], axis=1), 3e-3, 2.5e-4) is None


def test_curvature_of_an_arc_is_exact_and_its_deviation_that_of_noise():
    places = markers(8.0)
    centres = (places[0::2] + places[1::2]) / 2.0
    # Chords of 22.5 mm that turn by 8 * 22.5e-3 each: the circle through their ends.
    assert curvatures(centres) == pytest.approx(np.full(4, -2.0 * np.sin(8.0 * 0.0225 / 2.0) / 0.0225), rel=1e-9)
    sigma = 3e-5
    covariance = np.broadcast_to(sigma**2 * np.eye(2), (1, 6, 2, 2))
    stated = curvature_deviation(centres[None], covariance)[0]
    noisy = centres + sigma * np.random.default_rng(2).standard_normal((4000, 6, 2))
    assert stated == pytest.approx(np.std(curvatures(noisy), axis=0), rel=0.05)  # 4000 draws: 1.1 %


def test_largest_curvature_of_a_nearly_flat_fabric_has_no_bias():
    """The plain maximum of four equal noisy values is one deviation too large."""
    places = markers(0.5)
    centres, sigma = (places[0::2] + places[1::2]) / 2.0, 3e-5
    noisy = centres + sigma * np.random.default_rng(3).standard_normal((2000, 6, 2))
    found = largest_curvature(noisy, np.broadcast_to(sigma**2 * np.eye(2), (2000, 6, 2, 2)))
    plain = np.max(np.abs(curvatures(noisy)), axis=1)
    deviation = float(np.mean(found.deviation))
    assert np.mean(plain) - 0.5 > 0.8 * deviation
    assert abs(np.mean(found.values) - 0.5) < 0.35 * deviation


def test_largest_curvature_of_a_fabric_that_snaps_is_that_of_the_picture_and_never_negative():
    """The mean over nine pictures still bends to the other side."""
    bent = np.array([2.0] * 10 + [-2.0, -6.0, -9.0] + [-9.0] * 10)
    centres = np.array([(markers(c)[0::2] + markers(c)[1::2]) / 2.0 for c in bent])
    found = largest_curvature(centres, np.broadcast_to(1e-10 * np.eye(2), (len(bent), 6, 2, 2)))
    assert found.values == pytest.approx(np.max(np.abs(curvatures(centres)), axis=1), rel=1e-12)


def test_a_row_that_is_not_known_is_a_gap():
    centres = np.broadcast_to((markers(5.0)[0::2] + markers(5.0)[1::2]) / 2.0, (20, 6, 2)).copy()
    centres[7, 2] = np.nan
    found = largest_curvature(centres, np.broadcast_to(1e-10 * np.eye(2), (20, 6, 2, 2)))
    assert np.flatnonzero(np.isnan(found.values)).tolist() == [7]
    assert found.row[7] == 0
