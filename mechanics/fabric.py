"""Geometry of an active chainmail fabric: which links there are, where they start, what is tethered. No engine here."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from cosim.unit.protocol import Array
from mechanics.added import NO_EFFECTS, AddedEffects, OutOfRange
from mechanics.lattice import Weave, jammed_weave, taut_weave

#: Clearance of every hook in the woven start [m]: well above rounding, small against the tolerance.
CLEARANCE = 2e-5


@dataclass(frozen=True)
class FabricDesign:
    """A European 4-in-1 fabric of equal links, each two halves on a slide with two spring-loaded arms.

    Columns m give m links "A" and m - 1 links "B" in each row, as the paper counts its resolution: 2 x 6 has 18
    links, 2 x 8 has 24.

    Args:
        rows: Number of rows along y.
        columns: Number of A links in a row along x.
        bar_diameter: d, thickness of bars and arms [m].
        tolerance: tol, free play across the fabric [m].
        steel_stiffness: k_s of the compression spring of each arm [N/m].
        steel_rest_length: b, unloaded length of that spring [m].
        tether_rows: Number of tethered rows, counted from y = 0.
        tether_kind: "cantilever": all links of these rows are held flat at the hot pitch. "hanging": the upper
            halves of their A links are held; what hangs below is free.
        width: w, outer width of a link [m]; None takes the paper's w = 4 d + tol.
        length_cold: l at the outer stop, coil between its pins [m].
        length_hot: l at the inner stop [m].
        length_offset: Bar distance L less l [m].
        link_mass: Mass of a link [kg].
        friction: Coefficient of friction between links.
        restitution: Coefficient of restitution between links.
        gravity: Acceleration vector [m/s^2].
        tether_play: Gap between neighbouring bars of one layer in held rows [m].
        start_speed: Free links start with random speeds of up to this along every axis [m/s].
        start_number: Which random start; each has its own.
        added: Effects that a plain fabric leaves out.

    Raises:
        ValueError: A number is out of range or the fabric cannot be woven; names the field, its value and a remedy.

    Source: paper, sections 2.1, 2.2 and 2.4; docs/decisions/0003-reading-of-l-and-d.md.
    """

    rows: int
    columns: int
    bar_diameter: float
    tolerance: float
    steel_stiffness: float
    steel_rest_length: float
    tether_rows: int
    tether_kind: Literal["cantilever", "hanging"]
    width: float | None = None
    length_cold: float = 0.033
    length_hot: float = 0.030
    length_offset: float = 0.0
    link_mass: float = 7.3e-3
    friction: float = 0.73
    restitution: float = 0.0
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)
    tether_play: float = 1e-4
    start_speed: float = 0.0
    start_number: int = 0
    added: AddedEffects = NO_EFFECTS

    def __post_init__(self) -> None:
        self._check_numbers()
        self._check_links()
        self._check_weave()

    def _check_links(self) -> None:
        numbers = [link for link, _ in self.added.links]
        for link in numbers:
            if not 0 <= link < self.links or numbers.count(link) > 1:
                raise ValueError(f"link {link + 1}: the fabric has links 1 to {self.links}, each at most once")

    def _check_numbers(self) -> None:
        for name in ("bar_diameter", "tolerance", "length_cold", "length_hot", "link_mass", "steel_rest_length"):
            _require(name, getattr(self, name), getattr(self, name) > 0, "give a positive number")
        for name in ("steel_stiffness", "friction", "tether_play", "start_speed", "start_number"):
            _require(name, getattr(self, name), getattr(self, name) >= 0, "give zero or a positive number")
        _require("restitution", self.restitution, 0 <= self.restitution <= 1, "give a number from 0 to 1")
        is_possible = self.pair_friction > 0 or self.added.hinge_friction == 0
        _require("hinge_friction", self.added.hinge_friction, is_possible, "it needs a friction above 0")
        _require("length_offset", self.length_offset, self.length_hot + self.length_offset > 0, "make it larger")
        if len(self.gravity) != 3 or not all(map(math.isfinite, self.gravity)):
            raise ValueError(f"gravity is {self.gravity}: give three finite accelerations (x, y, z) in m/s^2")
        for name, least in (("rows", 3), ("columns", 1), ("tether_rows", 0)):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or value < least:
                raise OutOfRange(name, value, f"give a whole number, at least {least}")
        if self.tether_rows >= self.rows:
            raise OutOfRange("tether_rows", self.tether_rows, f"leave at least one of the {self.rows} rows free")
        if self.tether_kind not in ("cantilever", "hanging"):
            raise ValueError(f"tether_kind is {self.tether_kind!r}: give 'cantilever' or 'hanging'")
        if self.columns == 1:
            raise OutOfRange("columns", 1, "links of one column hook into nothing; give at least 2")

    def _check_weave(self) -> None:
        if self.length_hot >= self.length_cold:
            raise ValueError(
                f"length_hot is {self.length_hot} m, not below length_cold {self.length_cold} m: heat contracts links"
            )
        if self.width is not None and not self.width >= 4 * self.bar_diameter:
            raise ValueError(
                f"width is {self.width} m, below 4 d = {4 * self.bar_diameter:.6g} m: the fabric cannot be woven, as a "
                "link must hold two arms of its neighbours between its own; widen it or make the bars thinner"
            )
        if self.outer_width <= 4 * self.bar_diameter:
            raise ValueError("width equals 4 d exactly, which leaves no play: add a tolerance of some tenths of a mm")
        try:
            taut_weave(self.bar_distance_cold, self.bar_diameter)
        except ValueError as error:
            raise ValueError(
                f"the fabric cannot be woven: {error}; reduce bar_diameter {self.bar_diameter} m or lengthen "
                f"length_cold {self.length_cold} m"
            ) from error

    @property
    def outer_width(self) -> float:
        """w [m]; the paper's 4 d + tol unless given."""
        return 4 * self.bar_diameter + self.tolerance if self.width is None else self.width

    @property
    def pair_friction(self) -> float:
        """Coefficient of friction of two links in contact."""
        return self.friction + self.added.added_friction

    @property
    def bar_distance_cold(self) -> float:
        """L at the outer stop [m]."""
        return self.length_cold + self.length_offset

    @property
    def bar_distance_hot(self) -> float:
        """L at the inner stop [m]."""
        return self.length_hot + self.length_offset

    @property
    def column_pitch(self) -> float:
        """Distance of neighbouring A links along x [m]: shares the play equally over the three gaps inside a link."""
        return self.outer_width + (self.outer_width - 4 * self.bar_diameter) / 3

    @property
    def links_per_row(self) -> int:
        """m links A and m - 1 links B."""
        return 2 * self.columns - 1

    @property
    def links(self) -> int:
        """Number of links."""
        return self.rows * self.links_per_row

    @property
    def cold_weave(self) -> Weave:
        """Taut weave with every link at its outer stop."""
        return taut_weave(self.bar_distance_cold, self.bar_diameter)

    @property
    def held_weave(self) -> Weave:
        """Weave of held rows: the jammed one, with some play between neighbouring bars of a layer.

        The slack between them is 2 L cos(theta) - 3 d / sin(theta) - d; a clearance c at each hook takes 3 c from it.
        Without play the first free row sits in a wedge, and friction makes hundreds of newtons of some springs.
        """
        jam = jammed_weave(self.bar_diameter)
        distance = jam.bar_distance + (self.tether_play + 3 * CLEARANCE) / (2 * math.cos(jam.tilt))
        pitch = 2 * (distance * math.cos(jam.tilt) - self.bar_diameter / math.sin(jam.tilt))
        return Weave(distance, jam.tilt, pitch)


