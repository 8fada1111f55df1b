"""What a player shows: fabrics over time, quantities on them, curves beside them, marks of recordings and findings."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from cosim.unit.protocol import Array


@dataclass(frozen=True)
class Shape:
    """Size of a link: two cylinders (bars) along its x axis, joined by two square arms along its y axis.

    Args:
        bar_diameter: d, thickness of bars and arms [m].
        outer_width: w, length of a bar, over both arms [m].
        length_offset: Distance of the two bars' axes less the link length l [m].
    """

    bar_diameter: float
    outer_width: float
    length_offset: float

    @property
    def arm_x(self) -> float:
        """Distance of the axis of an arm from the middle of the link [m], as in `mechanics.half`."""
        return (self.outer_width - self.bar_diameter) / 2


@dataclass(frozen=True)
class Field:
    """A quantity that links are coloured by.

    Args:
        name: Short name, for example `temperature`.
        unit: Unit of `values`, as shown.
        values: Shape (frames, coils), two coils to a link: arm at -x, arm at +x.
    """

    name: str
    unit: str
    values: Array


@dataclass(frozen=True)
class Curve:
    """A quantity over time, for the plots.

    Args:
        plot: Title of the plot that it belongs to; curves of one title share axes.
        unit: Unit of `values`, as shown.
        label: Which one of several; empty where the plot has only one of a run.
        times: [s], rising, shape (points,).
        values: Shape (points,); not a number where there is no reading.
        lower: Lower edge of a band around the curve, shape (points,); None: a line alone.
        upper: Its upper edge.
    """

    plot: str
    unit: str
    label: str
    times: Array
    values: Array
    lower: Array | None = None
    upper: Array | None = None


@dataclass(frozen=True)
class Fabric:
    """A fabric of a run, frame by frame.

    Args:
        title: Of its run.
        name: Of the component.
        shape: Size of a link.
        times: [s], rising, shape (frames,).
        position: Middle of every link [m], shape (frames, links, 3).
        orientation: Quaternion x, y, z, w without jumps of sign, shape (frames, links, 4).
        link_length: l [m], shape (frames, links).
        row: Row of every link, from 1, shape (links,).
        place: Place of every link in its row, from 1, shape (links,).
        is_held: Links that do not move in the whole run, shape (links,).
        fields: What can be shown in colours, at least the link length.
        curves: What can be plotted.
        notes: What a viewer must know: a run that stopped early, frames left out.
    """

    title: str
    name: str
    shape: Shape
    times: Array
    position: Array
    orientation: Array
    link_length: Array
    row: npt.NDArray[np.int64]
    place: npt.NDArray[np.int64]
    is_held: npt.NDArray[np.bool_]
    fields: tuple[Field, ...]
    curves: tuple[Curve, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def links(self) -> int:
        """Number of links."""
        return len(self.row)

    @property
    def bar_distance(self) -> Array:
        """Distance of the two bars of every link [m], shape (frames, links)."""
        return self.link_length + self.shape.length_offset

    @property
    def size(self) -> str:
        """In words: `6 rows of 3 links`."""
        rows = int(self.row.max())
        return f"{rows} rows of {self.links // rows} links"


@dataclass(frozen=True)
class Track:
    """One recorded coordinate over time.

    Args:
        times: [s], rising, shape (samples,).
        values: [m], shape (samples,).
    """

    times: Array
    values: Array

    @property
    def gap(self) -> float:
        """Samples farther apart than this have a gap between them [s]: three times their usual distance."""
        return 3.0 * float(np.median(np.diff(self.times))) if len(self.times) > 1 else 0.0

    def at(self, time: float) -> float | None:
        """Reading at a time, linear between two samples; None in a gap, and outside the recording."""
        times = self.times
        if not times[0] <= time <= times[-1]:
            return None
        after = int(np.searchsorted(times, time, side="left"))
        before = after if times[after] == time else after - 1
        if times[after] - times[before] > self.gap:
            return None
        return float(np.interp(time, times, self.values))


@dataclass(frozen=True)
class Point:
    """A recorded point: a marker, or the middle of a link.

    Args:
        kind: `marker` or `link`.
        number: Which one, from 1.
        axes: Its x, y and z; None where a coordinate was not measured: it is taken from the run.
    """

    kind: str
    number: int
    axes: tuple[Track | None, Track | None, Track | None]


@dataclass(frozen=True)
class Marks:
    """What a recording adds to the picture.

    Args:
        title: Of the recording.
        points: Recorded points.
        curves: Recorded channels that a run has a plot of.
        notes: Channels that cannot be shown.
    """

    title: str
    points: tuple[Point, ...]
    curves: tuple[Curve, ...] = ()
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Finding:
    """Where and when a finding of a diagnosis sits.

    Args:
        text: Statement, in words.
        place: Place, in words.
        links: Links concerned, from 0; empty where the finding is not at any link.
        coils: Coils concerned, from 0; empty where it is about whole links.
        intervals: Times in which it shows [s].
        is_accepted: Whether the diagnosis accepts it.
    """

    text: str
    place: str
    links: tuple[int, ...]
    coils: tuple[int, ...]
    intervals: tuple[tuple[float, float], ...]
    is_accepted: bool


@dataclass(frozen=True)
class Film:
    """All that one player shows.

    Args:
        fabrics: The first in colours, the others as ghosts.
        marks: Recordings.
        findings: Of a diagnosis.
        notes: Beside those of the parts.
    """

    fabrics: tuple[Fabric, ...]
    marks: tuple[Marks, ...] = ()
    findings: tuple[Finding, ...] = ()
    notes: tuple[str, ...] = field(default=())

    @property
    def fabric(self) -> Fabric:
        """The one in colours."""
        return self.fabrics[0]

    def all_notes(self) -> list[str]:
        """Every note, with the title of its part where there are several."""
        parts: list[Fabric | Marks] = [*self.fabrics, *self.marks]
        told = [f"{p.title}: {n}" if len(parts) > 1 else n for p in parts for n in p.notes]
        return [*told, *self.notes]
