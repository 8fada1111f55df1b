"""How far a weave bends, by closed form: the slack of its bars against the distance of their two layers.

Bars of one layer lie r and p - r apart in turn (docs/mechanics.md); in a taut weave the second gap has the slack
p - r - d. A weave bends until that slack is used up in its lower layer while the upper one stays taut, over the
distance of the two layers, L sin(theta), once in a pitch. Real drapes bend more or less than that by a factor that is
fitted to one cold run (`fitted_scale`); hot links bend as far as the same form lets them, and not at all in the jam.
Arithmetic only: it screens geometries, and judges none.
"""

from __future__ import annotations

import math

from mechanics.lattice import jammed_weave, taut_jam_ratio, taut_weave


def slack_curvature(bar_distance: float, bar_diameter: float) -> float:
    """Curvature that the slack of a taut weave allows [1/m]; 0 where the weave is as tight as the jam.

    Args:
        bar_distance: L [m].
        bar_diameter: d [m].

    >>> round(slack_curvature(0.03385, 0.00835), 1), slack_curvature(0.030, 0.00835)
    (7.2, 0.0)
    """
    if bar_distance <= taut_jam_ratio() * bar_diameter:
        return 0.0
    weave = taut_weave(bar_distance, bar_diameter)
    overlap = bar_diameter / math.sin(weave.tilt)
    slack = weave.pitch - overlap - bar_diameter
    return slack / (weave.pitch * bar_distance * math.sin(weave.tilt))


def jam_distance(bar_diameter: float) -> float:
    """L at which a fabric of such bars is jammed, 3.69 d [m].

    >>> round(jam_distance(0.00835), 5)
    0.03081
    """
    return jammed_weave(bar_diameter).bar_distance


def thickest_bar(bar_distance: float, curvature: float, scale: float, low: float, high: float) -> float:
    """Thickest bar with which links still bend by a curvature when cold, between two ends [m].

    Args:
        bar_distance: L of cold links [m].
        curvature: Wanted [1/m].
        scale: Of the closed form, as fitted to a run.
        low: Thinnest bar [m]; it is returned where no bar bends so far.
        high: Thickest bar [m].
    """
    for _ in range(60):
        if scale * slack_curvature(bar_distance, high) >= curvature:
            return high
        middle = 0.5 * (low + high)
        if scale * slack_curvature(bar_distance, middle) >= curvature:
            low = middle
        else:
            high = middle
        if high - low < 1e-7:
            break
    return low
