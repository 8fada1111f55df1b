"""Other methods beside the diagnosis: what they are given, and the free run that judges them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cosim.unit.protocol import Array
from evaluation.systems.case import make
from evaluation.systems.others.__main__ import page
from evaluation.systems.others.data import Data, free_run, read
from evaluation.systems.others.methods import neural, sparse
from evaluation.systems.rigs import SLIDE


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> tuple[Data, ...]:
    """Of a slide without effects, whose numbers are off alone."""
    folder = tmp_path_factory.mktemp("case")
    make(folder, "null", 5, 0)
    return tuple(read(SLIDE, folder / "task" / name, 8.0) for name in ("first", "second", "third"))


def _truth(values: Array) -> Array:
    """What the equations leave of the truth of that case: its numbers are drawn first."""
    rng = np.random.default_rng([5, 0])
    numbers = {n: v * float(np.exp(0.03 * rng.standard_normal())) for n, v in SLIDE.numbers.items()}
    rows = [SLIDE.rates(numbers, v[:2], v[2:]) - SLIDE.rates(SLIDE.numbers, v[:2], v[2:]) for v in values]
    return np.array(rows)[:, 1:]


def test_states_and_what_the_equations_leave_come_from_the_readings(recordings: tuple[Data, ...]) -> None:
    first = recordings[0]
    expected = _truth(first.features)
    assert first.learnt.shape == expected.shape
    # the numbers of a null move the acceleration by 3 %, which noise in a second derivative hides in part
    assert np.corrcoef(first.learnt[:, 0], expected[:, 0])[0, 1] > 0.3
    assert np.corrcoef(first.states[:, 1], np.gradient(first.states[:, 0]))[0, 1] > 0.99


def test_a_free_run_with_what_is_missing_leaves_the_noise(recordings: tuple[Data, ...]) -> None:
    held_out = recordings[2]
    assert free_run(SLIDE, None, held_out) > 2.0
    assert free_run(SLIDE, _truth, held_out) == pytest.approx(1.0, abs=0.15)  # chi-square of 500 readings
    assert np.isinf(free_run(SLIDE, lambda v: 1e3 * v[:, 1:2], held_out))  # a damper that pushes


def test_methods_learn_a_damper_from_what_the_equations_leave(recordings: tuple[Data, ...]) -> None:
    """Derivatives without noise: 1 1/s more damping than the model has."""
    given = [replace(data, residuals=-data.states[:, 1:2]) for data in recordings[:2]]
    values = recordings[2].features
    for method in (sparse, neural):
        learnt, _ = method(SLIDE, given)
        error = np.std(learnt(values)[:, 0] + values[:, 1]) / np.std(values[:, 1])
        assert error < 0.1, method


def test_the_table_has_medians_of_nulls_and_of_others() -> None:
    one = {
        "kind": "null",
        "rig": "a rig",
        "case": "case_1",
        "as it is": {"chi": 4.0, "terms": 0, "seconds": 0.0},
        "sparse": {"chi": float("inf"), "terms": 7, "seconds": 2.0},
    }
    lines = page([one]).splitlines()
    assert lines[2] == "| case_1 | a rig | null | 4; 0; 0 s |  | ran away; 7; 2 s |  |  |  |  |"
    assert lines[3].startswith("| median of nulls | | | 4; 0; 0 s |")
