"""Charts of tracks as SVG."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from chainmail.camera.measure import Measured
from chainmail.camera.tracks import GAP, PART, REBUILT, SEEN
from cosim.unit.protocol import AnyArray, Array

#: Colours of gap, seen, in part, rebuilt; they stay apart for people who do not see red and green apart.
STATE_COLOURS = ("#c9c9c9", "#0072b2", "#e69f00", "#cc3399")
_LINES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a6d00", "#56b4e9", "#7a3e9d", "#444444")
_WIDTH, _LEFT, _RIGHT, _TOP, _BOTTOM = 900.0, 70.0, 15.0, 12.0, 46.0
#: Most points of a line: of each stretch of a longer one the lowest and the highest are drawn.
_POINTS = 1200


class Axes:
    """A frame with ticks.

    Args:
        x: Least and largest value along x.
        y: Along y.
        height: Of the picture [px].
        labels: Of x and y, with units.
    """

    def __init__(self, x: tuple[float, float], y: tuple[float, float], height: float, labels: tuple[str, str]) -> None:
        self.x, self.y, self.height, self.labels = x, y, height, labels
        self.marks: list[str] = []

    def at(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Pixels of values."""
        wide, high = _WIDTH - _LEFT - _RIGHT, self.height - _TOP - _BOTTOM
        return (
            _LEFT + wide * (x - self.x[0]) / (self.x[1] - self.x[0]),
            _TOP + high * (self.y[1] - y) / (self.y[1] - self.y[0]),
        )

    def line(self, x: Array, y: Array, colour: str, width: float = 1.4) -> None:
        """A line, broken where a value is no number."""
        for piece in _pieces(x, y):
            u, v = self.at(*piece)
            points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(u, v))
            self.marks.append(
                f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}" '
                'stroke-linecap="round"/>'
            )

    def band(self, x: Array, low: Array, high: Array, colour: str) -> None:
        """What is between two lines, broken where one is no number."""
        for (a, bottom), (_, top) in zip(_pieces(x, low + 0.0 * high), _pieces(x, high + 0.0 * low)):
            if len(a) > 1:
                u, v = self.at(np.append(a, a[::-1]), np.append(bottom, top[::-1]))
                points = " ".join(f"{p:.1f},{q:.1f}" for p, q in zip(u, v))
                self.marks.append(f'<polygon points="{points}" fill="{colour}" fill-opacity=".25"/>')

    def text(self, x: float, y: float, words: str, colour: str) -> None:
        """Words at a point."""
        u, v = self.at(np.array([x]), np.array([y]))
        self.marks.append(f'<text x="{u[0] + 4:.1f}" y="{v[0] - 4:.1f}" fill="{colour}">{words}</text>')

    def svg(self) -> str:
        """The picture."""
        right, bottom = _WIDTH - _RIGHT, self.height - _BOTTOM
        found = [f'<svg viewBox="0 0 {_WIDTH:g} {self.height:g}" font-family="sans-serif" font-size="13">']
        for value in ticks(*self.x):
            u = float(self.at(np.array([value]), np.array([self.y[0]]))[0][0])
            found.append(
                f'<path d="M{u:.1f} {_TOP}V{bottom}" stroke="#e4e4e4"/>'
                f'<text x="{u:.1f}" y="{bottom + 17}" text-anchor="middle">{value:g}</text>'
            )
        for value in ticks(*self.y):
            v = float(self.at(np.array([self.x[0]]), np.array([value]))[1][0])
            found.append(
                f'<path d="M{_LEFT} {v:.1f}H{right}" stroke="#e4e4e4"/>'
                f'<text x="{_LEFT - 6}" y="{v + 4:.1f}" text-anchor="end">{value:g}</text>'
            )
        middle = (_TOP + bottom) / 2.0
        found += [
            *self.marks,
            f'<text x="{(_LEFT + right) / 2:.0f}" y="{self.height - 8:g}" text-anchor="middle">{self.labels[0]}</text>',
            f'<text transform="translate(16 {middle:.0f}) rotate(-90)" text-anchor="middle">{self.labels[1]}</text>',
            "</svg>",
        ]
        return "".join(found)


def ticks(low: float, high: float) -> list[float]:
    """Round numbers between two values, four to nine of them."""
    raw = (high - low) / 6.0
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(m for m in (1.0, 2.0, 5.0, 10.0) if m * power >= raw) * power
    first = math.ceil(low / step - 1e-9)
    return [round((first + k) * step, 12) for k in range(math.floor(high / step + 1e-9) - first + 1)]


