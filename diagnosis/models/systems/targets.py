"""What a law of a role can be added to in an FMU, and which of its quantities stand for the symbols of the law."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping
from typing import TypeVar

from cosim.unit.quantity import cycles_and_angles, parse_unit
from diagnosis.laws.at_inputs import OVER
from diagnosis.laws.law import Role
from diagnosis.models.systems.quantities import Places, Quantity

_T = TypeVar("_T")
#: What the surroundings are called in a law where they are a number.
SURROUNDINGS = "surroundings"
#: Units of what a vessel holds.
_LENGTHS = ("m", "rad", "m^3", "Pa")
#: Share of its middle by which an input has to move to be told from a constant.
HARDLY = 0.05
#: Roles of laws that drive an exchange.
MODULATED = (Role.MODULATED, Role.MODULATED_BY_INPUT)
#: Roles at inputs and outputs.
AT_PORTS = (
    Role.READING,
    Role.INPUT,
    Role.STARTED_INPUT,
    Role.PORT,
    Role.OUTPUT,
    Role.RESPONSE,
    Role.RESPONSE_TO_ANOTHER,
)
#: Roles of laws that change a parameter.
AT_PARAMETERS = (Role.PARAMETER, Role.FAR_PARAMETER)
#: Roles of laws over a quantity of another component.
ACROSS = (Role.FAR_RATE, Role.FAR_PARAMETER, Role.FAR_INPUT, Role.FAR_PORT)
#: Roles of a state that is known by its unit alone: symbol in formulas, and units. A law of another domain, as of a
#: concentration, adds its role here.
OF_A_STATE: Mapping[Role, tuple[str, tuple[str, ...]]] = {
    Role.LEVEL: ("h", _LENGTHS),
    Role.CURRENT: ("i", ("A",)),
    Role.VOLTAGE: ("q", ("V",)),
}
#: `added_terms` target, its quantity, and symbol to quantity.
Target = tuple[str, Quantity, dict[str, Quantity]]


def targets(own: Places, role: Role) -> Iterator[Target]:
    """What a law of a role can be added to: `added_terms` target, its quantity, and symbol to quantity.

    A position and a twist are none: their derivatives are velocities, whatever acts.
    """
    free = {n: q for n, q in own.states.items() if n not in own.velocity_of and n not in own.twist_of}
    if role is Role.VELOCITY:
        yield from _motions(own, free)
    elif role is Role.LOADED_VELOCITY:
        for target, q, symbols in _motions(own, free):
            yield from ((target, q, {"v": symbols["v"], "o": load}) for load in own.inputs.values() if _is_load(load))
    elif role in (Role.COUPLED_VELOCITY, Role.COUPLED_TEMPERATURE, Role.COUPLED_LEVEL):
        yield from _coupled(own, role, free)
    elif role in OVER:
        yield from _hidden(own, role)
    elif role in AT_PORTS:
        yield from _at_ports(own, role)
    elif role in MODULATED:
        yield from _modulated(own, role, free)
    elif role in ACROSS:
        yield from _far(own, role, free)
    elif role in (Role.PARAMETER, Role.PAIR):
        yield from _over_another(own, role, free)
    else:
        yield from _single(own, role, free)


def parameter(name: str) -> str:
    """`added_terms` target of a parameter."""
    return f"parameter({name})"


def _over_another(own: Places, role: Role, free: Mapping[str, Quantity]) -> Iterator[Target]:
    """Parameters or states, over every other quantity."""
    every = (*own.states.values(), *own.inputs.values())
    if role is Role.PARAMETER:
        for name, changed in own.parameters.items():
            yield from ((parameter(name), changed.quantity, {"p": changed.quantity, "o": o}) for o in every)
    else:
        for name, q in free.items():
            yield from ((f"der({name})", q, {"s": q, "o": o}) for o in every if o.name != name)


def _far(own: Places, role: Role, free: Mapping[str, Quantity]) -> Iterator[Target]:
    """States, parameters and inputs over every quantity of another component."""
    for o, _ in own.far.values():
        if role is Role.FAR_RATE:
            yield from ((f"der({n})", q, {"s": q, "o": o}) for n, q in free.items())
        elif role is Role.FAR_PARAMETER:
            for name, changed in own.parameters.items():
                yield parameter(name), changed.quantity, {"p": changed.quantity, "o": o}
        elif role is Role.FAR_INPUT:
            yield from ((n, q, {"u": q, "o": o}) for n, q in own.inputs.items())
        else:
            for name, q in own.inputs.items():
                yield from ((name, q, {"u": q, "o": o, "y": y}) for y in own.outputs.values())


def _modulated(own: Places, role: Role, free: Mapping[str, Quantity]) -> Iterator[Target]:
    """States and what they exchange something with, over every other quantity; two states once."""
    if role is Role.MODULATED:
        pairs = [(q, r) for q, r in _pairs(free.values()) if r.name in own.acted_on_by.get(q.name, ())]
        partners = [(q, r, {"d": own.apart[q.name, r.name]}) for q, r in pairs if (q.name, r.name) in own.apart]
    else:
        named = [q for q in free.values() if q.unit not in ("", "1")]
        partners = [(q, r, {}) for q in named for r in own.inputs.values() if r.unit == q.unit]
    for q, r, gap in partners:
        for o in (*own.states.values(), *own.inputs.values()):
            if o.name not in (q.name, r.name):
                yield f"der({q.name})", q, {"s": q, "r": r, "o": o, **gap}


def _at_ports(own: Places, role: Role) -> Iterator[Target]:
    """Inputs and outputs."""
    if role is Role.READING:
        for name, q in own.readings.items():
            yield from ((name, q, {"y": q, "o": o}) for o in (*own.states.values(), *own.inputs.values()))
    elif role is Role.INPUT:
        yield from ((name, q, {"u": q}) for name, q in own.inputs.items())
    elif role is Role.STARTED_INPUT:
        yield from ((name, q, {"u": q}) for name, q in own.inputs.items() if _is_on(q))
    elif role is Role.PORT:
        for name, q in own.inputs.items():
            yield from ((name, q, {"u": q, "o": other}) for other in own.outputs.values())
    elif role is Role.OUTPUT:
        yield from ((name, q, {"y": q}) for name, q in own.outputs.items())
    elif role in (Role.RESPONSE, Role.RESPONSE_TO_ANOTHER):
        for name, q in own.outputs.items():
            ports = [p for p in (*own.inputs.values(), *own.outputs.values()) if role is Role.RESPONSE or p is not q]
            yield from ((name, q, {"y": q, "o": other}) for other in ports)


#: Units of an input and of the output of which it drives the derivative, of each role.
_DRIVEN = {
    Role.FORCE_OVER_VELOCITY: ((("N",), ("m/s",)), (("N*m",), ("rad/s",))),
    Role.FORCE_OVER_POSITION: ((("N",), ("m",)), (("N*m",), ("rad",))),
    Role.HEAT_OVER_TEMPERATURE: ((("W",), ("K",)),),
    Role.FLOW_OVER_LEVEL: ((("m^3/s", "kg/s"), ("m", "m^3", "Pa")),),
    Role.VOLTAGE_OVER_CURRENT: ((("V",), ("A",)),),
    Role.CURRENT_OVER_VOLTAGE: ((("A",), ("V",)),),
}


def _hidden(own: Places, role: Role) -> Iterator[Target]:
    """Inputs that drive what an output shows."""
    symbol = OVER[role][0]
    for drives, shows in _DRIVEN[role]:
        for u in (q for q in own.inputs.values() if is_of(q, *drives)):
            for o in (q for q in own.outputs.values() if is_of(q, *shows)):
                for beside in _beside_output(own, role, o):
                    yield u.name, u, {"u": u, symbol: o, **beside}


def _beside_output(own: Places, role: Role, output: Quantity) -> list[dict[str, Quantity]]:
    """Further symbols of a law over an output, one choice each: the surroundings; a velocity, for its size."""
    if role is Role.HEAT_OVER_TEMPERATURE:
        return _rooms(own)
    if role is Role.FORCE_OVER_POSITION:
        return [{"v": Quantity(f"rate of {output.name}", f"({output.unit})/s", output.rate, 0.0, 0.0)}]
    return [{}]


def _rooms(own: Places) -> list[dict[str, Quantity]]:
    """What may be the surroundings; where nobody says it, laws that need none have their place all the same."""
    rooms = [{"T_a": q} for q in own.inputs.values() if is_of(q, "K")]
    if rooms:
        return rooms
    return [{} if own.room is None else {"T_a": Quantity(SURROUNDINGS, "K", 1.0, own.room, 0.0)}]


def _motions(own: Places, free: Mapping[str, Quantity]) -> Iterator[Target]:
    """Velocities, with the position where there is one."""
    for position, velocity in own.velocity_of.items():
        yield f"der({velocity})", own.states[velocity], {"x": own.states[position], "v": own.states[velocity]}
    for name, q in free.items():
        if name not in own.velocity_of.values() and is_of(q, "m/s", "rad/s"):
            yield f"der({name})", q, {"v": q}


def _is_load(quantity: Quantity) -> bool:
    """Whether friction may go by an input: no temperature, and nothing that hardly changes, as a constant shows it."""
    return not is_of(quantity, "K") and quantity.size > HARDLY * abs(quantity.middle)


def _is_on(quantity: Quantity) -> bool:
    """Whether an input is on where recordings begin: the middle of a quantity is that of its first values."""
    return not is_of(quantity, "K") and abs(quantity.middle) > HARDLY * quantity.size


def _coupled(own: Places, role: Role, free: Mapping[str, Quantity]) -> Iterator[Target]:
    """Two states of one kind, each pair once."""
    q = own.states
    if role is Role.COUPLED_VELOCITY:
        between = {(v, v_2): own.apart.get((x, x_2)) for (x, v), (x_2, v_2) in _pairs(own.velocity_of.items())}
        between |= {pair: q[twist] for twist, pair in own.twist_of.items()}
        for (v, v_2), distance in between.items():
            if distance is not None and (v, v_2) in own.apart:
                yield f"der({v})", q[v], {"v": q[v], "v_2": q[v_2], "d": distance, "w": own.apart[v, v_2]}
        placed = {frozenset(pair) for pair, distance in between.items() if distance is not None}
        velocities = [n for n in free if n in own.velocity_of.values() or is_of(q[n], "m/s", "rad/s")]
        for v, v_2 in _pairs(velocities):  # shafts of which only the speeds are states: what rubs between them
            if frozenset((v, v_2)) not in placed and (v, v_2) in own.apart:
                yield f"der({v})", q[v], {"v": q[v], "v_2": q[v_2], "w": own.apart[v, v_2]}
        return
    units, symbol = (("K",), "T") if role is Role.COUPLED_TEMPERATURE else (_LENGTHS, "h")
    alone = [n for n in free if n not in own.velocity_of.values() and is_of(q[n], *units)]
    for one, other in _pairs(alone):
        if (one, other) in own.apart:
            yield f"der({one})", q[one], {symbol: q[one], f"{symbol}_2": q[other], "d": own.apart[one, other]}


def _pairs(some: Iterable[_T]) -> Iterator[tuple[_T, _T]]:
    return itertools.combinations(some, 2)


def _single(
    own: Places, role: Role, free: Mapping[str, Quantity]
) -> Iterator[tuple[str, Quantity, dict[str, Quantity]]]:
    alone = {n: q for n, q in free.items() if n not in own.velocity_of.values()}
    if role is Role.STATE:
        for name, q in free.items():
            yield f"der({name})", q, {"s": q}
    elif role is Role.TEMPERATURE:
        for name, q in alone.items():
            if is_of(q, "K"):
                yield from ((f"der({name})", q, {"T": q, **room}) for room in _rooms(own))
    else:
        symbol, units = OF_A_STATE[role]
        for name, q in alone.items():
            if is_of(q, *units):
                yield f"der({name})", q, {symbol: q}


def is_of(quantity: Quantity, *units: str) -> bool:
    """Whether a quantity is of the kind of one of these units; a pure number is no angle, nor 1/s its rate."""
    own = parse_unit(quantity.unit).dimensionality
    is_angle = any(cycles_and_angles(quantity.unit))
    return any(own == parse_unit(u).dimensionality and (is_angle or not any(cycles_and_angles(u))) for u in units)
