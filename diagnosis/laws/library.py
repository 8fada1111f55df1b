"""All laws, from one file each, and laws without a name that follow a pattern."""

from __future__ import annotations

import functools
import importlib
import pkgutil

import diagnosis.laws as package
from diagnosis.laws.law import Law, Number, Role

#: Folders of laws with a file each.
FOLDERS = ("motion", "heat", "fluid", "electrical", "signal")
_FORM = "form of the formula: a power series of what is missing"
#: Form to its formula over one quantity o, the product of symbols that divides its strength, and its name.
_FORMS = {
    "linear": ("o", "o"),
    "squared": ("o ** 2", "o**2"),
    "signed_square": ("abs(o) * o", "o**2"),
    "cubed": ("o ** 3", "o**3"),
}


@functools.cache
def library() -> tuple[Law, ...]:
    """Every law, those with a name first.

    >>> next(law.name for law in library() if law.identifier == "cubic_spring")
    'spring that hardens or softens (Duffing)'
    """
    named = []
    for folder in FOLDERS:
        where = importlib.import_module(f"{package.__name__}.{folder}")
        for module in sorted(m.name for m in pkgutil.iter_modules(where.__path__)):
            named.append(importlib.import_module(f"{where.__name__}.{module}").LAW)
    return tuple(sorted((*named, *_generic()), key=lambda law: not law.is_named))


def _generic() -> list[Law]:
    """Laws without a name: constants, powers and products."""
    found = [_law("constant", "constant rate", Role.STATE, "a", "rate")]
    for name, (formula, power) in _FORMS.items():
        own = formula.replace("o", "s"), power.replace("o", "s")
        found.append(_law(f"rate_{name}", "law of its own state", Role.STATE, f"a * {own[0]}", f"rate/({own[1]})"))
        found.append(
            _law(f"coupling_{name}", "law of another quantity", Role.PAIR, f"a * {formula}", f"rate/({power})")
        )
        found.append(_law(f"port_{name}", "law of an output at an input", Role.PORT, f"a * {formula}", f"u/({power})"))
    found.append(_law("rate_of_product", "law of a product", Role.PAIR, "a * s * o", "rate/s/o"))
    sign = {"rounding": ("s", 0.01)}
    found.append(
        _law("rate_of_sign", "law of the sign of its own state", Role.STATE, "a * tanh(s / rounding)", "rate", sign)
    )
    sign = {"rounding": ("o", 0.01)}
    found.append(_law("port_of_sign", "law of the sign of an output", Role.PORT, "a * tanh(o / rounding)", "u", sign))
    return found


def _law(
    identifier: str, name: str, role: Role, formula: str, of: str, constants: dict[str, tuple[str, float]] | None = None
) -> Law:
    strength = Number("a", of, "strength", (0.05, -0.05), 1000.0, None)
    return Law(identifier, name, role, formula, (strength,), _FORM, constants or {}, is_named=False)
