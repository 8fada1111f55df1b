"""What a camera reads of places: turned, of another scale, with another origin, or of a marker that sits elsewhere.

All of these change readings and no motion, so none needs a simulation. They are linear: what is seen is A p + b of the
places p of all markers and links.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy import sparse

from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.protocol import Labelled
from diagnosis.recording.quantity import Target
from diagnosis.search.problem import Term, TermParameter

#: Kinds of channels that are places, and axes of them.
PLACES, AXES = ("marker", "link"), ("x", "y", "z")
#: Axis about which a camera is turned to the axes that mix, in the order of a right-handed turn.
_TURNS = {"x": ("y", "z"), "y": ("z", "x"), "z": ("x", "y")}
#: Bounds; sizes beyond half of them a user sees when the camera is set up.
MOST_TURN, MOST_SCALE, MOST_SHIFT = 0.35, 0.3, 0.05


@dataclass(frozen=True)
class CameraLaw:
    """See `diagnosis.models.protocol.Effect`.

    Args:
        name: In plain words.
        law: Formula.
        confused_with: Identifiers that data often cannot tell from it, with what decides.
    """

    name: str
    law: str
    confused_with: Mapping[str, str] = field(default_factory=dict)

    @property
    def is_of_a_day(self) -> bool:
        """Never: the camera stands as it does in every recording."""
        return False

    @property
    def is_of_either(self) -> bool:
        """Never: what moves is compared by itself."""
        return False


_BEGIN = "the first pictures decide, in which nothing has moved yet"
_STILL = "a marker that is held and seen decides: it must not move"
_LAWS = {
    "turned_camera": CameraLaw(
        "a camera that is turned", "turned by angle about an axis of the fabric", {"tilt": _BEGIN, "roll": _BEGIN}
    ),
    "camera_scale": CameraLaw(
        "a camera of another scale", "seen = (1 + scale) * place", {"payload": _BEGIN, "base:link_mass": _BEGIN}
    ),
    "camera_origin": CameraLaw(
        "an origin that is elsewhere", "seen = place + offset", {"payload": _STILL, "supply_wire_stiffness": _STILL}
    ),
    "marker_elsewhere": CameraLaw(
        "a marker that sits elsewhere", "seen = place + offset", {"weak_steel": "other markers of the row decide"}
    ),
}

#: Identifiers of what a camera may do.
CAMERA_LAWS = frozenset(_LAWS)


def _number(name: str, unit: str, most: float, first: float, why: str, meaning: str) -> TermParameter:
    return TermParameter(
        name, unit, -most, most, (first, -first), plausible=most / 2, plausible_reason=why, meaning=meaning
    )


_ANGLE = _number("angle", "rad", MOST_TURN, 0.03, "10 degrees are seen at set-up", "angle of the turn")
_SCALE = _number("scale", "1", MOST_SCALE, 0.02, "15 per cent are seen at set-up", "relative error of the scale")
_ORIGIN = _number("offset", "m", MOST_SHIFT, 2e-3, "25 mm are seen at set-up", "offset of the origin")
_MARKER = _number("offset", "m", MOST_SHIFT, 1e-3, "25 mm are nearly a link", "offset of the marker")


class Camera:
    """What is seen of simulated values that stand in one row.

    Args:
        targets: What each channel measures.
        channel: Number of the channel of every value, shape (values,).
        time: Its time [s], shape (values,).
        recording: Number of the recording of every channel.
    """

    def __init__(self, targets: Sequence[Target], channel: AnyArray, time: Array, recording: Sequence[int]) -> None:
        self._count = len(channel)
        own = {n: np.flatnonzero(channel == n) for n in range(len(targets))}
        self._values = {n: places for n, places in own.items() if places.size}
        self._time = time
        axis: dict[int, str] = {}
        #: Recording, kind and element of a point to its channels by axis.
        points: dict[tuple[int, str, tuple[int, ...]], dict[str, int]] = {}
        for n, target in enumerate(targets):
            if target.kind in PLACES and target.quantity in AXES and n in self._values:
                axis[n] = target.quantity
                point = (recording[n], target.kind, tuple(target.element))
                points.setdefault(point, {})[target.quantity] = n
        self._axis, self._points = axis, points
        self._markers: dict[str, list[int]] = {}
        for n, target in enumerate(targets):
            if n in axis and target.kind == "marker":
                self._markers.setdefault(f"marker[{target.element[0]}].{target.quantity}", []).append(n)
        self._matrices: dict[str, sparse.csr_array] = {}
        self._lengths = self._measures(targets, ("length",))
        self._curvatures = self._measures(targets, ("max_curvature",))
        #: Every law of the camera and of its markers that these channels can show, with where it acts.
        self.terms: Mapping[Term, tuple[CameraLaw, Labelled]] = self._terms()

    def _measures(self, targets: Sequence[Target], quantities: Sequence[str]) -> AnyArray:
        """Values that are computed from places: they scale with them."""
        kinds = (*PLACES, "fabric")
        named = [n for n, t in enumerate(targets) if t.kind in kinds and t.quantity in quantities and n in self._values]
        return np.concatenate([self._values[n] for n in named]) if named else np.zeros(0, dtype=int)

    def _terms(self) -> dict[Term, tuple[CameraLaw, Labelled]]:
        """A turn needs both axes that it mixes of every point, an origin and a marker's place two markers or more."""
        found: dict[Term, tuple[CameraLaw, Labelled]] = {}

        def add(identifier: str, place: str, parameter: TermParameter) -> None:
            law = _LAWS[identifier]
            term = Term(identifier, place, "measurement", (parameter,), law=law.law)
            found[term] = law, Labelled(place)

        if not self._points:
            return found
        for about, pair in _TURNS.items():
            if all(set(pair) <= set(own) for own in self._points.values()):
                add("turned_camera", f"camera, about {about}", _ANGLE)
        add("camera_scale", "camera", _SCALE)
        for axis in sorted(set(self._axis.values())):
            if len({n for n, own in self._axis.items() if own == axis}) > 1:
                add("camera_origin", f"camera, along {axis}", _ORIGIN)
        if len(self._markers) > 1:
            for name in self._markers:
                add("marker_elsewhere", name, _MARKER)
        return found

    def seen(self, values: Array, terms: Mapping[Term, tuple[float, ...]]) -> Array:
        """Values as the camera reads them, shape as given; markers first, then turn, scale and origin.

        Args:
            values: Simulated, shape (values,).
            terms: Terms that are present; those of other units count nothing.
        """
        found = np.array(values, dtype=np.float64)
        own = [(t, v[0]) for t, v in terms.items() if t.identifier in _LAWS]
        for identifier, read in (
            ("marker_elsewhere", self._with_marker_elsewhere),
            ("turned_camera", self._turned),
            ("camera_scale", self._scaled),
            ("camera_origin", self._shifted),
        ):
            for term, size in own:
                if term.identifier == identifier:
                    found = read(found, term.place, size)
        return found

    def _with_marker_elsewhere(self, values: Array, place: str, offset: float) -> Array:
        for n in self._markers.get(place, ()):
            values[self._values[n]] += offset
        return values

    def _scaled(self, values: Array, place: str, scale: float) -> Array:
        del place  # there is one camera
        for places in (*(self._values[n] for n in self._axis), self._lengths):
            values[places] *= 1.0 + scale
        values[self._curvatures] /= 1.0 + scale
        return values

    def _shifted(self, values: Array, place: str, offset: float) -> Array:
        for n, axis in self._axis.items():
            if axis == place.rpartition(" ")[2]:
                values[self._values[n]] += offset
        return values

    def _turned(self, values: Array, place: str, angle: float) -> Array:
        about = place.rpartition(" ")[2]
        first, second = _TURNS[about]
        if about not in self._matrices:  # a search turns many times
            self._matrices[about] = self._mixing(first, second)
        matrix = self._matrices[about]
        is_turned = np.isin(np.arange(self._count), self._of_axes(first, second))
        turned = math.cos(angle) * values + math.sin(angle) * np.asarray(matrix @ values)
        return np.where(is_turned, turned, values)

    def _of_axes(self, first: str, second: str) -> AnyArray:
        return np.concatenate([self._values[n] for n, axis in self._axis.items() if axis in (first, second)])

    def _mixing(self, first: str, second: str) -> sparse.csr_array:
        """What a turn adds by its sine: first' = -second, second' = first, each at the other's instants."""
        rows, columns, entries = [], [], []
        for own in self._points.values():
            if first not in own or second not in own:
                continue
            for axis, other, sign in ((first, second, -1.0), (second, first, 1.0)):
                here, there = self._values[own[axis]], self._values[own[other]]
                r, c, e = _interpolation(self._time[here], self._time[there])
                rows.append(here[r])
                columns.append(there[c])
                entries.append(sign * e)
        shape = (self._count, self._count)
        if not rows:
            return sparse.csr_array(shape)
        joined = np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))
        return sparse.csr_array(joined, shape=shape)


def _interpolation(times: Array, known: Array) -> tuple[AnyArray, AnyArray, Array]:
    """Rows, columns and entries of the matrix that interpolates values at known times; beyond them the end values hold.

    >>> [a.tolist() for a in _interpolation(np.array([0.5]), np.array([0.0, 1.0]))]
    [[0, 0], [0, 1], [0.5, 0.5]]
    """
    count = len(times)
    right = np.clip(np.searchsorted(known, times), 1, max(len(known) - 1, 1))
    left = right - 1
    if len(known) == 1:
        return np.arange(count), np.zeros(count, dtype=int), np.ones(count)
    share = np.clip((times - known[left]) / (known[right] - known[left]), 0.0, 1.0)
    rows = np.repeat(np.arange(count), 2)
    return rows, np.stack([left, right], axis=1).ravel(), np.stack([1.0 - share, share], axis=1).ravel()
