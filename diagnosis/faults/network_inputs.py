"""Inputs of a coil network that were another than stated within an interval: voltage of a source, power of a heater."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.candidates.candidate import Axis, CandidateTerm, Parameter
from diagnosis.faults.law import INPUT, UNSTATED, FaultLaw, added, gain, zero_stretches
from diagnosis.models.coil_network.kernel.inputs import CoilNetworkInputs
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.places import Place, coil_label
from diagnosis.search.problem import TermParameter

#: Coils up to which each heater is tried alone; of more, those that have one programme are tried together.
ALONE = 6
_WITHIN = "(share_after(begin, t_begin, t_end) - share_after(end, t_begin, t_end))"


def _candidate(fault: FaultLaw, identifier: str, strength: Parameter, hook: str, lines: str) -> CandidateTerm:
    instants = tuple(
        Parameter(n, "s", -1e9, 1e9, "within the recording", (0.0,), plausible=1e9, plausible_reason="any instant")
        for n in ("begin", "end")
    )
    return CandidateTerm(
        identifier=identifier,
        name=fault.name,
        unit="measurement",
        law=fault.law,
        source="definition: another input than was stated within an interval",
        parameters=(strength, *instants),
        places=("supply",),
        lines={hook: lines},
        signature="Everything that the input drives departs within an interval.",
    )


_GAIN = Parameter(
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


def _offset(unit: str) -> Parameter:
    """Its bounds are those of the input that it is tried at (`diagnosis.faults.law.added`)."""
    return Parameter(
        "offset",
        unit,
        -1e6,
        1e6,
        "as large as the input elsewhere",
        (0.02,),
        is_amplitude=True,
        plausible=1e6,
        plausible_reason="as large as the input elsewhere",
    )


#: They are compiled into every network and are in no catalogue: they are tried at the intervals that a scan finds.
#: The first of a pair acts where something is stated, the second where nothing is.
VOLTAGE = (
    _candidate(INPUT, "source_gain_in_interval", _GAIN, "source", f"V *= 1.0 + gain * {_WITHIN};"),
    _candidate(
        UNSTATED, "source_unstated_in_interval", _offset("V"), "source", f"if (V == 0.0) V = offset * {_WITHIN};"
    ),
)
POWER = (
    _candidate(INPUT, "power_gain_in_interval", _GAIN, "heat", f"heat += gain * P * {_WITHIN};"),
    _candidate(
        UNSTATED,
        "power_unstated_in_interval",
        _offset("W"),
        "heat",
        f"heat += P == 0.0 ? offset * {_WITHIN} : 0.0;",
    ),
)
CANDIDATES = (*VOLTAGE, *POWER)


@dataclass(frozen=True)
class Driven:
    """An input that may have been another.

    Args:
        fault: Its kind.
        candidate: What the network knows it as.
        place: Where it acts.
        strength: With bounds.
        stretches: In which the input is stated as zero, where the fault is one of these.
    """

    fault: FaultLaw
    candidate: CandidateTerm
    place: Place
    strength: TermParameter
    stretches: tuple[tuple[float, float], ...] = ()


def driven_places(layout: CoilNetworkLayout, inputs: CoilNetworkInputs) -> Iterator[Driven]:
    """Every input that is not 0 throughout, with the candidate that makes it another."""
    if inputs.voltage is not None:
        for n in np.flatnonzero(np.any(inputs.voltage != 0.0, axis=0)).tolist():
            label = "voltage of the supply" if layout.sources == 1 else f"voltage of supply[{n + 1}]"
            place = Place("supply", label, _mask(layout, "source", [n]))
            yield from _both(VOLTAGE, place, "V", inputs.time, inputs.voltage[:, n])
    elif inputs.power is not None:
        for members in _alike(inputs.power):
            name = coil_label(layout, members[0]) if len(members) == 1 else f"{len(members)} coils of one programme"
            place = Place("coil", f"power of {name}", _mask(layout, "coil", members))
            yield from _both(POWER, place, "W", inputs.time, inputs.power[:, members[0]])


def _both(
    pair: tuple[CandidateTerm, CandidateTerm], place: Place, unit: str, ends: Array, stated: Array
) -> Iterator[Driven]:
    """Both faults of an input; the second where it is stated as zero somewhere."""
    yield Driven(INPUT, pair[0], place, gain())
    stretches = zero_stretches(ends, stated == 0.0)
    if stretches:
        yield Driven(UNSTATED, pair[1], place, added(unit, float(np.abs(stated).max())), tuple(stretches))


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
