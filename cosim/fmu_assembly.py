"""An FMU component of a scenario to a unit: which file, which interface, which values."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Collection
from functools import partial
from pathlib import Path

from cosim.components import FmuComponent, Isolation
from cosim.fmu.added_terms import given_terms
from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.unit import FmuSettings
from cosim.fmu_build.at_first_use import DEFAULT_COILS, file_name, shipped_fmu
from cosim.isolation.limits import Limits
from cosim.isolation.unit import IsolatedUnit
from cosim.nearest import did_you_mean
from cosim.parameters import Resolved
from cosim.shipped import fmu_folder, shipped_fmus
from cosim.unit.errors import InputError
from cosim.unit.protocol import Unit


def build_fmu(
    name: str,
    component: FmuComponent,
    parameters: Resolved,
    source: Path,
    reports_events: bool = False,
    stop: float | None = None,
    wanted: Collection[str] = (),
) -> Unit:
    """The unit of an FMU component.

    Args:
        name: Name of the component.
        component: What the scenario says of it.
        parameters: Its parameters; for an FMU of any author their units are those of its own description.
        source: File of the scenario.
        reports_events: Whether its steps end at their first event (`on_event: synchronise`).
        stop: End of the simulation [s], passed to the FMU; None: it is not known.
        wanted: Variables of it that terms of other components use.

    Raises:
        InputError: There is no such FMU, it cannot be loaded, or a parameter or start value does not fit.
    """
    isolation = Isolation() if component.isolation == "process" else component.isolation
    # A process of its own has files of its own: it may be killed at any moment.
    archive = open_fmu(find_fmu(component, source), is_shared=isinstance(isolation, str))
    try:
        tolerance = component.tolerance.to("1") if component.tolerance is not None else None
        settings = FmuSettings(
            component.structure,
            parameters.values,
            component.start,
            tuple(component.record),
            tolerance,
            stop,
            report_early_return=reports_events,
            added_terms=given_terms(component.added_terms),
            wanted=tuple(wanted),
        )
        kind: Callable[..., Unit] = ModelExchangeUnit if component.integrator == "cvode" else CoSimulationUnit
        build = partial(kind, name, archive, settings)
        if not isinstance(isolation, str):
            limits = Limits(isolation.step_limit.to("s"), round(isolation.memory_limit.to("byte")))
            return IsolatedUnit(name, build, limits, archive)
        # fmpy changes the working folder while it loads a library, and stays there if that fails.
        with contextlib.chdir(Path.cwd()):
            return build()
    except BaseException:
        archive.remove()
        raise


def find_fmu(component: FmuComponent, source: Path) -> Path:
    """File of an FMU: a path beside the scenario, or one of the shipped FMUs of the size that the scenario needs."""
    if component.fmu.endswith(".fmu"):
        beside = source.parent / component.fmu
        return beside if os.path.isfile(beside) else Path(component.fmu)  # of a name too long it is False
    coils = component.structure.get("coils", DEFAULT_COILS)
    path = shipped_fmu(component.fmu, component.fmi, coils)
    if path is not None:
        return path
    known = shipped_fmus()
    if component.fmu not in known:
        hint = did_you_mean(component.fmu, known)
        raise InputError(
            source,
            "fmu",
            f"there is no shipped FMU `{component.fmu}`{hint}",
            f"give the path of a .fmu file, or one of: {', '.join(known)}",
        )
    name = file_name(component.fmu, component.fmi, coils if component.fmi == 2 else DEFAULT_COILS)
    there = ", ".join(sorted(p.name for p in fmu_folder().glob("*.fmu"))) or "no FMU"
    how = f"cosim fmu build {component.fmu} --fmi {component.fmi} --coils {coils} --out {fmu_folder()}"
    raise InputError(
        source,
        "fmu",
        f"there is no `{name}` in COSIM_FMU_PATH={fmu_folder()} (there: {there})",
        f"build it with `{how}`, give the path of a .fmu file, or unset the variable",
    )
