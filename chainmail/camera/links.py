"""Rigid links: noise from the tracks themselves, lengths over time, hidden markers rebuilt."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from chainmail.camera.tracks import GAP, PART, REBUILT, SEEN, Tracks
from cosim.unit.protocol import AnyArray, Array

#: Weights of the third difference, which removes any course that is a parabola over four pictures.
_THIRD = np.array([-1.0, 3.0, -3.0, 1.0])
#: Largest factor by which scatter over time corrects the deviations, and fewest differences that tell it.
_LARGEST, _ENOUGH = 4.0, 20
#: Deviation of the window over which a link's length is averaged [s], and most pictures in it.
_WINDOW, _MOST = 0.1, 12.0
#: Mean and median of a length that differ by so many deviations of its noise: the link moves fast.
_FAST = 2.0
#: Three readings of one length seldom span more than so many deviations (one in 50 does).
_NOISE_OF_THREE = 4.0
#: A link's length cannot be trusted nearer than this [m]: it slides and rattles.
_RATTLE = 4e-5
#: A link whose length is off by so many deviations, and so much [m], has a wrong marker.
_WRONG, _LEAST_WRONG = 6.0, 8e-4
#: Longest time over which a hidden marker is rebuilt [s].
_LONGEST = 0.4


def with_errors(tracks: Tracks) -> tuple[Tracks, float]:
    """Deviations in accord with the scatter of the tracks over time, and the factor.

    Third differences of whole markers hold noise and little motion; their median over all markers and pictures, over
    what the deviations say, is the factor. A slow video of a fast motion makes it too large, never too small: it is 1
    at least, since errors that stay from picture to picture do not show in differences. Markers that are seen in part
    have deviations of their own outline, and keep them.

    Args:
        tracks: As followed.
    """
    is_whole = tracks.state == SEEN
    places = np.where(is_whole[..., None], tracks.places, np.nan)
    factor = 1.0
    if len(places) >= 8:
        difference = sum(w * places[k : len(places) - 3 + k] for k, w in enumerate(_THIRD))
        deviation = tracks.deviation
        variance = sum(w * w * deviation[k : len(places) - 3 + k] ** 2 for k, w in enumerate(_THIRD))
        scaled = np.abs(np.asarray(difference)) / np.sqrt(np.asarray(variance))
        known = scaled[np.isfinite(scaled)]
        if known.size >= _ENOUGH:
            factor = float(np.clip(np.median(known) / 0.6745, 1.0, _LARGEST))
    scale = np.where(is_whole[..., None, None], factor**2, 1.0)
    return replace(tracks, covariance=scale * tracks.covariance), factor


def lengths(tracks: Tracks) -> Array:
    """Distance of the two markers of every link, shape (frames, links) [m]; not a number in a gap."""
    step = tracks.places[:, 1::2] - tracks.places[:, 0::2]
    return np.asarray(np.hypot(step[..., 0], step[..., 1]))


def smooth_lengths(tracks: Tracks, grain: float) -> tuple[Array, Array]:
    """Length of every link over time, and how far it may be off, both of shape (frames, links) [m].

    A mean over neighbouring pictures in which both markers are whole. Where a link contracts faster than that, the
    median of about as many pictures: it follows every course that only falls or only rises, and a wrong marker in fewer
    than half of them does not move it. What mean and median differ by is then how far it may be off. A mean over
    pictures in which the markers hardly move has the error of one of them.

    Args:
        tracks: Of both ends of every link.
        grain: Errors of a place are others after it has moved so far [m].
    """
    own = lengths(tracks)
    is_whole = (tracks.state[:, 0::2] == SEEN) & (tracks.state[:, 1::2] == SEEN)
    period = float(np.median(np.diff(tracks.times))) if len(own) > 1 else 1.0
    wide = float(np.clip(_WINDOW / period, 0.5, _MOST))
    weight = gaussian_filter1d(is_whole.astype(np.float64), wide, axis=0, mode="nearest", truncate=6.0)
    total = gaussian_filter1d(np.where(is_whole, own, 0.0), wide, axis=0, mode="nearest", truncate=6.0)
    mean = np.where(weight > 1e-3, total / np.maximum(weight, 1e-12), np.nan)
    known = np.where(is_whole, own, np.nan)
    middle = _medians(known, int(1.5 * wide) + 1)
    off = np.abs(mean - middle)
    noise = _typical(np.where(is_whole, np.hypot(*np.sqrt(_along(tracks))), np.nan))
    is_fast = off > _FAST * noise + _RATTLE
    course, half = _jumps(own, noise)
    length = np.where(half > 2.0 * noise, course, np.where(is_fast, middle, mean))
    moved = half + np.where(is_fast, off, 0.0)
    return length, np.sqrt(_RATTLE**2 + moved**2 + noise**2 / _independent(tracks, grain, wide))


def _independent(tracks: Tracks, grain: float, wide: float) -> Array:
    """How many pictures of a mean over time have errors of their own, shape (frames, links)."""
    step = np.diff(tracks.places, axis=0, prepend=tracks.places[:1])
    noise = np.sum(tracks.deviation**2, axis=2)
    way = np.sqrt(np.maximum(np.sum(step**2, axis=2) - 2.0 * noise, 0.0))
    both = np.nan_to_num(way[:, 0::2] + way[:, 1::2]) / 2.0
    count = 2.0 * np.sqrt(np.pi) * wide
    travelled = count * gaussian_filter1d(both, wide, axis=0, mode="nearest", truncate=6.0)
    return np.asarray(np.clip(1.0 + travelled / max(grain, 1e-9), 1.0, max(count, 1.0)))


def _jumps(own: Array, noise: Array) -> tuple[Array, Array]:
    """Where a link changes its length between neighbouring pictures by more than noise: the middle, and half of it.

    A link that snaps may have any length in between while a picture is exposed. Gaps are bridged straight.

    Args:
        own: Lengths as read, shape (frames, links) [m].
        noise: Deviation of a length, shape (links,) [m].

    Returns:
        Middle of the lengths of the picture before and after, and half of what they, and this one, differ by beyond
        noise; both of shape (frames, links) [m].
    """
    course, half = own.copy(), np.zeros_like(own)
    for link in range(own.shape[1]):
        known = np.flatnonzero(np.isfinite(own[:, link]))
        if len(known) < 2:
            continue
        # Values of the nearest readings before and after, the own one where there is one.
        at = np.arange(len(own))
        place = np.searchsorted(known, at)
        before = own[known[np.clip(place - 1, 0, None)], link]
        after = own[known[np.clip(np.searchsorted(known, at, side="right"), None, len(known) - 1)], link]
        three = np.stack([before, np.where(np.isfinite(own[:, link]), own[:, link], before), after])
        half[:, link] = np.maximum(np.ptp(three, axis=0) - _NOISE_OF_THREE * np.nan_to_num(noise[link]), 0.0) / 2.0
        course[:, link] = (np.max(three, axis=0) + np.min(three, axis=0)) / 2.0
    return course, half


def _medians(values: Array, reach: int) -> Array:
    """Median of the values known within `reach` pictures before and after; not a number where there is none.

    Towards both ends of the video fewer pictures count, as many before as after, so that it still follows what only
    falls or only rises; but never fewer than two pictures on one side.
    """
    count = len(values)
    found = np.full(values.shape, np.nan)
    for frame in range(count):
        own = min(reach, max(2, min(frame, count - 1 - frame)))
        found[frame] = _typical(values[max(0, frame - own) : frame + own + 1])
    return found


def _typical(values: Array) -> Array:
    """Median over the first axis of the values that are known; not a number where there is none."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # nothing but gaps
        return np.asarray(np.nanmedian(values, axis=0))


