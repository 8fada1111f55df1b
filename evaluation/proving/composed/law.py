"""A composed law: a sum of products of chains, each over one variable."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from evaluation.proving.composed.shapes import Stage, drawn_function, drawn_hysteresis, drawn_memory
from evaluation.proving.rig import Array


@dataclass(frozen=True)
class Scale:
    """Makes a variable dimensionless: (value - zero) / size.

    Args:
        symbol: Of the variable in formulas.
        zero: SI.
        size: SI; what the variable reaches on this rig.
        is_signed: Whether it goes to both sides of its zero.
    """

    symbol: str
    zero: float
    size: float
    is_signed: bool = False

    def formula(self) -> str:
        """As text."""
        inner = self.symbol if self.zero == 0.0 else f"({self.symbol} - {self.zero:.5g})"
        return f"({inner} / {self.size:.4g})"


@dataclass
class Chain:
    """Stages over one variable.

    Args:
        variable: Its name.
        scale: Of it.
        stages: In the order in which they act.
    """

    variable: str
    scale: Scale
    stages: list[Stage]

    def formula(self) -> str:
        """As text."""
        text = self.scale.formula()
        for stage in self.stages:
            text = f"({stage.formula(text)})"
        return text

    def reset(self, values: Mapping[str, Array]) -> Array:
        """At the start."""
        value = self._scaled(values)
        for stage in self.stages:
            value = stage.reset(value)
        return value

    def moved(self, values: Mapping[str, Array], size: float) -> Array:
        """After a time [s]."""
        value = self._scaled(values)
        for stage in self.stages:
            value = stage.moved(value, size)
        return value

    def _scaled(self, values: Mapping[str, Array]) -> Array:
        return np.asarray((values[self.variable] - self.scale.zero) / self.scale.size)


@dataclass
class Law:
    """Sum of weighted products.

    Args:
        terms: Weight and factors of each.
        amplitude: Of all, in the unit of what it acts on.
    """

    terms: list[tuple[float, list[Chain]]]
    amplitude: float = 1.0

    def formula(self) -> str:
        """As text, with all of its numbers."""
        parts = [" * ".join([f"{w:.4g}", *(c.formula() for c in chains)]) for w, chains in self.terms]
        return f"{self.amplitude:.6g} * ({' + '.join(parts)})"

    def reset(self, values: Mapping[str, Array]) -> Array:
        """Value at the start; all memories begin anew."""
        return self._sum([[c.reset(values) for c in chains] for _, chains in self.terms])

    def moved(self, values: Mapping[str, Array], size: float) -> Array:
        """Value after a time [s] at whose end the variables have these values."""
        return self._sum([[c.moved(values, size) for c in chains] for _, chains in self.terms])

    def _sum(self, found: list[list[Array]]) -> Array:
        total = sum(w * np.prod(np.stack(values), axis=0) for (w, _), values in zip(self.terms, found))
        return np.asarray(self.amplitude * total)


def drawn_law(scales: Mapping[str, Scale], stop: float, rng: np.random.Generator) -> Law:
    """A law with its composition and all numbers but its amplitude drawn.

    Args:
        scales: Variables that may enter.
        stop: Length of a recording [s].
        rng: Source of draws.
    """
    terms = [(1.0, _drawn_product(scales, stop, rng))]
    if rng.random() < 0.35:
        weight = float(rng.choice([-1.0, 1.0])) * float(rng.uniform(0.3, 1.0))
        terms.append((weight, _drawn_product(scales, stop, rng)))
    return Law(terms, float(rng.choice([-1.0, 1.0])))


def _drawn_product(scales: Mapping[str, Scale], stop: float, rng: np.random.Generator) -> list[Chain]:
    names = [str(n) for n in rng.permutation(list(scales))]
    if names[0] == "time":  # alone it would be the same course in every recording, whatever is done to the rig
        names = [names[1], names[0]]
    elif rng.random() < 0.5:
        names = names[:1]
    names = names[:2]
    first = names[0]
    stages = [drawn_hysteresis(rng) if rng.random() < 0.2 else drawn_function(rng, scales[first].is_signed)]
    if rng.random() < 0.55:
        stages.append(drawn_memory(rng, stop))
    others = [Chain(n, scales[n], [drawn_function(rng, scales[n].is_signed)]) for n in names[1:]]
    return [Chain(first, scales[first], stages), *others]
