"""Gauss-Seidel: units step one after the other, each with the newest outputs."""

from __future__ import annotations

from cosim.system import System
from cosim.unit.protocol import StepOutcome, StepStatus


def step(system: System, time: int, size: int) -> StepOutcome:
    """Advance all units by one macro-step in the order of `system.units`.

    Outputs of units that have already stepped are those of `time + size`; feedback from units that come later is one
    macro-step old: first order in the step size, with a smaller constant than Jacobi.

    Args:
        system: The initialised system.
        time: Begin of the step [ns].
        size: Length of the step [ns].

    Returns:
        OK at `time + size`, or the first outcome that is not OK.

    Source: Kuebler and Schiehlen, Math. Comput. Model. Dyn. Syst. 6 (2000) 93-113 (sequential co-simulation).
    """
    system.sample_sources(time, size)
    system.propagate()
    for name in system.movers:
        system.exchange(name)
        outcome = system.step(name, time, size)
        if outcome.status is not StepStatus.OK:
            return outcome
    return StepOutcome(StepStatus.OK, time + size)
