"""How long a scenario with a fabric will take, before it begins: contacts are nearly all of its cost."""

from __future__ import annotations

from cosim.components import FabricComponent, Solver
from cosim.scenario import Scenario
from cosim.unit.quantity import PhysicalValue

#: Processor time of one micro-step [s] for each free link of a fabric with 12 of them, Bullet with 200 iterations, and
#: the power of the number of free links with which it grows: contacts of Bullet cost the same in every fabric, MuJoCo
#: solves for all of them together. Source: benchmarks/results/fabric_size.md.
PER_FREE_LINK, GROWTH, _OF = {"bullet": 2.5e-4, "mujoco": 5e-5}, {"bullet": 0.2, "mujoco": 1.1}, 12
#: Share of Bullet's time that iterations of its contact solver take, at 200 of them (decision 0015).
_SOLVER, _ITERATIONS = 0.83, 200
#: MuJoCo's own step, and the share of Bullet's time below which it is proposed.
_STEP_OF_MUJOCO, _CLEARLY = Solver(micro_step=PhysicalValue(0.25, "ms")), 0.7
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
    each = PER_FREE_LINK[fabric.engine] * float((free / _OF) ** GROWTH[fabric.engine])
    return each * share * free / fabric.solver.micro_step.to("s")


def announcement(scenario: Scenario, starts: int = 1, jobs: int = 1) -> str:
    """One sentence on a run that takes minutes, and what would make it shorter; empty where it is short."""
    seconds = expected_time(scenario, starts) / max(1, min(jobs, starts))
    if seconds < WORTH_SAYING:
        return ""
    links = sum(c.rows * (2 * c.columns - 1) for c in scenario.components.values() if isinstance(c, FabricComponent))
    runs = f", {starts} starts" if starts > 1 else ""
    time = f"about {_in_words(seconds)} on an idle machine{_faster(scenario)}"
    return f"{links} links{runs}: {time}. Ctrl-C keeps what is computed."


def _faster(scenario: Scenario) -> str:
    """What the other engine would take, where it is clearly less."""
    slow = {n: c for n, c in scenario.components.items() if isinstance(c, FabricComponent) and c.engine == "bullet"}
    moved = {n: c.model_copy(update={"engine": "mujoco", "solver": _STEP_OF_MUJOCO}) for n, c in slow.items()}
    other = scenario.model_copy(update={"components": {**scenario.components, **moved}})
    share = expected_time(other) / expected_time(scenario)
    return f"; with `--set {next(iter(slow))}.engine=mujoco` {100 * share:.0f} % of that" if share < _CLEARLY else ""


def _in_words(seconds: float) -> str:
    minutes = seconds / 60.0
    return f"{minutes:.0f} min" if minutes < 90 else f"{minutes / 60:.1f} h"
