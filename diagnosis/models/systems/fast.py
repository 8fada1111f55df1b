"""A scenario of FMUs and programmes, simulated many times in compiled code."""

from __future__ import annotations

import ctypes
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cosim.assemble import Assembly, assemble
from cosim.components import FmuComponent, nanoseconds
from cosim.connection import ConnectionFault, Transfer
from cosim.fmu.unit import FmuUnit
from cosim.fmu.units import is_known
from cosim.fmu.variables import start_value
from cosim.formula import to_base
from cosim.programme import Course, ProgrammeUnit
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array, UnitError
from cosim.unit.quantity import conversion
from diagnosis.models.systems.feedthrough import with_measured_feedthrough
from diagnosis.models.systems.fmu_layout import MOST_MOVED, FastFmu, NotFast, flat_address
from diagnosis.models.systems.layout import (
    MOST_DELAYS,
    AddedLayout,
    Code,
    CopyLayout,
    DelayLayout,
    Kind,
    OperationLayout,
    SampledLayout,
    SystemLayout,
)
from diagnosis.models.systems.placed import Placed, PlacedInput, placed_of
from diagnosis.models.systems.source import compiled
from diagnosis.search.cosim_run import Changes

_KINDS = ("gauss_seidel", "jacobi")


@dataclass(frozen=True)
class Rows:
    """What a simulation gives.

    Args:
        times: Of the outputs [s], shape (outputs,).
        values: Recorded numbers in the units of their variables, shape (outputs, recorded).
    """

    times: Array
    values: Array


