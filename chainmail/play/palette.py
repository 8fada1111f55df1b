"""The colours of the links: dark blue for the lowest value, over green and yellow, to red for the highest."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

#: Evenly spaced colours, chosen so that lightness tells values apart too, for those who do not see red and green.
_ANCHORS = np.array(
    [
        [46, 70, 160],
        [52, 110, 185],
        [70, 155, 190],
        [135, 195, 165],
        [222, 218, 130],
        [246, 176, 70],
        [228, 104, 48],
        [176, 28, 44],
    ]
)

#: Colours of ghosts and recordings, 0 to 1; none of them stands for a value.
GHOSTS = np.array([[0.48, 0.2, 0.85], [0.05, 0.4, 0.38], [0.5, 0.3, 0.12], [0.3, 0.32, 0.38]])


def palette() -> npt.NDArray[np.uint8]:
    """256 colours, shape (256, 3)."""
    at, steps = np.linspace(0, len(_ANCHORS) - 1, 256), np.arange(len(_ANCHORS))
    mixed = np.stack([np.interp(at, steps, column) for column in _ANCHORS.T], axis=1)
    return np.asarray(np.rint(mixed), dtype=np.uint8)
