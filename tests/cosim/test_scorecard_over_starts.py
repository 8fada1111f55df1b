"""The scorecard of several starts: medians, bands, and what passes."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

import chainmail.reproduce.command as reproducing
from chainmail.ensemble.folder import EnsembleFolder
from chainmail.figures.draw import open_run
from chainmail.reproduce.row import compare, relation
from chainmail.reproduce.scorecard import as_json, as_markdown
from chainmail.reproduce.starts import rows_over_starts, starts_of, together
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
