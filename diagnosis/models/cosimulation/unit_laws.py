"""Laws that the units of a scenario can switch on themselves, by kind of component."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from cosim.scenario import Scenario
from diagnosis.laws.library import library
from diagnosis.models.fabric.camera import CAMERA_LAWS
from diagnosis.models.fabric.laws import LINK_LAWS, fabric_laws
from diagnosis.search.pendulum_terms import pendulum_laws
from diagnosis.search.unit_law import UnitLaw

#: Kind of component to its laws, given its name in the scenario.
LAWS: Mapping[str, Callable[[str], Sequence[UnitLaw]]] = {
    "bullet_pendulum": pendulum_laws,
    "bullet_fabric": fabric_laws,
}


def laws_of(scenario: Scenario) -> list[UnitLaw]:
    """Every law that a unit of the scenario may lack."""
    return [law for name, c in scenario.components.items() if c.kind in LAWS for law in LAWS[c.kind](name)]


def identifiers() -> set[str]:
    """Of all laws of all kinds of component, of links and cameras, and of the library for systems of FMUs."""
    own = {law.place.term.identifier for laws in LAWS.values() for law in laws("")}
    return own | LINK_LAWS | CAMERA_LAWS | {law.identifier for law in library()}
