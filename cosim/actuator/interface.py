"""The interface of an actuator FMU: which inputs and outputs make it interchangeable with every other.

docs/actuators/interface.md explains it to those who write one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cosim.unit.protocol import Causality, Variable
from cosim.unit.quantity import conversion

#: Where a user reads on.
PAGE = "docs/actuators/interface.md"


@dataclass(frozen=True)
class Port:
    """One variable of the interface.

    Args:
        name: Its name in the FMU.
        causality: Seen from the FMU.
        unit: SI unit that the FMU must declare.
        meaning: One sentence for documentation and errors.
        is_required: Whether an actuator without it is refused.
        is_per_coil: Whether it has one value per coil; otherwise one for all, or one per coil.
    """

    name: str
    causality: Causality
    unit: str
    meaning: str
    is_required: bool = False
    is_per_coil: bool = True

    def __str__(self) -> str:
        return f"{self.causality.value} `{self.name}` [{self.unit}]"


_IN, _OUT = Causality.INPUT, Causality.OUTPUT
#: Every variable of the interface. Of power and voltage at least one is required.
PORTS = (
    Port("power", _IN, "W", "electrical power turned into heat in each coil"),
    Port("voltage", _IN, "V", "voltage across each coil"),
    Port("ambient_temperature", _IN, "K", "temperature of the surroundings", True, is_per_coil=False),
    Port("extension", _IN, "m", "elongation of each coil beyond its rest length"),
    Port("tension", _IN, "N", "pull on each coil"),
    Port("stiffness", _OUT, "N/m", "spring constant of each coil", True),
    Port("rest_length", _OUT, "m", "length of each coil without load", True),
    Port("temperature", _OUT, "K", "temperature of each coil", True),
    Port("resistance", _OUT, "ohm", "electrical resistance of each coil", True),
    Port("stored_energy", _OUT, "J", "energy stored in each coil since the start"),
    Port("convected_energy", _OUT, "J", "heat given to the surroundings since the start"),
)


def faults(variables: Mapping[str, Variable]) -> list[str]:
    """What keeps an FMU from being an actuator, one sentence per fault; an empty list for an actuator.

    Args:
        variables: The FMU's variables with the shapes that its structure gives.
    """
    found = [text for port in PORTS for text in _port_faults(port, variables.get(port.name))]
    if not {"power", "voltage"} & {n for n, v in variables.items() if v.causality is Causality.INPUT}:
        found.insert(0, "it has no input `power` [W] and no input `voltage` [V], one value per coil: one is needed")
    return found + _size_faults(variables)


def coils_of(variables: Mapping[str, Variable]) -> int | None:
    """Number of coils of an actuator: the length of its stiffness; None where it is no vector."""
    variable = variables.get("stiffness")
    return variable.shape[0] if variable is not None and len(variable.shape) == 1 else None


def _port_faults(port: Port, variable: Variable | None) -> list[str]:
    many = ", one value per coil" if port.is_per_coil else ""
    if variable is None:
        return [f"it has no {port}{many}: {port.meaning}"] if port.is_required else []
    found = []
    if variable.causality is not port.causality:
        found.append(f"its `{port.name}` is of causality {variable.causality.value}, not {port.causality.value}")
    if not variable.type.is_float:
        found.append(f"its `{port.name}` is of type {variable.type.value}, not a floating-point number")
    if not _is_same_unit(variable.unit, port.unit):
        found.append(f"its `{port.name}` is in `{variable.unit}`, not in {port.unit}")
    return found


def _is_same_unit(unit: str, wanted: str) -> bool:
    """Results of several actuators stand side by side, so a value in N/mm is no value in N/m here."""
    try:
        return conversion(unit, wanted) == (1.0, 0.0)
    except ValueError:
        return False


def _size_faults(variables: Mapping[str, Variable]) -> list[str]:
    coils, found = coils_of(variables), []
    for port in PORTS:
        variable = variables.get(port.name)
        if variable is None:
            continue
        if port.is_per_coil and len(variable.shape) != 1:
            found.append(f"its `{port.name}` has shape {variable.shape}, not one value per coil: (coils,)")
        elif coils is not None and variable.shape not in {(coils,)} | (set() if port.is_per_coil else {()}):
            found.append(f"its `{port.name}` has {variable.size} values, but its `stiffness` has {coils}")
    return found
