"""`import.yaml`: what the columns of another tracker's table are on the rig, strictly read."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, StrictBool, StrictFloat, StrictInt, model_validator

from chainmail.camera.rig import Frequency, LensEntry, NotNegativeTime, PlaneEntry, Seconds
from cosim.components import Strict
from cosim.unit.quantity import In, PhysicalValue
from cosim.yaml_file import read_model

Axis = Literal["x", "y", "z", "-x", "-y", "-z"]
HERE = "docs/camera.md explains the keys of an import"


class ImportClock(Strict):
    """When each row was taken."""

    rate: Frequency | None = Field(default=None, description="Rows per second, for a table without times.")
    offset: Seconds = Field(default=PhysicalValue(0.0, "s"), description="Time of the scenario at the table's time 0.")
    offset_bound: NotNegativeTime = Field(default=PhysicalValue(0.0, "s"), description="How far it may be off.")


class ImportFile(Strict):
    """How a table of tracks belongs to a rig."""

    title: str
    source: str = ""
    markers: list[str] = Field(min_length=1, description="Names of the points in the file, marker 1 first.")
    y: Axis = Field(default="x", description="Axis of the file that is y, with a minus where it is turned round.")
    z: Axis = Field(default="y", description="Axis of the file that is z; of pixels their own plane says that.")
    unit: Literal["px", "mm", "cm", "m"] = Field(description="Of the coordinates.")
    lens: LensEntry | None = None
    plane: PlaneEntry | None = Field(default=None, description="Of coordinates in px: as in a rig.")
    clock: ImportClock = ImportClock()
    fabric: StrictBool = Field(
        default=False, description="Whether the markers are back and front of row 1, then of row 2, and so on."
    )
    least_likelihood: Annotated[StrictFloat | StrictInt, Field(ge=0, le=1)] = Field(
        default=0.9, description="DeepLabCut: what is less sure is a gap."
    )
    noise: Annotated[PhysicalValue, In("m", minimum=0.0, is_exclusive=True)] | None = Field(
        default=None, description="Standard deviation of a coordinate; default: from the readings."
    )
    overrides: dict[str, Any] = Field(default={}, description="What was done: goes into the recording as it is.")

    @model_validator(mode="after")
    def _check(self) -> ImportFile:
        if (self.unit == "px") != (self.plane is not None) or (self.lens is not None and self.plane is None):
            raise ValueError("`plane` belongs to coordinates in px, and these need it")
        if self.plane is not None and self.plane.colour is not None:
            raise ValueError("plane: a table has no picture in which fiducials could be refined: leave out `colour`")
        if self.unit == "px" and {"y", "z"} & self.model_fields_set:
            raise ValueError("of coordinates in px the plane says where y and z point: leave out `y` and `z`")
        if self.y[-1] == self.z[-1]:
            raise ValueError("y and z are the same axis of the file")
        if len(set(self.markers)) < len(self.markers):
            raise ValueError("a name stands twice under `markers`")
        if self.fabric and (len(self.markers) < 6 or len(self.markers) % 2):
            raise ValueError("a fabric has two markers for each of three or more rows")
        return self


def load_import(path: Path) -> ImportFile:
    """Read an import file.

    Raises:
        InputError: It cannot be read, or a key or value is wrong; all faults are listed, each with its key.
    """
    return read_model(path, ImportFile, "an import is a mapping with the keys title, markers, unit", HERE)
