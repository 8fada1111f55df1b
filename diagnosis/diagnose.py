"""`cosim diagnose`: recordings and a scenario in, a diagnosis out."""

from __future__ import annotations

import functools
import time as clock
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from cosim.compute.batch import Batches
from cosim.compute.steps import TimeIsOver, is_limited, may_be_left, was_left, without_usual_time
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.candidates.registry import catalogue
from diagnosis.check.beside import Compared, compare
from diagnosis.check.check import doubts_of
from diagnosis.check.ends import with_ends
from diagnosis.check.input_rows import with_input_rows, with_instants
from diagnosis.check.odd_one_out import ALL_CHANNELS
from diagnosis.clocks import clocks_once_recalibrated
from diagnosis.faults.model import with_faults
from diagnosis.further import Further, further
from diagnosis.judge.acceptance import Accepted, accept
from diagnosis.judge.adequacy import adequacy, moved_day, with_day, with_solving
from diagnosis.judge.diagnosis import ChannelFit, Diagnosis, Doubt, Searched, Verdict
from diagnosis.judge.doubts import (
    ODD,
    doubted,
    of_another_experiment,
    without_explained_starts,
    without_what_fits,
)
from diagnosis.judge.findings import findings
from diagnosis.judge.form import companions, share_at_place
from diagnosis.judge.gain import is_better
from diagnosis.judge.headline import headline, notes
from diagnosis.judge.held_out import carried_over, channel_fits
from diagnosis.judge.initial_state import begun
from diagnosis.judge.isolability import Isolability
from diagnosis.judge.of_a_day import is_shown_there_alone
from diagnosis.judge.opposing import opposed
from diagnosis.judge.recalibration import recalibration
from diagnosis.judge.recordings import used
from diagnosis.judge.remainder import remainders
from diagnosis.judge.searched import searched
from diagnosis.judge.spread import spread_over_recordings
from diagnosis.judge.trust import is_settled
from diagnosis.judge.unfitted import (
    HeldOutReadings,
    Readings,
    can_be_moved,
    left_out_readings,
    left_out_stretches,
    with_rows_estimated,
)
from diagnosis.judge.verdict import evident, verdict, why_open
from diagnosis.judge.within_rows import within_rows
from diagnosis.locate.locate import Located
from diagnosis.model_error import search_with_model_error
from diagnosis.models.build import models_of, uses_batches, with_rig_faults, with_switch_times
from diagnosis.models.cosimulation.unit_laws import identifiers
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.wrappers.biased import with_biases
from diagnosis.recording.labels import distinct
from diagnosis.recording.recording import Recording
from diagnosis.refitted import Refitted
from diagnosis.report.user_units import written_units
from diagnosis.search.problem import Point, Term
from diagnosis.search.search import Outcome, Settings
from diagnosis.search.shares import titled
from diagnosis.search.structure import structure
from diagnosis.standing_out import apart_once_refitted
from diagnosis.ways import other_ways

#: Laws with a name that are fitted all the same where none of the best-scored terms leaves noise: of most systems all.
TRIALS = 24


#: What was not tried where the time was over.
_TIME_IS_OVER = (
    "stopped by `--stop-after` (10 min where nothing is said), Ctrl-C or SIGTERM: no further effect or other "
    "description was looked for; `--stop-after never` takes the time that it needs"
)
_STOPPED = f"{_TIME_IS_OVER[0].upper()}{_TIME_IS_OVER[1:]}."


@dataclass(frozen=True)
class Options:
    """What a diagnosis works with.

    Args:
        without: Identifiers of candidates that it must not know, for a proof that hides them.
        threads: Threads of one simulation.
        batches: Makes simulations that take seconds: in processes, kept on disk; closed by whoever made it.
        is_brief: Verdict, findings and fit alone.
        limits: Greatest values in a next experiment, `component.output` to a number in the unit of that output.
        is_checked: Whether recordings that seem to be of another experiment than the scenario are not searched.
    """

    without: tuple[str, ...] = ()
    threads: int = 2
    limits: Mapping[str, float] = field(default_factory=dict)
    batches: Batches = field(default_factory=Batches)
    is_brief: bool = False
    is_checked: bool = True

    def catalogue(self) -> tuple[CandidateTerm, ...]:
        """Candidates that it knows.

        Raises:
            InputError: There is no candidate of a name that is to be left out.
        """
        unknown = sorted(set(self.without) - {c.identifier for c in catalogue()} - identifiers())
        if unknown:
            raise InputError(
                "--without",
                "",
                f"the catalogue has no effect `{unknown[0]}`",
                "docs/candidates.md lists their identifiers",
            )
        return tuple(c for c in catalogue() if c.identifier not in self.without)


