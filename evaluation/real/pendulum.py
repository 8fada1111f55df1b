"""Free swings of a single arm, cart fixed: one swing in six pieces, the last two held out by its authors."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import loadmat

from cosim.unit.protocol import Array
from evaluation.real.folder import DataSet, Part
from evaluation.real.raw_files import SOURCES, raw_file

_FILE = "SinglePendulumDataForParameterEstimation.mat"
#: Of a thousand smoothed readings per second every so many is kept; a swing takes 0.8 s.
EVERY = 20


def pendulum(folder: Path) -> DataSet:
    """The data set, read from its raw file.

    Each piece starts from its own first readings.

    Raises:
        InputError: The file is missing.
    """
    content = loadmat(raw_file(folder, "cart-pendulum", _FILE))
    parts = [
        _part(kind, i + 1, times.ravel(), values)
        for kind in ("id", "vad")
        for i, (times, values) in enumerate(zip(content[f"Time_{kind}"].ravel(), content[f"Y_{kind}"].ravel()))
    ]
    names = [p.name for p in parts]
    fitted, judging = (tuple(n for n in names if n.startswith(kind)) for kind in ("id", "vad"))
    splits = {"authors' split": (fitted, judging), "widest and smallest": ((fitted[0], fitted[-1]), judging)}
    return DataSet("pendulum", "pendulum", SOURCES["cart-pendulum"], tuple(parts), splits)


def _part(kind: str, number: int, times: Array, values: Array) -> Part:
    # The clock is a whole number of milliseconds: undo the binary debris of its publication.
    columns = {"time": np.round(times, 3)[::EVERY], "angle": values[0, ::EVERY], "angular_velocity": values[1, ::EVERY]}
    sidecar: dict[str, Any] = {
        "time": {"column": "time", "unit": "s"},
        # Just over one swing: from it the start of a piece is estimated where that is held out.
        "beginning": "1 s",
        "overrides": {
            # Phase and speed are second order in the micro-step: 7e-5 of the phase at 5 ms, which the length absorbs.
            "time": {"macro_step": "20 ms", "output_step": "20 ms"},
            "components": {
                "arm": {
                    "micro_step": "5 ms",
                    "parameters": {
                        "initial_angle": f"{float(values[0, 0])!r} rad",
                        "initial_angular_velocity": f"{float(values[1, 0])!r} rad/s",
                    },
                }
            },
        },
        # Both readings are smoothed by their authors, most of all at the ends of the whole swing. They disagree: the
        # derivative of the angle is off the velocity by 0.03 to 0.055 rad/s, its integral off the angle by 0.0025 to
        # 0.0056 rad (root mean squares over the pieces). So much is the noise of both.
        "uncertain": {"arm.initial_angle": "0.01 rad", "arm.initial_angular_velocity": "0.1 rad/s"},
        "channels": {
            "arm.angle": {"column": "angle", "unit": "rad", "noise": "0.004 rad"},
            "arm.angular_velocity": {"column": "angular_velocity", "unit": "rad/s", "noise": "0.05 rad/s"},
        },
    }
    kinds = {"id": "for identification", "vad": "held out by its authors"}
    return Part(f"{kind}_{number}", f"Free swing of one arm, piece {number} {kinds[kind]}", columns, sidecar)
