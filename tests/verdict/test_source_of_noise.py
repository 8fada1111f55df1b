"""Where the noise comes from that readings are compared with: no sentence calls stated what was estimated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge.diagnosis import Left, Verdict
from diagnosis.judge.headline import headline, how_right, noise_of
from diagnosis.judge.location import Remainder
from diagnosis.judge.remainder import remainders
from diagnosis.judge.verdict import _rejections
from diagnosis.report.undecided import remainder, what_decides
from tests.diagnosis.report_examples import ADEQUACY, diagnosis
from tests.search.line_model import TIME
from tests.verdict.lines import Lines

WORST = Left("steps", "coil[2,5].temperature", "K", 1.2, 0.15, 64.0, 1.3, is_noise_stated=False)
UNSTATED = replace(ADEQUACY, is_noise_stated=False, noises_stated=(0, 3), worst=WORST, day=())
MIXED = replace(UNSTATED, noises_stated=(2, 3))


def test_noise_that_nobody_stated_is_called_estimated() -> None:
    noisy = replace(UNSTATED, is_irregular=True)
    reason = _rejections(noisy, "")[0]
    assert "by the scatter of neighbouring readings (no noise was stated)" in reason
    told = [reason, how_right(UNSTATED, True), how_right(noisy, True), headline(Verdict.CANNOT_TELL, [], noisy, ["x"])]
    for text in told:
        assert "stated noise" not in text
        assert "noise that was stated" not in text
        assert "noise that is stated" not in text
    assert "8.0 times the noise estimated from neighbouring readings" in told[1]
    assert "noise is larger than was estimated from neighbouring readings" in told[2]
    assert "noise is larger than is stated" in how_right(replace(ADEQUACY, is_irregular=True), True)


def test_where_some_channels_state_their_noise_it_is_said_how_many() -> None:
    assert noise_of(MIXED) == (
        "the noise of the sensors (stated for 2 of 3 channels, estimated from the scatter of neighbouring readings for "
        "the others)"
    )


@pytest.mark.parametrize(("is_given", "source"), [(True, "noise as stated"), (False, "noise as estimated from neigh")])
def test_what_is_left_says_by_which_noise(is_given: bool, source: str) -> None:
    model = Lines(0.3 + np.sin(20.0 * TIME), 1, is_given=is_given)
    channels = [s.channel for run in model.runs for s in run.series]
    (left, *_) = remainders(10.0 * np.sin(20.0 * TIME), model.layout, {}, channels)
    text = remainder(left)
    assert f"{source}" in text
    assert "in 99 of 100 recordings" in text
    assert "assumed" not in text
    assert "noise as" not in remainder(Remainder("a", 0.0, 1.0, 9.0, 4.0))


def test_who_stated_no_noise_is_not_asked_to_correct_it() -> None:
    noisy = replace(diagnosis(Verdict.CANNOT_TELL), adequacy=replace(UNSTATED, is_irregular=True), left=())
    assert what_decides(noisy).startswith("State `noise` of these channels")
    stated = replace(noisy, adequacy=replace(ADEQUACY, is_irregular=True))
    assert what_decides(stated).startswith("Correct `noise` of these channels")
