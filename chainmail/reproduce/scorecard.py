"""The scorecard as text, Markdown and JSON."""

from __future__ import annotations

import itertools
import json
from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from chainmail.reproduce.bands import ENGINE, inside
from chainmail.reproduce.row import Row


def number(value: float) -> str:
    """Five significant digits, without an exponent where it is readable."""
    return f"{value:.5g}"


def ours(row: Row) -> str:
    """Our value; a median with the band of its starts where there are several."""
    if row.band is None:
        return number(row.ours)
    band = f"({number(row.band[0])} to {number(row.band[1])})"
    return f"{number(row.ours)} {band}" if row.median is None else f"{number(row.ours)}; {number(row.median)} {band}"


def heading(rows: Sequence[Row]) -> str:
    """What the values are."""
    starts = max(row.starts for row in rows)
    if starts == 1:
        return "Published value, ours, the accepted difference with its reason, and the verdict."
    if any(row.median is not None for row in rows):
        return (
            f"Published value, ours from one run in Bullet; behind the semicolon the median of {starts} starts in "
            f"{ENGINE} with 5 and 95 %; the accepted difference with its reason, and the verdict. Where there is a "
            "band it decides: a number passes where the band reaches into the tolerance, a statement where it holds in "
            f"95 % of the starts. {agreement(rows)}"
        )
    return (
        f"Published value, ours as the median of {starts} starts with 5 and 95 %, the accepted difference with its "
        "reason, and the verdict: a number passes where the band reaches into the tolerance, a statement where it "
        "holds in 95 % of the starts."
    )


def agreement(rows: Sequence[Row]) -> str:
    """In how many lines the run in Bullet lies within the band of the other engine."""
    count, of = inside(rows)
    return f"Our run in Bullet lies within the band in {count} of {of} lines that have one."


def as_markdown(rows: Sequence[Row]) -> str:
    """One table a section."""
    lines = ["# Scorecard", "", heading(rows), ""]
    for section, group in itertools.groupby(rows, key=lambda r: r.section):
        lines += [
            f"## {section}",
            "",
            "| quantity | published | ours | unit | tolerance | verdict | why |",
            "|---|---|---|---|---|---|---|",
        ]
        for r in group:
            tolerance = "relation" if r.tolerance is None else f"+-{r.tolerance:g}"
            verdict = "pass" if r.is_met else "**FAIL**"
            why = r.reason + (f"; {r.explanation}" if r.explanation else "")
            cells = (r.quantity, r.published, ours(r), r.unit, tolerance, verdict, why)
            lines.append(f"| {' | '.join(cells)} |")
        lines.append("")
    met = sum(r.is_met for r in rows)
    lines.append(f"{met} of {len(rows)} lines pass.")
    return "\n".join(lines) + "\n"


def as_json(rows: Sequence[Row]) -> str:
    """All rows; NaN becomes null."""
    return json.dumps({"rows": [r.as_dict() for r in rows]}, indent=2, allow_nan=False)


def show(rows: Sequence[Row], console: Console) -> None:
    """Print the table; explanations below it."""
    for section, group in itertools.groupby(rows, key=lambda r: r.section):
        table = Table(title=section, title_justify="left", box=None, pad_edge=False)
        for heading in ("quantity", "published", "ours", "tolerance", ""):
            table.add_column(heading, overflow="fold")
        members = list(group)
        for r in members:
            tolerance = "relation" if r.tolerance is None else f"+-{r.tolerance:g}"
            verdict = "[green]pass[/]" if r.is_met else "[bold red]FAIL[/]"
            table.add_row(r.quantity, r.published, f"{ours(r)} {r.unit}", tolerance, verdict)
        console.print(table)
        for r in members:
            if r.explanation and not r.is_met:
                console.print(f"  {r.quantity}: {r.explanation}", style="dim", highlight=False)
        console.print()
    console.print(f"{sum(r.is_met for r in rows)} of {len(rows)} lines pass.")
    if inside(rows)[1]:
        console.print(agreement(rows))
