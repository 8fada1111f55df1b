"""`--cluster`: an address that is none, or at which nobody listens, is refused before anything is written."""

from __future__ import annotations

import socket
import sys
import threading
from pathlib import Path

import pytest

from cosim import cli
from tests.check import rig

ROOT = Path(__file__).resolve().parents[2]
SWEEP = ROOT / "docs" / "examples" / "sweeps" / "voltage_and_convection.yaml"
DESIGN = ROOT / "docs" / "examples" / "design" / "small.yaml"


def call(monkeypatch, capsys, *arguments):
    """Exit code and stderr of the command line."""
    monkeypatch.setattr(sys, "argv", ["cosim", *map(str, arguments)])
    with pytest.raises(SystemExit) as left:
        cli.main()
    return left.value.code, capsys.readouterr().err


@pytest.mark.parametrize("address", ["nonsense", " ", "tcp://127.0.0.1", "http://x:1", "tcp://a:70000", "tcp://:8786"])
@pytest.mark.parametrize(("command", "file"), [("sweep", SWEEP), ("design", DESIGN)])
def test_what_is_no_address_is_refused(monkeypatch, capsys, tmp_path, command, file, address):
    """`nonsense` was a traceback of Dask, and the folder then held a sweep that was never begun."""
    code, said = call(monkeypatch, capsys, command, file, "--out", tmp_path / "out", "--cluster", address)
    assert code == 2
    assert "error: --cluster: " in said
    assert "is no address of a Dask scheduler" in said
    assert "remedy: give the address that `dask scheduler` prints" in said
    assert not (tmp_path / "out").exists()


@pytest.fixture
def silent():
    """A port at which nobody listens."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        yield taken.getsockname()[1]


@pytest.fixture
def listening():
    """A port at which somebody listens who is no scheduler."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        thread = threading.Thread(target=lambda: server.accept()[0].close(), daemon=True)
        thread.start()
        yield server.getsockname()[1]


def test_where_nobody_listens_is_said_at_once(monkeypatch, capsys, tmp_path, silent):
    folder = rig.write(tmp_path / "r", rig.FIRST, rig.readings(rig.FIRST))
    for command in (("sweep", SWEEP), ("design", DESIGN), ("diagnose", "tclab", "--recording", folder)):
        address = f"tcp://127.0.0.1:{silent}"
        code, said = call(monkeypatch, capsys, *command, "--out", tmp_path / "out", "--cluster", address)
        assert code == 2
        assert f"error: --cluster: the cluster at {address} does not answer: " in said
        assert not (tmp_path / "out").exists()


def test_a_cluster_that_would_do_nothing_is_refused(monkeypatch, capsys, tmp_path, listening):
    """Compiled code simulates two heaters: the option was taken and never looked at."""
    folder = rig.write(tmp_path / "r", rig.FIRST, rig.readings(rig.FIRST))
    arguments = ("diagnose", "tclab", "--recording", folder, "--out", tmp_path / "out")
    code, said = call(monkeypatch, capsys, *arguments, "--cluster", f"tcp://127.0.0.1:{listening}")
    assert code == 2
    assert "error: --cluster: compiled code simulates this scenario on this machine" in said
    assert "remedy: leave `--cluster` out" in said
    assert not (tmp_path / "out").exists()