@dataclass(frozen=True)
class Result:
    """A diagnosis with what figures of it need.

    Args:
        diagnosis: The answer.
        training: Model of the recordings that were fitted.
        judge: Model of those held out, or None.
        points: `before`, `recalibrated`, `after` to the values of the training model.
        held_out_points: The same for the judge.
    """

    diagnosis: Diagnosis
    training: DiagnosisModel
    judge: DiagnosisModel | None
    points: Mapping[str, Point]
    held_out_points: Mapping[str, Point]


def diagnose(
    scenario: Scenario,
    training: Sequence[Recording],
    held_out: Sequence[Recording],
    settings: Settings,
    on_progress: Callable[[str], None] = lambda text: None,
    options: Options = Options(),
) -> Result:
    """Find out what a scenario leaves out.

    Args:
        scenario: The model as it is.
        training: Recordings that are fitted.
        held_out: Recordings that judge; nothing is fitted to them. Where there are none, stretches of the training that
            were left out of fits judge.
        settings: Of the search.
        on_progress: Told what is being done.
        options: What it works with.

    Raises:
        InputError: A recording does not fit the scenario, or the scenario is none that can be diagnosed.
    """
    begin = clock.perf_counter()
    known = options.catalogue()
    on_progress("checking that recordings and scenario are of the same experiment")
    compared = [compare(scenario, recording) for recording in distinct([*training, *held_out])]
    seen = doubts_of(compared)
    both = [with_ends(one.recording, seen) for one in compared]
    training, held_out = both[: len(training)], both[len(training) :]
    model, judge = models_of(scenario, training, held_out, known, options.threads, options.without, options.batches)
    _refuse_what_does_not_serve(uses_batches(model), options)
    doubts = _doubts(seen, compared, model, judge, options)
    if options.is_checked and of_another_experiment(doubts):
        seconds = clock.perf_counter() - begin
        return _unsearched(scenario, (model, training), (judge, held_out), doubts, settings, seconds)
    model = with_rig_faults(model, training, {d.recording for d in doubts if d.kind == ODD})
    given, judge_before = model, judge
    outcome, model, judge = _searched(given, judge, settings, on_progress)
    acting = outcome.best.fit.point.terms  # without any it was asked when the model was made
    moved = with_switch_times(given, judge_before, acting) if acting or not outcome.left.is_noise else None
    if moved is not None:
        with suppress(TimeIsOver), may_be_left():
            on_progress("searching again: inputs changed between rows of their tables")
            outcome, model, judge = _searched(moved[0], moved[1], settings, on_progress)
            given = moved[0]
    on_progress("judging by readings that it was not fitted to")
    accepted, readings = _accepted(model, judge, outcome, training, held_out, on_progress)
    if judge is not None and not is_settled(accepted) and given.can_be_searched_again:
        both_models = with_faults(with_biases(given)), judge
        outcome, model, accepted = _by_other_ways(
            both_models, (outcome, model, accepted), (training, held_out), readings, settings, on_progress
        )
    if can_be_moved(model):
        on_progress("asking what speaks against the names of laws")
        accepted = _with_doubts_of_names(model, accepted)
    points = {
        "before": Point(np.zeros(len(model.parameters))),
        "recalibrated": outcome.base.point,
        "after": accepted.explanation.fit.point,
    }
    fits: list[ChannelFit] = channel_fits(model, training, points, is_held_out=False)
    carried: dict[str, Point] = {}
    if judge is not None:
        carried = {s: with_rows_estimated(judge, carried_over(p, model, judge)) for s, p in points.items()}
        judge, carried = begun(judge, model, carried, held_out)
        fits += channel_fits(judge, held_out, carried, is_held_out=True)
    units = written_units(both)
    titles = [r.title for r in training]
    found = doubted(findings(model, outcome, accepted, titles, units, judge), doubts)
    found = within_rows(found, scenario, training)
    doubts = without_what_fits(without_explained_starts(doubts, found), fits, found)
    tried = searched(model, scenario, options.without, outcome.base.point)
    if was_left():
        tried = replace(tried, untried=(*tried.untried, _TIME_IS_OVER))
    day = () if judge is None else moved_day(accepted.after, judge.parameters, [r.title for r in held_out])
    right = with_day(adequacy(accepted, readings, day, bool(model.parameters), model.has_scatter), fits)
    right = with_solving(right, lambda: model.solving_error(accepted.explanation.fit.point))
    estimated = with_instants(model.parameters, titles)
    estimated |= with_instants(() if judge is None else judge.parameters, [r.title for r in held_out])
    right = with_input_rows(right, scenario, both, estimated)
    found = evident(found, right, outcome.margin)
    word = verdict(outcome, found, right, tried, recalibration(model, outcome.base, titles), doubts)
    reasons = why_open(outcome, found, right, tried, doubts, [titled(p, titles) for p in model.parameters])
    more = Further(Isolability(), Located(()), None)
    if not options.is_brief:
        more = further(scenario, model, training, (outcome, accepted), settings.seed, options.limits, on_progress)
    of_end = (*more.notes, *((_STOPPED,) if was_left() else ()))
    first, left = (model.plain.residuals([p])[0] for p in (outcome.base.point, accepted.explanation.fit.point))
    diagnosis = Diagnosis(
        verdict=word,
        statement=headline(word, found, right, reasons, doubts, units),
        notes=(*notes(word, found, right, reasons, doubts, units), *of_end),
        findings=found,
        fit=tuple(fits),
        margin=outcome.margin,
        nulls=outcome.nulls,
        false_alarm_rate=outcome.false_alarm_rate,
        structure_before=structure(first, model.layout, model.groups()).z,
        structure_after=structure(left, model.layout, model.groups()).z,
        recalibration=recalibration(model, accepted.explanation.fit, titles),
        isolability=more.told_apart,
        amended_model=None,
        seconds=clock.perf_counter() - begin,
        simulations=model.simulations,
        seed=settings.seed,
        locations=more.located.locations,
        waveforms=more.located.waveforms,
        proposals=more.located.proposals,
        scenario=str(scenario.path or scenario.title),
        recordings=used(training, held_out),
        spread=spread_over_recordings(fits),
        left=remainders(left, model.layout, model.groups(), [s.channel for run in model.runs for s in run.series]),
        next_experiment=more.experiment,
        adequacy=right,
        searched=tried,
        doubts=doubts,
        units=units.written,
        channel_units=dict(units.channels),
    )
    return Result(diagnosis, model, judge, points, carried)


