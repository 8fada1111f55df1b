"""Step of a network: as long as its error stays far below the noise, found by halving."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from diagnosis.models.coil_network.kernel.inputs import CoilNetworkInputs, Drive, grid
from diagnosis.models.coil_network.kernel.layout import Array
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters

#: Longest step where the readings lie close together, and the shortest of all [s]; each is half of the one before.
USUAL, SHORTEST = 0.4, 0.0125
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
    inputs: CoilNetworkInputs
    error: float


def choose_step(
    network: CoilNetwork,
    parameters: CoilNetworkParameters,
    drive: Drive,
    start: float,
    times: Mapping[str, Array],
    deviations: Mapping[str, float],
    fastest: CoilNetworkParameters | None = None,
) -> StepChoice:
    """The longest step with an error below `SHARE` of the noise.

    Inputs are constant within a step and each state has its exact exponential there, so that a step may be longer than
    a time constant. What limits it is the temperature's curvature in what depends on it (resistance, convection,
    stiffness), and the straight line between ends of steps on which readings lie. Steps up to `USUAL` are always tried;
    longer ones, up to the interval between readings, where the readings are farther apart: a reading that a law bends
    within one step (an instant, a lag) is then next to an end of it. Every point of a recorded input is an end of a
    step; with long steps, points that are alike are taken together where that keeps the error small as well.

    Args:
        network: The network.
        parameters: Where to judge; a candidate of interest may be switched on.
        drive: What drives it; its switches fall on ends of steps.
        start: First instant of the simulation [s].
        times: Sample times of each quantity that is measured [s].
        deviations: Standard deviation of the noise of each of them, SI.
        fastest: Where steps beyond `USUAL` are judged too: the fastest rig that the fit may come to; None: nowhere.

    Returns:
        The choice; the shortest step with its error if none is good enough.
    """
    stop = max(float(t[-1]) for t in times.values())
    switches = drive.switches()
    judges = [parameters] if fastest is None else [parameters, fastest]

    def simulated(step: float, at: CoilNetworkParameters) -> tuple[CoilNetworkInputs, dict[str, Array]]:
        inputs = drive.on_grid(grid(start, stop, step, switches))
        return inputs, network.simulate(at, inputs, times)

    def change(now: Mapping[str, Array], then: Mapping[str, Array]) -> float:
        return max(float(np.abs(now[q] - then[q]).max(initial=0.0)) / deviations[q] for q in times)

    step = longest(times)
    inputs, now = simulated(step, parameters)
    while True:
        finer, then = simulated(0.5 * step, parameters)
        error = change(now, then)
        if step > USUAL and fastest is not None and error < SHARE:
            error = max(error, change(simulated(step, fastest)[1], simulated(0.5 * step, fastest)[1]))
        span = step
        while step > USUAL and error < SHARE and span > USUAL:
            merged = drive.thinned(span)
            thin = merged.on_grid(grid(start, stop, step, merged.switches()))
            if 2 * len(thin.time) > len(inputs.time):
                break  # the input is not recorded more densely than the steps are long
            away = max(change(network.simulate(p, thin, times), network.simulate(p, inputs, times)) for p in judges)
            if error + away < SHARE:
                return StepChoice(step, thin, error + away)
            span *= 0.5
        if error < SHARE or step <= SHORTEST:
            return StepChoice(step, inputs, error)
        step, inputs, now = 0.5 * step, finer, then


def longest(times: Mapping[str, Array]) -> float:
    """Longest step to try [s]: `USUAL` times a power of 2, at most the usual interval of the densest readings."""
    intervals = [float(np.median(np.diff(t))) for t in times.values() if t.size > 1]
    step = USUAL
    while intervals and 2.0 * step <= min(intervals) * (1.0 + 1e-9):
        step *= 2.0
    return step
