"""The next experiment as a scenario that `cosim run` and `cosim record` take."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import yaml

from cosim.components import HangingMassComponent, ProgrammeComponent, nanoseconds
from cosim.run_folder import write_atomically, writing
from cosim.scenario import Scenario, parse_scenario
from cosim.yaml_file import parse_yaml, read_text
from diagnosis.judge.next_experiment import Course, NextExperiment


def write_experiment(scenario: Scenario, experiment: NextExperiment, folder: Path) -> NextExperiment:
    """Write scenario.yaml.

    Args:
        scenario: The model as it is; must have been read from a file.
        experiment: What was designed for it.
        folder: Where to write.

    Returns:
        The experiment with the path of its scenario.

    Raises:
        InputError: The folder cannot be written.
    """
    path = folder / "scenario.yaml"
    text = yaml.safe_dump(as_scenario(scenario, experiment, folder), sort_keys=False, allow_unicode=True, width=110)
    parse_scenario(text, path)  # what is written must be what `cosim run` takes
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
        write_atomically(path, text.encode())
    return replace(experiment, scenario=str(path))


def as_scenario(scenario: Scenario, experiment: NextExperiment, folder: Path) -> dict[str, Any]:
    """The scenario's own keys with title, times, programmes and load replaced; paths are as seen from `folder`."""
    assert scenario.path is not None, "the scenario was read from a file"
    data: dict[str, Any] = parse_yaml(read_text(scenario.path), scenario.path)
    data["title"] = f"{scenario.title}: next experiment"
    data["description"] = experiment.statement
    step = nanoseconds(scenario.time.output_step) * 1e-9
    stop = scenario.time.start.to("s") + step * max(1, int(experiment.duration / step + 1e-9))
    data["time"]["stop"] = f"{stop:.12g} s"
    components = data["components"]
    for course in experiment.courses:
        programme = scenario.components[course.component]
        assert isinstance(programme, ProgrammeComponent)
        output = components[course.component]["outputs"][course.output]
        output.pop("constant", None)
        output["interpolation"] = "linear" if course.is_linear else "hold"
        output["points"] = _points(course, programme.outputs[course.output].dim is not None)
    for name, component in scenario.components.items():
        if experiment.mass and isinstance(component, HangingMassComponent):
            components[name]["mass"] = f"{experiment.mass:.12g} kg"
        _move(components[name], scenario.path.parent, folder)
    return data


def _points(course: Course, is_list: bool) -> list[list[Any]]:
    found: list[list[Any]] = []
    for time, row in zip(course.times, course.values):
        values = [f"{v:.12g} {course.unit}" for v in row]
        found.append([f"{time:.12g} s", values if is_list else values[0]])
    return found


def _move(component: dict[str, Any], old: Path, new: Path) -> None:
    """Paths of files beside the old scenario, as seen from the new one."""
    for key in ("fmu", "parameter_set"):
        given = component.get(key)
        if isinstance(given, str) and (old / given).is_file():
            component[key] = os.path.relpath((old / given).resolve(), new.resolve())
