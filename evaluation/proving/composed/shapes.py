"""What a composed law is made of: functions of one dimensionless variable, and memories of what they gave.

A variable is of the order of 1. Functions: power, exponential, saturation, threshold, smooth step, bell. Memories:
relay and play (hysteresis), dead time, first-order lag, accumulation, change, resonance, and a relaxation that is not
linear. Numbers are drawn from ranges, so that no composition is the same as another, nor as a law of a library but by
chance.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from dataclasses import dataclass, field

import numpy as np

from evaluation.proving.rig import Array


class Stage(ABC):
    """One link of a chain; with or without a state of its own."""

    @abstractmethod
    def formula(self, inner: str) -> str:
        """As text, of what `inner` gives."""

    def reset(self, value: Array) -> Array:
        """The output at the start, where `value` comes in."""
        return self.moved(value, 0.0)

    @abstractmethod
    def moved(self, value: Array, size: float) -> Array:
        """The output after a time [s] at whose end `value` comes in."""


@dataclass
class Power(Stage):
    """Sign and power."""

    exponent: float

    def formula(self, inner: str) -> str:
        return f"sign({inner}) * abs({inner})**{self.exponent:.4g}"

    def moved(self, value: Array, size: float) -> Array:
        return np.asarray(np.sign(value) * np.abs(value) ** self.exponent)


@dataclass
class Exponential(Stage):
    """Exponential that is 0 at 0 and of size 1 at 1; its argument ends at 6."""

    rate: float

    def formula(self, inner: str) -> str:
        return f"(exp({self.rate:.4g} * {inner}) - 1) / {np.expm1(abs(self.rate)):.4g}"

    def moved(self, value: Array, size: float) -> Array:
        return np.asarray(np.expm1(np.minimum(self.rate * value, 6.0)) / np.expm1(abs(self.rate)))


@dataclass
class Saturation(Stage):
    """Hyperbolic tangent."""

    width: float

    def formula(self, inner: str) -> str:
        return f"tanh({inner} / {self.width:.4g})"

    def moved(self, value: Array, size: float) -> Array:
        return np.asarray(np.tanh(value / self.width))


@dataclass
class Threshold(Stage):
    """What lies beyond a threshold; 1 at 1."""

    onset: float

    def formula(self, inner: str) -> str:
        return f"max({inner} - {self.onset:.4g}, 0) / {1.0 - self.onset:.4g}"

    def moved(self, value: Array, size: float) -> Array:
        return np.asarray(np.maximum(value - self.onset, 0.0) / (1.0 - self.onset))


@dataclass
class SmoothStep(Stage):
    """From 0 to 1 about a threshold."""

    onset: float
    width: float

    def formula(self, inner: str) -> str:
        return f"1 / (1 + exp(-({inner} - {self.onset:.4g}) / {self.width:.4g}))"

    def moved(self, value: Array, size: float) -> Array:
        return np.asarray(0.5 * (1.0 + np.tanh(0.5 * (value - self.onset) / self.width)))


@dataclass
class Bell(Stage):
    """1 at a value, 0 away from it."""

    centre: float
    width: float

    def formula(self, inner: str) -> str:
        return f"exp(-(({inner} - {self.centre:.4g}) / {self.width:.4g})**2)"

    def moved(self, value: Array, size: float) -> Array:
        return np.asarray(np.exp(-(((value - self.centre) / self.width) ** 2)))


@dataclass
class Relay(Stage):
    """0 until the upper threshold is passed, then 1 until the lower one is."""

    upper: float
    lower: float
    _is_on: Array = field(default_factory=lambda: np.zeros(1), repr=False)

    def formula(self, inner: str) -> str:
        return f"relay({inner}; on above {self.upper:.4g}, off below {self.lower:.4g})"

    def reset(self, value: Array) -> Array:
        self._is_on = np.where(value > self.upper, 1.0, 0.0)
        return self._is_on

    def moved(self, value: Array, size: float) -> Array:
        self._is_on = np.where(value > self.upper, 1.0, np.where(value < self.lower, 0.0, self._is_on))
        return self._is_on


@dataclass
class Play(Stage):
    """Backlash: follows when it is pushed by more than half a width."""

    width: float
    _stands: Array = field(default_factory=lambda: np.zeros(1), repr=False)

    def formula(self, inner: str) -> str:
        return f"play({inner}; width {self.width:.4g})"

    def reset(self, value: Array) -> Array:
        self._stands = np.asarray(value, dtype=np.float64)
        return self._stands

    def moved(self, value: Array, size: float) -> Array:
        self._stands = np.clip(self._stands, value - 0.5 * self.width, value + 0.5 * self.width)
        return self._stands


@dataclass
class DeadTime(Stage):
    """What came in some time ago."""

    delay: float
    _past: deque[tuple[float, Array]] = field(default_factory=deque, repr=False)

    def formula(self, inner: str) -> str:
        return f"delayed({inner}; by {self.delay:.4g} s)"

    def reset(self, value: Array) -> Array:
        self._past = deque([(0.0, np.asarray(value))])
        return np.asarray(value)

    def moved(self, value: Array, size: float) -> Array:
        now = self._past[-1][0] + size
        if size > 0.0:
            self._past.append((now, np.asarray(value)))
        wanted = now - self.delay
        while len(self._past) > 2 and self._past[1][0] <= wanted:
            self._past.popleft()
        first = self._past[0]
        if len(self._past) == 1 or wanted <= first[0]:
            return first[1]
        second = self._past[1]
        share = min((wanted - first[0]) / (second[0] - first[0]), 1.0)
        return np.asarray((1.0 - share) * first[1] + share * second[1])


@dataclass
class _Hidden(Stage):
    """A hidden state z."""

    tau: float
    _z: Array = field(default_factory=lambda: np.zeros(1), repr=False)

    def reset(self, value: Array) -> Array:
        self._z = np.asarray(value, dtype=np.float64)
        return self.moved(value, 0.0)


class Lag(_Hidden):
    """First-order lag."""

    def formula(self, inner: str) -> str:
        return f"lag({inner}; {self.tau:.4g} s)"

    def moved(self, value: Array, size: float) -> Array:
        self._z = value + (self._z - value) * np.exp(-size / self.tau)
        return self._z


class Change(_Hidden):
    """What a first-order lag has yet to go."""

    def formula(self, inner: str) -> str:
        return f"change({inner}; {self.tau:.4g} s)"

    def moved(self, value: Array, size: float) -> Array:
        self._z = value + (self._z - value) * np.exp(-size / self.tau)
        return np.asarray(value - self._z)


class Accumulation(_Hidden):
    """Integral over time."""

    def formula(self, inner: str) -> str:
        return f"integral({inner}; over {self.tau:.4g} s)"

    def reset(self, value: Array) -> Array:
        self._z = np.zeros_like(np.asarray(value, dtype=np.float64))
        return self._z

    def moved(self, value: Array, size: float) -> Array:
        self._z = self._z + value * size / self.tau
        return self._z


class Relaxation(_Hidden):
    """A state that follows with the square of its distance: d(z) = (x - z) * abs(x - z) / tau, in closed form."""

    def formula(self, inner: str) -> str:
        return f"relaxed({inner}; quadratic, {self.tau:.4g} s)"

    def moved(self, value: Array, size: float) -> Array:
        gap = self._z - value
        self._z = value + gap / (1.0 + np.abs(gap) * size / self.tau)
        return self._z


@dataclass
class Resonance(Stage):
    """A hidden oscillator that is driven; implicit midpoint, stable for any step."""

    rate: float
    damping: float
    _z: Array = field(default_factory=lambda: np.zeros(1), repr=False)
    _speed: Array = field(default_factory=lambda: np.zeros(1), repr=False)

    def formula(self, inner: str) -> str:
        return f"resonance({inner}; {self.rate:.4g} rad/s, damping {self.damping:.4g})"

    def reset(self, value: Array) -> Array:
        self._z = np.asarray(value, dtype=np.float64)
        self._speed = np.zeros_like(self._z)
        return self._z

    def moved(self, value: Array, size: float) -> Array:
        half = 0.5 * size
        square = self.rate**2
        pull = square * (value - self._z - half * self._speed) - 2.0 * self.damping * self.rate * self._speed
        kick = size * pull / (1.0 + 2.0 * self.damping * self.rate * half + square * half**2)
        self._z = self._z + size * (self._speed + 0.5 * kick)
        self._speed = self._speed + kick
        return self._z


def drawn_function(rng: np.random.Generator, is_signed: bool) -> Stage:
    """A function of one variable, drawn; thresholds lie within what the variable reaches."""
    low = -0.6 if is_signed else 0.15
    choices = (
        lambda: Power(_log_uniform(rng, 0.35, 3.6)),
        lambda: Exponential(float(rng.choice([-1.0, 1.0])) * _log_uniform(rng, 0.8, 3.5)),
        lambda: Saturation(_log_uniform(rng, 0.12, 0.7)),
        lambda: Threshold(float(rng.uniform(low, 0.75))),
        lambda: SmoothStep(float(rng.uniform(low, 0.75)), _log_uniform(rng, 0.03, 0.2)),
        lambda: Bell(float(rng.uniform(low, 0.85)), _log_uniform(rng, 0.1, 0.4)),
    )
    return choices[int(rng.integers(len(choices)))]()


def drawn_hysteresis(rng: np.random.Generator) -> Stage:
    """A relay or a play, drawn."""
    if rng.random() < 0.5:
        upper = float(rng.uniform(0.35, 0.8))
        return Relay(upper, upper - float(rng.uniform(0.1, 0.5)))
    return Play(float(rng.uniform(0.1, 0.6)))


def drawn_memory(rng: np.random.Generator, stop: float) -> Stage:
    """A memory, drawn; its times are shares of a recording's length [s]."""
    choices = (
        lambda: DeadTime(stop * _log_uniform(rng, 0.01, 0.08)),
        lambda: Lag(stop * _log_uniform(rng, 0.01, 0.3)),
        lambda: Change(stop * _log_uniform(rng, 0.01, 0.3)),
        lambda: Accumulation(stop * _log_uniform(rng, 0.2, 1.0)),
        lambda: Relaxation(stop * _log_uniform(rng, 0.005, 0.1)),
        lambda: Resonance(2.0 * np.pi / (stop * _log_uniform(rng, 0.03, 0.3)), _log_uniform(rng, 0.05, 0.5)),
    )
    return choices[int(rng.integers(len(choices)))]()


def _log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    return float(low * (high / low) ** rng.random())
