"""Cost of every unit and of the algorithm per macro-step, for fabrics of 18, 72 and 288 links; memory."""

from __future__ import annotations

import statistics
import time as clock

from benchmarks.machine import heading, resident_memory, results_folder
from cosim.algorithms.choose import PLAIN
from cosim.assemble import assemble
from cosim.components import FmuComponent, ProgrammeComponent, nanoseconds
from cosim.scenario import Scenario, load_scenario
from cosim.unit.quantity import PhysicalValue

#: (rows, columns): rows * (2 * columns - 1) links.
SIZES = ((6, 2), (8, 5), (32, 5))


def fabric_of(rows: int, columns: int) -> Scenario:
    """The prototype under 6 V from the start, with another number of links, one string per row.

    The resistance rises with temperature here, so that the circuit is solved anew at every step.
    """
    base = load_scenario("prototype_cantilever")
    supply, actuator = base.components["supply"], base.components["actuator"]
    assert isinstance(supply, ProgrammeComponent)
    assert isinstance(actuator, FmuComponent)
    per_row = 2 * (2 * columns - 1)
    voltage = supply.outputs["voltage"].model_copy(update={"points": None, "constant": PhysicalValue(6.0, "V")})
    heated = {**actuator.parameters, "resistance_temperature_coefficient": PhysicalValue(1e-3, "1/K")}
    sized = {
        "supply": {"outputs": {"voltage": voltage}},
        "circuit": {"strings": [per_row] * rows},
        "actuator": {"structure": {"coils": rows * per_row}, "parameters": heated},
        "fabric": {"rows": rows, "columns": columns},
    }
    components = {n: c.model_copy(update=sized.get(n, {})) for n, c in base.components.items()}
    return base.model_copy(update={"components": components})


def measure(rows: int, columns: int, steps: int) -> dict[str, float]:
    """Medians per macro-step [us] of every unit and of the rest, and memory [MiB]."""
    before = resident_memory()
    scenario = fabric_of(rows, columns)
    assembly = assemble(scenario)
    system = assembly.system
    start, macro = nanoseconds(scenario.time.start), nanoseconds(scenario.time.macro_step)
    system.initialise(start, assembly.start)
    step = PLAIN[scenario.algorithm.kind]
    samples: dict[str, list[float]] = {name: [] for name in (*system.units, "algorithm and exchange")}
    for index in range(steps):
        units = dict(system.wall_time)
        begin = clock.perf_counter()
        step(system, start + index * macro, macro)
        whole = clock.perf_counter() - begin
        spent = {name: system.wall_time[name] - units[name] for name in units}
        for name, value in spent.items():
            samples[name].append(1e6 * value)
        samples["algorithm and exchange"].append(1e6 * (whole - sum(spent.values())))
    system.terminate()
    result = {name: statistics.median(values) for name, values in samples.items()}
    result["memory"] = resident_memory() - before
    return result


def main(arguments: list[str] | None = None) -> None:
    """Print and write the table."""
    del arguments
    tables = {rows * (2 * columns - 1): measure(rows, columns, 40 if rows < 20 else 15) for rows, columns in SIZES}
    names = list(next(iter(tables.values())))
    lines = [
        heading("Cost of a macro-step, by unit", "python -m benchmarks.units"),
        "Median microseconds per macro-step of 10 ms, with the shipped solver settings.\n",
        "| | " + " | ".join(f"{links} links" for links in tables) + " |",
        "|---|" + "---|" * len(tables),
    ]
    for name in names:
        unit = "MiB more" if name == "memory" else "us"
        lines.append(f"| {name} [{unit}] | " + " | ".join(f"{t[name]:.0f}" for t in tables.values()) + " |")
    text = "\n".join(lines) + "\n"
    (results_folder() / "units.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
