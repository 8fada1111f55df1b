"""What a diagnosis hands over: file, schema, page and summary, for every verdict."""

from __future__ import annotations

import base64
import io
import json
import math
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from rich.console import Console

from cosim.unit.errors import InputError
from diagnosis.judge.diagnosis import Estimate, Moved, Verdict
from diagnosis.judge.isolability import Isolability
from diagnosis.report.json_file import as_json, read_json, write_json
from diagnosis.report.network import Network
from diagnosis.report.page import write_html
from diagnosis.report.schema import PUBLISHED, as_text, schema
from diagnosis.report.sentences import improvement
from diagnosis.report.series import Series
from diagnosis.report.summary import LINES, print_summary
from tests.diagnosis.report_examples import CONTACT, FINDINGS, HOSTILE, UNNAMED, diagnosis, fit, series


def read_page(path: Path) -> str:
    return path.read_text(encoding="utf-8")


class Page(HTMLParser):
    """Elements, pictures, links and text of a page; every element that opens must close.

    The list of links and what stands beside the answer are no part of the text.
    """

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.addresses: list[str] = []
        self.links: list[str] = []
        self.ids: list[str] = []
        self.names: list[str] = []
        self.text = self.beside = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.names.append(tag)
        self.addresses += [v or "" for k, v in attrs if k == "src"]
        self.links += [v or "" for k, v in attrs if k == "href"]
        self.ids += [v or "" for k, v in attrs if k == "id"]
        if tag not in ("meta", "img", "input"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if "aside" in self.open:
            self.beside += data
        elif self.open and self.open[-1] != "style" and "nav" not in self.open:
            self.text += data.replace("\n", " ")  # as browsers show it


@pytest.mark.parametrize("verdict", list(Verdict))
def test_a_diagnosis_survives_its_file_and_obeys_the_schema(verdict: Verdict, tmp_path: Path) -> None:
    written = diagnosis(verdict, HOSTILE)
    write_json(written, tmp_path / "diagnosis.json")
    content = json.loads(read_page(tmp_path / "diagnosis.json"))
    jsonschema.Draft202012Validator(schema()).validate(content)
    assert content["verdict"] == verdict.value
    assert read_json(tmp_path / "diagnosis.json") == written


def test_numbers_that_are_not_finite_become_null_and_are_not_known_when_read(tmp_path: Path) -> None:
    unbounded = replace(CONTACT, parameters=(Estimate("R_contact", "ohm", np.float64(0.3), -math.inf, math.inf),))
    write_json(replace(diagnosis(Verdict.CANNOT_TELL), findings=(unbounded,), margin=math.nan), tmp_path / "d.json")
    content = json.loads(read_page(tmp_path / "d.json"))
    jsonschema.Draft202012Validator(schema()).validate(content)
    assert content["findings"][0]["parameters"][0] == {
        "name": "R_contact",
        "unit": "ohm",
        "value": 0.3,
        "lower": None,
        "upper": None,
        "meaning": "",
        "physical": None,
        "is_reading": False,
    }
    again = read_json(tmp_path / "d.json")
    assert math.isnan(again.margin)
    assert math.isnan(again.findings[0].parameters[0].upper)


def test_the_published_schema_is_the_one_the_code_makes() -> None:
    assert PUBLISHED.read_text(encoding="utf-8") == as_text()


def test_the_schema_describes_every_key_and_refuses_others() -> None:
    made = schema()
    objects = [made, *(d for d in made["$defs"].values() if d["type"] == "object")]
    assert len(objects) == 29
    for one in objects:
        assert all(len(about["description"]) > 3 for about in one["properties"].values())
    content = json.loads(json.dumps({**_content(), "surprise": 1}))
    assert [e.validator for e in jsonschema.Draft202012Validator(made).iter_errors(content)] == ["additionalProperties"]


def _content() -> dict[str, object]:
    return as_json(diagnosis(Verdict.MISSING_PHYSICS))


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"surprise": 1}, "surprise"),
        ({"seed": "seven"}, "seed"),
        ({"verdict": "perhaps"}, "verdict"),
        ({"findings": [{"unit": "thermal", "colour": "red"}]}, "findings.0.colour"),
    ],
)
def test_a_file_with_other_keys_or_types_is_refused_by_name(
    change: dict[str, object], key: str, tmp_path: Path
) -> None:
    (tmp_path / "d.json").write_text(json.dumps({**_content(), **change}))
    with pytest.raises(InputError) as caught:
        read_json(tmp_path / "d.json")
    assert caught.value.key == key


