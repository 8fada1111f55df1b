"""What a camera does to places, against facts of geometry, and as a law that the search finds."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import yaml

from cosim.scenario import load_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.models.build import model_of
from diagnosis.models.fabric.camera import CAMERA_LAWS, Camera
from diagnosis.models.fabric.mechanical import MechanicalModel
from diagnosis.models.fabric.surface import Surface
from diagnosis.recording.quantity import parse_quantity
from diagnosis.search.problem import Parameter, Point
from diagnosis.search.search import Settings, search
from tests.fabric_diagnosis.fabrics import DRAPE, made
from tests.fabric_diagnosis.test_scatter_and_search import BINS, TERMS, effect

NAMES = ["marker[5].x", "marker[5].y", "marker[5].z", "marker[6].x", "marker[6].y", "marker[6].z"]
LENGTHS = ["fabric.max_curvature", "link[3].length"]


def camera(names, times=2):
    """Channels one after the other, each at the same times."""
    count = len(names)
    channel, time = np.repeat(np.arange(count), times), np.tile(np.arange(times, dtype=float), count)
    return Camera([parse_quantity(n) for n in names], channel, time, [0] * count)


def term(own, identifier, place=""):
    (found,) = [t for t in own.terms if t.identifier == identifier and t.place.endswith(place)]
    return found


def seen(own, values, **sizes):
    """Readings of values, by channel, with `identifier__place` to size."""
    terms = {term(own, *name.split("__")): (size,) for name, size in sizes.items()}
    return own.seen(np.repeat(np.array(values, dtype=float), 2), terms)[::2].tolist()


def test_a_quarter_turn_about_each_axis_takes_the_axes_into_each_other():
    own = camera(NAMES)
    for about, expected in (("x", [1, -3, 2]), ("y", [3, 2, -1]), ("z", [-2, 1, 3])):
        turn = own.seen(
            np.repeat([1.0, 2, 3, 1, 2, 3], 2), {term(own, "turned_camera", f"about {about}"): (math.pi / 2,)}
        )
        np.testing.assert_allclose(turn[::2], 2 * expected, atol=1e-12)


def test_a_scale_makes_places_and_lengths_longer_and_curvature_smaller():
    own = camera([*NAMES, *LENGTHS])
    found = seen(own, [1, 2, 3, 4, 5, 6, 10, 0.03], camera_scale=0.25)
    np.testing.assert_allclose(found, [1.25, 2.5, 3.75, 5, 6.25, 7.5, 8, 0.0375])


def test_an_origin_moves_every_marker_and_no_length_and_a_marker_itself_alone():
    own = camera([*NAMES, *LENGTHS])
    values = [1, 2, 3, 4, 5, 6, 10, 0.03]
    terms = {term(own, "camera_origin", "along z"): (0.5,)}
    np.testing.assert_allclose(own.seen(np.repeat(values, 2), terms)[::2], [1, 2, 3.5, 4, 5, 6.5, 10, 0.03])
    terms = {term(own, "marker_elsewhere", "marker[6].y"): (0.5,)}
    np.testing.assert_allclose(own.seen(np.repeat(values, 2), terms)[::2], [1, 2, 3, 4, 5.5, 6, 10, 0.03])


def test_a_marker_that_sits_elsewhere_is_turned_with_the_camera():
    own = camera(NAMES)
    terms = {
        term(own, "turned_camera", "about x"): (math.pi / 2,),
        term(own, "marker_elsewhere", "marker[5].y"): (1.0,),
    }
    # it sits at y = 3: seen at z = 3
    np.testing.assert_allclose(own.seen(np.repeat([1.0, 2, 3, 1, 2, 3], 2), terms)[::2][:3], [1, -3, 3], atol=1e-12)


def test_axes_that_are_read_at_other_instants_are_interpolated():
    targets = [parse_quantity(n) for n in ("marker[5].y", "marker[5].z", "marker[6].y", "marker[6].z")]
    channel, time = np.array([0, 0, 1, 1, 2, 3]), np.array([0.0, 1.0, 0.5, 2.5, 0.0, 0.0])
    own = Camera(targets, channel, time, [0] * 4)
    values = np.array([0.0, 0.0, 4.0, 8.0, 0.0, 2.0])
    turned = own.seen(values, {term(own, "turned_camera", "about x"): (math.pi / 2,)})
    np.testing.assert_allclose(turned, [-4.0, -5.0, 0.0, 0.0, -2.0, 0.0], atol=1e-12)  # y' = -z, z at 1 s is 5


def test_what_the_channels_cannot_show_is_no_law_of_them():
    assert not camera(["coil[1].extension", "fabric.max_curvature"]).terms
    heights = camera(["marker[5].z", "marker[6].z"])
    assert {(t.identifier, t.place) for t in heights.terms} == {
        ("camera_scale", "camera"),
        ("camera_origin", "camera, along z"),
        ("marker_elsewhere", "marker[5].z"),
        ("marker_elsewhere", "marker[6].z"),
    }
    side = {t.place for t in camera(["marker[5].y", "marker[5].z"]).terms if t.identifier == "turned_camera"}
    assert side == {"camera, about x"}
    assert {t.identifier for t in camera(NAMES).terms} == CAMERA_LAWS


def test_every_law_has_bounds_that_its_starts_lie_within_and_is_of_the_measurement():
    for one, (law, spot) in camera(NAMES).terms.items():
        (size,) = one.parameters
        assert one.unit == "measurement"
        assert size.lower == -size.upper < min(size.starts) < 0.0 < max(size.starts) < size.plausible < size.upper
        assert size.plausible_reason
        assert not law.is_of_a_day
        assert spot.label == one.place


#: Ten heights, as the bins of the search's tests.
HEIGHTS = [parse_quantity(f"marker[{i + 1}].z") for i in range(10)]


def model(measured, ensemble):
    surface = Surface(ensemble.mean(axis=0), np.zeros(1))
    surface.slopes[0] = effect(9, 1e-4)
    for kind, one in enumerate(TERMS):
        surface.add(one, 1.0, ensemble.mean(axis=0) + effect(kind, 1e-3), np.zeros(1))
    own = Camera(HEIGHTS, BINS.channel, BINS.time, [0] * len(HEIGHTS))
    parameters = [Parameter("fabric.friction", "1", 0.5, 0.05)]
    return MechanicalModel(parameters, surface, measured, BINS, ensemble, [str(t) for t in HEIGHTS], own)


def drawn(seed):
    """Nine fabrics whose markers hang at heights of their own."""
    random = np.random.default_rng(seed)
    hangs = np.linspace(0.02, 0.08, 10)[BINS.channel]
    return hangs + 3e-4 * random.standard_normal((9, 10))[:, BINS.channel]


def test_derivatives_are_those_of_the_residuals_beside_a_camera_that_is_off():
    members = drawn(1)
    own = model(members[8], members[:8])
    scale = term(own.camera, "camera_scale")
    point = Point(np.array([0.3]), {scale: (0.1,), TERMS[0]: (0.5,)})
    start = own.residuals([point])[0]
    moved = own.residuals([replace(point, base=point.base + 1e-6)])[0]
    np.testing.assert_allclose(own.base_jacobian(point)[:, 0], (moved - start) / 1e-6, rtol=1e-4, atol=1e-5)
    origin, payload = term(own.camera, "camera_origin"), TERMS[1]
    for one, size in ((origin, 1e-3), (payload, 1.0)):
        expected = (own.residuals([point.plus(one, (size,))])[0] - start) / size
        np.testing.assert_allclose(own.slopes(point, [(one, (size,))])[0], expected, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize(
    ("identifier", "place", "size"), [("camera_scale", "", 0.06), ("marker_elsewhere", "marker[4].z", -2e-3)]
)
def test_the_search_finds_what_the_camera_does_and_not_a_force(identifier, place, size):
    members = drawn(3)
    own = model(members[8], members[:8])
    what = term(own.camera, identifier, place)
    own = model(own.camera.seen(members[8], {what: (size,)}), members[:8])
    outcome = search(own, [*TERMS, *own.camera.terms], Settings())
    assert [(t.identifier, t.place) for t in outcome.best.terms] == [(what.identifier, what.place)]
    assert outcome.best.fit.point.terms[what][0] == pytest.approx(size, abs=1.2e-3 if place else 0.02)


def test_the_search_finds_no_camera_in_scatter():
    found = 0
    for seed in range(20):
        members = drawn(20 + seed)
        own = model(members[8], members[:8])
        found += bool(search(own, [*TERMS, *own.camera.terms], Settings()).best.terms)
    assert found <= 1  # 5 %


def test_a_model_predicts_what_the_camera_sees_and_moves_nothing_by_it(tmp_path):
    channels = [f"marker[{i}].{axis}" for i in (7, 8) for axis in "yz"]
    recording = made(tmp_path / "r", 1, channels, load_scenario(DRAPE))
    found = model_of(load_scenario(DRAPE), [recording], catalogue())
    (turn,) = [t for t in found.terms() if t.identifier == "turned_camera"]
    plain = Point(np.zeros(len(found.parameters)))
    point = plain.plus(turn, (0.1,))
    assert found.fabric_parameters(point, 0) == {}
    y, z, *_ = found.predict(plain, 0)
    seen_y, seen_z, *_ = found.predict(point, 0)
    np.testing.assert_allclose(seen_y, math.cos(0.1) * y - math.sin(0.1) * z, atol=1e-12)
    np.testing.assert_allclose(seen_z, math.sin(0.1) * y + math.cos(0.1) * z, atol=1e-12)
    law, spot = found.where(turn)
    assert (law.name, spot.label) == ("a camera that is turned", "camera, about x")
    amended = found.amend(load_scenario(DRAPE), point, tmp_path / "amended")
    assert "# left out, it changes readings and moves nothing: camera, about x" in amended.read_text()
    assert not yaml.safe_load(amended.read_text())["components"]["fabric"]["parameters"]
