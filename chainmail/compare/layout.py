"""Where the quantities of a comparison are found in a run, and when it is driven."""

from __future__ import annotations

import itertools
import re
from dataclasses import dataclass

from cosim.components import ActuatorComponent, ProgrammeComponent, ProgrammeOutput
from cosim.scenario import CONNECTION, Scenario
from cosim.unit.quantity import PhysicalValue

_CONNECTION = re.compile(CONNECTION)


@dataclass(frozen=True)
class Layout:
    """Names of components, and switching times.

    Args:
        actuator: The actuator.
        electrical: What powers it, or None.
        mechanical: What it moves, or None.
        on: Time [s] at which the drive rises first; None where it is constant.
        off: Time [s] at which it falls after that, or None.
    """

    actuator: str
    electrical: str | None
    mechanical: str | None
    on: float | None
    off: float | None


def layout_of(scenario: Scenario, component: str) -> Layout:
    """Layout of a scenario for one of its actuators."""
    actuator = scenario.components[component]
    assert isinstance(actuator, ActuatorComponent)
    on, off = _switches(scenario, actuator.electrical)
    return Layout(component, actuator.electrical, actuator.mechanical, on, off)


def _switches(scenario: Scenario, electrical: str | None) -> tuple[float | None, float | None]:
    for output in _drives(scenario, electrical):
        levels = [(t.to("s"), _level(output, v)) for t, v in output.points or []]
        rises = [b for (_, a), (b, level) in itertools.pairwise(levels) if level > a]
        if levels and levels[0][1] > 0.0:
            rises.insert(0, levels[0][0])
        if not rises or output.interpolation != "hold":
            continue
        falls = [b for (_, a), (b, level) in itertools.pairwise(levels) if level < a and b > rises[0]]
        return rises[0], falls[0] if falls else None
    return None, None


def _drives(scenario: Scenario, electrical: str | None) -> list[ProgrammeOutput]:
    """Outputs of programmes that feed the electrical neighbour, or are it."""
    found = []
    texts = [c if isinstance(c, str) else c.connect for c in scenario.connections]
    ends = [(m[1], m[2]) for text in texts if (m := _CONNECTION.match(text)) and m[3] == electrical]
    for name, output in ends:
        source = scenario.components.get(name)
        if isinstance(source, ProgrammeComponent) and output in source.outputs:
            found.append(source.outputs[output])
    own = scenario.components.get(electrical or "")
    if isinstance(own, ProgrammeComponent):
        found += [own.outputs[n] for n in ("power", "voltage") if n in own.outputs]
    return found


def _level(output: ProgrammeOutput, value: PhysicalValue | list[PhysicalValue] | None) -> float:
    """Largest magnitude of a point."""
    elements = value if isinstance(value, list) else [value]
    return max(abs(e.to(output.unit)) for e in elements if e is not None)
