"""The table of variables (config.h) of a generated FMU."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache

from cosim.shipped import FMUS
from cosim.unit.quantity import parse_unit, registry

#: SI base units in the order of the table of units in fmus/fmi/describe.c, as pint names their dimensions.
_BASES = ("[mass]", "[length]", "[time]", "[current]", "[temperature]")


@dataclass(frozen=True)
class Row:
    """One variable; see fmus/fmi/model.h.

    Args:
        identifier: In C.
        role: INPUT, OUTPUT, PARAMETER, FLAG, HIDDEN, TIME or STRUCTURE.
        unit: SI unit.
        start: Start value, C text.
        description: For people.
        name: In the FMU; default the identifier.
        is_scalar: One value for all coils.
        limit: ANY, NON_NEGATIVE or POSITIVE.
        depends: Names of the inputs that it depends on directly; `@name`: at the start alone.
        nominal: Typical size.
    """

    identifier: str
    role: str
    unit: str = "1"
    start: str = "0"
    description: str = ""
    name: str = ""
    is_scalar: bool = False
    limit: str = "ANY"
    depends: str = ""
    nominal: float = 1.0

    def text(self) -> str:
        """The row of the X-macro."""
        extent = "SCALAR" if self.is_scalar else "PER_COIL"
        fields = (
            self.identifier,
            f'"{self.name or self.identifier}"',
            self.role,
            extent,
            f'"{self.unit}"',
            self.start,
            self.limit,
            f"{self.nominal:g}",
            f'"{self.depends}"',
            f'"{_plain(self.description)}"',
        )
        return f"V({', '.join(fields)})"


def config(identifier: str, description: str, rows: Sequence[Row]) -> str:
    """Text of config.h."""
    table = " \\\n    ".join(row.text() for row in rows)
    units = "".join(f"    {row} \\\n" for row in _new_units({r.unit for r in rows}))
    return (
        f"/* {_plain(description)}: its variables. Generated. */\n#ifndef CONFIG_H\n#define CONFIG_H\n\n"
        f'#define MODEL_IDENTIFIER "{identifier}"\n#define MODEL_DESCRIPTION "{_plain(description)}"\n'
        "#define MODEL_STOP_TIME 30.0\n#define MODEL_STEP_SIZE 0.01\n#define MODEL_CO_SIMULATION_ONLY\n"
        + (f"#define MODEL_UNITS \\\n{units}\n" if units else "")
        + f"#define VARIABLES(V) \\\n    {table}\n\n#endif\n"
    )


def _plain(text: str) -> str:
    """Text that may stand in a C string, a C comment and an XML attribute."""
    return re.sub(
        r"\s+",
        " ",
        text.replace("&", "and")
        .replace("<", "under")
        .replace(">", "over")
        .replace('"', "'")
        .replace("\\", "/")
        .replace("*/", "* /")
        .replace("/*", "/ *")
        .replace("%", "percent"),
    )


@cache
def _known_units() -> frozenset[str]:
    text = (FMUS / "fmi" / "describe.c").read_text(encoding="utf-8")
    return frozenset(re.findall(r'\{"([^"]+)", *-?\d', text))


def _new_units(units: Iterable[str]) -> list[str]:
    """Rows of the table of units for those that describe.c does not know.

    Raises:
        ValueError: A unit is not SI: its factor is not 1.
    """
    return [f'{{"{unit}", {", ".join(map(str, exponents(unit)))}}},' for unit in sorted(set(units) - _known_units())]


def exponents(unit: str) -> tuple[int, ...]:
    """Exponents of kg, m, s, A and K.

    Raises:
        ValueError: It is no product of powers of SI base units.

    >>> exponents("K/N")
    (-1, -1, 2, 0, 1)
    """
    quantity = registry().Quantity(1.0, parse_unit(unit)).to_base_units()
    dimensions = dict(quantity.dimensionality)
    if abs(quantity.magnitude - 1.0) > 1e-9 or set(dimensions) - set(_BASES):
        raise ValueError(f"{unit} is no SI unit")
    return tuple(int(str(dimensions.get(base, 0)).removesuffix(".0")) for base in _BASES)