class FastSystem:
    """See `simulate`; the FMUs stay loaded and are reset between simulations.

    Args:
        scenario: Programmes and FMUs, under the conditions of a recording.
        laws: Laws that may be added.

    Raises:
        InputError: The scenario is wrong.
        NotFast: It has something that only the co-simulation can do.
        CompilerError: There is no C compiler.
    """

    def __init__(self, scenario: Scenario, laws: Sequence[Placed] = ()) -> None:
        if scenario.algorithm.kind not in _KINDS or getattr(scenario.algorithm, "on_event", "continue") != "continue":
            raise NotFast(f"the algorithm {scenario.algorithm.kind} repeats steps")
        self.scenario = scenario
        self.assembly: Assembly = assemble(scenario)
        self.fmus: dict[str, FastFmu] = {}
        try:
            self._build(laws)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Free the FMUs; safe to call twice."""
        for fmu in self.fmus.values():
            fmu.close()
        self.assembly.system.terminate()

    def _build(self, laws: Sequence[Placed]) -> None:
        self._measure_feedthrough()
        system = self.assembly.system
        self._far = _far_of(laws)
        for name, unit in system.units.items():
            if isinstance(unit, FmuUnit):
                if unit.binding.capabilities.canBeInstantiatedOnlyOncePerProcess:
                    raise NotFast(f"the FMU of {name} can be instantiated only once")
                self.fmus[name] = FastFmu(unit, {i.name: i.unit for i in self._far.get(name, ())})
            elif not isinstance(unit, ProgrammeUnit):
                raise NotFast(f"{name} is no FMU")
        self._order()
        self._grid()
        self._take_laws(laws)

    def _measure_feedthrough(self) -> None:
        """Where declared dependencies make an algebraic loop, ask the FMUs whether there is one."""
        system = self.assembly.system
        if not system.loops:
            return
        try:
            system.initialise(nanoseconds(self.scenario.time.start), self.assembly.start)
        except (UnitError, ConnectionFault) as failed:
            raise NotFast(f"it cannot begin: {failed}") from failed
        self.assembly = replace(self.assembly, system=with_measured_feedthrough(system))
        if self.assembly.system.loops:
            raise NotFast("it has an algebraic loop: outputs of its FMUs follow each other at once")

    # laws

    def _take_laws(self, laws: Sequence[Placed]) -> None:
        given = [
            placed_of(name, entry)
            for name, component in self.scenario.components.items()
            if isinstance(component, FmuComponent)
            for entry in component.added_terms
        ]
        #: Laws that may be added; those that the scenario has already come last.
        self.laws = [*laws, *(placed for placed, _ in given)]
        self._given = {len(laws) + i: values for i, (_, values) in enumerate(given)}
        constants = [{n: repr(in_base(v.number, v.unit)) for n, v in law.constants.items()} for law in self.laws]
        self._compiled = compiled(self.laws, {n: f.symbols for n, f in self.fmus.items()}, constants)
        self._values = [np.zeros(max(len(law.numbers), 1)) for law in self.laws]
        self._bases = [[to_base(unit) for _, unit in law.numbers] for law in self.laws]
        self._histories: dict[tuple[str, int], Array] = {}
        self._kept: list[tuple[ctypes.Array[DelayLayout], Array]] = []
        self._added = [self._added_of(n, law) for n, law in enumerate(self.laws)]

    def _added_of(self, number: int, law: Placed) -> AddedLayout:
        fmu = self.fmus[law.component]
        if law.to.startswith("der("):
            name, kind = law.to[4:-1], Kind.SHARE if law.is_share else Kind.RATE
            if name not in fmu.states:
                raise NotFast(f"{law.component} has no state {name}")
            target = fmu.states[name]
        elif law.parameter:
            name, kind, target = law.parameter, Kind.PARAMETER, 0
        elif law.to in fmu.outputs:
            name, kind, target = law.to, Kind.OUTPUT, 0
            if fmu.outputs[name].size != 1:
                raise NotFast(f"a term at the output {name} of {law.component} is simulated by the co-simulation alone")
        else:
            name, kind = law.to, Kind.INPUT
            if not fmu.can_add_to(name):
                raise NotFast(f"{law.component} has no input {name}")
            target = fmu.inputs[name].start
        scale = 1.0 if kind in (Kind.SHARE, Kind.PARAMETER) else 1.0 / to_base(fmu.units[name])[0]
        delays, delayed = self._delays(number, law)
        found = AddedLayout(
            kind=kind,
            target=target,
            scale=scale,
            own=len(law.states),
            values=self._values[number].ctypes.data,
            amount=self._compiled.address(f"law_{number}_amount"),
            delay_count=len(law.delays),
            delays=ctypes.addressof(delays),
            delayed=delayed.ctypes.data,
        )
        if kind is Kind.OUTPUT:
            found.output = fmu.outputs[name].ctypes.data
        if kind is Kind.PARAMETER:
            fmu.check_changeable()
        for i in range(len(law.states)):
            found.rates[i] = self._compiled.address(f"law_{number}_rate_{i}")
            found.starts[i] = self._compiled.address(f"law_{number}_start_{i}")
        return found

    def _delays(self, number: int, law: Placed) -> tuple[ctypes.Array[DelayLayout], Array]:
        """Delayed inputs of a law, and room for their values; both stay."""
        fmu = self.fmus[law.component]
        delays, delayed = (DelayLayout * MOST_DELAYS)(), np.zeros(MOST_DELAYS)
        names = [name for name, _ in law.numbers]
        if len(law.delays) > MOST_DELAYS:
            raise NotFast(f"a term at {law.component} has more than {MOST_DELAYS} delayed inputs")
        for i, delay in enumerate(law.delays):
            own = fmu.inputs.get(delay.of)
            if own is None or own.stop - own.start != 1:
                raise NotFast(f"{law.component} has no input {delay.of}")
            factor, offset = to_base(fmu.units[delay.of])
            delays[i].input, delays[i].factor, delays[i].offset = own.start, factor, offset
            delays[i].by = self._values[number].ctypes.data + 8 * names.index(delay.by)
            delays[i].history = self._history(law.component, own.start).ctypes.data
        self._kept.append((delays, delayed))
        return delays, delayed

    def _history(self, component: str, place: int) -> Array:
        """Room for an input in every macro-step."""
        return self._histories.setdefault((component, place), np.zeros(self.steps + 1))

    # order of a macro-step

    def _order(self) -> None:
        system = self.assembly.system
        self._numbers = {name: i for i, name in enumerate(self.fmus)}
        self._copies: list[CopyLayout] = []
        self._far_copies: list[CopyLayout] = []
        self._sources = self._programme_arrays()
        settle = []
        for action in system.propagation.actions:
            owner: Any = getattr(action, "__self__", None)
            if isinstance(owner, Transfer):
                settle += self._transfer(owner)
            elif isinstance(owner, FmuUnit):
                settle.append(OperationLayout(Code.GET, self._numbers[owner.name], 0))
            else:
                raise NotFast("something of its order is no transfer")
        far = {name: self._far_transfer(name) for name in self.fmus if name in self._far}
        for name in (n for n in far if any(self.fmus[n].unit.feedthrough.values())):  # outputs that follow them at once
            settle = [*far[name], OperationLayout(Code.GET, self._numbers[name], 0), *settle]
        operations = list(settle)
        if self.scenario.algorithm.kind == "jacobi":
            for transfer in system.unsettled:
                operations += self._transfer(transfer)
            operations += [o for own in far.values() for o in own]
            operations += [OperationLayout(Code.STEP, self._numbers[n], 0) for n in system.movers]
        else:
            for name in system.movers:
                for transfer in system.transfers[name]:
                    operations += self._transfer(transfer)
                operations += far.get(name, [])
                operations.append(OperationLayout(Code.STEP, self._numbers[name], 0))
        self._settle = (OperationLayout * max(len(settle), 1))(*settle)
        self._operations = (OperationLayout * max(len(operations), 1))(*operations)
        self._counts = len(settle), len(operations)
        self._copy_array = (CopyLayout * max(len(self._copies), 1))(*self._copies)

    def _programme_arrays(self) -> dict[tuple[str, str], Array]:
        """Value of every output of a programme now."""
        return {
            (name, output): np.zeros(max(int(np.prod(course.values.shape[1:])), 1))
            for name, unit in self.assembly.system.units.items()
            if isinstance(unit, ProgrammeUnit)
            for output, course in unit.courses.items()
        }

    def _transfer(self, transfer: Transfer) -> list[OperationLayout]:
        target, name = transfer.end
        fmu = self.fmus[target]
        if name not in fmu.inputs:
            raise NotFast(f"{target}.{name} is no floating-point number of double precision")
        own = fmu.inputs[name]
        shape = transfer.variable.shape
        begin = len(self._copies)
        for part in transfer.parts:
            connection = part.connection
            source, variable = connection.source
            array = self._sources.get((source, variable))
            if array is None and source in self.fmus:
                array = self.fmus[source].outputs.get(variable)
            if array is None:
                raise NotFast(f"{source}.{variable} is no floating-point number of double precision")
            if (source, variable) in self._sources:
                shaped = array.reshape(part.source.variables[variable].shape)
            else:
                shaped = array
            address, count = flat_address(shaped, connection.source_element)
            element = connection.target_element
            first = own.start + (0 if element is None or not shape else int(np.ravel_multi_index(element, shape)))
            wanted = 1 if element is not None else own.stop - own.start
            for i in range(wanted):
                to = fmu.outer.ctypes.data + 8 * (first + i)
                self._copies.append(
                    CopyLayout(to, address + 8 * (i if count > 1 else 0), connection.factor, connection.offset)
                )
        return [
            OperationLayout(Code.COPY, begin, len(self._copies)),
            OperationLayout(Code.PUT, self._numbers[target], 0),
        ]

    def _far_transfer(self, name: str) -> list[OperationLayout]:
        """What carries quantities of other components to the laws of one."""
        fmu, begin = self.fmus[name], len(self._copies)
        for far in self._far[name]:
            factor, offset = conversion(self._unit_of(far.of), far.unit)
            to = fmu.outer.ctypes.data + 8 * fmu.inputs[far.name].start
            self._far_copies.append(CopyLayout(to, self._address_of(far.of), factor, offset))
        self._copies += self._far_copies[-len(self._far[name]) :]
        return [
            OperationLayout(Code.COPY, begin, len(self._copies)),
            OperationLayout(Code.PUT, self._numbers[name], 0),
        ]

    def _address_of(self, of: str) -> int:
        """Where `component.variable` stands: an output that is one number, or a state."""
        component, _, name = of.partition(".")
        array = self._sources.get((component, name))
        if array is None and component in self.fmus:
            fmu = self.fmus[component]
            if name in fmu.states:
                return int(fmu.state.ctypes.data + 8 * fmu.states[name])
            array = fmu.outputs.get(name)
        if array is None or array.size != 1:
            raise NotFast(f"{of} is not one floating-point number of double precision")
        return int(array.ctypes.data)

    def _unit_of(self, of: str) -> str:
        component, _, name = of.partition(".")
        unit = self.assembly.system.units[component]
        return unit.table.all[name].variable.unit if isinstance(unit, FmuUnit) else unit.variables[name].unit

    # time grid and records

    def _grid(self) -> None:
        time = self.scenario.time
        start, stop, size, output = (nanoseconds(t) for t in (time.start, time.stop, time.macro_step, time.output_step))
        steps = round((stop - start) / size)
        self.per_output = max(1, round(output / size))
        self.start, self.size, self.steps = start, size, steps
        outputs = steps // self.per_output + 1
        #: Times of the outputs [s].
        self.times: Array = (start + size * self.per_output * np.arange(outputs)) / 1e9
        #: Begins of the macro-steps [s].
        self._begins: Array = (start + size * np.arange(steps)) / 1e9
        self._columns = {key: self._column(key) for key in self._sources}
        self.recorded: dict[tuple[str, str], slice] = {}
        addresses: list[int] = []

        def record(key: tuple[str, str], address: int, count: int) -> None:
            self.recorded[key] = slice(len(addresses), len(addresses) + count)
            addresses.extend(address + 8 * i for i in range(count))

        for name, fmu in self.fmus.items():
            for output_name, array in fmu.outputs.items():
                record((name, output_name), array.ctypes.data, array.size)
        for key, array in self._sources.items():
            record(key, array.ctypes.data, array.size)
        for name, fmu in self.fmus.items():
            for input_name, own in fmu.inputs.items():
                record((name, f"input {input_name}"), fmu.outer.ctypes.data + 8 * own.start, own.stop - own.start)
            for state, place in fmu.states.items():
                record((name, f"state {state}"), fmu.state.ctypes.data + 8 * place, 1)
        self._addresses = (ctypes.c_void_p * max(len(addresses), 1))(*addresses)
        self._rows = np.zeros((outputs, len(addresses)))

    def _column(self, key: tuple[str, str]) -> Array:
        """Value in every macro-step, shape (steps, elements), contiguous by element."""
        unit = self.assembly.system.units[key[0]]
        assert isinstance(unit, ProgrammeUnit)
        return samples(unit.courses[key[1]], self.start, self.size, self.steps)

    def give(self, courses: Mapping[tuple[str, str], Course]) -> dict[tuple[str, str], Course]:
        """Let outputs of programmes have other courses in all simulations from now on.

        Args:
            courses: Component and output to what it gives, in its own unit.

        Returns:
            What they gave before; giving it again undoes this.
        """
        before = {}
        for (component, output), course in courses.items():
            unit = self.assembly.system.units[component]
            assert isinstance(unit, ProgrammeUnit)
            before[component, output] = unit.courses[output]
            unit.courses[output] = course
            self._columns[component, output] = self._column((component, output))
        return before

    def set_substeps(self, count: int) -> None:
        """Steps of the integration in each macro-step."""
        for fmu in self.fmus.values():
            fmu.layout.substeps = count

    def simulate(
        self, changes: Changes | None = None, laws: Mapping[int, Sequence[float]] | None = None
    ) -> Rows | None:
        """One simulation.

        Args:
            changes: Parameters and programmes that differ.
            laws: Numbers of laws that act, with the values of their numbers in their units.

        Returns:
            What was recorded, valid until the next simulation; None where a unit failed or a number is not finite.
        """
        changes = changes or Changes()
        acting = {**self._given, **(laws or {})}
        try:
            self._initialise(changes, acting)
        except (UnitError, InputError, ConnectionFault):
            return None
        self._set_laws(acting)
        columns = {key: self._changed_column(key, changes) for key in self._columns}
        sampled = []
        for key, values in columns.items():
            array = self._sources[key]
            array[:] = np.ravel(self.assembly.system.units[key[0]].get(key[1]))
            for i in range(array.size):
                sampled.append(SampledLayout(array.ctypes.data + 8 * i, values[i].ctypes.data))
        self._shift_start(changes)
        for fmu in self.fmus.values():
            fmu.take_over()
        for copy in self._far_copies:  # what laws have of other components before the first exchange
            value = copy.factor * ctypes.c_double.from_address(copy.source).value + copy.offset
            ctypes.c_double.from_address(copy.to).value = value
        programmes = (SampledLayout * max(len(sampled), 1))(*sampled)
        units = self._unit_array()
        layout = SystemLayout(
            ctypes.addressof(units),
            len(self.fmus),
            ctypes.addressof(self._copy_array),
            ctypes.addressof(self._settle),
            self._counts[0],
            ctypes.addressof(self._operations),
            self._counts[1],
            ctypes.addressof(programmes),
            len(sampled),
            ctypes.addressof(self._addresses),
            self._rows.shape[1],
            self._rows.ctypes.data,
            self.steps,
            self.per_output,
            self.start,
            self.size,
        )
        done = self._compiled.library.system_run(ctypes.addressof(layout))
        for fmu in self.fmus.values():
            fmu.unit.binding.messages.clear()
        if done < self.steps or not np.isfinite(self._rows).all():
            return None
        return Rows(self.times, self._rows)

    def _unit_array(self) -> Any:
        kind = type(next(iter(self.fmus.values())).layout)
        return (kind * len(self.fmus))(*(f.layout for f in self.fmus.values()))

    def _initialise(self, changes: Changes, laws: Collection[int]) -> None:
        system = self.assembly.system
        moved: dict[str, dict[str, Any]] = {}
        for name, fmu in self.fmus.items():
            own: dict[str, Any] = {**changes.parameters.get(name, {}), **changes.lists.get(name, {})}
            back = {n: self.parameter(name, n) for n in fmu.moved if n not in own}
            fmu.moved = frozenset(own)
            moved[name] = {**back, **own}
            fmu.unit.begin_again(moved[name])
        system.initialise(self.start, self.assembly.start)
        changing = [self.laws[n].component for n in laws if self.laws[n].parameter]
        for name in set(changing):
            if changing.count(name) > MOST_MOVED:
                raise UnitError(name, f"more than {MOST_MOVED} of its parameters change at once")
        for number in laws:
            law = self.laws[number]
            if law.parameter:
                instances = self.fmus[law.component].moved_parameter(law.parameter)
                instances.begin(self.start, moved[law.component])
                self._added[number].moved = ctypes.addressof(instances.layout)

    def parameter(self, component: str, name: str) -> Any:
        """What the scenario, its parameter set or the FMU says of a parameter."""
        resolved = self.assembly.parameters[component].values
        if name in resolved:
            return resolved[name]
        fmu = self.fmus[component].unit
        variable = fmu.table.all[name]
        start = variable.variable.start if variable.variable.start is not None else None
        if start is None:
            start = start_value(variable.declared, variable.variable.type, variable.variable.shape)
        return np.asarray(start).tolist()

    def _shift_start(self, changes: Changes) -> None:
        """Programmes that are moved are moved at the start too."""
        for name, own in changes.shifts.items():
            for output, amount in own.items():
                self._sources[name, output] += amount

    def _changed_column(self, key: tuple[str, str], changes: Changes) -> Array:
        values = self._columns[key]
        shift = changes.shifts.get(key[0], {}).get(key[1], 0.0)
        if shift:
            values = values + shift
        stated = values
        for fault in changes.faults.get(key[0], {}).get(key[1], ()):
            first, last = np.searchsorted(self._begins, (fault.begin - self.size / 1e9, fault.end))
            part = slice(max(int(first) - 1, 0), int(last) + 1)  # one step more on either side, whose share is nothing
            if part.start >= len(self._begins):
                continue  # after the last step
            values = values.copy() if values is stated else values
            shares = fault.shares(self._begins[part], self.size / 1e9)
            values[:, part] += fault.change(stated[:, part].T, shares, np.abs(stated).max(axis=1)).T
        return np.ascontiguousarray(values)

    def _set_laws(self, laws: Mapping[int, Sequence[float]]) -> None:
        added: dict[str, list[AddedLayout]] = {name: [] for name in self.fmus}
        for number, values in laws.items():
            own = self._values[number]
            for i, (value, (factor, offset)) in enumerate(zip(values, self._bases[number])):
                own[i] = factor * value + offset
            added[self.laws[number].component].append(self._added[number])
        for name, fmu in self.fmus.items():
            fmu.set_added(added[name])

    def outputs_at(self, component: str, time: float, states: Array) -> tuple[Array, dict[str, float]]:
        """Derivatives of a Model Exchange FMU's states and its scalar outputs at a point, after a simulation."""
        fmu = self.fmus[component]
        rates = self.rates(component, time, states)
        for read in fmu.readers:
            read()
        return rates, {n: float(a.item()) for n, a in fmu.outputs.items() if a.size == 1}

    def rates_at(self, component: str, points: Array) -> Array:
        """Derivatives at points of the states at the start, after a simulation, shape (points, states)."""
        return np.array([self.rates(component, self.start / 1e9, p) for p in points])

    def rates(self, component: str, time: float, states: Array) -> Array:
        """Derivatives of a Model Exchange FMU's states at a point, shape (states,), after a simulation."""
        fmu = self.fmus[component]
        given, found = np.ascontiguousarray(states, dtype=np.float64), np.zeros(len(states))
        status = self._compiled.library.system_rates(
            ctypes.addressof(fmu.layout), time, given.ctypes.data, found.ctypes.data
        )
        return found if status == 0 else np.full(len(states), np.nan)


def _far_of(laws: Sequence[Placed]) -> dict[str, tuple[PlacedInput, ...]]:
    """Component to the quantities of others that its laws use, each once."""
    found: dict[str, dict[str, PlacedInput]] = {}
    for law in laws:
        for far in law.inputs:
            found.setdefault(law.component, {})[far.name] = far
    return {name: tuple(own.values()) for name, own in found.items()}


def samples(course: Course, start: int, size: int, steps: int) -> Array:
    """Values of a programme in every macro-step, shape (elements, steps): see `cosim.programme.ProgrammeUnit`."""
    begins = start + size * np.arange(steps, dtype=np.float64)
    times = np.asarray(course.times, dtype=np.float64)
    values = course.values.reshape(len(times), -1)
    if course.is_linear:
        return np.ascontiguousarray([np.interp(begins + 0.5 * size, times, v) for v in values.T])
    place = np.maximum(np.searchsorted(times, begins, side="right") - 1, 0)
    return np.ascontiguousarray(values[place].T)


def in_base(value: float, unit: str) -> float:
    """A number in SI base units; as it is where its unit is none that is known."""
    if not is_known(unit):
        return value
    factor, offset = to_base(unit)
    return factor * value + offset
