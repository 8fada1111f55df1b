"""Effects that a search found, each with place, time, numbers, rivals and reservations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.faults.law import AS_A_LAW, FOR_A_WHILE, INPUT, OF_INPUTS, is_one_of
from diagnosis.judge.acceptance import Accepted
from diagnosis.judge.diagnosis import Finding, Member, Standing, class_places
from diagnosis.judge.doubts import MEASURED, accuses, is_physics
from diagnosis.judge.estimates import estimated, holding_both, widening
from diagnosis.judge.events import event_of, since
from diagnosis.judge.extent import channels_of, effect_of, elements_of, times_of, within_readings
from diagnosis.judge.form import EXPLAINED
from diagnosis.judge.plausibility import implausible
from diagnosis.judge.plausibility import unidentified as unmeasured
from diagnosis.judge.reservations import (
    BESIDE,
    INSIDE,
    ONE_COURSE,
    PARTS,
    cancelled,
    dragged,
    elsewhere,
    inconstant,
    limits,
    much_left,
    other_form,
)
from diagnosis.judge.rivals import alternatives_to, open_rivals
from diagnosis.judge.same_response import same_response
from diagnosis.judge.standing import standing_of, unidentified
from diagnosis.judge.strain import strained
from diagnosis.judge.trust import bears_names, is_trusted
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.report.display import words
from diagnosis.report.user_units import IN_SI, Units
from diagnosis.search.problem import Term
from diagnosis.search.search import Explanation, Outcome

#: Factor on an interval from which it is said that a number depends on a law that is not identified.
WIDER = 1.5


def findings(
    model: DiagnosisModel,
    outcome: Outcome,
    accepted: Accepted,
    titles: Sequence[str],
    units: Units = IN_SI,
    judge: DiagnosisModel | None = None,
) -> tuple[Finding, ...]:
    """Effects that were accepted, the largest gain first; then those that are suggested alone.

    Args:
        model: Model of the training recordings.
        outcome: Of the search.
        accepted: What of it is accepted.
        titles: Of the training recordings.
        units: In which sentences show quantities.
        judge: Model of the held-out recordings; None where there are none.
    """
    found: list[Finding] = []
    acting: list[Term] = []
    for explanation, terms, is_accepted in (
        (accepted.explanation, accepted.explanation.terms, True),
        (accepted.headline, tuple(accepted.reasons), False),
    ):
        ordered = sorted(terms, key=lambda t: -explanation.gains.get(t, 0.0))
        acting += ordered
        found += [
            _finding(model, outcome, accepted, explanation, t, is_accepted, titles, units, judge) for t in ordered
        ]
        if is_accepted:
            found = [
                _without_name(f, model.where(t)[0].name) if _is_beside_unnamed(f, found) else f
                for t, f in zip(ordered, found)
            ]
            found = [
                _widened(model, outcome, accepted, t, f, list(zip(ordered, found))) for t, f in zip(ordered, found)
            ]
            found = [one_course(f, found) for f in found]
            found = [in_parts(f, found, model.hidden) for f in found]
    return tuple(_lasting(model, t, f) for t, f in zip(acting, found))


def _lasting(model: DiagnosisModel, term: Term, finding: Finding) -> Finding:
    """The finding of a fault that may have lasted for its whole recording, or for all but a reading at either end.

    By the intervals of begin and end; it is not told as one of a while.
    """
    if term.recording is None:
        return finding
    times = np.unique(np.concatenate([s.channel.times for s in model.runs[term.recording].series]))
    ends = {e.name: e for e in finding.parameters}
    if ends["begin"].lower > times[1] or ends["end"].upper < times[-2]:
        return finding
    return replace(finding, statement=finding.statement.replace(FOR_A_WHILE, "", 1))


def one_course(finding: Finding, every: Sequence[Finding]) -> Finding:
    """The finding of an input that was another, where a second one is of the same input at the same time.

    Together they describe a course that it had, whatever that was: neither that it stayed nor that it was another by a
    share of what was stated is known of it.
    """
    if not is_one_of(finding.effect, OF_INPUTS):
        return finding

    def is_of_it(other: Finding) -> bool:
        return (
            other is not finding
            and is_one_of(other.effect, OF_INPUTS)
            and (other.place.split(",")[0], other.recording) == (finding.place.split(",")[0], finding.recording)
            and any(a < d and c < b for a, b in finding.intervals for c, d in other.intervals)
        )

    if not any(map(is_of_it, every)):
        return finding
    name = next(law.name for law in OF_INPUTS if law.identifier == finding.effect)
    told = finding.statement.replace(name, INPUT.name, 1)
    return replace(finding, statement=told, doubts=(*finding.doubts, ONE_COURSE))


def in_parts(finding: Finding, every: Sequence[Finding], hidden: Sequence[str]) -> Finding:
    """The finding of a law without a name, where its place is not known: that is said.

    Where others are in the same FMU at other places the readings confirm the sum of such laws. Of an FMU that hides its
    states laws are tried where it can be reached, and one inside may look like one of them, or take several.

    Args:
        finding: Any.
        every: All that are accepted.
        hidden: Components that hide their states.
    """

    def is_part(one: Finding) -> bool:
        is_in_an_fmu = "." in one.place and one.unit not in MEASURED
        return is_in_an_fmu and one.standing is Standing.UNNAMED and not is_one_of(one.effect, OF_INPUTS)

    own = finding.place.split(".")[0]
    others = {f.place for f in every if is_part(f) and f.place.split(".")[0] == own}
    if not is_part(finding):
        return finding
    doubts = (*([PARTS] if not others <= {finding.place} else []), *([INSIDE] if own in hidden else []))
    told = finding.statement
    if own in hidden:
        told = told.replace(f", {finding.place}", f", in {own} or at {finding.place}", 1)
    return replace(finding, statement=told, doubts=(*finding.doubts, *doubts))


def _is_beside_unnamed(finding: Finding, every: Sequence[Finding]) -> bool:
    """Whether a law with a name acts where one without a name does: both may be parts of one law that is in no library.

    The sum of such terms is what the readings confirm, and not each of them.
    """
    if finding.standing is Standing.UNNAMED:
        return False
    others = [f for f in every if f.standing is Standing.UNNAMED and f.unit not in MEASURED]
    if finding.unit in MEASURED:  # a sensor takes part in all that its readings show
        return any(set(f.channels) & set(finding.channels) for f in others)
    return any(set(f.elements) & set(finding.elements) for f in others if f.unit == finding.unit)


def _widened(
    model: DiagnosisModel,
    outcome: Outcome,
    accepted: Accepted,
    term: Term,
    finding: Finding,
    every: Sequence[tuple[Term, Finding]],
) -> Finding:
    """The finding with intervals that hold its numbers without each law that is accepted and not identified.

    A gain of a sensor, say, that no reading tells from something else scales every number of the rig with it: what is
    known of these is known with and without it alone.
    """
    if not (is_physics(finding) or accuses(finding)):
        return finding
    for other, beside in every:
        fitted = accepted.without.get(other)
        if is_physics(beside) or accuses(beside) or fitted is None or term not in fitted.point.terms:
            continue
        doubt = widening(outcome)
        alone = estimated(model, fitted, term, doubt)
        both = tuple(holding_both(a, b) for a, b in zip(finding.parameters, alone))
        if any(b.upper - b.lower > WIDER * (a.upper - a.lower) for a, b in zip(finding.parameters, both)):
            why = f"its numbers depend on {beside.statement}: the intervals hold what is fitted with and without that"
            finding = replace(finding, parameters=both, doubts=(*finding.doubts, why))
    return finding


def _without_name(finding: Finding, name: str) -> Finding:
    """The finding of a law of this name, told as one that has none."""
    place = finding.statement.removeprefix(statement(name, "", finding.standing, finding.ambiguous_with))
    return replace(
        finding,
        is_named=False,
        standing=Standing.UNNAMED,
        doubts=(*finding.doubts, BESIDE),
        statement=statement(name, place, Standing.UNNAMED, ()),
    )


def _finding(
    model: DiagnosisModel,
    outcome: Outcome,
    accepted: Accepted,
    explanation: Explanation,
    term: Term,
    is_accepted: bool,
    titles: Sequence[str],
    units: Units,
    judge: DiagnosisModel | None,
) -> Finding:
    candidate, place = model.where(term)
    fit = explanation.fit
    alternatives, probability = alternatives_to(outcome, accepted, term)
    members = same_response(model, fit.point, term, judge)
    likely = _class_of(term, members, open_rivals(alternatives, term, accepted))
    where = class_places(place.label, term.identifier, members)
    effect = effect_of(model, fit, term)
    doubt, event = widening(outcome), event_of(term, fit.point.terms[term], model)
    units = units.of(term.place)
    when = since(term, fit, model, doubt, units)
    told = estimated(model, fit, term, doubt)
    doubts = (*unidentified(term, fit, told, units), *implausible(term, fit.point.terms[term], units))
    if isinstance(candidate, CandidateTerm):
        unknown = unmeasured(candidate, _measured(model))
        doubts = (*doubts, unknown) if unknown else doubts
    if not bears_names(accepted):
        doubts = (*doubts, much_left(accepted))
    if is_one_of(term.identifier, AS_A_LAW) and accepted.agreement.is_rejected and not accepted.agreement.is_irregular:
        doubts = (*doubts, elsewhere(accepted))
    if term in accepted.strengths and not accepted.strengths[term].is_constant:
        doubts = (*doubts, inconstant(accepted.strengths[term], told[0], accepted.basis, units))
    if accepted.forms.get(term, 0.0) > EXPLAINED:
        doubts = (*doubts, other_form(accepted.forms[term]))
    if term in accepted.opposed:
        doubts = (*doubts, cancelled(model.where(accepted.opposed[term])))
    if far := strained(model.parameters, outcome.base, fit):
        doubts = (*doubts, dragged(far[0], titles))
    standing = standing_of(term, doubts, likely, is_trusted(outcome), any(m.is_named for m in members))
    recording, intervals = times_of(model, effect)
    if term.recording is not None:
        begin, end = (v for p, v in zip(term.parameters, fit.point.terms[term]) if p.is_instant)
        recording, intervals = term.recording, ((begin, end),)
    elif event is not None:
        recording, intervals = event.number, ((event.seconds, event.end),)
    intervals = within_readings(intervals, [s.channel.times for s in model.runs[recording].series])
    return Finding(
        unit=term.unit,
        place=place.label,
        elements=_class_elements(model, term, members),
        intervals=intervals,
        channels=channels_of(model, effect),
        effect=term.identifier,
        is_named=standing is not Standing.UNNAMED,
        statement=statement(candidate.name, where, standing, likely) + (f", {when}" if when else ""),
        law=candidate.law,
        parameters=told,
        gain=explanation.gains.get(term, 0.0),
        probability=probability,
        ambiguous_with=likely,
        alternatives=tuple(alternatives[:8]),
        confused_with=dict(candidate.confused_with),
        standing=standing,
        is_accepted=is_accepted,
        doubts=(*accepted.reasons.get(term, ()), *doubts, *(limits(accepted, term) if is_accepted else ())),
        recording=titles[recording],
        held_out_gain=accepted.gains[term].total if term in accepted.gains else float("nan"),
        members=members,
        judged_by=accepted.judged_by.get(term, accepted.basis),
        is_of_either=_is_of_either(model, term, likely),
        is_coarse=not is_accepted and term in accepted.coarse,
        is_within_rows=not is_accepted and term in accepted.rows,
    )


def _is_of_either(model: DiagnosisModel, term: Term, likely: Sequence[str]) -> bool:
    """Whether a finding may be of the rig as well as of a sensor or an input, by its law or its class."""
    if model.where(term)[0].is_of_either:
        return True
    if not likely:  # a rig of 36 coils has thousands of terms
        return False
    units = {t.identifier: t.unit for t in model.terms()}
    return len({units.get(e, term.unit) in MEASURED for e in (term.identifier, *likely)}) > 1


def _class_of(term: Term, members: Sequence[Member], rivals: Sequence[str]) -> tuple[str, ...]:
    """Other effects of a finding's class: those that respond the same, named ones first, then those within the odds."""
    alike = sorted((m for m in members if m.effect != term.identifier), key=lambda m: not m.is_named)
    return tuple(dict.fromkeys([*(m.effect for m in alike), *rivals]))


def _class_elements(model: DiagnosisModel, term: Term, members: Sequence[Member]) -> tuple[str, ...]:
    """Elements concerned by a finding or by any member of its class."""
    every = {(t.identifier, model.where(t)[1].label): t for t in model.terms()} if members else {}
    found = [term, *(every[m.effect, m.place] for m in members)]
    return tuple(dict.fromkeys(element for t in found for element in elements_of(model, t)))


def _measured(model: DiagnosisModel) -> set[str]:
    """Quantities that were recorded."""
    return {s.channel.target.quantity for run in model.runs for s in run.series}


def statement(name: str, place: str, standing: Standing, likely: Sequence[str]) -> str:
    """What was found, as far as it has a name.

    >>> statement("second thermal mass", "coil[2,5]", Standing.CLASS, ("sensor_lag",))
    'second thermal mass or sensor lag, coil[2,5]'
    """
    if standing is Standing.CLASS:
        others = [words(effect) for effect in likely[:3]]
        more = f" or {len(likely) - 3} more" if len(likely) > 3 else ""
        return f"{' or '.join([name, *others])}{more}, {place}"
    return (
        f"{name}, {place}"
        if standing is Standing.NAMED
        else f"an effect without a name (described as: {name}), {place}"
    )
