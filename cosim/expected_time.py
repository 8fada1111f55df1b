"""How long a scenario with a fabric will take, before it begins: contacts are nearly all of its cost."""

from __future__ import annotations

from cosim.components import FabricComponent
from cosim.scenario import Scenario

#: Processor time of one micro-step [s] for each free link, with 200 iterations of Bullet.
#: Source: benchmarks/results/fabric_size.md.
PER_FREE_LINK = {"bullet": 2.1e-4, "mujoco": 3.5e-5}
#: Share of Bullet's time that iterations of its contact solver take, at 200 of them (decision 0015).
_SOLVER, _ITERATIONS = 0.83, 200
#: What takes less than this is not announced [s].
WORTH_SAYING = 120.0


def expected_time(scenario: Scenario, starts: int = 1) -> float:
    """Processor time of a run [s], without what is not a fabric; right within a factor of two or so.

    Args:
        scenario: Any.
        starts: How often it is run.
    """
    simulated = scenario.time.stop.to("s") - scenario.time.start.to("s")
    fabrics = [c for c in scenario.components.values() if isinstance(c, FabricComponent)]
    return starts * simulated * sum(_per_second(c) for c in fabrics)


def _per_second(fabric: FabricComponent) -> float:
    """Processor time per simulated second."""
    free = (fabric.rows - fabric.tether.rows) * (2 * fabric.columns - 1)
    share = 1.0
    if fabric.engine == "bullet":
        share = 1.0 - _SOLVER + _SOLVER * fabric.solver.iterations / _ITERATIONS
    return PER_FREE_LINK[fabric.engine] * share * free / fabric.solver.micro_step.to("s")


def announcement(scenario: Scenario, starts: int = 1, jobs: int = 1) -> str:
    """One sentence on a run that takes minutes, and what would make it shorter; empty where it is short."""
    seconds = expected_time(scenario, starts) / max(1, min(jobs, starts))
    if seconds < WORTH_SAYING:
        return ""
    slow = [n for n, c in scenario.components.items() if isinstance(c, FabricComponent) and c.engine == "bullet"]
    links = sum(c.rows * (2 * c.columns - 1) for c in scenario.components.values() if isinstance(c, FabricComponent))
    faster = f"; `--set {slow[0]}.engine=mujoco` takes a third of that" if slow else ""
    runs = f", {starts} starts" if starts > 1 else ""
    return f"{links} links{runs}: about {_in_words(seconds)} on an idle machine{faster}. Ctrl-C keeps what is computed."


def _in_words(seconds: float) -> str:
    minutes = seconds / 60.0
    return f"{minutes:.0f} min" if minutes < 90 else f"{minutes / 60:.1f} h"
