"""Figures of the report as data addresses: network, time line, channels."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Sequence
from typing import Any, cast

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch, Rectangle
from matplotlib.ticker import FuncFormatter, MaxNLocator
from numpy.typing import NDArray

from cosim.figure_style import COLD, HOT, RECOOLED, WITH_MODEL, WITHOUT_MODEL
from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Finding
from diagnosis.judge.location import Remainder
from diagnosis.report.display import clean
from diagnosis.report.fits import is_channel
from diagnosis.report.network import Network, concerned
from diagnosis.report.series import Series
from diagnosis.report.user_units import IN_SI, Units

#: One colour for each finding, in their order.
FINDING_COLOURS = (HOT, COLD, RECOOLED, "#b7791f", "#6b46c1")
#: Looks of the curves of each stage.
STAGE_LOOKS: dict[str, dict[str, Any]] = {
    "before": {"color": WITHOUT_MODEL, "ls": ":", "lw": 1.2},
    "recalibrated": {"color": "#d97706", "ls": "--", "lw": 1.2},
    "after": {"color": WITH_MODEL, "ls": "-", "lw": 1.2},
}
#: Points of a curve that a figure shows; more would only make the file larger.
_POINTS = 1200
_WIRE, _COIL = "#718096", "#edf2f7"


def colour(number: int) -> str:
    """Colour of a finding, counted from 0."""
    return FINDING_COLOURS[number % len(FINDING_COLOURS)]


def drawn(paint: Callable[[Figure], None], width: float, height: float) -> str:
    """Data address of an SVG; the same drawing gives the same bytes."""
    look = {
        "font.size": 9,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "svg.hashsalt": "report",
        "text.parse_math": False,
    }
    with mpl.rc_context(cast(Any, look)):
        figure = Figure(figsize=(width, height), layout="constrained")
        FigureCanvasSVG(figure)
        paint(figure)
        stream = io.BytesIO()
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    return "data:image/svg+xml;base64," + base64.b64encode(stream.getvalue()).decode("ascii")


def network_figure(network: Network, findings: Sequence[Finding]) -> str:
    """Strings of coils across the supply, what findings concern in their colours."""
    longest, count = max(network.strings), len(network.strings)
    height = min(0.85 + 0.38 * count, 9.0)
    return drawn(lambda f: _paint_network(f.subplots(), network, findings), min(2.0 + 0.62 * longest, 9.0), height)


def _paint_network(axes: Axes, network: Network, findings: Sequence[Finding]) -> None:
    longest, count = max(network.strings), len(network.strings)
    marks = [concerned(f, network) for f in findings]
    for x in (0.2, longest + 0.8):
        axes.plot([x, x], [1, count], color=_WIRE, lw=1.2, zorder=1)
    for s, coils in enumerate(network.strings, start=1):
        axes.plot([0.2, longest + 0.8], [s, s], color=_WIRE, lw=1.2, zorder=1)
        own = [n for n, m in enumerate(marks) if s in m.strings]
        for n in own:
            axes.add_patch(Rectangle((0.3, s - 0.42), longest + 0.4, 0.84, fc=colour(n), alpha=0.18, ec=colour(n)))
        axes.text(
            longest + 1.0,
            s,
            f"string {s}",
            va="center",
            color=colour(own[0]) if own else "#4a5568",
            weight="bold" if own else "normal",
        )
        for c in range(1, coils + 1):
            hit = [n for n, m in enumerate(marks) if (s, c) in m.coils]
            _paint_coil(axes, c, s, [colour(n) for n in hit])
    for c in range(1, longest + 1):
        axes.text(c, 0.35, str(c), ha="center", va="center", color="#4a5568")
    supply = next((colour(n) for n, m in enumerate(marks) if m.supply), None)
    middle = (1 + count) / 2
    axes.plot(
        [0.2, -0.6, -0.6, longest + 0.8, longest + 0.8],
        [middle, middle, count + 0.8, count + 0.8, count],
        color=_WIRE,
        lw=1.2,
        zorder=1,
    )
    axes.text(
        -0.6,
        middle,
        "supply",
        ha="center",
        va="center",
        color="white" if supply else "black",
        zorder=3,
        bbox={"boxstyle": "circle,pad=0.25", "fc": supply or "white", "ec": supply or _WIRE},
    )
    axes.set(xlim=(-1.3, longest + 2.1), ylim=(count + 1.0, 0.1))
    axes.axis("off")


def _paint_coil(axes: Axes, x: float, y: float, colours: Sequence[str]) -> None:
    box = FancyBboxPatch(
        (x - 0.3, y - 0.2),
        0.6,
        0.4,
        boxstyle="round,pad=0,rounding_size=0.12",
        zorder=2,
        fc=colours[0] if colours else _COIL,
        ec=colours[-1] if colours else _WIRE,
        lw=2.5 if len(colours) > 1 else 1.0,
    )
    axes.add_patch(box)
    turns = np.linspace(-0.2, 0.2, 41)
    axes.plot(x + turns, y + 0.09 * np.sin(turns * 10 * np.pi), color="white" if colours else _WIRE, lw=0.8, zorder=3)


class _ScaledLocator(MaxNLocator):
    """Round ticks in a unit that is `factor` times the unit of the axis."""

    def __init__(self, factor: float) -> None:
        super().__init__(nbins=8, steps=[1, 2, 2.5, 5, 10])
        self._factor = factor

    def tick_values(self, vmin: float, vmax: float) -> list[float]:
        """Ticks, on the axis."""
        return [float(t) / self._factor for t in super().tick_values(self._factor * vmin, self._factor * vmax)]


def with_clock(axes: Axes, units: Units, end: float) -> None:
    """Axis of time in the unit in which the report names instants.

    Args:
        axes: Drawn over seconds.
        units: That the user wrote.
        end: Last instant [s].
    """
    scale = units.scale(end, "s")
    axes.set_xlabel(labelled("time", scale.unit))
    if scale.factor != 1.0:
        axes.xaxis.set_major_locator(_ScaledLocator(scale.factor))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda t, _: f"{scale.factor * t:.10g}"))


def timeline_figure(findings: Sequence[Finding], begin: float, end: float, units: Units = IN_SI) -> str:
    """Bars where each finding shows, over the recording."""
    height = 0.75 + 0.3 * len(findings)
    return drawn(lambda f: _paint_timeline(f.subplots(), findings, begin, end, units), 8.4, height)


def _paint_timeline(axes: Axes, findings: Sequence[Finding], begin: float, end: float, units: Units) -> None:
    shortest = 0.004 * (end - begin)
    for n, finding in enumerate(findings):
        axes.axhline(n, color="#e2e8f0", lw=8, zorder=0, solid_capstyle="butt")
        for a, b in finding.intervals:
            axes.barh(n, max(b - a, shortest), left=a, height=0.6, color=colour(n))
    names = [_shortened(f"{n}: {clean(f.effect).replace('_', ' ')}") for n, f in enumerate(findings, start=1)]
    axes.set_yticks(range(len(findings)), names)
    axes.set(xlim=(begin, end), ylim=(len(findings) - 0.4, -0.6))
    with_clock(axes, units, end)
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)


def _shortened(text: str, most: int = 44) -> str:
    return text if len(text) <= most else text[: most - 1] + "…"


def series_figure(
    series: Series, findings: Sequence[Finding], left: Sequence[Remainder] = (), units: Units = IN_SI
) -> str:
    """Measured values and the models' above, what the last two models leave below; shaded: findings, what is left."""
    return drawn(lambda f: _paint_series(f, series, findings, left, units), 8.4, 4.4)


