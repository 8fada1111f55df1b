"""Curvature, overlap, length and cost of the prototype fabric against micro-step and solver iterations."""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import heading, results_folder
from cosim.mechanics_assembly import FABRIC_UNITS
from cosim.parameters import resolve
from cosim.scenario import scenario_folder
from cosim.unit.protocol import UnitError
from cosim.unit.quantity import PhysicalValue
from mechanics.fabric import FabricDesign
from mechanics.solver import SolverSettings
from mechanics.unit import FabricUnit

#: Spring constants of equation (2) at 22 and at 70 degC [N/m]; rest length of the coil [m].
COLD, HOT, REST_LENGTH = 157.1, 356.0, 9.4e-3
#: Nanoseconds between two outputs.
MACRO_STEP = 10_000_000
#: Overlap that ends a run [m]: two bars that deep in each other have begun to pass through.
ESCAPED = 4e-3
#: (micro-step [ms], iterations, number of starts), cheap ones first. What is left out costs more than all the rest.
CELLS = (
    (1.0, 50, 1),
    (0.5, 50, 1),
    (0.5, 100, 2),
    (0.5, 200, 3),
    (1.0, 200, 1),
    (0.25, 50, 1),
    (0.25, 200, 1),
    (0.5, 1000, 1),
)
QUICK = ((1.0, 50, 1), (0.5, 50, 1))


@dataclass(frozen=True)
class Drape:
    """What one start gave.

    Args:
        curvature: Mean maximum curvature over the last second: cold, hot, re-cooled [1/m]; nan where not reached.
        penetration: Deepest overlap [m].
        seconds: Processor time per simulated second.
        failure: What ended it early, or nothing.
    """

    curvature: tuple[float, float, float]
    penetration: float
    seconds: float
    failure: str = ""


def prototype(**changes: Any) -> FabricDesign:
    """The 6 x 2 cantilever with the shipped parameters, with changes."""
    values = resolve("prototype_links", {}, scenario_folder() / "benchmark.yaml").values
    numbers: dict[str, Any] = {k: v.to(FABRIC_UNITS[k]) for k, v in values.items() if isinstance(v, PhysicalValue)}
    base: dict[str, Any] = {"rows": 6, "columns": 2, "tether_rows": 2, "tether_kind": "cantilever", **numbers}
    return FabricDesign(**{**base, **changes})


def woven_unit(design: FabricDesign, solver: SolverSettings, start: int) -> FabricUnit:
    """A fabric at its woven start; starts above 0 give the free links speeds of up to 1 mm/s."""
    unit = FabricUnit("fabric", design, solver)
    unit.set("stiffness", np.full(2 * design.links, COLD))
    unit.set("rest_length", np.full(2 * design.links, REST_LENGTH))
    unit.initialise(0)
    if start:
        state = unit.checkpoint()
        speeds = np.random.default_rng(start).uniform(-0.1, 0.1, (design.links, 3))  # cm/s
        held = design.tether_rows * design.links_per_row
        state["motion.velocity"][held:] += speeds[held:]
        unit.resume(state, 0)
    return unit


