"""Elements of HTML in which text is escaped by construction: only `Html` passes as it is."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from diagnosis.report.display import clean

#: Technical words of tables and what they mean.
MEANINGS = {
    "RMSE": "Root mean square of measured minus simulated, in the unit of the quantity.",
    "chi-square per sample": "Mean square of measured minus simulated over the noise of the sensor; 1 is noise alone.",
    "whiteness": "Largest standardised sum of residuals over a window of time; large where they keep one sign.",
    "before": "The model as the scenario has it.",
    "recalibrated": "The same model with its own parameters fitted to the training.",
    "after": "The model with the findings, fitted to the training.",
    "RMSE by channel": "Smallest and largest of the channels of this row, by the last model.",
    "z": "Standardised sum of residuals: how many standard deviations of noise it is.",
    "limit": "What noise alone stays below in 99 of 100 recordings.",
    "gain": "Fall of -2 log posterior of the training; larger is better.",
    "probability": "Among all explanations that were fitted in the same place.",
    "estimate (95 % interval)": "The value lies in the interval with 95 % probability, if the law is right.",
    "goes with": "Variables with which what is left rises and falls, with their correlation.",
}


class Html(str):
    """Text that is markup already."""

    __slots__ = ()


def element(name: str, *children: str, **attributes: str) -> Html:
    """`<name attributes>children</name>`.

    In the name of an attribute a trailing `_` is left out (`class_`), and another one is a hyphen (`aria_label`).
    """
    pairs = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{escape(clean(value))}"' for key, value in attributes.items()
    )
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
    top = [element("tr", *(_name(name, colspan=str(span)) for name, span in groups))] if groups else []
    names = element("tr", *(_name(h) for h in head))
    return element("div", element("table", element("thead", *top, names), element("tbody", *body)), class_="wide")


def _name(text: str, **attributes: str) -> Html:
    """Name of a column; what it means appears under the pointer."""
    meaning = MEANINGS.get(text.partition(",")[0])
    return element("th", element("abbr", text, title=meaning) if meaning else text, **attributes)


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
