"""Rolling shutters: readings of lines that are exposed one after the other, brought to one time for each picture."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from chainmail.camera.tracks import GAP, Tracks
from cosim.unit.protocol import Array

#: Readings through which a course goes, and fewest that tell one.
_MOST, _FEWEST = 4, 3
#: A marker that is not read again within so many pictures has no course there.
_NEAR = 4
#: Time over which speeds are taken [s].
_BASE = 0.1


def line_delays(lines: Array, height: int, readout: float) -> Array:
    """How much later than the middle of a picture its lines are exposed [s].

    Args:
        lines: From the top, any shape [px].
        height: Of the picture [px].
        readout: Time from the first line to the last one [s]; negative where the last one comes first.
    """
    return np.asarray(readout * ((lines + 0.5) / height - 0.5))


def at_one_time(tracks: Tracks, delays: Array) -> Tracks:
    """Places at the time of their picture, of readings that belong to other times.

    The course of a marker is the cubic through four readings, at their own times. What it differs by from the parabola
    through three of them counts as its error. A reading without enough others nearby becomes a gap.

    Args:
        tracks: Read at `times` + `delays`.
        delays: Shape (frames, markers) [s].

    Source: interpolation by Lagrange's polynomials.
    """
    places, covariance = tracks.places.copy(), tracks.covariance.copy()
    is_alone = np.zeros(tracks.state.shape, dtype=bool)
    for marker in range(tracks.markers):
        has = np.flatnonzero((tracks.state[:, marker] != GAP) & np.isfinite(delays[:, marker]))
        read_at = tracks.times + delays[:, marker]
        for frame in has:
            near = has[np.abs(has - frame) <= _NEAR]
            time = float(tracks.times[frame])
            near = near[np.argsort(np.abs(read_at[near] - time), kind="stable")][:_MOST]
            if len(near) < _FEWEST or frame not in near:
                is_alone[frame, marker] = True
                continue
            weights = _weights(read_at[near], time)
            fewer = _weights(read_at[near[:_FEWEST]], time)
            own = tracks.places[near, marker]
            places[frame, marker] = weights @ own
            left = places[frame, marker] - fewer @ own[:_FEWEST] if len(near) > _FEWEST else np.zeros(2)
            noise = np.tensordot(weights**2, tracks.covariance[near, marker], axes=1)
            covariance[frame, marker] = noise + np.outer(left, left)
    return replace(tracks, places=places, covariance=covariance).without(is_alone)


def largest_shift(tracks: Tracks, readout: float) -> float:
    """How far a rolling shutter would shift the fastest marker from the middle to the edge of a picture [m].

    Args:
        tracks: Of all markers.
        readout: Of the shutter [s].
    """
    if len(tracks.times) < 2:
        return 0.0
    # Between pictures that are farther apart than the shutter is long, noise is a small part of the way.
    apart = max(1, int(np.ceil(_BASE / float(np.median(np.diff(tracks.times))))))
    way = np.linalg.norm(tracks.places[apart:] - tracks.places[:-apart], axis=2)
    speed = way / (tracks.times[apart:] - tracks.times[:-apart])[:, None]
    known = speed[np.isfinite(speed)]
    return float(np.quantile(known, 0.99)) * readout / 2.0 if known.size else 0.0


def _weights(times: Array, at: float) -> Array:
    """Of values at these times in the polynomial through all of them, at another time."""
    apart = times[:, None] - times[None]
    np.fill_diagonal(apart, 1.0)
    ahead = np.where(np.eye(len(times), dtype=bool), 1.0, at - times[None])
    return np.asarray(np.prod(ahead / apart, axis=1))
