"""Measured beside simulated: one simulation of the scenario, as it is, under the conditions of a recording."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import xarray as xr
from scipy.linalg.blas import dtbsv

from cosim.components import FabricComponent, ProgrammeComponent
from cosim.estimate import computing_time
from cosim.run import RunStopped
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.check.feedthrough import QUIETER, quieter, settled
from diagnosis.check.outage import without_unknown
from diagnosis.check.starts import runs_from_starts
from diagnosis.models.systems.run import run_quickly
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import FEWEST_VALUES, Channel, Recording
from diagnosis.recording.series import MOST, Series, sample, series_of
from diagnosis.report.user_units import Units, written_units
from diagnosis.search.free_numbers import check_stated

#: Macro-steps beyond which a simulation is no matter of seconds; a longer recording is compared with its first part.
MOST_STEPS = 400_000
#: Samples of a channel that a regression looks at; more are thinned, which costs resolution in time and no truth.
MOST_SAMPLES = 500
#: Starts from which a fabric is simulated: they tell how far contacts scatter.
STARTS = 3
#: Computing time of these on one core beyond which a fabric is not simulated [s].
LONGEST = 900.0
#: Time constants of the lags that recalibrate a simulated channel.
LAGS = 5
#: Discrepancy of a model that has been recalibrated and lacks some physics, as a share of a channel's own deviation:
#: what
#: explains less than its square of the variance is no evidence against it. On 96 recordings with concealed effects
#: and 12 of
#: other laboratories the largest was 0.06. Kennedy, O'Hagan, J. R. Stat. Soc. B 63 (2001) 425-464.
DISCREPANCY = 0.1
#: Share of a value that a table's decimals and a solver's rounding come to, of a sensor without noise.
ROUNDING = 1e-9


@dataclass(frozen=True)
class Course:
    """One element of a programme's output over the recording.

    Args:
        name: `component.output`, with its element if it has several.
        unit: Unit of the values.
        times: Instants [s] from which a value holds, shape (points,), rising.
        values: Shape (points,).
        is_recorded: Whether it comes from a column of the recording.
        is_linear: Whether straight lines join the points.
    """

    name: str
    unit: str
    times: Array
    values: Array
    is_recorded: bool
    is_linear: bool = False

    def switches(self) -> Array:
        """Instants at which the value changes [s]."""
        return np.asarray(self.times[1:][np.diff(self.values) != 0.0])

    def at(self, times: Array) -> Array:
        """Values that hold at given times [s]; before the first point its own."""
        return np.asarray(self.values[np.maximum(np.searchsorted(self.times, times, side="right") - 1, 0)])


@dataclass(frozen=True)
class Beside:
    """A channel beside its simulation.

    Args:
        channel: As it was measured.
        simulated: On the output grid of the run; None where nothing was simulated.
        pick: Numbers of the samples that regressions look at, shape (picked,).
        lags: Time constants of `lagged` [s], shape (LAGS,).
        lagged: The simulated course through each lag once, and twice but for the longest, shape (2 LAGS - 1, outputs).
        scatter: What contacts do: standard deviation of one more fabric about the mean over starts, SI; else 0.
    """

    channel: Channel
    simulated: Series | None
    pick: np.ndarray[tuple[int], np.dtype[np.int64]]
    lags: Array
    lagged: Array
    scatter: float = 0.0
    #: What was computed of it once; see `diagnosis.check.explain.basis` and `diagnosis.check.readings`.
    memo: dict[str, object] = field(default_factory=dict, init=False, repr=False, compare=False)

    @cached_property
    def times(self) -> Array:
        """Of the picked samples [s]."""
        return self.channel.times[self.pick]

    @cached_property
    def measured(self) -> Array:
        """Picked readings, SI."""
        return self.channel.values[self.pick]

    def at(self, times: Array) -> Array:
        """Simulated values at given times; beyond the run its end values hold."""
        assert self.simulated is not None
        return sample(self.simulated, times)

    def behind(self, lag: float) -> Array:
        """Simulated values at the picked samples, behind a first-order lag [s]."""
        assert self.simulated is not None
        course = self.simulated
        # beside fitted numbers it is known at the readings alone, which need not be at equal steps
        even = np.linspace(course.times[0], course.times[-1], len(course.times))
        return np.asarray(sample(replace(course, times=even, values=lagged(even, self.at(even), lag)), self.times))

    @cached_property
    def simulated_there(self) -> Array:
        """Simulated values at the picked samples."""
        return self.at(self.times)

    @cached_property
    def floor(self) -> float:
        """Standard deviation below which a misfit says nothing: noise, rounding, contacts, lines between outputs."""
        own = float(np.sqrt(self.channel.deviation**2 + self.channel.quantum**2 / 12.0 + self.scatter**2))
        if self.simulated is None or len(self.simulated.values) < 3:
            return own
        own = float(np.hypot(own, ROUNDING * np.max(np.abs(self.simulated.values))))
        # the error of a straight line between outputs is an eighth of the second difference
        bend = np.diff(self.simulated.values, 2) / 8.0
        return float(np.sqrt(own**2 + np.mean(bend**2)))

    @cached_property
    def tolerance(self) -> float:
        """The same with the discrepancy that any model has."""
        return float(np.hypot(self.floor, DISCREPANCY * np.std(self.measured)))

    @property
    def is_comparable(self) -> bool:
        """Whether it was simulated and has readings enough to be held against that."""
        return self.simulated is not None and len(self.pick) >= FEWEST_VALUES

    @property
    def is_place(self) -> bool:
        """Whether it is a coordinate of a fabric's marker or link."""
        return self.channel.target.kind in ("marker", "link") and self.channel.target.quantity in ("x", "y", "z")

    @cached_property
    def moves(self) -> bool:
        """Whether the simulated channel changes by more than can be seen."""
        if self.simulated is None:
            return False
        values = self.simulated_there
        return bool(np.isfinite(values).all() and np.std(values) > 3.0 * self.floor)


