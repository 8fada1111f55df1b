"""A C program with nothing but the FMI calls: the floor that no master can pass."""

from __future__ import annotations

from pathlib import Path
from subprocess import run as run_process

import fmpy

from benchmarks.peers.job import Answer, Job, answer

SOURCE = Path(__file__).resolve().parent.parent / "c_floor.c"


def run(job: Job) -> Answer:
    """FMI 2.0 alone."""
    system, folder = job.wired, job.folder
    number = {name: i for i, name in enumerate(system.components)}
    references: dict[tuple[str, str], int] = {}
    lines = []
    for name in system.components:
        path = system.fmu(name, 2)
        description = fmpy.read_model_description(path)
        references.update({(name, v.name): v.valueReference for v in description.modelVariables})
        # One folder per instance: two instances of one library would share it otherwise, as masters must not assume.
        unzipped = Path(fmpy.extract(path, folder / name))
        library = unzipped / "binaries" / fmpy.platform / f"{description.coSimulation.modelIdentifier}.so"
        lines.append(f"fmu {library} {description.guid}")
    lines += [f"start {number[n]} {references[n, v]} {value!r}" for (n, v), value in system.start.items()]
    lines += [
        f"wire {number[c.source]} {references[c.source, c.output]} {number[c.target]} {references[c.target, c.input]}"
        for c in system.connections
    ]
    lines += [f"out {number[n]} {references[n, v]}" for n, v in system.outputs]
    spec, program = folder / "spec", folder / "c_floor"
    spec.write_text("\n".join(lines) + "\n")
    headers = Path(fmpy.__file__).parent / "c-code"
    run_process(
        ["gcc", "-std=c99", "-O2", "-Wall", "-Wextra", "-isystem", headers, "-o", program, SOURCE, "-ldl"], check=True
    )
    done = run_process([program, spec, str(job.steps), repr(job.step)], check=True, capture_output=True, text=True)
    seconds, *values = (float(text) for text in done.stdout.split())
    return Answer(seconds, job.steps * job.step, values)


if __name__ == "__main__":
    answer(run)
