"""Step of a bank: as long as its error stays far below the noise, found by halving."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from diagnosis.bank.bank import Bank
from diagnosis.bank.inputs import BankInputs, Drive, grid
from diagnosis.bank.layout import Array
from diagnosis.bank.parameters import BankParameters

#: Steps to try [s].
STEPS = (0.4, 0.2, 0.1, 0.05, 0.025, 0.0125)
#: Largest error that is accepted, in deviations: it adds 0.0025 to the mean square of a residual.
SHARE = 0.05


@dataclass(frozen=True)
class StepChoice:
    """A step and what it was judged by.

    Args:
        step: Longest step [s].
        inputs: The drive on that grid.
        error: Largest change of a sample, in deviations, when the step is halved once more.
    """

    step: float
    inputs: BankInputs
    error: float


def choose_step(
    bank: Bank,
    parameters: BankParameters,
    drive: Drive,
    start: float,
    times: Mapping[str, Array],
    deviations: Mapping[str, float],
) -> StepChoice:  # fmt: skip
    """The longest of `STEPS` with an error below `SHARE` of the noise.

    Args:
        bank: The bank.
        parameters: Where to judge; a candidate of interest may be switched on.
        drive: What drives it; its switches fall on ends of steps.
        start: First instant of the simulation [s].
        times: Sample times of each quantity that is measured [s].
        deviations: Standard deviation of the noise of each of them, SI.

    Returns:
        The choice; the last of `STEPS` with its error if none is good enough.
    """
    stop = max(float(t[-1]) for t in times.values())
    switches = drive.switches()
    choice = None
    last = None
    for step in [*STEPS, 0.5 * STEPS[-1]]:
        inputs = drive.on_grid(grid(start, stop, step, switches))
        now = bank.simulate(parameters, inputs, times)
        if last is not None and choice is not None:
            error = max(float(np.abs(now[q] - last[q]).max()) / deviations[q] for q in times)
            choice = StepChoice(choice.step, choice.inputs, error)
            if error < SHARE or step < STEPS[-1]:
                return choice
        choice, last = StepChoice(step, inputs, np.inf), now
    assert choice is not None
    return choice
