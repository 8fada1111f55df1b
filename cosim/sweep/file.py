"""Sweep files: YAML to typed axes and outputs."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, StrictBool, StrictInt, StrictStr, model_validator

from cosim.components import AnyQuantity, Count, Strict, Time
from cosim.scenario import find_scenario
from cosim.unit.errors import InputError
from cosim.unit.quantity import In, PhysicalValue
from cosim.yaml_file import parse_yaml, read_model, read_text

_REMEDY = "docs/sweeps.md explains every key"
#: Most points of one axis, and most runs of a sweep: more is a slip of the pen, and would fill a disk.
MOST_POINTS, MOST_RUNS = 100_000, 100_000
Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]


class Range(Strict):
    """Evenly spaced values, both ends included."""

    from_: AnyQuantity = Field(alias="from")
    to: AnyQuantity
    count: Annotated[StrictInt, Field(ge=2, le=MOST_POINTS)]
    scale: Literal["linear", "log"] = "linear"

    @model_validator(mode="after")
    def _check(self) -> Range:
        check_ends(self.from_, self.to, self.scale)
        return self


def check_ends(first: PhysicalValue, last: PhysicalValue, scale: str) -> None:
    """Raise ValueError unless two ends measure the same thing, differ, and are positive where the scale needs it."""
    low, high = first.to(first.unit), last.to(first.unit)
    if low == high:
        raise ValueError(f"`from` and `to` are both {first}")
    if scale == "log" and min(low, high) <= 0.0:
        raise ValueError(f"a logarithmic scale needs positive ends, not {first} and {last}")


class Keyed(Strict):
    """One key of the scenario and the values that it takes."""

    key: StrictStr
    values: list[Any] | None = Field(default=None, min_length=1, max_length=MOST_POINTS)
    range: Range | None = None

    @model_validator(mode="after")
    def _check(self) -> Keyed:
        if (self.values is None) == (self.range is None):
            raise ValueError("give either `values` or `range`")
        return self


class Spread(Strict):
    """One key of the scenario that is drawn: between two ends, or as its parameter set states."""

    key: StrictStr
    from_: AnyQuantity | None = Field(default=None, alias="from")
    to: AnyQuantity | None = None
    scale: Literal["linear", "log"] = "linear"
    stated: StrictBool = Field(
        default=False, description="ln(value) is normal, with the standard deviation that the parameter set states."
    )

    @model_validator(mode="after")
    def _check(self) -> Spread:
        if self.stated == (self.from_ is not None) or (self.from_ is None) != (self.to is None):
            raise ValueError("give either `from` and `to`, or `stated: true`")
        if self.from_ is not None and self.to is not None:
            check_ends(self.from_, self.to, self.scale)
        return self


class Stated(Strict):
    """Every parameter of a component whose parameter set states an uncertainty."""

    component: StrictStr


class Sobol(Strict):
    """Points of a scrambled Sobol' sequence (`scipy.stats.qmc`), or Saltelli's design for Sobol' indices (SALib)."""

    count: Annotated[StrictInt, Field(ge=1, le=MOST_POINTS)]
    of: list[Spread | Stated] = Field(min_length=1)
    seed: Annotated[StrictInt, Field(ge=0)] = 0
    indices: StrictBool = Field(
        default=False, description="Make count * (keys + 2) runs, from which Sobol' indices are estimated."
    )

    @model_validator(mode="after")
    def _check(self) -> Sobol:
        if self.indices and self.count & (self.count - 1):
            raise ValueError(f"with `indices` the count must be a power of two, not {self.count}")
        return self


class Starts(Strict):
    """Random starts of a fabric: its links begin with other small speeds, and contacts make other histories of it."""

    component: StrictStr = "fabric"
    count: Count
    first: Count = 1
    speed: Annotated[PhysicalValue, In("m/s", minimum=0.0, is_exclusive=True)] = PhysicalValue(1.0, "mm/s")


