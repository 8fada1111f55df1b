"""What all tests share: the option that rewrites golden traces, and the FMUs built from their sources."""

import fcntl
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tools.long_tests import LIST, names

ROOT = Path(__file__).resolve().parents[1]
#: Coils of the FMUs of FMI 2.0 in the folder of all; other sizes are built one by one.
SHIPPED_SIZES = (36, 6)

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # A shell starts jobs in the background deaf to Ctrl-C, and commands that tests start and interrupt inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser):
    parser.addoption(
        "--update-golden", action="store_true", help="rewrite tests/golden; give the reason in the changelog"
    )


def pytest_collection_modifyitems(items):
    long = names(LIST.read_text(encoding="utf-8").splitlines())
    for item in items:
        if item.nodeid in long:
            item.add_marker(pytest.mark.long)


@pytest.fixture(scope="session")
def once(tmp_path_factory):
    """`once(name, make)` is a folder that `make(folder)` has filled: one time per run, whichever worker asks first."""
    root = tmp_path_factory.getbasetemp()
    root = (root.parent if "PYTEST_XDIST_WORKER" in os.environ else root) / "made_once"
    root.mkdir(exist_ok=True)

    def made(name, make):
        folder, done = root / name, root / f"{name}.done"
        with (root / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not done.exists():
                shutil.rmtree(folder, ignore_errors=True)  # of a worker that failed
                folder.mkdir()
                make(folder)
                done.touch()
        return folder

    return made


@pytest.fixture(scope="session")
def shipped_fmu(once):
    """`shipped_fmu("thermal_stiffness", 2, coils=6)` is the path of an FMU of this tree, built from its sources."""

    def path(model, version, coils=36):
        name = f"{model}_fmi{version}" + (f"_n{coils}" if version == 2 and coils != 36 else "")
        if version == 3 or coils in SHIPPED_SIZES:
            return once("shipped_fmus", _all_fmus) / f"{name}.fmu"
        return once(name, lambda folder: _fmus(folder, coils, f"{folder / name}.fmu")) / f"{name}.fmu"

    return path


@pytest.fixture(scope="session")
def shipped_fmus(once):
    """Folder of the FMUs, those of FMI 2.0 for 36 and for 6 coils, built from their sources once per run."""
    return once("shipped_fmus", _all_fmus)


def _all_fmus(folder):
    for coils in SHIPPED_SIZES:
        _fmus(folder, coils, "all")


def _fmus(folder, coils, target):
    command = ["make", "-j2", "-C", ROOT / "fmus", f"PYTHON={sys.executable}", f"BUILD={folder}", f"COILS={coils}"]
    # As from a shell: a make above this one has job slots and flags of its own.
    plain = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
    done = subprocess.run([*command, target], capture_output=True, text=True, check=False, env=plain)
    assert done.returncode == 0, done.stderr
    assert "warning" not in done.stderr, done.stderr
