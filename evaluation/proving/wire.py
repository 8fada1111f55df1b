"""Heat in wires resolved along their length: finite volumes, TR-BDF2, Newton with the tridiagonal Jacobian."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg.lapack import dgtsv

from evaluation.proving.rig import Array, Rig

#: Heat into every piece [W] and its derivative by the piece's temperature [W/K].
Balance = Callable[[Array], tuple[Array, Array]]
#: Heat stored in every piece [J] and its derivative [J/K].
Storage = Callable[[Array], tuple[Array, Array]]

_GAMMA = 2.0 - np.sqrt(2.0)  # both stages then have the same implicit weight
_WEIGHT = _GAMMA / 2.0
_TOLERANCE = 1e-6  # [K]
_MOST_ITERATIONS = 25


class WireError(Exception):
    """Newton's iteration did not converge: the effects of a case are too abrupt for its step."""


class Wires:
    """Wires side by side, each cut into pieces that are shorter towards its ends, where temperature changes fastest.

    Args:
        rig: Conduction, ends, capacities.
        cells: Pieces of each wire.
    """

    def __init__(self, rig: Rig, cells: int) -> None:
        self.shape = (rig.sheet.coils, cells)
        self.edges = 0.5 * (1.0 - np.cos(np.pi * np.arange(cells + 1) / cells))
        self.weight = np.diff(self.edges)  # share of each piece, shape (cells,)
        self.centre = 0.5 * (self.edges[1:] + self.edges[:-1])
        self.capacity = rig.capacity[:, None] * self.weight
        inner = rig.sheet.conduction / np.diff(self.centre)
        self._inner = np.broadcast_to(inner, (rig.sheet.coils, cells - 1))
        half = rig.sheet.conduction / (0.5 * self.weight[[0, -1]])
        self.to_pins = np.zeros(self.shape)
        for at, side in ((0, 0), (-1, 1)):
            self.to_pins[:, at] += rig.end * half[side] / (rig.end + half[side])
        self._upper = np.zeros(self.shape)
        self._upper[:, :-1] = self._inner
        self._off = self._upper.ravel()[:-1]
        self._diagonal = -self._upper.copy()
        self._diagonal[:, 1:] -= self._inner
        self._diagonal -= self.to_pins

    def conduction(self, temperature: Array, pins: Array) -> Array:
        """Heat into every piece from its neighbours and the pins [W]; `pins` [K] has shape (coils,)."""
        heat = self.to_pins * (pins[:, None] - temperature)
        flow = self._inner * np.diff(temperature, axis=1)
        heat[:, :-1] += flow
        heat[:, 1:] -= flow
        return heat

    def mean(self, values: Array) -> Array:
        """Mean over each wire, shape (coils,)."""
        return np.asarray(values @ self.weight)

    def at(self, position: Array, values: Array) -> Array:
        """Value of each wire at a position from 0 to 1, linear between the centres of pieces, shape (coils,)."""
        right = np.clip(np.searchsorted(self.centre, position), 1, max(self.shape[1] - 1, 1))
        row = np.arange(self.shape[0])
        if self.shape[1] == 1:
            return values[:, 0].copy()
        low, high = self.centre[right - 1], self.centre[right]
        share = np.clip((position - low) / (high - low), 0.0, 1.0)
        return np.asarray((1.0 - share) * values[row, right - 1] + share * values[row, right])

    def step(self, start: Array, size: float, pins: Array, balance: Balance, storage: Storage) -> Array:
        """Temperatures after a step.

        Args:
            start: At its begin [K], shape (coils, cells).
            size: [s]
            pins: Temperature of the pins at the ends [K], shape (coils,).
            balance: Heat from all but conduction.
            storage: Heat stored.

        Raises:
            WireError: No convergence.

        Source: Bank et al., IEEE Trans. CAD 4 (1985) 436-451; weights after Hosea and Shampine, Appl. Numer. Math. 20
        (1996) 21-37.
        """
        stored, capacity = storage(start)
        inflow = balance(start)[0] + self.conduction(start, pins)
        weight = _WEIGHT * size
        guess = start + 0.5 * size * inflow / capacity
        middle = self._solve(guess, stored + weight * inflow, weight, pins, (balance, storage))
        stored_middle = storage(middle)[0]
        share = 1.0 / (_GAMMA * (2.0 - _GAMMA))
        target = share * stored_middle + (1.0 - share) * stored
        return self._solve(2.0 * middle - start, target, weight, pins, (balance, storage))

    def _solve(self, guess: Array, target: Array, weight: float, pins: Array, laws: tuple[Balance, Storage]) -> Array:
        """T with storage(T) - weight * inflow(T) = target."""
        balance, storage = laws
        temperature = guess
        for _ in range(_MOST_ITERATIONS):
            heat, slope = balance(temperature)
            stored, capacity = storage(temperature)
            missing = target - stored + weight * (heat + self.conduction(temperature, pins))
            diagonal = capacity - weight * (self._diagonal + slope)
            off = -weight * self._off
            change, info = _tridiagonal(off, diagonal.ravel(), missing.ravel())
            temperature = temperature + change.reshape(self.shape)
            if info != 0 or not np.isfinite(change).all():
                break
            if np.max(np.abs(change)) < _TOLERANCE:
                return np.asarray(temperature)
        raise WireError("the temperatures of the wires did not converge; take smaller steps")


def _tridiagonal(off: Array, diagonal: Array, right: Array) -> tuple[Array, int]:
    """Solution of a symmetric tridiagonal system, and LAPACK's report: 0 if all is well."""
    if diagonal.size == 1:
        return right / diagonal, 0
    change, info = dgtsv(off, diagonal, off, right)[3:]
    return np.asarray(change), int(info)
