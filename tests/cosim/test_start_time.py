"""What commands load before they do anything: each of these packages costs a tenth of a second or more."""

from __future__ import annotations

import subprocess
import sys

import pytest

HEAVY = (
    "dask.distributed",
    "matplotlib",
    "netCDF4",
    "pandas",
    "pyarrow",
    "scipy.linalg",
    "scipy.sparse",
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
        (("--help",), ("jinja2", "numpy", "pint", "pydantic", "pybullet", "PySpice")),
        (("run", "--help"), ("jinja2", "numpy", "pint")),
        (("validate", "prototype_cantilever"), ()),
        (("validate", "tclab"), ("pybullet", "PySpice")),
    ],
)
def test_a_command_loads_no_package_that_it_does_not_need(command: tuple[str, ...], also: tuple[str, ...]) -> None:
    done = subprocess.run([sys.executable, "-c", CALL, *command], capture_output=True, text=True, check=True)
    loaded = set(done.stderr.split())
    assert "cosim.cli" in loaded
    assert loaded.isdisjoint({*HEAVY, *also}), sorted(loaded & {*HEAVY, *also})
