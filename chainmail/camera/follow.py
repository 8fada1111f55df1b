"""From spots to tracks: every picture by itself, then those that are not resolved with their neighbours in time."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from chainmail.camera.identify import CLEAR, Chain, Expected, Weave, identify
from chainmail.camera.spots import Places
from chainmail.camera.tracks import GAP, PART, SEEN, Tracks
from cosim.unit.protocol import AnyArray, Array

#: Another assignment of points costs so much of a reach more.
_CLEARLY = 0.5
#: From this share of its reach on a marker may go beyond it.
_NEAR_END = 0.9
#: A marker that leaves its reach is sought up to so many times as far.
_BEYOND = 2.0
#: Deviation of an expected place [m], at once and by what it may move in a second [m/s].
_AT_ONCE, _PER_SECOND = 2e-3, 0.04
#: No place is expected over a longer time [s].
_LONGEST = 0.5
#: A place that is off the course through its neighbours by so many deviations, and so much [m], is no marker.
_OFF, _LEAST_OFF = 8.0, 4e-3
#: Missing share of a marker that its own scatter does not explain: so many deviations, and at least so much.
_MISSING, _LEAST_MISSING = 4.0, 0.012

#: A marker has moved where two readings differ by so many deviations.
_MOVED = 4.0
#: Markers move on by so many deviations of a step, and stop by less than this share of it, for so many pictures at
#: most; cosine of the angle between what they do before and after.
_GOING, _STOPPED, _HELD_FOR, _AHEAD = 2.0, 0.15, 4, 0.7

Assign = Callable[[Places, Expected | None], Chain | None]


def fabric_assigner(weave: Weave) -> Assign:
    """Assignment of spots by the chain of links of a fabric."""
    return lambda spots, expected: identify(spots.places, weave, expected)


def follow_points(
    times: Array, pictures: Sequence[Places], points: Array, reach: float
) -> tuple[Tracks, tuple[str, ...]]:
    """Tracks of markers that stay near known places, and what is to be said of their reach.

    Where reaches overlap, all markers of a picture together tell which is which, if none goes farther than its reach.
    Whether that holds, the travel shows: what comes near the end of its reach may leave it too.

    Args:
        times: Shape (frames,) [s].
        pictures: Spots of each frame.
        points: Places of the markers, shape (markers, 2) [m].
        reach: How far each may be from its place [m].
    """
    found = follow(times, pictures, len(points), point_assigner(points, reach, is_reach_sure=True))
    away = np.linalg.norm(found.places - points, axis=2)
    farthest = np.nanmax(np.where(np.isfinite(away), away, 0.0), axis=0)
    last = int(np.argmax(farthest))
    if not farthest[last] > _NEAR_END * reach:
        return found, ()
    said = (
        f"reach: marker {last + 1} is up to {1e3 * farthest[last]:.3g} mm from its place, of {1e3 * reach:.3g} mm that "
        "it may be, and may go farther; {}: state a larger `reach`, beyond which none goes"
    )
    careful = follow(times, pictures, len(points), point_assigner(points, reach, is_reach_sure=False))
    if np.any(_overlapping(points, reach)):
        return careful, (said.format("since reaches overlap, those markers are left open"),)
    return careful, (said.format("where a spot beyond its reach may be it, it is a gap"),)


def point_assigner(points: Array, reach: float, is_reach_sure: bool) -> Assign:
    """Assignment of spots to markers that stay near known places, all at once.

    Args:
        points: Their places, shape (markers, 2) [m].
        reach: How far each may be from its place [m].
        is_reach_sure: Whether none goes farther, so that all together tell which is which.
    """

    is_near = _overlapping(points, reach)

    def assign(spots: Places, expected: Expected | None) -> Chain | None:
        if not len(spots):
            return None
        far = np.linalg.norm(points[:, None] - spots.places[None], axis=2)
        cost = np.where(far <= reach, far + reach * np.maximum(0.0, 1.0 - spots.share), 4.0 * reach)
        rows, columns = linear_sum_assignment(cost)
        chosen = np.full(len(points), -1)
        fits = far[rows, columns] <= reach
        chosen[rows[fits]] = columns[fits]
        # A spot that no marker takes beside a marker that has none: that one may be farther than its reach, and others
        # whose reaches overlap the neighbours of what they seem to be.
        left = (spots.share > 0.5) & ~np.isin(np.arange(len(spots)), chosen)
        if not is_reach_sure or (np.any(left) and np.any(chosen < 0)):
            chosen[is_near] = -1
        if not is_reach_sure:
            # A spot beyond the reach may be the marker, and the one within reach something else.
            chosen[np.any(far[:, left] <= _BEYOND * reach, axis=1)] = -1
        # Several spots within one marker's reach leave it open which it is, unless every marker has one and any other
        # choice costs clearly more.
        several = np.flatnonzero(np.sum((far <= reach) & (spots.share > 0.5), axis=1) > 1)
        if np.all(chosen >= 0):
            most = float(np.sum(cost[rows, columns])) + _CLEARLY * reach
            several = several[[_next_best(cost, int(m), int(chosen[m])) < most for m in several]]
        chosen[several] = -1
        return Chain(chosen, 2.0 * CLEAR if (chosen >= 0).any() else 0.0)

    return assign


def _overlapping(points: Array, reach: float) -> AnyArray:
    """Markers whose reach overlaps that of another one, shape (markers,)."""
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    return np.asarray(np.sum(apart <= 2.0 * reach, axis=1) > 1)


def _next_best(cost: Array, marker: int, spot: int) -> float:
    """Least cost of all markers together where one of them is not this spot."""
    other = cost.copy()
    other[marker, spot] = 1e3 * float(np.max(cost) + 1.0)
    rows, columns = linear_sum_assignment(other)
    return float(np.sum(other[rows, columns]))


def follow(times: Array, pictures: Sequence[Places], markers: int, assign: Assign) -> Tracks:
    """Tracks of markers through all pictures.

    Args:
        times: Shape (frames,) [s].
        pictures: Spots of each frame.
        markers: Number of markers.
        assign: Which spot is which marker.
    """
    chains = [assign(spots, None) for spots in pictures]
    first = _tracks(times, pictures, chains, markers)
    good = np.array([c is not None and c.is_resolved for c in chains])
    for frame in np.flatnonzero(~good):
        expected = _expected(first, good, int(frame))
        chains[frame] = None if expected is None else assign(pictures[int(frame)], expected)
    return _without_strays(_tracks(times, pictures, chains, markers))


def _tracks(times: Array, pictures: Sequence[Places], chains: Sequence[Chain | None], markers: int) -> Tracks:
    places = np.full((len(times), markers, 2), np.nan)
    covariance = np.full((len(times), markers, 2, 2), np.nan)
    share = np.zeros((len(times), markers))
    state = np.full((len(times), markers), GAP)
    margin = np.zeros(len(times))
    for frame, (spots, chain) in enumerate(zip(pictures, chains)):
        if chain is None or not chain.is_resolved:
            continue
        has = chain.spots >= 0
        own = chain.spots[has]
        places[frame, has], covariance[frame, has] = spots.places[own], spots.covariance[own]
        share[frame, has] = spots.share[own]
        state[frame, has] = np.where(spots.is_whole[own], SEEN, PART)
        margin[frame] = min(chain.margin, 99.0)
    return Tracks(times, places, covariance, share, state, margin)


def _expected(tracks: Tracks, good: AnyArray, frame: int) -> Expected | None:
    """Where markers are expected: between the nearest readings before and after."""
    places = np.full((tracks.markers, 2), np.nan)
    deviation = np.full(tracks.markers, np.nan)
    now = tracks.times[frame]
    for marker in range(tracks.markers):
        has = np.flatnonzero(good & (tracks.state[:, marker] == SEEN))
        at = int(np.searchsorted(has, frame))
        near = [i for i in (has[at - 1] if at else None, has[at] if at < len(has) else None) if i is not None]
        near = [i for i in near if abs(tracks.times[i] - now) <= _LONGEST]
        if not near:
            continue
        away = np.array([abs(tracks.times[i] - now) for i in near])
        weight = (away[::-1] if len(near) == 2 else away) / away.sum()
        places[marker] = weight @ tracks.places[near, marker]
        deviation[marker] = _AT_ONCE + _PER_SECOND * away.min()
    return None if np.isnan(deviation).all() else Expected(places, deviation)


def _without_strays(tracks: Tracks) -> Tracks:
    """Gaps where a place is far off the median of its neighbours in time, while those agree."""
    is_off = np.zeros(tracks.state.shape, dtype=bool)
    for marker in range(tracks.markers):
        has = np.flatnonzero(tracks.state[:, marker] != GAP)
        if len(has) < 7:
            continue
        own = tracks.places[has, marker]
        around = np.lib.stride_tricks.sliding_window_view(own, 7, axis=0)
        middle = np.median(around, axis=2)
        spread = np.median(np.abs(around - middle[..., None]), axis=2)
        off = np.abs(own[3:-3] - middle)
        is_off[has[3:-3], marker] = np.any(off > np.maximum(_OFF * spread, _LEAST_OFF), axis=1)
    return tracks.without(is_off)


def without_repeats(tracks: Tracks, is_repeated: AnyArray) -> Tracks:
    """Gaps where a camera or a recorder gave the picture before once more while the markers moved.

    Such a reading belongs to an earlier time. Where nothing moved until the next picture it stays.

    Args:
        tracks: As followed.
        is_repeated: Whether a picture is the one before it, shape (frames,).
    """
    is_late = np.zeros(len(is_repeated), dtype=bool)
    new = np.flatnonzero(~is_repeated)
    for begin, end in zip(new, [*new[1:], len(is_repeated)]):
        if end - begin < 2:
            continue
        if end == len(is_repeated):  # nothing tells what came after it
            is_late[begin + 1 : end] = True
            continue
        moved = np.abs(tracks.places[end] - tracks.places[begin])
        noise = np.hypot(tracks.deviation[end], tracks.deviation[begin])
        is_late[begin + 1 : end] = not np.any(np.isfinite(moved)) or bool(np.any(moved > _MOVED * noise))
    return tracks.without(np.repeat(is_late[:, None], tracks.markers, axis=1))


def stopped(tracks: Tracks) -> AnyArray:
    """Pictures in which all markers stand where they were, in the middle of a motion, shape (frames,).

    A video that was made from fewer pictures, or a recorder that lost some, shows the one before once more; compression
    makes it differ by bits. What moves on in the same direction before and after did not stop in between.
    """
    step = np.diff(tracks.places, axis=0)
    with np.errstate(invalid="ignore"):
        noise = np.nanmedian(tracks.deviation) * np.sqrt(2.0)
    far = np.array([_size(s) for s in step])
    found = np.zeros(len(tracks.times), dtype=bool)
    large = np.flatnonzero(far > _GOING * noise)
    for before, after in itertools.pairwise(large.tolist()):
        between = far[before + 1 : after]
        if not 0 < len(between) <= _HELD_FOR or not np.all(between < _STOPPED * min(far[before], far[after])):
            continue
        both = np.isfinite(step[before] + step[after])
        along = float(np.sum(step[before][both] * step[after][both]))
        if along > _AHEAD * float(np.linalg.norm(step[before][both]) * np.linalg.norm(step[after][both])):
            found[before + 2 : after + 1] = True
    return found


def _size(step: Array) -> float:
    """Root mean square of what is known of it; not a number where fewer than three markers are."""
    known = np.isfinite(step).all(axis=1)
    return float(np.sqrt(np.mean(step[known] ** 2))) if known.sum() >= 3 else float("nan")


def doubt_parts(tracks: Tracks, radius: float) -> Tracks:
    """Larger covariances where a marker lacks more of its area than its own scatter explains.

    A strip that is hidden at the rim, with the share f of the area, moves the centroid by at most f radii.

    Args:
        tracks: As followed.
        radius: Of a marker [m].
    """
    share = np.where(tracks.state == GAP, np.nan, tracks.share)
    covariance, state = tracks.covariance.copy(), tracks.state.copy()
    for marker in range(tracks.markers):
        own = share[tracks.state[:, marker] == SEEN, marker]
        if own.size < 5:
            continue
        whole = float(np.median(own))
        scatter = float(np.median(np.abs(own - whole))) / 0.6745
        missing = whole - share[:, marker]
        is_less = (missing > max(_MISSING * scatter, _LEAST_MISSING)) & (tracks.state[:, marker] == SEEN)
        covariance[is_less, marker] += (missing[is_less] * radius)[:, None, None] ** 2 * np.eye(2)
        state[is_less, marker] = PART
    return Tracks(tracks.times, tracks.places, covariance, tracks.share, state, tracks.margin)


def doubt_motion(tracks: Tracks, exposure: float, radius: float) -> Tracks:
    """Larger covariances, or gaps, where a marker moves or turns off its course while a picture is exposed.

    A course with the acceleration a has its mean over an exposure T off its middle by a T^2 / 24. The outline of a
    marker that moves by b meanwhile is smeared by b. Where the circle goes through what is seen of the outline, because
    part of it is hidden or seems so, it may be that of the begin or of the end: off by up to half of b, by the faster
    one of the steps before and after. Smeared by more than half a radius it is no circle any more, and a gap.

    Args:
        tracks: As followed.
        exposure: Of a picture [s].
        radius: Of a marker [m].
    """
    if exposure <= 0.0 or len(tracks.times) < 3:
        return tracks
    step = np.diff(tracks.places, axis=0) / np.diff(tracks.times)[:, None, None]
    before, after = np.concatenate([step[:1], step]), np.concatenate([step, step[-1:]])
    is_faster = np.linalg.norm(np.nan_to_num(after), axis=2) > np.linalg.norm(np.nan_to_num(before), axis=2)
    smear = np.where(is_faster[..., None], after, before) * exposure / 2.0
    smear = np.where((tracks.state == PART)[..., None], smear, 0.0)
    speed = np.gradient(tracks.places, tracks.times, axis=0)
    bend = np.gradient(speed, tracks.times, axis=0) * exposure**2 / 24.0
    added = sum(np.nan_to_num(d)[..., :, None] * np.nan_to_num(d)[..., None, :] for d in (bend, smear))
    is_no_circle = np.linalg.norm(np.nan_to_num(smear), axis=2) > radius / 4.0
    return replace(tracks, covariance=tracks.covariance + added).without(is_no_circle)
