"""One run of a system of FMUs in compiled code, with results as `cosim.run` gives them."""

from __future__ import annotations

import xarray as xr

from cosim.components import FmuComponent, ProgrammeComponent
from cosim.run import run
from cosim.scenario import Scenario
from cosim.unit.protocol import Causality
from diagnosis.models.coil_network.kernel.compiler import CompilerError
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.steps import resolve


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
    system = FastSystem(scenario)
    try:
        for name, unit in system.assembly.system.units.items():
            fmu = system.fmus.get(name)
            shown = [v for v in unit.variables.values() if v.causality in (Causality.OUTPUT, Causality.LOCAL)]
            if fmu is not None and any(v.name not in fmu.outputs for v in shown):
                raise NotFast(f"{name} has outputs that are no numbers of double precision")
        values = resolve(system)
        if values is None:
            return None
        data = {}
        for (name, variable), columns in system.recorded.items():
            units = system.assembly.system.units[name].variables
            if variable not in units or units[variable].causality is Causality.INPUT:
                continue
            own = units[variable]
            dims = own.dims
            shaped = values[:, columns].reshape(len(values), *own.shape).copy()
            data[f"{name}.{variable}"] = (("time", *dims), shaped, {"units": own.unit})
        return xr.Dataset(data, {"time": system.times})
    finally:
        system.close()
