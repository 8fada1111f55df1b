"""Outputs of programmes that were others than stated within an interval, for models that the co-simulation runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.components import ProgrammeComponent, ProgrammeOutput, nanoseconds
from cosim.formula import to_base
from cosim.scenario import Scenario
from cosim.unit.protocol import AnyArray, Array
from cosim.unit.quantity import PhysicalValue, conversion
from diagnosis.faults.law import (
    HELD,
    INPUT,
    LEVEL,
    STAYED,
    Span,
    added,
    fault_term,
    gain,
    is_zero,
    level_of,
    level_term,
    occasion,
    unstated_terms,
    zero_stretches,
)
from diagnosis.recording.recording import Recording
from diagnosis.recording.units import si_unit
from diagnosis.search.problem import Term

#: A temperature is no input that is a share off: of a room that is another the catalogue has laws.
_TEMPERATURES = ("K", "degC")
#: Second per nanosecond.
_NANO = 1e-9


@dataclass(frozen=True)
class InputChange:
    """What a fault does to an output of a programme.

    Args:
        amount: Share of what is stated, or a value in the unit of the output that acts where nothing is stated.
        begin: [s].
        end: [s].
        is_added: Whether it acts where nothing is stated.
        is_everywhere: Whether it is added to whatever is stated.
        is_held: Whether the amount is a share of the way back to what is stated where it begins.
        is_level: Whether the amount is the value that acts in the place of what is stated.
    """

    amount: float
    begin: float
    end: float
    is_added: bool = False
    is_everywhere: bool = False
    is_held: bool = False
    is_level: bool = False

    def key(self) -> tuple[str, str, str, bool, bool, bool, bool]:
        """Every number to its last bit."""
        numbers = self.amount.hex(), self.begin.hex(), self.end.hex()
        return *numbers, self.is_added, self.is_everywhere, self.is_held, self.is_level

    def shares(self, low: Array, step: float) -> Array:
        """Share of each macro-step that lies in the interval, shape (steps,).

        Args:
            low: Begins of the macro-steps [s].
            step: Macro-step [s].
        """
        inside = np.minimum(low + step, self.end) - np.maximum(low, self.begin)
        return np.asarray(np.clip(inside / step, 0.0, 1.0))

    def change(self, stated: Array, shares: Array, size: Array | None = None) -> Array:
        """What acts beside what is stated, shape (steps,) or (steps, elements).

        Args:
            stated: In the unit of the output.
            shares: See `shares`.
            size: Largest stated value without its sign, shape () or (elements,); None: of `stated`, which is all.
        """
        inside = np.flatnonzero(shares)
        shares = shares.reshape(-1, *[1] * (stated.ndim - 1))
        if self.is_held:
            stays = stated[inside[0]] if len(inside) else stated
            return np.asarray(self.amount * shares * (stays - stated))
        if self.is_level:
            return np.asarray(shares * (self.amount - stated))
        if not self.is_added:
            return np.asarray(stated * self.amount * shares)
        if self.is_everywhere:
            return np.asarray(self.amount * shares * np.ones_like(stated))
        return np.asarray(np.where(is_zero(stated, size), self.amount * shares, 0.0))


def input_change(term: Term, values: Sequence[float], given: ProgrammeOutput) -> InputChange:
    """What a term of `programme_inputs` does to its output."""
    amount, begin, end, *more = values
    if term.identifier == LEVEL.identifier:
        factor, offset = conversion(term.parameters[-1].unit, given.unit)
        return InputChange(factor * more[0] + offset, begin, end, is_level=True)
    if term.identifier == INPUT.identifier:
        return InputChange(amount, begin, end)
    if term.identifier == HELD.identifier:
        return InputChange(amount, begin, end, is_held=True)
    return InputChange(amount / to_base(given.unit)[0], begin, end, True)


def programme_inputs(scenarios: Sequence[Scenario], recordings: Sequence[Recording]) -> dict[Term, tuple[str, str]]:
    """A fault of every output of every programme that is not 0 throughout, with its component and its name.

    Args:
        scenarios: Of each recording.
        recordings: The recordings.
    """
    found = {}
    for number, span, label, end, given in _outputs(scenarios, recordings):
        values = _values(given)
        if not np.any(values):
            continue
        found[fault_term(INPUT, label, gain(), span, number)] = end
        stretches = _zero_stretches(given, values, span)
        if stretches:
            largest = to_base(given.unit)[0] * float(np.abs(values).max())
            strength = added(si_unit(given.unit), largest)
            found.update(dict.fromkeys(unstated_terms(label, strength, stretches, span, number), end))
    return found


def held_inputs(scenarios: Sequence[Scenario], recordings: Sequence[Recording]) -> dict[Term, tuple[str, str]]:
    """The same of outputs that may have stayed where they were; what never moves has stayed all the time."""
    return {
        fault_term(HELD, label, STAYED, span, number): end
        for number, span, label, end, given in _outputs(scenarios, recordings)
        if np.ptp(_values(given), axis=0).any()
    }


def level_inputs(scenarios: Sequence[Scenario], recordings: Sequence[Recording]) -> dict[Term, tuple[str, str]]:
    """The same of outputs, temperatures too, that may have stood at a value that is not stated."""
    found = {}
    for number, span, label, end, given in _outputs(scenarios, recordings, has_temperatures=True):
        values = _values(given)
        if values.ndim == 1 and np.ptp(values) > 0.0:
            unit = si_unit(given.unit)
            factor, offset = conversion(given.unit, unit)
            least, most = sorted(factor * float(v) + offset for v in (values.min(), values.max()))
            found[level_term(label, level_of(unit, least, most), span, number)] = end
    return found


def span_of(scenario: Scenario, recording: Recording) -> Span:
    """When a fault of a recording may be: from the begin of its simulation to its last reading."""
    times = np.unique(np.concatenate([c.times for c in recording.channels.values()]))
    return Span(scenario.time.start.to("s"), float(times[-1]), len(times))


def _outputs(
    scenarios: Sequence[Scenario], recordings: Sequence[Recording], has_temperatures: bool = False
) -> Iterator[tuple[int, Span, str, tuple[str, str], ProgrammeOutput]]:
    """Outputs of programmes, temperatures where asked: number of the recording, when, place, component and name."""
    for number, (scenario, recording) in enumerate(zip(scenarios, recordings)):
        span = span_of(scenario, recording)
        for name, component in scenario.components.items():
            if not isinstance(component, ProgrammeComponent) or not span.begin < span.end:
                continue
            for output, given in component.outputs.items():
                if has_temperatures or given.unit not in _TEMPERATURES:
                    label = occasion(f"{name}.{output}", [r.title for r in recordings], number)
                    yield number, span, label, (name, output), given


def _zero_stretches(given: ProgrammeOutput, values: Array, span: Span) -> list[tuple[float, float]]:
    """Stretches in which a scalar output is stated as zero; none of a list."""
    if values.ndim != 1 or given.points is None:
        return []
    times = np.array([t.to("s") for t, _ in given.points])
    zero = is_zero(values)
    if given.interpolation == "linear":
        zero[:-1] &= zero[1:]
    edges = np.clip(np.concatenate([[span.begin], times[1:], [max(span.end, times[-1])]]), span.begin, span.end)
    return zero_stretches(edges, zero)


def with_changes(given: ProgrammeOutput, faults: Sequence[InputChange], scenario: Scenario) -> ProgrammeOutput:
    """The output as faults make it, each of them of what is stated.

    A macro-step that lies in the interval in part has that part of the change, so that the interval may begin and end
    anywhere: programmes switch between macro-steps alone.

    Args:
        given: As it is stated.
        faults: What they do.
        scenario: What runs it; its start and macro-step make the grid.
    """
    start, step = (nanoseconds(t) for t in (scenario.time.start, scenario.time.macro_step))
    edges = [int((edge / _NANO - start) // step) for f in faults for edge in (f.begin, f.end)]
    own = [nanoseconds(t) for t, _ in given.points or []]
    grid = [start + n * step for e in edges for n in (e, e + 1) if n >= 0]
    times = np.array(sorted({start, *own, *grid}), dtype=np.int64)
    values = _at(given, own, times)
    is_linear = given.points is not None and given.interpolation == "linear"
    low = np.asarray((times - (step // 2 if is_linear else 0)) * _NANO, dtype=np.float64)
    moved = values + sum(f.change(values, f.shares(low, step * _NANO)) for f in faults)
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