def _paint_series(
    figure: Figure, series: Series, findings: Sequence[Finding], left: Sequence[Remainder], units: Units
) -> None:
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    curves = series.curves
    scaled = units.of(series.channel).axis(series.measured, series.unit)
    keep = thinned(series.measured)
    upper.plot(series.times[keep], scaled(series.measured[keep]), ".", ms=2.5, color="#2d3748", label="measured")
    for name, values in curves.items():
        keep = thinned(values)
        upper.plot(series.times[keep], scaled(values[keep]), label=_labels(curves)[name], **STAGE_LOOKS[name])
    factor, of_difference = units.of(series.channel).difference(series.unit)
    noise = 2.0 * factor * np.broadcast_to(np.asarray(series.deviation, dtype=np.float64), series.times.shape)
    keep = np.array([0, -1]) if np.ndim(series.deviation) == 0 else thinned(noise)
    lower.fill_between(
        series.times[keep], -noise[keep], noise[keep], color="#cbd5e0", lw=0, label="2 deviations of the sensor"
    )
    for name, values in curves.items():
        residual = factor * (series.measured - values)
        keep = thinned(residual)
        lower.plot(series.times[keep], residual[keep], **{**STAGE_LOOKS[name], "lw": 0.9})
    lower.set_ylim(*residual_limits(series, factor))
    for axes in (upper, lower):
        _shade(axes, series, findings, left)
    upper.set_ylabel(labelled(clean(series.channel).rpartition(".")[2], scaled.unit))
    lower.set_ylabel(labelled("residual", of_difference))
    lower.set(xlim=_limits(series.times))
    with_clock(lower, units, float(series.times[-1]))
    figure.legend(loc="outside upper left", frameon=False, ncols=5, fontsize=8)


