"""Ctrl-C, and the sudden end of the simulation itself: nothing is lost, nothing is left."""

import os
import signal
import time

import pytest
import xarray as xr

from cosim.run import run

from .conftest import processes, remaining


def wait_for(condition, process):
    """Wait until `condition()`; fail if the process ends before."""
    while not condition():
        assert process.poll() is None, process.communicate()
        time.sleep(0.02)


def test_ctrl_c_reaches_the_simulation_alone_and_the_run_can_be_resumed(tmp_path, fmu, scenario, start):
    scenario({"faulty": fmu("nap", "step")}, stop=30, checkpoint="1 s")
    folder = tmp_path / "run"
    running = start("run", tmp_path / "scenario.yaml", "--out", folder, "--no-plots")
    wait_for(lambda: len(list(folder.glob("checkpoints/*"))) >= 2, running)
    os.killpg(running.pid, signal.SIGINT)
    _, said = running.communicate()
    assert running.returncode == 130, said
    assert "interrupted at t = " in said
    kept = xr.load_dataset(folder / "results.nc")
    assert 200 <= kept.sizes["time"] < 3001
    resumed = start("run", folder, "--resume", "--no-plots")
    _, said = resumed.communicate()
    assert resumed.returncode == 0, said
    whole = run(scenario({"faulty": fmu()}, isolation="none", stop=30, checkpoint="1 s"))
    ended = xr.load_dataset(folder / "results.nc")
    for name in ("faulty.y", "faulty.steps"):
        assert ended[name].values.tobytes() == whole[name].values.tobytes()
    assert kept["faulty.y"].values.tobytes() == whole["faulty.y"].values[: kept.sizes["time"]].tobytes()


def test_a_second_ctrl_c_ends_an_endless_step(tmp_path, fmu, scenario, start):
    scenario({"faulty": fmu("never_return", "step")})
    folder = tmp_path / "run"
    running = start("run", tmp_path / "scenario.yaml", "--out", folder, "--no-plots")
    wait_for((folder / "scenario.yaml").is_file, running)
    time.sleep(0.5)
    os.killpg(running.pid, signal.SIGINT)
    time.sleep(0.2)
    os.killpg(running.pid, signal.SIGINT)
    _, said = running.communicate()
    assert running.returncode == 130, said
    assert "interrupted at t = 0.05 s" in said
    assert "warning" not in said
    assert xr.load_dataset(folder / "results.nc")["faulty.steps"].values.tolist() == [0, 1, 2, 3, 4, 5]


@pytest.mark.parametrize("deed", ["nap", "never_return"])
def test_when_the_simulation_is_killed_its_fmus_end_and_remove_their_files(
    tmp_path, fmu, scenario, start, temporary, deed
):
    scenario({"one": fmu(deed, "step"), "two": fmu("nap", "step")}, stop=100, checkpoint="1 s")
    folder = tmp_path / "run"
    running = start("run", tmp_path / "scenario.yaml", "--out", folder, "--no-plots")
    wait_for((folder / "scenario.yaml").is_file, running)
    time.sleep(0.5)
    assert len(processes(str(temporary))) == 2
    assert len(list(temporary.iterdir())) == 2
    running.kill()
    running.wait()
    assert remaining(str(temporary)) == []
    assert list(temporary.iterdir()) == []
