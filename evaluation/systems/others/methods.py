"""Methods that learn what the equations leave of the derivatives, as a function of states and inputs."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from evaluation.systems.others.data import Data, Learnt, free_run
from evaluation.systems.rigs import Rig

#: Samples that a Gaussian process or a symbolic regression is given: both grow fast with their number.
FEW = 300
#: Thresholds of sparse regression, of variables of deviation 1.
THRESHOLDS = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5)


@dataclass(frozen=True)
class Scaled:
    """Variables of middle 0 and deviation 1."""

    middle: Array
    size: Array

    @classmethod
    def of(cls, values: Array) -> Scaled:
        """From data."""
        return cls(values.mean(axis=0), np.maximum(values.std(axis=0), 1e-12))

    def __call__(self, values: Array) -> Array:
        return np.asarray((values - self.middle) / self.size)

    def back(self, values: Array) -> Array:
        """From scaled values."""
        return np.asarray(values * self.size + self.middle)


def _library(z: Array) -> Array:
    """Polynomials of degree 3, signs and signed squares, shape (points, terms)."""
    count = z.shape[1]
    columns = [np.ones(len(z))]
    columns += [z[:, i] for i in range(count)]
    columns += [z[:, i] * z[:, j] for i in range(count) for j in range(i, count)]
    columns += [z[:, i] * z[:, j] * z[:, k] for i in range(count) for j in range(i, count) for k in range(j, count)]
    columns += [np.tanh(20.0 * z[:, i]) for i in range(count)]
    columns += [np.abs(z[:, i]) * z[:, i] for i in range(count)]
    return np.stack(columns, axis=1)


def sparse(rig: Rig, training: Sequence[Data]) -> tuple[Learnt, int]:
    """Sparse regression, and its number of terms."""
    import pysindy

    x, y = (np.concatenate([getattr(d, n) for d in training]) for n in ("features", "learnt"))
    # Signs are about 0 and not about a middle: variables are divided by their size alone.
    to = Scaled(np.zeros(x.shape[1]), np.maximum(np.sqrt(np.mean(x**2, axis=0)), 1e-12))
    out = np.maximum(y.std(axis=0), 1e-12)
    best: tuple[float, Learnt, int] | None = None
    for threshold in THRESHOLDS:
        model = pysindy.STLSQ(threshold=threshold)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            model.fit(_library(to(x)), y / out)
        weights = np.atleast_2d(model.coef_).copy()

        def learnt(values: Array, weights: Array = weights) -> Array:
            return np.asarray((_library(to(values)) @ weights.T) * out)

        error = free_run(rig, learnt, training[-1])
        if best is None or error < best[0]:
            best = error, learnt, int(np.count_nonzero(weights))
    assert best is not None
    return best[1], best[2]


def _few(training: Sequence[Data]) -> tuple[Array, Array]:
    x, y = (np.concatenate([getattr(d, n) for d in training]) for n in ("features", "learnt"))
    pick = np.random.default_rng(0).choice(len(x), min(FEW, len(x)), replace=False)
    return x[pick], y[pick]


def gaussian_process(rig: Rig, training: Sequence[Data]) -> tuple[Learnt, int]:
    """A Gaussian process for each target; it has no terms."""
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

    x, y = _few(training)
    to, out = Scaled.of(x), Scaled.of(y)
    weights, lengths, sizes = [], [], []
    for column in out(y).T:
        kernel = ConstantKernel(1.0) * RBF(np.ones(x.shape[1]), (0.05, 100.0)) + WhiteKernel(0.1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            model = GaussianProcessRegressor(kernel).fit(to(x), column)
        weights.append(np.ravel(model.alpha_))
        lengths.append(np.broadcast_to(model.kernel_.k1.k2.length_scale, x.shape[1]))
        sizes.append(float(model.kernel_.k1.k1.constant_value))
    points = to(x)

    def learnt(values: Array) -> Array:
        z, found = to(values), []
        for weight, length, size in zip(weights, lengths, sizes):
            distance = (((z[:, None] - points[None]) / length) ** 2).sum(axis=2)
            found.append(size * np.exp(-0.5 * distance) @ weight)
        return out.back(np.stack(found, axis=1))

    return learnt, 0


def neural(rig: Rig, training: Sequence[Data]) -> tuple[Learnt, int]:
    """A small network; it has no terms."""
    from sklearn.neural_network import MLPRegressor

    x, y = (np.concatenate([getattr(d, n) for d in training]) for n in ("features", "learnt"))
    to, out = Scaled.of(x), Scaled.of(y)
    model = MLPRegressor(
        hidden_layer_sizes=(16, 16), activation="tanh", solver="lbfgs", alpha=1e-3, max_iter=400, random_state=0
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model.fit(to(x), out(y) if y.shape[1] > 1 else out(y).ravel())
    layers = list(zip(model.coefs_, model.intercepts_))

    def learnt(values: Array) -> Array:
        z = to(values)
        for number, (weights, offset) in enumerate(layers):
            z = z @ weights + offset
            if number < len(layers) - 1:
                z = np.tanh(z)
        return out.back(np.asarray(z))

    return learnt, 0


def symbolic(rig: Rig, training: Sequence[Data]) -> tuple[Learnt, int]:
    """A formula for each target by genetic programming, and the number of their nodes."""
    from gplearn.genetic import SymbolicRegressor

    x, y = _few(training)
    to, out = Scaled.of(x), Scaled.of(y)
    programs = []
    for column in out(y).T:
        model = SymbolicRegressor(
            population_size=600,
            generations=12,
            parsimony_coefficient=0.002,
            random_state=0,
            function_set=("add", "sub", "mul", "div", "abs", "neg", "sqrt", "tan"),
        )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            programs.append(model.fit(to(x), column)._program)

    def learnt(values: Array) -> Array:
        z = to(values)
        return out.back(np.stack([p.execute(z) for p in programs], axis=1))

    return learnt, sum(len(p.program) for p in programs)
