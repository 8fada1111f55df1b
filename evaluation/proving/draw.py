"""Draws effects: strength, place and time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from evaluation.proving.effects.effect import Effect, Place, Strength, drawn_place, drawn_values
from evaluation.proving.effects.electrical import SupplyCurrentLimit
from evaluation.proving.effects.thermal import NeighbourHeat, TemperatureDependentConvection
from evaluation.proving.rig import Rig
from evaluation.proving.setups import EFFECTS, Setup

#: Recordings to learn from: what is sudden sets in during one of them.
TRAINING = 2
#: Share that no strength may pass, whatever the draw.
_MOST = {"openness": 1.0, "bridged": 1.0, "duhem_share": 1.0}
#: Parameters that grow with the conductance, or with the capacity, of the element that they act on.
_LIKE_CONDUCTANCE, _LIKE_CAPACITY = ("g", "loss", "emissivity_area"), ("C2", "C_chassis")


def drawn_effect(effect: type[Effect], setup: Setup, rig: Rig, strength: Strength, rng: np.random.Generator) -> Effect:
    """An effect on a rig: values within the range of its strength, sign, place, recording and instant drawn."""
    place = drawn_place_on(effect.places, setup, rng)
    parameters = drawn_values(effect.strengths, effect.ranges, strength, rng)
    parameters = {name: min(value, _MOST.get(name, np.inf)) for name, value in parameters.items()}
    if effect.signed and rng.random() < 0.5:
        parameters[effect.signed] *= -1.0
    if effect.is_sudden:
        parameters["instant"] = round(float(rng.uniform(0.25, 0.65)) * setup.stop, 1)
    if setup.sheet.is_driven_by_power:
        _scale(parameters, setup)
    if effect is SupplyCurrentLimit:
        strings = setup.sheet.strings
        most = setup.top / setup.sheet.resistance * sum(1.0 / n for n in strings)
        parameters = {"limit": parameters["share"] * most}
    made = effect(place, parameters)
    if effect.is_sudden:
        made.recording = int(rng.integers(1, TRAINING + 1))
    if isinstance(made, TemperatureDependentConvection):
        made.conductance = rig.conductance
    if isinstance(made, NeighbourHeat):
        made.pairs = _pairs(setup)
    return made


def drawn_place_on(kinds: Sequence[str], setup: Setup, rng: np.random.Generator) -> Place:
    """A place of one of some kinds, those that tell themselves from `all` on this rig."""
    places = [p for p in kinds if _is_place(p, setup)]
    return drawn_place(str(rng.choice(places)), setup.sheet, rng)


def _is_place(kind: str, setup: Setup) -> bool:
    """Whether a place tells itself from `all` on this rig."""
    strings = len(setup.sheet.strings)
    if kind == "string":
        return strings > 1 and setup.sheet.coils > strings
    return kind != "coil" or setup.sheet.coils > 1


def fits(effect: type[Effect], setup: Setup) -> bool:
    """Whether an effect can act on a rig."""
    return effect in setup.effects and any(_is_place(p, setup) for p in effect.places)


def _scale(parameters: dict[str, float], setup: Setup) -> None:
    """Strengths are given for a coil of the paper; a larger body needs as much more."""
    coil = type(setup.sheet)()
    for name in parameters:
        if name in _LIKE_CONDUCTANCE:
            parameters[name] *= setup.sheet.conductance / coil.conductance
        elif name in _LIKE_CAPACITY:
            parameters[name] *= setup.sheet.capacity / coil.capacity
        elif name == "drift":
            parameters[name] *= (
                coil.conductance / coil.capacity * setup.sheet.capacity / setup.sheet.conductance / 100.0
            )


def _pairs(setup: Setup) -> np.ndarray[tuple[int, int], np.dtype[np.int64]]:
    """Coils that touch: along a string, and at the same place of the next string."""
    strings, places = setup.sheet.string_of_coil, setup.sheet.place_in_string
    at = {(int(s), int(p)): n for n, (s, p) in enumerate(zip(strings, places))}
    found = [(n, at[o]) for (s, p), n in at.items() for o in ((s, p + 1), (s + 1, p)) if o in at]
    return np.array(found, dtype=np.int64).reshape(-1, 2)


def in_order(effects: list[Effect]) -> list[Effect]:
    """Effects in the order in which they act."""
    order: Callable[[Effect], int] = lambda e: EFFECTS.index(type(e))  # noqa: E731
    return sorted(effects, key=order)
