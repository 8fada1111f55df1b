"""Places of a fabric's markers and links: size, axes and numbering, by where they are and not by how they move.

Contacts decide how far a marker moves, and neighbours move alike. Where the markers lie beside each other is known far
better: links hardly stretch.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from cosim.unit.protocol import Array
from cosim.unit.quantity import conversion
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.explain import MOST_LEFT
from diagnosis.check.scale import UNITS
from diagnosis.check.swapped import EXCHANGED, cycles
from diagnosis.check.timing import critical
from diagnosis.judge.diagnosis import Doubt

#: Factor by which distances between markers may differ from simulated ones: a fabric that lies flat is seen whole where
#: one that drapes is foreshortened, and links have play.
STRETCH = 1.5
#: Factor within which another unit is named as the one that was meant.
MEANT = 1.25
#: Distances and spreads count that are so many times what contacts, noise and the model leave open.
CLEAR = 5.0
#: Correlation of measured with simulated places along an axis below which the axis is turned round.
TURNED = -0.9


def place_doubts(compared: Compared) -> list[Doubt]:
    """Doubts about axes and numbers of a fabric's markers and links; about their size see `size_doubts`."""
    axes = _axes(compared)
    turned = [d for (kind, axis), members in axes.items() for d in _turned(compared, kind, axis, members)]
    exchanged = [] if turned else _exchanged_axes(compared, axes)
    if turned or exchanged:  # either moves every marker to the place of others
        return [*turned, *exchanged]
    return [d for members in axes.values() for d in _exchanged(compared, members)]


def size_doubts(compared: Compared) -> list[Doubt]:
    """At most one doubt for each kind: distances between its members are no such fabric's."""
    found, axes = [], _axes(compared)
    for kind in ("marker", "link"):
        members = [b for (own, _), every in axes.items() if own == kind for b in every]
        found += _size(compared, kind, members)
    return found


def _axes(compared: Compared) -> dict[tuple[str, str], list[Beside]]:
    """Channels that give places of a fabric, by kind (marker, link) and axis."""
    found: dict[tuple[str, str], list[Beside]] = defaultdict(list)
    for b in compared.channels.values():
        if b.is_place and b.simulated is not None and len(b.pick):
            found[b.channel.target.kind, b.channel.target.quantity].append(b)
    return found


def _places(members: Sequence[Beside]) -> tuple[Array, Array]:
    """Measured and simulated places, medians over the readings, both of shape (members,)."""
    return np.array([np.median(b.measured) for b in members]), np.array([np.median(b.simulated_there) for b in members])


def _open(members: Sequence[Beside]) -> float:
    """What contacts and lines between outputs leave open of a simulated place [m]; noise may be in a wrong unit."""
    return max(float(np.hypot(b.scatter, 0.1 * np.std(b.simulated_there))) for b in members)


def _size(compared: Compared, kind: str, members: Sequence[Beside]) -> list[Doubt]:
    by_element: dict[tuple[int, ...], dict[str, Beside]] = defaultdict(dict)
    for b in members:
        by_element[tuple(b.channel.target.element)][b.channel.target.quantity] = b
    axes = sorted({b.channel.target.quantity for b in members})
    whole = [own for own in by_element.values() if len(own) == len(axes)]
    if len(whole) < 2:
        return []
    measured, simulated = (_table(whole, axes, side) for side in (0, 1))
    first, second = np.triu_indices(len(whole), 1)
    theirs, ours = (np.linalg.norm(p[first] - p[second], axis=1) for p in (measured, simulated))
    clear = ours > CLEAR * _open(members)
    if not clear.any():
        return []
    ratio = float(np.median(theirs[clear] / ours[clear]))
    if 1.0 / STRETCH < ratio < STRETCH:
        return []
    stated = _stated(compared, members[0])
    text = f"distances between {kind}s are {ratio:.3g} times as simulated, and links hardly stretch"
    factor = 1.0 / conversion(stated, "m")[0]
    others = {u: ratio * factor * conversion(u, "m")[0] for u in UNITS["m"] if u != stated}
    fitting = [u for u, left in others.items() if abs(np.log(left)) < np.log(MEANT)]
    if fitting:
        text += f"; as `unit: {fitting[0]}` they are of its size"
        remedy = f"correct `unit` of the channels of {kind}s"
    else:
        remedy = "were they measured in pixels, or with the scale of another camera? Convert them, or correct `unit`"
    names = f"{kind}s along {', '.join(axes)}"
    z = float(abs(np.log(ratio)) / np.log(STRETCH) * CLEAR)
    return [Doubt(compared.recording.title, names, "unit", text, remedy, True, compared.begin, compared.end, z)]


