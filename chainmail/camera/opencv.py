"""OpenCV, which is an optional extra: found here, or its absence said in one sentence."""

from __future__ import annotations

import importlib
from typing import Any

from cosim.unit.errors import InputError


def opencv() -> Any:
    """The module `cv2`.

    One thread: threads of several processes compete for the same cores, and results do not depend on their number.

    Raises:
        InputError: It is not installed.
    """
    try:
        module = importlib.import_module("cv2")
    except ImportError as error:
        raise InputError(
            "OpenCV",
            "",
            "pictures and videos need the package opencv-python-headless",
            "pip install 'active-chainmail[video]'",
        ) from error
    module.setNumThreads(1)
    return module
