"""Where the links of a woven cantilever begin, from the paper's measures alone."""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq, minimize_scalar

#: Room that every hook is given at the start [m].
CLEARANCE = 2e-5


@dataclass(frozen=True)
class Measures:
    """Of one link and of the fabric it is woven into, lengths in m.

    Args:
        bar: Thickness of bars and arms.
        play: Free play across the fabric.
        cold: Distance of a link's bars at its outer stop.
        stroke: What a link can shorten by.
        tether_play: Gap between the bars of held rows.
    """

    bar: float = 8.35e-3
    play: float = 1.0e-3
    cold: float = 33.85e-3
    stroke: float = 3.0e-3
    tether_play: float = 1e-4

    @property
    def width(self) -> float:
        """Outer width of a link [m]."""
        return 4.0 * self.bar + self.play


@dataclass(frozen=True)
class Link:
    """A link at the start.

    Args:
        row: From 0 at the tether.
        place: From 0 along x.
        back: Centre of the bar nearer the tether [m].
        tilt: Angle above the y axis [rad].
        distance: Of its bars [m].
        is_held: Whether it is part of the tether.
    """

    row: int
    place: int
    back: tuple[float, float, float]
    tilt: float
    distance: float
    is_held: bool


def taut_angle(measures: Measures) -> float:
    """Lean of links that are pulled tight [rad]: the pitch 2 (L cos a - d / sin a) is longest there."""
    ratio = measures.bar / measures.cold
    return float(brentq(lambda a: math.sin(a) ** 3 - ratio * math.cos(a), 0.1, 1.4))


def jam(measures: Measures) -> tuple[float, float]:
    """Lean [rad] and distance of the bars [m] of held rows: links as short as can be woven, and the play."""

    def shortest(angle: float) -> float:
        return measures.bar * (1.0 + 3.0 / math.sin(angle)) / (2.0 * math.cos(angle))

    angle = float(minimize_scalar(shortest, bounds=(0.2, 1.2), method="bounded", options={"xatol": 1e-12}).x)
    slack = measures.tether_play + 3.0 * CLEARANCE
    return angle, shortest(angle) + slack / (2.0 * math.cos(angle))


def weave(measures: Measures, rows: int, columns: int, held: int) -> list[Link]:
    """All links, row by row.

    Args:
        measures: Of a link.
        rows: Along y.
        columns: Links that lean upwards in a row; one less lean downwards.
        held: Rows of the tether.
    """
    taut, (jammed, short) = taut_angle(measures), jam(measures)
    chain: list[tuple[float, float, float, float]] = []  # y, z, lean, distance of A, B, A, B ...
    y = z = 0.0
    for number in range(2 * rows):
        is_held = number < 2 * held
        # The first free link cannot lie flatter than the held one that it hangs in.
        lean = jammed if is_held or number == 2 * held else taut
        distance = short if is_held else measures.cold
        if chain:
            _, _, before, reach = chain[-1]
            hook = measures.bar / math.sin(min(abs(before), lean)) + CLEARANCE
            y += reach * math.cos(before) - hook
            z += reach * math.sin(before)
        chain.append((y, z, -lean if number % 2 else lean, distance))
    spacing = (measures.width + measures.play / 3.0) / 2.0
    middle = columns - 1
    links = []
    for row in range(rows):
        for place in range(2 * columns - 1):
            along, up, lean, distance = chain[2 * row + place % 2]
            back = ((place - middle) * spacing, along, up)
            links.append(Link(row, place, back, lean, distance, row < held))
    return links
