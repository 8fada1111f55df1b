"""Simulations of a fabric for points of the search: by Bullet alone where the coil network gives what acts on it."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from cosim.assemble import assemble
from cosim.components import MUJOCO_STEP, CircuitComponent, FabricComponent, Solver, nanoseconds
from cosim.compute.batch import Batches
from cosim.compute.result import Task
from cosim.run_folder import resolved_scenario
from cosim.scenario import Scenario
from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.fabric.bullet_run import Courses, FabricSetting, simulate_fabric
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording
from diagnosis.search.cosim_run import Changes, Setting, setting, simulate
from diagnosis.search.problem import Point
from mechanics.fabric import Layout, layout
from mechanics.unit import FabricUnit

#: Kinds of channels that a fabric gives; all others belong to circuit and coils.
_KINDS = frozenset({"link", "marker", "fabric"})
_COIL_QUANTITIES = frozenset({"extension", "tension"})


def fabric_of(scenario: Scenario) -> str | None:
    """Name of the fabric of a scenario; None where it has none, or several."""
    names = [n for n, c in scenario.components.items() if isinstance(c, FabricComponent)]
    return names[0] if len(names) == 1 else None


def fabric_layout(scenario: Scenario, component: str) -> Layout:
    """Links of a fabric, and which of them are held.

    Args:
        scenario: The scenario.
        component: Name of the fabric.

    Raises:
        InputError: The scenario cannot be assembled.
    """
    assembly = assemble(scenario)
    assembly.system.terminate()
    unit = assembly.system.units[component]
    assert isinstance(unit, FabricUnit)
    return layout(unit.design)


def in_other_engine(scenario: Scenario, component: str) -> Scenario:
    """The scenario with its fabric in the other engine, at that engine's own settings.

    Args:
        scenario: The scenario.
        component: Name of the fabric.

    Raises:
        InputError: The other engine is not installed, or cannot simulate such a fabric.
    """
    given = scenario.components[component]
    assert isinstance(given, FabricComponent)
    kept = {"iterations": given.solver.iterations, "penetration_limit": given.solver.penetration_limit}
    if given.engine == "mujoco":
        other, settings = "bullet", {**kept, "friction_anchors": True}
    else:
        other, settings = "mujoco", {**kept, "micro_step": MUJOCO_STEP}
    solver = Solver().model_copy(update=settings)
    fabric = given.model_copy(update={"engine": other, "solver": solver})
    found = scenario.model_copy(update={"components": {**scenario.components, component: fabric}})
    assemble(found).system.terminate()
    return found


def divided(recording: Recording, component: str) -> tuple[Recording, Recording]:
    """A recording of a fabric as two: channels of circuit and coils, and those of the fabric."""
    mechanical = {
        name: c
        for name, c in recording.channels.items()
        if c.target.kind in _KINDS
        or c.target.kind == component
        or (c.target.kind == "coil" and c.target.quantity in _COIL_QUANTITIES)
    }
    other = {name: c for name, c in recording.channels.items() if name not in mechanical}
    return replace(recording, channels=other), replace(recording, channels=mechanical)


def beginning(recording: Recording, share: float) -> Recording | None:
    """The first part of a recording of a fabric; None where that has no reading.

    Args:
        recording: With readings of the fabric.
        share: Of the time from the first reading to the last one.
    """
    first = min(float(c.times[0]) for c in recording.channels.values())
    end = first + share * (recording.end - first)
    channels = {}
    for name, channel in recording.channels.items():
        count = int(np.searchsorted(channel.times, end, side="right"))
        if count:
            own = {part: getattr(channel, part)[:count] for part in ("times", "values", "is_clipped")}
            channels[name] = replace(channel, **own)
    if not channels:
        return None
    return replace(recording, channels=channels, end=max(float(c.times[-1]) for c in channels.values()))


class FabricRuns(Protocol):
    """Makes simulations of the fabric."""

    def make(self, wanted: Sequence[tuple[int, Mapping[str, PhysicalValue], Point]]) -> list[list[Array] | None]:
        """Values of the mechanical channels at their samples; None where a run stopped.

        Args:
            wanted: Number of a recording, parameters of the fabric that differ, and a point of the coil network.
        """
        ...

    @property
    def effort(self) -> float:
        """Of one simulation of every recording: links times micro-steps, and more for many iterations."""
        ...

    @property
    def reasons(self) -> list[str]:
        """Why runs of the last batch stopped, each once."""
        ...


class ClosedRuns:
    """The closed co-simulation, for actuators that no network simulates; points of a network do not count.

    Args:
        scenario: What the recordings are compared with.
        component: Name of the fabric.
        recordings: With mechanical channels alone.
        batches: Makes the runs.
    """

    def __init__(self, scenario: Scenario, component: str, recordings: Sequence[Recording], batches: Batches) -> None:
        self._component, self._batches = component, batches
        self._settings: list[Setting] = [setting(scenario_of(scenario, r), r) for r in recordings]
        self.effort = _effort([s.scenario for s in self._settings], component)
        self.reasons: list[str] = []

    def make(self, wanted: Sequence[tuple[int, Mapping[str, PhysicalValue], Point]]) -> list[list[Array] | None]:
        """See `FabricRuns`."""
        tasks = []
        for number, parameters, _ in wanted:
            changes = Changes({self._component: parameters})
            tasks.append(Task(self._settings[number].task_key(changes), (number, changes)))
        results = self._batches.results(simulate, self._settings, tasks)
        self.reasons = list(dict.fromkeys(r.failure for r in results if r.failure))
        return [list(r.arrays) if r.is_complete else None for r in results]


class BulletRuns:
    """Bullet alone, driven by the stiffness that the coil network gives at a point.

    The co-simulation gives the same: an actuator that ignores the fabric's motion is not changed by it.

    Args:
        scenario: What the recordings are compared with.
        component: Name of the fabric.
        recordings: With mechanical channels alone.
        network: Model of the other channels of the same recordings.
        batches: Makes the runs.
    """

    def __init__(
        self,
        scenario: Scenario,
        component: str,
        recordings: Sequence[Recording],
        network: CoilNetworkModel,
        batches: Batches,
    ) -> None:
        self._component, self._network, self._batches = component, network, batches
        self._recordings = list(recordings)
        self._scenarios = [_resolved(scenario_of(scenario, r)) for r in recordings]
        self.effort = _effort(self._scenarios, component)
        circuits = [c for c in scenario.components.values() if isinstance(c, CircuitComponent)]
        self._strings = tuple(circuits[0].strings) if circuits else ()
        self.reasons: list[str] = []

    def make(self, wanted: Sequence[tuple[int, Mapping[str, PhysicalValue], Point]]) -> list[list[Array] | None]:
        """See `FabricRuns`."""
        settings: list[FabricSetting] = []
        keys: list[str] = []
        known: dict[tuple[int, int], int] = {}
        tasks = []
        for number, parameters, point in wanted:
            place = known.get((number, id(point)))
            if place is None:
                place = known[number, id(point)] = len(settings)
                settings.append(self._setting(number, point))
                keys.append(settings[-1].key())
            changes = Changes({self._component: parameters})
            tasks.append(Task(_joined(keys[place], changes), (place, changes)))
        results = self._batches.results(simulate_fabric, settings, tasks)
        self.reasons = list(dict.fromkeys(r.failure for r in results if r.failure))
        return [list(r.arrays) if r.is_complete else None for r in results]

    def _setting(self, number: int, point: Point) -> FabricSetting:
        channels = list(self._recordings[number].channels.values())
        return FabricSetting(
            self._scenarios[number],
            self._component,
            self.courses(number, point),
            self._strings,
            tuple(c.target for c in channels),
            tuple(c.times for c in channels),
            self._recordings[number].path / "recording.yaml",
        )

    def courses(self, number: int, point: Point) -> Courses:
        """What the network's coils do to the fabric at a point."""
        time = self._scenarios[number].time
        start, stop, macro = (nanoseconds(t) for t in (time.start, time.stop, time.macro_step))
        grid = np.arange(start, stop + macro, macro, dtype=np.float64) * 1e-9
        parameters = self._network.network_parameters(point, number)
        inputs = self._network.runs[number].translation.drive.on_grid(grid)
        # An actuator steps before the fabric: the fabric moves under what the coils have at the end of the step.
        wanted = {"stiffness": grid[1:], "extension": grid[1:]}
        found = self._network.network.simulate(parameters, inputs, wanted)
        # Without a load a coil's extension is what its own length changes by (thermal contraction).
        rest = np.asarray(self._network.runs[number].translation.parameters.base["rest_length"]) + found["extension"]
        return Courses(found["stiffness"], rest)


def _effort(scenarios: Sequence[Scenario], component: str) -> float:
    """What links and contacts cost beside the iterations is worth about 50 of them (benchmarks/results/units.md)."""
    found = 0.0
    for scenario in scenarios:
        fabric = scenario.components[component]
        assert isinstance(fabric, FabricComponent)
        length = nanoseconds(scenario.time.stop) - nanoseconds(scenario.time.start)
        links = fabric.rows * (2 * fabric.columns - 1)
        # MuJoCo's micro-step ends where it has converged, and takes about a tenth of 200 iterations of Bullet.
        share = 0.1 if fabric.engine == "mujoco" else (fabric.solver.iterations + 50) / 250
        found += links * (length / nanoseconds(fabric.solver.micro_step)) * share
    return found


def _joined(key: str, changes: Changes) -> str:
    return hashlib.sha256(f"{key} {changes.text()}".encode()).hexdigest()


def _resolved(scenario: Scenario) -> Scenario:
    assembly = assemble(scenario)
    assembly.system.terminate()
    return resolved_scenario(scenario, assembly.parameters)
