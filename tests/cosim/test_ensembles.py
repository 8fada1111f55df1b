"""`cosim run --starts N`: one fabric from several starts, as one result that can be interrupted and resumed."""

from __future__ import annotations

import csv
import json
import os
import signal
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import chainmail.ensemble.one as single
from chainmail.ensemble.combine import combined, spread
from chainmail.ensemble.folder import EnsembleFolder
from chainmail.ensemble.members import member
from chainmail.ensemble.run import run_ensemble
from chainmail.figures.draw import draw_runs, open_run
from chainmail.measures import band, one_start
from chainmail.play.from_results import fabric_of
from cosim.cli import FAILED, INTERRUPTED, WRONG_INPUT, main
from cosim.components import Solver
from cosim.run import run
from cosim.scenario import Scenario, load_scenario
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue

DRAPE = Path(__file__).parents[1] / "fabric_diagnosis" / "drape.yaml"


def tiny(stop=0.2, **solver) -> Scenario:
    """3 x 2 links that drape from one held row."""
    whole = load_scenario(DRAPE)
    fabric = whole.components["fabric"]
    settings = Solver(iterations=10, **solver)
    fabric = fabric.model_copy(
        update={"rows": 3, "tether": fabric.tether.model_copy(update={"rows": 1}), "solver": settings}
    )
    time = whole.time.model_copy(
        update={"stop": PhysicalValue(stop, "s"), "checkpoint_step": PhysicalValue(40.0, "ms")}
    )
    return whole.model_copy(update={"components": {**whole.components, "fabric": fabric}, "time": time})


def ran(path, starts=3, scenario=None, **settings):
    given = {"jobs": 1, "say": lambda text: None, **settings}
    return run_ensemble(scenario or tiny(), EnsembleFolder(path), starts, **given)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """An ensemble of three starts that nothing disturbed."""
    path = tmp_path_factory.mktemp("ensemble") / "out"
    assert ran(path).complete == (1, 2, 3)
    return path


def test_the_first_start_is_the_scenario_as_it_is_and_the_others_differ(whole):
    found, alone = open_run(whole), run(tiny())
    assert dict(found.sizes)["start"] == 3
    curvature = found["fabric.max_curvature"]
    assert curvature.dims == ("time", "start")
    assert found["fabric.position"].dims == ("time", "start", "link", "axis")
    np.testing.assert_array_equal(curvature.sel(start=1), alone["fabric.max_curvature"])
    for other in (2, 3):
        difference = np.abs(found["fabric.position"].sel(start=other) - found["fabric.position"].sel(start=1)).max()
        assert 1e-7 < float(difference) < 3e-3  # 1 mm/s at the start
    # What no start changes is kept once.
    assert found["coil.stiffness"].dims[:1] == ("time",)
    assert "start" not in found["coil.stiffness"].dims


def test_summary_and_series_tell_median_and_band(whole):
    summary = json.loads((whole / "summary.json").read_text())
    assert summary["status"] == "complete"
    assert summary["ensemble"] == {"starts": 3, "complete": [1, 2, 3], "failures": {}}
    told = {(s["variable"], s["moment"]): s for s in summary["spread"]}
    row = told["fabric.max_curvature", "at the end"]
    values = sorted(row["starts"].values())
    assert row["median"] == pytest.approx(values[1], rel=1e-12)
    # Between the ordered values: 5 % of three lies a tenth of the way from the lowest to the middle one.
    assert row["5 %"] == pytest.approx(0.9 * values[0] + 0.1 * values[1], rel=1e-12)
    assert row["95 %"] == pytest.approx(0.9 * values[2] + 0.1 * values[1], rel=1e-12)
    with (whole / "series.csv").open() as file:
        rows = list(csv.DictReader(file))
    found = open_run(whole)["fabric.max_curvature"].isel(time=-1).values
    assert float(rows[-1]["median of fabric.max_curvature [1/m]"]) == pytest.approx(np.median(found), rel=1e-8)
    assert float(rows[-1]["5 % of fabric.max_curvature [1/m]"]) == pytest.approx(np.quantile(found, 0.05), rel=1e-8)


