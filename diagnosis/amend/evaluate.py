"""A diagnosis with its amended model, judged by free runs of the closed co-simulation on recordings held out."""

from __future__ import annotations

import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from cosim.compute.steps import counted
from cosim.run import RunStopped
from cosim.scenario import Scenario
from cosim.unit.protocol import Array
from diagnosis.amend.amend import AmendedModel, amend_like, write_amended
from diagnosis.amend.changes import CannotAmend, changes_of
from diagnosis.amend.free_run import free_run, free_run_of, start_of
from diagnosis.judge.diagnosis import Diagnosis
from diagnosis.judge.held_out import Predictions, channel_fits, differences, predictions
from diagnosis.judge.spread import spread_over_recordings
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.recording.recording import Recording
from diagnosis.search.cosim_model import BY_FREE_RUNS
from diagnosis.search.problem import Point


def evaluate_amended_model(
    diagnosis: Diagnosis,
    scenario: Scenario,
    models: tuple[DiagnosisModel, DiagnosisModel | None],
    points: tuple[Mapping[str, Point], Mapping[str, Point]],
    held_out: Sequence[Recording],
    folder: Path,
) -> Diagnosis:
    """Write the amended model, and take the fits of held-out recordings from free runs of it.

    Args:
        diagnosis: What was found, its held-out fits by the model that was fitted.
        scenario: What was diagnosed.
        models: Of the recordings that were fitted, and of those held out.
        points: Stage to point of each of the two models.
        held_out: Recordings that judge, in the order of their model.
        folder: Where the amended model goes.

    Returns:
        The diagnosis with the path of the amended model; where something of it cannot be written or run, with the
        reason in `held_out_by`.

    Raises:
        InputError: A folder cannot be written, or an FMU cannot be compiled.
        KeyboardInterrupt: The user stopped it.
    """
    begin = clock.perf_counter()
    found = _evaluate(diagnosis, scenario, models, points, held_out, folder)
    return replace(found, seconds=found.seconds + clock.perf_counter() - begin)


def _evaluate(
    diagnosis: Diagnosis,
    scenario: Scenario,
    models: tuple[DiagnosisModel, DiagnosisModel | None],
    points: tuple[Mapping[str, Point], Mapping[str, Point]],
    held_out: Sequence[Recording],
    folder: Path,
) -> Diagnosis:
    training, judge = models
    network, fitted = training.coil_network, _innermost(training, points[0])
    if network is None:
        by = "" if judge is None else judge.judged_by(points[1]["after"])
        return _by_itself(diagnosis, scenario, training, points[0]["after"], folder, by)
    by = network.judged_by(fitted["after"])
    try:
        amended = _amended(scenario, network, fitted, folder)
    except CannotAmend as reason:
        return replace(diagnosis, held_out_by=f"{by}; there is no amended scenario: {reason}")
    diagnosis = replace(diagnosis, amended_model=str(amended["after"].path))
    if judge is None:
        return replace(diagnosis, held_out_by="")
    fast = predictions(judge, points[1])
    try:
        free = _free(judge, points[1], fast, scenario, amended, held_out)
    except RunStopped as stopped:
        if stopped.is_interrupt:
            raise KeyboardInterrupt from stopped
        return replace(diagnosis, held_out_by=f"{by}; the free run stopped: {stopped.reason}")
    fits = [f for f in diagnosis.fit if not f.is_held_out]
    fits += channel_fits(judge, held_out, points[1], is_held_out=True, predicted=free)
    return replace(
        diagnosis,
        fit=tuple(fits),
        spread=spread_over_recordings(fits),
        held_out_by=BY_FREE_RUNS,
        differences=differences(judge, held_out, fast, free),
    )


def _by_itself(
    diagnosis: Diagnosis, scenario: Scenario, model: DiagnosisModel, point: Point, folder: Path, by: str
) -> Diagnosis:
    """The diagnosis with the scenario that a model amends itself, its held-out fits as they are."""
    try:
        path = model.amend(scenario, point, folder)
    except CannotAmend as reason:
        by = "; ".join(filter(None, (by, f"there is no amended scenario: {reason}")))
        return replace(diagnosis, held_out_by=by)
    if path is None:
        return replace(diagnosis, held_out_by=f"{model.judged_by(point)}; it has no amended scenario")
    return replace(diagnosis, amended_model=str(path), held_out_by=by)


def _innermost(model: DiagnosisModel, points: Mapping[str, Point]) -> dict[str, Point]:
    """Points by stage, as the model that simulates knows them."""
    return {stage: model.innermost_point(point) for stage, point in points.items()}


def _amended(
    scenario: Scenario, model: CoilNetworkModel, points: Mapping[str, Point], folder: Path
) -> dict[str, AmendedModel]:
    """`after`, and `recalibrated` in a folder beside it with the same FMUs, their terms switched off."""
    after = write_amended(scenario, changes_of(scenario, model, points["after"]), folder)
    changes = changes_of(scenario, model, points["recalibrated"])
    return {"after": after, "recalibrated": amend_like(after, changes, folder.parent / f"{folder.name}_without_terms")}


def _free(
    judge: DiagnosisModel,
    points: Mapping[str, Point],
    fast: Predictions,
    scenario: Scenario,
    amended: Mapping[str, AmendedModel],
    held_out: Sequence[Recording],
) -> dict[str, list[list[Array]]]:
    """Predictions of free runs, with what wrapped models add to their sensors.

    They begin as the judge's point says, be it estimated from a first stretch (`beginning`) or known of the same day.
    """
    network, own = judge.coil_network, _innermost(judge, points)
    assert network is not None, "training and judge are of the same kind"
    simulated = predictions(network, own)
    found: dict[str, list[list[Array]]] = {stage: [] for stage in points}
    order = [(stage, n, recording) for stage in points for n, recording in enumerate(held_out)]
    for stage, n, recording in counted(order, "recordings that judge simulated freely"):
        run, start = network.runs[n], start_of(network.network_parameters(own[stage], n))
        if stage in amended:
            values = free_run(amended[stage], recording, run.times, start)
        else:
            values = free_run_of(scenario, recording, run.times, start)
        channels = [values[s.quantity][s.samples, s.element] for s in run.series]
        added = [np.asarray(f - s) for f, s in zip(fast[stage][n], simulated[stage][n])]
        found[stage].append([c + a for c, a in zip(channels, added)])
    return found
