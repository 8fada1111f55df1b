"""Inputs of an FMU as they were some time ago, for terms that the master adds.

An input is held over a macro-step, so that a delayed input is constant but for jumps at instants that are known: no
value is interpolated. Where the master integrates, it stops at these instants; a Co-Simulation FMU gets the mean over
its step.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cosim.unit.protocol import NANOSECONDS, AnyArray

#: What is practically the same instant [s]: a tenth of the resolution of simulated time.
INSTANT = 0.1 / NANOSECONDS


@dataclass(frozen=True)
class SavedDelay:
    """What a delayed input has to remember.

    Args:
        times: From when on the input had a value [s]; the first is minus infinity.
        values: What it had, one array for each time.
        now: Its delayed value.
    """

    times: tuple[float, ...]
    values: tuple[AnyArray, ...]
    now: AnyArray


class DelayedInput:
    """One input, `by` seconds late; before the first step it had the value of the first step.

    Where no time passes, the delayed value stays; one that is late by nothing is the input itself.

    Args:
        of: Name of the input.
        by: Delay [s].
        outside: Gives the input as it is set.
    """

    def __init__(self, of: str, by: float, outside: Callable[[], AnyArray]) -> None:
        self.of, self.by, self._outside = of, by, outside
        self.begin()

    def begin(self) -> None:
        """Forget everything: a simulation begins."""
        self._times: list[float] = []
        self._values: list[AnyArray] = []
        self._first = math.nan
        self._now: AnyArray | None = None

    @property
    def value(self) -> AnyArray:
        """Its delayed value now, in the unit of the input."""
        return self._outside() if self._now is None or self.by <= INSTANT else self._now

    def hold(self, time: float) -> None:
        """The input has its value from `time` on [s]; what was said of later times does not hold."""
        value = np.array(self._outside())
        if not self._times or time <= self._first + INSTANT:
            self._times, self._values, self._first = [-math.inf], [value], time
            return
        keep = bisect.bisect_left(self._times, time - INSTANT)
        del self._times[keep:], self._values[keep:]
        if not np.array_equal(self._values[-1], value):
            self._times.append(time)
            self._values.append(value)
        past = bisect.bisect_right(self._times, time - self.by - INSTANT) - 1
        if past > 0:
            del self._times[1 : past + 1], self._values[:past]

    def move_to(self, time: float) -> bool:
        """Take the value from `time` on [s]; whether it is another one."""
        before, self._now = self.value, self._values[self._place(time)]
        return not np.array_equal(before, self.value)

    def average(self, begin: float, end: float) -> None:
        """Take the mean value between two times [s]."""
        place, last = self._place(begin), self._place(end - 2.0 * INSTANT)
        if place == last:
            self._now = self._values[place]
            return
        edges = [begin, *(t + self.by for t in self._times[place + 1 : last + 1]), end]
        shares = np.diff(edges) / (end - begin)
        self._now = np.asarray(sum(s * v for s, v in zip(shares.tolist(), self._values[place : last + 1])))

    def next_jump(self, time: float) -> float:
        """When it jumps next after `time` [s], as far as is known."""
        place = self._place(time) + 1
        return self._times[place] + self.by if place < len(self._times) else math.inf

    def _place(self, time: float) -> int:
        """Number of the value that it has from a time on."""
        return max(bisect.bisect_right(self._times, time - self.by + INSTANT) - 1, 0)

    def save(self) -> SavedDelay | None:
        """What `restore` takes; None before the first step."""
        return None if self._now is None else SavedDelay(tuple(self._times), tuple(self._values), self._now)

    def restore(self, saved: SavedDelay | None) -> None:
        """Return to what was saved."""
        self.begin()
        if saved is not None:
            self._times, self._values, self._now = list(saved.times), list(saved.values), saved.now
            self._first = -math.inf

    def arrays(self) -> dict[str, np.ndarray[Any, Any]]:
        """The same as arrays, of which `resume` goes on."""
        saved = self.save()
        if saved is None:
            return {}
        return {"times": np.array(saved.times), "values": np.array(saved.values), "now": np.array(saved.now)}

    def resume(self, arrays: Mapping[str, np.ndarray[Any, Any]]) -> None:
        """Return to what `arrays` gave."""
        saved = SavedDelay(tuple(arrays["times"].tolist()), tuple(arrays["values"]), arrays["now"]) if arrays else None
        self.restore(saved)


class DelayedInputs:
    """All delayed inputs of one FMU."""

    def __init__(self) -> None:
        self._all: list[DelayedInput] = []

    def take(self, more: Iterable[DelayedInput]) -> None:
        """These belong to it too."""
        self._all += more

    def begin(self) -> None:
        """A simulation begins."""
        for one in self._all:
            one.begin()

    def hold(self, time: float) -> None:
        """Inputs have their values from `time` on [s]."""
        for one in self._all:
            one.hold(time)

    def move_to(self, time: float) -> bool:
        """Take the values from `time` on [s]; whether one is another."""
        has_jumped = False
        for one in self._all:
            has_jumped |= one.move_to(time)
        return has_jumped

    def average(self, begin: float, end: float) -> None:
        """Take the mean values between two times [s]."""
        for one in self._all:
            one.average(begin, end)

    def next_jump(self, time: float) -> float:
        """When one jumps next after `time` [s], as far as is known."""
        return min((one.next_jump(time) for one in self._all), default=math.inf)

    def save(self) -> tuple[SavedDelay | None, ...]:
        """What `restore` takes."""
        return tuple(one.save() for one in self._all)

    def restore(self, saved: Sequence[SavedDelay | None]) -> None:
        """Return to what was saved."""
        for one, own in zip(self._all, saved):
            one.restore(own)

    def arrays(self) -> dict[str, np.ndarray[Any, Any]]:
        """What they remember, as arrays."""
        return {f"{i}.{n}": a for i, one in enumerate(self._all) for n, a in one.arrays().items()}

    def resume(self, arrays: Mapping[str, np.ndarray[Any, Any]]) -> None:
        """Return to what `arrays` gave."""
        for i, one in enumerate(self._all):
            one.resume({n.removeprefix(f"{i}."): a for n, a in arrays.items() if n.startswith(f"{i}.")})