def is_left_in(left: Remainder, series: Series) -> bool:
    """Whether something is left in this channel of this recording."""
    return not series.is_held_out and is_channel(left.channel, series.channel, series.recording)


def _shade(axes: Axes, series: Series, findings: Sequence[Finding], left: Sequence[Remainder]) -> None:
    """Where findings show and where more than noise is left."""
    if series.is_held_out:  # these are times of the training: another programme has others
        return
    for n, finding in enumerate(findings):
        is_here = finding.recording in ("", series.recording)
        if is_here and any(is_channel(c, series.channel, series.recording) for c in finding.channels):
            for a, b in finding.intervals:
                axes.axvspan(a, b, color=colour(n), alpha=0.07, lw=0)
    for one in left:
        if is_left_in(one, series):
            axes.axvspan(one.begin, one.end, color="black", alpha=0.15, lw=0)


def residual_limits(series: Series, factor: float) -> tuple[float, float]:
    """Of the axis below: all that fitted models leave; the model before them may leave the picture."""
    fitted = (series.recalibrated, series.after)
    last = [np.abs(series.measured - v) for v in fitted]
    sizes = [float(np.nanmax(v, initial=0.0)) for v in (*last, np.asarray(2.5 * np.asarray(series.deviation)))]
    size = factor * max([s for s in sizes if np.isfinite(s)], default=1.0) or 1.0
    return -1.08 * size, 1.08 * size


def _labels(curves: dict[str, Array]) -> dict[str, str]:
    """Names of the curves; one that stands for several stages says so."""
    order = list(STAGE_LOOKS)
    own = [order.index(name) for name in curves]
    ends = [*own[1:], len(order)]
    return {name: " = ".join(order[a:b]) for name, a, b in zip(curves, own, ends)}


def labelled(name: str, unit: str) -> str:
    """Name of an axis with its unit."""
    return f"{name.replace('_', ' ')} [{unit}]" if unit else name.replace("_", " ")


def _limits(times: Array) -> tuple[float, float]:
    begin, end = float(times[0]), float(times[-1])
    return (begin, end) if end > begin else (begin - 0.5, end + 0.5)


def thinned(values: Array, most: int = _POINTS) -> NDArray[np.int64]:
    """Indices of at most about `most` values: of each stretch the smallest and the largest, so that peaks stay.

    Not finite values are left out where thinning is needed.
    """
    if len(values) <= most:
        return np.arange(len(values), dtype=np.int64)
    finite = np.flatnonzero(np.isfinite(values))
    pieces = [p for p in np.array_split(finite, most // 2) if len(p)]
    ends = {int(i) for p in pieces for i in (p[np.argmin(values[p])], p[np.argmax(values[p])])}
    return np.array(sorted(ends), dtype=np.int64)
