"""Loading scenarios for the command line: the file formats are imported when a file is read, not for `cosim --help`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cosim.scenario import Scenario


def load_scenario(path: str | Path, changes: Sequence[str] = ()) -> Scenario:
    """As `cosim.scenario.load_scenario`, with its arguments and errors."""
    from cosim.scenario import load_scenario as load

    return load(path, changes)
