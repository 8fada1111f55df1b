"""Terms of the measurement: written beside the scenario, and applied to what a run gives."""

from __future__ import annotations

from typing import Any

import numpy as np

from diagnosis.amend.changes import Changes
from diagnosis.amend.parts import Part
from diagnosis.models.coil_network.kernel.layout import QUANTITIES, QUANTITY_FIELDS, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.places import channel_label


def sensor_entries(changes: Changes) -> list[dict[str, Any]]:
    """One entry for each channel and effect, with its law, parameters and units."""
    names = channel_names(changes.translation.layout)
    found: list[dict[str, Any]] = []
    for field, values in changes.sensors.items():
        unit = QUANTITY_FIELDS[field][1]
        for quantity, value in zip(QUANTITIES, np.broadcast_to(values, (len(QUANTITIES),)).tolist()):
            if value != 0.0:
                found.append({"quantity": quantity, "effect": field, "parameters": {field: f"{value:.10g} {unit}"}})
    for fitted in changes.of(Part.SENSOR):
        term = fitted.term
        for n, strength in enumerate(fitted.values[term.amplitude.name]):
            if strength != 0.0:
                numbers = {
                    p.name: f"{float(fitted.values[p.name][n]):.10g} {_unit(p.unit)}".strip() for p in term.parameters
                }
                found.append({"channel": names[n], "effect": term.identifier, "law": term.law, "parameters": numbers})
    return found


def _unit(unit: str) -> str:
    return "" if unit in ("1", "unit of the channel") else unit


def channel_names(layout: CoilNetworkLayout) -> list[str]:
    """Names of the network's channels in their order."""
    return [channel_label(layout, q, n) for q in QUANTITIES for n in range(layout.elements(q))]
