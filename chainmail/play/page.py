"""A film as one HTML file that opens without a network."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from chainmail.play.camera import reach_of
from chainmail.play.codec import Block, encode, quantised
from chainmail.play.film import Curve, Fabric, Film, Marks, Shape
from chainmail.play.palette import GHOSTS, palette
from cosim.html_page import environment
from cosim.unit.protocol import Array

#: Largest error of any point of a link on the page [m].
LARGEST_ERROR = 10e-6
#: Steps of positions and of the distance of two bars [m]; what they leave of the error, orientations may take.
_STEP = 4e-6
#: Steps of a recorded coordinate [m].
_RECORDED_STEP = 2e-5
#: Steps into which the range of a quantity is divided: as many as there are colours; and that of a curve.
_COLOUR_STEPS, _CURVE_STEPS = 255, 4000
_WEB = Path(__file__).parent / "web"
_SCRIPTS = ("decode.js", "scene.js", "plots.js", "controls.js", "player.js")


def page(film: Film) -> str:
    """The whole page as text.

    Source: docs/play.md says what it shows; docs/decisions/0013-own-renderer.md why it draws by itself.
    """
    blocks = _Blocks()
    content = _content(film, blocks)
    data, table = encode(blocks.blocks)
    text = json.dumps({**content, "blocks": table}, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    template = environment(_WEB).get_template("page.html.j2")
    scripts = "\n".join((_WEB / name).read_text(encoding="utf-8") for name in _SCRIPTS)
    return template.render(
        title=" and ".join(dict.fromkeys(f.title for f in film.fabrics)),
        style=(_WEB / "player.css").read_text(encoding="utf-8"),
        film=text,
        data=data,
        scripts=scripts.replace("</script", "<\\/script"),
    )


def orientation_step(shape: Shape, bar_distance: float) -> float:
    """Step of the parts of a quaternion for which no point of a link is off by more than `LARGEST_ERROR`.

    A middle rounded to steps s is off by at most sqrt(3) s / 2, and a bar, by its distance, by s / 4. Four parts
    rounded to steps q change the quaternion by at most q, and thus, normalised, turn the link by at most 2 q.

    Args:
        shape: Of a link.
        bar_distance: The largest distance of its bars [m].
    """
    reach = math.hypot(shape.outer_width / 2, (bar_distance + shape.bar_diameter) / 2, shape.bar_diameter / 2)
    return (LARGEST_ERROR - (math.sqrt(3) / 2 + 1 / 4) * _STEP) / (2.02 * reach)


class _Blocks:
    """Blocks in the order in which they are asked for, each with a name of its own."""

    def __init__(self) -> None:
        self.blocks: list[Block] = []
        self._names = map(str, count())

    def add(self, values: Array, step: float) -> str:
        """Keep series, shape (series, frames); returns the block's name."""
        name = next(self._names)
        self.blocks.append(quantised(name, np.asarray(values, dtype=np.float64), step))
        return name

    def times(self, times: Array) -> str:
        """Keep times [s], to a microsecond where they last below a minute or two."""
        return self.add(times[None, :], max(1e-6, float(np.ptp(times)) / 1e8))

    def curve(self, values: Array | None) -> str | None:
        """Keep the values of a curve, to a share of their range."""
        return None if values is None else self.add(values[None, :], _step(float(np.ptp(values)), _CURVE_STEPS))


def _step(span: float, steps: int) -> float:
    return span / steps if span > 0 else 1.0


def _series(values: Array) -> Array:
    """(frames, ...) as (series, frames)."""
    return values.reshape(len(values), -1).T


def _content(film: Film, blocks: _Blocks) -> dict[str, Any]:
    ranges = ranges_of(film.fabrics)
    reach = reach_of(film)
    return {
        "fabrics": [_fabric(fabric, ranges, blocks) for fabric in film.fabrics],
        "marks": [_marks(marks, blocks) for marks in film.marks],
        "plots": _plots(film, blocks),
        "findings": [
            {
                "text": f.text,
                "place": f.place,
                "links": f.links,
                "coils": f.coils,
                "intervals": f.intervals,
                "isAccepted": f.is_accepted,
            }
            for f in film.findings
        ],
        "ranges": {name: {"low": a, "high": b, "unit": unit} for name, (a, b, unit) in ranges.items()},
        "ghosts": GHOSTS.tolist(),
        "palette": palette().ravel().tolist(),
        "corners": reach.corners.round(5).tolist(),
        "margin": reach.margin,
        "notes": film.all_notes(),
    }


def ranges_of(fabrics: Iterable[Fabric]) -> dict[str, tuple[float, float, str]]:
    """Quantity to its lowest and highest value in all fabrics, and its unit."""
    found: dict[str, tuple[float, float, str]] = {}
    for quantity in (q for fabric in fabrics for q in fabric.fields):
        low, high = float(quantity.values.min()), float(quantity.values.max())
        before = found.get(quantity.name, (low, high, ""))
        found[quantity.name] = min(low, before[0]), max(high, before[1]), quantity.unit
    return found


def _fabric(fabric: Fabric, ranges: dict[str, tuple[float, float, str]], blocks: _Blocks) -> dict[str, Any]:
    step = orientation_step(fabric.shape, float(fabric.bar_distance.max()))
    return {
        "title": fabric.title,
        "size": fabric.size,
        "links": fabric.links,
        "row": fabric.row.tolist(),
        "place": fabric.place.tolist(),
        "held": fabric.is_held.astype(int).tolist(),
        "diameter": fabric.shape.bar_diameter,
        "width": fabric.shape.outer_width,
        "times": blocks.times(fabric.times),
        "position": blocks.add(_series(fabric.position), _STEP),
        "orientation": blocks.add(_series(fabric.orientation), step),
        "distance": blocks.add(_series(fabric.bar_distance), _STEP),
        "fields": [
            {
                "name": q.name,
                "block": blocks.add(_series(q.values), _step(ranges[q.name][1] - ranges[q.name][0], _COLOUR_STEPS)),
            }
            for q in fabric.fields
        ],
    }


def _marks(marks: Marks, blocks: _Blocks) -> dict[str, Any]:
    return {
        "title": marks.title,
        "points": [
            {
                "kind": point.kind,
                "number": point.number,
                "axes": [
                    None
                    if track is None
                    else {
                        "times": blocks.times(track.times),
                        "values": blocks.add(track.values[None, :], _RECORDED_STEP),
                        "gap": track.gap,
                    }
                    for track in point.axes
                ],
            }
            for point in marks.points
        ],
    }


def _plots(film: Film, blocks: _Blocks) -> list[dict[str, Any]]:
    """Plots of the first fabric in their order, then those that only others have."""
    owned: list[tuple[int | None, int | None, Curve]] = []
    owned += [(n, None, curve) for n, fabric in enumerate(film.fabrics) for curve in fabric.curves]
    owned += [(None, n, curve) for n, marks in enumerate(film.marks) for curve in marks.curves]
    found: dict[str, dict[str, Any]] = {}
    for fabric, mark, curve in owned:
        plot = found.setdefault(curve.plot, {"title": curve.plot, "unit": curve.unit, "curves": []})
        plot["curves"].append(
            {
                "fabric": fabric,
                "mark": mark,
                "label": curve.label,
                "times": blocks.times(curve.times),
                "values": blocks.curve(curve.values),
                "lower": blocks.curve(curve.lower),
                "upper": blocks.curve(curve.upper),
            }
        )
    return list(found.values())
