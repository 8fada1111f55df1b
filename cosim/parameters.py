"""Parameter sets: files that give every number its unit and its source."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import pydantic
from pydantic import BaseModel, ConfigDict, Field, StrictBool, model_validator

from cosim.components import ParameterValue
from cosim.nearest import did_you_mean
from cosim.scenario import scenario_folder
from cosim.unit.errors import InputError
from cosim.unit.quantity import In, PhysicalValue, parse_unit
from cosim.yaml_file import input_error, parse_yaml, read_text


class Parameter(BaseModel):
    """One number (or switch) of a parameter set."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)
    value: StrictBool | Annotated[PhysicalValue, In()]
    unit: str = ""
    source: str = Field(min_length=3, description="Where the value comes from: a publication, or an assumption and why")
    uncertainty: Annotated[float, Field(ge=0.0, allow_inf_nan=False)] | None = Field(
        default=None,
        description="Standard deviation of ln(value), common to all elements; `cosim diagnose` stays within.",
    )
    scatter: Annotated[float, Field(ge=0.0, allow_inf_nan=False)] | None = Field(
        default=None, description="The same from element to element."
    )

    @model_validator(mode="after")
    def _check(self) -> Parameter:
        if isinstance(self.value, PhysicalValue) and self.value.unit:
            raise ValueError(f"give the unit of `{self.value}` under `unit`, and the number alone under `value`")
        parse_unit(self.unit)
        return self

    def quantity(self) -> bool | PhysicalValue:
        """The value with its unit."""
        return self.value if isinstance(self.value, bool) else PhysicalValue(self.value.number, self.unit)


class ParameterSet(BaseModel):
    """A file of parameters."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)
    title: str
    parameters: dict[str, Parameter]


@dataclass(frozen=True)
class Resolved:
    """Parameters of one component after set and overrides.

    Args:
        values: Name to value.
        sources: Name to source; overrides say that they come from the scenario.
        uncertainty: Name to standard deviation of ln(value), where the set states one.
        scatter: The same from element to element.
    """

    values: Mapping[str, ParameterValue]
    sources: Mapping[str, str]
    uncertainty: Mapping[str, float] = field(default_factory=dict)
    scatter: Mapping[str, float] = field(default_factory=dict)


def find_parameter_set(name: str, scenario_file: Path) -> Path:
    """A shipped set by name, or a file relative to the scenario's folder.

    Raises:
        InputError: Neither exists.
    """
    folder = scenario_folder() / "parameter_sets"
    for candidate in (scenario_file.parent / name, folder / f"{name}.yaml"):
        if os.path.isfile(candidate):  # of a name too long it is False
            return candidate
    shipped = sorted(p.stem for p in folder.glob("*.yaml"))
    raise InputError(
        scenario_file,
        "parameter_set",
        f"there is no parameter set `{name}`{did_you_mean(name, shipped)}",
        f"give a file beside the scenario, or one of: {', '.join(shipped)}",
    )


def load_parameter_set(path: Path) -> ParameterSet:
    """Read a parameter set.

    Raises:
        InputError: It is no YAML or a key or value is wrong.
    """
    try:
        return ParameterSet.model_validate(parse_yaml(read_text(path), path))
    except pydantic.ValidationError as error:
        raise input_error(path, error, "each parameter needs value, unit and source", ParameterSet) from error


def resolve(set_name: str | None, overrides: Mapping[str, Any], scenario_file: Path) -> Resolved:
    """Parameters of a component: those of its set, replaced by those the scenario gives itself."""
    values: dict[str, ParameterValue] = {}
    sources: dict[str, str] = {}
    uncertainty: dict[str, float] = {}
    scatter: dict[str, float] = {}
    if set_name is not None:
        for name, parameter in load_parameter_set(find_parameter_set(set_name, scenario_file)).parameters.items():
            values[name] = parameter.quantity()
            sources[name] = parameter.source
            if parameter.uncertainty is not None:
                uncertainty[name] = parameter.uncertainty
            if parameter.scatter is not None:
                scatter[name] = parameter.scatter
    for name, value in overrides.items():
        values[name] = value
        sources[name] = f"scenario {scenario_file.name}"
    return Resolved(values, sources, uncertainty, scatter)
