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
from diagnosis.report.display import Axis, instant
from diagnosis.report.user_units import IN_SI, Scale, Units

#: Switches of a course that are listed.
LISTED = 6
#: Share of the range of a recorded course below which its typical change is no switch.
SMALL = 0.1
#: Units in which a pure number is shown by the hundred.
PER_CENT = ("%", "percent")


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
        unit: In which values are shown, and that of differences (noise, error); each ends in it.
    """

    name: str
    samples: str
    span: str
    noise: str
    ranges: tuple[str, str]
    fit: tuple[str, str]
    unit: tuple[str, str] = ("", "")


def row(beside: Beside, units: Units, clock: Scale) -> Row:
    """Numbers of a channel, in the units that the recording was written in.

    Args:
        beside: The channel.
        units: Those of the recording, that of the channel first.
        clock: How times are shown.
    """
    channel = beside.channel
    clipped = int(np.count_nonzero(channel.is_clipped))
    scale, of_difference = units.axis(channel.values, channel.unit), units.difference(channel.unit)[1]
    if channel.unit == "1" and units.written and units.written[0] in PER_CENT:
        scale, of_difference = Axis(100.0, 0.0, "%"), "%"
    unit, factor, offset = scale.unit, scale.factor, scale.offset
    stated = f"{factor * channel.deviation:.3g}" if channel.is_deviation_given else "-"
    return Row(
        channel.name,
        f"{len(channel.values)}" + (f", {clipped} at a limit" if clipped else ""),
        f"{instant(clock(channel.times[0]))} to {instant(clock(channel.times[-1]))}",
        f"{stated} / {factor * measured_noise(beside):.3g} {of_difference}",
        (_range(factor * channel.values + offset, unit), _simulated(beside, unit, factor, offset)),
        _fit(beside, of_difference, factor),
        (unit, of_difference),
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


def course_text(course: Course, units: Units = IN_SI) -> str:
    """One line about what drives a rig.

    A column that was logged changes with its readings; only what jumps has switches.

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
    about = f"{course.name}: {origin}, {low:.4g} to {high:.4g} {course.unit}"
    steps = np.abs(np.diff(course.values))
    step = float(np.median(steps[steps > 0.0]))
    if course.is_recorded and len(times) > LISTED and step < SMALL * (high - low):
        return f"{about}, changes with {len(times)} of its readings, by {step:.2g} {_difference(course.unit)} at a time"
    scale = units.scale(float(times[-1]), "s")
    listed = ", ".join(instant(scale(t)) for t in times[:LISTED])
    more = f", ... ({len(times)} in all)" if len(times) > LISTED else ""
    return f"{about}, switches at {listed}{more} {scale.unit}"


def _difference(unit: str) -> str:
    """Unit of a change: a change of 2 degC is 2 K."""
    return {"degC": "K", "degF": "°F"}.get(unit, unit)


def input_text(compared: InputComparison) -> str:
    """One line about a recorded input beside the programme."""
    whose = "stated by the recording" if compared.is_stated else "of the scenario"
    return (
        f"{compared.name}: the recorded input {how(compared)}; the simulation uses the recorded input, not the "
        f"programme {whose}"
    )


def print_check(every: Sequence[Compared], doubts: Sequence[Doubt], console: Console) -> None:
    """Channels, inputs and doubts of every recording.

    Args:
        every: Recordings beside their simulation.
        doubts: About them, serious ones first.
        console: Where to.
    """
    for one in every:
        clock = one.units.scale(one.end, "s")
        console.print(f"\n[bold]{escape(one.recording.title)}[/] ({escape(str(one.recording.path))})")
        if one.note:
            console.print(escape(one.note))
        rows = [row(b, one.units_of(b.channel.name), clock) for b in one.channels.values()]
        console.print(_table(rows, clock.unit))
        for course in one.courses:
            console.print("  " + escape(course_text(course, one.units)))
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


def _table(rows: Sequence[Row], clock: str) -> Table:
    """Channels beside their simulation, narrow enough for 80 columns: what all share stands in the heading."""
    table = Table(box=None, padding=(0, 1, 0, 0))
    shared = {(r.samples, r.span) for r in rows}
    if len(shared) == 1:
        samples, span = next(iter(shared))
        table.title = f"{samples} readings each, {span} {clock}"
        table.title_justify, table.title_style = "left", ""
    table.add_column("channel", no_wrap=True)
    for name in (*(() if len(shared) == 1 else ("readings", f"span [{clock}]")), "unit", "noise stated/seen"):
        table.add_column(name)
    for name in ("measured", "simulated", "corr.", "RMSE"):
        table.add_column(name, no_wrap=True)
    for r in rows:
        unit, difference = r.unit
        own = () if len(shared) == 1 else (r.samples, r.span)
        noise = _bare(r.noise, difference).replace(" / ", "/")
        ranges = [_bare(text, unit) for text in r.ranges]
        table.add_row(escape(r.name), *own, unit, noise, *ranges, r.fit[0], _bare(r.fit[1], difference))
    return table


def _bare(text: str, unit: str) -> str:
    """A number without its unit, which has a column of its own."""
    return text.removesuffix(f" {unit}").rstrip() if unit else text.rstrip()


def summary(every: Sequence[Compared], doubts: Sequence[Doubt]) -> str:
    """What follows, in one sentence that claims no more than was tested."""
    serious = sum(d.is_serious for d in doubts)
    if serious:
        return f"{serious} serious doubt{'s' if serious > 1 else ''}: settle {'these' if serious > 1 else 'it'} first."
    if all(one.results is None for one in every):
        return "No serious doubt about the readings by themselves; they were not compared with a simulation."
    return "No serious doubt. That is no statement about the model: missing physics is not looked for here."
