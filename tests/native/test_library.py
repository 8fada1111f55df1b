"""What happens where the compiled library is missing or does not fit."""

from __future__ import annotations

import subprocess

import numpy as np
import pytest

from cosim.algorithms.algorithm import Plain
from cosim.algorithms.choose import PLAIN
from cosim.loop import NativeLoop, PythonLoop, Watched, choose_loop
from cosim.native import compiled as module
from cosim.native.compiled import LibraryAbsent, library, tell_once
from cosim.native.csv_file import CsvWriter
from cosim.native.layout import LAYOUT_VERSION
from cosim.native.plan import Grid
from cosim.observers.energy_balance import EnergyMeter
from cosim.observers.trace import Trace
from cosim.system import System
from tests.native.both_loops import fmu

MS = 1_000_000


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """The library is looked for in an empty folder; a reason may be told once more."""
    path = tmp_path / "stepper.so"
    monkeypatch.setattr(module, "library_path", lambda: path)
    monkeypatch.setattr(module, "_told", set())
    return path


def test_the_library_is_built_and_fits():
    assert library().cosim_layout_version() == LAYOUT_VERSION


def test_a_missing_library_says_how_to_build_it(elsewhere):
    with pytest.raises(LibraryAbsent, match=r"stepper.so is not built; build it with `pip install -e .` \(needs gcc\)"):
        library()


def test_a_file_that_is_no_library_says_so(elsewhere):
    elsewhere.write_text("no library")
    with pytest.raises(LibraryAbsent, match=r"stepper\.so cannot be loaded"):
        library()


@pytest.mark.parametrize(
    ("source", "problem"),
    [
        ("int cosim_layout_version(void) { return 0; }", "is older than its Python side"),
        ("int something_else(void) { return 0; }", "cannot be loaded .*cosim_layout_version"),
    ],
)
def test_a_library_of_other_sources_is_refused(elsewhere, source, problem):
    command = ["gcc", "-shared", "-fPIC", "-x", "c", "-o", elsewhere, "-"]
    subprocess.run(command, input=source, text=True, check=True)
    with pytest.raises(LibraryAbsent, match=problem):
        library()


def test_the_loop_in_python_runs_without_it_and_says_why_once(elsewhere, scripted, capsys):
    system = System({"a": fmu("a", scripted[3])}, [])
    system.initialise(0, {})
    watched = Watched(system, Trace(system, range(0, 10 * MS, MS)), EnergyMeter(system), Grid(0, MS, 1))
    loops = [choose_loop(watched, Plain(PLAIN["jacobi"]), "jacobi") for _ in range(2)]
    system.terminate()
    assert [(type(loop), loop.language) for loop in loops] == [(PythonLoop, "Python")] * 2
    assert capsys.readouterr().err.count("stepper.so is not built") == 1


def test_the_native_loop_is_chosen_where_it_is_there(scripted):
    system = System({"a": fmu("a", scripted[3])}, [])
    system.initialise(0, {})
    watched = Watched(system, Trace(system, range(0, 10 * MS, MS)), EnergyMeter(system), Grid(0, MS, 1))
    loop = choose_loop(watched, Plain(PLAIN["jacobi"]), "jacobi")
    system.terminate()
    assert (type(loop), loop.language) == (NativeLoop, "C")


def test_csv_is_written_without_it(elsewhere, tmp_path):
    with (tmp_path / "run.csv").open("wb") as file:
        CsvWriter(file, np.array([0.0, 0.1]), []).write(2)
    assert (tmp_path / "run.csv").read_bytes() == b"time [s]\n0.0\n0.1\n"


def test_a_reason_is_told_once(monkeypatch, capsys):
    monkeypatch.setattr(module, "_told", set())
    tell_once("one")
    tell_once("two")
    tell_once("one")
    assert capsys.readouterr().err == "cosim: the loop runs in Python: one\ncosim: the loop runs in Python: two\n"
