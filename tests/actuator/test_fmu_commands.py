"""`cosim fmu build`, `export`, `info`, `validate`."""

import io
import json
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from rich.console import Console

from cosim.fmu_tools.info import read_info, show_info
from cosim.shipped import shipped_actuators

ROOT = Path(__file__).resolve().parents[2]


#: One in each FMI version stands for all: the commands are the same.
BUILT = {("thermal_stiffness", 2), ("polypyrrole_film", 3)}


@pytest.mark.parametrize(
    ("name", "version"),
    [
        pytest.param(name, version, marks=() if (name, version) in BUILT else pytest.mark.slow)
        for name in sorted(shipped_actuators())
        for version in (2, 3)
    ],
)
def test_build_makes_the_same_archive_as_the_makefile_to_the_byte(cosim, fmus, tmp_path, name, version):
    coils = 6 if version == 2 else 36
    answer = cosim("fmu", "build", name, "--fmi", version, "--coils", coils, "--out", tmp_path)
    assert answer.code == 0, answer.err
    suffix = "_n6" if version == 2 else ""
    made = tmp_path / f"{name}_fmi{version}{suffix}.fmu"
    assert str(made) in answer.out
    assert made.read_bytes() == (fmus / made.name).read_bytes()


def test_a_size_of_one_s_own_is_built_into_both_versions(cosim, tmp_path):
    for version in (2, 3):
        file = tmp_path / f"mine{version}.fmu"
        assert cosim("fmu", "export", "tcp_muscle", "--coils", 5, "--fmi", version, "--out", file).code == 0
        found = json.loads(cosim("fmu", "info", file, "--json").out)
        shapes = {v["name"]: v["shape"] for v in found["variables"]}
        assert shapes["stiffness"] == [5]
        assert shapes["ambient_temperature"] == []


def test_an_exported_fmu_holds_sources_and_licence_and_runs_in_fmpy(cosim, tmp_path):
    answer = cosim("fmu", "export", "thermal_stiffness", "--coils", 4, "--fmi", 2, "--out", tmp_path)
    assert answer.code == 0, answer.err
    file = tmp_path / "thermal_stiffness_fmi2_n4.fmu"
    with zipfile.ZipFile(file) as archive:
        names = set(archive.namelist())
        assert b"General Public License" in archive.read("documentation/licenses/license.txt")
    assert {"sources/model.c", "sources/config.h", "documentation/index.html"} <= names
    program = (
        "import sys, fmpy; r = fmpy.simulate_fmu(sys.argv[1], stop_time=1.0, output_interval=0.01,"
        "start_values={'power[1]': 0.4545}, output=['temperature[1]', 'temperature[2]']);"
        "print(repr(float(r['temperature[1]'][-1])), repr(float(r['temperature[2]'][-1])))"
    )
    done = subprocess.run([sys.executable, "-c", program, file], capture_output=True, text=True, check=True)
    hot, cold = map(float, done.stdout.split())
    rate = 90 * 97.85e-6 / (6450 * 7.328e-9 * 837)
    # Equation (3), exact in the FMU; 100 steps add up rounding only.
    assert hot == pytest.approx(295.15 + 0.4545 / (90 * 97.85e-6) * (1 - 2.718281828459045 ** (-rate)), rel=1e-12)
    assert cold == 295.15


def test_info_tells_version_interfaces_structure_states_and_whether_it_is_an_actuator(cosim, fmus):
    answer = cosim("fmu", "info", fmus / "thermal_stiffness_fmi3.fmu")
    assert answer.code == 0
    for line in (
        r"FMI version\s+3\.0",
        r"Co-Simulation\s+can",
        r"Model Exchange\s+can",
        r"structure\s+coils = 36",
        r"continuous states\s+temperature, convected_energy",
        r"actuator\s+yes",
        r"stiffness\s+output\s+Float64\[36\]\s+N/m",
    ):
        assert re.search(line, answer.out), line
    data = json.loads(cosim("fmu", "info", fmus / "niti_kinetics_fmi2.fmu", "--json").out)
    assert data["actuator"] == {"is_actuator": True, "faults": []}
    assert {v["name"]: v["causality"] for v in data["variables"]}["tension"] == "input"


@pytest.mark.parametrize("columns", [80, 200])
def test_info_cuts_no_name_and_no_unit_in_any_terminal(fmus, columns):
    """At 80 columns types, units and start values were one dot each."""
    out, file = io.StringIO(), fmus / "thermal_stiffness_fmi3.fmu"
    show_info(Path(file.name), read_info(file), Console(file=out, width=columns))
    text = out.getvalue()
    assert "…" not in text
    assert re.search(
        r"^heat_transfer_coefficient +parameter +Float64\[36\] +W/\(m\^2\*K\) +[\d.]+ ", text, re.MULTILINE
    )
    assert re.search(r"(^stiffness: |N/m +)Spring constant", text, re.MULTILINE)
    assert max(map(len, text.splitlines())) <= columns


