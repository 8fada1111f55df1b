"""The FMI side of an actuator in Python: the variables of the interface, sizes, checks, saved states.

Works with pythonfmu3, which puts a copy of itself and of this file into the FMU. numpy must be installed where it runs.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pythonfmu3 import Float64, Fmi3Causality, Fmi3Initial, Fmi3Slave, Fmi3Variability, UInt64
from pythonfmu3.enums import Fmi3Status
from pythonfmu3.fmi3slave import Fmi3StepResult
from pythonfmu3.unit import Unit
from pythonfmu3.variables import Dimension

INPUTS = {
    # name: unit, start value, smallest value, meaning
    "power": ("W", 0.0, None, "Electrical power turned into heat in each coil"),
    "voltage": ("V", 0.0, None, "Voltage across each coil"),
    "tension": ("N", 0.0, None, "Pull on each coil"),
    "extension": ("m", 0.0, None, "Elongation of each coil beyond its rest length"),
}
OUTPUTS = {
    "temperature": ("K", "Temperature of each coil"),
    "stiffness": ("N/m", "Spring constant of each coil"),
    "rest_length": ("m", "Length of each coil without load"),
    "resistance": ("ohm", "Electrical resistance of each coil"),
    "stored_energy": ("J", "Energy stored in each coil since the start"),
    "convected_energy": ("J", "Heat given to the surroundings since the start"),
}
#: These must stay above zero.
POSITIVE = ("stiffness", "rest_length", "temperature", "resistance")
BASE = {
    "W": {"kg": 1, "m": 2, "s": -3},
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "m": {"m": 1},
    "K": {"K": 1},
    "N/m": {"kg": 1, "s": -2},
    "ohm": {"kg": 1, "m": 2, "s": -3, "A": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "J/K": {"kg": 1, "m": 2, "s": -2, "K": -1},
    "W/K": {"kg": 1, "m": 2, "s": -3, "K": -1},
    "s": {"s": 1},
    "1": {},
    "1/K": {"K": -1},
    "1/s": {"s": -1},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "C": {"A": 1, "s": 1},
    "F": {"kg": -1, "m": -2, "s": 4, "A": 2},
}


@dataclass(frozen=True)
class Parameter:
    """A number that a scenario may set: name, start value, SI unit, meaning; one for all coils, or one per coil."""

    name: str
    start: float
    unit: str
    meaning: str
    is_per_coil: bool = False


class CoilActuator(Fmi3Slave):
    """Base: a subclass lists `inputs`, `states`, `parameters` and defines `start`, `advance` and `outputs`."""

    summary = ""
    inputs = ("power",)
    states = ()
    parameters = ()

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.description = self.summary
        self.register_units([Unit(name, **powers) for name, powers in BASE.items()])
        self.time, self.ambient_temperature = 0.0, 295.15
        self.mode, self.is_stale = "instantiated", True
        self._declare(self._size_at_build())

    def _size_at_build(self) -> int:
        file = Path(self.resources or ".") / "coils.txt"  # written by `cosim fmu build --coils N`
        return int(file.read_text()) if file.is_file() else 36

    def _declare(self, coils: int) -> None:
        self._resize(coils)
        continuous, outcome = Fmi3Variability.continuous, Fmi3Causality.output
        self.register_variable(Float64("time", causality=Fmi3Causality.independent, variability=continuous, unit="s"))
        self.register_variable(
            UInt64(
                "coils",
                causality=Fmi3Causality.structuralParameter,
                variability=Fmi3Variability.fixed,
                initial=Fmi3Initial.exact,
                description="Number of coils",
                setter=self._resize,
            )
        )
        for name in self.inputs:
            unit, _, _, text = INPUTS[name]
            self._register(name, unit, text, True, causality=Fmi3Causality.input, variability=continuous)
        self._register(
            "ambient_temperature",
            "K",
            "Temperature of the surroundings",
            False,
            causality=Fmi3Causality.input,
            variability=continuous,
        )
        for name, (unit, text) in OUTPUTS.items():
            self._register(
                name, unit, text, True, causality=outcome, variability=continuous, initial=Fmi3Initial.calculated
            )
        for p in self.parameters:
            self._register(
                p.name,
                p.unit,
                p.meaning,
                p.is_per_coil,
                causality=Fmi3Causality.parameter,
                variability=Fmi3Variability.fixed,
                initial=Fmi3Initial.exact,
            )

    def _register(self, name, unit, text, is_per_coil, **declared):
        dimensions = [Dimension(valueReference="1")] if is_per_coil else []
        self.register_variable(
            Float64(
                name,
                unit=unit,
                description=text,
                dimensions=dimensions,
                getter=(lambda: self._read(name).tolist()) if is_per_coil else (lambda: float(getattr(self, name))),
                setter=lambda value: self._write(name, unit, value, is_per_coil),
                **declared,
            )
        )

    def _read(self, name):
        if self.is_stale and name in OUTPUTS:
            self._update()
        return np.atleast_1d(getattr(self, name))

    def _write(self, name, unit, value, is_per_coil):
        array = np.array(value, dtype=float)
        bad = np.flatnonzero(~np.isfinite(array.reshape(-1)))
        if bad.size:
            raise ValueError(f"{name}[{bad[0] + 1}] = {array.reshape(-1)[bad[0]]} {unit}: it must be a finite number")
        if name == "ambient_temperature" and array <= 0.0:
            raise ValueError(f"{name} = {array} K: it must be positive")
        setattr(self, name, np.broadcast_to(array, (self.coils,)).copy() if is_per_coil else float(array))
        self.is_stale = True

    def _resize(self, coils) -> None:
        """Every value returns to its start value, as FMI 3.0 says for Configuration Mode."""
        self.coils = int(coils)
        if not 1 <= self.coils <= 100_000:
            raise ValueError(f"coils = {self.coils}: it must be between 1 and 100000")
        for name in self.inputs:
            setattr(self, name, np.full(self.coils, INPUTS[name][1]))
        for name in OUTPUTS:
            setattr(self, name, np.zeros(self.coils))
        for p in self.parameters:
            setattr(self, p.name, np.full(self.coils, p.start) if p.is_per_coil else p.start)

    def enter_initialization_mode(self):
        self.mode, self.is_stale = "initialisation", True

    def exit_initialization_mode(self):
        self._update()
        self.mode = "running"

    def _update(self) -> None:
        """Outputs follow states and inputs; until the run begins the states follow their parameters."""
        if self.mode == "instantiated":
            return
        if self.mode == "initialisation":
            self.start()
        self.is_stale = False
        self.outputs()
        for name in OUTPUTS:
            values = np.atleast_1d(getattr(self, name))
            wrong = ~np.isfinite(values) if name not in POSITIVE else ~(np.isfinite(values) & (values > 0.0))
            if wrong.any():
                i = int(np.flatnonzero(wrong)[0])
                raise ValueError(
                    f"{name}[{i + 1}] = {values[i]}: it must be finite" + (" and positive" if name in POSITIVE else "")
                )

    def do_step(self, current_time, step_size):
        """One step; what goes wrong in it is logged and returned as an error, which ends the run with its text."""
        try:
            if self.mode != "running":
                raise ValueError(f"a step must not be made in the mode {self.mode}")
            self.advance(step_size)
            self.time = current_time + step_size
            self._update()
        except (ValueError, ArithmeticError) as error:
            self.log(str(error), Fmi3Status.error)
            return Fmi3StepResult(status=Fmi3Status.error)
        return Fmi3StepResult()

    def _get_fmu_state(self):
        names = (
            "time",
            "coils",
            "mode",
            "is_stale",
            "ambient_temperature",
            *self.inputs,
            *OUTPUTS,
            *self.states,
            *(p.name for p in self.parameters),
        )
        values = {name: getattr(self, name) for name in names}
        return {name: v.tolist() if isinstance(v, np.ndarray) else v for name, v in values.items()}

    def _set_fmu_state(self, state):
        for name, value in state.items():
            setattr(self, name, np.array(value) if isinstance(value, list) else value)
