"""A comparison as text, Markdown, CSV and JSON."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from chainmail.compare.measures import Measure

#: Label of an actuator to its measures; None where its run failed.
Columns = Mapping[str, Sequence[Measure] | None]
NOTHING = "failed"


def _rows(columns: Columns) -> list[Measure]:
    """Labels and units, which are the same for every actuator."""
    return next((list(found) for found in columns.values() if found is not None), [])


def text_of(value: float) -> str:
    """Four significant digits; a dash where the quantity does not exist."""
    return "-" if math.isnan(value) else f"{value:.4g}"


def cells(columns: Columns) -> list[list[str]]:
    """Rows of text: label with unit, then one cell per actuator; quantities that no actuator has are left out."""
    table = []
    for index, row in enumerate(_rows(columns)):
        values = [NOTHING if found is None else text_of(found[index].value) for found in columns.values()]
        if any(v not in (NOTHING, "-") for v in values):
            table.append([f"{row.label} [{row.unit}]", *values])
    return table


def show(columns: Columns, console: Console) -> None:
    """Print the table."""
    table = Table(box=None, pad_edge=False)
    for heading in (
        "quantity",
        *(name.replace("_", "_\n") for name in columns),
    ):  # a long name breaks between its words
        table.add_column(heading, overflow="fold")
    for row in cells(columns):
        table.add_row(*map(escape, row))  # [s] is a unit here, no markup
    console.print(table)


def as_markdown(title: str, columns: Columns, notes: Sequence[str]) -> str:
    """Table and notes."""
    lines = [f"# {title}", "", f"| quantity | {' | '.join(columns)} |", "|---" * (len(columns) + 1) + "|"]
    lines += [f"| {' | '.join(row)} |" for row in cells(columns)]
    return "\n".join([*lines, "", *(f"- {note}" for note in notes)]).rstrip() + "\n"


def as_csv(columns: Columns) -> str:
    """One line per actuator, full precision; an empty cell where the quantity does not exist."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["actuator", *(row.key for row in _rows(columns))])
    for label, found in columns.items():
        if found is not None:
            writer.writerow([label, *("" if math.isnan(m.value) else repr(m.value) for m in found)])
    return stream.getvalue()


def as_json(title: str, columns: Columns, notes: Sequence[str], problems: Mapping[str, str]) -> str:
    """Everything; null where the quantity does not exist."""
    actuators: dict[str, Any] = {
        label: None if found is None else {m.key: None if math.isnan(m.value) else m.value for m in found}
        for label, found in columns.items()
    }
    data = {"title": title, "actuators": actuators, "problems": dict(problems), "notes": list(notes)}
    return json.dumps(data, indent=2, allow_nan=False) + "\n"
