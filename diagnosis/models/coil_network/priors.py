"""What a network's parameters may be off by: shared over all coils, from coil to coil, and from day to day.

The defaults are those of a careful rig: a few per cent. A parameter set can say otherwise (`uncertainty`, `scatter`).
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue, conversion
from diagnosis.recording.recording import Recording
from diagnosis.search.shares import RIG_START, own_deviation, shared_deviation


@dataclass(frozen=True)
class Prior:
    """How far a parameter may be off.

    Args:
        shared: Standard deviation common to all coils; 0: it is taken as given.
        scatter: Standard deviation from coil to coil; 0: all coils are the same.
        is_relative: Of the logarithm of the value, or of the value itself.
        needs: Quantities of which at least one must be measured for it to matter; empty: any.
    """

    shared: float
    scatter: float = 0.0
    is_relative: bool = True
    needs: tuple[str, ...] = ()


_MECHANICAL = ("extension", "length", "stiffness", "tension")

#: Base parameter of the network to its prior. `heating_shift` and `cooling_shift` move a branch of the stiffness along
#: the temperature, `transformation_shift` both [K].
PRIORS: Mapping[str, Prior] = {
    "reference_resistance": Prior(0.03, 0.035),
    "conductance": Prior(0.05, 0.035),
    "capacity": Prior(0.05, 0.035),
    "cooling_rate": Prior(0.05),
    "heating_a": Prior(0.03, needs=_MECHANICAL),
    "heating_d": Prior(0.02, needs=_MECHANICAL),
    "cooling_a": Prior(0.03, needs=_MECHANICAL),
    "heating_shift": Prior(1.0, is_relative=False, needs=_MECHANICAL),
    "cooling_shift": Prior(1.0, is_relative=False, needs=_MECHANICAL),
    # Coil by coil: one factor for weight and stiffness together, and where the loop lies (several coils only).
    "transformation_shift": Prior(0.0, 0.25, is_relative=False, needs=_MECHANICAL),
    "load": Prior(0.02, 0.012, needs=_MECHANICAL),
    "power_gain": Prior(0.0, needs=("temperature",)),
}
#: Doubt about the room and the start of every recording that states none [K]; divided into what all recordings share
#: and what each has (`diagnosis.search.shares`).
DAILY: Mapping[str, Prior] = {
    "ambient_offset": Prior(0.5, is_relative=False),
    "initial_temperature": Prior(RIG_START, is_relative=False),
}
#: Number and the element in brackets.
_ELEMENT = re.compile(r"^(?P<name>.*?)(?:\[(?P<element>\d+)\])?$")


@dataclass(frozen=True)
class OwnPriors:
    """What one recording does not know exactly itself: standard deviations.

    Args:
        ambient: Of the temperature of the surroundings [K].
        starts: Of the temperature at the start, coil to [K]: each by itself.
        positions: Of the place in the hysteresis loop at the start, coil to [1]: each by itself.
        are_all_stated: Whether `starts` has every coil; else the others together are off by the default.
        day: Name of its day; empty: one of its own.
    """

    ambient: float = DAILY["ambient_offset"].shared
    starts: Mapping[int, float] = field(default_factory=dict)
    positions: Mapping[int, float] = field(default_factory=dict)
    are_all_stated: bool = False
    day: str = ""


@dataclass(frozen=True)
class DailyPriors:
    """What all recordings of a rig share of their room and their start, and what is left to each.

    Args:
        shared: `ambient_offset` and `initial_temperature` to the deviation of what all recordings share [K].
        own: Of every recording, less what is shared.
    """

    shared: Mapping[str, float] = field(default_factory=dict)
    own: Sequence[OwnPriors] = ()
    #: Deviation of the start of all coils together of a recording that does not state it of every coil [K].
    start: float = 0.0


def matters(prior: Prior, measured: set[str]) -> bool:
    """Whether a parameter can be seen in what is measured."""
    return not prior.needs or bool(measured & set(prior.needs))


#: Parameter of the network to those of the actuator whose product it is.
FACTORS: Mapping[str, tuple[str, ...]] = {
    "conductance": ("heat_transfer_coefficient", "area"),
    "capacity": ("density", "volume", "specific_heat"),
}


def stated_priors(uncertainty: Mapping[str, float], scatter: Mapping[str, float]) -> dict[str, Prior]:
    """Priors of the network's relative parameters, as a parameter set states them; the defaults where it does not.

    Args:
        uncertainty: Parameter of the actuator to the standard deviation of ln(value) that all coils share.
        scatter: The same from coil to coil.
    """
    found = dict(PRIORS)
    for name, prior in PRIORS.items():
        factors = FACTORS.get(name, (name,))
        if prior.is_relative and any(f in uncertainty for f in factors):
            prior = replace(prior, shared=math.hypot(*(uncertainty.get(f, 0.0) for f in factors)))
        if prior.is_relative and any(f in scatter for f in factors):
            prior = replace(prior, scatter=math.hypot(*(scatter.get(f, 0.0) for f in factors)))
        found[name] = prior
    return found


def own_priors(recording: Recording, actuator: str, ambient: str, coils: int) -> OwnPriors:
    """What one recording does not know exactly itself, as it states it (`uncertain`); the defaults where it does not.

    Args:
        recording: The recording.
        actuator: Component of the coils.
        ambient: `component.output` of the programme of the surroundings.
        coils: How many there are.

    Raises:
        InputError: It states a number that a coil network cannot vary, of no coil, or no positive deviation.
    """
    room, starts, positions = DAILY["ambient_offset"].shared, dict[int, float](), dict[int, float]()
    places = {f"{actuator}.initial_temperature": (starts, "K"), f"{actuator}.initial_loop_position": (positions, "1")}
    # those of single coils last: they count more than one for all
    for name, given in sorted(recording.uncertain.items(), key=lambda item: item[0].endswith("]")):
        file, key = recording.path / "recording.yaml", f"uncertain.{name}"
        match = _ELEMENT.match(name)
        assert match is not None  # it matches any text
        element = None if match["element"] is None else int(match["element"])
        if name == ambient:
            room = stated_deviation(given, "K", recording, name)
        elif match["name"] not in places:
            raise InputError(
                file,
                key,
                "this number of a network of coils cannot be estimated",
                f"name {ambient}, {' or '.join(places)}",
            )
        elif element is not None and not 1 <= element <= coils:
            raise InputError(file, key, f"there are {coils} coils", f"name an element from 1 to {coils}")
        else:
            target, unit = places[match["name"]]
            deviation = stated_deviation(given, unit, recording, name)
            target.update(dict.fromkeys(range(coils) if element is None else (element - 1,), deviation))
    return OwnPriors(room, starts, positions, len(starts) == coils, recording.day)


def stated_deviation(given: PhysicalValue, unit: str, recording: Recording, name: str) -> float:
    """A standard deviation that a recording states (`uncertain`), in a unit; a difference, so that K and degC are one.

    Raises:
        InputError: It is not positive, or of another dimension.
    """
    file, key = recording.path / "recording.yaml", f"uncertain.{name}"
    try:
        factor = conversion(given.unit or unit, unit)[0]
    except ValueError as error:
        raise InputError(file, key, str(error), f"give a positive difference in {unit}") from error
    if not given.number > 0:
        raise InputError(file, key, f"{given} is not positive", f"give a positive difference in {unit}")
    return factor * given.number


def daily_priors(own: Sequence[OwnPriors]) -> DailyPriors:
    """The doubts of all recordings, divided into what the rig shares and what each has: `diagnosis.search.shares`."""
    if not own:
        return DailyPriors()
    ambient = shared_deviation([o.ambient for o in own])
    start = shared_deviation([min([RIG_START, *o.starts.values()]) for o in own], RIG_START)
    left = [
        replace(
            o,
            ambient=own_deviation(o.ambient, ambient),
            starts={i: own_deviation(s, start) for i, s in o.starts.items()},
        )
        for o in own
    ]
    shared = {"ambient_offset": ambient, "initial_temperature": start}
    return DailyPriors(shared, left, own_deviation(RIG_START, start))
