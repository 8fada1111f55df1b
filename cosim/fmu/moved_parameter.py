"""A parameter of an FMU that changes during a run, by instances in which it is smaller and larger.

FMI takes a fixed parameter before the initialisation alone. What the equations are with another value follows from two
more instances of the FMU, which stand at the same time, states and inputs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.unit.protocol import AnyArray, Array, UnitError

if TYPE_CHECKING:
    from cosim.fmu.model_exchange import ModelExchangeUnit

#: Share by which the parameter is smaller and larger in these instances.
REACH = 0.25
#: What a step down and a step up do may differ by this factor where a rational function goes through both.
MOST_RATIO = 4.0
#: Smallest denominator of that function: nearer to its pole it is no interpolation.
LEAST = 0.05


def change(share: float, below: Array, here: Array, above: Array) -> Array:
    """By how much equations change where a parameter changes by a share of itself.

    A rational function of first order goes through the three values: it is exact where the equations hold the parameter
    in proportion, in its reciprocal or in both. Where a step down and a step up do very different things, or opposite
    ones, it is a parabola.

    Args:
        share: Change of the parameter over its value, above -1.
        below: Values where it is smaller by `REACH` of itself.
        here: Values as it is.
        above: Values where it is larger by as much.

    Returns:
        What is to be added to `here`; NaN near a pole of the function, and where the parameter changes its sign.

    Source: Stoer, Bulirsch, Introduction to Numerical Analysis, Springer 2002, section 2.2 (rational interpolation).

    >>> three = [np.array([1.0 / (1.0 + s)]) for s in (-0.25, 0.0, 0.25)]
    >>> round(float(change(0.5, *three)[0]), 9)  # 1/1.5 - 1
    -0.333333333
    """
    fall, rise = (here - below) / REACH, (above - here) / REACH
    with np.errstate(all="ignore"):
        bend = (fall - rise) / REACH
        denominator = fall + rise + share * bend
        rational = 2.0 * rise * fall * share / denominator
        rational = np.where(denominator / (fall + rise) < LEAST, np.nan, rational)
    parabola = 0.5 * share * (fall + rise - share * bend)
    sizes = np.abs(fall), np.abs(rise)
    is_like = (fall * rise > 0.0) & (np.maximum(*sizes) <= MOST_RATIO * np.minimum(*sizes))
    found = np.where(is_like, rational, parabola)
    return found if share > -1.0 else np.full_like(found, np.nan)


@dataclass(frozen=True)
class MovedParameter:
    """Two instances of an FMU beside the one that is simulated.

    Args:
        name: The parameter.
        below: With a smaller value of it.
        above: With a larger one.
    """

    name: str
    below: ModelExchangeUnit
    above: ModelExchangeUnit

    @property
    def instances(self) -> tuple[ModelExchangeUnit, ModelExchangeUnit]:
        """Both, the smaller value first."""
        return self.below, self.above

    def set_parameters(self, unit: ModelExchangeUnit, parameters: Mapping[str, Any]) -> None:
        """Set parameters before initialisation, after the FMU itself has them."""
        value = unit.table.value_of(self.name)
        for instance, factor in zip(self.instances, (1.0 - REACH, 1.0 + REACH)):
            instance.set_parameters({**parameters, self.name: (factor * value).tolist()})

    def begin(self, unit: ModelExchangeUnit, time: int) -> None:
        """Initialise with the inputs that the FMU has, and leave Initialization Mode."""
        for instance in self.instances:
            for name in unit.writers:
                instance.set(name, unit.get(name))
            instance.initialise(time)
            instance.exit_initialisation()

    def free(self) -> None:
        """Free both; safe to call twice."""
        for instance in self.instances:
            instance.binding.free()

    def rates(self, time: float, states: Array, inputs: Mapping[str, AnyArray], share: float, here: Array) -> Array:
        """What is added to the derivatives of the states, shape (states,).

        Args:
            time: Time [s].
            states: Of the FMU, shape (states,).
            inputs: As the FMU has them.
            share: Change of the parameter over its value.
            here: Derivatives as the FMU has them.
        """
        below, above = (i.rates_at(time, states, inputs) for i in self.instances)
        return change(share, below, here, above)

    def outputs(
        self,
        time: float,
        states: Array,
        inputs: Mapping[str, AnyArray],
        share: float,
        here: Mapping[str, AnyArray],
    ) -> dict[str, AnyArray]:
        """What is added to outputs, by name.

        Args:
            time: Time [s].
            states: Of the FMU, shape (states,).
            inputs: As the FMU has them.
            share: Change of the parameter over its value.
            here: Outputs as the FMU has them.
        """
        below, above = (i.outputs_at(time, states, inputs) for i in self.instances)
        return {n: change(share, below[n], values, above[n]) for n, values in here.items()}


def refuse_event(name: str, time: float) -> UnitError:
    """What is wrong with an FMU whose parameter changes and that has an event at a time [s]."""
    return UnitError(
        name,
        f"it has an event at {time:.9g} s, and a term changes one of its parameters",
        remedy="a parameter can change in an FMU without events alone: leave the term out",
    )
