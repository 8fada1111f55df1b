"""Terms that an unknown input may be made of: dimensionless functions of the unit's own variables and their history.

The variables, their scales and the functions are those of the unnamed terms of the catalogue
(diagnosis.candidates.unnamed), so that what is found here can be put into the running model; `time since the switch`
comes in addition.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.candidates.unnamed import FORMS, TARGETS, VARIABLES
from diagnosis.locate.course import Course

#: Function of one variable, as `FORMS` writes it.
FUNCTIONS: Mapping[str, Callable[[Array], Array]] = {
    "linear": lambda v: v,
    "square": lambda v: v * v,
    "cube": lambda v: v * v * v,
    "absolute": np.abs,
    "saturating": lambda v: 3.0 * v / (1.0 + 2.0 * np.abs(v)),
}
#: Delays that are tried [s].
DELAYS = (1.0, 5.0, 20.0, 100.0)
#: Memory of a supply's jump that is tried [s].
AFTER_SWITCH = 5.0


@dataclass(frozen=True)
class Feature:
    """A dimensionless function over a course.

    Args:
        identifier: Of the unnamed term that is the same, or empty.
        formula: In the names of the catalogue, for sympy.
        words: What it depends on.
        values: Shape (steps, coils).
    """

    identifier: str
    formula: str
    words: str
    values: Array


def variables(course: Course) -> dict[str, Array]:
    """The variables of the unnamed terms, dimensionless, shape (steps, coils) each."""
    time = np.broadcast_to(course.middle[:, None], course.temperature.shape)
    return {
        "excess": (course.temperature - course.ambient) / 30.0,
        "power": course.power / 0.4,
        "rate": course.rate / 5.0,
        "time": time / 60.0,
        "energy": course.energy / 10.0,
        "stretch": course.extension / 0.005,
        "phase": course.phase,
        "amperes": course.current / 0.4,
        "pull": np.broadcast_to(course.load, course.temperature.shape),
    }


def delayed(values: Array, course: Course, tau: float) -> Array:
    """First-order delay of a variable, 0 at the start, at the middles of the steps."""
    decay = np.exp(-course.size / tau)
    found, state = np.empty_like(values), np.zeros(values.shape[1])
    for n, keep in enumerate(decay):
        following = values[n] + (state - values[n]) * keep
        found[n] = 0.5 * (state + following)
        state = following
    return found


def features(course: Course, equation: str) -> list[Feature]:
    """Every term that may act on an equation.

    Args:
        course: What happens.
        equation: `heat`, `resistance`, `stiffness` or `length`, as in the catalogue's `TARGETS`.
    """
    target, known = TARGETS[equation], variables(course)
    found = []
    for variable, forms in target.single.items():
        formula, words = VARIABLES[variable]
        for form in forms:
            own = FORMS[form].format(v=formula).replace("fabs", "Abs")
            name = f"unnamed_{equation}_{form}_{variable}"
            found.append(Feature(name, own, f"{words}, {form}", FUNCTIONS[form](known[variable])))
    for one, other in target.products:
        formula = f"({VARIABLES[one][0]}) * ({VARIABLES[other][0]})"
        words = f"{VARIABLES[one][1]} times {VARIABLES[other][1]}"
        name = f"unnamed_{equation}_{one}_times_{other}"
        found.append(Feature(name, formula, words, known[one] * known[other]))
    for variable in target.delayed:
        formula, words = VARIABLES[variable]
        for tau in DELAYS:
            late = delayed(known[variable], course, tau)
            name = f"unnamed_{equation}_delayed_{variable}"
            found.append(Feature(name, f"delay({formula}, {tau:g})", f"{words}, delayed by {tau:g} s", late))
    after = np.exp(-course.since_switch / AFTER_SWITCH)[:, None] * np.ones(course.temperature.shape[1])
    found.append(Feature("", f"exp(-t_since_switch / {AFTER_SWITCH})", "time since the supply jumped", after))
    return found


def multiplier(course: Course, equation: str) -> tuple[Array, str, str]:
    """What turns a term of an equation into an input of the unit, with the amplitude's unit and the law's left side.

    The input stands on the right of the unit's equation: heat [W]; voltage [V], -I R a phi for a share a of the
    resistance; force [N], -x a phi for a stiffness a, k a phi for an extension a.

    Returns:
        Factor, shape (steps, coils); unit of the amplitude; law with `{}` for the sum of the terms.
    """
    ones = np.ones_like(course.temperature)
    if equation == "heat":
        return ones, "W", "heat = {}"
    if equation == "resistance":
        return -course.current * course.resistance, "1", "R = R_0 + reference_resistance * ({})"
    if equation == "stiffness":
        return -course.extension, "N/m", "stiffness = stiffness_0 + {}"
    return course.stiffness, "m", "extension = extension_0 + {}"
