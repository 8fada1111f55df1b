"""Build the small FMUs of the measurements: `python -m benchmarks.models.build [FOLDER]`.

Each folder holds `model.toml` (variables) and `model.c` (equations). From `model.toml` come both the header with the
indices and modelDescription.xml, so that the two cannot disagree. The FMI headers are those of the installed fmpy.
"""

from __future__ import annotations

import os
import sys
import tomllib
import uuid
import zipfile
from pathlib import Path
from subprocess import run
from tempfile import TemporaryDirectory

import fmpy

from benchmarks.models.describe import FMI2, FMI3, Model, describe, header

HERE = Path(__file__).resolve().parent
DEFAULT = HERE.parent.parent / "build" / "benchmark_models"
SHIM = HERE / "shim"
SOURCES = {FMI2: ["fmi2.c"], FMI3: ["fmi3.c", "fmi3_absent.c"]}
FLAGS = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-fPIC", "-shared", "-fvisibility=hidden"]
#: The earliest time that a zip entry can carry; equal contents then give equal files.
EPOCH = (1980, 1, 1, 0, 0, 0)


def load(folder: Path) -> Model:
    """Model of one folder."""
    data = tomllib.loads((folder / "model.toml").read_text())
    token = str(uuid.uuid5(uuid.NAMESPACE_URL, folder.name + (folder / "model.toml").read_text()))
    events = data.get("events", False)
    return Model(folder.name, data["description"], token, tuple(data["fmi"]), data["variables"], events)


def build_one(folder: Path, version: int, into: Path) -> Path:
    """Compile and zip one FMU; returns its path. Raises CalledProcessError where gcc refuses."""
    model = load(folder)
    fmu = into / f"{model.name}_fmi{version}.fmu"
    platform = fmpy.platform if version == FMI2 else fmpy.platform_tuple
    binary = f"binaries/{platform}/{model.name}{fmpy.sharedLibraryExtension}"
    with TemporaryDirectory() as work:
        (Path(work) / "variables.h").write_text(header(model))
        library = Path(work) / "library"
        shared = [SHIM / name for name in ("instance.c", "linear_step.c", *SOURCES[version])]
        headers = Path(fmpy.__file__).parent / "c-code"
        run(
            [
                "gcc",
                *FLAGS,
                f"-I{work}",
                f"-I{SHIM}",
                "-isystem",
                headers,
                "-o",
                library,
                folder / "model.c",
                *shared,
                "-lm",
            ],
            check=True,
        )
        entries = {"modelDescription.xml": describe(model, version).encode(), binary: library.read_bytes()}
    into.mkdir(parents=True, exist_ok=True)
    part = fmu.with_name(f"{fmu.name}.{os.getpid()}.part")  # others may be reading the old file, or building it as well
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in entries.items():
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.external_attr = (0o100755 if name == binary else 0o100644) << 16
            archive.writestr(entry, content)
    part.replace(fmu)
    return fmu


def build(into: Path = DEFAULT) -> list[Path]:
    """Build every FMU that is missing or older than its sources; returns all paths."""
    built = []
    shim_age = max(file.stat().st_mtime for file in [*SHIM.iterdir(), HERE / "build.py", HERE / "describe.py"])
    for folder in sorted(p.parent for p in HERE.glob("*/model.toml")):
        age = max(shim_age, *(file.stat().st_mtime for file in folder.iterdir()))
        for version in load(folder).versions:
            fmu = into / f"{folder.name}_fmi{version}.fmu"
            is_fresh = fmu.is_file() and fmu.stat().st_mtime >= age
            built.append(fmu if is_fresh else build_one(folder, version, into))
    return built


if __name__ == "__main__":
    for path in build(Path(sys.argv[1]) if len(sys.argv) > 1 else DEFAULT):
        print(path)