def test_a_file_that_is_missing_or_no_json_is_refused(tmp_path: Path) -> None:
    (tmp_path / "d.json").write_text("{")
    for name, problem in (("d.json", "is no JSON"), ("none.json", "cannot be read")):
        with pytest.raises(InputError, match=problem):
            read_json(tmp_path / name)


@pytest.mark.parametrize("verdict", list(Verdict))
def test_the_page_tells_verdict_and_findings_and_loads_nothing(verdict: Verdict, tmp_path: Path) -> None:
    told = diagnosis(verdict)
    write_html(told, [series(), series("string[3].current", "A", 0.4)], tmp_path / "report.html", title="fabric")
    page = Page(read_page(tmp_path / "report.html"))
    assert not page.open
    assert told.statement in page.text
    assert verdict.value in page.text
    assert "5321 simulations, seed 7" in page.text
    for finding in told.findings:
        assert finding.statement in page.text
        assert finding.law in page.text
    assert all(a.startswith("data:image/svg+xml;base64,") for a in page.addresses)
    assert page.links
    assert {link[1:] for link in page.links} == set(page.ids)  # every link leads to a section of this page
    assert len(set(page.ids)) == len(page.ids)
    # Two channels and, where one was judged, the worst of them beside the answer; with findings the network and the
    # time line, where there are any waveform and next experiment.
    judged = {f.channel for f in told.fit} & {"coil[2,5].temperature", "string[3].current"}
    expected = 2 + bool(judged) + (2 if told.findings else 0) + len(told.waveforms) + (told.next_experiment is not None)
    assert len(page.addresses) == expected
    for address in page.addresses:
        ElementTree.fromstring(base64.b64decode(address.partition(",")[2]))


def test_the_page_says_where_units_depart_what_is_left_and_what_would_decide(tmp_path: Path) -> None:
    told = replace(diagnosis(Verdict.MISSING_PHYSICS), left=diagnosis(Verdict.CANNOT_TELL).left)
    write_html(told, [], tmp_path / "report.html")
    text = Page(read_page(tmp_path / "report.html")).text
    for part in (
        "heat balance",
        "9.25",
        "current (+0.81)",
        "coil[4,4].temperature",
        "30.0 to 42.0 s",
        "7.70",
        "Staircase for 60 s would decide.",
        "contact resistance at string[3]",
        "60 %",
        "8.25",
        "0.0625",
        "cosim run out/next_experiment/scenario.yaml",
        "supply.voltage from 0 to 6 V",
        "rig/monday",
        "1.00 (0.900 to 1.10)",
    ):
        assert part in text, part


def test_page_and_summary_say_that_a_long_recording_was_thinned(tmp_path: Path) -> None:
    told = diagnosis(Verdict.MISSING_PHYSICS)
    sentence = "Of very many readings a part was used, at even distances and as they are: 20000 of 1000000 in monday."
    for thinned, is_said in ((980_000, True), (0, False)):
        used = replace(told.recordings[0], title="monday", readings=20_000, thinned=thinned)
        console = Console(file=io.StringIO(), width=100)
        print_summary(replace(told, recordings=(used,)), console)
        stream = console.file
        assert isinstance(stream, io.StringIO)
        assert (sentence in " ".join(stream.getvalue().split())) is is_said
        write_html(replace(told, recordings=(used,)), [], tmp_path / "report.html")
        assert (sentence in (tmp_path / "report.html").read_text(encoding="utf-8")) is is_said


def test_the_summary_says_what_would_decide_and_what_is_left() -> None:
    console = Console(file=io.StringIO(), width=100)
    print_summary(replace(diagnosis(Verdict.MISSING_PHYSICS), findings=()), console)
    print_summary(diagnosis(Verdict.CANNOT_TELL), console)
    stream = console.file
    assert isinstance(stream, io.StringIO)
    assert "next     Staircase for 60 s would decide. Scenario: out/next_experiment/scenario.yaml" in stream.getvalue()
    assert (
        "left in  coil[4,4].temperature, 30.0 to 42.0 s: standardised sum of residuals at least 7.70; white"
        in stream.getvalue()
    )


