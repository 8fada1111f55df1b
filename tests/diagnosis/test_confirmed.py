"""Held-out recordings have the last word on findings."""

from dataclasses import replace

import pytest

from diagnosis.judge.confirmed import confirmed, held_out_chi_square
from diagnosis.judge.diagnosis import ChannelFit, Diagnosis, Verdict
from tests.diagnosis.report_examples import diagnosis as example


def _with(recalibrated: float, after: float, samples: int = 400) -> Diagnosis:
    stages = {"before": 9.0, "recalibrated": recalibrated, "after": after}
    fit = ChannelFit("held out", True, "coil[1,1].temperature", "K", stages, stages, stages, samples)
    return replace(example(Verdict.MISSING_PHYSICS), fit=(fit,))


def test_findings_that_foretell_better_stand():
    assert confirmed(_with(2.0, 1.0)).verdict is Verdict.MISSING_PHYSICS


def test_findings_that_foretell_worse_are_refuted_and_stay_listed():
    found = confirmed(_with(1.0, 1.2))
    assert found.verdict is Verdict.CANNOT_TELL
    assert found.findings
    assert "480 against 400" in found.statement


@pytest.mark.parametrize(("after", "is_kept"), [(1.04, True), (1.06, False)])
def test_a_rise_within_chance_refutes_nothing(after, is_kept):
    # 400 samples: 0.04 is 16, below 20; 0.06 is 24, above it and above 2 % of 400
    assert (confirmed(_with(1.0, after)).verdict is Verdict.MISSING_PHYSICS) is is_kept


def test_training_recordings_refute_nothing():
    found = _with(1.0, 5.0)
    training = replace(found, fit=tuple(replace(f, is_held_out=False) for f in found.fit))
    assert confirmed(training).verdict is Verdict.MISSING_PHYSICS
    assert held_out_chi_square(training, "after") == 0.0
