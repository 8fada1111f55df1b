"""Which parts of a network leave each other alone, so that several derivatives come from one simulation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.models.coil_network.kernel.layout import Array, CoilNetworkLayout, FieldAxis
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters

#: Hooks through which coils of different strings feel each other.
_JOINING_HOOKS = frozenset({"pairs", "contacts", "shared"})
_ELECTRICAL = frozenset({"reference_resistance", "resistance_temperature_coefficient", "reference_temperature"})


class Independence:
    """Whether coils, or strings, can be perturbed together.

    Strings are apart where their supply has no resistance (or each has its own) and no candidate joins them. Coils are
    apart where moreover no coil's temperature acts on its resistance and the parameter is not an electrical one.

    Args:
        layout: Coils and strings.
        active: Candidates that are switched on, or about to be.
        parameters: Values of the base.
    """

    def __init__(
        self, layout: CoilNetworkLayout, active: Sequence[CandidateTerm], parameters: CoilNetworkParameters
    ) -> None:
        self._layout = layout
        hooks = {h for t in active for h in t.lines}
        joined = bool(hooks & _JOINING_HOOKS) or any(t.axis == "channel" and not t.keeps_sums for t in active)
        supply = np.any(np.asarray(parameters.base.get("supply_resistance", 0.0))) or "supply" in hooks
        slope = np.any(np.asarray(parameters.base.get("resistance_temperature_coefficient", 0.0)))
        self.are_strings_apart = bool(layout.strings) and not joined and (not supply or layout.supply == "per_string")
        self.are_coils_apart = not joined and (not layout.strings or not (slope or "resistance" in hooks))

    def part(self, parameter: str, axis: FieldAxis, mask: Array) -> tuple[str, int]:
        """Level and number of the only part (coil, string, channel) that a direction touches; number -1: several."""
        touched = np.flatnonzero(mask)
        if axis == "channel" and touched.size == 1:
            return "channel", int(touched[0])  # sensors come after the simulation
        is_electrical = parameter in _ELECTRICAL
        if axis == "coil" and touched.size == 1 and self.are_coils_apart and not is_electrical:
            return "coil", int(touched[0])
        if axis in ("coil", "string") and self.are_strings_apart:
            strings = np.unique(self._layout.string_of_coil[touched]) if axis == "coil" else touched
            if strings.size == 1:
                return "string", int(strings[0])
        return "all", -1
