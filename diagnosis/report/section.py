"""Sections of the page, made by templates."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from cosim.html_page import environment
from diagnosis.report.display import UNKNOWN, listed, number, percent, words

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup

TEMPLATES = Path(__file__).parent / "templates"
#: Letters of a title that the list of sections shows.
_SHOWN = 44


class Cell(NamedTuple):
    """A cell of a table that looks different from others.

    Args:
        text: What it says.
        kind: Class in page.css; `text` may take several lines.
    """

    text: str
    kind: str


@dataclass(frozen=True)
class Section:
    """A section of the page.

    Args:
        title: What stands above it.
        body: What stands below.
        colour: Of a finding; empty of all else.
    """

    title: str
    body: Markup
    colour: str = ""

    @property
    def short(self) -> str:
        """The title as the list of sections shows it."""
        head = self.title.partition(":")[0]
        return head if len(head) <= _SHOWN else head[: _SHOWN - 1] + "…"


def rendered(template: str, **values: Any) -> Markup:
    """What a template makes of values; all of them are escaped."""
    from markupsafe import Markup

    return Markup(_environment().get_template(template).render(values))


def section(title: str, template: str, colour: str = "", **values: Any) -> Section:
    """A section that a template makes."""
    return Section(title, rendered(template, **values), colour)


def named(sections: Sequence[Section]) -> dict[str, Section]:
    """The sections by names for links to them, no two alike."""
    found: dict[str, Section] = {}
    for one in sections:
        base = re.sub(r"[^a-z0-9]+", "-", one.title.lower()).strip("-")[:_SHOWN].strip("-") or "section"
        name, count = base, 2
        while name in found:
            name, count = f"{base}-{count}", count + 1
        found[name] = one
    return found


@cache
def _environment() -> Environment:
    made = environment(TEMPLATES)
    made.filters.update(listed=listed, number=number, percent=percent, words=words)
    made.globals.update(unknown=UNKNOWN)
    return made
