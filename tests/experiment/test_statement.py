"""What is said of an experiment holds for how often it decides."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from diagnosis.experiment.design import LIKELY, Open, _statement, _Tried
from diagnosis.search.search import Explanation


def explanation(name: str) -> Explanation:
    point = SimpleNamespace(lasting=SimpleNamespace(terms=(f"{name} at all coils",)))
    return cast(Explanation, SimpleNamespace(fit=SimpleNamespace(point=point)))


def statement(decides: float) -> str:
    shape = SimpleNamespace(kind="long rest, then one pulse")
    conditions = SimpleNamespace(duration=554.7, load=None)
    explanations = tuple(explanation(name) for name in ("sheath", "second_mass"))
    best = _Tried(shape, (), conditions, [], decides, 1.0)  # type: ignore[arg-type]  # what a sentence needs of them
    return _statement(best, 0.0, Open(explanations, np.array([0.6, 0.4])))


@pytest.mark.parametrize("decides", [0.0, 0.49])
def test_what_hardly_ever_decides_is_not_said_to_decide(decides: float) -> None:
    told = statement(decides)
    assert told.startswith(
        "No programme that was tried within the limits of the rig is likely to decide between sheath"
    )
    assert f"in {100 * decides:.0f} % of cases" in told
    assert "would decide" not in told


def test_what_mostly_decides_is_said_to() -> None:
    assert statement(LIKELY).startswith(
        "Long rest, then one pulse for 554.7 s would decide between sheath at all coils and"
    )
