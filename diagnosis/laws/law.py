"""What a law says about itself: on which quantity it acts, its formula, its numbers, where it comes from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum


class Role(Enum):
    """Quantity that a law is added to, with the symbols that its formula may use.

    `rate` stands for the unit and the size of what the law is added to, `reading` for the time between two readings: no
    state of a law needs to follow faster, `duration` for the length of the longest recording, `o_peak` for how far
    another quantity o goes from its typical value.
    """

    #: Derivative of a velocity v that is the derivative of a position x.
    VELOCITY = "rate of a velocity"
    #: Derivative of a velocity v, over an input o.
    LOADED_VELOCITY = "rate of a velocity over an input"
    #: Derivative of a temperature T in surroundings of T_a, where an input or a parameter says what these are.
    TEMPERATURE = "rate of a temperature"
    #: Derivative of a level, a volume or a pressure h.
    LEVEL = "rate of a level"
    #: Derivative of a current i.
    CURRENT = "rate of a current"
    #: Derivative of a voltage q.
    VOLTAGE = "rate of a voltage"
    #: Derivative of any state s but a position.
    STATE = "rate of a state"
    #: Derivative of any state s but a position, over another state or input o.
    PAIR = "rate of a state over another quantity"
    #: Derivative of a velocity v, beside another one v_2 of the same FMU; d and w are what the positions and the
    #: velocities are apart by.
    COUPLED_VELOCITY = "rate of a velocity beside another one"
    #: Derivative of a temperature T beside another one T_2; d is what they are apart by.
    COUPLED_TEMPERATURE = "rate of a temperature beside another one"
    #: Derivative of a level, a volume or a pressure h beside another one h_2; d is what they are apart by.
    COUPLED_LEVEL = "rate of a level beside another one"
    #: Derivative of a state s that another one r of its unit acts on, over a third quantity o; d is what s and r are
    #: apart by.
    MODULATED = "rate of a state over its difference to another one and a third quantity"
    #: Derivative of a state s over its difference to an input r of its unit, and a third quantity o.
    MODULATED_BY_INPUT = "rate of a state over its difference to an input and a third quantity"
    #: A parameter p of an FMU that shows its states, wherever its equations hold it, over a state or input o.
    PARAMETER = "parameter over a state or input"
    #: An output y of an FMU that shows its states, which is none of them nor a derivative, over a state or input o.
    READING = "output that is no state, over a state or input"
    #: An input u.
    INPUT = "input"
    #: An input u that is on where recordings begin, and no temperature: 0 is off.
    STARTED_INPUT = "input that is on at the begin"
    #: A force or torque u at an input of an FMU that hides its states, over an output v that is a velocity.
    FORCE_OVER_VELOCITY = "force at an input over a velocity"
    #: The same over an output x that is a position, with the velocity v that follows from it.
    FORCE_OVER_POSITION = "force at an input over a position"
    #: A heat flow u at such an input over an output T, in surroundings of T_a.
    HEAT_OVER_TEMPERATURE = "heat flow at an input over a temperature"
    #: A flow u at such an input over an output h: a level, a volume or a pressure.
    FLOW_OVER_LEVEL = "flow at an input over a level"
    #: A voltage u at such an input over an output i.
    VOLTAGE_OVER_CURRENT = "voltage at an input over a current"
    #: A current u at such an input over an output q, a voltage.
    CURRENT_OVER_VOLTAGE = "current at an input over a voltage"
    #: An input u of an FMU that hides its states, over an output o.
    PORT = "input over an output"
    #: An output y of an FMU that hides its states.
    OUTPUT = "output"
    #: An output y of an FMU that hides its states, over an input or output o.
    RESPONSE = "output over an input or output"
    #: The same, over any but itself.
    RESPONSE_TO_ANOTHER = "output over an input or another output"
    #: Derivative of any state s but a position, over a quantity o of another component.
    FAR_RATE = "rate of a state over a quantity of another component"
    #: A parameter p of an FMU that shows its states, over such a quantity o.
    FAR_PARAMETER = "parameter over a quantity of another component"
    #: An input u, over such a quantity o.
    FAR_INPUT = "input over a quantity of another component"
    #: An input u of an FMU that hides its states, over an output y and such a quantity o.
    FAR_PORT = "input over an output and a quantity of another component"


@dataclass(frozen=True)
class Number:
    """A number of a law.

    Args:
        name: Symbol in the formula.
        of: Product of powers of symbols, from which follow its unit and its characteristic size: `rate/v`.
        meaning: What it is, in words.
        starts: Values that a search begins from, in characteristic sizes; with an `origin`, shares of the way from the
            least to the largest value that this takes in the recordings as the model has them.
        most: Largest value, in characteristic sizes.
        least: Smallest value, in characteristic sizes; None: as large as `most`, with the other sign.
        origin: Symbol of which it is a value (a position of a stop), or empty; its bounds are counted from the value
            at which that begins.
    """

    name: str
    of: str
    meaning: str
    starts: tuple[float, ...]
    most: float = 1e3
    least: float | None = 0.0
    origin: str = ""


def sets_in(of: str, what: str) -> Number:
    """What `tanh(of / rounding)` rounds a step at zero over: a rig's own is not known, so it is fitted.

    Args:
        of: Symbol of the speed or current.
        what: The same in words.
    """
    return Number("rounding", of, f"{what} within which it sets in", (0.01,), 0.1, 0.002)


@dataclass(frozen=True)
class OwnState:
    """A state that a law adds.

    Args:
        name: Symbol in the formulas.
        rate: Its derivative.
        start: Its value at the start.
        of: See `Number`.
    """

    name: str
    rate: str
    start: str
    of: str


@dataclass(frozen=True)
class Delay:
    """An input as it was some time ago: exact, no form of a low order.

    Args:
        name: Symbol in the formulas.
        of: Symbol of the input.
        by: Number of the law that is the time, 0 or longer.
    """

    name: str
    of: str
    by: str


@dataclass(frozen=True)
class Law:
    """One effect; the first number is its strength, at 0 it is absent.

    Args:
        identifier: Name in the catalogue.
        name: In plain words.
        role: What it is added to.
        formula: What is added, in the symbols of the role, its numbers, constants, states and
            delayed inputs.
        numbers: Free numbers, bounded below by 0 where the law takes energy.
        source: Where the law comes from.
        constants: Name to (product of symbols, value in characteristic sizes): what is not fitted, such as the width
            over which a sign is rounded.
        states: States of its own.
        delays: Inputs as they were some time ago.
        is_named: Whether it is an effect with a name.
        confused_with: Identifiers that data often cannot tell from it, with what decides.
        reaction: What is added to the derivative of `reacts_on` with it, in the same symbols: what one part loses the
            other one gets, as a share that inertias or capacities decide.
        reacts_on: Symbol of the other part.
        is_share: Whether the formula is a share of the derivative as the FMU has it, or of the parameter, and a pure
            number.
        series_of: Symbols of quantities of which it is a power series: of one far from 0 it is about a typical value.
        is_completing: Whether it belongs to a basis that is tried only where all other laws leave more than noise.
    """

    identifier: str
    name: str
    role: Role
    formula: str
    numbers: tuple[Number, ...]
    source: str
    constants: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    states: tuple[OwnState, ...] = ()
    delays: tuple[Delay, ...] = ()
    is_named: bool = True
    confused_with: Mapping[str, str] = field(default_factory=dict)
    reaction: str = ""
    reacts_on: str = ""
    is_share: bool = False
    series_of: tuple[str, ...] = ()
    is_completing: bool = False