def _refuse_what_does_not_serve(has_batches: bool, options: Options) -> None:
    """Refuse a cluster or a time that would do nothing for such a model.

    Args:
        has_batches: Whether the co-simulation itself makes its runs, in batches.
        options: What it works with.
    """
    if not has_batches and not options.batches.place.is_local:
        what = "compiled code simulates this scenario on this machine: a cluster has nothing to do"
        raise InputError("--cluster", "", what, "leave `--cluster` out; `--jobs` says how many cores are used")
    if has_batches and is_limited():
        what = "runs of the co-simulation are interrupted by Ctrl-C, and kept"
        raise InputError("--stop-after", "", what, "leave it out; `--resume` goes on from the runs that were made")
    if has_batches:
        without_usual_time()


def _by_other_ways(
    models: tuple[DiagnosisModel, DiagnosisModel],
    found: tuple[Outcome, DiagnosisModel, Accepted],
    recordings: tuple[Sequence[Recording], Sequence[Recording]],
    readings: Readings,
    settings: Settings,
    on_progress: Callable[[str], None],
) -> tuple[Outcome, DiagnosisModel, Accepted]:
    """What was found, or what another way found that predicts better; see `diagnosis.ways`.

    Not what predicts worse than the search's own explanation with a fault of one recording that was not accepted: it is
    no law that others show, and yet what keeps laws from taking its place.

    Args:
        models: Of the training recordings as it was searched, and the one that judges.
        found: Outcome, the model that it belongs to, and what of it is accepted.
        recordings: Of the training, and held out.
        readings: That judged.
        settings: Of the search.
        on_progress: Told what is being done.
    """
    (given, judge), (training, held_out), first = models, recordings, found[2]
    has_fault = any(t.recording is not None for t in first.reasons)
    with suppress(TimeIsOver), may_be_left():
        for other, own in other_ways(given, found[0], settings, on_progress):
            again, _ = _accepted(own, judge, other, training, held_out, on_progress)
            is_stopgap = has_fault and is_better(again.after, first.suggested, readings)
            if again.explanation.terms and is_better(found[2].after, again.after, readings) and not is_stopgap:
                found = other, own, again
            if not again.agreement.is_rejected and other.left.is_noise:
                break
    return found


def _doubts(
    found: tuple[Doubt, ...],
    compared: Sequence[Compared],
    model: DiagnosisModel,
    judge: DiagnosisModel | None,
    options: Options,
) -> tuple[Doubt, ...]:
    """Doubts beside the scenario as it is; about clocks, and recordings that stand out, beside it once recalibrated."""
    if not options.is_checked or of_another_experiment(found):
        return found
    refitted = Refitted(model, judge, compared)
    again = clocks_once_recalibrated(refitted)
    told = {d.recording for d in (*found, *again) if d.is_serious or (d.kind == ODD and not _is_open(d))}
    left_open = {d.recording for d in found if _is_open(d)}
    apart = [d for d in apart_once_refitted(refitted, told) if not _is_open(d) or d.recording not in left_open]
    again += apart
    known, answered = {(d.recording, d.subject, d.kind) for d in again}, {d.recording for d in apart}
    left = [d for d in found if (d.recording, d.subject, d.kind) not in known]
    return (*again, *(d for d in left if not _is_open(d) or d.recording not in answered))


