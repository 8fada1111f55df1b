"""How large the results of a run will be, and how long it may take: told before it begins.

`cosim validate` and `cosim run` estimate by the same numbers. Contacts are nearly all of the cost of a fabric.
"""

from __future__ import annotations

import math
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cosim.components import CircuitComponent, FabricComponent, Solver, nanoseconds
from cosim.observers.channels import recorded_channels
from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS
from cosim.unit.quantity import PhysicalValue

if TYPE_CHECKING:
    from cosim.assemble import Assembly
    from cosim.components import Component
    from cosim.scenario import Scenario
    from cosim.system import System

#: Processor time of one micro-step [s] for each free link of a fabric with 12 of them, Bullet with 200 iterations, and
#: the power of the number of free links with which it grows: contacts of Bullet cost the same in every fabric, MuJoCo
#: solves for all of them together. Source: benchmarks/results/fabric_size.md.
PER_FREE_LINK, GROWTH, OF = {"bullet": 2.5e-4, "mujoco": 2.7e-5}, {"bullet": 0.2, "mujoco": 1.2}, 12
#: Share of Bullet's time that iterations of its contact solver take, at 200 of them (decision 0015), and share of its
#: time that it needs with the friction pyramid (docs/engines.md).
SOLVER, ITERATIONS, PYRAMID = 0.83, 200, 0.6
#: Seconds for a solution of ngspice, and for a coil in it (a command each): benchmarks/results/units.md.
SOLUTION, COIL = 7e-5, 6e-6
#: Seconds for any other component and macro-step, and for a number that it passes on.
STEP, NUMBER = 5e-6, 1e-8
#: Working memory [byte]: of the program, of a fabric or circuit, of a link; and bytes for each byte recorded, which are
#: copied once when they are written. Measured: docs/scenarios.md.
PROGRAM, ENGINE, LINK, COPIES = 180e6, 25e6, 0.1e6, 2.0
#: Bytes of files for each byte recorded: checkpoints hold it once, series.csv as text; results.nc is compressed.
FILES = 4.0
#: The part of it that is certain: the values while the run goes on, and the checkpoints.
CERTAIN = 2.0
#: What takes less than this is not announced [s].
WORTH_SAYING = 120.0
#: MuJoCo's own step, and the share of Bullet's time below which it is proposed.
_STEP_OF_MUJOCO, _CLEARLY = Solver(micro_step=PhysicalValue(0.25, "ms")), 0.7


@dataclass(frozen=True)
class Estimate:
    """What a run takes.

    Args:
        steps: Macro-steps.
        outputs: Recorded times.
        bytes: Size of the recorded values.
        memory: Working memory [byte], right to a factor of one and a half or so.
        seconds: Computing time on one core [s], right to a factor of two or so.
        simulated: Simulated time [s].
    """

    steps: int
    outputs: int
    bytes: int
    memory: float
    seconds: float
    simulated: float

    @property
    def files(self) -> float:
        """Size of the run folder at most [byte]."""
        return FILES * self.bytes

    def __str__(self) -> str:
        rate = self.simulated / self.seconds
        return (
            f"{self.steps} macro-steps; {self.outputs} recorded times, {size_in_words(self.bytes)} of values; about "
            f"{size_in_words(self.memory)} of memory and up to {size_in_words(self.files)} of files; computing takes "
            f"about {_duration(self.seconds)}, {rate:.2g} simulated seconds a second (by size alone: a guess)"
        )


def estimate(assembly: Assembly) -> Estimate:
    """Size of the results, memory and computing time of a run, from sizes alone: nothing is simulated."""
    scenario, system = assembly.scenario, assembly.system
    time = scenario.time
    length = nanoseconds(time.stop) - nanoseconds(time.start)
    outputs = length // nanoseconds(time.output_step) + 1
    recorded = recorded_bytes(system, outputs)
    passed = {name: sum(v.size for v in unit.variables.values()) for name, unit in system.units.items()}
    memory = PROGRAM + COPIES * recorded + sum(_memory(c) for c in scenario.components.values())
    seconds = computing_time(scenario, passed=passed)
    return Estimate(scenario.time.macro_steps, outputs, recorded, memory, seconds, length / NANOSECONDS)


def recorded_bytes(system: System, outputs: int) -> int:
    """Size of the values that so many recorded times hold, their times included [byte]."""
    channels = recorded_channels(system)
    return outputs * (8 + sum(math.prod(c.variable.shape) * c.variable.type.dtype.itemsize for c in channels))


