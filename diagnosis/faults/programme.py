"""Outputs of programmes that were others than stated within an interval, for models that the co-simulation runs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.components import ProgrammeComponent, ProgrammeOutput, nanoseconds
from cosim.scenario import Scenario
from cosim.unit.protocol import AnyArray, Array
from cosim.unit.quantity import PhysicalValue
from diagnosis.faults.law import INPUT, Span, fault_term, occasion
from diagnosis.faults.network_inputs import gain
from diagnosis.recording.recording import Recording
from diagnosis.search.problem import Term

#: A temperature is no input that is a share off: of a room that is another the catalogue has laws.
_TEMPERATURES = ("K", "degC")
#: Second per nanosecond.
_NANO = 1e-9


def programme_inputs(scenarios: Sequence[Scenario], recordings: Sequence[Recording]) -> dict[Term, tuple[str, str]]:
    """A fault of every output of every programme that is not 0 throughout, with its component and its name.

    Args:
        scenarios: Of each recording.
        recordings: The recordings.
    """
    found = {}
    for number, (scenario, recording) in enumerate(zip(scenarios, recordings)):
        times = np.unique(np.concatenate([c.times for c in recording.channels.values()]))
        span = Span(scenario.time.start.to("s"), float(times[-1]), len(times))
        for name, component in scenario.components.items():
            if not isinstance(component, ProgrammeComponent) or not span.begin < span.end:
                continue
            for output, given in component.outputs.items():
                if given.unit not in _TEMPERATURES and np.any(_values(given)):
                    label = occasion(f"{name}.{output}", [r.title for r in recordings], number)
                    found[fault_term(INPUT, label, gain(), span, number)] = (name, output)
    return found


def with_gain(given: ProgrammeOutput, fault: tuple[float, float, float], scenario: Scenario) -> ProgrammeOutput:
    """The output times 1 + gain within an interval.

    A macro-step that lies in it in part has that part of the gain, so that the interval may begin and end anywhere:
    programmes switch between macro-steps alone.

    Args:
        given: As it is stated.
        fault: Gain, begin [s], end [s].
        scenario: What runs it; its start and macro-step make the grid.
    """
    amount, begin, end = fault
    start, step = (nanoseconds(t) for t in (scenario.time.start, scenario.time.macro_step))
    first, last = (int((edge / _NANO - start) // step) for edge in (begin, end))
    own = [nanoseconds(t) for t, _ in given.points or []]
    grid = [start + n * step for n in (first, first + 1, last, last + 1) if n >= 0]
    times = np.array(sorted({start, *own, *grid}), dtype=np.int64)
    values = _at(given, own, times)
    is_linear = given.points is not None and given.interpolation == "linear"
    low = (times - (step // 2 if is_linear else 0)) * _NANO
    inside = np.clip((np.minimum(low + step * _NANO, end) - np.maximum(low, begin)) / (step * _NANO), 0.0, 1.0)
    moved = values * (1.0 + amount * inside).reshape(-1, *[1] * (values.ndim - 1))
    points = [(PhysicalValue(t * _NANO, "s"), _quantity(v, given.unit)) for t, v in zip(times.tolist(), moved)]
    return given.model_copy(update={"constant": None, "points": points})


def _values(given: ProgrammeOutput) -> Array:
    """Values of its points, shape (points,) or (points, elements), in its unit."""
    values = [given.constant] if given.points is None else [v for _, v in given.points]
    return np.array([[x.to(given.unit) for x in v] if isinstance(v, list) else v.to(given.unit) for v in values if v])


def _at(given: ProgrammeOutput, own: Sequence[int], times: AnyArray) -> Array:
    """Values at instants [ns]; before the first and after the last point their values hold."""
    values = _values(given)
    if given.points is None:
        return np.repeat(values, len(times), axis=0)
    if given.interpolation == "hold":
        return np.asarray(values[np.maximum(np.searchsorted(own, times, side="right") - 1, 0)])
    columns = values.reshape(len(own), -1).T
    return np.stack([np.interp(times, own, c) for c in columns], axis=-1).reshape(len(times), *values.shape[1:])


def _quantity(value: Array, unit: str) -> PhysicalValue | list[PhysicalValue]:
    if np.ndim(value):
        return [PhysicalValue(float(v), unit) for v in value]
    return PhysicalValue(float(value), unit)
