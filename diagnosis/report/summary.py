"""The answer in the terminal, in at most 40 lines."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator

from rich.console import Console
from rich.text import Text

from diagnosis.judge.diagnosis import MOVED, Diagnosis, Finding, Verdict
from diagnosis.judge.next_experiment import NextExperiment
from diagnosis.report.display import clean, number
from diagnosis.report.fits import STAGES, Row, rows
from diagnosis.report.sentences import (
    ambiguity,
    clocks,
    decisive,
    doubt_text,
    effort,
    improvement,
    moved_most,
    moved_text,
    searched,
    structure,
    sureness,
    thinning,
    what,
    when,
    where,
)
from diagnosis.report.undecided import model_note, remainder, what_decides
from diagnosis.report.unit_factor import unit_factor
from diagnosis.report.user_units import Units, units_of

#: Lines that a summary has at most.
LINES = 40
_STYLES = {
    Verdict.CONSISTENT: "bold green",
    Verdict.RECALIBRATED: "bold green",
    Verdict.RECORDING_FAULT: "bold yellow",
    Verdict.MEASUREMENT_FAULT: "bold yellow",
    Verdict.MISSING_PHYSICS: "bold red",
    Verdict.UNNAMED_PHYSICS: "bold magenta",
    Verdict.CANNOT_TELL: "bold yellow",
}
#: Findings, rows of fits and statements that are printed; the rest is in the report.
_FINDINGS, _ROWS, _STATEMENTS = 2, 4, 2
#: Lines of the statement: it is cut only where somebody gave titles of many lines.
_STATEMENT = 14
#: Lines of a note below it.
_NOTE = 3


def print_summary(diagnosis: Diagnosis, console: Console, rest: str = "report.html") -> None:
    """Print verdict, findings, fit and certainty; foreign text is stripped of control characters and markup.

    Args:
        diagnosis: What is told.
        console: Where it goes.
        rest: Name of the file that has what is left out here.
    """
    width = max(console.width, 40)
    head = f"{diagnosis.verdict.value.upper()}  "
    first, *others = _wrapped(head, diagnosis.statement, width, _STATEMENT)
    top = Text(first)
    top.stylize(_STYLES[diagnosis.verdict], 0, len(head))
    lines = [top, *map(Text, others)]
    for note in diagnosis.notes:
        lines += map(Text, _wrapped("note     ", note, width, _NOTE))
    foot = [Text(line) for line in _wrapped("effort   ", effort(diagnosis), width, 1)]
    if shifted := clocks(diagnosis, units_of(diagnosis)):
        foot += map(Text, _wrapped("times    ", shifted, width, 3))
    if thinning(diagnosis):
        foot += map(Text, _wrapped("readings ", thinning(diagnosis), width, 3))
    if diagnosis.next_experiment is not None:
        foot += map(Text, _wrapped("next     ", _next(diagnosis.next_experiment), width, 6))
    if diagnosis.amended_model:
        note = model_note(diagnosis)
        label, told = ("model    ", f" ({note})") if note else ("amended  ", "")
        foot += map(Text, _wrapped(label, diagnosis.amended_model + told, width, 2))
    body = [Text(line) for line in _body(diagnosis, width, rest)]
    room = max(LINES - len(lines) - len(foot), 1)
    if len(body) > room:
        body = [*body[: room - 1], Text(f"  ... the rest is in {rest}")]
    for line in (*lines, *body, *foot):
        console.print(line, soft_wrap=True, highlight=False)


def _body(diagnosis: Diagnosis, width: int, rest: str) -> Iterator[str]:
    units = units_of(diagnosis)
    for doubt in diagnosis.doubts[:_FINDINGS]:
        yield from _wrapped("doubt    ", doubt_text(doubt), width, 3)
    if len(diagnosis.doubts) > _FINDINGS:
        more = len(diagnosis.doubts) - _FINDINGS
        yield f"         and {more} more doubt{'s' if more > 1 else ''} in diagnosis.json"
    told = (*diagnosis.accepted, *diagnosis.suggestions)[:_FINDINGS]
    for order, finding in enumerate(told, start=1):
        yield from _finding(order, finding, width, units, diagnosis.verdict is Verdict.CANNOT_TELL)
    more = len(diagnosis.findings) - len(told)
    if more > 0:
        yield f"  and {more} more in {rest}"
    decides = what_decides(diagnosis)
    if decides:
        yield from _wrapped("decide   ", decides, width, 8)
    if far := moved_most(diagnosis, units, _STATEMENTS):
        yield from _wrapped("moved    ", far, width, 6)
    yield from _wrapped("better   ", improvement(diagnosis), width, 4)
    yield from _fit(diagnosis, width, rest)
    yield from _wrapped("searched ", searched(diagnosis), width, 4)
    yield from _wrapped("sure     ", sureness(diagnosis), width, 4)
    yield from _wrapped("left     ", structure(diagnosis), width, 2)
    for left in diagnosis.left[:_STATEMENTS]:
        yield from _wrapped("left in  ", remainder(left, units), width, 2)
    yield from _moved(diagnosis, width, rest, units)
    for statement in diagnosis.isolability.statements[:_STATEMENTS]:
        yield from _wrapped("channels ", statement, width, 2)


def _moved(diagnosis: Diagnosis, width: int, rest: str, units: Units) -> Iterator[str]:
    """Parameters that moved and may be read as measurements; those that may not stand above."""
    measured = [m for m in diagnosis.recalibration if m.is_measured]
    for moved in measured[:_STATEMENTS]:
        yield from _wrapped("moved    ", moved_text(moved, units), width, 2)
    if len(measured) > _STATEMENTS:
        yield f"         and {len(measured) - _STATEMENTS} more by more than {MOVED:g} prior deviations, in {rest}"


def _next(experiment: NextExperiment) -> str:
    where = f" Scenario: {experiment.scenario}" if experiment.scenario else ""
    return experiment.statement + where


def _finding(order: int, finding: Finding, width: int, units: Units, is_open: bool) -> Iterator[str]:
    units = units.of(finding.place)
    yield from _wrapped(f"{order} where  ", where(finding), width, 1)
    yield from _wrapped("  when   ", when(finding, units=units), width, 1)
    prefix = "" if finding.is_accepted else "suggested, not accepted: "
    if finding.is_accepted and is_open:
        prefix = "improves the prediction, not identified: "
    yield from _wrapped("  what   ", prefix + what(finding), width, 2)
    yield from _wrapped("  law    ", finding.law, width, 2)
    told = [
        f"{clean(p.name)} = {units.estimate(p)}{f', {clean(p.meaning)}' if p.meaning else ''}"
        for p in finding.parameters
    ]
    yield from _wrapped("         ", "; ".join(told), width, 3)
    for doubt in finding.doubts[:_STATEMENTS]:
        yield from _wrapped("  doubt  " if finding.is_accepted else "  why not ", doubt, width, 3)
    if question := unit_factor(finding):
        yield from _wrapped("  unit   ", question, width, 2)
    if finding.ambiguous_with or finding.members:
        yield from _wrapped("  but    ", ambiguity(finding), width, 2)
        yield from (line for text in decisive(finding)[:2] for line in _wrapped("  decide ", text, width, 1))


def _fit(diagnosis: Diagnosis, width: int, rest: str) -> Iterator[str]:
    found, units = rows(diagnosis.fit), units_of(diagnosis)
    for row in found[:_ROWS]:
        yield from _wrapped("         ", _fit_row(row, units), width, 1)
    if len(found) > _ROWS:
        yield f"         and {len(found) - _ROWS} more rows in {rest}"


def _fit_row(row: Row, units: Units) -> str:
    factor, unit = units.of(row.first).difference(row.unit)
    every = [number(factor * row.rmse[stage]) for stage in STAGES]
    told = " -> ".join(every) if len(set(every)) > 1 else every[0]  # nothing was changed
    part = "held out" if row.is_held_out else "training"
    return f"{part}, {row.quantity}: RMSE {told} {unit} ({clean(row.recording)})"


def _wrapped(label: str, text: str, width: int, most: int) -> list[str]:
    """Lines with a label before the first; what is longer than `most` lines is cut."""
    return textwrap.wrap(
        label + clean(text),
        width,
        subsequent_indent=" " * min(len(label), 9),
        max_lines=most,
        placeholder=" ...",
        drop_whitespace=True,
    ) or [label]
