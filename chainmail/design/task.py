"""Design tasks: YAML to what may vary, what is wanted, and what is to be least."""

from __future__ import annotations

import math
import os
import re
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StrictInt, StrictStr, model_validator

from cosim.components import AnyQuantity, Count, Strict, Time
from cosim.faults import shown
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


class Span(Strict):
    """A number of the scenario and the range in which it may lie."""

    low: AnyQuantity
    high: AnyQuantity

    @model_validator(mode="after")
    def _check(self) -> Span:
        if self.low.number >= self.high.to(self.low.unit or "1"):
            raise ValueError(f"the range from {self.low} to {self.high} is empty")
        return self

    def at(self, share: float) -> str:
        """A value of the range as text, in the unit of its lower end, to four digits."""
        low, high = self.low.number, self.high.to(self.low.unit or "1")
        value = low + min(max(share, 0.0), 1.0) * (high - low)
        return str(PhysicalValue(min(max(float(f"{value:.4g}"), low), high), self.low.unit))

    def share(self, value: PhysicalValue) -> float:
        """Where a value lies in the range, 0 to 1; the nearest end where it lies outside."""
        low, high = self.low.number, self.high.to(self.low.unit or "1")
        return min(max((value.to(self.low.unit or "1") - low) / (high - low), 0.0), 1.0)


def _patterns(value: object) -> object:
    if isinstance(value, list) and all(isinstance(pattern, list) for pattern in value):
        wrong = [r for pattern in value for r in pattern if not isinstance(r, int) or isinstance(r, bool) or r < 1]
        if wrong:
            raise ValueError(f"{shown(wrong[0])} is no number of a row; rows are counted from 1, from the tether on")
        return value
    if value == "any":
        return value
    raise ValueError(f"{shown(value)} is neither `any` nor a list of patterns such as `[[3, 4], [3, 4, 5]]`")


class Vary(Strict):
    """What a design may choose."""

    rows_heated: Annotated[Literal["any"] | list[list[Count]], BeforeValidator(_patterns)] = Field(
        default="any", description="Patterns of heated rows, counted from the tether; any: every pattern of free rows."
    )
    voltage: Annotated[_Voltages, BeforeValidator(_ends)] = Field(description="Of a string while it is heated.")
    temperature: Annotated[_Temperatures, BeforeValidator(_ends)] = Field(
        default=_TEMPERATURES, description="Of a row at the end of heating."
    )
    keys: dict[str, Annotated[Span, BeforeValidator(_ends)]] = Field(
        default={}, description="Numbers of the fabric, by their paths; a path may stand beside the other keys."
    )

    @model_validator(mode="before")
    @classmethod
    def _paths(cls, data: Any) -> Any:
        """`fabric.parameters.tolerance: 0.5 mm to 2 mm` stands where `keys` would."""
        if not isinstance(data, dict) or not isinstance(data.get("keys", {}), dict):
            return data
        paths = {k: v for k, v in data.items() if isinstance(k, str) and "." in k}
        rest = {k: v for k, v in data.items() if k not in paths}
        return {**rest, "keys": {**data.get("keys", {}), **paths}} if paths else data


class Wanted(Output):
    """One requirement: a number of every run below or above a bound, in a share of starts."""

    below: AnyQuantity | None = None
    above: AnyQuantity | None = None
    share: float = Field(default=0.9, ge=0.5, lt=1.0, description="Share of starts in which it must hold.")
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

    @property
    def last(self) -> float:
        """Time from which a run says whether it holds [s]; infinite where the whole run says it."""
        if self.over == "at":
            return self.at.to("s") if self.at is not None else math.inf
        return self.to.to("s") if self.to is not None else math.inf

    def text(self) -> str:
        """For people."""
        relation = f"below {self.below}" if self.below is not None else f"above {self.above}"
        return f"{self.name} {relation}"

    @property
    def name(self) -> str:
        """What is bounded, without the bound."""
        span = f" from {self.from_} to {self.to}" if self.from_ is not None and self.to is not None else ""
        when = f" at {self.at}" if self.at is not None else f" ({self.over}{span})"
        element = f"[{self.of}]" if isinstance(self.of, int) else ""
        return f"{self.quantity}{element}{when}"


_ANGLE = In("rad", minimum=0.0, is_exclusive=True)


