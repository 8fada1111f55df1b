"""An FMU as a unit: what Co-Simulation and Model Exchange have in common."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from cosim.errors import InputError
from cosim.fmu.archive import FmuArchive
from cosim.fmu.binding import Interface, bind
from cosim.fmu.variables import FmuVariable, fmu_variables
from cosim.unit import Array, Causality, Coordinate, StepOutcome, Unit, UnitError, Variable, seconds


@dataclass(frozen=True)
class FmuSettings:
    """How an FMU is set up before it is initialised.

    Args:
        structure: Structural parameters (FMI 3.0), for example `{"coils": 36}`.
        parameters: Values in the FMU's own units; scalars fill arrays.
    """

    structure: Mapping[str, int] = field(default_factory=dict)
    parameters: Mapping[str, Any] = field(default_factory=dict)


class FmuUnit(Unit):
    """Base of both interfaces: variables as numpy buffers that the FMU reads and writes in place.

    Args:
        name: Name of the component in the scenario.
        archive: The opened FMU; removed from disk by `terminate`.
        settings: Structure and parameters.
        interface: Which of the FMU's interfaces is used.

    Raises:
        InputError: A structural or other parameter does not exist or does not fit.
    """

    def __init__(self, name: str, archive: FmuArchive, settings: FmuSettings, interface: Interface) -> None:
        self.name = name
        self.archive = archive
        self.coordinates: Mapping[str, Coordinate] = {}
        try:
            self._fmu = fmu_variables(archive.description, settings.structure)
        except ValueError as error:
            raise InputError(archive.path, f"{name}.structure", str(error)) from error
        self.variables: Mapping[str, Variable] = {
            n: v.variable for n, v in self._fmu.items() if v.is_real and v.variable.causality is not Causality.PARAMETER
        }
        self.binding = bind(archive, interface, name)
        self._configure(settings.structure)
        self.set_parameters(settings.parameters)
        self._buffers = {n: np.full(v.shape, 0.0 if v.start is None else v.start) for n, v in self.variables.items()}
        self._writers = {
            n: self.binding.writer(self._fmu[n], b)
            for n, b in self._buffers.items()
            if self.variables[n].causality is Causality.INPUT
        }
        readers = {n: b for n, b in self._buffers.items() if self.variables[n].causality is Causality.OUTPUT}
        self._readers = [self.binding.reader(self._fmu[n], b) for n, b in readers.items()]
        self._outputs = list(readers.items())

    def _configure(self, structure: Mapping[str, int]) -> None:
        for key, value in structure.items():
            if key not in self._fmu:  # FMI 2.0: the size was compared with the FMU's own when its variables were read
                continue
            start = int(self._structural_start(key))
            if value != start:
                self.binding.configure(self._fmu[key], value)

    def _structural_start(self, key: str) -> str:
        return next(v.start or "0" for v in self.archive.description.modelVariables if v.name == key)

    def set_parameters(self, parameters: Mapping[str, Any]) -> None:
        """Set parameters before initialisation; a scalar fills an array.

        Raises:
            InputError: No such parameter, or its shape differs.
        """
        for key, value in parameters.items():
            variable = self._fmu.get(key)
            if variable is None or variable.variable.causality is not Causality.PARAMETER or variable.is_structural:
                known = [n for n, v in self._fmu.items() if v.variable.causality is Causality.PARAMETER]
                raise InputError(
                    self.archive.path, f"{self.name}.parameters.{key}", "the FMU has no such parameter",
                    f"it has: {', '.join(known)}",
                )  # fmt: skip
            self.binding.set_parameter(variable, self._fill(variable, key, value))

    def _fill(self, variable: FmuVariable, key: str, value: Any) -> Any:
        if variable.kind == "String":
            return value
        try:
            return np.broadcast_to(np.asarray(value), variable.variable.shape).copy()
        except ValueError as error:
            raise InputError(
                self.archive.path, f"{self.name}.parameters.{key}", f"{np.shape(value)} values do not fit", str(error)
            ) from error

    def set(self, name: str, value: Array) -> None:
        """Copy a finite value to an input of the FMU."""
        buffer = self._buffers[name]
        buffer[...] = value
        if not np.isfinite(buffer).all():
            where = [int(i) for i in np.argwhere(~np.isfinite(buffer))[0]] if buffer.ndim else ""
            raise UnitError(self.name, f"input {name}{where} is not a finite number")
        self._writers[name]()

    def get(self, name: str) -> Array:
        """Live buffer of an input or output."""
        return self._buffers[name]

    def _read_outputs(self, time: int) -> None:
        for read in self._readers:
            read()
        for name, buffer in self._outputs:
            if not np.isfinite(buffer).all():
                where = [int(i) for i in np.argwhere(~np.isfinite(buffer))[0]] if buffer.ndim else ""
                raise UnitError(self.name, f"output {name}{where} is not a finite number", time)

    def initialise(self, time: int) -> None:
        """Pass through Initialization Mode with the inputs set so far."""
        self.binding.enter_initialisation(seconds(time))
        for write in self._writers.values():
            write()
        self.binding.exit_initialisation()
        self._read_outputs(time)

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Advance; the interface's own way."""
        raise NotImplementedError

    def checkpoint(self) -> dict[str, np.ndarray[Any, Any]]:
        """The FMU's serialised state and the inputs."""
        if not self.binding.capabilities.canSerializeFMUstate:
            raise UnitError(self.name, "the FMU cannot serialise its state, so the run cannot be resumed from here")
        inputs = {f"input.{n}": self._buffers[n].copy() for n in self._writers}
        return {"state": self.binding.serialise(), **inputs}

    def resume(self, state: Mapping[str, np.ndarray[Any, Any]], time: int) -> None:
        """Initialise, then restore the serialised state."""
        for name in self._writers:
            self._buffers[name][...] = state[f"input.{name}"]
        self.initialise(time)
        self.binding.deserialise(state["state"])
        self._read_outputs(time)

    def terminate(self) -> None:
        """Free the instance and the extracted files; safe to call twice."""
        self.binding.free()
        self.archive.remove()
