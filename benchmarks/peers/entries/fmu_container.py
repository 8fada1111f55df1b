"""fmucontainer of the FMU Manipulation Toolbox: the system becomes one FMU, which steps its parts in C."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from time import perf_counter

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave

from benchmarks.peers.job import Answer, Job, answer


def build(job: Job) -> Path:
    """Write the description and call the tool."""
    system, folder = job.wired, job.folder
    for name in system.components:
        shutil.copy(system.fmu(name, job.version), folder / f"{name}.fmu")
    description = {
        "name": "container.fmu",
        "step_size": job.step,
        "auto_link": False,
        "auto_input": False,
        "auto_output": False,
        "fmu": [f"{name}.fmu" for name in system.components],
        "link": [[f"{c.source}.fmu", c.output, f"{c.target}.fmu", c.input] for c in system.connections],
        "output": [[f"{n}.fmu", v, f"{n}_{v}"] for n, v in system.outputs],
        "start": [[f"{n}.fmu", v, value] for (n, v), value in system.start.items()],
    }
    (folder / "container.json").write_text(json.dumps(description))
    tool = Path(sys.executable).parent / "fmucontainer"
    subprocess.run(
        [tool, "-container", "container.json", "-fmu-directory", folder, "-fmi", str(job.version)],
        cwd=folder,
        check=True,
        stdout=sys.stderr,
    )
    return folder / "container.fmu"


def run(job: Job) -> Answer:
    """One call of doStep for the whole run: the container makes the macro-steps itself."""
    path = build(job)
    description = read_model_description(path)
    references = {v.name: v.valueReference for v in description.modelVariables}
    fmu = (FMU2Slave if job.version == 2 else FMU3Slave)(
        guid=description.guid,
        unzipDirectory=extract(path, job.folder / "container"),
        instanceName="container",
        modelIdentifier=description.coSimulation.modelIdentifier,
    )
    fmu.instantiate()
    if job.version == 2:
        fmu.setupExperiment(startTime=0.0)
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    begin = perf_counter()
    fmu.doStep(0.0, job.stop)
    seconds = perf_counter() - begin
    names = [references[f"{n}_{v}"] for n, v in job.wired.outputs]
    values = fmu.getReal(names) if job.version == 2 else fmu.getFloat64(names)
    fmu.terminate()
    fmu.freeInstance()
    return Answer(seconds, job.stop, [float(v) for v in values])


if __name__ == "__main__":
    answer(run)
