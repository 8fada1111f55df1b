"""One run of a system of FMUs in compiled code, with results as `cosim.run` gives them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing

import numpy as np
import xarray as xr

from cosim.components import FmuComponent, ProgrammeComponent
from cosim.programme import Course
from cosim.run import run
from cosim.scenario import Scenario
from cosim.unit.protocol import Array, Causality
from cosim.unit.quantity import PhysicalValue
from diagnosis.models.coil_network.kernel.compiler import CompilerError
from diagnosis.models.systems.fast import FastSystem, in_base
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.numbers import scalar_parameters
from diagnosis.models.systems.placed import Placed
from diagnosis.models.systems.steps import resolve
from diagnosis.search.cosim_run import Changes


def is_system(scenario: Scenario) -> bool:
    """Whether a scenario is FMUs and programmes alone."""
    kinds = [type(c) for c in scenario.components.values()]
    return FmuComponent in kinds and all(k in (FmuComponent, ProgrammeComponent) for k in kinds)


def run_quickly(scenario: Scenario) -> xr.Dataset:
    """Results of a run, by compiled code where it can.

    Raises:
        InputError: The scenario is wrong.
        RunStopped: A unit cannot go on.
    """
    if is_system(scenario):
        try:
            results = _run(scenario)
        except (NotFast, CompilerError):
            results = None
        if results is not None:
            return results
    return run(scenario)  # it says what went wrong, and when


def _run(scenario: Scenario) -> xr.Dataset | None:
    system, values = resolved(scenario)
    with closing(system):
        return None if values is None else dataset(system, values)


class SystemRuns:
    """Runs of a system of FMUs in compiled code, with another number of an FMU or other courses of programmes.

    Args:
        scenario: The system.

    Raises:
        InputError: The scenario is wrong.
        NotFast: It has something that only the co-simulation can do.
        CompilerError: There is no C compiler.
    """

    def __init__(self, scenario: Scenario) -> None:
        self._system, _ = resolved(scenario)

    def close(self) -> None:
        """Free the FMUs."""
        self._system.close()

    def numbers(self) -> Iterator[tuple[str, str, str, float]]:
        """Component, name, unit and value of every scalar parameter of an FMU."""
        for component in self._system.fmus:
            for name, unit, value in numbers_of(self._system, component):
                yield component, name, unit, value

    def with_number(self, component: str, name: str, value: float) -> xr.Dataset | None:
        """Results with another value of a parameter, in its own unit; None where a unit fails or runs away."""
        rows = self._rows_with(component, name, value)
        return None if rows is None else dataset(self._system, rows)

    def begin_with(self, component: str, name: str, value: float) -> tuple[xr.Dataset, Array] | None:
        """The same, with the states of its FMU at the begin [SI]; None for a Co-Simulation FMU, which hides them."""
        fmu = self._system.fmus[component]
        rows = self._rows_with(component, name, value) if fmu.is_model_exchange else None
        if rows is None:
            return None
        states = [
            in_base(float(rows[0, self._system.recorded[component, f"state {s}"].start]), fmu.units.get(s, "1"))
            for s in fmu.states
        ]
        return dataset(self._system, rows), np.array(states)

    def _rows_with(self, component: str, name: str, value: float) -> Array | None:
        unit = self._system.fmus[component].unit.table.all[name].variable.unit
        rows = self._system.simulate(Changes({component: {name: PhysicalValue(value, unit)}}))
        return None if rows is None else rows.values

    def with_courses(self, courses: Mapping[tuple[str, str], Course]) -> xr.Dataset | None:
        """Results with other courses of outputs of programmes, in their own units; None as in `with_number`.

        Args:
            courses: Component and output to what it gives.
        """
        stated = self._system.give(courses)
        try:
            rows = self._system.simulate()
            return None if rows is None else dataset(self._system, rows.values)
        finally:
            self._system.give(stated)


def resolved(scenario: Scenario, laws: Sequence[Placed] = ()) -> tuple[FastSystem, Array | None]:
    """A system with as many steps of the integration as it needs, and its recorded values; see `resolve`.

    Raises:
        InputError, NotFast, CompilerError: As of `SystemRuns`.
    """
    system = FastSystem(scenario, laws)
    try:
        _check_outputs(system)
        return system, resolve(system)
    except BaseException:
        system.close()
        raise


def numbers_of(system: FastSystem, component: str) -> Iterator[tuple[str, str, float]]:
    """Name, unit and value of every scalar parameter of one FMU."""
    fmu = system.fmus[component]
    for name, value in scalar_parameters(fmu, system, component):
        yield name, fmu.unit.table.all[name].variable.unit, value


def _check_outputs(system: FastSystem) -> None:
    """Raises `NotFast` where an FMU has outputs that compiled code does not record."""
    for name, unit in system.assembly.system.units.items():
        fmu = system.fmus.get(name)
        shown = [v for v in unit.variables.values() if v.causality in (Causality.OUTPUT, Causality.LOCAL)]
        if fmu is not None and any(v.name not in fmu.outputs for v in shown):
            raise NotFast(f"{name} has outputs that are no numbers of double precision")


def dataset(system: FastSystem, values: Array) -> xr.Dataset:
    """Recorded values, shape (outputs, recorded), as results of a run."""
    data = {}
    for (name, variable), columns in system.recorded.items():
        units = system.assembly.system.units[name].variables
        if variable not in units or units[variable].causality is Causality.INPUT:
            continue
        own = units[variable]
        shaped = values[:, columns].reshape(len(values), *own.shape).copy()
        data[f"{name}.{variable}"] = (("time", *own.dims), shaped, {"units": own.unit})
    return xr.Dataset(data, {"time": system.times})
