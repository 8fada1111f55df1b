"""Figures of runs: which there are, what they say, and the mean over a noisy line."""

import numpy as np
import pytest
import xarray as xr

from chainmail.figures import currents, quantities, side_view, temperatures
from chainmail.figures.draw import draw_run
from chainmail.figures.usual_names import with_usual_names
from chainmail.measures import switches
from cosim import figure_style as style
from cosim.figure_style import SWITCH, figure, mark_switches, smoothed
from cosim.options import FORMATS, formats_of
from cosim.run_folder import RunFolder
from cosim.unit.errors import InputError


@pytest.fixture
def fabric_run(tmp_path):
    """A run folder of a small fabric, with the results that the figures read."""
    time = np.arange(0.0, 30.0, 0.02)
    hot = (time > 8.0) & (time < 18.0)
    curve = np.where(hot, 1.0, 10.0) + 0.5 * np.cos(np.pi * np.arange(len(time)))
    voltage = np.where((time > 0.37) & (time < 12.6), 6.0, 0.0)
    kelvin = np.repeat((295.15 + 3.0 * voltage)[:, None], 4, axis=1)
    dataset = xr.Dataset(
        {
            "supply.voltage": ("time", voltage),
            "fabric.max_curvature": ("time", curve),
            "fabric.fabric_length": ("time", 0.1 + 0.0 * time),
            "fabric.link_length": (("time", "link"), np.full((len(time), 2), 0.03)),
            "fabric.marker_position": (("time", "marker", "axis"), np.zeros((len(time), 4, 3))),
            "fabric.row_centre": (("time", "row", "axis"), np.zeros((len(time), 2, 3))),
            "actuator.temperature": (("time", "coil"), kelvin),
            "actuator.stiffness": (("time", "coil"), 200.0 + 0.0 * kelvin),
            "circuit.current": (("time", "coil"), 0.4 + 0.0 * kelvin),
            "circuit.supply_current": ("time", voltage),
            "circuit.supply_power": ("time", 6 * voltage),
        },
        {"time": time},
        {"title": "My fabric, 5 $ a link"},
    )
    folder = RunFolder(tmp_path / "run")
    folder.path.mkdir()
    dataset.to_netcdf(folder.results, engine="netcdf4")
    return folder.path


