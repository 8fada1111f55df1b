"""ecos: two FMI 3.0 FMUs, an array of three elements connected to an array of three elements."""

from __future__ import annotations

from pathlib import Path

from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure

from benchmarks.peers.probes.finding import fmu, report


def probe(work: Path) -> str:
    """Expected: second.y = (2, 4, 6) for offset 1 in both. It has no call for structural parameters: they stay at 2."""
    del work
    EcosLib.set_log_level("off")
    with EcosSimulationStructure() as structure:
        for name in ("first", "second"):
            structure.add_model(name, str(fmu("vector_gain_fmi3")))
        structure.make_real_connection("first::y", "second::u")
        structure.add_parameter_set("start", {"first::offset": 1.0, "second::offset": 1.0})
        with EcosSimulation(structure=structure, step_size=0.1) as simulation:
            simulation.init(parameter_set="start")
            simulation.step(5)
            return f"y of the second array reads as {simulation.get_real('second::y')!r}; expected (2, 4)"


if __name__ == "__main__":
    report(probe)
