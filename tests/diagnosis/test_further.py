"""A simulation that fails after the verdict is known costs what it was for, and nothing else."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import diagnosis.further as stages
from cosim.unit.protocol import UnitError
from diagnosis.diagnose import diagnose
from diagnosis.models.coil_network.kernel.network import CoilNetworkError
from diagnosis.search.search import Settings
from tests.diagnosis.two_heaters import record, scenario

FAILURES = (
    CoilNetworkError("the coil network stopped being finite at t = 10.6 s (set 0)", 0, 10.6),
    np.linalg.LinAlgError("SVD did not converge"),
    UnitError("heaters", "the solver gave up"),
)
STAGES = {
    "isolability": "What these channels can tell apart is left out",
    "locate": "Where each unit departs is left out",
    "next_experiment": "The next experiment is left out",
}


@pytest.mark.parametrize(("failure", "stage"), list(zip(FAILURES, STAGES)), ids=list(STAGES))
def test_the_answer_stands_without_what_failed_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failure: Exception, stage: str
) -> None:
    def fails(*given: object, **named: object) -> None:
        raise failure

    monkeypatch.setattr(stages, stage, fails)
    made = scenario(tmp_path)
    found = diagnose(made, [record(made, tmp_path / "first", {}, 1)], [], Settings(nulls=1)).diagnosis
    said = [n for n in found.notes if "is left out" in n]
    assert said == [f"{STAGES[stage]}: {failure}."]
    assert found.statement
    # The other stages were gone through.
    assert bool(found.isolability.statements) == (stage != "isolability")
    assert bool(found.locations) == (stage != "locate")
