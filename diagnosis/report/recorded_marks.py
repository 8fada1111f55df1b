"""What a recording shows of a moving fabric: points beside its links, curves beside its plots."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from chainmail.play.film import Curve, Fabric, Marks, Point, Track
from cosim.unit.errors import InputError
from diagnosis.recording.recording import Channel, Recording

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


def marks_of(recording: Recording, fabric: Fabric) -> Marks:
    """Points and curves of a recording; what it has beside them is counted in a note.

    Args:
        recording: Of the fabric.
        fabric: Beside which they are shown.

    Raises:
        InputError: A coordinate is farther away than any point of a fabric.
    """
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