class Axis(Strict):
    """One axis: one key, several keys that change together, drawn keys, or starts."""

    key: StrictStr | None = None
    values: list[Any] | None = Field(default=None, min_length=1, max_length=MOST_POINTS)
    range: Range | None = None
    zip: list[Keyed] | None = Field(default=None, min_length=1)
    sobol: Sobol | None = None
    starts: Starts | None = None

    @model_validator(mode="after")
    def _check(self) -> Axis:
        given = [n for n in ("key", "zip", "sobol", "starts") if getattr(self, n) is not None]
        if len(given) != 1:
            raise ValueError(
                "an axis has one of `key`, `zip`, `sobol` and `starts`"
                + (f", not {' and '.join(given)}" if given else "")
            )
        if self.key is not None:
            Keyed(key=self.key, values=self.values, range=self.range)
        elif self.values is not None or self.range is not None:
            raise ValueError(f"`values` and `range` belong to `key`, not to `{given[0]}`")
        return self


class Output(Strict):
    """One number of every run."""

    quantity: StrictStr = Field(description="component.variable, component.tip_sag, or energy.")
    over: Literal["final", "at", "max", "min", "mean", "integral"] = "final"
    at: Time | None = None
    from_: Time | None = Field(default=None, alias="from")
    to: Time | None = None
    of: Annotated[Literal["max", "min", "mean", "sum"] | Count, Field(union_mode="left_to_right")] = Field(
        default="max", description="How elements of an array become one number, or which element, counted from 1."
    )
    unit: str | None = Field(default=None, description="Unit in tables and figures; default: that of the quantity.")

    @model_validator(mode="after")
    def _check(self) -> Output:
        if (self.over == "at") != (self.at is not None):
            raise ValueError("`at` gives the time of `over: at`, and only of that")
        if self.over in ("final", "at") and (self.from_ is not None or self.to is not None):
            raise ValueError(f"`from` and `to` bound max, min, mean and integral, not `{self.over}`")
        return self


class Recorded(Strict):
    """One series of every run."""

    quantity: StrictStr
    of: Annotated[Literal["max", "min", "mean", "sum"] | Count, Field(union_mode="left_to_right")] = "max"


class SweepFile(Strict):
    """A sweep, as its file describes it."""

    title: str
    description: str = ""
    scenario: StrictStr = Field(description="A scenario file beside the sweep file, or a shipped scenario.")
    axes: dict[Name, Axis] = Field(min_length=1, description="Each is a dimension of the result; they multiply.")
    outputs: dict[Name, Output] = Field(min_length=1)
    series: dict[Name, Recorded] = {}

    @model_validator(mode="after")
    def _check(self) -> SweepFile:
        twice = (set(self.axes) & set(self.outputs)) | (set(self.series) & (set(self.axes) | set(self.outputs)))
        if twice:
            raise ValueError(f"the name `{min(twice)}` stands for two things; axes, outputs and series need their own")
        taken = {"time", "run", "failure"} & (set(self.axes) | set(self.outputs) | set(self.series))
        if taken:
            raise ValueError(f"the name `{min(taken)}` is taken by the result itself; choose another")
        return self


def load_sweep(path: Path) -> SweepFile:
    """Read a sweep file.

    Raises:
        InputError: It cannot be read, or a key or value is wrong.
    """
    return read_model(path, SweepFile, "a sweep is a mapping with the keys title, scenario, axes, outputs", _REMEDY)


def base_scenario(sweep: SweepFile, path: Path) -> tuple[Any, Path]:
    """Content and file of the scenario that is swept.

    Args:
        sweep: The sweep.
        path: Its file: a scenario beside it comes before a shipped one of the same name.

    Raises:
        InputError: There is no such scenario, or it is no YAML.
    """
    beside = path.parent / sweep.scenario
    try:
        found = beside if os.path.isfile(beside) else find_scenario(sweep.scenario)
    except InputError as error:
        raise InputError(path, "scenario", f"`{sweep.scenario}`: {error.problem}", error.remedy) from error
    return parse_yaml(read_text(found), found), found
