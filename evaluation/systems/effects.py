"""Effects that are concealed in the truth, sized by what the model's own terms do."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from evaluation.systems.rigs import Rig

#: Rate that is added to one state, from all states and all inputs.
Added = Callable[[Array, Array], float]


@dataclass(frozen=True)
class Effect:
    """One effect at one place.

    Args:
        name: Of the law as the library calls it; empty: it has none there.
        state: Index of the state.
        added: What is added to its derivative.
        answers: Identifiers that name it rightly.
    """

    name: str
    state: int
    added: Added
    answers: tuple[str, ...]


def effects_of(rig: Rig, states: Array, rates: Array, inputs: Array, rng: np.random.Generator) -> list[Effect]:
    """Every effect that the rig may have, each once.

    Args:
        rig: The rig.
        states: Course of the model itself, shape (samples, states).
        rates: Its derivatives, the same shape.
        inputs: Course of the inputs, shape (samples, inputs).
        rng: For signs.
    """
    found: list[Effect] = []
    for state, role in rig.targets.items():
        s = float(np.sqrt(np.mean((states[:, state] - states[0, state]) ** 2)))
        r = float(np.sqrt(np.mean(rates[:, state] ** 2)))
        found += [Effect(n, state, a, (n, *_SAME.get(n, ()))) for n, a in _laws(role, state, states, s, r, rng).items()]
    return found


#: Law to others that say the same of these rigs.
_SAME: Mapping[str, tuple[str, ...]] = {
    "constant_force": ("input_offset",),
    "steady_inflow": ("input_offset",),
    "free_outflow": ("rate_signed_square",),
}


def _laws(role: str, state: int, states: Array, s: float, r: float, rng: np.random.Generator) -> Mapping[str, Added]:
    if role == "velocity":
        size = float(np.sqrt(np.mean(states[:, state - 1] ** 2)))
        sign, width = float(rng.choice([-1.0, 1.0])), 0.02 * s
        x_ = state - 1
        return {
            "dry_friction": lambda x, u: -0.15 * r * float(np.tanh(x[state] / width)),
            "quadratic_drag": lambda x, u: -0.25 * r * float(abs(x[state]) * x[state]) / s**2,
            "constant_force": lambda x, u: 0.15 * r,
            "cubic_spring": lambda x, u: -sign * 0.12 * r * float(x[x_] / size) ** 3,
            "quadratic_spring": lambda x, u: -0.15 * r * float(x[x_] / size) ** 2,
            "upper_stop": lambda x, u: -3.0 * r * max(float(x[x_]) / size - 0.8, 0.0),
        }
    if role == "speed":
        return {
            "dry_friction": lambda x, u: -0.1 * r * float(np.tanh(x[state] / (0.02 * s))),
            "quadratic_drag": lambda x, u: -0.15 * r * float(abs(x[state]) * x[state]) / s**2,
        }
    if role == "current":
        return {"contact_drop": lambda x, u: -0.1 * r * float(np.tanh(x[state] / (0.02 * s)))}
    if role == "level":
        top = float(np.max(np.abs(states[:, state])))
        return {
            "free_outflow": lambda x, u: -0.4 * r * float(np.sqrt(max(x[state], 0.0) / top)),
            "steady_inflow": lambda x, u: 0.3 * r,
        }
    rise = float(np.max(states[:, state]) - np.min(states[:, state])) or 1.0
    return {
        "radiation": lambda x, u: -0.5 * r * float(x[state] ** 4 - u[1] ** 4) / (4.0 * 293.0**3 * rise),
        "natural_convection": lambda x, u: (
            -0.5 * r * float(np.sign(x[state] - u[1]) * abs((x[state] - u[1]) / rise) ** 1.25)
        ),
    }


def composed(rig: Rig, states: Array, rates: Array, rng: np.random.Generator) -> Effect:
    """A law that no library has: a power that is none of a series, a threshold or a saturation of a state."""
    state = int(rng.choice(list(rig.targets)))
    names: Sequence[int] = [state, *([state - 1] if rig.targets[state] == "velocity" else [])]
    over = int(rng.choice(names))
    middle = float(np.mean(states[:, over]))
    size = float(np.std(states[:, over])) or 1.0
    r = float(np.sqrt(np.mean(rates[:, state] ** 2)))
    kind = int(rng.integers(3))
    power, sign = float(rng.uniform(1.4, 2.6)), float(rng.choice([-1.0, 1.0])) if over != state else -1.0

    def added(x: Array, u: Array) -> float:
        z = (float(x[over]) - middle) / size
        if kind == 0:
            return sign * 0.2 * r * float(np.sign(z) * abs(z) ** power)
        if kind == 1:
            return sign * 0.3 * r * max(abs(z) - 0.7, 0.0) * float(np.sign(z))
        return sign * 0.3 * r * float(np.tanh(2.0 * z))

    return Effect("", state, added, ())
