"""How much of the mismatch a law leaves is said as a share, and as a multiple where it makes it larger."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from diagnosis.judge.acceptance import Accepted
from diagnosis.judge.reservations import much_left


@pytest.mark.parametrize(
    ("left", "recalibrated", "said"),
    [
        (3.0, 10.0, "30 % of the squared mismatch that recalibration leaves in the held-out recordings is still"),
        (10.0, 10.0, "100 % of the squared mismatch"),
        (34.4, 10.0, "the squared mismatch in the held-out recordings is 3.4 times what recalibration leaves of it"),
    ],
)
def test_what_is_left_is_a_share_of_at_most_all(left: float, recalibrated: float, said: str) -> None:
    agreements = {"agreement": left, "agreement_recalibrated": recalibrated}
    found: Any = SimpleNamespace(
        basis="held-out recordings", **{name: SimpleNamespace(excess=value) for name, value in agreements.items()}
    )
    assert much_left(cast(Accepted, found)).startswith(said)
