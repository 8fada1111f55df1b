"""What comes with the program beside its modules: scenarios, parameter sets, sources of actuators, templates, examples.

In a clone they are folders of the tree. A wheel holds copies of the same folders in `cosim/data` (setup.py), because
the top-level names of an installation are those of the packages alone: chainmail, circuit, cosim, diagnosis, mechanics.
"""

from __future__ import annotations

import hashlib
import os
import sysconfig
from functools import cache
from pathlib import Path

import platformdirs

_PACKAGE = Path(__file__).resolve().parent
_PACKED = _PACKAGE / "data"
#: Whether this is an installation from a wheel, and no clone.
IS_INSTALLED = _PACKED.is_dir()
ROOT = _PACKED if IS_INSTALLED else _PACKAGE.parent

SCENARIOS = ROOT / "scenarios"
FMUS = ROOT / "fmus"
TEMPLATES = ROOT / "templates"
EXAMPLES = ROOT / "docs" / "examples"


def shipped_actuators() -> dict[str, Path]:
    """Name to source folder of every shipped actuator."""
    return {file.parent.name: file.parent for file in sorted(FMUS.glob("*/model.c"))}


def shipped_fmus() -> dict[str, Path]:
    """Name to source folder of every shipped FMU: actuators and controllers."""
    return {**shipped_actuators(), **{file.parent.name: file.parent for file in sorted(FMUS.glob("control/*/model.c"))}}


def shipped_examples() -> dict[str, Path]:
    """Name to folder of every shipped example that holds a scenario and recordings."""
    return {file.parent.name: file.parent for file in sorted(EXAMPLES.glob("*/scenario.yaml"))}


def given_fmu_folder() -> Path | None:
    """The folder that the environment variable `COSIM_FMU_PATH` names."""
    given = os.environ.get("COSIM_FMU_PATH")
    return Path(given) if given else None


def fmu_folder() -> Path:
    """Folder of the built FMUs of the shipped actuators.

    `COSIM_FMU_PATH` comes first; a clone has `build/fmus`, an installation a folder in the user's cache.
    """
    return given_fmu_folder() or (_cache_folder() if IS_INSTALLED else ROOT / "build" / "fmus")


@cache
def _cache_folder() -> Path:
    """One folder per set of sources and platform: what another version has built is never taken for this one's."""
    digest = hashlib.sha256(sysconfig.get_platform().encode())
    for file in sorted(p for p in FMUS.rglob("*") if p.is_file() and "__pycache__" not in p.parts):
        digest.update(file.relative_to(FMUS).as_posix().encode() + b"\0" + file.read_bytes())
    return platformdirs.user_cache_path("active-chainmail", appauthor=False) / "fmus" / digest.hexdigest()[:16]
