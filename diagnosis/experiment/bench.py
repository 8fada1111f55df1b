"""The model of the recordings under other programmes, read by the same sensors."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.experiment.separation import Bordered, Separation, distance, root, separation
from diagnosis.models.coil_network.kernel.inputs import Drive
from diagnosis.models.coil_network.kernel.network import CoilNetworkError
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.steps import USUAL
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.coil_network.runs import Run, deviation
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search.fit import Fit
from diagnosis.search.objective import STEP
from diagnosis.search.problem import Layout, Point, Term

#: Samples of a channel that a prediction uses; others count through the weight of these.
SAMPLES = 60
#: Step of the simulations [s]: its error is that of both explanations, and they are compared with each other. Where a
#: sensor is suspected, its delays are resolved as finely as in the fits.
COARSE = 0.2
#: Time after an edge within which every sample is used [s]: lags and clocks show there alone.
EDGE = 1.5
#: Edges up to which that is done: with more of them there are enough samples near edges anyway.
_EDGES = 12


@dataclass(frozen=True)
class Conditions:
    """What is done in an experiment.

    Args:
        drive: Programmes.
        duration: [s].
        load: Weight that hangs from each coil [N], or None for that of the scenario.
    """

    drive: Drive
    duration: float
    load: float | None = None


@dataclass(frozen=True)
class Contrast:
    """What an experiment does to two explanations.

    Args:
        separation: Predicted outcome.
        channel: Where they differ most.
        time: When [s].
    """

    separation: Separation
    channel: str
    time: float


@dataclass(frozen=True)
class Belief:
    """What is known of an explanation after the recordings.

    Args:
        point: Values of the coil network's parameters and of the terms.
        covariance: Of these, shape (parameters + term parameters,) twice.
    """

    point: Point
    covariance: Array

    @staticmethod
    def of(fit: Fit, parameters: int) -> Belief:
        """From a fit; parameters beyond the first so many (zeros of sensors) are left out, as uncertain as they are.

        Faults of one recording are left out too: another experiment does not have them.

        Args:
            fit: Of the recordings.
            parameters: Of the coil network.
        """
        lasts = [t.recording is None for t in fit.point.terms for _ in t.parameters]
        kept = np.r_[0:parameters, len(fit.point.base) + np.flatnonzero(lasts)]
        return Belief(Point(fit.point.base[:parameters], fit.point.lasting.terms), fit.covariance[np.ix_(kept, kept)])


class Bench:
    """Simulates explanations under conditions that nobody has tried yet.

    Args:
        model: Model of the recordings.
        recordings: These, in order.
        beliefs: Explanations, the most probable first.
        inflation: Of the variance, of every channel of every recording in order, where no model meets the noise.
    """

    def __init__(
        self,
        model: CoilNetworkModel,
        recordings: Sequence[Recording],
        beliefs: Sequence[Belief],
        inflation: Array | None = None,
    ) -> None:
        self.model, self.recordings, self.beliefs = model, recordings, beliefs
        counts = np.cumsum([len(r.series) for r in model.runs])
        every = np.ones(int(counts[-1])) if inflation is None else inflation
        self._inflation = np.split(every, counts[:-1])
        self._daily = np.array([p.own is not None for p in model.parameters])
        self._points = [self._restarted(b.point) for b in beliefs]
        has_sensor = any(t.unit == "measurement" for b in beliefs for t in b.point.terms)
        finest = float(min(np.max(np.diff(run.inputs.time)) for run in model.runs))
        coarse = finest if finest > USUAL else COARSE  # a slow rig, for which the recordings have longer steps
        self._step = min(coarse, finest) if has_sensor else coarse
        self._roots = [root(self._spread(b)) for b in beliefs]

    def repeat(self) -> CoilNetworkModel:
        """The model of one more set of the same recordings."""
        return self._with(
            [
                self._run(n, Conditions(r.translation.drive, float(r.inputs.time[-1] - r.inputs.time[0])))
                for n, r in enumerate(self.model.runs)
            ]
        )

    def under(self, conditions: Conditions) -> CoilNetworkModel:
        """The model of an experiment."""
        return self._with([self._run(0, conditions)])

    def temperatures(self, conditions: Conditions, count: int = 200) -> Array:
        """Of every coil by the most probable explanation [K], shape (count, coils); at equal distances of time.

        Infinite where the explanation runs away: what was fitted to some temperatures need not hold at higher ones.
        """
        run = self._run(0, conditions)
        times = np.linspace(run.inputs.time[0], run.inputs.time[-1], count)
        parameters = self._with([run]).network_parameters(self._points[0], 0)
        try:
            found = self.model.network.simulate(parameters, run.inputs, {"temperature": times})
        except CoilNetworkError:
            return np.full((count, self.model.coils.coils), np.inf)
        return np.asarray(found["temperature"])

    def contrasts(self, experiment: CoilNetworkModel, log_odds: Sequence[float]) -> list[Contrast]:
        """What an experiment does to the first explanation and each other one.

        Args:
            experiment: From `under` or `repeat`.
            log_odds: ln of the odds of the first against each of the others, before the experiment.
        """
        values = experiment.residuals(self._points)
        if not np.isfinite(values).all():
            return []
        base = experiment.base_jacobian(self._points[0])
        inner = base.T @ base
        bordered = [Bordered(base, inner, _term_slopes(experiment, p, v)) for p, v in zip(self._points, values)]
        found = []
        for other in range(1, len(self.beliefs)):
            difference = values[0] - values[other]
            first = distance(difference, bordered[other], self._roots[other])
            second = distance(difference, bordered[0], self._roots[0])
            found.append(self._contrast(experiment, difference, separation(first, second, log_odds[other - 1])))
        return found

    @staticmethod
    def _contrast(experiment: CoilNetworkModel, difference: Array, parted: Separation) -> Contrast:
        layout = experiment.layout
        strength = np.bincount(layout.channel, difference**2, minlength=len(layout.names))
        best = int(np.argmax(strength))
        own = layout.channel == best
        moment = float(layout.time[own][np.argmax(np.abs(difference[own]))])
        return Contrast(parted, layout.names[best], moment)

    def _run(self, number: int, conditions: Conditions) -> Run:
        """A run with other inputs, and samples that stand for all that the sensors would take."""
        like, recording = self.model.runs[number], self.recordings[number]
        translation = like.translation
        base = dict(translation.parameters.base)
        if conditions.load is not None:
            base["load"] = conditions.load
        moved = replace(
            translation, drive=conditions.drive, parameters=CoilNetworkParameters(base, translation.parameters.terms)
        )
        start, stop = translation.start, translation.start + conditions.duration
        corners = np.array(conditions.drive.switches())
        channels, weights = {}, []
        for series, inflation in zip(like.series, self._inflation[number]):
            channel, weight = _sampled(series.channel, (start, stop), corners)
            channels[channel.name] = channel
            weights.append(weight / np.sqrt(inflation))
        run = Run(moved, replace(recording, channels=channels, end=stop), self.model.network, self._step)
        run.weight = run.weight * np.concatenate(weights)
        return run

    def _with(self, runs: list[Run]) -> CoilNetworkModel:
        """A model of other runs; candidates, parameters and the compiled network are shared."""
        other = copy.copy(self.model)
        other.runs = runs
        other.seats = (self.model.timeline.afterwards,) * len(runs)
        series = [s for run in runs for s in run.series]
        channel = np.concatenate([np.full(len(s.samples), n) for n, s in enumerate(series)])
        time = np.concatenate([s.times for s in series])
        other.layout = Layout(channel, time, tuple(s.channel.name for s in series), ("",) * len(series))
        return other

    def _restarted(self, point: Point) -> Point:
        """The same on another day: its own ambient. What broke once stays broken (`Timeline.afterwards`)."""
        return Point(np.where(self._daily, 0.0, point.base), point.terms)

    def _spread(self, belief: Belief) -> Array:
        """Covariance of the parameters before another experiment: those of a day are as uncertain as ever."""
        covariance = belief.covariance.copy()
        fresh = np.flatnonzero(self._daily)
        covariance[fresh] = covariance[:, fresh] = 0.0
        covariance[fresh, fresh] = 1.0
        known = [
            len(self._daily) + i for i, name in enumerate(_term_parameters(belief.point.terms)) if name == "instant"
        ]
        covariance[known] = covariance[:, known] = 0.0
        return covariance


def _term_parameters(terms: Mapping[Term, tuple[float, ...]]) -> list[str]:
    return [p.name for t in terms for p in t.parameters]


def _term_slopes(model: CoilNetworkModel, point: Point, here: Array) -> Array:
    """Derivatives of the residuals by the parameters of the terms, shape (residuals, term parameters)."""
    moved, steps = [], []
    for term, values in point.terms.items():
        for i, (p, value) in enumerate(zip(term.parameters, values)):
            sizes = [abs(s) for s in p.starts if s] or [1.0]
            step = STEP * max(abs(value), float(np.median(sizes)))
            step = step if value + step < p.upper else -step
            moved.append(point.plus(term, [v + step if j == i else v for j, v in enumerate(values)]))
            steps.append(step)
    if not moved:
        return np.zeros((len(here), 0))
    found = ((model.residuals(moved) - here) / np.array(steps)[:, None]).T
    return np.where(np.isfinite(found), found, 0.0)


def _sampled(channel: Channel, span: tuple[float, float], corners: Array) -> tuple[Channel, Array]:
    """A channel of the same sensor with few samples, and the weight of each."""
    period = float(np.median(np.diff(channel.times)))
    times = span[0] + period * np.arange(1, int((span[1] - span[0]) / period + 1e-9) + 1)
    every = max(1, len(times) // SAMPLES)
    is_kept = np.arange(len(times)) % every == 0
    weight = np.full(len(times), np.sqrt(every))
    if 0 < len(corners) <= _EDGES and every > 1:
        after = times[:, None] - corners[None, :]
        near = np.asarray(((after > 0.0) & (after < EDGE)).any(axis=1))
        is_kept |= near
        weight[near] = 1.0
    chosen = times[is_kept]
    same = replace(
        channel,
        times=chosen,
        values=np.zeros(len(chosen)),
        deviation=deviation(channel),
        is_deviation_given=False,
        is_clipped=np.zeros(len(chosen), dtype=bool),
    )
    return same, weight[is_kept]
