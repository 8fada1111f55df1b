"""The answer in the terminal, in at most 30 lines."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator

from rich.console import Console
from rich.text import Text

from diagnosis.judge.diagnosis import Diagnosis, Finding, Verdict
from diagnosis.judge.next_experiment import NextExperiment
from diagnosis.report.display import clean, difference, interval, number
from diagnosis.report.fits import STAGES, Row, rows
from diagnosis.report.sentences import ambiguity, decisive, effort, improvement, structure, sureness, what, when, where
from diagnosis.report.undecided import is_refuted, model_note, remainder, what_decides, why

#: Lines that a summary has at most.
LINES = 30
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


def print_summary(diagnosis: Diagnosis, console: Console) -> None:
    """Print verdict, findings, fit and certainty; foreign text is stripped of control characters and markup."""
    width = max(console.width, 40)
    head = f"{diagnosis.verdict.value.upper()}  "
    first, *others = _wrapped(head, diagnosis.statement, width, 3)
    top = Text(first)
    top.stylize(_STYLES[diagnosis.verdict], 0, len(head))
    lines = [top, *map(Text, others)]
    foot = [Text(line) for line in _wrapped("effort   ", effort(diagnosis), width, 1)]
    if diagnosis.next_experiment is not None:
        foot += map(Text, _wrapped("next     ", _next(diagnosis.next_experiment), width, 6))
    if diagnosis.amended_model:
        note = model_note(diagnosis)
        label, told = ("model    ", f" ({note})") if note else ("amended  ", "")
        foot += map(Text, _wrapped(label, diagnosis.amended_model + told, width, 2))
    body = [Text(line) for line in _body(diagnosis, width)]
    room = LINES - len(lines) - len(foot)
    if len(body) > room:
        body = [*body[: room - 1], Text("  ... the rest is in report.html")]
    for line in (*lines, *body, *foot):
        console.print(line, soft_wrap=True, highlight=False)


def _body(diagnosis: Diagnosis, width: int) -> Iterator[str]:
    is_open = diagnosis.verdict is Verdict.CANNOT_TELL
    if is_open:
        yield from _undecided(diagnosis, width)
    for order, finding in enumerate(diagnosis.findings[:_FINDINGS], start=1):
        yield from _finding(order, finding, width, not is_open)
    more = len(diagnosis.findings) - _FINDINGS
    if more > 0:
        yield f"  and {more} more in report.html"
    if is_refuted(diagnosis):  # there the improvement is none, and the reason why
        yield from _wrapped("fit      ", "before -> recalibrated only -> with what is suggested", width, 2)
    else:
        yield from _wrapped("better   ", improvement(diagnosis), width, 4)
    yield from _fit(diagnosis, width)
    yield from _wrapped("sure     ", sureness(diagnosis), width, 3)
    yield from _wrapped("left     ", structure(diagnosis), width, 2)
    for rest in diagnosis.left[: 0 if is_open and not diagnosis.findings else _STATEMENTS]:
        yield from _wrapped("left in  ", remainder(rest), width, 2)
    for name, value in list(diagnosis.recalibration.items())[:_STATEMENTS]:
        yield from _wrapped("moved    ", f"{clean(name)}: {number(value)}", width, 1)
    for statement in diagnosis.isolability.statements[:_STATEMENTS]:
        yield from _wrapped("channels ", statement, width, 2)


def _undecided(diagnosis: Diagnosis, width: int) -> Iterator[str]:
    """What is left, why that is open, and what would decide."""
    for rest in diagnosis.left[: 0 if diagnosis.findings else _STATEMENTS]:
        yield from _wrapped("left in  ", remainder(rest), width, 2)
    yield from _wrapped("why      ", why(diagnosis), width, 5)
    told = what_decides(diagnosis)
    if told:
        yield from _wrapped("decide   ", told, width, 8)


def _next(experiment: NextExperiment) -> str:
    where = f" Scenario: {experiment.scenario}" if experiment.scenario else ""
    return experiment.statement + where


def _finding(order: int, finding: Finding, width: int, is_accepted: bool) -> Iterator[str]:
    yield from _wrapped(f"{order} where  ", where(finding), width, 1)
    yield from _wrapped("  when   ", when(finding), width, 1)
    yield from _wrapped("  what   ", ("" if is_accepted else "suggested, not accepted: ") + what(finding), width, 2)
    yield from _wrapped("  law    ", finding.law, width, 2)
    told = [f"{clean(p.name)} = {interval(p.value, p.lower, p.upper, clean(p.unit))}" for p in finding.parameters]
    yield from _wrapped("         ", ", ".join(told), width, 2)
    if finding.ambiguous_with:
        yield from _wrapped("  but    ", ambiguity(finding), width, 2)
        yield from (line for text in decisive(finding)[:2] for line in _wrapped("  decide ", text, width, 1))


def _fit(diagnosis: Diagnosis, width: int) -> Iterator[str]:
    found = rows(diagnosis.fit)
    for row in found[:_ROWS]:
        yield from _wrapped("         ", _fit_row(row), width, 1)
    if len(found) > _ROWS:
        yield f"         and {len(found) - _ROWS} more rows in report.html"


def _fit_row(row: Row) -> str:
    factor, unit = difference(row.unit)
    told = " -> ".join(number(factor * row.rmse[stage]) for stage in STAGES)
    part = "held out" if row.is_held_out else "training"
    return f"{part}, {row.quantity}: RMSE {told} {unit} ({clean(row.recording)})"


def _wrapped(label: str, text: str, width: int, most: int) -> list[str]:
    """Lines with a label before the first; what is longer than `most` lines is cut."""
    return textwrap.wrap(label + clean(text), width, subsequent_indent=" " * min(len(label), 9), max_lines=most,
                         placeholder=" ...", drop_whitespace=True) or [label]  # fmt: skip
