"""Clocks that are off in one recording alone, seen beside the recalibrated scenario.

Numbers that are off may hide a clock that runs half a per cent fast: the scenario as it is (`diagnosis.check`) misses
every recording by more. Its numbers are fitted first, to the recordings that are fitted anyway.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diagnosis.check.beside import Compared
from diagnosis.check.clock_of_one import OTHERS, RECALIBRATED, clocks_of_one
from diagnosis.judge.diagnosis import Doubt
from diagnosis.judge.held_out import carried_over
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.wrappers.masked import MaskedModel
from diagnosis.recording.series import Series
from diagnosis.search.problem import Point
from diagnosis.search.search import recalibrate


def clocks_once_recalibrated(
    model: DiagnosisModel, judge: DiagnosisModel | None, compared: Sequence[Compared]
) -> list[Doubt]:
    """Doubts about the clock of a channel in one recording; all are serious.

    Args:
        model: Of the training recordings, without laws.
        judge: Of those held out, or None.
        compared: Recordings beside the scenario as it is: those of the training, then those held out.

    Returns:
        None where there are fewer than three recordings, or where a fit takes minutes.
    """
    if len(compared) <= OTHERS or not model.can_be_searched_again or not model.parameters:
        return []
    point = recalibrate(model).point
    found = clocks_of_one(_compared(point, model, judge, compared), RECALIBRATED)
    by_others = {title: _by_others(title, model, judge, compared) for title in {told.recording for told in found}}
    found = [by_others[told.recording].get(told.subject, told) for told in found]
    if judge is None or len(model.runs) == 1:
        return found
    fitted = {one.recording.title for one in compared[: len(model.runs)]}
    if all(told.recording in fitted for told in found):
        return found
    alike = {(d.recording, d.subject) for d in clocks_of_one(_foreseen(point, model, judge, compared), RECALIBRATED)}
    return [told for told in found if told.recording in fitted or (told.recording, told.subject) in alike]


def _by_others(
    title: str, model: DiagnosisModel, judge: DiagnosisModel | None, compared: Sequence[Compared]
) -> dict[str, Doubt]:
    """Channel to the doubt about its clock with numbers that were fitted to the other recordings of the training.

    One whose clock is off bends numbers that are fitted to it too. Nothing where it is none of the training, is alone
    in it, or has its title in common with another.

    Args:
        title: Of the recording.
        model: Of the training recordings, without laws.
        judge: Of those held out, or None.
        compared: Recordings beside the scenario as it is.
    """
    titles = [one.recording.title for one in compared[: len(model.runs)]]
    if titles.count(title) != 1 or len(titles) == 1:
        return {}
    point = _fitted_to_others(model, titles.index(title))
    again = clocks_of_one(_compared(point, model, judge, compared), RECALIBRATED)
    return {told.subject: told for told in again if told.recording == title}


def _foreseen(
    point: Point, model: DiagnosisModel, judge: DiagnosisModel, compared: Sequence[Compared]
) -> list[Compared]:
    """Each recording beside what numbers predict of it that were not fitted to it.

    What no number of the model can do is spread over the recordings that are fitted, and shows in one that is held out:
    beside fitted ones that one alone seems to be off.

    Args:
        point: Fitted to all of the training.
        model: Of the training recordings, two at least.
        judge: Of those held out.
        compared: Recordings beside the scenario as it is.
    """
    every = _compared(point, model, judge, compared)
    for number in range(len(model.runs)):
        every[number] = _beside(compared[number], model, _fitted_to_others(model, number), number)
    return every


def _fitted_to_others(model: DiagnosisModel, number: int) -> Point:
    """Numbers that are fitted to the training recordings but one."""
    sizes = [sum(len(s.samples) for s in run.series) for run in model.runs]
    owners = np.repeat(np.arange(len(sizes)), sizes)
    return recalibrate(MaskedModel(model, owners != number)).point


def _compared(
    point: Point, model: DiagnosisModel, judge: DiagnosisModel | None, compared: Sequence[Compared]
) -> list[Compared]:
    """Recordings beside what a model predicts with fitted numbers."""
    every = [_beside(one, model, point, n) for n, one in enumerate(compared[: len(model.runs)])]
    if judge is not None:
        there = carried_over(point, model, judge)
        every += [_beside(one, judge, there, n) for n, one in enumerate(compared[len(model.runs) :])]
    return every


def _beside(one: Compared, model: DiagnosisModel, point: Point, number: int) -> Compared:
    """The recording beside what the model predicts of it, at the times of the readings."""
    channels = {}
    for series, values in zip(model.runs[number].series, model.predict(point, number)):
        name = series.channel.name
        beside = one.channels.get(name)
        if beside is not None and beside.simulated is not None and np.isfinite(values).all():
            times = series.channel.times[-len(values) :]  # those that are compared are the last ones
            channels[name] = replace(beside, simulated=Series(times, values, False, beside.simulated.unit))
    return replace(one, channels=channels)
