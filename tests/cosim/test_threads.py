"""Linear algebra of the command line runs in one thread, unless the user says otherwise."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

_ASKED = """
import sys
import cosim.threads
assert "numpy" not in sys.modules
import cosim.cli
import numpy
from threadpoolctl import threadpool_info
print({one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"})
"""


@pytest.mark.skipif((os.cpu_count() or 1) < 2, reason="one core has one thread")
@pytest.mark.parametrize(("given", "expected"), [(None, {1}), ("2", {2})])
def test_one_thread_or_what_the_user_says(given: str | None, expected: set[int]) -> None:
    pytest.importorskip("threadpoolctl")
    environment = {k: v for k, v in os.environ.items() if not k.endswith("_NUM_THREADS")}
    if given is not None:
        environment["OPENBLAS_NUM_THREADS"] = given
    done = subprocess.run([sys.executable, "-c", _ASKED], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == str(expected)
