"""Runs of a system of FMUs in compiled code in which something of an FMU is another for a while."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass

import numpy as np
import xarray as xr

from cosim.formula import base_unit, to_base
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.models.systems.changeable import why_none
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.placed import Placed
from diagnosis.models.systems.run import dataset, numbers_of, resolved
from diagnosis.recording.units import si_unit

#: 1 from begin to end of the interval, else 0.
_BOX = "(step(time - begin) - step(time - end))"
#: Share of a parameter, and share of its range by which a state would be moved over the recording, tried first.
FIRST_SHARE, FIRST_RISE = 0.05, 0.2


@dataclass(frozen=True)
class Changed:
    """What may be another for a while: a parameter of a Model Exchange FMU, or the derivative of one of its states.

    Args:
        component: Name of the FMU in the scenario.
        name: Of the parameter or state.
        unit: Of the parameter; of the state, whose derivative has it per second.
        stated: Value of the parameter; None of a derivative, to which an amount is added.
        first: Amount that is tried first: a share of the parameter, or the amount in SI base units.
    """

    component: str
    name: str
    unit: str
    stated: float | None
    first: float

    @property
    def is_share(self) -> bool:
        """Whether an amount is a share of what is stated."""
        return self.stated is not None

    @property
    def unit_of_amount(self) -> str:
        """SI unit of an amount; base units where nobody writes another that is as large."""
        own = si_unit(self.unit or "1")
        own = own if to_base(own) == (1.0, 0.0) else base_unit(self.unit)
        return "1" if self.is_share else "1/s" if own == "1" else f"({own})/s"

    @property
    def to(self) -> str:
        """Where it acts, as `added_terms` of a scenario say it."""
        return f"parameter({self.name})" if self.is_share else f"der({self.name})"


class ChangedRuns:
    """Runs of one scenario with one change each; the FMUs stay loaded until `close`.

    A Co-Simulation FMU hides its states and takes no parameter during a run: nothing of it can be changed.

    Args:
        scenario: The system.

    Raises:
        InputError: The scenario is wrong.
        NotFast: It has something that only the co-simulation can do, or nothing of it can be changed.
        CompilerError: There is no C compiler.
    """

    def __init__(self, scenario: Scenario) -> None:
        #: Everything that may be another.
        self.changes = changes_of(scenario)
        if not self.changes:
            raise NotFast("nothing of its FMUs can be another for a while")
        self._system, _ = resolved(scenario, [placed_change(c) for c in self.changes])

    def close(self) -> None:
        """Free the FMUs."""
        self._system.close()

    def results(self, number: int, amount: float, begin: float, end: float) -> xr.Dataset | None:
        """Results with a change from begin to end [s]; None where a unit fails or runs away.

        Args:
            number: Of the change.
            amount: See `Changed.first`.
            begin: [s].
            end: [s].
        """
        try:
            rows = self._system.simulate(laws={number: (amount, begin, end)})
        except (InputError, NotFast):
            return None  # the FMU takes no other value of this parameter
        return None if rows is None else dataset(self._system, rows.values)


def changes_of(scenario: Scenario) -> list[Changed]:
    """Everything of a system that may be another for a while; see `ChangedRuns`."""
    plain, values = resolved(scenario)
    with closing(plain):
        return [c for name in plain.fmus for c in _changes(plain, name, values)]


def placed_change(changed: Changed) -> Placed:
    """A change as a term: its numbers are amount, begin and end [s]."""
    numbers = (("amount", changed.unit_of_amount), ("begin", "s"), ("end", "s"))
    return Placed(changed.component, changed.to, f"amount*{_BOX}", numbers, is_share=changed.is_share)


def _changes(system: FastSystem, component: str, values: Array | None) -> Iterator[Changed]:
    """What of one FMU may be another: parameters that are not 0, and derivatives of states that move.

    Args:
        system: Of one recording.
        component: Name of the FMU.
        values: Recorded of a simulation; None where it stops.
    """
    fmu = system.fmus[component]
    if not fmu.is_model_exchange:
        return
    if not why_none(fmu):
        for name, unit, value in numbers_of(system, component):
            if value != 0.0:
                yield Changed(component, name, unit, value, FIRST_SHARE)
    span = system.times[-1] - system.times[0]
    for state in fmu.states:
        moved = 0.0 if values is None else float(np.ptp(values[:, system.recorded[component, f"state {state}"]]))
        if moved > 0.0 and state in fmu.units:
            unit = fmu.units[state]
            yield Changed(component, state, unit, None, FIRST_RISE * moved * to_base(unit)[0] / span)
