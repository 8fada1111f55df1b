"""How large an effect of a real rig can be, and the sizes that a search tries first: one rule for all candidates.

A size is believed up to `plausible`, by physics that each file states. Many such limits are multiples of what the rig
itself has: friction is compared with the load, play with the stretch, a second mass with the coil's own capacity.

The sizes that are tried follow from that limit alone:

- a ladder: the range from the size that is no finding (or 1 % of the limit, or the lower bound) to the limit is divided
  into parts that are equal by ratio, and the middle of each is tried: no size is farther from a tried one than another;
- places and thresholds, for which 0 is no smallest size: the middles of equal parts of the range, and where either
  sign is possible 0 and half the limit to each side.
"""

from __future__ import annotations

from collections.abc import Mapping

#: Sizes tried of an effect that has one sign, and of each sign of one that may have either.
ONE_SIGN, EITHER_SIGN = 3, 2
#: Share of the limit at which a ladder begins where nothing says below which size it is no finding.
SMALLEST = 0.01
#: What limits may be multiples of: value of the paper's coil under 0.1 kg
#: (`diagnosis.models.coil_network.kernel.layout.COIL_FIELDS`), and the same in words. A rig's own values take their
#: place.
_CONDUCTANCE, _CAPACITY, _STIFFNESS, _LOAD = 90.0 * 97.85e-6, 6450.0 * 7.328e-9 * 837.0, 157.1, 0.1 * 9.80665
SCALES: Mapping[str, tuple[float, str]] = {
    "conductance": (_CONDUCTANCE, "the coil's h A"),
    "capacity": (_CAPACITY, "the coil's heat capacity"),
    "time": (_CAPACITY / _CONDUCTANCE, "the coil's thermal time constant"),
    "rate": (_CONDUCTANCE / _CAPACITY * 30.0, "the rate that warms the coil by 30 K in its thermal time constant"),
    "heat": (_CONDUCTANCE * 30.0, "what the coil loses at 30 K above its surroundings"),
    "resistance": (2.2, "the coil's resistance"),
    "load": (_LOAD, "the load"),
    "per_load": (1.0 / _LOAD, "1 / load"),
    "stiffness": (_STIFFNESS, "the cold coil's stiffness"),
    "compliance": (1.0 / _STIFFNESS, "the cold coil's compliance"),
    "stretch": (_LOAD / _STIFFNESS, "the cold coil's stretch under its load"),
}


def ladder(least: float, most: float, count: int) -> tuple[float, ...]:
    """Middles of `count` parts of a range that are equal by ratio, to three digits.

    >>> ladder(0.01, 1.0, 2)
    (0.0316, 0.316)
    """
    return tuple(_rounded(least * (most / least) ** ((n + 0.5) / count)) for n in range(count))


def sizes(most: float, least: float = 0.0, count: int = ONE_SIGN) -> tuple[float, ...]:
    """Sizes tried of an effect of one sign.

    Args:
        most: Largest size that is believed.
        least: Size below which it is no finding; 0: `SMALLEST` of the largest.
        count: How many.
    """
    return ladder(least or SMALLEST * most, most, count)


def signed_sizes(most: float, least: float = 0.0, count: int = EITHER_SIGN) -> tuple[float, ...]:
    """The same of an effect that may have either sign: each size with both, the smallest first."""
    return tuple(sign * size for size in sizes(most, least, count) for sign in (1.0, -1.0))


def places(most: float, count: int = ONE_SIGN, origin: float = 0.0, is_signed: bool = False) -> tuple[float, ...]:
    """Where a threshold or a place is tried.

    Args:
        most: Largest distance from the origin that is believed.
        count: How many; three where it may lie on either side.
        origin: Where it is counted from.
        is_signed: Whether it may lie on either side.

    >>> places(6.0), places(6.0, is_signed=True)
    ((1.0, 3.0, 5.0), (0.0, 3.0, -3.0))
    """
    if is_signed:
        return tuple(origin + _rounded(share * most) for share in (0.0, 0.5, -0.5))
    return tuple(origin + _rounded(most * (n + 0.5) / count) for n in range(count))


def scale_of(name: str, scales: Mapping[str, float] | None = None) -> float:
    """What a limit is a multiple of.

    Args:
        name: Name in `SCALES`; empty for a limit that is a number by itself.
        scales: Values of a rig; what is missing or not positive there is that of the paper's coil.
    """
    if not name:
        return 1.0
    own = (scales or {}).get(name, 0.0)
    return own if 0.0 < own < float("inf") else SCALES[name][0]


def _rounded(value: float) -> float:
    return float(f"{value:.3g}")
