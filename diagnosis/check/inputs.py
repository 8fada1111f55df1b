"""What drove the rig, as it was recorded, beside what was programmed: level, switching instants, shape."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cosim.components import ProgrammeComponent, ProgrammeOutput, nanoseconds
from cosim.unit.protocol import AnyArray, Array
from diagnosis.check.beside import Compared
from diagnosis.recording.conditions import scenario_of

#: Share of a programme's range within which level and column agree: what a laboratory supply and its meter hold.
#: Source: 1 % each, as in docs/faults.md.
HELD = 0.02
#: Points at which courses are compared.
GRID = 4000
#: Share of the recording that a shift or a factor may leave: switches are not instantaneous.
LEFT = 0.02
#: Switches of a course that are kept.
MOST_SWITCHES = 50
#: Share of switches that both have, from which on a programme is taken to be meant.
MEANT = 0.5


@dataclass(frozen=True)
class InputComparison:
    """A recorded input beside the programme of the same output.

    Args:
        recording: Title of the recording.
        name: `component.output`, with its element if it has several; or a channel of the supply.
        unit: Unit of the values.
        kind: `equal`, `scaled`, `offset`, `shifted`, `off` (the recorded one is 0 where the programme is not), `part`
            (they differ in less than half of the time), `other`.
        used: What the simulation uses: `recorded` or `programme`.
        is_stated: Whether the recording itself states the programme, under `overrides`.
        stretches: Intervals in which they differ by more than both hold [s].
        share: Of the recording's time in which they differ.
        factor: Recorded over programmed level where they are `scaled`; else 1.
        offset: Recorded less programmed level where it is one, in `unit`; else 0.
        shift: How much later the recorded one is, where they are `shifted` [s]; else 0.
        switches: Instants at which they change, recorded and programmed [s].
    """

    recording: str
    name: str
    unit: str
    kind: str
    used: str
    is_stated: bool
    stretches: tuple[tuple[float, float], ...]
    share: float
    factor: float
    offset: float
    shift: float
    switches: tuple[tuple[float, ...], tuple[float, ...]]

    @property
    def is_meant(self) -> bool:
        """Whether the programme is meant for this recording: stated by it, or alike but for a part."""
        return self.is_stated or self.kind != "other"


def compare_inputs(compared: Compared) -> tuple[InputComparison, ...]:
    """Every recorded input beside the programme that holds without it."""
    recording = compared.recording
    if not recording.inputs or compared.base is None:
        return ()
    plain = scenario_of(compared.base, replace(recording, inputs=()))
    found = []
    for one in recording.inputs:
        own, other = (
            _output(s.components[one.component], one.output)  # `scenario_of` has refused what is no programme
            for s in (compared.scenario, plain)
        )
        interval = float(np.median(np.diff(one.times))) if len(one.times) > 1 else 0.0
        margin = interval + nanoseconds(compared.scenario.time.macro_step) * 1e-9
        start = compared.scenario.time.start.to("s")
        rows = _courses(own, start), _courses(other, start)
        for k in range(max(len(r) for r in rows)):
            mine, theirs = (r[min(k, len(r) - 1)] for r in rows)
            name = f"{one.component}.{one.output}" + (f"[{k + 1}]" if len(rows[0]) > 1 else "")
            found.append(
                set_beside(
                    recording.title,
                    name,
                    own.unit,
                    (mine, theirs),
                    (compared.begin, compared.end),
                    margin,
                    is_stated(recording.overrides, one.component, one.output),
                )
            )
    return tuple(found)


def is_stated(overrides: Mapping[str, Any], component: str, output: str) -> bool:
    """Whether a recording states the programme of an output."""
    here: Any = overrides
    for key in ("components", component, "outputs", output):
        if not isinstance(here, Mapping) or key not in here:
            return False
        here = here[key]
    return True


def _output(component: object, output: str) -> ProgrammeOutput:
    assert isinstance(component, ProgrammeComponent)
    return component.outputs[output]


#: Value at given times [s], shape (times,).
Course = Callable[[Array], Array]


def _courses(given: ProgrammeOutput, start: float) -> list[Course]:
    """Each element of an output as a function of time."""
    points = given.points if given.points is not None else [(None, given.constant)]
    times = np.array([start if t is None else t.to("s") for t, _ in points])
    rows = [v if isinstance(v, list) else [v] for _, v in points]
    values = np.array([[e.to(given.unit) for e in row if e is not None] for row in rows])
    is_linear = given.interpolation == "linear"
    return [_course(times, values[:, k], is_linear) for k in range(values.shape[1])]


def _course(times: Array, values: Array, is_linear: bool) -> Course:
    if is_linear:
        return lambda at: np.asarray(np.interp(at, times, values))
    return lambda at: np.asarray(values[np.maximum(np.searchsorted(times, at + 1e-9, side="right") - 1, 0)])


def set_beside(
    recording: str,
    name: str,
    unit: str,
    courses: tuple[Course, Course],
    span: tuple[float, float],
    margin: float,
    is_programme_stated: bool,
    used: str = "recorded",
) -> InputComparison:
    """Compare a recorded course with a programmed one.

    The first law that leaves no more than `LEFT` of the time is reported: equal, a factor, an offset, a shift, off for
    a stretch. A reading and a macro-step around a switch are not compared.

    Args:
        recording: Title.
        name: Of the input.
        unit: Of its values.
        courses: Recorded and programmed.
        span: First and last instant [s].
        margin: How far a switch may be off [s].
        is_programme_stated: Whether the recording states the programme.
        used: Which of the two the simulation uses.
    """
    grid = np.linspace(*span, GRID)
    own, other = (c(grid) for c in courses)
    size = 0.0 if unit == "K" else float(np.max(np.abs(other)))  # the zero of a temperature is no size
    width = float(np.ptp(other)) or size or float(np.ptp(own))
    cells = int(np.ceil(margin / (grid[1] - grid[0]))) + 1
    tolerance = HELD * width + 4.0 * _noise(own, other, cells)
    allowed = cells * (grid[1] - grid[0])

    def differ(values: Array) -> AnyArray:
        return _opened(np.abs(own - values) > tolerance, cells)

    plain = differ(other)
    share = float(plain.mean())
    kind, factor, offset, shift = "equal", 1.0, 0.0, 0.0
    if share > LEFT:
        power = float(other @ other)
        scale = float(own @ other) / power if power else 1.0
        level = float(np.median(own - other))
        moved, late = _shifted(courses, grid, other, own, allowed)
        if power and scale > 0.0 and differ(scale * other).mean() <= LEFT and np.ptp(scale * other) > tolerance:
            kind, factor = "scaled", scale
        elif differ(other + level).mean() <= LEFT and np.ptp(other) > tolerance:
            kind, offset = "offset", level
        elif differ(moved).mean() <= LEFT and np.ptp(other) > tolerance:
            kind, shift = "shifted", late
        elif np.mean(np.abs(own[plain]) <= tolerance) > 1.0 - LEFT and share <= 0.5:
            kind = "off"
        else:
            # one level that stays is what a scenario says that leaves the course to the recordings
            kind = "part" if share <= MEANT and np.ptp(other) > tolerance else "other"
    return InputComparison(
        recording,
        name,
        unit,
        kind,
        used,
        is_programme_stated,
        _runs(grid, plain),
        share,
        factor,
        offset,
        shift,
        (_switches(grid, own, tolerance), _switches(grid, other, tolerance)),
    )


def _noise(own: Array, other: Array, cells: int) -> float:
    """Standard deviation of a column that changes far more often than the programme does; else 0.

    Noise changes from reading to reading, within so many cells; a command that is held for longer is none.
    """
    steps = np.abs(np.diff(own))
    changes = np.flatnonzero(steps)
    if len(changes) > 1 and np.median(np.diff(changes)) > cells:
        return 0.0
    steps = steps[changes]
    if len(steps) < 10 * (1 + np.count_nonzero(np.diff(other))):
        return 0.0
    return float(np.median(steps)) / 0.954  # of the difference of two normal readings


def _opened(differs: AnyArray, cells: int) -> AnyArray:
    """The same without stretches of so many cells or less: a switch within its margin is none that differs."""
    found = differs.copy()
    for first, after in _bounds(differs):
        if after - first <= cells:
            found[first:after] = False
    return found


def _runs(grid: Array, differs: AnyArray) -> tuple[tuple[float, float], ...]:
    return tuple((float(grid[a]), float(grid[min(b, len(grid) - 1)])) for a, b in _bounds(differs))


def _bounds(differs: AnyArray) -> list[tuple[int, int]]:
    """First cell of each stretch, and the first one after it."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], differs.astype(int), [0]]))).tolist()
    return list(zip(edges[::2], edges[1::2]))


