"""Laws of a quantity that an FMU hides: added to the input that drives it, over the output that shows it.

What a force does to a velocity, heat to a temperature, a flow to a level, a voltage to a current and a current to a
voltage is in the FMU; a law that adds to the derivative of one adds to the other, divided by an inertia or capacity.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from diagnosis.laws.expression import names_in, renamed
from diagnosis.laws.law import Law, OwnState, Role

#: Role of a law of a state to the roles that it has where the state is hidden.
HIDDEN = {
    Role.VELOCITY: (Role.FORCE_OVER_VELOCITY, Role.FORCE_OVER_POSITION),
    Role.TEMPERATURE: (Role.HEAT_OVER_TEMPERATURE,),
    Role.LEVEL: (Role.FLOW_OVER_LEVEL,),
    Role.CURRENT: (Role.VOLTAGE_OVER_CURRENT,),
    Role.VOLTAGE: (Role.CURRENT_OVER_VOLTAGE,),
}
#: Such a role to the symbols that its formulas may use beside the input u; the first is the output.
OVER = {
    Role.FORCE_OVER_VELOCITY: ("v",),
    Role.FORCE_OVER_POSITION: ("x", "v"),
    Role.HEAT_OVER_TEMPERATURE: ("T", "T_a"),
    Role.FLOW_OVER_LEVEL: ("h",),
    Role.VOLTAGE_OVER_CURRENT: ("i",),
    Role.CURRENT_OVER_VOLTAGE: ("q",),
}
#: The velocity of a position: the position behind a delay of one reading, and the derivative that follows from it.
_BEHIND = OwnState("behind", "(x - behind) / step", "x", "x")
_SPEED = "((x - behind) / step)"
_STEP = ("u/rate", 1.0)
#: Laws of a state that are another law at an input: what is added to it all the time.
_ELSE = {"constant_force": "input_offset"}


def at_inputs(laws: Iterable[Law]) -> Iterator[Law]:
    """Laws of hidden quantities that follow from those of shown ones."""
    for law in laws:
        for role in HIDDEN.get(law.role, ()):
            found = _at_input(law, role)
            if found is not None:
                yield found


def _at_input(law: Law, role: Role) -> Law | None:
    """The law at an input; None where it would act on a derivative alone, or on none of the quantities there."""
    own = {n.name for n in law.numbers} | set(law.constants)
    used = names_in(law.formula) - own
    is_of_input = used and used <= set(OVER[role]) and not (law.is_share or law.states or law.delays or law.reaction)
    if not is_of_input:
        return None
    is_slope = role is Role.FORCE_OVER_POSITION and "v" in used
    if is_slope and "v ** 3" in law.formula:  # late by a reading, a cube of a slope drives itself
        return None
    numbers = [replace(n, of=_of(n.of)) for n in law.numbers]
    constants = {n: (_of(of), size) for n, (of, size) in law.constants.items()} | ({"step": _STEP} if is_slope else {})
    numbers[0] = replace(numbers[0], meaning=f"strength, {role.value}")
    return Law(
        f"{law.identifier}_at_port{'_of_rate' if is_slope else ''}",
        law.name,
        role,
        renamed(law.formula, {"v": _SPEED}) if is_slope else law.formula,
        tuple(numbers),
        law.source,
        constants,
        (_BEHIND,) if is_slope else (),
        confused_with={_ELSE.get(other, f"{other}_at_port"): what for other, what in law.confused_with.items()},
        series_of=law.series_of,
    )


def _of(product: str) -> str:
    """What the size of a number is made of, at the input: `rate` is that of the derivative there."""
    return renamed(product, {"rate": "u"})
