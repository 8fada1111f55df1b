"""`camera.yaml`: the camera through which a run is rendered, strictly read."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, Field, StrictBool, StrictFloat, StrictInt, model_validator

from chainmail.camera.colours import PLAIN, check_colour
from cosim.components import Strict
from cosim.unit.quantity import In, PhysicalValue
from cosim.yaml_file import read_model

Number = Annotated[StrictFloat | StrictInt, Field(allow_inf_nan=False)]
Length = Annotated[PhysicalValue, In("m", minimum=0.0, is_exclusive=True)]
Coordinate = Annotated[PhysicalValue, In("m")]
Angle = Annotated[PhysicalValue, In("rad")]
Time = Annotated[PhysicalValue, In("s")]


def _painted(text: str) -> str:
    if text in PLAIN:
        raise ValueError(f"`{text}` is no paint; give a colour, such as green")
    return check_colour(text)


def _value(text: str) -> PhysicalValue:
    return PhysicalValue.parse(text)


class Rod(Strict):
    """A dark rod in front of the fabric that moves across the picture."""

    width: Length
    start: tuple[Coordinate, Coordinate] = Field(description="y and z of a point of its axis at `begin`.")
    stop: tuple[Coordinate, Coordinate] = Field(description="y and z of that point at `end`.")
    direction: Angle = Field(default=_value("90 deg"), description="Of its axis, from +y towards +z.")
    begin: Time
    end: Time

    @model_validator(mode="after")
    def _check(self) -> Rod:
        if self.end.to("s") <= self.begin.to("s"):
            raise ValueError(f"end ({self.end}) must come after begin ({self.begin})")
        return self


class CameraFile(Strict):
    """How a camera sees the fabric; every disturbance is absent by default."""

    width: Annotated[StrictInt, Field(ge=64, le=8192)] = Field(default=960, description="Pixels.")
    height: Annotated[StrictInt, Field(ge=64, le=8192)] = Field(default=720, description="Pixels.")
    rate: Annotated[PhysicalValue, In("Hz", minimum=0.0, is_exclusive=True)] = Field(default=_value("60 Hz"))
    begin: Time | None = Field(default=None, description="Begin of the first exposure; default: that of the run.")
    end: Time | None = Field(default=None, description="No exposure ends later; default: the end of the run.")
    exposure: Annotated[PhysicalValue, In("s", minimum=0.0)] = Field(default=_value("4 ms"))
    scale: Length = Field(default=_value("0.25 mm"), description="Length of a pixel in the middle of the picture.")
    centre: tuple[Coordinate, Coordinate] = Field(
        default=(_value("72 mm"), _value("-10 mm")), description="y and z in the middle of the picture."
    )
    distance: Length = Field(default=_value("0.8 m"), description="From the camera to that point.")
    yaw: Angle = Field(default=_value("0 deg"), description="Turn of the plane about z.")
    pitch: Angle = Field(default=_value("0 deg"), description="Turn of the plane about y.")
    distortion: Annotated[list[Number], Field(max_length=5)] = Field(default=[], description="k1, k2, p1, p2, k3.")
    light: Annotated[Number, Field(gt=0, le=2)] = Field(default=1.0, description="Brightness.")
    gradient: Annotated[Number, Field(ge=-1, le=1)] = Field(
        default=0.0, description="Relative change of brightness from left to right."
    )
    noise: Annotated[Number, Field(ge=0)] = Field(default=1.5, description="Standard deviation, of 255 levels.")
    jpeg: Annotated[StrictInt, Field(ge=1, le=100)] = Field(default=95, description="Quality of compression.")
    colour: Annotated[str, AfterValidator(_painted)] = Field(default="green", description="Of the markers.")
    diameter: Length = Field(default=_value("6 mm"), description="Of the markers.")
    fiducials: StrictBool = Field(default=False, description="Whether six blue dots show the plane.")
    rods: list[Rod] = Field(default=[], description="What crosses in front.")


def load_camera(path: Path) -> CameraFile:
    """Read a camera.

    Raises:
        InputError: It cannot be read, or a key or value is wrong; all faults are listed, each with its key.
    """
    return read_model(
        path,
        CameraFile,
        "a camera is a mapping with keys such as rate, exposure and scale",
        "docs/camera.md lists the keys of a camera",
        "docs/camera.md lists them; `{}` is a camera without disturbances",
    )
