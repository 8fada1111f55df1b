"""What a process of its own costs an FMU: start, one macro-step, and two FMUs at the same time.

A macro-step sets every input, steps and reads every output. The FMU without a process and the one with it go on side by
side, in turns of 200 steps, so that noise of the machine hits both.
"""

from __future__ import annotations

import os
import statistics
import time as clock
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.machine import heading, results_folder
from benchmarks.models.build import DEFAULT, build
from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.settings import FmuSettings
from cosim.isolation.limits import Limits
from cosim.isolation.unit import IsolatedUnit
from cosim.shipped import fmu_folder
from cosim.unit.protocol import Causality, Unit

SIZE = 10_000_000
TURNS, STEPS = 20, 200
#: Values of inputs by their unit.
LEVELS = {"W": 0.3, "K": 295.0, "1": 1.0}


def load(path: Path, is_isolated: bool, coils: int | None = None) -> Unit:
    """An FMU, ready to be initialised."""
    archive = open_fmu(path)
    make = partial(CoSimulationUnit, "unit", archive, FmuSettings({} if coils is None else {"coils": coils}))
    return IsolatedUnit("unit", make, Limits(), archive) if is_isolated else make()


def stepper(unit: Unit) -> Callable[[int], list[float]]:
    """A function that makes macro-steps and returns the wall time of each [us]."""
    inputs = [
        (n, np.full(v.shape, LEVELS[v.unit])) for n, v in unit.variables.items() if v.causality is Causality.INPUT
    ]
    outputs = [n for n, v in unit.variables.items() if v.causality is Causality.OUTPUT]
    for name, value in inputs:
        unit.set(name, value)
    unit.initialise(0)
    unit.exit_initialisation()
    now = 0

    def advance(steps: int) -> list[float]:
        nonlocal now
        spent = []
        for _ in range(steps):
            begin = clock.perf_counter()
            for name, value in inputs:
                unit.set(name, value)
            unit.do_step(now, SIZE)
            for name in outputs:
                unit.get(name)
            spent.append(1e6 * (clock.perf_counter() - begin))
            now += SIZE
        return spent

    return advance


def macro_step(path: Path, coils: int | None) -> str:
    """Row of the table: a macro-step without and with a process [us]."""
    units = [load(path, is_isolated, coils) for is_isolated in (False, True)]
    advances = [stepper(unit) for unit in units]
    spent: tuple[list[float], list[float]] = ([], [])
    for _ in range(TURNS):
        for advance, times in zip(advances, spent):
            times.extend(advance(STEPS))
    for unit in units:
        unit.terminate()
    medians = [statistics.median(times) for times in spent]
    tenths = [statistics.quantiles(times, n=10)[-1] for times in spent]
    return f"{medians[0]:.1f} | {medians[1]:.1f} | {medians[1] - medians[0]:.1f} | {tenths[0]:.1f} | {tenths[1]:.1f}"


def start_and_end(path: Path, count: int = 9) -> tuple[float, float]:
    """Median wall time of the start and of the end of an isolated FMU [ms], without extracting it."""
    starts, ends = [], []
    for _ in range(count):
        archive = open_fmu(path)
        begin = clock.perf_counter()
        unit = IsolatedUnit("unit", partial(CoSimulationUnit, "unit", archive, FmuSettings()), Limits(), archive)
        middle = clock.perf_counter()
        unit.terminate()
        starts.append(1e3 * (middle - begin))
        ends.append(1e3 * (clock.perf_counter() - middle))
    return statistics.median(starts), statistics.median(ends)


def two_at_a_time(path: Path, coils: int) -> tuple[float, float]:
    """Median wall time of a step of two FMUs, one after the other and at the same time [us]."""
    units = [load(path, True, coils) for _ in range(2)]
    for unit in units:
        stepper(unit)(1)
    after, together = [], []
    for k in range(1, 2 * TURNS):
        begin = clock.perf_counter()
        for unit in units:
            unit.do_step(2 * k * SIZE - SIZE, SIZE)
        middle = clock.perf_counter()
        for unit in units:
            unit.begin_step(2 * k * SIZE, SIZE)  # type: ignore[attr-defined]
        for unit in units:
            unit.finish_step()  # type: ignore[attr-defined]
        after.append(1e6 * (middle - begin))
        together.append(1e6 * (clock.perf_counter() - middle))
    for unit in units:
        unit.terminate()
    return statistics.median(after), statistics.median(together)


def main(arguments: list[str] | None = None) -> None:
    """Print and write the tables."""
    build(DEFAULT)
    actuator = fmu_folder() / "thermal_stiffness_fmi3.fmu"
    cases = {
        "feedthrough, FMI 2.0, 1 input, 1 output": (DEFAULT / "feedthrough_fmi2.fmu", None),
        "thermal_stiffness, FMI 3.0, 36 coils": (actuator, 36),
        "thermal_stiffness, FMI 3.0, 1000 coils": (actuator, 1000),
    }
    lines = [
        heading("FMUs in processes of their own", "python -m benchmarks.isolation"),
        "Microseconds per macro-step: all inputs set, a step, all outputs read.\n",
        "| FMU | no process | process | cost of the process | slowest tenth: no process | process |",
        "|---|---|---|---|---|---|",
    ]
    lines += [f"| {name} | {macro_step(*case)} |" for name, case in cases.items()]
    start, end = start_and_end(actuator)
    after, together = two_at_a_time(actuator, 20_000)
    ratio = after / together
    lines += [
        f"\nStart of a process with its FMU {start:.0f} ms, end {end:.0f} ms (medians).\n",
        f"Two FMUs of 20,000 coils, us per step: one after the other (`do_step`) {after:.0f}, at the same time "
        f"(`begin_step`, `finish_step`) {together:.0f}, {ratio:.2f} times faster; load of the machine meanwhile "
        f"{os.getloadavg()[0]:.1f} on {os.cpu_count()} cores.",
    ]
    text = "\n".join(lines) + "\n"
    (results_folder() / "isolation.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
