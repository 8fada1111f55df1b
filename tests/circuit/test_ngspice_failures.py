"""What ngspice and its library can do wrong."""

import os
import subprocess
import sys

import numpy as np
import pytest

from circuit import ngspice
from circuit.netlist import Network
from circuit.unit import CircuitUnit
from cosim.unit import UnitError


def test_a_missing_library_is_one_clear_error(monkeypatch):
    monkeypatch.setattr(ngspice.ctypes.util, "find_library", lambda name: None)
    monkeypatch.setattr(ngspice, "glob", lambda pattern: [])
    monkeypatch.delenv("NGSPICE_LIBRARY_PATH", raising=False)
    with pytest.raises(UnitError, match=r"libngspice is not installed .*libngspice0.*ngspice-lib.*NGSPICE_LIBRARY_PATH"):
        ngspice.find_library()


def run_in_new_process(code, **environment):
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env={**os.environ, **environment}, check=False
    )


_ONE_CIRCUIT = (
    "from circuit.unit import CircuitUnit\nfrom circuit.netlist import Network\nfrom cosim.unit import UnitError\n"
    "try:\n    CircuitUnit('circuit', Network((1,)))\nexcept UnitError as error:\n    print(error)\n"
)


def test_a_wrong_library_path_names_the_path_and_the_packages():
    done = run_in_new_process(_ONE_CIRCUIT, NGSPICE_LIBRARY_PATH="/nowhere/libngspice.so")
    assert "/nowhere/libngspice.so, but there is no such file" in done.stdout
    assert "libngspice0" in done.stdout
    assert done.stderr == ""


def test_a_file_that_is_no_library_is_refused(tmp_path):
    fake = tmp_path / "libngspice.so"
    fake.write_text("not a library")
    done = run_in_new_process(_ONE_CIRCUIT, NGSPICE_LIBRARY_PATH=str(fake))
    assert f"{fake} cannot be loaded" in done.stdout
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("line", "failed"),
    [
        ("Note: Starting dynamic gmin stepping", False),
        ("Note: No compatibility mode selected!", False),
        ("Warning: singular matrix:  check node n1", False),
        ("Using SPARSE 1.3 as Direct Linear Solver", False),
        ("Using KLU as Direct Linear Solver", False),
        ("Trying gmin =   1.0000E-12", False),
        ("Error: no such device or model name rc99", True),
        ("doAnalyses: iteration limit reached, run aborted", True),
        ("Error on line 3 : ...", True),
    ],
)
def test_notes_are_told_from_errors(line, failed):
    assert ngspice.is_error(line) is failed


def test_a_command_that_fails_says_what_ngspice_said():
    unit = CircuitUnit("circuit", Network((1,)))
    unit.set("supply_voltage", np.array(1.0))
    unit.set("resistance", np.array([1.0]))
    unit.initialise(0)
    with pytest.raises(UnitError, match=r"alter rc99.*failed.*rc99"):
        ngspice.simulator().alter([("rc99", 1.0)])


def test_a_value_that_ngspice_would_drop_silently_never_reaches_it():
    with pytest.raises(UnitError, match="rc1 is nan"):
        ngspice.simulator().alter([("rc1", float("nan"))])


def test_a_vector_that_was_not_solved_is_an_error():
    unit = CircuitUnit("circuit", Network((1,)))
    unit.set("supply_voltage", np.array(1.0))
    unit.set("resistance", np.array([1.0]))
    unit.initialise(0)
    with pytest.raises(UnitError, match="holds no nowhere"):
        ngspice.simulator().operating_point([b"nowhere"])


@pytest.mark.parametrize(
    ("index", "what"), [(1, "current of coil"), (3, "breaks Kirchhoff"), (6, "supplies give")]
)
def test_a_solution_that_breaks_kirchhoff_is_not_passed_on(monkeypatch, index, what):
    unit = CircuitUnit("circuit", Network((2, 2)))
    unit.set("supply_voltage", np.array(6.0))
    unit.set("resistance", np.full(4, 2.0))
    honest = type(ngspice.simulator()).operating_point

    def disturbed(engine, vectors):
        values = honest(engine, vectors)
        values[index] *= 1.001
        return values

    monkeypatch.setattr(type(ngspice.simulator()), "operating_point", disturbed)
    with pytest.raises(UnitError, match=what):
        unit.initialise(0)


def test_after_a_failure_the_next_step_solves_again(monkeypatch):
    unit = CircuitUnit("circuit", Network((2,)))
    unit.set("supply_voltage", np.array(6.0))
    unit.set("resistance", np.full(2, 2.0))
    unit.initialise(0)
    unit.set("supply_voltage", np.array(3.0))
    with monkeypatch.context() as patch:
        patch.setattr(type(ngspice.simulator()), "operating_point", lambda *_: np.full(4, np.nan))
        with pytest.raises(UnitError, match="not finite"):
            unit.do_step(0, 1)
    unit.do_step(0, 1)
    assert unit.get("supply_current") == pytest.approx(0.75, rel=1e-12)
