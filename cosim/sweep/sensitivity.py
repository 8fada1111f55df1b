"""Sobol' indices of outputs, by SALib (an optional extra)."""

from __future__ import annotations

import importlib
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cosim.unit.protocol import Array


@dataclass(frozen=True)
class Indices:
    """Shares of an output's variance.

    Args:
        first: First-order index of every key: what it explains alone.
        first_error: Half width of its 95 % interval.
        total: Total index: what would be left unexplained without it.
        total_error: Half width of its 95 % interval.
    """

    first: Array
    first_error: Array
    total: Array
    total_error: Array


def saltelli(count: int, keys: Sequence[str], seed: int) -> Array:
    """Saltelli's design, shape (count * (keys + 2), keys), between 0 and 1.

    Raises:
        ValueError: SALib is not installed.
    """
    sample = _salib("SALib.sample.sobol")
    return np.asarray(sample.sample(_problem(keys), count, calc_second_order=False, seed=seed), dtype=np.float64)


def sobol_indices(values: Array, keys: Sequence[str], seed: int) -> Indices | None:
    """Indices of one output; None where it does not vary.

    Args:
        values: Shape (count * (keys + 2),), in the order of the design.
        keys: Names of what was varied.
        seed: Of the bootstrap that gives the intervals.

    Source: A. Saltelli et al., Variance based sensitivity analysis of model output, Computer Physics Communications
    181 (2010) 259-270.
    """
    if not np.ptp(values) > 1e-12 * max(float(np.max(np.abs(values))), 1e-300):
        return None
    analyze = _salib("SALib.analyze.sobol")
    with warnings.catch_warnings():  # of its own use of pandas and numpy
        warnings.simplefilter("ignore")
        found = analyze.analyze(_problem(keys), values, calc_second_order=False, seed=seed, print_to_console=False)
    return Indices(*(np.asarray(found[n], dtype=np.float64) for n in ("S1", "S1_conf", "ST", "ST_conf")))


def _problem(keys: Sequence[str]) -> dict[str, Any]:
    return {"num_vars": len(keys), "names": list(keys), "bounds": [[0.0, 1.0]] * len(keys)}


def _salib(module: str) -> Any:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return importlib.import_module(module)
    except ImportError as error:
        raise ValueError("`indices` needs SALib: `pip install SALib`") from error
