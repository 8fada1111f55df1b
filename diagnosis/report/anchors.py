"""A name for every section of the page, links to them, and what technical words mean."""

from __future__ import annotations

import re
from html import unescape

from diagnosis.report.markup import Html, element

_SECTION = re.compile(r"<section(?P<attributes>[^>]*)><h2>(?P<title>.*?)</h2>", re.DOTALL)
#: Letters of a title that the list of sections shows.
_SHOWN = 44


def anchored(body: str) -> tuple[Html, Html]:
    """The sections with names, and the list of links to them.

    Args:
        body: Sections as markup, each with its title as `h2` first.
    """
    names: dict[str, str] = {}

    def named(match: re.Match[str]) -> str:
        title = re.sub(r"<[^>]*>", "", match["title"])
        base = re.sub(r"[^a-z0-9]+", "-", unescape(title).lower()).strip("-")[:_SHOWN].strip("-") or "section"
        name, count = base, 2
        while name in names:
            name, count = f"{base}-{count}", count + 1
        names[name] = unescape(title)
        link = f'<a class="anchor" href="#{name}" title="Link to this section">{match["title"]}</a>'
        return f'<section id="{name}"{match["attributes"]}><h2>{link}</h2>'

    marked = Html(_SECTION.sub(named, body))
    links = [element("a", _short(title), href=f"#{name}") for name, title in names.items()]
    return marked, element("nav", *links, aria_label="Sections") if len(links) > 1 else Html("")


def _short(title: str) -> str:
    head = title.partition(":")[0]
    return head if len(head) <= _SHOWN else head[: _SHOWN - 1] + "…"
