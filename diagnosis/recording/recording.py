"""A recording, read and checked: channels in SI units on the scenario's clock."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from cosim.terminal import in_one_line
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array
from cosim.unit.quantity import PhysicalValue
from diagnosis.recording.noise import estimate_noise, find_quantum
from diagnosis.recording.quantity import SI_UNITS, Target, parse_quantity
from diagnosis.recording.series import MOST
from diagnosis.recording.sidecar import ChannelEntry, Clock, InputEntry, Sidecar, load_sidecar
from diagnosis.recording.table import Table
from diagnosis.recording.units import WrongUnit, conversion_of_difference, conversion_of_reading, unit_of_component

#: A channel needs at least this many values to be worth anything.
FEWEST_VALUES = 8
#: Most values of a channel that are compared. Their mean is known to 0.7 % of one reading's noise, far below what any
#: model or calibration is right to, and 100 channels with 100 derivatives stay within 1 GB in single precision.
MOST_VALUES = 20_000
#: Most values of all channels of a recording together: each is a row of every derivative that a search takes.
MOST_READINGS = 40_000
#: However many channels there are, so many values of each are kept.
LEAST_KEPT = 1_000
#: Most changes of a recorded input: each becomes a point of the programme in a text that is read several times.
MOST_CHANGES = 20_000

#: Readings whose own deviation is above so many times the median are left out: one number stands for the others.
UNCERTAIN = 3.0

#: An estimated noise is at least this share of the median over the channels of one quantity.
LIKE = 0.7


@dataclass(frozen=True)
class Channel:
    """One measured quantity.

    Args:
        name: As in recording.yaml, for example `coil[2,5].temperature`.
        target: What it means.
        times: Times of its samples on the scenario's clock [s], rising, shape (samples,).
        values: Readings in SI, shape (samples,).
        deviation: Standard deviation of the sensor's noise, SI.
        is_deviation_given: Whether the deviation was given and not estimated.
        quantum: Step of the reading, SI; 0 if it has none.
        limits: Readings at which the sensor clips, SI; infinite where it does not.
        lag_bound: Largest time constant of the sensor [s].
        offset_bound: How far its clock may be off [s].
        bias_bound: How far its zero may be off, SI.
        is_clipped: Which samples lie at a limit, shape (samples,).
        dropped: Why rows of its column are not among the samples (`empty`, `invalid`, `before begin`, `after end`,
            `uncertain`, `thinned`; once it has been held against a scenario, `before start` and `after stop` of the
            simulated time), with their number; `diagnosis.recording.usage` puts it into words.
        later: How much `times` were moved, to compare readings with the output after a change of an input [s].
        scatter: Part of `deviation` by which the simulation scatters by itself (contacts), SI; it is not white.
        scatter_together: How many times more the sum of squares over all channels varies by it than if each channel
            scattered by itself.
        scatter_runs: Simulations whose mean a prediction of it is.
        is_of_each_reading: Whether the deviation was given for each reading, as a camera's tracks have it: it may hold
            what neighbours share.
    """

    name: str
    target: Target
    times: Array
    values: Array
    deviation: float
    is_deviation_given: bool
    quantum: float = 0.0
    limits: tuple[float, float] = (-math.inf, math.inf)
    lag_bound: float = 0.0
    offset_bound: float = 0.0
    bias_bound: float = 0.0
    is_clipped: AnyArray = field(default_factory=lambda: np.zeros(0, dtype=bool))
    dropped: Mapping[str, int] = field(default_factory=dict)
    later: float = 0.0
    scatter: float = 0.0
    scatter_together: float = 1.0
    scatter_runs: int = 1
    is_of_each_reading: bool = False

    @property
    def unit(self) -> str:
        """SI unit."""
        return self.target.si_unit

    def only(self, kept: AnyArray, dropped: Mapping[str, int]) -> Channel:
        """The channel with some of its readings.

        Args:
            kept: Which, shape (samples,).
            dropped: Why the others are not, with their number; see `dropped`.
        """
        return replace(
            self,
            times=self.times[kept],
            values=self.values[kept],
            is_clipped=self.is_clipped[kept],
            dropped={**self.dropped, **dropped},
        )


@dataclass(frozen=True)
class Input:
    """A recorded course of a programme's output.

    Args:
        component: Programme.
        output: Its output.
        unit: Unit of `values`.
        times: [s] on the scenario's clock, shape (samples,).
        values: Shape (samples,).
    """

    component: str
    output: str
    unit: str
    times: Array
    values: Array


@dataclass(frozen=True)
class Recording:
    """What was done and what was measured.

    Args:
        path: Folder.
        title: One line.
        channels: By name.
        inputs: Recorded courses of programmes.
        overrides: Keys of the scenario that this recording replaces.
        end: Last time with a value [s].
        switch_margin: Samples this close to a switch are not used to judge [s].
        source: Who measured it.
        uncertain: What it does not know exactly itself, `component.parameter` to a standard deviation.
        beginning: Length of its first stretch, from which that is estimated where it is held out [s].
        day: Recordings with the same name are of one day; empty: a day of its own.
        order: Place among the recordings in time, from 1; None: as given, those held out last.
        cycles_before: Full cycles that the rig had made before.
        units: Units of its channels and its clock, as written: a report shows quantities in them.
        zero: Time of its table's clock at which the scenario's time is 0 [s]; NaN where that is no number.
    """

    path: Path
    title: str
    channels: Mapping[str, Channel]
    inputs: tuple[Input, ...]
    overrides: Mapping[str, Any]
    end: float
    switch_margin: float
    source: str = ""
    uncertain: Mapping[str, PhysicalValue] = field(default_factory=dict)
    beginning: float = 0.0
    day: str = ""
    order: int | None = None
    cycles_before: float = 0.0
    units: tuple[str, ...] = ()
    zero: float = 0.0


def load_recording(path: str | Path) -> Recording:
    """Read and check a recording.

    Args:
        path: Folder with recording.yaml, or that file.

    Of a channel with more than `MOST_VALUES` values that many are kept, spread evenly, and fewer where all channels
    have more than `MOST_READINGS` (`Channel.dropped` says how many were not).

    Raises:
        InputError: A file or key is missing or wrong, a column does not exist, holds text or infinite values, a value
            has no time, times do not rise, a unit does not fit, or a channel has too few values.
    """
    given = Path(path)
    file = given if given.is_file() else given / "recording.yaml"
    if not file.is_file():
        raise InputError(
            given,
            "",
            "there is no recording here: no recording.yaml",
            "see docs/recordings.md, or make one with `cosim record`",
        )
    return _Reader(file).recording()


def alike(channels: Mapping[str, Channel]) -> dict[str, Channel]:
    """The same, with no estimated noise far below that of its like.

    Differences of readings tell the noise, but not where a sensor stands at the end of its range: there they are all
    the same, and a noise taken from them would make everything else wild. Sensors of one quantity have like noise.
    """
    kinds: dict[tuple[str, str], list[float]] = {}
    for c in channels.values():
        if not c.is_deviation_given:
            kinds.setdefault((c.target.kind, c.target.quantity), []).append(c.deviation)
    least = {kind: LIKE * float(np.median(values)) for kind, values in kinds.items()}
    return {
        name: c
        if c.is_deviation_given
        else replace(c, deviation=max(c.deviation, least[c.target.kind, c.target.quantity]))
        for name, c in channels.items()
    }


class _Reader:
    """Reads one recording; of each table the columns that are named, once."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self.sidecar: Sidecar = load_sidecar(file)
        self._tables: dict[str, Table] = {}
        self._columns = _columns(self.sidecar)

    def recording(self) -> Recording:
        sidecar = self.sidecar
        rows = {name: self._rows(name, entry) for name, entry in sidecar.channels.items()}
        most = fair_share([len(r) for r, _ in rows.values()])
        channels = alike({n: self._channel(n, entry, *rows[n], most) for n, entry in sidecar.channels.items()})
        inputs = tuple(self._input(name, entry) for name, entry in sidecar.inputs.items())
        end = max(float(c.times[-1]) for c in channels.values())
        beginning = 0.0 if sidecar.beginning is None else sidecar.beginning.to("s")
        for channel in channels.values():
            length = float(channel.times[-1] - channel.times[0])
            if beginning and length < beginning:
                what = f"{channel.name} ends {length:.6g} s after its first value: nothing of it is left that judges"
                raise InputError(self.file, "beginning", what, f"give less than {length:.6g} s")
        return Recording(
            self.file.parent,
            in_one_line(sidecar.title),  # it is printed, and a title must not steer a terminal
            channels,
            inputs,
            sidecar.overrides,
            end,
            sidecar.switch_margin.to("s"),
            sidecar.source,
            sidecar.uncertain,
            beginning,
            sidecar.day,
            sidecar.order,
            float(sidecar.cycles_before),
            (*(c.unit for c in sidecar.channels.values()), sidecar.time.unit),
            self._zero(),
        )

    def _table(self, name: str | None) -> Table:
        chosen = name or self.sidecar.table
        if chosen not in self._tables:
            file = self.file.parent / chosen
            self._tables[chosen] = Table(file, self.sidecar.header_lines, self._columns[chosen])
        return self._tables[chosen]

    def _zero(self) -> float:
        """Time of the recording's own table at which the scenario's time is 0 [s]."""
        clock = self.sidecar.time
        factor = self._conversion(clock.unit, "s", "time.unit")[0]
        if clock.zero is not None:
            return factor * float(clock.zero)
        readings = self._table(None).column(clock.column, "time.column")
        known = readings[np.isfinite(readings)]
        return factor * float(known[0]) if len(known) else float("nan")

    def _times(self, table_name: str | None, own: Clock | None, key: str) -> tuple[Array, Clock]:
        """Times on the scenario's clock [s]."""
        clock = own or self.sidecar.time
        readings = self._table(table_name).column(clock.column, f"{key}.time.column")
        factor = self._conversion(clock.unit, "s", f"{key}.time.unit")[0]
        if clock.zero is not None:
            return factor * (readings - float(clock.zero)), clock
        # Tables that share a clock share its zero: the first reading of the recording's own table.
        reference = readings if own is not None else self._table(None).column(clock.column, "time.column")
        if not np.isfinite(reference).any():
            raise InputError(self._table(table_name).file, clock.column, "the clock has no values", "give times")
        return factor * (readings - float(reference[np.isfinite(reference)][0])), clock

    def _input(self, name: str, entry: InputEntry) -> Input:
        key = f"inputs.{name}"
        component, _, output = name.partition(".")
        if not output:
            raise InputError(self.file, key, "this is no output of a programme", "write `component.output`")
        try:  # whether it fits the programme, the scenario tells
            conversion_of_reading(entry.unit, entry.unit)
        except WrongUnit as error:
            raise InputError(self.file, f"{key}.unit", str(error), error.remedy) from error
        times, _ = self._times(entry.table, entry.time, key)
        column = self._table(entry.table).column(entry.column, f"{key}.column")
        known = self._known(times, column, key)
        self._check_times(times[known], key)
        times, values = times[known], entry.factor * column[known]
        changes = int(np.count_nonzero(np.diff(values))) + 1
        if changes > MOST_CHANGES:
            raise InputError(
                self.file,
                key,
                f"its column changes {changes} times; a programme holds at most {MOST_CHANGES} values",
                "average the column over as many rows as needed, or record the input at a lower rate",
            )
        return Input(component, output, entry.unit, times, values)

    def _known(self, times: Array, column: Array, key: str) -> AnyArray:
        """Rows that hold a value, shape (rows,); each of them must have a time, and both must be finite."""
        known = ~np.isnan(column)
        empty = "leave the place empty where nothing was measured, or list the number under `invalid`"
        for wrong, what, remedy in (
            (known & ~(np.abs(column) <= MOST), "no sensor reads", empty),
            (known & ~(np.abs(times) <= MOST), "has no time, or an infinite one", "give its time, or leave it empty"),
        ):
            if wrong.any():
                row = int(np.flatnonzero(wrong)[0])
                value = f"the value in row {row + 1} of its column, {column[row]:g},"
                raise InputError(self.file, key, f"{value} {what}", remedy)
        return np.asarray(known)

    def _check_times(self, times: Array, key: str) -> None:
        late = np.flatnonzero(np.diff(times) <= 0)
        if late.size:
            first = int(late[0])
            what = f"its times do not rise: {times[first]:.6g} s, then {times[first + 1]:.6g} s"
            raise InputError(self.file, key, what, "sort the table and remove doubled rows")

    def _channel(
        self, name: str, entry: ChannelEntry, counted: AnyArray, dropped: Mapping[str, int], most: int
    ) -> Channel:
        """A channel of at most so many of the rows that count."""
        key = f"channels.{name}"
        target = self._target(name, key)
        unit = SI_UNITS.get(target.quantity, entry.unit)
        if target.is_component:
            unit = unit_of_component(entry.unit, target.si_unit if target.si_unit != "1" else "")
        factor, offset = self._conversion(entry.unit, unit, f"{key}.unit")
        times, clock = self._times(entry.table, entry.time, key)
        raw = self._table(entry.table).column(entry.column, f"{key}.column")
        own = self._own_noise(entry, key)
        rows = _thinned(counted, len(raw), most)
        if len(rows) < len(counted):
            dropped = {**dropped, "thinned": len(counted) - len(rows)}
        times, values = times[rows], factor * (entry.factor * raw[rows]) + offset
        limits = self._limits(entry, unit, key)
        quantum = self._difference(entry.quantum, unit, f"{key}.quantum")
        given = self._difference(entry.noise, unit, f"{key}.noise")
        if own is not None:
            given = abs(factor * float(entry.factor)) * float(np.sqrt(np.mean(own[rows] ** 2)))
        if given and entry.quantum is None:  # a noise that is estimated holds the rounding already
            quantum = find_quantum(values)
        return Channel(
            name,
            Target(target.kind, target.element, target.quantity, unit),
            times,
            values,
            given or estimate_noise(times, values, quantum),
            bool(given),
            quantum,
            limits,
            entry.lag_bound.to("s"),
            clock.offset_bound.to("s"),
            self._difference(entry.bias_bound, unit, f"{key}.bias_bound"),
            _at_limit(values, limits, quantum),
            dropped,
            is_of_each_reading=own is not None,
        )

    def _own_noise(self, entry: ChannelEntry, key: str) -> Array | None:
        """Deviation of each reading as it stands in its column, shape (rows,)."""
        if entry.noise_column is None:
            return None
        table = self._table(entry.table)
        raw, own = table.column(entry.column, f"{key}.column"), table.column(entry.noise_column, f"{key}.noise_column")
        wrong = np.flatnonzero(~np.isnan(raw) & ~np.isin(raw, entry.invalid) & ~((own > 0.0) & (own <= MOST)))
        if wrong.size:
            row = int(wrong[0])
            what = f"the deviation in row {row + 1} of its column, {own[row]:g}, is no positive number"
            raise InputError(self.file, f"{key}.noise_column", what, "give one for each reading")
        return own

    def _rows(self, name: str, entry: ChannelEntry) -> tuple[AnyArray, dict[str, int]]:
        """Numbers of the rows of a column that can be its samples, and why the others cannot."""
        key = f"channels.{name}"
        self._target(name, key)
        times, _ = self._times(entry.table, entry.time, key)
        raw = self._table(entry.table).column(entry.column, f"{key}.column")
        own = self._own_noise(entry, key)
        is_invalid = np.isin(raw, entry.invalid)
        filled = self._known(times, np.where(is_invalid, math.nan, raw), key)
        begin = -math.inf if self.sidecar.begin is None else self.sidecar.begin.to("s")
        end = math.inf if self.sidecar.end is None else self.sidecar.end.to("s")
        early, late = filled & (times < begin), filled & (times > end)
        rows = np.flatnonzero(filled & ~early & ~late)
        vague = 0
        if own is not None and rows.size:
            sure = own[rows] <= UNCERTAIN * float(np.median(own[rows]))
            rows, vague = rows[sure], int(np.count_nonzero(~sure))
        if len(rows) < FEWEST_VALUES:
            raise InputError(
                self.file,
                key,
                f"it has {len(rows)} values, fewer than {FEWEST_VALUES}",
                "leave the channel out, or correct begin, end and invalid",
            )
        self._check_times(times[rows], key)
        counts = {
            "empty": int(np.count_nonzero(~filled & ~is_invalid)),
            "invalid": int(np.count_nonzero(is_invalid)),
            "before begin": int(np.count_nonzero(early)),
            "after end": int(np.count_nonzero(late)),
            "uncertain": vague,
        }
        return rows, {reason: count for reason, count in counts.items() if count}

    def _target(self, name: str, key: str) -> Target:
        try:
            return parse_quantity(name)
        except ValueError as error:
            raise InputError(self.file, key, str(error), "docs/recordings.md lists the quantities") from error

    def _conversion(self, source: str, target: str, key: str) -> tuple[float, float]:
        try:
            return conversion_of_reading(source, target)
        except WrongUnit as error:
            raise InputError(self.file, key, str(error), error.remedy) from error

    def _limits(self, entry: ChannelEntry, unit: str, key: str) -> tuple[float, float]:
        found = []
        for which, value, default in (("minimum", entry.minimum, -math.inf), ("maximum", entry.maximum, math.inf)):
            try:
                if value is not None and value.unit:
                    conversion_of_reading(value.unit, unit)
                found.append(default if value is None else value.to(unit))
            except ValueError as error:
                remedy = error.remedy if isinstance(error, WrongUnit) else f"give it in {unit}"
                raise InputError(self.file, f"{key}.{which}", f"{value}: {error}", remedy) from error
        if found[0] >= found[1]:
            raise InputError(
                self.file,
                f"{key}.maximum",
                f"{entry.maximum} is not above the minimum, {entry.minimum}",
                "exchange the two, or correct them",
            )
        return found[0], found[1]

    def _difference(self, value: PhysicalValue | None, unit: str, key: str) -> float:
        """A difference of readings in SI: 0.3 degC of noise are 0.3 K."""
        if value is None:
            return 0.0
        if not value.unit and unit != "1":  # of the column's unit or of the SI unit?
            raise InputError(self.file, key, f"{value} has no unit", f"write for example `{value} {unit}`")
        try:
            factor = conversion_of_difference(value.unit or unit, unit)
        except WrongUnit as error:
            raise InputError(self.file, f"{key}.unit", str(error), error.remedy) from error
        if not value.number * factor > 0:
            raise InputError(self.file, key, f"{value} is not positive", "give a positive number with its unit")
        if value.number * factor > MOST:
            raise InputError(self.file, key, f"{value} is too large", f"give at most {MOST / factor:.3g} {value.unit}")
        return factor * value.number


