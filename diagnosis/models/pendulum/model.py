"""A single pendulum with its recordings: fitted by many arms at a time (`swings`), judged by the co-simulation."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields, replace
from functools import cached_property

import numpy as np

from cosim.assemble import assemble
from cosim.components import PendulumComponent
from cosim.mechanics_assembly import PENDULUM_UNITS
from cosim.scenario import Scenario
from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue
from diagnosis.models.pendulum.batch import LAWS, arm, is_available, swings
from diagnosis.models.sensor_chain import read
from diagnosis.recording.recording import Recording
from diagnosis.recording.series import Series
from diagnosis.search.cosim_model import STEP, CompiledModel, Free
from diagnosis.search.cosim_run import Changes
from diagnosis.search.pendulum_terms import SENSOR_TERMS
from diagnosis.search.problem import Point
from mechanics.pendulum_design import PendulumDesign, behind_play

#: Numbers of a design that a scenario need not give.
_DEFAULTS: Mapping[str, float] = {f.name: f.default for f in fields(PendulumDesign) if f.default is not MISSING}
#: A parameter is moved until a residual moves by so much [deviations], at most by so many of its prior deviations.
SEEN, FARTHEST = 0.3, 0.3
#: How units of torques over rate or angle begin.
TORQUE = "N*m"
_MEASURED = frozenset({"angle", "arm_angle", "angular_velocity"})


@dataclass(frozen=True)
class _Grid:
    """When the unit of one recording tells its state.

    Args:
        values: Numbers of the arm in the scenario, SI.
        micro: Micro-step of the unit [s].
        macro: Macro-step [s].
        times: Of all macro-steps [s], shape (samples,).
        every: Macro-steps per output.
    """

    values: Mapping[str, float]
    micro: float
    macro: float
    times: Array
    every: int


def is_single_pendulum(scenario: Scenario, recordings: Sequence[Recording]) -> bool:
    """Whether a scenario is one pendulum and nothing else, seen in angle or speed, and there is a compiler."""
    components = list(scenario.components.values())
    if len(components) != 1 or not isinstance(components[0], PendulumComponent) or scenario.connections:
        return False
    measured = {c.target.quantity for r in recordings for c in r.channels.values()}
    return measured <= _MEASURED and not components[0].start and is_available()


def without_scale(scenario: Scenario, free: Sequence[Free]) -> tuple[list[Free], float]:
    """Numbers that a free swing can show, and the relative deviation of what it cannot: the scale of all torques.

    The mass, with the arm's shape kept (`PendulumModel.changes_at`), multiplies inertia and weight alike. Where nothing
    else turns the arm it is not fitted: but for rounding, its derivatives are those of all torques that are found.

    Args:
        scenario: Of one recording; a torque that it gives itself sets the scale.
        free: Numbers that may be off.
    """
    values = _grid_of(scenario).values
    is_driven = any(values[n] for n, unit in PENDULUM_UNITS.items() if n in LAWS and unit.startswith(TORQUE))
    is_reshaped = any(f.name == "central_inertia" for f in free)
    masses = [f for f in free if f.name == "mass" and not f.is_own]
    if is_driven or is_reshaped or not masses:
        return list(free), 0.0
    return [f for f in free if f not in masses], masses[0].parameter.deviation


class PendulumModel(CompiledModel):
    """See `CosimModel`; residuals come from `swings`, `predictions` from the co-simulation."""

    has_ridges = True

    def changes_at(self, point: Point, number: int | None) -> Changes:
        """See `CosimModel`; a heavier arm keeps its shape, so that its inertia grows with its mass.

        A free swing shows ratios to the inertia alone. So varied, the mass does nothing but scale torques; were it
        varied by itself, it and the length would do the same, and a fit would crawl along the ridge between them.
        """
        found = super().changes_at(point, number)
        parameters = {component: dict(own) for component, own in found.parameters.items()}
        for own in parameters.values():
            if "mass" in own and "central_inertia" not in own:
                values = self._grids[number or 0].values
                central = values["central_inertia"] * own["mass"].to("kg") / values["mass"]
                own["central_inertia"] = PhysicalValue(central, "kg*m^2")
        return Changes(parameters, found.shifts, found.lists, found.faults)

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`; forward differences: half the arms, and exact enough for their use.

        One deviation of a length turns a swing by some radians; a thousandth of it is bent by 1e-3 of itself.
        """
        slopes = self._slopes(point, np.full(len(self.free), STEP))
        # Friction makes a swing rough: what moves it by less than that must be moved further to be seen.
        strongest = np.max(np.abs(slopes), axis=0, initial=0.0)
        steps = np.clip(SEEN / np.maximum(strongest, 1e-300), STEP, FARTHEST)
        weak = np.flatnonzero(steps > STEP)
        if len(weak):
            slopes[:, weak] = self._slopes(point, steps, weak.tolist())[:, weak]
        return slopes

    def _slopes(self, point: Point, steps: Array, columns: Collection[int] | None = None) -> Array:
        """Forward differences by the z of parameters, all or some, shape (residuals, parameters)."""
        begin = np.concatenate([[0], np.cumsum(self._sizes)])
        found = np.zeros((begin[-1], len(self.free)))
        numbers = range(len(self.recordings))
        wanted = range(len(self.free)) if columns is None else columns
        places = [(i, n) for n in numbers for i in wanted if self.free[i].belongs_to(n)]
        moved = {i: replace(point, base=point.base + steps[i] * (np.arange(len(self.free)) == i)) for i in wanted}
        rows = self._rows([*((point, n) for n in numbers), *((moved[i], n) for i, n in places)])
        for (column, number), row in zip(places, rows[len(numbers) :]):
            with np.errstate(over="ignore", invalid="ignore"):
                slope = (row - rows[number]) / steps[column]
            found[begin[number] : begin[number + 1], column] = np.where(np.isfinite(slope), slope, 0.0)
        return found

    def predictions(self, wanted: Sequence[tuple[Point, int]]) -> list[list[Array] | None]:
        """See `CosimModel`; what faults of sensors add comes from `swings`."""
        found = super().predictions(wanted)
        for i, (point, number) in enumerate(wanted):
            values = found[i]
            if values is not None and any(t.identifier in SENSOR_TERMS for t in point.terms):
                plain = Point(point.base, {t: v for t, v in point.terms.items() if t.identifier not in SENSOR_TERMS})
                with_them, without = self._compiled([(point, number), (plain, number)])
                if with_them is not None and without is not None:
                    found[i] = [v + a - b for v, a, b in zip(values, with_them, without)]
        return found

    def _compiled(self, wanted: Sequence[tuple[Point, int]]) -> list[list[Array] | None]:
        """Values of every channel of recordings at their samples, SI, for points with the number of a recording."""
        numbers = [self._numbers(point, number) for point, number in wanted]
        together: dict[tuple[float, float, int], list[int]] = {}
        for i, ((_, number), values) in enumerate(zip(wanted, numbers)):
            grid = self._grids[number]
            if _is_possible(values):
                together.setdefault((grid.micro, grid.macro, len(grid.times)), []).append(i)
        found: list[list[Array] | None] = [None] * len(wanted)
        for (micro, macro, samples), members in together.items():
            for i, course in zip(members, swings([arm(numbers[i]) for i in members], micro, macro, samples)):
                if np.isfinite(course).all():
                    found[i] = self._read(
                        *wanted[i],
                        {
                            "arm_angle": course[:, 0],
                            "angular_velocity": course[:, 1],
                            "angle": encoded(course[:, 0], numbers[i]["backlash"]),
                        },
                    )
        return found

    def _numbers(self, point: Point, number: int) -> dict[str, float]:
        """All numbers of the arm, SI."""
        values = dict(self._grids[number].values)
        for own in self.changes_at(point, number).parameters.values():
            values.update({n: v.to(PENDULUM_UNITS[n]) for n, v in own.items()})
        return values

    def _read(self, point: Point, number: int, course: Mapping[str, Array]) -> list[Array]:
        """What the sensors read of a course."""
        found, grid = [], self._grids[number]
        for channel in self.recordings[number].channels.values():
            values = course[channel.target.quantity]
            series = Series(grid.times, values, False, channel.unit)
            found.append(read(channel, point.terms, series, grid.macro, grid.every))
        return found

    @cached_property
    def _grids(self) -> list[_Grid]:
        """Of every recording."""
        return [_grid_of(scenario) for scenario in self.scenarios]


