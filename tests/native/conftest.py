"""FMUs of the tests of the native loop."""

import pytest

from tests.native.scripted_fmu import build


@pytest.fixture(scope="session")
def scripted(tmp_path_factory):
    """FMI version to the scripted FMU."""
    folder = tmp_path_factory.mktemp("scripted")
    return {version: build(folder, version) for version in (2, 3)}