def test_figures_of_an_ensemble_are_drawn_and_show_the_start_nearest_to_the_median(whole):
    drawn = [p.name for p in draw_runs([whole, whole / "starts" / "01"])]
    assert drawn == ["curvature.png", "lengths.png", "side_view.png"]
    found = open_run(whole)
    curvature = found["fabric.max_curvature"].values
    distance = np.sum((curvature - np.median(curvature, axis=1)[:, None]) ** 2, axis=0)
    assert int(one_start(found)["start"]) == 1 + int(np.argmin(distance))


def test_processes_give_what_one_process_gives(whole, tmp_path):
    ran(tmp_path / "out", jobs=2)
    xr.testing.assert_identical(open_run(tmp_path / "out"), open_run(whole))


@contextmanager
def interrupting(title, *settings):
    """Ctrl-C half-way through the second start."""

    def on_progress(progress):
        if title == "start 2" and progress.done * 2 >= progress.total:
            os.kill(os.getpid(), signal.SIGINT)

    yield on_progress


def test_an_interrupted_ensemble_goes_on_to_the_same_result(whole, tmp_path, monkeypatch):
    out = tmp_path / "out"
    with monkeypatch.context() as patched:
        patched.setattr(single, "progress_bar", interrupting)
        outcome = ran(out)
    assert outcome.is_interrupted
    assert outcome.complete == (1,)
    assert not (out / "results.nc").exists()
    assert ran(out, resume=True).complete == (1, 2, 3)
    xr.testing.assert_identical(open_run(out), open_run(whole))
    # More starts are added; those that are there are not made again.
    before = (out / "starts" / "02" / "results.nc").stat().st_mtime_ns
    assert ran(out, 4, resume=True).complete == (1, 2, 3, 4)
    assert (out / "starts" / "02" / "results.nc").stat().st_mtime_ns == before
    assert open_run(out).sizes["start"] == 4
    with pytest.raises(InputError, match="an ensemble of 4 starts, 2 are asked for"):
        ran(out, 2, resume=True)


def test_a_start_that_stops_is_named_and_the_others_remain(tmp_path, monkeypatch):
    def strict_in_the_second(scenario, start):
        found = member(scenario, start)
        if start != 2:
            return found
        fabric = found.components["fabric"]
        solver = fabric.solver.model_copy(update={"penetration_limit": PhysicalValue(1e-4, "mm")})
        changed = {**found.components, "fabric": fabric.model_copy(update={"solver": solver})}
        return found.model_copy(update={"components": changed})

    monkeypatch.setattr(single, "member", strict_in_the_second)
    said: list[str] = []
    outcome = ran(tmp_path / "out", say=said.append)
    assert outcome.complete == (1, 3)
    assert "overlap by" in outcome.failures[2]
    assert [line.split(":")[0] for line in said] == ["start 1 of 3", "start 2 of 3", "start 3 of 3"]
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["status"] == "2 of 3 starts are complete"
    assert "overlap by" in summary["ensemble"]["failures"]["2"]
    assert open_run(tmp_path / "out")["start"].values.tolist() == [1, 3]


def ended(monkeypatch, *arguments):
    monkeypatch.setattr("sys.argv", ["cosim", *map(str, arguments)])
    with pytest.raises(SystemExit) as stopped:
        main()
    return stopped.value.code


def test_the_command_line_runs_refuses_and_reports(tmp_path, monkeypatch, capsys):
    file, out = tmp_path / "tiny.yaml", tmp_path / "out"
    file.write_text(tiny(0.1).to_yaml(True))
    assert not ended(monkeypatch, "run", file, "--out", out, "--starts", 2, "--jobs", 1)
    assert (out / "figures" / "curvature.png").is_file()
    assert ended(monkeypatch, "run", file, "--out", out, "--starts", 2) == WRONG_INPUT
    assert "--resume" in capsys.readouterr().err
    assert not ended(monkeypatch, "run", out, "--resume", "--starts", 3, "--jobs", 1)
    assert open_run(out).sizes["start"] == 3
    assert ended(monkeypatch, "run", "single_coil_heating", "--out", tmp_path / "coil", "--starts", 2) == WRONG_INPUT
    assert "there is no fabric" in capsys.readouterr().err
    bad = tmp_path / "bad.yaml"
    bad.write_text(tiny(0.1, penetration_limit=PhysicalValue(1e-4, "mm")).to_yaml(True))
    assert ended(monkeypatch, "run", bad, "--out", tmp_path / "bad", "--starts", 2, "--jobs", 1) == FAILED
    assert "stopped: start 2: fabric at t =" in capsys.readouterr().err
    monkeypatch.setattr(single, "progress_bar", interrupting)
    assert ended(monkeypatch, "run", file, "--out", tmp_path / "cut", "--starts", 2, "--jobs", 1) == INTERRUPTED
    assert f"cosim run {tmp_path / 'cut'} --resume" in capsys.readouterr().err