def _grid_of(scenario: Scenario) -> _Grid:
    (component,) = scenario.components.values()
    assert isinstance(component, PendulumComponent)
    assembly = assemble(scenario)
    try:
        (resolved,) = assembly.parameters.values()
    finally:
        assembly.system.terminate()
    values = dict(_DEFAULTS)
    for name, value in resolved.values.items():
        assert isinstance(value, PhysicalValue)
        values[name] = value.to(PENDULUM_UNITS[name])
    time = scenario.time
    start, stop, macro = time.start.to("s"), time.stop.to("s"), time.macro_step.to("s")
    count = round((stop - start) / macro)
    times: Array = start + macro * np.arange(count + 1.0)
    every = max(1, round(time.output_step.to("s") / macro))
    return _Grid(values, component.micro_step.to("s"), macro, times, every)


def _is_possible(values: Mapping[str, float]) -> bool:
    """Whether the unit can be built."""
    positive = all(values[n] > 0.0 for n in ("mass", "centre_distance", "gravity", "stribeck_speed", "band_width"))
    return positive and all(math.isfinite(v) for v in values.values()) and values["central_inertia"] >= 0.0


def encoded(angle: Array, play: float) -> Array:
    """Encoder behind a play of this full width [rad], from its middle, shape as given."""
    if play <= 0.0:
        return angle
    found, stands = np.empty_like(angle), float(angle[0])
    for i, now in enumerate(angle.tolist()):
        stands = behind_play(stands, now, play)
        found[i] = stands
    return found
