"""`recording.yaml`: what was done, in the scenario's own words, and what each column of the table measures."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, Field, StrictFloat, StrictInt, model_validator

from cosim.components import AnyQuantity, Duration, Strict, Time
from cosim.unit.quantity import In, PhysicalValue
from cosim.yaml_file import read_model

Number = StrictFloat | StrictInt


def _is_usable(value: float) -> float:
    if not math.isfinite(value) or value == 0.0:
        raise ValueError(f"a factor of {value:g} leaves nothing of the column; give a number other than 0")
    return value


#: What a column is multiplied by.
Factor = Annotated[Number, AfterValidator(_is_usable)]


class Clock(Strict):
    """A column of times."""

    column: str = Field(default="time", description="Column of the table.")
    unit: str = Field(default="s", description="Unit of time of that column.")
    zero: Annotated[Number, Field(allow_inf_nan=False)] | None = Field(
        default=None, description="Reading of the clock at the scenario's time 0, in that unit; default: its first."
    )
    offset_bound: Annotated[PhysicalValue, In("s", minimum=0.0)] = Field(
        default=PhysicalValue(0.0, "s"), description="How far the clock may be off; within it the offset is estimated."
    )


class ChannelEntry(Strict):
    """One measured quantity."""

    column: str = Field(description="Column of the table.")
    unit: str = Field(description="Unit of the values, for example degC or mA; without `factor` that of the column.")
    factor: Factor = Field(default=1.0, description="Value = factor * column, in `unit`, for example mm to one pixel.")
    noise: AnyQuantity | None = Field(
        default=None, description="Standard deviation of the sensor; estimated where it is not given."
    )
    noise_column: str | None = Field(
        default=None,
        description="Column with the standard deviation of each reading, in the unit and with the factor of the "
        "column; readings that are far less certain than the others are left out.",
    )
    quantum: AnyQuantity | None = Field(default=None, description="Step of a quantised reading.")
    minimum: AnyQuantity | None = Field(default=None, description="Reading at which the sensor clips at the bottom.")
    maximum: AnyQuantity | None = Field(default=None, description="Reading at which the sensor clips at the top.")
    lag_bound: Annotated[PhysicalValue, In("s", minimum=0.0)] = Field(
        default=PhysicalValue(0.0, "s"), description="Largest time constant that the sensor may have."
    )
    bias_bound: AnyQuantity | None = Field(
        default=None, description="How far its zero may be off; within it the bias is estimated."
    )
    invalid: list[Number] = Field(default=[], description="Readings that mean `no value`.")
    table: str | None = Field(default=None, description="Table of this channel; default: that of the recording.")
    time: Clock | None = Field(default=None, description="Clock of this channel; default: that of the recording.")

    @model_validator(mode="after")
    def _check(self) -> ChannelEntry:
        if self.noise is not None and self.noise_column is not None:
            raise ValueError("give `noise` or `noise_column`, not both")
        return self


class InputEntry(Strict):
    """A programme's output that was recorded: its points come from a column of the table."""

    column: str
    unit: str = Field(description="Unit of the column after scaling, for example W or V.")
    factor: Factor = Field(default=1.0, description="Value = factor * column, in `unit`.")
    table: str | None = None
    time: Clock | None = None


class Sidecar(Strict):
    """A recording as its file describes it."""

    title: str
    source: str = Field(default="", description="Who measured it, where it is published, under which licence.")
    table: str = Field(description="CSV or Parquet file beside this one.")
    header_lines: Annotated[StrictInt, Field(ge=0)] = Field(default=0, description="Lines of a CSV before its header.")
    time: Clock = Clock()
    begin: Time | None = Field(default=None, description="Only what was measured from this time on is used.")
    end: Time | None = Field(default=None, description="Only what was measured up to this time is used.")
    beginning: Time | None = Field(
        default=None,
        description="Where it is held out: what it does not know exactly itself is estimated from this "
        "first stretch of time, which then does not judge.",
    )
    day: str = Field(
        default="",
        description="Recordings of one day share its room, its clocks and its zeros; two halves of a day have one "
        "name. Default: a day of its own.",
    )
    order: Annotated[StrictInt, Field(ge=1)] | None = Field(
        default=None,
        description="Place among the recordings in time, from 1; what breaks in one stays broken in later ones. "
        "Default: as given to the command, those held out last.",
    )
    cycles_before: Annotated[Number, Field(ge=0, allow_inf_nan=False)] = Field(
        default=0, description="Full cycles (heated and cooled) that the rig had made before this recording."
    )
    switch_margin: Duration = Field(
        default=PhysicalValue(0.3, "s"), description="Samples this close to a switch are not used to judge."
    )
    overrides: dict[str, Any] = Field(
        default={}, description="What was done: keys of the scenario with the values of this recording."
    )
    uncertain: dict[str, AnyQuantity] = Field(
        default={},
        description="`component.parameter`, or a constant output of a programme, that this recording does not know "
        "exactly (initial state, room): standard deviation.",
    )
    inputs: dict[str, InputEntry] = Field(
        default={}, description="`component.output` of a programme whose course is a column of the table."
    )
    channels: dict[str, ChannelEntry] = Field(min_length=1)

    @model_validator(mode="after")
    def _check(self) -> Sidecar:
        if self.beginning is not None and self.beginning.to("s") <= 0.0:
            raise ValueError(f"beginning ({self.beginning}) is a length of time; it must be more than 0 s")
        if self.begin is not None and self.end is not None and self.end.to("s") <= self.begin.to("s"):
            raise ValueError(f"end ({self.end}) must come after begin ({self.begin})")
        return self


def load_sidecar(file: Path) -> Sidecar:
    """Read `recording.yaml`.

    Raises:
        InputError: It cannot be read, or a key or value is wrong; all faults are listed, each with its key.
    """
    return read_model(
        file,
        Sidecar,
        "a recording is a mapping with the keys title, table, channels",
        "docs/recordings.md lists the keys of a recording",
        "see docs/recordings.md, or make one with `cosim record`",
    )