class _Bends(Strict):
    """What counts as rigid and as flexible."""

    straight: Annotated[PhysicalValue, _ANGLE] = Field(
        default=PhysicalValue(8.0, "deg"), description="A rigid row bends by less."
    )
    bent: Annotated[PhysicalValue, _ANGLE] = Field(
        default=PhysicalValue(8.0, "deg"), description="A flexible row bends by more."
    )
    share: float = Field(default=0.9, ge=0.5, lt=1.0)
    confidence: float = Field(default=0.9, gt=0.5, lt=1.0)

    @model_validator(mode="after")
    def _ordered(self) -> _Bends:
        if self.bent.to("rad") < self.straight.to("rad"):
            raise ValueError(
                f"a row that bends by an angle between `bent` {self.bent} and `straight` {self.straight} would be both "
                "flexible and rigid; give a `bent` that is not below `straight`"
            )
        return self


class Shape(_Bends):
    """Rows that are to be rigid and rows that are to be flexible at one time."""

    rigid: list[Count] = []
    flexible: list[Count] = []
    at: Time

    @model_validator(mode="after")
    def _check(self) -> Shape:
        twice = [r for rows in (self.rigid, self.flexible) for r in rows if rows.count(r) > 1]
        if twice:
            raise ValueError(f"row {twice[0]} stands twice")
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


class Cycle(Strict):
    """Flexible, rigid after a delay, and flexible again at the end of the cycle; the first switch is at 0 s."""

    cold: Annotated[PhysicalValue, In("1/m", minimum=0.0)] = Field(
        description="Curvature that a cold fabric has more than."
    )
    hot: Annotated[PhysicalValue, In("1/m", minimum=0.0, is_exclusive=True)] = Field(
        description="Curvature that a hot one has less than."
    )
    delay: list[Time] = Field(min_length=1, description="From the first switch until it is hot; a front over several.")
    hot_for: Time = Field(default=PhysicalValue(1.0, "s"), description="How long it is to stay so.")
    period: Time = Field(description="From the first switch until it is cold again.")
    share: float = Field(default=0.9, ge=0.5, lt=1.0)
    confidence: float = Field(default=0.9, gt=0.5, lt=1.0)

    @model_validator(mode="before")
    @classmethod
    def _one(cls, data: Any) -> Any:
        """One delay may stand by itself."""
        if isinstance(data, dict) and "delay" in data and not isinstance(data["delay"], list):
            return {**data, "delay": [data["delay"]]}
        return data

    @model_validator(mode="after")
    def _check(self) -> Cycle:
        if self.cold.to("1/m") <= self.hot.to("1/m"):
            raise ValueError(f"a cold fabric bends more than a hot one, but `cold` {self.cold} is not above `hot`")
        delays = [d.to("s") for d in self.delay]
        if min(delays) <= 0.0 or self.hot_for.to("s") <= 0.0:
            raise ValueError("`delay` and `hot_for` are longer than 0 s")
        if len(set(delays)) < len(delays):
            raise ValueError("a delay stands twice")
        if self.period.to("s") <= max(delays) + self.hot_for.to("s"):
            raise ValueError(f"`period` {self.period} is over before the fabric has been hot; make it longer")
        return self


class Effort(Strict):
    """Most runs of each fidelity."""

    coarse: Annotated[
        StrictInt,
        Field(ge=0, description="0: the scenario's own settings decide about every design. Short runs count here too."),
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
    cycle: Cycle | None = None
    least: Literal["energy", "rows_heated"] = "energy"
    runs: Effort = Effort()
    seed: Annotated[StrictInt, Field(ge=0)] = 0

    @model_validator(mode="after")
    def _check(self) -> Task:
        given = [n for n in ("shape", "schedule", "cycle") if getattr(self, n) is not None]
        if not self.wanted and not given:
            raise ValueError("nothing is wanted: give `wanted`, `shape`, `schedule` or `cycle`")
        if len(given) > 1:
            raise ValueError(f"give either `{given[0]}` or `{given[1]}`")
        if self.cycle is not None:
            if self.least != "energy":
                raise ValueError("a cycle asks for the least energy: `least: energy`")
            timed = [w for w in self.wanted if w.at is not None]
            if timed:
                raise ValueError(f"`{timed[0].text()}`: a cycle has its own times; give what holds over the whole run")
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
