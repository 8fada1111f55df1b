"""Sweeps of one coil: against the closed form, against scipy, and to the last bit against a run alone."""

from __future__ import annotations

import csv
import io
import os
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.stats import norm, qmc

from cosim import figure_style as style
from cosim.compute.cache import Cache
from cosim.compute.cluster import Here, choose_place
from cosim.run import run
from cosim.scenario import load_scenario
from cosim.sweep.axes import Column, Points
from cosim.sweep.command import plan, sweep
from cosim.sweep.figures import draw
from cosim.sweep.keys import changed, parts_of
from cosim.sweep.result import reasons
from cosim.unit.errors import InputError
from tests.sweep.files import SWEEP, written

DRAWN = """
title: t
scenario: coil.yaml
axes:
  sample:
    sobol: {count: 8, seed: 3, of: [OF]}
outputs: {hottest: {quantity: actuator.temperature, over: max}}
"""


def test_outputs_follow_the_closed_form_on_all_axes(tmp_path):
    path = written(tmp_path)
    assert sweep(path, tmp_path / "out", Here(), False) == 0
    with xr.open_dataset(tmp_path / "out" / "sweep.nc") as data:
        assert dict(data.sizes) == {"voltage": 3, "volume": 2, "time": 41}
        volumes, rooms = np.array([7e-9, 8e-9]), np.array([22.0, 25.0])
        # Equation (3) from 22 degC, constant voltage: T = T_inf + (22 - T_inf) exp(-G t / C).
        conductance, capacity = 90 * 97.85e-6, 6450 * 837 * volumes
        limit = rooms + data["voltage"].values[:, None] ** 2 / 2.2 / conductance
        wanted = limit + (22.0 - limit) * np.exp(-conductance * 4.0 / capacity)
        np.testing.assert_allclose(data["hottest"].values, wanted, atol=1e-9)
        np.testing.assert_allclose(data["energy"].values[:, 0], data["voltage"].values ** 2 / 2.2 * 4.0, rtol=1e-9)
        np.testing.assert_allclose(data["integral"].values, data["energy"].values / 2.0, rtol=1e-9)
        assert data["hottest"].attrs["units"] == "degC"
        assert data["voltage"].attrs["units"] == "V"
        np.testing.assert_allclose(data["temperature"].values.max(axis=-1) - 273.15, data["hottest"].values)
        assert set(data["failure"].values.ravel()) == {""}
    rows = list(csv.reader(io.StringIO((tmp_path / "out" / "table.csv").read_text())))
    assert rows[0][1:4] == [
        "voltage",
        "volume.components.actuator.parameters.volume",
        "volume.room.outputs.temperature.constant",
    ]
    assert len(rows) == 7


def test_a_run_of_a_sweep_is_the_run_alone_to_the_last_bit(tmp_path):
    path = written(tmp_path, SWEEP.replace("[0.6 V, 0.8 V, 1.0 V]", "[1 V]").replace("7 mm^3, 8", "7.328 mm^3, 8"))
    sweep(path, tmp_path / "out", Here(), False)
    alone = run(load_scenario(tmp_path / "coil.yaml"))["actuator.temperature"].values[:, 0]
    with xr.open_dataset(tmp_path / "out" / "sweep.nc") as data:
        np.testing.assert_array_equal(data["temperature"].values[0, 0], alone)


