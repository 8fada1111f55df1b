"""Names by which people tell recordings apart."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from diagnosis.recording.recording import Recording


def labels(recordings: Sequence[Recording]) -> tuple[str, ...]:
    """One label for each recording, all different: the title, with the folder where several share a title.

    Args:
        recordings: All that are spoken of together, training and held out; in order.

    Returns:
        The title where no other has it; else the title with as many names of folders, from the last on, as tell the
        recordings apart; where two are the same folder, with their number too.
    """
    named = [r.title for r in recordings]
    paths = [Path(os.path.realpath(r.path)).parts for r in recordings]
    shared = _shared(named)
    for depth in range(1, max((len(p) for p in paths), default=0) + 1):
        if not any(shared):
            break
        tails = ["/".join(p[-depth:]).replace("//", "/") for p in paths]
        named = [f"{r.title} ({t})" if is_shared else n for r, t, n, is_shared in zip(recordings, tails, named, shared)]
        shared = _shared(named)
    return tuple(f"{n} no. {i}" if is_shared else n for i, (n, is_shared) in enumerate(zip(named, shared), 1))


def distinct(recordings: Sequence[Recording]) -> list[Recording]:
    """The same with their labels as titles: whoever prints a title then names one recording."""
    return [replace(r, title=label) for r, label in zip(recordings, labels(recordings))]


def _shared(names: Sequence[str]) -> list[bool]:
    count = Counter(names)
    return [count[n] > 1 for n in names]
