"""Findings of a search, as far as they are accepted, and the verdict."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.faults.law import AS_A_LAW, is_one_of
from diagnosis.judge.acceptance import UNSEPARATED, Accepted
from diagnosis.judge.agreement import times_louder, times_white
from diagnosis.judge.constancy import Constancy
from diagnosis.judge.diagnosis import (
    MOVED,
    Adequacy,
    Alternative,
    Doubt,
    Estimate,
    Finding,
    Member,
    Moved,
    Physical,
    Searched,
    Standing,
    Verdict,
    class_places,
)
from diagnosis.judge.doubts import MEASURED, ODD, accuses, far_starts, faults, is_physics, late_responses
from diagnosis.judge.events import between_samples, event_of, local_estimates, of_what_stays, since
from diagnosis.judge.form import EXPLAINED
from diagnosis.judge.headline import noise_of
from diagnosis.judge.plausibility import implausible
from diagnosis.judge.plausibility import unidentified as unmeasured
from diagnosis.judge.same_response import same_response
from diagnosis.judge.standing import standing_of, unidentified
from diagnosis.judge.strain import strained
from diagnosis.judge.unfitted import has_bins, raw_residuals
from diagnosis.models.protocol import DiagnosisModel, Effect, Spot
from diagnosis.report.display import listed, parameter_words, words
from diagnosis.report.user_units import IN_SI, Units
from diagnosis.search.fit import Fit
from diagnosis.search.posterior import HUBER, cost
from diagnosis.search.problem import Parameter, Term, TermParameter
from diagnosis.search.search import Explanation, Outcome
from diagnosis.search.shares import departures, titled

#: Half width of a 95 % interval in standard deviations.
NORMAL_95 = 1.959963984540054
#: The same of laws that are interpolated between few simulations, whose means scatter: what a fabric's search goes on
#: with (`diagnosis.models.fabric.search`).
INTERPOLATED = 40.0
#: Probability beyond which another explanation is open.
OPEN = 0.05
#: Structure beyond so many times its limit is more than the small errors that every model of a rig has.
EVIDENT = 1.2
#: Structure beyond so many times its limit, and a share of the misfit beyond this, make a name doubtful.
DOUBTFUL, UNEXPLAINED = 1.5, 0.03
#: Chi-square per reading below which errors of the model are smaller than the noise; share of what recalibration
#: leaves that may stay where they are larger.
BURIED, MOST_LEFT = 2.0, 0.1
#: Share of what recalibration leaves that a law without a name has to explain to be of the rig.
HALF = 0.5
#: A parameter that moved by more than this is no calibration: chance does that in one of 16,000.
STRAINED = 4.0
#: Share of the bound of a parameter from which it counts as being at it.
AT_BOUND = 0.99
#: Parameters that are named in one sentence.
NAMED = 6
#: Why nothing is concluded from what is suggested.
_UNCONFIRMED = "what the training recordings suggest is not confirmed by readings that it was not fitted to"
_COARSE = "time.macro_step is too long to tell what the training recordings suggest from an error of solving"
#: Why a law has no name beside one that has none.
_BESIDE = "a law without a name acts at the same place: both may be parts of one law that is in no library"
#: Factor on an interval from which it is said that a number depends on a law that is not identified.
WIDER = 1.5
#: Share of its peak from which an effect counts as being there.
SHOWS = 0.1


def verdict(
    outcome: Outcome,
    found: Sequence[Finding],
    adequacy: Adequacy,
    searched: Searched,
    moved: Sequence[Moved] = (),
    doubts: Sequence[Doubt] = (),
) -> Verdict:
    """One word for a search.

    Args:
        outcome: What the search found.
        found: Findings, accepted and suggested.
        adequacy: How right the accepted model is.
        searched: What was searched.
        moved: Parameters that the recalibration moved far.
        doubts: About the recordings.
    """
    accepted = [f for f in found if f.is_accepted]
    physics = [f for f in accepted if is_physics(f)]
    if physics:
        if any(f.standing is not Standing.UNNAMED for f in physics):
            return Verdict.MISSING_PHYSICS
        if not leaves_most(adequacy) and not _has_stopgap(accepted):
            return Verdict.UNNAMED_PHYSICS
    if faults(doubts) or (accepted and not is_stopgap(accepted)):
        return Verdict.MEASUREMENT_FAULT
    if why_open(outcome, found, adequacy, searched, doubts):
        return Verdict.CANNOT_TELL
    is_moved = any(abs(m.deviations) > MOVED for m in moved)
    is_needed = is_moved or adequacy.is_nominal_rejected or adequacy.day
    return Verdict.RECALIBRATED if is_needed else Verdict.CONSISTENT


def leaves_most(adequacy: Adequacy) -> bool:
    """Whether readings reject a model and more is left than was explained of what recalibration leaves.

    A law without a name that explains less than half is bent to something else, maybe of another part of the rig or of
    a sensor.
    """
    if not adequacy.is_rejected or adequacy.is_irregular:
        return False
    return 1.0 - adequacy.explained > HALF * (1.0 - adequacy.by_recalibration)


def is_stopgap(measured: Sequence[Finding]) -> bool:
    """Whether accepted laws of sensors and inputs only fill a gap of the model: none has a name of its own.

    An offset, a gain or a box in time brings a wrong model nearer to any readings. That alone accuses no sensor; nor
    does a law that a law of the rig may replace.
    """
    return not any(accuses(f) for f in measured)


def _has_stopgap(accepted: Sequence[Finding]) -> bool:
    """Whether laws of sensors or inputs that accuse nothing are accepted: beside laws of the rig without a name, all
    of them may describe one thing, of either."""
    return any(not is_physics(f) and not accuses(f) for f in accepted)


def why_open(
    outcome: Outcome,
    found: Sequence[Finding],
    adequacy: Adequacy,
    searched: Searched,
    doubts: Sequence[Doubt] = (),
    names: Sequence[str] = (),
) -> tuple[str, ...]:
    """Why it cannot be told whether something is missing, or what; empty if the model agrees.

    It is asked where no physics is accepted, or none that has a name and could not as well be of a sensor.

    Args:
        outcome: What the search found.
        found: Findings, accepted and suggested.
        adequacy: How right the accepted model is.
        searched: What was searched.
        doubts: About the recordings.
        names: Of the parameters of the model, in their order; without them parameters are counted only.
    """
    if far_starts(doubts):
        return (_start(far_starts(doubts)[0]),)
    if late := late_responses(doubts):
        return (f"{late[0].recording}: {late[0].statement.rstrip('.')}",)
    reasons = _open_ones(found)
    reasons += [d.statement for d in doubts if d.kind == "still"]
    if any(f.is_accepted and is_physics(f) for f in found) and leaves_most(adequacy):
        reasons.append("what improves the prediction has no name and leaves most of the squared mismatch")
    if not searched.has_physics:
        reasons.append(
            "no law of physics was tried: " + "; ".join(searched.untried or ("the model offers no place for one",))
        )
    if suggested := [f for f in found if not f.is_accepted]:
        reasons.append(_COARSE if all(f.is_coarse for f in suggested) else _UNCONFIRMED)
    unexplained = ", and no law that was tried explains what is left"
    if not searched.has_physics or any(not f.is_accepted for f in found):  # a suggested law may explain it
        unexplained = ""
    reasons += _rejections(adequacy, unexplained)
    is_open, left = adequacy.is_open, outcome.base_structure
    noise = math.sqrt(times_white(adequacy.alike, (left.channels,))) * times_louder(adequacy.louder, (left.channels,))
    if not is_open and abs(left.z) / noise > EVIDENT * left.limit:
        reasons.append("residuals of the training recordings are alike for longer than noise is")
    if adequacy.is_recalibration_worse and (is_open or adequacy.needs_parameter_error):
        reasons.append("the recalibrated parameters predict worse than those of the scenario")
    strained = np.flatnonzero(np.abs(outcome.base.point.base / outcome.base.widths) > STRAINED).tolist()
    if len(strained):
        reasons.append(_strained([parameter_words(names[int(i)]) for i in strained] if names else [], len(strained)))
    # Where something is open, one recording that stands out from all others is the first thing to look at.
    return (*(_apart(d) for d in doubts if d.kind == ODD and reasons), *reasons)


def _apart(doubt: Doubt) -> str:
    """That one recording stands out from the others, and what to look at."""
    return f"{doubt.recording} stands out: {doubt.statement}; {doubt.remedy}"


def evident(found: Sequence[Finding], adequacy: Adequacy, margin: float) -> tuple[Finding, ...]:
    """Findings without suggestions that noise gives which is alike from reading to reading.

    The search counts every reading as one of its own, and its noise as it is stated. Where no readings reject the
    model, and those of a suggestion's channels differ from their neighbours by less than the stated noise says, or all
    of them scatter by more, its gain counts for less.

    Args:
        found: Accepted and suggested.
        adequacy: How right the accepted model is.
        margin: What an effect must gain.
    """
    if adequacy.is_open:
        return tuple(found)

    def is_noise(finding: Finding) -> bool:
        louder = times_louder(adequacy.louder, finding.channels)
        times = times_white(adequacy.alike, finding.channels) * louder**2
        return not finding.is_accepted and times > 1.0 and finding.gain <= margin * times

    return tuple(f for f in found if not is_noise(f))


def _strained(names: Sequence[str], count: int) -> str:
    """That recalibration alone moved parameters far, and which; other laws in the model may leave them nearer."""
    those = "1 parameter" if count == 1 else f"{count} parameters"
    which = f": {listed(names, NAMED)}" if names else ""
    return f"recalibration alone, with no law added, moves {those} by more than {STRAINED:.0f} prior deviations{which}"


def _open_ones(found: Sequence[Finding]) -> list[str]:
    """Accepted laws that may be of the rig as well as of a sensor or an input."""
    accepted, reasons = [f for f in found if f.is_accepted], []
    if any(f.standing is Standing.UNNAMED and f.unit in MEASURED for f in accepted):
        is_part = any(f.unit not in MEASURED for f in accepted)
        what = "part of what improves the prediction" if is_part else "what improves the prediction"
        reasons.append(f"{what} is described by a law of a sensor or an input, but not identified")
    if any(f.is_of_either for f in accepted):
        reasons.append("what improves the prediction may be of the rig as well as of a sensor or an input")
    return reasons


def _rejections(adequacy: Adequacy, unexplained: str) -> list[str]:
    """How the readings reject the model, if they do."""
    if not adequacy.is_open:
        return []
    which = "readings" if adequacy.is_rejected else "training readings"
    if adequacy.is_irregular:
        return [
            f"the {which} reject the model by {noise_of(adequacy)}, but what is left scatters from one reading to the "
            "next, as a larger noise or single wild readings do"
        ]
    return [f"the {which} reject the model{unexplained}"]


def _start(doubt: Doubt) -> str:
    """Why nothing is concluded from a recording that begins elsewhere than it says."""
    return f"{doubt.recording} does not begin as it says; {doubt.subject}: {doubt.statement.rstrip('.')}"


def is_small(accepted: Accepted) -> bool:
    """Whether what the accepted model leaves of unfitted readings is so little that no other way is searched.

    That is less than the noise of a single reading, or a tenth of what the recalibrated model leaves.
    """
    left, recalibrated = accepted.agreement, accepted.agreement_recalibrated
    return left.chi_square < BURIED or left.excess < MOST_LEFT * recalibrated.excess


def is_settled(accepted: Accepted) -> bool:
    """Whether no other way to describe the training is asked for.

    That is where unfitted readings do not reject the model, or where little is left (`is_small`) and the laws are of
    the rig. A law of a sensor or an input that acts in every recording describes much of what a rig does too: while
    readings reject the model with it, it is no answer, however little is left.
    """
    if not accepted.agreement.is_rejected:
        return True
    is_stopgap = any(t.unit in MEASURED and t.recording is None for t in accepted.explanation.terms)
    return is_small(accepted) and not is_stopgap


def bears_names(accepted: Accepted) -> bool:
    """Whether a law may be called by its name though something is left of unfitted readings.

    Where readings reject the model by what lasts, as little may be left as in training (`is_trusted`): another law than
    the named one explains most of a mismatch too.
    """
    left, recalibrated = accepted.agreement, accepted.agreement_recalibrated
    if not left.is_rejected or left.is_irregular:
        return True
    return left.excess < UNEXPLAINED * recalibrated.excess


def is_trusted(outcome: Outcome) -> bool:
    """Whether the effects found may be called by their names: no name is forced on what still shows structure.

    A name stands where noise is left, or so small a share of the misfit that errors of the model itself explain it.
    """
    if abs(outcome.left.z) <= DOUBTFUL * outcome.left.limit:
        return True
    used = np.count_nonzero(outcome.base.residuals)
    before = cost(outcome.base.residuals, np.zeros(0)) - used
    after = cost(outcome.best.fit.residuals, np.zeros(0)) - used
    return bool(after < UNEXPLAINED * before)


def probabilities(costs: Sequence[float]) -> Array:
    """Posterior probabilities of explanations, from their -2 log posteriors."""
    values = np.asarray(costs, dtype=np.float64)
    weights = np.exp(-0.5 * (values - values.min()))
    return np.asarray(weights / weights.sum())


def bends_into(rival: Explanation, best: Explanation) -> bool:
    """Whether a rival is a law without a name and with a free shape where the best has names: it can bend into those.

    That it then explains as much is no ambiguity, and no experiment would part the two.
    """
    return all(t.is_named for t in best.terms) and not all(t.is_named for t in rival.terms)


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
    found = []
    for explanation, terms, is_accepted in (
        (accepted.explanation, accepted.explanation.terms, True),
        (accepted.headline, tuple(accepted.reasons), False),
    ):
        ordered = sorted(terms, key=lambda t: -explanation.gains.get(t, 0.0))
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
    return tuple(found)


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
        doubt = _doubt(outcome)
        alone = estimated(model, fitted, term, doubt)
        both = tuple(_over(a, b) for a, b in zip(finding.parameters, alone))
        if any(b.upper - b.lower > WIDER * (a.upper - a.lower) for a, b in zip(finding.parameters, both)):
            why = f"its numbers depend on {beside.statement}: the intervals hold what is fitted with and without that"
            finding = replace(finding, parameters=both, doubts=(*finding.doubts, why))
    return finding


def estimated(model: DiagnosisModel, fit: Fit, term: Term, doubt: float) -> tuple[Estimate, ...]:
    """Parameters of a term with intervals by all that is known of them: instants on the clock of their recording."""
    found = estimates(fit, term, doubt, model.scale_uncertainty(term))
    told = between_samples(local_estimates(found, term, fit, model, doubt), term, model)
    told = of_what_stays(told, term, fit, model, doubt)
    simulated = model.simulated_interval(term)
    if simulated is None:
        return told
    return _over(told[0], _estimate(term.parameters[0], told[0].value, *simulated)), *told[1:]


def _over(one: Estimate, other: Estimate) -> Estimate:
    """The estimate with an interval that holds that of another too."""
    physical = one.physical
    if physical is not None and other.physical is not None:
        physical = replace(
            physical, lower=min(physical.lower, other.physical.lower), upper=max(physical.upper, other.physical.upper)
        )
    return replace(one, lower=min(one.lower, other.lower), upper=max(one.upper, other.upper), physical=physical)


def _without_name(finding: Finding, name: str) -> Finding:
    """The finding of a law of this name, told as one that has none."""
    place = finding.statement.removeprefix(statement(name, "", finding.standing, finding.ambiguous_with))
    return replace(
        finding,
        is_named=False,
        standing=Standing.UNNAMED,
        doubts=(*finding.doubts, _BESIDE),
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
    alternatives, probability = _alternatives(outcome, accepted, term)
    members = same_response(model, fit.point, term, judge)
    likely = _class_of(term, members, _open_rivals(alternatives, term, accepted))
    where = class_places(place.label, term.identifier, members)
    effect = _effect(model, fit, term)
    doubt, event = _doubt(outcome), event_of(term, fit.point.terms[term], model)
    units = units.of(term.place)
    when = since(term, fit, model, doubt, units)
    told = estimated(model, fit, term, doubt)
    doubts = (*unidentified(term, fit, told, units), *implausible(term, fit.point.terms[term], units))
    if isinstance(candidate, CandidateTerm):
        unknown = unmeasured(candidate, _measured(model))
        doubts = (*doubts, unknown) if unknown else doubts
    if not bears_names(accepted):
        doubts = (*doubts, _much_left(accepted))
    if is_one_of(term.identifier, AS_A_LAW) and accepted.agreement.is_rejected and not accepted.agreement.is_irregular:
        doubts = (*doubts, _elsewhere(accepted))
    if term in accepted.strengths and not accepted.strengths[term].is_constant:
        doubts = (*doubts, _inconstant(accepted.strengths[term], told[0], accepted.basis, units))
    if accepted.forms.get(term, 0.0) > EXPLAINED:
        doubts = (*doubts, _other_form(accepted.forms[term]))
    if term in accepted.opposed:
        doubts = (*doubts, _cancelled(model.where(accepted.opposed[term])))
    if far := strained(model.parameters, outcome.base, fit):
        doubts = (*doubts, _dragged(far[0], titles))
    standing = standing_of(term, doubts, likely, is_trusted(outcome), any(m.is_named for m in members))
    recording, intervals = _intervals(model, effect)
    if term.recording is not None:
        begin, end = (v for p, v in zip(term.parameters, fit.point.terms[term]) if p.is_instant)
        recording, intervals = term.recording, ((begin, end),)
    elif event is not None:
        recording, intervals = event.number, ((event.seconds, event.end),)
    intervals = _within_readings(intervals, [s.channel.times for s in model.runs[recording].series])
    return Finding(
        unit=term.unit,
        place=place.label,
        elements=_class_elements(model, term, members),
        intervals=intervals,
        channels=_channels(model, effect),
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
        doubts=(*accepted.reasons.get(term, ()), *doubts, *(_limits(accepted, term) if is_accepted else ())),
        recording=titles[recording],
        held_out_gain=accepted.gains[term].total if term in accepted.gains else float("nan"),
        members=members,
        judged_by=accepted.judged_by.get(term, accepted.basis),
        is_of_either=_is_of_either(model, term, likely),
        is_coarse=not is_accepted and term in accepted.coarse,
    )


def _within_readings(
    intervals: Sequence[tuple[float, float]], times: Sequence[Array]
) -> tuple[tuple[float, float], ...]:
    """Intervals cut at the first and last reading: beyond these nobody looked."""
    if not any(len(t) for t in times):
        return tuple(intervals)
    first, last = (float(f(t[k] for t in times if len(t))) for f, k in ((min, 0), (max, -1)))
    return tuple((min(max(begin, first), last), max(min(end, last), first)) for begin, end in intervals)


def _is_of_either(model: DiagnosisModel, term: Term, likely: Sequence[str]) -> bool:
    """Whether a finding may be of the rig as well as of a sensor or an input, by the effects of its class."""
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
    return tuple(dict.fromkeys(element for t in found for element in _elements(model, t)))


def _effect(model: DiagnosisModel, fit: Fit, term: Term) -> Array:
    """What a term changes in every reading, in deviations of the noise, shape (residuals,).

    Predictions are compared, not residuals: where the zero of a channel is taken away, a change spreads over all of it.
    """
    point = fit.point
    if has_bins(model):
        return np.asarray(model.residuals([point.without(term)])[0] - fit.residuals)  # bins of a fabric
    inner = model.plain
    used = np.concatenate([s.used for run in model.runs for s in run.series])
    return np.where(used, raw_residuals(inner, point.without(term)) - raw_residuals(inner, point), 0.0)


def _measured(model: DiagnosisModel) -> set[str]:
    """Quantities that were recorded."""
    return {s.channel.target.quantity for run in model.runs for s in run.series}


def _elsewhere(accepted: Accepted) -> str:
    """Why a fault whose course a law may have has no name while readings that judge the whole model reject it.

    What it does in its interval a law of the rig does too, where the rig is in a state that the law needs, and readings
    of its own recording cannot tell them apart. A fault leaves nothing in other recordings, a law leaves as much there
    wherever that state comes again.
    """
    return f"the {accepted.basis} reject the model with it: a law that acts there may be what it stands for"


def _limits(accepted: Accepted, term: Term) -> tuple[str, ...]:
    """What does not hold of an accepted law although it is accepted."""
    rising = accepted.gains[term].rising if term in accepted.gains else ()
    told = (f"with it more is left of {listed(rising, 3)}, by no more than chance",) if rising else ()
    return (*told, *_beyond(accepted))


def _beyond(accepted: Accepted) -> tuple[str, ...]:
    """Why an interval may miss the true number: it is that of the fit, and takes the rest of the model for granted."""
    if not accepted.agreement.is_rejected or accepted.agreement.is_irregular:
        return ()
    return (f"the {accepted.basis} reject the model with it, so what is still missing may shift its numbers",)


def _inconstant(found: Constancy, strength: Estimate, basis: str, units: Units) -> str:
    """Why a law has no name that would have to have another strength in the readings that judge."""
    here, there = units.like(strength, found.fitted), units.like(strength, found.there)
    return (
        f"{strength.name} is {here} in the training recordings and would have to be {there} in the {basis}: "
        "a parameter of the rig is the same in all"
    )


def _other_form(share: float) -> str:
    """Why a law has no name that leaves what other laws at its place explain."""
    return (
        f"other laws at the same place would explain {100.0 * share:.0f} % of what it leaves in training beyond the "
        "noise: what acts there has another form"
    )


def _cancelled(other: tuple[Effect, Spot]) -> str:
    """Why a law has no name that another one mostly cancels."""
    law, place = other
    return (
        f"it and {law.name}, {place.label}, act against each other: both together change the readings far less than "
        "each alone, which one law of another form may do as well"
    )


def _dragged(far: tuple[Parameter, float], titles: Sequence[str]) -> str:
    """Why a law has no name with which a parameter of the model has to be far from what is stated."""
    parameter, z = far
    side = "above" if z > 0.0 else "below"
    return (
        f"with it {parameter_words(titled(parameter, titles))} is {abs(z):.1f} prior deviations {side} the stated "
        "value, farther than recalibration alone brings it: another law that leaves it alone may be what acts"
    )


def _much_left(accepted: Accepted) -> str:
    left, recalibrated = accepted.agreement, accepted.agreement_recalibrated
    share = 100.0 * left.excess / recalibrated.excess if recalibrated.excess > 0.0 else 100.0
    return (
        f"{share:.0f} % of the squared mismatch that recalibration leaves in the {accepted.basis} is still "
        "unexplained, so no name is certain"
    )


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


def _open_rivals(alternatives: Sequence[Alternative], term: Term, accepted: Accepted) -> tuple[str, ...]:
    """Effects with odds of more than 1 to 20 against this one, the most probable first."""
    own = max((a.gain for a in alternatives if a.effect == term.identifier), default=0.0)
    best = accepted.headline
    bends = {t.identifier for e, _ in accepted.rivals if bends_into(e, best) for t in e.terms if not t.is_named}
    near = [a for a in alternatives if a.probability > OPEN or (a.gain > own - UNSEPARATED and a.effect not in bends)]
    simulated = [other.identifier for other in _undecided(accepted, term)]
    return tuple(dict.fromkeys([*(a.effect for a in near if a.effect != term.identifier), *simulated]))


def _undecided(accepted: Accepted, term: Term) -> list[Term]:
    """Laws between which and this one few simulations do not decide, see `Accepted.confused`."""
    return [other for other, behind in accepted.confused.get(term, ()) if behind < INTERPOLATED]


def _alternatives(outcome: Outcome, accepted: Accepted, term: Term) -> tuple[list[Alternative], float]:
    """Explanations that have another term in the place of this one, and the probability of this one."""
    others = set(accepted.headline.terms) - {term}
    size = len(others) + 1
    rivals = [(e, total) for e, total in accepted.rivals if others <= set(e.terms) and len(e.terms) == size]
    if not rivals:
        return _shared([], 1.0, _undecided(accepted, term))
    chances = probabilities([total for _, total in rivals])
    worst = max(e.fit.cost for e, _ in rivals)
    found, own = [], 0.0
    for (explanation, _), chance in sorted(zip(rivals, chances), key=lambda pair: -pair[1]):
        other = next(t for t in explanation.terms if t not in others)
        gain = outcome.base.cost - explanation.fit.cost if not others else worst - explanation.fit.cost
        found.append(Alternative(other.identifier, other.place, float(gain), float(chance)))
        if other.identifier == term.identifier:
            own += float(chance)
    return _shared(found, own, _undecided(accepted, term))


def _shared(found: list[Alternative], own: float, undecided: Sequence[Term]) -> tuple[list[Alternative], float]:
    """The same with laws between which few simulations do not decide: each of them is as probable as the one found."""
    if not undecided:
        return found, own
    parts = 1.0 + len(undecided)
    less = [replace(a, probability=a.probability / parts) for a in found]
    more = [Alternative(t.identifier, t.place, found[0].gain if found else 0.0, own / parts) for t in undecided]
    return [*less, *more], own / parts


def _doubt(outcome: Outcome) -> float:
    """Factor on intervals where more than noise is left: errors of the model count as those of the sensors do."""
    residuals = outcome.best.fit.residuals
    used = max(int(np.count_nonzero(residuals)), 1)
    spread = np.sqrt(float(np.sum(np.clip(residuals, -HUBER, HUBER) ** 2)) / used)
    return max(1.0, float(spread), abs(outcome.left.z) / outcome.left.limit)


def estimates(
    fit: Fit, term: Term, doubt: float = 1.0, scale_uncertainty: Sequence[float] = ()
) -> tuple[Estimate, ...]:
    """Parameters of a term with 95 % intervals, cut at their bounds.

    Args:
        fit: The fit; the curvature of its posterior gives the intervals.
        term: One of its terms.
        doubt: Factor on the intervals.
        scale_uncertainty: Relative deviation of each parameter that the recordings cannot show; empty: none.
    """
    covariance = fit.covariance
    begin = len(fit.point.base)
    for other, values in fit.point.terms.items():
        if other == term:
            break
        begin += len(values)
    found = []
    for i, (p, value) in enumerate(zip(term.parameters, fit.point.terms[term])):
        seen = doubt * float(np.sqrt(max(covariance[begin + i, begin + i], 0.0)))
        unseen = np.hypot(value * scale_uncertainty[i] if scale_uncertainty else 0.0, p.resolution)
        half = NORMAL_95 * float(np.hypot(seen, unseen))
        lower, upper = max(value - half, p.lower), min(value + half, p.upper)
        found.append(_estimate(p, value, lower, upper))
    return tuple(found)


def _estimate(parameter: TermParameter, value: float, lower: float, upper: float) -> Estimate:
    """A parameter with its interval, and the physical quantity that it stands for."""
    p, physical = parameter, None
    if p.physical is not None:
        factor, offset, unit = p.physical
        physical = Physical(unit, *(factor * v + offset for v in (value, lower, upper)))
    return Estimate(p.name, p.unit, value, lower, upper, p.meaning, physical, p.is_reading)


def _elements(model: DiagnosisModel, term: Term) -> tuple[str, ...]:
    local = model.shows_in(term)
    if local is None:
        return (term.place,)
    return tuple(dict.fromkeys(model.layout.names[c].split(".")[0] for c in local[0])) or (term.place,)


def _intervals(model: DiagnosisModel, effect: Array) -> tuple[int, tuple[tuple[float, float], ...]]:
    """Recording in which an effect shows most, and the times in which it is there, pieces with gaps of a tenth of it.

    It is there where it is a tenth of its peak or more.
    """
    layout, first = model.layout, 0
    owners = np.concatenate([np.full(len(run.series), n) for n, run in enumerate(model.runs)])
    if len(layout.names) == len(owners):
        recording = owners[np.asarray(layout.channel, dtype=int)]
        first = int(np.argmax(np.bincount(recording, effect**2)))
        chosen = recording == first
    else:
        chosen = np.ones(len(effect), dtype=bool)
    times, place = np.unique(layout.time[chosen], return_inverse=True)
    strength = np.sqrt(np.bincount(place, effect[chosen] ** 2, minlength=len(times)))
    if not strength.max() > 0.0:  # what changes no reading is in none
        return first, ()
    kept = times[strength >= SHOWS * float(strength.max())]
    gap = 0.1 * (times[-1] - times[0])
    cuts = np.flatnonzero(np.diff(kept) > gap)
    begins, ends = np.concatenate([[0], cuts + 1]), np.concatenate([cuts, [len(kept) - 1]])
    return first, tuple((float(kept[a]), float(kept[b])) for a, b in zip(begins, ends))


def _channels(model: DiagnosisModel, effect: Array) -> tuple[str, ...]:
    """Channels in which the effect is largest, down to a tenth of the largest, at most twelve."""
    strength = np.bincount(np.asarray(model.layout.channel, dtype=int), effect**2, minlength=len(model.layout.names))
    order = np.argsort(-strength)
    return tuple(model.layout.names[i] for i in order[:12] if strength[i] > 0.1 * strength[order[0]])


def _fitted_value(parameter: Parameter, amount: float) -> float:
    """The number itself; NaN of an offset from 0 and of a factor over elements, which have no other value."""
    if parameter.nominal == 0.0 or parameter.unit in ("", "1"):
        return float("nan")
    return parameter.nominal * float(np.exp(amount)) if parameter.is_relative else parameter.nominal + amount


def recalibration(model: DiagnosisModel, fit: Fit, titles: Sequence[str] = ()) -> tuple[Moved, ...]:
    """Parameters that moved by more than `MOVED` prior deviations or to their bound, the farthest first.

    Args:
        model: Model of the training recordings.
        fit: Of it.
        titles: Of the recordings: parameters of one recording are called by its title.
    """
    known = {p.name: p for p in model.parameters}
    bounds = np.array([p.bounds for p in model.parameters]) * fit.widths
    at_bound = {p.name for p, z, most in zip(model.parameters, fit.point.base, bounds) if abs(z) >= AT_BOUND * most}
    found = []
    for name, (amount, z) in departures(model.parameters, fit.point.base).items():
        p = known[name]
        is_held = name in at_bound or (p.own is not None and p.own.number in at_bound)
        if p.is_within_row or not (abs(z) > MOVED or is_held):
            continue
        found.append(
            Moved(
                titled(p, titles),
                "1" if p.is_relative else p.unit,
                float(np.exp(amount)) if p.is_relative else amount,
                p.is_relative,
                float(z),
                _fitted_value(p, amount),
                p.unit,
                is_held,
            )
        )
    return tuple(sorted(found, key=lambda m: -abs(m.deviations)))
