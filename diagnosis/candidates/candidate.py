"""What every candidate effect states about itself, and the hooks of a model at which its C lines may act."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from diagnosis.candidates.sizes import EITHER_SIGN, ONE_SIGN, SCALES, SMALLEST, places, scale_of, signed_sizes, sizes

Unit = Literal["electrical", "thermal", "stiffness", "mechanical", "measurement"]
#: Where a candidate can act. `swap`: two channels of one quantity that were mistaken for each other; `powered`: all
#: coils of a network without a circuit, whose power is given; `pair`: two coils that may touch.
PlaceKind = Literal[
    "coil",
    "string",
    "all",
    "powered",
    "row_gradient",
    "column_gradient",
    "column",
    "string_ends",
    "outer_strings",
    "edge",
    "supply",
    "channel",
    "quantity",
    "swap",
    "pair",
]
Axis = Literal["coil", "string", "source", "channel", "pair"]
StateKind = Literal["continuous", "memory", "shared"]
#: `rig`: what sets in lasts, in later recordings too. `day`: it belongs to one day, and other days do not have it.
Scope = Literal["rig", "day"]
Physical = Literal["", "change", "rate", "reading"]

#: Hooks over one axis each, in the order in which a step comes to them.
HOOK_AXES: Mapping[str, Axis] = {
    "resistance": "coil",
    "source": "source",
    "string": "string",
    "supply": "source",
    "pairs": "coil",
    "contacts": "pair",
    "heat": "coil",
    "state": "coil",
    "gather": "coil",
    "shared": "coil",
    "stiffness": "coil",
    "play": "coil",
    "load": "coil",
    "length": "coil",
    "accept": "coil",
    "channel": "channel",
    "sensor": "channel",
}


#: Quantities of which at least one must be measured for a law of a unit to be told from one of another unit.
NEEDS: Mapping[Unit, tuple[str, ...]] = {
    "electrical": ("current", "voltage", "power", "resistance"),
    "thermal": ("temperature",),
    "stiffness": ("stiffness", "extension", "length"),
    "mechanical": ("extension", "length"),
    "measurement": (),
}


@dataclass(frozen=True)
class Parameter:
    """One number of a candidate; in the network an array over the axis of the candidate.

    Args:
        name: As used in the C lines and in the law.
        unit: SI unit.
        lower: Least value.
        upper: Greatest value.
        reason: Why these bounds: sign or passivity.
        starts: Values to start a fit from, smallest effect first. Empty: by the rule of `diagnosis.candidates.sizes`,
            from the limit alone; anything else needs a `starts_reason`.
        is_amplitude: Whether 0 switches the effect off (at that coil, string or channel); the first one, and it alone.
        is_fixed: Given with the place, never fitted (the scale of a channel).
        is_switch: An amplitude that is wholly there (its upper bound) or not at all.
        negligible: Size of an amplitude below which it is no finding: every rig has that much of it.
        plausible: Largest size that a real rig can have: a search may go beyond it, but what is found there is no name
            of an effect. In the parameter's unit, or, with `of`, a multiple of that scale.
        plausible_reason: Why: physics, with source or derivation.
        of: Name of a scale of the rig (`diagnosis.candidates.sizes.SCALES`).
        is_position: A threshold or a place, counted from `origin`: small values are no smaller effect. It may lie on
            either side where its lower bound is negative.
        origin: See there.
        count: How many values are tried; 0: as the rule says.
        starts_reason: Why the values to start from do not follow the rule.
        meaning: What the number is, in words: which physical quantity, or a share, a factor or a change of what.
        physical: Where it is counted in what its channel typically reads: the `change` of a reading, its `rate` per
            minute or a `reading` above the pivot that it stands for. A report shows that, in the channel's unit.
    """

    name: str
    unit: str
    lower: float
    upper: float
    reason: str
    starts: tuple[float, ...] = ()
    is_amplitude: bool = False
    is_fixed: bool = False
    is_switch: bool = False
    negligible: float = 0.0
    plausible: float = math.inf
    plausible_reason: str = ""
    of: str = ""
    is_position: bool = False
    origin: float = 0.0
    count: int = 0
    starts_reason: str = ""
    meaning: str = ""
    physical: Physical = ""

    @property
    def is_instant(self) -> bool:
        """Whether it is an instant, for which start values are to be spread over the recordings."""
        return self.name == "instant"

    def limit(self, scales: Mapping[str, float] | None = None) -> float:
        """Largest size that is believed, within the bounds; infinite where none is stated.

        Args:
            scales: Of a rig; None: of the paper's coil.
        """
        if not math.isfinite(self.plausible):
            return math.inf
        return min(abs(self.origin) + self.plausible * scale_of(self.of, scales), max(abs(self.lower), abs(self.upper)))

    def tried(self, scales: Mapping[str, float] | None = None) -> tuple[float, ...]:
        """Values to start a fit from by the rule, those outside the bounds left out.

        Args:
            scales: Of a rig; None: of the paper's coil.
        """
        if self.starts_reason or self.is_fixed or self.is_instant:
            return self.starts
        if self.is_switch:
            return (self.upper,)
        most = self.limit(scales) - abs(self.origin)
        if self.is_position:
            found = places(most, self.count or ONE_SIGN, self.origin, self.lower < 0.0)
        elif self.lower < 0.0 and self.is_amplitude:
            found = signed_sizes(most, self.negligible, self.count or EITHER_SIGN)
        else:
            found = sizes(most, max(self.negligible or SMALLEST * most, self.lower), self.count or ONE_SIGN)
        return tuple(v for v in found if self.lower <= v <= self.upper)

    def __post_init__(self) -> None:
        if not self.lower < self.upper:
            raise ValueError(f"{self.name}: the bounds {self.lower:g} to {self.upper:g} leave no room")
        if self.of and self.of not in SCALES:
            raise ValueError(f"{self.name}: there is no scale {self.of}")
        outside = [v for v in self.starts if not self.lower <= v <= self.upper]
        if outside:
            raise ValueError(f"{self.name}: start values must be given within its bounds, not {outside}")
        if not (self.is_fixed or self.is_instant) and not (0.0 < self.plausible < math.inf and self.plausible_reason):
            raise ValueError(f"{self.name}: say how large it can be on a real rig, and why")
        if self.is_instant and not self.meaning:
            object.__setattr__(self, "meaning", "when it sets in")
        if not self.starts:
            object.__setattr__(self, "starts", self.tried())
        if not self.starts:
            raise ValueError(f"{self.name}: none of the values that its limit suggests lies within its bounds")


@dataclass(frozen=True)
class State:
    """A state that a candidate adds.

    Args:
        name: As used in the C lines: its value at the middle of the step in `resistance` and `heat`, later
            that at the end; `<name>_begin` is its value at the begin of the step.
        unit: SI unit.
        start: C expression of its value at the start.
        kind: `continuous`: the lines of the hook `state` set `<name>_inflow` and `<name>_rate` of
            d name/dt = inflow - rate * name, which is stepped exactly. `shared`: the same, one for all coils, in the
            hook `shared`; the hook `gather` gives it `gathered` and `weight`, summed over the coils. `memory`: set by
            the lines of any hook, once in each step.
    """

    name: str
    unit: str
    start: str
    kind: StateKind = "continuous"


@dataclass(frozen=True)
class CandidateTerm:
    """An effect that a model may lack.

    Args:
        identifier: Stable name, also of its file.
        name: In plain words.
        unit: Part of the model that it belongs to.
        law: Formula with the names of the parameters; `=` between two expressions of Python's syntax.
        source: Where the law comes from.
        parameters: Its numbers, the amplitude first.
        places: Where it can act.
        lines: Hook to C lines; see docs/candidates.md for the names that a hook offers.
        signature: What it leaves in the residuals.
        confused_with: Identifiers (or `base:<parameter>`) that data often cannot tell from it, with what decides.
        states: States that it adds.
        is_named: False for a generic term, which stands for a law that nobody named.
        is_completing: A generic term that is tried only where all others leave more than noise.
        keeps_sums: A sensor that is linear in the signal of its own channel: a sum passes it as its parts do.
        same_as: A named candidate with the same law: this one is tried only where that is not in the catalogue.
        rank: Terms of a higher rank come later at a hook: latent heat needs the balance of all others.
        needs: Quantities of which at least one must be measured (of any element) for the law to be told from one of
            another unit; None: those of its unit (`NEEDS`).
        fewest: Least number of elements of its axis (coils or heaters, strings, channels): with fewer it has no place.
        scope: Whether what sets in at an instant lasts in later recordings, or belongs to the day in which it sets in;
            of an effect without an instant, whether it may be there on one day alone.
        scope_reason: Why; needed where it has an instant or belongs to a day.
    """

    identifier: str
    name: str
    unit: Unit
    law: str
    source: str
    parameters: tuple[Parameter, ...]
    places: tuple[PlaceKind, ...]
    lines: Mapping[str, str]
    signature: str
    confused_with: Mapping[str, str] = field(default_factory=dict)
    states: tuple[State, ...] = ()
    is_named: bool = True
    is_completing: bool = False
    keeps_sums: bool = False
    same_as: str = ""
    rank: int = 0
    needs: tuple[str, ...] | None = None
    fewest: int = 1
    scope: Scope = "rig"
    scope_reason: str = ""

    def __post_init__(self) -> None:
        if self.needs is None:
            object.__setattr__(self, "needs", NEEDS[self.unit])
        unknown = sorted(set(self.lines) - set(HOOK_AXES))
        if unknown:
            raise ValueError(f"{self.identifier}: there is no hook {unknown[0]}")
        if len({HOOK_AXES[h] for h in self.lines}) != 1:
            raise ValueError(f"{self.identifier}: its hooks lie on different axes; make two candidates")
        if [p.is_amplitude for p in self.parameters] != [True] + [False] * (len(self.parameters) - 1):
            raise ValueError(f"{self.identifier}: its first parameter, and it alone, must be the amplitude")
        if (self.scope == "day" or any(p.is_instant for p in self.parameters)) and not self.scope_reason:
            raise ValueError(f"{self.identifier}: say why it lasts, or why it belongs to one day (scope_reason)")

    @property
    def axis(self) -> Axis:
        """What its parameters are arrays over."""
        return HOOK_AXES[next(iter(self.lines))]

    @property
    def is_of_a_day(self) -> bool:
        """Whether it may belong to one day, which other days do not show."""
        return self.scope == "day"

    @property
    def is_of_either(self) -> bool:
        """Never: laws of the rig that do the same stand beside it."""
        return False

    @property
    def amplitude(self) -> Parameter:
        """The parameter that switches it off where it is 0."""
        return self.parameters[0]
