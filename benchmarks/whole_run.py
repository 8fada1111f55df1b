"""The whole prototype run against a bare Bullet loop with the same micro-steps and the same forces.

Both go on side by side in one process, second by second of simulated time, so that noise of the machine hits both: the
co-simulation makes its macro-steps while the spring constants it sends to Bullet are noted, then a second, bare world
takes the same micro-steps with the same constants. The bare loop reads the slides, applies the forces and steps Bullet;
it measures nothing, records nothing and has no circuit and no FMU. Both worlds pass through the same states.
"""

from __future__ import annotations

import argparse
import statistics
import time as clock
from typing import Any

import numpy as np

from benchmarks.machine import heading, results_folder
from cosim.algorithms.choose import PLAIN
from cosim.assemble import assemble
from cosim.components import nanoseconds
from cosim.observers.trace import Trace
from cosim.scenario import load_scenario
from mechanics.bullet import World, woven
from mechanics.fabric import layout
from mechanics.unit import FabricUnit


def measure(name: str, seconds_of_run: int) -> list[tuple[float, float]]:
    """Wall time [s] of (whole, bare) for each simulated second."""
    scenario = load_scenario(name)
    assembly = assemble(scenario)
    system = assembly.system
    fabric = system.units["fabric"]
    assert isinstance(fabric, FabricUnit)
    bare = World(fabric.design, layout(fabric.design), fabric.solver, woven(fabric.design, layout(fabric.design)))
    start, macro = nanoseconds(scenario.time.start), nanoseconds(scenario.time.macro_step)
    output = nanoseconds(scenario.time.output_step) // macro
    per_second = 1_000_000_000 // macro
    trace = Trace(system, list(range(start, nanoseconds(scenario.time.stop) + 1, output * macro)))
    system.initialise(start, assembly.start)
    trace.record(start)
    step, micro = PLAIN[scenario.algorithm.kind], round(macro / 1e9 / fabric.solver.micro_step)
    pairs, index = [], 0
    for _ in range(seconds_of_run):
        sent: list[tuple[Any, Any]] = []
        begin = clock.perf_counter()
        for _ in range(per_second):
            step(system, start + index * macro, macro)
            index += 1
            if index % output == 0:
                trace.record(start + index * macro)
            sent.append((fabric.get("stiffness").copy(), fabric.get("rest_length").copy()))
        middle = clock.perf_counter()
        for stiffness, rest_length in sent:
            bare.advance(micro, stiffness, rest_length)
        pairs.append((middle - begin, clock.perf_counter() - middle))
    assert np.array_equal(bare.motion().position, fabric._world.motion().position)  # type: ignore[union-attr]
    bare.close()
    system.terminate()
    return pairs


def main(arguments: list[str] | None = None) -> None:
    """Print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=int, default=20, help="simulated seconds per scenario")
    seconds = parser.parse_args(arguments).seconds
    lines = [
        heading("Whole run against a bare Bullet loop", "python -m benchmarks.whole_run"),
        "| scenario | simulated | whole run | bare loop | median ratio | quartiles of the ratio |",
        "|---|---|---|---|---|---|",
    ]
    for name in ("prototype_cantilever", "prototype_cantilever_instant"):
        pairs = measure(name, seconds)
        ratios = [whole / bare for whole, bare in pairs]
        low, middle, high = statistics.quantiles(ratios, n=4)
        lines.append(
            f"| {name} | {seconds} s | {sum(p[0] for p in pairs):.1f} s | {sum(p[1] for p in pairs):.1f} s | "
            f"{middle:.3f} | {low:.3f} to {high:.3f} |"
        )
    text = "\n".join(lines) + "\n"
    (results_folder() / "whole_run.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