def _columns(sidecar: Sidecar) -> dict[str, set[str]]:
    """Table to the columns of it that are named."""
    found: dict[str, set[str]] = {sidecar.table: {sidecar.time.column}}
    entries: list[ChannelEntry | InputEntry] = [*sidecar.channels.values(), *sidecar.inputs.values()]
    for entry in entries:
        own = found.setdefault(entry.table or sidecar.table, set())
        own |= {entry.column, (entry.time or sidecar.time).column}
        if isinstance(entry, ChannelEntry) and entry.noise_column is not None:
            own.add(entry.noise_column)
    return found


def fair_share(counts: Sequence[int]) -> int:
    """Most values that each channel may keep so that all together have no more than `MOST_READINGS`.

    Channels with few values keep them all, and leave more for the others.

    >>> fair_share([500, 500]), fair_share([10**6, 10**6, 600]), fair_share([10**6] * 1000)
    (20000, 19700, 1000)
    """
    left, rest = MOST_READINGS, len(counts)
    for count in sorted(counts):
        if count * rest > left:
            break
        left, rest = left - count, rest - 1
    share = left // rest if rest else MOST_VALUES
    return min(max(share, LEAST_KEPT), MOST_VALUES)


def _thinned(rows: AnyArray, count: int, most: int) -> AnyArray:
    """At most so many of the rows that hold a value: the first of each stretch of the table.

    Readings are picked, not averaged: what is kept has the noise that was stated, also where it is not white, is
    rounded and clipped as it was, and belongs to one instant. Channels of one table keep the same rows where they can.
    """
    if len(rows) <= most:
        return rows
    stretch = rows // math.ceil(count / most)
    return np.asarray(rows[np.concatenate([[True], np.diff(stretch) > 0])])


def _at_limit(values: Array, limits: tuple[float, float], quantum: float) -> AnyArray:
    """Which readings lie at a limit: within half a step, to which a clipped reading may be rounded."""
    slack = [0.5 * quantum + (1e-9 * abs(limit) if math.isfinite(limit) else 0.0) for limit in limits]
    return np.asarray((values <= limits[0] + slack[0]) | (values >= limits[1] - slack[1]))
