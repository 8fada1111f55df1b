"""One look for all figures."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # figures are written to files; no display is needed
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

#: Colours of Figure 3 of the paper, and of cold, hot and re-cooled.
WITH_MODEL, WITHOUT_MODEL, SWITCH = "#1f4fd8", "#c218b8", "#d62728"
COLD, HOT, RECOOLED = "#2b6cb0", "#c53030", "#2f855a"


@contextmanager
def figure(path: Path, width: float = 6.4, height: float = 3.8, rows: int = 1) -> Iterator[list[Axes]]:
    """Axes of a new figure that is saved to `path` at the end."""
    with plt.rc_context({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "figure.dpi": 150}):
        drawn: Figure
        drawn, axes = plt.subplots(rows, 1, figsize=(width, height), sharex=True, squeeze=False, layout="constrained")
        try:
            yield list(axes[:, 0])
            drawn.savefig(path)
        finally:
            plt.close(drawn)


def mark_switches(axes: Axes, moments: list[float]) -> None:
    """Red vertical lines where the supply switches, as in Figure 3."""
    for index, moment in enumerate(moments):
        axes.axvline(moment, color=SWITCH, lw=1, label="supply switched" if index == 0 else None)
