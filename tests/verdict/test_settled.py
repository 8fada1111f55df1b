"""When another way to describe the training is asked for."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from diagnosis.judge.acceptance import Accepted
from diagnosis.judge.trust import is_settled
from diagnosis.search.problem import Term


def _accepted(excess: float, units: dict[str, int | None], is_rejected: bool = True) -> Accepted:
    terms = {Term(f"law_{n}", "rig.x", unit, (), recording=of): () for n, (unit, of) in enumerate(units.items())}
    left: Any = SimpleNamespace(is_rejected=is_rejected, excess=excess, chi_square=3.0)
    before: Any = SimpleNamespace(excess=100.0)
    found: Any = SimpleNamespace(
        agreement=left, agreement_recalibrated=before, explanation=SimpleNamespace(terms=terms)
    )
    return cast(Accepted, found)


@pytest.mark.parametrize(
    ("excess", "units", "expected"),
    [
        (5.0, {"mechanical": None}, True),  # laws of the rig leave a twentieth
        (50.0, {"mechanical": None}, False),  # they leave half
        (5.0, {"mechanical": None, "measurement": None}, False),  # a lag of a sensor describes what a rig does
        (5.0, {"input": None}, False),
        (5.0, {"measurement": 1}, True),  # a sensor that was off for a while describes nothing of a rig
        (5.0, {}, True),
    ],
)
def test_little_that_is_left_settles_it_unless_a_sensor_stands_in_for_the_rig(
    excess: float, units: dict[str, int | None], expected: bool
) -> None:
    assert is_settled(_accepted(excess, units)) is expected
    assert is_settled(_accepted(excess, units, is_rejected=False))
