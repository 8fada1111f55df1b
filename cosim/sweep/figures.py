"""Figures of a sweep: lines, heat maps and distributions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from cosim.figure_style import figure, label_of, style_beside, with_degrees
from cosim.sweep.axes import Points
from cosim.sweep.sensitivity import Indices
from cosim.unit.protocol import Array

#: Kinds of axes along which runs scatter; along the others a value is chosen.
_SCATTER = ("starts", "sobol", "indices")
#: Most curves of one figure that can be told apart.
_CURVES = 8
LOW, HIGH = 5.0, 95.0


def draw(folder: Path, data: xr.Dataset, axes: Sequence[Points], outputs: Sequence[str]) -> list[Path]:
    """Draw every output against the axes; returns the files.

    Args:
        folder: Where the figures go.
        data: The sweep (`cosim.sweep.result.dataset`).
        axes: Its axes.
        outputs: Names of the outputs.
    """
    chosen = sorted((a for a in axes if a.kind not in _SCATTER and a.size > 1), key=lambda a: not _is_numeric(data, a))
    scatter = [a for a in axes if a.kind in _SCATTER and a.size > 1]
    files = []
    for name in outputs:
        values = data[name].squeeze(drop=True)  # an axis of one point is no axis of a figure
        if not np.isfinite(values.values).any():
            continue
        if chosen:
            files.append(_lines(folder / f"{name}_lines.png", data, values, chosen, scatter))
        if len(chosen) > 1 and all(_is_numeric(data, a) for a in chosen[:2]):
            files.append(_heat_map(folder / f"{name}_map.png", data, values, chosen, scatter))
        if scatter:
            files.append(_distribution(folder / f"{name}_distribution.png", data, values, chosen))
    return files


def draw_indices(path: Path, name: str, keys: Sequence[str], found: Indices) -> Path:
    """Bars of first-order and total indices with their 95 % intervals."""
    with figure(path, height=1.5 + 0.45 * len(keys), title=f"Sensitivity of {name}") as (place,):
        rows = np.arange(len(keys))[::-1]
        place.barh(rows + 0.18, found.first, 0.34, xerr=found.first_error, label="first order: alone", capsize=2)
        place.barh(rows - 0.18, found.total, 0.34, xerr=found.total_error, label="total: with all others", capsize=2)
        place.set_yticks(rows, [k.removeprefix("components.").replace(".parameters.", "\n") for k in keys])
        place.set_xlabel(f"share of the variance of {name}")
        place.axvline(0.0, color="k", lw=0.6)
        place.legend(frameon=False, fontsize=8, loc="lower right")
    return path


def _lines(
    path: Path, data: xr.Dataset, values: xr.DataArray, chosen: Sequence[Points], scatter: Sequence[Points]
) -> Path:
    main = max(chosen, key=lambda a: (_is_numeric(data, a), a.size))
    others = [a for a in chosen if a is not main]
    split = others[0] if others and others[0].size <= _CURVES else None
    across = [a.name for a in (*scatter, *(o for o in others if o is not split))]
    x, label, ticks = _abscissa(data, main)
    drawn: list[Array] = []
    with figure(path, title=f"{values.name} over {main.name}", run=label_of(data)) as (place,):
        for number in range(1 if split is None else split.size):
            own = values if split is None else values.isel({split.name: number})
            rows = own.transpose(main.name, *across).values.reshape(main.size, -1)
            colour = f"C{number}"
            name = "" if split is None else f"{split.name} = {_point(data, split, number)}"
            middle = _percentile(rows, 50.0)
            style = style_beside(middle, drawn)
            drawn.append(middle)
            mark = "o" if main.size <= 40 else ""
            place.plot(x, middle, ls=style, marker=mark, ms=3, color=colour, label=name)
            if rows.shape[1] > 1:
                place.fill_between(x, _percentile(rows, LOW), _percentile(rows, HIGH), alpha=0.2, color=colour, lw=0)
        if across:
            place.set_title(f"median, shaded: 5 to 95 % over {', '.join(across)}", fontsize=8)
        place.set_xlabel(label)
        place.set_ylabel(_name(values))
        if ticks is not None:
            place.set_xticks(x, ticks, rotation=30, ha="right")
        if split is not None:
            place.legend(frameon=False, fontsize=8)
    return path


def _heat_map(
    path: Path, data: xr.Dataset, values: xr.DataArray, chosen: Sequence[Points], scatter: Sequence[Points]
) -> Path:
    one, other = chosen[:2]
    across = [a.name for a in (*scatter, *chosen[2:])]
    rows = values.transpose(other.name, one.name, *across).values.reshape(other.size, one.size, -1)
    title = f"{values.name} over {one.name} and {other.name}"
    with figure(path, title=title, run=label_of(data)) as (place,):
        x, x_label, x_ticks = _abscissa(data, one)
        y, y_label, y_ticks = _abscissa(data, other)
        drawn = place.pcolormesh(x, y, _percentile(rows, 50.0), shading="nearest", cmap="viridis")
        bar = place.figure.colorbar(drawn, ax=place)
        bar.set_label(_name(values))
        failed = np.argwhere(~np.isfinite(rows).any(axis=-1))
        if failed.size:
            place.plot(x[failed[:, 1]], y[failed[:, 0]], "x", color="#d62728", label="all runs failed")
            place.legend(frameon=False, fontsize=8, loc="lower left", bbox_to_anchor=(0.0, 1.0))
        elif across:
            place.set_title(f"median over {', '.join(across)}", fontsize=8)
        place.set_xlabel(x_label)
        place.set_ylabel(y_label)
        if x_ticks is not None:
            place.set_xticks(x, x_ticks)
        if y_ticks is not None:
            place.set_yticks(y, y_ticks)
    return path


def _distribution(path: Path, data: xr.Dataset, values: xr.DataArray, chosen: Sequence[Points]) -> Path:
    split = next((a for a in chosen if a.size <= _CURVES), None)
    with figure(path, title=f"Distribution of {values.name}", run=label_of(data)) as (place,):
        for number in range(1 if split is None else split.size):
            own = values if split is None else values.isel({split.name: number})
            numbers = np.sort(own.values[np.isfinite(own.values)].ravel())
            if not numbers.size:
                continue
            # Share of runs at or below a value: nothing has to be chosen, as the width of a bin would have to be.
            label = "" if split is None else f"{split.name} = {_point(data, split, number)}"
            steps = np.arange(1, len(numbers) + 1) / len(numbers)
            place.step(np.r_[numbers[0], numbers], np.r_[0.0, steps], where="post", label=label)
        place.set_ylim(0.0, 1.02)
        place.set_xlabel(_name(values))
        place.set_ylabel("share of runs at or below")
        if split is not None:
            place.legend(frameon=False, fontsize=8)
    return path


def _is_numeric(data: xr.Dataset, axis: Points) -> bool:
    return axis.columns[0].numbers is not None and (axis.kind != "key" or data[axis.name].dtype.kind in "fiu")


def _abscissa(data: xr.Dataset, axis: Points) -> tuple[Array, str, list[str] | None]:
    """Places along an axis, its label, and texts of its ticks where it has no numbers."""
    column = axis.columns[0]
    if _is_numeric(data, axis) and column.numbers is not None:
        unit = with_degrees(column.unit)
        return column.numbers, f"{axis.name} [{unit}]" if unit else axis.name, None
    return np.arange(axis.size, dtype=np.float64), axis.name, [_short(t) for t in column.labels()]


def _point(data: xr.Dataset, axis: Points, number: int) -> str:
    return _short(with_degrees(str(axis.columns[0].values[number])))


def _short(text: str) -> str:
    return text if len(text) <= 28 else text[:25] + "..."


def _name(values: xr.DataArray) -> str:
    unit = with_degrees(str(values.attrs.get("units", "")))
    return f"{values.name} [{unit}]" if unit not in ("", "1") else str(values.name)


def _percentile(rows: Array, percent: float) -> Array:
    """Of what is finite along the last axis; NaN where nothing is."""
    shape = rows.shape[:-1]
    found = np.full(shape, np.nan)
    for place in np.ndindex(*shape):
        own = rows[place][np.isfinite(rows[place])]
        if own.size:
            found[place] = np.percentile(own, percent)
    return found


def draw_all_indices(folder: Path, found: Mapping[tuple[str, str], tuple[Sequence[str], Indices]]) -> list[Path]:
    """One figure for every output and axis that has indices."""
    return [
        draw_indices(folder / f"{output}_indices.png", output, keys, indices)
        for (output, _), (keys, indices) in found.items()
    ]