@dataclass(frozen=True)
class Links:
    """Rigid links.

    Args:
        tracks: Of their markers.
        cross: Covariance of back and front marker of each link, shape (frames, links, 2, 2) [m^2].
    """

    tracks: Tracks
    cross: Array

    @property
    def centres(self) -> Array:
        """Row centres, the middles of both markers, shape (frames, rows, 2) [m]."""
        return (self.tracks.places[:, 0::2] + self.tracks.places[:, 1::2]) / 2.0

    @property
    def centre_covariance(self) -> Array:
        """Of the row centres, shape (frames, rows, 2, 2) [m^2]."""
        own = self.tracks.covariance
        return (own[:, 0::2] + own[:, 1::2] + self.cross + np.swapaxes(self.cross, -1, -2)) / 4.0

    @property
    def angles(self) -> Array:
        """Angle of each link, back to front marker, from +y towards +z, shape (frames, links) [rad]."""
        step = self.tracks.places[:, 1::2] - self.tracks.places[:, 0::2]
        return np.arctan2(step[..., 1], step[..., 0])


def fit_links(tracks: Tracks, grain: float = 0.0) -> Links:
    """Rigid links through the readings: hidden markers rebuilt, others moved along their link as far as both allow.

    A link keeps its length between neighbouring pictures but for a rattle. Where one marker is hidden its place follows
    from the other, that length, and the link's angle between the pictures before and after; how far angles of this link
    are off such a line elsewhere in the video tells the deviation.

    Args:
        tracks: With their errors.
        grain: Errors of a place are others after it has moved so far [m].
    """
    length, loose = smooth_lengths(tracks, grain)
    checked = _without_wrong(tracks, length)
    return _adjusted(_rebuilt(checked, length, loose), length, loose)


def _without_wrong(tracks: Tracks, length: Array) -> Tracks:
    """Gaps at both ends of a link whose length cannot be: which end is wrong is not known."""
    along = _along(tracks)
    off = np.abs(lengths(tracks) - length)
    is_wrong = off > np.maximum(_WRONG * np.sqrt(along[0] + along[1]), _LEAST_WRONG)
    return tracks.without(np.repeat(is_wrong, 2, axis=1))


def _along(tracks: Tracks) -> tuple[Array, Array]:
    """Variance of both markers along their link, each of shape (frames, links) [m^2]."""
    step = tracks.places[:, 1::2] - tracks.places[:, 0::2]
    unit = step / np.linalg.norm(step, axis=2, keepdims=True)
    back, front = (np.einsum("flij,fli,flj->fl", tracks.covariance[:, k::2], unit, unit) for k in (0, 1))
    return back, front


