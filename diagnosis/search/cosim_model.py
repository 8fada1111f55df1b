"""Any scenario that runs through the co-simulation, with its recordings, as the model that the search varies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from cosim.assemble import assemble
from cosim.components import ProgrammeComponent
from cosim.errors import InputError
from cosim.quantity import PhysicalValue, conversion
from cosim.scenario import Scenario
from cosim.unit import Array
from diagnosis.compute.batch import Batches
from diagnosis.compute.result import Task
from diagnosis.faults.programme import programme_inputs
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search import cosim_run
from diagnosis.search.cosim_run import Changes, changed, setting, simulate
from diagnosis.search.problem import Layout, Parameter, Point, Term

#: Distance in z over which a derivative is taken; both sides, so that the error is of second order.
STEP = 1e-3
#: Kind of component to what its numbers may be off by where neither its scenario nor its parameter set says so
#: (deviation of ln(value)): a few per cent, as of a careful rig. Masses are weighed; where a centre lies is worked out.
USUAL: Mapping[str, Mapping[str, float]] = {"bullet_pendulum": {"mass": 0.015, "centre_distance": 0.05}}
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
        batches: Makes the runs; None: one after the other in this process, nothing kept.

    Raises:
        InputError: A scenario is wrong, or a recording does not fit it.
    """

    def __init__(
        self, scenario: Scenario, recordings: Sequence[Recording], free: Sequence[Free],
        terms: Sequence[ComponentTerm] = (), batches: Batches | None = None,
    ) -> None:  # fmt: skip
        self.recordings = list(recordings)
        self.scenarios = [scenario_of(scenario, r) for r in recordings]
        self.settings = [setting(s, r) for s, r in zip(self.scenarios, recordings)]
        self.free = list(free)
        self.parameters: Sequence[Parameter] = [f.parameter for f in free]
        self._terms = {t.term: t for t in terms}
        #: Faults of outputs of programmes within an interval, with component and output.
        self.inputs = programme_inputs(self.scenarios, recordings)
        self.layout = _layout(recordings)
        self._batches = batches or Batches()
        self._sizes = [sum(len(c.times) for c in r.channels.values()) for r in recordings]
        #: Number of runs asked for so far, those taken from the disk among them.
        self.runs = 0

    def terms(self) -> list[Term]:
        """Every law that may be missing."""
        return list(self._terms)

    def changes_at(self, point: Point, number: int) -> Changes:
        """What a point changes in the scenario of one recording."""
        parameters: dict[str, dict[str, PhysicalValue]] = {}
        shifts: dict[str, dict[str, float]] = {}
        for free, z in zip(self.free, point.base):
            if free.recording not in (None, number):
                continue
            value = free.parameter.value(float(z))
            if isinstance(self.scenarios[number].components[free.component], ProgrammeComponent):
                shifts.setdefault(free.component, {})[free.name] = value - free.parameter.nominal
            else:
                parameters.setdefault(free.component, {})[free.name] = PhysicalValue(value, free.parameter.unit)
        gains: dict[str, dict[str, tuple[float, float, float]]] = {}
        for term, values in point.terms.items():
            if term.recording is not None:
                component, output = self.inputs[term]
                if term.recording == number:
                    gains.setdefault(component, {})[output] = (values[0], values[1], values[2])
                continue
            own = self._terms[term]
            for name, parameter, value in zip(own.names, term.parameters, values):
                parameters.setdefault(own.component, {})[name] = PhysicalValue(value, parameter.unit)
        return Changes(parameters, shifts, gains)

    def scenario_at(self, point: Point, number: int) -> Scenario:
        """The scenario of one recording with the values of a point; it can be run as it is."""
        return changed(self.scenarios[number], self.changes_at(point, number))

    def predictions(self, wanted: Sequence[tuple[Point, int]]) -> list[list[Array] | None]:
        """Values of every channel at its samples, SI, for points with the number of a recording; None: it stopped."""
        different: dict[str, Task] = {}  # a fault of one recording changes no run of the others
        keys = []
        for point, number in wanted:
            changes = self.changes_at(point, number)
            keys.append(self.settings[number].task_key(changes))
            different.setdefault(keys[-1], Task(keys[-1], (number, changes)))
        self.runs += len(different)
        results = dict(zip(different, self._batches.results(simulate, self.settings, list(different.values()))))
        return [list(results[k].arrays) if results[k].is_complete else None for k in keys]

    def predict(self, point: Point, number: int) -> list[Array] | None:
        """Values of every channel of a recording at its samples, SI; None where the run stopped."""
        return self.predictions([(point, number)])[0]

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        count = len(self.recordings)
        rows = self._rows([(p, n) for p in points for n in range(count)])
        return np.array([np.concatenate(rows[i : i + count]) for i in range(0, len(rows), count)])

    def _rows(self, wanted: Sequence[tuple[Point, int]]) -> list[Array]:
        """Residuals of single recordings."""
        return [self._residual(n, v) for (_, n), v in zip(wanted, self.predictions(wanted))]

    def _residual(self, number: int, values: Sequence[Array] | None) -> Array:
        if values is None:
            return np.full(self._sizes[number], np.inf)
        channels = self.recordings[number].channels.values()
        return np.concatenate(
            [np.where(c.is_clipped, 0.0, (c.values - v) / c.deviation) for c, v in zip(channels, values)]
        )

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`; central differences, a number of one recording runs that one alone."""
        wanted: list[tuple[Point, int]] = []
        places: list[tuple[int, int]] = []
        for column, free in enumerate(self.free):
            sides = []
            for sign in (1.0, -1.0):
                base = point.base.copy()
                base[column] += sign * STEP
                sides.append(replace(point, base=base))
            for number in range(len(self.recordings)) if free.recording is None else (free.recording,):
                wanted += [(side, number) for side in sides]
                places.append((column, number))
        rows = self._rows(wanted)
        begin = np.concatenate([[0], np.cumsum(self._sizes)])
        jacobian = np.zeros((begin[-1], len(self.free)))
        for (column, number), high, low in zip(places, rows[0::2], rows[1::2]):
            with np.errstate(invalid="ignore"):
                slope = (high - low) / (2 * STEP)
            jacobian[begin[number] : begin[number + 1], column] = np.where(np.isfinite(slope), slope, 0.0)
        return jacobian


def predicted(results: xr.Dataset, channel: Channel, recording: Recording) -> Array:
    """What a run says at the samples of a channel, SI, shape (samples,).

    Raises:
        InputError: The run has no such quantity.
    """
    return cosim_run.predicted(results, channel.target, channel.times, recording.path / "recording.yaml")


def free_parameters(scenario: Scenario, recordings: Sequence[Recording]) -> list[Free]:
    """Numbers that may be off: those whose parameter set states an uncertainty, and what a recording says itself.

    Of a component whose parameters state none, those of `USUAL` may be off.

    Raises:
        InputError: A recording names something that the scenario does not have.
    """
    found = []
    assembly = assemble(scenario_of(scenario, recordings[0]))
    try:
        for component, resolved in assembly.parameters.items():
            usual = USUAL.get(scenario.components[component].kind, {})
            for name, deviation in (resolved.uncertainty or usual).items():
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
