"""Runs of a recording's scenario in which some of its inputs have other courses."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from cosim.components import nanoseconds
from cosim.programme import Course as Programme
from cosim.run import RunStopped
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside, Compared, Course
from diagnosis.check.odd_one_out import left, scaled_left
from diagnosis.models.coil_network.kernel.compiler import CompilerError
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.run import SystemRuns, is_system, run_quickly
from diagnosis.recording.conditions import on_grid, scenario_of
from diagnosis.recording.recording import Input
from diagnosis.recording.series import sample, series_of

#: Macro-steps beyond which nothing is estimated: a simulation of so many takes a tenth of a second or more.
MOST = 40_000


def of_one_element(one: Compared) -> list[Course]:
    """Courses of inputs that can be a column: of one element."""
    return [c for c in one.courses if not c.name.endswith("]")]


def is_quick(scenario: Scenario) -> bool:
    """Whether fifty simulations of each input take seconds: compiled code runs systems of FMUs, and nothing else."""
    return is_system(scenario) and scenario.time.macro_steps <= MOST


def given_as(course: Course, times: Array, values: Array) -> Input:
    """An input with other times [s] and values than its course."""
    component, _, output = course.name.partition(".")
    return Input(component, output, course.unit, times, values)


def readings_of(results: xr.Dataset, beside: Beside, one: Compared) -> Array:
    """Simulated readings of a channel, at its samples."""
    series = series_of(results, beside.channel.target, one.recording.path / "recording.yaml")
    return np.asarray(sample(series, beside.times))


def left_by(results: xr.Dataset | None, channels: dict[str, Beside], one: Compared) -> float:
    """Largest share of a channel's variance that a run leaves, scaled and shifted as suits best; infinite of none."""
    if results is None:
        return math.inf
    return max(scaled_left(b, readings_of(results, b, one)) for b in channels.values())


def parts_of(channels: dict[str, Beside], every: Array) -> list[Array]:
    """Rows of each channel."""
    ends = np.cumsum([len(b.times) for b in channels.values()])
    return np.split(every, ends[:-1])


class InputRuns:
    """Runs of the scenario of one recording, whose FMUs stay loaded until `close`.

    Args:
        one: A recording whose scenario is a system of FMUs.
    """

    def __init__(self, one: Compared) -> None:
        assert one.base is not None
        self.one = one
        self._base = one.base
        self._linear = {c.name: c.is_linear for c in one.courses}
        try:
            self._system: SystemRuns | None = SystemRuns(one.scenario)
        except (InputError, NotFast, CompilerError):
            self._system = None  # the co-simulation alone can run it

    def close(self) -> None:
        """Free the FMUs; safe to call twice."""
        if self._system is not None:
            self._system.close()
        self._system = None

    def results(self, given: Sequence[Input]) -> xr.Dataset:
        """A run with some inputs in place of those that are stated; raises `RunStopped` where it runs away."""
        if self._system is not None:
            found = self._system.with_courses({(i.component, i.output): self._programme(i) for i in given})
            if found is not None:
                return found
        names = {(i.component, i.output) for i in given}
        inputs = (*(i for i in self.one.recording.inputs if (i.component, i.output) not in names), *given)
        return run_quickly(scenario_of(self._base, replace(self.one.recording, inputs=inputs)))

    def readings(self, channels: dict[str, Beside], given: Sequence[Input]) -> Array:
        """Simulated readings of all channels one after another; raises `RunStopped` where it runs away."""
        results = self.results(given)
        return np.concatenate([readings_of(results, b, self.one) for b in channels.values()])

    def left_with(self, channels: dict[str, Beside], given: Sequence[Input]) -> float:
        """Largest share of a channel's variance that is left with some inputs; infinite where the run goes away."""
        try:
            parts = parts_of(channels, self.readings(channels, given))
        except RunStopped:
            return math.inf
        return max(left(b, part) for b, part in zip(channels.values(), parts))

    def missed_with(self, channels: dict[str, Beside], course: Course) -> Callable[[Array, Array], float]:
        """What times [s] and values in place of a course leave of the channel that they explain least."""

        def missed(times: Array, values: Array) -> float:
            try:
                parts = parts_of(channels, self.readings(channels, (given_as(course, times, values),)))
            except RunStopped:
                return 1.0
            return max(scaled_left(b, part) for b, part in zip(channels.values(), parts))

        return missed

    def _programme(self, given: Input) -> Programme:
        """What a programme gives: its points lie on the grid of macro-steps, as `scenario_of` puts them."""
        macro = nanoseconds(self.one.scenario.time.macro_step)
        steps, values = on_grid(given, macro * 1e-9)
        is_linear = self._linear[f"{given.component}.{given.output}"]
        return Programme(tuple((steps * macro).tolist()), values, given.unit, None, is_linear)
