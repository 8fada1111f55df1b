"""Whether a scenario is wired as a coil network is: what a network takes for granted must be what is connected."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.components import CircuitComponent, ContactElement, SourceResistanceElement
from cosim.connection import Connection
from cosim.system import System
from cosim.unit.protocol import Array
from diagnosis.models.coil_network.stated import is_constant


def fault(system: System, actuator: str, circuit: str | None, load: str | None, driven: Sequence[str]) -> str:
    """Why a network cannot stand for these connections; empty if it can.

    Args:
        system: The assembled scenario.
        actuator: Component that holds the coils.
        circuit: Circuit, or None where power is given.
        load: Hanging load, or None.
        driven: Components whose inputs are no part of the network (a fabric).
    """
    pairs = []
    if circuit is not None:
        pairs += [((circuit, "power"), (actuator, "power")), ((actuator, "resistance"), (circuit, "resistance"))]
    if load is not None:
        pairs += [((actuator, n), (load, n)) for n in ("stiffness", "rest_length")]
    for source, target in pairs:
        reason = _unlike(system, source, target)
        if reason:
            return reason
    known = {target for _, target in pairs} | {(actuator, "power"), (actuator, "ambient_temperature")}
    known |= {(circuit, "supply_voltage")} if circuit is not None else set()
    for connection in system.connections:
        if connection.target not in known and connection.target[0] not in driven:
            return f"a network has no connection {connection}"
    return ""


def _unlike(system: System, source: tuple[str, str], target: tuple[str, str]) -> str:
    """Why an input is not the output of another unit, element by element; empty if it is."""
    into = [c for c in system.connections if c.target == target]
    name = ".".join(target)
    other = next((c for c in into if c.source != source), None)
    if other is not None:
        return f"a network takes {name} from {'.'.join(source)}, and not by {other}"
    scaled = next((c for c in into if c.is_scaled), None)
    if scaled is not None:
        return f"a network takes {name} as it is, and {scaled} is scaled"
    if any(c.source_element is None and c.target_element is None for c in into):
        return ""
    moved = next((c for c in into if c.source_element != c.target_element), None)
    if moved is not None:
        return f"a network connects coils in their order, and not by {moved}"
    shape = system.units[target[0]].variables[target[1]].shape
    missing = set(np.ndindex(shape)) - {c.target_element for c in into}
    return f"nothing is connected to {name}" + (" of some coils" if into else "") if missing else ""


def reached(connections: Sequence[Connection], size: int) -> bool:
    """Whether every element of an input has a connection."""
    elements = {c.target_element for c in connections}
    return None in elements or len(elements) == size


def series_resistances(circuit: CircuitComponent, start: float) -> tuple[float | Array, float | Array]:
    """Resistance in series with every string and with every source, constant elements of the circuit among them [ohm].

    Args:
        circuit: The circuit.
        start: Begin of the run [s]; a contact that came before it is there all the time.

    Returns:
        For the strings and for the sources; one number where all are alike.
    """
    strings = np.full(len(circuit.strings), circuit.string_resistance.to("ohm"))
    sources = np.full(1 if circuit.supply == "common" else len(circuit.strings), circuit.supply_resistance.to("ohm"))
    for element in circuit.elements:
        if isinstance(element, ContactElement) and is_constant(element, start):
            strings[element.string - 1] += element.resistance.to("ohm")
        elif isinstance(element, SourceResistanceElement):
            sources[element.supply - 1] += element.resistance.to("ohm")
    return _one(strings), _one(sources)


def _one(values: Array) -> float | Array:
    return float(values[0]) if np.all(values == values[0]) else values
