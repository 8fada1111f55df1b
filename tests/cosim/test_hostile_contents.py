"""Files whose names are right and whose contents nobody means: one error that says what to do, exit code 2."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

import pytest

from cosim.unit.quantity import parse_unit

from .conftest import ROOT, finish

COIL = (ROOT / "docs" / "examples" / "sweeps" / "one_coil.yaml").read_text()
ROWS = "".join(f"{n},{20 + n * 0.01}\n" for n in range(200))
GOOD = "time,T1\n" + ROWS
SIDECAR = """title: t
table: data.csv
time: {column: time, unit: s}
channels:
  heaters.temperature[1]: {column: T1, unit: degC}
"""


def stop(text: str) -> str:
    """The scenario with another end."""
    return re.sub(r"stop: [^,}]*", lambda _: f"stop: {text}", COIL, count=1)


#: Scenario, and what its error must name.
SCENARIOS = {
    "a key twice": (COIL.replace("components:", "components: {}\ncomponents:", 1), "`components` stands twice"),
    "a component twice": (
        COIL.replace("  actuator:", "  actuator: {kind: x}\n  actuator:", 1),
        "`actuator` stands twice",
    ),
    "tabs": (COIL.replace("  ", "\t"), "not valid YAML"),
    "two documents": (f"{COIL}\n---\n{COIL}", "another document"),
    "a call": ("!!python/object/apply:os.system ['true']\n", "not valid YAML"),
    "itself": ("&a [*a]\n", "a scenario is a mapping"),
    "itself as a title": ("title: &a {x: *a}\n", "title: a mapping"),
    "UTF-16": (COIL.encode("utf-16"), "is no UTF-8"),
    "Latin-1": (COIL.replace("title:", "title: Prüfstand #", 1).encode("latin-1"), "is no UTF-8"),
    "no key": (f"{COIL}\n~: 3\n", "is no key"),
    "a list as a key": (f"{COIL}\n? [a, b]\n: 3\n", "is no key"),
    "a negative end": (stop("-5 s"), "must come after start"),
    "an endless end": (stop("1e300 s"), "is too long for simulated time"),
    "an end of the largest number": (stop("1.7e308 s"), "is too long for simulated time"),
    "an end that is no number": (stop("nan s"), "is not a number with a unit"),
    "a step below all": (
        re.sub(r"macro_step: [^,}]*", "macro_step: 1e-320 s", COIL, count=1),
        "less than a nanosecond",
    ),
    "a tower of powers": (stop("5 s**9**9**9**9"), "powers are of units"),
    "a unit of 40,000 letters": (stop("5 " + "s*" * 20_000 + "s"), "40001 letters"),
    "a unit that is a call": (stop("5 __import__('os').getcwd()"), "is not a unit"),
    "a path as a name": (COIL.replace("actuator:", '"../../x":', 1), "is not a name"),
    "an empty name": (COIL.replace("actuator:", '"":', 1), "is not a name"),
}
#: Table, change of recording.yaml, and what the error must name.
RECORDINGS = {
    "NUL": (GOOD.replace("20.05", "20\0.05"), "", "is no number"),
    "UTF-16": (GOOD.encode("utf-16"), "", "it is not saved as UTF-8"),
    "one column": ("time\n1\n2\n", "", "there is no column `T1`"),
    "a header alone": ("time,T1\n", "", "has no rows"),
    "nothing": ("", "", "cannot be read as a table"),
    "empty lines": ("\n\n\n", "", "cannot be read as a table"),
    "times that fall": ("time,T1\n" + "".join(f"{-n},20\n" for n in range(200)), "", "do not rise"),
    "one time": ("time,T1\n" + "1,20\n" * 200, "", "do not rise"),
    "values beyond all": ("time,T1\n" + "".join(f"{n},1e999\n" for n in range(200)), "", "no sensor reads"),
    "values of 5000 digits": (f"time,T1\n0,{'9' * 5000}\n" + ROWS, "", "is no number"),
    "no values": ("time,T1\n" + "".join(f"{n},\n" for n in range(200)), "", "has 0 values"),
    "a column twice": ("time,T1,T1\n" + "".join(f"{n},20,99\n" for n in range(200)), "", "is there 2 times"),
    "an open quote": ('time,T1\n"0,20\n1,21\n', "", "cannot be read as a table"),
    "a table elsewhere": (GOOD, "s/data.csv/..\\/..\\/nowhere.csv/", "there is no such table"),
    "a folder as a table": (GOOD, "s/data.csv/./", "there is no such table"),
    "endless noise": (GOOD, "s/unit: degC/unit: degC, noise: 1e308 degC/", "is too large"),
    "negative noise": (GOOD, "s/unit: degC/unit: degC, noise: -1 degC/", "is not positive"),
    "a factor of 0": (GOOD, "s/unit: degC/unit: degC, factor: 0/", "a factor of 0"),
    "an end before the begin": (GOOD, "+begin: 50 s\nend: 10 s\n", "must come after begin"),
    "a doubt of nobody": (GOOD, "+uncertain: {nobody.x: 1 degC}\n", "no such number"),
    "a doubt of an element that is not there": (
        GOOD,
        "+uncertain: {'heaters.initial_temperature[7]': 1 K}\n",
        "elements",
    ),
    "overrides of themselves": (GOOD, "+overrides: &a {components: *a}\n", "components.components"),
}


def refused(answer, words: str) -> None:
    """One error with a remedy, and the words in it."""
    assert answer.code == 2, answer
    assert "Traceback" not in answer.err
    assert sum(line.startswith("error: ") for line in answer.err.splitlines()) == 1, answer.err
    assert "\n  remedy: " in answer.err
    assert words in answer.err, answer.err


def write(path: Path, content: str | bytes) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize("case", SCENARIOS)
def test_a_scenario_is_refused(cosim, tmp_path, case):
    content, words = SCENARIOS[case]
    refused(cosim("validate", write(tmp_path / "scenario.yaml", content)), words)


@pytest.mark.parametrize("case", RECORDINGS)
def test_a_recording_is_refused(cosim, tmp_path, case):
    table, change, words = RECORDINGS[case]
    sidecar = SIDECAR
    if change.startswith("s/"):
        before, after = re.split(r"(?<!\\)/", change)[1:3]
        sidecar = sidecar.replace(before, after.replace("\\/", "/"))
    elif change:
        sidecar += change[1:]
    write(tmp_path / "r" / "data.csv", table)
    write(tmp_path / "r" / "recording.yaml", sidecar)
    refused(cosim("recording", "check", tmp_path / "r", "--scenario", "tclab"), words)


def test_a_terminal_that_lacks_a_letter_ends_no_command(start, tmp_path):
    scenario = write(tmp_path / "Prüf 🧵.yaml", COIL)
    answer = finish(start("validate", scenario, PYTHONIOENCODING="ascii"))
    assert answer.code == 0, answer
    assert r"\U0001f9f5.yaml: valid" in answer.out


def test_a_title_does_not_steer_the_terminal(cosim, tmp_path):
    write(tmp_path / "r" / "data.csv", b"\xef\xbb\xbf" + GOOD.encode())  # as spreadsheets begin a table in UTF-8
    write(tmp_path / "r" / "recording.yaml", SIDECAR.replace("title: t", 'title: "\\e[2Jcold"'))
    answer = cosim("recording", "check", tmp_path / "r", "--scenario", "tclab")
    assert answer.code == 0, answer
    assert "cold" in answer.out
    assert "\x1b[2J" not in answer.out


@pytest.mark.parametrize(
    ("text", "is_unit"),
    [
        ("9**9**9**9", False),
        ("9²²²²²²²²", False),
        ("((9)**9)**99", False),
        ("1000000000000**999", False),
        ("s**2**2", False),
        ("m**2", True),
        ("(m/s)**2", True),
        ("m²", True),
        ("kg*m^2/s^3", True),
        ("inH2O", True),
    ],
)
def test_a_unit_is_no_arithmetic(text, is_unit):
    """Each took hours or all memory before, or is what people write."""
    if is_unit:
        assert parse_unit(text) is parse_unit(text)
    else:
        with pytest.raises(ValueError, match="is not a unit"):
            parse_unit(text)


def test_a_folder_whose_name_is_no_utf8_is_refused_before_the_run(cosim, tmp_path):
    """Its results were lost at the end: NetCDF has no such name."""
    scenario = write(tmp_path / "s.yaml", COIL)
    refused(cosim("run", scenario, "--no-plots", "--out", tmp_path / "\udcff\udcfe"), "is no UTF-8")
    assert [p.name for p in tmp_path.iterdir()] == ["s.yaml"]


def repacked(source: Path, target: Path, **changes: bytes) -> Path:
    """An FMU with other contents: `library`, `description` or an `entry` of a name beside them."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            if name.endswith(".so"):
                content = changes.get("library", content)
            elif name == "modelDescription.xml":
                content = changes.get("description", content)
            new.writestr(name, content)
    return target


