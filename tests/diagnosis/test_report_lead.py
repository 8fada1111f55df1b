"""Beside the verdict: the worst held-out channel and one number; isolability as a matrix; from when a law acts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diagnosis.judge.diagnosis import ChannelFit, Diagnosis, Estimate, Verdict
from diagnosis.judge.isolability import FaultClass, Isolability
from diagnosis.report.experiment_section import isolability_section
from diagnosis.report.lead import lead, told, worst
from diagnosis.report.page import write_html
from diagnosis.report.section import named, section
from diagnosis.report.sentences import when
from diagnosis.report.series import Series
from diagnosis.report.user_units import Units
from tests.diagnosis.report_examples import CONTACT, diagnosis
from tests.diagnosis.test_report import Page

TIMES = np.linspace(0.0, 10.0, 50)


def channel(name: str, is_held_out: bool, title: str = "tuesday") -> Series:
    level = np.full(50, 0.1)
    return Series(name, "A", TIMES, level, level + 9.88e-3, level + 3e-3, level + 1.98e-3, 2e-3, title, is_held_out)


def judged(name: str, before: float, is_held_out: bool, title: str = "tuesday") -> ChannelFit:
    stages = {"before": before, "recalibrated": 1.7, "after": 1.0}
    rmse = {"before": 9.88e-3, "recalibrated": 3.15e-3, "after": 1.98e-3}
    return ChannelFit(title, is_held_out, name, "A", rmse, stages, stages)


@pytest.fixture
def answer() -> Diagnosis:
    fits = (
        judged("string[1].current", 17.0, True),
        judged("string[2].current", 24.0, True),
        judged("string[2].current", 99.0, False),
    )
    return replace(diagnosis(Verdict.MISSING_PHYSICS), fit=fits, units=("mA",))


def test_the_number_is_in_the_unit_of_the_user_and_names_the_noise(answer: Diagnosis) -> None:
    line = told(channel("string[2].current", True), answer.fit[1], Units(("mA",)))
    assert line == "current error 9.88 → 1.98 mA (RMSE), noise of its sensor 2.00 mA (stated)"
    unstated = told(channel("string[2].current", True), replace(answer.fit[1], is_noise_stated=False), Units(("mA",)))
    assert unstated.endswith("noise of its sensor 2.00 mA (estimated from neighbouring readings)")


def test_the_worst_held_out_channel_is_taken_and_training_only_where_nothing_was_held_out(answer: Diagnosis) -> None:
    series = [
        channel("string[1].current", True),
        channel("string[2].current", True),
        channel("string[2].current", False),
    ]
    found = worst(answer, series)
    assert found is not None
    assert found[0] is series[1]
    found = worst(answer, series[2:])
    assert found is not None
    assert not found[0].is_held_out
    beside = lead(answer, series[2:])
    assert beside is not None
    assert "no recording was held out" in beside.whose
    assert lead(answer, []) is None
    assert lead(replace(answer, fit=()), series) is None


def test_a_model_that_nothing_changed_has_one_number(answer: Diagnosis) -> None:
    level = np.full(50, 0.1)
    same = Series("string[2].current", "A", TIMES, level, level, level, level, 2e-3, "tuesday", True)
    assert told(same, answer.fit[1], Units(("mA",))).startswith("current error 9.88 mA (RMSE)")


def test_training_stands_beside_held_out_and_the_command_runs_the_amended_model(
    answer: Diagnosis, tmp_path: Path
) -> None:
    series = [channel("string[2].current", True), channel("string[2].current", False)]
    write_html(replace(answer, amended_model="my answer/amended/scenario.yaml"), series, tmp_path / "r.html")
    text = (tmp_path / "r.html").read_text()
    page = Page(text)
    assert "cosim run 'my answer/amended/scenario.yaml' --out runs/amended" in page.text
    assert text.count('<div class="pair">') == 1
    pair = text[text.index('<div class="pair">') :]
    assert pair.index("tuesday (training)") < pair.index("tuesday (held out)")
    assert "current error 9.88" in page.beside
    assert "prefers-color-scheme: dark" in text
    assert "@media print" in text
    assert 'title="Root mean square' in text


def test_isolability_is_a_matrix_that_agrees_with_the_classes() -> None:
    classes = (FaultClass(("a", "b"), True), FaultClass(("c",), False))
    page = Page(isolability_section(Isolability(("a and b look alike.",), classes)).body)
    assert page.text.count("●") == 2  # a with b, b with a; what is in the note is words
    assert page.text.count("○") == 4
    assert page.text.count("yes") == 1 + 1
    assert page.text.count("no") - page.text.count("not") - page.text.count("note") >= 1
    many = (FaultClass(tuple(f"f{i}" for i in range(40)), True),)
    assert "●" not in isolability_section(Isolability((), many)).body


def test_a_law_with_an_instant_acts_from_then_on() -> None:
    onset = Estimate("instant", "s", 33.4, 32.9, 33.9)
    begun = replace(CONTACT, parameters=(*CONTACT.parameters, onset), recording="monday")
    assert when(begun) == "from 33.4 s (32.9 to 33.9) of monday on"
    assert when(CONTACT).startswith("seen 5.00 to 42.5 s")


def test_sections_of_one_title_have_names_of_their_own() -> None:
    left = section("What is left", "left.html.j2", rows=[])
    assert list(named([left, left])) == ["what-is-left", "what-is-left-2"]
