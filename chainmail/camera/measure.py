"""The whole way from frames to tracks, links and curvature."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from chainmail.camera.curvature import Curvature, largest_curvature
from chainmail.camera.detect import NO_SPOTS, Detector, Spots, outline_error
from chainmail.camera.follow import (
    doubt_motion,
    doubt_parts,
    fabric_assigner,
    follow,
    follow_points,
    stopped,
    without_repeats,
)
from chainmail.camera.frames import Frames, frame_times
from chainmail.camera.links import Links, fit_links, with_errors
from chainmail.camera.mistakes import weave_of, what_would_fit
from chainmail.camera.rig import FabricLayout, Rig
from chainmail.camera.shutter import at_one_time, largest_shift, line_delays
from chainmail.camera.sight import Sight, sight_of
from chainmail.camera.spots import Places, Size, places_of, size_of
from chainmail.camera.steady import Motion, motion_of
from chainmail.camera.tracks import GAP, SEEN, Tracks
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array

#: A marker whose measured diameter is off by this factor is not what the rig describes.
_OTHER_SIZE = 1.4
#: From this relative difference on the sizes of the markers, measured and stated, are set side by side.
_ODD_SIZE = 0.1
#: Usual time that a rolling shutter takes for a picture [s]: tens of milliseconds.
_COMMON_READOUT = 0.02
#: A held row that moves by so much [m], while the last one moves by less than this share of it, is no held row.
_HELD, _STILL = 5e-3, 0.3
#: Errors of a marker's centre by pixels and blocks are others after it has moved by so many pixels.
_GRAIN = 4.0
#: Frames whose outlines are looked at.
_SAMPLES = 60
#: Fewest frames of a recording.
FEWEST = 8


@dataclass(frozen=True)
class Measured:
    """What a video says.

    Args:
        tracks: Of all markers, as they go into the recording.
        links: Rigid links of a fabric; None of points.
        curvature: Of a fabric; None of points.
        sight: The camera.
        notes: What was found out, in sentences.
        spots: Number of spots in every frame.
        motion: Of the camera, by coloured fiducials; None where nothing tells it.
    """

    tracks: Tracks
    links: Links | None
    curvature: Curvature | None
    sight: Sight
    notes: tuple[str, ...]
    spots: tuple[int, ...]
    motion: Motion | None = None


def measure(video: Path, rig: Rig, rig_file: Path, on_frame: Callable[[int], None] = lambda count: None) -> Measured:
    """Track the markers of a video.

    Args:
        video: Video file or folder of pictures.
        rig: The rig.
        rig_file: Its file, for what lies beside it and for errors.
        on_frame: Called with the number of frames read.

    Raises:
        InputError: The video or what the rig names cannot be read, no marker is found, or the markers are of
            another size than the rig says.
    """
    frames = Frames(video)
    sight = sight_of(rig, rig_file, frames, (frames.shape[1], frames.shape[0]))
    layout = rig.markers.layout
    count = 2 * layout.rows if isinstance(layout, FabricLayout) else len(layout.points)
    pictures, stamps, is_repeated = _spots(frames, rig, sight, count, on_frame)
    cut = f"the file states {frames.stated} frames, {frames.read} could be read" if frames.is_cut else ""
    if len(pictures) < FEWEST:
        raise InputError(
            video,
            "",
            f"it has {len(pictures)} frames{f' ({cut})' if cut else ''}; at least {FEWEST} are needed",
            "copy it once more: it is damaged" if cut else "film longer",
        )
    jump = frames.jump() if rig.clock.rate is not None else None
    if jump is not None:
        raise InputError(
            video,
            "",
            f"a picture is missing between {jump[0]} and {jump[1]}: by `rate` all later ones would get wrong times",
            "put it back, or give `clock.stamps`",
        )
    times, said = frame_times(rig.clock, np.array(stamps), frames.rate, rig_file, video)
    size = _size(pictures, rig, rig_file, sight, count)
    radius = size.radius
    error, contrast = _error(pictures, sight, size)
    motion = None if sight.followed is None else motion_of(sight.followed.pixels, sight.followed.reference, sight.lens)
    places = _places(pictures, sight, motion, size, error)
    reaches: tuple[str, ...] = ()
    if isinstance(layout, FabricLayout):
        followed = follow(times, places, count, fabric_assigner(weave_of(layout)))
    else:
        points = np.array([[c.to("m") for c in p] for p in layout.points])
        followed, reaches = follow_points(times, places, points, layout.reach.to("m"))
    if not np.any(followed.state != GAP):
        seen = int(np.median([len(p) for p in places]))
        raise InputError(
            video,
            "",
            f"in none of its {len(pictures)} frames can the markers be told apart: the rig has "
            f"{count}, the median frame shows {seen} spots of that colour{_compared(radius, rig)}",
            what_would_fit([p.places for p in places], layout)
            or "; ".join(reaches)
            or "look at markers.layout, plane and markers.colour of the rig file",
        )
    if isinstance(layout, FabricLayout):
        _check_direction(followed, layout, rig_file)
    tracks, factor = with_errors(followed)
    is_repeated = is_repeated | stopped(tracks)
    moving = _at_one_time(without_repeats(tracks, is_repeated), rig, sight, frames.shape[0])
    tracks = doubt_motion(doubt_parts(moving, radius), rig.clock.exposure.to("s"), radius)
    pixel = float(sight.pixel_length(_middle(frames))[0])
    notes = (
        *sight.notes,
        _moved(motion, sight, pixel),
        f"time: {said}",
        f"markers: {2e3 * radius:.2f} mm across{_compared(radius, rig)}",
        f"error of a marker by its outline: {1e6 * pixel * error / contrast:.0f} um; "
        f"by its scatter over time {factor:.2f} times that",
    )
    notes = (*notes, *reaches, *_unstated_shutter(tracks, rig))
    if cut:
        notes = (*notes, f"cut off, trimmed or damaged: {cut}; the last of them was left out")
    late = int(np.sum(is_repeated & (moving.state == GAP).all(axis=1)))
    if late:
        notes = (*notes, f"{late} pictures repeat the one before them while the markers move: they are gaps")
    return _finished(tracks, rig, sight, _GRAIN * pixel, notes, tuple(len(p) for p in places), motion)


def _places(pictures: list[Spots], sight: Sight, motion: Motion | None, size: Size, error: float) -> list[Places]:
    """Spots of all pictures in the plane; none where the camera moves and a picture does not say how."""
    found = []
    for number, spots in enumerate(pictures):
        is_lost = motion is not None and motion.is_moving and not motion.known[number]
        found.append(places_of(NO_SPOTS if is_lost else spots, sight.at(motion, number), size, error))
    return found


def _moved(motion: Motion | None, sight: Sight, pixel: float) -> str:
    """Whether the camera moves, and what is done about it."""
    if motion is None:
        return (
            "camera: taken to stand still, nothing in the rig shows whether it does; coloured fiducials "
            "(`plane.colour`) that stay in view would"
        )
    known, count = int(motion.known.sum()), len(motion.known)
    far = float(np.nanmax(np.hypot(*motion.shifts.T), initial=0.0))
    if not motion.is_moving:
        return f"camera: it stands still within {far:.2g} px, by the fiducials in {known} of {count} frames"
    lost = f"; the other {count - known} are gaps" if known < count else ""
    left = f", which leaves {motion.left:.2g} px of them" if np.isfinite(motion.left) else ""
    return (
        f"camera: it moves by up to {far:.3g} px ({1e3 * far * pixel:.2g} mm); its shift, turn and size are undone by "
        f"the fiducials in {known} of {count} frames{left}{lost}"
    )


def _at_one_time(tracks: Tracks, rig: Rig, sight: Sight, height: int) -> Tracks:
    """Readings of a rolling shutter at the time of their picture."""
    readout = rig.clock.readout.to("s")
    if not readout:
        return tracks
    lines = np.full(tracks.state.shape, np.nan)
    is_read = tracks.state != GAP
    lines[is_read] = sight.pixels(tracks.places[is_read])[:, 1]
    return at_one_time(tracks, line_delays(lines, height, readout))


def _unstated_shutter(tracks: Tracks, rig: Rig) -> tuple[str, ...]:
    """What a rolling shutter that nobody states would do, where that is more than noise."""
    if rig.clock.readout.to("s"):
        return ()
    shift = largest_shift(tracks, _COMMON_READOUT)
    if not shift > float(np.nanmedian(tracks.deviation)):
        return ()
    return (
        "shutter: taken to expose all lines at once. One that rolls, as in most phones and webcams, shifts the "
        f"fastest markers by about {1e3 * shift:.2g} mm if it takes {1e3 * _COMMON_READOUT:.0f} ms from the first "
        "line to the last one: state `clock.readout` then",
    )


def _size_ratio(radius: float, rig: Rig) -> float:
    """Measured over stated diameter of the markers."""
    return 2.0 * radius / float(rig.markers.diameter.to("m"))


def _compared(radius: float, rig: Rig) -> str:
    """What a size that is not the rig's says of its places."""
    ratio = _size_ratio(radius, rig)
    if abs(ratio - 1.0) < _ODD_SIZE:
        return ""
    which = "large" if ratio > 1.0 else "small"
    return (
        f"; the rig says {rig.markers.diameter}. If that is right, all distances are too {which} by "
        f"{100.0 * abs(ratio - 1.0):.0f} %, as after another zoom or at another size of the picture"
    )


