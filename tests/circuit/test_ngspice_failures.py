"""What ngspice and its library can do wrong."""

import os
import subprocess
import sys

import numpy as np
import pytest

from circuit import installation, ngspice
from circuit.netlist import Network
from circuit.unit import CircuitUnit
from cosim.unit.protocol import UnitError


def test_a_missing_library_is_one_clear_error(monkeypatch):
    monkeypatch.setattr(installation.ctypes.util, "find_library", lambda name: None)
    monkeypatch.setattr(installation, "USUAL_PLACES", ())
    monkeypatch.setattr(installation.sys, "prefix", "/nowhere")
    for variable in ("NGSPICE_LIBRARY_PATH", "CONDA_PREFIX"):
        monkeypatch.delenv(variable, raising=False)
    with pytest.raises(
        UnitError, match=r"not found .*libngspice0.*dnf.*ngspice-lib.*Homebrew.*NGSPICE_LIBRARY_PATH"
    ) as e:
        installation.find_ngspice()
    assert "\n" not in str(e.value)
    assert isinstance(e.value, ValueError)  # construction of a unit failed


def run_in_new_process(code, **environment):
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env={**os.environ, **environment}, check=False
    )


_ONE_CIRCUIT = (
    "from circuit.unit import CircuitUnit\nfrom circuit.netlist import Network\n"
    "from cosim.unit.protocol import UnitError\n"
    "try:\n    CircuitUnit('circuit', Network((1,)))\nexcept UnitError as error:\n    print(error)\n"
)


def test_a_wrong_library_path_names_the_path_and_the_packages():
    done = run_in_new_process(_ONE_CIRCUIT, NGSPICE_LIBRARY_PATH="/nowhere/libngspice.so")
    assert "/nowhere/libngspice.so, which does not load" in done.stdout
    assert "libngspice0" in done.stdout
    assert done.stderr == ""


def test_a_file_that_is_no_library_is_refused(tmp_path):
    fake = tmp_path / "libngspice.so"
    fake.write_text("not a library")
    done = run_in_new_process(_ONE_CIRCUIT, NGSPICE_LIBRARY_PATH=str(fake))
    assert f"{fake}, which does not load" in done.stdout
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


def one_circuit(*vectors):
    return ngspice.Circuit("v1 a 0 dc 1\nr1 a 0 1\n.end", vectors or ("a",))


def test_a_command_that_fails_says_what_ngspice_said():
    circuit = one_circuit()
    with pytest.raises(ngspice.NgspiceError, match=r"alter rc99.*no such device.*rc99"):
        circuit.solve({"rc99": 1.0})
    assert circuit.solve({"v1": 2.0}) == [2.0]  # and the circuit goes on
    circuit.remove()


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_a_value_that_ngspice_would_drop_silently_never_reaches_it(value):
    circuit = one_circuit("v1#branch")
    with pytest.raises(ngspice.NgspiceError, match=r"r1 = (nan|-?inf) is not a finite number"):
        circuit.solve({"r1": value})
    assert circuit.solve({}) == [-1.0]
    circuit.remove()


def test_a_vector_that_was_not_solved_is_an_error():
    circuit = one_circuit("a", "nowhere")
    with pytest.raises(ngspice.NgspiceError, match="no finite value of nowhere"):
        circuit.solve({})
    circuit.remove()


def test_a_removed_circuit_is_an_error():
    circuit = one_circuit()
    circuit.remove()
    circuit.remove()
    with pytest.raises(ngspice.NgspiceError, match="was removed"):
        circuit.solve({})


def test_a_netlist_that_ngspice_cannot_read_is_an_error():
    with pytest.raises(ngspice.NgspiceError, match=r"(?i)error"):
        ngspice.Circuit("r1 a 0\nq1 a b c nomodel\n.end", ("a",)).solve({})


def solved_pair_of_strings():
    unit = CircuitUnit("circuit", Network((2, 2), string_resistance=0.5))
    unit.set("supply_voltage", np.array(6.0))
    unit.set("resistance", np.full(4, 2.0))
    unit.initialise(0)
    return unit


