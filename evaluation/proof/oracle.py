"""The model that knows the effects, and the noise that nothing can explain."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import yaml

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.candidates.registry import catalogue
from diagnosis.judge.diagnosis import ChannelFit
from diagnosis.judge.held_out import carried_over, channel_fits
from diagnosis.models.build import models_of
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.coil_network.runs import deviation
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.recording.recording import Channel, Recording, load_recording
from diagnosis.search.fit import Fit, fit
from diagnosis.search.posterior import cost
from diagnosis.search.problem import Point, Term, TermParameter
from evaluation.proof.answer import Answer, Concealed
from evaluation.proof.ground import read_task
from evaluation.proof.place import Rig, found_place, read_rig, true_place

#: Starts that are fitted for some iterations, and those of them that are fitted to the end.
TRIED, FINISHED, TRIAL_ITERATIONS = 6, 2, 6


@dataclass(frozen=True)
class Data:
    """Models of a case's recordings.

    Args:
        case: Its folder.
        model: Of the training recordings.
        judge: Of those held out.
        training: Recordings that are fitted.
        held_out: Recordings that judge.
        rig: What it is made of.
    """

    case: Path
    model: CoilNetworkModel
    judge: CoilNetworkModel
    training: tuple[Recording, ...]
    held_out: tuple[Recording, ...]
    rig: Rig


def read_data(case: Path) -> Data:
    """Read a case with the whole catalogue, one thread.

    Raises:
        NoCoilNetwork: The scenario is none for a network.
    """
    task = read_task(case)
    scenario = load_scenario(case / "scenario.yaml")
    training = tuple(load_recording(case / n) for n in task.training)
    held_out = tuple(load_recording(case / n) for n in task.held_out)
    model = CoilNetworkModel(scenario, training, catalogue(), threads=1)
    judge = CoilNetworkModel(scenario, held_out, catalogue(), threads=1, timeline=model.timeline)
    return Data(case, model, judge, training, held_out, read_rig(case))


def oracle_fit(data: Data, answer: Answer, base: Fit) -> Fit | None:
    """Fit of everything with the true terms at the true places, from several starts; None where there are no such.

    Args:
        data: Models.
        answer: The truth; its values are one of the starts.
        base: Recalibrated model without terms.
    """
    if not all(e.is_in_catalogue for e in answer.effects):
        return None
    if not answer.effects:
        return base
    terms = [_term(data, e) for e in answer.effects]
    if any(t is None for t in terms):
        return None
    truths = [_on_joint_axis(e, data.model) for e in answer.effects]
    points = _starts([t for t in terms if t is not None], truths, base)
    costs = [_cost(data.model, p) for p in points]
    tried = [fit(data.model, points[i], iterations=TRIAL_ITERATIONS) for i in np.argsort(costs)[:TRIED]]
    best = sorted(tried, key=lambda f: f.cost)[:FINISHED]
    return min((fit(data.model, f.point, iterations=100) for f in best), key=lambda f: f.cost)


def _on_joint_axis(truth: Concealed, model: CoilNetworkModel) -> Concealed:
    """The truth with its instant on the axis on which a model lays its recordings end to end, if it does so."""
    timeline = model.timeline
    if truth.instant is None or not 1 <= truth.order <= len(timeline.seats):
        return truth
    seat = timeline.seats[truth.order - 1]
    return replace(truth, parameters={**truth.parameters, "instant": truth.instant - seat.begin + seat.position})


def _cost(model: CoilNetworkModel, point: Point) -> float:
    residuals = model.residuals([point])[0]
    return cost(residuals, point.base) if np.isfinite(residuals).all() else np.inf


def _term(data: Data, truth: Concealed) -> Term | None:
    wanted = true_place(truth, data.rig)
    same = [t for t in data.model.terms() if t.identifier == truth.effect]
    return next((t for t in same if found_place(t.place, data.rig) == wanted), None)


def _starts(terms: Sequence[Term], truths: Sequence[Concealed], base: Fit) -> list[Point]:
    """From the recalibrated and from the nominal point: the true values, and each of the strengths worth trying."""
    values = [_values(term, truth) for term, truth in zip(terms, truths)]
    points = []
    for z in (base.point.base, np.zeros_like(base.point.base)):
        for n in range(max(len(v) for v in values)):
            points.append(Point(z, {t: v[min(n, len(v) - 1)] for t, v in zip(terms, values)}))
    return points


def _values(term: Term, truth: Concealed) -> list[tuple[float, ...]]:
    strength, *others = term.parameters
    found = [tuple(_start(p, truth, p.starts[0]) for p in term.parameters)]
    for start in strength.starts[:4]:
        for last in (0, -1):
            found.append((start, *(_start(p, truth, p.starts[last]) for p in others)))
    return list(dict.fromkeys(found))


def _start(parameter: TermParameter, truth: Concealed, otherwise: float) -> float:
    value = truth.parameters[parameter.name] if parameter.name in truth.comparable else otherwise
    return float(np.clip(value, parameter.lower, parameter.upper))


def held_out_fits(data: Data, points: Mapping[str, Point]) -> list[ChannelFit]:
    """Fit of every held-out channel at points that were fitted to the training recordings."""
    carried = {stage: carried_over(p, data.model, data.judge) for stage, p in points.items()}
    return channel_fits(data.judge, data.held_out, carried, is_held_out=True)


def judging_samples(data: Data) -> dict[str, int]:
    """Number of samples that judge, by held-out channel."""
    counts: dict[str, int] = {}
    for run in data.judge.runs:
        for series in run.series:
            counts[series.channel.name] = counts.get(series.channel.name, 0) + int(np.sum(series.used))
    return counts


def read_judge(case: Path) -> DiagnosisModel:
    """The model that judges a case, of whatever kind: of its held-out recordings."""
    task = read_task(case)
    training, held_out = ([load_recording(case / n) for n in names] for names in (task.training, task.held_out))
    _, judge = models_of(load_scenario(case / "scenario.yaml"), training, held_out, catalogue(), threads=1)
    assert judge is not None, "the proving ground holds recordings out in every case"
    return judge


def about_truth(case: Path, judge: DiagnosisModel, clean: Mapping[str, Array]) -> dict[str, tuple[float, Channel, int]]:
    """Held-out readings about the truth: channel to the sum of squares [unit^2], the channel and its samples.

    Args:
        case: Its folder.
        judge: Model of its held-out recordings.
        clean: `<recording>/<quantity>/stamps` and `.../clean`, as the proving ground writes them.
    """
    found: dict[str, tuple[float, Channel, int]] = {}
    names = read_task(case).held_out
    for name, run in zip(names, judge.runs):
        given = yaml.safe_load((case / name / "recording.yaml").read_text())
        for series in run.series:
            entry = given["channels"][series.channel.name]
            table = entry.get("table", given.get("table", ""))
            header = (case / name / table).read_text().partition("\n")[0].split(",")[1:]
            kind = next(k for k in (Path(table).stem, entry["column"]) if f"{name}/{k}/stamps" in clean)
            stamps, values = (np.asarray(clean[f"{name}/{kind}/{what}"]) for what in ("stamps", "clean"))
            values = values.reshape(len(stamps), -1)
            times = series.channel.times[-len(series.samples) :]
            rows = np.abs(stamps[:, None] - times[None, :]).argmin(axis=0)
            truth = np.asarray(values[rows, header.index(entry["column"])], dtype=np.float64)
            noise = (series.channel.values[-len(series.samples) :] - truth)[series.used]
            total, _, count = found.get(series.channel.name, (0.0, series.channel, 0))
            found[series.channel.name] = (total + float(noise @ noise), series.channel, count + len(noise))
    return found


def floor(about: Mapping[str, tuple[float, Channel, int]]) -> float:
    """Chi-square per sample of readings about the truth."""
    scaled = sum(total / channel.deviation**2 for total, channel, _ in about.values())
    return scaled / sum(count for *_, count in about.values())


def noises(about: Mapping[str, tuple[float, Channel, int]]) -> dict[str, tuple[float, float]]:
    """Root mean square of the readings about the truth, and deviation of noise and rounding, by channel [unit]."""
    return {n: ((total / count) ** 0.5, deviation(channel)) for n, (total, channel, count) in about.items() if count}
