"""Blocks of numbers: what comes back, how exact, how large."""

import hypothesis.extra.numpy as drawn
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chainmail.play.codec import LARGEST, Block, decode, encode, quantised

_CODES = drawn.arrays(
    np.int64, st.tuples(st.integers(1, 4), st.integers(1, 30)), elements=st.integers(-LARGEST + 1, LARGEST - 1)
)


@given(_CODES, _CODES)
@settings(max_examples=60, deadline=None)
def test_every_code_comes_back_as_it_was(first, second):
    blocks = [Block("a", first, 1.0, np.zeros(len(first))), Block("b", second, 1.0, np.zeros(len(second)))]
    found = decode(*encode(blocks))
    np.testing.assert_array_equal(found["a"], first)
    np.testing.assert_array_equal(found["b"], second)


def test_no_value_is_off_by_more_than_half_a_step():
    values = np.random.default_rng(1).normal(size=(5, 200)).cumsum(axis=1)
    block = quantised("walk", values, 1e-3)
    found = decode(*encode([block]))["walk"]
    # half a step, and the ninth digit to which offsets are written
    assert 0.4e-3 < np.abs(found - values).max() <= 0.5e-3 + 1e-8
    np.testing.assert_allclose(found, block.values(), atol=1e-8)


def test_what_moves_evenly_is_predicted_from_two_values():
    ramp = Block("ramp", np.arange(5000)[None] * 77, 1.0, np.zeros(1))
    text, table = encode([ramp])
    assert table[0]["order"] == 2
    assert len(text) < 100


def test_what_jumps_to_and_fro_is_predicted_from_one_value():
    steps = np.random.default_rng(2).integers(0, 2, (1, 5000))
    assert encode([Block("noise", steps, 1.0, np.zeros(1))])[1][0]["order"] == 1


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_value_that_is_not_finite_is_refused(value):
    with pytest.raises(ValueError, match="heat is not finite"):
        quantised("heat", np.array([[0.0, value]]), 0.1)


def test_a_range_that_needs_too_many_steps_is_refused():
    with pytest.raises(ValueError, match="more than 268435456 steps"):
        quantised("far", np.array([[0.0, 1.0]]), 1e-9)
