"""Error against macro-step: the electro-thermal loop alone, and the whole prototype."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.machine import heading, results_folder
from chainmail.measures import half_way_delay, plateau
from cosim.run import run
from cosim.scenario import Scenario, load_scenario
from cosim.unit.quantity import PhysicalValue

#: Macro-steps of the electro-thermal loop and of the prototype [ms]; its switching times allow divisors of 10 ms only.
LOOP_STEPS = (400, 200, 100, 50)
PROTOTYPE_STEPS = (10, 5)


def with_steps(scenario: Scenario, macro_ms: float, **more: Any) -> Scenario:
    """The scenario with another macro-step."""
    time = scenario.time.model_copy(update={"macro_step": PhysicalValue(macro_ms, "ms"), **more})
    return scenario.model_copy(update={"time": time})


def loop(kind: str, macro_ms: float) -> np.ndarray[Any, Any]:
    """Temperatures [K] of single coils whose resistance rises by 0.1 % per kelvin, after 8 s of heating."""
    base = load_scenario("single_coil_heating")
    actuator = base.components["actuator"]
    values = {**getattr(actuator, "parameters", {}), "resistance_temperature_coefficient": PhysicalValue(1e-3, "1/K")}
    components = {**base.components, "actuator": actuator.model_copy(update={"parameters": values})}
    points = components["supply"].outputs["voltage"]  # type: ignore[union-attr]
    first = points.model_copy(update={"points": points.points[:1]})  # type: ignore[index]
    components["supply"] = components["supply"].model_copy(update={"outputs": {"voltage": first}})
    scenario = base.model_copy(
        update={"components": components, "algorithm": base.algorithm.model_copy(update={"kind": kind})}
    )
    scenario = with_steps(
        scenario,
        macro_ms,
        stop=PhysicalValue(8.0, "s"),
        output_step=PhysicalValue(0.4, "s"),
        checkpoint_step=PhysicalValue(8.0, "s"),
    )
    return np.array(run(scenario)["actuator.temperature"].values[-1])


def loop_table() -> list[str]:
    """Largest error over six voltages, against 1 ms, and the observed order."""
    lines = [
        "## Electro-thermal loop (R rises by 0.1 %/K), error of temperature after 8 s\n",
        "| macro-step [ms] | jacobi [K] | order | gauss_seidel [K] | order |",
        "|" + 5 * "---|",
    ]
    reference = loop("gauss_seidel", 1.0)
    errors = {k: [np.abs(loop(k, h) - reference).max() for h in LOOP_STEPS] for k in ("jacobi", "gauss_seidel")}
    for i, size in enumerate(LOOP_STEPS):
        cells = []
        for values in errors.values():
            order = math.log2(values[i - 1] / values[i]) if i else math.nan
            cells += [f"{values[i]:.2e}", f"{order:.2f}" if i else ""]
        lines.append(f"| {size} | " + " | ".join(cells) + " |")
    return lines


def prototype_row(macro_ms: float) -> str:
    """Measures of Figure 3 with one macro-step."""
    scenario = load_scenario("prototype_cantilever")
    result = run(with_steps(scenario, macro_ms, output_step=PhysicalValue(20.0, "ms")))
    kappa = result["fabric.max_curvature"] / 100
    cold, hot, again = plateau(kappa, -0.5, 0.36), plateau(kappa, 11.6, 12.6), plateau(kappa, 30.0, 32.0)
    on = half_way_delay(kappa.sel(time=slice(None, 12.6)), 0.37, cold, hot)
    off = half_way_delay(kappa, 12.6, hot, again)
    worst = 1e3 * float(result["fabric.max_penetration"].max())
    hottest = float(result["actuator.temperature"].max()) - 273.15
    return (
        f"| {macro_ms:g} | {cold:.4f} | {hot:.4f} | {again:.4f} | {on:.2f} | {off:.2f} | {hottest:.4f} | {worst:.3f} |"
    )


def main(arguments: list[str] | None = None) -> None:
    """Print and write the tables."""
    del arguments
    lines = [
        heading("Macro-step", "python -m benchmarks.macro_step"),
        *loop_table(),
        "",
        "## Prototype cantilever\n",
        "| macro-step [ms] | cold [1/cm] | hot [1/cm] | re-cooled [1/cm] | delay on [s] | delay off [s] "
        "| hottest coil [degC] | worst overlap [mm] |",
        "|---|---|---|---|---|---|---|---|",
    ]
    lines += [prototype_row(size) for size in PROTOTYPE_STEPS]
    text = "\n".join(lines) + "\n"
    (results_folder() / "macro_step.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
