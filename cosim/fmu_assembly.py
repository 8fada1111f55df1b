"""An FMU component of a scenario to a unit: which file, which interface, which values."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fmpy.model_description import ModelDescription

from cosim.components import FmuComponent, ParameterValue
from cosim.errors import InputError
from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.unit import FmuSettings
from cosim.parameters import Resolved
from cosim.quantity import PhysicalValue
from cosim.unit import Unit


def fmu_folder() -> Path:
    """Folder of the FMUs that `make fmus` builds; `COSIM_FMU_PATH` overrides it."""
    given = os.environ.get("COSIM_FMU_PATH")
    return Path(given) if given else Path(__file__).resolve().parent.parent / "build" / "fmus"


def build_fmu(name: str, component: FmuComponent, parameters: Resolved, source: Path) -> Unit:
    """The unit of an FMU component.

    Raises:
        InputError: There is no such FMU, it cannot be loaded, or a parameter or start value does not fit.
    """
    archive = open_fmu(find_fmu(component, source))
    try:
        values = {k: _in_fmu_unit(k, v, archive.description, source) for k, v in parameters.values.items()}
        settings = FmuSettings(component.structure, values)
        kind: Callable[..., Unit] = ModelExchangeUnit if component.integrator == "cvode" else CoSimulationUnit
        # fmpy changes the working folder while it loads a library, and stays there if that fails.
        with contextlib.chdir(Path.cwd()):
            return kind(name, archive, settings)
    except BaseException:
        archive.remove()
        raise


def find_fmu(component: FmuComponent, source: Path) -> Path:
    """File of an FMU: a path beside the scenario, or one of the shipped FMUs of the size that the scenario needs."""
    if component.fmu.endswith(".fmu"):
        beside = source.parent / component.fmu
        return beside if beside.is_file() else Path(component.fmu)
    coils = component.structure.get("coils", 36)
    suffix = f"_n{coils}" if component.fmi == 2 and coils != 36 else ""
    path = fmu_folder() / f"{component.fmu}_fmi{component.fmi}{suffix}.fmu"
    if not path.is_file():
        there = ", ".join(sorted(p.stem for p in fmu_folder().glob("*.fmu"))) or "none built"
        how = f"make -C fmus COILS={coils}" if suffix else "make fmus"
        raise InputError(source, "fmu", f"there is no FMU `{path.stem}` (there: {there})",
                         f"build it with `{how}`, or give the path of a .fmu file")  # fmt: skip
    return path


def _in_fmu_unit(key: str, value: ParameterValue, description: ModelDescription, source: Path) -> Any:
    found = next((v for v in description.modelVariables if v.name in (key, f"{key}[1]")), None)
    declared = found.declaredType.unit if found is not None and found.declaredType is not None else None
    unit = (found.unit or declared or "1") if found is not None else None
    try:
        return _converted(value, unit)
    except ValueError as error:
        raise InputError(source, f"parameters.{key}", str(error), f"give it in {unit}") from error


def _converted(value: ParameterValue, unit: str | None) -> Any:
    if isinstance(value, list):
        return [_converted(element, unit) for element in value]
    if isinstance(value, PhysicalValue):
        return value.number if unit is None else value.to(unit)
    return value
