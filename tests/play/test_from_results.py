"""A fabric from results: what a real run holds, and what is refused."""

import numpy as np
import pytest
import xarray as xr

from chainmail.play.from_results import fabric_of
from chainmail.play.links import markers, pose_at
from chainmail.play.run_results import run_results
from cosim.assemble import assemble
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError


@pytest.fixture(scope="module")
def results(run_folder):
    return run_results(run_folder)


def test_the_size_of_links_is_that_of_the_design(run_folder, results):
    # The results do not state it: it follows from markers and pitch, so exactly that rounding is the only difference.
    assembly = assemble(load_scenario(run_folder / "scenario.yaml"))
    design = assembly.system.units["fabric"].design
    assembly.system.terminate()
    shape = fabric_of(results, "run").shape
    assert shape.bar_diameter == pytest.approx(design.bar_diameter, rel=1e-9)
    assert shape.outer_width == pytest.approx(design.outer_width, rel=1e-9)
    assert shape.length_offset == pytest.approx(design.length_offset, rel=1e-9)


def test_poses_of_a_real_run_are_taken_over(results):
    found = fabric_of(results, "run")
    np.testing.assert_array_equal(found.position, results["fabric.position"].values)
    assert found.size == "3 rows of 3 links"
    assert found.is_held.tolist() == [True] * 3 + [False] * 6
    assert [q.name for q in found.fields] == ["tension", "extension", "link length"]
    assert {c.plot for c in found.curves} == {"Maximum curvature", "Fabric length"}


def test_markers_follow_from_poses_as_the_simulation_has_them(results):
    found = fabric_of(results, "run")
    for frame in (0, 7, 20):
        pose = pose_at(found, float(found.times[frame]))
        np.testing.assert_allclose(markers(found, pose), results["fabric.marker_position"].values[frame], atol=1e-9)


def test_quaternions_do_not_jump(results):
    turned = results.copy(deep=True)
    turned["fabric.orientation"][5:9] *= -1
    found = fabric_of(turned, "run").orientation
    assert (np.sum(found[1:] * found[:-1], axis=2) > 0.9).all()


def test_frames_are_evenly_spaced_and_the_last_is_kept(results):
    found = fabric_of(results, "run", frames=8)
    np.testing.assert_allclose(found.times, [0, 0.03, 0.06, 0.09, 0.12, 0.15, 0.18, 0.2], atol=1e-12)
    assert "8 of 21 output times are shown" in found.notes


@pytest.mark.parametrize("frames", [2, 3, 4, 5, 7, 10, 20, 21, 100])
def test_no_more_frames_are_shown_than_were_asked_for(results, frames):
    times = fabric_of(results, "run", frames=frames).times
    assert min(frames, 21) / 2.0 < len(times) <= frames
    assert times[-1] == pytest.approx(0.2)


def test_results_without_a_fabric_say_what_is_missing():
    plain = xr.Dataset({"coil.temperature": ("time", [300.0])}, {"time": [0.0]})
    with pytest.raises(InputError, match=r"hold no fabric(.|\n)*remedy: play the run of a scenario"):
        fabric_of(plain, "run")


def test_a_pose_that_is_not_finite_is_named(results):
    broken = results.copy(deep=True)
    broken["fabric.position"][4, 2, 1] = np.nan
    with pytest.raises(InputError, match=r"fabric.position: element 3 is not finite at t = 0.04 s"):
        fabric_of(broken, "run")


def test_a_curve_that_is_not_finite_is_left_out_and_told(results):
    broken = results.copy(deep=True)
    broken["fabric.max_curvature"][3] = np.nan
    broken["fabric.tension"][3, 1] = np.inf
    found = fabric_of(broken, "run")
    assert {c.plot for c in found.curves} == {"Fabric length"}
    assert "not shown, as it is not finite at every time: tension, Maximum curvature" in found.notes


def test_a_fabric_that_has_flown_off_is_refused(results):
    broken = results.copy(deep=True)
    broken["fabric.position"][4:] *= 1e6
    with pytest.raises(InputError, match=r"fabric.position: it reaches .* m, far off any fabric"):
        fabric_of(broken, "run")


def test_results_without_their_coordinates_are_refused(results):
    with pytest.raises(InputError, match="link_row: the links of `fabric` have no such coordinate"):
        fabric_of(results.drop_vars(["link_row"]), "run")


def test_results_that_are_not_woven_any_more_are_refused_where_nothing_is_held(results):
    # all rows moved: as if nothing were tethered
    sway = 1e-3 * np.sin(np.arange(21))[:, None] * np.arange(9)
    moving = results.copy(deep=True)
    moving["fabric.position"][:, :, 0] += sway
    with pytest.raises(InputError, match="its first frame is not a woven fabric"):
        fabric_of(moving.isel(time=slice(5, None)), "run")


def test_results_that_begin_in_the_middle_are_shown_where_a_row_is_held(results):
    whole, cut = fabric_of(results, "run"), fabric_of(results.isel(time=slice(9, None)), "run")
    assert cut.shape.bar_diameter == pytest.approx(whole.shape.bar_diameter, rel=1e-6)


def test_a_run_that_stopped_says_so(results):
    stopped = results.isel(time=slice(0, 9)).assign_attrs(status="interrupted at t = 0.08 s")
    assert "the run did not reach its end: interrupted at t = 0.08 s" in fabric_of(stopped, "run").notes