def scenario_with(fmu: Path) -> str:
    return (
        "title: t\ntime: {stop: 1 s, macro_step: 100 ms, output_step: 100 ms}\n"
        f"components:\n  a: {{kind: fmu, fmu: {fmu.name}}}\nconnections: []\n"
    )


@pytest.mark.parametrize(
    ("kept", "words"),
    [
        (0, "file too short"),
        (3000, "thermal_stiffness.so is cut off"),  # the loader mapped it, and the process ended by SIGBUS
        (-0x8000, "thermal_stiffness.so is cut off"),
        (None, "invalid ELF header"),
    ],
)
def test_a_library_that_is_cut_off_ends_no_process(cosim, shipped_fmus, tmp_path, kept, words):
    source = Path(shipped_fmus) / "thermal_stiffness_fmi2.fmu"
    with zipfile.ZipFile(source) as archive:
        whole = next(archive.read(n) for n in archive.namelist() if n.endswith(".so"))
    fmu = repacked(source, tmp_path / "cut.fmu", library=b"no library\n" * 99 if kept is None else whole[:kept])
    refused(cosim("validate", write(tmp_path / "s.yaml", scenario_with(fmu))), words)


def test_a_model_identifier_leads_to_no_library_outside_the_archive(cosim, shipped_fmus, tmp_path):
    source = Path(shipped_fmus) / "thermal_stiffness_fmi2.fmu"
    with zipfile.ZipFile(source) as archive:
        description = archive.read("modelDescription.xml")
    changed = description.replace(b'modelIdentifier="thermal_stiffness"', b'modelIdentifier="../../../tmp/x"')
    assert changed != description
    fmu = repacked(source, tmp_path / "path.fmu", description=changed)
    refused(cosim("validate", write(tmp_path / "s.yaml", scenario_with(fmu))), "is no name of a file")
