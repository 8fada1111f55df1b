"""Simulations of the tests: functions of a module, so that other processes find them."""

from __future__ import annotations

import os
import time as clock
from collections.abc import Callable
from pathlib import Path

import numpy as np

from cosim.compute.result import Result


def square(shared: float, given: float) -> Result:
    """One array: `shared * given**2` at full precision, and the process that made it."""
    if given < 0:
        return Result((), f"{given} is below 0", 0.5)
    return Result((np.array([shared * given**2, 1 / 3]), np.array([os.getpid()])), "", 0.5)


def interrupted_at_three(shared: float, given: float) -> Result:
    """The user presses Ctrl-C in the simulation of 3."""
    if given == 3:
        raise KeyboardInterrupt
    return square(shared, given)


def slow(shared: Path, given: float) -> Result:
    """A simulation of a tenth of a second that leaves a mark when it begins."""
    (shared / f"begun-{given}").touch()
    clock.sleep(0.1)
    return square(1.0, given)


def deadly(shared: float, given: float) -> Result:
    """A simulation that takes its process with it, as one that runs out of memory does."""
    os._exit(1)


def squares(offset: int) -> Callable[[int], tuple[int, int]]:
    """Answers with the process and the square of a number, and an offset."""

    def answer(number: int) -> tuple[int, int]:
        if number < 0:
            raise ValueError(f"{number} has no square here")
        return os.getpid(), number**2 + offset

    return answer


def no_squares(offset: int) -> Callable[[int], tuple[int, int]]:
    """Cannot be made."""
    raise RuntimeError(f"no squares and {offset}")