def test_set_overwrite_and_format_work_with_starts_and_a_resumed_ensemble_keeps_them(tmp_path, monkeypatch, capsys):
    file, out = tmp_path / "tiny.yaml", tmp_path / "out"
    file.write_text(tiny(0.1).to_yaml(True))
    short = ("--set", "time.stop=80 ms")
    assert not ended(monkeypatch, "run", file, "--out", out, "--starts", 2, "--jobs", 1, *short, "--format", "svg,pdf")
    assert float(open_run(out)["time"][-1]) == pytest.approx(0.08)
    assert sorted(p.suffix for p in (out / "figures").glob("curvature.*")) == [".pdf", ".svg"]
    assert ended(monkeypatch, "run", out, "--resume", "--starts", 3, *short) == WRONG_INPUT
    assert not ended(monkeypatch, "run", out, "--resume", "--starts", 3, "--jobs", 1, "--no-plots")
    found = open_run(out)
    assert (found.sizes["start"], float(found["time"][-1])) == (3, pytest.approx(0.08))
    assert ended(monkeypatch, "run", file, "--out", out) == WRONG_INPUT
    assert "--overwrite" in capsys.readouterr().err
    # A wrong new ensemble leaves the old one; a right one takes its place, and a single run takes that of both.
    wrong = ("--set", "fabric.parameters.colour=1")
    assert ended(monkeypatch, "run", file, "--out", out, "--starts", 2, "--overwrite", *wrong) == WRONG_INPUT
    assert open_run(out).sizes["start"] == 3
    (out / "notes.txt").write_text("mine")
    assert not ended(monkeypatch, "run", file, "--out", out, "--starts", 2, "--jobs", 1, "--overwrite", "--no-plots")
    assert (open_run(out).sizes["start"], float(open_run(out)["time"][-1])) == (2, pytest.approx(0.1))
    assert not (out / "starts" / "03").exists()
    assert not list((out / "figures").iterdir())
    assert not ended(monkeypatch, "run", file, "--out", out, "--overwrite", "--no-plots")
    assert "start" not in open_run(out).dims
    assert not (out / "starts").exists()
    assert (out / "notes.txt").read_text() == "mine"
    assert ended(monkeypatch, "run", out, "--resume") == WRONG_INPUT
    assert "this run is complete" in capsys.readouterr().err  # and no ensemble


def test_what_moves_is_the_start_nearest_to_the_median_and_the_page_says_so(whole):
    found, shown = open_run(whole), fabric_of(open_run(whole), whole)
    nearest = one_start(found)
    np.testing.assert_allclose(shown.position, nearest["fabric.position"], rtol=1e-12)
    assert f"of 3 starts start {int(nearest['start'])} is shown, the nearest to the median curvature" in shown.notes


def test_starts_count_on_from_the_scenarios_own():
    fabric = tiny().components["fabric"]
    given = {"start_speed": PhysicalValue(3.0, "mm/s"), "start_number": PhysicalValue(7.0, "1")}
    own = fabric.model_copy(update={"parameters": given})
    whole = tiny().model_copy(update={"components": {**tiny().components, "fabric": own}})
    assert member(whole, 1) is whole
    found = member(whole, 3).components["fabric"].parameters
    assert (found["start_speed"].to("mm/s"), found["start_number"].number) == (pytest.approx(3.0), 9.0)


def test_bands_and_moments_of_a_made_up_ensemble():
    time = np.linspace(0.0, 4.0, 41)
    voltage = xr.DataArray(np.where(time < 2.0, 0.0, 6.0), dims="time")
    values = {
        s: xr.Dataset(
            {"supply.voltage": voltage, "fabric.max_curvature": ("time", s * np.ones(41))}, coords={"time": time}
        )
        for s in range(1, 22)
    }
    whole = combined(values)
    low, middle, high = band(whole["fabric.max_curvature"])
    assert (float(low[0]), float(middle[0]), float(high[0])) == pytest.approx((2.0, 11.0, 20.0))
    assert [s["moment"] for s in spread(whole)] == ["before the switch at 1.9 s", "at the end"]
