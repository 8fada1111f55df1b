"""The FMUs, built once per session from their sources, and units made of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.unit import FmuSettings, FmuUnit

INTERFACES = {"co_simulation": CoSimulationUnit, "model_exchange": ModelExchangeUnit}

UnitMaker = Callable[..., FmuUnit]


@pytest.fixture(scope="session")
def fmu_file(shipped_fmu: Callable[..., Path]) -> Callable[..., Path]:
    """`fmu_file(model, version, coils)` is the path of an FMU."""

    def path(model: str = "thermal_stiffness", version: int = 3, coils: int = 36) -> Path:
        return shipped_fmu(model, version, coils)

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