@dataclass(frozen=True)
class Compared:
    """A recording beside the simulation of its scenario.

    Args:
        recording: What was measured, without readings that cannot be compared as an input is not known.
        whole: With these.
        scenario: The scenario under the conditions of the recording.
        channels: By name.
        courses: What drives it.
        note: Why nothing was simulated; else empty.
        results: Of the run.
        base: The scenario without these conditions.
    """

    recording: Recording
    whole: Recording
    scenario: Scenario
    channels: Mapping[str, Beside]
    courses: tuple[Course, ...]
    note: str = ""
    results: xr.Dataset | None = field(default=None, repr=False)
    base: Scenario | None = None

    @cached_property
    def units(self) -> Units:
        """Units that the recording was written in: what is shown of it is shown in them."""
        return written_units([self.recording])

    def units_of(self, channel: str) -> Units:
        """The same with the unit of one channel first: channels of one kind may be written in several units."""
        return self.units.of(channel)

    @cached_property
    def begin(self) -> float:
        """First sample [s]."""
        return min(float(c.times[0]) for c in self.recording.channels.values())

    @property
    def end(self) -> float:
        """Last sample [s]."""
        return self.recording.end

    @cached_property
    def drive(self) -> str:
        """What a response is earlier or later than, in words."""
        moving = [c for c in self.courses if len(c.switches())]
        return "its recorded input" if moving and all(c.is_recorded for c in moving) else "its programme"

    def switches(self) -> Array:
        """Instants within the recording at which a programme changes [s], rising."""
        found = [c.switches() for c in self.courses]
        every = np.unique(np.concatenate([np.zeros(0), *found]))
        return np.asarray(every[(every > self.begin) & (every < self.end)])


