"""Which spot is which marker of a fabric: the best chain of links over all rows of one picture.

Every pair of spots whose distance a link can have is a candidate for every row, and so is a spot alone, whose partner
is hidden. Neighbouring rows must be a row pitch apart and lean as a weave does. Dynamic programming finds the chain of
least cost, and the least cost of any other chain: where the two are close, the picture is not resolved.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import AnyArray, Array

#: Cost of a hidden marker: six deviations squared are a third of it.
HIDDEN = 12.0
#: The next chain must cost so much more: a likelihood ratio of exp(3) in its favour.
CLEAR = 6.0
#: Most cost of a marker that is not where it is expected: more than that of being hidden.
_MOST_OFF = 30.0
_NEVER = np.inf
#: A step between links seen in half leads at most so far away from the fabric's direction at its tether [rad].
_BACK = np.radians(110.0)
#: The first link's angle may differ so much from that of a flat weave [rad].
_FIRST = np.radians(75.0)


@dataclass(frozen=True)
class Weave:
    """What is known of a fabric's chain of links.

    Args:
        rows: Number of rows.
        length: Least and largest distance of the two markers of a link [m].
        pitch: Least and largest distance of neighbouring rows' centres [m].
        lean: Least and largest angle of a link above the line between rows [rad].
        along: Direction of the fabric at its tether [rad].
    """

    rows: int
    length: tuple[float, float]
    pitch: tuple[float, float]
    lean: tuple[float, float]
    along: float


@dataclass(frozen=True)
class Expected:
    """Where markers are expected from other pictures of the same video.

    Args:
        places: Shape (markers, 2) [m]; not a number where nothing is known.
        deviation: Of a coordinate, shape (markers,) [m].
    """

    places: Array
    deviation: Array


@dataclass(frozen=True)
class Chain:
    """Spots of the markers of a fabric.

    Args:
        spots: Number of the spot of each marker, back and front of row 1, then of row 2; -1 where it is hidden;
            shape (2 rows,).
        margin: By how much the next chain costs more.
    """

    spots: AnyArray
    margin: float

    @property
    def is_resolved(self) -> bool:
        """Whether no other chain comes close."""
        return self.margin >= CLEAR


def identify(places: Array, weave: Weave, expected: Expected | None = None) -> Chain | None:
    """The chain through the spots of one picture.

    Args:
        places: (y, z) of the spots, shape (spots, 2) [m].
        weave: What is known of the fabric.
        expected: Where its markers are expected, for a picture that is not resolved by itself.

    Returns:
        None where no chain fits.
    """
    states = _States(places, weave)
    if not len(states.back):
        return None
    edges = [states.edges(k) for k in (1, 2, 3)]
    own = states.own[None, :] + (0.0 if expected is None else states.off(expected))
    return _shortest(states, edges, own, weave.rows)


class _States:
    """All pairs of spots that may be a link, and all spots alone."""

    def __init__(self, places: Array, weave: Weave) -> None:
        self.places, self.weave = places, weave
        step = places[None, :] - places[:, None]
        distance = np.hypot(step[..., 0], step[..., 1])
        back, front = np.nonzero((distance >= weave.length[0]) & (distance <= weave.length[1]))
        alone, none = np.arange(len(places)), np.full(len(places), -1)
        self.back = np.concatenate([back, alone, none])
        self.front = np.concatenate([front, none, alone])
        pairs = len(back)
        angle = np.arctan2(step[back, front, 1], step[back, front, 0])
        self.angle = np.concatenate([angle, np.full(2 * len(places), np.nan)])
        middle, half = (weave.length[0] + weave.length[1]) / 2.0, (weave.length[1] - weave.length[0]) / 2.0
        cost = 0.5 * ((distance[back, front] - middle) / half) ** 2
        self.own = np.concatenate([cost, np.full(2 * len(places), HIDDEN)])
        self.is_pair = np.arange(len(self.back)) < pairs

    def off(self, expected: Expected) -> Array:
        """Cost of the states in each row, of not being where markers are expected, shape (rows, states)."""
        found = np.zeros((self.weave.rows, len(self.back)))
        for which, spot in ((0, self.back), (1, self.front)):
            there = np.where(spot[:, None] >= 0, self.places[spot], np.nan)
            apart = np.linalg.norm(there[None] - expected.places[which::2][:, None], axis=2)
            cost = 0.5 * (apart / expected.deviation[which::2][:, None]) ** 2
            found += np.nan_to_num(np.minimum(cost, _MOST_OFF), nan=0.0)
        return found

    def edges(self, skipped: int) -> Array:
        """Cost of going from one state to another `skipped` rows on, shape (states, states)."""
        step, apart = self._steps()
        distance = np.hypot(step[..., 0], step[..., 1])
        least, most = self.weave.pitch
        # Markers of one end are bent away from and towards each other by what the links turn.
        loose = np.where(self.is_pair[:, None] & self.is_pair[None, :], 0.0, 0.15)
        reach = (skipped * least * (0.7 if skipped > 1 else 1.0) * (1.0 - loose), skipped * most * (1.0 + loose))
        fits = apart & (distance >= reach[0]) & (distance <= reach[1])
        crossed = self._crossed(skipped)
        middle, half = skipped * (least + most) / 2.0, skipped * (most - least) / 2.0
        cost = 0.5 * ((distance - middle) / half) ** 2 + 2.0 * HIDDEN * (skipped - 1)
        direction = np.arctan2(step[..., 1], step[..., 0])
        fits &= self._goes_on(direction)
        for angle in (self.angle[:, None], self.angle[None, :]):
            within, off = self._lean(angle - direction, loose)
            fits &= within
            cost = cost + off
        return np.where(fits, cost, np.where(crossed, 1.0 + 2.0 * HIDDEN * (skipped - 1), _NEVER))

    def _crossed(self, skipped: int) -> AnyArray:
        """Whether a back marker alone and a front marker alone, or the reverse, can be ends of neighbouring links.

        Their distance is that of a row pitch and a link at the angle of its lean: the law of cosines, at its bounds.
        """
        found = np.zeros((len(self.back), len(self.back)), dtype=bool)
        if skipped > 1:
            return found
        (p0, p1), (l0, l1), (a0, a1) = self.weave.pitch, self.weave.length, self.weave.lean
        squares = [
            [p * p + k * k + sign * 2.0 * p * k * np.cos(a) for p in (p0, p1) for k in (l0, l1) for a in (a0, a1)]
            for sign in (1.0, -1.0)
        ]
        for ends, (first, second) in zip(squares, ((self.back, self.front), (self.front, self.back))):
            one = (first >= 0) & ~self.is_pair
            other = (second >= 0) & ~self.is_pair
            apart = np.linalg.norm(self.places[second][None, :] - self.places[first][:, None], axis=2)
            near = (apart >= 0.7 * np.sqrt(min(ends))) & (apart <= np.sqrt(max(ends)))
            found |= one[:, None] & other[None, :] & near
        return found

    def _lean(self, lean: Array, loose: Array) -> tuple[AnyArray, Array]:
        """Whether links lean as a weave does, and the cost; a link that is seen in half leans in any way."""
        least, most = self.weave.lean
        middle, half = (least + most) / 2.0, (most - least) / 2.0
        off = np.abs((lean - middle + np.pi) % (2.0 * np.pi) - np.pi)
        known = np.isfinite(off)
        return ~known | (off <= half * (1.0 + loose)), np.where(known, 0.5 * (off / half) ** 2, 0.0)

    def _goes_on(self, direction: Array) -> AnyArray:
        """Whether a step between two links that are both seen in half does not lead back towards the tether."""
        off = np.abs((direction - self.weave.along + np.pi) % (2.0 * np.pi) - np.pi)
        return np.asarray(self.is_pair[:, None] | self.is_pair[None, :] | (off <= _BACK))

    def _steps(self) -> tuple[Array, AnyArray]:
        """Vector from each state to each other, between centres or markers of one end; whether they share no spot."""
        b, f = self.back, self.front
        at_back, at_front = self.places[b], self.places[f]
        has_back, has_front = (b >= 0)[:, None] & (b >= 0)[None, :], (f >= 0)[:, None] & (f >= 0)[None, :]
        by_back = at_back[None, :] - at_back[:, None]
        by_front = at_front[None, :] - at_front[:, None]
        both = (has_back & has_front)[..., None]
        step = np.where(both, (by_back + by_front) / 2.0, np.where(has_back[..., None], by_back, by_front))
        # Two halves of different ends say nothing of each other.
        differ = has_back | has_front
        for one in (b, f):
            for other in (b, f):
                differ = differ & ((one[:, None] != other[None, :]) | (one < 0)[:, None])
        return step, differ


def _shortest(states: _States, edges: list[Array], own: Array, rows: int) -> Chain | None:
    """The chain of least cost, and by how much the next one costs more (min-marginals, forward and backward)."""
    count = len(states.back)
    own = np.broadcast_to(own, (rows, count))
    start = own[0:1] * 0.0 + _start(states)
    ahead = np.full((rows, count), _NEVER)
    came = np.full((rows, count, 2), -1)
    for row in range(rows):
        # A chain that begins late has all rows before hidden.
        ahead[row] = start[0] + 2.0 * HIDDEN * row
        for k, edge in enumerate(edges[:row], 1):
            costs = ahead[row - k][:, None] + edge
            best = np.argmin(costs, axis=0)
            value = costs[best, np.arange(count)]
            better = value < ahead[row]
            ahead[row] = np.where(better, value, ahead[row])
            came[row][better] = np.stack([np.full(count, row - k), best], axis=1)[better]
        ahead[row] += own[row]
    behind = np.full((rows, count), _NEVER)
    for row in range(rows - 1, -1, -1):
        behind[row] = 2.0 * HIDDEN * (rows - 1 - row)
        for k, edge in enumerate(edges[: rows - 1 - row], 1):
            behind[row] = np.minimum(behind[row], np.min(edge + (own[row + k] + behind[row + k])[None, :], axis=1))
    whole = ahead + behind
    if not np.isfinite(whole.min()):
        return None
    chain = _read(states, came, whole, rows)
    used = chain.spots[chain.spots >= 0]
    # Beyond a hidden row nothing keeps a chain from taking a spot twice: then it is none.
    return chain if len(np.unique(used)) == len(used) else None


def _start(states: _States) -> Array:
    """A first link points as a fabric does at its tether, within `_FIRST`; one that is seen in half anywhere."""
    weave = states.weave
    off = states.angle - weave.along - sum(weave.lean) / 2.0
    off = np.abs((off + np.pi) % (2.0 * np.pi) - np.pi)
    return np.where(np.isfinite(off) & (off > _FIRST), _NEVER, 0.0)


def _read(states: _States, came: AnyArray, whole: Array, rows: int) -> Chain:
    """Follow the best chain through its last row, and find the closest other one."""
    best = float(whole.min())
    taken = np.full(rows, -1)
    last = max(r for r in range(rows) if whole[r].min() <= best + 1e-9)
    at, state = last, int(np.argmin(whole[last]))
    while at >= 0:
        taken[at] = state
        at, state = (int(v) for v in came[at, state])
    spots = np.full(2 * rows, -1)
    margin = _NEVER
    for r in range(rows):
        if taken[r] >= 0:
            spots[2 * r], spots[2 * r + 1] = states.back[taken[r]], states.front[taken[r]]
        others = np.delete(whole[r], taken[r]) if taken[r] >= 0 else whole[r]
        margin = min(margin, float(others.min(initial=_NEVER)) - best)
    return Chain(spots, margin)
