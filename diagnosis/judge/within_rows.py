"""Clocks that are early by no more than a row of a recorded input: the rows alone may make them.

What changed between two rows stands in the later one: changes are recorded late, and readings seem to come early by up
to a row. No reading tells that from a clock that is off by as much. A response that comes late is never made so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from cosim.scenario import Scenario
from diagnosis.judge.diagnosis import Finding, Standing
from diagnosis.judge.findings import statement
from diagnosis.recording.recording import Recording
from diagnosis.search.switch_times import row_length

#: Identifier of the law of a clock; its offset is negative where readings come early.
CLOCK = "sensor_clock_offset"


@dataclass(frozen=True)
class Row:
    """How far the rows of a recorded input are apart.

    Args:
        name: `component.output`.
        recording: Title of the recording.
        length: Median time from one row to the next [s].
    """

    name: str
    recording: str
    length: float


def longest_row(scenario: Scenario, recordings: Sequence[Recording]) -> Row | None:
    """The input with the longest rows of those that hold their values and change; None where there is none.

    Args:
        scenario: As the recordings are compared with.
        recordings: Their inputs are looked at.
    """
    found = []
    for recording in recordings:
        for one in recording.inputs:
            if length := row_length(scenario, one):
                found.append(Row(f"{one.component}.{one.output}", recording.title, length))
    return max(found, key=lambda r: r.length, default=None)


def within_rows(
    findings: Sequence[Finding], scenario: Scenario, recordings: Sequence[Recording]
) -> tuple[Finding, ...]:
    """Findings; clocks that are early within a row of a recorded input have no name.

    Args:
        findings: Of a search.
        scenario: As the recordings are compared with.
        recordings: Of the training.
    """
    row = longest_row(scenario, recordings) if any(f.effect == CLOCK for f in findings) else None
    return tuple(findings) if row is None else tuple(_told(f, row) for f in findings)


def _told(finding: Finding, row: Row) -> Finding:
    if finding.effect != CLOCK or not -row.length <= finding.parameters[0].value < 0.0:
        return finding
    why = (
        f"rows of {row.name} in {row.recording} are {row.length:.3g} s apart: what changed between two of them stands "
        "in the later one, so that readings seem to come early by up to a row whatever their clock"
    )
    doubts = (*finding.doubts, why)
    if finding.standing is Standing.UNNAMED:
        return replace(finding, doubts=doubts)
    name = finding.statement.removesuffix(f", {finding.place}")
    told = statement(name, finding.place, Standing.UNNAMED, ())
    return replace(finding, is_named=False, standing=Standing.UNNAMED, doubts=doubts, statement=told)
