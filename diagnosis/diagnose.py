"""`cosim diagnose`: recordings and a scenario in, a diagnosis out."""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from cosim.errors import InputError
from cosim.scenario import Scenario
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.candidates.registry import catalogue
from diagnosis.compute.batch import Batches
from diagnosis.experiment.design import next_experiment
from diagnosis.fabric.model import FabricModel
from diagnosis.fabric.search import search_fabric
from diagnosis.faults.model import with_faults
from diagnosis.isolability.isolability import isolability
from diagnosis.judge.beginning import begun
from diagnosis.judge.confirmed import confirmed
from diagnosis.judge.diagnosis import ChannelFit, Diagnosis, Verdict
from diagnosis.judge.held_out import carried_over, channel_fits
from diagnosis.judge.isolability import Isolability
from diagnosis.judge.judge import findings, nominal_cost, recalibration, verdict
from diagnosis.judge.own_numbers import foretold
from diagnosis.judge.recordings import used
from diagnosis.judge.remainder import remainders
from diagnosis.judge.spread import spread_over_recordings
from diagnosis.locate.locate import Located, locate
from diagnosis.model_error import search_with_model_error
from diagnosis.recording.recording import Recording
from diagnosis.search.problem import Point
from diagnosis.search.search import Settings
from diagnosis.simulator.bank_model import BankModel
from diagnosis.simulator.biased import with_biases
from diagnosis.simulator.models import DiagnosisModel, model_of
from diagnosis.simulator.unit_laws import identifiers


@dataclass(frozen=True)
class Means:
    """What a diagnosis works with.

    Args:
        without: Identifiers of candidates that it must not know, for a proof that hides them.
        threads: Threads of one simulation.
        batches: Makes simulations that take seconds: in processes, kept on disk; closed by whoever made it.
        is_brief: Verdict, findings and fit alone.
        limits: Greatest values in a next experiment, `component.output` to a number in the unit of that output.
    """

    without: tuple[str, ...] = ()
    threads: int = 2
    limits: Mapping[str, float] = field(default_factory=dict)
    batches: Batches = field(default_factory=Batches)
    is_brief: bool = False

    def catalogue(self) -> tuple[CandidateTerm, ...]:
        """Candidates that it knows.

        Raises:
            InputError: There is no candidate of a name that is to be left out.
        """
        unknown = sorted(set(self.without) - {c.identifier for c in catalogue()} - identifiers())
        if unknown:
            raise InputError("--without", "", f"the catalogue has no effect `{unknown[0]}`",
                             "docs/candidates.md lists their identifiers")  # fmt: skip
        return tuple(c for c in catalogue() if c.identifier not in self.without)


@dataclass(frozen=True)
class Found:
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

    def foretell(self) -> dict[str, float]:
        """See `diagnosis.judge.own_numbers.foretold`."""
        assert self.judge is not None  # who asks has compared with held-out recordings
        points = {stage: self.held_out_points[stage] for stage in ("recalibrated", "after")}
        return foretold(self.judge, self.training, points)


def diagnose(
    scenario: Scenario, training: Sequence[Recording], held_out: Sequence[Recording], settings: Settings,
    on_progress: Callable[[str], None] = lambda text: None, means: Means = Means(),
) -> Found:  # fmt: skip
    """Find out what a scenario leaves out.

    Args:
        scenario: The model as it is.
        training: Recordings that are fitted.
        held_out: Recordings that judge; nothing is fitted to them.
        settings: Of the search.
        on_progress: Told what is being done.
        means: What it works with.

    Raises:
        InputError: A recording does not fit the scenario, or the scenario is none that can be diagnosed.
    """
    begin = clock.perf_counter()
    known = means.catalogue()
    model = model_of(scenario, training, known, means.threads, means.without, means.batches)
    judge = model_of(scenario, held_out, known, means.threads, means.without, means.batches) if held_out else None
    is_fast = isinstance(model, BankModel)
    if isinstance(model, FabricModel):
        outcome = search_fabric(model, settings, on_progress)
        if isinstance(judge, FabricModel):
            judge.take_scatter(model)
    else:
        outcome, model = search_with_model_error(with_faults(with_biases(model)), settings, on_progress)
        judge = with_biases(judge) if judge is not None else None
    word = verdict(outcome, nominal_cost(model))
    points = {
        "before": Point(np.zeros(len(model.parameters))),
        "recalibrated": outcome.base.point,
        "after": outcome.best.fit.point,
    }
    on_progress("judging by the recordings held out")
    fits: list[ChannelFit] = channel_fits(model, training, points, is_held_out=False)
    carried: dict[str, Point] = {}
    if judge is not None:
        carried = {stage: carried_over(point, model, judge) for stage, point in points.items()}
        judge, carried = begun(judge, model, carried, held_out)
        fits += channel_fits(judge, held_out, carried, is_held_out=True)
    found = findings(model, outcome)
    told_apart, located, experiment = Isolability(), Located(()), None
    if not means.is_brief:
        told_apart = isolability(model, outcome.base, model.terms())
        on_progress("driving each unit alone")
        located = locate(model, outcome.base, [r.title for r in training], settings.seed)
        on_progress("designing the next experiment")
        experiment = next_experiment(scenario, model, training, outcome, means.limits)
    diagnosis = Diagnosis(
        verdict=word,
        statement=_statement(word, found),
        findings=found,
        fit=tuple(fits),
        margin=outcome.margin,
        nulls=outcome.nulls,
        false_alarm_rate=outcome.false_alarm_rate,
        structure_before=outcome.base_structure.z,
        structure_after=outcome.left.z,
        recalibration=recalibration(model, outcome.best.fit),
        isolability=told_apart,
        amended_model=None,
        seconds=clock.perf_counter() - begin,
        simulations=model.simulations,
        seed=settings.seed,
        locations=located.locations,
        waveforms=located.waveforms,
        proposals=located.proposals,
        scenario=str(scenario.path or scenario.title),
        recordings=used(training, held_out),
        spread=spread_over_recordings(fits),
        left=remainders(outcome.best.fit.residuals, model.layout, model.groups()),
        next_experiment=experiment,
    )
    answer = Found(diagnosis, model, judge, points, carried)
    if is_fast and judge is not None and not means.is_brief:
        diagnosis = replace(diagnosis, foretold=answer.foretell())
    return replace(answer, diagnosis=confirmed(diagnosis, answer.foretell))


def _statement(word: Verdict, found: Sequence[object]) -> str:
    effects = "; ".join(getattr(f, "statement", "") for f in found)
    return {
        Verdict.CONSISTENT: "The model as it is agrees with the recordings within the noise of the sensors.",
        Verdict.RECALIBRATED: "The model agrees with the recordings once its own parameters are recalibrated.",
        Verdict.RECORDING_FAULT: "The recording and the scenario are not of the same experiment.",
        Verdict.MEASUREMENT_FAULT: f"The measurement, or what is recorded of an input, is at fault: {effects}.",
        Verdict.MISSING_PHYSICS: f"The model leaves out: {effects}.",
        Verdict.UNNAMED_PHYSICS: f"The model leaves out something that the catalogue has no name for: {effects}.",
        Verdict.CANNOT_TELL: "Something is left that no effect of the catalogue explains.",
    }[word]
