"""Which part of a scenario a term acts in, and what it needs to know there of the other parts."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cache
from pathlib import Path

from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.candidates.hooks import NAMES
from diagnosis.models.coil_network.kernel.source import READABLE, words


class Part(Enum):
    """A part of an amended model."""

    CIRCUIT = "circuit"
    ACTUATOR = "actuator"
    LOAD = "load"
    SENSOR = "sensor"


def part_of(term: CandidateTerm) -> Part:
    """Where the lines of a term run: all of them in one part."""
    if term.axis == "channel":
        return Part.SENSOR
    if term.axis in ("string", "source"):
        return Part.CIRCUIT
    return Part.LOAD if {"load", "length"} & set(term.lines) else Part.ACTUATOR


@dataclass(frozen=True)
class Port:
    """A quantity of the coils that one generated FMU gives to another.

    Args:
        array: Field of `Step` in the network's C.
        name: Name of the variable in both FMUs.
        unit: SI unit.
        meaning: For people.
        is_late: Whether it is of the end of the step, after the stiffness was found.
    """

    array: str
    name: str
    unit: str
    meaning: str
    is_late: bool = False


#: What a load can be told of its coils, beside stiffness and rest length.
PORTS: Mapping[str, Port] = {
    p.array: p
    for p in (
        Port("temperature", "temperature", "K", "Temperature of each coil"),
        Port("mean", "mean_temperature", "K", "Temperature of each coil, mean over the last step"),
        Port("ambient", "surrounding_temperature", "K", "Temperature of the surroundings of each coil"),
        Port("rate", "temperature_rate", "K/s", "Rate of the temperature, mean over the last step"),
        Port("power", "heating_power", "W", "Electrical power in each coil over the last step"),
        Port("current", "coil_current", "A", "Current of each coil over the last step"),
        Port("energy", "electrical_energy", "J", "Electrical energy given to each coil since the start"),
        Port("phase", "phase", "1", "Share of austenite", True),
        Port("shift", "transformation_shift", "K", "Shift of the transformation temperatures", True),
        Port("remembered", "remembered_stiffness", "N/m", "Stiffness that the play operator remembers", True),
        Port("heating", "heating_branch", "N/m", "Heating branch at the temperature", True),
        Port("cooling", "cooling_branch", "N/m", "Cooling branch at the temperature", True),
        Port("crossing", "crossing", "1", "Temperature [degC] above which both branches are one", True),
    )
}
#: Arrays that a load has itself.
_OWN = {"stiffness", "tension", "extension", "extension_before", "before"}


def names_in(terms: Iterable[CandidateTerm]) -> set[str]:
    """Names that the lines and start values of terms read, without their own parameters and states."""
    found: set[str] = set()
    for term in terms:
        text = "\n".join([*term.lines.values(), *(s.start for s in term.states)])
        own = {p.name for p in term.parameters} | {s.name for s in term.states}
        found |= (words(text) & (set(READABLE) | set(NAMES))) - own
    return found


def load_ports(terms: Sequence[CandidateTerm]) -> list[Port]:
    """What the terms of a load need to be told of the coils.

    Raises:
        KeyError: They read something that only the coils know.
    """
    arrays: set[str] = set()
    for name in names_in(terms) & set(READABLE):
        array = READABLE[name].removeprefix("s->").removesuffix("[i]")
        if array in ("felt", "before"):
            arrays.add("temperature")
        elif array not in _OWN:
            arrays.add(array)
    over_step = [text for t in terms for hook, text in t.lines.items() if hook in ("state", "gather", "shared")]
    if any("T" in words(text) for text in over_step):
        arrays.add("mean")
    unknown = sorted(arrays - set(PORTS))
    if unknown:
        raise KeyError(f"a load cannot be told of {unknown[0]}")
    return [p for name, p in PORTS.items() if name in arrays]


@cache
def step_arrays() -> tuple[str, ...]:
    """Names of the arrays of `Step` in plan.h that a step works on."""
    import diagnosis.models.coil_network.kernel.source as network_source

    text = (Path(network_source.__file__).parent / "plan.h").read_text(encoding="utf-8")
    block = re.search(r"typedef struct \{([^}]*)\} Step;", text)
    assert block is not None, "plan.h defines Step"
    without_comments = re.sub(r"/\*.*?\*/", "", block[1], flags=re.DOTALL)
    found: list[str] = []
    for declaration in re.findall(r"^\s*double ([^;]*);", without_comments, flags=re.MULTILINE):
        found += [part.strip().removeprefix("*") for part in declaration.split(",") if part.strip().startswith("*")]
    return tuple(found)