def test_two_processes_give_the_same_bits_and_resume_makes_nothing_twice(tmp_path):
    path = written(tmp_path)
    sweep(path, tmp_path / "one", Here(), False)
    sweep(path, tmp_path / "two", choose_place(2, goes_on=True), False)
    for name in ("sweep.nc", "table.csv", "failures.csv"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()
    kept = Cache(tmp_path / "one" / "runs")
    assert kept.count() == 6
    stamps = {p: os.stat(p).st_mtime_ns for p in (tmp_path / "one" / "runs").rglob("*.npz")}
    lost = next(iter(stamps))
    lost.unlink()
    sweep(path, tmp_path / "one", Here(), True)
    after = {p: os.stat(p).st_mtime_ns for p in stamps}
    assert {p for p in stamps if after[p] != stamps[p]} == {lost}
    assert (tmp_path / "one" / "sweep.nc").read_bytes() == (tmp_path / "two" / "sweep.nc").read_bytes()


def test_runs_that_fail_are_told_by_reason_and_the_others_stay(tmp_path):
    text = SWEEP.replace("values: [7 mm^3, 8 mm^3]", "values: [7 mm^3, -8 mm^3]")
    assert sweep(written(tmp_path, text), tmp_path / "out", Here(), False) == 1
    with xr.open_dataset(tmp_path / "out" / "sweep.nc") as data:
        assert np.isfinite(data["hottest"].values).tolist() == [[True, False]] * 3
        assert "volume" in data["failure"].values[1, 1]
    lines = list(csv.reader(io.StringIO((tmp_path / "out" / "failures.csv").read_text())))
    assert [line[0] for line in lines[1:]] == ["3"]
    assert lines[1][2] == "2 4 6"


def test_reasons_that_differ_in_numbers_alone_are_one():
    from cosim.compute.result import Result

    found = reasons([Result((), "link 3 at t = 1.5 s"), Result(()), Result((), "x"), Result((), "link 12 at t = 9 s")])
    assert found == [("link 3 at t = 1.5 s", [1, 4]), ("x", [3])]


def test_sobol_points_are_those_of_scipy_and_stated_uncertainties_those_of_the_set(tmp_path):
    low = "{key: actuator.parameters.volume, from: 7 mm^3, to: 9 mm^3}"
    log = "{key: supply.outputs.voltage.constant, from: 0.5 V, to: 1 V, scale: log}"
    planned = plan(written(tmp_path, DRAWN.replace("OF", f"{low}, {log}")))
    shares = qmc.Sobol(2, scramble=True, rng=np.random.default_rng(3)).random_base2(3)
    volume, voltage = planned.axes[0].columns
    np.testing.assert_allclose(volume.numbers, 7 + 2 * shares[:, 0], rtol=1e-14)
    np.testing.assert_allclose(voltage.numbers, 0.5 * 2 ** shares[:, 1], rtol=1e-14)
    (tmp_path / "set.yaml").write_text(
        "title: s\nparameters:\n"
        "  volume: {value: 7, unit: mm^3, uncertainty: 0.1, source: a test}\n"
        "  density: {value: 6450, unit: kg/m^3, source: a test}\n"
    )
    scenario = (tmp_path / "coil.yaml").read_text()
    (tmp_path / "coil.yaml").write_text(scenario.replace("ambient: room}", "ambient: room, parameter_set: set.yaml}"))
    (tmp_path / "sweep.yaml").write_text(DRAWN.replace("OF", "{component: actuator}"))
    stated = plan(tmp_path / "sweep.yaml").axes[0].columns
    assert [c.key for c in stated] == ["components.actuator.parameters.volume"]
    shares = qmc.Sobol(1, scramble=True, rng=np.random.default_rng(3)).random_base2(3)
    np.testing.assert_allclose(stated[0].numbers, 7 * np.exp(0.1 * norm.ppf(shares[:, 0])), rtol=1e-12)


def test_sobol_indices_of_a_known_function(tmp_path):
    pytest.importorskip("SALib")
    from cosim.sweep.sensitivity import saltelli, sobol_indices

    design = saltelli(1024, ["a", "b", "c"], 1)
    # Var(x) = 1/12: of a + 2 b the first-order indices are 1/5 and 4/5, and c has none.
    found = sobol_indices(design[:, 0] + 2.0 * design[:, 1], ["a", "b", "c"], 1)
    assert found is not None
    np.testing.assert_allclose(found.first, [0.2, 0.8, 0.0], atol=0.02)
    np.testing.assert_allclose(found.total, [0.2, 0.8, 0.0], atol=0.02)
    assert sobol_indices(np.ones(5 * 8), ["a", "b", "c"], 1) is None


def test_figures_of_a_sweep_have_a_title_the_sweep_and_degrees(tmp_path, monkeypatch):
    """They had neither a title nor the name of what they show."""
    columns = (
        Column("a", (0.6, 0.7), np.array([0.6, 0.7]), "V"),
        Column("b", (1.0, 2.0), np.array([1.0, 2.0]), "degC"),
    )
    points = [Points("voltage", "key", columns[:1]), Points("room", "key", columns[1:])]
    data = xr.Dataset(
        {"hottest": (("voltage", "room"), np.array([[30.0, 30.0], [40.0, 40.0]]), {"units": "degC"})},
        {"voltage": [0.6, 0.7], "room": [1.0, 2.0]},
        {"title": "Two rooms at 20 degC"},
    )
    seen = {}
    save = style.Figure.savefig

    def saved(self, path, **options):
        place = self.axes[0]
        styles = [line.get_linestyle() for line in place.lines]
        seen[path.name] = (self.get_suptitle(), place.get_xlabel(), place.get_ylabel(), styles)
        save(self, path, **options)

    monkeypatch.setattr(style.Figure, "savefig", saved)
    assert len(draw(tmp_path, data, points, ["hottest"])) == 2
    heading = "Two rooms at 20 °C"
    assert seen["hottest_lines.png"] == (f"hottest over voltage\n{heading}", "voltage [V]", "hottest [°C]", ["-", "--"])
    title = f"hottest over voltage and room\n{heading}"
    assert seen["hottest_map.png"] == (title, "voltage [V]", "room [°C]", [])


def test_indices_of_a_sweep_are_written_and_drawn(tmp_path):
    pytest.importorskip("SALib")
    of = (
        "{key: actuator.parameters.volume, from: 7 mm^3, to: 7.1 mm^3}, "
        "{key: supply.outputs.voltage.constant, from: 0.5 V, to: 1 V}"
    )
    text = DRAWN.replace("count: 8", "count: 4, indices: true").replace("OF", of)
    assert sweep(written(tmp_path, text, "1 s"), tmp_path / "out", Here(), False) == 0
    lines = list(csv.reader(io.StringIO((tmp_path / "out" / "indices.csv").read_text())))
    totals = {line[2]: float(line[5]) for line in lines[1:]}
    assert totals["supply.outputs.voltage.constant"] > 100 * totals["actuator.parameters.volume"]
    assert (tmp_path / "out" / "figures" / "hottest_indices.png").is_file()


def test_starts_are_parameters_of_the_fabric(tmp_path):
    text = """
title: t
scenario: passive_drape
axes:
  start: {starts: {count: 3, first: 2, speed: 2 mm/s}}
outputs: {sag: {quantity: fabric.tip_sag}}
"""
    (tmp_path / "s.yaml").write_text(text)
    planned = plan(tmp_path / "s.yaml")
    assert [a.assignments(2) for a in planned.axes] == [
        {"components.fabric.parameters.start_number": 4, "components.fabric.parameters.start_speed": "2 mm/s"}
    ]
    assert len({t.key for t in planned.tasks}) == 3


def test_paths_lead_to_places_and_change_nothing_else():
    data = {"time": {"stop": "1 s"}, "components": {"a": {"kind": "fmu", "l": [[1, 2], [3, 4]]}}}
    assert changed(data, {"a.l[2][1]": 9})["components"]["a"]["l"] == [[1, 2], [9, 4]]
    assert changed(data, {"a.parameters.body.x[3]": 1})["components"]["a"]["parameters"] == {"body.x[3]": 1}
    assert data["components"]["a"]["l"] == [[1, 2], [3, 4]]
    assert parts_of("time.stop", data) == ["time", "stop"]


WRONG = {
    "no axis": ("axes:\n  voltage:", "axes_:\n  voltage:", "there is no such key"),
    "two kinds": ("values: [0.6 V", "starts: {count: 2}, values: [0.6 V", "one of `key`, `zip`, `sobol` and `starts`"),
    "no values": (", values: [0.6 V, 0.8 V, 1.0 V]", "", "give either `values` or `range`"),
    "uneven zip": ("[22 degC, 25 degC]", "[22 degC]", "same number of values"),
    "unknown component": ("supply.outputs", "source.outputs", "cannot stand below|there is no"),
    "no such list": ("voltage.constant", "voltage[2]", "there is no element 2: `voltage` is no list"),
    "not from 1": ("voltage.constant", "voltage[0]", "counted from 1"),
    "misspelt key": ("voltage.constant", "voltage.constants", "no such key"),
    "unknown parameter": ("parameters.volume", "parameters.volum", "volum"),
    "set twice": (
        "room.outputs.temperature.constant, values: [22 degC, 25 degC]",
        "supply.outputs.voltage.constant, values: [1 V, 2 V]",
        "is set twice",
    ),
    "set under another name": (
        "room.outputs.temperature.constant, values: [22 degC, 25 degC]",
        "components.supply.outputs.voltage.constant, values: [1 V, 2 V]",
        "is set twice",
    ),
    "set below another": (
        "room.outputs.temperature.constant, values: [22 degC, 25 degC]",
        "supply.outputs.voltage, values: [{unit: V, constant: 1 V}, {unit: V, constant: 2 V}]",
        "lies below `supply.outputs.voltage`, which sets it too",
    ),
    "a value twice in two units": ("0.8 V, 1.0 V", "0.8 V, 800 mV", "the value 800 mV stands twice"),
    "a negative place": ("voltage.constant", "voltage[-1]", "is no path of keys"),
    "an open bracket": ("voltage.constant", "voltage[1", "is no path of keys"),
    "no list of that name": ("voltage.constant", "voltages[1]", "there is no list `voltages`"),
    "unknown quantity": ("quantity: actuator.temperature, over", "quantity: actuator.temprature, over", "did you mean"),
    "another unit": ("unit: degC", "unit: V", "K cannot be converted to V"),
    "no such element": ("over: max,", "over: max, of: 99, ", "there is no element 99"),
    "a window that ends before it begins": ("over: max,", "over: max, from: 2 s, to: 1 s, ", "is later than"),
    "a time after the end": ("over: max,", "over: at, at: 1 h, ", "lies outside the run"),
    "wrong unit": ("0.8 V, 1.0 V", "0.8 m, 1.0 V", "with voltage = 0.8 m, volume = 7 mm.3 the scenario is wrong"),
    "no scenario": ("coil.yaml", "cable.yaml", "`cable.yaml`: there is no such scenario"),
    "at without time": ("over: max,", "over: at,", "`at` gives the time"),
    "a name for two things": ("  hottest:", "  voltage:", "stands for two things"),
    "taken name": ("  hottest:", "  failure:", "is taken"),
    "too many": ("values: [0.6 V, 0.8 V, 1.0 V]", "range: {from: 0 V, to: 1 V, count: 99999}", "more than 100000"),
    "equal ends": ("values: [0.6 V, 0.8 V, 1.0 V]", "range: {from: 1 V, to: 1 V, count: 3}", "are both 1 V"),
    "log of zero": ("values: [0.6 V, 0.8 V, 1.0 V]", "range: {from: 0 V, to: 1 V, count: 3, scale: log}", "positive"),
    "series of other times": (
        '"supply.outputs.voltage.constant", values: [0.6 V, 0.8 V, 1.0 V]',
        "time.stop, values: [2 s, 4 s]",
        "no common axis",
    ),
    "no list of it": ("outputs:\n", "outputs: 3\nx:\n", "outputs"),
}


@pytest.mark.parametrize(("old", "new", "what"), WRONG.values(), ids=WRONG)
def test_a_malformed_sweep_gets_one_clear_error(tmp_path: Path, old: str, new: str, what: str) -> None:
    assert old in SWEEP
    with pytest.raises(InputError, match=what) as refused:
        plan(written(tmp_path, SWEEP.replace(old, new)))
    assert refused.value.source.endswith(("sweep.yaml", "coil.yaml"))
    assert refused.value.remedy


def test_a_folder_is_not_overwritten(tmp_path):
    path = written(tmp_path)
    with pytest.raises(InputError, match="no sweep to resume"):
        sweep(path, tmp_path / "out", Here(), True)
    sweep(path, tmp_path / "out", Here(), False)
    with pytest.raises(InputError, match="already holds a sweep"):
        sweep(path, tmp_path / "out", Here(), False)
