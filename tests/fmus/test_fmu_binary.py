"""The shared libraries: exported symbols, memory under valgrind, sources that build, reproducible archives."""

import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import fmpy
import pytest
from fmpy import read_model_description
from fmu_runs import every_fmu

HEADERS = Path(fmpy.__file__).parent / "c-code"
HERE = Path(__file__).parent
WARNINGS = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]


@pytest.fixture
def unpacked(fmu_file, tmp_path):
    """`unpacked(model, version)` is the folder of an extracted FMU."""

    def extract(model, version):
        folder = tmp_path / f"{model}{version}"
        with zipfile.ZipFile(fmu_file(model, version)) as archive:
            archive.extractall(folder)
        return folder

    return extract


def binary(folder, model, version):
    return folder / "binaries" / (fmpy.platform_tuple if version == 3 else fmpy.platform) / f"{model}.so"


@every_fmu
def test_only_the_functions_of_the_standard_are_exported(unpacked, model, version):
    listing = subprocess.run(
        ["nm", "-D", "--defined-only", binary(unpacked(model, version), model, version)],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    exported = {line.split()[-1] for line in listing.splitlines()}
    header = (HEADERS / f"fmi{version}Functions.h").read_text()
    standard = set(re.findall(rf"#define (fmi{version}\w+)\s+fmi{version}FullName\(fmi{version}\w+\)", header))
    assert len(standard) > 40
    assert exported == standard


@every_fmu
def test_a_binary_links_what_it_uses(unpacked, model, version):
    """Every symbol is found by the loader alone: a host that has no libm of its own can use it."""
    done = subprocess.run(
        ["ldd", "-r", binary(unpacked(model, version), model, version)], capture_output=True, text=True, check=True
    )
    assert "undefined symbol" not in done.stdout + done.stderr
    assert "not found" not in done.stdout + done.stderr
    assert "libm.so" in done.stdout or model == "instant_stiffness"


@every_fmu
def test_a_c_host_leaks_nothing(unpacked, tmp_path, model, version):
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind is not installed")
    folder = unpacked(model, version)
    library, host = binary(folder, model, version), tmp_path / "host"
    subprocess.run(
        [
            "gcc",
            *WARNINGS,
            "-g",
            "-isystem",
            HEADERS,
            HERE / f"host_fmi{version}.c",
            library,
            "-o",
            host,
            f"-Wl,-rpath,{library.parent}",
            "-lm",
        ],
        check=True,
    )
    description = read_model_description(folder)
    drive = next(v for v in description.modelVariables if v.name.split("[")[0] in ("power", "voltage"))
    assert drive.valueReference == 2  # as the hosts have it
    states = sum(variable.derivative is not None for variable in description.modelVariables)
    done = subprocess.run(
        [
            "valgrind",
            "--quiet",
            "--leak-check=full",
            "--show-leak-kinds=all",
            "--errors-for-leak-kinds=all",
            "--error-exitcode=255",
            host,
            description.guid or description.instantiationToken,
            str(states),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert int(done.stdout.split()[0]) >= 4  # refusals were logged


@every_fmu
def test_the_sources_in_the_fmu_build_on_their_own(unpacked, tmp_path, model, version):
    folder = unpacked(model, version)
    if version == 3:
        text = (folder / "sources" / "buildDescription.xml").read_text()
        files = re.findall(r'<SourceFile name="(.+?)"', text)
    else:
        text = (folder / "modelDescription.xml").read_text()
        files = sorted(set(re.findall(r'<File name="(.+?)"', text)))
    assert len(files) == 9
    subprocess.run(
        ["gcc", *WARNINGS, "-fPIC", "-shared", "-isystem", HEADERS, *files, "-o", tmp_path / "again.so", "-lm"],
        cwd=folder / "sources",
        check=True,
    )
    assert (tmp_path / "again.so").stat().st_size > 10_000


def test_archives_are_reproducible_and_complete(fmu_file):
    with zipfile.ZipFile(fmu_file()) as archive:
        names = archive.namelist()
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
    assert names == sorted(names)
    assert {
        "modelDescription.xml",
        "documentation/index.html",
        "documentation/licenses/license.txt",
        "sources/buildDescription.xml",
        "sources/config.h",
        f"binaries/{fmpy.platform_tuple}/thermal_stiffness.so",
    } <= set(names)
