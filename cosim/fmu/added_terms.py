"""Terms that the master adds to an FMU of somebody else: to derivatives, inputs, outputs, and shares of parameters."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from cosim.fmu.access import Access
from cosim.fmu.binding import Binding
from cosim.fmu.delays import INSTANT, DelayedInput, DelayedInputs
from cosim.fmu.moved_parameter import MovedParameter
from cosim.fmu.settings import AddedDelay, AddedState, AddedTerm, Table
from cosim.fmu.units import is_known
from cosim.fmu.variables import FmuVariable
from cosim.formula import Formula, FormulaError, to_base
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array, Causality, UnitError
from cosim.unit.quantity import PhysicalValue, parse_unit

_DERIVATIVE = re.compile(r"^der\((?P<state>.+)\)$")
_PARAMETER = re.compile(r"^parameter\((?P<parameter>.+)\)$")
_TIME = "time"


@dataclass
class _Term:
    """One term, ready to be evaluated.

    Args:
        target: Name of the state, input, output or parameter.
        formula: Its formula.
        parameters: In SI base units.
        factor: From SI base units to those of the target.
        own: Its own states, where it has some.
        delayed: Inputs as they were some time ago.
        is_share: Whether it is a share of the derivative as the FMU has it, or of the parameter.
    """

    target: str
    formula: Formula
    parameters: Mapping[str, AnyArray]
    factor: float
    own: OwnStates | None = None
    delayed: Delayed = field(default_factory=lambda: Delayed({}, {}))
    is_share: bool = False

    def amount(self, values: Mapping[str, AnyArray]) -> Any:
        """What is added, in the unit of the target; a share as it is."""
        own = {} if self.own is None else self.own.values
        known = {**self.parameters, **own, **self.delayed.values, **values}
        return self.factor * np.asarray(self.formula.value(known))

    @property
    def names(self) -> set[str]:
        """Names that its formulas use."""
        own = self.own.names if self.own is not None else set()
        return self.formula.names | own | {d.of for d in self.delayed.inputs.values()}


@dataclass
class Delayed:
    """Delayed inputs of one term.

    Args:
        inputs: Name in the formulas to the delayed input.
        bases: The same to factor and offset to SI base units.
    """

    inputs: Mapping[str, DelayedInput]
    bases: Mapping[str, tuple[float, float]]

    @property
    def values(self) -> dict[str, AnyArray]:
        """What they are now, in SI base units."""
        return {n: self.bases[n][0] * d.value + self.bases[n][1] for n, d in self.inputs.items()}


class OwnStates:
    """States of one term, in SI base units.

    Args:
        rates: Name to the formula of its derivative.
        starts: Name to the formula of its value at the start.
        parameters: Of the term, SI base units.
        delayed: Delayed inputs of the term.
    """

    def __init__(
        self,
        rates: Mapping[str, Formula],
        starts: Mapping[str, Formula],
        parameters: Mapping[str, AnyArray],
        delayed: Delayed,
    ) -> None:
        self._rates, self._starts, self._parameters, self._delayed = rates, starts, parameters, delayed
        #: Name to its value now.
        self.values: dict[str, AnyArray] = {name: np.zeros(()) for name in rates}

    @property
    def names(self) -> set[str]:
        """Names that its formulas use."""
        return {n for f in (*self._rates.values(), *self._starts.values()) for n in f.names}

    def start(self, environment: Mapping[str, AnyArray]) -> Array:
        """Values at the start, shape (states,)."""
        known = {**self._parameters, **self._delayed.values, **environment}
        return np.array([float(f.value(known)) for f in self._starts.values()])

    def take(self, values: Array) -> None:
        """Set them, shape (states,)."""
        for name, value in zip(self.values, values.tolist()):
            self.values[name] = np.asarray(value)

    def rates(self, environment: Mapping[str, AnyArray]) -> Array:
        """Their derivatives, shape (states,)."""
        known = {**self._parameters, **self.values, **self._delayed.values, **environment}
        return np.array([float(f.value(known)) for f in self._rates.values()])


@dataclass
class AddedTerms:
    """The terms of one FMU, by what they are added to.

    Args:
        name: Name of the unit.
        table: Its variables.
        is_model_exchange: Whether the master integrates it.

    Raises:
        InputError: A target or a name does not exist, units do not agree, or a derivative is not the master's.
    """

    name: str
    table: Table
    is_model_exchange: bool
    derivatives: list[_Term] = field(default_factory=list)
    inputs: list[_Term] = field(default_factory=list)
    outputs: list[_Term] = field(default_factory=list)
    parameters: list[_Term] = field(default_factory=list)

    def __post_init__(self) -> None:
        #: State to the places of its elements among the continuous states, shape of the variable.
        self.states: dict[str, AnyArray] = {}
        self._units = {_TIME: "s"}
        #: Time that outputs belong to [s].
        self.time = 0.0
        #: States of terms, one after the other in the order of the terms.
        self.owners: list[OwnStates] = []
        #: Delayed inputs of all terms.
        self.delayed = DelayedInputs()
        #: Parameter that a term changes to the instances that tell what that does; the unit makes them.
        self.moved: dict[str, MovedParameter] = {}
        #: Time and states where the FMU stands at a communication point; None: it is being initialised.
        self.where: Callable[[], tuple[float, Array] | None] = lambda: None
        if not self.table.settings.added_terms:
            return
        if self.is_model_exchange:
            self.states = self._states()
        self._units |= {
            n: v.variable.unit
            for n, v in self.table.all.items()
            if v.variable.type.is_float and (n in self.table.exposed or n in self.states) and is_known(v.variable.unit)
        }
        self._bases = {n: to_base(u) for n, u in self._units.items()}
        for number, given in enumerate(self.table.settings.added_terms):
            self._add(given, f"{self.name}.added_terms[{number}]")

    @property
    def is_empty(self) -> bool:
        """Whether there is none."""
        return not (self.derivatives or self.inputs or self.outputs or self.parameters)

    def continuous_states(self) -> dict[str, AnyArray]:
        """State to the places of its elements among the continuous states; empty where the FMU does not say."""
        return self.states or self._states()

    def _states(self) -> dict[str, AnyArray]:
        places: dict[str, dict[int, int]] = {}
        arrays: dict[str, AnyArray] = {}
        begin = 0
        owner = {id(d): (n, i) for n, v in self.table.all.items() for i, d in enumerate(v.declared)}
        for unknown in self.table.archive.description.derivatives:
            name, element = owner.get(id(unknown.variable.derivative), ("", 0))
            if not name:
                return {}  # the description does not say whose derivative it is
            variable = self.table.all[name]
            if len(variable.declared) == 1:
                arrays[name] = np.arange(begin, begin + variable.variable.size).reshape(variable.variable.shape)
                begin += variable.variable.size
            else:
                places.setdefault(name, {})[element] = begin
                begin += 1
        for name, by_element in places.items():
            shape = self.table.all[name].variable.shape
            if len(by_element) == math.prod(shape):
                arrays[name] = np.array([by_element[i] for i in sorted(by_element)]).reshape(shape)
        return arrays

    def _add(self, given: AddedTerm, key: str) -> None:
        match, changed = _DERIVATIVE.match(given.to), _PARAMETER.match(given.to)
        target = match["state"] if match else changed["parameter"] if changed else given.to
        unit = (
            self._parameter_unit(given, target, key) if changed else self._target_unit(given, target, bool(match), key)
        )
        units = dict(self._units)
        parameters = {}
        for name, value in given.parameters.items():
            if name in units:
                raise InputError(
                    self.table.archive.path,
                    f"{key}.parameters.{name}",
                    "a variable of the FMU has this name",
                    "choose another one",
                )
            units[name] = value.unit or "1"
            factor, offset = to_base(units[name])
            parameters[name] = np.asarray(factor * value.number + offset)
        delayed = self._delayed_inputs(given, units, parameters, key)
        own = self._own_states(given, units, parameters, delayed, key)
        if given.is_share and not (match or changed):
            raise InputError(
                self.table.archive.path,
                f"{key}.is_share",
                f"`{target}` is no derivative or parameter, of which a term may be a share",
                "leave it out, or add to der(state) or parameter(name)",
            )
        try:
            formula = Formula(given.formula, units, "1" if given.is_share else f"({unit})/s" if match else unit)
        except FormulaError as error:
            raise InputError(self.table.archive.path, f"{key}.formula", str(error), "correct the formula") from error
        factor = 1.0 if given.is_share else 1.0 / to_base(unit)[0]
        term = _Term(target, formula, parameters, factor, own, delayed, given.is_share)
        if changed:
            self.parameters.append(term)
        elif match:
            self.derivatives.append(term)
        elif self.table.all[target].variable.causality is Causality.INPUT:
            self.inputs.append(term)
        else:
            self.outputs.append(term)

    def _delayed_inputs(
        self, given: AddedTerm, units: dict[str, str], parameters: Mapping[str, AnyArray], key: str
    ) -> Delayed:
        """Delayed inputs of a term, whose names `units` has afterwards."""
        path = self.table.archive.path
        inputs = [
            n
            for n in self._units
            if n in self.table.exposed and self.table.all[n].variable.causality is Causality.INPUT
        ]
        found: dict[str, DelayedInput] = {}
        for name, delay in given.delays.items():
            where = f"{key}.delays.{name}"
            if name in units:
                raise InputError(path, where, "a variable or a parameter has this name", "choose another one")
            if delay.of not in inputs:
                raise InputError(
                    path,
                    f"{where}.of",
                    f"the FMU has no floating-point input `{delay.of}`",
                    f"it has: {', '.join(inputs) or 'none'}",
                )
            if delay.by not in parameters:
                raise InputError(
                    path,
                    f"{where}.by",
                    f"the term has no parameter `{delay.by}`",
                    f"it has: {', '.join(parameters) or 'none'}",
                )
            time = float(parameters[delay.by])
            if parse_unit(units[delay.by]).dimensionality != parse_unit("s").dimensionality or not time >= 0.0:
                raise InputError(path, f"{key}.parameters.{delay.by}", "it is no delay", "give a time of 0 s or longer")
            found[name] = DelayedInput(delay.of, time, functools.partial(self._input, delay.of))
        units |= {name: self._units[delay.of] for name, delay in given.delays.items()}
        self.delayed.take(found.values())
        return Delayed(found, {name: self._bases[d.of] for name, d in found.items()})

    def _input(self, name: str) -> AnyArray:
        """An input as it was given from outside."""
        return self._outside[name]

    def _own_states(
        self,
        given: AddedTerm,
        units: dict[str, str],
        parameters: Mapping[str, AnyArray],
        delayed: Delayed,
        key: str,
    ) -> OwnStates | None:
        """States of a term, whose names `units` has afterwards."""
        path = self.table.archive.path
        known = dict(units)
        for name, state in given.states.items():
            if name in units:
                raise InputError(
                    path, f"{key}.states.{name}", "a variable or a parameter has this name", "choose another one"
                )
            if not is_known(state.unit):
                raise InputError(
                    path,
                    f"{key}.states.{name}.unit",
                    f"`{state.unit}` is not a unit that is known here",
                    "write it as in `m/s^2`",
                )
        units |= {name: state.unit for name, state in given.states.items()}
        rates, starts = {}, {}
        for name, state in given.states.items():
            try:
                rates[name] = Formula(state.rate, units, f"({state.unit})/s")
                starts[name] = Formula(state.start, known, state.unit)
            except FormulaError as error:
                raise InputError(path, f"{key}.states.{name}", str(error), "correct the formula") from error
        if not given.states:
            return None
        own = OwnStates(rates, starts, parameters, delayed)
        self.owners.append(own)
        return own

    @property
    def own_count(self) -> int:
        """Number of states of terms."""
        return sum(len(o.values) for o in self.owners)

    def start_own(self, time: float, states: Array | None) -> Array:
        """States of terms at the start, shape (own_count,), SI base units; they are taken, and delays begin."""
        self.delayed.begin()
        if not self.owners:
            return np.zeros(0)
        self._read()
        environment = self._environment(time, states)
        found = [owner.start(environment) for owner in self.owners]
        values = np.concatenate(found) if found else np.zeros(0)
        self.take_own(values)
        return values

    def take_own(self, values: Array) -> None:
        """Set the states of terms, shape (own_count,)."""
        begin = 0
        for owner in self.owners:
            owner.take(values[begin : begin + len(owner.values)])
            begin += len(owner.values)

    @property
    def own_values(self) -> Array:
        """States of terms, shape (own_count,)."""
        return np.array([float(v) for owner in self.owners for v in owner.values.values()])

    def own_rates(self, time: float, states: Array | None) -> Array:
        """Their derivatives, shape (own_count,)."""
        self._read()
        environment = self._environment(time, states)
        return np.concatenate([owner.rates(environment) for owner in self.owners])

    def step_own(self, time: float, size: float) -> None:
        """Advance the states of terms beside a Co-Simulation FMU, whose inputs and outputs are held over the step.

        The classical Runge-Kutta method (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, Springer
        1993, section II.1).
        """
        if not self.owners:
            return
        begin: Array = self.own_values
        slopes: list[Array] = []
        for share in (0.0, 0.5, 0.5, 1.0):
            self.take_own(begin + (share * size * slopes[-1] if slopes else 0.0))
            slopes.append(self.own_rates(time, None))
        one, two, three, four = slopes
        end = begin + size / 6.0 * (one + 2.0 * (two + three) + four)
        if not np.isfinite(end).all():
            raise UnitError(self.name, "a state of an added term is not a finite number")
        self.take_own(end)

    def _target_unit(self, given: AddedTerm, target: str, is_derivative: bool, key: str) -> str:
        """Unit of the state, input or output that a term is added to."""
        where = self.table.archive.path, f"{key}.to"
        if is_derivative:
            if not self.is_model_exchange:
                raise InputError(
                    *where,
                    "its own solver integrates this FMU, nobody else sees its derivatives",
                    "use `integrator: cvode`, or add to an input or output",
                )
            if target not in self.states:
                raise InputError(
                    *where, f"the FMU has no continuous state `{target}`", f"it has: {', '.join(self.states) or 'none'}"
                )
            return self._units[target]
        ports = [n for n in self._units if n in self.table.exposed and not self.table.all[n].is_added]
        if target not in ports:
            raise InputError(
                *where,
                f"the FMU has no floating-point input or output `{target}`",
                f"it has: {', '.join(ports)}; a derivative is written der(state)",
            )
        return self._units[target]

    def _parameter_unit(self, given: AddedTerm, target: str, key: str) -> str:
        """Unit of the parameter that a term changes; what cannot be is refused."""
        where = self.table.archive.path, f"{key}.to"
        if not self.is_model_exchange:
            raise InputError(
                *where,
                "its own solver integrates this FMU, with parameters that stay as they were set",
                "use `integrator: cvode`, or add to an input or output",
            )
        names = [n for n, v in self.table.all.items() if is_changeable(v)]
        if target not in names:
            raise InputError(
                *where,
                f"the FMU has no floating-point parameter `{target}` that is one number",
                f"it has: {', '.join(names) or 'none'}",
            )
        problem = unchanging(self.table)
        if problem:
            raise InputError(*where, f"no parameter of this FMU can change: {problem}", "leave the term out")
        if not self.table.value_of(target):
            raise InputError(*where, f"`{target}` is 0, and a share of that is nothing", "give it another value")
        if any(t.target == target for t in self.parameters):
            raise InputError(*where, f"two terms change `{target}`", "write them as one")
        if not given.is_share:
            raise InputError(
                self.table.archive.path,
                f"{key}.is_share",
                "what changes a parameter is a share of its value",
                "write `is_share: true`, and a formula that is a pure number",
            )
        return "1"

    def bind(self, binding: Binding, values: Mapping[str, AnyArray]) -> None:
        """Connect to an instance; `values` are its inputs (as given from outside) and outputs."""
        self._outside = values
        #: Outputs that terms add to, as the FMU has them: what formulas see.
        self._own_outputs = {t.target: np.zeros(self.table.all[t.target].variable.shape) for t in self.outputs}
        self._own_output_readers = [binding.reader(self.table.all[n], v) for n, v in self._own_outputs.items()]
        used = {n for t in (*self.derivatives, *self.inputs, *self.parameters) for n in t.names}
        self._inner: dict[str, AnyArray] = {}
        self._readers: list[Access] = []
        self._writers: dict[str, tuple[Access, AnyArray]] = {}
        for name in used & set(self._units) - set(self.states) - {_TIME}:
            variable = self.table.all[name]
            if variable.variable.causality is not Causality.INPUT and self.is_model_exchange:
                self._inner[name] = np.zeros(variable.variable.shape)
                self._readers.append(binding.reader(variable, self._inner[name]))
        #: States that terms at outputs use, at a communication point; nobody else reads them there.
        self._states_there: dict[str, AnyArray] = {}
        self._state_readers: list[Access] = []
        for name in {n for t in (*self.outputs, *self.parameters) for n in t.names} & set(self.states) - set(values):
            self._states_there[name] = np.zeros(self.table.all[name].variable.shape)
            self._state_readers.append(binding.reader(self.table.all[name], self._states_there[name]))
        for term in self.inputs:
            own = np.zeros(self.table.all[term.target].variable.shape)
            self._writers[term.target] = binding.writer(self.table.all[term.target], own), own
        inputs = [
            n for n, v in self.table.exposed.items() if v.variable.causality is Causality.INPUT and not v.is_added
        ]
        #: Inputs as the FMU has them, and outputs that may hold a parameter.
        self._held = {n: self._writers[n][1] if n in self._writers else values[n] for n in inputs}
        self._changeable_outputs = [
            n
            for n, v in self.table.exposed.items()
            if v.variable.causality is not Causality.INPUT and v.variable.type.is_float
        ]

    @property
    def _every(self) -> tuple[_Term, ...]:
        return (*self.derivatives, *self.inputs, *self.outputs, *self.parameters)

    def _environment(self, time: float, states: Array | None) -> dict[str, AnyArray]:
        """Every quantity in SI base units at a point of the integration; without states at a communication point."""
        found: dict[str, AnyArray] = {_TIME: np.asarray(time)}
        inside = states is not None
        for name in {n for t in self._every for n in t.names}:
            if name not in self._units or name == _TIME:
                continue
            if inside and name in self.states:
                values = np.asarray(states)[self.states[name]]
            elif inside and name in self._inner:
                values = self._inner[name]
            elif name in self._own_outputs:
                values = self._own_outputs[name]
            elif name in self._outside:
                values = self._outside[name]
            elif name in self._states_there:
                values = self._states_there[name]
            else:
                continue
            factor, offset = self._bases[name]
            found[name] = factor * values + offset
        return found

    def place(self, time: float, states: Array) -> None:
        """The FMU stands at a point of the integration: its inputs get what is added to them there.

        Args:
            time: Time [s].
            states: Of the FMU, then those of terms.
        """
        if self.owners:
            self.take_own(np.asarray(states)[-self.own_count :])
        if self.moved:
            self._placed = time, np.array(states[: len(states) - self.own_count])
        if self.inputs:
            self._read()
            self._write_inputs(self._environment(time, states))

    def _read(self) -> None:
        for read in self._readers:
            read()

    def _write_inputs(self, environment: Mapping[str, AnyArray]) -> None:
        for own in self._writers:
            self._writers[own][1][...] = self._outside[own]
        for term in self.inputs:
            self._writers[term.target][1][...] += self._amount(term, environment)
        for write, _ in self._writers.values():
            write()

    def write_inputs(self, time: float) -> None:
        """At a communication point: inputs get what was given from outside and what is added."""
        if self.inputs:
            self._write_inputs(self._environment(time, None))

    def add_rates(self, time: float, states: Array, rates: Array) -> None:
        """Add to derivatives; fill those of terms, which come last. Shape (states,)."""
        if self.derivatives or self.owners or self.parameters:
            self._read()
            environment = self._environment(time, states)
            if self.parameters:
                self._change_rates(time, states, rates, environment)
            for term in (t for t in self.derivatives if t.is_share):  # before anything is added to what the FMU has
                places = self.states[term.target]
                rates[places] *= 1.0 + np.broadcast_to(self._amount(term, environment), places.shape)
            for term in (t for t in self.derivatives if not t.is_share):
                places = self.states[term.target]
                rates[places] += np.broadcast_to(self._amount(term, environment), places.shape)
            if self.owners:
                rates[-self.own_count :] = np.concatenate([o.rates(environment) for o in self.owners])

    def _change_rates(self, time: float, states: Array, rates: Array, environment: Mapping[str, AnyArray]) -> None:
        """What parameters that change do to the derivatives, before anything else is added."""
        count = len(states) - self.own_count
        here = rates[:count].copy()
        for term in self.parameters:
            share = self._share(term, environment)
            rates[:count] += self.moved[term.target].rates(time, states[:count], self._held, share, here)

    def _change_outputs(self, where: tuple[float, Array]) -> None:
        """What they do to the outputs that were just read."""
        environment = self._environment(self.time, None)
        here = {n: np.array(self._outside[n], dtype=np.float64) for n in self._changeable_outputs}
        for term in self.parameters:
            share = self._share(term, environment)
            found = self.moved[term.target].outputs(*where, self._held, share, here)
            for name, amount in found.items():
                self._outside[name][...] += amount

    def complete_step(self) -> None:
        """The FMU has come to the point where it was placed last: so have the instances with other parameters."""
        for moved in self.moved.values():
            for instance in moved.instances:
                instance.complete_step(*self._placed, self._held)

    def _share(self, term: _Term, environment: Mapping[str, AnyArray]) -> float:
        share = float(self._amount(term, environment))
        if not share > -1.0:
            raise UnitError(
                self.name,
                f"the term at the parameter {term.target} changes it by {100.0 * share:.3g} %: its sign changes",
                remedy=f"check `{term.formula.text}`",
            )
        return share

    def add_outputs(self) -> None:
        """Add to outputs that were just read."""
        where = self.where() if self.moved else None  # in Initialization Mode an FMU need not know its states
        for read in self._state_readers if self.outputs or where else ():
            read()
        if where:
            self._change_outputs(where)
        if self.outputs:
            for name, own in self._own_outputs.items():
                own[...] = self._outside[name]
            environment = self._environment(self.time, None)
            for term in self.outputs:
                self._outside[term.target][...] += self._amount(term, environment)

    def see_outputs(self) -> None:
        """The FMU is back at a saved state: read the outputs that formulas see."""
        for read in self._own_output_readers if self.outputs else ():
            read()

    def _amount(self, term: _Term, environment: Mapping[str, AnyArray]) -> Any:
        amount = term.amount(environment)
        if not np.isfinite(amount).all():
            raise UnitError(
                self.name,
                f"the term added to {term.target} is not a finite number",
                remedy=f"check `{term.formula.text}`",
            )
        return amount

    def feedthrough(self, own: Mapping[str, frozenset[str]]) -> dict[str, frozenset[str]]:
        """Output to the inputs that its terms use, and those at inputs that it follows.

        Args:
            own: Output to the inputs that it follows in the FMU.
        """
        inputs = {n for n, v in self.table.exposed.items() if v.variable.causality is Causality.INPUT}
        found: dict[str, frozenset[str]] = {}
        acting = [(t, [t.target]) for t in self.outputs]
        acting += [(t, [n for n, followed in own.items() if t.target in followed]) for t in self.inputs]
        for term, following in acting:
            at_once = {d.of for d in term.delayed.inputs.values() if d.by <= INSTANT}
            for name in following:
                found[name] = found.get(name, frozenset()) | ((term.formula.names | at_once) & inputs)
        at_parameters = frozenset(n for t in self.parameters for n in t.names) & inputs
        for name, variable in self.table.exposed.items() if at_parameters else ():
            if variable.variable.causality is not Causality.INPUT:  # any of them may hold the parameter
                found[name] = found.get(name, frozenset()) | at_parameters
        return found


def is_changeable(variable: FmuVariable) -> bool:
    """Whether a term may change a variable: a parameter that is one floating-point number."""
    v = variable.variable
    is_set = v.causality is Causality.PARAMETER and not variable.is_structural and not variable.is_constant
    return is_set and v.type.is_float and not v.shape


def unchanging(table: Table) -> str:
    """Why no parameter of an FMU can change during a run; empty where one can."""
    description = table.archive.description
    if description.numberOfEventIndicators or description.eventIndicators:
        return "it has event indicators, and events might come at other times with another value"
    if description.modelExchange is not None and description.modelExchange.canBeInstantiatedOnlyOncePerProcess:
        return "it can be instantiated only once in a process"
    inputs = [v for v in table.exposed.values() if v.variable.causality is Causality.INPUT]
    others = [v.variable.name for v in inputs if not v.variable.type.is_float]
    return f"its input `{others[0]}` is no floating-point number" if others else ""


def given_terms(given: Sequence[Any]) -> tuple[AddedTerm, ...]:
    """Terms as a scenario gives them."""
    return tuple(
        AddedTerm(
            t.to,
            t.formula,
            {n: PhysicalValue.parse(v) for n, v in t.parameters.items()},
            {n: AddedState(s.rate, s.start, s.unit) for n, s in t.states.items()},
            {n: AddedDelay(d.of, d.by) for n, d in t.delays.items()},
            t.is_share,
            {n: i.unit for n, i in t.inputs.items()},
        )
        for t in given
    )
