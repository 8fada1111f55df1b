"""Which of the effects that a search suggests are accepted: those that gain on readings that they were not fitted to.

The most probable explanation stands first: training and unfitted readings together decide between those with equally
many terms. Then terms that do not gain, or that make a channel worse, go one by one, the least needed first.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import lsq_linear

from cosim.compute.steps import TimeIsOver, may_be_left
from diagnosis.judge.agreement import Agreement, agreement, times_white
from diagnosis.judge.constancy import Constancy
from diagnosis.judge.gain import LEAST, Gain, gain, loss
from diagnosis.judge.of_a_day import hidden_fault
from diagnosis.judge.unfitted import Predicted, Unfitted
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.report.display import likelihood
from diagnosis.search.exchange import in_their_places
from diagnosis.search.fit import Fit, fit, fit_best
from diagnosis.search.objective import RUNAWAY
from diagnosis.search.problem import Model, Point, Term
from diagnosis.search.search import Explanation, Outcome, shrink

#: Rivals that are compared on unfitted readings, and how far behind in training they may lie [-2 log posterior].
RIVALS, BEHIND = 5, 30.0
#: Root mean square by which predictions with and without a law differ, in deviations of the noise, below which the
#: readings do not show it.
SHOWN = 0.02
#: Share of the largest gain of any channel from which a term shows in a channel.
SHOWS = 0.1
#: Steps of a fit of a law in the place of another, and multiples of its fitted strength at which it is simulated:
#: between few simulations a fit may end at one of them.
EXCHANGE, STRENGTHS = 20, (0.5, 1.0, 2.0, 4.0, 8.0)

#: Explanations whose -2 log posterior is within this of the best cannot be told from it (odds of 20 to 1).
UNSEPARATED = 6.0
#: Unit of laws of what scatters: how contacts and solvers of a fabric differ has a direction of its own, which a weak
#: law may follow in training and held out alike. A fabric that lacked nothing was short of 0.13 N of friction so.
SCATTERED = "mechanical"
#: Why a law of what scatters is not accepted that no readings ask for.
_SCATTERED = (
    "neither the training readings nor those that judge reject the model without it: by as much simulations of an "
    "equal fabric may differ"
)
#: Share of what a law moves (sum of squares) from which on an error of the macro-step may be taken for it: half as far.
SOLVED = 0.25
#: Most by which a change came earlier than its row, in halves of a row.
ROWS = 2.0
#: Why nothing is accepted that comes with a worse model.
_DISTORTED = (
    "together with the parameters that were fitted with it, the readings that judge are predicted worse than by the "
    "scenario as it is"
)


@dataclass(frozen=True)
class Accepted:
    """What of a search is accepted.

    Args:
        headline: Explanation with everything that is suggested, the most probable of its size.
        explanation: Explanation with what is accepted alone; the recalibrated model where nothing is.
        reasons: Term that is not accepted to why, in plain words.
        gains: Term to what it gains on unfitted readings, all others kept.
        rivals: Explanations of the headline's size with their -2 log posterior of training and unfitted readings.
        before: What the scenario as it is leaves of the unfitted readings.
        recalibrated: What the recalibrated model leaves.
        after: What the accepted explanation leaves.
        suggested: What the explanation with everything that is suggested leaves.
        recalibration: Gain of recalibrating; None where nothing was compared.
        agreement: Of the accepted explanation with the unfitted readings.
        training: Of the accepted explanation with the training readings.
        agreement_before: Of the scenario as it is with the unfitted readings.
        agreement_recalibrated: Of the recalibrated model with them.
        basis: Which readings judged.
        judged_by: Term to which readings judged it: others of its own recording where no other one has it.
        strengths: Term to its strength in the readings that judge, where they reject the model.
        without: Term that is accepted to the fit of all others without it.
        forms: Term to the share of what is left in training that other laws at its place explain, where readings reject
            the model and that was asked.
        opposed: Term to another that it mostly cancels.
        confused: Accepted term to laws that are not told from it, with how much more -2 log posterior they leave in its
            place. Of fabrics, whose laws are interpolated between few simulations, those that data often cannot tell
            from it, by training, 0 where unfitted readings do not tell them apart; else, where several terms are
            suggested, named laws at any place that leave less than `UNSEPARATED` more, by both.
        coarse: Terms that are not accepted because the macro-step is too long to tell, and for nothing else.
        rows: Terms that are not accepted because changes of recorded inputs that came before their rows explain as
            much, and for nothing else.
    """

    headline: Explanation
    explanation: Explanation
    reasons: Mapping[Term, tuple[str, ...]]
    gains: Mapping[Term, Gain]
    rivals: tuple[tuple[Explanation, float], ...]
    before: Predicted
    recalibrated: Predicted
    after: Predicted
    suggested: Predicted
    recalibration: Gain
    agreement: Agreement
    training: Agreement
    agreement_before: Agreement
    agreement_recalibrated: Agreement
    basis: str
    judged_by: Mapping[Term, str] = field(default_factory=dict)
    strengths: Mapping[Term, Constancy] = field(default_factory=dict)
    without: Mapping[Term, Fit] = field(default_factory=dict)
    forms: Mapping[Term, float] = field(default_factory=dict)
    opposed: Mapping[Term, Term] = field(default_factory=dict)
    confused: Mapping[Term, tuple[tuple[Term, float], ...]] = field(default_factory=dict)
    coarse: frozenset[Term] = frozenset()
    rows: frozenset[Term] = frozenset()


class _Judge:
    """Predictions of explanations, each made once."""

    def __init__(
        self, model: DiagnosisModel, unfitted: Unfitted, local: Unfitted | None, training: Unfitted | None = None
    ) -> None:
        self.model, self.unfitted, self.local, self.training = model, unfitted, local, training
        self._known: dict[tuple[int, bool], Predicted] = {}
        self._kept: list[Point] = []
        #: Terms that move readings no farther than an error of the macro-step may.
        self.coarse: set[Term] = set()
        #: Terms that gain no more than changes of inputs do that came before their rows.
        self.rows: set[Term] = set()

    def predict(self, point: Point, is_local: bool = False) -> Predicted:
        key = (id(point), is_local)
        if key not in self._known:
            source = self.local if is_local and self.local is not None else self.unfitted
            self._known[key] = source.predict(point)
            self._kept.append(point)  # an id is only one as long as its object lives
        return self._known[key]

    def evidence(self, without: Fit, with_it: Fit, is_local: bool) -> Gain:
        """What one fit gains over another; of a term that belongs to a stretch of a day on other readings of it."""
        source = self.local if is_local and self.local is not None else self.unfitted
        return gain(self.predict(without.point, is_local), self.predict(with_it.point, is_local), source.readings)

    def has_stopped(self, point: Point, is_local: bool) -> bool:
        """Whether a simulation gave no finite values, or values that run away."""
        return bool(np.any(np.abs(self.predict(point, is_local).residuals) >= RUNAWAY))

    def rejects(self, point: Point) -> bool:
        """Whether the readings that judge, or the training readings, reject a model."""
        if agreement(self.predict(point).residuals, self.unfitted.readings).is_rejected:
            return True
        if self.training is None:
            return False
        fitted = self.training.predict(point, is_fitted=False)
        return agreement(fitted.residuals, self.training.readings).is_rejected

    def basis(self, is_local: bool) -> str:
        """Which readings judge a term, in plain words."""
        return (self.local if is_local and self.local is not None else self.unfitted).basis


def accept(
    model: DiagnosisModel,
    outcome: Outcome,
    unfitted: Unfitted,
    training: Unfitted,
    is_local: Callable[[Term], bool],
    local: Callable[[], Unfitted] | None = None,
    can_compare: bool = True,
    on_progress: Callable[[str], None] = lambda text: None,
) -> Accepted:
    """Accept what gains on readings that it was not fitted to.

    Args:
        model: Model of the training recordings that the outcome belongs to.
        outcome: Of the search.
        unfitted: Readings that judge.
        training: The training readings.
        is_local: Whether a term belongs to the training recordings alone, so that no other recording shows it; see
            `diagnosis.judge.of_a_day`.
        local: Makes the readings that judge such terms.
        can_compare: Whether rivals are compared on unfitted readings too (not where each prediction takes minutes).
        on_progress: Told what is being done.
    """
    has_local = any(is_local(t) for t in outcome.best.terms)
    judge = _Judge(model, unfitted, local() if local is not None and has_local else None, training)
    before = unfitted.predict(Point(np.zeros(len(model.parameters))), is_fitted=False)
    recalibrated = judge.predict(outcome.base.point)
    headline = outcome.best
    rivals: tuple[tuple[Explanation, float], ...] = ((headline, headline.demerit),)
    if headline.terms and can_compare:
        on_progress("comparing explanations on readings that they were not fitted to")
        headline, rivals = _most_probable(judge, outcome)
    noise = outcome.margin, _alike(outcome, training) if has_local else {}
    reasons: dict[Term, tuple[str, ...]] = {}
    gains: dict[Term, Gain] = {}
    others: dict[Term, Fit] = {}
    current = headline
    while current.terms:
        what = "one effect" if len(current.terms) == 1 else f"{len(current.terms)} effects"
        on_progress(f"judging {what} by readings that were not fitted")
        others = {t: _others(judge.model, outcome, current, t) for t in current.terms}
        judged = {t: _judged(judge, current, t, others[t], is_local(t), noise) for t in current.terms}
        gains |= {t: found for t, (found, _) in judged.items()}
        failing = [t for t, (_, why) in judged.items() if why]
        if not failing:
            whole = judge.evidence(outcome.base, current.fit, False)
            if not whole.worse:
                break
            failing = list(current.terms)
            judged = {t: (g, (_worse(whole.worse),)) for t, (g, _) in judged.items()}
        worst = min(failing, key=lambda t: judged[t][0].total)
        reasons[worst] = judged[worst][1]
        current = _without(model, outcome, current, worst)
    if not current.terms:  # where the last terms went together, their fit may have ended in another ridge
        current = Explanation(outcome.base)
    after = judge.predict(current.fit.point)
    readings = unfitted.readings
    # A fault of a stretch of training says nothing of other readings; what it keeps from the parameters does.
    is_of_training = all(is_local(t) for t in current.terms) and gain(recalibrated, after, readings).is_gain
    if current.terms and not is_of_training and gain(before, after, readings).is_loss:
        reasons |= dict.fromkeys(current.terms, (_DISTORTED,))
        current, after = Explanation(outcome.base), recalibrated
    fitted = training.predict(current.fit.point, is_fitted=False)
    found = _agreement(unfitted, current.fit.point, after, on_progress)
    strengths = {}
    if found.is_rejected and current.terms:
        on_progress("asking whether each law has the same strength in readings that it was not fitted to")
        strengths = unfitted.strengths(current.fit.point, after)
    return Accepted(
        headline,
        current,
        reasons,
        gains,
        rivals,
        before,
        recalibrated,
        after,
        judge.predict(headline.fit.point) if headline.terms else recalibrated,
        gain(before, recalibrated, readings),
        found,
        agreement(fitted.residuals, training.readings),
        agreement(before.residuals, readings),
        agreement(recalibrated.residuals, readings),
        unfitted.basis,
        {t: judge.basis(is_local(t)) for t in gains},
        strengths,
        {t: others[t] for t in current.terms},
        confused=_not_told_apart(model, judge, headline, current, others, can_compare, on_progress),
        coarse=frozenset(judge.coarse & reasons.keys()),
        rows=frozenset(judge.rows & reasons.keys()),
    )


def _agreement(unfitted: Unfitted, point: Point, predicted: Predicted, on_progress: Callable[[str], None]) -> Agreement:
    """Of a fit with unfitted readings; where noise alone rejects it, within the error of what was fitted."""
    found = agreement(predicted.residuals, unfitted.readings)
    if not found.is_rejected:
        return found
    on_progress("asking whether the error of the fitted parameters explains what is left")
    tested = unfitted.tested(point, predicted)
    return agreement(predicted.residuals, unfitted.readings, tested)


def _without(model: Model, outcome: Outcome, explanation: Explanation, term: Term) -> Explanation:
    """The explanation without a term, fitted to the end; the recalibrated model where it was the only one."""
    point = explanation.fit.point.without(term)
    if not point.terms:
        return Explanation(outcome.base)
    found = Explanation(fit(model, point, widths=explanation.fit.widths))
    return shrink(model, found, outcome.margin)


def _not_told_apart(
    model: DiagnosisModel,
    judge: _Judge,
    headline: Explanation,
    current: Explanation,
    without: Mapping[Term, Fit],
    can_compare: bool,
    on_progress: Callable[[str], None],
) -> dict[Term, tuple[tuple[Term, float], ...]]:
    """See `Accepted.confused`."""
    if model.has_scatter:
        return {t: _confused(model, judge, current, t) for t in current.terms}
    if len(headline.terms) < 2 or not can_compare:  # a law alone was compared with all others when it was found
        return {}
    found: dict[Term, tuple[tuple[Term, float], ...]] = {}
    with suppress(TimeIsOver), may_be_left():
        on_progress("trying other laws in the place of those that were found")
        laws = [t for t in model.terms() if not t.is_completing]
        right = judge.predict(current.fit.point)
        for term, others in in_their_places(model, current.fit, without, laws).items():
            behind = [(other, _behind(judge, current, right, e)) for other, e in others]
            found[term] = tuple((other, value) for other, value in behind if value < UNSEPARATED)
    return found


def _behind(judge: _Judge, current: Explanation, right: Predicted, other: Explanation) -> float:
    """How much more -2 log posterior of training and unfitted readings another explanation of as many terms leaves."""
    there = gain(right, judge.predict(other.fit.point), judge.unfitted.readings)
    return float(other.cost - current.cost - there.total / there.doubt**2)


def _confused(model: DiagnosisModel, judge: _Judge, current: Explanation, term: Term) -> tuple[tuple[Term, float], ...]:
    """Laws of which a law says that data often cannot tell them from it, with what each leaves more in its place.

    What is interpolated between few simulations is simulated there: a law that predicts the readings that judge as well
    at its fitted strength, or at a smaller or larger one up to its bounds, leaves nothing more. What one law says of
    another holds for both.
    """
    names = model.where(term)[0].confused_with
    beside = [t for t in model.terms() if t.place == term.place and t not in current.terms]
    others = [t for t in beside if t.identifier in names or term.identifier in model.where(t)[0].confused_with]
    right, without, found = judge.predict(current.fit.point), current.fit.point.without(term), []
    for other in others:
        first, *rest = other.parameters
        starts = [without.plus(other, (size, *(p.starts[0] for p in rest))) for size in first.starts]
        fitted = Explanation(fit_best(model, starts, EXCHANGE, current.fit))
        strength, *shape = fitted.fit.point.terms[other]
        sizes = list(dict.fromkeys(float(np.clip(share * strength, first.lower, first.upper)) for share in STRENGTHS))
        points = [fitted.fit.point.plus(other, (size, *shape)) for size in sizes]
        is_told = all(gain(judge.predict(p), right, judge.unfitted.readings).is_gain for p in points)
        behind = fitted.demerit - current.demerit
        found.append((other, behind if is_told else min(behind, 0.0)))
    return tuple(found)


def _most_probable(judge: _Judge, outcome: Outcome) -> tuple[Explanation, tuple[tuple[Explanation, float], ...]]:
    """The explanation that training and unfitted readings together make the most probable, with its rivals."""
    best = outcome.best
    size = len(best.terms)
    others = [e for e in outcome.rivals if len(e.terms) == size and set(e.terms) != set(best.terms)]
    near = sorted((e for e in others if e.demerit < best.demerit + BEHIND), key=lambda e: e.demerit)[:RIVALS]
    readings = judge.unfitted.readings
    reference = judge.predict(best.fit.point)
    found = [(best, best.demerit)]
    for explanation in near:  # against the best: what all of them gain over the base says nothing about their order
        there = gain(reference, judge.predict(explanation.fit.point), readings)
        found.append((explanation, explanation.demerit - there.total / there.doubt**2))
    known = {id(e) for e in near}
    far = [e for e in others if id(e) not in known]
    worst = max(total - e.demerit for e, total in found)
    found += [(e, e.demerit + worst) for e in far]  # at best as good on unfitted readings as the worst of the near ones
    ranked = sorted(found, key=lambda pair: pair[1])
    chosen = ranked[0][0]
    if set(chosen.terms) != set(best.terms):
        chosen = shrink(judge.model, Explanation(chosen.fit), outcome.margin)
        if len(chosen.terms) != size:  # what remains has fewer terms: its rivals are not known
            return chosen, ((chosen, chosen.demerit),)
        ranked[0] = (chosen, ranked[0][1])
    return chosen, tuple(ranked)


def _others(model: Model, outcome: Outcome, current: Explanation, term: Term) -> Fit:
    """The fit of an explanation without one of its terms."""
    others = current.fit.point.without(term)
    if not others.terms:
        return outcome.base
    return current.without.get(term) or fit(model, others, near=current.fit)


def _judged(
    judge: _Judge,
    current: Explanation,
    term: Term,
    without: Fit,
    is_local: bool,
    noise: tuple[float, Mapping[str, float]],
) -> tuple[Gain, tuple[str, ...]]:
    """What a term gains on unfitted readings over the fit without it, and why it is not accepted.

    `noise` is what a term must gain, and the correlations of `_alike`.
    """
    found = judge.evidence(without, current.fit, is_local)
    where = judge.basis(is_local)
    reasons = []
    data = float(np.sum(loss(without.residuals)) - np.sum(loss(current.fit.residuals)))
    if data < LEAST:
        reasons.append(
            "only the priors support it: the training readings are met as well without it "
            f"(-2 log likelihood falls by {likelihood(data)})"
        )
    elif found.shown < SHOWN:
        reasons.append(
            f"the readings that judge ({where}) do not show it: they are predicted alike with and without it"
        )
    elif judge.has_stopped(current.fit.point, is_local) and not judge.has_stopped(without.point, is_local):
        reasons.append(f"with it the simulation stops or runs away before the end of the readings that judge ({where})")
    elif found.is_loss:
        reasons.append(
            f"it predicts the readings that judge ({where}) worse: "
            f"-2 log likelihood rises by {likelihood(-found.total)}"
        )
    elif found.total <= 0.0:
        reasons.append(
            f"it does not predict the readings that judge ({where}) better: "
            f"-2 log likelihood rises by {likelihood(-found.total)}"
        )
    elif not found.is_gain:
        reasons.append(
            f"it does not predict the readings that judge ({where}) better by more than chance: "
            f"-2 log likelihood falls by {likelihood(found.total)}, {likelihood(found.needed)} would be needed"
        )
    if found.worse:
        reasons.append(_worse(found.worse))
    hidden = hidden_fault(judge.model, current.fit.point, term)
    if hidden:
        reasons.append(hidden)
    if is_local and (why := _of_noise(judge.model, *noise, current, without)):
        reasons.append(why)  # readings beside those that were fitted have their noise
    return found, tuple(
        reasons
        or _scattered(judge, term, without)
        or _of_solving(judge, term, current, without)
        or ([] if is_local else _of_rows(judge, term, current, without, noise[0]))
    )


def _scattered(judge: _Judge, term: Term, without: Fit) -> list[str]:
    """Why a law of what scatters is not accepted that no readings ask for: none, or one reason."""
    if not judge.model.has_scatter or term.unit != SCATTERED or judge.rejects(without.point):
        return []
    return [_SCATTERED]


def _of_solving(judge: _Judge, term: Term, current: Explanation, without: Fit) -> list[str]:
    """Why a law is not accepted that moves readings as little as an error of solving may: none, or one reason."""
    inner, plain = judge.model.innermost, judge.model.innermost_point(without.point)
    error = inner.solving_error(plain)
    if error is None:
        return []
    moved = np.subtract(*inner.residuals([judge.model.innermost_point(current.fit.point), plain]))
    if float(error @ error) <= SOLVED * float(moved @ moved):
        return []
    judge.coarse.add(term)
    sizes = [f"{float(np.sqrt(np.mean(v**2))):.2g}" for v in (error, moved)]
    return [
        "time.macro_step is too long to tell: what components exchange, and inputs, are late by up to so much, which "
        f"moves readings by about {sizes[0]} of their noise, and the law by {sizes[1]}"
    ]


def _of_rows(judge: _Judge, term: Term, current: Explanation, without: Fit, margin: float) -> list[str]:
    """Why a law is not accepted that gains as rows of recorded inputs do which stand late: none, or one reason.

    What changed between two rows stands in the later one. Where changes of the inputs that came earlier, by up to a row
    of each recording, gain as much of the training readings as the law or more, up to what chance gives, the law is one
    of two reasons. Around the fit without the law residuals are straight lines in both (a step of Gauss and Newton).
    """
    inner, plain = judge.model.innermost, judge.model.innermost_point(without.point)
    shifts = inner.row_shifts(plain)
    if not len(shifts):
        return []
    before, after = inner.residuals([plain, judge.model.innermost_point(current.fit.point)])
    slopes = inner.base_jacobian(plain)
    ends = np.array([p.bounds for p in inner.parameters])
    prior = np.hstack([np.zeros((len(ends), len(shifts))), np.eye(len(ends))])
    moves = np.hstack([shifts.T, slopes])
    lower, upper = (
        np.r_[np.zeros(len(shifts)), -ends - plain.base],
        np.r_[np.full(len(shifts), ROWS), ends - plain.base],
    )
    aim = -np.concatenate([before, plain.base])
    found = lsq_linear(np.vstack([moves, prior]), aim, (lower - 1e-9, upper + 1e-9))
    left = before + moves @ found.x
    law, rows = (float(np.sum(loss(before)) - np.sum(loss(r))) for r in (after, left))
    if law - rows > margin:
        return []
    judge.rows.add(term)
    return [
        "changes of recorded inputs stand in the row after them: where they came up to a row earlier the training "
        f"readings are met as well (-2 log likelihood falls by {likelihood(rows)}, with the law by {likelihood(law)})"
    ]


def _alike(outcome: Outcome, training: Unfitted) -> Mapping[str, float]:
    """Correlations of neighbouring readings; none where the training readings reject the recalibrated model."""
    plain = agreement(training.predict(outcome.base.point, is_fitted=False).residuals, training.readings)
    return {} if plain.is_rejected else plain.alike


def _of_noise(model: Model, margin: float, alike: Mapping[str, float], current: Explanation, without: Fit) -> str:
    """Why what is judged by its own recording may be noise; empty where it is not.

    Args:
        model: Of the training recordings.
        margin: What a term must gain.
        alike: See `_alike`.
        current: Explanation with the term.
        without: The fit without it.
    """
    fall = loss(without.residuals) - loss(current.fit.residuals)
    own = np.bincount(np.asarray(model.layout.channel, dtype=int), fall, minlength=len(model.layout.names))
    names = [n for n, amount in zip(model.layout.names, own) if amount > SHOWS * own.max()]
    times = times_white(alike, names)
    if times <= 1.0 or float(own.sum()) > margin * times:
        return ""
    return (
        "the training readings do not reject the model without it, and noise that is alike from one reading to the "
        "next, as it may be here, gains as much"
    )


def _worse(channels: Sequence[str]) -> str:
    more = f" and {len(channels) - 3} more" if len(channels) > 3 else ""
    return f"with it these are predicted worse: {', '.join(channels[:3])}{more}"
