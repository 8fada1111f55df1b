"""Composed torques on the pendulum's arm, and how strong they must be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import numpy as np

from evaluation.proving.composed.law import Law, Scale, drawn_law
from evaluation.proving.composed.search import NoLaw, Wanted, amount_of, strength_of
from evaluation.proving.composed.strength import LEAST_IN_TRAINING, LEFT, Left
from evaluation.proving.pendulum.arm import Arm, Torque
from evaluation.proving.rig import Array

#: Size of the amplitude that is looked for [N m].
AMPLITUDES = (3e-6, 2e-2)
#: Step of the swings that are compared [s]; Stoermer and Verlet, so 0.1 mrad after 15 swings.
_STEP = 2e-3
#: How far a recalibration may move the ratio of weight moment to inertia: one standard deviation, relative.
_RATIO_PRIOR = 0.04
_STEPS = (1e-4, 1e-4, 1e-3)  # of finite differences: ratio, angle [rad], angular velocity [rad/s]
_ITERATIONS = 5
_TRIES = 40

#: Angle [rad] and angular velocity [rad/s] at the start.
Start = tuple[float, float]


@dataclass(frozen=True)
class ComposedTorque:
    """A composed law of the torque.

    Args:
        law: Composition with its amplitude [N m].
        left: What a recalibration leaves.
    """

    law: Law
    left: Left

    def fresh(self) -> Torque:
        """The torque, with its memories at their begin."""
        law, last = deepcopy(self.law), 0.0

        def torque(time: float, angle: float, speed: float) -> float:
            nonlocal last
            values = {n: np.float64(v) for n, v in (("angle", angle), ("rate", speed), ("time", time))}
            if time <= 0.0:
                last = 0.0
                return float(law.reset(values))  # type: ignore[arg-type]  # a number is an array of no axes
            size, last = max(time - last, 0.0), time
            return float(law.moved(values, size))  # type: ignore[arg-type]

        return torque

    def finding(self) -> dict[str, Any]:
        """For the answer."""
        parameters = {
            "amplitude": self.law.amplitude,
            "left_held_out": self.left.held_out,
            "left_training": self.left.training,
        }
        return {
            "effect": "composed",
            "unit": "mechanical",
            "is_in_catalogue": False,
            "is_hidden": False,
            "strength": strength_of(self.left),
            "place": "component",
            "elements": ["arm"],
            "channels": [],
            "law": "torque = " + self.law.formula(),
            "parameters": parameters,
            "comparable_parameters": [],
            "intervals": None,
        }


def drawn_torque(
    arm: Arm, starts: Sequence[Start], noise: float, span: tuple[float, float], rng: np.random.Generator
) -> ComposedTorque:
    """A composed torque of which a recalibration leaves between `LEFT`.

    Args:
        arm: Without it.
        starts: Of all recordings, the last one held out.
        noise: Of the encoder with its rounding [rad].
        span: Length of a recording and interval of its readings [s].
        rng: Source of draws.

    Raises:
        NoLaw: None of many compositions can be made strong enough.
    """
    scales = _scales(arm, starts, span)
    for _ in range(_TRIES):
        law = drawn_law(scales, span[0], rng)
        wanted = Wanted.drawn(rng)
        amounts = np.geomspace(*AMPLITUDES, 12).tolist()
        found = amount_of(amounts, left(arm, law, starts, (noise, *span), amounts), wanted)
        for _ in range(3):
            if found is None:
                break
            (here,) = left(arm, law, starts, (noise, *span), [found])
            if LEFT[0] * 1.05 <= here.held_out <= LEFT[1] * 0.95 and here.training >= LEAST_IN_TRAINING:
                return ComposedTorque(Law(law.terms, law.amplitude * found), here)
            found = wanted.corrected(found, here)
    raise NoLaw("no composed torque is strong enough")


def _scales(arm: Arm, starts: Sequence[Start], span: tuple[float, float]) -> dict[str, Scale]:
    """By what the plain arm does in training."""
    angles, speeds = _swings(arm, starts[0], [1.0], span)
    return {
        "angle": Scale("angle", math.pi, float(np.abs(angles - math.pi).max()), True),
        "rate": Scale("w", 0.0, float(np.abs(speeds).max()), True),
        "time": Scale("t", 0.0, span[0]),
    }


def left(
    arm: Arm, law: Law, starts: Sequence[Start], seen: tuple[float, float, float], amounts: Sequence[float]
) -> list[Left]:
    """What recalibrations leave of a law times each of these amounts.

    Fitted are the ratio of weight moment to inertia and every start, by Gauss and Newton; the held-out recording has
    the ratio of training and a start of its own.

    Args:
        arm: Without the law.
        law: Of the torque.
        starts: Of all recordings, the last one held out.
        seen: Noise [rad], length of a recording [s], interval of its readings [s].
        amounts: Factors on the law.
    """
    noise, *span = seen
    count = len(amounts)
    data = [_swings(arm, s, [1.0] * count, (span[0], span[1]), law, amounts)[0] / noise for s in starts]
    ratio = np.zeros(count)
    offsets = np.zeros((len(starts), 2, count))
    for _ in range(_ITERATIONS):
        normal, right = np.zeros((count, 1)), np.zeros((count, 1))
        pieces = []
        for start, wanted, offset in zip(starts[:-1], data[:-1], offsets):
            rest, columns = _linear(arm, start, ratio, offset, wanted, (noise, span[0], span[1]))
            pieces.append((rest, columns))
            # The starts of this recording are eliminated: what is left of the ratio's column beside theirs.
            alone = _beside(columns[:, 0], columns[:, 1:])
            normal[:, 0] += np.sum(alone**2, axis=0)
            right[:, 0] += np.sum(alone * rest, axis=0)
        prior = 1.0 / _RATIO_PRIOR**2
        step = (right[:, 0] - prior * ratio) / (normal[:, 0] + prior)
        ratio = ratio + step
        for n, (rest, columns) in enumerate(pieces):
            offsets[n] += _fitted(columns[:, 1:], rest - columns[:, 0] * step)
    for _ in range(_ITERATIONS):
        rest, columns = _linear(arm, starts[-1], ratio, offsets[-1], data[-1], (noise, span[0], span[1]))
        offsets[-1] += _fitted(columns[:, 1:], rest)
    rests = [
        wanted - _moved(arm, start, ratio, offset, (span[0], span[1])) / noise
        for start, wanted, offset in zip(starts, data, offsets)
    ]
    training = np.mean(np.concatenate(rests[:-1]) ** 2, axis=0)
    held_out = np.mean(rests[-1] ** 2, axis=0)
    return [Left(1.0 + float(t), 1.0 + float(h)) for t, h in zip(training, held_out)]


def _moved(arm: Arm, start: Start, ratio: Array, offset: Array, span: tuple[float, float]) -> Array:
    """Angles of arms without the law, each with its ratio and start, shape (samples, arms)."""
    return _swings(arm, (start[0] + offset[0], start[1] + offset[1]), np.exp(ratio), span)[0]


def _linear(
    arm: Arm, start: Start, ratio: Array, offset: Array, wanted: Array, seen: tuple[float, float, float]
) -> tuple[Array, Array]:
    """Residuals, shape (samples, arms), and their columns by ratio, angle and speed, shape (samples, 3, arms)."""
    noise, stop, interval = seen
    count = ratio.size
    ratios = np.concatenate([ratio, ratio + _STEPS[0], ratio, ratio])
    angles = np.concatenate([offset[0], offset[0], offset[0] + _STEPS[1], offset[0]])
    speeds = np.concatenate([offset[1], offset[1], offset[1], offset[1] + _STEPS[2]])
    found = _moved(arm, start, ratios, np.stack([angles, speeds]), (stop, interval)) / noise
    plain, *others = (found[:, n * count : (n + 1) * count] for n in range(4))
    columns = np.stack([(o - plain) / s for o, s in zip(others, _STEPS)], axis=1)
    return wanted - plain, columns


def _fitted(columns: Array, rest: Array) -> Array:
    """Least squares of two columns for every arm, shape (2, arms)."""
    normal = np.einsum("sik,sjk->kij", columns, columns) + 1e-9 * np.eye(columns.shape[1])
    return np.asarray(np.linalg.solve(normal, np.einsum("sik,sk->ki", columns, rest)[..., None])[..., 0].T)


def _beside(one: Array, others: Array) -> Array:
    """What of a column the others cannot make."""
    return np.asarray(one - np.einsum("sik,ik->sk", others, _fitted(others, one)))


def _swings(
    arm: Arm,
    start: tuple[float | Array, float | Array],
    ratios: Sequence[float] | Array,
    span: tuple[float, float],
    law: Law | None = None,
    amounts: Sequence[float] = (),
) -> tuple[Array, Array]:
    """Angles and speeds of arms side by side at the instants of readings, shape (samples, arms)."""
    stop, interval = span
    weight = arm.moment / arm.inertia * np.asarray(ratios)
    count = weight.size
    angle, speed = (np.broadcast_to(np.asarray(s, dtype=np.float64), count).copy() for s in start)
    factors = np.asarray(amounts) / arm.inertia
    copied = deepcopy(law)

    def pull(time: float, size: float) -> Array:
        found = weight * np.sin(angle)
        if copied is None:
            return found
        values = {"angle": angle, "rate": speed, "time": np.full(count, time)}
        given = copied.reset(values) if size == 0.0 else copied.moved(values, size)
        return np.asarray(found + factors * given)

    steps = round(interval / _STEP)
    dt = interval / steps
    angles, speeds = [angle.copy()], [speed.copy()]
    speed += 0.5 * dt * pull(0.0, 0.0)
    for n in range(round(stop / interval)):
        for k in range(steps):
            angle += dt * speed
            speed += dt * pull((n * steps + k + 1) * dt, dt)
        angles.append(angle.copy())
        speeds.append(speed.copy())
    return np.array(angles), np.array(speeds)
