"""Clocks that are off in one recording alone, seen beside the recalibrated scenario.

Numbers that are off may hide a clock that runs half a per cent fast: the scenario as it is (`diagnosis.check`) misses
every recording by more. Its numbers are fitted first, to the recordings that are fitted anyway.
"""

from __future__ import annotations

from diagnosis.check.clock_of_one import RECALIBRATED, clocks_of_one
from diagnosis.judge.diagnosis import Doubt
from diagnosis.refitted import Refitted


def clocks_once_recalibrated(refitted: Refitted) -> list[Doubt]:
    """Doubts about the clock of a channel in one recording; all are serious.

    Args:
        refitted: The recordings beside fitted numbers.

    Returns:
        None where there are fewer than three recordings, or where a fit takes minutes.
    """
    if not refitted.is_of_use:
        return []
    found = clocks_of_one(refitted.by_all, RECALIBRATED)
    by_others = {title: _by_others(title, refitted) for title in {told.recording for told in found}}
    found = [by_others[told.recording].get(told.subject, told) for told in found]
    fitted = set(refitted.fitted)
    if not refitted.has_unfitted or all(told.recording in fitted for told in found):
        return found
    alike = {(d.recording, d.subject) for d in clocks_of_one(refitted.foreseen, RECALIBRATED)}
    return [told for told in found if told.recording in fitted or (told.recording, told.subject) in alike]


def _by_others(title: str, refitted: Refitted) -> dict[str, Doubt]:
    """Channel to the doubt about its clock in a recording with numbers that were fitted to the others."""
    every = refitted.by_others(title)
    again = clocks_of_one(every, RECALIBRATED) if every else []
    return {told.subject: told for told in again if told.recording == title}
