"""FMUs of the tests of the native loop."""

import pytest

from benchmarks.models import systems
from benchmarks.models.build import build as build_models
from cosim.connection import Connection
from cosim.system import System
from tests.native.both_loops import fmu
from tests.native.scripted_fmu import build, fmu_path


@pytest.fixture(scope="session")
def scripted(once):
    """FMI version to the scripted FMU."""
    folder = once("scripted", lambda folder: [build(folder, version) for version in (2, 3)])
    return {version: fmu_path(folder, version) for version in (2, 3)}


@pytest.fixture(scope="session")
def scripted_events(once):
    """The FMI 3.0 FMU with Event Mode."""
    folder = once("scripted_events", lambda folder: build(folder, 3, has_event_mode=True))
    return fmu_path(folder, 3, has_event_mode=True)


@pytest.fixture(scope="session")
def quarter_truck():
    """Makes the quarter truck of the benchmarks with FMUs of a version."""
    built = {path.name: path for path in build_models()}
    truck = systems.QUARTER_TRUCK

    def make(version):
        units = {name: fmu(name, built[f"{model}_fmi{version}.fmu"]) for name, model in truck.components.items()}
        wires = [Connection((c.source, c.output), (c.target, c.input)) for c in truck.connections]
        return System(units, wires)

    return make
