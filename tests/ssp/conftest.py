"""FMUs of these sources, and small SSPs written by hand from the standard."""

import pytest

from benchmarks.models.build import build
from tests.ssp.packages import Packer


@pytest.fixture(scope="session", autouse=True)
def _fmus_of_these_sources(shipped_fmus):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COSIM_FMU_PATH", str(shipped_fmus))
        patch.setenv("OPENBLAS_NUM_THREADS", "1")
        yield


@pytest.fixture(scope="session")
def models():
    """`models("ground", 2)` is the path of a small FMU."""
    built = {path.stem: path for path in build()}
    return lambda name, version=2: built[f"{name}_fmi{version}"]


@pytest.fixture
def pack(tmp_path, models):
    """Makes .ssp files."""
    return Packer(tmp_path, models)
