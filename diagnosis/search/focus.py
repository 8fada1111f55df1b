"""Which of the thousands of terms at single elements are worth a simulation: those where something is left."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.search.posterior import HUBER
from diagnosis.search.problem import Layout, Model, Term
from diagnosis.search.structure import WINDOWS

#: Channels of each unit that are looked into, the most conspicuous first.
CHANNELS = 6


class Local(Protocol):
    """A model that knows which channels a term at one element shows in."""

    def shows_in(self, term: Term) -> tuple[Sequence[int], bool] | None:
        """Numbers of channels, and whether all of them must be conspicuous; None: the term is not local."""
        ...


def conspicuousness(residuals: Array, layout: Layout) -> Array:
    """Largest standardised sum of each channel's residuals over windows, shape (channels,)."""
    found = np.zeros(len(layout.names))
    for number in range(len(layout.names)):
        values = residuals[layout.channel == number]
        values = np.clip(values[values != 0.0], -HUBER, HUBER)
        for window in (*WINDOWS, 48):
            if len(values) >= window:
                sums = np.convolve(values, np.ones(window), mode="valid") / np.sqrt(window)
                found[number] = max(found[number], float(np.max(np.abs(sums))))
    return found


def conspicuous(residuals: Array, layout: Layout) -> set[int]:
    """The most conspicuous channels of every unit."""
    z = conspicuousness(residuals, layout)
    chosen: set[int] = set()
    for unit in set(layout.units):
        members = [i for i, u in enumerate(layout.units) if u == unit]
        chosen.update(sorted(members, key=lambda i: -z[i])[:CHANNELS])
    return chosen


def focus(model: Model, residuals: Array, terms: Sequence[Term]) -> list[Term]:
    """Terms that are not local, and named local ones that show where something is left."""
    shows_in = getattr(model, "shows_in", None)
    if shows_in is None:
        return list(terms)
    chosen = conspicuous(residuals, model.layout)
    kept = []
    for term in terms:
        local = shows_in(term)
        if local is None:
            kept.append(term)
            continue
        channels, is_every = local
        inside = [c in chosen for c in channels]
        if not term.is_named:
            continue  # they come in at the places that named terms single out
        if inside and (all(inside) if is_every else any(inside)):
            kept.append(term)
    return kept


def unnamed_at(terms: Sequence[Term], places: Sequence[str], known: Sequence[Term]) -> list[Term]:
    """Unnamed terms at places that scored well, without those that were scored already."""
    done = set(known)
    return [t for t in terms if not t.is_named and t.place in places and t not in done]