def _rebuilt(tracks: Tracks, length: Array, loose: Array) -> Tracks:
    places, covariance, state = tracks.places.copy(), tracks.covariance.copy(), tracks.state.copy()
    step = tracks.places[:, 1::2] - tracks.places[:, 0::2]
    angle = np.arctan2(step[..., 1], step[..., 0])
    for link in range(length.shape[1]):
        own = angle[:, link]
        has = np.flatnonzero(np.isfinite(own))
        for frame, hidden in _hidden(tracks.state[:, 2 * link : 2 * link + 2]):
            at = int(np.searchsorted(has, frame))
            if at in (0, len(has)) or tracks.times[has[at]] - tracks.times[has[at - 1]] > _LONGEST:
                continue
            before, after = int(has[at - 1]), int(has[at])
            line, deviation = _angle_between(own, frame, before, after)
            # The marker that is seen, the length, and the angle; front is ahead of back.
            sign, seen = (1.0, 2 * link) if hidden == 1 else (-1.0, 2 * link + 1)
            marker, radius = 2 * link + hidden, float(length[frame, link])
            if not np.isfinite(radius + deviation):
                continue
            unit = np.array([np.cos(line), np.sin(line)])
            across = np.array([-unit[1], unit[0]])
            places[frame, marker] = places[frame, seen] + sign * radius * unit
            covariance[frame, marker] = (
                covariance[frame, seen]
                + loose[frame, link] ** 2 * np.outer(unit, unit)
                + (radius * deviation) ** 2 * np.outer(across, across)
            )
            state[frame, marker] = REBUILT
    return replace(tracks, places=places, covariance=covariance, state=state)


def _hidden(state: AnyArray) -> list[tuple[int, int]]:
    """Pictures in which one marker of a link is hidden, and which."""
    frames = np.flatnonzero((state == GAP).sum(axis=1) == 1)
    return [(int(f), int(np.argmax(state[f] == GAP))) for f in frames]


def _angle_between(angle: Array, frame: int, before: int, after: int) -> tuple[float, float]:
    """Angle on the line between two pictures, and by how much angles nearby are off such lines, at the same spacing."""
    course = np.unwrap(angle[[before, after]])
    part = (frame - before) / (after - before)
    line = float((1.0 - part) * course[0] + part * course[1])
    width = after - before
    near = angle[max(0, before - 5 * width) : after + 5 * width + 1]
    inner = frame - before
    count = len(near) - width
    if count < 1:
        return line, float("nan")
    ahead, whole = near[inner : inner + count] - near[:count], near[width:] - near[:count]
    off = _turned(ahead) - part * _turned(whole)
    known = off[np.isfinite(off)]
    # Without a single picture to compare with nothing is known of it.
    return line, float(np.sqrt(np.mean(known**2))) if known.size >= 3 else float("nan")


def _turned(angle: Array) -> Array:
    """The same angle between -pi and pi."""
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def _adjusted(tracks: Tracks, length: Array, loose: Array) -> Links:
    """Both ends moved along their link towards its length, by their variances (one step of a Kalman filter)."""
    cross = _cross_of_rebuilt(tracks)
    places, covariance = tracks.places.copy(), tracks.covariance.copy()
    step = places[:, 1::2] - places[:, 0::2]
    own = np.linalg.norm(step, axis=2)
    unit = step / own[..., None]
    back, front = _along(tracks)
    usable = np.isfinite(own + length) & np.all(
        [(tracks.state[:, k::2] == SEEN) | (tracks.state[:, k::2] == PART) for k in (0, 1)], axis=0
    )
    spread = back + front + loose**2
    pulls = [np.einsum("flij,flj->fli", tracks.covariance[:, k::2], unit) for k in (0, 1)]
    joint = pulls[0][..., :, None] * pulls[1][..., None, :] / spread[..., None, None]
    cross = np.where(usable[..., None, None], joint, cross)
    for which, sign, variance in ((0, 1.0, back), (1, -1.0, front)):
        toward = pulls[which]
        gain = np.where(usable[..., None], toward / spread[..., None], 0.0)
        places[:, which::2] += sign * np.nan_to_num(gain * (own - length)[..., None])
        shrink = gain[..., :, None] * toward[..., None, :]
        covariance[:, which::2] -= np.where(np.isfinite(variance)[..., None, None], shrink, 0.0)
    return Links(replace(tracks, places=places, covariance=covariance), cross)


def _cross_of_rebuilt(tracks: Tracks) -> Array:
    """A rebuilt marker shares all of the error of the one that it was rebuilt from; others share none yet."""
    back, front = tracks.state[:, 0::2] == REBUILT, tracks.state[:, 1::2] == REBUILT
    cross = np.zeros((*back.shape, 2, 2))
    cross[back] = tracks.covariance[:, 1::2][back]
    cross[front] = tracks.covariance[:, 0::2][front]
    return cross