class Disturbed:
    """A real circuit, one reading of which is scaled."""

    def __init__(self, circuit, index, factor):
        self.circuit, self.index, self.factor = circuit, index, factor

    def solve(self, changes):
        values = self.circuit.solve(changes)
        values[self.index] *= self.factor
        return values


@pytest.mark.parametrize("error", [1e-3, 1e-9])
@pytest.mark.parametrize(
    ("index", "what"),
    [
        (0, r"coil 1 \(string 1, position 1\) breaks Ohm's law"),
        (1, r"coil 1 \(string 1, position 1\) breaks Ohm's law"),
        (5, r"coil 3 \(string 2, position 1\) breaks Ohm's law"),
        (6, r"source 1 breaks Kirchhoff's current law"),
    ],
)
def test_a_solution_that_breaks_kirchhoff_is_not_passed_on(index, what, error):
    unit = solved_pair_of_strings()
    before = {name: unit.get(name).copy() for name in ("current", "voltage", "supply_power")}
    unit._circuit = Disturbed(unit._circuit, index, 1 + error)
    unit.set("supply_voltage", np.array(5.0))
    with pytest.raises(UnitError, match=r"circuit at t = 2 s: " + what):
        unit.do_step(1_000_000_000, 1_000_000_000)
    for name, value in before.items():
        np.testing.assert_array_equal(unit.get(name), value)


def test_a_resistance_that_ngspice_did_not_take_breaks_ohms_law():
    unit = solved_pair_of_strings()
    unit._altered[1:] = 2.5  # the unit believes that ngspice holds this already
    unit.set("resistance", np.full(4, 2.5))
    with pytest.raises(UnitError, match="breaks Ohm's law"):
        unit.do_step(0, 1)


def test_a_voltage_that_ngspice_did_not_take_breaks_kirchhoffs_voltage_law():
    unit = solved_pair_of_strings()
    unit._altered[0] = 5.0
    unit.set("supply_voltage", np.array(5.0))
    with pytest.raises(UnitError, match="string 1 breaks Kirchhoff's voltage law: -1 V"):
        unit.do_step(0, 1)


def test_after_a_failure_the_next_step_solves_again():
    unit = solved_pair_of_strings()
    unit.set("supply_voltage", np.array(3.0))
    real, unit._circuit = unit._circuit, Disturbed(unit._circuit, 4, np.nan)
    with pytest.raises(UnitError):
        unit.do_step(0, 1)
    unit._circuit = real
    unit.do_step(0, 1)
    # two strings of 4.5 ohm at 3 V; rounding
    assert unit.get("supply_current") == pytest.approx(2 * 3.0 / 4.5, rel=1e-12)


def test_a_user_without_an_entry_in_the_password_database_gets_a_circuit():
    # As in a container that is run with `--user`: libngspice 39 crashes there when it looks for ~/.spiceinit.
    code = (
        "import pwd\n"
        "def none(uid):\n    raise KeyError(f'getpwuid(): uid not found: {uid}')\n"
        "pwd.getpwuid = none\n"
        "import os, pathlib\n"
        "from circuit import ngspice\n"
        "before, seen, write = os.getcwd(), [], pathlib.Path.write_text\n"
        "pathlib.Path.write_text = lambda p, text: seen.append(p.name) or write(p, text)\n"
    )
    done = run_in_new_process(f"{code}{_ONE_CIRCUIT}ngspice.ngspice()\nprint(seen, os.getcwd() == before)\n")
    assert done.stdout == "['.spiceinit'] True\n", done.stderr


@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only root may take another user's number")
def test_a_number_that_no_user_has_does_not_crash_libngspice():
    # Everything is imported before the change, because that user may read neither this clone nor this Python.
    code = (
        "import os, tempfile\nfrom circuit.installation import find_ngspice\nfrom circuit import ngspice\n"
        "from PySpice.Spice.NgSpice.Shared import NgSpiceShared\n"
        "os.chdir('/')\nfind_ngspice()\nos.setgid(54321), os.setuid(54321)\n"
        "print(ngspice._has_entry(), ngspice.Ngspice().version > 0)\n"
    )
    done = run_in_new_process(code, TMPDIR="/tmp")
    assert (done.returncode, done.stdout) == (0, "False True\n"), done.stderr
