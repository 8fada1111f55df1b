"""Runs one FMI 2.0 FMU in another importer and writes what it saw. A process of its own: importers print and crash.

Usage: python importer_run.py IMPORTER FMU INPUT[,INPUT...] OUT.json

The elements are driven from the start on, each by another value, and the drive ends after half of the steps. Every
importer gets its inputs through its own interface before a step and gives the outputs that it has after it.
"""

from __future__ import annotations

import ctypes
import importlib.metadata
import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

ELEMENTS, STEPS, STEP = 6, 200, 0.05
OUTPUTS = ("stiffness", "rest_length", "temperature", "resistance", "stored_energy", "convected_energy")
NAMES = [f"{name}[{i}]" for name in OUTPUTS for i in range(1, ELEMENTS + 1)]

#: Value of an input of the first element; that of element i is i times as large.
INPUTS = {"power": 0.12, "voltage": 0.12, "tension": 1.0}

#: Sets inputs by name; steps once and returns the outputs.
Importer = tuple[Callable[[Mapping[str, float]], None], Callable[[int], list[float]]]


def fmpy(fmu: str) -> Importer:
    """FMPy, its plain calls."""
    from fmpy import extract, instantiate_fmu, read_model_description

    description = read_model_description(fmu)
    instance = instantiate_fmu(extract(fmu), description, "CoSimulation")
    instance.setupExperiment(startTime=0.0)
    instance.enterInitializationMode()
    instance.exitInitializationMode()
    reference = {v.name: v.valueReference for v in description.modelVariables}

    def step(index: int) -> list[float]:
        instance.doStep(index * STEP, STEP)
        return list(instance.getReal([reference[name] for name in NAMES]))

    return lambda values: instance.setReal([reference[n] for n in values], list(values.values())), step


def libcosimpy(fmu: str) -> Importer:
    """libcosim: fixed-step algorithm, manipulator for inputs, observer for outputs."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(STEP * 1e9)
    slave, manipulator = CosimLocalSlave(fmu, "actuator"), CosimManipulator.create_override()
    observer = CosimObserver.create_last_value()
    execution.add_local_slave(slave)
    execution.add_manipulator(manipulator)
    execution.add_observer(observer)
    reference = {v.name.decode(): v.reference for v in execution.slave_variables(0)}

    def step(_: int) -> list[float]:
        # The library frees what Python has dropped, so the slave must outlive the run: the closure keeps it.
        if not (slave and execution.step()):
            raise RuntimeError("libcosim could not step")
        return list(observer.last_real_values(0, [reference[name] for name in NAMES]))

    return lambda values: manipulator.slave_real_values(0, [reference[n] for n in values], list(values.values())), step


def ecospy(fmu: str) -> Importer:
    """ecos: fixed-step algorithm."""
    # Its library wants libtbb, which the package tbb puts where the loader does not look.
    files = importlib.metadata.files("tbb") or []
    library = next(Path(str(file.locate())).resolve() for file in files if file.name == "libtbb.so.12")
    ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    from ecospy import EcosSimulation, EcosSimulationStructure

    structure = EcosSimulationStructure()
    structure.add_model("actuator", fmu)
    simulation = EcosSimulation(structure=structure, step_size=STEP)
    simulation.init()

    def set_inputs(values: Mapping[str, float]) -> None:
        for name, value in values.items():
            simulation.set_real(f"actuator::{name}", value)

    def step(_: int) -> list[float]:
        simulation.step(1)
        return [simulation.get_real(f"actuator::{name}") for name in NAMES]

    return set_inputs, step


def main(importer: str, fmu: str, inputs: str, out: str) -> None:
    """Run and write a list of steps, each a list of the values of NAMES."""
    set_inputs, step = {"fmpy": fmpy, "libcosimpy": libcosimpy, "ecospy": ecospy}[importer](fmu)
    trace = []
    for index in range(STEPS):
        if index in (0, STEPS // 2):
            on = 1.0 if index == 0 else 0.0
            set_inputs({f"{n}[{i}]": INPUTS[n] * i * on for n in inputs.split(",") for i in range(1, ELEMENTS + 1)})
        trace.append(step(index))
    Path(out).write_text(json.dumps(trace))


if __name__ == "__main__":
    main(*sys.argv[1:])
