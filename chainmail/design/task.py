"""Design tasks: YAML to what may vary, what is wanted, and what is to be least."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StrictInt, StrictStr, model_validator

from cosim.components import AnyQuantity, Count, Strict, Time
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
        element = f"[{self.of}]" if isinstance(self.of, int) else ""
        return f"{self.quantity}{element}{when} {relation}"


_ANGLE = In("rad", minimum=0.0, is_exclusive=True)


class _Bends(Strict):
    """What counts as rigid and as flexible."""

    straight: Annotated[PhysicalValue, _ANGLE] = Field(
        default=PhysicalValue(8.0, "deg"), description="A rigid row bends by less."
    )
    bent: Annotated[PhysicalValue, _ANGLE] = Field(
        default=PhysicalValue(8.0, "deg"), description="A flexible row bends by more."
    )
    share: float = Field(default=0.9, gt=0.0, lt=1.0)
    confidence: float = Field(default=0.9, gt=0.5, lt=1.0)


class Shape(_Bends):
    """Rows that are to be rigid and rows that are to be flexible at one time."""

    rigid: list[Count] = []
    flexible: list[Count] = []
    at: Time

    @model_validator(mode="after")
    def _check(self) -> Shape:
        both = sorted(set(self.rigid) & set(self.flexible))
        if both:
            raise ValueError(f"row {both[0]} is wanted rigid and flexible")
        if not self.rigid and not self.flexible:
            raise ValueError("name rows under `rigid` or `flexible`")
        return self


class Schedule(_Bends):
    """Rows that become rigid one after another: flexible before their time, rigid from then on."""

    rows: dict[Count, Time] = Field(min_length=1, description="Row to the time by which it is heated.")
    settle: Time = Field(default=PhysicalValue(1.0, "s"), description="From that time until its bend is looked at.")

    @model_validator(mode="after")
    def _check(self) -> Schedule:
        if min(t.to("s") for t in self.rows.values()) <= 0.0 or self.settle.to("s") < 0.0:
            raise ValueError("times of a schedule are after 0 s, and `settle` is not negative")
        return self


class Effort(Strict):
    """Most runs of each fidelity."""

    coarse: Annotated[
        StrictInt, Field(ge=0, description="0: the scenario's own settings decide about every design.")
    ] = 40
    full: Annotated[StrictInt, Field(ge=1)] = 20


class Task(Strict):
    """A design task, as its file describes it."""

    title: str
    description: str = ""
    scenario: StrictStr = Field(description="A fabric with a supply per string, beside the task, or a shipped one.")
    vary: Vary
    wanted: list[Wanted] = []
    shape: Shape | None = None
    schedule: Schedule | None = None
    least: Literal["energy", "rows_heated"] = "energy"
    runs: Effort = Effort()
    seed: Annotated[StrictInt, Field(ge=0)] = 0

    @model_validator(mode="after")
    def _check(self) -> Task:
        if not self.wanted and self.shape is None and self.schedule is None:
            raise ValueError("nothing is wanted: give `wanted`, `shape` or `schedule`")
        if self.shape is not None and self.schedule is not None:
            raise ValueError("give either `shape` or `schedule`")
        if (self.shape or self.schedule) and self.vary.rows_heated != "any":
            raise ValueError("`shape` and `schedule` say which rows are heated; leave `vary.rows_heated` out")
        return self


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
