"""What commands load before they do anything: each of these packages costs a tenth of a second or more."""

from __future__ import annotations

import subprocess
import sys

import pytest

HEAVY = (
    "dask",
    "matplotlib",
    "netCDF4",
    "pandas",
    "pyarrow",
    "scipy",
    "sympy",
    "xarray",
)
CALL = """
import sys
from cosim.cli import app
try:
    app(sys.argv[1:], standalone_mode=False)
except SystemExit:
    pass
print(*sys.modules, sep="\\n", file=sys.stderr)
"""


@pytest.mark.parametrize(
    ("command", "also"),
    [
        (("--help",), ("importlib.metadata", "jinja2", "numpy", "pint", "pydantic", "pybullet", "PySpice")),
        (("run", "--help"), ("jinja2", "numpy", "pint")),
        (("validate", "prototype_cantilever"), ("rich", "PySpice", "cffi")),
        (("validate", "tclab"), ("rich", "pybullet", "PySpice")),
    ],
)
def test_a_command_loads_no_package_that_it_does_not_need(command: tuple[str, ...], also: tuple[str, ...]) -> None:
    done = subprocess.run([sys.executable, "-c", CALL, *command], capture_output=True, text=True, check=True)
    loaded = set(done.stderr.split())
    assert "cosim.cli" in loaded
    assert loaded.isdisjoint({*HEAVY, *also}), sorted(loaded & {*HEAVY, *also})


def test_packages_that_pint_shall_not_load_are_there_for_others():
    code = "import sys, cosim.unit.quantity as q; print(q.conversion('mm', 'm'), 'dask' in sys.modules)"
    then = "import dask, scipy.linalg; import dask.array; print(dask.array.ones(3).sum().compute())"
    done = subprocess.run([sys.executable, "-c", f"{code}\n{then}"], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:2] == ["(0.001, 0.0) False", "3.0"]
