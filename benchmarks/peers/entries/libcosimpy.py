"""libcosim through libcosimpy: its fixed-step algorithm, results by its file observer."""

from __future__ import annotations

from time import perf_counter
from typing import Any

from fmpy import read_model_description
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

from benchmarks.peers.job import Answer, Job, answer, written


def run(job: Job) -> Answer:
    """Time is an integer number of nanoseconds here."""
    system = job.wired
    execution = CosimExecution.from_step_size(step_size=job.step * 1e9)
    index: dict[str, int] = {}
    references: dict[tuple[str, str], int] = {}
    for name in system.components:
        path = system.fmu(name, job.version)
        index[name] = execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name=name))
        for variable in read_model_description(path).modelVariables:
            references[name, variable.name] = variable.valueReference
    execution.real_time_simulation_enabled(enabled=False)
    for (name, variable), value in system.start.items():
        execution.real_initial_value(index[name], references[name, variable], value)
    for wire in system.connections:
        execution.connect_real_variables(
            index[wire.source],
            references[wire.source, wire.output],
            index[wire.target],
            references[wire.target, wire.input],
        )
    keep: list[Any] = [CosimManipulator.create_override()]
    if job.csv:
        keep.append(CosimObserver.create_to_dir(str(job.folder)))
        execution.add_observer(keep[-1])
    last = CosimObserver.create_last_value()
    execution.add_observer(last)
    begin = perf_counter()
    execution.simulate_until(target_time=round(job.stop * 1e9))
    seconds = perf_counter() - begin
    end = execution.status().current_time * 1e-9
    values = [last.last_real_values(index[n], [references[n, v]])[0] for n, v in system.outputs]
    return Answer(seconds, end, [float(v) for v in values], written(job.folder) if job.csv else 0)


if __name__ == "__main__":
    answer(run)
