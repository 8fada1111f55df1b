"""A crash becomes an error that names unit, time, signal and FMI function; what was computed is kept."""

import logging
import os
import signal

import numpy as np
import pytest
import xarray as xr

from cosim.run import RunStopped, run
from cosim.unit.errors import InputError
from cosim.unit.protocol import UnitError

from .conftest import processes, remaining, rising

STEP = 10_000_000

IN_A_STEP = {
    "segfault": r"faulty at t = 0.05 s: its process crashed with SIGSEGV \(segmentation fault\) in fmi2DoStep",
    "give_up": r"faulty at t = 0.05 s: its process crashed with SIGABRT \(abort\) in fmi2DoStep.*"
    r"; it printed last: state is inconsistent",
    "divide": r"faulty at t = 0.05 s: its process crashed with SIGFPE \(arithmetic error\) in fmi2DoStep",
    "leave": r"faulty at t = 0.05 s: its process ended by itself with exit code 0 in fmi2DoStep",
    "leave_with_code": r"faulty at t = 0.05 s: its process ended by itself with exit code 7 in fmi2DoStep",
    "be_killed": r"faulty at t = 0.05 s: its process was ended from outside with SIGKILL in fmi2DoStep",
    "turn_to_nan": r"faulty at t = 0.0[56] s: output y.* is not (a )?finite",
}


@pytest.mark.parametrize("deed", IN_A_STEP)
def test_a_step_that_fails_is_named_and_the_values_before_it_are_kept(tmp_path, fmu, scenario, deed):
    with pytest.raises(RunStopped, match=IN_A_STEP[deed]) as stopped:
        run(scenario({"faulty": fmu(deed, "step")}), tmp_path / "run")
    assert not stopped.value.is_interrupt
    kept = xr.load_dataset(tmp_path / "run" / "results.nc")
    assert kept.attrs["status"] == stopped.value.reason
    assert kept["faulty.y"].values.tolist() == rising(6)
    assert kept["faulty.steps"].values.tolist() == [0, 1, 2, 3, 4, 5]


@pytest.mark.parametrize(
    ("deed", "place", "what"),
    [
        ("segfault", "load", r"crashed with SIGSEGV \(segmentation fault\) during its construction"),
        ("segfault", "instantiate", r"crashed with SIGSEGV \(segmentation fault\) in fmi2Instantiate"),
        ("leave", "instantiate", "ended by itself with exit code 0 in fmi2Instantiate"),
        ("segfault", "initialise", r"crashed with SIGSEGV \(segmentation fault\) in fmi2EnterInitializationMode"),
        ("give_up", "get", r"crashed with SIGABRT \(abort\) in fmi2GetReal"),
    ],
)
def test_a_crash_before_the_first_step_is_an_input_error_and_leaves_no_run(tmp_path, fmu, scenario, deed, place, what):
    with pytest.raises(InputError, match=what) as refused:
        run(scenario({"faulty": fmu(deed, place)}), tmp_path / "run")
    assert refused.value.key == "components.faulty"
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(("place", "function"), [("terminate", "fmi2Terminate"), ("free_instance", "fmi2FreeInstance")])
def test_a_crash_at_the_end_is_a_warning_and_the_results_are_complete(tmp_path, fmu, scenario, caplog, place, function):
    with caplog.at_level(logging.WARNING):
        run(scenario({"faulty": fmu("segfault", place)}), tmp_path / "run")
    kept = xr.load_dataset(tmp_path / "run" / "results.nc")
    assert kept.attrs["status"] == "complete"
    assert kept["faulty.y"].values.tolist() == rising(11)
    (line,) = caplog.messages
    assert f"faulty at t = 0.1 s: its process crashed with SIGSEGV (segmentation fault) in {function}" in line


def test_a_crash_at_the_end_is_one_line_on_the_command_line(tmp_path, fmu, scenario, start):
    scenario({"faulty": fmu("segfault", "free_instance")})
    done = start("run", tmp_path / "scenario.yaml", "--out", tmp_path / "run", "--no-plots")
    _, said = done.communicate()
    assert done.returncode == 0
    lines = [line for line in said.splitlines() if "SIGSEGV" in line]
    assert len(lines) == 1
    assert lines[0].startswith("warning: faulty at t = 0.1 s: its process crashed with SIGSEGV")
    assert "Traceback" not in said


def test_a_process_that_is_killed_between_two_steps_is_an_error_of_the_next(isolate, fmu, temporary):
    unit = isolate(fmu())
    unit.initialise(0)
    unit.exit_initialisation()
    assert unit.do_step(0, STEP).time == STEP
    (process,) = processes(str(temporary))
    os.kill(process, signal.SIGKILL)
    with pytest.raises(
        UnitError, match=r"^faulty at t = 0.01 s: its process was ended from outside with SIGKILL during its step"
    ):
        unit.do_step(STEP, STEP)
    with pytest.raises(UnitError, match=r"its process has ended: its process was ended from outside"):
        unit.refresh() if unit.feedthrough else unit.checkpoint()


def test_values_stay_readable_after_a_crash(isolate, fmu):
    unit = isolate(fmu("segfault", "step"))
    unit.initialise(0)
    unit.exit_initialisation()
    unit.get("y")
    for k in range(5):
        unit.do_step(k * STEP, STEP)
    with pytest.raises(UnitError, match="SIGSEGV"):
        unit.do_step(5 * STEP, STEP)
    assert unit.get("y") == pytest.approx(0.01 * 5, rel=1e-12)


def test_processes_that_an_fmu_started_end_with_it(isolate, fmu, temporary):
    unit = isolate(fmu("start_helper", "step"))
    unit.initialise(0)
    unit.exit_initialisation()
    with pytest.raises(UnitError, match="SIGSEGV"):
        unit.do_step(5 * STEP, STEP)
    assert remaining(str(temporary)) == []


def test_an_error_of_the_fmu_leaves_its_process_alive(isolate, fmu):
    unit = isolate(fmu())
    unit.initialise(0)
    with pytest.raises(UnitError, match=r"^faulty: input u.* is not a finite number"):
        unit.set("u", np.array(np.nan))
    unit.set("u", np.array(2.0))
    unit.exit_initialisation()
    unit.do_step(0, STEP)
    assert unit.get("y") == pytest.approx(0.02, rel=1e-12)
