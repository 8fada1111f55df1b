"""Small units with exact solutions, to test systems and algorithms without an FMU, ngspice or Bullet."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from cosim.unit.protocol import ArrayStore, Causality, StepOutcome, StepStatus, Unit, UnitError, Variable


class Relaxation(Unit):
    """dx/dt = rate * (input - x), solved exactly for an input that is constant over the step."""

    can_restore = True

    def __init__(self, name: str, rate: float, start: float, feedback_start: float | None = None, shape=()) -> None:
        self.name, self.rate, self.first = name, rate, start
        dims = ("cell",) if shape else ()
        self.variables = {
            "input": Variable("input", Causality.INPUT, shape, "K", dims, start=feedback_start),
            "state": Variable("state", Causality.OUTPUT, shape, "K", dims),
        }
        self.coordinates: Mapping = {}
        self._store = ArrayStore(name, self.variables)
        self.set, self.get = self._store.set, self._store.get
        self.steps: list[tuple[int, int, float]] = []
        self.is_terminated = False

    def initialise(self, time: int) -> None:
        self._store.arrays["state"][...] = self.first

    def do_step(self, time: int, size: int) -> StepOutcome:
        given, state = self.get("input"), self._store.arrays["state"]
        self.steps.append((time, size, float(np.ravel(given)[0])))
        state[...] = given + (state - given) * np.exp(-self.rate * size * 1e-9)
        return StepOutcome(StepStatus.OK, time + size)

    def checkpoint(self) -> dict:
        return {n: self.get(n).copy() for n in self.variables}

    def resume(self, state: Mapping, time: int) -> None:
        for n in self.variables:
            self._store.arrays[n][...] = state[n]

    def terminate(self) -> None:
        self.is_terminated = True


class Failing(Relaxation):
    """Does `act` in place of its step from `moment` [ns] on."""

    def __init__(self, name: str, moment: int, act: Callable[[int, int], StepOutcome]) -> None:
        super().__init__(name, 1.0, 1.0, feedback_start=0.0)
        self.moment, self.act = moment, act

    def do_step(self, time: int, size: int) -> StepOutcome:
        if time >= self.moment:
            return self.act(time, size)
        return super().do_step(time, size)


def fail(time: int, size: int) -> StepOutcome:
    """A unit that cannot go on."""
    raise UnitError("scripted", "it cannot go on", time, "script it otherwise")


class Map(Unit):
    """output = function(input) at the same instant: nothing but direct feedthrough."""

    can_restore = True

    def __init__(self, name: str, function: Callable, start=0.0, shape=()) -> None:
        self.name, self.function = name, function
        dims = ("cell",) if shape else ()
        self.variables = {
            "input": Variable("input", Causality.INPUT, shape, "1", dims, start=start),
            "output": Variable("output", Causality.OUTPUT, shape, "1", dims),
        }
        self.coordinates: Mapping = {}
        self.feedthrough = self.initial_feedthrough = {"output": frozenset({"input"})}
        self._store = ArrayStore(name, self.variables)
        self.set, self.get = self._store.set, self._store.get
        self.refreshed = 0

    def initialise(self, time: int) -> None:
        self.refresh()

    def refresh(self) -> None:
        self.refreshed += 1
        self._store.arrays["output"][...] = self.function(self.get("input"))

    def do_step(self, time: int, size: int) -> StepOutcome:
        self.refresh()
        return StepOutcome(StepStatus.OK, time + size)

    def checkpoint(self) -> dict:
        return {n: self.get(n).copy() for n in self.variables}

    def resume(self, state: Mapping, time: int) -> None:
        for n in self.variables:
            self._store.arrays[n][...] = state[n]

    def terminate(self) -> None:
        pass


class Ramp(Unit):
    """state' = slope, which becomes `after` at the instant `event` [ns]: a step that crosses it returns early there."""

    can_restore = True

    def __init__(self, name: str, slope: float, after: float, event: int) -> None:
        self.name, self.slope, self.after, self.event = name, slope, after, event
        self.variables = {"state": Variable("state", Causality.OUTPUT, (), "K")}
        self.coordinates: Mapping = {}
        self._store = ArrayStore(name, self.variables)
        self.set, self.get = self._store.set, self._store.get

    def initialise(self, time: int) -> None:
        self._store.arrays["state"][...] = 0.0

    def do_step(self, time: int, size: int) -> StepOutcome:
        end = min(time + size, self.event) if time < self.event else time + size
        self._store.arrays["state"][...] += (self.slope if time < self.event else self.after) * (end - time) * 1e-9
        if end < time + size:
            return StepOutcome(StepStatus.EARLY_RETURN, end, f"{self.name} returned early")
        return StepOutcome(StepStatus.OK, end)

    def checkpoint(self) -> dict:
        return {"state": self.get("state").copy()}

    def resume(self, state: Mapping, time: int) -> None:
        self._store.arrays["state"][...] = state["state"]

    def terminate(self) -> None:
        pass
