"""Recordings beside what a model predicts with numbers that are fitted to all of the training, or to a part of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from diagnosis.check.beside import Compared, compare
from diagnosis.check.odd_one_out import OTHERS
from diagnosis.judge.held_out import carried_over
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.wrappers.masked import MaskedModel
from diagnosis.recording.series import Series
from diagnosis.search.problem import Point
from diagnosis.search.search import recalibrate


class Refitted:
    """Predictions of every recording with fitted numbers; each fit is made once, when it is asked for.

    Args:
        model: Of the training recordings, without laws.
        judge: Of those held out, or None.
        compared: Recordings beside the scenario as it is: those of the training, then those held out.
    """

    def __init__(self, model: DiagnosisModel, judge: DiagnosisModel | None, compared: Sequence[Compared]) -> None:
        self._model, self._judge, self._compared = model, judge, compared
        self._without: dict[int, Point] = {}

    @property
    def is_of_use(self) -> bool:
        """Whether there are others beside each recording, numbers to fit, and time for it: a fit takes no minutes."""
        return len(self._compared) > OTHERS and self._model.can_be_refitted and bool(self._model.parameters)

    @property
    def titles(self) -> list[str]:
        """Of all recordings, those of the training first."""
        return [one.recording.title for one in self._compared]

    @property
    def fitted(self) -> list[str]:
        """Titles of the recordings of the training."""
        return self.titles[: len(self._model.runs)]

    @property
    def has_unfitted(self) -> bool:
        """Whether each recording can be predicted with numbers that were not fitted to it."""
        return self._judge is not None and len(self._model.runs) > 1

    @cached_property
    def by_all(self) -> list[Compared]:
        """Every recording beside numbers that are fitted to all of the training."""
        return self._beside_all(self._point)

    def by_others(self, title: str) -> list[Compared]:
        """Every recording beside numbers that are fitted to the training without this recording.

        One that is off bends numbers that are fitted to it too. Nothing where it is none of the training, is alone in
        it, or has its title in common with another.
        """
        if self.fitted.count(title) != 1 or len(self.fitted) == 1:
            return []
        return self._beside_all(self._point_without(self.fitted.index(title)))

    @cached_property
    def foreseen(self) -> list[Compared]:
        """Each recording beside what numbers predict of it that were not fitted to it; see `has_unfitted`.

        What no number of the model can do is spread over the recordings that are fitted, and shows in one that is held
        out: beside fitted ones that one alone seems to be off.
        """
        every = list(self.by_all)
        for number in range(len(self._model.runs)):
            every[number] = _beside(self._compared[number], self._model, self._point_without(number), number)
        return every

    def restated(self, title: str) -> list[Compared]:
        """Every recording beside a simulation of the scenario with numbers that were not fitted to this recording.

        What one recording has of its own (its start, say) is as the scenario and the recording say. Empty where the
        model does not state its numbers in a scenario.
        """
        is_fitted = title in self.fitted
        point = self._point_without(self.fitted.index(title)) if is_fitted else self._point
        scenario = self._compared[0].base
        other = None if scenario is None else self._model.restated(scenario, point)
        return [] if other is None else [compare(other, one.whole) for one in self._compared]

    @cached_property
    def _point(self) -> Point:
        return recalibrate(self._model).point

    def _point_without(self, number: int) -> Point:
        """Numbers that are fitted to the training recordings but one."""
        if number not in self._without:
            sizes = [sum(len(s.samples) for s in run.series) for run in self._model.runs]
            owners = np.repeat(np.arange(len(sizes)), sizes)
            self._without[number] = recalibrate(MaskedModel(self._model, owners != number)).point
        return self._without[number]

    def _beside_all(self, point: Point) -> list[Compared]:
        model, judge, count = self._model, self._judge, len(self._model.runs)
        every = [_beside(one, model, point, n) for n, one in enumerate(self._compared[:count])]
        if judge is not None:
            there = carried_over(point, model, judge)
            every += [_beside(one, judge, there, n) for n, one in enumerate(self._compared[count:])]
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
