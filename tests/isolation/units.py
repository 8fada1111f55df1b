"""Units in Python that another process can build, to test what passes between the two."""

from __future__ import annotations

import os
import sys

import numpy as np

from cosim.unit.errors import InputError
from cosim.unit.protocol import Causality, Coordinate, StepOutcome, StepStatus, Unit, UnitError, Variable, VariableType

SHAPE = (2, 3)


class Echo(Unit):
    """One input and one output of every type; after a step they are equal."""

    can_restore = True

    def __init__(self, name: str) -> None:
        self.name = name
        self.variables = {}
        for vtype in VariableType:
            for shape, prefix in ((), ""), (SHAPE, "many_"):
                for causality in (Causality.INPUT, Causality.OUTPUT):
                    key = f"{prefix}{vtype.value}_{causality.value}"
                    dims = tuple(f"d{i}" for i in range(len(shape)))
                    self.variables[key] = Variable(key, causality, shape, "1", dims, type=vtype)
        self.coordinates = {"label": Coordinate("d0", np.array(["a", "b"]))}
        self.feedthrough = {"Float64_output": frozenset({"Float64_input"})}
        self.values = {n: empty(v) for n, v in self.variables.items()}
        self.calls: list[str] = []

    def set(self, name, value):
        """Keep it; 13 is refused."""
        if name == "Int8_input" and value == 13:
            raise UnitError(self.name, "13 is refused")
        self.values[name][...] = value

    def get(self, name):
        """The value."""
        return self.values[name]

    def echo(self, names):
        """Inputs to outputs."""
        for name in names:
            self.values[name.replace("_input", "_output")][...] = self.values[name]

    def initialise(self, time):
        """Nothing to do."""
        self.calls.append(f"initialise {time}")

    def exit_initialisation(self):
        """Nothing to do."""
        self.calls.append("exit_initialisation")

    def refresh(self):
        """The one with feedthrough."""
        self.echo(["Float64_input"])

    def do_step(self, time, size):
        """Step, or fail as `size` says."""
        self.echo([n for n in self.values if n.endswith("_input")])
        if size == 1:
            return StepOutcome(StepStatus.DISCARDED, time, "too short")
        if size == 2:
            return StepOutcome(StepStatus.EARLY_RETURN, time + 1, "event")
        if size == 3:
            raise InputError("file.fmu", "key", "a wrong value", "correct it")
        if size == 4:
            raise UnitError("another", "its own reason", 7, "a way out")
        if size == 5:
            raise ZeroDivisionError("a defect")
        return StepOutcome(StepStatus.OK, time + size)

    def checkpoint(self):
        """All numbers."""
        return {n: v.copy() for n, v in self.values.items() if v.dtype != object}

    def resume(self, state, time):
        """All numbers."""
        for name, value in state.items():
            self.values[name][...] = value

    def terminate(self):
        """Nothing to free."""


class Modules(Unit):
    """Its checkpoint names the modules that its process has loaded, and whether it ignores Ctrl-C."""

    coordinates = {}
    variables = {}

    def __init__(self, name: str) -> None:
        self.name = name

    def checkpoint(self):
        """Names."""
        return {"modules": np.array(sorted(sys.modules)), "group": np.array([os.getpgid(0), os.getpid()])}

    def terminate(self):
        """Nothing to free."""


class Babbler(Modules):
    """Its step writes rubbish to every pipe that it finds."""

    def do_step(self, time, size):
        """Write."""
        for entry in os.listdir("/proc/self/fd"):
            try:
                os.write(int(entry), b"\xff" * 4096)
            except OSError:  # not open for writing
                continue
        return StepOutcome(StepStatus.OK, time + size)


def empty(variable):
    """Array of zeros, empty texts or empty bytes."""
    blank = {VariableType.STRING: "", VariableType.BINARY: b""}.get(variable.type, 0)
    values = np.empty(variable.shape, variable.type.dtype)
    values.fill(blank)
    return values


def refusing(error: str) -> Unit:
    """A unit whose construction fails."""
    if error == "input":
        raise InputError("file.fmu", "modelDescription.xml", "it is damaged", "export it again")
    if error == "unit":
        raise UnitError("faulty", "there is no licence", remedy="buy one")
    raise RuntimeError("a defect in the construction")
