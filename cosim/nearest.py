"""What a user may have meant by a name that does not exist."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

#: Share of equal letters (difflib's ratio) from which on a name is a likely slip of another; 0.6 is difflib's own.
LIKELY = 0.6


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The known name that is most like the given one; None where none is like it."""
    by_small_letters = {k.lower(): k for k in known}
    found = difflib.get_close_matches(name.lower(), by_small_letters, n=1, cutoff=LIKELY)
    return by_small_letters[found[0]] if found else None


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The end of an error's sentence: `; did you mean `rows`?`, or nothing."""
    found = nearest(name[:200], known)  # difflib takes quadratic time
    return f"; did you mean `{found}`?" if found is not None and found != name else ""