def _shifted(
    courses: tuple[Course, Course], grid: Array, other: Array, own: Array, least: float
) -> tuple[Array, float]:
    """The programme as much later as agrees best with the column, by the largest correlation; and that shift [s]."""
    if not (np.ptp(own) and np.ptp(other)):
        return other, 0.0
    step = float(grid[1] - grid[0])
    sizes = np.arange(1, len(grid) // 2) * step
    best = (float(np.mean((own - other) ** 2)), 0.0)
    count = 2 * len(grid)
    power = np.fft.rfft(own - own.mean(), count) * np.conj(np.fft.rfft(other - other.mean(), count))
    products = np.fft.irfft(power, count)
    near = np.concatenate([np.arange(1, len(sizes) + 1), -np.arange(1, len(sizes) + 1)])
    for index in near[np.argsort(-products[near])[:20]]:
        values = courses[1](grid - index * step)
        error = float(np.mean((own - values) ** 2))
        if abs(index) * step > least and error < best[0]:
            best = error, float(index * step)
    return courses[1](grid - best[1]), best[1]


def _switches(grid: Array, values: Array, tolerance: float) -> tuple[float, ...]:
    """Instants at which a course changes by more than the tolerance [s], at most `MOST_SWITCHES`."""
    steps = np.flatnonzero(np.abs(np.diff(values)) > tolerance) + 1
    return tuple(float(grid[k]) for k in steps[:MOST_SWITCHES])
