"""`rig.yaml`: how a camera sees a rig, strictly read."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field, StrictFloat, StrictInt, model_validator

from chainmail.camera.colours import check_colour
from cosim.components import Strict
from cosim.unit.quantity import In, PhysicalValue
from cosim.yaml_file import read_model


def _finite(value: float) -> float:
    if not math.isfinite(value):
        raise ValueError(f"{value} is no finite number")
    return float(value)


def _no_screen(value: PhysicalValue) -> PhysicalValue:
    """A pixel of a picture is no length: what it shows depends on the camera."""
    if "px" in value.unit or "pixel" in value.unit or "dot" in value.unit:
        raise ValueError(f"`{value}` is a number of pixels; give a length, in the plane of the markers, such as `6 mm`")
    return value


def _number(value: object) -> object:
    if isinstance(value, str):
        raise ValueError(f"`{value}` is no number; it counts in pixels of the picture")
    return value


Number = Annotated[StrictFloat | StrictInt, AfterValidator(_finite), BeforeValidator(_number)]
Positive = Annotated[Number, Field(gt=0)]
Length = Annotated[PhysicalValue, In("m", minimum=0.0, is_exclusive=True, usual="mm"), AfterValidator(_no_screen)]
Coordinate = Annotated[PhysicalValue, In("m", usual="mm"), AfterValidator(_no_screen)]
Angle = Annotated[PhysicalValue, In("rad", usual="deg")]
Seconds = Annotated[PhysicalValue, In("s")]
NotNegativeTime = Annotated[PhysicalValue, In("s", minimum=0.0, usual="ms")]
Frequency = Annotated[PhysicalValue, In("Hz", minimum=0.0, is_exclusive=True)]
Pixel = tuple[Number, Number]
Pixels = Annotated[StrictInt, Field(ge=1)]
Colour = Annotated[str, AfterValidator(check_colour)]
HERE = "docs/camera.md explains the keys of a rig"


class Chessboard(Strict):
    """Pictures of a flat chessboard, from which the lens follows."""

    folder: str = Field(description="Folder of pictures, beside the rig file.")
    corners: tuple[Annotated[StrictInt, Field(ge=3)], Annotated[StrictInt, Field(ge=3)]] = Field(
        description="Inner corners along both sides of the board."
    )
    pattern: str = Field(default="*", description="Which files of the folder, for example left*.jpg.")


class LensEntry(Strict):
    """Intrinsics of the camera: given, or from pictures of a chessboard."""

    focal: tuple[Positive, Positive] | None = Field(default=None, description="Focal lengths along u and v [px].")
    centre: Pixel | None = Field(default=None, description="Principal point (u, v) [px].")
    distortion: list[Number] = Field(default=[], max_length=5, description="k1, k2, p1, p2, k3 of Brown's model.")
    chessboard: Chessboard | None = None

    @model_validator(mode="after")
    def _check(self) -> LensEntry:
        if self.chessboard is not None and (self.focal or self.centre or self.distortion):
            raise ValueError("give the intrinsics or a chessboard, not both")
        if self.chessboard is None and (self.focal is None or self.centre is None):
            raise ValueError("give `focal` and `centre`, or `chessboard`")
        return self


class Fiducial(Strict):
    """A point of the plane of the markers whose place is known."""

    at: tuple[Coordinate, Coordinate] = Field(description="Its y and z.")
    pixel: Pixel = Field(description="Where it is in the picture: u to the right, v down, from the centre of pixel 0.")


class PlaneEntry(Strict):
    """The plane in which the markers move."""

    scale: Length | None = Field(default=None, description="Length of one pixel, for a camera that looks squarely.")
    origin: Pixel | None = Field(default=None, description="With `scale`: pixel (u, v) of y = z = 0.")
    y: Literal["right", "left"] = Field(default="right", description="With `scale`: where +y points in the picture.")
    z: Literal["up", "down"] = Field(default="up", description="With `scale`: where +z points in the picture.")
    fiducials: list[Fiducial] | None = Field(default=None, min_length=4, description="At least four known points.")
    colour: Colour | None = Field(default=None, description="Colour of the fiducials: their pixels are refined.")
    diameter: Length | None = Field(default=None, description="Diameter of coloured fiducials.")

    @model_validator(mode="after")
    def _check(self) -> PlaneEntry:
        if (self.scale is None) == (self.fiducials is None):
            raise ValueError("give either `scale` (with `origin`) or `fiducials`")
        if self.scale is not None and self.origin is None:
            raise ValueError("`scale` needs `origin`, the pixel of y = z = 0")
        if self.fiducials is not None and {"origin", "y", "z"} & self.model_fields_set:
            raise ValueError("fiducials have coordinates of their own: leave out `origin`, `y` and `z`")
        if (self.colour is None) != (self.diameter is None) or (self.colour and self.fiducials is None):
            raise ValueError("`colour` and `diameter` of fiducials belong together, and to `fiducials`")
        return self


class Band(Strict):
    """Smallest and largest length."""

    least: Length
    most: Length

    @model_validator(mode="after")
    def _check(self) -> Band:
        if self.most.to("m") <= self.least.to("m"):
            raise ValueError(f"`most` ({self.most}) must be above `least` ({self.least})")
        return self


def _band(least: str, most: str) -> Band:
    return Band(least=PhysicalValue.parse(least), most=PhysicalValue.parse(most))


class FabricLayout(Strict):
    """Markers at both ends of the outermost link of each row, as in the paper; row 1 at the tether."""

    kind: Literal["fabric"]
    rows: Annotated[StrictInt, Field(ge=3, le=60)]
    columns: Annotated[StrictInt, Field(ge=2)] = Field(default=2, description="Links A in a row; names `link[n]`.")
    link_length: Band = Field(
        default_factory=lambda: _band("29.5 mm", "35 mm"), description="Distance of the two markers of a link."
    )
    row_pitch: Band = Field(
        default_factory=lambda: _band("18 mm", "31 mm"), description="Distance of the centres of neighbouring rows."
    )
    lean: tuple[Angle, Angle] = Field(
        default=(PhysicalValue(20.0, "deg"), PhysicalValue(75.0, "deg")),
        description="Angle of a link above the line to the next row's centre, least and most.",
    )
    along: Angle = Field(
        default=PhysicalValue(0.0, "deg"), description="Direction of the fabric at its tether, from +y towards +z."
    )
    tethered_rows: Annotated[StrictInt, Field(ge=0)] = Field(default=1, description="Rows that do not move.")

    @model_validator(mode="after")
    def _check(self) -> FabricLayout:
        least, most = (a.to("rad") for a in self.lean)
        if not least < most:
            raise ValueError(f"lean: {self.lean[1]} must be above {self.lean[0]}")
        if self.tethered_rows > self.rows:
            raise ValueError(f"tethered_rows: there are only {self.rows} rows")
        return self


class PointsLayout(Strict):
    """Any markers that each stay within reach of a known place."""

    kind: Literal["points"]
    points: list[tuple[Coordinate, Coordinate]] = Field(min_length=1, description="y and z of every marker, in order.")
    reach: Length = Field(description="How far a marker may be from its place.")


class MarkersEntry(Strict):
    """What the markers look like, and how they are laid out."""

    colour: Colour = Field(description="A name, #rrggbb, `dark` or `bright`.")
    diameter: Length
    layout: FabricLayout | PointsLayout = Field(discriminator="kind")


class ClockEntry(Strict):
    """When each frame was taken."""

    rate: Frequency | None = Field(default=None, description="Frames per second, evenly spaced.")
    stamps: str | None = Field(default=None, description="CSV file with a time for each frame, beside the rig file.")
    column: str = Field(default="time", description="Column of `stamps`.")
    unit: str = Field(default="s", description="Unit of that column.")
    stamp: Literal["begin", "middle", "end"] = Field(
        default="begin", description="Which instant of the exposure a time stamp is."
    )
    exposure: NotNegativeTime = Field(description="How long a frame is exposed.")
    readout: Seconds = Field(
        default=PhysicalValue(0.0, "s"),
        description="Of a rolling shutter: time from the top line to the bottom one; negative where it goes upwards. "
        "A time stamp is that of the line in the middle.",
    )
    offset: Seconds = Field(
        default=PhysicalValue(0.0, "s"), description="Time of the scenario at time stamp 0 of the camera."
    )
    offset_bound: NotNegativeTime = Field(
        default=PhysicalValue(0.0, "s"), description="How far `offset` may be off; goes into the recording."
    )

    @model_validator(mode="after")
    def _check(self) -> ClockEntry:
        if self.rate is not None and self.stamps is not None:
            raise ValueError("give `rate` or `stamps`, not both")
        if self.rate is not None and self.exposure.to("s") > 1.0 / self.rate.to("Hz"):
            raise ValueError(f"exposure: {self.exposure} is longer than a frame at {self.rate}")
        if self.rate is not None and abs(self.readout.to("s")) > 1.0 / self.rate.to("Hz"):
            raise ValueError(f"readout: {self.readout} is longer than a frame at {self.rate}")
        return self


class Rig(Strict):
    """A camera before a rig."""

    title: str
    source: str = Field(default="", description="Who filmed it, where it is published, under which licence.")
    picture: tuple[Pixels, Pixels] | None = Field(
        default=None, description="Width and height of the pictures in which the pixels of `lens` and `plane` count."
    )
    lens: LensEntry | None = Field(default=None, description="Absent: the lens is taken as free of distortion.")
    plane: PlaneEntry
    markers: MarkersEntry
    clock: ClockEntry
    largest_noise: Length = Field(
        default=PhysicalValue(1.0, "mm"), description="A marker known less well than this is a gap."
    )
    overrides: dict[str, Any] = Field(default={}, description="What was done: goes into the recording as it is.")


def load_rig(path: Path) -> Rig:
    """Read a rig.

    Raises:
        InputError: It cannot be read, or a key or value is wrong; all faults are listed, each with its key.
    """
    return read_model(path, Rig, "a rig is a mapping with the keys title, plane, markers, clock", HERE)