def test_the_page_gives_intervals_ambiguity_and_readable_units(tmp_path: Path) -> None:
    write_html(diagnosis(Verdict.MISSING_PHYSICS), [], tmp_path / "report.html")
    text = Page(read_page(tmp_path / "report.html")).text
    assert "0.312 ohm (0.281 to 0.350)" in text
    assert "5.00 to 42.5 s, 60.0 to 88.0 s" in text
    assert "The recordings cannot tell it from: the model's own reference resistance." in text
    assert "the voltage of one coil decides" in text
    # 0.003 A are 3 mA: 27, 12 and 3 by the three stages.
    assert re.search(
        r"string current \[mA\], 6 channels27\.012\.03\.0081\.016\.01\.0030\.012\.02\.503\.00 to 3\.00", text
    )
    told = "81.0 before, 16.0 recalibrated only, 1.00 after"
    assert f"chi-square per sample (held out, numbers of the day as written down), all channels: {told}" in text


def test_foreign_text_is_shown_and_never_run(tmp_path: Path) -> None:
    told = diagnosis(Verdict.MISSING_PHYSICS, HOSTILE)
    told = replace(
        told,
        statement=HOSTILE,
        isolability=Isolability((HOSTILE,)),
        recalibration=(Moved(HOSTILE, "1", 1.1, True, 2.5),),
    )
    one = replace(series(), channel=HOSTILE, recording=HOSTILE)
    write_html(told, [one], tmp_path / "report.html", title=HOSTILE)
    text = read_page(tmp_path / "report.html")
    page = Page(text)
    assert "script" not in page.names
    assert page.text.count("<script>alert('x')</script> & \"run\"") > 10
    assert page.text.count("&") == page.text.count("</script> & ")  # nothing is escaped twice
    assert "\x1b" not in text


def test_every_text_of_a_diagnosis_is_escaped_once(tmp_path: Path) -> None:
    written, told = _hostile(replace(diagnosis(Verdict.MISSING_PHYSICS), left=diagnosis(Verdict.CANNOT_TELL).left))
    write_html(told, [], tmp_path / "report.html", network=Network())
    page = Page(read_page(tmp_path / "report.html"))
    assert not page.open
    assert "script" not in page.names
    assert "&lt;" not in page.text
    assert "&amp;" not in page.text
    assert written > 50
    assert page.text.count("<script>&\"'") > 30


def _hostile(value: Any) -> tuple[int, Any]:
    """Every text of a diagnosis with a tag, an ampersand and quotes after it, and how many there are."""
    if isinstance(value, str) and not isinstance(value, Enum):
        return 1, f"{value}<script>&\"'"
    if isinstance(value, tuple):
        parts = [_hostile(v) for v in value]
        return sum(n for n, _ in parts), tuple(v for _, v in parts)
    if is_dataclass(value) and not isinstance(value, type):
        # Units and stages are keys of tables of numbers; a noise is one of a few words.
        kept = ("unit", "units", "noise", "value_unit")
        changed = {f.name: _hostile(getattr(value, f.name)) for f in fields(value) if f.name not in kept}
        return sum(n for n, _ in changed.values()), replace(value, **{k: v for k, (_, v) in changed.items()})
    return 0, value


def test_a_page_without_held_out_recordings_and_without_a_network_says_so(tmp_path: Path) -> None:
    fits = (fit("rod.angle", "rad", 0.01, False),)
    told = replace(
        diagnosis(Verdict.MISSING_PHYSICS),
        fit=fits,
        findings=(replace(UNNAMED, elements=("rod",)),),
        waveforms=(),
        next_experiment=None,
    )
    write_html(told, [], tmp_path / "report.html", network=Network())
    page = Page(read_page(tmp_path / "report.html"))
    assert "No recording was held out" in page.text
    assert len(page.addresses) == 1  # the time line alone
    assert "rod angle" in page.text


