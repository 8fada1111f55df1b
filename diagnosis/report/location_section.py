"""Where the recalibrated model departs, unit by unit, the input that is missing there, and what is left at the end."""

from __future__ import annotations

from collections.abc import Sequence

from diagnosis.judge.location import Location, Remainder, Waveform
from diagnosis.report.course_figures import waveform_figure
from diagnosis.report.display import UNKNOWN, clean, listed, number
from diagnosis.report.markup import Html, element, image, table, wrapped
from diagnosis.report.undecided import mean_left
from diagnosis.report.user_units import IN_SI, Units

#: Lines of the table and waveforms that are shown; the rest is in diagnosis.json.
_LINES, _WAVEFORMS = 10, 4


def location_section(locations: Sequence[Location], units: Units = IN_SI) -> Html:
    """Table of units that were driven alone; nothing where none was."""
    if not locations:
        return Html("")
    head = ("unit", "equation", "element", "channel", "window", "z", "limit", "goes with")
    rows = [_line(one, units) for one in locations[:_LINES]]
    more = len(locations) - _LINES
    if any(one.is_whole for one in locations):
        title, driven = (
            "Where most is left" if all(one.is_noise for one in locations) else "Where it departs",
            "No unit could be driven alone: these are residuals of the whole simulation.",
        )
    else:
        title = "Each unit driven alone"
        driven = "Each unit was driven alone with the recorded inputs, the noise of their sensors carried along."
    rest = element("p", f"And {more} more in diagnosis.json.", class_="note") if more > 0 else ""
    note = (
        f"{driven} z is the largest standardised sum of residuals; noise alone stays below the limit in 99 of 100 "
        "recordings." + (" None exceeds it." if all(one.is_noise for one in locations) else "")
    )
    return element("section", element("h2", title), table(head, rows), rest, element("p", note, class_="note"))


def _line(one: Location, units: Units) -> list[str]:
    goes = listed([f"{d.variable} ({d.correlation:+.2f})" for d in one.depends_on], 2) or UNKNOWN
    z = element("td", number(abs(one.z)), class_="met" if one.is_noise else "missed")
    return [
        one.unit,
        wrapped(clean(one.equation)),
        clean(one.element),
        wrapped(clean(one.channel)),
        units.span(one.begin, one.end),
        z,
        number(one.limit),
        wrapped(goes),
    ]


def waveform_section(waveforms: Sequence[Waveform]) -> Html:
    """Figures of the unknown inputs; nothing where none was estimated."""
    resolved = [w for w in waveforms if any(low > 0.0 or up < 0.0 for low, up in zip(w.lower, w.upper))]
    if not resolved:
        return Html("")
    drawn = []
    for one in resolved[:_WAVEFORMS]:
        whose = f" (finding {one.finding})" if one.finding else ""
        caption = f"{clean(one.element)}: {clean(one.equation)}{whose}"
        drawn.append(
            element(
                "figure",
                element("figcaption", caption),
                image(waveform_figure(one), f"{caption}: estimate with 95 % band"),
            )
        )
    note = "The input that would have to be added for the unit to give what was measured, without any law assumed."
    if len(resolved) < len(waveforms):
        note += f" {len(waveforms) - len(resolved)} more cannot be told from 0 anywhere: see diagnosis.json."
    return element("section", element("h2", "The missing input"), *drawn, element("p", note, class_="note"))


def remainder_section(left: Sequence[Remainder], units: Units = IN_SI) -> Html:
    """What no model explains; nothing where only noise is left."""
    if not left:
        return Html("")
    rows = [
        (clean(r.channel), units.span(r.begin, r.end), mean_left(r, units) or UNKNOWN, number(r.z), number(r.limit))
        for r in left
    ]
    note = (
        "z: standardised sums of what the last model leaves; noise alone stays below the limit in 99 of 100 recordings."
    )
    head = ("channel", "window", "measured - simulated, mean", "z", "limit")
    return element("section", element("h2", "What is left"), table(head, rows), element("p", note, class_="note"))
