"""report.html: one file that opens without a network."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path

from cosim.run_folder import write_atomically
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.report.display import clean
from diagnosis.report.experiment_section import experiment_section, isolability_section
from diagnosis.report.figures import is_left_in, network_figure, series_figure, timeline_figure
from diagnosis.report.finding_section import finding_section
from diagnosis.report.fit_section import TITLE, fit_section
from diagnosis.report.lead import lead
from diagnosis.report.location_section import location_section, remainder_section, waveform_section
from diagnosis.report.moving_fabric import MovingFabric
from diagnosis.report.network import Network, concerned, inferred
from diagnosis.report.section import Section, named, rendered, section
from diagnosis.report.sentences import (
    ADVICE,
    ambiguity,
    clocks,
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
from diagnosis.report.user_units import Units, units_of

#: Windows in which something is left that are shown at the top.
_LEFT = 3
#: Channels that only a fabric has: its findings can be seen in motion (docs/play.md).
_OF_A_FABRIC = ("marker[", "link[", "fabric.")


def write_html(
    diagnosis: Diagnosis,
    series: Sequence[Series],
    path: Path,
    network: Network | None = None,
    title: str = "",
    moving: MovingFabric | None = None,
) -> None:
    """Write the report.

    Args:
        diagnosis: What to report.
        series: Channels to draw, the worst first; a handful.
        path: The file.
        network: Strings of the scenario; taken from the names of channels and elements where it is not given.
        title: Of the scenario.
        moving: The fabric in motion, where the scenario has one.
    """
    write_atomically(path, page(diagnosis, series, network or inferred(diagnosis), title, moving).encode())


def page(
    diagnosis: Diagnosis,
    series: Sequence[Series],
    network: Network,
    title: str = "",
    moving: MovingFabric | None = None,
) -> str:
    """The report as text."""
    name = f"Diagnosis of {clean(title)}" if clean(title) else "Diagnosis"
    made = rendered(
        "report.html.j2",
        name=name,
        verdict=diagnosis.verdict.value,
        statement=diagnosis.statement,
        advice=ADVICE[diagnosis.verdict],
        notes=diagnosis.notes,
        answer=_answer(diagnosis),
        command=_command(diagnosis),
        judged_by=_judged_by(diagnosis),
        lead=lead(diagnosis, series),
        sections=named(list(_sections(diagnosis, series, network, moving))),
        effort=effort(diagnosis),
        scripts=moving.scripts if moving is not None else (),
    )
    return str(made)  # as markup, it would escape what is put into it


def _sections(
    diagnosis: Diagnosis, series: Sequence[Series], network: Network, moving: MovingFabric | None
) -> Iterator[Section]:
    """Sections in their order: where nothing was found, what is left is the answer and comes first."""
    units = units_of(diagnosis)
    left = [remainder_section(diagnosis.left, units)] if diagnosis.left else []
    moved = [section("The fabric in motion", "moving_fabric.html.j2", moving=moving)] if moving else []
    if diagnosis.findings:
        yield _place_and_time(diagnosis, series, network)
    yield from moved
    for order, finding in enumerate(diagnosis.findings):
        yield finding_section(order, finding, units, diagnosis.verdict is Verdict.CANNOT_TELL)
    if not diagnosis.findings:
        yield from left
    if series:
        yield _channels(diagnosis, series)
    if missing := waveform_section(diagnosis.waveforms, units):
        yield missing
    if diagnosis.next_experiment is not None:
        yield experiment_section(diagnosis.next_experiment)
    if diagnosis.findings:
        yield from left
    yield fit_section(diagnosis.fit, diagnosis.spread, TITLE if diagnosis.accepted else "How well it fits", units)
    yield _certainty(diagnosis, units)
    if diagnosis.locations:
        yield location_section(diagnosis.locations, units)
    yield isolability_section(diagnosis.isolability)
    if diagnosis.recordings:
        yield _rests_on(diagnosis, units)


#: What a fact says: a text, or a line for each of several.
Told = str | list[str]


def _answer(diagnosis: Diagnosis) -> list[tuple[str, Told]]:
    """Where, when, what and how much better in a line each."""
    facts: list[tuple[str, Told]] = [("Doubt", doubt_text(d)) for d in diagnosis.doubts[:_LEFT]]
    facts += _undecided(diagnosis) if diagnosis.verdict is Verdict.CANNOT_TELL else _found(diagnosis)
    facts.append(("Searched", searched(diagnosis)))
    if far := moved_most(diagnosis, units_of(diagnosis)):
        facts.append(("Parameters", far))
    if diagnosis.next_experiment is not None:
        facts.append(("Next experiment", diagnosis.next_experiment.statement))
    if diagnosis.amended_model and (note := model_note(diagnosis)):
        facts.append(("Model", f"{diagnosis.amended_model} ({note})"))
    return facts


def _command(diagnosis: Diagnosis) -> str:
    """How the amended model is run; empty where nothing was added to a model."""
    scenario = diagnosis.amended_model
    if not scenario or model_note(diagnosis):
        return ""
    folder = Path("runs") / Path(scenario).parent.name
    return f"cosim run {shlex.quote(scenario)} --out {shlex.quote(str(folder))}"


def _judged_by(diagnosis: Diagnosis) -> str:
    """What the answer was judged by, code between backticks; empty where that goes without saying."""
    if diagnosis.adequacy is not None and not any(f.is_held_out for f in diagnosis.fit):
        return diagnosis.adequacy.basis
    return diagnosis.held_out_by


def _found(diagnosis: Diagnosis) -> list[tuple[str, Told]]:
    """Where, when, what and how much better; how much better alone where nothing was found."""
    better, told = ("How much better", improvement(diagnosis)), diagnosis.accepted
    units = units_of(diagnosis)
    others = [("Suggested", suggested(f, units)) for f in diagnosis.suggestions]
    if not told:
        return [*others, better]
    open_ones = [("Open", _each([ambiguity(f) for f in told]))] if any(f.ambiguous_with for f in told) else []
    return [
        ("Where", _each([where(f) for f in told])),
        ("When", _each([when(f, units=units) for f in told])),
        ("What", _each([what(f) for f in told])),
        *open_ones,
        *others,
        better,
    ]


def _undecided(diagnosis: Diagnosis) -> list[tuple[str, Told]]:
    """What is suggested or left, why that is not accepted, and what would decide."""
    units = units_of(diagnosis)
    facts: list[tuple[str, Told]] = []
    for finding in diagnosis.accepted:
        facts.append(("Accepted, not identified", f"{finding.statement}; {when(finding, units=units)}"))
    facts += [("Suggested", suggested(f, units)) for f in diagnosis.suggestions]
    if left := [remainder(r, units) for r in diagnosis.left[:_LEFT]]:
        facts.append(("What is left", _each(left)))
    if alone := departing(diagnosis):
        facts.append(("Units", alone))
    facts.append(("How much better", improvement(diagnosis)))
    if told := what_decides(diagnosis):
        facts.append(("What would decide", told))
    return facts


def _each(texts: Sequence[str]) -> list[str]:
    """One line for each finding, numbered where there are several."""
    return list(texts) if len(texts) == 1 else [f"{n}: {text}" for n, text in enumerate(texts, 1)]


def _place_and_time(diagnosis: Diagnosis, series: Sequence[Series], network: Network) -> Section:
    begin, end = _extent(diagnosis, series)
    return section(
        "Where and when" if diagnosis.accepted else "Where and when it would act",
        "place_and_time.html.j2",
        network=network_figure(network, diagnosis.findings) if network.strings else "",
        # What the picture cannot show: findings that concern no single element of the network.
        others=[f"{n}: {f.place}" for n, f in enumerate(diagnosis.findings, 1) if not concerned(f, network)],
        timeline=timeline_figure(diagnosis.findings, begin, end, units_of(diagnosis)) if end > begin else "",
        span=units_of(diagnosis).span(begin, end),
        is_fabric=any(fit.channel.startswith(_OF_A_FABRIC) for fit in diagnosis.fit),
    )


def _extent(diagnosis: Diagnosis, series: Sequence[Series]) -> tuple[float, float]:
    """Times of the training from the first sample to the last one, as far as they are known here."""
    moments = [t for f in diagnosis.findings for pair in f.intervals for t in pair]
    moments += [float(t) for s in series if not s.is_held_out for t in (s.times[0], s.times[-1])]
    return (min([0.0, *moments]), max(moments)) if moments else (0.0, 0.0)


def _channels(diagnosis: Diagnosis, series: Sequence[Series]) -> Section:
    """Figures of channels: training and, beside it, held out."""
    units = units_of(diagnosis)
    drawn: dict[str, dict[bool, list[tuple[str, str]]]] = {}
    if not diagnosis.findings:  # what is left is the answer
        series = sorted(series, key=lambda s: not any(is_left_in(r, s) for r in diagnosis.left))
    for one in series:
        part = "held out" if one.is_held_out else "training"
        caption = f"{one.channel}, {one.recording} ({part})" if one.recording else f"{one.channel} ({part})"
        picture = series_figure(one, diagnosis.findings, diagnosis.left, units)
        drawn.setdefault(one.channel, {}).setdefault(one.is_held_out, []).append((caption, picture))
    pairs = [[parts[part] for part in sorted(parts)] for parts in drawn.values()]
    return section("Channels", "channels.html.j2", pairs=pairs)


def _rests_on(diagnosis: Diagnosis, units: Units) -> Section:
    """Scenario and recordings."""
    rows = [
        (
            r.title,
            "held out" if r.is_held_out else "training",
            units.span(r.begin, r.end),
            str(len(r.channels)),
            readings_text(r),
            r.path,
        )
        for r in diagnosis.recordings
    ]
    return section(
        "What it rests on",
        "rests_on.html.j2",
        scenario=diagnosis.scenario,
        rows=rows,
        thinning=thinning(diagnosis),
        clocks=clocks(diagnosis, units),
    )


def _certainty(diagnosis: Diagnosis, units: Units) -> Section:
    return section(
        "How sure",
        "certainty.html.j2",
        sureness=sureness(diagnosis),
        structure=structure(diagnosis),
        differences=len(diagnosis.differences),
        most=next(iter(diagnosis.differences), None),
        heading=moved_heading(diagnosis),
        moved=[moved_text(m, units) for m in diagnosis.recalibration],
    )
