"""One scenario, another actuator: what changes, and what cannot be kept."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from cosim.components import ActuatorComponent
from cosim.fmu_assembly import find_fmu
from cosim.fmu_tools.info import read_info
from cosim.scenario import Scenario
from cosim.unit.errors import InputError


@dataclass(frozen=True)
class Variant:
    """One run of a comparison.

    Args:
        label: Name in tables and of its run folder.
        scenario: The scenario with this actuator.
        left_out: Parameters of the scenario that this actuator does not have.
    """

    label: str
    scenario: Scenario
    left_out: tuple[str, ...]


def actuator_name(scenario: Scenario, chosen: str | None = None) -> str:
    """Name of the component to exchange.

    Raises:
        InputError: There is none of kind `actuator`, or more than one and none is chosen.
    """
    names = [n for n, c in scenario.components.items() if isinstance(c, ActuatorComponent)]
    where = scenario.path or "scenario"
    if chosen is not None and chosen not in names:
        raise InputError(
            where,
            "components",
            f"`{chosen}` is no component of kind actuator",
            f"there are: {', '.join(names) or 'none'}",
        )
    if not names:
        raise InputError(
            where,
            "components",
            "no component is of kind actuator, so there is nothing to exchange",
            "give the actuator `kind: actuator` (docs/swap-an-actuator.md)",
        )
    if chosen is None and len(names) > 1:
        raise InputError(
            where, "components", f"it has several actuators: {', '.join(names)}", "choose one with `--component`"
        )
    return chosen or names[0]


def label_of(actuator: str) -> str:
    """Name of an actuator in a table: a shipped name as it is, a path without folder and ending."""
    return Path(actuator).stem if actuator.endswith(".fmu") else actuator


def variant(scenario: Scenario, component: str, actuator: str, fmi: int | None) -> Variant:
    """The scenario with another actuator.

    Its parameter set is its own; of the parameters that the scenario gives it keeps those that it has.

    Args:
        scenario: The scenario as written.
        component: The component to exchange.
        actuator: A shipped name, or path of a .fmu file (relative to the working folder).
        fmi: FMI version of shipped actuators; None as in the scenario.

    Raises:
        InputError: There is no such actuator.
    """
    old = scenario.components[component]
    assert isinstance(old, ActuatorComponent)
    update: dict[str, object] = {"fmi": fmi or old.fmi}
    left_out: list[str] = []
    if actuator != old.fmu:
        file = str(Path(actuator).resolve()) if actuator.endswith(".fmu") else actuator
        new = old.model_copy(update={**update, "fmu": file})
        known = _variables(new, scenario)
        left_out = [n for n in old.parameters if n not in known]
        kept = {n: v for n, v in old.parameters.items() if n in known}
        start = {n: v for n, v in old.start.items() if n in known}
        record = [n for n in old.record if n in known]
        update |= {"fmu": file, "parameter_set": None, "parameters": kept, "start": start, "record": record}
    changed = old.model_copy(update=update)
    title = f"{label_of(actuator)}: {scenario.title}"
    components = {**scenario.components, component: changed}
    return Variant(
        label_of(actuator), scenario.model_copy(update={"components": components, "title": title}), tuple(left_out)
    )


def _variables(component: ActuatorComponent, scenario: Scenario) -> set[str]:
    """Names of the variables of an FMU; those of FMI 2.0 and 3.0 are the same, whatever the size."""
    source = scenario.path or Path("scenario")
    unsized = component.model_copy(update={"structure": {}})
    return {row["name"] for row in read_info(find_fmu(unsized, source)).variables}
