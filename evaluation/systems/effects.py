"""Effects that are concealed in the truth, sized by what the model's own terms do."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from evaluation.systems.rigs import Rig

#: Rate that is added to one state, from all states, all inputs and the effect's own state.
Added = Callable[[Array, Array, float], float]
#: Derivative of an effect's own state, from the same.
Rate = Callable[[Array, Array, float], float]
#: What an actuator makes of its command: course with a value at every step and time between two steps [s], to course.
Passed = Callable[[Array, float], Array]


@dataclass(frozen=True)
class Effect:
    """One effect at one place.

    Args:
        name: Of the law as the library calls it; empty: it has none there.
        place: Component with its state or input.
        answers: Identifiers that name it rightly.
        state: Index of the state whose derivative it is added to.
        added: What is added.
        own_rate: Derivative of a state of its own.
        own_start: That state at the start.
        port: Index of the input that it changes, where it is one of an actuator.
        passed: What the actuator makes of it.
    """

    name: str
    place: str
    answers: tuple[str, ...]
    state: int = -1
    added: Added | None = None
    own_rate: Rate | None = None
    own_start: float = 0.0
    port: int = -1
    passed: Passed | None = None


#: Law to others that say the same of these rigs.
SAME: Mapping[str, tuple[str, ...]] = {
    "constant_force": ("input_offset",),
    "steady_inflow": ("input_offset",),
    "input_offset": ("constant_force", "steady_inflow"),
    "free_outflow": ("rate_signed_square",),
}
#: Effects inside that are the same as one at the input.
AT_INPUT = ("constant_force", "steady_inflow")


@dataclass(frozen=True)
class Course:
    """The model itself over a recording, from which effects take their sizes.

    Args:
        states: Shape (samples, states).
        rates: Their derivatives, the same shape.
        inputs: Shape (samples, inputs).
    """

    states: Array
    rates: Array
    inputs: Array

    def size(self, state: int) -> float:
        """How far a state moves."""
        return float(np.sqrt(np.mean((self.states[:, state] - self.states[0, state]) ** 2)))

    def rate(self, state: int) -> float:
        """How fast it changes, per second."""
        return float(np.sqrt(np.mean(self.rates[:, state] ** 2)))


def effects_inside(rig: Rig, course: Course, rng: np.random.Generator) -> list[Effect]:
    """Effects at derivatives of states, each once, of all FMUs."""
    found: list[Effect] = []
    for state, role in rig.targets.items():
        laws = _laws(role, state, course.states, course.size(state), course.rate(state), rng)
        for name, law in laws.items():
            added = _without_own(law)
            found.append(Effect(name, rig.states[state], (name, *SAME.get(name, ())), state, added))
    return found


def _without_own(law: Callable[[Array, Array], float]) -> Added:
    return lambda x, u, z: law(x, u)


def _laws(
    role: str, state: int, states: Array, s: float, r: float, rng: np.random.Generator
) -> Mapping[str, Callable[[Array, Array], float]]:
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


# actuators


def effects_of_actuators(rig: Rig, course: Course) -> list[Effect]:
    """Effects at inputs that are driven, each once."""
    found = []
    for port, place in rig.driven().items():
        u = course.inputs[:, port]
        size, top, dwell = float(np.sqrt(np.mean(u**2))), float(np.max(np.abs(u))), rig.dwell * rig.step
        kinds: dict[str, Passed] = {
            "input_offset": _offset(0.12 * size),
            "input_saturation": _saturation(0.6 * top),
            "input_lag": _lag(dwell / 10.0),
            "input_dead_time": _dead_time(dwell / 10.0),
            "input_rate_limit": _rate_limit(top / (dwell / 4.0)),
        }
        if np.min(u) < 0.0:  # of a command that has one sign, both are offsets
            kinds |= {"input_dead_zone": _dead_zone(0.15 * size), "input_play": _play(0.12 * size)}
        found += [
            Effect(name, place, (name, *SAME.get(name, ())), port=port, passed=passed) for name, passed in kinds.items()
        ]
    return found


def _offset(amount: float) -> Passed:
    return lambda u, h: np.asarray(u + amount)


def _saturation(limit: float) -> Passed:
    return lambda u, h: np.clip(u, -limit, limit)


def _dead_zone(zone: float) -> Passed:
    return lambda u, h: np.asarray(np.sign(u) * np.maximum(np.abs(u) - zone, 0.0))


def _lag(time: float) -> Passed:
    def passed(u: Array, h: float) -> Array:
        found, now, keep = np.empty_like(u), float(u[0]), float(np.exp(-h / time))
        for i, value in enumerate(u):
            now = value + (now - value) * keep
            found[i] = now
        return found

    return passed


def _dead_time(time: float) -> Passed:
    def passed(u: Array, h: float) -> Array:
        late = round(time / h)
        return np.concatenate([np.full(late, u[0]), u[: len(u) - late]])

    return passed


def _rate_limit(limit: float) -> Passed:
    def passed(u: Array, h: float) -> Array:
        found, now = np.empty_like(u), float(u[0])
        for i, value in enumerate(u):
            now += float(np.clip(value - now, -limit * h, limit * h))
            found[i] = now
        return found

    return passed


def _play(half: float) -> Passed:
    def passed(u: Array, h: float) -> Array:
        found, now = np.empty_like(u), float(u[0])
        for i, value in enumerate(u):
            now = float(np.clip(now, value - half, value + half))
            found[i] = now
        return found

    return passed


# effects with a memory, and those at random


def with_memory(rig: Rig, course: Course, rng: np.random.Generator) -> Effect:
    """A hidden state beside a state: it follows behind a delay and pulls back.

    Where the library knows such a law, the answers name it.
    """
    state = int(rng.choice(list(rig.targets)))
    role = rig.targets[state]
    over = state - 1 if role == "velocity" else state
    size, r = course.size(over), course.rate(state)
    time = float(rng.uniform(0.5, 2.0)) * rig.dwell * rig.step / 4.0
    strength = 0.6 * r / size
    answers = {"velocity": ("maxwell_element",), "temperature": ("second_mass",)}.get(role, ())
    return Effect(
        "hidden_state",
        rig.states[state],
        answers,
        state,
        lambda x, u, z: -strength * (float(x[over]) - z),
        lambda x, u, z: (float(x[over]) - z) / time,
        float(course.states[0, over]),
    )


def composed(rig: Rig, course: Course, rng: np.random.Generator) -> Effect:
    """A law that no library has, put together at random: of one state, or the sum or product of two.

    Each part is a power that is none of a series, a threshold, a saturation, an exponential or a ripple, over states of
    the FMU and what drives it; now and then over a state behind a delay of its own.
    """
    state = int(rng.choice(list(rig.targets)))
    own = [i for i in range(len(rig.states)) if rig.component(i) == rig.component(state)]
    first, way = int(rng.choice(own)), str(rng.choice(["one", "one", "sum", "product"]))
    parts = [_part(course.states[:, first], rng)]
    places = [first]
    if way != "one":
        places.append(int(rng.choice(own)))
        parts.append(_part(course.states[:, places[1]], rng))
    r = course.rate(state)
    is_late = bool(rng.random() < 0.25)
    time = float(rng.uniform(0.5, 2.0)) * rig.dwell * rig.step / 4.0

    def plain(x: Array) -> float:
        values = [part(float(x[i])) for part, i in zip(parts, places)]
        return values[0] if way == "one" else values[0] + values[1] if way == "sum" else values[0] * values[1]

    values = np.array([plain(x) for x in course.states])
    scale = 0.25 * r / (float(np.std(values)) or 1.0)
    # A power of the state itself that pushes it away would throw the rig out.
    sign = -1.0 if first == state else float(rng.choice([-1.0, 1.0]))
    if is_late:
        return Effect(
            "",
            rig.states[state],
            (),
            state,
            lambda x, u, z: sign * scale * z,
            lambda x, u, z: (plain(x) - z) / time,
            float(values[0]),
        )
    return Effect("", rig.states[state], (), state, lambda x, u, z: sign * scale * plain(x))


def _part(values: Array, rng: np.random.Generator) -> Callable[[float], float]:
    """A function of one state, counted from its middle in standard deviations."""
    middle, size = float(np.mean(values)), float(np.std(values)) or 1.0
    kind, power = int(rng.integers(5)), float(rng.uniform(1.4, 2.6))
    shapes: Sequence[Callable[[float], float]] = (
        lambda z: float(np.sign(z) * abs(z) ** power),
        lambda z: max(abs(z) - 0.7, 0.0) * float(np.sign(z)),
        lambda z: float(np.tanh(2.0 * z)),
        lambda z: float(np.exp(np.clip(0.8 * z, -5.0, 5.0))) - 1.0,
        lambda z: float(np.sin(power * z)),
    )
    shape = shapes[kind]
    return lambda x: shape((x - middle) / size)