def direct(compared: Compared, times: Array) -> Array:
    """What drives a recording, as a sensor sees it that answers it at once; shape (courses that change, times).

    A transfer function may have a direct term: a reading that rises with the power before the body does comes early by
    no clock.
    """
    rows = [c.at(times) for c in compared.courses]
    return np.array([r for r in rows if np.ptp(r) > 0.0]).reshape(-1, len(times))


def held_inputs(courses: Sequence[Course]) -> list[tuple[Array, Array]]:
    """Instants [s] and values of each input that holds its values, from each instant on."""
    return [(c.times, c.values) for c in courses if not c.is_linear]


def compare(scenario: Scenario, recording: Recording, results: xr.Dataset | None = None) -> Compared:
    """Simulate a scenario under the conditions of a recording.

    Args:
        scenario: As the recordings are compared with.
        recording: What was measured.
        results: Of `cosim.run.run` under these conditions, where they are known already.

    Raises:
        InputError: The recording does not fit the scenario.
    """
    own = scenario_of(scenario, recording)
    check_stated(own, recording)
    note, runs = "", [results] if results is not None else []
    if results is None:
        note = _hindrance(own)
        if not note and has_fabric(own):
            runs, stopped = runs_from_starts(own, STARTS)
            note = f"{STARTS - len(runs)} of {STARTS} simulations stopped: {stopped}" if stopped else ""
        elif not note:
            try:
                runs = [run_quickly(own)]
            except RunStopped as error:
                note = f"the simulation stopped: {error.reason}"
        results = runs[0] if runs else None
    courses = tuple(_courses(own, recording))
    recording = replace(
        recording, channels={n: _settled(c, recording, courses, results) for n, c in recording.channels.items()}
    )
    whole = recording
    if results is not None and not has_fabric(own):
        recording = without_unknown(scenario, recording, results)
    channels = {n: _beside(c, runs, recording.path / "recording.yaml") for n, c in recording.channels.items()}
    if len(runs) > 1:
        channels = _pooled(channels)
    return Compared(recording, whole, own, channels, courses, note, results, scenario)


def has_fabric(scenario: Scenario) -> bool:
    """Whether contacts scatter in its simulation."""
    return any(isinstance(c, FabricComponent) for c in scenario.components.values())


def _hindrance(scenario: Scenario) -> str:
    """Why a scenario cannot be simulated in seconds; empty if it can."""
    if has_fabric(scenario) and (seconds := computing_time(scenario, STARTS)) > LONGEST:
        return (
            f"{STARTS} simulations of this fabric take about {seconds / 60.0:.0f} min on one core: only the readings "
            "by themselves were looked at"
        )
    steps = scenario.time.macro_steps
    if steps > MOST_STEPS:
        return (
            f"the recording lasts {steps} macro-steps, which takes more than seconds to simulate: only the "
            f"readings "
            "by themselves were looked at; is the unit of its clock right?"
        )
    return ""


def _courses(scenario: Scenario, recording: Recording) -> list[Course]:
    recorded = {f"{i.component}.{i.output}" for i in recording.inputs}
    start = scenario.time.start.to("s")
    found = []
    for name, component in scenario.components.items():
        if not isinstance(component, ProgrammeComponent):
            continue
        for output, given in component.outputs.items():
            key = f"{name}.{output}"
            points = given.points if given.points is not None else [(None, given.constant)]
            times = np.array([start if t is None else t.to("s") for t, _ in points])
            rows = [v if isinstance(v, list) else [v] for _, v in points]
            values = np.array([[e.to(given.unit) for e in row if e is not None] for row in rows])
            many = values.shape[1] > 1
            found += [
                Course(
                    f"{key}[{k + 1}]" if many else key,
                    given.unit,
                    times,
                    values[:, k],
                    key in recorded,
                    given.interpolation == "linear",
                )
                for k in range(values.shape[1])
            ]
    return found


