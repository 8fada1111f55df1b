"""What a bank's parameters may be off by: shared over all coils, from coil to coil, and from day to day.

The defaults are those of a careful rig: a few per cent. A parameter set can say otherwise (`uncertainty`, `scatter`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from cosim.errors import InputError
from diagnosis.recording.recording import Recording


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


_MECHANICAL = ("extension", "length", "stiffness", "tension")

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


#: Parameter of the bank to those of the actuator whose product it is.
FACTORS: Mapping[str, tuple[str, ...]] = {
    "conductance": ("heat_transfer_coefficient", "area"), "capacity": ("density", "volume", "specific_heat"),
}  # fmt: skip


def stated_priors(uncertainty: Mapping[str, float], scatter: Mapping[str, float]) -> dict[str, Prior]:
    """Priors of the bank's relative parameters, as a parameter set states them; the defaults where it does not.

    Args:
        uncertainty: Parameter of the actuator to the standard deviation of ln(value) that all coils share.
        scatter: The same from coil to coil.
    """
    found = dict(PRIORS)
    for name, prior in PRIORS.items():
        factors = FACTORS.get(name, (name,))
        if prior.is_relative and any(f in uncertainty for f in factors):
            prior = replace(prior, shared=math.hypot(*(uncertainty.get(f, 0.0) for f in factors)))
        if prior.is_relative and any(f in scatter for f in factors):
            prior = replace(prior, scatter=math.hypot(*(scatter.get(f, 0.0) for f in factors)))
        found[name] = prior
    return found


def daily_priors(recording: Recording, initial: str, ambient: str) -> dict[str, Prior]:
    """What belongs to one recording alone, as it states it (`uncertain`); the defaults where it does not.

    Args:
        recording: The recording.
        initial: `component.parameter` of the initial temperature.
        ambient: `component.output` of the programme of the surroundings.

    Raises:
        InputError: It states a number that a coil bank cannot vary.
    """
    names = {ambient: "ambient_offset", initial: "initial_temperature"}
    found = dict(DAILY)
    for name, deviation in recording.uncertain.items():
        file, key = recording.path / "recording.yaml", f"uncertain.{name}"
        if name not in names:
            raise InputError(file, key, "this number of a network of coils cannot be estimated",
                             f"name {ambient} or {initial}")  # fmt: skip
        if not deviation.number > 0:
            raise InputError(file, key, f"{deviation} is not positive",
                             "give a positive difference in K or degC")  # fmt: skip
        found[names[name]] = Prior(deviation.number, is_relative=False)  # a difference: K and degC are the same
    return found