def test_the_same_diagnosis_gives_the_same_page(tmp_path: Path) -> None:
    for name in ("a.html", "b.html"):
        write_html(diagnosis(Verdict.MISSING_PHYSICS), [series()], tmp_path / name)
    assert read_page(tmp_path / "a.html") == read_page(tmp_path / "b.html")


@pytest.mark.parametrize("verdict", list(Verdict))
@pytest.mark.parametrize("width", [60, 80, 140])
def test_the_summary_fits_a_screen_and_tells_the_verdict_first(verdict: Verdict, width: int) -> None:
    stream = io.StringIO()
    told = replace(diagnosis(verdict), findings=FINDINGS[verdict] * 3, isolability=Isolability(("a statement",) * 9))
    print_summary(told, Console(file=stream, width=width))
    lines = stream.getvalue().splitlines()
    assert len(lines) <= LINES
    assert max(map(len, lines)) <= width
    assert lines[0].startswith(f"{verdict.value.upper()}  The answer is")
    assert f"{told.simulations} simulations, seed 7" in stream.getvalue()


def test_the_summary_has_law_interval_fit_and_false_alarms() -> None:
    stream = io.StringIO()
    print_summary(replace(diagnosis(Verdict.MISSING_PHYSICS), findings=(CONTACT,)), Console(file=stream, width=120))
    text = " ".join(stream.getvalue().split())
    assert "R_string = R_string_0 + R_contact" in text
    assert "R_contact = 0.312 ohm (0.281 to 0.350)" in text
    assert "held out, coil temperature: RMSE 2.70 -> 1.20 -> 0.300 K" in text
    assert "noise alone gives the first gain in 0.2 % of searches" in text
    assert "thermal: 30 laws (12 without a name) at 37 places; not tried: `plant` (fmu) offers no place" in text
    assert "convection: 1.08 times the scenario's value (2.4 prior deviations)" in text
    assert "shift: -1.60 K (3.0 prior deviations: no measurement of it)" in text
    assert "the model's own reference resistance: the voltage of one coil decides" in text


def test_the_summary_does_not_let_foreign_text_steer_the_terminal() -> None:
    stream = io.StringIO()
    told = replace(diagnosis(Verdict.CANNOT_TELL, HOSTILE), statement=f"[red]{HOSTILE}[/red]")
    print_summary(told, Console(file=stream, width=120, force_terminal=False))
    assert "\x1b" not in stream.getvalue()
    assert "[red]<script>" in stream.getvalue()


def test_long_gappy_and_single_sample_channels_make_a_small_page(tmp_path: Path) -> None:
    times = np.arange(100_000) * 0.01
    wave = 300.0 + np.sin(times)
    gaps = np.where(times % 50.0 < 5.0, np.nan, wave)
    long = Series("heater.temperature", "K", times, gaps, wave, wave + 1.0, wave, np.full(100_000, 0.1))
    unknown = Series("heater.power", "W", times[:5], *[np.full(5, np.nan)] * 4, 0.1)
    single = Series("rod.angle", "rad", *[np.array([1.0])] * 5, 0.01)
    write_html(diagnosis(Verdict.MISSING_PHYSICS), [long, unknown, single], tmp_path / "report.html")
    # 1200 points a curve and five curves, about 20 bytes a point, as base64, beside 80 rows of fits.
    assert (tmp_path / "report.html").stat().st_size < 1_200_000
    assert (
        len(Page(read_page(tmp_path / "report.html")).addresses) == 7
    )  # with network, time line, waveform and next experiment


def test_the_improvement_is_told_where_a_finding_shows_too() -> None:
    told = diagnosis(Verdict.MISSING_PHYSICS)
    finding = replace(told.findings[0], channels=("string[3].current (steps)",))
    better = [
        replace(f, chi_square={**f.chi_square, "after": 0.5}) if f.channel == "string[3].current" else f
        for f in told.fit
    ]
    said = improvement(replace(told, findings=(finding,), fit=tuple(better)))
    assert "where findings show most: 81.0 before, 16.0 recalibrated only, 0.500 after; with those numbers" in said
    everywhere = replace(finding, channels=tuple(f.channel for f in told.fit))
    assert "where findings" not in improvement(replace(told, findings=(everywhere,)))
