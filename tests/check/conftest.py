"""The command line in this process, for tests of checks and proposals."""

from __future__ import annotations

import sys

import pytest

from cosim import cli


@pytest.fixture
def command(monkeypatch, capsys):
    """The command line in this process: exit code, stdout, stderr."""

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["cosim", *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            cli.main()
        said = capsys.readouterr()
        return left.value.code, said.out, said.err

    return call
