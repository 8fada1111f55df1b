"""What outputs of a Model Exchange FMU are: a state, the derivative of one, a part of it, or made of several.

Outputs that are a derivative (an accelerometer, the net flow into a store): a law is added to the derivative, which the
FMU does not know, and its output leaves the law out. So the law is added to the output too. Outputs that are made of
several quantities have an equation of their own, from which something may be missing as from those of the states.

Outputs that are a part of a derivative (a load cell in series with a spring, a flow meter in a pipe, a heat flux in
a wall) read what acts between states. A law that is missing from that spring, pipe or wall is missing from the output
too; one beside it is not. Both are tried.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import Any

import numpy as np

from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue, parse_unit, registry
from diagnosis.laws.expression import names_in
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.fmu_layout import FastFmu
from diagnosis.models.systems.placed import Placed
from diagnosis.models.systems.quantities import Places, Quantity

#: Random points at which the equations are asked, and their seed.
PROBES, SEED = 8, 21
#: Largest departure of an output from its straight line in a derivative, as a share of the output's own range.
ROUNDING = 1e-8
#: Name of the factor in the added term.
FACTOR = "derivative_factor"


def outputs_read(system: FastSystem, fmu: FastFmu, own: Places) -> tuple[dict[str, dict[str, float]], list[str]]:
    """Outputs that are the derivative of a state, and those that are made of several quantities.

    Args:
        system: After a simulation.
        fmu: One of its FMUs.
        own: Its quantities.

    Returns:
        State to output to the factor of its derivative, in the units of the output and of the state per second; an
        output is that times the factor plus a constant at every point. Not of a state whose derivative is a state: that
        output is the reading of a velocity, to which nothing is added. And the outputs that are no straight line in any
        one state or in the derivative of one, and change.
    """
    outputs = _outputs(fmu, own)
    if not outputs:
        return {}, []
    states, rates, read = _asked(system, fmu, own)
    names = list(fmu.states)
    derivatives: dict[str, dict[str, float]] = {}
    for state in (n for n in own.states if n not in own.velocity_of and n not in own.twist_of):
        rate, value = rates[:, names.index(state)], states[:, names.index(state)]
        for output in outputs:
            factor = _line(rate, read[output])
            # of a store that decays by itself, whatever reads its level is a straight line in its rate
            if factor is not None and _line(value, read[output]) is None:
                derivatives.setdefault(state, {})[output] = factor
    single = np.hstack([states, rates]).T
    composed = [
        name
        for name in outputs
        if np.isfinite(read[name]).all()
        and np.ptp(read[name]) > 0.0
        and all(_line(values, read[name]) is None for values in single)
    ]
    return derivatives, composed


def states_read(fmu: FastFmu, own: Places, composed: Sequence[str]) -> frozenset[str]:
    """States, and outputs that are a straight line in one of them alone; nothing of the rig lies between.

    Args:
        fmu: Any FMU; of one that hides its states nothing is known.
        own: Its quantities, with `derivatives_read`.
        composed: Outputs that are more than that.
    """
    rates = {output for outputs in own.derivatives_read.values() for output in outputs}
    return frozenset(fmu.states) | (set(_outputs(fmu, own)) - set(composed) - rates)


def _outputs(fmu: FastFmu, own: Places) -> list[str]:
    """Scalar outputs of a Model Exchange FMU all of whose states are known; else none."""
    if not fmu.is_model_exchange or not fmu.states or set(fmu.states) != set(own.states):
        return []
    return [n for n, a in fmu.outputs.items() if a.size == 1 and n in fmu.units and n not in fmu.states]


def _asked(
    system: FastSystem, fmu: FastFmu, own: Places, moving: Collection[str] | None = None
) -> tuple[Array, Array, dict[str, Array]]:
    """Random states, shape (probes, states), their rates there, and outputs by name, shape (probes,).

    Args:
        system: After a simulation.
        fmu: One of its FMUs.
        own: Its quantities.
        moving: States and inputs that move, where the others stay at their middles; None: all.
    """
    rng = np.random.default_rng(SEED)
    names, before = list(fmu.states), fmu.inner.copy()

    def drawn(name: str, quantity: Quantity) -> float:
        size = quantity.size * rng.standard_normal()
        return quantity.middle + (size if moving is None or name in moving else 0.0)

    states, rates, read = [], [], []
    for _ in range(PROBES):
        for name, quantity in own.inputs.items():
            fmu.inner[fmu.inputs[name]] = drawn(name, quantity)
        for write in fmu.writers:
            write()
        point = np.array([drawn(n, own.states[n]) for n in names])
        found = system.outputs_at(own.component, system.start / 1e9, point)
        states.append(point)
        rates.append(found[0])
        read.append(found[1])
    fmu.inner[:] = before
    for write in fmu.writers:
        write()
    return np.array(states), np.array(rates), {n: np.array([r[n] for r in read]) for n in read[0]}


def _line(given: Array, values: Array) -> float | None:
    """Slope of values that are a straight line in others; None where they are not, or where nothing changes."""
    if not (np.isfinite(given).all() and np.isfinite(values).all()) or np.ptp(given) == 0.0 or np.ptp(values) == 0.0:
        return None
    centred = given - given.mean()
    slope = float(centred @ (values - values.mean()) / (centred @ centred))
    left = values - values.mean() - slope * centred
    return slope if float(np.max(np.abs(left))) <= ROUNDING * float(np.ptp(values)) else None


def read_by_outputs(own: Places, placed: Placed) -> Iterator[Placed]:
    """What an addition to a derivative adds to the outputs that are this derivative.

    Raises:
        ValueError: A unit is none.
    """
    state = _state_of(placed)
    for output, factor in own.derivatives_read.get(state, {}).items():
        yield _read(own, placed, state, output, factor)


def read_in_part(own: Places, placed: Placed) -> Iterator[Placed]:
    """What an addition to a derivative adds to the outputs that are a part of it, where it acts over what they read.

    Raises:
        ValueError: A unit is none.
    """
    state = _state_of(placed)
    used = set().union(*(names_in(f) for f in (placed.formula, *(s.rate for s in placed.states))))
    used &= {*own.states, *own.inputs}
    for output, (factor, over) in own.parts_read.get(state, {}).items():
        if used and used <= over:
            yield _read(own, placed, state, output, factor)


def _state_of(placed: Placed) -> str:
    """The state to whose derivative something is added; empty where it is another place."""
    return placed.to[4:-1] if placed.to.startswith("der(") else ""


def _read(own: Places, placed: Placed, state: str, output: str, factor: float) -> Placed:
    """What an addition to the derivative of a state adds to an output."""
    per_second = parse_unit(own.states[state].unit) / parse_unit("s")
    unit = registry().Quantity(1.0, parse_unit(own.output_units[output])) / registry().Quantity(1.0, per_second)
    text = f"{unit.units:~C}".replace("**", "^") or "1"
    constants = {**placed.constants, FACTOR: PhysicalValue(factor, text)}
    return Placed(
        placed.component,
        output,
        f"{FACTOR} * ({placed.formula})",
        placed.numbers,
        constants,
        placed.states,
        placed.delays,
    )


def parts_read(system: FastSystem, fmu: FastFmu, own: Places) -> dict[str, dict[str, tuple[float, frozenset[str]]]]:
    """Outputs that are a part of the derivative of a state, by which they are an inertia or a capacity times.

    An output that changes with some states alone, and by the same amount times a factor as a derivative does when these
    move, is that part of it. One of the unit of such a state is a difference or a sum of states, and no force; neither
    is one whose factor is no inertia, capacity, inductance or area.

    Args:
        system: After a simulation.
        fmu: One of its FMUs.
        own: Its quantities, with `velocity_of`, `twist_of` and `derivatives_read`.

    Returns:
        State to output to the factor of its derivative, in their units, and the states over which a law may act there:
        those with which the output changes, and the velocities of these.
    """
    whole = {n for read in own.derivatives_read.values() for n in read}
    names, found = list(fmu.states), dict[str, dict[str, tuple[float, frozenset[str]]]]()
    over = _changing_with(system, fmu, own, [n for n in _outputs(fmu, own) if n not in whole])
    for output, states in over.items():
        if any(_dimension(own.states[n].unit) == _dimension(fmu.units[output]) for n in states):
            continue
        _, rates, read = _asked(system, fmu, own, states)
        for state in (n for n in own.states if n not in own.velocity_of and n not in own.twist_of):
            factor = _line(rates[:, names.index(state)], read[output])
            if factor is not None and _is_inertia(fmu.units[output], own.states[state].unit):
                moving = {own.velocity_of[n] for n in states if n in own.velocity_of}
                found.setdefault(state, {})[output] = factor, states | moving
    return found


def _changing_with(system: FastSystem, fmu: FastFmu, own: Places, outputs: Sequence[str]) -> dict[str, frozenset[str]]:
    """Outputs that change with states alone, with these states; not those that change with an input too."""
    if not outputs:
        return {}
    _, _, by_inputs = _asked(system, fmu, own, own.inputs)
    asked = [n for n in outputs if not np.ptp(by_inputs[n]) > 0.0]
    found: dict[str, set[str]] = {n: set() for n in asked}
    for state in own.states:
        _, _, read = _asked(system, fmu, own, (state,))
        for output in asked:
            if np.ptp(read[output]) > 0.0:
                found[output].add(state)
    return {n: frozenset(states) for n, states in found.items() if states}


#: Units of what turns the rate of a state into a force, a heat, a flow, a voltage or a current.
_INERTIAS = ("kg", "kg*m", "kg*m^2", "J/K", "m^2", "m^3/Pa", "H", "F")


def _is_inertia(output: str, state: str) -> bool:
    """Whether an output over the rate of a state is an inertia, a capacity, an area or an inductance."""
    found = _dimension(output) / (_dimension(state) / parse_unit("s").dimensionality)
    return any(found == _dimension(unit) for unit in _INERTIAS)


def _dimension(unit: str) -> Any:
    return parse_unit(unit).dimensionality
