"""How a probe reports, and where its files go."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable
from pathlib import Path

from benchmarks.models.systems import FMUS


def report(probe: Callable[[Path], str]) -> None:
    """Run the probe in a folder of its own; a Python exception is a finding too. The last line printed is JSON."""
    with tempfile.TemporaryDirectory() as work:
        try:
            text = probe(Path(work))
        except Exception as error:  # every way of refusing is what is asked for here
            text = f"{type(error).__name__}: {str(error).splitlines()[0][:160] if str(error) else ''}"
    print(json.dumps({"finding": text}), flush=True)


def fmu(name: str) -> Path:
    """A built FMU, for example `vector_gain_fmi3`."""
    return FMUS / f"{name}.fmu"