def refuse_too_large(scenario: Scenario, recorded: int, outputs: int, folder: Path | None) -> None:
    """Refuse a run whose values cannot be kept, before anything is reserved for them.

    Args:
        scenario: What is run.
        recorded: Size of its values [byte].
        outputs: Recorded times.
        folder: Run folder, which exists; None: everything stays in memory.

    Raises:
        InputError: The disk, or without a folder the memory, has less room.
    """
    needed, free = CERTAIN * recorded, None
    if folder is not None:
        free, where = float(shutil.disk_usage(folder).free), f"free on the disk of {folder}"
    else:
        needed, free, where = float(recorded), _free_memory(), "of free memory"
    if free is not None and needed > free:
        raise InputError(
            scenario.path or "scenario",
            "time.output_step",
            f"{scenario.time.macro_steps} macro-steps with {outputs} recorded times take {size_in_words(needed)}; "
            f"there are {size_in_words(free)} {where}",
            "take a longer output_step or a nearer stop" + ("" if folder is None else ", or make room"),
        )


def computing_time(scenario: Scenario, starts: int = 1, passed: Mapping[str, int] | None = None) -> float:
    """Processor time of a run [s], right within a factor of two or so.

    Args:
        scenario: Any.
        starts: How often it is run.
        passed: Numbers that components pass on in a macro-step, where they are known.
    """
    numbers = passed or {}
    steps = scenario.time.macro_steps
    return starts * sum(steps * _of_a_step(scenario, n, c, numbers.get(n, 0)) for n, c in scenario.components.items())


def announcement(scenario: Scenario, starts: int = 1, jobs: int = 1) -> str:
    """One sentence on a run that takes minutes, and what would make it shorter; empty where it is short."""
    seconds = computing_time(scenario, starts) / max(1, min(jobs, starts))
    if seconds < WORTH_SAYING:
        return ""
    links = sum(c.rows * (2 * c.columns - 1) for c in scenario.components.values() if isinstance(c, FabricComponent))
    what = f"{links} links" if links else f"{scenario.time.macro_steps} macro-steps"
    runs = f", {starts} starts" if starts > 1 else ""
    time = f"about {_duration(seconds)} on an idle machine{_faster(scenario)}"
    return f"{what}{runs}: {time}. Ctrl-C keeps what is computed."


def _of_a_step(scenario: Scenario, name: str, component: Component, numbers: int) -> float:
    """Computing time of a component for a macro-step [s]."""
    if isinstance(component, FabricComponent):
        micro = nanoseconds(scenario.time.macro_step) / nanoseconds(component.solver.micro_step)
        return micro * _of_a_micro_step(component)
    if isinstance(component, CircuitComponent):
        return SOLUTION + COIL * sum(component.strings)
    return STEP + NUMBER * numbers


def _of_a_micro_step(fabric: FabricComponent) -> float:
    free = (fabric.rows - fabric.tether.rows) * (2 * fabric.columns - 1)
    each = PER_FREE_LINK[fabric.engine] * float((free / OF) ** GROWTH[fabric.engine])
    if fabric.engine == "bullet":
        each *= 1.0 - SOLVER + SOLVER * fabric.solver.iterations / ITERATIONS
        each *= PYRAMID if fabric.solver.friction_model == "pyramid" else 1.0
    return each * free


def _memory(component: Component) -> float:
    """Working memory that a component takes beside the program's [byte]."""
    if isinstance(component, FabricComponent):
        return ENGINE + LINK * component.rows * (2 * component.columns - 1)
    return ENGINE if isinstance(component, CircuitComponent) else 0.0


def _free_memory() -> float | None:
    """Memory that can be had without swapping [byte]; None where the system does not tell."""
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return 1024.0 * int(line.split()[1])
    except (OSError, ValueError, IndexError):
        pass
    return None


def _faster(scenario: Scenario) -> str:
    """What the other engine would take, where it is clearly less."""
    slow = {n: c for n, c in scenario.components.items() if isinstance(c, FabricComponent) and c.engine == "bullet"}
    moved = {n: c.model_copy(update={"engine": "mujoco", "solver": _STEP_OF_MUJOCO}) for n, c in slow.items()}
    other = scenario.model_copy(update={"components": {**scenario.components, **moved}})
    share = computing_time(other) / computing_time(scenario)
    if not slow or share >= _CLEARLY:
        return ""
    return f"; with `--set {next(iter(slow))}.engine=mujoco` {100 * share:.0f} % of that"


def size_in_words(count: float) -> str:
    """Bytes as people read them."""
    for unit, size in (("TB", 10**12), ("GB", 10**9), ("MB", 10**6), ("kB", 10**3)):
        if count >= size:
            return f"{count / size:.3g} {unit}"
    return f"{count:.0f} bytes"


def _duration(seconds: float) -> str:
    """Time as people read it."""
    for unit, size in (("years", 3.156e7), ("days", 86400.0), ("hours", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.2g} {unit}" if seconds < 100.0 * size else f"{seconds / size:.0f} {unit}"
    return f"{seconds:.1g} s" if seconds < 10.0 else f"{seconds:.0f} s"
