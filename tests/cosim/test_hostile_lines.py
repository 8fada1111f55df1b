"""Command lines that nobody means: one error that says what to do, exit code 2, nothing left behind, nothing lost."""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from .conftest import ROOT, finish
from .hostile_lines import REFUSED, lay


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with all files; its name has a blank and an umlaut."""
    folder = tmp_path_factory.mktemp("Prüf stand")
    lay(folder)
    pytest.importorskip("cv2")  # half a second that is not the command's
    return folder


def words(line, place):
    """Arguments of a line of `REFUSED`."""
    found = []
    for word in shlex.split(line):
        if word == "@no" or word.startswith("@no."):  # below a file no folder can be made, not even by root
            found.append(str(place / "empty.txt" / "x") + word.removeprefix("@no"))
        else:
            found.append(str(place / word[1:]) if word.startswith("@") else word)
    return found


def content(folder):
    """Every file with its bytes, every folder."""
    return {str(p): p.read_bytes() if p.is_file() else None for p in folder.rglob("*")}


@pytest.mark.parametrize("line", REFUSED)
def test_a_command_line_that_nobody_means_is_refused(cosim, place, tmp_path, monkeypatch, line):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "300")
    before, begin = content(place), time.process_time()
    answer = cosim(*words(line, place))
    assert time.process_time() - begin < 2.0
    assert answer.code == 2, answer
    assert "Traceback" not in answer.err
    if answer.err.startswith("Usage:"):  # said by the parser of arguments: it names the option
        assert answer.err.count("Invalid value for") == 1
    else:
        errors = [text for text in answer.err.splitlines() if text.startswith("error: ")]
        assert len(errors) == 1, answer.err
        assert "\n  remedy: " in answer.err
    assert content(place) == before
    assert not list(tmp_path.iterdir())


def test_there_are_lines_for_every_subcommand():
    names = {line.split()[0] for line in REFUSED}
    assert len(names) == 12
    counted = {name: sum(line.startswith(f"{name} ") for line in REFUSED) for name in names}
    assert min(counted.values()) >= 6, counted
    assert len(REFUSED) >= 200
    assert len(set(REFUSED)) == len(REFUSED)


def test_what_would_cost_a_long_run_is_said_before_it(cosim, tmp_path, monkeypatch):
    """Wrong channels, sensors and folders were found when the run was over, and its values were gone."""
    monkeypatch.setattr("cosim.run.run", lambda *_: pytest.fail("it was run"))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").touch()
    (tmp_path / "sensors.yaml").write_text("default: {rate: 1e12 Hz}\n")
    for options in (
        ("--channels", "coil[99].temperature", "--out", "r"),
        ("--sensor", "sensors.yaml", "--out", "r"),
        ("--out", "file/r"),
    ):
        answer = cosim("record", "prototype_cantilever", *options)
        assert answer.code == 2, answer
        assert "remedy:" in answer.err


@pytest.mark.parametrize(
    "line",
    ["list", "schema", "fmu info {fmu}", "fmu info {fmu} --json", "validate tclab", "validate tclab tclab", "--help"],
)
def test_a_reader_that_has_enough_is_no_error(shipped_fmus, line):
    """`cosim schema | head -1` must neither show a traceback nor complain."""
    fmu = next(Path(shipped_fmus).glob("*.fmu"))
    command = [sys.executable, "-m", "cosim.cli", *line.format(fmu=shlex.quote(str(fmu))).split()]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(command, stdout=write, stderr=subprocess.PIPE, text=True, env=environment, check=False)
    os.close(write)
    assert "Traceback" not in done.stderr, done.stderr
    assert "Exception ignored" not in done.stderr, done.stderr
    assert "Errno 32" not in done.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no device that is always full")
@pytest.mark.parametrize("line", ["list", "schema", "validate tclab", "fmu info {fmu} --json", "--help"])
def test_an_output_that_has_no_room_is_said(shipped_fmus, line):
    """`cosim schema > file` on a full disk was a traceback, or ended well with half a file."""
    fmu = next(Path(shipped_fmus).glob("*.fmu"))
    command = [sys.executable, "-m", "cosim.cli", *line.format(fmu=shlex.quote(str(fmu))).split()]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            command,
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            check=False,
        )
    assert done.returncode == 1, done.stderr
    assert done.stderr.splitlines() == [
        "error: the output: it cannot be written: No space left on device",
        "  remedy: make room on the disk, and repeat the command",
    ]


def test_a_folder_that_was_removed_under_the_command_is_said(start, tmp_path):
    gone = tmp_path / "gone"
    gone.mkdir()
    answer = finish(start("validate", "tclab", prelude=f"import os; os.chdir({str(gone)!r}); os.rmdir({str(gone)!r})"))
    assert answer.code == 2, answer
    assert "Traceback" not in answer.err
    assert "remedy: go to a folder that exists" in answer.err


def test_ctrl_c_where_nothing_handles_it_is_said(start):
    stop = "def stop(*_): raise KeyboardInterrupt"
    prelude = f"import cosim.scenario\n{stop}\ncosim.scenario.load_scenario = stop"
    answer = finish(start("validate", "tclab", prelude=prelude))
    assert (answer.code, answer.err.strip()) == (130, "interrupted"), answer


SWEEP = str(ROOT / "docs" / "examples" / "sweeps" / "voltage_and_convection.yaml")


@pytest.mark.parametrize(
    ("line", "sign"),
    [
        (("sweep", SWEEP, "--jobs", "1", "--out", "{out}"), "out/runs"),
        (("record", "tclab", "--set", "time.stop=1000000 s", "--out", "{out}"), ""),
        (("compare", "hanging_coils", "--jobs", "1", "--out", "{out}"), "out/*/checkpoints"),
    ],
    ids=["sweep", "record", "compare"],
)
def test_ctrl_c_in_the_middle_ends_with_130_and_says_what_is_kept(start, tmp_path, line, sign):
    out = tmp_path / "out"
    process = start(*(w.format(out=out) for w in line))
    end = time.monotonic() + 60
    while process.poll() is None and time.monotonic() < end and not (sign and list(tmp_path.glob(sign))):
        time.sleep(0.05 if sign else 4.0)
        if not sign:
            break
    process.send_signal(signal.SIGINT)
    answer = finish(process)
    assert answer.code == 130, answer
    assert "Traceback" not in answer.err, answer.err
    assert "interrupted" in answer.err
