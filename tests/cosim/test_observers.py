"""What watches a run: trace, energy meter, progress."""

import io

import numpy as np
import pytest
import xarray as xr
from rich.console import Console

from cosim import progress
from cosim.observers.energy_balance import EnergyBalance
from cosim.observers.trace import Trace
from cosim.progress import progress_bar
from cosim.run import Progress, RunStopped, run
from cosim.run_folder import RunFolder
from cosim.scenario import load_scenario
from cosim.system import System
from cosim.unit.protocol import Coordinate

from .scripted import Relaxation
from .short_runs import drape, heating, shortened


def test_a_closed_cycle_is_measured_by_what_flowed_in_between():
    result = run(load_scenario("water_bath"))
    # 30-70-30 degC: all energies end near zero, about 1.6 J went in and came out again.
    assert result.attrs["energy_convected_J"] == pytest.approx(0.0, abs=1e-9)
    assert abs(result.attrs["energy_residual"]) < 1e-12


def test_a_resumed_run_remembers_what_flowed_before(tmp_path):
    def interrupt(progress):
        if progress.done >= 0.85 * progress.total:  # on the way down, long after the hottest moment
            raise KeyboardInterrupt

    scenario = load_scenario("water_bath")
    with pytest.raises(RunStopped):
        run(scenario, tmp_path / "run", on_progress=interrupt)
    whole = run(scenario)
    resumed = run(scenario, tmp_path / "run", resume=True)
    assert resumed.attrs["energy_residual"] == whole.attrs["energy_residual"]


def test_a_missing_joule_shows_in_the_residual():
    assert EnergyBalance(100.0, 9.0, 90.0, 100.0).residual == pytest.approx(-0.01)
    assert EnergyBalance(0.0, 0.0, 0.0, 0.0).residual == 0.0


def tanks(first, second, labels=None):
    """Two units whose arrays share the name of their dimension but perhaps not its size."""
    units = {"a": Relaxation("a", 1.0, 1.0, 0.0, shape=(first,)), "b": Relaxation("b", 1.0, 2.0, 0.0, shape=(second,))}
    if labels is not None:
        units["a"].coordinates = labels
    system = System(units, [])
    system.initialise(0, {})
    return system


def test_equal_dimensions_are_shared_and_unequal_ones_kept_apart():
    assert Trace(tanks(3, 3), [0]).dataset()["b.state"].dims == ("time", "cell")
    assert Trace(tanks(3, 2), [0]).dataset()["b.state"].dims == ("time", "b_cell")


def test_only_what_was_recorded_is_in_the_dataset():
    trace = Trace(tanks(2, 2), range(0, 40, 10))
    assert trace.dataset().sizes["time"] == 0
    trace.record(0)
    trace.record(10)
    assert trace.dataset()["time"].values.tolist() == [0.0, 1e-8]
    assert trace.dataset()["a.state"].values.tolist() == [[1.0, 1.0], [1.0, 1.0]]
    with pytest.raises(ValueError, match="output 2 belongs to 20 ns, not 30 ns"):
        trace.record(30)


def test_a_unit_labels_its_dimensions():
    labels = {
        "cell": Coordinate("cell", np.array(["left", "right"]), "side"),
        "cell_volume": Coordinate("cell", np.array([1.0, 2.0]), "volume"),
    }
    data = Trace(tanks(2, 2, labels), [0]).dataset()
    assert data["cell"].values.tolist() == ["left", "right"]
    assert data["cell_volume"].attrs["long_name"] == "volume"


def test_every_recorded_variable_carries_unit_and_description():
    for scenario in (drape(), heating(), shortened("water_bath", "10 s", checkpoint_step="10 s")):
        for name, variable in run(scenario).data_vars.items():
            assert variable.attrs["units"], name
            assert variable.attrs["long_name"], name
            assert variable.dims[0] == "time"


def test_checkpoints_are_ordered_by_step_even_beyond_six_digits(tmp_path):
    (tmp_path / "checkpoints").mkdir()
    for index in (999_999, 1_000_000, 20, 10_000_000):
        RunFolder(tmp_path).write_checkpoint(index, {"index": np.array(index)})
    assert [int(p.stem) for p in RunFolder(tmp_path).checkpoints()] == [20, 999_999, 1_000_000, 10_000_000]


def test_the_main_series_summarise_coils_and_keep_strings(tmp_path):
    result = run(heating(), tmp_path / "run")
    header, *rows = (tmp_path / "run" / "series.csv").read_text().splitlines()
    columns = header.split(",")
    assert columns[0] == "time [s]"
    assert "circuit.string_current[6] [A]" in columns
    last = dict(zip(columns, map(float, rows[-1].split(",")), strict=True))
    temperature = result["actuator.temperature"].values[-1]
    # numbers are written so that they read back to the same double; the mean may be added up in another order
    assert last["mean actuator.temperature [K]"] == pytest.approx(temperature.mean(), rel=1e-14)
    assert last["max actuator.temperature [K]"] == temperature.max()
    assert last["circuit.supply_current [A]"] == float(result["circuit.supply_current"][-1])


def test_a_netcdf_of_an_unknown_program_would_read_the_same(tmp_path):
    run(heating(), tmp_path / "run")
    with xr.open_dataset(tmp_path / "run" / "results.nc", decode_cf=False) as plain:
        assert plain["time"].dims == ("time",)
        assert plain["actuator.temperature"].attrs["units"] == "K"
        assert plain["circuit.string_current"].dims == ("time", "string")
        assert plain.attrs["wall_time_circuit_s"] > 0
        assert plain.attrs["status"] == "complete"


HALF = Progress(done=50, total=100, time=-1.5, elapsed=10.0, simulated=5.0, step=0.1)


def test_time_left_follows_from_the_speed_so_far():
    assert HALF.remaining == pytest.approx(10.0)
    assert Progress(0, 100, 0.0, 0.0, 0.0, 0.1).remaining == 0.0


def test_a_terminal_shows_share_and_time_left():
    screen = io.StringIO()
    with progress_bar("drape", Console(file=screen, force_terminal=True, width=120)) as draw:
        draw(HALF)
    assert "drape" in screen.getvalue()
    assert "50 %" in screen.getvalue()
    assert "10 s left" in screen.getvalue()


def test_without_a_terminal_a_line_comes_every_ten_seconds(monkeypatch, capsys):
    now = [0.0]
    monkeypatch.setattr(progress.clock, "perf_counter", lambda: now[0])
    with progress_bar("drape", Console(file=io.StringIO(), force_terminal=False)) as say:
        for moment in (1.0, 9.0, 11.0, 12.0, 22.0):
            now[0] = moment
            say(HALF)
    lines = capsys.readouterr().err.splitlines()
    assert lines == [f"{'drape':<34} {11 * '#'}{11 * '-'}  50 %       10 s left"] * 2