def checks(out):
    """Name of each check to its verdict."""
    return {m[2]: m[1] for m in re.finditer(r"^(pass|FAIL|  - )  ([^:]+):", out, re.MULTILINE)}


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("name", sorted(shipped_actuators()))
def test_every_shipped_actuator_passes_every_check(cosim, fmus, name, version):
    answer = cosim("fmu", "validate", fmus / f"{name}_fmi{version}.fmu")
    found = checks(answer.out)
    assert len(found) == 11
    assert {n for n, v in found.items() if v != "pass"} == set(), answer.out
    assert answer.code == 0


def rebuilt(tmp_path, cosim, change, name="mine"):
    """FMU of the C template with model.c changed."""
    folder = tmp_path / name
    assert cosim("fmu", "new", folder).code == 0
    model = folder / "model.c"
    text = model.read_text()
    assert change(text) != text
    model.write_text(change(text))
    answer = cosim("fmu", "build", folder)
    assert answer.code == 0, answer.err
    return folder / f"{name}_fmi3.fmu"


BROKEN = {
    "crash": (
        lambda t: t.replace("    model_accept(model);\n", "    *(volatile int *)0 = 1;\n"),
        "initialises and steps",
        "the FMU ended the process (SIGSEGV)",
    ),
    "shared memory": (
        lambda t: t.replace("/* Co-Sim", "static double shared;\n\n/* Co-Sim", 1).replace(
            "    model_accept(model);\n", "    shared += 1.0;\n    ARRAY(temperature)[0] += shared;\n"
        ),
        "instances independent",
        "instances share something: temperature differs",
    ),
    "forgetful state": (
        lambda t: t.replace("/* Co-Sim", "static double count;\n\n/* Co-Sim", 1).replace(
            "    model_accept(model);\n", "    count += 1.0;\n    ARRAY(temperature)[0] += count * 1e-6;\n"
        ),
        "restored state replays",
        "after restoring, temperature differs at step 1",
    ),
    "other equation": (
        lambda t: t.replace("/ NUMBER(heat_capacity);", "* 1.01 / NUMBER(heat_capacity);"),
        "CS and ME agree",
        "of its size, more than",
    ),
    "not finite": (
        lambda t: t.replace("ARRAY(rest_length)[i] = NUMBER(coil_rest_length);", "ARRAY(rest_length)[i] = NAN;"),
        "initialises and steps",
        "rest_length[1] = nan m: it must be",
    ),
}


@pytest.mark.parametrize("fault", BROKEN)
def test_each_kind_of_fault_fails_its_own_check_and_the_rest_is_still_reported(cosim, tmp_path, fault):
    change, check, what = BROKEN[fault]
    answer = cosim("fmu", "validate", rebuilt(tmp_path, cosim, change))
    found = checks(answer.out)
    assert answer.code == 1
    assert found[check] == "FAIL"
    assert what in answer.out.replace("-nan", "nan")
    assert len(found) == 11
    assert found["model description"] == found["exported functions"] == "pass"


def test_an_fmu_that_is_no_actuator_is_not_measured_as_one(cosim, fmus, tmp_path):
    # Another name for every output of the interface: a sound FMU, but no actuator.
    with zipfile.ZipFile(fmus / "thermal_stiffness_fmi3.fmu") as old, zipfile.ZipFile(tmp_path / "o.fmu", "w") as new:
        for name in old.namelist():
            data = old.read(name)
            if name == "modelDescription.xml":
                data = re.sub(rb'name="(stiffness|rest_length|resistance)"', rb'name="my_\1"', data)
            new.writestr(name, data)
    answer = cosim("fmu", "validate", tmp_path / "o.fmu")
    assert checks(answer.out)["actuator interface"] == "  - "
    assert answer.code == 0, answer.out


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (("build", "no_such_thing"), "there is no such folder and no such actuator"),
        (("export", "no_such_thing"), "there is no such actuator"),
        (("build", "tcp_muscle", "--fmi", "4"), "there is no FMI 4"),
        (("info", "no.fmu"), "there is no such FMU"),
        (("validate", "no.fmu"), "there is no such FMU"),
        (("new", "Two Words"), "cannot name an actuator"),
        (("new", "tcp_muscle"), "is the name of a shipped actuator"),
    ],
)
def test_what_a_user_gives_wrongly_is_one_clear_error(cosim, tmp_path, monkeypatch, arguments, what):
    monkeypatch.chdir(tmp_path)
    answer = cosim("fmu", *arguments)
    assert answer.code == 2
    assert what in answer.err
    assert "remedy:" in answer.err
    assert list(tmp_path.iterdir()) == []


def test_a_compile_error_is_shown_with_its_line(cosim, tmp_path):
    folder = tmp_path / "mine"
    assert cosim("fmu", "new", folder).code == 0
    model = folder / "model.c"
    model.write_text(model.read_text().replace("ARRAY(rest_length)[i] =", "ARRAY(rest_lenght)[i] ="))
    answer = cosim("fmu", "build", folder)
    assert answer.code == 2
    assert "it does not compile" in answer.err
    assert "rest_lenght" in answer.err


def test_no_compiler_is_one_clear_error(cosim, tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    answer = cosim("fmu", "build", "tcp_muscle", "--out", tmp_path)
    assert answer.code == 2
    assert "there is no such C compiler" in answer.err
