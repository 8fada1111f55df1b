"""Elements of HTML in which text is escaped by construction: only `Html` passes as it is."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from diagnosis.report.display import clean


class Html(str):
    """Text that is markup already."""

    __slots__ = ()


def element(name: str, *children: str, **attributes: str) -> Html:
    """`<name attributes>children</name>`; a trailing `_` of an attribute's name is left out (`class_`)."""
    pairs = "".join(f' {key.rstrip("_")}="{escape(clean(value))}"' for key, value in attributes.items())
    return Html(f"<{name}{pairs}>{joined(children)}</{name}>")


def joined(parts: Iterable[str]) -> Html:
    """Parts one after the other, those that are no markup escaped."""
    return Html("".join(p if isinstance(p, Html) else escape(clean_lines(p)) for p in parts))


def clean_lines(text: str) -> str:
    """Text without control characters, spaces at its ends kept."""
    return "".join(c if c.isprintable() else " " for c in text)


def coded(text: str) -> Html:
    """Text in which what stands between backticks is code."""
    return joined(element("code", part) if n % 2 else part for n, part in enumerate(text.split("`")))


def image(source: str, about: str) -> Html:
    """A picture given as a data address."""
    return Html(f'<img src="{escape(source)}" alt="{escape(clean(about))}">')


def table(head: Sequence[str], rows: Iterable[Sequence[str]], groups: Sequence[tuple[str, int]] = ()) -> Html:
    """A table.

    Args:
        head: Names of the columns.
        rows: Cells: text, markup, or whole `td` elements.
        groups: Name and number of columns of each part of a second row of names, above the first.
    """
    body = [element("tr", *(_cell(c) for c in row)) for row in rows]
    top = [element("tr", *(element("th", name, colspan=str(span)) for name, span in groups))] if groups else []
    names = element("tr", *(element("th", h) for h in head))
    return element("div", element("table", element("thead", *top, names), element("tbody", *body)), class_="wide")


def _cell(content: str) -> Html:
    return content if isinstance(content, Html) and content.startswith("<td") else element("td", content)


def wrapped(text: str) -> Html:
    """A cell of running text, which may take several lines."""
    return element("td", text, class_="text")


def listing(items: Iterable[str]) -> Html:
    """A bulleted list."""
    return element("ul", *(element("li", i) for i in items))


def folded(summary: str, *content: str) -> Html:
    """Content that opens with a click."""
    return element("details", element("summary", summary), *content)
