"""The wheel is whole: built from what the repository holds, installed outside the clone, it does what it promises."""

import os
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest
from packaging.utils import parse_wheel_filename

from cosim.native.compiled import library_path

ROOT = Path(__file__).resolve().parents[2]
pytestmark = pytest.mark.slow


def call(*command, **options):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False, **options)
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Built in a copy of the files that git knows: nothing that merely lies around can be in it."""
    folder = tmp_path_factory.mktemp("wheel")
    source = folder / "source"
    listed = call("git", "-C", ROOT, "ls-files", "-co", "--exclude-standard", "-z").split("\0")
    for name in filter(None, listed):
        if (ROOT / name).is_file():
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            (source / name).write_bytes((ROOT / name).read_bytes())
    call(sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "--no-build-isolation", "-w", folder, source)
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def cosim(wheel, tmp_path_factory):
    """The installed command, in an empty folder and with an empty cache."""
    folder = tmp_path_factory.mktemp("installed")
    venv.create(folder / "venv", with_pip=False)
    python = folder / "venv" / "bin" / "python"
    packages = Path(call(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip())
    # Dependencies come from the environment of the tests; the line of a .pth file runs no .pth file in turn, so the
    # clone that is installed there for editing is not found.
    (packages / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(packages)
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "COSIM_FMU_PATH")}
    environment |= {"XDG_CACHE_HOME": str(folder / "cache"), "HOME": str(folder), "OPENBLAS_NUM_THREADS": "1"}
    (folder / "work").mkdir()

    def run(*arguments):
        program = "import sys; from cosim.cli import main; sys.argv[0] = 'cosim'; main()"
        return call(python, "-P", "-c", program, *arguments, cwd=folder / "work", env=environment)

    run.folder = folder / "work"
    run.cache = folder / "cache"
    return run


def test_its_top_level_names_are_the_packages(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    top = {name.split("/")[0] for name in names}
    packages = {"chainmail", "circuit", "cosim", "diagnosis", "mechanics"}
    assert {name for name in top if not name.endswith(".dist-info")} == packages
    assert not [n for n in names if n.endswith((".fmu", "reference.csv")) or n.startswith("tests")]
    for folder in ("scenarios", "scenarios/parameter_sets"):
        for file in (ROOT / folder).glob("*.yaml"):
            assert f"cosim/data/{folder}/{file.name}" in names
    templates = [f for name in ("chainmail", "diagnosis") for f in (ROOT / name).rglob("*.j2")]
    assert len(templates) > 10
    for file in templates:
        assert file.relative_to(ROOT).as_posix() in names


def test_one_wheel_serves_every_python_of_its_platform(wheel):
    """It was built for the Python that built it; another said "is not a supported wheel on this platform"."""
    (tag,) = {(t.interpreter, t.abi) for t in parse_wheel_filename(wheel.name)[3]}
    assert tag == ("py3", "none")
    with zipfile.ZipFile(wheel) as archive:
        libraries = [name for name in archive.namelist() if name.endswith((".so", ".dll", ".pyd"))]
    assert libraries == [library_path().relative_to(ROOT).as_posix()]


def test_it_lists_scenarios_and_runs_one_with_an_fmu_that_it_builds_once(cosim):
    assert "prototype_cantilever" in cosim("list")
    first = cosim("run", "single_coil_heating", "--set", "time.stop=1 s")
    assert "building thermal_stiffness_fmi3.fmu" in first
    assert (cosim.folder / "runs" / "single_coil_heating" / "figures" / "temperatures.png").is_file()
    again = cosim("run", "single_coil_heating", "--set", "time.stop=1 s", "--out", "again", "--no-plots")
    assert "building" not in again
    assert len(list(cosim.cache.rglob("*.fmu"))) == 1


def test_an_actuator_of_one_s_own_is_begun_and_built(cosim):
    cosim("fmu", "new", "my_latex")
    assert "my_latex_fmi3.fmu" in cosim("fmu", "build", "my_latex")
    assert "every check passes" in cosim("fmu", "validate", "my_latex/my_latex_fmi3.fmu")


def test_the_packaged_example_is_diagnosed(cosim):
    cosim("example", "rig")
    said = cosim(
        "diagnose", "rig/scenario.yaml", "--recording", "rig/monday", "--held-out", "rig/tuesday", "--out", "answer"
    )
    assert "MISSING PHYSICS" in said
    assert "temperature-dependent resistance" in said
    assert (cosim.folder / "answer" / "report.html").is_file()
    assert (cosim.folder / "answer" / "amended" / "scenario.yaml").is_file()
