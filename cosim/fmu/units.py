"""Units that an FMU declares, as text that pint understands wherever that is possible.

An FMU names its units freely (`N.m`, `W/(m2.K)`, `foo`) and may define each by exponents of SI base units, a factor and
an offset (FMI 2.0 section 2.2.2, FMI 3.0 section 2.4.4): value in base units = factor * value + offset.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from fmpy.model_description import BaseUnit, ModelDescription, ModelVariable

from cosim.unit.quantity import conversion, parse_unit, registry

_BASES = {"kg": "kg", "m": "m", "s": "s", "A": "A", "K": "K", "mol": "mol", "cd": "cd", "rad": "rad"}
_POWER = re.compile(r"(?<=[A-Za-z])([-+]?\d+)")
_TOLERANCE = 1e-9


class UnitNames:
    """Unit text of every variable.

    Args:
        description: The model description.
    """

    def __init__(self, description: ModelDescription) -> None:
        self._bases: Mapping[str, BaseUnit | None] = {u.name: u.baseUnit for u in description.unitDefinitions}
        self._displays = {
            u.name: {d.name: (float(d.factor), float(d.offset)) for d in u.displayUnits}
            for u in description.unitDefinitions
        }
        self._resolved: dict[str, str] = {"": "1", "1": "1"}

    def declared(self, variable: ModelVariable) -> str:
        """Unit as the FMU writes it; `1` where it declares none."""
        kind = variable.declaredType
        return variable.unit or (kind.unit if kind is not None else None) or "1"

    def of(self, variable: ModelVariable) -> str:
        """Text that pint understands where the FMU's own text or its definition allows that, else the FMU's text."""
        text = self.declared(variable)
        if text not in self._resolved:
            self._resolved[text] = self._resolve(text)
        return self._resolved[text]

    def from_display(self, variable: ModelVariable, number: float, unit: str) -> float | None:
        """A number in one of the variable's display units in its unit; None where there is no such display unit.

        FMI 2.0 and 3.0: value in the display unit = factor * value in the unit + offset.
        """
        found = self._displays.get(self.declared(variable), {}).get(unit)
        return None if found is None or found[0] == 0.0 else (number - found[1]) / found[0]

    def _resolve(self, text: str) -> str:
        base = self._bases.get(text)
        candidates = [text, modelica_to_pint(text)]
        if "." in text:  # pint would read `J/kg.K` from left to right
            candidates.reverse()
        for candidate in candidates:
            if is_known(candidate) and (base is None or _agrees(candidate, base)):
                return candidate
        return text if base is None else _define(text, base)


def is_known(text: str) -> bool:
    """Whether pint understands it."""
    try:
        parse_unit(text)
    except ValueError:
        return False
    return True


def modelica_to_pint(text: str) -> str:
    """Modelica's notation of products and powers: `W/(m2.K)` becomes `W/(m**2*K)`."""
    return _POWER.sub(r"**\1", text.replace(".", "*"))


def _exponents(base: BaseUnit) -> str:
    powers = [(symbol, int(getattr(base, key))) for key, symbol in _BASES.items() if int(getattr(base, key))]
    return " * ".join(symbol if power == 1 else f"{symbol}**{power}" for symbol, power in powers) or "1"


def _agrees(text: str, base: BaseUnit) -> bool:
    """Whether pint takes the text for what the FMU defines; else the definition counts (`C` may be degrees)."""
    try:
        factor, offset = conversion(text, _exponents(base))
    except ValueError:
        return False
    allowed = _TOLERANCE * abs(base.factor), _TOLERANCE * max(abs(base.offset), 1.0)
    return bool(abs(factor - base.factor) <= allowed[0] and abs(offset - base.offset) <= allowed[1])


def _define(text: str, base: BaseUnit) -> str:
    """A unit by its definition: the base units where they are the unit, else a name of its own made known to pint."""
    exponents = _exponents(base)
    if base.factor == 1.0 and base.offset == 0.0:
        return exponents
    factor, offset = repr(float(base.factor)), repr(float(base.offset))
    stem = re.sub(r"\W+", "_", text).strip("_") or "unit"
    # The definition is part of the name: two FMUs may mean different things by the same text.
    name = re.sub(r"\W", "_", f"fmu_{stem}_{factor}_{offset}_{exponents}".replace("-", "minus"))
    if not is_known(name):
        scale = f"{factor} * {exponents}" if exponents != "1" else factor
        registry().define(f"{name} = {scale}" + (f"; offset: {offset}" if base.offset else ""))
    return name