def _check_direction(tracks: Tracks, layout: FabricLayout, rig_file: Path) -> None:
    """Refuse a fabric whose held row moves while its last one stays: it is read from its free end.

    Turned by half a turn a weave looks the same, so no single picture can tell.
    """
    if not layout.tethered_rows:
        return
    first, last = (_travel(tracks, k) for k in (slice(0, 2), slice(-2, None)))
    if first > _HELD and last < _STILL * first:
        raise InputError(
            rig_file,
            "markers.layout.along",
            f"row 1 is held at the tether, but what looks like it moves "
            f"by {1e3 * first:.3g} mm, and row {layout.rows} by {1e3 * last:.2g} mm: the fabric points "
            "the other way",
            "correct `along`, or the directions of y and z under `plane`",
        )


def _travel(tracks: Tracks, markers: slice) -> float:
    """How far markers travel [m], without the extreme tenths of the time."""
    own = tracks.places[:, markers][(tracks.state[:, markers] == SEEN).all(axis=1)]
    return float(np.max(np.ptp(np.quantile(own, (0.1, 0.9), axis=0), axis=0))) if len(own) else 0.0


def _finished(
    tracks: Tracks,
    rig: Rig,
    sight: Sight,
    grain: float,
    notes: tuple[str, ...],
    spots: tuple[int, ...],
    motion: Motion | None,
) -> Measured:
    largest = rig.largest_noise.to("m")
    shared = sight.plane.doubt**2 + (0.0 if motion is None else (motion.error * grain / _GRAIN) ** 2)
    doubt = np.broadcast_to(shared, (len(tracks.times),))[:, None, None, None] * np.eye(2)
    if not isinstance(rig.markers.layout, FabricLayout):
        tracks = tracks.without(_vague(tracks, largest))
        tracks = replace(tracks, covariance=tracks.covariance + doubt)
        return Measured(tracks, None, None, sight, notes, spots, motion)
    links = fit_links(tracks.without(_vague(tracks, largest)), grain)
    links = replace(links, tracks=links.tracks.without(_vague(links.tracks, largest)))
    curvature = largest_curvature(links.centres, links.centre_covariance)
    # What the fiducials leave open moves all places alike: it is no noise of a curvature.
    tracks = replace(links.tracks, covariance=links.tracks.covariance + doubt)
    if sight.plane.doubt > largest:
        notes = (
            *notes,
            f"plane: what the fiducials leave open moves all places together by {1e3 * sight.plane.doubt:.2g} mm (one "
            f"standard deviation), more than largest_noise ({rig.largest_noise}), which counts for single markers",
        )
    return Measured(tracks, links, curvature, sight, notes, spots, motion)


