"""A network in the derivative, fitted to the readings through the simulation.

Chen, Rubanova, Bettencourt, Duvenaud, Neural Ordinary Differential Equations, NeurIPS 2018; here beside known
equations, over windows that begin at estimated states (multiple shooting).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from cosim.unit.protocol import Array
from evaluation.systems.others.data import ENDS, Data, Learnt
from evaluation.systems.others.methods import Scaled
from evaluation.systems.rigs import Rig

#: Samples of a window, neurons, steps of Adam and their size.
LENGTH, NEURONS, ITERATIONS, RATE = 40, 16, 600, 5e-3
#: Deviations of the noise beyond which a misfit counts no more than linearly.
HUBER = 5.0


def neural_ode(rig: Rig, training: Sequence[Data]) -> tuple[Learnt, int]:
    """What the network adds to the derivatives of the targets; it has no terms."""
    import jax

    jax.config.update("jax_enable_x64", True)
    jnp: Any = jax.numpy
    targets, outputs = list(rig.targets), list(rig.outputs.values())
    x = np.concatenate([d.features for d in training])
    to, out = Scaled.of(x), np.maximum(np.concatenate([d.learnt for d in training]).std(axis=0), 1e-12)
    begins, inputs, readings = _windows(training)
    noise = training[0].noise
    code = compile(rig.source, rig.name, "eval")

    def added(weights: Any, y: Any, u: Any) -> Any:
        z = (jnp.concatenate([y, u]) - to.middle) / to.size
        first, offset, second = weights
        return out * (jnp.tanh(z @ first + offset) @ second)

    def rate(weights: Any, y: Any, u: Any) -> Any:
        found = jnp.stack(eval(code, {**rig.numbers, "x": y, "u": u}))
        return found.at[jnp.array(targets)].add(added(weights, y, u))

    def window(weights: Any, begin: Any, driven: Any) -> Any:
        def step(y: Any, u: Any) -> Any:
            h = rig.step
            a = rate(weights, y, u)
            b = rate(weights, y + 0.5 * h * a, u)
            c = rate(weights, y + 0.5 * h * b, u)
            y = y + h / 6.0 * (a + 2.0 * (b + c) + rate(weights, y + h * c, u))
            return y, y[jnp.array(outputs)]

        return jax.lax.scan(step, begin, driven)[1]

    def loss(weights: Any) -> Any:
        courses = jax.vmap(lambda b, u: window(weights, b, u))(begins, inputs)
        misfit = jnp.abs((courses - readings) / noise)
        small = jnp.minimum(misfit, HUBER)
        return jnp.mean(small**2 + 2.0 * HUBER * (misfit - small))

    slope = jax.jit(jax.grad(loss))
    weights = _fitted(slope, x.shape[1], len(targets))

    def learnt(values: Array) -> Array:
        first, offset, second = weights
        return np.asarray(out * (np.tanh(to(values) @ first + offset) @ second))

    return learnt, 0


def _windows(training: Sequence[Data]) -> tuple[Array, Array, Array]:
    """States at the begin, inputs and the readings that follow, of every window."""
    begins, inputs, readings = [], [], []
    for data in training:
        for begin in range(ENDS, len(data.states) - LENGTH - ENDS, LENGTH):
            begins.append(data.states[begin])
            inputs.append(data.inputs[begin : begin + LENGTH])
            readings.append(data.readings[begin + 1 : begin + 1 + LENGTH])
    return np.array(begins), np.array(inputs), np.array(readings)


def _fitted(slope: Any, variables: int, targets: int) -> list[Array]:
    """Weights by Adam (Kingma and Ba, 2015)."""
    rng = np.random.default_rng(0)
    weights = [rng.normal(0.0, variables**-0.5, (variables, NEURONS)), np.zeros(NEURONS), np.zeros((NEURONS, targets))]
    mean, square = [np.zeros_like(w) for w in weights], [np.zeros_like(w) for w in weights]
    for number in range(1, ITERATIONS + 1):
        for i, g in enumerate(np.asarray(s) for s in slope(weights)):
            g = np.nan_to_num(g)
            mean[i], square[i] = 0.9 * mean[i] + 0.1 * g, 0.999 * square[i] + 0.001 * g**2
            step = mean[i] / (1.0 - 0.9**number) / (np.sqrt(square[i] / (1.0 - 0.999**number)) + 1e-8)
            weights[i] = weights[i] - RATE * step
    return weights