def _settled(channel: Channel, recording: Recording, courses: Sequence[Course], results: xr.Dataset | None) -> Channel:
    """The channel as it can be compared where it follows an input at once, with a noise that nobody stated."""
    if results is None or channel.later:
        return channel
    source = recording.path / "recording.yaml"
    series = series_of(results, channel.target, source)
    _check_finite(series, channel, source)
    if channel.target.is_component:
        channel = settled(channel, series, held_inputs(courses))
    if channel.is_deviation_given:
        return channel
    noise = quieter(channel, series)
    return replace(channel, deviation=noise) if noise < QUIETER * channel.deviation else channel


def _check_finite(series: Series, channel: Channel, source: Path) -> None:
    """Raises `InputError` where a simulation has run away."""
    away = np.flatnonzero(~np.isfinite(series.values))
    if len(away):
        raise InputError(
            source,
            f"channels.{channel.name}",
            f"the simulation of this recording runs away: from {series.times[away[0]]:.6g} s on its values are beyond "
            f"{MOST:g} or no numbers",
            "an FMU that integrates itself may be unstable under these inputs: a shorter `time.macro_step` helps where "
            "its steps are that long; else export it with shorter ones, or for Model Exchange",
        )


def _beside(channel: Channel, runs: Sequence[xr.Dataset], source: Path) -> Beside:
    step = max(1, -(-len(channel.times) // MOST_SAMPLES))
    pick = np.flatnonzero(~channel.is_clipped)[::step] if not channel.is_clipped.all() else np.zeros(0, np.int64)
    if not runs:
        return Beside(channel, None, pick, np.zeros(0), np.zeros((0, 0)))
    every = [series_of(results, channel.target, source) for results in runs]
    values = np.array([one.values for one in every])
    for one in every:
        _check_finite(one, channel, source)
    series = replace(every[0], values=values.mean(axis=0)) if len(runs) > 1 else every[0]
    span = float(channel.times[-1] - channel.times[0])
    least = 2.0 * float(np.median(np.diff(channel.times)))
    lags = np.geomspace(least, max(0.5 * span, 2.0 * least), LAGS)
    once = [lagged(series.times, series.values, lag) for lag in lags]
    twice = [lagged(series.times, values, lag) for values, lag in zip(once[:-1], lags)]
    return Beside(channel, series, pick, lags, np.stack([*once, *twice]), _scatter(values))


def _scatter(values: Array) -> float:
    """Standard deviation of one more run about the mean of those given, shape (runs, outputs), over all outputs."""
    count = len(values)
    if count < 2:
        return 0.0
    return float(np.sqrt((1.0 + 1.0 / count) * np.mean(np.var(values, axis=0, ddof=1))))


def _pooled(channels: Mapping[str, Beside]) -> dict[str, Beside]:
    """Scatter of a channel is at least that of its kind: of three starts one channel's own may be small by chance."""
    kinds: dict[tuple[str, str], list[float]] = {}
    for b in channels.values():
        kinds.setdefault((b.channel.target.kind, b.channel.target.quantity), []).append(b.scatter)
    usual = {kind: float(np.sqrt(np.mean(np.square(own)))) for kind, own in kinds.items()}
    least = {n: usual[b.channel.target.kind, b.channel.target.quantity] for n, b in channels.items()}
    return {n: replace(b, scatter=max(b.scatter, least[n])) for n, b in channels.items()}


def lagged(times: Array, values: Array, time_constant: float) -> Array:
    """A course behind a first-order lag [s], on its own grid of equal steps; it begins settled."""
    if len(times) < 2:
        return values
    keep = float(np.exp(-(times[1] - times[0]) / time_constant))
    # y[n] - keep * y[n - 1] = (1 - keep) * x[n], solved forwards; scipy.signal takes more than a second to load
    band = np.full((2, len(values)), -keep, order="F")
    found = dtbsv(1, band, (1.0 - keep) * (values - values[0]), lower=1, diag=1)
    return np.asarray(found + values[0])