def _is_open(doubt: Doubt) -> bool:
    """Whether a doubt says that a recording stands out, and not what of it is off."""
    return doubt.kind == ODD and doubt.subject == ALL_CHANNELS


def _unsearched(
    scenario: Scenario,
    fitted: tuple[DiagnosisModel, Sequence[Recording]],
    judged: tuple[DiagnosisModel | None, Sequence[Recording]],
    doubts: tuple[Doubt, ...],
    settings: Settings,
    seconds: float,
) -> Result:
    """The answer where recordings and scenario are not of the same experiment: nothing is fitted."""
    (model, training), (judge, held_out) = fitted, judged
    points = dict.fromkeys(("before", "recalibrated", "after"), Point(np.zeros(len(model.parameters))))
    units = written_units((*training, *held_out))
    fits = channel_fits(model, training, points, is_held_out=False)
    carried: dict[str, Point] = {}
    if judge is not None:
        carried = dict.fromkeys(points, Point(np.zeros(len(judge.parameters))))
        fits += channel_fits(judge, held_out, carried, is_held_out=True)
    diagnosis = Diagnosis(
        verdict=Verdict.RECORDING_FAULT,
        statement=headline(Verdict.RECORDING_FAULT, (), None, doubts=doubts),
        findings=(),
        fit=tuple(fits),
        margin=settings.floor,
        false_alarm_rate=1.0,
        structure_before=float("nan"),
        structure_after=float("nan"),
        recalibration=(),
        isolability=Isolability(),
        amended_model=None,
        seconds=seconds,
        simulations=model.simulations,
        seed=settings.seed,
        scenario=str(scenario.path or scenario.title),
        recordings=used(training, held_out),
        spread=spread_over_recordings(fits),
        searched=Searched(untried=("nothing was searched: the recordings come first",)),
        doubts=doubts,
        units=units.written,
        channel_units=dict(units.channels),
    )
    return Result(diagnosis, model, judge, points, carried)


def _searched(
    model: DiagnosisModel, judge: DiagnosisModel | None, settings: Settings, on_progress: Callable[[str], None]
) -> tuple[Outcome, DiagnosisModel, DiagnosisModel | None]:
    """Outcome of the search, the model that it belongs to, and the model that judges."""
    own = model.own_search(settings, on_progress)
    if own is not None:
        if judge is not None:
            judge.take_scatter(model.scatter())
        return own, model, judge
    if model.can_be_searched_again and not model.is_fast:
        settings = replace(settings, trials=TRIALS)
    outcome, found = search_with_model_error(with_faults(with_biases(model)), settings, on_progress)
    return outcome, found, with_biases(judge) if judge is not None else None


def _accepted(
    model: DiagnosisModel,
    judge: DiagnosisModel | None,
    outcome: Outcome,
    training: Sequence[Recording],
    held_out: Sequence[Recording],
    on_progress: Callable[[str], None],
) -> tuple[Accepted, Readings]:
    """What of a search is accepted, and the readings that judged."""
    titles = [r.title for r in training]
    fitted = left_out_stretches(model, titles, on_progress)
    unfitted = fitted if judge is None else HeldOutReadings(judge, model, held_out)
    known = {t: v for e in (*outcome.rivals, outcome.best) for t, v in e.fit.point.terms.items()}

    @functools.cache
    def is_local(term: Term) -> bool:
        return is_shown_there_alone(term, known[term], model, judge)

    accepted = accept(
        model,
        outcome,
        unfitted,
        fitted,
        is_local,
        lambda: left_out_readings(model, titles),
        judge is None or judge.can_be_fitted,
        on_progress,
    )
    return accepted, unfitted.readings


def _with_doubts_of_names(model: DiagnosisModel, accepted: Accepted) -> Accepted:
    """The same with what speaks against the names of accepted laws: others that cancel them, or that have their form.

    Of the form is asked where readings reject the model: else nothing is left that has one.
    """
    fit = accepted.explanation.fit
    laws = [t for t in fit.point.terms if t.is_named and t.unit != "measurement" and t.recording is None]
    has_rest = accepted.agreement.is_rejected and not accepted.agreement.is_irregular
    forms = {t: share_at_place(model, fit, companions(model, t)) for t in laws} if has_rest else {}
    return replace(accepted, forms=forms, opposed=opposed(model, fit.point, laws))