def test_every_figure_is_written_in_every_format_under_a_name_that_fits_any_fabric(fabric_run):
    drawn = draw_run(fabric_run, FORMATS)
    names = {path.stem for path in drawn}
    assert names == {"curvature", "lengths", "side_view", "temperatures", "stiffness_loops", "currents"}
    assert len(drawn) == len(names) * len(FORMATS)
    for path in drawn:
        begin = path.read_bytes()[:200]
        assert {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[path.suffix[1:]] in begin


def test_the_same_run_gives_the_same_files(fabric_run):
    first = {path: path.read_bytes() for path in draw_run(fabric_run, FORMATS)}
    assert {path: path.read_bytes() for path in draw_run(fabric_run, FORMATS)} == first


@pytest.fixture
def texts(fabric_run, monkeypatch):
    """Figure to its texts, as it is saved."""
    found = {}
    save = style.Figure.savefig

    def saved(self, path, **options):
        axes = self.axes
        found[path.stem] = {
            "heading": self.get_suptitle(),
            "labels": [a.get_ylabel() for a in axes] + [axes[-1].get_xlabel()],
            "switches": [line.get_color() for a in axes for line in a.lines if line.get_label() == "supply switched"],
            "marks": [t.get_text() for t in axes[0].texts],
        }
        save(self, path, **options)

    monkeypatch.setattr(style.Figure, "savefig", saved)
    draw_run(fabric_run)
    return found


def test_each_figure_has_its_title_and_the_run_and_an_axis_per_unit(texts):
    for name, told in texts.items():
        title, run = told["heading"].split("\n")
        assert run == r"My fabric, 5 \$ a link", name
        assert title
        assert not [label for label in told["labels"] if "degC" in label or label.count("[") > 1]
        assert {str(c) for c in told["switches"]} <= {SWITCH}
    assert texts["currents"]["labels"][:3] == ["coil current [mA]", "supply current [A]", "supply power [W]"]
    assert "°C" in texts["temperatures"]["labels"][0]


def test_what_the_paper_states_is_marked_in_the_paper_s_own_run_alone(texts, fabric_run):
    assert texts["curvature"]["marks"] == []
    with xr.open_dataset(fabric_run / "results.nc") as stored:
        paper = stored.load()
    paper.attrs["title"] = "Prototype (paper, Figure 3)"
    (fabric_run / "results.nc").unlink()
    paper.to_netcdf(fabric_run / "results.nc", engine="netcdf4")
    draw_run(fabric_run)
    marks = texts["curvature"]["marks"]
    assert "Figure 3" in texts["curvature"]["heading"]
    for part in ("full rigidity", "flexibility regained", "delay"):
        assert any(part in mark for mark in marks), part


def test_the_mean_keeps_a_line_and_takes_away_what_alternates():
    times = np.arange(0.0, 2.0, 0.02)
    line = 3.0 + 2.0 * times
    inside = slice(5, -5)
    assert smoothed(times, line)[inside] == pytest.approx(line[inside], rel=1e-12)
    noise = np.cos(np.pi * np.arange(len(times)))
    # Eleven samples of +1 and -1 sum to 1: the mean is at most 1/11.
    assert np.abs(smoothed(times, noise)[inside]).max() == pytest.approx(1 / 11, rel=1e-9)
    assert smoothed(times[:2], line[:2]).tolist() == line[:2].tolist()


def test_a_long_name_of_a_run_stays_inside(tmp_path):
    with figure(tmp_path / "f.png", title="Lengths", run="word " * 80) as (axes,):
        mark_switches(axes, [0.5])
        heading = axes.figure.get_suptitle()
    assert heading.count("\n") == 2
    assert heading.endswith("...")


@pytest.mark.parametrize("given", ["", " , ", "gif", "png,sgv"])
def test_a_format_that_is_none_is_refused(given):
    with pytest.raises(InputError, match="--format"):
        formats_of(given)
    assert FORMATS == style.FORMATS
    assert formats_of("SVG, png,svg") == ["svg", "png"]


def test_a_system_of_any_units_gets_a_figure_with_an_axis_for_each_unit(tmp_path, monkeypatch):
    """Runs of somebody's FMUs had an empty folder of figures."""
    time = np.arange(0.0, 10.0, 0.1)
    dataset = xr.Dataset(
        {
            "tank.level": ("time", 1.0 + 0.1 * time, {"units": "m"}),
            "tank.temperature": (("time", "zone"), 300.0 + np.outer(time, [1.0, 2.0]), {"units": "K"}),
            "pump.is_on": ("time", time > 5.0),
            "pump.message": ("time", np.array(["text"] * len(time))),
            "pump.unknown": ("time", np.full(len(time), np.nan), {"units": "Pa"}),
        },
        {"time": time},
        {"title": "Two zones"},
    )
    folder = RunFolder(tmp_path / "run")
    folder.path.mkdir()
    dataset.to_netcdf(folder.results, engine="netcdf4")
    seen = {}
    save = style.Figure.savefig

    def saved(self, path, **options):
        seen["heading"] = self.get_suptitle()
        seen["axes"] = {
            a.get_ylabel(): {line.get_label(): float(line.get_ydata()[-1]) for line in a.lines} for a in self.axes
        }
        save(self, path, **options)

    monkeypatch.setattr(style.Figure, "savefig", saved)
    assert [path.name for path in draw_run(folder.path)] == ["quantities.png"]
    assert seen["heading"] == "Recorded quantities\nTwo zones"
    assert set(seen["axes"]) == {"[m]", "[°C]", "[1]"}
    assert seen["axes"]["[m]"] == pytest.approx({"tank.level": 1.99})
    assert seen["axes"]["[°C]"] == pytest.approx({"tank.temperature[1]": 36.75, "tank.temperature[2]": 46.65})
    assert seen["axes"]["[1]"] == {"pump.is_on": 1.0}


def test_a_large_system_says_how_much_of_it_is_drawn(tmp_path):
    dataset = xr.Dataset({"a.x": (("time", "element"), np.zeros((5, 300)), {"units": "m"})}, {"time": np.arange(5.0)})
    assert sum(len(lines) for lines in quantities.by_unit(dataset).values()) == 300
    assert quantities._left_out(quantities.by_unit(dataset), quantities.by_unit(dataset)) == (
        ", 10 of 300 (all of them: results.nc)"
    )


def test_a_line_on_the_same_values_as_another_is_dashed_so_that_both_are_seen(tmp_path, monkeypatch):
    time = np.arange(0.0, 5.0, 0.5)
    columns = {"arm.angle": np.sin(time), "arm.sensor": np.sin(time), "arm.other": np.cos(time)}
    run = xr.Dataset({n: ("time", v, {"units": "rad"}) for n, v in columns.items()}, {"time": time})
    seen = {}
    save = style.Figure.savefig

    def saved(self, path, **options):
        seen.update({line.get_label(): line.get_linestyle() for line in self.axes[0].lines})
        save(self, path, **options)

    monkeypatch.setattr(style.Figure, "savefig", saved)
    quantities.draw(tmp_path / "quantities.png", run, [])
    assert seen == {"arm.angle": "-", "arm.sensor": "--", "arm.other": "-"}


def test_lines_of_the_supply_have_no_colour_of_a_coil(tmp_path, monkeypatch):
    time = np.arange(0.0, 5.0, 0.5)
    data = {
        "circuit.current": (("time", "coil"), np.outer(1.0 + time, [0.1, 0.2])),
        "circuit.supply_current": ("time", time),
        "circuit.supply_power": ("time", time),
    }
    coils, supply = set(), set()
    save = style.Figure.savefig

    def saved(self, path, **options):
        coils.update(line.get_color() for line in self.axes[0].lines)
        supply.update(line.get_color() for axes in self.axes[1:] for line in axes.lines)
        save(self, path, **options)

    monkeypatch.setattr(style.Figure, "savefig", saved)
    currents.draw(tmp_path / "currents.png", xr.Dataset(data, {"time": time}), [])
    assert len(coils) == 2
    assert supply == {currents.SUPPLY}
    assert coils.isdisjoint(supply)


def test_figures_follow_what_components_do_and_not_how_they_are_called(tmp_path):
    """A run whose actuator was not called `actuator` had no figure of its temperatures."""
    time = np.arange(0.0, 5.0, 0.5)
    coils = np.outer(300.0 + time, [1.0, 1.1])
    data = {
        "cell.voltage": ("time", np.where(time < 2.0, 0.0, 3.0), {"units": "V"}),
        "lab.temperature": ("time", np.full(len(time), 295.0), {"units": "K"}),
        "muscles.temperature": (("time", "coil"), coils, {"units": "K"}),
        "muscles.stiffness": (("time", "coil"), coils, {"units": "N/m"}),
        "net.current": (("time", "coil"), 0.001 * coils, {"units": "A"}),
        "net.voltage": (("time", "coil"), 0.001 * coils, {"units": "V"}),
        "net.supply_current": ("time", time, {"units": "A"}),
        "net.supply_power": ("time", time, {"units": "W"}),
    }
    folder = RunFolder(tmp_path / "run")
    folder.path.mkdir()
    run = xr.Dataset(data, {"time": time}, {"title": "Own names"})
    run.to_netcdf(folder.results, engine="netcdf4")
    named = with_usual_names(run)
    assert switches(named) == [1.5]
    assert temperatures.surroundings(named) == ["lab.temperature"]
    assert [path.name for path in draw_run(folder.path)] == ["temperatures.png", "stiffness_loops.png", "currents.png"]
    two = run.assign({"more.temperature": run["muscles.temperature"], "more.stiffness": run["muscles.stiffness"]})
    assert "muscles.temperature" in with_usual_names(two)  # which of the two is meant cannot be said


def test_coils_are_drawn_where_a_sensor_of_another_size_has_their_dimension(tmp_path):
    """Beside a camera with one element the coils of an actuator have the dimension `actuator_coil`."""
    time = np.arange(0.0, 5.0, 0.5)
    for name, coils in (("same", np.outer(300.0 + time, np.ones(36))), ("own", np.outer(time, np.arange(36.0)))):
        data = {
            "camera.reading": (("time", "coil"), np.outer(time, [1.0]), {"units": "1/m"}),
            "actuator.temperature": (("time", "actuator_coil"), coils, {"units": "K"}),
            "actuator.stiffness": (("time", "actuator_coil"), coils, {"units": "N/m"}),
        }
        folder = RunFolder(tmp_path / name)
        folder.path.mkdir()
        xr.Dataset(data, {"time": time}, {"title": "Two sizes"}).to_netcdf(folder.results, engine="netcdf4")
        assert [path.name for path in draw_run(folder.path)] == ["temperatures.png", "stiffness_loops.png"]


def test_the_side_view_says_when_and_at_which_voltage_and_claims_no_heat():
    """A fabric whose coils had reached 32 degC was labelled hot."""
    now = xr.Dataset({"supply.voltage": 6.0}, {"time": 1.5})
    assert side_view._label(now) == "t = 1.50 s, 6 V"
    assert side_view._label(now.drop_vars("supply.voltage")) == "t = 1.50 s"
    two = xr.Dataset({"supply.voltage": ("string", [6.0, 0.0])}, {"time": 1.5})
    assert side_view._label(two) == "t = 1.50 s"
