"""Structural model of a coil network: which equation holds which variables, and where a fault would enter.

Equations: docs/architecture.md (circuit, heat balance, stiffness, extension under a load). Faults are additive, one in
each equation and one in each sensor. Analysis: canonical decomposition (Dulmage and Mendelsohn) as in M. Krysander and
E. Frisk, IEEE Trans. Syst. Man Cybern. A 38 (2008) 1398-1410, by faultdiagnosistoolbox.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from cosim.unit.protocol import AnyArray

#: Quantity that a channel may measure to the variable of the model.
VARIABLES: Mapping[str, str] = {
    "supply_current": "supply_current",
    "current": "current",
    "resistance": "R",
    "power": "P",
    "temperature": "T",
    "stiffness": "k",
    "extension": "x",
    "length": "x",
    "terminal_voltage": "V_terminal",
    "voltage": "U",
    "string_voltage": "U_string",
    "supply_power": "P_supply",
    "second_temperature": "T",
    "second_extension": "x",
}
#: Quantity to what its sensor is called, where that is not element and quantity.
SENSORS: Mapping[str, str] = {
    "terminal_voltage": "voltage at the supply's terminals",
    "string_voltage": "{}.voltage",
    "supply_power": "supply.power",
}
#: Kind of a fault to its words; `{}` is the element.
WORDS: Mapping[str, str] = {
    "supply": "voltage of {}",
    "string": "resistance in series with {}",
    "resistance": "resistance of {}",
    "heat": "heat balance of {}",
    "stiffness": "stiffness of {}",
    "length": "force or extension of {}",
}


@dataclass(frozen=True)
class Rig:
    """The part of a coil network that stands for the whole.

    Args:
        strings: Name of each string to the names of its coils; one string without name where power is given.
        has_circuit: Whether there is a circuit, else power is given.
        is_common: One supply for all strings.
        channels: Quantity and element of every channel.
        feels_heat: Whether a coil's resistance follows its temperature.
        has_load: Whether the coils are stretched, or their stiffness is of interest.
    """

    strings: Mapping[str, Sequence[str]]
    has_circuit: bool
    is_common: bool
    channels: Collection[tuple[str, str]]
    feels_heat: bool = False
    has_load: bool = True


@dataclass
class _Equations:
    """Equations as they are gathered."""

    relations: list[list[str]] = field(default_factory=list)
    unknown: dict[str, None] = field(default_factory=dict)
    known: dict[str, None] = field(default_factory=dict)
    faults: dict[str, str] = field(default_factory=dict)

    def add(self, unknown: Sequence[str], known: Sequence[str] = (), fault: str = "", words: str = "") -> None:
        """One relation between unknown and known variables, with a fault in it."""
        self.unknown |= dict.fromkeys(unknown)
        self.known |= dict.fromkeys(known)
        if fault:
            self.faults[fault] = words
        self.relations.append([*unknown, *known, *([fault] if fault else [])])

    def derivative(self, rate: str, variable: str) -> None:
        """`rate` is the derivative of `variable`."""
        self.unknown |= dict.fromkeys((rate, variable))
        from faultdiagnosistoolbox import DiffConstraint  # late, as below: it takes seconds to load

        self.relations.append(DiffConstraint(rate, variable))


@dataclass(frozen=True)
class Analysis:
    """What a structure lets one tell.

    Args:
        faults: In words.
        kinds: Kind of each fault: `heat`, `sensor`, ...
        is_detectable: Shape (faults,).
        is_isolable: Whether the first can be told from the second, shape (faults, faults).
    """

    faults: tuple[str, ...]
    kinds: tuple[str, ...]
    is_detectable: AnyArray
    is_isolable: AnyArray

    def classes(self) -> list[tuple[str, ...]]:
        """Detectable faults by what can be told apart."""
        found: list[list[int]] = []
        for n in np.flatnonzero(self.is_detectable):
            own = next((c for c in found if not (self.is_isolable[n, c[0]] or self.is_isolable[c[0], n])), None)
            if own is None:
                found.append([int(n)])
            else:
                own.append(int(n))
        return [tuple(self.faults[n] for n in c) for c in found]

    def undetectable(self) -> tuple[str, ...]:
        """Faults that no channel shows."""
        return tuple(f for f, seen in zip(self.faults, self.is_detectable) if not seen)

    @property
    def pairs(self) -> int:
        """Pairs of faults that can be told apart."""
        return int(np.sum(self.is_isolable & self.is_isolable.T) // 2)


def analyse(rig: Rig) -> Analysis:
    """Detectability and isolability of every fault of a rig."""
    from faultdiagnosistoolbox import DiagnosisModel

    equations = _equations(rig)
    model = DiagnosisModel(
        {
            "type": "VarStruc",
            "x": list(equations.unknown),
            "f": list(equations.faults),
            "z": list(equations.known),
            "rels": equations.relations,
        },
    )
    detectable, _ = model.DetectabilityAnalysis()
    mixed = np.asarray(model.IsolabilityAnalysis())
    seen = np.array([f in detectable for f in equations.faults])
    apart = (mixed == 0) & seen[:, None]
    kinds = tuple(name.split(":")[0] for name in equations.faults)
    return Analysis(tuple(equations.faults.values()), kinds, seen, apart)


def _equations(rig: Rig) -> _Equations:
    found = _Equations()
    if rig.has_circuit:
        _circuit(rig, found)
    for coils in rig.strings.values():
        for coil in coils:
            _coil(rig, coil, found)
    for quantity, element in sorted(rig.channels):  # a set has another order in every process
        variable = f"{VARIABLES[quantity]}:{element}"
        if variable in found.unknown:
            name = f"{element}.{quantity}" if element != "supply" else "supply.current"
            name = SENSORS.get(quantity, name).format(element)
            found.add([variable], [f"y:{quantity}:{element}"], f"sensor:{quantity}:{element}", f"sensor of {name}")
    return found


def _circuit(rig: Rig, found: _Equations) -> None:
    currents = [f"current:{s}" for s in rig.strings]
    if rig.is_common:
        found.add(
            ["V_terminal:supply", "supply_current:supply"], ["V"], "supply:", WORDS["supply"].format("the supply")
        )
    found.add(["supply_current:supply", *currents])
    if rig.is_common and _is_measured(rig, "supply_power"):
        found.add(["P_supply:supply", "V_terminal:supply", "supply_current:supply"])
    for string, coils in rig.strings.items():
        terminal = "V_terminal:supply" if rig.is_common else f"V_terminal:{string}"
        if not rig.is_common:
            words = WORDS["supply"].format(f"the supply of {string}")
            found.add([terminal], [f"V:{string}"], f"supply:{string}", words)
        resistances = [f"R:{c}" for c in coils]
        fault, words = f"string:{string}", WORDS["string"].format(string)
        if ("string_voltage", string) in rig.channels:  # over its coils, without what lies in series with them
            across = f"U_string:{string}"
            found.add([terminal, f"current:{string}", across], (), fault, words)
            found.add([across, f"current:{string}", *resistances])
        else:
            found.add([terminal, f"current:{string}", *resistances], (), fault, words)
        for coil in coils:
            felt = [f"T:{coil}"] if rig.feels_heat else []
            found.add([f"R:{coil}", *felt], (), f"resistance:{coil}", WORDS["resistance"].format(coil))
            found.add([f"P:{coil}", f"R:{coil}", f"current:{string}"])
            if ("voltage", coil) in rig.channels:
                found.add([f"U:{coil}", f"R:{coil}", f"current:{string}"])


def _is_measured(rig: Rig, quantity: str) -> bool:
    return any(q == quantity for q, _ in rig.channels)


def _coil(rig: Rig, coil: str, found: _Equations) -> None:
    if not rig.has_circuit:
        found.add([f"P:{coil}"], [f"P_given:{coil}"])
    found.add([f"dT:{coil}", f"P:{coil}", f"T:{coil}"], ["T_ambient"], f"heat:{coil}", WORDS["heat"].format(coil))
    found.derivative(f"dT:{coil}", f"T:{coil}")
    if not rig.has_load:
        return
    found.add([f"k:{coil}", f"T:{coil}"], (), f"stiffness:{coil}", WORDS["stiffness"].format(coil))
    found.add([f"x:{coil}", f"k:{coil}"], ["load"], f"length:{coil}", WORDS["length"].format(coil))
