"""The scenario of a recording: the scenario given, with what was done in place of what it says."""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from cosim.components import nanoseconds
from cosim.scenario import Scenario, scenario_of_data
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array
from cosim.unit.quantity import PhysicalValue
from cosim.yaml_file import parse_yaml, read_text
from diagnosis.recording.recording import Input, Recording
from diagnosis.recording.units import WrongUnit, conversion_of_difference

#: A key to the one that it stands in place of: a programme's output has either. With its unit it stands by itself.
_INSTEAD = {"constant": "points", "points": "constant"}
#: An output step that is longer than a channel's readings are apart by less than this factor stays as it is.
SLACK = 1.1


def scenario_of(base: Scenario, recording: Recording) -> Scenario:
    """The scenario under the conditions of a recording.

    Keys in `overrides` replace those of the scenario, mapping by mapping; an output of a programme that is given with
    its unit replaces the whole of it, interpolation too. Recorded inputs become the points of their
    programme, moved to the grid of macro-steps; the run ends with the last sample unless `overrides` says otherwise.
    Outputs are recorded at least as often as the channels were read, as far as macro-steps allow: between outputs
    readings are compared with straight lines.

    Raises:
        InputError: The result is no valid scenario; the keys are those of the scenario.
    """
    assert base.path is not None, "the scenario was read from a file"
    data = _data_of(base)
    merged = copy.deepcopy(_merged(data, recording.overrides))
    macro = nanoseconds(base.time.macro_step) * 1e-9
    for recorded in recording.inputs:
        _put_points(merged, recorded, macro, recording)
    if "stop" not in recording.overrides.get("time", {}):
        output = nanoseconds(base.time.output_step) * 1e-9
        begin = base.time.start.to("s")
        steps = max(1, math.ceil((recording.end - begin) / output - 1e-9))
        merged["time"]["stop"] = f"{begin + steps * output:.12g} s"
    try:
        return _with_outputs_as_read(scenario_of_data(merged, base.path), recording)
    except InputError as error:
        problem = f"{error.problem} (with the overrides of {recording.path})"
        remedy = error.remedy
        if error.key == "time" and set(recording.overrides.get("time", {})) == {"stop"}:
            remedy = "leave time.stop out of the recording's overrides: the run then ends with its last reading"
        raise InputError(error.source, error.key, problem, remedy) from error


def _with_outputs_as_read(scenario: Scenario, recording: Recording) -> Scenario:
    """The scenario with the longest output step that is no longer than the readings of any channel are apart."""
    intervals = [float(np.median(np.diff(c.times))) for c in recording.channels.values() if len(c.times) > 1]
    if not intervals:
        return scenario
    macro, output = nanoseconds(scenario.time.macro_step), nanoseconds(scenario.time.output_step)
    longest = SLACK * 1e9 * min(intervals)
    if output <= longest:
        return scenario
    # a divisor of what it was: checkpoints and the end stay whole numbers of it
    counts = [n for n in range(1, output // macro + 1) if (output // macro) % n == 0]
    finer = macro * max((n for n in counts if macro * n <= longest), default=1)
    time = scenario.time.model_copy(update={"output_step": PhysicalValue(finer * 1e-9, "s")})
    return scenario.model_copy(update={"time": time})


def _data_of(base: Scenario) -> Any:
    """The scenario as YAML data: as its file has it, or as it is where a program changed it since it was read."""
    assert base.path is not None
    data = parse_yaml(read_text(base.path), base.path)
    if scenario_of_data(copy.deepcopy(data), base.path) == base:
        return data
    return parse_yaml(base.to_yaml(), base.path)


def _merged(base: Any, change: Any) -> Any:
    if isinstance(base, Mapping) and isinstance(change, Mapping):
        if change.get("kind", base.get("kind")) != base.get("kind"):
            return change  # another kind has other keys
        if "unit" in change and any(key in change for key in _INSTEAD):
            return change  # a programme's output as a whole, as `cosim record` writes it
        both = {k: v for k, v in base.items() if not any(_INSTEAD.get(other) == k for other in change)}
        for key, value in change.items():
            both[key] = _merged(base[key], value) if key in base else value
        return both
    return change


def on_grid(given: Input, macro: float) -> tuple[AnyArray, Array]:
    """Macro-steps and values of an input's points; of several readings in one macro-step the latest one holds.

    Args:
        given: The input.
        macro: Macro-step [s].
    """
    steps = np.round(given.times / macro).astype(np.int64)
    last = np.append(steps[1:] != steps[:-1], True)
    return steps[last], given.values[last]


def _put_points(data: dict[str, Any], recorded: Input, macro: float, recording: Recording) -> None:
    key = f"inputs.{recorded.component}.{recorded.output}"
    component = data.get("components", {}).get(recorded.component)
    if not isinstance(component, dict) or component.get("kind") != "programme":
        raise InputError(
            recording.path / "recording.yaml",
            key,
            f"the scenario has no programme {recorded.component}",
            "name an output of a programme of the scenario",
        )
    output = component.get("outputs", {}).get(recorded.output)
    if output is None:
        raise InputError(
            recording.path / "recording.yaml",
            key,
            f"the programme has no output {recorded.output}",
            f"it has: {', '.join(component.get('outputs', {}))}",
        )
    try:
        conversion_of_difference(recorded.unit, str(output.get("unit", "1")))
    except WrongUnit as error:
        raise InputError(
            recording.path / "recording.yaml",
            f"{key}.unit",
            f"the programme gives {recorded.output} in {output.get('unit', '1')}: {error}",
            error.remedy,
        ) from error
    steps, values = on_grid(recorded, macro)
    if output.get("interpolation") != "linear":  # a value that stays needs no point
        changes = np.append(True, values[1:] != values[:-1])
        steps, values = steps[changes], values[changes]
    output.pop("constant", None)
    output["points"] = [
        [f"{step * macro:.12g} s", f"{value!r} {recorded.unit}"] for step, value in zip(steps.tolist(), values.tolist())
    ]
