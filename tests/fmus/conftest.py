"""The FMUs, built once per session from their sources, and units made of them."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.unit import FmuSettings, FmuUnit

FMUS = Path(__file__).resolve().parents[2] / "fmus"
INTERFACES = {"co_simulation": CoSimulationUnit, "model_exchange": ModelExchangeUnit}

Builder = Callable[[int], Path]
UnitMaker = Callable[..., FmuUnit]


@pytest.fixture(scope="session")
def build(tmp_path_factory: pytest.TempPathFactory) -> Builder:
    """`build(coils)` runs make, once per number of coils, and returns the folder of the FMUs."""
    folder = tmp_path_factory.mktemp("fmus")
    built: set[int] = set()

    def make(coils: int = 36) -> Path:
        if coils not in built:
            done = subprocess.run(
                ["make", "-C", FMUS, f"PYTHON={sys.executable}", f"BUILD={folder}", f"COILS={coils}"],
                capture_output=True,
                text=True,
                check=False,
            )
            assert done.returncode == 0, done.stderr
            assert "warning" not in done.stderr, done.stderr
            built.add(coils)
        return folder

    return make


@pytest.fixture(scope="session")
def fmu_file(build: Builder) -> Callable[..., Path]:
    """`fmu_file(model, version, coils)` is the path of an FMU."""

    def path(model: str = "thermal_stiffness", version: int = 3, coils: int = 36) -> Path:
        suffix = f"_n{coils}" if version == 2 and coils != 36 else ""
        return build(coils if version == 2 else 36) / f"{model}_fmi{version}{suffix}.fmu"

    return path


@pytest.fixture(scope="module")
def make_unit(fmu_file: Callable[..., Path]) -> Iterator[UnitMaker]:
    """`make_unit(...)` loads an FMU, not yet initialised; all are freed at the end of the module."""
    units: list[FmuUnit] = []

    def make(
        model: str = "thermal_stiffness",
        version: int = 3,
        interface: str = "co_simulation",
        coils: int = 36,
        parameters: Mapping[str, Any] | None = None,
        **settings: Any,
    ) -> FmuUnit:
        archive = open_fmu(fmu_file(model, version, coils))
        unit = INTERFACES[interface]("actuator", archive, FmuSettings({"coils": coils}, parameters or {}, **settings))
        units.append(unit)
        return unit

    yield make
    for unit in units:
        unit.terminate()
