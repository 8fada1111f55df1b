"""The mechanical channels of a fabric as a model that the search can vary: a surface, not simulations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.fabric.scatter import Bins, Whitening, calibrated_scatter
from diagnosis.models.fabric.surface import Surface
from diagnosis.search.problem import Layout, Parameter, Point, Term


class MechanicalModel:
    """See `diagnosis.search.problem.Model`; an evaluation costs microseconds.

    Args:
        parameters: Mechanical numbers that may be off.
        surface: Answers of the fabric.
        measured: Bins of the recordings, shape (bins,).
        bins: What each bin is.
        members: Ensemble about the anchor, shape (members, bins): its scatter counts as noise.
        names: Names of the channels.
    """

    def __init__(
        self,
        parameters: Sequence[Parameter],
        surface: Surface,
        measured: Array,
        bins: Bins,
        members: Array,
        names: Sequence[str],
    ) -> None:
        self.parameters, self.surface, self.measured, self.bins, self.members = (
            parameters,
            surface,
            measured,
            bins,
            members,
        )
        self.scatter = calibrated_scatter(members, bins)
        self._whiten = Whitening(self.scatter, bins.noise)
        self.layout = Layout(bins.channel, bins.time, tuple(names), ("mechanical",) * len(names))

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return self._whiten(self.measured - self.surface.bins(points, [p.base for p in points]))

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return -self._whiten(self.surface.slopes).T if len(self.parameters) else np.zeros((len(self.measured), 0))

    def slopes(self, point: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]) -> Array:
        """See `diagnosis.search.problem.strength_slopes`; not finite where a term could not be simulated."""
        found = np.full((len(tasks), len(self.measured)), np.inf)
        for row, (term, values) in zip(found, tasks):
            if self.surface.knows(term):
                row[:] = -self._whiten(self.surface.effect(term, values[0])) / values[0]
        return found

    def groups(self) -> Mapping[str, AnyArray]:
        """Residuals are free of each other: no channels are looked at together."""
        return {}

    def without_member(self, number: int, seed: int) -> MechanicalModel:
        """A null: one member of the ensemble as the recording, with sensors' noise, the others as the ensemble."""
        others = np.delete(self.members, number, axis=0)
        noise = self.bins.noise * np.random.default_rng([seed, number]).standard_normal(len(self.measured))
        surface = self.surface.with_mean(others.mean(axis=0), self.surface.anchor)
        measured = self.members[number] + noise
        return MechanicalModel(self.parameters, surface, measured, self.bins, others, self.layout.names)

    def scatter_deviation(self) -> Array:
        """Standard deviation of scatter in each bin, shape (bins,)."""
        return np.asarray(np.sqrt(np.diag(self.scatter)))
