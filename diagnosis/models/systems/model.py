"""A system of FMUs with its recordings: simulated in compiled code, with laws wherever their quantities fit."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import TypeVar

import numpy as np
import xarray as xr

from cosim.components import AddedTermEntry, nanoseconds
from cosim.compute.batch import Batches
from cosim.compute.replicas import Replicas
from cosim.run import RunStopped, run
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue, conversion
from diagnosis.faults.programme import held_inputs, level_inputs
from diagnosis.laws.library import library
from diagnosis.models.coil_network.kernel.compiler import CompilerError
from diagnosis.models.sensor_chain import read
from diagnosis.models.systems.changed_run import Changed, placed_change
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.numbers import usual_numbers
from diagnosis.models.systems.placed import Placed
from diagnosis.models.systems.places import Fit, fits, places_of
from diagnosis.models.systems.rig_faults import rig_terms
from diagnosis.models.systems.sensors import reach_of, sensor_laws_of
from diagnosis.models.systems.steps import MOST_SUBSTEPS, resolve
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording
from diagnosis.recording.series import Series, place_of
from diagnosis.search.cosim_model import CompiledModel, Free
from diagnosis.search.cosim_run import Changes, predicted
from diagnosis.search.problem import Point, Term
from diagnosis.search.switch_times import shifts_by_recording, with_earlier_inputs
from diagnosis.search.unit_law import UnitLaw

#: Steps of the integration in a macro-step: doubled until no reading moves by more than this share of its noise.
EXACT = 0.02
#: With laws: until all readings together move by no more than this [-2 log likelihood], or than this share of what is
#: left of them; a search decides by 20.
SAME, SAME_SHARE = 1.0, 1e-4
#: Largest difference from the co-simulation in the size of a quantity, where the first outputs are compared.
AGREED = 1e-3
#: Macro-steps over which a run of the co-simulation is compared.
COMPARED = 2000
#: Steps of the integration over all recordings from which another search would take minutes.
SEARCHED_AGAIN = 30_000
#: The same up to which the numbers alone are fitted a few times more: some hundred simulations in place of thousands.
REFITTED = 300_000
#: Steps of the integration over a recording from which an input that stayed is not looked for: that takes hundreds of
#: simulations for each, of some 0.1 s then.
HELD_STEPS = 200_000
#: Points whose numbers are kept, and simulations.
MOST_PLAIN, MOST_COURSES = 64, 8
#: Macro-steps of the run that tells what the variables of the results are called.
FIRST_STEPS = 3


_Key = TypeVar("_Key")
_Value = TypeVar("_Value")
#: A point, the number of a recording, and steps of the integration in a macro-step.
_Asked = tuple[Point, int, int]
#: Numbers of a point, laws and faults of inputs that act in a recording, its number, steps.
_Course = tuple[bytes, tuple[tuple[Term, tuple[float, ...]], ...], int, int]


#: Scenario, recordings, numbers, laws, and what of the rig may have been another in recordings, by their numbers.
_Given = tuple[Scenario, Sequence[Recording], Sequence[Free], Sequence[Fit], Mapping[int, Sequence[Changed]]]


def _row_of(given: _Given) -> Callable[[_Asked], Array]:
    """What answers questions for residuals in another process."""
    scenario, recordings, free, found, changes = given
    return SystemModel(scenario, recordings, free, found, changes=changes)._row


class SystemModel(CompiledModel):
    """See `CosimModel`; residuals and predictions come from `FastSystem`.

    Args:
        scenario: What the recordings are compared with.
        recordings: Recordings of it.
        free: Numbers that may be off.
        found: Laws at their places.
        batches: Makes runs of the co-simulation, where they are asked for.
        like: A model of the same scenario: what it finds of the steps that laws need holds here too, and the reverse.
        changes: What of the rig may have been another for a while in recordings, by their numbers.

    Raises:
        NotFast: Only the co-simulation can simulate it.
        CompilerError: There is no C compiler.
        InputError: A scenario is wrong, or a recording does not fit it.
    """

    def __init__(
        self,
        scenario: Scenario,
        recordings: Sequence[Recording],
        free: Sequence[Free],
        found: Sequence[Fit],
        batches: Batches | None = None,
        like: SystemModel | None = None,
        changes: Mapping[int, Sequence[Changed]] = MappingProxyType({}),
    ) -> None:
        super().__init__(scenario, recordings, free, (), batches)
        #: Steps of the integration in a macro-step that points with laws need, where these are more than without.
        self._needed: dict[frozenset[Term], int] = {} if like is None else like._needed
        #: What points without laws change, by their numbers and recording.
        self._plain: dict[tuple[bytes, int | None], Changes] = {}
        #: Courses of the channels that were simulated last.
        self._courses: dict[_Course, Array | None] = {}
        #: Law to what it adds, by the numbers that the compiled code has for each, and its place.
        self._found: dict[Term, tuple[range, Fit]] = {}
        placed: list[Placed] = []
        for fit in found:
            self._found[fit.term] = range(len(placed), len(placed) + len(fit.every)), fit
            placed += fit.every
        #: What of the rig may have been another, by its number among what the compiled code of its recording adds.
        self.rig: dict[Term, tuple[int, Changed]] = {}
        own = [changes.get(n, ()) for n in range(len(recordings))]
        self._fast = [FastSystem(s, [*placed, *map(placed_change, c)]) for s, c in zip(self.scenarios, own)]
        for number, every in changes.items():
            terms = rig_terms(every, self.scenarios[number], self.recordings, number)
            self.rig |= {t: (len(placed) + n, c) for n, (t, c) in enumerate(zip(terms, every))}
        self._places = [_channel_places(s, r, f) for s, r, f in zip(self.scenarios, recordings, self._fast)]
        self._set_steps()
        if self.can_try_intervals:
            self.inputs |= held_inputs(self.scenarios, recordings) | level_inputs(self.scenarios, recordings)
        place = self._batches.place
        given: _Given = (scenario, self.recordings, self.free, list(found), dict(changes))
        self._given = given
        #: Residuals of a recording at a point, by this process and by copies of this model in others.
        self._replicas = Replicas(_row_of, given, self._row, place.parallel - 1 if place.is_local else 0)

    @property
    def can_be_searched_again(self) -> bool:
        """Whether its simulations have not many steps."""
        return self._steps_of_all < SEARCHED_AGAIN

    @property
    def can_try_intervals(self) -> bool:
        """Whether hundreds of simulations of a recording take no minutes; see `HELD_STEPS`."""
        return self._substeps * max(fast.steps for fast in self._fast) < HELD_STEPS

    @property
    def can_be_refitted(self) -> bool:
        """See `CosimModel`."""
        return self._steps_of_all < REFITTED

    @property
    def _steps_of_all(self) -> int:
        """Steps of the integration of all recordings."""
        return self._substeps * sum(fast.steps for fast in self._fast)

    def terms(self) -> list[Term]:
        """Every law that may be missing."""
        return list(self._found)

    def late_inputs(self) -> list[Term]:
        """Laws that an input is late by, and nothing else."""
        return [t for t, (_, fit) in self._found.items() if fit.law.delays and len(fit.law.numbers) == 1]

    def changes_at(self, point: Point, number: int | None) -> Changes:
        """See `CosimModel`; laws are added to their FMUs."""
        found = self._numbers_at(point, number)
        added: dict[str, list[AddedTermEntry]] = {}
        for term, values in point.terms.items():
            if term in self._found:
                fit = self._found[term][1]
                for placed in fit.every:
                    added.setdefault(placed.component, []).append(placed.entry(fit.values_of(placed, values)))
            elif term in self.rig and term.recording == number:
                change = self.rig[term][1]
                added.setdefault(change.component, []).append(placed_change(change).entry(values))
        return replace(found, added={name: tuple(entries) for name, entries in added.items()})

    def _numbers_at(self, point: Point, number: int | None) -> Changes:
        """What a point changes beside laws."""
        faults = {t: v for t, v in point.terms.items() if t.recording is not None and t not in self.rig}
        if faults:
            return super().changes_at(Point(point.base, faults), number)
        key = point.base.tobytes(), number
        if key not in self._plain:  # a law is tried with many of its values where nothing else moves
            _keep(self._plain, key, super().changes_at(Point(point.base), number), MOST_PLAIN)
        return self._plain[key]

    def predictions(self, wanted: Sequence[tuple[Point, int]]) -> list[list[Array] | None]:
        """Values of every channel at its samples, SI; None where the simulation stopped."""
        self.runs += len(wanted)
        for point in {id(p): p for p, _ in wanted}.values():
            self.refine(point)
        return list(self._compiled(wanted))

    def refine(self, point: Point) -> bool:
        """See `diagnosis.search.problem.refined`: steps of the integration are halved until that changes nothing."""
        laws, count = self._laws_of(point), self._steps_of(point)
        before, is_new = self.residuals([point])[0], False  # a fit that ends here has asked for them
        while count < MOST_SUBSTEPS:
            now = self._residuals_by(point, 2 * count)
            with np.errstate(invalid="ignore", over="ignore"):
                moved, left = float(np.sum((now - before) ** 2)), float(np.sum(now**2))
            if not moved > max(SAME, SAME_SHARE * left):  # or it stops, with few steps and with many
                break
            count, before, is_new = 2 * count, now, True
        if is_new:
            self._needed[laws] = count
        return is_new

    def _residuals_by(self, point: Point, count: int) -> Array:
        """Residuals of all recordings with so many steps of the integration in a macro-step."""
        rows = self._replicas.answers([(point, n, count) for n in range(len(self.recordings))])
        self.runs += len(rows)
        return np.concatenate(rows)

    def _laws_of(self, point: Point) -> frozenset[Term]:
        return frozenset(t for t in point.terms if t in self._found)

    def _steps_of(self, point: Point) -> int:
        """See `CompiledModel`: of the integration in a macro-step, as any of its laws need, alone or together."""
        laws = self._laws_of(point)
        return max((n for own, n in self._needed.items() if own <= laws), default=0) or self._substeps

    def solving_error(self, point: Point) -> Array | None:
        """See `diagnosis.models.protocol.DiagnosisModel`.

        Source: Richardson's rule for an error in proportion to the step.
        """
        finer = self._with_shorter_steps
        if finer is None:
            return None
        finer.refine(point)
        with np.errstate(invalid="ignore", over="ignore"):  # runs that stop, or run away, have none
            found = 2.0 * (finer.residuals([point])[0] - self.residuals([point])[0])
        return found if np.isfinite(found).all() else None

    def row_shifts(self, point: Point) -> Array:
        """See `diagnosis.models.protocol.DiagnosisModel`."""
        count = self._steps_of(point)
        before = self._residuals_by(point, count) if self._with_earlier_inputs else np.zeros(0)
        with np.errstate(invalid="ignore", over="ignore"):  # runs that stop, or run away, have none
            changes = [moved._residuals_by(point, count) - before for moved in self._with_earlier_inputs]
        return shifts_by_recording(changes, self._sizes)

    @cached_property
    def _with_earlier_inputs(self) -> list[SystemModel]:
        """The same with one input that was sampled half a row earlier in each recording, for each such input."""
        scenario, recordings, free, found, changes = self._given
        moved = with_earlier_inputs(self.scenarios, recordings)
        return [SystemModel(scenario, own, free, found, self._batches, changes=changes) for own in moved]

    @cached_property
    def _with_shorter_steps(self) -> SystemModel | None:
        """The same with macro-steps of half the length; None where no such run can be made."""
        scenario, recordings, free, found, changes = self._given
        half = PhysicalValue(0.5 * scenario.time.macro_step.to("s"), "s")
        time = scenario.time.model_copy(update={"macro_step": half})
        try:
            shorter = scenario.model_copy(update={"time": time})
            return SystemModel(shorter, recordings, free, found, self._batches, changes=changes)
        except (NotFast, CompilerError, InputError):
            return None

    def judged_by(self, point: Point) -> str:
        """See `CosimModel`; with how far the co-simulation is from compiled code in the first recording."""
        by, found = "compiled code that steps the same FMUs", self.apart(point, 0)
        if found is None:
            return f"{by}; `cosim run` of the amended scenario stops"
        worst, end = found
        return (
            f"{by}; `cosim run` of the amended scenario differs by {worst:.2g} of the noise at most until {end:.4g} s"
        )

    def apart(self, point: Point, number: int, steps: int = COMPARED) -> tuple[float, float] | None:
        """How far a run of the co-simulation is from what was simulated, over the first macro-steps of a recording.

        Args:
            point: Values, terms of sensors are left out.
            number: Of the recording.
            steps: Macro-steps at most.

        Returns:
            Largest difference in deviations of the noise, and the time until which both were compared [s]; None where
            the co-simulation stops.
        """
        plain = Point(point.base, {t: v for t, v in point.terms.items() if t in self._found})
        scenario, fast = self.scenario_at(plain, number), self._fast[number]
        outputs = max(min(steps, fast.steps) // fast.per_output, 1)
        end = (fast.start + outputs * fast.per_output * fast.size) / 1e9
        stop = PhysicalValue(float(f"{end:.12g}"), "s")
        try:
            results = run(scenario.model_copy(update={"time": scenario.time.model_copy(update={"stop": stop})}))
        except RunStopped:
            return None
        mine = self._prediction(plain, number)
        source, worst = self.recordings[number].path / "recording.yaml", 0.0
        for i, channel in enumerate(self.recordings[number].channels.values()):
            # The last outputs of a shorter run are drawn with other neighbours.
            inside = channel.times <= end - 3.0 * fast.per_output * fast.size / 1e9
            if mine is None or not inside.any():
                continue
            there = predicted(results, channel.target, channel.times[inside], source)
            worst = max(worst, float(np.max(np.abs(mine[i][inside] - there)) / channel.deviation))
        return worst, end

    def _compiled(self, wanted: Sequence[tuple[Point, int]]) -> Iterator[list[Array] | None]:
        """One after the other: values of many points would take much memory."""
        return (self._prediction(point, number) for point, number in wanted)

    def _new_rows(self, wanted: Sequence[tuple[Point, int]]) -> list[Array]:
        """See `CompiledModel`."""
        return self._replicas.answers([(p, n, self._steps_of(p)) for p, n in wanted])

    def _row(self, asked: _Asked) -> Array:
        """Residuals of a recording at a point."""
        point, number, count = asked
        return self._residual(number, self._prediction(point, number, count))

    def _prediction(self, point: Point, number: int, count: int | None = None) -> list[Array] | None:
        count = self._steps_of(point) if count is None else count
        courses = self._simulated(point, number, count)
        if courses is None:
            return None
        fast = self._fast[number]
        step = fast.per_output * fast.size / 1e9
        found = []
        for channel, values, (_, factor, offset, is_flow, unit) in zip(
            self.recordings[number].channels.values(), courses, self._places[number]
        ):
            series = Series(fast.times, factor * values + offset, is_flow, unit)
            found.append(read(channel, point.terms, series, step))
        return found

    def _simulated(self, point: Point, number: int, count: int) -> Array | None:
        """What the channels of a recording measure, shape (channels, outputs); None where the simulation stopped.

        It is kept for points that differ in what sensors do alone.
        """
        acting = tuple((t, v) for t, v in point.terms.items() if t in self._found or t.recording == number)
        key = point.base.tobytes(), acting, number, count
        if key in self._courses:
            return self._courses[key]
        changes = self._numbers_at(point, number)
        laws: dict[int, Sequence[float]] = {}
        for term, amounts in acting:
            if term in self._found:
                own, fit = self._found[term]
                laws |= {n: fit.values_of(placed, amounts) for n, placed in zip(own, fit.every)}
            elif term in self.rig:
                laws[self.rig[term][0]] = amounts
        fast = self._fast[number]
        fast.set_substeps(count)
        rows = fast.simulate(changes, laws)
        found = None if rows is None else rows.values[:, [place[0] for place in self._places[number]]].T.copy()
        _keep(self._courses, key, found, MOST_COURSES)
        return found

    def _set_steps(self) -> None:
        """As few steps of the integration as the noise allows, for all recordings the same."""
        zero = Point(np.zeros(len(self.free)))
        numbers = range(len(self.recordings))
        count = 1
        before = [self._row((zero, n, count)) for n in numbers]
        while count < MOST_SUBSTEPS:
            now = [self._row((zero, n, 2 * count)) for n in numbers]
            with np.errstate(invalid="ignore"):
                moved = [float(np.max(np.abs(a - b), initial=0.0)) for a, b in zip(before, now)]
            count, before = 2 * count, now
            if all(m < EXACT for m in moved):  # the finer one stays: states of laws may be faster than the model's
                break
        self._substeps = count


#: Column of the rows, factor and offset to SI, whether it is a flow, SI unit.
_Place = tuple[int, float, float, bool, str]


def _keep(kept: dict[_Key, _Value], key: _Key, value: _Value, most: int) -> None:
    """Keep a value, and forget the oldest of so many."""
    if len(kept) >= most:
        del kept[next(iter(kept))]
    kept[key] = value


def _channel_places(scenario: Scenario, recording: Recording, fast: FastSystem) -> list[_Place]:
    """Where each channel's quantity stands in the rows of the fast simulation.

    Raises:
        InputError: The scenario has no such quantity.
        NotFast: It is none that the fast simulation records.
    """
    time = scenario.time
    steps = min(FIRST_STEPS * fast.per_output, fast.steps // fast.per_output * fast.per_output)
    stop = (nanoseconds(time.start) + steps * fast.size) / 1e9
    end = PhysicalValue(float(f"{stop:.12g}"), "s")
    short = scenario.model_copy(update={"time": time.model_copy(update={"stop": end})})
    try:
        results = run(short)
    except RunStopped as stopped:
        raise NotFast(f"the co-simulation stops at its start: {stopped.reason}") from stopped
    _check_agreement(results, fast)
    found: list[_Place] = []
    source = recording.path / "recording.yaml"
    for channel in recording.channels.values():
        variable, index = place_of(results, channel.target, source)
        component, _, name = str(variable.name).partition(".")
        key = component, name
        if key not in fast.recorded:
            raise NotFast(f"{component}.{name} is not recorded")
        own = str(variable.attrs.get("units", "1"))
        unit = own if channel.target.si_unit == "1" else channel.target.si_unit
        factor, offset = conversion(own, unit)
        is_flow = channel.target.quantity in ("current", "voltage", "power")
        found.append((fast.recorded[key].start + index, factor, offset, is_flow, unit))
    return found


def _check_agreement(results: xr.Dataset, fast: FastSystem) -> None:
    """Compare the first outputs of the co-simulation with those of compiled code.

    Raises:
        NotFast: They are not the same.
    """
    values = resolve(fast)
    if values is None:
        raise NotFast("a simulation stops; `cosim run` tells why")
    count = len(results["time"])
    for (component, name), columns in fast.recorded.items():
        variable = f"{component}.{name}"
        if variable in results and results[variable].dtype == np.float64:
            there = results[variable].values.reshape(count, -1)
            mine, size = values[:, columns], float(np.std(values[:, columns])) or 1.0
            if np.max(np.abs(mine[:count] - there), initial=0.0) > AGREED * size:
                raise NotFast(f"{variable} is not what `cosim run` gives")


@dataclass(frozen=True)
class SystemLaws:
    """What may be missing or off in a system.

    Args:
        found: Laws at their places.
        sensors: Laws of its sensors.
        usual: Numbers that may be off though nobody says so.
        untried: Where no law can be tried, and why.
        hidden: Components that hide their states.
    """

    found: tuple[Fit, ...]
    sensors: tuple[UnitLaw, ...]
    usual: tuple[Free, ...]
    untried: tuple[str, ...]
    hidden: tuple[str, ...]


def laws_at(
    scenario: Scenario, recordings: Sequence[Recording], free: Sequence[Free], without: Collection[str] = ()
) -> SystemLaws:
    """Laws of the library at every place of a system, those of its sensors, and numbers that may be off unstated.

    Args:
        scenario: What the recordings are compared with.
        recordings: Recordings of it.
        free: Numbers that are stated to be off.
        without: Laws that are hidden.

    Raises:
        NotFast: Only the co-simulation can simulate it.
        CompilerError: There is no C compiler.
        InputError: A scenario is wrong.
    """
    systems = [FastSystem(scenario_of(scenario, r)) for r in recordings]
    try:
        places = places_of(systems)
        usual = usual_numbers(systems[0], free)
        states = {f"{own.component}.{name}" for own in places for name in own.states_read}
    finally:
        for system in systems:
            system.close()
    laws = [law for law in library() if law.identifier not in without]
    step, macro = sample_step(recordings), nanoseconds(scenario.time.macro_step) * 1e-9
    sensors = [
        law
        for law in sensor_laws_of(reach_of(recordings, states), step, macro)
        if law.place.term.identifier not in without
    ]
    untried = tuple(text for own in places for text in own.untried)
    longest = max((float(np.ptp(c.times)) for r in recordings for c in r.channels.values()), default=0.0)
    hidden = tuple(own.component for own in places if own.is_hidden)
    return SystemLaws(tuple(fits(places, laws, step, macro, longest)), tuple(sensors), tuple(usual), untried, hidden)


def sample_step(recordings: Sequence[Recording]) -> float:
    """Typical time between two readings [s]."""
    steps = [np.median(np.diff(c.times)) for r in recordings for c in r.channels.values() if len(c.times) > 1]
    return float(np.median(steps)) if steps else 1.0
