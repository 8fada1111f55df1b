"""`python -m evaluation.systems.walk DIR`: what a new user has at first, an FMU and tables of a logger.

The FMU stands for one that another tool has exported: a slide on a spring, linear, as a data sheet would have it. The
tables come from the truth of `evaluation.systems`: two numbers are a few per cent off, and the slide rubs.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from evaluation.systems.case import course, drive
from evaluation.systems.effects import Effect
from evaluation.systems.rigs import SLIDE

#: Friction of the truth over the mass [m/s^2], and velocity below which its sign is rounded [m/s].
FRICTION, ROUNDING = 0.25, 2e-3
#: Noise of the encoder [m].
NOISE = 2e-4
#: What is off, as factors of the FMU's numbers.
OFF = {"m": 1.03, "c": 0.95, "k": 1.02}
#: Table to the seed of its drive.
TABLES = {"monday": 11, "tuesday": 12}


def main() -> int:
    """Returns the exit code."""
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    SLIDE.models["slide"].build(folder)
    friction = Effect("dry_friction", "slide.v", ("dry_friction",), 1, _rubs)
    numbers = {name: value * OFF[name] for name, value in SLIDE.numbers.items()}
    for name, seed in TABLES.items():
        rng = np.random.default_rng(seed)
        force = drive(SLIDE, rng)
        position = course(SLIDE, numbers, force, [friction])[:, 0] + NOISE * rng.standard_normal(SLIDE.count)
        times = SLIDE.step * np.arange(SLIDE.count)
        rows = np.column_stack([times, force[:, 0], 1e3 * position])
        header = "time_s,force_N,position_mm"
        np.savetxt(
            folder / f"{name}.csv", rows, delimiter=",", header=header, comments="", fmt=("%.3f", "%.4f", "%.3f")
        )
    return 0


def _rubs(states: np.ndarray[tuple[int], np.dtype[np.float64]], _: object, __: float) -> float:
    return -FRICTION * float(np.tanh(states[1] / ROUNDING))


if __name__ == "__main__":
    sys.exit(main())
