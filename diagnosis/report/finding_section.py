"""One finding on the page: where, when, what, with what it is ambiguous and what would decide."""

from __future__ import annotations

import math

from diagnosis.judge.diagnosis import Finding
from diagnosis.report.display import UNKNOWN, listed, number
from diagnosis.report.figures import colour
from diagnosis.report.fits import plain_channel
from diagnosis.report.section import Section, section
from diagnosis.report.sentences import ambiguity, decisive, fall, what, when, where
from diagnosis.report.unit_factor import unit_factor
from diagnosis.report.user_units import IN_SI, Units


def finding_section(order: int, finding: Finding, units: Units = IN_SI, is_open: bool = False) -> Section:
    """Section of a finding.

    Args:
        order: Its place among the findings, from 0; gives its colour.
        finding: What was found.
        units: In which quantities are shown.
        is_open: Whether the verdict is that nothing can be told: then no finding is one of the rig or of a sensor.
    """
    accepted = f"Finding {order + 1}" + (", not identified" if is_open else "")
    title = accepted if finding.is_accepted else f"Suggestion {order + 1}, not accepted"
    shown = listed(list(dict.fromkeys(plain_channel(c) for c in finding.channels)), 12) or UNKNOWN
    doubt = "Doubt" if finding.is_accepted else "Why not accepted"
    return section(
        f"{title}: {finding.statement}",
        "finding.html.j2",
        colour(order),
        finding=finding,
        units=units.of(finding.place),
        before=[
            ("Where", where(finding)),
            ("When", when(finding, 12, units)),
            ("Shows in", shown),
            ("What", what(finding)),
        ],
        after=[("Gain", _gain(finding)), *((doubt, text) for text in finding.doubts), *_unit(finding)],
        ambiguity=ambiguity(finding),
        decisive=decisive(finding),
        confusions={e: text for e, text in finding.confused_with.items() if e not in finding.ambiguous_with},
    )


def _unit(finding: Finding) -> list[tuple[str, str]]:
    told = unit_factor(finding)
    return [("Unit", told)] if told else []


def _gain(finding: Finding) -> str:
    told = f"-2 log posterior of the training falls by {number(finding.gain)}"
    if math.isnan(finding.held_out_gain):
        return told
    by = f" ({finding.judged_by})" if finding.judged_by else ""
    return f"{told}, -2 log likelihood of the readings that judge{by} {fall(finding.held_out_gain)}"
