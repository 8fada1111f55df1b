"""Any scenario that runs through the co-simulation, with its recordings, as the model that the search varies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr

from cosim.components import ProgrammeComponent
from cosim.compute.batch import Batches
from cosim.compute.result import Task
from cosim.scenario import Scenario
from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue, conversion
from diagnosis.faults.programme import InputChange, input_change, programme_inputs
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.labels import labels
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search import cosim_run
from diagnosis.search.cosim_run import Changes, changed, setting, simulate
from diagnosis.search.free_numbers import Free, Numbers, free_parameters, moved
from diagnosis.search.problem import Layout, Parameter, Point, Term

__all__ = ["ComponentTerm", "CosimModel", "Free", "free_parameters", "predicted"]

#: What simulated recordings that judge, where the co-simulation did.
BY_FREE_RUNS = "free runs of the closed co-simulation, `cosim run` of the amended scenario"
#: Distance in z over which a derivative is taken, to one side: its error is the change of the derivative over that.
STEP = 1e-3
#: Residuals that are kept: a fit asks again for those where it stands.
KEPT = 256
_Key = tuple[bytes, tuple[tuple[Term, tuple[float, ...]], ...], int, int]


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


def with_law(
    numbers: Numbers, law: ComponentTerm, values: Sequence[float], fitted: Mapping[str, PhysicalValue]
) -> dict[str, PhysicalValue]:
    """Parameters of a component with a law switched on: its strength comes on top of what the scenario has of it.

    Args:
        numbers: Of the scenario.
        law: The law.
        values: Of its parameters; the first is the strength.
        fitted: Parameters of the component that the fit has moved.
    """
    found = {}
    for index, (name, parameter, value) in enumerate(zip(law.names, law.term.parameters, values)):
        there = 0.0
        if index == 0 and name in fitted:
            there = fitted[name].to(parameter.unit)
        elif index == 0:
            there = given_strength(numbers, law)
        found[name] = PhysicalValue(there + value, parameter.unit)
    return found


def given_strength(numbers: Numbers, law: ComponentTerm) -> float:
    """What a scenario has of a law already, in the unit of the law's strength."""
    if not law.names:
        return 0.0
    known = numbers.of(law.component, law.names[0])
    return PhysicalValue(known.values[0], known.unit).to(law.term.parameters[0].unit) if known else 0.0


