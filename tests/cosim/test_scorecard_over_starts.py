"""The scorecard of several starts: medians, bands, and what passes."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import chainmail.reproduce.command as reproducing
from chainmail.ensemble.folder import EnsembleFolder
from chainmail.figures.draw import open_run
from chainmail.reproduce.bands import inside, with_bands
from chainmail.reproduce.row import compare, relation
from chainmail.reproduce.scorecard import as_json, as_markdown
from chainmail.reproduce.starts import rows_over_starts, starts_of, together
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from tests.cosim.test_ensembles import tiny


def measured(values, target=10.0, tolerance=1.0):
    return together([compare("S", "length", "10 cm", v, target, "cm", tolerance, "reading") for v in values])


def test_a_number_passes_where_the_band_reaches_into_the_tolerance():
    row = measured([11.0, 12.0, 13.0])
    assert (row.ours, row.band, row.starts) == (12.0, pytest.approx((11.1, 12.9)), 3)
    assert not row.is_met  # the lowest start alone would pass; the band does not
    assert measured([10.0, 12.0, 13.0]).is_met
    assert measured([8.0, 12.0, 30.0]).is_met
    assert not measured([np.nan, 12.0, 10.0]).is_met


def test_a_statement_passes_where_it_holds_in_nearly_every_start():
    def said(misses):
        return together([relation("S", "rigid", "it is", float(i), "1", i >= misses, "seen") for i in range(20)])

    assert said(0).is_met
    assert said(1).is_met
    assert not said(2).is_met


def test_what_no_start_changes_has_no_band():
    row = measured([10.2, 10.2, 10.2])
    assert (row.band, row.starts, row.is_met) == (None, 1, True)


def test_rows_are_made_for_each_start_and_told_with_their_band():
    time = np.arange(3.0)
    ensemble = xr.Dataset(
        {"length": (("time", "start"), np.outer(np.ones(3), [9.0, 10.0, 12.0]))},
        coords={"time": time, "start": [1, 2, 4]},
    )
    other = ensemble.isel(start=[0, 2])
    single = xr.Dataset({"length": ("time", np.full(3, 2.0))}, coords={"time": time})

    def rows_of(runs):
        whole = sum(float(r["length"].mean()) for r in runs.values())
        return [compare("S", "sum", "22 cm", whole, 22.0, "cm", 1.0, "reading")]

    assert starts_of({"a": ensemble, "b": other, "c": single}) == [1, 4]
    (row,) = rows_over_starts({"a": ensemble, "b": other, "c": single}, rows_of)
    assert (row.ours, row.starts) == (23.0, 2)  # 20 and 26
    assert rows_over_starts({"c": single}, rows_of)[0].band is None
    text = as_markdown([row])
    assert "median of 2 starts" in text
    assert "23 (20.3 to 25.7)" in text
    assert json.loads(as_json([row]))["rows"][0]["band"] == pytest.approx([20.3, 25.7])


def test_a_fabric_is_reproduced_from_several_starts_and_more_are_added(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(reproducing, "scenario_of", lambda name: tiny(0.1))
    assert not reproducing.run_one("drape", tmp_path, 2)
    assert open_run(tmp_path / "drape").sizes["start"] == 2
    assert not reproducing.run_one("drape", tmp_path, 2)
    assert "drape: start 2 of 2: complete" in capsys.readouterr().err
    assert not reproducing.run_one("drape", tmp_path, 3)
    assert EnsembleFolder(tmp_path / "drape").starts() == 3
    assert not reproducing.run_one("single", tmp_path)
    assert "start" not in open_run(tmp_path / "single").dims
    assert "already holds a run" in reproducing.run_one("single", tmp_path, 2)


def test_bands_of_another_engine_decide_beside_our_own_value():
    own = [
        compare("S", "length", "10 cm", 12.5, 10.0, "cm", 1.0, "reading"),
        relation("S", "a", "b", 1.0, "1", True, "c"),
    ]
    over = [replace(measured([10.5, 12.0, 13.0]), quantity="length"), relation("S", "a", "b", 2.0, "1", False, "c")]
    length, other = with_bands(own, over)
    assert (length.ours, length.median, length.band, length.is_met) == (12.5, 12.0, pytest.approx((10.65, 12.9)), True)
    assert other == own[1]  # no start changes it: our run decides
    text = as_markdown([length, other])
    assert "12.5; 12 (10.65 to 12.9)" in text
    assert "within the band in 1 of 1 lines" in text
    assert inside([replace(length, ours=13.0)]) == (0, 1)
    with pytest.raises(ValueError, match="no band"):
        with_bands(own, over[::-1])


def test_bands_are_asked_for_in_one_way_only(tmp_path, monkeypatch, capsys):
    for starts, bands in ((3, 12), (1, 1)):
        with pytest.raises(InputError, match="--bands"):
            reproducing.reproduce(tmp_path, 1, starts, bands)
    monkeypatch.setattr(reproducing, "is_available", lambda: False)
    assert reproducing._possible_bands(1, 12) == 0
    assert "MuJoCo is not installed" in capsys.readouterr().err


def test_the_plan_says_first_what_is_done_and_how_long_it_takes(tmp_path):
    first, *lines = reproducing.plan(tmp_path, 2, 1, 12).splitlines()
    alone = reproducing.plan(tmp_path, 2).splitlines()
    assert first.startswith("the paper's experiments in Bullet, about ")
    assert "bands from 12 starts in MuJoCo" in first
    assert re.search(r"in all about \d+ min$", first)
    assert alone[0] in first
    assert sum("12 starts" in line for line in lines) == len(reproducing.BANDS)


def test_bands_stand_beside_the_run_in_bullet(tmp_path, monkeypatch, capsys):
    def rows(runs):
        value = float(runs["drape"]["fabric.max_curvature"][-1])
        return [relation("S", "curvature", "drapes", value, "1/m", value > 0, "seen")]

    def run_all(out, jobs, tasks):
        return [p for name, starts, is_band in tasks if (p := reproducing.run_one(name, out, starts, 0, is_band))]

    monkeypatch.setattr(reproducing, "scenario_of", lambda name: tiny(0.1))
    for name, value in (
        ("RUNS", {"drape": 1}),
        ("BANDS", {"drape": 1}),
        ("PROTOTYPES", ("drape",)),
        ("scorecard_rows", rows),
        ("_run_all", run_all),
    ):
        monkeypatch.setattr(reproducing, name, value)
    assert reproducing.reproduce(tmp_path, 1, 1, 2) == 0
    band = load_scenario(tmp_path / "bands/drape/scenario.yaml")
    assert band.components["fabric"].engine == "mujoco"
    assert band.title.endswith("in MuJoCo")
    assert load_scenario(tmp_path / "drape/scenario.yaml").components["fabric"].engine == "bullet"
    (row,) = json.loads((tmp_path / "scorecard.json").read_text())["rows"]
    assert row["starts"] == 2
    assert row["band"][0] <= row["median"] <= row["band"][1]
    assert row["ours"] != row["median"]
    assert "lies within the band" in capsys.readouterr().out
