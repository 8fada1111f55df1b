"""How an FMU is set up before it is initialised."""

from __future__ import annotations

import difflib
import keyword
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from cosim.fmu.access import Access
from cosim.fmu.archive import FmuArchive
from cosim.fmu.binding import Binding
from cosim.fmu.gathering import fmu_variables
from cosim.fmu.sizes import StructureFault, check_total
from cosim.fmu.units import UnitNames, is_known
from cosim.fmu.values import array_of
from cosim.fmu.variables import FmuVariable, Sizes, added_input, declared_array, start_value
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Causality, UnitError, are_equal
from cosim.unit.quantity import PhysicalValue
from cosim.unit.ranges import beyond, has_range, in_words, with_unit

#: Relative rounding of a parameter that an FMU keeps in single precision.
_ROUNDING = 1e-6


@dataclass(frozen=True)
class AddedState:
    """A state of a term's own.

    Args:
        rate: Formula of its derivative.
        start: Formula of its value at the start.
        unit: Its unit.
    """

    rate: str
    start: str
    unit: str = "1"


@dataclass(frozen=True)
class AddedDelay:
    """What an input was some time ago.

    Args:
        of: The input.
        by: Parameter of the term that is the time.
    """

    of: str
    by: str


@dataclass(frozen=True)
class AddedTerm:
    """A term that the master adds.

    Args:
        to: `der(state)`, the name of an input or output, or `parameter(name)`.
        formula: In the names of the FMU's variables, `time`, the parameters, its own states and delayed inputs.
        parameters: Numbers with units.
        states: Its own states.
        delays: Delayed inputs.
        inputs: Quantities of other components by name, with their units: inputs that the FMU does not have.
        is_share: Whether the formula is a share of the derivative as the FMU has it (a capacity that is larger, say),
            or of a parameter.
    """

    to: str
    formula: str
    parameters: Mapping[str, PhysicalValue] = field(default_factory=dict)
    states: Mapping[str, AddedState] = field(default_factory=dict)
    delays: Mapping[str, AddedDelay] = field(default_factory=dict)
    is_share: bool = False
    inputs: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class FmuSettings:
    """How an FMU is set up.

    Args:
        structure: Structural parameters (FMI 3.0), for example `{"coils": 36}`.
        parameters: Values of any type; bare numbers are in the FMU's own units, scalars fill arrays.
        start: Start values of inputs, and of variables whose start value may be set (initial exact or approx).
        record: Names of local variables that can be read beside the outputs.
        tolerance: Relative tolerance of the integrator; None: the FMU's own, or 1e-8 in Model Exchange.
        stop_time: End of the simulation [s], told to the FMU where it is known.
        report_early_return: Whether a step of a Co-Simulation FMU ends at its first event.
        added_terms: What the master adds to derivatives, inputs and outputs.
        wanted: Variables that terms of other components use; local ones can be read as those of `record`.
    """

    structure: Mapping[str, int] = field(default_factory=dict)
    parameters: Mapping[str, Any] = field(default_factory=dict)
    start: Mapping[str, Any] = field(default_factory=dict)
    record: Sequence[str] = ()
    tolerance: float | None = None
    stop_time: float | None = None
    report_early_return: bool = False
    added_terms: Sequence[AddedTerm] = ()
    wanted: Sequence[str] = ()


