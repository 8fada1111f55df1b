"""The whole way from frames to tracks, links and curvature."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from chainmail.camera.curvature import Curvature, largest_curvature
from chainmail.camera.detect import Detector, Spots, outline_error
from chainmail.camera.follow import doubt_parts, fabric_assigner, follow, point_assigner
from chainmail.camera.frames import Frames, frame_times
from chainmail.camera.identify import Weave
from chainmail.camera.links import Links, fit_links, with_errors
from chainmail.camera.rig import FabricLayout, Rig
from chainmail.camera.sight import Sight, sight_of
from chainmail.camera.spots import WHOLE, places_of, radius_of
from chainmail.camera.tracks import GAP, Tracks
from cosim.unit.errors import InputError

#: A marker whose measured diameter is off by this factor is not what the rig describes.
_OTHER_SIZE = 1.4
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
    """

    tracks: Tracks
    links: Links | None
    curvature: Curvature | None
    sight: Sight
    notes: tuple[str, ...]
    spots: tuple[int, ...]


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
    sight = sight_of(rig, rig_file, frames)
    layout = rig.markers.layout
    count = 2 * layout.rows if isinstance(layout, FabricLayout) else len(layout.points)
    pictures, stamps = _spots(frames, rig, sight, count, on_frame)
    if len(pictures) < FEWEST:
        raise InputError(video, "", f"it has {len(pictures)} frames; at least {FEWEST} are needed", "film longer")
    times, said = frame_times(rig.clock, np.array(stamps), frames.rate, rig_file, video)
    radius = _radius(pictures, rig, rig_file, sight, count)
    places = [places_of(spots, sight, radius) for spots in pictures]
    assign = (
        fabric_assigner(_weave(layout))
        if isinstance(layout, FabricLayout)
        else point_assigner(np.array([[c.to("m") for c in p] for p in layout.points]), layout.reach.to("m"))
    )
    followed = follow(times, places, count, assign)
    if not np.any(followed.state != GAP):
        raise InputError(
            video,
            "",
            f"in none of its {len(pictures)} frames can the markers be told apart",
            "look at markers.layout, plane and markers.colour of the rig file",
        )
    steady = _steady(pictures, sight, radius)
    tracks, factor = with_errors(followed, steady)
    tracks = doubt_parts(tracks, radius)
    notes = (
        *sight.notes,
        f"time: {said}",
        f"markers: {2e3 * radius:.2f} mm across",
        f"noise: {factor:.2f} times that of single pictures; error that stays: {1e6 * steady:.0f} um",
    )
    return _finished(tracks, rig, sight, notes, tuple(len(p) for p in places))


def _finished(tracks: Tracks, rig: Rig, sight: Sight, notes: tuple[str, ...], spots: tuple[int, ...]) -> Measured:
    largest = rig.largest_noise.to("m")
    if not isinstance(rig.markers.layout, FabricLayout):
        return Measured(tracks.without(_vague(tracks, largest)), None, None, sight, notes, spots)
    links = fit_links(tracks.without(_vague(tracks, largest)))
    links = replace(links, tracks=links.tracks.without(_vague(links.tracks, largest)))
    curvature = largest_curvature(links.centres, links.centre_covariance)
    # What the fiducials leave open moves all places alike: it is no noise of a curvature.
    doubt = sight.plane.doubt**2 * np.eye(2)
    tracks = replace(links.tracks, covariance=links.tracks.covariance + doubt)
    return Measured(tracks, links, curvature, sight, notes, spots)


def _vague(tracks: Tracks, largest: float) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    return np.asarray(~(np.max(tracks.deviation, axis=2) <= largest))


def _spots(
    frames: Frames, rig: Rig, sight: Sight, count: int, on_frame: Callable[[int], None]
) -> tuple[list[Spots], list[float]]:
    centre = np.array([[frames.shape[1] / 2.0, frames.shape[0] / 2.0]])
    pixel = float(sight.pixel_length(centre)[0])
    detector = Detector(rig.markers.colour, rig.markers.diameter.to("m") / pixel, count)
    pictures, stamps = [], []
    for frame in frames:
        pictures.append(detector.spots(frame.picture))
        stamps.append(frame.stamp)
        on_frame(len(pictures))
    return pictures, stamps


def _radius(pictures: list[Spots], rig: Rig, rig_file: Path, sight: Sight, count: int) -> float:
    """Radius of the markers [m], measured."""
    radius = radius_of(pictures, sight, count)
    if not np.isfinite(radius):
        raise InputError(
            rig_file,
            "markers.colour",
            f"no spot that is {rig.markers.colour} and about {rig.markers.diameter} across is in any frame",
            "correct colour and diameter of the markers, or the plane",
        )
    ratio = 2.0 * radius / rig.markers.diameter.to("m")
    if not 1.0 / _OTHER_SIZE < ratio < _OTHER_SIZE:
        raise InputError(
            rig_file,
            "markers.diameter",
            f"spots of this colour are {2e3 * radius:.3g} mm across, not {rig.markers.diameter}",
            "correct diameter, colour, or the scale of the plane",
        )
    return radius


def _steady(pictures: list[Spots], sight: Sight, radius: float) -> float:
    """Error of whole markers that does not change from picture to picture [m]."""
    edges, centres, pixels = [], [], []
    for spots in pictures[:: max(1, len(pictures) // _SAMPLES)]:
        pixel = sight.pixel_length(spots.pixels)
        for number in np.flatnonzero(spots.area * pixel**2 > WHOLE * np.pi * radius**2):
            edges.append(spots.edges[number])
            centres.append(spots.pixels[number])
            pixels.append(pixel[number])
    return outline_error(edges, np.array(centres)) * float(np.median(pixels)) if edges else 0.0


def _weave(layout: FabricLayout) -> Weave:
    return Weave(
        layout.rows,
        (layout.link_length.least.to("m"), layout.link_length.most.to("m")),
        (layout.row_pitch.least.to("m"), layout.row_pitch.most.to("m")),
        (layout.lean[0].to("rad"), layout.lean[1].to("rad")),
        layout.along.to("rad"),
    )
