"""ecos through ecospy: its fixed-step algorithm and its CSV writer."""

from __future__ import annotations

from time import perf_counter

from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure

from benchmarks.peers.job import Answer, Job, answer, written


def run(job: Job) -> Answer:
    """Stepped with `step_until`, as in its examples."""
    system = job.wired
    EcosLib.set_log_level("warn")
    with EcosSimulationStructure() as structure:
        for name in system.components:
            structure.add_model(name, str(system.fmu(name, job.version)))
        for wire in system.connections:
            structure.make_real_connection(f"{wire.source}::{wire.output}", f"{wire.target}::{wire.input}")
        start = {f"{name}::{variable}": value for (name, variable), value in system.start.items()}
        if start:
            structure.add_parameter_set("start", start)
        with EcosSimulation(structure=structure, step_size=job.step) as simulation:
            if job.csv:
                identifiers = [f"{name}::{variable}" for name, variable in system.outputs]
                simulation.add_csv_writer(str(job.folder / "out.csv"), identifiers=identifiers)
            simulation.init(parameter_set="start" if start else None)
            begin = perf_counter()
            simulation.step_until(job.stop)
            seconds = perf_counter() - begin
            end = simulation.get_time()
            values = [simulation.get_real(f"{name}::{variable}") for name, variable in system.outputs]
            simulation.terminate()
    return Answer(seconds, end, values, written(job.folder) if job.csv else 0)


if __name__ == "__main__":
    answer(run)
