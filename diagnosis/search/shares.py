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
from diagnosis.search.problem import Own, Parameter

#: Largest doubt about a temperature at the start that can be the rig's [K]; beyond it the start is what is not known.
#: It is the doubt that is taken where none is stated: a thermometer of the rig and the room, not a start by hand.
RIG_START = 0.3


def own_label(own: Own) -> str:
    """Name of a parameter that belongs to one recording, or to all of one day."""
    return f"{own.number} of recording day {own.day}" if own.day else _of_recording(own.number, str(own.recording + 1))


def titled(parameter: Parameter, titles: Sequence[str]) -> str:
    """Name of a parameter, with the title of its recording in the place of the number.

    Args:
        parameter: Any.
        titles: Of the recordings of its model, in their order; those that are missing keep their numbers.
    """
    own = parameter.own
    if own is None or own.day or own.recording >= len(titles):
        return parameter.name
    return _of_recording(own.number, titles[own.recording])


def _of_recording(number: str, recording: str) -> str:
    return f"{number} of recording {recording}"


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


def departures(parameters: Sequence[Parameter], z: Array) -> dict[str, tuple[float, float]]:
    """How far numbers are from their nominal values: what is shared and what is a recording's own taken together.

    Args:
        parameters: All of a model.
        z: Their distances in their prior deviations, shape (parameters,).

    Returns:
        Name to the amount, and the amount in deviations of the sum; what is shared stands in the sums alone.
    """
    known = {p.name: (p.deviation * float(far), p.deviation) for p, far in zip(parameters, z)}
    parts = {p.name: p.own.number for p in parameters if p.own is not None and p.own.number in known}
    found = {}
    for name, (amount, deviation) in known.items():
        if name in parts.values():
            continue
        more, doubt = known[parts[name]] if name in parts else (0.0, 0.0)
        found[name] = amount + more, (amount + more) / math.hypot(deviation, doubt)
    return found