def _table(whole: Sequence[dict[str, Beside]], axes: Sequence[str], side: int) -> Array:
    """Measured (0) or simulated (1) places, shape (elements, axes)."""
    return np.stack([_places([own[a] for own in whole])[side] for a in axes], axis=-1)


def _stated(compared: Compared, beside: Beside) -> str:
    written = dict(zip(compared.recording.channels, compared.recording.units)).get(beside.channel.name)
    return written or beside.channel.unit


def _turned(compared: Compared, kind: str, axis: str, members: Sequence[Beside]) -> list[Doubt]:
    """Places along an axis that fall where the simulated ones rise."""
    if len(members) < 3:
        return []
    measured, simulated = _places(members)
    if np.std(simulated) < CLEAR * _open(members) or not np.std(measured) > 0.0:
        return []
    correlation = float(np.corrcoef(measured, simulated)[0, 1])
    if correlation > TURNED:
        return []
    text = (
        f"the {axis} of {len(members)} {kind}s falls from one to the next where the simulated one rises (correlation "
        f"{correlation:.3f})"
    )
    remedy = f"is this axis of the camera or of the table turned round, or are the {kind}s numbered from the other end?"
    z = CLEAR * float(np.sqrt(len(members)))
    names = f"{kind}s along {axis}"
    return [Doubt(compared.recording.title, names, "sign", text, remedy, True, compared.begin, compared.end, z)]


def _off(beside: Beside, course: Beside, offset: float) -> float:
    """Mean square of what is left where a channel is read as another one is simulated, with what is left open."""
    left = beside.measured - offset - course.at(beside.times)
    return float(np.mean(left**2)) + beside.tolerance**2


def _exchanged_axes(compared: Compared, axes: dict[tuple[str, str], list[Beside]]) -> list[Doubt]:
    """Two axes of all markers whose columns are exchanged."""
    found = []
    for kind, first in axes:
        for other, second in axes:
            if other != kind or not first < second:
                continue
            named = [{tuple(b.channel.target.element): b for b in axes[kind, axis]} for axis in (first, second)]
            both = sorted(named[0].keys() & named[1].keys())
            pairs = [(named[0][e], named[1][e]) for e in both]
            if len(pairs) < 2:
                continue
            # both axes must gain: an origin that is elsewhere makes one nearer by chance
            own = [sum(_off(p[k], p[k], 0.0) for p in pairs) for k in (0, 1)]
            turned = [sum(_off(p[k], p[1 - k], 0.0) for p in pairs) for k in (0, 1)]
            if not all(t < MOST_LEFT**2 * o for t, o in zip(turned, own)):
                continue
            z = float(np.sqrt(min(o / t for o, t in zip(own, turned)) * len(pairs)))
            text = f"the {first} of {kind}s reads like their simulated {second}, and their {second} like their {first}"
            remedy = "exchange `column` of these channels"
            title = compared.recording.title
            names = f"{kind}s along {first}, {second}"
            found.append(Doubt(title, names, "swapped", text, remedy, True, compared.begin, compared.end, z))
    return found


def _exchanged(compared: Compared, members: Sequence[Beside]) -> list[Doubt]:
    """Members whose places along an axis are those of others: each must be nearer there, all along a cycle."""
    count = len(members)
    if count < 2:
        return []
    measured, simulated = _places(members)
    offset = float(np.median(measured - simulated))  # the origin of the camera
    squares = np.array([[_off(b, course, offset) for course in members] for b in members])
    tolerance = np.array([b.tolerance**2 for b in members])
    own = np.diag(squares)[:, None]
    is_nearer = squares < MOST_LEFT**2 * own
    gains = np.where(is_nearer, (own - squares) / tolerance[:, None], -1e-9)
    np.fill_diagonal(gains, 0.0)
    rows, columns = linear_sum_assignment(gains, maximize=True)
    found = []
    for cycle in cycles(rows, columns):
        least = min(float(gains[i, columns[i]]) for i in cycle)
        if least <= critical(float(count * (count - 1))):
            continue
        takes = ", ".join(f"`{members[i].channel.name}` reads like `{members[columns[i]].channel.name}`" for i in cycle)
        apart = compared.units.text(float(np.max(np.abs(measured - offset - simulated)[list(cycle)])), "m")
        text = f"{takes}: each is where the other is simulated, up to {apart} from its own place"
        remedy = (
            "are these markers numbered as on the rig? Correct `column` of these channels, or the numbers in the rig"
        )
        names = ", ".join(members[i].channel.name for i in cycle)
        same = (EXCHANGED,) if len(cycle) == 2 else ()
        title, z = compared.recording.title, float(np.sqrt(least))
        found.append(Doubt(title, names, "swapped", text, remedy, True, compared.begin, compared.end, z, same_as=same))
    return found
