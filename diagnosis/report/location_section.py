"""Where the recalibrated model departs, unit by unit, the input that is missing there, and what is left at the end."""

from __future__ import annotations

from collections.abc import Sequence

from diagnosis.judge.location import Location, Remainder, Waveform
from diagnosis.report.course_figures import waveform_figure
from diagnosis.report.display import UNKNOWN, clean, listed, number
from diagnosis.report.section import Cell, Section, section
from diagnosis.report.undecided import mean_left
from diagnosis.report.user_units import IN_SI, Units

#: Lines of the table and waveforms that are shown; the rest is in diagnosis.json.
_LINES, _WAVEFORMS = 10, 4


def location_section(locations: Sequence[Location], units: Units = IN_SI) -> Section:
    """Table of units that were driven alone."""
    is_whole, is_noise = any(one.is_whole for one in locations), all(one.is_noise for one in locations)
    title = "Each unit driven alone"
    if is_whole:
        title = "Where most is left" if is_noise else "Where it departs"
    return section(
        title,
        "location.html.j2",
        rows=[_line(one, units) for one in locations[:_LINES]],
        more=len(locations) - _LINES,
        is_whole=is_whole,
        is_noise=is_noise,
    )


def _line(one: Location, units: Units) -> list[str | Cell]:
    goes = listed([f"{d.variable} ({d.correlation:+.2f})" for d in one.depends_on], 2) or UNKNOWN
    return [
        one.unit,
        Cell(one.equation, "text"),
        one.element,
        Cell(one.channel, "text"),
        units.span(one.begin, one.end),
        Cell(number(abs(one.z)), "met" if one.is_noise else "missed"),
        number(one.limit),
        Cell(goes, "text"),
    ]


def waveform_section(waveforms: Sequence[Waveform], units: Units = IN_SI) -> Section | None:
    """Figures of the unknown inputs; None where all of them may be 0."""
    resolved = [w for w in waveforms if any(low > 0.0 or up < 0.0 for low, up in zip(w.lower, w.upper))]
    if not resolved:
        return None
    return section(
        "The missing input",
        "waveforms.html.j2",
        drawn=[(_caption(one), waveform_figure(one, units)) for one in resolved[:_WAVEFORMS]],
        unresolved=len(waveforms) - len(resolved),
    )


def _caption(one: Waveform) -> str:
    whose = f" (finding {one.finding})" if one.finding else ""
    return f"{clean(one.element)}: {clean(one.equation)}{whose}"


def remainder_section(left: Sequence[Remainder], units: Units = IN_SI) -> Section:
    """What no model explains."""
    rows = [
        (r.channel, units.span(r.begin, r.end), mean_left(r, units) or UNKNOWN, number(r.z), number(r.limit))
        for r in left
    ]
    return section("What is left", "left.html.j2", rows=rows)
