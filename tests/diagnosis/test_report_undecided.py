"""What a reader is told where the verdict is `cannot tell`, or where effects cannot be told from each other."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from cosim.html_page import environment
from diagnosis.curves import drawn_channels
from diagnosis.judge.diagnosis import Diagnosis, Difference, Finding, Verdict
from diagnosis.judge.isolability import ExtraChannel, Isolability
from diagnosis.judge.location import Remainder
from diagnosis.report.figures import residual_limits, series_figure
from diagnosis.report.page import write_html
from diagnosis.report.section import TEMPLATES
from diagnosis.report.series import Series
from diagnosis.report.summary import LINES, print_summary
from diagnosis.report.undecided import what_decides
from diagnosis.report.user_units import Units
from tests.diagnosis.report_examples import CONTACT, EXPERIMENT, LAG, diagnosis, series
from tests.diagnosis.test_report import Page, read_page

LEFT = Remainder("coil[2,5].temperature (steps)", 30.0, 42.0, -7.7, 4.9)


WHY = "it predicts the readings that judge (held-out recordings) worse: -2 log likelihood rises by 300"


def rejected() -> Diagnosis:
    """A lag that training shows, and that makes the channels held out worse."""
    lag = replace(LAG, is_accepted=False, doubts=(WHY,), held_out_gain=-300.0)
    told = diagnosis(Verdict.CANNOT_TELL)
    return replace(told, findings=(lag,), left=())


def unexplained() -> Diagnosis:
    return replace(diagnosis(Verdict.CANNOT_TELL), left=(LEFT,))


def page_of(told: Diagnosis, drawn: list[Series], folder: Path) -> str:
    write_html(told, drawn, folder / "report.html")
    return Page(read_page(folder / "report.html")).text


def shades(one: Series, findings: Sequence[Finding] = (), left: Sequence[Remainder] = ()) -> int:
    """Areas that a figure has more than the same without findings and remainders."""
    with_them, without = (
        base64.b64decode(address.partition(",")[2]).decode().count("<path")
        for address in (series_figure(one, findings, left), series_figure(one, ()))
    )
    return with_them - without


def lines_of(told: Diagnosis, width: int) -> list[str]:
    stream = io.StringIO()
    print_summary(told, Console(file=stream, width=width))
    return stream.getvalue().splitlines()


def test_the_top_of_the_page_says_what_is_left_why_and_what_would_decide(tmp_path: Path) -> None:
    text = page_of(unexplained(), [series()], tmp_path)
    top = text[: text.index("Channels")]
    for part in (
        "coil[2,5].temperature (steps), 30.0 to 42.0 s: standardised sum of residuals at least 7.70; white noise alone",
        "driven alone, coil[2,5] departs most (thermal)",
        "Repeat the recording in which most is left: what comes back",
        "out/amended/scenario.yaml (recalibrated, nothing added)",
        "white noise alone stays below the limit in 99 of 100",
    ):
        assert part in top, part
    assert "Amended model" not in text


def test_units_that_depart_in_nothing_when_driven_alone_are_told_so(tmp_path: Path) -> None:
    (location,) = unexplained().locations
    quiet = replace(unexplained(), locations=(replace(location, z=4.5),))  # its limit is 4.6
    assert "no unit departs when it is driven alone" in page_of(quiet, [], tmp_path)
    assert "driven alone" not in " ".join(lines_of(replace(quiet, locations=()), 100))


def test_what_is_not_accepted_is_told_as_a_suggestion_and_not_as_found(tmp_path: Path) -> None:
    text = page_of(rejected(), [series()], tmp_path)
    top = text[: text.index("Where and when it would act")]
    for part in (
        "Suggestedsensor lag; measurement: coil[1,2].temperature (coil[1,2]); seen 10.0 to 95.0 s",
        WHY,
        "Record a programme of the training once more",
        "out/amended/scenario.yaml (recalibrated, nothing added)",
    ):
        assert part in top, part
    assert f"Suggestion 1, not accepted: {LAG.statement}" in text
    assert "Why not accepted" + WHY in text
    for contradiction in ("Finding 1", "Amended model"):
        assert contradiction not in text, contradiction
    accepted = page_of(diagnosis(Verdict.MEASUREMENT_FAULT), [], tmp_path)
    for part in ("How much better", "Finding 1", "Amended model"):
        assert part in accepted, part


@pytest.mark.parametrize("width", [60, 80, 140])
@pytest.mark.parametrize("told", [unexplained(), rejected()], ids=["unexplained", "rejected"])
def test_the_summary_says_why_and_what_would_decide(told: Diagnosis, width: int) -> None:
    lines = lines_of(told, width)
    assert len(lines) <= LINES
    assert max(map(len, lines)) <= width
    whole = " ".join(" ".join(lines).split())
    assert ("belongs to the rig" if not told.findings else "its form is then in doubt.") in whole
    if told.findings:
        assert "suggested, not accepted: sensor lag" in whole


def test_an_experiment_that_was_designed_takes_the_place_of_a_repeat(tmp_path: Path) -> None:
    text = page_of(replace(unexplained(), next_experiment=EXPERIMENT), [], tmp_path)
    assert "Staircase for 60 s would decide." in text
    assert "Repeat the recording" not in text
    # What the held-out recordings reject is not among the rivals of an experiment: both are reported.
    assert "Record a programme of the training" in page_of(
        replace(rejected(), next_experiment=EXPERIMENT), [], tmp_path
    )


def test_what_an_effect_cannot_be_told_from_stands_at_the_top(tmp_path: Path) -> None:
    told = diagnosis(Verdict.MISSING_PHYSICS)
    text = page_of(told, [], tmp_path)
    top = text[: text.index("Where and when")]
    assert "Open1: The recordings cannot tell it from: the model's own reference resistance." in top
    alone = replace(told, findings=told.findings[1:])
    assert "Open" not in page_of(alone, [], tmp_path)


def test_the_channel_in_which_most_is_left_is_drawn_first_and_shaded(tmp_path: Path) -> None:
    other = replace(series(), is_held_out=True)
    mine = replace(series(), is_held_out=False)
    text = page_of(unexplained(), [other, mine], tmp_path)
    assert text.index("coil[2,5].temperature, steps (training)") < text.index("coil[2,5].temperature, steps (held out)")

    assert shades(mine, left=(LEFT,)) == 2  # above and below
    assert shades(other, left=(LEFT,)) == 0  # another programme has other times
    assert shades(mine, left=(replace(LEFT, channel="coil[2,4].temperature (steps)"),)) == 0


def test_findings_are_shaded_in_training_alone() -> None:
    mine, held_out = (replace(series("string[3].current", "A", 0.4), is_held_out=h) for h in (False, True))
    assert shades(mine, (CONTACT,)) == 2 * len(CONTACT.intervals)
    assert shades(held_out, (CONTACT,)) == 0


def test_channels_are_chosen_by_findings_then_by_what_is_left_then_by_the_worst_fit() -> None:
    told = replace(rejected(), left=(replace(LEFT, channel="coil[4,4].temperature (steps)"),))
    fits = [f for f in told.fit if f.is_held_out is False]
    fits[7] = replace(fits[7], chi_square={**fits[7].chi_square, "recalibrated": 50.0})
    assert [fits[i].channel for i in drawn_channels(told, fits)] == [
        "coil[1,2].temperature",
        "coil[4,4].temperature",
        "coil[2,2].temperature",
    ]


def test_the_axis_of_time_has_the_unit_in_which_the_text_names_instants() -> None:
    """Over 4 h: ticks at round numbers of minutes, not at round numbers of seconds."""
    times = np.linspace(0.0, 240.0 * 60.0, 200)
    flat = np.full(200, 300.0)
    one = Series("vessel.temperature", "K", times, flat, flat + 1.0, flat + 0.5, flat, 0.1)

    def drawn(units: Units) -> str:
        return base64.b64decode(series_figure(one, (), (), units).partition(",")[2]).decode()

    minutes, seconds = drawn(Units(("min",))), drawn(Units())
    assert "time [min]" in minutes
    assert "time [s]" not in minutes
    assert all(f"<!-- {n} -->" in minutes for n in (50, 100, 150, 200))
    assert "time [s]" in seconds
    assert "<!-- 10000 -->" in seconds
    assert Units(("min",)).span(0.0, 240.0 * 60.0) == "0 to 240 min"


def test_residuals_are_scaled_by_fitted_models_where_nothing_was_added() -> None:
    times = np.arange(100.0)
    flat = np.zeros(100)
    one = Series("coil[1,1].temperature", "K", times, flat, flat + 50.0, flat + 0.6, flat + 0.6, 0.1)
    # 0.6 K and a margin of 8 %; the model before them, 50 K off, leaves the picture.
    assert residual_limits(one, 1.0) == pytest.approx((-0.648, 0.648), rel=1e-12)


def test_how_the_fast_simulation_differs_stands_where_certainty_is_told(tmp_path: Path) -> None:
    by = (Difference("steps", "coil[2,5].temperature", "before", 0.531, 111.0),)
    text = page_of(replace(unexplained(), differences=by, held_out_by="free runs, `cosim run`"), [], tmp_path)
    assert "Judged byfree runs, cosim run" in text
    told = "most on coil[2,5].temperature (before): by 0.531 deviations, and its chi-square per sample there is 111."
    assert text.index("How sure") < text.index(told)


def test_code_between_backticks_is_marked_and_stays_escaped() -> None:
    told = environment(TEMPLATES).from_string('{% from "parts.html.j2" import coded %}{{ coded(text) }}')
    assert told.render(text="run `a <b>` now") == "run <code>a &lt;b&gt;</code> now"
    assert told.render(text="a < b") == "a &lt; b"


def test_only_the_best_extra_channel_is_called_so(tmp_path: Path) -> None:
    extra = tuple(
        ExtraChannel(name, 8, f"The extra channel that would help most is {name}: it would tell {what} from a sensor.")
        for name, what in (("a second sensor", "heat"), ("a balance", "force"))
    )
    text = page_of(replace(unexplained(), isolability=Isolability((), (), extra)), [], tmp_path)
    assert "it would tell force from a sensor." in text
    assert "help most" not in text


@pytest.mark.parametrize(
    ("gain", "has_scatter", "text"),
    [
        (11.5, True, "by no more than such fabrics differ by"),
        (-300.0, True, "predicts the repeat worse too"),
        (11.5, False, "predicts the repeat worse too"),
    ],
)
def test_what_decides_where_readings_are_met_better_within_the_scatter_of_contacts(
    gain: float, has_scatter: bool, text: str
) -> None:
    told = rejected()
    (lag,) = told.findings
    held_out = replace(told.fit[0], is_held_out=True)
    assert told.adequacy is not None
    told = replace(
        told,
        findings=(replace(lag, held_out_gain=gain),),
        fit=(*told.fit, held_out),
        adequacy=replace(told.adequacy, has_scatter=has_scatter),
    )
    assert text in what_decides(told)
