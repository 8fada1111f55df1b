"""The mechanical channels of a fabric as a model that the search can vary: a surface, not simulations."""

from __future__ import annotations

import copy
from collections.abc import Container, Mapping, Sequence
from typing import Protocol

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.fabric.scatter import Bins, Whitening, calibrated_scatter, engine_covariance
from diagnosis.models.fabric.surface import Surface
from diagnosis.search.problem import Layout, Parameter, Point, Term


class View(Protocol):
    """What is seen of bins: see `diagnosis.models.fabric.camera.Camera`."""

    @property
    def terms(self) -> Container[Term]:
        """Laws that change what is seen and not what moves."""
        ...

    def seen(self, values: Array, terms: Mapping[Term, tuple[float, ...]]) -> Array:
        """Values as they are read, shape as given."""
        ...


class MechanicalModel:
    """See `diagnosis.search.problem.Model`; an evaluation costs microseconds.

    Args:
        parameters: Mechanical numbers that may be off.
        surface: Answers of the fabric.
        measured: Bins of the recordings, shape (bins,).
        bins: What each bin is.
        members: Ensemble about the anchor, shape (members, bins): its scatter counts as noise.
        names: Names of the channels.
        camera: What is seen of the bins; None: they are read as they are.
        difference: What the mean of another engine differs by, shape (bins,); None: none was asked.
    """

    def __init__(
        self,
        parameters: Sequence[Parameter],
        surface: Surface,
        measured: Array,
        bins: Bins,
        members: Array,
        names: Sequence[str],
        camera: View | None = None,
        difference: Array | None = None,
    ) -> None:
        self.camera, self.difference = camera, difference
        self.parameters, self.surface, self.measured, self.bins, self.members = (
            parameters,
            surface,
            measured,
            bins,
            members,
        )
        self.scatter = calibrated_scatter(members, bins)
        if difference is not None:
            self.scatter = self.scatter + engine_covariance(difference, bins)
        self._whiten = Whitening(self.scatter, bins.noise)
        many = np.ones(len(bins.time), dtype=bool)
        self.layout = Layout(bins.channel, bins.time, tuple(names), ("mechanical",) * len(names), many)

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        bins = self.surface.bins(points, [p.base for p in points])
        return self._whiten(self.measured - np.array([self._seen(row, p) for row, p in zip(bins, points)]))

    def misfits(self, runs: Array, point: Point) -> Array:
        """-2 log posterior of simulations of a point, each beside the recordings, shape (runs,).

        Parameters may move, by their straight lines: what another strength needs of them is paid for by their priors.

        Args:
            runs: Bins of each, shape (runs, bins).
            point: Where they were made; what the camera does is taken from it.
        """
        residuals = self._whiten(self.measured - np.array([self._seen(row, point) for row in runs]))
        count, z = len(self.parameters), point.base
        equations = np.vstack([self.base_jacobian(point), np.eye(count)])
        ends = np.vstack([residuals.T, np.repeat(z[:, None], len(runs), axis=1)])
        moved = np.linalg.lstsq(equations, -ends, rcond=None)[0]
        return np.asarray(np.sum((ends + equations @ moved) ** 2, axis=0))

    def shifts(self, runs: Array, slope: Array, point: Point) -> Array:
        """By how much a strength would be another if a run were the recording, shape (runs,); empty of a single run.

        Each run of a point is fitted by the mean of the others, along a straight line, and parameters may move: the
        strength that a recording tells scatters as these do, however sharply its curvature tells it.

        Args:
            runs: Their bins, shape (runs, bins).
            slope: Change of the bins by the strength, shape (bins,).
            point: Where they were made.
        """
        if len(runs) < 2:
            return np.zeros(0)
        count, mean = len(self.parameters), runs.mean(axis=0)
        column = -self._whiten(self._seen(mean + slope, point) - self._seen(mean, point))
        equations = np.vstack([np.column_stack([self.base_jacobian(point), column]), np.eye(count, count + 1)])
        found = []
        for number, run in enumerate(runs):
            others = np.delete(runs, number, axis=0).mean(axis=0)
            left = self._whiten(self._seen(run, point) - self._seen(others, point))
            ends = np.concatenate([left, np.zeros(count)])
            found.append(float(np.linalg.lstsq(equations, -ends, rcond=None)[0][-1]))
        return np.array(found)

    def _seen(self, bins: Array, point: Point) -> Array:
        return bins if self.camera is None else self.camera.seen(bins, point.terms)

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        if not len(self.parameters):
            return np.zeros((len(self.measured), 0))
        nothing = self._seen(np.zeros_like(self.measured), point)
        return -self._whiten(np.array([self._seen(row, point) - nothing for row in self.surface.slopes])).T

    def slopes(self, point: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]) -> Array:
        """See `diagnosis.search.problem.strength_slopes`; not finite where a term could not be simulated."""
        found = np.full((len(tasks), len(self.measured)), np.inf)
        here = self.surface.bins([point], [point.base])[0]
        seen = self._seen(here, point)
        for row, (term, values) in zip(found, tasks):
            if self.surface.knows(term):
                change = self._seen(here + self.surface.effect(term, values[0]), point) - seen
            elif self.camera is not None and term in self.camera.terms:
                change = self._seen(here, point.plus(term, values)) - seen
            else:
                continue
            row[:] = -self._whiten(change) / values[0]
        return found

    def groups(self) -> Mapping[str, AnyArray]:
        """Residuals are free of each other: no channels are looked at together."""
        return {}

    def without_member(self, number: int, seed: int) -> MechanicalModel:
        """A null: one member of the ensemble as the recording, with sensors' noise, the others as the ensemble."""
        others = np.delete(self.members, number, axis=0)
        surface = self.surface.with_mean(others.mean(axis=0), self.surface.anchor)
        measured = self.members[number] + self._noise(seed, number)
        return MechanicalModel(
            self.parameters, surface, measured, self.bins, others, self.layout.names, self.camera, self.difference
        )

    def _noise(self, *seed: int) -> Array:
        """What sensors may add to the bins of a null."""
        return np.asarray(self.bins.noise * np.random.default_rng(seed).standard_normal(len(self.measured)))

    def of_run(self, runs: Array, number: int, seed: int) -> MechanicalModel:
        """A null: one of several runs of one point as the recording, with sensors' noise, about the mean of the others.

        Args:
            runs: Shape (runs, bins), two or more.
            number: Of the run that is the recording.
            seed: Of the noise.
        """
        surface = self.surface.with_mean(np.delete(runs, number, axis=0).mean(axis=0), self.surface.anchor)
        null = copy.copy(self)
        null.surface, null.measured = surface, runs[number] + self._noise(seed, number)
        return null

    def of_other_engine(self, run: Array, number: int, seed: int) -> MechanicalModel:
        """A null: a run of the same fabric in another engine as the recording, with sensors' noise.

        Args:
            run: Shape (bins,).
            number: Of the run, for the noise.
            seed: Of the noise.
        """
        null = copy.copy(self)
        null.measured = run + self._noise(seed, number, 1)
        return null

    def scatters_together(self) -> float:
        """How many times more the sum of squares over all channels varies than if each scattered by itself.

        For draws of covariance C, the variance of a sum of squares is 2 trace(C C), each channel in its own deviation.
        Contacts move many markers at once, and two engines differ in a direction.
        """
        variance = np.diag(self.scatter) + self.bins.noise**2
        own = np.bincount(self.bins.channel, variance) / np.maximum(np.bincount(self.bins.channel), 1)
        deviation = np.sqrt(own)[self.bins.channel]
        squares = (self.scatter / np.outer(deviation, deviation)) ** 2
        is_same = self.bins.channel[:, None] == self.bins.channel[None, :]
        alone = float(np.sum(squares[is_same]))
        return float(np.sum(squares)) / alone if alone > 0.0 else 1.0

    def scatter_deviation(self) -> Array:
        """Standard deviation of scatter in each bin, shape (bins,)."""
        return np.asarray(np.sqrt(np.diag(self.scatter)))
