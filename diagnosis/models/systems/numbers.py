"""Which parameters of an FMU may be off where nobody says how well they are known."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.components import ProgrammeComponent
from cosim.fmu.units import is_known
from cosim.unit.protocol import Array, Causality
from cosim.unit.quantity import PhysicalValue, conversion
from diagnosis.faults.programme import InputChange
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.fmu_layout import FastFmu
from diagnosis.recording.units import si_unit
from diagnosis.search.cosim_model import Free
from diagnosis.search.cosim_run import Changes
from diagnosis.search.problem import Parameter

#: Standard deviation of ln(value) of a parameter of which nothing is stated: a careful data sheet.
USUAL = 0.05
#: Change by which a parameter is asked what it does, relative.
STEP = 0.01
#: Gain of all programmes with which a parameter of an FMU without visible states is asked again, and largest share of
#: what it does that may change with them if it is a start value: a linear system's free response depends on no input.
LESS, FREE = -0.5, 0.05
#: Parameters that are varied at most, those that move the outputs most.
MOST = 20


def usual_numbers(system: FastSystem, free: Sequence[Free]) -> list[Free]:
    """Parameters of FMUs of which neither a parameter set nor a recording states anything.

    A parameter counts if it is a number other than 0, changes what the FMU does, and is no start value: a start value
    leaves the equations as they are.

    Args:
        system: Of one recording.
        free: Numbers that are stated to be off.
    """
    found: list[tuple[float, Free]] = []
    for name, fmu in system.fmus.items():
        stated = system.assembly.parameters[name].uncertainty
        if stated or any(f.component == name and not f.is_own for f in free):
            continue
        named = {f.name for f in free if f.component == name}
        for parameter, value in scalar_parameters(fmu, system, name):
            if parameter not in named and value != 0.0:  # a relative change of 0 is none
                effect = _effect(system, name, fmu, parameter, value)
                if effect > 0.0:
                    found.append((effect, _free(name, fmu, parameter, value)))
    found.sort(key=lambda one: -one[0])
    return [free for _, free in found[:MOST]]


def scalar_parameters(fmu: FastFmu, system: FastSystem, component: str) -> Iterator[tuple[str, float]]:
    """Scalar parameters with their values in the FMU's own units."""
    for name, variable in fmu.unit.table.all.items():
        v = variable.variable
        if v.causality is not Causality.PARAMETER or not v.type.is_float or v.shape or not is_known(v.unit):
            continue
        if variable.is_structural or variable.is_constant:
            continue
        given = system.parameter(component, name)
        value = given.to(v.unit) if isinstance(given, PhysicalValue) and given.unit else given
        value = value.number if isinstance(value, PhysicalValue) else value
        if isinstance(value, int | float) and not isinstance(value, bool) and np.isfinite(value):
            yield name, float(value)


def _effect(system: FastSystem, component: str, fmu: FastFmu, parameter: str, value: float) -> float:
    """How far the outputs move with it, in their own sizes; 0 for a start value."""
    before, after = (_simulated(system, component, fmu, parameter, f * value) for f in (1.0, 1.0 + STEP))
    if before is None or after is None:
        return 0.0
    moved = np.abs(after.rows - before.rows)
    sizes = np.std(before.rows, axis=0) + 1e-12 * np.max(np.abs(before.rows), axis=0)
    outputs = [s for (name, _), s in system.recorded.items() if name in system.fmus]
    columns = np.concatenate([np.arange(s.start, s.stop) for s in outputs])
    with np.errstate(divide="ignore", invalid="ignore"):
        effect = float(np.nanmax(np.where(sizes > 0.0, np.sqrt(np.mean(moved**2, axis=0)) / sizes, 0.0)[columns]))
    if not np.any(moved[0, columns] > 0.0):
        return effect
    if fmu.is_model_exchange and fmu.state_count:
        own = [s for (c, name), s in system.recorded.items() if c == component and name.startswith("state ")]
        states = np.concatenate([np.arange(s.start, s.stop) for s in own])
        is_start = np.array_equal(before.rates, after.rates) and bool(np.any(moved[0, states] > 0.0))
    else:
        less = [_simulated(system, component, fmu, parameter, f * value, LESS) for f in (1.0, 1.0 + STEP)]
        rows = [r.rows[:, columns] for r in less if r is not None]
        change = (after.rows - before.rows)[:, columns]
        is_start = len(rows) < 2 or bool(np.max(np.abs(change - (rows[1] - rows[0]))) < FREE * np.max(np.abs(change)))
    return 0.0 if is_start else effect


@dataclass(frozen=True)
class _Simulated:
    """What a simulation recorded, shape (outputs, recorded), and derivatives of the states after it."""

    rows: Array
    rates: Array


def _simulated(
    system: FastSystem, component: str, fmu: FastFmu, parameter: str, value: float, gain: float = 0.0
) -> _Simulated | None:
    """A simulation with another value of a parameter, and programmes that are larger by a share; None if it fails."""
    unit = fmu.unit.table.all[parameter].variable.unit
    scenario = system.scenario
    span = scenario.time.start.to("s"), scenario.time.stop.to("s")
    faults = {
        name: dict.fromkeys(part.outputs, (InputChange(gain, *span),))
        for name, part in scenario.components.items()
        if isinstance(part, ProgrammeComponent)
    }
    rows = system.simulate(Changes({component: {parameter: PhysicalValue(value, unit)}}, faults=faults if gain else {}))
    return None if rows is None else _Simulated(rows.values.copy(), _rates(system, component, fmu))


def _rates(system: FastSystem, component: str, fmu: FastFmu) -> Array:
    """Derivatives at a point that has nothing to do with the course."""
    if not fmu.is_model_exchange or not fmu.state_count:
        return np.zeros(0)
    return system.rates(component, system.start / 1e9, np.linspace(0.3, 1.7, fmu.state_count))


def _free(component: str, fmu: FastFmu, name: str, value: float) -> Free:
    own = fmu.unit.table.all[name].variable.unit
    unit = si_unit(own)
    factor, offset = conversion(own, unit)
    parameter = Parameter(f"{component}.{name}", unit, factor * value + offset, USUAL)
    return Free(parameter, component, name)
