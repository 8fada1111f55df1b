"""Two commands into one folder at once: one refuses, nothing is corrupted; a killed one keeps nobody out."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray as xr

from cosim.alone import LOCK, alone
from cosim.run import run
from cosim.unit.errors import InputError

from .conftest import ROOT, finish
from .hostile_lines import lay
from .short_runs import heating, shortened
from .test_command_line import file

SWEEP = ROOT / "docs" / "examples" / "sweeps" / "voltage_and_convection.yaml"
DESIGN = ROOT / "docs" / "examples" / "design" / "small.yaml"


def until(condition, process):
    """Wait for something that a process does."""
    end = time.monotonic() + 60.0
    while not condition() and process.poll() is None and time.monotonic() < end:
        time.sleep(0.01)
    assert condition(), finish(process)


COMMANDS = {
    "run": ("run", "tclab", "--no-plots"),
    "run that goes on": ("run", "tclab", "--no-plots", "--resume"),
    "run that overwrites": ("run", "tclab", "--no-plots", "--overwrite"),
    "ensemble": ("run", "passive_drape", "--no-plots", "--starts", "2"),
    "sweep": ("sweep", SWEEP),
    "sweep that goes on": ("sweep", SWEEP, "--resume"),
    "design": ("design", DESIGN),
    "comparison": ("compare", "hanging_coils"),
    "record": ("record", "tclab"),
    "reproduction": ("reproduce",),
    "proof": ("prove", "--cases", "1", "--no-baselines"),
    "tracking": ("track", "@film", "--rig", "@rig.yaml"),
    "rendering": ("record", "passive_drape", "--video", "@camera.yaml"),
    "recording begun": ("recording", "new", "@tracks.csv", "--scenario", "tclab"),
    "tracks imported": ("recording", "import", "@tracks.csv", "--as", "@as.yaml"),
    "SSP imported": ("ssp", "import", "@no_structure.ssp"),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_whatever_is_at_work_in_a_folder_keeps_all_others_out(cosim, tmp_path, name):
    """A sweep was let into the folder of a run: each looked for its own kind alone; some looked for none."""
    out, files = tmp_path / "out", tmp_path / "files"
    files.mkdir()
    lay(files)
    words = [str(files / w[1:]) if str(w).startswith("@") else w for w in COMMANDS[name]]
    with alone(out, "run"):
        (out / "scenario.yaml").write_text("title: mine\n")
        answer = cosim(*words, "--out", out)
        assert answer.code == 2, answer
        assert answer.err.count("error:") == 1
        assert f"error: {out}: another run is at work in this folder (process {os.getpid()})" in answer.err
        assert "remedy: wait for it, or give another folder with `--out`" in answer.err
        assert sorted(p.name for p in out.iterdir()) == [LOCK, "scenario.yaml"]
        assert (out / "scenario.yaml").read_text() == "title: mine\n"
    assert not (out / LOCK).exists()


def test_two_that_go_on_at_once_are_one_and_the_result_is_whole(start, tmp_path):
    scenario = shortened("passive_drape", "1 s", checkpoint_step="0.1 s")
    path, out = file(tmp_path, scenario), tmp_path / "run"
    first = start("run", path, "--out", out, "--no-plots")
    until(lambda: list(out.glob("checkpoints/*.npz")), first)
    first.send_signal(signal.SIGINT)
    assert finish(first).code == 130
    both = [start("run", out, "--resume", "--no-plots") for _ in range(2)]
    answers = sorted((finish(p) for p in both), key=lambda a: a.code)
    assert [a.code for a in answers] == [0, 2], answers
    refused = answers[1].err
    assert "is at work in this folder" in refused or "this run is complete" in refused
    whole, resumed = run(scenario), xr.load_dataset(out / "results.nc")
    assert all((resumed[name].values == whole[name].values).all() for name in whole.data_vars)


def test_what_was_killed_keeps_nobody_out(start, cosim, tmp_path):
    """The file is left behind; the system freed its lock."""
    scenario = shortened("passive_drape", "0.6 s", checkpoint_step="0.1 s")
    path, out = file(tmp_path, scenario), tmp_path / "run"
    process = start("run", path, "--out", out, "--no-plots")
    until(lambda: list(out.glob("checkpoints/*.npz")), process)
    assert cosim("run", path, "--out", out, "--resume", "--no-plots").code == 2
    process.kill()
    assert finish(process).code == -signal.SIGKILL
    assert (out / LOCK).read_text() == f"run {process.pid}"
    assert cosim("run", out, "--resume", "--no-plots").code == 0
    assert not (out / LOCK).exists()
    whole, resumed = run(scenario), xr.load_dataset(out / "results.nc")
    assert all((resumed[name].values == whole[name].values).all() for name in whole.data_vars)


def test_a_file_system_without_locks_is_said(tmp_path, monkeypatch):
    def refuse(*_: object) -> None:
        raise OSError(37, "No locks available")

    monkeypatch.setattr("cosim.alone.fcntl.flock", refuse)
    with pytest.raises(InputError, match=r"it cannot be locked.*No locks available"), alone(tmp_path / "run", "run"):
        pass


def test_an_ssp_is_not_imported_over_one_that_is_running(cosim, tmp_path):
    """The folder `imported` was replaced before anybody looked whether it was in use."""
    package = tmp_path / "heating.ssp"
    assert cosim("ssp", "export", file(tmp_path, heating()), "--out", package).code == 0
    out = tmp_path / "out"
    with alone(out, "run"):
        (out / "imported").mkdir()
        (out / "imported" / "scenario.yaml").write_text("in use")
        answer = cosim("run", package, "--out", out, "--no-plots")
        assert answer.code == 2
        assert "another run is at work" in answer.err
        assert (out / "imported" / "scenario.yaml").read_text() == "in use"


def test_the_lock_is_no_part_of_what_is_kept(cosim, tmp_path):
    assert cosim("run", file(tmp_path, heating()), "--out", tmp_path / "run", "--no-plots").code == 0
    assert LOCK not in {p.name for p in Path(tmp_path / "run").iterdir()}


def test_figures_are_not_drawn_into_a_run_that_is_at_work(cosim, tmp_path):
    """`--overwrite` removes the figures of the run before while another command draws them."""
    out = tmp_path / "run"
    assert cosim("run", file(tmp_path, heating()), "--out", out, "--no-plots").code == 0
    with alone(out, "run"):
        answer = cosim("plot", out)
        assert answer.code == 2
        assert f"error: {out}: another run is at work in this folder" in answer.err
        assert not (out / "figures").exists()
    assert cosim("plot", out).code == 0


#: Slow commands, and the line of their program at which they are killed.
KILLED = {
    "track": ("chainmail.camera.measure.measure", ("track", "@film", "--rig", "@rig.yaml")),
    "import": (
        "chainmail.camera.importing.imported",
        ("recording", "import", "@tracks.csv", "--as", "@as.yaml"),
    ),
    "new": ("diagnosis.check.propose.propose", ("recording", "new", "@tracks.csv", "--scenario", "tclab")),
    "record": ("diagnosis.recording.command._read", ("record", "tclab")),
    "video": ("diagnosis.recording.command._render", ("record", "tclab", "--video", "@rig.yaml")),
    "ssp": ("cosim.ssp.importer.import_ssp", ("ssp", "import", "@no_structure.ssp")),
}


@pytest.mark.parametrize("name", KILLED)
def test_what_was_killed_in_a_new_folder_keeps_nobody_out(start, cosim, tmp_path, name):
    """While the command is at work a second one is refused; once it is killed, the second gets as far as its files."""
    where, line = KILLED[name]
    module, _, function = where.rpartition(".")
    lay(tmp_path)
    out = tmp_path / "new" / "out"
    words = [str(tmp_path / w[1:]) if w.startswith("@") else w for w in line]
    stop = f"import time, {module}\n{module}.{function} = lambda *a, **k: time.sleep(600)"
    process = start(*words, "--out", out, prelude=stop)
    until(lambda: (out / LOCK).exists() and (out / LOCK).read_text(), process)
    refused = cosim(*words, "--out", out)
    assert refused.code == 2
    assert f"at work in this folder (process {process.pid})" in refused.err
    process.kill()
    assert finish(process).code == -signal.SIGKILL
    assert (out / LOCK).exists()
    answer = cosim(*words, "--out", out)
    assert "at work" not in answer.err
    assert not (out / LOCK).exists()


def test_folders_that_a_refused_command_made_go_again(cosim, tmp_path):
    assert (
        cosim("recording", "new", tmp_path / "no.csv", "--scenario", "tclab", "--out", tmp_path / "a" / "b").code == 2
    )
    assert not list(tmp_path.iterdir())


def test_two_that_write_one_file_leave_a_whole_one(tmp_path):
    """Both wrote `x.part`: the first to finish took away what the second had written so far."""
    path = tmp_path / "play.html"
    program = (
        "import sys, time\nfrom pathlib import Path\nfrom chainmail.play.output import output\n"
        "with output(Path(sys.argv[1])) as partial, partial.open('w') as file:\n"
        "    for _ in range(20):\n        file.write(sys.argv[2] * 5000); file.flush(); time.sleep(0.01)\n"
    )
    both = [subprocess.Popen([sys.executable, "-c", program, path, letter]) for letter in "ab"]
    assert [p.wait() for p in both] == [0, 0]
    assert path.read_text() in ("a" * 100_000, "b" * 100_000)
    assert list(tmp_path.iterdir()) == [path]
