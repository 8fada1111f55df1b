"""Inputs of a coil network that were another than stated within an interval: voltage of a source, power of a heater."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.candidates.candidate import Axis, CandidateTerm, Parameter
from diagnosis.faults.law import INPUT
from diagnosis.models.coil_network.kernel.inputs import CoilNetworkInputs
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.places import Place, coil_label
from diagnosis.search.problem import TermParameter

#: Coils up to which each heater is tried alone; of more, those that have one programme are tried together.
ALONE = 6
#: Share by which an input is off that is no finding: laboratory supplies hold what is set on them to about 1 %.
ACCURACY = 0.01
_WITHIN = "(share_after(begin, t_begin, t_end) - share_after(end, t_begin, t_end))"


def gain() -> TermParameter:
    """Strength of a wrong input: off altogether at -1, twice as much at 1."""
    return TermParameter(
        "gain",
        "1",
        -1.0,
        1.0,
        (0.02,),
        negligible=ACCURACY,
        meaning="change of the input in the interval, as a share of what was stated",
    )


def _candidate(identifier: str, hook: str, lines: str) -> CandidateTerm:
    instants = tuple(
        Parameter(n, "s", -1e9, 1e9, "within the recording", (0.0,), plausible=1e9, plausible_reason="any instant")
        for n in ("begin", "end")
    )
    strength = Parameter(
        "gain",
        "1",
        -1.0,
        1.0,
        "off to twice as much",
        (0.02,),
        is_amplitude=True,
        plausible=1.0,
        plausible_reason="off altogether, or twice as much",
    )
    return CandidateTerm(
        identifier=identifier,
        name=INPUT.name,
        unit="measurement",
        law=INPUT.law,
        source="definition: the input times a factor within an interval",
        parameters=(strength, *instants),
        places=("supply",),
        lines={hook: lines},
        signature="Everything that the input drives departs within an interval.",
    )


#: They are compiled into every network and are in no catalogue: they are tried at the intervals that a scan finds.
VOLTAGE = _candidate("source_gain_in_interval", "source", f"V *= 1.0 + gain * {_WITHIN};")
POWER = _candidate("power_gain_in_interval", "heat", f"heat += gain * P * {_WITHIN};")
CANDIDATES = (VOLTAGE, POWER)


def driven_places(layout: CoilNetworkLayout, inputs: CoilNetworkInputs) -> Iterator[tuple[CandidateTerm, Place]]:
    """Every input that is not 0 throughout, with the candidate that makes it another."""
    if inputs.voltage is not None:
        for n in np.flatnonzero(np.any(inputs.voltage != 0.0, axis=0)).tolist():
            label = "voltage of the supply" if layout.sources == 1 else f"voltage of supply[{n + 1}]"
            yield VOLTAGE, Place("supply", label, _mask(layout, "source", [n]))
    elif inputs.power is not None:
        for members in _alike(inputs.power):
            name = coil_label(layout, members[0]) if len(members) == 1 else f"{len(members)} coils of one programme"
            yield POWER, Place("coil", f"power of {name}", _mask(layout, "coil", members))


def _mask(layout: CoilNetworkLayout, axis: Axis, members: list[int]) -> Array:
    mask = np.zeros(layout.size(axis))
    mask[members] = 1.0
    return mask


def _alike(power: Array) -> list[list[int]]:
    """Heaters that are driven, each alone, or in groups of one programme where they are many."""
    driven = np.flatnonzero(np.any(power != 0.0, axis=0)).tolist()
    if power.shape[1] <= ALONE:
        return [[n] for n in driven]
    groups: dict[bytes, list[int]] = {}
    for n in driven:
        groups.setdefault(np.ascontiguousarray(power[:, n]).tobytes(), []).append(n)
    return list(groups.values())
