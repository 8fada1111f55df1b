"""Any scenario that runs through the co-simulation, with its recordings, as the model that the search varies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from cosim.assemble import assemble
from cosim.components import ProgrammeComponent, ProgrammeOutput
from cosim.errors import InputError
from cosim.quantity import PhysicalValue, conversion
from cosim.run import RunStopped, run
from cosim.scenario import Scenario
from cosim.unit import Array
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Channel, Recording
from diagnosis.recording.series import sample, series_of
from diagnosis.search.problem import Layout, Parameter, Point, Term

#: Distance in z over which a derivative is taken; both sides, so that the error is of second order.
STEP = 1e-3
#: Units in which numbers are varied, by dimension; others are varied in the unit that they are written in.
_SI = ("rad", "rad/s", "K", "m", "kg", "kg*m^2", "m^2", "m^3", "W/(m^2*K)", "J/(kg*K)", "kg/m^3", "1", "ohm", "V", "W",
       "N/m", "N*m", "N*m*s", "1/K", "m/s^2")  # fmt: skip


@dataclass(frozen=True)
class Free:
    """A number of the scenario that may be off.

    Args:
        parameter: Name, unit, nominal value and prior.
        component: Component that has it.
        name: Its parameter, or an output of a programme, which is moved as a whole.
        recording: Recording that it belongs to alone (an initial state), or None.
    """

    parameter: Parameter
    component: str
    name: str
    recording: int | None = None


@dataclass(frozen=True)
class ComponentTerm:
    """A law that a component can switch on itself.

    Args:
        term: The law, with bounds and start values.
        component: Component.
        names: Its parameters that the term's parameters set, in order.
    """

    term: Term
    component: str
    names: tuple[str, ...]


class CosimModel:
    """See `diagnosis.search.problem.Model`: every evaluation is a run of the closed co-simulation.

    Args:
        scenario: What the recordings are compared with.
        recordings: Training recordings.
        free: Numbers that may be off; `free_parameters` reads them from parameter sets and recordings.
        terms: Laws that may be missing.

    Raises:
        InputError: A scenario is wrong, or a recording does not fit it.
    """

    def __init__(
        self, scenario: Scenario, recordings: Sequence[Recording], free: Sequence[Free],
        terms: Sequence[ComponentTerm] = (),
    ) -> None:  # fmt: skip
        self.recordings = list(recordings)
        self.scenarios = [scenario_of(scenario, r) for r in recordings]
        for own in self.scenarios:  # later, what cannot be built is a value that makes no sense
            assemble(own).system.terminate()
        self.free = list(free)
        self.parameters: Sequence[Parameter] = [f.parameter for f in free]
        self._terms = {t.term: t for t in terms}
        self.layout = _layout(recordings)
        #: Number of runs made so far.
        self.runs = 0

    def terms(self) -> list[Term]:
        """Every law that may be missing."""
        return list(self._terms)

    def scenario_at(self, point: Point, number: int) -> Scenario:
        """The scenario of one recording with the values of a point; it can be run as it is."""
        changes: dict[str, dict[str, PhysicalValue]] = {}
        shifts: dict[str, dict[str, float]] = {}
        scenario = self.scenarios[number]
        for free, z in zip(self.free, point.base):
            if free.recording not in (None, number):
                continue
            value = free.parameter.value(float(z))
            if isinstance(scenario.components[free.component], ProgrammeComponent):
                shifts.setdefault(free.component, {})[free.name] = value - free.parameter.nominal
            else:
                changes.setdefault(free.component, {})[free.name] = PhysicalValue(value, free.parameter.unit)
        for term, values in point.terms.items():
            own = self._terms[term]
            for name, parameter, value in zip(own.names, term.parameters, values):
                changes.setdefault(own.component, {})[name] = PhysicalValue(value, parameter.unit)
        return _changed(scenario, changes, shifts)

    def predict(self, point: Point, number: int) -> list[Array] | None:
        """Values of every channel of a recording at its samples, SI; None where the run stopped."""
        self.runs += 1
        try:
            results = run(self.scenario_at(point, number))
        except (RunStopped, InputError):  # a value at which the unit cannot be built or go on
            return None
        return [predicted(results, c, self.recordings[number]) for c in self.recordings[number].channels.values()]

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return np.array([np.concatenate([self._residual(p, n) for n in range(len(self.recordings))]) for p in points])

    def _residual(self, point: Point, number: int) -> Array:
        channels = list(self.recordings[number].channels.values())
        values = self.predict(point, number)
        if values is None:
            return np.full(sum(len(c.times) for c in channels), np.inf)
        return np.concatenate(
            [np.where(c.is_clipped, 0.0, (c.values - v) / c.deviation) for c, v in zip(channels, values)]
        )

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`; central differences, a number of one recording runs that one alone."""
        sizes = [sum(len(c.times) for c in r.channels.values()) for r in self.recordings]
        begin = np.concatenate([[0], np.cumsum(sizes)])
        jacobian = np.zeros((begin[-1], len(self.free)))
        for column, free in enumerate(self.free):
            sides = []
            for sign in (1.0, -1.0):
                base = point.base.copy()
                base[column] += sign * STEP
                sides.append(replace(point, base=base))
            for number in range(len(self.recordings)) if free.recording is None else (free.recording,):
                high, low = (self._residual(side, number) for side in sides)
                with np.errstate(invalid="ignore"):
                    slope = (high - low) / (2 * STEP)
                jacobian[begin[number] : begin[number + 1], column] = np.where(np.isfinite(slope), slope, 0.0)
        return jacobian