def _require(name: str, value: float, holds: bool, remedy: str) -> None:
    if not (math.isfinite(value) and holds):
        raise OutOfRange(name, value, remedy)


@dataclass(frozen=True)
class Layout:
    """The woven start of a fabric; links row by row, inside a row along x.

    Args:
        row: Shape (link,), row of every link.
        link_in_row: Shape (link,), place along x.
        is_b: Shape (link,), True for B links.
        back_bar: Shape (link, 3), centre of the bar nearer the tether [m].
        tilt: Shape (link,), angle of the link's plane above +y [rad].
        bar_distance: Shape (link,), L at the start [m].
        is_fixed: Shape (link,), whether the back half is held.
        is_locked: Shape (link,), whether the slide is held too.
        hooked: Shape (pair, 2), links that pass through each other.
    """

    row: npt.NDArray[np.int64]
    link_in_row: npt.NDArray[np.int64]
    is_b: npt.NDArray[np.bool_]
    back_bar: Array
    tilt: Array
    bar_distance: Array
    is_fixed: npt.NDArray[np.bool_]
    is_locked: npt.NDArray[np.bool_]
    hooked: npt.NDArray[np.int64]


def layout(design: FabricDesign) -> Layout:
    """Woven flat: held rows at the hot pitch, the others just inside the taut cold pitch, nothing overlapping."""
    per_row, links = design.links_per_row, design.links
    row, place = np.divmod(np.arange(links), per_row)
    is_b = place % 2 == 1
    y, z, tilt, distance = _side_view(design)
    chain = 2 * row + is_b
    back = np.empty((links, 3))
    back[:, 0] = (place - (per_row - 1) / 2) * design.column_pitch / 2
    back[:, 1], back[:, 2] = y[chain], z[chain]
    tethered = row < design.tether_rows
    cantilever = design.tether_kind == "cantilever"
    return Layout(
        row=row,
        link_in_row=place,
        is_b=is_b,
        back_bar=back,
        tilt=tilt[chain],
        bar_distance=distance[chain],
        is_fixed=tethered & (cantilever | ~is_b),
        is_locked=tethered & cantilever,
        hooked=_hooked(links, per_row),
    )


