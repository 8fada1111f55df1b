"""Plane geometry of the weave: taut pitch, jammed lattice, and the calibration of what the paper leaves open.

Side view (y along the fabric, z up). Consecutive links tilt by +theta and -theta; each hooks its back bar behind the
front bar of the link before it. With d the thickness of bars and arms and L the distance of a link's two bars:

* hook overlap rx = L cos(theta) - p / 2, where p is the pitch (two links further the pattern repeats);
* a bar rests on its neighbour's arms: rx sin(theta) >= d, equality when taut;
* bars of one layer are apart by rx and p - rx in turn, so p - rx >= d.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from mechanics.root import root_between


@dataclass(frozen=True)
class Weave:
    """A flat periodic weave.

    Args:
        bar_distance: L, centre to centre [m].
        tilt: theta [rad].
        pitch: p, one row [m].
    """

    bar_distance: float
    tilt: float
    pitch: float


def taut_weave(bar_distance: float, bar_diameter: float) -> Weave:
    """Longest flat weave: p = 2 (L cos(theta) - d / sin(theta)) at its maximum, sin^3(theta) / cos(theta) = d / L.

    Args:
        bar_distance: L [m].
        bar_diameter: d [m].

    Raises:
        ValueError: The links are too short to interlock in a taut weave.

    Source: plane geometry, docs/decisions/0003-reading-of-l-and-d.md.

    >>> round(100 * taut_weave(0.033, 0.0081).pitch, 2)
    2.58
    """
    if not 0 < bar_diameter < bar_distance:
        raise ValueError(f"bar_diameter {bar_diameter} m must lie between 0 and the bar distance {bar_distance} m")
    ratio = bar_diameter / bar_distance
    tilt = root_between(lambda t: math.sin(t) ** 3 - ratio * math.cos(t), 1e-6, math.pi / 2 - 1e-6, 1e-14)
    pitch = 2 * (bar_distance * math.cos(tilt) - bar_diameter / math.sin(tilt))
    if pitch < bar_diameter / math.sin(tilt) + bar_diameter - 1e-12:
        raise ValueError(
            f"bars of {bar_diameter} m do not fit into links of bar distance {bar_distance} m: the taut weave would "
            f"overlap; at least {taut_jam_ratio() * bar_diameter:.4g} m is needed"
        )
    return Weave(bar_distance, tilt, pitch)


def taut_jam_ratio() -> float:
    """Smallest L / d of a taut weave whose bars do not overlap: s^3 + 5 s^2 = 2 with s = sin(theta), about 3.76."""
    s = root_between(lambda x: x**3 + 5 * x**2 - 2, 0.0, 1.0, 1e-14)
    return math.sqrt(1 - s * s) / s**3


def jammed_weave(bar_diameter: float) -> Weave:
    """Shortest possible weave: both conditions are equalities and no slack is left.

    The slack 2 (L cos - d / sin) - 2/3 (L cos + d) vanishes at L = d (1 + 3 / sin) / (2 cos), whose minimum over
    theta (3 cos^2 = sin^2 (sin + 3)) is L = 3.69 d.

    Args:
        bar_diameter: d [m].

    >>> jam = jammed_weave(1.0)
    >>> round(jam.bar_distance, 2), round(jam.pitch, 2)
    (3.69, 2.49)
    """
    tilt = root_between(lambda t: math.sin(t) ** 2 * (math.sin(t) + 3) - 3 * math.cos(t) ** 2, 0.1, 1.5, 1e-14)
    distance = bar_diameter * (1 + 3 / math.sin(tilt)) / (2 * math.cos(tilt))
    return Weave(distance, tilt, 2 * (distance * math.cos(tilt) - bar_diameter / math.sin(tilt)))


@dataclass(frozen=True)
class Calibration:
    """Geometry that reproduces two published pitches.

    Args:
        bar_diameter: d [m].
        length_offset: Bar distance L less the published link length l [m].
    """

    bar_diameter: float
    length_offset: float


def calibrate(pitch_cold: float, pitch_hot: float, length_cold: float) -> Calibration:
    """Bar diameter whose jammed pitch is the hot one, and the offset whose taut pitch is the cold one.

    Args:
        pitch_cold: Published cold pitch [m]; 13.2 cm over five pitches.
        pitch_hot: Published hot pitch [m]; 11.5 cm over five pitches.
        length_cold: Published cold link length l [m].

    Source: docs/decisions/0003-reading-of-l-and-d.md.
    """
    diameter = pitch_hot / jammed_weave(1.0).pitch
    shortest = taut_jam_ratio() * diameter * (1 + 1e-9)
    if taut_weave(shortest, diameter).pitch > pitch_cold:
        raise ValueError(f"cold pitch {pitch_cold} m is too close to the hot pitch {pitch_hot} m for a jammed lattice")
    distance = root_between(lambda L: taut_weave(L, diameter).pitch - pitch_cold, shortest, 10 * diameter, 1e-12)
    return Calibration(diameter, distance - length_cold)
