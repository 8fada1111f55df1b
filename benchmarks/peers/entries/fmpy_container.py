"""FMPy's container FMU: the system becomes one FMU, whose parts are stepped by native code.

The container itself is FMI 3.0, its parts are FMI 2.0 or FMI 3.0."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter

from fmpy import extract, read_model_description
from fmpy.container_fmu.cli import create_container_fmu
from fmpy.container_fmu.config import Component, Configuration, Connection
from fmpy.fmi3 import FMU3Slave
from fmpy.model_description import CoSimulation, ModelDescription, ModelVariable

from benchmarks.peers.job import Answer, Job, answer

TOKEN = "container"


def build(job: Job) -> Path:
    """Configure the container; the outputs and start values of the system are its variables."""
    system = job.wired
    kind = "Float64"
    parts, variables = {}, {}
    for name in system.components:
        description = read_model_description(system.fmu(name, job.version))
        parts[name] = Component(name, system.fmu(name, job.version), description)
        for variable in description.modelVariables:
            variable.type = kind  # its writer names the connections of FMI 2.0 parts `Real`, which its reader refuses
            variables[name, variable.name] = variable
    time = ModelVariable(type=kind, variability="continuous", causality="independent", name="time")
    mappings = {
        ModelVariable(type=kind, initial="calculated", variability="continuous", causality="output", name=f"{n}_{v}"): [
            (parts[n], variables[n, v])
        ]
        for n, v in system.outputs
    }
    for (n, v), value in system.start.items():
        outer = ModelVariable(type=kind, variability="continuous", causality="input", name=f"{n}_{v}", start=str(value))
        mappings[outer] = [(parts[n], variables[n, v])]
    description = ModelDescription(
        fmiVersion="3.0",
        modelName="container",
        instantiationToken=TOKEN,
        coSimulation=CoSimulation(fixedInternalStepSize=job.step),
        modelVariables=[time, *mappings],
    )
    wires = [
        Connection(parts[c.source], [variables[c.source, c.output]], parts[c.target], [variables[c.target, c.input]])
        for c in system.connections
    ]
    path = job.folder / "container.fmu"
    unzipped = job.folder / "unzipped"
    unzipped.mkdir()
    create_container_fmu(Configuration(False, description, list(parts.values()), wires, mappings), unzipped, path)
    return path


def run(job: Job) -> Answer:
    """One call of doStep for the whole run: the container makes the macro-steps itself."""
    path = build(job)
    description = read_model_description(path)
    references = {v.name: v.valueReference for v in description.modelVariables}
    fmu = FMU3Slave(
        guid=TOKEN,
        unzipDirectory=extract(path, job.folder / "container"),
        instanceName="container",
        modelIdentifier=description.coSimulation.modelIdentifier,
    )
    fmu.instantiate()
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    begin = perf_counter()
    fmu.doStep(0.0, job.stop)
    seconds = perf_counter() - begin
    names = [references[f"{n}_{v}"] for n, v in job.wired.outputs]
    values = fmu.getFloat64(names)
    fmu.terminate()
    fmu.freeInstance()
    return Answer(seconds, job.stop, [float(v) for v in values])


if __name__ == "__main__":
    answer(run)
