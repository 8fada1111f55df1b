"""Every test here runs with FMUs built from the sources as they are now, in this process and in those it starts."""

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from cosim import cli

ROOT = Path(__file__).resolve().parents[2]
#: As the user gave it: loading ngspice in this process writes its place into the environment.
ENVIRONMENT = dict(os.environ)


@pytest.fixture(scope="session", autouse=True)
def _fmus_of_these_sources(shipped_fmus):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COSIM_FMU_PATH", str(shipped_fmus))
        patch.setenv("OPENBLAS_NUM_THREADS", "1")
        yield


@pytest.fixture
def _one_step_per_turn(monkeypatch):
    """The loop comes back, for progress and interrupts, after every macro-step and not after some wall time."""
    monkeypatch.setattr("cosim.native.plan.TURN", 0.0)


@dataclass(frozen=True)
class Answer:
    """What a command gave back."""

    code: int
    out: str
    err: str


@pytest.fixture
def cosim(monkeypatch, capsys):
    """`cosim("run", "x.yaml")` calls the entry point of the command line in this process."""

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["cosim", *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            cli.main()
        captured = capsys.readouterr()
        return Answer(int(left.value.code or 0), captured.out, captured.err)

    return call


@pytest.fixture
def start():
    """`start("run", "x.yaml", variable="value")` starts the command line as a process of its own."""
    processes = []

    def call(*arguments, prelude="", **environment):
        program = f"{prelude}\nfrom cosim.cli import main\nmain()"
        process = subprocess.Popen(
            [sys.executable, "-c", program, *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**ENVIRONMENT, "COSIM_FMU_PATH": os.environ["COSIM_FMU_PATH"], "PYTHONPATH": str(ROOT), **environment},
        )
        processes.append(process)
        return process

    yield call
    for process in processes:
        if process.poll() is None:
            process.kill()
        process.communicate()


def finish(process):
    """Wait for a process that `start` began."""
    out, err = process.communicate()
    return Answer(process.returncode, out, err)
