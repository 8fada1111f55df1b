"""Clocks of an FMI 3.0 Co-Simulation FMU with Event Mode (FMI 3.0, section 2.2.9).

Time-based input clocks (constant, fixed, tunable, changing, countdown) are ticked here at their times; triggered input
clocks tick when the output that is connected to them has ticked. Output clocks are read in Event Mode.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from cosim.fmu.binding import Binding
from cosim.fmu.variables import FmuVariable
from cosim.unit.protocol import AnyArray, Causality, VariableType

_UNCHANGED, _CHANGED = 1, 2
_PERIODIC = ("constant", "fixed", "tunable", "changing")


@dataclass
class TimedClock:
    """An input clock that ticks by time.

    Args:
        reference: Its value reference.
        kind: Its interval variability.
        next_tick: Time of its next tick [s]; None: not known yet, or never.
        ticks: How many it has had with its present interval.
        origin: Time from which they are counted [s].
        interval: Time between them [s].
    """

    reference: int
    kind: str
    next_tick: float | None = None
    ticks: int = 0
    origin: float = 0.0
    interval: float = math.nan

    def state(self) -> tuple[float, ...]:
        """Everything that changes."""
        return (math.nan if self.next_tick is None else self.next_tick, self.ticks, self.origin, self.interval)

    def take(self, state: Iterable[float]) -> None:
        """Return to what `state` gave."""
        tick, ticks, self.origin, self.interval = (float(x) for x in state)
        self.next_tick, self.ticks = (None if math.isnan(tick) else tick), int(ticks)


class Clocks:
    """All clocks of one instance.

    Args:
        binding: The FMU; it has Event Mode.
        variables: Its inputs and outputs.
        values: Their buffers; those of clocks are true while the clock ticks.
    """

    def __init__(self, binding: Binding, variables: Mapping[str, FmuVariable], values: Mapping[str, AnyArray]) -> None:
        clocks = {n: v for n, v in variables.items() if v.variable.type is VariableType.CLOCK}
        self.is_empty = not clocks
        #: Clocked input to the references of its clocks: it may be set only while one of them ticks.
        self.clocked = {
            n: {c.valueReference for c in v.declared[0].clocks or ()}
            for n, v in variables.items()
            if v.variable.causality is Causality.INPUT and n not in clocks and v.declared[0].clocks
        }
        self._values = values
        self._inputs = {n: v.value_references[0] for n, v in clocks.items() if v.variable.causality is Causality.INPUT}
        self._outputs = {n: v.value_references[0] for n, v in clocks.items() if n not in self._inputs}
        timed = {v.value_references[0]: v.declared[0].intervalVariability for v in clocks.values()}
        self.timed = [TimedClock(r, timed[r]) for r in self._inputs.values() if timed[r] != "triggered"]
        self._ticking: set[int] = set()
        if not self.is_empty:
            access = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p
            self._set = binding.checked("SetClock", *access)
            self._get = binding.checked("GetClock", *access)
            self._interval = binding.checked("GetIntervalDecimal", *access, ctypes.c_void_p)
            self._shift = binding.checked("GetShiftDecimal", *access)
        self._reference, self._flag = ctypes.c_uint32(), ctypes.c_bool()
        self._number, self._qualifier = ctypes.c_double(), ctypes.c_int()

    def _ask(self, function: Callable[..., None], reference: int, *results: object) -> None:
        self._reference.value = reference
        function(ctypes.addressof(self._reference), 1, *(ctypes.addressof(r) for r in results))  # type: ignore[arg-type]

    def begin(self, time: float) -> None:
        """First ticks, asked for in the first Event Mode at `time` [s]."""
        for clock in self.timed:
            if clock.kind in _PERIODIC:
                self._ask(self._shift, clock.reference, self._number)
                self._ask_interval(clock, time + self._number.value)
                if clock.interval > 0.0:
                    clock.next_tick = clock.origin
            else:
                self._ask_interval(clock, time)

    def _ask_interval(self, clock: TimedClock, origin: float) -> None:
        self._qualifier.value = _UNCHANGED
        self._ask(self._interval, clock.reference, self._number, self._qualifier)
        if clock.kind == "countdown":
            if self._qualifier.value == _CHANGED:
                clock.next_tick = origin + self._number.value
        elif self._qualifier.value == _CHANGED or math.isnan(clock.interval):
            clock.interval, clock.origin, clock.ticks = self._number.value, origin, 0

    @property
    def next_tick(self) -> float | None:
        """Time of the next tick by time [s]."""
        return min((c.next_tick for c in self.timed if c.next_tick is not None), default=None)

    def silence(self) -> None:
        """A new step begins: no output clock has ticked in it yet. Input clocks that were set tick in it."""
        for name in self._outputs:
            self._values[name][...] = False

    def activate(self, now: float, instant: float, write: Callable[[str], None]) -> None:
        """Set the input clocks that tick, by time or connection, then the inputs that belong to them.

        Args:
            now: Time [s].
            instant: What counts as the same time [s].
            write: Hands one input to the FMU.
        """
        ticking = {r for n, r in self._inputs.items() if self._values[n]}
        for clock in self.timed:
            if clock.next_tick is not None and clock.next_tick <= now + instant:
                ticking.add(clock.reference)
                clock.ticks += 1
                # Multiples of the interval, not sums: the thousandth tick is where it belongs.
                periodic = clock.kind in _PERIODIC
                clock.next_tick = clock.origin + clock.ticks * clock.interval if periodic else None
        for name, reference in self._inputs.items():
            if reference in ticking:
                self._values[name][...] = True
                self._flag.value = True
                self._ask(self._set, reference, self._flag)
        for name, clocks in self.clocked.items():
            if clocks & ticking:
                write(name)
        self._ticking = ticking

    def read(self) -> None:
        """Note which output clocks tick in this iteration of Event Mode."""
        for name, reference in self._outputs.items():
            self._ask(self._get, reference, self._flag)
            if self._flag.value:
                self._values[name][...] = True

    def ask_intervals(self, now: float) -> None:
        """After an update of the discrete states: intervals that change while the simulation runs."""
        for clock in self.timed:
            if clock.kind == "changing" and clock.reference in self._ticking:
                before = clock.interval
                self._ask_interval(clock, now)
                if clock.interval != before:
                    clock.ticks, clock.next_tick = 1, now + clock.interval
            elif clock.kind == "countdown":
                self._ask_interval(clock, now)
        for name in self._inputs:
            self._values[name][...] = False
