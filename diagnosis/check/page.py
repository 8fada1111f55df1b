"""The page of `cosim recording check`: measured beside simulated, inputs, doubts; one file, offline."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cosim.figure_style import SWITCH, WITH_MODEL
from cosim.html_page import environment
from cosim.run_folder import write_atomically
from diagnosis.check.beside import Beside, Compared, Course
from diagnosis.check.inputs import compare_inputs
from diagnosis.check.tables import course_text, input_text, row, summary
from diagnosis.judge.diagnosis import Doubt
from diagnosis.report.figures import drawn, thinned
from diagnosis.report.section import TEMPLATES

#: Channels of one quantity that are drawn; a rig of 36 coils would need a page of its own.
MOST_DRAWN = 6


def write_page(every: Sequence[Compared], doubts: Sequence[Doubt], out: Path) -> None:
    """Write the page.

    Args:
        every: Recordings beside their simulation.
        doubts: About them.
        out: HTML file.
    """
    template = environment(Path(__file__).parent / "templates", TEMPLATES).get_template("check.html.j2")
    recordings = [_recording(one, doubts) for one in every]
    page = template.render(summary=summary(every, doubts), doubts=doubts, recordings=recordings)
    write_atomically(out, page.encode(), is_shared=True)


def _recording(one: Compared, doubts: Sequence[Doubt]) -> dict[str, object]:
    clock = one.units.scale(one.end, "s")
    rows = [row(b, one.units_of(b.channel.name), clock) for b in one.channels.values()]
    own = [d for d in doubts if d.recording == one.recording.title]
    return {
        "title": one.recording.title,
        "note": one.note,
        "clock": clock.unit,
        "rows": [(r.name, r.samples, r.span, r.noise, *r.ranges, *r.fit) for r in rows],
        "inputs": [
            *(course_text(c, one.units) for c in one.courses),
            *(input_text(c) for c in compare_inputs(one)),
        ],
        "picture": picture(one, own),
    }


def picture(one: Compared, doubts: Sequence[Doubt]) -> str:
    """Data address of a figure: what drives the rig on top, below it every quantity, measured and simulated."""
    courses = [c for c in one.courses if len(c.times) > 1]
    chosen = _chosen(one, doubts)
    rows = len(chosen) + bool(courses)
    return drawn(lambda f: _paint(f, one, courses, chosen, doubts), 8.4, 0.6 + 1.7 * rows)


def _chosen(one: Compared, doubts: Sequence[Doubt]) -> list[Beside]:
    """Of every quantity a few channels, those in doubt first."""
    doubted = {name for d in doubts for name in d.subject.split(", ")}
    kinds: dict[tuple[str, str], list[Beside]] = {}
    for b in sorted(one.channels.values(), key=lambda b: b.channel.name not in doubted):
        kinds.setdefault((b.channel.target.kind, b.channel.target.quantity), []).append(b)
    return [b for members in kinds.values() for b in members[:MOST_DRAWN]]


def _paint(
    figure: Figure, one: Compared, courses: Sequence[Course], chosen: Sequence[Beside], doubts: Sequence[Doubt]
) -> None:
    panels = figure.subplots(len(chosen) + bool(courses), 1, sharex=True, squeeze=False)[:, 0]
    if courses:
        _paint_courses(panels[0], one, courses)
    for axes, beside in zip(panels[bool(courses) :], chosen):
        channel = beside.channel
        scaled = one.units.axis(channel.values, channel.unit)
        if beside.simulated is not None:
            keep = thinned(beside.simulated.values)
            axes.plot(
                beside.simulated.times[keep],
                scaled(beside.simulated.values[keep]),
                color=WITH_MODEL,
                lw=1.2,
                label="simulated",
            )
        keep = thinned(channel.values)
        axes.plot(channel.times[keep], scaled(channel.values[keep]), ".", ms=2.5, color="#2d3748", label="measured")
        for instant in one.switches() if len(one.switches()) <= 40 else ():
            axes.axvline(instant, color=SWITCH, lw=0.6, alpha=0.5)
        for doubt in doubts:
            is_part = doubt.end - doubt.begin < 0.999 * (one.end - one.begin)
            if channel.name in doubt.subject.split(", ") and is_part:
                axes.axvspan(
                    doubt.begin, doubt.end, color="#c53030" if doubt.is_serious else "#b7791f", alpha=0.18, lw=0
                )
        axes.set_ylabel(f"{channel.target.quantity} [{scaled.unit}]" if scaled.unit else channel.target.quantity)
        axes.set_title(channel.name, loc="left", fontsize=8)
        axes.legend(loc="upper right", frameon=False, fontsize=7)
    panels[-1].set(xlabel="time [s]", xlim=(one.begin, one.end))


def _paint_courses(axes: Axes, one: Compared, courses: Sequence[Course]) -> None:
    for c in courses:
        times = np.append(c.times, max(one.end, c.times[-1]))
        values = np.append(c.values, c.values[-1])
        name = f"{c.name} ({'recorded' if c.is_recorded else 'programme'})"
        axes.step(times, values, where="post", lw=1.2, label=name)
    axes.set_ylabel(f"[{courses[0].unit}]" if len({c.unit for c in courses}) == 1 else "inputs")
    axes.set_title("inputs", loc="left", fontsize=8)
    axes.legend(loc="upper right", frameon=False, fontsize=7)
