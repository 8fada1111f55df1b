"""What all tests share: the option that rewrites golden traces, and the FMUs built from their sources."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


def pytest_addoption(parser):
    parser.addoption(
        "--update-golden", action="store_true", help="rewrite tests/golden; give the reason in the changelog"
    )


@pytest.fixture(scope="session")
def shipped_fmus(tmp_path_factory):
    """Folder of the FMUs, built from their sources once per session."""
    folder = tmp_path_factory.mktemp("shipped_fmus")
    command = ["make", "-C", ROOT / "fmus", f"PYTHON={sys.executable}", f"BUILD={folder}", "COILS=36"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder
