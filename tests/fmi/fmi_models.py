"""Builds the test models into FMUs with gcc."""

from __future__ import annotations

import subprocess
import zipfile
from pathlib import Path

import fmpy

MODELS = Path(__file__).resolve().parent / "models"
HEADERS = Path(fmpy.__file__).parent / "c-code"
#: Every model in the FMI versions for which it has a description.
FMUS = [(p.parent.name, int(p.stem[-1])) for p in sorted(MODELS.glob("*/fmi?.xml"))]
_FLAGS = [
    "-std=c11",
    "-O1",
    "-fPIC",
    "-shared",
    "-Wall",
    "-Wextra",
    "-Wno-unused-parameter",
    "-Wno-stringop-truncation",
]


def fmu_path(model: str, version: int, folder: Path) -> Path:
    """Where `build` puts the .fmu file of one model."""
    return folder / f"{model}_fmi{version}.fmu"


def build(model: str, version: int, folder: Path) -> Path:
    """The .fmu file of one model."""
    library = folder / f"{model}{version}.so"
    subprocess.run(
        [
            "gcc",
            *_FLAGS,
            f"-I{MODELS / 'shim'}",
            f"-isystem{HEADERS}",
            MODELS / "shim" / f"fmi{version}.c",
            MODELS / model / "model.c",
            "-o",
            library,
            "-lm",
        ],
        check=True,
    )
    platform = fmpy.platform_tuple if version == 3 else fmpy.platform
    path = fmu_path(model, version, folder)
    with zipfile.ZipFile(path, "w") as archive:
        archive.write(MODELS / model / f"fmi{version}.xml", "modelDescription.xml")
        archive.write(library, f"binaries/{platform}/{model}{fmpy.sharedLibraryExtension}")
    return path


def described(fmu: Path, path: Path, old: str, new: str) -> Path:
    """A copy of an FMU at `path` with another text in its modelDescription.xml."""
    with zipfile.ZipFile(fmu) as source, zipfile.ZipFile(path, "w") as target:
        for name in source.namelist():
            content = source.read(name)
            if name == "modelDescription.xml":
                content = content.replace(old.encode(), new.encode())
            target.writestr(name, content)
    return path