def predicted(results: xr.Dataset, channel: Channel, recording: Recording) -> Array:
    """What a run says at the samples of a channel, SI, shape (samples,).

    Raises:
        InputError: The run has no such quantity.
    """
    series = series_of(results, channel.target, recording.path / "recording.yaml")
    return sample(series, channel.times)


def free_parameters(scenario: Scenario, recordings: Sequence[Recording]) -> list[Free]:
    """Numbers that may be off: those whose parameter set states an uncertainty, and what a recording says itself.

    Raises:
        InputError: A recording names something that the scenario does not have.
    """
    found = []
    assembly = assemble(scenario_of(scenario, recordings[0]))
    try:
        for component, resolved in assembly.parameters.items():
            for name, deviation in resolved.uncertainty.items():
                value = resolved.values[name]
                if deviation and isinstance(value, PhysicalValue):
                    unit = _si(value.unit)
                    parameter = Parameter(f"{component}.{name}", unit, value.to(unit), deviation)
                    found.append(Free(parameter, component, name))
    finally:
        assembly.system.terminate()
    for number, recording in enumerate(recordings):
        own = scenario_of(scenario, recording)
        found += [_own(own, recording, number, name, d) for name, d in recording.uncertain.items()]
    return found


def _own(scenario: Scenario, recording: Recording, number: int, name: str, deviation: PhysicalValue) -> Free:
    """A number that one recording does not know exactly."""
    file, key = recording.path / "recording.yaml", f"uncertain.{name}"
    component, _, own = name.partition(".")
    given = scenario.components.get(component)
    if isinstance(given, ProgrammeComponent):
        output = given.outputs.get(own)
        value = None if output is None else output.constant
    else:
        value = getattr(given, "parameters", {}).get(own)
    if not isinstance(value, PhysicalValue):
        raise InputError(file, key, "the scenario gives no such number",
                         "name `component.parameter`, or an output of a programme that is constant")  # fmt: skip
    unit = _si(value.unit)
    factor = conversion(deviation.unit or unit, unit)[0]
    parameter = Parameter(f"{name} of {recording.path.name}", unit, value.to(unit), factor * deviation.number, False)
    return Free(parameter, component, own, number)


def _si(unit: str) -> str:
    """SI unit of the same dimension."""
    base = PhysicalValue(1.0, unit)
    for candidate in _SI:
        try:
            base.to(candidate)
        except ValueError:
            continue
        return candidate
    return unit


def _layout(recordings: Sequence[Recording]) -> Layout:
    channel, time = [], []
    names: list[str] = []
    units: list[str] = []
    for recording in recordings:
        for c in recording.channels.values():
            channel.append(np.full(len(c.times), len(names)))
            time.append(c.times)
            names.append(c.name if len(recordings) == 1 else f"{c.name} ({recording.path.name})")
            units.append(c.target.domain)
    return Layout(np.concatenate(channel), np.concatenate(time), tuple(names), tuple(units))


def _changed(
    scenario: Scenario, changes: Mapping[str, Mapping[str, PhysicalValue]], shifts: Mapping[str, Mapping[str, float]]
) -> Scenario:
    """The scenario with other parameters, and with constants of programmes moved."""
    components: dict[str, Any] = dict(scenario.components)
    for name, values in changes.items():
        own = components[name]
        components[name] = own.model_copy(update={"parameters": {**own.parameters, **values}})
    for name, moved in shifts.items():
        own = components[name]
        outputs = {o: _shifted(g, moved.get(o, 0.0)) for o, g in own.outputs.items()}
        components[name] = own.model_copy(update={"outputs": outputs})
    return scenario.model_copy(update={"components": components})


def _shifted(given: ProgrammeOutput, amount: float) -> ProgrammeOutput:
    if not amount or not isinstance(given.constant, PhysicalValue):
        return given
    return given.model_copy(update={"constant": PhysicalValue(given.constant.to(given.unit) + amount, given.unit)})
