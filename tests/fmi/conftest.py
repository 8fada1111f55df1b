"""The test models, built once per session, and units made of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.unit import FmuSettings, FmuUnit
from tests.fmi.fmi_models import FMUS, build, fmu_path

INTERFACES = {"cs": CoSimulationUnit, "me": ModelExchangeUnit}
Maker = Callable[..., FmuUnit]


@pytest.fixture(scope="session")
def built(once: Callable[..., Path]) -> dict[tuple[str, int], Path]:
    """(model, FMI version) to its .fmu file."""

    def make(folder: Path) -> None:
        for model, version in FMUS:
            build(model, version, folder)

    folder = once("fmi_models", make)
    return {(model, version): fmu_path(model, version, folder) for model, version in FMUS}


@pytest.fixture
def load(built: dict[tuple[str, int], Path]) -> Iterator[Maker]:
    """`load("ball", 3, "cs", parameters=...)` is a unit that is not yet initialised."""
    units: list[FmuUnit] = []

    def make(model: str, version: int = 3, interface: str = "cs", **settings: Any) -> FmuUnit:
        archive = open_fmu(built[model, version])
        try:
            unit = INTERFACES[interface](model, archive, FmuSettings(**settings))
        except BaseException:
            archive.remove()
            raise
        units.append(unit)
        return unit

    yield make
    for unit in units:
        unit.terminate()


@pytest.fixture
def started(load: Maker) -> Maker:
    """The same, initialised at 0."""

    def make(*kind: Any, **settings: Any) -> FmuUnit:
        unit = load(*kind, **settings)
        unit.initialise(0)
        unit.exit_initialisation()
        return unit

    return make
