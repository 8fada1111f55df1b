"""`cosim run --csv`: every recorded value as text, to the last bit, however the run ends."""

import csv

import numpy as np
import pytest
import xarray as xr

from cosim.run import RunStopped, run
from cosim.unit.errors import InputError

from .short_runs import heating, with_parameters


def table(folder):
    """Header and rows of numbers."""
    with (folder / "results.csv").open(newline="") as file:
        header, *rows = csv.reader(file)
    return header, np.array(rows, dtype=float)


def check_is(folder, data):
    """The file holds what the dataset holds: exactly, since the shortest text that reads back the same is written."""
    header, rows = table(folder)
    assert header[0] == "time [s]"
    assert rows[:, 0].tolist() == data["time"].values.tolist()
    assert len(header) == 1 + sum(v[0].size for v in data.data_vars.values())
    for coil in range(6):
        column = header.index(f"actuator.temperature[{coil + 1}] [K]")
        assert rows[:, column].tolist() == data["actuator.temperature"].values[:, coil].tolist()
    assert (
        rows[:, header.index("circuit.supply_current [A]")].tolist() == data["circuit.supply_current"].values.tolist()
    )


def interrupt_at(done):
    def on_progress(progress):
        if progress.done == done:
            raise KeyboardInterrupt

    return on_progress


def test_the_command_writes_every_recorded_value(tmp_path, cosim):
    (tmp_path / "mine.yaml").write_text(heating().to_yaml())
    answer = cosim("run", tmp_path / "mine.yaml", "--csv", "--no-plots", "--out", tmp_path / "run")
    assert answer.code == 0
    data = xr.load_dataset(tmp_path / "run" / "results.nc")
    assert data.sizes["time"] == 31
    check_is(tmp_path / "run", data)


def test_no_file_is_written_unless_it_is_asked_for(tmp_path):
    run(heating(), tmp_path / "run")
    assert not (tmp_path / "run" / "results.csv").exists()


def test_a_run_that_fails_keeps_the_rows_before_the_failure(tmp_path):
    scenario = with_parameters(heating(), "actuator", resistance_temperature_coefficient="-0.05 1/K")
    with pytest.raises(RunStopped) as stopped:
        run(scenario, tmp_path / "run", csv=True)
    # macro-steps of 0.1 s; the FMU refuses the step that begins at 0.7 s
    assert table(tmp_path / "run")[1][-1, 0] == 0.7
    check_is(tmp_path / "run", stopped.value.dataset)


@pytest.mark.usefixtures("_one_step_per_turn")
@pytest.mark.parametrize("asked_again", [True, False])
def test_an_interrupted_run_keeps_its_rows_and_the_resumed_one_completes_them(tmp_path, asked_again):
    with pytest.raises(RunStopped) as stopped:
        run(heating(), tmp_path / "run", on_progress=interrupt_at(25), csv=True)
    assert len(table(tmp_path / "run")[1]) == 26
    check_is(tmp_path / "run", stopped.value.dataset)
    resumed = run(heating(), tmp_path / "run", resume=True, csv=asked_again)
    assert len(table(tmp_path / "run")[1]) == 31
    check_is(tmp_path / "run", resumed)


def test_where_the_file_cannot_be_written_the_run_is_not_complete_and_can_be_resumed(tmp_path, monkeypatch):
    def full(_path, _trace):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("cosim.native.trace_csv.write_trace", full)
        with pytest.raises(RunStopped, match="No space left on device"):
            run(heating(), tmp_path / "run", csv=True)
    assert (tmp_path / "run" / "results.nc").is_file()
    assert not (tmp_path / "run" / "results.csv").exists()
    assert run(heating(), tmp_path / "run", resume=True, csv=True).sizes["time"] == 31
    check_is(tmp_path / "run", xr.load_dataset(tmp_path / "run" / "results.nc"))
    with pytest.raises(InputError, match="this run is complete"):
        run(heating(), tmp_path / "run", resume=True)
