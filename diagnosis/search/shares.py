"""What a rig shares and what a day has: where a recording doubts a number, two parameters stand for one doubt.

A thermometer of the room that reads 0.4 K too high does so every day; how warm the draught at the window is, is another
number each day. A deviation s that is stated for a number x is the deviation of the sum of both: x = nominal + shared +
own, with variances that add to s^2. The shared part is learned from all recordings and holds for those held out; the
own part is known of no other day. Without knowledge of their ratio both have half of the variance (the principle of
insufficient reason). With a single recording the two cannot be told apart: the posterior mean puts half of what was
found into each, so that half of it is expected on another day. With n recordings that agree the shared part has the
share 1 / (1 + 1/n) of it: 1/2, 2/3, 3/4, ... (one-way random effects; A. Gelman et al., Bayesian Data Analysis, 3rd
ed. 2013, section 5.4).
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

from cosim.unit.protocol import Array

#: Stands in the name of every parameter that belongs to some recordings alone.
OWN = " of recording "
#: Stands in the name of those that belong to a day that has a name; recordings held out may be of the same day.
DAY = " of recording day "
#: Largest doubt about a temperature at the start that can be the rig's [K]; beyond it the start is what is not known.
#: It is the doubt that is taken where none is stated: a thermometer of the rig and the room, not a start by hand.
RIG_START = 0.3


def own_label(name: str, number: int, day: str = "") -> str:
    """Name of a parameter that belongs to one recording, or to all of one day.

    Args:
        name: Of the number.
        number: Of the recording, from 0.
        day: Name of the day; empty: the recording's own.
    """
    return f"{name}{DAY}{day}" if day else f"{name}{OWN}{number + 1}"


def of_title(name: str, titles: Sequence[str]) -> str:
    """A parameter of one recording, with the recording's title in the place of its number.

    >>> of_title("initial_temperature of recording 2", ("monday", "tuesday")), of_title("capacity", ("monday",))
    ('initial_temperature of recording tuesday', 'capacity')
    """
    field, own, number = name.partition(OWN)
    if not own or DAY in name or not number.isdigit() or int(number) > len(titles):
        return name
    return f"{field}{OWN}{titles[int(number) - 1]}"


def is_own(name: str) -> bool:
    """Whether a parameter belongs to some recordings alone, by its name."""
    return OWN in name


def is_carried(name: str) -> bool:
    """Whether a parameter means the same in another model of the rig: it is shared, or belongs to a day with a name."""
    return not is_own(name) or DAY in name


def shared_deviation(stated: Collection[float], most: float = math.inf) -> float:
    """Standard deviation of what all recordings share, from those that they state: half of the least variance.

    Args:
        stated: Deviation that each recording states; none of them is smaller than what it shares.
        most: Largest deviation that can be the rig's.
    """
    return min(most, *stated) / math.sqrt(2.0)


def own_deviation(stated: float, shared: float) -> float:
    """Standard deviation of what is left to a recording: the variances add to the one that it states."""
    return math.sqrt(stated**2 - shared**2)


def departures(names: Sequence[str], deviations: Array, z: Array) -> dict[str, tuple[float, float]]:
    """How far numbers are from their nominal values: what is shared and what is a recording's own taken together.

    Args:
        names: Of all parameters.
        deviations: Their prior deviations, shape (parameters,).
        z: Their distances in these, shape (parameters,).

    Returns:
        Name to the amount, and the amount in deviations of the sum; what is shared stands in the sums alone.
    """
    known = dict(zip(names, zip((deviations * z).tolist(), deviations.tolist())))
    parts = {name: name.split(OWN)[0] for name in names if is_own(name) and name.split(OWN)[0] in known}
    found = {}
    for name, (amount, deviation) in known.items():
        if name in parts.values():
            continue
        more, doubt = known[parts[name]] if name in parts else (0.0, 0.0)
        found[name] = amount + more, (amount + more) / math.hypot(deviation, doubt)
    return found
