"""Endless steps, leaks and floods: what a unit may take, and what is said when it takes more."""

import os
import re
import signal
import time

import pytest
import xarray as xr

from cosim.isolation.ending import last_lines
from cosim.run import RunStopped, run
from cosim.unit.errors import InputError
from cosim.unit.protocol import UnitError

from .conftest import processes, rising

STEP = 10_000_000
MEGABYTE = 1_000_000


def begin(unit):
    unit.initialise(0)
    unit.exit_initialisation()
    return unit


def with_limits(scenario, **limits):
    text = ", ".join(f"{key}: {value}" for key, value in limits.items())
    return lambda fmus: scenario(fmus, isolation=f"{{kind: process, {text}}}")


def test_an_endless_step_is_ended_and_the_values_before_it_are_kept(tmp_path, fmu, scenario):
    limited = with_limits(scenario, step_limit="1.5 s")
    what = r"^faulty at t = 0.05 s: fmi2DoStep did not return within 1.5 s \(raise isolation.step_limit"
    with pytest.raises(RunStopped, match=what):
        run(limited({"faulty": fmu("never_return", "step")}), tmp_path / "run")
    kept = xr.load_dataset(tmp_path / "run" / "results.nc")
    assert kept["faulty.y"].values.tolist() == rising(6)


@pytest.mark.parametrize(
    ("place", "what"),
    [
        ("load", "its construction did not return within 1.5 s"),
        ("instantiate", "fmi2Instantiate did not return within 1.5 s"),
        ("initialise", "fmi2EnterInitializationMode did not return within 1.5 s"),
    ],
)
def test_an_endless_beginning_is_an_input_error(tmp_path, fmu, scenario, place, what):
    limited = with_limits(scenario, step_limit="1.5 s")
    with pytest.raises(InputError, match=what) as refused:
        run(limited({"faulty": fmu("never_return", place)}), tmp_path / "run")
    assert refused.value.key == "components.faulty"


def test_an_endless_end_is_a_warning(tmp_path, fmu, scenario, caplog):
    limited = with_limits(scenario, step_limit="1.5 s")
    run(limited({"faulty": fmu("never_return", "free_instance")}), tmp_path / "run")
    (line,) = caplog.messages
    assert "faulty at t = 0.1 s: fmi2FreeInstance did not return within 1.5 s" in line
    assert xr.load_dataset(tmp_path / "run" / "results.nc").sizes["time"] == 11


def test_a_process_that_stands_still_is_ended_too(isolate, fmu, temporary):
    unit = begin(isolate(fmu(), step_limit=1.5))
    (process,) = processes(str(temporary))
    os.kill(process, signal.SIGSTOP)
    with pytest.raises(UnitError, match=r"its step did not return within 1\.5 s"):
        unit.do_step(0, STEP)


def test_a_leak_ends_at_the_memory_limit_which_is_named(tmp_path, fmu, scenario):
    limited = with_limits(scenario, memory_limit="600 MB")
    what = (
        r"faulty at t = 0.05 s: its process crashed with SIGSEGV .* in fmi2DoStep; it had used (\d+) MB of the 600 MB"
    )
    with pytest.raises(RunStopped, match=what) as stopped:
        run(limited({"faulty": fmu("leak", "step")}), tmp_path / "run")
    used = float(re.search(what, stopped.value.reason)[1])
    # The last block of 4 MB did not fit. The resident set holds 40 MB of files beside what is limited, lacks what was
    # reserved and not touched, and Linux adds it up late on machines of many processors: 473 MB were seen.
    assert 360 <= used <= 700
    kept = xr.load_dataset(tmp_path / "run" / "results.nc")
    assert kept["faulty.y"].values.tolist() == rising(6)


def test_memory_that_is_never_touched_counts_too_and_a_refusal_names_it(isolate, fmu):
    unit = begin(isolate(fmu("hoard", "step"), memory_limit=600 * MEGABYTE))
    what = r"^faulty at t = [\d.]+ s: fmi2DoStep returned error: no more memory; it had used (\d+) MB of the 600 MB"
    with pytest.raises(UnitError, match=what) as refused:
        [unit.do_step(k * STEP, STEP) for k in range(100)]
    # A block of 21 MB did not fit any more.
    assert 570 <= float(re.search(what, str(refused.value))[1]) <= 600


def test_a_limit_below_what_the_interpreter_needs_is_refused(tmp_path, fmu, scenario):
    limited = with_limits(scenario, memory_limit="5 MB")
    with pytest.raises(InputError, match=r"uses \d+ MB before the FMU is loaded, more than its limit of 5 MB"):
        run(limited({"faulty": fmu()}), tmp_path / "run")


def test_a_flood_of_output_neither_blocks_nor_reaches_the_terminal(tmp_path, fmu, scenario, capfd):
    dataset = run(scenario({"faulty": fmu("flood", "step")}))
    assert dataset["faulty.y"].values.tolist() == rising(11)
    assert capfd.readouterr() == ("", "")


def test_a_flood_while_nobody_waits_does_not_block_for_ever(isolate, fmu):
    units = [begin(isolate(fmu("flood", "step"), name=name)) for name in ("first", "second")]
    for unit in units:
        unit.begin_step(5 * STEP, STEP)
    time.sleep(0.2)  # both have filled their pipes by now
    assert [unit.finish_step().time for unit in reversed(units)] == [6 * STEP] * 2


def test_the_last_lines_before_a_crash_belong_to_the_error(isolate, fmu):
    unit = begin(isolate(fmu("flood_and_crash", "step")))
    with pytest.raises(UnitError, match=r"SIGSEGV") as crashed:
        unit.do_step(5 * STEP, STEP)
    said = crashed.value.what.partition("; it printed last: ")[2].split(" | ")
    # Both streams reach one pipe, line by line. Nothing that a terminal would obey is left.
    assert said == [
        "line 19998 of the flood, long enough to fill a pipe soon",
        "error 19998 of the flood",
        "line 19999 of the flood, long enough to fill a pipe soon",
        "error 19999 of the flood",
        "[2Jthe last words",
    ]


def test_control_characters_and_long_lines_do_not_reach_an_error():
    assert (
        last_lines(b"\x1b[2Jred\x07\n\n" + b"x" * 500 + b"\n\xff\n")
        == "; it printed last: [2Jred | " + ("x" * 200) + " | \ufffd"
    )
    assert last_lines(b"\n \n") == ""