def _vague(tracks: Tracks, largest: float) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    return np.asarray(~(np.max(tracks.deviation, axis=2) <= largest))


def _spots(
    frames: Frames, rig: Rig, sight: Sight, count: int, on_frame: Callable[[int], None]
) -> tuple[list[Spots], list[float], AnyArray]:
    pixel = float(sight.pixel_length(_middle(frames))[0])
    detector = Detector(rig.markers.colour, rig.markers.diameter.to("m") / pixel, count)
    pictures, stamps, repeated = [], [], []
    for frame in frames:
        pictures.append(detector.spots(frame.picture))
        if sight.followed is not None:
            sight.followed.look(frame.picture)
        stamps.append(frame.stamp)
        repeated.append(frame.is_repeated)
        on_frame(len(pictures))
    return pictures, stamps, np.array(repeated, dtype=bool)


def _size(pictures: list[Spots], rig: Rig, rig_file: Path, sight: Sight, count: int) -> Size:
    """Size of the markers, measured, and compared with the rig's."""
    size = size_of(pictures, sight, count)
    radius = size.radius
    if not np.isfinite(radius):
        raise InputError(
            rig_file,
            "markers.colour",
            f"no spot that is {rig.markers.colour} and about {rig.markers.diameter} across is in any frame",
            "correct colour and diameter of the markers, or the plane",
        )
    ratio = _size_ratio(radius, rig)
    if not 1.0 / _OTHER_SIZE < ratio < _OTHER_SIZE:
        raise InputError(
            rig_file,
            "markers.diameter",
            f"spots of this colour are {2e3 * radius:.3g} mm across, not {rig.markers.diameter}",
            "correct diameter, colour, or the scale of the plane",
        )
    return size


def _middle(frames: Frames) -> Array:
    """Middle of the picture, shape (1, 2) [px]."""
    return np.array([[frames.shape[1] / 2.0, frames.shape[0] / 2.0]])


def _error(pictures: list[Spots], sight: Sight, size: Size) -> tuple[float, float]:
    """Error of whole markers by their outlines for a contrast of 1 [px], and their median contrast."""
    edges, centres, contrast = [], [], []
    for spots in pictures[:: max(1, len(pictures) // _SAMPLES)]:
        pixel = sight.pixel_length(spots.pixels)
        for number in np.flatnonzero(spots.area * pixel**2 > size.whole * np.pi * size.radius**2):
            edges.append(spots.edges[number])
            centres.append(spots.pixels[number])
            contrast.append(spots.contrast[number])
    if not edges:
        return 0.0, 1.0
    return outline_error(edges, np.array(centres), np.array(contrast)), float(np.median(contrast))
