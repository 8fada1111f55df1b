"""Scenario files: YAML to a typed, validated description of one run.

A scenario names components, the connections between their variables, the algorithm and the times. Quantities carry
their units. `json_schema()` is what editors use to complete and check a file.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic
import yaml
from pydantic import Field, StrictBool, StrictFloat, field_validator, model_validator

from cosim.components import (
    Component,
    ControllerComponent,
    Count,
    Duration,
    FabricComponent,
    PendulumComponent,
    ProgrammeComponent,
    SensorComponent,
    Strict,
    Time,
    nanoseconds,
)
from cosim.nearest import did_you_mean
from cosim.overrides import with_changes
from cosim.shipped import SCENARIOS
from cosim.unit.errors import InputError
from cosim.unit.quantity import In, PhysicalValue
from cosim.yaml_file import input_error, parse_yaml, read_text

_REMEDY = "`cosim schema` prints every key; `cosim list` shows examples"
#: `component.output -> component.input`; variables of an FMU may hold dots and brackets themselves.
CONNECTION = r"^\s*(\w+)\.(\S+)\s*->\s*(\w+)\.(\S+)\s*$"


#: Checkpoints of a run whose scenario does not say when: at most so many, because each costs a file that is synced.
MOST_CHECKPOINTS = 100
_SHORTEST_CHECKPOINT_STEP = 2_000_000_000


def default_checkpoint_step(duration: int, output_step: int) -> int:
    """2 s or a hundredth of the run, whichever is longer, in whole output steps [ns].

    >>> default_checkpoint_step(36_000_000_000, 300_000_000)
    2100000000
    >>> default_checkpoint_step(1_000_000_000_000_000, 1_000_000_000)
    10000000000000
    """
    wanted = max(_SHORTEST_CHECKPOINT_STEP, -(-duration // MOST_CHECKPOINTS))
    return -(-wanted // output_step) * output_step


#: Simulated time [ns] that a signed number of 64 bits no longer holds, about 292 years.
LATEST = 2**63


class TimeSettings(Strict):
    """Start, end and steps of a run."""

    start: Time = Field(default=PhysicalValue(0.0, "s"), description="Simulated time at which the run begins.")
    stop: Time = Field(description="Simulated time at which the run ends; met exactly.")
    macro_step: Duration = Field(description="Communication step of the co-simulation.")
    output_step: Duration = Field(description="Interval between recorded values; a multiple of the macro-step.")
    checkpoint_step: Duration = Field(
        default=PhysicalValue(2.0, "s"),
        description="Interval between checkpoints; default: 2 s or a hundredth of the run, whichever is longer, in "
        "whole output steps.",
    )

    @property
    def macro_steps(self) -> int:
        """Macro-steps of a run."""
        return (nanoseconds(self.stop) - nanoseconds(self.start)) // nanoseconds(self.macro_step)

    @field_validator("start", "stop", "macro_step", "output_step", "checkpoint_step")
    @classmethod
    def _counted(cls, value: PhysicalValue) -> PhysicalValue:
        if abs(nanoseconds(value)) >= LATEST:
            raise ValueError(
                f"`{value}` cannot be simulated: time ends at {LATEST / 1e9:.3g} s, it is counted in nanoseconds"
            )
        return value

    @model_validator(mode="after")
    def _check(self) -> TimeSettings:
        start, stop, macro = nanoseconds(self.start), nanoseconds(self.stop), nanoseconds(self.macro_step)
        output, checkpoint = nanoseconds(self.output_step), nanoseconds(self.checkpoint_step)
        if stop <= start:
            raise ValueError(f"stop ({self.stop}) must come after start ({self.start})")
        if "checkpoint_step" not in self.model_fields_set:
            checkpoint = default_checkpoint_step(stop - start, output)
            self.__dict__["checkpoint_step"] = PhysicalValue(checkpoint / 1e9, "s")
        for name, value, divisor, of in (
            ("output_step", output, macro, "macro_step"),
            ("checkpoint_step", checkpoint, output, "output_step"),
            ("stop - start", stop - start, output, "output_step"),
        ):
            if value % divisor:
                raise ValueError(f"{name} ({value / 1e9:g} s) must be a multiple of {of} ({divisor / 1e9:g} s)")
        return self


_Order = Annotated[list[str] | None, Field(description="Order of the components; default: as listed.")]
_OnEvent = Annotated[
    Literal["continue", "synchronise"],
    Field(
        default="continue",
        description="When an FMU returns early. continue: it goes on alone to the end of the macro-step; synchronise: "
        "all units go back and step to that instant (every unit must be able to restore).",
    ),
]
_Tolerance = Annotated[PhysicalValue, In("1", minimum=0.0, is_exclusive=True)]


class GaussSeidel(Strict):
    """Units step one after the other, each with the newest outputs."""

    kind: Literal["gauss_seidel"]
    order: _Order = None
    on_event: _OnEvent = "continue"


class Jacobi(Strict):
    """All units step with the outputs of the last communication point."""

    kind: Literal["jacobi"]
    order: _Order = None
    on_event: _OnEvent = "continue"


class Iterated(Strict):
    """Steps are repeated until the values exchanged inside each loop of units agree."""

    kind: Literal["iterated"]
    order: _Order = None
    relative_tolerance: _Tolerance = PhysicalValue(1e-8, "")
    iterations: Count = Field(default=50, description="Most repetitions of one step.")
    inputs: Literal["mean", "end"] = Field(
        default="mean",
        description="What a loop's inputs are over the step: mean of its begin and end (second order), or its end.",
    )


class StepDoubling(Strict):
    """Each step is made once whole and once in halves; their difference sets the step within the macro-step."""

    kind: Literal["step_doubling"]
    order: _Order = None
    inner: Literal["gauss_seidel", "jacobi"] = "gauss_seidel"
    relative_tolerance: _Tolerance = PhysicalValue(1e-4, "")
    absolute_tolerance: StrictFloat = Field(default=1e-6, gt=0.0, description="In the unit of each variable.")
    minimum_step: Duration = PhysicalValue(1.0, "us")


Algorithm = Annotated[GaussSeidel | Jacobi | Iterated | StepDoubling, Field(discriminator="kind")]


#: A number that is finite, whole or not.
_Scale = Annotated[StrictFloat, Field(allow_inf_nan=False)]


class ScaledConnection(Strict):
    """A connection whose value is scaled: target = factor * source + offset, after conversion of units."""

    connect: Annotated[str, Field(pattern=CONNECTION)]
    factor: _Scale = 1.0
    offset: _Scale = 0.0
    convert_units: StrictBool = Field(default=True, description="Whether the variables' units are converted first.")


def _micro_step(component: FabricComponent | PendulumComponent) -> tuple[str, PhysicalValue]:
    """Key and value of the step in which Bullet advances a component."""
    if isinstance(component, FabricComponent):
        return "solver.micro_step", component.solver.micro_step
    return "micro_step", component.micro_step


class Scenario(Strict):
    """One run, as a scenario file describes it."""

    title: str
    description: str = ""
    time: TimeSettings
    algorithm: Algorithm = GaussSeidel(kind="gauss_seidel")
    components: dict[Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")], Component] = Field(min_length=1)
    connections: list[Annotated[str, Field(pattern=CONNECTION)] | ScaledConnection] = []
    path: Path | None = Field(default=None, exclude=True, description="File that it was read from.")

    @model_validator(mode="after")
    def _check(self) -> Scenario:
        order = self.algorithm.order
        if order is not None and sorted(order) != sorted(self.components):
            raise ValueError(f"algorithm.order must list every component once: {', '.join(self.components)}")
        self._check_grid()
        return self

    def _check_grid(self) -> None:
        """Switching times must fall on the macro-step grid: a switch inside a step would act late, silently."""
        start, macro = nanoseconds(self.time.start), nanoseconds(self.time.macro_step)
        for name, component in self.components.items():
            if isinstance(component, FabricComponent | PendulumComponent):
                key, micro = _micro_step(component)
                if macro % nanoseconds(micro):
                    raise ValueError(
                        f"components.{name}.{key} ({micro}) must divide time.macro_step "
                        f"({self.time.macro_step}) into a whole number of steps"
                    )
            if isinstance(component, SensorComponent | ControllerComponent) and nanoseconds(component.sample) % macro:
                raise ValueError(
                    f"components.{name}.sample ({component.sample}) must be a multiple of time.macro_step "
                    f"({self.time.macro_step})"
                )
            if isinstance(component, ProgrammeComponent):
                for output, given in component.outputs.items():
                    late = [t for t, _ in given.points or [] if (nanoseconds(t) - start) % macro]
                    if late:
                        raise ValueError(
                            f"components.{name}.outputs.{output}: {late[0]} is not a whole number of macro-steps "
                            f"({self.time.macro_step}) after the start; move it, or choose another macro_step"
                        )

    def names(self) -> list[str]:
        """Components in stepping order."""
        return self.algorithm.order or list(self.components)

    def to_yaml(self, is_complete: bool = False) -> str:
        """The scenario as YAML that `load_scenario` reads back to an equal scenario.

        Args:
            is_complete: Write defaults too, so that the text keeps its meaning where a default changes later.
        """
        data = self.model_dump(mode="json", exclude_defaults=not is_complete, exclude_none=True)
        return yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=110)


def parse_scenario(text: str, source: Path) -> Scenario:
    """Scenario from YAML text.

    Args:
        text: YAML.
        source: File named in errors; relative paths inside the scenario start from its folder.

    Raises:
        InputError: It is no YAML, or a key or value is wrong; all faults are listed, each with its key.
    """
    return scenario_of_data(parse_yaml(text, source), source)


def scenario_of_data(data: object, source: Path) -> Scenario:
    """Scenario from the content of YAML, however it was put together; arguments and errors as of `parse_scenario`."""
    if not isinstance(data, dict):
        raise InputError(
            source,
            "",
            "a scenario is a mapping with the keys title, time, components, connections",
            "copy one from `cosim list`",
        )
    if "path" in data:
        raise InputError(source, "path", "there is no such key here", "remove it: the path is that of the file itself")
    try:
        return Scenario.model_validate({**data, "path": source})
    except pydantic.ValidationError as error:
        raise input_error(source, error, _REMEDY, Scenario) from error


def load_scenario(path: str | Path, changes: Sequence[str] = ()) -> Scenario:
    """Read a scenario file, or a shipped scenario by its name.

    Args:
        path: File or name.
        changes: `key=value` of `--set`, put in place of what the file says before it is checked.

    Raises:
        InputError: There is no such file, it is wrong, or a change does not fit.
    """
    found = find_scenario(path)
    if not changes:
        return parse_scenario(read_text(found), found)
    keys = [name for name, field in Scenario.model_fields.items() if not field.exclude]
    data = with_changes(parse_yaml(read_text(found), found), changes, keys)
    try:
        return scenario_of_data(data, found)
    except InputError as error:
        given = " ".join(f"--set {change}" for change in changes)
        raise InputError(error.source, error.key, f"{error.problem} (with {given})", error.remedy) from error


def scenario_folder() -> Path:
    """Folder of the shipped scenarios."""
    return SCENARIOS


def shipped_scenarios() -> dict[str, Path]:
    """Name to file of every shipped scenario."""
    return {path.stem: path for path in sorted(scenario_folder().glob("*.yaml"))}


def find_scenario(path: str | Path) -> Path:
    """A file as given, or a shipped scenario by name."""
    direct = Path(path)
    if os.path.isfile(direct):  # of a name too long it is False
        return direct
    shipped = shipped_scenarios()
    if str(path) in shipped:
        return shipped[str(path)]
    if os.path.isdir(direct) and str(path):
        raise InputError(path, "", "this is a folder", "give the scenario file in it, or the name of a shipped one")
    problem = f"there is no such scenario{did_you_mean(str(path), shipped)}"
    raise InputError(path, "", problem, f"give a file, or one of: {', '.join(shipped)}")


def json_schema() -> dict[str, Any]:
    """JSON Schema of scenario files."""
    schema = Scenario.model_json_schema(mode="validation")
    schema["properties"].pop("path", None)
    schema["properties"]["components"]["additionalProperties"] = False  # names that break the pattern
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