def phase(unit: FabricUnit, stiffness: float, seconds: float, begin: int, output: str) -> Iterator[tuple[float, float]]:
    """One output and the deepest overlap, macro-step by macro-step, under one spring constant."""
    unit.set("stiffness", np.full(unit.variables["stiffness"].shape, stiffness))
    for index in range(round(seconds * 1e9) // MACRO_STEP):
        unit.do_step(begin + index * MACRO_STEP, MACRO_STEP)
        yield float(unit.get(output)), float(unit.get("max_penetration"))


def drape(
    micro_step: float, iterations: int, start: int, durations: tuple[float, float, float], **changes: Any
) -> Drape:
    """Cold, hot at once, cold again; see `Drape`."""
    unit = woven_unit(prototype(**changes), SolverSettings(micro_step, iterations, ESCAPED), start)
    found, worst, now, failure = [math.nan] * 3, 0.0, 0, ""
    began = time.process_time()
    try:
        for index, (stiffness, duration) in enumerate(zip((COLD, HOT, COLD), durations)):
            series = []
            for value, overlap in phase(unit, stiffness, duration, now, "max_curvature"):
                series.append(value)
                worst, now = max(worst, overlap), now + MACRO_STEP
            found[index] = float(np.mean(series[-100:]))
    except UnitError as error:
        failure = error.what
    taken = time.process_time() - began
    unit.terminate()
    return Drape((found[0], found[1], found[2]), worst, taken / max(1e-9 * now, 0.01), failure)


def hanging(micro_step: float, iterations: int, seconds: float) -> tuple[float, float]:
    """Length cold and hot of the fabric hung by its first row [m]; mean over the last half second."""
    design = prototype(tether_kind="hanging", tether_rows=1, gravity=(0.0, 9.81, 0.0))
    unit = woven_unit(design, SolverSettings(micro_step, iterations, ESCAPED), 0)
    lengths = []
    for index, stiffness in enumerate((COLD, HOT)):
        series = phase(unit, stiffness, seconds, round(index * seconds * 1e9), "fabric_length")
        try:
            lengths.append(float(np.mean([length for length, _ in series][-50:])))
        except UnitError:
            lengths.append(math.nan)
            break
    unit.terminate()
    return lengths[0], lengths[-1]


def spread(values: list[float]) -> str:
    """Median, and the range where there are several."""
    known = [v for v in values if not math.isnan(v)]
    if not known:
        return "-"
    middle = f"{np.median(known):.2f}"
    return middle if len(known) == 1 else f"{middle} ({min(known):.2f}-{max(known):.2f})"


def row(micro_ms: float, iterations: int, starts: int, durations: tuple[float, float, float]) -> str:
    """One line of the table."""
    runs = [drape(1e-3 * micro_ms, iterations, s, durations) for s in range(starts)]
    lengths = hanging(1e-3 * micro_ms, iterations, min(2.0, durations[0]))
    cells = [spread([r.curvature[i] for r in runs]) for i in range(3)]
    seconds = float(np.median([r.seconds for r in runs]))
    failed = sum(bool(r.failure) for r in runs)
    cells += [f"{1e3 * max(r.penetration for r in runs):.3f}", str(failed)]
    cells += [f"{100 * length:.2f}" for length in lengths]
    cells += [f"{seconds * micro_ms:.2f}", f"{seconds:.2f}"]
    return f"| {micro_ms:g} | {iterations} | {starts} | {' | '.join(cells)} |"


def table(cells: tuple[tuple[float, int, int], ...], durations: tuple[float, float, float]) -> Iterator[str]:
    """Lines of the table, as they are measured."""
    cold, hot, again = durations
    yield (
        f"Prototype cantilever from flat: {cold:g} s at {COLD} N/m, {hot:g} s at {HOT} N/m (switched at once, the "
        f"hardest case), {again:g} s at {COLD} N/m. Curvature in 1/m: mean over the last second of each, median over "
        "the starts and, in brackets, their range. Starts differ by speeds of up to 1 mm/s of the free links: their "
        "range is the yardstick, how far the fabric itself, not the solver, decides. Overlap: the worst of all starts. "
        f"Failed: starts that ended because links tore free or overlapped by more than {1e3 * ESCAPED:g} mm. Hung "
        "lengths: hung by the first row, 2 s each, one start. Times: of the processor, on one core. Cells that "
        "are missing, and starts that are fewer, cost too much.\n"
    )
    yield (
        "| micro-step [ms] | iterations | starts | cold | hot | re-cooled | worst overlap [mm] | failed "
        "| hung cold [cm] | hung hot [cm] | ms per micro-step | s per simulated s |"
    )
    yield "|" + "---|" * 12
    for micro_ms, iterations, starts in cells:
        yield row(micro_ms, iterations, starts, durations)


def main(arguments: list[str] | None = None) -> None:
    """Print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=None, help="file of the table (default: benchmarks/results)")
    parser.add_argument("--quick", action="store_true", help="two cells and short runs, to see that it works")
    given = parser.parse_args(arguments)
    target = given.output or results_folder() / "bullet_convergence.md"
    lines = [heading("Convergence of the Bullet fabric", "python -m benchmarks.bullet_convergence")]
    cells, durations = (QUICK, (1.0, 1.0, 1.0)) if given.quick else (CELLS, (2.0, 3.0, 3.0))
    for line in table(cells, durations):
        print(line, flush=True)
        lines.append(line)
        target.write_text("\n".join(lines) + "\n")  # what is measured stays, whatever stops the rest


if __name__ == "__main__":
    main()
