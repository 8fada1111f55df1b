"""Axes of a sweep: the values along each, and what every value changes in the scenario."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import norm, qmc

from cosim.components import FabricComponent, FmuComponent, PendulumComponent
from cosim.parameters import Resolved, resolve
from cosim.scenario import Scenario
from cosim.sweep.checks import check_keys
from cosim.sweep.file import MOST_RUNS, Axis, Keyed, Range, Sobol, Spread, Starts, SweepFile
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue

#: Least distance of a drawn share from 0 and 1: the normal distribution is infinite there.
_EDGE = 1e-12


@dataclass(frozen=True)
class Column:
    """Values of one key along an axis.

    Args:
        key: Path in the scenario.
        values: As they are written into the scenario.
        numbers: Shape (points,), in `unit`; None where they are no quantities of one kind.
        unit: Unit of the numbers; empty for pure numbers.
        bounds: Lowest and highest number, of what is drawn between two ends.
    """

    key: str
    values: tuple[Any, ...]
    numbers: Array | None
    unit: str

    def labels(self) -> list[str]:
        """The values as text."""
        return [str(v) for v in self.values]


@dataclass(frozen=True)
class Points:
    """An axis with its values.

    Args:
        name: Name of the dimension.
        kind: `key`, `zip`, `sobol`, `indices` or `starts`.
        columns: One per key; all of the same length.
        shares: Drawn shares, shape (points, keys), of a Sobol' axis; empty else.
    """

    name: str
    kind: str
    columns: tuple[Column, ...]
    shares: Array = field(default_factory=lambda: np.empty((0, 0)))

    @property
    def size(self) -> int:
        """Number of points."""
        return len(self.columns[0].values)

    def assignments(self, index: int) -> dict[str, Any]:
        """Path to value at a point."""
        return {c.key: c.values[index] for c in self.columns}


def axes_of(sweep: SweepFile, scenario: Scenario, source: Path) -> list[Points]:
    """All axes of a sweep.

    Args:
        sweep: The sweep.
        scenario: The scenario that is swept, unchanged: stated uncertainties are those of its parameter sets.
        source: File of the sweep, for errors.

    Raises:
        InputError: An axis is wrong, or the sweep has more than `MOST_RUNS` runs.
    """
    found = []
    for name, axis in sweep.axes.items():
        try:
            found.append(_points(name, axis, scenario))
        except ValueError as error:
            raise InputError(source, f"axes.{name}", str(error), "correct this axis") from error
    check_keys([c.key for p in found for c in p.columns], scenario, source)
    runs = math.prod(p.size for p in found)
    if runs > MOST_RUNS:
        sizes = " x ".join(f"{p.size} ({p.name})" for p in found)
        raise InputError(
            source,
            "axes",
            f"{sizes} are {runs if runs < 10**15 else 'more than 1e15'} runs, more than {MOST_RUNS}",
            "take fewer values, or draw them with `sobol`",
        )
    return found


def grid(axes: Sequence[Points]) -> Iterator[tuple[tuple[int, ...], dict[str, Any]]]:
    """Every run: its place on the axes, and what it changes in the scenario; the last axis changes fastest."""
    for place in itertools.product(*(range(a.size) for a in axes)):
        changes: dict[str, Any] = {}
        for axis, index in zip(axes, place):
            changes |= axis.assignments(index)
        yield place, changes


def _points(name: str, axis: Axis, scenario: Scenario) -> Points:
    if axis.key is not None:
        column = _column(Keyed(key=axis.key, values=axis.values, range=axis.range))
        _check_once(column)
        return Points(name, "key", (column,))
    if axis.zip is not None:
        columns = tuple(_column(k) for k in axis.zip)
        sizes = {c.key: len(c.values) for c in columns}
        if len(set(sizes.values())) > 1:
            told = ", ".join(f"{k} has {n}" for k, n in sizes.items())
            raise ValueError(f"zip: all keys need the same number of values; {told}")
        return Points(name, "zip", columns)
    if axis.starts is not None:
        return _starts(name, axis.starts, scenario)
    assert axis.sobol is not None
    return _sobol(name, axis.sobol, scenario)


def _check_once(column: Column) -> None:
    """Raise ValueError where a value stands twice: no run could be told from the other by its label."""
    seen: set[object] = set()
    for i, value in enumerate(column.values):
        label: object = repr(value) if column.numbers is None else float(column.numbers[i])
        if label in seen:
            raise ValueError(f"the value {value} stands twice; for random repetitions use `starts`")
        seen.add(label)


def _column(given: Keyed) -> Column:
    if given.range is not None:
        numbers = _spaced(given.range)
        unit = given.range.from_.unit
        return Column(given.key, tuple(_written(n, unit) for n in numbers), numbers, unit)
    values = tuple(given.values or ())
    found, unit = _numbers(values)
    return Column(given.key, values, found, unit)


def _spaced(given: Range) -> Array:
    unit = given.from_.unit
    low, high = given.from_.to(unit), given.to.to(unit)
    spaced = np.geomspace(low, high, given.count) if given.scale == "log" else np.linspace(low, high, given.count)
    # As a person would write them: 0.3, not 0.30000000000000004.
    return np.array([float(f"{v:.12g}") for v in spaced])


def _written(number: float, unit: str) -> Any:
    """A number as it stands in a scenario: whole numbers without unit stay whole, for keys that count something."""
    if unit:
        return f"{float(number)!r} {unit}"
    return int(number) if float(number).is_integer() else float(number)


def _numbers(values: Sequence[Any]) -> tuple[Array | None, str]:
    """Quantities of one kind as numbers in the unit of the first; None for anything else."""
    try:
        if any(isinstance(v, bool) for v in values):
            return None, ""
        parsed = [PhysicalValue.parse(v) for v in values]
        return np.array([p.to(parsed[0].unit) for p in parsed]), parsed[0].unit
    except ValueError:
        return None, ""


def _starts(name: str, given: Starts, scenario: Scenario) -> Points:
    if not isinstance(scenario.components.get(given.component), FabricComponent):
        fabrics = ", ".join(n for n, c in scenario.components.items() if isinstance(c, FabricComponent)) or "none"
        raise ValueError(f"starts: `{given.component}` is no fabric of the scenario (there: {fabrics})")
    numbers = np.arange(given.first, given.first + given.count, dtype=np.float64)
    place = f"components.{given.component}.parameters"
    return Points(
        name,
        "starts",
        (
            Column(f"{place}.start_number", tuple(int(n) for n in numbers), numbers, ""),
            Column(
                f"{place}.start_speed",
                (str(given.speed),) * given.count,
                np.full(given.count, given.speed.number),
                given.speed.unit,
            ),
        ),
    )


@dataclass(frozen=True)
class _Drawn:
    """A key and how a share between 0 and 1 becomes its value."""

    key: str
    unit: str
    low: float
    high: float
    scale: str

    def values(self, shares: Array) -> Array:
        if self.scale == "stated":  # low: the nominal value; high: standard deviation of its logarithm
            return np.asarray(self.low * np.exp(self.high * norm.ppf(np.clip(shares, _EDGE, 1.0 - _EDGE))))
        if self.scale == "log":
            return np.asarray(self.low * (self.high / self.low) ** shares)
        return np.asarray(self.low + (self.high - self.low) * shares)


def _sobol(name: str, given: Sobol, scenario: Scenario) -> Points:
    drawn = [d for entry in given.of for d in _drawn(entry, scenario)]
    keys = [d.key for d in drawn]
    if len(set(keys)) < len(keys):
        raise ValueError(f"sobol: `{max(keys, key=keys.count)}` is drawn twice")
    shares = _saltelli(given, keys) if given.indices else _sequence(given, len(drawn))
    columns = []
    for number, own in enumerate(drawn):
        values = own.values(shares[:, number])
        columns.append(Column(own.key, tuple(f"{float(v)!r} {own.unit}".strip() for v in values), values, own.unit))
    return Points(name, "indices" if given.indices else "sobol", tuple(columns), shares)


def _sequence(given: Sobol, keys: int) -> Array:
    # Whole powers of two are drawn, since only they are balanced; what is too much is left away.
    power = max(int(np.ceil(np.log2(given.count))), 0)
    return np.asarray(qmc.Sobol(keys, scramble=True, rng=np.random.default_rng(given.seed)).random_base2(power))[
        : given.count
    ]


def _saltelli(given: Sobol, keys: Sequence[str]) -> Array:
    from cosim.sweep.sensitivity import saltelli

    return saltelli(given.count, list(keys), given.seed)


def _drawn(entry: Any, scenario: Scenario) -> list[_Drawn]:
    if isinstance(entry, Spread):
        if entry.from_ is not None and entry.to is not None:
            unit = entry.from_.unit
            return [_Drawn(entry.key, unit, entry.from_.to(unit), entry.to.to(unit), entry.scale)]
        pieces = entry.key.removeprefix("components.").split(".", 2)
        if len(pieces) != 3 or pieces[1] != "parameters":
            raise ValueError(f"stated: `{entry.key}` is no parameter; write `component.parameters.name`")
        stated = _stated(pieces[0], scenario)
        if pieces[2] not in stated:
            raise ValueError(
                f"stated: the parameter set states no uncertainty of `{pieces[2]}` "
                f"(stated: {', '.join(stated) or 'none'})"
            )
        return [stated[pieces[2]]]
    found = _stated(entry.component, scenario)
    if not found:
        raise ValueError(f"stated: the parameter set of `{entry.component}` states no uncertainty")
    return list(found.values())


def _stated(name: str, scenario: Scenario) -> Mapping[str, _Drawn]:
    component = scenario.components.get(name)
    if not isinstance(component, FmuComponent | FabricComponent | PendulumComponent):
        raise ValueError(f"stated: `{name}` is no component with a parameter set")
    resolved: Resolved = resolve(component.parameter_set, {}, scenario.path or Path("scenario"))
    found = {}
    for key, deviation in resolved.uncertainty.items():
        value = component.parameters.get(key, resolved.values[key])
        if isinstance(value, PhysicalValue) and deviation > 0.0:
            found[key] = _Drawn(f"components.{name}.parameters.{key}", value.unit, value.number, deviation, "stated")
    return found
