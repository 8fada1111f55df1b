"""Which experiment parts explanations that the recordings leave open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.scenario import Scenario
from cosim.unit import Array
from diagnosis.experiment.bench import Bench, Conditions, Contrast
from diagnosis.experiment.drivers import Rig, rig
from diagnosis.experiment.plan import HOTTER, Planner
from diagnosis.experiment.programmes import Shape, again, shapes, stretched
from diagnosis.judge.judge import UNSEPARATED, probabilities
from diagnosis.judge.next_experiment import Course, NextExperiment, Rival
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording
from diagnosis.search.search import Explanation, Outcome
from diagnosis.simulator.bank_model import BankModel
from diagnosis.simulator.translate import GRAVITY

#: Explanations that are weighed against each other.
MOST = 4
#: A programme that decides with this probability is enough: then the shortest such is taken.
ENOUGH = 0.95
#: Families of which longer programmes are tried too.
_LONGER = 3


@dataclass(frozen=True)
class _Tried:
    """A programme and what it is predicted to do."""

    shape: Shape
    courses: tuple[Course, ...]
    conditions: Conditions
    contrasts: list[Contrast]
    decides: float
    gain: float


def open_explanations(outcome: Outcome) -> tuple[Explanation, ...]:
    """Explanations that the recordings leave open, the most probable first; fewer than two where nothing is open.

    Args:
        outcome: Of a search.
    """
    ordered = sorted(outcome.rivals, key=lambda e: e.fit.cost)
    if not ordered:
        return ()
    if not outcome.best.terms:  # nothing was earned: the model as it is against what came nearest
        return (outcome.best, *(e for e in ordered if e.terms))[:MOST]
    near = [e for e in ordered if e.fit.cost < ordered[0].fit.cost + UNSEPARATED]
    best = next((e for e in near if e.terms == outcome.best.terms), None)
    return tuple(near if best is None else [best, *(e for e in near if e is not best)])[:MOST]


def design(
    scenario: Scenario, model: BankModel, recordings: Sequence[Recording], explanations: Sequence[Explanation],
    limits: Mapping[str, float] | None = None,
) -> NextExperiment | None:  # fmt: skip
    """The experiment that parts explanations best, or None where nothing is open or nothing can be driven.

    Of families of programmes within the limits of the rig it takes the one with the largest predicted odds; where
    several decide almost surely, the shortest of them. Predictions are full simulations of each explanation; what each
    could still be recalibrated to is taken away to first order (see `separation.distance`).

    Args:
        scenario: The model as it is.
        model: Model of the recordings.
        recordings: These, in order.
        explanations: What is open, the most probable first; see `open_explanations`.
        limits: `component.output` to its greatest value, in the unit of that output.

    Raises:
        InputError: A limit names nothing that can be driven.
    """
    if len(explanations) < 2:
        return None
    longest = max(float(run.inputs.time[-1] - run.inputs.time[0]) for run in model.runs)
    driven = rig(scenario, [scenario_of(scenario, r) for r in recordings], longest, limits or {})
    if driven is None:
        return None
    bench = Bench(model, recordings, [e.fit for e in explanations])
    chances = probabilities(tuple(explanations))
    tried = _tried(driven, bench, chances)
    if not tried:
        return None
    best = _best(tried)
    repeated = _weighed(bench.contrasts(bench.repeat(), _odds(chances)), chances)
    first = best.contrasts[0]
    return NextExperiment(
        scenario=None,
        kind=best.shape.kind,
        statement=_statement(best, repeated[0], explanations),
        rivals=tuple(Rival(_words(e), float(c)) for e, c in zip(explanations, chances)),
        courses=best.courses,
        duration=best.conditions.duration,
        limits=(*driven.limits(), f"coils at most {HOTTER:g} K hotter than in the recordings",
                f"at most three times as long as the recordings ({3.0 * longest:g} s)"),
        log_bayes_factor=best.gain,
        repeat_log_bayes_factor=repeated[1],
        decides=best.decides,
        repeat_decides=repeated[0],
        channel=first.channel,
        best_time=first.time,
        tried=len(tried),
        mass=(best.conditions.load or 0.0) / GRAVITY,
    )  # fmt: skip


def _words(explanation: Explanation) -> tuple[str, ...]:
    return tuple(map(str, explanation.terms)) or ("the model as it is",)


def _odds(chances: Array) -> list[float]:
    """ln of the odds of the first against each other explanation."""
    return [float(np.log(max(chances[0], 1e-12) / max(c, 1e-12))) for c in chances[1:]]


def _weighed(contrasts: Sequence[Contrast], chances: Array) -> tuple[float, float]:
    """Probability of a decision, and expected ln of the Bayes factor, averaged over the rivals of the first."""
    if not contrasts:
        return 0.0, 0.0
    weights = chances[1:] / np.sum(chances[1:])
    return (float(weights @ [c.separation.decides for c in contrasts]),
            float(weights @ [c.separation.log_bayes_factor for c in contrasts]))  # fmt: skip


def _tried(driven: Rig, bench: Bench, chances: Array) -> list[_Tried]:
    """One programme of each family; of the best, if none decides, longer ones, repeated ones, and half the load."""
    planner = Planner(driven, bench)
    found: list[_Tried] = []
    for shape in shapes(driven.duration, driven.columns, planner.levels()):
        found += _one(planner, shape, None, chances)
    if not found or max(t.decides for t in found) >= ENOUGH:
        return found
    first = sorted(found, key=lambda t: -t.gain)
    for one in first[:_LONGER]:
        found += _one(planner, stretched(one.shape, 3.0 * driven.duration), None, chances)
    shortest = next(t.shape for t in first if t.shape.duration <= driven.duration)
    found += _one(planner, again(shortest, 3), None, chances)
    if driven.load is not None:
        weight = float(np.max(np.asarray(bench.model.runs[0].translation.parameters.base["load"])))
        best = max(found, key=lambda t: t.gain)
        found += _one(planner, best.shape, 0.5 * weight, chances)
    return found


def _one(planner: Planner, shape: Shape, load: float | None, chances: Array) -> list[_Tried]:
    made = planner.conditions(shape, load)
    if made is None:
        return []
    contrasts = planner.bench.contrasts(planner.bench.under(made[1]), _odds(chances))
    if not contrasts:
        return []
    decides, gain = _weighed(contrasts, chances)
    return [_Tried(shape, *made, contrasts, decides, gain)]


def _best(tried: Sequence[_Tried]) -> _Tried:
    enough = [t for t in tried if t.decides >= ENOUGH]
    if not enough:
        return max(tried, key=lambda t: t.gain)
    shortest = min(t.conditions.duration for t in enough)
    return max((t for t in enough if t.conditions.duration <= shortest), key=lambda t: t.gain)


def _statement(best: _Tried, again: float, explanations: Sequence[Explanation]) -> str:
    first, second = ("; ".join(_words(e)) for e in explanations[:2])
    load = "" if best.conditions.load is None else f", with half the load ({best.conditions.load / GRAVITY:.3g} kg)"
    more = f" (and {len(explanations) - 2} more)" if len(explanations) > 2 else ""
    kind = best.shape.kind[0].upper() + best.shape.kind[1:]
    return (
        f"{kind} for {best.conditions.duration:g} s{load} would decide between {first} and {second}{more} with odds of "
        f"20 to 1 in {100 * best.decides:.0f} % of cases, a repeat of the recordings in {100 * again:.0f} %."
    )
