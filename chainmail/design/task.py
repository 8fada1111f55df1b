"""Design tasks: YAML to what may vary, what is wanted, and what is to be least."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StrictInt, StrictStr, model_validator

from cosim.components import AnyQuantity, Count, Strict
from cosim.scenario import Scenario, find_scenario, scenario_of_data
from cosim.sweep.file import Output
from cosim.unit.errors import InputError
from cosim.unit.quantity import In, PhysicalValue
from cosim.yaml_file import parse_yaml, read_model, read_text

_REMEDY = "docs/design.md explains every key"
_SPAN = re.compile(r"^\s*(?P<low>.+?)\s+to\s+(?P<high>.+?)\s*$")


def _ends(value: object) -> object:
    match = _SPAN.match(value) if isinstance(value, str) else None
    if match is None:
        raise ValueError(f"{value!r} is no range; write `0 V to 12 V`")
    return {"low": match["low"], "high": match["high"]}


class _Voltages(Strict):
    low: Annotated[PhysicalValue, In("V", minimum=0.0)]
    high: Annotated[PhysicalValue, In("V", minimum=0.0, is_exclusive=True)]

    @model_validator(mode="after")
    def _check(self) -> _Voltages:
        if self.low.to("V") >= self.high.to("V"):
            raise ValueError(f"the range from {self.low} to {self.high} is empty")
        return self


class _Temperatures(Strict):
    low: Annotated[PhysicalValue, In("K", minimum=0.0, is_exclusive=True)]
    high: Annotated[PhysicalValue, In("K", minimum=0.0, is_exclusive=True)]

    @model_validator(mode="after")
    def _check(self) -> _Temperatures:
        if self.low.to("K") >= self.high.to("K"):
            raise ValueError(f"the range from {self.low} to {self.high} is empty")
        return self


_TEMPERATURES = _Temperatures(low=PhysicalValue(62.0, "degC"), high=PhysicalValue(80.0, "degC"))


class Vary(Strict):
    """What a design may choose."""

    rows_heated: Literal["any"] | list[list[Count]] = Field(
        default="any", description="Patterns of heated rows, counted from the tether; any: every pattern of free rows."
    )
    voltage: Annotated[_Voltages, BeforeValidator(_ends)] = Field(description="Of a string while it is heated.")
    temperature: Annotated[_Temperatures, BeforeValidator(_ends)] = Field(
        default=_TEMPERATURES, description="Of a row at the end of heating."
    )


class Wanted(Output):
    """One requirement: a number of every run below or above a bound, in a share of starts."""

    below: AnyQuantity | None = None
    above: AnyQuantity | None = None
    share: float = Field(default=0.9, gt=0.0, lt=1.0, description="Share of starts in which it must hold.")
    confidence: float = Field(default=0.9, gt=0.5, lt=1.0, description="Of the statement that this share is reached.")

    @model_validator(mode="before")
    @classmethod
    def _at(cls, data: Any) -> Any:
        """`at: 15 s` says `over: at` by itself."""
        return {"over": "at", **data} if isinstance(data, dict) and "at" in data else data

    @model_validator(mode="after")
    def _bounded(self) -> Wanted:
        if (self.below is None) == (self.above is None):
            raise ValueError("give either `below` or `above`")
        return self

    def output(self) -> Output:
        """What is read off a run."""
        return Output.model_validate(
            self.model_dump(by_alias=True, exclude={"below", "above", "share", "confidence"}, exclude_none=True)
        )

    def distance(self, value: float, unit: str) -> float:
        """How far a value is on the right side of its bound, in `unit`; negative: on the wrong side."""
        if self.below is not None:
            return self.below.to(unit) - value
        assert self.above is not None
        return value - self.above.to(unit)

    def text(self) -> str:
        """For people."""
        relation = f"below {self.below}" if self.below is not None else f"above {self.above}"
        when = f" at {self.at}" if self.at is not None else f" ({self.over})"
        return f"{self.quantity}{when} {relation}"


class Effort(Strict):
    """Most runs of each fidelity."""

    coarse: Annotated[StrictInt, Field(ge=1)] = 40
    full: Annotated[StrictInt, Field(ge=1)] = 20


class Task(Strict):
    """A design task, as its file describes it."""

    title: str
    description: str = ""
    scenario: StrictStr = Field(description="A fabric with a supply per string, beside the task, or a shipped one.")
    vary: Vary
    wanted: list[Wanted] = Field(min_length=1)
    least: Literal["energy"] = "energy"
    runs: Effort = Effort()
    seed: Annotated[StrictInt, Field(ge=0)] = 0


def load_task(path: Path) -> tuple[Task, Scenario]:
    """Read a task and its scenario.

    Raises:
        InputError: One of them cannot be read, or a key or value is wrong.
    """
    task = read_model(path, Task, "a task is a mapping with the keys title, scenario, vary, wanted", _REMEDY)
    beside = path.parent / task.scenario
    try:
        found = beside if os.path.isfile(beside) else find_scenario(task.scenario)
    except InputError as error:
        raise InputError(path, "scenario", error.problem, error.remedy) from error
    return task, scenario_of_data(parse_yaml(read_text(found), found), found)
