"""Quantities of other components that a law of an FMU may use though nothing connects them to it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from cosim.fmu.units import is_known
from cosim.programme import ProgrammeUnit
from cosim.unit.protocol import Array
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.quantities import Quantity, quantity_of

#: Courses in their own mean and size that differ by no more than this are one quantity in two units.
SAME = 1e-6
#: A quantity that moves by less of its value is a constant.
MOVES = 1e-9
_STATE = "state "


def far_quantities(
    system: FastSystem, component: str, courses: Sequence[Mapping[tuple[str, str], Array]], step: float
) -> dict[str, tuple[Quantity, str]]:
    """By the names of inputs for them: the quantity, and `component.variable` of what they get.

    What is connected to the FMU, what it has itself, and what is one quantity with another that is there, are none: a
    law over the first ones has its places already. Nor is what does not move.

    Args:
        system: Without laws.
        component: The FMU.
        courses: What was recorded in each recording.
        step: Time between two values [s].
    """
    fmu = system.fmus[component]
    taken = {*fmu.units, "time"}
    known = [form for key in courses[0] if key[0] == component and (form := _form(key, courses)) is not None]
    found: dict[str, tuple[Quantity, str]] = {}
    for key, name, unit in _others(system, component):
        form = _form(key, courses)
        if form is None or any(_are_one(form, other) for other in known):
            continue
        known.append(form)
        own = _free(re.sub(r"\W+", "_", f"{key[0]}_{name}").strip("_"), taken)
        taken.add(own)
        found[own] = quantity_of(own, unit, [c[key].reshape(-1) for c in courses if key in c], step), f"{key[0]}.{name}"
    return found


def _others(system: FastSystem, component: str) -> Iterator[tuple[tuple[str, str], str, str]]:
    """Key of what is recorded of every other component, name of the variable, and unit; states last."""
    states = []
    for key, place in system.recorded.items():
        other, text = key
        name = text.removeprefix(_STATE)
        if other == component or place.stop - place.start != 1 or text.startswith("input "):
            continue
        unit = system.assembly.system.units[other]
        own = unit.variables[name].unit if isinstance(unit, ProgrammeUnit) else system.fmus[other].units.get(name, "")
        if not own or not is_known(own):
            continue
        if text.startswith(_STATE):
            states.append((key, name, own))
        else:
            yield key, name, own
    yield from states


def _form(key: tuple[str, str], courses: Sequence[Mapping[tuple[str, str], Array]]) -> Array | None:
    """Course over all recordings from its mean, in its own size; None of what does not move or is no number."""
    values = [c[key] for c in courses if key in c]
    if not values or any(v.ndim > 1 and v.shape[1] != 1 for v in values):
        return None
    whole = np.concatenate([v.reshape(-1) for v in values])
    apart = whole - np.mean(whole)
    size = float(np.sqrt(np.mean(apart**2)))
    return apart / size if size > MOVES * float(np.max(np.abs(whole))) else None


def _are_one(one: Array, other: Array) -> bool:
    return bool(one.shape == other.shape and min(np.max(np.abs(one - other)), np.max(np.abs(one + other))) < SAME)


def _free(name: str, taken: set[str]) -> str:
    """The name, with as many `_` as no other has it; one that begins with a digit is none of a formula."""
    name = name if name.isidentifier() else f"far_{name}"
    while name in taken:
        name += "_"
    return name
