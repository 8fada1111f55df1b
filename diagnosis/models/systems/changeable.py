"""Which parameters of an FMU may change with a quantity: those that its derivatives hold."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cosim.fmu.added_terms import unchanging
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.moved_parameter import MovedParameter
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array, UnitError
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.fmu_layout import FastFmu
from diagnosis.models.systems.numbers import scalar_parameters
from diagnosis.models.systems.quantities import Changeable, Places, Quantity
from diagnosis.models.systems.targets import is_of

#: Points at which the equations are asked, and their seed.
PROBES, SEED = 5, 23
#: Parameters of an FMU at most, those that move its states most.
MOST = 12
#: Effect on a derivative that is rounding, over its size.
ROUNDING = 1e-9


@dataclass(frozen=True)
class _Effect:
    """What a parameter does to the derivatives.

    Args:
        quantity: The parameter.
        rates: Derivatives where it is smaller and larger, over their sizes, shape (2, points, states).
        size: How far they are apart by at most.
    """

    quantity: Quantity
    rates: Array
    size: float

    def is_like(self, other: _Effect) -> bool:
        """Whether both do the same in every point: the equations hold them as one product."""
        return bool(np.max(np.abs(self.rates - other.rates)) <= 1e-6 * max(self.size, other.size))


def changeable(system: FastSystem, fmu: FastFmu, own: Places) -> dict[str, Changeable]:
    """Parameters that may change, by name; of several that only act as a product, the first.

    A temperature is none: a share of it says nothing.

    Args:
        system: Of one recording, after a simulation.
        fmu: The FMU.
        own: Its quantities.
    """
    if not isinstance(fmu.unit, ModelExchangeUnit) or not fmu.states or set(fmu.states) != set(own.states):
        return {}
    if why_none(fmu):
        return {}
    groups: list[list[_Effect]] = []
    # Of parameters that do the same but for rounding, the first that the FMU declares comes first.
    for effect in sorted(_effects(system, fmu, fmu.unit, own), key=lambda e: -float(f"{e.size:.6g}"))[:MOST]:
        like = next((g for g in groups if effect.is_like(g[0])), None)
        if like is None:
            groups.append([effect])
        else:
            like.append(effect)
    found = {}
    for first, *others in groups:
        moved = np.ptp(first.rates, axis=0).max(axis=0) > ROUNDING * first.size
        moves = tuple(n for n, is_moved in zip(fmu.states, moved) if is_moved)
        found[first.quantity.name] = Changeable(first.quantity, moves, tuple(o.quantity.name for o in others))
    return found


def why_none(fmu: FastFmu) -> str:
    """Why no parameter of a Model Exchange FMU can change; empty where one can. After a simulation."""
    if np.isfinite(fmu.layout.next_event):
        return "it has time events, which might come at other times with another value"
    return unchanging(fmu.unit.table)


def _effects(system: FastSystem, fmu: FastFmu, unit: ModelExchangeUnit, own: Places) -> Iterator[_Effect]:
    rng = np.random.default_rng(SEED)
    middle, size = np.array([own.states[n].in_fmu for n in fmu.states]).T
    points = middle + size * rng.standard_normal((PROBES, len(middle)))
    inputs: dict[str, AnyArray] = {n: np.array(unit.get(n)) for n in unit.writers}
    given = []
    for _ in points:
        own_inputs = {n: q.in_fmu[0] + q.in_fmu[1] * rng.standard_normal() for n, q in own.inputs.items()}
        given.append({**inputs, **{n: np.asarray(v) for n, v in own_inputs.items()}})
    sizes = np.array([own.states[n].rate / own.states[n].size * s for n, s in zip(fmu.states, size)])
    for name, value in scalar_parameters(fmu, system, own.component):
        unit_text = fmu.unit.table.all[name].variable.unit
        quantity = Quantity(name, unit_text, abs(value), value, 0.0)
        if value == 0.0 or is_of(quantity, "K"):
            continue
        try:
            moved = fmu.moved_parameter(name)
            moved.begin(system.start, {})
            rates = _rates(moved.moved, system.start / 1e9, points, given) / sizes
        except (UnitError, InputError):
            continue  # the FMU does not take another value
        effect = float(np.max(np.ptp(rates, axis=0)))
        if np.isfinite(rates).all() and effect > ROUNDING * float(np.max(np.abs(rates))):
            yield _Effect(quantity, rates, effect)


def _rates(moved: MovedParameter, time: float, points: Array, given: list[dict[str, AnyArray]]) -> Array:
    """Derivatives where the parameter is smaller and larger, shape (2, points, states)."""
    return np.array([[i.rates_at(time, p, u) for p, u in zip(points, given)] for i in moved.instances])
