"""FMUs that misbehave, units made of them, and the check that nothing is left of any."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

import pytest

from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.unit import FmuSettings
from cosim.isolation.limits import Limits
from cosim.isolation.unit import IsolatedUnit
from cosim.scenario import parse_scenario

from .fmus import Builder

ROOT = Path(__file__).resolve().parents[2]
SCENARIO = """
title: An FMU that misbehaves
time: {{stop: {stop} s, macro_step: 10 ms, output_step: 10 ms, checkpoint_step: {checkpoint}}}
algorithm: {{kind: jacobi}}
components:
{components}
"""


@pytest.fixture(scope="session")
def fmu(tmp_path_factory):
    """`fmu(deed, place)` is the path of an FMU."""
    return Builder(tmp_path_factory.mktemp("faulty"))


@pytest.fixture(autouse=True)
def temporary(tmp_path, monkeypatch):
    """Folder in which FMUs are extracted; after the test nothing is left: no folder, process or open descriptor."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    monkeypatch.setenv("TMPDIR", str(folder))
    monkeypatch.delenv("PYTHONUNBUFFERED", raising=False)
    before = descriptors("pipe:"), descriptors("pidfd")
    yield folder
    assert list(folder.iterdir()) == []
    assert remaining(str(folder)) == []
    assert (descriptors("pipe:"), descriptors("pidfd")) == before
    assert not [name for name in os.listdir("/dev/shm") if "cosim" in name]


def rising(count):
    """The first values of y: u = 1 summed over steps of 0.01 s, each rounded (10 steps: a relative 2e-15)."""
    return pytest.approx([0.01 * k for k in range(count)], rel=1e-12)


def processes(text):
    """Ids of all processes with `text` in their command line (the extracted FMU's folder is in it), but this one."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            command = (entry / "cmdline").read_bytes() if entry.name.isdigit() else b""
        except OSError:  # it has just ended
            continue
        if text.encode() in command and int(entry.name) != os.getpid():
            found.append(int(entry.name))
    return found


def remaining(text):
    """Processes that are still there after the moment that the system needs to end a killed one (10 s at most)."""
    for _ in range(100):
        if not (found := processes(text)):
            break
        time.sleep(0.1)
    return found


def descriptors(kind):
    """How many descriptors this process has open whose target holds `kind` ("pipe:", "memfd:", "pidfd")."""
    found = 0
    for entry in Path("/proc/self/fd").iterdir():
        try:
            found += kind in os.readlink(entry)
        except OSError:  # the descriptor of the listing itself
            continue
    return found


@pytest.fixture
def isolate():
    """`isolate(path, step_limit=...)` is an isolated unit of an FMU; all are terminated after the test."""
    units = []

    def make(path, name="faulty", settings=None, **limits):
        archive = open_fmu(path)
        build = partial(CoSimulationUnit, name, archive, settings or FmuSettings())
        try:
            units.append(IsolatedUnit(name, build, Limits(**limits), archive))
        except BaseException:
            archive.remove()
            raise
        return units[-1]

    yield make
    for unit in units:
        unit.terminate()


@pytest.fixture
def scenario(tmp_path):
    """`scenario({name: path}, isolation)` is a run of FMUs over 0.1 s (they misbehave from 0.05 s on)."""

    def make(fmus, isolation="process", stop=0.1, checkpoint="20 ms"):
        components = "\n".join(f"  {n}: {{kind: fmu, fmu: {p}, isolation: {isolation}}}" for n, p in fmus.items())
        text = SCENARIO.format(stop=stop, checkpoint=checkpoint, components=components)
        (tmp_path / "scenario.yaml").write_text(text)
        return parse_scenario(text, tmp_path / "scenario.yaml")

    return make


@pytest.fixture
def start(temporary):
    """`start(*arguments)` starts the command line in a process group of its own, as a shell does."""
    started = []

    def call(*arguments):
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
        process = subprocess.Popen(
            [sys.executable, "-m", "cosim.cli", *map(str, arguments)],
            env=environment,
            text=True,
            process_group=0,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )
        started.append(process)
        return process

    yield call
    for process in started:
        if process.poll() is None:
            process.kill()
        process.communicate()
