"""Figures of inputs over time: the missing input that was estimated, and the programme of the next experiment."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cosim.figure_style import COLD, HOT, WITH_MODEL
from cosim.unit.protocol import Array
from diagnosis.judge.location import Waveform
from diagnosis.judge.next_experiment import Course, NextExperiment
from diagnosis.report.display import clean, difference
from diagnosis.report.figures import colour, drawn, thinned, with_clock
from diagnosis.report.user_units import IN_SI, Units

#: Courses that differ are drawn up to this many.
_COURSES = 6


def waveform_figure(waveform: Waveform, units: Units = IN_SI) -> str:
    """Estimate with its band, and what the law of the finding gives."""
    return drawn(lambda f: _paint_waveform(f.subplots(), waveform, units), 8.4, 2.8)


def _paint_waveform(axes: Axes, waveform: Waveform, units: Units) -> None:
    factor, unit = difference(waveform.unit)
    times = np.array(waveform.times)
    values, lower, upper = (factor * np.array(v) for v in (waveform.values, waveform.lower, waveform.upper))
    keep = thinned(values)
    tone = colour(max(waveform.finding - 1, 0))
    axes.axhline(0.0, color="#a0aec0", lw=0.8)
    axes.fill_between(times[keep], lower[keep], upper[keep], color=tone, alpha=0.2, lw=0, label="95 % band")
    axes.plot(times[keep], values[keep], color=tone, lw=1.2, label="estimated from the recording")
    if waveform.predicted:
        law = factor * np.array(waveform.predicted)
        axes.plot(times[keep], law[keep], color="black", lw=1.0, ls="--", label="by the law that was found")
    axes.set_ylabel(f"missing input [{unit}]")
    if len(times) > 1:
        axes.set_xlim(float(times[0]), float(times[-1]))
    with_clock(axes, units, float(times[-1]))
    axes.legend(frameon=False, fontsize=8, ncols=3, loc="upper left", bbox_to_anchor=(0.0, 1.18))


def experiment_figure(experiment: NextExperiment) -> str:
    """What is driven, how, with the instant at which the rivals differ most; beside it the chances of a decision."""
    count = len(experiment.courses)
    return drawn(lambda f: _paint_experiment(f, experiment), 8.4, 1.2 + 1.5 * count)


def _paint_experiment(figure: Figure, experiment: NextExperiment) -> None:
    count = len(experiment.courses)
    grid = figure.add_gridspec(count, 2, width_ratios=(3.0, 1.0))
    for n, course in enumerate(experiment.courses):
        axes = figure.add_subplot(grid[n, 0])
        _paint_course(axes, course, experiment)
        axes.set_xlabel("time [s]" if n == count - 1 else "")
    bars = figure.add_subplot(grid[:, 1])
    shares = [100.0 * experiment.repeat_decides, 100.0 * experiment.decides]
    bars.barh([0, 1], shares, color=[COLD, WITH_MODEL], height=0.5)
    for y, share in enumerate(shares):
        is_inside = share > 70.0
        bars.text(
            72.0 if is_inside else share + 2.0,
            y,
            f"{share:.0f} %",
            va="center",
            color="white" if is_inside else "black",
        )
    bars.set_yticks([0, 1], ["a repeat", "this one"])
    bars.set(xlim=(0.0, 100.0), ylim=(-0.6, 1.6), xlabel="decides in so many cases [%]")


def _paint_course(axes: Axes, course: Course, experiment: NextExperiment) -> None:
    values = np.array(course.values)
    end = course.times[0] + experiment.duration
    times = np.array([*course.times, max(end, course.times[-1] + 1e-9)])
    rows = np.vstack([values, values[-1:]])
    for numbers, column in _different(rows):
        style = {} if course.is_linear else {"drawstyle": "steps-post"}
        axes.plot(times, column, lw=1.3, label=numbers, **style)  # type: ignore[arg-type]
    axes.axvline(experiment.best_time, color=HOT, lw=1.0, ls=":")
    axes.set(ylabel=f"{clean(course.output)} [{course.unit}]", xlim=(float(times[0]), float(times[-1])))
    if values.shape[1] > 1:
        axes.legend(frameon=False, fontsize=7, ncols=3, loc="upper right")


def _different(rows: Array) -> Sequence[tuple[str, Array]]:
    """Columns that differ, each with the numbers of the elements that follow it."""
    groups: dict[bytes, list[int]] = {}
    for n, column in enumerate(rows.T):
        groups.setdefault(column.tobytes(), []).append(n)
    found = [(", ".join(str(n + 1) for n in members), rows[:, members[0]]) for members in groups.values()]
    return [(f"element {numbers}", column) for numbers, column in found[:_COURSES]]
