"""Geometry: the weave, its checks, the measures taken of it."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from mechanics.bullet import rotation
from mechanics.curvature import max_curvature
from mechanics.fabric import CLEARANCE, layout
from mechanics.half import half
from mechanics.lattice import calibrate, jammed_weave, taut_jam_ratio, taut_weave
from mechanics.linking import is_hooked
from mechanics.root import root_between
from mechanics.springs import SteelSpring, coil_tension, spring_energy

from .designs import prototype, woven_unit


@pytest.mark.parametrize(("rows", "links"), [(6, 18), (8, 24)])
def test_resolution_counts_links_of_one_orientation(rows, links):
    design = prototype(rows=rows)
    assert design.links == links
    assert len(layout(design).row) == links


def test_a_taut_weave_has_the_longest_pitch():
    d, length = 8.1e-3, 33e-3
    best = minimize_scalar(
        lambda t: -2 * (length * math.cos(t) - d / math.sin(t)),
        bounds=(0.2, 1.3),
        method="bounded",
        options={"xatol": 1e-12},
    )
    weave = taut_weave(length, d)
    assert weave.pitch == pytest.approx(-best.fun, rel=1e-9)
    assert weave.tilt == pytest.approx(best.x, abs=1e-5)
    assert math.sin(weave.tilt) ** 3 / math.cos(weave.tilt) == pytest.approx(d / length, rel=1e-12)


def test_a_jammed_weave_is_the_shortest_that_leaves_no_slack():
    best = minimize_scalar(
        lambda t: (1 + 3 / math.sin(t)) / (2 * math.cos(t)),
        bounds=(0.2, 1.3),
        method="bounded",
        options={"xatol": 1e-12},
    )
    jam = jammed_weave(1.0)
    assert jam.bar_distance == pytest.approx(best.fun, rel=1e-9)
    # Both conditions hold as equalities: the bar rests on the arms, and bars of one layer touch.
    overlap = jam.bar_distance * math.cos(jam.tilt) - jam.pitch / 2
    assert overlap * math.sin(jam.tilt) == pytest.approx(1.0, rel=1e-9)
    assert jam.pitch - overlap == pytest.approx(1.0, rel=1e-9)
    assert jam.bar_distance < taut_jam_ratio()


def test_the_shipped_links_hang_at_the_published_cold_length_and_just_reach_the_jam():
    design = prototype()
    assert 5 * design.cold_weave.pitch == pytest.approx(0.132, abs=0.0003)
    jam = jammed_weave(design.bar_diameter).bar_distance
    assert 0 <= design.bar_distance_hot - jam < 1e-4


def test_calibration_returns_the_pitches_it_was_given():
    found = calibrate(0.132 / 5, 0.115 / 5, 0.033)
    assert jammed_weave(found.bar_diameter).pitch == pytest.approx(0.115 / 5, rel=1e-9)
    assert taut_weave(0.033 + found.length_offset, found.bar_diameter).pitch == pytest.approx(0.132 / 5, rel=1e-9)


WRONG = [
    ({"link_mass": -7e-3}, "link_mass is -0.007"),
    ({"bar_diameter": math.nan}, "bar_diameter is nan"),
    ({"width": 0.030}, "cannot be woven"),
    ({"width": 4 * 8.35e-3}, "leaves no play"),
    ({"bar_diameter": 10e-3}, "cannot be woven"),
    ({"length_hot": 0.034}, "heat contracts links"),
    ({"friction": -0.1}, "friction"),
    ({"restitution": 1.5}, "restitution"),
    ({"rows": 2}, "rows is 2"),
    ({"rows": 6.0}, "rows is 6.0"),
    ({"columns": 1}, "columns is 1"),
    ({"tether_rows": 6}, "leave at least one of the 6 rows free"),
    ({"tether_kind": "nailed"}, "tether_kind"),
    ({"gravity": (0.0, 0.0, math.inf)}, "gravity"),
    ({"steel_stiffness": -1.0}, "steel_stiffness"),
]


@pytest.mark.parametrize(("change", "what"), WRONG)
def test_a_fabric_that_makes_no_sense_is_refused_by_name(change, what):
    with pytest.raises(ValueError, match=what):
        prototype(**change)


@pytest.mark.parametrize(
    ("kind", "tethered"), [("cantilever", 1), ("cantilever", 2), ("cantilever", 3), ("hanging", 1)]
)
@pytest.mark.parametrize("shape", [(6, 2), (8, 2), (5, 4)])
def test_the_woven_start_overlaps_nowhere_and_every_link_is_hooked(kind, tethered, shape):
    design = prototype(rows=shape[0], columns=shape[1], tether_kind=kind, tether_rows=tethered)
    unit = woven_unit(design)
    unit.do_step(0, 500_000)  # Bullet finds contacts when it steps
    assert unit.get("max_penetration") <= 1e-6
    unit.terminate()
    plan = layout(design)
    # Each B link hooks two A links of its row and two of the next; at the last row only its own.
    b_links = design.rows * (design.columns - 1)
    assert len(plan.hooked) == 4 * b_links - 2 * (design.columns - 1)


def test_bars_of_one_layer_never_overlap_in_the_woven_start():
    design = prototype()
    plan = layout(design)
    along = np.stack([np.cos(plan.tilt), np.sin(plan.tilt)], axis=1)
    back = plan.back_bar[:, 1:]
    front = back + plan.bar_distance[:, None] * along
    chain = plan.link_in_row < 2  # seen from the side: every A and every B link once
    bars = np.concatenate([back[chain], front[chain]])
    apart = np.linalg.norm(bars[:, None] - bars[None, :], axis=2) + np.eye(len(bars))
    assert apart.min() >= design.bar_diameter + 0.9 * CLEARANCE


def test_curvature_of_a_circle_and_of_a_line_is_exact():
    angle = np.array([0.1, 0.35, 0.8, 0.9, 1.6])
    circle = 0.05 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    assert max_curvature(circle) == pytest.approx(20.0, rel=1e-12)
    line = np.stack([np.linspace(0, 1, 6), 2 * np.linspace(0, 1, 6)], axis=1)
    assert max_curvature(line) == pytest.approx(0.0, abs=1e-9)


def test_curvature_agrees_with_equation_1_on_a_smooth_curve():
    y = np.linspace(-0.5, 0.5, 801)
    # z = y^2 has curvature 2 / (1 + 4 y^2)^(3/2), largest at 0; three points 1/800 apart err by their square.
    assert max_curvature(np.stack([y, y**2], axis=1)) == pytest.approx(2.0, rel=1e-5)


@pytest.mark.parametrize("points", [np.zeros((2, 2)), np.zeros((4, 3)), np.zeros((4, 2))])
def test_curvature_of_points_that_make_no_curve_is_refused(points):
    with pytest.raises(ValueError, match=r"three points|coincide"):
        max_curvature(points)


def test_mass_and_inertia_of_a_half_agree_with_integration_over_its_volume():
    design = prototype()
    part = half(design)
    n = 60
    grid = (np.arange(n) + 0.5) / n - 0.5
    x, y, z = np.meshgrid(grid * part.bar_length, *2 * [grid * 2 * part.bar_radius], indexing="ij")
    inside = y**2 + z**2 <= part.bar_radius**2
    bar = np.stack([x[inside], y[inside], z[inside]], axis=1)
    weights = [np.full(len(bar), part.bar_length * (2 * part.bar_radius) ** 2 / n**3)]
    points = [bar]
    for side in (-1, 1):
        sx, sy, sz = part.arm_size
        x, y, z = np.meshgrid(grid * sx, grid * sy, grid * sz, indexing="ij")
        points.append(np.stack([(x + side * part.arm_x).ravel(), (y + sy / 2).ravel(), z.ravel()], axis=1))
        weights.append(np.full(n**3, sx * sy * sz / n**3))
    place, mass = np.concatenate(points), np.concatenate(weights)
    mass *= part.mass / mass.sum()
    centre = mass @ place / part.mass
    # A grid of 60 points per edge meets the cylinder's surface within 0.5 %.
    assert centre == pytest.approx([0, part.centre, 0], abs=0.005 * part.arm_size[1])
    off = place - centre
    moments = [mass @ (off[:, b] ** 2 + off[:, c] ** 2) for b, c in ((1, 2), (0, 2), (0, 1))]
    assert part.inertia == pytest.approx(moments, rel=0.005)


def test_frames_are_hooked_when_one_passes_through_the_other_and_not_when_it_lies_beside():
    back = np.array([[0.0, 0.0, 0.0], [0.0, 0.015, 0.01]])
    upright = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]).T  # y axis up, so the frame stands
    flat = np.eye(3)
    distance = np.array([0.03, 0.03])
    pair = np.array([[0, 1]])
    down = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]).T
    hooked = is_hooked(back + np.array([[0, 0, 0], [0.01, 0, 0.005]]), np.stack([flat, down]), distance, 0.012, pair)
    beside = is_hooked(back + np.array([[0, 0, 0], [0.05, 0, 0.005]]), np.stack([flat, down]), distance, 0.012, pair)
    within = is_hooked(back, np.stack([flat, upright]), np.array([0.03, 0.001]), 0.012, pair)
    assert hooked.tolist() == [True]
    assert beside.tolist() == [False]
    assert within.tolist() == [False]


def test_quaternions_turn_like_rotation_matrices():
    angle = 0.7
    about_x = rotation(np.array([[math.sin(angle / 2), 0, 0, math.cos(angle / 2)]]))[0]
    expected = [[1, 0, 0], [0, math.cos(angle), -math.sin(angle)], [0, math.sin(angle), math.cos(angle)]]
    np.testing.assert_allclose(about_x, expected, atol=1e-15)


def test_a_coil_pulls_and_does_not_push_and_energies_are_those_of_springs():
    assert coil_tension(np.array([100.0, 100.0]), np.array([0.01, -0.01])).tolist() == [1.0, 0.0]
    steel = SteelSpring(200.0, 0.05)
    energy = spring_energy(np.array([100.0]), np.array([0.02]), np.array([0.03]), steel)
    assert energy == pytest.approx(0.5 * 100 * 0.02**2 + 0.5 * 200 * 0.02**2, rel=1e-12)


def test_roots_are_those_of_scipy_to_the_last_bit():
    """Fabrics are chaotic: another last bit of the tilt is another course of contacts."""
    random = np.random.default_rng(5)
    for ratio, constant in random.uniform((0.05, -3.0), (0.9, 3.0), (500, 2)):
        for function, lower, upper in (
            (lambda t, r=ratio: math.sin(t) ** 3 - r * math.cos(t), 1e-6, math.pi / 2 - 1e-6),
            (lambda x, c=constant: math.exp(x) - 3.0 * x**3 + c, 1.0, 30.0),
            (lambda x, c=constant: x**5 - 7.0 * x + c, -0.5, 1.1),
        ):
            if function(lower) * function(upper) < 0.0:
                assert root_between(function, lower, upper, 1e-14) == brentq(function, lower, upper, xtol=1e-14)


def test_a_function_without_a_change_of_sign_has_no_root_to_find():
    with pytest.raises(ValueError, match="same sign at 1 and at 2"):
        root_between(lambda x: x, 1.0, 2.0, 1e-14)
    assert root_between(lambda x: x - 1.0, 1.0, 2.0, 1e-14) == 1.0
    assert root_between(lambda x: x - 2.0, 1.0, 2.0, 1e-14) == 2.0
