"""One finding on the page: where, when, what, with what it is ambiguous and what would decide."""

from __future__ import annotations

import math

from diagnosis.judge.diagnosis import Estimate, Finding
from diagnosis.report.display import UNKNOWN, clean, listed, number, percent, words
from diagnosis.report.figures import colour
from diagnosis.report.fits import plain_channel
from diagnosis.report.markup import Html, element, folded, joined, listing, table, wrapped
from diagnosis.report.sentences import ambiguity, decisive, fall, what, when, where
from diagnosis.report.user_units import IN_SI, Units


def finding_section(order: int, finding: Finding, units: Units = IN_SI, is_open: bool = False) -> Html:
    """Section of a finding.

    Args:
        order: Its place among the findings, from 0; gives its colour.
        finding: What was found.
        units: In which quantities are shown.
        is_open: Whether the verdict is that nothing can be told: then no finding is one of the rig or of a sensor.
    """
    accepted = f"Finding {order + 1}" + (", not identified" if is_open else "")
    title = accepted if finding.is_accepted else f"Suggestion {order + 1}, not accepted"
    facts = [
        ("Where", where(finding)),
        ("When", when(finding, 12, units)),
        ("Shows in", listed(list(dict.fromkeys(plain_channel(c) for c in finding.channels)), 12) or UNKNOWN),
        ("What", what(finding)),
        ("Law", element("code", finding.law)),
        ("Gain", _gain(finding)),
    ]
    facts += [("Doubt" if finding.is_accepted else "Why not accepted", doubt) for doubt in finding.doubts]
    return element(
        "section",
        element("h2", f"{title}: {finding.statement}"),
        element("dl", *(joined([element("dt", k), element("dd", v)]) for k, v in facts)),
        _parameters(finding.parameters, units),
        element("p", ambiguity(finding)),
        _decisive(finding),
        _alternatives(finding),
        _confusions(finding),
        class_="finding",
        style=f"border-color: {colour(order)}",
    )


def _gain(finding: Finding) -> str:
    told = f"-2 log posterior of the training falls by {number(finding.gain)}"
    if math.isnan(finding.held_out_gain):
        return told
    by = f" ({finding.judged_by})" if finding.judged_by else ""
    return f"{told}, -2 log likelihood of the readings that judge{by} {fall(finding.held_out_gain)}"


def _parameters(estimates: tuple[Estimate, ...], units: Units) -> Html:
    if not estimates:
        return Html("")
    rows = [(element("code", p.name), units.estimate(p), wrapped(p.meaning or UNKNOWN)) for p in estimates]
    return table(("parameter", "estimate (95 % interval)", "what it is"), rows)


def _decisive(finding: Finding) -> Html:
    told = decisive(finding)
    if not finding.ambiguous_with:
        return Html("")
    if not told:
        return element("p", "The catalogue does not say what would decide.")
    return joined([element("p", "What would decide:"), listing(told)])


def _alternatives(finding: Finding) -> Html:
    if not finding.alternatives:
        return Html("")
    rows = [(words(a.effect), clean(a.place), number(a.gain), percent(a.probability)) for a in finding.alternatives]
    return folded("Other explanations that were fitted", table(("effect", "place", "gain", "probability"), rows))


def _confusions(finding: Finding) -> Html:
    rest = {e: text for e, text in finding.confused_with.items() if e not in finding.ambiguous_with}
    if not rest:
        return Html("")
    return folded(
        "Effects that often look alike, and what decides", listing(f"{words(e)}: {text}" for e, text in rest.items())
    )
