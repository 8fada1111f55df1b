"""Foreign text on a terminal: a title or a file's name must not steer it."""

from __future__ import annotations

import shlex
from pathlib import Path


def printable(text: str) -> str:
    """Text with its lines, every other control character replaced by a space.

    >>> printable("a\\x1b[31mb\\nc")
    'a [31mb\\nc'
    """
    return "".join(c if c.isprintable() or c == "\n" else " " for c in text)


def in_one_line(text: str) -> str:
    """The same in one line.

    >>> in_one_line("a\\n  b ")
    'a b'
    """
    return " ".join(printable(text).split())


def as_argument(path: str | Path) -> str:
    """A path as an argument of a command that a user may paste into a shell; no path is taken for an option.

    >>> as_argument("my runs/a")
    "'my runs/a'"
    >>> as_argument("-runs")
    './-runs'
    """
    text = str(path)
    return shlex.quote(f"./{text}" if text.startswith("-") else text)
