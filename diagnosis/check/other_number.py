"""A recording that stands out, and which one number of the rig would have to be another in it alone.

Another fill, another load, another part: where the scenario meets the other recordings and not this one, each number
of its FMUs is moved in this recording alone. What then explains every channel as well as the others are explained is
what to look at first. One channel proves nothing: some number gives it nearly any course.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.errors import InputError
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.factors import best_logarithm
from diagnosis.check.input_runs import is_quick, left_by
from diagnosis.check.odd_one_out import as_explained, comparable, in_words, is_within, left_beside, scaled_left
from diagnosis.check.timing import percent
from diagnosis.judge.diagnosis import Doubt
from diagnosis.models.coil_network.kernel.compiler import CompilerError
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.run import SystemRuns

#: Channels that have to be explained.
CHANNELS = 2
#: Factors between which a number may be another.
FARTHEST = 10.0
#: Factors that are tried first, on either side; between the neighbours of the best one the number is found.
FACTORS = (1.1, 1.5, 3.0, FARTHEST)
_TRIED = sorted([0.0, *(sign * math.log(f) for f in FACTORS for sign in (-1.0, 1.0))])
#: Sizes of a number that is stated as 0, in its own unit, that are tried first, on either side.
_SIZES = [math.log(10.0) * n for n in range(-9, 10)]
#: Numbers that explain a recording beyond which they say nothing.
MOST = 3


@dataclass(frozen=True)
class _Explained:
    """A number with which a recording is explained: its name, unit, stated and other value, what is left at most."""

    name: str
    unit: str
    stated: float
    value: float
    left: float


def other_number(one: Compared, others: Sequence[Compared]) -> Doubt | None:
    """A doubt about a number that is another in one recording; None where none, or too many, explain it.

    It is serious where the recording moves within what the others move within: a law that acts at large values, or in
    fast motion, may act in one recording alone.

    Args:
        one: A recording that stands out (`diagnosis.check.odd_one_out`).
        others: The other recordings of the same rig, which the scenario meets.
    """
    channels = comparable(one)
    if not is_quick(one.scenario) or len(channels) < CHANNELS:
        return None
    before, theirs = left_beside(one, others, scaled_left)
    enough = as_explained(theirs)
    if before <= enough:
        return None
    try:
        with closing(SystemRuns(one.scenario)) as system:
            found = [f for f in _each(system, one, channels) if f.left <= enough]
    except (InputError, NotFast, CompilerError):
        return None
    if not 0 < len(found) <= MOST:
        return None
    return replace(_doubt(one, found, before, theirs), is_serious=is_within(one, others))


def _each(system: SystemRuns, one: Compared, channels: dict[str, Beside]) -> list[_Explained]:
    """Every number with the value that explains the recording best."""
    found = []
    for number in system.numbers():
        stated = number[-1]
        sides = [(_TRIED, stated)] if stated != 0.0 else [(_SIZES, 1.0), (_SIZES, -1.0)]
        found.append(min((_best(system, one, channels, number, *side) for side in sides), key=lambda f: f.left))
    return found


def _best(
    system: SystemRuns,
    one: Compared,
    channels: dict[str, Beside],
    number: tuple[str, str, str, float],
    tried: Sequence[float],
    scale: float,
) -> _Explained:
    """The value with which a number explains the recording best.

    Args:
        system: Of the recording.
        one: The recording.
        channels: Its channels that are compared, by name.
        number: Component, name, unit and stated value.
        tried: Logarithms of factors that are tried first, rising.
        scale: Which the factors multiply: its sign stays.
    """
    component, name, unit, stated = number

    def cost(logarithm: float) -> float:
        return left_by(system.with_number(component, name, scale * math.exp(logarithm)), channels, one)

    logarithm, left = best_logarithm(cost, tried)
    return _Explained(f"{component}.{name}", unit, stated, scale * math.exp(logarithm), left)


def _doubt(one: Compared, found: Sequence[_Explained], before: float, theirs: float) -> Doubt:
    values = " or ".join(
        f"{f.name} = {f.value:.4g} {'' if f.unit == '1' else f.unit}".rstrip() + f" ({f.stated:.4g} is stated)"
        for f in sorted(found, key=lambda f: f.left)
    )
    worst = max(f.left for f in found)
    text = (
        f"{in_words(before, theirs)}; "
        f"with {values} in this recording alone it is at least {percent(1.0 - worst)} here too"
    )
    remedy = (
        "was it so? State it under `overrides` of this recording, or how far it is unknown under `uncertain`; a law "
        "that only this recording reaches may look alike"
    )
    z = float(np.sqrt(before / max(worst, 1e-12)))
    return Doubt(one.recording.title, found[0].name, "number", text, remedy, True, one.begin, one.end, z)
