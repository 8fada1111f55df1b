"""The recordings that a diagnosis rests on."""

from __future__ import annotations

from collections.abc import Sequence

from diagnosis.judge.diagnosis import Used
from diagnosis.recording.recording import Recording


def used(training: Sequence[Recording], held_out: Sequence[Recording]) -> tuple[Used, ...]:
    """All of them, those that were fitted first."""
    return tuple(_used(r, False) for r in training) + tuple(_used(r, True) for r in held_out)


def _used(recording: Recording, is_held_out: bool) -> Used:
    begin = min(float(c.times[0]) for c in recording.channels.values())
    readings = sum(len(c.times) for c in recording.channels.values())
    thinned = sum(c.dropped.get("thinned", 0) for c in recording.channels.values())
    names = tuple(recording.channels)
    return Used(
        recording.title,
        str(recording.path),
        is_held_out,
        begin,
        recording.end,
        names,
        readings,
        thinned,
        recording.zero,
    )
