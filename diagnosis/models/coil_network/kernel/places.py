"""Places at which a candidate can act in a given network, and its parameters as arrays over that place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from diagnosis.candidates.candidate import CandidateTerm, PlaceKind
from diagnosis.models.coil_network.kernel.layout import QUANTITIES, Array, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.source import reads_current

#: Typical size of each quantity's departures and the value that gain and clipping count from; fixed, not fitted.
SCALES: Mapping[str, tuple[float, float]] = {
    "temperature": (10.0, 295.15),
    "current": (0.1, 0.0),
    "supply_current": (0.5, 0.0),
    "extension": (1e-3, 0.0),
    "stiffness": (50.0, 0.0),
    "resistance": (0.1, 0.0),
    "power": (0.1, 0.0),
    "length": (1e-3, 0.0),
    "tension": (0.1, 0.0),
    "voltage": (0.1, 0.0),
    "string_voltage": (0.5, 0.0),
    "terminal_voltage": (0.5, 0.0),
    "supply_power": (1.0, 0.0),
}


#: Two coils always lie on a straight line: it says no more than that they differ.
FEWEST_OF_A_GRADIENT = 3
#: Places along a string, and strings, from which there is something between the ends.
FEWEST_BETWEEN = 3


@dataclass(frozen=True)
class Place:
    """Where a candidate acts.

    Args:
        kind: Kind of place.
        label: For people, counting from 1: `coil[2,5]` is the fifth coil of string 2.
        mask: Weight of the amplitude at every element of the candidate's axis.
        fixed: Values of the candidate's fixed parameters here.
        day: The day on which it acts alone; None: every one.
    """

    kind: PlaceKind
    label: str
    mask: Array
    fixed: Mapping[str, float | Array] = field(default_factory=dict)
    day: object = None

    @property
    def channels(self) -> tuple[int, ...] | None:
        """None: any channel may show it."""
        return None

    def values(self, term: CandidateTerm, numbers: Mapping[str, float]) -> dict[str, float | Array]:
        """Parameters of `term` here for `CoilNetworkParameters.terms`, from one number for each that is fitted."""
        arrays: dict[str, float | Array] = {
            p.name: np.full(self.mask.size, numbers[p.name]) for p in term.parameters if p.name in numbers
        }
        arrays[term.amplitude.name] = numbers[term.amplitude.name] * self.mask
        return {**self.fixed, **arrays}


def merge(
    term: CandidateTerm, first: Mapping[str, float | Array], second: Mapping[str, float | Array]
) -> dict[str, float | Array]:
    """One candidate at two places: amplitudes add, other parameters are those of the place whose amplitude is not 0."""
    own = np.asarray(second[term.amplitude.name])
    merged: dict[str, float | Array] = {
        name: np.where(own != 0.0, value, first.get(name, value)) for name, value in second.items()
    }
    merged[term.amplitude.name] = np.asarray(first[term.amplitude.name]) + own
    return merged


def places(term: CandidateTerm, layout: CoilNetworkLayout, measured: Sequence[str] = ()) -> list[Place]:
    """Every place at which `term` can act; none where it takes more elements than there are.

    Args:
        term: The candidate.
        layout: Coils and strings.
        measured: Quantities that are measured, for candidates of the measurement.
    """
    if layout.size(term.axis) < term.fewest:
        return []
    found: list[Place] = []
    for kind in term.places:
        found += _of_kind(kind, term, layout, measured)
    return found


def _of_kind(
    kind: PlaceKind, term: CandidateTerm, layout: CoilNetworkLayout, measured: Sequence[str]
) -> Iterator[Place]:
    size = layout.size(term.axis)
    if term.axis == "channel":
        # Heaters have no current; in a channel of strings or of the supply what follows the current is a gain.
        has_current = [q for q in measured if layout.strings and QUANTITIES[q].axis == "coil"]
        for quantity in has_current if reads_current(term) else measured:
            yield from _channels(kind, quantity, term, layout)
    elif kind in ("all", "powered"):
        if size and not (kind == "powered" and layout.strings):
            yield Place(kind, "all coils" if term.axis == "coil" else f"all {term.axis}s", np.ones(size))
    elif kind in ("row_gradient", "column_gradient"):
        yield from _gradient(kind, layout)
    elif kind in ("column", "string_ends", "outer_strings", "edge"):
        yield from _patterns(kind, layout)
    elif kind == "string" and term.axis == "coil":
        for s in range(len(layout.strings)):
            yield Place(kind, f"string[{s + 1}]", (layout.string_of_coil == s).astype(np.float64))
    else:
        names = {
            "coil": coil_label,
            "string": lambda _, n: f"string[{n + 1}]",
            "source": _source_label,
            "pair": contact_label,
        }[term.axis]
        for n in range(size):
            yield Place(kind, names(layout, n), _unit(size, n))


def _unit(size: int, at: int) -> Array:
    mask = np.zeros(size)
    mask[at] = 1.0
    return mask


def _gradient(kind: PlaceKind, layout: CoilNetworkLayout) -> Iterator[Place]:
    place = layout.string_of_coil if kind == "row_gradient" else layout.place_in_string
    if place.max() > 0 and len(place) >= FEWEST_OF_A_GRADIENT:
        mask = 2.0 * place / place.max() - 1.0
        yield Place(kind, f"gradient over {'rows' if kind == 'row_gradient' else 'columns'}", mask - mask.mean())


def _patterns(kind: PlaceKind, layout: CoilNetworkLayout) -> Iterator[Place]:
    """Coils that a rig treats alike: those at one place of every string, at the clamps, in the outer strings.

    Where a string has two coils, or a rig two strings, all of them are ends: nothing lies between.
    """
    string, place = layout.string_of_coil, layout.place_in_string
    last = np.array([place[string == s].max() for s in range(int(string.max()) + 1)])
    is_long, is_wide = int(last.min()) + 1 >= FEWEST_BETWEEN, len(last) >= FEWEST_BETWEEN
    is_end, is_outer = (place == 0) | (place == last[string]), (string == 0) | (string == len(last) - 1)
    if kind == "column" and len(last) > 1:
        for n in range(int(last.max()) + 1 if last.max() > 0 else 0):
            yield Place(kind, f"place {n + 1} of every string", (place == n).astype(np.float64))
    elif kind == "string_ends" and is_long:
        yield Place(kind, "ends of the strings", is_end.astype(np.float64))
    elif kind == "outer_strings" and is_wide:
        yield Place(kind, "outer strings", is_outer.astype(np.float64))
    elif kind == "edge" and is_long and is_wide:
        yield Place(kind, "edge of the network", (is_end | is_outer).astype(np.float64))


def coil_label(layout: CoilNetworkLayout, coil: int) -> str:
    """`coil[2,5]`: string and place in the string, from 1; `coil[5]` where there is no circuit."""
    if not layout.strings:
        return f"coil[{coil + 1}]"
    return f"coil[{layout.string_of_coil[coil] + 1},{layout.place_in_string[coil] + 1}]"


def contact_label(layout: CoilNetworkLayout, contact: int) -> str:
    """`coil[1,2] and coil[2,2]`: two coils that touch."""
    return " and ".join(coil_label(layout, coil) for coil in layout.contacts[contact])


def _source_label(layout: CoilNetworkLayout, source: int) -> str:
    return "supply" if layout.sources == 1 else f"supply[{source + 1}]"


def channel_label(layout: CoilNetworkLayout, quantity: str, element: int) -> str:
    """`coil[2,5].temperature`, `string[3].current` or `supply.current`."""
    axis = QUANTITIES[quantity].axis
    if axis == "supply" or (quantity == "terminal_voltage" and layout.sources == 1):
        return {"supply_power": "supply.power", "terminal_voltage": "supply.voltage"}.get(quantity, "supply.current")
    if quantity == "string_voltage":
        return f"string[{element + 1}].voltage"
    return f"{coil_label(layout, element) if axis == 'coil' else f'string[{element + 1}]'}.{quantity}"


def _channels(kind: PlaceKind, quantity: str, term: CandidateTerm, layout: CoilNetworkLayout) -> Iterator[Place]:
    first, count, size = layout.channel(quantity), layout.elements(quantity), layout.size("channel")
    scale, pivot = SCALES[quantity]
    given: dict[str, float | Array] = {"scale": scale, "pivot": pivot}
    fixed = {p.name: given[p.name] for p in term.parameters if p.is_fixed and p.name in given}
    if kind == "quantity" and count > 1:
        mask = np.zeros(size)
        mask[first : first + count] = 1.0
        yield Place(kind, f"every {quantity}", mask, fixed)
    elif kind == "channel":
        for n in range(count):
            yield Place(kind, channel_label(layout, quantity, n), _unit(size, first + n), fixed)
    elif kind == "swap":
        for a, b in combinations(range(count), 2):
            mask, partner = np.zeros(size), np.zeros(size)
            mask[[first + a, first + b]] = 1.0
            partner[[first + a, first + b]] = b, a
            label = f"{channel_label(layout, quantity, a)} and {channel_label(layout, quantity, b)}"
            yield Place(kind, label, mask, {**fixed, "other": partner})
