"""How a unit that is driven alone answers an unknown input at its equation: linear, as the equations are in it."""

from __future__ import annotations

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.locate.course import Course


def heat_response(course: Course, coil: int, times: Array) -> Array:
    """Temperature of a coil [K] at sample times per heat flow [W] in each step, shape (samples, steps).

    The heat balance C dT/dt = P - hA (T - T_ambient) + u is linear in u; its exact solution over a step in which u and
    the loss stand still is a sum of exponentials.

    Args:
        course: What happens.
        coil: Number of the coil, from 0.
        times: Sample times [s], shape (samples,).
    """
    rate, begin = course.loss[:, coil], course.time[:-1]
    decades = np.concatenate([[0.0], np.cumsum(rate * course.size)])  # how often the excess has fallen by e
    at = np.interp(times, course.time, decades)
    end = np.clip(times[:, None], begin, course.time[1:])
    spent = end - begin
    after = np.maximum(at[:, None] - (decades[:-1] + rate * spent), 0.0)
    grown = -np.expm1(-rate * spent) / np.maximum(rate, 1e-30)
    return np.asarray(np.exp(-after) * np.where(rate > 1e-12, grown, spent) / course.capacity[coil])


def instant_response(gain: Array, course: Course, times: Array) -> Array:
    """Response of an equation without memory: at each sample the gain of its step, shape (samples, steps).

    Args:
        gain: Output per input in each step, shape (steps,).
        course: What happens.
        times: Sample times [s], shape (samples,).
    """
    return np.asarray(interpolation(times, course) * gain)


def interpolation(times: Array, course: Course) -> Array:
    """Weights with which means over steps stand for values at sample times, shape (samples, steps).

    Linear between the middles of two steps, never across a jump of the supply: there the own step stands.
    """
    middle = course.middle
    own = np.clip(np.searchsorted(course.time, times, side="left") - 1, 0, len(middle) - 1)
    other = np.clip(np.where(times > middle[own], own + 1, own - 1), 0, len(middle) - 1)
    distance = np.where(other == own, 1.0, np.abs(middle[other] - middle[own]))
    weight = np.where(other == own, 0.0, np.clip(np.abs(times - middle[own]) / distance, 0.0, 1.0))
    later = np.maximum(own, other)
    weight = np.where(course.since_switch[later] < course.size[later], 0.0, weight)
    found = np.zeros((len(times), len(middle)))
    rows = np.arange(len(times))
    found[rows, own] = 1.0 - weight
    found[rows, other] += weight
    return found


def spread(samples: Array, course: Course) -> Array:
    """Weights with which samples stand for the steps of a course, shape (steps, samples): linear between samples.

    A recorded input is known at its samples alone; between them it is joined, before the first and after the last held.

    Args:
        samples: Sample times [s], rising, shape (samples,).
        course: What happens.
    """
    middle = course.middle
    after = np.clip(np.searchsorted(samples, middle), 0, len(samples) - 1)
    before = np.maximum(after - 1, 0)
    width = samples[after] - samples[before]
    share = np.clip((middle - samples[before]) / np.where(width > 0, width, 1.0), 0.0, 1.0)
    share = np.where(width > 0, share, 1.0)
    found = np.zeros((len(middle), len(samples)))
    rows = np.arange(len(middle))
    found[rows, before] += 1.0 - share
    found[rows, after] += share
    return found
