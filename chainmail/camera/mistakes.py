"""A fabric that is not found: which of the usual mistakes of a rig file would explain it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from chainmail.camera.identify import Weave, identify
from chainmail.camera.rig import FabricLayout, PointsLayout
from cosim.unit.protocol import Array

#: Frames in which another arrangement is tried.
_TRIED = 12


def what_would_fit(places: Sequence[Array], layout: FabricLayout | PointsLayout) -> str:
    """What would have to be another in a rig for its fabric to be found; empty where none of the usual mistakes is all.

    Args:
        places: (y, z) of the spots of each picture, shape (spots, 2) [m].
        layout: Of the rig.
    """
    if not isinstance(layout, FabricLayout):
        return ""
    weave = weave_of(layout)
    chosen = places[:: max(1, len(places) // _TRIED)]
    seen = int(np.median([len(p) for p in chosen])) // 2
    tried: dict[str, tuple[Array, Weave]] = {
        "y points the other way: correct `plane`, y of all fiducials or `y`": (
            np.array([[-1.0, 0.0], [0.0, 1.0]]),
            weave,
        ),
        "z points the other way: correct `plane`, z of all fiducials or `z`": (
            np.array([[1.0, 0.0], [0.0, -1.0]]),
            weave,
        ),
        "y and z both point the other way, or the picture stands on its head: correct `plane`, or `along`": (
            -np.eye(2),
            weave,
        ),
        "y and z are exchanged: correct `at` of the fiducials": (np.array([[0.0, 1.0], [1.0, 0.0]]), weave),
        "the picture is turned by a quarter, as a phone does: correct `plane`, or turn the video": (
            np.array([[0.0, -1.0], [1.0, 0.0]]),
            weave,
        ),
        "the picture is turned by a quarter the other way: correct `plane`, or turn the video": (
            np.array([[0.0, 1.0], [-1.0, 0.0]]),
            weave,
        ),
    }
    if seen >= 3 and seen != weave.rows:
        tried[f"it has {seen} rows: correct markers.layout.rows"] = np.eye(2), replace(weave, rows=seen)
    fitting = [
        text
        for text, (turn, other) in tried.items()
        if np.mean([(c := identify(p @ turn, other)) is not None and c.is_resolved for p in chosen]) > 0.5
    ]
    return f"they can be told apart if {' or if '.join(fitting)}" if fitting else ""


def weave_of(layout: FabricLayout) -> Weave:
    """What a rig says of its fabric's chain of links."""
    return Weave(
        layout.rows,
        (layout.link_length.least.to("m"), layout.link_length.most.to("m")),
        (layout.row_pitch.least.to("m"), layout.row_pitch.most.to("m")),
        (layout.lean[0].to("rad"), layout.lean[1].to("rad")),
        layout.along.to("rad"),
    )
