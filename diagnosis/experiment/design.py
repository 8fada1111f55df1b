"""Which experiment parts explanations that the recordings leave open."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.compute.steps import counted
from cosim.scenario import Scenario
from cosim.unit.protocol import Array
from diagnosis.experiment.bench import Belief, Bench, Conditions, Contrast
from diagnosis.experiment.drivers import Rig, rig
from diagnosis.experiment.plan import HOTTER, Planner
from diagnosis.experiment.programmes import Shape, again, shapes, stretched
from diagnosis.experiment.separation import DECISIVE
from diagnosis.judge.acceptance import UNSEPARATED, Accepted
from diagnosis.judge.next_experiment import Course, NextExperiment, Rival
from diagnosis.judge.rivals import bends_into, probabilities
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.coil_network.translate import GRAVITY
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording
from diagnosis.search.search import Explanation, Outcome

#: Share of cases from which an experiment is said to decide: more often than not.
LIKELY = 0.5
#: Odds beyond which an explanation is no longer open.
ODDS = math.exp(DECISIVE)
#: Explanations that are weighed against each other.
MOST = 4
#: A programme that decides with this probability is enough: then the shortest such is taken.
ENOUGH = 0.95
#: Families that are tried with half the load, and of which longer programmes are tried.
_LOADED, _LONGER = 2, 3
_BROAD = ("staircase", "steps in mixed order")


@dataclass(frozen=True)
class _Tried:
    """A programme and what it is predicted to do."""

    shape: Shape
    courses: tuple[Course, ...]
    conditions: Conditions
    contrasts: list[Contrast]
    decides: float
    gain: float


@dataclass(frozen=True)
class Open:
    """Explanations that recordings leave open.

    Args:
        explanations: The most probable first.
        chances: Probability of each among them, shape (explanations,).
    """

    explanations: tuple[Explanation, ...]
    chances: Array

    @property
    def log_odds(self) -> list[float]:
        """ln of the odds of the first against each of the others."""
        return [float(np.log(self.chances[0] / c)) for c in np.maximum(self.chances[1:], 1e-12)]


def open_explanations(outcome: Outcome, totals: Sequence[tuple[Explanation, float]] = ()) -> Open | None:
    """Explanations that the recordings leave open; None where nothing is open.

    Args:
        outcome: Of a search.
        totals: -2 log posterior of explanations by training and unfitted readings together; those that are not listed
            count by training alone.
    """
    known = {id(e): total for e, total in totals}
    if not outcome.best.terms:
        return _unearned(outcome)
    size = len(outcome.best.terms)
    laws = set(outcome.best.fit.point.lasting.terms)
    others = [e for e in outcome.rivals if len(e.terms) == size and set(e.fit.point.lasting.terms) != laws]
    chances = probabilities([known.get(id(e), e.demerit) for e in (outcome.best, *others)])
    # What is printed as ambiguous is open too: odds that rest on the number of parameters alone decide nothing.
    gaps = np.array([e.fit.cost - outcome.best.fit.cost for e in others])
    is_alike = [g < UNSEPARATED and not bends_into(e, outcome.best) for g, e in zip(gaps, others)]
    near = [i for i in np.argsort(-chances[1:]) if chances[0] < ODDS * chances[i + 1] or is_alike[i]]
    near = near[: MOST - 1]
    found = (outcome.best, *(others[i] for i in near))
    return Open(found, probabilities([known.get(id(e), e.demerit) for e in found])) if near else None


def _as_accepted(outcome: Outcome, accepted: Accepted) -> Outcome:
    """The outcome as it stands after readings have judged that it was not fitted to.

    Open are then those whose odds, of training and unfitted readings together, are not below 1 to 20; where nothing is
    accepted, what is suggested is open against the recalibrated model.
    """
    base = Explanation(outcome.base)
    if not accepted.explanation.terms:
        known = [e for e in outcome.rivals if set(e.terms) != set(accepted.headline.terms)]
        return replace(outcome, best=base, rivals=(base, accepted.headline, *known))
    least = min(total for _, total in accepted.rivals)
    near = tuple(e for e, total in accepted.rivals if total < least + UNSEPARATED)
    return replace(outcome, best=accepted.headline, rivals=near)


def _unearned(outcome: Outcome) -> Open | None:
    """The model as it is against what came nearest: with a gain of just the margin an effect would be a toss-up."""
    with_term = [e for e in outcome.rivals if e.fit.point.lasting.terms]
    gains = np.array([outcome.base.cost - e.fit.cost for e in with_term])
    kept = [i for i in np.argsort(-gains) if gains[i] > outcome.margin - UNSEPARATED][: MOST - 1]
    if not kept:
        return None
    weights = np.concatenate([[1.0], np.exp(0.5 * (gains[kept] - outcome.margin))])
    return Open((Explanation(outcome.base), *(with_term[i] for i in kept)), weights / weights.sum())


def next_experiment(
    scenario: Scenario,
    model: DiagnosisModel,
    recordings: Sequence[Recording],
    outcome: Outcome,
    accepted: Accepted,
    limits: Mapping[str, float],
) -> NextExperiment | None:
    """What would decide about explanations that are left open, where the coil network can simulate it; see `design`."""
    totals = accepted.rivals if accepted.explanation.terms else ()  # as the probability of a finding counts them
    question = open_explanations(_as_accepted(outcome, accepted), totals)
    network = model.coil_network
    if question is None or network is None:
        return None
    return design(scenario, SoFar(network, recordings, model.inflation), question, limits)


@dataclass(frozen=True)
class SoFar:
    """Recordings so far.

    Args:
        model: Their model.
        recordings: Themselves, in order.
        inflation: Of the variance, of every channel, where no model meets their noise.
    """

    model: CoilNetworkModel
    recordings: Sequence[Recording]
    inflation: Array | None = None


def design(
    scenario: Scenario, so_far: SoFar, question: Open, limits: Mapping[str, float] | None = None
) -> NextExperiment | None:
    """The experiment that parts explanations best, or None where nothing can be driven.

    Of families of programmes within the limits of the rig it takes the one with the largest predicted odds; where
    several decide almost surely, the shortest of them. Predictions are full simulations of each explanation; what each
    could still be recalibrated to is taken away to first order (see `separation.distance`).

    Args:
        scenario: The model as it is.
        so_far: Recordings so far.
        question: What is open; see `open_explanations`.
        limits: `component.output` to its greatest value, in the unit of that output.

    Raises:
        InputError: A limit names nothing that can be driven.
    """
    longest = max(float(run.inputs.time[-1] - run.inputs.time[0]) for run in so_far.model.runs)
    driven = rig(scenario, [scenario_of(scenario, r) for r in so_far.recordings], longest, limits or {})
    if driven is None:
        return None
    beliefs = [Belief.of(e.fit, len(so_far.model.parameters)) for e in question.explanations]
    bench = Bench(so_far.model, so_far.recordings, beliefs, so_far.inflation)
    tried = _tried(driven, bench, question)
    if not tried:
        return None
    best = _best(tried)
    repeated = _weighed(bench.contrasts(bench.repeat(), question.log_odds), question)
    first = best.contrasts[0]
    return NextExperiment(
        scenario=None,
        kind=best.shape.kind,
        statement=_statement(best, repeated[0], question),
        rivals=tuple(Rival(_words(e), float(c)) for e, c in zip(question.explanations, question.chances)),
        courses=best.courses,
        duration=best.conditions.duration,
        limits=(
            *driven.limits(),
            f"coils at most {HOTTER:g} K hotter than in the recordings",
            f"at most three times as long as the recordings ({3.0 * longest:g} s)",
        ),
        log_bayes_factor=best.gain,
        repeat_log_bayes_factor=repeated[1],
        decides=best.decides,
        repeat_decides=repeated[0],
        channel=first.channel,
        best_time=first.time,
        tried=len(tried),
        mass=(best.conditions.load or 0.0) / GRAVITY,
    )


def _words(explanation: Explanation) -> tuple[str, ...]:
    return tuple(map(str, explanation.fit.point.lasting.terms)) or ("the model as it is",)


def _weighed(contrasts: Sequence[Contrast], question: Open) -> tuple[float, float]:
    """Probability of a decision, and expected ln of the Bayes factor, averaged over the rivals of the first."""
    if not contrasts:
        return 0.0, 0.0
    weights = question.chances[1:] / np.sum(question.chances[1:])
    return (
        float(weights @ [c.separation.decides for c in contrasts]),
        float(weights @ [c.separation.log_bayes_factor for c in contrasts]),
    )


def _tried(driven: Rig, bench: Bench, question: Open) -> list[_Tried]:
    """One programme of each family; of the best, as long as none decides, with half the load, longer, and repeated."""
    planner = Planner(driven, bench)
    found: list[_Tried] = []
    if not np.isfinite(planner.hottest):
        return found  # what the coils stood so far is not known
    every = list(shapes(driven.duration, driven.columns, planner.levels()))
    for shape in counted(every, "programmes simulated"):
        found += _one(planner, shape, None, question)
    if not found or max(t.decides for t in found) >= ENOUGH:
        return found
    first = sorted(found, key=lambda t: -t.gain)
    if driven.load is not None:
        weight = float(np.max(np.asarray(bench.model.runs[0].translation.parameters.base["load"])))
        # A programme that shows nothing with the old load may show all with another: two that visit every level too.
        chosen = [*(t.shape for t in first[:_LOADED]), *(t.shape for t in found if t.shape.kind in _BROAD)]
        for shape in counted(list({id(s): s for s in chosen}.values()), "programmes simulated with half the load"):
            found += _one(planner, shape, 0.5 * weight, question)
        if max(t.decides for t in found) >= ENOUGH:
            return found
    for one in counted(sorted(found, key=lambda t: -t.gain)[:_LONGER], "longer programmes simulated"):
        found += _one(planner, stretched(one.shape, 3.0 * driven.duration), one.conditions.load, question)
    shortest = next(t.shape for t in first if t.shape.duration <= driven.duration)
    return found + _one(planner, again(shortest, 3), None, question)


def _one(planner: Planner, shape: Shape, load: float | None, question: Open) -> list[_Tried]:
    made = planner.conditions(shape, load)
    if made is None:
        return []
    contrasts = planner.bench.contrasts(planner.bench.under(made[1]), question.log_odds)
    if not contrasts:
        return []
    decides, gain = _weighed(contrasts, question)
    return [_Tried(shape, *made, contrasts, decides, gain)]


def _best(tried: Sequence[_Tried]) -> _Tried:
    enough = [t for t in tried if t.decides >= ENOUGH]
    if not enough:
        return max(tried, key=lambda t: t.gain)
    shortest = min(t.conditions.duration for t in enough)
    return max((t for t in enough if t.conditions.duration <= shortest), key=lambda t: t.gain)


def _statement(best: _Tried, repeated: float, question: Open) -> str:
    first, second = (" with ".join(_words(e)).replace("_", " ") for e in question.explanations[:2])
    load = "" if best.conditions.load is None else f", with half the load ({best.conditions.load / GRAVITY:.3g} kg)"
    more = f" (and {len(question.chances) - 2} more)" if len(question.chances) > 2 else ""
    kind = best.shape.kind[0].upper() + best.shape.kind[1:]
    programme, between = f"{kind} for {best.conditions.duration:g} s{load}", f"{first} and {second}{more}"
    cases = f"in {100 * best.decides:.0f} % of cases, a repeat of the recordings in {100 * repeated:.0f} %"
    if best.decides < LIKELY:
        return (
            f"No programme that was tried within the limits of the rig is likely to decide between {between}: "
            f"{programme[0].lower()}{programme[1:]}, the best of them, does with odds of 20 to 1 {cases}."
        )
    return f"{programme} would decide between {between} with odds of 20 to 1 {cases}."
