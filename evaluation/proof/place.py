"""Places of findings and of truths in one language: the set of elements that an effect acts on."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import yaml

from cosim.unit.quantity import PhysicalValue
from evaluation.proof.answer import Concealed

#: Gradients act on all coils, each with another sign or amount: they are places of their own.
_GRADIENTS = {
    "gradient over rows": "row gradient",
    "gradient over columns": "column gradient",
    "row_gradient": "row gradient",
    "column_gradient": "column gradient",
}
#: Places that are several coils of a circuit.
_PATTERNS = ("ends of the strings", "outer strings", "edge of the network")
_COLUMN = re.compile(r"place (\d+) of every string$")
_STRING = re.compile(r"string\[(\d+)\]$")
_COIL = re.compile(r"coil\[([\d,]+)\]$")
#: On which day alone an effect acts says nothing about where.
_DAY = re.compile(r" (in recording \d+|on day .*)$")


@dataclass(frozen=True)
class Rig:
    """What a case is made of.

    Args:
        strings: Coils of each string; without a circuit, one entry for each coil.
        is_circuit: Whether coils are numbered by string and place.
        channels: Names of what is measured.
    """

    strings: tuple[int, ...]
    is_circuit: bool
    channels: tuple[str, ...]

    @property
    def coils(self) -> frozenset[str]:
        """All coils."""
        return frozenset(c for s in range(len(self.strings)) for c in self.string(s + 1))

    def string(self, number: int) -> frozenset[str]:
        """Coils of a string, counted from 1."""
        if not self.is_circuit:
            return frozenset({f"coil[{number}]"})
        return frozenset(f"coil[{number},{n + 1}]" for n in range(self.strings[number - 1]))

    def pattern(self, label: str) -> frozenset[str]:
        """Coils at one place of every string, at the ends of strings, in the outer strings, or both."""
        column, last = _COLUMN.match(label), len(self.strings) - 1
        found = set()
        for s, count in enumerate(self.strings):
            for n in range(count):
                is_end, is_outer = n in (0, count - 1), s in (0, last)
                is_of = {
                    "ends of the strings": is_end,
                    "outer strings": is_outer,
                    "edge of the network": is_end or is_outer,
                }
                if n == int(column[1]) - 1 if column else is_of[label]:
                    found.add(f"coil[{s + 1},{n + 1}]")
        return frozenset(found)

    def of_quantity(self, quantity: str) -> frozenset[str]:
        """Channels of one quantity; the current of the supply is a quantity of its own."""
        return frozenset(c for c in self.channels if c.partition(".")[2] == quantity and c != "supply.current")


def true_place(truth: Concealed, rig: Rig) -> frozenset[str]:
    """Elements that a concealed effect acts on."""
    if truth.channels:
        return frozenset(truth.channels)
    if truth.place in _GRADIENTS:
        return frozenset({_GRADIENTS[truth.place]})
    if truth.place == "all":
        return rig.coils
    if truth.elements:
        return frozenset().union(*(found_place(e, rig) for e in truth.elements))
    return frozenset({truth.place})


def found_place(label: str, rig: Rig) -> frozenset[str]:
    """Elements of a finding's place: `coil[2,5]`, `string[3]`, `all coils`, `every temperature`, `supply`, ...

    A string is the set of its coils, so that the only coil of a string, and all coils of a rig of one, are the same.
    """
    label = _DAY.sub("", label.strip())
    if label in _GRADIENTS:
        return frozenset({_GRADIENTS[label]})
    if label in ("all coils", "all strings"):
        return rig.coils
    if label == "all sources" or label.startswith("supply["):
        return frozenset({"supply"})
    if label.startswith("every "):
        return rig.of_quantity(label.removeprefix("every "))
    if " and " in label:
        return frozenset(part.strip() for part in label.split(" and "))
    if label in _PATTERNS or _COLUMN.match(label):
        return rig.pattern(label)
    string = _STRING.match(label)
    if string and int(string[1]) <= len(rig.strings):
        return rig.string(int(string[1]))
    coil = _COIL.match(label)
    return frozenset({f"coil[{coil[1]}]"}) if coil else frozenset({label})


def read_rig(case: Path) -> Rig:
    """Rig of a case, from its scenario and the channels of its recordings."""
    scenario = yaml.safe_load((case / "scenario.yaml").read_text())
    channels: set[str] = set()
    for sidecar in sorted(case.glob("*/recording.yaml")):
        channels |= set(yaml.safe_load(sidecar.read_text())["channels"])
    circuits = [c for c in scenario["components"].values() if c.get("kind") == "ngspice"]
    if circuits:
        return Rig(tuple(circuits[0]["strings"]), True, tuple(sorted(channels)))
    coils = {c.partition(".")[0] for c in channels if c.startswith("coil[")}
    return Rig((1,) * len(coils), False, tuple(sorted(channels)))


def read_duration(case: Path) -> float:
    """Length of a case's first training recording [s], as its table has it."""
    sidecar = yaml.safe_load((case / "training_1" / "recording.yaml").read_text())
    return float(PhysicalValue.parse(sidecar["overrides"]["time"]["stop"]).to("s"))
