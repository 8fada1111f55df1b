"""The equation of a unit at a located element: what inputs there would do beyond what parameters can do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.locate.panel import Panel
from diagnosis.locate.statistic import Tested, calm, propagated


@dataclass(frozen=True)
class Products:
    """Inner products of responses, parameters taken away.

    Args:
        gram: Of the responses with each other, shape (inputs, inputs).
        along: With the residuals, shape (inputs,).
    """

    gram: Array
    along: Array

    def gain(self, amounts: Array) -> float:
        """Fall of -2 log posterior by inputs of these amounts."""
        return float(2.0 * amounts @ self.along - amounts @ self.gram @ amounts)

    def only(self, chosen: Sequence[int]) -> Products:
        """Of some of the inputs."""
        return Products(self.gram[np.ix_(chosen, chosen)], self.along[list(chosen)])


class Equation:
    """One equation at some elements: unknown inputs there, seen through the channels of those elements.

    Args:
        tested: The unit, its own parameters fitted.
        elements: Coils or strings on which the inputs act, counted from 0; None: the supply.
        quantities: Channels through which they are seen.
        parts: Which samples count, one mask (samples,) for each panel; None: all.
    """

    def __init__(
        self,
        tested: Tested,
        elements: AnyArray | None,
        quantities: Sequence[str],
        parts: Sequence[AnyArray] | None = None,
    ) -> None:
        self.panels = [p if p.quantity in quantities else None for p in tested.panels]
        self._rows: list[tuple[Panel, AnyArray, Array, Array] | None] = []
        size = tested.panels[0].columns.shape[2]
        normal, slope = np.eye(size), tested.pull.copy()
        for number, panel in enumerate(tested.panels):
            part = np.ones(len(panel.times), dtype=bool) if parts is None else parts[number]
            # What is left is looked at as a signal: only readings that stand alone are held back.
            panel = replace(panel, residual=calm(panel.residual, panel.used))
            weights = np.where(panel.used & part[:, None], 1.0 / (1.0 + propagated(panel)), 0.0)
            flat = panel.columns.reshape(-1, size)
            weighted = flat * weights.reshape(-1, 1)
            normal += flat.T @ weighted
            slope += weighted.T @ panel.residual.reshape(-1)
            is_there = np.ones(len(panel.elements)) if elements is None else np.isin(panel.elements, elements)
            members = np.flatnonzero(is_there)
            kept = self.panels[number] is not None and members.size and panel.respond is not None
            self._rows.append((panel, members, weights[:, members], panel.columns[:, members]) if kept else None)
        self._inverse = np.linalg.inv(normal)
        self._step = self._inverse @ slope

    @property
    def members(self) -> list[tuple[int, Panel, AnyArray]]:
        """Number of each panel that sees the inputs, the panel, and the channels of the elements in it."""
        return [(n, row[0], row[1]) for n, row in enumerate(self._rows) if row is not None]

    def products(self, responses: Sequence[Array]) -> Products:
        """Inner products of what inputs do.

        Args:
            responses: For each of `members` in turn, SI, shape (samples, channels, inputs).
        """
        count = responses[0].shape[2]
        size = len(self._inverse)
        gram, along, across = np.zeros((count, count)), np.zeros(count), np.zeros((size, count))
        rows = [row for row in self._rows if row is not None]
        for (panel, members, weights, columns), response in zip(rows, responses):
            scaled = (response / panel.deviation[:, members, None]).reshape(-1, count)
            weighted = scaled * weights.reshape(-1, 1)
            gram += scaled.T @ weighted
            along += weighted.T @ panel.residual[:, members].reshape(-1)
            across += columns.reshape(-1, size).T @ weighted
        # The parameters are fitted again to these samples and weights: what that takes from the residuals is lost.
        return Products(np.asarray(gram - across.T @ self._inverse @ across), np.asarray(along - across.T @ self._step))
