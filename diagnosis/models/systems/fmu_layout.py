"""One FMU of an assembled system as the structure that compiled code steps."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from cosim.fmu.access import Access, address_of
from cosim.fmu.added_terms import unchanging
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.unit import FmuUnit
from cosim.fmu.units import is_known
from cosim.fmu.variables import added_input
from cosim.formula import to_base
from cosim.unit.protocol import Array, Causality
from diagnosis.models.systems.layout import ROOM, AccessLayout, AddedLayout, CopyLayout, Kind, MovedLayout, UnitLayout

#: Parameters of one FMU that may change together, and whose instances stay: an FMU may need much memory.
MOST_MOVED = 8
#: States that the laws of one FMU may have together.
MOST_ADDED = 64


class NotFast(Exception):
    """Compiled code cannot step this system; the text says why."""


class Instances:
    """Instances of an FMU in which a parameter is smaller and larger, as structures.

    Args:
        unit: The FMU.
        parameter: Its parameter.
        inputs: Floating-point inputs of the FMU, all elements.
        count: Its states or outputs, what is more.
    """

    def __init__(self, unit: ModelExchangeUnit, parameter: str, inputs: int, count: int) -> None:
        self._unit, self.moved = unit, unit.moved_parameter(parameter)
        self._held, self._values = np.zeros((2, max(inputs, 1))), np.zeros((2, count))
        self.layout = (MovedLayout * 2)(
            *(
                MovedLayout(i.binding.fmu.component, held.ctypes.data, values.ctypes.data)
                for i, held, values in zip(self.moved.instances, self._held, self._values)
            )
        )

    def begin(self, time: int, parameters: Mapping[str, Any]) -> None:
        """Initialise them as the FMU is, which has its parameters and inputs."""
        for instance in self.moved.instances:
            instance.begin_again()
        self.moved.set_parameters(self._unit, parameters)
        self.moved.begin(self._unit, time)
        self._held.fill(np.nan)  # what they have is written once more before they are asked


class FastFmu:
    """Arrays and addresses of one FMU.

    Args:
        unit: The FMU, assembled.
        far: Quantities of other components that laws may use, by name with their units.

    Raises:
        NotFast: It has something that only the co-simulation can do.
    """

    def __init__(self, unit: FmuUnit, far: Mapping[str, str] | None = None) -> None:
        self.unit, self.name = unit, unit.name
        self.is_model_exchange = isinstance(unit, ModelExchangeUnit)
        if not self.is_model_exchange and not isinstance(unit, CoSimulationUnit):
            raise NotFast(f"{unit.name} runs in a process of its own")
        if not self.is_model_exchange and unit.binding.uses_event_mode:
            raise NotFast(f"{unit.name} is a Co-Simulation FMU with events")
        if isinstance(unit, CoSimulationUnit) and not unit.clocks.is_empty:
            raise NotFast(f"{unit.name} has clocks")
        binding, table = unit.binding, unit.table
        #: Name of an input to the places of its elements among all inputs.
        self.inputs: dict[str, slice] = {}
        begin = 0
        for name in unit.writers:
            variable = table.exposed[name].variable
            if variable.type.dtype != np.float64:
                continue
            self.inputs[name] = slice(begin, begin + variable.size)
            begin += variable.size
        #: Numbers that the FMU is given.
        self.input_count = begin
        #: Inputs that it does not have, with their units, which laws alone see; their places are the last.
        self.added_inputs = {n: table.all[n].variable.unit for n in unit.inputs if n not in unit.writers}
        self.added_inputs |= far or {}
        self.inputs |= {n: slice(begin + i, begin + i + 1) for i, n in enumerate(self.added_inputs)}
        self.outer, self.inner, self.held = (np.zeros(begin + len(self.added_inputs)) for _ in range(3))
        self.writers = [
            binding.writer(table.exposed[n], self.inner[s].reshape(table.exposed[n].variable.shape))
            for n, s in self.inputs.items()
            if n not in self.added_inputs
        ]
        self.readers = [a for a in unit.buffers.group_readers if a.values.dtype == np.float64 and a.is_direct]
        #: Name of an output to its array, which the FMU fills.
        self.outputs = {
            n: unit.buffers.values[n]
            for n, v in unit.variables.items()
            if v.causality in (Causality.OUTPUT, Causality.LOCAL) and v.type.dtype == np.float64
        }
        #: Name of a continuous state to its place, for scalars and elements of arrays.
        self.states = _state_names(unit) if self.is_model_exchange else {}
        self.state_count = len(self.states)
        #: Parameter to the instances in which it is smaller and larger.
        self.instances: dict[str, Instances] = {}
        #: Parameters that the last simulation has moved.
        self.moved: frozenset[str] = frozenset()
        self._build()

    def _build(self) -> None:
        unit, binding, table = self.unit, self.unit.binding, self.unit.table
        description = unit.archive.description
        self.layout = UnitLayout(
            component=binding.fmu.component,
            is_fmi3=binding.prefix == "fmi3",
            is_model_exchange=self.is_model_exchange,
            substeps=1,
            inputs=self.input_count,
        )
        self.indicators = 0
        if self.is_model_exchange:
            self.state_count = int(description.numberOfContinuousStates or 0)
            self.indicators = int(description.numberOfEventIndicators or 0)
            if self.states and len(self.states) != self.state_count:
                self.states = {}
            self._take_functions()
            self.layout.reports_steps = bool(binding.capabilities.needsCompletedIntegratorStep)
        else:
            self.layout.do_step = address_of(binding.step_function)
        self.layout.states, self.layout.indicators = self.state_count, self.indicators
        self._writer_array = (AccessLayout * max(len(self.writers), 1))(*map(_access, self.writers))
        self._reader_array = (AccessLayout * max(len(self.readers), 1))(*map(_access, self.readers))
        self.signs = np.zeros(2 * max(self.indicators, 1))
        self.seen = np.zeros(max(self.state_count, 1))
        names = {n: table.all[n].variable for n in (*self.states, *self.inputs, *self.outputs) if n in table.all}
        known = {n: v for n, v in names.items() if is_known(v.unit)}
        known |= {n: added_input(n, unit).variable for n, unit in self.added_inputs.items()}
        #: Name of what laws may use to its unit.
        self.units = {n: v.unit for n, v in known.items()}
        sources: dict[str, int] = {}
        #: Outputs before laws have added to them, which is what laws see.
        self.seen_outputs = np.zeros(max(len(self.outputs), 1))
        self._own_outputs: list[CopyLayout] = []
        for name, variable in known.items():
            if variable.shape:
                continue
            if name in self.states:
                sources[name] = self.seen.ctypes.data + 8 * self.states[name]
            elif name in self.inputs:
                sources[name] = self.outer.ctypes.data + 8 * self.inputs[name].start
            elif not self.is_model_exchange:
                sources[name] = self._own_output(name)
        self.environment = np.zeros(1 + len(sources))
        #: Name of what laws may use to what stands for it in C.
        self.symbols = {"time": "e[0]", **{n: f"e[{i + 1}]" for i, n in enumerate(sources)}}
        copies = []
        for i, (name, source) in enumerate(sources.items()):
            factor, offset = to_base(self.units[name])
            copies.append(CopyLayout(self.environment.ctypes.data + 8 * (i + 1), source, factor, offset))
        self._known_array = (CopyLayout * max(len(copies), 1))(*copies)
        layout = self.layout
        layout.signs, layout.seen = self.signs.ctypes.data, self.seen.ctypes.data
        layout.outer, layout.inner, layout.held = (a.ctypes.data for a in (self.outer, self.inner, self.held))
        layout.writers, layout.writer_count = ctypes.addressof(self._writer_array), len(self.writers)
        layout.readers, layout.reader_count = ctypes.addressof(self._reader_array), len(self.readers)
        layout.environment = self.environment.ctypes.data
        layout.known, layout.known_count = ctypes.addressof(self._known_array), len(copies)
        self._own_output_array = (CopyLayout * max(len(self._own_outputs), 1))(*self._own_outputs)
        layout.own_outputs, layout.own_output_count = ctypes.addressof(self._own_output_array), len(self._own_outputs)
        #: States of the FMU, those of laws, and room for the integration; its address stays.
        self.state = np.zeros(ROOM * (self.state_count + MOST_ADDED))
        self.set_added([])

    def _own_output(self, name: str) -> int:
        """Where laws see an output as the FMU has it."""
        to = self.seen_outputs.ctypes.data + 8 * len(self._own_outputs)
        self._own_outputs.append(CopyLayout(to, self.outputs[name].ctypes.data, 1.0, 0.0))
        return int(to)

    def _take_functions(self) -> None:
        binding, layout = self.unit.binding, self.layout
        is_fmi3 = binding.prefix == "fmi3"
        names = {
            "set_time": "SetTime",
            "set_states": "SetContinuousStates",
            "get_states": "GetContinuousStates",
            "get_derivatives": "GetContinuousStateDerivatives" if is_fmi3 else "GetDerivatives",
            "get_indicators": "GetEventIndicators",
            "completed": "CompletedIntegratorStep",
            "enter_event_mode": "EnterEventMode",
            "update": "UpdateDiscreteStates" if is_fmi3 else "NewDiscreteStates",
            "enter_continuous_mode": "EnterContinuousTimeMode",
        }
        for field, name in names.items():
            setattr(layout, field, address_of(binding.function(name)))

    def set_added(self, added: Sequence[AddedLayout]) -> None:
        """Laws that act from now on; states of theirs come after those of the FMU."""
        own = 0
        for one in added:
            one.first = own
            own += one.own
        if own > MOST_ADDED:
            raise NotFast(f"laws of {self.name} have {own} states of their own")
        layout = self.layout
        layout.state, layout.own = self.state.ctypes.data, own
        self._added_array = (AddedLayout * max(len(added), 1))(*added)
        layout.added, layout.added_count = ctypes.addressof(self._added_array), len(added)
        layout.has_delays = any(a.delay_count for a in added)
        layout.has_inputs_added = any(a.kind == Kind.INPUT for a in added)
        layout.has_outputs_added = any(a.kind == Kind.OUTPUT for a in added)
        layout.has_parameters_added = any(a.kind == Kind.PARAMETER for a in added)

    def can_add_to(self, name: str) -> bool:
        """Whether it has an input of this name that is one number."""
        own = self.inputs.get(name)
        return own is not None and name not in self.added_inputs and own.stop - own.start == 1

    def check_changeable(self) -> None:
        """Whether its parameters can change during a run.

        Raises:
            NotFast: They cannot.
        """
        problem = unchanging(self.unit.table) if self.is_model_exchange else "it integrates itself"
        if problem:
            raise NotFast(f"no parameter of {self.name} can change: {problem}")

    def moved_parameter(self, name: str) -> Instances:
        """Instances in which a parameter is smaller and larger; the last few stay.

        Raises:
            InputError: No other instance can be made.
        """
        if name in self.instances:
            self.instances[name] = self.instances.pop(name)  # the last one asked for
        else:
            assert isinstance(self.unit, ModelExchangeUnit)
            count = max(self.state_count, sum(a.buffer.size for a in self.readers), 1)
            if len(self.instances) == MOST_MOVED:
                self.instances.pop(next(iter(self.instances))).moved.free()
            self.instances[name] = Instances(self.unit, name, self.input_count, count)
        return self.instances[name]

    def close(self) -> None:
        """Free the instances with other parameters."""
        for instances in self.instances.values():
            instances.moved.free()

    def take_over(self) -> None:
        """Inputs, states and the next event as the initialisation has left them."""
        unit = self.unit
        for name, own in self.inputs.items():
            if name in unit.buffers.values:
                self.outer[own] = np.ravel(unit.buffers.values[name])
        event = None
        if isinstance(unit, ModelExchangeUnit):
            event = unit.next_event
            self.state[: self.state_count] = unit.continuous_states()
        self.layout.next_event = math.inf if event is None else event


def _state_names(unit: FmuUnit) -> dict[str, int]:
    places: Mapping[str, Any] = unit.added.continuous_states()
    found: dict[str, int] = {}
    for name, place in places.items():
        if np.ndim(place) == 0:
            found[name] = int(place)
        else:
            for index, one in np.ndenumerate(place):
                found[f"{name}[{','.join(str(i + 1) for i in index)}]"] = int(one)
    return dict(sorted(found.items(), key=lambda item: item[1]))


def _access(access: Access) -> AccessLayout:
    return AccessLayout(
        address_of(access.call),
        ctypes.addressof(access.references),
        len(access.references),
        access.buffer.ctypes.data,
        access.buffer.size,
    )


def flat_address(array: Array, element: tuple[int, ...] | None) -> tuple[int, int]:
    """Address of the first number and count of numbers of an array, or of one element of it."""
    if element is None or not array.shape:
        return array.ctypes.data, array.size
    return array.ctypes.data + 8 * int(np.ravel_multi_index(element, array.shape)), 1
