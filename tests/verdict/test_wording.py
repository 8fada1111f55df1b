"""Small words of a diagnosis: spelling of names, plurals, digits, and intervals within the readings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge.diagnosis import Domain, Searched, Verdict
from diagnosis.judge.extent import within_readings
from diagnosis.report.display import likelihood, parameter_words
from diagnosis.report.sentences import improvement, searched
from tests.diagnosis.report_examples import diagnosis, fit


def test_a_parameter_of_an_fmu_is_called_as_its_scenario_calls_it() -> None:
    assert parameter_words("room.c_air") == "room.c_air"
    assert parameter_words("coil[2,1].capacity") == "heat capacity of coil[2,1]"


def test_one_law_is_no_laws() -> None:
    told = replace(diagnosis(Verdict.CONSISTENT), searched=Searched((Domain("mechanical", 1, 0, 1),)))
    assert searched(told) == "mechanical: 1 law (0 without a name) at 1 place"


def test_where_nothing_was_fitted_the_one_number_is_said_to_be_of_the_scenario() -> None:
    same = dict.fromkeys(("before", "recalibrated", "after"), 7.0)
    told = replace(
        diagnosis(Verdict.CANNOT_TELL), findings=(), fit=(replace(fit("a", "K", 1.0, True), chi_square=same),)
    )
    assert improvement(told).endswith("7.00 by the scenario as given (nothing was fitted)")


@pytest.mark.parametrize(("value", "shown"), [(12.3456, "12.3"), (1234567.8, "1.235e+06"), (98765.4, "98770")])
def test_a_log_likelihood_has_four_digits_at_most(value: float, shown: str) -> None:
    assert likelihood(value) == shown


def test_an_interval_ends_with_the_last_reading() -> None:
    times = [np.array([2.0, 50.0]), np.array([1.0, 59.8])]
    assert within_readings([(0.0, 12.0), (35.4, 61.2)], times) == ((1.0, 12.0), (35.4, 59.8))
