"""Actuator FMUs built from the sources as they are now, and the command line called in this process."""

import sys
from dataclasses import dataclass

import pytest

from cosim import cli


@pytest.fixture(scope="session", autouse=True)
def fmus(shipped_fmus):
    """Folder of the FMUs; those of FMI 2.0 for 36 and for 6 coils."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COSIM_FMU_PATH", str(shipped_fmus))
        patch.setenv("OPENBLAS_NUM_THREADS", "1")
        yield shipped_fmus


@dataclass(frozen=True)
class Answer:
    """What a command gave back."""

    code: int
    out: str
    err: str


@pytest.fixture
def cosim(monkeypatch, capsys):
    """`cosim("fmu", "info", file)` calls the entry point of the command line in this process."""

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["cosim", *map(str, arguments)])
        monkeypatch.setenv("COLUMNS", "200")
        with pytest.raises(SystemExit) as left:
            cli.main()
        captured = capsys.readouterr()
        return Answer(int(left.value.code or 0), captured.out, captured.err)

    return call