def curvature_chart(measured: Measured) -> str:
    """Largest curvature over time, with its 95 % interval; empty where no frame has all markers."""
    curvature, times = measured.curvature, measured.tracks.times
    if curvature is None or not np.isfinite(curvature.values).any():
        return ""
    half = 1.96 * curvature.deviation
    low, high = curvature.values - half, curvature.values + half
    top = float(np.nanquantile(high, 0.995)) * 1.08
    axes = Axes(
        _span(times),
        (min(0.0, float(np.nanmin(curvature.values))), max(top, 0.5)),
        300.0,
        ("time [s]", "largest curvature [1/m]"),
    )
    axes.band(times, np.clip(low, axes.y[0], axes.y[1]), np.clip(high, axes.y[0], axes.y[1]), "#0072b2")
    axes.line(times, np.clip(curvature.values, *axes.y), "#0072b2")
    return axes.svg()


def tracks_chart(measured: Measured) -> str:
    """Places of every marker in the plane."""
    places = 1e3 * measured.tracks.places
    y, z = places[..., 0], places[..., 1]
    x_span, y_span = _wider(y), _wider(z)
    wide = _WIDTH - _LEFT - _RIGHT
    high = wide * (y_span[1] - y_span[0]) / (x_span[1] - x_span[0])
    if high > 640.0:  # a tall plane: y gets more room than it needs
        extra = (x_span[1] - x_span[0]) * (high / 640.0 - 1.0) / 2.0
        x_span, high = (x_span[0] - extra, x_span[1] + extra), 640.0
    axes = Axes(x_span, y_span, high + _TOP + _BOTTOM, ("y [mm]", "z [mm]"))
    for marker in range(places.shape[1]):
        colour = _LINES[marker % len(_LINES)]
        axes.line(y[:, marker], z[:, marker], colour, 2.0)
        known = np.flatnonzero(np.isfinite(y[:, marker]))
        if known.size:
            axes.text(float(y[known[0], marker]), float(z[known[0], marker]), str(marker + 1), colour)
    return axes.svg()


def quality_chart(measured: Measured) -> str:
    """How each reading came about: one strip for each marker."""
    tracks = measured.tracks
    count = tracks.markers
    axes = Axes(_span(tracks.times), (0.5, count + 0.5), 22.0 * count + _TOP + _BOTTOM, ("time [s]", "marker"))
    half = 0.5 * float(np.median(np.diff(tracks.times)))
    for marker in range(count):
        for code in (SEEN, PART, REBUILT, GAP):
            for begin, end in _runs(tracks.state[:, marker] == code):
                u, v = axes.at(tracks.times[[begin, end]] + [-half, half], np.array([marker + 1.4, marker + 0.6]))
                axes.marks.append(
                    f'<rect x="{u[0]:.2f}" y="{v[0]:.1f}" width="{max(u[1] - u[0], 0.6):.2f}" '
                    f'height="{v[1] - v[0]:.1f}" fill="{STATE_COLOURS[code]}"/>'
                )
    return axes.svg()


def noise_chart(measured: Measured) -> str:
    """Standard deviation of the places over time."""
    times, deviation = measured.tracks.times, 1e3 * np.max(measured.tracks.deviation, axis=2)
    has = np.isfinite(deviation).any(axis=1)
    filled = np.where(has[:, None], deviation, 0.0)
    low, middle, high = (np.where(has, f(filled, axis=1), np.nan) for f in (np.nanmin, np.nanmedian, np.nanmax))
    axes = Axes(_span(times), (0.0, max(1.1 * float(np.nanmax(high)), 1e-6)), 220.0, ("time [s]", "deviation [mm]"))
    axes.band(times, low, high, "#009e73")
    axes.line(times, middle, "#009e73")
    return axes.svg()


def _span(values: Array) -> tuple[float, float]:
    return float(values[0]), float(values[-1])


def _wider(values: Array) -> tuple[float, float]:
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    margin = 0.06 * (high - low) + 2.0
    return low - margin, high + margin


def _pieces(x: Array, y: Array) -> list[tuple[Array, Array]]:
    """Stretches without a gap; of long lines only the extremes of each short stretch."""
    return [_thinned(x[a : b + 1], y[a : b + 1], len(x)) for a, b in _runs(np.isfinite(y) & np.isfinite(x))]


def _thinned(x: Array, y: Array, whole: int) -> tuple[Array, Array]:
    stretch = max(1, 2 * whole // _POINTS)
    if stretch < 2 or len(x) < 2 * stretch:
        return x, y
    kept: set[int] = {0, len(x) - 1}
    for begin in range(0, len(x), stretch):
        part = y[begin : begin + stretch]
        kept |= {begin + int(np.argmin(part)), begin + int(np.argmax(part))}
    chosen = sorted(kept)
    return x[chosen], y[chosen]


def _runs(holds: AnyArray) -> Sequence[tuple[int, int]]:
    """First and last index of every stretch in which something holds."""
    edges = np.diff(np.concatenate([[0], holds.astype(int), [0]]))
    return list(zip(np.flatnonzero(edges == 1).tolist(), (np.flatnonzero(edges == -1) - 1).tolist()))
