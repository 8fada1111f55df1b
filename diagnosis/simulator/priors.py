"""What a bank's parameters may be off by: shared over all coils, from coil to coil, and from day to day.

The defaults are those of a careful rig: a few per cent. A parameter set can say otherwise (`uncertainty`, `scatter`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Prior:
    """How far a parameter may be off.

    Args:
        shared: Standard deviation common to all coils; 0: it is taken as given.
        scatter: Standard deviation from coil to coil; 0: all coils are the same.
        is_relative: Of the logarithm of the value, or of the value itself.
        needs: Quantities of which at least one must be measured for it to matter; empty: any.
    """

    shared: float
    scatter: float = 0.0
    is_relative: bool = True
    needs: tuple[str, ...] = ()


_MECHANICAL = ("extension", "length", "stiffness")
_ELECTRICAL = ("current", "supply_current", "resistance", "power")

#: Base parameter of the bank to its prior. `heating_shift` and `cooling_shift` move a branch of the stiffness along
#: the temperature, `transformation_shift` both [K].
PRIORS: Mapping[str, Prior] = {
    "reference_resistance": Prior(0.03, 0.035),
    "conductance": Prior(0.05, 0.035),
    "capacity": Prior(0.05, 0.035),
    "cooling_rate": Prior(0.05),
    "heating_a": Prior(0.03, needs=_MECHANICAL),
    "heating_d": Prior(0.02, needs=_MECHANICAL),
    "cooling_a": Prior(0.03, needs=_MECHANICAL),
    "heating_shift": Prior(1.0, is_relative=False, needs=_MECHANICAL),
    "cooling_shift": Prior(1.0, is_relative=False, needs=_MECHANICAL),
    # Coil by coil: one factor for weight and stiffness together, and where the loop lies (several coils only).
    "transformation_shift": Prior(0.0, 0.25, is_relative=False, needs=_MECHANICAL),
    "load": Prior(0.02, 0.012, needs=_MECHANICAL),
    "power_gain": Prior(0.0, needs=("temperature",)),
}
#: The same for every recording by itself (another day): [K].
DAILY: Mapping[str, Prior] = {
    "ambient_offset": Prior(0.5, is_relative=False),
    "initial_temperature": Prior(0.3, is_relative=False),
}


def matters(prior: Prior, measured: set[str]) -> bool:
    """Whether a parameter can be seen in what is measured."""
    return not prior.needs or bool(measured & set(prior.needs))
