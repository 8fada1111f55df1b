"""FMUs of the tests of the native loop."""

import pytest

from benchmarks.models import systems
from benchmarks.models.build import build as build_models
from cosim.connection import Connection
from cosim.system import System
from tests.native.both_loops import fmu
from tests.native.scripted_fmu import build


@pytest.fixture(scope="session")
def scripted(tmp_path_factory):
    """FMI version to the scripted FMU."""
    folder = tmp_path_factory.mktemp("scripted")
    return {version: build(folder, version) for version in (2, 3)}


@pytest.fixture(scope="session")
def scripted_events(tmp_path_factory):
    """The FMI 3.0 FMU with Event Mode."""
    return build(tmp_path_factory.mktemp("scripted_events"), 3, has_event_mode=True)


@pytest.fixture(scope="session")
def quarter_truck(tmp_path_factory):
    """Makes the quarter truck of the benchmarks with FMUs of a version."""
    folder = tmp_path_factory.mktemp("models")
    build_models(folder)
    truck = systems.QUARTER_TRUCK

    def make(version):
        units = {name: fmu(name, folder / f"{model}_fmi{version}.fmu") for name, model in truck.components.items()}
        wires = [Connection((c.source, c.output), (c.target, c.input)) for c in truck.connections]
        return System(units, wires)

    return make
