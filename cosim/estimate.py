"""How large the results of a run will be, and how long it may take: told before it begins."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cosim.assemble import Assembly
from cosim.components import CircuitComponent, FabricComponent, nanoseconds
from cosim.observers.channels import recorded_channels
from cosim.unit.protocol import NANOSECONDS

#: Seconds of a micro-step for a link: in Bullet by iteration, at least so much; in MuJoCo (benchmarks/results/engines).
BULLET, LEAST_BULLET, MUJOCO = 0.65e-6, 4e-5, 1.2e-5
#: Share of its time that Bullet needs with the friction pyramid.
PYRAMID = 0.6
#: Seconds for a solution of ngspice, and for a coil in it (a command each): benchmarks/results/units.md.
SOLUTION, COIL = 7e-5, 6e-6
#: Seconds for any other component and macro-step, and for a number that it passes on.
STEP, NUMBER = 5e-6, 1e-8


@dataclass(frozen=True)
class Estimate:
    """What a run takes.

    Args:
        outputs: Recorded times.
        bytes: Size of the recorded values in memory, and on the disk before they are compressed.
        seconds: Computing time on one core, right to a factor of three or so.
        simulated: Simulated time [s].
    """

    outputs: int
    bytes: int
    seconds: float
    simulated: float

    def __str__(self) -> str:
        rate = self.simulated / self.seconds
        return (
            f"{self.outputs} recorded times, {_size(self.bytes)}; computing takes about {_duration(self.seconds)}, "
            f"{rate:.2g} simulated seconds a second (by size alone: a guess)"
        )


def estimate(assembly: Assembly) -> Estimate:
    """Size of the results and computing time of a run, from sizes alone: nothing is simulated."""
    scenario = assembly.scenario
    time = scenario.time
    length = nanoseconds(time.stop) - nanoseconds(time.start)
    outputs = length // nanoseconds(time.output_step) + 1
    row = sum(math.prod(c.variable.shape) * c.variable.type.dtype.itemsize for c in recorded_channels(assembly.system))
    steps = length / nanoseconds(time.macro_step)
    each = sum(_of_a_step(assembly, name) for name in scenario.components)
    return Estimate(outputs, outputs * (row + 8), steps * each, length / NANOSECONDS)


def _of_a_step(assembly: Assembly, name: str) -> float:
    """Computing time of a component for a macro-step [s]."""
    component = assembly.scenario.components[name]
    variables = assembly.system.units[name].variables
    if isinstance(component, FabricComponent):
        links = variables["link_length"].size
        micro = nanoseconds(assembly.scenario.time.macro_step) / nanoseconds(component.solver.micro_step)
        return micro * links * _of_a_link(component)
    if isinstance(component, CircuitComponent):
        return SOLUTION + COIL * variables["resistance"].size
    return STEP + NUMBER * sum(v.size for v in variables.values())


def _of_a_link(fabric: FabricComponent) -> float:
    if fabric.engine == "mujoco":
        return MUJOCO
    share = PYRAMID if fabric.solver.friction_model == "pyramid" else 1.0
    return max(share * BULLET * fabric.solver.iterations, LEAST_BULLET)


def _size(count: int) -> str:
    """Bytes as people read them."""
    for unit, size in (("GB", 10**9), ("MB", 10**6), ("kB", 10**3)):
        if count >= size:
            return f"{count / size:.3g} {unit}"
    return f"{count} bytes"


def _duration(seconds: float) -> str:
    """Time as people read it."""
    for unit, size in (("days", 86400.0), ("hours", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.2g} {unit}"
    return f"{seconds:.1g} s" if seconds < 10.0 else f"{seconds:.0f} s"
