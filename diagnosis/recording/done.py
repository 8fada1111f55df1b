"""What was done in a run, as keys of a scenario: a recording that holds them stands by itself."""

from __future__ import annotations

from typing import Any

from cosim.assemble import assemble
from cosim.components import ParameterValue, ProgrammeComponent
from cosim.fmu.unit import FmuUnit
from cosim.scenario import Scenario
from cosim.unit.protocol import Unit
from mechanics.pendulum import PendulumUnit

#: Begin of the names of parameters that say how a component starts.
_START = "initial_"


def conditions(scenario: Scenario) -> dict[str, Any]:
    """Overrides that bring back the conditions of a run, whatever the scenario says later.

    They are the begin of the run, every output of every programme (supply, power, room) with its unit, interpolation
    and course, and every parameter of a component that says how it starts (`initial_temperature`, `initial_angle`; of
    an FMU also those that the scenario does not give). Circuit, parameter sets and all else belong to the model.

    Args:
        scenario: As it was run.

    Returns:
        `time` and `components` as in a scenario file.

    Raises:
        InputError: The scenario is wrong.
    """
    components: dict[str, Any] = {}
    for name, component in scenario.components.items():
        if isinstance(component, ProgrammeComponent):
            outputs = {n: o.model_dump(mode="json", exclude_none=True) for n, o in component.outputs.items()}
            components[name] = {"outputs": outputs}
    assembly = assemble(scenario)
    try:
        for name, unit in assembly.system.units.items():
            given = assembly.parameters[name].values
            own = _own_starts(unit) | {n: _written(v) for n, v in given.items() if n.startswith(_START)}
            if own:
                components[name] = {"parameters": own}
    finally:
        assembly.system.terminate()
    return {"time": {"start": str(scenario.time.start)}, "components": components}


def _written(value: ParameterValue) -> Any:
    """A parameter as a scenario file has it."""
    if isinstance(value, list):
        return [_written(v) for v in value]
    return value if isinstance(value, bool) else str(value)


def _own_starts(unit: Unit) -> dict[str, Any]:
    """How a unit starts where the scenario does not say it: an FMU by its description, a pendulum by its design."""
    if isinstance(unit, PendulumUnit):
        design = unit.design
        return {
            "initial_angle": f"{design.initial_angle!r} rad",
            "initial_angular_velocity": f"{design.initial_angular_velocity!r} rad/s",
        }
    if not isinstance(unit, FmuUnit):
        return {}
    found: dict[str, Any] = {}
    for variable in unit.archive.description.modelVariables:
        if variable.causality != "parameter" or not variable.name.startswith(_START) or variable.start is None:
            continue
        numbers = [f"{part} {variable.unit or ''}".strip() for part in str(variable.start).split()]
        if variable.type in ("Real", "Float64", "Float32") and "[" not in variable.name:
            found[variable.name] = numbers[0] if len(numbers) == 1 else numbers
    return found
