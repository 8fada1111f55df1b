"""One offline page: overlays on chosen frames, tracks, curvature and quality over time."""

from __future__ import annotations

import base64
import html
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from chainmail.camera import charts
from chainmail.camera.frames import Frame
from chainmail.camera.measure import Measured
from chainmail.camera.opencv import opencv
from chainmail.camera.rig import Rig
from chainmail.camera.summary import summary
from chainmail.camera.tracks import GAP, STATES
from cosim.run_folder import write_atomically
from cosim.unit.protocol import AnyArray

#: Widest overlay [px], and quality of its picture.
_WIDE, _QUALITY = 960, 80
_STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.45 system-ui, sans-serif; color: #1a1a1a; background: #fff; margin: 0 auto; padding: 1rem;
  max-width: 62rem; }
h1 { font-size: 1.35rem; } h2 { font-size: 1.1rem; margin-top: 2rem; }
.chart { overflow-x: auto; } .chart svg { min-width: 34rem; }
svg, img { max-width: 100%; height: auto; } figure { margin: 1rem 0; } figcaption { color: #444; font-size: .9rem; }
.frames { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 26rem), 1fr)); gap: 1rem; }
.frames figure { margin: 0; } .frame { position: relative; } .frame img, .frame svg { display: block; width: 100%; }
.frame svg { position: absolute; inset: 0; height: 100%; }
.key span { display: inline-block; margin-right: 1.2rem; white-space: nowrap; }
.key i { display: inline-block; width: .8rem; height: .8rem; margin-right: .35rem; vertical-align: -1px; }
"""


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
    chosen = chosen_frames(measured)
    parts = [
        f"<h1>{html.escape(rig.title)}</h1>",
        "<ul>" + "".join(f"<li>{html.escape(s)}</li>" for s in summary(measured)) + "</ul>",
        "<h2>Chosen frames</h2>",
        _key(),
        '<div class="frames">',
        *_overlays(measured, chosen, frames),
        "</div>",
    ]
    if measured.curvature is not None:
        parts += [
            "<h2>Largest curvature</h2>",
            charts.curvature_chart(measured),
            "<p>Line: reading; band: 95 % interval of each reading. No line: a gap.</p>",
        ]
    parts += [
        "<h2>Tracks in the plane</h2>",
        charts.tracks_chart(measured),
        "<p>Each colour is a marker; the number stands at its first place.</p>",
        "<h2>How each reading came about</h2>",
        _key(),
        charts.quality_chart(measured),
        "<h2>Standard deviation of the places</h2>",
        charts.noise_chart(measured),
        "<p>Line: median over the markers; band: from the surest to the least sure one.</p>",
    ]
    parts = [f'<div class="chart">{p}</div>' if p.startswith("<svg") else p for p in parts]
    page = (
        '<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" '
        f'content="width=device-width, initial-scale=1"><title>{html.escape(rig.title)}</title>'
        f"<style>{_STYLE}</style></head><body>{''.join(parts)}</body></html>"
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


def _overlays(measured: Measured, chosen: dict[int, str], frames: Iterable[Frame]) -> list[str]:
    found = []
    for number, frame in enumerate(frames):
        if number in chosen:
            found.append(_overlay(measured, number, chosen[number], frame.picture))
        if number >= max(chosen):
            break
    return found


def _overlay(measured: Measured, frame: int, why: str, picture: AnyArray) -> str:
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
    return (
        f'<figure><div class="frame"><img alt="{html.escape(text)}" src="data:image/jpeg;base64,{coded}">'
        f'<svg viewBox="0 0 {wide} {high}" preserveAspectRatio="none">{_marks(measured, frame, wide)}</svg></div>'
        f"<figcaption>{html.escape(text)}</figcaption></figure>"
    )


def _marks(measured: Measured, frame: int, wide: int) -> str:
    """Markers with their numbers, links and the line of row centres, over a picture."""
    tracks = measured.tracks
    places = tracks.places[frame]
    known = np.isfinite(places).all(axis=1)
    pixels = np.full_like(places, np.nan)
    if known.any():
        pixels[known] = measured.sight.pixels(places[known])
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


def _key() -> str:
    spans = "".join(f'<span><i style="background:{c}"></i>{s}</span>' for c, s in zip(charts.STATE_COLOURS, STATES))
    return f'<p class="key">{spans}</p>'
