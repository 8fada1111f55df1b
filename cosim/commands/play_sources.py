"""What `cosim play` is given, by what lies in each folder: runs, recordings, diagnoses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from chainmail.play.film import Curve, Fabric, Film, Finding, Marks, Point, Track
from chainmail.play.from_diagnosis import FILE, findings_of
from chainmail.play.from_results import fabric_of
from chainmail.play.run_results import is_run, run_results
from cosim.unit.errors import InputError
from diagnosis.recording.recording import Channel, Recording, load_recording

#: Recorded quantity to the plot that shows it, its unit, factor and shift.
_PLOTS = {
    ("supply", "voltage"): ("Supply voltage", "V", 1.0, 0.0),
    ("supply", "current"): ("Supply current", "A", 1.0, 0.0),
    ("supply", "power"): ("Supply power", "W", 1.0, 0.0),
    ("coil", "temperature"): ("Coil temperature", "°C", 1.0, -273.15),
    ("fabric", "max_curvature"): ("Maximum curvature", "1/m", 1.0, 0.0),
    ("fabric", "length"): ("Fabric length", "mm", 1e3, 0.0),
}
_AXES = ("x", "y", "z")
#: No point of a fabric is farther away [m].
_FARTHEST = 1000.0
#: Most readings of a channel that are shown.
_MOST = 2000


def film_of(folders: Sequence[Path], frames: int) -> Film:
    """The film of runs, recordings and diagnoses, told apart by their files.

    Args:
        folders: At least one run.
        frames: At most this many frames of each run.

    Raises:
        InputError: A folder does not exist, holds none of the three or cannot be read, or none holds a run.
    """
    kinds = [(_kind(folder), folder) for folder in folders]
    runs = [folder for kind, folder in kinds if kind == "run"]
    if not runs:
        raise InputError(
            folders[0],
            "",
            "there is no run among what was given, so there is no fabric to show",
            "give the folder of a run first, then recordings and diagnoses",
        )
    fabrics = _distinct([fabric_of(run_results(run), run, frames) for run in runs], runs)
    first = fabrics[0]
    marks = tuple(_marks(load_recording(folder), first) for kind, folder in kinds if kind == "recording")
    findings: list[Finding] = []
    notes = _comparison(fabrics)
    for folder in (folder for kind, folder in kinds if kind == "diagnosis"):
        found, told = findings_of(folder, first)
        findings += found
        notes += told
    return Film(tuple(fabrics), marks, tuple(findings), tuple(notes))


def _kind(folder: Path) -> str:
    if not folder.exists():
        raise InputError(folder, "", "there is no such folder", "give the folder of a run, a recording or a diagnosis")
    if folder.is_file():
        raise InputError(folder, "", "this is a file", f"give its folder: {folder.parent}")
    if is_run(folder):
        return "run"
    if (folder / "recording.yaml").is_file():
        return "recording"
    if (folder / FILE).is_file():
        return "diagnosis"
    raise InputError(
        folder,
        "",
        f"it holds no run (results.nc), no recording (recording.yaml) and no diagnosis ({FILE})",
        "give the folder that `cosim run`, `cosim record` or `cosim diagnose` wrote",
    )


def _distinct(fabrics: list[Fabric], runs: Sequence[Path]) -> list[Fabric]:
    """Fabrics with titles that tell them apart: the folder stands behind a title that several have."""
    titles = [f.title for f in fabrics]
    return [
        replace(f, title=f"{f.title} ({run.resolve().name})" if titles.count(f.title) > 1 else f.title)
        for f, run in zip(fabrics, runs)
    ]


def _comparison(fabrics: Sequence[Fabric]) -> list[str]:
    """What differs between the fabrics of several runs."""
    first = fabrics[0]
    notes = []
    for other in fabrics[1:]:
        if other.links != first.links or other.size != first.size:
            notes.append(f"the fabrics differ: {first.title} has {first.size}, {other.title} has {other.size}")
        elif other.shape != first.shape:
            notes.append(f"the links of {first.title} and {other.title} differ in size")
        if other.times[0] > first.times[-1] or other.times[-1] < first.times[0]:
            notes.append(f"{other.title} has no time in common with {first.title}: they are never shown together")
    return notes


def _marks(recording: Recording, fabric: Fabric) -> Marks:
    """Points and curves of a recording; what it has beside them is counted in a note."""
    tracks: dict[tuple[str, int], dict[str, Track]] = {}
    curves, unseen, foreign = [], [], []
    for channel in recording.channels.values():
        target = channel.target
        if target.kind in ("marker", "link") and target.quantity in _AXES:
            count = 2 * int(fabric.row.max()) if target.kind == "marker" else fabric.links
            if target.element[0] > count:
                foreign.append(channel.name)
                continue
            _check_distance(recording, channel)
            own = tracks.setdefault((target.kind, target.element[0]), {})
            own[target.quantity] = Track(channel.times, channel.values)
        elif (target.kind, target.quantity) in _PLOTS:
            curves.append(_curve(channel))
        else:
            unseen.append(channel.name)
    notes = [f"{len(unseen)} recorded channels are not shown ({_some(unseen)})"] if unseen else []
    if foreign:
        notes.append(f"{len(foreign)} recorded points are not of this fabric ({_some(foreign)})")
    notes += _flat(tracks)
    points = tuple(
        Point(kind, number, (own.get("x"), own.get("y"), own.get("z"))) for (kind, number), own in tracks.items()
    )
    return Marks(recording.title, points, tuple(curves), tuple(notes))


def _check_distance(recording: Recording, channel: Channel) -> None:
    farthest = float(np.abs(channel.values).max())
    if farthest > _FARTHEST:
        raise InputError(
            recording.path / "recording.yaml",
            f"channels.{channel.name}",
            f"it reads {farthest:.4g} m",
            "correct its `unit` and `factor`",
        )


def _flat(tracks: dict[tuple[str, int], dict[str, Track]]) -> list[str]:
    """A note on coordinates that no point has: they are those of the simulation."""
    missing = [axis for axis in _AXES if tracks and not any(axis in own for own in tracks.values())]
    if not missing:
        return []
    return [f"{' and '.join(missing)} of its points was not recorded: there they lie where the run has them"]


def _some(names: Sequence[str]) -> str:
    return ", ".join(names[:3]) + (", ..." if len(names) > 3 else "")


def _curve(channel: Channel) -> Curve:
    plot, unit, factor, shift = _PLOTS[channel.target.kind, channel.target.quantity]
    stride = -(-len(channel.times) // _MOST)
    return Curve(plot, unit, channel.name, channel.times[::stride], factor * channel.values[::stride] + shift)
