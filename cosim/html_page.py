"""Templates of HTML pages: every value is escaped, and one that is missing is an error."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jinja2 import Environment


@cache
def environment(*folders: Path) -> Environment:
    """What finds templates, and renders them with all values escaped.

    Args:
        folders: Of templates, in the order in which they are searched.
    """
    # Loaded where a page is written: most commands write none.
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    return Environment(
        loader=FileSystemLoader(folders),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_printable,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )


def _printable(value: object) -> object:
    """A value, or foreign text with blanks for its control characters; markup stays as it is."""
    if isinstance(value, str) and not (value.isprintable() or hasattr(value, "__html__")):
        return "".join(c if c.isprintable() else " " for c in value)
    return value
