"""What `cosim recording check` prints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from diagnosis.check.beside import Beside, Compared, Course
from diagnosis.check.input_doubts import how
from diagnosis.check.inputs import InputComparison, compare_inputs
from diagnosis.check.readings import measured_noise
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.usage import usage
from diagnosis.report.display import instant
from diagnosis.report.user_units import Units


@dataclass(frozen=True)
class Row:
    """One channel beside its simulation, as people read it.

    Args:
        name: Of the channel.
        samples: Readings, and how many lie at a limit of the sensor.
        span: First and last reading [s].
        noise: Stated, and by its neighbours.
        ranges: Measured and simulated, smallest to largest.
        fit: Correlation and root mean square error of the simulation as it is; empty where nothing was simulated.
    """

    name: str
    samples: str
    span: str
    noise: str
    ranges: tuple[str, str]
    fit: tuple[str, str]


def row(beside: Beside, units: Units) -> Row:
    """Numbers of a channel, in the units that the recording was written in."""
    channel = beside.channel
    clipped = int(np.count_nonzero(channel.is_clipped))
    scale = units.axis(channel.values, channel.unit)
    unit, factor, offset = scale.unit, scale.factor, scale.offset
    of_difference = units.difference(channel.unit)[1]
    stated = f"{factor * channel.deviation:.3g}" if channel.is_deviation_given else "-"
    return Row(
        channel.name,
        f"{len(channel.values)}" + (f", {clipped} at a limit" if clipped else ""),
        f"{instant(channel.times[0])} to {instant(channel.times[-1])}",
        f"{stated} / {factor * measured_noise(beside):.3g} {of_difference}",
        (_range(factor * channel.values + offset, unit), _simulated(beside, unit, factor, offset)),
        _fit(beside, of_difference, factor),
    )


def _range(values: np.ndarray, unit: str) -> str:
    return f"{np.min(values):.4g} to {np.max(values):.4g} {unit}"


def _simulated(beside: Beside, unit: str, factor: float, offset: float) -> str:
    if beside.simulated is None:
        return "-"
    return _range(factor * beside.at(beside.channel.times) + offset, unit)


def _fit(beside: Beside, unit: str, factor: float) -> tuple[str, str]:
    if beside.simulated is None:
        return "-", "-"
    course, values = beside.at(beside.channel.times), beside.channel.values
    error = float(np.sqrt(np.mean((values - course) ** 2)))
    is_flat = not (np.std(course) > 0.0 and np.std(values) > 0.0)
    correlation = "-" if is_flat else f"{np.corrcoef(course, values)[0, 1]:.3f}"
    return correlation, f"{factor * error:.3g} {unit}"


def course_text(course: Course) -> str:
    """One line about what drives a rig.

    >>> from diagnosis.check.beside import Course
    >>> import numpy as np
    >>> course_text(Course("drive.power", "W", np.array([0.0, 5.0]), np.array([0.0, 2.0]), False))
    'drive.power: programme, 0 to 2 W, switches at 5 s'
    """
    origin = "recorded" if course.is_recorded else "programme"
    low, high = float(np.min(course.values)), float(np.max(course.values))
    if low == high:
        return f"{course.name}: {origin}, {low:.4g} {course.unit} throughout"
    times = course.switches()
    listed = ", ".join(instant(t) for t in times[:6]) + (f", ... ({len(times)} in all)" if len(times) > 6 else "")
    return f"{course.name}: {origin}, {low:.4g} to {high:.4g} {course.unit}, switches at {listed} s"


def input_text(compared: InputComparison) -> str:
    """One line about a recorded input beside the programme."""
    whose = "stated by the recording" if compared.is_stated else "of the scenario"
    return f"{compared.name}: the recorded input {how(compared)}; the simulation uses it, not the programme {whose}"


def print_check(every: Sequence[Compared], doubts: Sequence[Doubt], console: Console) -> None:
    """Channels, inputs and doubts of every recording.

    Args:
        every: Recordings beside their simulation.
        doubts: About them, serious ones first.
        console: Where to.
    """
    for one in every:
        console.print(f"\n[bold]{escape(one.recording.title)}[/] ({escape(str(one.recording.path))})")
        if one.note:
            console.print(escape(one.note))
        table = Table(box=None)
        table.add_column("channel", no_wrap=True)
        for name in ("readings", "span [s]", "noise stated / seen", "measured", "simulated", "corr.", "RMSE"):
            table.add_column(name)
        for beside in one.channels.values():
            r = row(beside, one.units)
            table.add_row(escape(r.name), r.samples, r.span, r.noise, *r.ranges, *r.fit)
        console.print(table)
        for course in one.courses:
            console.print("  " + escape(course_text(course)))
        for compared in compare_inputs(one):
            console.print("  " + escape(input_text(compared)), soft_wrap=True)
        for used in usage(one.recording):
            if used.unused:
                console.print("  " + escape(str(used)), soft_wrap=True)
    console.print()
    for doubt in doubts:
        colour, word = ("red", "serious") if doubt.is_serious else ("yellow", "note")
        console.print(
            f"[{colour}]{word}[/]: {escape(doubt.recording)}, {escape(doubt.subject)} ({doubt.kind}): "
            f"{escape(doubt.statement)}",
            soft_wrap=True,
        )
        console.print(f"  -> {escape(doubt.remedy)}", soft_wrap=True)
    console.print(summary(every, doubts), soft_wrap=True)


def summary(every: Sequence[Compared], doubts: Sequence[Doubt]) -> str:
    """What follows, in one sentence that claims no more than was tested."""
    serious = sum(d.is_serious for d in doubts)
    if serious:
        return f"{serious} serious doubt{'s' if serious > 1 else ''}: settle {'these' if serious > 1 else 'it'} first."
    if all(one.results is None for one in every):
        return "No serious doubt about the readings by themselves; they were not compared with a simulation."
    return "No serious doubt. That is no statement about the model: missing physics is not looked for here."
