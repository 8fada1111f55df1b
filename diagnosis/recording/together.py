"""What recordings must have in common to be used together."""

from __future__ import annotations

import itertools
import os
from collections.abc import Sequence
from pathlib import Path

from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from diagnosis.recording.fits import fitting
from diagnosis.recording.labels import distinct
from diagnosis.recording.recording import Recording


def prepared(
    scenario: Scenario, training: Sequence[Recording], held_out: Sequence[Recording]
) -> tuple[list[Recording], list[Recording]]:
    """Recordings ready for a diagnosis: held against the scenario and each other, each with a title of its own.

    Args:
        scenario: What they are compared with.
        training: Recordings that are fitted.
        held_out: Recordings that judge.

    Returns:
        Training and held-out recordings, without the readings outside the simulated time.

    Raises:
        InputError: One of them does not fit the scenario (`diagnosis.recording.fits.fitting`), or they contradict each
            other (`check_order`).
    """
    both = [*training, *held_out]
    check_order(both)
    found = distinct(fitting(scenario, both))
    return found[: len(training)], found[len(training) :]


def refuse_doubled(recordings: Sequence[Path]) -> None:
    """Refuse a recording that is given twice: it would count as two, and everything would seem surer than it is."""
    folders = [os.path.realpath(p) for p in recordings]  # links may point at themselves
    doubled = [given for given, folder in zip(recordings, folders) if folders.count(folder) > 1]
    if doubled:
        raise InputError(doubled[0], "", "this recording is given twice", "give each recording once")


def check_order(recordings: Sequence[Recording]) -> None:
    """Refuse what cannot have happened.

    Raises:
        InputError: Some recordings state their `order` and others do not, two state the same, a later one has fewer
            `cycles_before`, or a `day` goes on after another one has begun.
    """
    stated = [r for r in recordings if r.order is not None]
    if not stated:
        return
    for one in recordings:
        if one.order is None:
            raise _fault(
                one,
                "order",
                f"it does not state its place in time, and {_name(stated[0])} does",
                "give `order` in all recordings or in none",
            )
    rising = sorted(stated, key=lambda r: r.order or 0)
    done: list[str] = []
    for before, after in itertools.pairwise(rising):
        if before.order == after.order:
            raise _fault(after, "order", f"{_name(before)} has the order {after.order} too", "number them from 1")
        if after.cycles_before < before.cycles_before:
            raise _fault(
                after,
                "cycles_before",
                f"it comes after {_name(before)}, which had {before.cycles_before:g} cycles "
                f"before it, but states {after.cycles_before:g}",
                "correct `cycles_before` or `order`",
            )
        if before.day != after.day:
            done.append(before.day)
            if after.day and after.day in done:
                raise _fault(
                    after,
                    "day",
                    f"the day `{after.day}` goes on after {_name(before)}, which is of another day",
                    "correct `day` or `order`",
                )


def _fault(recording: Recording, key: str, problem: str, remedy: str) -> InputError:
    return InputError(recording.path / "recording.yaml", key, problem, remedy)


def _name(recording: Recording) -> str:
    return f"`{recording.title}` ({recording.path.name})"
