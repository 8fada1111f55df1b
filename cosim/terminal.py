"""Foreign text on a terminal: a title or a file's name must not steer it."""

from __future__ import annotations


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
