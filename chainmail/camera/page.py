"""One offline page: overlays on chosen frames, tracks, curvature and quality over time."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from chainmail.camera import charts
from chainmail.camera.frames import Frame
from chainmail.camera.measure import Measured
from chainmail.camera.opencv import opencv
from chainmail.camera.rig import Rig
from chainmail.camera.summary import summary
from chainmail.camera.tracks import GAP, STATES
from cosim.html_page import environment
from cosim.run_folder import write_atomically
from cosim.unit.protocol import AnyArray

#: Widest overlay [px], and quality of its picture.
_WIDE, _QUALITY = 960, 80


@dataclass(frozen=True)
class Overlay:
    """A frame with what was found in it.

    Args:
        text: Which frame, why it is shown, and the curvature.
        jpeg: The frame, base64.
        width: Of the frame as it was read [px].
        height: Of the same [px].
        marks: What is drawn over it, SVG.
    """

    text: str
    jpeg: str
    width: int
    height: int
    marks: str


def write_page(file: Path, measured: Measured, rig: Rig, frames: Iterable[Frame]) -> None:
    """Write the page.

    Args:
        file: Page.
        measured: From a video.
        rig: The rig.
        frames: The frames once more, for the overlays.

    Raises:
        OSError: It cannot be written.
    """
    template = environment(Path(__file__).parent / "templates").get_template("track.html.j2")
    page = template.render(
        title=rig.title,
        sentences=summary(measured),
        states=list(zip(charts.STATE_COLOURS, STATES)),
        overlays=_overlays(measured, chosen_frames(measured), frames),
        has_curvature=measured.curvature is not None,
        curvature=charts.curvature_chart(measured),
        tracks=charts.tracks_chart(measured),
        quality=charts.quality_chart(measured),
        noise=charts.noise_chart(measured),
    )
    write_atomically(file, page.encode())


def chosen_frames(measured: Measured) -> dict[int, str]:
    """Frames that are shown, with the reason: first and last, extremes of curvature, most doubtful ones, a gap."""
    tracks = measured.tracks
    found = {0: "first frame", len(tracks.times) - 1: "last frame"}
    curvature = measured.curvature
    if curvature is not None and np.isfinite(curvature.values).any():
        found.setdefault(int(np.nanargmax(curvature.values)), "largest curvature")
        found.setdefault(int(np.nanargmin(curvature.values)), "smallest curvature")
        found.setdefault(int(np.nanargmax(curvature.deviation)), "least certain curvature")
    gaps = (tracks.state == GAP).sum(axis=1)
    if gaps.any():
        found.setdefault(int(np.argmax(gaps)), "most gaps")
    return dict(sorted(found.items()))


def _overlays(measured: Measured, chosen: dict[int, str], frames: Iterable[Frame]) -> list[Overlay]:
    found = []
    for number, frame in enumerate(frames):
        if number in chosen:
            found.append(_overlay(measured, number, chosen[number], frame.picture))
        if number >= max(chosen):
            break
    return found


def _overlay(measured: Measured, frame: int, why: str, picture: AnyArray) -> Overlay:
    cv2 = opencv()
    high, wide = picture.shape[:2]
    shrunk = (
        picture
        if wide <= _WIDE
        else cv2.resize(picture, (_WIDE, round(high * _WIDE / wide)), interpolation=cv2.INTER_AREA)
    )
    coded = base64.b64encode(cv2.imencode(".jpg", shrunk, [cv2.IMWRITE_JPEG_QUALITY, _QUALITY])[1].tobytes()).decode()
    curvature = measured.curvature
    value = (
        ""
        if curvature is None
        else (
            f", {curvature.values[frame]:.2f} ± {1.96 * curvature.deviation[frame]:.2f} 1/m"
            if np.isfinite(curvature.values[frame])
            else ", no curvature"
        )
    )
    text = f"{why}: frame {frame + 1}, {measured.tracks.times[frame]:.3f} s{value}"
    return Overlay(text, coded, wide, high, _marks(measured, frame, wide))


def _marks(measured: Measured, frame: int, wide: int) -> str:
    """Markers with their numbers, links and the line of row centres, over a picture."""
    tracks = measured.tracks
    places = tracks.places[frame]
    known = np.isfinite(places).all(axis=1)
    pixels = np.full_like(places, np.nan)
    if known.any():
        pixels[known] = measured.sight.at(measured.motion, frame).pixels(places[known])
    unit = wide / 480.0
    found = []
    if measured.links is not None:
        for back, front in zip(pixels[0::2], pixels[1::2]):
            if np.isfinite(back + front).all():
                found.append(_line([back, front], "#ffffff", 1.2 * unit))
        centres = (pixels[0::2] + pixels[1::2]) / 2.0
        found.append(_line([c for c in centres if np.isfinite(c).all()], "#ffd400", 1.5 * unit))
    for marker in np.flatnonzero(known):
        u, v = pixels[marker]
        colour = charts.STATE_COLOURS[int(tracks.state[frame, marker])]
        found.append(
            f'<circle cx="{u:.1f}" cy="{v:.1f}" r="{7 * unit:.1f}" fill="none" stroke="{colour}" '
            f'stroke-width="{1.6 * unit:.1f}"/>'
            f'<text x="{u + 8 * unit:.1f}" y="{v - 6 * unit:.1f}" font-size="{11 * unit:.1f}" fill="#000" '
            f'stroke="#fff" stroke-width="{2.4 * unit:.1f}" paint-order="stroke" '
            f'font-family="sans-serif">{marker + 1}</text>'
        )
    return "".join(found)


def _line(points: Sequence[AnyArray], colour: str, width: float) -> str:
    path = " ".join(f"{u:.1f},{v:.1f}" for u, v in points)
    return f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width:.1f}"/>'
