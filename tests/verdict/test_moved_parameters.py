"""What is said of parameters that a fit moved far: how many, which, and that their values are no measurements."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from diagnosis.judge.diagnosis import Moved, Verdict
from diagnosis.judge.recalibration import recalibration
from diagnosis.judge.verdict import verdict, why_open
from diagnosis.report.network import Network
from diagnosis.report.page import page
from diagnosis.report.sentences import moved_most, moved_text
from diagnosis.report.summary import print_summary
from diagnosis.report.user_units import Units
from diagnosis.search.problem import Parameter, Point
from diagnosis.search.structure import Structure
from tests.diagnosis.report_examples import ADEQUACY, diagnosis

QUIET_RIGHT = replace(ADEQUACY, is_rejected=False, is_nominal_rejected=False, day=())


def outcome(*z: float) -> Any:
    base = SimpleNamespace(point=Point(np.array(z)), widths=np.ones(len(z)))
    return SimpleNamespace(base_structure=Structure(0.0, "", 0.0, 1.0), base=base, first=None)


def test_parameters_that_are_counted_are_named_beside_the_count() -> None:
    """A report said that 4 parameters moved while a list of another fit had one."""
    tried: Any = SimpleNamespace(has_physics=True, untried=())
    names = ["coil[2,1].capacity", "load", "ambient_offset of recording monday"]
    (told,) = why_open(outcome(5.0, 0.1, -4.5), [], QUIET_RIGHT, tried, (), names)
    assert told == (
        "recalibration alone, with no law added, moves 2 parameters by more than 4 prior deviations: heat capacity of "
        "coil[2,1], room temperature of recording monday"
    )
    assert "stated" not in told
    (many,) = why_open(outcome(*[5.0] * 8), [], QUIET_RIGHT, tried, (), [f"p{n}" for n in range(8)])
    assert "moves 8 parameters" in many
    assert many.endswith("p0, p1, p2, p3, p4, p5 and 2 more")


def fitted(z: float, bounds: float) -> tuple[Moved, ...]:
    spring = Parameter("rig.stiffness", "N/m", 20.0, 0.1, bounds=bounds)
    fit: Any = SimpleNamespace(point=Point(np.array([z])), widths=np.ones(1))
    model: Any = SimpleNamespace(parameters=[spring])
    return recalibration(model, fit)


def test_a_parameter_at_its_bound_is_no_measurement() -> None:
    (held,) = fitted(1.5, 1.5)
    assert held.is_at_bound
    assert not held.is_measured
    assert held.value == pytest.approx(20.0 * math.exp(0.15))
    assert moved_text(held) == (
        "rig.stiffness: 1.16 times the scenario's value, that is 23.2 N/m (1.5 prior deviations, at its bound: no "
        "measurement of it)"
    )
    assert not fitted(1.5, 6.0)


def test_a_parameter_far_from_its_prior_is_no_measurement_and_one_near_it_may_be() -> None:
    (far,) = fitted(-3.5, 6.0)
    assert moved_text(far).endswith("(3.5 prior deviations: no measurement of it)")
    (near,) = fitted(2.5, 6.0)
    assert moved_text(near).endswith("(2.5 prior deviations)")


def test_a_bound_that_is_reached_within_the_prior_changes_no_verdict() -> None:
    tried: Any = SimpleNamespace(has_physics=True, untried=())
    quiet = replace(QUIET_RIGHT, is_training_rejected=False)
    assert verdict(outcome(0.0), [], quiet, tried, fitted(1.5, 1.5)) is Verdict.CONSISTENT
    assert verdict(outcome(0.0), [], quiet, tried, fitted(2.5, 6.0)) is Verdict.RECALIBRATED


def test_the_report_says_at_its_top_which_values_are_no_measurements() -> None:
    moved = (
        Moved("convection", "1", 1.083, True, 2.4),
        Moved("rig.c", "1", 3.0, True, 5.5, 60.0, "N*s/m", True),
        Moved("shift", "K", -1.6, False, -3.2),
    )
    told = replace(diagnosis(Verdict.RECALIBRATED), recalibration=moved)
    assert moved_most(told, Units()).startswith(
        "2 parameters of the model ended at a bound or at least 3 prior deviations from the scenario's value, where a "
        "fitted value is no measurement: rig.c: 3.00 times the scenario's value, that is 60.0 N*s/m (5.5 prior"
    )
    text = page(told, [], Network(()))
    assert "<dt>Parameters</dt>" in text
    assert "3 parameters are more than 2 prior deviations" in text
    console = Console(width=120, record=True)
    print_summary(told, console)
    shown = " ".join(console.export_text().split())
    assert "2 parameters of the model ended at a bound" in shown
    assert moved_most(replace(told, recalibration=moved[:1])) == ""
    assert "<dt>Parameters</dt>" not in page(replace(told, recalibration=moved[:1]), [], Network(()))