def can_be_added(numbers: Numbers, law: ComponentTerm) -> bool:
    """Whether a unit can have more of a law: one whose shape has numbers of its own acts once in a unit."""
    return len(law.names) < 2 or given_strength(numbers, law) == 0.0


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

    #: See `diagnosis.search.problem.has_ridges`.
    has_ridges = False

    @property
    def can_be_searched_again(self) -> bool:
        """Whether another search takes a minute or two; see `diagnosis.ways`."""
        return False

    @property
    def can_be_refitted(self) -> bool:
        """Whether a few fits of the numbers alone take seconds."""
        return False

    def __init__(
        self,
        scenario: Scenario,
        recordings: Sequence[Recording],
        free: Sequence[Free],
        terms: Sequence[ComponentTerm] = (),
        batches: Batches | None = None,
    ) -> None:
        self.recordings = list(recordings)
        self.scenarios = [scenario_of(scenario, r) for r in recordings]
        self.settings = [setting(s, r) for s, r in zip(self.scenarios, recordings)]
        self.free = list(free)
        self._own, self._numbers_of = Numbers(scenario), [Numbers(s) for s in self.scenarios]
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

    def refine(self, point: Point) -> bool:
        """See `diagnosis.search.problem.refined`; False: units choose their own steps."""
        return False

    def solving_error(self, point: Point) -> Array | None:
        """None: asked of compiled code alone."""
        return None

    def row_shifts(self, point: Point) -> Array:
        """No rows: asked of compiled code alone."""
        return np.zeros((0, len(self.layout.time)))

    def changes_at(self, point: Point, number: int | None) -> Changes:
        """What a point changes in the scenario of one recording; None: in the scenario itself, on no day of its own."""
        numbers = self._own if number is None else self._numbers_of[number]
        own = [
            (f, float(z))
            for f, z in zip(self.free, point.base)
            if (not f.is_own if number is None else f.belongs_to(number))
        ]
        switches = [(f, z) for f, z in own if f.switch is not None]
        own = [(f, z) for f, z in own if f.switch is None]
        parameters: dict[str, dict[str, PhysicalValue]] = {}
        lists: dict[str, dict[str, tuple[PhysicalValue, ...]]] = {}
        shifts: dict[str, dict[str, float]] = {}
        for (component, name), found in moved(numbers, own).items():
            given = numbers.scenario.components[component]
            if isinstance(given, ProgrammeComponent):
                factor = conversion(found.unit, given.outputs[name].unit)[0]
                shifts.setdefault(component, {})[name] = factor * found.values[0]
            elif found.is_list and len(set(found.values)) > 1:
                lists.setdefault(component, {})[name] = tuple(PhysicalValue(v, found.unit) for v in found.values)
            else:
                parameters.setdefault(component, {})[name] = PhysicalValue(found.values[0], found.unit)
        faults = _moved_switches(switches)
        for term, values in point.terms.items():
            if term.recording is not None:
                component, output = self.inputs[term]
                if term.recording == number:
                    given = numbers.scenario.components[component]
                    assert isinstance(given, ProgrammeComponent)
                    own_faults = faults.setdefault(component, {})
                    change = input_change(term, values, given.outputs[output])
                    own_faults[output] = (*own_faults.get(output, ()), change)
                continue
            law = self._terms[term]
            there = parameters.setdefault(law.component, {})
            there.update(with_law(numbers, law, values, there))
        return Changes(parameters, shifts, lists, faults)

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

    def judged_by(self, point: Point) -> str:
        """What simulated recordings that judge, for people.

        Args:
            point: At which they were judged.
        """
        return BY_FREE_RUNS

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
        with np.errstate(over="ignore"):  # a run may end far away
            return np.concatenate(
                [np.where(c.is_clipped, 0.0, (c.values - v) / c.deviation) for c, v in zip(channels, values)]
            )

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`; forward differences, a number of one recording runs that one alone.

        What recordings share moves each of them as what it has by itself does, and needs no runs of its own.
        """
        wanted: list[tuple[Point, int]] = []
        places: list[tuple[int, int]] = []
        numbers = range(len(self.recordings))
        for column, free in enumerate(self.free):
            base = point.base.copy()
            base[column] += STEP
            moved = replace(point, base=base)
            where = [n for n in numbers if free.belongs_to(n) and not self._parts(free, n)]
            wanted += [(moved, n) for n in where]
            places += [(column, n) for n in where]
        begun = sorted({number for _, number in places})
        rows = self._rows([*((point, n) for n in begun), *wanted])
        here = dict(zip(begun, rows))
        begin = np.concatenate([[0], np.cumsum(self._sizes)])
        jacobian = np.zeros((begin[-1], len(self.free)))
        for (column, number), there in zip(places, rows[len(begun) :]):
            with np.errstate(over="ignore", invalid="ignore"):
                slope = (there - here[number]) / STEP
            jacobian[begin[number] : begin[number + 1], column] = np.where(np.isfinite(slope), slope, 0.0)
        for column, free in enumerate(self.free):
            for number in numbers:
                own = slice(begin[number], begin[number + 1])
                for part in self._parts(free, number):
                    scale = free.parameter.deviation / self.free[part].parameter.deviation
                    jacobian[own, column] += scale * jacobian[own, part]
        return jacobian

    def _parts(self, free: Free, number: int) -> list[int]:
        """Numbers of one recording whose offsets together are an offset that all share; empty where they are not."""
        if free.is_own or free.parameter.is_relative:
            return []
        same = [
            i
            for i, f in enumerate(self.free)
            if f.is_own
            and f.switch is None
            and (f.component, f.name) == (free.component, free.name)
            and f.belongs_to(number)
        ]
        elements = {self.free[i].element for i in same}
        if elements == {None}:
            return same
        known = self._numbers_of[number].of(free.component, free.name)
        return same if known is not None and elements == set(range(len(known.values))) else []


def _moved_switches(switches: Iterable[tuple[Free, float]]) -> dict[str, dict[str, tuple[InputChange, ...]]]:
    """Changes of recorded inputs that came earlier or later than their rows say, by component and output."""
    found: dict[str, dict[str, tuple[InputChange, ...]]] = {}
    for free, z in switches:
        if free.switch is not None and z != 0.0:
            own = found.setdefault(free.component, {})
            change = free.switch.moved(free.parameter.deviation * z)
            own[free.name] = (*own.get(free.name, ()), change)
    return found


class CompiledModel(CosimModel):
    """A `CosimModel` whose residuals come from compiled code; those that were asked for last are kept."""

    def _compiled(self, wanted: Sequence[tuple[Point, int]]) -> Iterable[list[Array] | None]:
        """Values of every channel at its samples, SI, for points with the number of a recording; None: it stopped."""
        raise NotImplementedError

    def _new_rows(self, wanted: Sequence[tuple[Point, int]]) -> Iterable[Array]:
        """Residuals of single recordings that are not kept."""
        return (self._residual(n, values) for (_, n), values in zip(wanted, self._compiled(wanted)))

    def _steps_of(self, point: Point) -> int:
        """Steps in which a point is simulated; residuals by fewer are not kept for it."""
        return 1

    @cached_property
    def _known(self) -> dict[_Key, Array]:
        """Residuals that are kept, by what was asked."""
        return {}

    def _rows(self, wanted: Sequence[tuple[Point, int]]) -> list[Array]:
        """Residuals of single recordings."""
        known = self._known
        keys = [(p.base.tobytes(), tuple(p.terms.items()), n, self._steps_of(p)) for p, n in wanted]
        new = {key: one for key, one in zip(keys, wanted) if key not in known}
        known.update(zip(new, self._new_rows(list(new.values()))))
        self.runs += len(new)
        found = [known[key] for key in keys]
        for key in list(known)[:-KEPT]:
            del known[key]
        return found


def predicted(results: xr.Dataset, channel: Channel, recording: Recording) -> Array:
    """What a run says at the samples of a channel, SI, shape (samples,).

    Raises:
        InputError: The run has no such quantity.
    """
    return cosim_run.predicted(results, channel.target, channel.times, recording.path / "recording.yaml")


def _layout(recordings: Sequence[Recording]) -> Layout:
    channel, time = [], []
    names: list[str] = []
    units: list[str] = []
    for recording, label in zip(recordings, labels(recordings)):
        for c in recording.channels.values():
            channel.append(np.full(len(c.times), len(names)))
            time.append(c.times)
            names.append(c.name if len(recordings) == 1 else f"{c.name} ({label})")
            units.append(c.target.domain)
    return Layout(np.concatenate(channel), np.concatenate(time), tuple(names), tuple(units))
