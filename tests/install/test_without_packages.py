"""Where a package is missing, one sentence names it and the remedy, and what does not need it works."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from cosim.shipped import SCENARIOS

ROOT = Path(__file__).resolve().parents[2]
#: Runs the command line in a process that cannot import some packages.
PROGRAM = """
import sys
hidden = sys.argv[1].split(",")
class Hide:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in hidden:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Hide())
sys.argv = ["cosim", *sys.argv[2:]]
from cosim.cli import main
main()
"""
EVERY = "pybullet,sksundae,PySpice"


@pytest.fixture
def cosim_without(shipped_fmus, tmp_path):
    def call(hidden, *arguments):
        return subprocess.run(
            [sys.executable, "-c", PROGRAM, hidden, *map(str, arguments)],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, "PYTHONPATH": str(ROOT), "COSIM_FMU_PATH": str(shipped_fmus)},
        )

    return call


def with_cvode(folder):
    text = (
        (SCENARIOS / "water_bath.yaml").read_text().replace("kind: actuator", "kind: actuator\n    integrator: cvode")
    )
    (folder / "cvode.yaml").write_text(text)
    return folder / "cvode.yaml"


@pytest.mark.parametrize(
    ("hidden", "scenario", "what", "remedy"),
    [
        (
            "pybullet",
            "pendulum",
            "a fabric or a pendulum needs pybullet, and it is not installed",
            "pip install pybullet",
        ),
        ("sksundae", "cvode", "`integrator: cvode` needs scikit-sundae", "pip install scikit-sundae"),
        ("PySpice", "hanging_coils", "a circuit needs PySpice, and PySpice is not installed", "pip install PySpice"),
        ("cffi", "hanging_coils", "and cffi, which PySpice imports, is not installed", "pip install PySpice"),
    ],
)
def test_one_sentence_names_the_package_and_the_remedy(cosim_without, tmp_path, hidden, scenario, what, remedy):
    given = with_cvode(tmp_path) if scenario == "cvode" else scenario
    done = cosim_without(hidden, "run", given, "--out", "out")
    assert done.returncode == 2, done.stderr
    assert what in done.stderr
    assert remedy in done.stderr
    assert "Traceback" not in done.stderr
    assert len(done.stderr.strip().splitlines()) == 2
    assert not (tmp_path / "out").exists()


def test_everything_else_works_without_any_of_them(cosim_without, tmp_path):
    done = cosim_without(EVERY, "run", "water_bath", "--set", "time.stop=20 s", "--out", "out")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "figures" / "stiffness_loops.png").is_file()
    for arguments in (
        ("list",),
        ("diagnose", "--help"),
        ("record", "tclab", "--set", "time.stop=2 s", "--out", "r", "--channels", "coil[1].temperature"),
    ):
        done = cosim_without(EVERY, *arguments)
        assert done.returncode == 0, done.stderr