class Table:
    """The variables of one FMU and the values that a user gives to them.

    Args:
        name: Name of the component, for error texts.
        archive: The opened FMU.
        settings: What the user gives.

    Raises:
        InputError: The structure does not fit.
    """

    def __init__(self, name: str, archive: FmuArchive, settings: FmuSettings) -> None:
        self.name, self.archive, self.settings = name, archive, settings
        self.units = UnitNames(archive.description)
        try:
            self.all = fmu_variables(archive.description, settings.structure, self.units)
        except StructureFault as error:
            raise InputError(archive.path, f"{name}.structure", str(error), error.remedy) from error
        self.all = {**self.all, **self._added_inputs()}
        self._given: dict[str, tuple[FmuVariable, AnyArray]] = {}
        #: Calls that read a parameter back, made at the first initialisation.
        self._readers: dict[str, Access] = {}
        recorded = {self._recorded(n) for n in settings.record}
        recorded |= {n for w in settings.wanted for n in (w, w.partition("[")[0]) if n in self.all}
        self.exposed = {
            n: v
            for n, v in self.all.items()
            if v.variable.causality in (Causality.INPUT, Causality.OUTPUT) or n in recorded
        }
        try:
            check_total(self.exposed.values())
        except StructureFault as error:
            raise InputError(archive.path, name, str(error), error.remedy) from error

    def _added_inputs(self) -> dict[str, FmuVariable]:
        found: dict[str, FmuVariable] = {}
        for number, term in enumerate(self.settings.added_terms):
            for name, unit in term.inputs.items():
                where = self.archive.path, f"{self.name}.added_terms[{number}].inputs.{name}"
                if name in self.all:
                    raise InputError(*where, "a variable of the FMU has this name", "choose another one")
                if not name.isidentifier() or keyword.iskeyword(name):
                    raise InputError(*where, "no formula can use this name", "write letters, digits and `_`")
                if not is_known(unit):
                    raise InputError(*where, f"`{unit}` is not a unit that is known here", "write it as in `m/s^2`")
                found[name] = added_input(name, unit)
        return found

    def _recorded(self, name: str) -> str:
        if name not in self.all:
            raise self._unknown("record", name, self.all)
        return name

    def configure(self, binding: Binding) -> None:
        """Set the structural parameters that differ from their start values; also those that are no size."""
        given: list[tuple[FmuVariable, Any]] = []
        for key, value in {**self.settings.structure, **self.settings.parameters}.items():
            variable = self.all.get(key)
            if variable is not None and variable.is_structural:
                part = "structure" if key in self.settings.structure else "parameters"
                if part == "parameters" and variable.is_size:
                    raise InputError(
                        self.archive.path,
                        f"{self.name}.parameters.{key}",
                        "it is the size of an array",
                        "give it under `structure`",
                    )
                given.append((variable, self._array(part, key, variable, value)))
        binding.configure([(v, array) for v, array in given if not _is_start(v, array)])

    def set_parameters(self, binding: Binding, parameters: Mapping[str, Any]) -> None:
        """Set parameters before initialisation.

        Raises:
            InputError: No such parameter, or a value that does not fit.
        """

        def is_parameter(v: FmuVariable) -> bool:
            return v.variable.causality is Causality.PARAMETER and not v.is_structural and not v.is_constant

        for key, value in parameters.items():
            if key in self.all and self.all[key].is_structural:
                continue  # `configure` has set it
            variable = self._find("parameters", key, is_parameter)
            array = self._array("parameters", key, variable, value)
            binding.give(variable, array)
            self._given[key] = variable, array

    def value_of(self, name: str) -> AnyArray:
        """A parameter as it was given last, or its start value, in the FMU's own unit."""
        if name in self._given:
            return self._given[name][1]
        variable = self.all[name]
        if name in self.settings.parameters:
            return self._array("parameters", name, variable, self.settings.parameters[name])
        start = start_value(variable.declared, variable.variable.type, variable.variable.shape)
        return np.asarray(0.0 if start is None else start)

    def outside_range(self) -> list[str]:
        """A sentence for each parameter or start value that lies outside the range which the FMU declares for it."""
        found = []
        for part, given in (("parameters", self.settings.parameters), ("start", self.settings.start)):
            for key, value in given.items():
                variable = self.all[key].variable if key in self.all else None
                if variable is None or not has_range(variable):
                    continue
                values = self._array(part, key, self.all[key], value)
                outside = beyond(variable, values)
                if outside.any():
                    worst = float(values.flat[int(np.argmax(outside))])
                    found.append(
                        f"{self.name}.{part}.{key} = {with_unit(worst, variable)} is outside the range for which this "
                        f"FMU is made ({in_words(variable)})"
                    )
        return found

    def check_accepted(self, binding: Binding) -> None:
        """Read the numbers that were given to parameters back, in Initialization Mode.

        Raises:
            InputError: The FMU keeps another value. A parameter that cannot be read is taken to be accepted.
        """
        for key, (variable, array) in self._given.items():
            if not (variable.variable.type.is_float or array.dtype.kind in "iub"):
                continue
            known = self._readers.get(key)
            if known is None or known.values.shape != array.shape or known.values.dtype != array.dtype:
                known = self._readers[key] = binding.reader(variable, np.empty_like(array))
            try:
                known()
            except UnitError:
                continue
            kept = known.values
            if are_equal(kept, array):
                continue
            rounding = _ROUNDING if array.dtype.kind == "f" else 0.0
            wrong = np.flatnonzero(~np.isclose(kept, array, rtol=rounding, atol=0.0, equal_nan=True))
            if len(wrong):
                element = f"[{wrong[0] + 1}]" if array.ndim else ""
                raise InputError(
                    self.archive.path,
                    f"{self.name}.parameters.{key}{element}",
                    f"the FMU does not take {array.flat[wrong[0]]:g}: it keeps {kept.flat[wrong[0]]:g}",
                    "give a value that it takes; it may limit or round it, or set this parameter itself",
                )

    def start_values(self, binding: Binding) -> dict[str, AnyArray]:
        """Set start values before initialisation; those of inputs are returned, by name of the input.

        Raises:
            InputError: No such variable, its start value cannot be set, or a value that does not fit.
        """
        inputs: dict[str, AnyArray] = {}
        for key, value in self.settings.start.items():
            variable = self._find("start", key, lambda v: v.variable.causality is Causality.INPUT or v.has_start)
            array = self._array("start", key, variable, value)
            if key in self.exposed and variable.variable.causality is Causality.INPUT:
                inputs[key] = array
            else:
                binding.give(variable, array)
        return inputs

    def _array(self, part: str, key: str, variable: FmuVariable, value: Any) -> AnyArray:
        try:
            return array_of(variable, value, self.units)
        except ValueError as error:
            v = variable.variable
            what = " x ".join(map(str, v.shape)) + f" {v.type.value}" if v.shape else v.type.value
            unit = f" in {v.unit}" if v.type.is_float and v.unit != "1" else ""
            raise InputError(
                self.archive.path, f"{self.name}.{part}.{key}", str(error), f"give {what}{unit}"
            ) from error

    def _find(self, part: str, key: str, is_right: Callable[[FmuVariable], bool]) -> FmuVariable:
        """A variable, or one element of gathered scalars by its own name in the FMU."""
        found = self.all.get(key)
        if found is None:
            element = next((v for v in self.archive.description.modelVariables if v.name == key), None)
            found = None if element is None else declared_array(element, Sizes({}, {}), self.units)
        if found is None or not is_right(found):
            raise self._unknown(part, key, [n for n, v in self.all.items() if is_right(v)])
        return found

    def _unknown(self, part: str, key: str, names: Iterable[str]) -> InputError:
        there = list(names)
        what = "parameter" if part == "parameters" else "variable"
        declared = self.all.get(key)
        problem = f"the FMU has no such {what}"
        if declared is not None:
            v = declared.declared[0]
            problem = f"this is no {what} that can be set here: its causality is {v.causality}, its initial {v.initial}"
        close = difflib.get_close_matches(key, there, 3, 0.5)
        listed = ", ".join(there[:20]) + (", ..." if len(there) > 20 else "")
        remedy = f"did you mean {' or '.join(close)}? " if close else ""
        return InputError(
            self.archive.path, f"{self.name}.{part}.{key}", problem, f"{remedy}it has: {listed or 'none'}"
        )


def _is_start(variable: FmuVariable, array: AnyArray) -> bool:
    start = start_value(variable.declared, variable.variable.type, variable.variable.shape)
    return start is not None and bool((array == start).all())
