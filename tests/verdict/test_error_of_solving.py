"""Where readings reject a model, it is said what an error of the macro-step may do to them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge.adequacy import with_solving
from diagnosis.judge.verdict import _rejections
from tests.diagnosis.report_examples import ADEQUACY

LEFT = replace(ADEQUACY, is_rejected=True, is_irregular=False, chi_square={**ADEQUACY.chi_square, "after": 1.18})


def test_an_error_as_large_as_what_is_left_is_told_with_its_size_and_the_remedy() -> None:
    error = np.array([0.1, -1.9, 0.5, 0.3])
    (told,) = _rejections(with_solving(LEFT, lambda: error), ", and no law that was tried explains what is left")
    assert "no law that was tried explains what is left; but `time.macro_step` is so long" in told
    assert "1.9 times its noise, which may be what is left: shorten it first" in told


@pytest.mark.parametrize(
    ("error", "after"),
    [
        (np.full(100, 0.9), 1.18),  # no reading is moved by its noise
        (np.array([1.5, *np.zeros(99)]), 1.18),  # a ninth of what is left
        (np.array([1.9, -1.2]), 9.4),  # far more is left than that
        (None, 1.18),
        (np.zeros(0), 1.18),
    ],
)
def test_an_error_that_cannot_be_what_is_left_is_not_told(error: np.ndarray | None, after: float) -> None:
    found = with_solving(replace(LEFT, chi_square={**LEFT.chi_square, "after": after}), lambda: error)
    assert found.by_solving == 0.0
    assert "macro_step" not in _rejections(found, "")[0]


def test_it_is_not_asked_where_no_reading_rejects_the_model() -> None:
    met = replace(ADEQUACY, is_rejected=False, is_training_rejected=False)

    def never() -> np.ndarray:
        raise AssertionError

    assert with_solving(met, never) is met
