"""What a video gave, in sentences."""

from __future__ import annotations

import numpy as np

from chainmail.camera.measure import Measured
from chainmail.camera.tracks import GAP, PART, REBUILT, SEEN


def summary(measured: Measured) -> list[str]:
    """Sentences on time, markers, noise, gaps and curvature."""
    tracks, state = measured.tracks, measured.tracks.state
    frames = len(tracks.times)
    is_complete = (state != GAP).all(axis=1)
    found = [
        f"{frames} frames from {tracks.times[0]:.4f} s to {tracks.times[-1]:.4f} s, {tracks.markers} markers",
        *measured.notes,
        f"readings: {_share(state == SEEN)} of whole markers, {_share(state == PART)} of markers hidden in part, "
        f"{_share(state == REBUILT)} rebuilt from their link, {_share(state == GAP)} gaps",
        f"frames with all markers: {int(is_complete.sum())} of {frames}",
    ]
    found += _unresolved(measured)
    whole = tracks.deviation[state == SEEN]
    if whole.size:
        found.append(f"standard deviation of a whole marker: {1e3 * float(np.median(whole)):.3g} mm (median)")
    curvature = measured.curvature
    if curvature is not None and np.isfinite(curvature.values).any():
        known = np.isfinite(curvature.values)
        low, high = float(np.min(curvature.values[known])), float(np.max(curvature.values[known]))
        noise = float(np.median(curvature.deviation[known]))
        found.append(
            f"largest curvature: {low:.2f} to {high:.2f} 1/m with a standard deviation of {noise:.2g} 1/m (median), "
            f"in {int(known.sum())} of {frames} frames"
            + ("; below 0 is noise of a fabric that is nearly straight, whose mean is right" if low < 0.0 else "")
        )
    return found


def _unresolved(measured: Measured) -> list[str]:
    """Frames without any marker, and how many spots of the markers' colour these show."""
    tracks = measured.tracks
    is_lost = (tracks.state == GAP).all(axis=1)
    if not is_lost.any():
        return []
    spots = int(np.median(np.array(measured.spots)[is_lost]))
    return [
        f"frames without any marker: {int(is_lost.sum())}; the median one of them shows {spots} spots that may be a "
        f"marker, of {tracks.markers} (a marker that something of its colour touches, or that is hidden at either end "
        "of the chain, leaves it open which is which)"
    ]


def _share(holds: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> str:
    return f"{100.0 * float(np.mean(holds)):.1f} %"
