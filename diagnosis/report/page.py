"""report.html: one file that opens without a network."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path

from cosim.run_folder import write_atomically
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.report.anchors import anchored
from diagnosis.report.display import clean, listed, number
from diagnosis.report.experiment_section import experiment_section, isolability_section
from diagnosis.report.figures import is_left_in, network_figure, series_figure, timeline_figure
from diagnosis.report.finding_section import finding_section
from diagnosis.report.fit_section import TITLE, fit_section
from diagnosis.report.lead import lead
from diagnosis.report.location_section import location_section, remainder_section, waveform_section
from diagnosis.report.markup import Html, coded, element, image, joined, listing, table
from diagnosis.report.network import Network, concerned, inferred
from diagnosis.report.sentences import (
    ADVICE,
    ambiguity,
    doubt_text,
    effort,
    improvement,
    moved_heading,
    moved_most,
    moved_text,
    readings_text,
    searched,
    structure,
    sureness,
    thinning,
    what,
    when,
    where,
)
from diagnosis.report.series import Series
from diagnosis.report.undecided import departing, model_note, remainder, suggested, what_decides
from diagnosis.report.user_units import Units

#: Looks of the page; no font and no picture comes from elsewhere.
STYLE = (Path(__file__).parent / "page.css").read_text(encoding="utf-8")
#: Windows in which something is left that are shown at the top.
_LEFT = 3
#: Channels that only a fabric has, and where to see a finding on it (docs/play.md).
_OF_A_FABRIC = ("marker[", "link[", "fabric.")
_ON_THE_FABRIC = (
    "To see these places on the moving fabric: `cosim play RUN FOLDER`, with the folder of a run of the scenario and "
    "that of this report."
)
#: Forbids the page to load anything, whatever a recording's title says.
_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"


def write_html(
    diagnosis: Diagnosis, series: Sequence[Series], path: Path, network: Network | None = None, title: str = ""
) -> None:
    """Write the report.

    Args:
        diagnosis: What to report.
        series: Channels to draw, the worst first; a handful.
        path: The file.
        network: Strings of the scenario; taken from the names of channels and elements where it is not given.
        title: Of the scenario.
    """
    write_atomically(path, page(diagnosis, series, network or inferred(diagnosis), title).encode())


def page(diagnosis: Diagnosis, series: Sequence[Series], network: Network, title: str = "") -> str:
    """The report as text."""
    name = f"Diagnosis of {clean(title)}" if clean(title) else "Diagnosis"
    head = element(
        "head",
        Html('<meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'),
        Html(f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">'),
        element("title", f"{name}: {diagnosis.verdict.value}"),
        element("style", Html(STYLE)),
    )
    # Where nothing was found, what is left is the answer.
    units = Units(diagnosis.units)
    left, is_first = [remainder_section(diagnosis.left, units)], not diagnosis.findings
    sections, contents = anchored(
        joined(
            [
                _place_and_time(diagnosis, series, network),
                *(
                    finding_section(n, f, units, diagnosis.verdict is Verdict.CANNOT_TELL)
                    for n, f in enumerate(diagnosis.findings)
                ),
                *left[:is_first],
                _figures(diagnosis, series),
                waveform_section(diagnosis.waveforms),
                experiment_section(diagnosis.next_experiment),
                *left[is_first:],
                fit_section(
                    diagnosis.fit, diagnosis.spread, TITLE if diagnosis.accepted else "How well it fits", units
                ),
                _certainty(diagnosis),
                location_section(diagnosis.locations, units),
                isolability_section(diagnosis.isolability),
                _rests_on(diagnosis),
            ]
        )
    )
    body = element("body", _answer(diagnosis, name, series), contents, sections, element("footer", effort(diagnosis)))
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def _section(title: str, *content: str) -> Html:
    return element("section", element("h2", title), *content)


def _answer(diagnosis: Diagnosis, name: str, series: Sequence[Series]) -> Html:
    """Verdict, and where, when, what and how much better in a line each."""
    verdict = diagnosis.verdict.value
    facts = [("Doubt", doubt_text(d)) for d in diagnosis.doubts[:_LEFT]]
    facts += _undecided(diagnosis) if diagnosis.verdict is Verdict.CANNOT_TELL else _found(diagnosis)
    facts.append(("Searched", searched(diagnosis)))
    if far := moved_most(diagnosis, Units(diagnosis.units)):
        facts.append(("Parameters", far))
    if diagnosis.next_experiment is not None:
        facts.append(("Next experiment", diagnosis.next_experiment.statement))
    if diagnosis.amended_model:
        note = model_note(diagnosis)
        facts.append(
            ("Model", f"{diagnosis.amended_model} ({note})")
            if note
            else ("Amended model", _command(diagnosis.amended_model))
        )
    if diagnosis.adequacy is not None and not any(f.is_held_out for f in diagnosis.fit):
        facts.append(("Judged by", diagnosis.adequacy.basis))
    elif diagnosis.held_out_by:
        facts.append(("Judged by", coded(diagnosis.held_out_by)))
    beside = lead(diagnosis, series)
    return element(
        "header",
        element("h1", name),
        element(
            "p",
            element("span", verdict, class_=f"verdict {verdict.replace(' ', '-')}"),
            " ",
            element("strong", diagnosis.statement),
            " ",
            ADVICE[diagnosis.verdict],
        ),
        listing(map(clean, diagnosis.notes)) if diagnosis.notes else "",
        element(
            "div",
            element("dl", *(joined([element("dt", k), element("dd", v)]) for k, v in facts)),
            beside,
            class_="answer" if beside else "wide",
        ),
    )


def _command(scenario: str) -> Html:
    """How the amended model is run."""
    folder = Path("runs") / Path(scenario).parent.name
    return joined(
        [element("code", f"cosim run {shlex.quote(scenario)} --out {shlex.quote(str(folder))}"), " simulates it."]
    )


def _found(diagnosis: Diagnosis) -> list[tuple[str, str]]:
    """Where, when, what and how much better; how much better alone where nothing was found."""
    better, told = ("How much better", improvement(diagnosis)), diagnosis.accepted
    others = [("Suggested", suggested(f, Units(diagnosis.units))) for f in diagnosis.suggestions]
    if not told:
        return [*others, better]
    open_ones = [("Open", _each([ambiguity(f) for f in told]))] if any(f.ambiguous_with for f in told) else []
    times = [when(f, units=Units(diagnosis.units)) for f in told]
    return [
        ("Where", _each([where(f) for f in told])),
        ("When", _each(times)),
        ("What", _each([what(f) for f in told])),
        *open_ones,
        *others,
        better,
    ]


def _undecided(diagnosis: Diagnosis) -> list[tuple[str, str]]:
    """What is suggested or left, why that is not accepted, and what would decide."""
    units = Units(diagnosis.units)
    facts = [("Accepted, not identified", f"{clean(f.statement)}; {when(f, units=units)}") for f in diagnosis.accepted]
    facts += [("Suggested", suggested(f, units)) for f in diagnosis.suggestions]
    left = [remainder(r, Units(diagnosis.units)) for r in diagnosis.left[:_LEFT]]
    facts += [("What is left", _each(left))] if left else []
    alone = departing(diagnosis)
    facts += [("Units", alone)] if alone else []
    facts.append(("How much better", improvement(diagnosis)))
    told = what_decides(diagnosis)
    return [*facts, ("What would decide", told)] if told else facts


def _differ(diagnosis: Diagnosis) -> str:
    """Where the fast simulation, which was fitted, predicts something else than what judged."""
    most = diagnosis.differences[0]
    return (
        f"On {len(diagnosis.differences)} held-out channels the fast simulation, which was fitted, differs from what "
        f"judged by more than a tenth of the noise; most on {most.channel} ({most.stage}): by {number(most.size)} "
        f"deviations, and its chi-square per sample there is {number(most.chi_square)}."
    )


def _each(texts: Sequence[str]) -> Html:
    """One line for each finding, numbered where there are several."""
    lines = texts if len(texts) == 1 else [f"{n}: {text}" for n, text in enumerate(texts, 1)]
    return joined(element("div", line) for line in lines)


def _place_and_time(diagnosis: Diagnosis, series: Sequence[Series], network: Network) -> Html:
    if not diagnosis.findings:
        return Html("")
    parts: list[str] = []
    if network.strings:
        parts += [
            image(network_figure(network, diagnosis.findings), "network of coils with what is concerned"),
            element("p", _caption(diagnosis, network), class_="note"),
        ]
    begin, end = _extent(diagnosis, series)
    if end > begin:
        about = f"intervals in which each finding shows, {Units(diagnosis.units).span(begin, end)}"
        note = "Bars: where an effect is at least a tenth of its largest, in the recording that shows it most."
        parts += [image(timeline_figure(diagnosis.findings, begin, end), about), element("p", note, class_="note")]
    if any(fit.channel.startswith(_OF_A_FABRIC) for fit in diagnosis.fit):
        parts.append(element("p", coded(_ON_THE_FABRIC), class_="note"))
    return _section("Where and when" if diagnosis.accepted else "Where and when it would act", *parts)


def _caption(diagnosis: Diagnosis, network: Network) -> str:
    """What the picture cannot show: findings that concern no single element of the network."""
    others = [f"{n}: {f.place}" for n, f in enumerate(diagnosis.findings, 1) if not concerned(f, network)]
    told = "Coloured: the elements concerned, in the colours of the findings below."
    return f"{told} Not in the picture: {listed(others, 6)}." if others else told


def _extent(diagnosis: Diagnosis, series: Sequence[Series]) -> tuple[float, float]:
    """Times of the training from the first sample to the last one, as far as they are known here."""
    moments = [t for f in diagnosis.findings for pair in f.intervals for t in pair]
    moments += [float(t) for s in series if not s.is_held_out for t in (s.times[0], s.times[-1])]
    return (min([0.0, *moments]), max(moments)) if moments else (0.0, 0.0)


def _figures(diagnosis: Diagnosis, series: Sequence[Series]) -> Html:
    if not series:
        return Html("")
    drawn: dict[str, dict[bool, list[Html]]] = {}
    if not diagnosis.findings:  # what is left is the answer
        series = sorted(series, key=lambda s: not any(is_left_in(r, s) for r in diagnosis.left))
    for one in series:
        part = "held out" if one.is_held_out else "training"
        caption = f"{one.channel}, {one.recording} ({part})" if one.recording else f"{one.channel} ({part})"
        picture = image(
            series_figure(one, diagnosis.findings, diagnosis.left, Units(diagnosis.units)),
            f"{caption}: measured and simulated",
        )
        figure = element("figure", element("figcaption", caption), picture)
        drawn.setdefault(one.channel, {}).setdefault(one.is_held_out, []).append(figure)
    told = (
        "Those in which findings show most or most is left, and those that are met worst; the same channel in training "
        "and held out side by side, where both recorded it. Above: measured and "
        "simulated. Below: measured minus simulated. Shaded in training: where a finding shows; grey: where more than "
        "noise is left."
    )
    note = element("p", told, class_="note")
    rows = [
        element("div", *(element("div", *parts[part]) for part in (False, True) if part in parts), class_="pair")
        for parts in drawn.values()
    ]
    return _section("Channels", note, *rows)


def _rests_on(diagnosis: Diagnosis) -> Html:
    """Scenario and recordings."""
    if not diagnosis.recordings:
        return Html("")
    units = Units(diagnosis.units)
    rows = [
        (
            clean(r.title),
            "held out" if r.is_held_out else "training",
            units.span(r.begin, r.end),
            str(len(r.channels)),
            readings_text(r),
            clean(r.path),
        )
        for r in diagnosis.recordings
    ]
    told = table(("recording", "part", "time", "channels", "readings", "folder"), rows)
    parts = [element("p", "Scenario: ", element("code", clean(diagnosis.scenario))), told]
    if thinning(diagnosis):
        parts.append(element("p", thinning(diagnosis), class_="note"))
    return _section("What it rests on", *parts)


def _certainty(diagnosis: Diagnosis) -> Html:
    units = Units(diagnosis.units)
    moved = [moved_text(m, units) for m in diagnosis.recalibration]
    parts = [element("p", sureness(diagnosis)), element("p", structure(diagnosis))]
    if diagnosis.differences:
        parts.append(element("p", _differ(diagnosis)))
    if moved:
        parts += [element("p", moved_heading(diagnosis)), listing(moved)]
    return _section("How sure", *parts)
