"""A co-simulation loop written by hand on FMPy: the yardstick that every tool is compared with."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from typing import Any

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave

from benchmarks.models.systems import System

#: Passes over the connections after the initialisation, so that chains of direct feedthrough settle.
SETTLING = 3
Row = tuple[float, ...]


class Loop:
    """Instances of a system's FMUs in this process.

    Args:
        system: What to simulate.
        version: FMI version, 2 or 3.
    """

    def __init__(self, system: System, version: int) -> None:
        self.system, self.version = system, version
        self.folders: list[str] = []
        self.references: dict[tuple[str, str], int] = {}
        self.fmus = {name: self._open(name) for name in system.components}
        self.wires = [
            (
                self.fmus[c.source],
                [self.references[c.source, c.output]],
                self.fmus[c.target],
                [self.references[c.target, c.input]],
            )
            for c in system.connections
        ]

    def _open(self, name: str) -> Any:
        path = self.system.fmu(name, self.version)
        description = read_model_description(path)
        self.folders.append(extract(path))
        self.references.update({(name, v.name): v.valueReference for v in description.modelVariables})
        slave = FMU2Slave if self.version == 2 else FMU3Slave
        fmu = slave(
            guid=description.guid,
            unzipDirectory=self.folders[-1],
            instanceName=name,
            modelIdentifier=description.coSimulation.modelIdentifier,
        )
        fmu.instantiate()
        return fmu

    def get(self, name: str, variable: str) -> float:
        """Value of a variable."""
        return float(self._getter(self.fmus[name])([self.references[name, variable]])[0])

    def _getter(self, fmu: Any) -> Callable[[list[int]], list[float]]:
        getter: Callable[[list[int]], list[float]] = fmu.getReal if self.version == 2 else fmu.getFloat64
        return getter

    def _setter(self, fmu: Any) -> Callable[[list[int], list[float]], None]:
        setter: Callable[[list[int], list[float]], None] = fmu.setReal if self.version == 2 else fmu.setFloat64
        return setter

    def initialise(self) -> None:
        """Start values, initialization mode, consistent inputs."""
        for fmu in self.fmus.values():
            if self.version == 2:
                fmu.setupExperiment(startTime=0.0)
                fmu.enterInitializationMode()
            else:
                fmu.enterInitializationMode(startTime=0.0)
        for (name, variable), value in self.system.start.items():
            self._setter(self.fmus[name])([self.references[name, variable]], [value])
        for _ in range(SETTLING):
            self.exchange()
        for fmu in self.fmus.values():
            fmu.exitInitializationMode()

    def exchange(self) -> None:
        """All outputs are read before any input is set."""
        values = [self._getter(source)(output) for source, output, _, _ in self.wires]
        for (_, _, target, variable), value in zip(self.wires, values):
            self._setter(target)(variable, value)

    def step_jacobi(self, time: float, size: float) -> None:
        """Every unit steps with the outputs of the step before."""
        for fmu in self.fmus.values():
            fmu.doStep(time, size)
        self.exchange()

    def step_gauss_seidel(self, time: float, size: float) -> None:
        """Unit by unit, each with the newest outputs."""
        for fmu in self.fmus.values():
            for source, output, target, variable in self.wires:
                if target is fmu:
                    self._setter(target)(variable, self._getter(source)(output))
            fmu.doStep(time, size)

    def free(self) -> None:
        """Terminate and remove what was extracted."""
        for fmu in self.fmus.values():
            fmu.terminate()
            fmu.freeInstance()
        for folder in self.folders:
            shutil.rmtree(folder, ignore_errors=True)


def simulate(system: System, version: int, step: float, kind: str = "jacobi") -> Row:
    """Outputs of `system` at its stop time.

    Args:
        system: What to simulate.
        version: FMI version, 2 or 3.
        step: Communication step [s]; divides the stop time.
        kind: `jacobi` or `gauss_seidel`.
    """
    loop = Loop(system, version)
    loop.initialise()
    make_step = loop.step_jacobi if kind == "jacobi" else loop.step_gauss_seidel
    for index in range(round(system.stop / step)):
        make_step(index * step, step)
    values = tuple(loop.get(*output) for output in system.outputs)
    loop.free()
    return values
