"""From derivatives of the network's outputs to derivatives of whitened residuals."""

from __future__ import annotations

import ctypes
from pathlib import Path

import numpy as np
import numpy.typing as npt

from diagnosis.models.coil_network.kernel.compiler import load
from diagnosis.models.coil_network.kernel.layout import Array

_SOURCE = Path(__file__).resolve().parent / "whiten.c"


class Whitening:
    """Picks samples, divides them by the noise and takes the share of an unknown zero of each channel away.

    Residuals r of deviation 1 with a common zero of deviation s have the covariance I + s^2 1 1'; its inverse root
    takes the share 1 - 1 / sqrt(1 + n s^2) of the mean away.

    Args:
        pick: Numbers of the samples in the network's output, shape (samples,).
        weight: 1 / deviation, 0 where a sample does not count, shape (samples,).
        shares: Share of the sum of each series that is taken away, shape (series,).
        lengths: Samples of each series, shape (series,).

    Raises:
        CompilerError: There is no usable C compiler.
        ValueError: Lengths that do not fit each other.
    """

    def __init__(
        self, pick: npt.NDArray[np.int64], weight: Array, shares: Array, lengths: npt.NDArray[np.int64]
    ) -> None:
        #: Share of the sum of each series that is taken away, shape (series,).
        self.shares = shares
        self._pick = np.ascontiguousarray(pick, dtype=np.int64)
        self._weight = np.ascontiguousarray(weight, dtype=np.float64)
        self._shares = np.ascontiguousarray(shares, dtype=np.float64)
        self._lengths = lengths
        self._begin = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
        if not (len(self._pick) == len(self._weight) == self._begin[-1] and len(self._shares) == len(lengths)):
            raise ValueError(
                f"{len(self._pick)} samples, {len(self._weight)} weights, series of {self._begin[-1]} samples in all; "
                f"{len(lengths)} series, {len(self._shares)} shares"
            )
        self._function = load(_SOURCE.read_text()).whiten_slopes
        self._function.restype = None

    def values(self, rows: Array) -> Array:
        """Rows of residuals (in place), whitened: shape (sets, samples)."""
        sums = np.add.reduceat(rows, self._begin[:-1], axis=1)
        rows -= np.repeat(sums * self._shares, self._lengths, axis=1) * (self._weight > 0.0)
        return rows

    def slopes(
        self, slopes: Array, rows: int, into: npt.NDArray[np.int64] | None = None, factors: Array | None = None
    ) -> npt.NDArray[np.float32]:
        """Derivatives of residuals in single precision, shape (rows, samples).

        Args:
            slopes: Derivatives of outputs, shape (directions, out_size).
            rows: Rows of the result.
            into: Row to which each direction adds; None: its own.
            factors: What each direction is multiplied by; None: 1.

        Raises:
            ValueError: A row or a sample that there is not, or not one row and factor for each direction.
        """
        slopes = np.ascontiguousarray(slopes, dtype=np.float64)
        into = np.arange(len(slopes)) if into is None else np.ascontiguousarray(into, dtype=np.int64)
        factors = np.ones(len(slopes)) if factors is None else np.ascontiguousarray(factors, dtype=np.float64)
        if into.size and not (into.min() >= 0 and into.max() < rows):
            raise ValueError(f"rows {into.min()} to {into.max()} of {rows}")
        if not len(into) == len(factors) == len(slopes):
            raise ValueError(f"{len(slopes)} directions, {len(into)} rows, {len(factors)} factors")
        if self._pick.size and not (self._pick.min() >= 0 and self._pick.max() < slopes.shape[1]):
            raise ValueError(f"samples {self._pick.min()} to {self._pick.max()} of {slopes.shape[1]}")
        out = np.zeros((rows, len(self._pick)), dtype=np.float32)
        work = np.empty(len(self._pick))
        number, pointer = ctypes.c_int64, ctypes.c_void_p
        self._function(
            number(len(slopes)),
            number(slopes.shape[1]),
            pointer(slopes.ctypes.data),
            number(len(self._lengths)),
            pointer(self._begin.ctypes.data),
            pointer(self._pick.ctypes.data),
            pointer(self._weight.ctypes.data),
            pointer(self._shares.ctypes.data),
            pointer(into.ctypes.data),
            pointer(factors.ctypes.data),
            pointer(work.ctypes.data),
            pointer(out.ctypes.data),
        )
        return out
