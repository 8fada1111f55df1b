"""Work that ends its process."""

from __future__ import annotations

import os
import signal

import numpy as np

from cosim.compute.result import Result


def deadly(shared: float, given: int) -> Result:
    """The third task kills the process that it runs in."""
    if given == shared:
        os.kill(os.getpid(), signal.SIGKILL)
    return Result((np.array([float(given)]),))