def _hooked(links: int, per_row: int) -> npt.NDArray[np.int64]:
    """Each B link (odd places) with the A links beside it, of its own row and of the next; shape (pair, 2)."""
    own = np.arange(links)[np.arange(links) % per_row % 2 == 1]
    ahead, aside = np.array([0, 0, 1, 1]), np.array([-1, 1, -1, 1])
    row, place = own[:, None] // per_row + ahead, own[:, None] % per_row + aside
    is_there = (place >= 0) & (place < per_row) & (row * per_row < links)
    pairs = np.stack([np.broadcast_to(own[:, None], row.shape), row * per_row + place], axis=2)
    return np.asarray(pairs[is_there])


def _side_view(design: FabricDesign) -> tuple[Array, Array, Array, Array]:
    """Chain A1, B1, A2, B2, ... seen along x: y, z of the back bars, tilt, bar distance; each of shape (2 rows,)."""
    held = 2 * design.tether_rows if design.tether_kind == "cantilever" else 0
    tight, cold = design.held_weave, design.cold_weave
    weaves = [tight if s < held else cold for s in range(2 * design.rows)]
    if held:
        # A flatter link would need a longer hook than the jammed rows behind it leave room for.
        weaves[held] = Weave(cold.bar_distance, tight.tilt, cold.pitch)
    y, z = np.zeros(len(weaves)), np.zeros(len(weaves))
    for s in range(1, len(weaves)):
        before, weave = weaves[s - 1], weaves[s]
        hook = design.bar_diameter / math.sin(min(before.tilt, weave.tilt)) + CLEARANCE
        y[s] = y[s - 1] + before.bar_distance * math.cos(before.tilt) - hook
        # A links rise and B links fall, so that hooked bars share a level.
        z[s] = z[s - 1] + (1 if s % 2 else -1) * before.bar_distance * math.sin(before.tilt)
    sign = np.where(np.arange(len(weaves)) % 2, -1.0, 1.0)
    tilt = sign * np.array([w.tilt for w in weaves])
    return y, z, tilt, np.array([w.bar_distance for w in weaves])
