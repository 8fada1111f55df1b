"""Scorecard of runs from several starts: medians and bands instead of single values."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from chainmail.measures import HIGH, LOW
from chainmail.reproduce.row import Row

#: Share of the starts in which a statement in words must hold.
HOLDS = 0.95


def starts_of(runs: Mapping[str, xr.Dataset]) -> list[int]:
    """Starts that every ensemble among the runs has; none where there is no ensemble."""
    found = [set(run["start"].values.tolist()) for run in runs.values() if "start" in run.dims]
    return sorted(set.intersection(*found)) if found else []


def rows_over_starts(
    runs: Mapping[str, xr.Dataset], rows_of: Callable[[Mapping[str, xr.Dataset]], list[Row]]
) -> list[Row]:
    """Rows of every start, put together; those of single runs where there is no ensemble.

    Start k of one scenario is taken with start k of the others.

    Args:
        runs: Name to results.
        rows_of: Rows of single runs.
    """
    starts = starts_of(runs)
    if not starts:
        return rows_of(runs)
    each = [rows_of({n: r.sel(start=s) if "start" in r.dims else r for n, r in runs.items()}) for s in starts]
    return [together(same) for same in zip(*each, strict=True)]


def together(rows: Sequence[Row]) -> Row:
    """One row of several starts: the median, with its band of 5 to 95 %.

    A number passes where the band reaches into the tolerance about the published value; a statement passes where it
    holds in at least 95 % of the starts. Values that no start changes have no band.
    """
    first, values = rows[0], np.array([r.ours for r in rows])
    if np.ptp(values) == 0.0:
        return replace(first, is_met=all(r.is_met for r in rows))
    low, middle, high = (float(q) for q in np.quantile(values, (LOW, 0.5, HIGH)))
    if first.target is None or first.tolerance is None:
        is_met = float(np.mean([r.is_met for r in rows])) >= HOLDS
    else:
        is_met = low <= first.target + first.tolerance and high >= first.target - first.tolerance
    return replace(first, ours=middle, is_met=bool(is_met), band=(low, high), starts=len(rows))
