"""Jacobi: every unit steps with the outputs of the previous communication point."""

from __future__ import annotations

from cosim.system import System
from cosim.unit.protocol import StepOutcome


def step(system: System, time: int, size: int) -> StepOutcome:
    """Advance all units by one macro-step; the order of units does not matter.

    Sources (functions of time alone) are sampled first, so a switch acts in the step that begins with it. All other
    inputs are those of `time`, so each connection delays its value by one macro-step: first order in the step size.

    Args:
        system: The initialised system.
        time: Begin of the step [ns].
        size: Length of the step [ns].

    Returns:
        OK at `time + size`, or the first outcome that is not OK.

    Source: Kuebler and Schiehlen, Math. Comput. Model. Dyn. Syst. 6 (2000) 93-113 (parallel co-simulation).
    """
    system.sample_sources(time, size)
    system.propagate()
    for transfer in system.unsettled:
        transfer.carry_out()
    return system.step_together(system.movers, time, size)
