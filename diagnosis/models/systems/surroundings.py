"""The temperature of the surroundings of an FMU that has it as a parameter, found by its equations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue, conversion, parse_unit
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.fmu_layout import FastFmu
from diagnosis.models.systems.numbers import scalar_parameters
from diagnosis.models.systems.quantities import Places
from diagnosis.models.systems.targets import is_of
from diagnosis.search.cosim_run import Changes

#: What temperatures are moved by [K], and what rates may then change by, relative: rounding.
MOVED, ROUNDING = 1.0, 1e-6
#: How closely all temperatures follow a parameter that is their surroundings and their start, relative.
CARRIED = 1e-3


def surroundings(
    system: FastSystem, fmu: FastFmu, own: Places, names: Sequence[str], points: Array, rates: Array
) -> float | None:
    """Temperature [K] towards which the states of an FMU that are temperatures go; None where that is not clear.

    It is the only parameter with which those rates change, or the only one that, moved together with all states that
    are temperatures, leaves them as they are: what flows goes by differences to it.

    Args:
        system: Of one recording.
        fmu: The FMU.
        own: Its quantities.
        names: Its states, in order.
        points: States at which its equations are asked, in its units, shape (points, states).
        rates: Derivatives there, of the same shape.
    """
    warm = [i for i, n in enumerate(names) if is_of(own.states[n], "K")]
    if not warm or any(is_of(q, "K") for q in own.inputs.values()):
        return None
    acting: list[float] = []
    carried: list[float] = []
    plain = rates[:, warm]
    steps = np.zeros(points.shape[1])
    for i in warm:
        steps[i] = MOVED / conversion(fmu.units[names[i]], "K")[0]
    for kelvin, changes in _moved(system, fmu, own):
        if system.simulate(changes) is None:
            continue
        if not _are_alike(system.rates_at(own.component, points)[:, warm], plain):
            acting.append(kelvin)
            if _are_alike(system.rates_at(own.component, points + steps)[:, warm], plain):
                carried.append(acting[-1])
    system.simulate()
    found = carried or acting
    return found[0] if len(found) == 1 else None


def hidden_surroundings(system: FastSystem, fmu: FastFmu, own: Places) -> float | None:
    """The same of an FMU that hides its states, by its outputs; None where that is not clear.

    It is the only parameter that leaves where temperatures begin and moves them later, or else the only one that moves
    all of them by as much as itself all the time: a start at rest.

    Args:
        system: Of one recording.
        fmu: The FMU.
        own: Its quantities.
    """
    warm = [q.name for q in own.outputs.values() if is_of(q, "K")]
    driven = any(is_of(q, "K") for q in own.inputs.values())
    if not warm or driven or not any(is_of(q, "W") for q in own.inputs.values()):
        return None
    plain = _temperatures(system, fmu, own, warm, Changes())
    if plain is None:
        return None
    acting: list[float] = []
    carrying: list[float] = []
    for kelvin, changes in _moved(system, fmu, own):
        there = _temperatures(system, fmu, own, warm, changes)
        if there is None or _are_alike(there, plain):
            continue
        if _are_alike(there[0], plain[0]):
            acting.append(kelvin)
        elif np.allclose(there - plain, MOVED, rtol=CARRIED):
            carrying.append(kelvin)
    system.simulate()
    found = acting or carrying
    return found[0] if len(found) == 1 else None


def _moved(system: FastSystem, fmu: FastFmu, own: Places) -> Iterator[tuple[float, Changes]]:
    """Parameters that are temperatures: each as it is [K], and the change by which it is `MOVED` higher."""
    for parameter, value in scalar_parameters(fmu, system, own.component):
        unit = fmu.unit.table.all[parameter].variable.unit
        if parse_unit(unit).dimensionality == parse_unit("K").dimensionality:
            factor, offset = conversion(unit, "K")
            higher = PhysicalValue(value + MOVED / factor, unit)
            yield factor * value + offset, Changes({own.component: {parameter: higher}})


def _temperatures(
    system: FastSystem, fmu: FastFmu, own: Places, names: Sequence[str], changes: Changes
) -> Array | None:
    """Outputs that are temperatures [K], shape (rows, names); None where the simulation stops."""
    rows = system.simulate(changes)
    if rows is None:
        return None
    found = []
    for name in names:
        factor, offset = conversion(fmu.units[name], "K")
        found.append(factor * rows.values[:, system.recorded[own.component, name]].reshape(-1) + offset)
    return np.array(found).T


def _are_alike(rates: Array, others: Array) -> bool:
    return bool(np.allclose(rates, others, rtol=ROUNDING, atol=ROUNDING * float(np.max(np.abs(others), initial=0.0))))
